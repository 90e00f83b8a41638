"""The report shows what was computed, escapes all text, and needs nothing but itself."""

import json
import math
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from report_page import Page, dot_rows, figures, svg_texts
from report_samples import FIG7, FOUNDATIONS, case_entry, response, three_piers, write_results

from rockbatch.common.errors import InputError
from rockbatch.common.figures.description import COLOURS, SHAPES, marks_of, thin
from rockbatch.pier import Pier, RigidBase, YieldingBase, yield_deflection
from rockbatch.reporting import write_report
from rockbatch.reporting.finished import read
from rockbatch.reporting.markup import escape, tag
from rockbatch.reporting.svg import curve
from rockbatch.reporting.templates import document

NASTY = ["<script>alert(1)</script>", "$x_1$ & a&b", '"><img src=x onerror=alert(1)>', r"\frac{1}{2} </title></svg>"]


def report(directory: Path, *responses, **results) -> str:
    write_results(directory, **results)
    return write_report(directory, responses).read_text(encoding="utf-8")


def histories(**columns):
    pier = Pier(alpha=0.2, p=1.0)
    entries = [("rigid", RigidBase())] + [("soil", YieldingBase(beta=50.0, eta=eta)) for eta in (5.0, 3.0, 2.5, 2.2)]
    cases = [case_entry(n, {} if n == "rigid" else {"eta": base.eta}, pier, base) for n, base in entries]
    responses = [
        response("sine", name, base, **({} if name == "rigid" else {"eta": base.eta})) for name, base in entries
    ]
    return responses, {"records": [("sine", 1.0)], "cases": cases, "varied": ("eta",)}


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """Return responses, and the text of a report with these, a published value and a file that could not be used."""
    responses, results = histories()
    reference = {"record": "*", "case": "1", "columns": {}, "theta_max_over_alpha": 0.1, "source": "s"}
    unusable = [{"name": "x", "source": "x", "reason": "empty"}]
    folder = tmp_path_factory.mktemp("drawn")
    return responses, report(folder, *responses, references=[reference], unusable=unusable, **results)


def test_every_peak_stands_in_the_picture_and_in_the_table_once_the_worst_first(tmp_path):
    text = report(tmp_path, records=FIG7[::-1])
    finished = read(tmp_path)
    runs = finished.runs.sort_values("theta_max_over_alpha", ascending=False, kind="stable")
    head, *body = Page(text).tables["peaks"]
    column = head.index("θmax/α")
    assert [float(row[column]) for row in body] == pytest.approx(list(runs["theta_max_over_alpha"]), abs=0.5e-5)
    assert [row[0] for row in body] == list(runs["record"])
    rows = dot_rows(text)
    assert [row.words for row in rows] == list(runs["record"].drop_duplicates())
    for row in rows:
        said = {
            title.split("\n")[1].split(": ")[0]: float(title.split(": ")[-1].split(" ")[0]) for title in row.marks[0]
        }
        own = runs[runs["record"] == row.words]
        peaks = {finished.series[run.series].label.split(":")[0]: run.theta_max_over_alpha for run in own.itertuples()}
        assert said == pytest.approx(peaks, abs=0.5e-4)


def test_outcomes_other_than_ok_are_words_and_never_rotations(tmp_path):
    changes = {
        ("RRS228", "2"): {"status": "overturned", "theta_max_over_alpha": 7.7},
        ("SYL360", "3"): {"status": "flight", "flight_s": 3.214},
        ("CPM000", "rigid"): {"status": "overturned"},
        ("CPM000", "4"): {"status": "failed", "theta_max_over_alpha": "", "reason": "more than 20,000 events"},
        ("ERZ-NS", "1"): {"flight_s": 1.5},  # guided: went on, and has its peak
    }
    text = report(tmp_path, changes=changes)
    page = Page(text)
    head, *rows = page.tables["peaks"]
    assert re.findall(r"data-filter>([^<]*)", text) == ["case", "status"]
    status = {(row[0], row[1]): row[head.index("status")] for row in rows}
    assert status["RRS228", "2"] == status["CPM000", "rigid"] == "overturned"
    assert (status["SYL360", "3"], status["CPM000", "4"], status["ERZ-NS", "1"]) == ("flight", "failed", "ok")
    in_picture = {row.words: row for row in dot_rows(text)}
    assert (len(in_picture["RRS228"].marks[0]), in_picture["RRS228"].ends) == (4, ["2"])
    assert (len(in_picture["CPM000"].marks[0]), in_picture["CPM000"].ends) == (3, ["rigid?4"])
    assert len(in_picture["ERZ-NS"].marks[0]) == 5
    assert "In one run the pier left the ground altogether; it was guided down" in page.text
    assert "The pier overturns in 2 of 30 runs, among them RRS228, case 2" in page.text
    assert "In one run both pivots leave the ground, and the analysis stops there: SYL360, case 3" in page.text
    assert [cell.replace("\u00a0", " ") for cell in page.tables["unusable"][1]] == [
        "CPM000",
        "4: β = 80, η = 3.5",
        "more than 20,000 events",
    ]
    assert {"m-overturned", "m-flight"} < {link.removeprefix("#") for link in page.links}
    assert "flight: both pivots off the ground" in page.text


def test_the_axis_is_not_stretched_by_a_pier_that_overturned(tmp_path):
    violent = {("RRS228", "2"): {"status": "overturned", "theta_max_over_alpha": 1e3}}
    texts = [report(tmp_path), report(tmp_path, changes=violent)]
    ticks = [re.findall(r">(0\.\d+)</text>", text.split('class="of axis"')[1].split("</svg>")[0]) for text in texts]
    assert ticks[0] == ticks[1] != []


def test_each_value_of_a_pier_key_has_its_own_column_on_one_axis(tmp_path):
    text = report(tmp_path, cases=three_piers(), varied=("p",))
    assert re.findall(r'<span class="column">(.*?)</span>', text.replace("\u00a0", " ")) == [
        "p = 0.38 rad/s", "p = 0.36 rad/s", "p = 0.35 rad/s",
    ]  # fmt: skip
    rows = dot_rows(text)
    assert len(rows) == len(FIG7)
    # foundations are the same on the three piers: five marks each, not fifteen
    assert {len(marks) for row in rows for marks in row.marks} == {5}
    assert {len(row.marks) for row in rows} == {3}


def test_values_of_a_list_become_labels_and_foundations_differ_in_shape_and_colour(tmp_path):
    pier = Pier(alpha=0.13, p=0.38)
    grid = [(beta, eta) for beta in (40.0, 80.0) for eta in (2.5, 3.5)]
    cases = [
        case_entry("soil", {"beta": beta, "eta": eta}, pier, YieldingBase(beta=beta, eta=eta)) for beta, eta in grid
    ]
    text = report(tmp_path, cases=cases, varied=("beta", "eta"))
    entries = re.findall(r'<li data-of="case"[^>]*>.*?<span>(.*?)</span>', text.replace("\u00a0", " "))
    assert [entry.split(" – ")[1] for entry in entries] == [f"β = {beta:g}, η = {eta:g}" for beta, eta in grid]
    looks = [marks_of(index) for index in range(len(SHAPES) * COLOURS)]
    assert len(set(looks)) == len(looks)
    assert len({look.shape for look in looks[:7]}) == len({look.colour for look in looks[:7]}) == 7


def test_beta_of_a_given_stiffness_is_not_taken_for_a_constant_of_the_foundation(tmp_path):
    # springs of ω_v = 20 and 30 rad/s are β = 40 and 60 under one pier, 50 and 75 under the other
    cases = [
        case_entry(name, {"p": p}, Pier(alpha=0.13, p=p), YieldingBase(beta=omega_v / p, eta=eta))
        for p in (0.5, 0.4)
        for name, omega_v, eta in (("1", 20.0, 2.5), ("2", 30.0, 3.5))
    ]
    write_results(tmp_path, cases=cases, varied=("p",))
    assert {series.label.replace("\u00a0", " ") for series in read(tmp_path).series} == {"1: η = 2.5", "2: η = 3.5"}


@pytest.mark.slow
def test_references_are_compared_with_every_run_they_fit(tmp_path):
    changes = {("RSN779_LOMAP_LGP000", "rigid"): {"theta_max_over_alpha": 0.12}}
    reference = {"columns": {}, "theta_max_over_alpha": 0.1, "source": "Palmeri & Makris (2007)"}
    references = [
        reference | {"record": "*LGP*", "case": "rigid"},
        reference | {"record": "*LGP*", "case": "rigid", "columns": {"p": 0.35}},
        reference | {"record": "*TCU*", "case": "rigid"},
        reference | {"record": "CPM*", "case": "4", "columns": {"p": 0.36}},
    ]
    changes["CPM000", "4"] = {"status": "overturned", "theta_max_over_alpha": 2.0}
    text = report(tmp_path, cases=three_piers(), varied=("p",), changes=changes, references=references)
    _, *rows = Page(text).tables["references"]
    run = ["RSN779_LOMAP_LGP000", "rigid"]
    agreement = ["0.1200", "0.1", "+20.0", "Palmeri & Makris (2007)"]
    assert rows == [
        *([*run, p, *agreement] for p in ("0.38", "0.36", "0.35")),
        [*run, "0.35", *agreement],
        ["*TCU*", "rigid", "", "no such run", "0.1", "", "Palmeri & Makris (2007)"],
        ["CPM000", "4", "0.36", "overturned", "0.1", "", "Palmeri & Makris (2007)"],
    ]


def test_names_and_reasons_are_shown_as_they_are_and_never_run(tmp_path):
    text = report(
        tmp_path,
        records=[(name, 0.3 + 0.1 * i) for i, name in enumerate(NASTY)],
        unusable=[{"name": NASTY[2], "source": NASTY[0], "reason": NASTY[1]}],
        command=["rockbatch", "run", NASTY[0]],
    )
    page = Page(text)
    assert page.tags.count("script") == 1
    assert "img" not in page.tags
    assert not page.mismatched
    assert not page.open
    assert {row[0] for row in page.tables["peaks"][1:]} == {row.words for row in dot_rows(text)} == set(NASTY)
    assert page.tables["unusable"][1] == [NASTY[2], NASTY[0], NASTY[1]]
    assert "$x_1$ & a&b" in page.text
    assert "<script>alert(1)</script>" in page.text


def test_the_page_asks_for_nothing_outside_itself(drawn):
    _, text = drawn
    page = Page(text)
    assert not {"link", "img", "iframe", "object", "base"} & set(page.tags)
    assert all(link.startswith("#") or link == "peaks.csv" for link in page.links)  # which lies beside it
    assert "@import" not in text
    assert re.findall(r"url\((?!#)", text) == []


def test_every_printed_page_has_study_version_and_number(tmp_path):
    title = 'A "pier" \\ 1; } </style><b>é'
    written = document(title, "", [], version="1.2")
    style = written[written.index("<style>") : written.index("</style>")]
    assert '@bottom-right { content: counter(page) " / " counter(pages); }' in style
    top = re.search(r'@top-left \{ content: "([^"]*)" \} @top-right \{ content: "rockbatch 1\.2" \} \}', style)
    assert re.sub(r"\\([0-9a-f]+) ", lambda match: chr(int(match[1], 16)), top[1]) == title
    page = report(tmp_path, rockbatch="0.0.7")
    assert '@top-right { content: "rockbatch 0.0.7" }' in page


def test_colours_of_figures_come_from_the_page_so_that_dark_mode_reaches_them(drawn):
    _, text = drawn
    style = text[text.index("<style>") : text.index("</style>")]
    defined = set(re.findall(r"(--\w+):", style)) | {"--w", "--n", "--h", "--share"}
    assert set(re.findall(r"var\((--\w+)[,)]", style)) <= defined
    for svg in re.findall(r"<svg.*?</svg>", text, flags=re.DOTALL):
        assert not re.findall(r"#[0-9a-fA-F]{6}\b|rgb", svg)
        assert "style=" not in svg


def readable(text: str) -> list[ET.Element]:
    """Return the pictures from which values are read: the histories under each motion, each followed by its loops."""
    return [svg for svg in figures(text) if "readings" in svg.attrib["class"]]


def names_of(svg: ET.Element) -> list[str]:
    return [node.get("data-name") for node in svg.iter() if node.get("data-name")]


def test_all_cases_under_a_motion_are_drawn_together_in_the_colours_of_the_page(drawn):
    responses, text = drawn
    together, *loops = readable(text)
    assert {"t [s]", "θ/α", "θ̇/(αp)", "üg/g"} <= set(svg_texts(together))
    cases = ["rigid", "a", "b", "c", "d"]
    assert names_of(together) == [*(f"θ/α {name}" for name in cases), *(f"θ̇/(αp) {name}" for name in cases), "üg/g"]
    looks = [node.get("class") for node in together.iter() if (node.get("data-name") or "").startswith("θ/α")]
    assert looks == ["rigid", *(f"curve s{place + 1}" for place in range(4))]
    dots = text[text.index('class="dots"') :]
    for look, place in zip(looks[1:], range(4), strict=True):
        # The same colour and marker as in the figure of peaks
        marker = re.search(rf'<use href="#m-([a-z]+)"[^>]*class="{look.split()[1]}"', dots)
        assert marker[1] == SHAPES[place]
        (peak,) = [node for node in together.iter() if node.tag == "use" and node.get("class") == look.split()[1]]
        assert peak.get("href") == f"#m-{SHAPES[place]}"
    entries = Page(text).text
    for eta, shown in zip((5, 3, 2.5, 2.2), responses[1:], strict=True):
        assert f"soil: η = {eta:g}: {np.abs(shown.theta).max() / shown.pier.alpha:.4f} at" in entries
    captions = re.findall(
        r"<figcaption><span>([^<]*)</span></figcaption>",
        text[text.index('class="histories"') : text.index('id="studied"')],
    )
    assert captions == [f"{name}, {side}" for name in "abcd" for side in ("left", "right")]
    assert all({"F/Fy", "v/δy"} <= set(svg_texts(svg)) for svg in loops)
    assert len(loops) == 8


def test_the_drawn_curve_gives_the_history_back(drawn):
    responses, text = drawn
    axes = next(node for node in readable(text)[0].iter() if node.get("class") == "axes")
    left, top, width, height = map(float, axes.get("data-box").split())
    (t0, t1), (y0, y1) = (map(float, axes.get(f"data-{name}").split()) for name in "xy")
    path = next(node for node in axes if node.get("data-name") == "θ/α a").get("d")
    start, steps = path.removeprefix("M").split("l")
    moves = np.array([*map(int, re.findall(r"-?\d+", start)), *map(int, re.findall(r"-?\d+", steps))]).reshape(-1, 2)
    x, y = moves.cumsum(axis=0).T / 10
    t, theta = t0 + (x - left) / width * (t1 - t0), y1 - (y - top) / height * (y1 - y0)
    ours = responses[1].theta / responses[1].pier.alpha
    step = (y1 - y0) / height / 10  # a tenth of a pixel, half of it by rounding
    assert (theta.min(), theta.max()) == pytest.approx((ours.min(), ours.max()), abs=0.5 * step * 1.01)
    # At any time it stays between the least and the largest value within a pixel of that time
    pixel = math.ceil(8001 / width)
    near = np.lib.stride_tricks.sliding_window_view(np.pad(ours, pixel, mode="edge"), 2 * pixel + 1)
    read_back = np.interp(responses[1].t, t, theta)
    assert np.all(read_back > near.min(axis=1) - step)
    assert np.all(read_back < near.max(axis=1) + step)


def test_every_curve_of_a_picture_is_drawn_to_its_peaks(tmp_path):
    write_results(tmp_path)
    rigid = response("ERZ-NS", "rigid", RigidBase())
    rigid = replace(rigid, history=rigid.history.assign(theta=2 * rigid.theta))
    text = write_report(tmp_path, [rigid, response("ERZ-NS", "1", FOUNDATIONS[1][1])]).read_text(encoding="utf-8")
    axes = next(node for node in readable(text)[0].iter() if node.get("class") == "axes")
    low, high = map(float, axes.get("data-y").split())
    theta = rigid.theta / rigid.pier.alpha
    assert low < theta.min()
    assert theta.max() < high
    # one piece: nothing of it is cut off
    assert next(node for node in axes if node.get("data-name") == "θ/α rigid").get("d").count("M") == 1


def test_the_largest_rotation_and_the_events_are_marked(tmp_path):
    write_results(tmp_path)
    drawn = response("ERZ-NS", "1", FOUNDATIONS[1][1])
    text = write_report(tmp_path, [drawn]).read_text(encoding="utf-8")
    svg = readable(text)[0]
    assert f"{np.abs(drawn.theta).max() / drawn.pier.alpha:.4f}" in svg_texts(svg)
    strokes = [node.get("d") for node in svg.iter() if (node.get("class") or "").startswith("event")]
    assert [len(stroke.split("M")) - 1 for stroke in strokes] == [1]  # the one separation of the sample


def test_a_picture_is_cut_to_the_time_in_which_a_pier_moves(tmp_path):
    write_results(tmp_path)
    drawn = response("ERZ-NS", "1", FOUNDATIONS[1][1])
    late = drawn.history.assign(t=drawn.t + 60.0)
    rest = late.iloc[[0]].assign(t=0.0, theta=0.0, omega=0.0)
    drawn = replace(drawn, history=pd.concat([rest, late], ignore_index=True))
    text = write_report(tmp_path, [drawn]).read_text(encoding="utf-8")
    assert "60 s to 68 s of 68 s, while the pier moves" in Page(text).text
    axes = [node for node in readable(text)[0].iter() if node.get("class") == "axes"]
    assert {tuple(map(float, node.get("data-x").split())) for node in axes} == {(0.0, 68.0)}
    windows = [node for node in readable(text)[0].iter() if node.get("data-views")]
    for panel in windows:
        cut, whole = ([float(size) for size in view.split()] for view in panel.get("data-views").split("|"))
        assert panel.get("viewBox") == panel.get("data-views").split("|")[0]
        assert cut[2] == 900.0
        assert whole[2] == pytest.approx(900.0 * 68.0 / 8.4, rel=0.05)
    assert len(windows) == 3


def test_a_viscoelastic_spring_that_recovers_in_the_air_does_not_squeeze_its_loop(tmp_path):
    """There the spring's force tends to nothing while the support bears nothing, and the pivot is far above."""
    write_results(tmp_path)
    drawn = response("ERZ-NS", "1", FOUNDATIONS[1][1])
    z, v = drawn.history["z_left"], drawn.history["v_left"]
    drawn = replace(drawn, history=drawn.history.assign(v_left=v.where(z < 0.0, 10.0 * v.max())))
    recovering = replace(drawn, history=drawn.history.assign(z_left=z.where(z < 0.0, -0.01)))
    scales = []
    for each in (drawn, recovering):
        text = write_report(tmp_path, [each]).read_text(encoding="utf-8")
        loop = next(node for node in readable(text)[1].iter() if node.get("class") == "axes")
        scales.append([*map(float, loop.get("data-x").split())])
    assert (z == 0.0).any()
    assert scales[1] == scales[0]
    assert scales[0][1] < 3.0 < 10.0 * v.max() / yield_deflection(drawn.pier, drawn.base)


def test_a_lone_rigid_response_is_drawn_without_loops(tmp_path):
    write_results(tmp_path)
    text = write_report(tmp_path, [response("ERZ-NS", "rigid", RigidBase())]).read_text(encoding="utf-8")
    (drawn,) = readable(text)
    assert "θ/α" in svg_texts(drawn)


def test_loops_of_devices_are_in_kn_within_their_picture(tmp_path):
    """Draw a friction damper of 450 kN at both pivots: the force axis reaches it on either side of 0, with numbers."""
    pier = Pier(alpha=0.2, p=1.0, mass_t=1000.0)
    bare, tied = response("ERZ-NS", "rigid", RigidBase(), pier=pier), response("ERZ-NS", "1", RigidBase(), pier=pier)
    way = 2.0 * pier.half_width * np.abs(tied.theta)
    columns = {"t": tied.t}
    for side in ("left", "right"):
        columns |= {f"damper 1 {side} elongation": way, f"damper 1 {side} force": 0.45 * np.sign(np.gradient(way))}
    tied = replace(tied, restraints=pd.DataFrame(columns))
    write_results(tmp_path)
    text = write_report(tmp_path, [bare, tied]).read_text(encoding="utf-8")
    drawn = readable(text)
    (loops,) = (node for node in drawn[-1].iter() if node.get("data-kind") == "plane")
    low, high = map(float, loops.attrib["data-y"].split())
    assert low < -450.0 < 450.0 < high < 600.0
    words = [node for node in drawn[-1].iter() if node.tag == "text" and node.text]
    numbers = {float(node.text.replace("−", "-")) for node in words if re.fullmatch(r"−?\d+", node.text)}
    assert min(numbers) <= -200.0
    assert max(numbers) >= 200.0
    assert "<span>1, damper 1</span>" in text
    width = float(drawn[-1].attrib["viewBox"].split()[2])
    assert all(0.0 <= float(node.get("x")) <= width for node in words)


def test_of_many_responses_the_worst_of_each_case_is_drawn(tmp_path, monkeypatch):
    monkeypatch.setattr("rockbatch.reporting.sections.histories.MOST_HISTORIES", 20)
    write_results(tmp_path, records=FIG7[:3], polarities=("+", "-"))
    every = [
        replace(response(record, name, base), polarity=sign)
        for record, _ in FIG7[:3]
        for name, base in FOUNDATIONS
        for sign in "+-"
    ]
    text = write_report(tmp_path, every).read_text(encoding="utf-8")
    runs = read(tmp_path).runs
    worst = {runs.loc[same["theta_max_over_alpha"].idxmax(), "record"] for _, same in runs.groupby("case")}
    section = text[text.index('class="histories"') :]
    shown = re.findall(r"<figcaption><strong>([^<,]*)", section[: section.index("</section>")])
    assert set(shown) == worst
    first = runs.loc[runs["theta_max_over_alpha"].idxmax(), "record"]
    assert shown[0] == first
    for name, _ in FOUNDATIONS:
        assert sum(f"θ/α {name}" in names_of(svg) for svg in readable(text)) == len(worst)


def test_the_worst_of_many_cases_are_drawn_and_the_others_counted(tmp_path):
    pier = Pier(alpha=0.2, p=1.0)
    bases = [(f"pad{i}", YieldingBase(beta=50.0, eta=2.0 + 0.1 * i)) for i in range(9)]
    cases = [case_entry("rigid", {}, pier, RigidBase()), *(case_entry(name, {}, pier, base) for name, base in bases)]
    scale = 1.0 / 3.0  # peaks.csv has ten digits of it
    write_results(tmp_path, records=[("sine", 1.0)], cases=cases, scales=(round(scale, 10),))
    drawn = [replace(response("sine", name, base), scale=scale) for name, base in [("rigid", RigidBase()), *bases]]
    text = write_report(tmp_path, drawn).read_text(encoding="utf-8")
    runs = read(tmp_path).runs.query("case != 'rigid'").sort_values("theta_max_over_alpha", ascending=False)
    letters = sorted("abcdefghi"[int(case.removeprefix("pad"))] for case in runs["case"].iloc[:7])
    assert names_of(readable(text)[0])[:8] == ["θ/α rigid", *(f"θ/α {letter}" for letter in letters)]
    assert "The 2 cases with the smallest rotations are left out." in Page(text).text


def test_a_page_holds_the_table_once_whatever_the_number_of_runs(tmp_path):
    write_results(tmp_path)
    finished = read(tmp_path)
    table = finished.saved.peaks["theta_max_over_alpha"].to_numpy()
    ((_, runs),) = finished.groups()
    assert all(np.shares_memory(table, own["theta_max_over_alpha"].to_numpy()) for own in (finished.runs, runs))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("x", "y", "drawn"), [
    ([0, 1, 2, 3, 3, 3.01, 4, 5, np.nan, 7, 8], [0, 1, 2, 3, 3, 3.01, 2, 1, np.nan, 0, 0], "M0 0l30 30 20-20M70 0l10 0"),
    ([0, 5, 2], [0, 0, 0], "M0 0l50 0-30 0"),
    ([0, 1, 2, 3], [0, 1e300, -np.inf, 1], "M0 0h0M30 10h0"),
], ids=["straight and repeated", "turning back", "beyond all pixels"])  # fmt: skip
def test_curves_cost_their_turns_only_and_nothing_where_no_pixel_is(x, y, drawn):
    assert re.search(r' d="([^"]*)"', curve(np.array(x, float), np.array(y, float), "c"))[1] == drawn


def test_thinning_keeps_every_extremum_and_both_ends():
    t = np.linspace(0, 40, 50_001)
    y = np.sin(3 * t) + 0.01 * np.sin(500 * t)
    spikes = np.random.default_rng(7).choice(t.size, 20, replace=False)
    y[spikes] += np.where(np.arange(20) % 2, 5.0, -5.0)
    x, kept = thin(t, y, 200)
    assert x.size <= 4 * 200
    assert (x[0], x[-1]) == (t[0], t[-1])
    assert np.all(np.diff(x) > 0)
    edges = np.linspace(0, t.size, 200 + 1).astype(int)
    for start, end in pairwise(edges):
        inside = (x >= t[start]) & (x <= t[end - 1])
        assert (kept[inside].min(), kept[inside].max()) == (y[start:end].min(), y[start:end].max())
    y[:25_000] = np.nan
    assert np.nanmax(thin(t, y, 200)[1]) == np.nanmax(y)


def test_the_same_results_give_the_same_bytes(tmp_path):
    responses, results = histories()
    first = report(tmp_path, *responses, **results)
    assert write_report(tmp_path, responses).read_text(encoding="utf-8") == first


def test_fifty_records_on_five_foundations_stay_below_half_a_megabyte(tmp_path):
    records = [(f"RSN{i}_EVENT_STATION{i:03d}_WITH_A_LONG_NAME", 0.1 + 0.02 * i) for i in range(50)]
    text = report(tmp_path, records=records)
    assert len(text.encode()) < 5e5
    rows = dot_rows(text)
    assert [row.role for row in rows] == [""] * 13 + ["rest"] + ["folded"] * 37
    assert sorted(row.words for row in rows if row.role != "rest") == sorted(name for name, _ in records)
    # In the common row, marks that would lie under another are left out
    assert set(rows[13].marks[0]) <= {title for row in rows[14:] for title in row.marks[0]}


def test_both_directions_and_scales_are_distinguished(tmp_path):
    text = report(tmp_path, polarities=("+", "-"), scales=(1.0, 2.0))
    page = Page(text)
    rows = {row.words: row for row in dot_rows(text)}
    assert {len(row.marks) for row in rows.values()} == {2}
    assert {title.split(": ")[-2][-3:] for title in rows["ERZ-NS"].marks[0]} == {"(+)", "(-)"}
    assert "in both polarities, scaled by 1, 2: 120 runs." in page.text
    assert re.findall(r"data-filter>([^<]*)", text) == ["case", "polarity", "scale"]
    # PGA is that of the scaled motion
    head, *body = page.tables["peaks"]
    own = [dict(zip(head, row, strict=True)) for row in body if row[0] == "ERZ-NS"]
    assert {row["scale"] for row in own} == {"1", "2"}
    assert re.search(r'data-pga="1.03"><span class="of" title="ERZ-NS">', text)


def test_a_study_without_any_usable_record_still_has_a_report(tmp_path):
    unusable = [{"name": "x", "source": "motions/x.AT2", "reason": "motions/x.AT2: empty file"}]
    page = Page(report(tmp_path, records=[], unusable=unusable))
    assert "No ground motion could be used" in page.text
    assert page.tables["unusable"][1] == ["x", "motions/x.AT2", "motions/x.AT2: empty file"]


def test_sections_come_in_the_order_in_which_they_are_asked_for(drawn):
    page = Page(drawn[1])
    assert page.headings == [
        "Scorecard", "Every run", "Compared with published values", "Histories", "Statistics of the suite",
        "One record and the suite", "What was studied", "What is assumed", "Statics", "Ground motions", "Not used", "Notes",
        "How to reproduce",
    ]  # fmt: skip
    assert "rockbatch run configs/fig7.toml --jobs 2" in page.text
    assert '[[case]]\nname = "rigid"' in page.text


def test_all_that_is_wrong_with_a_folder_is_said_at_once(tmp_path):
    with pytest.raises(InputError) as caught:
        write_report(tmp_path)
    assert [problem.split(":")[0] for problem in caught.value.messages] == [str(tmp_path)]

    write_results(tmp_path, changes={("ERZ-NS", "1"): {"t_max_s": "soon"}})
    document = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    del document["machine"]
    (tmp_path / "run.json").write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        write_report(tmp_path)
    missing, cell = caught.value.messages
    assert "has no machine" in missing
    assert cell == f'{tmp_path / "peaks.csv"}:3: t_max_s = "soon": expected a number or nothing'


def test_files_of_different_runs_are_refused(tmp_path):
    pier = Pier(alpha=0.13, p=0.38)
    write_results(tmp_path, cases=[case_entry("other", {}, pier, FOUNDATIONS[1][1])])
    other = (tmp_path / "run.json").read_text(encoding="utf-8")
    write_results(tmp_path)
    (tmp_path / "run.json").write_text(other, encoding="utf-8")
    with pytest.raises(InputError, match="belong to different runs"):
        write_report(tmp_path)


def test_a_report_that_fails_leaves_the_earlier_one_and_no_litter(tmp_path, monkeypatch):
    earlier = report(tmp_path)

    def no_space(*_):
        raise OSError("no space left on device")

    monkeypatch.setattr("rockbatch.common.files.os.replace", no_space)
    with pytest.raises(OSError, match="no space"):
        write_report(tmp_path)
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == earlier
    assert sorted(path.name for path in tmp_path.iterdir()) == ["peaks.csv", "report.html", "run.json"]


def test_a_record_called_na_keeps_its_name(tmp_path):
    text = report(tmp_path, records=[("NA", 0.3), ("nan", 0.4)])
    assert {row[0] for row in Page(text).tables["peaks"][1:]} == {row.words for row in dot_rows(text)} == {"NA", "nan"}


@pytest.mark.slow
def test_neither_report_nor_comparison_loads_the_compiler_nor_what_it_does_not_need(tmp_path):
    folder = str(write_results(tmp_path))
    code = (
        "import sys; from rockbatch.commands.cli import main;"
        f"main(['report', {folder!r}]); main(['report', {folder!r}, {folder!r}, '--out', {str(tmp_path / 'c.html')!r}]);"
        "print([m for m in ('numba', 'rockbatch.core', 'matplotlib', 'scipy', 'obspy', 'h5py') if m in sys.modules]"
        " + [m for m in sys.modules if m.startswith('rockbatch.analyses.') and m.endswith('section')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"
    assert (tmp_path / "report.html").exists()
    assert (tmp_path / "c.html").exists()


def test_markup_escapes_all_but_markup():
    assert tag("p", "<b>", tag("i", "a & b"), title='"') == '<p title="&quot;">&lt;b&gt;<i>a &amp; b</i></p>'
    assert tag("td", class_="n", hidden=False, open=True) == '<td class="n" open></td>'
    assert escape(1.5) == "1.5"


def test_of_a_big_study_the_worst_is_shown_and_the_page_says_so(tmp_path, monkeypatch):
    monkeypatch.setattr("rockbatch.reporting.sections.peaks.MOST_ROWS", 20)
    worst = {("SYL360", name): {"theta_max_over_alpha": 0.9} for name, _ in FOUNDATIONS}
    text = report(tmp_path, changes=worst)
    page = Page(text)
    assert len(page.tables["peaks"]) == 1 + 20
    assert [row[0] for row in page.tables["peaks"][1:7]].count("SYL360") == 5
    assert "The worst 20 of 30 rows are shown." in page.text
    assert [row.words for row in dot_rows(text)][:1] == ["SYL360"]


def test_every_line_of_a_damaged_table_is_reported_at_once(tmp_path):
    changes = {("ERZ-NS", "1"): {"impacts": "2.5"}, ("SYL360", "2"): {"settlement_m": "x"}}
    write_results(tmp_path, changes=changes)
    path = tmp_path / "peaks.csv"
    with path.open("a", encoding="utf-8") as file:
        file.write("cut,short\n")
    with pytest.raises(InputError) as caught:
        write_report(tmp_path)
    columns = len(path.read_text(encoding="utf-8").split("\n", 1)[0].split(","))
    assert list(caught.value.messages) == [
        f'{path}:3: impacts = "2.5": expected a whole number or nothing',
        f'{path}:24: settlement_m = "x": expected a number or nothing',
        f"{path}:32: 2 cells: expected {columns}, as in the first line",
    ]


def test_errors_are_rounded_up_to_the_digits_of_the_peaks(tmp_path):
    changes = {("SYL360", "2"): {"theta_max_error": 2.1e-5}, ("ERZ-NS", "1"): {"theta_max_error": 3e-9}}
    head, *rows = Page(report(tmp_path, changes=changes)).tables["peaks"]
    errors = {tuple(row[:2]): row[head.index("±")] for row in rows}
    assert (errors["SYL360", "2"], errors["ERZ-NS", "1"]) == ("0.00003", "0.00001")


def test_a_remark_stands_once_below_the_table_under_the_number_that_its_runs_have(tmp_path):
    notes = {("SYL360", "2"): "first", ("ERZ-NS", "1"): "second", ("RRS228", "3"): "first"}
    text = report(tmp_path, changes={run: {"note": note} for run, note in notes.items()})
    listed = re.findall(r"<li>(.*?)</li>", text.split('<ol class="remarks">')[1].split("</ol>")[0])
    assert sorted(listed) == ["first", "second"]
    head, *rows = Page(text).tables["peaks"]
    found = {tuple(row[:2]): row[head.index("remark")] for row in rows}
    assert {run: listed[int(number) - 1] for run, number in found.items() if number} == notes


def test_the_worst_comes_first_overturned_flight_failed_then_rotation(tmp_path):
    changes = {
        ("CPM000", "4"): {"status": "failed", "theta_max_over_alpha": ""},
        ("SYL360", "3"): {"status": "flight", "theta_max_over_alpha": 0.001, "flight_s": 2.0},
        ("RRS228", "1"): {"status": "overturned", "theta_max_over_alpha": 0.002},
        ("ERZ-NS", "2"): {"theta_max_over_alpha": 0.8},
    }
    head, *rows = Page(report(tmp_path, changes=changes)).tables["peaks"]
    order = [tuple(row[:2]) for row in rows]
    assert order[:4] == [("RRS228", "1"), ("SYL360", "3"), ("CPM000", "4"), ("ERZ-NS", "2")]
    rotations = [float(row[head.index("θmax/α")]) for row in rows[3:]]
    assert rotations == sorted(rotations, reverse=True)


@pytest.mark.parametrize("count", [1, 3, 20])
def test_few_spectra_are_drawn_with_names_and_many_as_a_spread(tmp_path, count):
    names = [(f"record {i}", 0.1 + 0.01 * i) for i in range(count)]
    spectra = {"damping": 0.05, "period_s": [0.1, 1.0, 5.0], "sa_g": [[1.0, 0.5 + 0.1 * i, 0.1] for i in range(count)]}
    write_results(tmp_path, records=names, spectra=spectra)
    text = write_report(tmp_path).read_text(encoding="utf-8")
    drawn = text[text.index(f"Response spectra of {count} ground motions") :].split("</ul>")[0]
    assert drawn.count("<path") > count
    assert (">record 0<" in drawn) == (count < 20)
    assert ("84 %" in drawn) == (count == 20)
    assert ("median" in drawn) == (count > 1)


def test_what_is_odd_about_a_record_and_whether_it_is_processed_stand_in_the_table(tmp_path):
    write_results(tmp_path, records=[("rings", 0.2), ("plain", 0.3)])
    info = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    odd = [{"what": what, "text": what, "gross": True, "key": "confirm"} for what in ("alternates", "no PGD")]
    info["records"][0] |= {"processed": False, "findings": odd, "pgd_m": None}
    info["records"][1] |= {"processed": True, "findings": []}
    (tmp_path / "run.json").write_text(json.dumps(info), encoding="utf-8")
    text = write_report(tmp_path).read_text(encoding="utf-8")
    table = text[text.index("to check") :].split("</table>")[0]
    assert ">alternates, no PGD<" in table
    assert table.index(">no<") < table.index(">yes<")
    assert "displacement 0.30 m" in text


def test_files_left_out_are_separate_from_unusable_ones(tmp_path):
    left_out = [{"name": "meta", "source": "a/<meta>.json", "reason": "no record: text about the records"}]
    write_results(tmp_path, left_out=left_out)
    text = write_report(tmp_path).read_text(encoding="utf-8")
    assert "a/&lt;meta&gt;.json" in text
    assert "Left out" in text
    assert "could not be used" not in text
