"""The screenshots of the report: committed, small, each on the page; and the script that takes them, where there is Chromium."""

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from report_samples import write_results

from rockbatch.reporting import write_report

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture
def script():
    spec = importlib.util.spec_from_file_location("take", DOCS / "screenshots" / "take.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_screenshot_is_committed_small_and_on_the_page(script):
    page = (DOCS / "pages" / "gallery.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"\(images/([\w-]+)\.png\)", page)) == sorted(script.SHOTS)
    for name, shot in script.SHOTS.items():
        path = DOCS / "images" / f"{name}.png"
        assert path.stat().st_size < 200_000
        with Image.open(path) as picture:
            assert abs(picture.width - shot.width) <= 1
            assert abs(picture.height - shot.height) <= 100  # letter or A4, as the printer's default is
            paper = picture.convert("L").getpixel((3, 3))
        assert paper < 40 if shot.dark else paper > 240


def test_the_palette_of_a_screenshot_keeps_the_pale_colours_of_verdicts(script):
    """They were grey; words, whose edges have many colours, take most of a palette."""
    draw = np.random.default_rng(7)
    pixels = draw.integers(0, 256, (400, 300, 1)) + draw.integers(-12, 13, (400, 300, 3))
    pale = {name: np.array(colour) for name, colour in (("pass", (237, 243, 239)), ("fail", (247, 230, 229)))}
    for place, colour in enumerate(pale.values()):
        pixels[:, 100 * place : 100 * place + 60] = colour
    picture = Image.fromarray(np.clip(pixels, 0, 255).astype(np.uint8))
    kept = np.asarray(script.smaller(picture).convert("RGB")).astype(int)
    for place, colour in enumerate(pale.values()):
        assert np.abs(kept[:, 100 * place : 100 * place + 60] - colour).max() <= 2


def test_without_chromium_the_script_says_so_and_changes_nothing(script, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(script.shutil, "which", lambda name: None)
    script.main(tmp_path)
    assert capsys.readouterr().err == "no Chromium: the screenshots stay as they are\n"
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_the_script_takes_a_report_dark_and_printed(script, tmp_path):
    chromium = script.browser()
    if chromium is None:
        pytest.skip("needs Chromium")
    write_results(tmp_path)
    page = write_report(tmp_path, [])
    for shot in (script.SHOTS["report-dark"], script.SHOTS["report-printed"]):
        if shot.printed and importlib.util.find_spec("pypdfium2") is None:
            assert script.take(shot, page, chromium) is None
            continue
        picture = script.take(shot, page, chromium).convert("L")
        assert picture.width == pytest.approx(shot.width, abs=1)
        assert len(picture.getcolors(1 << 24)) > 10
        assert (picture.getpixel((3, 3)) < 40) is shot.dark


@pytest.mark.thorough
@pytest.mark.slow
def test_all_screenshots_are_made_anew(script, tmp_path):
    if script.browser() is None:
        pytest.skip("needs Chromium")
    script.main(tmp_path)
    made = {}
    for path in tmp_path.iterdir():
        with Image.open(path) as picture:
            made[path.stem] = picture.width
    assert set(script.SHOTS) - {"report-printed"} <= set(made)
    assert made == pytest.approx({name: script.SHOTS[name].width for name in made}, abs=1)
