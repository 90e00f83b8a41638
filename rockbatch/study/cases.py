"""The cases of a study file, with every combination of listed values: [[case]]."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, replace
from typing import NamedTuple

from rockbatch.common.errors import Problem
from rockbatch.common.naming import alike
from rockbatch.common.showing import shown
from rockbatch.common.units import rounded_up
from rockbatch.pier import (
    WITH_EPSILON,
    WITH_EXPONENT,
    Base,
    ElasticBase,
    FootingBase,
    Pier,
    RigidBase,
    YieldingBase,
    beta_of,
    eta_of,
    least_beta,
    problems,
)
from rockbatch.pier.bases import BASES
from rockbatch.pier.bending import MOST_MODES
from rockbatch.pier.block import unlikely_mass
from rockbatch.pier.laws import meanings
from rockbatch.pier.plausibility import wrong_device
from rockbatch.pier.possible import enough_eta
from rockbatch.pier.sizes import BOUNDS as OF_PIER
from rockbatch.pier.supports import SUPPORTS
from rockbatch.pier.traits import BETA, BOUNDS, EPSILON_AND_ZETA, USUAL, WORDS, wrong_blow
from rockbatch.quantities.design import BOUND
from rockbatch.study.design_bounds import DesignBound
from rockbatch.study.footing_keys import FOOTING_KEYS, at_pivots, footing_of, on_foot
from rockbatch.study.lists import Chosen, Grid, complain_where_due, too_many
from rockbatch.study.piers import PIER, PierRead, Values, has_mass
from rockbatch.study.restraint_keys import RESTRAINTS, Device, read_devices
from rockbatch.study.spec import Case
from rockbatch.toml.kinds import KeyValues, KindError, Other, Whole, choice, positive, text, within
from rockbatch.toml.meant import names
from rockbatch.toml.reader import Table, TomlFile, in_table
from rockbatch.toml.section import CONFIRM, Clash, Key, Section

_CALLED = {
    "base": names(
        {
            "rigid": "fixed rigidbase rigidground housner rock",
            "elastic": "spring springs winkler flexible linear compliant",
            "yielding": "inelastic nonlinear plastic elastoplastic elasticplastic epp boucwen bilinear",
            "footing": "bed soil strip foot spreadfooting shallowfoundation",
        }
    ),
    "spring": names(
        {
            "epp": "bilinear elastoplastic elasticplastic elasticperfectlyplastic perfectlyplastic",
            "bouc-wen": "smooth",
        }
    ),
    "impact": names({"landing": "impulse"}),
    "kinematics": names(
        {
            "first-order": "small smallrotations linear linearised linearized 1storder",
            "finite": "large largerotations nonlinear exact full",
        }
    ),
}
_ON_SPRINGS = {"base": tuple(name for name, base in BASES.items() if base.two_springs)}
_ON_GROUND_THAT_GIVES = {"base": tuple(name for name, base in BASES.items() if base.on_springs)}
_NOT_ON_A_BED = {"base": (*_ON_SPRINGS["base"], "rigid")}
_ON_ROCK = {"base": tuple(name for name, base in BASES.items() if not base.on_springs)}
_YIELDS = {"base": tuple(name for name, base in BASES.items() if base.two_springs and base.yields)}


def _impact_rule(value: object) -> str:
    """Return the name of an impact rule of a shaft that bends. Raises :class:`KindError` for an unknown one."""
    if problem := wrong_blow(str(value)):
        raise KindError(problem, whole=True)
    return str(value)


BASE_KEYS = {
    "restitution": Key(
        within(BOUNDS["restitution"]),
        "0.9",
        "Factor on the angular velocity at an impact; default: Housner's, from the geometry.",
        many=True,
        only=_ON_ROCK,
        usual=USUAL["restitution"],
    ),
    "beta": Key(
        positive,
        "40.0",
        "Stiffness as β = ω_v/p, the vertical over the rocking frequency; or give `stiffness_kN_m`.",
        many=True,
        only=_ON_GROUND_THAT_GIVES,
        usual=USUAL["beta"],
    ),
    "stiffness_kN_m": Key(
        positive,
        "2.0e6",
        "Stiffness K of one support, if the mass is given; or give `beta`.",
        many=True,
        only=_ON_SPRINGS,
    ),
    "mass_t": Key(
        positive,
        "3000.0",
        "Mass of all that rocks, unless `[pier]` states it.",
        many=True,
        only=_ON_GROUND_THAT_GIVES,
        usual=PIER["mass_t"].usual,
    ),
    "epsilon": Key(
        within(BOUNDS["epsilon"]),
        "0.05",
        "Restitution ε of the landing pivot, from 0 (no rebound) to 1 (no loss).",
        many=True,
        only=_ON_SPRINGS | {"impact": WITH_EPSILON},
    ),
    "impact": Key(
        choice(*WORDS["impact"], called=_CALLED["impact"]),
        '"landing"',
        'What a landing does: "landing", an impulse at that pivot, by `epsilon`; or "housner", Housner\'s e on the '
        "angular velocity while the other pivot keeps its velocity, for which the supports would have to pull.",
        many=True,
        only=_ON_SPRINGS,
    ),
    "zeta": Key(
        within(BOUNDS["zeta"]),
        "0.05",
        "Damping ratio ζ of the vertical vibration, by a dashpot parallel to each spring; instead of `epsilon`.",
        many=True,
        only=_ON_SPRINGS,
    ),
    "kinematics": Key(
        choice(*WORDS["kinematics"], called=_CALLED["kinematics"]),
        '"first-order"',
        'The paper\'s equations, "first-order", or equations for rotations of any size.',
        many=True,
        only=_ON_SPRINGS,
    ),
    "eta": Key(
        within(BOUNDS["eta"]),
        "2.5",
        "Strength as η = F_y/(static force of a support), above 1; or give `yield_kN`.",
        many=True,
        only=_YIELDS,
        usual=USUAL["eta"],
    ),
    "yield_kN": Key(
        positive,
        "4.0e4",
        "Yield force F_y of one support, if the mass is given; or give `eta`.",
        many=True,
        only=_YIELDS,
    ),
    "spring": Key(
        choice(*WORDS["spring"], called=_CALLED["spring"]),
        '"bouc-wen"',
        f"Law of the supports: {meanings()}.",
        many=True,
        only=_YIELDS,
    ),
    "n": Key(
        within(BOUNDS["n"]),
        "5",
        "Bouc–Wen exponent, of hardening springs too: the larger, the sharper the corner between elastic and plastic.",
        many=True,
        only=_YIELDS | {"spring": WITH_EXPONENT},
    ),
    "flight": Key(
        choice(*WORDS["flight"]),
        '"stop"',
        'What happens when both pivots are off the ground: "guided" follows the pier, which shear keys hold sideways, until '
        'it lands, and the run goes on; "stop" ends the run there, as in the paper.',
        many=True,
        only=_NOT_ON_A_BED,
    ),
    "flight_limit_mm": Key(
        within(BOUNDS["flight_limit_mm"]),
        "20.0",
        "Height of the lower pivot in flight beyond which a run carries a note: as far as shear keys reach, say.",
        many=True,
        usual=USUAL["flight_limit_mm"],
    ),
    "friction": Key(
        within(BOUNDS["friction"]),
        "0.5",
        "Coefficient of friction of the interface, for runs with `forces = true` under `[output]`: those that would slide "
        "say so.",
        many=True,
        usual=USUAL["friction"],
    ),
    "contact_stiffness_kN_m": Key(
        within(BOUNDS["contact_stiffness_kN_m"]),
        "5.0e6",
        "Stiffness of the ground under one foot, by which runs with `forces = true` estimate the force of their hardest landing: "
        "the column `landing_force_kN`, an orientation that no check takes; it does not affect any run.",
        many=True,
        only=_ON_ROCK,
    ),
    "shaft": Key(
        choice(*WORDS["shaft"]),
        '"rigid"',
        'Whether the shaft bends: "elastic" follows its modes besides, the first of the period `flexural_period_s` of '
        '`[pier]`; on springs with `zeta` and `kinematics = "finite"`.',
        many=True,
        only=_NOT_ON_A_BED,
    ),
    "flexural_damping": Key(
        within(BOUNDS["flexural_damping"]),
        "0.05",
        "Damping ratio of the first mode, of the pier fixed at its base.",
        many=True,
        only=_NOT_ON_A_BED | {"shaft": ("elastic",)},
    ),
    "flexural_damping_kind": Key(
        choice(*WORDS["flexural_damping_kind"]),
        '"modal"',
        'Damping of the higher modes: "modal", the same ratio as of the first, or "stiffness", in proportion to their frequency.',
        many=True,
        only=_NOT_ON_A_BED | {"shaft": ("elastic",)},
    ),
    "flexural_modes": Key(
        Whole(1, f"a whole number, 1 to {MOST_MODES}", MOST_MODES),
        "4",
        "Number of modes of the shaft; default: four, or as many as its masses have. Errors include what one fewer would change.",
        many=True,
        only=_NOT_ON_A_BED | {"shaft": ("elastic",)},
    ),
    "flexural_impact": Key(
        Other('"momentum"', _impact_rule, {"enum": ["momentum"]}),
        '"momentum"',
        "What a blow keeps, the momentum of the mode: the only rule, so that the key has no effect and may be left out.",
        many=True,
        only=_ON_ROCK | {"shaft": ("elastic",)},
    ),
    "area_m2": Key(
        within(BOUNDS["area_m2"]),
        "6.0",
        "Area of one support, for the bearing stresses of the statics sheet; it does not affect any run.",
        many=True,
        only=_NOT_ON_A_BED,
    ),
    **FOOTING_KEYS,
}
"""Keys that describe a base; in a list each value is a case."""
CASE = Section(
    ("case",),
    (
        "A foundation. Write one for each foundation to compare. All keys but `name`, `base`, `other_width_m` "
        "and `confirm` may be lists: every combination is a case."
    ),
    {
        "name": Key(text, '"soft"', "Its name in tables; the base if there is only one case."),
        "base": Key(
            choice(*BASES, called=_CALLED["base"]),
            '"yielding"',
            '"rigid": Housner\'s block on ground that neither gives nor yields; "elastic": two springs without tension; '
            '"yielding": the same, and the springs yield; "footing": a foot on a bed of strips.',
            required=True,
        ),
        **BASE_KEYS,
        "other_width_m": Key(
            within(OF_PIER["width_m"]),
            "8.0",
            "Width between the pivots across the axis, at right angles to `width_m` of `[pier]`. The case is then run "
            "on both axes, each a planar model under its component of every record, and checks combine them by "
            "`both_axes`.",
            usual=PIER["width_m"].usual,
            only=_NOT_ON_A_BED,
        ),
        **CONFIRM,
    },
    many=True,
    required=True,
    homes=(YieldingBase, ElasticBase, RigidBase, FootingBase),
    also=names(
        {
            "base": "foundation support supports type kind model ground",
            "stiffness_kN_m": "k kv kz springstiffness",
            "yield_kN": "fy strength capacity yieldforce yieldstrength bearingcapacity vult qult ultimate",
            "zeta": "damping dampingratio xi",
            ("restitution", "epsilon"): "cor e r coefficientofrestitution",
            "friction": "mu mus coefficientoffriction",
            "spring": "law hysteresis material springs springlaw springtype",
            "eta": "fs factorofsafety safetyfactor",
            "n": "exponent boucwenn",
            "name": "id label title",
        }
    ),
    instead=names({("mass_t", "the weight in kN over 9.81"): "weight w"}),
    clashes=(
        Clash(
            ("beta", "stiffness_kN_m"),
            "beta and stiffness_kN_m are given, which fix the same; keep one",
            at="stiffness_kN_m",
        ),
        Clash(("eta", "yield_kN"), "eta and yield_kN are given, which fix the same; keep one", at="yield_kN"),
        Clash(("epsilon", "zeta"), EPSILON_AND_ZETA, shown=True),
        Clash(("impact", "zeta"), EPSILON_AND_ZETA, shown=True),
        Clash(
            ("mass_t",),
            "mass_t is for use with stiffness_kN_m or yield_kN; leave it out",
            lacking=("stiffness_kN_m", "yield_kN"),
        ),
    ),
)

_ANY_PIER = Pier(alpha=1.0, p=1.0, flexural_period_s=1.0)
"""Pier used if none can be read, so that keys that do not depend on it are still checked."""


class _WrittenCase(NamedTuple):
    """A [[case]] as it is written: its table, its name and base, its devices, and the values of its keys."""

    table: Table
    name: str
    base: str
    devices: list[Device]
    grid: Grid


class Cases(NamedTuple):
    """The cases of a study, the keys that are lists in any of them, and all keys that are written, by the names of cases."""

    cases: list[Case]
    varied: tuple[str, ...]
    keys: dict[str, tuple[str, ...]]


def read_cases(file: TomlFile, piers: Sequence[PierRead], bounds: Sequence[DesignBound] = ()) -> Cases:
    """Return every [[case]] on every pier, each followed by itself under the ``bounds``, with all keys that apply as columns."""
    tables = file.tables("case", title="name")
    if file.data.get("case", []) == [] and ("case",) not in file.misspelt:
        file.complain(("case",), '[[case]] is missing; write at least one, for example with base = "rigid"')
    cases = []
    varied: dict[str, None] = {}
    names: set[str] = set()
    for table in tables:
        case = _read_case(table)
        if len(tables) > 1 and not table.has("name"):
            table.complain('name is missing; of several cases each needs its own, for example name = "soft"')
        elif case.name in names:
            table.complain(f"name = {shown(case.name)}: given twice; give each case its own name", "name")
        elif other := alike(case.name, sorted(names)):
            table.complain(
                f"name = {case.name!a}: is read as the case {other!a}, from which it differs in letters or spaces that look "
                "alike; give it another name",
                "name",
            )
        names |= {case.name} - {""}
        varied |= dict.fromkeys(case.grid.varied)
        if case.base:
            cases.append(case)
    keys = {case.name: tuple(case.grid.settings) for case in cases}
    if message := too_many(max(len(piers), 1) * (1 + len(bounds)) * sum(len(case.grid) for case in cases), "cases"):
        file.complain(("case",), message)
        return Cases([], tuple(varied), keys)
    expanded: list[Case] = []
    for pier in piers or [PierRead(_ANY_PIER, {})]:
        for case in cases:
            for chosen in _without_repeats(case.grid):
                expanded += _with_bounds(case, chosen, pier, bounds)
    return Cases(expanded, tuple(varied), keys)


def _with_bounds(case: _WrittenCase, chosen: Chosen, pier: PierRead, bounds: Sequence[DesignBound]) -> Iterator[Case]:
    """Yield the case of one choice of values on a pier, and if that is sound, the same under each bound."""
    file = case.table.file
    problems_before = len(file.problems)
    nominal = _case_of(case, chosen, pier.pier, pier.values)
    yield replace(nominal, columns=nominal.columns | ({BOUND: ""} if bounds else {}))
    if not file.is_sound_since(problems_before):
        return
    for bound in bounds:
        gathered = bound.noting(file)
        table = bound.table(case.table, gathered)
        devices = [replace(device, table=bound.table(device.table, gathered)) for device in case.devices]
        changed_pier, pier_values = pier.under.get(bound.name, (pier.pier, pier.values))
        chosen_then = bound.changed(chosen, table, of_pier=False)
        changed = _case_of(case._replace(table=table, devices=devices), chosen_then, changed_pier, pier_values)
        bound.note(file, gathered)
        yield replace(changed, columns=nominal.columns | {BOUND: bound.name}, changed=changed.columns)


def _case_of(case: _WrittenCase, chosen: Chosen, pier: Pier, pier_values: Values) -> Case:
    """Return the case of one choice of values on a pier; note values that are impossible or unusual together."""
    values = {key: setting.value for key, setting in chosen.items()}
    any_pier = pier is _ANY_PIER
    if "mass_t" in values:
        pier = replace(pier, mass_t=values["mass_t"], confirm=(*pier.confirm, "mass_t"))
    pivots = pier
    if "width_m" in values:
        pier = on_foot(pier, values["width_m"])
    made = (written.made(pier, chosen, judged=not any_pier) for written in case.devices)
    devices = tuple(device for device in made if device is not None)
    devices = at_pivots(devices, pivots) if pier is not pivots else devices
    of_base = {name: values[name] for name in BASE_KEYS if name in values}
    of_base |= {"restraints": devices, "confirm": tuple(USUAL)}  # reading the keys notes unusual values
    if "zeta" in of_base:
        for name in ("epsilon", "impact"):  # the clash is noted already
            of_base.pop(name, None)
    on_bed = case.base == FootingBase.name
    base, wrong = footing_of(values, pier, devices) if on_bed else _base_of(case.base, of_base, pier)
    wrong += problems(pier, base)
    of_devices = [problem for device in devices for problem in wrong_device(pier, device)]
    for problem in wrong:
        if problem not in of_devices and not (any_pier and problem.key == "beta"):
            _complain(case.table, chosen, problem, pier, base)
    if not wrong and pier.mass_t is not None:
        _complain_unless_usual(case.table, chosen, pier)
    applying = {key: value for key, value in asdict(base).items() if value is not None} | values
    for name in ("restraints", "confirm", "flexural_impact", "vertical_over_formula"):  # columns of their own have them
        applying.pop(name, None)
    if not base.has_epsilon:
        applying.pop("epsilon", None)
    if "zeta" in applying:
        applying.pop("impact", None)
    if not base.has_exponent:
        applying.pop("n", None)
    if not base.bends:
        for key in ("shaft", "flexural_damping", "flexural_damping_kind", "flexural_modes"):
            applying.pop(key, None)
    return Case(case.name, pier, base, pier_values | applying)


def _base_of(name: str, values: KeyValues, pier: Pier) -> tuple[Base, list[Problem]]:
    """Return the base, with β and η from K [kN/m] and F_y [kN] by the mass of the pier, and the problems of β and η.

    A possible value takes the place of an impossible or missing one, so that the other keys can be checked.
    """
    arguments, wrong = dict(values), list[Problem]()
    stiffness, strength, _ = (arguments.pop(key, None) for key in ("stiffness_kN_m", "yield_kN", "mass_t"))
    kind = BASES[name]
    if stiffness and pier.mass_t:
        arguments["beta"] = beta_of(pier, stiffness)
    if strength and pier.mass_t:
        arguments["eta"] = eta_of(pier, strength)
    ratios = {"beta": (BETA, 2 * pier.least_beta, kind.on_springs), "eta": (BOUNDS["eta"], 2.0, kind.yields)}
    for ratio, (bounds, possible, applies) in ratios.items():
        if applies and (problems_of_ratio := bounds.problems(ratio, arguments.setdefault(ratio, possible))):
            wrong += problems_of_ratio
            arguments[ratio] = possible
    return kind(**arguments), wrong


def _without_repeats(all_of_them: Iterable[Chosen]) -> Iterator[Chosen]:
    """Yield the choices, each once, without n or ε where the law of the springs or the impact has none."""
    visited = set()
    for chosen in all_of_them:
        if "spring" in chosen and chosen["spring"].value not in WITH_EXPONENT:
            chosen.pop("n", None)
        if "impact" in chosen and chosen["impact"].value not in WITH_EPSILON:
            chosen.pop("epsilon", None)
        identity = tuple(chosen.items())
        if identity not in visited:
            visited.add(identity)
            yield chosen


# Mistakes that take more than one key to see


def _read_case(table: Table) -> _WrittenCase:
    """Return a [[case]]; note keys that are missing beside others or beside [pier]."""
    grid = Grid.of(table, CASE, other=RESTRAINTS)
    base, name = (next((s.value for s in grid.settings.pop(key, ())), "") for key in ("base", "name"))
    weighed = has_mass(table.file)
    if weighed and grid.settings.pop("mass_t", ()):
        value = shown(table.data["mass_t"])
        table.complain(f"mass_t = {value}: [pier] states the pier's mass already; leave it out", "mass_t")
    for ratio, absolute in (("beta", "stiffness_kN_m"), ("eta", "yield_kN")):
        if base not in BASE_KEYS[absolute].only["base"] or table.has(ratio):
            continue
        if not table.has(absolute):
            table.complain(
                f"{ratio} is missing; write for example {ratio} = {BASE_KEYS[ratio].example}, or {absolute} = "
                f"{BASE_KEYS[absolute].example} with mass_t"
            )
        elif not (weighed or table.has("mass_t")):
            example = BASE_KEYS["mass_t"].example
            table.complain(
                f"mass_t is missing beside {absolute}; write for example mass_t = {example}, here or in [pier]",
                absolute,
            )
    if table.has("area_m2") and not (weighed or table.has("mass_t")):
        table.complain(
            "area_m2: stresses are of a pier whose mass is known; write mass_t in [pier], or leave it out", "area_m2"
        )
    devices, of_devices = read_devices(table)
    return _WrittenCase(table, name or base, base, devices, grid + of_devices)


def _complain(table: Table, chosen: Chosen, problem: Problem, pier: Pier, base: Base) -> None:
    """Note a problem of pier and base at its key, or at K or F_y, from which β or η follows, with the value needed."""
    source = {"beta": "stiffness_kN_m", "eta": "yield_kN"}.get(problem.key, "")
    mass = pier.mass_t
    if source in chosen and mass is not None:
        needed = {
            "yield_kN": rounded_up(0.5 * enough_eta(pier, base) * mass * pier.gravity),
            "stiffness_kN_m": rounded_up(0.5 * (least_beta(pier, base) * pier.p) ** 2 * mass),
        }
        strength, stiffness = (f"{name} above {value:.4g}" for name, value in needed.items())
        remedies = {"eta": strength, "beta": stiffness}
        if "yield_kN" in chosen and base.beta > pier.least_beta:  # β is too low only for springs so near to yielding
            remedies["beta"] = f"{strength}, or {stiffness}"
        weighing = f"mass_t = {mass:g}" if "mass_t" in chosen else f"the {mass:g} t of [pier]"
        derived = f"{source} = {chosen[source].value:g} with {weighing}"
        unit = _other_unit(source, chosen[source].value, needed[source], pier.gravity)
        text = f"{derived} means {problem}; {unit}write {remedies[problem.key]}"
        problem = replace(problem, key=source, text=text, named=False)
    complain_where_due(table, chosen, problem)


def _other_unit(name: str, value: float, needed: float, gravity: float) -> str:
    """Return the remedy for a unit by which a stiffness or force would be enough: MN, or kN for the mass; empty for none."""
    if value * gravity > needed:
        return f"if a mass is a weight in kN, write it over {gravity:g}; else "
    return f"if it is in MN, write {name} = {1000.0 * value:g}; else " if 1000.0 * value > needed else ""


def _complain_unless_usual(table: Table, chosen: Chosen, pier: Pier) -> None:
    """Note an unusual mass, stiffness, yield force or area of a support under this pier, unless it is confirmed."""
    if "mass_t" in chosen:
        for problem in unlikely_mass(pier, table.confirmed):
            table.complain_about(chosen["mass_t"], in_table(problem))
    for name, usual in SUPPORTS.items():
        if name not in chosen or name in table.confirmed:
            continue
        for problem in usual.doubts(pier, name, float(chosen[name].value)):
            table.complain_about(chosen[name], in_table(problem))
