"""What is as long as a bound is shown whole, and what is longer is not, whatever the bound."""

import pytest
from check_samples import verdict
from report_samples import write_results

from rockbatch.checks import write_verdicts
from rockbatch.reporting.finished import read
from rockbatch.reporting.overview import by_foundation, by_record
from rockbatch.reporting.sections import distribution, peaks, statics, verdicts

RECORDS, FOUNDATIONS, SCALES = 6, 5, 2
RUNS = RECORDS * FOUNDATIONS * SCALES
REMARKS, CHECKS, CASES = 3, 4, 8


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """Return results with remarks, and verdicts on other cases than theirs: 3 fail, 5 pass, each by four checks."""
    folder = tmp_path_factory.mktemp("bounds")
    notes = {("ERZ-NS", str(i)): {"note": f"remark {i}"} for i in range(1, 1 + REMARKS)}
    write_results(folder, scales=(1.0, 2.0), changes=notes)
    fates = [
        ("fail" if case < 3 and check < 1 else "pass", case, check) for case in range(CASES) for check in range(CHECKS)
    ]
    write_verdicts(folder, [verdict(f"c{case}", fate, check=f"k{check}") for fate, case, check in fates])
    return read(folder, ())


@pytest.mark.parametrize(
    ("section", "name", "n", "way"),
    [
        (by_record, "reporting.overview.MOST_ROWS", RECORDS, 1),
        (by_record, "reporting.overview.MOST_COLUMNS", SCALES, 1),
        (by_record, "reporting.overview.MOST_NAMED", FOUNDATIONS, 1),
        (by_foundation, "reporting.overview.MOST_SERIES", FOUNDATIONS, 1),
        (verdicts.scorecard, "reporting.sections.verdicts.MOST_CASES", CASES + FOUNDATIONS * SCALES, 1),
        (verdicts.scorecard, "reporting.sections.verdicts.MOST_DRAWN", CASES + FOUNDATIONS * SCALES, 1),
        (verdicts.scorecard, "reporting.sections.verdicts.MOST_COLUMNS", CHECKS, 1),
        (verdicts.section, "reporting.sections.verdicts.MOST_ROWS", CASES * CHECKS, 1),
        (verdicts.answer, "checks.answer.MOST_NAMES", FOUNDATIONS * SCALES, 1),
        (distribution.section, "reporting.sections.distribution.MOST_CURVES", FOUNDATIONS, 1),
        (distribution.section, "reporting.sections.distribution.MOST_PANELS", SCALES, 1),
        (distribution.section, "reporting.sections.distribution.LEAST_RECORDS", RECORDS, -1),
        (peaks.section, "reporting.sections.peaks.MOST_ROWS", RUNS, 1),
        (peaks.section, "reporting.sections.peaks.MOST_OPEN_REMARKS", REMARKS, 1),
        (peaks.section, "reporting.sections.peaks.MOST_REMARKS", REMARKS, 1),
        (peaks.section, "reporting.table.MOST_OPEN", RUNS, 1),
        (peaks.section, "reporting.table.LEAST_COMMON", RUNS - 1, -1),
        (statics.section, "reporting.sections.statics.MOST_CASES", FOUNDATIONS, 1),
        (statics.section, "reporting.sections.statics.ABREAST", FOUNDATIONS, 1),
    ],
)
def test_as_many_as_a_bound_are_whole_and_one_more_is_not(finished, monkeypatch, section, name, n, way):
    drawn = []
    for bound in (n, n + 50 * way, n - way):
        monkeypatch.setattr(f"rockbatch.{name}", bound)
        drawn.append(section(finished))
    assert drawn[0] == drawn[1] != drawn[2]
