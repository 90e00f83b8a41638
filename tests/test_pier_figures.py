"""The figures of a pier: to scale with its devices, and its statics."""

import dataclasses
import math

import numpy as np
import pytest

import rockbatch as rb
from rockbatch.common.figures.description import Area, Polyline, Rule, Words
from rockbatch.pier import Place
from rockbatch.pier.figures import ASIDE, MOST_PIERS, Sheet, sketches, statics

PIER = {"alpha": math.atan(0.2), "half_width_m": 4.0, "height_m": 20.0}


def marks(figure, kind, type_=Polyline):
    (panel,) = figure.panels
    return [mark for mark in panel.marks if isinstance(mark, type_) and mark.look.kind == kind]


def outline(figure):
    """Return width and height of the shaft [px]."""
    (shaft,) = marks(figure, "band", Area)
    return np.ptp(shaft.x), np.ptp(shaft.y)


def test_piers_are_to_one_scale():
    figures = sketches([PIER | {"top_m": 30.0}, PIER | {"half_width_m": 1.0, "height_m": 10.0}], {"rigid", "yielding"})
    (wide, tall), (narrow, low) = map(outline, figures)
    assert wide / tall == pytest.approx(8.0 / 30.0)
    assert narrow / low == pytest.approx(2.0 / 20.0)
    assert tall / low == pytest.approx(30.0 / 20.0)


def test_the_deck_and_the_devices_are_to_scale():
    devices = (("tendon", Place(-2.0)), ("viscous damper", Place(4.0)), ("stop", Place(-4.0)))
    (figure,) = sketches([PIER | {"top_m": 30.0, "deck_m": 33.0, "devices": devices}], {"rigid"})
    scale = outline(figure)[1] / 30.0
    (deck,) = marks(figure, "deck", Area)
    assert deck.y.mean() == pytest.approx(33.0 * scale)
    tendon = next(mark for mark in marks(figure, "tendon") if mark.title == "tendon")
    assert tendon.x.tolist() == pytest.approx([-2.0 * scale] * 2)
    assert tendon.y.max() == pytest.approx(30.0 * scale)
    (damper,) = marks(figure, "damper", Area)
    assert damper.x.mean() == pytest.approx(4.0 * scale + ASIDE)
    assert "with tendon and viscous damper and stop" in figure.description
    assert {"h = 20 m", "2b = 8 m", "deck, 33 m"} <= {mark.text for mark in marks(figure, "", Words)}


def test_the_slenderness_is_an_arc_about_the_toe_from_the_edge_to_the_radius():
    (figure,) = sketches([PIER], {"rigid"})
    (shaft,) = marks(figure, "band", Area)
    (arc,) = (mark for mark in marks(figure, "edge") if len(mark.x) > 2)
    toe = shaft.x.max()
    assert np.ptp(np.hypot(arc.x - toe, arc.y)) < 1e-9
    turned = np.arctan2(toe - arc.x, arc.y)
    assert (turned.min(), turned.max()) == pytest.approx((0.0, PIER["alpha"]))


def test_no_more_piers_are_drawn_than_can_be_taken_in():
    assert len(sketches([PIER] * 20, {"rigid"})) == MOST_PIERS


@pytest.mark.parametrize(
    "wrong", [{"height_m": 0.0}, {"half_width_m": -1.0}, {"height_m": 1e300}, {"top_m": -3.0}, {"alpha": 0}]
)
def test_a_pier_that_cannot_be_is_not_drawn(wrong):
    assert sketches([PIER | wrong], {"rigid"}) == []
    assert len(sketches([PIER | wrong, PIER], {"rigid"})) == 1


def sheet(name="", **more):
    pier = dataclasses.replace(rb.Pier.rectangle(width_m=4.0, height_m=20.0, mass_t=1000.0), **more)
    base = rb.RigidBase(restraints=(rb.Tendon(psi=0.1, lam=0.2),))
    own = rb.statics(pier, base)
    return Sheet(name, pier, own.equilibria, own.swings_at)


def test_the_statics_of_one_pier_have_the_shares_of_its_moment_and_of_several_a_curve_each():
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
