"""Run the notebooks beside this file and keep what their cells come to: ``python docs/notebooks/execute.py``."""

import re
from pathlib import Path

import nbclient
import nbformat

NOTEBOOKS = sorted(Path(__file__).parent.glob("*.ipynb"))


def executed(path: Path) -> nbformat.NotebookNode:
    """Return the notebook with the outputs of this machine."""
    notebook = nbformat.read(path, as_version=4)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(path.parent)}}).execute()
    return notebook


def kept(notebook: nbformat.NotebookNode) -> nbformat.NotebookNode:
    """Return the notebook as it is kept: without progress bars, times, and names of temporary folders."""
    text = nbformat.writes(notebook)
    text = re.sub(r"(?:/[\w.-]+)*/tmp\w{8}\b", "folder", text)
    notebook = nbformat.reads(text, as_version=4)
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)
        if cell.cell_type == "code":
            cell.outputs = [output for output in cell.outputs if output.get("name") != "stderr"]
    notebook.metadata.get("language_info", {}).pop("version", None)
    return notebook


if __name__ == "__main__":
    for path in NOTEBOOKS:
        nbformat.write(kept(executed(path)), path)
