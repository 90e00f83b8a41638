"""Templates of the pages: HTML with values in it, all of which are escaped but :class:`Markup`."""

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from rockbatch.files import legible
from rockbatch.report.labels import counted
from rockbatch.report.markup import Markup, escape, number
from rockbatch.report.table import THETA

if TYPE_CHECKING:
    from jinja2 import Environment


def render(template: str, **values: object) -> Markup:
    """Return a template of this package as HTML; ``template`` is its path in the package."""
    return Markup(_environment().get_template(template).render(values))


@cache
def _environment() -> "Environment":
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    made = Environment(
        loader=FileSystemLoader(Path(__file__).parent),
        autoescape=True,
        finalize=escape,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.filters |= {"number": number, "css": css_string, "as": lambda value, form: format(value, form)}
    made.globals |= {"counted": counted, "THETA": THETA}
    return made


def css_string(text: str) -> Markup:
    """Return ``text`` as a string of a style sheet, which nothing in it can end."""
    written = (char if char.isalnum() or char in " .,()–" else f"\\{ord(char):x} " for char in legible(text))
    return Markup(f'"{"".join(written)}"')
