"""Counts, headings and heads of columns on the page."""

import re
from collections.abc import Sequence

from rockbatch.common.units import with_unit
from rockbatch.quantities.labels import symbol_of
from rockbatch.quantities.quantity import Quantity
from rockbatch.reporting.markup import Markup, escape, tag
from rockbatch.reporting.table import WHOLE, Head


def counted(count: int, word: str) -> str:
    """Return a count with its noun: "one run", "30 runs", "1,200 runs", "0 runs"."""
    return f"{count:,} {word}s" if count != 1 else f"one {word}"


def symbol(key: str) -> str:
    """Return symbol and unit of a study key for an axis or a sentence: "p [rad/s]"."""
    return with_unit(*symbol_of(key))


def head_of_key(key: str, form: str = WHOLE, note: str | None = None, *, filter: bool = False) -> Head:
    """Return the head of a study key: its symbol and unit."""
    letter, unit = symbol_of(key)
    return Head(letter, form, note, unit=unit, filter=filter)


def heading(words: str) -> Markup:
    """Return words as HTML, with small letters and 0 after "_" as a subscript, as "max" in "θ_max/α"."""
    return Markup(re.sub(r"_([a-z0]+)", lambda match: tag("sub", match[1]), escape(words)))


def head(column: Quantity) -> Head:
    """Return the head of a column that is in the report, its tooltip with the column's name and meaning."""
    assert column.page is not None
    factor = f" × {column.page.factor}" if column.page.factor != 1 else ""
    note = f"{column.name}{factor}: {column.meaning}"
    return Head(heading(column.page.head), column.page.form, note, unit=column.unit_on_page)


def first_of(names: Sequence[str], most: int) -> str:
    """Return the first ``most`` names and how many are left out: "a, b and 3 more"."""
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")
