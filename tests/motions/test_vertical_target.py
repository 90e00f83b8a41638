"""Vertical components with a target and a factor of their own."""

from dataclasses import replace

import numpy as np
import pytest
from motion_files import wiggle
from studies import RIGID, study_text, write_study

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.motions import Motion, MotionSet
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.motions.suites.design_spectra import TableSpectrum
from rockbatch.motions.suites.scaling import Target, scale_verticals, verticals
from rockbatch.motions.suites.spectrum_target import SpectrumTarget
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

G = 9.81
TABLE = TableSpectrum((0.02, 0.1, 0.5, 3.0), (0.5, 0.9, 0.4, 0.05))


def record(seed, station, size=100.0, **more):
    return Motion(
        f"m{seed}", 0.01, size * wiggle(1200, seed), size * wiggle(1200, 50 + ord(station)), station=station, **more
    )


def suite():
    return [record(1, "A"), record(2, "A"), record(3, "B", 60.0), replace(record(4, "C"), vertical=None)]


def given(motions):
    return {motion.name: motion.vertical for motion in motions}


def test_every_vertical_meets_a_target_of_one_measure():
    motions = MotionSet([motion.times(2.0) for motion in suite()])
    found = scale_verticals(motions, given(suite()), Target(pga_g=0.3), 1.0, G).motions
    for motion, before in zip(found[:3], motions, strict=False):
        assert motion.pga_vertical == pytest.approx(0.3 * G)
        np.testing.assert_array_equal(motion.horizontal, before.horizontal)
    assert found[0].vertical_factor == found[1].vertical_factor != found[2].vertical_factor
    assert found[3] == motions[3]
    assert any(note.endswith("to PGA = 0.3 g") for note in found[0].notes)


@pytest.mark.parametrize("factors", ["each", "suite", "both"])
def test_a_spectrum_is_fitted_by_one_vertical_of_each_station(factors):
    target = SpectrumTarget(TABLE, (0.05, 1.0), factors)
    found = scale_verticals(MotionSet(suite()), given(suite()), target, 1.0, G, ["*"]).motions
    of_stations = [found[0], found[2]]
    spectra = [spectral_acceleration(m.vertical, m.dt, target.periods) / G for m in of_stations]
    over = spectra / TABLE.at(target.periods)
    if factors == "each":
        np.testing.assert_allclose(np.log(over).mean(axis=1), 0.0, atol=1e-12)
    else:
        assert over.mean(axis=0).min() == pytest.approx(0.9) or (factors == "both" and over.mean(axis=0).min() > 0.9)
    described = target.run_json_entry(verticals(found), G)
    np.testing.assert_allclose(described["mean_sa_g"], np.mean(spectra, axis=0), rtol=1e-4)


def test_a_factor_alone_multiplies_what_the_horizontal_factor_gave():
    motions = MotionSet([replace(motion.times(2.0), factor=2.0) for motion in suite()])
    found = scale_verticals(motions, given(suite()), None, 0.5, G).motions
    np.testing.assert_allclose(found[0].vertical, suite()[0].vertical)
    assert (found[0].vertical_factor, found[0].notes[-1]) == (1.0, "vertical times 0.5")
    both = scale_verticals(motions, given(suite()), Target(pga_g=0.3), 0.5, G).motions
    assert both[0].pga_vertical == pytest.approx(0.15 * G)
    assert scale_verticals(motions, given(suite()), None, 1.0, G) is motions


def test_a_weak_vertical_is_not_made_strong_until_it_is_confirmed():
    weak = [replace(motion, vertical=None if motion.vertical is None else 0.02 * motion.vertical) for motion in suite()]
    target = SpectrumTarget(TABLE, (0.05, 1.0), "each")
    found = scale_verticals(MotionSet(weak), given(weak), target, 1.0, G)
    assert [motion.name for motion in found.motions] == ["m4"]
    assert [each.name for each in found.unusable] == ["m1", "m2", "m3"]
    assert found.unusable[1].reason.startswith("its vertical component takes ")
    assert 'confirm = ["m2"]' in found.unusable[1].reason
    assert len(scale_verticals(MotionSet(weak), given(weak), target, 1.0, G, ["m*"]).motions) == 4


def test_a_vertical_component_that_does_not_move_stays_as_it_is():
    still = [replace(suite()[0], vertical=np.zeros(1200))]
    found = scale_verticals(MotionSet(still), given(still), Target(pga_g=0.3), 1.0, G)
    assert not found.motions[0].vertical.any()


# From the study file


def study(folder, **motions):
    text = study_text(
        motions={"path": str(rb.__path__[0]) + "/../motions/near_fault", **motions}, pulses=(), cases=[RIGID]
    )
    return load_study(write_study(folder, text))


VERTICAL = {"spectrum": "EN 1998-1 vertical", "type": 1, "ag_g": 0.4, "period_range_s": [0.05, 0.5]}


@pytest.mark.slow
def test_a_study_scales_both_components_apart(tmp_path):
    target = {"pga_g": 0.4}
    made = study(tmp_path, target=target, vertical_target=VERTICAL, vertical_scale=0.5)
    found = ground_motions(made)
    before = ground_motions(study(tmp_path))
    assert len(found.motions) == 10
    for motion, original in zip(found.motions, before.motions, strict=True):
        assert motion.pga_g == pytest.approx(0.4)
        np.testing.assert_allclose(motion.vertical, motion.vertical_factor * original.vertical, rtol=1e-12)
    fitted = made.motions.vertical_target
    spectra = [spectral_acceleration(m.horizontal, m.dt, fitted.periods) / G for m in verticals(found.motions)]
    over = np.mean(spectra, axis=0) / fitted.spectrum.at(fitted.periods)
    assert len(spectra) == 5
    assert over.min() >= 0.45 * (1 - 1e-9)


@pytest.mark.usefixtures("pages")
def test_results_say_what_the_vertical_components_were_scaled_by(tmp_path):
    rb.run(study(tmp_path, select={"pga_g": [0.3, 0.35]}, vertical_target=VERTICAL), out=tmp_path / "out")
    info = rb.open_results(tmp_path / "out").info
    assert info["vertical_target"]["spectrum"].startswith("EN 1998-1 vertical")
    assert all(record["vertical_factor"] > 0 for record in info["records"])
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "Vertical components" in page
    assert "vertical factor" in page


@pytest.mark.parametrize(
    ("motions", "said"),
    [
        (
            {"vertical_target": {"pga_g": 0.3}, "vertical": False},
            "vertical_target = .*: does not apply to vertical = false",
        ),
        ({"vertical_scale": 0.7, "vertical": False}, "vertical_scale = 0.7: does not apply to vertical = false"),
        ({"vertical_scale": 0}, "vertical_scale = 0: expected a number above 0"),
        ({"vertical_scale": 67}, 'vertical_scale = 67: more than 10 .*write confirm = \\["vertical_scale"\\]'),
        ({"vertical_target": {"pga_g": 0.3, "sa_g": 1.0}}, "pga_g and sa_g are given"),
        (
            {"vertical_target": VERTICAL | {"pairs": "rotd100"}},
            'pairs = "rotd100": is for horizontal components; leave it out',
        ),
        ({"vertical_target": {"sa_g": 0.4, "period_s": 0.1, "pairs": "apart"}}, "is for horizontal components"),
        ({"target": VERTICAL}, r'spectrum = "EN 1998-1 vertical": is for \[motions.vertical_target\]'),
        ({"vertical_target": {"damping": 0.05}}, "the measure is missing"),
    ],
)
def test_mistakes_about_verticals_are_answered(tmp_path, motions, said):
    with pytest.raises(InputError, match=said):
        study(tmp_path, **motions)
