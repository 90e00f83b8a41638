"""Figures are described once: both renderers draw every kind of mark, and a page and ``plot()`` show the same description."""

import itertools
import math
import re
import warnings
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
from figure_makers import makers
from matplotlib.colors import same_color
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
import rockbatch.reporting
from rockbatch.common.figures import description, paper
from rockbatch.common.figures.description import (
    COLOURS,
    DASHES,
    ENDED,
    Area,
    Axis,
    Figure,
    Look,
    Panel,
    Points,
    Polyline,
    Rule,
    Span,
    Words,
    decades,
    line_of,
    log_spanning,
    sign_of,
    spanning,
    without_repeats,
    written,
)
from rockbatch.reporting import svg

NASTY = "_$x_1$ <b>&"
X, Y = np.array([0.0, 1.0, 2.0]), np.array([0.0, 2.0, 1.0])
MARKS = (
    Span("x", 0.5, 0.7, look=Look("band"), label="span"),
    Area(X, Y, look=Look("area", 2), label="area"),
    Polyline(X, Y, "named", look=line_of(2), label="line"),
    Points(X, Y, np.array([0.0, 0.5, 0.0]), ["a", NASTY, "c"], look=Look("", 1, shape="up"), label="points"),
    Points(X[:1], Y[:1], look=sign_of("failed"), label="failed"),
    Rule("y", np.array([1.0]), look=Look("limit", dash=1), label="limit", title="at 1"),
    Rule("x", np.array([0.5, 1.5]), 0.0, 0.1, look=Look("event"), label="events"),
    Words(1.0, 1.0, NASTY),
)


def figure(*marks, x=Axis("θ_max/α", 0.0, 2.0), y=Axis("F [kN]", 0.0, 2.0), **more):  # noqa: B008
    return Figure([Panel(x, y, marks, **more)], "a figure")


def parsed(drawn):
    return ET.fromstring(f"<div>{drawn}</div>")


def numbers_in(path):
    return [float(number) for number in re.findall(r"-?[\d.]+", path.get("d"))]


def test_every_mark_is_drawn_at_its_values_with_its_tooltip_and_legend():
    """Read them back by the frame, whose ends are those of the axes; words may stand some pixels beside their point."""
    y = Axis("F [kN]", -1.0, 3.0)
    more = Span("y", 1.5, 2.5, look=Look("strip")), Rule("x", X[1:2], 0.25, 0.5, look=Look("bar low"))
    picture, key = parsed(svg.drawn(figure(*MARKS, *more, Words(1.5, 2.0, "left", -1, 10.0), y=y, reads="plane")))
    of_class = {}
    for node in picture.iter():
        of_class.setdefault(node.get("class"), []).append(node)
    assert of_class["event"][0].get("d").count("M") == 2
    assert [node.text for node in picture.iter("title")] == ["a", NASTY, "c", "at 1"]
    assert {"plot", "marks", "readings", "alone"} == set(picture.get("class").split())
    assert [item[1].text for item in key] == ["span", "area", "line", "points", "failed", "limit", "events"]
    left, top, foot, right = numbers_in(of_class["edge"][0])
    (x0, y0), (dx, dy) = (left, foot - (foot - top) / 4), ((right - left) / 2, (foot - top) / 4)

    def at(x, y):
        return pytest.approx((x0 + x * dx, y0 - y * dy), abs=0.06)

    (group,) = of_class["axes"]
    assert (group.get("data-names"), [path.get("data-name") for path in group]) == ("θmax/α|F [kN]", ["named"])
    assert [*map(float, group.get("data-box").split())] == pytest.approx(
        [left, top, right - left, foot - top], abs=0.06
    )
    where = np.column_stack([x0 + X * dx, y0 - Y * dy])
    for kind in ("area s2", "level s3 d2"):
        steps = np.reshape([int(number) for number in re.findall(r"-?\d+", of_class[kind][0].get("d"))], (-1, 2))
        np.testing.assert_allclose(steps.cumsum(axis=0) / 10.0, where, atol=0.06)
    marks = [[float(node.get("x")), float(node.get("y"))] for node in of_class["s1"]]
    np.testing.assert_allclose(marks, where, atol=0.06)
    bar, high, wide, *back, low = numbers_in(of_class["bar"][0])[:6]
    assert ((bar + wide / 2, high), (bar + wide + back[0], low)) == (at(1.0, 2.5), at(1.0, 1.5))
    assert numbers_in(of_class["limit d1"][0]) == [*at(0.0, 1.0).expected, *at(2.0, 1.0).expected[:1]]
    assert numbers_in(of_class["event"][0]) == pytest.approx(
        [x0 + 0.5 * dx, foot, foot - 0.1 * (foot - top), x0 + 1.5 * dx, foot, foot - 0.1 * (foot - top)], abs=0.06
    )
    assert numbers_in(of_class["bar low"][0]) == pytest.approx([x0 + dx, y0, y0 - dy], abs=0.06)
    x, y, width, height = (
        [float(node.get(name)) for node in picture.iter("rect")] for name in ("x", "y", "width", "height")
    )
    assert x + width == pytest.approx([x0 + 0.5 * dx, left, 0.2 * dx, right - left], abs=0.06)
    assert y + height == pytest.approx([top, y0 - 2.5 * dy, foot - top, dy], abs=0.06)
    lines = numbers_in(of_class["grid"][0])
    assert lines[1:15:3] == pytest.approx([y0 - value * dy for value in (-1, 0, 1, 2, 3)], abs=0.06)
    assert lines[15::3] == pytest.approx([x0 + value * dx for value in (0.0, 0.5, 1.0, 1.5, 2.0)], abs=0.06)
    words = {node.text: node for node in picture.iter("text")}
    for value in (0.0, 0.5, 1.0, 1.5, 2.0):
        x, y = (float(words[f"{value:.1f}"].get(name)) for name in "xy")
        assert (x, foot + 9.0 < y < foot + 18.0) == (pytest.approx(x0 + value * dx, abs=0.06), True)
    for value in (-1, 0, 1, 2, 3):
        x, y = (float(words[f"{value}".replace("-", "−")].get(name)) for name in "xy")
        assert left - 8.0 < x < left
        assert y0 - value * dy + 2.0 < y < y0 - value * dy + 6.0
    x, y = (float(words["left"].get(name)) for name in "xy")
    assert (x, float(words["left"].get("dx"))) == (
        pytest.approx(x0 + 1.5 * dx, abs=0.06),
        -float(words[NASTY].get("dx")),
    )
    assert y0 - 2.0 * dy - 12.0 < y < y0 - 2.0 * dy - 4.0
    assert "dx" not in words["?"].attrib
    assert float(words["θ"].get("x")) == pytest.approx(0.5 * (left + right), abs=0.06)
    assert foot + 20.0 < float(words["θ"].get("y")) < float(picture.get("viewBox").split()[3]) - 3.0
    assert 0.0 <= float(words["F [kN]"].get("x")) < left
    assert 9.0 < float(words["F [kN]"].get("y")) < top - 2.0


def test_every_kind_of_mark_is_drawn_on_paper_with_its_legend():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        drawn = paper.drawn(figure(*MARKS, caption=NASTY), 88.0)
        drawn.draw_without_rendering()
    (axes,) = drawn.axes
    assert len(axes.patches) == 2
    assert axes.lines[0].get_xydata().tolist() == np.column_stack([X, Y]).tolist()
    assert [line.get_marker() for line in axes.lines if line.get_marker() not in ("None", None)][-1] == "$?$"
    assert len(axes.containers) == 1
    assert [text.get_text() for text in drawn.legends[0].get_texts()] == [mark.label for mark in MARKS if mark.label]
    assert axes.texts[0].get_text() == axes.get_title() == r" _\$x_1\$ <b>&"
    assert axes.get_xlabel() == r"θ$_\mathrm{max}$/α"
    assert drawn.get_figwidth() == pytest.approx(88.0 / 25.4)
    legend, whole = (each.get_window_extent() for each in (drawn.legends[0], drawn))
    assert legend.width < 1.1 * whole.width
    assert legend.height < axes.get_window_extent().height < 0.8 * whole.height


@pytest.mark.parametrize("width_mm", [40.0, 88.0, 166.0])
@pytest.mark.parametrize("title", ["", "Peaks", f"Peaks of {NASTY}", "Peaks of " + "many records " * 9])
def test_the_title_of_a_figure_is_on_paper_above_its_panels(title, width_mm):
    drawn = paper.drawn(replace(figure(MARKS[0], caption="caption"), title=title), width_mm)
    drawn.draw_without_rendering()
    (axes,) = drawn.axes
    assert drawn.get_suptitle().split() == title.replace("$", r"\$").split()
    if title:
        assert drawn._suptitle.get_window_extent().y0 >= axes.title.get_window_extent().y1
        assert drawn._suptitle.get_window_extent().width <= drawn.bbox.width


@pytest.mark.parametrize("status", ENDED)
def test_a_run_that_ended_is_in_the_colour_of_alarm_and_one_without_a_result_is_not(status):
    shown = figure(Points(X[:1], Y[:1], look=sign_of(status)))
    (axes,) = paper.drawn(shown, 88.0).axes
    (sign,) = axes.lines
    is_alarm = same_color(sign.get_color(), paper.ALARM)
    assert is_alarm == (status != "failed")
    assert any("alarm" in node.get("class", "") for node in parsed(svg.drawn(shown)).iter()) == is_alarm


def test_on_paper_the_second_of_two_rigid_lines_is_paler_and_open_marks_are_hollow():
    marks = [Rule("y", np.ones(1), look=Look("rigid", open=is_open)) for is_open in (False, True)]
    marks += [Points(X, Y, look=Look("", 1, open=is_open)) for is_open in (False, True)]
    (axes,) = paper.drawn(figure(*marks), 88.0).axes
    assert [line.get_alpha() is not None for line in axes.lines] == [False, True, False, False]
    assert [line.get_markerfacecolor() == "none" for line in axes.lines] == [False, False, False, True]


@pytest.mark.parametrize(
    ("x", "y", "pieces"),
    [
        ([], [], 0),
        ([1.0], [1.0], 1),
        ([0.0, 0.5, 1.0, 1.5], [0.0, math.nan, 1.0, 1.0], 2),
        ([0.0, 1.0], [math.nan] * 2, 0),
    ],
    ids=["empty", "one point", "interrupted", "none"],
)
def test_what_has_no_value_is_not_drawn_and_breaks_nothing(x, y, pieces):
    values = np.array(x), np.array(y)
    shown = figure(Polyline(*values, look=Look("level")), Points(*values))
    drawn = parsed(svg.drawn(shown))
    (path,) = (node for node in drawn.iter("path") if node.get("class") == "level ink")
    assert path.get("d").count("M") == pieces
    assert len(list(drawn.iter("use"))) == np.isfinite(values[1]).sum()
    paper.drawn(shown, 88.0).draw_without_rendering()


def test_both_renderers_write_the_same_ticks():
    for axis in (
        Axis("", -0.5, 2.0),
        Axis("", 0.2, 3.0, log=True),
        decades("", [1e-7, 0.3]),
        Axis("", 0, 3, names={1.0: "a"}),
    ):
        shown = figure(x=axis, y=Axis("", 0.0, 1.0, numbered=False))
        (axes,) = paper.drawn(shown, 88.0).axes
        on_paper = [label.get_text() for label in axes.get_xticklabels()]
        on_page = [node.text for node in parsed(svg.drawn(shown)).iter("text")]
        assert on_paper == on_page == list(axis.ticks().values())
        assert len(on_page) in range(1, 10)
    assert written([0.5, 1.0, 1.5]) == ["0.5", "1.0", "1.5"]
    assert (written([]), written([0.0]), written([0.25])) == ([], ["0"], ["0.25"])
    assert written([-20_000.0, 0.0, 5_000.0, 20_000.0]) == ["−20,000", "0", "5000", "20,000"]
    assert written([1e-4, 1e-2, 1.0]) == ["10⁻⁴", "10⁻²", "1"]
    assert written([1e-3, 1e-2, 0.1]) == ["10⁻³", "10⁻²", "10⁻¹"]
    assert written([1.0, 10.0, 100.0, 1e3, 1e4, 1e5]) == ["1", "10", "100", "1000", "10000", "10⁵"]
    assert written([0.1, 0.5, 2.0]) == ["0.1", "0.5", "2.0"]
    assert list(Axis("", 0.0, 2.0, last=1.0, about=4).ticks()) == [0.0, 0.5, 1.0]
    assert list(Axis("", 1.1, 1.3, log=True, about=2).ticks()) == pytest.approx([1.1, 1.2, 1.3])


def test_on_paper_axes_of_numbers_have_a_grid_and_those_of_names_none():
    (axes,) = paper.drawn(figure(x=Axis("", 0, 3, names={1.0: "a"})), 88.0).axes
    assert not any(line.get_visible() for line in axes.xaxis.get_gridlines())
    assert all(line.get_visible() for line in axes.yaxis.get_gridlines())


@pytest.mark.parametrize("about", [1, 3, 5, 6])
@pytest.mark.parametrize("high", [0.3, 1.0, 1.01, 2.4, 7.0, 40.0, 990.0])
@pytest.mark.parametrize("low", [0.0, -0.4, -90.0])
def test_ticks_of_an_axis_are_the_multiples_of_the_least_round_step_wide_enough(low, high, about):
    round_steps = sorted(digits * 10.0**n for n in range(-3, 5) for digits in (1.0, 2.0, 2.5, 5.0))
    step = next(step for step in round_steps if step * about >= (high - low) * (1.0 - 1e-9))
    expected = [n * step for n in range(-10_000, 10_001) if low - 1e-9 <= n * step <= high + 1e-9]
    assert list(Axis("", low, high, about=about).ticks()) == pytest.approx(expected)


@pytest.mark.parametrize("about", [3, 5, 6])
@pytest.mark.parametrize("number", range(2, 15))
def test_ticks_of_a_long_logarithmic_axis_are_as_many_powers_of_ten_as_are_asked_for(number, about):
    ticks = list(Axis("", 1e-6, 10.0 ** (number - 7), log=True, about=about).ticks())
    if number <= 3:  # 1, 2, 5, 10, 20, 50 and 100: seven or fewer
        assert ticks == pytest.approx([digit * 10.0**n for n in range(-6, number - 6) for digit in (1, 2, 5)][:-2])
    else:
        every = next(n for n in range(1, number) if len(range(0, number, n)) <= about)
        assert ticks == pytest.approx([10.0 ** (n - 6) for n in range(0, number, every)])


def test_axes_hold_their_values():
    held = spanning("", np.array([1.0, math.nan, 4.0]))
    assert (held.low, held.high) == (0.0, pytest.approx(4.24))
    for nothing in ([], [0.0], [0.0, math.nan]):
        held = spanning("", np.array(nothing))
        assert (held.low, held.high) == (-1.0, 1.0)
    held = spanning("", np.array([-4.0, 1.0]), np.array([math.inf, 6.0]), margin=0.1)
    assert (held.low, held.high) == (-5.0, 7.0)
    for nothing in ([], [0.0], [-1.0, math.nan, math.inf]):
        held = log_spanning("", np.array(nothing))
        assert 0.05 < held.low < 0.1 < 1.0 < held.high < 2.0
    held = log_spanning("", np.array([0.0, 0.1, math.inf, 10.0]))
    assert 0.05 < held.low < 0.1 < 10.0 < held.high < 20.0
    for values, ends in (
        ([], (1.0, 10.0)),
        ([0.5, 0.02, 30.0], (0.01, 100.0)),
        ([10.0], (10.0, 100.0)),
        ([0.5], (0.1, 1.0)),
    ):
        held = decades("", values)
        assert (held.low, held.high) == pytest.approx(ends)
    assert decades("", [0.5]).fraction(np.array([0.1, 1.0])).tolist() == [0.0, 1.0]


def test_a_curve_without_repeats_keeps_its_ends_and_gaps():
    x, y = np.linspace(0.0, 1.0, 10_001), np.zeros(10_001)
    y[5000] = math.nan
    thinner, values = without_repeats(x, y, 10)
    assert len(thinner) < 210
    assert (thinner[0], thinner[-1]) == pytest.approx((0.0, 1.0), abs=0.01)
    assert np.isnan(values).sum() == 1


def test_panels_flow_into_the_width_and_stacked_rows_stay_together():
    panel = Panel(Axis("x", 0.0, 1.0), Axis("y", 0.0, 1.0), [], "caption", width=300.0)
    flowing = Figure([panel] * 3, "three")
    assert svg.drawn(flowing).count("<figure") == 3
    assert len({axes.get_position().x0 for axes in _laid_out(flowing, 160.0).axes}) == 2
    own = Figure([replace(panel, x=Axis("x", 0.0, high)) for high in (1.0, 2.0, 3.0)], "axes of their own")
    assert len({axes.get_position().x0 for axes in _laid_out(own, 80.0).axes}) == 1
    half = Panel(panel.x, panel.y, [], width=150.0)
    stacked = Figure([panel, half, half], "two rows", stacked=True)
    assert [len(row) for row in stacked.rows] == [1, 2]
    assert svg.drawn(stacked).count("<svg") == 1
    assert _laid_out(stacked, 160.0).axes[0].get_title() == "caption"
    heights = [
        float(parsed(svg.drawn(figure(y=Axis(label, 0.0, 1.0))))[0].get("viewBox").split()[3]) for label in ("", "y")
    ]
    assert 10.0 < heights[1] - heights[0] < 20.0  # room for a label above, where there is one


@pytest.mark.parametrize("beyond", [(3.0, 1.0), (-1.0, 1.0), (1.0, 3.0), (1.0, -1.0)])
def test_a_curve_is_interrupted_where_it_leaves_its_panel_on_any_side(beyond):
    x, y = np.array([[0.5, 1.0], [1.0, 1.0], beyond, [1.5, 1.0], [1.6, 1.2]]).T
    (path,) = (
        node
        for node in parsed(svg.drawn(figure(Polyline(x, y, look=Look("level"))))).iter("path")
        if node.get("class") == "level ink"
    )
    assert path.get("d").count("M") == 2


def test_words_beside_panels_stand_in_no_panel_and_inside_the_picture():
    """Frames of a row are as wide as each other, and ten pixels apart."""
    axes = {"x": Axis("t [s]", 0.0, 1.0), "y": Axis("F [kN]", 0.0, 1.0)}
    panels = [
        Panel(**axes, marks=[], caption=f"part {i}", width=width) for i, width in enumerate((300.0, 150.0, 150.0))
    ]
    (picture,) = (node for node in parsed(svg.drawn(Figure(panels, "two rows", stacked=True))) if node.tag == "svg")
    _, _, width, height = map(float, picture.get("viewBox").split())
    frames = [numbers_in(node) for node in picture.iter("path") if node.get("class") == "edge"]
    assert len(frames) == 3
    (whole, first, second) = ((left, right) for left, _, _, right in frames)
    assert first[1] - first[0] == pytest.approx(second[1] - second[0], abs=0.11)
    assert second[0] - first[1] == pytest.approx(10.0, abs=0.11)
    assert (whole[0], whole[1]) == (first[0], second[1])
    places = [(float(node.get("x")), float(node.get("y"))) for node in picture.iter("text")]
    assert len(places) == 3 * (3 + sum(len(axis.ticks()) for axis in axes.values()))
    for x, y in places:
        assert 0.0 <= x <= width
        assert 8.0 < y < height - 2.0
        assert not any(left < x < right and top < y < foot for left, top, foot, right in frames)
    for left, top, foot, right in frames:
        assert 0.0 < left < right < width
        assert any(x == pytest.approx(right, abs=0.06) and top - 15.0 < y < top - 4.0 for x, y in places)  # its caption
        assert sum(foot + 8.0 < y < foot + 18.0 and left <= x <= right for x, y in places) == len(axes["x"].ticks())


def test_samples_in_a_legend_stand_in_the_middle_of_their_box():
    marks = [
        Points(X, Y),
        Polyline(X, Y, look=Look("level")),
        Area(X, Y),
        Rule("x", X),
        Rule("y", X, look=Look("limit")),
    ]
    boxes = [item[0] for item in parsed(svg.key([svg.Entry("one", [mark]) for mark in marks]))[0]]
    assert [box.get("viewBox") for box in boxes] == ["0 0 22 14"] * 5
    point, level, area, upright, limit = (box[0] for box in boxes)
    assert (point.get("x"), point.get("y")) == ("11", "7")
    assert [level.get(name) for name in ("x1", "x2", "y1", "y2")] == ["0", "22", "7", "7"]
    assert [area.get(name) for name in ("x", "y", "width", "height")] == ["1", "1", "20", "12"]
    assert [upright.get(name) for name in ("x1", "x2", "y1", "y2")] == ["11", "11", "0", "14"]
    assert limit.get("d") == "M11 0v14M7 0h8M7 14h8"


def test_panels_apart_have_their_captions_and_a_single_one_without_has_none():
    panel = Panel(Axis("x", 0.0, 1.0), Axis("y", 0.0, 1.0), [], "caption", note="note", reads="plane")
    alone = parsed(svg.drawn(Figure([panel], "one")))
    assert ["".join(node.itertext()) for node in alone.iter("figcaption")] == ["caption note"]
    assert [node.get("aria-label") for node in alone.iter("svg")] == ["one, caption"]
    assert not list(parsed(svg.drawn(Figure([replace(panel, caption="")], "one"))).iter("figcaption"))
    assert [node.text for node in parsed(svg.sketch(Figure([panel], "one"))).iter("figcaption")] == ["caption"]
    assert not list(parsed(svg.sketch(Figure([replace(panel, caption="")], "one"))).iter("figcaption"))
    grids = [parsed(svg.drawn(Figure([replace(panel, reads=reads)] * 2, "two")))[0] for reads in ("plane", "")]
    assert [grid.get("tabindex") for grid in grids] == [
        None,
        "0",
    ]  # the pictures take keys themselves, or the group does
    entries = parsed(svg.key([svg.Entry("all", [Points(X, Y)]), svg.Entry("one", [], "case", "pads")]))[0]
    assert [dict(item.attrib) for item in entries] == [{}, {"data-of": "case", "data-value": "pads"}]


def test_a_figure_whose_marks_have_no_label_has_no_legend():
    """An empty list would be read out as one."""
    for marks, legends in (((Polyline(X, Y),), 0), ((Polyline(X, Y, label="line"),), 1), ((), 0)):
        for captioned in ({}, {"caption": "caption"}):
            lists = list(parsed(svg.drawn(figure(*marks, **captioned))).iter("ul"))
            assert len(lists) == legends
            assert all(len(entries) for entries in lists)


def test_stretched_panels_have_words_of_one_size_in_either_view():
    x, y = np.linspace(0.0, 10.0, 101), np.sin(np.linspace(0.0, 10.0, 101))
    marks = [Polyline(x, y, "y"), Points(np.full(1, 3.0), np.full(1, 0.5)), Words(8.0, 0.0, "late")]
    panel = Panel(Axis("t [s]", 2.0, 4.0), Axis("y", -1.0, 1.0), marks, width=900.0, reads="time")
    picture = parsed(svg.timed(Figure([panel], "one", stacked=True), Axis("t [s]", 0.0, 10.0)))[0][0]
    assert "viewBox" not in picture.attrib
    views = {name: next(node for node in picture.iter("g") if node.get("class") == name) for name in ("v0", "v1")}
    places = {name: [node.get("x") for node in view.iter("use")] for name, view in views.items()}
    assert places == {"v0": ["50.00%"], "v1": ["30.00%"]}
    written = {name: [node.text for node in view.iter("text")] for name, view in views.items()}
    assert written["v0"] == ["2.0", "2.5", "3.0", "3.5", "4.0"]  # what lies outside is not beside it
    assert written["v1"] == ["late", "0", "2", "4", "6", "8", "10"]
    (inner,) = (node for node in picture if node.tag == "svg")
    assert (inner.get("viewBox"), inner.get("data-views").split("|")[1]) == ("0.0 0 900.0 132", "-900.0 0 4500.0 132")
    alone = parsed(svg.timed(Figure([panel], "one", stacked=True), panel.x))[0][0]
    assert {node.get("class") for node in alone.iter("g")} == {"axes", "v0"}
    assert not any("data-views" in node.attrib for node in alone)


def test_a_curve_is_drawn_by_few_points_to_a_tenth_of_a_pixel_and_to_its_extremes():
    x = np.linspace(0.0, 900.0, 9001)
    y = 100.0 * np.sin(x / 20.0) * np.exp(-x / 300.0)
    path = re.search(' d="M([^"]*)"', svg.curve(x, y, ""))[1]
    points = np.array([*map(int, re.findall(r"-?\d+", path))]).reshape(-1, 2).cumsum(axis=0) / 10.0
    assert len(points) < 800
    away = np.abs(np.interp(x, *points.T) - y) / np.hypot(1.0, np.gradient(y, x))
    assert away.max() < 0.1 + 0.08  # rounding in both directions, too
    assert (points[:, 1].min(), points[:, 1].max()) == pytest.approx((y.min(), y.max()), abs=0.051)


@pytest.mark.parametrize("seed", range(12))
def test_each_piece_of_an_interrupted_curve_is_drawn_as_it_is_alone(seed):
    rng = np.random.default_rng(seed)
    x, y = np.cumsum(rng.random(300)), np.round(np.cumsum(rng.normal(0.0, (0.02, 1.0, 30.0)[seed % 3], 300)), 1)
    y[1:-1][rng.choice(298, (2, 15, 90, 270)[seed % 4], replace=False)] = np.nan
    pieces = [
        piece
        for piece in np.split(np.arange(300), np.flatnonzero(np.diff(np.isnan(y))) + 1)
        if not np.isnan(y[piece[0]])
    ]
    alone = [re.search(' d="([^"]*)"', svg.curve(x[piece], y[piece], ""))[1] for piece in pieces]
    assert all(path.count("M") == 1 for path in alone)
    assert re.search(' d="([^"]*)"', svg.curve(x, y, ""))[1] == "".join(alone)


def test_a_level_curve_of_repeated_points_is_one_line_and_a_single_point_a_dot():
    x = np.repeat(np.arange(9.0), 3)
    assert ' d="M0 20l80 0"' in svg.curve(x, np.full(27, 2.0), "")
    assert ' d="M20 0l0 80"' in svg.curve(np.full(27, 2.0), x, "")
    assert ' d="M0 20h0M20 30h0"' in svg.curve(np.arange(3.0), np.array([2.0, np.nan, 3.0]), "")
    assert ' d=""' in svg.curve(np.arange(3.0), np.full(3, np.nan), "")


def test_many_panels_that_share_their_axes_fit_a_page_and_are_numbered_at_its_edges():
    panel = Panel(
        Axis("x", 0.0, 1.0), Axis("θ_max/α", 0.0, 1.0), [], "Waiau 2016, Te Mara Farm, N28W", width=166.0, height=110.0
    )
    drawn = _laid_out(Figure([panel] * 20, "twenty", "A title"), 88.0)
    assert drawn.get_figheight() < 1.5 * drawn.get_figwidth()
    numbered = [axes for axes in drawn.axes if axes.get_yticklabels()[0].get_text()]
    assert len({axes.get_position().x0 for axes in numbered}) == 1
    assert [axes.get_ylabel() for axes in drawn.axes if axes.get_ylabel().strip()] == [r"θ$_\mathrm{max}$/α"]
    assert drawn.axes[0].yaxis.label.get_rotation() == 0.0
    foot = [axes.get_position().x0 for axes in drawn.axes if axes.get_xticklabels()[0].get_text()]
    assert len(foot) == len(set(foot)) == len({axes.get_position().x0 for axes in drawn.axes})


def test_a_plot_is_drawn_in_axes_of_a_figure_that_exists():
    whole, (first, second) = plt.subplots(1, 2)
    panel = Panel(Axis("x", 0.0, 2.0), Axis("y", 0.0, 2.0), MARKS)
    assert paper.drawn(Figure([panel], "one"), 88.0, first) is whole
    assert first.get_legend() is not None
    assert first.get_xlim() == (0.0, 2.0)
    assert paper.drawn(Figure([panel] * 3, "three"), 88.0, second) is whole
    whole.draw_without_rendering()
    assert len(whole.subfigs[0].axes) == 3
    assert second not in whole.axes
    plt.close(whole)


def test_one_panel_is_drawn_into_given_axes_which_are_returned_and_stay_whole():
    whole, given = plt.subplots(2, 2)
    panel = Panel(Axis("x", 0.0, 2.0), Axis("y", 0.0, 2.0), MARKS, "second")
    figure = Figure([replace(panel, caption="first"), panel], "two")
    assert paper.panel_in(figure, given[0, 0], "second") is given[0, 0]
    assert given[0, 0].get_title() == "second"
    assert list(whole.axes) == list(given.flat)  # neither split nor replaced
    with pytest.raises(rb.InputError, match='there is no panel "third"; there are first, second'):
        paper.panel_in(figure, None, "third")
    plt.close(whole)


@pytest.mark.parametrize("width_mm", [88.0, 180.0])
def test_the_legend_of_one_panel_covers_neither_axes_nor_labels_and_is_on_the_paper(width_mm):
    whole, given = plt.subplots(figsize=(width_mm / 25.4, 0.9 * width_mm / 25.4))
    panel = Panel(Axis("time [s]", 0.0, 2.0), Axis("y", 0.0, 2.0), MARKS)
    paper.panel_in(Figure([panel], "one"), given)
    whole.draw_without_rendering()
    legend = given.get_legend().get_window_extent()
    below = given.xaxis.get_tightbbox()
    assert legend.y1 <= below.y0
    assert legend.y0 >= 0.0
    assert given.yaxis.label.get_window_extent().y1 <= whole.bbox.y1
    sizes = [
        text.get_fontsize() for text in (given.xaxis.label, *given.get_xticklabels(), *given.get_legend().get_texts())
    ]
    assert min(sizes) >= 7.0
    plt.close(whole)


def test_two_panels_in_a_column_have_their_numbers_apart_and_their_legends_below():
    """Numbers and legends of axes 44 mm wide, which were written over their neighbours."""
    whole, given = plt.subplots(1, 2, figsize=(88.0 / 25.4, 70.0 / 25.4))
    label = "stiff, strong: β = 80, η = 3.5 (p = 0.38 rad/s)"
    for place, axes in enumerate(given):
        line = Polyline(np.array([0.0, 160.0]), np.array([0.0, 1.0]), look=Look("curve", place + 1), label=label)
        paper.panel_in(Figure([Panel(Axis("time [s]", 0.0, 160.0), Axis("y", 0.0, 1.0), [line])], "one"), axes)
    whole.draw_without_rendering()
    for axes in given:
        boxes = [text.get_window_extent() for text in axes.get_xticklabels() if text.get_text()]
        assert len(boxes) >= 3
        assert all(left.x1 < right.x0 for left, right in itertools.pairwise(boxes))
        assert axes.get_legend().get_window_extent().y1 <= axes.xaxis.get_tightbbox().y0
    left, right = (axes.get_legend().get_window_extent() for axes in given)
    assert left.x1 < given[1].get_window_extent().x0
    assert right.x1 <= whole.bbox.x1
    assert "".join(text.get_text() for text in given[0].get_legend().get_texts()).replace("\n", " ") == label
    plt.close(whole)


@pytest.mark.parametrize("ax", [3, "axes", [1, 2], plt.Figure()])
def test_wrong_axes_are_answered_like_any_wrong_argument(ax):
    figure = Figure([Panel(Axis("x", 0.0, 1.0), Axis("y", 0.0, 1.0), [])], "one")
    for draw in (lambda: paper.drawn(figure, 88.0, ax), lambda: paper.panel_in(figure, ax)):
        with pytest.raises(
            rb.InputError, match=r"^ax = .*: must be an Axes, as matplotlib's subplots\(\) makes, or None$"
        ):
            draw()


def test_each_function_of_a_single_panel_draws_the_run_or_the_runs(tmp_path):
    pulses = [SINE | {"name": f"sine {n}"} for n in range(3)]
    study = write_study(tmp_path, study_text(pulses=pulses, cases=[RIGID, PADS]))
    rb.run(study, tmp_path / "out")
    results = rb.open_results(tmp_path / "out")
    response = results.responses[1]
    whole, given = plt.subplots(1, 3)
    assert response.plot_rotation(given[0]) is given[0]
    theta = max((line.get_ydata() for line in given[0].lines), key=len)
    assert np.max(np.abs(theta)) == pytest.approx(response.theta_max / response.pier.alpha, rel=1e-3)
    assert response.plot_loops(given[1], of="right") is given[1]
    assert given[1].get_title() == "right"
    assert results.plot_peaks(given[2]) is given[2]
    drawn = np.concatenate([line.get_ydata() for line in given[2].lines if line.get_linestyle() == "None"])
    assert sorted(drawn) == pytest.approx(sorted(results.peaks["theta_max_over_alpha"]))
    with pytest.raises(rb.InputError, match='there is no panel "damper 1"; there are left, right'):
        response.plot_loops(of="damper 1")
    with pytest.raises(rb.InputError, match="there are no loops"):
        next(one for one in results.responses if one.case == "rigid").plot_loops()
    plt.close(whole)


def test_several_panels_do_not_go_into_axes_without_a_grid():
    whole = plt.figure()
    axes = whole.add_axes((0.1, 0.1, 0.8, 0.8))
    with pytest.raises(rb.InputError, match="several panels; make it by matplotlib's subplots"):
        paper.drawn(Figure([Panel(Axis("", 0.0, 1.0), Axis("", 0.0, 1.0), [])] * 2, "two"), 88.0, axes)
    plt.close(whole)


def test_several_panels_go_into_a_subfigure_and_not_into_a_grid_inside_a_cell():
    """They were drawn over the cells beside, and the height of the whole figure was taken for theirs."""
    whole = plt.figure(figsize=(180.0 / 25.4, 160.0 / 25.4), layout="constrained")
    axes = whole.add_subplot(whole.add_gridspec(2, 1)[1].subgridspec(2, 2)[0, 0])
    with pytest.raises(rb.InputError, match=r"inside a cell of another.* make it by subplots\(\), or in a subfigure"):
        paper.drawn(_panels(2, 110.0), 88.0, axes)
    axes.remove()
    inner = whole.subfigures(2, 1)[1]
    paper.drawn(_panels(2, 110.0), 180.0, inner.subplots())
    whole.draw_without_rendering()
    panels = [one.get_window_extent() for one in inner.subfigs[0].axes]
    assert len(panels) == 2
    assert all(panel.y1 < whole.bbox.height / 2 for panel in panels)
    plt.close(whole)


@pytest.mark.parametrize(("rows", "ending"), [(1, "wider or higher"), (2, "wider or higher, or give it fewer rows")])
def test_fewer_rows_are_advised_only_for_a_grid_of_several(rows, ending):
    whole, axes = plt.subplots(rows, squeeze=False, figsize=(88.0 / 25.4, rows * 55.0 / 25.4), layout="constrained")
    with pytest.raises(rb.InputError, match=f"make the figure {ending}$"):
        paper.drawn(_panels(4), 88.0, axes[0, 0])
    plt.close(whole)


def test_a_figure_of_one_panel_is_drawn_in_given_axes_as_that_panel_alone_is():
    """Its legend covered curves, and its numbers had the size of a screen."""
    line = Polyline(np.array([0.0, 1.0]), np.array([0.0, 1.0]), look=line_of(0), label="rises")
    figure = Figure([Panel(Axis("x", 0.0, 1.0), Axis("y", 0.0, 1.0), [line], "one")], "one")
    whole, axes = plt.subplots(figsize=(88.0 / 25.4, 60.0 / 25.4))
    assert paper.drawn(figure, 88.0, axes) is whole
    whole.draw_without_rendering()
    assert axes.get_legend().get_window_extent().y1 < axes.get_window_extent().y0
    assert axes.xaxis.get_ticklabels()[0].get_fontsize() == paper._STYLE["xtick.labelsize"]
    plt.close(whole)


def _panels(count, width=440.0):
    lines = [Polyline(np.array([0.0, 1.0]), np.array([0.0, float(n)]), label=f"curve {n}") for n in range(count)]
    return Figure(
        [Panel(Axis("x", 0.0, 1.0), Axis("y", 0.0, n + 1.0), [line], width=width) for n, line in enumerate(lines)], ""
    )


def test_panels_too_many_for_given_axes_are_refused_with_the_height_they_need():
    whole, axes = plt.subplots(figsize=(88.0 / 25.4, 55.0 / 25.4), layout="constrained")
    with pytest.raises(
        rb.InputError, match=r"^ax: 4 panels and their legend need (\d+) mm of height here, and it has 55 mm"
    ) as told:
        paper.drawn(_panels(4), 88.0, axes)
    assert axes.figure is whole  # and is still there
    plt.close(whole)
    needed = float(re.search(r"need (\d+) mm", str(told.value))[1])
    whole, axes = plt.subplots(figsize=(88.0 / 25.4, needed / 25.4), layout="constrained")
    paper.drawn(_panels(4), 88.0, axes)
    whole.draw_without_rendering()
    panels = [one.get_window_extent() for one in whole.subfigs[0].axes]
    assert min(panel.height for panel in panels) > 0.8 * paper.LOWEST / 25.4 * whole.dpi
    assert all(upper.y0 > lower.y1 for upper, lower in itertools.pairwise(panels))
    plt.close(whole)


@pytest.mark.parametrize(("height", "rows"), [(112.0, 2), (300.0, 4)])
def test_panels_stand_abreast_in_given_axes_that_are_too_low_for_all_of_them(height, rows):
    whole, axes = plt.subplots(figsize=(160.0 / 25.4, height / 25.4), layout="constrained")
    paper.drawn(_panels(4), 160.0, axes)
    whole.draw_without_rendering()
    assert len({round(one.get_window_extent().y0) for one in whole.subfigs[0].axes}) == rows
    plt.close(whole)


def _laid_out(shown, width_mm):
    drawn = paper.drawn(shown, width_mm)
    drawn.draw_without_rendering()
    return drawn


def test_colours_and_dashes_of_paper_are_those_of_the_page():
    style = (Path(rockbatch.reporting.__file__).parent / "style.css").read_text(encoding="utf-8").split("@media")[0]
    colours = dict(re.findall(r"--(\w+): (#\w{6})", style))
    assert list(paper.PALETTE) == [colours["ink"], *(colours[f"s{i}"] for i in range(1, COLOURS + 1))]
    assert tuple(colours[name] for name in ("alarm", "muted", "band")) == (paper.ALARM, paper.MUTED, paper.PALE)
    assert len(paper._DASHES) == DASHES
    assert set(description.SHAPES) | set(description.ENDED) <= set(paper._MARKERS)
    assert set(paper._MARKERS) == set(svg._OUTLINES) | {"failed"}
    assert len({line_of(place) for place in range(COLOURS * DASHES)}) == COLOURS * DASHES


@pytest.mark.usefixtures("pages")
def test_the_page_and_every_plot_show_figures_of_the_same_functions(tmp_path):
    pulses = [SINE | {"name": f"sine {n}"} for n in range(3)]
    study = write_study(tmp_path, study_text(pulses=pulses, cases=[RIGID, PADS]))
    of_page = makers(lambda: rb.run(study, tmp_path / "out"))
    results = rb.open_results(tmp_path / "out")
    response = results.responses[1]
    sheet = rb.statics(response.pier, response.base)
    plots = {"peaks": results.plot, "distributions": results.plot_cdf, "history": response.plot, "statics": sheet.plot}
    for name, plot in plots.items():
        of_plot = makers(plot) - {"rockbatch.results.figures.peaks_of_all"}  # which gives the panels of `peaks` a title
        assert [maker.rpartition(".")[2] for maker in of_plot] == [name]
        assert name == "peaks" or of_plot <= of_page  # on the page, peaks are rows of dots


def test_numbers_of_two_axes_that_begin_with_one_do_not_meet_at_the_corner():
    panel = Panel(Axis("x", 0.05, 5.0, log=True), Axis("y", 0.02, 2.0, log=True), [])
    (picture,) = (node for node in parsed(svg.drawn(Figure([panel], ""))) if node.tag == "svg")
    places = {node.text: (node.get("class"), float(node.get("y"))) for node in picture.iter("text")}
    (side, baseline), (below, foot) = places["0.02"], places["0.05"] if places["0.05"][0] == "m" else places["0.10"]
    assert (side, below) == ("e", "m")
    assert foot - 0.75 * 11.5 > baseline + 2.0  # digits of 11.5 px
