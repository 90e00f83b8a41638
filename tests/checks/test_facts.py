"""Facts decide, and not the words of notes and reasons, which are for people."""

import ast
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from check_samples import judged, runs
from report_samples import FIG7, FOUNDATIONS, case_entry, write_results
from studies import study_text, write_study

import rockbatch as rb
from rockbatch.checks import Rule, judge
from rockbatch.checks.suite import Suite
from rockbatch.commands.check import answered
from rockbatch.commands.summary import failed_later, warnings
from rockbatch.common.errors import InputError
from rockbatch.outcome.outcome import Failure
from rockbatch.quantities.catalogue import COLUMNS, FACTS
from rockbatch.reporting import write_report
from rockbatch.results.reading import read_saved

RULES = [
    Rule("rotation", "theta_max_over_alpha", 0.5),
    Rule("most", "theta_max_over_alpha", 1.5, overturned="value", flight="value", failed="value"),
    Rule("median", "theta_max_over_alpha", 0.3, statistic="median", overturned="unknown", failed="left out"),
    Rule("settlement", "settlement_m", 0.02, statistic="mean"),
    Rule("asce", "top_drift_m", 1.0, statistic="asce7-16"),
    Rule("overturning", "overturned", 0, statistic="count"),
]
PIER = rb.Pier(alpha=0.13, p=0.38)
SENTENCES = (
    "the peak is chaotic, a motion 1e-08 weaker overturns the pier: no error of it is claimed",
    "in free vibration after the record the pier leans further and further: yielding springs ratchet",
    "a peak of 0.3 rad by linearised kinematics, which neglect 12% of inertia", "would slide at 1.2 s", "not run", "", "",
    "impacts not settled: 3 or 4", "theta_max is mostly lean",
)  # fmt: skip


def random_peaks(peaks: pd.DataFrame, rng: np.random.Generator) -> pd.DataFrame:
    """Return the runs with facts, statuses and sentences of all kinds, which need not fit each other; a few are missing."""
    n, ended, hold = len(peaks), rng.choice([0.0, 0.1, 0.5]), rng.choice([0.0, 0.1, 0.5])
    table = peaks.assign(
        status=np.where(rng.random(n) < ended, rng.choice(["overturned", "flight", "failed"], n), "ok"),
        theta_max_over_alpha=rng.uniform(0.0, 0.7, n),
        theta_max_error=rng.choice([1e-6, np.nan], n),
        note=rng.choice(SENTENCES, n),
        reason=rng.choice(SENTENCES, n),
        failure=rng.choice(["", *Failure], n),
        **{name: pd.array((rng.random(n) < hold).astype(int), dtype="Int64") for name in FACTS},
    )
    return table[rng.random(n) < 0.95]


def shuffled(peaks: pd.DataFrame, rng: np.random.Generator) -> pd.DataFrame:
    """Return the table with the words of all notes and reasons dealt out anew, some of them cut in two."""
    words = " ".join([*peaks["note"], *peaks["reason"]]).split()
    dealt = rng.permutation([part for word in words for part in (word[:3], word[3:])])
    cells = [" ".join(some) for some in np.array_split(dealt, 2 * len(peaks))]
    return peaks.assign(note=cells[::2], reason=cells[1::2])


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Made-up results of two foundations under six records."""
    cases = [case_entry(name, {}, PIER, base) for name, base in FOUNDATIONS[:2]]
    directory = write_results(tmp_path_factory.mktemp("facts"), records=FIG7[:4], cases=cases)
    return rb.open_results(directory)


@pytest.mark.slow
@pytest.mark.parametrize("tables", [range(40), pytest.param(range(40, 300), marks=pytest.mark.thorough)])
def test_words_of_notes_and_reasons_decide_nothing_in_random_tables(results, tables):
    """Verdicts of every table; of every 50th, too, the scorecard, its colours, the answer and the warnings of a run."""
    kinds = set()
    records = {record["record"]: record["record"] for record in results.info["records"]}
    for seed in tables:
        rng = np.random.default_rng(seed)
        peaks, rules = random_peaks(results.peaks, rng), rng.permutation(RULES)[: rng.integers(1, len(RULES) + 1)]
        both = (peaks, shuffled(peaks, rng))
        before, after = (judge(rules, table, results.info["cases"], Suite(records)) for table in both)
        assert repr(before) == repr(after), seed
        kinds |= {verdict.verdict for verdict in before}
        if seed % 50 == 0:
            first, second = (
                [answered(before, replace(results, peaks=table)), answered([], replace(results, peaks=table)),
                 warnings(table, lambda run: run["case"]), failed_later(table)]
                for table in both
            )  # fmt: skip
            assert first == second, seed
    assert kinds == {"pass", "fail", "not decided", "does not apply"}


def test_words_of_notes_decide_nothing_on_the_page(results):
    """But for themselves it is the same page, with its marks, colours and sentences."""
    pages = []
    for words in ("plain", "; ".join(SENTENCES)):
        peaks = results.peaks.assign(note=[f"{words} {place}" for place in range(len(results.peaks))])
        page = write_report(results.directory, saved=replace(results, peaks=peaks)).read_text(encoding="utf-8")
        assert words in page
        pages.append(page.replace(words, "remark"))
    assert pages[0] == pages[1]


PRINTING = {
    "reporting/sections/answer.py": "the number of runs that have a remark",
}
"""Modules that print notes or reasons, and cut or count them for that."""


class Readers(ast.NodeVisitor):
    """Lines where a note or a reason is compared, searched or cut, or those of many rows are gone through."""

    CUT = (
        "split",
        "rsplit",
        "partition",
        "rpartition",
        "startswith",
        "endswith",
        "find",
        "index",
        "count",
        "contains",
        "match",
    )

    def __init__(self) -> None:
        self.lines: list[int] = []

    def visit_Compare(self, node: ast.Compare) -> None:
        if any(is_words(side) for side in (node.left, *node.comparators)):
            self.lines.append(node.lineno)
        self.generic_visit(node)

    def visit_comprehension(self, node: ast.comprehension) -> None:
        if is_words(node.iter):
            self.lines.append(node.iter.lineno)
        self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> None:
        inner = node.func.value if isinstance(node.func, ast.Attribute) else None
        if (
            isinstance(node.func, ast.Attribute)
            and node.func.attr in self.CUT
            and inner is not None
            and is_words(inner)
        ):
            self.lines.append(node.lineno)
        self.generic_visit(node)


def is_words(node: ast.expr) -> bool:
    """Return whether an expression has a note or a reason in it: ``x.note``, ``x["note"]``, ``x.texts("note")``."""
    for part in ast.walk(node):
        if isinstance(part, ast.Attribute) and part.attr in WORDS:
            return True
        if isinstance(part, ast.Subscript) and WORDS & constants(part.slice):
            return True
        if getattr(getattr(part, "func", None), "attr", "") in ("texts", "get") and any(
            WORDS & constants(argument) for argument in part.args
        ):
            return True
    return False


WORDS = {"note", "reason"}


def constants(node: ast.expr) -> set[object]:
    return {part.value for part in ast.walk(node) if isinstance(part, ast.Constant)}


def lines_that_read_words(source: str) -> list[int]:
    visitor = Readers()
    visitor.visit(ast.parse(source))
    return visitor.lines


def test_no_module_compares_searches_or_cuts_a_note_or_a_reason():
    """None but those that print them: ``in``, ``==``, ``split``, ``startswith`` and the like on a note or a reason."""
    package, found = Path(rb.__file__).parent, set()
    for path in package.rglob("*.py"):
        source = path.read_text(encoding="utf-8")
        if any(word in source for word in (".note", ".reason", '"note"', '"reason"')) and lines_that_read_words(source):
            found.add(path.relative_to(package).as_posix())
    assert found == PRINTING.keys()


@pytest.mark.parametrize(
    "line", [
        "'chaotic' in outcome.note", "runs['note'].str.contains('lean')", "outcome.reason == 'not run'",
        "[words in note for note in runs.texts('note')]", "row['reason'].startswith('left alone')",
    ]
)  # fmt: skip
def test_each_way_to_read_words_back_is_seen(line):
    assert lines_that_read_words(line) == [1]


def test_results_of_an_earlier_version_count_a_withheld_error_as_chaos():
    """The column was not written yet: a run that claims no error beside others that do is known to a factor of 2."""
    table = runs([0.1, 0.3], theta_max_error=[1e-6, None])
    assert judged(table).verdict == judged(table.drop(columns="chaotic")).verdict == "not decided"
    assert judged(table.assign(chaotic=0)).verdict == "pass"
    assert judged(table.assign(theta_max_error=np.nan)).verdict == "pass"  # a fixed step


@pytest.mark.parametrize("name", ["chaotic", "may_overturn"])
def test_a_table_without_a_fact_that_decides_is_refused(tmp_path, name):
    table = runs([0.1, 0.3], case="rigid")
    study = write_study(tmp_path, study_text())
    with pytest.raises(InputError, match=f"needs these columns once each, as rockbatch.run returned it: {name}$"):
        rb.check(table.drop(columns=name), RULES[:1], study=study)


@pytest.mark.parametrize("cell", ["2", "0.5", "yes"])
def test_a_fact_that_is_neither_0_nor_1_is_damage(tmp_path, cell):
    directory = write_results(tmp_path)
    peaks = pd.read_csv(directory / "peaks.csv", dtype=str, keep_default_na=False)
    peaks.loc[3, "chaotic"] = cell
    peaks.to_csv(directory / "peaks.csv", index=False)
    with pytest.raises(InputError, match=f'peaks.csv:5: chaotic = "{cell}": expected 0, 1 or nothing'):
        read_saved(directory)


def test_the_kinds_of_failure_are_those_that_the_columns_name():
    named = COLUMNS["failure"].words
    assert all(kind.value in named for kind in Failure)
