"""Forces in sections of each run: sections.csv, a row for each section; interaction.csv, one for each corner of the envelope."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from rockbatch.common.lazy import pd
from rockbatch.outcome.outcome import Section
from rockbatch.pier import Pier
from rockbatch.quantities.demands import OF_SECTIONS
from rockbatch.results.beside_peaks import read_beside


def section_rows(pier: Pier, sections: Sequence[Section]) -> list[dict[str, Any]]:
    """Return a row for each section of a run of ``pier``; None for its forces in kN if the mass is not known."""
    rows = []
    for height, *forces, error in sections:
        in_kilonewtons = [None if pier.mass_t is None else pier.mass_t * force for force in forces]
        rows.append(dict(zip(OF_SECTIONS, (height, *forces, *in_kilonewtons, error), strict=True)))
    return rows


def as_table(rows: Iterable[dict[str, Any]]) -> "pd.DataFrame":
    """Return rows as a DataFrame of floats, with the columns of sections.csv alone; NaN for None and missing cells."""
    return pd.DataFrame(list(rows), columns=list(OF_SECTIONS), dtype="float64")


def read_forces(path: Path, varied: Sequence[str], columns: Iterable[str]) -> "pd.DataFrame":
    """Read ``columns`` of either table of a study with these ``varied`` keys; ``InputError`` if one is missing or has texts."""
    return read_beside(path, varied, columns).astype(dict.fromkeys(columns, "float64"))


_SYMBOLS = {"shear": "V", "moment": "moment", "axial_least": "N", "axial_greatest": "N", "axial_at_moment": "N"}


class ForceColumn(NamedTuple):
    """A column of sections.csv, with symbol and unit of its force."""

    name: str
    symbol: str
    unit: str
    over_mass: bool


def columns_in(runs: "pd.DataFrame") -> dict[str, ForceColumn]:
    """Return the columns by force ("shear", "moment", …): in kN if all rows have these, else over the mass."""
    over_mass = bool(runs["section_shear_kN"].isna().any())
    columns = {}
    for name, symbol in _SYMBOLS.items():
        unit, ending = ("kN m", "kNm") if name == "moment" else ("kN", "kN")
        if over_mass:
            symbol, unit, ending = f"{symbol}/M", *(("m²/s²", "m2_s2") if name == "moment" else ("m/s²", "m_s2"))
        columns[name] = ForceColumn(f"section_{name}_{ending}", symbol, unit, over_mass)
    return columns
