"""Runs are scaled to the intensities of their levels."""

from dataclasses import replace

import numpy as np
import pytest
from fragility_samples import STRIPES, written

import rockbatch as rb
from rockbatch.analyses.fragility.curves import assess
from rockbatch.analyses.fragility.runs import LevelPlan, ScaledRuns, intensities
from rockbatch.analyses.fragility.scale_factors import described_scales, scales
from rockbatch.analyses.fragility.study import read_fragility
from rockbatch.batch.plan import simulations
from rockbatch.common.errors import InputError
from rockbatch.motions.intensity.measures import pga, pgv
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


ALL = ({0.2: 0.2, 0.4: 0.4},) * 3
"""Three records at both levels, of 0.4, 0.2 and 0.1 g as they come: factors of 0.5, 1, 1, 2, 2 and 4."""


@pytest.mark.parametrize(
    ("used", "not_used", "settings", "words"),
    [
        (ALL, {}, {}, "records are scaled by 0.5 to 4 (median 1.5)"),
        (
            ({0.4: 0.4}, ALL[1], {0.2: 0.2}), ({0.2: 0.2}, {}, {0.4: 0.4}), {"least_scale": 0.75, "most_scale": 3.0},
            "records are scaled by 1 to 2 (median 1.5); factors 0.75 to 3 are allowed, which leaves 2 of 3 records at 0.2, "
            "2 of 3 records at 0.4 g",
        ),
        (
            (*ALL[:2], {0.2: 0.2}), ({}, {}, {0.4: 0.4}), {"most_scale": 3.0},
            "records are scaled by 0.5 to 2 (median 1); factors up to 3 are allowed, which leaves 2 of 3 records at 0.4 g",
        ),
        (
            ({0.2: 0.17, 0.4: 0.37}, {0.2: 0.22, 0.4: 0.4}, {0.2: 0.2}), {}, {},
            "records are scaled by 0.42 to 2 (median 1.1); the given factors bring records to intensities away from their "
            "levels, 0.17 to 0.22 at 0.2 g: is PGA the measure of the selection?",
        ),
        (
            ({0.2: 0.2, 0.4: 0.36}, {0.4: 0.451}, {}), {}, {},
            "records are scaled by 0.5 to 2.3 (median 0.9); the given factors bring records to intensities away from their "
            "levels, 0.36 to 0.451 at 0.4 g: is PGA the measure of the selection?",
        ),
        (({0.4: 0.4}, {0.2: 0.2}, {}), {}, {}, "records are taken as they were recorded"),
        (({0.4: 0.4}, {0.2: 0.2}, {0.1: 0.1}), {}, {"method": "cloud"}, "records are taken as they were recorded"),
        (({0.4: 0.4}, {0.4: 0.4}, {}), {}, {"method": "cloud"}, "records are scaled by 1 to 2 (median 1.5)"),
        (
            ({0.4: 0.4, 0.8: 0.8}, {0.2: 0.2}, {0.1: 0.1}), {}, {"method": "cloud"},
            "records are scaled by 1 to 2 (median 1); each counts once at every scale",
        ),
    ],
)  # fmt: skip
def test_the_factors_on_records_are_said_with_what_they_leave_and_miss(tmp_path, used, not_used, settings, words):
    spec = replace(read_fragility(load_study(written(tmp_path, STRIPES))), levels=(0.2, 0.4), **settings)
    plan = LevelPlan([0.4, 0.2, 0.1], [1.0] * 3, [*used], [*not_used] or [{}] * 3)
    assert described_scales([plan], spec, "abc")["said"] == words


def test_factors_are_those_on_the_recorded_motions_with_limits_where_there_are_any(tmp_path):
    """The study's target has halved a, of 0.8 g, and doubled c, of 0.2 g; 4 is more than is allowed on c."""
    study = load_study(written(tmp_path, STRIPES))
    spec = replace(read_fragility(study), levels=(0.2, 0.4, 0.8))
    plan = LevelPlan([0.4, 0.4], [0.5, 2.0], [{0.2: 0.2, 0.4: 0.4}, {0.2: 0.2, 0.4: 0.4}], [{}, {0.8: 0.8}], power=1.0)
    described = described_scales([plan], spec, ["a", "c"])
    assert described["records"] == ["a", "c"]
    assert described["factors"] == [[0.25, 0.5, None], [1.0, 2.0, 4.0]]
    assert described["used"] == [[True, True, False], [True, True, False]]
    assert described["limits"] == [None, None]
    for ends, limits in (((0.5, 2.0), [0.5, 2.0]), ((0.0, 2.0), [None, 2.0]), ((0.5, np.inf), [0.5, None])):
        limited = replace(spec, least_scale=ends[0], most_scale=ends[1])
        assert described_scales([plan], limited, ["a", "c"])["limits"] == limits
    table = scales([plan], spec, ["a", "c"], study.cases, ())
    assert table["record"].to_list() == ["a", "a", "c", "c", "c"]
    assert table["unscaled"].to_list() == [0.8, 0.8, 0.2, 0.2, 0.2]
    assert table["level"].to_list() == table["intensity"].to_list() == [0.2, 0.4, 0.2, 0.4, 0.8]
    assert (table["scale"] * table["unscaled"]).to_list() == pytest.approx(table["intensity"].to_list())
    assert table["used"].to_list() == [True] * 4 + [False]
    assert {*table["measure"], *table["unit"]} == {"PGA", "g"}
