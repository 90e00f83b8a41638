"""Layouts in which practitioners' programs write records, and advice that was tried before it is given."""

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from motion_files import wiggle

from rockbatch.common.errors import Unstated
from rockbatch.common.units import acceleration_factor
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.formats import read_record
from rockbatch.motions.sources.record_file import RecordFile

N, DT = 203, 0.005
A = np.round(wiggle(N, 1, 0.4), 6)
B, C = np.round(wiggle(N, 2, 0.3), 6), np.round(wiggle(N, 3, 0.2), 6)
T = np.round(DT * np.arange(N), 6)
HORIZONTAL = ReadOptions(role="horizontal")


def pairs(per_line: int, between: str = " ", end: str = "") -> str:
    words = [f"{t:.3f}{between}{a:.6f}" for t, a in zip(T, A, strict=True)]
    rows = [between.join(words[i : i + per_line]) + end for i in range(0, N, per_line)]
    return "\n".join(rows) + "\n"


def in_columns(*columns: np.ndarray, between: str = ",") -> str:
    return "".join(between.join(f"{value:.6f}" for value in row) + "\n" for row in zip(*columns, strict=True))


def read(folder: Path, text: str, name: str = "x.txt", options: ReadOptions = HORIZONTAL, **given):
    (folder / name).write_text(text)
    return read_motions(folder, options=options, gravity=1.0, **given)


def only(folder: Path, text: str, name: str = "x.txt", **stated):
    (motion,) = read(folder, text, name, ReadOptions(role="horizontal", **stated)).motions
    return motion


def why(folder: Path, text: str, name: str = "x.txt", **stated) -> str:
    (unusable,) = read(folder, text, name, ReadOptions(role="horizontal", **stated)).unusable
    return unusable.reason


def is_a(motion, dt: float = DT) -> bool:
    return motion.dt == dt and np.allclose(motion.horizontal, A, atol=1e-9)


# Pairs of time and value


@pytest.mark.parametrize("per_line", [1, 2, 3, 4, 5, 8])
@pytest.mark.parametrize(("between", "end"), [(" ", ""), ("  ", ""), (", ", ","), ("\t", "")])
def test_pairs_on_a_line_are_recognised_and_no_sample_is_lost(tmp_path, per_line, between, end):
    assert is_a(only(tmp_path, pairs(per_line, between, end), unit="g"))
    assert is_a(only(tmp_path, "EQ x\nAcceleration in g\n" + pairs(per_line, between, end)))
    assert is_a(only(tmp_path, pairs(per_line, between, end), unit="g", layout="wrapped"))


@pytest.mark.parametrize("sign", ["#", "%", " # ", "%%"])
@pytest.mark.parametrize("comment", ["", "0.5 0.6", "words", "words #", "words %"])
def test_comments_stand_anywhere_in_a_table(tmp_path, sign, comment):
    above, *rows = ("time(s) NS(g)\n" + in_columns(T, A)).splitlines()
    for place in (0, 1, 50, len(rows)):
        lines = [above, *rows[:place], f"{sign}{comment}", *rows[place:]]
        assert is_a(only(tmp_path, "\n".join(lines)))


@pytest.mark.parametrize("line", ["words", "words #", "0.5 0.6 %"])
def test_other_lines_in_a_table_are_refused_whatever_they_end_with(tmp_path, line):
    above, *rows = ("time(s) NS(g)\n" + in_columns(T, A)).splitlines()
    found = read(tmp_path, "\n".join([above, *rows[:50], line, *rows[50:]]))
    assert "line 52: found" in found.unusable[0].reason


def test_an_amplitude_of_abaqus_is_read(tmp_path):
    text = f"*Amplitude, name=EQ, definition=TABULAR\n{pairs(4, ', ', ',')}** end of amplitude\n"
    assert is_a(only(tmp_path, text, "eq.inp", unit="g"))


def test_columns_that_are_no_pairs_stay_columns(tmp_path):
    found = read(tmp_path, "time(s),NS(g),time(s),EW(g)\n" + in_columns(T, A, T + DT, B))
    assert "2 columns of time that differ" in found.unusable[0].reason
    first, second = read(tmp_path, "time(s),NS(g),time(s),EW(g)\n" + in_columns(T, A, T, B)).motions
    assert is_a(first)
    np.testing.assert_allclose(second.horizontal, B, atol=1e-9)
    found = read(tmp_path, "time(s),NS(g),EW(g),UD(g)\n" + in_columns(T, A, B, C))
    assert len(found.motions) == 2


# Counts above the numbers


@pytest.mark.parametrize(
    "text",
    [
        f"{N} {DT}\n{pairs(1)}",
        f"{DT} {N}\n{pairs(1)}",
        f"{N}\n{pairs(1)}",
        f"{N}\n{DT}\n{pairs(4)}",
        f"{N} {DT}\n{pairs(3)}",
        f"Motion of a program\n{N} {DT}\n{pairs(1, chr(9))}",
        f"title\n{N}, {DT} NPTS, DT\n" + "\n".join(" ".join(map(str, A[i : i + 6])) for i in range(0, N, 6)),
        f"title\n{N} {DT} 0\n" + "\n".join(" ".join(map(str, A[i : i + 5])) for i in range(0, N, 5)),
    ],
)
def test_count_and_step_above_pairs_or_samples_are_understood(tmp_path, text):
    assert is_a(only(tmp_path, text, unit="g"))


def test_a_count_above_pairs_that_is_another_one_is_refused(tmp_path):
    assert f"the header says {N + 1} samples" in why(tmp_path, f"{N + 1} {DT}\n{pairs(1)}", unit="g")


def test_a_step_with_a_point_may_stand_above_decimal_commas(tmp_path):
    rows = in_columns(A, B, between=" ").replace(".", ",")
    options = ReadOptions(unit="g", columns=("000", "090"))
    assert is_a(read(tmp_path, f"{N} {DT}\n{rows}", options=options).motions[0])


# Headers


@pytest.mark.parametrize(
    "head",
    [
        "Time,NS,EW,UD\ns,g,g,g",
        "Time,NS,EW,UD\n(s),(g),(g),(g)",
        "time NS EW UD\n[sec] [g] [g] [g]",
        "# t;N-S;E-W;U-D\n# s;g;g;g",
        "sec,g,g,g\nTime,North,East,Up",
        ",time (s),NS (g),EW (g),UD (g)",
        '"","time (s)","NS (g)","EW (g)","UD (g)"',
        "Unnamed: 0,time [s],NS [g],EW [g],UD [g]",
        "index,t,NS,EW,UD\n,s,g,g,g",
        "No.;t (s);NS (g);EW (g);UD (g)",
    ],
)
@pytest.mark.parametrize("first", [0, 1])
def test_a_row_of_units_and_a_column_that_counts_rows_are_understood(tmp_path, head, first):
    between = ";" if ";" in head else "," if "," in head else " "
    counted = re.match(r'^("",|,|Unnamed|index|No)', head) is not None
    columns = [np.arange(N) + first] * counted + [T, A, B, C]
    found = read(tmp_path, head + "\n" + in_columns(*columns, between=between), "x.csv")
    assert [motion.azimuth for motion in found.motions] == [0.0, 90.0]
    assert is_a(found.motions[0])
    assert found.motions[0].vertical == pytest.approx(C)


def test_a_nameless_first_column_that_grows_as_time_does_is_time(tmp_path):
    (motion,) = read(tmp_path, ",NS (g)\n" + in_columns(T, A), "x.csv").motions
    assert is_a(motion)


@pytest.mark.parametrize(
    ("unit", "in_g"),
    [
        ("in/s2", 9.81 / 0.0254), ("in/sec^2", 9.81 / 0.0254), ("inch/s/s", 9.81 / 0.0254), ("ft/s2", 9.81 / 0.3048),
        ("ft/sec**2", 9.81 / 0.3048), ("feet/s²", 9.81 / 0.3048), ("mg", 1000.0), ("milli-g", 1000.0), ("%g", 100.0),
        ("mGal", 981000.0), ("Gals", 981.0), ("m·s⁻²", 9.81), ("g's", 1.0), ("µg", 1e6), ("cm/seg²", 981.0),
    ],
)  # fmt: skip
def test_units_of_other_trades_are_understood(tmp_path, unit, in_g):
    assert acceleration_factor(unit) * in_g == pytest.approx(9.81, rel=1e-12)
    (tmp_path / "x.csv").write_text(f"t (s),NS ({unit})\n" + in_columns(T, in_g * A))
    (motion,) = read_motions(tmp_path).motions
    assert motion.pga_g == pytest.approx(np.abs(A).max(), rel=1e-4)


@pytest.mark.parametrize(
    "header",
    [
        "Zeit;NS;EW;UD\nSekunden;g's;g's;g's",
        "Zeit [Sekunden];NS [g's];EW [g's];UD [g's]",
        "Zeit (Sek.);NS (g);EW (g);UD (g)",
        "Unit: g\nTiempo en segundos;NS;EW;UD",
        "Unit: g\nSekunden;NS;EW;UD",
        "時間(秒);NS(G);EW(G);UD(G)",
    ],
)
def test_seconds_are_known_in_the_languages_of_directions(tmp_path, header):
    first, second = read(tmp_path, f"{header}\n{in_columns(T, A, B, C, between=';')}", options=ReadOptions()).motions
    assert is_a(first)
    assert (first.azimuth, second.azimuth) == (0.0, 90.0)
    assert first.vertical == pytest.approx(C)


def test_the_header_of_a_matched_record_has_its_unit_beside_other_words_in_brackets(tmp_path):
    head = "Matched\n#Misfit: 0.12\nFile Type: Accelerations (g)\n#Identifier:  Final (Baseline Corrected)\n"
    text = f"{head}NPTS = {N} , DT = {DT} SEC\n" + in_columns(A)
    assert is_a(only(tmp_path, text, "x.acc"))
    assert not read(tmp_path, text, "x.acc", ReadOptions()).motions  # nothing says its direction


def test_a_unit_that_nobody_knows_is_asked_for_and_can_be_stated(tmp_path):
    text = "time(s) NS(furlong/s2)\n" + in_columns(T, A, between=" ")
    assert 'the unit "furlong/s2" is not known; write unit = "g"' in why(tmp_path, text)
    assert is_a(only(tmp_path, text, unit="g"))


MIDAS = "*SGSw\n*TITLE, x\n*X-AXIS, Time (sec)\n*Y-AXIS, Ground Accel. (g)\n*UNIT&TYPE, {}\n*FLAGS, 0, 0\n*DATA\n{}*ENDDATA\n"


def test_a_record_file_of_midas_is_read_by_its_unit_and_type(tmp_path):
    assert is_a(only(tmp_path, MIDAS.format("GRAV, ACCEL", in_columns(T, A)), "x.sgs"))
    motion = only(tmp_path, MIDAS.format("MM, ACCEL", in_columns(T, 1000.0 * A)), "x.sgs")
    assert motion.horizontal == pytest.approx(A)
    assert "expected accelerations" in why(tmp_path, MIDAS.format("CM, VEL", in_columns(T, A)), "x.sgs")


@pytest.mark.parametrize(
    "mark",
    [
        "*** End Data ***",
        "*** End",
        "*ENDDATA",
        "END",
        "End of file",
        "EOF",
        "<EOF>",
        "#end",
        "# End of data",
        "$END",
        "[End]",
        "- end -",
        "/&  ---- End of Data ----",
        "----- end -----\n\n",
        "*",
    ],
)
@pytest.mark.parametrize("kind", ["AT2", "columns"])
def test_marks_at_the_end_are_no_numbers(tmp_path, mark, kind):
    head = f"x\ny\nunits of g\nNPTS= {N}, DT= {DT} SEC\n" if kind == "AT2" else "t(s),N(g)\n"
    body = in_columns(A) if kind == "AT2" else in_columns(T, A)
    assert is_a(only(tmp_path, f"{head}{body}{mark}\n", "x.at2" if kind == "AT2" else "x.txt"))


def test_words_within_the_numbers_and_other_words_behind_them_are_still_refused(tmp_path):
    lines = in_columns(T, A).splitlines()
    for wrong in ([*lines[:50], "*** End", *lines[50:]], [*lines, "PGA = 0.4 g"], [*lines, "-inf"]):
        assert "found " in why(tmp_path, "t(s),N(g)\n" + "\n".join(wrong) + "\n")


@pytest.mark.parametrize(
    ("first", "start"),
    [
        ("2023-02-06T01:17:35.{:03d}Z", 1675646255.0),
        ("2023-02-06 01:17:35.{:03d}", None),
        ("2023/02/06T03:17:35,{:03d}+02:00", 1675646255.0),
        ("01:17:35.{:03d}", None),
        ("06.02.2023 01:17:35.{:03d}", None),
        ("6/2/2023 1:17:35.{:03d}", None),
        ("06-Feb-23 01:17:35,{:03d}Z", None),
    ],
)
@pytest.mark.parametrize("head", ["time;N (g)", ";N (g)", "timestamp;N (g)"])
@pytest.mark.parametrize("point", [".", ","])
def test_clock_times_are_seconds_after_the_first(tmp_path, first, start, head, point):
    rows = "".join(f"{first.format(5 * i)};" + f"{a:.6f}\n".replace(".", point) for i, a in enumerate(A[:190]))
    (motion,) = read(tmp_path, f"{head}\n{rows}", "x.csv").motions
    assert (motion.dt, motion.npts, motion.start) == (DT, 190, start)
    assert motion.horizontal == pytest.approx(A[:190])


@pytest.mark.parametrize(
    ("between", "point"), [("\t", ","), (" ", ","), ("; ", ","), (", ", "."), (" , ", "."), (" ", ".")]
)
def test_clock_times_stand_between_any_separators(tmp_path, between, point):
    columns = zip(*np.round([A, B, C], 6)[:, :190], strict=True)
    rows = [
        [f"01:17:35{point}{5 * i:03d}", *(f"{a:.6f}".replace(".", point) for a in row)] for i, row in enumerate(columns)
    ]
    lines = [["t", "NS(g)", "EW(g)", "UD(g)"], *rows]
    first, _ = read(tmp_path, "".join(between.join(row) + "\n" for row in lines), options=ReadOptions()).motions
    assert (first.dt, first.npts) == (DT, 190)
    assert first.horizontal == pytest.approx(A[:190])


@pytest.mark.parametrize("digits", [3, 6, 9])
def test_seconds_since_1970_have_the_step_of_those_after_the_first(tmp_path, digits):
    rows = "".join(f"{1675646255.0 + t:.{digits}f},{a:.6f}\n" for t, a in zip(T, A, strict=True))
    assert is_a(only(tmp_path, f"time,N (g)\n{rows}"))


def test_clock_times_go_on_after_midnight_and_may_stand_behind_a_count(tmp_path):
    clock = [f"{(23 * 3600 + 59 * 60 + 59 + i // 2) // 3600 % 24:02d}:{(59 if i < 2 else 0):02d}:" for i in range(6)]
    seconds = ["59.0", "59.5", "00.0", "00.5", "01.0", "01.5"]
    rows = "".join(f"{i},{c}{s},{a}\n" for i, (c, s, a) in enumerate(zip(clock, seconds, A[60:66], strict=True)))
    (motion,) = read(tmp_path, ",time,N (g)\n" + rows, "x.csv").motions
    assert (motion.dt, motion.npts) == (0.5, 6)


# FEMA P-695


def p695(folder: Path, number: int, count: int = N, called: str = "SortedEQFile") -> None:
    (folder / f"{called}_({number}).txt").write_text("".join(f"{a:.6e}\n" for a in A))
    (folder / f"DtFile_({number}).txt").write_text(f"{DT}\n")
    (folder / f"NumPointsFile_({number}).txt").write_text(f"{count}\n")


def test_the_text_files_of_fema_p695_have_step_and_count_beside_them(tmp_path):
    p695(tmp_path, 120711)
    p695(tmp_path, 120712)
    found = read_motions(tmp_path, options=ReadOptions(unit="g", role="horizontal"), gravity=1.0)
    assert not found.unusable
    assert len(found.left_out) == 5  # two of each, and the second record, a copy of the first
    assert is_a(found.motions[0])
    p695(tmp_path, 120711, count=N + 1)
    reasons = [one.reason for one in read_motions(tmp_path, options=ReadOptions(unit="g", role="horizontal")).unusable]
    assert any(f"says {N + 1} samples" in reason for reason in reasons)


@pytest.mark.parametrize("called", ["EQFile", "EQ_File", "SortedEQ_File"])
def test_the_record_of_a_step_file_may_be_spelt_in_other_ways(tmp_path, called):
    p695(tmp_path, 120711, called=called)
    found = read_motions(tmp_path, options=ReadOptions(unit="g", role="horizontal"), gravity=1.0)
    assert is_a(found.motions[0])
    assert [left.reason for left in found.left_out] == [f"no record: a statement about {called}_(120711).txt"] * 2


def test_a_step_without_its_record_is_no_statement(tmp_path):
    (tmp_path / "DtFile_(1).txt").write_text("0.01\n")
    assert "one row of numbers" in read_motions(tmp_path).unusable[0].reason


# Advice


def advised_of(text: str, name: str = "x.txt") -> Unstated:
    with pytest.raises(Unstated) as error:
        read_record(RecordFile(Path(name), name, text.encode()))
    return error.value


@pytest.mark.parametrize(
    "text",
    [
        in_columns(A),
        in_columns(T, A),
        in_columns(T, A, B, C),
        in_columns(A, B, C),
        in_columns(T, A, B, C, A, B),
        "\n".join(" ".join(f"{a:.6f}" for a in A[i : i + 8]) for i in range(0, N, 8)),
        pairs(4),
        "t,NS\n" + in_columns(T, A),
    ],
)
def test_what_a_message_tells_to_write_into_a_manifest_makes_a_record_of_the_file(tmp_path, text):
    message = str(advised_of(text))
    (tmp_path / "x.txt").write_text(text)
    advice = message.partition("; write ")[2].partition(" under [motions]")[0]
    assert advice
    for choice in advice.split(", or "):
        lines = dict(re.findall(r'(unit|dt|layout|columns) = (\[[^]]*\]|"[^"]*"|…)', choice))
        lines["dt"] = "0.005" if "dt" in lines else ""
        stated = "".join(f"{key} = {value}\n" for key, value in lines.items() if value)
        tomllib.loads(stated)
        (tmp_path / "motions.toml").write_text(f'[[record]]\nfile = "x.txt"\n{stated}')
        (tmp_path / "motions.toml").write_text(f'[[record]]\nfile = "x.txt"\n{stated}')
        found = read_motions(tmp_path, options=HORIZONTAL)
        assert found.motions, (stated, found.unusable)


def test_no_unit_is_advised_that_makes_no_earthquake_of_the_numbers():
    assert 'unit = "g" (PGA' in str(advised_of(in_columns(T, A)))
    assert "cm/s2" not in str(advised_of(in_columns(T, A)))
    assert 'unit = "cm/s2" (PGA' in str(advised_of(in_columns(T, 981.0 * A)))


@pytest.mark.parametrize(
    ("header", "columns", "pga"),
    [
        ("t (s), NS (cm/s2), EW, UD (cm/s2)", (98.1 * A, 0.5 * B, 98.1 * C), 0.5 * np.abs(B).max()),
        ("t (s), NS, EW (mg), UD", (0.5 * A, 1000.0 * B, 0.0 * C), 0.5 * np.abs(A).max()),
    ],
)
def test_a_unit_is_advised_by_the_peak_of_the_columns_that_state_none(tmp_path, header, columns, pga):
    text = f"{header}\n{in_columns(T, *columns)}"
    refused = why(tmp_path, text)
    assert f'write unit = "g" (PGA {pga:.2g} g)' in refused
    assert "in motions.toml, it would replace the units of its other columns, too" in refused
    advised = [m.pga for m in read(tmp_path, text, options=ReadOptions(unit="g")).motions]
    assert pytest.approx(pga, rel=1e-3) in advised


def test_nothing_is_advised_that_makes_no_record():
    cut = f"# NPTS = {N + 30}, dt = 0.005\n" + "\n".join(
        " ".join(f"{a:.6f}" for a in A[i : i + 8]) for i in range(0, N, 8)
    )
    message = str(advised_of(cut))
    assert "write layout" not in message
    assert "makes no record of it" in message


def test_columns_of_one_file_may_be_stated_in_its_manifest(tmp_path):
    (tmp_path / "x.txt").write_text(in_columns(T, A, B, C))
    stated = 'columns = ["time", "010", "-", "up"]\nunit = "g"\n'
    (tmp_path / "motions.toml").write_text(f'[[record]]\nfile = "x.txt"\n{stated}')
    (motion,) = read_motions(tmp_path, gravity=1.0).motions
    assert (motion.azimuth, motion.vertical is not None) == (10.0, True)
    assert is_a(motion)


# Velocities, displacements and counts


@pytest.mark.parametrize("unit", ["cm/s", "M/S", "mm", "Counts", "V"])
def test_a_unit_of_another_quantity_gives_way_to_a_manifest_only(tmp_path, unit):
    for text in (
        f"time (s),NS ({unit}),UD ({unit})\n" + in_columns(T, A, C),
        f"unit: {unit}\nDT = 0.005 s\n" + in_columns(A),
    ):
        reason = why(tmp_path, text, unit="g")
        assert f"numbers in {unit}, and accelerations are expected" in reason
        assert "write unit = … for this file in motions.toml" in reason
        (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x.txt"\nunit = "g"\n')
        assert is_a(read(tmp_path, text).motions[0])
        (tmp_path / "motions.toml").unlink()


@pytest.mark.parametrize(
    "line", ["Velocity time history", "Velocity record", "Displacement data", "Data type: velocity", "velocity"]
)
def test_a_header_of_velocities_above_bare_numbers_is_no_record(tmp_path, line):
    text = f"Station X, 000\n{line}\nDT = 0.005 s\n" + in_columns(A)
    assert "holds no accelerations" in why(tmp_path, text, unit="g")
    assert is_a(only(tmp_path, text.replace(line, "Shear wave velocity: 360 m/s"), unit="g"))
    assert is_a(only(tmp_path, text.replace("X, 000", "Acceleration"), unit="g"))


@pytest.mark.parametrize(
    "line",
    [
        "Shear wave velocity in top 30 m: 300 m/s",
        "baseline corrected; displacement time history ends at zero",
        "Initial velocity (m/s): 0",
        "Peak velocity (cm/s) = 31",
        "Event type: displacement on strike-slip fault",
    ],
)
def test_a_velocity_in_a_comment_is_none_of_the_samples(tmp_path, line):
    for unit in ("unit: g\n", ""):
        assert is_a(only(tmp_path, f"Station X, 000\n{unit}{line}\nDT = 0.005 s\n{in_columns(A)}", unit="g"))


@pytest.mark.parametrize(
    ("acc", "vel", "disp"),
    [
        ("S_000_acc", "S_000_vel", "S_000_disp"),
        ("acc_000", "velocity_000", "displacement_000"),
        ("S052_A", "S052_V", "S052_D"),
        ("s052a", "s052v", "s052d"),
    ],
)
def test_files_called_velocity_and_displacement_beside_a_record_are_left_out(tmp_path, acc, vel, disp):
    for name, values in ((acc, A), (vel, B), (disp, C)):
        (tmp_path / f"{name}.txt").write_text(in_columns(values))
    found = read_motions(tmp_path, options=ReadOptions(unit="g", dt=DT, role="horizontal"), gravity=1.0)
    assert is_a(*found.motions)
    assert not found.motions[0].vertical_source
    assert {file.source: file.reason for file in found.left_out} == {
        f"{vel}.txt": "no record: the velocity of a record",
        f"{disp}.txt": "no record: the displacement of a record",
    }


def test_a_letter_v_without_a_and_d_beside_it_is_vertical(tmp_path):
    for name, values in (("S052_L", A), ("S052_V", B), ("S052_T", C)):
        (tmp_path / f"{name}.txt").write_text(in_columns(values))
    found = read_motions(tmp_path, options=ReadOptions(unit="g", dt=DT), gravity=1.0)
    assert [m.vertical_source for m in found.motions] == ["S052_V.txt"] * 2


@pytest.mark.parametrize(
    "heads",
    ["t a v d", "T A V D", "time acc vel dis", "t acc velocidad desplazamiento", "t(s) a_N(g) v_N(cm/s) d_N(cm)"],
)
def test_columns_of_velocity_and_displacement_beside_an_acceleration_are_left_out(tmp_path, heads):
    motion = only(tmp_path, heads + "\n" + in_columns(T, A, B, C, between=" "), unit="g")
    assert is_a(motion)
    assert motion.vertical is None
    assert sum("left out" in note for note in motion.notes) == 2


# What services and agencies write above their numbers


def clock(i: int) -> str:
    return f"2023-02-06T01:17:{35 + DT * i:09.6f}"


@pytest.mark.parametrize("kind", ["TSPAIR", "SLIST", "GeoCSV", "JMA", "anc"])
def test_headers_of_services_and_agencies_state_unit_step_and_count(tmp_path, kind):
    head = f"TIMESERIES XX_S__HNE_D, {N} samples, 200 sps, 2023-02-06T01:17:35.000000, {kind}, FLOAT, CM/S**2\n"
    words = [f"{a:+.6e}" for a in A]
    times = "".join(f"{clock(i)}{{}}{a:.6f}\n" for i, a in enumerate(A))
    text = {
        "TSPAIR": head + times.replace("{}", "  "),
        "SLIST": head + "".join("\t".join(words[i : i + 6]) + "\n" for i in range(0, N, 6)),
        "GeoCSV": f"# dataset: GeoCSV 2.0\n# field_unit: UTC, CM/S**2\n# sample_count: {N}\n# sample_rate_hz: 200.0\n"
        f"Time, Sample\n{times.replace('{}', ', ')}",
        "JMA": f"SITE CODE= 47891\n SAMPLING RATE= 200Hz\n UNIT  = gal(cm/s/s)\n NS, UD\n{in_columns(A, B)}",
        "anc": f"INTERVALO DE MUESTREO (SEGUNDOS): 0.005\nNUMERO DE DATOS: {N}\nUNIDADES: cm/s^2\n EW  VER\n"
        + in_columns(A, B, between=" "),
    }[kind]
    motion = only(tmp_path, text)
    assert motion.dt == DT
    assert np.allclose(motion.horizontal, A / 100, atol=1e-8)


@pytest.mark.parametrize(
    ("line", "azimuth", "vertical"),
    [
        ("Component: VERTICAL", None, True),
        ("Component : N 12 E", 12.0, False),
        ("Channel = HNZ", None, True),
        ("Azimuth: 12", 12.0, False),
        ("Componente: Vertical", None, True),
        ("Direction: Up", None, True),
        ("Direção: L-O", 90.0, False),
        ("DIR: E", 90.0, False),
        ("Azimuth (deg): 12", 12.0, False),
        ("方向：NS", 0.0, False),
        ("Component\tN-S", 0.0, False),
        ("Station: ABC, Component: N-S; Recorder: K2", 0.0, False),
        ("Component: H1, Azimuth: 345", 345.0, False),
        ("Station: ABC, Channel: HNE, Azimuth: 102", 102.0, False),
        ("Component: N   Azimuth: 345", 345.0, False),
        ("Azimuth: 0, Component: UP", None, True),
        ("Компонента: Вертикальная", None, True),
    ],
)
@pytest.mark.parametrize("heads", ["time (s), acc (g)", "Acceleration in g"])
def test_a_line_of_the_header_tells_the_direction_of_an_only_column(tmp_path, line, azimuth, vertical, heads):
    (component,) = read_record(RecordFile(Path("x.txt"), "x.txt", f"{line}\n{heads}\n{in_columns(T, A)}".encode()))
    assert (component.orientation.vertical, component.orientation.azimuth) == (vertical, azimuth)


@pytest.mark.parametrize(
    ("line", "azimuth", "held"),
    [
        ("Component: N, Azimuth: 345", 345.0, ()),
        ("Component: H1, Azimuth: 345", 345.0, ()),
        ("Component: N, Azimuth: 90", None, ('its header says "90 deg"', 'its header says "N"')),
        ("Component: UP, Azimuth: 12", None, ('its header says "UP"', 'its header says "12 deg"')),
    ],
)
@pytest.mark.parametrize("columns", [(A,), (T, A)])
def test_the_azimuth_in_a_header_is_compared_with_other_directions(tmp_path, line, azimuth, held, columns):
    found = read(tmp_path, f"{line}\nAcceleration in g\ndt = {DT}\n{in_columns(*columns)}")
    assert [motion.azimuth for motion in found.motions] == [azimuth] * (not held)
    assert len(found.unusable) == bool(held)
    assert all(words in unusable.reason for unusable in found.unusable for words in held)


def test_a_vertical_by_its_header_under_a_horizontal_name_is_held_back(tmp_path):
    (tmp_path / "x_090.txt").write_text(f"Component: UP\ntime (s), acc (g)\n{in_columns(T, A)}")
    (refused,) = read_motions(tmp_path).unusable
    assert 'its header says "UP", but its file is called "x_090.txt"' in refused.reason
    (tmp_path / "x_090.txt").write_text(f"Component: 3\ntime (s), acc (g)\n{in_columns(T, A)}")
    assert read_motions(tmp_path).motions[0].azimuth == 90.0


# Time in another place, and columns that are none


@pytest.mark.parametrize("per_line", [1, 3, 4])
def test_pairs_with_the_value_first_are_recognised(tmp_path, per_line):
    words = [f"{a:.6f} {t:.3f}" for t, a in zip(T, A, strict=True)]
    text = "".join(" ".join(words[i : i + per_line]) + "\n" for i in range(0, N, per_line))
    assert is_a(only(tmp_path, text, unit="g"))


@pytest.mark.parametrize("first", [0, 1])
def test_a_column_that_grows_by_one_is_not_taken_for_seconds(tmp_path, first):
    text = "".join(f"{i + first} {a:.6f}\n" for i, a in enumerate(A))
    assert 'columns = ["-", "000"]' in why(tmp_path, text, unit="g")
    assert is_a(only(tmp_path, text, unit="g", columns=("-", "000"), dt=DT))
    assert only(tmp_path, text, unit="g", columns=("time", "000")).dt == 1.0
    text = in_columns(np.arange(N) + first, A, B, C, between=" ")
    assert 'columns = ["-", "000", "090", "up"]' in why(tmp_path, text, unit="g")


def test_the_column_of_time_is_advised_where_it_stands(tmp_path):
    reason = why(tmp_path, in_columns(A, B, C, T, between=" "), unit="g")
    assert 'write columns = ["000", "090", "up", "time"] if these' in reason
    assert ",," not in why(tmp_path, in_columns(A, B, C, between=" "), unit="g")


# What headers state of the numbers


@pytest.mark.parametrize(
    "line",
    ["Scale factor: 0.5", "scale_factor = 0.5", "Factor de escala 0.5", "Acceleration in g x 0.5", "Scaling factor=.5"],
)
def test_a_factor_in_the_header_is_asked_for_and_a_manifest_answers(tmp_path, line):
    text = f"{line}\nunits: g\nDT = 0.005 s\n{in_columns(A)}"
    reason = why(tmp_path, text)
    assert "write scale = … with this factor" in reason  # reasons of several files are shown by the first one
    for factor in (0.5, 1.0):
        (tmp_path / "motions.toml").write_text(f'[[record]]\nfile = "x.txt"\nscale = {factor}\n')
        (motion,) = read(tmp_path, text).motions
        assert np.allclose(motion.horizontal, factor * A, atol=1e-9)
    (tmp_path / "motions.toml").unlink()
    for applied in ("0.5", ".5"):
        text = text.replace(applied, "1.0") if applied in line else text
    assert is_a(only(tmp_path, text))


@pytest.mark.parametrize(
    "line",
    [
        "Conversion factor: 980.665 cm/s2 per g",
        "Instrument scale factor = 1.2345 V/g",
        "acceleration in g x 9.81 m/s2",
        "Target PGA = 0.5 g",
        "Arias intensity: 1.2 m/s, duration: 8.2 s",
    ],
)
def test_constants_and_targets_of_a_header_say_nothing_of_its_samples(tmp_path, line):
    motion = only(tmp_path, f"{line}\nunits: g\nDT = 0.005 s\n{in_columns(A)}")
    assert is_a(motion)
    assert not {finding.what for finding in motion.findings} & {"peak", "duration"}


@pytest.mark.parametrize("line", ["unit: 0.1 g", "acceleration in units of 0.1 g"])
def test_a_share_of_g_is_a_unit_of_a_table(tmp_path, line):
    assert is_a(only(tmp_path, f"{line}\nDT = 0.005 s\n{in_columns(10.0 * A)}"))


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("PGA (g): 0.72", "peak"),
        ("PGA: 72 cm/s2", "peak"),
        ("Peak acceleration = -0.72 g", "peak"),
        ("Max. acc. = 0.72", "peak"),
        ("Duration (s): 2.03", "duration"),
        ("Record length = 2.03 sec", "duration"),
    ],
)
def test_a_peak_and_a_duration_in_the_header_are_compared_with_the_samples(tmp_path, line, what):
    text = f"{line}\nunits: g\nDT = 0.005 s\n{in_columns(A)}"
    assert [finding.what for finding in only(tmp_path, text).findings] == [what]
    right = text.replace("0.72", "0.36").replace("72 cm", "36 cm").replace("2.03", "1.015")
    assert only(tmp_path, right).findings == ()


def test_a_manifest_s_step_is_believed_before_the_header_s(tmp_path):
    text = f"INTERVALO DE MUESTREO (SEGUNDOS): 200\nunits: g\n{in_columns(A)}"
    assert "a sampling interval of 200 s" in why(tmp_path, text)
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x.txt"\ndt = 0.005\n')
    assert is_a(read(tmp_path, text).motions[0])


def test_columns_of_several_stations_in_one_file_are_told_apart_by_their_names(tmp_path):
    heads = ",".join(f"{station}_{way} (g)" for station in ("AAA", "BBB") for way in ("HNE", "HNN", "HNZ"))
    values = [np.round(wiggle(N, seed, 0.3), 6) for seed in range(11, 17)]
    found = read(tmp_path, f"time (s),{heads}\n{in_columns(T, *values)}")
    assert [(m.of_station, m.vertical_source) for m in found.motions] == [
        *[("AAA", "x.txt (AAA_HNZ)")] * 2,
        *[("BBB", "x.txt (BBB_HNZ)")] * 2,
    ]
    found = read(tmp_path, f"time (s),{heads.replace('BBB', 'AAA')}\n{in_columns(T, *values)}")
    assert not found.motions  # one direction twice of one station


@pytest.mark.parametrize(("one", "other"), [("raw", "corrected"), ("acc", "acc2")])
def test_columns_of_one_sensor_twice_contradict_each_other(tmp_path, one, other):
    heads = ",".join(f"{name}_{way} (g)" for name in (one, other) for way in "NE")
    drift = np.linspace(0.0, 0.01, N)
    found = read(tmp_path, f"time (s),{heads}\n{in_columns(T, A, B, A + drift, B - drift)}")
    assert not found.motions


@pytest.mark.parametrize(
    ("sites", "used"),
    [(("COL", "KEM"), 2), (("KEM", "PIER"), 2), (("KEM", "DECK"), 1), (("PIER", "DECK"), 0), (("FF", "COL"), 1)],
)
def test_words_for_structures_are_codes_of_stations_beside_other_codes(tmp_path, sites, used):
    heads = ",".join(f"{site}_{way} (g)" for site in sites for way in "NE")
    values = [np.round(wiggle(N, seed, 0.3), 6) for seed in range(31, 35)]
    found = read(tmp_path, f"time (s),{heads}\n{in_columns(T, *values)}")
    assert len({motion.of_station for motion in found.motions}) == used
    assert all("is in a structure" in file.reason for file in found.unusable)


def test_the_roof_beside_the_base_in_one_file_is_held_back(tmp_path):
    heads = ",".join(f"{name}_{way} (g)" for name in ("base", "roof") for way in "NE")
    values = [np.round(wiggle(N, seed, 0.3), 6) for seed in range(21, 25)]
    found = read(tmp_path, f"time (s),{heads}\n{in_columns(T, *values)}")
    assert {motion.of_station for motion in found.motions} == {"BASE"}
    assert [one.reason[:21] for one in found.unusable] == ['"roof" is in a struct'] * 2


@pytest.mark.parametrize("unit", ["", " (cm/s^2)"])
@pytest.mark.parametrize(
    ("ways", "sign"), [(("000", "090", "up"), 1.0), (("32.0", "122.0", "upward"), 1.0), (("35", "125", "down"), -1.0)]
)
def test_columns_of_a_broadband_platform_have_the_directions_of_their_signs(tmp_path, unit, ways, sign):
    names = ("N/S", "H2", "V")
    lines = [
        f"Column {i}: {name} component ground acceleration{unit} (+ is {way})"
        for i, name, way in zip((2, 3, 4), names, ways, strict=True)
    ]
    head = "\n".join(
        f"# {line}" for line in ("units= cm/s^2", "Data fields are TAB-separated", "Column 1: Time (s)", *lines)
    )
    (tmp_path / "8034.acc.bbp").write_text(f"{head}\n{in_columns(T, 981 * A, 981 * B, 981 * C, between=chr(9))}")
    one, two = read_motions(tmp_path).motions
    assert (one.azimuth, two.azimuth) == (float(ways[0]), float(ways[1]))
    np.testing.assert_allclose(one.horizontal, 9.81 * A, atol=1e-6)
    np.testing.assert_allclose(two.vertical, sign * 9.81 * C, atol=1e-6)


@pytest.mark.parametrize(
    "line",
    ["MUESTREO (Hz): 200", "Muestreo: 200 Hz", "Pas de timp: 0.005 s", "サンプリング周波数：200 Hz", "采样率: 200 Hz"],
)
def test_further_words_state_the_interval(tmp_path, line):
    (tmp_path / "x.txt").write_text(f"{line}\nUnits: g\nN E Z\n{in_columns(A, B, C, between=' ')}", encoding="utf-8")
    assert {motion.dt for motion in read_motions(tmp_path)} == {DT}


@pytest.mark.parametrize(
    "line",
    ["Muestreo: 0.01", "Muestreo: 100 Hz original", "Muestreo original: 100 Hz", "Delta: 0.45 deg", "delta = 54.2"],
)
def test_distances_and_other_rates_are_no_interval(tmp_path, line):
    (motion,) = read(tmp_path, f"{line}\ntime(s) N(g)\n{in_columns(T, A, between=' ')}").motions
    assert motion.dt == DT


@pytest.mark.parametrize("unit", ["", " (m/s)"])
def test_columns_of_velocity_keep_this_word_and_are_left_out_beside_accelerations(tmp_path, unit):
    for name, quantity, of_it in (("a", "acceleration", unit and " (m/s/s)"), ("v", "velocity", unit)):
        lines = [
            f"# Column {i}: H{i - 1} component ground {quantity}{of_it} (+ is {way})"
            for i, way in ((2, "055"), (3, "145"))
        ]
        head = "\n".join(["# Column 1: Time (s)", *lines, "# units= m/s^2" if quantity == "acceleration" else "#"])
        (tmp_path / f"{name}.txt").write_text(f"{head}\n{in_columns(T, A, B, between=' ')}")
    found = read_motions(tmp_path)
    assert [motion.azimuth for motion in found.motions] == [55.0, 145.0]
    assert [file.source for file in found.left_out] == ["v.txt"]


def test_numbered_lines_without_units_give_way_to_labels_with_units_and_to_the_study(tmp_path):
    rows = in_columns(T, A, B, between=" ")
    lines = "# Column 1: seconds after origin\n# Column 2: first\n# Column 3: second\n"
    labelled = read(tmp_path, f"{lines}# time(sec) N-S(g) E-W(g)\n{rows}", options=ReadOptions())
    stated = read(tmp_path, lines + rows, options=ReadOptions(columns=("time", "NS", "EW"), unit="g"))
    for found in (labelled, stated):
        assert [(motion.azimuth, motion.dt) for motion in found.motions] == [(0.0, DT), (90.0, DT)]
