"""The version of the package, and the commit of a checkout."""

from functools import cache
from pathlib import Path

__version__ = "0.1.0"

_TOP = Path(__file__).parents[2]


@cache
def commit() -> str:
    """Return the digest of the commit that runs, 12 digits, with "+" if any tracked file differs.

    "" outside of a checkout, or if Git cannot tell.
    """
    if not (_TOP / ".git").exists():
        return ""
    import subprocess  # a few milliseconds, for the two that ask

    described = ["git", "-C", str(_TOP), "describe", "--always", "--exclude=*", "--abbrev=12", "--dirty=+"]
    try:
        return subprocess.run(described, capture_output=True, text=True, timeout=10, check=True).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return ""


def full_version() -> str:
    """Return the version, and the commit in a checkout: "0.1.0 (1f2e3d4c5b6a)"."""
    return f"{__version__} ({commit()})" if commit() else __version__
