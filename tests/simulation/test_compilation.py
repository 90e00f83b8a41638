"""Loading of the compiler without what no kernel uses."""

import subprocess
import sys


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
