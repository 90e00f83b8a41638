"""The capacity of a record: the first exceedance among its levels, bisected, and what undecided runs leave open."""

import math

import pytest

from rockbatch.analyses.fragility.ida import Bracket, Capacity, bisect, capacity, hunt
from rockbatch.analyses.fragility.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD

LEVELS = [0.2, 0.4, 0.6, 0.8, 1.0]


def capacity_of(states):
    return capacity(dict(zip(LEVELS, states, strict=True)), LEVELS)


def test_runs_beyond_the_levels_are_no_part_of_the_hunt():
    """A window about the highest level ends above it, where a capacity that the levels do not reach stays open."""
    looks = {0.39: EXCEEDED, 0.4: WITHSTOOD, 0.8: WITHSTOOD, 0.81: EXCEEDED}
    assert capacity(looks, [0.4, 0.8]).decided == (0.8, math.inf)


def decided(low, high, returns=0, widest_step=1.0):
    return Capacity(*3 * (Bracket(low, high),), undecided=0, returns=returns, widest_step=widest_step)


def test_the_first_exceedance_counts_and_what_withstands_above_it_is_counted():
    assert capacity_of([0, 0, 2, 0, 2]) == decided(0.4, 0.6, returns=1)
    assert capacity_of([2, 2, 2, 2, 2]) == decided(0.0, 0.2, widest_step=0.0)
    assert capacity_of([0, 0, 0, 0, LEFT_OUT]) == decided(0.8, math.inf)
    assert capacity_of([LEFT_OUT] * 5) is None


def test_an_undecided_level_is_neither_exceeded_nor_withstood():
    for states, brackets, undecided, returns, widest_step in (
        ([0, LEFT_OUT, 1, 2, 2], ((0.2, 0.8), (0.2, 0.6), (0.6, 0.8)), 1, 0, pytest.approx(2.0)),
        ([1, 0, 0, 0, 1], ((0.8, math.inf), (0.0, 0.2), (1.0, math.inf)), 2, 0, 1.0),
        ([0, 1, 0, 2, 0], ((0.6, 0.8), (0.2, 0.4), (0.6, 0.8)), 1, 1, 1.0),
    ):
        assert capacity_of(states) == Capacity(*brackets, undecided, returns, widest_step)
    assert capacity_of([0, 2, 1, 1, 2]) == decided(0.2, 0.4)


def bisected(looks, tolerance, look):
    """Capacities by key; ``look`` gives the state at a key and an intensity. And the waves, as lists of keys."""
    waves = []

    def wave(wanted):
        waves.append([key for key, _ in wanted])
        return [look(*each) for each in wanted]

    levels = sorted({x for each in looks.values() for x in each})
    found = bisect(looks, levels, tolerance, wave)
    return {key: capacity(each, levels) for key, each in found.items()}, waves


def test_bisection_goes_in_waves_and_closes_every_bracket_to_the_tolerance():
    truth = {"a": 0.41, "b": 0.5999}
    start = {"a": {0.4: 0, 0.8: 2}, "b": {0.4: 0, 0.8: 2}, "c": {0.8: 2}, "d": {0.4: 0, 0.8: 0}}
    found, waves = bisected(start, 0.01, lambda key, x: EXCEEDED if x >= truth[key] else WITHSTOOD)
    for key in "ab":
        assert found[key].decided.low < truth[key] <= found[key].decided.high <= 1.01 * found[key].decided.low
    assert (found["c"], found["d"]) == (decided(0.0, 0.8, widest_step=0.0), decided(0.8, math.inf))
    assert waves == [["a", "b"]] * 7  # ln 2 / ln 1.01 = 69.7 < 2⁷


def test_the_hunt_finds_a_window_below_the_first_level_that_exceeds():
    """Both overturn from 0.243 to 0.25 and from 0.7 on; a step of 2 % is narrower than that window, the levels are not."""
    seen = []

    def look(wanted):
        seen.extend(wanted)
        return [EXCEEDED if 0.243 <= x < 0.25 or x >= 0.7 else WITHSTOOD for _, x in wanted]

    levels = [0.2, 0.4, 0.8, 1.0]
    on_levels = {key: {0.2: 0, 0.4: 0, 0.8: 2, 1.0: 2} for key in "ab"}
    found = hunt(on_levels, levels, {"a": 0.02, "b": None}.get, look)
    hunted, alone = (capacity(found[key], levels) for key in "ab")
    assert hunted.decided.low < 0.243 <= hunted.decided.high <= min(0.25, 1.02 * hunted.decided.low)
    assert hunted.widest_step <= 0.02 + 1e-12
    assert (alone.decided, alone.widest_step) == ((0.4, 0.8), 1.0)
    assert {key for key, _ in seen} == {"a"}
    assert max(x for _, x in seen) < 0.8  # above the first exceedance on the levels nothing is looked at


def test_bisection_goes_on_beyond_what_is_undecided_to_both_of_its_ends():
    """Withstood up to 0.5, exceeded from 0.6 on, and nothing is known in between: that is what the capacity says."""
    found, _ = bisected(
        {"a": {0.4: WITHSTOOD, 0.8: EXCEEDED}}, 1e-3,
        lambda _, x: WITHSTOOD if x < 0.5 else UNDECIDED if x < 0.6 else EXCEEDED,
    )  # fmt: skip
    one = found["a"]
    assert one.if_exceeded.low < 0.5 <= one.if_exceeded.high <= 1.001 * one.if_exceeded.low
    assert one.if_withstood.low < 0.6 <= one.if_withstood.high <= 1.001 * one.if_withstood.low
    assert one.decided == (one.if_exceeded.low, one.if_withstood.high)


def test_an_undecided_level_does_not_move_the_capacity_of_the_bisection():
    found, _ = bisected({"a": {0.2: WITHSTOOD, 0.4: UNDECIDED, 0.8: EXCEEDED}}, 1e-3, lambda _, x: 2 if x >= 0.7 else 0)
    one = found["a"]
    assert one.if_withstood.low < 0.7 <= one.if_withstood.high == one.decided.high
    assert one.if_exceeded.high == 0.4 <= 1.001 * one.if_exceeded.low  # it may have been an island, however narrow
