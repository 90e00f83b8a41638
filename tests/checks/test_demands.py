"""Every demand is what an engineer computes by hand from a row, with its error, and does not apply where it has none."""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from check_samples import ELASTIC, PADS, PIER, RIGID, SECTION, case, in_sections, interaction_of, judged, runs

import rockbatch as rb
from rockbatch.checks import Rule, judge
from rockbatch.common.errors import InputError
from rockbatch.pier import Damper, DeckSpring, ElasticBase, FootingBase, RigidBase, Stop, Tendon, YieldingBase
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.catalogue import DEMANDS

INF = math.inf

ROW = {
    "theta_max_error": 0.001, "theta_res_over_alpha": -0.02, "theta_res_error": 0.0005, "base_tilt_rad": -0.0035,
    "settlement_m": 0.03, "ductility_left": 1.5, "ductility_right": 2.5, "impacts": 12, "separations": 13,
    "deflection_max_m": 0.07, "deflection_error_m": 0.0002,
}  # fmt: skip
FORCES = {
    "base_shear_m_s2": 3.0, "base_shear_kN": 9000.0, "base_moment_m2_s2": 15.0, "base_moment_kNm": 45000.0,
    "normal_force_m_s2": 12.0, "normal_force_kN": 36000.0, "friction_demand": 0.3, "impact_friction_demand": 0.15,
    "pivot_force_left": 2.2, "pivot_force_right": 2.1, "pivot_force_left_kN": 32373.0, "pivot_force_right_kN": 30901.5,
    "heel_gap_left_m": 0.1, "heel_gap_right_m": 0.15, "heel_speed_left_m_s": 0.7, "heel_speed_right_m_s": 0.6,
    "deck_acceleration_m_s2": 4.905, "landing_velocity_m_s": math.nan,  # no impact
    "impulse_m_s": 0.4, "impulse_kN_s": 1200.0, "omega_max_over_p": 0.2, "key_shear_m_s2": 1.5, "key_shear_kN": 4500.0,
    "flight_longest_s": 0.03,
}  # fmt: skip
DEVICES = {
    "damper_force_over_weight": 0.05, "damper_stroke_m": 0.12, "damper_speed_m_s": 0.4, "damper_energy_J_kg": 0.8,
    "tendon_force_over_weight": 0.3, "tendon_yield_m": 0.004, "tendon_slack": 2,
    "stop_force_over_weight": 0.6, "stop_deflection_m": 0.02, "stop_blows": 3, "stop_energy_J_kg": 0.1,
    "deck_spring_force_over_weight": 0.2, "deck_spring_deflection_m": 0.03, "deck_spring_blows": 5,
    "deck_spring_energy_J_kg": 0.2,
    "damper_travel_m": 1.5, "damper_work_J_kg": 0.5, "damper_work_kJ": 0.5 * 3000, "damper_half_cycles": 20,
    "tendon_strain_over_yield": 0.7,
}  # fmt: skip
BED = {"bed_force_over_weight": 1.7, "bed_pressure_MPa": 0.8, "yielding_half_cycles": 6, "bed_work_J_kg": 0.02}
EDGES = {"settlement_left_m": 0.01, "settlement_right_m": 0.025, "edge_settlement_error_m": 0.002}
FLIGHTS = {"flights": 2, "flight_duration_s": 0.05, "flight_height_m": 0.002}
ROW |= FORCES | DEVICES | FLIGHTS | BED | EDGES | {"flight_s": 1.2, "theta_rocking_over_alpha": 0.25}
TIED = case(
    base=replace(
        PADS,
        zeta=0.05,
        restraints=(Damper("viscous", nu=0.1), Tendon(psi=0.1, strength=0.5), Stop(0.1, 20.0), DeckSpring(0.2)),
    )
)
B, H = 7.3575 * math.sin(0.2), 7.3575 * math.cos(0.2)
TILT_OVER_RESIDUAL = 1 - 9.81 * H / (50.0 * B) ** 2
BY_HAND = {  # value and error for θ_max/α = 0.3, α = 0.2
    "theta_max_over_alpha": (0.3, 0.001), "theta_max_rad": (0.06, 0.0002), "top_drift_m": (2 * H * 0.06, 2 * H * 0.0002),
    "heel_uplift_m": (2 * B * 0.06, 2 * B * 0.0002), "theta_res_over_alpha": (0.02, 0.0005), "theta_res_rad": (0.004, 0.0001),
    "base_tilt_rad": (0.0035, 0.0001 * TILT_OVER_RESIDUAL),
    "differential_settlement_m": (2 * B * 0.0035, 2 * B * 0.0001 * TILT_OVER_RESIDUAL), "settlement_m": (0.03, 0.0),
    "toe_settlement_m": (0.03 + B * 0.0035, 0.0), "ductility": (2.5, 0.0), "impacts": (12, 0.0), "separations": (13, 0.0),
    "flight": (1, 0.0), **{name: (value, 0.0) for name, value in FLIGHTS.items()}, "overturned": (0, 0.0), "failed": (0, 0.0),
    "eta": (2.5, 0.0), "static_deflection_m": (9.81 / 50.0**2, 0.0), "yield_kN": (2.5 * 3000 * 9.81 / 2, 0.0),
    "stiffness_kN_m": (50.0**2 * 3000 / 2, 0.0), "top_drift_mm": (2000 * H * 0.06, 2000 * H * 0.0002),
    "drift_ratio": (0.06, 0.0002),
    "heel_uplift_mm": (2000 * B * 0.06, 2000 * B * 0.0002), "theta_rocking_over_alpha": (0.25, 0.0),
    **{name: (value, 0.0) for name, value in FORCES.items() if "left" not in name and "right" not in name},
    "pivot_force": (2.2, 0.0), "pivot_force_kN": (32373.0, 0.0), "heel_gap_m": (0.15, 0.0), "heel_gap_mm": (150.0, 0.0),
    "heel_speed_m_s": (0.7, 0.0), "deck_acceleration_g": (0.5, 0.0), "landing_velocity_m_s": (0.0, 0.0),
    **{name: (value, 0.0) for name, value in DEVICES.items()}, "damper_force_kN": (0.05 * 3000 * 9.81, 0.0),
    "tendon_force_kN": (0.3 * 3000 * 9.81, 0.0), "damper_stroke_mm": (120.0, 0.0), "stop_force_kN": (0.6 * 3000 * 9.81, 0.0),
    "stop_deflection_mm": (20.0, 0.0), "deck_spring_force_kN": (0.2 * 3000 * 9.81, 0.0),
    "deck_spring_deflection_mm": (30.0, 0.0), "section_shear_kN": (3000.0, 0.0), "section_moment_kNm": (40000.0, 0.0),
    "section_axial_kN": (30000.0, 0.0),
    "section_moment_over_capacity": (0.8, 0.0), "base_shear_over_capacity": (0.8, 0.0),
    "section_tension_kN": (200.0, 0.0), "deflection_max_m": (0.07, 0.0002),
    "deflection_max_mm": (70.0, 0.2), **{name: (value, 0.0) for name, value in BED.items()},
    "edge_settlement_m": (0.025, 0.002), "edge_settlement_mm": (25.0, 2.0), "safety_factor": (3.0, 0.0),
}  # fmt: skip
BY_IMPULSE = {"impulse_m_s", "impulse_kN_s", "impact_friction_demand"}
"""Demands of landings that an impulse stops."""
ON_FOOTING = {*BED, "edge_settlement_m", "edge_settlement_mm", "safety_factor"}
"""Demands that only a footing has."""


@pytest.mark.parametrize("demand", DEMANDS)
def test_every_demand_is_what_a_hand_computes_from_the_row(demand):
    value, error = BY_HAND[demand]
    one = case(base=RigidBase(shaft="elastic")) if demand.startswith("deflection_max") else TIED
    one = (
        case(base=FootingBase(50.0, safety_factor=3.0))
        if demand in ON_FOOTING
        else case()
        if demand in BY_IMPULSE
        else one
    )
    found = judged(runs([0.3], **ROW), one=one, demand=demand, at_most=1000.0)
    assert (found.low, found.value, found.high) == tuple(map(pytest.approx, (value - error, value, value + error)))


def test_a_demand_is_in_its_list_by_the_name_that_a_hand_computes():
    assert BY_HAND.keys() == DEMANDS.keys()


@pytest.mark.parametrize("name", DEMANDS)
def test_the_name_of_a_demand_ends_with_its_unit(name):
    plain = DEMANDS[name].unit.replace("²", "2").replace("/", "_")
    endings = {plain.replace(" ", "_"), plain.replace(" ", "")}
    assert not DEMANDS[name].unit or name.endswith(tuple(f"_{ending}" for ending in endings))
    assert DEMANDS[name].unit or not name.endswith(
        ("_m", "_mm", "_rad", "_s", "_s2", "_g", "_kN", "_kNm", "_kJ", "_kg", "_MPa")
    )


@pytest.mark.parametrize("demand", [name for name, demand in DEMANDS.items() if demand.needs == "forces"])
def test_the_error_of_forces_leaves_a_limit_within_it_undecided(demand):
    value, _ = BY_HAND[demand]
    row = ROW | {"forces_error": 0.02}
    one = case() if demand in BY_IMPULSE else TIED
    found = judged(runs([0.3], **row), one=one, demand=demand, at_most=max(1.01 * value, 1e-3))
    assert (found.low, found.high) == (pytest.approx(0.98 * value), pytest.approx(1.02 * value))
    assert found.verdict == ("not decided" if value else "pass")


@pytest.mark.parametrize("demand", [name for name, demand in DEMANDS.items() if demand.device])
def test_the_error_of_devices_leaves_a_limit_within_it_undecided(demand):
    value, _ = BY_HAND[demand]
    found = judged(runs([0.3], **ROW, devices_error=0.02), one=TIED, demand=demand, at_most=1.01 * value)
    share = 0.0 if demand in ("tendon_slack", "stop_blows", "deck_spring_blows", "damper_half_cycles") else 0.02
    assert (found.low, found.high) == (pytest.approx((1 - share) * value), pytest.approx((1 + share) * value))
    assert found.verdict == ("not decided" if share else "pass")


@pytest.mark.parametrize(
    ("reached", "error", "verdict"),
    [(0.6, 0.01, "fail"), (0.505, 0.01, "not decided"), (0.6, math.nan, "not decided"), (0.4, 0.01, "not decided")],
)
def test_a_run_that_failed_after_its_motion_breaks_a_limit_that_it_passed_before(reached, error, verdict):
    failed = runs([0.9], status="failed", reason="left alone")
    failed[["theta_max_in_motion_over_alpha", "theta_max_in_motion_error"]] = reached, error
    found = judged(pd.concat([failed, runs([0.1], record="other", station="other")]))
    assert (found.verdict, found.high) == (verdict, INF)
    assert found.low == pytest.approx(0.1 if math.isnan(error) else reached - error)
    assert ("no error estimate" in found.remarks) == math.isnan(error)
    radians = judged(failed, demand="theta_max_rad", at_most=0.5 * 0.2)
    assert radians.verdict == verdict
    assert judged(failed, demand="settlement_m", at_most=0.0).verdict == "not decided"


def test_a_demand_on_a_device_does_not_apply_to_a_pier_without():
    others = {
        "damper": Tendon(psi=0.1),
        "tendon": Stop(0.1, 20.0),
        "stop": DeckSpring(0.2),
        "deck_spring": Stop(0.1, 20.0),
    }
    for device, only in others.items():
        rules = [Rule(name, name, 100.0) for name, demand in DEMANDS.items() if demand.device == device]
        for restraints in ((), (only,)):
            one = case(base=replace(PADS, restraints=restraints))
            found = {(each.verdict, each.note) for each in judge(rules, runs([0.3], damper_travel_m=math.nan), [one])}
            assert found == {("does not apply", f"the pier has no {device}")}


def of_every_base():
    return pd.concat([runs([0.3], name, **ROW) for name in ("rigid", "elastic", "pads")])


def test_a_demand_that_a_base_does_not_have_does_not_apply():
    table = of_every_base()
    _, sections = in_sections(table, "section_shear_kN")
    demands = [name for name, demand in DEMANDS.items() if not demand.device]
    rules = [Rule(name, name, 100.0, **in_sections(table, name)[0]) for name in demands]
    found = judge(rules, table, [RIGID, ELASTIC, case()], sections=sections, interaction=interaction_of(table))
    springs = {"theta_res_over_alpha", "theta_res_rad", "base_tilt_rad", "differential_settlement_m", "settlement_m",
               "toe_settlement_m", "static_deflection_m", "stiffness_kN_m"}  # fmt: skip
    yielding, others = {"eta", "ductility", "yield_kN"}, ON_FOOTING | {"deflection_max_m", "deflection_max_mm"}
    missing = {"rigid": yielding | springs, "elastic": yielding | springs - {"static_deflection_m", "stiffness_kN_m"}}
    assert len(found) == 3 * len(demands)
    for each in found:
        absent = each.demand in missing.get(each.case, set()) | others
        assert (each.verdict == "does not apply") == absent, each.demand


SET = {"settlement_m", "toe_settlement_m", "base_tilt_rad", "differential_settlement_m"}
OF_BED = {"edge_settlement_m", "edge_settlement_mm", "yielding_half_cycles", "bed_work_J_kg"}
RESIDUAL = {"theta_res_over_alpha", "theta_res_rad"}


@pytest.mark.parametrize(
    ("base", "demands", "lack"),
    [
        (ElasticBase(beta=50.0, zeta=0.05), SET, "the supports of the case do not yield"),
        (FootingBase(50.0), SET | OF_BED, "the supports of the case do not yield"),
        (YieldingBase(beta=50.0, eta=2.5, zeta=0.05), SET, ""),
        (FootingBase(50.0, safety_factor=3.0), SET | OF_BED, ""),
        (ElasticBase(beta=50.0, zeta=0.05), RESIDUAL, "nothing in the case keeps the pier at a tilt"),
        (ElasticBase(beta=50.0, restraints=(Damper("viscous", nu=0.1),)), RESIDUAL,
         "nothing in the case keeps the pier at a tilt"),
        (ElasticBase(beta=50.0, restraints=(Damper("friction", f=0.1),)), RESIDUAL, ""),
        (ElasticBase(beta=50.0, restraints=(Tendon(psi=0.1, at="left"),)), RESIDUAL, ""),
        (RigidBase(restraints=(Tendon(psi=0.1),)), {"tendon_yield_m"}, "the pier has no yielding tendon"),
        (RigidBase(restraints=(Tendon(psi=0.1, strength=0.5),)), {"tendon_yield_m"}, ""),
        (FootingBase(50.0, safety_factor=3.0), {"impacts", "landing_velocity_m_s"},
         "on a bed of strips a landing is a force, and no impact"),
        (FootingBase(50.0, safety_factor=3.0), BY_IMPULSE, "a landing is a force in this case, and no impulse"),
        (ElasticBase(beta=50.0, zeta=0.05), BY_IMPULSE, "a landing is a force in this case, and no impulse"),
        (ElasticBase(beta=50.0, epsilon=1.0), BY_IMPULSE, "a landing is a force in this case, and no impulse"),
        (ElasticBase(beta=50.0, zeta=0.05), {"impacts", "landing_velocity_m_s"}, ""),
        (ElasticBase(beta=50.0), BY_IMPULSE, ""),
        (ElasticBase(beta=50.0, impact="housner"), BY_IMPULSE, ""),
        (RigidBase(), BY_IMPULSE | {"impacts", "landing_velocity_m_s"}, ""),
    ],
)  # fmt: skip
def test_what_is_zero_in_every_run_of_a_model_passes_no_check(base, demands, lack):
    """A bed that does not yield does not settle, and a dashpot stops no landing by an impulse, whatever the motion is."""
    zeros = dict.fromkeys((*ROW, "edge_settlement_error_m"), 0.0)
    table = runs([0.3], **zeros | {"theta_max_error": 1e-4})
    for demand in demands:
        found = judged(table, one=case(base=base), demand=demand, at_most=1.0)
        assert (found.verdict, found.note if lack else "") == ("does not apply" if lack else "pass", lack), demand


@pytest.mark.parametrize(("limit", "verdict"), [(1.1, "pass"), (1.3, "does not apply")])
def test_a_limit_that_the_pressure_of_one_bed_never_exceeds_judges_the_others_alone(limit, verdict):
    """Bearing strength: 3 times a weight of 29.43 MN on 2.923 m × 25 m. The other bed has none."""
    table = runs([0.3], bed_pressure_MPa=1.0, bed_pressure_error_MPa=1e-3)
    yields, elastic = (case(base=FootingBase(50.0, length_m=25.0, safety_factor=factor)) for factor in (3.0, None))
    found = judged(table, one=yields, demand="bed_pressure_MPa", at_most=limit)
    assert (found.verdict, "does not occur, as the bed yields there" in found.note) == (verdict, verdict != "pass")
    assert judged(table, one=elastic, demand="bed_pressure_MPa", at_most=limit).verdict == "pass"
    assert judged(table, one=yields, demand="bed_pressure_MPa", at_most=limit, confirm=("at_most",)).verdict == "pass"


def test_a_check_of_drift_takes_that_of_a_shaft_that_bends_and_not_its_rotation():
    """Its rotation is within the limit, 2h θ = 0.87 m; its drift, by bending too, is not."""
    bent = case(base=RigidBase(shaft="elastic"))
    table = runs([0.3], theta_max_error=0.001, top_drift_m=1.2, top_drift_error_m=0.003)
    for demand, factor in (("top_drift_m", 1.0), ("top_drift_mm", 1000.0), ("drift_ratio", 0.5 / H)):
        found = judged(table, one=bent, demand=demand, at_most=factor)
        assert (found.verdict, found.value) == ("fail", pytest.approx(1.2 * factor))
        assert found.high - found.value == pytest.approx(0.003 * factor)
        assert judged(table, demand=demand, at_most=factor).verdict == "pass"


@pytest.mark.parametrize(("kind", "applies"), [("friction", True), ("hysteretic", True), ("viscous", False)])
def test_a_rigid_base_has_a_residual_rotation_if_dampers_may_hold_the_pier(kind, applies):
    damper = Damper(
        kind, **{"viscous": {"nu": 0.1}, "friction": {"f": 0.8}, "hysteretic": {"f": 0.8, "yield_m": 0.01}}[kind]
    )
    one = case("rigid", RigidBase(restraints=(damper,)))
    for demand, value in (("theta_res_over_alpha", 0.02), ("theta_res_rad", 0.004)):
        found = judged(runs([0.3], "rigid", **ROW), one=one, demand=demand, at_most=0.01)
        assert found.verdict == (("fail" if value > 0.01 else "pass") if applies else "does not apply")
    assert judged(runs([0.3], "rigid", **ROW), one=one, demand="base_tilt_rad").verdict == "does not apply"


def test_a_sections_error_is_a_share_of_its_force_or_of_the_greatest_axial():
    for demand, value, error in (
        ("section_shear_kN", 3000.0, 30.0), ("section_moment_kNm", 40000.0, 400.0), ("section_axial_kN", 30000.0, 300.0),
        ("section_tension_kN", 200.0, 300.0),
    ):  # fmt: skip
        place, sections = in_sections(runs([0.3]), demand, sections_error=0.01)
        (found,) = judge([Rule("check", demand, 1e6, **place)], runs([0.3], impacts=0), [case()], sections=sections)
        assert (found.value, found.high) == (value, pytest.approx(value + error))
        assert found.words == f"maximum of {demand} at 7.5 m"


def test_a_check_of_a_section_takes_the_rows_of_its_height_and_of_its_run():
    table = runs([0.1, 0.2, 0.3], impacts=0)
    names = table[["record", "case", "polarity", "scale"]]
    moments = {0.0: (5.0, 9.0, 7.0), 7.5: (3.0, 1.0, 2.0)}
    sections = pd.concat(
        [names.assign(height_m=z, section_moment_kNm=m, sections_error=0.0) for z, m in moments.items()]
    )
    rules = [Rule("foot", "section_moment_kNm", 8.0, at_m=0.0), Rule("above", "section_moment_kNm", 4.0, at_m=7.5)]
    foot, above = judge(rules, table, [case()], sections=sections.sample(frac=1.0, random_state=1))
    assert (foot.value, foot.record, foot.verdict) == (9.0, "r1", "fail")
    assert (above.value, above.record, above.verdict) == (3.0, "r0", "pass")
    lower = runs([0.1], "rigid")
    both = pd.concat([table, lower])
    found = judge(rules[1:], both, [RIGID, case()], sections=sections)
    assert [(each.case, each.verdict) for each in found] == [("rigid", "does not apply"), ("pads", "pass")]
    assert found[0].note == "the pier has no section at 7.5 m"
    unread = judge(
        rules[:1], pd.concat([table, runs([0.1], record="late", station="late")]), [case()], sections=sections
    )
    assert (unread[0].low, unread[0].high) == (9.0, INF)


def test_a_check_of_a_section_with_nothing_above_it_does_not_apply():
    """At the top of a pier without a deck there is nothing to bear, whatever the motion is."""
    table, nothing = runs([0.1], impacts=0), dict.fromkeys(SECTION, 0.0)
    for demand in ("section_shear_kN", "section_moment_kNm", "section_axial_kN", "section_tension_kN"):
        for cells, verdict, note in (
            (nothing, "does not apply", "nothing of the pier is above 7.5 m"),
            ({}, "pass", ""),
        ):
            place, sections = in_sections(table, demand, **cells | {"sections_error": 0.0})
            (found,) = judge(
                [Rule("check", demand, 1e6, **place)], table, [case(base=replace(PADS, zeta=0.05))], sections=sections
            )
            assert (found.verdict, found.note if note else "") == (verdict, note)


@pytest.mark.parametrize(("width", "height"), [(4.0, 24.0), (4.0, 30.0), (5.0, 30.0)])
def test_nothing_is_above_the_top_of_a_pier_whatever_its_height_rounds_to(tmp_path, width, height):
    """Twice the half height of 4 × 30 m is 4e-15 m more than 30 m."""
    motion = rb.pulse("sine", name="pulse", amplitude=4.0, period=1.0, dt=0.01, duration=3.0)
    shaft = {"width_m": width, "height_m": height, "mass_t": 800.0}
    top = {"name": "top", "demand": "section_axial_kN", "at_m": height, "at_most": 1.0, "reason": "drawing 12"}
    tables = {"title": "top", "pier": shaft, "case": [{"name": "rock", "base": "rigid"}], "output": {"forces": True}}
    tables["output"] |= {"sections_m": [0.0, height]}
    rb.run(rb.Study.from_dict(tables | {"check": [top]}, motions=[motion]), out=tmp_path / "out")
    (found,) = rb.check(tmp_path / "out").to_dict("records")
    assert (found["verdict"], found["note"]) == ("does not apply", f"nothing of the pier is above {height:g} m")


@pytest.mark.parametrize(
    ("sections", "message"),
    [
        (None, r'demand = "section_shear_kN": there are no forces in sections; write sections = 5 under \[output\]'),
        ((0.0, 15.0), "at_m = 7.5: there is no section at this height; there are 0, 15"),
    ],
)
def test_a_demand_in_a_section_is_refused_where_there_is_none(sections, message):
    table = None if sections is None else runs(sections).assign(height_m=sections)
    with pytest.raises(InputError, match=message):
        judge([Rule("check", "section_shear_kN", 1.0, at_m=7.5)], runs([0.3]), [case()], sections=table)


def test_a_height_goes_with_demands_in_sections_only():
    with pytest.raises(InputError, match="at_m is missing, the height of the section"):
        Rule("check", "section_shear_kN", 1.0)
    with pytest.raises(InputError, match="at_m: is for demands in a section"):
        Rule("check", "base_shear_kN", 1.0, at_m=7.5)


def test_a_demand_of_forces_is_refused_where_nobody_asked_for_them():
    demands = [name for name, demand in DEMANDS.items() if demand.needs == "forces"]
    with pytest.raises(InputError) as caught:
        judge([Rule(demand, demand, 100.0) for demand in demands], runs([0.3]), [case()])
    for demand, problem in zip(demands, caught.value.messages, strict=True):
        assert f'demand = "{demand}": there is no column of forces; write forces = true under' in problem


def test_a_force_of_a_pier_that_nobody_has_weighed_does_not_apply():
    one = TIED | {"pier": {key: value for key, value in TIED["pier"].items() if key != "mass_t"}}
    table = runs([0.3], **FORCES | DEVICES)
    _, sections = in_sections(table, "section_shear_kN")
    demands = [name for name, demand in DEMANDS.items() if demand.weighed and name not in ON_FOOTING | BY_IMPULSE]
    rules = [Rule(name, name, 100.0, **in_sections(table, name)[0]) for name in demands]
    found = {
        (each.verdict, each.note)
        for each in judge(rules, table, [one], sections=sections, interaction=interaction_of(table))
    }
    assert found == {("does not apply", "the study does not state the pier's mass")}


def test_a_force_that_an_earlier_version_did_not_write_is_unknown_and_not_none():
    earlier = runs([0.3], **{name: value for name, value in FORCES.items() if not name.startswith("base_moment")})
    assert judged(earlier, demand="base_moment_kNm", at_most=100.0).verdict == "not decided"


def test_a_friction_demand_without_limit_fails():
    found = judged(runs([0.3], **FORCES | {"friction_demand": INF}), demand="friction_demand", at_most=0.5)
    assert (found.value, found.verdict) == (INF, "fail")


def test_the_worked_values_belong_to_the_sample_pier():
    """b = R0 sin α and h = R0 cos α with R0 = ¾ · 9.81 m."""
    assert (PIER.half_width, PIER.height) == (pytest.approx(B), pytest.approx(H))


@pytest.mark.parametrize(
    ("demand", "status", "flight_s", "low", "high"),
    [
        ("flight", "flight", 3.0, 1, 1), ("flight", "ok", 3.0, 1, 1),  # guided: the run went on
        ("flight", "failed", math.nan, 0, 1), ("flight", "overturned", math.nan, 0, 0),
        ("overturned", "overturned", math.nan, 1, 1), ("overturned", "flight", 3.0, 0, 1),
        ("overturned", "failed", math.nan, 0, 1), ("failed", "failed", math.nan, 1, 1), ("failed", "flight", 3.0, 0, 0),
    ],
)  # fmt: skip
def test_an_event_is_unknown_where_the_run_ended_before(demand, status, flight_s, low, high):
    found = judged(runs([0.1], status=status, flight_s=flight_s), demand=demand, at_most=0)
    assert (found.low, found.high) == (low, high)
    assert found.verdict == (
        "fail" if low else "not decided"
    )  # where it is known not to occur, the other end is not checked


@pytest.mark.parametrize("demand", FLIGHTS)
@pytest.mark.parametrize(
    ("status", "flight_s", "low", "high"),
    [("ok", math.nan, 0, 0), ("flight", 1.2, 0, INF), ("failed", math.nan, 0, INF)],
)
def test_a_whole_run_without_a_flight_has_none_and_a_cut_one_may_have_any(demand, status, flight_s, low, high):
    found = judged(runs([0.1], status=status, flight_s=flight_s), demand=demand, at_most=0.5)
    assert (found.low, found.high) == (low, high)


@pytest.mark.parametrize("demand", FLIGHTS)
def test_a_column_of_flights_is_zero_without_one_and_unknown_if_not_run(demand):
    table = runs([0.1] * 4, status=["ok", "overturned", "failed", "ok"], flight_s=[math.nan, math.nan, math.nan, 1.0])
    np.testing.assert_array_equal(DEMANDS[demand].evaluate(Rows(table), case()).value, [0.0, 0.0, math.nan, math.nan])


def test_a_force_of_which_one_of_two_columns_is_missing_is_not_known_to_be_none():
    table = runs([0.3], **FORCES | {"pivot_force_left": math.nan}).drop(columns="pivot_force_right")
    assert np.isnan(DEMANDS["pivot_force"].evaluate(Rows(table), case()).value).all()


def test_a_run_with_two_sections_at_a_height_is_refused():
    _, sections = in_sections(table := runs([0.1, 0.3]), "section_shear_kN")
    with pytest.raises(InputError, match=r"a run has several sections at 7\.5 m"):
        judge(
            [Rule("check", "section_shear_kN", 1.0, at_m=7.5)],
            table,
            [case()],
            sections=pd.concat([sections, sections[:1]]),
        )


def test_events_are_counted_by_record():
    table = runs(
        [0.1] * 5, status=["ok", "flight", "ok", "flight", "ok"], flight_s=[math.nan, 3, math.nan, 4, math.nan]
    )
    assert judged(table, demand="flight", statistic="count", at_most=2).verdict == "pass"
    assert judged(table, demand="flight", statistic="count", at_most=1).value == 2
    assert judged(table, demand="flight", statistic="mean", at_most=1).value == pytest.approx(0.4)
