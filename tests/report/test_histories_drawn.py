"""Histories and loops are drawn as they were computed."""

import math
import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from report_page import Page, figures, svg_texts
from report_samples import FIG7, FOUNDATIONS, case_entry, response, write_results

from rockbatch.common.figures.description import SHAPES, thin
from rockbatch.pier import Damper, Pier, RigidBase, YieldingBase, yield_deflection
from rockbatch.reporting import write_report
from rockbatch.reporting.finished import read
from rockbatch.reporting.sections import histories
from rockbatch.reporting.svg import curve


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


@pytest.mark.parametrize(
    ("scale", "polarity", "words"),
    [
        (1.0, "+", "Kobe"),
        (2.5, "+", "Kobe, scaled by 2.5"),
        (1.0, "-", "Kobe, reversed"),
        (2.0, "-", "Kobe, scaled by 2, reversed"),
    ],
)
def test_a_picture_says_how_its_motion_was_scaled_and_whether_it_was_reversed(scale, polarity, words):
    named = SimpleNamespace(named={"TAK000": "Kobe"}.get)
    assert histories._of_motion(named, {"record": "TAK000", "scale": scale, "polarity": polarity}) == words


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
    base = RigidBase(restraints=(Damper("friction", f=0.045),))
    tied = replace(tied, base=base, restraints=pd.DataFrame(columns))
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
