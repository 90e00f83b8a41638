"""What no study can ask: numbers that overflow, or make a run that never ends, and more cases and runs than there is room for."""

import time

import pytest
from studies import PADS, PIER, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.batch import execution
from rockbatch.commands.cli import main
from rockbatch.study import lists


def told(folder, **parts):
    """What is said of a study; nothing where there is nothing to say."""
    try:
        rb.run(write_study(folder, study_text(**parts)), jobs=1)
    except rb.InputError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("value", [1e-300, 1e300, -1e300, 1e-9, 1e9])
def test_a_pier_of_no_size_that_there_is_is_refused_at_its_key(tmp_path, value):
    """1e-300 divided by zero, 1e300 overflowed, and a pier of 1e-9 rad/s takes ten thousand million seconds to rock once."""
    assert "study.toml:4: [pier]: p = " in told(tmp_path, pier=PIER | {"p": value})
    with pytest.raises(rb.InputError, match="p = "):
        rb.Pier(0.2, value)
    with pytest.raises(rb.InputError):
        rb.Pier.from_size(0.2, value)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"beta": 1e300}, "beta = 1e+300: expected a number of the size 1e-15 to 1e+15"),
        ({"eta": 1e300}, "eta = 1e+300: expected a number of the size"),
        ({"n": 1e12}, "n = 1000000000000.0: the Bouc–Wen exponent must be at least 1, and 1000 at most"),
        ({"epsilon": 1e-300}, "epsilon = 1e-300: expected a number of the size"),
    ],
)
def test_a_foundation_of_numbers_that_nobody_means_is_refused_at_its_key(tmp_path, keys, words):
    assert words in told(tmp_path, cases=(PADS | keys,))


@pytest.mark.parametrize("masses", [{"width_m": 1e300}, {"height_m": 1e-300}, {"deck_mass_t": 1e300}])
def test_masses_whose_squares_overflow_are_refused(masses):
    given = {"width_m": 8.0, "height_m": 30.0, "mass_t": 2000.0, "deck_mass_t": 1000.0} | masses
    with pytest.raises(rb.InputError, match=next(iter(masses))):
        rb.Pier.with_deck(**given)


def test_more_cases_than_there_is_room_for_are_refused_at_once(tmp_path):
    """10⁹ of them, in a file of some kilobytes."""
    many = {"beta": [50 + 0.1 * i for i in range(1000)], "eta": [2 + 0.1 * i for i in range(1000)]}
    many |= {"epsilon": [0.001 * i for i in range(1000)]}
    started = time.process_time()
    said = told(tmp_path, cases=(RIGID, PADS | many))
    assert "1,000,000,001 cases, more than 100,000: every value of a list is combined with every other" in said
    piers = {"alpha": [0.1 + 0.0001 * i for i in range(1000)], "p": [1 + 0.001 * i for i in range(1000)]}
    assert "1,000,000 piers, more than 100,000" in told(tmp_path, pier=piers)
    assert time.process_time() - started < 5


def test_more_runs_than_a_table_holds_are_refused_before_the_first(tmp_path, monkeypatch):
    monkeypatch.setattr(execution, "MOST_RUNS", 5)
    assert told(tmp_path, motions={"scale": [0.5, 1.0]}) == ""  # 4 runs
    scales = {"scale": [0.5, 0.75, 1.0]}
    assert "6 runs, more than 5: records × polarities × scales × cases; split the study" in told(
        tmp_path, motions=scales
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("betas", "shown", "most_info", "most_page"),
    [(2, 30, 38_100, 860_000), pytest.param(12, 300, 215_000, 2_500_000, marks=pytest.mark.thorough)],
)
@pytest.mark.usefixtures("pages")
def test_the_greatest_number_of_cases_is_checked_to_the_end(
    tmp_path, monkeypatch, capsys, betas, shown, most_info, most_page
):
    """Stages after the runs say what they are if they take long; a case is a line of run.json, and the page stays small."""
    monkeypatch.setattr("rockbatch.batch.listening.PATIENCE_S", 0.0)
    most = 30 * betas
    monkeypatch.setattr(lists, "MOST_CASES", most)
    monkeypatch.setattr("rockbatch.reporting.overview.MOST_FOUNDATIONS", shown)
    cases = {"beta": [50 + 0.1 * i for i in range(betas)], "eta": [2 + 0.01 * i for i in range(30)]}
    text = study_text(
        pulses=(SINE | {"duration_s": 0.5},), cases=(PADS | cases,), numerics={"substeps": 1, "quiet_s": 0.0},
        output={"both_laws": False, "histories": "none"},
    )  # fmt: skip
    assert main(["run", str(write_study(tmp_path, text)), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0
    said = capsys.readouterr().err
    assert "writing run.json" in said
    assert "writing histories.h5" in said
    assert "writing report.html" in said
    info = (tmp_path / "out/run.json").read_text(encoding="utf-8")
    assert sum(line.startswith('  {"case": ') for line in info.splitlines()) == most
    assert len(info) < most_info
    page = (tmp_path / "out/report.html").read_text(encoding="utf-8")
    assert f"The first {shown} of {most} foundations, in the order of the study" in page
    assert len(page) < most_page
