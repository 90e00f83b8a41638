"""From components to motions: every horizontal one with its station's vertical, on common samples."""

import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from rockbatch.motions.component import Component
from rockbatch.motions.motion import Motion, MotionSet, Samples, Unusable
from rockbatch.motions.orientation import same_azimuth
from rockbatch.units import GRAVITY

_SAME_STEP = 1e-6  # relative: steps that differ by less are the same, printed otherwise
_SAME_SAMPLE = 0.01  # of dt: components whose starts are off by less share their samples
_MOST_OF_IT = 0.95  # of the horizontal peak: what a vertical that ends early may cost
_HIGHEST, _LOWEST = 5.0, 0.001  # PGA in g beyond which a wrong unit is likelier than the record


def to_motions(
    components: Sequence[Component],
    packaged: Sequence[Component] = (),
    *,
    vertical: bool = True,
    gravity: float = GRAVITY,
) -> MotionSet:
    """Motions of ``components`` in their order, then of those of a package.

    Components are paired that share folder and station; those of a package (no folder) join the files of the
    same RSN, whose own component of that azimuth goes first. Verticals that find no partner, or that are not
    the only one, come back as unusable with the reason.
    """
    verticals: dict[tuple[str, str], list[Component]] = {}
    for component in components:
        if component.orientation.vertical:
            verticals.setdefault((component.folder, component.station), []).append(component)
    horizontals = [component for component in components if not component.orientation.vertical]
    kept, replaced = _without_doubles(horizontals, packaged)

    used: set[int] = set()
    unusable: list[Unusable] = []
    motions: list[Motion] = []
    for component in kept:
        notes = list(component.notes)
        if not component.orientation.label and component.orientation.azimuth is None:
            notes.append("direction not stated: taken as horizontal")
        notes += replaced.get(id(component), [])
        partner = None
        if vertical:
            together = [v for v in _candidates(component, verticals) if _overlap(component, v)]
            ambiguous = len(together) > 1
            if ambiguous:
                notes.append(f"no vertical: there are {len(together)} of them for this station")
                names = ", ".join(v.source for v in together)
                reason = f"several vertical components of one station ({names}): keep one of them"
                unusable += [Unusable(v.name, v.source, reason) for v in together if id(v) not in used]
            elif together:
                partner = together[0]
            used.update(id(v) for v in together)
        motions.append(_motion(component, partner, notes, gravity))
    if vertical:
        reason = "a vertical component without a horizontal one of its station in its folder"
        left = [v for group in verticals.values() for v in group if id(v) not in used]
        unusable += [Unusable(v.name, v.source, f"{reason} ({v.station})") for v in left]
    named = _told_apart(motions, [component.folder for component in kept])
    return MotionSet(named, sorted(unusable, key=lambda u: u.source))


def _without_doubles(
    files: Sequence[Component], packaged: Sequence[Component]
) -> tuple[list[Component], dict[int, list[str]]]:
    """Horizontals without those of the package that a file has too, and notes for these files."""
    kept = list(files)
    notes: dict[int, list[str]] = {}
    for component in packaged:
        azimuth = component.orientation.azimuth
        same = [
            file
            for file in files
            if file.station == component.station and same_azimuth(file.orientation.azimuth, azimuth)
        ]
        if not same:
            kept.append(component)
        for file in same:
            notes.setdefault(id(file), []).append(f"used instead of {component.name} of {component.source}")
    return kept, notes


def _candidates(horizontal: Component, verticals: dict[tuple[str, str], list[Component]]) -> list[Component]:
    """Vertical components of the horizontal one's station: of its folder, or of the first that has some."""
    if horizontal.folder or not horizontal.station:
        return verticals.get((horizontal.folder, horizontal.station), [])
    folders = sorted(folder for folder, station in verticals if station == horizontal.station)
    return verticals[folders[0], horizontal.station] if folders else []


def _overlap(a: Component, b: Component) -> bool:
    """Whether two components have a time in common, as far as is known."""
    if a.start is None or b.start is None:
        return True
    return a.start < b.start + b.duration and b.start < a.start + a.duration


def _motion(h: Component, v: Component | None, notes: Iterable[str], gravity: float) -> Motion:
    """The motion of a horizontal component and its vertical one."""
    said = list(notes)
    dt, horizontal, vertical = h.dt, h.acceleration, None
    if v is not None:
        dt, horizontal, vertical, how = _on_common_samples(h, v)
        if len(horizontal) < 2 or np.abs(horizontal).max() < _MOST_OF_IT * h.pga:
            said.append(f"no vertical: {v.source} does not last over the horizontal peak")
            dt, horizontal, vertical, v = h.dt, h.acceleration, None, None
        else:
            said += how
    if v is not None:
        said += [f"vertical: {note}" for note in v.notes]
        if v.orientation.down:
            said.append(f"vertical: {v.orientation.label or 'component'} is positive down, sign reversed")
    pga = float(np.abs(horizontal).max()) / gravity
    if not _LOWEST <= pga <= _HIGHEST:
        said.append(f"PGA {pga:.3g} g: check the unit")
    return Motion(
        name=h.name,
        dt=dt,
        horizontal=horizontal,
        vertical=vertical,
        source=h.source,
        vertical_source=v.source if v is not None else "",
        notes=tuple(said),
    )


def _on_common_samples(h: Component, v: Component) -> tuple[float, Samples, Samples, list[str]]:
    """Both components on common samples, over their common time: dt, horizontal, vertical, notes.

    Components without absolute times start together. Where samples do not coincide, the horizontal component
    keeps its own, with as many between them as make it no coarser than the vertical one, and both are
    interpolated linearly: exact for the horizontal one, and for the vertical one where its samples are met.
    """
    offset = 0.0 if h.start is None or v.start is None else v.start - h.start
    up = v.upward
    notes = []
    same_step = abs(h.dt - v.dt) <= _SAME_STEP * h.dt
    shift = round(offset / h.dt)
    if same_step and abs(offset / h.dt - shift) <= _SAME_SAMPLE:
        first, last = max(0, shift), min(len(h.acceleration), len(up) + shift)
        dt, horizontal, vertical = h.dt, h.acceleration[first:last], up[first - shift : last - shift]
    else:
        parts = 1 if same_step else math.ceil(h.dt / v.dt * (1 - _SAME_STEP))
        dt = h.dt / parts
        times = np.arange((len(h.acceleration) - 1) * parts + 1) * dt
        slack = _SAME_SAMPLE * dt
        times = times[(times >= offset - slack) & (times <= offset + v.duration + slack)]
        horizontal = np.interp(times / h.dt, np.arange(len(h.acceleration)), h.acceleration)
        vertical = np.interp((times - offset) / v.dt, np.arange(len(up)), up)
        moved = ["horizontal"] * (parts > 1) + ["vertical"] * (abs(dt - v.dt) > _SAME_STEP * dt or offset != 0)
        notes.append(
            f"{' and '.join(moved)} interpolated linearly to dt = {dt:g} s, from {h.dt:g} s horizontal and "
            f"{v.dt:g} s vertical"
        )
    span = (len(horizontal) - 1) * dt
    if span < max(h.duration, v.duration) - 0.5 * dt:
        whole = f"{h.duration:g} s horizontal and {v.duration:g} s vertical"
        notes.append(f"common span: {span:g} s of {whole}")
    return dt, horizontal, vertical, notes


def _told_apart(motions: list[Motion], folders: list[str]) -> list[Motion]:
    """Motions of the same name get the suffix of their files, then their folder, then a number."""

    def with_suffix(i: int, name: str) -> str:
        file = re.sub(r" \(.*\)$", "", motions[i].source).rsplit("/", 1)[-1]
        return file if file.startswith(f"{name}.") else name

    def with_folder(i: int, name: str) -> str:
        return f"{folders[i].rsplit('/', 1)[-1]}/{name}" if folders[i] else name

    names = [motion.name for motion in motions]
    in_folder = Counter(zip(folders, names, strict=True))
    names = [with_suffix(i, name) if in_folder[folders[i], name] > 1 else name for i, name in enumerate(names)]
    count = Counter(names)
    names = [with_folder(i, name) if count[name] > 1 else name for i, name in enumerate(names)]
    seen: Counter[str] = Counter()
    for i, name in enumerate(names):
        seen[name] += 1
        if seen[name] > 1:
            names[i] = f"{name} ({seen[name]})"
    return [replace(motion, name=name) for motion, name in zip(motions, names, strict=True)]
