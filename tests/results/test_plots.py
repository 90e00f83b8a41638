"""The figure of the peaks, and what opened results tell of themselves."""

import numpy as np
import pandas as pd
import pytest
from studies import PADS, PIER, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.results import plots

STUDY = study_text(
    title="Panels",
    pier=PIER | {"p": [1.0, 2.0]},
    motions={"polarity": ["+", "-"]},
    pulses=[
        SINE | {"name": "strong", "amplitude_g": 4.0, "period_s": 2.0, "confirm": "amplitude_g"},
        SINE | {"name": "weak", "amplitude_g": 0.8, "period_s": 0.3},
    ],
    cases=[RIGID | {"name": "rock"}, PADS | {"beta": [30, 50]}],
)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("panels")
    rb.run(write_study(folder, STUDY), folder / "out")
    return rb.open_results(folder / "out")


def panel(figure, name):
    return next(axes for axes in figure.axes if axes.get_title() == name)


def test_there_is_a_panel_for_each_record_in_order_of_pga(results):
    figure = results.plot()
    assert [axes.get_title() for axes in figure.axes if axes.get_visible()] == ["weak", "strong"]
    assert figure.get_suptitle() == "Panels"


def test_marks_and_lines_are_the_rows_of_the_table(results):
    axes = panel(results.plot(), "weak")
    rows = results.peaks[(results.peaks["record"] == "weak") & (results.peaks["polarity"] == "+")]
    assert (rows["status"] == "ok").all()
    labels = [tick.get_text() for tick in axes.get_xticklabels()]
    assert labels == ["pads, beta = 30", "pads, beta = 50"]
    for p, marks in zip((1.0, 2.0), axes.containers, strict=True):
        pads = rows[(rows["case"] == "pads") & (rows["p"] == p)]
        x, y = marks.lines[0].get_data()
        assert y == pytest.approx(pads["theta_max_over_alpha"])
        assert x.astype(float).round().tolist() == [0, 1]
    beside = np.array([marks.lines[0].get_xdata().astype(float) for marks in axes.containers]) % 1.0
    assert np.mean((beside + 0.5) % 1.0 - 0.5) == pytest.approx(0.0, abs=1e-12)  # as far left as right of the ticks
    rigid = {line.get_label(): line.get_ydata()[0] for line in axes.lines if line.get_label().startswith("rock")}
    expected = rows[rows["case"] == "rock"].set_index("p")["theta_max_over_alpha"]
    assert rigid == {f"rock, p = {p:g}": pytest.approx(theta) for p, theta in expected.items()}


def test_runs_without_a_peak_stand_above_the_axis_values(results):
    rows = results.peaks[(results.peaks["record"] == "strong") & (results.peaks["polarity"] == "+")]
    fell = (rows["status"] == "overturned").sum()
    assert fell > 0
    figure = results.plot()
    axes = panel(figure, "strong")
    marks = [line for line in axes.lines if line.get_label() == "overturned"]
    assert sum(len(line.get_xdata()) for line in marks) == fell
    highest = results.peaks.loc[results.peaks["status"] == "ok", "theta_max_over_alpha"].max()
    assert min(min(line.get_ydata()) for line in marks) > highest
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "overturned" in legend
    assert len(legend) == len(set(legend))


def test_a_study_of_rigid_bases_alone_has_its_cases_on_the_axis(tmp_path):
    cases = [RIGID | {"name": name, "restitution": e} for name, e in (("hard", 0.9), ("soft", 0.6))]
    rb.run(write_study(tmp_path, study_text(pulses=[SINE], cases=cases)), tmp_path / "out")
    (axes,) = rb.open_results(tmp_path / "out").plot().axes
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["hard", "soft"]
    assert len(axes.containers[0].lines[0].get_xdata()) == 2


def test_fifteen_distributions_differ_in_colour_or_dashes_and_the_legend_is_beside_them(results):
    cases = pd.concat([results.peaks.assign(case=f"case {n}") for n in range(15)])
    figure = plots.plot_cdf(cases, [], "station", 88.0)
    (axes,) = figure.axes
    looks = {(step.get_color(), step.get_linestyle()) for step in axes.lines if step.get_label().startswith("case")}
    assert len(looks) == 15
    figure.draw_without_rendering()
    assert figure.legends[0].get_window_extent().y1 <= axes.get_window_extent().y0


def test_of_many_records_the_worst_have_a_panel(results, monkeypatch):
    monkeypatch.setattr(plots, "MOST_PANELS", 1)
    figure = results.plot()
    assert [axes.get_title() for axes in figure.axes] == ["strong"]
    assert "1 of 2 records" in figure.get_suptitle()


def test_without_runs_there_is_no_figure(results):
    with pytest.raises(rb.InputError, match="no runs to plot"):
        plots.plot(results.peaks.iloc[:0], results.info, 160.0)


def test_results_tell_of_themselves_in_a_few_lines(results):
    told = repr(results).splitlines()
    assert told[0] == f"<results of 'Panels' in {results.directory}>"
    runs = results.peaks[results.peaks["polarity"] == "+"]
    assert told[1].split() == ["runs", "12:", *" ".join(_counts(runs)).split()]
    worst = runs[runs["status"] == "ok"].nlargest(1, "theta_max_over_alpha").iloc[0]
    assert f"θ_max/α = {worst['theta_max_over_alpha']:.5f}, {worst['record']} on {worst['case']}" in told[2]
    assert "histories.h5" in told[3]
    html = results._repr_html_()
    assert "<th>beta</th>" in html
    assert html.count("<td>weak</td>") == 6


def _counts(runs):
    counts = runs["status"].value_counts()
    return [", ".join(f"{n} {status}" for status, n in counts.items())]
