"""Records in archives: read as in folders, without harm from what an archive may hold."""

import gzip
import io
import os
import stat
import struct
import tarfile
import zipfile
import zlib
from pathlib import Path

import numpy as np
import pytest
from agency_files import knet_text
from archive_files import tarred, write_zip
from motion_files import at2_text, wiggle, write_at2
from waveform_files import COUNTS, channel_xml, station_xml, trace, write_mseed

from rockbatch.motions import read_motions
from rockbatch.motions.manifest_draft import write_manifest
from rockbatch.motions.sources import archives

NAMES = {"RSN1063_NORTHR_RRS228.AT2": 1, "RSN1063_NORTHR_RRS318.AT2": 2, "RSN1063_NORTHR_RRS-UP.AT2": 3}


def at2(name: str, seed: int) -> str:
    component = name.removesuffix(".AT2")[-3:].strip("-").removeprefix("RS")
    return at2_text(wiggle(50, seed), title=f"Made-up, 1/17/1994, Test Station, {component}")


def peer_zip(path: Path, inside: str = "") -> Path:
    return write_zip(path, peer_files(inside))


def peer_files(inside: str = "") -> dict[str, str]:
    return {inside + name: at2(name, seed) for name, seed in NAMES.items()}


def reasons_of(found) -> dict[str, str]:
    return {unusable.source: unusable.reason for unusable in found.unusable}


def packed_in(kind: str, path: Path, inside: str) -> Path:
    """Write the files of PEER into an archive of a kind."""
    if kind == "zip":
        return peer_zip(path / "peer.zip", inside)
    if kind == "zip in zip":
        return write_zip(path / "all.zip", {"one/peer.zip": peer_zip(path / "peer", inside).read_bytes()})
    if kind == "tar.gz in zip":
        return write_zip(path / "all.zip", {"one/peer.tar.gz": tarred(peer_files(inside), "w:gz")})
    if kind == "zip in tgz":
        (path / "all.tgz").write_bytes(tarred({"one/peer.zip": peer_zip(path / "peer", inside).read_bytes()}, "w:gz"))
        return path / "all.tgz"
    (path / f"peer.{kind}").write_bytes(tarred(peer_files(inside), "w" if kind == "tar" else "w:gz"))
    return path / f"peer.{kind}"


KINDS = {
    "zip": "peer.zip/", "tar": "peer.tar/", "tgz": "peer.tgz/", "tar.gz": "peer.tar.gz/",
    "zip in zip": "all.zip/one/peer.zip/", "tar.gz in zip": "all.zip/one/peer.tar.gz/", "zip in tgz": "all.tgz/one/peer.zip/",
}  # fmt: skip
"""Kinds of archives, and where records in them come from."""


@pytest.mark.parametrize(
    ("kind", "inside"), [*((kind, "records/") for kind in KINDS), ("zip", ""), ("zip", "records\\"), ("tar.gz", "./")]
)
def test_an_archive_gives_what_its_files_give_in_a_folder(tmp_path, kind, inside):
    archive = packed_in(kind, tmp_path, inside)
    (tmp_path / "folder").mkdir()
    for name, seed in NAMES.items():
        (tmp_path / "folder" / name).write_text(at2(name, seed))
    packed, plain = read_motions(archive), read_motions(tmp_path / "folder")
    assert [motion.name for motion in packed.motions] == [motion.name for motion in plain.motions]
    where = KINDS[kind] + inside.replace("\\", "/").removeprefix("./")
    for one, other in zip(packed.motions, plain.motions, strict=True):
        np.testing.assert_array_equal(one.horizontal, other.horizontal)
        np.testing.assert_array_equal(one.vertical, other.vertical)
        assert (one.source, one.vertical_source) == (where + other.source, where + other.vertical_source)
    assert not packed.unusable


def test_files_of_two_archives_are_not_paired_and_bear_the_names_of_their_archives(tmp_path):
    for name, seed in (("a.zip", 1), ("b.zip", 2)):
        write_zip(tmp_path / name, {"Y000.AT2": at2_text(wiggle(50, seed), title="nothing")})
    write_zip(tmp_path / "c.zip", {"Y-UP.AT2": at2_text(wiggle(50, 3), title="nothing")})
    found = read_motions(tmp_path)
    assert [motion.name for motion in found.motions] == ["a.zip/Y000", "b.zip/Y000"]
    assert "without a usable horizontal" in reasons_of(found)["c.zip/Y-UP.AT2"]


def test_a_gz_is_the_file_that_it_holds(tmp_path):
    for name, seed in NAMES.items():
        (tmp_path / f"{name}.gz").write_bytes(gzip.compress(at2(name, seed).encode()))
    found = read_motions(tmp_path)
    assert [(motion.name, motion.source, motion.vertical_source) for motion in found.motions] == [
        (f"RSN1063_NORTHR_RRS{azimuth}", f"RSN1063_NORTHR_RRS{azimuth}.AT2.gz", "RSN1063_NORTHR_RRS-UP.AT2.gz")
        for azimuth in ("228", "318")
    ]
    np.testing.assert_allclose(found.motions[0].horizontal / 9.81, wiggle(50, 1), rtol=1e-6)


def test_components_that_differ_by_suffix_only_keep_it_in_their_names_when_packed(tmp_path):
    for direction, suffix in (("E-W", "EW"), ("N-S", "NS")):
        (tmp_path / f"TST.{suffix}.gz").write_bytes(gzip.compress(knet_text(direction)[0].encode()))
    assert [motion.name for motion in read_motions(tmp_path).motions] == ["TST.EW", "TST.NS"]


def test_miniseed_in_an_archive_takes_the_station_xml_beside_it_there(tmp_path):
    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    station_xml(tmp_path, channel_xml("HNN"))
    packed = {f"day/{name}": (tmp_path / name).read_bytes() for name in ("n.mseed", "stations.xml")}
    (tmp_path / "elsewhere").mkdir()
    (motion,) = read_motions(write_zip(tmp_path / "elsewhere" / "x.zip", packed)).motions
    (plain,) = read_motions(tmp_path / "n.mseed").motions
    np.testing.assert_array_equal(motion.horizontal, plain.horizontal)
    assert any("from StationXML" in note for note in motion.notes)


def test_companions_are_left_out_and_hidden_files_passed_over_as_in_folders(tmp_path):
    other = {"_SearchResults.csv": "x", "notes.pdf": "x", "RSN1.VT2": "x", "motions.toml": "x", "stations.xml": "<x/>"}
    other["readme.st_N.txt"] = "x"
    passed = {"README.txt": "x", "readme.txt.gz": "x", "__MACOSX/._x.AT2": "x", ".git/x.AT2": "x"}
    write_zip(tmp_path / "x.zip", {"x.AT2": at2("x.AT2", 1), "unknown.xyz": "x", **other, **passed})
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["x.zip/x.AT2"]
    assert {left.source: left.reason for left in found.left_out} == {
        "x.zip/_SearchResults.csv": "no record: a table about the records",
        "x.zip/notes.pdf": "no record: text about the records",
        "x.zip/readme.st_N.txt": "no record: no columns of numbers found in it",
        "x.zip/RSN1.VT2": "no record: the velocity of a record",
        "x.zip/motions.toml": "no record: a manifest within an archive is not obeyed; put it beside that",
    }
    assert list(reasons_of(found)) == ["x.zip/unknown.xyz"]


def test_an_archive_without_files_is_whole(tmp_path):
    write_zip(tmp_path / "x.zip", {})
    (tmp_path / "x.tar").write_bytes(tarred({}, "w"))
    assert reasons_of(read_motions(tmp_path)) == dict.fromkeys(("x.tar", "x.zip"), "an archive without files")


def test_a_folder_with_the_name_of_an_archive_is_a_folder(tmp_path):
    (tmp_path / "day.zip").mkdir()
    (tmp_path / "day.zip" / "x.AT2").write_text(at2("x.AT2", 1))
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["day.zip/x.AT2"]
    assert archives.archive_of(tmp_path / "day.zip" / "x.AT2") is None


def test_manifest_and_draft_reach_into_archives(tmp_path):
    peer_zip(tmp_path / "peer.zip")
    (tmp_path / "x.AT2.gz").write_bytes(gzip.compress(at2("000.AT2", 4).encode()))
    before = read_motions(tmp_path)
    text = write_manifest(tmp_path).read_text(encoding="utf-8")
    assert [(m.name, m.vertical_source, m.notes) for m in read_motions(tmp_path).motions] == [
        (m.name, m.vertical_source, m.notes) for m in before.motions
    ]
    assert 'file = "peer.zip/RSN1063_NORTHR_RRS228.AT2"' in text
    (tmp_path / "motions.toml").write_text(
        '[[record]]\nfile = "peer.zip/RSN1063_NORTHR_RRS228.AT2"\nmagnitude = 6\n'
        '[[record]]\nfile = "peer.zip"\nmagnitude = 7\n[[record]]\nfile = "x.AT2.gz"\nuse = false\n'
    )
    found = read_motions(tmp_path)
    assert [motion.magnitude for motion in found.motions] == [6.0, 7.0]
    assert [left.source for left in found.left_out] == ["x.AT2.gz"]


@pytest.mark.parametrize("name", ["../x.AT2", "a/../../x.AT2", "/etc/x.AT2", "C:/x.AT2", "C:\\x.AT2", "..\\x.AT2"])
def test_names_that_lead_out_of_the_archive_are_refused_and_cost_no_other_file(tmp_path, name):
    write_zip(tmp_path / "x.zip", {name: at2("x.AT2", 1), "x.AT2": at2("x.AT2", 2)})
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["x.zip/x.AT2"]
    np.testing.assert_allclose(found.motions[0].horizontal / 9.81, wiggle(50, 2), rtol=1e-6)
    (reason,) = reasons_of(found).values()
    assert "leads out of the archive" in reason


def test_links_double_names_and_other_packing_are_refused_with_reasons(tmp_path):
    inner = io.BytesIO()
    with zipfile.ZipFile(inner, "w") as archive:
        archive.writestr("x.AT2", at2("x.AT2", 1))
    link = zipfile.ZipInfo("link.AT2")
    link.external_attr = (stat.S_IFLNK | 0o777) << 16
    with zipfile.ZipFile(tmp_path / "x.zip", "w") as archive:
        archive.writestr(link, "/etc/passwd")
        archive.writestr("inner.AT2.gz", gzip.compress(b"x"))
        archive.writestr("disguised.AT2", inner.getvalue())
        archive.writestr("twice.AT2", at2("000.AT2", 1))
        archive.writestr("lzma.AT2", at2("000.AT2", 1), zipfile.ZIP_LZMA)
        with pytest.warns(UserWarning, match="Duplicate name"):
            archive.writestr("twice.AT2", at2("000.AT2", 2))
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["x.zip/twice.AT2"]
    reasons = [(u.source.removeprefix("x.zip/"), u.reason.split(";")[0]) for u in found.unusable]
    assert sorted(reasons) == [
        ("disguised.AT2", "an archive within an archive"),
        ("inner.AT2.gz", "an archive within an archive"),
        ("link.AT2", "a link"),
        ("lzma.AT2", "packed by method 14, which is not read"),
        ("twice.AT2", "the archive has two files of this name"),
    ]


def test_encrypted_files_are_refused_as_such(tmp_path):
    data = bytearray(peer_zip(tmp_path / "x.zip").read_bytes())
    for signature, flags in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):  # local headers, and the list at the end
        at = data.find(signature)
        data[at + flags] |= 1
    (tmp_path / "x.zip").write_bytes(data)
    assert "encrypted; unpack it" in reasons_of(read_motions(tmp_path))["x.zip/RSN1063_NORTHR_RRS228.AT2"]


def test_what_grows_beyond_any_record_is_not_unpacked(tmp_path):
    zeros = at2("000.AT2", 1).encode() + b"0.0 " * 2**20
    write_zip(tmp_path / "x.zip", {"x.AT2": zeros})
    (tmp_path / "y.AT2.gz").write_bytes(gzip.compress(zeros))
    first, second = reasons_of(read_motions(tmp_path)).values()
    assert "more than 100 times its" in first
    assert "more than 100 times its" in second


def test_what_unpacks_to_more_than_a_file_may_have_is_never_read_in_part(tmp_path, monkeypatch):
    text = at2("000.AT2", 1).encode()
    monkeypatch.setattr(archives, "LARGEST", len(text) - 1)
    (tmp_path / "x.AT2.gz").write_bytes(gzip.compress(text))
    write_zip(tmp_path / "x.zip", {"x.AT2": text})
    found = read_motions(tmp_path)
    assert not found.motions
    assert all("unpacks to more than" in reason for reason in reasons_of(found).values())
    assert len(found.unusable) == 2


def test_a_zip_that_lies_about_its_sizes_ends_in_a_reason(tmp_path):
    body = zlib.compress(b"0.0 " * 2**22, 9)[2:-4]  # 16 MiB, said to be 1000 bytes
    name = b"x.AT2"
    local = struct.pack("<4s5H3I2H", b"PK\x03\x04", 20, 0, 8, 0, 0, 0, len(body), 1000, len(name), 0) + name
    entry = struct.pack("<4s6H3I5H2I", b"PK\x01\x02", 20, 20, 0, 8, 0, 0, 0, len(body), 1000, len(name), *[0] * 6)
    end = struct.pack("<4s4H2IH", b"PK\x05\x06", 0, 0, 1, 1, len(entry) + len(name), len(local) + len(body), 0)
    (tmp_path / "x.zip").write_bytes(local + body + entry + name + end)
    (reason,) = reasons_of(read_motions(tmp_path)).values()
    assert "reader failed" not in reason


def test_the_number_of_files_and_their_sum_are_bounded(tmp_path, monkeypatch):
    write_zip(tmp_path / "many.zip", {f"{i}.AT2": "" for i in range(2001)})
    assert "more than 2000 files" in reasons_of(read_motions(tmp_path))["many.zip"]
    (tmp_path / "many.zip").unlink()
    peer_zip(tmp_path / "x.zip")
    monkeypatch.setattr(archives, "_MOST_UNPACKED", 2500)  # each has 1 kB
    found = read_motions(tmp_path)
    assert len(found.motions) == 1
    assert any("the archive unpacks to more than" in reason for reason in reasons_of(found).values())


def test_a_third_archive_and_a_folder_with_the_name_of_one_are_refused(tmp_path):
    (tmp_path / "third").mkdir()
    third = peer_zip(tmp_path / "third" / "x.zip").read_bytes()
    second = write_zip(tmp_path / "third" / "y.zip", {"third.zip": third, "y.AT2": at2("000.AT2", 1)}).read_bytes()
    write_zip(tmp_path / "first.zip", {"second.zip": second, "a.zip/x.AT2": at2("000.AT2", 2), "damaged.zip": b"PK"})
    found = read_motions(tmp_path / "first.zip")
    assert [motion.source for motion in found.motions] == ["first.zip/second.zip/y.AT2"]
    assert {source: reason.split(";")[0] for source, reason in reasons_of(found).items()} == {
        "first.zip/second.zip/third.zip": "an archive within an archive",
        "first.zip/a.zip/x.AT2": "in a folder with the name of an archive",
        "first.zip/damaged.zip": "not a zip archive, or a cut one",
    }


def test_a_tar_gives_records_only_no_links_devices_or_holes(tmp_path):
    kinds = {
        "link.AT2": tarfile.SYMTYPE,
        "hard.AT2": tarfile.LNKTYPE,
        "device.AT2": tarfile.CHRTYPE,
        "pipe.AT2": tarfile.FIFOTYPE,
    }
    more = []
    for name, kind in kinds.items():
        info = tarfile.TarInfo(name)
        info.type, info.linkname = kind, "/etc/passwd"
        more.append(info)
    names = {"x.AT2": at2("000.AT2", 1), "../out.AT2": at2("000.AT2", 2), "/etc/out.AT2": at2("000.AT2", 3)}
    (tmp_path / "x.tar.gz").write_bytes(tarred(names, "w:gz", *more))
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["x.tar.gz/x.AT2"]
    assert {source.removeprefix("x.tar.gz/"): reason.split(";")[0] for source, reason in reasons_of(found).items()} == {
        "../out.AT2": "its name leads out of the archive", "/etc/out.AT2": "its name leads out of the archive",
        "link.AT2": "a link", "hard.AT2": "a link", "device.AT2": "no regular file", "pipe.AT2": "no regular file",
    }  # fmt: skip


def test_a_tar_that_was_cut_anywhere_loses_no_record_in_silence(tmp_path):
    whole = tarred(peer_files())
    for length in range(0, len(whole) - 9 * 512, 256):  # the end is filled up to 20 blocks
        (tmp_path / "x.tar").write_bytes(whole[:length])
        found = read_motions(tmp_path)
        assert (not found.motions and found.unusable) or found.motions[0].vertical is not None, length


@pytest.mark.parametrize("kind", ["w", "w:gz"])
def test_a_tar_is_bounded_as_a_zip_is(tmp_path, monkeypatch, kind):
    name = "many.tar" if kind == "w" else "many.tgz"
    (tmp_path / name).write_bytes(tarred({f"{i}.AT2": "" for i in range(2001)}, kind))
    (reason,) = reasons_of(read_motions(tmp_path)).values()
    assert "more than 2000 files" in reason
    (tmp_path / name).write_bytes(tarred({"x.AT2": at2("000.AT2", 1).encode() + b"0.0 " * 2**18}, kind))
    assert ("more than 100 times" in str(reasons_of(read_motions(tmp_path)))) is (kind == "w:gz")
    monkeypatch.setattr(archives, "LARGEST", 1000)
    (reason,) = reasons_of(read_motions(tmp_path)).values()
    assert "larger than" in reason or "unpacks to more than" in reason


@pytest.mark.parametrize("name", ["x.tar.gz", "x.tgz", "x.tar"])
def test_what_is_no_archive_by_its_bytes_is_said_to_be_none(tmp_path, name):
    (tmp_path / name).write_bytes(b"whatever")
    assert reasons_of(read_motions(tmp_path))[name].endswith(
        "or a cut one; fetch it again" if name == "x.tar" else "fetch it again"
    )


@pytest.mark.parametrize("name", ["x.7z", "x.rar", "x.AT2.bz2", "x.zip.gz", "x.tar.xz"])
def test_other_archives_lead_on(tmp_path, name):
    (tmp_path / name).write_bytes(b"whatever")
    assert reasons_of(read_motions(tmp_path))[name].endswith("unpack it")


def test_a_vertical_named_z_is_no_archive(tmp_path):
    write_at2(tmp_path, "ABBAR.N", wiggle(50, 1), title="Made-up, 1/17/1994, Test Station, N")
    write_at2(tmp_path, "ABBAR.Z", wiggle(50, 2), title="Made-up, 1/17/1994, Test Station, UP")
    (motion,) = read_motions(tmp_path).motions
    assert motion.vertical_source == "ABBAR.Z"


def test_a_damaged_archive_ends_in_records_or_reasons(tmp_path):
    whole = {"x.zip": peer_zip(tmp_path / "x.zip").read_bytes(), "x.AT2.gz": gzip.compress(at2("x.AT2", 1).encode())}
    nested = write_zip(tmp_path / "y", {"x.zip": whole["x.zip"]}, zipfile.ZIP_STORED).read_bytes()
    whole |= {"x.tar": tarred(peer_files()), "x.tgz": tarred(peer_files(), "w:gz"), "all.zip": nested}
    for path in (tmp_path / "x.zip", tmp_path / "y"):
        path.unlink()
    rng = np.random.default_rng(0)
    reasons = 0
    for i in range(60):
        name, data = list(whole.items())[i % len(whole)]
        damaged = bytearray(data[: rng.integers(0, len(data))] if rng.random() < 0.3 else data)
        for _ in range(int(rng.integers(0, 6))):
            if damaged:
                damaged[rng.integers(0, len(damaged))] = rng.integers(0, 256)
        (tmp_path / name).write_bytes(damaged)
        found = read_motions(tmp_path)
        reasons += len(found.unusable)
        assert not any("reader failed" in unusable.reason for unusable in found.unusable)
        assert found.motions or found.unusable or found.left_out or not damaged
        os.unlink(tmp_path / name)
    assert reasons > 12


def test_a_record_in_a_file_without_a_known_suffix_is_recognised_by_its_header(tmp_path):
    write_at2(tmp_path, "RSN1063_NORTHR_RRS228.AT2.90", wiggle(50, 1))
    (tmp_path / "unknown").write_text("hello\n")
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["RSN1063_NORTHR_RRS228.AT2.90"]
    assert "write it as MiniSEED, or as text columns" in reasons_of(found)["unknown"]


@pytest.mark.parametrize("name", ["x.zip", "x.tgz", "all.zip"])
def test_an_archive_is_opened_and_listed_once_whatever_it_holds(tmp_path, monkeypatch, name):
    """Where each file listed it again, 600 files took 15 s."""
    files = {f"r{i}_000.AT2": at2_text(wiggle(50, i), title=f"Made-up, 1/17/1994, S{i}, 000") for i in range(30)}
    if name == "x.tgz":
        (tmp_path / name).write_bytes(tarred(files, "w:gz"))
    else:
        inner = write_zip(tmp_path / "x.zip", files)
        if name == "all.zip":
            write_zip(tmp_path / name, {"x.zip": inner.read_bytes()}, zipfile.ZIP_STORED)
            inner.unlink()
    listed = []
    once = archives._Archive
    monkeypatch.setattr(archives, "_Archive", lambda *given: (listed.append(given), once(*given))[1])
    assert len(read_motions(tmp_path).motions) == 30
    assert len(listed) == (2 if name == "all.zip" else 1)


@pytest.mark.parametrize("name", ["TST.ps.gz", "plot.PNG.gz", "plot.svgz", "notes.pdf.gz"])
def test_a_packed_plot_or_text_in_an_archive_is_left_out_and_a_packed_record_is_not(tmp_path, name):
    write_at2(tmp_path, "x000.AT2", wiggle(60))
    record = (tmp_path / "x000.AT2").read_bytes()
    (tmp_path / "x000.AT2").unlink()
    write_zip(
        tmp_path / "all.zip", {"x000.AT2": record, name: gzip.compress(b"x"), "y000.AT2.gz": gzip.compress(record)}
    )
    found = read_motions(tmp_path)
    assert [one.source for one in found.left_out] == [f"all.zip/{name}"]
    assert "all.zip/y000.AT2.gz" in [one.source for one in found.unusable]


def test_station_xml_is_read_once_however_many_records_ask_for_it(tmp_path, monkeypatch):
    read: list[Path] = []
    plain = archives.content
    monkeypatch.setattr(archives, "content", lambda path, *first: (read.append(path), plain(path, *first))[1])
    for channel in ("HNE", "HNN", "HNZ"):
        write_mseed(tmp_path / f"{channel}.mseed", trace(channel, COUNTS // (2 if channel == "HNZ" else 1)))
    station_xml(tmp_path, *map(channel_xml, ("HNE", "HNN", "HNZ")))
    assert not read_motions(tmp_path).unusable
    assert read.count(tmp_path / "stations.xml") == 1
    (tmp_path / "stations.xml").unlink()
    assert len(read_motions(tmp_path).unusable) == 3


@pytest.mark.parametrize(
    ("name", "inside"), [("a/b.at2", "a/b.at2"), ("/etc/x", "etc/x"), ("../../x", "x"), ("..", "?"), ("/", "?")]
)
def test_no_name_in_an_archive_leads_out_of_it_and_none_is_empty(name, inside):
    assert str(archives._member_path(name)) == inside
