"""Moment and settlement over rotation of a pier on two footings under the same record."""

from pathlib import Path

from matplotlib.figure import Figure

import rockbatch as rb

RECORDS = Path(__file__).parents[2] / "motions" / "near_fault" / "imperialvalley1979_meloland"
PIER = rb.Pier.with_deck(width_m=10, height_m=30, mass_t=2000, deck_mass_t=1000)
GROUNDS = {
    "dense sand": rb.FootingBase.from_soil(PIER, 120, 0.3, length_m=12, bearing_MPa=2.5),
    "clay": rb.FootingBase.from_soil(PIER, 40, 0.45, length_m=12, bearing_MPa=0.75),
}


def draw() -> Figure:
    motion = rb.read_motions(RECORDS).motions[0]
    figure = Figure(figsize=(8.0, 4.0), layout="constrained")
    moment, depth = figure.subplots(1, 2)
    for name, base in GROUNDS.items():
        history = rb.simulate(PIER, base, motion).history
        arm = PIER.half_width * (history["force_left"] - history["force_right"]) / PIER.gravity
        middle = 0.5 * (history["v_left"] + history["v_right"])
        moment.plot(1000 * history["theta"], arm, lw=0.8, label=f"{name}, FS = {base.safety_factor:.1f}")
        depth.plot(1000 * history["theta"], 1000 * middle, lw=0.8)
    moment.legend(frameon=False)
    moment.set(xlabel="rotation [mrad]", ylabel="moment of the ground over weight [m]")
    depth.set(xlabel="rotation [mrad]", ylabel="height of the middle of the foot [mm]")
    figure.suptitle("Meloland, Imperial Valley 1979")
    return figure
