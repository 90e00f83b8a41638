"""The smallest words of every picture can be read, on a wide screen, on a narrow one and on paper."""

import re

import pytest
from browser import CHROMIUM, browse
from report_page import figures
from studies import PADS, RIGID, SINE, study_text, write_study

from rockbatch.cli import main
from rockbatch.report import write_report

STUDY = study_text(
    title="Every picture",
    pulses=(
        SINE | {"name": "short", "amplitude_g": 0.5, "period_s": 0.6, "duration_s": 1.0},
        SINE | {"name": "long", "amplitude_g": 0.35, "period_s": 1.0, "duration_s": 1.0},
        SINE | {"name": "strong", "amplitude_g": 0.8, "period_s": 1.0, "duration_s": 1.0},
    ),
    cases=(RIGID, PADS | {"beta": 30, "eta": 3, "epsilon": 0.1}),
    spectrum={
        "alpha": [0.1, 0.2],
        "two_pi_over_p_s": [2.0, 10.0],
        "points": 3,
        "map": [
            {
                "name": "sine", "shape": "sine", "frequency": [1.0, 4.0], "frequencies": 3, "amplitude": [1.0, 6.0],
                "amplitudes": 4, "tolerance": 0.1, "width": 0.5,
            }
        ],
    },
    fragility={"measure": "PGA", "levels_g": [0.3, 0.6, 1.2]},
    sensitivity={"samples": 4, "uniform": {"alpha": [0.18, 0.22]}, "choice": {"kinematics": ["first-order", "finite"]}},
)  # fmt: skip
PICTURES = {
    "answer", "figure", "distribution", "fragility", "spectrum", "sensitivity", "histories", "studied", "records", "accuracy",
}  # fmt: skip
"""Sections of the report that have one."""

MEASURE = """
found.smallest = {};
for (const svg of document.querySelectorAll("main svg.plot")) {
  const section = svg.closest("section").id;
  for (const node of svg.querySelectorAll("text, tspan")) {
    if (![...node.childNodes].some((child) => child.nodeType === 3 && child.data.trim())) continue;
    const size = parseFloat(getComputedStyle(node).fontSize) * svg.getScreenCTM().a;
    found.smallest[section] = Math.min(found.smallest[section] ?? Infinity, size);
  }
}
"""


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """A report with every kind of picture."""
    folder = tmp_path_factory.mktemp("pictures")
    study, out = str(write_study(folder, STUDY)), str(folder / "out")
    for command in ("run", "spectrum", "fragility", "sensitivity"):
        main([command, study, "--out", out])
    assert main(["accuracy", study, "--out", out, "--no-scipy", "--runs", "1"]) == 0
    return write_report(folder / "out")


def test_no_picture_is_made_for_more_room_than_it_has(report):
    """Held without a browser: one that is drawn 440 px wide, in words of 11 px, is not shrunk where there are so many."""
    text = report.read_text(encoding="utf-8")
    widths = [float(svg.attrib["viewBox"].split()[2]) for svg in figures(text) if "viewBox" in svg.attrib]
    assert len(widths) > 10
    assert max(widths) <= 440
    style = text[text.index("<style>") : text.index("</style>")]
    base = float(re.search(r"svg\.plot \{[^}]*font-size: ([\d.]+)px", style)[1])
    labels = float(re.search(r"\.plot \.q \{ font-size: ([\d.]+)px", style)[1])
    lowered = float(re.search(r"\.plot \.sub \{ font-size: (\d+)%", style)[1]) / 100
    assert min(base, lowered * labels) >= 11
    assert not re.search(r"\.plot [^{]*\{[^}]*font-size: ([0-9]|10)(\.\d+)?px", style)


@pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium")
@pytest.mark.parametrize("width", [1400, 500, 720], ids=["wide", "narrow", "paper"])
def test_the_smallest_words_of_every_picture_can_be_read(tmp_path, report, width):
    """On A4 with the margins of the page there are 688 px between them, as in a window of 720."""
    found = browse(tmp_path, report, MEASURE, size=(width, 900))["smallest"]
    assert set(found) == PICTURES
    assert {name: size for name, size in found.items() if size < 11} == {}
