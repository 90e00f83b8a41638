"""Values of a study that a wrong unit explains better than the pier: refused until they are confirmed.

A table confirms its own: ``confirm = ["height_m"]`` beside the key. The ratios beta and eta have no unit and are not judged:
their limits, too, are something to study.
"""

from collections.abc import Collection, Iterable, Mapping
from typing import Any, NamedTuple

from rockbatch import pier as piers
from rockbatch.pier import MOST_ETA, Base, Pier, eta_of, static_deflection
from rockbatch.study.lists import Chosen
from rockbatch.toml.kinds import shown, text
from rockbatch.toml.reader import Key, Setting, Table

CONFIRM = {"confirm": Key(text, '["height_m"]', many=True)}


class Usual(NamedTuple):
    """The most that is usual, and a word on it."""

    most: float
    told: str


_LENGTH = Usual(400.0, "m: the highest bridge piers reach some 300 m")
_MASS = Usual(1e6, "t: the heaviest bridge piers weigh some 200 000 t")
LENGTHS = dict.fromkeys(("width_m", "height_m", "size_m", "deck_height_m", "top_m"), _LENGTH)
MASSES = dict.fromkeys(("mass_t", "deck_mass_t"), _MASS)
TOLERANCE = Usual(0.1, "of theta_max/alpha, in which 1 is the edge of overturning: 1e-6 to 1e-2 is usual")

SCALE = Usual(10.0, "times as recorded; 150 % are 1.5")
TARGETS = {
    "pga_g": Usual(5.0, "g: the strongest earthquakes had 2 to 4 g"),
    "pgv_m_s": Usual(5.0, "m/s: the strongest earthquakes had some 3 m/s"),
    "sa_g": Usual(10.0, "g: the strongest earthquakes had 5 to 8 g"),
    "ag_g": Usual(2.0, "g: codes have 0.05 to 0.6 g"),
    "sds_g": Usual(5.0, "g: codes have 0.1 to 3 g"),
    "sd1_g": Usual(5.0, "g: codes have 0.05 to 2 g"),
}

LEAST_DEFLECTION = 2e-5
"""Static deflection [m] of supports below which a wrong unit is likelier than the ground: on sound rock it is some 0.1 mm."""


def confirmed(table: Table, read: dict[str, Any], keys: Mapping[str, Key]) -> Collection[str]:
    """Takes the key ``confirm`` out of what was ``read``: the keys that are right; other names are noted."""
    names = read.pop("confirm", ())
    for setting in names:
        if setting.value not in table.data or setting.value not in keys:
            there = [shown(name) for name in table.data if name in keys]
            instead = f"write one of {', '.join(there)}" if there else "leave it out"
            table.complain_about(setting, f"confirm = {shown(setting.value)}: this table has no such key; {instead}")
    return {setting.value for setting in names}


def complain_unless_usual(
    table: Table, name: str, settings: Iterable[Setting], usual: Usual, believed: Collection[str]
) -> None:
    """Note every value that is larger than usual and not confirmed."""
    for setting in settings:
        if setting.value > usual.most and name not in believed:
            told = f"more than {usual.most:g} {usual.told}"
            table.complain_about(setting, f"{name} = {setting.value:g}: {told}; {remedy(name)}")


def complain_unless_usual_support(
    table: Table, chosen: Chosen, pier: Pier, base: Base, believed: Collection[str]
) -> None:
    """Note a stiffness and a yield force that no support has under this pier, unless they are confirmed."""
    name = "stiffness_kN_m"
    deflection = static_deflection(pier, base)
    if name in chosen and name not in believed and deflection < LEAST_DEFLECTION:
        told = f"{name} = {chosen[name].value:g}: the pier's weight presses the supports in by {1000 * deflection:.2g} mm only"
        table.complain_about(chosen[name], f"{told}, where sound rock gives some 0.1 mm; {remedy(name)}")
    name = "yield_kN"
    if name in chosen and name not in believed and (eta := eta_of(pier, chosen[name].value)) > MOST_ETA:
        told = f"{name} = {chosen[name].value:g}: {eta:.3g} times what the support carries at rest"
        table.complain_about(chosen[name], f"{told}, where 2 to 20 times is usual; {remedy(name)}")


def remedy(name: str) -> str:
    """Say what to do about a value that is not usual."""
    return f"{piers.remedy(name)} in this table"
