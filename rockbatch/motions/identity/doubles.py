"""One recording in several files: choice of the set of components to use."""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from rockbatch.common.grouping import grouped
from rockbatch.motions.alignment import common_factor, same_step
from rockbatch.motions.component import Component
from rockbatch.motions.formats import is_usual
from rockbatch.motions.identity.likeness import Pairs, factor_between, pairs_of_one_recording, sets_of
from rockbatch.motions.identity.stations import in_one_event
from rockbatch.motions.motion import Finding
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.quality.plausible import gross_findings, in_a_borehole
from rockbatch.motions.unused import LeftOut

_CORRECTED = {True: 0, None: 1, False: 2}
_GROSS_FACTOR = 0.05  # relative difference between copies beyond which they have to be confirmed
_UNITS, _SAME_UNIT = (3.2808, 9.81, 10.0, 32.185, 39.37, 98.1, 100.0, 386.22, 981.0, 1000.0, 9810.0), 0.003
"""Factors between units of acceleration (10 is g/10), and how far off they may be, relative: g is 9.80665 to 9.81 m/s²."""
_UNEQUAL = 1.5  # ratio of the peaks of two copies that is reported
_MOVING = 1e-3  # of the peak
_SECONDARY = re.compile(r"(?<!un)(?<!not_)scaled|(?<![a-z])automatic(?![a-z])", re.IGNORECASE)
_RAW = re.compile(r"(?<![a-z])(?:raw|uncorr(?:ected)?)(?![a-z])", re.IGNORECASE)


def without_boreholes(components: Sequence[Component]) -> tuple[list[Component], list[LeftOut]]:
    """Return the components in use, and as left out those in boreholes below a surface sensor that recorded the same earthquake.

    A manifest's choice (``use = true``) stays in use.
    """
    surface = [c for c in components if c.sensor.number and not in_a_borehole(c)]
    at_surface = grouped(surface, lambda c: c.sensor.number)
    used_components: list[Component] = []
    left_out: list[LeftOut] = []
    for component in components:
        below = in_a_borehole(component) and not component.preferred
        above = at_surface.get(component.sensor.number, []) if below else []
        used = next((candidate for candidate in above if in_one_event(component, candidate)), None)
        if used is None:
            used_components.append(component)
        else:
            reason = f"in a borehole below {used.source}"
            left_out.append(LeftOut(component.name, component.sources, reason, of=used.source))
    return used_components, left_out


def without_doubles(components: Sequence[Component]) -> tuple[list[Component], list[LeftOut]]:
    """Return the components to use, in their order, and the copies that are left out, with the reason.

    Sets are ranked as wholes (:func:`_ranks`), so that the components of a station come from one instrument. A manifest's
    choice (``use = true``) is always used. A finding of the used component names copies that differ by a factor or in their
    peaks; if neither plausibility nor a file's name decides which factor is right, it has to be confirmed. Copies by a factor
    under other names stay, since suites are scaled on purpose, with a finding; if the factor is a ratio of units, both have
    to be confirmed, as have components with the same samples at two steps. A vertical in two sets of other horizontals is used
    with both, with a finding.
    """
    components, below = without_boreholes(components)
    pairs, scaled, denied = pairs_of_one_recording(components)
    upright = [replace(c, acceleration=c.upward) if c.orientation.vertical else c for c in components]
    factors = {(i, j): factor_between(upright[i], upright[j]) for i, copies in pairs.items() for j in copies}
    rank = _ranks(components, pairs, factors)
    used: set[int] = set()
    stands_for: dict[int, int] = {}
    for i in sorted(pairs, key=rank.__getitem__):
        better = [j for j in pairs[i] if j in used]
        if better and not components[i].preferred:
            stands_for[i] = min(better, key=rank.__getitem__)
        else:
            used.add(i)
    findings: dict[int, list[Finding]] = {}
    for i, horizontals in list(_shared_verticals(components, stands_for)):
        source = components[stands_for.pop(i)].source
        text = f"its vertical component {components[i].source} is {source}, of other horizontals: check which of them has it"
        for horizontal in horizontals:
            findings.setdefault(horizontal, []).append(Finding("vertical", text))
    left_out = []
    for i, j in sorted(stands_for.items()):
        copy, original, factor = components[i], components[j], factors[i, j]
        left_out.append(LeftOut(copy.name, copy.sources, _reason(copy, original, factor), of=original.source))
        decided = original.preferred or rank[i][1:4] != rank[j][1:4]
        if finding := _finding_on_copy(copy, original, factor, decided):
            findings.setdefault(j, []).append(finding)
    for i, j in (pair for pair in scaled if not stands_for.keys() & pair):
        for k, other in ((i, components[j]), (j, components[i])):
            findings.setdefault(k, []).append(_factor_finding(components[k], other))
    stretched = list(_at_other_steps(components))
    for i, j in (pair for pair in stretched if not stands_for.keys() & pair):
        for k, other in ((i, components[j]), (j, components[i])):
            text = f"{other.source} has the same samples with a step of {other.dt:g} s: one of their steps is wrong; check both"
            stations = {components[i].sensor.number, components[j].sensor.number} - {""}
            findings.setdefault(k, []).append(Finding("step", text, gross=len(stations) < 2))
    for i, j in (pair for pair in denied if not stands_for.keys() & pair and pair not in stretched):
        for k, other in ((i, components[j]), (j, components[i])):
            text = f"{other.source} is the same sensor, event and direction by its header, and has other samples: check both"
            findings.setdefault(k, []).append(Finding("header", text))
    for i, own in findings.items():
        components[i] = components[i].with_findings(*own)
    remaining = [component for i, component in enumerate(components) if i not in stands_for]
    return remaining, [*below, *left_out]


def _at_other_steps(components: Sequence[Component]) -> Iterator[tuple[int, int]]:
    """Yield places i < j of two components of two files with the same samples, perhaps times a factor, at different steps."""
    moving = [(i, c) for i, c in enumerate(components) if c.pga > 0.0]
    for alike in grouped(
        moving, lambda pair: (len(pair[1].acceleration), int(np.abs(pair[1].acceleration).argmax()))
    ).values():
        for (i, a), (j, b) in combinations(alike, 2):
            one_file = a.file == b.file
            if not (one_file or same_step(a.dt, b.dt)) and common_factor(a.acceleration, b.acceleration):
                yield i, j


def _factor_finding(component: Component, other: Component) -> Finding:
    """Return the finding that ``other`` has the samples of ``component`` times a factor, gross for a ratio of units."""
    factor = factor_between(other, component)
    assert factor is not None  # scaled pairs have one
    text = f"{other.source} has the same samples times {factor:.4g}"
    if _is_unit_ratio(factor):
        text += ": a unit, which one of them states wrongly; check which of them is right"
    else:
        text += "; both are used, and count as one record"
    return Finding("factor", text, gross=_is_unit_ratio(factor))


def _shared_verticals(
    components: Sequence[Component], stands_for: Mapping[int, int]
) -> Iterator[tuple[int, list[int]]]:
    """Yield the place of a set's only vertical if another station's stands for it, and the places of its used horizontals."""

    def place(i: int) -> tuple[str, str]:
        return components[i].folder, components[i].station or components[i].site

    for members in sets_of(components):
        verticals = [i for i in members if components[i].orientation.vertical]
        horizontals = [i for i in members if i not in verticals and i not in stands_for]
        copied = [i for i in verticals if i in stands_for and place(i) != place(stands_for[i])]
        if horizontals and len(verticals) == len(copied) == 1:
            yield copied[0], horizontals


def _ranks(
    components: Sequence[Component], pairs: Pairs, factors: dict[tuple[int, int], float | None]
) -> dict[int, tuple[object, ...]]:
    """Return sort keys of components with copies, the least for the one to use: the key of its set, then its index.

    In this order: chosen by a manifest; sound before grossly odd; corrected before unknown before uncorrected; not called
    scaled, or automatic, also by the header; not called raw, if no header says; two horizontals and a vertical before fewer; a
    unit of acceleration before counts; the finer time step; the stronger shaking, by powers of two; the longer shaking, by
    seconds; the suffix of a format; the shorter name; the first.
    """
    sets: dict[int, list[int]] = {}
    for members in sets_of(components):
        sets.update(dict.fromkeys(members, members))
    energy = {i: float(c.acceleration @ c.acceleration) * c.dt for i, c in enumerate(components) if i in sets}
    for (i, j), factor in factors.items():
        if factor is not None:
            energy[i] = energy[j] = min(energy[i], energy[j])
    ranks: dict[int, tuple[object, ...]] = {}
    for members in {id(m): m for i, m in sets.items() if i in pairs}.values():
        of_set = [components[i] for i in members]
        first = of_set[0]
        across = sum(not c.orientation.vertical for c in of_set)
        rank = (
            not any(c.preferred for c in of_set),
            any(c.contradiction or gross_findings(c) for c in of_set),
            _CORRECTED[first.processed],
            any(_SECONDARY.search(f"{c.source} {c.station}") for c in of_set),
            first.processed is None and any(_RAW.search(c.source) for c in of_set),
            -min(2, across) - (across < len(of_set)),
            not first.unit,
            float(f"{first.dt:.3g}"),
            -round(math.log2(sum(energy[i] for i in members) or 1e-300)),
            -round(_shaken(of_set)),
            not is_usual(first.suffix),
            min(len(c.source) for c in of_set),
            members[0],
        )
        ranks.update({i: (*rank, i) for i in members})
    return ranks


def _shaken(components: Sequence[Component]) -> float:
    """Return the time [s] between the first and the last sample at which a set moves by 0.1 % of its peak or more.

    Zeros put around a record do not change it, nor do turned axes, since the components are taken as one vector.
    """
    squares = np.zeros(max(len(c.acceleration) for c in components))
    for component in components:
        squares[: len(component.acceleration)] += np.square(component.acceleration)
    moving = np.flatnonzero(squares >= _MOVING**2 * squares.max())
    return float(moving[-1] - moving[0]) * components[0].dt


def _is_unit_ratio(factor: float) -> bool:
    """Return whether a factor between copies, or its inverse, is to 0.3 % the ratio of two units, as m/s² and g; False near 1."""
    apart = abs(math.log(abs(factor)))
    return any(abs(apart - math.log(unit)) < _SAME_UNIT for unit in _UNITS)


def _reason(copy: Component, used: Component, factor: float | None) -> str:
    """Return why ``copy`` is left out for ``used``: a copy, the same recording, less corrected, or ``factor`` times as large."""
    same = copy.dt == used.dt and np.array_equal(copy.acceleration, used.acceleration)
    corrected = "" if _CORRECTED[used.processed] >= _CORRECTED[copy.processed] else "less corrected, "
    larger = "" if factor is None else f"{factor:.4g} times as large, "
    if corrected or larger:
        return f"the same recording, {corrected}{larger}as {used.source}"
    return f"{'a copy of' if same else 'the same recording as'} {used.source}"


def tell_use_of_originals(left_out: Iterable[LeftOut], motions: MotionSet) -> list[LeftOut]:
    """Return left-out files; to the reason of a copy is added whether ``motions`` uses its original, or refuses it."""
    used = {source for motion in motions for source in motion.sources}
    refused = {source for file in motions.unusable for source in file.sources}

    def fate(file: LeftOut) -> str:
        if file.of in used:
            return ", which is used; write use = true in motions.toml to use this one"
        return ", which is not used either, for another reason" if file.of in refused else ""

    return [replace(file, reason=file.reason + fate(file)) if file.of else file for file in left_out]


def _finding_on_copy(copy: Component, used: Component, factor: float | None, decided: bool) -> Finding | None:
    """Return a finding on a left-out ``copy`` times a ``factor``, gross unless ``decided``, or with another peak; else None."""
    if factor is not None:
        text = f"{copy.source}, left out, has the same samples times {factor:.4g}: check which of them is right"
        return Finding("factor", text, gross=not decided and abs(abs(factor) - 1.0) > _GROSS_FACTOR)
    ratio = copy.pga / max(used.pga, 1e-300)
    if 1.0 / _UNEQUAL <= ratio <= _UNEQUAL:
        return None
    return Finding("other peak", f"{copy.source}, the same recording, left out, has {ratio:.3g} times its peak")
