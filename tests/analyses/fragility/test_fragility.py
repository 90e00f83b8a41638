"""From records at rising intensities to fragility curves: scaling, limits, bisection, resuming, files and messages."""

import contextlib
import csv
import io
import json
import math
import shutil
from dataclasses import replace

import numpy as np
import pytest
from report_page import Page
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.fragility.command import table
from rockbatch.analyses.fragility.curves import Curve, Member, Readings, Undecided, assess
from rockbatch.analyses.fragility.hazard import Hazard
from rockbatch.analyses.fragility.ida import Bracket, Capacity
from rockbatch.analyses.fragility.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD, states
from rockbatch.analyses.fragility.lognormal import Capacities, Lognormal, NoCurve, fit
from rockbatch.analyses.fragility.risk import risk_table, risks
from rockbatch.analyses.fragility.runs import LevelPlan, ScaledRuns, intensities, output
from rockbatch.analyses.fragility.section import section
from rockbatch.analyses.fragility.study import OVERTURNING, FragilitySpec, read_fragility
from rockbatch.analyses.fragility.tables import capacities, described, note, points
from rockbatch.analyses.fragility.windows import Windows
from rockbatch.batch.digests import digests
from rockbatch.batch.journal import Journal
from rockbatch.batch.plan import simulations
from rockbatch.batch.threads import Threads
from rockbatch.batch.waves import Waves
from rockbatch.checks import Rule
from rockbatch.commands.cli import main
from rockbatch.common.errors import EditedTable, InputError
from rockbatch.motions.hazard import HazardCurve
from rockbatch.motions.measures import pga, pgv
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.pier import ElasticBase, Pier, RigidBase
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.reporting import finished_analysis
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.results.columns import columns
from rockbatch.study import Case, load_study
from rockbatch.study.spec import Output
from rockbatch.study.suite import ground_motions

STRIPES = 'measure = "PGA"\nlevels_g = [0.2, 0.4, 0.6, 0.8]'
IDA = f'method = "ida"\ntolerance = 0.02\n{STRIPES}'


def check(name, demand, reason, **limit):
    return {"name": name, "demand": demand, **limit, "reason": reason}


def written(tmp_path, fragility):
    shapes = [("sine", 0.6), ("sine", 1.0), ("cosine", 0.7), ("ricker", 0.9), ("ricker", 1.4)]
    text = study_text(
        title="Fragility of a small pier", pier={"alpha": 0.2, "p": 2.0}, motions={"polarity": ["+", "-"]},
        pulses=[
            SINE | {"name": f"{shape} {t} s", "shape": shape, "amplitude_g": 0.4, "period_s": t, "duration_s": 4.5}
            for shape, t in shapes
        ],
        cases=(RIGID, PADS | {"beta": 60, "eta": 3.0, "epsilon": 0.1, "flight": "guided"}), numerics={"tolerance": 1e-3},
        check=[
            check("half way", "theta_max_over_alpha", "margin", at_most=0.5),
            check("settlement", "settlement_m", "bearings", at_most=0.005),
            check("bearing", "eta", "of the case, about no record", at_least=2.0),
        ],
    )  # fmt: skip
    return write_study(tmp_path, f"{text}\n[fragility]\n{fragility}\n")


@pytest.fixture(scope="module")
def ida(tmp_path_factory):
    """The folder that the command leaves after an incremental dynamic analysis, and what it prints."""
    folder, printed = tmp_path_factory.mktemp("ida"), io.StringIO()
    with contextlib.redirect_stdout(printed):
        assert main(["fragility", str(written(folder, IDA)), "--out", str(folder / "out"), "--jobs", "2"]) == 0
    return folder / "out", printed.getvalue()


def read(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def journal_of(study, spec, directory):
    found = ground_motions(study).motions
    return found, Journal(directory / "runs.csv.part", columns(study), digests(found, levels=spec))


# Scaling


@pytest.mark.parametrize(
    ("fragility", "measure"),
    [
        (STRIPES, lambda a: pga(a) / 9.81),
        ('measure = "PGV"\nlevels_m_s = [0.2, 0.6]', lambda a: pgv(a, 0.01)),
        ('measure = "Sa"\nperiod_s = 0.5\nlevels_g = [0.2, 0.6]', lambda a: spectral_acceleration(a, 0.01, [0.5])[0] / 9.81),
    ],
    ids=["PGA", "PGV", "Sa"],
)  # fmt: skip
def test_every_run_has_the_intensity_of_its_level(tmp_path, fragility, measure):
    study = load_study(written(tmp_path, fragility))
    spec = read_fragility(study)
    motions = ground_motions(study).motions
    seen = []

    def simulate(runs):
        assert isinstance(runs, ScaledRuns)
        for run, moved, point in zip(runs, simulations(runs), runs.points, strict=True):
            assert measure(moved.motion.horizontal) == pytest.approx(point.intensity, rel=1e-12)
            assert moved.motion.horizontal == pytest.approx(
                run.scale * run.record.horizontal * (1 if run.polarity == "+" else -1)
            )
            seen.append((run.record.name, run.polarity, point.intensity, run.case.name))
        raise StopIteration

    with pytest.raises(StopIteration):
        assess(study, spec, motions, simulate)
    assert len(set(seen)) == len(seen) == 5 * len(spec.levels) * 2
    assert {polarity for _, polarity, _, _ in seen} == {"+"}  # the other would be their mirror image


def test_a_motion_without_intensity_is_refused(tmp_path):
    study = load_study(written(tmp_path, STRIPES))
    still = rb.Motion("still", 0.01, np.zeros(10))
    with pytest.raises(InputError, match="still: its horizontal component has PGA = 0"):
        intensities([still], read_fragility(study), 9.81)


# Limits


def of_statuses(statuses, theta=0.4, error=0.01):
    """Rows of peaks.csv with these statuses."""
    import pandas as pd

    n = len(statuses)
    rows = {"status": statuses, "theta_max_over_alpha": [theta] * n, "theta_max_error": [error] * n}
    flew = [1.0 if status == "flight" else np.nan for status in statuses]
    return pd.DataFrame(rows | {"flight_s": flew, "polarity": ["+"] * n})


@pytest.mark.parametrize(("rule", "expected"), [
    ({"at_most": 0.5}, [WITHSTOOD, EXCEEDED, UNDECIDED, UNDECIDED]),
    ({"at_most": 0.3}, [EXCEEDED, EXCEEDED, EXCEEDED, UNDECIDED]),
    ({"at_most": 0.405}, [UNDECIDED, EXCEEDED, UNDECIDED, UNDECIDED]),
    ({"at_most": 0.5, "flight": "infinite", "failed": "left out"}, [WITHSTOOD, EXCEEDED, EXCEEDED, LEFT_OUT]),
    ({"at_most": 0.5, "statistic": "asce7-16"}, [WITHSTOOD, EXCEEDED, EXCEEDED, EXCEEDED]),
    ({"at_most": 3, "statistic": "count", "above": 0.3}, [EXCEEDED, EXCEEDED, EXCEEDED, UNDECIDED]),
])  # fmt: skip
def test_a_run_that_did_not_go_through_counts_as_its_check_says(rule, expected):
    runs = of_statuses(["ok", "overturned", "flight", "failed"])
    found = states(Rule("check", "theta_max_over_alpha", **rule), Rows(runs), {"base": "rigid", "pier": {"alpha": 0.2}})
    assert list(found) == expected


def test_whether_a_run_that_was_cut_short_would_have_overturned_is_undecided():
    runs = of_statuses(["ok", "overturned", "flight", "failed"])
    found = states(Rule("overturning", "overturned", at_most=0), Rows(runs), {"base": "rigid"})
    assert list(found) == [WITHSTOOD, EXCEEDED, UNDECIDED, UNDECIDED]


# Bisection


@pytest.mark.parametrize(("shape", "first", "last", "amplitudes"), [
    ("half-sine", 3.289147, math.inf, [2.5, 4.5, 6.8, 7.5]),
    ("sine", 3.018600, 6.318071, [2.5, 4.5, 6.8, 7.5]),
    ("sine", 3.018600, 6.318071, [2.5, 6.8, 7.5]),
])  # fmt: skip
def test_the_amplitude_of_overturning_is_that_of_the_closed_form(tmp_path, shape, first, last, amplitudes):
    """Slender block, e = 0.9, ω_p/p = 5 (test_overturning): the one-sine's second safe window is 6.318–7.168.

    The level 6.8 is inside it: the first exceedance is found all the same, also where no level is in the window of overturning
    below, and that the block stands there is counted. Tolerance 1e-4, and as much for the pulse that is linear between 400
    samples a period.
    """
    alpha, period = 1e-4, 2 * math.pi / 5
    unit = math.tan(alpha)
    levels = [amplitude * unit for amplitude in amplitudes]
    text = study_text(
        pier={"alpha": alpha, "p": 1.0},
        pulses=[{"name": "pulse", "shape": shape, "amplitude_g": 1.0} | {"period_s": period, "dt_s": period / 400,
        "duration_s": period}], cases=({"base": "rigid", "restitution": 0.9},), numerics={"substeps": 1, "quiet_s": 0.0},
        fragility={"method": "ida", "measure": "PGA", "levels_g": levels, "tolerance": 1e-4},
    )  # fmt: skip
    path = write_study(tmp_path, text)
    study = load_study(path)
    spec = read_fragility(study)
    motions, journal = journal_of(study, spec, tmp_path)
    with journal:
        (curve,) = assess(study, spec, motions, Waves(study, journal, Threads(1)))
    ((_, found),) = curve.capacities
    assert found.decided.low / unit == pytest.approx(first, rel=2e-4)
    assert found.decided.high / unit == pytest.approx(first, rel=2e-4)
    assert found.returns == (1 if last < 6.8 else 0)


# The whole


def test_the_command_writes_points_curves_capacities_and_all_runs(ida):
    out, printed = ida
    points, capacities_, runs = (read(out / f"fragility{name}.csv") for name in ("", "_capacities", "_runs"))
    told = json.loads((out / "fragility.json").read_text(encoding="utf-8"))
    names = "case columns limit_state words reason counting median dispersion note undecided says_little median_undecided points"
    of_file = {*names.split(), "capacities", "looked"}  # earlier folders have these names
    assert all(of_file <= curve.keys() for curve in told["curves"])
    limits = ["overturning", "half way", "settlement"]
    assert list(dict.fromkeys(point["limit_state"] for point in points)) == limits
    assert len(points) == 4 * (2 + 2 + 1)  # a rigid base does not settle, and eta is about no record
    assert {(one["limit_state"], one["case"]) for one in told["curves"]} == {
        (limit, case) for limit in limits for case in ("rigid", "pads") if (limit, case) != ("settlement", "rigid")
    }
    assert len(capacities_) == 5 * 5
    for one in capacities_:
        if one["found"] == "exceeded":
            assert float(one["above"]) < float(one["at_most"]) <= 1.02 * float(one["above"]) * (1 + 1e-9)
            assert float(one["scale_at_most"]) == pytest.approx(float(one["at_most"]) / 0.4, rel=0.05)
    overturned = {(run["record"], run["case"]) for run in runs if run["status"] == "overturned"}
    found = {
        (one["record"], one["case"]) for one in capacities_ if one["limit_state"] == "overturning" and one["at_most"]
    }
    assert overturned == found
    assert "Fragility for PGA, incremental dynamic analysis" in printed
    assert "half way: theta_max_over_alpha > 0.5" in printed
    assert not (out / "fragility_runs.csv.part").exists()


def test_capacities_have_all_their_bounds_also_as_scales():
    case, spec = Case("rigid", Pier(0.2, 1.0), RigidBase(), {}), FragilitySpec("ida", "PGA", (0.2, 0.8), ())
    found = (
        ((0, 0), Capacity(Bracket(0.2, 0.4), Bracket(0.25, 0.3), Bracket(0.35, 0.5), 2, 1, 0.05)),
        ((0, 1), Capacity(*3 * (Bracket(0.8, math.inf),), 0, 0, 0.1)),
        ((0, 2), Capacity(*3 * (Bracket(0.0, 0.2),), 0, 0, 0.0)),
        ((0, 1), Capacity(*3 * (Bracket(0.3, 0.31),), 0, 3, 0.2)),
        ((0, 1), Capacity(Bracket(0.8, math.inf), Bracket(0.2, 0.3), Bracket(0.8, math.inf), 1, 0, 0.1)),
    )
    curve = Curve(case, OVERTURNING, (), "none", Undecided(0, 0, 0, 0), capacities=found)
    plan = LevelPlan([0.1, 0.2, 0.4], [1.0] * 3, [{}] * 3, [{}] * 3)
    rows = capacities([curve], spec, (), ["a", "b", "c"], [plan], [case])
    assert rows.columns[:6].to_list() == ["record", "case", "limit_state", "measure", "unit", "found"]
    assert rows["record"].to_list() == ["a", "b", "c", "b", "b"]
    assert rows["found"].to_list() == [
        "undecided", "beyond the highest level", "below the lowest level", "exceeded", "undecided",
    ]  # fmt: skip
    names = (
        "above", "at_most", "scale_above", "scale_at_most", "undecided", "if_exceeded", "if_withstood", "returns", "widest_step",
    )  # fmt: skip
    np.testing.assert_allclose(rows[list(names)].to_numpy(float), [
        [0.2, 0.4, 2.0, 4.0, 2, 0.3, 0.35, 1, 0.05],
        [0.8, np.nan, 4.0, np.nan, 0, np.nan, np.nan, 0, 0.1],
        [0.0, 0.2, 0.0, 0.5, 0, np.nan, np.nan, 0, 0.0],
        [0.3, 0.31, 1.5, 1.55, 0, np.nan, np.nan, 3, 0.2],
        [0.8, np.nan, 4.0, np.nan, 1, 0.3, 0.8, 0, 0.1],
    ])  # fmt: skip


def test_notes_say_why_there_is_no_curve_and_what_one_rests_on():
    case, spec = Case("rigid", Pier(0.2, 1.0), RigidBase(), {}), FragilitySpec("ida", "PGA", (0.2, 0.8), ())
    fitted = Lognormal(0.5, 0.4, (0.4, 0.6), (0.3, 0.5), np.zeros((1, 2)))

    def said(fitted, undecided=(0, 0, 0, 0), **more):
        return note(Curve(case, OVERTURNING, (), fitted, Undecided(*undecided), **more), spec)

    assert (said(NoCurve("no record counts")), said(fitted)) == ("no record counts", "")
    for median, beyond in ((0.19, True), (0.2, False), (0.8, False), (0.81, True)):
        words = "the median is extrapolated beyond the intensities that were run"
        assert said(replace(fitted, median=median)) == beyond * words
    few = replace(fitted, median_interval=None, dispersion_interval=None, stations=4)
    assert said(few) == "no intervals: records of 4 stations, and 5 are needed to tell their scatter"
    for name in ("median_interval", "dispersion_interval"):
        assert said(replace(fitted, **{name: (0.3, math.inf)})).startswith("the records leave the intervals open")
    assert (
        said(fitted, windows=Windows(0.02, (0.0,), (1,), (0,), NoCurve("none exceeds")))
        == "no median by shares: none exceeds"
    )
    returning = tuple(
        (Member(0, m), Capacity(*3 * (Bracket(0.3, 0.31),), 0, returns, 0.1)) for m, returns in enumerate((0, 2, 1))
    )
    assert said(fitted, capacities=returning) == "2 of 3 records withstand a level above their first exceedance"
    assert said(fitted, (10, 1, 2, 0)).startswith(
        "3 of 10 runs undecided: 1 flew, 2 failed, above the first exceedance of"
    )


def test_stripes_count_a_record_once_in_whatever_polarities(tmp_path):
    study = load_study(written(tmp_path, STRIPES))
    spec = read_fragility(study)
    motions, journal = journal_of(study, spec, tmp_path)
    with journal:
        curves = assess(study, spec, motions, Waves(study, journal, Threads(2)))
        rows = [row for _, row in journal.rows()]
    over = next(curve for curve in curves if curve.case.name == "rigid" and curve.limit.name == "overturning")
    unscaled = {motion.name: pga(motion.horizontal) / 9.81 for motion in motions}
    for stripe in over.stripes:
        names = {
            row["record"]
            for row in rows
            if row["case"] == "rigid" and row["status"] == "overturned"
            and float(row["scale"]) * unscaled[row["record"]] == pytest.approx(stripe.level)
        }  # fmt: skip
        assert (stripe.records, stripe.exceeded, stripe.collapsed) == (5, len(names), len(names))
    assert 0 < sum(stripe.exceeded for stripe in over.stripes) < 20
    assert over.capacities == ()


# Undecided runs


def made_up(tmp_path, fragility, status_of, limits=None, motions=30, **more):
    """Curves of the rigid case through runs with a status by number of the motion and intensity."""
    study = load_study(written(tmp_path, fragility))
    study = replace(study, cases=study.cases[:1])
    spec = read_fragility(study)
    spec = replace(spec, limits=limits or spec.limits[:1], **more)
    one = ground_motions(study).motions[0]
    scaled = [replace(one, name=f"motion {m}") for m in range(motions)]

    def simulate(runs):
        return of_statuses([status_of(point.motion, point.intensity) for point in runs.points])

    return assess(study, spec, scaled, simulate), spec, study


def lognormal_capacities(motions=30, median=0.5, dispersion=0.4):
    from scipy.special import ndtri

    return median * np.exp(dispersion * ndtri((np.arange(motions) + 0.5) / motions))


CAPACITIES = lognormal_capacities()


def stands_or_falls(motion, x):
    return "overturned" if x >= CAPACITIES[motion] else "ok"


@pytest.mark.parametrize("fragility", [STRIPES, IDA], ids=["stripes", "ida"])
def test_runs_that_flew_or_failed_far_below_their_capacity_do_not_move_the_headline(tmp_path, fragility):
    """Every second record fails up to 0.3 g, where most would stand: the median is as without them."""

    def status(motion, x):
        return "failed" if x < 0.3 and motion % 2 else stands_or_falls(motion, x)

    (without,), _, _ = made_up(tmp_path, fragility, stands_or_falls)
    (curve,), _, _ = made_up(tmp_path, fragility, status)
    assert without.readings is None
    assert without.undecided.words == ""
    assert curve.fitted.median == pytest.approx(without.fitted.median, rel=0.03)
    low, high = curve.readings.medians
    assert low < 0.8 * without.fitted.median
    assert high == pytest.approx(without.fitted.median, rel=0.03)
    assert high / low > np.divide(*curve.fitted.median_interval[::-1])
    assert curve.inconclusive


def test_the_readings_are_those_of_all_undecided_runs_counted_either_way(tmp_path):
    """Held against fits of the counts themselves; 12 of 120 runs, 4 of them flights."""

    def status(motion, x):
        if motion < 8 and x == 0.4:
            return "failed"
        return "flight" if motion >= 26 and x == 0.6 else stands_or_falls(motion, x)

    (curve,), spec, _ = made_up(tmp_path, STRIPES, status)
    assert curve.undecided.words == "12 of 120 runs undecided: 4 flew, 8 failed"
    levels = np.array(spec.levels)
    kinds = np.array([[status(m, x) for x in spec.levels] for m in range(30)])
    open_, within, beyond = np.isin(kinds, ["flight", "failed"]), kinds == "ok", kinds == "overturned"
    for found, expected in (
        (curve.fitted, (within, beyond)),
        (curve.readings.exceeded, (within, beyond | open_)),
        (curve.readings.withstood, (within | open_, beyond)),
    ):
        assert found.median == fit(Capacities.of_same_records(levels, *expected)).median
    assert curve.readings.exceeded.median < curve.fitted.median < curve.readings.withstood.median
    assert [stripe.undecided for stripe in curve.stripes] == [0, 8, 4, 0]


def test_without_a_curve_undecided_runs_leave_no_median_open(tmp_path):
    """All that is decided stands: only those that failed could give a curve."""
    (curve,), *_ = made_up(tmp_path, STRIPES, lambda motion, x: "failed" if motion % 3 == 0 and x > 0.4 else "ok")
    assert isinstance(curve.fitted, NoCurve)
    assert curve.readings is not None
    assert not curve.inconclusive


def test_both_rates_that_undecided_runs_allow_are_in_the_table(tmp_path):
    """Each by the closed form ν(θ) exp(k²β²/2) under a power law; without undecided runs neither."""

    def status(motion, x):
        return "failed" if motion < 8 and x == 0.4 else stands_or_falls(motion, x)

    hazard = Hazard(HazardCurve([0.25], [1 / 475], slope=2.0), (50.0,), "made up")
    (curve,), spec, _ = made_up(tmp_path, STRIPES, status, hazard=hazard)
    (decided,), *_ = made_up(tmp_path, STRIPES, stands_or_falls, hazard=hazard)
    table = risk_table([curve, decided], risks([curve, decided], spec), spec, ())
    row, without = table.to_dict("records")
    for name, reading in (
        ("rate_if_withstood", curve.readings.withstood),
        ("rate_if_exceeded", curve.readings.exceeded),
    ):
        expected = 1 / 475 * (0.25 / reading.median) ** 2 * math.exp(2.0 * reading.dispersion**2)
        assert row[name] == pytest.approx(expected, rel=1e-6)
        assert math.isnan(without[name])
    assert row["rate_if_withstood"] < row["rate_per_year"] < row["rate_if_exceeded"]


def test_runs_put_out_what_their_limits_need_and_no_more(tmp_path):
    spec = read_fragility(load_study(written(tmp_path, STRIPES)))
    rotation = Rule("half way", "theta_max_over_alpha", at_most=0.5)
    of_study = Output(least_normal_share=0.2, least_stroke_mm=7.0)
    of_runs = {name: demand for name, demand in DEMANDS.items() if not demand.per_case and demand.needs != "sections"}
    assert {demand.needs for demand in of_runs.values()} >= {"forces", "rocking", "devices_work"}
    for name, demand in of_runs.items():
        asked = output(replace(spec, limits=(rotation, Rule("other", name, at_most=0.01))), of_study)
        assert asked.both_laws == bool(demand.other_law)
        for need in ("forces", "rocking", "devices_work"):
            assert getattr(asked, need) == (demand.needs == need), name
        assert (asked.histories, asked.least_normal_share, asked.least_stroke_mm) == ("none", 0.2, 7.0)
    assert output(replace(spec, limits=(Rule("settled", "settlement_m", at_most=0.01),)), Output()).both_laws


def test_undecided_runs_alone_make_no_curve_but_an_open_interval(tmp_path):
    rule = Rule("half way", "theta_max_over_alpha", at_most=0.5, overturned="unknown")
    (curve,), _, _ = made_up(tmp_path, STRIPES, stands_or_falls, limits=(rule,))
    assert [stripe.exceeded for stripe in curve.stripes] == [0, 0, 0, 0]
    assert (
        curve.fitted
        == curve.readings.withstood
        == NoCurve("no record exceeds the limit up to 0.8: the median is above", 0.8)
    )
    assert curve.readings.medians == (curve.readings.exceeded.median, math.inf)
    assert curve.undecided.other == curve.undecided.number > 0
    x, beyond = np.array([0.3, 0.5]), curve.readings.exceeded
    for readings, expected in (
        (curve.readings, (np.zeros(2), beyond.probability(x))),
        (Readings(NoCurve("none"), beyond), (beyond.probability(x), np.ones(2))),
    ):
        np.testing.assert_array_equal(readings.probability(x), expected)
    assert Readings(NoCurve("none"), beyond).medians == (0.0, beyond.median)


def test_a_check_for_which_flight_and_failure_are_infinite_leaves_them_undecided_here(tmp_path):
    path = written(tmp_path, STRIPES)
    text = path.read_text(encoding="utf-8").replace(
        'at_most = 0.5\n', 'at_most = 0.5\nflight = "infinite"\nfailed = "value"\n'
    )  # fmt: skip
    text = text.replace("at_most = 0.005\n", 'at_most = 0.005\nfailed = "left out"\n')
    path.write_text(text, encoding="utf-8")
    _, half, settled = read_fragility(load_study(path)).limits
    path.write_text(f'{text}checks = ["set*", "half w[ab]y"]\n', encoding="utf-8")
    assert read_fragility(load_study(path)).limits[1:] == (half, settled)
    assert (half.flight, half.failed) == ("unknown", "unknown")
    assert (settled.flight, settled.failed) == ("unknown", "left out")
    runs = of_statuses(["flight", "failed"], theta=0.6)
    assert list(states(half, Rows(runs), {"base": "rigid"})) == [EXCEEDED, UNDECIDED]  # beyond the limit before it flew


def test_undecided_runs_come_first_in_the_table_the_files_and_the_report(tmp_path):
    """Every second record fails at two of four levels."""
    (curve,), spec, study = made_up(
        tmp_path, STRIPES, lambda m, x: "failed" if m % 2 and x < 0.5 else stands_or_falls(m, x)
    )
    told = described([curve], spec, study, 30)
    printed = table(told, spec)
    first, *rest = printed.splitlines()
    assert first == "Fragility for PGA, stripes; 1 of 1 curve says little: too many runs are undecided"
    assert any("says little: 30 of 120 runs undecided: 30 failed; they count for nothing here" in line for line in rest)
    rows = points([curve], spec, ())
    assert list(rows["undecided"]) == [15, 15, 0, 0]
    assert (rows["p_low"] <= rows["p"]).all()
    assert (rows["p"] <= rows["p_high"]).all()
    told |= {"study": {"sha256": "here"}}
    (tmp_path / "fragility.json").write_text(json.dumps(told), encoding="utf-8")
    page = section(Contents(tmp_path, told["study"]))
    first, figure = page.split("<figure", 1)
    assert first.startswith('<p class="lead">Overturning has a median of PGA')
    assert '<span class="undecided">too many runs are undecided to say much, 30 of 120 runs: with these on' in first
    assert 'class="unsure s1"' in figure
    assert "Between dotted edges: the curve with undecided runs on either side." in figure
    assert "30 of 120 runs undecided: 30 failed" in figure


@pytest.mark.parametrize(("stations", "said"), [(30, False), (15, True)])
def test_intervals_by_station_are_said_to_be_so(tmp_path, stations, said):
    (curve,), spec, study = made_up(tmp_path, STRIPES, stands_or_falls)
    told = described([curve], spec, study, 30) | {"stations": stations, "study": {"sha256": "here"}}
    (tmp_path / "fragility.json").write_text(json.dumps(told), encoding="utf-8")
    page = section(Contents(tmp_path, told["study"]))
    words = "Intervals are by station: the 30 records are components of 15 stations."
    first, figure = page.split("<figure", 1)
    assert (words in first) == said
    for shown in (
        "Between dotted edges",
        "Strips above",
        "by shares",
        "Dashed",
        "Demand of every record",
        "records of its own",
    ):
        assert shown not in figure


@pytest.mark.parametrize(("fragility", "words"), [
    ("", ["measure is missing"]),
    ('measure = "PGD"', ['measure = "PGD": expected one of "PGA", "PGV", "Sa", ']),
    ('measure = "PGA"', ["levels_g is missing"]),
    ('measure = "PGA"\nlevels_m_s = [0.2, 0.4]',
     ['levels_m_s = [0.2, 0.4]: does not apply to measure = "PGA"', "levels_g is missing"]),
    ('measure = "Sa"\nlevels_g = [0.2, 0.4]', ["period_s is missing"]),
    ('measure = "PGA"\nperiod_s = 1.0\nlevels_g = [0.2]',
     ['period_s = 1.0: does not apply to measure = "PGA"; leave it out, or write measure = "Sa"', "one level does not deter"]),
    ('measure = "PGA"\nlevels_g = [0.4, 0.2]', ["levels_g = 0.2: after 0.4; write them in rising order"]),
    (f"{STRIPES}\ntolerance = 0.1", ['tolerance = 0.1: is for method = "ida"; write that too']),
    (f"{STRIPES}\nhunt_step = 0.1", ['hunt_step = 0.1: is for method = "ida"']),
    (f"{IDA}\nhunt_step = 1e-4", ["hunt_step = 0.0001: expected a number from 0.001 to 1"]),
    (f"{STRIPES}\nwindow = 0.02", ['window = 0.02: is for method = "ida"']),
    (f"{IDA}\nwindow = 2", ["window = 2: expected a number from 0.001 to 0.2"]),
    (f'{STRIPES}\nmethod = "IDA"', ['did you mean "ida"?']),
    (f'{STRIPES}\nchecks = ["half-way"]', ['checks = "half-way": no [[check]] has this name; did you mean "half way"?']),
    (f"{STRIPES}\nconfidence = 1.0", ["confidence = 1.0: expected a number, 0 or above and below 1"]),
])  # fmt: skip
def test_mistakes_in_the_settings_are_reported_with_their_line(tmp_path, capsys, fragility, words):
    path = written(tmp_path, fragility)
    assert main(["fragility", str(path), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    for word in words:
        line = next(line for line in told.splitlines() if word in line)
        assert f"{path}:" in line
        assert "[fragility]" in line
    assert not (tmp_path / "out").exists()


# The report


@pytest.fixture(scope="module")
def stripes(tmp_path_factory):
    """The folder that the command leaves after stripes."""
    folder = tmp_path_factory.mktemp("stripes")
    assert main(["fragility", str(written(folder, STRIPES)), "--out", str(folder / "out"), "--jobs", "2"]) == 0
    return folder / "out"


def test_the_report_has_a_panel_for_each_limit_and_every_curve_in_its_table(ida):
    out, _ = ida
    page = Page((out / "analyses.html").read_text(encoding="utf-8"))
    told = json.loads((out / "fragility.json").read_text(encoding="utf-8"))
    assert page.mismatched == []
    assert page.headings == ["Fragility", "The study file"]
    assert len(told["curves"]) == 5
    rows = page.tables["fragility"]
    medians, capacities, factors = rows[1:6], rows[7:32], rows[32:]
    of_csv = read(out / "fragility_capacities.csv")
    assert [cells[0] for cells in capacities] == [row["record"] for row in of_csv]
    assert [float(cells[-1]) for cells in capacities] == pytest.approx(
        [100 * float(row["widest_step"]) for row in of_csv], rel=0.05
    )
    assert [cells[0] for cells in factors[2:]] == told["scales"]["records"]
    assert [cells[0] for cells in medians] == [curve["limit_state"] for curve in told["curves"]]


def test_where_first_exceedances_were_looked_for_is_said_once_and_drawn(ida):
    """On rigid ground in steps of 0.25 % up to the greatest capacity, a single dash; on pads at the four levels, a dash each."""
    out, printed = ida
    page = Page((out / "analyses.html").read_text(encoding="utf-8"))
    told = json.loads((out / "fragility.json").read_text(encoding="utf-8"))
    words = "in steps of 0.25 % from the lowest level up (rigid)", "at the levels alone, up to 100 % apart (pads)"
    assert "Strips above: intensities that were looked at." in page.text
    for text in (page.text, printed):
        assert [text.count(each) for each in words] == [1, 1]
    by_case = {one["case"]: one["looked"] for one in told["curves"] if one["limit_state"] == "overturning"}
    assert by_case["pads"] == [[x, x] for x in (0.2, 0.4, 0.6, 0.8)]
    ((low, high),) = by_case["rigid"]
    capacities = [row for row in read(out / "fragility_capacities.csv") if row["limit_state"] == "overturning"]
    bounds = [float(row["at_most"] or "inf") for row in capacities if row["case"] == "rigid"]
    assert (low, high) == (0.2, pytest.approx(min(max(bounds), 0.8)))
    steps = {case: [float(row["widest_step"]) for row in capacities if row["case"] == case] for case in by_case}
    assert max(steps["rigid"]) <= 0.0025 + 1e-9
    assert max(steps["pads"]) >= 0.3


def test_hunt_step_looks_between_the_levels_on_every_base(tmp_path):
    spec = read_fragility(load_study(written(tmp_path, f"{IDA}\nhunt_step = 0.05")))
    assert [spec.step_on(base) for base in (RigidBase(), ElasticBase(30.0))] == [0.05, 0.05]
    spec = read_fragility(load_study(written(tmp_path, IDA)))
    assert [spec.step_on(base) for base in (RigidBase(), ElasticBase(30.0))] == [0.0025, None]


def test_an_edited_or_damaged_analysis_is_reported(tmp_path, stripes):
    """Medians stand in fragility.json only: a digit that flipped would be a wrong curve."""
    out = shutil.copytree(stripes, tmp_path / "out")
    path, points_csv = out / "fragility.json", out / "fragility.csv"
    whole = path.read_text(encoding="utf-8")
    study = json.loads(whole)["study"]
    first = next(one for one in json.loads(whole)["curves"] if one["median"] is not None)
    other = whole.replace(f'"median": {first["median"]}', f'"median": {2 * first["median"]}', 1)
    assert other != whole
    of_another = whole.replace('"sha256": "', '"sha256": "0')
    for text, shown in ((other, True), (of_another, False), (whole[:-100], False), ("\xf4" + whole, False)):
        path.write_text(text, encoding="latin-1")
        with pytest.warns(EditedTable, match=r"fragility\.json: not as it was written"):
            assert (section(Contents(out, study)) != "") == shown
    path.write_text(whole, encoding="utf-8")
    assert section(Contents(out, study)) != ""
    points_csv.write_text(points_csv.read_text(encoding="utf-8").replace("0", "1", 1), encoding="utf-8")
    found = finished_analysis.read(out, "fragility", study["sha256"])
    with pytest.warns(EditedTable, match=r"fragility\.csv: not as it was written"):
        assert found.table("fragility.csv", ()) is not None
