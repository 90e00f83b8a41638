"""What the pages tell a reader to write is taken by the program as it is now."""

import doctest
import functools
import re
import shutil
import tomllib
from pathlib import Path
from textwrap import dedent

import motion_files  # noqa: F401  loads ObsPy, which warns
import numpy as np
import pandas as pd
import pytest
from jsonschema import Draft7Validator
from studies import study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import COMMANDS, main
from rockbatch.results.labelled import labelled
from rockbatch.study.load import load_study
from rockbatch.study.schema import MANIFEST, STUDY, schema_of

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
PAGES = sorted([*(ROOT / "docs" / "pages").rglob("*.md"), ROOT / "docs" / "commands.md"])
SCHEMAS = [Draft7Validator(schema_of(sections, "")) for sections in (STUDY, MANIFEST)]
SHELL = re.compile(r"^(?:\.venv/bin/)?(\w+) ?(\S*)(.*?)(?:#.*)?$")


def blocks(page, language):
    """The texts between ```language and ``` on a page."""
    return re.findall(rf"^```{language}\n(.*?)^```$", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)


TOML = [(page.stem, text) for page in PAGES for text in blocks(page, "toml")]
LINES = [(page.stem, line) for page in PAGES for text in blocks(page, "sh") for line in text.splitlines() if line]


@pytest.mark.parametrize(("page", "text"), TOML, ids=[page for page, _ in TOML])
def test_every_piece_of_a_study_has_keys_and_values_that_are_read(page, text):
    data = tomllib.loads(text)
    schema = SCHEMAS["record" in data]
    wrong = [error.message for error in schema.iter_errors(data) if error.validator != "required"]
    assert wrong == []


@pytest.mark.parametrize(("page", "line"), LINES, ids=[f"{page}: {line}" for page, line in LINES])
def test_every_command_is_there(page, line, capsys):
    program, word, rest = SHELL.match(line).groups() if not line.startswith((". ", "cd ")) else ("", "", "")
    if program == "rockbatch":
        assert word in COMMANDS
        with pytest.raises(SystemExit):
            main([word, "--help"])
        printed = capsys.readouterr().out
        assert [flag for flag in re.findall(r"--[\w-]+", rest) if flag not in printed] == []
    elif program == "make":
        assert re.search(rf"^{word}:", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
    elif program == "chromium":  # as tests/report/test_browser.py prints
        assert "--print-to-pdf" in line
    elif program == "python":
        assert (ROOT / word).is_file()
    else:
        assert program == ""


@pytest.mark.slow
def test_the_tutorial_comes_to_a_verdict(tmp_path, monkeypatch, capsys):
    study = next(text for text in blocks(ROOT / "docs" / "pages" / "tutorial.md", "toml") if text.startswith("title"))
    shutil.copytree(ROOT / "motions" / "near_fault" / "imperialvalley1979_meloland", tmp_path / "records")
    undamped = re.sub(r"^zeta .*\n", "", study, flags=re.MULTILINE)  # damped supports have a kernel of their own
    (tmp_path / "pier.toml").write_text(undamped, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert main(["motions", "--all", "records"]) == 0
    code = main(["run", "pier.toml"])
    assert (tmp_path / "reports" / "pier" / "report.html").is_file()
    capsys.readouterr()
    assert main(["check", "reports/pier"]) == code
    told = capsys.readouterr().out
    assert code == ("✗" in told)
    assert "uplift of the" in told
    assert main(["check", "reports/pier", "--all"]) == code
    assert "no overturning: no record overturns the pier" in " ".join(capsys.readouterr().out.split())


@pytest.mark.usefixtures("pages")
def test_the_pier_on_both_axes_comes_to_what_a_hand_makes_of_its_peaks(tmp_path, monkeypatch, capsys):
    page = ROOT / "docs" / "pages" / "questions" / "axes.md"
    (tmp_path / "records").symlink_to(ROOT / "motions" / "near_fault")
    (tmp_path / "pier.toml").write_text(blocks(page, "toml")[0], encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert main(["run", "pier.toml"]) == 0
    told = capsys.readouterr().out
    assert blocks(page, "text")[0].strip() in told
    assert "SRSS of both axes (rotation); 100 % +" in told
    peaks, checks = (pd.read_csv(tmp_path / "reports" / "pier" / f"{name}.csv") for name in ("peaks", "checks"))
    along, across = (peaks[peaks["case"] == name].set_index("record") for name in ("rock", "rock across"))
    x, y = along["theta_max_over_alpha"], across["theta_max_over_alpha"]
    u, v = along["top_drift_m"], across["top_drift_m"]
    by_hand = [np.sqrt(x**2 + y**2).mean(), max((u + 0.3 * v).max(), (0.3 * u + v).max()), 0.0]
    np.testing.assert_allclose(checks["value"], by_hand, rtol=1e-9)
    report = (tmp_path / "reports" / "pier" / "report.html").read_text(encoding="utf-8")
    words = " ".join(re.sub("<[^>]+>", " ", report).split())
    assert "Each axis is a planar model of its own, without rolling or twisting" in words
    assert "One pier on one foundation under 5 ground motions" in words
    assert "5 stations, 10 components" in words
    results = rb.open_results(tmp_path / "reports" / "pier")
    shown = labelled(results.peaks, results.info, results.directory).runs
    np.testing.assert_allclose(
        shown["pga"], results.peaks["pga_g"], rtol=1e-3
    )  # 9.81 of the pier, and as run.json rounds
    assert results.plot(axes="self-similar") is not None


def test_the_page_of_commands_shows_every_command():
    shown = re.findall(r"^rockbatch (\w+)", (ROOT / "docs" / "commands.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert set(shown) == set(COMMANDS)


def test_the_study_of_the_readme_is_accepted_as_it_stands(tmp_path):
    """A pier on a rigid base and on two pads with a damper."""
    text = re.search(r"^    title = .*?(?=^\S)", README.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    assert text is not None
    (tmp_path / "records").mkdir()
    (tmp_path / "pier4.toml").write_text(dedent(text.group()), encoding="utf-8")
    study = load_study(tmp_path / "pier4.toml")
    assert [len(case.base.restraints) for case in study.cases] == [0, 1, 1]


def test_the_readme_stays_one_page_and_its_links_lead_somewhere():
    text = README.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 180
    assert [link for link in re.findall(r"\]\(([\w./-]+)", text) if not (ROOT / link).exists()] == []


def test_the_search_of_the_site_finds_frequent_questions_by_their_words():
    page = (ROOT / "docs" / "pages" / "faq.md").read_text(encoding="utf-8")
    headings = " ".join(re.findall(r"^### (.+)$", page, re.MULTILINE)).lower()
    for word in ("jupyter", "parallel", "cluster", "units", "excel", "not decided", "failed", "cite", "cores"):
        assert word in headings


@pytest.mark.slow
def test_the_examples_on_the_page_about_records_come_to_what_they_say(tmp_path, monkeypatch):
    (tmp_path / "motions").symlink_to(ROOT / "motions")
    monkeypatch.chdir(tmp_path)
    text = "\n".join(blocks(ROOT / "docs" / "pages" / "records.md", "python"))
    test = doctest.DocTestParser().get_doctest(text, {}, "records.md", None, 0)
    wrong = []
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE, verbose=False)
    runner.run(test, out=wrong.append)
    assert not wrong, "".join(wrong)
    assert len(test.examples) > 20


@pytest.mark.slow
def test_the_page_of_bounds_quotes_what_is_printed(tmp_path, capsys):
    (page,) = (text for text in blocks(ROOT / "docs" / "pages" / "questions" / "bounds.md", "text"))
    main(["run", str(ROOT / "configs" / "pier_with_bounds.toml"), "--out", str(tmp_path / "out")])
    assert page in capsys.readouterr().out


@pytest.mark.thorough
def test_the_page_of_capacities_quotes_what_is_printed(tmp_path, capsys):
    (page,) = blocks(ROOT / "docs" / "pages" / "questions" / "capacity.md", "text")
    main(["run", str(ROOT / "configs" / "capacities.toml"), "--out", str(tmp_path / "out")])
    assert page in capsys.readouterr().out


@pytest.mark.thorough
def test_the_page_of_the_value_that_just_passes_quotes_what_is_printed(tmp_path, capsys):
    (page,) = blocks(ROOT / "docs" / "pages" / "questions" / "design.md", "text")
    main(["design", str(ROOT / "configs" / "damper_that_passes.toml"), "--out", str(tmp_path / "out")])
    assert page in capsys.readouterr().out


@pytest.mark.slow
def test_the_page_of_two_designs_quotes_what_is_printed(tmp_path, capsys):
    study = rb.load_study(ROOT / "configs" / "pier_with_bounds.toml")
    for side, case in (("with", "dampers"), ("without", "no dampers")):
        ground = study.with_(case=case, bound=["soft ground", "stiff ground"])
        rb.run(ground, tmp_path / side, progress=False)
    (page,) = blocks(ROOT / "docs" / "pages" / "questions" / "comparison.md", "text")
    capsys.readouterr()
    assert main(["report", str(tmp_path / "with"), str(tmp_path / "without")]) == 0
    assert capsys.readouterr().out == page


@pytest.mark.slow
def test_the_lines_about_a_cluster_give_the_table_of_threads(tmp_path, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.chdir(tmp_path)
    write_study(tmp_path, study_text(), "pier.toml")
    (lines,) = (text for text in blocks(ROOT / "docs" / "pages" / "faq.md", "python") if "rb.Dask" in text)
    names = {"__name__": "__main__"}
    exec(lines.replace('"tcp://10.0.0.1:8786"', "workers=1"), names)
    rb.run("pier.toml", "threads")
    assert (tmp_path / "reports" / "pier" / "peaks.csv").read_bytes() == (
        tmp_path / "threads" / "peaks.csv"
    ).read_bytes()
    with pytest.raises(rb.OutOfRange, match="workers = 0: must be 1 or above"):
        rb.Dask(workers=0)


def test_the_names_that_stand_for_those_of_other_programs_are_there(tmp_path):
    table = (
        (ROOT / "docs" / "pages" / "glossary.md").read_text(encoding="utf-8").partition("## Names of other programs")[2]
    )
    ours = " ".join(row.split(" | ")[1] for row in table.splitlines() if row.startswith("| "))
    roots = {"rb": rb, "motion": rb.pulse("sine", name="sine", amplitude=2.0, period=1.0, dt=0.01, duration=2.0)}
    named = re.findall(r"\b(rb|motion)((?:\.[A-Za-z]\w*)+)", ours)
    assert len(named) >= 8
    for root, names in named:
        functools.reduce(getattr, names[1:].split("."), roots[root])
    keys = {key for section in STUDY for key in section} | {"motions", "damper"}
    assert {word for word in re.findall(r"`([a-z]+_[A-Za-z_]+)`", ours) if not word.startswith("rotd")} <= keys


RECIPES = (ROOT / "docs" / "pages" / "extending.md").read_text(encoding="utf-8")


def test_recipes_name_files_functions_and_numbers_of_hooks_that_there_are():
    files = set(re.findall(r"`((?:rockbatch|tests|benchmarks|docs)/[\w./]+)`", RECIPES))
    assert len(files) > 60
    assert not [file for file in files if "NAME" not in file and not (ROOT / file).exists()]
    names = set(re.findall(r"`(_?[a-z]+(?:_[a-z0-9]+)+)(?:\([^`]*\))?`|`(_[a-z]+)`", RECIPES))
    sources = [
        path.read_text(encoding="utf-8") for top in ("rockbatch", "tests") for path in (ROOT / top).rglob("*.py")
    ]
    used = set(re.findall(r"\w+", " ".join(sources)))
    assert len(names) > 30
    assert not [name for pair in names if (name := "".join(pair)) not in used]
    hooks = (ROOT / "rockbatch" / "core" / "system.py").read_text(encoding="utf-8")
    counts = [len(re.findall(rf"^@{kind}$", hooks, re.MULTILINE)) for kind in ("hook", "optional_hook")]
    assert re.search(r"the (\d+) hooks of .*, and of (\d+) optional", RECIPES).groups() == tuple(map(str, counts))
