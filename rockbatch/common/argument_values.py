"""Types of command-line values, and keywords of ``ArgumentParser.add_argument``."""

import argparse
import math
import re
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from rockbatch.common.grouping import closest
from rockbatch.common.units import number_in_unit_of


def _meant(text: str, number: str) -> argparse.ArgumentTypeError:
    """Return the error of a text that is no number of its kind, with the ``number`` that it probably means; "" for none."""
    return argparse.ArgumentTypeError(
        f"{text}: did you mean {number}?" if number else f"{text}: must be a number alone"
    )


def whole(text: str) -> int:
    """Return a whole number, 1 or above; raise ``ArgumentTypeError`` for another text, with the number of "2.0" and "2x"."""
    if re.fullmatch(r"\d+", text, re.ASCII) and int(text) > 0:
        return int(text)
    if re.fullmatch(r"0*[1-9]\d*(\.0*|[a-zA-Z]+)", text, re.ASCII):
        raise _meant(text, re.split(r"[.a-zA-Z]", text)[0].lstrip("0"))
    if text.lower() in ("all", "auto", "max", "none"):
        raise argparse.ArgumentTypeError(f"{text}: all processors are the default; leave the option out")
    raise argparse.ArgumentTypeError(f"{text}: must be at least 1, a whole number")


def number(text: str) -> float:
    """Return a finite number; raise ``ArgumentTypeError`` for another text, as :func:`_number`."""
    if math.isfinite(value := _number(text)):
        return value
    raise argparse.ArgumentTypeError(f"{text}: must be a finite number")


def _number(text: str) -> float:
    """Return a number, "inf" and "nan" too; raise ``ArgumentTypeError`` for another text.

    The error has the number that is probably meant, if any: that before "s" or "counts", another time in seconds, a point for a
    decimal comma, the interval [s] of a rate in Hz.
    """
    with suppress(ValueError):
        return float(text)
    rate = re.fullmatch(r"(\d+(?:\.\d*)?)[ ]*(?:Hz|sps)", text, re.IGNORECASE)
    if rate and float(rate[1]):
        raise _meant(text, f"{1.0 / float(rate[1]):g}")
    decimal = re.fullmatch(r"(-?\d+),(\d+)", text)
    alone = re.fullmatch(r"(-?\d+(?:\.\d*)?(?:e[-+]?\d+)?)[ ]*(?:s|counts?)", text, re.IGNORECASE)
    raise _meant(
        text, f"{decimal[1]}.{decimal[2]}" if decimal else alone[1] if alone else number_in_unit_of("dt", text)
    )


def seconds(text: str) -> float:
    """Return a number above 0, or inf; raise ``ArgumentTypeError`` for another text."""
    if (value := _number(text)) > 0:
        return value
    raise argparse.ArgumentTypeError(f"{text}: must be above 0")


def word(*words: str) -> dict[str, Any]:
    """Return the keywords of ``ArgumentParser.add_argument`` for one of a few ``words``; for others a similar one is named."""

    def one(text: str) -> str:
        if text in words:
            return text
        meant = closest(text, words)
        listed = f"did you mean {meant}?" if meant else f"must be {' or '.join(words)}"
        raise argparse.ArgumentTypeError(f"{text}: {listed}")

    return {"type": one, "choices": words}


def address(text: str) -> str:
    """Return the address of a scheduler, as given; raise ``ArgumentTypeError`` if it is empty or blank."""
    if not text.strip():
        raise argparse.ArgumentTypeError("must be an address such as tcp://10.0.0.1:8786; it is empty")
    return text


def place(text: str) -> Path:
    """Return the path of a folder; raise ``ArgumentTypeError`` if the text is blank, which would be the current folder."""
    if not text.strip():
        raise argparse.ArgumentTypeError("must be a folder; it is empty: write . for this one")
    return Path(text)


def file(text: str) -> Path:
    """Return the path of a file to write; raise ``ArgumentTypeError`` if the text is blank."""
    if not text.strip():
        raise argparse.ArgumentTypeError("must be a file; it is empty: write - to print it")
    return Path(text)


def shard(text: str) -> tuple[int, int]:
    """Return shard and number of shards: "2/4" gives (2, 4); raise ``ArgumentTypeError`` for other texts, as "0/4" or "5/4".

    The error says "2/4" for "2-4", "2,4" or "2of4".
    """
    match = re.fullmatch(r"(\d+)[ ]*(/|-|,|:|of)[ ]*(\d+)", text, re.ASCII)
    share, shares = (int(match[1]), int(match[3])) if match else (0, 0)
    if match is None or not 1 <= share <= shares:
        raise argparse.ArgumentTypeError(f"{text}: must be such as 2/4, the second of four shares")
    if match[2] != "/":
        raise _meant(text, f"{share}/{shares}")
    return share, shares


def case_pair(text: str) -> tuple[str, str]:
    """Return the names before and after the first "=" of "A=B". Raises ``ArgumentTypeError`` if there are no two.

    The error proposes "A=B" for "A:B", "A,B", "A->B", "A=>B" and "A==B".
    """
    first, sign, second = text.partition("=")
    if first and sign and second and not second.startswith(("=", ">")):
        return first, second
    if other := re.fullmatch(r"([^=:,]+?)[ ]*(?:==|=>|->|:|,)[ ]*([^=:,]+)", text):
        raise _meant(text, f"{other[1]}={other[2]}")
    raise argparse.ArgumentTypeError(f"{text}: must be two cases in a word, such as pads=springs")


def flag(text: str) -> dict[str, Any]:
    """Return the keywords of ``ArgumentParser.add_argument`` for a flag with a help ``text``."""
    return {"action": "store_true", "help": text}


def value(kind: Callable[[str], Any], metavar: str | None, text: str, **more: Any) -> dict[str, Any]:
    """Return the keywords of ``ArgumentParser.add_argument`` for an argument with a value of this ``kind``."""
    return {"type": kind, "metavar": metavar, "help": text, **more}
