"""Types of command-line values, and keywords of ``ArgumentParser.add_argument``."""

import argparse
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any


def positive(kind: Callable[[str], float], least: str) -> Callable[[str], float]:
    """Return a converter of text to a number of this ``kind`` above 0; its error for others says "must be" and ``least``."""

    def number(text: str) -> float:
        value = kind(text)
        if not value > 0:
            raise argparse.ArgumentTypeError(f"{text}: must be {least}")
        return value

    number.__name__ = kind.__name__  # of which argparse says "invalid int value"
    return number


whole, seconds = positive(int, "at least 1"), positive(float, "above 0")


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


def shard(text: str) -> tuple[int, int]:
    """Return shard and number of shards: "2/4" gives (2, 4); raise ``ArgumentTypeError`` for other texts, as "0/4" or "5/4"."""
    match = re.fullmatch(r"(\d+)/(\d+)", text, re.ASCII)
    share, shares = map(int, match.groups()) if match else (0, 0)
    if not 1 <= share <= shares:
        raise argparse.ArgumentTypeError(f"{text}: must be such as 2/4, the second of four shares")
    return share, shares


def case_pair(text: str) -> tuple[str, str]:
    """Return the two names of "A=B". Raises ``ArgumentTypeError`` for other texts."""
    first, sign, second = text.partition("=")
    if not (first and sign and second):
        raise argparse.ArgumentTypeError(f"{text}: must be two cases, such as pads=springs")
    return first, second


def flag(text: str) -> dict[str, Any]:
    """Return the keywords of ``ArgumentParser.add_argument`` for a flag with a help ``text``."""
    return {"action": "store_true", "help": text}


def value(kind: Callable[[str], Any], metavar: str | None, text: str, **more: Any) -> dict[str, Any]:
    """Return the keywords of ``ArgumentParser.add_argument`` for an argument with a value of this ``kind``."""
    return {"type": kind, "metavar": metavar, "help": text, **more}
