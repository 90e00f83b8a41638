"""Sections on the suite: its distribution, target spectrum and pulses, intensity measures."""

import json
import math

import pandas as pd
import pytest
from report_page import Page
from report_samples import case_entry, write_results
from studies import COSINE, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.observers.forces import section as forces
from rockbatch.observers.intensity import section as intensity
from rockbatch.observers.intensity.table import measures_in
from rockbatch.pier import Pier, YieldingBase
from rockbatch.reporting import write_report
from rockbatch.reporting.finished import read
from rockbatch.reporting.sections import distribution, studied, target

PULSES = tuple(
    {**shape, "name": f"{shape['shape']} {size}", "amplitude_g": size}
    for shape in (SINE, COSINE)
    for size in (0.15, 0.3, 0.6)
)


@pytest.fixture(scope="module")
def asked(tmp_path_factory):
    """Write a folder of a study that asks for all of these sections."""
    folder = tmp_path_factory.mktemp("suite")
    text = study_text(
        pier={"alpha": [0.2, 0.3], "p": 1.0},
        motions={"target": {"spectrum": [[0.1, 1.0], [2.0, 0.4]], "period_range_s": [0.2, 1.5], "factors": "none"}},
        pulses=PULSES,
        output={"intensity": True, "histories": "none"},
    )
    rb.run(write_study(folder, text), out=folder / "out")
    return folder / "out"


def page_of(folder, module):
    return Page(module.section(read(folder, ())))


# The distribution


def test_every_report_says_that_one_record_predicts_nothing_and_shows_the_suite(tmp_path):
    write_results(tmp_path, changes={("CPM000", "2"): {"status": "overturned"}, ("SYL360", "2"): {"status": "flight"}})
    section = distribution.section(read(tmp_path, ()))
    page = Page(section)
    assert "is not a prediction" in page.text
    assert "Bachmann" in page.text
    assert "33 % overturned, or ended by flight" in section
    assert section.count("<figure") == 2  # the whole, and one panel
    assert section.count('data-name="') == 5


def test_too_few_motions_have_no_distribution(tmp_path):
    write_results(tmp_path, records=[("A", 0.3), ("B", 0.4)])
    page = page_of(tmp_path, distribution)
    assert "too few records" in page.text
    assert "is not a prediction" in page.text


def test_of_too_many_foundations_the_best_are_drawn(tmp_path):
    pier = Pier(alpha=0.13, p=0.38)
    etas = [2.0 + 0.1 * i for i in range(25)]
    cases = [case_entry("soil", {"eta": eta}, pier, YieldingBase(beta=40.0, eta=eta)) for eta in etas]
    write_results(tmp_path, cases=cases, varied=("eta",))
    content = distribution.section(read(tmp_path, ()))
    assert content.count('data-name="') == 7
    assert "The 7 best of 25 foundations are shown." in content


# Intensity measures


@pytest.mark.slow
def test_intensity_measures_are_shown_by_case_with_the_best_of_each(asked):
    shown = page_of(asked, intensity)
    order = rb.open_results(asked).intensity_order
    assert "they share the highest rank" in shown.text
    assert "In every row: runs 6" in shown.text
    rows = [row for row in shown.tables[""] if row[0] != "case"]
    ranks, lines = rows[:4], rows[4:]
    for row, (_, same) in zip(ranks, order.groupby(["case", "alpha"], sort=False), strict=True):
        measures = same.set_index("measure")
        assert row[-len(measures) :] == [f"{value:.2f}" for value in measures["rank_correlation"]]
        assert measures_in(measures.index)[measures["rank_correlation"].idxmax()].symbol in row
    for row, (_, same) in zip(lines, order.groupby(["case", "alpha"], sort=False), strict=True):
        measures = same.set_index("measure")
        assert row[-len(measures) :] == ["—" if value != value else f"{value:.2f}" for value in measures["dispersion"]]


# The target spectrum


def test_the_target_is_drawn_with_every_record_and_the_mean_over_it(asked):
    section = target.section(read(asked, ()))
    page = Page(section)
    for name in ("target", "mean of the records", *(pulse["name"] for pulse in PULSES)):
        assert f'data-name="{name}"' in section
    saved = json.loads((asked / "run.json").read_text(encoding="utf-8"))["target"]
    over = [mean / aim for mean, aim in zip(saved["mean_sa_g"], saved["sa_g"], strict=True)]
    assert f"is between {min(over):.2f} of the target" in page.text
    assert f"and {max(over):.2f}, at " in page.text
    assert min(over) > 0.0
    assert ": below the" not in page.text  # which is only compared
    assert "The records are not scaled to the target" in page.text
    assert "no conformity is claimed" in page.text


def test_pulses_and_distances_are_counted(asked, tmp_path):
    info = json.loads((asked / "run.json").read_text(encoding="utf-8"))
    pulses = [record for record in info["records"] if record["pulse_period_s"] is not None]
    page = page_of(asked, target)
    assert f"{len(pulses)} of 6 horizontal components" in page.text
    assert "No distance from the source is known" in page.text
    for record, distance in zip(info["records"], (5.0, 15.0, 40.0, None, None, None), strict=True):
        record["distance_km"] = distance
    (tmp_path / "run.json").write_text(json.dumps(info), encoding="utf-8")
    (tmp_path / "peaks.csv").write_bytes((asked / "peaks.csv").read_bytes())
    text = page_of(tmp_path, target).text
    assert "Of 3 components with a known distance 2 were recorded within 15 km; for the other 3 it is not known" in text


def test_stations_without_a_pair_are_named_if_pairs_are_requested(asked, tmp_path):
    info = json.loads((asked / "run.json").read_text(encoding="utf-8"))
    info["target"] |= {"pairs": "srss", "alone": 6}
    (tmp_path / "run.json").write_text(json.dumps(info), encoding="utf-8")
    (tmp_path / "peaks.csv").write_bytes((asked / "peaks.csv").read_bytes())
    text = page_of(tmp_path, target).text
    assert "6 stations without two components" in text
    assert "the square root of the sum of their components' squares" in text
    assert "without two components" not in page_of(asked, target).text


def test_the_page_of_it_all_is_whole_and_spectra_are_drawn_once(asked):
    text = write_report(asked).read_text(encoding="utf-8")
    assert text.count('aria-label="Response spectra of') == 1
    headings = Page(text).headings
    names = (
        "Statistics of the suite", "One record and the suite", "Intensity measures",
        "What was studied", "Statics", "Ground motions", "The suite against its target spectrum",
    )  # fmt: skip
    places = [headings.index(name) for name in names]
    assert places == sorted(places)
    assert math.isfinite(rb.open_results(asked).intensity["cav_m_s"].sum())


@pytest.mark.parametrize(
    ("last", "said"), [(1.274, "by 1.274;"), (2.5, "by 1.274 to 2.5;"), (0.75, "by 0.75 to 1.274;")]
)
def test_measures_of_scaled_motions_are_not_called_as_recorded(tmp_path, last, said):
    """Scale to a target: PGA and other measures are those of the motions as they were run."""
    write_results(tmp_path)
    saved = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    saved["records"] = [record | {"factor": 1.274} for record in saved["records"]]
    saved["records"][-1]["factor"] = last
    (tmp_path / "run.json").write_text(json.dumps(saved), encoding="utf-8")
    text = page_of(tmp_path, studied).text
    assert f"scaled to the target {said}" in text
    assert "as recorded" not in text


def test_the_table_of_foundations_has_what_each_case_was_given(tmp_path):
    """β and η as given; static deflection g/(β p)² and η times it."""
    write_results(tmp_path)
    head, *rows = page_of(tmp_path, studied).tables[""]
    names = ("case", "base", "β", "η", "ε", "δs [mm]", "δy [mm]")
    shown = [[row[head.index(name)] for name in names] for row in rows]
    assert shown[0] == ["rigid", "rigid", "", "", "", "", ""]
    given = [(40.0, 2.5), (40.0, 3.5), (80.0, 2.5), (80.0, 3.5)]
    for number, (row, (beta, eta)) in enumerate(zip(shown[1:], given, strict=True), 1):
        static = 1000.0 * 9.81 / (beta * 0.38) ** 2
        assert row[:2] == [str(number), "yielding"]
        assert [float(cell) for cell in row[2:]] == pytest.approx([beta, eta, 0.05, static, eta * static], abs=0.006)


def test_forces_of_a_case_with_runs_that_did_not_go_through_are_marked_as_bounds(tmp_path):
    write_results(tmp_path, changes={("ERZ-NS", "1"): {"status": "failed", "reason": "not settled"}})
    peaks = pd.read_csv(tmp_path / "peaks.csv")
    peaks["base_shear_m_s2"] = peaks["status"].map({"ok": 2.5})
    peaks.to_csv(tmp_path / "peaks.csv", index=False)
    rows = page_of(tmp_path, forces).tables[""]
    place = next(i for i, head in enumerate(rows[0]) if "V/M" in head)
    by_case = {row[0]: [cell.replace("\u00a0", " ") for cell in row] for row in rows[1:6]}
    cut, whole = (next(row for name, row in by_case.items() if name.startswith(case)) for case in ("1", "2"))
    assert (cut[1], cut[place]) == ("5 of 6", "≥ 2.500")
    assert (whole[1], whole[place]) == ("6 of 6", "2.500")


def test_components_count_by_station_and_each_by_itself_without_one(asked, tmp_path):
    info = json.loads((asked / "run.json").read_text(encoding="utf-8"))
    for record, station, pulse in zip(info["records"], ("S", "S", None, None, None, "T"), "yynnnn", strict=True):
        record |= {"station": station, "pulse_period_s": {"y": 2.0, "n": None}[pulse]}
    (tmp_path / "run.json").write_text(json.dumps(info), encoding="utf-8")
    (tmp_path / "peaks.csv").write_bytes((asked / "peaks.csv").read_bytes())
    assert "pulse-like, at 1 of 5 stations" in " ".join(page_of(tmp_path, target).text.split())


def test_what_was_done_with_a_record_stands_beside_it_and_nothing_where_nothing_was(tmp_path):
    write_results(tmp_path)
    info = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    info["records"][0]["notes"], info["records"][1]["notes"] = [], ["cut at 20 s", "turned by 30°"]
    (tmp_path / "run.json").write_text(json.dumps(info), encoding="utf-8")
    rows = Page(write_report(tmp_path).read_text(encoding="utf-8")).tables["records"]
    done = next(i for i, row in enumerate(rows) if row[-1] == "processing")
    assert [row[-1] for row in rows[done + 1 : done + 3]] == ["", "cut at 20 sturned by 30°"]
