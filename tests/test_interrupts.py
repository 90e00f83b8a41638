"""Ctrl-C on the command line: answered at once, whatever the program is in, and over soon."""

import signal
import socket
import subprocess
import sys
import time

import pytest
from studies import RIGID, study_text, write_study

from rockbatch.commands import interrupts
from rockbatch.commands.interrupts import answered_interrupts

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")

IN_C_CODE = """
import hashlib, signal, sys, threading
signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell ignores it in what it runs in the background
import rockbatch.batch.carrying_out
from rockbatch.commands import cli, interrupts

def compile_for_minutes(*_):  # as LLVM does: Python hears of no signal meanwhile
    # by another thread, once this one is in there
    threading.Timer(0.1, print, ["compiling"], {{"file": sys.stderr, "flush": True}}).start()
    hashlib.pbkdf2_hmac("sha256", b"", b"", 10**9)

rockbatch.batch.carrying_out.make_ready = compile_for_minutes
interrupts.GRACE_S = {grace}
sys.exit(cli.main(["run", {study!r}, "--out", {out!r}]))
"""


@pytest.mark.slow
@pytest.mark.parametrize(("grace", "times"), [(0.6, 1), pytest.param(600.0, 2, marks=pytest.mark.slow)])
def test_an_interrupt_while_something_is_compiled_is_answered_and_ends_it(tmp_path, grace, times):
    study, out = write_study(tmp_path, study_text(cases=(RIGID,))), tmp_path / "out"
    code = IN_C_CODE.format(grace=grace, study=str(study), out=str(out))
    with subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        while process.stderr.readline() != "compiling\n":
            assert process.poll() is None
        interrupted = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.stderr.readline().startswith("stopping within a second")
        assert time.monotonic() - interrupted < 10.0  # half a second, where nothing else runs
        if times == 2:
            process.send_signal(signal.SIGINT)
        assert process.wait(timeout=20.0) == 130
        assert process.stderr.read() == "rockbatch: interrupted\n"


WHILE_LOADED = """
import runpy, sys

class Interrupting:  # as if Ctrl-C were pressed when this module is about to be loaded
    def find_spec(self, name, *_):
        if name == {module!r}:
            sys.meta_path.remove(self)
            raise KeyboardInterrupt

sys.meta_path.insert(0, Interrupting())
sys.argv = ["rockbatch", "run", {study!r}, "--out", {out!r}]
runpy.run_module("rockbatch", run_name="__main__")
"""


@pytest.mark.parametrize(
    "module",
    ["gc", "rockbatch.commands.interrupts", "rockbatch.commands.run", pytest.param("numba", marks=pytest.mark.slow)],
)
def test_an_interrupt_while_modules_are_loaded_is_answered_in_one_line(tmp_path, module):
    study, out = write_study(tmp_path, study_text(cases=(RIGID,))), tmp_path / "out"
    code = WHILE_LOADED.format(module=module, study=str(study), out=str(out))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr.splitlines()[-1]) == (130, "rockbatch: interrupted")
    assert "Traceback" not in done.stderr


def test_an_interrupt_of_what_ends_at_once_is_not_remarked_upon(capsys):
    earlier = signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell ignores in the background
    try:
        with pytest.raises(KeyboardInterrupt), answered_interrupts():
            signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, earlier)
    assert capsys.readouterr().err == ""


def test_of_two_interrupts_that_wait_each_is_read_on_its_own():
    bell, rope = socket.socketpair()
    with bell, rope:
        rope.send(bytes([signal.SIGINT, signal.SIGTERM]))
        assert [interrupts._next(bell, 1.0) for _ in range(2)] == [signal.SIGINT, signal.SIGTERM]
