"""Write a version, and today's date, into every file that states one: `python docs/packaging/set_version.py 1.0.0`."""

import re
import sys
from datetime import date
from pathlib import Path

ROOT = Path(__file__).parents[2]
PLACES = (
    ("rockbatch/common/version.py", r'(?<=__version__ = ").+(?=")', "{version}"),
    ("docs/packaging/meta.yaml", r'(?<=set version = ").+(?=")', "{version}"),
    ("CITATION.cff", r"^version: .+(\ndate-released: .+)?", "version: {version}\ndate-released: {today}"),
    ("CHANGELOG.md", r"^## [\d.]+ \(not yet released\)", "## {version} ({today})"),
)
"""File, pattern and what takes its place."""


def set_version(root: Path, version: str, today: date) -> None:
    """Write a version and a date into the files below a folder; refuse a file that has no place for it."""
    texts = {}
    for name, pattern, new in PLACES:
        text = (root / name).read_text(encoding="utf-8")
        texts[name], count = re.subn(pattern, new.format(version=version, today=today), text, flags=re.MULTILINE)
        if count != 1:
            sys.exit(f"{name}: found {count} places for the version instead of one ({pattern}); nothing was written")
    for name, text in texts.items():
        (root / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2 or not re.fullmatch(r"\d+\.\d+\.\d+", sys.argv[1]):
        sys.exit(__doc__)
    set_version(ROOT, sys.argv[1], date.today())
