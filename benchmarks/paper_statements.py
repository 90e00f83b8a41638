"""What the text and the axes of Palmeri & Makris (2007), Figs. 5 and 6, state, and which of it each impact gives.

    python benchmarks/paper_statements.py [--perturbed 12]

Twenty-one statements, for an impulse at the landing pivot (ε = 0.10) and for Housner's e. With ``--perturbed`` each is also tried
on so many runs whose β, η and amplitude differ by up to 1 %: a statement that many of them do not share is chaotic.
"""

import argparse
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

import rockbatch as rb

IMPACTS = {"landing": {"epsilon": 0.10}, "housner": {}}
ETAS, BETAS = (5.0, 3.0, 2.5, 2.2), (20.0, 40.0, 60.0, 100.0)
SHOWN_S = 7.0
"""Time to which the figures go [s]."""

DT = 0.005


@dataclass(frozen=True)
class Shown:
    """What a panel shows, up to SHOWN_S."""

    peak: float  # greatest |θ|/α
    speed: float  # greatest |θ̇|/(α p)
    residual: float  # static rotation on the deformed base/α
    late: float  # greatest θ/α of the last two seconds
    energy: float  # mean of the last two seconds [J/kg]
    energy_max: float
    left: float  # greatest deflection/δ_y
    right: float
    force: float  # greatest |F|/F_y
    plastic: float  # work [J/kg]


def shown(pier: rb.Pier, base: rb.YieldingBase, motion: rb.Motion) -> Shown:
    """Run a panel in steps that resolve its springs, without waiting for what comes later."""
    steps = math.ceil(base.beta * pier.p * DT / 0.05)
    response = rb.simulate(pier, base, motion, substeps=steps, quiet_s=0.0, wait=False)
    row, last = response.row, response.t > SHOWN_S - 2.0
    return Shown(
        peak=row.theta_max_over_alpha,
        speed=float(np.abs(response.omega).max()) / (pier.alpha * pier.p),
        residual=row.theta_res_over_alpha,
        late=float(response.theta[last].max()) / pier.alpha,
        energy=float(response.energy[last].mean()),
        energy_max=float(response.energy.max()),
        left=row.ductility_left,
        right=row.ductility_right,
        force=float(max(np.abs(response.z_left).max(), np.abs(response.z_right).max())),
        plastic=(row.dissipated_left_J_kg + row.dissipated_right_J_kg),
    )


def figure(impact: str, number: int, scatter: Sequence[float] = (1.0, 1.0, 1.0)) -> tuple[list[Shown], float]:
    """Return the panels of Fig. 5 or 6, and the rigid peak/α; ``scatter`` are factors on β, η and the amplitude."""
    of_beta, of_eta, of_amplitude = scatter
    shape, period, alpha = ("sine", 0.5, 0.20) if number == 5 else ("cosine", 1.0, 0.15)
    pier = rb.Pier(alpha=alpha, p=1.0)
    motion = rb.pulse(shape, name=shape, amplitude=9.81 * of_amplitude, period=period, dt=DT, duration=SHOWN_S)
    values = [(50.0, eta) for eta in ETAS] if number == 5 else [(beta, 2.5) for beta in BETAS]
    panels = [
        shown(
            pier,
            rb.YieldingBase(of_beta * beta, eta=of_eta * eta, flight="stop", impact=impact, **IMPACTS[impact]),
            motion,
        )
        for beta, eta in values
    ]
    rigid = rb.simulate(pier, rb.RigidBase(flight="stop"), motion, substeps=8, quiet_s=0.0, wait=False)
    return panels, rigid.row.theta_max_over_alpha


def statements(impact: str, scatter: Sequence[float] = (1.0, 1.0, 1.0)) -> dict[str, bool]:
    """Return the 21 statements, and whether they hold."""
    return dict(_of_fig5(*figure(impact, 5, scatter))) | dict(_of_fig6(*figure(impact, 6, scatter)))


def _of_fig5(panels: Sequence[Shown], rigid: float) -> Iterator[tuple[str, bool]]:
    strong, *weak = panels
    band = 4.0 / 3.0 / (50.0**2 * math.sin(0.20)) / 0.20  # eq. (10) of the paper, over α
    yield "5: eta = 5 is elastic", strong.force < 0.75
    for eta, above, below in zip(ETAS[1:], panels, weak, strict=False):
        yield f"5: the peak falls to eta = {eta:g}", below.peak < above.peak
    for eta, panel in zip(ETAS[1:], weak, strict=True):
        yield f"5: eta = {eta:g} ends tilted to the left", panel.residual < 0.0
    for eta, panel in zip(ETAS[1:], weak, strict=True):
        yield f"5: eta = {eta:g} yields more on the left", panel.left > panel.right
    yield "5: eta = 2.2 ends below its band", panels[-1].late < -band
    yield "5: eta = 2.2 ends with energy below 0", panels[-1].energy < 0.0
    yield "5: the others do not", all(panel.energy >= 0.0 for panel in panels[:-1])
    yield "5: eta = 5 peaks as on rigid ground (2 %)", abs(strong.peak / rigid - 1.0) < 0.02
    yield "5: weaker springs dissipate more", all(a.plastic < b.plastic for a, b in zip(panels, weak, strict=False))
    yield (
        "5: all stays within the axes",
        all(
            panel.peak < 0.25 and panel.speed < 1.0 and panel.energy_max < 1.0 and max(panel.left, panel.right) < 7.0
            for panel in panels
        ),
    )


def _of_fig6(panels: Sequence[Shown], rigid: float) -> Iterator[tuple[str, bool]]:
    demands = [max(panel.left, panel.right) for panel in panels]
    yield "6: the peak grows with beta", all(a.peak < b.peak for a, b in pairwise(panels))
    yield "6: all peaks are below the rigid one", all(panel.peak < rigid for panel in panels)
    yield "6: the demand on springs grows with beta", demands == sorted(demands)
    yield "6: up to beta = 60 springs stay within -6 (7)", max(demands[:-1]) < 7.0
    yield "6: at beta = 100 one goes beyond -12", 12.0 < demands[-1] < 18.0


def main(perturbed: int) -> None:
    """Print both impacts side by side, and the share of perturbed runs in which each statement holds."""
    rng = np.random.default_rng(1)
    scatters = [tuple(1.0 + rng.uniform(-0.01, 0.01, 3)) for _ in range(perturbed)]
    found = {impact: statements(impact) for impact in IMPACTS}
    shares = {impact: [statements(impact, scatter) for scatter in scatters] for impact in IMPACTS}
    print(f"{'':48}{'landing':>14}{'housner':>14}")
    for name in found["landing"]:
        cells = []
        for impact in IMPACTS:
            also = f" {sum(each[name] for each in shares[impact])}/{perturbed}" if perturbed else ""
            cells.append(f"{'yes' if found[impact][name] else 'no'}{also}")
        print(f"{name:48}" + "".join(f"{cell:>14}" for cell in cells))
    totals = [f"{sum(found[impact].values())}" for impact in IMPACTS]
    print(f"{'of 21':48}" + "".join(f"{total:>14}" for total in totals))
    if perturbed:
        means = [sum(sum(each.values()) for each in shares[impact]) / perturbed for impact in IMPACTS]
        print(f"{f'mean of {perturbed} runs':48}" + "".join(f"{mean:14.1f}" for mean in means))


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description="Which statements of the paper each impact gives.")
    arguments.add_argument("--perturbed", type=int, default=0, help="runs that differ by up to 1 %%")
    main(arguments.parse_args().perturbed)
