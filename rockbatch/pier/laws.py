"""Laws of yielding supports: what a pier at rest, messages and checks take from each; the core has the other half.

A law is a record of :data:`LAWS`, without which its name cannot be written, and a record of the same name in ``LAWS`` of
``rockbatch/core/springs/laws.py``, which ``rockbatch/simulation/models.py`` asks for when it is imported. No field has a default.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

from rockbatch.pier.first_loading import Curve, Straight, bouc_wen

SpringLaw = Literal["bouc-wen", "epp", "hardening"]


@dataclass(frozen=True)
class Creep:
    """Cyclic settlement (ratcheting) of springs, which settle a little with every cycle below their yield force.

    ``exponent`` says of n by which power of the load they settle; the law ``other`` does not ratchet, so that the settlement lies
    between both (THEORY.md, Results of a run).
    """

    exponent: Callable[[float], float]
    other: SpringLaw


@dataclass(frozen=True)
class Law:
    """A law of yielding supports.

    ``meaning`` stands after its name in the reference of studies; ``has_exponent`` says whether n belongs to it;
    ``first_loading`` is its curve for a value of n; ``creep`` is None unless it ratchets.
    """

    meaning: str
    has_exponent: bool
    first_loading: Callable[[float], Curve]
    creep: Creep | None


LAWS: dict[SpringLaw, Law] = {
    "bouc-wen": Law(
        meaning="smooth, as in the paper",
        has_exponent=True,
        first_loading=bouc_wen,
        creep=Creep(exponent=lambda n: n, other="epp"),
    ),
    "epp": Law(
        meaning="elastic and then perfectly plastic",
        has_exponent=False,
        first_loading=lambda n: Straight(),
        creep=None,
    ),
    "hardening": Law(
        meaning='loaded at first as "bouc-wen", and elastic below the greatest force borne so far',
        has_exponent=True,
        first_loading=bouc_wen,
        creep=None,
    ),
}
"""All laws by the names that users write."""

if missing := set(get_args(SpringLaw)) ^ set(LAWS):
    raise TypeError(f"laws of springs stand in one of SpringLaw and LAWS only: {', '.join(sorted(missing))}")

WITH_EXPONENT = tuple(name for name, law in LAWS.items() if law.has_exponent)
"""Laws with the exponent n."""

RATCHETING = tuple(name for name, law in LAWS.items() if law.creep is not None)
"""Laws that ratchet."""


def steady(word: str) -> str:
    """Return the laws that do not ratchet as a study writes them, joined by ``word``: "and" or "or"."""
    names = [f'"{name}"' for name in LAWS if name not in RATCHETING]
    return f" {word} ".join((", ".join(names[:-1]), names[-1]))


def meanings() -> str:
    """Return all laws as a study writes them, with their meanings."""
    *others, last = (f'"{name}", {law.meaning}' for name, law in LAWS.items())
    return f"{'; '.join(others)}; or {last}"
