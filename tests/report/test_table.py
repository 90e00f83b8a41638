"""Tables: numbers below each other by their decimal point, no exponents, and once what is the same in every row."""

import math
import re
import xml.etree.ElementTree as ET

import pytest
from report_page import Page

from rockbatch.reporting.markup import Markup, number
from rockbatch.reporting.table import LEAST_COMMON, MOST_OPEN, MOST_ROWS, Head, table


@pytest.mark.parametrize(
    ("value", "form", "written"),
    [
        (9.088e-5, ".4g", "0.00009088"), (117_000.0, ".3g", "117,000"), (182_800.0, ".4g", "182,800"),
        (1550.0, ".3g", "1550"), (123_456.789, ".10g", "123,456.789"), (3e-7, ".1g", "3 × 10⁻⁷"),
        (-2.5e12, ".3g", "-2.5 × 10¹²"), (2e9, ".3g", "2,000,000,000"), (-0.0001, ".2f", "0.00"), (-0.25, ".2f", "-0.25"),
        (12_345.0, ",.0f", "12,345"), (20.0, "+.1f", "+20.0"), (math.inf, ".3g", "inf"), (math.nan, ".3g", ""),
        (9999.0, ".4g", "9999"), (10_000.0, ".5g", "10,000"), (-10_499.6, ".0f", "-10,500"), (9998.6, ".0f", "9999"),
        (28.0, "#.3g", "28.0"), (0.1, "#.3g", "0.100"), (1020.0, "#.3g", "1020"), (133.0, "#.3g", "133"),
        (None, ".3g", ""), ("words", ".3g", "words"), (7, ".3g", "7"), (0.0, ".3g", "0"),
    ],
)  # fmt: skip
def test_a_number_has_significant_digits_and_no_exponent(value, form, written):
    assert number(value, form) == written


def cells(markup, place):
    """The cells of a column with all of their spaces."""
    return [re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row)[place] for row in re.findall(r"<tr>(.*?)</tr>", markup)[1:]]


def test_decimal_points_stand_below_each_other_whatever_the_digits():
    """Behind a number stands the room of the decimals that others have: a point's, and a digit's for each."""
    shown = cells(
        table(
            [Head("name"), Head("value", ".4g")], [["a", 1.25], ["b", 20.0], ["c", 300.5], ["d", None], ["e", "none"]]
        ),
        1,
    )
    assert shown == ["1.25", "20\u2008\u2007\u2007", "300.5\u2007", "", "none"]
    drawn = table([Head("name"), Head("value", ".2f"), Head("nothing")], [["a", 1.25, None], ["b", 20.0, math.nan]])
    assert re.findall(r"<t[hd]\b([^>]*)>([^<]*)", drawn) == [
        (' scope="col"', "name"), (' class="n" scope="col"', "value"),
        *((' scope="row"', "a"), (' class="n"', "1.25")), *((' scope="row"', "b"), (' class="n"', "20.00")),
    ]  # fmt: skip


def test_a_table_names_its_rows_groups_its_heads_and_breaks_no_unit():
    heads = [Head("a < b"), Head("θ", ".1f", "meaning", "both", "mm/s"), Head("n", group="both"), Head("left")]
    drawn = ET.fromstring(table(heads, [["<x>", 1.5, 2, Markup("<b>y</b>")], ["z", None, 3, ""]], prose=True))
    assert (drawn.get("class"), drawn.get("role"), drawn.get("aria-label")) == ("wide prose", "region", "Table")
    assert ET.fromstring(table(heads, [["x", 1.5, 2, ""]], name="all")).get("class") == "wide"
    over, own, *body = drawn.iter("tr")
    assert over.get("class") == "over"
    assert [(th.text, th.get("colspan"), th.get("scope")) for th in over] == [
        (None, "1", None), ("both", "2", "colgroup"), (None, "1", None),
    ]  # fmt: skip
    assert [("".join(th.itertext()), th.get("title"), th.get("scope")) for th in own] == [
        ("a < b", None, "col"), ("θ [mm/s]", "meaning", "col"), ("n", None, "col"), ("left", None, "col"),
    ]  # fmt: skip
    assert [span.text for span in own.iter("span") if span.get("class") == "unit"] == ["[mm/s]"]
    assert [[cell.tag for cell in row] for row in body] == [["th", "td", "td", "td"]] * 2
    assert [["".join(cell.itertext()).strip("\u2008\u2007") for cell in row] for row in body] == [
        ["<x>", "1.5", "2", "y"], ["z", "", "3", ""],
    ]  # fmt: skip
    assert [cell.get("class") for cell in body[0]] == [None, "n", "n", None]


def test_what_is_the_same_in_every_row_of_a_long_table_stands_above_it_once():
    heads = [Head("name"), Head("status"), Head("scale", ".2f"), Head("peak", ".1f")]
    rows = [[f"r{i}", "ok", 1.5, float(i)] for i in range(LEAST_COMMON + 1)]
    shown = Page(f'<section id="x">{table(heads, rows, sortable=True)}</section>')
    assert "In every row: status ok; scale 1.50." in shown.text
    assert shown.tables["x"][0] == ["name", "peak"]
    with_unit = table(
        [heads[0], Head("drift at", ".4g", unit="m"), *heads[2:]],
        [[row[0], 30.0, *row[2:]] for row in rows],
        sortable=True,
    )
    assert "In every row: drift at 30\u00a0m; scale 1.50." in with_unit
    at_rest = table([heads[0], Head("period [s] of rest"), *heads[2:]], rows, sortable=True)
    assert "In every row: period [s] of rest ok; scale 1.50." in at_rest
    for unlike in (table(heads, rows), table(heads, rows[:LEAST_COMMON], sortable=True)):
        assert "In every row" not in unlike
    one = [*rows[:-1], ["r", "failed", 1.5, 0.0]]
    assert Page(f'<section id="x">{table(heads, one, sortable=True)}</section>').tables["x"][0] == [
        "name",
        "status",
        "peak",
    ]


def test_a_table_of_some_rows_says_of_how_many_and_what_they_share():
    heads = [Head("name"), Head("status")]
    rows = [[f"r{i}", "ok"] for i in range(MOST_ROWS + 1)]
    assert f"The first {MOST_ROWS:,} of {MOST_ROWS + 1:,} rows are shown." in table(heads, rows)
    few = rows[: LEAST_COMMON + 1]
    worst = table(heads, few, sortable=True, worst_of=90)
    assert f"The worst {len(few)} of 90 rows are shown." in worst
    assert "In each of these rows: status ok." in worst
    whole = table(heads, few, sortable=True, worst_of=len(few))
    assert "In every row: status ok." in whole
    assert "are shown" not in whole


def test_columns_by_which_rows_are_chosen_are_marked_and_long_tables_are_folded():
    rows = [[f"r{i}", i % 2] for i in range(MOST_OPEN + 1)]
    shown = table([Head("name"), Head("case", filter=True)], rows, name="Every run")
    assert 'data-filter="">case</th>' in shown
    assert f"<summary>Every run: {MOST_OPEN + 1} rows</summary>" in shown
    assert "<details>" not in table([Head("name"), Head("case")], rows[:-1])


def test_only_a_table_that_is_to_be_sorted_is_marked_so():
    rows = [["a", 1.0], ["b", 2.0]]
    plain, sorted_by_reader = (table([Head("name"), Head("value")], rows, sortable=way) for way in (False, True))
    assert 'class="sortable"' in sorted_by_reader
    assert "sortable" not in plain
