"""Rules of checks, in files and beside results that meet them."""

from pathlib import Path

import pytest
from check_samples import case, folder, runs
from studies import PADS, SINE, study_text

CONFIGS = Path(__file__).parents[2] / "configs"


MARGIN = """
[[check]]
name = "margin"
demand = "theta_max_over_alpha"
at_most = 0.5
basis = "code"
reason = "clause 7"
"""


FLIGHT = """
[[check]]
name = "no flight"
demand = "flight"
at_most = 0
reason = "no keys"
"""


STUDY = study_text(pulses=(SINE | {"amplitude_g": 0.6, "duration_s": 1.0},), cases=(PADS | {"beta": [50, 60]},))


def rules_file(path, text):
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture
def passing(tmp_path):
    return folder(tmp_path / "out", runs([0.1, 0.4], theta_max_error=1e-5), [case()], MARGIN + FLIGHT)
