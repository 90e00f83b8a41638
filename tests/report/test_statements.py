"""A statement on a case says what its results hold, in every outcome, and nothing that its tables do not have."""

import json
import random
import re
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from browser import HOSTILE
from check_samples import PADS, PIER, RECORD, RIGID, case, folder, runs, verdict
from report_page import Page
from studies import RIGID as ROCK
from studies import seven_pulses, study_text, write_study

import rockbatch as rb
from rockbatch.checks import as_table, read_verdicts, write_verdicts
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS
from rockbatch.commands.cli import main
from rockbatch.reporting.finished import read
from rockbatch.reporting.page import page
from rockbatch.reporting.sections.statement import MOST_CASES, section
from rockbatch.reporting.sections.statement.check_sentences import quoted
from rockbatch.reporting.sections.statement.statements import statements
from rockbatch.reporting.sheet import sheet_of
from rockbatch.results.checking import verdicts
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case

MEDIAN = rb.Rule("half", "theta_max_over_alpha", 0.08, statistic="median", reason="EN 1998-2, 7.6.2", basis="code")
UPLIFT = rb.Rule("lift", "heel_uplift_m", 0.0885, reason="travel of the keys")
STANDS = rb.Rule("stands", "overturned", 0, reason="collapse")
FREE = rb.Rule("turns", "theta_max_over_alpha", 0.5, reason="agreed")
BOUNDS = [
    {"name": "light", "pier.p": {"times": 1.25}},
    {"name": "bouncy", "case.restitution": 0.95, "source": "tests of 2025"},
]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Results of a rocking block under seven pulses, nominally and under two bounds."""
    path = tmp_path_factory.mktemp("statements")
    check = [{"name": "turns", "demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "agreed"}]
    cases = [ROCK | {"restitution": 0.9}]
    text = study_text(pulses=seven_pulses(0.3), cases=cases, bound=BOUNDS, check=check)
    rb.run(write_study(path, text), out=path / "out")
    return path / "out"


def of(directory, *rules):
    """Judge the results by these rules, if any, and return verdict and paragraph of each case, by its label."""
    if rules:
        write_verdicts(directory, verdicts(directory, rules))
    return {one.name: (one.verdict, one.text) for one in statements(read(directory, ()))}


def alone(directory, *rules):
    (found,) = of(directory, *rules).values()
    return found


def figures(text):
    """Return value, limit, share and margin of each check in a paragraph."""
    number = r"([-\d.,e]+)"
    value = rf'"(\w+)" \w[\w ]+: the .+? is (?:at worst )?{number} '
    limit = rf".*?{number}(?: \w+)? is allowed \({number} % of the limit, {number}"
    pattern = value + limit
    return {name: tuple(float(n.replace(",", "")) for n in numbers) for name, *numbers in re.findall(pattern, text)}


def test_value_share_margin_bound_and_record_are_those_of_peaks_csv(results):
    """The median and the greatest of seven records, under the worst of three designs, from the table by hand."""
    decided, text = alone(results, MEDIAN, UPLIFT)
    peaks = pd.read_csv(results / "peaks.csv", keep_default_na=False)
    by_bound = peaks.groupby("bound")
    medians, greatest = by_bound["theta_max_over_alpha"].median(), by_bound["heel_uplift_m"].max()
    assert (medians.idxmax(), greatest.idxmax()) == ("light", "bouncy")
    found = figures(text)
    for name, values, limit in (("half", medians, 0.08), ("lift", greatest, 0.0885)):
        value = values.max()
        assert found[name] == pytest.approx((value, limit, 100 * value / limit, abs(limit - value)), rel=5e-3)
    of_light = peaks[peaks["bound"] == "light"].set_index("record")["theta_max_over_alpha"]
    assert f'greatest in "{of_light.idxmax()}": {of_light.max():.4g};' in text  # a median has no record that governs
    of_bouncy = peaks[peaks["bound"] == "bouncy"].set_index("record")["heel_uplift_m"]
    assert f'governed by "{of_bouncy.idxmax()}"' in text
    assert decided == FAIL


def test_a_design_that_fails_under_one_bound_fails_with_the_bound_named(results):
    decided, text = alone(results, MEDIAN, UPLIFT, STANDS)
    assert decided == FAIL
    assert text.startswith('Case "rigid" fails 1 of 3 checks: "lift".')
    assert '"half" passes: the median over 7 stations of the greatest rotation over α is at worst' in text
    assert 'beyond it); it fails under "bouncy", and passes under "light", nominally; governed by' in text
    assert 'limit by code clause: "EN 1998-2, 7.6.2".' in text
    assert '"stands" passes: it asks that no record overturns the pier, of 7 stations; limit by engineering' in text
    assert 'under 2 bounds: "light", pier.p × 1.25; "bouncy", case.restitution = 0.95 (tests of 2025).' in text


def test_a_design_passes_only_where_every_bound_does(results):
    decided, text = alone(results, replace(UPLIFT, at_most=0.1), replace(MEDIAN, at_most=0.2))
    assert (decided, text.count(" fails"), text.count("not decided")) == (PASS, 0, 0)
    assert text.startswith('Case "rigid" passes both checks under every bound. It was run under 7 analytical motions,')
    assert "Assumed, for the nominal design: Each pier moves in one vertical plane" in text
    assert "the given factor 0.9." in text  # that of the nominal design, not of a bound
    assert "any strength of pier, joints, devices and ground but as these limits state it." in text


def test_study_program_and_results_are_those_of_run_json(results):
    text, info = alone(results, MEDIAN)[1], json.loads((results / "run.json").read_text(encoding="utf-8"))
    for digest in (info["study"]["sha256"], info["peaks"]["sha256"]):
        assert f"{digest[:16]}…" in text
    assert f"Computed by rockbatch {info['rockbatch']}" in text
    assert info["created"][:10] in text


OUTCOMES = {
    "overturned": (FAIL, 'fails its only check: "turns"', "is beyond any limit, where at most 0.5 is allowed;"),
    "flight": (NOT_DECIDED, 'is not decided by its only check: "turns"', "is at least 0.3, where"),
    "failed": (NOT_DECIDED, 'is not decided by its only check: "turns"', "is at least 0.2, where"),
}
"""What the status of a run of θ = 0.3 α makes of a limit of 0.5, beside runs that stand with up to 0.2 α."""


@pytest.mark.parametrize("status", OUTCOMES)
def test_a_run_that_does_not_end_standing_is_in_the_statement(tmp_path, status):
    table = runs((0.1, 0.2, 0.3), "rigid", status=["ok", "ok", status])
    decided, text = alone(folder(tmp_path / "out", table, [RIGID]), FREE)
    expected, first, value = OUTCOMES[status]
    assert decided == expected
    assert first in text
    assert value in text
    ended = {"overturned": "overturned", "flight": "ended by flight", "failed": "failed"}[status]
    assert f"what follows where the pier does not end standing: 1 of 3 runs {ended}" in text
    assert f"runs that do not end standing: 1 {status}" in text


@pytest.mark.parametrize(
    ("status", "theta", "share"),
    [
        ("ok", 0.3, "60 % of the limit, 0.2 to spare"),
        ("ok", 0.5, "100 % of the limit, 0 to spare"),
        ("ok", 0.7, "140 % of the limit, 0.2 beyond it"),
        ("flight", 0.3, "at least 60 % of the limit, at most 0.2 to spare"),
        ("flight", 0.7, "at least 140 % of the limit, at least 0.2 beyond it"),
    ],
)
def test_share_and_margin_of_a_run_that_ended_early_are_bounds(tmp_path, status, theta, share):
    table = runs((0.1, theta), "rigid", status=["ok", status], theta_max_error=0.0)
    _, text = alone(folder(tmp_path / "out", table, [RIGID]), FREE)
    assert f", where at most 0.5 is allowed ({share})" in text


def test_what_is_required_is_not_called_allowed(tmp_path):
    """η of the pads is 2.5."""
    asked = rb.Rule("reserve", "eta", at_least=2.0, reason="agreed")
    _, text = alone(folder(tmp_path / "out", runs((0.1,)), [case()]), asked)
    assert "is 2.5, where at least 2 is required (80 % of the limit, 0.5 to spare)" in text


def test_a_run_that_is_missing_leaves_the_case_open(tmp_path):
    results = folder(tmp_path / "out", runs((0.1, 0.2, 0.3), "rigid"), [RIGID])
    peaks = (results / "peaks.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    (results / "peaks.csv").write_text("".join(peaks[:-1]), encoding="utf-8")
    decided, text = alone(results, FREE)
    assert decided == NOT_DECIDED
    assert "does not end standing: 1 of 3 runs not run" in text


def test_a_case_of_which_no_run_stands_is_not_checked(tmp_path):
    table = runs((0.1, 0.2), "rigid", status="overturned")
    share = rb.Rule("share", "overturned", 1.0, statistic="mean", reason="agreed", confirm=("at_most",))
    decided, text = alone(folder(tmp_path / "out", table, [RIGID]), share)
    assert decided == DOES_NOT_APPLY
    assert text.startswith('Case "rigid" is not checked: no run ends standing.')


def test_files_that_could_not_be_used_keep_a_case_from_passing(tmp_path):
    bad = {"name": "WTMC.N", "source": "WTMC.V2A", "reason": "no unit", "station": "WTMC"}
    left = {"name": "KOBE", "source": "kobe.at2", "reason": "a copy", "station": "KOBE", "named": True}
    table = runs((0.1, 0.2), "rigid")
    decided, text = alone(folder(tmp_path / "out", table, [RIGID], unusable=[bad], left_out=[left]), FREE)
    assert decided == NOT_DECIDED
    assert "meets its only check, but is not decided: records of 1 of 3 stations could not be used." in text
    assert 'records that could not be used: "WTMC.N"; records left out by name: "KOBE"' in text


def test_stations_of_which_no_record_is_selected_are_named_up_to_six(tmp_path):
    weak = {"source": "records.zip", "reason": "not selected", "named": False, "of": ""}
    files = [weak | {"name": f"N{i}", "station": f"ST{i}"} for i in range(61)]
    _, text = alone(folder(tmp_path / "out", runs((0.1, 0.2), "rigid"), [RIGID], left_out=files), FREE)
    named = ", ".join(f'"ST{i}"' for i in range(6))
    assert f"stations of which no record is selected: {named}, and 55 more;" in text


def test_a_response_that_governs_without_a_limit_keeps_a_case_from_passing(tmp_path):
    yielded = {"ductility_left": 2.0, "ductility_right": 3.0, "settlement_m": 0.05, "base_tilt_rad": 1e-3}
    decided, text = alone(folder(tmp_path / "out", runs((0.1, 0.2), **yielded), [case()]), FREE)
    assert decided == NOT_DECIDED
    assert "but is not decided: no check limits its mean settlement, residual tilt, ductility." in text
    assert "Not covered: mean settlement, which no check limits, of up to 50 mm; residual tilt" in text


@pytest.mark.parametrize(("over", "expected"), [(0.8, NOT_DECIDED), (0.95, PASS)])
def test_a_suite_below_its_target_decides_no_case(tmp_path, over, expected):
    target = {
        "spectrum": "of a code", "damping": 0.05, "range_s": [0.5, 1.0], "factors": "both", "pairs": "apart", "alone": 0,
        "at_least": 0.9, "period_s": [0.5, 1.0], "sa_g": [0.8, 0.4], "mean_sa_g": [1.0, 0.4 * over],
    }  # fmt: skip
    decided, text = alone(folder(tmp_path / "out", runs((0.1, 0.2), "rigid"), [RIGID], target=target), FREE)
    assert decided == expected
    below = f"the suite does not meet: mean spectrum of the suite over its target {over:g}, at least 0.9: fails."
    assert (below in text) == (expected == NOT_DECIDED)
    assert ("its suite of motions fails a check of its own" in text) == (expected == NOT_DECIDED)
    met = 'The suite meets the only condition of "suite to target" ("of a code, between 0.5 s and 1 s").'
    assert (met in text) == (expected == PASS)


def test_a_real_suite_that_is_scaled_down_is_below_its_target(tmp_path):
    """The same case passes under records scaled by 2, and is not decided under these by 0.5."""
    target = {
        "spectrum": "EN 1998-1",
        "type": 1,
        "ground": "C",
        "ag_g": 0.3,
        "factors": "each",
        "period_range_s": [0.3, 3.8],
    }
    motions = {"path": str(tmp_path / "records"), "unit": "g", "scale": [0.5, 2.0], "target": target}
    (tmp_path / "records").mkdir()
    t = np.arange(0.0, 8.0, 0.02)
    for i, period in enumerate((0.5, 0.9, 1.7)):
        shaking = (
            0.3 * np.exp(-((t - 3.0) ** 2)) * sum(np.sin(2 * np.pi * t / (k * period)) for k in (0.5, 1.0, 2.0, 4.0))
        )
        rows = "\n".join(f"{time:.2f},{value:.6f}" for time, value in zip(t, shaking, strict=True))
        (tmp_path / "records" / f"S{i}.csv").write_text(f"time,000\n{rows}\n", encoding="utf-8")
    check = [{"name": "turns", "demand": "theta_max_over_alpha", "at_most": 0.9, "reason": "agreed"}]
    study = study_text(pulses=(), motions=motions, cases=[ROCK], check=check)
    rb.run(write_study(tmp_path, study), out=tmp_path / "out")
    found = of(tmp_path / "out")
    table = pd.read_csv(tmp_path / "out" / "checks.csv", keep_default_na=False)
    for (name, (decided, text)), scale in zip(found.items(), (0.5, 2.0), strict=True):
        of_suite = table[(table["case"] == "") & (table["scale"] == scale)]
        failing = int((of_suite["verdict"] == FAIL).sum())
        assert decided == (NOT_DECIDED if failing else PASS), name
        assert text.count(": fails") == failing
        assert ("all scaled by 0.5" in text) == (scale == 0.5)
    assert [decided for decided, _ in found.values()] == [NOT_DECIDED, PASS]


def test_results_without_a_check_are_said_not_to_be_checked(tmp_path):
    decided, text = alone(folder(tmp_path / "out", runs((0.1, 0.2), "rigid"), [RIGID]))
    assert decided == DOES_NOT_APPLY
    assert text.startswith('Case "rigid" is not checked: no limit was set.')
    assert "Not covered: every limit of rotation, displacement, settlement and force." in text
    assert section(read(tmp_path / "out", ())) == ""


def test_a_check_that_does_not_apply_is_not_counted_and_is_said_to_be_left_out(tmp_path):
    settles = rb.Rule("sinks", "settlement_m", 0.1, reason="track")
    decided, text = alone(folder(tmp_path / "out", runs((0.1, 0.2), "rigid"), [RIGID]), FREE, settles)
    assert decided == PASS
    assert text.startswith('Case "rigid" passes its only check.')
    assert 'Not covered: "sinks", which does not apply: a rigid base has no settlement_m;' in text
    assert text.count('"sinks"') == 1  # no sentence on its value


@pytest.mark.parametrize(
    ("factors", "verticals", "directions", "expected"),
    [
        ((2.0, 0.5), (None, None), "++", "multiplied by factors of 0.5 to 2, without vertical components."),
        ((1.0, 1.0), (0.3, None), "--", "reversed, with the vertical component in 1 of 2."),
        ((1.0, 1.0), (0.3, 0.2), "+-", "in both directions, with the vertical component."),
    ],
)
def test_the_suite_is_said_with_factors_directions_and_verticals(tmp_path, factors, verticals, directions, expected):
    cells = [{"factor": factor, "pga_v_g": vertical} for factor, vertical in zip(factors, verticals, strict=True)]
    records = [RECORD | {"record": f"r{i}", "station": f"r{i}"} | own for i, own in enumerate(cells)]
    table = runs((0.1, 0.2), "rigid", polarity=list(directions))
    _, text = alone(folder(tmp_path / "out", table, [RIGID], records=records), FREE)
    assert f"It was run under 2 horizontal components of 2 stations, {expected}" in text


def test_only_a_case_that_lacks_a_changed_key_is_said_to_lack_it(tmp_path):
    """The bound changes a key of pads, which the rigid base does not have."""
    bound = {"name": "soft", "case.beta": {"times": 0.5}}
    check = [{"name": "turns", "demand": "theta_max_over_alpha", "at_most": 0.9, "reason": "agreed"}]
    pads = {"name": "pads", "base": "elastic", "beta": 50.0, "zeta": 0.05}
    text = study_text(pulses=seven_pulses(0.3)[:1], cases=[ROCK, pads], bound=[bound], check=check)
    rb.run(write_study(tmp_path, text), out=tmp_path / "out")
    lacking = 'It lacks case.beta, and ran without this change under "soft".'
    assert [lacking in text for _, text in of(tmp_path / "out").values()] == [True, False]


def test_cases_whose_labels_are_alike_have_statements_of_their_own(tmp_path):
    """The label of a listed value is the name of another case: each keeps its own verdict."""
    listed = [case("a", replace(PADS, epsilon=value), epsilon=value) for value in (0.0, 0.1)]
    other = case("a: ε = 0.1", PADS)
    tables = [runs((0.1, theta), "a", epsilon=value) for value, theta in ((0.0, 0.2), (0.1, 0.7))]
    peaks = pd.concat([*tables, runs((0.1, 0.3), "a: ε = 0.1", epsilon="")], ignore_index=True)
    rules = [FREE, *(replace(FREE, name=name, demand=name) for name in ("ductility",))]
    found = of(folder(tmp_path / "out", peaks, [*listed, other]), *rules[:1])
    assert len(found) == 3
    assert sorted(decided for decided, _ in found.values()).count(FAIL) == 1
    (failing,) = (text for decided, text in found.values() if decided == FAIL)
    assert "is 0.7, where" in failing


def test_a_pier_on_both_axes_has_one_statement_of_their_combined_demand(tmp_path):
    across = describe_case(Case("pads across", PIER, PADS, {}, across_of="pads"))
    peaks = pd.concat([runs((0.1, 0.3)), runs((0.2, 0.4), name="pads across")], ignore_index=True)
    decided, text = alone(folder(tmp_path / "out", peaks, [case(), across]), replace(FREE, both_axes="srss"))
    assert decided == PASS
    assert "of the greatest rotation over α, SRSS of both axes, is 0.5," in text
    assert "2 pairs of horizontal components of 2 stations" in text
    assert "Two planar models of each pier" in text


@pytest.mark.parametrize("name", [*HOSTILE, 'x" passes all 9 checks. Case "y', "\x1b[2J", "a.\u2028Case", "a\nb\tc"])
def test_no_name_can_be_read_as_a_sentence_or_as_markup(tmp_path, name):
    table = runs((0.1, 0.7), name)
    table["record"] = [name, "other"]
    results = folder(tmp_path / "out", table, [case(name)])
    decided, text = alone(results, rb.Rule(name, "theta_max_over_alpha", 0.5, reason=name))
    assert decided == FAIL
    assert text.count(quoted(name)) >= 3  # as case, as check and as reason
    assert text.count('"') % 2 == 0
    assert text.isprintable()
    drawn = section(read(results, ()))
    plain = Page(drawn)
    assert not plain.mismatched
    assert {*plain.tags} == {"h3", "span", "p", "code"}


@pytest.mark.parametrize("seed", range(5))
def test_no_remark_or_reason_is_read_to_decide_anything(results, seed):
    """Shuffled words in remarks, reasons and names of statistics: the verdict and every number stay."""
    judged = verdicts(results, [MEDIAN, UPLIFT, STANDS])
    draw = random.Random(seed)
    words = [
        "pass",
        "fails",
        "chaotic",
        "not",
        "decided",
        "any",
        "value",
        "no",
        "limit",
        "overturns",
        "under",
        "nominally",
    ]

    def mixed():
        return " ".join(draw.choices(words, k=6))

    write_verdicts(results, judged)
    before = alone(results)
    changes = [{"remarks": (mixed(), mixed()), "reason": mixed(), "counted": mixed(), "words": mixed()} for _ in judged]
    write_verdicts(results, [replace(one, **change) for one, change in zip(judged, changes, strict=True)])
    after = alone(results)
    assert (after[0], figures(after[1])) == (before[0], figures(before[1]))
    assert len(figures(after[1])) == 2
    assert after[1].split(". ")[0] == before[1].split(". ")[0]


def test_a_remark_is_said_once_with_its_checks_and_its_bounds(results):
    judged = verdicts(results, [MEDIAN, UPLIFT])
    noted = [
        replace(one, remarks=("two laws",) * (one.columns["bound"] == "light" or one.check == "half")) for one in judged
    ]
    write_verdicts(results, noted)
    assert 'Remarks: "half", "lift" under "light": two laws.' in alone(results)[1]


def test_the_command_prints_what_python_returns_for_all_cases_or_some(tmp_path, capsys):
    peaks = pd.concat([runs((0.1, 0.2), name) for name in ("rock a", "rock b", "pads")], ignore_index=True)
    results = folder(tmp_path / "out", peaks, [case(name) for name in ("rock a", "rock b", "pads")])
    write_verdicts(results, verdicts(results, [FREE]))
    for arguments, cases in (([], ["rock a", "rock b", "pads"]), (["--case", "rock *"], ["rock a", "rock b"])):
        assert main(["statement", str(results), *arguments]) == 0
        printed = capsys.readouterr().out
        assert printed == rb.statement(results, *arguments[1:]) + "\n"
        paragraphs = printed.split("\n\n")
        assert [re.match('Case "(.*?)" passes', one)[1] for one in paragraphs] == cases
    for asked, told in (("pad", 'did you mean "pads"?'), ("x", 'there is "rock a", "rock b", "pads"')):
        assert main(["statement", str(results), "--case", asked]) == 2
        assert told in capsys.readouterr().err


def test_verdicts_on_a_case_that_was_not_run_are_refused(tmp_path):
    results = folder(tmp_path / "out", runs((0.1, 0.2), "rigid"), [RIGID])
    write_verdicts(results, [verdict("pads", PASS)])
    with pytest.raises(rb.InputError, match=r'verdicts on case "pads", which run\.json does not list'):
        rb.statement(results)


@pytest.mark.slow
def test_page_and_sheet_have_the_statements_of_as_many_cases_as_are_read(tmp_path):
    names = [f"c{i}" for i in range(MOST_CASES + 1)]
    peaks = pd.concat([runs((0.1, 0.2), name) for name in names], ignore_index=True)
    results = folder(tmp_path / "out", peaks, [case(name) for name in names])
    found = of(results, FREE)
    for drawn in (page(read(results, ())), sheet_of(read(results, ())).html()):
        text = "".join(Page(drawn).words)
        shown_cases = [name for name, (_, paragraph) in found.items() if paragraph in text]
        assert shown_cases == names[:MOST_CASES]
        assert f"These are the first {MOST_CASES} cases." in text
    assert as_table(read_verdicts(results))["case"].nunique() == MOST_CASES + 1
