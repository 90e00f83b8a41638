"""From records at rising intensities to fragility curves: scaling, limits, bisection, resuming, files and messages."""

import csv
import itertools
import json
import math
from dataclasses import replace

import numpy as np
import pytest
from report_page import Page

import rockbatch as rb
from rockbatch.analysis.fragility import ScaledRuns, assess, intensities
from rockbatch.analysis.ida import Bracket, bisect, bracket
from rockbatch.analysis.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD, states
from rockbatch.analysis.lognormal import Lognormal
from rockbatch.analysis.waves import Waves
from rockbatch.batch import digests
from rockbatch.checks import Rule
from rockbatch.cli import main
from rockbatch.engines import Threads
from rockbatch.errors import InputError
from rockbatch.journal import Journal
from rockbatch.motions.measures import pga, pgd, pgv
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.report.fragility import section
from rockbatch.results import columns
from rockbatch.study import load_study
from rockbatch.study.fragility import read_fragility
from rockbatch.study.suite import ground_motions

STUDY = """
title = "Fragility of a small pier"

[pier]
alpha = 0.2
p = 2.0

[motions]
polarity = ["+", "-"]

{pulses}

[numerics]
tolerance = 1e-3

[fragility]
{fragility}

[[case]]
name = "rigid"
base = "rigid"

[[case]]
name = "pads"
base = "yielding"
beta = 60
eta = 3.0
epsilon = 0.1
flight = "guided"

[[check]]
name = "half way"
demand = "theta_max_over_alpha"
at_most = 0.5
reason = "margin"

[[check]]
name = "settlement"
demand = "settlement_m"
at_most = 0.005
reason = "bearings"

[[check]]
name = "bearing"
demand = "eta"
at_least = 2.0
reason = "of the case, about no record"
"""
PULSE = """
[[motions.pulse]]
name = "{name}"
shape = "{shape}"
amplitude_g = 0.4
period_s = {period}
dt_s = 0.01
duration_s = 6.0
"""
STRIPES = 'measure = "PGA"\nlevels_g = [0.2, 0.4, 0.6, 0.8]'
IDA = f'method = "ida"\ntolerance = 0.02\n{STRIPES}'


def written(tmp_path, fragility):
    shapes = [("sine", 0.6), ("sine", 1.0), ("cosine", 0.7), ("ricker", 0.9), ("ricker", 1.4)]
    pulses = "".join(PULSE.format(name=f"{shape} {t} s", shape=shape, period=t) for shape, t in shapes)
    path = tmp_path / "study.toml"
    path.write_text(STUDY.format(pulses=pulses, fragility=fragility), encoding="utf-8")
    return path


def read(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


class Interrupted(Threads):
    """Breaks off in the middle of the wave ``last``."""

    def __init__(self, last):
        super().__init__(1)
        object.__setattr__(self, "left", [last])

    def outcomes(self, runs, numerics, output):
        for group in super().outcomes(runs, numerics, output):
            if self.left[0] == 0:
                yield group[: len(group) // 2]
                raise KeyboardInterrupt
            yield group
        self.left[0] -= 1


def journal_of(study, spec, directory):
    found = ground_motions(study).motions
    return found, Journal(directory / "runs.csv.part", columns(study), digests(found, levels=spec))


# Scaling


def oscillator(acceleration, dt, period, damping):
    """u'' + 2ζω u' + ω² u = −a by the trapezoidal rule with 40 steps per sample."""
    omega = 2 * math.pi / period
    fine = np.interp(np.arange(0, len(acceleration) - 1, 1 / 40), np.arange(len(acceleration)), acceleration)
    h = dt / 40
    step = np.array([[0, 1], [-(omega**2), -2 * damping * omega]])
    forward = np.linalg.inv(np.eye(2) - h / 2 * step)
    state, most = np.zeros(2), 0.0
    for a, b in itertools.pairwise(fine):
        state = forward @ ((np.eye(2) + h / 2 * step) @ state + np.array([0, -h * (a + b) / 2]))
        most = max(most, abs(state[0]))
    return omega**2 * most


@pytest.mark.parametrize("period", [0.05, 0.4, 2.0])
def test_spectral_acceleration_is_that_of_an_oscillator_integrated_otherwise(period):
    """A peak between samples Δ apart is missed by up to (πΔ/T)²/2, of which there are 20 a period at least; the
    trapezoidal rule is off by less than 1e-3."""
    motion = np.concatenate((np.random.default_rng(1).normal(0, 1, 200), np.zeros(300)))
    found = spectral_acceleration(motion, 0.01, [period])[0]
    missed = (math.pi * min(0.01 / period, 1 / 20)) ** 2 / 2
    assert found == pytest.approx(oscillator(motion, 0.01, period, 0.05), rel=missed + 1e-3)


def test_a_stiff_oscillator_feels_the_peak_of_the_ground_and_a_soft_one_its_displacement():
    """An undamped oscillator overshoots a slow change by nothing: T is 1/1000 of the pulse's period, then 1000 times it."""
    motion = rb.pulse("sine", name="one-sine", amplitude=3.0, period=1.0, dt=0.01, duration=2.0)
    stiff, soft = spectral_acceleration(motion.horizontal, 0.01, [0.001, 1000.0], damping=0.0)
    assert stiff == pytest.approx(3.0, rel=1e-3)
    assert soft == pytest.approx((2 * math.pi / 1000) ** 2 * pgd(motion.horizontal, 0.01), rel=1e-3)


def test_a_period_or_damping_out_of_range_is_told():
    with pytest.raises(InputError, match="period = 0: must be a number above 0") as caught:
        spectral_acceleration(np.ones(3), 0.01, [0.0], damping=1.0)
    assert "damping = 1: must be within 0" in str(caught.value)


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
        for run, point in zip(runs, runs.points, strict=True):
            assert measure(run.motion.horizontal) == pytest.approx(point.intensity, rel=1e-12)
            assert run.motion.horizontal == pytest.approx(
                run.scale * run.recorded.horizontal * (1 if run.polarity == "+" else -1)
            )
            seen.append((run.motion.name, run.polarity, point.intensity, run.case.name))
        raise StopIteration

    with pytest.raises(StopIteration):
        assess(study, spec, motions, simulate)
    assert len(set(seen)) == len(seen) == 5 * 2 * len(spec.levels) * 2


def test_a_motion_without_intensity_is_told(tmp_path):
    study = load_study(written(tmp_path, STRIPES))
    still = rb.Motion("still", 0.01, np.zeros(10))
    with pytest.raises(InputError, match="still: its horizontal component has PGA = 0"):
        intensities([still], read_fragility(study), 9.81)


# Limits


def of_statuses(statuses, theta=0.4, error=0.01):
    """Rows of peaks.csv with these statuses, and their case."""
    import pandas as pd

    n = len(statuses)
    rows = {"status": statuses, "theta_max_over_alpha": [theta] * n, "theta_max_error": [error] * n}
    flew = [1.0 if status == "flight" else np.nan for status in statuses]
    return pd.DataFrame(rows | {"flight_s": flew, "polarity": ["+"] * n})


@pytest.mark.parametrize(
    ("rule", "expected"),
    [
        ({"at_most": 0.5}, [WITHSTOOD, EXCEEDED, UNDECIDED, UNDECIDED]),
        ({"at_most": 0.3}, [EXCEEDED, EXCEEDED, EXCEEDED, UNDECIDED]),
        ({"at_most": 0.405}, [UNDECIDED, EXCEEDED, UNDECIDED, UNDECIDED]),
        ({"at_most": 0.5, "flight": "infinite", "failed": "left out"}, [WITHSTOOD, EXCEEDED, EXCEEDED, LEFT_OUT]),
        ({"at_most": 0.5, "statistic": "asce7-16"}, [WITHSTOOD, EXCEEDED, EXCEEDED, EXCEEDED]),
        ({"at_most": 3, "statistic": "count", "above": 0.3}, [EXCEEDED, EXCEEDED, EXCEEDED, UNDECIDED]),
        ({"at_most": 0.5, "polarity": "-"}, [LEFT_OUT] * 4),
    ],
)
def test_a_run_that_did_not_go_through_counts_as_its_check_says(rule, expected):
    runs = of_statuses(["ok", "overturned", "flight", "failed"])
    found = states(Rule("check", "theta_max_over_alpha", **rule), runs, {"base": "rigid", "pier": {"alpha": 0.2}})
    assert list(found) == expected


def test_whether_a_run_that_was_cut_short_would_have_overturned_is_undecided():
    runs = of_statuses(["ok", "overturned", "flight", "failed"])
    found = states(Rule("overturning", "overturned", at_most=0), runs, {"base": "rigid"})
    assert list(found) == [WITHSTOOD, EXCEEDED, UNDECIDED, UNDECIDED]


# Bisection


def test_the_first_exceedance_counts_and_what_withstands_above_it_is_counted():
    levels = [0.2, 0.4, 0.6, 0.8, 1.0]
    assert bracket(levels, [0, 0, 2, 0, 2]) == Bracket(0.4, 0.6, returns=1)
    assert bracket(levels, [0, LEFT_OUT, 1, 2, 2]) == Bracket(0.2, 0.6, undecided=True)
    assert bracket(levels, [2, 2, 2, 2, 2]) == Bracket(0.0, 0.2)
    assert bracket(levels, [0, 0, 0, 0, LEFT_OUT]) == Bracket(0.8, math.inf)
    assert bracket(levels, [LEFT_OUT] * 5) is None


def test_bisection_goes_in_waves_and_closes_every_bracket_to_the_tolerance():
    truth = {"a": 0.41, "b": 0.5999, "c": 0.7}
    waves = []

    def look(wanted):
        waves.append(sorted(wanted))
        return {key: EXCEEDED if x >= truth[key] else WITHSTOOD for key, x in wanted.items()}

    start = {"a": Bracket(0.4, 0.8), "b": Bracket(0.4, 0.8), "c": Bracket(0.0, 0.8), "d": Bracket(1.0, math.inf)}
    found = bisect(start, 0.01, look)
    for key in "ab":
        assert found[key].low < truth[key] <= found[key].high <= 1.01 * found[key].low
    assert (found["c"], found["d"]) == (start["c"], start["d"])
    assert waves == [["a", "b"]] * 7  # ln 2 / ln 1.01 = 69.7 < 2⁷


def test_bisection_ends_below_what_is_undecided_and_says_so():
    def look(wanted):
        return {key: WITHSTOOD if x < 0.5 else UNDECIDED if x < 0.6 else EXCEEDED for key, x in wanted.items()}

    found = bisect({"a": Bracket(0.4, 0.8)}, 1e-3, look)["a"]
    assert found.undecided
    assert found.low < 0.5 <= found.high <= 1.001 * found.low


@pytest.mark.parametrize(("shape", "first", "last"), [("half-sine", 3.289147, math.inf), ("sine", 3.018600, 6.318071)])
def test_the_amplitude_of_overturning_is_that_of_the_closed_form(tmp_path, shape, first, last):
    """Slender block, e = 0.9, ω_p/p = 5 (test_known_overturning): the one-sine's second safe window is 6.318–7.168.

    The level 6.8 is inside it: the first exceedance is found all the same, and that the block stands there is counted.
    Tolerance 1e-4, and as much for the pulse that is linear between 400 samples a period.
    """
    alpha, period = 1e-4, 2 * math.pi / 5
    unit = math.tan(alpha)
    levels = [2.5 * unit, 4.5 * unit, 6.8 * unit, 7.5 * unit]
    text = f"""
        [pier]
        alpha = {alpha}
        p = 1.0
        [numerics]
        substeps = 1
        quiet_s = 0.0
        [fragility]
        method = "ida"
        measure = "PGA"
        levels_g = {levels}
        tolerance = 1e-4
        [[motions.pulse]]
        name = "pulse"
        shape = "{shape}"
        amplitude_g = 1.0
        period_s = {period}
        dt_s = {period / 400}
        duration_s = {period}
        [[case]]
        base = "rigid"
        restitution = 0.9
        """
    path = tmp_path / "study.toml"
    path.write_text(text, encoding="utf-8")
    study = load_study(path)
    spec = read_fragility(study)
    motions, journal = journal_of(study, spec, tmp_path)
    with journal:
        (curve,) = assess(study, spec, motions, Waves(study, journal, Threads(1)))
    ((_, found),) = curve.capacities
    assert found.low / unit == pytest.approx(first, rel=2e-4)
    assert found.high / unit == pytest.approx(first, rel=2e-4)
    assert found.returns == (1 if last < 6.8 else 0)


# The whole


def test_a_search_that_is_interrupted_goes_on_to_the_same_runs_and_curves(tmp_path):
    study = load_study(written(tmp_path, IDA))
    spec = read_fragility(study)

    def searched(folder, engines):
        motions, journal = journal_of(study, spec, folder)
        for engine in engines:
            try:
                with journal:
                    waves = Waves(study, journal, engine)
                    curves = assess(study, spec, motions, waves)
                    journal.write_in_order(folder / "runs.csv")
            except KeyboardInterrupt:
                assert (folder / "runs.csv.part").exists()
        return waves.finished, curves, (folder / "runs.csv").read_bytes()

    straight = searched(tmp_path / "straight", [Threads(1)])
    resumed = searched(tmp_path / "resumed", [Interrupted(0), Interrupted(2), Threads(2)])
    assert straight[0] == resumed[0] > 5 * 2 * 4 * 2
    assert straight[2] == resumed[2]
    for one, other in zip(straight[1], resumed[1], strict=True):
        assert (one.stripes, one.capacities) == (other.stripes, other.capacities)


def test_the_command_writes_points_curves_capacities_and_all_runs(tmp_path, capsys):
    out = tmp_path / "results"
    assert main(["fragility", str(written(tmp_path, IDA)), "--out", str(out), "--jobs", "2"]) == 0
    printed = capsys.readouterr().out
    points, capacities, runs = (read(out / f"fragility{name}.csv") for name in ("", "_capacities", "_runs"))
    told = json.loads((out / "fragility.json").read_text(encoding="utf-8"))
    limits = ["overturning", "half way", "settlement"]
    assert list(dict.fromkeys(point["limit_state"] for point in points)) == limits
    assert len(points) == 4 * (2 + 2 + 1)  # a rigid base does not settle, and eta is about no record
    assert {(one["limit_state"], one["case"]) for one in told["curves"]} == {
        (limit, case) for limit in limits for case in ("rigid", "pads") if (limit, case) != ("settlement", "rigid")
    }
    assert len(capacities) == 5 * 5
    for one in capacities:
        if one["found"] == "exceeded":
            assert float(one["above"]) < float(one["at_most"]) <= 1.02 * float(one["above"]) * (1 + 1e-9)
            assert float(one["scale_at_most"]) == pytest.approx(float(one["at_most"]) / 0.4, rel=0.05)
    overturned = {(run["record"], run["case"]) for run in runs if run["status"] == "overturned"}
    found = {
        (one["record"], one["case"]) for one in capacities if one["limit_state"] == "overturning" and one["at_most"]
    }
    assert overturned == found
    assert "Fragility for PGA, incremental dynamic analysis" in printed
    assert "half way: theta_max_over_alpha > 0.5" in printed
    assert not (out / "fragility_runs.csv.part").exists()


def test_stripes_count_a_record_once_with_the_worse_of_its_polarities(tmp_path):
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


def test_undecided_runs_count_as_exceeded_and_the_other_way_is_told(tmp_path):
    study = load_study(written(tmp_path, STRIPES))
    spec = replace(
        read_fragility(study), limits=(Rule("half way", "theta_max_over_alpha", at_most=0.5, overturned="unknown"),)
    )

    def simulate(runs):
        """Overturns above a scale that differs from record to record; that it does so counts as unknown."""
        rows = of_statuses(["overturned" if p.intensity > 0.25 + 0.12 * p.motion else "ok" for p in runs.points])
        return rows

    curve = assess(study, spec, ground_motions(study).motions, simulate)[0]
    assert [stripe.undecided for stripe in curve.stripes] == [0, 2, 3, 5]
    assert [stripe.exceeded for stripe in curve.stripes] == [0, 0, 0, 0]
    assert isinstance(curve.fitted, Lognormal)
    assert curve.otherwise == "no record exceeds the limit up to 0.8: the median is beyond"


@pytest.mark.parametrize(
    ("fragility", "words"),
    [
        ("", ["measure is missing"]),
        ('measure = "PGD"', ['expected one of "PGA", "PGV", "Sa"; did you mean']),
        ('measure = "PGA"', ["levels_g is missing"]),
        ('measure = "PGA"\nlevels_m_s = [0.2, 0.4]', ["levels_m_s: PGA is given in g; write levels_g"]),
        ('measure = "Sa"\nlevels_g = [0.2, 0.4]', ["period_s is missing"]),
        (
            'measure = "PGA"\nperiod_s = 1.0\nlevels_g = [0.2]',
            ['period_s: is for measure = "Sa"', "one level tells no"],
        ),
        ('measure = "PGA"\nlevels_g = [0.4, 0.2]', ["levels_g = 0.2: after 0.4; write them in rising order"]),
        (f"{STRIPES}\ntolerance = 0.1", ['tolerance: is for method = "ida"']),
        (f'{STRIPES}\nmethod = "IDA"', ['did you mean "ida"?']),
        (
            f'{STRIPES}\nchecks = ["half-way"]',
            ['checks = "half-way": no [[check]] is called so; did you mean "half way"?'],
        ),
        (f"{STRIPES}\nconfidence = 1.0", ["confidence = 1.0: expected a number, 0 or above and below 1"]),
    ],
)
def test_mistakes_in_the_settings_are_told_with_their_line(tmp_path, capsys, fragility, words):
    path = written(tmp_path, fragility)
    assert main(["fragility", str(path), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    for word in words:
        line = next(line for line in told.splitlines() if word in line)
        assert f"{path}:" in line
        assert "[fragility]" in line
    assert not (tmp_path / "out").exists()


def test_a_study_without_the_table_is_told_what_to_write(tmp_path, capsys):
    path = written(tmp_path, STRIPES)
    path.write_text(path.read_text(encoding="utf-8").replace("[fragility]", "[output]\n[other]"), encoding="utf-8")
    text = path.read_text(encoding="utf-8").replace("[other]\n" + STRIPES, "")
    path.write_text(text, encoding="utf-8")
    assert main(["fragility", str(path)]) == 2
    assert '[fragility] is missing; write [fragility] with measure = "PGV"' in capsys.readouterr().err


# The report


def page_of(tmp_path, fragility):
    """The page that the command leaves, and its folder."""
    out = tmp_path / "results"
    assert main(["fragility", str(written(tmp_path, fragility)), "--out", str(out), "--jobs", "2"]) == 0
    return Page((out / "analyses.html").read_text(encoding="utf-8")), out


def test_the_report_has_a_panel_for_each_limit_and_every_curve_in_its_table(tmp_path):
    page, out = page_of(tmp_path, IDA)
    told = json.loads((out / "fragility.json").read_text(encoding="utf-8"))
    assert page.mismatched == []
    assert page.headings == ["Fragility", "The study file"]
    assert len(page.tables["fragility"]) == 1 + len(told["curves"]) == 6
    for cells, one in zip(page.tables["fragility"][1:], told["curves"], strict=True):
        assert one["limit_state"] in cells[0]
        assert one["note"] == cells[-1] or one["note"] == ""
        if one["median"] is not None:
            assert f"{one['median']:.3g}" in cells
    fitted = [one for one in told["curves"] if one["median"] is not None]
    classes = [value or "" for name, value in page.attributes if name == "class"]
    assert sum(value.startswith("area ") for value in classes) == len(fitted) >= 3
    assert sum(value == "whole" for value in classes) == 1


def test_bands_of_the_report_hold_their_curves_and_rise_with_the_intensity(tmp_path):
    _, out = page_of(tmp_path, STRIPES)
    for one in json.loads((out / "fragility.json").read_text(encoding="utf-8"))["curves"]:
        if "curve" in one:
            low, p, high = (np.array(one["curve"][name]) for name in ("low", "p", "high"))
            assert (low <= p).all()
            assert (p <= high).all()
            assert (np.diff(p) >= 0).all()


def test_the_report_leaves_out_curves_of_another_state_of_the_study(tmp_path):
    _, out = page_of(tmp_path, STRIPES)
    digest = json.loads((out / "fragility.json").read_text(encoding="utf-8"))["study"]["sha256"]
    assert section(out, digest) == section(out, None) != ""
    assert section(out, "another") == section(tmp_path, None) == ""
    assert not (out / "fragility_capacities.csv").exists()
