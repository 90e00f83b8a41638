"""Run an analysis, and write its tables and NAME.json, which describes them."""

import json
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, ClassVar, TypeVar

from rockbatch.batch.compiling import make_ready
from rockbatch.batch.execution import RowOf, Runs, execute_runs
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Listener, Progress, count, listener_of
from rockbatch.batch.threads import Engine, Threads, engine_of
from rockbatch.common.errors import InputError
from rockbatch.common.files import (
    csv_text,
    is_plain,
    made_folder,
    only_writer,
    read_table,
    read_text,
    refuse_irregular,
    remove,
    sha256_of,
    write_whole,
)
from rockbatch.common.lazy import pd
from rockbatch.common.showing import Shown, several
from rockbatch.common.version import __version__
from rockbatch.motions import MotionSet, Unusable
from rockbatch.reporting import REPORT, write_analyses
from rockbatch.reporting.finished_analysis import digest_of
from rockbatch.results.run_json import describe_case, describe_study, versions
from rockbatch.study import Case, Motions, Study, given_study
from rockbatch.study.both_axes import along_the_axis, on_both_axes
from rockbatch.study.suite import ground_motions

A = TypeVar("A", bound="Analysis")
Spec = TypeVar("Spec")


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Analysis(Shown):
    """Results of an analysis; each table is an attribute named after its CSV file, None if the analysis has none.

    ``RUNS`` are those of its ``TABLES`` that have a row for each run.

    Attributes
    ----------
    study : Study
        The study that was analysed.
    info : dict
        The content of NAME.json: settings, runs and cost.
    unusable : tuple of Unusable
        Files of the study that could not be used, with reasons.
    files : tuple of Path
        Paths written; empty without a folder.
    """

    NAME: ClassVar[str]
    TABLES: ClassVar[tuple[str, ...]]
    RUNS: ClassVar[tuple[str, ...]] = ()

    study: Study
    info: dict[str, Any]
    unusable: tuple[Unusable, ...] = ()
    files: tuple[Path, ...] = ()

    @classmethod
    def refuse_irregular(cls, directory: Path) -> None:
        """Raise ``InputError`` if something other than a regular file is where the analysis will write one."""
        names = (*(f"{name}.csv" for name in cls.TABLES), f"{cls.NAME}.json", REPORT)
        refuse_irregular(*(directory / name for name in names))

    @property
    def tables(self) -> "dict[str, pd.DataFrame]":
        """Return the tables of the analysis by name, without those that it does not have."""
        return {name: table for name in self.TABLES if (table := getattr(self, name)) is not None}

    def _facts(self) -> tuple[str, dict[str, str]]:
        """Return the title and, by name, the facts that :class:`Shown` prints: tables, files not used, files written."""
        tables = ", ".join(f"{name} ({count(len(table), 'row')})" for name, table in self.tables.items())
        files = several(len(self.files), "file")
        return f"{self.NAME} of {self.study.title!r}", {
            "tables": tables,
            "not used": several(len(self.unusable), "file") + (", see .unusable" if self.unusable else ""),
            "written": files and f"{files} in {self.files[0].parent}",
        }

    def _beneath(self) -> "pd.DataFrame | None":
        """Return the table that notebooks show below the facts: that of the analysis's own name; None without it."""
        return self.tables.get(self.NAME)

    def save(self, folder: str | os.PathLike[str]) -> tuple[Path, ...]:
        """Write the tables, NAME.json and the report into ``folder``; return their paths.

        Raises ``InputError`` if the disk is full, or if another process is writing into the folder.
        """
        directory = made_folder(Path(folder))
        with only_writer(directory):
            results = AnalysisFolder(directory, self.NAME, self.study)
            results.info = self.info | {"files": []}
            for name in self.TABLES:
                if name in self.tables:
                    results.keep_table(f"{name}.csv", self.tables[name])
                else:
                    results.drop(f"{name}.csv")
            return results.end()


class AnalysisFolder:
    """Folder of an analysis, its tables and NAME.json, with the engine and listener for its runs.

    ``info`` is the content of NAME.json: versions, study, its cases, ``files`` written and the digests of their runs, to
    which the analysis adds its own entries. It is written after each table, so that a later command can keep the table if
    this one is killed. A ``temporary`` folder gets no report. ``suite`` holds the ground motions once read.
    """

    def __init__(
        self,
        directory: Path,
        name: str,
        study: Study,
        *,
        fresh: bool = False,
        listener: Listener | None = None,
        engine: Engine | None = None,
        temporary: bool = False,
    ) -> None:
        self.directory, self.study, self.fresh, self.temporary = directory, study, fresh, temporary
        self.listener, self.engine, self.suite = listener or Listener(), engine or Threads(1), MotionSet()
        self.path = directory / f"{name}.json"
        self.info: dict[str, Any] = {"rockbatch": __version__, "versions": versions(), "study": describe_study(study)}
        self.info |= {"cases": [describe_case(case) for case in study.cases], "files": [], "digests": {}}
        self._earlier = {} if fresh else _earlier_digests(self.path)

    def read_motions(self, study: Study) -> MotionSet:
        """Return the ground motions of ``study``, read, announced to the listener, and listed in ``info``."""
        self.suite = ground_motions(study)
        self.listener.motions(self.suite)
        labels = self.suite.labels
        self.info["under"] = under = []
        for motion in self.suite.motions:
            vertical = motion.pga_vertical is not None
            under.append({"record": motion.name, "label": labels[motion.name], "vertical": vertical})
        return self.suite

    def execute_runs(
        self,
        file: str,
        columns: Sequence[str],
        digest: Mapping[str, str],
        runs: Runs,
        cases: Sequence[Case],
        row: RowOf,
    ) -> None:
        """Carry out ``runs`` and write the ``row`` of each into ``file``, unless it has them; list the file in NAME.json.

        Kernels for ``cases`` are compiled before. Runs in the journal of an interrupted command are not repeated.
        """
        if self.has(file, digest):
            self.keep(file, digest)
            return
        with self.journal(file, columns, digest) as journal:
            with self.listener.progress(len(runs) - len(journal)) as progress:
                make_ready(replace(self.study, cases=tuple(cases)), self.listener)
                execute_runs(runs, self.study.numerics, journal, self.engine, row=row, progress=progress)
            journal.write_in_order(self.directory / file)
            self.keep(file, digest)

    def has(self, file: str, digest: Mapping[str, str]) -> bool:
        """Return whether ``file`` has the runs with ``digest``; False with ``fresh``. ``InputError`` if it has and was edited."""
        path, earlier = self.directory / file, self._earlier.get(file, {})
        if not (earlier.get("runs") == digest and is_plain(path)):
            return False
        if earlier.get("sha256") != sha256_of(path):
            raise InputError(
                f"{path}: edited or damaged; nothing was run: move it away if you edited it, and start over with --fresh"
            )
        return True

    @contextmanager
    def journal(
        self,
        file: str,
        columns: Sequence[str],
        digest: Mapping[str, str],
        beside: Sequence[str] = (),
        stays: bool = False,
    ) -> Iterator[Journal]:
        """Context manager: yield the journal of the runs in ``file``; announce its finished runs, at the start and after Ctrl-C.

        ``beside`` and ``stays`` as for :class:`Journal`. The first new row replaces those of another digest with which ``file``
        was finished.
        """
        path, say = self.directory / f"{file}.part", self.listener.say
        outdated = self._earlier.get(file, {}).get("runs")
        with Journal(
            path, columns, digest, self.fresh, tell=say, beside=beside, stays=stays, outdated=outdated
        ) as journal:
            if len(journal):
                self.listener.say(f"{count(len(journal), 'run')} are finished already (--fresh starts over)")
            try:
                yield journal
            except KeyboardInterrupt:
                if len(journal):
                    remark = f"{count(len(journal), 'run')} are finished and kept in {journal.path}"
                    self.listener.say(f"interrupted: {remark}; the same command continues from there")
                raise

    def keep(self, file: str, digest: Mapping[str, str] | None = None) -> None:
        """List ``file`` in NAME.json as finished, with the digest of its contents and the ``digest`` of its runs.

        With None for that, the digest of its runs stays as it was.
        """
        self.info["files"].append(file)
        noted = self.info["digests"].get(file, {}) if digest is None else {"runs": dict(digest)}
        self.info["digests"] = self.info["digests"] | {file: noted | {"sha256": sha256_of(self.directory / file)}}
        self._write_info()

    def keep_table(self, file: str, table: "pd.DataFrame") -> None:
        """Write ``table`` as a CSV, formatted as by the journal, completely or not at all, and list it in NAME.json."""
        rows = ({str(name): value for name, value in row.items()} for row in table.to_dict("records"))
        write_whole(self.directory / file, csv_text(list(table.columns), rows))
        self.keep(file)

    def drop(self, file: str) -> None:
        """Remove a table of an earlier analysis that this one does not have; nothing happens if it is not there."""
        remove(self.directory / file)

    def tables(self, names: Sequence[str]) -> "dict[str, pd.DataFrame | None]":
        """Return the tables NAME.csv by ``names``, read from the folder; None for those that the analysis does not have."""
        files = self.info["files"]
        return {name: read_table(self.directory / f"{name}.csv") if f"{name}.csv" in files else None for name in names}

    def end(self, **cost: object) -> tuple[Path, ...]:
        """Add ``cost`` to NAME.json, write the report, and return the paths of all files.

        For a temporary folder no report is written, and () is returned.
        """
        self.info |= cost
        self._write_info()
        if self.temporary:
            return ()
        report = write_analyses(self.directory, self.study)
        return (*(self.directory / file for file in self.info["files"]), self.path, report)

    def _write_info(self) -> None:
        content = self.info | {"sha256": digest_of(self.info)}
        write_whole(self.path, json.dumps(content, indent=1, ensure_ascii=False) + "\n")


def run_analysis(
    kind: type[A],
    read: Callable[[Study], Spec],
    work: Callable[[AnalysisFolder, Spec], dict[str, Any]],
    study: str | os.PathLike[str] | Study,
    out: str | os.PathLike[str] | None,
    motions: Motions,
    jobs: int | Engine | None,
    fresh: bool,
    progress: Progress,
    takes_both_axes: Callable[[Spec], bool] = lambda spec: False,
) -> A:
    """Run an analysis of ``study``: ``work`` writes its tables into ``out``, and returns its other attributes.

    ``read`` extracts the settings that ``work`` takes from the study. Cases across the pier's axis are left out unless
    ``takes_both_axes`` returns True for these settings. Without ``out``, a temporary folder is used and removed. Other
    parameters as in :func:`rockbatch.run`.
    """
    started = time.monotonic()
    loaded, listener, engine = given_study(study, motions), listener_of(progress), engine_of(jobs)
    spec = read(loaded)
    if on_both_axes(loaded.cases) and not takes_both_axes(spec):
        listener.say("other_width_m: this analysis takes the cases along the axis of the pier only")
        loaded = replace(loaded, cases=along_the_axis(loaded.cases))
        spec = read(loaded)
    if out is not None:
        kind.refuse_irregular(Path(out))
    with nullcontext(out) if out is not None else TemporaryDirectory(prefix="rockbatch-") as directory, engine:
        results = AnalysisFolder(
            Path(directory), kind.NAME, loaded, fresh=fresh, listener=listener, engine=engine, temporary=out is None
        )
        attributes = work(results, spec)
        files = results.end(wall_s=round(time.monotonic() - started, 3))
        unusable, content = tuple(results.suite.unusable), results.tables(kind.TABLES) | attributes
        return kind(study=results.study, info=results.info, unusable=unusable, files=files, **content)


def _earlier_digests(path: Path) -> dict[str, dict[str, Any]]:
    """Return the digests in an earlier NAME.json, of each file and its runs; empty if it cannot be read."""
    try:
        digests = dict(json.loads(read_text(path))["digests"])
        return {file: noted for file, noted in digests.items() if isinstance(noted, dict)}
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return {}
