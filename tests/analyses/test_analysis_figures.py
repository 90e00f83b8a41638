"""Figures of the analyses show the numbers of their tables, each case in one look everywhere."""

import numpy as np
import pandas as pd
import pytest
from figure_makers import makers
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.accuracy.figures import error_and_time
from rockbatch.analyses.accuracy.levels import of_table
from rockbatch.analyses.fragility.figures import curves
from rockbatch.analyses.sensitivity.figures import INDICES, bars
from rockbatch.analyses.spectrum.figures import FELL, REGIONS, maps, spectra
from rockbatch.analyses.spectrum.map_regions import between, inside, strips
from rockbatch.common.figures.description import Area, Points, Polyline, Words

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


def test_a_fragility_has_its_shares_and_one_colour_for_each_case(tmp_path):
    result = rb.fragility(study(tmp_path, FRAGILITY))
    figure = curves(result.info)
    assert [panel.caption for panel in figure.panels] == ["overturning", "settlement"]
    colours = {}
    for panel in figure.panels:
        for mark in panel.marks:
            colours.setdefault(mark.label, set()).add(mark.look.colour)
            if isinstance(mark, Points):
                rows = result.fragility[
                    (result.fragility["case"] == mark.label) & (result.fragility["limit_state"] == panel.caption)
                ]
                assert mark.y == pytest.approx(rows["exceeded"] / rows["n"])
    assert {len(colours[case]) for case in ("rigid", "pads")} == {1}
    assert colours["rigid"] != colours["pads"]
    assert makers(result.plot) <= makers(lambda: result.save(tmp_path / "out"))


@pytest.fixture(scope="module")
def spectrum(tmp_path_factory):
    return rb.spectrum(study(tmp_path_factory.mktemp("spectrum"), SPECTRUM))


def test_a_spectrum_has_a_panel_for_each_case_and_a_curve_for_each_slenderness_and_record(spectrum, tmp_path):
    result = spectrum
    figure = spectra(result.spectrum_suite, result.spectrum, result.info)
    assert [panel.caption for panel in figure.panels] == ["rigid", "pads"]
    lines = of_kind(figure.panels[0].marks, Polyline)
    suite = result.spectrum_suite[result.spectrum_suite["case"] == "rigid"]
    for colour, (_, rows) in enumerate(suite.groupby("alpha", sort=False), 1):
        for name, dash in (("median", 0), ("p84", 1), ("p16", 2)):
            (line,) = (line for line in lines if (line.look.colour, line.look.dash) == (colour, dash))
            np.testing.assert_array_equal(line.y, rows[name].replace(np.inf, np.nan))
    assert sum(line.label == "each record" for line in lines) == 3 * 2
    panels = [axes for axes in result.plot().axes if axes.lines]
    titles = [axes.get_title().rpartition(", ")[0] or axes.get_title() for axes in panels]
    assert titles == ["rigid", "pads", "sine (sine), rigid", "sine (sine), pads"]
    assert makers(result.plot) - {"rockbatch.analyses.spectrum.analysis.plot"} <= makers(
        lambda: result.save(tmp_path / "out")
    )


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
    assert fell.y.min() > panel.y.last


def test_a_sensitivity_has_the_swings_and_indices_of_its_tables(tmp_path):
    result = rb.sensitivity(study(tmp_path, SENSITIVITY, (RIGID,)))
    tornado, indices = bars(result.sensitivity, result.sobol, result.study.varied).panels
    table = result.sensitivity
    ends = [(area.x.min(), area.x.max()) for area in of_kind(tornado.marks, Area)]
    expected = [
        sorted((row.answer_base, answer)) for row in table.itertuples() for answer in (row.answer_low, row.answer_high)
    ]
    assert np.array(ends) == pytest.approx(np.array(expected))
    assert [words.text for words in of_kind(tornado.marks, Words)] == [
        f"{float(end):.4g}" for row in table.itertuples() for end in (row.low, row.high)
    ]
    assert set(indices.y.names.values()) == {"p", "α"}
    ordered = result.sobol.sort_values("total", ascending=False, kind="stable")
    whiskers = [line.x.mean() for line in of_kind(indices.marks, Polyline)]
    assert whiskers == pytest.approx([row[name] for row in ordered.to_dict("records") for name in INDICES])
    assert makers(result.plot) <= makers(lambda: result.save(tmp_path / "out"))


def test_an_accuracy_has_its_errors_over_times_and_steps_beside_the_marks():
    table = pd.DataFrame({
        "method": ["located", "located", "not located"], "machine": "", "substeps": pd.array([1, 2, 4], "Int64"),
        "seconds_per_run": [1e-3, 2e-3, 0.1], "error_95": [1e-5, 1e-6, 1e-7], "error_max": [2e-5, 2e-6, 2e-7],
    })  # fmt: skip
    for name in ("tolerance", "runs", "error_median", "status_differs", "reference_change"):
        table[name] = 1.0
    (panel,) = error_and_time(of_table(table)).panels
    lines = {line.label: line for line in of_kind(panel.marks, Polyline)}
    assert lines["error that 95 % of the runs keep"].x == pytest.approx([1.0, 2.0])
    assert lines["error that 95 % of the runs keep"].y == pytest.approx([1e-5, 1e-6])
    assert lines["largest error"].y == pytest.approx([2e-5, 2e-6])
    assert [words.text for words in of_kind(panel.marks, Words)] == ["k = 1", "k = 2", "k = 4"]
