"""A release test, what was measured of it and what is fitted: [release] of a study file."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise, zip_longest
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.study.load import Study
from rockbatch.study.spec import Case
from rockbatch.toml.csv_columns import columns_of
from rockbatch.toml.kinds import choice, not_negative, positive, share, text
from rockbatch.toml.reader import Table
from rockbatch.toml.section import Clash, Key, Section

FITS = ("restitution", "epsilon", "zeta")

UNITS = {
    "impact_s": ("impact_s", 1.0),
    "impact_ms": ("impact_s", 1e-3),
    "amplitude_rad": ("amplitude_rad", 1.0),
    "amplitude_mrad": ("amplitude_rad", 1e-3),
    "amplitude_deg": ("amplitude_rad", math.pi / 180.0),
}
"""Columns of a file of measured values: the key that each stands for, and the factor on its numbers."""

FEWEST, MOST = 3, 500
"""Values and impacts of a test: with fewer there is no interval, and more no test has."""


@dataclass(frozen=True)
class ReleaseSpec:
    """[release]: a row of ``impact_s`` [s] from the release and ``amplitude_rad`` for each impact, NaN where not measured.

    ``fit`` is None for what the base of each case has: restitution on rigid ground, zeta or epsilon of springs.
    """

    impact_s: tuple[float, ...] = ()
    amplitude_rad: tuple[float, ...] = ()
    measured: str | None = None
    clock: str = "release"
    fit: str | None = None
    confidence: float = 0.95

    def fits(self, case: Case) -> str:
        """Return the key fitted in a case: the given one, else "restitution", on springs "zeta" if it has one, or "epsilon"."""
        if self.fit is not None:
            return self.fit
        if not case.base.on_springs:
            return "restitution"
        return "epsilon" if getattr(case.base, "zeta", None) is None else "zeta"


RELEASE = Section(
    ("release",),
    (
        "A release test, by `rb.release`: what was measured as the pier was let go from `initial_rotation_rad`, to which the "
        "restitution of rigid ground, or the losses of springs, are fitted."
    ),
    {
        "impact_s": Key(
            positive,
            "[0.32, 0.86, 1.31]",
            "Times of the impacts [s], from the first one on; on springs of the passages through upright.",
            many=True,
            distinct=False,
        ),
        "amplitude_rad": Key(
            positive,
            "[0.082, 0.068, 0.057]",
            "Greatest rotation [rad], without its sign, after each of these impacts.",
            many=True,
            distinct=False,
        ),
        "measured": Key(
            text,
            '"test.csv"',
            "Instead: a CSV with a row for each impact, and the columns impact_s or impact_ms, and amplitude_rad, "
            "amplitude_mrad or amplitude_deg; empty where nothing was measured. Relative to the study file.",
        ),
        "clock": Key(
            choice("release", "first impact"),
            '"first impact"',
            'Where times count from: the "release", or the "first impact", whose own time may be any then.',
        ),
        "fit": Key(
            choice(*FITS),
            '"restitution"',
            "What is fitted; by default restitution on a rigid base, and of springs zeta, if the case has one, or epsilon.",
        ),
        "confidence": Key(share, "0.95", "Level of the intervals."),
    },
    homes=(ReleaseSpec,),
    clashes=(
        Clash(("measured", "impact_s"), "measured and impact_s are given; keep one"),
        Clash(("measured", "amplitude_rad"), "measured and amplitude_rad are given; keep one"),
    ),
)

SECTIONS = (RELEASE,)
"""Its tables in a study file."""


def read_release(study: Study) -> ReleaseSpec:
    """Return what the study file says of its release test in [release].

    Raises ``InputError`` with every mistake, or because there is no such table.
    """
    file = study.file()
    table = file.table("release", required="[release] with impact_s = [0.32, 0.86, 1.31], measured times of impacts")
    spec = ReleaseSpec()
    if table is not None:
        read = table.read(RELEASE)
        if "measured" in read:
            read |= _of_file(table, read["measured"])
        read |= _padded(read.get("impact_s", ()), read.get("amplitude_rad", ()), read.get("clock"))
        spec = ReleaseSpec(**read)
        if not file.problems:
            _check_measured(table, spec, study)
    file.finish()
    return spec


def _padded(times: Sequence[float], amplitudes: Sequence[float], clock: str | None) -> dict[str, tuple[float, ...]]:
    """Return times [s] and amplitudes [rad] of equal number, padded by NaN.

    With the clock "first impact" times count from the first, which is then NaN.
    """
    rows = list(zip_longest(times, amplitudes, fillvalue=math.nan))
    if clock == "first impact" and rows:
        first = rows[0][0] if rows[0][0] == rows[0][0] else 0.0
        rows = [(t - first, amplitude) for t, amplitude in rows]
        rows[0] = (math.nan, rows[0][1])  # 0 by definition, and so no measurement
    return {"impact_s": tuple(t for t, _ in rows), "amplitude_rad": tuple(value for _, value in rows)}


def _of_file(table: Table, name: str) -> dict[str, tuple[float, ...]]:
    """Return the columns of a CSV of measured values as impact_s [s] and amplitude_rad [rad], whichever it has.

    {} after a mistake in it, which becomes a problem of ``table``.
    """
    path = table.file.path.parent / Path(name).expanduser()
    with table.noting("measured"):
        columns = columns_of(path, dict.fromkeys(UNITS, not_negative), gaps=True)
        measured = {UNITS[name][0]: tuple(UNITS[name][1] * x for x in values) for name, values in columns.items()}
        if len(measured) < len(columns):
            raise InputError(f"{path}: times or amplitudes are given by two columns; keep one")
        return measured
    return {}


def _check_measured(table: Table, spec: ReleaseSpec, study: Study) -> None:
    """Complain about values that no free rocking gives, and about cases that leave nothing to fit.

    They may be fewer than FEWEST, 3, values or more than MOST, 500, impacts, times that do not rise, and a first amplitude not
    below the initial rotation, or no such rotation; and bases without what is to be fitted.
    """
    times, amplitudes = _numbered(spec.impact_s), _numbered(spec.amplitude_rad)
    key = "measured" if spec.measured else "impact_s"
    measured = len(times) + len(amplitudes)
    if measured < FEWEST or len(spec.impact_s) > MOST:
        few = f"{measured} values were measured, and an interval takes {FEWEST} at least"
        message = few if measured < FEWEST else f"more than {MOST} impacts"
        table.complain(f"{message}; write impact_s, amplitude_rad or both", *([key] if table.has(key) else []))
    for (n, previous), (m, t) in pairwise(times):
        if not t > previous:
            table.complain(f"impact {m} is at {t:g} s, and impact {n} at {previous:g} s: times have to rise", key)
            break
    start = [abs(case.pier.initial_rotation_rad) for case in study.cases]
    if not all(start):
        table.complain("from where was the pier let go? write initial_rotation_rad = 0.1 under [pier]")
    elif amplitudes and amplitudes[0][1] >= min(start):
        table.complain(
            f"amplitude {amplitudes[0][0]} is {amplitudes[0][1]:g} rad, not below initial_rotation_rad, {min(start):g} rad: "
            "the first amplitude is the one after the first impact",
            "measured" if spec.measured else "amplitude_rad",
        )
    for case in study.cases:
        if case.base.asks_tension:
            table.complain(
                f'case "{case.name}" has impact = "housner", whose e follows from the pier: nothing is left to be fitted; '
                'write impact = "landing" or zeta'
            )
        elif (spec.fits(case) == "restitution") == case.base.on_springs:
            instead = "epsilon or zeta" if case.base.on_springs else "restitution"
            table.complain(
                f'fit = "{spec.fit}": case "{case.name}" has {instead} instead; write that, or leave it out', "fit"
            )


def _numbered(values: Iterable[float]) -> list[tuple[int, float]]:
    """Return number and value of those that are not NaN; the numbers, from 1, count the others, too."""
    return [(n, value) for n, value in enumerate(values, 1) if not math.isnan(value)]
