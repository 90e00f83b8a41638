"""The verdict is in a sentence and in a table, and failures cannot be overlooked."""

import math
import re

import numpy as np
from check_samples import verdict
from report_page import Page
from report_samples import FIG7, FOUNDATIONS, case_entry, write_results

from rockbatch.checks import Verdict, write_verdicts
from rockbatch.common.figures.description import Look, Polyline, Rule
from rockbatch.pier import Pier
from rockbatch.reporting import write_report
from rockbatch.reporting.svg import Entry, key

GOVERNING = ("theta_max_over_alpha", "toe_settlement_m", "ductility")
"""Demands whose limits bound all that governs a pier on yielding springs: the settlement of the toe has the tilt in it."""


def page(directory, *verdicts: Verdict, cases=None, **results) -> Page:
    """The page of results of these cases; by default of those that the verdicts are about, as far as there are such."""
    names = cases or {one.case for one in verdicts}
    entries = [case_entry(name, {}, Pier(alpha=0.13, p=0.38), base) for name, base in FOUNDATIONS if name in names]
    write_results(directory, cases=entries, **results)
    write_verdicts(directory, verdicts)
    return Page(write_report(directory, []).read_text(encoding="utf-8"))


def card(found: Page) -> list[list[str]]:
    """The rows of the scorecard, with what stands in each cell; of the parameters in the name of a case nothing."""
    return [
        [" ".join(re.sub(r"^(\d): [^a-z]*", r"\1 ", cell).split()) for cell in row] for row in found.tables["answer"]
    ]


def test_cases_that_pass_fail_and_are_not_decided_are_named(tmp_path):
    found = page(
        tmp_path,
        verdict("1", "pass"),
        verdict("2", "fail", ratio=1.25, value=0.625, low=0.62, high=0.63),
        verdict("3", "not decided", ratio=0.99, high=0.6, remarks=("between 0.2 and 0.6",)),
        verdict("3", "pass", check="tilt"),
        verdict("1", "does not apply", check="tilt", value=math.nan, ratio=math.nan),
    )
    assert (
        "? 1 of 3 cases meets the limits, but none is set on mean settlement, residual tilt, ductility: 1: β = 40, η = 2.5."
        in found.text
    )
    assert (
        "✗ 1 of 3 cases fails: 2: β = 40, η = 3.5. Nearest to passing: 2: β = 40, η = 3.5, margin at 125 % of its limit."
        in found.text
    )
    assert (
        "? 1 of 3 cases cannot be decided: 3: β = 80, η = 2.5. margin in 3: β = 80, η = 2.5: between 0.2 and 0.6, limit 0.5."
        in found.text
    )
    assert card(found) == [
        ["Case", "margin≤ 0.5", "tilt≤ 0.5"], ["1 no limit on mean settlement, residual tilt, ductility", "0.25✓ 50 %", "–"],
        ["3 check not decided", "0.25? 99 %", "0.25✓ 50 %"], ["2 fails 1 check", "0.625✗ 125 %", "–"],
    ]  # fmt: skip


def test_a_cell_of_a_check_that_does_not_apply_is_as_empty_as_one_without_a_verdict(tmp_path):
    nothing = {"check": "tilt", "value": math.nan, "ratio": math.nan}
    write_results(tmp_path)
    drift = [verdict(name, "pass") for name in "123"]
    write_verdicts(tmp_path, [*drift, verdict("3", "pass", check="tilt"), verdict("1", "does not apply", **nothing)])
    text = write_report(tmp_path, []).read_text(encoding="utf-8")
    own = text[text.index('<table class="card">') :].split("</table>")[0]
    empty = [
        cell for cell in re.findall(r"<td.*?</td>", own, re.DOTALL) if 'data-check="tilt' in cell and ">–<" in cell
    ]
    assert len(empty) == 4  # two cases without any verdict, too
    assert len(set(empty)) == 1
    assert "does not apply" in empty[0]


FELL = {"status": "overturned", "theta_max_over_alpha": 9.0}


def test_a_case_without_a_check_is_counted_and_its_overturning_named(tmp_path):
    checked = [verdict("1", "pass", demand=demand, check=demand) for demand in GOVERNING]
    fell = {(record, "rigid"): FELL for record, _ in FIG7[:2]}
    shown = page(tmp_path, *checked, cases=("rigid", "1", "2"), changes=fell)
    assert "? 1 of 3 cases passes; 2 are not checked." in shown.text
    assert "Not checked: rigid, 2 of 6 runs overturned; 2: η = 3.5." in shown.text
    assert [row[0] for row in card(shown)[1:]] == ["1 passes 3 checks", "rigidnot checked", "2 not checked"]
    assert "✓" not in shown.text[: shown.text.index("Case")]


def test_a_station_that_could_not_be_used_takes_the_green_from_what_passes(tmp_path):
    checked = [verdict("1", "pass", demand=demand, check=demand) for demand in GOVERNING]
    lost = [{"name": "ABBAR--L", "source": "ABBAR--L.AT2", "reason": "the file is cut", "station": "RSN1633"}]
    shown = page(tmp_path, *checked, unusable=lost)
    assert "? 6 of 7 stations; RSN1633 could not be used: ABBAR--L.AT2: the file is cut." in shown.text
    assert "6 of 7 stations, 6 components" in shown.text  # below the title
    assert "? Every check passes in the only case." in shown.text
    assert 'leave_out = ["RSN1633"]' in shown.text


def test_a_station_left_out_by_name_stands_beside_the_green(tmp_path):
    checked = [verdict("1", "pass", demand=demand, check=demand) for demand in GOVERNING]
    file = {"name": "ABBAR--L", "source": "ABBAR--L.AT2", "reason": "use = false in motions.toml"}
    spectra = {"name": "x", "source": "x.txt", "reason": "no record: a spectrum"}
    shown = page(tmp_path, *checked, left_out=[spectra, file | {"station": "RSN1633", "named": True}])
    assert "✓ Every check passes in the only case." in shown.text
    assert "Left out by name: RSN1633." in shown.text
    assert [row[0] for row in shown.tables["unusable"]] == ["record", "ABBAR--L", "record", "x"]


def test_a_demand_beside_its_limit_shows_on_which_side_it_lies(tmp_path):
    shown = page(tmp_path, verdict("1", "fail", ratio=1.001), verdict("2", "pass", ratio=1.0))
    assert [row[1] for row in card(shown)[1:]] == ["0.25✓ 100 %", "0.25✗ 100.1 %"]


def test_an_infinite_demand_is_shown_as_such(tmp_path):
    shown = page(tmp_path, verdict("1", "fail", ratio=math.inf, value=math.inf, high=math.inf))
    assert card(shown)[1][1] == "∞✗ ∞"
    assert next(row for row in shown.tables["checks"] if row[1] == "1")[3:5] == ["∞", "0.2 – ∞"]


def test_a_bound_that_is_rounding_beside_its_limit_is_zero(tmp_path):
    shown = page(
        tmp_path, verdict("1", "pass", value=9.8e-14, high=9.8e-14, low=0.0), verdict("2", "pass", value=0.1, low=1e-13)
    )
    rows = {row[1][:2]: row[3:5] for row in shown.tables["checks"] if row[1][:2] in ("1:", "2:")}
    assert rows == {"1:": ["0", ""], "2:": ["0.1", "0 – 0.3"]}


def test_large_limits_and_margins_are_written_out(tmp_path):
    forces = {"unit": "kN", "value": 7800.0, "low": 7800.0, "high": 7800.0, "limit": 1e5, "margin": 92200.0}
    shown = page(tmp_path, verdict("1", "pass", **forces))
    assert any("at most 100,000 kN" in cell for row in shown.tables["checks"] for cell in row)
    assert "92,200" in next(row for row in shown.tables["checks"] if row[1] == "1")


def test_a_verdict_stands_with_its_unit_margin_and_governing_run(tmp_path):
    more = {"unit": "m", "count": "station", "records": 5, "station": "WTMC", "record": "WTMC.N28W", "polarity": "-"}
    shown = page(
        tmp_path,
        verdict("1", "pass", **more, governing=0.25),
        verdict("2", "fail", ratio=2.0, margin=-0.5, value=1.0, low=1.0, high=1.0, **more, governing=1.5),
        verdict("3", "not decided", high=math.inf, **more, governing=0.2),
    )
    rows = [[cell.replace("\u00a0", " ").strip() for cell in row] for row in shown.tables["checks"]]
    start = next(i for i, row in enumerate(rows) if "governing run" in row)
    failed, unsure, passed = ([row[i] for i in (1, 2, 3, 6, 7, 8, 9)] for row in rows[start + 1 : start + 4])
    assert rows[start][8] == "stations"
    assert failed == ["2: β = 40, η = 3.5", "✗ fail", "1", "-0.5", "m", "5", "largest: WTMC, WTMC.N28W (-), 1.5"]
    left_open = "left open by WTMC, WTMC.N28W (-), 0.2"
    assert unsure == ["3: β = 80, η = 2.5", "? not decided", "≥ 0.25", "≤ 0.25", "m", "5", left_open]
    assert passed == ["1: β = 40, η = 2.5", "✓ pass", "0.25", "0.25", "m", "5", "governs: WTMC, WTMC.N28W (-), 0.25"]


def test_each_verdict_has_its_colour_and_a_sign_with_a_name(tmp_path):
    write_results(tmp_path)
    write_verdicts(tmp_path, [verdict("1", "pass"), verdict("2", "fail"), verdict("3", "not decided")])
    text = write_report(tmp_path, []).read_text(encoding="utf-8")
    for colour, sign, name in (("pass", "✓", "passes:"), ("fail", "✗", "fails:"), ("undecided", "?", "not decided:")):
        assert f'<span class="{colour}"><span role="img" aria-label="{name}">{sign}</span>' in text
        assert re.search(rf"\.{colour}\b[^}}]*color: var\(--", text)


def test_an_event_that_no_record_may_do_reads_as_words(tmp_path):
    event = {"demand": "failed", "statistic": "max", "words": "no record has a run that is missing or not settled"}
    event |= {"check": "every run settled", "limit": 0.0, "low": 0.0, "margin": 0.0}
    shown = page(
        tmp_path,
        verdict("1", "pass", **event, value=0.0, high=0.0, ratio=0.0),
        verdict("2", "fail", **event, value=1.0, high=1.0, ratio=math.inf),
    )
    assert [row[1] for row in card(shown)[1:]] == ["none✓", "some✗"]
    assert ("class", "bar") not in shown.attributes
    assert "no record has a run that is missing or not settled" in shown.text
    assert not re.search(r"at most 0(?![.\d])", shown.text)  # but of an error


def test_the_legend_says_of_which_statistic_a_check_is_but_not_of_a_ban(tmp_path):
    ban = {"check": "stands", "demand": "overturned", "statistic": "max", "limit": 0.0, "value": 0.0, "high": 0.0}
    shown = page(
        tmp_path, verdict("1", "pass"), verdict("1", "pass", check="tilt"), verdict("1", "pass", **ban, ratio=0.0)
    )
    assert "Mean over records (margin, tilt). The mark on a bar is the limit." in shown.text


def test_the_six_cases_nearest_to_passing_stand_open_and_others_are_folded(tmp_path):
    some = [verdict(f"c{i}", "fail", ratio=1.0 + i / 10, check="drift") for i in range(1, 41)]
    write_results(tmp_path)
    write_verdicts(tmp_path, [*some, *(verdict(f"c{i}", "pass") for i in range(1, 6))])
    text = write_report(tmp_path, []).read_text(encoding="utf-8")
    own = text[text.index('<table class="card">') :].split("</table>")[0]
    rows = re.findall(r'<tr( class="folded")?><th scope="row">(c\d+|rig|\d:)', own)
    assert [name for folded, name in rows if not folded] == [f"c{i}" for i in range(1, 7)]
    assert [name for folded, name in rows if folded] == [
        *(f"c{i}" for i in range(7, 41)), "rig", "1:", "2:", "3:", "4:",
    ]  # fmt: skip
    assert "6 of 45 cases, the best first.<" in text  # the five of the study, which have no verdict, too
    assert 'data-button="All 45 cases"' in text
    assert "Every verdict with its numbers, the worst first (45)" in text


def test_of_very_many_cases_a_page_has_the_best_and_the_worst_verdicts_and_says_so(tmp_path):
    fates = [verdict(f"c{i}", "fail", ratio=1.0 + i / 10) for i in range(1, 1101)]
    shown = page(tmp_path, *fates)
    assert [row[0].removesuffix("fails 1 check") for row in card(shown)[1:]] == [f"c{i}" for i in range(1, 201)]
    assert "6 of 1,100 cases, the best first. All are in checks.csv." in shown.text
    assert ("data-button", "The best 200 cases") in shown.attributes
    assert "Verdicts with their numbers, the worst first (1,100)" in shown.text
    assert "The worst 1,000 of 1,100 rows are shown.In each of these rows: verdict ✗ fail;" in shown.text
    assert [row[1] for row in shown.tables["checks"][-1000:]] == [f"c{i}" for i in range(1100, 100, -1)]


def test_failures_come_first_and_passes_beyond_the_seventh_are_counted(tmp_path):
    passing = [verdict("1", "pass", check=f"c{i}", ratio=i / 20) for i in range(10)]
    failing = [verdict("1", "fail", check=f"f{i}", ratio=1.5 + i) for i in range(2)]
    head, row = card(page(tmp_path, *passing, *failing))
    assert [name.split("≤")[0] for name in head] == ["Case", "f1", "f0", "c9", "c8", "c7", "c6", "c5", ""]
    assert row[-1] == "✓ 5 more"
    head, row = card(page(tmp_path, *(verdict("1", "fail", check=f"f{i}", ratio=2.0) for i in range(9))))
    assert len(row) == 1 + 9


def test_the_bar_of_a_cell_is_half_at_the_limit_and_full_at_twice_it(tmp_path):
    write_results(tmp_path)
    ratios = (0.5, 1.0, 1.16, 2.0, 5.46, math.inf)  # cases with larger ones stand further below
    fates = [verdict(f"c{r}", "fail" if r > 1 else "pass", ratio=r, value=0.5 * r) for r in ratios]
    write_verdicts(tmp_path, fates)
    text = write_report(tmp_path, []).read_text(encoding="utf-8")
    assert re.findall(r'class="bar" style="--share:(\d+)%"', text) == ["25", "50", "58", "100", "100", "100"]
    assert re.search(r"\.bar::after \{[^}]*left: 50%", text)


def test_beside_checks_the_greatest_responses_say_of_which_runs_they_are(tmp_path):
    fell = {(FIG7[0][0], "1"): FELL}
    shown = page(tmp_path, verdict("1", "pass"), verdict("2", "fail", ratio=1.2), changes=fell)
    assert "Largest value over 11 of 12 runs that end standing; hover for the record." in shown.text


def test_small_limits_stand_in_millimetres_with_the_distinguishing_digits(tmp_path):
    """Three digits, and more where they would make a demand look like its limit."""
    more = {"unit": "m", "limit": 0.05, "check": "settlement", "demand": "settlement_m"}
    shown = card(page(tmp_path, verdict("1", "pass", **more, value=0.0123456, ratio=0.246912),
                      verdict("2", "fail", **more, value=0.0500012, ratio=1.000024)))  # fmt: skip
    assert shown == [
        ["Case", "settlement≤ 50 mm"], ["1 no limit on rotation, residual tilt, ductility", "12.3✓ 25 %"],
        ["2 fails 1 check", "50.001✗ 100.002 %"]
    ]  # fmt: skip


def test_a_case_whose_checks_pass_though_no_run_stands_is_not_said_to_pass(tmp_path):
    fell = {(record, "1"): FELL for record, _ in FIG7}
    shown = page(tmp_path, verdict("1", "pass", check="static deflection"), verdict("2", "pass"), changes=fell)
    assert {row[0] for row in card(shown)[1:]} == {
        "2 no limit on mean settlement, residual tilt, ductility",
        "1 no run ends standing",
    }


def test_what_a_statistic_of_a_code_rests_on_is_said(tmp_path):
    shown = page(
        tmp_path, verdict("1", "pass", statistic="nzs1170.5", words="maximum by NZS 1170.5 of theta_max_over_alpha")
    )
    assert "nzs1170.5: the maximum of a family of at least three records, as NZS 1170.5 is commonly cited" in shown.text
    assert "neither the standard's own text nor a report of it could be checked" in shown.text


def test_a_study_without_checks_does_not_claim_to_pass(tmp_path):
    write_results(tmp_path)
    text = Page(write_report(tmp_path, []).read_text(encoding="utf-8")).text
    assert "No limits were set, so nothing was checked." in text
    assert "✓" not in text


def test_the_verdict_comes_before_the_figure_and_the_table_of_checks_after_it(tmp_path):
    write_results(tmp_path)
    write_verdicts(tmp_path, [verdict(case, "fail", ratio=1.25) for case, _ in FOUNDATIONS])
    text = write_report(tmp_path, []).read_text(encoding="utf-8")
    places = [text.index(f'<section id="{anchor}">') for anchor in ("answer", "peaks", "checks", "studied")]
    assert places == sorted(places)
    assert (
        places[0] < text.index("All 5 cases fail") < text.index('class="card"') < text.index('class="dots"') < places[1]
    )
    assert len(Page(text).tables["answer"]) == 1 + len(FOUNDATIONS)


def test_cases_at_several_scales_are_distinguished_by_these(tmp_path):
    at_scales = [verdict("1", "pass" if scale < 2.0 else "fail", ratio=scale, scale=scale) for scale in (1.0, 2.0)]
    shown = page(tmp_path, *at_scales, scales=(1.0, 2.0))
    names = [row[0].split("motions scaled by ")[1][:1] for row in shown.tables["answer"][1:]]
    assert names == ["1", "2"]


def test_each_remark_on_the_checks_is_a_line_of_its_own(tmp_path):
    write_results(tmp_path)
    remarks = {"push": ("no error estimate",), "drift": ("no error estimate", "fewer than 7 records")}
    write_verdicts(
        tmp_path, [verdict(f"c{i}", "pass", check=k, remarks=of) for i in range(3) for k, of in remarks.items()]
    )
    text = write_report(tmp_path, []).read_text(encoding="utf-8").partition('<section id="checks"')[2]
    listed = re.search(r'<ul class="legend">(.*?)</ul>', text, re.DOTALL)[1]
    lines = re.findall(r"<li>(.*?)</li>", listed)
    assert {"push, drift: no error estimate.", "drift: fewer than 7 records."} <= set(lines)


def test_the_legend_draws_limits_along_an_axis_as_a_line_and_a_rule_upright():
    x = np.array([0.0, 1.0])
    entries = [
        Entry("capacity", [Polyline(x, x, look=Look("limit"))]),
        Entry("limit", [Rule("x", x[:1], look=Look("limit"))]),
    ]
    assert re.findall(r"<(line|path)", key(entries)) == ["line", "path"]
