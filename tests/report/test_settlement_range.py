"""Settlement of springs that ratchet is shown as the range between two spring laws, and checks take the worse."""

from report_page import Page
from studies import PADS, study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main

LIMIT = {"name": "settlement", "demand": "settlement_m", "reason": "bearings"}


def test_settlement_is_a_range_in_the_report_on_the_terminal_and_in_checks(tmp_path, capsys):
    """Set a limit between both laws: the pier fails by the larger settlement, and the verdict says both."""
    cases = (PADS | {"eta": 2.2, "epsilon": 0.1},)
    run = rb.run(write_study(tmp_path, study_text(cases=cases, output={"both_laws": True}))).iloc[0]
    low, high = sorted((run["settlement_m"], run["settlement_other_law_m"]))
    assert high > low + 1e-3
    check = LIMIT | {"at_most": 0.5 * (low + high)}
    path, out = write_study(tmp_path, study_text(cases=cases, check=[check])), tmp_path / "out"
    assert main(["run", str(path), "--out", str(out)]) == 1
    printed = " ".join("".join(capsys.readouterr()).split())
    assert f"{1000 * low:.1f} to {1000 * high:.1f} mm, the larger by the Bouc–Wen law; checks take the worse" in printed
    page = Page((out / "report.html").read_text(encoding="utf-8"))
    cells = [cell for row in page.tables["peaks"] for cell in row]
    assert f"{1000 * low:.2f}\u00a0–\u00a0{1000 * high:.2f}" in cells
    assert (
        f"the worse of two spring laws counts: {high:.4g} by the law of the case, {low:.4g} by the other" in page.text
    )


def test_the_page_says_by_which_law_a_settlement_is_if_the_other_was_not_asked_for(tmp_path):
    path, out = write_study(tmp_path, study_text(cases=(PADS | {"eta": 2.2, "epsilon": 0.1},))), tmp_path / "out"
    assert "settlement_other_law_m" not in rb.run(path, out)
    text = Page((out / "report.html").read_text(encoding="utf-8")).text
    assert "Settlement and residual rotation are by the Bouc–Wen law alone; [output] both_laws = true" in text


def test_springs_that_do_not_creep_have_one_settlement_and_no_warning(tmp_path, capsys):
    path, out = write_study(tmp_path, study_text(cases=(PADS | {"spring": "epp"},))), tmp_path / "out"
    assert main(["run", str(path), "--out", str(out)]) == 0
    assert "both spring laws" not in "".join(capsys.readouterr())
    assert "ratchet" not in Page((out / "report.html").read_text(encoding="utf-8")).text
