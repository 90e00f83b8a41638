"""HTML escaped by construction: whatever is not :class:`Markup` is text, and escaped."""

import html
import math
import re
from functools import cache, lru_cache

from rockbatch.common.files import legible


class Markup(str):
    """Text that is HTML already."""

    def __html__(self) -> str:
        """Return the text for Jinja, which then does not escape it."""
        return self


def escape(content: object) -> str:
    """Return ``content`` as HTML, with control characters made legible; :class:`Markup` stays as it is."""
    return content if isinstance(content, Markup) else _escaped(str(content))


@lru_cache(maxsize=4096)
def _escaped(text: str) -> str:
    return text if _PLAIN.fullmatch(text) else Markup(html.escape(legible(text, keep="\t\r\n")))


_PLAIN = re.compile(r"[A-Za-z0-9_Α-ω\xa0 .,:;/()+−–-]*")
"""Texts that need no escaping: most do not."""


def join(*children: object, between: str = "") -> Markup:
    """Concatenate the children, escaped, with ``between``, not escaped, between them."""
    return Markup(between.join([escape(child) for child in children]))


def tag(name: str, *children: object, **attributes: object) -> Markup:
    """Return an HTML element; ``class_`` becomes ``class``, ``aria_label`` ``aria-label``.

    None and False omit an attribute, True leaves it empty: the element is well-formed XML, too.
    """
    written = []
    for key, value in attributes.items():
        if value is not None and value is not False:
            written.append(f'{_attribute(key)}="{"" if value is True else escape(str(value))}"')
    return Markup(f"<{name}{''.join(written)}>{''.join(map(escape, children))}</{name}>")


@cache
def _attribute(key: str) -> str:
    return f" {key.rstrip('_').replace('_', '-')}"


def interval(low: str, high: str) -> Markup:
    """Return "low – high" of these texts, without a line break; they are not escaped."""
    return Markup(f"{low}\u00a0–\u2060\u00a0{high}")


def number(value: object, form: str = ".4g") -> str:
    """Return a float in the format ``form``, anything else as text; "" for None and NaN.

    Exponents are avoided where few zeros suffice: "182,800", "0.00009", but "1 × 10⁻⁷"; "-0.00" becomes "0.00".
    """
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if not isinstance(value, float):
        return str(value)
    written = format(value, form)
    shown = written if form in _DECIMALS and abs(value) < _LEAST_GROUPED else _without_exponent(written)
    return shown.removeprefix("-") if shown.startswith("-0") and float(shown.replace(",", "")) == 0 else shown


def _without_exponent(written: str) -> str:
    """Return a formatted number in decimals, grouped by thousands from 10,000.

    One that is written with an exponent keeps it, as a power of ten, if it is below 10⁻⁶ or 10¹⁰ and above.
    """
    mantissa, _, exponent = written.partition("e")
    power = int(exponent or 0)
    if not -_FEWEST <= power <= _MOST:
        return f"{mantissa} × 10{str(power).translate(_RAISED)}"
    if not exponent and not mantissa.lstrip("-").partition(".")[0].isdigit():
        return written  # with a sign, in groups already, or infinite
    digits = max(len(mantissa.partition(".")[2]) - power, 0)
    value = float(written)
    return f"{value:,.{digits}f}" if abs(value) >= 1e4 else f"{value:.{digits}f}"


_DECIMALS = frozenset(f".{digits}f" for digits in range(10))
_LEAST_GROUPED = 9999.0
"""Below it a number formatted by :data:`_DECIMALS` needs no grouping, which saves time in long tables."""

_FEWEST, _MOST = 6, 9
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


def paragraphs(*sentences: object) -> Markup:
    """Return a paragraph for each non-empty sentence."""
    return join(*(tag("p", sentence) for sentence in sentences if sentence))


def figure(drawn: Markup, *caption: object) -> Markup:
    """Return a picture with its caption below."""
    return tag("figure", drawn, tag("figcaption", *caption), class_="whole")
