"""The peak of every record on every foundation, of configs/near_fault.toml."""

from pathlib import Path
from tempfile import TemporaryDirectory

from matplotlib.figure import Figure

import rockbatch as rb

STUDY = Path(__file__).parents[2] / "configs" / "near_fault.toml"


def draw() -> Figure:
    with TemporaryDirectory() as folder:
        rb.run(STUDY, out=folder)
        return rb.open_results(folder).plot()
