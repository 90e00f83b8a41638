"""What one run comes to."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Outcome:
    """What a run comes to. SI units, angles in radians; ``None`` where it does not apply.

    Attributes
    ----------
    status : str
        "ok", "overturned", "flight" (the run was stopped by it) or "failed".
    reason : str
        Why it failed, or what made it fly; empty otherwise.
    note : str
        What else there is to know of a run that is right: counts that have not settled, say; empty otherwise.
    theta_max, t_max : float
        Greatest rotation |θ| [rad] until the end of the run, and its time [s].
    theta_max_error, theta_res_error : float or None
        Estimated errors of ``theta_max`` and ``theta_res`` [rad]; ``None`` with a fixed step.
    theta_res, base_tilt : float or None
        Residual rotation, static on the deformed base, and tilt of the base itself [rad].
    settlement : float or None
        Mean plastic settlement of the supports since the start [m].
    t_read : float or None
        When residual rotation, tilt and settlement of a yielding base were read [s] (THEORY.md, 7).
    settlement_drift, theta_res_drift : float or None
        How fast they went on changing then [m/s, rad/s].
    impacts, separations : int
        Counts; on the rigid base a separation is a lift-off from rest.
    t_flight : float or None
        First time at which neither pivot was in contact [s].
    t_end : float
        End of the run [s].
    ductility_left, ductility_right : float or None
        Yield demand: greatest deflection of each support over its yield deflection.
    dissipated_left, dissipated_right : float or None
        Plastic work in each spring [J/kg].
    substeps : int
        Steps per sample.
    settlement_other_law : float or None
        Settlement [m] by the other law of yielding springs, where it was asked for.
    damper_force, damper_stroke, damper_speed, damper_energy : float or None
        Of dampers: greatest force over M g, elongation [m] and speed [m/s] of any; energy of all [J/kg].
    tendon_force, tendon_yield, tendon_slack : float or None
        Of tendons: greatest force over M g and plastic elongation [m] of any; how often they went slack.
    energies : mapping of str to float, or None
        Energy ledger at the end [J/kg], and the greatest ``remainder`` on the way, where it was asked for.
    """

    status: str
    reason: str
    theta_max: float
    t_max: float
    impacts: int
    separations: int
    t_flight: float | None
    t_end: float
    substeps: int
    theta_max_error: float | None = None
    theta_res: float | None = None
    theta_res_error: float | None = None
    base_tilt: float | None = None
    settlement: float | None = None
    t_read: float | None = None
    settlement_drift: float | None = None
    theta_res_drift: float | None = None
    ductility_left: float | None = None
    ductility_right: float | None = None
    dissipated_left: float | None = None
    dissipated_right: float | None = None
    settlement_other_law: float | None = None
    damper_force: float | None = None
    damper_stroke: float | None = None
    damper_speed: float | None = None
    damper_energy: float | None = None
    tendon_force: float | None = None
    tendon_yield: float | None = None
    tendon_slack: int | None = None
    energies: Mapping[str, float] | None = None
    note: str = ""

    @property
    def was_run(self) -> bool:
        """Whether there is anything but a reason: a run that would blow up or take too long is not begun."""
        return not math.isnan(self.theta_max)

    def mirrored(self) -> "Outcome":
        """What the same run comes to with the horizontal motion reversed, where pier and foundation are symmetric."""
        return replace(
            self,
            theta_res=_reversed(self.theta_res),
            base_tilt=_reversed(self.base_tilt),
            theta_res_drift=_reversed(self.theta_res_drift),
            ductility_left=self.ductility_right,
            ductility_right=self.ductility_left,
            dissipated_left=self.dissipated_right,
            dissipated_right=self.dissipated_left,
        )


def _reversed(angle: float | None) -> float | None:
    return None if angle is None else 0.0 - angle  # never a negative zero
