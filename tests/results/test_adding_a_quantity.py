"""A quantity is added in a copy by one row of the catalogue; everything that shows, judges or explains it follows."""

import json
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from studies import PIER, RIGID, SINE, study_text, write_study

import rockbatch

TOP = Path(rockbatch.__file__).parent

ROW = """    Quantity(
        "toe_lift_m", "greatest rotation times the width", lambda run: 2.0 * run.pier.half_width * run.outcome.theta_max, "m",
        ReportFormat("toe lift", ".1f", 1000, "theta_max_over_alpha"),
        limits=(Limit(), Limit(unit="mm", times=THOUSAND)),
    ),
)  # fmt: skip
"""

SCRIPT = """
import sys
from rockbatch.commands.cli import main
from rockbatch.quantities.catalogue import as_markdown
assert main(["run", sys.argv[1], "--out", "results", "--jobs", "1"]) in (0, 1)
print(as_markdown())
"""


@pytest.mark.slow
@pytest.mark.usefixtures("pages")
def test_a_quantity_is_added_by_a_row_of_the_catalogue(tmp_path):
    shutil.copytree(TOP, tmp_path / "rockbatch", ignore=shutil.ignore_patterns("*.nb[ci]"))
    path = tmp_path / "rockbatch" / "quantities" / "catalogue.py"
    before, start, after = path.read_text(encoding="utf-8").partition("TRAILING = (\n")
    rows, _, rest = after.partition(")  # fmt: skip\n")
    path.write_text(before + start + rows + ROW + rest, encoding="utf-8")
    rule = {"name": "toe", "demand": "toe_lift_mm", "at_most": 1.0, "reason": "the toe"}
    study = write_study(tmp_path, study_text(pier=PIER, pulses=[SINE], cases=[RIGID], check=[rule]))
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(study)], cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(tmp_path)},
        text=True, capture_output=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    folder = tmp_path / "results"
    head, run = ((folder / "peaks.csv").read_text(encoding="utf-8").splitlines())[:2]
    peaks = dict(zip(head.split(","), run.split(","), strict=True))
    width, theta = 1.5 * 9.81 * math.sin(0.2), 0.2 * float(peaks["theta_max_over_alpha"])  # of a rectangle with p = 1
    assert float(peaks["toe_lift_m"]) == pytest.approx(width * theta)
    assert json.loads((folder / "run.json").read_text(encoding="utf-8"))["units"]["toe_lift_m"] == "m"
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert 'title="toe_lift_m × 1000: greatest rotation times the width">toe lift' in page
    assert "toe_lift_mm" in page
    assert "toe_lift_m" in done.stdout  # what docs/columns.md takes in
