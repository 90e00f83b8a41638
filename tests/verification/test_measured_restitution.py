"""Restitution as ElGawady et al. measured it, about 0.95 of Housner's on concrete and 0.67 on rubber, in a study."""

from pathlib import Path

import pytest

import rockbatch as rb

ROOT = Path(__file__).parents[2]
STUDY = ROOT / "configs" / "measured_restitution.toml"
RECORDS = {
    "Te Mara Farm, N28W": "20161113_110259_WTMC_20.N28W",
    "El Centro Highway 8, 270": "CHAN24",
    "El Centro Highway 8, 360": "CHAN15",
    "Hanmer Springs, N80W": "20161113_110300_HSES_20.N80W",
    "Pages Road, N00E": "20160214_001346_PRPC_20.N00E",
}


def test_study_has_the_measured_shares_of_housners_restitution():
    """A block of the aspect ratio 5; values in the file have three figures."""
    cases = rb.load_study(STUDY).cases
    housner = cases[0].pier.restitution
    assert housner == pytest.approx(1.0 - 1.5 / 26.0, rel=1e-12)  # sin² α = 1/26
    assert [round(case.base.restitution / housner, 2) for case in cases[1:]] == [0.95, 0.67]


def test_peaks_on_the_page_are_those_of_the_study():
    """The table of docs/pages/held_against_others.md, to its three decimals."""
    peaks = rb.run(STUDY).pivot(index="record", columns="case", values="theta_max_over_alpha")
    lines = (ROOT / "docs" / "pages" / "held_against_others.md").read_text(encoding="utf-8").splitlines()
    for name, record in RECORDS.items():
        printed = next(line for line in lines if line.startswith(f"| {name} |")).split("|")[2:5]
        found = [f"{peaks.loc[record, case]:.3f}" for case in ("Housner", "on concrete", "on rubber")]
        assert [value.strip() for value in printed] == found
