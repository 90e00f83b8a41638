"""Settlement of springs that ratchet is shown as the range between two spring laws, and checks take the worse."""

import math
import re
from types import SimpleNamespace

import pandas as pd
import pytest
from check_samples import PADS as SOFT
from check_samples import RIGID, case, runs
from report_page import Page
from studies import PADS, study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.observers.other_law.quantities import OTHER_LAW
from rockbatch.observers.other_law.section import remark, warning

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
    assert "Settlement and residual rotation are those of the Bouc–Wen law alone; [output] both_laws = true" in text


def test_springs_that_do_not_creep_have_one_settlement_and_no_warning(tmp_path, capsys):
    path, out = write_study(tmp_path, study_text(cases=(PADS | {"spring": "epp"},))), tmp_path / "out"
    assert main(["run", str(path), "--out", str(out)]) == 0
    assert "both spring laws" not in "".join(capsys.readouterr())
    assert "ratchet" not in Page((out / "report.html").read_text(encoding="utf-8")).text


def table_of(by_other, of_case=(0.005, 0.020, 0.030, math.nan)):
    """Return four runs with their settlements [m] by both laws."""
    return runs([0.1] * 4, settlement_m=list(of_case)).assign(**{OTHER_LAW: list(by_other)})


@pytest.mark.parametrize(
    ("by_other", "widest", "said"),
    [
        (
            (0.012, 0.050, 0.029, math.nan),
            ("r1", "20.0", "50.0"),
            ("2 runs", "r1", "20.0 to 50.0", "perfectly plastic law"),
        ),
        ((0.0111, 0.0195, 0.010, math.nan), ("r2", "10.0", "30.0"), ("2 runs", "r2", "10.0 to 30.0", "Bouc–Wen")),
        ((0.0059, 0.0219, 0.0329, math.nan), ("r2", "30.0", "32.9"), None),  # less than a millimetre, or a tenth
        (
            (math.nan, 0.0221, math.nan, 0.05),
            ("r1", "20.0", "22.1"),
            ("1 run", "r1", "20.0 to 22.1", "perfectly plastic law"),
        ),
    ],
)
def test_the_widest_range_is_named_and_a_wide_one_warned_of(by_other, widest, said):
    table = table_of(by_other)
    finished = SimpleNamespace(runs=table, info={"cases": [case("pads", SOFT)]}, place_of=lambda run: run["record"])
    words = Page(remark(finished)).text
    assert re.findall(r"widest in (\w+): ([\d.]+) to ([\d.]+) mm", words) == [widest]
    assert "by the Bouc–Wen law alone" not in words
    warned = warning(table, lambda run: run["case"])
    assert all(part in warned for part in said) if said else not warned


def test_a_range_that_no_run_has_and_springs_that_do_not_creep_are_passed_over():
    none, alone = table_of([math.nan] * 4), runs([0.1] * 4, settlement_m=0.01)
    for table, base, parts in ((none, SOFT, (False, False)), (alone, SOFT, (False, True)), (none, None, None)):
        cases = [RIGID] if base is None else [RIGID, case("pads", base)]
        words = remark(SimpleNamespace(runs=pd.DataFrame(table), info={"cases": cases}, place_of=str))
        said = ("the range between both laws" in words, "those of the Bouc–Wen law alone" in words)
        assert said == parts if parts else words == ""
        assert warning(table, str) == ""
