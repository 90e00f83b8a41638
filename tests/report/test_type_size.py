"""The smallest text of every picture is legible on a wide screen, on a narrow one and on paper."""

import re
import zlib

import numpy as np
import pytest
from browser import browse, needs_chromium, printed
from report_page import figures
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common.figures.description import Look
from rockbatch.outcome.figures import ON_PAGE, PEAK, QUANTITIES, Drawn, History, together

STUDY = study_text(
    title="Every picture",
    pulses=(
        SINE | {"name": "short", "amplitude_g": 0.5, "period_s": 0.6, "duration_s": 1.0},
        SINE | {"name": "long", "amplitude_g": 0.35, "period_s": 1.0, "duration_s": 1.0},
        SINE | {"name": "strong", "amplitude_g": 0.8, "period_s": 1.0, "duration_s": 1.0},
    ),
    cases=(RIGID, PADS | {"beta": 30, "eta": 3, "epsilon": 0.1}),
    spectrum={
        "alpha": [0.2],
        "two_pi_over_p_s": [2.0, 4.0],
        "points": 2,
        "map": [
            {
                "name": "sine", "shape": "sine", "frequency": [1.0, 2.0], "frequencies": 2, "amplitude": [1.0, 2.0],
                "amplitudes": 2, "tolerance": 0.5, "width": 0.5,
            }
        ],
    },
    output={"forces": True},
    fragility={"measure": "PGA", "levels_g": [0.3, 1.2]},
    sensitivity={"samples": 4, "uniform": {"alpha": [0.18, 0.22]}, "choice": {"spring": ["bouc-wen", "epp"]}},
)  # fmt: skip
PICTURES = {
    "answer", "distribution", "fragility", "spectrum", "sensitivity", "histories", "statics", "records",
    "error_and_time",
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
    """Write a report with every kind of picture."""
    folder = tmp_path_factory.mktemp("pictures")
    study, out = write_study(folder, STUDY), folder / "out"
    for analysis in (rb.spectrum, rb.fragility, rb.sensitivity):
        analysis(study, out=out)
    rb.accuracy(study, out=out, runs=1)
    rb.run(study, out=out)
    return out / "report.html"


@pytest.mark.slow
def test_no_picture_is_made_for_more_room_than_it_has(report):
    """Check without a browser that a picture drawn 440 px wide, with text of 11 px, is not shrunk among many others."""
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


@needs_chromium
@pytest.mark.parametrize("width", [1400, 500, 720], ids=["wide", "narrow", "paper"])
def test_the_smallest_words_of_every_picture_can_be_read(report, width):
    """Check windows and paper: a window of 720 px has 688 px between the margins, as has A4."""
    found = browse(report, MEASURE, size=(width, 900))["smallest"]
    assert set(found) == PICTURES
    assert {name: size for name, size in found.items() if size < 11} == {}


@needs_chromium
def test_no_page_is_printed_smaller_because_a_table_is_too_wide(tmp_path, report):
    """Check the scale of the pages, which Chromium shrinks until the widest element fits: 300 units to an inch, 3.125 a pixel."""
    text = report.read_text(encoding="utf-8")
    for name in ("short", "long", "strong"):
        text = text.replace(f">{name}<", f">{name} motion of a station with a name of its own, 5 km south-west<")
    page = tmp_path / "report.html"
    page.write_text(text, encoding="utf-8")
    scales = set()
    for stream in re.findall(rb"stream\r?\n(.*?)endstream", printed(page), re.DOTALL):
        try:
            drawn = zlib.decompress(stream)
        except zlib.error:
            continue
        if matrix := re.match(rb"\s*\.2399\d* 0 0 -\.2399\d* 0 \d+ cm\s+q\s+([\d.]+) 0 0", drawn):
            scales.add(float(matrix[1]))
    assert scales == {3.125}


def test_a_pier_that_overturns_leaves_the_picture_and_does_not_flatten_how_it_rocked():
    t = np.linspace(0.0, 20.0, 2001)
    theta = np.where(t < 10.0, 0.4 * np.sin(t), 0.4 * np.sin(10.0) - np.expm1(t - 10.0))
    none = np.array([])
    fell = History(
        "overturned", [(t, theta)] * len(QUANTITIES), none, none, none, (20.0, 1e4), (20.0, theta[-1]), (0.0, 20.0)
    )
    figure, _ = together([Drawn(fell, "rigid", "rigid", Look("rigid"), PEAK)], "")
    scales = [panel.y for panel in figure.panels]
    assert len(scales) == len(ON_PAGE)
    assert all(-2.0 < scale.low < -0.4 < 0.4 < scale.high < 2.0 for scale in scales)
    assert "rigid: overturned at 20.0 s" in figure.legend
