"""The pictures of the gallery: each script draws one, with axes that say what they show, and the page has it."""

import importlib.util
import re
from io import BytesIO
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
SCRIPTS = sorted((DOCS / "gallery").glob("*.py"))


def drawn(path):
    """The figure of the script at ``path``."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.draw()


LONG = "bounds", "comparison", "design", "fragility", "overturning_map", "peaks", "self_similar", "spectrum"
COMPILED = ("footing",)
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
