"""What a command other than ``rockbatch run`` left in a folder: NAME.json and its tables."""

import hashlib
import json
import warnings
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from rockbatch.errors import EditedTable, InputError
from rockbatch.files import read_table, read_text, sha256_of
from rockbatch.report.labels import counted, quantity
from rockbatch.report.markup import Markup, tag

if TYPE_CHECKING:
    import pandas as pd


MOST_NAMES = 60

P = ParamSpec("P")
T = TypeVar("T")

_DAMAGE = (KeyError, IndexError, TypeError, ValueError, AttributeError, ArithmeticError)
"""What drawing raises where a file of an analysis says something else than its command writes."""


@dataclass(frozen=True)
class FinishedAnalysis:
    """An analysis that is finished: what NAME.json says about it, and its folder."""

    directory: Path
    info: dict[str, Any]

    def provenance(self) -> Markup:
        """Under which ground motions it was made, and with which versions; empty where an earlier version has not noted them."""
        motions = [str(one["label"]) for one in self.info.get("under", ())]
        versions = {"rockbatch": self.info["rockbatch"], **self.info["versions"]} if "versions" in self.info else {}
        told = (
            [
                f"{counted(len(motions), 'ground motion')}: {'; '.join(motions[:MOST_NAMES])}"
                + (f"; and {len(motions) - MOST_NAMES} more" if len(motions) > MOST_NAMES else "")
            ]
            if motions
            else []
        )
        told += (
            [f"made with {', '.join(f'{name} {version}' for name, version in versions.items())}"] if versions else []
        )
        return (
            tag("p", ". ".join(part[0].upper() + part[1:] for part in told), ".", class_="legend")
            if told
            else Markup("")
        )

    def table(self, name: str, columns: Collection[str]) -> "pd.DataFrame | None":
        """One of its tables; None where NAME.json does not name it, or where it is damaged or lacks a column.

        Warns of an ``EditedTable``.
        """
        if name not in self.info.get("files", []):
            return None
        path, noted = self.directory / name, self.info.get("digests", {}).get(name, {}).get("sha256")
        try:
            if noted and sha256_of(path) != noted:
                _tell(path)
            table = read_table(path)
        except (OSError, ValueError):
            return None
        return table if len(table) and set(columns) <= set(table.columns) else None


def read(directory: Path, name: str, sha256: str) -> FinishedAnalysis | None:
    """The analysis ``name`` in a folder.

    None where there is none, or where it is of another state of the study than the one with the digest ``sha256``: the
    report does without. Warns of an ``EditedTable`` where NAME.json is not as it was written.
    """
    path = Path(directory) / f"{name}.json"
    try:
        info = json.loads(read_text(path))
        of_study = info["study"]["sha256"]
        intact = "sha256" not in info or info["sha256"] == digest_of(info)
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        of_study, intact = None, False
    if not intact:
        _tell(path)
    return FinishedAnalysis(Path(directory), info) if of_study == sha256 else None


def digest_of(info: Mapping[str, Any]) -> str:
    """Digest of all that NAME.json says, which it has in its own ``sha256``."""
    said = {key: value for key, value in info.items() if key != "sha256"}
    return hashlib.sha256(json.dumps(said).encode()).hexdigest()


def _tell(path: Path) -> None:
    """Warn of a file that is not as it was written."""
    told = f"{path}: not as it was written: it was edited, or is damaged; what can be read of it is shown"
    warnings.warn(told, EditedTable, stacklevel=3)


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
