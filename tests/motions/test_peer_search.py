"""PEER's list of search results: shown with the records beside it, and a source of scale factors."""

import numpy as np
import pytest
from archive_files import write_zip
from motion_files import at2_text, wiggle, write_at2
from studies import FOLDER_STUDY, write_study

from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.motions import read_motions
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

HEADS = (
    "Result ID, Spectral Ordinate, Record Sequence Number, MSE, Scale Factor, Tp(s), 5-75% Duration (sec), 5-95% Duration (sec), "
    "Arias Intensity (m/sec), Earthquake Name, Year, Station Name, Magnitude, Mechanism, Rjb (km), Rrup (km), Vs30 (m/sec), "
    "Lowest Useable Frequency (Hz), Horizontal-1 Acc. Filename, Horizontal-2 Acc. Filename, Vertical Acc. Filename"
)


def listing(*rows: str) -> str:
    above = [
        " -- PEER --",
        "",
        " Spectral Ordinate:, SRSS",
        " -- Summary of Metadata of Selected Records --",
        f" {HEADS}",
    ]
    return "\n".join([*above, *rows, "", " -- Scaled Spectra used in Search & Scaling --", "T, RSN-999", "0.01, 5", ""])


def row(rsn: int, scale: str = "1.5", pulse: str = "-999", files: str = "---, ---, ---") -> str:
    return (
        f' 1, SRSS, {rsn}, 0.02, {scale}, {pulse}, 6.9, 24.2, 1.6, "Some, where", 1990, "A, B", 6.95, strike slip, 5.0, 6.09, '
        f"213.44, 0.25, {files}"
    )


def write_records(folder) -> None:
    write_at2(folder, "RSN6_MADEUP_ELC180.AT2", wiggle(300, 1, 0.2), title="Madeup, 1/17/1994, Elc, 180")
    write_at2(folder, "RSN7_MADEUP_XYZ090.AT2", wiggle(300, 2, 0.3), title="Madeup, 1/17/1994, Xyz, 090")


def test_what_the_list_says_of_a_record_is_in_the_table_and_shown(tmp_path, capsys):
    write_records(tmp_path)
    (tmp_path / "_SearchResults.csv").write_text(listing(row(6, pulse=" 1.41"), row(8)))
    table = read_motions(tmp_path).table().set_index("record")
    heads = ["magnitude", "distance_km", "vs30_m_s", "list_scale", "list_d5_95_s", "list_pulse_period_s"]
    assert table.loc["RSN6_MADEUP_ELC180", heads].tolist() == [6.95, 6.09, 213.44, 1.5, 24.2, 1.41]
    assert table.loc["RSN7_MADEUP_XYZ090", heads].isna().all()
    assert main(["motions", "--all", str(tmp_path)]) == 0
    shown = capsys.readouterr().out
    for text in ("list scale", "Vs30 [m/s]", "213.44", "1.41"):
        assert text in shown


def test_a_manifest_knows_better_than_the_list(tmp_path):
    write_records(tmp_path)
    (tmp_path / "_SearchResults.csv").write_text(listing(row(6)))
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "RSN6_MADEUP_ELC180.AT2"\nmagnitude = 5.0\n')
    motion = read_motions(tmp_path)["RSN6_MADEUP_ELC180"]
    assert (motion.magnitude, motion.distance_km) == (5.0, 6.09)


def test_records_are_found_by_their_file_too_and_lists_in_archives_go_with_theirs(tmp_path):
    files = {"a.AT2": at2_text(wiggle(300, 1, 0.2), title="Madeup, 1/17/1994, Elc, 180")}
    write_zip(tmp_path / "peer.zip", files | {"_SearchResults.csv": listing(row(6, files="A.AT2, ---, ---"))})
    write_zip(tmp_path / "other.zip", {"b.AT2": at2_text(wiggle(300, 2, 0.2), title="Madeup, 1/17/1994, Elc, 090")})
    assert {m.name: m.listed.scale for m in read_motions(tmp_path)} == {"a": 1.5, "b": None}


@pytest.mark.parametrize(
    "text", ["", "x", listing(), listing(row(6, scale="-999")), "\x00", listing(row(6))[:300], '"open\n6']
)
def test_a_list_without_a_factor_costs_no_record(tmp_path, text):
    write_records(tmp_path)
    (tmp_path / "_SearchResults.csv").write_text(text)
    found = read_motions(tmp_path)
    assert len(found) == 2
    assert all(motion.listed.scale is None for motion in found)


@pytest.mark.parametrize("damaged", [b'"' + b"x" * 200_000, b"\xff\xfe\x00\xd8x"], ids=["cell", "code"])
def test_a_list_that_cannot_be_read_gives_no_factors_of_another_folder(tmp_path, damaged):
    for folder, content in (
        ("a", listing(row(6)).encode()),
        ("b", damaged),
        ("c", listing(row(6, scale="2")).encode()),
    ):
        write_at2(tmp_path / folder, f"RSN6_{folder}_180.AT2", wiggle(300, ord(folder), 0.2))
        (tmp_path / folder / "_SearchResults.csv").write_bytes(content)
    assert [motion.listed.scale for motion in read_motions(tmp_path)] == [1.5, None, 2.0]


def test_a_study_scales_records_by_the_factors_of_the_list(tmp_path):
    records = tmp_path / "records"
    records.mkdir()
    write_records(records)
    (records / "_SearchResults.csv").write_text(listing(row(6), row(7, scale="0.5")))
    text = FOLDER_STUDY + 'scale = "list"\n'
    suite = ground_motions(load_study(write_study(tmp_path, text)))
    unscaled = read_motions(records)
    for motion, plain, factor in zip(suite, unscaled, (1.5, 0.5), strict=True):
        np.testing.assert_allclose(motion.horizontal, factor * plain.horizontal, rtol=1e-15)
        assert motion.factor == factor
        assert any("as PEER's search lists it" in note for note in motion.notes)
    (records / "_SearchResults.csv").write_text(listing(row(6)))
    (lacking,) = ground_motions(load_study(write_study(tmp_path, text))).unusable
    assert "has no scale factor" in lacking.reason


@pytest.mark.parametrize(("second", "factor"), [("1.5", 1.5), ("0.5", None)])
def test_a_sequence_has_the_facts_of_a_list_that_all_its_records_share(tmp_path, second, factor):
    records = tmp_path / "records"
    records.mkdir()
    write_records(records)
    (records / "_SearchResults.csv").write_text(listing(row(6, pulse="1.41"), row(7, scale=second)))
    joined = '[[motions.sequence]]\nname = "both"\nrecords = ["RSN6_MADEUP_ELC180", "RSN7_MADEUP_XYZ090"]\n'
    (whole,) = ground_motions(load_study(write_study(tmp_path, FOLDER_STUDY + joined)))
    listed = whole.listed
    assert (listed.scale, listed.vs30_m_s, listed.pulse_period_s, listed.d5_95_s) == (factor, 213.44, None, None)
    study = load_study(write_study(tmp_path, FOLDER_STUDY + 'scale = "list"\n' + joined))
    if factor is not None:
        assert [motion.factor for motion in ground_motions(study)] == [factor]
    else:
        with pytest.raises(InputError, match="both has no scale factor that all its records share"):
            ground_motions(study)


@pytest.mark.parametrize("scale", ['["list", 2.0]', '"lists"', "0"])
def test_a_scale_that_is_no_factor_nor_the_list_is_refused(tmp_path, scale):
    (tmp_path / "records").mkdir()
    text = f"{FOLDER_STUDY}scale = {scale}\n"
    with pytest.raises(InputError, match="scale"):
        load_study(write_study(tmp_path, text))
