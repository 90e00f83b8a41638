"""What an analysis leaves in a folder: its tables, and NAME.json, which says what they hold."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch._version import __version__
from rockbatch.batch.journal import Journal
from rockbatch.files import csv_text, write_whole
from rockbatch.report import write_analyses
from rockbatch.study import Study

if TYPE_CHECKING:
    import pandas as pd


class AnalysisFolder:
    """What an analysis leaves in a folder: its tables, and NAME.json, which says what they hold.

    ``info`` is what NAME.json will say: what was done, in which ``files`` it is, and of which runs, by their digests. It
    is written as soon as a table is, so that a command that was killed later takes it as it is.
    """

    def __init__(self, directory: Path, name: str, study: Study, fresh: bool) -> None:
        self.directory, self.study, self.fresh = directory, study, fresh
        self.path = directory / f"{name}.json"
        sha256 = hashlib.sha256(study.text.encode()).hexdigest()
        of_study = {
            "path": str(study.path),
            "title": study.title,
            "notes": study.notes,
            "text": study.text,
            "sha256": sha256,
        }
        self.info: dict[str, Any] = {"rockbatch": __version__, "study": of_study, "files": [], "digests": {}}
        self._earlier = {} if fresh else _digests(self.path)

    def has(self, file: str, digest: Mapping[str, str]) -> bool:
        """Whether ``file`` holds the runs with that digest already."""
        return self._earlier.get(file) == digest and (self.directory / file).exists()

    def journal(self, file: str, columns: Sequence[str], digest: Mapping[str, str]) -> Journal:
        """The journal of the runs in ``file``, not yet entered."""
        return Journal(self.directory / f"{file}.part", columns, digest, self.fresh)

    def keep(self, file: str, digest: Mapping[str, str] | None = None) -> None:
        """Note that ``file`` is finished, and which runs it holds."""
        self.info["files"].append(file)
        if digest is not None:
            self.info["digests"][file] = dict(digest)
        write_whole(self.path, json.dumps(self.info, indent=1, ensure_ascii=False) + "\n")

    def keep_table(self, file: str, table: "pd.DataFrame") -> None:
        """Write ``table`` as CSV, as the journal writes its rows, whole or not at all, and note it."""
        rows = ({str(name): value for name, value in row.items()} for row in table.to_dict("records"))
        write_whole(self.directory / file, csv_text(list(table.columns), rows))
        self.keep(file)

    def end(self, **cost: object) -> list[Path]:
        """Note what the analysis cost, and write the report; returns all files that there are."""
        self.info |= cost
        write_whole(self.path, json.dumps(self.info, indent=1, ensure_ascii=False) + "\n")
        report = write_analyses(self.directory, self.study)
        return [*(self.directory / file for file in self.info["files"]), self.path, report]


def _digests(path: Path) -> dict[str, Any]:
    """Digests of the runs in each file, as an earlier analysis has noted them."""
    try:
        return dict(json.loads(path.read_text(encoding="utf-8"))["digests"])
    except (OSError, ValueError, KeyError, TypeError):
        return {}
