"""The notebooks of the docs run from top to bottom, without a word on stderr, and are kept with what they come to."""

import ast
import importlib.util
import json
import os
import re
import time
import tomllib
from pathlib import Path

import nbformat
import pytest
from jsonschema import Draft7Validator
from jupyter_client.manager import start_new_kernel
from studies import RIGID, study_text, write_study

import rockbatch as rb
from rockbatch.study.schema import STUDY, schema_of

FOLDER = Path(__file__).parents[1] / "docs" / "notebooks"
_SPEC = importlib.util.spec_from_file_location("execute", FOLDER / "execute.py")
execute = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(execute)


def test_there_are_notebooks():
    assert [path.name for path in execute.NOTEBOOKS] == ["first_study.ipynb"]


def test_the_cells_use_names_that_are_public_and_studies_that_are_read():
    (path,) = execute.NOTEBOOKS
    cells = [cell.source for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]
    for cell in cells:
        used = {
            node.attr for node in ast.walk(ast.parse(cell)) if getattr(getattr(node, "value", None), "id", "") == "rb"
        }
        assert used <= set(rb.__all__)
    (study,) = (text for cell in cells for text in re.findall(r'f"""(.*?)"""', cell, re.DOTALL))
    written = tomllib.loads(re.sub(r"\{.*\}", "records", study))
    wrong = Draft7Validator(schema_of(STUDY, "")).iter_errors(written)
    assert [error.message for error in wrong] == []


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


@pytest.mark.slow
def test_a_notebook_is_kept_with_what_it_comes_to(notebook):
    stored = nbformat.read(execute.NOTEBOOKS[0], as_version=4)
    nbformat.validate(stored)
    assert texts(outputs_of(stored)) == texts(outputs_of(execute.kept(notebook)))
    assert len(shown(outputs_of(stored), "image/png")) == 2


def shown(outputs, kind):
    """What objects gave as a picture of one kind."""
    return [output.data[kind] for output in outputs if kind in output.get("data", {})]


@pytest.mark.slow
def test_the_first_study_shows_its_objects_as_tables_and_figures(executed):
    tables = shown(executed, "text/html")
    assert sum("10 ground motions" in table for table in tables) == 1
    assert sum("results of &#x27;My first stepping pier&#x27;" in table for table in tables) == 1
    assert sum("response " in table for table in tables) == 2
    assert len(shown(executed, "image/png")) == 2


@pytest.mark.slow
def test_the_bar_of_a_notebook_warns_of_nothing(executed):
    """Without ipywidgets tqdm warns, and draws in characters."""
    errors = "".join(output.text for output in executed if output.output_type == "stream" and output.name == "stderr")
    assert "Warning" not in errors
    assert "/30 [" in errors


@pytest.mark.slow
def test_an_interrupted_cell_ends_and_the_same_cell_goes_on_in_the_same_kernel(tmp_path):
    """No finished run is lost, and the table has the bytes of a run that nobody interrupted."""
    scales = [0.2 + 0.0005 * i for i in range(4000)]
    study = write_study(tmp_path, study_text(cases=(RIGID,), motions={"scale": scales}, output={"histories": "none"}))
    part, top = tmp_path / "out" / "peaks.csv.part", str(Path(rb.__file__).parents[1])
    manager, client = start_new_kernel(cwd=str(tmp_path), env=os.environ | {"PYTHONPATH": top})
    try:
        assert client.execute("import rockbatch as rb", reply=True, timeout=120)["content"]["status"] == "ok"
        cell = 'table = rb.run("study.toml", "out", jobs=1)'
        asked, until = client.execute(cell), time.monotonic() + 600
        while not part.exists() or part.read_bytes().count(b"\n") < 2:
            assert time.monotonic() < until
            time.sleep(0.01)
        manager.interrupt_kernel()
        reply = client.get_shell_msg(timeout=60)
        assert (reply["parent_header"]["msg_id"], reply["content"]["ename"]) == (asked, "KeyboardInterrupt")
        finished = part.read_bytes().count(b"\n") - 1
        assert 0 < finished < len(scales)
        reply, until = client.execute(cell, reply=True, timeout=120), time.monotonic() + 120
        while (
            reply["content"]["status"] == "aborted" and time.monotonic() < until
        ):  # with those that an interrupt cuts off
            reply = client.execute(cell, reply=True, timeout=120)
        assert reply["content"]["status"] == "ok"
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)
    assert json.loads((tmp_path / "out" / "run.json").read_text(encoding="utf-8"))["kept"] >= finished
    rb.run(study, tmp_path / "whole")
    assert (tmp_path / "out" / "peaks.csv").read_bytes() == (tmp_path / "whole" / "peaks.csv").read_bytes()
