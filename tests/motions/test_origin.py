"""What records are called: event and year, station, direction, by their headers; the name in tables stays their file's."""

import csv
import io
import json
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import pytest
from agency_files import cwa_text, dyna_text, geonet_text, knet_text, renadic_text, resorce_text
from damaged_files import traced
from fixed_column_files import cosmos_text, csmip_channel, csmip_text, read, smc_text
from motion_files import at2_text, needs_records, wiggle, write_at2
from national_files import afad_text, bhrc_text, csmnc_text, unam_text, usc_corrected_text, usc_text
from studies import FOLDER_STUDY, write_study

from rockbatch.commands.cli import main
from rockbatch.motions import Motion, MotionSet, ReadOptions, read_motions
from rockbatch.motions.component import Sensor
from rockbatch.motions.labels.orientation import Orientation, orientation_of, unknown
from rockbatch.motions.labels.origin import Origin, origin_of, with_direction

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(
    ("event", "date", "called"),
    [
        ("IMPERIAL VALLEY, CA  EARTHQUAKE", "15 OCT 1979 - 2317 UTC", "Imperial Valley 1979"),
        ("Imperial Valley-06", "10/15/1979", "Imperial Valley-06 1979"),
        ("CAPE MENDOCINO", "04/25/92 1806", "Cape Mendocino 1992"),
        ("X", "1/17/04", "X 2004"),
        ("KOBE 01/16/95 2046", "", "KOBE 1995"),
        ("X", "2046", "X"),
        ("Record of Point MacKenzie Earthquake of Fri Nov 30, 2018 17:29 UTC", "", "Point MacKenzie 2018"),
        ("Rcrd of Fri Jul  5, 2019 20:19:37.0 PDT", "", "2019-07-05"),
        ("MAULE 2010", "01/01/1980 0:00:00 (GMT)", "Maule 2010"),
        ("MAULE 2010", "", "Maule 2010"),
        ("5 km south-west of Waiau", "2016 November 13         11:02:56 UT", "Waiau 2016"),
        ("11 km east of CHRISTCHURCH", "2016 February 14", "Christchurch 2016"),
        ("12km NNE of Ridgecrest, CA", "2019", "Ridgecrest 2019"),
        ("", "2018-01-24 19:51", "2018-01-24"),
        ("", "", ""),
        ("   ,", "", ""),
        ("10/15/1979", "", "10/15/1979"),
        ("10/15/79 1817", "10/15/79 1817", "10/15/79 1817"),
    ],
)
def test_an_event_is_called_by_its_name_and_year(event, date, called):
    assert origin_of(event, date=date).event == called


def test_no_year_of_two_digits_or_four_is_after_today():
    today = datetime.now().year
    for year, understood in ((today, today), (today + 1, today - 99)):
        assert origin_of("X", date=f"1/17/{year % 100:02d}").event == f"X {understood}"
    assert origin_of("X", date=f"{today}").event == f"X {today}"
    assert origin_of("X", date=f"{today + 1}").event == "X"


@pytest.mark.parametrize(
    ("header", "called"),
    [
        ("EL CENTRO - HWY 8/MELOLAND OVERPASS", "El Centro - Hwy 8/Meloland Overpass"),
        ("LGPC", "LGPC"),
        ("NP.8040", "NP.8040"),
        ("SYLMAR", "Sylmar"),
        ("Te Mara Farm Waiau", "Te Mara Farm Waiau"),
        ("HESPERIA - 4TH & PALM", "Hesperia - 4TH & Palm"),
    ],
)
def test_a_station_is_not_shouted_and_a_code_stays_a_code(header, called):
    assert origin_of(station=header).station == called


def test_directions_are_three_digits_or_what_the_header_has():
    labels = {"270 DEG": "270", "0": "000", "N28W": "N28W", "HNE": "HNE", "21": "021"}
    for label, called in labels.items():
        orientation = orientation_of(label)
        assert orientation is not None
        assert with_direction(Origin("e"), orientation).direction == called
    assert with_direction(Origin("e"), Orientation("", azimuth=5.0)).direction == "005"
    assert with_direction(Origin("e"), unknown()).direction == ""


QUAKE, FARING = "MADE UP EARTHQUAKE JAN 17, 1994 -1230 GMT", "700 N, Faring Rd., Los Angeles, Ca"
RIDGECREST, SHAFTER = "RCRD OF FRI JUL 5, 2019 20:19:37.0 PDT", "San José, 1295 Shafter, 42n"
UNKNOWN = {"FECHA DEL SISMO [GMT]": "", "HORA EPICENTRO (GMT)": ""}
HEADERS = [
    ("a.AT2", at2_text(wiggle()), "Made-up 1994", "Test Station", Sensor("TEST STATION"), "MADE-UP 1/17/1994",
     "MADE-UP, 1/17/1994, TEST STATION"),
    ("a.AT2", at2_text(wiggle(), title="nothing, 000"), "", "", Sensor(), "", ""),
    ("a.EW", knet_text()[0], "2018-01-24", "TST003", Sensor("TST003", location=""), "", "TST003"),
    ("a.EW", knet_text("5")[0], "2018-01-24", "TST003", Sensor("TST003", location="2", place="surface"), "", "TST003.2"),
    ("a.V2A", geonet_text(2), "Waiau 2016", "Te Mara Farm Waiau", Sensor("WTMC", "NZ", "20"), "20161113_110256_WTMC_20",
     "WTMC 20161113_110256_WTMC_20, corrected"),
    ("a.V1A", geonet_text(1), "Waiau 2016", "Te Mara Farm Waiau", Sensor("WTMC", "NZ", "20"), "20161113_110256_WTMC_20",
     "WTMC 20161113_110256_WTMC_20, uncorrected"),
    ("a.ASC", dyna_text(stream="HNZ"), "Made Up", "L'Aquila: Aquil Park", Sensor("AQK", "IT", ""), "X-1",
     "IT.AQK..HN, X-1, manual"),
    ("a.V1c", cosmos_text(), "Señor Quake of Fri Nov 30, 2018", "Anchorage;R B Atwood Bld",
     Sensor("8040", "NP", "D0", "BUILDING; GROUND LEVEL", "35"), "RECORD OF SEÑOR QUAKE OF FRI NOV 30, 2018 17:29 UTC",
     "NP-8040, D0, Building; ground level, uncorrected"),
    ("a.V1c", cosmos_text(location="").replace("Code:NP-8040", ""), "Señor Quake of Fri Nov 30, 2018", "",
     Sensor("", "", "D0", None, "35"), "RECORD OF SEÑOR QUAKE OF FRI NOV 30, 2018 17:29 UTC", ""),
    ("a.V2", csmip_text(2), "2019-07-05", "Peñón Blanco", Sensor("CCC", "CI", "", None, "1"), RIDGECREST,
     "CCC, 38457511.CI.CCC.--.HN, Volume 2"),
    ("a.V2", "\n".join(csmip_channel("Up", wiggle(), volume=2, number=3)).replace("(Sta Chn: 3)", ""), "2019-07-05",
     "Peñón Blanco", Sensor("CCC", "CI", "", None, "3"), RIDGECREST, "CCC, 38457511.CI.CCC.--.HN, Volume 2"),
    ("a.smc", smc_text(), "Loma Prieta 1989", SHAFTER, Sensor("1675", place=SHAFTER.upper()), "1989-291 0:4",
     f"{SHAFTER} 1675, 1989-291 0:4, corrected"),
    ("b.V1", renadic_text(), "Maule 2010", "Viña Del Mar Centro S/N 675", Sensor("VIÑA DEL MAR CENTRO S/N 675", channel="1"),
     "MAULE 2010 02/27/2010 6:34:00", "VIÑA DEL MAR CENTRO S/N 675, MAULE 2010 02/27/2010 6:34:00, Volume 1"),
    ("a.s0a", usc_text(), "Made Up 1994", FARING, Sensor("0016", "LA"), QUAKE, f"0016, {QUAKE}, Volume 1"),
    ("a.s0a", usc_corrected_text(), "Made Up 1994", FARING, Sensor("0016", "LA"), QUAKE, f"0016, {QUAKE}, Volume 2"),
    ("c.V1", bhrc_text(), "2012/08/11", "Ajab Shir", Sensor("AJAB SHIR"), "5522/01",
     "5522/01, Ajab Shir, Origin Time : 2012/08/11   12:23:16"),
    ("a.dat", csmnc_text(), "Made Up 2013", "51BXD", Sensor("51BXD", "CN", place="GROUND"),
     "0130420080246 2013-04-20 8:2:46 BTM", "51BXD, 0130420080246 2013-04-20 8:2:46 BTM, uncorrected"),
    ("a.txt", afad_text(), "2017/07/20", "Aydin Germencik İ", Sensor("0921", "TK"), "2017/07/20 22:31:09 (GMT)",
     "0921, 20/07/2017 22:30:58.500000 (GMT)"),
    ("a.191", unam_text(), "2017/09/19", "Las Canas", Sensor("CANA"), "2017/09/19 18:14:40",
     "CANA, 2017/09/19 18:14:40 1505844884.5"),
    ("a.191", unam_text(**UNKNOWN), "", "Las Canas", Sensor("CANA"), "", "CANA"),
    ("b.dat", cwa_text(), "1999/09/20", "TCU068", Sensor("TCU068", "TW"), "1999/09/20-17:47:02.000",
     "TCU068, 1999/09/20-17:47:02.000"),
    ("a.cor.acc", resorce_text(), "1980-05-23", "Made Up-Post Office", Sensor("3202"), "1980-05-23 12:26:24",
     "3202, 1980-05-23 12:26:24"),
]  # fmt: skip
"""Files, and the event, station and sensor that their headers state; what tells recordings of a sensor, and stations, apart."""


@pytest.mark.parametrize(
    ("name", "text", "event", "place", "sensor", "told", "station"), HEADERS, ids=[row[0] for row in HEADERS]
)
def test_every_agency_s_header_names_event_station_and_sensor(name, text, event, place, sensor, told, station):
    components = read(text, name)
    assert {component.origin for component in components} == {Origin(event, place)}
    assert {(component.event, component.station) for component in components} == {(told, station)}
    assert components[0].sensor == sensor
    assert len({component.sensor for component in components}) in (1, len(components))


def test_an_event_without_a_year_has_that_of_its_origin_time():
    """The line before it has the place, the next one the station."""
    text = cosmos_text().replace(" of Fri Nov 30, 2018 17:29 UTC", "").replace("Señor", "Alum Rock")
    assert {component.origin.event for component in read(text, "x.V1c")} == {"Alum Rock Quake 2018"}
    (component,) = read(dyna_text(EVENT_DATE_YYYYMMDD="20090406", EVENT_ID=""), "x.ASC")
    assert (component.origin.event, component.event) == ("Made Up 2009", "MADE UP")


@pytest.mark.parametrize("form", ["SAC", "MSEED"])
def test_what_has_no_event_is_called_by_its_day(tmp_path, form):
    import obspy

    stream = obspy.read(io.BytesIO(traced(form)), format=form)
    stream[0].stats.starttime = obspy.UTCDateTime(2019, 7, 6, 3, 19)
    stream.write(str(tmp_path / f"x.{form.lower()}"), format=form)
    (motion,) = read_motions(tmp_path, options=ReadOptions(unit="m/s2"), confirmed=["*"]).motions
    assert motion.label == "2019-07-06, CI.LRL, HNE"


def test_a_record_whose_header_tells_nothing_is_called_by_its_file(tmp_path):
    """Neither CHAN24 alone, as its name in tables is, nor anything that nobody said."""
    (tmp_path / "meloland").mkdir()
    rows = "".join(f"{a:.5f}\n" for a in wiggle())
    (tmp_path / "meloland" / "CHAN24_270.csv").write_text(f"# dt = 0.01 s\n# acceleration in g\n{rows}")
    (motion,) = read_motions(tmp_path).motions
    assert (motion.name, motion.label) == ("CHAN24_270", "meloland/CHAN24_270.csv")


def test_a_manifest_s_station_stands_in_the_name_and_a_turned_pair_has_its_azimuth(tmp_path):
    write_at2(tmp_path, "a000.AT2", wiggle(), title="EVENT, 1/17/1994, STATION, 000")
    write_at2(tmp_path, "a090.AT2", wiggle(seed=2), title="EVENT, 1/17/1994, STATION, 090")
    (tmp_path / "motions.toml").write_text(
        "".join(f'[[record]]\nfile = "a{azimuth}.AT2"\nstation = "Rinaldi"\n' for azimuth in ("000", "090"))
    )
    assert [motion.label for motion in read_motions(tmp_path).motions] == [
        "EVENT 1994, Rinaldi, 000",
        "EVENT 1994, Rinaldi, 090",
    ]
    (turned,) = read_motions(tmp_path, azimuths=(30.0,)).motions
    assert turned.label == "EVENT 1994, Rinaldi, 030"


def test_the_records_that_come_with_it_are_called_by_event_station_and_direction():
    found = read_motions(ROOT / "motions" / "near_fault", confirmed=["*"])
    labels = {motion.name: motion.label for motion in found.motions}
    assert labels["CHAN24"] == "Imperial Valley 1979, Meloland Overpass, 270"
    assert labels["20161113_110259_WTMC_20.S62W"] == "Waiau 2016, Te Mara Farm, S62W"


@pytest.mark.parametrize(
    ("event", "station", "called"),
    [
        ("A very long name of an event somewhere else 1994", "A station of many words, indeed",
         "A very long name of an event… 1994, A station of many…, 000"),
        ("Waiau 2016", "Te Mara Farm Waiau", "Waiau 2016, Te Mara Farm, 000"),
        ("X 1994", "Hanmer Springs Emergency Centre", "X 1994, Hanmer Springs, 000"),
        ("X 1994", "El Centro - Hwy 8/Meloland Overpass", "X 1994, Meloland Overpass, 000"),
        ("X 1994", "San Antonio Dam - Toe", "X 1994, San Antonio Dam, 000"),
        ("X 1994", "Fire Station", "X 1994, Fire Station, 000"),
        ("", "Meloland", "Meloland, 000"),
        ("X 1994", "", "X 1994, 000"),
        ("X 1994", "A very long name of it - Harbor", "X 1994, Harbor, 000"),
        ("X 1994", "A very long name of it - Docks", "X 1994, A very long name of…, 000"),
    ],
)  # fmt: skip
def test_a_label_keeps_year_place_and_direction_of_long_names(event, station, called):
    origin = Origin(event, station, "000")
    assert origin.label == called
    assert origin.full_label == ", ".join(filter(None, (event, station, "000")))
    assert Origin().label == Origin().full_label == ""


@pytest.mark.parametrize("over", [-1, 0, 1, 40])
def test_events_of_34_letters_and_stations_of_20_are_whole_and_longer_ones_are_cut(over):
    for most, short in ((34, lambda text: Origin(text).short_event), (20, lambda text: Origin("", text).short_station)):
        name = ("abcdefghij" * 9)[: most + over]
        assert short(name) == (name if over <= 0 else f"{name[: most - 1]}…")
    dated = ("abcdefghij" * 9)[: 34 + over - 5] + " 1994"
    shortened = Origin(dated).short_event
    assert shortened == dated if over <= 0 else (len(shortened), shortened[-6:]) == (34, "… 1994")


def test_motions_that_would_share_a_label_have_longer_ones():
    def motion(name, station):
        made = Motion.from_array(wiggle(), 0.01, "m/s2", name=name)
        return replace(made, origin=Origin("Christchurch 2011", station, "N"))

    names = {"a": "Christchurch Central Hospital", "b": "Christchurch Central Library", "c": "Papanui", "d": "Papanui"}
    assert MotionSet([motion(*of_one) for of_one in names.items()]).labels == {
        "a": "Christchurch 2011, Christchurch Central Hospital, N",
        "b": "Christchurch 2011, Christchurch Central Library, N",
        "c": "Christchurch 2011, Papanui, N (c)",
        "d": "Christchurch 2011, Papanui, N (d)",
    }


@needs_records
def test_real_records_have_names_of_words_where_their_headers_have_them():
    from motion_files import RECORDS

    named = {m.name: m.label for m in read_motions(RECORDS / "table1", confirmed=["*"]).motions}
    assert named["RSN1063_NORTHR_RRS228"] == "Northridge-01 1994, Rinaldi, 228"
    assert named["RSN825_CAPEMEND_CPM000"] == "Cape Mendocino 1992, Cape Mendocino, 000"


@pytest.mark.usefixtures("pages")
def test_tables_keep_the_name_and_report_terminal_and_run_json_say_the_words(tmp_path, capsys):
    records = tmp_path / "records"
    write_at2(records, "CHAN24.AT2", wiggle(400, scale=0.5), title="IMPERIAL VALLEY, 10/15/79, MELOLAND, 270")
    label = "Imperial Valley 1979, Meloland, 270"
    path = write_study(tmp_path, FOLDER_STUDY + '[output]\nhistories = "none"\n')
    assert main(["run", str(path), "--out", str(tmp_path / "out")]) == 0
    assert label in capsys.readouterr().out
    rows = list(csv.DictReader((tmp_path / "out" / "peaks.csv").read_text(encoding="utf-8").splitlines()))
    assert {row["record"] for row in rows} == {"CHAN24"}
    (record,) = json.loads((tmp_path / "out" / "run.json").read_text(encoding="utf-8"))["records"]
    told = [record[key] for key in ("record", "label", "event", "station_name", "direction")]
    assert told == ["CHAN24", label, "Imperial Valley 1979", "Meloland", "270"]
    report = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert f'<th scope="row"><span title="CHAN24">{label}</span></th>' in report  # every run
    assert f'<th scope="row">{label}' not in report
    assert f"{label} (CHAN24)" in report


@pytest.mark.parametrize(
    ("event", "station", "short"),
    [
        ("Kobe 1995", "Town Hall Kobe", "Town Hall"),
        ("Kobe Aftershock 1995", "Town Hall Kobe", "Town Hall"),
        ("Waiau 2016", "Town Hall Kobe", "Town Hall Kobe"),
        ("", "Town Hall Kobe", "Town Hall Kobe"),
        ("X 1999", "Lower Valley - Elementary School", "Elementary"),
    ],
)
def test_a_station_in_a_table_leaves_out_the_place_of_its_event(event, station, short):
    assert Origin(event, station).short_station == short
