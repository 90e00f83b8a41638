"""Intensity measures beside the peaks: their values, who is asked, and what overturned runs count for."""

import math
import re

import numpy as np
import pandas as pd
import pytest
import scipy.stats
from motion_files import wiggle, write_at2
from report_page import Page
from studies import COSINE, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.motions.intensity import measures
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.observers.intensity.order import order_of
from rockbatch.observers.intensity.section import _tables, section
from rockbatch.observers.intensity.table import measures_in
from rockbatch.reporting.finished import read
from rockbatch.results import suite_statistics
from rockbatch.results.suite_statistics import distribution

PULSES = tuple(
    {**shape, "name": f"{shape['shape']} {size}", "amplitude_g": size}
    for shape in (SINE, COSINE)
    for size in (0.15, 0.3, 0.6)
)
ASKED = {"intensity": True, "sa_periods_s": [0.5, 1.25], "histories": "none"}


def written(folder, output=ASKED, **more):
    text = study_text(pier={"alpha": [0.2, 0.3], "p": 1.0}, output=output, **{"pulses": PULSES, **more})
    rb.run(write_study(folder, text), out=folder / "out")
    return rb.open_results(folder / "out")


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return written(tmp_path_factory.mktemp("intensity"), motions={"polarity": ["+", "-"], "scale": [1.0, 1.5]})


def test_every_simulated_run_has_its_measures_in_the_order_of_the_peaks(results):
    table = results.intensity
    peaks = results.peaks[results.peaks["mirror_of"] == ""].reset_index(drop=True)
    assert len(table) == 6 * 2 * 4
    for name in ("record", "case", "scale", "alpha", "status", "theta_max_over_alpha"):
        assert (table[name] == peaks[name]).all() or np.allclose(table[name], peaks[name], equal_nan=True)


def test_measures_are_those_of_the_scaled_motion_and_the_runs_own_pier(results):
    for row in results.intensity.to_dict("records"):
        pulse = next(pulse for pulse in PULSES if pulse["name"] == row["record"])
        motion = rb.pulse(
            pulse["shape"], name="p", amplitude=pulse["amplitude_g"] * 9.81 * row["scale"], period=pulse["period_s"],
            dt=pulse["dt_s"], duration=pulse["duration_s"],
        )  # fmt: skip
        a, uplift = motion.horizontal, 9.81 * math.tan(row["alpha"])
        assert row["pga_over_g_tan_alpha"] == pytest.approx(motion.pga / uplift)
        assert row["p_pgv_over_g_tan_alpha"] == pytest.approx(1.0 * measures.pgv(a, motion.dt) / uplift)
        assert row["bracketed_s"] == pytest.approx(measures.bracketed_duration(a, motion.dt, uplift))
        assert row["uniform_s"] == pytest.approx(measures.uniform_duration(a, motion.dt, uplift))
        assert row["cav_m_s"] == pytest.approx(measures.cumulative_absolute_velocity(a, motion.dt))
        sa = spectral_acceleration(a, motion.dt, [0.5, 1.25]) / 9.81
        assert [row["sa_0.5s_g"], row["sa_1.25s_g"]] == pytest.approx(sa)


def test_order_has_a_row_for_each_case_scale_and_measure(results):
    order = results.intensity_order
    assert len(order) == 4 * 2 * 7
    one = order[(order["case"] == "rigid") & (order["alpha"] == 0.3) & (order["scale"] == 1.0)]
    assert set(one["runs"]) == {6}
    runs = results.intensity.query("case == 'rigid' and alpha == 0.3 and scale == 1.0")
    peak = runs["theta_max_over_alpha"].where(runs["status"] == "ok", math.inf)
    for row in one.to_dict("records"):
        wanted = scipy.stats.spearmanr(runs[row["measure"]], peak.rank()).statistic
        assert row["rank_correlation"] == pytest.approx(wanted)


@pytest.mark.parametrize("seed", range(5))
def test_rank_correlation_and_line_are_those_of_scipy_ties_and_all(seed):
    draw = np.random.default_rng(seed)
    measure = np.round(draw.lognormal(size=30), 1)
    theta = np.round(measure * draw.lognormal(0, 0.5, size=30), 1) + 0.1
    found = order_of(measure, theta, ["ok"] * 30)
    assert found.rank_correlation == pytest.approx(scipy.stats.spearmanr(measure, theta).statistic)
    moved = measure > 0
    line = scipy.stats.linregress(np.log(measure[moved]), np.log(theta[moved]))
    residual = np.log(theta[moved]) - line.intercept - line.slope * np.log(measure[moved])
    assert found.slope == pytest.approx(line.slope)
    assert found.dispersion == pytest.approx(math.sqrt((residual**2).sum() / (moved.sum() - 2)))


def test_overturned_runs_rank_above_all_and_are_left_out_of_the_line():
    measure = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    theta = np.array([0.1, 0.2, 0.3, 0.05, 0.01, np.nan])
    status = ["ok", "ok", "ok", "overturned", "flight", "failed"]
    found = order_of(measure, theta, status)
    assert (found.runs, found.without_peak, found.fitted) == (5, 2, 3)
    assert found.rank_correlation == pytest.approx(scipy.stats.spearmanr([1, 2, 3, 4, 5], [1, 2, 3, 4, 4]).statistic)
    assert (found.slope, found.dispersion) == (pytest.approx(1.0), pytest.approx(0.0, abs=1e-7))


def test_runs_that_stayed_rank_lowest_and_have_no_logarithm():
    found = order_of(np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 0.1]), ["ok"] * 3)
    assert found.rank_correlation == pytest.approx(scipy.stats.spearmanr([1, 2, 3], [1, 1, 2]).statistic)
    assert found.fitted == 1
    assert math.isnan(found.dispersion)
    assert math.isnan(order_of(np.ones(4), np.arange(4.0), ["ok"] * 4).rank_correlation)
    assert math.isnan(order_of(np.arange(2.0), np.arange(2.0), ["ok"] * 2).rank_correlation)


def test_nobody_gets_what_nobody_asked_for_and_tables_of_another_time_go(tmp_path):
    few = {"pulses": PULSES[:1], "cases": (RIGID,)}
    results = written(tmp_path, **few)
    assert (tmp_path / "out" / "intensity.csv").exists()
    assert all("pulse_period_s" in record for record in results.info["records"])
    plain = written(tmp_path, {"histories": "none"}, **few)
    assert not (tmp_path / "out" / "intensity.csv").exists()
    assert "pulse" not in plain.info["records"][0]
    assert "target" not in plain.info
    with pytest.raises(InputError, match=r"add \[output\] intensity = true"):
        plain.intensity  # noqa: B018


def test_periods_without_the_table_are_refused(tmp_path):
    with pytest.raises(InputError, match=r"sa_periods_s = \[1\.0\]: is for intensity = true"):
        rb.load_study(write_study(tmp_path, study_text(output={"sa_periods_s": [1.0]})))


# The distribution


def test_a_distribution_counts_overturned_runs_as_larger_than_any():
    values = np.array([0.3, -0.1, 0.2, 0.9, 0.5, np.nan])
    theta, share = distribution(values, ["ok", "ok", "ok", "overturned", "flight", "failed"])
    assert theta.tolist() == [0.1, 0.2, 0.3]
    assert share.tolist() == pytest.approx([0.2, 0.4, 0.6])
    by_station = distribution(
        values, ["ok", "ok", "ok", "overturned", "flight", "failed"], ["A", "A", "B", "C", "B", "C"]
    )
    assert [each.tolist() for each in by_station] == [[0.3], [pytest.approx(1 / 3)]]
    theta, share = distribution(np.array([0.4]), ["overturned"])
    assert (len(theta), len(share)) == (0, 0)


def test_the_distribution_is_drawn_with_a_curve_for_each_case_pier_and_scale(results):
    panels = [axes for axes in results.plot_cdf().axes if axes.lines]
    assert len(panels) == 2 * 2
    assert {len(axes.lines) for axes in panels} == {2}
    assert panels[0].get_title().replace("\u00a0", " ") == "α = 0.2 rad, motions scaled by 1"
    first = results.peaks.query("case == 'rigid' and alpha == 0.2 and scale == 1.0 and mirror_of == ''")
    stood = first["status"] == "ok"
    assert panels[0].lines[0].get_xdata()[1:-1:2].tolist() == sorted(first["theta_max_over_alpha"][stood])
    assert panels[0].lines[0].get_ydata()[-1] == pytest.approx(stood.mean())


def test_a_suite_that_all_overturned_has_a_picture_too(tmp_path):
    strong = {**SINE, "amplitude_g": 9.0, "period_s": 3.0, "confirm": "amplitude_g"}
    found = written(tmp_path, {"histories": "none"}, pulses=(strong,), cases=({"name": "rigid", "base": "rigid"},))
    assert set(found.peaks["status"]) == {"overturned"}
    panels = found.plot_cdf().axes
    assert {axes.get_xlim() for axes in panels} == {(0.0, 1.08)}
    assert [[line.get_marker() for line in axes.lines] for axes in panels] == [["None", "None", "X"]] * 2


# Of pairs


def write_pairs(folder, lone=()):
    for name, seed in (("RSN1_A_000", 1), ("RSN1_A_090", 2), ("RSN2_B_000", 3), ("RSN2_B_090", 4)):
        _, station, azimuth = name.split("_")
        if name not in lone:
            title = f"Made-up, 1/17/1994, Station {station}, {azimuth}"
            write_at2(folder / "records", f"{name}.AT2", 4.0 * wiggle(500, seed), title=title)


def pairs_study(folder, **motions):
    output = ASKED | {"sa_periods_s": [0.3], "sa_pairs": ["rotd50", "rotd100"]}
    text = study_text(
        motions={"path": "records", "scale": [1.0, 2.0], **motions}, pulses=(), output=output, cases=[RIGID]
    )
    return write_study(folder, text)


@pytest.mark.usefixtures("pages")
def test_measures_of_pairs_are_of_both_components_and_empty_without_one(tmp_path):
    write_pairs(tmp_path, lone=("RSN2_B_090",))
    rb.run(pairs_study(tmp_path), out=tmp_path / "out")
    table = rb.open_results(tmp_path / "out").intensity
    names = ["sa_0.3s_g", "sa_0.3s_rotd50_g", "sa_0.3s_rotd100_g"]
    assert list(table)[-3:] == names
    motions = rb.read_motions(tmp_path / "records")
    spectrum = rb.pair_spectrum(motions[0], motions[1], [0.3]).iloc[0]
    for row in table.to_dict("records"):
        if row["record"].startswith("RSN1"):
            assert row[names[1]] == pytest.approx(row["scale"] * spectrum["rotd50_g"], rel=1e-9)
            assert row[names[2]] == pytest.approx(row["scale"] * spectrum["rotd100_g"], rel=1e-9)
            assert row[names[0]] <= row[names[2]] * (1 + 1e-9)
        else:
            assert math.isnan(row[names[1]])
            assert row[names[0]] > 0.0
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "RotD100(0.3\u00a0s)" in page
    assert "SA(0.3\u00a0s)" in page


def test_turned_to_the_axis_a_motion_has_the_measures_of_its_pair(tmp_path):
    write_pairs(tmp_path)
    both = []
    for name, motions in (("recorded", {}), ("turned", {"axis_deg": 25})):
        rb.run(pairs_study(tmp_path, **motions), out=tmp_path / name)
        table = rb.open_results(tmp_path / name).intensity
        both.append(sorted({round(value, 9) for value in table["sa_0.3s_rotd100_g"]}))
    assert both[0] == pytest.approx(both[1], rel=1e-4)


def test_pairs_without_intensity_are_answered(tmp_path):
    with pytest.raises(InputError, match=r"sa_pairs = .*: is for intensity = true"):
        rb.load_study(write_study(tmp_path, study_text(output={"sa_pairs": ["rotd50"]})))
    with pytest.raises(InputError, match=r'sa_pairs = "srss": expected one of "geomean", "rotd50", "rotd100"'):
        rb.load_study(write_study(tmp_path, study_text(output={"intensity": True, "sa_pairs": ["srss"]})))


def test_the_worst_records_and_the_most_frequent_reasons_come_first():
    table = pd.DataFrame({
        "record": ["a", "b", "b", "c", "d", "e"],
        "theta_max_over_alpha": [0.4, 0.1, 0.6, np.nan, 0.5, np.nan],
        "status": ["ok", "ok", "ok", "flight", "ok", "failed"],
        "reason": ["", "", "", "", "", "x"],
    })  # fmt: skip
    assert suite_statistics.worst_records(table, 3) == ["c", "b", "d"]
    kinds = ["contacts", "not settled", "ratchets", "not settled", "ratchets", "not settled"]
    reasons = ["c", "at 1: a", "z", "at 2: b", "y", "at 3"]
    failed = pd.DataFrame({"status": ["failed"] * 6, "failure": kinds, "reason": reasons})
    assert suite_statistics.reasons_of_failure(failed) == ["3 ×, for example: at 1: a", "2 ×, for example: z"]
    assert suite_statistics.reasons_of_failure(failed[:1]) == ["1 ×: c"]


@pytest.mark.parametrize("blank", [(), (1,), (0, 2), slice(None)])
def test_the_best_measure_is_the_extreme_of_those_that_have_a_number(results, blank):
    """Largest rank correlation, least dispersion; a dash without any, as in the first row if all are blank there."""
    finished, order = read(results.directory, ()), results.intensity_order.copy()
    first = (order["scale"] == 1.0) & (order["alpha"] == order["alpha"].min())
    for column in ("rank_correlation", "dispersion"):
        names = order["measure"].unique()
        order.loc[order["measure"].isin(names[blank if isinstance(blank, slice) else list(blank)]) & first, column] = (
            np.nan
        )
    tables = [Page(str(drawn)).tables[""] for drawn in _tables(finished, order)]
    for (head, *rows), column, best in zip(
        tables, ("rank_correlation", "dispersion"), ("idxmax", "idxmin"), strict=True
    ):
        place = head.index("largest" if best == "idxmax" else "least")
        groups = order.groupby(["case", *finished.info["varied"], "scale"], sort=False)
        for row, (_, group) in zip(rows, groups, strict=True):
            numbers = group.set_index("measure")[column].dropna()
            assert row[place] == (measures_in(numbers.index)[getattr(numbers, best)()].symbol if len(numbers) else "—")


def test_the_page_has_a_row_for_each_case_and_scale_and_names_both(results):
    shown = Page(section(read(results.directory, ()))).tables[""]
    rows = [row for row in shown if row[0] != "case"]
    of_rows = [same.iloc[0] for _, same in results.intensity_order.groupby(["case", "alpha", "scale"], sort=False)]
    assert [float(row[1]) for row in rows] == 2 * [same["scale"] for same in of_rows]
    assert {row[1] for row in rows} == {"1", "1.5"}
    alphas = [float(re.search(r"α = ([\d.]+)", row[0].replace("\u00a0", " "))[1]) for row in rows]
    assert alphas == 2 * [same["alpha"] for same in of_rows]
