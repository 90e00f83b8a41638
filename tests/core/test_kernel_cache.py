"""Compiled kernels are kept once for all copies of the sources, never outlive these, and are never in the way."""

import ast
import dis
import importlib
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

import numba
import pytest

import rockbatch
from rockbatch.commands.cli import main
from rockbatch.core import kept
from rockbatch.core import kernel as kernels
from rockbatch.core.kernel import core_digest, entry, inlined_once, kernel

SCRIPT = """
from numba.core import event
class Compilations(event.Listener):
    count = 0
    def on_start(self, _):
        self.count += 1
    def on_end(self, _):
        pass
compilations = Compilations()
event.register("numba:compile", compilations)
import numpy as np
from rockbatch.core.block.model import Rocking, Stance
from rockbatch.core.history import MOMENT
from rockbatch.motions.motion import Motion
from rockbatch.pier import Pier, RigidBase
from rockbatch.outcome.outcome import TERMS
from rockbatch.simulation import Run
from rockbatch.observers.energy_balance.observe import energies
rows = np.zeros(2, [(name, "f8") for name in (*MOMENT, *Rocking._fields, *Stance._fields)]).view(np.recarray)
rows.t, rows.theta, rows.omega, rows.right = (0.0, 0.01), 0.1, 0.2, 1.0
motion = Motion("push", 0.01, np.full(50, -3.0))
print(repr(float(abs(energies(Run(Pier(0.2, 1.0), RigidBase(), motion), rows)[1, TERMS.index("input")]))))
print(compilations.count)
"""


def run_copy(folder: Path) -> tuple[float, int]:
    """Return the work of the ground in a step, as the copy of the package in ``folder`` computes, and what it compiled.

    Its kernel takes two seconds to compile; the driver of all runs is kept alike, and takes ten.
    """
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], cwd=folder, env=environment, capture_output=True, text=True, check=True
    )
    work, compilations = done.stdout.split()
    return float(work), int(compilations)


@pytest.mark.slow
def test_another_copy_compiles_nothing_until_a_called_kernel_is_edited(tmp_path, cache):
    """Numba's own cache goes by the caller's file and its path. Without the arm, which that calls, the ground does no work."""
    for name in ("one", "two"):
        shutil.copytree(
            Path(rockbatch.__file__).parent, tmp_path / name / "rockbatch", ignore=shutil.ignore_patterns("__pycache__")
        )
    work, compilations = run_copy(tmp_path / "one")
    assert compilations > 0
    assert run_copy(tmp_path / "two") == (work, 0)
    source = tmp_path / "two" / "rockbatch" / "core" / "block" / "equations.py"
    text = source.read_text(encoding="utf-8")
    line = "return arms_about(m, y.theta, side if side != 0.0 else key_of(m, contact))[1]\n"
    assert text.count(line) == 1
    source.write_text(text.replace(line, line.replace("return ", "return 0.0 * ")), encoding="utf-8")
    assert run_copy(tmp_path / "two") == (0.0, compilations)
    assert run_copy(tmp_path / "one") == (work, 0)


def test_the_digest_depends_on_every_source_of_the_core(tmp_path):
    core = tmp_path / "core"
    shutil.copytree(Path(rockbatch.__file__).parent / "core", core, ignore=shutil.ignore_patterns("__pycache__"))
    digest = core_digest(core)
    sources = sorted(core.rglob("*.py"))
    assert {source.parent for source in sources} > {core}
    for source in sources:
        text = source.read_bytes()
        source.write_bytes(text + b"\n")
        assert core_digest(core) != digest, source.name
        source.write_bytes(text)
    assert core_digest(core) == digest


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """Return the folder of a cache of its own, in which nothing was kept yet, and of which nothing was said."""
    monkeypatch.setenv("ROCKBATCH_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(kept._State, "reason", "")
    monkeypatch.setattr(kept._State, "reported", False)
    return tmp_path / "cache"


def twice(x):
    return 2.0 * x


def compilations(function=twice, argument=3.0, result=6.0) -> int:
    """Return how often a function is compiled when a process that has just begun calls it: once, or not at all."""
    dispatcher = entry(function)
    assert dispatcher(argument) == result
    return sum(dispatcher.stats.cache_misses.values())


def test_a_kernel_is_compiled_once_in_a_folder_of_the_users_own(cache):
    assert [compilations() for _ in range(3)] == [1, 0, 0]
    (file,) = cache.iterdir()
    assert file.name.startswith("twice-")
    if hasattr(os, "geteuid"):
        assert [path.stat().st_mode & 0o777 for path in (cache, file)] == [0o700, 0o600]


DAMAGES = {
    "empty": lambda content: b"",
    "cut in its head": lambda content: content[:30],
    "cut": lambda content: content[:-1],
    "longer": lambda content: content + b"0",
    "a bit of its mark": lambda content: bytes([content[0] ^ 1]) + content[1:],
    "a bit of its digest": lambda content: content[:25] + bytes([content[25] ^ 4]) + content[26:],
    "a bit of its contents": lambda content: content[:-1000] + bytes([content[-1000] ^ 64]) + content[-999:],
    "no kernel": lambda content: b"import os",
}


@pytest.mark.parametrize("damaged", DAMAGES.values(), ids=DAMAGES)
def test_what_does_not_match_its_digest_is_compiled_again_and_replaced(cache, damaged):
    """Numba's own cache ends in a traceback at a cut file, and the process at a bit that is wrong."""
    compilations()
    (file,) = cache.iterdir()
    file.write_bytes(damaged(file.read_bytes()))
    assert [compilations(), compilations()] == [1, 0]
    assert kept.unreported() == ""


def negative(x):
    return -x


def test_the_kernel_of_another_function_is_not_taken_for_this_one(cache):
    compilations()
    (file,) = cache.iterdir()
    compilations(negative, 3.0, -3.0)
    (other,) = set(cache.iterdir()) - {file}
    shutil.copy(other, file)
    assert compilations() == 1


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has other rights")
@pytest.mark.parametrize("mode", [0o770, 0o702, 0o777])
def test_a_folder_that_others_may_write_to_is_not_used_and_a_sentence_says_so(cache, mode):
    """What lies there is unpickled, which runs whatever its author wrote."""
    compilations()
    cache.chmod(mode)
    before = [(file, file.stat().st_mtime_ns) for file in cache.iterdir()]
    assert compilations() == 1
    assert [(file, file.stat().st_mtime_ns) for file in cache.iterdir()] == before
    assert not kept.usable()
    assert f"{cache}: others may write into this folder" in kept.unreported()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has other rights")
def test_a_file_that_others_could_have_written_is_not_read(cache):
    compilations()
    (file,) = cache.iterdir()
    file.chmod(0o620)
    assert compilations() == 1
    file.chmod(0o600)
    file.rename(cache / "elsewhere")
    file.symlink_to(cache / "elsewhere")
    assert compilations() == 1
    assert not file.is_symlink()
    if os.geteuid() == 0:
        os.chown(file, 12345, 12345)
        assert compilations() == 1
        os.chown(cache, 12345, 12345)
        assert compilations() == 1
        assert "others may write into this folder" in kept.unreported()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows limits no files")
def test_where_the_disk_is_full_a_run_goes_on_and_nothing_is_left_behind(cache):
    """A limit to the size of files ends the writing as a full disk does: in the middle."""
    import resource

    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limits[1]))
    try:
        assert [compilations(), compilations()] == [1, 1]
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert list(cache.iterdir()) == []
    assert f"{cache}: File too large" in kept.unreported()
    assert kept.unreported() == ""  # once is enough


def test_where_there_can_be_no_folder_a_run_goes_on(cache):
    cache.write_text("a file in its place")
    assert [compilations(), compilations()] == [1, 1]
    assert not kept.usable()
    reported = kept.unreported()
    assert str(cache) in reported
    assert "ROCKBATCH_CACHE" in reported


def test_the_folder_is_the_users_cache_folder_unless_another_is_named(tmp_path, monkeypatch):
    monkeypatch.delenv("ROCKBATCH_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert kept.folder() == tmp_path / "rockbatch"
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")  # which its specification says to ignore
    assert kept.folder() == Path.home() / ".cache" / "rockbatch"
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("ROCKBATCH_CACHE", "here")
    assert kept.folder() == tmp_path / "here"


def kept_files(cache, count):
    """Fill a cache with files of 1,000 bytes of contents, the first used a day longer ago than the second, and so on."""
    for number in range(count):
        kept.keep(f"f-{number}", "identity", bytes(1000))
        long_ago = time.time() - 86_400.0 * (count - number)
        os.utime(cache / f"f-{number}.kernel", (long_ago, long_ago))


def test_the_cache_is_bounded_and_drops_what_was_used_longest_ago(cache, monkeypatch):
    kept_files(cache, 5)
    assert kept.read("f-0", "identity") == bytes(1000)  # used now, and so not the first to go
    monkeypatch.setattr(kept, "MOST_BYTES", 3500)
    kept.keep("new", "identity", bytes(1000))
    assert sorted(path.stem for path in cache.iterdir()) == ["f-0", "f-4", "new"]
    kept.keep("large", "identity", bytes(9000))
    assert [path.stem for path in cache.iterdir()] == ["large"]


def test_what_nobody_used_for_long_is_dropped_and_what_was_never_finished(cache):
    kept_files(cache, 2)
    (cache / "f-7-abc.unfinished").write_bytes(b"of a process that ended")
    (cache / "f-8-abc.unfinished").write_bytes(b"of one that writes now")
    long_ago = time.time() - 86_400.0 * (kept.UNUSED_DAYS + 1)
    for name in ("f-0.kernel", "f-7-abc.unfinished"):
        os.utime(cache / name, (long_ago, long_ago))
    kept.keep("new", "identity", b"")
    assert sorted(path.name for path in cache.iterdir()) == ["f-1.kernel", "f-8-abc.unfinished", "new.kernel"]


def test_a_command_shows_the_cache_and_clears_it_but_for_what_is_not_its_own(cache, capsys):
    assert main(["cache"]) == 0
    assert capsys.readouterr().out == f"{cache}: 0 compiled kernels, 0.0 MB of at most 500 MB\n"
    kept_files(cache, 3)
    kept.keep("large", "identity", bytes(2_600_000))
    first, last = (time.mktime((2031, 5, day, 12, 0, 0, 0, 0, -1)) for day in (3, 14))
    for name, used in (("f-0", last - 1.0), ("f-1", first), ("f-2", last - 1.0), ("large", last)):
        os.utime(cache / f"{name}.kernel", (used, used))
    (cache / "notes.txt").write_text("not ours")
    assert main(["cache"]) == 0
    shown, used = capsys.readouterr().out.splitlines()
    assert shown == f"{cache}: 4 compiled kernels, 2.6 MB of at most 500 MB"
    assert used == f"last used between 2031-05-03 and 2031-05-14; removed when unused for {kept.UNUSED_DAYS} days"
    assert main(["cache", "--clear"]) == 0
    assert capsys.readouterr().out == f"{cache}: removed 4 compiled kernels, 2.6 MB\n"
    assert [path.name for path in cache.iterdir()] == ["notes.txt"]


WRITER = """
import sys
from rockbatch.core import kept
own = sys.argv[1].encode()
found = set()
for number in range(150):
    kept.keep("f-0", "identity", own * (1 + 5_000 * (number % 7)))
    content = kept.read("f-0", "identity")
    assert content, "missing, or damaged"
    assert set(content) in ({97}, {98}, {99}), "mixed"
assert not kept.unreported()
"""


def test_processes_that_write_one_kernel_at_a_time_leave_a_whole_one(cache):
    command = [sys.executable, "-c", WRITER]
    writers = [subprocess.Popen([*command, name], stderr=subprocess.PIPE, text=True) for name in "abc"]
    assert [writer.communicate()[1] for writer in writers] == [""] * 3
    assert [path.name for path in cache.iterdir()] == ["f-0.kernel"]


def of_one_module():
    class Pair(NamedTuple):
        a: float
        b: float

    return Pair


def of_another_module():
    class Pair(NamedTuple):
        b: float
        a: float

    return Pair


def difference(pair):
    return pair.a - pair.b


def test_named_tuples_of_one_name_do_not_share_machine_code(cache, monkeypatch):
    """Numba's words for both types are the same."""
    one, other = of_one_module(), of_another_module()
    for name, pair in (("One", one), ("Other", other)):
        monkeypatch.setattr(sys.modules[__name__], name, pair, raising=False)
        pair.__qualname__ = name
    assert compilations(difference, one(5.0, 3.0), 2.0) == 1
    assert compilations(difference, one(5.0, 3.0), 2.0) == 0
    assert compilations(difference, other(5.0, 3.0), -2.0) == 1


@pytest.mark.parametrize(
    ("place", "name", "value"),
    [
        (kernels, "_DIGEST", "of other sources"),
        (numba, "__version__", "0.0"),
        (kernels.llvmlite, "__version__", "0.0"),
        (numba.config, "BOUNDSCHECK", 1),
        (numba.config, "LOOP_VECTORIZE", 0),
        (kernels.sys, "version", "3.0"),
    ],
)
def test_machine_code_is_that_of_these_sources_and_of_this_compiler(cache, monkeypatch, place, name, value):
    compilations()
    with monkeypatch.context() as patch:
        patch.setattr(place, name, value)
        patch.setattr(kernels, "core_digest", lambda: kernels._DIGEST)
        assert [compilations(), compilations()] == [1, 0]
    assert compilations() == 0


def test_machine_code_is_that_of_this_processor(cache):
    """Of its name and of its features, which need not be those of its name: in a virtual machine some are missing."""

    class Processor(NamedTuple):
        triple: str = "x86_64"
        name: str = "znver3"
        features: str = "+avx2"

        def magic_tuple(self):
            return tuple(self)

    cached = entry(twice)._cache
    processors = Processor(), Processor(name="znver4"), Processor(features="-avx2"), Processor(triple="aarch64")
    assert len({cached._identity((numba.float64,), processor) for processor in processors}) == 4


def test_what_was_compiled_from_sources_that_changed_meanwhile_is_not_kept(cache, monkeypatch):
    """The next process would take it for what the new sources say."""
    dispatcher = entry(twice)
    with monkeypatch.context() as patch:
        patch.setattr(kernels, "core_digest", lambda: "after an edit")
        assert dispatcher(3.0) == 6.0
    assert kept.files() == []


def test_a_closure_is_no_entry():
    factor = 3.0

    def times(x):
        return factor * x

    with pytest.raises(TypeError, match="times: the machine code of a closure cannot be kept"):
        entry(times)


OUTSIDE = ("rockbatch.simulation.restraints", "rockbatch.simulation.sections")


@pytest.mark.parametrize("module", OUTSIDE)
def test_entries_outside_of_the_core_use_the_core_and_their_own_file_only(module):
    """A change anywhere else would not be seen."""
    loaded = importlib.import_module(module)
    tree = ast.parse(Path(loaded.__file__).read_text(encoding="utf-8"))
    origin = {
        (name.asname or name.name): node.module
        for node in tree.body
        if isinstance(node, ast.ImportFrom)
        for name in node.names
    }
    loads = (step for step in dis.get_instructions(loaded._follow.py_func) if step.opname == "LOAD_GLOBAL")
    used = {origin[load.argval] for load in loads if load.argval in origin}
    assert used
    assert {name.split(".core.")[0] for name in used} == {"rockbatch"}


def test_these_are_the_only_entries_outside_of_the_core():
    top = Path(rockbatch.__file__).parent
    paths = [path.relative_to(top).as_posix() for path in top.rglob("*.py") if "@entry\n" in path.read_text("utf-8")]
    assert sorted(path for path in paths if not path.startswith("core/")) == [
        f"{module.split('.', 1)[1].replace('.', '/')}.py" for module in OUTSIDE
    ]


@pytest.mark.parametrize("building_block", [kernel, inlined_once])
def test_a_building_block_is_part_of_its_callers_only_and_python_may_call_it_too(building_block):
    """Machine code of its own would take a quarter of all compilation, and nobody would run it."""

    @building_block
    def twice(x):
        return 2.0 * x

    @numba.njit
    def caller(x):
        return twice(x) + 1.0

    assert caller(3.0) == 7.0
    compiled = twice.overloads[(numba.float64,)]
    assert compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name) == 0
    assert not compiled.library._codegen._engine.is_symbol_defined(compiled.fndesc.llvm_func_name)
    assert twice(4.0) == 8.0
