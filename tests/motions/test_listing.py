"""What `rockbatch motions` prints first: counts, what is missing by its reason, and stations, however many files there are."""

from motion_files import wiggle, write_at2

from rockbatch.commands.cli import main
from rockbatch.commands.motions import MOST_LINES


def many_files(folder, good, bad):
    for i in range(good):
        write_at2(
            folder, f"RSN{i + 1}_A_S{i:03d}000.AT2", wiggle(400, i, scale=0.3), title=f"Made-up, 1/17/1994, S{i}, 000"
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
