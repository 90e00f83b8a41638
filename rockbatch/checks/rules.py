"""Rules: a demand, its statistic over the suite, a limit, and the source of the limit."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

from rockbatch.checks import capacity
from rockbatch.checks.capacity import Curve
from rockbatch.common.arguments import checked
from rockbatch.common.errors import Contradiction, Problem, WrongType, refuse
from rockbatch.common.grouping import grouped
from rockbatch.common.showing import shown
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.toml.kinds import Choice, KindError, Other, boolean, choice, count, not_negative, number, positive, text
from rockbatch.toml.meant import names
from rockbatch.toml.section import Key, Section

BASES = ("code", "literature", "judgement")
COUNTING = ("infinite", "unknown", "value", "left out")
"""Ways of counting a run that did not go through to its end:

infinite
    Worse than any limit.
unknown
    Any value from the known one up to infinity: a peak or a count is at least its value when the pier overturned or flew.
value
    The value in the table, as if the run had gone through; unknown if it has none.
left out
    Not counted; the verdict has the number of such runs.
"""
COUNTS = ("station", "component")
"""Ways to count records:

station
    All components, directions and polarities of one station in one earthquake, with the worst of them.
component
    Every horizontal component by itself, with the worse of its polarities.
"""
BOTH_AXES = {"greater": "the greater of both axes", "srss": "SRSS of both axes", "100_30": "100 % + 30 % of both axes"}
"""Ways to combine the demands of a record on both axes of a pier, with words for them:

greater
    The greater of the two.
srss
    The root of the sum of their squares.
100_30
    The greater of one with 0.3 of the other.
"""
EITHER, LESSER = "on either axis", "the lesser of both axes"
"""Ways to combine events, and properties of a case of which more is better."""
OF_EVENTS = ("max", "count", "mean")
"""Statistics of events: whether any record has it, how many, and the share; a rank of ones and zeros says neither."""
CONFIRMED = ("at_most", "at_least", "above", "capacity")
MOST_SHARE = 10.0
"""Greatest share of a capacity that a limit may be."""
USUAL = {"overturned": "infinite", "flight": "unknown", "failed": "unknown"}


@checked
@dataclass(frozen=True)
class Rule:
    """One check.

    A record is a station: its components, the angles that they are turned to and both polarities are directions of it, and it
    counts once, with the worst of them, for every statistic. Each scale is a suite of its own, as is each case.

    Attributes
    ----------
    name : str
        What it is called in the table.
    demand : str
        A key of :data:`rockbatch.quantities.demands.DEMANDS`.
    at_most, at_least : float or None
        The limit, one of the two; ``at_least`` is for properties of the case, such as eta.
    statistic : str
        A key of :data:`rockbatch.quantities.statistics.STATISTICS`; "max" unless given.
    above : float or None
        With "count", what a record has to exceed to count; 0 unless given for events such as flight.
    least : int or None
        Number of records below which nothing passes; that of the statistic if it is larger or nothing is given.
    count : "station", "component" or None
        What counts as one record, one of :data:`COUNTS`; ``None`` takes what [suite] of the study says, or "station". A code's
        statistic counts stations.
    per_event : int or None
        With a code's statistic: the greatest number of records of one event with which anything passes, where those of no known
        event count as of one; no limit unless given.
    reason : str
        Clause, source, or why, in words.
    basis : "code", "literature" or "judgement"
        Where the limit comes from.
    case : tuple of str
        Names or globs of the cases to check; all if empty.
    scale : tuple of float
        Scales to check; all if empty.
    overturned, flight, failed : str
        How such runs count, one of :data:`COUNTING`; a run that has not settled, or was not run, is failed. ``None`` takes
        the usual: overturned is infinite, the others are unknown; under "asce7-16" all are unacceptable, hence infinite.
    other_law : bool
        Whether the settlement by the other spring law has to be there: where both were run the worse counts in any case, and with
        this a run that did not go through by the other one is unknown.
    at_m : float or None
        Height of the section that a demand such as section_moment_kNm is about [m].
    both_axes : "greater", "srss", "100_30" or None
        How the demands of a record combine on both axes of a pier, one of :data:`BOTH_AXES`, in cases with ``other_width_m``;
        "greater" unless given, and of demands that do not add up (:attr:`rockbatch.quantities.demands.Demand.directed`).
    capacity : float, tuple of pairs or None
        Of a demand over a capacity: points of axial force, positive in compression, and resistance [kN, and kN m or kN], by
        ascending axial force; a number is the same at every axial force. Of any other quantity of a run a number in its unit, of
        which ``at_most`` is the share.
    confirm : tuple of str
        Those of at_most, at_least, above and capacity that are right though nothing exceeds them
        (:mod:`rockbatch.checks.rule_choices`).

    Raises ``InputError`` with all that is wrong, each problem with the name of its attribute as ``key``.

    Examples
    --------
    >>> limit = rb.Rule("rotation", "theta_max_over_alpha", at_most=0.3, statistic="median", reason="agreed")
    >>> rb.check(rb.run("pier4.toml"), [limit], study="pier4.toml")[["case", "value", "limit", "verdict"]].round(2)
        case  value  limit verdict
    0  rigid   0.21    0.3    pass
    1   pads   0.17    0.3    pass
    """

    name: str
    demand: str
    at_most: float | None = None
    at_least: float | None = None
    statistic: str | None = None
    above: float | None = None
    least: int | None = None
    count: str | None = None
    reason: str = ""
    basis: str = "judgement"
    case: tuple[str, ...] = ()
    scale: tuple[float, ...] = ()
    overturned: str | None = None
    flight: str | None = None
    failed: str | None = None
    other_law: bool = False
    confirm: tuple[str, ...] = ()
    at_m: float | None = None
    both_axes: str | None = None
    per_event: int | None = None
    capacity: float | tuple[tuple[float, float], ...] | None = None

    def __post_init__(self) -> None:
        refuse(_unknown_words(self) or _misfits(self))

    @property
    def limit(self) -> float:
        """The value of at_most or at_least, times :attr:`number_of_capacity`, if any; NaN if neither limit is given."""
        limit = float(next((limit for limit in (self.at_most, self.at_least) if limit is not None), math.nan))
        return limit * (self.number_of_capacity or 1.0)

    @property
    def threshold(self) -> float:
        """Limit on the demand of one record; of a check that counts records, the value ``above`` which they count, or 0."""
        return (self.above or 0.0) if self.statistic == "count" else self.limit

    @property
    def number_of_capacity(self) -> float | None:
        """The capacity of which ``at_most`` is a share; None without one, for a curve, and for a demand over a capacity."""
        return self.capacity if isinstance(self.capacity, float) and not DEMANDS[self.demand].over_capacity else None

    @property
    def curve(self) -> Curve | None:
        """The capacity of a demand over a capacity, as a curve of the axial force (level for a number); None for others."""
        if not DEMANDS[self.demand].over_capacity or self.capacity is None:
            return None
        return capacity.line(self.capacity) if isinstance(self.capacity, float) else self.capacity

    @property
    def sense(self) -> str:
        """ "at most" if ``at_most`` is given, else "at least"."""
        return "at most" if self.at_most is not None else "at least"

    @property
    def limit_key(self) -> str:
        """The key of the limit: "at_most" or "at_least", or "capacity" where the limit is a share of one."""
        return self.bound_key if self.number_of_capacity is None else "capacity"

    @property
    def bound_key(self) -> str:
        """The key of the bound that is given: "at_most", or else "at_least"."""
        return "at_most" if self.at_most is not None else "at_least"

    @property
    def counts_unacceptable(self) -> bool:
        """Whether the code of its statistic says how many records may respond unacceptably."""
        return self.statistic in STATISTICS and STATISTICS[self.statistic].counts_unacceptable

    @cached_property
    def ways(self) -> dict[str, str]:
        """Way of counting, one of :data:`COUNTING`, by status: {"overturned": "infinite", …}; all infinite by ASCE 7-16."""
        given = {"overturned": self.overturned, "flight": self.flight, "failed": self.failed}
        usual = dict.fromkeys(USUAL, "infinite") if self.counts_unacceptable else USUAL
        return {status: way or usual[status] for status, way in given.items()}

    @property
    def on_both_axes(self) -> str:
        """Way to combine both axes: "SRSS of both axes"; of an event "on either axis", with ``at_least`` the lesser."""
        if DEMANDS[self.demand].event:
            return EITHER
        return BOTH_AXES[self.both_axes or "greater"] if self.sense == "at most" else LESSER

    @property
    def is_ban(self) -> bool:
        """True if it asks that an event happens under no record."""
        return is_ban(self.demand, self.statistic or "max", self.limit)

    @property
    def words(self) -> str:
        """Words for what is compared with the limit: "mean of theta_max_over_alpha"; "no record overturns"; "eta"."""
        return self.words_at(self.at_m)

    def words_at(self, height: float | None) -> str:
        """Return :attr:`words` with the height at which the demand is read [m]; without it for None, a ban and a property."""
        demand = DEMANDS[self.demand]
        if demand.per_case:
            return self.demand
        statistic = STATISTICS[self.statistic or "max"].words
        if self.is_ban:
            return f"no record {demand.verb}"
        place = "" if height is None else f" at {height:g} m"
        if self.statistic != "count":
            return f"{statistic} of {self.demand}{place}"
        return f"{statistic} with {self.demand}{place}" + (
            "" if demand.event and not self.above else f" above {self.above:g}"
        )

    @property
    def counting(self) -> str:
        """Ways of counting runs cut short: "overturned: infinite; flight, failed: unknown"; "" for a demand not of every run."""
        if not DEMANDS[self.demand].per_run:
            return ""
        by_way = grouped(self.ways, self.ways.__getitem__)
        return "; ".join(f"{', '.join(statuses)}: {way}" for way, statuses in by_way.items())


def is_ban(demand: str, statistic: str, limit: float) -> bool:
    """Return whether a check bans an event such as "overturned": its statistic is "max", and its limit in 0 ≤ limit < 1."""
    return demand in DEMANDS and DEMANDS[demand].event and statistic == "max" and 0 <= limit < 1


COUNT = (
    'What counts as one record: a "station" in one earthquake, with the worst of its components and polarities, '
    'or each "component"'
)
PER_EVENT = "Greatest number of stations of one event with which anything passes by a code's statistic"
AXES = "How the demands of a record on both axes of a pier combine, in cases with `other_width_m`"
_CALLED = {
    "demand": names(
        {
            ("heel_uplift_m", "heel_uplift_mm"): "uplift heeluplift",
            ("theta_max_rad", "theta_max_over_alpha"): "rotation maxrotation peakrotation thetamax theta",
            "drift_ratio": "peakdriftratio maxdriftratio topdriftratio",
            ("theta_res_rad", "theta_res_over_alpha"): "residualrotation residual thetares",
            "theta_res_rad": "residualdrift residualdriftratio residualtilt",
            (
                "top_drift_m",
                "top_drift_mm",
            ): "displacement topdisplacement drift topdrift deckdisplacement storydrift",
            "friction_demand": "sliding slip",
            "overturned": "overturning overturn collapse toppling",
        }
    ),
    "statistic": names(
        {
            "mean": "average avg",
            "max": "maximum envelope worst largest peak",
            "median": "p50",
            "count": "number",
            "p84": "84th 84 84percentile percentile84 84thpercentile",
            "p84_lognormal": "lognormal",
            "p84_95": "tolerance",
            ("en1998-1", "en1998-2"): "ec8 eurocode8 en1998",
            "asce7-16": "asce7",
            "aashto": "aashtolrfd lrfd",
            "nzs1170.5": "nzs",
        }
    ),
    "basis": names(
        {
            "code": "standard norm",
            "literature": "paper book",
            "judgement": "judgment engineeringjudgement expert",
        }
    ),
}
_DEMAND = Choice(tuple(DEMANDS), called=_CALLED["demand"], listed_by="rockbatch check --list")


def _part_of_capacity(value: object) -> capacity.Capacity:
    """Return a number above 0 as it is, [N, M] as a tuple of one point, a line as one of two; :class:`KindError` for others."""
    if isinstance(value, dict):
        if not value or not value.keys() <= {"constant", "per_N"}:
            raise KindError("a line { constant = 500.0, per_N = 0.6 }")
        return capacity.line(*(not_negative(value.get(key, 0.0)) for key in ("constant", "per_N")))
    if isinstance(value, list):
        if len(value) != 2:
            raise KindError("points [N, M] in brackets")
        return ((number(value[0]), number(value[1])),)
    return positive(value)


_NOT_NEGATIVE = {"type": "number", "minimum": 0}
_CAPACITY = Other(
    "a number, a line { constant, per_N }, or points [N, M] in brackets",
    _part_of_capacity,
    {
        "anyOf": [
            {"type": "number", "exclusiveMinimum": 0},
            {
                "type": "object",
                "properties": {"constant": _NOT_NEGATIVE, "per_N": _NOT_NEGATIVE},
                "additionalProperties": False,
                "minProperties": 1,
            },
            {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2},
        ]
    },
)

CHECK = Section(
    ("check",),
    (
        "A design check: a demand, its statistic over the records, and a limit. `rockbatch check` compares results with it."
    ),
    {
        "name": Key(text, '"overturning margin"', "Its name in the table of verdicts.", required=True),
        "demand": Key(_DEMAND, '"theta_max_over_alpha"', "What is looked at.", required=True),
        "at_m": Key(
            not_negative,
            "7.5",
            "Height above the pivots of the section that the demand is about, one of those of `sections` or `sections_m`.",
        ),
        "statistic": Key(
            choice(*STATISTICS, called=_CALLED["statistic"]),
            '"mean"',
            'How the records are summed up; "max" if it is not given.',
        ),
        "above": Key(
            not_negative,
            "0.5",
            'With statistic = "count": the value that a record has to exceed to count; 0 for events if it is not given.',
        ),
        "least": Key(
            count, "7", "Number of records below which nothing passes; what the statistic asks for if it is not given."
        ),
        "count": Key(
            choice(*COUNTS),
            '"component"',
            f"{COUNT}; what `[suite]` says if it is not given. A code's statistic counts stations.",
        ),
        "per_event": Key(count, "4", f"{PER_EVENT}; what `[suite]` says if it is not given."),
        "both_axes": Key(
            choice(*BOTH_AXES),
            '"srss"',
            f'{AXES}: "greater", the greater; "srss", the root of the sum of squares; "100_30", one with 0.3 of the other. What '
            "`[suite]` says if it is not given.",
        ),
        "capacity": Key(
            _CAPACITY,
            "[[-2000, 0], [0, 30000], [20000, 60000], [50000, 0]]",
            "Of `section_moment_over_capacity` points [N, M] of the axial force [kN], positive in compression, and the moment of "
            "resistance [kN m], by ascending N, with straight lines between them and no capacity beyond the ends; of "
            "`base_shear_over_capacity` points [N, V] in kN. A line, such as friction with a key, is "
            "`{ constant = 500.0, per_N = 0.6 }`. The demand is the greatest moment or shear over the resistance at the axial "
            "force of the same moment. Of any other demand of a run a number in its unit, of which `at_most` is the share.",
            many=True,
        ),
        "at_most": Key(number, "0.5", "The limit."),
        "at_least": Key(number, "2.0", "The limit, for what belongs to the foundation, where more is better."),
        "basis": Key(choice(*BASES, called=_CALLED["basis"]), '"code"', "Where the limit comes from."),
        "reason": Key(text, '"EN 1998-2, 7.6.2"', "Clause, source, or why, in words.", required=True),
        "case": Key(
            text,
            '["soft", "stiff*"]',
            "Names of the cases to check, or patterns with * and ?; all if it is not given.",
            many=True,
        ),
        "scale": Key(
            positive,
            "1.0",
            "Scales of the motions to check, each a suite of its own; all if it is not given.",
            many=True,
        ),
        "overturned": Key(
            choice(*COUNTING),
            '"infinite"',
            'How an overturned run counts: "infinite", beyond any limit; "unknown", any value from the known one upwards; '
            '"value", as the table has it; "left out". "infinite" if it is not given.',
        ),
        "flight": Key(
            choice(*COUNTING), '"unknown"', 'How a run counts that was ended by flight; "unknown" if it is not given.'
        ),
        "failed": Key(
            choice(*COUNTING),
            '"unknown"',
            'How a run counts that has not settled, or was not run; "unknown" if it is not given.',
        ),
        "other_law": Key(
            boolean,
            "true",
            "Whether nothing passes without the settlement by the other spring law; where both were run the worse counts.",
        ),
        "confirm": Key(
            choice(*CONFIRMED),
            '["at_most"]',
            "Keys of this check that are right though such a limit decides nothing.",
            many=True,
        ),
    },
    many=True,
    homes=(Rule,),
    also=names(
        {
            "at_most": "limit max maximum threshold allowable value lessthan upper upperlimit",
            "at_least": "min minimum greaterthan",
            "demand": "quantity edp measure response parameter variable",
            "statistic": "stat aggregate",
            "reason": "source reference clause comment note notes description why because",
            "name": "id label title",
        }
    ),
    instead=names(
        {
            'write statistic = "median" or "p84"': "percentile quantile fractile",
            "the unit stands in the name of the demand, as in heel_uplift_mm; leave it out": "unit units",
            "both polarities of a study are mirror images, of which each run counts once; leave it out": "polarity "
            "polarities sign",
        }
    ),
)
"""A [[check]]; :class:`Rule` says what its keys mean."""


def _unknown_words(rule: Rule) -> list[Problem]:
    """Return a problem for each attribute that is not one of the words of its key; None, numbers and lists are not looked at."""
    wrong = []
    for name, key in CHECK.items():
        value = getattr(rule, name)
        if value is None or key.many or not isinstance(key.kind, Choice):
            continue
        try:
            key.kind(value)
        except KindError as error:
            text = f"{name} = {shown(value)}: {error.advice()}"
            wrong.append(Problem(name, value, text, kind=WrongType, named=False))
    return wrong


def _misfits(rule: Rule) -> list[Problem]:
    """Return a problem for each contradiction between the attributes of a rule, with one of these as its key; [] for none."""
    wrong = (*_wrong_limit(rule), *_wrong_threshold(rule), *_wrong_for_code(rule), *_wrong_for_demand(rule))
    problems = [Problem(key, None, text, kind=Contradiction, named=False) for key, text in wrong]
    demand, code = DEMANDS[rule.demand], rule.counts_unacceptable
    without_effect: list[tuple[bool, Iterable[str], str]] = [
        (demand.per_case, ("statistic", "least", "count"), f"{rule.demand} is the same for all records"),
        (not demand.per_run, USUAL, f"says nothing about {rule.demand}"),
        (demand.per_run and code, USUAL, "is unacceptable by ASCE 7-16"),
    ]
    for applies, attributes, reason in without_effect:
        given = [name for name in attributes if getattr(rule, name) is not None] if applies else []
        problems += [Problem(name, None, f"{reason}; leave it out", kind=Contradiction) for name in given]
    return problems


def _wrong_limit(rule: Rule) -> Iterator[tuple[str, str]]:
    """Yield problems of the limit, each with its attribute: none, two, on the wrong side, or not finite."""
    if rule.at_most is not None and rule.at_least is not None:
        yield "at_least", "at_least: given beside at_most; keep one, and write the other as a check of its own"
    if rule.at_most is None and rule.at_least is None:
        least = {"eta": 2.0, "yield_kN": 4e4, "stiffness_kN_m": 2e6}.get(rule.demand)
        key, example = ("at_most", 0.5) if least is None else ("at_least", least)
        yield key, f"{key} is missing, the limit; write for example {key} = {example:.10g}"
    elif rule.at_most is None and not DEMANDS[rule.demand].per_case:
        limit = rule.limit
        yield "at_least", f"at_least = {limit:g}: more of {rule.demand} is worse; write at_most = {limit:g}"
    elif not math.isfinite(rule.limit):
        yield rule.bound_key, f"{rule.bound_key} = {rule.limit:g}: must be a finite number"


def _wrong_threshold(rule: Rule) -> Iterator[tuple[str, str]]:
    """Yield a problem if ``above`` is missing for a "count" of runs by a quantity, or given with another statistic."""
    demand = DEMANDS[rule.demand]
    if rule.above is not None and rule.statistic != "count":
        yield "above", 'above: is for statistic = "count"; leave it out'
    if rule.above is None and rule.statistic == "count" and not (demand.event or demand.per_case):
        yield "above", "above is missing, what a record has to exceed to count; write for example above = 0.5"


def _wrong_for_code(rule: Rule) -> Iterator[tuple[str, str]]:
    """Yield contradictions to what the statistic, or its code, asks of the records, each with its attribute."""
    statistic = STATISTICS[rule.statistic or "max"]
    if rule.least is not None and rule.least < statistic.least:
        asks = f"{statistic.code or 'a statistic'} asks for {statistic.least}"
        yield "least", f"least = {rule.least}: {asks}; leave it out"
    if rule.count == "component" and statistic.code:
        yield (
            "count",
            f'count = "component": {statistic.code} asks for {statistic.least} motions, and the components of a station are '
            'one; write count = "station" in this check, or a statistic of no code, such as "mean"',
        )
    if rule.per_event is not None and not statistic.code:
        yield "per_event", "per_event: is for a code's statistic; leave it out"
    if DEMANDS[rule.demand].event and rule.statistic not in (None, *OF_EVENTS):
        text = f'statistic = "{rule.statistic}": is for quantities, and {rule.demand} is yes or no'
        yield "statistic", f"{text}; write {' or '.join(map(shown, OF_EVENTS))}"


def _wrong_for_demand(rule: Rule) -> Iterator[tuple[str, str]]:
    """Yield attributes that do not apply to the demand, or are missing for it, each with the problem."""
    demand = DEMANDS[rule.demand]
    if demand.in_section and rule.at_m is None:
        yield "at_m", "at_m is missing, the height of the section [m]; write for example at_m = 7.5"
    if not demand.in_section and rule.at_m is not None:
        yield "at_m", "at_m: is for demands in a section, such as section_moment_kNm; leave it out"
    yield from _wrong_capacity(rule)
    if rule.both_axes not in (None, "greater") and not demand.directed:
        yield (
            "both_axes",
            f"both_axes: {rule.demand} does not add up over the axes, and the greater counts; leave it out",
        )
    if rule.other_law and demand.other_end is None:
        ranges = " and ".join(name for name, candidate in DEMANDS.items() if candidate.other_end)
        yield "other_law", f"other_law: is for {ranges}; leave it out"


def _wrong_capacity(rule: Rule) -> Iterator[tuple[str, str]]:
    """Yield problems of the capacity: missing, given for another demand, no curve, or with a limit that is no share of it."""
    demand, given = DEMANDS[rule.demand], rule.capacity
    if demand.over_capacity and given is None:
        points, example = "points [N, M] in kN and kN m", CHECK["capacity"].example
        if not demand.in_section:
            points, example = "a line, or points [N, V] in kN", "{ per_N = 0.6 }"
        yield "capacity", f"capacity is missing, {points}; write for example capacity = {example}"
    if given is None:
        return
    if demand.over_capacity:
        yield from (("capacity", f"capacity {problem}") for problem in capacity.problems(rule.curve or ()))
    elif not isinstance(given, float):
        curves = " and ".join(name for name, candidate in DEMANDS.items() if candidate.over_capacity)
        yield "capacity", f"capacity: a curve is for {curves}; write a number, or leave it out"
    elif not demand.per_run or rule.statistic == "count":
        yield "capacity", f"capacity: {rule.demand} has none that it uses a share of; leave it out"
    elif not given > 0.0:
        yield "capacity", f"capacity = {given:g}: must be above 0"
    elif rule.at_most is not None and rule.at_most > MOST_SHARE:
        share = f"{rule.at_most / given:.3g}"
        yield (
            "at_most",
            f"at_most = {rule.at_most:g}: is a share of the capacity; write at_most = {share}, or leave capacity out",
        )
