"""The sections of what other commands than ``rockbatch run`` found about a study."""

from pathlib import Path

from rockbatch.report.document import Section
from rockbatch.report.sections import fragility, sensitivity, spectrum


def sections(directory: Path, sha256: str | None) -> list[Section]:
    """A section for each analysis in the folder that is of the study with the digest ``sha256``; empty for others."""
    return [
        Section("Fragility", "fragility", fragility.section(directory, sha256)),
        Section("Rocking spectra and overturning", "spectrum", spectrum.section(directory, sha256)),
        Section("What the answer hangs on", "sensitivity", sensitivity.section(directory, sha256)),
    ]
