"""Write docs/pages/formats.md: the layouts of each format that are read, the reasons for which others are refused, and which
statements of its header each format's reader compares with the samples.

    python docs/layouts.py

reads the files of ``tests/helpers/layouts.py`` and ``contradictions.py``; a test compares the page with their outcome today.
"""

import sys
import tempfile
from pathlib import Path

from rockbatch.motions import read_motions
from rockbatch.motions.formats.stated import QUANTITIES
from rockbatch.motions.ranking import Use, use_of

HERE = Path(__file__).parent
PAGE = HERE / "pages" / "formats.md"
_HEAD = """\
# Formats of records

Tests write every layout below as a file (`tests/helpers/layouts.py`) and read it on its own. *Read* means that unit, step and
direction of all components are recognised; *asked for*, that a manifest or the study has to state or confirm something.
[Ground motions](reference/motions.md) has more on each format.

"""
_STATEMENTS = """
## What headers state of their samples

Tests make each of these statements wrong in a whole file (`tests/helpers/contradictions.py`), a number by a factor of 1.1 to 10.
*Error* means that the file is not used; *waits*, that it waits for `confirm`; *warning*, that the table of records marks it;
*note*, that it is remarked; *once*, that nothing else in the file tells it; –, that the header does not state it. Peaks are those
of the accelerations: what is stated of the velocities and displacements that follow them is not compared. No format read here
has a checksum but MiniSEED, whose blocks repeat their last sample.

"""
_LIMITS = """
A number that differs by rounding is right; by less than the first of these limits, it is a note; by more, a warning; by more than
the second, the record waits. A duration that is short by more than a second and 1 % waits, too. Exceptions: extremes of SAC,
which some programs leave as they were, are a note up to a factor of 2; durations of CSMNC, which may leave out the time before
the event, those before the correction in Volume 2 and II, and peaks and durations in text columns are a warning at most.

"""


def page() -> str:
    """Return the text of the page."""
    sys.path.insert(0, str(HERE.parent / "tests" / "helpers"))
    from layouts import LAYOUTS

    outcomes = [(layout.format, layout.what, *_outcome(layout)) for layout in LAYOUTS]
    lines = [_HEAD + "| format | layouts | read | asked for | refused |", "| --- | --: | --: | --: | --: |"]
    for form in dict.fromkeys(row[0] for row in outcomes):
        of_format = [row[2] for row in outcomes if row[0] == form]
        counts = [of_format.count(outcome) for outcome in ("read", "asked for", "refused")]
        lines.append(f"| {form} | {len(of_format)} | {' | '.join(map(str, counts))} |")
    lines += ["", "| format | layout | outcome | why |", "| --- | --- | --- | --- |"]
    lines += [f"| {' | '.join(row)} |" for row in outcomes]
    return "\n".join([*lines, "", *_statements(), ""])


def _statements() -> list[str]:
    """Return the lines of the part on what headers state."""
    from contradictions import HEADERS, ONCE, STATEMENTS, Contradiction

    lines = [_STATEMENTS.strip("\n"), "", f"| format | {' | '.join(STATEMENTS)} | others |", "| --- " * 7 + "|"]
    for header in HEADERS:
        outcomes = {
            name: ONCE if change == ONCE else Contradiction(header, name).consequence()
            for name, change in header.statements.items()
        }
        cells = [outcomes.pop(name, "–") for name in STATEMENTS]
        others = ", ".join(f"{name}: {outcome}" for name, outcome in outcomes.items()) or "–"
        lines.append(f"| {' | '.join([header.format, *cells, others])} |")
    lines += ["", _LIMITS.strip("\n"), "", "| statement | a note up to | waits beyond |", "| --- | --: | --: |"]
    limits = ((name, quantity.limits) for name, quantity in QUANTITIES.items())
    return lines + [f"| {name} | {noted:.0%} | {gross:.0%} |" for name, (noted, gross) in limits]


def _outcome(layout) -> tuple[str, str]:
    """Return the outcome of reading a layout, and its reason."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / layout.file).write_bytes(layout.data)
        motions = read_motions(folder, options=layout.stated)
    if motions.motions and not motions.unusable:
        return "read", ""
    refused = motions.unusable[0]
    outcome = "asked for" if use_of(refused) is Use.HELD_BACK else "refused"
    return outcome, refused.reason.replace("|", "\\|")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
