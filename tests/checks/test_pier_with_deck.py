"""The pier with its deck on five real stations, from its file to verdicts that name what governs, all of it recomputed."""

import csv
import json
import math
from pathlib import Path

import pytest
from report_page import Page
from studies import write_study

import rockbatch as rb
from rockbatch.batch.preparing import run_count
from rockbatch.commands.cli import main
from rockbatch.study.suite import ground_motions

pytestmark = pytest.mark.usefixtures("pages")

STUDY = Path(rb.__file__).parents[1] / "configs" / "pier_with_deck.toml"
STATIONS = {"NBLC", "PRPC", "1336", "HSES", "WTMC"}
MEASURED = ["drift at the bearings", "uplift of the heel"]
LABELS = {
    "CHAN24": "Imperial Valley 1979, Meloland Overpass, 270",
    "20161113_110259_WTMC_20.N28W": "Waiau 2016, Te Mara Farm, N28W",
}

# By hand: shaft 2,100 t with its centre at 20 m, deck 1,400 t at 41.5 m; half of the width is 3.5 m
HEIGHT = (2100 * 20 + 1400 * 41.5) / 3500
ALPHA = math.atan(3.5 / HEIGHT)
LEVERS = {"drift at the bearings": 40.0 * ALPHA, "uplift of the heel": 7.0 * ALPHA}


@pytest.fixture(scope="module")
def out(tmp_path_factory):
    """The study's results, but with nothing that guides the pier in flight on rigid ground: a run there ends with it."""
    folder = tmp_path_factory.mktemp("deck")
    text = STUDY.read_text(encoding="utf-8").replace('base = "rigid"', 'base = "rigid"\nflight = "stop"')
    text = text.replace('"../motions/near_fault"', json.dumps(str(STUDY.parents[1] / "motions" / "near_fault")))
    study = write_study(folder, text, STUDY.name)
    # Te Mara Farm lifts the pier off rigid ground, which leaves checks there undecided
    assert main(["run", str(study), "--out", str(folder / "out")]) == 1
    return folder / "out"


def rows(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_the_study_has_the_five_stations_that_come_with_it(out):
    peaks = rows(out / "peaks.csv")
    assert {row["station"] for row in peaks} == STATIONS
    assert len(peaks) == 3 * 10
    judged = [row for row in rows(out / "checks.csv") if row["statistic"] and row["verdict"] != "does not apply"]
    assert {row["records"] for row in judged} == {"5"}


@pytest.mark.parametrize("stiffness", ["2500000", "5000000"])
@pytest.mark.parametrize("check", MEASURED)
def test_the_verdict_on_pads_is_the_most_unfavourable_station_by_plain_arithmetic(out, check, stiffness):
    """Five stations are fewer than seven, so that the greatest counts; the mean of ten components is less than half."""
    runs = [row for row in rows(out / "peaks.csv") if row["stiffness_kN_m"] == stiffness]
    worst = max(runs, key=lambda row: float(row["theta_max_over_alpha"]))
    value = LEVERS[check] * float(worst["theta_max_over_alpha"])
    (found,) = [row for row in rows(out / "checks.csv") if (row["check"], row["stiffness_kN_m"]) == (check, stiffness)]
    assert float(found["value"]) == pytest.approx(value, rel=1e-8)
    assert float(found["margin"]) == pytest.approx(float(found["limit"]) - value, rel=1e-7)
    assert (found["station"], found["record"], found["unit"]) == (worst["station"], worst["record"], "m")
    assert float(found["governing"]) == pytest.approx(value, rel=1e-8)
    assert found["verdict"] == ("pass" if value < float(found["limit"]) else "fail")


def test_flight_on_rigid_ground_leaves_open_what_the_pier_comes_to(out):
    peaks = rows(out / "peaks.csv")
    flown = {row["record"] for row in peaks if row["case"] == "rigid" and row["status"] == "flight"}
    drift = next(row for row in rows(out / "checks.csv") if (row["check"], row["case"]) == (MEASURED[0], "rigid"))
    assert drift["verdict"] == "not decided"
    assert drift["station"] == "WTMC"
    assert drift["record"] in flown


def test_the_report_names_station_component_value_unit_and_margin(out):
    text = (out / "report.html").read_text(encoding="utf-8")
    table = [row for row in Page(text).tables["checks"] if row[0] == MEASURED[0] and "pads" in row[1]]
    assert len(table) == 2
    for row, found in zip(
        table,
        [row for row in rows(out / "checks.csv") if row["check"] == MEASURED[0] and row["case"] == "pads"],
        strict=True,
    ):
        assert row[2].replace("\u00a0", " ") == f"✓ {found['verdict']}"
        assert row[3] == f"{float(found['value']):.4g}"
        assert f"{float(found['margin']):.3g}" in row
        assert "m" in row
        assert any(f"{LABELS[found['record']]} (+), {float(found['value']):.4g} m" in cell for cell in row)
    assert "report of EN 1998-2; the standard's own text could not be checked" in Page(text).text


def test_every_place_counts_ten_records_of_five_stations(out, capsys):
    study = rb.load_study(STUDY)
    assert run_count(study, ground_motions(study)).startswith("10 records of 5 stations × 3 cases = 30 runs")
    assert main(["motions", "--all", str(STUDY.parents[1] / "motions" / "near_fault")]) == 0
    shown = capsys.readouterr()
    head, *lines = shown.out.splitlines()
    place = head.index("counts as")
    assert {line[place:].split()[0] for line in lines[:10]} == STATIONS
    assert "10 records, 0 files not used, 0 left out; 5 stations" in shown.err
    tables = Page((out / "report.html").read_text(encoding="utf-8")).tables
    place = tables["records"][0].index("code")
    assert {row[place] for row in tables["records"][1:11]} <= STATIONS
    place = tables["suite"][0].index("n")
    assert {row[place] for row in tables["suite"][1:3]} == {"5"}  # the rigid base has a record without a peak, too


def test_the_terminal_says_the_same(out, capsys):
    assert main(["check", str(out), "--all"]) == 1
    printed = " ".join(capsys.readouterr().out.split())
    for found in rows(out / "checks.csv"):
        if found["check"] == MEASURED[0] and found["case"] == "pads":
            assert f"governs: {LABELS[found['record']]} (+), {float(found['value']):.4g} m" in printed
    assert "left open by Waiau 2016, Te Mara Farm" in printed
