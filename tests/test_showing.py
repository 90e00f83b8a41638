"""Values and names as messages and tables show them."""

import re
import tomllib
import unicodedata
from itertools import pairwise, product

import pytest

from rockbatch.common.grouping import closest, distinct, spread
from rockbatch.common.naming import alike, chosen, chosen_by, fits
from rockbatch.common.showing import shown

VALUES = [True, False, 0, -7, 2**63, 0.5, 1e-9, "", "a b", 'say "a"', "C:\\a\\b", "a\tb", "η", [1, 2.5, "c"], [], [[1], []],
          {"a": 1, "b": [True]}, {}]  # fmt: skip


@pytest.mark.parametrize("value", VALUES)
def test_a_shown_value_is_the_one_that_toml_reads(value):
    assert tomllib.loads(f"value = {shown(value)}")["value"] == value
    assert "\\u" not in shown(value)  # letters of any alphabet are shown, not their codes


@pytest.mark.parametrize("limit", [20, 60])
@pytest.mark.parametrize("over", range(-2, 3))
def test_a_value_is_cut_only_where_it_is_longer_than_the_limit(limit, over):
    letters = "abcdefghij" * 10
    whole = f'"{letters[: limit + over - 2]}"'
    assert shown(whole[1:-1], limit) == (whole if over <= 0 else f"{whole[: limit - 1]}…")


@pytest.mark.parametrize(
    "value",
    ["a" * 10**6, list(range(10**5)), dict.fromkeys(range(10**5)), 10**5000],
    ids=["text", "list", "table", "number"],
)
def test_a_value_of_any_size_is_shown_in_sixty_characters(value):
    assert len(shown(value)) == 60


def test_distinct_names_differ_and_the_first_of_each_stays():
    for names in product(("a", "b", "a (2)", "a (3)"), repeat=4):
        named = distinct(names)
        assert len(set(named)) == len(named)
        for i, name in enumerate(names):
            first = names.index(name) == i
            assert named[i] == name if first else re.fullmatch(rf"{re.escape(name)} \(\d+\)", named[i])


def test_repeated_names_are_made_longer_before_they_are_numbered():
    longer = (lambda i, name: f"{name}{i // 2}", lambda i, name: f"{name}.{i}")
    assert distinct(["a", "b", "a", "a", "c0"], *longer) == ["a0", "b", "a1.2", "a1.3", "c0"]
    assert distinct(["a", "a"], lambda _, name: name) == ["a", "a (2)"]


@pytest.mark.parametrize("most", range(1, 8))
@pytest.mark.parametrize("number", range(9))
def test_items_are_spread_evenly_from_the_first_to_the_last(number, most):
    chosen = spread(range(number), most)
    assert len(chosen) == min(number, most)
    assert chosen[:1] == list(range(number))[:1]
    if most > 1:
        assert chosen[-1:] == list(range(number))[-1:]
        gaps = [second - first for first, second in pairwise(chosen)]
        assert max(gaps, default=0) - min(gaps, default=0) <= 1


def test_the_closest_name_is_found_whatever_its_case_and_none_where_none_is_alike():
    known = ["Alpha", "beta", "gamma"]
    assert [closest(word, known) for word in ("ALPHA", "bet", "gama", "xyz", "")] == [
        "Alpha",
        "beta",
        "gamma",
        None,
        None,
    ]


@pytest.mark.parametrize(
    ("pattern", "names"),
    [
        ("soft 1", ["soft 1"]),
        ("soft [1]", ["soft [1]"]),
        ("soft [12]", ["soft 1", "soft 2"]),
        ("soft ?", ["soft 1", "soft 2"]),
        ("soft*", ["soft 1", "soft [1]", "soft 2"]),
        ("SOFT 1", []),
        ("[0]", []),
    ],
)
def test_a_pattern_chooses_the_name_that_it_is_or_else_those_that_it_matches(pattern, names):
    known = ["soft 1", "soft [1]", "soft 2"]
    assert chosen(pattern, known) == names
    assert chosen_by((pattern, "none"), frozenset(known)) == set(names)
    assert fits(pattern, pattern)


@pytest.mark.parametrize(
    ("letter", "latin"),
    [
        ("CYRILLIC SMALL LETTER ER", "p"),
        ("CYRILLIC CAPITAL LETTER EN", "H"),
        ("GREEK CAPITAL LETTER RHO", "P"),
        ("GREEK SMALL LETTER NU", "v"),
    ],
)
def test_a_name_is_alike_to_others_of_its_look_and_not_to_itself(letter, latin):
    known = ["other", latin, f"{latin} 2"]
    assert alike(unicodedata.lookup(letter), known) == latin
    assert alike(latin, known) == ""
    assert alike(f"{latin}\u00a0 2", known) == f"{latin} 2"
