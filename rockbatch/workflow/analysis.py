"""Results of an analysis and its folder: the tables, and NAME.json, which describes them."""

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
from rockbatch.results.run_json import describe_study, versions
from rockbatch.study import Case, Motions, Study, given_study
from rockbatch.study.both_axes import along_the_axis
from rockbatch.study.suite import ground_motions

A = TypeVar("A", bound="Analysis")
Spec = TypeVar("Spec")


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Analysis(Shown):
    """Results of an analysis: each table is an attribute with the name of its CSV file, None if the analysis has none.

    Attributes
    ----------
    study : Study
        The study that was analysed.
    info : dict
        NAME.json: what was done, and its cost.
    unusable : tuple of Unusable
        Files of the study that are no usable records, and why.
    files : tuple of Path
        Paths written; empty if none were.
    """

    NAME: ClassVar[str]
    TABLES: ClassVar[tuple[str, ...]]

    study: Study
    info: dict[str, Any]
    unusable: tuple[Unusable, ...] = ()
    files: tuple[Path, ...] = ()

    @classmethod
    def refuse_irregular(cls, directory: Path) -> None:
        """Raise ``InputError`` if no regular file stands where one of this analysis is to be written."""
        names = (*(f"{name}.csv" for name in cls.TABLES), f"{cls.NAME}.json", REPORT)
        refuse_irregular(*(directory / name for name in names))

    @property
    def tables(self) -> "dict[str, pd.DataFrame]":
        """Return the tables that the analysis has, by their names."""
        return {name: table for name in self.TABLES if (table := getattr(self, name)) is not None}

    def _facts(self) -> tuple[str, dict[str, str]]:
        """See :class:`Shown`."""
        tables = ", ".join(f"{name} ({count(len(table), 'row')})" for name, table in self.tables.items())
        files = several(len(self.files), "file")
        return f"{self.NAME} of {self.study.title!r}", {
            "tables": tables,
            "not used": several(len(self.unusable), "file") + (", see .unusable" if self.unusable else ""),
            "written": files and f"{files} in {self.files[0].parent}",
        }

    def _beneath(self) -> "pd.DataFrame | None":
        """See :class:`Shown`."""
        return self.tables.get(self.NAME)

    def save(self, folder: str | os.PathLike[str]) -> tuple[Path, ...]:
        """Write what the command leaves in ``folder``: the tables, NAME.json and the report; return their paths.

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
    """Folder of an analysis: its tables, and NAME.json, which describes them; and what carries out its runs.

    ``info`` is the content of NAME.json: what was done, in which ``files`` it is, and of which runs, by their digests; the
    analysis adds its own. It is written as soon as a table is, so that a later command takes the table as it is if this one is
    killed. A ``temporary`` folder has no report. ``suite`` are the ground motions that were read.
    """

    def __init__(
        self, directory: Path, name: str, study: Study, *, fresh: bool = False, listener: Listener | None = None,
        engine: Engine | None = None, temporary: bool = False,
    ) -> None:  # fmt: skip
        self.directory, self.study, self.fresh, self.temporary = directory, study, fresh, temporary
        self.listener, self.engine, self.suite = listener or Listener(), engine or Threads(1), MotionSet()
        self.path = directory / f"{name}.json"
        self.info: dict[str, Any] = {"rockbatch": __version__, "versions": versions(), "study": describe_study(study)}
        self.info |= {"files": [], "digests": {}}
        self._earlier = {} if fresh else _earlier(self.path)

    def read_motions(self, study: Study) -> MotionSet:
        """Return the ground motions of ``study``; announce them, and note them for the report to name."""
        self.suite = ground_motions(study)
        self.listener.motions(self.suite)
        labels = self.suite.labels
        self.info["under"] = [
            {"record": m.name, "label": labels[m.name], "vertical": m.pga_vertical is not None}
            for m in self.suite.motions
        ]
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
        """Write the ``row`` of each of ``runs`` into ``file``, unless it holds them already; ``cases`` need all their kernels."""
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
        """Return whether ``file`` holds the runs with that digest already; raises ``InputError`` if it was edited."""
        path, earlier = self.directory / file, self._earlier.get(file)
        if not (isinstance(earlier, dict) and earlier.get("runs") == digest and is_plain(path)):
            return False
        if earlier.get("sha256") != sha256_of(path):
            raise InputError(
                f"{path}: not as it was written; nothing is run: keep it as a copy elsewhere if it was edited, and start "
                "over with --fresh"
            )
        return True

    @contextmanager
    def journal(self, file: str, columns: Sequence[str], digest: Mapping[str, str]) -> Iterator[Journal]:
        """Yield the journal of the runs in ``file``; report what is in it already, and what stays in it after Ctrl-C."""
        with Journal(self.directory / f"{file}.part", columns, digest, self.fresh, tell=self.listener.say) as journal:
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
        """Note that ``file`` is finished, and which runs it holds."""
        self.info["files"].append(file)
        noted = self.info["digests"].get(file, {}) if digest is None else {"runs": dict(digest)}
        self.info["digests"] = self.info["digests"] | {file: noted | {"sha256": sha256_of(self.directory / file)}}
        self._write_info()

    def keep_table(self, file: str, table: "pd.DataFrame") -> None:
        """Write ``table`` as CSV, as the journal writes its rows, whole or not at all, and note it."""
        rows = ({str(name): value for name, value in row.items()} for row in table.to_dict("records"))
        write_whole(self.directory / file, csv_text(list(table.columns), rows))
        self.keep(file)

    def drop(self, file: str) -> None:
        """Remove a table that an earlier analysis had, and this one has not."""
        remove(self.directory / file)

    def tables(self, names: Sequence[str]) -> dict[str, Any]:
        """Return the tables NAME.csv as the disk has them; None for those that this analysis does not have."""
        files = self.info["files"]
        return {name: read_table(self.directory / f"{name}.csv") if f"{name}.csv" in files else None for name in names}

    def end(self, **cost: object) -> tuple[Path, ...]:
        """Note what the analysis cost, and write the report; return all files that stay."""
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
    """Return an analysis of ``study``: ``work`` writes its tables into ``out``, and returns its other attributes.

    ``read`` returns the settings of the study that ``work`` takes. Cases across the axis of others are taken if
    ``takes_both_axes`` with these settings. Without ``out`` the folder is a temporary one, removed with
    all that is in it. The others as for :func:`rockbatch.run`.
    """
    started = time.monotonic()
    loaded, listener, engine = given_study(study, motions), listener_of(progress), engine_of(jobs)
    spec, cases = read(loaded), along_the_axis(loaded.cases)
    if len(cases) < len(loaded.cases) and not takes_both_axes(spec):
        listener.say("other_width_m: this analysis takes the cases along the axis of the pier only")
        loaded = replace(loaded, cases=cases)
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


def _earlier(path: Path) -> dict[str, Any]:
    """Return the digests of the runs in each file, and of the file, as an earlier analysis has noted them."""
    try:
        return dict(json.loads(read_text(path))["digests"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return {}
