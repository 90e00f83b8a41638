"""Statements for a calculation file: a paragraph on each design, to copy."""

from itertools import islice

from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.sections.statement.statements import statements
from rockbatch.reporting.sections.verdicts import mark

MOST_CASES = 12
"""Most cases whose statements are on the page; the command prints all."""


def section(finished: Finished) -> Markup:
    """Return a paragraph on each of the first :data:`MOST_CASES` designs; empty without verdicts on cases."""
    if not any(verdict.case for verdict in finished.verdicts):
        return Markup("")
    first = list(islice(statements(finished), MOST_CASES + 1))
    shown = (join(tag("h3", mark(said.verdict, said.name)), tag("p", said.text)) for said in first[:MOST_CASES])
    more = f"These are the first {MOST_CASES} cases. " if len(first) > MOST_CASES else ""
    command = tag("code", "rockbatch statement DIR")
    return join(*shown, tag("p", more, "As text, also of single cases: ", command, ".", class_="legend"))
