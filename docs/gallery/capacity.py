"""Moment over axial force of a section in the run that uses most of its capacity, and the capacity."""

from pathlib import Path

from matplotlib.figure import Figure

import rockbatch as rb
from rockbatch.batch.preparing import ground_motions
from rockbatch.observers.interaction.envelopes import envelope
from rockbatch.simulation import Run, run_to_tolerance
from rockbatch.simulation.recording import recorded
from rockbatch.simulation.sections import forces_in_sections

STUDY = rb.load_study(Path(__file__).parents[2] / "configs" / "capacities.toml")
RECORD = "WTMC"
HEIGHT = 12.0


def draw() -> Figure:
    (check,) = (check for check in STUDY.checks if check.at_m == HEIGHT)
    motion = next(motion for motion in ground_motions(STUDY).motions if RECORD in motion.name)
    case = STUDY.cases[-1]
    run, numerics = Run(case.pier, case.base, motion), STUDY.numerics
    outcome = run_to_tolerance(case.pier, case.base, motion, numerics.tolerance, numerics.quiet_s)
    rows = recorded(run, outcome, numerics.quiet_s, every_step=True).rows
    (forces,) = forces_in_sections(run, rows, [HEIGHT])
    along = slice(len(rows))
    axial, moment = case.pier.mass_t * forces.axial[along], case.pier.mass_t * abs(forces.moment[along])
    corners = envelope(HEIGHT, axial, moment)
    figure = Figure(figsize=(6.4, 3.6), layout="constrained")
    axes = figure.subplots()
    axes.plot(axial / 1e3, moment / 1e3, lw=0.6, color="0.6", label="path of the run")
    axes.plot(corners.axial / 1e3, corners.effect / 1e3, ".-", ms=4, lw=1.0, label="its envelope")
    most = zip(*((n / 1e3, m / 1e3) for n, m in check.curve), strict=True)
    axes.plot(*most, color="tab:red", label="capacity")
    axes.plot(min(axial) / 1e3, max(moment) / 1e3, "x", color="k", label="greatest M with least N")
    axes.legend(frameon=False)
    axes.set(xlabel="N [MN], compression positive", ylabel="|M| [MN m]", ylim=(0, None), xlim=(None, 80))
    return figure
