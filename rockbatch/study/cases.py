"""The cases of a study file, with every combination of listed values: [[case]]."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any, NamedTuple

from rockbatch.common.errors import Contradiction, Problem
from rockbatch.common.naming import alike
from rockbatch.common.showing import shown
from rockbatch.common.units import rounded_up
from rockbatch.pier import (
    OF_SHAFT,
    WITH_EPSILON,
    WITH_EXPONENT,
    WITH_POINTS,
    Base,
    FootingBase,
    Pier,
    beta_of,
    eta_of,
    least_beta,
    problems,
)
from rockbatch.pier.backbones import first_corner
from rockbatch.pier.bases import BASES
from rockbatch.pier.block import unlikely_mass
from rockbatch.pier.plausibility import wrong_device
from rockbatch.pier.possible import enough_eta
from rockbatch.pier.supports import SUPPORTS, of_backbone
from rockbatch.pier.traits import BETA, BOUNDS, ETA_OF_BACKBONE, USUAL
from rockbatch.quantities.design import BOUND
from rockbatch.study.case_keys import BASE_KEYS, CASE
from rockbatch.study.design_bounds import DesignBound
from rockbatch.study.footing_keys import at_pivots, footing_of, on_foot, unlikely_foot
from rockbatch.study.lists import Chosen, Grid, complain_where_due, too_many
from rockbatch.study.piers import PierRead, Values, has_mass
from rockbatch.study.restraint_keys import RESTRAINTS, Device, read_devices
from rockbatch.study.spec import Case
from rockbatch.toml.kinds import KeyValues
from rockbatch.toml.reader import Table, TomlFile, in_table

_ANY_PIER = Pier(alpha=1.0, p=1.0, flexural_period_s=1.0)
"""Pier used if none can be read, so that keys that do not depend on it are still checked."""


_REMEDIES = {
    "beta": "write smaller deflections, or greater forces",
    "eta": "write a greater force at its last corner, or a last slope above 0",
}
"""What to write instead of a backbone whose β or η is impossible."""


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
    """Return every combination of a pier, a [[case]] and its listed values, each followed by itself under the ``bounds``.

    Mistakes become problems of ``file``; a [[case]] of no known base is left out, and all are if they are more than
    :data:`MOST_CASES`. Columns of a case are all keys that apply to it. Without ``piers``, cases stand on a stand-in, so that
    their keys are still checked.
    """
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
    """Yield the case of one choice of values on a pier, and if that has no problem, the same under each bound."""
    file = case.table.file
    problems_before = len(file.problems)
    nominal = _case_of(case, chosen, pier.pier, pier.values)
    yield replace(nominal, columns=nominal.columns | ({BOUND: ""} if bounds else {}))
    if not file.is_sound_since(problems_before):
        return
    for bound in bounds:
        gathered = bound.without_mistakes(file)
        table = bound.table(case.table, gathered)
        devices = [replace(device, table=bound.table(device.table, gathered)) for device in case.devices]
        changed_pier, pier_values = pier.under.get(bound.name, (pier.pier, pier.values))
        chosen_then = bound.changed(chosen, table, of_pier=False)
        changed = _case_of(case._replace(table=table, devices=devices), chosen_then, changed_pier, pier_values)
        bound.note(file, gathered)
        yield replace(changed, columns=nominal.columns | {BOUND: bound.name}, changed=changed.columns)


def _case_of(case: _WrittenCase, chosen: Chosen, pier: Pier, pier_values: Values) -> Case:
    """Return the case of one choice of values on a pier, with a possible base if its own is impossible.

    Values that are impossible or unusual together become problems of the file.
    """
    values = {key: setting.value for key, setting in chosen.items()}
    any_pier = pier is _ANY_PIER
    if "mass_t" in values:
        pier = replace(pier, mass_t=values["mass_t"], confirm=(*pier.confirm, "mass_t"))
    pivots = pier
    if "width_m" in values:
        pier = on_foot(pier, values["width_m"])
        for problem in [] if any_pier or "width_m" in case.table.confirmed else unlikely_foot(pivots, pier):
            case.table.complain_about(chosen["width_m"], in_table(problem))
    made = (written.made(pier, chosen, judged=not any_pier) for written in case.devices)
    devices = tuple(device for device in made if device is not None)
    devices = at_pivots(devices, pivots) if pier is not pivots else devices
    of_base = {name: values[name] for name in BASE_KEYS if name in values}
    of_base |= {"restraints": devices, "confirm": tuple(USUAL)}  # reading the keys notes unusual values
    if "zeta" in of_base:
        for name in ("epsilon", "impact"):  # the clash is noted already
            of_base.pop(name, None)
    on_bed = case.base == FootingBase.name
    confirmed = case.table.confirmed
    base, wrong = footing_of(values, pier, devices, confirmed) if on_bed else _base_of(case.base, of_base, pier)
    wrong += problems(pier, base)
    of_devices = [problem for device in devices for problem in wrong_device(pier, device)]
    for problem in wrong:
        if problem not in of_devices and not (any_pier and problem.key == "beta"):
            _complain(case.table, chosen, problem, pier, base)
    if not wrong and pier.mass_t is not None:
        _complain_unless_usual(case.table, chosen, pier)
    applying = {key: value for key, value in asdict(base).items() if value is not None} | values
    # devices have columns of their own, the others have none
    for name in ("restraints", "confirm", "flexural_impact", "vertical_over_formula", "backbone", "backbone_mm_kN"):
        applying.pop(name, None)
    if not base.has_epsilon:
        applying.pop("epsilon", None)
    if "zeta" in applying:
        applying.pop("impact", None)
    if not base.has_exponent:
        applying.pop("n", None)
    if not base.bends:
        for key in OF_SHAFT:
            applying.pop(key, None)
    return Case(case.name, pier, base, pier_values | applying)


def _base_of(name: str, values: KeyValues, pier: Pier) -> tuple[Base, list[Problem]]:
    """Return the base, with β and η from K [kN/m] and F_y [kN] or points by the mass of the pier, and problems of these.

    A possible value takes the place of an impossible or missing one, so that the other keys can be checked.
    """
    arguments, wrong = dict(values), list[Problem]()
    stiffness, strength, _ = (arguments.pop(key, None) for key in ("stiffness_kN_m", "yield_kN", "mass_t"))
    kind, of_eta = BASES[name], BOUNDS["eta"]
    points, spring = arguments.pop("backbone_mm_kN", None), arguments.get("spring")
    if points and spring and spring not in WITH_POINTS:
        text = "has no points, and backbone_mm_kN is given; write a [[case]] of its own for it"
        wrong.append(Problem("spring", spring, text, kind=Contradiction))
    elif points and spring and pier.mass_t:
        arguments |= of_backbone(pier, points)
        of_eta = ETA_OF_BACKBONE
    elif spring in WITH_POINTS:  # points or mass are missing or wrong, which is noted already
        arguments["spring"] = "epp"
    if stiffness and pier.mass_t:
        arguments["beta"] = beta_of(pier, stiffness)
    if strength and pier.mass_t:
        arguments["eta"] = eta_of(pier, strength)
    ratios = {"beta": (BETA, 2 * pier.least_beta, kind.on_springs), "eta": (of_eta, 2.0, kind.yields)}
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
    """Return a [[case]] as it is written, its name by default its base, its base "" if unknown.

    Problems of the file: a missing strength or stiffness; one in kN without a mass; a mass given again that [pier] states; an
    area without a mass.
    """
    grid = Grid.of(table, CASE, other=RESTRAINTS)
    base, name = (next((s.value for s in grid.settings.pop(key, ())), "") for key in ("base", "name"))
    weighed = has_mass(table.file)
    if weighed and grid.settings.pop("mass_t", ()):
        value = shown(table.data["mass_t"])
        table.complain(f"mass_t = {value}: [pier] states the pier's mass already; leave it out", "mass_t")
    without_mass = not (weighed or table.has("mass_t"))
    by_points = table.has("backbone_mm_kN") or table.data.get("spring") in WITH_POINTS
    for ratio, absolute in (("beta", "stiffness_kN_m"), ("eta", "yield_kN")):
        if base not in BASE_KEYS[absolute].only["base"] or table.has(ratio) or by_points:
            continue
        if not table.has(absolute):
            table.complain(
                f"{ratio} is missing; write for example {ratio} = {BASE_KEYS[ratio].example}, or {absolute} = "
                f"{BASE_KEYS[absolute].example} with mass_t"
            )
        elif without_mass:
            _complain_of_mass(table, absolute)
    if without_mass and table.has("backbone_mm_kN"):
        _complain_of_mass(table, "backbone_mm_kN")
    if without_mass and table.has("area_m2"):
        table.complain(
            "area_m2: stresses are of a pier whose mass is known; write mass_t in [pier], or leave it out", "area_m2"
        )
    devices, of_devices = read_devices(table)
    return _WrittenCase(table, name or base, base, devices, grid + of_devices)


def _complain_of_mass(table: Table, key: str) -> None:
    """Add to the table that a key in kN has no mass beside it, here or in [pier]."""
    example = BASE_KEYS["mass_t"].example
    table.complain(f"mass_t is missing beside {key}; write for example mass_t = {example}, here or in [pier]", key)


def _complain(table: Table, chosen: Chosen, problem: Problem, pier: Pier, base: Base) -> None:
    """Add a problem of pier and base to the table, at the key by which the case gives what is wrong."""
    values = {key: setting.value for key, setting in chosen.items()}
    complain_where_due(table, chosen, as_given(values, problem, pier, base))


def as_given(values: Mapping[str, Any], problem: Problem, pier: Pier, base: Base) -> Problem:
    """Return a problem of pier and base as one of the keys in ``values`` of the case: of β or η as one of K or F_y if given.

    It then says what K or F_y would have to be.
    """
    if "backbone_mm_kN" in values and problem.key in ("beta", "eta"):
        text = f"it gives {problem}; {_REMEDIES[problem.key]}"
        return replace(problem, key="backbone_mm_kN", value=None, text=text)
    source = {"beta": "stiffness_kN_m", "eta": "yield_kN"}.get(problem.key, "")
    mass = pier.mass_t
    if source in values and mass is not None:
        needed = {
            "yield_kN": rounded_up(0.5 * enough_eta(pier, base) * mass * pier.gravity),
            "stiffness_kN_m": rounded_up(0.5 * (least_beta(pier, base) * pier.p) ** 2 * mass),
        }
        strength, stiffness = (f"{name} above {value:.4g}" for name, value in needed.items())
        remedies = {"eta": strength, "beta": stiffness}
        # β would do for springs that are further from yielding
        if "yield_kN" in values and base.beta > pier.least_beta:
            remedies["beta"] = f"{strength}, or {stiffness}"
        weighing = f"mass_t = {mass:g}" if "mass_t" in values else f"the {mass:g} t of [pier]"
        derived = f"{source} = {values[source]:g} with {weighing}"
        unit = _other_unit(source, values[source], needed[source], pier.gravity)
        text = f"{derived} means {problem}; {unit}write {remedies[problem.key]}"
        return replace(problem, key=source, text=text, named=False)
    return problem


def _other_unit(name: str, value: float, needed: float, gravity: float) -> str:
    """Return the likelier mistake by which ``value`` is below ``needed``: "if it is in MN, write …; else "; "" for none.

    The mistake looked at first is a weight in kN written as the mass.
    """
    if value * gravity > needed:
        return f"if a mass is a weight in kN, write it over {gravity:g}; else "
    return f"if it is in MN, write {name} = {1000.0 * value:g}; else " if 1000.0 * value > needed else ""


def _complain_unless_usual(table: Table, chosen: Chosen, pier: Pier) -> None:
    """Add to the table an unusual mass, stiffness, yield force or area of a support of this pier, unless it is confirmed."""
    if "mass_t" in chosen:
        for problem in unlikely_mass(pier, table.confirmed):
            table.complain_about(chosen["mass_t"], in_table(problem))
    if "backbone_mm_kN" in chosen and "backbone_mm_kN" not in table.confirmed:
        values = zip(("stiffness_kN_m", "yield_kN"), first_corner(chosen["backbone_mm_kN"].value), strict=True)
        for name, value in values:
            for problem in SUPPORTS[name].doubts(pier, "backbone_mm_kN", value):
                table.complain_about(chosen["backbone_mm_kN"], in_table(replace(problem, value=None)))
    for name, usual in SUPPORTS.items():
        if name not in chosen or name in table.confirmed:
            continue
        for problem in usual.doubts(pier, name, float(chosen[name].value)):
            table.complain_about(chosen[name], in_table(problem))
