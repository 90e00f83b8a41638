"""The section on devices: what each of them has to be made for, case by case."""

import pytest
from report_page import Page
from studies import RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.reporting.finished import read
from rockbatch.reporting.sections import devices

PIER = {"width_m": 4.0, "height_m": 20.0, "mass_t": 1000.0}
PULSES = [SINE | {"name": name, "amplitude_g": share} for name, share in (("weak", 0.3), ("strong", 0.4))]
DAMPED = RIGID | {"name": "damped", "damper": [{"kind": "friction", "f": 0.05}]}
TIED = RIGID | {"name": "tied", "tendon": [{"psi": 0.1, "lambda": 0.1}]}


def section_of(folder, *cases):
    text = study_text(pier=PIER, pulses=PULSES, cases=cases, output={"devices_work": True, "histories": "none"})
    table = rb.run(write_study(folder, text), out=folder / "out")
    return table, Page(devices.section(read(folder / "out")))


@pytest.mark.slow
def test_the_greatest_of_every_record_is_beside_its_case(tmp_path):
    table, page = section_of(tmp_path, RIGID, DAMPED)
    heads, damped = page.tables[""]  # the case without devices has no row
    worst = table[table["case"] == "damped"].max(numeric_only=True)
    values = dict(zip(heads, damped, strict=True))
    assert values["damper work [kJ]"].replace(",", "") == f"{worst['damper_work_kJ']:.1f}"
    assert values["damper stroke [mm]"] == f"{1000 * worst['damper_stroke_m']:.1f}"
    assert values["half cycles"] == f"{worst['damper_half_cycles']:.0f}"


def test_devices_that_no_case_has_have_no_columns(tmp_path):
    _, page = section_of(tmp_path, RIGID, TIED)
    heads = page.tables[""][0]
    assert any("tendon" in head for head in heads)
    assert not any("damper" in head or "half cycles" in head for head in heads)
    (folder := tmp_path / "bare").mkdir()
    assert section_of(folder, RIGID)[1].tables == {}
