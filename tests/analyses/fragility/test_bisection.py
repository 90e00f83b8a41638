"""The amplitude of overturning by bisection is that of the closed form."""

import math

import pytest
from fragility_samples import journal_of
from studies import study_text, write_study

from rockbatch.analyses.fragility.curves import assess
from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.batch.threads import Threads
from rockbatch.batch.waves import Waves
from rockbatch.study import load_study


@pytest.mark.parametrize(("shape", "first", "last", "amplitudes"), [
    ("half-sine", 3.289147, math.inf, [2.5, 4.5, 6.8, 7.5]),
    ("sine", 3.018600, 6.318071, [2.5, 4.5, 6.8, 7.5]),
    ("sine", 3.018600, 6.318071, [2.5, 6.8, 7.5]),
])  # fmt: skip
def test_the_amplitude_of_overturning_is_that_of_the_closed_form(tmp_path, shape, first, last, amplitudes):
    """Slender block, e = 0.9, ω_p/p = 5 (test_overturning): the one-sine's second safe window is 6.318–7.168.

    The level 6.8 is inside it: the first exceedance is found all the same, also where no level is in the window of overturning
    below, and that the block stands there is counted. Tolerance 1e-4, and as much for the pulse that is linear between 400
    samples a period.
    """
    alpha, period = 1e-4, 2 * math.pi / 5
    unit = math.tan(alpha)
    levels = [amplitude * unit for amplitude in amplitudes]
    text = study_text(
        pier={"alpha": alpha, "p": 1.0},
        pulses=[{"name": "pulse", "shape": shape, "amplitude_g": 1.0} | {"period_s": period, "dt_s": period / 400,
        "duration_s": period}], cases=({"base": "rigid", "restitution": 0.9},), numerics={"substeps": 1, "quiet_s": 0.0},
        fragility={"method": "ida", "measure": "PGA", "levels_g": levels, "tolerance": 1e-4},
    )  # fmt: skip
    path = write_study(tmp_path, text)
    study = load_study(path)
    spec = read_fragility(study)
    motions, journal = journal_of(study, spec, tmp_path)
    with journal:
        (curve,) = assess(study, spec, motions, Waves(study, journal, Threads(1)))
    ((_, found),) = curve.capacities
    assert found.decided.low / unit == pytest.approx(first, rel=2e-4)
    assert found.decided.high / unit == pytest.approx(first, rel=2e-4)
    assert found.returns == (1 if last < 6.8 else 0)
