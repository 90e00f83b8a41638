"""Clock times in tables of numbers, such as 2023-02-06T01:17:35.010Z, converted to seconds after the first of them."""

import re
from datetime import UTC, datetime, timedelta

_CLOCK = re.compile(
    r"""^(?P<before>[ \t]*(?:\d+[ \t]*[,;\t][ \t]*)?)"?
    (?:(?:(?P<date>\d{4}[-/]\d\d[-/]\d\d)|\d{1,2}[-/.](?:\d{1,2}|[a-zA-Z]{3})[-/.]\d{2,4})[T ])?
    (?P<clock>\d{1,2}:\d\d:\d\d)(?:[.,](?P<fraction>\d{1,12}))?
    (?P<zone>[ ]?(?:Z|UTC|GMT)|[+-]\d\d:?\d\d)?"?(?=[ \t]*(?:[,;\t ]|$))""",
    re.MULTILINE | re.VERBOSE,
)
_DECIMAL_COMMA = re.compile(  # in the line behind a time, which no comma and no line with points follows
    r"[ \t]*(?:;|[ \t](?!,))(?=[^\n.]*(?:\n|$))(?=[^\n]*\d,\d)"
)
_FEWEST = 3  # lines that begin with a time; a header has one at most
_DAY = 86400  # s


def in_seconds(text: str) -> tuple[str, float | None]:
    """Return a text with times at the beginning of lines as seconds after the first, and the first [s since 1970, UTC].

    The first is ``None`` if the times lack a date or a zone, or the date begins with its day or month, which may be either; fewer
    than three times, or an impossible one, leave the text as it is, with ``None``. Seconds have a decimal comma if the numbers
    behind have.
    """
    if ":" not in text or len(times := list(_CLOCK.finditer(text))) < _FEWEST:
        return text, None
    try:
        first = _moment(times[0])
    except ValueError:
        return text, None
    fraction = _nanoseconds(times[0])
    days, latest = 0, first
    has_commas = (_DECIMAL_COMMA.match(text, match.end()) for match in times)
    point = "," if any(has_commas) else "."

    def seconds(match: re.Match[str]) -> str:
        """Return the line's beginning with seconds in place of its time."""
        nonlocal days, latest
        moment = _moment(match) + timedelta(days=days)
        if match["date"] is None and moment < latest:  # past midnight
            days += 1
            moment += timedelta(days=1)
        latest = moment
        since = int((moment - first).total_seconds()) * 10**9 + _nanoseconds(match) - fraction
        sign, since = ("-" if since < 0 else ""), abs(since)
        return f"{match['before']}{sign}{since // 10**9}{point}{since % 10**9:09d}"

    try:
        return _CLOCK.sub(seconds, text), _start(times[0], first, fraction)
    except ValueError:  # an impossible clock time
        return text, None


def _moment(match: re.Match[str]) -> datetime:
    """Return a time in whole seconds, without its zone; on 1970-01-01 without a date that begins with its year."""
    date = (match["date"] or "1970-01-01").replace("/", "-")
    return datetime.fromisoformat(f"{date}T{match['clock']:0>8}")


def _nanoseconds(match: re.Match[str]) -> int:
    return int((match["fraction"] or "0").ljust(9, "0")[:9])


def _start(match: re.Match[str], first: datetime, nanoseconds: int) -> float | None:
    """Return a time [s since 1970, UTC], plus its ``nanoseconds``; ``None`` if written without a zone or a date by year."""
    zone = (match["zone"] or "").strip()
    if match["date"] is None or not zone:
        return None
    offset = datetime.strptime(zone.replace(":", ""), "%z").utcoffset() if zone[0] in "+-" else timedelta()
    return (first - (offset or timedelta())).replace(tzinfo=UTC).timestamp() + 1e-9 * nanoseconds
