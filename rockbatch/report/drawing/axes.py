"""Axes of a picture: from values to pixels, round ticks, and the frame with its numbers."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rockbatch.report.drawing.svg import Array, text
from rockbatch.report.markup import Markup, join, tag


@dataclass(frozen=True)
class Scale:
    """Values ``low``..``high`` along one axis; ``log`` for powers of ten."""

    low: float
    high: float
    log: bool = False

    def fraction(self, values: Array) -> Array:
        """Return places along the scale: 0 at ``low``, 1 at ``high``."""
        if self.log:
            return np.log(values / self.low) / math.log(self.high / self.low)
        return (values - self.low) / (self.high - self.low)

    def ticks(self, about: int) -> list[float]:
        """Return round values, ``about`` as many or fewer."""
        if self.log:
            first, last = math.ceil(math.log10(self.low) - 1e-9), math.floor(math.log10(self.high) + 1e-9)
            return [10.0**i for i in range(first, last + 1, max(1, math.ceil((last - first + 1) / about)))]
        rough = (self.high - self.low) / max(about, 1)
        power = 10.0 ** math.floor(math.log10(rough))
        step = next(power * round_ for round_ in (1, 2, 2.5, 5, 10) if power * round_ >= rough * (1 - 1e-9))
        first, last = math.ceil(self.low / step - 1e-9), math.floor(self.high / step + 1e-9)
        return [i * step for i in range(first, last + 1)]

    def round_ticks(self) -> list[float]:
        """Return 1, 2 and 5 times the powers of ten within a logarithmic scale; the powers alone if it is wide."""
        powers = range(math.floor(math.log10(self.low)), math.ceil(math.log10(self.high)) + 1)
        steps = (1, 2, 5) if self.high < 100 * self.low else (1,)
        return [tick for n in powers for step in steps if self.low <= (tick := step * 10.0**n) <= self.high]


def spanning(*arrays: Array, margin: float = 0.06) -> Scale:
    """Return a scale that holds every finite value, and zero, with a margin."""
    finite = [array[np.isfinite(array)] for array in arrays]
    low = min((float(array.min()) for array in finite if len(array)), default=0.0)
    high = max((float(array.max()) for array in finite if len(array)), default=0.0)
    low, high = min(low, 0.0), max(high, 0.0)
    room = margin * (high - low) or 1.0
    return Scale(low - room * (low < 0 or high == low), high + room)


@dataclass(frozen=True)
class Axes:
    """A rectangle of a picture [px] with a scale on either side."""

    left: float
    top: float
    width: float
    height: float
    x: Scale
    y: Scale

    def across(self, values: float | Array) -> Array:
        """Return abscissae [px]."""
        return self.left + self.width * self.x.fraction(np.asarray(values, dtype=np.float64))

    def down(self, values: float | Array) -> Array:
        """Return ordinates [px], from the top of the picture."""
        return self.top + self.height * (1 - self.y.fraction(np.asarray(values, dtype=np.float64)))

    def frame(
        self, x_ticks: Sequence[float] | None, y_ticks: Sequence[float], x_numbers: bool = True, y_numbers: bool = True
    ) -> Markup:
        """Draw the grid and the numbers beside it; no vertical lines if ``x_ticks`` is None."""
        right, foot = self.left + self.width, self.top + self.height
        lines = "".join(f"M{self.left:.1f} {y:.1f}H{right:.1f}" for y in self.down(np.array(y_ticks)))
        lines += "".join(f"M{x:.1f} {self.top:.1f}V{foot:.1f}" for x in self.across(np.array(x_ticks or [])))
        drawn = [tag("path", d=lines, class_="grid")]
        drawn += [tag("path", d=f"M{self.left:.1f} {self.top:.1f}V{foot:.1f}H{right:.1f}", class_="edge")]
        if y_numbers:
            places = self.down(np.array(y_ticks))
            drawn += [text(self.left - 4, y + 4, s, class_="e") for y, s in zip(places, written(y_ticks), strict=True)]
        if x_ticks and x_numbers:
            places = self.across(np.array(x_ticks))
            drawn += [text(x, foot + 13, s, class_="m") for x, s in zip(places, written(x_ticks), strict=True)]
        return join(*drawn)

    def readable(self, kind: str, *content: object, names: str | None = None) -> Markup:
        """Group ``content`` so that the script can read values back; ``kind`` is "time" or "plane".

        ``names`` are those of the quantities of a plane: "elongation [mm]|F [kN]".
        """
        box = f"{self.left:g} {self.top:g} {self.width:g} {self.height:g}"
        limits = f"{self.x.low:.6g} {self.x.high:.6g}", f"{self.y.low:.6g} {self.y.high:.6g}"
        return tag("g", *content, class_="axes", data_kind=kind, data_box=box, data_x=limits[0], data_y=limits[1],
                   data_names=names)  # fmt: skip


def written(ticks: Sequence[float]) -> list[str]:
    """Format ticks with as many decimals as their step needs; as powers of ten if they are far apart."""
    if len(ticks) > 1 and ticks[0] > 0 and ticks[1] / ticks[0] > 9:
        return [_power_of_ten(tick) for tick in ticks]
    step = min((b - a for a, b in pairwise(ticks)), default=ticks[0] if ticks else 1.0) or 1.0
    decimals = next((d for d in range(9) if math.isclose(step, round(step, d), rel_tol=1e-6)), 9)
    return [f"{tick + 0.0:.{decimals}f}".replace("-", "−") for tick in ticks]


def _power_of_ten(value: float) -> str:
    exponent = round(math.log10(value))
    if 0 <= exponent <= 4:
        return f"{10**exponent}"
    return "10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
