"""The columns of peaks.csv stand in one table, and everything that tells of them says what it says."""

import json
import re
from dataclasses import fields, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pint
import pytest
from check_samples import PADS, case
from report_page import Page
from report_samples import write_results
from studies import RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError, MissingColumns
from rockbatch.motions.suites.scaling import Target
from rockbatch.outcome.outcome import TERMS, Outcome
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.bed import OF_FOOTING
from rockbatch.quantities.cases import THOUSAND
from rockbatch.quantities.catalogue import (
    COLUMNS,
    DEMANDS,
    FACTS,
    FIXED,
    OPTIONAL,
    TRAILING,
    as_markdown,
    names,
    report_columns,
)
from rockbatch.quantities.quantity import BENDING, FOOTING, Limit, Quantity
from rockbatch.reporting import write_report
from rockbatch.results.columns import columns, units
from rockbatch.results.reading import read_saved
from rockbatch.results.run_json import describe
from rockbatch.study.suite import ground_motions

PAGE = Path(rb.__file__).parents[1] / "docs/columns.md"
STUDY = """
[pier]
alpha = 0.2
p = 1.0

[motions]
polarity = ["+", "-"]
scale = [1, 4]

[[motions.pulse]]
name = "one-sine"
shape = "sine"
amplitude_g = 0.6
period_s = 1.0
dt_s = 0.01
duration_s = 2.0

[output]
ledger = true
forces = true
rocking = true
both_laws = true
devices_work = true

[[case]]
name = "rigid"
base = "rigid"

[[case]]
name = "elastic"
base = "elastic"
beta = 50

[[case]]
name = "yielding"
base = "yielding"
beta = 50
eta = 2.5
epsilon = 0.1
"""
STOPPED = RIGID | {"flight": "stop"}
RULES = """
[[check]]
name = "tilt"
demand = "base_tilt_rad"
at_most = 0.1
basis = "judgement"
reason = "r"
"""


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    path = tmp_path_factory.mktemp("columns") / "study.toml"
    path.write_text(STUDY, encoding="utf-8")
    return rb.load_study(path)


@pytest.fixture(scope="module")
def table(study):
    return rb.run(study)


def without(directory, *dropped):
    """A folder as an earlier version left it, that did not write ``dropped`` yet."""
    write_results(directory)
    peaks = pd.read_csv(directory / "peaks.csv", dtype=str, keep_default_na=False)
    peaks.drop(columns=list(dropped)).to_csv(directory / "peaks.csv", index=False)
    return directory


def test_the_page_of_columns_lists_them_as_the_table_has_them():
    """To put it right: write what ``rockbatch.quantities.catalogue.as_markdown`` gives into docs/columns.md."""
    assert as_markdown() in PAGE.read_text(encoding="utf-8")


def test_a_name_ends_with_its_unit():
    """``theta_res_drift_per_s`` is 1/s, ``energy_input_J_kg`` is J/kg; pint reads them all."""
    endings = {"s": "s", "m": "m", "rad": "rad", "J/kg": "J_kg", "m/s": "m_s", "1/s": "per_s"}
    endings |= {"m/s^2": "m_s2", "kN": "kN", "kN*s": "kN_s", "standard_gravity": "g", "m^2/s^2": "m2_s2"}
    endings |= {"kN*m": "kNm", "kJ": "kJ", "MPa": "MPa"}
    for column in COLUMNS.values():
        pint.Unit(column.unit)
        ended = [unit for unit, ending in endings.items() if column.name.endswith(f"_{ending}")]
        expected = max(ended, key=len, default="1")  # settlement_drift_m_s also ends like a time
        assert column.unit == expected, column.name
        assert column.kind == "number" or column.unit == "1"


def test_the_page_shows_a_column_in_the_unit_of_its_heading():
    named = {"g": "standard_gravity", "": "1"}
    for column in COLUMNS.values():
        if column.page is not None:
            unit = column.unit_on_page
            unit = named.get(unit, unit.replace("²", "**2").replace(" ", "*"))
            assert pint.Quantity(1.0, column.unit).to(unit).magnitude == pytest.approx(column.page.factor), column.name


def test_every_number_of_an_outcome_has_its_column():
    taken = {column.source for column in COLUMNS.values() if isinstance(column.source, str)}
    of_functions = {"observed", "bed"}  # each of their numbers has a column of its own
    of_functions |= {"flight_duration", "flight_height"}  # empty where they are 0
    of_functions |= {"top_drift_max"}  # top_drift_m where the shaft bends
    of_functions |= {"failure"}  # as a plain text
    of_functions |= {"change_in_motion"}  # the error of the peak in motion where that is not theta_max
    beside = {"tables"}  # in files of their own
    assert {field.name for field in fields(Outcome)} - taken == of_functions | beside


def test_every_term_of_the_energy_ledger_has_its_column():
    assert [name for name in COLUMNS if name.startswith("energy_")] == [f"energy_{term}_J_kg" for term in TERMS]


def test_a_row_of_the_catalogue_gives_column_heading_and_demands_in_two_units():
    row = Quantity(
        "slip_m",
        "slip",
        "slip",
        "m",
        more=" of the base",
        error="slip_error_m",
        limits=(Limit(), Limit(unit="mm", times=THOUSAND)),
    )
    assert row.meaning == "slip of the base"
    runs = pd.DataFrame({"slip_m": [0.5, -0.2], "slip_error_m": [0.1, np.nan]})
    demands = {demand.name: demand for demand in row.demands()}
    assert [(name, demand.words) for name, demand in demands.items()] == [
        ("slip_m", "slip [m]"),
        ("slip_mm", "slip [mm]"),
    ]
    np.testing.assert_allclose(
        demands["slip_mm"].evaluate(Rows(runs), case("pads", PADS)), [[500.0, 200.0], [100.0, np.nan]]
    )


def test_columns_of_devices_that_are_for_runs_that_stood_are_empty_in_others(tmp_path):
    devices = {"damper": [{"kind": "friction", "f": 0.05}], "tendon": {"psi": 0.1, "lambda": 0.5}}
    pulses = [SINE, SINE | {"name": "strong", "amplitude_g": 2.0, "period_s": 2.0}]
    text = study_text(pulses=pulses, cases=[RIGID | devices], output={"devices_work": True})
    table = rb.run(write_study(tmp_path, text))
    assert table["status"].tolist() == ["ok", "overturned"]
    for column in (*(column for column in OPTIONAL if column.device), COLUMNS["devices_error"]):
        if column.name in table:
            upright, fallen = table[column.name].notna()
            assert upright or column.sometimes, column.name
            assert not (fallen and column.stood), column.name
            assert fallen or column.stood or column.sometimes, column.name


def test_a_column_is_empty_where_the_table_says_that_it_does_not_apply(study, table):
    assert set(table["status"]) == {"ok", "overturned"}
    for name in columns(study):
        if name not in COLUMNS:
            continue
        column = COLUMNS[name]
        filled = table[name].notna() & (table[name].astype(object) != "")
        applies = table["case"].isin(column.bases) & ((table["status"] == "ok") | ~np.full(len(table), column.stood))
        assert not filled[~applies].any(), name
        assert column.sometimes or filled[applies].all(), name


def test_the_table_has_the_fixed_columns_first_and_those_asked_for_last(study, table):
    of_devices = (*(column for column in OPTIONAL if column.device), COLUMNS["devices_error"])  # it has no device
    unasked = (*of_devices, COLUMNS["landing_force_kN"], COLUMNS["slides"])
    asked = [column for column in OPTIONAL if column not in unasked and column.bases not in (BENDING, FOOTING)]
    assert list(table) == [*names(FIXED), *study.varied, *names(TRAILING), *names(asked)]


def test_run_json_says_the_unit_of_every_number(study, table):
    told = describe(study, ground_motions(study))["units"]
    assert told == units(study)
    texts = [column.name for column in COLUMNS.values() if column.kind == "text"]
    assert list(told) == [name for name in table if name not in (*texts, *study.varied)]
    assert (told["settlement_m"], told["theta_res_drift_per_s"], told["impacts"]) == ("m", "1/s", "1")


def test_a_target_that_is_no_spectrum_is_none_that_the_suite_is_compared_with(study):
    to_pga = replace(study, motions=replace(study.motions, target=Target(pga_g=0.3)))
    assert "target" not in describe(to_pga, ground_motions(study))


def test_demands_read_columns_of_the_table_only():
    pads = case("pads", PADS)
    runs = Rows(pd.DataFrame({name: ["" if column.kind == "text" else 0.5] for name, column in COLUMNS.items()}))
    for demand in DEMANDS.values():
        assert len(demand.evaluate(runs, pads).value) == 1
        assert demand.other_end is None or len(demand.other_end.evaluate(runs, pads)) == 1


UNSHOWN = {
    "mirror_of", "theta_max_in_motion_over_alpha", "theta_max_in_motion_error", "station", "impacts", "separations", "flight_s",
    "flights", "flight_duration_s", "substeps", "t_end_s", "residual_s", "theta_res_error", "theta_res_drift_per_s",
    "settlement_drift_m_s", "settlement_error_m", "top_drift_error_m", "dissipated_left_J_kg", "dissipated_right_J_kg", "failure",
    *FACTS,
    "foot_alpha_rad", "bed_force_s", "bed_pressure_s", "bed_pressure_at_m", "yielding_half_cycles", "bed_work_J_kg",
    "bed_force_error", "bed_pressure_error_MPa", "bed_work_error_J_kg", "settlement_left_m", "settlement_right_m",
    "edge_settlement_error_m", "strips_error",
}  # fmt: skip
"""Columns that stand in peaks.csv alone: counts, times, details of the method, and what the remarks say in words."""


def test_the_page_shows_columns_with_their_names_and_meanings(tmp_path):
    """Those that belong together stand side by side."""
    shown = names([*report_columns(), *report_columns("forces")])
    assert len(shown) == len(set(shown))
    assert set(shown) == {*COLUMNS} - UNSHOWN
    for together in (["theta_res_over_alpha", "base_tilt_rad", "settlement_m"], ["reason", "note"]):
        start = shown.index(together[0])
        assert shown[start : start + len(together)] == together
    behind = {column.name: column.page.behind for column in COLUMNS.values() if column.page and column.page.behind}
    for name, first in behind.items():
        between = shown[shown.index(first) + 1 : shown.index(name)]
        assert shown.index(first) < shown.index(name)
        assert all(behind.get(other) in (first, *between) for other in between), name
    write_results(tmp_path)
    text = write_report(tmp_path).read_text(encoding="utf-8")
    assert (
        'title="base_tilt_rad × 1000: residual tilt of the base">base tilt <span class="unit">[mrad]</span></th>'
        in text
    )
    assert 'over α, at rest on the deformed base">θ<sub>res</sub>/α</th>' in text
    page = Page(text)
    tilt = page.tables["peaks"][0].index("base tilt [mrad]")
    peaks = read_saved(tmp_path).peaks
    first = page.tables["peaks"][1]
    run = peaks[(peaks["record"] == first[0]) & (peaks["case"] == first[1])].iloc[0]
    assert float(first[tilt]) == pytest.approx(1000 * run["base_tilt_rad"], abs=6e-4)


def test_what_has_statistics_is_compared(tmp_path):
    a, b = write_results_in(tmp_path / "a"), write_results_in(tmp_path / "b")
    page = Page(rb.report(a, b).path.read_text(encoding="utf-8"))
    over = [text for text in page.tables["peaks"][0] if text]
    assert over == ["θmax/α", "θres/α", "settlement [mm]"]
    assert sum(column.suite is not None for column in (*FIXED, *TRAILING)) == len(over)


def write_results_in(directory):
    directory.mkdir()
    return write_results(directory)


def test_results_without_newer_columns_are_read_and_say_which_are_missing(tmp_path):
    without(tmp_path, "note", "residual_s")
    with pytest.warns(MissingColumns, match=r"has no columns residual_s, note, as an earlier version wrote it"):
        results = rb.open_results(tmp_path)
    assert results.missing == ("residual_s", "note")
    assert results.peaks["residual_s"].isna().all()
    assert (results.peaks["note"] == "").all()
    assert results.peaks["settlement_m"].notna().any()
    full = write_results_in(tmp_path / "full")
    assert rb.open_results(full).missing == ()


@pytest.mark.sweep(fast=2)
@pytest.mark.filterwarnings("ignore::rockbatch.common.errors.MissingColumns")
@pytest.mark.parametrize("first", range(4))
def test_a_report_without_newer_columns_is_made_and_says_so(tmp_path, first):
    """Every column is missing in one of four reports."""
    dropped = names(TRAILING)[first::4]
    text = write_report(without(tmp_path, *dropped)).read_text(encoding="utf-8")
    assert f"has no columns {', '.join(dropped)}, as an earlier version wrote it" in text
    assert not [name for name in dropped if f'title="{name}' in text]


def test_a_report_of_all_columns_speaks_of_no_earlier_version(tmp_path):
    assert "earlier version" not in write_report(write_results_in(tmp_path / "full")).read_text(encoding="utf-8")


@pytest.mark.filterwarnings("ignore::rockbatch.common.errors.MissingColumns")
def test_a_folder_without_newer_columns_is_compared_with_one_that_has_them(tmp_path):
    (tmp_path / "old").mkdir()
    old, new = without(tmp_path / "old", *names(TRAILING)), write_results_in(tmp_path / "new")
    assert "30 pairs of runs" in rb.report(old, new).path.read_text(encoding="utf-8")


def test_commands_say_once_and_plainly_which_columns_are_missing(tmp_path, capsys):
    without(tmp_path, "note")
    assert main(["report", str(tmp_path)]) == 0
    told = f"rockbatch: {tmp_path / 'peaks.csv'}: has no column note, as an earlier version wrote it"
    assert capsys.readouterr().err.count(told) == 1

    rules = tmp_path / "rules.toml"
    rules.write_text(RULES, encoding="utf-8")
    without(tmp_path, "base_tilt_rad")
    assert main(["check", str(tmp_path), "--rules", str(rules)]) == 1
    said = capsys.readouterr()
    assert said.err.count("has no column base_tilt_rad") == 1
    assert "? " in said.out
    assert "cannot be decided" in said.out


@pytest.mark.parametrize("dropped", names(FIXED))
def test_a_table_without_a_column_that_every_version_wrote_is_refused(tmp_path, dropped):
    with pytest.raises(InputError, match=rf"peaks\.csv:1: has no column {dropped}; start"):
        read_saved(without(tmp_path, dropped))


@pytest.mark.parametrize("content", ["", "a,b\n1,2\n", "\x00\x01\n", "record;case;polarity\nx;y;+\n"])
def test_what_is_no_table_of_peaks_is_refused(tmp_path, content):
    write_results(tmp_path)
    (tmp_path / "peaks.csv").write_text(content, encoding="utf-8")
    with pytest.raises(
        InputError, match=re.escape(f"{tmp_path / 'peaks.csv'}:1: has no column record, case, polarity")
    ):
        read_saved(tmp_path)


def test_a_table_that_is_no_text_is_refused_by_its_name_first(tmp_path):
    write_results(tmp_path)
    path = tmp_path / "peaks.csv"
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(lines + 500 * lines[1:2]) + b"\xff\xfe\n")  # beyond what is read at once
    with pytest.raises(InputError) as caught:
        read_saved(tmp_path)
    assert caught.value.messages[-1].startswith(f"{path}: not a table ('utf-8' codec can't decode")


def test_a_table_without_a_varied_key_is_refused(tmp_path):
    write_results(tmp_path)
    info = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    (tmp_path / "run.json").write_text(json.dumps(info | {"varied": ["beta"]}), encoding="utf-8")
    with pytest.raises(InputError, match="has no column beta"):
        read_saved(tmp_path)


def test_a_demand_without_bound_comes_back_from_disk(tmp_path):
    """A pier that flies is not held by friction at all: V/N is infinite then; the table has it while N is not small."""
    station = Path(__file__).parents[2] / "motions" / "near_fault" / "kaikoura2016_wtmc"
    pier, motions = {"alpha": 0.13, "p": 0.76}, {"path": str(station)}
    text = study_text(pier=pier, motions=motions, pulses=(), cases=(STOPPED,), output={"forces": True})
    rb.run(write_study(tmp_path, text), out=tmp_path / "out")
    opened = rb.open_results(tmp_path / "out")
    flown = opened.peaks[opened.peaks["status"] == "flight"]
    assert len(flown) == 2
    assert np.isfinite(flown["friction_demand"]).all()
    assert (flown["key_shear_m_s2"] > 0.0).all()
    assert np.isinf(opened.responses[0].forces["friction"]).any()
    assert np.isfinite(flown["base_shear_m_s2"]).all()
    assert (tmp_path / "out" / "report.html").exists()


def test_runs_that_never_flew_have_no_duration_and_no_height_of_flights(table):
    grounded = table[table["flights"] == 0]
    assert len(grounded)
    assert grounded[["flight_duration_s", "flight_height_m"]].isna().all(axis=None)


@pytest.mark.parametrize("quantity", OF_FOOTING, ids=lambda quantity: quantity.name)
def test_a_run_without_a_bed_has_no_quantity_of_one(quantity):
    outcome = SimpleNamespace(bed=None, settlement_error=0.1, theta_res_error=0.1)
    assert quantity.source(SimpleNamespace(pier=rb.Pier(0.2, 1.0), base=rb.RigidBase(), outcome=outcome)) is None
