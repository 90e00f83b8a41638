"""Write docs/pages/formats.md: the layouts of each format that are read, and the reasons for which others are refused.

    python docs/layouts.py

reads the files of ``tests/helpers/layouts.py``; a test compares the page with their outcome today.
"""

import sys
import tempfile
from pathlib import Path

from rockbatch.motions import read_motions

HERE = Path(__file__).parent
PAGE = HERE / "pages" / "formats.md"
_HEAD = """\
# Formats of records

Tests write every layout below as a file (`tests/helpers/layouts.py`) and read it on its own. *Read* means that unit, step and
direction of all components are recognised; *asked for*, that a manifest or the study has to state or confirm something.
[Ground motions](reference/motions.md) has more on each format.

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
    return "\n".join([*lines, ""])


def _outcome(layout) -> tuple[str, str]:
    """Return the outcome of reading a layout, and its reason."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / layout.file).write_bytes(layout.data)
        motions = read_motions(folder, options=layout.stated)
    reasons = [refused.reason for refused in motions.unusable]
    if motions.motions and not reasons:
        return "read", ""
    reason = reasons[0].split("; if it is right")[0]
    needs_statement = any(word in reasons[0] for word in ("state", "write confirm"))
    return ("asked for" if needs_statement else "refused"), reason.replace("|", "\\|")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
