"""Self-similar spectra (Dimitrakopoulos & DeJong 2012): blocks of all sizes, and slender ones of any α, on one curve."""

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from slender_block import end_of_pulse
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.spectrum.figures import spectra
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.common.figures.description import Points
from rockbatch.results.figures import self_similar
from rockbatch.results.labelled import labelled

AXES = {"omega_g_over_p": [3.0, 6.0], "points": 4, "pga_over_g_tan_alpha": [1.5, 2.5]}
E = 0.9


def pulse(name, shape, period, amplitude_g):
    """A pulse of 400 samples in its period, followed by as many zeros."""
    times = {"period_s": period, "dt_s": period / 400, "duration_s": 2 * period}
    return SINE | times | {"name": name, "shape": shape, "amplitude_g": amplitude_g}


def spectrum(alphas, pulses, cases, **numerics):
    """Return spectrum.csv, indexed by all that tells its runs apart."""
    text = study_text(pulses=pulses, cases=cases, numerics=numerics, spectrum={"alpha": alphas, **AXES})
    table = rb.spectrum(rb.Study.from_toml(text), jobs=1).spectrum
    return table.set_index(["case", "record", "alpha", "pga_over_g_tan_alpha", "omega_g_over_p"])


def test_piers_of_all_sizes_are_one_under_pulses_of_one_shape():
    """Two one-sines, 0.4 and 1.7 s long: p of the piers differs by as much. To 1e-9: the same steps, in other units of time."""
    pulses = [pulse("short", "sine", 0.4, 0.3), pulse("long", "sine", 1.7, 0.8)]
    table = spectrum([0.2], pulses, [RIGID, PADS | {"epsilon": 0.1}])
    short, long = (table.xs(name, level="record") for name in ("short", "long"))
    assert (short["p"] / long["p"]).to_list() == pytest.approx([1.7 / 0.4] * 16, rel=1e-9)
    assert (short["status"] == long["status"]).all()
    stood = short["status"] == "ok"
    assert stood.sum() > 8
    np.testing.assert_allclose(short["theta_max_over_alpha"][stood], long["theta_max_over_alpha"][stood], rtol=1e-9)


def first_swing(amplitude, w):
    """Return θ_max/α of a slender block after a half-sine that does not overturn it; x = θ/α − 1, and x² − x′² is kept."""
    x, x_rate = end_of_pulse(amplitude, math.pi, w)
    return 1.0 - math.sqrt(x * x - x_rate * x_rate)


def test_slender_piers_share_the_curve_that_has_a_closed_form():
    """Half-sines: PGV = 2a/ω, so ω_g is half of ω. 2e-4 of it: 400 samples in a period; α² adds 10⁻⁶."""
    table = spectrum([1e-3, 2e-3], [pulse("half", "half-sine", 0.7, 0.1)], [RIGID | {"restitution": E}], tolerance=1e-7)
    curves = [table.xs(alpha, level="alpha") for alpha in (1e-3, 2e-3)]
    np.testing.assert_allclose(*(curve["theta_max_over_alpha"] for curve in curves), rtol=1e-5)
    for (_, _, amplitude, frequency), row in curves[0].iterrows():
        assert row["status"] == "ok"
        assert row["theta_max_over_alpha"] == pytest.approx(first_swing(amplitude, 2.0 * frequency), rel=2e-4)


def test_other_piers_part_from_the_curve_as_alpha_squared():
    """The paper calls them practically self-similar: with one e, α = 0.2 is within 3 %, and 0.1 at a quarter of that."""
    table = spectrum(
        [1e-3, 0.1, 0.2], [pulse("half", "half-sine", 0.7, 0.1)], [RIGID | {"restitution": E}], tolerance=1e-7
    )
    slender, middle, stocky = (table.xs(alpha, level="alpha")["theta_max_over_alpha"] for alpha in (1e-3, 0.1, 0.2))
    assert 0.005 < (stocky / slender - 1.0).abs().max() < 0.03
    np.testing.assert_allclose((stocky - slender) / (middle - slender), 4.0, atol=0.15)


@pytest.mark.thorough
def test_near_fault_records_share_the_curves_as_the_page_says():
    """docs/pages/questions/size.md: α = 0.2 over 0.05 where both stand, in the median, in 95 % of the points, and at most."""
    runs = rb.spectrum(Path(__file__).parents[3] / "configs" / "self_similar.toml").spectrum
    keys = ["record", "pga_over_g_tan_alpha", "omega_g_over_p"]
    stood = runs[runs["status"] == "ok"].pivot_table("theta_max_over_alpha", keys, "alpha")
    gaps = (stood[0.2] / stood[0.05] - 1.0).abs().dropna()
    assert len(gaps) > 400
    assert gaps.quantile([0.5, 0.95]).to_list() == pytest.approx([0.006, 0.044], abs=0.001)
    assert gaps.max() == pytest.approx(4.0, abs=0.1)
    sizes = runs.groupby("omega_g_over_p")["size_m"].agg(["min", "max"])
    assert sizes.loc[2.0].to_list() == pytest.approx([0.2, 2.8], abs=0.05)
    assert sizes.loc[14.0].to_list() == pytest.approx([10.6, 139.0], rel=0.01)


STUDY = study_text(
    title="one curve",
    pulses=[pulse("sine", "sine", 0.6, 0.3), pulse("cosine", "cosine", 1.1, 0.5)],
    cases=(RIGID | {"restitution": E},),
    spectrum={"alpha": [0.1, 0.2], **AXES},
)


@pytest.mark.usefixtures("pages")
def test_every_run_has_the_intensity_and_frequency_of_its_point(tmp_path, capsys):
    """PGA and PGV of the pulses: a sine has 2a/ω, a cosine a/ω; 1e-4 for the samples and the straight lines between them."""
    out = tmp_path / "out"
    assert main(["spectrum", str(write_study(tmp_path, STUDY)), "--out", str(out)]) == 0
    runs = pd.read_csv(out / "spectrum.csv")
    assert len(runs) == 2 * 2 * 2 * 4
    for row in runs.to_dict("records"):
        period, pga, cycles = (0.6, 0.3, 2.0) if row["record"] == "sine" else (1.1, 0.5, 1.0)
        assert row["scale"] * pga / math.tan(row["alpha"]) == pytest.approx(row["pga_over_g_tan_alpha"], rel=1e-4)
        assert 2 * math.pi / period / cycles / row["p"] == pytest.approx(row["omega_g_over_p"], rel=1e-4)
        assert row["size_m"] * row["p"] ** 2 == pytest.approx(0.75 * 9.81)
    points = pd.read_csv(out / "spectrum_suite.csv")
    assert list(points["count"]) == [2] * 16
    assert points["least_size_m"].min() == runs["size_m"].min()
    assert points["greatest_scale"].max() == runs["scale"].max()
    assert "omega_g = PGA/PGV of each record; piers with R0 = " in capsys.readouterr().out
    report = (out / "analyses.html").read_text(encoding="utf-8")
    assert "Self-similar spectra" in report
    assert "PGA/(g tan α) = 1.5" in report.replace("\u00a0", " ")


def test_the_figure_has_a_panel_for_each_intensity_and_a_median_for_each_slenderness():
    result = rb.spectrum(rb.Study.from_toml(STUDY), jobs=1)
    panels = spectra(result.spectrum_suite, result.spectrum, result.info).panels
    assert len(panels) == 2
    labels = {mark.label.replace("\u00a0", " ") for mark in panels[0].marks if mark.label}
    assert labels == {"each record", "α = 0.1 rad, median", "α = 0.2 rad, median"}
    with pytest.raises(InputError, match="must be omega_g_over_p in this spectrum"):
        result.plot(axis="p")


def test_other_spectra_are_drawn_over_each_of_their_axes_and_not_over_this_one():
    text = study_text(cases=[RIGID], spectrum={"alpha": [0.2], "p": [1.0, 2.0], "points": 3})
    result = rb.spectrum(rb.Study.from_toml(text), jobs=1)
    over = {axis: result.plot(axis=axis).axes[0] for axis in ("two_pi_over_p_s", "p", "size_m")}
    assert over["p"].lines[0].get_xdata() == pytest.approx([1.0, 1.5, 2.0])
    assert over["size_m"].lines[0].get_xdata() == pytest.approx(0.75 * 9.81 / np.array([1.0, 1.5, 2.0]) ** 2)
    assert result.plot().axes[0].get_xlabel() == over["two_pi_over_p_s"].get_xlabel()
    with pytest.raises(InputError, match="for omega_g_over_p write it as the range in"):
        result.plot(axis="omega_g_over_p")
    with pytest.raises(InputError, match=r'axis = "period": must be .* in this spectrum$'):
        result.plot(axis="period")


@pytest.mark.parametrize(("change", "line", "words"), [
    (("pga_over_g_tan_alpha = [1.5, 2.5]\n", ""), 31, "pga_over_g_tan_alpha is missing beside omega_g_over_p; write for"),
    (("omega_g_over_p = [3.0, 6.0]", "p = [1, 2]"), 33, "pga_over_g_tan_alpha = [1.5, 2.5]: goes with omega_g_over_p"),
    (("omega_g_over_p = [3.0, 6.0]", "omega_g_over_p = [6.0, 3.0]"), 31, "expected a range"),
    (("[[motions.pulse]]", "[motions]\nscale = 2.0\n\n[[motions.pulse]]"), 34, "so scale in [motions] has no effect"),
    (("pga_over_g_tan_alpha = [1.5", "pga_over_g_tan_alpha = [0"), 33, "pga_over_g_tan_alpha = 0: expected a number above 0"),
])  # fmt: skip
def test_keys_that_do_not_fit_are_reported_with_their_line(tmp_path, change, line, words):
    text = STUDY.replace(*change, 1)
    with pytest.raises(InputError) as caught:
        rb.spectrum(write_study(tmp_path, text))
    assert any(f"study.toml:{line}: " in problem and words in problem for problem in caught.value.messages), (
        caught.value
    )


def test_bases_given_in_kilonewtons_have_no_place_on_piers_of_many_sizes(tmp_path):
    stiff = {"name": "pads", "base": "elastic", "stiffness_kN_m": 2.0e6, "zeta": 0.05}
    damper = {"kind": "viscous", "coefficient_kN_s_m": 2000.0}
    tied = RIGID | {"name": "tied", "damper": [damper]}
    ratios = PADS | {"name": "ratios", "epsilon": 0.1}
    pier = {"alpha": 0.2, "p": 1.0, "mass_t": 3000.0}
    text = study_text(pier=pier, cases=[RIGID, stiff, tied, ratios], spectrum={"alpha": [0.2], **AXES})
    with pytest.raises(InputError) as caught:
        rb.spectrum(write_study(tmp_path, text))
    problems = [problem.split(": ", 2)[2] for problem in caught.value.messages]
    assert len(problems) == 2
    for problem, name in zip(problems, ("pads", "tied"), strict=True):
        assert f'case "{name}" has another base for each size; give its ratios: beta, eta, nu instead of' in problem


def test_still_ground_is_refused():
    still = rb.Motion("still", 0.01, np.zeros(100))
    with pytest.raises(InputError, match="still: PGA/PGV has no value"):
        rb.spectrum(rb.Study.from_toml(STUDY), motions=[still], jobs=1)


@pytest.mark.slow
def test_peaks_are_drawn_where_their_intensity_and_frequency_are(tmp_path):
    """A panel for each base; each run where intensity.csv puts it: PGA/(g tan α) over the ratio of its two groups."""
    text = study_text(
        pier={"alpha": [0.1, 0.2], "p": 1.5},
        motions={"polarity": ["+", "-"]},
        pulses=[SINE, SINE | {"name": "weak", "amplitude_g": 0.05}],
        output={"intensity": True},
    )
    rb.run(rb.Study.from_toml(text), out=tmp_path / "out", jobs=1)
    results = rb.open_results(tmp_path / "out")
    results.plot(axes="self-similar").draw_without_rendering()
    own = labelled(results.peaks, results.info, results.directory)
    rigid = self_similar(own, results.info).panels[0]
    assert rigid.caption == "rigid"
    shown = np.vstack([np.column_stack([mark.x, mark.y]) for mark in rigid.marks if isinstance(mark, Points)])
    rows = results.intensity[results.intensity["case"] == "rigid"]
    a, v = rows["pga_over_g_tan_alpha"], rows["p_pgv_over_g_tan_alpha"]
    expected = np.column_stack([a / v, a])
    assert len(shown) == len(expected) == 4
    np.testing.assert_allclose(np.sort(shown, axis=0), np.sort(expected, axis=0), rtol=1e-6)
    with pytest.raises(InputError, match='must be "records" or "self-similar"'):
        results.plot(axes="self similar")
    records = [
        record | {"pgv_m_s": record["pgv_m_s"] * (1.0 + i * 2.0**-52)}
        for i, record in enumerate(results.info["records"])
    ]
    narrow = self_similar(own, results.info | {"records": records}).panels[0].x  # not narrower than rounding
    assert narrow.high > 1.1 * narrow.low
