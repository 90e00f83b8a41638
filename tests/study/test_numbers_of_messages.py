"""Mistakes in studies, tables and arguments, read back: each line, key and value in a message is the one that is wrong."""

import argparse
import re

import pytest
from messages import assert_states, said_by

from rockbatch.common import argument_values as values
from rockbatch.common.errors import InputError
from rockbatch.common.units import Bounds, Usual
from rockbatch.study import load_study
from rockbatch.study.inputs import outside
from rockbatch.study.lists import MOST_CASES, too_many
from rockbatch.study.tables import changed, plain
from rockbatch.toml import csv_columns
from rockbatch.toml.csv_columns import columns_of
from rockbatch.toml.kinds import positive, text

STUDY = """\
title = "Pier 4"

[pier]
width_m = 6.0
height_m = 30.0
mass_t = 1800.0
deck_mass_t = 900.0

[[motions.pulse]]
name = "one"
shape = "sine"
amplitude_g = 0.5
period_s = 0.8
dt_s = 0.01
duration_s = 6.0

[[motions.pulse]]
name = "two"
shape = "ricker"
amplitude_g = 0.4
period_s = 1.6
dt_s = 0.01
duration_s = 9.0

[numerics]
tolerance = 1e-3
quiet_s = 4.0

[output]
histories = "worst"
histories_MB = 200

[[case]]
name = "rigid"
base = "rigid"

[[case]]
name = "pads"
base = "yielding"
stiffness_kN_m = 2e6
yield_kN = 4e4
epsilon = 0.05

[[case.damper]]
kind = "viscous"
coefficient_kN_s_m = 900.0

[[check]]
name = "uplift"
demand = "heel_uplift_m"
at_most = 0.15
reason = "keys"
"""
MISTAKES = {  # what stands in a line of the study: what is written there, and what a message has behind its file and line
    "height_m = 30.0": ("height_m = -31.5", ["[pier]", "height_m", -31.5, 0.0, "height_m", 30.0]),
    "deck_mass_t = 900.0": ("deck_mas_t = 900.0", ["[pier]", "deck_mas_t", "deck_mass_t"]),
    "amplitude_g = 0.5": ('amplitude_g = "big"', ['"one"', "amplitude_g", '"big"', "amplitude_g", 0.5]),
    "period_s = 1.6": ("perod_s = 1.6", ['"two"', "perod_s", "period_s"]),
    "duration_s = 9.0": ("duration_s = 0.0", ['"two"', "duration_s", 0.0, 0.0, "duration_s", 10.0]),
    "tolerance = 1e-3": ("tolerance = 2e-13", ["[numerics]", "tolerance", 2e-13, 1e-12]),
    "quiet_s = 4.0": ("quiet_s = -3.5", ["[numerics]", "quiet_s", -3.5, 0.0, "quiet_s", 2.0]),
    'histories = "worst"': ('histories = "best"', ["[output]", "histories", '"best"', '"worst", "all", "none"']),
    "epsilon = 0.05": ("epsilon = 1.75", ['"pads"', "epsilon", 1.75]),
    'kind = "viscous"': ('kind = "viscos"', ['"pads", damper', 1.0, "kind", '"viscos"', '"viscous"', '"friction"']),
    "at_most = 0.15": ("at_mst = 0.15", ['"uplift"', "at_mst", "at_most"]),
    'demand = "heel_uplift_m"': (
        'demand = "heel_uplft_m"',
        ['"uplift"', "demand", '"heel_uplft_m"', '"heel_uplift_m"'],
    ),
}


def messages_of(folder, study):
    """Return why a study is refused, a message for each mistake, without the folder."""
    path = folder / "study.toml"
    path.write_text(study, encoding="utf-8")
    with pytest.raises(InputError) as refused:
        load_study(path)
    return [message.replace(f"{folder}/", "") for message in refused.value.messages]


NAMES = [*MISTAKES]


@pytest.mark.parametrize("n", range(len(NAMES)), ids=NAMES)
def test_of_two_mistakes_each_is_told_with_its_own_line_key_and_value(tmp_path, n):
    first = NAMES[n]
    for second in (NAMES[n - 1], NAMES[n - 4]):
        study = STUDY
        for words in (first, second):
            study = study.replace(words, MISTAKES[words][0])
        messages = messages_of(tmp_path, study)
        assert len(messages) == 2
        for words in (first, second):
            wrong, expected = MISTAKES[words]
            line = study[: study.index(wrong)].count("\n") + 1
            (message,) = (message for message in messages if message.startswith(f"study.toml:{line}: "))
            assert_states(message.removeprefix(f"study.toml:{line}: ").replace("0..1", ""), *expected)


@pytest.mark.parametrize("which", [0, 1])
def test_either_value_that_is_advised_for_one_that_is_missing_is_accepted(tmp_path, which):
    pads = STUDY[STUDY.index("stiffness_kN_m = 2e6") :].partition("[[check]]")[0]
    study = STUDY.replace(pads, "eta = 3.0\n\n").replace("mass_t = 1800.0\ndeck_mass_t = 900.0", "mass_t = 2700.0")
    (message,) = messages_of(tmp_path, study)
    advised = re.search(r"write for example (beta = .+), or (stiffness_kN_m = .+) with mass_t", message).groups()
    path = tmp_path / "study.toml"
    path.write_text(study.replace("eta = 3.0", f"{advised[which]}\neta = 3.0"), encoding="utf-8")
    assert load_study(path).cases


KINDS = {"record": text, "scale": positive}


def table(lines):
    """Return a function that reads a table of these lines."""

    def read(folder):
        path = folder / "table.csv"
        path.write_text("\n".join(lines), encoding="utf-8")
        return said_by(lambda: columns_of(path, KINDS)).replace(f"{folder}/", "")

    return read


TABLES = {
    "a cell too few": (["# of the agency", "record,scale", "a,1.5", "", "b"], ["table.csv", 5.0, 1.0, 2.0]),
    "a word for a number": (["record,scale", "a,1.5", "b,big"], ["table.csv", 3.0, "scale", '"big"', 0.0]),
    "a column of another name": (["", "record,scal", "a,1.5"], ["table.csv", 2.0, '"scal"', "scale"]),
    "a column twice": (["#", "#", "record,record", "a,b"], ["table.csv", 3.0]),
    "no row": (["record,scale"], ["table.csv"]),
}


@pytest.mark.parametrize("name", TABLES)
def test_a_fault_of_a_table_has_its_file_line_and_column(tmp_path, name):
    lines, expected = TABLES[name]
    assert_states(table(lines)(tmp_path), *expected)


def test_a_table_of_too_many_lines_has_its_file_and_both_numbers(tmp_path, monkeypatch):
    monkeypatch.setattr(csv_columns, "MOST_ROWS", 1234)
    assert_states(table(["record,scale", *["a,1"] * 2345])(tmp_path), "table.csv", 2346.0, "lines", 1234.0)


def argument(kind, written):
    """Return why an argument of the command line is refused."""

    def read():
        try:
            return str(kind(written))
        except argparse.ArgumentTypeError as error:
            return str(error)

    return read


WIDTH = Usual(400.0, "m wide", 0.5)
MESSAGES = {
    "a whole number": (argument(values.whole, "3.0"), [3.0, 3.0]),
    "no whole number": (argument(values.whole, "0"), [0.0, 1.0]),
    "a decimal comma": (argument(values.number, "0,25"), [0.0, 25.0, 0.25]),
    "a rate": (argument(values.number, "250 Hz"), [250.0, 0.004]),
    "no time": (argument(values.seconds, "-7.5"), [-7.5, 0.0]),
    "a share": (argument(values.shard, "5/4"), [5.0, 4.0, 2.0, 4.0]),
    "a share in words": (argument(values.shard, "2of7"), [2.0, 2.0, 7.0]),
    "a pair": (argument(values.case_pair, "pads->springs"), ["pads->springs", "pads=springs"]),
    "a word": (argument(values.word("worst", "all")["type"], "worse"), ["worse", "worst"]),
    "a share of 1 in percent": (lambda: Bounds(0.0, 1.0).message(35.0), [0.0, 1.0, 0.35]),
    "a great number": (lambda: Bounds(0.0, 1e15).message(1e16), [1e15]),
    "an unusual value": (
        lambda: map(str, WIDTH.doubts("width_m", 8000.0)),
        ["width_m", 8000.0, 400.0, "mm", "width_m", 8.0, "cm", "width_m", 80.0, '"width_m"'],
    ),
    "a small value": (lambda: map(str, WIDTH.doubts("width_m", 0.25)), ["width_m", 0.25, 0.5, '"width_m"']),
    "lists within lists": (lambda: plain(nested(40), "case", "beta"), ["case.beta.0", 32.0]),
    "a name of no table": (
        lambda: changed({"case": [{"name": "pads"}, {"name": "piles"}]}, {"case": "pods"}),
        ["case", '"pods"', '"pads"'],
    ),
    "too many cases": (lambda: too_many(MOST_CASES + 7, "piers"), [MOST_CASES + 7.0, "piers", MOST_CASES]),
    "a range beside the value": (
        lambda: outside("beta", (30.0, 45.0), [("pads", 50.0)]),
        ["beta", 30.0, 45.0, 50.0, '"pads"', "beta", 30.0, 50.0],
    ),
}


def nested(depth):
    value = []
    for _ in range(depth):
        value = [value]
    return value


@pytest.mark.parametrize("name", MESSAGES)
def test_what_a_message_names_is_what_it_speaks_of(name):
    call, expected = MESSAGES[name]
    assert_states(said_by(call), *expected)
