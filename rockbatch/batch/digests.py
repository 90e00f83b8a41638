"""Digests of everything that rows depend on; earlier rows count if all digests agree."""

import hashlib
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path

from rockbatch.batch.observers import observers_of
from rockbatch.motions import Motion, MotionSet
from rockbatch.motions.description import digest
from rockbatch.simulation import core_digest
from rockbatch.study import Study

SHOW = ("commands", "terminal", "reporting", "__init__.py", "__main__.py", "common/version.py")
"""Packages and modules that only display rows; all others influence rows or the choice of runs."""

OF_SLICES = ("command.py", "section.py", "figure.py", "summary.py")
"""Modules of analyses and observers that only display rows."""

_TOP = Path(__file__).parents[1]


def digests(motions: Iterable[Motion], **settings: object) -> dict[str, str]:
    """Return digests of 16 digits for a :class:`Journal` by name: "motions", "program", and each setting, by its ``repr``."""
    hashes = {name: hashlib.sha256(repr(value).encode()) for name, value in settings.items()}
    hashes["motions"] = hashlib.sha256()
    for motion in motions:
        hashes["motions"].update(repr((motion.name, motion.station, digest(motion))).encode())
    return {name: hashed.hexdigest()[:16] for name, hashed in hashes.items()} | {"program": program()}


def study_digests(study: Study, motions: MotionSet) -> dict[str, str]:
    """Return digests of the parts of a study that its rows depend on: not its title, checks or comments."""
    return digests(
        motions.motions,
        cases=study.cases,
        scales=(study.motions.polarity, study.motions.scale),
        numerics=(study.numerics, observers_of(study.output)),
    )


def sources() -> Iterator[Path]:
    """Yield the modules that can influence a row, in a fixed order: all but :data:`SHOW`, and :data:`OF_SLICES` of slices."""
    for path in sorted(_TOP.rglob("*.py")):
        module = path.relative_to(_TOP)
        shows = module.parts[0] in SHOW or module.as_posix() in SHOW
        if not shows and not (module.parts[0] in ("analyses", "observers") and module.name in OF_SLICES):
            yield path


@cache
def program() -> str:
    """Return a digest of the modules that can influence a row, and of the compiler."""
    digest = hashlib.sha256(core_digest().encode())
    for path in sources():
        digest.update(path.relative_to(_TOP).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]
