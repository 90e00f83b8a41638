"""Design checks on a folder of results, or on a table: :func:`rockbatch.check`."""

import os
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from rockbatch.checks.judging import judge
from rockbatch.checks.rule_files import Checks, given_rules, read_checks
from rockbatch.checks.rules import Rule
from rockbatch.checks.suite import Suite
from rockbatch.checks.suite_target import suite_of, suite_verdicts
from rockbatch.checks.verdicts import Verdict, as_table
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.common.showing import shown
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import Case, alpha, top, width
from rockbatch.quantities.demands import INTERACTION, OF_INTERACTION, OF_SECTIONS, SECTIONS
from rockbatch.quantities.rows import rows_of_cases, with_case
from rockbatch.results.columns import given_table
from rockbatch.results.labelled import Item
from rockbatch.results.reading import Saved, read_saved
from rockbatch.results.run_json import INFO, describe, describe_case
from rockbatch.results.sections import read_forces
from rockbatch.study import Motions, Study, given_study
from rockbatch.study.suite import ground_motions
from rockbatch.toml.reader import TomlFile

PathLike = str | os.PathLike[str]

_ROUNDING = 1e-6
"""Share of a length or a scale in a table by which it may differ from that of the study."""
_OF_SECTIONS = {"sections": (SECTIONS, OF_SECTIONS), "interaction": (INTERACTION, OF_INTERACTION)}
"""Tables of forces in sections, each with its columns, by the ``needs`` of demands."""


@checked
def check(
    results: "PathLike | Saved | pd.DataFrame",
    rules: PathLike | Iterable[Rule] | None = None,
    *,
    study: PathLike | Study | None = None,
    motions: Motions = None,
) -> "pd.DataFrame":
    """Check results against rules.

    Parameters
    ----------
    results : path, opened results or DataFrame
        A folder written by ``rockbatch run``, the results that :func:`rockbatch.open_results` returned, the table that
        :func:`rockbatch.run` returned, some of its rows, or peaks.csv as read by ``pandas.read_csv``. Records without a row
        in a table are not part of the suite, unless ``motions`` are given.
    rules : path or iterable of Rule, optional
        A TOML file with [[check]] tables, or the rules themselves; by default the study's own.
    study : path or Study, optional
        The study that produced a table; folders contain theirs.
    motions : path, MotionSet, Motion or list of Motion, optional
        The motions of a table, as :func:`rockbatch.run` takes them. By them codes' statistics know earthquakes and target
        spectrum, as those of a folder do; without them ``per_event`` is not decided.

    Returns
    -------
    DataFrame
        The rows of checks.csv, one for each case, scale and rule: see :class:`rockbatch.checks.Verdict`. For a folder whose study
        fits the suite to a target spectrum, the first rows judge the suite, and have no case.

    Raises
    ------
    InputError
        For mistakes in the rules, with line numbers, for rules that do not apply to the results, for missing columns, without any
        rule, for a table without its ``study``, for ``motions`` that lack one of its records, and for
        ``motions`` of a folder, which has its own.

    Examples
    --------
    >>> table = rb.run("pier4.toml", out="reports/pier4")
    >>> rb.check("reports/pier4")[["check", "case", "verdict"]]
          check   case verdict
    0  rotation  rigid    pass
    1  rotation   pads    pass
    """
    judged = verdicts(results, rules, study=study, motions=motions)
    return as_table(judged)


def verdicts(
    results: "PathLike | Saved | pd.DataFrame",
    rules: PathLike | Iterable[Rule] | None = None,
    *,
    study: PathLike | Study | None = None,
    motions: Motions = None,
) -> list[Verdict]:
    """Return the verdicts of :func:`check`, one for each row, those on the suite first; ``InputError`` likewise."""
    given = None if rules is None else given_rules(rules)
    of_suite: list[Verdict] = []
    in_sections: dict[str, pd.DataFrame] = {}
    if isinstance(results, Saved | str | os.PathLike):
        if motions is not None:
            raise InputError("motions: are for a table; a folder has its own")
        saved = results if isinstance(results, Saved) else read_saved(Path(results))
        own_rules, count, _ = _own_checks(saved.info["study"], judged=given is None)
        table, cases = saved.peaks, saved.info["cases"]
        for needs, (name, columns) in _OF_SECTIONS.items():
            if (path := saved.directory / name).exists():
                in_sections[needs] = read_forces(path, saved.info["varied"], columns)
        of_suite = suite_verdicts(saved.info, with_case(table)["scale"])
        suite = suite_of(saved.info)
    else:
        if study is None:
            raise InputError('check: a table alone lacks its piers; pass its study: study = "pier.toml"')
        study = given_study(study, motions)
        own_rules, count = study.checks, study.count
        table, cases = given_table(results, study.varied), [describe_case(case) for case in study.cases]
        _refuse_runs_of_others(with_case(table), cases, study.motions.scale)
        suite = Suite(
            unrecorded={pulse.name for pulse in study.motions.pulses},
            shocks={sequence.name: () for sequence in study.motions.sequences},
        )
        if motions is not None:
            info = describe(study, ground_motions(study))
            of_suite, suite = suite_verdicts(info, with_case(table)["scale"]), suite_of(info)
            _refuse_other_records(with_case(table)["record"], suite)
    judged = own_rules if given is None else given
    if not (judged or of_suite):
        raise InputError("no checks: the study has no [[check]]; add some, or pass a file of rules")
    if not judged:
        return of_suite
    # The limits of a study's own rules are compared with its piers when the study is read
    doubted = given is not None
    sections, interaction = (in_sections.get(needs) for needs in _OF_SECTIONS)
    of_cases = judge(judged, table, cases, suite, count, sections, interaction=interaction, doubted=doubted)
    return [*of_suite, *of_cases]


def _refuse_other_records(records: "pd.Series", suite: Suite) -> None:
    """Raise ``InputError`` for a record of a table that the motions of its suite lack."""
    if lacking := [record for record in records.unique() if record not in suite.stations]:
        raise InputError(
            f"motions: have no {shown(lacking[0])}, of which the table has a run: pass those that it was run with"
        )


def _refuse_runs_of_others(runs: "pd.DataFrame", cases: Sequence[Case], scales: Sequence[float]) -> None:
    """Raise ``InputError`` if a table has a run of no case or scale of the study, or of a pier of other lengths than its case."""
    of_study = np.isclose(runs["scale"].to_numpy(np.float64)[:, None], scales, rtol=_ROUNDING, atol=0.0).any(axis=1)
    if not of_study.all():
        listed = ", ".join(f"{scale:g}" for scale in scales)
        raise InputError(
            f"the table has a run at scale {runs['scale'][~of_study].iloc[0]:g}, and the study scales by {listed}: pass the "
            "study that produced it"
        )
    known = np.zeros(len(runs), dtype=bool)
    for case, places in rows_of_cases(runs, cases):
        known[places] = True
        own = Rows(runs).at(places)
        uplift = width(case) * alpha(case) * own.numbers("theta_max_over_alpha")
        for name, expected in (("drift_height_m", np.full(len(own), top(case))), ("heel_uplift_m", uplift)):
            found = own.numbers(name)
            if (other := np.abs(found - expected) > _ROUNDING * np.abs(expected)).any():
                first = int(np.flatnonzero(other)[0])
                raise InputError(
                    f"{name} = {found[first]:.6g} of {own.texts('record')[first]}, case {case['case']}, where the study's pier "
                    f"has {expected[first]:.6g}: pass the study that produced the table"
                )
    if not known.all():
        row = runs[~known].iloc[0]
        keys = dict.fromkeys(key for case in cases for key in case["columns"])
        values = (f"{key} = {row[key]}" for key in keys if row[key] == row[key])  # NaN of a case without the key
        name = ", ".join((f"case {shown(row['case'])}", *values))
        raise InputError(
            f"the table has a run of {name}, which the study does not have: pass the study that produced it"
        )


def _own_checks(study: Item, *, judged: bool) -> Checks:
    """Parse the checks in run.json's copies of a study and its file of rules; raise ``InputError`` for mistakes if ``judged``."""

    def opened(path: Path) -> TomlFile:
        for check in study.get("checks", ()):
            return TomlFile.parse(Path(check["path"]), check["text"])
        raise InputError(f"{INFO} has no copy of {path}; run the study again, or pass the file of rules")

    file = TomlFile.parse(Path(study["path"]), study["text"])
    checks = read_checks(file, opened=opened)
    if judged:
        file.finish()
    return checks
