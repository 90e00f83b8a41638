"""Result of a simulation: the histories of one record on one foundation."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Self

import numpy as np
import numpy.typing as npt

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.common.showing import Shown
from rockbatch.common.statuses import Status
from rockbatch.common.units import ColumnUnits
from rockbatch.outcome.outcome import TERMS
from rockbatch.pier import Base, Pier, place_names

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Samples = npt.NDArray[np.float64]

HISTORY_UNITS = {
    "t": "s",
    "theta": "rad",
    "omega": "rad/s",
    "v": "m",
    "z_left": "1",
    "z_right": "1",
    "v_left": "m",
    "v_right": "m",
    "force_left": "N/kg",
    "force_right": "N/kg",
    "energy": "J/kg",
    "ag_h": "m/s^2",
    "ag_v": "m/s^2",
    "deflection": "m",
}
"""Units of the columns of a history, in order."""

FORCE_UNITS = {
    "base_shear": "m/s^2",
    "normal_force": "m/s^2",
    "base_moment": "m^2/s^2",
    "friction": "1",
    "pivot_left": "1",
    "pivot_right": "1",
    "heel_gap_left": "m",
    "heel_gap_right": "m",
    "heel_speed_left": "m/s",
    "heel_speed_right": "m/s",
    "deck_acceleration": "m/s^2",
}
"""Columns of the table of forces except the time, with their units."""

IMPACT_UNITS = {"t": "s", "landing_velocity": "m/s", "impulse_horizontal": "m/s", "impulse_vertical": "m/s"}
"""Columns of the table of impacts except the pivot, with their units."""

DEVICE_UNITS = {"elongation": "m", "force": "N/kg"}
"""Columns of the table of restraints for each device, such as "damper 1 force", with their units."""

EVENT_TYPES = {"t": "float64", "kind": "str", "pivot": "str", "before": "int64", "after": "int64"}
"""Columns of the table of events, with their types."""


READ_LATER = ("history", "events", "restraints")
"""Tables that a response may read only when they are needed: they cost more than a run."""


@dataclass(frozen=True, eq=False, repr=False)
class Response(Shown):
    """Results of one run, and its histories. SI units; angles in radians; energy per unit mass.

    The histories of :func:`simulate` are computed when the first of them is asked for. ``attrs["units"]`` of a table has
    the units of its columns.

    Attributes
    ----------
    record, case : str
        Names of the ground motion and of the foundation case.
    columns : dict
        Values of the study's varied keys that apply to this run, such as ``{"beta": 40.0}``.
    pier : Pier
        The block.
    base : RigidBase, ElasticBase or YieldingBase
        The base under it.
    status : Status
        "ok", "overturned", "flight" (the run was stopped by it) or "failed".
    history : DataFrame, one row per instant
        ``t`` [s]; ``theta`` [rad], positive tilts right; ``omega`` = dθ/dt [rad/s]; ``v`` [m], the centre of
        mass above the position of unstressed springs; ``z_left``, ``z_right``, spring forces over the yield
        force, −1..0, of elastic springs over half the weight; ``v_left``, ``v_right`` [m], the pivots, up positive;
        ``force_left``, ``force_right`` [N/kg], forces of the supports per unit mass of the pier, negative in compression;
        ``energy`` [J/kg], relative to the start; ``ag_h``, ``ag_v`` [m/s²], the ground, positive right and up; ``deflection``
        [m] of the top of a shaft that bends, across it, positive right. On the rigid base ``v``, ``z_*``, ``v_*`` and
        ``force_*`` are NaN, on a footing ``z_*``.
    events : DataFrame, one row per event
        ``t`` [s], ``kind`` ("separation", "impact", …), ``pivot`` ("left", "right"), and the places in ``history`` of
        the rows ``before`` and ``after`` it, alike where nothing jumps.
    ledger : DataFrame or None
        Energies [J/kg] at the rows of ``history``, if requested: stored ``kinetic``, ``potential``,
        ``elastic``, relative to the start; summed since, ``input``, ``plastic``, ``impact``, ``p_delta`` (first-order
        kinematics), ``constraint`` (finite kinematics), ``damping`` (dashpots of the supports, dampers); and the ``remainder``
        of their balance, the integrator's error.
    forces : DataFrame or None
        Design forces at the rows of ``history``, if requested (THEORY.md, Forces): ``base_shear`` V/M, to the right on
        the pier, ``normal_force`` N/M [m/s²], ``base_moment`` over M about the middle of the base, of supports, dampers and
        tendons [m²/s²], positive as the right support bears more, ``friction`` |V|/N, at every row
        (``friction_demand`` is the greatest while N is above a share of the weight), ``pivot_…``, the supports' forces over half
        the weight, ``heel_gap_…`` [m], ``heel_speed_…`` [m/s], opening, ``deck_acceleration`` [m/s²].
    impacts : DataFrame or None
        With the forces: of each impact ``t`` [s], the ``pivot`` that lands, ``landing_velocity`` [m/s], down, and the
        impulse on the pier per unit mass, ``impulse_horizontal``, to the right, and ``impulse_vertical`` [m/s].
    polarity : str
        "-" where the motion's horizontal component was reversed, else "+".
    scale : float
        Factor on all components of the motion.
    restraints : DataFrame or None
        Elongation [m] and force [N/kg], positive in tension, of every device at the rows of ``history``, such as
        ``damper 1 left force``; ``None`` without.
    row : Series or None
        The run's row of ``peaks.csv``, by the names and in the units of its columns; NaN or "" where a column does not
        apply.
    shocks : DataFrame or None
        Effects of each shock of a sequence, in the columns of ``shocks.csv`` that do not name the run; ``None`` for a
        motion that is not a sequence.

    sections : DataFrame or None
        Greatest forces in sections of the shaft, if requested, a row for each, in the columns of ``sections.csv`` that do not
        name the run. ``None`` in responses of a folder, whose ``sections`` has all runs.

    Examples
    --------
    >>> pier, base = rb.Pier(alpha=0.2, p=1.0), rb.ElasticBase(beta=50, epsilon=0.1)
    >>> motion = rb.pulse("sine", name="one-sine", amplitude=9.81, period=0.5, dt=0.005, duration=2.0)
    >>> response = rb.simulate(pier, base, motion)
    >>> response.status, int(response.row["impacts"])
    ('ok', 5)
    >>> f"{response.theta_max / pier.alpha:.4f}", response.theta_max_error < 1e-4 * pier.alpha
    ('0.1713', True)
    >>> response.history[["t", "theta", "omega"]].tail(1).round(4)
           t   theta   omega
    822  4.0  0.0014 -0.0801
    """

    record: str
    case: str
    columns: dict[str, float | str]
    pier: Pier
    base: Base
    status: Status
    history: "pd.DataFrame" = field(repr=False)
    events: "pd.DataFrame" = field(repr=False)
    ledger: "pd.DataFrame | None" = field(default=None, repr=False)
    polarity: str = "+"
    scale: float = 1.0
    forces: "pd.DataFrame | None" = field(default=None, repr=False)
    impacts: "pd.DataFrame | None" = field(default=None, repr=False)
    restraints: "pd.DataFrame | None" = field(
        default_factory=lambda: None, repr=False
    )  # no attribute of the class: READ_LATER
    row: "pd.Series[Any] | None" = None
    shocks: "pd.DataFrame | None" = field(default=None, repr=False)
    sections: "pd.DataFrame | None" = field(default=None, repr=False)

    def __post_init__(self) -> None:
        """Set ``attrs["units"]`` of the tables that are given."""
        names = place_names(self.pier, self.base.restraints)
        of_tables = {
            "history": HISTORY_UNITS,
            "events": {"t": "s"},
            "restraints": {f"{name} {what}": unit for name in names for what, unit in DEVICE_UNITS.items()},
            "ledger": dict.fromkeys(TERMS, "J/kg"),
            "forces": FORCE_UNITS,
            "impacts": IMPACT_UNITS,
        }
        for name, units in of_tables.items():
            table = getattr(self, name)
            if table is not None:
                of_columns = {"t": "s"} | units
                table.attrs["units"] = ColumnUnits({name: of_columns[name] for name in table if name in of_columns})

    @classmethod
    def unread(cls, read: Callable[[], "Response"], **known: Any) -> Self:
        """Return a response of ``known`` fields; ``read`` is called for the whole one when a history is first needed."""
        response = object.__new__(cls)
        response.__dict__.update(known, _read=read)
        return response

    if not TYPE_CHECKING:  # of which a checker would conclude that any attribute exists

        def __getattr__(self, name: str) -> Any:
            """Return a table of histories not read yet, reading all of them; raise ``AttributeError`` for any other name."""
            read = self.__dict__.get("_read") if name in READ_LATER else None
            if read is None:
                raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)
            whole = read()
            self.__dict__.update({table: getattr(whole, table) for table in READ_LATER})
            return self.__dict__[name]

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields for a copy or a pickle, with the histories read, so that they do not depend on compiled code."""
        tables = {table: getattr(self, table) for table in READ_LATER}
        return {name: value for name, value in self.__dict__.items() if name != "_read"} | tables

    @property
    def theta_max(self) -> float:
        """Greatest rotation |θ| until the end of the run [rad]; NaN if nothing was run. ``InputError`` without a row."""
        return self.pier.alpha * self._number("theta_max_over_alpha")

    @property
    def theta_max_error(self) -> float:
        """Estimated error of ``theta_max`` [rad]; NaN with a fixed step, of a chaotic peak, or if the pier did not stand.

        ``InputError`` without a row.
        """
        return self.pier.alpha * self._number("theta_max_error")

    @property
    def theta_res(self) -> float:
        """Residual rotation θ [rad]; NaN on a rigid base without dampers that hold a tilt, or if the pier did not stand.

        ``InputError`` without a row.
        """
        return self.pier.alpha * self._number("theta_res_over_alpha")

    @property
    def settlement(self) -> float:
        """Mean settlement of the supports [m]; NaN on the rigid base, or if the pier did not stand.

        ``InputError`` without a row.
        """
        return self._number("settlement_m")

    @property
    def reason(self) -> str:
        """Reason that the run failed, or that the pier left the ground; "" otherwise. ``InputError`` without a row."""
        return str(self._of_row()["reason"])

    @property
    def note(self) -> str:
        """Remarks on a valid run; "" without any. ``InputError`` without a row of peaks.csv."""
        return str(self._of_row()["note"])

    @property
    def t(self) -> Samples:
        """Time [s], shape (n,)."""
        return self._history("t")

    @property
    def theta(self) -> Samples:
        """Rotation θ [rad], shape (n,); positive lifts the left pivot and tilts the block to the right."""
        return self._history("theta")

    @property
    def omega(self) -> Samples:
        """Angular velocity dθ/dt [rad/s], shape (n,)."""
        return self._history("omega")

    @property
    def v(self) -> Samples:
        """Centre of mass above the position of unstressed springs [m], shape (n,); NaN on the rigid base."""
        return self._history("v")

    @property
    def z_left(self) -> Samples:
        """Force of the left spring over its yield force, −1..0, shape (n,); NaN on the rigid base and on a footing.

        On a backbone it is over the force at the first corner, and falls below −1 beyond it.

        Of an elastic spring, which does not yield, it is the force over half the weight, without a lower bound.
        """
        return self._history("z_left")

    @property
    def z_right(self) -> Samples:
        """Force of the right spring over its yield force, −1..0, shape (n,); NaN on the rigid base and on a footing.

        On a backbone it is over the force at the first corner, and falls below −1 beyond it.

        Of an elastic spring, which does not yield, it is the force over half the weight, without a lower bound.
        """
        return self._history("z_right")

    @property
    def energy(self) -> Samples:
        """Total energy per unit mass [J/kg], relative to the start, shape (n,)."""
        return self._history("energy")

    @property
    def half_cycles(self) -> "pd.DataFrame":
        """Half cycles of rocking: row 0 from the start of the run to the first impact, then one row from each impact on.

        ``t`` [s], its beginning; ``omega_before``, ``omega_after`` [rad/s], the angular velocity before and after the impact
        there, NaN in row 0, which begins without one; ``amplitude`` [rad], the greatest |θ| until the next impact, and
        ``t_amplitude`` [s], NaN if the run ends before it; ``apparent_restitution``, the restitution that would give this
        amplitude after the previous one on rigid ground at rest. On springs a half cycle begins as the pier passes through
        θ = 0, where its velocity does not jump.

        Examples
        --------
        >>> block = rb.Pier.rectangle(width_m=0.3, height_m=1.2)
        >>> ground, still = rb.RigidBase(restitution=0.9), rb.Motion.still(2.0)
        >>> response = rb.simulate(block, ground, still, initial_rotation_rad=0.1)
        >>> response.half_cycles[["t", "amplitude", "apparent_restitution"]].head(3).round(4)
                t  amplitude  apparent_restitution
        0  0.0000     0.1000                   NaN
        1  0.3242     0.0764                   0.9
        2  0.8589     0.0595                   0.9
        """
        from rockbatch.outcome.half_cycles import COLUMNS, Path, apparent_restitution, half_cycles

        landed = self.events.loc[self.events["kind"].isin(["impact", "rest"]), "after"].to_numpy()
        cycles = half_cycles(Path(self.t, self.theta, self.omega), None if self.base.on_springs else landed)
        return pd.DataFrame(
            dict(zip(COLUMNS, (*cycles, apparent_restitution(self.pier, cycles.amplitude)), strict=True))
        )

    def device_work(self, least_stroke_m: float = 0.01) -> "pd.DataFrame":
        """Return the work of every device, a row for each of its places, from the rows of the history.

        Raises ``InputError`` without devices. ``travel_m``, cumulative travel, of a damper without its brace;
        ``energy_J_kg``, work per unit mass of the pier, and ``energy_kJ``, NaN if the mass is not known; ``half_cycles``
        with a range of at least ``least_stroke_m``, by rainflow counting (ASTM E1049-85); ``strain_over_yield``, the
        greatest of a tendon that can yield, else NaN.

        Examples
        --------
        >>> base = rb.RigidBase(restraints=(rb.Damper("friction", f=0.05, at="left"),))
        >>> motion = rb.pulse("sine", name="one-sine", amplitude=9.81, period=0.5, dt=0.005, duration=2.0)
        >>> response = rb.simulate(rb.Pier(alpha=0.2, p=1.0), base, motion)
        >>> work = response.device_work().loc["damper 1"]
        >>> f"{work.travel_m:.3f} m, {work.half_cycles:.0f} half cycles"
        '0.300 m, 4 half cycles'
        """
        from rockbatch.outcome.device_work import Courses, work_of

        if self.restraints is None:
            raise InputError(f"{self._title}: there are no devices")
        names = place_names(self.pier, self.base.restraints)
        elongation, pull = (
            self.restraints[[f"{name} {what}" for name in names]].to_numpy(dtype=np.float64)
            for what in ("elongation", "force")
        )
        work = work_of(self.pier, self.base, Courses(elongation, pull), least_stroke_m)
        mass = math.nan if self.pier.mass_t is None else self.pier.mass_t
        table = {"travel_m": work.travel, "energy_J_kg": work.lost, "energy_kJ": mass * work.lost}
        table |= {"half_cycles": work.half_cycles.astype(np.int64), "strain_over_yield": work.strain}
        return pd.DataFrame(table, index=pd.Index(names, name="device"))

    def plot(self, width_mm: float = 160.0, ax: "Axes | None" = None) -> "Figure":
        """Return a matplotlib Figure of rotation, angular velocity, energy, ground motion and events against time, and of the
        loops of supports and devices, ``width_mm`` wide or in the place of ``ax``:
        ``response.plot().savefig("pier.pdf")``."""
        from rockbatch.common.figures.paper import drawn
        from rockbatch.outcome.figures import of_one

        return drawn(of_one(self, self._title), width_mm, ax)

    def plot_rotation(self, ax: "Axes | None" = None) -> "Axes":
        """Draw θ/α against time into ``ax``, by default in a figure of one column of a paper, 88 mm; return the axes.

        With the events, the band in which both supports stay loaded, and the largest value.
        """
        from rockbatch.common.figures.paper import panel_in
        from rockbatch.outcome.figures import rotation

        return panel_in(rotation(self), ax)

    @checked
    def plot_loops(self, ax: "Axes | None" = None, of: str = "") -> "Axes":
        """Draw force against deformation of one device or support into ``ax``, as :meth:`plot_rotation` does; return the axes.

        ``of`` is "damper 1", "left" and so on; by default the first device, or the left support without any. Raises
        ``InputError`` for an unknown name, and lists the names, or if there are neither devices nor supports that give.
        """
        from rockbatch.common.figures.paper import panel_in
        from rockbatch.outcome.figures import loops

        return panel_in(loops(self), ax, of)

    def _facts(self) -> tuple[str, dict[str, str]]:
        """Return the title, and facts by their labels; "" hides one: see :class:`Shown`.

        History and events come last; before them, if the response has a row, peak, residual, settlement, reason and note.
        """
        kinds = self.events["kind"].value_counts(sort=False)
        facts = {
            "history": f"{len(self.history)} rows until {self.t[-1]:.2f} s" if len(self.history) else "",
            "events": ", ".join(f"{count} × {kind}" for kind, count in kinds.items()),
        }
        if self.row is not None:
            forms = {
                "theta_max_over_alpha": ".5f",
                "theta_max_error": ".0e",
                "t_max_s": ".2f",
                "theta_res_over_alpha": ".5f",
            }
            numbers = {name: self._number(name) for name in forms}
            peak, error, time, residual = ("" if x != x else format(x, forms[name]) for name, x in numbers.items())
            facts = {
                "θ_max/α": f"{peak}{f' ± {error}' if error else ''} at {time} s" if peak else "",
                "θ_res/α": residual,
                "settlement": "" if self.settlement != self.settlement else f"{1000 * self.settlement:.2f} mm",
                "reason": self.reason,
                "note": self.note,
            } | facts
        return f"response {self._title}", facts

    @property
    def _title(self) -> str:
        sign = f", polarity {self.polarity}" if self.polarity != "+" else ""
        scale = f" × {self.scale:g}" if self.scale != 1 else ""
        status = f": {self.status}" if self.status != "ok" else ""
        return f"{self.record}{scale}{sign}, {self.case}{status}"

    def _of_row(self) -> "pd.Series[Any]":
        """Return the row of peaks.csv; raise ``InputError`` if the response was read without it."""
        if self.row is None:
            raise InputError(
                f"{self._title}: these are histories alone; take them from `open_results(...).response(...)`"
            )
        return self.row

    def _number(self, column: str) -> float:
        return float(self._of_row()[column])

    def _history(self, column: str) -> Samples:
        return self.history[column].to_numpy(dtype=np.float64)
