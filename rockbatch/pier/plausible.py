"""Implausible sizes, as of a wrong unit or of two values exchanged: refused until ``confirm`` names them."""

from collections.abc import Collection

from rockbatch.errors import remedy

LOWEST, HIGHEST = 0.25, 2.5
"""Bounds of the heights of deck and drift, over the pier's height."""


def unlikely_sizes(width_m: float, height_m: float, confirm: Collection[str], **heights: float | None) -> list[str]:
    """Return what is odd about a pier's width and height [m] and its other ``heights``, except those in ``confirm``."""
    odd = {}
    if width_m > height_m:
        odd["width_m"] = (
            f"width_m = {width_m:g}: more than the height, {height_m:g} m: such a block lifts off at {width_m / height_m:.2g} g "
            "only, and slides before; width and height may be exchanged"
        )
    for name, value in heights.items():
        if value is not None and not LOWEST * height_m <= value <= HIGHEST * height_m:
            odd[name] = f"{name} = {value:g}: {value / height_m:.2g} times the height of the pier, {height_m:g} m"
    return [f"{text}; {remedy(name)}" for name, text in odd.items() if name not in confirm]
