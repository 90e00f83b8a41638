"""The other axis of a pier: a case that gives ``other_width_m`` is followed by the case of that axis.

Both are planar models of their own; each record is run along the axis by its component there, and across it by the one at
right angles. Checks combine them (:mod:`rockbatch.checks.judging`).
"""

from collections.abc import Container, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

from rockbatch.common.errors import InputError, refuse
from rockbatch.common.showing import shown
from rockbatch.motions import MotionSet
from rockbatch.motions.suites.spectrum_target import SpectrumTarget
from rockbatch.pier import Base, Pier, Restraint, offsets, problems
from rockbatch.study.piers import with_width
from rockbatch.study.spec import Case, MotionSpec
from rockbatch.toml.reader import Table, TomlFile, in_table

KEY = "other_width_m"


def with_other_axes(file: TomlFile, cases: Sequence[Case], motions: MotionSpec) -> list[Case]:
    """Return the cases, each with ``other_width_m`` followed by its case across the axis.

    A case that cannot be run on both axes is not followed, and the reasons become problems of ``file``.
    """
    tables = file.tables("case", title="name")
    names = [table.data.get("name") for table in tables]
    both: list[Case] = []
    for case in cases:
        both.append(case)
        if KEY in case.columns:
            table = tables[names.index(case.name) if case.name in names else 0]  # a single case need not have a name
            wrong = list(_obstacles(case, motions, names))
            for problem in wrong:
                table.complain(f"{KEY}: {problem}", KEY)
            both += [] if wrong else _case_across(table, case)
    return both


def _name_across(case: Case) -> str:
    """Return the name of the case across the axis of ``case``: "soft across" for "soft"."""
    return f"{case.name} across"


def _obstacles(case: Case, motions: MotionSpec, names: Container[object]) -> Iterator[str]:
    """Yield each reason why a case cannot be run on both axes, with the remedy; ``names`` are those of all [[case]]."""
    if _name_across(case) in names:
        yield f"the case across the axis is called {shown(_name_across(case))}; give the case of that name another one"
    if "width_m" not in case.columns:
        yield "needs width_m of [pier]; write width_m and height_m, or width_m and parts, instead of another size"
    if case.base.bends:
        yield 'a shaft that bends has another period across the axis; write a case and a [pier] for each axis, or shaft = "rigid"'
    if case.pier.initial_rotation_rad or motions.still_s is not None:
        yield "a released pier rotates in one plane; leave initial_rotation_rad and still_s, or this, out"
    if len(motions.azimuths) != 1 and not isinstance(motions.override, MotionSet):
        yield (
            "pairs are turned to the axis; write axis_deg in [motions], the direction of width_m in degrees from north"
            + (", instead of every_deg" if motions.azimuths else "")
        )
    if isinstance(motions.target, SpectrumTarget) and motions.target.pairs == "apart":
        yield (
            'pairs = "apart" in [motions.target], its default, scales one component and leaves the other as recorded; write '
            'pairs = "srss" (EN 1998-2), "rotd100" (ASCE 7), "rotd50" or "geomean"'
        )


def _case_across(table: Table, case: Case) -> list[Case]:
    """Return the case across the axis of ``case`` in a list; [] if its pier or base is impossible or unusual, with problems."""
    width = float(case.columns[KEY])
    pier_table = table.file.table("pier")
    confirmed = {name.replace(KEY, "width_m") for name in table.confirmed}
    try:
        pier = with_width(
            case.columns | case.changed, width, confirmed | (pier_table.confirmed if pier_table else set())
        )
        base = across(case.pier, case.base, pier)
        refuse(problems(pier, base))
    except InputError as error:
        for problem in error.problems:
            if problem.key == "width_m":
                problem = replace(problem, key=KEY, confirm=problem.confirm and KEY)
            else:
                problem = replace(
                    problem, key=KEY, text=f"{KEY} = {width:g}: across the axis {problem}", confirm="", named=False
                )
            table.complain(in_table(problem), KEY)
        return []
    return [replace(case, name=_name_across(case), pier=pier, base=base, across_of=case.name)]


def across(pier: Pier, base: Base, other: Pier) -> Base:
    """Return the base of ``pier`` under ``other``, the same pier across its axis.

    Its springs have the stiffness and the yield force of those along the axis at the lever of the other width. Its devices stand
    in the plane of the axis, hence in the middle of the other width, two there for one at both pivots; those at the deck act
    in that plane alone, and are left out.
    """
    restraints = tuple(_in_the_middle(pier, device, other) for device in base.restraints for _ in offsets(pier, device))
    if base.on_springs:
        return replace(base, restraints=restraints, beta=base.beta * pier.p / other.p)
    return replace(base, restraints=restraints)


def _in_the_middle(pier: Pier, device: Restraint, other: Pier) -> Restraint:
    """Return a device of ``pier`` in the middle of the base of ``other``, with its stiffness and damping coefficient.

    λ, brace and ν, which are ratios to sizes of the pier, change for that.
    """
    levers = (other.half_width / pier.half_width) ** 2 * pier.size / other.size
    times = {"lam": levers, "brace": levers, "nu": pier.p / other.p}
    changes: dict[str, Any] = {name: getattr(device, name) * by for name, by in times.items() if hasattr(device, name)}
    return replace(device, **changes | {"at": 0.0})


def on_both_axes(cases: Iterable[Case]) -> bool:
    """Return whether a case is run on both axes of its pier."""
    return any(case.across_of for case in cases)


def along_the_axis(cases: Iterable[Case]) -> tuple[Case, ...]:
    """Return the cases without those across the axis of others."""
    return tuple(case for case in cases if not case.across_of)
