"""What a command other than ``rockbatch run`` left in a folder: NAME.json and its tables."""

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch.files import read_table, read_text
from rockbatch.report.labels import quantity

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class FinishedAnalysis:
    """An analysis that is finished: what NAME.json says about it, and its folder."""

    directory: Path
    info: dict[str, Any]

    def table(self, name: str, columns: Collection[str]) -> "pd.DataFrame | None":
        """One of its tables; None where NAME.json does not name it, or where it is damaged or lacks a column."""
        if name not in self.info.get("files", []):
            return None
        try:
            table = read_table(self.directory / name)
        except (OSError, ValueError):
            return None
        return table if len(table) and set(columns) <= set(table.columns) else None


def read(directory: Path, name: str, sha256: str) -> FinishedAnalysis | None:
    """The analysis ``name`` in a folder.

    None where there is none, or where it is of another state of the study than the one with the digest ``sha256``: the
    report does without.
    """
    try:
        info = json.loads(read_text(Path(directory) / f"{name}.json"))
        if info["study"]["sha256"] != sha256:
            return None
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    return FinishedAnalysis(Path(directory), info)


def named(values: Mapping[str, Any], shown: Sequence[str]) -> str:
    """The values that tell one picture from another, in words: "pads, β = 40"."""
    words = [str(values["case"])]
    words += [quantity(name, values[name]) for name in shown if name != "case" and values[name] == values[name]]
    return ", ".join(words)
