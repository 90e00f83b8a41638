"""Rocking spectra and overturning maps in a study file: [spectrum] and [[spectrum.map]]."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rockbatch.motions.suites.pulses import SHAPES
from rockbatch.pier import Base, Pier, problems
from rockbatch.quantities.design import BOUND
from rockbatch.study.cases import as_given, read_cases
from rockbatch.study.load import Study
from rockbatch.study.motions import PULSE
from rockbatch.study.piers import PierRead, has_mass
from rockbatch.study.spec import Case
from rockbatch.toml.kinds import Number, Whole, choice, number, positive, text
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import Clash, Key, Section, beside

Range = tuple[float, float]

SELF_SIMILAR, INTENSITY = "omega_g_over_p", "pga_over_g_tan_alpha"
"""Axes of a self-similar spectrum (Dimitrakopoulos & DeJong 2012): ω_g/p with ω_g = PGA/PGV of a record, and PGA/(g tan α)."""

AXES = ("two_pi_over_p_s", "p", "size_m", SELF_SIMILAR)
"""Quantities over which a spectrum may run: 2π/p [s], p [rad/s], R0 [m], or ω_g/p."""

LEAST_TOLERANCE = 1e-9
"""Least tolerance of a boundary, along either axis: shorter intervals would soon have no number between their ends."""


@dataclass(frozen=True)
class SpectrumSpec:
    """A rocking spectrum: every base of the study on piers of given slenderness and varied size."""

    axis: str  # one of :data:`AXES`
    # α slowest, then the value on the axis, then the bases. Piers of a self-similar spectrum are those of a record with ω_g = 1
    # rad/s.
    cases: tuple[Case, ...]
    # keys of ``Case.columns``: α, ``axis``, and the keys of bases that the study varies; of a self-similar spectrum
    # :data:`INTENSITY` too
    varied: tuple[str, ...]
    intensities: tuple[float, ...] = ()  # values of :data:`INTENSITY` of a self-similar spectrum


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
        """Return frequencies and amplitudes, evenly spaced, with both ends of their ranges."""
        return (
            np.linspace(*self.frequency, self.frequencies).tolist(),
            np.linspace(*self.amplitude, self.amplitudes).tolist(),
        )


_POINTS = Whole(2, "a whole number, 2 or above: the ends of the range are among them")
_WIDTH = Number(f"a number, {LEAST_TOLERANCE:g} or above", low=LEAST_TOLERANCE)
SPECTRUM = Section(
    ("spectrum",),
    (
        "Rocking spectra, by `rockbatch spectrum`: the greatest rotation over the size of the pier. "
        "One of the four ranges is given."
    ),
    {
        "alpha": Key(positive, "[0.10, 0.15, 0.20]", "Slendernesses [rad], a curve for each.", many=True),
        "two_pi_over_p_s": Key(positive, "[2, 16]", "Range of 2π/p.", pair=True),
        "p": Key(positive, "[0.4, 3]", "Range of p [rad/s].", pair=True),
        "size_m": Key(positive, "[1, 60]", "Range of the size R0.", pair=True),
        SELF_SIMILAR: Key(
            positive,
            "[1, 8]",
            "Range of ω_g/p, with ω_g = PGA/PGV of each record: under each record the pier has sizes of its own.",
            pair=True,
        ),
        INTENSITY: Key(
            positive,
            "[2, 4]",
            "PGA/(g tan α) to which every motion is scaled, with `omega_g_over_p`: a spectrum for each. 1 just lifts the pier.",
            many=True,
        ),
        "points": Key(_POINTS, "41", "Number of values along the range.", default=41),
        "spacing": Key(choice("linear", "log"), '"log"', "How the values are spaced.", default="linear"),
    },
    clashes=(
        beside(SELF_SIMILAR, INTENSITY, "[2, 4]"),
        Clash(
            (INTENSITY,),
            f"goes with {SELF_SIMILAR} = [1, 8]; write that as the range, or leave it out",
            lacking=(SELF_SIMILAR,),
            shown=True,
        ),
    ),
)
MAP = Section(
    ("spectrum", "map"),
    "A map of the pulses that overturn the pier, for every case. Write one for each.",
    {
        "name": Key(text, '"one-sine"', "Its name in the report.", required=True),
        "shape": Key(choice(*SHAPES), '"sine"', "Formula of the pulse.", required=True),
        "gamma": Key(
            Number("a number above 1", low=1.0, above=True),
            "1.5",
            "Number of oscillations of a Mavroeidis–Papageorgiou pulse.",
            required=True,
            only=PULSE["gamma"].only,
        ),
        "nu": Key(
            number, "0.0", "Phase of a Mavroeidis–Papageorgiou pulse [rad].", required=True, only=PULSE["nu"].only
        ),
        "frequency": Key(
            positive,
            "[1.0, 8.0]",
            "Range of ω_p/p, the circular frequency of the pulse over the pier's frequency parameter.",
            required=True,
            pair=True,
        ),
        "frequencies": Key(_POINTS, "29", "Number of frequencies in the grid."),
        "amplitude": Key(
            positive,
            "[1.0, 12.0]",
            "Range of a_p/(g tan α); 1 just lifts the pier off rigid ground.",
            required=True,
            pair=True,
        ),
        "amplitudes": Key(_POINTS, "45", "Number of amplitudes in the grid."),
        "tolerance": Key(_WIDTH, "1e-3", "Width of a_p/(g tan α) within which every boundary is found."),
        "width": Key(_WIDTH, "0.02", "Width of ω_p/p within which it is found where regions begin or end."),
    },
    many=True,
    homes=(MapSpec,),
)

SECTIONS = (SPECTRUM, MAP)
"""Its tables in a study file."""


def read_spectrum(study: Study) -> tuple[SpectrumSpec | None, tuple[MapSpec, ...]]:
    """Return the spectrum of a study file, None if [spectrum] has maps alone, and the maps.

    Raises ``InputError`` with every mistake in [spectrum], or if there is none.
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
    axes_written = [name for name in AXES if table.has(name)]
    if len(axes_written) != 1:
        examples = " or ".join(f"{name} = {SPECTRUM[name].example}" for name in AXES)
        table.complain(f"it runs over one range; write {examples}", *axes_written[1:2])
        return None
    (axis,) = axes_written
    if not read.keys() >= {"alpha", axis}:
        return None
    space = np.geomspace if read.get("spacing") == "log" else np.linspace
    low, high = read[axis]
    values = space(low, high, read.get("points", SPECTRUM["points"].default)).tolist()
    piers = _piers(table, read["alpha"], axis, values, study)
    problems_before = len(table.file.problems)
    expanded, varied, _ = read_cases(table.file, piers)
    larger = (
        read_cases(
            table.file,
            [
                read._replace(pier=replace(read.pier, p=0.5 * read.pier.p, confirm=(*read.pier.confirm, "p")))
                for read in piers
            ],
        ).cases
        if axis == SELF_SIMILAR
        else []
    )
    del table.file.problems[problems_before:]  # said below, with the slenderness to which it applies
    _without_size(
        table,
        study,
        {case.name: case.base for case, large in zip(expanded, larger, strict=False) if case.base != large.base},
    )
    reported = set()
    written = {case.data.get("name"): case.data for case in table.file.tables("case", title="name")}
    for case in sorted(expanded, key=lambda case: -case.pier.p):  # at the greatest p a stiffness in kN/m lacks most
        alpha = case.pier.alpha
        for problem in problems(case.pier, case.base):
            if (alpha, case.name) not in reported:
                reported.add((alpha, case.name))
                given = as_given({**written.get(case.name, {}), **case.columns}, problem, case.pier, case.base)
                table.complain(f'alpha = {alpha:g}, case "{case.name}": {given}', "alpha")
    apart = [name for name in ("mu", "mass_t") if len({values.get(name) for _, values, _ in piers}) > 1]
    intensities = read.get(INTENSITY, ()) if axis == SELF_SIMILAR else ()
    of_axis = (INTENSITY, axis) if intensities else (axis,)
    varied = ("alpha", *apart, *of_axis, *(name for name in varied if name not in apart))
    return SpectrumSpec(axis, tuple(case.with_columns(varied) for case in expanded), varied, intensities)


def _without_size(table: Table, study: Study, bases: Mapping[str, Base]) -> None:
    """Complain about ``bases``, by case, that depend on the pier's size, and about scales, in a self-similar spectrum."""
    if not table.has(SELF_SIMILAR):
        return
    for name, base in bases.items():
        remedy = (
            "its points are in mm and kN of one size; leave the case out"
            if base.has_points
            else "give its ratios: beta, eta, nu instead of stiffness_kN_m, yield_kN, coefficient_kN_s_m"
        )
        table.complain(
            f'{SELF_SIMILAR}: the pier has another size under each record, and case "{name}" has another base for each size; '
            f"{remedy}",
            SELF_SIMILAR,
        )
    if study.motions.scale != (1.0,):
        table.complain(
            f"{SELF_SIMILAR}: every motion is scaled to {INTENSITY}, so scale in [motions] has no effect; leave it out",
            SELF_SIMILAR,
        )


def _piers(table: Table, alphas: Sequence[float], axis: str, values: list[float], study: Study) -> list[PierRead]:
    """Return piers of every slenderness and size, else as the study's nominal ones without deck and parts; with values by key.

    A mass that is written in a case alone is left out, as the case adds it. A size that is impossible becomes a problem of the
    file, and ends those of its slenderness.
    """
    nominal = [case.pier for case in study.cases if not case.columns.get(BOUND)]  # of which the rocking spectrum is
    weighed = has_mass(table.file)
    templates = dict.fromkeys(_template(pier, pier.mass_t if weighed else None) for pier in nominal)
    piers: list[PierRead] = []
    for n, alpha in enumerate(alphas):
        for template in templates:
            mass = {} if template.mass_t is None else {"mass_t": template.mass_t}
            with table.noting("alpha", n):
                for value in values:
                    p = _p(axis, alpha, value, template)
                    values_of_pier: dict[str, float | str] = {"alpha": alpha, "mu": template.mu, axis: value, **mass}
                    pier = replace(template, alpha=alpha, p=p, confirm=("p", "mass_t"))
                    piers.append(PierRead(pier, values_of_pier))
    return piers


def _template(pier: Pier, mass_t: float | None) -> Pier:
    """Return the pier without deck and parts, of which slenderness and size are still to be set."""
    return replace(pier, alpha=1.0, p=1.0, top_m=None, deck_height_m=None, parts=None, mass_t=mass_t)


def _p(axis: str, alpha: float, value: float, pier: Pier) -> float:
    """Return p [rad/s] at a value on the axis, of a pier with all else as ``pier``; of a self-similar one for ω_g = 1 rad/s."""
    if axis == "size_m":
        return Pier.from_size(alpha, value, pier.mu, pier.gravity, confirm=("size_m",)).p
    return {"p": value, "two_pi_over_p_s": 2 * math.pi / value, SELF_SIMILAR: 1.0 / value}[axis]


def _maps(file: TomlFile) -> list[MapSpec]:
    maps: list[MapSpec] = []
    names: set[str] = set()
    for table in file.tables("spectrum", "map", title="name"):
        problems_before = len(file.problems)
        read = table.read(MAP)
        if read.get("name") in names:
            table.complain(f'name = "{read["name"]}": given twice; give each map its own name', "name")
        names.add(read.get("name", ""))
        if file.is_sound_since(problems_before):
            maps.append(MapSpec(**read))
    return maps
