"""What a refusal says of the lines of a file is true of them: tried on files of all text formats with one fault each."""

import random
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from damaged_files import SAMPLES

from rockbatch.common.errors import InputError
from rockbatch.motions.formats import read_record
from rockbatch.motions.sources.record_file import ReadOptions, RecordFile

NUMBER = re.compile(r"-?\d+\.?\d*")


def with_one_fault(lines, i, rng):
    """Yield the lines with a number that is none or has a digit more, with line i lost, twice or halved, and cut before it."""
    before, line, after = lines[:i], lines[i], lines[i + 1 :]
    if numbers := list(NUMBER.finditer(line)):
        for wrong in ("x7", lambda found: found[0] + "1"):
            chosen = rng.choice(numbers)
            text = wrong if isinstance(wrong, str) else wrong(chosen)
            yield [*before, line[: chosen.start()] + text + line[chosen.end() :], *after]
    yield before + after
    yield [*before, line, line, *after]
    yield before
    yield [*before, line[: len(line) // 2], *after]


def line_of(lines, number):
    return lines[int(number) - 1].rstrip() if int(number) <= len(lines) else ""


def numbers_of(line):
    """Return how many numbers a line has, in columns that may touch each other."""
    return len(re.findall(r"-?\d+\.?\d*(?:[EDed][-+]\d+)?", line))


OF_HEADERS = (40, 48, 50, 60)
"""Numbers in headers of one format, which no line of the file states."""


def declared(lines, count):
    """Return whether a number of values is a count of a line, or of that many pairs or samples of three components."""
    stated = {int(number) for line in lines for number in re.findall(r"\d+", line)}
    return int(count) in OF_HEADERS or any(int(count) == each * count_of for each in stated for count_of in (1, 2, 3))


CLAIMS: dict[str, Callable[..., bool]] = {
    r'line (\d+): found "(.+?)…?"(?:;| after|, \d+ char)': lambda lines, n, text: text in line_of(lines, n),
    r'line (\d+): found "(.+?)", shorter': lambda lines, n, text: line_of(lines, n).split()[-1] == text,
    r'line (\d+): found "(.+)…", (\d+) characters': lambda lines, n, text, count: (
        len(line_of(lines, n)) - line_of(lines, n).index(text) == int(count)
    ),
    r"line (\d+): found (\d+) numbers": lambda lines, n, count: numbers_of(line_of(lines, n)) == int(count),
    r'line (\d+): found (?:".*"|\d+ numbers); expected (\d+) (?:numbers )?as above': lambda lines, n, count: (
        numbers_of(line_of(lines, int(n) - 1)) == int(count)
    ),
    r"line (\d+): found the end of the file": lambda lines, n: int(n) > len(lines),
    r"take (\d+) lines, but the file ends with line (\d+)": lambda lines, needed, n: (
        int(n) == len(lines) and int(needed) > 0
    ),
    r"header says (\d+) (?:values|samples)": lambda lines, count: (
        count in re.findall(r"\d+", " ".join(line for line in lines if numbers_of(line) < 4))
    ),
    r"(\d+) (?:values|samples) from line (\d+) on": lambda lines, count, n: declared(lines[: int(n) - 1], count),
    r"from line (\d+) on take \d+ lines, but there are (\d+)": lambda lines, n, found: (
        len("\n".join(lines[int(n) - 1 :]).rstrip().splitlines()) == int(found)
    ),
    r"line (\d+) says (\d+) points": lambda lines, n, count: (
        int(count) in map(int, re.findall(r"\d+", line_of(lines, n)))
    ),
    r'line (\d+): "(.+)" a second time': lambda lines, n, key: (
        line_of(lines, n).startswith(key) and any(line.startswith(key) for line in lines[: int(n) - 1])
    ),
    r'the header says ([^"]+): "(.+?)"': lambda lines, key, value: any(
        key in line and value in line[line.index(key) + len(key) :] for line in lines
    ),
    r"the header says NPTS = (\d+), but the file holds (\d+) values": lambda lines, stated, count: (
        stated in re.findall(r"\d+", lines[3]) and sum(map(numbers_of, lines[4:])) == int(count)
    ),
}
"""What messages say of a file, with what is true of its lines then."""


def refusal(file, lines):
    """Return why a file of these lines is refused; "" if it is read."""
    data = "".join(f"{line}\n" for line in lines).encode("latin-1")
    try:
        read_record(RecordFile(Path(file), file, data, options=ReadOptions(unit="m/s2")))
    except InputError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("name", [name for name, files in SAMPLES.items() if b"\0" not in files[0][1]])
def test_what_a_refusal_says_of_the_lines_of_a_file_is_true_of_them(name):
    rng, checked = random.Random(name), 0
    for file, whole in SAMPLES[name]:
        lines = whole.decode("latin-1").splitlines()
        for i in sorted(rng.sample(range(len(lines)), min(6, len(lines)))):
            for damaged in with_one_fault(lines, i, rng):
                message = refusal(file, damaged)
                for claim, holds in CLAIMS.items():
                    for found in re.finditer(claim, message):
                        checked += 1
                        assert holds(damaged, *found.groups()), message
    assert checked > 3
