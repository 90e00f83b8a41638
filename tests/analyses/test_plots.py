"""Figures of the analyses show the numbers of their tables, each case in one look everywhere."""

import numpy as np
import pandas as pd
import pytest
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.accuracy.plots import accuracy as plot_of_accuracy
from rockbatch.analyses.spectrum import map_drawing as overturning_map

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


def test_a_fragility_has_its_shares_and_one_colour_for_each_case(tmp_path):
    result = rb.fragility(study(tmp_path, FRAGILITY))
    figure = result.plot()
    colours = {}
    for axes in figure.axes:
        for drawn in axes.lines:
            case, *records = drawn.get_label().split(", ")
            colours.setdefault(case, set()).add(drawn.get_color())
            if records:
                rows = result.fragility[
                    (result.fragility["case"] == case) & (result.fragility["limit_state"] == axes.get_title())
                ]
                assert drawn.get_ydata() == pytest.approx(rows["exceeded"] / rows["n"])
    assert [axes.get_title() for axes in figure.axes] == ["overturning", "settlement"]
    assert {len(of_case) for of_case in colours.values()} == {1}
    assert len(set().union(*colours.values())) == 2


def test_a_spectrum_has_a_panel_for_each_slenderness_and_case_and_each_map(tmp_path):
    result = rb.spectrum(study(tmp_path, SPECTRUM))
    figure = result.plot()
    titles = [axes.get_title() for axes in figure.axes]
    cases = result.spectrum_suite[["case", "alpha"]].drop_duplicates().itertuples(index=False)
    assert titles == [rf"{case}, $\alpha$ = {alpha:g}" for case, alpha in cases] + ["sine, rigid", "sine, pads"]
    of_case = result.spectrum_suite[
        (result.spectrum_suite["case"] == "rigid") & (result.spectrum_suite["alpha"] == 0.2)
    ]
    median = figure.axes[titles.index(r"rigid, $\alpha$ = 0.2")].lines[-1].get_ydata()
    np.testing.assert_array_equal(median, of_case["median"].replace(np.inf, np.nan))
    axes, colours = figure.axes[titles.index("sine, rigid")], {}
    regions = result.overturning_map[result.overturning_map["case"] == "rigid"]
    low, high = axes.get_xlim()
    for row in regions.to_dict("records"):  # as the report draws them: no colour where the pier stands
        inside = min(max(row["omega_p_over_p"], low + 1e-6), high - 1e-6), 0.5 * (row["low"] + row["high"])
        of_point = {patch.get_facecolor() for patch in axes.patches if patch.get_path().contains_point(inside)}
        colours.setdefault(row["outcome"], set()).update(of_point)
    assert colours.pop("safe") == set()
    assert [len(of_outcome) for of_outcome in colours.values()] == [1] * len(colours)
    assert len(set.union(*colours.values())) == len(colours) > 0
    strips = overturning_map.strips(regions)
    boundaries = [*overturning_map.inside(strips), *overturning_map.between(strips)]
    assert [line.get_xydata().tolist() for line in axes.lines] == [np.transpose(xy).tolist() for xy in boundaries]


def test_a_spectrum_marks_the_sizes_that_overturn():
    """As the report does; a panel in which all do was empty."""
    pulse = SINE | {"amplitude_g": 3.0, "period_s": 2.0}
    text = study_text(pulses=(pulse,), cases=(RIGID,), spectrum={"alpha": [0.15], "p": [1.5, 2.5], "points": 3})
    result = rb.spectrum(rb.Study.from_toml(text), jobs=1)
    assert np.isinf(result.spectrum_suite["median"]).all()
    (marks,) = (line for line in result.plot(axis="p").axes[0].lines if line.get_marker() == "x")
    assert marks.get_xdata() == pytest.approx([1.5, 2.0, 2.5])


def test_a_sensitivity_has_the_swings_of_its_table(tmp_path):
    result = rb.sensitivity(study(tmp_path, SENSITIVITY, (RIGID,)))
    tornado, shares = result.plot(88.0).axes
    widths = sorted(abs(bar.get_width()) for bar in tornado.patches)
    assert widths == pytest.approx(sorted((result.sensitivity["answer_high"] - result.sensitivity["answer_low"]).abs()))
    assert {label.get_text() for label in shares.get_yticklabels()} == {"p", "alpha"}


def test_an_accuracy_has_its_errors_over_times_and_steps_beside_the_marks():
    table = pd.DataFrame({
        "method": ["located", "located", "SciPy DOP853"], "substeps": pd.array([1, 2, None], "Int64"),
        "seconds_per_run": [1e-3, 2e-3, 0.1], "error_95": [1e-5, 1e-6, 1e-7],
    })  # fmt: skip
    (axes,) = plot_of_accuracy(table, 88.0).axes
    located = axes.lines[0]
    assert located.get_label() == "located"
    assert located.get_xdata() == pytest.approx([1.0, 2.0])
    assert located.get_ydata() == pytest.approx([1e-5, 1e-6])
    assert [words.get_text() for words in axes.texts] == ["1", "2"]
