"""Loading of the compiler without what no kernel uses."""

import subprocess
import sys
from collections import deque

import numba
import pytest

from rockbatch.batch import compiling
from rockbatch.batch.listening import Listener


@pytest.mark.slow
def test_numba_is_loaded_without_linear_algebra_and_still_multiplies_matrices():
    code = """
import sys
from rockbatch.simulation.compilation import load_numba
load_numba()
print("scipy.linalg" in sys.modules)
import numba, numpy as np
print(numba.njit(lambda a: np.dot(a, a))(2.0 * np.eye(2))[0, 0])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "4.0"]


def test_runs_without_the_compiler_are_announced_before_the_first(monkeypatch):
    said = []

    class Hearing(Listener):
        def say(self, text):
            said.append(text)

    monkeypatch.setattr(compiling, "_tasks", lambda study, observers: [])
    compiling.make_ready(None, Hearing(), ())
    assert said == []
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 1)
    compiling.make_ready(None, Hearing(), ())
    (only,) = said
    assert "NUMBA_DISABLE_JIT is set" in only
    assert "a thousand times as long" in only
    assert "`unset NUMBA_DISABLE_JIT`" in only


@pytest.mark.slow
def test_what_another_process_cannot_compile_is_left_without_a_word(capfd):
    waiting = deque(["no task"])
    compiling._compile_elsewhere(waiting)
    assert not waiting
    assert capfd.readouterr() == ("", "")
