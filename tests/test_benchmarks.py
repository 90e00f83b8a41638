"""The benchmarks run, and measure what they say. Times are never asserted."""

import importlib
import re
from importlib.util import find_spec
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest

from rockbatch.motions import Motion, pulse
from rockbatch.pier import Pier, YieldingBase
from rockbatch.simulation import run_to_tolerance

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"


@pytest.fixture
def benchmark(monkeypatch):
    """Imports a module of the benchmarks as a script beside them does."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    return importlib.import_module


def cells(lines):
    """Rows of the tables among ``lines``, without their heads."""
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]
    return [row for row, below in zip(rows, [*rows[1:], [""]], strict=True) if "---" not in row + below]


def test_tasks_are_repeated_in_turn(benchmark):
    module = benchmark("interleaved")
    order = []
    times = module.interleaved({"a": lambda: order.append("a"), "b": lambda: order.append("b")}, repeats=2)
    assert order == ["a", "b"] * 3  # the first call of each compiles
    assert len(times["a"]) == len(times["b"]) == 2


def test_a_ratio_is_of_the_best_times_and_the_median_of_each_repeat(benchmark):
    assert benchmark("interleaved").ratio([2.0, 8.0, 9.0], [1.0, 2.0, 3.0], scale=0.5) == "1 | 1.5"


@pytest.mark.thorough
def test_every_solver_is_as_accurate_as_asked(benchmark):
    module = benchmark("solvers")
    rows = cells(module.main(repeats=1, side_by_side=4, seconds=3.0))
    assert rows[0][0] == module.UNIT
    assert rows[0][4:] == ["1", "1"]
    assert len(rows) == 8
    absent = [row for row in rows if row[1] == "not installed"]
    assert len(absent) == 2 * (find_spec("sksundae") is None) + (find_spec("heyoka") is None)
    for row in rows:
        if row not in absent:
            assert float(row[3]) <= module.ACCURACY


@pytest.mark.thorough
def test_loops_of_spring_laws_are_closed_but_for_bouc_wen(benchmark):
    """A cycle of ±30 % about the weight, over δ_s: ∫ zⁿ/(1 − zⁿ) dz for Bouc–Wen (test_ratchet), nothing for the others."""
    module = benchmark("spring_laws")
    z = np.linspace(0.7 / 2.5, 1.3 / 2.5, 2001)
    expected = 2.5 * np.trapezoid(z**5 / (1.0 - z**5), z)
    assert [module.per_cycle(law) for law in range(4)] == [pytest.approx(expected, rel=1e-3)] + 3 * [
        pytest.approx(0.0, abs=1e-9)
    ]


@pytest.mark.thorough
@pytest.mark.parametrize("law", ["bouc-wen", "epp", "hardening"])
def test_settlements_agree_with_a_solver_that_knows_other_laws_too(benchmark, law):
    """A one-sine and vertical vibration; the other solver is of first order, with steps of 20 µs."""
    module = benchmark("spring_laws")
    t = np.arange(0.0, 6.0, 0.01)
    horizontal, vertical = 2.5 * np.sin(2 * np.pi * t) * (t < 1.0), 3.0 * np.sin(8 * np.pi * t) * (t > 2.0)
    base = YieldingBase.from_stiffness(module.PIER, **module.PADS, spring=law)
    here = run_to_tolerance(module.PIER, base, Motion("shaken", 0.01, horizontal, vertical), 1e-4)
    ground = [np.append(a, np.zeros(200)) for a in (horizontal, vertical)]
    settlement, theta = module.settled(module.model(base, module.LAWS.index(law)), *ground, 0.01, 500)
    assert settlement == pytest.approx(here.settlement, rel=2e-3)
    assert theta == pytest.approx(here.theta_max, rel=2e-3)


def test_errors_are_held_against_the_reported_ones_with_dampers_too(benchmark):
    module = benchmark("error_estimates")
    motion = pulse("sine", name="sine", amplitude=4.0, period=0.8, dt=0.01, duration=4.0)
    rows = [module.verify(name, base, motion, 1e-4) for name, base in [*module.TIED.items()][:2]]
    assert all(row["settled"] and 0.0 < row["theta_max_true"] <= row["theta_max_reported"] for row in rows)
    everything = [row for row in cells(module.summary(rows)) if row[0] == "all"]
    assert [row[:4] for row in everything] == [
        ["all", "2", of, "2 of 2 (100.00%)"] for of in ("theta_max", "theta_res")
    ]


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize(
    ("package", "solver", "tolerance", "error"),
    [
        ("scipy", lambda peers, rocking: peers.scipy(rocking, 1e-10, "DOP853"), 1e-8, 1e-7),
        ("scipy", lambda peers, rocking: peers.scipy(rocking, 1e-10, "LSODA"), 1e-8, 1e-7),
        ("sksundae", lambda peers, rocking: peers.cvode(rocking, 1e-10, "Adams"), 1e-8, 1e-7),
        ("sksundae", lambda peers, rocking: peers.cvode(rocking, 1e-10, "BDF"), 1e-8, 1e-7),
        ("heyoka", lambda peers, rocking: peers.heyoka(rocking, 1e-12), 1e-10, 1e-9),
    ],
    ids=["SciPy DOP853", "SciPy LSODA", "CVODE Adams", "CVODE BDF", "heyoka"],
)
def test_another_solver_finds_the_same_peak(benchmark, package, solver, tolerance, error):
    """Within what both claim: ``tolerance`` of rockbatch, and ``error`` for what the solver gathers over the run."""
    pytest.importorskip(package)
    peers = benchmark("peers")
    pier, base = Pier(0.15, 1.0), YieldingBase(30.0, 0.05, eta=2.5)
    motion = pulse("ricker", name="ricker", amplitude=0.6 * 9.81, period=1.0, dt=0.02, duration=4.0)
    outcome = run_to_tolerance(pier, base, motion, tolerance)
    status, theta_max = solver(peers, peers.Rocking(pier, base, motion))()
    assert status == outcome.status == "ok"
    assert outcome.impacts > 0
    assert theta_max == pytest.approx(outcome.theta_max, rel=0, abs=(tolerance + error) * pier.alpha)


@pytest.mark.thorough
def test_the_bare_step_is_compared_for_every_law_step_and_component(benchmark):
    lines = benchmark("bare_step").main(repeats=1, runs=2, seconds=3.0)
    assert lines[0].startswith("vector instructions of ")
    rows = cells(lines)
    laws, devices = rows[: (4 + 1) * 2 * 3], rows[(4 + 1) * 2 * 3 :]
    assert len({tuple(row[:3]) for row in laws}) == (4 + 1) * 2 * 3
    assert all(float(row[3]) > 0 for row in laws)
    assert any(float(row[5]) > 0 for row in laws)  # events per step: something happens within 3 s
    (waits,) = (line for line in lines if "that wait after" in line)
    (footings,) = (line for line in lines if "on a footing of 40 strips" in line)
    assert all(float(re.search(r"best ([\d.]+)", line)[1]) > 0 for line in (waits, footings))
    assert {tuple(row[:2]) for row in devices} == {(base, steps) for base in ("rigid", "bouc-wen") for steps in "124"}
    assert all(float(row[2]) > 0 for row in devices)


@pytest.mark.parametrize(
    ("base", "cause"),
    [
        ("rigid", "changed: it magnifies errors of steps"),
        ("springs", "further: residuals, lesser extremes or the time of the peak"),
    ],
)
def test_steps_to_the_tolerance_are_counted_by_cause(benchmark, base, cause):
    """A halved run has twice the steps of the first; further ones have four times as many, and runs under changed motions two."""
    rows = {row[1]: row for row in cells(benchmark("halvings").main(size=3, base=base))}
    assert rows["first"][2:] == ["100.0", "1.000"]
    assert rows["halved"][2:] == ["100.0", "2.000"]
    causes = [row for cause, row in rows.items() if cause not in ("first", "halved", "all")]
    assert cause in rows
    assert float(rows["all"][3]) == pytest.approx(3.0 + sum(float(row[3]) for row in causes), abs=0.01)


def test_scaling_has_its_four_tables(benchmark):
    module = benchmark("scaling")
    lines = module.main(repeats=1, most_runs=64, runs=2, seconds=4.0)
    assert sum(line.startswith("| ---") for line in lines) == 4
    assert all(float(row[1]) > 0 for row in cells(lines))


def test_the_small_pier_of_the_mixed_runs_overturns_early_and_the_tower_does_not(benchmark):
    module = benchmark("scaling")
    motion = module.record()
    assert set(module.one_group(module.many(4, motion, module.SMALL))) == {"overturned"}
    assert set(module.one_group(module.many(4, motion))) == {"ok"}


@pytest.mark.thorough  # compiles its reference
def test_a_survey_of_the_rigid_base_has_no_wrong_outcome(benchmark):
    survey = benchmark("rigid_survey")
    rows = list(survey.survey(survey.cases(100, seed=1)))
    assert len(rows) >= 100
    counts = survey.counts(rows)
    assert counts["wrong outcome"] == counts["beyond tolerance, unmarked"] == 0
    assert counts["with flights"] > 0
    assert counts["overturned"] > 0
    assert cells(survey.table(rows))[-1][:2] == ["all", str(len(rows))]


def test_tables_that_differ_in_a_byte_or_are_missing_are_named(benchmark, monkeypatch):
    module = benchmark("same_rows")
    tables = {
        "before": {"peaks.csv": b"1.0", "spectrum.csv": b"2", "lost.csv": b""},
        "after": {"peaks.csv": b"1.0", "spectrum.csv": b"2.0", "added.csv": b""},
    }
    monkeypatch.setattr(module, "tables_of", lambda tree, study, out: tables[tree.name])
    before, after = Path("before"), Path("after")
    assert list(module.differences(before, after, ["a"])) == [
        "a: 3 tables, of which differ: spectrum.csv, lost.csv, added.csv"
    ]
    assert list(module.differences(before, before, ["a"])) == ["a: 3 tables, all the same"]
    assert [command[0] for command in module.commands(BENCHMARKS.parent / "configs" / "release.toml")] == ["run"]


@pytest.mark.thorough
@pytest.mark.slow
def test_a_study_has_the_tables_of_the_last_revision(benchmark):
    """This tree against its last commit, which in a clean clone is the same."""
    assert benchmark("same_rows").main("HEAD", ["fig6"]) == 0


def workbook(path, rows):
    """Write a workbook as spreadsheets do: shared texts, numbers in their cells, and an empty row."""
    texts = sorted({cell for row in rows for cell in row if isinstance(cell, str)})
    lines = [
        "".join(
            f'<c r="{chr(65 + i)}{n}" t="s"><v>{texts.index(cell)}</v></c>'
            if isinstance(cell, str)
            else f'<c r="{chr(65 + i)}{n}"><v>{cell}</v></c>'
            for i, cell in enumerate(row)
        )
        for n, row in enumerate(rows, 1)
    ]
    space = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    with ZipFile(path, "w") as book:
        shared = "".join(f"<si><t>{text}</t></si>" for text in texts)
        book.writestr("xl/sharedStrings.xml", f"<sst {space}>{shared}</sst>")
        data = "".join(f"<row>{line}</row>" for line in ["", *lines])
        book.writestr("xl/worksheets/sheet1.xml", f"<worksheet {space}><sheetData>{data}</sheetData></worksheet>")


@pytest.fixture
def measured_folder(tmp_path):
    """Seven tests in their authors' form: one-sines of 1 Hz; the weak cannot lift a block, the strong overturn it."""
    strengths = {11: 0.05, 12: 0.06, 13: 0.07, 14: 0.60, 15: 0.65, 16: 0.70, 17: 0.70}
    outcomes = {test: int(strength > 0.3) for test, strength in strengths.items()}
    head = [
        "Test Number",
        "Response-Specimen 1",
        "Response-Specimen 2",
        "Specimen 1-Numerical A",
        "Specimen 2-Numerical B",
    ]
    rows = [[test, over, 0, over, 1] for test, over in outcomes.items()]
    workbook(tmp_path / "Results_Granite.xlsx", [head, *rows, [18, 1, 1, 1, 1]])  # 18 has no acceleration
    time = np.arange(0.0, 8.0, 1 / 800)
    shape = np.where((time > 3.0) & (time < 4.0), np.sin(2 * np.pi * (time - 3.0)), 0.0)
    listed = []
    for test, strength in strengths.items():
        made = np.column_stack([time, 0.02 + strength * shape, time, 0.0 * time])  # an offset, which is taken off
        np.savetxt(tmp_path / f"Test{test:03}.txt", made, fmt="%.6g", delimiter="\t", header="Time [s]", comments="")
        stated = strength * (2.0 if test == 17 else 1.0)  # 17 is half as strong as it was meant to be
        listed.append([test, 20210621 + test % 2, "Earthquake", f"'R{test % 3}.xlsx'", 0.1, stated])
    workbook(
        tmp_path / "Earthquake_Records_Info.xlsx", [["Test No. ", "Date"], *listed, [18, 20210621, "", "", 0.1, 0.5]]
    )
    return tmp_path


def test_measured_tests_are_read_as_their_authors_publish_them(benchmark, measured_folder):
    module = benchmark("measured")
    kept = measured_folder / "kept.npz"
    tests = module.read_tests(measured_folder, kept)
    assert tests.number.tolist() == [11, 12, 13, 14, 15, 16]
    assert tests.overturned.sum(axis=0).tolist() == [3, 0]
    assert tests.record.tolist() == ["R2.xlsx", "R0.xlsx", "R1.xlsx"] * 2
    assert tests.motions[0].dt == pytest.approx(0.005)
    assert tests.pga / 9.81 == pytest.approx([0.05, 0.06, 0.07, 0.6, 0.65, 0.7], rel=0.05)
    again = module.read_tests(measured_folder, kept)
    assert all(a == b for a, b in zip(tests.motions, again.motions, strict=True))


def test_the_block_overturns_where_made_up_specimens_did(benchmark, measured_folder, monkeypatch):
    """Below g tan α it cannot; a one-sine six times as strong overturns so small a block. Only specimen 1 did so, too."""
    module = benchmark("measured")
    monkeypatch.setattr(module, "ALPHAS", (0.10, 0.11, 0.12))
    tests = module.read_tests(measured_folder)
    by_alpha = {alpha: module.predictions(tests.motions, alpha) for alpha in module.ALPHAS}
    rows = cells(module.in_sample(tests, by_alpha))
    assert [row[1:] for row in rows] == [["3", "3 3 0 0", "1.000", "0 3 3 0", "0.500"]] * 3
    table = cells(module.out_of_sample(tests, by_alpha, 4, 0))
    assert [row[2] for row in table if row[1] == "authors' simulations"] == ["1.000", "0.000"]
    assert table[0][:3] == ["1", "block, α", "1.000"]
    assert table[0][4] == "1.000 (1.000 to 1.000)"
    shares = module.over_intensity(tests, by_alpha, 4, 0, bins=2)
    assert [(row["observed"], row["block"]) for row in shares if row["specimen"] == 1] == [(0.0, 0.0), (1.0, 1.0)] * 2


def test_methods_see_one_half_only_and_records_stay_whole(benchmark):
    module = benchmark("measured")
    observed = np.array([0.0, 0.0, 1.0, 1.0, 1.0, 0.0])
    seen = np.array([True, True, True, True, False, False])
    strength = np.array([1.0, 2.0, 8.0, 9.0, 7.0, 3.0])
    assert module.threshold(strength, observed, seen).value == pytest.approx(4.0)  # between 2 and 8
    turned = np.where(seen, observed, 1.0 - observed)
    for method in (
        module.majority,
        lambda *of: module.threshold(strength, *of),
        lambda *of: module.logistic(strength[:, None], *of),
    ):
        assert (method(observed, seen).predicted == method(turned, seen).predicted).all()
    records = np.array(["a", "a", "a", "b", "c", "c", "d", "e"])
    for half in module.random_halves(records, 20, 0):
        assert all(len(set(half[records == record])) == 1 for record in "abcde")


def test_a_failed_run_counts_as_wrong(benchmark):
    module = benchmark("measured")
    predicted, observed = np.array([1.0, 0.0, np.nan, np.nan]), np.array([1.0, 0.0, 1.0, 0.0])
    assert module.share_right(predicted, observed) == 0.5
    assert module.counted(predicted, observed) == "1 1 0 0 (2 failed)"


def test_troubles_count_what_was_tried_and_what_ended_badly(benchmark, capsys):
    module = benchmark("troubles")
    printed = "journal: 20 damaged, 1 ended badly\n    19  words\njournal, seed 51, number 3\nstudy: 10 damaged, 0 ended badly\n"
    assert module.of_damage(printed) == [("damaged journals", 20, 1), ("damaged studies", 10, 0)]
    files = benchmark("broken_files")
    for name in ("PEER AT2", "DYNA (ESM, ITACA, AFAD)", "motions.csv", "motions.toml", "folders that change"):
        files.tell(name, lambda: files.fuzz.Counts(good=1000, refused=2345, slowest=0.0123))
    assert module.of_broken_files(capsys.readouterr().out) == [
        ("damaged records of 2 formats", 6690, 0),
        ("damaged manifests", 6690, 0),
        ("folders of records that change while they are read", 3345, 0),
    ]
    printed = (
        "| command | duration [s] | files | kills | failed |\n| - | - | - | - | - |\n| run | 1.5 | 8, 4 | 5, 4 | 0 |\n"
    )
    printed += "| sheet | 2.5 | 9, 4 | 5, 5 | 2 |\n"
    assert module.of_kills(printed) == [("kills of 2 commands at random instants", 9, 2)]


@pytest.mark.parametrize(("ended", "row"), [("PEER AT2", 0), ("motions.toml", 1), ("folders that change", 2)])
def test_the_kind_of_file_at_which_the_reading_ended_counts_as_one_that_ended_badly(benchmark, capsys, ended, row):
    files = benchmark("broken_files")

    def read(name):
        if name == ended:
            raise AssertionError(name)
        return files.fuzz.Counts(good=10, refused=5, slowest=0.1)

    names = ["DYNA", "PEER AT2", "motions.csv", "motions.toml", "folders that change"]
    for name in names[: names.index(ended)]:
        files.tell(name, read, name)
    with pytest.raises(AssertionError):
        files.tell(ended, read, ended)
    rows = benchmark("troubles").of_broken_files(capsys.readouterr().out)
    assert [badly for *_, badly in rows] == [int(place == row) for place in range(3)]
    assert rows[0].trouble == "damaged records of 2 formats"
