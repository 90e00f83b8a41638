"""A table that a user has is judged as the folder that it comes from, however pandas keeps it, or is refused with words."""

from pathlib import Path

import pandas as pd
import pytest
from studies import COSINE, PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.checks import Rule
from rockbatch.common.errors import InputError

RECORDS = Path(__file__).parents[2] / "motions" / "near_fault"
RULES = [
    Rule("rotation", "theta_max_over_alpha", 0.1, statistic="mean"),
    Rule("settlement", "settlement_m", 0.001),
    Rule("stands", "overturned", 0),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a study of both polarities and two scales, of which one pad falls, and its folder, with a file that is no record."""
    home = tmp_path_factory.mktemp("given")
    pulses = (SINE, COSINE | {"amplitude_g": 2.0, "period_s": 2.0})
    cases = (RIGID, PADS | {"beta": [30, 50]})
    motions = {"polarity": ["+", "-"], "scale": [0.5, 1.0]}
    study = rb.load_study(write_study(home, study_text(pulses=pulses, cases=cases, motions=motions)))
    rb.run(study, out=home / "out")
    return study, home / "out"


def read(folder, **options):
    return pd.read_csv(folder / "peaks.csv", **options)


def as_category(table):
    return table.astype(dict.fromkeys(("record", "case", "polarity", "status"), "category"))


@pytest.mark.sweep(fast=2)
@pytest.mark.parametrize("kept", [
    read, lambda folder: read(folder, keep_default_na=False), lambda folder: read(folder, dtype_backend="numpy_nullable"),
    lambda folder: read(folder, dtype=str), lambda folder: as_category(read(folder)), lambda folder: read(folder).astype(object),
    lambda folder: read(folder).sample(frac=1.0, random_state=1).set_index("reason", drop=False),
], ids=["as read", "empty cells", "nullable", "texts", "categories", "objects", "shuffled"])  # fmt: skip
def test_a_table_is_judged_as_its_folder(folder, kept):
    study, results = folder
    expected = rb.check(results, RULES)
    assert set(expected["verdict"]) >= {"pass", "fail"}
    found = rb.check(kept(results), RULES, study=study)
    order = ["check", "case", "beta", "scale"]
    both = (table.sort_values(order, ignore_index=True).drop(columns="governing") for table in (found, expected))
    pd.testing.assert_frame_equal(*both, check_dtype=False)


def test_rows_of_unusable_files_are_in_no_suite_of_a_table_read_by_pandas(folder):
    study, results = folder
    unusable = pd.DataFrame({"record": ["broken"], "status": ["failed"], "reason": ["cut off"]})
    found = rb.check(pd.concat([read(results), unusable]), RULES, study=study)
    assert len(found) == len(rb.check(results, RULES))
    assert not found["counted"].str.contains("not run").any()


@pytest.mark.parametrize(("made", "words"), [
    (lambda table: table.drop(columns="status"), "once each, as rockbatch.run returned it: status"),
    (lambda table: table.set_index(["record", "case"]), "once each, as rockbatch.run returned it: record, case"),
    (lambda table: table.drop(columns="beta"), "once each, as rockbatch.run returned it: beta"),
    (lambda table: pd.concat([table, table["status"]], axis=1), "once each, as rockbatch.run returned it: status"),
    (lambda table: pd.concat([table, table[:1]]), "the table has a run of one-sine, case rigid, twice; leave one out"),
    (lambda table: table.assign(theta_max_error="small"), 'theta_max_error = "small": expected a number'),
    (lambda table: table[table["polarity"] == "-"], "the table has mirror images only, and not the runs that they mirror"),
    (lambda table: table.assign(status=table["status"].str.upper()), 'status = "OK": expected one of "ok", "overturned"'),
    (lambda table: table.replace({"case": {"rigid": "rock"}}), 'a run of case "rock", which the study does not have'),
    (lambda table: table.replace({"beta": {50: 60}}), 'a run of case "pads", beta = 60.0, which the study does not have'),
    (lambda table: table.replace({"scale": {0.5: 0.6}}), "a run at scale 0.6, and the study scales by 0.5, 1: pass the study"),
    (lambda table: table.assign(drift_height_m=9.0), "drift_height_m = 9 of one-sine, case rigid, where the study's pier has"),
    (lambda table: table.assign(heel_uplift_m=table["heel_uplift_m"] * 1.01), "pass the study that produced the table"),
    (lambda table: pd.DataFrame(), "once each, as rockbatch.run returned it: record, case"),
    (lambda table: table.iloc[0], "expected the table that rockbatch.run returned, not Series"),
    (lambda table: table.to_dict("records"), "expected the table that rockbatch.run returned, not list"),
])  # fmt: skip
def test_a_table_that_cannot_be_judged_is_refused_with_what_it_lacks(folder, made, words):
    study, results = folder
    with pytest.raises(InputError) as refused:
        rb.check(made(read(results)), RULES, study=study)
    assert words in str(refused.value)


def test_a_table_is_not_judged_by_a_study_of_another_pier(folder):
    study, results = folder
    pier = study.cases[0].pier
    other = study.with_(pier={"alpha": 2.0 * pier.alpha})
    with pytest.raises(InputError, match=r"^drift_height_m = .* pass the study that produced the table"):
        rb.check(read(results), RULES, study=other)
    lengths = ["drift_height_m", "heel_uplift_m"]
    assert len(rb.check(read(results).drop(columns=lengths), RULES, study=study))


def test_motions_beside_a_folder_are_refused(folder):
    """The folder has those that it was run with."""
    _, out = folder
    for results in (out, rb.open_results(out)):
        with pytest.raises(InputError, match="a folder has its own"):
            rb.check(results, RULES, motions=out)


def test_a_table_that_was_given_is_left_as_it_is(folder):
    study, results = folder
    table = read(results, keep_default_na=False)
    before = table.to_csv()
    rb.check(table, RULES, study=study)
    assert table.to_csv() == before


def test_choices_and_limits_of_given_rules_that_do_not_fit_are_refused_together(folder):
    study, out = folder
    wrong = [
        Rule("x", "theta_max_over_alpha", -1.0, case=("rig",), scale=(3.0,)),
        Rule("y", "section_moment_kNm", 1.0, at_m=3.0),
        Rule("z", "top_drift_m", 1e6),
    ]
    for results, more in ((out, {}), (pd.read_csv(out / "peaks.csv"), {"study": study})):
        with pytest.raises(InputError) as error:
            rb.check(results, wrong, **more)
        assert [problem.text.split(":")[0] for problem in error.value.problems] == [
            *['check "x"'] * 3,
            'check "y"',
            'check "z"',
        ]
    with pytest.raises(InputError, match="no such case"):
        rb.check(out, wrong[:1])


@pytest.mark.slow
def test_a_table_with_its_motions_is_judged_by_codes_as_its_folder(tmp_path):
    """A table alone knows no earthquake and no target, and says what to pass for them."""
    target = {"spectrum": "EN 1998-1", "type": 1, "ground": "C", "ag_g": 0.2, "period_range_s": [0.4, 2.0]}
    motions = {"path": str(RECORDS), "target": target}
    study = rb.load_study(write_study(tmp_path, study_text(pulses=(), motions=motions, cases=[RIGID])))
    rules = [Rule("mean", "theta_max_over_alpha", 0.5, statistic="en1998-1", per_event=3)]
    rb.run(study, out=tmp_path / "out")
    expected = rb.check(tmp_path / "out", rules).drop(columns="governing")
    table = read(tmp_path / "out")
    found = rb.check(table, rules, study=study, motions=RECORDS).drop(columns="governing")
    pd.testing.assert_frame_equal(found, expected, check_dtype=False)
    of_case = found.iloc[-1]
    assert (len(found) > 3, of_case["verdict"], of_case["omits"]) == (True, "pass", "")
    (alone,) = rb.check(table, rules, study=study).to_dict("records")
    advice = "the check allows 3 of one event, and of 5 it is not known: pass the motions of the table, too"
    assert (alone["verdict"], alone["note"].split("; ")[0]) == ("not decided", advice)
    missing = rb.check(table[table["record"] != table["record"][0]], rules, study=study, motions=RECORDS)
    assert missing["counted"].iloc[-1] == "1 not run (unknown)"
    with pytest.raises(InputError, match=r"motions: have no .*: pass those that it was run with"):
        rb.check(table, rules, study=study, motions=RECORDS / "kaikoura2016_wtmc")
