"""Figures of the analyses show the numbers of their tables, each case in one look everywhere."""

import math

import numpy as np
import pandas as pd
import pytest
from figure_makers import makers
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.accuracy.figures import error_and_time
from rockbatch.analyses.accuracy.levels import of_table
from rockbatch.analyses.fragility import figures
from rockbatch.analyses.fragility.figures import clouds, curves, risk
from rockbatch.analyses.release.figures import rotations
from rockbatch.analyses.sensitivity.figures import INDICES, bars
from rockbatch.analyses.spectrum.figures import FELL, REGIONS, maps, spectra
from rockbatch.analyses.spectrum.map_regions import between, inside, strips
from rockbatch.common.figures.description import Area, Points, Polyline, Rule, Span, Words

pytestmark = pytest.mark.usefixtures("pages")

FRAGILITY = """
[[check]]
name = "settlement"
demand = "settlement_m"
at_most = 0.01
reason = "a test"
case = ["pads"]

[fragility]
measure = "PGA"
levels_g = [0.4, 0.8, 1.6]
"""
SPECTRUM = """
[spectrum]
alpha = [0.15, 0.2]
two_pi_over_p_s = [3.0, 8.0]
points = 3

[[spectrum.map]]
name = "sine"
shape = "sine"
frequency = [2.0, 6.0]
frequencies = 3
amplitude = [1.0, 8.0]
amplitudes = 4
tolerance = 0.1
width = 1.0
"""
SENSITIVITY = """
[sensitivity]
samples = 8

[sensitivity.uniform]
p = [0.9, 1.1]
alpha = [0.18, 0.22]
"""


def study(folder, tables, cases=(RIGID, PADS)):
    pulses = [SINE | {"name": f"sine {n}", "period_s": 0.4 + 0.2 * n} for n in range(3)]
    return write_study(folder, study_text(pulses=pulses, cases=cases) + tables)


def of_kind(marks, kind):
    return [mark for mark in marks if isinstance(mark, kind)]


def hold_plot(result, folder, *, beside=frozenset()):
    """Check that an analysis plots what its page draws, and the figures ``beside`` it, 160 mm wide."""
    plots = []
    made = makers(lambda: plots.append(result.plot()))
    assert plots[0].get_size_inches()[0] == pytest.approx(160.0 / 25.4)
    assert made - beside <= makers(lambda: result.save(folder / "out"))


def entry(case, limit="overturning", **more):
    """A curve of fragility.json at four levels: some undecided, all decided, none decided, and no record."""
    counts = ((0.2, 10, 1, 2), (0.5, 10, 4, 0), (0.8, 9, 0, 9), (2.0, 0, 0, 0))
    points = [dict(zip(("level", "records", "exceeded", "undecided"), of_level, strict=True)) for of_level in counts]
    points = [point | {"collapsed": 1, "flight": place, "failed": 0} for place, point in enumerate(points)]
    identity = {"case": case, "columns": {}, "limit_state": limit, "words": f"{limit} > 0.3", "points": points}
    return identity | {"capacities": []} | more


def test_the_marks_of_a_curve_share_one_label(monkeypatch):
    """The label, for which the list of cases is searched, was made anew for every level: 2 s for 3,000 cases."""
    shown = [entry("rock"), entry("pads")]
    info = {"measure": "PGA", "unit": "g", "levels": [0.2, 0.5, 0.8, 2.0], "curves": shown}
    real, asked = figures.label, []
    monkeypatch.setattr(figures, "label", lambda info, curve: asked.append(curve["case"]) or real(info, curve))
    (panel,) = curves(info).panels
    assert {mark.label for mark in of_kind(panel.marks, Points)} == {"rock", "pads"}
    assert asked == ["rock", "pads"] * 2  # once for the looks of all figures, once for the marks


def test_a_fragility_has_its_shares_and_one_look_for_each_case(tmp_path):
    x = [0.3, 0.6, 0.9]
    drawn = {"x": x, "p": [0.1, 0.4, 0.8], "low": [0.05, 0.3, 0.6], "high": [0.2, 0.5, 0.9]}
    windows = {"shares": [0.15, None, 0.55, None], "width": 0.02, "curve": {"x": x, "p": [0.2, 0.3, 0.7]}}
    capacities = [[0.1, 0.7], [0.1, 0.35], [0.8, None], [0.9, 5.0]]
    whole = {"curve": drawn, "total": {"x": x, "p": [0.15, 0.45, 0.75]}, "windows": windows, "capacities": capacities}
    whole["looked"] = [[0.2, 0.3], [0.5, 0.6]]
    unsure = {
        "open": {"x": x, "low": [0.0, 0.2, 0.5], "high": [0.3, 0.6, 1.0]},
        "capacities": capacities,
        "looked": [[0.2, 0.8]],
    }
    cases = [
        entry("rock"), entry("pads", **whole), entry("soil", **unsure), entry("sand"), entry("sand", columns={"beta": 30.0}),
    ]  # fmt: skip
    info = {"measure": "PGA", "unit": "g", "levels": [0.2, 0.5, 0.8, 2.0], "curves": [*cases, entry("pads", "uplift")]}
    first, second, third = curves(info).panels
    assert [panel.caption for panel in (first, second, third)] == ["overturning", "overturning", "uplift"]
    assert (first.x.low, first.x.high, first.y.low, first.y.last) == pytest.approx((0.0, 2.2, 0.0, 1.0))
    strips = [mark for mark in of_kind(first.marks, Polyline) if mark.y.min() > 1.0]
    assert [strip.x.tolist() for strip in strips] == [[0.2, 0.3], [0.5, 0.6], [0.2, 0.8]]
    heights = [height for strip in strips for height in strip.y]
    assert heights[0] == heights[1] == heights[2] == heights[3] < heights[4] == heights[5] < first.y.high
    assert first.y.high == pytest.approx(1.0 + 2.5 * (heights[0] - 1.0))
    assert second.y.high == 1.0

    looks = {mark.label: mark.look for mark in of_kind([*first.marks, *second.marks], Points)}
    names = {name.replace("\u00a0", " ") for name in looks}
    assert names == {"rock", "pads", "pads, by shares", "soil", "sand", "sand: β = 30"}
    of_uplift = of_kind(third.marks, Points)[0]
    assert of_uplift.look == looks["pads"]
    assert len({(look.colour, look.shape) for name, look in looks.items() if "," not in name}) == 5
    colour = looks["pads"].colour
    own = [mark for mark in first.marks if mark.look.colour == colour]
    (band,) = of_kind(own, Area)
    assert (band.look.kind, band.x.tolist()) == ("area", [*x, *x[::-1]])
    assert band.y.tolist() == [*drawn["low"], *drawn["high"][::-1]]
    lines = {mark.look.dash: mark for mark in of_kind(own, Polyline) if len(mark.x) > 2}
    for dash, of_line in ((0, drawn), (1, whole["total"]), (3, windows["curve"])):
        assert (lines[dash].x.tolist(), lines[dash].y.tolist()) == (x, of_line["p"])
    assert (lines[0].label, lines[3].label) == ("pads", "pads, by shares")
    assert lines[2].x == pytest.approx([0.0, 0.35, 0.35, 0.7, 0.7, 2.2, 2.2, 2.2])  # a record of four each
    assert lines[2].y == pytest.approx([0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75])
    bar, unknown = (mark for mark in of_kind(own, Polyline) if mark.title)
    assert (bar.x.tolist(), bar.y.tolist()) == ([0.2, 0.2], pytest.approx([0.1, 0.3]))
    assert (unknown.x.tolist(), unknown.y.tolist()) == ([0.8, 0.8], [0.0, 1.0])
    assert bar.title == "pads, 0.2: 1 of 10 records exceed the limit; 2 undecided; 1 overturned"
    shown = {mark.label: mark for mark in of_kind(own, Points)}
    assert (shown["pads"].x.tolist(), shown["pads"].y.tolist()) == ([0.2, 0.5], [1 / 8, 4 / 10])
    assert shown["pads"].titles == [bar.title, "pads, 0.5: 4 of 10 records exceed the limit; 1 overturned; 1 flew"]
    of_shares = shown["pads, by shares"]
    assert (of_shares.x.tolist(), of_shares.y.tolist(), of_shares.look.open) == ([0.2, 0.8], [0.15, 0.55], True)
    assert of_shares.look.shape == looks["pads"].shape
    assert of_shares.titles[1] == "pads, 0.8: 55% of the scales within ±2 % exceed the limit"
    (unsure_band,) = (mark for mark in of_kind(first.marks, Area) if mark.look.kind == "unsure")
    assert (unsure_band.look.colour, unsure_band.y.tolist()) == (looks["soil"].colour, [0.0, 0.2, 0.5, 1.0, 0.6, 0.3])
    assert not [mark for mark in first.marks if mark.look.colour == looks["soil"].colour and mark.look.dash == 2]
    result = rb.fragility(study(tmp_path, FRAGILITY))
    hold_plot(result, tmp_path)
    limits = [panel.caption for panel in curves(result.info).panels]
    alone = result.plot_fragility(limit=limits[-1])
    assert alone.get_title().startswith(limits[-1])
    with pytest.raises(rb.InputError, match=f'no panel "colapse"; there are {limits[0]}'):
        result.plot_fragility(limit="colapse")


def test_a_cloud_shows_demands_its_line_with_a_deviation_and_its_limit():
    kinds = ("line", 0.1), ("line", 0.2), ("below", 0.001), ("overturned", None), ("undecided", None)
    runs = [{"x": 0.2 * (n + 1), "counts": counts, "demand": demand} for n, (counts, demand) in enumerate(kinds)]
    line = {"ln_a": math.log(0.4), "b": 1.5, "sigma": 0.3}
    cloud = {"limit": 0.25, "floor": 0.005, "demand": "theta_max_over_alpha", "line": line, "runs": runs}
    shown = entry("pads", "rotation", cloud=cloud)
    others = [entry("rock", limit, cloud=cloud | change) for limit, change in (
        ("overturning", {"floor": None}), ("none", {"limit": 0.0}), ("any", {"limit": math.inf}), ("bare", {"line": None}),
    )]  # fmt: skip
    figure = clouds({"measure": "PGV", "unit": "m/s", "levels": [1.0], "curves": [entry("rock"), *others, shown]})
    assert [panel.caption for panel in figure.panels] == ["bare, rock", "rotation, pads"]
    panel = figure.panels[1]
    assert (panel.x.label, panel.y.label) == ("PGV [m/s]", "theta_max_over_alpha")
    (limit,) = of_kind(panel.marks, Rule)
    assert (limit.axis, limit.at.tolist()) == ("y", [0.25])
    below, through, above = sorted(of_kind(panel.marks, Polyline), key=lambda mark: np.nanmedian(mark.y / mark.x**1.5))
    for mark, factor, dash in ((through, 1.0, 0), (below, math.exp(-0.3), 2), (above, math.exp(0.3), 2)):
        assert (mark.x[0], mark.x[-1], mark.look.dash) == (
            pytest.approx(panel.x.low),
            pytest.approx(panel.x.high),
            dash,
        )
        up, top = 0.4 * factor * mark.x**1.5, 1.5 * 0.25
        np.testing.assert_allclose(mark.y, np.where((up <= top) & (up >= panel.y.low), up, np.nan))
    assert not np.isnan(through.y[0])
    assert np.isnan(above.y[-1])
    of_line, small, fell = of_kind(panel.marks, Points)
    assert (of_line.x.tolist(), of_line.y.tolist(), of_line.label) == ([0.2, 0.4], [0.1, 0.2], "pads")
    assert (small.x.tolist(), small.y.tolist(), small.titles) == ([pytest.approx(0.6)], [0.005], ["0.6 m/s, below"])
    assert (small.look.colour, small.look.shape, small.look.open) == (of_line.look.colour, "down", True)
    assert (fell.x.tolist(), fell.look.shape) == ([0.8], "overturned")
    assert max(0.25, 1.5 * 0.25) == panel.y.last < fell.y[0] < panel.y.high
    assert panel.y.low < 0.005
    assert of_line.titles == ["0.2 m/s, line: 0.1", "0.4 m/s, line: 0.2"]


def test_rates_have_the_hazard_and_where_each_limit_comes_from():
    hazard = {
        "levels": [0.1, 0.4],
        "rates": [1 / 50, 1 / 1000],
        "drawn": {"x": [0.05, 0.1, 0.8], "rate": [0.05, 0.02, 2e-4]},
    }
    densities = [
        {"x": [low, 0.3, high], "share": [0.1, share, 0.2]} for low, high, share in ((0.15, 0.6, 0.8), (0.2, 0.9, 0.5))
    ]
    cases = [entry(case, risk={"density": density}) for case, density in zip(("rock", "pads"), densities, strict=True)]
    cases += [entry("pads", "uplift", risk={}), entry("pads", "slip", risk={"density": densities[1]})]
    info = {"measure": "PGA", "unit": "g", "levels": [0.2], "curves": cases, "hazard": hazard}
    of_site, *of_limits = risk(info, cases).panels
    (curve,), (points,) = of_kind(of_site.marks, Polyline), of_kind(of_site.marks, Points)
    assert (curve.x.tolist(), curve.y.tolist()) == (hazard["drawn"]["x"], hazard["drawn"]["rate"])
    assert (points.x.tolist(), points.y.tolist()) == (hazard["levels"], hazard["rates"])
    assert points.titles[1] == "0.4 g: 0.001 per year, once in 1000 years"
    assert (of_site.x.low, of_site.x.high, of_site.x.log) == (0.05, 0.8, True)
    assert [panel.caption for panel in of_limits] == ["overturning", "uplift", "slip"]
    both, none, alone = of_limits
    lines = of_kind(both.marks, Polyline)
    assert [(line.label, line.x.tolist(), line.y.tolist()) for line in lines] == [
        (case["case"], density["x"], density["share"]) for case, density in zip(cases[:2], densities, strict=True)
    ]
    assert (both.x.low, both.x.high, both.x.log, both.y.low, both.y.high) == (0.15, 0.9, True, 0.0, pytest.approx(0.88))
    assert [rule.at.tolist() for rule in of_kind(both.marks, Rule)] == [[0.4]]  # 0.1 is out of the panel
    assert (of_kind(none.marks, Polyline), none.x.low < none.x.high, none.y.high) == ([], True, pytest.approx(1.1))
    assert of_kind(alone.marks, Polyline)[0].look == lines[1].look != lines[0].look


@pytest.fixture(scope="module")
def spectrum(tmp_path_factory):
    return rb.spectrum(study(tmp_path_factory.mktemp("spectrum"), SPECTRUM))


@pytest.mark.slow
def test_a_spectrum_has_a_panel_for_each_case_and_a_curve_for_each_slenderness(spectrum, tmp_path):
    result = spectrum
    figure = spectra(result.spectrum_suite, result.spectrum, result.info)
    assert [panel.caption for panel in figure.panels] == ["rigid", "pads"]
    lines = of_kind(figure.panels[0].marks, Polyline)
    suite = result.spectrum_suite[result.spectrum_suite["case"] == "rigid"]
    for colour, (_, rows) in enumerate(suite.groupby("alpha", sort=False), 1):
        for name, dash in (("median", 0), ("p84", 1), ("p16", 2)):
            (line,) = (line for line in lines if (line.look.colour, line.look.dash) == (colour, dash))
            np.testing.assert_array_equal(line.y, rows[name].replace(np.inf, np.nan))
    faint, top = [line for line in lines if line.label == "each record"], figure.panels[0].y.last
    runs = result.spectrum[result.spectrum["case"] == "rigid"].groupby(["alpha", "record"], sort=False)
    for line, (_, own) in zip(faint, runs, strict=True):
        shown = (own["status"] == "ok") & (own["theta_max_over_alpha"] <= top)
        np.testing.assert_array_equal(line.x, own["two_pi_over_p_s"])
        np.testing.assert_array_equal(line.y, own["theta_max_over_alpha"].where(shown))
    panels = [axes for axes in result.plot().axes if axes.lines]
    titles = [axes.get_title().rpartition(", ")[0] or axes.get_title() for axes in panels]
    assert titles == ["rigid", "pads", "sine (sine), rigid", "sine (sine), pads"]
    hold_plot(result, tmp_path, beside={"rockbatch.analyses.spectrum.analysis.plot"})


@pytest.mark.parametrize("count", [3, 1])
def test_where_a_quantile_is_infinite_a_spectrum_has_a_mark_instead_of_a_gap(count):
    """A full one where the median is, an open one where the 84 % quantile alone is, which a single motion has not."""
    suite = pd.DataFrame({
        "case": "rigid", "scale": 1.0, "alpha": 0.1, "p": [0.5, 1.0, 1.5, 2.0], "count": count,
        "p16": [0.1, 0.2, 0.3, np.inf], "median": [0.2, 0.3, 0.4, np.inf], "p84": [0.3, np.inf, np.inf, np.inf],
    })  # fmt: skip
    (panel,) = spectra(suite, None, {"axis": "p", "varied": ["alpha", "p"], "cases": []}).panels
    shown = {points.look.open: (points.x.tolist(), points.label) for points in of_kind(panel.marks, Points)}
    of_median = {False: ([2.0], "overturned or ended by flight")}
    assert shown == (of_median | {True: ([1.0, 1.5], "likewise, 84 % quantile alone")} if count > 1 else of_median)


def test_a_map_has_the_colours_of_its_regions_and_their_boundaries(spectrum):
    result = spectrum
    panel = maps(result.overturning_map, result.info).panels[0]
    regions = result.overturning_map[result.overturning_map["case"] == "rigid"]
    drawn = {REGIONS[outcome][1] for outcome in regions["outcome"] if outcome != "safe"}
    areas = of_kind(panel.marks, Area)
    assert {area.label for area in areas} == drawn != set()
    assert len({area.look.colour for area in areas}) == len(areas)
    for area in areas:
        heights = [row[side] for row in regions.to_dict("records") for side in ("low", "high")
                   if REGIONS.get(row["outcome"], ("", ""))[1] == area.label]  # fmt: skip
        assert (np.nanmin(area.y), np.nanmax(area.y)) == pytest.approx((min(heights), max(heights)))
    shown = strips(regions)
    (boundary,) = of_kind(panel.marks, Polyline)
    expected = [xy for line in (*inside(shown), *between(shown)) for xy in zip(*line, strict=True)]
    points = np.column_stack([boundary.x, boundary.y])
    assert points[~np.isnan(points[:, 0])].tolist() == np.array(expected).tolist()


def test_a_spectrum_marks_the_sizes_that_overturn():
    """As the report does; a panel in which all do was empty."""
    pulse = SINE | {"amplitude_g": 3.0, "period_s": 2.0}
    text = study_text(pulses=(pulse,), cases=(RIGID,), spectrum={"alpha": [0.15], "p": [1.5, 2.5], "points": 3})
    result = rb.spectrum(rb.Study.from_toml(text), jobs=1)
    assert np.isinf(result.spectrum_suite["median"]).all()
    (panel,) = spectra(result.spectrum_suite, result.spectrum, result.info, "p").panels
    (fell,) = (mark for mark in panel.marks if mark.label == FELL)
    assert fell.x == pytest.approx([1.5, 2.0, 2.5])
    assert panel.y.last < fell.y.min() <= fell.y.max() < panel.y.high
    assert (panel.x.low, panel.x.high) == (1.5, 2.5)
    (frame,) = of_kind(panel.marks, Span)
    assert (frame.axis, frame.low, frame.high) == ("y", panel.y.last, panel.y.high)


def test_panels_are_named_by_what_differs_between_them():
    """A value that one case alone has is named; the one scale and slenderness are not."""
    points = pd.DataFrame(
        {"case": ["rigid"] * 2 + ["pads"] * 2, "beta": [np.nan] * 2 + [40.0] * 2, "p": [1.0, 2.0] * 2}
    )
    points = points.assign(scale=1.0, alpha=0.2, count=1, median=[0.4, 0.3, np.inf, 0.2])
    info = {"axis": "p", "varied": ["beta", "alpha", "p"]}
    panels = spectra(points, None, info).panels
    assert [panel.caption.replace("\u00a0", " ") for panel in panels] == ["rigid", "pads: β = 40"]
    assert [mark.label.replace("\u00a0", " ") for mark in of_kind(panels[0].marks, Polyline)] == ["α = 0.2 rad"]
    twice = pd.concat([points, points.assign(scale=2.0)])
    assert len({panel.caption for panel in spectra(twice, None, info).panels}) == 4


def test_a_sensitivity_has_the_swings_and_indices_of_its_tables(tmp_path):
    result = rb.sensitivity(study(tmp_path, SENSITIVITY, (RIGID,)))
    tornado, indices = bars(result.sensitivity, result.sobol, result.info).panels
    table, ordered = result.sensitivity, result.sobol.sort_values("total", ascending=False, kind="stable")
    base = table["answer_base"][0]
    answers = table[["answer_low", "answer_high"]].to_numpy().ravel()
    of_indices = ordered[list(INDICES)].to_numpy().ravel()
    for panel, start, ends, names in (
        (tornado, base, answers, table["parameter"]),
        (indices, 0.0, of_indices, ordered["parameter"]),
    ):
        bars_, rows = of_kind(panel.marks, Area), sorted(panel.y.names, reverse=True)
        assert [{"α": "alpha"}.get(panel.y.names[row], panel.y.names[row]) for row in rows] == names.to_list()
        assert np.array([(bar.x.min(), bar.x.max()) for bar in bars_]) == pytest.approx(
            np.array([sorted((start, end)) for end in ends])
        )
        assert [0.5 * (bar.y.min() + bar.y.max()) for bar in bars_] == pytest.approx(
            [row + shift for row in rows for shift in (0.2, -0.2)]  # the low end above the high one
        )
        assert [bar.look.colour for bar in bars_] == [1, 2] * len(rows)
        assert [rule.at.tolist() for rule in of_kind(panel.marks, Rule)] == [[start]]
        assert panel.x.low <= min(0.0 if panel is indices else 1.0, *ends) < max(*ends) < panel.x.high
    words, levels = of_kind(tornado.marks, Words), table[["low", "high"]].to_numpy().ravel()
    assert [each.text for each in words] == [f"{float(level):.4g}" for level in levels]
    assert [each.x for each in words] == answers.tolist()
    assert [each.side for each in words] == [1 if answer >= base else -1 for answer in answers]
    assert [each.y for each in words] == pytest.approx([bar.y.mean() for bar in of_kind(tornado.marks, Area)])
    errors = ordered[[f"{name}_error" for name in INDICES]].to_numpy().ravel()
    whiskers = of_kind(indices.marks, Polyline)
    assert [line.x.tolist() for line in whiskers] == [
        pytest.approx([value - error, value + error]) for value, error in zip(of_indices, errors, strict=True)
    ]
    least, most = (limit(0.0, *(limit(*line.x) for line in whiskers)) for limit in (min, max))
    assert most < indices.x.high <= most + 0.1 * (most - least)
    assert least - 0.1 * (most - least) <= indices.x.low <= least
    assert whiskers[0].title == f"{of_indices[0]:.3f} ± {errors[0]:.3f}"
    hold_plot(result, tmp_path)


def test_a_release_has_its_impacts_at_rest_and_amplitudes_on_the_computed_side():
    t, theta = np.linspace(-0.5, 2.0, 6), np.array([0.1, -0.08, -0.02, 0.06, 0.05, -0.04])
    history = pd.DataFrame(
        {"t_s": np.tile(t, 2), "theta_rad": np.append(theta, 0.5 * theta), "case": np.repeat(["rock", "pads"], 6)}
    )
    impacts = pd.DataFrame({
        "case": ["rock"] * 3 + ["pads"] * 3, "t_measured_s": [-0.5, 2.0, 2.1, -0.6, np.nan, 0.7],
        "t_amplitude_computed_s": [0.25, 1.0, 2.0] * 2, "amplitude_measured_rad": [0.12, 0.03, np.nan, 0.03, 0.04, 0.02],
    })  # fmt: skip
    panels = rotations(impacts, history, {"varied": ()}).panels
    assert [panel.caption for panel in panels] == ["rock", "pads"]
    for panel, factor, most, at, amplitudes in (
        (panels[0], 1.0, 0.12, [-0.5, 2.0], [-0.12, 0.03, np.nan]), (panels[1], 0.5, 0.05, [0.7], [-0.03, 0.04, -0.02]),
    ):  # fmt: skip
        (line,), (hits, highest) = of_kind(panel.marks, Polyline), of_kind(panel.marks, Points)
        np.testing.assert_array_equal([line.x, line.y], [t, factor * theta])
        assert hits.look.colour == highest.look.colour != line.look.colour
        assert (hits.x.tolist(), hits.y.tolist()) == (at, [0.0] * len(at))
        np.testing.assert_allclose([highest.x, highest.y], [[0.25, 1.0, 2.0], amplitudes])
        assert (panel.x.low, panel.x.high, panel.y.low, panel.y.high) == pytest.approx(
            (-0.5, 2.0, -1.08 * most, 1.08 * most)
        )
        assert (hits.titles[-1], highest.titles[1]) == (
            f"impact at {at[-1]:.4g} s",
            f"amplitude {abs(amplitudes[1]):.4g} rad",
        )


def test_an_accuracy_has_its_errors_over_times_and_steps_beside_the_marks():
    table = pd.DataFrame({
        "method": ["located", "located", "not located", "study", "located"], "machine": "",
        "substeps": pd.array([1, 2, 4, None, 8], "Int64"), "tolerance": [np.nan, np.nan, np.nan, 1e-5, np.nan],
        "seconds_per_run": [1e-3, 2e-3, 0.1, 5e-3, np.nan], "error_max": [2e-5, 0.0, 2e-7, 3e-6, 1.0],
        "error_95": [1e-5, np.nan, 1e-7, 2e-6, 1.0], "error_median": [3e-6, 3e-7, 3e-8, 1e-6, 1.0],
    })  # fmt: skip
    for name in ("runs", "compared", "status_differs", "reference_change"):
        table[name] = 1.0
    (panel,) = error_and_time(of_table(table)).panels
    assert [(axis.low, axis.high) for axis in (panel.x, panel.y)] == [
        pytest.approx((1, 1e3)),
        pytest.approx((1e-14, 1e-4)),
    ]
    lines = {line.label: line for line in of_kind(panel.marks, Polyline)}
    for label, dash, errors in (
        ("largest error", 0, [2e-5, 1e-14]), ("error that 95 % of the runs keep", 1, [1e-5, np.nan]),
        ("median error", 2, [3e-6, 3e-7]),
    ):  # fmt: skip
        assert lines[label].x == pytest.approx([1.0, 2.0])
        np.testing.assert_array_equal(lines[label].y, errors)
        assert (lines[label].look.colour, lines[label].look.dash) == (1, dash)
    located, other, own = of_kind(panel.marks, Points)
    for points, x, y, title in (
        (located, [1.0, 2.0], [2e-5, 1e-14], "located, k = 1: 2.0e-05 at most in 1 ms"),
        (other, [100.0], [2e-7], "not located, k = 4: 2.0e-07 at most in 100 ms"),
        (own, [5.0], [3e-6], "study, tolerance 1e-05: 3.0e-06 at most in 5 ms"),
    ):
        assert (points.x.tolist(), points.y.tolist(), points.titles[0]) == (pytest.approx(x), y, title)
    assert own.label == "this study: tolerance 1e-05"
    assert [(rule.axis, rule.at.tolist()) for rule in of_kind(panel.marks, Rule)] == [("y", [1e-5])]
    words = of_kind(panel.marks, Words)
    assert [(each.text, each.side, each.x, each.y) for each in words] == [
        ("k = 1", -1, 1.0, 2e-5), ("k = 2", -1, 2.0, 1e-14), ("k = 4", 1, pytest.approx(100.0), 2e-7),
    ]  # fmt: skip
    assert [each.lift for each in words] == [-5.0, -5.0, 5.0]
    assert len(lines) == 3  # one of which only one time is known has no lines
    table.loc[3, ["tolerance", "substeps"]] = [np.nan, 8]
    assert error_and_time(of_table(table)).panels[0].marks[-1].label == "this study: 8 substeps"
    table.loc[3, "error_max"] = np.nan
    assert len(of_kind(error_and_time(of_table(table)).panels[0].marks, Points)) == 2
