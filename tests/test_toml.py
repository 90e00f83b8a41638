"""The line of every key, and what is said about files that are not TOML."""

import math
import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rockbatch.common.errors import InputError
from rockbatch.toml.csv_columns import MOST_ROWS, columns_of
from rockbatch.toml.kinds import Choice, KindError, Number, boolean
from rockbatch.toml.lines import key_lines
from rockbatch.toml.meant import known_as, names
from rockbatch.toml.reader import TomlFile
from rockbatch.toml.slips import meant_line

AWKWARD = '''\
# [pier] in a comment = 1
title = "a # no comment, [no.table]"
notes = """
[case]
beta = 4    \\"""
"""
raw = \'\'\'
eta = 2 \'\' \'\'\'
quoted = """two quotes at the end"""""

[pier]   # header
alpha = [
    0.1,   # ] not the end
    0.2, [ "x]", "y" ],
]
"p" = 0.38
'mu.x'.y = { a = 1, "b]" = [1, 2] }

[[case]]
name = "1"
[case.sub]
deep.er = 1
[[case]]
beta = 40
[[case.part]]
n = 1
[[case.part]]
n = 2
'''


def _line_of(fragment: str) -> int:
    return next(n for n, line in enumerate(AWKWARD.splitlines(), 1) if line.startswith(fragment))


def _places(value: object, at: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Every place in parsed TOML, tables and list elements included."""
    if isinstance(value, dict):
        inner = [(key, item) for key, item in value.items()]
    elif isinstance(value, list):
        inner = list(enumerate(value))
    else:
        inner = []
    here = [at] if at else []
    return here + [place for key, item in inner for place in _places(item, (*at, key))]


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_strings_comments_and_brackets_do_not_confuse_the_lines(newline):
    text = AWKWARD.replace("\n", newline)
    lines = key_lines(text)
    assert set(lines) == set(_places(tomllib.loads(text)))
    assert lines["notes",] == 3
    assert lines["raw",] == 7
    assert lines["pier",] == _line_of("[pier]")
    assert lines["pier", "alpha", 1] == _line_of("    0.2")
    assert lines["pier", "alpha", 2, 1] == _line_of("    0.2")
    assert lines["pier", "p"] == _line_of('"p"')
    assert lines["pier", "mu.x", "y", "b]", 1] == _line_of("'mu.x'")
    assert lines["case", 0, "sub", "deep", "er"] == _line_of("deep.er")
    assert lines["case", 1, "beta"] == _line_of("beta = 40")
    assert lines["case", 1, "part", 1, "n"] == _line_of("n = 2")


_KEYS = st.text("abc #[]=.'\"\\\n é", min_size=1, max_size=6)
_LEAVES = st.one_of(
    st.integers(),
    st.booleans(),
    st.floats(allow_nan=False),
    st.text("ab#[]{}=,'\"\\\n é", max_size=8),
)
_VALUES = st.recursive(_LEAVES, lambda inner: st.lists(inner, max_size=3), max_leaves=6)


def _basic(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


def _written(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        literal = "'" not in value and "\n" not in value
        multi = '"""\n' + _basic(value)[1:-1].replace("\\n", "\n") + '"""'
        return f"'{value}'" if literal and len(value) % 2 else multi if len(value) % 3 == 0 else _basic(value)
    if isinstance(value, list):
        return "[ # ]\n" + ",\n".join(map(_written, value)) + "\n]"
    return repr(value)


@given(st.lists(st.dictionaries(_KEYS, _VALUES, max_size=4), max_size=4))
def test_every_key_of_any_file_has_the_line_it_is_written_on(tables):
    chunks, expected, line = [], {}, 1
    for n, table in enumerate(tables):
        chunks.append("[[t]]")
        expected["t", n] = line
        line += 1
        for key, value in table.items():
            chunk = f"{_basic(key)} = {_written(value)}  # {key!r}"
            chunks.append(chunk)
            expected["t", n, key] = line
            line += chunk.count("\n") + 1
    text = "\n".join(chunks)
    lines = key_lines(text)
    assert set(lines) == set(_places(tomllib.loads(text)))
    assert {at: lines[at] for at in expected} == expected


RULES = "texts belong in quotes, decimals take a point, and numbers no unit; [[…]] above each of several tables"
NOT_TOML = [  # a text, the line that is wrong, and why
    ("a = 1\nbase = rigid\n", 2, "invalid value"), ('notes = """a"""\nbase = rigid\n', 2, "invalid value"),
    ("alpha = 0,13\n", 1, "expected newline or end of document after a statement"), ("alpha: 0.13\n", 1, "expected '=' after"),
    ("mass_t = 1.8e6 kg\n", 1, "expected newline or end of document"), ("alpha =\n", 1, "invalid value"),
    ("[pier\nalpha = 1\n", 1, "expected ']' at the end of a table declaration"), ("\n= 3\n", 2, "invalid statement"),
    ("[pier]\n[pier]\n", 2, "cannot declare ('pier',) twice"),
    ("beta = [1,\n2\n\n", 2, "unclosed array"), ("title = \"a\nb = 1\n", 1, "illegal character"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "line", "reason"), NOT_TOML)
def test_what_is_not_toml_is_refused_with_its_line_and_what_was_meant_or_the_rules(tmp_path, text, line, reason):
    path = tmp_path / "study.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        TomlFile.read(path)
    (problem,) = caught.value.messages
    assert problem.startswith(f"{path}:{line}: not valid TOML: {reason}")
    meant = meant_line(text.splitlines()[line - 1])
    assert problem.endswith(f": {text.splitlines()[line - 1]}; {f'write {meant}' if meant else RULES}")
    assert not meant or tomllib.loads(meant)


def test_a_file_that_is_not_utf8_is_refused_with_its_line(tmp_path):
    path = tmp_path / "study.toml"
    path.write_bytes(b'title = "a"\nnotes = "\xb5"\n')
    with pytest.raises(InputError, match=r"study\.toml:2: not UTF-8"):
        TomlFile.read(path)


@pytest.mark.parametrize("text", ["x = " + "[" * 5000 + "]" * 5000, "x = " + "9" * 5000])
def test_absurd_values_are_refused_without_a_crash(tmp_path, text):
    path = tmp_path / "study.toml"
    path.write_text(text)
    with pytest.raises(InputError):
        TomlFile.read(path)


def test_a_missing_file_and_a_folder_are_refused(tmp_path):
    (tmp_path / "fig7.toml").touch()
    with pytest.raises(InputError, match=r"no such file; did you mean .*fig7\.toml\?"):
        TomlFile.read(tmp_path / "fig77.toml")
    for name in ("a", "b", "z"):
        (tmp_path / f"{name}.toml").touch()
    with pytest.raises(InputError, match=r"a folder; did you mean \S+/a\.toml or \S+/b\.toml or \S+/fig7\.toml\?$"):
        TomlFile.read(Path(tmp_path))


def test_a_line_that_is_no_toml_is_quoted_as_it_can_be_shown(tmp_path):
    (tmp_path / "x.toml").write_bytes(b'a = "\x1b[31m\0"\n')
    with pytest.raises(InputError) as caught:
        TomlFile.read(tmp_path / "x.toml")
    assert 'a = "\\x1b[31m\\x00"' in str(caught.value)
    assert str(caught.value).isprintable()


# Small CSV files beside a study


@pytest.mark.parametrize(
    ("text", "gaps", "found"),
    [
        ("a,b\n1,2\n# remark\n\n3,4e0\n", False, {"a": [1.0, 3.0], "b": [2.0, 4.0]}),
        ("b;a\n1,5;2\n", False, {"b": [1.5], "a": [2.0]}), ("a\n1\nNaN\n", True, {"a": [1.0, math.nan]}),
        ("a,b\n,2\n", True, {"a": [math.nan], "b": [2.0]}), ("a,b\n,2\n", False, ":2: a = "),
        ("a\nnan\n", False, ':2: a = "nan"'), ("a\n1_0\n", True, ':2: a = "1_0"'),
        ("a,b\n1\n", False, ":2: 1 cells below 2 column names"), ("a,a\n1,2\n", False, ":1: a column occurs twice"),
        ("a,c\n1,2\n", False, ':1: "c": unknown column; write one of a, b'),
        ("# a\na\n", False, "expected a line of column names"),
    ],
)  # fmt: skip
def test_columns_of_a_small_file_are_numbers_or_the_line_says_why_not(tmp_path, text, gaps, found):
    path = tmp_path / "x.csv"
    path.write_text(text, encoding="utf-8")
    kinds = {name: Number("a number above 0", low=0.0, high=10.0, above=True) for name in ("a", "b")}
    if isinstance(found, str):
        with pytest.raises(InputError) as caught:
            columns_of(path, kinds, gaps=gaps)
        assert found in caught.value.messages[0]
    else:
        assert str(columns_of(path, kinds, gaps=gaps)) == str(found)  # NaN equals itself so


def test_a_small_file_of_too_many_lines_is_refused_with_their_number(tmp_path):
    path = tmp_path / "x.csv"
    path.write_text("a\n" + "1\n" * MOST_ROWS, encoding="utf-8")
    with pytest.raises(InputError, match=r"x\.csv: 100,001 lines; at most 100,000 are read"):
        columns_of(path, {"a": Number()})


@pytest.mark.parametrize(
    ("error", "advice"),
    [
        (KindError("a length"), "expected a length"),
        (KindError("a length", "2.5"), "did you mean 2.5? expected a length"),
        (KindError("x" * 99, "2.5"), f"did you mean 2.5? expected {'x' * 99}"),
        (KindError("x" * 100, "2.5"), "did you mean 2.5?"),
        (KindError("it is too long", "2.5", whole=True), "it is too long"),
    ],
)
def test_advice_is_what_was_meant_and_what_was_expected_if_that_is_short(error, advice):
    assert error.advice() == advice


@pytest.mark.parametrize(
    ("kind", "value", "expected", "meant"),
    [
        (boolean, "yes", "true or false (without quotes)", "true"),
        (boolean, "often", "true or false (without quotes)", ""),
        (boolean, 0, "true or false (without quotes)", "false"),
        (boolean, 1.0, "true or false (without quotes)", ""),
        (Choice((1, 2)), "2", "one of 1, 2", "2"),
        (Choice((1, 2)), True, "one of 1, 2", ""),
        (Choice(("left", "right"), listed_by="rockbatch x"), "rihgt", "one that `rockbatch x` lists", '"right"'),
        (Choice(("left", "right"), listed_by="rockbatch x"), "LEFT", "one that `rockbatch x` lists", '"left"'),
    ],
)
def test_an_option_is_accepted_as_its_own_type_only_and_near_ones_are_suggested(kind, value, expected, meant):
    with pytest.raises(KindError) as refused:
        kind(value)
    assert (str(refused.value), refused.value.meant) == (expected, meant)


@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("Width_M", "width_m"), ("diameter_ft", "width_m"), ("c_N_s_m", "nu"), ("widht_m", "width_m"), ("depth_m", ""),
        ("r", "size_m"),
    ],
)  # fmt: skip
def test_a_key_is_known_by_its_letters_its_other_names_and_its_spelling(name, key):
    also = names({"width_m": "diameter", ("coefficient", "nu"): "c", "size_m": "r"})
    assert known_as(name, ["width_m", "size_m", "nu"], also) == key
