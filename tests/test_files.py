"""Texts from elsewhere do no harm: not in a spreadsheet, not in a terminal, not in a file."""

import csv
import io
import math
import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rockbatch.common.files import csv_lines, csv_plain, csv_safe, csv_text, legible, read_table
from rockbatch.toml import kinds

FORMULAS = ["=1+1", "+1", "-2+3", "@SUM(A1)", "\t=1", "\r=1", '=HYPERLINK("http://x")', "＝1+1", "＋1", "－2", "＠A1"]


@pytest.mark.parametrize("text", FORMULAS)
def test_a_cell_that_a_spreadsheet_would_calculate_gets_an_apostrophe(text):
    assert csv_safe(text) == f"'{text}"


def test_so_does_what_half_of_the_world_takes_for_a_cell_of_its_own():
    """Where a comma is in decimals, a semicolon separates cells."""
    assert csv_safe("a;=1+1;b;-2+3") == "a;'=1+1;b;'-2+3"
    assert csv_safe("a; b;c") == "a; b;c"


@pytest.mark.parametrize("text", ["RSN1063_RRS228", "a=b", "", "+", "-", "'quoted'", "Δ-1"])
def test_other_texts_and_a_polarity_stay_as_they_are(text):
    assert csv_safe(text) == text


@given(st.text(alphabet="'=+-@＝＋－＠\t\nab;", max_size=6))
def test_a_safe_cell_gives_its_text_back_and_is_no_formula(text):
    cell = csv_safe(text)
    assert csv_plain(cell) == text
    for part in cell.split(";"):
        assert len(part) < 2 or part[0] not in "=+-@＝＋－＠\t\r\n"


def test_numbers_in_a_csv_stay_numbers_and_texts_cannot_break_it():
    rows = [{"a": -1.5, "b": '=1,"x"\ny'}, {"a": math.nan, "b": None}, {"b": -3}]
    written = csv_text(("a", "b"), rows)
    assert list(csv.reader(io.StringIO(written))) == [["a", "b"], ["-1.5", '\'=1,"x"\ny'], ["", ""], ["", "-3"]]


def test_what_a_terminal_would_obey_is_written_out_in_a_table():
    assert csv_text(("a",), [{"a": "x\x1b[2J\x9b"}]) == "a\nx\\x1b[2J\\x9b\n"


def test_what_a_terminal_would_obey_is_shown_instead():
    name = b"a\x1b[31m\xff\n.AT2".decode("utf-8", "surrogateescape")
    assert legible(name) == "a\\x1b[31m\\xff\\x0a.AT2"
    assert legible("\u202eTA.1") == "\\u202eTA.1"
    assert legible("Zürich 東京 – π") == "Zürich 東京 – π"


@pytest.mark.parametrize("hidden", "\u200b\u200d\u200e\u2060\ufeff\xad\u061c\u3164\ufe0f\ufff9\U000e0041\U000e0100")
def test_no_character_that_is_not_seen_makes_two_names_look_alike(hidden):
    written = hidden.encode("ascii", "backslashreplace").decode()
    assert legible(f"TA{hidden}Z") == f"TA{written}Z"
    assert legible(f"TA{hidden}Z", keep="\t\r\n") == csv_text(("a",), [{"a": f"TA{hidden}Z"}]).split()[1]


@pytest.mark.parametrize(
    "name",
    ["نرم\u200cافزار", "می\u200cشود", "क्\u200dष", "ക്\u200cഷ", "❤\ufe0f", "👩\u200d🔬", "🏗\ufe0f", "❤\ufe0f\u200d🔥"],
)
def test_joiners_and_selectors_stay_where_they_are_seen(name):
    assert legible(name) == name
    assert kinds.text(name) == name
    assert csv_text(("a",), [{"a": name}]).split("\n")[1] == name


@pytest.mark.parametrize(
    "name", ["a\u200cb", "م\u200c", "\u200cم", "د\u200cا", "م\u200c\u200cم", "م\u200c9", "👩\u200d",
    "👩\u200da", "1\ufe0f", "❤\ufe0f\ufe0f", "क\u200dष", "नी\u200c"]
)  # fmt: skip
def test_joiners_that_change_nothing_are_written_out(name):
    assert "\\u" in legible(name)
    with pytest.raises(kinds.KindError, match="invisible"):
        kinds.text(name)


def test_all_format_characters_are_written_out_but_those_that_are_seen():
    """Signs that enclose Arabic, Syriac and Kaithi numbers, and joiners of hieroglyphs and shorthand, are drawn."""
    formats = {chr(code) for code in range(0x110000) if unicodedata.category(chr(code)) == "Cf"}
    raw = {char for char in formats if legible(char) == char}
    assert all(
        any(word in unicodedata.name(char) for word in ("ARABIC", "SYRIAC", "KAITHI", "EGYPTIAN")) for char in raw
    )
    assert not raw & set("\u061c\u200b")


def test_columns_make_the_lines_that_a_csv_writer_makes_of_their_cells():
    texts = ["", "a", 'b "c"', "d,e", "f\ng", " h ", "7", "µ⟂"]
    columns = [
        texts,
        [0.1 + 0.2, math.nan, -0.0, 1e300, math.inf, 5e-324, 1.0, 2.0],
        [1, True, None, 2, 3, 4, 5, 6],
        [None] * 8,
    ]
    cells = [
        texts,
        ["0.3", "", "-0", "1e+300", "inf", "4.940656458e-324", "1", "2"],
        [1, True, "", 2, 3, 4, 5, 6],
        [""] * 8,
    ]
    lines = []
    for row in zip(*cells, strict=True):
        buffer = io.StringIO()
        csv.writer(buffer, lineterminator="\n").writerow(row)
        lines.append(buffer.getvalue())
    assert [f"{line}\n" for line in csv_lines(columns)] == lines


def test_a_name_that_a_reader_of_tables_takes_for_no_value_stays_a_name(tmp_path):
    names = ["NA", "nan", "None", "NULL", "", "12", "1e5", "=1+1"]
    (tmp_path / "a.csv").write_text(csv_text(("record", "x"), [{"record": name, "x": 1.5} for name in names]), "utf-8")
    table = read_table(tmp_path / "a.csv")
    assert table["record"].to_list() == names
    assert table["x"].to_list() == [1.5] * len(names)
