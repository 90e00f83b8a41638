"""Forces that leave landings or the modes of a shaft out decide no check that they could pass, and the others as before."""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from check_samples import PIER, RIGID, case, folder, in_sections, judged, runs, verdict
from studies import RIGID as ROCK
from studies import SINE, study_text, write_study

from rockbatch.batch.single import simulate
from rockbatch.checks import Rule, as_table, judge
from rockbatch.checks.answer import answer
from rockbatch.checks.omissions import (
    BENDING,
    FLIGHTS,
    IMPULSES,
    KEYS,
    LANDINGS,
    LANDINGS_OF_BENDING,
    LANDINGS_OF_FRAME,
    LINEARISED,
    MODES,
    OMISSIONS,
    POINTS,
    SHAKEDOWN,
    SLIDES,
    STILL_ROCKS,
    TAIL,
    TENDONS,
    YIELDS_ON,
)
from rockbatch.checks.scorecard import scorecard
from rockbatch.checks.verdicts import read_verdicts, write_verdicts
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.motions import pulse
from rockbatch.pier import Damper, ElasticBase, FootingBase, Part, Pier, RigidBase, Stop, Tendon, YieldingBase
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.results.checking import verdicts
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case

ENTERED = {
    *("base_shear_m_s2", "base_shear_kN", "key_shear_m_s2", "key_shear_kN", "friction_demand"),
    *("normal_force_m_s2", "normal_force_kN", "pivot_force", "pivot_force_kN", "base_moment_m2_s2", "base_moment_kNm"),
    *("deck_acceleration_m_s2", "deck_acceleration_g"),
    *("section_shear_kN", "section_moment_kNm", "section_axial_kN", "section_tension_kN"),
}
"""Forces that the blow of a landing on stiff feet enters, by THEORY.md, Forces: written down again."""
DAMPED = case("damped", ElasticBase(beta=50.0, zeta=0.05))
FLEXIBLE = replace(PIER, flexural_period_s=0.6)
BENDING_PADS = ElasticBase(beta=50.0, zeta=0.05, kinematics="finite", shaft="elastic")


def bent(modes=None):
    """A pier whose shaft bends in so many modes, by default in all that are followed."""
    return of_pier(FLEXIBLE, RigidBase(shaft="elastic", flexural_modes=modes)) | {"case": "bent"}


LIGHT = Pier.with_deck(width_m=8.0, height_m=30.0, mass_t=150.0, deck_mass_t=1000.0, confirm=("mass_t", "deck_mass_t"))
SHEAR = {"base_shear_kN": 3000.0, "base_shear_m_s2": 1.0, "forces_error": 0.01}


def of_pier(pier, base=RIGID):
    """A case of another pier."""
    return describe_case(Case("other", pier, base, {}))


def columns_of(demand, value):
    """Cells of peaks.csv by which ``demand`` is ``value``, whatever its columns are called."""
    if DEMANDS[demand].needs == "sections":
        return {}
    sides = {"pivot_force": ("pivot_force_left", "pivot_force_right"),
             "pivot_force_kN": ("pivot_force_left_kN", "pivot_force_right_kN")}  # fmt: skip
    columns = sides.get(demand, (demand.replace("deck_acceleration_g", "deck_acceleration_m_s2"),))
    return {name: value * (9.81 if demand == "deck_acceleration_g" else 1.0) for name in columns} | {
        "base_shear_m_s2": 1.0
    }


@pytest.mark.sweep(fast=10)
@pytest.mark.parametrize("demand", sorted(ENTERED))
@pytest.mark.parametrize(("impacts", "verdict", "high"), [(0, "pass", 40000.0), (1, "not decided", math.inf)])
def test_a_force_on_rigid_ground_passes_only_if_the_pier_never_lands(demand, impacts, verdict, high):
    table = runs([0.3], name="rigid", **columns_of(demand, 3000.0) | {"impacts": impacts})
    found = judged(table, one=RIGID, demand=demand, at_most=50000.0 if impacts else 1e9)
    assert (found.verdict, LANDINGS in found.omits) == (verdict, bool(impacts))
    assert found.high == math.inf if impacts else found.high <= high
    on_springs = judged(table.assign(case="damped"), one=DAMPED, demand=demand, at_most=50000.0)
    assert (on_springs.verdict, LANDINGS in on_springs.omits) == ("pass", False)


def test_the_blow_of_a_landing_enters_these_forces_and_no_other_demand():
    share = {"section_moment_over_capacity", "base_shear_over_capacity"}
    on_bed = {"bed_force_over_weight", "bed_pressure_MPa"}
    assert {name for name, demand in DEMANDS.items() if demand.landing} == ENTERED | share | on_bed
    axial = {"section_axial_kN", "section_tension_kN"}
    upright = {
        "normal_force_m_s2",
        "normal_force_kN",
        "pivot_force",
        "pivot_force_kN",
        "base_moment_m2_s2",
        "base_moment_kNm",
    }
    assert {name for name, demand in DEMANDS.items() if demand.bending} == (ENTERED - axial - upright) | share


@pytest.mark.parametrize(
    "name", ["landing_velocity_m_s", "impulse_kN_s", "impact_friction_demand", "stop_force_over_weight"]
)
def test_what_is_finite_in_a_landing_is_decided_on_rigid_ground(name):
    stopped = case("rigid", RigidBase(restraints=(Stop(0.1, 20.0),)))
    table = runs([0.3], name="rigid", impacts=5, **{name: 0.5}, **SHEAR)
    assert judged(table, one=stopped, demand=name, at_most=0.6).verdict == "pass"


def test_a_force_beyond_its_limit_without_landings_fails_and_says_so():
    table = runs([0.3], name="rigid", impacts=4, **SHEAR)
    beyond, within_error = (judged(table, one=RIGID, demand="base_shear_kN", at_most=most) for most in (2900.0, 2980.0))
    assert (beyond.verdict, beyond.omits) == ("fail", (LANDINGS, BENDING))
    assert (within_error.verdict, within_error.low) == ("not decided", pytest.approx(2970.0))
    assert OMISSIONS[LANDINGS].remark in beyond.note


def test_a_count_or_a_median_is_decided_where_runs_without_landings_suffice():
    table = runs([0.3] * 5, name="rigid", impacts=[0, 0, 0, 3, 0], **SHEAR)
    ask = {"one": RIGID, "demand": "base_shear_kN", "at_most": 4000.0}
    assert judged(table, statistic="median", **ask).verdict == "pass"
    assert judged(table, statistic="max", **ask).verdict == "not decided"
    counts = [judged(table, statistic="count", above=4000.0, **ask | {"at_most": most}) for most in (1, 0)]
    assert [(found.verdict, found.low, found.high) for found in counts] == [("pass", 0, 1), ("not decided", 0, 1)]
    assert [LANDINGS in found.omits for found in counts] == [False, True]


def test_one_axis_that_lands_leaves_the_demand_of_both_open():
    along = runs([0.1], name="rigid", impacts=0, **SHEAR)
    across = runs([0.1], name="rigid across", impacts=2, **SHEAR)
    cases = [RIGID, describe_case(Case("rigid across", PIER, RigidBase(), {}, across_of="rigid"))]
    for way in ("greater", "srss", "100_30"):
        rule = Rule("shear", "base_shear_kN", at_most=9000.0, both_axes=way)
        (found,) = judge([rule], pd.concat([along, across]), cases)
        assert (found.verdict, LANDINGS in found.omits) == ("not decided", True)
        (still,) = judge([rule], pd.concat([along, across.assign(impacts=0)]), cases)
        assert still.verdict == "pass"


def test_runs_left_out_leave_nothing_open():
    table = runs([0.3, 0.4], name="rigid", impacts=[0, 6], **SHEAR).assign(status=["ok", "overturned"])
    found = judged(table, one=RIGID, demand="base_shear_kN", at_most=4000.0, overturned="left out")
    assert (found.verdict, found.omits) == ("not decided", (BENDING,))  # no check says how many runs may overturn
    assert found.high < 4000.0
    kept = judged(table, one=RIGID, demand="base_shear_kN", at_most=4000.0, overturned="value")
    assert (kept.verdict, kept.omits) == ("not decided", (LANDINGS, BENDING))


def test_the_landings_of_a_frame_cannot_be_told_to_go_on_springs():
    frame = Pier.frame(Pier.rectangle(1.6, 9.6, mass_t=60.0), 3, 1000.0)
    found = judged(
        runs([0.3], name="other", impacts=4, **SHEAR),
        one=of_pier(frame, RigidBase()),
        demand="base_shear_kN",
        at_most=1e4,
    )
    assert found.omits == (LANDINGS_OF_FRAME,)  # a light shaft: no bending
    assert 'base = "elastic"' not in found.note


@pytest.mark.parametrize(("modes", "error"), [(1, 0.01), (None, math.nan)])
def test_forces_of_modes_that_are_not_known_to_converge_decide_nothing_either_way(modes, error):
    """Of a single mode, and of several with a fixed step, which have no error; their number is shown."""
    table, one = runs([0.3], name="bent", impacts=0, **SHEAR | {"forces_error": error}), bent(modes)
    for most, ratio in ((2000.0, 1.5), (6000.0, 0.5)):
        found = judged(table, one=one, demand="base_shear_kN", at_most=most)
        assert (found.verdict, found.low, found.value, found.high) == ("not decided", 0.0, 3000.0, math.inf)
        assert (found.ratio, found.omits[0], found.is_lower_bound) == (ratio, MODES, False)
    overturned = judged(table.assign(status="overturned"), one=one, demand="base_shear_kN", at_most=6000.0)
    assert overturned.verdict == "fail"
    assert judged(table, one=one, demand="theta_max_over_alpha", at_most=0.5).verdict == "pass"


@pytest.mark.parametrize("impacts", [0, 5])
def test_forces_of_several_modes_are_decided_by_their_error_through_landings_too(impacts):
    """The modes take up a blow across the shaft; along it nothing gives, so that N stays open."""
    table = runs([0.3], name="bent", impacts=impacts, **SHEAR | {"normal_force_kN": 3000.0, "forces_error": 0.2})
    for most, decided in ((3601.0, "pass"), (3599.0, "not decided"), (2399.0, "fail")):
        found = judged(table, one=bent(), demand="base_shear_kN", at_most=most)
        assert (found.verdict, found.omits) == (decided, ())
    found = judged(table, one=bent(), demand="normal_force_kN", at_most=9000.0)
    assert (found.verdict, found.omits) == (("not decided", (LANDINGS_OF_BENDING,)) if impacts else ("pass", ()))
    assert ('kinematics = "finite"' in found.note) is bool(impacts)
    as_advised = of_pier(FLEXIBLE, BENDING_PADS) | {"case": "bent"}
    assert judged(table, one=as_advised, demand="normal_force_kN", at_most=9000.0).verdict == "pass"


def test_the_deck_of_a_shaft_that_bends_on_dashpots_is_not_decided():
    table = runs([0.3], name="bent", impacts=3, deck_acceleration_m_s2=2.0, **SHEAR | {"forces_error": 0.1})
    on_springs = of_pier(FLEXIBLE, BENDING_PADS) | {"case": "bent"}
    for one, omitted in ((bent(), ()), (on_springs, (POINTS,))):
        found = judged(table, one=one, demand="deck_acceleration_g", at_most=1.0)
        assert (found.verdict, found.omits) == ("not decided" if omitted else "pass", omitted)
    assert judged(table, one=on_springs, demand="base_shear_kN", at_most=4000.0).verdict == "pass"


def test_a_case_of_an_earlier_version_bends_in_one_mode():
    old = bent()
    del old["parameters"]["flexural_modes"]
    table = runs([0.3], name="bent", impacts=0, **SHEAR)
    assert judged(table, one=old, demand="base_shear_kN", at_most=9000.0).omits == (MODES,)


@pytest.mark.parametrize(
    "base", [RigidBase(), ElasticBase(beta=50.0, zeta=0.05), YieldingBase(beta=50.0, zeta=0.05, eta=3.0)]
)
def test_a_heavy_rigid_shaft_says_that_bending_is_left_out_and_a_light_one_does_not(base):
    table = runs([0.3], name="other", impacts=0, **SHEAR | {"forces_error": 0.0})
    heavy, light = (
        judged(table, one=of_pier(pier, base), demand="base_shear_kN", at_most=4000.0) for pier in (PIER, LIGHT)
    )
    assert (heavy.verdict, heavy.omits, light.verdict, light.omits) == ("pass", (BENDING,), "pass", ())
    assert "1.6 to 2.9 times" in heavy.note
    place, sections = in_sections(table, "section_shear_kN", sections_error=0.0)
    rules = [Rule(name, name, 5e4, **place) for name in ("section_shear_kN", "section_moment_kNm", "section_axial_kN")]
    found = judge(rules, table, [of_pier(PIER, base)], sections=sections)
    assert [one.omits for one in found] == [(BENDING,), (BENDING,), ()]


@pytest.mark.parametrize(
    ("loss", "omits"),
    [({}, (IMPULSES,)), ({"epsilon": 0.05}, (IMPULSES,)), ({"impact": "housner"}, (IMPULSES,)), ({"epsilon": 1.0}, ()),
     ({"zeta": 0.05}, ())],
)  # fmt: skip
def test_a_landing_on_springs_that_an_impulse_stops_leaves_its_force_open(loss, omits):
    """By default ε is 0. The springs take no more than what the impulse leaves of a landing."""
    pads, ask = case(base=ElasticBase(beta=50.0, **loss)), {"demand": "pivot_force", "at_most": 3.0}
    forces = {"pivot_force_left": 2.0, "pivot_force_right": 2.0, "base_shear_m_s2": 1.0, "forces_error": 0.0}
    table = runs([0.3], name="pads", impacts=3, **forces)
    found = judged(table, one=pads, **ask)
    assert (found.verdict, found.omits) == ("not decided" if omits else "pass", omits)
    beyond = judged(table, one=pads, **ask | {"at_most": 1.9})
    assert (beyond.verdict, beyond.omits) == ("fail", omits)
    standing = judged(table.assign(impacts=0), one=pads, **ask)
    assert (standing.verdict, standing.omits) == ("pass", ())


def test_by_zeta_a_landing_has_more_than_twice_the_force_that_it_has_by_epsilon():
    """The verdict by ε is open, and the advice that it gives decides."""
    pier = Pier.rectangle(6.0, 30.0, mass_t=2200.0)
    motion = pulse("sine", name="p", amplitude=4.0, period=1.5, dt=0.005, duration=4.0)
    verdicts_of, forces = {}, {}
    for loss in ("epsilon", "zeta"):
        base = ElasticBase.from_stiffness(pier, 2e7, **{loss: 0.05})
        response = simulate(pier, base, motion, forces=True)
        one = describe_case(Case(base.name, pier, base, {}))
        rule = Rule("foot", "pivot_force_kN", at_most=1e5, reason="crushing")
        (found,) = judge([rule], pd.DataFrame([response.row]), [one])
        verdicts_of[loss], forces[loss] = found.verdict, found.value
    assert verdicts_of == {"epsilon": "not decided", "zeta": "fail"}
    assert forces["zeta"] > 2.0 * forces["epsilon"]


@pytest.mark.parametrize("ratio", [0.05, 0.19, 0.21, 1.0, 7.0])
def test_the_share_of_the_shaft_is_that_of_its_parts_and_that_which_mu_tells(ratio):
    deck = 1000.0
    pier = Pier.of_parts(4.0, [Part(ratio * deck, 20.0, ratio * deck * 40.0**2 / 12.0, 40.0), Part(deck, 40.0, 0.0, 0.0)],
                         confirm=("width_m", "mass_t"))  # fmt: skip
    assert pier.shaft_share == pytest.approx(ratio / (1.0 + ratio))
    assert replace(pier, parts=None).shaft_share == pytest.approx(ratio / (1.0 + ratio))
    assert describe_case(Case("other", pier, RigidBase(), {}))["pier"]["shaft_share"] == pier.shaft_share


def test_a_mass_within_the_height_is_of_the_shaft_and_a_rectangle_is_all_shaft():
    parts = [Part(100.0, 10.0, 4000.0, 20.0), Part(500.0, 12.0, 0.0, 0.0), Part(400.0, 21.0, 0.0, 0.0)]
    assert Pier.of_parts(4.0, parts, confirm=("width_m", "mass_t")).shaft_share == pytest.approx(0.6)
    assert Pier.rectangle(4.0, 20.0).shaft_share == Pier(alpha=0.13, p=0.38).shaft_share == 1.0
    column = Pier.rectangle(1.6, 9.6, mass_t=60.0)
    assert Pier.frame(column, 3, 900.0).shaft_share == pytest.approx(180.0 / 1080.0)


def test_a_footing_below_a_shaft_is_not_of_its_mass():
    """A slab 2 m high and 10 m wide under a shaft; alone, or above the pivots, or as wide as high it is shaft."""
    deck, shaft = Part(600.0, 24.0, 0.0, 0.0), Part.rectangle(200.0, 12.0, 20.0, 4.0)
    slab, raised = Part.rectangle(200.0, 1.0, 2.0, 10.0), Part.rectangle(200.0, 1.5, 2.0, 10.0)
    square = Part.rectangle(200.0, 1.0, 2.0, 2.0)

    def share(*parts):
        return Pier.of_parts(10.0, parts, confirm=("width_m", "mass_t")).shaft_share

    assert share(slab, shaft, deck) == pytest.approx(0.25)
    assert share(raised, shaft, deck) == share(square, shaft, deck) == pytest.approx(0.4)
    assert share(slab, Part(600.0, 2.0, 0.0, 0.0)) == pytest.approx(0.25)


def test_the_first_screen_says_what_an_undecided_and_a_green_check_leave_out():
    omitting = verdict("rock", "not decided", check="shear", high=math.inf, value=0.2, omits=("landings", "bending"))
    also = verdict("rock", "not decided", check="foot", high=math.inf, value=0.2, omits=("landings",))
    passing = verdict("feet", "pass", check="shear", omits=("bending",))
    lines = answer([omitting, also, passing], (), lambda one: one.case, lambda one: one.record)
    words = {line.verdict: " ".join(line.details) for line in lines}
    assert f"shear, foot: {OMISSIONS[LANDINGS].remark}." in words["not decided"]
    assert words["not decided"].count("landings") == 1
    assert f"shear: {OMISSIONS[BENDING].remark}." in words["pass"]
    card = scorecard([omitting, also, passing], lambda one: one.case)
    rock = next(row for row in card.rows if row.name == "rock")
    assert (rock.verdict, {cell.percent for cell in rock.cells}) == ("not decided", {"≥\u00a050\u00a0%"})


@pytest.mark.parametrize(
    ("omits", "percent"), [((LANDINGS,), "≥\u00a050\u00a0%"), ((MODES,), "50\u00a0%"), ((), "≥\u00a050\u00a0%")]
)
def test_a_force_without_its_last_mode_is_no_lower_bound(omits, percent):
    """What the mode adds may have either sign."""
    one = verdict("rock", "not decided", check="shear", value=0.25, ratio=0.5, high=math.inf, omits=omits)
    assert one.is_lower_bound == (omits != (MODES,))
    assert scorecard([one], lambda one: one.case).rows[0].cells[0].percent == percent


def test_what_is_left_out_is_a_column_of_the_verdicts_and_no_other_word_is_read(tmp_path):
    table = runs([0.3], name="rigid", impacts=4, **SHEAR)
    found = [judged(table, one=RIGID, demand="base_shear_kN", at_most=4000.0)]
    path = write_verdicts(tmp_path, found)
    assert [one.omits for one in read_verdicts(tmp_path)] == [(LANDINGS, BENDING)]
    assert as_table(found)["omits"].tolist() == ["landings, bending"]
    path.write_text(path.read_text().replace("landings, bending", "nothing"))
    with pytest.raises(InputError, match="damaged"):
        read_verdicts(tmp_path)


@pytest.mark.parametrize(("pier", "omits"), [(LIGHT, ()), (PIER, (BENDING,))])
def test_results_of_an_earlier_version_have_the_shaft_that_mu_tells(tmp_path, pier, omits):
    old = of_pier(pier, ElasticBase(beta=50.0, zeta=0.05))
    old["pier"].pop("shaft_share", None)
    table = runs([0.3], name="other", impacts=4, **SHEAR)
    text = '[[check]]\nname = "shear"\ndemand = "base_shear_kN"\nat_most = 4000.0\nreason = "keys"\n'
    (found,) = verdicts(folder(tmp_path / "old", table, [old], text))
    assert (found.verdict, found.omits) == ("pass", omits)


@pytest.mark.parametrize(("amplitudes", "decided"), [((0.03, 0.05), "pass"), ((0.03, 0.5), "not decided")])
def test_a_study_is_decided_on_rigid_ground_only_if_its_pier_never_lands(tmp_path, amplitudes, decided):
    """A pier of 4 m × 30 m lifts off at 0.13 g."""
    pier = {"width_m": 4.0, "height_m": 30.0, "mass_t": 1000.0}
    pulses = [SINE | {"name": f"{amplitude}", "amplitude_g": amplitude} for amplitude in amplitudes]
    checks = [
        {"name": demand, "demand": demand, "at_most": 1e6, "reason": "keys", "confirm": ["at_most"]} | place
        for demand, place in (("base_shear_kN", {}), ("section_moment_kNm", {"at_m": 15.0}), ("omega_max_over_p", {}))
    ]
    output = {"forces": True, "sections": 3, "histories": "none"}
    path = write_study(tmp_path, study_text(pier=pier, pulses=pulses, cases=(ROCK,), output=output, check=checks))
    assert main(["run", str(path), "--out", str(tmp_path / "out")]) == (decided != "pass")
    assert [one.verdict for one in read_verdicts(tmp_path / "out")] == [decided, decided, "pass"]


STATISTICS = {
    "max": lambda values: max(values), "mean": lambda values: sum(values) / len(values),
    "median": lambda values: float(np.sort(values)[len(values) // 2]),  # of an odd number
}  # fmt: skip


@pytest.mark.sweep(fast=40)
@pytest.mark.parametrize("seed", range(150))
def test_random_checks_are_decided_only_if_a_separate_judge_omits_no_force(seed):
    """The judge here knows rows only: a run that an impulse stopped may have any greater force, one mode any at all.

    Across a shaft of several modes a landing has a force.
    """
    rng = np.random.default_rng(seed)
    base = [RigidBase(), RigidBase(shaft="elastic", flexural_modes=int(rng.integers(1, 3))),
            RigidBase(restraints=(Damper("hysteretic", f=0.1, yield_m=0.005),)),
            ElasticBase(beta=60.0, zeta=0.05), YieldingBase(beta=60.0, eta=3.0, epsilon=0.2)][int(rng.integers(5))]  # fmt: skip
    demand = str(
        rng.choice(["base_shear_kN", "theta_max_over_alpha", "key_shear_kN", "omega_max_over_p", "friction_demand"])
    )
    n, statistic = 2 * int(rng.integers(1, 5)) + 1, str(rng.choice(list(STATISTICS)))
    values, errors = rng.uniform(0.1, 0.9, n), rng.uniform(0.0, 0.05)
    impacts = rng.integers(0, 4, n) * rng.integers(0, 2, n)
    limit, theta = float(rng.uniform(0.1, 0.9)), demand == "theta_max_over_alpha"
    cells = (
        {"theta_max_error": errors * values}
        if theta
        else {demand: values, "forces_error": errors, "base_shear_m_s2": 1.0}
    )
    table = runs(values, name="one", impacts=impacts, **cells)
    found = judged(
        table, one=of_pier(FLEXIBLE, base) | {"case": "one"}, demand=demand, at_most=limit, statistic=statistic
    )

    forced, alone = demand in ENTERED, base.bends and base.flexural_modes == 1
    lows = [0.0 if forced and alone else value * (1.0 - errors) for value in values]
    stopped = not (base.bends or (base.on_springs and base.zeta))
    highs = [
        math.inf if forced and (alone or (stopped and landed)) else value * (1.0 + errors)
        for value, landed in zip(values, impacts, strict=True)
    ]
    low, high = (STATISTICS[statistic](bounds) for bounds in (lows, highs))
    expected = "fail" if low > limit else "pass" if high <= limit else "not decided"
    assert (found.verdict, found.low, found.high) == (expected, pytest.approx(low), pytest.approx(high))
    if expected == "not decided" and math.isinf(high):
        assert found.left_open in (LANDINGS, IMPULSES, MODES)


@pytest.mark.parametrize(
    ("name", "cells"),
    [(SLIDES, {"slides": 1}), (LINEARISED, {"beyond_linearised": 1}), (FLIGHTS, {"flight_height_m": 6e-3})],
)
@pytest.mark.parametrize("demand", ["theta_max_over_alpha", "overturned"])
def test_a_pass_says_if_a_run_moves_as_the_model_does_not_follow(demand, name, cells):
    """By default the keys guide a pier that flies up to 5 mm."""
    table = runs([0.1, 0.2], name="damped", theta_max_error=1e-5)
    for moved, omits in ((table.assign(**cells), (name,)), (table.assign(**dict.fromkeys(cells, 0)), ()), (table, ())):
        found = judged(moved, one=DAMPED, demand=demand, at_most=0.5)
        assert (found.verdict, found.omits, bool(found.note)) == ("pass", omits, bool(omits))
    assert judged(table.assign(**cells), one=DAMPED, demand="failed", at_most=0.5).omits == ()
    left_out = table.assign(**{column: [0, value] for column, value in cells.items()}, status=["ok", "overturned"])
    assert name not in judged(left_out, one=DAMPED, overturned="left out").omits


def test_a_limit_on_the_height_of_flights_omits_none_of_them():
    table = runs([0.1], name="damped", theta_max_error=1e-5, flight_height_m=6e-3, flights=1, flight_duration_s=0.1)
    for demand, omits in (("flight_height_m", ()), ("flights", (FLIGHTS,))):
        assert [name for name in judged(table, one=DAMPED, demand=demand, at_most=9.0).omits if name == FLIGHTS] == [
            *omits
        ]
    assert "flight_limit_mm (5 unless given)" in OMISSIONS[FLIGHTS].remark


def test_a_friction_demand_says_that_keys_carry_the_shear_of_a_light_contact():
    table = runs([0.1, 0.2], name="damped", friction_demand=0.3, key_shear_m_s2=[math.nan, 2.0], **SHEAR)
    asked = {"one": DAMPED, "demand": "friction_demand", "at_most": 0.5}
    assert judged(table, **asked).omits == (BENDING, KEYS)
    assert judged(table.assign(key_shear_m_s2=math.nan), **asked).omits == (BENDING,)
    assert judged(table, **asked | {"demand": "base_shear_kN", "at_most": 9000.0}).omits == (BENDING,)


@pytest.mark.parametrize(
    ("demand", "above"),
    [
        ("settlement_m", (SHAKEDOWN,)),
        ("edge_settlement_m", (SHAKEDOWN,)),
        ("theta_max_over_alpha", ()),
        ("base_tilt_rad", ()),
        ("theta_res_over_alpha", ()),
    ],
)
def test_a_settlement_above_a_safety_factor_of_two_is_said_to_be_a_lower_bound(demand, above):
    """Its residual rotations have either sign in them."""
    table = runs(
        [0.1], name="foot", theta_max_error=1e-5, settlement_m=0.05, settlement_error_m=1e-4, base_tilt_rad=1e-3,
        theta_res_over_alpha=1e-2, theta_res_error=1e-4, settlement_left_m=0.06, settlement_right_m=0.04,
            edge_settlement_error_m=1e-4,
    )  # fmt: skip
    for factor, omits in ((2.0, ()), (2.1, above)):
        foot = case("foot", FootingBase(beta=60.0, safety_factor=factor))
        found = judged(table, one=foot, demand=demand, at_most=0.5)
        assert (found.verdict, found.omits) == ("pass", omits)
    on_pads = judged(table, one=case("foot"), demand=demand, at_most=0.5)
    assert SHAKEDOWN not in on_pads.omits


def test_what_grows_until_the_run_ends_is_said_to_be_a_lower_bound():
    """Counts, energies of devices, travel, work and half cycles of dampers, and those of a bed; strokes and rotations are not."""
    grow = {name for name, demand in DEMANDS.items() if demand.cumulative}
    assert grow == {
        *(f"{device}_energy_J_kg" for device in ("damper", "stop", "deck_spring")),
        *("damper_travel_m", "damper_work_J_kg", "damper_work_kJ", "damper_half_cycles"),
        *("impacts", "separations", "flights", "flight_duration_s", "yielding_half_cycles", "bed_work_J_kg"),
    }
    oil = case("oil", RigidBase(restraints=(Damper("viscous", nu=0.3),)))
    table = runs(
        [0.1], name="oil", theta_max_error=1e-5, damper_energy_J_kg=0.2, damper_stroke_m=0.02, devices_error=1e-4
    )
    limited = [
        judged(table, one=oil, demand=demand, at_most=0.5) for demand in ("damper_energy_J_kg", "damper_stroke_m")
    ]
    assert [(found.verdict, found.omits) for found in limited] == [("pass", (TAIL,)), ("pass", ())]


@pytest.mark.parametrize(
    ("demand", "open_"),
    [
        *(
            (demand, True)
            for demand in (
                "normal_force_kN",
                "landing_velocity_m_s",
                "damper_stroke_m",
                "section_axial_kN",
                "impacts",
                "flights",
            )
        ),
        *((demand, False) for demand in ("theta_max_over_alpha", "heel_uplift_m", "heel_gap_m", "overturned")),
    ],
)
def test_a_run_that_ends_before_a_harder_landing_decides_no_force_that_it_could_pass(demand, open_):
    """On rigid ground too, before the first of all; what exceeds its limit fails."""
    oil = case("oil", RigidBase(restraints=(Damper("viscous", nu=0.3),)))
    cells = {"normal_force_kN": 0.2, "damper_stroke_m": 0.2, "landing_velocity_m_s": math.nan, "flights": 0}
    cells |= {"heel_gap_left_m": 0.2, "heel_gap_right_m": 0.1}
    errors = {"base_shear_m_s2": 1.0, "forces_error": 1e-6, "devices_error": 1e-6, "theta_max_error": 1e-5}
    table = runs([0.1, 0.2], name="oil", impacts=0, **errors, **cells)
    soon, later = table.assign(still_rocks=[1, 0]), table.assign(still_rocks=0)
    asked = {"one": oil, "demand": demand, "at_most": 9e4 if demand.startswith("section") else 0.5}
    found = judged(soon, **asked)
    assert (found.verdict, found.left_open) == (("not decided", STILL_ROCKS) if open_ else ("pass", ""))
    assert judged(later, **asked).verdict == judged(table, **asked).verdict == "pass"
    if demand in ("normal_force_kN", "damper_stroke_m"):
        assert judged(soon, **asked | {"at_most": 0.1}).verdict == "fail"


@pytest.mark.parametrize(
    ("demand", "cells", "bases"),
    [
        ("top_drift_m", {"top_drift_m": 0.2, "top_drift_error_m": 1e-6}, {"bent"}),
        ("deflection_max_m", {"deflection_max_m": 0.2, "deflection_error_m": 1e-6}, {"bent"}),
        ("heel_gap_m", {"heel_gap_left_m": 0.2, "heel_gap_right_m": 0.1, "forces_error": 1e-6}, {"damped", "foot"}),
        ("bed_force_over_weight", {"bed_force_over_weight": 0.2, "bed_force_error": 1e-6}, {"foot"}),
        ("settlement_m", {"settlement_m": 0.2, "settlement_error_m": 1e-6}, set()),
    ],
)
def test_a_later_landing_leaves_what_it_may_raise_open_by_the_ground_and_the_shaft(demand, cells, bases):
    """Drift of a rigid shaft, and gaps on rigid ground, are those of the greatest rotation; a settlement has an error of it."""
    cases = {"bent": bent(), "damped": DAMPED, "rigid": RIGID, "foot": case("foot", FootingBase(60.0, 3.0))}
    table = runs([0.1], theta_max_error=1e-5, base_shear_m_s2=1.0, still_rocks=1, impacts=0, **cells)
    found = {
        name: judged(table.assign(case=name), one=one, demand=demand, at_most=0.5)
        for name, one in cases.items()
        if DEMANDS[demand].applies_to(one)
    }
    assert {name for name, its in found.items() if its.left_open == STILL_ROCKS} == bases
    assert all(its.verdict == ("not decided" if name in bases else "pass") for name, its in found.items())


def test_a_pass_says_that_springs_go_on_yielding_when_a_run_that_counts_is_read():
    """Ductility and settlements; a footing has no such drift."""
    cells = {"settlement_m": 0.01, "settlement_error_m": 1e-4, "ductility_left": 1.2, "ductility_right": 1.1}
    table = runs([0.1, 0.2], name="pads", theta_max_error=1e-5, base_tilt_rad=1e-3, theta_res_error=1e-4, **cells)
    pads = case("pads", YieldingBase(60.0, eta=3.0, zeta=0.05))
    for demand in ("ductility", "settlement_m", "toe_settlement_m", "theta_max_over_alpha"):
        for drift, goes_on in ((-2e-6, demand != "theta_max_over_alpha"), (5e-7, False), (math.nan, False)):
            drifting = table.assign(settlement_drift_m_s=[0.0, drift])
            found = judged(drifting, one=pads, demand=demand, at_most=2.0, confirm=["at_most"])
            assert (found.verdict, YIELDS_ON in found.omits) == ("pass", goes_on), (demand, drift)
    left_out = table.assign(settlement_drift_m_s=[0.0, 1e-3], status=["ok", "overturned"])
    assert YIELDS_ON not in judged(left_out, one=pads, demand="ductility", at_most=2.0, overturned="left out").omits


@pytest.mark.parametrize(("quiet_s", "found"), [(2.0, ["not decided", "not decided"]), (20.0, ["not decided", "fail"])])
def test_a_block_that_is_up_when_its_run_ends_passes_no_limit_on_its_landing(tmp_path, quiet_s, found):
    """A half-sine of 1.5 s, whose peak comes after it; the normal force of a landing on rigid ground is never decided."""
    pulse = {
        "name": "half",
        "shape": "half-sine",
        "amplitude_g": 0.38,
        "period_s": 3.0,
        "dt_s": 0.01,
        "duration_s": 1.5,
    }
    checks = [
        {"name": demand, "demand": demand, "at_most": most, "reason": "drawing", "confirm": ["at_most"]}
        for demand, most in (("normal_force_kN", 25e3), ("landing_velocity_m_s", 0.05))
    ]
    output = {"forces": True, "histories": "none"}
    pier = {"alpha": 0.13, "p": 0.35, "mass_t": 2000.0}
    more = {"output": output, "check": checks, "numerics": {"quiet_s": quiet_s}}
    path = write_study(tmp_path, study_text(pier=pier, pulses=[pulse], cases=(ROCK,), **more))
    assert main(["run", str(path), "--out", str(tmp_path / "out")]) == 1
    assert [one.verdict for one in read_verdicts(tmp_path / "out")] == found


def test_forces_in_a_section_say_that_they_have_no_tendon_in_them():
    held = case("damped", ElasticBase(beta=50.0, zeta=0.05, restraints=(Tendon(0.2, 10.0),)))
    table = runs([0.3], name="damped", **SHEAR)
    limits = {"section_axial_kN": 5e4, "section_moment_kNm": 5e4, "section_moment_over_capacity": 1.0}
    for demand, most in limits.items():
        omits = [judged(table, one=one, demand=demand, at_most=most).omits for one in (held, DAMPED)]
        assert [TENDONS in its for its in omits] == [True, False]
    assert TENDONS not in judged(table, one=held, demand="base_shear_kN", at_most=9000.0).omits
