"""Names of records, cases and checks decide nothing: others change nothing but themselves, in whatever table or sentence."""

import re
from pathlib import Path

import pytest
from studies import RIGID, SINE, study_text

import rockbatch as rb

pytestmark = pytest.mark.usefixtures("pages")

WHAT = ["weak", "strong", "similar", "alike", "rock", "pads", "hard pads", "tied", "rotation", "uplift", "standing"]
PULSES = {"weak": (0.3, 0.8), "strong": (0.9, 1.2), "similar": (0.31, 0.8), "alike": (0.31, 0.79)}
"""Amplitude [g] and period [s] by name."""
OF_THE_RUN = re.compile(r"\b[0-9a-f]{12,}\b|\d{4}-\d\d-\d\d[T ][\d:]+(\+00:00)?|(?<=took )[\d.]+ s")
"""Digests and times."""
ELASTIC = {"base": "elastic", "beta": 40.0}
FRICTION = {"kind": "friction", "f": 0.05}


def results(folder: Path, letters: str) -> dict[str, str]:
    """Return the tables and the page of a study whose names begin with these letters, each name as what it is the name of."""
    names = {what: f"{letter}{number:02}-name" for number, (letter, what) in enumerate(zip(letters, WHAT, strict=True))}
    pulses = [SINE | {"name": names[what], "amplitude_g": g, "period_s": s} for what, (g, s) in PULSES.items()]
    cases = [RIGID, ELASTIC, ELASTIC | {"epsilon": 0.2}, RIGID | {"damper": [FRICTION]}]
    limit = {"demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "agreed"}
    checks = [
        limit, limit | {"demand": "heel_uplift_m", "at_most": 0.1, "case": [names["pads"], names["hard pads"]]},
        limit | {"demand": "overturned", "at_most": 0},
    ]  # fmt: skip
    text = study_text(
        title="names", pier={"width_m": 4.0, "height_m": 20.0, "mass_t": 900.0}, motions={"polarity": ["+", "-"]},
        pulses=[one | {"duration_s": 1.6} for one in pulses], numerics={"tolerance": 1e-3, "quiet_s": 0.5},
        cases=[case | {"name": names[what]} for case, what in zip(cases, WHAT[4:8], strict=True)], output={"intensity": True},
        check=[check | {"name": names[what]} for check, what in zip(checks, WHAT[8:], strict=True)],
    )  # fmt: skip
    rb.run(rb.Study.from_toml(text), folder, jobs=1, progress=False)
    found = {}
    for path in (*folder.glob("*.csv"), folder / "report.html"):
        found[path.name] = OF_THE_RUN.sub("", path.read_text(encoding="utf-8").replace(str(folder), ""))
        for what, name in names.items():
            found[path.name] = found[path.name].replace(name, what)
    return found


def test_other_names_change_nothing_but_themselves(tmp_path):
    ascending, descending = (results(tmp_path / letters, letters) for letters in ("abcdefghijk", "zyxwvutsrqp"))
    assert ascending.keys() == {"peaks.csv", "checks.csv", "intensity.csv", "report.html"}
    for name, text in ascending.items():
        assert text.splitlines() == descending[name].splitlines(), name
