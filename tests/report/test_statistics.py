"""Statistics of the suite: hand-computed, and no run drops out unnoticed."""

import csv
import math

import numpy as np
import pytest
from report_page import Page
from report_samples import FIG7, write_results

from rockbatch.quantities.statistics import quantile
from rockbatch.reporting import write_report
from rockbatch.reporting.finished import read
from rockbatch.reporting.sections import statistics
from rockbatch.results.suite_statistics import records, suite, suites


def page_of(folder):
    return Page(statistics.section(read(folder, ())))


def test_mean_median_and_percentiles_are_those_of_the_magnitudes():
    result = suite(np.array([0.1, -0.2, 0.3, 0.4, -0.5, 0.6]), ["ok"] * 6)
    assert (result.count, result.standing) == (6, 6)
    # 16 % of five intervals is 0.8 of the first, 84 % is 0.2 of the last
    expected = 0.35, 0.1 + 0.8 * 0.1, 0.35, 0.5 + 0.2 * 0.1, 0.6
    assert (result.mean, result.low, result.median, result.high, result.largest) == pytest.approx(expected, rel=1e-14)


def test_overturned_and_flying_runs_count_as_larger_and_are_in_no_mean():
    result = suite(np.array([0.1, 0.2, 0.3, 0.4, 7.0, 0.05, 9.0]), ["ok"] * 4 + ["overturned", "flight", "overturned"])
    assert (result.count, result.standing, result.overturned, result.flight, result.failed) == (7, 4, 2, 1, 0)
    assert result.mean == pytest.approx(0.25, rel=1e-14)
    assert result.median == 0.4  # fourth of seven, whatever the three came to
    assert result.low == pytest.approx(0.196, rel=1e-14)
    assert (result.high, result.largest) == (math.inf, math.inf)


def test_a_failed_run_is_counted_as_such_and_as_nothing_else():
    result = suite(np.array([0.1, math.nan]), ["ok", "failed"])
    assert (result.count, result.failed, result.mean, result.largest) == (1, 1, 0.1, 0.1)
    nothing = suite(np.array([math.nan]), ["failed"])
    assert (nothing.count, nothing.failed) == (0, 1)
    assert math.isnan(nothing.median)


def test_a_quantity_that_does_not_apply_has_no_statistics():
    assert suite(np.array([math.nan, math.nan]), ["ok", "ok"]).count == 0


def test_runs_of_one_station_count_once_with_the_worst_of_them():
    values = np.array([0.1, 0.4, 0.3, 0.2, 0.5, 7.0, 0.1, math.nan])
    status = ["ok", "ok", "ok", "ok", "ok", "overturned", "ok", "failed"]
    result = suite(values, status, ["A", "A", "B", "B", "C", "C", "D", "D"])
    assert (result.count, result.standing, result.overturned, result.failed) == (3, 2, 1, 1)
    assert result.mean == pytest.approx(0.35, rel=1e-14)
    assert (result.median, result.largest) == (0.4, math.inf)
    both = suite(np.array([1.0, 1.0]), ["flight", "overturned"], ["A", "A"])
    assert (both.count, both.overturned, both.flight) == (1, 1, 0)


def test_groups_that_are_taken_at_once_have_the_statistics_that_each_has_alone():
    rng = np.random.default_rng(3)
    group = rng.integers(0, 7, 300)  # of eight: the last has no runs
    values = np.where(rng.random(300) < 0.1, math.nan, rng.normal(size=300))
    status = rng.choice(["ok", "ok", "ok", "overturned", "flight", "failed"], 300).tolist()
    names = [f"S{i}" for i in rng.integers(0, 12, 300)]
    found = suites(values, status, names, group, 8)
    for place in range(7):
        of = np.flatnonzero(group == place)
        one = records(values[of], [status[i] for i in of], [names[i] for i in of])
        known = one.worst[one.known]
        told = found[place].low, found[place].median, found[place].high, found[place].largest
        assert told == tuple(quantile(known, q) for q in (0.16, 0.5, 0.84, 1.0))
        stood = known[np.isfinite(known)]
        assert (found[place].count, found[place].standing) == (len(known), len(stood))
        assert found[place].mean == pytest.approx(stood.mean(), rel=1e-12)
        assert found[place].overturned == len({names[i] for i in of if status[i] == "overturned"})
    assert (found[7].count, math.isnan(found[7].median)) == (0, True)


@pytest.mark.parametrize(("count", "n", "largest"), [("station", "3", "worse"), ("component", "6", "every")])
def test_the_table_counts_as_the_checks_do(tmp_path, count, n, largest):
    stations = {record: f"S{i // 2}" for i, (record, _) in enumerate(FIG7)}
    changes = {(record, "rigid"): {"theta_max_over_alpha": 0.1 * i} for i, (record, _) in enumerate(FIG7, 1)}
    changes = {key: values | {"station": stations[key[0]]} for key, values in changes.items()}
    for record, station in stations.items():
        for case in "1234":
            changes[record, case] = {"station": station}
    write_results(tmp_path, changes=changes, count=count)
    page = page_of(tmp_path)
    head = page.tables[""][0]
    row = dict(zip(head, next(row for row in page.tables[""] if row[0] == "rigid"), strict=True))
    assert row["n"] == n
    assert float(row["mean"]) == pytest.approx({"worse": 0.4, "every": 0.35}[largest])  # of 0.2, 0.4, 0.6; of 0.1 … 0.6
    assert "A record is a" in page.text


def test_the_table_says_how_many_stood_and_which_percentiles_fall_on_overturned_runs(tmp_path):
    changes = {(record, "2"): {"status": "overturned"} for record, _ in FIG7[:2]}
    write_results(tmp_path, changes=changes)
    page = page_of(tmp_path)
    rows = page.tables[""]
    head = rows[0]
    row = dict(zip(head, next(row for row in rows if row[0].startswith("2:")), strict=True))
    assert (row["n"], row["84 %"], row["maximum"], row["overturned"]) == ("6", "∞", "∞", "2")
    assert row["mean"].endswith(" of 4")
    assert math.isfinite(float(row["median"]))
    assert "counts as infinite (∞)" in page.text


def test_settlements_are_in_millimetres_and_the_rigid_base_has_none(tmp_path):
    write_results(tmp_path)
    page = page_of(tmp_path)
    with (tmp_path / "peaks.csv").open(encoding="utf-8", newline="") as file:
        settled = [float(row["settlement_m"]) for row in csv.DictReader(file) if row["case"] == "3"]
    rows = [row for row in page.tables[""] if row[0].startswith("3:")]
    assert float(rows[-1][2]) == pytest.approx(1000 * np.mean(settled), abs=0.005)
    assert sum(row[0] == "rigid" for row in page.tables[""]) == 1


def test_with_and_without_vertical_stand_side_by_side_where_both_were_run(tmp_path):
    write_results(tmp_path, vertical=(True, False))
    page = Page(write_report(tmp_path, []).read_text(encoding="utf-8"))
    over, head, *rows = page.tables["suite"]
    assert over[1:3] == ["n", "mean"]
    assert head[1:5] == ["with vertical", "without vertical"] * 2
    with (tmp_path / "peaks.csv").open(encoding="utf-8", newline="") as file:
        runs = [row for row in csv.DictReader(file) if row["case"] == "rigid"]
    means = [
        np.mean([float(row["theta_max_over_alpha"]) for row in runs if row["vertical"] == way])
        for way in ("True", "False")
    ]
    assert [float(cell) for cell in rows[0][3:5]] == pytest.approx(means, abs=0.5e-4)
    assert "with and without the vertical component" in page.text
