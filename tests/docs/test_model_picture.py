"""The picture of the model has every key of [pier] and [[case]], or the reason why it is left out, and is legible."""

import importlib.util
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from rockbatch.study.schema import STUDY

TOP = Path(__file__).parents[2]
LETTER, HIGH = 7.9, 13.0
"""Width and height of a letter of a key [px]."""


@pytest.fixture(scope="module")
def model():
    spec = importlib.util.spec_from_file_location("model", TOP / "docs" / "model.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def named(picture):
    """Return the keys on a picture with their tables and elements."""
    texts = ElementTree.fromstring(picture).iter("{http://www.w3.org/2000/svg}text")
    return [(text.get("data-table"), text.text, text) for text in texts if text.get("data-table")]


def test_every_key_of_the_pier_and_of_the_cases_is_drawn_or_left_out_with_a_reason(model):
    tables = {
        ".".join(section.at): set(section.keys_read) for section in STUDY if section.at[:1] in (("pier",), ("case",))
    }
    drawn = {}
    for table, key, _ in named(model.drawn()):
        drawn.setdefault(table, set()).add(key)
    assert drawn.pop("output") == {"sections_m"}
    assert set(model.LEFT_OUT) == set(tables)
    for table, keys in tables.items():
        left_out = model.LEFT_OUT[table]
        assert drawn.get(table, set()) | set(left_out) == keys
        assert not drawn.get(table, set()) & set(left_out)
        assert all(len(reason.split()) > 3 for reason in left_out.values())
    lengths = {"width_m", "height_m", "deck_height_m", "top_m", "size_m", "alpha", "initial_rotation_rad"}
    assert lengths <= drawn["pier"]


def test_the_picture_in_the_documentation_is_the_one_that_is_drawn(model):
    assert model.PICTURE.read_text(encoding="utf-8") == model.drawn()


def test_keys_stand_apart_and_inside_the_picture(model):
    left, top, width, height = model.BOX
    boxes = []
    for table, key, text in named(model.drawn()):
        x, y, wide = float(text.get("x")), float(text.get("y")), LETTER * len(key)
        anchor = {"e": -wide, "m": -0.5 * wide}
        start = next((anchor[name] for name in text.get("class").split() if name in anchor), 0.0)
        box = (x + start, y - 0.8 * HIGH, x + start + wide, y + 0.2 * HIGH)
        if text.get("transform"):  # by a quarter turn
            box = (x - 0.8 * HIGH, y + start, x + 0.2 * HIGH, y + start + wide)
        assert left <= box[0] < box[2] <= left + width, key
        assert top <= box[1] < box[3] <= top + height, key
        boxes.append((f"{table}.{key}", box))
    for place, (one, a) in enumerate(boxes):
        for other, b in boxes[:place]:
            assert a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1], (one, other)


def luminance(colour):
    parts = [int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_words_and_lines_are_legible_on_light_and_on_dark_paper(model):
    themes = [dict(re.findall(r"--(\w+):(#\w+)", rule)) for rule in re.findall(r"svg\{([^}]*)\}", model.STYLE)]
    assert len(themes) == 2
    for colours in themes:
        assert set(colours) == {"paper", "ink", "muted", "band", "blue", "orange", "green"}
        for name in set(colours) - {"paper", "band"}:
            for ground in ("paper", "band"):
                light, dark = sorted((luminance(colours[name]), luminance(colours[ground])), reverse=True)
                assert (light + 0.05) / (dark + 0.05) >= (4.5 if ground == "paper" else 4.0), (name, ground)
    light, dark = (luminance(colours["paper"]) for colours in themes)
    assert light > 0.9
    assert dark < 0.02


def test_the_first_pages_show_the_picture():
    start = (TOP / "docs" / "pages" / "start.md").read_text(encoding="utf-8")
    assert "](images/model.svg)" in start
    assert "](docs/images/model.svg)" in (TOP / "README.md").read_text(encoding="utf-8")
