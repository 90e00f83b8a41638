"""Of several copies of a recording one is used, as a whole set, and nothing counts twice: on files made here."""

from pathlib import Path

import numpy as np
import pytest
from agency_files import dyna_text
from copies import title
from fixed_column_files import A, B, C, cosmos_text, csmip_channel, smc_text
from motion_files import wiggle, write_at2
from national_files import unam_text
from waveform_files import trace

from rockbatch.motions import ReadOptions, alignment, read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.identity import likeness
from rockbatch.motions.labels.orientation import Orientation

NEAR_FAULT = Path(__file__).parents[2] / "motions" / "near_fault"

DATE = "FECHA DEL SISMO [GMT]"


def left_out(found) -> dict[str, str]:
    return {double.source: double.reason for double in found.left_out}


def shaking(seed: int, scale: float = 90.0) -> np.ndarray:
    return np.round(wiggle(400, seed, scale), 3)


# Several earthquakes


def test_recordings_of_unknown_time_are_never_one_record(tmp_path):
    """Four earthquakes at one station, whose files say nothing of their dates."""
    for i in range(4):
        columns = tuple(shaking(10 * i + k) for k in (1, 2, 3))
        text = unam_text(columns=columns, **{DATE: None, "HORA EPICENTRO (GMT)": None})
        (tmp_path / f"CANA000{i}.191").write_text(text, encoding="latin-1")
    found = read_motions(tmp_path)
    assert len(found.motions) == 8
    assert len({motion.station for motion in found.motions}) == 4
    assert all(motion.vertical_source.startswith(motion.source[:12]) for motion in found.motions)
    assert len(read_motions(tmp_path, azimuths=(30.0,)).motions) == 4


@pytest.mark.parametrize(
    ("key", "date"),
    [
        ("FECHA DEL SISMO (GMT)", "21/JUL/2000"),
        ("FECHA DEL SISMO (GMT)", "21 DE JULIO DEL 2000"),
        ("FECHA DEL SISMO [GMT]", "21/07/2000"),
        ("FECHA DEL SISMO", "2000-07-21"),
    ],
)
def test_dates_of_unam_s_sister_institutes_are_read(tmp_path, key, date):
    (tmp_path / "a.191").write_text(unam_text(**{DATE: None, key: date}), encoding="latin-1")
    (tmp_path / "b.191").write_text(unam_text(**{DATE: "2000/07/21"}), encoding="latin-1")
    found = read_motions(tmp_path)
    assert {motion.source.partition(" ")[0] for motion in found.motions} == {"a.191"}
    assert len(found.left_out) == 3
    assert all("2000" in motion.origin.event for motion in found.motions)


# Scaled copies


def test_the_unscaled_of_two_copies_is_used_and_the_factor_named(tmp_path):
    write_at2(tmp_path, "scaled.AT2", 2.0 * wiggle(60), title=title("0"))
    write_at2(tmp_path, "unscaled.AT2", wiggle(60), title=title("0"))
    found = read_motions(tmp_path)
    (motion,) = found.motions
    assert motion.source == "unscaled.AT2"
    assert left_out(found)["scaled.AT2"].startswith("the same recording, 2 times as large, as unscaled.AT2")
    assert [finding.what for finding in motion.findings] == ["factor"]


def test_a_copy_that_is_less_corrected_and_larger_is_said_to_be_both(tmp_path):
    values = 981.0 * wiggle(400)
    for stage, factor, stated in (
        ("C", 1.0, {}),
        ("U", 2.0, {"BASELINE_CORRECTION": "BASELINE NOT REMOVED", "PROCESSING": ""}),
    ):
        text = dyna_text(factor * values, **stated)
        (tmp_path / f"IT.AQK..HNE.D.20090406.013239.{stage}.ACC.ASC").write_text(text)
    (reason,) = left_out(read_motions(tmp_path)).values()
    assert reason.startswith(
        "the same recording, less corrected, 2 times as large, as IT.AQK..HNE.D.20090406.013239.C.ACC.ASC"
    )


@pytest.mark.parametrize("stages", [("automatic", "manual"), ("manual", "automatic")])
def test_a_copy_that_was_processed_by_hand_is_used_before_an_automatic_one(tmp_path, stages):
    for name, stage in zip("ab", stages, strict=True):
        (tmp_path / name).mkdir()
        text = dyna_text((1.1 if stage == "manual" else 1.0) * 981.0 * wiggle(400), PROCESSING=stage)
        (tmp_path / name / "IT.AQK..HNE.ASC").write_text(text)
    (motion,) = read_motions(tmp_path).motions
    assert motion.source == f"{'ab'[stages.index('manual')]}/IT.AQK..HNE.ASC"


def test_where_nothing_tells_which_factor_is_right_it_is_asked_for(tmp_path):
    write_at2(tmp_path, "one.AT2", wiggle(60), title=title("0"))
    write_at2(tmp_path, "two.AT2", 2.0 * wiggle(60), title=title("0"))
    found = read_motions(tmp_path)
    (asked,) = found.unusable
    assert asked.reason.startswith("two.AT2, left out, has the same samples times 2: check which of them is right; if")
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "two.AT2"\nuse = true\n')
    (motion,) = read_motions(tmp_path).motions
    assert motion.source == "two.AT2"


@pytest.mark.parametrize(
    ("factor", "waits"), [(9.81, True), (9.80665, True), (100.0, True), (-9.81, True), (2.0, False), (9.5, False)]
)
def test_neither_of_copies_a_unit_apart_is_used_until_one_is_named(tmp_path, factor, waits):
    """0.089 g and 0.874 g: in one of the files m/s² are called g."""
    small = 0.02 * wiggle(60)
    write_at2(tmp_path, "one_000.AT2", small, title="EVENT, 1/17/1994, ONE, 000")
    write_at2(tmp_path, "two_000.AT2", factor * small, title="EVENT, 1/17/1994, TWO, 000")
    found = read_motions(tmp_path, vertical=False)
    assert len(found.unusable) == 2 * waits
    assert len(found.motions) == 2 * (not waits)
    if waits:
        assert all("a unit, which one of them states wrongly" in unusable.reason for unusable in found.unusable)
        (right,) = read_motions(tmp_path, vertical=False, confirmed=["one_000"]).motions
        assert right.source == "one_000.AT2"
    said = [one.reason if waits else one.notes[-1] for one in (found.unusable if waits else found.motions)]
    for text, (other, times) in zip(said, (("two", factor), ("one", 1.0 / factor)), strict=True):
        assert f"{other}_000.AT2 has the same samples times {times:.4g}" in text


def test_a_sound_copy_is_used_instead_of_one_in_a_wrong_unit(tmp_path):
    """In gal, but called g: 90 g, more intense than the sound one, and refused."""
    write_at2(tmp_path, "gal.AT2", 981.0 * wiggle(60), title=title("0"))
    write_at2(tmp_path, "right_one.AT2", wiggle(60), title=title("0"))
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["right_one.AT2"]
    assert not found.unusable
    assert "981 times as large" in left_out(found)["gal.AT2"]


def test_the_peak_of_a_left_out_vertical_is_heard_of(tmp_path):
    for name, processed, up in (("a", "Uncorrected", 3.0), ("b", "Corrected", 1.0)):
        for way, values in (("90 Deg", A), ("Up", up * C + (up > 1.0) * B)):
            text = cosmos_text(values, way, stage=processed, scnl=f"8040.HN{'Z' if way == 'Up' else 'E'}.NP.D0")
            (tmp_path / f"{name}_{way[:2]}.v1c").write_text(text, encoding="latin-1")
    (motion,) = read_motions(tmp_path).motions
    assert any("vertical: a_Up.v1c, the same recording, left out, has" in note for note in motion.notes)


# One recording in two formats


def csmip(label: str, values, **header) -> list[str]:
    return csmip_channel(label, values / 981.0, volume=1, station="24386", record="24386-S1234-94017.01", **header)


def test_a_csmip_file_and_miniseed_of_the_same_recording_are_one(tmp_path):
    """The station is called 24386 here and CE.VNB there, and the file of film times does not know its time in UTC."""
    series = {way: shaking(seed) for way, seed in (("90", 1), ("Up", 2), ("360", 3))}
    lines = [line for way, values in series.items() for line in csmip(f"{way} Deg", values, modern=False)]
    (tmp_path / "ce24386.v1").write_text("\n".join([*lines, ""]), encoding="latin-1")
    for channel, way in (("HNE", "90"), ("HNZ", "Up"), ("HNN", "360")):
        counts = trace(channel, (1e4 * series[way]).astype(np.int32))
        counts.stats.network, counts.stats.station = "CE", "VNB"
        counts.write(str(tmp_path / f"CE.VNB.{channel}.mseed"), format="MSEED")
    found = read_motions(tmp_path, options=ReadOptions(unit="cm/s2", sensitivity=1e4), confirmed=["*"])
    assert len(found.motions) == 2
    assert len({motion.station for motion in found.motions}) == 1
    assert len(found.left_out) == 3


@pytest.mark.parametrize("sign", [1, -1])
def test_an_smc_file_and_a_cosmos_file_of_the_same_recording_are_one(tmp_path, sign):
    values = shaking(4)
    (tmp_path / "a.smc").write_text(smc_text(values, clock=(-32768,) * 6), encoding="latin-1")
    text = cosmos_text(sign * values, "135 Deg", series={"seconds": 2}, stage="Corrected", scnl="")
    (tmp_path / "b.v2c").write_text(text.replace("NP-8040", "NP-1675") if sign > 0 else text, encoding="latin-1")
    found = read_motions(tmp_path)
    assert len(found.motions) == 1
    (reason,) = left_out(found).values()
    assert ("-1 times as large" in reason) == (sign < 0)


def test_records_that_only_look_alike_stay_two(tmp_path):
    """The same shaking later in the day, by their headers, is another recording."""
    for i, hour in enumerate((17, 18)):
        text = cosmos_text(A + 0.01 * i * B, clock=(2018, 11, 30, hour, 29))
        (tmp_path / f"{i}.v1c").write_text(text, encoding="latin-1")
    assert len(read_motions(tmp_path).motions) == 2


@pytest.mark.parametrize(
    ("cycles", "stretched", "one"),
    [((2,), 1.02, False), ((2, 5, 8), 1.03, False), ((2, 5, 8, 11), 1.04, False), ((2, 5, 8), 1.02, True),
     ((2, 5, 8, 11), 1.03, True)],
)  # fmt: skip
def test_a_few_waves_are_no_copies_of_each_other_however_they_correlate(cycles, stretched, one):
    """Two to seven independent values each: what they correlate by is 4 standard deviations above chance in the last two only."""
    t, north = np.linspace(0.0, 1.0, 400), Orientation("NS", azimuth=0.0)
    waves = (np.hanning(400) * sum(np.sin(2 * np.pi * c * k * t) for c in cycles) for k in (1.0, stretched))
    first, second = (Component("r", 0.01, wave, north) for wave in waves)
    assert alignment.correlation(first.acceleration, second.acceleration) > 0.95
    assert likeness._are_one_recording(first, second) is one


def test_a_copy_of_a_record_of_one_period_is_found_without_a_header(tmp_path):
    """Soft soil near Christchurch swung at 0.5 Hz: 7 independent values, the fewest of the records at hand."""
    (soil,) = (m for m in read_motions(NEAR_FAULT).motions if "NBLC" in m.name and "N00E" in m.name)
    noise = 0.05 * soil.horizontal.std() * np.random.default_rng(1).standard_normal(soil.npts)
    for name, values in (("a", soil.horizontal), ("b", soil.horizontal + noise)):
        rows = "".join(f"{i * soil.dt:.3f} {a:.6f}\n" for i, a in enumerate(values))
        (tmp_path / f"{name}_NS.txt").write_text("time(s) a(m/s2)\n" + rows)
    found = read_motions(tmp_path)
    assert (len(found.motions), len(found.left_out)) == (1, 1)


# Whole sets


def test_components_of_a_station_come_from_one_stream_the_one_with_the_finer_step(tmp_path):
    """A stream at 40 Hz, stronger by chance in one direction, beside that at 200 Hz, of the same sensor."""
    t = np.arange(4000) / 200
    series = {way: 1e5 * np.exp(-((t - 8) ** 2) / 6) * np.sin(7 * t + k) for k, way in enumerate("ENZ")}
    for band, rate, gain in (("B", 40, 1.5), ("H", 200, 1.0)):
        for way, values in series.items():
            each = trace(f"{band}N{way}", (gain * values[:: 200 // rate]).astype(np.int32))
            each.stats.sampling_rate = rate
            each.write(str(tmp_path / f"{band}N{way}.mseed"), format="MSEED")
    options = ReadOptions(unit="cm/s2", sensitivity=1e3)
    found = read_motions(tmp_path, options=options)
    assert [(motion.source, motion.vertical_source) for motion in found.motions] == [
        ("HNE.mseed", "HNZ.mseed"),
        ("HNN.mseed", "HNZ.mseed"),
    ]
    assert len(read_motions(tmp_path, options=options, azimuths=(45.0,)).motions) == 1


def test_a_set_is_chosen_as_a_whole(tmp_path):
    """One instrument has the stronger east component, the other one the stronger north one."""
    for folder, east, north in (("a", 1.5, 1.0), ("b", 1.0, 1.6)):
        noise = wiggle(300, 9, 0.01 if folder == "a" else 0.02)
        for way, values in (("0", north * wiggle(300, 1)), ("90", east * wiggle(300, 2)), ("UP", wiggle(300, 3))):
            write_at2(tmp_path / folder, f"STA{way}.AT2", values + noise, title=title(way))
    found = read_motions(tmp_path, confirmed=["*"])
    used = {motion.source.partition("/")[0] for motion in found.motions}
    assert (len(found.motions), len(used)) == (2, 1)
    assert all(motion.vertical_source.partition("/")[0] in used for motion in found.motions)


def test_copies_by_a_factor_under_other_names_are_all_used_and_say_so(tmp_path):
    for name, factor in (("design_000", 1.0), ("collapse_000", 1.5)):
        rows = "".join(f"{0.01 * i:.2f} {factor * value:.6f}\n" for i, value in enumerate(wiggle(400)))
        (tmp_path / f"{name}.txt").write_text("time(s) a(g)\n" + rows)
    found = read_motions(tmp_path)
    assert len(found.motions) == 2
    assert len({motion.station for motion in found.motions}) == 1
    assert [[finding.what for finding in motion.findings] for motion in found.motions] == [["factor"], ["factor"]]


@pytest.mark.parametrize("factor", [1.0, 9.81, -1.0])
@pytest.mark.parametrize("second", [title("0"), "nothing"])
def test_copies_with_another_step_are_held_back_and_each_step_is_named(tmp_path, factor, second):
    values = wiggle(400)
    write_at2(tmp_path / "a", "x000.AT2", values, title=title("0"))
    write_at2(tmp_path / "b", "y000.AT2", factor * values, dt=".0050", title=second)
    found = read_motions(tmp_path)
    assert not found.motions
    steps = [reason.partition("with a step of ")[2][:5].strip() for reason in (one.reason for one in found.unusable)]
    assert steps == ["0.005", "0.01"]
    assert not any("other samples" in one.reason for one in found.unusable)


def test_copies_at_another_step_of_another_station_are_used_and_say_so(tmp_path):
    for folder, step in (("a", ".0100"), ("b", ".0050")):
        write_at2(tmp_path / folder, "x000.AT2", wiggle(400), dt=step, title=f"Made-up, 1/17/1994, Station {folder}, 0")
    found = read_motions(tmp_path)
    assert [[finding.what for finding in motion.findings] for motion in found.motions] == [["step"], ["step"]]
    assert "has the same samples with a step of 0.005 s" in found.motions[0].findings[0].text


@pytest.mark.parametrize("place", ["STA_{}_raw.txt", "STA_{}_uncorrected.txt", "raw/STA_{}.txt"])
def test_of_two_sets_the_one_that_is_called_raw_is_left_out(tmp_path, place):
    for seed, way in enumerate("NEZ", 1):
        for called, noise in (
            (place, 0.004),
            ("published/STA_{}_2.txt" if "/" in place else "STA_{}_corrected as published.txt", 0.0),
        ):
            rows = wiggle(400, seed) + noise * wiggle(400, 7)
            (tmp_path / called.format(way)).parent.mkdir(exist_ok=True)
            (tmp_path / called.format(way)).write_text(
                "time(s) a(g)\n" + "".join(f"{0.01 * i:.2f} {a:.6f}\n" for i, a in enumerate(rows))
            )
    found = read_motions(tmp_path)
    assert len(found.motions) == 2
    assert all("published" in motion.source and "published" in motion.vertical_source for motion in found.motions)


def test_a_copy_that_is_cut_stands_back_behind_the_whole_record_whatever_their_names(tmp_path):
    for seed, way in enumerate(("000", "090", "UP"), 1):
        write_at2(tmp_path, f"RSN5_A_STATION{way}.AT2", wiggle(500, seed), title=title(way))
        write_at2(tmp_path, f"S{way}_cut.AT2", wiggle(500, seed)[150:], title=title(way))
    found = read_motions(tmp_path)
    assert [motion.npts for motion in found] == [500, 500]
    assert set(left_out(found)) == {f"S{way}_cut.AT2" for way in ("000", "090", "UP")}


def test_zeros_around_a_copy_do_not_make_it_the_longer_record(tmp_path):
    for seed, way in enumerate(("000", "090", "UP"), 1):
        values = wiggle(500, seed) * np.sin(np.pi * np.arange(500) / 499)
        write_at2(tmp_path, f"A_{way}.AT2", values, title=title(way))
        write_at2(
            tmp_path, f"A_{way}_padded.AT2", np.concatenate((np.zeros(150), values, np.zeros(300))), title=title(way)
        )
    found = read_motions(tmp_path)
    assert [motion.npts for motion in found] == [500, 500]


# Sources


def test_a_file_with_a_plus_in_its_name_is_one_source(tmp_path):
    write_at2(tmp_path, "A + B 000.AT2", wiggle(400), title="Made-up, 1/17/1994, Test Station, 000")
    write_at2(tmp_path, "the copy of A + B 000.AT2", wiggle(400), title="Made-up, 1/17/1994, Test Station, 000")
    found = read_motions(tmp_path)
    assert [motion.sources for motion in found] == [("A + B 000.AT2",)]
    (reason,) = left_out(found).values()
    assert reason.startswith("a copy of A + B 000.AT2, which is used")


def test_a_copy_of_both_horizontals_of_a_rotated_motion_is_of_files_that_are_used(tmp_path):
    for folder in ("a", "b"):
        for seed, way in enumerate(("000", "090"), 1):
            write_at2(tmp_path / folder, f"RSN7_X_STA{way}.AT2", wiggle(80, seed), title=f"X, 1/17/1994, STA, {way}")
    found = read_motions(tmp_path, azimuths=(30.0,))
    assert [motion.sources for motion in found] == [("a/RSN7_X_STA000.AT2", "a/RSN7_X_STA090.AT2")]
    assert all("which is used" in reason for reason in left_out(found).values())
    assert [double.sources for double in found.left_out] == [("b/RSN7_X_STA000.AT2",), ("b/RSN7_X_STA090.AT2",)]
