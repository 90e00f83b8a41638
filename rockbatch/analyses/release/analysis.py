"""Release tests: what a pier loses at impacts or in its springs, fitted to a laboratory's times and amplitudes."""

import math
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from rockbatch.analyses.release.fit import Fit, Passages, fitted
from rockbatch.analyses.release.study import ReleaseSpec, read_release
from rockbatch.batch.listening import Progress
from rockbatch.batch.single import simulate
from rockbatch.batch.threads import Engine
from rockbatch.common.arguments import checked
from rockbatch.common.files import made_folder
from rockbatch.common.lazy import pd
from rockbatch.motions import Motion
from rockbatch.outcome.half_cycles import apparent_restitution
from rockbatch.pier import Base, block_period
from rockbatch.simulation.histories import cycles_of
from rockbatch.simulation.recording import recorded
from rockbatch.simulation.runs import Run, run_fixed
from rockbatch.simulation.steps import first_substeps
from rockbatch.study import Case, Motions, Study
from rockbatch.workflow.analysis import Analysis, AnalysisFolder, run_analysis

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

GRIDS = {
    "restitution": np.linspace(0.05, 1.0, 39),
    "epsilon": np.linspace(0.0, 1.0, 26),
    "zeta": np.geomspace(1e-3, 1.0, 31),
}
"""Values of each parameter between which a fit begins; the first and the last are its bounds."""

STEP = 0.005
"""Longest sampling interval of the runs of a fit [s]."""

STEPS_IN_QUARTER = 40
"""Least samples of the way from the release to the first impact."""

POOR_TIMES, POOR_AMPLITUDES = 0.2, 0.1
"""Differences, as shares of a mean half cycle and of the initial rotation, from which a fit is called poor."""

NO_STRETCH = 0.005
"""Share by which all times may be too long or too short without a remark."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Release(Analysis):
    """A fitted release test; see also :class:`rockbatch.workflow.analysis.Analysis`.

    Attributes
    ----------
    release : DataFrame
        A row for each case: the ``parameter`` that is fitted, its ``value`` with ``low`` and ``high`` at the ``confidence``; for
        restitution also over Housner's, ``over_housner``; ``scatter``, its standard deviation from impact to impact;
        ``by_times`` and ``by_amplitudes``, fitted to these alone; ``time_stretch``, the factor on all computed times that would
        fit best beside the value, and its error; root mean squares of measured less computed values; ``remark``, and of it
        the ``doubt``, what speaks against the fit, or "".
    release_impacts : DataFrame
        A row for each case and impact: times [s] and amplitudes [rad], measured and computed, and the apparent restitution.
    release_history : DataFrame
        The rotation [rad] that is computed with the fitted value, against time [s] from the release.
    spec : ReleaseSpec
        The settings in [release] of the study.
    """

    NAME: ClassVar[str] = "release"
    TABLES: ClassVar[tuple[str, ...]] = ("release", "release_impacts", "release_history")

    release: "pd.DataFrame"
    release_impacts: "pd.DataFrame"
    release_history: "pd.DataFrame"
    spec: ReleaseSpec

    def plot(self, width_mm: float = 160.0, ax: "Axes | None" = None) -> "Figure":
        """Draw the computed rotation of each case, and the measured impacts and amplitudes on it: a matplotlib Figure,
        ``width_mm`` wide or in the place of ``ax``."""
        from rockbatch.analyses.release.figures import rotations
        from rockbatch.common.figures.paper import drawn

        return drawn(rotations(self.release_impacts, self.release_history, self.info), width_mm, ax)


@checked
def release(
    study: str | os.PathLike[str] | Study,
    out: str | os.PathLike[str] | None = None,
    *,
    motions: Motions = None,
    jobs: int | Engine | None = None,
    fresh: bool = False,
    progress: Progress = None,
) -> Release:
    """Fit restitution, or the losses of springs, to a release test: [release] of a study, for each of its cases.

    The ground does not move, whatever the motions of the study are.

    Parameters
    ----------
    study, motions, jobs, fresh, progress
        As for :func:`rockbatch.run`; there is nothing to continue.
    out : path, optional
        Folder for the tables, release.json and their section of report.html; without it nothing is kept on disk.

    Returns
    -------
    Release
        With the tables ``release``, ``release_impacts`` and ``release_history``, as their CSV files have them.

    Raises
    ------
    InputError
        With every mistake in the study and in the file of measured values.

    Examples
    --------
    >>> study = rb.Study.from_dict({
    ...     "pier": {"width_m": 0.3, "height_m": 1.2, "initial_rotation_rad": 0.1},
    ...     "motions": {"still_s": 5.0},
    ...     "case": [{"base": "rigid"}],
    ...     "release": {"impact_s": [0.324, 0.858, 1.313, 1.707, 2.048]},
    ... })
    >>> test = rb.release(study)
    >>> test.release[["parameter", "value", "low", "high"]].round(4)
         parameter  value     low    high
    0  restitution  0.8995  0.8938  0.9043
    """
    return run_analysis(Release, read_release, _write_tables, study, out, motions, jobs, fresh, progress)


def _write_tables(results: AnalysisFolder, spec: ReleaseSpec) -> dict[str, object]:
    """Fit each case, and write the tables."""
    made_folder(results.directory)
    study, measured = results.study, Passages(np.array(spec.impact_s), np.array(spec.amplitude_rad))
    results.info |= {"varied": list(study.varied)}
    results.info |= {name: value for name, value in asdict(spec).items() if name not in ("impact_s", "amplitude_rad")}
    rows, impacts, histories = [], [], []
    for case in study.cases:
        test = _Test(case, spec.fits(case), measured, spec)
        results.listener.say(f"{case.name}: fitting {test.parameter}")
        fit = test.fit(measured)
        identity: dict[str, Any] = {"case": case.name, **case.columns}
        table, history = test.laid_over(fit.value)
        rows.append(identity | test.row(fit, table))
        impacts.append(table.assign(**identity))
        histories.append(history.assign(**identity))
    keys = ["case", *study.varied]
    results.keep_table("release.csv", pd.DataFrame(rows))
    for name, parts in (("release_impacts", impacts), ("release_history", histories)):
        table = pd.concat(parts)
        results.keep_table(f"{name}.csv", table[[*keys, *(column for column in table if column not in keys)]])
    return {"spec": spec}


class _Test:
    """The test of one case: its model, and what was measured."""

    def __init__(self, case: Case, parameter: str, measured: Passages, spec: ReleaseSpec) -> None:
        self.case, self.parameter, self.measured, self.spec = case, parameter, measured, spec
        pier = case.pier
        quarter = 0.25 * block_period(pier, abs(pier.initial_rotation_rad))
        last = float(np.nan_to_num(measured.t).max(initial=0.0)) + (quarter if spec.clock == "first impact" else 0.0)
        duration = max(1.25 * last + quarter, 1.5 * (2 * len(measured.t) + 3) * quarter)
        step = min(STEP, quarter / STEPS_IN_QUARTER)
        self.still = Motion.still(duration, step)
        self.model = cache(self._model)  # fits to times, to amplitudes and to both begin with the same values

    def base(self, value: float) -> Base:
        """Return the base with this value of the parameter; on springs without the other loss (``epsilon`` 0, no ``zeta``)."""
        changes: dict[str, Any] = {self.parameter: value}
        if self.parameter != "restitution":
            changes = {"epsilon": 0.0, "zeta": None} | changes
        return replace(self.case.base, **changes)

    def _model(self, value: float) -> Passages:
        """Return the impacts of the pier with this value; those that it lacks are at the end of the run, with amplitude 0."""
        run = Run(self.case.pier, self.base(value), self.still)
        substeps = 2 * first_substeps(run.pier, run.base, run.motion.dt)
        outcome = run_fixed(run.pier, run.base, run.motion, substeps, 0.0, wait=False)
        rows = recorded(run, outcome, 0.0, every_step=False, wait=False).rows
        cycles = cycles_of(run.base, rows)
        n, computed = len(self.measured.t), len(cycles.t) - 1
        t, amplitude = np.full(n, float(rows.t[-1])), np.zeros(n)
        t[:computed], amplitude[:computed] = cycles.t[1 : n + 1], np.nan_to_num(cycles.amplitude[1 : n + 1])
        return Passages(t - t[0] if self.spec.clock == "first impact" else t, amplitude)

    def fit(self, measured: Passages) -> Fit:
        """Return the fit to ``measured`` values, all of the test or only those of a kind."""
        return fitted(measured, self.model, GRIDS[self.parameter], self.spec.confidence, self._shifted)

    def laid_over(self, value: float) -> "tuple[pd.DataFrame, pd.DataFrame]":
        """Return the table of impacts, measured and computed with a value, and the computed history until past the last impact.

        Times count from the first impact if those measured do.
        """
        pier, computed = self.case.pier, self.model(value)
        table = pd.DataFrame({"impact": np.arange(1, len(computed.t) + 1)})
        for name, unit, measured, modelled in (
            ("t", "s", self.measured.t, computed.t),
            ("amplitude", "rad", self.measured.amplitude, computed.amplitude),
        ):
            table[f"{name}_measured_{unit}"], table[f"{name}_computed_{unit}"] = measured, modelled
            table[f"{name}_difference_{unit}"] = measured - modelled
        for name, amplitude in (("measured", self.measured.amplitude), ("computed", computed.amplitude)):
            every = np.concatenate([[abs(pier.initial_rotation_rad)], amplitude])
            table[f"restitution_{name}"] = apparent_restitution(pier, every)[1:]
        response = simulate(pier, self.base(value), self.still, case=self.case.name, quiet_s=0.0)
        cycles = response.half_cycles.reindex(range(len(table) + 1))
        first = cycles["t"].iloc[1] if self._shifted else 0.0
        table["t_amplitude_computed_s"] = cycles["t_amplitude"].to_numpy()[1:] - first
        history = pd.DataFrame({"t_s": response.t - first, "theta_rad": response.theta})
        return table, history[history["t_s"] <= 1.1 * computed.t.max() + self.still.dt]

    @property
    def _shifted(self) -> bool:
        return self.spec.clock == "first impact"

    def row(self, fit: Fit, table: "pd.DataFrame") -> dict[str, object]:
        """Return the row of release.csv: the value with its interval, fits by times or amplitudes alone, residuals, remarks."""
        e = self.case.pier.restitution if self.parameter == "restitution" else math.nan
        apart = {"by_times": self._alone(0), "by_amplitudes": self._alone(1)}
        row = {
            "parameter": self.parameter,
            "value": fit.value,
            "low": fit.low,
            "high": fit.high,
            "confidence": self.spec.confidence,
            "scatter": fit.scatter,
            "impacts": len(table),
        }
        for name, value in (("", fit.value), ("_low", fit.low), ("_high", fit.high)):
            row[f"over_housner{name}"] = value / e if e > 0.0 else math.nan
        for name, best in apart.items():
            for end in ("value", "low", "high"):
                row[name if end == "value" else f"{name}_{end}"] = math.nan if best is None else getattr(best, end)
        row |= {"t_rms_s": fit.t_rms, "amplitude_rms_rad": fit.amplitude_rms}
        row |= {"time_stretch": fit.stretch, "time_stretch_error": fit.stretch_error}
        doubt = self._doubt(fit, apart)
        return row | {"remark": "; ".join(filter(None, (doubt, self._differences(fit)))), "doubt": doubt}

    def _alone(self, kind: int) -> Fit | None:
        """Return the fit to times (0) or amplitudes (1) alone; None unless both were measured three times or more."""
        if any(np.count_nonzero(~np.isnan(values)) < 3 for values in self.measured):
            return None
        nothing = np.full(len(self.measured.t), math.nan)
        return self.fit(Passages(self.measured.t, nothing) if kind == 0 else Passages(nothing, self.measured.amplitude))

    def _differences(self, fit: Fit) -> str:
        """Return the root mean squares of measured less computed values: "…: times by 3.1 ms (0.012 of a mean half cycle)".

        Amplitudes stand behind, in mrad and over the initial rotation; what was not measured is left out.
        """
        first = float(self.model(fit.value).t.max()) / len(self.measured.t)
        differences = []
        if not math.isnan(fit.t_rms):
            differences.append(f"times by {fit.t_rms * 1000.0:.3g} ms ({fit.t_rms / first:.2g} of a mean half cycle)")
        if not math.isnan(fit.amplitude_rms):
            relative = f"{fit.amplitude_rms / abs(self.case.pier.initial_rotation_rad):.2g} of the initial rotation"
            differences.append(f"amplitudes by {fit.amplitude_rms * 1000.0:.3g} mrad ({relative})")
        return f"measured values differ from computed ones by root mean square: {', '.join(differences)}"

    def _doubt(self, fit: Fit, apart: Mapping[str, Fit | None]) -> str:
        """Return what to check, since the fit seems wrong; "" if nothing speaks against it.

        That is the first that holds: the value is at an end of the values, all times are stretched, times and amplitudes
        contradict each other, or the differences are above POOR_TIMES or POOR_AMPLITUDES.
        """
        pier = self.case.pier
        first, start = float(self.model(fit.value).t.max()) / len(self.measured.t), abs(pier.initial_rotation_rad)
        if fit.at_end:
            return "the best value is at the end of what can be: check size, slenderness and initial rotation"
        if abs(fit.stretch - 1.0) > max(fit.stretch_error, NO_STRETCH):
            return (
                f"measured times are {fit.stretch:.3f} ± {fit.stretch_error:.3f} times as long as computed ones, as of a pier "
                f"with p = {pier.p / fit.stretch:.4g} rad/s instead of {pier.p:.4g}: check size, slenderness, initial rotation"
            )
        times, amplitudes = apart["by_times"], apart["by_amplitudes"]
        if (
            times is not None
            and amplitudes is not None
            and (times.low > amplitudes.high or amplitudes.low > times.high)
        ):
            return (
                f"times and amplitudes give values that differ by more than their intervals, {times.value:.4g} and "
                f"{amplitudes.value:.4g}: size, slenderness or initial rotation may differ from those stated"
            )
        if fit.t_rms > POOR_TIMES * first or fit.amplitude_rms > POOR_AMPLITUDES * start:
            return "poor: no value describes the test; check size, slenderness, initial rotation and the clock"
        return ""
