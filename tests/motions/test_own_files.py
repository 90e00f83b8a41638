"""A folder of records that holds results of a study, too."""

import shutil
from dataclasses import replace

import numpy as np
import pytest
from motion_files import wiggle, write_at2
from studies import RIGID, study_text, write_study

import rockbatch as rb
from rockbatch.batch.journal import Journal
from rockbatch.commands.cli import main
from rockbatch.motions import read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.folder import read_files
from rockbatch.motions.identity.pairing import to_motions
from rockbatch.motions.sources.own_files import is_own

OUTPUT = {"histories": "all", "forces": True, "half_cycles": True, "intensity": True, "sections": 3}
CHECK = {"name": "upright", "reason": "test", "demand": "theta_max_over_alpha", "at_most": 0.9}
PARTS = {"width_m": 4.0, "part": [{"mass_t": 1000.0, "height_m": 10.0, "length_m": 20.0, "width_m": 3.0}]}


@pytest.fixture
def folder(tmp_path):
    """Two components of a station, and the study that runs them."""
    for seed, name in enumerate(("RSN7_A_B000", "RSN7_A_B090")):
        write_at2(tmp_path, f"{name}.AT2", wiggle(200, seed), title=f"Made-up, 1/17/1994, B, {name[8:]}")
    text = study_text(pier=PARTS, motions={"path": "."}, pulses=(), cases=(RIGID,), check=(CHECK,), output=OUTPUT)
    return write_study(tmp_path, text).parent


def test_a_study_beside_its_records_reads_no_results_when_it_is_run_again(folder):
    study = folder / "study.toml"
    assert main(["run", str(study), "--out", str(folder / "results")]) == 0
    before = {path.name: path.read_bytes() for path in (folder / "results").glob("*.csv")}
    assert len(before) >= 5
    assert main(["run", str(study), "--out", str(folder / "results"), "--strict", "--fresh", "--csv", "semicolon"]) == 0
    after = {path.name: path.read_bytes() for path in (folder / "results").glob("*.csv")}
    assert {name: after[name] for name in before} == before
    for copied in (folder / "results").iterdir():  # singly, under other names, beside the records
        shutil.copy(copied, folder / f"copy_of_{copied.name}")
    found = read_motions(folder)
    assert [motion.name for motion in found] == ["RSN7_A_B000", "RSN7_A_B090"]
    assert not found.unusable


def test_a_journal_of_a_run_that_was_stopped_is_no_record(tmp_path):
    row = {"record": "a", "case": "b", "polarity": "+", "scale": 1.0, "status": "ok"}
    with Journal(tmp_path / "peaks.csv.part", [*row], {"cases": "5f1c", "motions": "09ab"}) as journal:
        journal.add_all({0: row})
    assert is_own(tmp_path / "peaks.csv.part")


@pytest.mark.parametrize("head", ["time,acc", "record,000,090,UP", "time,case 1,case 2", "scale,time,acc", "t_s;case"])
def test_a_table_of_samples_is_not_taken_for_a_result(tmp_path, head):
    path = tmp_path / "table.csv"
    path.write_text(f"{head}\n0,1,2\n")
    assert not is_own(path)


def test_tables_of_analyses_are_recognised_by_their_heads(tmp_path):
    heads = (
        "case,limit_state,at_most,median,dispersion", "case,parameter,swing", "map,case,omega_p_over_p,outcome",
        "method,runs,machine,study", "case,impact,t_measured_s", "\ufeffcase;t_s;theta_rad", "record,file_h,file_v,dt_s",
    )  # fmt: skip
    for number, head in enumerate(heads):
        path = tmp_path / f"{number}.txt"
        path.write_text(f"{head}\n")
        assert is_own(path), head


def test_samples_of_all_components_are_checked_copied_and_frozen():
    samples = np.sin(np.arange(50) / 5.0)
    samples.flags.writeable = False
    motion = rb.Motion("m", 0.01, samples, vertical=samples, across=samples)
    samples.flags.writeable = True
    samples *= 9.0
    for component in (motion.horizontal, motion.vertical, motion.across):
        assert abs(component).max() <= 1.0
        with pytest.raises(ValueError, match="WRITEABLE"):
            component.flags.writeable = True
    for odd in (samples[:5], samples * np.nan, samples + 1j, "abc", [[1.0] * 50]):
        with pytest.raises(rb.InputError, match="across"):
            rb.Motion("m", 0.01, samples, across=odd)
    with pytest.raises(rb.InputError, match="dt"):
        rb.Motion("m", np.timedelta64(10, "ms"), samples)


def test_a_motion_shares_its_components_samples_and_copies_share_them_too(folder):
    components = [reading for reading in read_files([folder])[0] if isinstance(reading, Component)]
    motions = to_motions(components).motions
    for component, motion in zip(components, motions, strict=True):
        assert motion.horizontal is component.acceleration is replace(motion, notes=("read",)).horizontal
        with pytest.raises(ValueError, match="WRITEABLE"):
            component.acceleration.flags.writeable = True
