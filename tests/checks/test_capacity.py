"""The share of a capacity that a run uses: of moment, or shear, and axial force at one moment, against a polygon by hand."""

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from check_samples import case, runs

import rockbatch as rb
from rockbatch.checks import Rule, judge
from rockbatch.checks.capacity import line, problems, resistance, used
from rockbatch.observers.interaction.envelopes import FLATNESS, Envelope, envelope, thinned, with_errors
from rockbatch.observers.interaction.observe import InteractionInSections, with_values_between
from rockbatch.quantities.demands import OF_INTERACTION
from rockbatch.simulation import Run

CURVE = ((-2000.0, 0.0), (0.0, 30e3), (20e3, 60e3), (50e3, 0.0))
DEMAND = "section_moment_over_capacity"
SHEAR = "base_shear_over_capacity"


def rule(curve=CURVE, at_most=1.0, **more):
    return Rule("shaft", DEMAND, at_most, at_m=12.0, capacity=curve, reason="drawing 7", **more)


def corners(axial, moment, error=0.0, record="r0"):
    """Rows of interaction.csv of one run on pads."""
    rows = pd.DataFrame({"axial_kN": np.array(axial, dtype=float), "moment_kNm": np.array(moment, dtype=float)})
    known = {"height_m": 12.0, "shear_kN": np.nan, "interaction_error": error}
    return rows.assign(record=record, case="pads", polarity="+", scale=1.0, **known)


def at_base(normal, shear, error=0.0):
    """Rows of interaction.csv of the base in one run on pads."""
    rows = corners(normal, shear, error).rename(columns={"moment_kNm": "shear_kN", "shear_kN": "moment_kNm"})
    return rows.assign(height_m=np.nan)


def judged(rows, table=None, *, one=None, checked=None, **more):
    checks = [checked or rule(**more)]
    (verdict,) = judge(checks, runs([0.1], impacts=0) if table is None else table, [one or case()], interaction=rows)
    return verdict


def by_hand(curve, n, m):
    """Return M over the height of the polygon at N, by the side that N is beside; infinite beyond its ends."""
    for (n1, m1), (n2, m2) in pairwise(curve):
        if n1 <= n <= n2:
            most = m1 + (m2 - m1) * (n - n1) / (n2 - n1)
            return 0.0 if m == 0.0 else m / most if most > 0.0 else math.inf
    return math.inf


def random_curve(rng):
    """Return a concave curve of 4 to 7 points with its ends on the axis."""
    n = np.sort(rng.uniform(-1.0, 6.0, rng.integers(4, 8)))
    n[0], n[-1] = -1.0, 6.0
    m = 3.0 * (1.0 - ((n - 2.5) / 3.5) ** 2)
    return tuple(zip(n.tolist(), np.maximum(m, 0.0).tolist(), strict=True))


@pytest.mark.parametrize(
    ("n", "m", "share", "verdict"),
    [
        (10e3, 22.5e3, 0.5, "pass"), (10e3, 45e3, 1.0, "pass"), (10e3, 54e3, 1.2, "fail"), (-1000.0, 7.5e3, 0.5, "pass"),
        (35e3, 60e3, 2.0, "fail"), (50e3, 0.0, 0.0, "pass"), (50e3, 1.0, math.inf, "fail"), (-2001.0, 0.0, math.inf, "fail"),
        (51e3, 0.0, math.inf, "fail"),
    ],
)  # fmt: skip
def test_a_point_inside_on_and_outside_the_curve_has_its_share_by_hand(n, m, share, verdict):
    found = judged(corners([n], [m]))
    assert (found.value, found.verdict) == (pytest.approx(share, rel=1e-12), verdict)
    assert found.words == f"maximum of {DEMAND} at 12 m"


@pytest.mark.parametrize("seed", range(60))
def test_the_greatest_share_over_time_is_that_of_a_corner_of_the_envelope(seed):
    """Of a random path of moment and axial force, all of whose points are held against the polygon one by one."""
    rng = np.random.default_rng(seed)
    curve, t = random_curve(rng), np.linspace(0.0, 1.0, 400)
    waves = rng.uniform(0.2, 1.0, 4)
    n = 2.5 + 2.9 * waves[0] * np.sin(9 * waves[1] * t + seed)
    m = 2.0 * waves[2] * np.cos(23 * waves[3] * t)
    own = envelope(12.0, n, m)
    assert len(own.axial) < len(t)
    rows = corners(own.axial, own.effect)
    expected = max(by_hand(curve, *point) for point in zip(n.tolist(), np.abs(m).tolist(), strict=True))
    assert used(curve, rows)["over_capacity"].item() == pytest.approx(expected, rel=1e-9)


def test_the_ratio_of_peaks_is_not_the_peak_of_ratios():
    """The greatest moment comes with a great axial force, the least axial force with little moment: 0.6, where peaks give 2."""
    found = judged(corners([0.0, 20e3], [15e3, 36e3]))
    assert found.value == pytest.approx(0.6)
    assert 36e3 / resistance(CURVE, np.array([0.0])).item() > 1.0


@pytest.mark.parametrize("seed", range(40))
def test_the_error_of_a_share_holds_all_that_axial_force_and_moment_may_be(seed):
    rng = np.random.default_rng(seed)
    curve, error = random_curve(rng), float(rng.uniform(0.001, 0.1))
    n, m = np.sort(rng.uniform(-0.5, 5.5, 3)), rng.uniform(0.1, 2.0, 3)
    found = used(curve, corners(n, m, error)).iloc[0]
    sizes = error * np.abs(n).max(), error * m.max()
    tries = [
        max(by_hand(curve, n[i] + sizes[0] * x, max(m[i] + sizes[1] * y, 0.0)) for i, (x, y) in enumerate(moves))
        for moves in rng.uniform(-1.0, 1.0, (300, 3, 2)).tolist()
    ]
    if math.isnan(found["over_capacity"]):  # the error decides whether N is beyond an end
        assert math.isinf(max(by_hand(curve, n[i] + s * sizes[0], m[i] + sizes[1]) for i in range(3) for s in (-1, 1)))
        return
    assert max(tries) <= found["over_capacity"] + found["over_capacity_error"] + 1e-12
    assert min(tries) >= found["over_capacity"] - found["over_capacity_error"] - 1e-12


def test_a_capacity_that_an_error_puts_out_of_reach_is_not_decided():
    for n in (49.9e3, 50.1e3):
        found = judged(corners([n], [10.0], 0.01))
        assert (found.high, found.verdict) == (math.inf, "not decided")
        assert found.is_lower_bound
        assert 0.0 < found.value == found.low < 0.02
        assert f"between {found.low:.4g} and any value" in found.remarks
    assert judged(corners([60e3], [10.0], 0.01)).verdict == "fail"
    assert judged(corners([20e3], [59.9e3], 0.01)).verdict == "not decided"


def test_without_an_estimate_the_verdict_says_so():
    assert judged(corners([20e3], [30e3], math.nan)).note.endswith("; no error estimate")


def test_envelopes_of_both_steps_differ_by_what_either_reaches_further():
    fine = envelope(0.0, np.array([0.0, 1.0, 2.0]), np.array([0.0, 4.0, 0.0]))
    coarse = envelope(0.0, np.array([0.0, 1.0, 2.0]), np.array([0.0, 3.6, 0.0]))
    (own,) = with_errors([fine], [coarse], 4.0)
    assert own.error == pytest.approx(4.0 * 0.1, rel=1e-3)
    assert with_errors([fine], [fine], 4.0)[0].error < 1e-6


def test_errors_are_four_times_the_change_by_the_step_and_by_the_last_mode():
    """The moment changes by a tenth of itself; forces are per unit mass, of 900 t."""
    n, m = np.array([0.0, 1.0, 2.0]), np.array([0.0, 4.0, 0.0])
    fine, coarse = envelope(0.0, n, m), envelope(0.0, n, 0.9 * m)
    pier = replace(rb.Pier.rectangle(6.0, 30.0, mass_t=900.0), flexural_period_s=0.8)
    base = rb.RigidBase(shaft="elastic", flexural_modes=2)
    run = Run(pier, base, rb.Motion("still", 0.01, np.zeros(3)))
    observer = InteractionInSections((0.0,))
    (by_modes,) = observer.beyond(run, [fine], [coarse])
    assert by_modes.error == pytest.approx(0.4, rel=1e-3)
    rows = observer.add(run, SimpleNamespace(with_table=lambda name, rows: rows), [fine], [coarse])
    assert [row["interaction_error"] for row in rows] == pytest.approx([0.4] * 3, rel=1e-3)
    assert [(row["axial_kN"], row["moment_kNm"]) for row in rows] == [(0.0, 0.0), (900.0, 3600.0), (1800.0, 0.0)]


@pytest.mark.parametrize(
    ("curve", "said"),
    [
        (((0.0, 1.0),), "fewer than two points"),
        (((-2e3, 0.0), (0.0, 30e3), (20e3, 40e3), (30e3, 60e3), (50e3, 0.0)), r"is not convex: \[20000, 40000\] is below"),
        (((-2e3, 0.0), (0.0, 30e3), (50e3, 0.0), (0.0, -30e3)), r"a moment below 0 at \[0, -30000\]"),
        (((50e3, 0.0), (0.0, 30e3), (-2e3, 0.0)), "does not go by ascending N"),
        (((0.0, 20e3), (0.0, 30e3), (50e3, 0.0)), r"does not go by ascending N from \[0, 20000\] to \[0, 30000\]"),
        (((-2e3, 0.0), (0.0, 30e3), (50e3, 0.0), (-2e3, 0.0)), "does not go by ascending N"),
    ],
)  # fmt: skip
def test_a_curve_that_is_none_is_refused_with_its_point(curve, said):
    with pytest.raises(rb.InputError, match=f"capacity .*{said}"):
        rule(curve)
    assert list(problems(CURVE)) == []


def test_a_capacity_is_for_its_demand_alone_and_its_demand_needs_it():
    with pytest.raises(rb.InputError, match="capacity is missing, points"):
        rule(None)
    with pytest.raises(
        rb.InputError, match="a curve is for section_moment_over_capacity and base_shear_over_capacity; write"
    ):
        Rule("a", "theta_max_over_alpha", 0.5, capacity=CURVE)
    with pytest.raises(rb.InputError, match=r"capacity is missing, a line, or points .*capacity = \{ per_N = 0.6 \}"):
        Rule("a", SHEAR, 1.0)


@pytest.mark.parametrize(
    ("shift", "at_m", "said"),
    [(-60e3, 12.0, "is above 0"), (30e3, 0.0, ""), (-25e3, 0.0, "is 2.943e"), (-25e3, 12.0, "")],
)
def test_a_capacity_without_the_dead_load_is_refused(shift, at_m, said):
    """The pier weighs 29,430 kN: at its foot N is that, above it is less."""
    curve = tuple((n + shift, m) for n, m in CURVE)
    one = rb.Rule("shaft", DEMAND, 1.0, at_m=at_m, capacity=curve, reason="r")
    rows = corners([1000.0], [1.0]).assign(height_m=at_m)

    def refused():
        return judge([one], runs([0.1]), [case()], interaction=rows, doubted=True)

    if said:
        with pytest.raises(rb.InputError, match=f"and that of the dead load {said}.*positive in compression"):
            refused()
    else:
        assert len(refused()) == 1


def test_an_envelope_that_is_thinned_reaches_less_by_what_its_error_gains():
    t = np.linspace(0.0, np.pi, 4000)
    whole = envelope(12.0, 3.0 - 2.0 * np.cos(t), 7.0 * np.sin(t))._replace(error=0.01)
    fewer = thinned(whole)
    assert len(whole.axial) > 3000
    assert 30 < len(fewer.axial) < 150
    lost = 7.0 * np.sin(t) - np.interp(3.0 - 2.0 * np.cos(t), fewer.axial, fewer.effect)
    assert lost.min() > -1e-9
    assert fewer.error == pytest.approx(0.01 + FLATNESS)
    assert (fewer.axial[0], fewer.axial[-1], fewer.effect.max()) == (1.0, 5.0, pytest.approx(7.0, rel=1e-6))
    ways = np.linspace(0.0, np.pi, 500)
    reach = [np.outer(np.cos(ways), of.axial / 5) + np.outer(np.sin(ways), of.effect / 7) for of in (whole, fewer)]
    assert 0.0 <= (reach[0].max(axis=1) - reach[1].max(axis=1)).max() <= FLATNESS
    assert thinned(Envelope(0.0, np.array([4.0]), np.array([2.0]))).error is None
    flat = thinned(Envelope(0.0, np.array([0.0, 1.0, 2.0]), np.array([1.0, 1.0 + 0.5 * FLATNESS, 1.0])))
    assert flat.axial.tolist() == [0.0, 1.0, 2.0]


@pytest.mark.parametrize("seed", range(40))
def test_the_envelope_of_points_is_that_of_all_pairs_of_them(seed):
    """At each N of a point: the highest line between any two points, and nothing above it is left out."""
    rng = np.random.default_rng(seed)
    n, e = rng.normal(size=60), np.abs(rng.standard_cauchy(60))
    if seed % 4 == 0:
        n[:20] = n.min()  # many moments without any axial force
    own = envelope(None, n, e)
    highest = [
        max(
            e[i] + (e[j] - e[i]) * (x - n[i]) / (n[j] - n[i]) if n[i] != n[j] else max(e[i], e[j])
            for i in range(60)
            for j in range(60)
            if min(n[i], n[j]) <= x <= max(n[i], n[j])
        )
        for x in n.tolist()
    ]
    assert np.interp(n, own.axial, own.effect) == pytest.approx(highest, rel=1e-9)
    assert set(zip(own.axial.tolist(), own.effect.tolist(), strict=True)) <= set(
        zip(n.tolist(), e.tolist(), strict=True)
    )


def test_values_between_rows_are_those_of_a_cubic_and_none_beside_an_event():
    """Rows at 0.3 s twice: an event, beside which no four rows are even."""
    t = np.array([0.0, 0.1, 0.2, 0.3, 0.3, 0.4, 0.5, 0.6, 0.7, 0.72])
    times, values = with_values_between(t, t), with_values_between(t, 1.0 - 2.0 * t + 7.0 * t**3)
    assert times.tolist() == pytest.approx([*t, 0.125, 0.15, 0.175, 0.425, 0.45, 0.475, 0.525, 0.55, 0.575])
    assert values == pytest.approx(1.0 - 2.0 * times + 7.0 * times**3, rel=1e-12)


@pytest.mark.parametrize("seed", range(30))
def test_friction_and_a_key_are_held_against_shear_and_normal_force_of_one_moment(seed):
    """V <= c + μ N at each of the moments of a random path, one by one."""
    rng = np.random.default_rng(seed)
    t, key, friction = np.linspace(0.0, 1.0, 300), float(rng.uniform(100.0, 900.0)), float(rng.uniform(0.2, 0.9))
    normal = 2e4 * (1.0 + 0.9 * np.sin(7 * t + seed))
    shear = 5e3 * np.cos(31 * t * rng.uniform(0.2, 1.0))
    own = envelope(None, normal, shear)
    found = judged(
        at_base(own.axial, own.effect), checked=Rule("joint", SHEAR, 1.0, capacity=line(key, friction), reason="r")
    )
    assert found.value == pytest.approx(max(np.abs(shear) / (key + friction * normal)), rel=1e-9)
    assert found.verdict == ("pass" if found.value <= 1.0 else "fail")
    assert math.isnan(found.at_m)
    assert found.words == f"maximum of {SHEAR}"


def test_a_line_has_no_capacity_under_more_tension_than_it_bears():
    curve = line(600.0, 0.6)
    assert resistance(curve, np.array([-1001.0, -1000.0, -500.0, 0.0, 1e6])).tolist() == pytest.approx(
        [math.nan, 0.0, 300.0, 600.0, 600600.0], rel=1e-12, nan_ok=True
    )
    assert resistance(line(600.0), np.array([-1e5, 1e5])).tolist() == [600.0, 600.0]


def test_without_a_normal_force_friction_alone_holds_no_shear():
    """The error of N is 100 kN, of which 0.6 is friction; the shear is 1000 kN."""
    friction = Rule("joint", SHEAR, 1.0, capacity=line(0.0, 0.6), reason="r")
    found = judged(at_base([0.0, 1e4], [1000.0, 100.0], 0.01), checked=friction)
    assert (found.verdict, found.value, found.high) == ("fail", pytest.approx(990.0 / 60.0), math.inf)
    assert judged(at_base([0.0, 1e4], [0.0, 100.0]), checked=friction).value == pytest.approx(100.0 / 6000.0)


def test_the_least_share_within_an_error_is_at_the_top_of_the_curve():
    """N is 0.5 to 19.5 kN and M at least 2.5 kN m; the curve has its top at 2 kN, and ends at 12 kN."""
    found = used(((-10.0, 0.0), (2.0, 100.0), (12.0, 0.0)), corners([10.0], [50.0], 0.95)).iloc[0]
    assert (found["over_capacity"], found["over_capacity_error"]) == (pytest.approx(0.025), math.inf)


def test_a_number_is_a_capacity_of_which_the_limit_is_a_share():
    table = runs([0.1]).assign(heel_gap_left_m=0.3, heel_gap_right_m=0.2, base_shear_m_s2=1.0, forces_error=0.0)
    one = Rule("stroke", "heel_gap_m", 0.8, capacity=0.5, reason="r")
    found = judge([one], table, [case()])[0]
    assert (found.value, found.limit, found.ratio) == (0.3, 0.4, pytest.approx(0.75))
    of_curve = judged(corners([0.0, 9e3], [15e3, 36e3]), checked=rule(72e3))
    assert (of_curve.value, of_curve.limit, of_curve.unit) == (pytest.approx(0.5), 1.0, "")


@pytest.mark.parametrize(
    ("demand", "limits", "capacity", "said"),
    [
        (
            "heel_gap_m",
            {"at_most": 400.0},
            500.0,
            "at_most = 400: is a share of the capacity; write at_most = 0.8, or leave",
        ),
        ("heel_gap_m", {"at_most": 1.0}, -500.0, "capacity = -500: must be above 0"),
        ("flight", {"at_most": 0.5}, 500.0, "capacity: flight has none that it uses a share of; leave it out"),
        ("eta", {"at_least": 2.0}, 500.0, "capacity: eta has none that it uses a share of; leave it out"),
        (SHEAR, {"at_most": 1.0}, ((0.0, 0.0), (9.0, 0.0)), "capacity is 0 at every N"),
        (SHEAR, {"at_most": 1.0, "at_m": 0.0}, 500.0, "at_m: is for demands in a section"),
    ],
)
def test_a_number_that_is_no_capacity_is_refused_with_a_remedy(demand, limits, capacity, said):
    with pytest.raises(rb.InputError, match=said):
        Rule("a", demand, capacity=capacity, reason="r", **limits)


def test_of_what_is_not_known_no_number_is_written():
    """The run has no row, so that its demand may be any."""
    friction = Rule("joint", SHEAR, 1.0, capacity=line(0.0, 0.6), reason="r")
    found = judged(at_base([20e3], [30e3]).assign(record="another"), checked=friction)
    assert (found.verdict, found.low, found.high) == ("not decided", 0.0, math.inf)
    assert all(map(math.isnan, (found.value, found.ratio, found.margin, found.governing)))
    assert not found.is_lower_bound
    assert (found.station, found.record) == ("r0", "r0")


def test_columns_of_the_table_are_on_the_page():
    page = (Path(rb.__file__).parents[1] / "docs/columns.md").read_text(encoding="utf-8")
    assert all(f"| {name} | {meaning} |" in page for name, meaning in OF_INTERACTION.items())
