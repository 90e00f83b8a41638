"""Rows of peaks.csv as arrays, against the tables that they come from; suites with what is missing, against a join by pandas."""

import numpy as np
import pandas as pd
import pytest

from rockbatch.quantities.arrays import MISSING, Rows
from rockbatch.quantities.rows import complete


def table_of(rng: np.random.Generator, records: int) -> pd.DataFrame:
    """Some runs of records that have two polarities each, in any order, with cells that are missing in every way."""
    names = [(f"r{number}", polarity) for number in range(records) for polarity in "+-"]
    table = pd.DataFrame(names, columns=["record", "polarity"]).sample(
        frac=0.6, random_state=int(rng.integers(1 << 30))
    )
    table["theta"] = np.where(rng.random(len(table)) < 0.3, np.nan, rng.random(len(table)))
    table["impacts"] = pd.array(rng.integers(0, 9, len(table)), dtype="Int64")
    table.loc[table.index[::3], "impacts"] = pd.NA
    table["error"] = pd.Series([None] * len(table), index=table.index, dtype=object)
    table["status"] = pd.Categorical(
        rng.choice(np.array(["ok", "failed", "overturned", None], dtype=object), len(table))
    )
    table["reason"] = pd.Series(
        rng.choice(np.array(["", "it fell", None], dtype=object), len(table)), index=table.index
    )
    table["station"] = np.nan
    return table


@pytest.mark.parametrize("seed", range(10))
def test_columns_of_some_rows_are_those_of_the_table(seed):
    rng = np.random.default_rng(seed)
    table = table_of(rng, 8)
    rows = rng.integers(0, len(table), 30)
    runs, taken = Rows(table).at(rows), table.iloc[rows]
    assert len(runs) == 30
    for name in ("theta", "impacts", "error"):
        expected = [np.nan if pd.isna(cell) else float(cell) for cell in taken[name]]
        np.testing.assert_array_equal(runs.numbers(name), expected)
    for name in ("record", "polarity", "status", "reason", "station"):
        assert runs.texts(name).tolist() == ["" if pd.isna(cell) else cell for cell in taken[name]]
    assert "theta" in runs
    assert "phi" not in runs
    assert np.isnan(runs.numbers("phi")).all()
    assert runs.texts("note").tolist() == [""] * 30


def test_a_row_that_the_table_lacks_has_nothing_but_what_is_known_of_it():
    table = pd.DataFrame({"theta": [1.0, 2.0], "record": ["a", "b"]})
    runs = Rows(table).at(np.array([1, MISSING, 0]), record=np.array(["b", "c", "a"], dtype=object))
    np.testing.assert_array_equal(runs.numbers("theta"), [2.0, np.nan, 1.0])
    assert runs.texts("record").tolist() == ["b", "c", "a"]
    assert runs.texts("note").tolist() == ["", "", ""]
    some = runs.where(np.array([False, True, True]))
    np.testing.assert_array_equal(some.numbers("theta"), [np.nan, 1.0])
    assert some.texts("record").tolist() == ["c", "a"]
    wider = some.same_rows_of(Rows(table.assign(shear=[5.0, 6.0])))
    np.testing.assert_array_equal(wider.numbers("shear"), [np.nan, 5.0])
    assert wider.texts("record").tolist() == ["c", "a"]


@pytest.mark.parametrize("seed", range(20))
def test_a_suite_has_every_record_in_every_polarity_once_as_in_an_outer_join(seed):
    rng = np.random.default_rng(seed)
    table = table_of(rng, 6)
    table["status"] = table["status"].astype(object)
    stations = {
        f"r{number}": f"S{number // 2}" for number in rng.permutation(9)[:7]
    }  # some are not in the table, and the reverse
    rows = np.flatnonzero(rng.random(len(table)) < 0.7)
    suite = complete(Rows(table).at(rows), stations, ["+", "-"])

    planned = pd.MultiIndex.from_product([list(stations), ["+", "-"]], names=["record", "polarity"]).to_frame(
        index=False
    )
    joined = planned.merge(table.iloc[rows].drop(columns="station"), how="outer", on=["record", "polarity"])
    missing = joined["status"].isna()
    joined.loc[missing, "status"] = "failed"
    joined["station"] = joined["record"].map(stations)
    assert missing.any()
    joined.loc[missing, ["reason", "theta"]] = ["", np.nan]  # a row without a status was not run
    for name in ("record", "polarity", "station", "status", "reason"):
        assert suite.texts(name).tolist() == joined[name].fillna("").tolist(), name
    np.testing.assert_array_equal(suite.numbers("theta"), joined["theta"])
    np.testing.assert_array_equal(suite.missing, missing)
