"""Ground motions: from files, packages and formulas to accelerations in m/s², their measures, spectra and scaling.

It stands alone: nothing here knows of a pier. A file becomes components (``sources``, ``formats``), which are judged (``labels``,
``quality``), put together as motions (``identity``, ``folder``), measured (``intensity``), and chosen and scaled (``suites``).
"""

from rockbatch.common.lazy import loading

_NAMES = {
    "quality.baseline": "Offset",
    "suites.design_spectra": "EUROCODE AashtoSpectrum AsceSpectrum EurocodeSpectrum NzsSpectrum TableSpectrum read_spectrum",
    "folder": "read_motions",
    "sources.record_file": "ReadOptions",
    "suites.hazard": "HazardCurve",
    "manifest_draft": "write_manifest",
    "intensity.measures": "arias_intensity bracketed_duration cumulative_absolute_velocity displacement pga pgd pgv "
    "significant_duration uniform_duration velocity",
    "motion": "Motion",
    "motion_set": "MotionSet",
    "intensity.pairs": "pair_spectrum",
    "suites.pulses": "pulse",
    "suites.scaling": "Target at_target",
    "suites.selection": "Selection selected",
    "suites.sequences": "sequence",
    "spectrum": "spectral_acceleration",
    "suites.spectrum_target": "SpectrumTarget",
    "unused": "LeftOut Unusable",
}
"""Public names by their modules; ``__init__.pyi`` has all of them for type checkers."""

_HOMES = {name: f"{__name__}.{home}" for home, names in _NAMES.items() for name in names.split()} | {
    "InputError": "rockbatch.common.errors"
}

__all__ = sorted(_HOMES)

__getattr__ = loading(__name__, _HOMES)


def __dir__() -> list[str]:
    return __all__
