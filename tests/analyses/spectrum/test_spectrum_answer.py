"""The first sentences of spectra and maps name the worst of all panels, and say what leaves it open."""

import math

import pandas as pd
import pytest

from rockbatch.analyses.spectrum.answer import answer, of_maps, of_spectra
from rockbatch.analyses.spectrum.command import shown_maps

INFO = {"axis": "two_pi_over_p_s", "varied": ["alpha", "two_pi_over_p_s"], "motions": 3, "varied_map": []}


def suite(*rows, count=3, axis="two_pi_over_p_s", **more):
    """Points (case, α, size, number that overturns, median)."""
    points = [
        {"case": case, "scale": 1.0, "alpha": alpha, "two_pi_over_p_s": size, "p": 2 * math.pi / size, axis: size, "count": count}
        | {"overturned": fell, "flight": 0, "failed": 0}
        | {"median": median, "p16": math.nan, "p84": math.nan}
        | more
        for case, alpha, size, fell, median in rows
    ]  # fmt: skip
    return pd.DataFrame(points)


def test_the_largest_piers_that_overturn_are_of_the_worst_panel():
    """On rock those with α = 0.1 overturn up to 6 s, on pads those with α = 0.2; a smaller one that stands is none of them."""
    sentences, remarks = of_spectra(
        INFO,
        suite(
            ("rock", 0.1, 4, 0, 0.9), ("rock", 0.1, 6, 2, math.inf), ("rock", 0.1, 8, 0, 0.3),
            ("rock", 0.2, 4, 1, 0.8), ("rock", 0.2, 6, 0, 0.4), ("rock", 0.2, 8, 0, 0.2),
            ("pads", 0.1, 4, 1, 0.7), ("pads", 0.1, 6, 0, 0.5), ("pads", 0.1, 8, 0, 0.3),
            ("pads", 0.2, 4, 0, 0.9), ("pads", 0.2, 6, 1, 0.95), ("pads", 0.2, 8, 0, 0.2),
        ),
    )  # fmt: skip
    assert [each.replace("\u00a0", " ") for each in sentences] == [
        "The largest piers that overturn under one or more of 3 motions have 2π/p = 6 s and 6 s for α = 0.1 and 0.2 rad, under "
        "half of them 6 s and none, in the worst of 2 panels.",
        "The greatest median rotation of those that stand is θ_max/α = 0.95, at 2π/p = 6 s, α = 0.2 rad, pads.",
    ]
    assert not remarks


def test_a_case_without_the_key_that_others_vary_is_a_panel_and_is_named():
    """Rigid ground has no β; one with the same β is the same panel."""
    info = INFO | {"varied": [*INFO["varied"], "beta"]}
    pads, rock = suite(("pads", 0.1, 4, 1, 0.7), beta=40.0), suite(("rock", 0.1, 4, 0, 0.9), beta=math.nan)
    largest, greatest = of_spectra(info, pd.concat([pads, rock]))[0]
    assert largest.endswith(", in the worst of 2 panels.")
    assert greatest.endswith(", rock.")
    same, other = pd.concat([pads, pads.assign(median=0.9)]), pd.concat([pads, pads.assign(beta=math.nan)])
    assert [of_spectra(info, each)[0][0].endswith(" of 2 panels.") for each in (same, other)] == [False, True]


@pytest.mark.parametrize(("motions", "words"), [(3, "any of 3 motions"), (1, "one motion")])
def test_where_nothing_overturns_that_is_said_and_one_motion_has_no_median(motions, words):
    (stands, greatest), _ = of_spectra(INFO | {"motions": motions}, suite(("rock", 0.1, 4, 0, 0.9), count=motions))
    assert stands == f"No pier overturns under {words}."
    assert ("median" in greatest) == (motions > 1)


@pytest.mark.parametrize(("quantiles", "words"), [
    ({}, "0.95, at"), ({"p16": 0.475, "p84": math.inf}, "0.95 (16 to 84 %: 0.475 to overturned), at"),
])  # fmt: skip
def test_quantiles_are_said_where_there_are_some(quantiles, words):
    (_, greatest), _ = of_spectra(INFO | {"motions": 6}, suite(("pads", 0.2, 6, 1, 0.95), **quantiles))
    assert f"is θ_max/α = {words} 2π/p" in greatest


def test_larger_piers_than_the_largest_that_overturns_may_overturn_too():
    sentences, remarks = of_spectra(INFO, suite(("rock", 0.1, 4, 3, math.inf), ("rock", 0.1, 8, 2, math.inf)))
    assert len(sentences) == 1
    assert remarks == ["The largest piers that were run overturn: larger ones may, too."]


def test_over_p_the_largest_pier_has_the_least():
    points = suite(("rock", 0.1, 4, 1, 0.7), ("rock", 0.1, 6, 1, 0.6), ("rock", 0.1, 8, 0, 0.5))
    (largest, _), remarks = of_spectra(INFO | {"axis": "p", "varied": ["alpha", "p"]}, points)
    assert "have p = 1.05 rad/s for" in largest.replace("\u00a0", " ")
    assert not remarks


def test_flights_and_failed_runs_are_counted_below():
    _, remarks = of_spectra(INFO, suite(("rock", 0.1, 4, 0, 0.7), ("rock", 0.1, 6, 0, 0.6), flight=1, failed=2))
    assert remarks == [
        "The largest piers that were run overturn: larger ones may, too.",
        "2 of 10 runs were ended by flight, and count as overturned.",
        "4 of 10 runs failed, and are left out here.",
    ]


def regions(*rows, name="one-sine"):
    """Regions (case, frequency, outcome, low, high)."""
    return pd.DataFrame(rows, columns=["case", "omega_p_over_p", "outcome", "low", "high"]).assign(map=name)


FELL, OUTRIGHT = "overturned with impact", "overturned without impact"
ROCK = [
    ("rock", 1.0, "safe", 1, 2.5), ("rock", 1.0, FELL, 2.5, 9), ("rock", 2.0, "safe", 1, 2.1), ("rock", 2.0, OUTRIGHT, 2.1, 9),
    ("rock", 3.0, "safe", 1, 9),
]  # fmt: skip


def test_the_least_amplitude_is_that_of_the_worst_case_with_its_frequency():
    pads = [
        ("pads", 1.0, "safe", 1, 9), ("pads", 2.0, "safe", 1, 1.5), ("pads", 2.0, FELL, 1.5, 9), ("pads", 3.0, "safe", 1, 9),
    ]  # fmt: skip
    (said,), remarks = of_maps(INFO, regions(*ROCK, *pads))
    assert (
        said
        == "The least one-sine that overturns the pier has a_p/(g tan α) = 1.5, at ω_p/p = 2, for pads, the least of 2 cases."
    )
    assert not remarks


@pytest.mark.parametrize(
    ("row", "remark"),
    [
        (("rock", 2.5, FELL, 1.0, 9),
         "one-sine: that is the least amplitude of the map, and lower ones may overturn the pier, too."),
        (("rock", 3.0, FELL, 1.7, 9),
         "one-sine: that is at the end of the map's frequencies, and beyond it less may overturn the pier."),
        (("rock", 2.5, "flight", 1.2, 9), "one-sine: from a_p/(g tan α) = 1.2 on, at ω_p/p = 2.5, the run ends by flight."),
        (("rock", 2.5, "undecided", 1.2, 1.3),
         "one-sine: from a_p/(g tan α) = 1.2 on, at ω_p/p = 2.5, it is not decided whether the pier overturns."),
    ],
)  # fmt: skip
def test_what_may_overturn_below_the_least_amplitude_is_said(row, remark):
    _, remarks = of_maps(INFO, regions(*ROCK, row))
    assert remarks == [remark]


def test_a_map_in_which_nothing_overturns_says_how_far_it_reaches():
    (said,), remarks = of_maps(INFO, regions(("rock", 1.0, "safe", 1, 9), ("pads", 3.0, "flight", 1, 9)))
    assert said == "No one-sine of ω_p/p = 1 to 3, up to a_p/(g tan α) = 9 overturns the pier, in any of 2 cases."
    assert remarks == ["one-sine: from a_p/(g tan α) = 1 on, at ω_p/p = 3, the run ends by flight."]


def test_cases_that_overturn_alike_are_counted():
    other = [("pads", *row[1:]) for row in ROCK]
    (said,), _ = of_maps(INFO, regions(*ROCK, *other))
    assert said.endswith("at ω_p/p = 2, for 2 of 2 cases.")


def test_of_many_maps_the_worst_has_a_sentence():
    maps = [regions(("rock", 1.0, "safe", 1, 9), name="none")]
    maps += [regions(*((*row[:3], row[3] + n, 9) for row in ROCK), name=f"map {n}") for n in (3, 1, 2)]
    (said,), _ = of_maps(INFO, pd.concat(maps))
    assert said.startswith(
        "The least map 1 that overturns the pier has a_p/(g tan α) = 3.1, at ω_p/p = 2, the least of 4 maps."
    )


@pytest.mark.parametrize(
    ("frequencies", "printed"),
    [
        ([1.0, 1.1, 1.2, 10.0], [1.0, 1.1, 1.2, 10.0]),
        (range(1, 13), range(1, 13)),
        (range(1, 35), range(1, 35, 3)),  # twelve that are evenly spaced from 1 to 34
        ([*range(1, 35, 3), 1.1, 1.2, 33.9], range(1, 35, 3)),
    ],
)
def test_the_terminal_has_the_regions_of_every_map_at_up_to_twelve_frequencies(frequencies, printed):
    rows = [
        row
        for x in sorted(map(float, frequencies))
        for row in (("rock", x, "safe", 1.0, 2.25), ("rock", x, FELL, 2.25, 9.0))
    ]
    pads = [("pads", 2.0, "safe", 1.0, 9.0)]
    blocks = shown_maps(INFO, pd.concat([regions(*rows), regions(*pads, name="ricker")])).split("\n\n")
    of_rock = f"1 to 2.25 safe; 2.25 to 9 {FELL}"
    heads, lines = zip(*((head, lines) for head, *lines in map(str.splitlines, blocks)), strict=True)
    assert [head.split(";")[0] for head in heads] == ["one-sine, rock", "ricker, pads"]
    assert [line.split(maxsplit=3) for line in lines[0]] == [
        ["omega_p/p", "=", f"{x:.4g}", of_rock] for x in map(float, printed)
    ]
    assert [line.split(maxsplit=3) for line in lines[1]] == [["omega_p/p", "=", "2", "1 to 9 safe"]]


def test_only_symbols_get_subscripts_and_names_are_text():
    page = answer(["θ_max/α in soft_pads, <b>, of a_p and sigma_p."], ["ω_p"])
    assert "θ<sub>max</sub>/α in soft_pads, &lt;b&gt;, of a<sub>p</sub> and sigma_p." in page
    assert '<span class="undecided">ω<sub>p</sub></span>' in page
