"""The section on forces over the height of the shaft: its table, its picture, and what a reader must not overlook."""

import shutil

import numpy as np
import pandas as pd
import pytest
from report_page import Page
from studies import COSINE, PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.observers.sections import section as shaft
from rockbatch.observers.sections.figure import over_height
from rockbatch.quantities.demands import SECTIONS
from rockbatch.reporting.finished import read
from rockbatch.results.labelled import groups_of
from rockbatch.results.reading import EditedTable

PIER = {"width_m": 3.0, "height_m": 14.0, "mass_t": 400.0, "deck_mass_t": 200.0}


def run(folder, pier=PIER):
    pulses = [SINE | {"amplitude_g": 0.5}, COSINE]
    text = study_text(pier=pier, pulses=pulses, cases=[RIGID, PADS], output={"sections": 3, "histories": "none"})
    rb.run(write_study(folder, text), out=folder / "out")
    return folder / "out"


@pytest.fixture(scope="module")
def out(tmp_path_factory):
    return run(tmp_path_factory.mktemp("shaft"))


def test_the_envelopes_of_every_case_are_in_the_table_and_drawn(out):
    finished, sections = read(out, ()), rb.open_results(out).sections
    page = Page(shaft.section(finished))
    rows = sections[(sections["case"] == "pads") & (sections["height_m"] == 7.0)]
    worst = rows.loc[rows["section_moment_kNm"].idxmax()]
    (cells,) = (row for row in page.tables[""] if row[:2] == ["pads", "7.00"])
    assert float(cells[7]) == pytest.approx(rows["sections_error"].max(), rel=0.5)
    assert cells[8:] == [worst["record"]]
    assert "In every row: runs 2 of 2." in page.text
    assert [cell.replace(",", "") for cell in cells[2:7]] == [
        f"{value:.0f}"
        for value in (
            rows["section_shear_kN"].max(), worst["section_moment_kNm"], worst["section_axial_at_moment_kN"],
            rows["section_axial_least_kN"].min(), rows["section_axial_greatest_kN"].max(),
        )
    ]  # fmt: skip
    whole = Page((out / "report.html").read_text(encoding="utf-8"))
    assert "Forces over the height of the shaft" in whole.headings

    merged = finished.runs.merge(sections, on=["record", "case", "polarity", "scale"])
    shear, moment, axial = over_height(groups_of(merged, finished.piers), finished.series).panels
    assert [panel.x.label for panel in (shear, moment, axial)] == ["V [kN]", "moment [kN m]", "N [kN]"]
    pads = [mark for mark in axial.marks if mark.label == "pads"]
    assert [mark.y.tolist() for mark in pads] == 2 * [[0.0, 7.0, 14.0]]
    assert np.all(pads[0].x < pads[1].x)
    assert pads[0].x[1] == rows["section_axial_least_kN"].min()


def test_runs_that_were_cut_short_are_counted_and_raise_an_alarm(out, tmp_path):
    folder = shutil.copytree(out, tmp_path / "out")
    peaks = pd.read_csv(folder / "peaks.csv", dtype=str, keep_default_na=False)
    of_pads = peaks.index[peaks["case"] == "pads"]
    assert len(of_pads) == 2
    for ended, words in ((["flight"], "1 of 2"), (["flight", "failed"], "0 of 2")):
        peaks.loc[of_pads[: len(ended)], "status"] = ended
        peaks.to_csv(folder / "peaks.csv", index=False)
        with pytest.warns(EditedTable):
            section = shaft.section(read(folder, ()))
        counts = {(row[0], row[8]) for row in Page(section).tables[""] if row[0] in ("rigid", "pads")}
        assert counts == {("rigid", "2 of 2"), ("pads", words)}
        assert section.count('"alarm"') == 3 + 1  # sections of the pads, and the legend
    assert '"alarm"' not in shaft.section(read(out, ()))


def test_a_pier_without_a_mass_has_forces_over_it(tmp_path):
    light = {name: value for name, value in PIER.items() if "mass" not in name}
    text = Page(shaft.section(read(run(tmp_path, light), ()))).text
    assert "V/M [m/s²]" in text
    assert "moment/M [m²/s²]" in text


def test_a_table_that_was_damaged_is_an_error_in_words(out, tmp_path):
    table = shutil.copytree(out, tmp_path / "out") / SECTIONS
    table.write_text(table.read_text(encoding="utf-8").replace("section_shear_kN", "shear"), encoding="utf-8")
    with pytest.raises(
        InputError, match=r"sections.csv: column section_shear_kN is missing: .*start `rockbatch run` again"
    ):
        rb.report(tmp_path / "out")
