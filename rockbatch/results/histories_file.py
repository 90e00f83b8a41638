"""``histories.h5``: the histories of a study's runs in HDF5; h5py is loaded only to write or read it.

::

    /                   attributes: format, rockbatch, created, title, study (its text), sha256
    /versions           attributes: the packages that wrote it
    /runs/000000        attributes: record, case, polarity, scale, status
          varied        attributes: values of the study's varied keys
          pier, base    attributes: their parameters, as in rockbatch.pier; SI, angles in radians
          t, theta, …   the columns of Response.history, shape (n,); those of springs for piers on springs
          events        t, kind, pivot, before, after: the columns of Response.events
          restraints    elongation and force of each device, if any: Response.restraints
          ledger        the terms of the energy ledger, if requested
          forces        the columns of Response.forces, if requested
          impacts       the columns of Response.impacts, with forces

Every numeric dataset has an attribute ``unit``; "1" is dimensionless. The file begins with an HDF5 user block that holds the
digest of the rest, which is checked first: HDF5 can crash the process on a damaged file.
"""

import hashlib
import io
import json
import math
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, fields, replace
from functools import cached_property
from pathlib import Path
from shutil import disk_usage
from typing import Any, overload

import numpy as np

from rockbatch.common.errors import InputError
from rockbatch.common.files import FULL, opened, replacing, state_of
from rockbatch.common.lazy import h5py, pd
from rockbatch.outcome.outcome import TERMS
from rockbatch.outcome.response import FORCE_UNITS, HISTORY_UNITS, IMPACT_UNITS, Response
from rockbatch.pier import (
    Base,
    Part,
    Pier,
    places,
    restraint_of,
    vertical_frequency,
)
from rockbatch.pier.bases import BASES
from rockbatch.pier.restraints import DEVICE
from rockbatch.pier.sizes import USUAL as PIERS
from rockbatch.pier.traits import USUAL as OF_BASES
from rockbatch.quantities.demands import FORCES
from rockbatch.results.columns import StudyRun
from rockbatch.results.hdf5 import array_in, attribute, attributes_of, group_in
from rockbatch.results.labelled import Item

HISTORIES = "histories.h5"
"""File of the kept histories, beside peaks.csv."""

FORMAT = "rockbatch histories"

BLOCK = 512
"""Size of the user block before the HDF5 data [bytes]."""

MARK = b"rockbatch histories: HDF5 from byte 512 on, of sha256 "

MARGIN = 10_000_000
"""Free disk space that writing leaves [bytes]."""

OF_SPRINGS = ("v", "z_left", "z_right", "v_left", "v_right", "force_left", "force_right")
"""Columns of a history of piers on springs or a footing only."""

OF_TWO_SPRINGS = ("z_left", "z_right")
"""Those of :data:`OF_SPRINGS` that piers on a footing lack."""


def columns_of(base: Base | type[Base], bends: bool) -> list[str]:
    """Return the columns of a history of a pier on ``base``, without those of springs or of the shaft that do not apply."""
    lacking = () if base.two_springs else OF_TWO_SPRINGS if base.on_springs else OF_SPRINGS
    return [name for name in HISTORY_UNITS if name not in lacking and (bends or name != "deflection")]


LEDGER = "energy_input_J_kg"
"""Column of peaks.csv that is filled for runs with an energy ledger."""

BYTES_OF_A_DATASET = 2500.0
"""Overhead of a dataset in HDF5, including its share of the groups [bytes]."""

BYTES_OF_AN_EVENT = 56.0
"""Size of an event in the file [bytes]: three numbers and two words."""

_EVENTS = {"t": "f", "kind": "S", "pivot": "S", "before": "i", "after": "i"}
_IMPACTS = {"t": "f", "pivot": "S"} | dict.fromkeys(IMPACT_UNITS, "f")
_BESIDE = {"restraints": (), "ledger": TERMS, "forces": tuple(FORCE_UNITS)}
"""Optional tables with a row for each row of the history: their columns by HDF5 group, () for those present."""

_OF_RUN = ("record", "case", "polarity", "scale", "status")
_DAMAGE = (OSError, KeyError, ValueError, TypeError, RuntimeError, AttributeError, OverflowError)
"""Exceptions raised while reading a damaged file."""


class _NotTheseError(InputError):
    """The file is intact but has no histories, or those of another run."""


def write(path: Path, responses: Iterable[Response], info: Item) -> None:
    """Write ``responses`` to ``path`` one by one, completely or not at all; ``info`` is the content of ``run.json``.

    Raises ``InputError`` if the disk is full.
    """
    with replacing(path) as temporary:
        tried = _check_room(path, temporary, MARGIN)
        with h5py.File(temporary, "w", userblock_size=BLOCK) as file:
            study = info["study"]
            attributes = {"format": FORMAT, "rockbatch": info["rockbatch"], "created": info["created"]}
            _set(file, attributes | {"title": study["title"], "study": study["text"], "sha256": study["sha256"]})
            _set(file.create_group("versions"), info["versions"] | {"hdf5": h5py.version.hdf5_version})
            runs = file.create_group("runs")
            for number, response in enumerate(responses):
                tried = _check_room(path, temporary, MARGIN + _size_of(response), tried)
                _write(runs.create_group(_group_name(number)), response)
                file.flush()  # HDF5 reports failed writes on a flush, but not when it closes a dataset
        seal(temporary)


def seal(path: Path) -> None:
    """Write the digest of a histories file into its user block."""
    with opened(path, "r+b") as file:
        digest = _digest(file)
        file.seek(0)
        file.write(MARK + digest)


def _digest(file: io.FileIO) -> bytes:
    file.seek(BLOCK)
    return hashlib.file_digest(file, "sha256").hexdigest().encode()


def _check_room(path: Path, temporary: Path, needed: int, tried: int = 0) -> int:
    """Raise ``InputError`` or ``OSError`` if a file of ``path``'s folder, ``temporary``, cannot grow by ``needed`` [bytes].

    HDF5 may crash at exit after a failed write, and so is given room that leaves MARGIN, 10 MB. The free space of a disk does
    not tell a quota, nor a limit on the size of files: they refuse to grow the file, which then has its size again. Returns the
    size to which it could grow. A file system that cannot give room is written to instead, and so it is not tried again while
    all but half of MARGIN lies below the size ``tried``.
    """
    free = disk_usage(path.parent).free
    if free < needed:
        raise InputError(
            f"{path}: the disk is full, {free / 1e6:.0f} MB are left; make room, or keep fewer histories with [output] "
            'histories = "worst" or "none"'
        )
    size = temporary.stat().st_size
    if not hasattr(os, "posix_fallocate") or size + needed - MARGIN // 2 <= tried:  # macOS and Windows lack it
        return tried
    with opened(temporary, "r+b") as file:
        try:
            os.posix_fallocate(file.fileno(), size, needed)
        except OSError as error:
            if error.errno in FULL:
                raise
        finally:
            file.truncate(size)
    return size + needed


def _size_of(response: Response) -> int:
    """Return the size of the tables of a response [bytes]."""
    tables = (getattr(response, name) for name in ("history", "events", "impacts", *_BESIDE))
    return sum(int(table.memory_usage().sum()) for table in tables if table is not None)


def _group_name(number: int) -> str:
    return f"{number:06d}"


def _write(group: "h5py.Group", response: Response) -> None:
    """Write a response into its group."""
    _set(group, {name: getattr(response, name) for name in _OF_RUN})
    _set(group.create_group("varied"), response.columns)
    parts = json.dumps(response.pier.parts) if response.pier.parts else None
    _set(group.create_group("pier"), asdict(response.pier) | {"parts": parts, "confirm": None})
    base = {"name": response.base.name} | asdict(response.base) | {"confirm": None}
    base["restraints"] = json.dumps([asdict(device) | {DEVICE: device.what} for device in response.base.restraints])
    if "backbone" in base:
        base["backbone"] = json.dumps(base["backbone"]) if base["backbone"] else None
    _set(group.create_group("base"), base)
    _write_all(group, response.history, columns_of(response.base, response.base.bends))
    _write_all(group.create_group("events"), response.events, _EVENTS)
    if response.impacts is not None:
        _write_all(group.create_group("impacts"), response.impacts, _IMPACTS)
    for name, columns in _BESIDE.items():
        if (table := getattr(response, name)) is not None:
            _write_all(group.create_group(name), table, columns or table.columns.drop("t"))


def _write_all(group: "h5py.Group", table: "pd.DataFrame", columns: Iterable[str]) -> None:
    """Write columns of a table: "kind" and "pivot" as texts of at most 16 bytes, others as numbers with their unit."""
    units = table.attrs["units"]
    for name in columns:
        if name in ("kind", "pivot"):
            group[name] = np.array(table[name], dtype="S16")
        else:
            group.create_dataset(name, data=table[name].to_numpy()).attrs["unit"] = units.get(name, "1")


def _set(group: "h5py.Group", values: Mapping[str, object]) -> None:
    """Set the attributes of a group, with characters escaped that HDF5 cannot store; None is left out."""
    for name, value in values.items():
        if value is not None:
            group.attrs[name] = _legible(value) if isinstance(value, str) else value


def _legible(text: str) -> str:
    """Escape the characters that HDF5 cannot store: NUL, and bytes of file names that are not Unicode."""
    return text.encode(errors="backslashreplace").decode().replace("\0", "\\x00")


class Responses(Sequence[Response]):
    """The responses in a ``histories.h5``, each read on access; empty without a file.

    Access raises ``InputError`` if the file is damaged, is something else, or does not belong to ``info``, the content of
    ``run.json``. Each response gets its row of ``peaks``, if given.
    """

    def __init__(self, path: Path, info: Item, peaks: "pd.DataFrame | None" = None) -> None:
        self.path = path
        self._info = info
        self._peaks = peaks
        self._intact: tuple[int, ...] = ()

    @cached_property
    def runs(self) -> "pd.DataFrame":
        """Table of the runs: record, case, polarity, scale, status and varied keys, NaN if a key does not apply.

        No history is read for it; it has no rows if there is no file.
        """
        rows = []
        if self.path.exists() or self.path.is_symlink():
            with self._opened() as runs:
                groups = [group_in(runs, _group_name(number)) for number in range(len(runs))]
                rows = [_run(group) | attributes_of(group_in(group, "varied")) for group in groups]
        return pd.DataFrame(rows, columns=[*_OF_RUN, *self._info["varied"]])

    def __len__(self) -> int:
        return len(self.runs)

    @overload
    def __getitem__(self, which: int) -> Response: ...
    @overload
    def __getitem__(self, which: slice) -> list[Response]: ...
    def __getitem__(self, which: int | slice) -> Response | list[Response]:
        if isinstance(which, slice):
            return [self[number] for number in range(*which.indices(len(self)))]
        number = range(len(self))[which]  # raises IndexError, as any sequence
        (response,) = self.without_rows([number])
        return response if self._peaks is None else replace(response, row=_row_of(response, self._peaks))

    def without_rows(self, numbers: Iterable[int]) -> Iterator[Response]:
        """Yield the responses with these ``numbers`` without their rows of ``peaks``; the file is opened once."""
        with self._opened() as runs:
            for number in numbers:
                yield _read(group_in(runs, _group_name(number)))

    @contextmanager
    def _opened(self) -> Iterator["h5py.Group"]:
        """Yield the group of runs; turn errors of reading into ``InputError``."""
        with opened(self.path) as plain:
            self._check_digest(plain)
            try:
                with h5py.File(plain, "r") as file:
                    self._check(file)
                    yield group_in(file, "runs")
            except _NotTheseError:
                raise
            except _DAMAGE as error:
                raise InputError(f"{self.path}: damaged ({error}); start `rockbatch run` again") from error

    def _check_digest(self, plain: io.FileIO) -> None:
        """Raise ``InputError`` if bytes were changed; accept a file without a digest, or found intact and unchanged since."""
        if (state := state_of(os.fstat(plain.fileno()))) != self._intact:
            head = plain.read(BLOCK)
            if head.startswith(MARK) and head[len(MARK) :].rstrip(b"\0") != _digest(plain):
                raise InputError(f"{self.path}: damaged (not the bytes that were written); start `rockbatch run` again")
            self._intact = state
            plain.seek(0)

    def _check(self, file: "h5py.File") -> None:
        """Raise ``InputError`` unless the file holds the histories of the run in ``info``."""
        if attribute(file, "format") != FORMAT:
            raise _NotTheseError(f"{self.path}: not the histories of a study; start `rockbatch run` again")
        created = attribute(file, "created")
        if (created, attribute(file, "sha256")) != (self._info["created"], self._info["study"]["sha256"]):
            raise _NotTheseError(
                f"{self.path}: written on {created}, by another run than run.json ({self._info['created']}); start "
                "`rockbatch run` again"
            )


def _read(group: "h5py.Group") -> Response:
    """Read a response from its group; raise ``ValueError`` for inconsistent data."""
    base = attributes_of(group_in(group, "base"))
    kind = BASES[base.pop("name")]
    if "restraints" in base:
        base["restraints"] = tuple(map(restraint_of, json.loads(base["restraints"])))
    if "backbone" in base:
        base["backbone"] = tuple(map(tuple, json.loads(base["backbone"])))
    pier = attributes_of(group_in(group, "pier"))
    if "parts" in pier:
        pier["parts"] = tuple(Part(*part) for part in json.loads(pier["parts"]))
    t = array_in(group, "t", "f")
    if not len(t) or np.isnan(t).any() or (np.diff(t) < 0).any():
        raise ValueError("t is no rising time")
    bends = base.get("shaft") == "elastic"
    history = _table(group, dict.fromkeys(columns_of(kind, bends), "f"), len(t))
    events = _table(group_in(group, "events"), _EVENTS)
    places = events[["before", "after"]].to_numpy()
    if ((places < 0) | (places >= len(t))).any():
        raise ValueError("an event is beyond the end of the history")
    # Earlier versions stopped at flight on rigid ground, where ``flight`` could not be chosen
    before = {"flight": "stop"} if "flight" in {field.name for field in fields(kind)} else {}
    tables: dict[str, Any] = {}
    for name, columns in _BESIDE.items():
        if name in group:
            datasets = group_in(group, name)
            # Files of earlier versions lack the base moment
            present = [column for column in columns or datasets if column in datasets or column != "base_moment"]
            tables[name] = _table(datasets, dict.fromkeys(present, "f"), len(t))
            tables[name].insert(0, "t", t)
    if "forces" in group:
        tables["impacts"] = _table(group_in(group, "impacts"), _IMPACTS)
    return Response(
        **_run(group),
        columns=attributes_of(group_in(group, "varied")),
        pier=Pier(**pier, confirm=tuple(PIERS)),
        base=kind(**before | base, confirm=tuple(OF_BASES)),
        history=history.reindex(columns=[name for name in HISTORY_UNITS if bends or name != "deflection"]),
        events=events,
        **tables,
    )


def _table(group: "h5py.Group", kinds: Mapping[str, str], rows: int | None = None) -> "pd.DataFrame":
    """Read columns by their kinds into a table of ``rows``, by default as many as the group's ``t`` has.

    Only ``friction`` may hold values that are not finite.
    """
    rows = len(array_in(group, "t", "f")) if rows is None else rows
    columns = {name: array_in(group, name, kind, rows, finite=name != "friction") for name, kind in kinds.items()}
    return pd.DataFrame(columns)


def _row_of(response: Response, peaks: "pd.DataFrame") -> "pd.Series | None":
    """Return the first row of ``peaks`` with the response's identity, numbers compared to ten digits; None if there is none."""
    names = {name: getattr(response, name) for name in ("record", "case", "polarity", "scale")} | response.columns
    matches = np.ones(len(peaks), dtype=bool)
    for name, value in names.items():
        stored = float(f"{value:.10g}") if isinstance(value, float) else value
        matches &= (peaks[name] == stored).to_numpy(bool, na_value=False)
    return peaks.iloc[int(matches.argmax())].rename(response.record) if matches.any() else None


def _run(group: "h5py.Group") -> dict[str, Any]:
    """Return the identity and status of a run; raise ``ValueError`` unless ``scale`` is a float and the rest are texts."""
    names = {name: attribute(group, name) for name in _OF_RUN}
    for name, value in names.items():
        if not isinstance(value, float if name == "scale" else str):
            raise ValueError(f"the attribute {name} is missing, or of another kind")
    return names


def history_bytes(run: StudyRun, row: "Item | pd.Series") -> float:
    """Estimate the size of a run's history on disk [bytes], at most a third too large.

    Each column takes eight bytes for each sample and for each side of an event, and :data:`BYTES_OF_A_DATASET`.
    """
    pier, base = run.case.pier, run.case.base
    columns = len(columns_of(base, base.bends))
    columns += 2 * sum(len(places(pier, device)) for device in base.restraints)  # elongations and forces
    if has_value(row, LEDGER):
        columns += len(TERMS)
    if has_value(row, FORCES):
        columns += len(FORCE_UNITS)
    # Both springs, if they yield in every cycle, change their branch twice a period of the vibration
    reversals = 2.0 * vertical_frequency(pier, base) / math.pi if base.ratchets else 0.0  # a second
    events = row["impacts"] + row["separations"] + reversals * row["t_end_s"]
    rows = row["t_end_s"] / run.record.dt + 2.0 * events
    return columns * (BYTES_OF_A_DATASET + 8.0 * rows) + BYTES_OF_AN_EVENT * events


def has_value(row: "Item | pd.Series", column: str) -> bool:
    """Return whether a row has a number in an optional column: False if not requested, or if the run was too long for it."""
    value = row.get(column)
    return value is not None and value == value
