"""Pages state the limits that the program has: each sentence here is on its page with the values of the constants in braces."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

import pytest

TOP = Path(__file__).parents[2]
WORDS = {
    0.1: "tenth", 0.25: "quarter", 1.0 / 3.0: "third", 0.5: "half", 2: "two", 3: "three", 4: "four", 5: "five", 6: "six",
    7: "seven", 10: "ten", 100: "hundred",
}  # fmt: skip


def power(value: float) -> str:
    """Return "10⁻⁸" or "3·10⁻⁸"."""
    digits, exponent = f"{value:e}".split("e")
    of_ten = "10" + str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return of_ten if float(digits) == 1.0 else f"{float(digits):g}·{of_ten}"


FORMS: dict[str, Callable[[float], str]] = {
    "": lambda value: f"{value:g}".replace("e-0", "e-"), "%": lambda value: f"{100.0 * value:g} %", "power": power,
    "word": WORDS.__getitem__, "one in": lambda value: f"1/{1.0 / value:g}", "one over": lambda value: f"1/{value:g}",
    "million": lambda value: f"{value / 1e6:g} million", "thousands": lambda value: f"{value:,}",
    "MiB": lambda value: f"{value / 2**20:g} MiB", "GiB": lambda value: f"{value / 2**30:g} GiB",
}  # fmt: skip
"""How pages write a number."""


class Stated(NamedTuple):
    """A number as pages write it, by what stands in its braces."""

    value: float

    def __format__(self, form: str) -> str:
        return FORMS[form](self.value)


class Constants(dict[str, object]):
    """The numbers of a module by their names, and those of its tuples by name and place."""

    def __init__(self, module: str) -> None:
        for name, value in vars(import_module(f"rockbatch.{module}")).items():
            self[name] = [*map(Stated, value)] if isinstance(value, tuple) and name.isupper() else Stated(value)


STATED: dict[str, dict[str, tuple[str, ...]]] = {
    "motions/README.md": {
        "motions.sources.archives": (
            "archives above {LARGEST:MiB}, {_MOST_FILES} files or {_MOST_UNPACKED:GiB} unpacked",
            "files that unpack to more than {_NEVER_TOO_LARGE:MiB} and {_GROWTH} times their size",
            "a file may have {LARGEST:MiB}",
        ),
        "motions.limits": (
            "a component a sampling interval of {SHORTEST_STEP} to {LONGEST_STEP} s and {MOST_SAMPLES:million} samples",
            "A step has to agree with a time column within {SAME_STEP:%}",
            "A vertical with a step that differs by more than a factor of {MOST_STEPS} is not used",
        ),
        "motions.sources.stationxml": (
            "the product of the stages' gains from the sensitivity by more than {_SAME_STAGES:%}, the record waits",
            "a StationXML {LARGEST:MiB}",
        ),
        "motions.formats.miniseed": (
            "a MiniSEED file {_MOST_PIECES} pieces of channels",
            "separated by more than a minute and {_APART:word} times the longer one, are two records",
        ),
        "motions.identity.common_span": ("Starts within a {_SIMULTANEOUS:word} of the finer step are treated as simultaneous",),
        "motions.labels.orientation": ("perpendicular within {SAME_AZIMUTH}°",),
        "motions.intensity.measures": (
            "(a constant velocity reduces its peak to less than 1/{_STRAIGHT}), PGD is left empty",
            "above {_STRAIGHT} times the residual from a straight line",
        ),
        "motions.identity.likeness": (
            "they correlate by {_ALIKE} or more once resampled and aligned",
            "they are one if they correlate by {_CERTAIN} or more, and significantly so",
        ),
        "motions.quality.plausible": (
            "outside {LOWEST}–{HIGHEST} g; above {STRONG} g under a header of g | gross outside {LOWEST}–{HIGHEST} g |",
            "above {ALTERNATION:%} of the PGA | gross |",
            "above {FARTHEST} m | gross if corrected, or above {ABSURD} m |",
            "mean above {FARTHEST_MEAN:%} of the peak | gross |",
            "{_LONG_TOP} in a row, or 5 in several | gross |",
            "above {UNEQUAL}, in PGA | gross above {FAINT}, and for noise |",
            "above {SELDOM_ABOVE}, below {SELDOM_BELOW:one in}, in PGA | gross above {UNEQUAL}, below {FAINT:one over} |",
        ),
        "motions.quality.faults": (
            "a gap was filled | {FILLED} s | gross |",
            "less than {SPIKE:word} of it remains | {SPIKE:%} | gross |",
            "at the first sample, or in the last {_LAST:word} second | {BEGINS:%}, {ENDS:%} of the PGA | |",
        ),
        "motions.alignment": ("perhaps reversed, scaled or delayed | correlation {_COPIED} | |",),
        "motions.identity.colocated": (
            "under an azimuth at a right angle | correlation {_ALIKE} | gross |",
            "{_FACTOR} times or negative, correlation {_ALIKE} | gross |",
        ),
        "motions.quality.places": ("with a depth above {_LEAST_DEPTH} m in its place",),
        "motions.identity.doubles": (
            "has the same samples times a factor | {_GROSS_FACTOR:%} | gross if undecided |",
            "another peak | {_UNEQUAL} times | |",
        ),
        "toml.reader": (
            "A manifest may have {LARGEST:MiB}",
            "Up to a {MOST_REPORTED:word} mistakes are reported together",
        ),
    },
    "docs/columns.md": {
        "outcome.changes": ("relative to {FLOOR:%} of the scale of small ones",),
        "outcome.outcome": ("least_normal_share of the weight, {LEAST_NORMAL_SHARE} unless given",),
        "simulation.coarser": (
            "{UNEVEN} times its change by twice the step, and by half as many strips, and {MISSED:%} of it",
            "{UNEVEN} times the change by half as many, {EXTREMES} times that of any extreme before",
        ),
        "simulation.steps": ("had stopped rocking, or {PATIENCE}/p had passed",),
        "simulation.error_control": ("among the force columns: {CHANCE:word} times the change when the step was halved",),
        "observers.interaction.envelopes": ("change its reach by less than {FLATNESS:power} are left out",),
    },
    "docs/pages/questions/risk.md": {
        "analyses.fragility.bounds": (
            "With fewer than {STATIONS_OF_INTERVAL:word} stations there is no interval",
            "with fewer than {STATIONS_OF_CURVE:word} no curve",
        ),
        "analyses.fragility.quantities": ("With fewer than {FEW:word}, a remark says that the curve is extrapolated",),
        "analyses.fragility.uncertain": ("At most {MOST_IMPOSSIBLE:%} of the draws may be impossible",),
    },
    "docs/pages/questions/spectra.md": {
        "motions.suites.scaling": ("A record that needs a factor above {MOST_FACTOR:word} is not used until",),
        "motions.suites.design_spectra": ("has Z R of {MOST_ZR} at most",),
        "motions.suites.spectrum_target": ("at a {_A_DECADE:word} periods a decade",),
    },
    "docs/pages/questions/foundation.md": {
        "pier.bases": ("neglects more than {MOST_NEGLECTED:%} of inertia and righting moment",),
        "pier.supports": ("a static deflection of less than {LEAST_DEFLECTION_MM} mm is rejected until it is confirmed",),
    },
    "docs/pages/questions/flight.md": {"pier.traits": ("`flight_limit_mm` (default {FLIGHT_LIMIT_MM} mm)",)},
    "docs/pages/questions/footing.md": {"checks.omissions": ("a lower bound above a safety factor of {SHAKES_DOWN}",)},
    "docs/pages/statics.md": {"pier.statics": ("at {COMPARED} α, a typical", "Above a {MOST_FLEXURE:word}, bending adds")},
    "docs/pages/lanes.md": {"simulation.recording": ("as many as fit into {ROWS_TOGETHER:thousands} rows",)},
    "docs/pages/worked_design.md": {"quantities.statistics": ("With fewer than {MEAN_FROM:word} motions the most unfavourable",)},
    "THEORY.md": {
        "analyses.fragility.cloud": ("quantiles over {DRAWS:thousands} draws",),
        "analyses.fragility.study": ("steps of {HUNT_STEP:%} (`hunt_step`)", "within ±{WINDOW:%} of each level (`window`"),
        "analyses.fragility.windows": ("also run at {SAMPLES} scales",),
        "analyses.spectrum.overturning_map": ("The pulse has {SAMPLES} samples a period",),
        "checks.bounds": ("Checks use its result with a factor of {SCATTER}",),
        "motions.intensity.velocity_pulses": (
            "pseudo-period {_PSEUDO_PERIOD} scales), {PERIODS_OF_PULSES[0]} to {PERIODS_OF_PULSES[1]} s",
            "The pulse is the sum of {_WAVELETS:word} wavelets of that period",
            "each the largest in the residual within {_NEAR} scales",
            "above {PULSE_LIKE} pulse-like, if PGV ≥ {LEAST_PGV} m/s",
        ),
        "quantities.statistics": ("Those of 16 and 84 % are of {FRACTILES_FROM:word} motions or more",),
        "motions.suites.hazard": ("in every {STEP:%} of x", "of an exponent up to {STEEPEST}"),
        "motions.suites.scaling": ("Records with a factor above {MOST_FACTOR} are removed",),
        "observers.forces.peaks": ("above {LARGE_ERROR:%} a `note` names the quantity that has not converged",),
        "observers.shocks.effects": ("of the extremes of θ in the last {LAST_PART:word} of the pause",),
        "outcome.outcome": ("(`[output] least_normal_share`, {LEAST_NORMAL_SHARE})",),
        "pier.bending": ("follows up to {MOST_MODES:word} modes",),
        "pier.footing_base": ("N strips, {STRIPS} unless given",),
        "simulation.agreement": (
            "has to overturn within {SAME_TIME}/p of the same time, with the same earlier rotations to {SAME_FALL} α",
            "stay below the peak by {FAR_BELOW:word} times their change",
        ),
        "simulation.chaos": (
            "count only if {RISES} times their change brings them to it, or to {FALLS} α",
            "did not reduce the difference by a factor of {NEARER}",
            "of its unstable equilibrium for longer than {SWIFT}/p",
        ),
        "simulation.coarser": ("no less than {EXTREMES} times the change of the greatest",),
        "simulation.error_control": (
            "at least {ROUNDING:power}, the rounding error, or {ROUGH:power} with a viscous damper",
            "not converged after {HALVINGS} halvings",
            "counts {CHANCE:word} times as well",
        ),
        "simulation.relaxation": ("for {FURTHER}/p, with friction dampers for {FURTHER_WITH_FRICTION}/p",),
        "simulation.runs": ("would need more than {MOST_STEPS:power} steps",),
        "simulation.steps": (
            "satisfies ω dt/k ≤ {FREQUENCY_STEP}",
            "with ω dt/k > {STABLE_STEP} it is rejected",
            "the run continues for {PATIENCE}/p after the record",
            "at least {READ_AFTER:word} periods 2π/ω_v after the record",
        ),
    },
}  # fmt: skip


@pytest.mark.parametrize(("page", "module"), [(page, module) for page, of in STATED.items() for module in of])
def test_a_page_states_a_limit_as_it_is(page, module):
    text = " ".join((TOP / page).read_text(encoding="utf-8").split())
    constants = Constants(module)
    wrong = [said for template in STATED[page][module] if (said := template.format_map(constants)) not in text]
    assert not wrong
