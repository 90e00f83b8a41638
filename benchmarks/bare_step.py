"""What a step of whole runs costs, side by side, over the bare step of the model.

    python benchmarks/bare_step.py [--repeats 7]

Bare is one step of Runge–Kutta 4 and the rates at its end, of one run in full contact, in a compiled loop that does
nothing else: no events, no extremes, one run at a time. Whole runs are those of a study: tests for events, their
location, landings and separations, peaks and plastic work. On the rigid base bare is a step of a block about one corner.
Runs with devices have two viscous dampers and a tendon: the step of one run is held against that of one plain run.
Runs on footings go one by one: their step is held against that of runs on Bouc–Wen springs; 60 of them run to tolerance.

The first line says how wide the compiled vector instructions are. To run as a processor of 256 bits does:

    NUMBA_CPU_NAME=znver3 NUMBA_CPU_FEATURES= python benchmarks/bare_step.py

Features left empty are those of the named processor; otherwise Numba keeps those of the one it runs on.
"""

import argparse
import math
import re
from collections.abc import Mapping
from dataclasses import replace
from functools import partial

import numba
import numpy as np
from interleaved import Times, interleaved, machine, ratio
from tower import QUIET_S, TOWER, foundations, record

from rockbatch.core.block.model import Rocker, Tilt
from rockbatch.core.clock import read_ground, start_clock
from rockbatch.core.devices.lanes import equipment_of
from rockbatch.core.ground import later
from rockbatch.core.history import MOMENT
from rockbatch.core.rk4 import rk4
from rockbatch.core.run import Settings, march
from rockbatch.core.springs.lanes import static_state
from rockbatch.core.springs.laws import CODES
from rockbatch.core.springs.model import Contact
from rockbatch.core.system import begin, one_pass, rates
from rockbatch.core.table import LANES, table
from rockbatch.core.table import record as record_of
from rockbatch.core.types import RIGHT, SURVIVED, Ground, Instant
from rockbatch.motions import Motion
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Base, Damper, ElasticBase, FootingBase, Pier, RigidBase, Tendon, YieldingBase
from rockbatch.simulation import Run, Stop, block, ground_of, run_all_fixed, run_all_to_tolerance, springs
from rockbatch.simulation.elements import elements
from rockbatch.simulation.models import line_of, system_of
from rockbatch.simulation.models import model as model_of
from rockbatch.simulation.starting import start_of

BARE_STEPS = 200_000
AT_REST = start_of(TOWER, RigidBase())
SETTINGS = Settings(1, True, False)
BARE_ROCKING = 1e-6  # [s]: of a bare step on the rigid base, so that the block stays on its corner
PASSES = 10_000
DEVICES = (Damper("viscous", nu=1.0), Tendon(psi=0.1, lam=0.5))


@numba.njit(error_model="numpy")
def bare(m, y, contact, ground, h, steps):
    """Return the rotation after ``steps`` steps of ``h`` [s] and nothing else: on springs, or about a corner of a rigid base."""
    k = rates(m, y, contact, Ground(ground[0, 0], ground[0, 1], ground[0, 2], ground[0, 3]))
    for i in range(steps):
        row = ground[i % len(ground)]
        under = Ground(row[0], row[1], row[2], row[3])
        y = rk4(m, None, Instant(y, k, contact, None, under), h)
        k = rates(m, y, contact, later(under, h))
    return y.theta


@numba.njit(error_model="numpy", _nrt=False)
def passes(traits, lanes_table, runs, ground, count):
    """Take all lanes from the start through ``count`` passes of tiny steps: no sample is reached, and nothing happens."""
    lanes = lanes_table[0]
    for i in range(len(runs)):
        start_clock(lanes, i, i, runs[i])
        read_ground(lanes, i, ground)
        begin(traits, lanes, i, runs[i])
        lanes.step_status.watched[i] = 0.0
        to_right = 1.0 if (ground[0, 0] if ground[0, 0] != 0.0 else ground[0, 1]) < 0.0 else 0.0  # no velocity reverses
        lanes.contact.left_yields[i], lanes.contact.right_yields[i] = 1.0 - to_right, to_right
    for k in range(count):
        one_pass(traits, lanes, len(runs), k, SETTINGS)


@numba.njit(error_model="numpy", fastmath=False)
def _widened(a, b):
    for i in range(len(a)):
        a[i] += b[i] * b[i]


def vector_width() -> str:
    """Return how many bits Numba's vector instructions have here, read off a loop that it compiles."""
    _widened(np.zeros(64), np.ones(64))
    (code,) = _widened.inspect_asm().values()
    bits = next(
        (bits for name, bits in (("zmm", 512), ("ymm", 256), ("xmm|v[0-9]+\\.2d", 128)) if re.search(name, code)), 64
    )
    named = numba.config.CPU_NAME  # type: ignore[attr-defined]
    return f"vector instructions of {bits} bits" + (f", as on {named}" if named else "")


def of_law(law: str, base: YieldingBase) -> ElasticBase:
    """``base`` with springs of ``law``; a flight goes on, so that no run ends early."""
    if law == "elastic":
        return ElasticBase(base.beta, base.epsilon, flight="guided")
    return replace(base, spring=law, flight="guided")


def with_vertical(motion: Motion) -> Motion:
    """``motion`` with a third of its horizontal component, reversed in time, as a vertical one."""
    vertical = 1.0 / 3.0 * np.ascontiguousarray(motion.horizontal[::-1])
    return Motion(motion.name, motion.dt, motion.horizontal, vertical)


def timing(motion: Motion, substeps: int) -> tuple[float, ...]:
    """Return what a line of the core has of Timing; nothing is waited for."""
    dt = float(motion.dt)
    return dt, substeps, math.ceil(QUIET_S / dt - 1e-9), 0, motion.npts, 0


def measure(law: str, motion: Motion, substeps: int, runs: int, repeats: int) -> str:
    """Line of the table."""
    ground, dt = ground_of(motion), float(motion.dt)
    models = [springs(TOWER, of_law(law, base)) for base in foundations(runs)]
    system, lines = system_of(models[0]), [line_of(m, timing(motion, substeps), (0, 0), 0.0, AT_REST) for m in models]
    stop = np.zeros(1, np.uint8)
    ends = march(system, lines, ground, stop, substeps)
    if (ends.status != SURVIVED).any():
        raise SystemExit(f"{law}: a run ended early; its steps are no measure")
    steps = int(np.rint(ends.t_end / dt * substeps).sum())

    # An event is two rows of a history, a sample one
    history = np.zeros((1, 1, len(MOMENT) + len(system.columns)))
    counted = march(system, [lines[runs // 2]], ground, stop, substeps, history=history)[0]
    samples = round(counted.t_end / dt) + 1
    events = (counted.rows - samples) // 2

    m = models[runs // 2]
    branch = 1.0 if m.law == CODES["bouc-wen"] else 0.0
    alone = (m, static_state(m, m.gravity), Contact(1.0, 1.0, branch, branch, 0.0), ground, dt / substeps, BARE_STEPS)
    times = interleaved(
        {"whole": lambda: march(system, lines, ground, stop, substeps), "bare": lambda: bare(*alone)}, repeats
    )
    return row(law, motion, substeps, times, steps, events / (samples - 1) / substeps)


def row(law: str, motion: Motion, substeps: int, times: Mapping[str, Times], steps: int, events: float) -> str:
    """Line of the table, by the times of whole runs of so many ``steps`` and of the bare ones; ``events`` in each."""
    over = ratio(times["whole"], times["bare"], BARE_STEPS / steps)
    nanoseconds = 1e9 * min(times["bare"]) / BARE_STEPS
    up = "no" if motion.vertical is None else "yes"
    return f"| {law} | {up} | {substeps} | {over} | {events:.4f} | {nanoseconds:.0f} ns |"


def measure_rigid(motion: Motion, substeps: int, runs: int, repeats: int) -> str:
    """Line of the table for the rigid base: piers of p = 0.38 … 0.5 rad/s."""
    ground, dt = ground_of(motion), float(motion.dt)
    models = [block(Pier(TOWER.alpha, TOWER.p + 0.12 * i / runs), RigidBase()) for i in range(runs)]
    system, lines = system_of(models[0]), [line_of(m, timing(motion, substeps), (0, 0), 0.0, AT_REST) for m in models]
    stop = np.zeros(1, np.uint8)
    ends = march(system, lines, ground, stop, substeps)
    if (ends.status != SURVIVED).any():
        raise SystemExit("rigid: a run ended early; its steps are no measure")
    steps = int(np.rint(ends.t_end / dt * substeps).sum())
    m = models[0]
    alone = (
        Rocker(m.half_width, m.height, m.gravity, m.quickness),
        Tilt(0.1 * m.alpha, 0.0),
        RIGHT,
        ground,
        BARE_ROCKING,
        BARE_STEPS,
    )
    times = interleaved(
        {"whole": lambda: march(system, lines, ground, stop, substeps), "bare": lambda: bare(*alone)}, repeats
    )
    return row("rigid", motion, substeps, times, steps, (ends.impacts + ends.uplifts).sum() / steps)


def pass_alone(motion: Motion, repeats: int) -> str:
    """Return what the lanes' pass takes without any event or sample, a lane, over the bare step."""
    ground, dt = ground_of(motion), float(motion.dt)
    models = [springs(TOWER, of_law("bouc-wen", base)) for base in foundations(LANES)]
    system = system_of(models[0])
    lines = [line_of(m, (dt, 100 * PASSES, 0, 0, len(ground), 0), (0, 0), 0.0, AT_REST) for m in models]
    runs = np.array(lines, record_of(system.line)).view(np.recarray)
    static, contact = static_state(models[0], models[0].gravity), Contact(1.0, 1.0, 1.0, 1.0, 0.0)
    tasks = {
        "pass": lambda: passes(system.traits, table(system.lane)[0], runs, ground, PASSES),
        "bare": lambda: bare(models[0], static, contact, ground, dt, BARE_STEPS),
    }
    times = interleaved(tasks, repeats)
    best, median = ratio(times["pass"], times["bare"], BARE_STEPS / (PASSES * LANES)).split(" | ")
    return f"The lanes' pass alone, bouc-wen, a lane / bare step: best {best}, median {median}"


def waiting(motion: Motion, runs: int, repeats: int) -> str:
    """Return what a step takes of runs on weak supports that wait after a weak motion, over the bare one.

    At each sample it is asked whether they are over.
    """
    weak, bases = motion.times(0.25), [replace(base, beta=0.5 * base.beta, eta=1.5) for base in foundations(runs)]
    waiting_runs = [Run(TOWER, of_law("bouc-wen", base), weak) for base in bases]

    def whole() -> list[Outcome | None]:
        return run_all_fixed(waiting_runs, [1] * runs, QUIET_S, Stop())

    steps = sum(round(end.t_end / weak.dt) for end in whole() if end is not None)
    if steps < 3 * runs * weak.npts:
        raise SystemExit("waiting: the runs were over too soon; their steps are no measure")
    m = springs(TOWER, waiting_runs[0].base)
    alone = (m, static_state(m, m.gravity), Contact(1.0, 1.0, 1.0, 1.0, 0.0), ground_of(weak), weak.dt, BARE_STEPS)
    times = interleaved({"whole": whole, "bare": lambda: bare(*alone)}, repeats)
    best, median = ratio(times["whole"], times["bare"], BARE_STEPS / steps).split(" | ")
    return f"A step of runs that wait after a weak motion, bouc-wen / bare step: best {best}, median {median}"


def on_footings(motion: Motion, runs: int, repeats: int) -> str:
    """Return what a step of runs on footings of 40 strips takes over one of runs on two Bouc–Wen springs, both side by side."""
    ground, stop, over_dt = ground_of(motion), np.zeros(1, np.uint8), 2.0 / float(motion.dt)
    tasks, steps = {}, {}
    for name, base_of in (
        ("footing", lambda base: FootingBase(base.beta, base.eta)),
        ("springs", lambda base: of_law("bouc-wen", base)),
    ):
        models = [model_of(TOWER, base_of(base)) for base in foundations(runs)]
        system, lines = system_of(models[0]), [line_of(m, timing(motion, 2), (0, 0), 0.0, AT_REST) for m in models]
        ends = march(system, lines, ground, stop, 2)
        if (ends.status != SURVIVED).any():
            raise SystemExit(f"{name}: a run ended early; its steps are no measure")
        steps[name] = int(np.rint(ends.t_end * over_dt).sum())
        tasks[name] = partial(march, system, lines, ground, stop, 2)
    times = interleaved(tasks, repeats)
    best, median = ratio(times["footing"], times["springs"], steps["springs"] / steps["footing"]).split(" | ")
    return f"A step of runs on a footing of 40 strips / on two Bouc-Wen springs: best {best}, median {median}"


def sixty_footings(motion: Motion, repeats: int) -> str:
    """Return how long 60 runs on footings take with their error estimates, those of half as many strips included."""
    runs = [Run(TOWER, FootingBase(base.beta, base.eta), motion) for base in foundations(60)]

    def whole() -> list[Outcome | None]:
        return run_all_to_tolerance(runs, 1e-5, QUIET_S, Stop())

    if any(outcome is None or outcome.status != "ok" for outcome in whole()):
        raise SystemExit("footings: a run ended early; its time is no measure")
    times = interleaved({"whole": whole}, repeats)["whole"]
    return f"60 runs on footings of 40 strips to their tolerance: best {min(times):.3f} s"


def with_devices(name: str, base: Base, motion: Motion, substeps: int, repeats: int) -> str:
    """Return the line of one run with two viscous dampers and a tendon, over one without, step by step."""
    ground, stop = ground_of(motion), np.zeros(1, np.uint8)
    tied = replace(base, restraints=DEVICES)
    laws = elements(TOWER, tied)
    m = model_of(TOWER, base)
    system, load = system_of(m), sum(each.prestress for each in laws)
    plain, held = (line_of(m, timing(motion, substeps), (0, 0), each, AT_REST) for each in (0.0, load))

    def run_plain() -> np.recarray:
        return march(system, [plain], ground, stop, substeps)

    def run_held() -> np.recarray:
        return march(system, [held], ground, stop, substeps, devices=equipment_of(system, [(laws, (), math.nan)]))

    ends = [run()[0] for run in (run_held, run_plain)]
    if any(end.status != SURVIVED for end in ends):
        raise SystemExit(f"{name}: a run ended early; its steps are no measure")
    times = interleaved({"held": run_held, "plain": run_plain}, repeats)
    over = ratio(times["held"], times["plain"], ends[1].t_end / ends[0].t_end)
    return f"| {name} | {substeps} | {over} | {1e3 * min(times['held']):.3g} ms |"


def main(repeats: int = 7, runs: int = 64, seconds: float | None = None) -> list[str]:
    """Return the lines of the tables; of the first ``seconds`` of the record only, if given."""
    motion = record(seconds)
    alone = {"rigid": RigidBase(), "bouc-wen": of_law("bouc-wen", foundations(1)[0])}
    return [
        vector_width(),
        f"{runs} runs side by side under {motion.name}, {motion.npts} samples",
        "",
        "| law | vertical | steps per sample | step of whole runs / bare step: best | median | events per step | bare |",
        "| --- | --- | --- | --- | --- | --- | --- |",
        *(
            measure(law, moved, substeps, runs, repeats)
            for law in ("bouc-wen", "elastic", "epp", "hardening")
            for moved in (motion, with_vertical(motion))
            for substeps in (1, 2, 4)
        ),
        *(
            measure_rigid(moved, substeps, runs, repeats)
            for moved in (motion, with_vertical(motion))
            for substeps in (1, 2, 4)
        ),
        "",
        pass_alone(motion, repeats),
        waiting(motion, runs, repeats),
        on_footings(motion, runs, repeats),
        sixty_footings(motion, repeats),
        "",
        "| base | steps per sample | run with devices / plain run, one each: best | median | with devices |",
        "| --- | --- | --- | --- | --- |",
        *(
            with_devices(name, base, motion, substeps, repeats)
            for name, base in alone.items()
            for substeps in (1, 2, 4)
        ),
    ]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=7)
    arguments = parser.parse_args()
    print(machine())
    print("\n".join(main(arguments.repeats)))
