"""The ground motions of a study: read, selected, scaled, and pulses beside them."""

from collections.abc import Sequence
from dataclasses import fields, replace

from rockbatch.common.errors import InputError
from rockbatch.motions import Motion, MotionSet, ReadOptions
from rockbatch.motions.folder import read_records, with_manifest_sequences
from rockbatch.motions.labels.orientation import same_azimuth
from rockbatch.motions.quality.baseline import Offset
from rockbatch.motions.suites.scaling import scale_as_listed, scale_to_targets
from rockbatch.motions.suites.selection import Selection, selected
from rockbatch.motions.suites.sequences import add_sequences
from rockbatch.motions.suites.spectrum_target import SpectrumTarget
from rockbatch.motions.unused import Unusable
from rockbatch.study.both_axes import on_both_axes
from rockbatch.study.load import Study
from rockbatch.study.spec import MotionSpec


def ground_motions(study: Study) -> MotionSet:
    """Return all motions of a study, of its files, packaged records, pulses and still ground, and its unusable files.

    Records are read, freed of their offsets, turned and paired, joined to sequences, then selected, then scaled to the study's
    target; its ``scale`` and ``polarity`` are left to the runs. Raises ``InputError`` if no motion is left, in a strict study if
    any file is unusable, and for keys about recorded motions in a study without these.
    """
    spec, both = study.motions, on_both_axes(study.cases)
    if wrong := _without_records(spec, both):
        raise InputError(*wrong)
    gravity, azimuths = study.cases[0].pier.gravity, _azimuths(study)
    if isinstance(spec.override, MotionSet):
        records = _as_given(spec.override, spec.vertical)
    else:
        records, sequences = read_records(
            spec.paths,
            vertical=spec.vertical,
            gravity=gravity,
            options=ReadOptions(spec.unit, spec.dt, spec.columns, spec.sensitivity, spec.role, spec.layout),
            fema=[(record.station, record.azimuth) for record in spec.fema_p695],
            offset=spec.offset,
            azimuths=azimuths,
            confirmed=spec.confirm,
            confirmed_pga=spec.confirm_pga,
            leave_out=spec.leave_out if spec.override is None else (),
        )
        if azimuths != spec.azimuths:
            records = _without_the_square(records, azimuths)
        records = with_manifest_sequences(records, sequences)
    pulses = [shape.motion(gravity) for shape in spec.pulses]
    records, pulses = add_sequences(records, spec.sequences, pulses)
    station = {motion.name: motion.of_station for motion in records}
    records = selected(records, spec.select, gravity)
    if both:
        records, pulses = _with_pairs(records, pulses)
    if spec.scale_as_listed:
        records = scale_as_listed(records)
    records = scale_to_targets(records, spec.target, spec.vertical_target, spec.vertical_scale, gravity, spec.confirm)
    unusable = [replace(file, station=file.station or station.get(file.name, file.name)) for file in records.unusable]
    records = replace(records, unusable=unusable)
    reasons = [f"{file.source}: {file.reason}" for file in records.unusable]
    if spec.strict and reasons:
        raise InputError(*reasons, f"{len(reasons)} of the records cannot be used, and the study is strict")
    if spec.still_s is not None and spec.override is None:
        pulses.append(Motion.still(spec.still_s))
    if not records.motions and not pulses:
        reasons += [f"{file.source}: {file.reason}" for file in records.left_out]
        folders = ", ".join(str(path) for path in spec.paths)
        raise InputError(f"{folders}: no ground motion that can be used; `rockbatch motions PATH` shows why", *reasons)
    return replace(records, motions=[*records.motions, *pulses])


_OF_FILES = ("unit", "dt", "columns", "sensitivity", "role", "layout")
_OF_RECORDS = (
    "vertical",
    "offset",
    "azimuths",
    "select",
    "target",
    "vertical_target",
    "vertical_scale",
    "confirm",
    "confirm_pga",
    "leave_out",
    "strict",
)
"""Keys that do not apply to pulses and still ground; scale and polarity do."""


def _without_records(spec: MotionSpec, both_axes: bool) -> list[str]:
    """Return a message for each key that only files use, or only recorded motions, in a study without these; [] with files."""
    if spec.paths or spec.override is not None:
        return []
    usual = {field.name: field.default for field in fields(spec)} | {"offset": Offset(), "select": Selection()}
    candidates = _OF_FILES if spec.fema_p695 else (*_OF_FILES, *_OF_RECORDS)
    idle = [name for name in candidates if getattr(spec, name) != usual[name]]
    compared_only = isinstance(spec.target, SpectrumTarget) and spec.target.factors == "none"
    effective = {"azimuths": both_axes, "confirm": {*spec.confirm} <= {"scale"}, "target": compared_only}
    idle = [name for name in idle if not effective.get(name)]
    keys = ["axis_deg or every_deg" if name == "azimuths" else name for name in idle]
    return [f'[motions]: {key}: is for recorded motions; write path = "../motions", or leave {key} out' for key in keys]


def _azimuths(study: Study) -> tuple[float, ...]:
    """Return the directions [°] that pairs are turned to: those of the study, and one at right angles to the first if spectra
    of pairs or runs on both axes need it and none of them is."""
    spec = study.motions
    of_pairs = spec.target is not None and spec.target.pairs != "apart"
    if not (of_pairs or study.output.has("sa_pairs") or on_both_axes(study.cases)) or not spec.azimuths:
        return spec.azimuths
    square = (spec.azimuths[0] + 90.0) % 360.0
    if any(same_azimuth(azimuth, way) for azimuth in spec.azimuths for way in (square, square + 180.0)):
        return spec.azimuths
    return *spec.azimuths, square


def _with_pairs(motions: MotionSet, pulses: Sequence[Motion]) -> tuple[MotionSet, list[Motion]]:
    """Return the records and pulses that have an ``across``, their other horizontal component; others are unusable."""
    reason = (
        "has no horizontal component at right angles, and cases with other_width_m are run on both axes; leave it out "
        "(leave_out under [motions]), or run it in a study without other_width_m"
    )
    lacking = [motion for motion in (*motions, *pulses) if motion.across is None]
    unusable = [
        Unusable(motion.name, motion.sources or (motion.name,), f"{motion.name} {reason}", station=motion.of_station)
        for motion in lacking
    ]
    paired = [motion for motion in motions if motion.across is not None]
    return motions.reduced_to(paired, unusable), [pulse for pulse in pulses if pulse.across is not None]


def _without_the_square(motions: MotionSet, azimuths: Sequence[float]) -> MotionSet:
    """Return motions without those along the last of ``azimuths``, square to the first.

    Each becomes the component across of its station's motion along the first, if that is as long.
    """
    first, square = (azimuth % 360.0 for azimuth in (azimuths[0], azimuths[-1]))
    across = {motion.of_station: motion for motion in motions if motion.turned and motion.azimuth == square}
    along = [motion for motion in motions if across.get(motion.of_station) is not motion]
    for i, motion in enumerate(along):
        perpendicular = across.get(motion.of_station)
        if (
            perpendicular is not None
            and motion.turned
            and motion.azimuth == first
            and perpendicular.npts == motion.npts
        ):
            along[i] = replace(motion, across=perpendicular.horizontal)
    return replace(motions, motions=along)


def _as_given(motions: MotionSet, vertical: bool | str) -> MotionSet:
    """Return motions from Python, without vertical components if ``vertical`` is False.

    Raises ``InputError`` for motions without one if it is "required".
    """
    if vertical is False:
        return replace(motions, motions=[replace(motion, vertical=None) for motion in motions])
    if vertical == "required":
        lacking = [f"motions: {motion.name} has no vertical component" for motion in motions if motion.vertical is None]
        if lacking:
            raise InputError(*lacking)
    return motions
