"""Laws of yielding supports as the pier, messages and checks need them; their kernels are in the core.

A law has an entry in :data:`LAWS`, which makes its name known, and one of the same name in ``LAWS`` of
``rockbatch/core/springs/laws.py``, which ``rockbatch/simulation/models.py`` checks on import. No field has a default.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

from rockbatch.pier.backbones import Points
from rockbatch.pier.first_loading import Curve, Polyline, Straight, bouc_wen

SpringLaw = Literal["bouc-wen", "epp", "hardening", "backbone"]


@dataclass(frozen=True)
class Creep:
    """Cyclic settlement (ratcheting) of springs, which settle a little with every cycle below their yield force.

    ``exponent`` returns the power of the load with which they settle, from n; the law ``other`` does not ratchet, so that the
    settlement lies between those by both laws (THEORY.md, Results of a run).
    """

    exponent: Callable[[float], float]
    other: SpringLaw


@dataclass(frozen=True)
class Law:
    """A law of yielding supports.

    ``meaning`` follows its name in the reference of studies; ``has_exponent`` is True if it has the exponent n;
    ``has_points`` if its curve is given by points; ``first_loading`` returns the curve for n and points; ``creep`` is None
    unless it ratchets.
    """

    meaning: str
    has_exponent: bool
    has_points: bool
    first_loading: Callable[[float, Points], Curve]
    creep: Creep | None


LAWS: dict[SpringLaw, Law] = {
    "bouc-wen": Law(
        meaning="smooth, as in the paper",
        has_exponent=True,
        has_points=False,
        first_loading=lambda n, points: bouc_wen(n),
        creep=Creep(exponent=lambda n: n, other="epp"),
    ),
    "epp": Law(
        meaning="elastic and then perfectly plastic",
        has_exponent=False,
        has_points=False,
        first_loading=lambda n, points: Straight(),
        creep=None,
    ),
    "hardening": Law(
        meaning='loaded at first as "bouc-wen", and elastic below the greatest force borne so far',
        has_exponent=True,
        has_points=False,
        first_loading=lambda n, points: bouc_wen(n),
        creep=None,
    ),
    "backbone": Law(
        meaning="loaded along the points given, and elastic below the greatest force borne so far",
        has_exponent=False,
        has_points=True,
        first_loading=lambda n, points: Polyline(points),
        creep=None,
    ),
}
"""All laws, by the names that a study gives."""

if missing := set(get_args(SpringLaw)) ^ set(LAWS):
    raise TypeError(f"laws of springs stand in one of SpringLaw and LAWS only: {', '.join(sorted(missing))}")

WITH_EXPONENT = tuple(name for name, law in LAWS.items() if law.has_exponent)
"""Laws with the exponent n."""

WITH_POINTS = tuple(name for name, law in LAWS.items() if law.has_points)
"""Laws whose curve is given by points."""

WITHOUT_POINTS = tuple(name for name in LAWS if name not in WITH_POINTS)
"""Laws whose curve follows from n or has no parameter."""

RATCHETING = tuple(name for name, law in LAWS.items() if law.creep is not None)
"""Laws that ratchet."""


def without_ratcheting(word: str) -> str:
    """Return the quoted names of the laws that neither ratchet nor need points, joined by ``word``: '"epp" or "hardening"'."""
    names = [f'"{name}"' for name in WITHOUT_POINTS if name not in RATCHETING]
    return f" {word} ".join((", ".join(names[:-1]), names[-1]))


def meanings() -> str:
    """Return the quoted names of all laws with their meanings: '"bouc-wen", smooth, …; "epp", …; or "hardening", …'."""
    *others, last = (f'"{name}", {law.meaning}' for name, law in LAWS.items())
    return f"{'; '.join(others)}; or {last}"
