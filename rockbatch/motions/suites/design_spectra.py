"""Elastic target spectra: shapes of codes by their parameters, and tables."""

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, NamedTuple, Protocol

import numpy as np

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.motions.spectrum import Samples
from rockbatch.toml.reader import TomlFile


class Spectrum(Protocol):
    """Interface of all spectra."""

    @property
    def damping(self) -> float:
        """Return the fraction of critical damping."""

    @property
    def limits(self) -> tuple[float, float]:
        """Return the least and largest period [s] for which it is defined."""

    @property
    def code(self) -> str:
        """Return the name of the code whose conditions a suite must meet; empty for a table."""

    @property
    def beyond(self) -> str:
        """Return a remark on a limit of the code that is exceeded and not applied; empty if none is."""

    def at(self, periods: Samples) -> Samples:
        """Return the spectral acceleration [g] at periods [s], shape (n,); NaN outside ``limits``."""


class Shape(NamedTuple):
    """Soil factor and corner periods [s] of EN 1998-1, Tables 3.2 and 3.3."""

    soil_factor: float
    tb_s: float
    tc_s: float
    td_s: float


EUROCODE = {
    1: {
        "A": Shape(1.0, 0.15, 0.4, 2.0),
        "B": Shape(1.2, 0.15, 0.5, 2.0),
        "C": Shape(1.15, 0.2, 0.6, 2.0),
        "D": Shape(1.35, 0.2, 0.8, 2.0),
        "E": Shape(1.4, 0.15, 0.5, 2.0),
    },
    2: {
        "A": Shape(1.0, 0.05, 0.25, 1.2),
        "B": Shape(1.35, 0.05, 0.25, 1.2),
        "C": Shape(1.5, 0.1, 0.25, 1.2),
        "D": Shape(1.8, 0.1, 0.3, 1.2),
        "E": Shape(1.6, 0.05, 0.25, 1.2),
    },
}
"""Recommended values by type of spectrum and ground type; national annexes have their own."""


VERTICAL_SHAPE = Shape(1.0, 0.05, 0.15, 1.0)
"""Shape of the vertical spectrum of EN 1998-1, for both types and all grounds."""

VERTICAL_RATIO = {1: 0.9, 2: 0.45}
"""a_vg/a_g by type of spectrum: recommended values of EN 1998-1, Table 3.4, as later literature quotes them."""


@dataclass(frozen=True)
class EurocodeSpectrum:
    """Elastic spectrum of EN 1998-1:2004, horizontal by 3.2.2.2, eqs. (3.2) to (3.6), vertical by 3.2.2.3, up to 4 s.

    ``ag_g`` is a_g = γ_I a_gR on ground type A [g], or a_vg; η = √(10/(5 + ξ)) ≥ 0.55 follows from ``damping`` (ξ in percent).
    The plateau is ``amplification`` η times the ground acceleration: 2.5 η, vertical 3 η.
    """

    ag_g: float
    shape: Shape
    damping: float = 0.05
    name: str = "EN 1998-1"
    limits: tuple[float, float] = (0.0, 4.0)
    amplification: float = 2.5
    beyond: ClassVar[str] = ""

    @property
    def code(self) -> str:
        """Return "EN 1998-1"; "" for a vertical spectrum, for which no conditions on suites are known."""
        return "" if self.shape == VERTICAL_SHAPE else "EN 1998-1"

    def __str__(self) -> str:
        symbol = "a_vg" if self.shape == VERTICAL_SHAPE else "a_g"
        return f"{self.name}, {symbol} = {self.ag_g:g} g, {100 * self.damping:g} %"

    def at(self, periods: Samples) -> Samples:
        """Return the spectral acceleration [g] at periods [s]; NaN outside ``limits``."""
        s, tb, tc, td = self.shape
        eta = max(math.sqrt(10.0 / (5.0 + 100.0 * self.damping)), 0.55)
        plateau = self.amplification * eta
        t = np.maximum(periods, 1e-12)
        rising = 1.0 + t / tb * (plateau - 1.0)
        falling = plateau * np.select([t <= tc, t <= td], [1.0, tc / t], tc * td / t**2)
        return _within(self.limits, periods, self.ag_g * s * np.where(t < tb, rising, falling))


@dataclass(frozen=True)
class AsceSpectrum:
    """Two-period design response spectrum of ASCE/SEI 7-16, 11.4.6, for 5 % damping."""

    sds_g: float
    sd1_g: float
    tl_s: float
    damping: float = 0.05
    limits: tuple[float, float] = (0.0, math.inf)
    code: ClassVar[str] = "ASCE 7-16"
    beyond: ClassVar[str] = ""

    def __str__(self) -> str:
        return f"ASCE 7, S_DS = {self.sds_g:g} g, S_D1 = {self.sd1_g:g} g, T_L = {self.tl_s:g} s, 5 %"

    def at(self, periods: Samples) -> Samples:
        """Return the spectral acceleration [g] at periods [s] of 0 or more, all of which are within ``limits``."""
        ts = self.sd1_g / self.sds_g
        t0 = 0.2 * ts
        t = np.maximum(periods, 1e-12)
        falling = np.where(t <= self.tl_s, self.sd1_g / t, self.sd1_g * self.tl_s / t**2)
        return np.where(t < t0, self.sds_g * (0.4 + 0.6 * t / t0), np.minimum(self.sds_g, falling))


@dataclass(frozen=True)
class AashtoSpectrum:
    """Three-point design spectrum of AASHTO, by A_s at 0 s, S_DS and S_D1, for 5 % damping.

    By the formulas of programs and handbooks, not compared with the articles (LRFD 3.10.4, Guide Specifications 3.4.1 before
    the 3rd edition).
    """

    as_g: float
    sds_g: float
    sd1_g: float
    damping: float = 0.05
    limits: tuple[float, float] = (0.0, math.inf)
    code: ClassVar[str] = "AASHTO"
    beyond: ClassVar[str] = ""

    def __str__(self) -> str:
        return f"AASHTO, A_s = {self.as_g:g} g, S_DS = {self.sds_g:g} g, S_D1 = {self.sd1_g:g} g, 5 %"

    def at(self, periods: Samples) -> Samples:
        """Return the spectral acceleration [g] at periods [s] of 0 or more, all of which are within ``limits``."""
        ts = self.sd1_g / self.sds_g
        t0 = 0.2 * ts
        t = np.maximum(periods, 1e-12)
        rising = self.as_g + (self.sds_g - self.as_g) * t / t0
        return np.where(t < t0, rising, np.minimum(self.sds_g, self.sd1_g / t))


class SubsoilShape(NamedTuple):
    """Spectral shape C_h of NZS 1170.5 for a subsoil: ``start`` at 0 s, the plateau from 0.1 s, and its branches beyond,
    a (b/T)^0.75 up to 1.5 s, c/T up to 3 s, then 3 c/T²."""

    start: float
    plateau: float
    a: float
    b: float
    c: float


NZS_1170_5 = {
    "A": SubsoilShape(1.00, 2.35, 1.6, 0.50, 1.05),
    "B": SubsoilShape(1.00, 2.35, 1.6, 0.50, 1.05),
    "C": SubsoilShape(1.33, 2.93, 2.0, 0.50, 1.32),
    "D": SubsoilShape(1.12, 3.00, 2.4, 0.75, 2.14),
    "E": SubsoilShape(1.12, 3.00, 3.0, 1.00, 3.32),
}
"""Shapes for response spectra and time histories by site subsoil class, as in several programs."""

FAR_KM = 20.0
"""Distance from a major fault beyond which NZS 1170.5 has no near-fault factor."""

MOST_ZR = 0.7
"""Greatest Z R of NZS 1170.5, 3.1.1, as programs implement it."""


@dataclass(frozen=True)
class NzsSpectrum:
    """Elastic site spectrum C(T) = C_h(T) Z R N(T, D) of NZS 1170.5:2004 for 5 % damping, up to 4.5 s.

    By the numbers on which several programs agree, not compared with the standard. ``fault_km`` is the distance D from the
    nearest major fault of the standard's list; N is 1 for R up to 0.75.
    """

    subsoil: str
    hazard_factor: float
    return_period_factor: float = 1.0
    fault_km: float = math.inf
    damping: float = 0.05
    limits: tuple[float, float] = (0.0, 4.5)
    code: ClassVar[str] = "NZS 1170.5"

    def __str__(self) -> str:
        near = f", D = {self.fault_km:g} km" if self.fault_km < FAR_KM else ""
        return f"NZS 1170.5 subsoil {self.subsoil}, Z = {self.hazard_factor:g}, R = {self.return_period_factor:g}{near}, 5 %"

    @property
    def beyond(self) -> str:
        """Return a remark if Z R exceeds :data:`MOST_ZR`, the limit of the standard, which is not applied; else ""."""
        product = self.hazard_factor * self.return_period_factor
        if product <= MOST_ZR * (1.0 + 1e-9):
            return ""
        return (
            f"Z R = {product:.3g}, which NZS 1170.5, 3.1.1, as programs implement it, limits to {MOST_ZR:g}: the target is "
            f"{product / MOST_ZR:.2f} times that; for the limited one write return_period_factor = "
            f"{MOST_ZR / self.hazard_factor:.4g}"
        )

    def at(self, periods: Samples) -> Samples:
        """Return the spectral acceleration [g] at periods [s]; NaN outside ``limits``."""
        start, plateau, a, b, c = NZS_1170_5[self.subsoil]
        t = np.maximum(periods, 1e-12)
        falling = np.select([t <= 1.5, t <= 3.0], [a * (b / t) ** 0.75, c / t], 3.0 * c / t**2)
        shape = np.where(t < 0.1, start + (plateau - start) * t / 0.1, np.minimum(plateau, falling))
        values = shape * self.hazard_factor * self.return_period_factor * self._near(t)
        return _within(self.limits, periods, values)

    def _near(self, t: Samples) -> Samples:
        """Return the near-fault factor N(T, D) at periods ``t`` [s], shape of ``t``: 1 up to 1.5 s, 1.6 at 4 s, 1.66 at 4.5 s.

        That is up to 2 km from the fault; N − 1 falls linearly to 0 at 20 km, and is 0 for R ≤ 0.75.
        """
        share = min(1.0, max(0.0, (FAR_KM - self.fault_km) / 18.0)) if self.return_period_factor > 0.75 else 0.0
        return 1.0 + share * (np.interp(t, [1.5, 4.0, 5.0], [1.0, 1.6, 1.72]) - 1.0)


@dataclass(frozen=True)
class TableSpectrum:
    """A spectrum [g] given at rising periods [s]; linear between them in logarithms, or, if ``linear``, in its numbers, which
    allows 0 s.

    Raises ``InputError`` for fewer than two periods, numbers not above 0 and periods that do not rise.
    """

    periods: tuple[float, ...]
    sa_g: tuple[float, ...]
    damping: float = 0.05
    name: str = "table"
    linear: bool = False
    code: ClassVar[str] = ""
    beyond: ClassVar[str] = ""

    def __post_init__(self) -> None:
        wrong = []
        if len(self.periods) < 2:
            wrong.append("a spectrum has two periods at least")
        from_zero = self.periods[:1] in ((0,), [0])
        if from_zero and not self.linear:
            wrong.append(
                'periods must be above 0 [s] for their logarithms; write interpolation = "linear", or begin at 0.01 s'
            )
        if any(not (0 < value < math.inf) for value in (*self.periods[from_zero:], *self.sa_g)):
            wrong.append("periods [s] and spectral accelerations [g] must be numbers above 0")
        elif any(b <= a for a, b in zip(self.periods, self.periods[1:], strict=False)):
            wrong.append("periods must grow from line to line")
        if wrong:
            raise InputError(*(f"{self.name}: {message}" for message in wrong))

    def __str__(self) -> str:
        return f"{self.name}, {100 * self.damping:g} %"

    @property
    def limits(self) -> tuple[float, float]:
        """Return the first and the last period of the table [s]."""
        return self.periods[0], self.periods[-1]

    def at(self, periods: Samples) -> Samples:
        """Return the spectral acceleration [g] at periods [s]; NaN outside ``limits``."""
        if self.linear:
            return _within(self.limits, periods, np.interp(periods, self.periods, self.sa_g))
        logs = np.interp(np.log(np.maximum(periods, 1e-12)), np.log(self.periods), np.log(self.sa_g))
        return _within(self.limits, periods, np.exp(logs))


@checked
def read_spectrum(path: str | os.PathLike[str], damping: float = 0.05, linear: bool = False) -> TableSpectrum:
    """Return the spectrum in a text file: a period [s] and a spectral acceleration [g] on each line, after an optional header.

    Blanks, commas or semicolons separate them; the header ends with the first pair, and lines that begin with # are skipped.
    Raises ``InputError`` for a file that cannot be read, with the first other line, and as :class:`TableSpectrum`.
    """
    path = Path(path)
    periods: list[float] = []
    values: list[float] = []
    try:
        lines = TomlFile.text_of(path).splitlines()
    except InputError as error:
        raise InputError(f"{path}: cannot be read as a spectrum: {error}") from None
    for number, line in enumerate(lines, 1):
        cells = line.replace(",", " ").replace(";", " ").split()
        if not cells or cells[0].startswith("#"):
            continue
        try:
            period, value = map(float, cells)
        except ValueError:
            if not periods:
                continue  # its header
            raise InputError(
                f"{path}:{number}: expected a period [s] and a spectral acceleration [g]: {line.strip()[:60]}"
            ) from None
        periods.append(period)
        values.append(value)
    return TableSpectrum(tuple(periods), tuple(values), damping, path.name, linear)


def _within(limits: tuple[float, float], periods: Samples, values: Samples) -> Samples:
    """Return ``values``, with NaN at periods [s] outside ``limits``."""
    low, high = limits
    inside = (np.asarray(periods) >= low * (1 - 1e-9)) & (np.asarray(periods) <= high * (1 + 1e-9))
    return np.where(inside, values, math.nan)
