"""Parts of the report that analyses and observers bring, and access to their modules from packages that do not import them."""

from importlib import import_module
from typing import Any, NamedTuple


class ReportPart(NamedTuple):
    """A part of the report: its heading, its anchor, the function that returns it, and the anchor of the part before it."""

    heading: str
    anchor: str
    function: str = "section.section"
    behind: str = ""
    folded: bool = False


def from_slice(folder: str, name: str) -> Any:
    """Return an attribute of a module in a folder: "section.section" in "analyses.design", importing the module."""
    module, _, attribute = name.partition(".")
    return getattr(import_module(f"rockbatch.{folder}.{module}"), attribute)
