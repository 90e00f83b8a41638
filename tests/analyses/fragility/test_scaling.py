"""Runs are scaled to the intensities of their levels."""

import numpy as np
import pytest
from fragility_samples import STRIPES, written

import rockbatch as rb
from rockbatch.analyses.fragility.curves import assess
from rockbatch.analyses.fragility.runs import ScaledRuns, intensities
from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.batch.plan import simulations
from rockbatch.common.errors import InputError
from rockbatch.motions.measures import pga, pgv
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions


@pytest.mark.parametrize(
    ("fragility", "measure"),
    [
        (STRIPES, lambda a: pga(a) / 9.81),
        ('measure = "PGV"\nlevels_m_s = [0.2, 0.6]', lambda a: pgv(a, 0.01)),
        ('measure = "Sa"\nperiod_s = 0.5\nlevels_g = [0.2, 0.6]', lambda a: spectral_acceleration(a, 0.01, [0.5])[0] / 9.81),
    ],
    ids=["PGA", "PGV", "Sa"],
)  # fmt: skip
def test_every_run_has_the_intensity_of_its_level(tmp_path, fragility, measure):
    study = load_study(written(tmp_path, fragility))
    spec = read_fragility(study)
    motions = ground_motions(study).motions
    seen = []

    def simulate(runs):
        assert isinstance(runs, ScaledRuns)
        for run, moved, point in zip(runs, simulations(runs), runs.points, strict=True):
            assert measure(moved.motion.horizontal) == pytest.approx(point.intensity, rel=1e-12)
            assert moved.motion.horizontal == pytest.approx(
                run.scale * run.record.horizontal * (1 if run.polarity == "+" else -1)
            )
            seen.append((run.record.name, run.polarity, point.intensity, run.case.name))
        raise StopIteration

    with pytest.raises(StopIteration):
        assess(study, spec, motions, simulate)
    assert len(set(seen)) == len(seen) == 5 * len(spec.levels) * 2
    assert {polarity for _, polarity, _, _ in seen} == {"+"}  # the other would be their mirror image


def test_a_motion_without_intensity_is_refused(tmp_path):
    study = load_study(written(tmp_path, STRIPES))
    still = rb.Motion("still", 0.01, np.zeros(10))
    with pytest.raises(InputError, match="still: its horizontal component has PGA = 0"):
        intensities([still], read_fragility(study), 9.81)
