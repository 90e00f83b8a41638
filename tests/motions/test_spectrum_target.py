"""Target spectra by the formulas of their codes, and the factors that fit a suite to them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from studies import study_text, write_study

from rockbatch.common.errors import InputError
from rockbatch.motions import Motion, MotionSet, description
from rockbatch.motions.spectrum import PERIODS, periods_over, spectral_acceleration
from rockbatch.motions.suites.design_spectra import (
    EUROCODE,
    AashtoSpectrum,
    AsceSpectrum,
    EurocodeSpectrum,
    NzsSpectrum,
    TableSpectrum,
    read_spectrum,
)
from rockbatch.motions.suites.scaling import MOST_FACTOR, at_target, scale_to_targets
from rockbatch.motions.suites.spectrum_target import SpectrumTarget
from rockbatch.study import load_study


def shaking(seed: int, size: float = 1.0) -> Motion:
    """Ten seconds of noise in a bell [m/s²]."""
    t = np.arange(1001) * 0.01
    draw = np.random.default_rng(seed)
    waves = sum(draw.normal() * np.sin(2 * np.pi * f * t + draw.uniform(0, 6)) for f in np.arange(0.2, 8.0, 0.2))
    return Motion(f"m{seed}", 0.01, size * np.exp(-(((t - 4) / 2) ** 2)) * waves)


SUITE = [shaking(1), shaking(2, 3.0), shaking(3, 0.5)]
TABLE = TableSpectrum((0.1, 0.5, 2.0, 6.0), (0.8, 0.9, 0.3, 0.05))


# The shapes


def test_eurocode_damping_scales_all_but_the_ground_acceleration_and_has_a_floor():
    shape = EUROCODE[1]["B"]
    t = np.array([0.0, 0.3, 1.0])
    for damping, eta in ((0.02, math.sqrt(10 / 7)), (0.05, 1.0), (0.10, math.sqrt(10 / 15)), (0.5, 0.55)):
        ratio = EurocodeSpectrum(1.0, shape, damping).at(t) / EurocodeSpectrum(1.0, shape).at(t)
        assert ratio == pytest.approx([1.0, eta, eta])


def test_the_asce_spectrum_meets_its_corner_values():
    spectrum = AsceSpectrum(sds_g=1.0, sd1_g=0.6, tl_s=8.0)
    t = np.array([0.0, 0.06, 0.12, 0.6, 1.2, 8.0, 16.0])
    assert spectrum.at(t) == pytest.approx([0.4, 0.7, 1.0, 1.0, 0.5, 0.075, 0.6 * 8 / 256])


def test_a_table_is_straight_in_logarithms_and_ends_where_it_ends():
    assert TABLE.at(np.array([0.5, 1.0, 6.0])) == pytest.approx([0.9, math.sqrt(0.9 * 0.3), 0.05])
    assert np.isnan(TABLE.at(np.array([0.09, 6.1]))).all()


@pytest.mark.parametrize(
    "text", ["period_s,sa_g\n0.1,0.8\n2,0.3\n", "0.1 0.8\n\n# more\n2.0\t0.3", "T;Sa\n0.1;0.8\n2;0.3"]
)
def test_a_spectrum_is_read_from_columns_of_any_kind(tmp_path, text):
    (tmp_path / "t.csv").write_text(text)
    found = read_spectrum(tmp_path / "t.csv", 0.02)
    assert (found.periods, found.sa_g, found.damping) == ((0.1, 2.0), (0.8, 0.3), 0.02)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("0.1, 0.8\n0.2, x\n", ":2: expected a period"),
        ("0.1, 0.8\n0.2\n", ":2: expected a period"),
        ("0.2, 0.8\n0.1, 0.7\n", "must grow"),
        ("0.1, 0.8\n", "two periods at least"),
        ("0.0, 0.8\n1, 1\n", "above 0"),
    ],
)
def test_a_damaged_spectrum_is_refused_with_its_line(tmp_path, text, said):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(InputError, match=said):
        read_spectrum(tmp_path / "t.csv")


def test_periods_of_spectra_reach_as_far_as_the_target_asks():
    assert periods_over(0.2, 4.0) == pytest.approx(PERIODS)
    wide = periods_over(0.03, 9.0)
    assert (wide[0] <= 0.03, wide[-1] >= 9.0, set(np.round(PERIODS, 9)) <= set(np.round(wide, 9))) == (True, True, True)


# The factors


def spectra(motions, target):
    return np.array([spectral_acceleration(m.horizontal, m.dt, target.periods, 0.05) / 10.0 for m in motions])


def test_each_record_exceeds_the_target_as_much_as_it_falls_below_it():
    target = SpectrumTarget(TABLE, (0.3, 3.0), "each")
    assert (target.periods[0], target.periods[-1], len(target.periods)) == (0.3, 3.0, 101)
    scaled = at_target(MotionSet(SUITE), target, 10.0).motions
    off = np.log(spectra(scaled, target) / TABLE.at(target.periods))
    np.testing.assert_allclose(off.mean(axis=1), 0.0, atol=1e-12)
    for motion, before in zip(scaled, SUITE, strict=True):
        np.testing.assert_allclose(motion.horizontal, before.horizontal * motion.factor)
        assert motion.notes == (f"scaled by {motion.factor:.4g} to the spectrum table, 5 % between 0.3 s and 3 s",)


def test_components_of_a_station_share_their_factor():
    pair = [replace(SUITE[0], station="S"), replace(SUITE[1], station="S"), SUITE[2]]
    target = SpectrumTarget(TABLE, (0.3, 3.0), "each")
    alone, together = target.factors_of(SUITE, 10.0), target.factors_of(pair, 10.0)
    # least squares of both: the geometric mean of the pair meets the target
    assert together == pytest.approx([math.sqrt(alone[0] * alone[1])] * 2 + [alone[2]])


def test_pairs_make_one_spectrum_by_the_root_of_the_sum_of_squares():
    pair = [replace(SUITE[0], station="S"), replace(SUITE[1], station="S"), SUITE[2]]
    target = SpectrumTarget(TABLE, (0.3, 3.0), "each", "srss")
    assert (target.share, replace(target, pairs="apart").share, replace(target, at_least=1.0).share) == (1.3, 0.9, 1.0)
    scaled = at_target(MotionSet(pair), target, 10.0).motions
    assert scaled[0].factor == scaled[1].factor != scaled[2].factor
    found = spectra(scaled, target)
    of_pair, alone = np.hypot(found[0], found[1]), found[2]
    for one in (of_pair, alone):
        assert np.log(one / TABLE.at(target.periods)).mean() == pytest.approx(0.0, abs=1e-12)
    told = target.run_json_entry(scaled, 10.0)
    np.testing.assert_allclose(told["mean_sa_g"], (of_pair + alone) / 2, rtol=1e-4)
    assert (told["pairs"], told["alone"], told["at_least"]) == ("srss", 1, 1.3)
    raised = at_target(MotionSet(pair), replace(target, factors="both"), 10.0).motions
    found = spectra(raised, target)
    mean = (np.hypot(found[0], found[1]) + found[2]) / 2
    assert (mean / TABLE.at(target.periods)).min() == pytest.approx(1.3)


@pytest.mark.parametrize("share", [0.9, 1.3])
def test_a_suite_gets_the_least_factor_by_which_its_mean_is_nowhere_below_the_share(share):
    target = SpectrumTarget(TABLE, (0.3, 3.0), "suite", at_least=share)
    scaled = at_target(MotionSet(SUITE), target, 10.0).motions
    assert len({round(motion.factor, 12) for motion in scaled}) == 1
    over = spectra(scaled, target).mean(axis=0) / TABLE.at(target.periods)
    assert over.min() == pytest.approx(share)


def test_both_fits_each_and_raises_all_if_the_mean_is_too_low_but_lowers_none():
    each = SpectrumTarget(TABLE, (0.3, 3.0), "each").factors_of(SUITE, 10.0)
    high = SpectrumTarget(TABLE, (0.3, 3.0), "both", at_least=1.2)
    ratio = np.array(high.factors_of(SUITE, 10.0)) / each
    assert ratio == pytest.approx([ratio[0]] * 3)
    assert ratio[0] > 1.0
    over = spectra(at_target(MotionSet(SUITE), high, 10.0).motions, high).mean(axis=0) / TABLE.at(high.periods)
    assert over.min() == pytest.approx(1.2)
    assert SpectrumTarget(TABLE, (0.3, 3.0), "both", at_least=0.01).factors_of(SUITE, 10.0) == pytest.approx(each)


def test_none_leaves_records_as_they_are_and_says_how_they_compare():
    target = SpectrumTarget(TABLE, (0.3, 3.0), "none")
    assert at_target(MotionSet(SUITE), target, 10.0).motions == SUITE
    told = target.run_json_entry(SUITE, 10.0)
    np.testing.assert_allclose(told["mean_sa_g"], spectra(SUITE, target).mean(axis=0), rtol=1e-4)
    np.testing.assert_allclose(told["sa_g"], TABLE.at(target.periods), rtol=1e-4)
    shown = description.spectra(SUITE, SUITE, 10.0, target)
    periods = np.array(shown["period_s"])
    within = (periods >= 0.3) & (periods <= 3.0)
    found, mean = (
        [sa for sa, one in zip(shown[name], within, strict=True) if one] for name in ("target_sa_g", "mean_sa_g")
    )
    np.testing.assert_allclose(found, TABLE.at(periods[within]), rtol=1e-3)
    np.testing.assert_allclose(mean, np.array(shown["sa_g"])[:, within].mean(axis=0), rtol=1e-3)


def test_a_record_without_motion_is_unusable_and_does_not_spoil_the_others():
    still = replace(SUITE[0], name="still", horizontal=np.zeros(1001))
    for factors in ("each", "suite", "both"):
        target = SpectrumTarget(TABLE, (0.3, 3.0), factors)
        found = at_target(MotionSet([SUITE[0], still]), target, 10.0)
        assert [motion.name for motion in found.motions] == ["m1"]
        assert found.motions[0].factor == pytest.approx(target.factors_of(SUITE[:1], 10.0)[0])
        assert "no motion that can be scaled to the spectrum table" in found.unusable[0].reason


@pytest.mark.parametrize("seed", range(2))
def test_a_suite_is_fitted_again_without_those_that_need_too_large_a_factor(seed):
    """The first fit refuses some; the mean of what remains is the share of the target, and all factors are within the limit."""
    sizes = np.exp(np.random.default_rng(seed).uniform(-2.5, 1.0, 12))
    motions = MotionSet([shaking(20 * seed + i, size) for i, size in enumerate(sizes)])
    target = SpectrumTarget(TABLE, (0.3, 3.0), "both", at_least=1.1)
    first, last = at_target(motions, target, 10.0), scale_to_targets(motions, target, None, 1.0, 10.0)
    assert 0 < len(first.unusable) <= len(last.unusable) < 12
    assert {file.name for file in first.unusable} <= {file.name for file in last.unusable}
    assert len(last.motions) + len(last.unusable) == 12
    assert max(motion.factor for motion in last) <= MOST_FACTOR
    over = spectra(last.motions, target).mean(axis=0) / TABLE.at(target.periods)
    assert over.min() >= 1.1 * (1 - 1e-9)
    confirmed = scale_to_targets(motions, target, None, 1.0, 10.0, ["*"])
    assert [motion.factor for motion in confirmed] == pytest.approx(target.factors_of(motions.motions, 10.0))


def test_a_record_refused_for_its_vertical_component_is_in_no_fit_of_the_others():
    target, vertical = SpectrumTarget(TABLE, (0.3, 3.0), "suite"), SpectrumTarget(TABLE, (0.3, 3.0), "each")
    pairs = [replace(motion, vertical=motion.horizontal) for motion in SUITE]
    pairs[1] = replace(pairs[1], vertical=1e-3 * pairs[1].horizontal)
    found = scale_to_targets(MotionSet(pairs), target, vertical, 1.0, 10.0, ["m1", "m3"])
    assert [motion.name for motion in found] == ["m1", "m3"]
    assert found.unusable[0].reason.startswith("its vertical component takes ")
    assert [motion.factor for motion in found] == pytest.approx(target.factors_of([SUITE[0], SUITE[2]], 10.0))


def test_a_range_beyond_the_target_is_refused():
    with pytest.raises(InputError, match=r"defined from 0.1 s to 6 s"):
        SpectrumTarget(TABLE, (0.05, 3.0))
    with pytest.raises(InputError, match="lesser one first"):
        SpectrumTarget(TABLE, (3.0, 0.3))


# From the study file

EUROCODE_KEYS = {"spectrum": "EN 1998-1", "type": 1, "ground": "B", "ag_g": 0.3, "period_range_s": [0.4, 4.0]}


def study_with(folder, target):
    return load_study(write_study(folder, study_text(motions={"target": target}))).motions.target


def test_a_study_names_codes_tables_and_files(tmp_path):
    found = study_with(tmp_path, EUROCODE_KEYS)
    assert found == SpectrumTarget(
        EurocodeSpectrum(0.3, EUROCODE[1]["B"], 0.05, "EN 1998-1 type 1, ground B"), (0.4, 4.0), "both", "apart"
    )
    annex = study_with(tmp_path, EUROCODE_KEYS | {"tc_s": 0.4, "damping": 0.1, "factors": "suite", "at_least": 1.3})
    assert (annex.spectrum.shape, annex.spectrum.damping) == (EUROCODE[1]["B"]._replace(tc_s=0.4), 0.1)
    assert (annex.factors, annex.at_least) == ("suite", 1.3)
    asce = {"spectrum": "asce7", "sds_g": 1.0, "sd1_g": 0.6, "tl_s": 8.0, "period_range_s": [1, 12]}
    assert study_with(tmp_path, asce).spectrum == AsceSpectrum(1.0, 0.6, 8.0)
    pairs = {"spectrum": [[0.1, 1.0], [4.0, 0.2]], "period_range_s": [0.2, 2.0], "damping": 0.02}
    assert study_with(tmp_path, pairs).spectrum == TableSpectrum((0.1, 4.0), (1.0, 0.2), 0.02, "given by the study")
    (tmp_path / "site.csv").write_text("T [s], Sa [g]\n0.1, 1.0\n4.0, 0.2\n")
    of_file = study_with(tmp_path, {"spectrum": "site.csv", "period_range_s": [0.2, 2.0]})
    assert of_file.spectrum == TableSpectrum((0.1, 4.0), (1.0, 0.2), 0.05, "site.csv")


@pytest.mark.parametrize(
    ("target", "said"),
    [
        (EUROCODE_KEYS | {"period_range_s": [0.4, 5.0]}, "defined from 0 s to 4 s"),
        (EUROCODE_KEYS | {"period_range_s": [4.0, 0.4]}, r"write for example period_range_s = \[0.4, 4.0\]"),
        (EUROCODE_KEYS | {"ground": "F"}, 'ground = "F": expected one of'),
        (EUROCODE_KEYS | {"type": 3}, "expected 1 or 2"),
        (EUROCODE_KEYS | {"tb_s": 0.6}, "must grow in this order"),
        (EUROCODE_KEYS | {"sds_g": 1.0}, 'sds_g = 1.0: is for spectrum = "ASCE 7"'),
        (EUROCODE_KEYS | {"pga_g": 1.0}, "is for a target of one measure"),
        (EUROCODE_KEYS | {"factors": "every"}, 'factors = "every": expected one of'),
        ({"spectrum": "EN1998", "period_range_s": [0.4, 4]}, 'no such file.*did you mean "EN 1998-1"'),
        ({"spectrum": [[1.0, 0.1], [0.5, 0.2]], "period_range_s": [0.6, 0.9]}, "periods must grow"),
        ({"spectrum": [0.1, 0.2], "period_range_s": [0.6, 0.9]}, "or pairs of a period"),
        ({"spectrum": [[1.0, 0.1], [1.5, 0.2]]}, "period_range_s is missing"),
        ({"pga_g": 0.4, "ground": "B"}, "is for a target with spectrum"),
    ],
)
def test_a_wrong_target_is_refused_with_the_reason(tmp_path, target, said):
    with pytest.raises(InputError, match=said):
        study_with(tmp_path, target)


# AASHTO, NZS 1170.5, and the vertical spectrum of EN 1998-1

TABLE_OF_NZS = {
    "A": "1.00 2.35 2.35 2.35 - 1.60 1.40 1.24 1.12 1.03 0.95 0.70 0.53 0.42 0.35 0.26 0.20 0.16",
    "C": "1.33 2.93 2.93 2.93 - 2.00 1.74 1.55 1.41 1.29 1.19 0.88 0.66 0.53 0.44 0.32 0.25 0.20",
    "D": "1.12 3.00 3.00 3.00 3.00 3.00 2.84 2.53 2.29 2.09 1.93 1.43 1.07 0.86 0.71 0.52 0.40 0.32",
    "E": "1.12 3.00 3.00 3.00 3.00 3.00 3.00 3.00 3.00 3.00 3.00 2.21 1.66 1.33 1.11 0.81 0.62 0.49",
}
"""Shapes for modal analyses and time histories as a table of a public program has them, to two decimals (Table 3.1 there); at
0.4 s its rows for rock and class C have the values of the other column, for equivalent static analyses."""


@pytest.mark.parametrize("subsoil", ["A", "B", "C", "D", "E"])
def test_the_shapes_of_nzs_1170_5_are_those_of_its_table(subsoil):
    periods = np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5])
    cells = TABLE_OF_NZS["A" if subsoil == "B" else subsoil].split()
    listed = np.array([math.nan if cell == "-" else float(cell) for cell in cells])
    shape = NzsSpectrum(subsoil, 1.0).at(periods)
    known = ~np.isnan(listed)
    np.testing.assert_allclose(shape[known], listed[known], atol=0.0075)
    assert np.isnan(NzsSpectrum(subsoil, 1.0).at(np.array([4.6]))).all()


def test_hazard_return_period_and_near_faults_multiply_the_shape():
    t = np.array([0.5, 1.5, 2.0, 3.0, 4.0, 4.5])
    plain = NzsSpectrum("C", 1.0).at(t)
    np.testing.assert_allclose(NzsSpectrum("C", 0.4, 1.3).at(t), 0.52 * plain)
    near = NzsSpectrum("C", 0.4, 1.3, 2.0).at(t) / (0.52 * plain)
    np.testing.assert_allclose(near, [1.0, 1.0, 1.12, 1.36, 1.60, 1.66])
    np.testing.assert_allclose(
        NzsSpectrum("C", 0.4, 1.3, 11.0).at(t) / (0.52 * plain) - 1.0, 0.5 * (near - 1.0), atol=1e-12
    )
    np.testing.assert_allclose(NzsSpectrum("C", 0.4, 1.3, 25.0).at(t), 0.52 * plain)
    np.testing.assert_allclose(NzsSpectrum("C", 0.4, 0.75, 2.0).at(t), 0.3 * plain)
    np.testing.assert_allclose(
        NzsSpectrum("C", 0.4, 1.3, 0.5).at(t), NzsSpectrum("C", 0.4, 1.3, 2.0).at(t)
    )  # as at 2 km
    assert [str(NzsSpectrum("C", 0.4, 1.3, km)).count("D = ") for km in (19.9, 20.0)] == [1, 0]
    for z, r in ((0.4, 1.75), (0.7, 1.0), (0.35, 2.0)):  # Z R of 0.7, and beyond it
        assert not NzsSpectrum("C", z, r).beyond
        assert NzsSpectrum("C", z, 1.001 * r).beyond.startswith(f"Z R = {1.001 * z * r:.3g}, which NZS 1170.5, 3.1.1")


def test_the_aashto_spectrum_meets_its_corner_values_and_falls_without_end():
    spectrum = AashtoSpectrum(as_g=0.35, sds_g=1.0, sd1_g=0.6)
    t = np.array([0.0, 0.06, 0.12, 0.6, 1.2, 6.0, 12.0])
    assert spectrum.at(t) == pytest.approx([0.35, 0.675, 1.0, 1.0, 0.5, 0.1, 0.05])


def test_the_vertical_eurocode_spectrum_meets_its_corner_values(tmp_path):
    keys = {"spectrum": "EN 1998-1 vertical", "type": 1, "ag_g": 0.3, "period_range_s": [0.1, 2.0]}

    def spectrum_of(table):
        text = study_text(motions={"vertical_target": table})
        return load_study(write_study(tmp_path, text)).motions.vertical_target.spectrum

    spectrum = spectrum_of(keys)
    t = np.array([0.0, 0.05, 0.15, 1.0, 4.0])
    top = 0.9 * 0.3 * 3.0
    assert spectrum.at(t) == pytest.approx([0.27, top, top, top * 0.15, top * 0.15 / 16.0])
    assert str(spectrum) == "EN 1998-1 vertical, a_vg = 0.27 g, 5 %"
    other = spectrum_of({name: value for name, value in keys.items() if name != "type"} | {"avg_over_ag": 0.7})
    assert float(other.at(np.array([0.1]))[0]) == pytest.approx(0.63)
    assert spectrum_of(keys | {"type": 2}).ag_g == pytest.approx(0.135)
    with pytest.raises(InputError, match=r"type is missing; write for example type = 1, or avg_over_ag = 0.9"):
        spectrum_of({name: value for name, value in keys.items() if name != "type"})


AASHTO_KEYS = {"spectrum": "AASHTO", "as_g": 0.4, "sds_g": 1.0, "sd1_g": 0.6, "period_range_s": [0.4, 4.0]}
ASCE_KEYS = {"spectrum": "ASCE 7", "sds_g": 1.0, "sd1_g": 0.6, "tl_s": 8.0, "period_range_s": [0.4, 4.0]}
NZS_KEYS = {"spectrum": "NZS 1170.5", "subsoil": "C", "hazard_factor": 0.4, "period_range_s": [0.4, 4.0]}


def test_a_study_names_the_further_codes(tmp_path):
    assert study_with(tmp_path, AASHTO_KEYS).spectrum == AashtoSpectrum(0.4, 1.0, 0.6)
    assert study_with(tmp_path, NZS_KEYS | {"spectrum": "nzs1170.5"}).spectrum == NzsSpectrum("C", 0.4)
    assert {
        AashtoSpectrum(0.4, 1.0, 0.6).damping,
        NzsSpectrum("C", 0.4).damping,
        AsceSpectrum(1.0, 0.6, 8.0).damping,
    } == {0.05}
    near = study_with(tmp_path, NZS_KEYS | {"return_period_factor": 1.8, "fault_km": 6})
    assert str(near.spectrum) == "NZS 1170.5 subsoil C, Z = 0.4, R = 1.8, D = 6 km, 5 %"


@pytest.mark.parametrize("keys", [EUROCODE_KEYS, AASHTO_KEYS, NZS_KEYS, ASCE_KEYS])
def test_what_a_code_needs_and_has_no_usual_value_must_be_given(tmp_path, keys):
    for name in keys.keys() - {"spectrum", "period_range_s"}:
        with pytest.raises(InputError, match=f"{name} is missing"):
            study_with(tmp_path, {key: value for key, value in keys.items() if key != name})


@pytest.mark.parametrize(
    ("target", "said"),
    [
        (AASHTO_KEYS | {"tl_s": 8.0}, 'tl_s = 8.0: is for spectrum = "ASCE 7"; leave it out'),
        (AASHTO_KEYS | {"as_g": 1.1}, "as_g must not be above sds_g"),
        (AASHTO_KEYS | {"damping": 0.02}, "damping: the spectrum of AASHTO is for 5 %"),
        (NZS_KEYS | {"subsoil": "F"}, 'subsoil = "F": expected one of "A", "B", "C", "D", "E"'),
        (NZS_KEYS | {"hazard_factor": 4.0}, "hazard_factor = 4: more than 1 .New Zealand has 0.13 to 0.6.; "),
        (NZS_KEYS | {"period_range_s": [0.4, 5.0]}, "defined from 0 s to 4.5 s"),
        (NZS_KEYS | {"sds_g": 1.0}, 'sds_g = 1.0: is for spectrum = "ASCE 7" or "AASHTO"; leave it out'),
        ({"spectrum": "NZS", "period_range_s": [0.4, 4]}, 'no such file.*did you mean "NZS 1170.5"'),
        (NZS_KEYS | {"interpolation": "linear"}, "interpolation: is for tables, and NZS 1170.5 is none"),
        (
            {"spectrum": [[0.0, 0.4], [4.0, 0.2]], "period_range_s": [0.4, 3.0]},
            'write interpolation = "linear", or begin at 0.01 s',
        ),
        ({"spectrum": [[-0.1, 0.4], [4.0, 0.2]], "period_range_s": [0.4, 3.0]}, "expected 0 or a number above it"),
    ],
)
def test_mistakes_about_the_further_codes_are_answered(tmp_path, target, said):
    with pytest.raises(InputError, match=said):
        study_with(tmp_path, target)


def test_a_linear_table_is_straight_in_its_numbers_from_zero_on(tmp_path):
    keys = {"spectrum": [[0.0, 0.4], [0.2, 1.0], [1.0, 0.5], [4.0, 0.1]], "period_range_s": [0.1, 3.0]}
    spectrum = study_with(tmp_path, keys | {"interpolation": "linear"}).spectrum
    assert spectrum.at(np.array([0.0, 0.1, 0.6, 2.5])) == pytest.approx([0.4, 0.7, 0.75, 0.3])
    (tmp_path / "site.csv").write_text("T,Sa\n0.0,0.4\n0.2,1.0\n4.0,0.1\n")
    of_file = study_with(tmp_path, keys | {"spectrum": "site.csv", "interpolation": "linear"}).spectrum
    assert of_file == TableSpectrum((0.0, 0.2, 4.0), (0.4, 1.0, 0.1), 0.05, "site.csv", linear=True)
    with pytest.raises(InputError, match="must be numbers above 0"):
        TableSpectrum((0.0, 0.2), (0.4, 0.0), linear=True)


@pytest.mark.parametrize("of", [tuple, list])
@pytest.mark.parametrize("linear", [True, False])
@pytest.mark.parametrize("first", [0, 1])
def test_a_table_begins_at_0_only_if_it_is_straight_in_its_numbers(of, linear, first):
    """In a tuple or a list alike."""
    if first == 0 and not linear:
        with pytest.raises(InputError) as refused:
            TableSpectrum(of([first, 4]), of([0.9, 0.4]))
        assert len(refused.value.messages) == 1
        return
    middle = 0.65 if linear else math.sqrt(0.9 * 0.4)
    half_way = (first + 4) / 2 if linear else math.sqrt(first * 4)
    assert TableSpectrum(of([first, 4]), of([0.9, 0.4]), linear=linear).at(np.array([half_way])) == pytest.approx(
        [middle]
    )


GROUNDS = {
    1: {"A": (1.0, 0.15, 0.4, 2.0), "B": (1.2, 0.15, 0.5, 2.0), "C": (1.15, 0.2, 0.6, 2.0), "D": (1.35, 0.2, 0.8, 2.0),
        "E": (1.4, 0.15, 0.5, 2.0)},
    2: {"A": (1.0, 0.05, 0.25, 1.2), "B": (1.35, 0.05, 0.25, 1.2), "C": (1.5, 0.1, 0.25, 1.2), "D": (1.8, 0.1, 0.3, 1.2),
        "E": (1.6, 0.05, 0.25, 1.2)},
}  # fmt: skip
"""S, T_B, T_C and T_D of EN 1998-1:2004, Tables 3.2 and 3.3."""


@pytest.mark.parametrize(
    ("kind", "ground"), [(kind, ground) for kind, of_kind in GROUNDS.items() for ground in of_kind]
)
def test_a_study_names_grounds_of_the_eurocode_by_the_values_of_its_tables(tmp_path, kind, ground):
    keys = {"spectrum": "EN 1998-1", "type": kind, "ground": ground, "ag_g": 0.2, "period_range_s": [0.1, 2.0]}
    spectrum = study_with(tmp_path, keys).spectrum
    soil, tb, tc, td = GROUNDS[kind][ground]
    t = np.array([0.0, 0.5 * tb, tb, tc, 0.5 * (tc + td), td, 4.0])
    top = 0.2 * soil * 2.5
    falling = [top * tc / (0.5 * (tc + td)), top * tc / td, top * tc * td / 16.0]
    assert spectrum.at(t) == pytest.approx([0.4 * top, 0.7 * top, top, top, *falling], rel=1e-9)
    assert np.isnan(spectrum.at(np.array([4.01]))).all()  # 3.2.2.2: up to 4 s
