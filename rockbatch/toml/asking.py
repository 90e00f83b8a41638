"""What a kind takes, found out by asking it: what editors and the reference know of a key is what the reader does."""

from collections.abc import Iterable
from itertools import pairwise
from typing import Any

from rockbatch.toml.kinds import Choice, Kind, KindError

_NUMBERS = (-1e9, -1.0, 0.0, 1e-14, 0.5, 1.5, 1e9)
_WHOLE = (0, 1, 2, 3, 4)
_TEXTS = ("", "x", "g")
_OTHERS: tuple[Any, ...] = ([0.5, 0.5], {})


def schema(kind: Kind) -> dict[str, Any]:
    """The kind as JSON Schema (draft 7). It may take more than the kind does, never less."""
    if isinstance(kind, Choice):
        return {"enum": list(kind.options)}
    forms: list[dict[str, Any]] = []
    if takes(kind, True):
        forms.append({"type": "boolean"})
    if any(takes(kind, value) for value in _NUMBERS):
        forms.append({"type": "number"} | _bounds(kind))
    elif any(takes(kind, value) for value in _WHOLE):
        forms.append({"type": "integer"} | _bounds(kind))
    if any(takes(kind, value) for value in _TEXTS):
        forms.append({"type": "string"} | ({} if takes(kind, "") else {"minLength": 1}))
    else:
        forms += [{"const": word} for word in _words(kind)]
    forms += [{"type": form} for form, value in zip(("array", "object"), _OTHERS, strict=True) if takes(kind, value)]
    return forms[0] if len(forms) == 1 else {"anyOf": forms}


def told(kind: Kind) -> str:
    """What the kind takes, in the words with which it refuses anything else; the most particular of them."""
    asked: Iterable[Any] = (None, "", *_NUMBERS, *_WHOLE)
    if any(takes(kind, value) for value in (*_NUMBERS, *_WHOLE)):
        asked = (None, "") if _words(kind) else (None, *_NUMBERS, *_WHOLE)
    refusals = [refused for value in asked if (refused := _refusal(kind, value))]
    return list(dict.fromkeys(refusals))[-1] if refusals else "anything"


def takes(kind: Kind, value: Any) -> bool:
    """Whether the kind takes this value."""
    return _refusal(kind, value) is None


def _refusal(kind: Kind, value: Any) -> str | None:
    try:
        kind(value)
    except KindError as wrong:
        return str(wrong)
    return None


def _bounds(kind: Kind) -> dict[str, float]:
    """Where the numbers begin that a kind takes, if that is at 0 or, of whole ones, at 1 to 4."""
    if takes(kind, -1.0) or takes(kind, -1):
        return {}
    if takes(kind, 0.0) or takes(kind, 0):
        return {"minimum": 0}
    least = next((high for low, high in pairwise(_WHOLE) if takes(kind, high) and not takes(kind, low)), None)
    if least is not None and not takes(kind, least - 0.5):
        return {"minimum": least} if not takes(kind, least + 0.5) else {"exclusiveMinimum": least - 1}
    return {"exclusiveMinimum": 0}


def _words(kind: Kind) -> list[str]:
    """Words that a kind takes beside what is no text, as it names them in quotes itself."""
    quoted = [word for value in (None, "") for word in (_refusal(kind, value) or "").split('"')[1::2]]
    return [word for word in dict.fromkeys(quoted) if takes(kind, word)]
