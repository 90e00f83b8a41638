"""Rocking spectra: θ_max/α over the size of the pier, for given slendernesses, on every base of a study.

The peak rotation of a rocking block under a given motion is a function of α and p alone, as that of an oscillator is
one of damping and period (Makris & Konstantinidis 2003, Earthq. Eng. Struct. Dyn. 32, 265–289). On springs it is one of
their parameters too, which stay as the study has them.

Of slender blocks with one restitution, θ_max/α is a function of ω_g/p and a_g/(g tan α) alone, with a frequency ω_g and an
acceleration a_g that describe a motion of given shape (Dimitrakopoulos & DeJong 2012, Proc. R. Soc. A 468, 2294–2318). A
self-similar spectrum has these for axes, with a_g = PGA and ω_g = PGA/PGV of each record.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace

from rockbatch.analyses.spectrum.study import INTENSITY, SELF_SIMILAR, SpectrumSpec
from rockbatch.batch.plan import Made, Plan, Runs
from rockbatch.common.analyses import Entry
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.common.statuses import NOT_STANDING
from rockbatch.motions import Motion, MotionSet
from rockbatch.motions.intensity import measures
from rockbatch.quantities.statistics import FRACTILES_FROM
from rockbatch.results.columns import StudyRun, row
from rockbatch.results.suite_statistics import suite
from rockbatch.study import Study

FILE = "spectrum.csv"
SUITE = "spectrum_suite.csv"
GROUP = ("case", "scale")
"""Columns, beside the varied ones, that identify a point of a spectrum."""

SIZE = ("p", "two_pi_over_p_s", "size_m")
OWN, ENDS = ("size_m", "scale"), {"least": "min", "greatest": "max"}
"""Columns of which a point of a self-similar spectrum has the ends, since each record has its own value, and their names."""

RESULTS = (
    "record",
    "polarity",
    "status",
    "theta_max_over_alpha",
    "theta_max_error",
    "t_max_s",
    "impacts",
    "flight_s",
    "substeps",
    "reason",
)


def plan(study: Study, spectrum: SpectrumSpec, motions: MotionSet) -> Runs:
    """Return the runs of a spectrum: each motion and scale of the study, in the polarity that is simulated, on each of its piers.

    Those of a self-similar one have PGA/(g tan α) in place of the scale.
    """
    if spectrum.axis == SELF_SIMILAR:
        return _self_similar(study.motions.simulated, spectrum, motions.motions)
    once = replace(study.motions, polarity=(study.motions.simulated,))
    return Plan(replace(study, cases=spectrum.cases, motions=once), motions)


def _self_similar(polarity: str, spectrum: SpectrumSpec, motions: Sequence[Motion]) -> Made:
    """Return the runs of a self-similar spectrum: record, PGA/(g tan α), case, the last running fastest.

    Raises ``InputError`` for a motion without acceleration.
    """
    frequencies = [_frequency(motion) for motion in motions]

    def make(number: int) -> StudyRun:
        rest, place = divmod(number, len(spectrum.cases))
        of_motion, level = divmod(rest, len(spectrum.intensities))
        case, intensity, motion = spectrum.cases[place], spectrum.intensities[level], motions[of_motion]
        pier = replace(case.pier, p=case.pier.p * frequencies[of_motion], confirm=("p",))
        scale = intensity * pier.gravity * math.tan(pier.alpha) / motion.pga
        scaled_case = replace(case, pier=pier, columns=case.columns | {INTENSITY: intensity})
        return StudyRun(motion, polarity, scale, scaled_case)

    return Made(len(motions) * len(spectrum.intensities) * len(spectrum.cases), make)


def _frequency(motion: Motion) -> float:
    """Return ω_g = PGA/PGV [rad/s] of a motion; raises ``InputError`` if the ground does not move."""
    pgv = measures.pgv(motion.horizontal, motion.dt, motion.initial)
    if not (motion.pga > 0.0 and pgv > 0.0):
        raise InputError(f"{motion.name}: PGA/PGV has no value, for the ground does not move; leave the record out")
    return motion.pga / pgv


def columns(spectrum: SpectrumSpec) -> list[str]:
    """Return the columns of spectrum.csv: the point of the spectrum, and the results of one motion there."""
    return [*dict.fromkeys((*GROUP, *spectrum.varied, *SIZE, *RESULTS))]


def groups(varied: Sequence[str]) -> list[str]:
    """Return the columns that identify a point of a spectrum; of a self-similar one without the scale, which each record has."""
    return [name for name in (*GROUP, *varied) if name != "scale" or SELF_SIMILAR not in varied]


def row_of(run: StudyRun) -> dict[str, object]:
    """Return the row of spectrum.csv of a run that is finished."""
    pier = run.case.pier
    size = {"p": pier.p, "two_pi_over_p_s": 2 * math.pi / pier.p, "size_m": pier.size}
    return size | row(run)


def of_suite(table: "pd.DataFrame", varied: Sequence[str], stations: Mapping[str, str]) -> "pd.DataFrame":
    """Return the statistics of the suite at every point of the spectrum from the rows of spectrum.csv.

    ``stations`` has that of each record.

    A row for each case, scale and pier has the 16, 50 and 84 % quantiles of θ_max/α over the motions (``p16``, ``median``,
    ``p84``), and the greatest (``largest``); of fewer than 6 stations ``p16`` and ``p84`` are empty. A run that overturned, or
    was ended by flight, counts as infinite; a failed one is unknown and only counted. At a point of a self-similar spectrum
    every record has its own pier and scale: of these it has the least and the greatest.
    """
    keys = groups(varied)
    rows: list[Entry] = []
    for names, runs in table.groupby(keys, sort=False, dropna=False):
        statistics = asdict(suite(runs["theta_max_over_alpha"].to_numpy(float), runs["status"].tolist()))
        known = {stations[name] for name in runs["record"][runs["status"] != "failed"]}
        ends = statistics.pop("low"), statistics.pop("high")
        statistics["p16"], statistics["p84"] = ends if len(known) >= FRACTILES_FROM else (math.nan, math.nan)
        rows.append(dict(zip(keys, names, strict=True)) | _sizes(runs, varied) | statistics)
    shown = ("count", "p16", "median", "p84", "largest", *NOT_STANDING)
    return pd.DataFrame(rows, columns=[*dict.fromkeys((*keys, *_sizes(table, varied), *shown))])


def _sizes(runs: "pd.DataFrame", varied: Sequence[str]) -> dict[str, float]:
    """Return p, 2π/p and R0 of the pier of these runs, NaN without runs; of a self-similar spectrum the ends of R0 and scale."""
    if SELF_SIMILAR in varied:
        return {f"{end}_{name}": getattr(runs[name], method)() for name in OWN for end, method in ENDS.items()}
    return {name: runs[name].iloc[0] if len(runs) else math.nan for name in SIZE}
