"""half_cycles.csv, which a study asks for: what Response.half_cycles has of each run."""

import pandas as pd
from studies import study_text, write_study

import rockbatch as rb
from rockbatch.common.files import read_table
from rockbatch.observers.half_cycles import TABLE as HALF_CYCLES
from rockbatch.outcome.half_cycles import HALF_CYCLE_COLUMNS
from rockbatch.study.output import OUTPUT

PIER = {"width_m": 0.3, "height_m": 1.2, "initial_rotation_rad": [0.05, 0.1]}


def test_a_study_that_asks_has_the_half_cycles_of_every_run(tmp_path):
    cases = [{"name": "rigid", "base": "rigid"}]
    text = study_text(pier=PIER, motions={"still_s": 2.0}, pulses=(), cases=cases, output={"half_cycles": True})
    study = rb.load_study(write_study(tmp_path, text))
    peaks = rb.run(study, tmp_path / "out")
    table = read_table(tmp_path / "out" / HALF_CYCLES)
    for start, row in zip(PIER["initial_rotation_rad"], peaks.to_dict("records"), strict=True):
        own = table[table["initial_rotation_rad"] == start].reset_index(drop=True)
        motion, pier = rb.Motion.still(2.0), rb.Pier.rectangle(0.3, 1.2)
        response = rb.simulate(pier, rb.RigidBase(), motion, substeps=row["substeps"], initial_rotation_rad=start)
        expected = response.half_cycles.set_axis(list(HALF_CYCLE_COLUMNS), axis=1)
        pd.testing.assert_frame_equal(own[list(HALF_CYCLE_COLUMNS)], expected, rtol=1e-8, atol=1e-12)
        assert own["half_cycle"].tolist() == list(range(len(own)))
        release, impacts = own.iloc[0], own.iloc[1:]
        assert (release["t_s"], release["amplitude_rad"]) == (0.0, start)
        assert release[["omega_before_rad_s", "omega_after_rad_s", "apparent_restitution"]].isna().all()
        assert len(impacts) == row["impacts"]
        assert impacts[["omega_before_rad_s", "omega_after_rad_s"]].notna().all(axis=None)
    assert "half_cycle 0 begins with the run" in OUTPUT["half_cycles"].words
    rb.run(study.with_(output=None), tmp_path / "out")
    assert not (tmp_path / "out" / HALF_CYCLES).exists()
