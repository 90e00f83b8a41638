"""Render templates of pages and sections; every value is escaped except :class:`Markup`."""

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
    """A section of the page: its heading, its anchor (the ``id`` that links go to) and its body.

    A ``folded`` section unfolds when a reader clicks its heading or a link to it. ``badge`` is a number beside its entry in
    the list of sections.
    """

    heading: str
    anchor: str
    content: Markup
    folded: bool = False
    badge: int = 0


def styles(*names: str) -> Markup:
    """Return the style sheets of these names, one after the other."""
    return Markup("".join((HERE / name).read_text(encoding="utf-8") for name in names))


def document(
    title: str, about: object, sections: Iterable[Section], version: str = __version__, whole: bool = False
) -> str:
    """Return a page as HTML; sections without content are left out.

    ``about`` stands below the title. Printed pages bear the title and ``version``, that of the rockbatch that computed the
    results. Folded sections are not printed; with ``whole`` none is folded.
    """
    script = (HERE / "script.js").read_text(encoding="utf-8")
    return render(
        "reporting/page.html",
        title=title,
        about=about,
        sections=[section for section in sections if section.content],
        version=f"rockbatch {version}",
        digest=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
        markers=markers(),
        style=styles("style.css"),
        script=Markup(script),
        whole=whole,
    )


def render(template: str, **values: object) -> Markup:
    """Render ``template``, a path in rockbatch, with ``values``.

    Raises ``KeyError`` if a value that the template uses is missing.
    """
    from jinja2 import UndefinedError

    try:
        return Markup(_environment().get_template(template).render(values))
    except UndefinedError as error:
        raise KeyError(str(error)) from error


@cache
def _environment() -> "Environment":
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(TOP),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=lambda value: value if hasattr(value, "__html__") else escape(value),
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"f": number, "css": css_string, "shell": shlex.join}
    environment.globals |= {"counted": counted, "THETA": THETA}
    return environment


def css_string(text: str) -> Markup:
    """Return ``text`` as a quoted CSS string, escaped so that it cannot end early."""
    written = (char if char.isalnum() or char in " .,()–" else f"\\{ord(char):x} " for char in legible(text))
    return Markup(f'"{"".join(written)}"')
