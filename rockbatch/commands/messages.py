"""What commands tell, on stderr."""

import sys
from threading import Timer
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockbatch.motions import MotionSet
    from rockbatch.study import Study


def say(text: str) -> None:
    """Print a message where it does not mix with what a command was asked for."""
    print(text, file=sys.stderr, flush=True)


def tell_motions(motions: "MotionSet") -> None:
    """Tell which files are not used, and how many nobody misses."""
    for file in motions.unusable:
        say(f"not used: {file.source}: {file.reason}")
    for one, other in _twice(motions):
        say(f"{one} and {other} are the same record: it counts twice; leave one out")
    if motions.without_vertical:
        say(f"no vertical: {', '.join(motions.without_vertical)}")
    if motions.left_out:
        say(f"{count(len(motions.left_out), 'file')} left out, or no records: `rockbatch motions` says why")


def _twice(motions: "MotionSet") -> list[tuple[str, str]]:
    """Names of motions with the same samples: the first, and each that repeats it."""
    first: dict[tuple[float, bytes], str] = {}
    pairs = []
    for motion in motions.motions:
        name = first.setdefault((motion.dt, motion.horizontal.tobytes()), motion.name)
        if name != motion.name:
            pairs.append((name, motion.name))
    return pairs


def once(study: "Study") -> str:
    """Why there are no more runs, where a study asks for both polarities."""
    return " (polarity: mirror images, counted once)" if len(study.motions.polarity) > 1 else ""


def make_ready(study: "Study") -> None:
    """Have the kernels loaded before the clock starts; where they must be compiled first, it takes a while and is told."""
    from rockbatch.batch.groups import compile_kernels

    words = "compiling the kernels (once for each kind of foundation, 20 to 30 s)"
    told = Timer(1.5, say, [words])  # to load them takes less
    told.start()
    try:
        compile_kernels(study)
    finally:
        told.cancel()


def count(n: int, noun: str) -> str:
    """A number of things: "1 run", "2 runs"."""
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"
