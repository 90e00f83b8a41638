"""The page of formats says what comes of every layout today."""

import importlib.util
from pathlib import Path

import pytest
from layouts import LAYOUTS

SCRIPT = Path(__file__).parents[2] / "docs" / "layouts.py"


@pytest.mark.slow
def test_the_page_of_formats_is_what_comes_of_the_layouts():
    spec = importlib.util.spec_from_file_location("layouts_page", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    page = script.page()
    assert page == script.PAGE.read_text(encoding="utf-8"), "write it anew: python docs/layouts.py"
    assert len(LAYOUTS) > 50
