"""Small synthetic records for tests, and the place of real ones."""

import os
import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pytest

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # ObsPy's own use of the standard library, when it is first loaded
    import obspy  # noqa: F401

from rockbatch.motions import MotionSet, ReadOptions, read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.folder import read_files
from rockbatch.motions.labels.orientation import split_stem

RECORDS = Path(os.environ.get("ROCKBATCH_RECORDS", "no-records"))
"""Folder of real records, most of which may not be redistributed; its path comes from the environment."""

needs_records = pytest.mark.skipif(not RECORDS.is_dir(), reason="ROCKBATCH_RECORDS names no folder of real records")


@cache
def real_motions(*folders: str, unit: str | None = None) -> MotionSet:
    """Return the motions of all real records, or of some of their folders; read once."""
    return read_motions([RECORDS / folder for folder in folders] or RECORDS, options=ReadOptions(unit=unit))


@cache
def real_components(unit: str | None = None) -> list[Component]:
    """Return the components of all real records, copies included; read once."""
    readings, _, _ = read_files([RECORDS], options=ReadOptions(unit=unit))
    return [reading for reading in readings if isinstance(reading, Component)]


def state_of(found: MotionSet) -> list[object]:
    """Return names and numbers of a folder, as people see them."""
    return [
        *(
            (m.name, m.named, m.station, m.dt, m.horizontal.tobytes(), m.vertical_source, m.notes)
            for m in found.motions
        ),
        *found.unusable,
        *found.left_out,
    ]


def e15_7(value: float) -> str:
    """Return a number as PEER's Fortran writes it in E15.7: ``  -.2415593E-03``."""
    mantissa, exponent = f"{abs(value):.6e}".split("e")
    digits = mantissa.replace(".", "")
    power = int(exponent) + 1 if value else 0
    return f"{'-' if value < 0 else ''}.{digits}E{power:+03d}".rjust(15)


def at2_text(
    values,
    *,
    dt: str = ".0100",
    count: str | None = None,
    title: str = "Made-up, 1/17/1994, Test Station, 228",
    unit: str = "ACCELERATION TIME SERIES IN UNITS OF G",
    newline: str = "\n",
    number=e15_7,
) -> str:
    """Return an AT2 file; ``count`` replaces the header line with the number of points."""
    fields = [number(float(value)) for value in values]
    lines = ["".join(fields[i : i + 5]) for i in range(0, len(fields), 5)]
    count = count or f"NPTS= {len(fields):6d}, DT=   {dt} SEC"
    return newline.join(["PEER NGA STRONG MOTION DATABASE RECORD", title, unit, count, *lines, ""])


def write_at2(folder: Path, name: str, values, **header) -> Path:
    """Write an AT2 file into ``folder``; unless a ``title`` is given, it says the direction that the name does, or 228°."""
    folder.mkdir(parents=True, exist_ok=True)
    by_name = split_stem(Path(name).stem)[1]
    header.setdefault("title", f"Made-up, 1/17/1994, Test Station, {by_name.label if by_name else 228}")
    path = folder / name
    path.write_bytes(at2_text(values, **header).encode("latin-1"))
    return path


def wiggle(npts: int = 200, seed: int = 1, scale: float = 0.1) -> np.ndarray:
    """Return noise under a bell, in g, with its peak of 0.9 ``scale`` inside: no two records alike, none suspicious.

    The ground comes to rest where it was: the sum and the first moment of the accelerations are zero.
    """
    t = np.linspace(-3, 3, npts)
    bell = np.exp(-(t**2))
    a = bell * np.convolve(np.random.default_rng(seed).standard_normal(npts + 4), [1, 2, 3, 2, 1], "valid")
    a -= bell * (a.sum() / bell.sum() + t * (t @ a) / (t @ (t * bell)))
    return 0.9 * scale * a / np.abs(a).max()
