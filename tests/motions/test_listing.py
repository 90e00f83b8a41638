"""What `rockbatch motions` prints first: counts, what is missing by its reason, and stations, however many files there are."""

import numpy as np
import pytest
from archive_files import tarred, write_zip
from damaged_files import SAMPLES
from motion_files import at2_text, wiggle, write_at2
from waveform_files import channel_xml, station_xml, trace, write_mseed

from rockbatch.commands.cli import main
from rockbatch.commands.motions import MOST_LINES


def many_files(folder, good, bad):
    for i in range(good):
        write_at2(
            folder, f"RSN{i + 1}_A_S{i:03d}000.AT2", wiggle(150, i, scale=0.3), title=f"Made-up, 1/17/1994, S{i}, 000"
        )
    for i in range(bad):
        (folder / f"cut{i}.AT2").write_text("PEER\nx\ny\nNPTS= 400, DT= .01 SEC\n1 2\n", encoding="utf-8")


def test_of_many_files_counts_come_first_and_reasons_once(tmp_path, capsys):
    many_files(tmp_path / "records", 70, 50)
    assert main(["motions", str(tmp_path / "records")]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "120 files: 70 usable recordings of 70 stations, 50 not used, 0 left out"
    assert len(lines) <= MOST_LINES
    assert sum("50 ×: " in line for line in lines) == 1
    assert any(line.startswith("and ") and line.endswith("stations more") for line in lines)
    assert sum("cut" in line for line in lines) == 1


def test_files_are_counted_whose_names_differ_in_brackets(tmp_path, capsys):
    """As browsers name what is fetched twice."""
    for number in (1, 2):
        write_at2(
            tmp_path,
            f"RSN1_A_S000 ({number}).AT2",
            wiggle(150, number, scale=0.3),
            title=f"M, 1/17/1994, S{number}, 000",
        )
    main(["motions", str(tmp_path)])
    assert capsys.readouterr().out.startswith("2 files: ")


@pytest.mark.parametrize("folder", ["Imperial Valley, 1979", "a"])
def test_files_are_counted_whose_names_have_commas(tmp_path, capsys, folder):
    for i, label in enumerate(("000", "090", "UP"), 1):
        write_at2(tmp_path / folder, f"Kobe, Japan_{label}.AT2", wiggle(150, i, scale=0.3))
    main(["motions", str(tmp_path)])
    assert capsys.readouterr().out.startswith("3 files: ")


def test_all_lists_every_recording_and_every_file(tmp_path, capsys):
    many_files(tmp_path / "records", 20, 30)
    main(["motions", "--all", str(tmp_path / "records")])
    printed = capsys.readouterr().out
    assert printed.count("cut") >= 30
    assert all(f"RSN{i + 1}_" in printed for i in range(20))


def test_rare_reasons_stand_first(tmp_path, capsys):
    many_files(tmp_path / "records", 1, 5)
    (tmp_path / "records" / "empty.AT2").write_text("")
    main(["motions", str(tmp_path / "records")])
    counted = [line.split(" ×")[0].strip() for line in capsys.readouterr().out.splitlines() if " ×: " in line]
    assert counted[:2] == ["1", "5"]


def test_a_reason_of_three_channels_stands_once(tmp_path, capsys):
    for channel in ("HNN", "HNE", "HNZ"):
        write_mseed(tmp_path / f"{channel}.mseed", trace(channel))
    both = [channel_xml(channel, value=value) for channel in ("HNN", "HNE", "HNZ") for value in (2e5, 5e5)]
    station_xml(tmp_path, *both)
    assert main(["motions", str(tmp_path)]) == 1
    printed = capsys.readouterr().out
    assert printed.count("StationXML contradicts itself") == 1
    assert "3 ×: CI.LRL..HN" in printed


def test_a_folder_of_many_agencies_archives_and_junk_is_said_in_a_screen(tmp_path, capsys):
    """Eight agencies, as a project collects them: every record is used, wherever it lies, and each other file has its reason."""
    folder = tmp_path / "Aufzeichnungen Übung"
    agencies = ["K-NET/KiK-net", "GeoNet V1A/V2A", "COSMOS", "CSMIP", "USGS SMC", "UNAM", "MiniSEED", "PEER AT2"]
    for number, agency in enumerate(agencies):
        (folder / f"Behörde {number}").mkdir(parents=True)
        for name, content in SAMPLES[agency]:
            (folder / f"Behörde {number}" / name).write_bytes(content)
    packed = {
        f"RSN{i}_A_PACKED{i}000.AT2": at2_text(wiggle(300, i, scale=0.3), title=f"Made-up, 1/17/1994, P{i}, 000")
        for i in range(6)
    }
    names = list(packed)
    (folder / "archive").mkdir()
    (folder / "archive" / "a.tar.gz").write_bytes(tarred({name: packed[name] for name in names[:3]}, "w:gz"))
    inner = write_zip(tmp_path / "inner", {name: packed[name] for name in names[3:]})
    write_zip(folder / "archive" / "außen.zip", {"innen.zip": inner.read_bytes()})
    decimals = "\n".join(f"{0.01 * i:.2f};{value:.5f}".replace(".", ",") for i, value in enumerate(wiggle(400, 9)))
    (folder / "Messung.000.csv").write_text(f"Zeit [s];000 [m/s²]\n{decimals}\n", encoding="utf-8")
    for name in ("Thumbs.db", "Liste.xlsx", "Notizen.docx", "Skizze.png", "leer.txt"):
        (folder / name).write_bytes(b"" if name == "leer.txt" else b"PK\x03\x04")
    (folder / "kaputt.AT2").write_text("PEER\nx\ny\nNPTS= 400, DT= .01 SEC\n1 2\n")
    (folder / "Rauschen.dat").write_bytes(np.random.default_rng(1).bytes(2000))
    main(["motions", str(folder)])
    printed = capsys.readouterr().out
    assert len(printed.splitlines()) <= MOST_LINES
    assert "17 usable recordings of 11 stations, 3 not used, 11 left out" in printed.splitlines()[0]
    assert all(f"\nP{i} " in printed for i in range(6))
    for name in ("Messung ", "Behörde 6/x.mseed", "Rauschen.dat", "kaputt.AT2", "Liste.xlsx", "Thumbs.db"):
        assert name in printed
