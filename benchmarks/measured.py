"""Does a planar block overturn where two granite specimens did? 582 shake-table tests, of which one number is fitted.

    python benchmarks/measured.py FOLDER [--accelerations FILE.npz] [--splits 200] [--seed 0] [--bins FILE.csv]

FOLDER is data/Shake_Table_Response of the public repository ZhiangChen/virtual_shake_robot_pybullet (GPL-3.0; nothing of it
is in this repository): the workbooks Results_Granite.xlsx and Earthquake_Records_Info.xlsx and a Test011.txt for each test.
Reading a gigabyte of text takes minutes, so what is made of it can be kept: --accelerations is written where it is missing
(a11 [m/s²] and dt11 [s] of test 11, …) and read where it is not. Tests without an acceleration are left out, and those whose
measured PGA is not 0.9 to 1.15 of the listed one.

A Housner block (rigid base) with the specimens' mean height of the centre of mass and radius of gyration runs under every
measured table acceleration, for each α of a grid. α is fitted to one half of the tests by the share of right outcomes and
judged on the other, and the other way round, for many random halves; so are the majority, the best thresholds on PGA and PGV
and a logistic regression on ln PGA and ln PGV/PGA, and the choice among the columns of the authors' own simulations.
Halves are of tests, or of records (a record with all its tests in one half), or the first and the last days.

A run that fails predicts nothing and counts as wrong. No times; minutes. docs/pages/measured.md discusses the results.
"""

import argparse
import csv
import math
import re
import zipfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
from scipy.optimize import minimize
from scipy.signal import butter, sosfiltfilt

import rockbatch as rb

HEIGHT_M = 0.293  # of the centre of mass above the lowest point: mean of the two scanned meshes
GYRATION_M2 = 0.0565  # I/m about a horizontal axis through it: mean of both horizontal axes
GRAVITY = 9.81
ALPHAS = tuple(round(0.08 + 0.005 * i, 3) for i in range(21))
"""0.08 to 0.18 rad. The meshes tip at 0.10 to 0.13 rad on their weak side; a finer grid changes fewer outcomes than chaos."""

BAND_HZ, EVERY = (0.05, 25.0), 4  # band-pass of the 800 samples per second, of which one in four is kept
PGA_RATIO = (0.9, 1.15)  # measured over listed
SPECIMENS = (1, 2)

Predictions = np.ndarray
"""1 where a test overturns the block, 0 where not, NaN where a run failed."""


@dataclass(frozen=True)
class Tests:
    """Tests with an acceleration of the table, in the order of their numbers."""

    number: np.ndarray
    day: np.ndarray
    record: np.ndarray
    pga: np.ndarray  # measured [m/s²]
    pga_listed: np.ndarray  # [m/s²]
    pgv: np.ndarray  # [m/s]: of the listed PGV/PGA, since measured accelerations drift
    overturned: np.ndarray  # shape (tests, 2): specimens
    simulated: np.ndarray  # shape (tests, columns): the authors' own simulations
    columns: tuple[str, ...]  # their names, which begin with "Specimen 1" or "Specimen 2"
    motions: tuple[rb.Motion, ...]

    def at(self, rows: np.ndarray) -> "Tests":
        """Return some of the tests."""
        arrays = {name: value[rows] for name, value in vars(self).items() if isinstance(value, np.ndarray)}
        return Tests(**arrays, columns=self.columns, motions=tuple(self.motions[i] for i in np.flatnonzero(rows)))


def sheet(path: Path) -> Iterator[dict[str, str]]:
    """Yield the rows of a workbook's first sheet that are not empty, as texts by the letters of their columns."""
    tag = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
    with zipfile.ZipFile(path) as book:
        shared = ElementTree.fromstring(book.read("xl/sharedStrings.xml"))
        texts = ["".join(text.text or "" for text in item.iter(f"{tag}t")) for item in shared]
        rows = ElementTree.fromstring(book.read("xl/worksheets/sheet1.xml")).iter(f"{tag}row")
        for row in rows:
            cells = {}
            for cell in row:
                value = cell.find(f"{tag}v")
                if value is not None and value.text is not None:
                    letters = re.sub(r"\d", "", cell.get("r", ""))
                    cells[letters] = texts[int(value.text)] if cell.get("t") == "s" else value.text
            if cells:
                yield cells


def table_acceleration(path: Path) -> tuple[np.ndarray, float]:
    """Return the horizontal acceleration [m/s²] of the table in a test, filtered, and its sampling interval [s]."""
    time, measured = np.loadtxt(path, skiprows=1, usecols=(0, 1), unpack=True)
    dt = (time[-1] - time[0]) / (len(time) - 1)
    still = measured - np.median(measured[:400])
    band = butter(4, BAND_HZ, "bandpass", fs=1.0 / dt, output="sos")
    return GRAVITY * sosfiltfilt(band, still)[::EVERY], EVERY * dt


def accelerations(folder: Path, kept: Path | None) -> dict[int, rb.Motion]:
    """Return the motions of the table by the numbers of their tests, from ``kept`` if it is there."""
    if kept and kept.exists():
        with np.load(kept) as arrays:
            numbers = [int(name.removeprefix("dt")) for name in arrays if name.startswith("dt")]
            return {n: rb.Motion(f"test {n}", float(arrays[f"dt{n}"]), arrays[f"a{n}"]) for n in numbers}
    read = {int(path.stem.removeprefix("Test")): table_acceleration(path) for path in sorted(folder.glob("Test*.txt"))}
    if kept:
        arrays = {f"a{n}": a for n, (a, _) in read.items()} | {f"dt{n}": np.array(dt) for n, (_, dt) in read.items()}
        np.savez_compressed(kept, **arrays)
    return {n: rb.Motion(f"test {n}", dt, a) for n, (a, dt) in read.items()}


def read_tests(folder: Path, kept: Path | None = None) -> Tests:
    """Return the tests whose acceleration is there and as strong as it was meant to be."""
    head, *outcomes = sheet(folder / "Results_Granite.xlsx")
    simulations = [letter for letter, name in head.items() if "Numerical" in name]
    of_test = {int(row["A"]): row for row in outcomes}
    listed = {int(row["A"]): row for row in sheet(folder / "Earthquake_Records_Info.xlsx") if row["A"].isdigit()}
    motions = accelerations(folder, kept)
    numbers = sorted(of_test.keys() & listed.keys() & motions.keys())

    def numbers_in(rows: Mapping[int, Mapping[str, str]], letter: str) -> np.ndarray:
        return np.array([float(rows[n][letter]) for n in numbers])

    pga, pga_listed = np.array([motions[n].pga for n in numbers]), GRAVITY * numbers_in(listed, "F")
    tests = Tests(
        number=np.array(numbers), day=numbers_in(listed, "B"),
        record=np.array([listed[n]["D"].strip(" '") for n in numbers]),
        pga=pga, pga_listed=pga_listed, pgv=numbers_in(listed, "E") * pga,
        overturned=np.column_stack([numbers_in(of_test, letter) for letter in "BC"]),
        simulated=np.column_stack([numbers_in(of_test, letter) for letter in simulations]),
        columns=tuple(head[letter] for letter in simulations), motions=tuple(motions[n] for n in numbers),
    )  # fmt: skip
    ratio = pga / pga_listed
    return tests.at((ratio >= PGA_RATIO[0]) & (ratio <= PGA_RATIO[1]))


def block(alpha: float) -> dict[str, float]:
    """Return the keys of [pier] of a block of the specimens' height and inertia."""
    size = HEIGHT_M / math.cos(alpha)
    return {"alpha": alpha, "size_m": size, "mu": size**2 / GYRATION_M2}


def predictions(motions: Sequence[rb.Motion], alpha: float, **case: Any) -> Predictions:
    """Return which motions overturn a block; ``case`` are keys of its case, on the rigid base unless it names another."""
    one = {"name": "block", "base": "rigid", **case}
    study = rb.Study.from_dict({"pier": block(alpha), "case": [one]}, motions=list(motions))
    status = rb.run(study, jobs=1, progress=False)["status"].to_numpy()
    return np.where(status == "failed", np.nan, status == "overturned")


def share_right(predicted: Predictions, observed: np.ndarray) -> float:
    return float((predicted == observed).mean())


# Methods: each fits to some tests and returns what it predicts of all


@dataclass(frozen=True)
class Fitted:
    """What a method predicts of every test, and the number that it has fitted (NaN if that is not one number)."""

    predicted: Predictions
    value: float = math.nan


Method = Callable[[np.ndarray, np.ndarray], Fitted]
"""Of the outcomes of all tests, and which of them it may see."""


def best_column(columns: np.ndarray, values: Sequence[float], observed: np.ndarray, seen: np.ndarray) -> Fitted:
    """Choose among columns of predictions by the share right; of equally good ones the middle."""
    right = (columns[seen] == observed[seen, None]).mean(axis=0)
    best = np.flatnonzero(right == right.max())
    chosen = best[(len(best) - 1) // 2]
    return Fitted(columns[:, chosen], values[chosen])


def majority(observed: np.ndarray, seen: np.ndarray) -> Fitted:
    return Fitted(np.full(len(observed), float(observed[seen].mean() > 0.5)))


def threshold(measure: np.ndarray, observed: np.ndarray, seen: np.ndarray) -> Fitted:
    """Fit the value of an intensity measure above which tests overturn."""
    values = np.sort(measure[seen])
    between = np.sqrt(values[1:] * values[:-1])
    return best_column((measure[:, None] > between).astype(float), between, observed, seen)


def logistic(measures: np.ndarray, observed: np.ndarray, seen: np.ndarray) -> Fitted:
    """Fit a logistic regression by its likelihood."""
    design = np.column_stack([np.ones(len(measures)), measures])
    signs = 2.0 * observed[seen] - 1.0

    def loss(weights: np.ndarray) -> float:
        # The ridge, far below any information in the data, keeps weights finite if the tests can be separated.
        return float(np.logaddexp(0.0, -signs * (design[seen] @ weights)).sum() + 1e-6 * weights @ weights)

    return Fitted((design @ minimize(loss, np.zeros(design.shape[1])).x > 0.0).astype(float))


def methods(tests: Tests, by_alpha: Mapping[float, Predictions], specimen: int) -> dict[str, Method]:
    """Return the block and what it is compared with, for a specimen."""
    own = [i for i, name in enumerate(tests.columns) if name.startswith(f"Specimen {specimen}")]
    measures = np.column_stack([np.log(tests.pga), np.log(tests.pgv / tests.pga)])
    spread = measures.std(axis=0)
    spread[spread < 1e-9] = 1.0  # the same in all tests
    return {
        "block, α": partial(best_column, np.column_stack(list(by_alpha.values())), list(by_alpha)),
        "majority": majority,
        "threshold on PGA": partial(threshold, tests.pga),
        "threshold on PGV": partial(threshold, tests.pgv),
        "logistic regression": partial(logistic, (measures - measures.mean(axis=0)) / spread),
        "authors' simulations": partial(best_column, tests.simulated[:, own], [float(i) for i in own]),
    }


# Halves


def random_halves(keys: np.ndarray, splits: int, seed: int) -> Iterator[np.ndarray]:
    """Yield halves of the tests in which those with the same key stay together, each followed by the other half."""
    rng = np.random.default_rng(seed)
    for _ in range(splits):
        half, order = np.zeros(len(keys), bool), rng.permutation(np.unique(keys))
        for key in order:
            if 2 * half.sum() >= len(keys):
                break
            half |= keys == key
        yield from (half, ~half)


def days(tests: Tests) -> Iterator[np.ndarray]:
    """Yield the first days with half of the tests, and the last."""
    first = tests.day <= np.median(tests.day)
    yield from (first, ~first)


@dataclass(frozen=True)
class Judged:
    """A method on halves that it has not seen."""

    right: np.ndarray  # shares, one for each half
    values: np.ndarray  # what it fitted to the other half

    def interval(self) -> str:
        low, high = np.percentile(self.right, [2.5, 97.5])
        return f"{self.right.mean():.3f} ({low:.3f} to {high:.3f})"


def judge(method: Method, observed: np.ndarray, halves: Sequence[np.ndarray]) -> Judged:
    """Fit to each half and judge on the rest."""
    fitted = [(method(observed, half), ~half) for half in halves]
    right = [share_right(fit.predicted[rest], observed[rest]) for fit, rest in fitted]
    return Judged(np.array(right), np.array([fit.value for fit, _ in fitted]))


# Tables


def markdown(head: Sequence[str], rows: Sequence[Sequence[object]]) -> list[str]:
    return [f"| {' | '.join(str(cell) for cell in row)} |" for row in (head, ["---"] * len(head), *rows)] + [""]


def counted(predicted: Predictions, observed: np.ndarray) -> str:
    """Return TP TN FP FN, and how many runs failed if any did."""
    pairs = [(1, 1), (0, 0), (1, 0), (0, 1)]
    counts = [int(((predicted == p) & (observed == o)).sum()) for p, o in pairs]
    failed = int(np.isnan(predicted).sum())
    return " ".join(map(str, counts)) + (f" ({failed} failed)" if failed else "")


def in_sample(tests: Tests, by_alpha: Mapping[float, Predictions]) -> list[str]:
    """Return the table of every α on all tests."""
    rows = []
    for alpha, predicted in by_alpha.items():
        row: list[object] = [f"{alpha:.3f}", int(np.nansum(predicted))]
        for observed in tests.overturned.T:
            row += [counted(predicted, observed), f"{share_right(predicted, observed):.3f}"]
        rows.append(row)
    return markdown(["α", "overturned", "1: TP TN FP FN", "right", "2: TP TN FP FN", "right"], rows)


def out_of_sample(tests: Tests, by_alpha: Mapping[float, Predictions], splits: int, seed: int) -> list[str]:
    """Return a table of every method on halves that it has not seen, with the central 95 % over the halves."""
    halves = {
        "tests": list(random_halves(tests.number, splits, seed)),
        "records": list(random_halves(tests.record, splits, seed)),
        "days": list(days(tests)),
    }
    rows, fitted = [], []
    for specimen, observed in zip(SPECIMENS, tests.overturned.T, strict=True):
        everything = np.ones(len(observed), bool)
        block_right = None
        for name, method in methods(tests, by_alpha, specimen).items():
            judged = {kind: judge(method, observed, of_kind) for kind, of_kind in halves.items()}
            if block_right is None:  # the block is the first
                block_right = judged["records"].right
                low, middle, high = np.percentile(judged["records"].values, [2.5, 50, 97.5])
                fitted.append(f"Specimen {specimen}: α of halves of records {middle:.3f} ({low:.3f} to {high:.3f}).")
            better = block_right - judged["records"].right
            low, high = np.percentile(better, [2.5, 97.5])
            first, last = judged["days"].right
            rows.append(
                [
                    specimen, name, f"{share_right(method(observed, everything).predicted, observed):.3f}",
                    judged["tests"].interval(), judged["records"].interval(), f"{first:.3f}, {last:.3f}",
                    f"{better.mean():+.3f} ({low:+.3f} to {high:+.3f})" if better.any() else "",
                ]
            )  # fmt: skip
    head = [
        "specimen", "method", "all tests, in sample", "halves of tests", "halves of records",
        "first on last days, last on first", "block better by, records",
    ]  # fmt: skip
    return [*markdown(head, rows), *fitted, ""]


def unseen(tests: Tests, method: Method, observed: np.ndarray, splits: int, seed: int) -> np.ndarray:
    """Return how often each test is predicted to overturn by fits to halves of records without it."""
    total, count = np.zeros(len(observed)), np.zeros(len(observed))
    for half in random_halves(tests.record, splits, seed):
        predicted = method(observed, half).predicted
        known = ~half & ~np.isnan(predicted)
        total[known] += predicted[known]
        count[known] += 1
    return total / np.maximum(count, 1)


def wilson(successes: float, n: int) -> tuple[float, float]:
    """Return the 95 % interval of a share by Wilson's score."""
    z, share = 1.959964, successes / n
    centre, half = share + z * z / (2 * n), z * math.sqrt(share * (1 - share) / n + z * z / (4 * n * n))
    return max(0.0, centre - half) / (1 + z * z / n), min(1.0, (centre + half) / (1 + z * z / n))


def over_intensity(
    tests: Tests, by_alpha: Mapping[float, Predictions], splits: int, seed: int, bins: int = 8
) -> list[dict[str, Any]]:
    """Return observed and predicted shares in bins of equally many tests, by PGV and by PGA."""
    rows = []
    for specimen, observed in zip(SPECIMENS, tests.overturned.T, strict=True):
        predicted = unseen(tests, methods(tests, by_alpha, specimen)["block, α"], observed, splits, seed)
        for name, measure in (("pgv_m_s", tests.pgv), ("pga_g", tests.pga / GRAVITY)):
            for part in np.array_split(np.argsort(measure, kind="stable"), bins):
                low, high = wilson(observed[part].sum(), len(part))
                rows.append(
                    {
                        "specimen": specimen, "measure": name, "from": measure[part].min(), "to": measure[part].max(),
                        "tests": len(part), "observed": observed[part].mean(), "low": low, "high": high,
                        "block": predicted[part].mean(),
                    }
                )  # fmt: skip
    return rows


def binned(rows: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return the table of what ``over_intensity`` found."""
    cells = [
        [
            row["specimen"], row["measure"], f"{row['from']:.3f} to {row['to']:.3f}", row["tests"],
            f"{row['observed']:.2f} ({row['low']:.2f} to {row['high']:.2f})", f"{row['block']:.2f}",
        ]
        for row in rows
    ]  # fmt: skip
    return markdown(["specimen", "measure", "bin", "tests", "observed", "block, unseen"], cells)


def variants(alpha: float) -> dict[str, dict[str, Any]]:
    """Return what else could be under the block, as keys of its case."""
    keys = block(alpha)
    pier = rb.Pier.from_size(alpha, keys["size_m"], keys["mu"])
    springs = {"base": "elastic", "kinematics": "finite"}
    return {
        **{
            f"e = {factor:g} of Housner's": {"restitution": factor * pier.restitution}
            for factor in (0.67, 0.8, 0.9, 0.95)
        },
        "e halfway to 1": {"restitution": 0.5 * (1.0 + pier.restitution)},
        **{
            f"springs, β = {beta:g}, ζ = {zeta:g}": springs | {"beta": beta, "zeta": zeta}
            for beta in (20.0, 50.0)
            for zeta in (0.05, 0.3)
        },
    }


def sensitivity(tests: Tests, by_alpha: Mapping[float, Predictions], alphas: Sequence[float]) -> list[str]:
    """Return a table of other landings, bases and motions: what changes at the middle α, and shares right with α fitted again."""
    middle = alphas[len(alphas) // 2]
    stronger = [motion.scaled(1.01) for motion in tests.motions]
    results = {"rigid, Housner's e": {alpha: by_alpha[alpha] for alpha in alphas}}
    results["the same, motions 1 % stronger"] = {alpha: predictions(stronger, alpha) for alpha in alphas}
    for name in variants(middle):
        results[name] = {alpha: predictions(tests.motions, alpha, **variants(alpha)[name]) for alpha in alphas}
    rows = []
    for name, of_name in results.items():
        here = of_name[middle]
        changed = np.nan_to_num(here, nan=-1.0) != np.nan_to_num(by_alpha[middle], nan=-1.0)
        row: list[object] = [name, int(np.nansum(here)), int(changed.sum()), int(np.isnan(here).sum())]
        for observed in tests.overturned.T:
            right = {alpha: share_right(predicted, observed) for alpha, predicted in of_name.items()}
            best = max(right, key=lambda alpha: right[alpha])
            row += [f"{right[middle]:.3f}", f"{right[best]:.3f} at {best:g}"]
        rows.append(row)
    head = [
        "base",
        f"overturned at {middle:g}",
        "otherwise",
        "failed",
        "1: right there",
        "1: best",
        "2: right there",
        "2: best",
    ]
    return markdown(head, rows)


def repeatability(tests: Tests, near: float = 1.03) -> list[str]:
    """Return how far tests agree among themselves: specimens under one motion, and a record at one strength, or at two."""
    one, two = tests.overturned.T
    repeated = contrary = 0
    differing, inverted = np.zeros(2, int), np.zeros(2, int)
    for record in np.unique(tests.record):
        rows = np.flatnonzero(tests.record == record)
        rows = rows[np.argsort(tests.pga[rows])]
        for k, weak in enumerate(rows):
            for strong in rows[k + 1 :]:
                same = tests.pga[strong] <= near * tests.pga[weak]
                repeated += same
                contrary += not same
                differing += same * (tests.overturned[weak] != tests.overturned[strong])
                inverted += (not same) * (tests.overturned[weak] > tests.overturned[strong])
    only = [int((a > b).sum()) for a, b in ((one, two), (two, one))]
    return [
        f"The specimens end alike in {(one == two).mean():.3f} of the tests; 1 alone overturns in {only[0]}, 2 in {only[1]}.",
        f"{repeated} pairs of one record with PGA within {near - 1:.0%}: {differing[0]} and {differing[1]} end differently.",
        f"{contrary} pairs of one record with PGA further apart: the weaker alone overturns in {inverted[0]} and {inverted[1]}.",
        "",
    ]


def main(
    folder: Path, kept: Path | None = None, splits: int = 200, seed: int = 0, bins: Path | None = None
) -> Iterator[str]:
    """Yield the lines of all tables."""
    tests = read_tests(folder, kept)
    overturned = " and ".join(f"{count:.0f}" for count in tests.overturned.sum(axis=0))
    yield f"{len(tests.number)} tests of {len(np.unique(tests.record))} records, {overturned} overturned\n"
    yield from repeatability(tests)
    by_alpha = {alpha: predictions(tests.motions, alpha) for alpha in ALPHAS}
    yield from in_sample(tests, by_alpha)
    yield from out_of_sample(tests, by_alpha, splits, seed)
    rows = over_intensity(tests, by_alpha, splits, seed)
    yield from binned(rows)
    if bins:
        with open(bins, "w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in row.items()} for row in rows)
    yield from sensitivity(tests, by_alpha, ALPHAS[4:9:2])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument(
        "--accelerations", type=Path, help="keep what is made of the tests' texts here, and read it again"
    )
    parser.add_argument("--splits", type=int, default=200, help="random divisions into halves")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--bins", type=Path, help="write shares over intensity to this file")
    arguments = parser.parse_args()
    for line in main(arguments.folder, arguments.accelerations, arguments.splits, arguments.seed, arguments.bins):
        print(line, flush=True)
