"""The worst run of each case is played by the curves of the page: pier and ground in one clock, still where it is asked for."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from browser import HOSTILE, browse, needs_chromium, tab
from report_samples import FOUNDATIONS, case_entry, report, response, write_results

from rockbatch.pier import Pier
from rockbatch.reporting import write_report
from rockbatch.reporting.finished import read
from rockbatch.reporting.sections import histories as of_histories
from rockbatch.reporting.sheet import sheet_of
from rockbatch.reporting.typeset import Setting, blocks, parsed

PIER = Pier(alpha=0.13, p=0.38)
RUNS = [("ERZ-NS", 1), ("SYL360", 1), ("SYL360", 2)]


def players(page):
    """Return the figures of the player of a page."""
    found = page.partition('<div class="player">')[2].partition('<p class="legend">The pier at its peak')[0]
    return list(parsed(f"<div>{found}").iter("figure")) if found else []


def pages(folder, worst="ERZ-NS"):
    """Write a report of which case 1 has two histories, that under ``worst`` being its worst."""
    changes = {(name, "1"): {"theta_max_over_alpha": 0.9 if name == worst else 0.2} for name in ("ERZ-NS", "SYL360")}
    write_results(folder, changes=changes)
    runs = [response(name, *FOUNDATIONS[place], pier=PIER) for name, place in RUNS]
    return write_report(folder, runs), runs


@pytest.mark.parametrize("worst", ["ERZ-NS", "SYL360"])
def test_each_case_is_played_once_under_its_worst_motion(tmp_path, worst):
    page, _ = pages(tmp_path, worst)
    figures = players(page.read_text(encoding="utf-8"))
    words = ["".join(figure[0].itertext()).replace("\u00a0", " ") for figure in figures]
    assert words == [f"1: β = 40, η = 2.5 under {worst}", "2: β = 40, η = 3.5 under SYL360"]
    assert [figure.get("class") for figure in figures] == ["chosen", None]
    titles = re.findall(
        r"<figcaption><strong>([\w-]+)</strong>", page.read_text(encoding="utf-8").partition('class="histories"')[2]
    )
    assert [titles[int(figure.get("data-picture"))] for figure in figures] == [worst, "SYL360"]
    assert [figure.get("data-curve") for figure in figures] == ["0", "1"]


def test_the_still_drawing_is_the_pier_at_its_peak_turned_by_a_stated_factor(tmp_path):
    page, runs = pages(tmp_path)
    figure = players(page.read_text(encoding="utf-8"))[0]
    at = int(np.argmax(np.abs(runs[0].theta)))
    theta, time = float(runs[0].theta[at]), float(runs[0].t[at])
    words = "".join(figure[-1].itertext())
    factor = int(re.search(r"rotation drawn (\d+) times as large", words)[1])
    assert words.startswith(f"θ/α = {abs(theta) / PIER.alpha:.4f} at {time:.1f} s; ")
    assert factor * abs(theta) <= 0.25 < 2.6 * factor * abs(theta)
    moves = next(group for group in figure.iter("g") if group.get("class") == "moves")
    turned, pivot, level = map(float, re.findall(r"-?[\d.]+", moves.get("transform")))
    assert turned == pytest.approx(math.degrees(factor * theta), abs=2e-3)
    outline = moves[0].get("d")
    left, top, right = (
        float(re.search(pattern, outline)[1]) for pattern in (r"M(-[\d.]+) 0", r"V(-[\d.]+)", r"H([\d.]+)")
    )
    assert (pivot, level) == (math.copysign(right, theta), 0.0)  # to the right about the right pivot
    assert (right - left) / -top == pytest.approx(2.0 * PIER.half_width / PIER.highest, rel=5e-3)
    assert float(figure.get("data-turn")) == pytest.approx(math.degrees(factor * PIER.alpha), rel=1e-5)
    greatest = float(np.abs(runs[0].history["ag_h"]).max()) / PIER.gravity
    assert f"ground acceleration, {greatest:.3g} g at its longest" in words
    assert "rotation to scale" not in words


def test_without_a_history_nothing_is_played(tmp_path):
    page = report(tmp_path)
    assert 'class="player"' not in page
    assert "under the worst motion whose history is kept" not in page


def test_a_history_whose_run_was_taken_out_of_the_table_is_drawn_and_not_played(tmp_path):
    _, runs = pages(tmp_path)
    table = tmp_path / "peaks.csv"
    header, *rows = table.read_text(encoding="utf-8").splitlines(keepends=True)
    kept = [row for row in rows if ",2," not in row[: row.index("ok")]]
    assert 0 < len(kept) < len(rows)
    table.write_text("".join([header, *kept]), encoding="utf-8")
    page = write_report(tmp_path, runs).read_text(encoding="utf-8")
    assert ["".join(figure[0].itertext()).replace("\u00a0", " ") for figure in players(page)] == [
        "1: β = 40, η = 2.5 under ERZ-NS"
    ]
    assert "2: β = 40, η = 3.5" in page.replace("\u00a0", " ")


def test_a_player_costs_less_than_sixty_kilobytes_for_as_many_cases_as_are_played(tmp_path):
    names = [f"case number {n} with a name that is long enough to cost something" for n in range(60)]
    cases = [case_entry(name, {}, PIER, FOUNDATIONS[1][1]) for name in names]
    write_results(tmp_path, records=[(f"record {n}", 0.3) for n in range(10)], cases=cases)
    runs = [response(f"record {n // 6}", name, FOUNDATIONS[1][1], pier=PIER) for n, name in enumerate(names)]
    page = write_report(tmp_path, runs).read_text(encoding="utf-8")
    figures = players(page)
    assert 30 < len(figures) <= of_histories.MOST_PLAYED
    start = page.index('<div class="player">')
    added = page[start : page.index('<div class="histories">')]
    script = page.partition("// The worst run of each case")[2].partition("</script>")[0]
    assert len(script) > 3000
    assert len((added + script).encode()) < 60_000


def test_the_sheet_and_its_pdf_show_the_worst_case_at_its_peak_only(tmp_path):
    pages(tmp_path)
    runs = [response(name, *FOUNDATIONS[place], pier=PIER) for name, place in RUNS]
    (section,) = (part for part in sheet_of(read(tmp_path, runs)).sections if part.anchor == "histories")
    setting = Setting({})
    written = blocks(parsed(section.content), setting)
    assert "under ERZ" in written
    drawn = [picture for picture in setting.pictures.values() if b'class="moves"' in picture]
    assert len(drawn) == 1
    assert b"rotate(" in drawn[0]


@needs_chromium
def test_pier_and_ground_follow_the_history_in_one_clock(tmp_path):
    page, runs = pages(tmp_path)
    act = """
    const figures = [...document.querySelectorAll(".player > figure")], bar = document.querySelector(".buttons");
    const [play, back, on] = bar.querySelectorAll("button"), words = bar.querySelector("output");
    const slider = bar.querySelector("input"), now = (time) => { slider.value = time; slider.dispatchEvent(new Event("input")); };
    const state = () => {
      const figure = document.querySelector(".player > .chosen");
      const [pier, arrow] = [".moves", ".push"].map((name) => figure.querySelector(name));
      return [words.textContent, pier.getAttribute("transform"), arrow.getAttribute("d"), slider.value];
    };
    found.names = [play, back, on, slider, bar].map((node) => node.ariaLabel ?? node.textContent);
    found.role = bar.getAttribute("role");
    found.first = state();
    found.at = [];
    for (const time of [0.1, 0.3, 1, 2.5, 3.3, 6]) { now(time); found.at.push(state()); }
    found.valued = slider.getAttribute("aria-valuetext");
    on.click(); on.click(); back.click();
    found.stepped = state()[3];
    now(1);
    const speed = bar.querySelectorAll("select")[1];
    speed.value = "2"; speed.dispatchEvent(new Event("change"));
    const began = performance.now();
    play.click();
    found.playing = play.textContent;
    await new Promise((resolve) => setTimeout(resolve, 500));
    play.click();
    found.ran = [Number(slider.value) - 1, (performance.now() - began) / 1000, play.textContent];
    const stopped = slider.value;
    await later();
    found.stays = slider.value === stopped;
    speed.value = "5"; speed.dispatchEvent(new Event("change"));
    now(Number(slider.max) - 0.2);
    play.click();
    await new Promise((resolve) => setTimeout(resolve, 600));
    found.ended = [slider.value === slider.max || Math.abs(slider.value - slider.max) < 0.011, play.textContent];
    const cases = bar.querySelector("select");
    cases.selectedIndex = 1; cases.dispatchEvent(new Event("change"));
    found.chosen = figures.map((figure) => figure.getBoundingClientRect().height > 0);
    found.second = state();
    found.options = [...cases.options].map((option) => option.textContent);
    """
    found = browse(page, act)
    assert (found["wrong"], found["requests"], found["wide"]) == ([], [], True)
    names = ["Play", "A step of 0.02 s back", "A step of 0.02 s on", "Time [s]", "Play the worst run of a case"]
    assert (found["names"], found["role"]) == (names, "group")
    t, theta = runs[0].t, runs[0].theta / PIER.alpha
    ground = runs[0].history["ag_h"].to_numpy() / PIER.gravity
    figure = players(page.read_text(encoding="utf-8"))[0]
    turn, half, push = (float(figure.get(f"data-{name}")) for name in ("turn", "half", "push"))
    peak = float(t[np.argmax(np.abs(theta))])
    assert float(found["first"][3]) == pytest.approx(peak, abs=0.006)
    for time, (words, transform, arrow, _) in zip(
        (peak, 0.1, 0.3, 1.0, 2.5, 3.3, 6.0), (found["first"], *found["at"]), strict=True
    ):
        shown = dict(zip(("t", "theta", "g"), map(float, re.findall(r"-?\d+\.\d+", words)), strict=True))
        assert shown["t"] == pytest.approx(time, abs=0.006)
        assert shown["theta"] == pytest.approx(float(np.interp(time, t, theta)), abs=2e-3)
        assert shown["g"] == pytest.approx(float(np.interp(time, t, ground)), abs=2e-2)
        turned, pivot, _ = map(float, re.findall(r"-?\d+\.?\d*(?:e-\d+)?", transform))
        assert turned == pytest.approx(
            shown["theta"] * turn, abs=0.01 + 6e-4 * turn
        )  # of the three decimals that are shown
        assert pivot == pytest.approx(math.copysign(half, turned) if turned else 0.0)
        assert float(re.search(r"h(-?[\d.e-]+)", arrow)[1]) == pytest.approx(shown["g"] * push, abs=0.001 * push + 0.01)
    assert found["valued"] == found["at"][-1][0]
    assert float(found["stepped"]) == pytest.approx(6.02)
    ran, real, words = found["ran"]
    assert (found["playing"], words, found["stays"]) == ("Pause", "Play", True)
    assert 0.4 * real < ran < 2.2 * real  # at twice the speed; frames may be lost
    assert found["ended"] == [True, "Play"]
    assert found["chosen"] == [False, True]
    assert [words.replace("\u00a0", " ") for words in found["options"]] == ["1: β = 40, η = 2.5", "2: β = 40, η = 3.5"]
    other = runs[2]
    assert float(found["second"][3]) == pytest.approx(float(other.t[np.argmax(np.abs(other.theta))]), abs=0.006)


@needs_chromium
def test_nothing_moves_by_itself_and_with_reduced_motion_only_step_by_step(tmp_path):
    page, _ = pages(tmp_path)
    ask_for = """
    const [play, back, on] = document.querySelectorAll(".buttons button"), calm = document.querySelector(".buttons .muted");
    const shown = (node) => node.getBoundingClientRect().width > 0;
    const before = document.querySelector(".buttons input").value;
    await later();
    found.moved = document.querySelector(".buttons input").value !== before;
    found.shown = [play, back, on, calm].map(shown);
    """
    assert browse(page, ask_for)["shown"] == [True, True, True, False]
    with tab(page, (1200, 900)) as ask:
        ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
        asked = (
            "(async () => { const found = {}; const later = () => new Promise((done) => setTimeout(done, 200));"
            + ask_for
        )
        done = ask("Runtime.evaluate", expression=asked + "return found; })()", awaitPromise=True, returnByValue=True)
    assert done["result"]["value"] == {"moved": False, "shown": [False, True, True, True]}


@needs_chromium
def test_hostile_names_of_cases_and_records_are_words_in_the_player(tmp_path):
    named = [name for name in HOSTILE if len(name) < 200][:6]
    cases = [case_entry(name, {}, PIER, FOUNDATIONS[1][1]) for name in named]
    write_results(tmp_path, records=[(name, 0.3) for name in named], cases=cases)
    runs = [response(name, name, FOUNDATIONS[1][1], pier=PIER) for name in named]
    act = """
    for (const button of document.querySelectorAll(".buttons button")) button.click();
    const select = document.querySelector(".buttons select");
    for (const option of select.options) { option.selected = true; select.dispatchEvent(new Event("change")); }
    found.options = [...select.options].map((option) => option.textContent);
    found.ran = window.ran ?? null;
    found.scripts = document.scripts.length;
    """
    found = browse(write_report(tmp_path, runs), act)
    assert (found["wrong"], found["requests"], found["ran"], found["scripts"]) == ([], [], None, 1)
    assert len(found["options"]) == len(named)


def test_the_pier_is_named_once_by_the_case_and_not_again_by_its_motion(tmp_path):
    """The list of motions names the pier, since the curves of a picture are of one."""
    cases = [case_entry("pads", {"p": p}, Pier(alpha=0.13, p=p), FOUNDATIONS[1][1]) for p in (0.38, 0.76)]
    write_results(tmp_path, cases=cases, varied=("p",))
    runs = [response("ERZ-NS", "pads", FOUNDATIONS[1][1], pier=Pier(alpha=0.13, p=p), p=p) for p in (0.38, 0.76)]
    page = write_report(tmp_path, runs).read_text(encoding="utf-8")
    words = ["".join(figure[0].itertext()).replace("\u00a0", " ") for figure in players(page)]
    assert sorted(words) == ["pads: p = 0.38 rad/s under ERZ-NS", "pads: p = 0.76 rad/s under ERZ-NS"]
    assert {"ERZ-NS, p = 0.38 rad/s", "ERZ-NS, p = 0.76 rad/s"} <= set(
        re.findall(r"<strong>([^<]*)</strong>", page.replace("\u00a0", " "))
    )


@needs_chromium
def test_behind_the_end_of_a_curve_its_last_value_is_called_so(tmp_path):
    """The run of case 1 is over after 3 s of the 8 that the picture shows."""
    write_results(tmp_path, changes={("ERZ-NS", "1"): {"theta_max_over_alpha": 0.9}})
    runs = [response("ERZ-NS", *FOUNDATIONS[place], pier=PIER) for place in (1, 2)]
    runs[0] = replace(runs[0], history=runs[0].history[runs[0].history["t"] <= 3.0])
    act = """
    const slider = document.querySelector(".buttons input"), words = document.querySelector(".buttons output");
    const say = (time) => { slider.value = time; slider.dispatchEvent(new Event("input")); return words.textContent; };
    found.said = ["2.9", "6"].map(say);
    """
    before, after = browse(write_report(tmp_path, runs), act)["said"]
    assert "t = 2.90 s, θ/α" in before
    last = float(runs[0].theta[-1]) / PIER.alpha
    assert float(re.search(r"t = 6.00 s, the curve ended at θ/α = (-?[\d.]+), ground", after)[1]) == pytest.approx(
        last, abs=2e-3
    )


def still(folder, change):
    """Return the run of case 1 with the columns of ``change`` in its history, and its figure in the player."""
    write_results(folder)
    run = response("ERZ-NS", *FOUNDATIONS[1], pier=PIER)
    run = replace(run, history=run.history.assign(**change(run.history)))
    (figure,) = players(write_report(folder, [run]).read_text(encoding="utf-8"))
    return run, figure


def test_at_a_peak_to_the_left_the_pier_leans_left_and_the_arrow_is_its_own(tmp_path):
    """The ground moves by cos t, of which the arrow of 50 px is the greatest."""
    run, figure = still(tmp_path, lambda old: {"theta": -old["theta"], "ag_h": PIER.gravity * np.cos(old["t"])})
    at = int(np.argmax(np.abs(run.theta)))
    assert run.theta[at] < 0.0
    moves = next(group for group in figure.iter("g") if group.get("class") == "moves")
    turned, pivot, _ = map(float, re.findall(r"-?[\d.]+", moves.get("transform")))
    assert turned < 0.0
    assert pivot == -float(figure.get("data-half"))
    arrow = next(path for path in figure.iter("path") if path.get("class") == "push")
    push = float(re.search(r"h(-?[\d.]+)", arrow.get("d"))[1])
    assert push == pytest.approx(50.0 * math.cos(run.t[at]), abs=0.06)


def test_a_pier_that_overturns_is_drawn_where_its_curve_is_cut(tmp_path):
    """At 1.5 α, to scale, and not at the six times α that it reached."""
    _, figure = still(tmp_path, lambda old: {"theta": 50.0 * old["theta"]})
    moves = next(group for group in figure.iter("g") if group.get("class") == "moves")
    turned = float(re.search(r"-?[\d.]+", moves.get("transform"))[0])
    assert turned == pytest.approx(math.degrees(1.5 * PIER.alpha), abs=2e-3)


def test_a_run_is_played_over_the_stretch_that_its_picture_shows(tmp_path):
    """The pier does not move before 4 s of 8."""
    _, figure = still(tmp_path, lambda old: {"theta": np.where(old["t"] < 4.0, 0.0, old["theta"])})
    first, last, peak = map(float, figure.get("data-times").split())
    assert 2.0 < first < 4.0 < peak < last <= 8.0
