"""What commands that answer a question about a study have in common: what they tell of their journals and files."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rockbatch.commands.messages import count, say

if TYPE_CHECKING:
    from rockbatch.analysis.folder import AnalysisFolder
    from rockbatch.batch.journal import Journal


@contextmanager
def journal_of(
    folder: "AnalysisFolder", file: str, columns: Sequence[str], digest: Mapping[str, str]
) -> "Iterator[Journal]":
    """The journal of the runs in ``file``; tells what is in it already, and what stays in it after Ctrl-C."""
    with folder.journal(file, columns, digest) as journal:
        if len(journal):
            say(f"{count(len(journal), 'run')} are finished already (--fresh starts over)")
        try:
            yield journal
        except KeyboardInterrupt:
            kept = f"{count(len(journal), 'run')} are finished and kept in {journal.path}"
            say(f"interrupted: {kept}; the same command goes on from there")
            raise


def end(folder: "AnalysisFolder", **cost: object) -> None:
    """Say what the analysis cost, write the report, and tell what there is."""
    for path in folder.end(**cost):
        say(str(path))
