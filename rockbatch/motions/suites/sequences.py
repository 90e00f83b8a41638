"""Sequences of shocks as one motion: records one after the other, with the ground brought to rest in the pauses.

A record rarely ends with the ground at rest, and a late-triggered one does not begin so. Records are not changed: the
difference Δv in velocity is made up in the pause of length P, by the acceleration (Δv/P) (1 − cos(2πt/P)), which begins and
ends with 0. P is long, so that this is far below the acceleration that lifts a pier; :data:`MOST_IN_PAUSE` bounds it.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import TypeVar

import numpy as np

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError, refuse
from rockbatch.common.grouping import closest
from rockbatch.common.showing import shown
from rockbatch.common.units import GRAVITY, Usual
from rockbatch.motions.intensity import measures
from rockbatch.motions.labels.origin import UNKNOWN_ORIGIN
from rockbatch.motions.limits import MOST_SAMPLES, MOST_STEPS
from rockbatch.motions.motion import Initial, Motion, Samples, Shock
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.sources.listed import NOT_LISTED, Listed
from rockbatch.motions.unused import LeftOut, Unusable
from rockbatch.toml.kinds import boolean, choice, positive, text
from rockbatch.toml.meant import names
from rockbatch.toml.reader import TomlFile
from rockbatch.toml.section import CONFIRM, Key, Section

T = TypeVar("T")

PAUSE = 20.0
"""Default pause between two shocks [s]."""

MOST_IN_PAUSE = 0.005 * GRAVITY
"""Greatest acceleration that may bring the ground to rest in a pause [m/s²]: a tenth of that which lifts a pier of α = 0.05."""

_NOTED = 1e-6  # m/s²: smaller accelerations in pauses are rounding
_SAME = 1e-6  # relative: steps that differ by less are the same


@dataclass(frozen=True)
class ShockSequence:
    """A sequence by the names of its records; its fields are the keys of :data:`SEQUENCE`.

    One value of ``factors`` or ``polarity`` is for all records; none means 1 or "+". Raises ``InputError`` for another number of
    them than that of the records.
    """

    name: str
    records: tuple[str, ...]
    pause_s: float = PAUSE
    factors: tuple[float, ...] = ()
    polarity: tuple[str, ...] = ()
    alone: bool = False

    def __post_init__(self) -> None:
        wrong, n = [], len(self.records)
        for key, count in (("factors", len(self.factors)), ("polarity", len(self.polarity))):
            if count not in (0, 1, n):
                wrong.append(f"{key}: {count} given for {n} records; write one for each, or one for all")
        refuse(wrong)

    def as_motion(self, parts: Sequence[Motion]) -> Motion:
        """Return its records ``parts``, in their order, as one motion, with its pause, factors and polarities.

        Raises ``InputError`` as :func:`sequence`.
        """
        n = len(parts)
        factors = self.factors * (n if len(self.factors) == 1 else 1) or (1.0,) * n
        signs = self.polarity * (n if len(self.polarity) == 1 else 1) or ("+",) * n
        return sequence(parts, name=self.name, pause=self.pause_s, factors=factors, polarity=signs)


_SEQUENCE = {
    "name": Key(text, '"main shock and aftershock"', "Its name in tables.", required=True),
    "records": Key(
        text,
        '["CHAN15", "CHAN24"]',
        "Names of its records, as in tables, in the order of the shocks; repetitions are allowed.",
        required=True,
        many=True,
        distinct=False,
    ),
    "pause_s": Key(
        positive,
        "20.0",
        "Time between the last sample of a shock and the first one of the next, in which the ground is brought to rest.",
        usual=Usual(600.0, "s: a pier that rocks comes to rest in less"),
    ),
    "factors": Key(
        positive,
        "[1.0, 0.8]",
        "Factor on all components of each shock, or one for all.",
        many=True,
        distinct=False,
        usual=Usual(10.0, "times as recorded; 150 % are 1.5"),
    ),
    "polarity": Key(
        choice("+", "-"),
        '["+", "-"]',
        'Of each shock, or one for all: "-" reverses its horizontal component.',
        many=True,
        distinct=False,
    ),
    "alone": Key(boolean, "true", "Whether its records are also run on their own."),
    **CONFIRM,
}
SEQUENCE = Section(
    ("motions", "sequence"),
    "Shocks as one motion: a main shock and its aftershocks, one after the other on the same pier. A sequence is selected and "
    "scaled as one record; `shocks.csv` and the report have the results of each shock.",
    _SEQUENCE,
    many=True,
    homes=(ShockSequence,),
    also=names({"records": "motions shocks", "pause_s": "gap interval rest", "factors": "scale scales"}),
)
"""The table [[motions.sequence]] of a study."""


def read_sequences(file: TomlFile, *at: str) -> tuple[ShockSequence, ...]:
    """Return the sound sequences in the tables ``[[at]]`` of a study or manifest; mistakes are added to the file's problems."""
    sequences: list[ShockSequence] = []
    for table in file.tables(*at, title="name"):
        read = table.read(SEQUENCE)
        if any(sequence.name == read.get("name") for sequence in sequences):
            table.complain(f"name = {shown(read['name'])}: given twice; give each sequence its own name", "name")
        elif {"name", "records"} <= read.keys():
            with table.noting("records"):
                sequences.append(ShockSequence(**read))
    return tuple(sequences)


@checked
def sequence(
    motions: Sequence[Motion],
    *,
    name: str = "sequence",
    pause: float = PAUSE,
    factors: Sequence[float] | None = None,
    polarity: Sequence[str] | None = None,
    confirm: Sequence[str] = (),
) -> Motion:
    """Return shocks as one motion, one after the other.

    Parameters
    ----------
    motions : sequence of Motion
        The shocks in their order; repetitions are allowed.
    name : str
        Of the sequence.
    pause : float
        Time from the last sample of a shock to the first of the next [s], rounded to whole samples, at least two. In it the
        ground is brought to the initial velocity of the next record, mostly 0, by an acceleration (Δv/P) (1 − cos(2πt/P)).
    factors : sequence of float, optional
        On all components of each shock.
    polarity : sequence of str, optional
        "+" or "-" for each shock: "-" reverses its horizontal component.
    confirm : sequence of str
        Names of values of the sequence that are right though unusual, as of a :class:`Motion`; those that all shocks confirm are
        confirmed.

    Returns
    -------
    Motion
        With the times of its ``shocks``. Its sampling interval is the least of theirs; records with a longer one are interpolated
        linearly, which changes nothing for a multiple. If some shocks have a vertical component, the others get zeros, with a
        note; it has a component ``across`` if all have. Its ``factor`` is that of all shocks, 1 if theirs differ. A sequence of
        one has the record's samples.

    Raises ``InputError`` for no motions, sequences among them, lists of other lengths, values other than above, sampling
    intervals too far apart, too many samples, and more than 0.005 g needed to bring the ground to rest.

    Examples
    --------
    >>> shock = rb.pulse("sine", name="shock", amplitude=2.0, period=1.0, dt=0.01, duration=5.0)
    >>> both = rb.sequence([shock, shock], name="twice", pause=10.0, factors=[1.0, 0.8])
    >>> [(s.name, round(s.start, 2), round(s.end, 2)) for s in both.shocks]
    [('shock', 0.0, 5.0), ('shock', 15.0, 20.0)]
    """
    signs = ["+"] * len(motions) if polarity is None else list(polarity)
    times = [1.0] * len(motions) if factors is None else list(factors)
    _check(motions, name, pause, times, signs)
    notes = [f"shock {i}, {m.name}: {note}" for i, m in enumerate(motions, 1) for note in m.notes]
    parts = list(motions)
    for i, (factor, sign) in enumerate(zip(times, signs, strict=True)):
        if (factor, sign) != (1.0, "+"):
            parts[i] = parts[i].times(factor, reverse=sign == "-")
            notes.append(f"shock {i + 1}, {parts[i].name}: times {factor:g}{', reversed' * (sign == '-')}")
    dt = min(part.dt for part in parts)
    _check_size(parts, dt, name, pause)
    parts = [_resampled(part, dt, notes) for part in parts]
    pause_steps = max(2, round(pause / dt))
    starts = np.cumsum([0, *(part.npts - 1 + pause_steps for part in parts[:-1])])
    rest, vertical, across = [Initial()] * len(parts), None, None
    if any(part.vertical is not None for part in parts):
        lacking = [part.name for part in parts if part.vertical is None]
        notes += [f"no vertical component in {lacks}: zeros" for lacks in dict.fromkeys(lacking)]
        verticals = [part.vertical if part.vertical is not None else np.zeros(part.npts) for part in parts]
        vertical = _concatenated(verticals, rest, dt, pause_steps, name, "vertical: ", notes)
    acrosses = [part.across for part in parts if part.across is not None]
    if len(acrosses) == len(parts):
        across = _concatenated(acrosses, rest, dt, pause_steps, name, "across: ", notes)
    initial = [part.initial or Initial() for part in parts]
    horizontal = _concatenated([part.horizontal for part in parts], initial, dt, pause_steps, name, "", notes)
    shocks = []
    for start, part in zip(map(int, starts), parts, strict=True):
        end = start + part.npts - 1
        shocks.append(Shock(part.name, start * dt, end * dt, (end + pause_steps) * dt, part.of_station))
    whole = replace(
        parts[0],
        name=name,
        dt=dt,
        across=across,
        horizontal=horizontal,
        vertical=vertical,
        notes=tuple(notes),
        shocks=tuple(shocks),
        confirm=tuple(sorted({*confirm}.union(set.intersection(*({*part.confirm} for part in parts))))),
    )
    return whole if len(parts) == 1 else _with_common_origin(parts, whole)


def _check(
    motions: Sequence[Motion], name: str, pause: float, factors: Sequence[float], polarity: Sequence[str]
) -> None:
    """Raise ``InputError`` with all impossible arguments of :func:`sequence`; return None if there are none."""
    wrong = [] if motions else [f"{name}: a sequence has one motion at least"]
    if not 0 < pause < math.inf:
        wrong.append(f"{name}: pause = {pause:g}: must be a number above 0 [s]")
    wrong += [f"{name}: factors: {f:g} must be a number above 0" for f in factors if not 0 < f < math.inf]
    wrong += [f'{name}: polarity: {shown(sign)} must be "+" or "-"' for sign in polarity if sign not in ("+", "-")]
    for key, values in (("factors", factors), ("polarity", polarity)):
        if len(values) != len(motions):
            wrong.append(f"{name}: {key}: {len(values)} given for {len(motions)} motions; give one for each")
    wrong += [
        f"{name}: {motion.name} is a sequence itself; give its records" for motion in motions if len(motion.shocks) > 1
    ]
    refuse(wrong)


def _check_size(parts: Sequence[Motion], dt: float, name: str, pause: float) -> None:
    """Raise ``InputError`` for sampling intervals too far apart, and for more samples than a record may have."""
    coarse = max(part.dt for part in parts)
    length = sum(part.duration for part in parts) + pause * (len(parts) - 1)
    if coarse > MOST_STEPS * dt:
        raise InputError(f"{name}: sampled at {dt:g} s and at {coarse:g} s, more than {MOST_STEPS} times apart")
    if length > MOST_SAMPLES * dt:
        raise InputError(
            f"{name}: {length:.3g} s at {dt:g} s are more than {MOST_SAMPLES:,} samples; write a shorter pause"
        )


def _resampled(motion: Motion, dt: float, notes: list[str]) -> Motion:
    """Return a motion interpolated linearly to an interval ``dt`` [s], and append a note; itself if it has that interval."""
    if abs(motion.dt - dt) <= _SAME * dt:
        return motion
    notes.append(f"{motion.name} interpolated linearly from dt = {motion.dt:g} s to {dt:g} s")
    places = np.arange(math.floor(motion.duration / dt * (1 + _SAME)) + 1) * dt / motion.dt  # in samples of the motion

    def interpolated(component: Samples) -> Samples:
        return np.interp(places, np.arange(motion.npts), component)

    return replace(
        motion,
        dt=dt,
        horizontal=interpolated(motion.horizontal),
        vertical=None if motion.vertical is None else interpolated(motion.vertical),
        across=None if motion.across is None else interpolated(motion.across),
    )


def _concatenated(
    series: Sequence[Samples], initial: Sequence[Initial], dt: float, gap: int, name: str, part: str, notes: list[str]
) -> Samples:
    """Return accelerations one after the other, ``gap`` steps apart, in which the ground reaches the next ``initial`` velocity.

    ``part`` names the component in ``notes`` and errors.
    """
    if len(series) == 1:
        return series[0]
    joined = []
    bell = 1.0 - np.cos(2.0 * math.pi * np.arange(1, gap) / gap)
    most = 0.0
    for a, b, before, after in zip(series, series[1:], initial, initial[1:], strict=False):
        ends = float(measures.velocity(a, dt, before)[-1]) + 0.5 * dt * (a[-1] + b[0])
        height = (after.velocity - ends) / (gap * dt)
        most = max(most, 2.0 * abs(height))
        joined += [a, height * bell if 2.0 * abs(height) > 1e-12 * np.abs(a).max() else np.zeros(gap - 1)]
    if most > MOST_IN_PAUSE:
        raise InputError(
            f"{name}: {part}it takes {most / GRAVITY:.2g} g to bring the ground to rest in a pause of {gap * dt:g} s, more than "
            f'{MOST_IN_PAUSE / GRAVITY:g} g: a record ends with a velocity, as with an offset; write offset = "mean" under '
            "[motions], or a longer pause_s"
        )
    if most > _NOTED:
        notes.append(f"{part}the ground is brought to rest in the pauses by {most / GRAVITY:.1e} g at most")
    return np.concatenate([*joined, series[-1]])


def _with_common_origin(parts: Sequence[Motion], whole: Motion) -> Motion:
    """Return ``whole`` with the sources and findings of all ``parts``, and facts that all share, such as magnitude; else None."""
    listed = {name: _common(getattr(part.listed, name) for part in parts) for name in vars(NOT_LISTED)}
    return replace(
        whole,
        source=", ".join(_in_turn((part.source,) for part in parts)),
        vertical_source=", ".join(_in_turn((part.vertical_source,) for part in parts)),
        component_sources=_in_turn(part.sources for part in parts),
        recorded=any(part.recorded for part in parts),
        findings=tuple(dict.fromkeys(finding for part in parts for finding in part.findings)),
        station=" + ".join(sorted({part.of_station for part in parts})),  # the same for any order and repetition
        origin=UNKNOWN_ORIGIN,
        lacks_vertical=any(part.lacks_vertical for part in parts),
        azimuth=_common(part.azimuth for part in parts),
        magnitude=_common(part.magnitude for part in parts),
        distance_km=_common(part.distance_km for part in parts),
        processed=_common(part.processed for part in parts),
        listed=Listed(**listed | {"d5_95_s": None}),  # that of one record
        factor=_common(part.factor for part in parts) or 1.0,
        vertical_factor=_common(part.vertical_factor for part in parts),
    )


def _in_turn(sources: Iterable[Iterable[str]]) -> tuple[str, ...]:
    """Return the sources of all shocks in their order, once each; empty ones are skipped."""
    return tuple(dict.fromkeys(filter(None, chain.from_iterable(sources))))


def _common(values: Iterable[T]) -> T | None:
    """Return the value that all ``values`` share; None if they differ, or there is none."""
    different = set(values)
    return different.pop() if len(different) == 1 else None


def add_sequences(
    motions: MotionSet, sequences: Sequence[ShockSequence], pulses: Sequence[Motion] = (), source: str = ""
) -> tuple[MotionSet, list[Motion]]:
    """Return records and pulses followed by their sequences, which replace the records that are not also run ``alone``.

    A sequence of pulses only is a pulse, which no target scales. A sequence is unusable if one of its records is, or if they
    cannot be joined. In a study raises ``InputError`` for a sequence with the name of a record, and for names of no record; a
    sequence of a manifest, ``source``, is then unusable, or left out if none of its records is read.
    """
    if not sequences:
        return motions, list(pulses)
    by_name = {motion.name: motion for motion in (*motions.motions, *pulses)}
    not_used: tuple[Unusable | LeftOut, ...] = (*motions.unusable, *motions.left_out)
    reasons = {file.name: file.reason for file in not_used}
    joined_motions: list[Motion] = []
    refused: list[Unusable | LeftOut] = []
    wrong: list[str] = []
    for entry in sequences:
        try:
            joined = _sequence_or_refusal(entry, by_name, reasons, source)
        except InputError as error:
            wrong += error.messages
        else:
            (joined_motions if isinstance(joined, Motion) else refused).append(joined)  # type: ignore[arg-type]
    refuse(wrong)
    names = {motion.name for motion in joined_motions}
    parts = {name: entry.name for entry in reversed(sequences) if entry.name in names for name in entry.records}
    alone = {name for entry in sequences if entry.alone for name in entry.records}
    for name, whole in parts.items():
        if name not in alone:
            reason = f"a shock of the sequence {shown(whole)}; alone = true there also runs it on its own"
            refused.append(LeftOut(name, by_name[name].sources, reason))
    parts_only = parts.keys() - alone
    as_pulses = [motion for motion in joined_motions if not motion.recorded]
    records = [motion for motion in motions.motions if motion.name not in parts_only]
    records += [motion for motion in joined_motions if motion not in as_pulses]
    unusable = [file for file in refused if isinstance(file, Unusable)]
    left_out = [file for file in refused if isinstance(file, LeftOut)]
    pulses_alone = [pulse for pulse in pulses if pulse.name not in parts_only]
    return motions.reduced_to(records, unusable, left_out), pulses_alone + as_pulses


def _sequence_or_refusal(
    entry: ShockSequence, by_name: Mapping[str, Motion], reasons: Mapping[str, str], source: str
) -> Motion | Unusable | LeftOut:
    """Return a sequence of the motions ``by_name``; unusable if a record of it is, or if they cannot be joined.

    ``reasons`` has those of unusable and left-out records by name. A name that is taken or unknown is an error in a study, where
    ``source`` is ""; in a manifest the sequence is unusable, or left out if all its records are unknown.
    """
    taken = ["a record has this name; give the sequence one of its own"] if entry.name in by_name else []
    missing = [name for name in entry.records if name not in by_name]
    reasons_of_parts = [f"its record {name} cannot be used: {reasons[name]}" for name in missing if name in reasons]
    unknown = []
    for name in (name for name in missing if name not in reasons):
        nearest = closest(name, by_name)
        hint = f"did you mean {shown(nearest)}?" if nearest else "`rockbatch motions PATH` lists them"
        unknown.append(f"records: there is no record {shown(name)}; {hint}")
    if (taken or unknown) and not source:
        raise InputError(*(f"[[motions.sequence]] {shown(entry.name)}: {message}" for message in (*taken, *unknown)))
    # if only one file beside the manifest is read, or rotation has renamed the records
    if len(unknown) == len(entry.records):
        return LeftOut(entry.name, (source,), f"none of its records is read: {unknown[0]}")
    if not missing and not taken:
        try:
            return entry.as_motion([by_name[name] for name in entry.records])
        except InputError as error:
            reasons_of_parts = list(error.messages)
    reason = f"sequence {shown(entry.name)}: {'; '.join((*taken, *reasons_of_parts, *unknown))}"
    return Unusable(entry.name, (source or "[[motions.sequence]]",), reason)
