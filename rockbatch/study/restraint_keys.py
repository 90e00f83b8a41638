"""Devices of a case: [[case.damper]], [[case.tendon]], [[case.stop]] and [[case.deck_spring]]."""

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, replace

from rockbatch.common.errors import InputError, Problem, Unusual
from rockbatch.common.units import in_other_units
from rockbatch.pier import DeckSpring, Pier, Restraint, Stop, doubt, fields_of
from rockbatch.pier.devices import BOUNDS, DAMPERS
from rockbatch.pier.plausibility import wrong_device
from rockbatch.pier.restraints import KINDS
from rockbatch.study.lists import Chosen, Grid
from rockbatch.study.piers import has_mass
from rockbatch.toml.kinds import Choice, KeyValues, choice, not_negative, number, positive, within
from rockbatch.toml.meant import names
from rockbatch.toml.reader import Table, in_table
from rockbatch.toml.section import CONFIRM, Key, Section, either

_MIDDLE = names({0.0: "centre center middle axis central"})
_PLACE = Choice(("left", "right"), '"left", "right" or an offset from the middle of the base in m', number, _MIDDLE)
_OR_DECK = Choice(
    ("left", "right", "deck"), '"left", "right", "deck" or an offset from the middle of the base in m', number, _MIDDLE
)
_ALSO_AT = names({"at": "location position place offset x eccentricity where"})
_ALSO_SPRING = _ALSO_AT | names(
    {
        "stiffness_kN_m": "k",
        "lambda": "lamda",
        "gap_mm": "clearance distance opening",
        "restitution": "cor e coefficientofrestitution",
    }
)
_ONE_EACH = names({"write a table for each": "number quantity count"})
_KINDS = names(
    {
        "viscous": "dashpot fluid fluidviscous fvd oil linearviscous nonlinearviscous viscousdamper fluidviscousdamper",
        "friction": "coulomb sliding frictional",
        "hysteretic": "steel metallic yielding brb ufp tadas bilinear elastoplastic elasticplastic",
    }
)
_FORCE, _VISCOUS = {"kind": ("friction", "hysteretic")}, {"kind": ("viscous",)}
_ON_BRACE = {"kind": ("viscous", "hysteretic")}


_OR_LAMBDA = either("stiffness_kN_m", "lambda")
_RESTITUTION = Key(
    within(BOUNDS["restitution"]),
    "0.6",
    "Restitution: speed of a mass after a blow over that before, by this device alone.",
    many=True,
)

DAMPER = Section(
    ("case", "damper"),
    "A damper between the pier and the ground. Write one for each.",
    {
        "kind": Key(
            choice(*DAMPERS, called=_KINDS),
            '"friction"',
            "What its force depends on: the direction of the motion, a yielding displacement, or the speed.",
            required=True,
        ),
        "force_kN": Key(
            positive,
            "450.0",
            "Force of a friction or hysteretic damper, if the mass is given; or give `f`.",
            many=True,
            only=_FORCE,
        ),
        "f": Key(
            within(BOUNDS["f"]),
            "0.02",
            "Force of a friction or hysteretic damper over the weight.",
            many=True,
            only=_FORCE,
        ),
        "yield_mm": Key(
            positive, "5.0", "Yield displacement of a hysteretic damper.", many=True, only={"kind": ("hysteretic",)}
        ),
        "coefficient_kN_s_m": Key(
            not_negative,
            "900.0",
            "Coefficient C of a viscous damper, in kN and m/s to the power of `exponent`; or give `nu`.",
            many=True,
            only=_VISCOUS,
        ),
        "nu": Key(within(BOUNDS["nu"]), "0.5", "Coefficient of a viscous damper as C/(M p).", many=True, only=_VISCOUS),
        "exponent": Key(
            within(BOUNDS["exponent"]), "0.5", "Exponent of the speed of a viscous damper.", many=True, only=_VISCOUS
        ),
        "brace_kN_m": Key(
            positive,
            "2.0e5",
            "Stiffness of the brace in series with the damper, if the mass is given; or give `brace`. It is rigid "
            "if neither is given.",
            many=True,
            only=_ON_BRACE,
        ),
        "brace": Key(positive, "5.0", "Stiffness of its brace as λ = k b²/(M g R0).", many=True, only=_ON_BRACE),
        "at": Key(
            _OR_DECK,
            '"left"',
            "Where it is: a pivot, an offset [m] from the middle of the base, or between the deck and its neighbours; "
            "one at each pivot if it is not given.",
        ),
        **CONFIRM,
    },
    many=True,
    single=True,
    also=_ALSO_AT
    | names(
        {
            "kind": "type",
            "exponent": "alpha velocityexponent power a",
            "brace_kN_m": "bracestiffness kb",
            "coefficient_kN_s_m": "c damping dampingcoefficient dampingconstant",
            "force_kN": "f fy yieldforce strength capacity slipforce fd",
            ("force_kN", "yield_mm"): "yield",
            "yield_mm": "dy uy deltay yielddisplacement yielddeformation",
        }
    ),
    instead=_ONE_EACH
    | names(
        {
            "write yield_mm, the force over the stiffness, or brace_kN_m of its brace": "stiffness k k0 "
            "k1 initialstiffness",
            "write coefficient_kN_s_m, or nu = C/(M p)": "zeta xi dampingratio",
            "write force_kN, friction times the normal force, or f, that force over the weight": "mu friction",
        }
    ),
    clashes=(
        either("force_kN", "f"),
        either("coefficient_kN_s_m", "nu"),
        either("brace_kN_m", "brace"),
    ),
)
TENDON = Section(
    ("case", "tendon"),
    "An unbonded tendon between the pier and the ground, which takes tension only.",
    {
        "prestress_kN": Key(
            not_negative, "5000.0", "Its prestress P0, if the mass is given; or give `psi`.", many=True
        ),
        "psi": Key(within(BOUNDS["psi"]), "0.5", "Prestress over the weight.", many=True),
        "stiffness_kN_m": Key(
            not_negative, "40000.0", "Its stiffness k_t, if the mass is given; or give `lambda`.", many=True
        ),
        "lambda": Key(not_negative, "1.0", "Stiffness as λ = k_t b²/(M g R0).", many=True),
        "yield_kN": Key(positive, "9000.0", "Force at which it yields; default: it does not yield.", many=True),
        "at": Key(
            _PLACE,
            "0.0",
            "Where it is: a pivot, or an offset [m] from the middle of the base; on the axis if it is not given.",
        ),
        **CONFIRM,
    },
    many=True,
    single=True,
    also=_ALSO_AT
    | names(
        {
            "prestress_kN": "pretension preload p0 t0 force initialforce posttension",
            "stiffness_kN_m": "k kt",
            "yield_kN": "fy strength capacity yieldforce",
        }
    ),
    instead=_ONE_EACH
    | names(
        {
            "write stiffness_kN_m, E A over the length": "area modulus e length",
            "write prestress_kN, the stress times the area": "prestressmpa stressmpa stress",
        }
    ),
    clashes=(
        either("prestress_kN", "psi"),
        _OR_LAMBDA,
    ),
)
STOP = Section(
    ("case", "stop"),
    "A stop that limits how far the base lifts: a spring that is met when its place has risen by a gap.",
    {
        "gap_mm": Key(not_negative, "100.0", "Uplift of its position at contact.", required=True, many=True),
        "stiffness_kN_m": Key(positive, "5.0e5", "Its stiffness k, if the mass is given; or give `lambda`.", many=True),
        "lambda": Key(not_negative, "20.0", "Stiffness as λ = k b²/(M g R0).", many=True),
        "restitution": _RESTITUTION,
        "at": Key(
            _PLACE,
            '"left"',
            "Where it is: a pivot, or an offset [m] from the middle of the base; one at each pivot if it is not given.",
        ),
        **CONFIRM,
    },
    many=True,
    single=True,
    homes=(Stop,),
    also=_ALSO_SPRING,
    instead=_ONE_EACH,
    clashes=(_OR_LAMBDA,),
)
DECK_SPRING = Section(
    ("case", "deck_spring"),
    "A horizontal spring between the deck and an abutment or a neighbouring span, which go with the ground; a damper there is a "
    '[[case.damper]] with `at = "deck"`.',
    {
        "stiffness_kN_m": Key(positive, "5.0e4", "Its stiffness k, if the mass is given; or give `lambda`.", many=True),
        "lambda": Key(not_negative, "0.2", "Stiffness as λ = k b²/(M g R0).", many=True),
        "gap_mm": Key(not_negative, "50.0", "Displacement of the deck at contact.", many=True),
        "restitution": _RESTITUTION,
        "side": Key(choice("both", "left", "right"), '"right"', "To which side the deck moves when it is met."),
        "height_m": Key(
            positive, "31.5", "Height above the pivots at which it acts; that of the deck if it is not given."
        ),
        **CONFIRM,
    },
    many=True,
    single=True,
    homes=(DeckSpring,),
    also=_ALSO_SPRING,
    instead=_ONE_EACH,
    clashes=(_OR_LAMBDA,),
)
DEVICES: dict[str, Section] = {"damper": DAMPER, "tendon": TENDON, "stop": STOP, "deck_spring": DECK_SPRING}
"""Tables of a case's devices, by their names."""

RESTRAINTS = tuple(DEVICES)

IN_KN = ("force_kN", "coefficient_kN_s_m", "prestress_kN", "stiffness_kN_m", "yield_kN", "brace_kN_m")
_UNMEASURED = ("kind", "at", "side", "height_m", "confirm")


def _measured_keys(section: Section, damper: str = "") -> tuple[str, ...]:
    """Return the keys of a device that have numbers; for the section of dampers, those of the kind ``damper``."""
    measured = ((name, key) for name, key in section.items() if name not in _UNMEASURED)
    return tuple(name for name, key in measured if damper in key.only.get("kind", (damper,)))


KEYS_OF = {kind: _measured_keys(DAMPER, kind) for kind in DAMPERS} | {
    device: _measured_keys(section) for device, section in DEVICES.items() if device != "damper"
}
"""Keys with numbers of a damper of each kind, and of each other device."""


FIELD_OF = {key: name for key, (name, _) in fields_of(Pier(alpha=0.2, p=1.0, mass_t=100.0)).items()}
"""The field of a device, by key."""


@dataclass(frozen=True)
class Device:
    """A device of a case as it is written: its table, and its name among the keys of the case, "damper_1"."""

    table: Table
    name: str

    @property
    def what(self) -> str:
        """Return the name of its table, a key of :data:`DEVICES`."""
        return self.name.rpartition("_")[0]

    def values(self, chosen: Chosen) -> Chosen:
        """Return the chosen values of this device, by their keys: "damper_1_f" becomes "f"."""
        prefix = f"{self.name}_"
        return {key.removeprefix(prefix): setting for key, setting in chosen.items() if key.startswith(prefix)}

    def made(self, pier: Pier, chosen: Chosen, *, judged: bool) -> Restraint | None:
        """Return the device with the chosen values; None if impossible.

        Impossible values become problems of its table, as do unusual ones if ``judged``.
        """
        values = {key: setting.value for key, setting in self.values(chosen).items()}
        arguments: KeyValues = {name: values[name] for name in ("kind", "at", "side", "height_m") if name in values}
        arguments |= {field: values[key] / unit for key, (field, unit) in fields_of(pier).items() if key in values}
        arguments["confirm"] = tuple(FIELD_OF.get(name, name) for name in sorted(self.table.confirmed))
        if values.get("kind") == "hysteretic":
            arguments.setdefault("yield_m", 0.001)  # a missing value is a problem already, and the rest can be checked
        if self.what in ("stop", "deck_spring"):  # likewise
            arguments.setdefault("gap_m", 0.0)
            arguments.setdefault("lam", 1.0)
        try:
            device = KINDS[self.what](**arguments)
        except InputError as error:
            self._complain(chosen, error.problems)
            return None
        if judged:
            self._complain(chosen, wrong_device(pier, device))
            self._complain_unless_usual(pier, chosen, device)
        return device

    def _complain(self, chosen: Chosen, problems: Iterable[Problem]) -> None:
        """Add each problem to the table at its key; one of a field that follows from a key with the value of that key."""
        values = self.values(chosen)
        keys = {FIELD_OF.get(key, key): key for key in values}
        for problem in (replace(problem, place="") for problem in problems):
            key = keys.get("lam" if problem.key == "lambda" else problem.key, "")
            if key and key != problem.key:
                text = f"{key} = {values[key].value:g} means {problem}; check the unit"
                problem = replace(problem, key=key, text=text, named=False)
            self.table.complain(problem, key or next(iter(values)))

    def _complain_unless_usual(self, pier: Pier, chosen: Chosen, device: Restraint) -> None:
        """Add to the table the first value of the device that is unusual and not confirmed, at its key; nothing if none is."""
        values = self.values(chosen)
        keys = {FIELD_OF.get(key, key): key for key in values}
        doubts = doubt(pier, device)
        if doubts is not None and doubts.name in keys:
            key = keys[doubts.name]
            written = float(values[key].value)

            def usual(other: float) -> bool:
                with suppress(InputError):
                    changed = replace(device, **{doubts.name: getattr(device, doubts.name) * other / written})
                    return doubt(pier, changed) is None
                return False

            text = doubts.meaning + in_other_units(key, written, usual)
            problem = Problem(key, written, text, confirm=key, kind=Unusual)
            self.table.complain_about(values[key], in_table(problem, f"[[case.{self.what}]]"))


def read_devices(case: Table) -> tuple[list[Device], Grid]:
    """Return the devices of a case as they are written, and all values of their keys, called "damper_1_f" for the first damper.

    :meth:`Device.made` makes one of them with one value of each key. A damper of no known kind is left out; mistakes become
    problems of the file.
    """
    devices: list[Device] = []
    grid = Grid()
    for section, keys in DEVICES.items():
        for n, table in enumerate(_tables(case, section), 1):
            grid_of_table = Grid.of(table, keys, f"{section}_{n}_")
            kind: str | None = section
            if section == "damper":
                kind = next((s.value for s in grid_of_table.settings.get(f"damper_{n}_kind", ())), None)
            if kind is not None:
                devices.append(Device(table, f"{section}_{n}"))
                _check_given(table, kind)
            for name in IN_KN:
                if name in table.data and not has_mass(table.file):
                    table.complain(f"{name}: kN are of a pier whose mass is known; write mass_t in [pier]", name)
            grid += grid_of_table
    return devices, grid


def _tables(case: Table, kind: str) -> list[Table]:
    """Return the tables of a kind of device, labelled by their number in the case; one under single brackets has none."""
    single = case.data.get(kind)
    if isinstance(single, dict):
        return [Table(case.file, (*case.key_path, kind), f"{case.label}, {kind}", single)]
    tables = case.file.tables(*case.key_path, kind, title="kind")
    return [replace(table, label=f"{case.label}, {kind} {n}") for n, table in enumerate(tables, 1)]


_NEEDED = {
    "friction": ("force_kN", "f"),
    "hysteretic": ("force_kN", "f"),
    "viscous": ("coefficient_kN_s_m", "nu"),
    "tendon": ("prestress_kN", "psi", "stiffness_kN_m", "lambda"),
    "stop": ("stiffness_kN_m", "lambda"),
    "deck_spring": ("stiffness_kN_m", "lambda"),
}


def _check_given(table: Table, kind: str) -> None:
    """Add to the table that a device lacks its force, coefficient, prestress or stiffness, or a hysteretic one yield_mm."""
    first, second, *_ = _NEEDED[kind]
    if not any(map(table.has, _NEEDED[kind])):
        example = f"write for example {first} = {DEVICES.get(kind, DAMPER)[first].example}, or"
        if kind == "tendon":
            message = "it has neither prestress nor stiffness, so it has no effect"
            table.complain(f"{message}; {example} leave the table out")
        else:
            table.complain(f"{first} is missing; {example} {second}")
    if kind == "hysteretic" and not table.has("yield_mm"):
        table.complain('yield_mm is missing; write for example yield_mm = 5.0, or kind = "friction", its limit')
