"""Terminal, page and files of an analysis have the same numbers: each is tested here, where all three come together."""

import json
import re

import pandas as pd
import pytest
from report_page import Page
from studies import RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.reporting.markup import number

pytestmark = pytest.mark.usefixtures("pages")

PULSES = [
    SINE | {"name": f"sine {period}", "period_s": period, "amplitude_g": 0.4, "duration_s": 3.0}
    for period in (0.6, 0.8, 1.0, 1.2, 1.5)
]
RELEASE = study_text(
    pier={"width_m": 0.3, "height_m": 1.2, "initial_rotation_rad": 0.1}, motions={"still_s": 5.0}, cases=(RIGID,),
    release={"impact_s": [0.324, 0.858, 1.313, 1.707, 2.048], "amplitude_rad": [0.0794, 0.0632, 0.0519, 0.0415, 0.0334]},
)  # fmt: skip
SENSITIVITY = study_text(
    pulses=PULSES[:1], cases=(RIGID,), sensitivity={"samples": 8, "uniform": {"p": [0.9, 1.1], "alpha": [0.18, 0.22]}},
)  # fmt: skip
FRAGILITY = study_text(
    pier={"alpha": 0.2, "p": 2.0}, pulses=PULSES, cases=(RIGID,), numerics={"tolerance": 1e-3},
    fragility={
        "method": "ida", "measure": "PGA", "levels_g": [0.2, 0.25, 0.3, 0.35],
        "dispersion": [{"name": "modelling", "value": 0.3}],
        "hazard": {"levels_g": [0.05, 0.2, 0.5], "return_period_years": [50, 475, 2475], "years": [50]},
    },
)  # fmt: skip
ACCURACY = study_text(pulses=PULSES[:2], cases=(RIGID,))


def made(tmp_path, capsys, text, command, *options):
    """Return what a command prints, the cells of the tables on its page, and the folder of its files."""
    out = tmp_path / "out"
    path = str(write_study(tmp_path, text))
    if command == "accuracy":
        assert main(["run", path, "--out", str(out)]) == 0
    capsys.readouterr()
    assert main([command, path, "--out", str(out), *options]) == 0
    page = out / ("report.html" if command == "accuracy" else "analyses.html")
    return capsys.readouterr().out, Page(page.read_text(encoding="utf-8")), out


def plain(text):
    """Return text with single spaces between words, whatever their kind."""
    return re.sub(r"\s+", " ", text.replace("\u2060", "")).strip()


def agree(printed, table, expected, names):
    """Hold rows of the page, and the ends of lines of the terminal, against ``expected`` cells, which follow ``names`` others."""
    lines = [plain(line) for line in printed.splitlines()]
    for cells, texts in zip(table, expected, strict=True):
        assert [plain(cell) for cell in cells[names : names + len(texts)]] == texts
        assert any(line.endswith(" ".join(filter(None, texts))) for line in lines), texts


def texts_of(rows, formats):
    """Return the texts of each row in these columns; empty without a value."""
    return [[number(row[name], form) for name, form in formats.items()] for row in rows.to_dict("records")]


def interval(low, high, form):
    return f"{low:{form}} – {'∞' if high is None or high != high else format(high, form)}"


@pytest.mark.slow
def test_a_release_test(tmp_path):
    out = tmp_path / "out"
    rb.release(write_study(tmp_path, RELEASE), out)
    page = Page((out / "analyses.html").read_text(encoding="utf-8"))
    (fit,) = pd.read_csv(out / "release.csv").to_dict("records")
    value, bounds = f"{fit['value']:.4g}", f"{fit['low']:.4g} to {fit['high']:.4g} (95%)"
    scatter, over = f"{fit['scatter']:.2g}", f"{fit['over_housner']:.3f}"
    ends, housner = f"{fit['low']:.4g} to {fit['high']:.4g}", f"{fit['value'] / fit['over_housner']:.4g}"
    rows = page.tables["release"]
    assert rows[0] == ["case", "fitted", "value", "interval", "scatter", "over Housner's"]
    assert rows[1] == ["rigid", "restitution", value, bounds, scatter, over]
    words = (
        f"rigid: restitution = {value} (95 %: {ends}), Housner's is {housner}; it scatters by ±{scatter} from impact to"
    )
    assert words in page.text
    assert fit["remark"] in page.text
    times = {"impact": "d", "t_measured_s": ".4f", "t_computed_s": ".4f"}
    amplitudes = {"amplitude_measured_rad": ".5f", "amplitude_computed_rad": ".5f"}
    apparent = {"restitution_measured": ".3f", "restitution_computed": ".3f"}
    assert rows[3] == ["impact", *["measured", "computed"] * 3]
    expected = texts_of(pd.read_csv(out / "release_impacts.csv"), times | amplitudes | apparent)
    assert [[plain(cell) for cell in cells] for cells in rows[4:]] == expected


def test_a_sensitivity(tmp_path, capsys):
    printed, page, out = made(tmp_path, capsys, SENSITIVITY, "sensitivity")
    table = pd.read_csv(out / "sensitivity.csv").merge(pd.read_csv(out / "sobol.csv"), on=["case", "parameter"])
    answers = {"answer_low": ".4f", "answer_base": ".4f", "answer_high": ".4f"}
    indices = {"first": ".3f", "first_error": ".3f", "total": ".3f", "total_error": ".3f"}
    ends = {"low": ".4g", "base": ".4g", "high": ".4g"}
    heads = ["low", "study", "high", "low", "study", "high", "first-order", "±", "total", "±"]
    rows = page.tables["sensitivity"]
    assert rows[0][1:] == ["answer at", "Sobol index"]
    assert rows[1] == ["input", *heads]
    assert " ".join(["input", *heads]) in plain(printed)
    assert "vertical component" not in page.text  # none of the inputs
    agree(printed, rows[2:], texts_of(table, ends | answers | indices), 1)


@pytest.mark.slow
def test_a_fragility_and_its_rates(tmp_path, capsys):
    printed, page, out = made(tmp_path, capsys, FRAGILITY, "fragility")
    (curve,) = json.loads((out / "fragility.json").read_text(encoding="utf-8"))["curves"]
    windows = curve["windows"]
    medians = [
        f"{curve['median']:.3g}", interval(*curve["median_interval"], ".3g"),
        f"{curve['dispersion']:.2f}", interval(*curve["dispersion_interval"], ".3g"),
        f"{(curve['dispersion'] ** 2 + 0.3**2) ** 0.5:.2f}",
        f"{windows['median']:.3g}", f"{100 * (windows['median'] / curve['median'] - 1):+.1f}",
    ]  # fmt: skip
    heads = ["median [g]", "95 %", "dispersion", "95 %", "with added", "by shares", "apart [%]"]
    rows = page.tables["fragility"]
    assert rows[0][: 2 + len(heads)] == ["limit", "case", *heads]
    assert " ".join(["limit", "case", *heads]) in plain(printed)
    agree(printed, rows[1:2], [medians], 2)
    assert curve["note"] == ""  # five records have an interval
    assert "within ±2 % of each level" in printed
    assert "within ±2 % of each level" in page.text

    (risk,) = pd.read_csv(out / "fragility_risk.csv").to_dict("records")
    heads = ["dispersion", "rate [1/year]", "95 %", "in 50 years", "90 % come from [g]"]
    names, cells = page.tables["risk"]
    assert names == ["limit", "case", *heads]
    assert " ".join(["limit", "case", *heads]) in plain(printed)
    low, p, high = (f"{100 * risk[f'p_in_50_years{end}']:.2g}" for end in ("_low", "", "_high"))
    rates = [risk["rate_per_year"], risk["rate_low"], risk["rate_high"]]
    others = [f"{p} % ({low} – {high})", interval(risk["contributing_from"], risk["contributing_to"], ".2g")]
    dispersion = f"{risk['dispersion_total']:.2f}"
    line = [dispersion, f"{rates[0]:.2e}", interval(*rates[1:], ".2e"), *others]
    assert " ".join(line) in plain(printed)
    assert [plain(cells[2]), *map(plain, cells[5:])] == [dispersion, *others]
    power = [cell.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")).replace("·10", "e") for cell in cells[3:5]]
    shown = [float(rate) for cell in power for rate in plain(cell).split(" – ")]
    assert shown == pytest.approx(rates, rel=0.05)
    assert risk["note"] in page.text
    assert f"overturning, rigid: {risk['note']}" in printed


@pytest.mark.slow
def test_an_accuracy(tmp_path, capsys):
    printed, page, out = made(tmp_path, capsys, ACCURACY, "accuracy", "--runs", "1", "--seconds", "5")
    table = pd.read_csv(out / "accuracy.csv").astype({"substeps": float, "runs": float, "compared": float})
    heads = ["method", "k", "tolerance", "runs", "with error", "median error", "95 %", "largest", "time per run [ms]"]
    rows = page.tables["error_and_time"]
    assert rows[0][: len(heads)] == heads
    assert " ".join(heads) in plain(printed)
    for row, expected in zip(rows[1:], table.to_dict("records"), strict=True):
        formats = {"method": "", "substeps": ".0f", "tolerance": ".0e", "runs": ".0f", "compared": ".0f"}
        formats |= {"error_median": ".1e", "error_95": ".1e", "error_max": ".1e"}
        texts = [number(expected[name], form) for name, form in formats.items()]
        assert row[: len(texts)] == texts
        assert plain(" ".join(row)) in map(plain, printed.splitlines())
        assert float(row[len(texts)]) == pytest.approx(1000 * expected["seconds_per_run"], rel=0.01, abs=0.51)
