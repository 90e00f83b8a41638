"""The notebooks of the docs run from top to bottom, without a word on stderr, and are kept with what they come to."""

import importlib.util
from pathlib import Path

import nbformat
import pytest

FOLDER = Path(__file__).parents[1] / "docs" / "notebooks"
_SPEC = importlib.util.spec_from_file_location("execute", FOLDER / "execute.py")
execute = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(execute)


def test_there_are_notebooks():
    assert [path.name for path in execute.NOTEBOOKS] == ["first_study.ipynb"]


@pytest.fixture(scope="module")
def notebook():
    """The first study, run anew."""
    return execute.executed(execute.NOTEBOOKS[0])


@pytest.fixture(scope="module")
def executed(notebook):
    """What its cells came to."""
    return outputs_of(notebook)


def outputs_of(notebook):
    """The outputs of all cells."""
    return [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]


def texts(outputs):
    """What cells print and how objects are written; pictures count, and their bytes do not."""
    return [output.get("text") or output.data["text/plain"] for output in outputs]


def test_a_notebook_is_kept_with_what_it_comes_to(notebook):
    stored = nbformat.read(execute.NOTEBOOKS[0], as_version=4)
    nbformat.validate(stored)
    assert texts(outputs_of(stored)) == texts(outputs_of(execute.kept(notebook)))
    assert len(shown(outputs_of(stored), "image/png")) == 2


def shown(outputs, kind):
    """What objects gave as a picture of one kind."""
    return [output.data[kind] for output in outputs if kind in output.get("data", {})]


def test_the_first_study_shows_its_objects_as_tables_and_figures(executed):
    tables = shown(executed, "text/html")
    assert sum("10 ground motions" in table for table in tables) == 1
    assert sum("results of &#x27;My first stepping pier&#x27;" in table for table in tables) == 1
    assert sum("response " in table for table in tables) == 2
    assert len(shown(executed, "image/png")) == 2


def test_the_bar_of_a_notebook_warns_of_nothing(executed):
    """Without ipywidgets tqdm warns, and draws in characters."""
    errors = "".join(output.text for output in executed if output.output_type == "stream" and output.name == "stderr")
    assert "Warning" not in errors
    assert "/30 [" in errors
