"""Labels of foundations and piers, made of the values that distinguish them."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass

from rockbatch.quantities.cases import Case, backbone
from rockbatch.quantities.labels import distinguishing_digits, quantity, titled
from rockbatch.quantities.quantity import FOOTING
from rockbatch.study import PIER_KEYS

BASE_KEYS = (
    "beta",
    "stiffness_kN_m",
    "eta",
    "yield_kN",
    "safety_factor",
    "impact",
    "epsilon",
    "zeta",
    "spring",
    "n",
    "kinematics",
    "flight",
    "restitution",
    "flight_limit_mm",
    "friction",
    "area_m2",
)
SAME = {"beta": "stiffness_kN_m", "eta": "yield_kN"}
"""Equivalent keys, without and with units: labels use the one that the study gives."""

Key = tuple[object, ...]
"""Identity of a foundation: case and varied values in the order of the study; of a pier: varied values."""


@dataclass(frozen=True)
class Series:
    """A foundation in figures: a marker, or a line for rigid ground without devices.

    ``tick`` is its short label on axes; ``index`` counts the rigid foundations, or the others, from 0; ``has_values`` tells a
    label that has values from a case's bare name, ``has_tick`` one that begins with the tick.
    """

    label: str
    tick: str
    rigid: bool
    index: int
    has_values: bool = False
    has_tick: bool = False

    @property
    def order(self) -> tuple[bool, int]:
        """Return the key by which series are sorted: rigid ground first."""
        return not self.rigid, self.index

    def with_values(self, words: Iterable[str]) -> str:
        """Return the label followed by further values: "pads: β = 40, p = 1 rad/s", or "pads: p = 1 rad/s" of "pads"."""
        return ", ".join((self.label, *words)) if self.has_values else titled(self.label, words)

    @property
    def keyed(self) -> str:
        """Return the label for a legend after the tick, "a – pads: β = 40"; alone if rigid, or if it begins with it."""
        return self.label if self.rigid or self.has_tick else f"{self.tick} – {self.label}"


def named(
    cases: Mapping[Key, Sequence[Case]], varied: Sequence[str], given: Mapping[str, Collection[str]]
) -> dict[Key, Series]:
    """Return a series for each foundation, labelled by its case and the values that distinguish it from others of its kind.

    The case is left out if all share it and values distinguish them. A tick is a letter, or the name of the case if all names
    differ and have three characters at most. ``cases`` maps each foundation to its entries in run.json, one for each pier;
    ``given`` maps case names to the keys that the study gives. Rigid ground without devices is a line, ``rigid``, unless all
    of several foundations are.
    """
    constants = {key: _constants(of_foundation, given.get(str(key[0]), ())) for key, of_foundation in cases.items()}
    # The rocking block itself, drawn as a line to compare others with: on rigid ground and without devices
    firsts = {key: entries[0] for key, entries in cases.items()}
    rigid = {
        key for key, case in firsts.items() if case["base"] == "rigid" and not case["parameters"].get("restraints")
    }
    if 1 < len(cases) == len(rigid):
        rigid = set()  # without others to compare with, they get markers
    shown = dict.fromkeys((*BASE_KEYS, *varied))
    # Supports are compared with supports only: rigid ground lacks their keys
    kinds = {key: (key in rigid, case["base"] == "rigid") for key, case in firsts.items()}
    values = {
        kind: [(firsts[key]["base"], constants[key]) for key in cases if kinds[key] == kind] for kind in kinds.values()
    }
    differing = {kind: _differing(shown, of_kind) for kind, of_kind in values.items()}
    digits = {
        name: distinguishing_digits(constants_of.get(name) for constants_of in constants.values()) for name in shown
    }
    names = [key[0] for key in cases if key not in rigid]
    short = len(set(names)) == len(names) and all(len(str(name)) <= 3 for name in names)
    alone = len({key[0] for key in cases}) == 1  # a name that all share distinguishes nothing
    series: dict[Key, Series] = {}
    count = {True: 0, False: 0}
    for key in cases:
        kind = key in rigid
        distinguishing = [name for name in differing[kinds[key]] if name in constants[key]]
        words = [quantity(name, constants[key][name], digits[name], cases[key][0]) for name in distinguishing]
        case, index = str(key[0]), count[kind]
        count[kind] += 1
        untitled = bool(words) and alone
        label, tick = ", ".join(words) if untitled else titled(case, words), case if short else _tick(index)
        series[key] = Series(label, tick, kind, index, bool(words), has_tick=short and not untitled)
    return series


def under_bounds(designs: Mapping[Key, Series], keys: Iterable[Key]) -> dict[Key, Series]:
    """Return a series for each of the ``keys``, which end with a bound: the label of its design and the bound.

    It is "pads: stiff ground", or "pads: β = 40, stiff ground" if the label has values. The nominal design, whose bound is "",
    keeps its label. Letters are given anew.
    """
    series: dict[Key, Series] = {}
    count = {True: 0, False: 0}
    for *design, bound in keys:
        of_design = designs[(*design, "")]
        kind, index = of_design.rigid, count[of_design.rigid]
        count[kind] += 1
        label = of_design.with_values([str(bound)]) if bound else of_design.label
        series[(*design, bound)] = Series(label, _tick(index), kind, index, of_design.has_values or bool(bound))
    return series


def _tick(index: int) -> str:
    """Return the short label of a series: a letter, or a number from the 27th on."""
    return chr(ord("a") + index) if index < 26 else str(index + 1)


def _differing(names: Iterable[str], values: Sequence[tuple[str, Mapping[str, object]]]) -> list[str]:
    """Return the ``names`` whose values are not all equal; ``values`` are those of each foundation, after its base.

    Bases none of which has a name are not compared by it: a footing has no spring.
    """
    differing = []
    for name in names:
        having = {base for base, of_foundation in values if name in of_foundation}
        if len({str(of_foundation.get(name)) for base, of_foundation in values if base in having}) > 1:
            differing.append(name)
    return differing


def _constants(cases: Sequence[Case], given: Collection[str]) -> dict[str, object]:
    """Return the parameters and varied values of a foundation that are equal on every pier, except keys of the pier and None.

    Of β and the stiffness, and of η and the yield force, the one with units is kept if it is in ``given``, since the other then
    depends on the pier; else the one without. β of a footing is left out unless it is given. So is η of a backbone, which is
    that of its first corner, while checks of η take its greatest force.
    """
    first, *further = [case["parameters"] | case["columns"] for case in cases]
    omitted = {free if unit in given else unit for free, unit in SAME.items()}.union(PIER_KEYS)
    omitted |= {"beta"} if cases[0]["base"] in FOOTING and "beta" not in given else set()
    omitted |= {"eta"} if backbone(cases[0]) else set()
    kept = {key: value for key, value in first.items() if key not in omitted and value is not None}
    return {key: value for key, value in kept.items() if all(values.get(key) == value for values in further)}
