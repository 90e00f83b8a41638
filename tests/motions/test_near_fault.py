"""The records that come with rockbatch are whole, licensed, and run."""

from pathlib import Path

import numpy as np
import pytest

import rockbatch as rb
from rockbatch.motions.spectrum import PERIODS, spectral_acceleration

ROOT = Path(__file__).parents[2]
RECORDS = ROOT / "motions" / "near_fault"


def test_every_station_has_two_horizontal_components_and_a_vertical_one():
    motions = rb.read_motions(RECORDS)
    assert not motions.unusable
    assert len(motions.motions) == 10
    assert all(motion.vertical is not None for motion in motions.motions)


@pytest.mark.parametrize(
    ("folder", "horizontal_g", "vertical_g"),
    [
        ("kaikoura2016_wtmc", (0.99, 0.81), 1.84),
        ("kaikoura2016_hses", (0.24, 0.26), 0.16),
        ("christchurch2016_nblc", (0.19, 0.18), 0.34),
        ("christchurch2016_prpc", (0.28, 0.22), 0.23),
        ("imperialvalley1979_meloland", (0.31, 0.30), 0.23),
    ],
)
def test_peak_accelerations_are_those_that_their_agencies_state(folder, horizontal_g, vertical_g):
    motions = rb.read_motions(RECORDS / folder).motions
    assert sorted(motion.pga / 9.81 for motion in motions) == pytest.approx(sorted(horizontal_g), abs=0.006)
    assert {round(motion.pga_vertical / 9.81, 2) for motion in motions} == {vertical_g}


def test_every_folder_of_records_is_named_with_its_licence():
    page = (RECORDS / "README.md").read_text()
    folders = [path.name for path in RECORDS.iterdir() if path.is_dir()]
    rows = {line.split("|")[1].strip(" `"): line.split("|")[-2].strip() for line in page.splitlines() if "| `" in line}
    assert sorted(rows) == sorted(folders)
    assert set(rows.values()) == {"A", "B"}
    assert "CC BY 3.0 NZ" in page
    assert "We acknowledge the New Zealand GeoNet project and its sponsors EQC, GNS Science and LINZ." in page


def test_the_study_of_the_near_fault_records_is_ten_records_on_six_cases():
    study = rb.load_study(ROOT / "configs" / "near_fault.toml")
    assert len(study.cases) == 6
    assert len(rb.read_motions(study.motions.paths[0]).motions) == 10


def test_spectra_are_drawn_through_enough_periods_to_follow_the_record():
    """Straight lines between the periods, against ten times as many, in pixels of the report's picture (260 px high)."""
    fine = np.geomspace(PERIODS[0], PERIODS[-1], 10 * (len(PERIODS) - 1) + 1)
    for motion in list(rb.read_motions(RECORDS))[::10]:
        drawn, true = (np.log(spectral_acceleration(motion.horizontal, motion.dt, at)) for at in (PERIODS, fine))
        height = 260 / (true.max() - true.min())
        off = height * np.abs(np.interp(np.log(fine), np.log(PERIODS), drawn) - true)
        assert np.percentile(off, 95) < 4
        assert np.median(off) < 1
