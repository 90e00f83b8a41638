"""What commands tell, on stderr."""

import sys


def say(text: str) -> None:
    """Print a message where it does not mix with what a command was asked for."""
    print(text, file=sys.stderr, flush=True)


def count(n: int, noun: str) -> str:
    """A number of things: "1 run", "2 runs"."""
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"
