"""Rocking spectra: every size and slenderness, overturned points among them, and the mistakes that a file may hold."""

import math

import numpy as np
import pandas as pd
import pytest
from studies import PADS, RIGID, SINE, study_text, write_study

from rockbatch.analyses.spectrum.command import shown
from rockbatch.analyses.spectrum.rocking_spectrum import of_suite, row_of
from rockbatch.analyses.spectrum.study import read_spectrum
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.pier import Pier, RigidBase, YieldingBase
from rockbatch.results.columns import StudyRun
from rockbatch.simulation import run_to_tolerance
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

pytestmark = pytest.mark.usefixtures("pages")

STUDY = study_text(
    title="spectra of a Brücke",
    pulses=(
        SINE | {"name": "short", "amplitude_g": 0.5, "period_s": 0.6, "duration_s": 2.0},
        SINE | {"name": "long", "amplitude_g": 0.4, "period_s": 1.2, "duration_s": 2.0},
    ),
    cases=(RIGID, PADS | {"beta": 40, "epsilon": 0.05}),
    spectrum={"alpha": [0.1, 0.2], "two_pi_over_p_s": [2.0, 10.0], "points": 9},
)


def written(tmp_path, text=STUDY):
    return write_study(tmp_path, text)


def read(text, tmp_path):
    return read_spectrum(load_study(written(tmp_path, text)))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Results of the study above."""
    path = tmp_path_factory.mktemp("spectrum")
    assert main(["spectrum", str(written(path)), "--out", str(path / "out")]) == 0
    return path / "out"


def test_texts_of_a_study_stand_in_the_json_of_an_analysis_as_they_are(folder):
    assert '"title": "spectra of a Brücke"' in (folder / "spectrum.json").read_text(encoding="utf-8")


def test_every_point_is_the_run_of_its_pier(folder, tmp_path):
    """Four points of either base against a run of their own, to the ten digits of the table."""
    table = pd.read_csv(folder / "spectrum.csv")
    assert len(table) == 2 * 2 * 9 * 2
    study = load_study(written(tmp_path))
    motions = {motion.name: motion for motion in ground_motions(study).motions}
    bases = {"rigid": RigidBase(), "pads": YieldingBase(beta=40.0, eta=2.5, epsilon=0.05)}
    for row in table.iloc[[0, 1, 10, 35, 36, 50, 70, 71]].to_dict("records"):
        pier = Pier(row["alpha"], 2 * math.pi / row["two_pi_over_p_s"])
        outcome = run_to_tolerance(pier, bases[row["case"]], motions[row["record"]], 1e-4)
        assert row["status"] == outcome.status
        assert row["theta_max_over_alpha"] == pytest.approx(outcome.theta_max / pier.alpha, rel=1e-9)
        assert row["size_m"] == pytest.approx(pier.size, rel=1e-9)


def test_overturned_points_stay_in_the_spectrum_as_infinite(folder, capsys):
    """Small piers overturn under the long pulse: of two motions one, so the median lies between a value and ∞."""
    runs = pd.read_csv(folder / "spectrum.csv")
    suite = pd.read_csv(folder / "spectrum_suite.csv")
    assert len(suite) == 2 * 2 * 9
    fallen = runs[runs["status"] == "overturned"].groupby(["case", "alpha", "two_pi_over_p_s"]).size()
    assert 0 < len(fallen) < len(suite)
    at = suite.set_index(["case", "alpha", "two_pi_over_p_s"])
    assert (at.loc[fallen.index, "overturned"] == fallen).all()
    assert np.isinf(at.loc[fallen.index, "largest"]).all()
    assert np.isfinite(at.drop(fallen.index)["largest"]).all()
    report = (folder / "analyses.html").read_text(encoding="utf-8")
    assert "Rocking spectra and overturning" in report
    assert ("Solid: median of the motions." in report, "quantiles, where 6 motions" in report) == (
        True,
        False,
    )  # of two
    assert "∞" in report


def test_the_terminal_shows_every_median(folder, tmp_path):
    suite, lines = pd.read_csv(folder / "spectrum_suite.csv"), {}
    for first, *medians in map(str.split, shown({}, suite, read(STUDY, tmp_path)[0]).splitlines()):
        lines[first] = [*lines.get(first, []), *medians]
    for size, of_size in suite.groupby("two_pi_over_p_s"):
        assert lines[f"{size:.4g}"] == ["∞" if np.isinf(median) else f"{median:.4f}" for median in of_size["median"]]


def test_quantiles_count_overturned_and_flight_as_infinite_and_failed_not_at_all():
    rows = [("ok", 0.2), ("ok", 0.4), ("overturned", 15.0), ("failed", 9.0), ("ok", 0.3), ("ok", 0.5), ("flight", 7.0)]
    table = pd.DataFrame(rows, columns=["status", "theta_max_over_alpha"]).assign(
        case="rigid", scale=1.0, alpha=0.1, p=1.0, two_pi_over_p_s=2 * math.pi, size_m=7.0, record=[*"abcdefg"]
    )
    own = {name: name for name in "abcdefg"}
    (row,) = of_suite(table, ("alpha", "p"), own).to_dict("records")
    assert (row["count"], row["overturned"], row["failed"]) == (6, 1, 1)
    assert row["median"] == pytest.approx(0.45)  # between 0.4 and 0.5 of 0.2, 0.3, 0.4, 0.5, ∞, ∞
    assert row["p16"] == pytest.approx(0.2 + 0.8 * 0.1)
    assert math.isinf(row["p84"])
    assert math.isinf(row["largest"])
    (pair,) = of_suite(table, ("alpha", "p"), own | {"b": "a"}).to_dict("records")  # five stations, as d failed
    assert (pair["count"], pair["median"]) == (6, row["median"])
    assert np.isnan([pair["p16"], pair["p84"]]).all()
    (few,) = of_suite(table[:6], ("alpha", "p"), own).to_dict("records")
    assert (few["count"], few["median"]) == (5, pytest.approx(0.4))
    assert np.isnan(
        [few["p16"], few["p84"]]
    ).all()  # the ranks of five say too little of the 16 and 84 % of all motions


@pytest.mark.parametrize(("axis", "values"), [
    ("p = [0.5, 2.0]\nspacing = 'log'", [0.5, 1.0, 2.0]),
    ("size_m = [2, 6]", [2.0, 4.0, 6.0]),
])  # fmt: skip
def test_a_spectrum_runs_over_p_or_over_the_size_as_well(tmp_path, axis, values):
    text = STUDY.replace("two_pi_over_p_s = [2.0, 10.0]\npoints = 9", f"{axis}\npoints = 3")
    spectrum, maps = read(text, tmp_path)
    assert maps == ()
    first = [case for case in spectrum.cases if case.name == "rigid" and case.pier.alpha == 0.1]
    assert [case.columns[spectrum.axis] for case in first] == pytest.approx(values)
    found = [case.pier.p if spectrum.axis == "p" else case.pier.size for case in first]
    assert found == pytest.approx(values)
    motion = ground_motions(load_study(written(tmp_path, text))).motions[0]
    outcome = run_to_tolerance(first[1].pier, RigidBase(), motion, 1e-4)
    row = row_of(StudyRun(motion, "+", 1.0, first[1], outcome=outcome))
    assert row["two_pi_over_p_s"] * row["p"] == pytest.approx(2 * math.pi)
    assert row["size_m"] * row["p"] ** 2 == pytest.approx(0.75 * 9.81)


def test_a_base_given_in_kilonewtons_keeps_its_stiffness_on_every_pier(tmp_path):
    text = STUDY.replace("beta = 40", "stiffness_kN_m = 2.0e6\nmass_t = 3000.0")
    spectrum, _ = read(text, tmp_path)
    pads = [case for case in spectrum.cases if case.name == "pads"]
    assert len({case.base.beta for case in pads}) == 9
    assert [case.base.beta * case.pier.p for case in pads] == pytest.approx([math.sqrt(4e6 / 3000)] * len(pads))


def test_every_mistake_is_reported_with_its_line(tmp_path):
    text = STUDY.replace("alpha = [0.1, 0.2]", "alpha = [0.1, 0.01, 1.7]").replace("points = 9", "points = 1\npint = 3")
    text += '[[spectrum.map]]\nname = "a"\nshape = "sin"\nfrequency = [5, 1]\namplitude = [1, 2, 3]\ntolerance = 0\n'
    with pytest.raises(InputError) as caught:
        read(text, tmp_path)
    told = "\n".join(caught.value.messages)
    for line, words in (
        (38, "points = 1: expected a whole number, 2 or above"),
        (39, "pint: unknown key; did you mean points?"),
        (42, 'did you mean "sine"?'),
        (43, "frequency = [5, 1]: expected a range; write for example frequency = [1.0, 5.0]"),
        (44, "amplitude = [1, 2, 3]: expected a range; write for example amplitude = [1.0, 3.0]"),
        (45, "tolerance = 0: expected a number, 1e-09 or above"),
    ):
        assert any(f"study.toml:{line}: " in problem and words in problem for problem in caught.value.messages), told


def test_impossible_slendernesses_are_reported_with_the_case(tmp_path):
    with pytest.raises(InputError) as caught:
        read(STUDY.replace("alpha = [0.1, 0.2]", "alpha = [0.1, 0.01, 1.7]"), tmp_path)
    first, second = caught.value.messages
    assert "study.toml:36: " in first
    assert "alpha = 1.7: must be below" in first + second
    assert 'alpha = 0.01, case "pads": beta = 40' in first + second


def test_a_spectrum_names_the_stiffness_that_a_case_gives_and_what_it_takes(tmp_path):
    """β > √((1+μ) cos α/μ)/sin α is K > M (β p)²/2, greatest at the greatest p; with it the spectrum is read."""
    case = PADS | {"base": "elastic", "stiffness_kN_m": 1e5}
    case = {name: value for name, value in case.items() if name in ("name", "base", "stiffness_kN_m")}
    pier, wide = {"width_m": 4.0, "height_m": 20.0, "mass_t": 3000.0}, {"alpha": 0.08, "p": [0.4, 1.0], "points": 4}
    text = study_text(pier=pier, cases=(case,), spectrum=wide)
    with pytest.raises(InputError) as caught:
        read(text, tmp_path)
    (message,) = caught.value.messages
    assert (
        'alpha = 0.08, case "pads": stiffness_kN_m = 100000 with mass_t = 3000 means beta = 8.16497: the pier'
        in message
    )
    needed = 0.5 * 3000.0 * (math.sqrt(4.0 / 3.0 * math.cos(0.08)) / math.sin(0.08)) ** 2
    advised = float(message.rpartition("write stiffness_kN_m above ")[2])
    assert needed <= advised <= 1.001 * needed
    spectra, _ = read(text.replace("100000.0", f"{1.0001 * advised!r}"), tmp_path)
    assert len(spectra.cases) == 4


@pytest.mark.parametrize(("lines", "words"), [
    ("", "[spectrum] is missing"),
    ("[spectrum]\nalpha = 0.1", "it runs over one range; write two_pi_over_p_s ="),
    ("[spectrum]\np = [1, 2]\nsize_m = [1, 2]\nalpha = 0.1", "it runs over one range"),
    ("[spectrum]\np = [1, 2]", "alpha is missing"),
])  # fmt: skip
def test_missing_keys_are_reported(tmp_path, lines, words):
    with pytest.raises(InputError, match=words.replace("[", r"\[")):
        read(STUDY.split("[spectrum]")[0] + lines, tmp_path)


def test_results_of_the_study_keep_the_spectrum_in_their_report(tmp_path):
    path, out = (
        written(tmp_path, study_text(pulses=[SINE], cases=[RIGID], spectrum={"alpha": 0.2, "p": [1, 2], "points": 2})),
        tmp_path / "out",
    )
    assert main(["run", str(path), "--out", str(out)]) == 0
    assert "Rocking spectra" not in (out / "report.html").read_text(encoding="utf-8")
    assert main(["spectrum", str(path), "--out", str(out)]) == 0
    assert "Rocking spectra" in (out / "report.html").read_text(encoding="utf-8")
    assert not (out / "analyses.html").exists()
