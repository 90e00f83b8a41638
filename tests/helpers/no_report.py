"""A short page instead of the report, for tests of which it is not the subject: it takes longer than their runs."""

from pathlib import Path
from typing import Any

import pytest

from rockbatch.reporting import REPORT


def _written(directory: Path, **_: Any) -> Path:
    path = directory / REPORT
    path.write_text((directory / "run.json").read_text(encoding="utf-8"), encoding="utf-8")
    return path


@pytest.fixture
def no_report(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let ``rockbatch run`` and ``rockbatch check`` write run.json once more in place of their report."""
    for module in ("workflow.running", "commands.check"):
        monkeypatch.setattr(f"rockbatch.{module}.write_report", _written)
