"""The first sentences of a fragility name the weakest of all curves, and say what leaves it open."""

import html
import re

import pytest

from rockbatch.analyses.fragility.answer import of_curves, of_rates

LEVELS = (0.2, 0.5, 1.0, 2.0)
INFO = {
    "method": "stripes", "measure": "PGV", "unit": "m/s", "levels": LEVELS, "confidence": 0.95, "records": 10, "stations": 10,
}  # fmt: skip


BELOW = {"is": "below", "above": None, "below": 0.2, "confidence": 0.95}
EVERY = "every record exceeds the limit from 0.2 on"


def curve(case="rigid", limit="overturning", median=None, exceeded=(0, 2, 6, 9), interval=None, **more):
    """A curve of ten records, of which so many exceed the limit at each level."""
    undecided = more.pop("undecided", (0, 0, 0, 0))
    points = [
        {"level": level, "records": 10, "exceeded": over, "undecided": unknown}
        for level, over, unknown in zip(LEVELS, exceeded, undecided, strict=True)
    ]
    return {
        "case": case, "columns": {}, "limit_state": limit, "words": "" if limit == "overturning" else "theta > 1",
        "median": median, "median_interval": interval or (median and [0.8 * median, 1.3 * median]), "points": points,
        "dispersion": median and 0.4, "no_curve": None, "median_undecided": None, "says_little": False, "risk": None,
        "capacities": [], "undecided": {"runs": 40, "flight": 0, "failed": sum(undecided), "other": 0, "lower": 0},
    } | more  # fmt: skip


def said(*curves, by=of_curves, **more):
    """What the page says, and what of it is marked."""
    answer = by(INFO | {"curves": list(curves)} | more)
    marked = re.findall(r'<span class="undecided">(.*?)</span>', answer)
    lines = re.findall(r"<p[^>]*>(.*?)</p>", answer)
    return [html.unescape(re.sub("<.*?>", "", line)).replace("\u00a0", " ") for line in lines], marked


def test_the_lowest_median_of_each_limit_is_said_whatever_the_order_of_cases():
    (line,), marked = said(
        curve("rock", median=1.4),
        curve("pads", median=1.0),
        curve("rock", "drift", median=0.9),
        curve("rock", "uplift", median=0.7),
        curve("pads", "uplift", median=0.4),
    )
    overturning, first = line.split(". ", 1)[0] + ".", line.split("cases (difference not significant). ")[-1]
    assert overturning == (
        "Overturning has a median of PGV 1 m/s (95 % from 10 records: 0.8 to 1.3) and a dispersion of 0.40 for pads, the lowest "
        "of 2 cases (difference not significant)."
    )
    assert first == (
        "The limit exceeded first, uplift (theta > 1), has a median of PGV 0.4 m/s (95 % from 10 records: 0.32 to 0.52) and a "
        "dispersion of 0.40 for pads, the lowest of 2 cases."
    )
    assert not marked


def test_a_limit_that_is_exceeded_after_overturning_is_not_called_the_first():
    (line,), _ = said(curve(median=0.6), curve(limit="settlement", median=0.9))
    assert line.endswith("dispersion of 0.40. No other limit has a lower median.")


NOT_KNOWN = {
    "below": {"exceeded": (10, 10, 10, 10), "median_bound": BELOW},
    "between": {"exceeded": (0, 0, 10, 10), "median_bound": BELOW | {"is": "between", "above": 0.5, "below": 1.0}},
    "above": {"exceeded": (0, 0, 0, 1), "median_bound": BELOW | {"is": "above", "above": 2.0, "below": None}},
}


@pytest.mark.parametrize(
    ("overturning", "other", "first"),
    [
        (0.6, 0.5, True), (0.6, 0.6, False), (0.6, 0.7, False), ("below", "below", True), ("below", 0.3, False),
        (1.1, "between", True), (0.9, "between", False), ("between", 0.9, True), ("between", 1.1, False),
        ("above", "above", False), ("above", 2.5, True), (0.6, "above", False),
    ],
)  # fmt: skip
def test_a_limit_is_exceeded_first_if_its_median_is_lower_or_below_all_levels(overturning, other, first):
    """Of a median between two levels the upper one counts; below all levels neither of two is known to be the lower."""
    known = [NOT_KNOWN.get(median) or {"median": median} for median in (overturning, other)]
    (line,), _ = said(curve(**known[0]), curve(limit="tilt", **known[1]))
    assert ("The limit exceeded first, tilt (theta > 1), has a median" in line) == first
    assert ("No other limit has a lower median." in line) != first


def test_a_curve_without_a_fit_that_is_weaker_than_all_others_comes_first():
    """Every record exceeds the limit at the lowest level on pads: their median is not known, but below that of rock."""
    (line,), marked = said(
        curve("rock", median=0.6), curve("pads", exceeded=(10, 10, 10, 10), median_bound=BELOW, no_curve=EVERY)
    )
    assert line == (f"Overturning has a median below PGV 0.2 m/s (95 %), for pads, the lowest of 2 cases: {EVERY}.")
    assert not marked
    (line,), _ = said(
        curve("rock", median=0.6), curve("rock", "tilt", exceeded=(10, 10, 10, 10), median_bound=BELOW, no_curve=EVERY)
    )
    assert line.endswith(
        "The limit exceeded first, tilt (theta > 1), has a median below PGV 0.2 m/s (95 %): " + f"{EVERY}."
    )


def test_no_limit_is_called_the_first_while_the_median_of_a_third_one_is_not_known():
    known, beside = (curve(median=0.6), curve(limit="tilt", median=0.4)), curve(limit="uplift", exceeded=(0, 1, 3, 4))
    (line,), _ = said(*known)
    assert "The limit exceeded first, tilt" in line
    line = said(*known, beside)[0][0]
    assert "exceeded first" not in line
    assert "The limit of the lowest median that is known, tilt (theta > 1), has a median of PGV 0.4 m/s" in line


@pytest.mark.parametrize(("cases", "words"), [(1, "10 records."), (2, "10 records, in any of 2 cases.")])
def test_a_limit_that_no_record_reaches_has_no_median_and_that_is_no_flaw(cases, words):
    (line,), marked = said(*(curve(f"case {n}", exceeded=(0, 0, 0, 0)) for n in range(cases)))
    assert line == f"Overturning is not reached up to PGV 2 m/s by any of {words}"
    assert not marked


def test_undecided_runs_at_the_highest_level_are_said_beside_the_limit():
    (line,), marked = said(curve(exceeded=(0, 0, 0, 0), undecided=(0, 0, 4, 10)))
    assert line == "Overturning is not reached up to PGV 1 m/s by any of 10 records; 14 of 40 runs undecided."
    assert marked == ["14 of 40 runs undecided"]


def test_without_a_decided_run_nothing_is_claimed():
    (line,), _ = said(curve(exceeded=(0, 0, 0, 0), undecided=(10, 10, 10, 10)))
    assert line == "Overturning is decided by no run; 40 of 40 runs undecided."
    nothing = curve(exceeded=(0, 0, 0, 0))
    nothing["points"] = [point | {"records": 0} for point in nothing["points"]]
    line, lost = said(nothing, curve(median=0.8))[0]
    assert "not reached" not in line
    assert lost == "1 of 2 curves has no median within the levels: the table says why."


def test_without_medians_the_weakest_case_is_where_half_exceed_first():
    pads, rock = curve("pads", exceeded=(4, 4, 4, 5)), curve("rock", exceeded=(3, 1, 4, 3), undecided=(0, 0, 2, 0))
    assert said(pads, rock)[0][0].startswith("Overturning has no median for rock")


def test_too_many_undecided_runs_are_said_with_the_median_that_they_allow():
    open_ = {"says_little": True, "median_undecided": [0.3, None], "undecided": (0, 5, 5, 0)}
    (line,), marked = said(curve(median=0.8, **open_))
    assert (
        "; too many runs are undecided to say much, 10 of 40 runs: with these on either side the median is 0.3 or more."
        in line
    )
    assert len(marked) == 1


def test_another_case_that_undecided_runs_may_make_weaker_is_named():
    open_ = {"says_little": True, "median_undecided": [0.3, 1.1], "undecided": (0, 5, 5, 0)}
    (line, little), _ = said(curve("rock", median=0.8), curve("pads", median=1.0, **open_))
    assert line.endswith("; pads may be weaker, down to 0.3, as runs of it are undecided.")
    assert little == "1 of 2 curves says little: too many runs are undecided."


@pytest.mark.parametrize(
    ("interval", "words"), [((0.5, None), "0.5 or more"), ((0.0, 2.5), "2.5 or less"), ((0.0, None), "open")]
)
def test_an_interval_without_a_bound_is_said_so(interval, words):
    (line,), _ = said(curve(median=0.8, interval=interval))
    assert f"(95 % from 10 records: {words})" in line


OF_FEW = {"exceeded": (5, 5, 5, 5), "no_curve": f"{EVERY}: a bound of the median takes 6 stations"}


def test_a_limit_that_most_exceed_at_the_lowest_level_comes_first():
    """Its median is not known, but below the levels for most of the records; half of them would not say so."""
    assert (
        "The limit exceeded first, tilt"
        in said(curve(median=0.2), curve(limit="tilt", **OF_FEW | {"exceeded": (6,) * 4}))[0][0]
    )
    assert "The limit exceeded first" not in said(curve(median=0.2), curve(limit="tilt", **OF_FEW))[0][0]


@pytest.mark.parametrize(
    ("other", "known"),
    [(OF_FEW, False), (OF_FEW | {"exceeded": (6,) * 4}, False), (NOT_KNOWN["between"], True), ({"median": 0.9}, True)],
)
def test_no_limit_and_no_case_is_called_the_lowest_beside_an_unknown_median(other, known):
    (line, *_), _ = said(curve(median=0.3), curve(limit="tilt", **other))
    assert ("No other limit has a lower median." in line) == known
    (line, *_), _ = said(curve("rock", median=0.3), curve("pads", **other))
    assert ("the lowest of 2 cases" in line, "one of 2 cases" in line) == (known, not known)


def test_of_two_cases_below_all_levels_none_is_called_the_lowest():
    (line,), _ = said(curve("rock", **NOT_KNOWN["below"]), curve("pads", **NOT_KNOWN["below"]))
    assert ", for rock, one of 2 cases: " in line


@pytest.mark.parametrize(
    ("median", "beyond"), [(0.1, True), (0.2 - 1e-16, False), (0.2, False), (2.0 + 4e-16, False), (3.4, True)]
)
def test_a_median_beyond_the_levels_is_called_an_extrapolation(median, beyond):
    _, marked = said(curve(median=median))
    assert marked == ["an extrapolation, as runs are at 0.2 to 2 m/s"] * beyond


def test_a_curve_whose_shares_do_not_grow_has_no_median():
    (line,), _ = said(curve(exceeded=(4, 3, 4, 3)))
    assert line == "Overturning has no median: no curve could be fitted."


def test_a_cloud_with_few_records_beyond_the_limit_says_how_few():
    (line,), _ = said(curve(median=0.8, exceeded=(0, 0, 1, 1), cloud={}), method="cloud", records=2, stations=2)
    assert line.endswith("from 40 records: 0.64 to 1.04) and a dispersion of 0.40; only 2 records beyond the limit.")


def test_what_intervals_count_and_what_makes_medians_too_high_is_a_line_each():
    alone = {"looked": [[level, level] for level in LEVELS[:2]]}
    lines, marked = said(curve("pads", median=0.8, **alone), curve("rock", median=0.9, looked=[[0.2, 2.0]]), stations=5)
    assert lines[1:] == [
        "Intervals are by station: the 10 records are components of 5 stations.",
        "Between the levels nothing was run in pads: a first exceedance there is missed, and medians may be too high.",
    ]
    assert marked == lines[1:]
    many = [curve(f"pads {n}", median=0.8, **alone) for n in range(4)]
    assert "was run in pads 0, pads 1, pads 2: a" in said(*many[:3])[0][1]
    assert "was run in 4 cases: a" in said(*many)[0][1]


def rate(per_year, **more):
    return {
        "rate_per_year": per_year, "rate_low": 0.5 * per_year, "rate_high": 3 * per_year, "rate_if_withstood": None,
        "rate_if_exceeded": None, "bound": "", "rate_below_points": 0.0, "rate_above_points": 0.0, "rate_below_levels": 0.0,
        "rate_above_levels": 0.0, "p_in_50_years": 50 * per_year, "p_in_50_years_low": 25 * per_year, "p_in_50_years_high": 0.5,
    } | more  # fmt: skip


HAZARD = {"source": "", "years": [100.0, 50.0]}


def test_the_most_frequent_case_is_said_though_another_has_the_lower_median():
    (line,), marked = said(
        curve("rock", median=0.7, risk=rate(1e-4)),
        curve("pads", median=0.9, risk=rate(2e-4)),
        curve("rock", "drift", median=1.5, risk=rate(1e-5)),
        curve("pads", "uplift", median=0.3, risk=rate(1e-3)),
        by=of_rates, hazard=HAZARD | {"source": "made up"},
    )  # fmt: skip
    assert line == (
        "With the hazard “made up” overturning has a probability of 1 % in 50 years (95 %: 0.5 to 50 %) for pads, the greatest "
        "of 2 cases (difference not significant), a mean rate of 2.0·10⁻⁴ a year. Uplift has a probability of 5 % in 50 years "
        "(95 %: 2.5 to 50 %), a mean rate of 1.0·10⁻³ a year."
    )
    assert not marked


def test_a_curve_without_a_rate_may_be_the_worst_and_is_counted():
    (line, lost), marked = said(
        curve("rock", exceeded=(10, 10, 10, 10)), curve("rock", "uplift", risk=rate(1e-3)), by=of_rates, hazard=HAZARD
    )
    assert line.startswith(
        "Overturning has no rate: it needs a curve, or an upper bound of the median. Uplift has a probability of 5 %"
    )
    assert lost == "1 of 2 curves without a rate: their limits may be exceeded more often."
    assert marked == [lost]


def test_a_rate_says_what_it_rests_on_and_what_leaves_it_open():
    open_ = {"rate_high": None, "rate_above_points": 3e-5, "rate_below_levels": 5e-5}
    readings = {"rate_if_withstood": 1e-5, "rate_if_exceeded": None}
    (line,), marked = said(
        curve(median=0.7, says_little=True, risk=rate(1e-4, **open_, **readings)), by=of_rates, hazard=HAZARD
    )
    assert marked == [
        "the records leave its upper bound open",
        "undecided runs leave it between 1.0·10⁻⁵ and no bound a year",
        "30\u00a0% of it from an extrapolated hazard",
        "50\u00a0% of it from intensities that were not run",
    ]
    assert line.endswith("were not run.")


def test_names_of_limits_and_hazards_are_text_and_no_elements():
    """fragility.json may come from anybody."""
    fitted = curve("rock", limit="<b>uplift</b>", median=0.3, risk=rate(1e-3))
    answers = (
        of_curves(INFO | {"curves": [curve(median=0.7), fitted]}),
        of_rates(INFO | {"curves": [curve(limit="<b>"), fitted], "hazard": HAZARD | {"source": "<b>"}}),
    )
    for answer in answers:
        assert "&lt;b&gt;" in answer
        assert "<b>" not in answer


def test_a_record_that_exceeds_between_levels_does_not_count_as_withstanding():
    (line,), _ = said(curve(exceeded=(0, 0, 0, 0), capacities=[[0.5, 0.6], [2.0, None]]), method="ida")
    assert line == "Overturning has no median: no curve could be fitted."


def test_records_that_differ_from_level_to_level_are_said_as_a_range():
    fewer = curve(median=0.8)
    fewer["points"][3]["records"] = 9
    (line,), _ = said(fewer)
    assert "(95 % from 9 to 10 records a level: " in line


def test_of_several_cases_that_may_be_weaker_the_one_that_may_be_weakest_is_named():
    open_ = [
        {"says_little": True, "median_undecided": bounds, "undecided": (0, 5, 5, 0)}
        for bounds in ([0.5, 0.6], [0.3, 1.1])
    ]
    (line, _), _ = said(
        curve("rock", median=0.8), curve("mats", median=1.0, **open_[0]), curve("pads", median=1.0, **open_[1])
    )
    assert line.endswith("; pads may be weaker, down to 0.3, as runs of it are undecided.")
    (line, _), _ = said(curve("rock", median=0.25), curve("pads", median=1.0, **open_[1]))
    assert "weaker" not in line


@pytest.mark.parametrize(
    ("interval", "overlaps"),
    [((0.78, 2.0), True), ((0.8, 2.0), True), ((0.82, 2.0), False), ((None, 2.0), True), ((0.0, None), True)],
)
def test_intervals_overlap_where_another_median_may_be_as_low(interval, overlaps):
    for cases in ((interval,), ((1.5, 2.0), interval)):
        others = [curve(f"case {n}", median=1.0, interval=bounds) for n, bounds in enumerate(cases)]
        (line,), _ = said(curve("rock", median=0.6, interval=(0.4, 0.8)), *others)
        assert line.endswith(" (difference not significant).") == overlaps
    (line,), _ = said(curve("rock", median=0.6, interval=(0.4, None)), curve("pads", median=1.0, interval=(0.9, 2.0)))
    assert line.endswith(" (difference not significant).")


def test_a_rate_of_zero_rests_on_nothing_and_a_fifth_of_one_is_not_worth_a_word():
    (line,), marked = said(curve(median=0.7, risk=rate(0.0)), by=of_rates, hazard=HAZARD)
    assert line.startswith("Overturning has a probability of 0")
    assert not marked
    for share, named in ((0.19, False), (0.21, True)):
        for where in ("rate_below_points", "rate_above_points", "rate_below_levels", "rate_above_levels"):
            _, marked = said(curve(median=0.7, risk=rate(1e-4, **{where: share * 1e-4})), by=of_rates, hazard=HAZARD)
            assert len(marked) == named


@pytest.mark.parametrize("others", [[], [{"median_undecided": [0.5, 0.6]}]], ids=["alone", "beside one with bounds"])
def test_a_case_of_which_nothing_is_known_may_be_weaker_down_to_0(others):
    open_ = {"says_little": True, "undecided": (0, 5, 5, 0)}
    several = [curve(f"mats {i}", median=1.0, **(open_ | each)) for i, each in enumerate(others)]
    unknown = curve("pads", median=1.0, **open_, median_undecided=[None, 1.1])
    (line, _), _ = said(curve("rock", median=0.8), *several, unknown)
    assert line.endswith("; pads may be weaker, down to 0, as runs of it are undecided.")


def test_a_median_by_shares_that_is_far_from_the_other_stands_beside_it():
    for above, beside in ((0.38, True), (0.05, False)):
        windows = {"median": 0.8 * (1 + above), "above": above}
        (line,), _ = said(curve(median=0.8, windows=windows))
        assert (f"0.64 to 1.04), by shares PGV {0.8 * (1 + above):.3g} m/s (+38 %), and a disp" in line) == beside


def test_without_intervals_the_stations_stand_in_their_place():
    three = curve(median=0.8, stations=3) | {"median_interval": None}
    (line,), _ = said(three)
    assert "a median of PGV 0.8 m/s (from 10 records, no interval: 3 stations) and a dispersion of 0.40" in line


@pytest.mark.parametrize(
    ("exceeded", "words"),
    [
        ((0, 0, 0, 0), "No other limit is exceeded up to PGV 2 m/s."),
        ((0, 0, 0, 1), "No other limit has a lower median."),
    ],
)
def test_only_a_limit_that_no_record_exceeds_is_said_not_to_be_exceeded(exceeded, words):
    above = {"is": "above", "above": 2.0, "below": None, "confidence": 0.95}
    (line,), _ = said(curve(median=0.6), curve(limit="tilt", exceeded=exceeded, median_bound=above))
    assert line.endswith(words)


def bound(least):
    ends = {"rate_least": least, "rate_most": None, "p_in_50_years_low": 50 * least, "p_in_50_years_high": 1.0}
    unknown = dict.fromkeys(("rate_per_year", "rate_low", "rate_high", "p_in_50_years"))
    return rate(0.0) | unknown | {"bound": "at least"} | ends


def test_a_rate_that_is_a_bound_is_said_so_with_its_confidence():
    (line,), _ = said(curve(risk=bound(2e-4)), by=of_rates, hazard=HAZARD)
    chance = "at least 1 % in 50 years (95 %), a mean rate of at least 2.0·10⁻⁴ a year"
    assert line == f"Overturning has a probability of {chance}."


@pytest.mark.parametrize(("rock", "pads", "overlaps"), [
    ((1e-4, 2e-4), (2.1e-4, 4e-4), False), ((1e-4, 2.2e-4), (2.1e-4, 4e-4), True), ((1e-4, None), (2.1e-4, 4e-4), True),
    ((None, None), (2.1e-4, 4e-4), False), ((1e-4, 2.2e-4), (None, None), False), ((1e-4, 2e-4), (2.1e-4, None), False),
])  # fmt: skip
def test_intervals_of_rates_that_overlap_leave_open_which_is_the_greatest(rock, pads, overlaps):
    """As those of medians do, a page up, of which the lowest is not always that of the greatest rate."""
    known = [rate(per_year, rate_low=low, rate_high=high) for per_year, (low, high) in ((1e-4, rock), (3e-4, pads))]
    (line,), _ = said(curve("rock", risk=known[0]), curve("pads", risk=known[1]), by=of_rates, hazard=HAZARD)
    assert ("for pads, the greatest of 2 cases (difference not significant), a mean" in line) == overlaps


@pytest.mark.parametrize(
    ("rock", "pads", "rank", "open_"),
    [
        (rate(2e-4), bound(1e-4), "for rock, one", "; pads may exceed it more often"),
        (rate(2e-4), rate(1e-5), "for rock, the greatest", ""),
        (rate(2e-4), bound(3e-4), "for pads, one", ""),
        (bound(2e-4), bound(3e-4), "for pads, one", "; rock may exceed it more often"),
    ],
)
def test_the_greatest_rate_is_called_so_only_if_no_bound_leaves_it_open(rock, pads, rank, open_):
    (line,), marked = said(curve("rock", risk=rock), curve("pads", risk=pads), by=of_rates, hazard=HAZARD)
    assert f" {rank} of 2 cases, a mean rate of" in line
    assert open_ in line
    assert len(marked) == bool(open_)


@pytest.mark.parametrize(
    ("uplift", "named"),
    [(bound(1e-4), True), (rate(1e-4), False)],
)
def test_a_limit_that_may_be_exceeded_more_often_than_overturning_is_named(uplift, named):
    (line,), _ = said(curve(risk=rate(2e-4)), curve(limit="uplift", risk=uplift), by=of_rates, hazard=HAZARD)
    assert ("Uplift has a probability of" in line) == named
