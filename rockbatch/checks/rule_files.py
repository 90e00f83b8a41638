"""Rules from TOML: the tables [[check]] of a study file or of a file of rules."""

import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from rockbatch.checks.capacity import whole
from rockbatch.checks.rules import AXES, BOTH_AXES, CHECK, COUNT, COUNTS, PER_EVENT, Rule
from rockbatch.common.errors import InputError, Problem
from rockbatch.common.showing import shown
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.toml.kinds import KeyValues, choice, count, text
from rockbatch.toml.meant import names
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import Key, Section

SUITE = Section(
    ("suite",),
    "Values of keys for every check that does not give its own, and a file of further checks.",
    {
        "count": Key(choice(*COUNTS), '"component"', f"{COUNT}.", default=COUNTS[0]),
        "per_event": Key(count, "4", f"{PER_EVENT}; no limit if it is not given."),
        "both_axes": Key(
            choice(*BOTH_AXES), '"srss"', f"{AXES}; demands that do not add up have the greater.", default="greater"
        ),
        "checks": Key(
            text,
            '"checks.toml"',
            "A file of checks, relative to this one, that hold beside those written here; its text is kept in run.json.",
        ),
    },
    also=names({"checks": "file rules"}),
)

TOP = Section(
    (),
    "",
    {
        "title": Key(
            text, '"Checks of a stepping pier"', "Heading of the report and its tables; default: the file's name."
        ),
        "notes": Key(text, '"Limits as agreed."', "Free text for the report. Blank lines separate paragraphs."),
    },
)


SECTIONS = (TOP, SUITE, CHECK)
"""Tables of a file of checks."""


def given_rules(rules: str | os.PathLike[str] | Iterable[Rule]) -> tuple[Rule, ...]:
    """Return rules, loaded from their file unless they are rules; ``InputError`` for anything else."""
    if isinstance(rules, str | os.PathLike):
        return load_rules(rules)
    listed = tuple(rules) if isinstance(rules, Iterable) else ()
    if isinstance(rules, Iterable) and all(isinstance(rule, Rule) for rule in listed):
        return listed
    raise InputError("rules: must be a file with [[check]] tables, or a list of Rule")


def load_rules(path: str | os.PathLike[str]) -> tuple[Rule, ...]:
    """Return the rules of the [[check]] tables of a file, and of a file that its [suite] names.

    Other tables of a study file are ignored; in a file without [pier] they are mistakes. Raises ``InputError`` with every mistake
    and its line, and for a file without checks.
    """
    file = _opened(Path(path))
    if "pier" not in file.data:
        Table(file, (), "", file.data).read(TOP, other=("check", "suite"))
    checks = read_checks(file)
    if not (file.data.get("check") or checks.file):
        file.complain((), "no checks; write at least one [[check]] with name, demand, at_most and reason")
    file.finish()
    return checks.rules


def _opened(path: Path) -> TomlFile:
    """Return a file of checks, parsed. Raises ``InputError`` if it cannot be read."""
    return TomlFile.read(path, SECTIONS)


class Checks(NamedTuple):
    """The rules of a file and of the file that its [suite] names; the way of counting records; and the second file, if any."""

    rules: tuple[Rule, ...]
    counted: str
    file: TomlFile | None


def read_checks(
    file: TomlFile,
    unmet: Callable[[Rule], Iterable[Problem]] | None = None,
    opened: Callable[[Path], TomlFile] = _opened,
) -> Checks:
    """Read [suite] and [[check]] of ``file``, and [[check]] of the file that [suite] names; mistakes are noted in ``file``.

    ``unmet`` returns problems of a rule in the study, as :func:`rockbatch.checks.rule_choices.fitted` finds them; ``opened``
    opens the file that [suite] names, or raises ``InputError``.
    """
    names: set[str] = set()
    rules, usual = _rules(file, SUITE, {}, unmet, names)
    second = None
    if (suite := file.table("suite")) and "checks" in usual:
        with suite.noting("checks", before=f"checks = {shown(usual['checks'])}: "):
            second = opened(file.path.parent / usual["checks"])
    if second is not None:
        Table(second, (), "", second.data).read(TOP, other=("check", "suite"))
        without_file = {name: key for name, key in SUITE.items() if name != "checks"}
        rules += _rules(second, without_file, usual, unmet, names)[0]
        file.adopt(second, ("suite", "checks"))
    return Checks(tuple(rules), usual.get("count", COUNTS[0]), second)


def _rules(
    file: TomlFile,
    section: Mapping[str, Key],
    usual: KeyValues,
    unmet: Callable[[Rule], Iterable[Problem]] | None,
    names: set[str],
) -> tuple[list[Rule], KeyValues]:
    """Return the rules of the sound [[check]] tables, and the ``usual`` values with those of [suite] in their place.

    ``section`` has the keys of [suite]. Mistakes become problems of ``file``, such as a name that is among ``names``, to which
    those of the tables are added. Rules with problems by ``unmet`` are among those returned.
    """
    suite = file.table("suite")
    usual = usual | (suite.read(section) if suite else {})
    rules: list[Rule] = []
    for table in file.tables("check", title="name"):
        before = len(table.file.problems)
        read = table.read(CHECK)
        name = read.get("name")
        if name in names:
            table.complain(f"name = {shown(name)}: given twice; give each check its own name", "name")
        if name is not None:
            names.add(name)
        if table.file.is_sound_since(before):
            demand = DEMANDS.get(read.get("demand", ""))
            applying = {"count"} if demand and not demand.per_case else set()
            applying |= {"both_axes"} if demand and demand.directed else set()
            applying |= {"per_event"} if STATISTICS[read.get("statistic", "max")].code else set()
            read = {name: value for name, value in usual.items() if name in applying} | read
            if "capacity" in read:
                read["capacity"] = whole(read["capacity"])
            try:
                rule = Rule(**read)
            except InputError as error:
                wrong: Iterable[Problem] = error.problems
            else:
                rules.append(rule)
                wrong = unmet(rule) if unmet else ()
            for problem in wrong:
                table.complain(problem, *([problem.key] if problem.key in table.data else []))
    return rules, usual
