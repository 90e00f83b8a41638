"""Studies of fragility, and analyses of made-up runs."""

import csv
from dataclasses import replace

import numpy as np
from studies import PADS, RIGID, SINE, study_text, write_study

from rockbatch.analyses.fragility.curves import assess
from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.batch.digests import digests
from rockbatch.batch.journal import Journal
from rockbatch.results.columns import columns
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

STRIPES = 'measure = "PGA"\nlevels_g = [0.2, 0.4, 0.6, 0.8]'
IDA = f'method = "ida"\ntolerance = 0.02\n{STRIPES}'


def check(name, demand, reason, **limit):
    return {"name": name, "demand": demand, **limit, "reason": reason}


def written(tmp_path, fragility):
    shapes = [("sine", 0.6), ("sine", 1.0), ("cosine", 0.7), ("ricker", 0.9), ("ricker", 1.4)]
    text = study_text(
        title="Fragility of a small pier", pier={"alpha": 0.2, "p": 2.0}, motions={"polarity": ["+", "-"]},
        pulses=[
            SINE | {"name": f"{shape} {t} s", "shape": shape, "amplitude_g": 0.4, "period_s": t, "duration_s": 4.5}
            for shape, t in shapes
        ],
        cases=(RIGID, PADS | {"beta": 60, "eta": 3.0, "epsilon": 0.1, "flight": "guided"}), numerics={"tolerance": 1e-3},
        check=[
            check("half way", "theta_max_over_alpha", "margin", at_most=0.5),
            check("settlement", "settlement_m", "bearings", at_most=0.005),
            check("bearing", "eta", "of the case, about no record", at_least=2.0),
        ],
    )  # fmt: skip
    return write_study(tmp_path, f"{text}\n[fragility]\n{fragility}\n")


def read(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def journal_of(study, spec, directory):
    found = ground_motions(study).motions
    return found, Journal(directory / "runs.csv.part", columns(study), digests(found, levels=spec))


def of_statuses(statuses, theta=0.4, error=0.01):
    """Rows of peaks.csv with these statuses."""
    import pandas as pd

    n = len(statuses)
    rows = {"status": statuses, "theta_max_over_alpha": [theta] * n, "theta_max_error": [error] * n}
    flew = [1.0 if status == "flight" else np.nan for status in statuses]
    return pd.DataFrame(rows | {"flight_s": flew, "polarity": ["+"] * n})


def made_up(tmp_path, fragility, status_of, limits=None, motions=30, **more):
    """Curves of the rigid case through runs with a status by number of the motion and intensity."""
    study = load_study(written(tmp_path, fragility))
    study = replace(study, cases=study.cases[:1])
    spec = read_fragility(study)
    spec = replace(spec, limits=limits or spec.limits[:1], **more)
    one = ground_motions(study).motions[0]
    scaled = [replace(one, name=f"motion {m}") for m in range(motions)]

    def simulate(runs):
        return of_statuses([status_of(point.motion, point.intensity) for point in runs.points])

    return assess(study, spec, scaled, simulate), spec, study


def lognormal_capacities(motions=30, median=0.5, dispersion=0.4):
    from scipy.special import ndtri

    return median * np.exp(dispersion * ndtri((np.arange(motions) + 0.5) / motions))


CAPACITIES = lognormal_capacities()


def stands_or_falls(motion, x):
    return "overturned" if x >= CAPACITIES[motion] else "ok"
