"""What a command other than ``rockbatch run`` left in a folder: NAME.json and its tables."""

import json
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from rockbatch.errors import InputError
from rockbatch.files import read_table, read_text
from rockbatch.report.labels import quantity

if TYPE_CHECKING:
    import pandas as pd


P = ParamSpec("P")
T = TypeVar("T")

_DAMAGE = (KeyError, IndexError, TypeError, ValueError, AttributeError, ArithmeticError)
"""What drawing raises where a file of an analysis says something else than its command writes."""


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


def of_files(name: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """A section that is drawn from NAME.json and its tables, which may come from anybody: where they do not fit, words say so."""

    def decorated(section: Callable[P, T]) -> Callable[P, T]:
        @wraps(section)
        def told(*args: P.args, **more: P.kwargs) -> T:
            try:
                return section(*args, **more)
            except InputError:
                raise
            except _DAMAGE as error:
                what = f"{type(error).__name__}: {error}"
                raise InputError(
                    f"{name}.json and its tables do not fit each other, or are damaged ({what}); start `rockbatch {name}` again"
                ) from error

        return told

    return decorated


def named(values: Mapping[str, Any], shown: Sequence[str]) -> str:
    """The values that tell one picture from another, in words: "pads, β = 40"."""
    words = [str(values["case"])]
    words += [quantity(name, values[name]) for name in shown if name != "case" and values[name] == values[name]]
    return ", ".join(words)
