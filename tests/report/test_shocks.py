"""The section on sequences: what each shock does, and what a reader must not overlook."""

import shutil

import pytest
from report_page import Page
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.observers.shocks import TABLE
from rockbatch.observers.shocks import section as shocks
from rockbatch.reporting.finished import read

STRONG = SINE | {"name": "strong", "amplitude_g": 2.0, "period_s": 2.0}  # overturns the pier


def run(folder, records, pause, cases=(RIGID, PADS)):
    sequence = {"name": "both", "records": records, "pause_s": pause}
    text = study_text(motions={"sequence": [sequence]}, pulses=[SINE, STRONG], cases=cases)
    rb.run(write_study(folder, text), out=folder / "out")
    return folder / "out"


def page_of(out):
    return Page(shocks.section(read(out, ())))


@pytest.fixture(scope="module")
def out(tmp_path_factory):
    return run(tmp_path_factory.mktemp("shocks"), ["one-sine", "one-sine"], 0.5)


def test_every_shock_has_a_row_and_pauses_that_are_too_short_are_marked(out):
    page = page_of(out)
    assert "In 4 of 4 pauses the pier is still moving at the end" in page.text
    assert "write a longer pause_s" in page.text
    assert page.text.count("one-sine") == 1  # in the line on what is the same in every row
    whole = Page((out / "report.html").read_text(encoding="utf-8"))
    assert "Shock by shock" in whole.headings
    assert whole.headings.index("Every run") < whole.headings.index("Shock by shock")


def test_a_pier_at_rest_and_one_that_falls_are_said(tmp_path):
    text = page_of(run(tmp_path, ["one-sine", "strong", "one-sine"], 60.0, [RIGID])).text
    assert "Shock 2 overturns the pier in one run." in text
    assert "In 1 of 1 runs the greatest rotation comes in a later shock than the first" in text
    assert "than the first; 1 of 1 stopped early." in text
    assert "In every pause that was reached the pier has come to rest, within 0.001 α." in text
    assert "not reached" in text


def test_a_table_that_was_damaged_is_an_error_in_words(out, tmp_path):
    table = shutil.copytree(out, tmp_path / "out") / TABLE
    table.write_text(table.read_text(encoding="utf-8").replace("shock_status", "state"), encoding="utf-8")
    with pytest.raises(InputError, match=r"shocks.csv: column shock_status is missing: .*start `rockbatch run` again"):
        rb.report(tmp_path / "out")
