"""Results of one run, without its histories."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any, NamedTuple

from rockbatch.common.statuses import Status

RELEASED = "theta_max is the rotation from which the pier was let go, which it did not exceed"
"""Note on a run whose greatest rotation is its initial one."""

LEANS = "lean"
"""Value of ``theta_max_is`` if the peak is mostly the lean of a base that has yielded."""


class Failure(StrEnum):
    """Kind of failure of a run; its ``reason`` describes it."""

    CONTACTS = "contacts"  # too many contact events within one sample
    BLEW_UP = "blew up"  # the integration diverged
    UNDECIDED = "undecided"  # the pier may still overturn in free vibration after the record
    RATCHETS = "ratchets"  # its springs ratchet in free vibration after the record
    NOT_SETTLED = "not settled"  # the results did not converge when the step was halved
    LARGE_STEP = "large step"  # refused: a fixed step too large for the springs
    MANY_STEPS = "many steps"  # refused: it would take too many steps
    UNUSABLE = "unusable"  # its record cannot be used


TERMS = (
    "kinetic",
    "potential",
    "elastic",
    "input",
    "plastic",
    "impact",
    "p_delta",
    "constraint",
    "damping",
    "remainder",
)
"""Terms of the energy ledger, in the order in which the core returns them."""


LEAST_NORMAL_SHARE = 0.1
"""Of the weight: the normal force below which shear keys, not friction, bear the base shear."""


@dataclass(frozen=True)
class BedDemands:
    """Demands on the bed of a footing; SI units, per unit mass of the pier."""

    contact_least: float  # least share of the foot that was pressed
    # greatest push of the bed on the foot [m/s²], dashpots included, and its time [s]
    force: float
    t_force: float
    pressure: float | None  # greatest pressure at an edge [MPa]; None if mass or length is not known
    # its time [s], and the place of that edge [m], positive to the right
    t_pressure: float
    pressure_at: float
    yielding_rocks: int  # rocks to one side in which the ground yielded: half cycles
    work: float  # plastic work of the ground [J/kg]
    # settlements of both edges of the foot at rest [m]
    settlement_left: float | None = None
    settlement_right: float | None = None
    strips_error: float | None = None  # share of the error of ``theta_max`` that the number of strips has [rad]
    # estimated errors of ``force`` [m/s²], ``pressure`` [MPa] and ``work`` [J/kg] by step and strips
    force_error: float | None = None
    pressure_error: float | None = None
    work_error: float | None = None

    def mirrored(self) -> "BedDemands":
        """Return the demands of the mirror image: edges exchanged, and ``pressure_at`` with the other sign."""
        return replace(
            self,
            pressure_at=0.0 - self.pressure_at,
            settlement_left=self.settlement_right,
            settlement_right=self.settlement_left,
        )


@dataclass(frozen=True)
class Outcome:
    """Results of a run. SI units, angles in radians; ``None`` if a result does not apply."""

    status: Status  # "ok", "overturned", "flight" (the run was stopped by it) or "failed"
    reason: str  # reason that it failed or left the ground, for people; empty otherwise
    # greatest rotation |θ| [rad] until the end of the run, and its time [s]
    theta_max: float
    t_max: float
    # Counts; on the rigid base a separation is a lift-off from rest. On springs a pivot that its own impact throws up again has
    # separated, too, without an event of its own.
    impacts: int
    separations: int
    t_flight: float | None  # first time at which neither pivot was in contact [s]
    t_end: float  # end of the run [s]
    substeps: int  # steps per sample
    # Estimated error of ``theta_max`` [rad], as of others below: ``None`` with a fixed step, or if the result is chaotic; errors
    # of residuals include their drift while they were read, and the further change as dampers slip.
    theta_max_error: float | None = None
    theta_res: float | None = None  # residual rotation, static on the deformed base [rad]
    theta_res_error: float | None = None
    base_tilt: float | None = None  # residual tilt of the base itself [rad]
    settlement: float | None = None  # mean plastic settlement of the supports since the start [m]
    # time at which residual rotation, tilt and settlement on yielding springs were read [s] (THEORY.md, Results of a run)
    t_read: float | None = None
    # their rates of change then [m/s, rad/s]
    settlement_drift: float | None = None
    theta_res_drift: float | None = None
    # greatest deflection of each support over its yield deflection
    ductility_left: float | None = None
    ductility_right: float | None = None
    # plastic work in each spring [J/kg]
    dissipated_left: float | None = None
    dissipated_right: float | None = None
    # greatest force over M g, elongation [m] and speed [m/s] of any damper; total energy [J/kg]
    damper_force: float | None = None
    damper_stroke: float | None = None
    damper_speed: float | None = None
    damper_energy: float | None = None
    # greatest force over M g and plastic elongation [m] of any tendon; number of times that tendons went slack
    tendon_force: float | None = None
    tendon_yield: float | None = None
    tendon_slack: int | None = None
    # greatest force over M g and deflection [m] of any stop; number of blows; total energy [J/kg]
    stop_force: float | None = None
    stop_depth: float | None = None
    stop_blows: int | None = None
    stop_energy: float | None = None
    # the same of deck springs
    deck_spring_force: float | None = None
    deck_spring_depth: float | None = None
    deck_spring_blows: int | None = None
    deck_spring_energy: float | None = None
    note: str = ""  # remarks on a valid run for people, e.g. counts that did not converge
    # greatest relative error of these demands except counts; relative to at least 1 % of each demand's scale
    devices_error: float | None = None
    # greatest rotation |θ| until the record's last sample, or the end of a run that ended before it [rad]
    theta_max_in_motion: float = math.nan
    change_in_motion: float | None = None  # change of that by halving the step [rad], if it has converged
    flights: int = 0  # number of flights, in which both pivots leave the ground, with the one that ended the run
    # total duration of the flights that were followed [s], and greatest height of the lower pivot in them [m]; 0 without
    flight_duration: float = 0.0
    flight_height: float = 0.0
    # "lean" if ``theta_max`` is mostly the lean of a base that has yielded; empty if the pier rocks
    theta_max_is: str = ""
    settlement_error: float | None = None  # estimated error of ``settlement`` on a base that yields [m]
    # greatest transverse deflection and horizontal displacement of the top of an elastic shaft [m], each with its estimated error
    deflection_max: float | None = None
    deflection_max_error: float | None = None
    top_drift_max: float | None = None
    top_drift_max_error: float | None = None
    bed: BedDemands | None = None  # demands on the bed of a footing
    failure: Failure | None = None  # the kind of failure of a run that failed
    # true if a change of the motion or of the step below any record's resolution changes the peak or the residuals beyond the
    # tolerance; ``None`` with a fixed step and for a run that failed
    chaotic: bool | None = None
    # true if the run did not overturn, but does under a motion 10⁻⁸ stronger or weaker; ``None`` as for ``chaotic``
    may_overturn: bool | None = None
    # true if the peak is too large for the linearised kinematics of its base; ``None`` with finite rotations
    beyond_linearised: bool | None = None
    # true if the pier may land harder after the end of the run than in it; ``None`` unless it is "ok"
    still_rocks: bool | None = None
    # Results of observers by their names, which their quantities turn into columns. Results that the direction of the motion
    # changes have a method ``mirrored``.
    observed: Mapping[str, Any] = field(default_factory=dict)
    # rows of tables beside peaks.csv by file, if requested; empty for a mirror image
    tables: Mapping[str, Any] = field(default_factory=dict)

    @property
    def was_run(self) -> bool:
        """True unless the run was refused, since it would diverge or take too long."""
        return not math.isnan(self.theta_max)

    @property
    def theta_max_in_motion_error(self) -> float | None:
        """Estimated error of ``theta_max_in_motion`` [rad]; None if it is not known.

        If the run is "ok" or ended by flight: ``theta_max_error`` if both peaks are the same, None if ``theta_max`` has no
        error. Otherwise ``change_in_motion``, which a run that overturned or failed after its motion has, too.
        """
        stood = self.status in ("ok", "flight")
        same = self.theta_max_error is None or self.theta_max == self.theta_max_in_motion
        return self.theta_max_error if stood and same else self.change_in_motion

    def changed(self, **fields: object) -> "Outcome":
        """Return a copy with other ``fields``; ``TypeError`` for an unknown one. It is faster than ``dataclasses.replace``."""
        if unknown := fields.keys() - vars(self).keys():
            raise TypeError(f"Outcome has no field {min(unknown)!r}")
        copy = object.__new__(Outcome)
        vars(copy).update(vars(self), **fields)
        return copy

    def noted(self, *remarks: str, **fields: object) -> "Outcome":
        """Return a copy with the non-empty ``remarks`` appended to its note after "; ", and with other ``fields``."""
        return self.changed(note="; ".join(filter(None, (self.note, *remarks))), **fields)

    def with_observed(self, observer: str, results: object) -> "Outcome":
        """Return a copy with the ``results`` of an observer by its name, in place of earlier ones."""
        return self.changed(observed={**self.observed, observer: results})

    def with_table(self, file: str, rows: object) -> "Outcome":
        """Return a copy with the ``rows`` of the table ``file`` beside peaks.csv, in place of earlier ones."""
        return self.changed(tables={**self.tables, file: rows})

    def mirrored(self) -> "Outcome":
        """Return the outcome under the reversed horizontal motion, for a symmetric pier; its ``tables`` are empty."""
        return self.changed(
            theta_res=_reversed(self.theta_res),
            base_tilt=_reversed(self.base_tilt),
            theta_res_drift=_reversed(self.theta_res_drift),
            ductility_left=self.ductility_right,
            ductility_right=self.ductility_left,
            dissipated_left=self.dissipated_right,
            dissipated_right=self.dissipated_left,
            bed=self.bed and self.bed.mirrored(),
            observed={name: _mirrored(results) for name, results in self.observed.items()},
            tables={},
        )


class Section(NamedTuple):
    """Greatest forces in a section; SI units, per unit mass of the pier, axial forces positive in compression.

    ``error`` is four times the greatest relative change of shear, moment or an axial extreme by halving the step; None with a
    fixed step.
    """

    height: float  # above the pivots [m]
    shear: float  # greatest |V|/M, across the axis [m/s²]
    moment: float  # greatest |moment|/M about the middle of the section [m²/s²]
    axial_least: float  # N/M, along the axis [m/s²]
    axial_greatest: float
    axial_at_moment: float  # at the greatest |moment|
    error: float | None = None


def _mirrored(results: Any) -> Any:
    """Return the results of an observer for the mirror image: the same unless they have a method ``mirrored``."""
    return results.mirrored() if hasattr(results, "mirrored") else results


def _reversed(angle: float | None) -> float | None:
    return None if angle is None else 0.0 - angle  # unlike -angle never a negative zero, which would be written as -0
