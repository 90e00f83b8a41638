"""Tables beside peaks.csv are read as they were written, or refused with the column that is wrong."""

import math

import pandas as pd
import pytest

from rockbatch.common.errors import InputError
from rockbatch.quantities.rows import as_in_peaks, simulated, with_case
from rockbatch.results.beside_peaks import NAMING, case_key, read_beside

COLUMNS = ["height_m", "force_kN", "words"]
TABLE = pd.DataFrame([{name: "x" for name in NAMING} | {"beta": 40.0, "height_m": 1.5, "force_kN": -2.0, "words": "w"}])


@pytest.mark.parametrize("name", [*NAMING, "beta", *COLUMNS])
def test_every_column_has_to_be_there(tmp_path, name):
    TABLE.drop(columns=name).to_csv(tmp_path / "of.csv", index=False)
    with pytest.raises(InputError, match=f"of.csv: column {name} is missing: the file was changed"):
        read_beside(tmp_path / "of.csv", ["beta"], COLUMNS, ["words"])


@pytest.mark.parametrize("name", ["height_m", "force_kN"])
def test_numbers_have_to_be_numbers_and_texts_may_be_any(tmp_path, name):
    path = tmp_path / "of.csv"
    TABLE.assign(words=1.0).to_csv(path, index=False)
    assert read_beside(path, ["beta"], COLUMNS, ["words"])["height_m"].tolist() == [1.5]
    TABLE.assign(**{name: "many"}).to_csv(path, index=False)
    with pytest.raises(InputError, match=f"of.csv: column {name} has texts"):
        read_beside(path, ["beta"], COLUMNS, ["words"])


def test_a_text_that_looks_like_a_number_or_a_formula_stays_as_it_was(tmp_path):
    TABLE.assign(words="007").to_csv(tmp_path / "of.csv", index=False)
    assert read_beside(tmp_path / "of.csv", ["beta"], COLUMNS, ["words"])["words"].tolist() == ["007"]
    TABLE.assign(words="'=1+1").to_csv(tmp_path / "of.csv", index=False)
    assert read_beside(tmp_path / "of.csv", ["beta"], COLUMNS, ["words"])["words"].tolist() == ["=1+1"]


def test_a_case_is_known_by_its_values_in_the_digits_of_the_table():
    assert case_key("pads", {"beta": 1.0 / 3.0, "spring": "epp"}, ["spring", "beta"]) == ("pads", "epp", 0.3333333333)
    assert case_key("pads", {}, ["beta"]) == ("pads", "")


def test_rows_of_runs_have_the_digits_of_peaks_and_no_mirror_images():
    peaks = pd.DataFrame({"record": ["a", "a", "b"], "case": ["pads", "pads", ""], "mirror_of": ["", "a +", ""]})
    assert with_case(peaks)["record"].tolist() == ["a", "a"]
    assert with_case(peaks[:2]) is not peaks
    assert simulated(peaks)["record"].tolist() == ["a", "b"]
    assert simulated(peaks.drop(columns="mirror_of"))["record"].tolist() == ["a", "a", "b"]
    assert [as_in_peaks(value) for value in (None, math.nan, 2.0 / 3.0, 3, "epp")] == ["", "", 0.6666666667, 3.0, "epp"]
