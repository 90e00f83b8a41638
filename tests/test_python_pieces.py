"""Pieces that are made in Python: motions from arrays and streams, dampers and tendons in kN."""

import math

import numpy as np
import pytest
from motion_files import wiggle
from obspy import Stream, Trace, UTCDateTime
from studies import study_text, write_study

import rockbatch as rb

TALL = rb.Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=1000)
VALUES = wiggle(400)


def test_a_motion_of_an_array_is_in_its_unit():
    motion = rb.Motion.from_array(VALUES, 0.01, "g", name="mine", vertical=0.5 * VALUES)
    np.testing.assert_array_equal(motion.horizontal, 9.81 * VALUES)
    np.testing.assert_array_equal(motion.vertical, 9.81 * (0.5 * VALUES))
    assert motion.pga_g == pytest.approx(np.abs(VALUES).max())
    np.testing.assert_allclose(rb.Motion.from_array(VALUES, 0.01, "gal").horizontal, 0.01 * VALUES, rtol=1e-15)
    with pytest.raises(rb.InputError, match='unknown acceleration unit "yd/s2"'):
        rb.Motion.from_array(VALUES, 0.01, "yd/s2")


def test_a_name_that_is_no_unicode_is_in_tables_as_in_the_motion_itself(tmp_path):
    """As of a file whose name has another encoding; where pandas keeps texts as Arrow does, they have to be Unicode."""
    motion = rb.Motion("b\udcffc", 0.02, np.sin(np.arange(50.0)), station="D\udcfczce")
    assert (motion.name, motion.station) == (r"b\xffc", r"D\xfczce")
    table = rb.run(rb.load_study(write_study(tmp_path, study_text())), motions=[motion])
    response = rb.simulate(rb.Pier(0.2, 1.0), rb.RigidBase(), motion)
    for row in (table.iloc[0], response.row):
        assert (row["record"], row["station"]) == (motion.name, motion.station)
    assert response.record == motion.name
    assert rb.Motion("two\tcolumns", 0.02, [0.0, 1.0]).name == "two\tcolumns"


def stream(*channels: str, **header: object) -> Stream:
    return Stream([
        Trace(VALUES * (n + 1), {"delta": 0.01, "station": "ABC", "channel": channel} | header)
        for n, channel in enumerate(channels)
    ])  # fmt: skip


def test_a_motion_of_an_obspy_stream_has_its_vertical_component():
    motion = rb.Motion.from_obspy(stream("HNZ", "HNE"), "cm/s2")
    assert (motion.name, motion.dt) == (".ABC..HNE", 0.01)
    np.testing.assert_allclose(motion.horizontal, 0.02 * VALUES)
    np.testing.assert_allclose(motion.vertical, 0.01 * VALUES)


def test_a_vertical_component_is_known_by_other_names_and_points_up():
    down = rb.Motion.from_obspy(stream("DWN", "N10E"), "cm/s2")
    np.testing.assert_allclose(down.vertical, -0.01 * VALUES)
    np.testing.assert_allclose(rb.Motion.from_obspy(stream("UP", "N10E"), "cm/s2").vertical, 0.01 * VALUES)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (stream("HNE", "HNN", "HNZ"), "one horizontal component"), (stream("HNZ"), "one horizontal component"),
        (stream("HNE", "HNZ", "UD"), "one vertical one at most"), (Stream(), "not none"),
        (stream("HNE") + stream("HNZ", delta=0.02), "differ in sampling interval"),
        (stream("HNE") + stream("HNZ", starttime=UTCDateTime(5)), "or start"),
    ],
)  # fmt: skip
def test_a_stream_of_other_components_is_refused(given, words):
    with pytest.raises(rb.InputError, match=words):
        rb.Motion.from_obspy(given, "g")


def test_the_spectrum_of_a_motion_is_that_of_resonance():
    """At its own period after n cycles the undamped oscillator's amplitude is n π a, in the limit of many."""
    sa = rb.Motion.from_array(np.sin(2 * np.pi * np.arange(40001) / 1000), 0.001, "g").spectrum([1.0], damping=0.0)
    assert (sa.index.name, sa.name) == ("period_s", "sa_g")
    assert sa.loc[1.0] == pytest.approx(40 * math.pi, rel=1e-3)
    assert len(rb.Motion.from_array(VALUES, 0.01, "g").spectrum()) == 101


def test_a_motion_is_drawn_with_all_its_components():
    motion = rb.Motion.from_array(VALUES, 0.01, "g", vertical=VALUES)
    axes = motion.plot().axes
    assert [axis.get_ylabel() for axis in axes] == ["horizontal [g]", "vertical [g]"]
    np.testing.assert_allclose(axes[0].lines[0].get_ydata(), VALUES)


def test_piers_bases_and_devices_show_what_was_given_as_a_table_in_notebooks():
    pads = rb.YieldingBase(beta=80, eta=2.5, restraints=(rb.Damper("viscous", nu=1.0742785, exponent=0.3),))
    shown = {each: each._repr_html_() for each in (TALL, pads, rb.RigidBase())}
    assert "<strong>Pier</strong>" in shown[TALL]
    assert f"<tr><th>size_m</th><td>{TALL.size:.5g}</td></tr>" in shown[TALL]
    assert "<td>Damper: kind = viscous, nu = 1.0743, exponent = 0.3</td>" in shown[pads]
    assert "kinematics" not in shown[pads]  # a default
    assert shown[rb.RigidBase()] == "<p><strong>RigidBase</strong></p>"


def test_a_study_without_motions_names_the_argument():
    tables = {"pier": {"alpha": 0.13, "p": 0.38}, "case": [{"base": "rigid"}]}
    with pytest.raises(rb.InputError, match="no ground motions; give them as motions=…, or write path"):
        rb.Study.from_dict(tables)
    assert rb.Study.from_dict(tables, motions=rb.Motion.from_array(VALUES, 0.01, "g")).cases


def test_devices_in_kilonewtons_are_those_of_a_study(tmp_path):
    """A study with the same keys, and the closed forms of THEORY.md: F/(M g), C/(M p), k b²/(M g R0)."""
    devices = [
        {"kind": "friction", "force_kN": 450.0, "at": "left"},
        {"kind": "hysteretic", "force_kN": 800.0, "yield_mm": 6.0},
        {"kind": "viscous", "coefficient_kN_s_m": 1500.0, "exponent": 0.3},
    ]
    tendon = {"prestress_kN": 3000.0, "stiffness_kN_m": 20e3, "yield_kN": 9000.0}
    deck = {"width_m": 8, "height_m": 30, "mass_t": 2000, "deck_mass_t": 1000}
    case = {"name": "tied", "base": "rigid", "damper": devices, "tendon": tendon}
    (read,) = rb.load_study(write_study(tmp_path, study_text(pier=deck, cases=(case,)))).cases
    made = (
        rb.Damper.friction(TALL, 450.0, at="left"),
        rb.Damper.hysteretic(TALL, force_kN=800.0, yield_mm=6.0),
        rb.Damper.viscous(TALL, coefficient_kN_s_m=1500.0, exponent=0.3),
        rb.Tendon.of(TALL, prestress_kN=3000.0, stiffness_kN_m=20e3, yield_kN=9000.0),
    )
    assert read.base.restraints == made
    weight = 3000 * 9.81
    assert made[1].f == pytest.approx(800 / weight)
    assert made[1].yield_m == pytest.approx(0.006)
    assert made[2].nu == pytest.approx(1500 / (3000 * TALL.p))
    assert made[3].lam == pytest.approx(20e3 * 4.0**2 / (weight * math.hypot(4.0, TALL.height)))
    assert rb.Tendon.of(TALL, prestress_kN=1000.0).strength == math.inf


def test_kilonewtons_need_a_pier_whose_mass_is_known():
    with pytest.raises(rb.InputError, match="mass_t is missing"):
        rb.Damper.friction(rb.Pier(alpha=0.2, p=1.0), force_kN=100.0)
    with pytest.raises(rb.InputError, match="force_kN = -1: must be 0 or above"):
        rb.Damper.friction(TALL, force_kN=-1.0)
    with pytest.raises(rb.InputError, match="force_kN = '100': must be a number"):
        rb.Damper.friction(TALL, force_kN="100")


@pytest.mark.parametrize(
    ("dt", "said"),
    [
        (
            100.0,
            "records have 0.002 to 0.05 s from sample to sample; if it is in ms, write dt = 0.1; if it is a rate in Hz",
        ),
        (200.0, "if it is a rate in Hz, write dt = 0.005"),
        (1.0, "dt = 1: more than 0.2 s"),
        (0.25, "dt = 0.25: more than 0.2 s"),
    ],
)
def test_a_sampling_rate_is_not_taken_for_a_step(dt, said):
    with pytest.raises(rb.InputError) as caught:
        rb.Motion.from_array(VALUES, dt, "m/s2")
    (problem,) = caught.value.messages
    assert said in problem
    assert problem.endswith('if it is right, write confirm = ["dt"]')
    assert rb.Motion.from_array(VALUES, dt, "m/s2", confirm=["dt"]).dt == dt
    with pytest.raises(rb.InputError):
        rb.Motion("mine", dt, VALUES)


def test_steps_of_records_are_taken():
    for dt in (1e-4, 0.0005, 0.005, 0.02, 0.1, 0.2):
        assert rb.Motion.from_array(VALUES, dt, "m/s2").times(2.0).dt == dt


@pytest.mark.parametrize("component", ["horizontal", "vertical", "across"])
def test_a_factor_with_which_any_component_overflows_is_refused(component):
    large = {
        name: np.array([0.0, 1e200 if name == component else 1.0]) for name in ("horizontal", "vertical", "across")
    }
    with pytest.raises(rb.InputError, match=f"{component} sample 1 .* is inf"):
        rb.Motion("mine", 0.01, **large).times(1e150)
