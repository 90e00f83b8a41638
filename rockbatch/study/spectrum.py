"""Rocking spectra and overturning maps in a study file: [spectrum] and [[spectrum.map]]."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rockbatch.motions.pulses import SHAPES
from rockbatch.pier import Pier, problems
from rockbatch.study.cases import read_cases
from rockbatch.study.load import Study
from rockbatch.study.motions import PULSE
from rockbatch.study.piers import has_mass
from rockbatch.study.spec import Case
from rockbatch.toml.kinds import Number, Whole, choice, number, positive, text
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import Key, Section

Range = tuple[float, float]

AXES = ("two_pi_over_p_s", "p", "size_m")
"""Quantities over which a spectrum may run: 2π/p [s], p [rad/s], or R0 [m]."""

LEAST_TOLERANCE = 1e-9
"""Of a boundary, along either axis; halves of intervals that are shorter would soon be no numbers between their ends."""


@dataclass(frozen=True)
class SpectrumSpec:
    """A rocking spectrum: every base of the study on piers of given slenderness and varied size.

    Attributes
    ----------
    axis : str
        One of :data:`AXES`.
    cases : tuple of Case
        α slowest, then the value on the axis, then the bases.
    varied : tuple of str
        Keys of ``Case.columns``: α, ``axis``, and the keys of bases that the study varies.
    """

    axis: str
    cases: tuple[Case, ...]
    varied: tuple[str, ...]


@dataclass(frozen=True)
class MapSpec:
    """[[spectrum.map]]: amplitudes a_p/(g tan α) over frequencies ω_p/p of one pulse, for every case of the study.

    :data:`MAP` says what each key means.
    """

    name: str
    shape: str
    frequency: Range
    amplitude: Range
    frequencies: int = 29
    amplitudes: int = 45
    tolerance: float = 1e-3
    width: float = 0.02
    gamma: float | None = None
    nu: float | None = None

    @property
    def grid(self) -> tuple[list[float], list[float]]:
        """Frequencies and amplitudes, evenly spaced."""
        return (
            np.linspace(*self.frequency, self.frequencies).tolist(),
            np.linspace(*self.amplitude, self.amplitudes).tolist(),
        )


_POINTS = Whole(2, "a whole number, 2 or above: the ends of the range are among them")
_WIDTH = Number(f"a number, {LEAST_TOLERANCE:g} or above", low=LEAST_TOLERANCE)
SPECTRUM = Section(("spectrum",), (
    "Rocking spectra, by `rockbatch spectrum`: the greatest rotation over the size of the pier. "
    "One of the three ranges is given."
), {
    "alpha": Key(positive, "[0.10, 0.15, 0.20]", "Slendernesses [rad], a curve for each.", many=True),
    "two_pi_over_p_s": Key(positive, "[2, 16]", "Range of 2π/p.", pair=True),
    "p": Key(positive, "[0.4, 3]", "Range of p [rad/s].", pair=True),
    "size_m": Key(positive, "[1, 60]", "Range of the size R0.", pair=True),
    "points": Key(_POINTS, "41", "Number of values along the range.", default=41),
    "spacing": Key(choice("linear", "log"), '"log"', "How the values are spaced.", default="linear"),
})  # fmt: skip
MAP = Section(("spectrum", "map"), "A map of the pulses that overturn the pier, for every case. Write as many as are wanted.", {
    "name": Key(text, '"one-sine"', "Its name in the report.", required=True),
    "shape": Key(choice(*SHAPES), '"sine"', "Formula of the pulse.", required=True),
    "gamma": Key(Number("a number above 1", low=1.0, above=True), "1.5",
        "Number of oscillations of a Mavroeidis–Papageorgiou pulse.", required=True,
        only=PULSE["gamma"].only),
    "nu": Key(number, "0.0", "Phase of a Mavroeidis–Papageorgiou pulse [rad].", required=True, only=PULSE["nu"].only),
    "frequency": Key(positive, "[1.0, 8.0]",
        "Range of ω_p/p, the circular frequency of the pulse over the pier's frequency parameter.", required=True, pair=True),
    "frequencies": Key(_POINTS, "29", "Number of frequencies in the grid."),
    "amplitude": Key(positive, "[1.0, 12.0]",
        "Range of a_p/(g tan α); 1 just lifts the pier off rigid ground.", required=True, pair=True),
    "amplitudes": Key(_POINTS, "45", "Number of amplitudes in the grid."),
    "tolerance": Key(_WIDTH, "1e-3", "Width of a_p/(g tan α) within which every boundary is found."),
    "width": Key(_WIDTH, "0.02", "Width of ω_p/p within which it is found where regions begin or end."),
}, many=True, homes=(MapSpec,))  # fmt: skip


def read_spectrum(study: Study) -> tuple[SpectrumSpec | None, tuple[MapSpec, ...]]:
    """Return the spectrum and the maps that a study file asks for.

    Raises
    ------
    InputError
        With every mistake in [spectrum], or because there is none.
    """
    file = study.file()
    table = file.table(
        "spectrum", required="[spectrum] with alpha = [0.10, 0.15] and two_pi_over_p_s = [2, 16], or a [[spectrum.map]]"
    )
    spectrum, maps = None, []
    if table is not None:
        if table.data.keys() - {"map"} or "map" not in table.data:
            spectrum = _spectrum(table, study)
        maps = _maps(file)
    file.finish()
    return spectrum, tuple(maps)


def _spectrum(table: Table, study: Study) -> SpectrumSpec | None:
    read = table.read(SPECTRUM, other=["map"])
    if not table.has("alpha"):
        table.complain(f"alpha is missing; write for example alpha = {SPECTRUM['alpha'].example}")
    given = [name for name in AXES if table.has(name)]
    if len(given) != 1:
        ways = " or ".join(f"{name} = {SPECTRUM[name].example}" for name in AXES)
        table.complain(f"it runs over one range; write {ways}", *given[1:2])
        return None
    (axis,) = given
    if not read.keys() >= {"alpha", axis}:
        return None
    space = np.geomspace if read.get("spacing") == "log" else np.linspace
    low, high = read[axis]
    values = space(low, high, read.get("points", SPECTRUM["points"].default)).tolist()
    piers = _piers(table, read["alpha"], axis, values, study)
    before = len(table.file.problems)
    expanded, varied = read_cases(table.file, piers)
    del table.file.problems[before:]  # said below, with the slenderness to which it applies
    reported = set()
    for case in expanded:
        alpha = case.pier.alpha
        for problem in problems(case.pier, case.base):
            if (alpha, case.name) not in reported:
                reported.add((alpha, case.name))
                table.complain(f'alpha = {alpha:g}, case "{case.name}": {problem}', "alpha")
    apart = [name for name in ("mu", "mass_t") if len({values.get(name) for _, values in piers}) > 1]
    varied = ("alpha", *apart, axis, *(name for name in varied if name not in apart))
    return SpectrumSpec(axis, tuple(case.case(varied) for case in expanded), varied)


def _piers(
    table: Table, alphas: Sequence[float], axis: str, values: list[float], study: Study
) -> list[tuple[Pier, dict[str, Any]]]:
    """Return piers of every slenderness and size, with all else of the study's, and their values by key.

    A mass that only a case says is no pier's: the case brings it itself.
    """
    weighed = has_mass(table.file)
    others = dict.fromkeys(
        replace(
            case.pier, alpha=1.0, p=1.0, top_m=None, deck_height_m=None, mass_t=case.pier.mass_t if weighed else None
        )
        for case in study.cases
    )
    piers = []
    for n, alpha in enumerate(alphas):
        for other in others:
            mass = {} if other.mass_t is None else {"mass_t": other.mass_t}
            with table.noting("alpha", n):
                for value in values:
                    if axis == "size_m":
                        p = Pier.from_size(alpha, value, other.mu, other.gravity).p
                    else:
                        p = value if axis == "p" else 2 * math.pi / value
                    own = {"alpha": alpha, "mu": other.mu, axis: value} | mass
                    piers.append((replace(other, alpha=alpha, p=p), own))
    return piers


def _maps(file: TomlFile) -> list[MapSpec]:
    maps: list[MapSpec] = []
    names: set[str] = set()
    for table in file.tables("spectrum", "map", title="name"):
        before = len(file.problems)
        read = table.read(MAP)
        if read.get("name") in names:
            table.complain(f'name = "{read["name"]}": given twice; give each map its own name', "name")
        names.add(read.get("name", ""))
        if file.is_sound_since(before):
            maps.append(MapSpec(**read))
    return maps
