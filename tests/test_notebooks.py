"""The notebooks of the docs run from top to bottom, without a word on stderr, and are kept without their outputs."""

from pathlib import Path

import nbclient
import nbformat
import pytest

NOTEBOOKS = sorted(Path(__file__).parents[1].glob("docs/notebooks/*.ipynb"))


def test_there_are_notebooks():
    assert [path.name for path in NOTEBOOKS] == ["first_study.ipynb"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_kept_without_outputs(path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            assert (cell.outputs, cell.execution_count) == ([], None)


@pytest.fixture(scope="module")
def executed():
    """The first study, with what its cells came to."""
    notebook = nbformat.read(NOTEBOOKS[0], as_version=4)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(NOTEBOOKS[0].parent)}}).execute()
    return [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]


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
