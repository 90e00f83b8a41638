"""What a file says goes first: the study's unit, dt and columns fill gaps, and contradictions are refused."""

import numpy as np
import pytest
from motion_files import wiggle, write_at2

from rockbatch.cli import main
from rockbatch.errors import InputError
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.formats.column_header import stated_step

A, B, C = (wiggle(120, seed) for seed in (1, 2, 3))


def write(folder, header, *columns, name="x_N.txt", form="{:.6f}"):
    rows = [" ".join(form.format(value) for value in row) for row in zip(*columns, strict=True)]
    (folder / name).write_text("\n".join([*([header] if header else []), *rows, ""]))


def one(folder, **options):
    found = read_motions(folder, options=ReadOptions(**options), confirmed=["*"])
    assert not found.unusable
    (motion,) = found.motions
    return motion


def reason(folder, **options) -> str:
    found = read_motions(folder, options=ReadOptions(**options))
    assert not found.motions
    (unusable,) = found.unusable
    return unusable.reason


STEPS = [
    ("SAMPLING INTERVAL (sec) : 0.01", 0.01),
    ("DT = 0.005", 0.005),
    ("dt: 0.01 s", 0.01),
    ("sampling rate: 200 Hz", 0.005),
    ("Sample Interval 0.02 sec", 0.02),
    ("NPTS= 120, DT= .0100 SEC", 0.01),
    ("NPTS = 120  DT = 0.02", 0.02),
    ("Sampling Freq(Hz)  100Hz", 0.01),
    ("Sampling frequency (Hz): 250", 0.004),
    ("SAMPLING_INTERVAL_S: 0.005000", 0.005),
    ("SampleRate(Hz):200", 0.005),
    ("Samples per second: 50", 0.02),
    ("Time step [ms] = 5", 0.005),
    ("time increment 10 msec", 0.01),
    ("Sampling rate: 0.01 sec", 0.01),
    ("120 points of accel data equally spaced at .020 sec", 0.02),
    ("Accelerogram at equal intervals of 0.02 s", 0.02),
    ("dt = 0,005 s", 0.005),
    ("Δt = 5.0E-03 s", 0.005),
]


@pytest.mark.parametrize(("line", "dt"), STEPS)
def test_the_step_of_a_header_is_read_as_people_write_it(tmp_path, line, dt):
    write(tmp_path, f"# {line}\n# unit: g", A)
    assert one(tmp_path).dt == pytest.approx(dt, rel=1e-12)


@pytest.mark.parametrize(
    "line",
    [
        *(
            "low-cut frequency 0.05 Hz",
            "width 3",
            "Original sampling rate: 200 Hz",
            "resampled from sampling rate 200 Hz",
        ),
        *("raw data dt = 0.005", "dt = fast", "adt = 3", "interval 3", "samples 120"),
    ],
)
def test_what_is_no_step_of_these_data_is_not_taken_for_one(line):
    assert stated_step([line]) is None


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["dt = -0.1"], 'found "dt = -0.1"; expected e.g. dt = 0.01 s'),
        (["sampling rate: 0"], "expected e.g. dt = 0.01 s"),
        (["Sampling rate: 0.005"], "which is no rate"),
        (["DT = 0.01", "sampling rate: 200 Hz"], '"DT = 0.01" and "sampling rate: 200 Hz", 0.01 s and 0.005 s'),
    ],
)
def test_a_step_that_cannot_be_and_two_of_them_are_refused(lines, message):
    with pytest.raises(InputError) as caught:
        stated_step(lines)
    assert message in str(caught.value)


@pytest.mark.parametrize(("line", "dt"), STEPS)
@pytest.mark.parametrize("width", [2, 3, 4])
def test_a_line_with_a_value_names_no_columns_however_many_words_it_has(tmp_path, line, dt, width):
    write(tmp_path, f"# {line}\n# unit: g", *[np.roll(A, k) for k in range(width)], name="x.txt")
    names = ("000", "090", "up", "-")[:width]
    found = read_motions(tmp_path, options=ReadOptions(columns=names))
    assert not found.unusable
    assert [motion.dt for motion in found.motions] == [pytest.approx(dt, rel=1e-12)] * 2


@pytest.mark.parametrize(("line", "dt"), STEPS)
def test_a_stated_step_that_halves_the_duration_is_refused_with_both_values(tmp_path, line, dt):
    write(tmp_path, f"# {line}\n# unit: g", A)
    said = reason(tmp_path, dt=dt / 2)
    assert f"the file says {dt:g} s, but dt = {dt / 2:g} is stated" in said
    assert "motions.toml" in said
    assert one(tmp_path, dt=dt).dt == pytest.approx(dt, rel=1e-12)


def test_rounding_is_no_contradiction_and_the_files_own_step_is_kept(tmp_path):
    t = np.arange(120) / 256
    write(tmp_path, "# time(s) N(g); dt = .0039 s\n# time(s) N(g)", t, A, form="{:.8f}")
    assert one(tmp_path, dt=0.0039).dt == pytest.approx(1 / 256, rel=1e-6)


def test_a_step_in_the_header_beside_a_time_column_that_contradicts_it_is_refused(tmp_path):
    write(tmp_path, "# dt = 0.005 s\n# time(s) N(g)", 0.01 * np.arange(120), A)
    said = reason(tmp_path)
    assert 'the header says "dt = 0.005 s", 0.005 s, but time grows by 0.01 s' in said
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x_N.txt"\ndt = 0.005\n')
    assert one(tmp_path).dt == 0.005


def test_a_lost_sample_does_not_make_the_headers_step_wrong(tmp_path):
    t = np.delete(0.01 * np.arange(121), 60)
    write(tmp_path, "# sampling rate: 100 Hz\n# time(s) N(g)", t, A)
    assert "1 samples put between, none lost" in one(tmp_path).notes[0]


@pytest.mark.parametrize("stated", ["gal", "cm/s2", "m/s2", "g/10"])
def test_a_stated_unit_that_contradicts_the_file_is_refused_with_both(tmp_path, stated):
    folders = {name: tmp_path / name for name in ("at2", "label", "line")}
    for folder in folders.values():
        folder.mkdir()
    write_at2(folders["at2"], "x000.AT2", A)
    write(folders["label"], "# time(s) N(g)", 0.01 * np.arange(120), A)
    write(folders["line"], "# unit: g\n# dt = 0.01", A)
    for folder in folders.values():
        said = reason(folder, unit=stated, dt=0.02)
        assert said.lower().startswith(f'the file says g, but unit = "{stated}" is stated')
        assert "the file says 0.01 s, but dt = 0.02 is stated" in said
        assert one(folder, unit="G", dt=0.01).dt == 0.01


@pytest.mark.parametrize(
    "line",
    [
        *(
            "ACCELERATION TIME HISTORY IN UNITS OF CM/S/S",
            "Acceleration in cm/s2",
            "Acceleration unit: gal",
            "Acc. (cm/s2)",
        ),
        *("AmplitudeUnit: gal", "Corrected acceleration values in units of cm/sec2.", "Units: cm/s**2"),
    ],
)
def test_a_unit_in_the_text_of_a_header_counts_and_is_not_overridden(tmp_path, line):
    write(tmp_path, f"# {line}\n# dt = 0.01", 100 * A)
    np.testing.assert_allclose(one(tmp_path).horizontal, A, atol=1e-6)
    assert 'but unit = "g" is stated' in reason(tmp_path, unit="g")


def test_the_unit_of_a_peak_and_words_behind_in_are_no_unit_of_the_data(tmp_path):
    write(tmp_path, "# Peak acceleration (cm/s2): 98.1\n# acceleration in station 3\n# dt = 0.01", A)
    assert "has no unit" in reason(tmp_path)
    np.testing.assert_allclose(one(tmp_path, unit="m/s2").horizontal, A, atol=1e-6)


def test_a_manifest_stays_the_word_for_one_file_and_says_so_whatever_the_study_states(tmp_path):
    write(tmp_path, "# dt = 0.01\n# unit: g", A)
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x_N.txt"\nunit = "m/s2"\ndt = 0.02\n')
    for options in ({}, {"unit": "gal", "dt": 0.005}):
        motion = one(tmp_path, **options)
        np.testing.assert_allclose(motion.horizontal, A, atol=1e-6)
        assert motion.dt == 0.02
        assert motion.notes == (
            "unit m/s2 as motions.toml says, instead of g",
            "dt = 0.02 s as motions.toml says, instead of 0.01 s",
        )


@pytest.mark.parametrize("header", ["# time(s) N(g) UP(g) E(g)", "t N UP E", "time,000,up,090"])
def test_stated_columns_that_make_a_vertical_horizontal_are_refused_with_both_names(tmp_path, header):
    write(tmp_path, header, 0.01 * np.arange(120), A, B, C, name="x.txt")
    unit = None if "(g)" in header else "g"
    said = reason(tmp_path, unit=unit, columns=("time", "000", "090", "up"))
    assert 'column 3: the header says "UP", but columns states "090"'.lower() in said.lower()
    found = read_motions(tmp_path, options=ReadOptions(unit=unit, columns=("time", "000", "up", "090")))
    assert [(m.azimuth, m.vertical_source) for m in found.motions] == [
        (0.0, found.motions[0].vertical_source),
        (90.0, found.motions[0].vertical_source),
    ]
    assert "up" in found.motions[0].vertical_source.lower()


@pytest.mark.parametrize(
    ("header", "columns", "message"),
    [
        ("# time(s) N(g)", ("000", "time"), 'column 1: the header says "time", but columns states "000"'),
        ("# N(g) E(g)", ("time", "090"), 'column 1: the header says "N", but columns states "time"'),
        ("# time(s) N(g)", ("time", "180"), 'column 2: the header says "N", but columns states "180"'),
        ("# time(s) Zdown(g)", ("time", "up"), 'column 2: the header says "Zdown", but columns states "up"'),
        ("# T(s) Sa(g)", ("time", "000"), "a response spectrum is no time history"),
    ],
)
def test_stated_columns_cannot_change_what_the_header_names(tmp_path, header, columns, message):
    write(tmp_path, header, 0.01 * np.arange(120), A, name="x.txt")
    assert message in reason(tmp_path, dt=0.01, columns=columns)


def test_stated_columns_fill_what_the_header_leaves_open_and_leave_columns_out(tmp_path):
    t = 0.01 * np.arange(120)
    write(tmp_path, "# time(s) ch1(g) ch2(g) ch3(g)", t, A, B, C, name="x.txt")
    found = read_motions(tmp_path, options=ReadOptions(columns=("time", "000", "-", "up")), gravity=1.0)
    assert [(m.name, m.vertical_source) for m in found.motions] == [("x.000", "x.txt (up)")]
    np.testing.assert_allclose(found.motions[0].vertical, C, atol=1e-6)  # six decimals; the unit is the header's
    write(tmp_path, "# time(s) H1(g) H2(g) V(g)", t, A, B, C, name="x.txt")
    found = read_motions(tmp_path, options=ReadOptions(columns=("time", "045", "135", "up")))
    assert [m.azimuth for m in found.motions] == [45.0, 135.0]


@pytest.mark.parametrize("line", ["Origin time", "Station N", "Component UP", "Site Z"])
def test_two_words_of_text_above_two_columns_name_neither(tmp_path, line):
    write(tmp_path, f"# {line}\n# unit: g", 0.01 * np.arange(120), A)
    motion = one(tmp_path, columns=("time", "000"))
    assert (motion.name, motion.dt) == ("x_N", 0.01)
    np.testing.assert_allclose(motion.horizontal / 9.81, A, atol=1e-6)
    (tmp_path / "x_N.txt").write_text((tmp_path / "x_N.txt").read_text().replace("\n", "\n# N E t\n", 1))
    assert one(tmp_path).dt == 0.01  # three words are no two columns either


def test_columns_of_other_files_do_not_concern_one_whose_header_tells_its_own(tmp_path):
    write(tmp_path, "# time(s) N(g)", 0.01 * np.arange(120), A, name="own.txt")
    write(tmp_path, "", 0.01 * np.arange(120), B, C, A[::-1], name="other.txt")
    found = read_motions(tmp_path, options=ReadOptions(unit="g", columns=("time", "000", "090", "up")))
    assert [m.name for m in found.motions] == ["other.000", "other.090", "own"]
    assert "the 4 that are stated are those of other files" in found.motions[2].notes[0]


def test_the_commands_options_are_refused_in_the_same_way(tmp_path, capsys):
    write(tmp_path, "# SAMPLING INTERVAL (sec) : 0.01\n# unit: g", A)
    assert main(["motions", str(tmp_path), "--dt", "0.005", "--unit", "cm/s2"]) == 1
    shown = capsys.readouterr().out
    assert 'the file says g, but unit = "cm/s2" is stated' in shown
    assert "the file says 0.01 s, but dt = 0.005 is stated" in shown
