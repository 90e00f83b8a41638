"""Display of objects: a few lines in a terminal, a small table in a notebook; and of values, as TOML writes them."""

import json
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import fields
from html import escape
from itertools import islice

from rockbatch.common.files import legible
from rockbatch.common.lazy import pd

MOST_LISTED = 6
"""Greatest number of names that a sentence lists, unless it says otherwise."""
MOST_ROWS = 12
"""Greatest number of rows of a table in a notebook."""


class InNotebook:
    """A dataclass that shows the fields that differ from their defaults as a table in a notebook; its ``repr`` is Python's."""

    def _facts(self) -> tuple[str, Mapping[str, str]]:
        """Return the name of the class, and the fields that differ from their defaults as short texts; "" is not shown."""
        given = [(field.name, getattr(self, field.name), field.default) for field in fields(self)]  # type: ignore[arg-type]
        return type(self).__name__, {name: _short(value) for name, value, default in given if value != default}

    def _beneath(self) -> "pd.DataFrame | None":
        """Return a table whose first rows are shown below the facts, None without one."""
        return None

    def _repr_html_(self) -> str:
        title, facts = self._facts()
        rows = [f"<tr><th>{escape(name)}</th><td>{escape(words)}</td></tr>" for name, words in facts.items() if words]
        shown = f"<p><strong>{escape(title)}</strong></p>" + (f"<table>{''.join(rows)}</table>" if rows else "")
        table = self._beneath()
        if table is None or table.empty:
            return shown
        more = len(table) - MOST_ROWS
        remainder = f"<p>and {more} more</p>" if more > 0 else ""
        return shown + table.head(MOST_ROWS).to_html(index=False, na_rep="", border=0) + remainder


class Shown(InNotebook, ABC):
    """An object whose ``repr`` and view in a notebook are made of the same few facts."""

    @abstractmethod
    def _facts(self) -> tuple[str, Mapping[str, str]]:
        """Return the title, and facts by their names; facts that are "" are not shown."""

    def __repr__(self) -> str:
        title, facts = self._facts()
        facts = {name: words for name, words in facts.items() if words}
        width = max(map(len, facts), default=0)
        return "\n".join([f"<{title}>", *(f"  {name:<{width}}  {words}" for name, words in facts.items())])


def _short(value: object) -> str:
    """Return a value as short text: floats with 5 significant digits, items of a tuple separated by semicolons, others by str.

    An :class:`InNotebook` is its title and facts, "Pier: alpha = 0.13".
    """
    if isinstance(value, InNotebook):
        title, facts = value._facts()
        return f"{title}: " + ", ".join(f"{name} = {words}" for name, words in facts.items() if words)
    if isinstance(value, tuple):
        return "; ".join(map(_short, value))
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def several(n: int, noun: str) -> str:
    """Return a count with its noun: "1 run", "2 runs"; empty for 0."""
    return "" if n == 0 else f"{n} {noun}" if n == 1 else f"{n} {noun}s"


def abridged(names: Sequence[str], comma: str = "; ", most: int = MOST_LISTED) -> str:
    """Return up to ``most`` names with ``comma`` between them, then "and 3 more" for the number of the others."""
    more = len(names) - most
    return comma.join(names[:most]) + (f"{comma}and {more} more" if more > 0 else "")


def capital(words: str) -> str:
    """Return words with a capital first letter; "" for none."""
    return words[:1].upper() + words[1:]


def shown(value: object, limit: int = 60) -> str:
    """Return the value as TOML writes it, a text in quotes, legible, and cut with "…" if longer than ``limit``."""
    if isinstance(value, bool):
        written = str(value).lower()
    elif isinstance(value, str):
        written = json.dumps(value[: limit + 1], ensure_ascii=False)  # TOML's basic strings are JSON's
    elif isinstance(value, list):
        written = "[" + ", ".join(map(shown, value[:limit])) + "]"
    elif isinstance(value, dict):
        written = "{ " + ", ".join(f"{key} = {shown(item)}" for key, item in islice(value.items(), limit)) + " }"
    elif isinstance(value, int) and value.bit_length() > 64:
        written = hex(value)  # Python refuses to write thousands of digits
    else:
        written = str(value)
    written = legible(written)
    return written if len(written) <= limit else written[: limit - 1] + "…"
