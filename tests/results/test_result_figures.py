"""The figures of finished results show the rows of the table."""

import json
import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from check_samples import verdict
from studies import PADS, PIER, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common.figures.description import COLOURS, ENDED, Look, Points, Polyline, Rule, Span, line_of
from rockbatch.common.units import GRAVITY
from rockbatch.observers.interaction.figure import over_axial_force
from rockbatch.results import figures
from rockbatch.results.figures import OVER, distributions, peaks_of_all, tooltip
from rockbatch.results.labelled import groups_of, labelled
from rockbatch.results.labels import Series
from rockbatch.results.spectra_figure import drawable, response_spectra

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


def own(results):
    return labelled(results.peaks, results.info, results.directory)


def peaks_of(results):
    figure = peaks_of_all(own(results), results.info)
    return figure, {panel.caption: panel for panel in figure.panels}


def test_there_is_a_panel_for_each_record_in_order_of_pga(results):
    figure, panels = peaks_of(results)
    assert list(panels) == ["weak", "strong"]
    assert figure.title == "Panels"


def test_marks_and_lines_are_the_rows_of_the_table(results):
    panel = peaks_of(results)[1]["weak"]
    rows = results.peaks[(results.peaks["record"] == "weak") & (results.peaks["polarity"] == "+")]
    assert (rows["status"] == "ok").all()
    assert panel.x.names == {1.0: "a", 2.0: "b"}
    marks = {
        (mark.label.replace("\u00a0", " "), mark.look.open): mark for mark in panel.marks if isinstance(mark, Points)
    }
    for p, is_open in ((1.0, False), (2.0, True)):
        for place, (letter, beta) in enumerate((("a", 30), ("b", 50)), 1):
            row = rows[(rows["case"] == "pads") & (rows["p"] == p) & (rows["beta"] == beta)]
            mark = marks[f"{letter} – pads: β = {beta} (p = {p:g} rad/s)", is_open]
            assert mark.y == pytest.approx(row["theta_max_over_alpha"])
            assert mark.error.tolist() == [0.0]  # shorter than its marker
            assert mark.x == pytest.approx([place + (0.16 if is_open else -0.16)])
    rigid = sorted(float(mark.at[0]) for mark in panel.marks if isinstance(mark, Rule))
    assert rigid == pytest.approx(sorted(rows[rows["case"] == "rock"]["theta_max_over_alpha"]))
    (second,) = (float(mark.at[0]) for mark in panel.marks if isinstance(mark, Rule) and mark.look.open)
    assert second == pytest.approx(rows[(rows["case"] == "rock") & (rows["p"] == 2.0)]["theta_max_over_alpha"].item())


def test_runs_without_a_peak_stand_above_the_axis_values(results):
    rows = results.peaks[(results.peaks["record"] == "strong") & (results.peaks["polarity"] == "+")]
    fell = (rows["status"] == "overturned").sum()
    assert fell > 0
    figure, panels = peaks_of(results)
    marks = [mark for mark in panels["strong"].marks if mark.label == ENDED["overturned"]]
    assert sum(len(mark.x) for mark in marks) == fell
    highest = results.peaks.loc[results.peaks["status"] == "ok", "theta_max_over_alpha"].max()
    assert min(mark.y.min() for mark in marks) > highest
    assert all(panel.y.last < panel.y.high for panel in figure.panels)
    rock = rows[(rows["case"] == "rock") & (rows["status"] == "overturned")]
    lines = [float(mark.at[0]) for mark in panels["strong"].marks if isinstance(mark, Rule)]
    assert sum(at > panels["strong"].y.last for at in lines) == len(rock) > 0


def test_a_run_that_failed_stands_at_the_foot_and_its_error_is_not_drawn(results):
    peaks = results.peaks.copy()
    failed = (peaks["record"] == "weak") & (peaks["beta"] == 30)
    peaks.loc[failed, ["status", "theta_max_over_alpha", "theta_max_error"]] = ["failed", np.nan, np.nan]
    panel = peaks_of(replace(results, peaks=peaks))[1]["weak"]
    marks = [mark for mark in panel.marks if mark.label == ENDED["failed"]]
    assert [len(mark.x) for mark in marks] == [1, 1]
    assert max(mark.y.max() for mark in marks) < 0.1 * panel.y.last


def test_errors_longer_than_their_marker_have_bars_also_those_of_a_line(results):
    peaks = results.peaks.copy()
    weak = peaks["record"] == "weak"
    peaks.loc[weak & peaks["case"].isin(["rock", "pads"]) & (peaks["p"] == 1.0), "theta_max_error"] = 0.2
    panel = peaks_of(replace(results, peaks=peaks))[1]["weak"]
    marks = [mark for mark in panel.marks if isinstance(mark, Points) and not mark.look.open]
    assert [mark.error.tolist() for mark in marks] == [[0.2], [0.2]]
    (bar,) = (mark for mark in panel.marks if isinstance(mark, Polyline))
    assert np.ptp(bar.y) == pytest.approx(0.4)


def test_three_sides_and_more_have_colours_of_their_own(results):
    peaks = results.peaks[results.peaks["mirror_of"] == ""]
    thrice = replace(results, peaks=peaks.assign(scale=np.where(peaks["record"] == "weak", 1.0, 2.0)))
    marks = [mark for panel in peaks_of(thrice)[1].values() for mark in panel.marks if mark.label not in ENDED.values()]
    looks = {mark.look for mark in marks if isinstance(mark, Points | Rule)}
    assert len(looks) == 2 * 4  # of the pads and of the rigid base
    assert not any(look.open for look in looks)
    of_rigid, of_pads = ({mark.look.colour for mark in marks if isinstance(mark, kind)} for kind in (Rule, Points))
    assert of_rigid == of_pads


def test_a_study_of_rigid_bases_alone_has_its_cases_on_the_axis(tmp_path):
    cases = [RIGID | {"name": name, "restitution": e} for name, e in (("hard", 0.9), ("soft", 0.6))]
    rb.run(write_study(tmp_path, study_text(pulses=[SINE], cases=cases)), tmp_path / "out")
    (panel,) = peaks_of(rb.open_results(tmp_path / "out"))[1].values()
    assert list(panel.x.names.values()) == ["a", "b"]
    assert [len(mark.x) for mark in panel.marks] == [1, 1]


def test_distributions_are_those_of_the_table_and_end_below_one_by_what_overturned(results):
    runs = own(results)
    figure = distributions(list(groups_of(runs.runs, runs.piers)), runs.series, "station")
    assert [panel.caption.replace("\u00a0", " ") for panel in figure.panels] == ["p = 1 rad/s", "p = 2 rad/s"]
    peaks = results.peaks[results.peaks["mirror_of"] == ""]
    for panel, p in zip(figure.panels, (1.0, 2.0), strict=True):
        assert panel.x.last < panel.x.high  # no numbers where what overturned stands
        curves = [mark for mark in panel.marks if isinstance(mark, Polyline) and mark.name]
        assert len(curves) == 3
        rows = peaks[(peaks["p"] == p) & (peaks["case"] == "rock")]
        stood = rows["theta_max_over_alpha"][rows["status"] == "ok"]
        (rock,) = (curve for curve in curves if curve.name == "rock")
        assert sorted(set(rock.x[1:-1])) == sorted(stood)
        assert rock.y[-1] == pytest.approx(len(stood) / len(rows))
        fell = (
            peaks[peaks["p"] == p]
            .groupby(["case", "beta"], dropna=False)["status"]
            .agg(lambda of: "overturned" in set(of))
        )
        assert sum(mark.label == OVER for mark in panel.marks) == fell.sum()
    results.plot_cdf(88.0).draw_without_rendering()


def test_distributions_have_room_for_overturned_runs_everywhere_if_one_panel_has_any(results):
    runs = own(results)
    (first, rows), (second, others) = groups_of(runs.runs, runs.piers)
    stood = others[others["status"] == "ok"]
    for groups, room in (([(first, rows), (second, stood)], True), ([(second, stood)], False)):
        panels = distributions(groups, runs.series, "station").panels
        assert {panel.x.last < panel.x.high for panel in panels} == {room}


def test_a_distribution_climbs_at_each_peak_and_leaves_a_gap_for_overturned_runs(results):
    """The gap, from what stood to one, stands in a band beyond the axis, with what it means; without falls there is neither."""
    runs = own(results)
    figure = distributions(list(groups_of(runs.runs, runs.piers)), runs.series, "station")
    labels = {one.label: one for one in runs.series}
    for panel, (_, rows) in zip(figure.panels, groups_of(runs.runs, runs.piers), strict=True):
        (band,) = (mark for mark in panel.marks if isinstance(mark, Span))
        assert (band.axis, band.low, band.high) == ("x", panel.x.last, panel.x.high)
        for curve in (mark for mark in panel.marks if isinstance(mark, Polyline) and mark.name):
            one = labels[curve.name]
            of_curve = rows[(rows["series"] == runs.series.index(one)) & (rows["mirror_of"] == "")]
            stood = sorted(of_curve["theta_max_over_alpha"][of_curve["status"] == "ok"])
            reached = len(stood) / len(of_curve)
            steps = np.array([[0.0, 0.0], *np.repeat(stood, 2).reshape(-1, 2), [panel.x.high] * 2]).ravel()[1:-1]
            assert curve.x.tolist() == steps.tolist()
            assert curve.y == pytest.approx(np.repeat(np.arange(len(stood) + 1) / len(of_curve), 2))
            assert curve.look == (Look("level") if one.rigid else line_of(one.index))
            gaps = [
                mark for mark in panel.marks if isinstance(mark, Polyline) and not mark.name and mark.look == curve.look
            ]
            assert [gap.y.tolist() for gap in gaps] == [[reached, 1.0]] * (reached < 1.0)
            assert all(band.low < x < band.high for gap in gaps for x in gap.x)
            notes = [
                mark for mark in panel.marks if isinstance(mark, Points) and mark.titles[0].startswith(f"{curve.name}:")
            ]
            assert [note.titles for note in notes] == [[f"{curve.name}: {100 * (1 - reached):.0f} % {OVER}"]] * len(
                gaps
            )
            assert [note.y[0] for note in notes] == [0.5 * (1.0 + reached)] * len(gaps)
    calm = runs.runs[runs.runs["record"] == "weak"]
    (panel,) = distributions([("", calm)], runs.series, "station").panels
    assert panel.caption == "all runs"
    assert panel.x.last == panel.x.high
    assert {type(mark) for mark in panel.marks} == {Polyline}


def test_self_similar_axes_have_every_run_at_its_intensity_and_frequency(results):
    """PGA/(g tan α) over ω_g/p with ω_g = PGA/PGV; at 1 a pier lifts off rigid ground."""
    figure, records = (
        figures.self_similar(own(results), results.info),
        {record["record"]: record for record in results.info["records"]},
    )
    peaks = results.peaks[results.peaks["mirror_of"] == ""]
    assert figure.title == "Panels"
    assert [panel.caption for panel in figure.panels] == [one.label for one in own(results).series]
    seen = 0
    for panel in figure.panels:
        (lifts,) = (mark for mark in panel.marks if isinstance(mark, Rule))
        assert (lifts.axis, lifts.at.tolist()) == ("y", [1.0])
        assert (panel.x.log, panel.y.log) == (True, True)
        assert "PGA" in panel.y.label
        assert "ω_g/p" in panel.x.label
        for mark in (mark for mark in panel.marks if isinstance(mark, Points) and not mark.label):
            tone, values = mark.shade
            stood = peaks[peaks["status"] == "ok"]["theta_max_over_alpha"]
            assert (tone.log, tone.low, tone.high) == (True, stood.min(), stood.max())
            for x, y, value in zip(mark.x, mark.y, values, strict=True):
                (row,) = peaks[peaks["theta_max_over_alpha"] == value].to_dict("records")
                of = records[row["record"]]
                assert y == pytest.approx(of["pga_g"] / math.tan(PIER["alpha"]))
                assert x == pytest.approx(of["pga_g"] * GRAVITY / of["pgv_m_s"] / row["p"])
                seen += 1
    assert seen == (peaks["status"] == "ok").sum()


def test_of_many_records_the_worst_have_a_panel(results, monkeypatch):
    monkeypatch.setattr(figures, "MOST_PANELS", 1)
    figure, panels = peaks_of(results)
    assert list(panels) == ["strong"]
    assert "1 of 2 records" in figure.title
    results.plot(88.0).draw_without_rendering()


def test_without_runs_there_is_no_figure(results):
    none = replace(results, peaks=results.peaks.iloc[:0])
    for plot in (none.plot, none.plot_cdf, lambda: none.plot(axes="self-similar")):
        with pytest.raises(rb.InputError, match="no runs to plot"):
            plot()


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


def test_a_case_without_runs_is_named_by_its_own_values(results):
    known = own(results).named_case("pads", {"p": 1.0, "beta": 30}, ["p", "beta"])
    gone = own(results).named_case("gone", {"p": 1.0, "beta": 30}, ["p", "beta"])
    other = own(results).named_case("rock", {"p": 9.0}, ["p", "beta"])
    assert [name.replace("\u00a0", " ") for name in (known, gone, other)] == [
        "pads: β = 30, p = 1 rad/s",
        "gone: p = 1 rad/s, β = 30",
        "rock: p = 9 rad/s",
    ]


def test_rigid_bases_beyond_the_first_have_dashes_of_their_own(results):
    """The sixth has those of the second; a line of an error, or of what overturned, has the look of its foundation."""
    runs = own(results)
    series = [replace(one, index=5) if one.rigid else one for one in runs.series]
    for panel in distributions(list(groups_of(runs.runs, runs.piers)), series, "station").panels:
        assert {mark.look.dash for mark in panel.marks if isinstance(mark, Polyline) and mark.label == "rock"} == {1}
    for panel in peaks_of_all(replace(runs, series=series), results.info).panels:
        assert {mark.look.dash for mark in panel.marks if isinstance(mark, Rule)} == {1}


def test_the_tooltip_of_a_marker_has_value_error_and_side_or_how_the_run_ended(results):
    one = own(results).series[-1]
    run = {"status": "ok", "theta_max_over_alpha": 0.06166, "theta_max_error": 3.2e-7, "polarity": "-"}
    assert tooltip(one, run, "") == f"{one.label}: 0.0617 ± 3e-07"
    assert (
        tooltip(one, run | {"theta_max_error": math.nan}, "p = 1 rad/s, -") == f"{one.label} (p = 1 rad/s, -): 0.0617"
    )
    assert tooltip(one, run | {"status": "flight"}, "-") == f"{one.label} (-): flight"


def test_on_self_similar_axes_a_run_that_did_not_move_is_none_that_stood_or_fell(results):
    """Peaks of 0.5, 0 and one that overturned, of each foundation, in turn over the records."""
    peaks = results.peaks[results.peaks["mirror_of"] == ""].copy()
    peaks["status"], peaks["theta_max_over_alpha"] = "ok", 0.5
    weak = (peaks["record"] == "weak") & (peaks["p"] == 1.0)
    peaks.loc[weak, "theta_max_over_alpha"] = 0.0
    fell = (peaks["record"] == "strong") & (peaks["p"] == 1.0)
    peaks.loc[fell, ["status", "theta_max_over_alpha"]] = ["overturned", np.inf]
    for panel in figures.self_similar(labelled(peaks, results.info, results.directory), results.info).panels:
        marks = {mark.label: mark for mark in panel.marks if isinstance(mark, Points)}
        assert {label: len(mark.x) for label, mark in marks.items()} == {
            "": 2,
            "did not move": 1,
            ENDED["overturned"]: 1,
        }
        assert marks[""].shade[1].tolist() == [0.5, 0.5]
        assert marks["did not move"].look.open


# Response spectra


PERIODS = [0.1, 0.5, 2.0]


def spectra_of(values, **more):
    """Return the panel of spectra with these accelerations [g] at three periods, and its lines by their names."""
    item = {"damping": 0.05, "period_s": PERIODS, "sa_g": values} | more
    (panel,) = response_spectra(item, [f"m{i}" for i in range(len(values))], more.get("fitted")).panels
    return panel, {mark.name: mark for mark in panel.marks if isinstance(mark, Polyline)}


def test_spectra_of_a_few_records_are_drawn_beside_their_median_over_all_periods():
    panel, lines = spectra_of([[0.5, 1.0, 0.2], [0.4, 3.0, 0.1], [0.1, 0.9, 0.05]])
    assert [lines[name].y.tolist() for name in ("m0", "m1", "m2")] == [
        [0.5, 1.0, 0.2],
        [0.4, 3.0, 0.1],
        [0.1, 0.9, 0.05],
    ]
    assert lines["median"].y.tolist() == [0.4, 1.0, 0.1]
    assert lines.keys() == {"m0", "m1", "m2", "median"}
    assert (panel.x.low, panel.x.high, panel.x.log) == (0.1, 2.0, True)
    assert (0.025 < panel.y.low < 0.05, 3.0 < panel.y.high < 6.0, panel.y.log) == (True, True, True)
    assert spectra_of([[0.5, 1.0, 0.2]])[1].keys() == {"m0"}


def test_spectra_of_many_records_are_faint_beside_their_quantiles():
    panel, lines = spectra_of([[0.01 + i, 1.01 + i, 2.01 + i] for i in range(101)])
    assert [lines[name].y[0] for name in ("16 %", "median", "84 %")] == pytest.approx([16.01, 50.01, 84.01])
    assert {lines[f"m{i}"].look for i in range(101)} == {Look("faint")}
    assert {mark.label for mark in panel.marks} == {"", "median", "16 and 84 %"}
    for records in (COLOURS, COLOURS + 1):
        _, lines = spectra_of([[1.0, 1.0, 1.0]] * records)
        assert (lines["m0"].label, "16 %" in lines) == (("m0", False) if records == COLOURS else ("", True))


def test_spectra_with_a_target_are_drawn_beside_it_and_the_mean_that_was_fitted():
    panel, lines = spectra_of(
        [[0.5, 1.0, 0.2], [0.4, 3.0, 0.1]], target_sa_g=[9.0, 2.0, 0.01], mean_sa_g=[0.45, 2.0, 0.15], fitted=(0.2, 1.5)
    )
    assert lines["target"].y.tolist() == [9.0, 2.0, 0.01]
    assert lines["mean of the records"].y.tolist() == [0.45, 2.0, 0.15]
    assert lines.keys() == {"m0", "m1", "target", "mean of the records"}
    (span,) = (mark for mark in panel.marks if isinstance(mark, Span))
    assert (span.axis, span.low, span.high) == ("x", 0.2, 1.5)
    assert (panel.y.low < 0.01, panel.y.high > 9.0) == (True, True)


def test_a_record_of_nearly_nothing_does_not_flatten_the_other_spectra():
    panel, lines = spectra_of([[25.0, 50.0, 10.0], [1e-9, 0.0, 1e-9]])
    assert panel.y.low == pytest.approx(1e-4 * 50.0, rel=0.5)
    assert set(lines["m1"].y) == {panel.y.low}
    nothing, flat = spectra_of([[0.0, 0.0, 0.0]])
    assert 0.0 < nothing.y.low < nothing.y.high
    assert set(flat["m0"].y) == {nothing.y.low}


@pytest.mark.parametrize(
    ("changes", "drawn"),
    [
        ({}, True), ({"period_s": [0.1, 0.5, 0.5]}, False), ({"period_s": [0.0, 0.5, 2.0]}, False),
        ({"sa_g": [[1.0, 1.0]]}, False), ({"period_s": [0.1], "sa_g": [[1.0]]}, False),
        ({"sa_g": [[1.0, -1e-9, 1.0]]}, False), ({"sa_g": [[1.0, None, 0.0]]}, True),
        ({"mean_sa_g": [1.0, 1.0, 1.0]}, False), ({"mean_sa_g": [1.0] * 3, "target_sa_g": [1.0] * 3}, True),
        ({"mean_sa_g": [1.0] * 3, "target_sa_g": [1.0] * 2}, False),
    ],
)  # fmt: skip
def test_spectra_are_drawn_only_if_each_has_a_value_at_every_rising_period(changes, drawn):
    assert drawable({"damping": 0.05, "period_s": PERIODS, "sa_g": [[1.0, 1.0, 1.0]]} | changes) == drawn


# Effects over the axial force, and their capacity


CURVE = ((-800.0, 0.0), (0.0, 6e3), (2e3, 9e3), (9e3, 16e3), (20e3, 0.0))
"""Points of a capacity (N [kN], M [kN m]) or (N, V [kN])."""


def panel_over_axial_force(axial, *, at_m=2.5, places=(0, 0, 0), curve=CURVE):
    """Return the panel of three rows at these axial forces, with effects 100, 300 and 200, of the ``places`` in two series."""
    checked = verdict("pads", "pass", check="foot", capacity=json.dumps(curve), at_m=at_m)
    height, effect = (math.nan, "shear_kN") if math.isnan(at_m) else (at_m, "moment_kNm")
    rows = pd.DataFrame(
        {"series": places, "height_m": height, "axial_kN": axial, "shear_kN": np.nan, "moment_kNm": np.nan}
    )
    rows[effect] = [100.0, 300.0, 200.0]
    series = [Series("pads", "a", False, 0), Series("more pads", "b", False, 1)]
    (panel,) = over_axial_force([(checked, rows)], series).panels
    return panel


@pytest.mark.parametrize(
    ("axial", "low", "high"),
    [
        ((1000.0, 4000.0, 5000.0), -800.0, 6500.0),  # 1500 beyond 0 would be beyond its end
        ((100.0, 400.0, 500.0), -150.0, 650.0),
        ((-100.0, 400.0, 500.0), -250.0, 650.0),
        ((1000.0, 4000.0, 18e3), -800.0, 20e3),  # beyond both its ends
        ((-400.0, -300.0, -100.0), -520.0, 20.0),
    ],
)
def test_a_capacity_is_drawn_around_the_axial_forces_of_its_runs_and_no_further(axial, low, high):
    """From 0 at least, and 3/10 of the greatest |N| beyond both, with every corner between them, and straight."""
    capacity, envelope = panel_over_axial_force(axial).marks
    inner = [n for n, _ in CURVE if low < n < high]
    assert capacity.x.tolist() == pytest.approx([low, *inner, high])
    assert capacity.y.tolist() == pytest.approx(np.interp([low, *inner, high], *zip(*CURVE, strict=True)).tolist())
    assert envelope.x.tolist() == list(axial)
    assert envelope.y.tolist() == [100.0, 300.0, 200.0]


def test_every_foundation_has_its_envelope_in_its_own_look_and_axes_that_hold_all():
    panel = panel_over_axial_force((1000.0, 4000.0, 5000.0), places=(0, 1, 1))
    capacity, pads, more = panel.marks
    assert [mark.label for mark in panel.marks] == ["capacity", "pads", "more pads"]
    assert (capacity.look, pads.look, more.look) == (Look("limit"), line_of(0), line_of(1))
    assert (pads.x.tolist(), more.x.tolist()) == ([1000.0], [4000.0, 5000.0])
    for axis, along in ((panel.x, "x"), (panel.y, "y")):
        drawn = np.concatenate([getattr(mark, along) for mark in panel.marks])
        assert axis.low <= drawn.min() < drawn.max() <= axis.high


def test_a_section_shows_moments_at_its_height_and_the_base_shears():
    section, base = (panel_over_axial_force((1e3, 4e3, 5e3), at_m=at_m) for at_m in (2.5, math.nan))
    assert [(panel.x.label, panel.y.label) for panel in (section, base)] == [
        ("N [kN]", "M [kN m]"),
        ("N [kN]", "V [kN]"),
    ]
    assert (section.caption, base.caption) == ("foot", "foot")
    assert ("2.5 m" in section.note, any(map(str.isdigit, base.note))) == (True, False)
