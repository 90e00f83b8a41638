"""Templates of the pages and their sections: HTML with values in it, all of which are escaped but :class:`Markup`."""

import base64
import hashlib
import shlex
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rockbatch.common.files import legible
from rockbatch.common.version import __version__
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, escape, number
from rockbatch.reporting.svg import markers
from rockbatch.reporting.table import THETA

if TYPE_CHECKING:
    from jinja2 import Environment

HERE = Path(__file__).parent

TOP = HERE.parent


class Section(NamedTuple):
    """A part of the page: its heading, its anchor (the ``id`` that links go to), and what stands under the heading.

    A ``folded`` one is unfolded by its heading, and by a link to its anchor. ``badge`` stands beside its name in the list.
    """

    heading: str
    anchor: str
    content: Markup
    folded: bool = False
    badge: int = 0


def document(
    title: str, about: object, sections: Iterable[Section], version: str = __version__, whole: bool = False
) -> str:
    """Return a page as HTML; sections without content are left out.

    ``about`` stands below the title. On paper each page has the title and ``version``, that of the rockbatch that made the
    results, and sections that are folded are left out, unless the page is to be printed ``whole``: then none is.
    """
    style, script = ((HERE / name).read_text(encoding="utf-8") for name in ("style.css", "script.js"))
    return render(
        "reporting/page.html", title=title, about=about, sections=[section for section in sections if section.content],
        version=f"rockbatch {version}", digest=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
        markers=markers(), style=Markup(style), script=Markup(script), whole=whole,
    )  # fmt: skip


def render(template: str, **values: object) -> Markup:
    """Return a template of this package as HTML; ``template`` is its path in rockbatch.

    Raises ``KeyError`` if a value lacks what the template shows.
    """
    from jinja2 import UndefinedError

    try:
        return Markup(_environment().get_template(template).render(values))
    except UndefinedError as error:
        raise KeyError(str(error)) from error


@cache
def _environment() -> "Environment":
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    made = Environment(
        loader=FileSystemLoader(TOP), autoescape=True, undefined=StrictUndefined,
        finalize=lambda value: value if hasattr(value, "__html__") else escape(value),
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip
    made.filters |= {"f": number, "css": css_string, "shell": shlex.join}
    made.globals |= {"counted": counted, "THETA": THETA}
    return made


def css_string(text: str) -> Markup:
    """Return ``text`` as a string of a style sheet, which nothing in it can end."""
    written = (char if char.isalnum() or char in " .,()–" else f"\\{ord(char):x} " for char in legible(text))
    return Markup(f'"{"".join(written)}"')
