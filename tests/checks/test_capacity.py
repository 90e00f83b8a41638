"""The share of a section's capacity that a run uses: of moment and axial force at one moment, against a polygon by hand."""

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
from rockbatch.checks.capacity import problems, resistance, used
from rockbatch.observers.interaction.observe import InteractionInSections, envelope, with_errors
from rockbatch.quantities.demands import OF_INTERACTION
from rockbatch.simulation import Run

CURVE = ((-2000.0, 0.0), (0.0, 30e3), (20e3, 60e3), (50e3, 0.0))
DEMAND = "section_moment_over_capacity"


def rule(curve=CURVE, at_most=1.0, **more):
    return Rule("shaft", DEMAND, at_most, at_m=12.0, capacity=curve, reason="drawing 7", **more)


def corners(axial, moment, error=0.0, record="r0"):
    """Rows of interaction.csv of one run on pads."""
    rows = pd.DataFrame({"axial_kN": np.array(axial, dtype=float), "moment_kNm": np.array(moment, dtype=float)})
    return rows.assign(record=record, case="pads", polarity="+", scale=1.0, height_m=12.0, interaction_error=error)


def judged(rows, table=None, *, one=None, **more):
    (verdict,) = judge([rule(**more)], runs([0.1]) if table is None else table, [one or case()], interaction=rows)
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
    rows = corners(own.axial, own.moment)
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
        assert "between 0 and any value" in found.remarks
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
    with pytest.raises(rb.InputError, match="capacity: is for section_moment_over_capacity; leave it out"):
        Rule("a", "theta_max_over_alpha", 0.5, capacity=CURVE)


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


def test_columns_of_the_table_are_on_the_page():
    page = (Path(rb.__file__).parents[1] / "docs/columns.md").read_text(encoding="utf-8")
    assert all(f"| {name} | {meaning} |" in page for name, meaning in OF_INTERACTION.items())
