"""Ground motions: one horizontal component, perhaps with its station's vertical one."""

import math
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError, Problem, refuse
from rockbatch.common.files import legible
from rockbatch.common.lazy import pd
from rockbatch.common.showing import Shown
from rockbatch.common.units import GRAVITY, acceleration_factor
from rockbatch.motions.labels.orientation import orientation_of, unknown
from rockbatch.motions.labels.origin import UNKNOWN_ORIGIN, Origin
from rockbatch.motions.limits import USUAL_STEP
from rockbatch.motions.sources.listed import NOT_LISTED, Listed
from rockbatch.motions.spectrum import PERIODS, Samples, as_periods, spectral_acceleration

if TYPE_CHECKING:
    import obspy
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_GREATEST_RATE = 1e4  # Hz, of any recorder


@dataclass(frozen=True)
class Initial:
    """The ground's velocity [m/s] and displacement [m] at a record's first sample."""

    velocity: float = 0.0
    displacement: float = 0.0

    @checked
    def times(self, factor: float) -> "Initial":
        """Return the state for a motion ``factor`` times as large: both velocity and displacement times it."""
        return Initial(self.velocity * factor, self.displacement * factor)


@dataclass(frozen=True)
class Shock:
    """A record within a sequence of shocks: its name, the times of its first and last sample in the sequence [s], the time until
    which it counts, the start of the next record or a pause after the last, and the station of the record."""

    name: str
    start: float
    end: float
    until: float
    station: str = ""


@dataclass(frozen=True)
class Finding:
    """An oddity of a motion."""

    what: str  # in a word or two, for tables
    text: str  # in a sentence, with its remedy
    gross: bool = False  # whether the motion is held back until confirmed
    key: str = "confirm"  # the key that confirms it, under [motions] and in manifests; "confirm" confirms all findings


COMPONENTS = ("horizontal", "vertical", "across")
"""Fields of a motion that are samples; all but the first may be ``None``."""

MOST_SAMPLES = 10_000_000
"""Greatest number of samples of a pulse or of still ground."""


def frozen(samples: object) -> Samples:
    """Return samples as an array of ``float64`` over bytes, itself if it is one; raise ``TypeError`` unless real numbers.

    Nobody can write into bytes, while whoever made an array read-only may make it writeable again.
    """
    if type(samples) is np.ndarray and isinstance(samples.base, bytes) and samples.dtype == float:
        return samples
    if np.ma.is_masked(samples):
        raise TypeError("has masked samples: fill them or leave the record out")
    try:
        values = np.asarray(samples)
    except ValueError as error:
        raise TypeError(f"cannot be made an array of: {error}") from error
    if values.dtype.kind not in "iuf":
        raise TypeError(f"has samples of type {values.dtype}: must be real numbers")
    return np.ndarray(values.shape, np.float64, np.asarray(values, np.float64).tobytes())


@checked
@dataclass(frozen=True, repr=False, eq=False)
class Motion(Shown):
    """A ground motion in SI units, sampled evenly and linear between its samples.

    Attributes
    ----------
    name : str
        Name in tables: the stem of the horizontal component's file, its channel id, or the pulse's name; control characters,
        invisible ones, and bytes that are no text are written as ``\\x1b`` in it.
    dt : float
        Sampling interval [s].
    horizontal : ndarray, shape (npts,)
        Horizontal ground acceleration ü_g [m/s²], positive to the right.
    vertical : ndarray, shape (npts,), or None
        Vertical ground acceleration v̈_g [m/s²], positive up; ``None`` without one.
    source : str
        Where the horizontal component came from: a file, a package, or "pulse".
    vertical_source : str
        Likewise for the vertical one; empty without one.
    notes : tuple of str
        What was done to the data on its way here, in words.
    azimuth : float or None
        Of the horizontal component [degrees clockwise from north]; ``None`` where unknown.
    magnitude, distance_km : float or None
        Of the event, and the site's distance from it [km]; ``None`` where unknown.
    factor : float
        What brought the record to the study's target; it is in the components already.
    initial : Initial or None
        Of the horizontal component, if its file states it; ``None``: unknown, from rest.
    processed : bool or None
        Whether its agency has corrected the horizontal component; ``None`` where the file does not say.
    listed : Listed
        What PEER's search says of the record: scale factor, magnitude, distance, Vs30, duration, period of its pulse.
    findings : tuple of Finding
        Oddities that were found when it was read.
    origin : Origin
        Event, station and direction in words, as far as its header says them.
    lacks_vertical : bool
        Whether a vertical component was requested and is missing.
    station : str
        What the components of one station in one earthquake share, which count as one record; empty for a record of its own.
    confirm : sequence of str
        "pga", if a PGA above 5 g is right, which :func:`rockbatch.simulate` else refuses; "dt", if a sampling interval is right
        that no record has, outside 1e-5 to 0.2 s.
    shocks : tuple of Shock
        Records of which it is a sequence, in their order; empty for a record of its own.
    start : float or None
        Time of the first sample [s since 1970, UTC], or counted within its station alone; ``None`` where unknown.
    across : ndarray, shape (npts,), or None
        Horizontal acceleration square to it [m/s²], for spectra of the pair and runs on the other axis of a pier; ``None`` if
        that is a motion of its own, or there is none.
    vertical_factor : float or None
        What the vertical component as it was recorded was multiplied by, if that is not ``factor``.
    component_sources : tuple of str
        Where all its components came from, if from more than ``source`` and ``vertical_source``: those of both horizontals of
        a rotated motion, and of all shocks of a sequence.
    recorded : bool
        Whether it is an earthquake's; False for pulses and still ground, which no target scales and no suite counts.
    turned : bool
        Whether both horizontals of its station were turned to its azimuth.

    All samples are copied and cannot be changed afterwards. Raises ``InputError`` for samples that are no finite numbers,
    components of different lengths, and a ``dt`` not above 0, or unusual and not confirmed.

    Examples
    --------
    >>> import numpy as np
    >>> shake = rb.Motion("shake", dt=0.01, horizontal=9.81 * np.sin(np.arange(200) / 10))
    >>> shake
    <ground motion shake>
      samples  200 at 0.01 s: 1.99 s
      PGA      1.000 g
    >>> round(shake.times(0.5).pga, 2)
    4.9
    """

    name: str
    dt: float
    horizontal: Samples
    vertical: Samples | None = None
    source: str = ""
    vertical_source: str = ""
    notes: tuple[str, ...] = ()
    azimuth: float | None = None
    magnitude: float | None = None
    distance_km: float | None = None
    factor: float = 1.0
    initial: Initial | None = None
    processed: bool | None = None
    findings: tuple[Finding, ...] = ()
    origin: Origin = UNKNOWN_ORIGIN
    lacks_vertical: bool = False
    station: str = ""
    confirm: Sequence[str] = ()
    shocks: tuple[Shock, ...] = ()
    start: float | None = None
    across: Samples | None = None
    vertical_factor: float | None = None
    listed: Listed = NOT_LISTED
    component_sources: tuple[str, ...] = ()
    recorded: bool = True
    turned: bool = False

    def __post_init__(self) -> None:
        for text in ("name", "station"):  # which go into tables
            object.__setattr__(self, text, legible(getattr(self, text), keep="\t\r\n"))
        wrong, place = list[Problem | str](), f'motion "{self.name}"'
        if not (math.isfinite(self.dt) and self.dt > 0):
            wrong.append(f"{place}: dt = {self.dt:g}: must be a number above 0 [s]")
        elif "dt" not in self.confirm:
            rate = f"; if it is a rate in Hz, write dt = {1.0 / self.dt:g}" if 10.0 <= self.dt <= _GREATEST_RATE else ""
            doubts = USUAL_STEP.doubts("dt", self.dt)
            wrong += [replace(doubt, text=f"{doubt.text}{rate}", place=place) for doubt in doubts]
        for component in COMPONENTS:
            samples = getattr(self, component)
            if samples is None and component != "horizontal":
                continue
            try:
                samples = frozen(samples)
            except TypeError as error:
                wrong.append(f"{place}: {component} acceleration {error}")
                continue
            object.__setattr__(self, component, samples)
            if np.ndim(samples) != 1 or len(samples) == 0:
                shape = np.shape(samples)
                wrong.append(f"{place}: {component} acceleration has shape {shape}: must be samples in a row")
            elif not np.isfinite(samples).all():
                first = int(np.argmin(np.isfinite(samples)))
                wrong.append(
                    f"{place}: {component} sample {first} (t = {first * self.dt:g} s) is {samples[first]}: "
                    "must be a number; repair the record or leave it out"
                )
        for component in COMPONENTS[1:] if not wrong else ():
            samples, npts = getattr(self, component), len(self.horizontal)
            if samples is not None and len(samples) != npts:
                counts = f"{npts} horizontal and {len(samples)} {component} samples"
                wrong.append(f"{place}: {counts}: bring them to one length")
        refuse(wrong)

    @classmethod
    @checked
    def from_array(
        cls,
        values: object,
        dt: float,
        unit: str,
        *,
        name: str = "motion",
        vertical: object = None,
        gravity: float = GRAVITY,
        confirm: Sequence[str] = (),
    ) -> "Motion":
        """Return a motion of samples in ``unit``.

        Parameters
        ----------
        values : array_like, shape (npts,)
            Horizontal ground acceleration.
        dt : float
            Sampling interval [s].
        unit : str
            Of both components: "g", "m/s2", "cm/s2", …
        vertical : array_like, shape (npts,), optional
            Vertical ground acceleration, positive up.
        gravity : float
            What "g" is [m/s²].
        confirm : sequence of str
            "dt" or "pga", if it is right though unusual.

        Raises ``InputError`` for samples that are no real numbers, another unit, lengths that differ, or an unusual ``dt``.

        Examples
        --------
        >>> rb.Motion.from_array([0.0, 0.5, -0.3, 0.0], 0.02, "g", name="mine").pga
        4.905
        """
        try:
            factor = acceleration_factor(unit, gravity)
        except ValueError as error:
            raise InputError(str(error)) from error
        motion = cls(name, dt, values, vertical, confirm=confirm)  # type: ignore[arg-type]
        return motion if factor == 1.0 else motion.scaled(factor)

    @classmethod
    @checked
    def still(cls, duration_s: float, dt: float = 0.005, *, name: str = "still") -> "Motion":
        """Return ground that does not move for ``duration_s`` [s], sampled every ``dt`` [s]: for a release test.

        Raises ``InputError`` unless both are above 0 and there are 10 million samples at most.

        Examples
        --------
        >>> pier = rb.Pier(alpha=0.2, p=2.0, initial_rotation_rad=0.1)
        >>> response = rb.simulate(pier, rb.RigidBase(restitution=0.9), rb.Motion.still(duration_s=20.0))
        >>> float(response.theta[0]), float(response.theta[-1])
        (0.1, 0.0)
        """
        times = {"duration_s": duration_s, "dt": dt}
        wrong = [f"{key} = {t:g}: must be a number above 0 [s]" for key, t in times.items() if not 0 < t < math.inf]
        if not wrong and duration_s / dt > MOST_SAMPLES:
            wrong.append(f"dt = {dt:g}: more than {MOST_SAMPLES:,} samples in {duration_s:g} s; take a larger dt")
        refuse(wrong)
        return cls(name, dt, np.zeros(round(duration_s / dt) + 1), source="still", initial=Initial(), recorded=False)

    @classmethod
    def from_obspy(cls, stream: "obspy.Stream", unit: str, *, name: str = "") -> "Motion":
        """Return a motion of an ObsPy ``Stream`` of acceleration in ``unit``: a horizontal component, and a vertical one if any.

        A component is vertical by its channel: "HNZ", "UD", or "DWN", which is reversed. Raises ``InputError`` for
        another number of components, gaps, or different sampling. Remove the instrument's response from counts before.
        """
        traces = list(stream)
        horizontal, vertical = [], []
        for trace in traces:
            direction = orientation_of(trace.stats.channel) or unknown()
            if direction.vertical:
                vertical.append(-trace.data if direction.down else trace.data)
            else:
                horizontal.append(trace)
        if len(horizontal) != 1 or len(vertical) > 1:
            ids = ", ".join(trace.id for trace in traces) or "none"
            raise InputError(
                f"stream: needs one horizontal component and one vertical one at most, not {ids}; use stream.select"
            )
        steps = {(trace.stats.delta, str(trace.stats.starttime)) for trace in traces}
        if len(steps) > 1:
            raise InputError(
                "stream: its components differ in sampling interval or start; use stream.trim and interpolate"
            )
        (trace,) = horizontal
        return cls.from_array(
            trace.data, trace.stats.delta, unit, name=name or trace.id, vertical=vertical[0] if vertical else None
        )

    def __setstate__(self, state: dict[str, object]) -> None:
        """Restore a copy, or a motion from another process, with samples that cannot be changed: pickling loses this flag."""
        vars(self).update(state)
        for component in COMPONENTS:
            if (samples := state.get(component)) is not None:
                vars(self)[component] = frozen(samples)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Motion):
            return NotImplemented
        return all(np.array_equal(getattr(self, field.name), getattr(other, field.name)) for field in fields(self))

    def __hash__(self) -> int:
        return hash((self.name, self.dt, self.npts))

    @property
    def records(self) -> tuple[str, ...]:
        """Return the names of the records of which it is a sequence; its own name if it is not one."""
        return tuple(shock.name for shock in self.shocks) or (self.name,)

    @property
    def label(self) -> str:
        """Return its name in words, "Imperial Valley 1979, Meloland, 270", else its file; the name of a pulse or a sequence."""
        by_name = self.source in ("", "pulse") or not self.recorded or len(self.records) > 1
        return self.origin.label or (self.name if by_name else self.source)

    @property
    def named(self) -> str:
        """Return its label, followed by its name in tables if that differs."""
        return self.label if self.label == self.name else f"{self.label} ({self.name})"

    @property
    def sources(self) -> tuple[str, ...]:
        """Return the sources of all its components."""
        return self.component_sources or tuple(filter(None, (self.source, self.vertical_source)))

    @property
    def files(self) -> str:
        """Return the sources of its components in words, "a.AT2, a-UP.AT2"."""
        return ", ".join(self.sources)

    @property
    def of_station(self) -> str:
        """Return the name under which it counts as one record with others: its station, else its own name."""
        return self.station or self.name

    @property
    def stations(self) -> tuple[str, ...]:
        """Return the stations of its records, sorted: of each shock of a sequence, else its own (:attr:`of_station`)."""
        return tuple(sorted({shock.station for shock in self.shocks if shock.station})) or (self.of_station,)

    @property
    def npts(self) -> int:
        """Return the number of samples."""
        return len(self.horizontal)

    @property
    def duration(self) -> float:
        """Return the time from the first to the last sample [s]."""
        return (self.npts - 1) * self.dt

    @cached_property
    def pga(self) -> float:
        """Return the peak absolute horizontal ground acceleration [m/s²]."""
        return float(np.abs(self.horizontal).max())

    @property
    def pga_g(self) -> float:
        """Return the peak horizontal ground acceleration [g], with g = 9.81 m/s² as in tables."""
        return self.pga / GRAVITY

    @property
    def pga_vertical(self) -> float | None:
        """Return the peak absolute vertical ground acceleration [m/s²]; ``None`` without a vertical component."""
        return None if self.vertical is None else float(np.abs(self.vertical).max())

    def _facts(self) -> tuple[str, dict[str, str]]:
        """Return the title and, by name, the facts that :class:`Shown` prints: record, samples, PGA, files, findings."""
        return f"ground motion {self.name}", {
            "record": self.origin.label,
            "samples": f"{self.npts} at {self.dt:g} s: {self.duration:.2f} s",
            "PGA": f"{self.pga / GRAVITY:.3f} g"
            + ("" if self.pga_vertical is None else f", vertical {self.pga_vertical / GRAVITY:.3f} g"),
            "from": self.files,
            "check": ", ".join(finding.what for finding in self.findings),
        }

    @cached_property
    def exchanged(self) -> "Motion":
        """Return the motion with ``horizontal`` and ``across``, which it must have, exchanged.

        Its azimuth is 90° further, and its initial state unknown.
        """
        assert self.across is not None
        azimuth = None if self.azimuth is None else (self.azimuth + 90.0) % 360.0
        return replace(self, horizontal=self.across, across=self.horizontal, azimuth=azimuth, initial=None)

    def scaled(self, factor: float) -> "Motion":
        """Return the motion with all components, and its initial state, ``factor`` times as large; its field ``factor`` stays."""
        return self.times(factor)

    @checked
    def spectrum(self, periods: Samples | Sequence[float] | None = None, damping: float = 0.05) -> "pd.Series[float]":
        """Return the elastic response spectrum of the horizontal component.

        Parameters
        ----------
        periods : array_like, shape (n,), optional
            Undamped periods [s]; 101 from 0.05 to 5 s by default.
        damping : float
            Fraction of critical damping.

        Returns
        -------
        Series, length n
            Pseudo-spectral acceleration ``sa_g``, in g of 9.81 m/s², by ``period_s``.

        Raises ``InputError`` for impossible periods and damping.
        """
        undamped = PERIODS if periods is None else as_periods(periods)
        sa = spectral_acceleration(self.horizontal, self.dt, undamped, damping) / GRAVITY
        return pd.Series(sa, index=pd.Index(undamped, name="period_s"), name="sa_g")

    def plot(self, width_mm: float = 160.0, ax: "Axes | None" = None) -> "Figure":
        """Draw the accelerations of its components against time; return a matplotlib Figure, ``width_mm`` wide or that of
        ``ax``."""
        from rockbatch.common.figures.paper import drawn
        from rockbatch.motions.figures import record

        components = {"horizontal": self.horizontal} | ({} if self.vertical is None else {"vertical": self.vertical})
        return drawn(record(components, self.dt, self.label), width_mm, ax)

    @checked
    def times(self, factor: float, reverse: bool = False) -> "Motion":
        """Return the motion with all components ``factor`` times as large, and the horizontal one reversed if ``reverse``.

        So is its initial state; ``across`` is not reversed. Raises ``InputError`` if a component overflows.
        """
        along = -factor if reverse else factor
        times = copy(self)  # without the checks of __init__: the product is finite unless it overflows
        vars(times).pop("pga", None)
        for name, by in (("horizontal", along), ("vertical", factor), ("across", factor)):
            if (samples := getattr(self, name)) is not None:
                with np.errstate(over="ignore", invalid="ignore"):  # __post_init__ refuses it below
                    vars(times)[name] = frozen(samples * by)
        if self.initial is not None:
            vars(times)["initial"] = self.initial.times(along)
        across = 0.0 if times.across is None else float(np.abs(times.across).max())
        if not math.isfinite(times.pga + (times.pga_vertical or 0.0) + across):
            times.__post_init__()
        return times
