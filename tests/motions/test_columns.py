"""Text columns: the unit is declared or the file is not used; time is even or the file is not used."""

import contextlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from motion_files import at2_text, wiggle

from rockbatch.common.errors import InputError, NoRecord
from rockbatch.motions import ReadOptions, Unusable, read_motions
from rockbatch.motions.formats import RecordFile, read_record, table
from rockbatch.motions.formats.column_header import Column
from rockbatch.motions.formats.columns import is_bbp
from rockbatch.motions.formats.stated_step import stated_step
from rockbatch.motions.formats.time_steps import grows_evenly, on_even_steps

T = np.arange(60) * 0.005
NS, EW, UD = (wiggle(60, seed, 100.0) for seed in (1, 2, 3))


def write(folder, header, *columns, name="REC.txt", separator="  ", form="{:.6e}"):
    rows = [separator.join(form.format(value) for value in row) for row in zip(*columns, strict=True)]
    (folder / name).write_text("\n".join([*([header] if header else []), *rows, ""]))


def one(folder, **options):
    found = read_motions(folder, options=ReadOptions(**options))
    assert not found.unusable
    (motion,) = found.motions
    return motion


def reason(folder, **options):
    found = read_motions(folder, options=ReadOptions(**options))
    assert not found.motions
    (unusable,) = found.unusable
    return unusable.reason


LONG = """# Strong motion recording
#    closest distance to fault (km): 16.62
# Data fields are TAB-separated
# Column 1: Time (s)
# Column 2: North-south acceleration (cm/s/s) (+ is northward)
# Column 3: East-west acceleration (cm/s/s) (+ is eastward)
# Column 4: Up-down acceleration (cm/s/s) (+ is upward)
#"""


@pytest.mark.parametrize(
    ("header", "separator"),
    [
        ("#    time(sec)      N-S(cm/s/s)      E-W(cm/s/s)      U-D(cm/s/s)", "   "),
        (LONG, "\t"),
        ("time [s], NS [cm/s2], EW [cm/s2], UD [cm/s2]", ","),
        ("# time(s);NS(gal);EW(gal);UD(gal)", "; "),
    ],
)
def test_a_header_that_declares_columns_and_units_is_enough(tmp_path, header, separator):
    write(tmp_path, header, T, NS, EW, UD, separator=separator)
    found = read_motions(tmp_path)
    assert not found.unusable
    assert [motion.name for motion in found.motions] == ["REC.NS", "REC.EW"]
    for motion, values in zip(found.motions, (NS, EW), strict=True):
        assert motion.dt == 0.005
        np.testing.assert_allclose(motion.horizontal, values / 100, rtol=1e-6, atol=1e-12)  # seven digits
        np.testing.assert_allclose(motion.vertical, UD / 100, rtol=1e-6, atol=1e-12)


def test_decimal_commas_are_read_between_semicolons(tmp_path):
    rows = [f"{t:.3f};{a:.4f}".replace(".", ",") for t, a in zip(T, NS, strict=True)]
    (tmp_path / "x.csv").write_text("time (s); 000 (gal)\n" + "\n".join(rows))
    np.testing.assert_allclose(one(tmp_path).horizontal, NS / 100, atol=1e-6)


ROWS = [f"{t:.3f}|{a:.4f}" for t, a in zip(T, NS, strict=True)]


@pytest.mark.parametrize(
    "text",
    [
        "time (s)|000 (gal)\n".replace("|", ";") + "\n".join(ROWS).replace("|", ";").replace(".", ","),
        "sep=;\r\ntime (s);000 (gal)\r\n" + "\r\n".join(ROWS).replace("|", ";").replace(".", ",") + "\r\n;;\r\n",
        "time (s)\t000 (gal)\n" + "\n".join(ROWS).replace("|", "\t").replace(".", ","),
        "time (s)  000 (gal)\n" + "\n".join(ROWS).replace("|", "   ").replace(".", ","),
        '"time (s)","000 (gal)"\n' + "\n".join(f'"{row}"' for row in ROWS).replace("|", '","'),
        "time (s),000 (gal),\n" + "\n".join(ROWS).replace("|", ", "),
    ],
    ids=["semicolons", "sep=", "tabs", "blanks", "quotes", "points"],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_what_excel_exports_in_any_country_is_read(tmp_path, text, encoding):
    (tmp_path / "x.csv").write_bytes(text.encode(encoding))
    motion = one(tmp_path)
    assert motion.dt == 0.005
    np.testing.assert_allclose(motion.horizontal, NS / 100, atol=1e-6)  # four decimals of cm/s²


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"0,005\n0,125\n0,250\n", "a comma may be decimal or between columns"),
        (b"time (s);000 (gal)\n0,00;1.234,5\n0,01;2.345,6\n", "numbers with both points and commas"),
        (b"PK\x03\x04" + bytes(40), "export it as CSV"),
        ("time(s) NS(gal)\n0 1\n1 2\n".encode("utf-16-le"), "to be saved as UTF-8"),
        (b"\xff\xfe" + "0 1\n".encode("utf-16-le") + b"\x00", "begins as UTF-16 text"),
        (b"# NPTS = 4\n# time(s) NS(gal)\n0 1\n1 2\n2 3\n", "the header says 4 samples, but there are 3 rows"),
        (b"# dt = fast\n# NS(gal)\n1\n2\n", "write dt = … (its sampling interval [s]) under [motions]"),
        (b"# dt = -0.1\n# NS(gal)\n1\n2\n", 'found "dt = -0.1"; expected e.g. dt = 0.01 s'),
        (b"# time(s)\n1\n2\n", "a column of time and no other"),
        (b"# time(s) NS(gal)\n0 1\n1 1e300\n", "expected finite numbers"),
    ],
)
def test_what_may_mean_two_things_is_refused_with_the_remedy(tmp_path, data, message):
    (tmp_path / "x.csv").write_bytes(data)
    assert message in reason(tmp_path)


def test_double_precision_exponents_of_fortran_are_numbers(tmp_path):
    (tmp_path / "x.txt").write_text("# time(s) NS(gal)\n0.0D0 1.5D+01\n1.0D-2 -2.5d+01\n2.0D-2 0.0D0\n")
    np.testing.assert_allclose(one(tmp_path).horizontal, [0.15, -0.25, 0.0])


def test_a_step_and_a_count_in_the_header_are_taken(tmp_path):
    (tmp_path / "x_N.txt").write_text("# NPTS = 3\n# dt = 10 ms\n# unit: gal\n1.0\n2.5\n3.0\n")
    assert one(tmp_path).dt == 0.01


@pytest.mark.parametrize(
    "line",
    ["dt = 20 ms", "dt (ms) = 20", "dt_ms: 20", "dt [ms.] 20", "time step (s): 0.02", "dt = 0.02", "sampling rate: 50 Hz",
     "sampling rate (Hz): 50", "sampling rate (samples/sec) = 50", "sampling_rate_hz = 50", "sampling interval (ms): 20"],
)  # fmt: skip
def test_the_unit_of_a_step_may_stand_before_or_behind_its_number(line):
    stated = stated_step([f"# {line}"])
    assert stated is not None
    assert stated.dt == pytest.approx(0.02, rel=1e-12)


def test_a_table_cut_within_its_last_number_is_refused(tmp_path):
    t = np.arange(150) * 0.005
    write(tmp_path, "# time(s) NS(gal)", t, wiggle(150, 1, 100.0), form="{:.6f}")
    path = tmp_path / "REC.txt"
    path.write_text(path.read_text().rstrip()[:-2])
    assert "the file is cut" in reason(tmp_path)


def test_time_in_milliseconds_is_time(tmp_path):
    write(tmp_path, "# time(ms) NS(gal)", 1000 * T, NS)
    assert one(tmp_path).dt == 0.005


def test_what_the_header_does_not_say_the_study_can_state(tmp_path):
    write(tmp_path, "", T, NS, EW, UD)
    options = {"unit": "cm/s2", "columns": ("time", "000", "-", "up")}
    motion = one(tmp_path, **options)
    assert motion.name == "REC.000"
    np.testing.assert_allclose(motion.horizontal, NS / 100, rtol=1e-6, atol=1e-12)
    assert motion.vertical is not None


def test_time_may_stand_behind_what_was_recorded(tmp_path):
    write(tmp_path, "# NS EW time", NS, EW, T)
    motions = read_motions(tmp_path, options=ReadOptions(unit="cm/s2")).motions
    assert [(motion.name, motion.dt) for motion in motions] == [("REC.NS", 0.005), ("REC.EW", 0.005)]


def test_one_column_takes_step_and_unit_from_the_study_and_direction_from_its_name(tmp_path):
    write(tmp_path, "", NS, name="STA_N.dat")
    write(tmp_path, "", UD, name="STA_Z.dat")
    motion = one(tmp_path, unit="cm/s2", dt=0.01)
    assert (motion.dt, motion.name, motion.vertical_source) == (0.01, "STA_N", "STA_Z.dat")


def test_two_columns_of_which_one_grows_evenly_are_time_and_acceleration(tmp_path):
    write(tmp_path, "", T, NS, name="STA_E.acc")
    motion = one(tmp_path, unit="gal")
    assert motion.dt == 0.005
    assert any("taken as time" in note for note in motion.notes)


def test_a_unit_line_in_the_header_counts(tmp_path):
    write(tmp_path, "# unit: mm/s2\n# t a", T, NS, name="REC_N.txt")
    np.testing.assert_allclose(one(tmp_path).horizontal, NS / 1000, rtol=1e-6, atol=1e-12)


def test_a_remark_with_a_unit_in_it_declares_nothing(tmp_path):
    write(tmp_path, "# PGA (g): 0.5", NS)
    assert "unit" in reason(tmp_path, dt=0.01)


@pytest.mark.parametrize("header", ["", "# t NS", "# time(s) NS", "t,NS"])
def test_without_a_unit_the_file_is_not_used_and_the_reason_says_what_to_add(tmp_path, header):
    write(tmp_path, header, T, NS)
    assert 'write unit = "cm/s2" (PGA 0.092 g)' in reason(tmp_path)


def test_a_column_that_is_no_acceleration_is_left_out_with_a_reason(tmp_path):
    write(tmp_path, "# time(s) NS(cm/s2) EW(cm/s)", T, NS, EW)
    found = read_motions(tmp_path)
    assert [motion.name for motion in found.motions] == ["REC.NS"]
    assert 'unknown acceleration unit "cm/s"' in found.unusable[0].reason


def test_four_columns_that_nobody_names_are_not_guessed(tmp_path):
    write(tmp_path, "", T, NS, EW, UD)
    assert 'columns = ["time", "000", "090", "up"]' in reason(tmp_path, unit="g")


def test_a_wrong_number_of_stated_columns_is_refused(tmp_path):
    write(tmp_path, "", T, NS, EW)
    assert "found 3 columns" in reason(tmp_path, unit="g", columns=("time", "000"))


def test_no_time_and_no_step_is_refused_with_the_remedy(tmp_path):
    write(tmp_path, "# NS(gal)", NS)
    assert "write dt = …" in reason(tmp_path)


@pytest.mark.parametrize("lost", [[29], [30, 40]])
def test_lost_samples_are_filled_linearly_and_it_is_said(tmp_path, lost):
    lost = np.array(lost)
    write(tmp_path, "# time(s) NS(gal)", np.delete(T, lost), np.delete(NS, lost))
    motion = one(tmp_path)
    filled = NS.copy()
    filled[lost] = (NS[lost - 1] + NS[lost + 1]) / 2
    assert motion.dt == 0.005
    np.testing.assert_allclose(motion.horizontal, filled / 100, rtol=1e-6, atol=1e-12)
    assert any(f"{len(lost)} sample{'s' * (len(lost) > 1)} put between, none lost" in note for note in motion.notes)


@pytest.mark.parametrize(
    ("t", "message"),
    [
        (np.concatenate([T[:30], T[30:] + 1.0]), "a gap is not filled"),
        (np.concatenate([T[:30], T[29:-1]]), "does not grow after sample 30 (t = 0.145)"),
        (np.concatenate([T[:30], T[30:] - 0.1]), "does not grow after sample 30"),
    ],
)
def test_gaps_and_times_that_stand_still_or_go_back_are_refused_with_the_sample(tmp_path, t, message):
    write(tmp_path, "# time(s) NS(gal)", t, NS, form="{:.9e}")
    assert message in reason(tmp_path)


def test_steps_up_to_twenty_times_apart_come_on_one_grid_and_more_are_a_gap():
    for usual, other in ((20.0, 1.0), (1.0, 20.0)):
        t = np.cumsum([0.0, *[usual] * 30, other, *[usual] * 5])
        dt, values, _ = on_even_steps(t, t[:, None])
        assert dt == 1.0
        np.testing.assert_allclose(values[:, 0], np.arange(t[-1] + 1))
    for usual, other in ((21.0, 1.0), (1.0, 21.0)):
        with pytest.raises(InputError, match=f"by {usual:g} as a rule, by {other:g} after sample 31 "):
            on_even_steps(np.cumsum([0.0, *[usual] * 30, other, *[usual] * 5]), t[:, None])


def test_uneven_times_take_the_shortest_step_and_the_lost_peak_is_said(tmp_path):
    t = np.cumsum(np.random.default_rng(7).uniform(0.004, 0.008, 60))
    write(tmp_path, "# time(s) NS(gal)", t, NS, form="{:.12e}")
    motion = one(tmp_path)
    assert motion.dt == pytest.approx(np.diff(t).min(), rel=0.02)  # a whole number of steps for the whole time
    at = t[0] + motion.dt * np.arange(motion.npts)
    np.testing.assert_allclose(motion.horizontal, np.interp(at, t, NS / 100), atol=1e-9)
    lost = 1 - motion.pga / np.abs(NS / 100).max()
    assert any(f"its peak is lower by {lost:.1%}" in note for note in motion.notes)


@pytest.mark.parametrize(("rate", "digits"), [(30, 3), (256, 3), (128, 3), (1024, 4)])
def test_rounding_of_printed_times_is_no_unevenness(tmp_path, rate, digits):
    t = np.round(np.arange(60) / rate, digits)
    write(tmp_path, "# time(s) NS(gal)", t, NS, form="{:.6f}")
    motion = one(tmp_path)
    assert (motion.npts, motion.notes) == (60, ())
    assert motion.dt == pytest.approx(1 / rate, rel=10**-digits * rate / 59)  # both ends are rounded


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("# time(s) NS(gal)\n0 1\n0.1 2\n0.2\n", "line 4: found 1 numbers; expected 2"),
        ("# time(s) NS(gal)\n0 1\n0.1 x\n0.2 3\n", 'line 3: found "0.1 x"'),
        ("# time(s) NS(gal)\n0 1\n0.1 nan\n0.2 3\n", 'line 3: found "0.1 nan"; expected finite'),
        ("# time(s) NS(gal)\n0 1\n", "at least two samples"),
        ("# time(h) NS(gal)\n0 1\n1 2\n", 'unit of time "h"'),
        ("just a letter to a friend\n", "no columns of numbers"),
        ("# time(s) NS(gal)\n0 1\n0.1 2_0\n", 'line 3: found "0.1 2_0"'),
    ],
)
def test_a_file_that_is_not_whole_is_refused_with_the_place(tmp_path, text, message):
    (tmp_path / "x.txt").write_text(text)
    assert message in reason(tmp_path)


def test_an_at2_file_saved_as_text_is_read_as_at2(tmp_path):
    (tmp_path / "RSN1_X_Y228.txt").write_text(at2_text(wiggle(50)))
    assert one(tmp_path).npts == 50


def test_a_small_text_file_reads_the_same_in_latin_1_and_utf_8_with_a_mark(tmp_path):
    text = "# time(s) NS(cm/s²)\n0 1\n0.1 2\n0.2 3\n"
    for name, data in (("a.txt", text.encode("latin-1")), ("b.txt", text.encode("utf-8-sig"))):
        (tmp_path / name).write_bytes(data)
    (first,), (second,) = (read_motions(tmp_path / name).motions for name in ("a.txt", "b.txt"))
    np.testing.assert_array_equal(first.horizontal, second.horizontal)
    np.testing.assert_allclose(first.horizontal, [0.01, 0.02, 0.03])


def test_all_impossible_options_are_one_error():
    with pytest.raises(InputError) as caught:
        ReadOptions(unit="furlongs", dt=-1.0, columns=("time", "-"), sensitivity=0.0)
    assert len(caught.value.messages) == 4


@settings(max_examples=80, deadline=1000, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.text(alphabet="0123456789.,;-+eE \t\n#tNS()galu:", max_size=200) | st.binary(max_size=200))
def test_any_text_ends_in_motions_or_reasons(tmp_path, content):
    path = tmp_path / "x.txt"
    data = content.encode() if isinstance(content, str) else content
    with contextlib.suppress(InputError):
        for reading in read_record(RecordFile(path, path.name, data, ReadOptions(unit="g", dt=0.01))):
            assert isinstance(reading, Unusable) or np.isfinite(reading.acceleration).all()


WORDS = st.sampled_from(
    ("0.1", "-2.50", "1e3", "1D-2", "1_0", "nan", "1e999", "x", "#", '"3.5"', "1,5", "1.0-2.0", ".5", "٣")
)
ROWS = st.lists(st.lists(WORDS | st.sampled_from(("0.25", "-1.75")), min_size=0, max_size=4), min_size=1, max_size=12)


@settings(max_examples=80, deadline=None)
@given(ROWS | st.lists(st.lists(st.sampled_from(("0.25", "-1.75", "3.00")), min_size=2, max_size=2), min_size=4),
       st.sampled_from((" ", "\t", ";", ",", ", ", "\xa0")), st.booleans())  # fmt: skip
@example([["0.25", "1_0"]] * 4, " ", False)  # no number, whatever Python makes of it
@example([["0.25", "3.00"], ["0.25", "1_0"], ["-1.75", "3.00"]], " ", False)
def test_rows_that_are_read_at_once_are_those_read_one_by_one(rows, separator, wrapped):
    """To the bit, and with the same words about the same line."""
    text = "time NS\n" + "\n".join(map(separator.join, rows))

    def read():
        try:
            header, numbers = table.read_table(text, wrapped)
        except InputError as error:
            return type(error), error.messages
        return header, numbers.shape, numbers.tobytes()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(table, "_PIECE", 3)
        at_once = read()
        patch.setattr(table, "_even_rows", lambda *_: [])
        assert read() == at_once


@pytest.mark.parametrize(
    ("head", "dt"),
    [
        ("Zeit [s]; Beschleunigung [g]", 0.01), ("Tiempo (s), Aceleracion (g)", 0.01), ("Zaman (s)\tIvme (g)", 0.01),
        ("時間 (s), 加速度 (g)", 0.01), ("Temps, acc (g)", 0.01), ("Zeit (ms), acc (g)", 1e-5), ("time_s, acc_g", 0.01),
        ("Tiempo, a(g)", 0.01), ("時間, acc_g", 0.01), ("t [s], a_cm_s2", 0.01), ("time (s), Acc. (cm/s^2)", 0.01),
    ],
)  # fmt: skip
@pytest.mark.parametrize("meant_for_others", [None, 0.02])
def test_a_column_in_seconds_is_time_in_any_language(tmp_path, head, dt, meant_for_others):
    """Its own times win over the step that the study states for other files."""
    between = next(sign for sign in ";\t," if sign in head)
    scale = 981.0 if "cm" in head else 1.0
    rows = [f"{0.01 * i:.2f}{between} {scale * a:.6f}\n" for i, a in enumerate(wiggle(300, scale=0.3))]
    (tmp_path / "x_NS.csv").write_text(f"{head}\n{''.join(rows)}", encoding="utf-8")
    (motion,) = read_motions(
        tmp_path, options=ReadOptions(dt=meant_for_others), vertical=False, confirmed=["*"]
    ).motions
    assert motion.dt == pytest.approx(dt)
    assert motion.pga == pytest.approx(9.81 * max(abs(a) for a in wiggle(300, scale=0.3)), rel=1e-5)


SHAKEN = [f"{a:.5f}" for a in wiggle(80, scale=0.3)]


@pytest.mark.parametrize(
    "text",
    [
        "# acceleration in g\n80 0.02\n" + "\n".join(SHAKEN),
        "# acceleration in g\n80 0.02\n" + "\n".join(" ".join(SHAKEN[i : i + 8]) for i in range(0, 80, 8)),
        "# acceleration in g, dt = 0.02 s\n" + "\n".join(f"{a} \\" for a in SHAKEN),
        "EL CENTRO\n# time(s) NS(g)\n" + "\n".join(f"{0.02 * i:.2f} {a}" for i, a in enumerate(SHAKEN)) + "\n***\n",
    ],
    ids=["count and step over a column", "count and step over rows", "backslashes", "an end of stars"],
)
def test_a_table_as_textbooks_and_programs_pass_it_on_is_read_whole(tmp_path, text):
    (tmp_path / "x_000.txt").write_text(text)
    motion = one(tmp_path)
    assert motion.dt == 0.02
    np.testing.assert_allclose(motion.horizontal, 9.81 * np.array(list(map(float, SHAKEN))), rtol=1e-12)


@pytest.mark.parametrize("line", ["79 0.02", "81 0.02", "nan 0.02", "inf 0.02", "80 1.0", "80 0.0", "80 -0.02"])
def test_a_count_and_step_over_a_column_that_are_not_its_own_are_none(tmp_path, line):
    (tmp_path / "x_000.txt").write_text(f"# acceleration in g\n{line}\n" + "\n".join(SHAKEN))
    assert "found 1 numbers; expected 2" in reason(tmp_path)


@pytest.mark.parametrize("suffix", ["AT2", "g3"])
def test_numbers_that_programs_leave_in_a_file_of_records_are_read_as_text_columns(tmp_path, suffix):
    (tmp_path / f"x_000.{suffix}").write_text("".join(f"{0.01 * i:.2f} {a}\n" for i, a in enumerate(SHAKEN)))
    assert 'column 2 has no unit; write unit = "g" (PGA 0.27 g)' in reason(tmp_path)
    motion = one(tmp_path, unit="g")
    np.testing.assert_allclose(motion.horizontal, 9.81 * np.array(list(map(float, SHAKEN))), rtol=1e-12)
    assert motion.dt == 0.01


@pytest.mark.parametrize("suffix", ["smc", "V2", "xyz"])
def test_columns_under_another_suffix_are_asked_to_be_called_text(tmp_path, suffix):
    rows = "".join(f"{0.01 * i:.2f} {a}\n" for i, a in enumerate(SHAKEN))
    (tmp_path / f"x_000.{suffix}").write_text(rows)
    assert "but it is a table: read it as text columns: call it .txt, and state unit" in reason(tmp_path)
    (tmp_path / f"x_000.{suffix}").rename(tmp_path / "x_000.txt")
    assert one(tmp_path, unit="g").npts == len(SHAKEN)


@pytest.mark.parametrize("suffix", ["anc", "cor", "th"])
def test_tables_have_the_suffixes_of_agencies_and_programs(tmp_path, suffix):
    write(tmp_path, "# acceleration (cm/s2)", T, NS, name=f"x_NS.{suffix}")
    assert one(tmp_path).azimuth == 0.0


def test_what_is_no_table_is_not_asked_to_be_called_text(tmp_path):
    (tmp_path / "x_000.smc").write_text("1 2 3\nnot a table\n4 5\n" * 40)
    assert reason(tmp_path).endswith("its header is another one")


@pytest.mark.parametrize(("stated", "told"), [("EW", False), ("090", False), ("NS", True), ("UD", True)])
def test_columns_stated_otherwise_than_in_a_header_are_of_other_files(tmp_path, stated, told):
    write(tmp_path, "# time(s) EW(cm/s2)", T, EW)
    motion = one(tmp_path, columns=("time", stated))
    assert motion.horizontal == pytest.approx(EW / 100, rel=1e-6, abs=1e-12)
    assert any("those of other files" in note for note in motion.notes) == told


def test_decimal_commas_are_read_between_tabs_and_commas_between_columns_too(tmp_path):
    rows = [f"{t:.3f}\t{value:.4f}" for t, value in zip(T, EW, strict=True)]
    (tmp_path / "REC.txt").write_text("time(s)\tEW(cm/s2)\n" + "\n".join(rows).replace(".", ",") + "\n")
    assert one(tmp_path).horizontal == pytest.approx(EW / 100, abs=6e-7)
    (tmp_path / "REC.txt").write_text("time(s),\tEW(cm/s2)\n" + "\n".join(rows).replace("\t", ",\t") + "\n")
    assert one(tmp_path).horizontal == pytest.approx(EW / 100, abs=6e-7)


@pytest.mark.parametrize(("words", "kind"), [(3, InputError), (300, NoRecord)])
def test_a_text_with_some_numbers_is_no_record_and_a_damaged_table_is_one(words, kind):
    rows = [f"{t:.3f} {value:.4f}" for t, value in zip(T, EW, strict=True)]
    text = "\n".join([*rows[:30], *["more words, and 3 of them"] * words, *rows[30:], ""])
    with pytest.raises(InputError) as refused:
        read_record(RecordFile(Path("x.txt"), "x.txt", text.encode(), ReadOptions(unit="g")))
    assert refused.type is kind


def test_times_that_fall_do_not_grow_evenly():
    assert grows_evenly(T)
    assert not grows_evenly(T[::-1])
    assert not grows_evenly(0.0 * T)


@pytest.mark.parametrize("rest", ["", "\n\n", "\n9.5 10.5 11.5", "\n9.5 10.5 11.5\n12.5 13.5 14.5"])
def test_a_shorter_row_is_refused_but_at_the_end_of_a_wrapped_table(rest):
    text = "1.5 2.5 3.5\n4.5 5.5 6.5\n7.5 8.5" + rest
    with pytest.raises(InputError, match="line 3: found 2 numbers; expected 3"):
        table.read_table(text)
    if rest.strip():
        with pytest.raises(InputError, match="line 3: found 2 numbers; expected 3"):
            table.read_table(text, wrapped=True)
    else:
        assert table.read_table(text, wrapped=True)[1].ravel().tolist() == [0.5 + n for n in range(1, 9)]


def test_a_t_may_be_time_unless_it_has_a_unit_of_acceleration():
    assert [Column(*head).may_be_time for head in (("T",), ("Ts",), ("T", "g"), ("U",))] == [True, True, False, False]


def test_a_broadband_platform_file_has_time_and_three_accelerations():
    head = "# time(s) NS({}) EW({}) UD({})\n".format
    units = [["cm/s/s"] * 3, ["cm/s", "cm/s/s", "cm/s/s"], ["cm/s/s", "cm/s", "cm/s/s"], ["cm/s/s", "cm/s/s", "cm/s"]]
    assert [is_bbp(head(*each).encode()) for each in units] == [True, False, False, False]
