"""From the study file to a checked Study."""

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from rockbatch.checks.choices import unmet
from rockbatch.checks.demands import BROUGHT
from rockbatch.checks.plausible import implausible
from rockbatch.checks.reading import CHECK, SUITE, read_checks
from rockbatch.checks.rules import Rule
from rockbatch.errors import InputError
from rockbatch.pier import described, symmetric
from rockbatch.study.cases import BASE_KEYS, CASE, Expanded, read_cases
from rockbatch.study.motions import FEMA, MOTIONS, PULSE, SOURCES, read_motions_table
from rockbatch.study.piers import PART, PIER, read_piers
from rockbatch.study.plausible import CONFIRM, TOLERANCE, complain_unless_usual, confirmed
from rockbatch.study.spec import LEAST_TOLERANCE, Case, MotionSpec, Numerics, Output, Reference, Study
from rockbatch.toml.kinds import KindError, boolean, choice, count, not_negative, number, positive, shown, text
from rockbatch.toml.reader import Key, Setting, Table, TomlFile

TOP = {
    "title": Key(text, '"Pier 4, longitudinal"'),
    "notes": Key(text, '"Soil class C."'),
}
ANALYSES = ("fragility", "spectrum", "sensitivity")  # each read by its own command
SECTIONS = ("pier", "motions", "numerics", "output", "case", "reference", "suite", "check", *ANALYSES)


def _tolerance(value: Any) -> float:
    if positive(value) < LEAST_TOLERANCE:
        raise KindError(f"{LEAST_TOLERANCE:g} or above, because rounding alone makes as much")
    return float(value)


def _share(value: Any) -> float:
    if not 0.0 < number(value) < 1.0:
        raise KindError("a number above 0 and below 1, a share of the weight")
    return float(value)


NUMERICS = {
    "tolerance": Key(_tolerance, "1e-4"),
    "substeps": Key(count, "4"),
    "quiet_s": Key(not_negative, "2.0"),
}
OUTPUT = {
    "histories": Key(choice("worst", "all", "none"), '"all"'),
    "histories_MB": Key(positive, "50"),
    "ledger": Key(boolean, "true"),
    "forces": Key(boolean, "true"),
    "rocking": Key(boolean, "true"),
    "least_normal_share": Key(_share, "0.1"),
    "both_laws": Key(boolean, "true"),
    "intensity": Key(boolean, "true"),
    "sa_periods_s": Key(positive, "[0.5, 1.0, 2.0]", many=True),
    "estimate": Key(boolean, "true"),
}
REFERENCE = {
    "record": Key(text, '"*LGP*"', required=True),
    "case": Key(text, '"rigid"', required=True),
    "theta_max_over_alpha": Key(positive, "0.114", required=True),
    "source": Key(text, '"Palmeri & Makris (2007)"', required=True),
}
SELECTING = {name: replace(key, many=False) for name, key in (PIER | BASE_KEYS).items()}
"""Keys that tell a reference's case from its siblings."""

HOMES = {
    name: home
    for home, names in (
        ("[[check]]", CHECK),  # first: the keys that it shares belong to the others
        ("[suite]", SUITE),
        ("[[pier.part]]", PART),
        ("[pier]", PIER),
        ("[motions]", MOTIONS.keys() | SOURCES),
        ("[[motions.fema_p695]]", FEMA),
        ("[[motions.pulse]]", PULSE),
        ("[numerics]", NUMERICS),
        ("[output]", OUTPUT),
        ("[[case]]", CASE.keys() | BASE_KEYS),
        ("[[reference]]", REFERENCE),
    )
    for name in names
    if name not in ("name", "case", "confirm")  # these have several, or are sections
}


def load_study(path: str | os.PathLike[str], *, motions: str | os.PathLike[str] | None = None) -> Study:
    """Read and check the study file ``path``.

    Parameters
    ----------
    path : path-like
        A TOML file; paths in it are relative to its folder.
    motions : path-like, optional
        A file or folder that replaces all motions of the study.

    Returns
    -------
    Study
        Each combination of pier, [[case]] and listed values is one case: all of the first pier's, then the
        second's; within a [[case]] the last listed key varies fastest.

    Raises
    ------
    InputError
        With every mistake in the order of the file: the line, what was found, what was expected, and what to
        write instead.

    Examples
    --------
    >>> study = rb.load_study("pier4.toml")
    >>> study.title, [case.name for case in study.cases]
    ('Pier 4', ['rigid', 'pads'])
    """
    file = TomlFile.read(Path(path))
    file.homes = HOMES
    top = Table(file, (), "", file.data).read(TOP, other=SECTIONS)
    motion_spec = read_motions_table(file, None if motions is None else Path(motions))
    numerics = _numerics(file)
    piers, varied_pier = read_piers(file)
    cases, varied_case = read_cases(file, piers)
    varied = varied_pier + varied_case
    references = _references(file, cases, varied)
    output = _output(file)
    if len(motion_spec.polarity) > 1 and not all(_symmetric(each) for each in cases):
        told = "dampers or tendons on one side make another run of the reversed motion, not the mirror image; keep one polarity"
        file.complain(("motions", "polarity"), f"[motions]: {told}")
    if not output.forces:
        _complain_about_friction(file)
    checks = read_checks(file, partial(_unfit, cases, motion_spec, output) if cases else None)
    file.finish()
    return Study(
        title=top.get("title", file.path.stem),
        notes=top.get("notes", ""),
        path=file.path,
        text=file.text,
        motions=motion_spec,
        numerics=numerics,
        cases=tuple(Case(each.name, each.pier, each.base, _pick(varied, each.values)) for each in cases),
        references=references,
        varied=varied,
        output=output,
        checks=checks.rules,
        count=checks.counted,
        check_files=() if checks.file is None else ((checks.file.path, checks.file.text),),
    )


def _symmetric(case: Expanded) -> bool:
    return symmetric(case.pier, case.base.restraints)


def given_study(study: str | os.PathLike[str] | Study, motions: str | os.PathLike[str] | None = None) -> Study:
    """A study as functions are given it: a file, which is loaded, perhaps with other ``motions``, or one that is loaded."""
    if not isinstance(study, Study):
        return load_study(study, motions=motions)
    if motions is not None:
        raise InputError(
            f"motions = {os.fspath(motions)}: the study is loaded already; write load_study(path, motions=...)"
        )
    return study


def _unfit(cases: Sequence[Expanded], motions: MotionSpec, output: Output, rule: Rule) -> Iterator[str]:
    """What a check chooses and the study does not have, and a limit that is implausible for its piers."""
    yield from unmet(
        rule,
        cases=list(dict.fromkeys(each.name for each in cases)),
        scales=motions.scale,
        polarities=motions.polarity,
        other_law=output.both_laws or not any(each.base.ratchets for each in cases),
        output=[key for key in BROUGHT if getattr(output, key)],
    )
    told = [{"case": each.name, "base": each.base.name, "pier": described(each.pier)} for each in cases]
    yield from implausible(rule, told)


def _numerics(file: TomlFile) -> Numerics:
    table = file.table("numerics")
    if table is None:
        return Numerics()
    read = table.read(NUMERICS | CONFIRM)
    believed = confirmed(table, read, NUMERICS)
    if "tolerance" in read:
        given = Setting(read["tolerance"], (*table.at, "tolerance"))
        complain_unless_usual(table, "tolerance", [given], TOLERANCE, believed)
    if "tolerance" in read and "substeps" in read:
        table.complain("tolerance and substeps are given: a fixed step has no tolerance; keep one", "substeps")
    if "substeps" in read:
        read["tolerance"] = None
    return Numerics(**read)


def _output(file: TomlFile) -> Output:
    table = file.table("output")
    if table is None:
        return Output()
    read = table.read(OUTPUT)
    if "sa_periods_s" in read:
        if not read.get("intensity"):
            table.complain("sa_periods_s: is for intensity = true; write that too, or leave it out", "sa_periods_s")
        read["sa_periods_s"] = tuple(setting.value for setting in read["sa_periods_s"])
    if "least_normal_share" in read and not read.get("forces"):
        told = "least_normal_share: is for forces = true; write that too, or leave it out"
        table.complain(told, "least_normal_share")
    return Output(**read)


def _complain_about_friction(file: TomlFile) -> None:
    """The forces that friction is held against cost a second run at every step: the study says that it wants them."""
    for table in file.tables("case", title="name"):
        if "friction" in table.data:
            table.complain(
                "friction: nothing to hold it against; write forces = true under [output], which computes the friction "
                "demand, or leave it out",
                "friction",
            )


def _references(file: TomlFile, cases: Sequence[Expanded], varied: Iterable[str]) -> tuple[Reference, ...]:
    named = [table.data.get("name", table.data.get("base")) for table in file.tables("case", title="name")]
    known = choice(*dict.fromkeys(name for name in named if isinstance(name, str)))
    of_parts = {name: Key(not_negative, "0.0") for name in varied if name not in SELECTING}
    keys = REFERENCE | {"case": replace(REFERENCE["case"], kind=known)} | SELECTING | of_parts
    references = []
    for table in file.tables("reference", title="record"):
        read = table.read(keys)
        columns = {name: value for name, value in read.items() if name not in REFERENCE}
        alike = [each.values for each in cases if each.name == read.get("case")]
        for name, value in columns.items():
            there = dict.fromkeys(values[name] for values in alike if name in values)
            if alike and value not in there:
                case = shown(read["case"])
                instead = f"write {' or '.join(map(shown, there))}, or leave it out" if there else "leave it out"
                table.complain(f"{name} = {shown(value)}: no case {case} has it; {instead}", name)
        if REFERENCE.keys() <= read.keys():
            own = {name: read[name] for name in REFERENCE}
            references.append(Reference(columns=_pick(varied, columns), **own))
    return tuple(references)


def _pick(names: Iterable[str], values: Mapping[str, float | str]) -> dict[str, float | str]:
    return {name: values[name] for name in names if name in values}
