"""The columns of peaks.csv: each is one row of a table here, from which its descriptions follow.

The file, its types and units, the report's tables and tooltips, the comparison of two studies and docs/columns.md follow from
:data:`COLUMNS`. A new column is a row at the end of :data:`MORE`, and a number in :class:`Outcome` for it.
"""

from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from operator import attrgetter
from typing import Any, Literal, NamedTuple

from rockbatch.common.lazy import pd
from rockbatch.motions import Motion, MotionSet
from rockbatch.pier import Pier
from rockbatch.quantities.demands import DEVICES_ERROR, IN_MOTION, IN_MOTION_ERROR, MIRROR_OF, OTHER_LAW, ROCKING
from rockbatch.simulation.outcome import TERMS, Outcome
from rockbatch.study import Case, Study

PEAKS = "peaks.csv"
PART = f"{PEAKS}.part"
"""Finished runs of a table that is under way."""

STATUSES = ("ok", "overturned", "flight", "failed")

ALL = ("rigid", "elastic", "yielding")
SPRINGS = ("elastic", "yielding")
YIELDING = ("yielding",)
TILTS = (*SPRINGS, "held")
"""Bases on which a pier may rest at a tilt: springs, or any base if friction or hysteretic dampers hold it."""


_BASES_IN_WORDS = {
    ALL: "", SPRINGS: "springs", YIELDING: "yielding springs", TILTS: "springs, or dampers that hold the pier at a tilt",
}  # fmt: skip


class OnPage(NamedTuple):
    """A column in the report: its head with the unit there, its format, and the factor from the file's unit to the page's.

    The page makes an index of a word after a low line: "θ_max/α". ``behind`` names the column after which it is put, if
    that is not the one before it in the file. ``table`` is the section in whose tables it is.
    """

    head: str
    form: str = ".10g"
    factor: int = 1
    behind: str = ""
    table: Literal["peaks", "forces"] = "peaks"


class Ran(NamedTuple):
    """A finished run: its outcome, its case, and its motion as it was run.

    ``mirror_of`` is the polarity of the run whose mirror image it is; None if the study has one polarity.
    """

    outcome: Outcome
    motion: Motion
    polarity: str
    scale: float
    case: Case
    mirror_of: str | None = None

    @property
    def pier(self) -> Pier:
        """The pier of its case."""
        return self.case.pier


class OfSuite(NamedTuple):
    """Heading of the statistics of a column over a suite, and the format of its numbers there."""

    heading: str
    form: str


@dataclass(frozen=True)
class Column:
    """A column of peaks.csv.

    Attributes
    ----------
    name : str
        With its unit, if any; fixed, since users' scripts read it.
    meaning : str
        Its meaning, in a sentence; the same for columns that are explained together.
    source : str, function or None
        Field of :class:`Outcome`, or function of :class:`Ran`; None for names of the run.
    unit : str
        Of a number, as pint reads it; "1" is none.
    page : OnPage or None
        Its place in the report; None: it has none.
    kind : str
        "number", "count" (a whole one) or "text".
    over_alpha : bool
        True if the outcome's angle is divided by the pier's α.
    bases : tuple of str
        Bases to which it applies; it is empty on others.
    stood : bool
        True if it is empty for a pier that overturned, and a run that flight ended.
    unbounded : bool
        True if a number may be infinite.
    sometimes : bool
        True if only some of the runs to which it applies have one: a flight, a reason.
    suite : OfSuite or None
        Its statistics, if it has any; two studies are compared by it, too.
    requested : function or None
        True for a study that asks for it; None: it is always there.
    """

    name: str
    meaning: str
    source: str | Callable[[Ran], Any] | None = None
    unit: str = "1"
    page: OnPage | None = None
    kind: Literal["number", "count", "text"] = "number"
    over_alpha: bool = False
    bases: tuple[str, ...] = ALL
    stood: bool = False
    unbounded: bool = False
    sometimes: bool = False
    suite: OfSuite | None = None
    requested: Callable[[Study], bool] | None = None

    @property
    def applies(self) -> str:
        """Runs to which it applies, in words; empty for all."""
        base = _BASES_IN_WORDS[self.bases]
        run = "where the pier stood" if self.stood else "if it occurs" if self.sometimes else ""
        return ", ".join(filter(None, (base, run)))


def _energy(term: str) -> Column:
    def value(ran: Ran) -> float | None:
        return None if ran.outcome.energies is None else ran.outcome.energies[term]

    return Column(
        f"energy_{term}_J_kg",
        "energy ledger at the end, per unit mass, and the greatest remainder on the way; with [output] ledger = true",
        value,
        "J/kg",
        OnPage(f"{term.replace('_', '-')} [J/kg]", ".0e" if term == "remainder" else ".4f"),
        requested=lambda study: study.output.ledger,
    )


def _force(
    name: str, meaning: str, field: str, unit: str, head: str, form: str, factor: int = 1, *, per: str = "",
    behind: str = "", **more: Any,
) -> Column:  # fmt: skip
    """Return a column of a ``field`` of PeakForces; ``per`` "g", or times the "mass" or "half the weight" if known."""

    def greatest(ran: Ran) -> float | None:
        value = None if ran.outcome.forces is None else getattr(ran.outcome.forces, field)
        times = {"g": 1.0 / ran.pier.gravity, "mass": ran.pier.mass_t, "half the weight": _half_weight(ran.pier)}
        factor = times.get(per, 1.0)
        return None if value is None or factor is None else value * factor

    page = OnPage(head, form, factor, behind, table="forces")
    if per in ("mass", "half the weight"):
        more["sometimes"] = True
    meaning = f"{meaning}; with [output] forces = true"
    return Column(name, meaning, greatest, unit, page, requested=lambda study: study.output.forces, **more)


def _half_weight(pier: Pier) -> float | None:
    return None if pier.mass_t is None else 0.5 * pier.mass_t * pier.gravity


STAYING = (
    Column("record", "ground motion: its file's name, or its channel's", kind="text", page=OnPage("record")),
    Column("case", "foundation, as the study calls it", kind="text", page=OnPage("case")),
    Column(
        "polarity", "+ as recorded, - horizontal component reversed", kind="text", page=OnPage("polarity")
    ),
    Column("scale", "factor on all components", page=OnPage("scale")),
    Column(
        "status",
        "ok, overturned, flight (both pivots left the ground and the run ended there: see reason) or failed (see reason)",
        "status", kind="text", page=OnPage("status"),
    ),
    Column(
        "theta_max_over_alpha", "greatest rotation over α; the run goes on until nothing later can exceed it",
        "theta_max", page=OnPage("θ_max/α", ".5f"), over_alpha=True, suite=OfSuite("Largest rotation θ_max/α", ".4f"),
    ),
    Column(
        "theta_max_error",
        "estimated error of the greatest rotation over α: what halving the step, or a motion 10⁻⁸ stronger or weaker, still "
        "changed; empty where it is chaotic, and with a fixed step",
        "theta_max_error", page=OnPage("±", ".0e"), over_alpha=True, stood=True,
    ),
    Column("t_max_s", "time of the greatest rotation", "t_max", "s", OnPage("at t [s]", ".2f")),
    Column(
        "theta_res_over_alpha", "residual rotation over α, at rest on the deformed base", "theta_res",
        page=OnPage("θ_res/α", ".5f"), over_alpha=True, bases=TILTS, stood=True,
        suite=OfSuite("Residual rotation |θ_res|/α", ".5f"),
    ),
    Column(
        "settlement_m", "mean settlement of the supports since the start", "settlement", "m",
        OnPage("settlement [mm]", ".2f", 1000), bases=SPRINGS, stood=True, suite=OfSuite("Settlement [mm]", ".2f"),
    ),
    Column("impacts", "number of impacts", "impacts", kind="count", page=OnPage("impacts", ".0f")),
    Column("separations", "number of separations", "separations", kind="count", page=OnPage("separations", ".0f")),
    Column(
        "flight_s", "first time with both pivots off the ground, also where the run went on", "t_flight",
        "s", OnPage("flight [s]", ".3f"), sometimes=True,
    ),
    Column("substeps", "integration steps per sample", "substeps", kind="count", page=OnPage("substeps", ".0f")),
)  # fmt: skip
"""Columns that every table has, in its order; then come those of the keys that the study varies."""

_DUCTILITY = "greatest deflection of each support over its yield deflection"
_DISSIPATED = "plastic work of each support, per unit mass"

MORE = (
    Column(
        "theta_res_error",
        "estimated error of the residual rotation over α, including its drift while it was read; empty where it is chaotic, "
        "and with a fixed step",
        "theta_res_error", page=OnPage("±", ".0e", behind="theta_res_over_alpha"), over_alpha=True, bases=TILTS,
        stood=True,
    ),
    Column("t_end_s", "when the analysis ended", "t_end", "s", OnPage("end [s]", ".2f", behind="flight_s")),
    Column(
        "base_tilt_rad", "residual tilt of the base", "base_tilt", "rad",
        OnPage("base tilt [mrad]", ".3f", 1000, "theta_res_error"), bases=SPRINGS, stood=True,
    ),
    Column(
        "ductility_left", _DUCTILITY, "ductility_left", page=OnPage("demand L", ".2f", behind="flight_s"),
        bases=YIELDING,
    ),
    Column(
        "ductility_right", _DUCTILITY, "ductility_right", page=OnPage("demand R", ".2f", behind="ductility_left"),
        bases=YIELDING,
    ),
    Column(
        "dissipated_left_J_kg", _DISSIPATED, "dissipated_left", "J/kg",
        OnPage("dissipated L [J/kg]", ".4f", behind="ductility_right"), bases=YIELDING,
    ),
    Column(
        "dissipated_right_J_kg", _DISSIPATED, "dissipated_right", "J/kg",
        OnPage("dissipated R [J/kg]", ".4f", behind="dissipated_left_J_kg"), bases=YIELDING,
    ),
    Column(
        "residual_s",
        "when residual rotation, tilt and settlement were read: the pier had stopped stepping, or 40/p were over",
        "t_read", "s", OnPage("read at [s]", ".2f", behind="settlement_m"), bases=YIELDING, stood=True,
    ),
    Column(
        "theta_res_drift_per_s",
        "how fast the residual rotation over α went on changing when it was read: undamped vibration goes on",
        "theta_res_drift", "1/s", OnPage("drift [1/s]", ".1e", behind="settlement_m"), over_alpha=True, bases=YIELDING,
        stood=True,
    ),
    Column(
        "settlement_drift_m_s", "how fast the settlement went on changing when it was read", "settlement_drift", "m/s",
        OnPage("drift [mm/s]", ".3f", 1000, "settlement_m"), bases=YIELDING, stood=True,
    ),
    Column(
        "reason", "why a run failed, or what made the pier fly", "reason", kind="text", page=OnPage("reason"),
        sometimes=True,
    ),
    Column(
        "note", "remarks on a valid run, such as counts that did not converge", "note",
        kind="text", page=OnPage("note"), sometimes=True,
    ),
    Column(
        "station",
        "what the components of one station in one earthquake share, which checks count as one record; a pulse is its own",
        kind="text", page=OnPage("station"),
    ),
    Column(
        "top_drift_m", "greatest drift of the top: the height at which it is read, times the greatest rotation",
        lambda ran: ran.pier.top * ran.outcome.theta_max, "m", OnPage("top drift [mm]", ".1f", 1000, "t_max_s"),
    ),
    Column(
        "heel_uplift_m", "greatest rise of the heel above the toe: the width between the pivots, times the greatest rotation",
        lambda ran: 2.0 * ran.pier.half_width * ran.outcome.theta_max, "m",
        OnPage("heel uplift [mm]", ".1f", 1000, "top_drift_m"),
    ),
    Column(
        "pga_g", "peak horizontal ground acceleration of the motion as it was run, over g",
        lambda ran: ran.motion.pga / ran.pier.gravity, "standard_gravity", OnPage("PGA [g]", ".3f", behind="heel_uplift_m"),
    ),
    Column(
        "flights", "how often both pivots left the ground at one time; a flight that ended the run counts", "flights",
        kind="count", page=OnPage("flights", ".0f", behind="flight_s"),
    ),
    Column(
        "flight_duration_s", "time with both pivots in the air, in all flights together that were followed",
        lambda ran: ran.outcome.flight_duration or None, "s", OnPage("in flight [s]", ".3f", behind="flights"),
        sometimes=True,
    ),
    Column(
        "flight_height_m", "greatest height of the lower pivot above the ground, or above its support, in these flights",
        lambda ran: ran.outcome.flight_height or None, "m",
        OnPage("flight height [mm]", ".2f", 1000, "flight_duration_s"), sometimes=True,
    ),
    Column(
        "theta_max_is",
        '"lean" where the greatest rotation is mostly that of a base that has yielded, about which the pier has rocked twice as '
        "far before; empty where it rocks",
        "theta_max_is", kind="text", page=OnPage("θ_max is", behind="theta_max_error"), bases=YIELDING, sometimes=True,
    ),
    Column(
        IN_MOTION,
        "greatest rotation over α until the record's last sample: of a run that failed later, a lower bound of its peak",
        "theta_max_in_motion", over_alpha=True,
    ),
    Column(
        IN_MOTION_ERROR, "estimated error of it over α; empty where it has not converged, and with a fixed step",
        "theta_max_in_motion_error", over_alpha=True, sometimes=True,
    ),
    Column(
        "settlement_error_m",
        "estimated error of the settlement, including its drift while it was read; empty where it is chaotic, and with a "
        "fixed step",
        "settlement_error", "m", OnPage("± [mm]", ".0e", 1000, "settlement_m"), bases=YIELDING, stood=True, sometimes=True,
    ),
)  # fmt: skip
"""Columns that follow those of the varied keys. A table of an earlier version may lack the last of them."""


def _in_kilonewtons(field: str) -> Callable[[Ran], float | None]:
    """Return a force of :class:`Outcome` over the weight in kN, if the pier's mass is known."""

    def value(ran: Ran) -> float | None:
        force, mass = getattr(ran.outcome, field), ran.pier.mass_t
        return None if force is None or mass is None else force * mass * ran.pier.gravity

    return value


def _device(
    name: str, meaning: str, source: str | Callable[[Ran], Any], unit: str, head: str, form: str, factor: int = 1,
    behind: str = "",
) -> Column:  # fmt: skip
    """Return a column of studies that have devices of the kind with which its name begins."""

    def in_study(study: Study) -> bool:
        return any(name.startswith(f"{device.what}_") for case in study.cases for device in case.base.restraints)

    number: Literal["number", "count"] = (
        "count" if source in ("tendon_slack", "stop_blows", "deck_spring_blows") else "number"
    )
    return Column(
        name, meaning, source, unit, OnPage(head, form, factor, behind), number, sometimes=True, requested=in_study
    )


_DAMPER, _TENDON, _STOP = (f"greatest force of a {device}" for device in ("damper", "tendon", "stop"))
_DECK = "greatest force of a spring beside the deck"

DEVICES = (
    _device("damper_force_over_weight", f"{_DAMPER} over the pier's weight", "damper_force", "1", "damper F/(M g)", ".4f"),
    _device("damper_stroke_m", "greatest elongation of a damper", "damper_stroke", "m", "damper stroke [mm]", ".1f", 1000),
    _device("damper_speed_m_s", "greatest speed of a damper", "damper_speed", "m/s", "damper speed [m/s]", ".3f"),
    _device(
        "damper_energy_J_kg", "energy that all dampers take, per unit mass of the pier", "damper_energy", "J/kg",
        "dampers [J/kg]", ".4f",
    ),
    _device("tendon_force_over_weight", f"{_TENDON} over the pier's weight", "tendon_force", "1", "tendon T/(M g)", ".4f"),
    _device(
        "tendon_yield_m", "by how much the tendon that yielded most is longer for good", "tendon_yield", "m",
        "tendon yield [mm]", ".2f", 1000,
    ),
    _device("tendon_slack", "how often tendons went slack", "tendon_slack", "1", "slack", ".0f"),
    _device(
        "damper_force_kN", f"{_DAMPER}, where the mass is known", _in_kilonewtons("damper_force"), "kN", "damper F [kN]", ".0f",
        behind="damper_force_over_weight",
    ),
    _device(
        "tendon_force_kN", f"{_TENDON}, where the mass is known", _in_kilonewtons("tendon_force"), "kN", "tendon T [kN]", ".0f",
        behind="tendon_force_over_weight",
    ),
    _device("stop_force_over_weight", f"{_STOP} over the pier's weight", "stop_force", "1", "stop F/(M g)", ".4f"),
    _device(
        "stop_deflection_m", "by how much the stop that was pressed in most was, beyond its gap", "stop_depth", "m",
        "stop deflection [mm]", ".1f", 1000,
    ),
    _device("stop_blows", "how often stops were met", "stop_blows", "1", "blows", ".0f"),
    _device(
        "stop_energy_J_kg", "energy that all stops take and do not give back, per unit mass of the pier", "stop_energy", "J/kg",
        "stops [J/kg]", ".4f",
    ),
    _device(
        "stop_force_kN", f"{_STOP}, where the mass is known", _in_kilonewtons("stop_force"), "kN", "stop F [kN]", ".0f",
        behind="stop_force_over_weight",
    ),
    _device(
        "deck_spring_force_over_weight", f"{_DECK} over the pier's weight", "deck_spring_force", "1", "deck spring F/(M g)",
        ".4f",
    ),
    _device(
        "deck_spring_deflection_m", "by how much the spring beside the deck that was pressed in most was, beyond its gap",
        "deck_spring_depth", "m", "deck spring deflection [mm]", ".1f", 1000,
    ),
    _device("deck_spring_blows", "how often gaps beside the deck closed", "deck_spring_blows", "1", "closures", ".0f"),
    _device(
        "deck_spring_energy_J_kg",
        "energy that all springs beside the deck take and do not give back, per unit mass of the pier", "deck_spring_energy",
        "J/kg", "deck springs [J/kg]", ".4f",
    ),
    _device(
        "deck_spring_force_kN", f"{_DECK}, where the mass is known", _in_kilonewtons("deck_spring_force"), "kN",
        "deck spring F [kN]", ".0f", behind="deck_spring_force_over_weight",
    ),
)  # fmt: skip
"""Columns of devices."""
_ITSELF = "the same, not over the mass, where that is known"
_PIVOT = "greatest force of each support over half the weight, its dashpot's included; of a rigid base, where it bears all of N"
_GAP = "heel gap: greatest height of each pivot above where its support waits, the stroke of a key or damper"
_SPEED = "greatest speed at which the heel gap opens or closes"

_FORCES = (
    _force(
        "base_shear_m_s2", "greatest base shear V over the mass, without the impulses of impacts", "base_shear", "m/s^2",
        "V/M [m/s²]", ".3f",
    ),
    _force("base_shear_kN", _ITSELF, "base_shear", "kN", "V [kN]", ".0f", per="mass"),
    _force(
        "normal_force_m_s2", "greatest normal force N of all supports over the mass, likewise", "normal_force", "m/s^2",
        "N/M [m/s²]", ".3f",
    ),
    _force("normal_force_kN", _ITSELF, "normal_force", "kN", "N [kN]", ".0f", per="mass"),
    _force(
        "friction_demand",
        "greatest V over N at one time, while N is above [output] least_normal_share of the weight, 0.1 unless given",
        "friction_demand", "1", "V/N", ".4f", unbounded=True,
    ),
    _force("pivot_force_left", _PIVOT, "pivot_left", "1", "support L/(Mg/2)", ".3f"),
    _force("pivot_force_right", _PIVOT, "pivot_right", "1", "support R/(Mg/2)", ".3f"),
    _force("pivot_force_left_kN", _ITSELF, "pivot_left", "kN", "support L [kN]", ".0f", per="half the weight"),
    _force("pivot_force_right_kN", _ITSELF, "pivot_right", "kN", "support R [kN]", ".0f", per="half the weight"),
    _force("heel_gap_left_m", _GAP, "heel_gap_left", "m", "heel gap L [mm]", ".1f", 1000),
    _force("heel_gap_right_m", _GAP, "heel_gap_right", "m", "heel gap R [mm]", ".1f", 1000),
    _force("heel_speed_left_m_s", _SPEED, "heel_speed_left", "m/s", "heel speed L [m/s]", ".3f"),
    _force("heel_speed_right_m_s", _SPEED, "heel_speed_right", "m/s", "heel speed R [m/s]", ".3f"),
    _force(
        "deck_acceleration_m_s2", "greatest absolute horizontal acceleration of the deck, or of the top without one",
        "deck_acceleration", "m/s^2", "deck [m/s²]", ".3f",
    ),
    _force(
        "landing_velocity_m_s", "speed of the pivot that lands, at the hardest impact", "landing_velocity", "m/s",
        "landing [m/s]", ".3f", sometimes=True,
    ),
    _force(
        "impulse_m_s", "its vertical impulse over the mass", "impulse", "m/s", "impulse/M [m/s]", ".3f", sometimes=True
    ),
    _force("impulse_kN_s", _ITSELF, "impulse", "kN*s", "impulse [kN s]", ".0f", per="mass"),
    _force(
        "impact_friction_demand", "greatest horizontal over vertical impulse of an impact", "impact_friction_demand", "1",
        "V/N at impact", ".4f", sometimes=True,
    ),
    _force(
        "first_uplift_s", "when a pivot first leaves its support", "first_uplift", "s", "first uplift [s]", ".3f",
        sometimes=True,
    ),
    _force(
        "first_uplift_g", "magnitude of the horizontal ground acceleration then, over g", "uplift_ground",
        "standard_gravity", "ground then [g]", ".4f", per="g", sometimes=True,
    ),
    _force("omega_max_over_p", "greatest angular velocity over p", "omega_over_p", "1", "θ̇_max/p", ".4f"),
    _force(
        "key_shear_m_s2", "greatest V over the mass while N is not above that share, as in flight: shear keys bear it",
        "key_shear", "m/s^2", "V of keys/M [m/s²]", ".3f", sometimes=True,
    ),
    _force("key_shear_kN", _ITSELF, "key_shear", "kN", "V of keys [kN]", ".0f", per="mass"),
    _force(
        "flight_longest_s", "the longest of the flights that were followed", "flight_longest", "s",
        "longest flight [s]", ".3f", sometimes=True,
    ),
    _force(
        "forces_error",
        "estimated error, as a share of itself, of that of these columns whose error is the largest: what halving the step "
        "still changed; empty with a fixed step",
        "error", "1", "±", ".0e", sometimes=True,
    ),
    _force(
        "base_moment_m2_s2",
        "greatest moment about the middle of the base, of the vertical forces of supports, dampers and tendons, over the mass; "
        "of a frame, of each column's about its own middle, all together",
        "base_moment", "m^2/s^2", "base moment/M [m²/s²]", ".2f", behind="base_shear_kN",
    ),
    _force(
        "base_moment_kNm", _ITSELF, "base_moment", "kN*m", "base moment [kN m]", ".0f", per="mass",
        behind="base_moment_m2_s2",
    ),
)  # fmt: skip
"""Forces and motions for design, until the run ends or the pier leans beyond α for good."""

ASKED = (
    Column(
        MIRROR_OF, 'with both polarities, "+" in the rows of "-": the run whose mirror image this is', kind="text",
        sometimes=True, requested=lambda study: len(study.motions.polarity) > 1,
    ),
    Column(
        OTHER_LAW,
        "settlement of Bouc–Wen springs by the elastic–perfectly plastic law: the other end of its range; unless [output] "
        "both_laws = false",
        "settlement_other_law", "m", OnPage("by the other law [mm]", ".2f", 1000, "settlement_m"), bases=YIELDING,
        stood=True, sometimes=True, suite=OfSuite("Settlement by the other law [mm]", ".2f"),
        requested=lambda study: study.output.both_laws and any(case.base.ratchets for case in study.cases),
    ),
    Column(
        ROCKING,
        "greatest rotation over α about where the pier would rest on its base as it then is; with [output] rocking = true",
        "theta_rocking", page=OnPage("rocking/α", ".5f", behind="theta_max_is"), over_alpha=True,
        requested=lambda study: study.output.rocking,
    ),
    Column(
        "theta_lean_over_alpha", "rotation over α at which it would rest at the time of the greatest rotation, to its side; with "
        "[output] rocking = true",
        "theta_lean", page=OnPage("lean/α", ".5f", behind=ROCKING), over_alpha=True, bases=YIELDING, stood=True,
        requested=lambda study: study.output.rocking,
    ),
    *DEVICES,
    *map(_energy, TERMS),
    *_FORCES,
    Column(
        "theta_rocking_error",
        "estimated error of rocking, and of lean, over α: what halving the step still changed; empty with a fixed step; with "
        "[output] rocking = true",
        "theta_rocking_error", page=OnPage("±", ".0e", behind=ROCKING), over_alpha=True, stood=True,
        requested=lambda study: study.output.rocking,
    ),
    Column(
        "theta_lean_error",
        "estimated error of rocking, and of lean, over α: what halving the step still changed; empty with a fixed step; with "
        "[output] rocking = true",
        "theta_lean_error", page=OnPage("±", ".0e", behind="theta_lean_over_alpha"), over_alpha=True, bases=YIELDING,
        stood=True, requested=lambda study: study.output.rocking,
    ),
    Column(
        DEVICES_ERROR,
        "estimated error of that column of devices, but for counts, whose error is the largest, as a share of it or of 1 % "
        "of its scale: "
        "what halving the step still changed; empty with a fixed step",
        "devices_error", page=OnPage("devices ±", ".0e", behind="deck_spring_energy_J_kg"), stood=True,
        requested=lambda study: any(case.base.restraints for case in study.cases),
    ),
)  # fmt: skip
"""Columns at the end of a table, on request of the study."""

COLUMNS = {column.name: column for column in (*STAYING, *MORE, *ASKED)}
"""All of them, by name, in the order of the file."""

TEXTS = tuple(column.name for column in COLUMNS.values() if column.kind == "text")
COUNTS = tuple(column.name for column in COLUMNS.values() if column.kind == "count")
UNBOUNDED = tuple(column.name for column in COLUMNS.values() if column.unbounded)

_FIELDS = {column.name: column.source for column in COLUMNS.values() if isinstance(column.source, str)}
_FUNCTIONS = {column.name: column.source for column in COLUMNS.values() if callable(column.source)}
_OVER_ALPHA = tuple(column.name for column in COLUMNS.values() if column.over_alpha)
_read_fields = attrgetter(*_FIELDS.values())


def cells(runs: Sequence[Ran], requested: Container[str] = COLUMNS) -> dict[str, list[Any]]:
    """Return the columns of peaks.csv of ``runs``, each shape (n,): their names, and their outcomes over α.

    Numbers that functions give are only those of ``requested`` columns. None where a column does not apply.
    """
    table: dict[str, list[Any]] = {
        "record": [ran.motion.name for ran in runs],
        "station": [ran.motion.of_station for ran in runs],
        "case": [ran.case.name for ran in runs],
        "polarity": [ran.polarity for ran in runs],
        "scale": [ran.scale for ran in runs],
        MIRROR_OF: [ran.mirror_of for ran in runs],
    }
    varied = dict.fromkeys(name for case in {id(ran.case): ran.case for ran in runs}.values() for name in case.columns)
    table |= {name: [ran.case.columns.get(name) for ran in runs] for name in varied}
    table |= zip(_FIELDS, map(list, zip(*(_read_fields(ran.outcome) for ran in runs), strict=True)), strict=True)
    table |= {name: [function(ran) for ran in runs] for name, function in _FUNCTIONS.items() if name in requested}
    alpha = [ran.case.pier.alpha for ran in runs]
    for name in _OVER_ALPHA:
        table[name] = [None if x is None else x / a for x, a in zip(table[name], alpha, strict=True)]
    return table


def row(ran: Ran) -> dict[str, Any]:
    """Return the row of peaks.csv of a run."""
    return {name: values[0] for name, values in cells([ran]).items()}


def unusable_rows(motions: MotionSet) -> list[dict[str, Any]]:
    """Return a row for each file that could not be used, with the reason."""
    return [
        {"record": file.name, "status": "failed", "reason": f"{file.source}: {file.reason}"}
        for file in motions.unusable
    ]


def columns(study: Study) -> list[str]:
    """Return the columns of the table of ``study``: those that stay, its varied keys, more, and what it asks for."""
    requested = [column for column in ASKED if column.requested and column.requested(study)]
    return [*names(STAYING), *study.varied, *names(MORE), *names(requested)]


def names(table: Iterable[Column]) -> list[str]:
    """Return the names of columns."""
    return [column.name for column in table]


def units(study: Study) -> dict[str, str]:
    """Return the units of the numbers in the table of ``study``, but for its varied keys; "1" is none."""
    described = (COLUMNS[name] for name in columns(study) if name in COLUMNS)
    return {column.name: column.unit for column in described if column.kind != "text"}


def as_table(rows: Iterable[Mapping[str, Any]], study: Study) -> "pd.DataFrame":
    """Return the rows of peaks.csv as a DataFrame: NaN if a number does not apply, counts that can be missing."""
    return _typed(pd.DataFrame(list(rows), columns=columns(study)), study.varied)


def as_series(cells: Mapping[str, Any]) -> "pd.Series[Any]":
    """Return a row on its own, as it stands in a table, with those columns on request that it has."""
    present = [column for column in ASKED if cells.get(column.name) is not None]
    table = pd.DataFrame([cells], columns=names((*STAYING, *MORE, *present)))
    return _typed(table, ()).iloc[0].rename(cells["record"])


def _typed(table: "pd.DataFrame", varied: Sequence[str]) -> "pd.DataFrame":
    texts = [name for name in table if name in TEXTS]
    table[texts] = table[texts].fillna("")
    for name in table.columns.difference([*TEXTS, *varied, *COUNTS]):
        table[name] = table[name].astype("float64")
    for name in table.columns.intersection(list(COUNTS)):
        table[name] = table[name].astype("Int64")
    return table


def in_words(name: str, value: Any) -> str:
    """Return a value of a column as the report writes it, in the page's unit; empty if it has none."""
    page = COLUMNS[name].page
    if value is None or value != value or page is None:
        return ""
    return value if isinstance(value, str) else format(page.factor * float(value), page.form)


def on_page(shown: str = "peaks") -> list[Column]:
    """Return the columns in the report's tables of ``shown``, in their order: beside each other what is read together."""
    order: list[str] = []
    for column in COLUMNS.values():
        if column.page and column.page.table == shown:
            place = order.index(column.page.behind) + 1 if column.page.behind else len(order)
            order.insert(place, column.name)
    return [COLUMNS[name] for name in order]


def as_markdown() -> str:
    """Return the table of docs/columns.md; columns with one meaning share a line."""
    lines = ["| column | unit | meaning | where |", "| --- | --- | --- | --- |"]
    for meaning, alike in groupby(COLUMNS.values(), key=lambda column: column.meaning):
        first, *further = alike
        unit = "" if first.kind == "text" or first.unit == "1" else first.unit
        lines.append(f"| {', '.join(names([first, *further]))} | {unit} | {meaning} | {first.applies} |")
    return "\n".join(lines) + "\n"
