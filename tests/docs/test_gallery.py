"""The pictures of the gallery: each script draws one, with axes that say what they show, and the page has it."""

import importlib.util
import re
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest

DOCS = Path(__file__).parents[2] / "docs"
SCRIPTS = sorted((DOCS / "gallery").glob("*.py"))


def module_of(path):
    """Load the script at ``path``."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def drawn(path):
    """Draw the figure of the script at ``path``."""
    return module_of(path).draw()


LONG = "bounds", "comparison", "design", "fragility", "overturning_map", "peaks", "self_similar", "spectrum"
COMPILED = ("footing", "opensees")
"""Those with a kernel that no fast test shares; `make docs` draws them and the long ones, too."""


def marks_of(name):
    """Return the mark of a script that takes longer than fast tests do."""
    return [pytest.mark.thorough] * (name in LONG) + [pytest.mark.slow] * (name in COMPILED)


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("path", [pytest.param(path, id=path.stem, marks=marks_of(path.stem)) for path in SCRIPTS])
def test_each_script_draws_a_picture(path):
    figure = drawn(path)
    picture = BytesIO()
    figure.savefig(picture, format="png", dpi=40)
    assert picture.getvalue().startswith(b"\x89PNG")
    shown = [axes for axes in figure.axes if axes.get_visible()]
    said = {axes.get_ylim() for axes in shown if axes.get_ylabel()}
    for axes in shown:
        assert axes.has_data()
        shared = axes.get_shared_y_axes().get_siblings(axes) != [axes]
        assert not axes.axison or shared or axes.get_ylim() in said  # by itself, or by one of the same scale


def test_the_page_has_every_picture_and_no_other():
    page = (DOCS / "pages" / "gallery.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"\(pictures/(\w+)\.svg\)", page)) == [path.stem for path in SCRIPTS]


OPENSEES = DOCS.parent / "benchmarks" / "opensees_curve"


def test_the_scripts_beside_each_other_are_those_whose_curves_are_drawn():
    """The page has benchmarks/opensees_curve.py to the letter, and the keywords of the gallery's run."""
    ours, theirs = re.findall(
        r"```python\n(.*?)```", (DOCS / "pages/questions/opensees.md").read_text("utf-8"), re.DOTALL
    )
    script = OPENSEES.with_suffix(".py").read_text("utf-8")
    assert theirs == script[script.index("import math") :]
    drawn_by = (DOCS / "gallery" / "opensees.py").read_text("utf-8")
    assert all(line.split(" = ")[-1] in drawn_by for line in ours.splitlines()[2:5])


@pytest.mark.slow
def test_the_curve_of_opensees_is_ours_within_what_the_page_says():
    """0.4 mrad of 41, whose bound is the digit behind it; the base is held elsewhere."""
    response = module_of(DOCS / "gallery" / "opensees.py").run()
    t, theta = np.loadtxt(OPENSEES.with_suffix(".csv"), delimiter=",", skiprows=1).T
    apart = np.abs(np.interp(t, response.t, response.theta) - theta)
    assert 0.0 < apart.max() < 0.45e-3
    assert apart.max() < 0.0105 * np.abs(theta).max()
