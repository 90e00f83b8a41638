"""From the study file to a checked Study."""

import os
import tomllib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from rockbatch.checks.rule_choices import Available, fitted
from rockbatch.checks.rule_files import SUITE, read_checks
from rockbatch.checks.rules import CHECK, Rule
from rockbatch.common.analyses import doors
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError, Problem
from rockbatch.common.observers import parts
from rockbatch.common.showing import Shown, several, shown
from rockbatch.common.units import MOST, Bounds, Usual
from rockbatch.motions import MotionSet
from rockbatch.motions.suites.sequences import SEQUENCE
from rockbatch.pier import described, symmetric
from rockbatch.quantities.catalogue import BROUGHT, COLUMNS, DEMANDS
from rockbatch.quantities.design import BOUND
from rockbatch.study.both_axes import with_other_axes
from rockbatch.study.bound_keys import BOUNDS, read_bounds
from rockbatch.study.case_keys import BASE_KEYS, CASE, WHICH_DEVICE
from rockbatch.study.cases import read_cases
from rockbatch.study.design_bounds import DesignBound, placed
from rockbatch.study.motions import FEMA, MOTIONS, PULSE, SELECT, Motions, as_source, read_motions_table
from rockbatch.study.output import OUTPUT, Output
from rockbatch.study.piers import PART, PIER, read_piers
from rockbatch.study.restraint_keys import DEVICES
from rockbatch.study.spec import LEAST_TOLERANCE, Case, MotionSpec, Numerics, Reference
from rockbatch.study.tables import as_toml, changed, plain_table, without_lost_cases
from rockbatch.study.target_keys import TARGET, VERTICAL_TARGET
from rockbatch.toml.kinds import Points, choice, count, not_negative, positive, text, within
from rockbatch.toml.meant import names
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import CONFIRM, Clash, Key, Section

TOP = Section(
    (),
    "",
    {
        "title": Key(text, '"Pier 4, longitudinal"', "Heading of the report and its tables; default: the file's name."),
        "notes": Key(text, '"Soil class C."', "Free text for the report. Blank lines separate paragraphs."),
    },
    also=names(
        {
            "pier": "geometry structure column body",
            "motions": "groundmotion groundmotions records earthquakes accelerograms input",
            "case": "foundation foundations base bases support supports loadcase",
            "numerics": "analysis solver settings options integration numerical",
            "output": "results",
            "check": "limit limits criteria acceptance rule rules verification",
        }
    ),
    instead=names(
        {
            "write [[case.tendon]]": "cable cables strand",
            WHICH_DEVICE: "device devices restraint restraints",
        }
    ),
)
_ROUNDING = f"must be {LEAST_TOLERANCE:g} or above, because rounding alone makes as much"
NUMERICS = Section(
    ("numerics",),
    "How exact the results are.",
    {
        "tolerance": Key(
            within(Bounds(LEAST_TOLERANCE, MOST, why=_ROUNDING)),
            "1e-4",
            "Error allowed on θ_max/α. The step of each run is halved until it is met, and the error is reported.",
            usual=Usual(0.1, "of theta_max/alpha, in which 1 is the edge of overturning: 1e-6 to 1e-2 is usual"),
        ),
        "substeps": Key(
            count, "4", "Instead of a tolerance: a fixed number of steps per sample, without an estimate of the error."
        ),
        "quiet_s": Key(
            not_negative,
            "2.0",
            "Time at rest after the record, at least; a run continues as long as a larger rotation may follow.",
            usual=Usual(600.0, "s: a pier that rocks comes to rest in less", 0.01),
        ),
        **CONFIRM,
    },
    homes=(Numerics,),
    also=names(
        {
            "tolerance": "tol rtol atol error accuracy precision maxerror",
            "quiet_s": "freevibration timeafter after tail rest padding",
            "substeps": "stepspersample subdivisions",
        }
    ),
    instead=names(
        {
            "the step follows from tolerance; leave it out, or write substeps, the number of steps per sample": (
                "dt timestep step deltat dtmax maxstep"
            ),
            "there is one method; leave it out": "integrator method solver scheme maxiter iterations gamma newmark",
            "write --jobs behind rockbatch run; leave it out": "jobs threads cores workers",
        }
    ),
    clashes=(
        Clash(
            ("tolerance", "substeps"),
            "tolerance and substeps are given: a fixed step has no tolerance; keep one",
            at="substeps",
        ),
    ),
)
_OF_TABLES = "|".join(rf"^{what}_[1-9][0-9]*_({'|'.join(keys)})$" for what, keys in {"part": PART, **DEVICES}.items())
"""Keys of tables in a list, by their numbers: "damper_1_f"."""

REFERENCE = Section(
    ("reference",),
    "A published value to print beside the results. Keys that the study varies select the case.",
    {
        "record": Key(text, '"*LGP*"', "Names of the records, as a pattern with * and ?.", required=True),
        "case": Key(text, '"rigid"', "Name of the case.", required=True),
        "theta_max_over_alpha": Key(positive, "0.114", "The published θ_max/α.", required=True),
        "source": Key(text, '"Palmeri & Makris (2007)"', "Where it was published.", required=True),
        **{
            name: Key(key.kind, key.example, "The value that the case has, where the study varies this key.")
            for name, key in {**PIER, **BASE_KEYS}.items()
            if name != "confirm" and not isinstance(key.kind, Points)  # points are not varied
        },
    },
    many=True,
    free=_OF_TABLES,
)
OF_REFERENCE = ("record", "case", "theta_max_over_alpha", "source")
"""Keys of a reference itself; the others tell its case from its siblings."""

SECTIONS = (
    TOP,
    PIER,
    PART,
    MOTIONS,
    SELECT,
    TARGET,
    VERTICAL_TARGET,
    PULSE,
    FEMA,
    SEQUENCE,
    CASE,
    *DEVICES.values(),
    BOUNDS,
    NUMERICS,
    OUTPUT,
    SUITE,
    CHECK,
    REFERENCE,
)
"""Tables that are read with the study, outer ones before inner; the commands of analyses read their own."""


@dataclass(frozen=True, repr=False)
class Study(Shown):
    """A study, checked, with every combination of pier, case and listed values as one :class:`Case`.

    ``path`` and ``text`` are the file and its text, ``varied`` the names of the keys that were lists, ``checks`` the
    rules that its results are held against, ``count`` what counts as one record of its suite, one of
    :data:`rockbatch.checks.rules.COUNTS`, ``check_files`` the paths and texts of the files that its [suite] names for checks.
    ``lined`` is False if the text was made of tables, so that messages give no lines. ``bounds`` are those under which every
    case is run beside the nominal design.

    Examples
    --------
    >>> pier = rb.Study.from_dict({
    ...     "title": "Pier 4",
    ...     "pier": {"width_m": 4.0, "height_m": 30.0},
    ...     "motions": {"path": "motions/near_fault"},
    ...     "case": [{"name": "rock", "base": "rigid"}, {"name": "pads", "base": "elastic", "beta": [40, 80], "zeta": 0.05}],
    ... })
    >>> pier
    <study 'Pier 4'>
      pier      alpha 0.1326 rad, R0 15.13 m
      motions   motions/near_fault
      cases     rock, pads (2)
      varied    beta
      numerics  error of theta_max/alpha below 0.0001
    >>> higher = pier.with_(pier={"height_m": 32}, case="rock")
    >>> round(higher.cases[0].pier.alpha, 4)
    0.1244
    """

    title: str
    notes: str
    path: Path
    text: str
    motions: MotionSpec
    numerics: Numerics
    cases: tuple[Case, ...]
    references: tuple[Reference, ...]
    varied: tuple[str, ...]
    output: Output = field(default_factory=Output)
    checks: tuple[Rule, ...] = ()
    count: str = "station"
    check_files: tuple[tuple[Path, str], ...] = ()
    lined: bool = True
    bounds: tuple[DesignBound, ...] = ()

    @classmethod
    @checked
    def from_toml(cls, text: str, path: str | os.PathLike[str] = "study.toml", *, motions: Motions = None) -> "Study":
        """Return the study that is the TOML ``text``, checked as :func:`load_study` checks a file.

        ``path`` is what messages and results call it; paths in the study are relative to its folder. No such file is needed.
        ``motions`` as for :func:`load_study`.
        """
        return _checked_study(TomlFile.parse(Path(path), text, SECTIONS), motions)

    @classmethod
    @checked
    def from_dict(
        cls, tables: Mapping[str, object], path: str | os.PathLike[str] = "study.toml", *, motions: Motions = None
    ) -> "Study":
        """Return the study of the tables and keys of a file, ``{"pier": {"alpha": 0.13, "p": 0.38}, "case": […]}``, checked.

        Mistakes are raised as those of a file, by table and key. ``path`` and ``motions`` as for :meth:`from_toml`.
        """
        return _checked_study(TomlFile.parse(Path(path), as_toml(plain_table(tables)), SECTIONS, lined=False), motions)

    @checked
    def with_(self, *, motions: Motions | Mapping[str, object] = None, **tables: object) -> "Study":
        """Return a changed study, checked again with everything in it.

        Parameters
        ----------
        motions : path, MotionSet, Motion, list of Motion, or dict, optional
            Motions that replace all those of the study, or changes of [motions].
        **tables
            Changes by the names of tables and keys at the top: a dict changes a table key by key, and None takes a key, a table
            or all tables of a name away. Of tables that have names, ``case="pads"`` and ``case=["rock", "pads"]`` keep these,
            with the references and checks about them, ``case={"pads": {"beta": 60}}`` changes one, and a list of dicts
            replaces all.

        Raises
        ------
        InputError
            With every mistake in the changed study, by table and key.
        """
        changes = tables | ({"motions": motions} if isinstance(motions, Mapping) else {})
        override = self.motions.override if motions is None or isinstance(motions, Mapping) else motions
        if not changes:
            return _checked_study(self.file(), override)
        before = tomllib.loads(self.text)
        after = without_lost_cases(before, changed(before, changes))
        return _checked_study(TomlFile.parse(self.path, as_toml(after), SECTIONS, lined=False), override)

    @property
    def in_file(self) -> bool:
        """Return whether the file at ``path`` holds this text, so a command can read the study again; False if unreadable."""
        try:
            return TomlFile.text_of(self.path) == self.text
        except InputError:
            return False

    def file(self) -> TomlFile:
        """Return the study parsed again, for reading the tables of analyses."""
        return TomlFile.parse(self.path, self.text, SECTIONS, lined=self.lined)

    def _facts(self) -> tuple[str, dict[str, str]]:
        """Return the title and, by name, the facts that :class:`Shown` prints: pier, motions, cases, varied, checks, numerics."""
        piers = {f"alpha {case.pier.alpha:.4g} rad, R0 {case.pier.size:.4g} m" for case in self.cases}
        names = Counter(case.name for case in self.cases)
        spec, step = self.motions, self.numerics
        given = len(spec.override) if isinstance(spec.override, MotionSet) else 0
        counts = several(given, "motion"), several(len(spec.fema_p695), "record"), several(len(spec.pulses), "pulse")
        still = f"still ground for {spec.still_s:g} s" if spec.still_s is not None else ""
        fixed, error = f"{step.substeps} steps per sample", f"error of theta_max/alpha below {step.tolerance or 0:g}"
        return f"study {self.title!r}", {
            "pier": piers.pop() if len(piers) == 1 else f"{len(piers)} piers",
            "motions": ", ".join(filter(None, (*map(str, spec.paths), *counts, still))),
            "cases": ", ".join(name if n == 1 else f"{name} ({n})" for name, n in names.items()),
            "varied": ", ".join(self.varied),
            "checks": ", ".join(rule.name for rule in self.checks),
            "numerics": fixed if step.tolerance is None else error,
        }


@checked
def load_study(path: str | os.PathLike[str], *, motions: Motions = None) -> Study:
    """Read and check the study file ``path``.

    Parameters
    ----------
    path : path-like
        A TOML file; paths in it are relative to its folder.
    motions : path, MotionSet, Motion or list of Motion, optional
        Replacement for all motions of the study: a file or folder, or motions, which are then selected and scaled as the
        study says; the keys of [motions] about reading files do not apply to these.

    Returns
    -------
    Study
        Each combination of pier, [[case]] and listed values is one case: all of the first pier's, then the
        second's; within a [[case]] the last listed key varies fastest.

    Raises
    ------
    InputError
        With every mistake in the order of the file: the line, the value, what was expected, and what to write instead.

    Examples
    --------
    >>> study = rb.load_study("pier4.toml")
    >>> study.title, [case.name for case in study.cases]
    ('Pier 4', ['rigid', 'pads'])
    """
    return _checked_study(TomlFile.read(Path(path), SECTIONS), motions)


def _checked_study(file: TomlFile, motions: Motions) -> Study:
    """Return the study in ``file``, with ``motions`` instead of its own unless None. Raises ``InputError`` with all mistakes."""
    of_analyses = (name for door in doors().values() for name in door.tables)  # read by their own commands
    others = dict.fromkeys((*(section.at[0] for section in SECTIONS[1:]), *of_analyses))
    top = Table(file, (), "", file.data).read(TOP, other=others)
    motion_spec = read_motions_table(file, as_source(motions))
    numerics = _numerics(file)
    bounds = read_bounds(file)
    piers, varied_pier, keys_of_pier = read_piers(file, bounds)
    cases, varied_case, keys_of_cases = read_cases(file, piers, bounds)
    cases = with_other_axes(file, cases, motion_spec) if piers else cases
    varied = varied_pier + varied_case + ((BOUND,) if bounds else ())
    references = _references(file, cases, varied)
    table = file.table("output")
    output = Output.with_keys(**table.read(OUTPUT)) if table else Output()
    if len(motion_spec.polarity) > 1 and not all(symmetric(case.pier, case.base.restraints) for case in cases):
        message = "devices on one side make another run of the reversed motion, not the mirror image"
        file.complain(("motions", "polarity"), f"[motions]: {message}; keep one polarity")
    if len(motion_spec.polarity) > 1 and any(read.pier.initial_rotation_rad for read in piers):
        message = "a pier released from a rotation responds differently to the reversed motion, not as its mirror image"
        file.complain(
            ("motions", "polarity"),
            f"[motions]: {message}; keep one polarity, and list initial_rotation_rad = [0.05, -0.05] for the other side",
        )
    checks = read_checks(file, partial(_problems_of_rule, cases, motion_spec, output, bool(piers)) if cases else None)
    output = output.also({key for rule in checks.rules for key in DEMANDS[rule.demand].brings})
    _place_brought(file)
    for kind, complain in parts("study.COMPLAINS"):
        complain(file, output.of(kind), [case.pier for case in cases if piers] or [read.pier for read in piers])
    placed_bounds = placed(file, bounds, keys_of_pier, keys_of_cases)
    file.finish()
    return Study(
        title=top.get("title", file.path.stem),
        notes=top.get("notes", ""),
        path=file.path,
        text=file.text,
        motions=motion_spec,
        numerics=numerics,
        cases=tuple(case.with_columns(varied) for case in cases),
        references=references,
        varied=varied,
        output=output,
        checks=checks.rules,
        count=checks.counted,
        check_files=() if checks.file is None else ((checks.file.path, checks.file.text),),
        lined=bool(file.lines),
        bounds=placed_bounds,
    )


def given_study(study: str | os.PathLike[str] | Study, motions: Motions = None) -> Study:
    """Return ``study``, loaded if it is the path of a file, with ``motions`` instead of its own unless None."""
    if not isinstance(study, Study):
        return load_study(study, motions=motions)
    return study if motions is None else study.with_(motions=motions)


def _problems_of_rule(
    cases: Sequence[Case], motions: MotionSpec, output: Output, known_piers: bool, rule: Rule
) -> list[Problem]:
    """Return problems of a check: choices that the study lacks, and implausible limits if its piers are known."""
    available = Available(
        cases=list(dict.fromkeys(case.name_along for case in cases)),
        scales=motions.scale,
        output=[
            *DEMANDS[rule.demand].brings,
            *(key for key in BROUGHT if output.has(key) or not _adds_columns(key, cases)),
        ],
        sections=_heights(cases if known_piers else (), output, rule.at_m or 0.0),
        piers=[_as_in_run_json(case) for case in cases] if known_piers else (),
    )
    return fitted(rule, available).problems


def _place_brought(file: TomlFile) -> None:
    """Give the keys of [output] that checks bring, and that are not written, the line of the first check that does."""
    named = file.lines.get(("suite", "checks"), 0)
    lines = {key: named for demand in DEMANDS.values() for key in demand.brings} if named else {}
    for table in reversed(file.tables("check", title="name")):
        demand = DEMANDS.get(str(table.data.get("demand")))
        lines |= dict.fromkeys(demand.brings if demand else (), file.lines.get(table.key_path, 0))
    for key, line in lines.items():
        file.lines.setdefault(("output", key), line)


def _as_in_run_json(case: Case) -> dict[str, object]:
    """Return the entries of a case in run.json that a limit is compared with."""
    pier, base = case.pier, case.base
    names = {"case": case.name, "across_of": case.across_of}
    return names | {"base": base.name, "pier": described(pier), "parameters": base.parameters(pier)}


def _heights(cases: Sequence[Case], output: Output, own: float) -> dict[str, set[float]]:
    """Return the heights [m] of sections that a rule may be about, by what its demand needs, for the piers of ``cases``.

    It is that of the rule, ``own``, without cases, and where [output] asks for sections that no pier can have.
    """
    piers = {case.pier for case in cases}
    of_settings = ((needs, output.of(kind), heights) for needs, kind, heights in parts("study.HEIGHTS"))
    return {
        needs: heights(settings, piers) or ({own} if settings.requested or not piers else set())
        for needs, settings, heights in of_settings
    }


def _numerics(file: TomlFile) -> Numerics:
    """Return [numerics], or its defaults if the table is missing; a fixed number of substeps has no tolerance."""
    table = file.table("numerics")
    read = table.read(NUMERICS) if table else {}
    if "substeps" in read:
        read["tolerance"] = None
    return Numerics(**read)


def _adds_columns(key: str, cases: Sequence[Case]) -> bool:
    """Return whether a key of [output] adds a column for these cases; a column of a device needs the device."""
    return any(COLUMNS[name].device in _device_kinds(cases) for name in BROUGHT[key])


def _device_kinds(cases: Sequence[Case]) -> set[str]:
    """Return the kinds of devices in these cases, and "", the kind of columns that need no device."""
    return {"", *(kind for case in cases for device in case.base.restraints for kind in device.kinds)}


def _references(file: TomlFile, cases: Sequence[Case], varied: Iterable[str]) -> tuple[Reference, ...]:
    """Return the references that have all required keys, with their values of ``varied`` keys alone.

    A value that no case of the reference's name has becomes a problem.
    """
    named = [table.data.get("name", table.data.get("base")) for table in file.tables("case", title="name")]
    names = choice(*dict.fromkeys(name for name in named if isinstance(name, str)))
    of_parts = {name: Key(not_negative, "0.0") for name in varied if name not in (*REFERENCE, BOUND)}
    keys = {**REFERENCE, "case": replace(REFERENCE["case"], kind=names), **of_parts}
    references = []
    for table in file.tables("reference", title="record"):
        read = table.read(keys)
        columns = {name: value for name, value in read.items() if name not in OF_REFERENCE}
        columns |= {BOUND: ""} if BOUND in varied else {}  # what was published is of the nominal design
        alike = [case.columns for case in cases if case.name == read.get("case")]
        for name, value in columns.items():
            options = dict.fromkeys(values[name] for values in alike if name in values)
            if alike and value not in options:
                case = shown(read["case"])
                instead = f"write {' or '.join(map(shown, options))}, or leave it out" if options else "leave it out"
                table.complain(f"{name} = {shown(value)}: no case {case} has it; {instead}", name)
        if read.keys() >= set(OF_REFERENCE):
            fields_read = {name: read[name] for name in OF_REFERENCE}
            references.append(
                Reference(columns={name: columns[name] for name in varied if name in columns}, **fields_read)
            )
    return tuple(references)
