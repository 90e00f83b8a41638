"""Messages read back: the numbers in them and the names beside these, in their order."""

import re

from rockbatch.common.errors import InputError

NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def numbers_in(text):
    """Return the numbers of a text, but for those in names such as R0."""
    return [float(number) for number in NUMBER.findall(text.replace(",", ""))]


def resolution(printed):
    """Return by how much a printed number may be off: half a unit of its last digit, or half a percent of a single digit."""
    digits, _, power = printed.partition("e")
    decimals = len(digits.partition(".")[2])
    single = len(digits.replace(".", "").lstrip("-0")) < 2
    return 0.005 * abs(float(printed)) if single else 0.501 * 10.0 ** (int(power or 0) - decimals)


def assert_states(message, *expected):
    """Assert that a message has these texts and numbers in this order, and no number besides."""
    place, text = 0, re.sub(r"(?<=\d),(?=\d{3})", "", message)
    for wanted in expected:
        if isinstance(wanted, str):
            found = re.compile(rf"(?<!\w){re.escape(wanted)}(?!\w)").search(text, place)
            assert found, f"{wanted!r} is not in {text[place:]!r}"
            assert not numbers_in(text[place : found.start()]), f"numbers before {wanted!r} in {text[place:]!r}"
        else:
            found = NUMBER.search(text, place)
            assert found, f"{wanted!r} is not in {text[place:]!r}"
            assert abs(float(found[0]) - wanted) <= resolution(found[0]), (
                f"{wanted!r} is {found[0]} in {text[place:]!r}"
            )
        place = found.end()
    assert not numbers_in(text[place:]), f"numbers left in {text[place:]!r}"


def said_by(call):
    """Return what a call says: the message of its error, or its text; of several texts one after the other."""
    try:
        answer = call()
    except InputError as error:
        return str(error)
    return answer if isinstance(answer, str) else "; ".join(answer)
