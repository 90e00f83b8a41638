"""Numbers in columns of one width, which are read together: to the bit what ``float`` makes of each of them."""

import random

import numpy as np
import pytest
from motion_files import e15_7

from rockbatch.common.errors import InputError
from rockbatch.motions.formats.fixed_width import _ends_within_a_column, aligned_numbers, fixed_numbers

LAYOUTS = {
    "F8.3": (8, lambda x: f"{x:8.3f}"),
    "F10.5": (10, lambda x: f"{x:10.5f}"),
    "I9": (9, lambda x: f"{round(1e3 * x):9d}"),
    "E15.7": (15, e15_7),
    "1PE15.6": (15, lambda x: f"{x:15.6E}"),
    "small e": (14, lambda x: f"{x:14.6e}"),
}


def in_lines(fields, per_line=5):
    return ["".join(fields[i : i + per_line]) for i in range(0, len(fields), per_line)]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_numbers_of_one_layout_are_those_of_float_to_the_bit(layout):
    width, written = LAYOUTS[layout]
    rng = np.random.default_rng(1)
    values = rng.standard_normal(2003) * 10.0 ** rng.integers(-9, 2, 2003)
    fields = [written(float(x)) for x in (*values, 0.0, -0.0, -1e-9)]
    numbers = aligned_numbers(in_lines(fields), width)
    assert numbers is not None
    assert numbers.tobytes() == np.array(list(map(float, fields))).tobytes()


@pytest.mark.parametrize("seed", range(20))
def test_a_damaged_field_is_read_as_float_reads_it_or_left_to_the_slow_reader(seed):
    rng = random.Random(seed)
    left = 0
    for _ in range(100):
        width, written = LAYOUTS[rng.choice(list(LAYOUTS))]
        fields = [written(rng.uniform(-9.0, 9.0)) for _ in range(23)]
        i, k = rng.randrange(23), rng.randrange(width)
        fields[i] = fields[i][:k] + rng.choice("0123456789+-. _eEDx,\t²") + fields[i][k + 1 :]
        numbers = aligned_numbers(in_lines(fields), width)
        left += numbers is None
        assert numbers is None or numbers.tobytes() == np.array(list(map(float, fields))).tobytes()
    assert 20 < left < 90


@pytest.mark.parametrize(
    "lines",
    [
        ["  1.0  2.0", " 1.0  2.0", "  1.0"],
        ["  1.0  2.0", "  1.0 2.0"],
        ["1.0e30", "1.0e-9"],
        ["1234567890.1234567"],
        ["    ", "    "],
    ],
)
def test_lines_of_other_lengths_and_numbers_of_more_digits_are_left_to_it(lines):
    assert aligned_numbers(lines, 5 if len(lines[0]) == 10 else len(lines[0])) is None


@pytest.mark.parametrize(("lines", "per_line", "cut"), [
    (["  100  200", "  300  400", "  500   60"], 2, False), (["  100  200", "  300  400", "  500  60"], 2, True),
    (["  100  200", "  300  400", "  50"], 2, True), (["  100  200", "  300  400", "  500"], 2, False),
    (["  100  200", "  500  60"], 2, False), (["  100  20", "  300  400", "  500  60"], 2, False),
    (["  100", "  300", "  50"], 1, False), (["  100  200  300"] * 2 + ["  400  50"], 3, True),
])  # fmt: skip
def test_a_whole_number_that_has_lost_digits_ends_before_its_column(lines, per_line, cut):
    assert _ends_within_a_column(lines, per_line) == cut


@pytest.mark.parametrize("blanks", ["", "   ", " " * 40])
def test_blanks_may_follow_the_columns_of_fixed_numbers(blanks):
    lines = ["header", *(line + blanks for line in in_lines([f"{x:10.5f}" for x in range(7)]))]
    values, end = fixed_numbers(lines, 1, 7, 10, 5)
    assert values.tolist() == list(range(7))
    assert end == 3


@pytest.mark.parametrize(
    ("written", "per_line", "found"),
    [("9.5f", 5, "45 characters; expected 5 values of 10"), ("10.5f", 4, "40 characters; expected 5 values of 10")],
)
def test_columns_of_another_width_or_number_than_declared_are_refused_with_the_line(written, per_line, found):
    lines = in_lines([format(float(x), written) for x in range(11)], per_line)
    with pytest.raises(InputError, match=rf"line 1: found .* {found}"):
        fixed_numbers(lines, 0, 11, 10, 5)
