"""What is no ground acceleration is refused or left out, files that say enough are read, and one file costs no folder."""

import io

import agency_files as agency
import numpy as np
import pytest
from agency_files import dyna_text, knet_text
from fixed_column_files import A, B, C, csmip_channel, csmip_text, film_text, smc_text
from motion_files import state_of, wiggle, write_at2
from national_files import afad_text, unam_text
from obspy import Trace
from waveform_files import trace

from rockbatch.commands.cli import main
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.manifest_draft import draft, write_manifest


def only_reason(found) -> str:
    (refused,) = found.unusable
    return refused.reason


# Other quantities


def write_sac(path, channel: str = "", idep: int | None = None, rate: float = 100.0, order: str = "<") -> None:
    record = Trace((wiggle(300) * 9.81).astype(np.float32), {"sampling_rate": rate, "channel": channel})
    record.stats.sac = {"cmpaz": 0.0, "cmpinc": 90.0, **({} if idep is None else {"idep": idep})}
    target = io.BytesIO()
    record.write(target, format="SAC", byteorder=order)
    path.write_bytes(target.getvalue())


@pytest.mark.parametrize(("channel", "idep"), [("HNN", 6), ("HNN", 7), ("HHN", 8), ("BHN", None)])
@pytest.mark.parametrize("order", ["<", ">"])
def test_a_sac_file_of_velocity_or_displacement_needs_a_manifest(tmp_path, channel, idep, order):
    write_sac(tmp_path / "x.sac", channel, idep, order=order)
    options = ReadOptions(unit="m/s2")
    assert "accelerations are expected; if it does hold them" in only_reason(read_motions(tmp_path, options=options))
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x.sac"\nunit = "m/s2"\n')
    assert len(read_motions(tmp_path).motions) == 1


def test_a_seismometer_s_channel_is_no_acceleration_whatever_sensitivity_is_stated(tmp_path):
    for channel in ("HHE", "BHN", "HNE"):
        trace(channel, (1e5 * wiggle(600)).astype(np.int32)).write(str(tmp_path / f"{channel}.mseed"), format="MSEED")
    found = read_motions(tmp_path, options=ReadOptions(sensitivity=1e4))
    assert [motion.source for motion in found.motions] == ["HNE.mseed"]
    assert all("holds velocities (channel" in refused.reason for refused in found.unusable)


def test_a_displacement_of_more_than_100_m_is_asked_for_even_unprocessed(tmp_path):
    a = wiggle(20000, 1, 0.4) + 0.002  # 392 m in 200 s
    write_at2(tmp_path, "x.AT2", a, title="nothing, 000")
    assert "its displacement reaches" in only_reason(read_motions(tmp_path))
    assert len(read_motions(tmp_path, confirmed=["x"]).motions) == 1


# Structures and boreholes


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("x.txt", afad_text(PLACE="ELAZIG KEBAN (KRET-CREST)")),
        ("x.ASC", dyna_text(STATION_NAME="KEBAN (KRET-CREST)")),
        ("x.V2", "\n".join([*csmip_channel("90 Deg", A, volume=2, place="Downhole 30 m"), ""])),
        ("x.191", unam_text(**{"NOMBRE DE LA ESTACION": "TORRE (ROOF)"})),
    ],
)
def test_crests_roofs_and_boreholes_are_flagged_in_every_format(tmp_path, name, text):
    (tmp_path / name).write_text(text, encoding="latin-1")
    found = read_motions(tmp_path)
    assert not found.motions
    assert any(
        "not on the ground" in refused.reason or "not at the surface" in refused.reason for refused in found.unusable
    )


@pytest.mark.parametrize(
    ("station", "used"), [("Dam, L Abut", 0), ("Dam (crest)", 0), ("Hillcrest", 1), ("Crest Dr", 1), ("Crest Drive", 1)]
)
def test_the_station_of_an_at2_file_may_be_in_a_structure(tmp_path, station, used):
    write_at2(tmp_path, "x.AT2", wiggle(60), title=f"Somewhere, 1/17/1994, {station}, 000")
    assert len(read_motions(tmp_path).motions) == used


def test_a_borehole_is_used_beside_its_surface_if_that_is_stated(tmp_path):
    for direction, suffix in ((2, "EW1"), (5, "EW2")):
        (tmp_path / f"TST.{suffix}").write_text(knet_text(str(direction))[0])
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "TST.EW1"\nuse = true\nconfirm = true\n')
    assert len(read_motions(tmp_path).motions) == 2


# Files that say enough


@pytest.mark.parametrize(
    "changed",
    [
        {"ACEL. MAX.(Gal), C1-C6": None, "ACEL. MAX. (Gal), C1-C6": "/1.0/2.0/3.0"},
        {"ORIENTACION C1-C6 (rumbo;orientacion)": "/N00E;/N90E;/V;+"},
        {"FACTOR DE DECIMACION": None},
        {"FORMATO DATOS (FORTRAN,10 campos/dato)": "(3F10.4)"},
        {"NUM. TOTAL DE MUESTRAS, C1-C6": "/42/42/42"},
    ],
)
def test_files_of_unam_s_sister_institutes_are_read(tmp_path, changed):
    (tmp_path / "x.191").write_text(unam_text(**changed), encoding="latin-1")
    found = read_motions(tmp_path, confirmed=["*"])
    assert [motion.azimuth for motion in found.motions] == [0.0, 90.0]
    npts = found.motions[0].npts
    expected = agency.A[:npts] - agency.A[:npts].mean()
    np.testing.assert_allclose(found.motions[0].horizontal * 100, expected, atol=1e-4)


def test_a_unam_file_in_exponents_is_read(tmp_path):
    text = unam_text(columns=(A, B, C), **{"FORMATO DATOS (FORTRAN,10 campos/dato)": "3E16.7"})
    head = text[: text.index("DATOS DE ACELERACION")]
    rows = "\n".join("".join(f"{value:16.7E}" for value in row) for row in zip(A, B, C, strict=True))
    data = f"DATOS DE ACELERACION:\n-----\nCANAL-1 CANAL-2 CANAL-3\nN00E; N90E; V;+\n-----\n{rows}\n"
    (tmp_path / "x.dat").write_text(head + data, encoding="latin-1")
    one, two = read_motions(tmp_path).motions
    np.testing.assert_allclose(one.horizontal * 100, A - A.mean(), atol=1e-9)
    np.testing.assert_allclose(two.horizontal * 100, B - B.mean(), atol=1e-9)


@pytest.mark.parametrize(
    "rate", [1.0, 120.0, 125.0, 128.0, 150.0, 204.8, 250.0, 256.0, 300.0, 409.6, 500.0, 512.0, 1e5]
)
def test_sac_files_of_every_usual_rate_are_read(tmp_path, rate):
    write_sac(tmp_path / "x.sac", "HNN", rate=rate)
    (motion,) = read_motions(tmp_path, options=ReadOptions(unit="m/s2"), confirmed=["*"]).motions
    assert motion.dt == pytest.approx(1.0 / rate, rel=2e-6)  # ObsPy writes some steps in whole microseconds


def wrapped(values, per_line: int = 5) -> str:
    lines = [" ".join(f"{value:.6f}" for value in values[i : i + per_line]) for i in range(0, len(values), per_line)]
    return "\n".join([*lines, ""])


@pytest.mark.parametrize("npts", [60, 63])
def test_one_series_that_goes_on_from_line_to_line_is_read_if_that_is_stated(tmp_path, npts, capsys):
    values = wiggle(npts)
    (tmp_path / "quake_000.txt").write_text(wrapped(values))
    stated = ReadOptions(unit="g", dt=0.01)
    assert 'write layout = "wrapped"' in only_reason(read_motions(tmp_path, options=stated))
    (motion,) = read_motions(tmp_path, options=ReadOptions(unit="g", dt=0.01, layout="wrapped")).motions
    np.testing.assert_allclose(motion.horizontal, 9.81 * values, atol=1e-5)
    assert main(["motions", "--all", str(tmp_path), "--unit", "g", "--dt", "0.01", "--layout", "wrapped"]) == 0
    assert str(npts) in capsys.readouterr().out
    lines = 'unit = "g"\ndt = 0.01\nlayout = "wrapped"\n'
    (tmp_path / "motions.toml").write_text(f'[[record]]\nfile = "quake_000.txt"\n{lines}')
    assert read_motions(tmp_path).motions[0].npts == npts


# Drafted manifests


def test_the_draft_of_a_building_addresses_its_channels_by_number(tmp_path):
    """Twelve channels, of which several point the same way."""
    lines = []
    for i in range(12):
        values = wiggle(120, i + 1, 90.0)
        lines += csmip_channel(
            ("90 Deg", "360 Deg", "Up")[i % 3], values, volume=2, number=i + 1, place=f"Channel {i + 1}"
        )
    (tmp_path / "x.V2").write_text("\n".join([*lines, ""]), encoding="latin-1")
    before = state_of(read_motions(tmp_path))
    text = write_manifest(tmp_path).read_text(encoding="utf-8")
    assert "component = 12\n" in text
    assert state_of(read_motions(tmp_path)) == before
    assert main(["motions", "--all", str(tmp_path)]) < 2


def test_a_component_can_be_meant_by_its_number(tmp_path):
    for name, text in (
        ("motions.toml", '[[record]]\nfile = "x.V2"\ncomponent = 2\nuse = false\n'),
        ("motions.csv", "file,component,use\nx.V2,2,false\n"),
    ):
        lines = [*csmip_channel("90 Deg", A, volume=2), *csmip_channel("90 Deg", B, volume=2)]
        (tmp_path / "x.V2").write_text("\n".join([*lines, ""]), encoding="latin-1")
        (tmp_path / name).write_text(text)
        found = read_motions(tmp_path)
        assert (len(found.motions), len(found.left_out)) == (1, 1)
        (tmp_path / name).unlink()


def test_an_untouched_draft_changes_no_name_and_what_joins_components_is_no_name(tmp_path):
    write_at2(tmp_path, "RSN7_X_S000.AT2", wiggle(60, 1), title="New Brighton, 1/17/1994, New Brighton Library, 000")
    write_at2(tmp_path, "RSN7_X_SUP.AT2", wiggle(60, 2), title="New Brighton, 1/17/1994, New Brighton Library, UP")
    (tmp_path / "NB.V2").write_text(csmip_text(2), encoding="latin-1")
    before = state_of(read_motions(tmp_path))
    text = write_manifest(tmp_path).read_text(encoding="utf-8")
    assert state_of(read_motions(tmp_path)) == before
    (tmp_path / "motions.toml").write_text(text.replace("# station =", "station ="), encoding="utf-8")
    assert all(
        m.origin.station == "New Brighton Library" for m in read_motions(tmp_path).motions if m.name.startswith("RSN")
    )


def test_the_draft_of_counts_does_not_state_a_unit_without_its_sensitivity(tmp_path):
    write_sac(tmp_path / "x.sac", "HNN")
    assert "\nunit =" not in draft(tmp_path, ReadOptions(sensitivity=1e4))


# What nobody misses


def test_what_lies_beside_records_is_left_out_and_the_exit_code_is_0(tmp_path):
    (tmp_path / "a.V2").write_text(csmip_text(2), encoding="latin-1")
    (tmp_path / "a.V3").write_text(
        "Response and Fourier Spectra\nCorrected accelerogram\n" + csmip_text(1), encoding="latin-1"
    )
    for name in ("a.vel", "a.disp", "event.yml", "map.geojson", "LICENSE", "a.vt2"):
        (tmp_path / name).write_text("whatever\n")
    (tmp_path / "notes.txt").write_text("Received in 2019.\nMagnitude\n6.7\nand it was cold.\n")
    (tmp_path / "velocity.txt").write_text("time(s) velocity(cm/s)\n" + "".join(f"{i / 100} {i}\n" for i in range(50)))
    (tmp_path / "records.xlsx").write_bytes(b"PK\x03\x04")
    found = read_motions(tmp_path)
    assert not found.unusable
    reasons = {left.source: left.reason for left in found.left_out}
    assert len(reasons) == 10
    assert "if it holds records, save its sheets as CSV" in reasons["records.xlsx"]
    assert "Volume 3, spectra" in reasons["a.V3"]
    assert main(["motions", "--all", str(tmp_path)]) == 0


def test_notes_above_the_folders_of_records_and_files_of_the_system_are_no_failure(tmp_path):
    write_at2(tmp_path / "event" / "station", "x.AT2", wiggle(60), title="EVENT, 1/17/1994, STATION, 000")
    notes = "Received in 2019.\nand it was cold.\n"
    for name in ("notes.txt", "event/notes.txt"):
        (tmp_path / name).write_text(notes)
    (tmp_path / "Thumbs.db").write_bytes(b"\xd0\xcf\x11\xe0")
    found = read_motions(tmp_path)
    assert (len(found.unusable), len(found.left_out)) == (0, 3)
    assert main(["motions", str(tmp_path)]) == 0
    elsewhere = tmp_path / "event" / "other"
    elsewhere.mkdir()
    (elsewhere / "notes.txt").write_text(notes)  # beside no record, and below none
    assert [file.source for file in read_motions(tmp_path).unusable] == ["event/other/notes.txt"]


def test_alone_they_were_meant_and_the_exit_code_is_1(tmp_path):
    (tmp_path / "a.V3").write_text(
        "Response and Fourier Spectra\nCorrected accelerogram\n" + csmip_text(1), encoding="latin-1"
    )
    assert "Volume 3, spectra" in only_reason(read_motions(tmp_path))
    assert main(["motions", "--all", str(tmp_path)]) == 1


def test_a_damaged_table_beside_records_was_meant(tmp_path):
    write_at2(tmp_path, "x.AT2", wiggle(60), title="nothing, 000")
    rows = [f"{i / 100} {value:.6f}" for i, value in enumerate(wiggle(60))]
    (tmp_path / "y_000.txt").write_text("\n".join(["time(s) a(g)", *rows[:30], "and here it ends", *rows[30:], ""]))
    assert "expected 2 numbers as above" in only_reason(read_motions(tmp_path))


# Names


def test_turkish_texts_and_those_of_web_pages_are_legible(tmp_path):
    (tmp_path / "x.txt").write_bytes(afad_text(PLACE="MU\xd0LA &#40;MERKEZ&#41;").encode("latin-1"))
    assert {m.origin.station for m in read_motions(tmp_path).motions} == {"Muğla (Merkez)"}


def test_an_event_that_is_a_time_is_shown_as_one(tmp_path):
    (tmp_path / "x.ASC").write_text(dyna_text(EVENT_NAME="201011142308"))
    assert read_motions(tmp_path).motions[0].origin.event == "2010-11-14 23:08"


def test_turned_pairs_of_a_station_keep_their_sensor_in_their_names(tmp_path):
    for direction, suffix in ((1, "NS1"), (2, "EW1"), (4, "NS2"), (5, "EW2")):
        (tmp_path / f"TST.{suffix}").write_text(knet_text(str(direction), seed=direction % 3)[0])
    lines = [f'[[record]]\nfile = "TST.{suffix}"\nuse = true\nconfirm = true\n' for suffix in ("NS1", "EW1")]
    (tmp_path / "motions.toml").write_text("".join(lines))
    names = [motion.name for motion in read_motions(tmp_path, azimuths=(30.0,)).motions]
    assert sorted(names) == ["TST.EW1_az030", "TST.EW2_az030"]


def test_a_series_with_a_stated_count_needs_no_layout_and_numbers_may_touch(tmp_path):
    values = np.round(wiggle(43), 5)
    rows = ["".join(f"{value:8.5f}" for value in values[i : i + 8]) for i in range(0, 43, 8)]
    head = "Corrected record\nNumber of points: 43\nSampling interval: 0.01 s\nunits: g\n"
    (tmp_path / "sta_000.cor.acc").write_text(head + "\n".join([*rows, ""]))
    (motion,) = read_motions(tmp_path).motions
    np.testing.assert_allclose(motion.horizontal, 9.81 * values, atol=1e-9)


def test_columns_can_be_named_by_a_line_of_components(tmp_path):
    rows = [f"{a:.6f} {b:.6f} {c:.6f}" for a, b, c in zip(*(wiggle(60, k) for k in (1, 2, 3)), strict=True)]
    (tmp_path / "x.txt").write_text("\n".join(["units: g", "dt: 0.01 s", "components: E N Z", *rows, ""]))
    found = read_motions(tmp_path)
    assert [motion.azimuth for motion in found.motions] == [90.0, 0.0]
    assert all(motion.vertical is not None for motion in found.motions)


@pytest.mark.parametrize(
    "header",
    ["Acceleration (g)\nNPTS= 60, DT= .02 SEC", "El Centro 1940 NS acceleration (g), NPTS= 60, DT= .02 SEC"],
)
def test_el_centro_goes_from_hand_to_hand_with_little_header(tmp_path, header):
    values = wiggle(60)
    (tmp_path / "elcentro_000.at2").write_text(f"{header}\n{wrapped(values)}")
    (motion,) = read_motions(tmp_path).motions
    assert (motion.npts, motion.dt) == (60, 0.02)
    np.testing.assert_allclose(motion.horizontal, 9.81 * values, atol=1e-5)


def test_degrees_may_have_an_r_behind_in_csmip_files(tmp_path):
    text = "\n".join([*csmip_channel("270 DegR", A, volume=2), ""])
    (tmp_path / "x.V2").write_text(text, encoding="latin-1")
    assert [motion.azimuth for motion in read_motions(tmp_path).motions] == [270.0]


def test_film_with_a_gap_is_left_out_beside_the_corrected_record_of_its_station(tmp_path):
    (tmp_path / "film.smc").write_text(film_text(times=np.r_[0:0.2:42j, 9.0]), encoding="latin-1")  # with a gap
    other = smc_text().replace("      1675", "      1676")
    for text, left in ((other, 0), (smc_text(), 1)):
        (tmp_path / "x.smc").write_text(text, encoding="latin-1")
        found = read_motions(tmp_path)
        assert (len(found.motions), len(found.left_out), len(found.unusable)) == (1, left, 1 - left)


def test_film_is_a_copy_of_the_corrected_record_of_its_station(tmp_path):
    (tmp_path / "film.smc").write_text(film_text(times=0.005 * np.arange(len(A))), encoding="latin-1")
    (tmp_path / "x.smc").write_text(smc_text(), encoding="latin-1")
    found = read_motions(tmp_path)
    assert ([motion.name for motion in found.motions], len(found.left_out)) == (["x"], 1)
