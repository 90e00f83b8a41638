"""What a file states wins: the study's unit, dt, columns and layout fill gaps, and a note tells where they differ."""

import numpy as np
import pytest
from motion_files import wiggle, write_at2

from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.formats.stated_step import stated_step

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
def test_the_step_of_a_header_is_read_as_people_write_it(tmp_path, line, dt):
    width = min(4, len(line.split()))
    write(tmp_path, f"# {line}\n# unit: g", *[wiggle(len(A), k) for k in range(width)], name="x.txt")
    names = ("000", "090", "up", "-")[:width]
    found = read_motions(tmp_path, options=ReadOptions(columns=names))
    assert not found.unusable
    assert [motion.dt for motion in found.motions] == [pytest.approx(dt, rel=1e-12)] * min(width, 2)


@pytest.mark.parametrize(("line", "dt"), STEPS[:4])
def test_the_step_of_a_file_wins_over_that_of_the_study_and_a_note_tells_both(tmp_path, line, dt):
    write(tmp_path, f"# {line}\n# unit: g", A)
    motion = one(tmp_path, dt=dt / 2)
    assert motion.dt == pytest.approx(dt, rel=1e-12)
    assert any(note.startswith(f"dt = {dt:g} s as the file states; {dt / 2:g} s is") for note in motion.notes)
    assert not any("as the file states" in note for note in one(tmp_path, dt=dt).notes)


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


@pytest.mark.parametrize(
    ("stated", "right"),
    [
        (0.00989, False), (0.00991, True), (0.01, True), (0.01009, True), (0.01011, False),
        (0.015, False), (0.01979, False), (0.01981, True), (0.02, True), (0.02019, True), (0.02021, False),
    ],
)  # fmt: skip
def test_a_headers_step_is_that_of_the_samples_or_the_usual_one_of_uneven_times(tmp_path, stated, right):
    """Times of every second sample, and of one between: samples are 0.01 s apart, those of the file as a rule 0.02 s."""
    t = 0.01 * np.sort([*range(0, 238, 2), 61])
    write(tmp_path, f"# dt = {stated} s\n# time(s) N(g)", t, A)
    if right:
        assert one(tmp_path).dt == pytest.approx(0.01, rel=1e-9)
    else:
        assert f'"dt = {stated} s"' in reason(tmp_path)


def test_a_lost_sample_does_not_make_the_headers_step_wrong(tmp_path):
    t = np.delete(0.01 * np.arange(121), 60)
    write(tmp_path, "# sampling rate: 100 Hz\n# time(s) N(g)", t, A)
    assert "1 sample put between, none lost" in one(tmp_path).notes[0]


@pytest.mark.parametrize("stated", ["gal", "cm/s2", "m/s2", "g/10"])
def test_the_unit_of_a_file_wins_over_that_of_the_study_and_a_note_tells_both(tmp_path, stated):
    folders = {name: tmp_path / name for name in ("at2", "label", "line")}
    for folder in folders.values():
        folder.mkdir()
    write_at2(folders["at2"], "x000.AT2", A)
    write(folders["label"], "# time(s) N(g)", 0.01 * np.arange(120), A)
    write(folders["line"], "# unit: g\n# dt = 0.01", A)
    for folder in folders.values():
        motion, agreed = one(folder, unit=stated, dt=0.02), one(folder, unit="G", dt=0.01)
        np.testing.assert_array_equal(motion.horizontal, agreed.horizontal)
        np.testing.assert_allclose(motion.horizontal / 9.81, A, atol=1e-6)
        assert motion.dt == 0.01
        told = [note.lower() for note in motion.notes if note not in agreed.notes]
        assert [note.partition(";")[0] for note in told] == [
            "unit g as the file states",
            "dt = 0.01 s as the file states",
        ]
        assert f"{stated} is for files without a unit" in told[0]


def test_a_study_states_the_unit_that_one_file_lacks_and_loses_no_other(tmp_path):
    write_at2(tmp_path, "at2_000.AT2", A)
    write(tmp_path, "# time(s) N(cm/s2)", 0.01 * np.arange(120), 981 * B, name="columns.txt")
    write(tmp_path, "", 0.01 * np.arange(120), 9.81 * C, name="bare_N.txt")
    lacking = read_motions(tmp_path, confirmed=["*"]).unusable
    assert [file.name for file in lacking] == ["bare_N"]
    for words in (
        "has no unit",
        'unit = "g" (PGA 0.88 g)',
        "under [motions]",
        "the others keep their own",
        "--write-manifest",
    ):
        assert words in lacking[0].reason
    found = read_motions(tmp_path, options=ReadOptions(unit="m/s2"), confirmed=["*"])
    assert not found.unusable
    motions = {motion.name: motion.horizontal / 9.81 for motion in found}
    for name, values in {"at2_000": A, "columns": B, "bare_N": C}.items():
        np.testing.assert_allclose(motions[name], values, atol=2e-4)


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
        *(
            "Acceleration (units: gal)",
            "Corrected record (units are gal)",
            "Baseline corrected; units: gal",
            "Values are in gal",
        ),
        *(
            "Acceleration, cm/s2",
            "corrected acceleration - cm/sec/sec",
            "Unit of acceleration: gal",
            "Acceleration / gal",
        ),
        *("単位：gal", "Units\tgal", "Μονάδα: gal"),
        *("Aceleración en cm/s2", "Beschleunigung in cm/s2", "Accelerations expressed in gal"),
        *("Trigger: 2019-07-06; acceleration in gal", "Instrument corrected acceleration in gal (cm/s2)"),
    ],
)
def test_a_unit_in_the_text_of_a_header_counts_and_is_not_overridden(tmp_path, line):
    write(tmp_path, f"# {line}\n# dt = 0.01", 100 * A)
    np.testing.assert_allclose(one(tmp_path).horizontal, A, atol=1e-6)
    np.testing.assert_allclose(one(tmp_path, unit="g").horizontal, A, atol=1e-6)


@pytest.mark.parametrize(
    "lines",
    [
        "Peak acceleration (cm/s2): 98.1\n# acceleration in station 3\n# Data, G. Smith",
        "design acceleration, g = 0.35",
        "target acceleration, g",
        "Target acceleration in g",
        "Threshold acceleration, g",
        "Trigger acceleration - g",
        "Recorder range: acceleration, g",
        "Full scale acceleration, g",
        "Bedrock acceleration is in g; see the report",
        "Acceleration/g factor none",
        "Values in g were converted to m/s2",
        "Originally recorded values in g, converted to m/s2",
        "Original acceleration in g",
        "Gravity acceleration, m/s2",
        "Gravity acceleration in m/s2",
        "Accuracy in g",
    ],
)
def test_the_unit_of_something_else_is_no_unit_of_the_samples(tmp_path, lines):
    write(tmp_path, f"# {lines}\n# dt = 0.01", A)
    assert "has no unit" in reason(tmp_path)
    np.testing.assert_allclose(one(tmp_path, unit="m/s2").horizontal, A, atol=1e-6)


def test_a_manifest_decides_for_its_file_whatever_the_study_states(tmp_path):
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
def test_stated_columns_make_no_vertical_horizontal_that_the_header_names(tmp_path, header):
    write(tmp_path, header, 0.01 * np.arange(120), A, B, C, name="x.txt")
    unit = None if "(g)" in header else "g"
    for columns in (("time", "000", "090", "up"), ("time", "000", "up", "090")):
        found = read_motions(tmp_path, options=ReadOptions(unit=unit, columns=columns))
        assert not found.unusable
        assert [motion.azimuth for motion in found] == [0.0, 90.0]
        assert all("up" in motion.vertical_source.lower() for motion in found)
        noted = ["are those of other files" in note for note in found.motions[0].notes]
        assert any(noted) == (columns[2] != "up")


@pytest.mark.parametrize(
    ("header", "columns", "names"),
    [
        ("# time(s) N(g)", ("000", "time"), ["x"]),
        ("# N(g) E(g)", ("time", "090"), ["x.N", "x.E"]),
        ("# time(s) N(g)", ("time", "180"), ["x"]),
    ],
)
def test_stated_columns_cannot_change_what_the_header_names(tmp_path, header, columns, names):
    first = 0.01 * np.arange(120) if "time" in header else A
    write(tmp_path, header, first, B, name="x.txt")
    found = read_motions(tmp_path, options=ReadOptions(dt=0.01, columns=columns), confirmed=["*"])
    assert not found.unusable
    assert [motion.name for motion in found] == names
    assert found.motions[0].azimuth == 0.0
    assert "are those of other files" in " ".join(found.motions[0].notes)


def test_stated_columns_make_no_record_of_a_spectrum(tmp_path):
    write(tmp_path, "# T(s) Sa(g)", 0.01 * np.arange(120), A, name="x.txt")
    assert "a response spectrum is no time history" in reason(tmp_path, dt=0.01, columns=("time", "000"))


def test_a_layout_of_the_study_is_for_files_whose_header_names_no_columns(tmp_path):
    write(tmp_path, "", *A.reshape(-1, 5).T, name="wrapped_N.txt")
    write(tmp_path, "# time(s) E(g)", 0.01 * np.arange(120), B, name="named_E.txt")
    found = read_motions(tmp_path, options=ReadOptions(unit="g", dt=0.01, layout="wrapped"), confirmed=["*"])
    assert not found.unusable
    for motion, values in zip(found, (B, A), strict=True):
        np.testing.assert_allclose(motion.horizontal / 9.81, values, atol=1e-6)
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "named_E.txt"\nlayout = "wrapped"\n')
    found = read_motions(tmp_path, options=ReadOptions(unit="g", dt=0.01, layout="wrapped"), confirmed=["*"])
    assert max(motion.npts for motion in found) == 240


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


def test_the_commands_options_are_for_files_that_state_none_too(tmp_path, capsys):
    write(tmp_path, "# SAMPLING INTERVAL (sec) : 0.01\n# unit: g", A)
    assert main(["motions", "--all", str(tmp_path), "--dt", "0.005", "--unit", "cm/s2"]) == 0
    shown = capsys.readouterr().out
    assert "x_N" in shown
    assert "unit g as the file states" in shown
