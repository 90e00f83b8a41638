"""One door for the files of a results folder, and one for the terminal: nobody goes round them."""

import re
from pathlib import Path

import pytest

from rockbatch.common.errors import InputError
from rockbatch.study import load_study
from rockbatch.workflow.analysis import AnalysisFolder

TOP = Path(__file__).parents[1] / "rockbatch"
OF_FOLDERS = ("analyses", "batch", "checks", "reporting", "results")
ROUND = re.compile(
    r"(?<!temporary)(?<!h5[ao])\.open\(|(?<![.\w])open\(|(?<!joinpath\(name\))\.read_text\(|\.read_bytes\(|\.write_text\(|\.touch\("
)


def lines_of(*packages):
    """Lines of code, with their places."""
    for package in packages:
        assert (TOP / package).is_dir()
        for path in sorted((TOP / package).rglob("*.py")):
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                yield f"{path.relative_to(TOP)}:{number}", line


def test_files_of_a_results_folder_are_opened_by_one_door():
    """`rockbatch.common.files`, or h5py given what that has opened; the program reads its own sources and style otherwise."""
    found = [place for place, line in lines_of(*OF_FOLDERS) if ROUND.search(line)]
    assert [place for place in found if not place.startswith(("batch/digests.py", "reporting/templates.py"))] == []


def test_commands_print_by_one_door():
    found = [
        place
        for place, line in lines_of("commands", "analyses", "terminal")
        if re.search(r"\bprint\(|sys\.std\w+\.write", line)
    ]
    assert {place.partition(":")[0] for place in found} <= {"terminal/streams.py"}


def test_an_edited_table_of_an_analysis_is_reported_and_kept(tmp_path):
    study = load_study(TOP.parent / "configs" / "fig5.toml")
    before = AnalysisFolder(tmp_path, "fragility", study)
    (tmp_path / "runs.csv").write_text("a\n1\n")
    before.keep("runs.csv", {"cases": "5f1c"})
    assert AnalysisFolder(tmp_path, "fragility", study).has("runs.csv", {"cases": "5f1c"})
    assert not AnalysisFolder(tmp_path, "fragility", study).has("runs.csv", {"cases": "other"})
    (tmp_path / "runs.csv").write_text("a\n2\n")
    assert not AnalysisFolder(tmp_path, "fragility", study, fresh=True).has("runs.csv", {"cases": "5f1c"})
    with pytest.raises(InputError, match=r"runs\.csv: edited or damaged; nothing was run: move it away"):
        AnalysisFolder(tmp_path, "fragility", study).has("runs.csv", {"cases": "5f1c"})
