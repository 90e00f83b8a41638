"""A quantity: a column of peaks.csv, its place in the report, and the demands that checks make of it."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, Literal, NamedTuple, Protocol

from rockbatch.pier import Pier
from rockbatch.quantities.cases import ONE, Lever
from rockbatch.quantities.demands import Ceiling, Demand, Evaluate, Facts, OtherEnd, largest, largest_force

ALL = ("rigid", "elastic", "yielding", "footing")
SPRINGS = ("elastic", "yielding", "footing")
TWO_SPRINGS = ("elastic", "yielding")
YIELDING = ("yielding",)
TILTS = (*SPRINGS, "held")
"""Bases on which a pier may rest at a tilt: springs, or any base if friction or hysteretic dampers hold it."""

SETTLING = ("yielding", "footing")
FOOTING = ("footing",)

BENDING = ("bending",)
"""A rigid base under a shaft that bends."""

BASES_IN_WORDS = {
    ALL: "",
    SPRINGS: "springs or a footing",
    YIELDING: "yielding springs",
    TILTS: "springs, a footing, or dampers that hold the pier at a tilt",
    SETTLING: "yielding springs or a footing",
    TWO_SPRINGS: "springs",
    FOOTING: "a footing",
    BENDING: "a shaft that bends",
}

ENDINGS = {
    "m": "m",
    "s": "s",
    "rad": "rad",
    "m/s": "m_s",
    "1/s": "per_s",
    "m/s^2": "m_s2",
    "m^2/s^2": "m2_s2",
    "J/kg": "J_kg",
    "kN": "kN",
    "MPa": "MPa",
    "kJ": "kJ",
    "kN*s": "kN_s",
    "kN*m": "kNm",
    "standard_gravity": "g",
}
"""Endings of names by unit, in the notation of pint."""

SHARES = ("forces_error", "devices_error")
"""Columns of relative errors; other errors are in the unit of their quantity."""


class Run(Protocol):
    """The parts of a finished run that a quantity takes."""

    @property
    def outcome(self) -> Any:
        """The :class:`rockbatch.outcome.outcome.Outcome` of the run."""

    @property
    def pga(self) -> float:
        """Peak horizontal acceleration of its motion, as it was run [m/s²]."""

    @property
    def pier(self) -> Pier:
        """The pier of its case."""


class ReportFormat(NamedTuple):
    """A quantity in the report: its heading, its format, and the factor from the file's unit to the page's, 1 or 1000.

    The page makes an index of a word after a low line: "θ_max/α". ``behind`` names the column after which it is put, if
    that is not the one before it in the file. ``table`` is the section in whose tables it is.
    """

    head: str
    form: str = ".10g"
    factor: int = 1
    behind: str = ""
    table: Literal["peaks", "forces"] = "peaks"


class OfSuite(NamedTuple):
    """Heading of the statistics of a quantity over a suite, and the format of its numbers there."""

    heading: str
    form: str


class Limit(NamedTuple):
    """A demand that checks make of a quantity, with the quantity's name, words, unit and columns unless given.

    A ``unit`` without a name replaces the ending of the quantity's name; ``times`` is the factor from the columns to the unit.
    """

    name: str = ""
    unit: str = ""
    times: Lever = ONE
    ceiling: Ceiling | None = None
    words: str = ""
    columns: tuple[str, ...] = ()
    evaluate: Evaluate | None = None
    reached: Evaluate | None = None
    other_end: OtherEnd | None = None
    height: Lever | None = None


@dataclass(frozen=True)
class Quantity(Facts):
    """A quantity of a run."""

    name: str  # of its column, with its unit, if any; fixed, since users' scripts read it
    words: str  # its meaning, as far as checks need it; the same for columns that are explained together
    # field of ``Outcome``, or function of a :class:`Run`; None for names of the run
    source: str | Callable[[Run], Any] | None = None
    unit: str = "1"  # of a number, as pint reads it; "1" is none
    page: ReportFormat | None = None  # its place in the report; None: it has none
    more: str = ""  # what its meaning goes on with
    # "number", "count" (a whole one), "fact" (1 if it holds, 0 if not) or "text"
    kind: Literal["number", "count", "fact", "text"] = "number"
    over_alpha: bool = False  # true if the outcome's angle is divided by the pier's α
    bases: tuple[str, ...] = ALL  # bases to which it applies; it is empty on others
    stood: bool = False  # true if it is empty for a pier that overturned, and a run that flight ended
    unbounded: bool = False  # true if a number may be infinite
    sometimes: bool = False  # true if only some of the runs to which it applies have one: a flight, a reason
    suite: OfSuite | None = None  # its statistics, if it has any; two studies are compared by it, too
    error: str = ""  # column of its estimated error; empty without one
    limits: tuple[Limit, ...] = ()  # demands that checks make of it
    requested: Callable[[Any], bool] | None = None  # true for a study that brings it otherwise
    least_is_worst: bool = False  # true if the smallest value of several runs is the worst

    @property
    def meaning(self) -> str:
        """The whole meaning in a sentence, with the key of [output] that it needs."""
        return f"{self.words}{self.more}" + (f"; with [output] {self.needs} = true" if self.needs else "")

    @property
    def unit_on_page(self) -> str:
        """Unit of its numbers in the report, "mm" of metres times 1000; empty for none."""
        prefix = "m" if self.page and self.page.factor == 1000 else ""
        return prefix + in_print(self.unit)

    @property
    def applies(self) -> str:
        """Runs to which the quantity applies: "yielding springs, if the pier stayed upright"; empty for all."""
        base = BASES_IN_WORDS[self.bases]
        run = "if the pier stayed upright" if self.stood else "if it occurs" if self.sometimes else ""
        return ", ".join(filter(None, (base, run)))

    def requested_by(self, study: Any) -> bool:
        """Return whether the peaks.csv of a :class:`rockbatch.study.Study` has a column of this quantity.

        ``requested`` alone decides if given; otherwise [output] must have what it ``needs``, and a case its ``device``.
        """
        if self.requested:
            return self.requested(study)
        if self.needs and not study.output.has(self.needs):
            return False
        return not self.device or any(
            self.device in device.kinds for case in study.cases for device in case.base.restraints
        )

    def demands(self) -> list[Demand]:
        """Return the demands that checks make of this quantity, one for each of its ``limits``."""
        return [self._demand(limit) for limit in self.limits]

    def _demand(self, limit: Limit) -> Demand:
        """Return the demand of a limit: its own evaluation, else the largest magnitude of its columns, by default the quantity's.

        Quantities with [output] forces are evaluated by :func:`largest_force`.
        """
        columns = limit.columns or (self.name,)
        evaluate = limit.evaluate
        if evaluate is None and self.needs == "forces":
            evaluate = largest_force(columns, limit.times, self.error)
        if evaluate is None:
            error = "share" if self.error in SHARES else "error"
            evaluate = largest(columns, limit.times, **{error: self.error})
        name = limit.name or (f"{self._stem}_{limit.unit}" if limit.unit else self.name)
        return Demand(
            name,
            limit.words or self.words,
            evaluate,
            in_print(limit.unit or self.unit),
            self.bases,
            residual=self.stood,
            other_end=limit.other_end,
            ceiling=limit.ceiling,
            reached=limit.reached,
            height=limit.height,
            **{shared.name: getattr(self, shared.name) for shared in fields(Facts)},
        )

    @property
    def _stem(self) -> str:
        """The name without its unit."""
        return self.name.removesuffix(f"_{ENDINGS[self.unit]}")


def in_print(unit: str) -> str:
    """Return a unit as people write it: "m/s²", "kN m"; empty for none."""
    if unit == "1":
        return ""
    return unit.replace("standard_gravity", "g").replace("^2", "²").replace("*", " ")


def fact(name: str, words: str, more: str = "", source: Callable[[Run], Any] | None = None, **facts: Any) -> Quantity:
    """Return a quantity that is 1 if ``words`` hold, 0 if not, by the field ``name`` of ``Outcome``, or by ``source``."""
    return Quantity(name, f"1 if {words}, 0 if not", source or name, more=more, kind="fact", sometimes=True, **facts)
