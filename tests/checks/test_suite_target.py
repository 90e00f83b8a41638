"""A suite below its target spectrum fails a check of its own, which comes first and decides; one that reaches it passes."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from check_samples import RIGID, folder, runs, verdict
from report_page import Page
from studies import RIGID as RIGID_BASE
from studies import SINE, study_text, write_study

import rockbatch as rb
from rockbatch.checks import read_verdicts, wording
from rockbatch.checks.answer import answer
from rockbatch.checks.suite_target import suite_verdicts
from rockbatch.checks.verdicts import FAIL, NOT_DECIDED, PASS
from rockbatch.commands.cli import main
from rockbatch.motions.design_spectra import TableSpectrum
from rockbatch.results.run_json import describe
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

NEAR_FAULT = Path(__file__).parents[2] / "motions" / "near_fault"
MARGIN = '[[check]]\nname = "margin"\ndemand = "theta_max_over_alpha"\nat_most = 0.9\nreason = "agreed"\n'


def target(*over: float, **more):
    """Return a target as run.json has it, with these means over it at as many periods from 0.5 s on."""
    sa = [0.8 / (1 + i) for i in range(len(over))]
    return {
        "spectrum": "of a code", "damping": 0.05, "range_s": [0.5, 2.0], "factors": "both", "pairs": "apart", "alone": 0,
        "at_least": 0.9, "period_s": [0.5 * (1 + i) for i in range(len(over))], "sa_g": sa,
        "mean_sa_g": [float(f"{ratio * value:.5g}") for ratio, value in zip(over, sa, strict=True)],
    } | more  # fmt: skip


def suite(path, over, checks=MARGIN, **info):
    return folder(path, runs([0.1, 0.4], "rigid"), [RIGID], checks, target=target(1.2, over, 1.0), **info)


@pytest.mark.parametrize(
    ("over", "decided"), [(0.9, PASS), (0.89996, PASS), (0.95, PASS), (0.8995, FAIL), (0.76, FAIL), (0.0, FAIL)]
)
def test_the_least_mean_over_target_decides_to_the_digits_of_run_json(over, decided):
    (found,) = suite_verdicts({"target": target(1.3, over, 1.0)}, [1.0])
    assert (found.check, found.case, found.verdict, found.limit) == ("suite to target", "", decided, 0.9)
    assert found.value == found.low == found.high == pytest.approx(over, rel=1e-4)
    assert found.margin == found.value - 0.9
    assert found.ratio == (0.9 / found.value if over else np.inf)
    assert (found.basis, found.reason) == ("study", "of a code, between 0.5 s and 2 s")
    assert (found.records, found.runs, found.scale) == (0, 0, 1.0)  # it is no run's
    assert found.note == "least at T = 1 s"


def test_both_targets_are_checks_but_not_one_that_is_only_compared():
    below = target(0.5)
    both = suite_verdicts({"target": below, "vertical_target": below}, [0.5, 1.0])
    assert [found.check for found in both] == ["suite to target", "suite to vertical target"]
    assert all("as fitted, at scale 1" in found.note for found in both)
    assert not suite_verdicts({"target": target(0.5, factors="none")}, [1.0])  # as an earlier version wrote it
    assert not suite_verdicts({"target": target(0.5, factors="none", required=False)}, [1.0])
    assert suite_verdicts({"target": target(0.5, factors="none", required=True)}, [1.0])
    assert not suite_verdicts({}, [1.0])


@pytest.mark.parametrize(
    ("scales", "value"), [([1.0], 0.9), ([0.5, 1.0, 2.0], 0.9), ([0.5], 0.45), ([0.25, 0.5], 0.45)]
)
def test_a_suite_is_held_against_its_target_as_it_is_run(scales, value):
    """At scale 1 if that is among the scales, else at the greatest; a mean of 0.9 of the target at half of it is 0.45."""
    (found,) = suite_verdicts({"target": target(0.9)}, scales)
    assert (found.value, found.verdict) == (pytest.approx(value), "pass" if value == 0.9 else "fail")
    assert (f"at scale {max(scales):g}" in found.note) == (1.0 not in scales)


def test_a_suite_without_a_record_that_was_fitted_has_no_verdict():
    assert not suite_verdicts({"target": target(0.0)}, [1.0])


def test_a_suite_below_its_target_comes_first_and_leaves_nothing_green():
    of_suite = suite_verdicts({"target": target(0.6)}, [1.0])
    of_cases = [verdict("a", "pass", ratio=0.5), verdict("b", "fail", ratio=3.0, value=1.5)]
    assert [found.check for found in wording.worst_first([*of_cases, *of_suite])] == ["suite to target", "margin"]

    def lines(verdicts):
        return answer(verdicts, (), lambda found: found.case, lambda found: found.record)

    first, passing, failing = lines([*of_suite, *of_cases])
    assert (first.verdict, first.text) == (FAIL, "The suite is below its target")
    assert first.details == ("suite to target: 0.6 < 0.9, least at T = 0.5 s.".replace(" < ", "\u00a0<\u00a0"),)
    assert (passing.verdict, passing.cases) == (NOT_DECIDED, "a")
    assert passing.text == "1 of 2 cases passes every check, but under a suite below its target"
    assert failing.verdict == FAIL
    met = suite_verdicts({"target": target(0.9)}, [1.0])
    assert lines([*met, *of_cases]) == lines(of_cases)


@pytest.mark.usefixtures("no_report")
def test_the_command_and_the_page_say_it_first_whatever_the_rules(tmp_path, capsys):
    below, met = (suite(tmp_path / name, over) for name, over in (("below", 0.76), ("met", 0.9)))
    rules = tmp_path / "rules.toml"
    rules.write_text(MARGIN.replace("margin", "other"))
    for arguments, name in (([], "margin"), (["--rules", str(rules)], "other")):
        assert main(["check", str(met), *arguments]) == 0
        assert "✓ Every check passes" in capsys.readouterr().out
        assert main(["check", str(below), *arguments]) == 1
        shown = capsys.readouterr().out
        assert "✓ Every" not in shown
        assert shown.index("✗ The suite is below its target.") < shown.index(
            "? Every check passes in the only case, but"
        )
        written = [(found.check, found.case, found.verdict) for found in read_verdicts(below)]
        assert written == [("suite to target", "", "fail"), (name, "rigid", "pass")]
    page = Page(rb.report(below).path.read_text(encoding="utf-8"))
    assert page.text.index("✗ The suite is below its target.") < page.text.index(
        "? Every check passes in the only case, but"
    )
    assert [row[0] for row in page.tables["answer"]] == ["Case", "rigidpasses 1 check"]
    assert "suite to target" in [row[0] for row in page.tables["checks"]]
    assert ": below the 0.9 that is asked for." in page.text
    both = Page(rb.report(met, below, out=tmp_path / "two.html").path.read_text(encoding="utf-8")).text
    assert both.index("✓ Every check passes") < both.index("✗ The suite is below its target.")


@pytest.mark.usefixtures("no_report")
def test_a_study_without_checks_is_held_against_its_target_and_nothing_else_is_claimed(tmp_path, capsys):
    for over, code in ((0.76, 1), (0.9, 0)):
        out = suite(tmp_path / f"{over}", over, "")
        assert main(["check", str(out)]) == code
        shown = capsys.readouterr().out
        assert ("✗ The suite is below its target." in shown) == bool(code)
        assert "No limits were set" in shown
        assert "Every check" not in shown
        text = Page(rb.report(out).path.read_text(encoding="utf-8")).text
        assert text.index("No limits were set") > (text.index("✗ The suite is below its target.") if code else 0)


def test_checks_of_which_none_applies_have_not_passed_though_the_suite_has(tmp_path, capsys):
    out = suite(tmp_path / "out", 0.9, MARGIN.replace("theta_max_over_alpha", "settlement_m"))
    assert main(["check", str(out)]) == 1
    assert "none of the checks applies" in capsys.readouterr().err


def test_scales_of_cases_are_distinguished_and_the_suite_has_none(tmp_path):
    out = folder(tmp_path / "out", runs([0.1, 0.4], "rigid", scale=2.0), [RIGID], MARGIN, target=target(0.76))
    main(["check", str(out)])
    tables = Page(rb.report(out).path.read_text(encoding="utf-8")).tables
    (verdict,) = [row for row in tables["checks"] if row[0] == "margin" and "✓" in "".join(row)]
    assert verdict[1] == "rigid"


def near_fault(tmp_path, **spectrum):
    keys = {
        "spectrum": "NZS 1170.5", "subsoil": "C", "hazard_factor": 0.4, "return_period_factor": 1.85,
        "period_range_s": [0.2244, 2.2483], "at_least": 0.9,
    }  # fmt: skip
    motions = {"path": str(NEAR_FAULT), "vertical": False, "target": keys | spectrum}
    return load_study(
        write_study(tmp_path, study_text(motions=motions, pulses=(), cases=[RIGID_BASE], output={"histories": "none"}))
    )


def test_records_that_need_too_large_a_factor_leave_no_suite_below_its_target(tmp_path):
    """Of five stations one needs a factor of 4.17; without it the mean of the others was 0.76 of the target."""
    study = near_fault(tmp_path, factors="both")
    motions = ground_motions(study)
    assert {motion.of_station for motion in motions} == {"1336", "HSES", "WTMC"}
    assert len(motions.unusable) == 4
    assert max(motion.factor for motion in motions) <= 4.0
    (found,) = suite_verdicts(describe(study, motions), [1.0])
    assert (found.verdict, found.value) == (PASS, 0.9)


@pytest.mark.usefixtures("no_report")
def test_a_run_of_a_suite_below_its_target_ends_with_1(tmp_path, capsys):
    near_fault(tmp_path, factors="each")
    assert main(["run", str(tmp_path / "study.toml"), "--out", str(tmp_path / "out")]) == 1
    shown = capsys.readouterr()
    assert "✗ The suite is below its target." in shown.out
    assert "not used" not in shown.err
    (found,) = read_verdicts(tmp_path / "out")
    assert (found.verdict, found.note) == (FAIL, "least at T = 0.23 s")
    assert found.value == pytest.approx(0.7467, abs=1e-4)


def test_pulses_are_in_no_mean_that_is_held_against_a_target(tmp_path, monkeypatch):
    monkeypatch.setitem(globals(), "NEAR_FAULT", NEAR_FAULT / "christchurch2016_nblc")
    records = near_fault(tmp_path, factors="each")
    info = describe(records, ground_motions(records))
    text = (tmp_path / "study.toml").read_text(encoding="utf-8")
    pulse = "\n".join(f"{key} = {value!r}" for key, value in (SINE | {"amplitude_g": 2.9}).items())
    (tmp_path / "study.toml").write_text(f"{text}\n[[motions.pulse]]\n{pulse}\n", encoding="utf-8")
    study = load_study(tmp_path / "study.toml")
    motions = ground_motions(study)
    with_pulse = describe(study, motions)
    assert len(motions.motions) == len(info["records"]) + 1
    assert with_pulse["target"] == info["target"]
    np.testing.assert_array_equal(with_pulse["spectra"]["mean_sa_g"], info["spectra"]["mean_sa_g"])


def test_a_target_beyond_a_limit_of_its_code_and_components_apart_are_remarked_on_and_not_refused(tmp_path, capsys):
    """Z R = 0.74 of NZS 1170.5, which caps it at 0.7, and a code's spectrum for each component of five pairs."""
    near_fault(tmp_path, factors="none")
    assert main(["run", str(tmp_path / "study.toml"), "--out", str(tmp_path / "out")]) == 1
    cap, pairs = "Z R = 0.74, which NZS 1170.5, 3.1.1", 'pairs = "apart": each of two components'
    told = capsys.readouterr().err
    page = Page((tmp_path / "out" / "report.html").read_text(encoding="utf-8")).text
    for shown in (told, page):
        assert cap in shown
        assert pairs in shown
        assert "return_period_factor = 1.75" in shown


@pytest.mark.parametrize(
    ("keys", "remarks"),
    [
        ({"return_period_factor": 1.75, "pairs": "srss"}, 0),
        ({"return_period_factor": 1.75}, 1),
        ({"return_period_factor": 1.76, "pairs": "srss"}, 1),
    ],
)
def test_remarks_on_a_target_are_for_what_is_beyond_it_only(tmp_path, keys, remarks):
    study = near_fault(tmp_path, factors="none", **keys)
    motions, target = ground_motions(study).motions, study.motions.target
    assert len(target.remarks(motions)) == remarks
    one_each = list({motion.of_station: motion for motion in motions}.values())
    assert len(target.remarks(one_each)) == remarks - ("pairs" not in keys)
    assert not replace(target, spectrum=TableSpectrum((0.1, 4.0), (1.0, 0.2))).remarks(motions)
