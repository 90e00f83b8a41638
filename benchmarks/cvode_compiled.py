"""CVODE as C programs have it: SUNDIALS' own library, called and calling back in compiled code only, without Python.

    python benchmarks/cvode_compiled.py            # needs SUNDIALS 6 (Debian: libsundials-dev)

The model, its events and tolerances are those of ``peers.py``; right-hand side, signals, what follows from an event, and
the loop over steps are compiled by Numba, which calls the library through pointers.
"""

import ctypes
import ctypes.util
import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numba
import numpy as np
from interleaved import interleaved, machine, ratio
from numba import carray, cfunc, types
from numba.core import cgutils
from numba.extending import intrinsic
from peers import FAILED, MOST_EVENTS, UPRIGHT, Rocking, _events, _rates, signals
from tower import QUIET_S, TOWER, foundations, record

from rockbatch.core.springs.lanes import static_state
from rockbatch.core.springs.model import Contact, State, Supports
from rockbatch.core.springs.transitions import handle
from rockbatch.core.types import Ground, Moment
from rockbatch.pier import YieldingBase
from rockbatch.simulation import Run, Stop, run_all_fixed, run_all_to_tolerance, run_fixed

ADAMS, BDF, ONE_STEP = 1, 2, 2
STOPPED, ROOT, FLIGHT, NONE = 1, 2, 3, -9
ACCURACY = 1e-4
RUNS = 256


@intrinsic
def at_address(typing: Any, source: Any) -> Any:
    """A pointer from a number."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.inttoptr(arguments[0], cgutils.voidptr_t)

    return types.voidptr(source), code


@numba.njit
def _data(vector):
    """The six numbers of a serial N_Vector, whose content has length, ownership and data."""
    content = carray(at_address(vector), 1, np.int64)[0]
    return carray(at_address(carray(at_address(content), 3, np.int64)[2]), 6, np.float64)


@numba.njit
def _user(user):
    told = carray(at_address(user), 3, np.int64)
    return carray(at_address(told[0]), 20, np.float64), carray(at_address(told[1]), (told[2], 4), np.float64)


@cfunc("int32(float64, int64, int64, int64)")
def right_hand_side(t, y, y_rates, user):
    """The model; each spring is on the branch of its own velocity, so that a turn is no event."""
    cells, ground = _user(user)
    now = _data(y)
    if cells[11] != 0.0:
        cells[13] = 1.0 if now[2] + cells[0] * now[3] < 0.0 else 0.0
    if cells[12] != 0.0:
        cells[14] = 1.0 if now[2] - cells[0] * now[3] < 0.0 else 0.0
    _rates(t, now, _data(y_rates), cells, ground)
    return 0


@cfunc("int32(float64, int64, int64, int64)")
def roots(t, y, values, user):
    """Signals of contact, of a pier that lies, and of turning, for the greatest rotation."""
    cells, ground = _user(user)
    found = carray(at_address(values), 6, np.float64)
    _events(t, _data(y), found, cells, ground)
    if cells[15] == 0.0:
        found[2] = found[3] = 1.0
    return 0


@numba.njit
def _on_its_branch(contact, y, half_width):
    left = 1.0 if y.v_rate + half_width * y.omega < 0.0 else 0.0
    right = 1.0 if y.v_rate - half_width * y.omega < 0.0 else 0.0
    return Contact(
        contact.left,
        contact.right,
        left if contact.left != 0.0 else contact.left_yields,
        right if contact.right != 0.0 else contact.right_yields,
        contact.held,
    )


def _library(name: str) -> ctypes.CDLL:
    found = ctypes.util.find_library(f"sundials_{name}")
    if found is None:
        raise SystemExit(f"sundials_{name} is not there: install SUNDIALS 6 (Debian: libsundials-dev)")
    return ctypes.CDLL(found)


def _typed(function: Any, result: Any, *arguments: Any) -> Any:
    function.restype, function.argtypes = result, arguments
    return function


def compiled(rocking: Rocking, tolerance: float, method: int) -> Callable[[], tuple[int, float]]:
    """One run, ready to be timed: 0 where the pier stood, and θ_max [rad]; tolerances as in :meth:`Rocking.tolerances`."""
    number, whole, pointer = ctypes.c_double, ctypes.c_int, ctypes.c_int64
    cv = _library("cvode")
    context = pointer()
    _typed(_library("generic").SUNContext_Create, whole, pointer, ctypes.POINTER(pointer))(0, ctypes.byref(context))
    new = _typed(_library("nvecserial").N_VNew_Serial, pointer, pointer, pointer)
    y, absolute = new(6, context.value), new(6, context.value)
    numbers = _data(y)
    numbers[:], _data(absolute)[:] = static_state(rocking.m, rocking.m.gravity), tolerance * rocking.scale
    memory = _typed(cv.CVodeCreate, pointer, whole, pointer)(method, context.value)
    told = np.array([rocking.cells.ctypes.data, rocking.ground.ctypes.data, len(rocking.ground)], np.int64)
    directions = np.array([-1] * 5 + [0], np.int32)
    done = [
        _typed(cv.CVodeInit, whole, pointer, pointer, number, pointer)(memory, right_hand_side.address, 0.0, y),
        _typed(cv.CVodeSVtolerances, whole, pointer, number, pointer)(memory, tolerance, absolute),
        _typed(cv.CVodeSetMaxStep, whole, pointer, number)(memory, rocking.dt),
        _typed(cv.CVodeSetMaxNumSteps, whole, pointer, pointer)(memory, 10_000_000),
        _typed(cv.CVodeSetUserData, whole, pointer, pointer)(memory, told.ctypes.data),
        _typed(cv.CVodeRootInit, whole, pointer, whole, pointer)(memory, 6, roots.address),
        _typed(cv.CVodeSetRootDirection, whole, pointer, pointer)(memory, directions.ctypes.data),
    ]
    if method == ADAMS:
        fixed_point = _library("sunnonlinsolfixedpoint").SUNNonlinSol_FixedPoint
        solver = _typed(fixed_point, pointer, pointer, whole, pointer)(y, 0, context.value)
        done.append(_typed(cv.CVodeSetNonlinearSolver, whole, pointer, pointer)(memory, solver))
    else:
        dense, linear = _library("sunmatrixdense").SUNDenseMatrix, _library("sunlinsoldense").SUNLinSol_Dense
        matrix = _typed(dense, pointer, pointer, pointer, pointer)(6, 6, context.value)
        solver = _typed(linear, pointer, pointer, pointer, pointer)(y, matrix, context.value)
        done.append(_typed(cv.CVodeSetLinearSolver, whole, pointer, pointer, pointer)(memory, solver, matrix))
    if any(done):
        raise SystemExit(f"CVODE refused its settings: {done}")
    step = _typed(cv.CVode, whole, pointer, number, pointer, pointer, whole)
    again = _typed(cv.CVodeReInit, whole, pointer, number, pointer)
    until = _typed(cv.CVodeSetStopTime, whole, pointer, number)
    crossed = _typed(cv.CVodeGetRootInfo, whole, pointer, pointer)
    m, rest, end, dt, alpha = rocking.m, rocking.rest, rocking.end, rocking.dt, rocking.alpha
    cells, ground, start, guided = (
        rocking.cells,
        rocking.ground,
        tuple(static_state(rocking.m, rocking.m.gravity)),
        bool(rocking.m.guided),
    )

    @numba.njit(error_model="numpy")
    def to_event(t, time, info, numbers, theta_max):
        """From an event to the next: its time and number, NONE at the end, and the greatest rotation."""
        if again(memory, t, y) != 0 or until(memory, end) != 0:
            return t, FAILED, theta_max
        while True:
            flag = step(memory, end, y, time.ctypes.data, ONE_STEP)
            theta_max = max(theta_max, abs(numbers[1]))
            if flag < 0:
                return time[0], FAILED, theta_max
            if flag == STOPPED or time[0] >= end:
                return time[0], NONE, theta_max
            if flag == ROOT:
                crossed(memory, info.ctypes.data)
                for j in range(5):
                    if info[j] != 0:
                        return time[0], j, theta_max

    @numba.njit(error_model="numpy")
    def run(m, cells, ground, time, info, numbers):
        t, theta_max = 0.0, 0.0
        now = State(start[0], start[1], start[2], start[3], start[4], start[5])
        contact, supports = Contact(1.0, 1.0, 1.0, 1.0, 0.0), Supports(math.nan, math.nan, -1.0, -1.0)
        for _ in range(MOST_EVENTS):
            i = int(t / dt)
            here = Ground(
                ground[i, 0] + (t - i * dt) * ground[i, 1], 0.0, ground[i, 2] + (t - i * dt) * ground[i, 3], 0.0
            )
            contact = _on_its_branch(contact, now, cells[0])
            values = signals(m, now, contact, supports, here)
            which = NONE
            for j in range(4 if contact.held != 0.0 else 2):
                if values[j] < -rest and which == NONE:
                    which = j
            if which == NONE:
                cells[11], cells[12], cells[13], cells[14], cells[15] = contact
                cells[16], cells[17] = supports.left, supports.right
                for j in range(6):
                    numbers[j] = now[j]
                t, which, theta_max = to_event(t, time, info, numbers, theta_max)
                now = State(numbers[0], numbers[1], numbers[2], numbers[3], numbers[4], numbers[5])
                if which == NONE:
                    return 0, theta_max
                if which in (FAILED, UPRIGHT):
                    return which, theta_max
                i = int(t / dt)
                here = Ground(
                    ground[i, 0] + (t - i * dt) * ground[i, 1], 0.0, ground[i, 2] + (t - i * dt) * ground[i, 3], 0.0
                )
                contact = _on_its_branch(contact, now, cells[0])
            (now, contact, supports), _kind = handle(m, Moment(now, contact, supports), which, here)
            if contact.left == 0.0 and contact.right == 0.0 and contact.held == 0.0 and not guided:
                return UPRIGHT if abs(now.theta) >= alpha and now.theta * now.omega > 0.0 else FLIGHT, theta_max
            if t >= end:
                return 0, theta_max
        return FAILED, theta_max

    time, info = np.zeros(1), np.zeros(6, np.int32)
    kept = told, directions  # the library holds their addresses
    return lambda kept=kept: run(m, cells, ground, time, info, numbers)  # type: ignore[misc]


def main() -> None:
    """Print CVODE's time over ours, for the loosest tolerance from which on its error is below ACCURACY."""
    motion, base = record(), YieldingBase(80.0, 0.05, flight="stop", eta=2.5)
    fine = run_fixed(TOWER, base, motion, 64, QUIET_S, wait=False).theta_max
    runs = [Run(TOWER, foundation, motion) for foundation in foundations(RUNS)]
    tasks: dict[str, Callable[[], object]] = {
        "rockbatch to its tolerance": partial(run_all_to_tolerance, runs, ACCURACY, QUIET_S, Stop()),
        "rockbatch, 1 step per sample": partial(run_all_fixed, runs, [1] * RUNS, QUIET_S, Stop()),
    }
    errors = {}
    for name, method in (("Adams", ADAMS), ("BDF", BDF)):
        loosest: dict[str, Callable[[], object]] = {}
        for power in range(8, 2, -1):
            solve = compiled(Rocking(TOWER, base, motion, QUIET_S), 10.0**-power, method)
            status, theta_max = solve()
            error = abs(theta_max - fine) / TOWER.alpha
            if status != 0 or error > ACCURACY:
                break
            loosest, errors[f"CVODE, {name}"] = {f"CVODE, {name}": solve}, error
        tasks |= loosest
    times = interleaved(tasks, 9)
    print(machine())
    print("| solver | per run | error of θ_max/α | over rockbatch to its tolerance, 256 side by side: best | median |")
    print("| --- | --- | --- | --- | --- |")
    unit = times["rockbatch to its tolerance"]
    for name, each in times.items():
        runs_of = 1 if name in errors else RUNS
        told = f"{errors[name]:.0e}" if name in errors else ""
        print(f"| {name} | {1e3 * min(each) / runs_of:.3g} ms | {told} | {ratio(each, unit, RUNS / runs_of)} |")


if __name__ == "__main__":
    main()
