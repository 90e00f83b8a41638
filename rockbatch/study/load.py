"""From the study file to a checked Study."""

import os
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from rockbatch.checks.rule_choices import implausible, unmet
from rockbatch.checks.rule_files import SUITE, read_checks
from rockbatch.checks.rules import CHECK, Rule
from rockbatch.common.analyses import doors
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError, Problem
from rockbatch.common.showing import Shown, several, shown
from rockbatch.common.units import MOST, Bounds, Usual
from rockbatch.motions import MotionSet
from rockbatch.motions.pairs import TWO_COMPONENT_RULES
from rockbatch.motions.sequences import SEQUENCE
from rockbatch.pier import NO_SECTIONS, Pier, described, symmetric
from rockbatch.pier.sections import section_heights
from rockbatch.quantities.catalogue import BROUGHT, COLUMNS, DEMANDS
from rockbatch.study.both_axes import along_the_axis, with_other_axes
from rockbatch.study.cases import BASE_KEYS, CASE, read_cases
from rockbatch.study.motions import FEMA, MOTIONS, PULSE, SELECT, Motions, as_source, read_motions_table
from rockbatch.study.piers import PART, PIER, read_piers
from rockbatch.study.restraint_keys import DEVICES
from rockbatch.study.spec import LEAST_TOLERANCE, Case, MotionSpec, Numerics, Output, Reference
from rockbatch.study.tables import as_toml, changed, plain, without_lost_cases
from rockbatch.study.target import TARGET, VERTICAL_TARGET
from rockbatch.toml.kinds import Whole, boolean, choice, count, not_negative, positive, share, text, within
from rockbatch.toml.meant import names
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import CONFIRM, Clash, Key, Section

TOP = Section((), "", {
    "title": Key(text, '"Pier 4, longitudinal"', "Heading of the report and its tables; default: the file's name."),
    "notes": Key(text, '"Soil class C."', "Free text for the report. Blank lines separate paragraphs."),
}, also=names({
    "pier": "geometry structure column body", "motions": "groundmotion groundmotions records earthquakes accelerograms input",
    "case": "foundation foundations base bases support supports loadcase",
    "numerics": "analysis solver settings options integration numerical", "output": "results",
    "check": "limit limits criteria acceptance rule rules verification",
}))  # fmt: skip
_ROUNDING = f"must be {LEAST_TOLERANCE:g} or above, because rounding alone makes as much"
NUMERICS = Section(("numerics",), "How exact the results are.", {
    "tolerance": Key(within(Bounds(LEAST_TOLERANCE, MOST, why=_ROUNDING)), "1e-4",
        "Error allowed on θ_max/α. The step of each run is halved until it is met, and the error is reported.",
        usual=Usual(0.1, "of theta_max/alpha, in which 1 is the edge of overturning: 1e-6 to 1e-2 is usual")),
    "substeps": Key(count, "4",
        "Instead of a tolerance: a fixed number of steps per sample, without an estimate of the error."),
    "quiet_s": Key(not_negative, "2.0",
        "Time at rest after the record, at least; a run continues as long as anything larger may follow.",
        usual=Usual(600.0, "s: a pier that rocks comes to rest in less", 0.01)),
    **CONFIRM,
}, homes=(Numerics,), also=names({
    "tolerance": "tol rtol atol error accuracy precision maxerror", "quiet_s": "freevibration timeafter after tail rest padding",
    "substeps": "stepspersample subdivisions",
}), instead=names({
    "the step follows from tolerance; leave it out, or write substeps, the number of steps per sample": "dt timestep step deltat",
    "there is one method; leave it out": "integrator method solver scheme",
    "write --jobs behind rockbatch run; leave it out": "jobs threads cores workers",
}), clashes=(
    Clash(("tolerance", "substeps"), "tolerance and substeps are given: a fixed step has no tolerance; keep one", at="substeps"),
))  # fmt: skip
OUTPUT = Section(("output",), "What is kept beyond the table of peaks.", {
    "histories": Key(choice("worst", "all", "none"), '"all"',
        'Runs whose histories are kept: the "worst" record of each case, "all", or "none".'),
    "histories_MB": Key(positive, "50",
        'How large their file may become with "worst"; the greatest rotations are kept first.', only={"histories": ("worst",)}),
    "ledger": Key(boolean, "true", "Whether the energy ledger of every run is added to the table."),
    "forces": Key(boolean, "true",
        "Whether what designers size is added: base shear, friction, forces of the supports, gaps, impacts, accelerations."),
    "rocking": Key(boolean, "true",
        "Whether the rocking about a base that has yielded is separated from its lean in every run, which takes one more."),
    "least_normal_share": Key(share, "0.1",
        "Share of the weight that the normal force has to exceed for the friction demand to count: below it, as in a hop, "
        "shear keys carry the base shear, which is a column of its own.", only={"forces": (True,)}),
    "both_laws": Key(boolean, "true",
        "Whether the settlement of Bouc–Wen springs is found by the elastic–perfectly plastic law too, which takes two more "
        "runs or more; of others it is not a range. A check of a settlement, which takes the worse, has it found too."),
    "intensity": Key(boolean, "true",
        "Whether intensity measures of each motion are written, and which of them orders the peaks best."),
    "sa_periods_s": Key(positive, "[0.5, 1.0, 2.0]",
        "Periods of the spectral accelerations among the intensity measures.", many=True,
        only={"intensity": (True,)}),
    "sa_pairs": Key(choice(*TWO_COMPONENT_RULES), '["rotd50", "rotd100"]',
        "Spectral accelerations of both components of a station, beside those of each: their geometric mean, and the median and "
        "the greatest over all directions.", many=True, only={"intensity": (True,)}),
    "half_cycles": Key(boolean, "true",
        "Whether half_cycles.csv is written: of every run the times of impacts, the angular velocities around them and the "
        "amplitudes in between; half_cycle 0 begins with the run, such as a release, and not with an impact."),
    "sections": Key(Whole(2, "a whole number, 2 or above: foot and top of the pier are among them"), "5",
        "Number of sections of the pier, evenly from its foot to its highest point, in which shear, moment and axial force of "
        "every run are computed: `sections.csv`."),
    "sections_m": Key(not_negative, "[0.0, 7.5, 15.0]", "Heights of such sections above the pivots instead.", many=True),
    "devices_work": Key(boolean, "true",
        "Whether the work of devices is added: travel, energy and half cycles of the damper that has most, and the strain of "
        "tendons over their yield strain."),
    "least_stroke_mm": Key(positive, "20.0",
        "Stroke, from end to end, from which half cycles of dampers count.", only={"devices_work": (True,)}),
}, homes=(Output,), also=names({
    "histories": "timehistories timehistory", "ledger": "energy", "intensity": "intensitymeasures",
}), instead=names({
    "write --out FOLDER behind rockbatch run; leave it out": "path folder directory dir out file",
    "the estimates of design practice are an example now, configs/code_estimates.py; leave it out": "estimate estimates",
}), clashes=(
    Clash(("sections", "sections_m"), "sections and sections_m are given, which say the same; keep one", at="sections_m"),
))  # fmt: skip
_OF_TABLES = "|".join(rf"^{what}_[1-9][0-9]*_({'|'.join(keys)})$" for what, keys in {"part": PART, **DEVICES}.items())
"""Keys of tables in a list, by their numbers: "damper_1_f"."""

REFERENCE = Section(("reference",), (
    "A published value to print beside the results. Keys that the study varies tell the case from its siblings."
), {
    "record": Key(text, '"*LGP*"', "Names of the records, as a pattern with * and ?.", required=True),
    "case": Key(text, '"rigid"', "Name of the case.", required=True),
    "theta_max_over_alpha": Key(positive, "0.114", "The published θ_max/α.", required=True),
    "source": Key(text, '"Palmeri & Makris (2007)"', "Where it was published.", required=True),
    **{
        name: Key(key.kind, key.example, "The value that the case has, where the study varies this key.")
        for name, key in {**PIER, **BASE_KEYS}.items() if name != "confirm"
    },
}, many=True, free=_OF_TABLES)  # fmt: skip
OF_REFERENCE = ("record", "case", "theta_max_over_alpha", "source")
"""Keys of a reference itself; the others tell its case from its siblings."""

SECTIONS = (
    TOP, PIER, PART, MOTIONS, SELECT, TARGET, VERTICAL_TARGET, PULSE, FEMA, SEQUENCE, CASE, *DEVICES.values(), NUMERICS, OUTPUT,
    SUITE, CHECK, REFERENCE,
)  # fmt: skip
"""Tables that are read with the study, outer ones before inner; those of analyses are read by their own commands."""


@dataclass(frozen=True, repr=False)
class Study(Shown):
    """A study, checked, with every combination of pier, case and listed values as one :class:`Case`.

    ``path`` and ``text`` are the file and its text, ``varied`` the names of the keys that were lists, ``checks`` the
    rules that its results are held against, ``count`` what counts as one record of its suite, one of
    :data:`rockbatch.checks.rules.COUNTS`, ``check_files`` the paths and texts of the files that its [suite] names for checks.
    ``lined`` is False if the text was made of tables, so that messages give no lines.

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

    @classmethod
    @checked
    def from_toml(cls, text: str, path: str | os.PathLike[str] = "study.toml", *, motions: Motions = None) -> "Study":
        """Check a study that is the TOML ``text``, as :func:`load_study` checks a file.

        ``path`` is what messages and results call it; paths in the study are relative to its folder. No such file is needed.
        ``motions`` as for :func:`load_study`.
        """
        return _checked(TomlFile.parse(Path(path), text, SECTIONS), motions)

    @classmethod
    @checked
    def from_dict(
        cls, tables: Mapping[str, Any], path: str | os.PathLike[str] = "study.toml", *, motions: Motions = None
    ) -> "Study":
        """Check a study of the tables and keys of a study file, such as ``{"pier": {"alpha": 0.13, "p": 0.38}, "case": […]}``.

        Mistakes are reported as those of a file, by table and key. ``path`` and ``motions`` as for :meth:`from_toml`.
        """
        return _checked(TomlFile.parse(Path(path), as_toml(plain(tables)), SECTIONS, lined=False), motions)

    @checked
    def with_(self, *, motions: Motions | Mapping[str, Any] = None, **tables: Any) -> "Study":
        """Return a changed study, checked again with everything in it.

        Parameters
        ----------
        motions : path, MotionSet, Motion, list of Motion, or dict, optional
            What replaces all motions of the study, or changes of [motions].
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
            return _checked(self.file(), override)
        before = tomllib.loads(self.text)
        after = without_lost_cases(before, changed(before, changes))
        return _checked(TomlFile.parse(self.path, as_toml(after), SECTIONS, lined=False), override)

    @property
    def in_file(self) -> bool:
        """Return whether the file at ``path`` holds this study as it is, so that a command can read it again."""
        try:
            return TomlFile.text_of(self.path) == self.text
        except InputError:
            return False

    def file(self) -> TomlFile:
        """Return the text, parsed again, for the tables of analyses."""
        return TomlFile.parse(self.path, self.text, SECTIONS, lined=self.lined)

    def _facts(self) -> tuple[str, dict[str, str]]:
        """See :class:`Shown`."""
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
        What replaces all motions of the study: a file or folder, or motions, which are then selected and scaled as the study
        says; the keys of [motions] by which files are read do not matter to these.

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
    return _checked(TomlFile.read(Path(path), SECTIONS), motions)


def _checked(file: TomlFile, motions: Motions) -> Study:
    of_analyses = (name for door in doors().values() for name in door.tables)  # read by their own commands
    others = dict.fromkeys((*(section.at[0] for section in SECTIONS[1:]), *of_analyses))
    top = Table(file, (), "", file.data).read(TOP, other=others)
    motion_spec = read_motions_table(file, as_source(motions))
    numerics = _numerics(file)
    piers, varied_pier = read_piers(file)
    cases, varied_case = read_cases(file, piers)
    cases = with_other_axes(file, cases, motion_spec) if piers else cases
    varied = varied_pier + varied_case
    references = _references(file, cases, varied)
    table = file.table("output")
    output = Output(**table.read(OUTPUT)) if table else Output()
    if len(motion_spec.polarity) > 1 and not all(symmetric(case.pier, case.base.restraints) for case in cases):
        message = "devices on one side make another run of the reversed motion, not the mirror image"
        file.complain(("motions", "polarity"), f"[motions]: {message}; keep one polarity")
    if len(motion_spec.polarity) > 1 and any(pier.initial_rotation_rad for pier, _ in piers):
        message = "a pier that is let go from a rotation has another run of the reversed motion, not the mirror image"
        file.complain(
            ("motions", "polarity"),
            f"[motions]: {message}; keep one polarity, and list initial_rotation_rad = [0.05, -0.05] for the other side",
        )
    _complain_about_sections(file, [pier for pier, _ in piers], output, any(case.base.bends for case in cases))
    if not output.forces:
        _complain_without_forces(file)
    along = along_the_axis(cases)
    checks = read_checks(file, partial(_unfit, along, motion_spec, output, bool(piers)) if along else None)
    if any(DEMANDS[rule.demand].other_law for rule in checks.rules):
        output = replace(output, both_laws=True)
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
    )


def given_study(study: str | os.PathLike[str] | Study, motions: Motions = None) -> Study:
    """Return a study, a file or one that is loaded, perhaps with other ``motions``."""
    if not isinstance(study, Study):
        return load_study(study, motions=motions)
    return study if motions is None else study.with_(motions=motions)


def _unfit(
    cases: Sequence[Case], motions: MotionSpec, output: Output, known_piers: bool, rule: Rule
) -> Iterator[Problem]:
    """Return the choices of a check that the study lacks, and limits that are implausible for its piers, if these are known."""
    yield from unmet(
        rule,
        cases=list(dict.fromkeys(case.name for case in cases)),
        scales=motions.scale,
        other_law=True,  # a check that takes it brings it
        output=[key for key in BROUGHT if getattr(output, key) or not _brings(key, cases)],
        sections=_heights(cases, output) if known_piers else {rule.at_m or 0.0},
    )
    if not known_piers:
        return
    rows = [
        {
            "case": case.name,
            "base": case.base.name,
            "pier": described(case.pier),
            "parameters": case.base.parameters(case.pier),
        }
        for case in cases
    ]
    yield from implausible(rule, rows)


def _heights(cases: Sequence[Case], output: Output) -> set[float]:
    """Return the heights [m] of all sections of all cases; none without any, or of a pier that lacks some, which is noted."""
    heights = set[float]()
    for pier in {case.pier for case in cases}:
        with suppress(InputError):
            heights.update(section_heights(pier, output.requested_sections or 0))
    return heights


def _numerics(file: TomlFile) -> Numerics:
    table = file.table("numerics")
    read = table.read(NUMERICS) if table else {}
    if "substeps" in read:
        read["tolerance"] = None
    return Numerics(**read)


_OF_FORCES = {
    "friction": "nothing to hold it against; write forces = true under [output], which computes the friction demand",
    "contact_stiffness_kN_m": "is of the force of a landing; write forces = true under [output], which computes it",
}
"""Keys of a [[case]] that only forces use, and what is missing without them."""


def _complain_without_forces(file: TomlFile) -> None:
    """Note keys that only forces use in a study without, which cost a second run with every step."""
    for table in file.tables("case", title="name"):
        for key, problem in _OF_FORCES.items():
            if key in table.data:
                table.complain(f"{key}: {problem}, or leave it out", key)


def _brings(key: str, cases: Sequence[Case]) -> bool:
    """Return whether a key of [output] brings columns of these cases: those of devices need the device."""
    return any(COLUMNS[name].device in _kinds(cases) for name in BROUGHT[key])


def _kinds(cases: Sequence[Case]) -> set[str]:
    """Return the kinds of devices in these cases, and "" of columns that need none."""
    return {"", *(kind for case in cases for device in case.base.restraints for kind in device.kinds)}


def _complain_about_sections(file: TomlFile, piers: Iterable[Pier], output: Output, bends: bool) -> None:
    """Note sections that some pier does not have, or whose forces are not known, such as those of a shaft that bends."""
    if output.requested_sections is None:
        return
    wrong: dict[str, None] = {NO_SECTIONS: None} if bends else {}
    for pier in piers:
        try:
            section_heights(pier, output.requested_sections)
        except InputError as error:
            wrong |= dict.fromkeys(error.messages)
    for problem in wrong:
        file.complain(("output", "sections" if output.sections else "sections_m"), f"[output]: {problem}")


def _references(file: TomlFile, cases: Sequence[Case], varied: Iterable[str]) -> tuple[Reference, ...]:
    named = [table.data.get("name", table.data.get("base")) for table in file.tables("case", title="name")]
    names = choice(*dict.fromkeys(name for name in named if isinstance(name, str)))
    of_parts = {name: Key(not_negative, "0.0") for name in varied if name not in REFERENCE}
    keys = {**REFERENCE, "case": replace(REFERENCE["case"], kind=names), **of_parts}
    references = []
    for table in file.tables("reference", title="record"):
        read = table.read(keys)
        columns = {name: value for name, value in read.items() if name not in OF_REFERENCE}
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
