"""What commands that answer a question about a study have in common."""

import argparse
from typing import TYPE_CHECKING, Any

from rockbatch.commands.messages import Terminal, say
from rockbatch.commands.options import engine, folder

if TYPE_CHECKING:
    from rockbatch.analysis.folder import Analysis


def asked(arguments: argparse.Namespace) -> dict[str, Any]:
    """What the command line says of every analysis: its folder, what carries it out, and who hears of it."""
    return {
        "out": folder(arguments),
        "jobs": engine(arguments),
        "fresh": arguments.fresh,
        "progress": Terminal(),
    }


def tell_files(found: "Analysis") -> None:
    """Say what was written."""
    for path in found.files:
        say(str(path))
