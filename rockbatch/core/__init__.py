"""The physics: floats and arrays in SI units, compiled by Numba.

The core knows no files, units or tables. Its scalar functions (springs, equations, impact, events) take and return
plain numbers and tuples and allocate nothing, so that any integrator or target can share them.
"""

from contextlib import suppress

LEAST_MEMORY = 600_000_000
"""Address space [bytes] below which the compiler ends the process without a message."""

with suppress(ImportError):  # Windows has no such limits
    import resource

    _LIMIT = resource.getrlimit(resource.RLIMIT_AS)[0]
    if 0 <= _LIMIT < LEAST_MEMORY:
        raise MemoryError(
            f"the memory of this process is limited to {_LIMIT / 1e6:.0f} MB (ulimit -v, or a job's limit), and runs need "
            f"{LEAST_MEMORY / 1e6:.0f} MB at least: allow more"
        )
