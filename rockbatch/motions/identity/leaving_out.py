"""Records, files and stations that a study leaves out by name."""

from collections.abc import Iterable, Sequence
from pathlib import PurePosixPath

from rockbatch.common.errors import refuse
from rockbatch.common.grouping import closest
from rockbatch.common.naming import fits
from rockbatch.common.showing import shown
from rockbatch.motions.component import Component
from rockbatch.motions.identity.stations import station_of
from rockbatch.motions.motion import Motion
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.unused import LeftOut, Unusable

Reading = Component | Unusable | LeftOut


class LeaveOut:
    """Names and patterns to leave out; it remembers which of them matched, and all names, for messages."""

    def __init__(self, patterns: Sequence[str]) -> None:
        self._patterns = patterns
        self._matched: set[str] = set()
        self._names: dict[str, None] = {}

    def readings(self, readings: Iterable[Reading]) -> list[Reading]:
        """Return the readings of files, with those left out whose record, file, folder or station fits a pattern."""
        if not self._patterns:
            return list(readings)
        return [self._reading(reading) for reading in readings]

    def _reading(self, reading: Reading) -> Reading:
        """Return a reading, left out if a pattern fits any of its names."""
        stations = [reading.station]
        if isinstance(reading, Component):
            stations = [station_of(reading), reading.origin.station, reading.site]
        file = PurePosixPath(reading.file)
        folders = [str(folder) for folder in file.parents if folder.name]
        pattern = self._fitting(reading.name, *stations, str(file), file.name, file.stem, *folders)
        if not pattern or isinstance(reading, LeftOut):
            return reading
        return _left_out(reading.name, reading.sources, pattern, stations[0])

    def motions(self, motions: MotionSet) -> MotionSet:
        """Return the set with motions and unusable files moved to the left-out ones if their record or station fits a pattern."""
        if not self._patterns:
            return motions
        left_out: dict[int, LeftOut] = {}
        items: list[Motion | Unusable] = [*motions.motions, *motions.unusable]
        for item in items:
            station = item.of_station if isinstance(item, Motion) else item.station
            if pattern := self._fitting(item.name, station):
                left_out[id(item)] = _left_out(item.name, item.sources, pattern, station)
        used = [motion for motion in motions.motions if id(motion) not in left_out]
        unusable = [file for file in motions.unusable if id(file) not in left_out]
        return MotionSet(used, unusable, [*motions.left_out, *left_out.values()])

    def finish(self) -> None:
        """Raise ``InputError`` with every pattern that fitted nothing; return None if all did."""
        wrong = []
        for pattern in self._patterns:
            if pattern not in self._matched:
                nearest = closest(pattern, self._names)
                hint = f"; did you mean {shown(nearest)}?" if nearest else "; `rockbatch motions FOLDER` lists them"
                wrong.append(
                    f"[motions] leave_out: no record, file or station is called {shown(pattern)}, or matches it{hint}"
                )
        refuse(wrong)

    def _fitting(self, *names: str) -> str:
        """Return the first pattern that fits one of these names, and remember all that do; "" if none does."""
        self._names.update(dict.fromkeys(filter(None, names)))
        fitting = [pattern for pattern in self._patterns if any(fits(name, pattern) for name in names)]
        self._matched.update(fitting)
        return fitting[0] if fitting else ""


def _left_out(name: str, sources: tuple[str, ...], pattern: str, station: str) -> LeftOut:
    """Return a file that the study leaves out by ``pattern``, with the key leave_out as the reason."""
    return LeftOut(name, sources, f"leave_out = [{shown(pattern)}] in the study", station, named=True)
