"""Damaged studies, journals, folders of results, tables of analyses and rules: each ends in words or in what is right, soon.

    python benchmarks/damage.py --studies 5000 --journals 2000 --folders 2000 --analyses 1000 --rules 2000 --seed 1

Whatever ends in anything but an ``InputError``, takes more than SECONDS of processor time or more than MEGABYTES, gives a
row that the undamaged file does not have, or a page with an element that the undamaged one does not have, is a failure: it is
printed with its seed, and the exit code is 1. Of analyses, most are damaged by somebody who writes fitting checksums beside.
"""

import argparse
import contextlib
import csv
import faulthandler
import hashlib
import io
import json
import re
import shutil
import signal
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np

import rockbatch as rb
from rockbatch.batch.digests import study_digests
from rockbatch.batch.journal import Journal
from rockbatch.batch.plan import Plan
from rockbatch.batch.preparing import cost_of_finished
from rockbatch.commands.cli import main
from rockbatch.common.errors import EditedTable
from rockbatch.reporting.finished_analysis import digest_of
from rockbatch.results.columns import JOURNAL, columns
from rockbatch.results.histories_file import seal
from rockbatch.simulation import first_substeps, steps_of
from rockbatch.study import Study
from rockbatch.study.suite import ground_motions

SECONDS, MEGABYTES = 10, 1500
MOST_STEPS = 2e6
"""Of all runs of a damaged study, without a halving, for it to be run."""

AT_ONCE = 100

STUDY = """
title = "Damaged"
notes = "Two piers."
[pier]
alpha = [0.2, 0.25]
p = 1.0
mass_t = 3000.0
[motions]
polarity = ["+", "-"]
scale = [0.5, 1.0]
[[motions.pulse]]
name = "sine"
shape = "sine"
amplitude_g = 0.6
period_s = 0.5
dt_s = 0.01
duration_s = 1.0
[numerics]
tolerance = 1e-3
quiet_s = 1.0
[[case]]
name = "rigid"
base = "rigid"
[[case]]
name = "pads, \\"soft\\""
base = "yielding"
beta = [50, 60]
eta = 2.5
epsilon = 0.05
spring = "epp"
[[reference]]
record = "sine"
case = "rigid"
theta_max_over_alpha = 0.2
source = "nobody"
[[check]]
name = "no overturning"
demand = "theta_max_over_alpha"
at_most = 0.5
reason = "a test"
[fragility]
measure = "PGA"
levels_g = [0.2, 0.4, 0.8]
[spectrum]
alpha = [0.15, 0.2]
size_m = [2, 20]
points = 3
[[spectrum.map]]
name = "one-sine"
shape = "sine"
frequency = [1.0, 2.0]
frequencies = 2
amplitude = [1.0, 3.0]
amplitudes = 2
tolerance = 0.2
width = 1.0
[sensitivity]
samples = 4
[sensitivity.uniform]
alpha = [0.18, 0.28]
mu = [2.5, 3.5]
[output]
both_laws = false
histories = "worst"
"""

RULES = """
title = "Limits"
[suite]
count = "component"
[[check]]
name = "rotation"
demand = "theta_max_over_alpha"
statistic = "mean"
at_most = 0.5
reason = "agreed"
[[check]]
name = "pads"
demand = "settlement_m"
case = "pads*"
scale = 1.0
at_most = 0.01
reason = "bearings"
[[check]]
name = "impacts"
demand = "impacts"
at_most = 20
reason = "a test"
"""

Rng = np.random.Generator
Task = Callable[[Rng], str]
"""Damages something and says what it came to."""


class TookTooLongError(BaseException):
    """Nothing that is tested catches it."""


class WrongError(AssertionError):
    """A damaged file that was believed."""


# Damage to bytes and to values


def flipped(data: bytes, rng: Rng) -> bytes:
    out = bytearray(data)
    for _ in range(int(rng.integers(1, 4))):
        if out:
            out[int(rng.integers(len(out)))] ^= 1 << int(rng.integers(8))
    return bytes(out)


def cut(data: bytes, rng: Rng) -> bytes:
    return data[: int(rng.integers(len(data) + 1))]


def hole(data: bytes, rng: Rng) -> bytes:
    at = int(rng.integers(len(data) + 1))
    return data[:at] + data[at + int(rng.integers(1, 200)) :]


def zeros(data: bytes, rng: Rng) -> bytes:
    at = int(rng.integers(len(data) + 1))
    size = int(rng.integers(1, 300))
    return data[:at] + bytes(size) + data[at + size :]


def lines(data: bytes, rng: Rng) -> bytes:
    """Lines in another order, twice, or left out."""
    parts = data.splitlines(keepends=True)
    for _ in range(int(rng.integers(1, 4))):
        i, j = (int(rng.integers(len(parts))) for _ in range(2))
        way = int(rng.integers(3))
        if way == 0:
            parts[i], parts[j] = parts[j], parts[i]
        elif way == 1:
            parts.insert(i, parts[j])
        elif len(parts) > 1:
            del parts[i]
    return b"".join(parts)


NUMBERS = (
    "0", "-1", "1e-300", "1e300", "-1e300", "1e15", "1e-15", "1e308", "1e-9", "nan", "inf", "-inf", "900000000",
    "99999999999999999999", "1" * 400, "0*18", "1_0", "true", "\u0661", "", "''", "[]", "[1, 2, 3]", "{}",
    '"word"', "1e6", "-0.0",
    "0x10", "1.5.2", str([float(i + 1) for i in range(200)]),
)  # fmt: skip


def number(data: bytes, rng: Rng) -> bytes:
    """A number becomes another, or no number."""
    found = list(re.finditer(rb"[-+]?\d[\d.eE+-]*", data))
    if not found:
        return data
    one = found[int(rng.integers(len(found)))]
    return data[: one.start()] + NUMBERS[int(rng.integers(len(NUMBERS)))].encode() + data[one.end() :]


WORDS = (
    "",
    "\x1b[31m",
    "=1+1",
    "\u202e",
    "..",
    "\\u0000",
    "a" * 5000,
    "\ud7ff",
    "é",
    "nan",
    "-",
    "rigid",
    "[",
    "]",
    '"',
    "'''",
)


def word(data: bytes, rng: Rng) -> bytes:
    """A word becomes another."""
    found = list(re.finditer(rb"[A-Za-z_]{2,}", data))
    if not found:
        return data
    one, other = (found[int(rng.integers(len(found)))] for _ in range(2))
    new = other[0] if rng.random() < 0.5 else WORDS[int(rng.integers(len(WORDS)))].encode()
    return data[: one.start()] + new + data[one.end() :]


BYTES = (flipped, cut, hole, zeros, lines)
TEXT = (*BYTES, number, number, number, number, word, word)


def damaged(data: bytes, rng: Rng, ways: tuple[Callable[[bytes, Rng], bytes], ...], most: int = 3) -> bytes:
    """``data``, damaged in one or more of these ways."""
    for _ in range(int(rng.integers(1, most + 1))):
        data = ways[int(rng.integers(len(ways)))](data, rng)
    return data


VALUES: tuple[Any, ...] = (
    None, True, 0, -1, 1e300, 1e-300, 10**30, float("nan"), float("inf"), "", "x", "\x1b[31m", [], {}, [[]], [None], {"a": 1},
    "rigid", ["x"], 0.5, -0.5, 7,
)  # fmt: skip


def json_value(data: bytes, rng: Rng) -> bytes:
    """A value of JSON becomes another, or goes; what is written is JSON still."""
    whole = json.loads(data)
    for _ in range(int(rng.integers(1, 3))):
        here, steps = whole, int(rng.integers(1, 6))
        for step in range(steps):
            keys = list(here) if isinstance(here, dict) else list(range(len(here)))
            if not keys:
                break
            key = keys[int(rng.integers(len(keys)))]
            if step + 1 == steps or not isinstance(here[key], dict | list) or not here[key]:
                if rng.random() < 0.2:
                    del here[key]
                else:
                    here[key] = json.loads(json.dumps(VALUES[int(rng.integers(len(VALUES)))]))
                break
            here = here[key]
    return json.dumps(whole).encode()


def hdf5_value(path: Path, rng: Rng) -> None:
    """An attribute, a dataset or a link of a file becomes another."""
    import h5py

    with h5py.File(path, "r+") as file:
        places: list[str] = []
        file.visit(places.append)
        place = places[int(rng.integers(len(places)))]
        item, (parent, _, name) = file[place], place.rpartition("/")
        way = int(rng.integers(6))
        if len(item.attrs) and way < 3:
            names = list(item.attrs)
            values = (
                "x",
                1.0,
                np.nan,
                np.inf,
                -1,
                10**9,
                np.zeros(3),
                h5py.Empty("f"),
                np.array(["a"], dtype="S2"),
                "",
            )
            item.attrs[names[int(rng.integers(len(names)))]] = values[int(rng.integers(len(values)))]
            return
        home = file[parent] if parent else file
        was = item[()] if isinstance(item, h5py.Dataset) else None
        del home[name]
        if way == 3:
            home[name] = h5py.ExternalLink("/etc/passwd", "/") if rng.random() < 0.5 else h5py.SoftLink("/runs")
        elif way == 4:
            home.create_dataset(name, shape=(4 * 10**9,), dtype="f8", chunks=(1000,) if rng.random() < 0.5 else None)
        elif was is not None:
            changed = (was[:-1], was[::-1], was.astype("S8"), np.full(was.shape, np.nan), was.reshape(1, -1), was[:0])
            home[name] = changed[int(rng.integers(len(changed)))]


CELLS = (
    *NUMBERS, '"><script>alert(1)</script>', "</style>", "{{7*7}}", "\x1b[31m", "\u202e", "=cmd|1", "x" * 50_000, "\0", "a\nb",
    "javascript:alert(1)", "<img src=x onerror=alert(1)>", "rigid", "sine", "1,5", "0.5",
)  # fmt: skip


def table_cell(data: bytes, rng: Rng) -> bytes:
    """A cell or a column of a table becomes another, or goes; rows go, come twice, or change places."""
    rows = list(csv.reader(io.StringIO(data.decode(errors="replace"))))
    row, column = int(rng.integers(max(1, len(rows)))), int(rng.integers(max(1, len(rows[0]) if rows else 1)))
    new, way = CELLS[int(rng.integers(len(CELLS)))], int(rng.integers(7))
    if way < 4:
        for cells in rows[row : None if way == 3 else row + 1]:
            cells[column : column + 1] = [new]
    elif way == 4:
        rows = [cells[:column] + cells[column + 1 :] for cells in rows]
    elif way == 5:
        rows[row : row + 1] = []
    else:
        rows = (
            rows[:1] + [rows[i] for i in rng.integers(1, max(2, len(rows)), len(rows) - 1)] if len(rows) > 1 else rows
        )
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue().encode()


class Elements(HTMLParser):
    """Elements of a page that can run or fetch something, counted, and attributes that can."""

    RISKY = ("script", "style", "iframe", "img", "link", "meta", "object", "embed", "form", "base", "video", "audio")

    def __init__(self, page: Path) -> None:
        super().__init__()
        self.found: Counter[str] = Counter()
        self.feed(page.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found[tag] += tag in self.RISKY
        for name, value in attrs:
            address = (value or "").strip().lower().startswith(("javascript:", "http:", "https:", "data:", "//"))
            self.found[f"{tag} {name}"] += name.startswith("on") or address


# What is damaged


def as_numbers(row: dict[str, str]) -> dict[str, float | str]:
    """Cells of a table as a run gives them."""
    found: dict[str, float | str] = dict(row)
    for name, cell in row.items():
        with contextlib.suppress(ValueError):
            found[name] = float(cell)
    return found


def changed(before: bytes, now: bytes) -> bool:
    """Whether JSON says something else, and still has a digest that tells so."""
    try:
        said = json.loads(now)
        return "sha256" in said and said != json.loads(before)
    except (ValueError, RecursionError):
        return True


def sealed(folder: Path) -> None:
    """Write checksums that fit, as somebody who makes a folder can."""
    for path in folder.glob("*.json"):
        with contextlib.suppress(ValueError, TypeError, AttributeError, KeyError, RecursionError, OSError):
            info = json.loads(path.read_text(encoding="utf-8"))
            for name, noted in (*info.get("digests", {}).items(), ("peaks.csv", info.get("peaks"))):
                if isinstance(noted, dict):
                    noted["sha256"] = hashlib.sha256((folder / name).read_bytes()).hexdigest()
            if path.name != "run.json":
                info["sha256"] = digest_of(info)
            path.write_text(json.dumps(info), encoding="utf-8")


class Sample:
    """A study that was carried out, its folder, and its journal when all of it was finished."""

    def __init__(self, folder: Path, analyses: tuple[str, ...] = ("fragility", "spectrum", "sensitivity")) -> None:
        self.study = folder / "study.toml"
        self.study.write_text(STUDY, encoding="utf-8")
        with quiet():
            assert main(["run", str(self.study), "--out", str(folder / "out"), "--shard", "1/1"]) == 0
            self.journal = (folder / "out" / JOURNAL).read_bytes()
            assert main(["run", str(self.study), "--out", str(folder / "out")]) == 0
            for analysis in analyses:
                assert main([analysis, str(self.study), "--out", str(folder / "out")]) == 0
            shutil.copytree(folder / "out", folder / "other")
            rb.report(folder / "out", folder / "other", out=folder / "both.html")
        self.folder, self.scratch, self.other = folder / "out", folder / "scratch", folder / "other"
        self.pages = {name: Elements(page).found for name, page in (
            ("one", self.folder / "report.html"), ("both", folder / "both.html")
        )}  # fmt: skip
        loaded = rb.load_study(self.study)
        motions = ground_motions(loaded)
        self.columns, self.digest = columns(loaded), study_digests(loaded, motions)
        self.runs = len(Plan(loaded, motions))
        self.info = json.loads((self.folder / "run.json").read_text(encoding="utf-8"))
        with (self.folder / "peaks.csv").open(encoding="utf-8", newline="") as file:
            self.rows = list(csv.DictReader(file))

    def damage_study(self, rng: Rng) -> str:
        text = damaged(STUDY.encode(), rng, (*BYTES, word, *10 * [number]), most=2)
        self.study.with_name("damaged.toml").write_bytes(text)
        study = rb.load_study(self.study.with_name("damaged.toml"))
        if len(study.cases) > 8 or _steps(study) > MOST_STEPS:
            return "read"
        with quiet():
            rb.run(study)
        return "run"

    def damage_journal(self, rng: Rng) -> str:
        self.clear()
        part = self.scratch / JOURNAL
        part.write_bytes(damaged(self.journal, rng, TEXT))
        told: list[str] = []
        with Journal(part, self.columns, self.digest, runs=self.runs, tell=told.append) as journal:
            for at, row in journal.rows():
                if row != self.rows[at]:
                    raise WrongError(f"row {at}: {row}")
            there = len(journal)
            journal.add_all({at: as_numbers(self.rows[at]) for at in range(self.runs) if at not in journal})
            journal.write_in_order(self.scratch / "peaks.csv")
        if (self.scratch / "peaks.csv").read_bytes() != (self.folder / "peaks.csv").read_bytes():
            raise WrongError("another table")
        return "all rows" if there == self.runs else "some rows, and that is told" if told else "its end was torn off"

    def damage_folder(self, rng: Rng) -> str:
        """A file of a folder is damaged, and its report made and its checks held; a changed table is told."""
        shutil.rmtree(self.scratch, ignore_errors=True)
        shutil.copytree(self.folder, self.scratch)
        names = ("run.json", "run.json", "peaks.csv", "histories.h5", "checks.csv", "fragility.json")
        path = self.scratch / names[int(rng.integers(len(names)))]
        before = path.read_bytes()
        if path.suffix == ".h5" and rng.random() < 0.6:
            hdf5_value(path, rng)
            seal(path)  # so that what it holds is looked at
        elif path.suffix == ".json" and rng.random() < 0.7:
            path.write_bytes(json_value(before, rng))
        else:
            path.write_bytes(damaged(before, rng, BYTES if path.suffix == ".h5" else TEXT))
        said: list[str] = []
        if path.name == "peaks.csv" and path.read_bytes() != before:
            try:
                finished = cost_of_finished(self.scratch, self.info)
            except rb.InputError:
                said.append("a changed table is told")
            else:
                raise WrongError(f"a changed table counts as finished: {finished}")
        tasks = (lambda: rb.report(self.scratch), lambda: rb.check(self.scratch))
        told = False
        for task in tasks:
            try:
                with warnings.catch_warnings(record=True) as warned:
                    warnings.simplefilter("always", UserWarning)
                    task()
            except rb.InputError:
                said.append("words")
            else:
                about = any(issubclass(one.category, EditedTable) for one in warned)
                said.append("told and read" if about else "read")
            told |= said[-1] != "read"
        if path.name == "fragility.json" and not told and changed(before, path.read_bytes()):
            raise WrongError("what an analysis says of itself was changed, and that is not told")
        return f"{path.name}: {' and '.join(dict.fromkeys(said))}"

    def damage_analysis(self, rng: Rng) -> str:
        """Tables of analyses are damaged, most with fitting checksums; the pages that show and compare them hold no more."""
        shutil.rmtree(self.scratch, ignore_errors=True)
        shutil.copytree(self.folder, self.scratch)
        tables = sorted(path.name for path in self.folder.iterdir() if path.suffix in (".csv", ".json"))
        for name in rng.choice(tables, int(rng.integers(1, 3)), replace=False):
            path = self.scratch / str(name)
            own = json_value if path.suffix == ".json" else table_cell
            path.write_bytes(damaged(path.read_bytes(), rng, (own,) if rng.random() < 0.8 else TEXT))
        if rng.random() < 0.8:
            sealed(self.scratch)
        said = []
        for name, folders in (
            ("one", (self.scratch,)), ("both", (self.scratch, self.other)), ("both", (self.other, self.scratch))
        ):  # fmt: skip
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", UserWarning)
                    page = rb.report(*folders, out=self.scratch / "page.html").path
            except rb.InputError as error:
                if not str(error).strip():
                    raise WrongError("no words") from None
                said.append("words")
                continue
            said.append("read")
            if more := Elements(page).found - self.pages[name]:
                raise WrongError(f"the page has {dict(more)}")
        return " and ".join(dict.fromkeys(said))

    def damage_rules(self, rng: Rng) -> str:
        """A file of rules is damaged, and the results are held against what is left of it."""
        path = self.study.with_name("rules.toml")
        path.write_bytes(damaged(RULES.encode(), rng, (*BYTES, word, word, *6 * [number]), most=2))
        rb.check(self.folder, path)
        return "judged"

    def clear(self) -> None:
        shutil.rmtree(self.scratch, ignore_errors=True)
        self.scratch.mkdir()


def _steps(study: Study) -> float:
    """Steps of all runs without a halving; of both polarities one is the other's mirror image."""
    quiet_s = study.numerics.quiet_s
    return len(study.motions.scale) * sum(
        steps_of(motion, first_substeps(case.pier, case.base, motion.dt), quiet_s)
        for motion in ground_motions(study)
        for case in study.cases
    )


@contextlib.contextmanager
def quiet() -> Iterator[None]:
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        yield


# Bounds of each


@contextlib.contextmanager
def bounded() -> Iterator[None]:
    """Ends what takes too long or too much memory; what waits, or hangs in C, ends the process, with its stack."""
    import resource

    def too_long(*_: object) -> None:
        raise TookTooLongError(f"more than {SECONDS} s of processor time")

    size = int(re.search(r"VmSize:\s+(\d+)", Path("/proc/self/status").read_text())[1]) << 10  # type: ignore[index]
    before, handler = resource.getrlimit(resource.RLIMIT_AS), signal.signal(signal.SIGPROF, too_long)
    resource.setrlimit(resource.RLIMIT_AS, (size + (MEGABYTES << 20), before[1]))
    faulthandler.dump_traceback_later(120, exit=True)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        faulthandler.cancel_dump_traceback_later()
        resource.setrlimit(resource.RLIMIT_AS, before)
        signal.signal(signal.SIGPROF, handler)


def _in_time(task: Task, seed: int, i: int) -> str:
    """How the task ended within its bounds, at the second try at the latest: the first may have had kernels to compile."""
    with contextlib.suppress(TookTooLongError), bounded():
        return task(np.random.default_rng([seed, i]))
    with bounded():
        return task(np.random.default_rng([seed, i]))


def repeated(task: Task, times: int, seed: int, first: int = 0) -> tuple[Counter[str], list[str]]:
    """How so many damaged inputs ended, and those that ended badly, with their stacks."""
    ends: Counter[str] = Counter()
    bad = []
    for i in range(first, first + times):
        try:
            ends[_in_time(task, seed, i)] += 1
        except rb.InputError:
            ends["words"] += 1
        except KeyboardInterrupt:
            raise
        except BaseException:
            bad.append(f"{task.__name__}, seed {seed}, number {i}\n{traceback.format_exc()}")
    return ends, bad


def run(asked: dict[str, int], seed: int, first: int = 0) -> int:
    """Damage so many of each; returns how many ended badly."""
    failures = 0
    with tempfile.TemporaryDirectory(prefix="damage-") as folder:
        sample = Sample(Path(folder))
        for name, times in asked.items():
            ends: Counter[str] = Counter()
            bad: list[str] = []
            for start in range(0, times, AT_ONCE):
                some, worse = repeated(
                    getattr(sample, f"damage_{name}"), min(AT_ONCE, times - start), seed, first + start
                )
                ends, bad = ends + some, bad + worse
                print(
                    f"{name}: {ends.total() + len(bad)} of {times}, {len(bad)} ended badly", file=sys.stderr, flush=True
                )
            print(f"{name}: {times} damaged, {len(bad)} ended badly")
            for end, count in ends.most_common():
                print(f"    {count:6d}  {end}")
            for one in bad[:20]:
                print(one)
            failures += len(bad)
    return failures


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    for what, default in (
        ("studies", 5000), ("journals", 2000), ("folders", 2000), ("analyses", 1000), ("rules", 2000)
    ):  # fmt: skip
        parser.add_argument(f"--{what}", type=int, default=default)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first, to look at one again")
    given = parser.parse_args()
    warnings.simplefilter("error", RuntimeWarning)
    wanted = {"journal": given.journals, "study": given.studies, "folder": given.folders}
    wanted |= {"analysis": given.analyses, "rules": given.rules}
    sys.exit(run({name: times for name, times in wanted.items() if times}, given.seed, given.first) > 0)
