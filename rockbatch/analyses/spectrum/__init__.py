"""Rocking spectra over size or intensity, and maps of the pulses that overturn."""

from rockbatch.common.analyses import Door
from rockbatch.common.slices import ReportPart

DOOR = Door(
    help="rocking spectra, and maps of the pulses that overturn",
    example="rockbatch spectrum pier.toml",
    writes="  spectrum.csv, spectrum_suite.csv, overturning_map.csv, overturning_runs.csv, as the study asks,\n"
    "  spectrum.json, and a section of report.html",
    parts=(ReportPart("Rocking spectra and overturning", "spectrum"),),
    tables=("spectrum",),
)
