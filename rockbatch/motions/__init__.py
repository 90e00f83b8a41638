"""Ground motions: from files, packages and formulas to accelerations in m/s², their measures, spectra and scaling.

It stands alone: nothing here knows of a pier.
"""

from typing import TYPE_CHECKING

from rockbatch.common.lazy import loading

if TYPE_CHECKING:
    from rockbatch.common.errors import InputError
    from rockbatch.motions.baseline import Offset
    from rockbatch.motions.design_spectra import (
        EUROCODE,
        AashtoSpectrum,
        AsceSpectrum,
        EurocodeSpectrum,
        NzsSpectrum,
        TableSpectrum,
        read_spectrum,
    )
    from rockbatch.motions.folder import read_motions
    from rockbatch.motions.formats import ReadOptions
    from rockbatch.motions.hazard import HazardCurve
    from rockbatch.motions.manifest_draft import write_manifest
    from rockbatch.motions.measures import (
        arias_intensity,
        bracketed_duration,
        cumulative_absolute_velocity,
        displacement,
        pga,
        pgd,
        pgv,
        significant_duration,
        uniform_duration,
        velocity,
    )
    from rockbatch.motions.motion import LeftOut, Motion, Unusable
    from rockbatch.motions.motion_set import MotionSet
    from rockbatch.motions.pairs import pair_spectrum
    from rockbatch.motions.pulses import pulse
    from rockbatch.motions.scaling import Target, at_target
    from rockbatch.motions.selection import Selection, selected
    from rockbatch.motions.sequences import sequence
    from rockbatch.motions.spectrum import spectral_acceleration
    from rockbatch.motions.spectrum_target import SpectrumTarget
    from rockbatch.motions.velocity_pulses import VelocityPulse, pulse_of

_NAMES = {
    "baseline": "Offset",
    "design_spectra": "EUROCODE AashtoSpectrum AsceSpectrum EurocodeSpectrum NzsSpectrum TableSpectrum read_spectrum",
    "folder": "read_motions",
    "formats": "ReadOptions",
    "hazard": "HazardCurve",
    "manifest_draft": "write_manifest",
    "measures": "arias_intensity bracketed_duration cumulative_absolute_velocity displacement pga pgd pgv significant_duration "
    "uniform_duration velocity",
    "motion": "LeftOut Motion Unusable",
    "motion_set": "MotionSet",
    "pairs": "pair_spectrum",
    "pulses": "pulse",
    "scaling": "Target at_target",
    "selection": "Selection selected",
    "sequences": "sequence",
    "spectrum": "spectral_acceleration",
    "spectrum_target": "SpectrumTarget",
    "velocity_pulses": "VelocityPulse pulse_of",
}
_HOMES = {name: f"{__name__}.{home}" for home, names in _NAMES.items() for name in names.split()} | {
    "InputError": "rockbatch.common.errors"
}

__all__ = [
    "EUROCODE",
    "AashtoSpectrum",
    "AsceSpectrum",
    "EurocodeSpectrum",
    "HazardCurve",
    "InputError",
    "LeftOut",
    "Motion",
    "MotionSet",
    "NzsSpectrum",
    "Offset",
    "ReadOptions",
    "Selection",
    "SpectrumTarget",
    "TableSpectrum",
    "Target",
    "Unusable",
    "VelocityPulse",
    "arias_intensity",
    "at_target",
    "bracketed_duration",
    "cumulative_absolute_velocity",
    "displacement",
    "pair_spectrum",
    "pga",
    "pgd",
    "pgv",
    "pulse",
    "pulse_of",
    "read_motions",
    "read_spectrum",
    "selected",
    "sequence",
    "significant_duration",
    "spectral_acceleration",
    "uniform_duration",
    "velocity",
    "write_manifest",
]

__getattr__ = loading(__name__, _HOMES)


def __dir__() -> list[str]:
    return __all__
