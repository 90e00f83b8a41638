"""Of several copies of a recording one is used, as a whole set, and nothing counts twice: on files made here."""

from pathlib import Path

import numpy as np
import pytest
from agency_files import dyna_text
from fixed_column_files import A, B, C, cosmos_text, csmip_channel, smc_text
from motion_files import wiggle, write_at2
from national_files import unam_text
from waveform_files import trace

from rockbatch.motions import ReadOptions, doubles, likeness, read_motions
from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.orientation import Orientation

NEAR_FAULT = Path(__file__).parents[2] / "motions" / "near_fault"
DATE = "FECHA DEL SISMO [GMT]"


def title(component: str, station: str = "STA", event: str = "Somewhere, 1/17/1994") -> str:
    return f"{event}, {station}, {component}"


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
    assert likeness.correlation(first.acceleration, second.acceleration) > 0.95
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


def write_set(folder, first, second, upright, labels=("000", "090"), titled=title):
    for way, values in ((labels[0], first), (labels[1], second), ("UP", upright)):
        write_at2(folder, f"{folder.name}{way}.AT2", values, title=titled(way))


def shaken(seed: int, n: int = 1500):
    """Two horizontal components and a vertical one, the second horizontal one half as strong."""
    return [scale * wiggle(n, seed + k) * np.hanning(n) for k, scale in enumerate((1.0, 0.5, 0.4))]


def turned(first, second, angle: float):
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return c * first + s * second, c * second - s * first


FRAMES = {
    "turned by 37°": (lambda a, b: turned(a, b, 37.0), ("037", "127")),
    "turned by 37°, as if it were not": (lambda a, b: turned(a, b, 37.0), ("000", "090")),
    "an azimuth that is off by 180°": (lambda a, b: (a, b), ("180", "090")),
    "both reversed": (lambda a, b: (-a, -b), ("000", "090")),
    "swapped": (lambda a, b: (b, a), ("010", "100")),
    "H1 and H2": (lambda a, b: turned(a, b, 12.0), ("H1", "H2")),
    "a mirror image, 1.02 times as strong": (lambda a, b: (1.02 * b, 1.02 * a), ("020", "110")),
}  # fmt: skip
"""What was done to the horizontal components of a copy, and how they are labelled."""


@pytest.mark.parametrize("frame", FRAMES)
def test_a_copy_in_another_frame_is_left_out_whole(tmp_path, frame):
    change, labels = FRAMES[frame]
    first, second, upright = shaken(10)
    write_set(tmp_path / "a", first, second, upright)
    write_set(tmp_path / "longer", *change(first, second), upright, labels)
    found = read_motions(tmp_path, confirmed=["*"], options=ReadOptions(role="horizontal"))
    assert len(found.motions) == 2
    assert {motion.source.partition("/")[0] for motion in found.motions} == {"a"}
    assert all(motion.vertical_source == "a/aUP.AT2" for motion in found.motions)
    assert sorted(double.source.partition("/")[0] for double in found.left_out) == ["longer"] * 3


def test_a_cut_copy_is_left_out_whole_though_one_component_has_grown(tmp_path):
    first, second, upright = (a * np.hanning(1500) ** 4 for a in shaken(5))
    second = second + 0.012 * np.random.default_rng(1).standard_normal(
        1500
    )  # goes on from the first to the last sample
    write_set(tmp_path / "a", first, second, upright)
    write_set(
        tmp_path / "longer", *(a[250:1250] for a in (first, second, upright)), titled=lambda way: f"a copy, {way}"
    )
    found = read_motions(tmp_path, confirmed=["*"])
    assert [motion.source for motion in found.motions] == ["a/a000.AT2", "a/a090.AT2"]
    assert len(found.left_out) == 3


@pytest.mark.parametrize("share", [0.0, 0.9])
def test_a_set_that_shares_its_vertical_only_is_another_recording(tmp_path, share):
    """As of a neighbour's, whose horizontal components are alike to ``share``: they are used, in any frame."""
    first, second, upright = shaken(1)
    others = [share * a + np.sqrt(1.0 - share**2) * b for a, b in zip((first, second), shaken(51), strict=False)]
    write_set(tmp_path / "a", first, second, upright)
    write_set(tmp_path / "longer", *turned(*others, 25.0), upright, ("025", "115"))
    found = read_motions(tmp_path, confirmed=["*"])
    assert len(found.motions) == 4
    assert all(motion.vertical is not None for motion in found.motions)
    remarks = [[finding.text for finding in motion.findings if finding.what == "vertical"] for motion in found.motions]
    text = "its vertical component longer/longerUP.AT2 is a/aUP.AT2, of other horizontals: check which of them has it"
    assert remarks == [[], [], [text], [text]]


def earthquake(seed: int, n: int = 4000):
    """Return two horizontal components [g] at 100 Hz that grow for 6 s and fade, with most energy around 2 Hz."""
    t, f = np.arange(n) / 100, np.fft.rfftfreq(n, 0.01)
    amplitude = f / (f + 0.2) / np.hypot(1.0 - (f / 2.0) ** 2, 0.6 * f)
    noise = np.fft.rfft(np.random.default_rng(seed).standard_normal((2, n)))
    a = (t / 6) ** 2 * np.exp(2 - t / 3) * np.fft.irfft(amplitude * noise, n)
    return 0.3 * a / np.abs(a).max()


def in_band(a, low: float, high: float):
    """Return what a Butterworth filter of order 4, run forwards and backwards, leaves."""
    f = np.fft.rfftfreq(a.shape[-1], 0.01)[1:]
    gain = np.append(0.0, 1.0 / (1.0 + (low / f) ** 8) / (1.0 + (f / high) ** 8))
    return np.fft.irfft(gain * np.fft.rfft(a), a.shape[-1])


CHANGES = {
    "turned": lambda a: np.array(turned(*a, 37.0)),
    "cut to 1-11 s": lambda a: a[:, 100:1100],
    "cut to 5.5 s": lambda a: a[:, 100:650],
    "cut and turned": lambda a: np.array(turned(*a[:, 100:1100], 61.0)),
    "filtered to 1-5 Hz": lambda a: in_band(a, 1.0, 5.0),
    "filtered to 1-5 Hz, cut and turned": lambda a: np.array(turned(*in_band(a, 1.0, 5.0)[:, 100:1100], 110.0)),
    "filtered to 0.3-8 Hz, reversed, half as strong": lambda a: -0.5 * in_band(a, 0.3, 8.0),
}  # fmt: skip
"""What was done to a copy without a vertical, of which no component is as it was."""


def write_pair(folder, pair, labels=("000", "090"), **header):
    for label, values in zip(labels, pair, strict=True):
        write_at2(folder, f"{folder.name}{label}.AT2", values, title=f"nothing, {label}", **header)


@pytest.mark.parametrize("change", CHANGES)
def test_a_copy_without_a_vertical_of_which_no_component_is_alike_is_left_out_whole(tmp_path, change):
    first = earthquake(1)
    write_pair(tmp_path / "a", first)
    write_pair(tmp_path / "longer", CHANGES[change](first), ("037", "127") if "turned" in change else ("000", "090"))
    found = read_motions(tmp_path, confirmed=["*"])
    (used,) = {motion.source.partition("/")[0] for motion in found.motions}
    assert (len(found.motions), len(found.left_out)) == (2, 2)
    for double in found.left_out:
        assert double.source.partition("/")[0] != used
        assert double.reason.startswith(f"the same recording as {used}/")


def test_the_likeness_of_two_sets_is_the_greatest_of_all_alignments():
    """By trying them: half a degree apart, of which the cosine costs 1e-5."""
    rng = np.random.default_rng(4)
    a, b = rng.standard_normal((2, 2, 400)) * np.hanning(400) ** 2
    b[:, :350] += 2.0 * np.array(turned(a[1], a[0], 37.0))[:, 50:]
    a, b = (x - x.mean(axis=1, keepdims=True) for x in (a, b))
    north = Orientation("000", azimuth=0.0)
    sets = ([Component(str(k), 0.01, x, north) for k, x in enumerate(side)] for side in (a, b))
    angles, tried = np.radians(np.arange(0.0, 360.0, 0.5)), []
    for shift in range(-100, 101):
        x, y = a[:, max(0, shift) : 400 + min(0, shift)], b[:, max(0, -shift) : 400 - max(0, shift)]
        (xx, xy), (yx, yy) = each = x @ y.T
        turning = np.cos(angles) * (xx + yy) + np.sin(angles) * (xy - yx)
        mirrored = np.cos(angles) * (xx - yy) + np.sin(angles) * (xy + yx)
        best = max(turning.max(), mirrored.max()) / np.sqrt((x * x).sum() * (y * y).sum())
        tried.append((best, shift, each))
    best, shift, each = max(tried, key=lambda one: one[0])
    found = likeness._greatest_likeness(*sets, 1)
    assert shift == 50
    assert found.correlation == pytest.approx(best, rel=2e-5)
    np.testing.assert_allclose(found.each, np.abs(each))
    slow = np.sin(np.linspace(0.0, 30.0, 1000))[None]
    assert likeness._coherence(slow, slow, 0.01) == 0.0  # of too few bands


def test_a_decimated_and_turned_copy_is_left_out_whole(tmp_path):
    first = in_band(earthquake(3), 0.1, 15.0)
    write_pair(tmp_path / "a", first)
    write_pair(tmp_path / "longer", turned(*first[:, ::2], 20.0), ("020", "110"), dt=".0200")
    found = read_motions(tmp_path, confirmed=["*"])
    assert [motion.source for motion in found.motions] == ["a/a000.AT2", "a/a090.AT2"]


def neighbour(a, seed: int, per_hz: float | None = None, r: float = 0.975):
    """Return what an instrument nearby records: alike to ``r``, or less and less with the frequency."""
    f = np.fft.rfftfreq(a.shape[-1], 0.01)
    coherence = r if per_hz is None else np.exp(-per_hz * f)
    own = np.fft.rfft(earthquake(seed))
    return np.fft.irfft(coherence * np.fft.rfft(a) + np.sqrt(1.0 - coherence**2) * own, a.shape[-1])


def basin_waves(seed: int):
    """Return waves of 0.5 Hz that last, as deep basins have them."""
    rng, t = np.random.default_rng(seed), np.arange(6000) / 100
    phases = np.pi * t + rng.uniform(0.0, 6.0, (2, 1))
    slow = np.sin(t / 17 + rng.uniform(0.0, 6.0)) + 2.0
    return 0.05 * slow * np.sin(phases) + 0.002 * rng.standard_normal((2, 6000))


OTHERS = {
    "another seed of one spectrum": lambda a: earthquake(51),
    "a neighbour": lambda a: neighbour(a, 52),
    "a close neighbour": lambda a: neighbour(a, 57, r=0.983),
    "a near one": lambda a: neighbour(a, 53, 0.005),
    "a neighbour, filtered": lambda a: in_band(neighbour(a, 54), 1.0, 5.0),
    "a near one, filtered": lambda a: in_band(neighbour(a, 55, 0.005), 1.0, 5.0),
    "an aftershock": lambda a: 0.4 * (0.3 * a + np.roll(earthquake(56), 70, axis=1)),
}  # fmt: skip


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("seed", [1, 2])
def test_what_only_resembles_a_set_in_another_frame_is_another_recording(tmp_path, other, seed):
    first = earthquake(seed)
    write_pair(tmp_path / "a", first)
    write_pair(tmp_path / "longer", turned(*OTHERS[other](first), 60.0), ("060", "150"))
    assert len(read_motions(tmp_path, confirmed=["*"]).motions) == 4


def test_waves_of_basins_are_no_copies_of_each_other_in_any_frame(tmp_path):
    for seed in range(4):
        write_pair(tmp_path / f"r{seed}", basin_waves(seed), (f"{10 * seed:03d}", f"{10 * seed + 90:03d}"))
    assert len(read_motions(tmp_path, confirmed=["*"]).motions) == 8


@pytest.mark.parametrize(("other", "same"), [(Sensor("B", "CI"), False), (Sensor("B", "NP"), True)])
def test_a_turned_copy_at_another_station_of_the_network_is_another_recording(other, same):
    """Two instruments on one pad: of two networks, which name the station as they like, one is used and names the other."""
    first = earthquake(1)
    sets = (("a", Sensor("A", "CI"), first, 0.0), ("b", other, turned(*first, 30.0), 30.0))
    components = [
        Component(f"{name}{k}", 0.01, values, Orientation("", azimuth=azimuth + 90.0 * k), source=f"{name}{k}", folder=name,
                  sensor=sensor, station=name)
        for name, sensor, pair, azimuth in sets for k, values in enumerate(pair)
    ]  # fmt: skip
    kept, left = doubles.without_doubles(components)
    assert len(kept) == (2 if same else 4)
    assert all("the same recording as a" in double.reason for double in left)


def test_other_recordings_are_hardly_compared_in_any_frame(monkeypatch):
    """Each comparison takes four Fourier transforms; their number may not grow with the square of that of the sets."""
    compared = []
    plain = likeness._greatest_likeness
    monkeypatch.setattr(likeness, "_greatest_likeness", lambda *sets: (compared.append(sets), plain(*sets))[1])
    components = [
        Component(f"{n}.{k}", 0.01, values, Orientation("", azimuth=90.0 * k), source=f"{n}.{k}", station=str(n))
        for n in range(60) for k, values in enumerate(earthquake(n))
    ]  # fmt: skip
    assert len(doubles.without_doubles(components)[0]) == 120
    assert len(compared) < 6  # of 1770


@pytest.fixture
def correlations(monkeypatch):
    """The correlations that were computed, each of which takes a Fourier transform of the samples."""
    computed: list[float] = []
    plain = likeness.correlation

    def noted(one, two):
        computed.append(plain(one, two))
        return computed[-1]

    monkeypatch.setattr(likeness, "correlation", noted)
    return computed


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("events", [True, False])
def test_sets_are_found_in_time_that_grows_with_their_number(tmp_path, correlations, events):
    """Records of one station in many earthquakes, or without a header, are hardly compared sample by sample."""
    for i in range(60):
        if events:
            said = title("0", event=f"E{i}, 1/{i % 28 + 1}/{1960 + i}")
            write_at2(tmp_path, f"r{i}.AT2", wiggle(200, i + 1), title=said)
        else:
            rows = "".join(f"{0.01 * k:.2f} {value:.6f}\n" for k, value in enumerate(wiggle(200, i + 1)))
            (tmp_path / f"r{i}_NS.txt").write_text("time(s) a(g)\n" + rows)
    assert len(read_motions(tmp_path).motions) == 60
    assert len(correlations) < 60


@pytest.mark.parametrize("change", ["half the step", "reversed", "noise", "cut", "another scale"])
def test_spectra_rule_out_no_copy_that_the_samples_tell(change):
    """A correlation is computed, and decides, however a recording of a narrow band was changed on its way."""
    a = np.convolve(wiggle(4000, 5), np.hanning(40), "same")
    b, dt = {
        "half the step": (np.interp(np.arange(0, 3999, 0.5), np.arange(4000), a), 0.005),
        "reversed": (-np.roll(a, 7), 0.01),
        "noise": (a + 0.12 * a.std() * np.random.default_rng(1).normal(size=len(a)), 0.01),
        "cut": (a[100:3900], 0.01),
        "another scale": (981.0 * a, 0.01),
    }[change]
    north = Orientation("000", azimuth=0.0)
    one, two = Component("a", 0.01, a, north, source="a"), Component("b", dt, b, north, source="b")
    assert list(likeness._Table([one, two]).similar_pairs()) == [(0, 1)]


def test_copies_by_a_factor_under_other_names_are_all_used_and_say_so(tmp_path):
    for name, factor in (("design_000", 1.0), ("collapse_000", 1.5)):
        rows = "".join(f"{0.01 * i:.2f} {factor * value:.6f}\n" for i, value in enumerate(wiggle(400)))
        (tmp_path / f"{name}.txt").write_text("time(s) a(g)\n" + rows)
    found = read_motions(tmp_path)
    assert len(found.motions) == 2
    assert len({motion.station for motion in found.motions}) == 1
    assert [[finding.what for finding in motion.findings] for motion in found.motions] == [["factor"], ["factor"]]


def test_steps_that_differ_by_half_a_per_cent_are_not_one_step():
    """After 40 s they are 0.2 s apart: sample by sample, one recording would look like two."""
    t, fine = np.arange(0.0, 40.0, 0.01), np.arange(0.0, 40.0, 0.01005)
    north, noise = Orientation("000", azimuth=0.0), np.random.default_rng(5).normal(size=400)

    def shaken(times):
        return np.interp(times, np.linspace(0.0, 40.0, 400), noise)

    one, two = (
        Component("a", 0.01, shaken(t), north, source="a"),
        Component("b", 0.01005, shaken(fine), north, source="b"),
    )
    assert likeness._are_one_recording(one, two)


def test_series_that_never_move_have_no_independent_values():
    assert likeness._independent_values(np.ones(100), np.ones(100)) == 0.0
    moving = np.random.default_rng(0).normal(size=(2, 4096))  # of white noise each sample is one, to its scatter
    assert likeness._independent_values(*moving) == pytest.approx(4096.0, rel=0.1)
