"""Values of arguments: their types, and how argparse is given them."""

import argparse
import re
from collections.abc import Callable
from typing import Any


def positive(kind: Callable[[str], float], least: str) -> Callable[[str], float]:
    """Return the type of numbers above 0, of which the smallest is in words ``least``."""

    def number(text: str) -> float:
        value = kind(text)
        if not value > 0:
            raise argparse.ArgumentTypeError(f"{text}: must be {least}")
        return value

    number.__name__ = kind.__name__  # of which argparse says "invalid int value"
    return number


whole, seconds = positive(int, "at least 1"), positive(float, "above 0")


def address(text: str) -> str:
    """Return the address of a scheduler."""
    if not text.strip():
        raise argparse.ArgumentTypeError("must be an address such as tcp://10.0.0.1:8786; it is empty")
    return text


def shard(text: str) -> tuple[int, int]:
    """Return a share and the number of shares, of "2/4"."""
    match = re.fullmatch(r"(\d+)/(\d+)", text, re.ASCII)
    share, shares = map(int, match.groups()) if match else (0, 0)
    if not 1 <= share <= shares:
        raise argparse.ArgumentTypeError(f"{text}: must be such as 2/4, the second of four shares")
    return share, shares


def flag(text: str) -> dict[str, Any]:
    """Return the keywords of an argument that is given or not."""
    return {"action": "store_true", "help": text}


def value(kind: Callable[[str], Any], metavar: str | None, text: str, **more: Any) -> dict[str, Any]:
    """Return the keywords of an argument with a value."""
    return {"type": kind, "metavar": metavar, "help": text, **more}
