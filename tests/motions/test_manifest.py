"""Manifests: what they add to records, what they override, and what is said about a bad one."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from agency_files import knet_text
from motion_files import wiggle, write_at2
from waveform_files import trace

from rockbatch.common.errors import InputError
from rockbatch.motions import Unusable, read_motions
from rockbatch.motions.manifest import Entry
from rockbatch.motions.manifest_draft import write_manifest


def title(component: str, station: str = "STA") -> str:
    return f"X, 1/17/1994, {station}, {component}"


def write_records(folder):
    write_at2(folder, "a000.AT2", wiggle(50, 1), title=title("000"))
    write_at2(folder, "a090.AT2", wiggle(50, 2), title=title("090"))
    write_at2(folder, "aup.AT2", wiggle(50, 3), title=title("UP"))


def motions_of(folder, **options):
    return {motion.name: motion for motion in read_motions(folder, gravity=10.0, **options).motions}


def problems_of(folder) -> list[str]:
    with pytest.raises(InputError) as caught:
        read_motions(folder)
    return [problem.removeprefix(str(folder) + "/") for problem in caught.value.messages]


def test_it_adds_what_files_do_not_say_and_overrides_what_they_say(tmp_path):
    write_records(tmp_path)
    before = motions_of(tmp_path)
    (tmp_path / "motions.toml").write_text("""
[[record]]
file = "a000.AT2"
azimuth = 12.5
unit = "m/s2"
scale = 2
polarity = "-"
magnitude = 6.7
distance_km = 6.5
[[record]]
file = "a090.AT2"
dt = 0.02
""")
    after = motions_of(tmp_path)
    changed = after["a000"]
    np.testing.assert_allclose(changed.horizontal, before["a000"].horizontal * (-2 / 10.0), rtol=1e-12)
    assert (changed.azimuth, changed.magnitude, changed.distance_km) == (12.5, 6.7, 6.5)
    assert changed.notes[:3] == (
        "unit m/s2 as motions.toml says, instead of G",
        "scaled by 2 as motions.toml says",
        "sign reversed as motions.toml says",
    )
    assert changed.notes[3:] == ()
    assert after["a090"].notes[0] == "dt = 0.02 s as motions.toml says, instead of 0.01 s"
    of_step = "a000.AT2 has as many samples with a step of 0.01 s, not 0.02 s: check which step is right"
    assert after["a090"].notes[-1] == of_step
    assert before["a000"].vertical_source == changed.vertical_source == "aup.AT2"


def test_a_component_can_be_made_vertical_and_a_station_given(tmp_path):
    write_at2(tmp_path, "one.AT2", wiggle(50, 1), title="nothing, 000")
    write_at2(tmp_path, "two.AT2", wiggle(50, 2), title="nothing, 000")
    (tmp_path / "motions.toml").write_text("""
[[record]]
file = "one.AT2"
station = "S"
[[record]]
file = "two.AT2"
station = "S"
role = "vertical"
polarity = "-"
""")
    (motion,) = motions_of(tmp_path).values()
    assert (motion.name, motion.vertical_source) == ("one", "two.AT2")
    np.testing.assert_allclose(motion.vertical, -10 * wiggle(50, 2), rtol=1e-6)


def test_a_unit_makes_a_file_usable_that_does_not_state_its_own(tmp_path):
    write_at2(tmp_path, "x.AT2", wiggle(50), unit="ACCELERATION")
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x.AT2"\nunit = "g"\n')
    (motion,) = motions_of(tmp_path).values()
    np.testing.assert_allclose(motion.horizontal, 10 * wiggle(50), rtol=1e-6)


def test_what_shall_not_be_used_is_left_out_and_is_no_fault(tmp_path):
    write_records(tmp_path)
    (tmp_path / "broken.AT2").write_text("no record")
    (tmp_path / "motions.toml").write_text(
        '[[record]]\nfile = "broken.AT2"\nuse = false\n[[record]]\nfile = "a090.AT2"\nuse = false\n'
    )
    found = read_motions(tmp_path)
    assert [motion.name for motion in found.motions] == ["a000"]
    assert not found.unusable
    assert [(f.source, f.reason) for f in found.left_out] == [
        ("a090.AT2", "use = false in motions.toml"),
        ("broken.AT2", "use = false in motions.toml"),
    ]


def test_one_component_of_a_file_can_be_meant(tmp_path):
    rows = "\n".join(f"{i / 100} {v} {2 * v} {3 * v}" for i, v in enumerate(wiggle(50, 1)))
    (tmp_path / "x.txt").write_text(f"# time(s) NS(g) EW(g) UD(g)\n{rows}\n")
    (tmp_path / "motions.toml").write_text(
        '[[record]]\nfile = "x.txt"\nmagnitude = 7\n'
        '[[record]]\nfile = "x.txt"\ncomponent = "NS"\nazimuth = 10\n'
        '[[record]]\nfile = "x.txt"\ncomponent = "EW"\nuse = false\n'
    )
    (motion,) = motions_of(tmp_path).values()
    assert (motion.azimuth, motion.magnitude) == (10.0, 7.0)
    assert motion.vertical is not None


def test_a_csv_says_the_same_also_as_excel_writes_it_where_decimals_have_commas(tmp_path):
    for folder, text in (
        ("comma", "file,station,azimuth,use,magnitude\na000.AT2,24,12.5,,6.7\na090.AT2,,,false,\n"),
        ("semicolon", "\ufefffile;station;azimuth;use;magnitude\r\na000.AT2;24;12,5;;6,7\r\na090.AT2;;;FALSE;\r\n"),
    ):
        write_records(tmp_path / folder)
        (tmp_path / folder / "motions.csv").write_text(text)
        (motion,) = motions_of(tmp_path / folder).values()
        assert (motion.name, motion.azimuth, motion.magnitude) == ("a000", 12.5, 6.7)
        assert motion.station == "STA 24"


@pytest.mark.parametrize(("given", "azimuth"), [("0", 0.0), ("359.5", 359.5), ("360", 0.0)])
def test_an_azimuth_of_360_is_north(tmp_path, given, azimuth):
    write_records(tmp_path)
    (tmp_path / "motions.toml").write_text(f'[[record]]\nfile = "a000.AT2"\nazimuth = {given}\n')
    assert motions_of(tmp_path)["a000"].azimuth == azimuth


def test_a_motions_csv_without_a_column_of_files_is_a_record(tmp_path):
    rows = "\n".join(f"{i / 100},{v}" for i, v in enumerate(wiggle(50)))
    (tmp_path / "motions.csv").write_text(f"time(s),NS(g)\n{rows}\n")
    assert list(motions_of(tmp_path)) == ["motions"]


def test_all_mistakes_are_one_error_with_their_lines(tmp_path):
    write_records(tmp_path)
    (tmp_path / "outside").mkdir()
    (tmp_path / "motions.toml").write_text("""\
title = "x"
[[record]]
file = "a00.AT2"
azimut = 3
[[record]]
azimuth = 400
[[record]]
file = "../a000.AT2"
[[record]]
file = "a000.AT2"
unit = "furlong"
scale = -1
role = "vertical"
azimuth = 3
[[record]]
file = "a000.AT2"
[[record]]
file = "aup.AT2"
azimuth = 3
component = "NS"
""")
    problems = problems_of(tmp_path)
    expected = [
        "motions.toml:1: title: unknown key; ",
        '3: [[record]] "a00.AT2": file = "a00.AT2": no such file in ',
        '4: [[record]] "a00.AT2": azimut: unknown key; did you mean azimuth?',
        "5: [[record]] no. 2: file is missing",
        "6: [[record]] no. 2: azimuth = 400: expected an azimuth within 0..360",
        '8: [[record]] "../a000.AT2": file = "../a000.AT2": lies outside this folder',
        '11: [[record]] "a000.AT2": unit = "furlong": expected one of g, ',
        '12: [[record]] "a000.AT2": scale = -1: expected a number above 0',
        '14: [[record]] "a000.AT2": azimuth: it is a vertical component',
        '16: [[record]] "a000.AT2": file = "a000.AT2": given twice',
        '20: [[record]] "aup.AT2": component = "NS": the file has "UP"; write one of these',
    ]
    assert len(problems) == len(expected)
    for problem, beginning in zip(problems, expected, strict=True):
        assert problem.removeprefix("motions.toml:").startswith(beginning.removeprefix("motions.toml:"))
    assert "did you mean a0" in problems[1]


def test_mistakes_in_a_csv_have_their_lines_too(tmp_path):
    write_records(tmp_path)
    (tmp_path / "motions.csv").write_text("file,azimut,scale\na000.AT2,,x\n\na09.AT2,,1,2\n")
    first, second, third, fourth = problems_of(tmp_path)
    assert first == 'motions.csv:1: "azimut": unknown column; did you mean azimuth?'
    assert second.startswith('motions.csv:2: [[record]] "a000.AT2": scale = "x": expected a number')
    assert third.startswith("motions.csv:4: found 4 cells; the first line names 3 columns")
    assert fourth.startswith('motions.csv:4: [[record]] "a09.AT2": file = "a09.AT2": no such file in ')
    (tmp_path / "motions.csv").write_text("file,zzz\na000.AT2,1\n")
    assert problems_of(tmp_path)[0].startswith('motions.csv:1: "zzz": unknown column; write one of file, ')


def test_counts_take_no_unit_and_two_components_no_single_azimuth(tmp_path):
    (tmp_path / "TST.EW").write_text(knet_text("E-W")[0])  # counts, with their scale in the header
    rows = "\n".join(f"{i / 100} {v} {2 * v}" for i, v in enumerate(wiggle(50, 1)))
    (tmp_path / "x.txt").write_text(f"# time(s) NS(g) EW(g)\n{rows}\n")
    (tmp_path / "motions.toml").write_text(
        '[[record]]\nfile = "TST.EW"\nunit = "g"\n[[record]]\nfile = "x.txt"\nazimuth = 3\n'
    )
    unit, azimuth = problems_of(tmp_path)
    assert "3: " in unit
    assert "unit: the file has a scale of its own" in unit
    assert 'azimuth: the file has 2 components; write component = "NS" with it' in azimuth


def test_a_manifest_beside_a_single_file_counts_and_one_below_governs_its_own_folder(tmp_path):
    write_records(tmp_path / "sub")
    (tmp_path / "sub" / "motions.toml").write_text('[[record]]\nfile = "a000.AT2"\nmagnitude = 6\n')
    assert motions_of(tmp_path)["a000"].magnitude == 6.0
    assert motions_of(tmp_path / "sub" / "a000.AT2")["a000"].magnitude == 6.0


def test_the_draft_changes_nothing_until_it_is_edited(tmp_path):
    write_records(tmp_path)
    write_at2(tmp_path / "deep", "RSN9_X_Y--L.AT2", wiggle(50, 4), title=title("L", "Zürich"))
    write_at2(tmp_path / "deep", "RSN9_X_Y--V.AT2", wiggle(50, 5), title=title("V", "ß, another header"))
    (tmp_path / "broken.AT2").write_text("no record")
    before = read_motions(tmp_path)
    draft = write_manifest(tmp_path)
    after = read_motions(tmp_path)
    assert [(m.name, m.vertical_source, m.notes) for m in after.motions] == [
        (m.name, m.vertical_source, m.notes) for m in before.motions
    ]
    assert after.unusable == before.unusable
    text = draft.read_text(encoding="utf-8")
    assert "# Not used: its suffix .AT2 says PEER AT2 or text columns" in text
    assert text.count("[[record]]\nfile") == 5
    assert "1/17/1994, ZÜRICH" in text


def test_the_draft_of_a_header_with_odd_characters_is_a_manifest(tmp_path):
    """DEL, which TOML does not allow in a text nor in a remark, and what a terminal would obey."""
    odd = "ST\x7fA\x1b[2J"
    write_at2(tmp_path, "a000.AT2", wiggle(50, 1), title=title("000", odd))
    write_at2(tmp_path, "b.AT2", wiggle(50, 2), title=title("090", odd))
    before = read_motions(tmp_path)
    text = write_manifest(tmp_path).read_text(encoding="utf-8")
    assert not set(text) & {"\x7f", "\x1b"}
    assert [motion.name for motion in read_motions(tmp_path).motions] == [motion.name for motion in before.motions]


def test_the_draft_has_a_line_for_each_unit_and_interval_that_a_file_lacks(tmp_path):
    """What is asked for is enough: with the lines filled in, every file is a record."""
    timed, plain, nothing = ([f"{value:.6f}" for value in wiggle(50, seed)] for seed in (1, 2, 3))
    (tmp_path / "timed_000.txt").write_text("".join(f"{i / 100} {value}\n" for i, value in enumerate(timed)))
    (tmp_path / "plain_000.acc").write_text("# unit: g\n" + "\n".join(plain) + "\n")
    (tmp_path / "nothing_000.acc").write_text("\n".join(nothing) + "\n")
    write_at2(tmp_path, "bare.AT2", wiggle(50, 4), unit="ACCELERATION TIME SERIES")
    trace("HNE", wiggle(300).astype(np.float32)).write(str(tmp_path / "e.sac"), format="SAC")
    assert len(read_motions(tmp_path).unusable) == 5
    draft = write_manifest(tmp_path)
    assert len(read_motions(tmp_path).unusable) == 5
    text = draft.read_text(encoding="utf-8")
    asked = '# unit =   # of its numbers: "g", "g/10", "m/s2", "cm/s2", "gal" or "mm/s2"\n'
    assert (text.count(asked), text.count("# dt =   # its sampling interval [s]\n")) == (4, 2)
    draft.write_text(text.replace("# unit =   #", 'unit = "g"   #').replace("# dt =   #", "dt = 0.01   #"))
    found = read_motions(tmp_path)
    assert not found.unusable
    peaks = {motion.name: motion.pga / 9.81 for motion in found.motions}
    assert set(peaks) == {"bare", "e", "nothing_000", "plain_000", "timed_000"}
    for seed, name in enumerate(("timed_000", "plain_000", "nothing_000", "bare"), start=1):
        assert peaks[name] == pytest.approx(np.abs(wiggle(50, seed)).max(), abs=1e-6)


def test_a_draft_is_never_written_over_a_manifest(tmp_path):
    write_records(tmp_path)
    for name in ("motions.toml", "motions.csv"):
        (tmp_path / name).write_text("file\n")
        with pytest.raises(InputError, match="is there already"):
            write_manifest(tmp_path)
        (tmp_path / name).unlink()
    with pytest.raises(InputError, match="a manifest is for a folder"):
        write_manifest(tmp_path / "a000.AT2")


@pytest.mark.slow
def test_mistakes_come_in_one_order_whatever_the_hashes_of_texts(tmp_path):
    """Sets of texts have another order in each process: messages must not."""
    (tmp_path / "x.csv").write_text("NS,EW\n" + "".join(f"{a:.5f},{a / 2:.5f}\n" for a in wiggle(50)))
    (tmp_path / "motions.csv").write_text("file,role,azimuth,unit,dt\nx.csv,horizontal,0,g,0.01\n")
    (tmp_path / "study.toml").write_text("[pier]\nalpha = 0.2\nsize_m = 900\ndeck_height_m = 900\ncolumns = 900\n")
    code = (
        "import sys; from rockbatch import InputError, read_motions, load_study\n"
        "for read, name in ((read_motions, '.'), (load_study, 'study.toml')):\n"
        "    try: read(name)\n"
        "    except InputError as error: print(error)\n"
    )

    def said(seed: int) -> str:
        environment = os.environ | {"PYTHONHASHSEED": str(seed)}
        return subprocess.run(
            [sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True
        ).stdout

    first = said(0)
    assert first.count("write component =") == 2
    assert said(1) == first


def test_an_entry_of_a_whole_file_is_for_none_of_its_components():
    without_number = Unusable("a", ("a.txt",), "it ends early")
    assert not Entry(Path("a.txt"), None, {}).is_for(without_number)
    assert Entry(Path("a.txt"), None, {"component": 2}).is_for(replace(without_number, number=2))
    assert not Entry(Path("a.txt"), None, {"component": 0}).is_for(without_number)
