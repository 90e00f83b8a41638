"""Simulate a single run: its row of peaks.csv and its histories."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TypedDict, Unpack

from rockbatch.batch.observers import observers_beside, observers_of
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError, Problem, refuse
from rockbatch.common.observers import parts
from rockbatch.motions import Motion
from rockbatch.motions.quality.plausible import unlikely_samples
from rockbatch.outcome.outcome import LEAST_NORMAL_SHARE, Outcome
from rockbatch.outcome.response import Response
from rockbatch.pier import Base, Pier, problems, unlikely_devices
from rockbatch.pier.sections import section_heights
from rockbatch.quantities.demands import SECTIONS
from rockbatch.results import sections as of_sections
from rockbatch.results.columns import StudyRun, as_series, row
from rockbatch.simulation.error_control import run_to_tolerance
from rockbatch.simulation.histories import histories
from rockbatch.simulation.leaning import with_lean
from rockbatch.simulation.observing import Observer, observed
from rockbatch.simulation.recording import Recording, recorded
from rockbatch.simulation.runs import Run, run_fixed
from rockbatch.simulation.steps import least_substeps
from rockbatch.study import Case, Numerics, Output
from rockbatch.study.spec import LEAST_TOLERANCE


class Steps(TypedDict, total=False):
    """Settings of :class:`Numerics` by keyword."""

    tolerance: float
    substeps: int | None
    quiet_s: float


@checked
def simulate(
    pier: Pier,
    foundation: Base,
    motion: Motion,
    *,
    case: str | None = None,
    ledger: bool = False,
    forces: bool = False,
    sections: int | Sequence[float] = (),
    devices_work: bool = False,
    least_normal_share: float = LEAST_NORMAL_SHARE,
    wait: bool = True,
    initial_rotation_rad: float | None = None,
    **steps: Unpack[Steps],
) -> Response:
    """Simulate one run; return its histories and its row of peaks.csv.

    Parameters
    ----------
    pier, foundation, motion
        The pier, its base and the ground motion, whose vertical component is used if it has one.
    case : str, optional
        Name of the foundation; its kind by default.
    ledger : bool
        Also keep the energy balance (THEORY.md, Energy ledger).
    forces : bool
        Also keep forces and impacts (THEORY.md, Forces).
    sections : int or list of float
        Heights [m] of sections of the shaft, or their number from foot to top, whose greatest forces are also kept
        (THEORY.md, Forces in sections).
    devices_work : bool
        Add the work of devices to the row, as ``[output] devices_work`` of a study; :meth:`Response.device_work` gives that of
        each device.
    least_normal_share : float
        With ``forces``: share of the weight, between 0 and 1, that the normal force must exceed for V/N to count; as
        ``[output] least_normal_share`` of a study.
    initial_rotation_rad : float, optional
        Rotation from which the pier is released [rad], instead of its own; see :class:`rockbatch.Pier`.
    tolerance : float, default 1e-4
        Tolerance of θ_max/α; the steps per sample are chosen to meet it.
    substeps : int, optional
        Fixed number of steps per sample, instead of a tolerance.
    quiet_s : float, default 2
        Free-vibration tail after the record [s].
    wait : bool
        Continue after ``quiet_s`` until nothing later can exceed the peak; False, with ``substeps``, ends there.

    Returns
    -------
    Response
        ``status``, ``theta_max`` [rad], ``theta_max_error``, ``settlement`` [m], ``reason``, the ``row`` without the settlement
        by the other spring law, and the histories ``t``, ``theta``, …, of the same steps, computed when the first is asked for.

    Raises
    ------
    InputError
        If the pier cannot stand on the foundation; if a device or the motion is implausible and not named in its
        ``confirm``; if the run would take too many steps.

    Examples
    --------
    >>> motion = rb.pulse("sine", name="one-sine", amplitude=9.81, period=0.5, dt=0.005, duration=2.0)
    >>> response = rb.simulate(rb.Pier(alpha=0.2, p=1.0), rb.RigidBase(), motion)
    >>> response
    <response one-sine, rigid>
      θ_max/α  0.17801 ± 3e-12 at 1.30 s
      history  808 rows until 4.00 s
      events   1 × lift-off, 3 × impact
    >>> response.plot().savefig("one-sine.pdf")
    """
    if initial_rotation_rad is not None:
        pier = replace(pier, initial_rotation_rad=initial_rotation_rad)
    numerics, run = Numerics(**steps), Run(pier, foundation, motion)
    _check(run, numerics, least_normal_share, wait)
    if sections:
        section_heights(pier, sections)
    name, outcome, quiet_s = case or foundation.name, _outcome(run, numerics, wait), numerics.quiet_s
    heights = {"sections": sections} if isinstance(sections, int) else {"sections_m": tuple(sections)}
    asked = {"ledger": ledger, "forces": forces, "devices_work": devices_work, **heights}
    asked |= {"least_normal_share": least_normal_share} if forces else {}
    output = Output.with_keys(**{key: value for key, value in asked.items() if value})
    observers = (*observers_of(output), *observers_beside(output, [motion]))
    kept = HistoriesOfRun(name, observers, foundation.remembers)
    if observers:
        (outcome,) = observed([run], [outcome], (*observers, kept), quiet_s, error=numerics.substeps is None, wait=wait)
    finished = StudyRun(motion, "+", 1.0, Case(name, pier, foundation, {}), outcome=outcome)
    beside = {
        "row": as_series(row(finished)),
        "sections": of_sections.as_table(outcome.tables[SECTIONS]) if sections else None,
        **{name: table(motion, outcome) for name, table in parts("table.OF_RESPONSE")},
    }
    if observers:
        response = outcome.tables.get(kept.table) or _recorded(kept, run, outcome, quiet_s, wait)
        return replace(response, **beside)
    later = partial(_read, kept, run, outcome, quiet_s, wait)
    settings = {"record": motion.name, "case": name, "columns": {}, "pier": pier, "base": foundation}
    return Response.unread(later, **settings, status=outcome.status, **beside)


def _read(kept: "HistoriesOfRun", run: Run, outcome: Outcome, quiet_s: float, wait: bool) -> Response:
    """Return the histories of a run that no other observer reads; recorded apart if it is too long for observers."""
    (outcome,) = observed([run], [outcome], [kept], quiet_s, error=False, wait=wait)
    return outcome.tables.get(kept.table) or _recorded(kept, run, outcome, quiet_s, wait)


def _recorded(kept: "HistoriesOfRun", run: Run, outcome: Outcome, quiet_s: float, wait: bool) -> Response:
    """Return the histories of a run that is too long for observers."""
    return kept.read(recorded(run, outcome, quiet_s, kept.every_step, wait), outcome)


@dataclass(frozen=True)
class HistoriesOfRun(Observer):
    """Observer that keeps the histories of a run of ``case``, with those that other ``observers`` add."""

    case: str
    observers: tuple[Observer, ...]
    remembers: bool = False
    """Whether the state of the ground follows from every step."""

    table = "histories"

    @property
    def every_step(self) -> bool:  # type: ignore[override]
        """Return whether the histories need every step: the ground remembers, or one of the observers adds to them by steps."""
        return self.remembers or any(observer.histories_of_steps for observer in self.observers)

    def claims_error(self, outcome: Outcome) -> bool:
        """Return False: histories have no error."""
        return False

    def read(self, recording: Recording, outcome: Outcome) -> Response:
        """Return the histories of the run, with those of the observers."""
        return histories(recording, outcome.status, self.case, {}, self.observers)

    def add(self, run: Run, outcome: Outcome, fine: Response | None, coarse: None) -> Outcome:
        """Return ``outcome`` with the histories ``fine`` as its table "histories"; unchanged without them."""
        return outcome if fine is None else outcome.with_table(self.table, fine)


def _outcome(run: Run, numerics: Numerics, wait: bool) -> Outcome:
    """Simulate a run and separate rocking from lean; raise ``InputError`` if the run is refused."""
    quiet_s, settings = numerics.quiet_s, (run.pier, run.base, run.motion)
    if numerics.substeps is None:
        outcome = run_to_tolerance(*settings, numerics.tolerance or 0.0, quiet_s)
    else:
        outcome = run_fixed(*settings, numerics.substeps, quiet_s, wait=wait)
    if not outcome.was_run:
        raise InputError(f"{run.motion.name}: {outcome.reason}")
    return with_lean([run], [outcome], quiet_s, wait=wait)[0]


def _check(run: Run, numerics: Numerics, least_normal_share: float, wait: bool) -> None:
    """Raise ``InputError`` with every impossible or implausible value of a run and its settings."""
    pier, base, motion, substeps = run.pier, run.base, run.motion, numerics.substeps
    tolerance = numerics.tolerance or 0.0
    wrong: list[Problem | str] = [*(problems(pier, base) or unlikely_devices(pier, base.restraints))]
    wrong += unlikely_samples(motion, pier.gravity)
    if not tolerance >= LEAST_TOLERANCE:
        wrong.append(f"tolerance = {tolerance:g}: must be {LEAST_TOLERANCE:g} or above (on theta_max/alpha)")
    if not (math.isfinite(numerics.quiet_s) and numerics.quiet_s >= 0):
        wrong.append(f"quiet_s = {numerics.quiet_s:g}: must be 0 or more [s]")
    if substeps is None and not wait:
        wrong.append("wait = False: a run that is cut off has no error estimate; give substeps")
    if substeps is not None and not wrong and substeps < (least := least_substeps(pier, base, motion.dt)):
        wrong.append(f"substeps = {substeps}: must be a whole number of at least {least} for this pier and motion")
    if not 0.0 < least_normal_share < 1.0:
        wrong.append(f"least_normal_share = {least_normal_share:g}: must be above 0 and below 1, a share of the weight")
    refuse(wrong)
