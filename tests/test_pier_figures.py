"""The figures of a pier: to scale with its devices, and its statics."""

import dataclasses
import math

import numpy as np
import pytest

import rockbatch as rb
from rockbatch.common.figures.description import Area, Points, Polyline, Rule, Words
from rockbatch.pier import Place
from rockbatch.pier.figures import (
    APART,
    ASIDE,
    MOST_PIERS,
    SPRING,
    STRIPS,
    PlacedDevice,
    Sheet,
    sketches,
    springs_below,
    statics,
)

PIER = {"alpha": math.atan(0.2), "half_width_m": 4.0, "height_m": 20.0, "springs": 0}


def marks(figure, kind, type_=Polyline):
    (panel,) = figure.panels
    return [mark for mark in panel.marks if isinstance(mark, type_) and mark.look.kind == kind]


def outline(figure):
    """Return width and height of the shaft [px]."""
    (shaft,) = marks(figure, "band", Area)
    return np.ptp(shaft.x), np.ptp(shaft.y)


def test_piers_are_to_one_scale():
    figures = sketches([PIER | {"highest_m": 30.0}, PIER | {"half_width_m": 1.0, "height_m": 10.0}])
    (wide, tall), (narrow, low) = map(outline, figures)
    assert wide / tall == pytest.approx(8.0 / 30.0)
    assert narrow / low == pytest.approx(2.0 / 20.0)
    assert tall / low == pytest.approx(30.0 / 20.0)


def test_the_deck_and_the_devices_are_to_scale():
    devices = (
        PlacedDevice("tendon", "tendon", Place(-2.0)),
        PlacedDevice("damper", "viscous damper", Place(4.0)),
        PlacedDevice("stop", "stop", Place(-4.0)),
    )
    (figure,) = sketches([PIER | {"highest_m": 33.0, "deck_m": 33.0, "devices": devices}])
    scale = outline(figure)[1] / 33.0
    (deck,) = marks(figure, "deck", Area)
    assert deck.y.mean() == pytest.approx(33.0 * scale)
    tendon = next(mark for mark in marks(figure, "tendon") if mark.title == "tendon")
    assert tendon.x.tolist() == pytest.approx([-2.0 * scale] * 2)
    assert tendon.y.max() == pytest.approx(33.0 * scale)
    (damper,) = marks(figure, "damper", Area)
    assert damper.x.mean() == pytest.approx(4.0 * scale + ASIDE)
    assert "with tendon and viscous damper and stop" in figure.description
    assert {"h = 20 m", "2b = 8 m", "deck, 33 m"} <= {mark.text for mark in marks(figure, "", Words)}


def at(mark):
    """Return the corners of a mark [px]."""
    return [(round(float(x), 9), round(float(y), 9)) for x, y in zip(mark.x, mark.y, strict=True)]


@pytest.mark.parametrize("base", ["rigid", "elastic"])
def test_lines_of_a_sketch_end_where_what_they_show_does(base):
    devices = [
        PlacedDevice("tendon", "tendon", Place(2.0)),
        PlacedDevice("stop", "stop", Place(-4.0)),
        PlacedDevice("damper", "viscous damper", Place(4.0)),
        PlacedDevice("deck_spring", "deck spring", Place(0.0, 38.0, -1.0)),
    ]
    (figure,) = sketches([PIER | {"deck_m": 41.0, "devices": devices, "springs": springs_below({base})}])
    (panel,) = figure.panels
    (shaft,) = marks(figure, "band", Area)
    b, top = (round(float(each.max()), 9) for each in (shaft.x, shaft.y))
    (centre,) = marks(figure, "peak", Points)
    ((_, h),) = at(centre)
    assert at(centre) == [(0.0, pytest.approx(20.0 / 41.0 * top))]  # the shaft is drawn up to the deck
    assert sorted(at(shaft)) == [(-b, 0.0), (-b, top), (b, 0.0), (b, top)]
    rigid = [at(mark) for mark in marks(figure, "rigid")]
    assert [(-b, 0.0), (-b, top), (b, top), (b, 0.0), (-b, 0.0)] in rigid
    assert [(b, 0.0), (0.0, h)] in rigid
    below = -SPRING if base == "elastic" else 0.0
    for x in (-b, b):
        (ground,) = (
            line for line in rigid if len(line) == 2 and {y for _, y in line} == {below} and line[0][0] < x < line[1][0]
        )
        assert ground[0][0] + ground[1][0] == pytest.approx(2 * x)
        hatches = [
            at(m) for m in marks(figure, "edge") if m.y[0] == below and m.y[1] < below and abs(m.x[0] - x) < 15.0
        ]
        assert len(hatches) == 4
        assert len({round(end[0] - start[0], 6) for start, end in hatches}) == 1
        coils = [line for line in rigid if len(line) == 7 and line[0] == (x, 0.0)]
        assert len(coils) == (base == "elastic")
        for coil in coils:
            assert [y for _, y in coil] == pytest.approx(np.linspace(0.0, below, 7))
            assert [round(along - x) for along, _ in coil] == [0, 4, -4, 4, -4, 4, 0]
    edges = [at(mark) for mark in marks(figure, "edge")]
    (height,) = (line for line in edges if [y for _, y in line] == [0.0, h] and line[0][0] == line[1][0])
    (width,) = (line for line in edges if [x for x, _ in line] == [-b, b] and line[0][1] == line[1][1] < -SPRING)
    assert height[0][0] > b
    words = {mark.text: [mark.x, mark.y, mark.side] for mark in panel.marks if isinstance(mark, Words)}
    assert words["h = 20 m"] == pytest.approx([*np.mean(height, axis=0), 1])
    assert words["2b = 8 m"] == pytest.approx([*np.mean(width, axis=0) - (0.0, 10.0), 0])
    for end in (*height, *width):
        assert (
            sum(np.mean(line, axis=0) == pytest.approx(end) and np.ptp(line) > 0 for line in edges if len(line) == 2)
            == 1
        )
    assert at(marks(figure, "tendon")[1]) == [(b, 0.0), (b + ASIDE, 0.0), (b + ASIDE, -SPRING)]
    assert [(-b - ASIDE, -SPRING), (-b - ASIDE, ASIDE), (-b, ASIDE)] in rigid
    tied = at(marks(figure, "tendon")[2])
    assert [y for _, y in tied] == pytest.approx([h * 38.0 / 20.0] * 2)
    assert tied[0][0] - tied[1][0] == pytest.approx(SPRING)
    (wall,) = (line for line in rigid if len(line) == 2 and line[0][0] == line[1][0] == tied[1][0])
    assert sum(y for _, y in wall) / 2 == pytest.approx(tied[0][1])
    for mark in (m for m in panel.marks if not isinstance(m, Words)):
        assert panel.x.low <= mark.x.min() <= mark.x.max() <= panel.x.high
        assert panel.y.low <= mark.y.min() <= mark.y.max() <= panel.y.high


def test_the_slenderness_is_an_arc_about_the_toe_from_the_edge_to_the_radius():
    (figure,) = sketches([PIER])
    (shaft,) = marks(figure, "band", Area)
    (arc,) = (mark for mark in marks(figure, "edge") if len(mark.x) > 2)
    toe = shaft.x.max()
    assert np.ptp(np.hypot(arc.x - toe, arc.y)) < 1e-9
    turned = np.arctan2(toe - arc.x, arc.y)
    assert (turned.min(), turned.max()) == pytest.approx((0.0, PIER["alpha"]))


@pytest.mark.parametrize(
    ("heights", "written"),
    [
        ((), ["drift 36 m"]),
        ((0.0, 9.0), ["section 0 m", "section 9 m", "drift 36 m"]),
        ((0.0, 36.0), ["section 0 m", "drift and section 36 m"]),
        (tuple(range(0, 37, 6)), ["section 0 m", "drift and section 36 m"]),
    ],
)
def test_heights_that_are_read_are_marked_at_the_left_and_a_few_of_them_written(heights, written):
    (figure,) = sketches([PIER | {"highest_m": 40.0, "top_m": 36.0, "sections_m": heights}])
    (shaft,) = marks(figure, "band", Area)
    b, scale = shaft.x.max(), shaft.y.max() / 40.0
    across = [mark for mark in marks(figure, "edge") if np.ptp(mark.y) == 0 and mark.x.tolist() == [-b - 8.0, b]]
    assert [mark.y[0] / scale for mark in across] == pytest.approx(sorted(heights))
    labels = sorted((mark for mark in marks(figure, "", Words) if mark.side == -1), key=lambda mark: mark.y)
    assert [mark.text for mark in labels] == written
    at_drift = (*across, *(mark for mark in marks(figure, "edge") if mark.x.tolist() == [-b - 8.0, -b]))
    assert 36.0 * scale in [pytest.approx(mark.y[0]) for mark in at_drift]
    assert "drift read at 36 m" in figure.description
    assert (", sections at 0" in figure.description) == bool(heights)


def test_labels_of_heights_do_not_overlap_and_point_at_their_heights():
    (figure,) = sketches([PIER | {"sections_m": (10.0, 10.5, 11.0, 39.9)}])
    (shaft,) = marks(figure, "band", Area)
    places = sorted(mark.y for mark in marks(figure, "", Words) if mark.side == -1)
    assert len(places) == 5
    assert np.diff(places).min() >= APART
    leaders = [mark for mark in marks(figure, "edge") if mark.x.tolist() == [shaft.x.min() - 8.0, shaft.x.min() - 14.0]]
    assert sorted(mark.y[1] for mark in leaders) == places
    scale = shaft.y.max() / 40.0
    assert sorted(mark.y[0] / scale for mark in leaders) == pytest.approx([10.0, 10.5, 11.0, 39.9, 40.0])
    (panel,) = figure.panels
    assert max(places) < panel.y.high + 10.0


def test_a_pier_without_labels_shows_its_devices_alone():
    devices = (
        PlacedDevice("tendon", "tendon", Place(0.0)),
        PlacedDevice("deck_spring", "deck spring", Place(0.0, 38.0, 1.0)),
    )
    plain = {"labels": False, "deck_m": 38.0, "devices": devices, "sections_m": (3.0,)}
    labelled, bare = sketches([PIER | plain | {"labels": True}, PIER | plain])
    assert marks(bare, "", Words) == []
    assert marks(bare, "edge", Words) == []
    assert [mark.title for mark in marks(bare, "tendon")] == ["tendon", "deck spring"]
    wide, narrow = labelled.panels[0], bare.panels[0]
    assert (narrow.height, narrow.width < wide.width) == (wide.height, True)  # the ground is level beside it


def test_labels_fit_beside_a_pier():
    (figure,) = sketches([PIER | {"sections_m": (40.0,), "deck_m": 40.0}])
    (panel,) = figure.panels
    for mark in (mark for mark in panel.marks if isinstance(mark, Words) and mark.side):
        end = mark.x + mark.side * (7.0 + 6.2 * len(mark.text))
        assert panel.x.low <= end <= panel.x.high


@pytest.mark.parametrize("wrong", [{"sections_m": (-1.0,)}, {"sections_m": (99.0,)}, {"top_m": -3.0}, {"top_m": 1e5}])
def test_a_pier_with_heights_that_cannot_be_is_not_drawn(wrong):
    assert sketches([PIER | wrong]) == []


def test_no_more_piers_are_drawn_than_can_be_taken_in():
    assert len(sketches([PIER] * 20)) == MOST_PIERS


@pytest.mark.parametrize(
    "wrong", [{"height_m": 0.0}, {"half_width_m": -1.0}, {"height_m": 1e300}, {"highest_m": -3.0}, {"alpha": 0}]
)
def test_a_pier_that_cannot_be_is_not_drawn(wrong):
    assert sketches([PIER | wrong]) == []
    assert len(sketches([PIER | wrong, PIER])) == 1


def sheet(name="", **more):
    pier = dataclasses.replace(rb.Pier.rectangle(width_m=4.0, height_m=20.0, mass_t=1000.0), **more)
    base = rb.RigidBase(restraints=(rb.Tendon(psi=0.1, lam=0.2),))
    own = rb.statics(pier, base)
    return Sheet(name, pier, own.equilibria, own.swings_at)


def test_statics_show_shares_of_one_pier_and_a_curve_each_of_several():
    one = statics([sheet(flexural_period_s=1.5)])
    moment, acceleration, period = one.panels
    assert (moment.y.label, acceleration.y.label, period.y.label) == ("moment [MN m]", "acceleration [g]", "period [s]")
    whole, *shares = moment.marks
    assert [mark.label for mark in shares] == ["weight and supports", "tendons"]
    assert whole.y == pytest.approx(sum(mark.y for mark in shares))
    assert next(mark.at.tolist() for mark in period.marks if isinstance(mark, Rule)) == [1.5]
    several = statics([sheet("a"), sheet("b", flexural_period_s=1.5)])
    assert [[mark.name for mark in panel.marks] for panel in several.panels] == [["a", "b"]] * 3
    assert list(several.legend) == ["a", "b"]


@pytest.mark.parametrize(
    ("bases", "springs", "words"),
    [({"rigid"}, 0, "rigid ground"), ({"rigid", "elastic"}, 2, "two springs"), ({"footing"}, STRIPS, "a bed of strips"),
     ({"footing", "elastic"}, 2, "two springs")],
)  # fmt: skip
def test_a_footing_stands_on_a_bed_and_other_bases_on_two_springs(bases, springs, words):
    (figure,) = sketches([PIER | {"springs": springs_below(bases)}])
    turns = [mark for mark in marks(figure, "rigid") if len(mark.x) == 7 and np.ptp(mark.y) == SPRING]
    width, _ = outline(figure)
    assert sorted(float(mark.x[0]) for mark in turns) == pytest.approx(np.linspace(-0.5, 0.5, springs) * width)
    assert f"to scale on {words}:" in figure.description
