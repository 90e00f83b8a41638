"""Fragility curves in a study file: [fragility]."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

from rockbatch.analyses.fragility.hazard import (
    DISPERSION,
    HAZARD,
    IN_G,
    IN_M_S,
    Dispersion,
    Hazard,
    read_dispersions,
    read_hazard,
    root_of_squares,
)
from rockbatch.analyses.fragility.measures import LEVELS, MEASURES, OwnMeasure, given_measure, measure_of_file
from rockbatch.analyses.fragility.stripes import STRIPE, StripeRecords, read_stripes
from rockbatch.analyses.fragility.uncertain import SECTIONS as OF_UNCERTAIN
from rockbatch.analyses.fragility.uncertain import Uncertain, read_uncertain
from rockbatch.checks.rules import Rule
from rockbatch.common.grouping import closest
from rockbatch.common.naming import chosen, chosen_by
from rockbatch.common.showing import shown
from rockbatch.pier import Base, Pier
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.study.load import Study
from rockbatch.study.target_keys import PERIOD
from rockbatch.toml.kinds import Number, choice, not_negative, positive, share, text
from rockbatch.toml.meant import names
from rockbatch.toml.reader import Table
from rockbatch.toml.section import CONFIRM, Clash, Key, Section

OVERTURNING = Rule("overturning", "overturned", at_most=0, reason="collapse of a rocking pier")
"""The limit state that every study has."""


HUNT_STEP = 0.0025
"""Relative steps of the hunt on rigid ground, unless the study gives others."""

WINDOW = 0.02
"""Relative half-width of the windows about the levels on rigid ground, unless the study gives another."""


@dataclass(frozen=True)
class FragilitySpec:
    """[fragility]: how intensity is measured, where fragility is sampled, and the limits.

    :data:`FRAGILITY` says what each key means. ``levels`` rise, in :attr:`unit`; ``limits`` are overturning, then the checks,
    each held against every record by itself, with runs that flew or failed undecided unless the check leaves them out.
    ``stripes`` are those with records of their own, one for each level. ``own`` is the engineer's own measure in place of
    ``measure``, which is then empty.
    """

    method: str
    measure: str
    levels: tuple[float, ...]
    limits: tuple[Rule, ...]
    period_s: float = 1.0
    damping: float = 0.05
    tolerance: float = 0.01
    confidence: float = 0.95
    hunt_step: float | None = None
    window: float | None = None
    hazard: Hazard | None = None
    dispersions: tuple[Dispersion, ...] = ()
    least_scale: float = 0.0
    most_scale: float = math.inf
    censored_below: float = 0.01
    stripes: tuple[StripeRecords, ...] = ()
    uncertain: Uncertain = field(default_factory=Uncertain)
    own: OwnMeasure | None = None

    @property
    def of_runs(self) -> "FragilitySpec":
        """Return the settings with the default confidence, and without the hazard and dispersions, on which no run depends."""
        return replace(self, confidence=0.95, hazard=None, dispersions=())

    @property
    def added(self) -> float:
        """Return the root of the sum of the squares of the added dispersions; 0 without any."""
        return root_of_squares(self.dispersions)

    def step_on(self, base: Base) -> float | None:
        """Return the relative steps of the hunt between the levels on ``base``: the given ones, else HUNT_STEP, 0.0025, on rigid
        ground, and None, the levels alone, on springs or a footing.
        """
        return HUNT_STEP if self.hunt_step is None and not base.on_springs else self.hunt_step

    def window_on(self, base: Base) -> float | None:
        """Return the relative half-width of the windows about the levels on ``base``; None for no windows.

        With method "ida" it is the given one, else WINDOW, 0.02, on rigid ground, and None on springs or a footing; None with
        others.
        """
        if self.method != "ida":
            return None
        return WINDOW if self.window is None and not base.on_springs else self.window

    def allows(self, factor: float) -> bool:
        """Return whether a factor on a record as it was recorded is within the limits of the study, to 1e-9 of it."""
        return self.least_scale <= factor * (1 + 1e-9) and factor <= self.most_scale * (1 + 1e-9)

    @property
    def unit(self) -> str:
        """Return the unit of the levels; empty without one."""
        return self.own.unit if self.own else MEASURES[self.measure].unit

    @property
    def label(self) -> str:
        """Return the measure in words: "Sa(1 s, 5 %)", "PGA/(g tan α)", or the name of an own one."""
        if self.own:
            return self.own.name
        if self.measure == "Sa":
            return f"Sa({self.period_s:g} s, {100 * self.damping:g} %)"
        return self.measure.replace("alpha", "α")

    @property
    def per_pier(self) -> Callable[[Pier], float] | None:
        """Return the factor that makes intensities relative to a pier, so that piers share a curve; None of other measures."""
        return None if self.own else MEASURES[self.measure].per_pier

    @property
    def power(self) -> float:
        """Return the power by which the measure grows with the scale of a motion: 1 but for an own measure."""
        return self.own.power if self.own else 1.0


_BELOW_ONE = Number("a number, 0 or above and below 1", low=0.0, high=1.0, below=True)
_SA, _IDA, _CLOUD = {"measure": ("Sa",)}, {"method": ("ida",)}, {"method": ("cloud",)}
_SCALED = {"method": ("stripes", "ida")}
FRAGILITY = Section(
    ("fragility",),
    ("Fragility curves, by `rockbatch fragility`: how probable it is at a given intensity that a limit is exceeded."),
    {
        "method": Key(
            choice("stripes", "ida", "cloud"),
            '"ida"',
            '"stripes": every record at every level; "ida": also, for each record, the least intensity that exceeds a limit; '
            '"cloud": every record as it is, in the scales of [motions], and a line through the logarithms of demand and '
            "intensity.",
            default="stripes",
        ),
        "measure": Key(
            choice(*MEASURES),
            '"PGV"',
            "Intensity measure of the horizontal component. Of the two over g tan alpha, which are relative to a pier, all "
            "piers of a case share one curve, and both axes of a pier.",
        ),
        "measure_file": Key(
            text,
            '"avgsa.csv"',
            "A CSV file with an intensity measure of your own in place of measure, relative to the study: a column record, and "
            "one of values of the records as they were recorded, with the unit in its heading, such as AvgSa [g].",
        ),
        "measure_power": Key(
            positive,
            "2.0",
            "Power by which the measure of measure_file grows with the scale of a motion: 2 for an Arias intensity, 1 for a "
            "spectral acceleration.",
            default=1.0,
        ),
        "period_s": Key(positive, "1.0", "Period of the oscillator of Sa.", required=True, only=_SA, usual=PERIOD),
        "damping": Key(
            _BELOW_ONE, "0.05", "Damping of the oscillator of Sa, as a fraction of critical damping.", only=_SA
        ),
        "levels_g": Key(
            positive,
            "[0.2, 0.4, 0.6, 0.8]",
            "Levels of PGA or Sa; each [[fragility.stripe]] has its own instead.",
            many=True,
            only={"measure": ("PGA", "Sa")} | _SCALED,
            usual=IN_G,
        ),
        "levels_m_s": Key(
            positive,
            "[0.25, 0.5, 1.0, 1.5]",
            "Levels of PGV; each [[fragility.stripe]] has its own instead.",
            many=True,
            only={"measure": ("PGV",)} | _SCALED,
            usual=IN_M_S,
        ),
        "levels": Key(
            positive,
            "[0.5, 1.0, 1.5, 2.0]",
            "Levels of a measure over g tan alpha, or of measure_file in its unit.",
            many=True,
            only=_SCALED,
        ),
        "least_scale": Key(
            not_negative,
            "0.25",
            "Least factor on a record, as it was recorded: at levels that take a smaller one it is not used.",
            only=_SCALED,
        ),
        "most_scale": Key(
            Number("a number above 0, or inf", low=0.0, above=True, endless=True),
            "4.0",
            "Greatest factor on a record, as it was recorded: at levels that take a larger one it is not used.",
            only=_SCALED,
        ),
        "tolerance": Key(
            Number("a number from 1e-6 to 1", low=1e-6, high=1.0),
            "0.01",
            "Relative width to which the least intensity is narrowed down.",
            only=_IDA,
        ),
        "hunt_step": Key(
            Number("a number from 0.001 to 1", low=1e-3, high=1.0),
            "0.02",
            "Relative steps in which the first exceedance is hunted between the levels, on every base; if it is not given, "
            "0.0025 on rigid ground and the levels alone elsewhere.",
            only=_IDA,
        ),
        "window": Key(
            Number("a number from 0.001 to 0.2", low=1e-3, high=0.2),
            "0.05",
            "Relative half-width of a window about each level, of which the share of the scales that exceed a limit gives a "
            "second curve, on every base; if it is not given, 0.02 on rigid ground and none elsewhere.",
            only=_IDA,
        ),
        "censored_below": Key(
            share,
            "0.05",
            "Share of a limit below which a demand is censored, that is counts as small, without its value: the "
            "logarithms of very small demands say nothing about the limit.",
            only=_CLOUD,
        ),
        "checks": Key(
            text,
            '["no overturning", "uplift*"]',
            "Which of the checks are limits, by name or pattern, beside overturning; all that are about records if it is not "
            "given.",
            many=True,
        ),
        "confidence": Key(_BELOW_ONE, "0.95", "Level of the confidence bands."),
        **CONFIRM,
    },
    homes=(FragilitySpec,),
    clashes=(
        Clash(("measure", "measure_file"), "measure and measure_file are given; keep one"),
        Clash(
            ("measure_power",),
            "measure_power is of measure_file; write that, or leave it out",
            lacking=("measure_file",),
        ),
    ),
    also=names(
        {
            "measure": "im intensity intensitymeasure",
            "checks": "limits limitstates",
            "method": "type analysis",
        }
    ),
)

SECTIONS = (FRAGILITY, HAZARD, DISPERSION, STRIPE, *OF_UNCERTAIN)
"""Its tables in a study file."""


def read_fragility(study: Study, im: Any = None) -> FragilitySpec:
    """Return the settings of the table [fragility] of a loaded study; ``im``, if given, is a measure in place of its own.

    Raises ``InputError`` with every mistake in it, with its line.
    """
    file = study.file()
    table = file.table("fragility", required='[fragility] with measure = "PGV" and levels_m_s = [0.25, 0.5, 1.0, 1.5]')
    read = table.read(FRAGILITY, other=("hazard", "dispersion", "stripe", "uncertain")) if table else {}
    limits = _limits(table, study.checks, read.pop("checks", None)) if table else ()
    key = _measure(table, read, im) if table else None
    stripes = read_stripes(file, key) if key else ()
    levels = _levels(table, read, stripes, key) if table else ()
    hazard = read_hazard(file, key) if key else None
    uncertain = read_uncertain(file, study)
    dispersions = read_dispersions(file, uncertain.names)
    file.finish()
    settings: dict[str, Any] = {
        "method": "stripes",
        "hazard": hazard,
        "dispersions": dispersions,
        "stripes": stripes,
    } | read
    return FragilitySpec(levels=levels, limits=(OVERTURNING, *limits), uncertain=uncertain, **settings)


def _measure(table: Table, read: dict[str, Any], im: Any) -> str | None:
    """Return the key of the levels of the measure, "levels_g"; None, with a complaint, without a valid measure.

    An own measure, ``im`` before a file, is put into ``read``; its key is that of its unit, if the table has it, or else the
    first that the table has, or "levels".
    """
    power, name = read.pop("measure_power", 1.0), read.pop("measure_file", None)
    if im is not None or name is not None:
        with table.noting("measure_file"):
            own = given_measure(im, power) if im is not None else measure_of_file(table.file.path.parent / name, power)
            read["own"], read["measure"] = own, ""
            by_unit = {"g": "levels_g", "m/s": "levels_m_s"}.get(own.unit, "levels")
            return by_unit if table.has(by_unit) else next(filter(table.has, LEVELS), "levels")
        return None
    if "measure" in read:
        return MEASURES[read["measure"]].levels
    if not table.has("measure"):
        table.complain('measure is missing; write for example measure = "PGV", or measure_file = "avgsa.csv"')
    return None


def _levels(table: Table, read: dict[str, Any], stripes: Sequence[StripeRecords], key: str | None) -> tuple[float, ...]:
    """Return the levels in the unit of the measure, those of ``stripes`` if there are any, () of a cloud or without a ``key``.

    Mistakes become problems of the file.
    """
    written = {name: read.pop(name, ()) for name in LEVELS}
    if read.get("least_scale", 0.0) > read.get("most_scale", math.inf):
        table.complain(
            f"least_scale = {read['least_scale']:g}: more than most_scale; no factor lies between", "least_scale"
        )
    if key is None:
        return ()
    for other in LEVELS:
        if other != key and written[other]:
            table.complain(f"{other}: the measure has {key}; write that", other)
    if table.file.has((*table.key_path, "stripe")):
        if written[key]:
            table.complain(f"{key}: each [[fragility.stripe]] has its level; leave {key} out", key)
        if read.get("method", "stripes") != "stripes":
            table.complain(
                f'method = {shown(read["method"])}: records of their own are for "stripes"; leave it out', "method"
            )
        return tuple(stripe.level for stripe in stripes)
    if read.get("method") == "cloud":
        return ()
    if not table.has(key):
        table.complain(f"{key} is missing; write for example {key} = {FRAGILITY[key].example}")
    levels = written[key]
    for n, (previous, level) in enumerate(pairwise(levels), 1):
        if level < previous:
            table.complain(f"{key} = {level:g}: after {previous:g}; write them in rising order", key, n)
    if len(levels) == 1:
        table.complain(
            f"{key} = {shown(table.data[key])}: one level does not determine a dispersion; write at least two", key
        )
    return levels


def _limits(table: Table, rules: tuple[Rule, ...], wanted: tuple[str, ...] | None) -> tuple[Rule, ...]:
    """Return the checks that are ``wanted`` as limits of one record, by name or pattern; all if it is None.

    Left out are those on overturning, which is a limit already, of the case alone, and in sections or over a curve of capacity,
    which peaks do not have. Mistakes become problems of the file.
    """
    able = [rule for rule in rules if not DEMANDS[rule.demand].per_case and rule.demand != OVERTURNING.demand]
    able = [rule for rule in able if rule.at_m is None and rule.curve is None]
    if any(rule.name == OVERTURNING.name for rule in able):
        table.complain(f"a [[check]] is called {shown(OVERTURNING.name)}, as the limit state is; give it another name")
    if wanted is not None:
        names = [rule.name for rule in able]
        for n, pattern in enumerate(wanted):
            if not chosen(pattern, names):
                nearest = closest(pattern, names)
                choices = f"there is {', '.join(map(shown, names))}" if names else "the study has none about records"
                instead = f"did you mean {shown(nearest)}?" if nearest else choices
                table.complain(f"checks = {shown(pattern)}: no [[check]] has this name; {instead}", "checks", n)
        able = [rule for rule in able if rule.name in chosen_by(wanted, frozenset(names))]
    return tuple(map(_of_one_record, able))


def _of_one_record(rule: Rule) -> Rule:
    """Return a check as a limit of every record, at all scales; the rule of ASCE 7-16 becomes the largest value.

    A run that flew or failed is left out if the check says so, and else undecided: a check is on the safe side where such a run
    counts as infinite, a fragility is not.
    """
    statistic = "max" if rule.counts_unacceptable else rule.statistic
    limit = replace(rule, scale=(), statistic=statistic)
    if not DEMANDS[rule.demand].per_run:
        return limit
    flight, failed = ("left out" if limit.ways[status] == "left out" else "unknown" for status in ("flight", "failed"))
    return replace(limit, flight=flight, failed=failed)
