"""What a run left in its folder: ``peaks.csv`` and ``run.json``, read back and held against each other."""

import csv
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch.errors import InputError
from rockbatch.files import csv_plain
from rockbatch.results.columns import COLUMNS, COUNTS, MORE_COLUMNS, PEAKS, TEXTS
from rockbatch.results.run_json import INFO

if TYPE_CHECKING:
    import pandas as pd

SECTIONS = (
    "rockbatch", "created", "command", "study", "versions", "machine", "numerics", "varied", "cases",
    "records", "unusable", "references", "runs", "jobs", "wall_s",
)  # fmt: skip
MOST_PROBLEMS = 20


@dataclass(frozen=True, eq=False)
class Saved:
    """The results in a folder.

    Attributes
    ----------
    directory : Path
        The folder.
    info : dict
        ``run.json``.
    peaks : DataFrame
        ``peaks.csv`` with the types that ``rockbatch.run`` returns: texts that are "" where they do not apply, numbers
        that are NaN, counts that can be missing; varied keys are numbers or texts.
    """

    directory: Path
    info: dict[str, Any]
    peaks: "pd.DataFrame"


def read_saved(directory: Path) -> Saved:
    """Read what ``rockbatch run`` wrote into ``directory``.

    Raises ``InputError``, with all that is wrong at once, where a file is missing or damaged.
    """
    directory = Path(directory)
    problems: list[str] = []
    info = _read_info(directory / INFO, problems)
    peaks = _read_peaks(directory / PEAKS, info.get("varied", []), problems)
    if problems or peaks is None:
        raise InputError(*problems)
    return Saved(directory, info, peaks)


def _read_info(path: Path, problems: list[str]) -> dict[str, Any]:
    try:
        info = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        problems.append(f"{path}: not there; give a folder that `rockbatch run` has written")
        return {}
    except ValueError as error:
        line = getattr(error, "lineno", 1)
        problems.append(f"{path}:{line}: not JSON ({error}); start `rockbatch run` again")
        return {}
    if not isinstance(info, dict):
        problems.append(f"{path}: not what `rockbatch run` writes; start it again")
        return {}
    missing = [name for name in SECTIONS if name not in info]
    if missing:
        problems.append(f"{path}: has no {', '.join(missing)}; start `rockbatch run` again with this version")
    return info


def _read_peaks(path: Path, varied: Sequence[str], problems: list[str]) -> "pd.DataFrame | None":
    import pandas as pd

    try:
        with path.open(encoding="utf-8", newline="") as file:
            head = next(csv.reader(file), [])
    except FileNotFoundError:
        problems.append(f"{path}: not there; give a folder that `rockbatch run` has written")
        return None
    except (UnicodeDecodeError, csv.Error) as error:
        problems.append(f"{path}:1: not a table ({error}); start `rockbatch run` again")
        return None
    missing = [name for name in (*COLUMNS, *MORE_COLUMNS, *varied) if name not in head]
    if missing:
        problems.append(f"{path}:1: has no column {', '.join(missing)}; start `rockbatch run` again")
        return None
    texts = [name for name in head if name in TEXTS or name in varied or name == "vertical"]
    numbers = [name for name in head if name not in texts]
    try:
        # A record may be called "NA": only an empty number is missing
        table = pd.read_csv(
            path, keep_default_na=False, na_values={name: [""] for name in numbers}, encoding="utf-8", index_col=False,
            dtype={**dict.fromkeys(texts, "str"), **dict.fromkeys(numbers, "float64")},
        )  # fmt: skip
        for name in COUNTS:
            table[name] = table[name].astype("Int64")
    except (ValueError, TypeError) as error:
        found = _bad_cells(path, head, numbers)
        problems += found or [f"{path}: not a table ({error}); start `rockbatch run` again"]
        return None
    for name in texts:
        escaped = table[name].str.startswith("'")
        if escaped.any():
            table.loc[escaped, name] = table.loc[escaped, name].map(csv_plain)
    for name in varied:
        table[name] = _values(table[name])
    return table


def _bad_cells(path: Path, head: Sequence[str], numbers: Sequence[str]) -> list[str]:
    """Every row of another length and every cell that should be a number and is not, with its line."""
    found: list[str] = []
    try:
        with path.open(encoding="utf-8", newline="") as file:
            reader = csv.reader(file)
            next(reader)
            for cells in reader:
                place = f"{path}:{reader.line_num}"
                if len(cells) != len(head):
                    found.append(f"{place}: {len(cells)} cells: expected {len(head)}, as in the first line")
                    continue
                row = dict(zip(head, cells, strict=True))
                found += [
                    f'{place}: {name} = "{row[name]}": expected {"a whole number" if name in COUNTS else "a number"} '
                    "or nothing"
                    for name in numbers
                    if not _is_number(row[name], name in COUNTS)
                ]
    except (UnicodeDecodeError, csv.Error) as error:
        found.append(f"{path}: not a table ({error}); start `rockbatch run` again")
    more = len(found) - MOST_PROBLEMS
    return [*found[:MOST_PROBLEMS], *([f"{path}: and {more} more"] if more > 0 else [])]


def _is_number(text: str, whole: bool) -> bool:
    try:
        value = float(text or 0)
    except ValueError:
        return False
    return value.is_integer() if whole else True


def _values(texts: "pd.Series[str]") -> "pd.Series[Any]":
    """Values of a varied key: numbers, or words such as "finite"; NaN where the key does not apply."""
    import pandas as pd

    numbers = pd.to_numeric(texts, errors="coerce")
    words = numbers.isna() & (texts != "")
    return texts.where(texts != "") if words.any() else numbers.astype("float64")
