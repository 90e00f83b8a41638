"""Faults of results, read back: each file, line, column and cell in a message is the one that is wrong."""

import csv
import json
from dataclasses import replace
from types import SimpleNamespace

import h5py
import numpy as np
import pandas as pd
import pytest
from messages import assert_states, said_by
from report_samples import COLUMNS, FIG7, response, write_results

import rockbatch as rb
from rockbatch.outcome.figures import History
from rockbatch.pier import Pier, YieldingBase
from rockbatch.results.columns import given_table
from rockbatch.results.histories_file import HISTORIES, _run
from rockbatch.results.opened import _candidates
from rockbatch.results.reading import EditedTable, read_saved


@pytest.fixture
def folder(tmp_path):
    """Return a folder of results of six records on five foundations."""
    return write_results(tmp_path)


def with_cells(folder, *changes):
    """Write other cells into lines of peaks.csv."""
    path = folder / "peaks.csv"
    rows = list(csv.reader(path.read_text(encoding="utf-8").splitlines()))
    for line, column, cell in changes:
        rows[line - 1][rows[0].index(column)] = cell
    with path.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows(rows)


def refusal(folder):
    """Return why results cannot be read, without the path of the folder."""
    return said_by(lambda: read_saved(folder)).replace(f"{folder}/", "")


def test_wrong_cells_are_named_by_line_column_and_content(folder):
    wrong = (5, "t_max_s", "soon"), (7, "status", "fine"), (7, "impacts", "many"), (12, "scale", "")
    with_cells(folder, *wrong)
    first, impacts, status, scale = refusal(folder).splitlines()
    assert_states(first, "peaks.csv", 5.0, "t_max_s", '"soon"')
    assert_states(impacts, "peaks.csv", 7.0, "impacts", '"many"')
    assert_states(status, "peaks.csv", 7.0, "status", '"fine"')
    assert_states(scale, "peaks.csv", 12.0, "scale")


def test_a_row_of_another_length_is_named_by_its_line_and_both_numbers(folder):
    path = folder / "peaks.csv"
    lines = path.read_text(encoding="utf-8").splitlines()
    lines[8] += ",,"
    path.write_text("\n".join(lines), encoding="utf-8")
    assert_states(refusal(folder), "peaks.csv", 9.0, len(COLUMNS) + 2.0, len(COLUMNS))


def test_more_wrong_cells_than_are_listed_are_said_to_follow_in_the_same_file(folder):
    with_cells(folder, *((line, name, "x") for line in range(2, 16) for name in ("t_max_s", "impacts")))
    *listed, last = refusal(folder).splitlines()
    assert_states(listed[0], "peaks.csv", 2.0, "t_max_s", '"x"')
    assert last == "peaks.csv: and more"


def test_a_file_that_is_no_text_or_no_json_is_named_with_a_line_if_it_is_known(folder):
    path = folder / "peaks.csv"
    path.write_bytes(path.read_bytes().replace(b"RRS228", b"RRS\xff28", 1))
    assert refusal(folder).startswith("peaks.csv: not a table ('utf-8' codec")
    text = (folder / "run.json").read_text(encoding="utf-8")
    (folder / "run.json").write_text("\n\n" + text[:-1], encoding="utf-8")
    assert refusal(folder).startswith("run.json:3: not JSON (Expecting")
    (folder / "run.json").write_bytes(b"\n\n\n" + text.encode().replace(b"RRS228", b"RRS\xff28", 1))
    assert refusal(folder).startswith("run.json: not JSON ('utf-8' codec")


def test_a_table_whose_cells_are_right_one_by_one_is_named_with_what_is_wrong(folder, monkeypatch):
    """A count beyond 2⁵³ is a number, and none that a table of counts can hold."""
    monkeypatch.setattr("rockbatch.results.reading._bad_cells", lambda path, head, numbers: [])
    with_cells(folder, (5, "impacts", "1e300"))
    assert refusal(folder).startswith("peaks.csv: not a table (a count is out of range)")


def test_an_attribute_of_a_kept_run_that_is_missing_or_of_another_kind_is_named():
    whole = {"record": "LGP000", "case": "pads", "polarity": "+", "scale": 1.5, "status": "ok"}
    with h5py.File("x.h5", "w", driver="core", backing_store=False) as file:
        file.attrs.update(whole)
        assert _run(file) == whole
        for name, value in whole.items():
            for wrong in (None, 7 if isinstance(value, str) else "1.5"):
                del file.attrs[name]
                if wrong is not None:
                    file.attrs[name] = wrong
                with pytest.raises(ValueError, match=rf"the attribute {name} is"):
                    _run(file)
                file.attrs[name] = value


def test_an_edited_table_is_named_with_the_rows_that_it_had(folder):
    info = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    info["peaks"] = {"rows": 77, "sha256": "0" * 64}
    (folder / "run.json").write_text(json.dumps(info), encoding="utf-8")
    with pytest.warns(EditedTable) as told:
        read_saved(folder)
    assert_states(str(told[0].message).replace(f"{folder}/", ""), "peaks.csv", 77.0, "rows")


def test_a_varied_key_of_cases_that_the_table_has_as_words_is_named_with_both_files(tmp_path):
    folder = write_results(tmp_path, varied=("beta",))
    with_cells(folder, *((line, "beta", "soft") for line in range(2, 2 + 5 * len(FIG7))))
    assert_states(refusal(folder).partition(" is a number")[0], "peaks.csv", "beta")


def test_what_is_no_folder_of_results_is_told_from_one_that_is_not_there(folder):
    assert_states(
        said_by(lambda: read_saved(folder / "peaks.csv")).replace(str(folder), "HERE"), "HERE/peaks.csv", "HERE"
    )
    (folder / "analyses.html").touch()
    other = folder / "pads"
    other.mkdir()
    (other / "analyses.html").touch()
    said = said_by(lambda: read_saved(other)).replace(str(other), "HERE")
    assert_states(said, "HERE", "HERE/analyses.html")


def test_a_table_in_hand_is_refused_with_the_column_the_cell_or_the_run():
    table = pd.DataFrame({name: [0.1, 0.2, 0.3] for name in COLUMNS})
    for name, cells in {"record": "aab", "case": "xxy", "status": ["ok"] * 3, "polarity": "+++"}.items():
        table[name] = list(cells)
    table["scale"] = 1.0
    for name in ("reason", "note", "failure", "theta_max_is"):
        table[name] = ""
    assert_states(said_by(lambda: given_table(table, ())), "run of a", "case x", "leave one out")
    assert_states(said_by(lambda: given_table(table.assign(impacts=["4", "many", "9"]), ())), "impacts", '"many"')


def test_a_choice_of_histories_that_fits_several_or_none_is_told_those_there_are(folder):
    results = rb.open_results(folder)
    records = [name for name, _ in FIG7]
    index = pd.DataFrame({"record": records, "case": "pads", "eta": np.arange(6) + 0.5, "status": "ok"})
    said = results._no_history("record", "CPM00", index).replace(str(folder), "HERE")
    assert_states(said, "HERE", "record", '"CPM00"', '"CPM000"')
    assert_states(results._no_history("eta", 7.5, index).partition(": ")[2], "eta", 7.5, *(n + 0.5 for n in range(6)))
    several = pd.concat([index, index.assign(eta=index["eta"] + 6.0)])
    assert_states(_candidates(several, {"case": "pads"}).rpartition("; ")[2], 4.0, "more")


def test_a_response_shows_its_results_and_the_length_of_its_history():
    made = response("LGP000", "pads", YieldingBase(beta=40.0, eta=2.5), pier=Pier(alpha=0.2, p=1.0))
    cells = {"theta_max_over_alpha": 0.34567, "theta_max_error": 3e-5, "t_max_s": 4.25, "theta_res_over_alpha": 0.0123}
    row = pd.Series(cells | {"settlement_m": 0.0456, "reason": "", "note": ""})
    title, facts = replace(made, row=row, scale=1.5, polarity="-")._facts()
    assert_states(title, "LGP000", 1.5, "pads")
    assert_states(facts["history"], 8001.0, 8.0, "s")
    assert_states(facts["events"], 1.0, "separation")
    assert_states(facts["θ_max/α"], 0.34567, 3e-5, 4.25, "s")
    assert_states(facts["settlement"], 45.6, "mm")


@pytest.mark.parametrize("unusable", [0, 1, 3])
@pytest.mark.parametrize("kept", [True, False])
def test_results_show_their_runs_the_files_not_used_and_the_histories(tmp_path, unusable, kept):
    lost = [{"name": f"x{n}", "source": f"x{n}.AT2", "reason": "empty"} for n in range(unusable)]
    folder = write_results(
        tmp_path, unusable=lost, changes={("RRS228", "1"): {"status": "overturned", "theta_max_over_alpha": ""}}
    )
    if kept:
        (folder / HISTORIES).touch()
    _, facts = rb.open_results(folder)._facts()
    assert_states(facts["runs"], 30.0, 29.0, "ok", 1.0, "overturned")
    assert_states(facts["not used"], *[float(unusable)] * (unusable > 0))
    assert facts["histories"] == (HISTORIES if kept else "")


@pytest.mark.parametrize(("status", "expected"), [("ok", [0.1234, 7.5]), ("overturned", ["overturned", 9.5])])
def test_a_history_states_its_peak_or_its_end_with_the_time(status, expected):
    history = SimpleNamespace(status=status, peak=(7.5, -0.1234), end=(9.5, -1.5))
    assert_states(History.outcome.fget(history), *expected, *["s"])
