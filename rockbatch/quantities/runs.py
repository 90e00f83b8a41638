"""Rows of peaks.csv as arrays, for what asks a few of them for a few columns, a thousand times over."""

import copy

import numpy as np
import numpy.typing as npt

from rockbatch.common.lazy import pd
from rockbatch.quantities.statistics import Values

Texts = npt.NDArray[np.object_]

MISSING = -1
"""Place of a row that a table lacks."""


class Runs:
    """Rows of a table, n of them: columns of numbers, NaN where there is none, and of texts, "" there; shape (n,).

    A DataFrame of the same rows takes ten times as long to make and to ask. ``rows`` are their places in the table; each of its
    columns is converted once, for all that :meth:`at` takes from it.
    """

    def __init__(self, table: "pd.DataFrame") -> None:
        self.rows = np.arange(len(table))
        self._table = table
        self._known: dict[str, Texts] = {}
        self._numbers: dict[str, Values] = {}
        self._texts: dict[str, Texts] = {}

    def at(self, rows: npt.NDArray[np.intp], **known: Texts) -> "Runs":
        """Return those at ``rows`` of the table, :data:`MISSING` for one that it lacks; with columns ``known`` of these, too."""
        taken = copy.copy(self)
        taken.rows, taken._known = rows, known
        return taken

    def where(self, chosen: npt.NDArray[np.bool_]) -> "Runs":
        """Return those that are ``chosen``, shape (n,)."""
        return self.at(self.rows[chosen], **{name: texts[chosen] for name, texts in self._known.items()})

    def beside(self, wider: "Runs") -> "Runs":
        """Return the same rows of a table that has further columns, all of whose rows are in ``wider``."""
        return wider.at(self.rows, **self._known)

    def __len__(self) -> int:
        return len(self.rows)

    def __contains__(self, column: str) -> bool:
        return column in self._table

    def numbers(self, column: str) -> Values:
        """Return a column of numbers; NaN for one that an earlier version did not write."""
        if column not in self._table:
            return np.full(len(self), np.nan)
        if column not in self._numbers:
            whole = self._table[column].to_numpy(dtype=np.float64, na_value=np.nan)
            self._numbers[column] = np.append(whole, np.nan)  # which MISSING takes
        return self._numbers[column][self.rows]

    def texts(self, column: str) -> Texts:
        """Return a column of texts; "" for one that an earlier version did not write."""
        if column in self._known:
            return self._known[column]
        if column not in self._texts:
            cells = self._table[column].astype(object) if column in self._table else pd.Series(index=self._table.index)
            self._texts[column] = np.array(
                [*cells.where(cells.notna(), "").map(str), ""], dtype=object
            )  # MISSING takes it
        return self._texts[column][self.rows]
