"""interaction.csv: axial force and moment of the same moment in sections, a row for each corner of their envelope."""

from collections.abc import Sequence
from pathlib import Path

from rockbatch.common.lazy import pd
from rockbatch.quantities.demands import OF_INTERACTION
from rockbatch.results.beside_peaks import read_beside

INTERACTION = "interaction.csv"


def read_interaction(path: Path, varied: Sequence[str]) -> "pd.DataFrame":
    """Read interaction.csv of a study with these ``varied`` keys; ``InputError`` if a column is missing or has texts."""
    return read_beside(path, varied, OF_INTERACTION).astype(dict.fromkeys(OF_INTERACTION, "float64"))
