"""Nothing that a file holds can hurt: damaged in whatever way, it ends in components or a reason, and soon."""

import contextlib
import os
import tempfile
import threading
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from bounds import bounds
from damaged_files import SAMPLES, damaged
from motion_files import wiggle, write_at2

from rockbatch.common.errors import InputError
from rockbatch.motions import read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.formats import FORMATS, read_record
from rockbatch.motions.identity.pairing import to_motions
from rockbatch.motions.sources.record_file import ReadOptions, RecordFile
from rockbatch.motions.unused import Unusable

OPTIONS = (ReadOptions(), ReadOptions(unit="cm/s2", dt=0.01), ReadOptions(unit="g", sensitivity=1e5))


SECONDS, MEGABYTES = 1.0, 300
"""What a file of some kB may take."""


class Counts(NamedTuple):
    """How many files gave components, or were read; how many gave a reason; and the computing time of the slowest [s]."""

    good: int
    refused: int
    slowest: float


def read_all_ways_of_damage(name: str, inputs: int, seed: int) -> Counts:
    """Read so many damaged files of a format."""
    rng = np.random.default_rng(seed)
    components = reasons = 0
    slowest = 0.0
    for _ in range(inputs):
        file, whole = SAMPLES[name][int(rng.integers(len(SAMPLES[name])))]
        data = damaged(whole, rng)
        record = RecordFile(Path(file), file, data, options=OPTIONS[int(rng.integers(len(OPTIONS)))])
        started = time.process_time()
        try:
            with bounds(SECONDS, MEGABYTES):
                found = read_record(record)
                to_motions([reading for reading in found if isinstance(reading, Component)])
        except InputError as error:
            found, told = [], str(error)
        except BaseException:
            Path(tempfile.gettempdir(), f"damaged-{file}").write_bytes(data)
            raise
        else:
            told = "components"
        slowest = max(slowest, time.process_time() - started)
        assert told.strip()
        for reading in found:
            assert isinstance(reading, Unusable) or np.isfinite(reading.acceleration).all()
            assert isinstance(reading, Unusable) or 0 < reading.dt < np.inf
        components += bool(found)
        reasons += not found
    return Counts(components, reasons, slowest)


def test_there_are_samples_of_every_format_and_all_of_them_are_read():
    assert set(SAMPLES) == {known.name for known in FORMATS}
    options = ReadOptions(unit="m/s2", sensitivity=1e5)
    for files in SAMPLES.values():
        for file, whole in files:
            assert not any(
                isinstance(one, Unusable) for one in read_record(RecordFile(Path(file), file, whole, options=options))
            )


@pytest.mark.parametrize("name", sorted(SAMPLES))
def test_a_damaged_file_ends_in_components_or_a_reason(name):
    counts = read_all_ways_of_damage(name, 40, seed=1)
    assert counts.good > 0
    assert counts.refused > 5


WITHOUT_A_COUNT = ("text columns", "CWA free field")  # of samples in the header
WHOLE = [(name, file, whole) for name, files in SAMPLES.items() for file, whole in files if name not in WITHOUT_A_COUNT]


@pytest.mark.parametrize(("name", "file", "whole"), WHOLE, ids=[f"{name} {file}" for name, file, _ in WHOLE])
def test_a_file_cut_after_any_line_has_whole_components_or_is_refused(name, file, whole):
    """What comes out has all of its samples, whatever a count in the header promised."""
    options = ReadOptions(unit="m/s2")
    components = read_record(RecordFile(Path(file), file, whole, options=options))
    binary = b"\x00" in whole
    lines = [whole[i : i + 64] for i in range(0, len(whole), 64)] if binary else whole.splitlines(keepends=True)
    refused = 0
    for end in range(1, len(lines)):
        try:
            found = read_record(RecordFile(Path(file), file, b"".join(lines[:end]), options=options))
        except InputError:
            refused += 1
            continue
        for reading, component in zip(found, components, strict=False):
            np.testing.assert_array_equal(reading.acceleration, component.acceleration)
    assert refused > 0.9 * (len(lines) - 1)


@pytest.mark.slow
@pytest.mark.parametrize("count", [150, pytest.param(10_000, marks=pytest.mark.thorough)])
@pytest.mark.parametrize("name", sorted(SAMPLES))
def test_thousands_of_damaged_files_of_a_format_end_in_components_or_a_reason(name, count):
    """And what a count promises is not allocated."""
    read_all_ways_of_damage(name, count, seed=2)


def read_changing_folders(folder: Path, inputs: int, seed: int) -> Counts:
    """Read so many folders in which files are cut, removed, replaced, and made pipes or folders, while they are read."""
    rng = np.random.default_rng(seed)
    formats, slowest, read, refused = sorted(SAMPLES), 0.0, 0, 0
    for i in range(inputs):
        inside = Path(tempfile.mkdtemp(dir=folder))
        for name in rng.choice(formats, 6, replace=False):
            file, whole = SAMPLES[name][int(rng.integers(len(SAMPLES[name])))]
            (inside / file).write_bytes(whole)
        (inside / "motions.toml").write_text(f'[[record]]\nfile = "{file}"\nscale = 1.5\n')
        ended = threading.Event()
        other = threading.Thread(target=_change, args=(inside, ended, np.random.default_rng([seed, i])))
        other.start()
        started = time.process_time()
        try:
            with bounds(SECONDS * 10, MEGABYTES):
                found = read_motions(inside)
            assert not [file.reason for file in found.unusable if "its reader failed" in file.reason]
            read += 1
        except InputError as error:
            refused += bool(str(error).strip())
        finally:
            ended.set()
            other.join()
        slowest = max(slowest, time.process_time() - started)
    return Counts(read, refused, slowest)


def _change(folder: Path, ended: threading.Event, rng: np.random.Generator) -> None:
    """Do harm to one file after the other until it has ``ended``."""
    while not ended.wait(float(rng.random()) * 2e-3):
        with contextlib.suppress(OSError):
            files = sorted(folder.iterdir())
            path, way = files[int(rng.integers(len(files)))], int(rng.integers(6))
            if not path.is_file():
                continue
            if way == 0:
                os.truncate(path, int(rng.integers(path.stat().st_size + 1)))
            elif way == 1:
                path.write_bytes(path.read_bytes() + b"0.1 0.2\n")
            else:
                path.unlink()
            if way == 3:
                path.mkdir()
            elif way == 4 and hasattr(os, "mkfifo"):
                os.mkfifo(path)
            elif way == 5:
                path.symlink_to("/dev/zero")


@pytest.mark.slow
@pytest.mark.parametrize("count", [20, pytest.param(200, marks=pytest.mark.thorough)])
def test_folders_that_change_while_they_are_read_end_in_motions_or_words(tmp_path, count):
    counts = read_changing_folders(tmp_path, count, seed=1)
    assert counts.good > counts.refused  # nine of ten are read before they change
    assert counts.good + counts.refused == count


MANIFESTS = {
    "motions.toml": """\
# what is known of these
[[record]]
file = "a000.AT2"
azimuth = 228.0   # degrees
magnitude = 6.7
scale = 1.5
station = "Rinaldi"

[[record]]
file = "b.csv"
component = "NS"
role = "horizontal"
unit = "cm/s2"
dt = 0.01
polarity = "-"
use = true
confirm = true
""",
    "motions.csv": """\
file,component,role,azimuth,unit,dt,scale,station
a000.AT2,,,228,,,1.5,Rinaldi
b.csv,NS,horizontal,0,cm/s2,0.01,,Rinaldi
""",
}


def read_damaged_manifests(folder: Path, name: str, inputs: int, seed: int) -> Counts:
    """Read a folder with so many damaged manifests, one after the other."""
    rng = np.random.default_rng(seed)
    slowest = 0.0
    write_at2(folder, "a000.AT2", wiggle(50))
    (folder / "b.csv").write_text("NS,UD\n" + "".join(f"{a:.5f},{a / 2:.5f}\n" for a in wiggle(50, 2)))
    read = refused = 0
    for _ in range(inputs):
        (folder / name).write_bytes(damaged(MANIFESTS[name].encode(), rng))
        problems: tuple[str, ...] = ()
        started = time.process_time()
        try:
            with bounds(SECONDS, MEGABYTES):
                found = read_motions(folder)
        except InputError as error:
            problems = error.messages
            refused += 1
        else:
            sources = {one.source.partition(" ")[0] for one in (*found.motions, *found.unusable, *found.left_out)}
            assert sources >= {"a000.AT2", "b.csv"}
            read += 1
        slowest = max(slowest, time.process_time() - started)
        assert all(str(folder) in problem for problem in problems)
    return Counts(read, refused, slowest)


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("name", MANIFESTS)
def test_a_damaged_manifest_is_read_or_refused(tmp_path, name):
    counts = read_damaged_manifests(tmp_path, name, 40, seed=1)
    assert counts.good > 0
    assert counts.refused > 10


@pytest.mark.slow
@pytest.mark.parametrize("count", [200, pytest.param(2_500, marks=pytest.mark.thorough)])
@pytest.mark.parametrize("name", MANIFESTS)
def test_thousands_of_damaged_manifests_are_read_or_refused(tmp_path, name, count):
    read_damaged_manifests(tmp_path, name, count, seed=2)
