"""Parts that the commands of analyses share."""

import argparse
from typing import TYPE_CHECKING, Any

from rockbatch.commands.messages import Terminal, say
from rockbatch.commands.options import engine, folder

if TYPE_CHECKING:
    from rockbatch.analysis.folder import Analysis


def asked(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the arguments of every analysis: its folder, its engine, and the listener for its messages."""
    return {
        "out": folder(arguments),
        "jobs": engine(arguments),
        "fresh": arguments.fresh,
        "progress": Terminal(),
    }


def tell_files(analysis: "Analysis") -> None:
    """Print the paths of the files that were written."""
    for path in analysis.files:
        say(str(path))
