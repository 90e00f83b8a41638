"""Made-up results for the report: correct in form, plausible in size, not computed."""

import csv
import hashlib
import itertools
import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from rockbatch.outcome.response import Response
from rockbatch.pier import Base, ElasticBase, Pier, RigidBase, YieldingBase
from rockbatch.quantities.catalogue import FIXED, TRAILING, names
from rockbatch.reporting import write_report

COLUMNS = names((*FIXED, *TRAILING))
FIG7 = [
    ("ERZ-NS", 0.515), ("RSN779_LOMAP_LGP000", 0.563), ("RSN1120_KOBE_TAK000", 0.611),
    ("RRS228", 0.838), ("SYL360", 0.843), ("CPM000", 1.497),
]  # fmt: skip
FOUNDATIONS: list[tuple[str, Base]] = [
    ("rigid", RigidBase()),
    ("1", YieldingBase(beta=40.0, eta=2.5, epsilon=0.05)),
    ("2", YieldingBase(beta=40.0, eta=3.5, epsilon=0.05)),
    ("3", YieldingBase(beta=80.0, eta=2.5, epsilon=0.05)),
    ("4", YieldingBase(beta=80.0, eta=3.5, epsilon=0.05)),
]


def case_entry(name: str, columns: dict[str, Any], pier: Pier, base: Base) -> dict[str, Any]:
    """Return a case as run.json has it."""
    parameters: dict[str, Any] = {}
    if isinstance(base, RigidBase):
        parameters["restitution"] = base.restitution
    if isinstance(base, ElasticBase):
        omega = base.beta * pier.p
        static = pier.gravity / omega**2
        parameters = {"beta": base.beta, "epsilon": base.epsilon, "kinematics": base.kinematics, "flight": base.flight}
        parameters |= {"omega_v": omega, "delta_s_m": static}
        if isinstance(base, YieldingBase):
            parameters |= {"eta": base.eta, "spring": base.spring, "n": base.n, "delta_y_m": base.eta * static}
    return {
        "case": name,
        "columns": columns,
        "pier": {
            "alpha": pier.alpha, "p": pier.p, "mu": pier.mu, "gravity": pier.gravity,
            "size_m": pier.size, "half_width_m": pier.half_width, "height_m": pier.height,
        },
        "base": base.name,
        "parameters": parameters,
    }  # fmt: skip


def write_results(
    directory: Path,
    *,
    records: list[tuple[str, float]] = FIG7,
    cases: list[dict[str, Any]] | None = None,
    varied: tuple[str, ...] = (),
    polarities: tuple[str, ...] = ("+",),
    scales: tuple[float, ...] = (1.0,),
    vertical: tuple[bool, ...] = (),
    changes: dict[tuple[str, str], dict[str, Any]] | None = None,
    unusable: list[dict[str, str]] | None = None,
    references: list[dict[str, Any]] | None = None,
    **info: Any,
) -> Path:
    """Write peaks.csv and run.json; ``changes`` overwrites cells of the rows of a (record, case)."""
    pier = Pier(alpha=0.13, p=0.38)
    cases = cases if cases is not None else [case_entry(name, {}, pier, base) for name, base in FOUNDATIONS]
    unusable = unusable or []
    changes = changes or {}
    draw = np.random.default_rng(20070625)
    rows: list[dict[str, Any]] = []
    columns = (*COLUMNS, *varied, *(["vertical"] if vertical else []))
    motions = itertools.product(records, polarities, scales, vertical or (None,))
    for ((record, _), polarity, scale, way), case in itertools.product(motions, cases):
        theta = 0.06 * scale * math.exp(draw.normal(0, 0.4))
        springs = case["base"] != "rigid"
        row: dict[str, Any] = dict.fromkeys(columns, "")
        row |= {
            "record": record, "case": case["case"], "polarity": polarity, "scale": scale, "status": "ok",
            "theta_max_over_alpha": theta, "theta_max_error": 3e-6, "t_max_s": draw.uniform(3, 12),
            "impacts": int(draw.integers(4, 60)), "substeps": 4, "t_end_s": 32.0,
        }  # fmt: skip
        if vertical:
            row["vertical"] = way
        if springs:
            row |= {
                "theta_res_over_alpha": draw.normal(0, 0.004), "settlement_m": abs(draw.normal(0.05, 0.02)),
                "separations": int(draw.integers(4, 60)), "base_tilt_rad": draw.normal(0, 5e-4),
                "ductility_left": draw.uniform(0.8, 4), "ductility_right": draw.uniform(0.8, 4),
                "dissipated_left_J_kg": draw.uniform(0, 1), "dissipated_right_J_kg": draw.uniform(0, 1),
                "residual_s": 32.0, "theta_res_drift_per_s": 1e-4, "settlement_drift_m_s": 2e-4,
            }  # fmt: skip
        rows.append(row | case["columns"] | changes.get((record, case["case"]), {}))
    rows += [
        dict.fromkeys(columns, "") | {"record": u["name"], "status": "failed", "reason": u["reason"]} for u in unusable
    ]
    with (directory / "peaks.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, columns)
        writer.writeheader()
        writer.writerows(rows)

    text = '[pier]\nalpha = 0.13\np = 0.38\n\n[[case]]\nname = "rigid"\nbase = "rigid"\n'
    document = {
        "rockbatch": "0.1.0",
        "created": "2025-11-21T10:00:00+00:00",
        "command": ["rockbatch", "run", "configs/fig7.toml", "--jobs", "2"],
        "study": {
            "path": "configs/fig7.toml",
            "title": "Stepping tower, Palmeri & Makris (2007) Fig. 7",
            "notes": "The paper's tower under its six records.\n\nIt prints p as 0.38 and as 0.36 rad/s.",
            "text": text,
            "sha256": hashlib.sha256(text.encode()).hexdigest(),
        },
        "versions": {"python": "3.11.2", "numpy": "2.3.1", "numba": "0.62.0"},
        "machine": "Linux x86_64, 2 cores",
        "numerics": {"tolerance": 1e-4, "substeps": None, "quiet_s": 2.0},
        "varied": list(varied),
        "cases": cases,
        "records": [
            {
                "record": name, "dt_s": 0.005, "npts": 6000, "duration_s": 29.995, "pga_g": pga, "pga_v_g": 0.6 * pga,
                "pgv_m_s": 0.8, "pgd_m": 0.3, "source": f"motions/{name}.AT2",
                "vertical_source": f"motions/{name}-UP.AT2",
                "notes": ["vertical component cut from 6005 to 6000 samples"],
            }
            for name, pga in records
        ],
        "unusable": unusable,
        "references": references or [],
        "runs": len(rows) - len(unusable),
        "jobs": 2,
        "wall_s": 3.21,
    }  # fmt: skip
    (directory / "run.json").write_text(json.dumps(document | info, ensure_ascii=False), encoding="utf-8")
    return directory


def three_piers() -> list[dict[str, Any]]:
    """Return the cases of Fig. 7 for the three values of p that the paper may mean."""
    return [
        case_entry(name, {"p": p}, Pier(alpha=0.13, p=p), base)
        for p in (0.38, 0.36, 0.35)
        for name, base in FOUNDATIONS
    ]


def response(record: str, case: str, base: Base, *, pier: Pier | None = None, **columns: float | str) -> Response:
    """Return histories that look like rocking: two decaying cycles with a ripple at the springs' frequency."""
    pier = pier or Pier(alpha=0.20, p=1.0)
    events = pd.DataFrame({"t": [0.3], "kind": ["separation"], "pivot": ["right"]})
    return Response(record, case, dict(columns), pier, base, "ok", _rocking(pier, base).copy(), events)


@cache
def _rocking(pier: Pier, base: Base) -> pd.DataFrame:
    t = np.linspace(0, 8, 8001)
    rate = 1.5 if isinstance(base, RigidBase) else 1.7
    theta = 0.15 * pier.alpha * np.exp(-0.2 * t) * np.sin(rate * t)
    history = pd.DataFrame({"t": t, "theta": theta, "omega": np.gradient(theta, t)})
    history["ag_h"] = np.where(t < 0.5, pier.gravity * np.sin(4 * np.pi * t), 0.0)
    history["ag_v"] = 0.0
    history["energy"] = 0.7 * np.exp(-0.3 * t) * (t > 0.2)
    springs = ["v", "z_left", "z_right", "v_left", "v_right", "force_left", "force_right"]
    history[springs] = np.nan
    if isinstance(base, ElasticBase):
        ripple = 0.02 * pier.alpha * np.sin(base.beta * pier.p * t) * np.exp(-0.5 * t)
        history["theta"] += ripple
        eta = base.eta if isinstance(base, YieldingBase) else 1.0
        yielding = eta * pier.gravity / (base.beta * pier.p) ** 2
        for side, sign in (("left", 1), ("right", -1)):
            v = yielding * (-1 / eta + sign * 20 * theta / pier.alpha)
            z = np.zeros_like(v)
            z[0] = -1 / eta
            for i in range(1, len(v)):
                z[i] = min(0.0, max(-1.0, z[i - 1] + (v[i] - v[i - 1]) / yielding))
            history[f"v_{side}"], history[f"z_{side}"] = v, z
            history[f"force_{side}"] = 0.5 * eta * pier.gravity * z
        history["v"] = (history["v_left"] + history["v_right"]) / 2
    return history


def report(directory: Path, *responses, **results) -> str:
    """Return the text of the page of made-up results, written into ``directory``."""
    write_results(directory, **results)
    return write_report(directory, responses).read_text(encoding="utf-8")


def histories(**columns):
    """Return responses on rigid ground and on four yielding bases, and what :func:`write_results` takes for these."""
    pier = Pier(alpha=0.2, p=1.0)
    entries = [("rigid", RigidBase())] + [("soil", YieldingBase(beta=50.0, eta=eta)) for eta in (5.0, 3.0, 2.5, 2.2)]
    cases = [case_entry(n, {} if n == "rigid" else {"eta": base.eta}, pier, base) for n, base in entries]
    responses = [
        response("sine", name, base, **({} if name == "rigid" else {"eta": base.eta})) for name, base in entries
    ]
    return responses, {"records": [("sine", 1.0)], "cases": cases, "varied": ("eta",)}
