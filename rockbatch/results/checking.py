"""Design checks on a folder of results, or on a table: :func:`rockbatch.check`."""

import os
from collections.abc import Iterable
from pathlib import Path

from rockbatch.checks.judging import judge
from rockbatch.checks.rule_files import Checks, given_rules, read_checks
from rockbatch.checks.rules import Rule
from rockbatch.checks.suite import Suite
from rockbatch.checks.suite_target import suite_of, suite_verdicts
from rockbatch.checks.verdicts import Verdict, as_table
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.quantities.rows import with_case
from rockbatch.results.columns import given_table
from rockbatch.results.interaction import INTERACTION, read_interaction
from rockbatch.results.labelled import Item
from rockbatch.results.reading import Saved, read_saved
from rockbatch.results.run_json import INFO, describe_case
from rockbatch.results.sections import SECTIONS, read_sections
from rockbatch.study import Study, load_study
from rockbatch.toml.reader import TomlFile

PathLike = str | os.PathLike[str]

_OF_SECTIONS = {"sections": (SECTIONS, read_sections), "interaction": (INTERACTION, read_interaction)}
"""Tables of forces in sections, each with the function that reads it, by the ``needs`` of demands."""


@checked
def check(
    results: "PathLike | Saved | pd.DataFrame",
    rules: PathLike | Iterable[Rule] | None = None,
    *,
    study: PathLike | Study | None = None,
) -> "pd.DataFrame":
    """Check results against rules.

    Parameters
    ----------
    results : path, opened results or DataFrame
        A folder written by ``rockbatch run``, the results that :func:`rockbatch.open_results` returned, the table that
        :func:`rockbatch.run` returned, some of its rows, or peaks.csv as read by ``pandas.read_csv``. Records without a row
        in a table are not part of the suite.
    rules : path or iterable of Rule, optional
        A TOML file with [[check]] tables, or the rules themselves; by default the study's own.
    study : path or Study, optional
        The study that produced a table; folders contain theirs.

    Returns
    -------
    DataFrame
        The rows of checks.csv, one for each case, scale and rule: see :class:`rockbatch.checks.Verdict`. For a folder whose study
        fits the suite to a target spectrum, the first rows judge the suite, and have no case.

    Raises
    ------
    InputError
        For mistakes in the rules, with line numbers, for rules that do not apply to the results, for missing columns, without any
        rule, and for a table without its ``study``.

    Examples
    --------
    >>> table = rb.run("pier4.toml", out="reports/pier4")
    >>> rb.check("reports/pier4")[["check", "case", "verdict"]]
          check   case verdict
    0  rotation  rigid    pass
    1  rotation   pads    pass
    """
    judged = verdicts(results, rules, study=study)
    return as_table(judged)


def verdicts(
    results: "PathLike | Saved | pd.DataFrame",
    rules: PathLike | Iterable[Rule] | None = None,
    *,
    study: PathLike | Study | None = None,
) -> list[Verdict]:
    """Return the verdicts of :func:`check`, one for each row, those on the suite first; ``InputError`` likewise."""
    given = None if rules is None else given_rules(rules)
    of_suite: list[Verdict] = []
    in_sections: dict[str, pd.DataFrame] = {}
    if isinstance(results, Saved | str | os.PathLike):
        saved = results if isinstance(results, Saved) else read_saved(Path(results))
        own_rules, count, _ = _own_checks(saved.info["study"], judged=given is None)
        table, cases = saved.peaks, saved.info["cases"]
        for needs, (name, read) in _OF_SECTIONS.items():
            if (path := saved.directory / name).exists():
                in_sections[needs] = read(path, saved.info["varied"])
        of_suite = suite_verdicts(saved.info, with_case(table)["scale"])
        suite = suite_of(saved.info)
    else:
        if study is None:
            raise InputError('check: a table alone lacks its piers; pass its study: study = "pier.toml"')
        study = study if isinstance(study, Study) else load_study(study)
        own_rules, count = study.checks, study.count
        table, cases = given_table(results, study.varied), [describe_case(case) for case in study.cases]
        suite = Suite(unrecorded={pulse.name for pulse in study.motions.pulses})
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
