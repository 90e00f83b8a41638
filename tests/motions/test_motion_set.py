"""A set of motions as a list of them, and as a table; what it tells of itself."""

import re
from dataclasses import replace

import numpy as np
import pytest

import rockbatch as rb
from rockbatch.motions import LeftOut, Unusable
from rockbatch.motions.motion_set import COLUMNS, TEXTS, row


def motion(name, pga, vertical=None):
    up = None if vertical is None else np.array([0.0, vertical, 0.0])
    return rb.Motion(name, 0.02, np.array([0.0, pga, -0.5 * pga]), up, source=f"{name}.txt", azimuth=35.0)


FOUND = rb.MotionSet(
    [motion("weak", 0.981), motion("strong", 4.905, vertical=-1.962)], [Unusable("bad", ("bad.txt",), "it ends early")]
)


def test_a_set_is_gone_through_as_a_list_of_its_motions():
    assert len(FOUND) == 2
    assert [each.name for each in FOUND] == ["weak", "strong"]
    assert FOUND[1] is FOUND.motions[1]
    assert FOUND[-1] is FOUND["strong"]
    assert FOUND[:1] == FOUND.motions[:1]
    assert "weak" in FOUND
    assert FOUND[0] in FOUND
    assert "bad" not in FOUND


def test_an_unknown_name_is_an_error_with_the_known_ones():
    with pytest.raises(rb.InputError, match='"stron"; did you mean "strong"'):
        FOUND["stron"]
    with pytest.raises(rb.InputError, match="there are weak, strong"):
        FOUND["RSN821"]
    with pytest.raises(IndexError):
        FOUND[2]


def test_the_table_has_a_row_for_each_motion_with_numbers_and_words_as_such():
    table = FOUND.table()
    assert list(table) == list(COLUMNS) == list(row(FOUND[0]))
    assert table["record"].to_list() == ["weak", "strong"]
    assert table["pga_h_g"].to_list() == pytest.approx([0.1, 0.5])
    assert np.isnan(table["pga_v_g"][0])
    assert table["pga_v_g"][1] == pytest.approx(0.2)
    assert table["processed"].to_list() == ["", ""]  # nobody knows
    assert table["npts"].to_list() == [3, 3]
    assert table["azimuth_deg"].mean() == 35.0
    numbers = table.select_dtypes("number").columns
    assert set(table) - set(numbers) == set(TEXTS)


def test_an_empty_set_has_the_same_columns():
    assert rb.MotionSet().table().dtypes.to_dict() == FOUND.table().dtypes.to_dict()
    assert repr(rb.MotionSet()) == "<no ground motions>"
    assert "no ground motions" in rb.MotionSet()._repr_html_()


def test_a_set_and_a_motion_tell_of_themselves_in_a_few_lines():
    assert repr(FOUND).splitlines() == [
        "<2 ground motions>",
        "  records   weak, strong",
        "  PGA       0.100 to 0.500 g",
        "  vertical  1 of 2",
        "  not used  1 file, see .unusable",
    ]
    assert repr(FOUND[1]).splitlines() == [
        "<ground motion strong>",
        "  samples  3 at 0.02 s: 0.04 s",
        "  PGA      0.500 g, vertical 0.200 g",
        "  from     strong.txt",
    ]


def test_components_of_a_station_stand_together():
    pair = [rb.Motion(name, 0.02, np.ones(3), station="S") for name in ("a", "b")]
    assert rb.MotionSet([*pair, motion("c", 1.0)]).stations() == {"S": pair, "c": [motion("c", 1.0)]}


def test_what_could_not_be_used_is_printed_as_its_file_and_the_reason():
    assert str(FOUND.unusable[0]) == str(LeftOut("bad", ("bad.txt",), "it ends early")) == "bad.txt: it ends early"


def test_a_notebook_shows_the_first_of_many_rows_and_escapes_names():
    html = rb.MotionSet([motion(f"<{i}>", 1.0) for i in range(20)])._repr_html_()
    assert "&lt;11&gt;" in html
    assert "<12>" not in html
    assert "&lt;12&gt;" not in html
    assert "and 8 more" in html
    shown = [rb.MotionSet([motion(f"{i}", 1.0) for i in range(n)])._repr_html_() for n in (12, 13)]
    assert ["<p>and" in html for html in shown] == [False, True]
    assert [cell for cell in re.findall("<th>(.*?)</th>", html) if cell.isdecimal()] == []  # no numbers of rows


def test_what_is_stated_about_files_is_public(tmp_path):
    (tmp_path / "A090.txt").write_text("0.1\n0.2\n-0.4\n0.0\n", encoding="utf-8")
    assert len(rb.read_motions(tmp_path)) == 0
    found = rb.read_motions(tmp_path, options=rb.ReadOptions(unit="g", dt=0.01, columns=("090",)))
    assert found[0].pga == pytest.approx(0.4 * 9.81)


def test_sources_follow_a_source_that_is_replaced_unless_they_are_stated():
    motion = rb.Motion("x", 0.02, np.ones(3), source="a.AT2")
    assert replace(motion, source="b.AT2").sources == ("b.AT2",)
    assert replace(motion, component_sources=("a", "b"), source="c").sources == ("a", "b")
    assert rb.Motion("x", 0.02, np.ones(3), source="pulse").label == "x"


@pytest.mark.parametrize("refused", [Unusable, LeftOut])
def test_a_text_is_not_taken_for_several_sources(refused):
    with pytest.raises(rb.InputError, match=r"sources = 'a\.AT2'"):
        refused("n", "a.AT2", "reason")
