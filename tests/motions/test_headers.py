"""What a person reads in the header of each format, beside its samples: the program has to come to the same."""

from datetime import UTC, datetime
from pathlib import Path

import pytest
from agency_files import geonet_text
from layouts import LAYOUTS

from rockbatch.motions.formats import read_record
from rockbatch.motions.formats.geonet import is_geonet
from rockbatch.motions.formats.unam import _texts_of
from rockbatch.motions.sources.record_file import RecordFile

GEONET = "20161113_110256_WTMC_20"
CGS = "RCRD OF FRI JUL 5, 2019 20:19:37.0 PDT"
COSMOS = "RECORD OF SEÑOR QUAKE OF FRI NOV 30, 2018 17:29 UTC"
SMC = "San José, 1295 Shafter, 42n 1675, 1989-291 0:4"
USC = "MADE UP EARTHQUAKE JAN 17, 1994 -1230 GMT"
HOUSE = "700 N, Faring Rd., Los Angeles, Ca"
CHILE, CHINA = "VIÑA DEL MAR CENTRO S/N 675", "0130420080246 2013-04-20 8:2:46 BTM"
READ = [
    # format, layout; direction, unit, dt, start; corrected, with the instrument's zero; station, event; their names
    ("PEER AT2", "`NPTS= …, DT= … SEC`", "228", "G", 0.01, "", True, False,
     "MADE-UP, 1/17/1994, TEST STATION", "MADE-UP 1/17/1994", "Made-up 1994", "Test Station"),
    ("PEER AT2", "two lines, `(g)`", "000", "g", 0.02, "", None, False, "", "", "", ""),
    ("K-NET/KiK-net", "K-NET", "EW", "", 0.01, "2018-01-24T10:51:23", False, True, "TST003", "", "2018-01-24", "TST003"),
    ("K-NET/KiK-net", "KiK-net, at the surface", "EW", "", 0.01, "2018-01-24T10:51:23", False, True,
     "TST003.2", "", "2018-01-24", "TST003"),
    ("GeoNet", "V1A", "N28W", "mm/s/s", 0.005, "2016-11-13T11:02:19.715", False, True,
     f"WTMC {GEONET}, uncorrected", GEONET, "Waiau 2016", "Te Mara Farm Waiau"),
    ("GeoNet", "V2A", "N28W", "mm/s/s", 0.005, "2016-11-13T11:02:19.715", True, False,
     f"WTMC {GEONET}, corrected", GEONET, "Waiau 2016", "Te Mara Farm Waiau"),
    ("DYNA", "1.2", "HNE", "cm/s^2", 0.005, "2009-04-06T01:32:40.870", True, False,
     "IT.AQK..HN, X-1, manual", "X-1", "Made Up", "L'Aquila: Aquil Park"),
    ("COSMOS", "V1c, 8F10.5", "90", "cm/s2", 0.005, "2018-11-30T17:29:06.332", False, True,
     "NP-8040, D0, Building; ground level, uncorrected", COSMOS, "Señor Quake of Fri Nov 30, 2018", "Anchorage;R B Atwood Bld"),
    ("COSMOS", "V2c, 1E15.6", "90", "cm/s2", 0.005, "2018-11-30T17:29:06.332", True, False,
     "NP-8040, D0, Building; ground level, corrected", COSMOS, "Señor Quake of Fri Nov 30, 2018", "Anchorage;R B Atwood Bld"),
    ("CSMIP", "Volume 1, as CGS writes it", "90", "g", 0.01, "2019-07-06T03:19:37.5", False, True,
     "CCC, 38457511.CI.CCC.--.HN, Volume 1", CGS, "2019-07-05", "Peñón Blanco"),
    ("CSMIP", "Volume 1, as CDMG did", "90", "G", 0.01, "", False, True,
     "CCC, 38457511.CI.CCC.--.HN, Volume 1", CGS, "2019-07-05", "Peñón Blanco"),
    ("CSMIP", "Volume 2", "90", "cm/sec2", 0.01, "2019-07-06T03:19:37.5", True, False,
     "CCC, 38457511.CI.CCC.--.HN, Volume 2", CGS, "2019-07-05", "Peñón Blanco"),
    ("USGS SMC", "corrected, 8E10.4", "135", "cm/s2", 0.005, "1989-10-18T00:04:15.25", True, False,
     f"{SMC}, corrected", "1989-291 0:4", "Loma Prieta 1989", "San José, 1295 Shafter, 42n"),
    ("USGS SMC", "from film, pairs of time and value", "135", "cm/s2", 0.00142, "1989-10-18T00:04:15.25", False, True,
     f"{SMC}, uncorrected", "1989-291 0:4", "Loma Prieta 1989", "San José, 1295 Shafter, 42n"),
    ("RENADIC", "pairs of time and value", "L", "G/10", 0.005, "2010-02-27T06:34:11.5", False, True,
     f"{CHILE}, MAULE 2010 02/27/2010 6:34:00, Volume 1", "MAULE 2010 02/27/2010 6:34:00",
     "Maule 2010", "Viña Del Mar Centro S/N 675"),
    ("USC", "Volume I", "N90E", "G/10", 0.005, "", False, True, f"0016, {USC}, Volume 1", USC, "Made Up 1994", HOUSE),
    ("USC", "Volume II", "N90E", "CM/SEC/SEC", 0.02, "", True, False, f"0016, {USC}, Volume 2", USC, "Made Up 1994", HOUSE),
    ("Caltech", "Volume II", "S00E", "CM/SEC/SEC", 0.02, "", True, False, f"117, {USC}, Volume 2", USC, "Made Up 1994", HOUSE),
    ("RESORCE", "`.cor.acc`, 5E14.7", "N", "m/s/s", 0.005, "", True, False,
     "3202, 1980-05-23 12:26:24", "1980-05-23 12:26:24", "1980-05-23", "Made Up-Post Office"),
    ("BHRC", "Volume 1", "L", "G/10", 0.005, "", False, True,
     "5522/01, Ajab Shir, Origin Time : 2012/08/11   12:23:16", "5522/01", "2012/08/11", "Ajab Shir"),
    ("CSMNC", "uncorrected", "EW", "CM/SEC/SEC", 0.005, "", False, True,
     f"51BXD, {CHINA}, uncorrected", CHINA, "Made Up 2013", "51BXD"),
    ("CSMNC", "corrected", "EW", "CM/SEC/SEC", 0.005, "", True, False,
     f"51BXD, {CHINA}, corrected", CHINA, "Made Up 2013", "51BXD"),
    ("AFAD text", "gal", "NS", "gal", 0.005, "2017-07-20T22:30:58.5", False, True,
     "0921, 20/07/2017 22:30:58.500000 (GMT)", "2017/07/20 22:31:09 (GMT)", "2017/07/20", "Aydin Germencik İ"),
    ("UNAM, RA-UAM, CICESE", "3F10.4", "N00E", "Gal", 0.005, "2017-09-19T18:14:44.5", False, True,
     "CANA, 2017/09/19 18:14:40 1505844884.5", "2017/09/19 18:14:40", "2017/09/19", "Las Canas"),
    ("CWA", "free field", "U", "gal", 0.005, "1999-09-20T17:47:02", False, False,
     "TCU068, 1999/09/20-17:47:02.000", "1999/09/20-17:47:02.000", "1999/09/20", "TCU068"),
    ("EMOD3D (ucgmsim)", "`.000`, `.090`, `.ver`", "090", "mm/s2", 0.005, "", None, False, "HALS", "", "", "HALS"),
    ("text columns", "SCEC Broadband Platform", "NS", "cm/s/s", 0.005, "", None, False, "x", "", "", ""),
]  # fmt: skip
SENSORS = {
    # station, network, location, place, channel of the second component, or the only one
    "PEER AT2": ("TEST STATION", None, None, None, None),
    "K-NET/KiK-net": ("TST003", None, "", None, None),
    "GeoNet": ("WTMC", "NZ", "20", None, None),
    "DYNA": ("AQK", "IT", "", None, None),
    "COSMOS": ("8040", "NP", "D0", "BUILDING; GROUND LEVEL", "35"),
    "CSMIP": ("CCC", "CI", "", None, "2"),
    "USGS SMC": ("1675", None, None, "SAN JOSÉ, 1295 SHAFTER, 42N", None),
    "USC": ("0016", "LA", None, None, None),
    "Caltech": ("117", None, None, None, None),
    "RESORCE": ("3202", None, None, None, None),
    "BHRC": ("AJAB SHIR", None, None, None, None),
    "CSMNC": ("51BXD", "CN", None, "GROUND", None),
    "AFAD text": ("0921", "TK", None, None, None),
    "UNAM, RA-UAM, CICESE": ("CANA", None, None, None, None),
    "CWA": ("TCU068", "TW", None, None, None),
    "EMOD3D (ucgmsim)": ("HALS", None, None, None, None),
}


def read(form, what):
    """Return the components of a layout."""
    (layout,) = (layout for layout in LAYOUTS if (layout.format, layout.what) == (form, what))
    return read_record(RecordFile(Path(layout.file), layout.file, layout.data, layout.stated))


@pytest.mark.parametrize(
    ("form", "what", "label", "unit", "dt", "start", "corrected", "zero", "station", "event", "named", "at"), READ
)
def test_a_header_says_what_a_person_reads_in_it(
    form, what, label, unit, dt, start, corrected, zero, station, event, named, at
):
    first = read(form, what)[0]
    found = first.orientation.label, first.unit, first.dt, first.processed, first.raw, first.station, first.event
    assert found == (label, unit, dt, corrected, zero, station, event)
    assert (first.origin.event, first.origin.station) == (named, at)
    time = None if first.start is None else datetime.fromtimestamp(first.start, UTC).replace(tzinfo=None)
    assert time == (datetime.fromisoformat(start) if start else None)


@pytest.mark.parametrize("form", SENSORS)
def test_a_header_says_which_sensor_has_recorded(form):
    found = read(form, next(row[1] for row in READ if row[0] == form))
    sensor = found[min(1, len(found) - 1)].sensor
    assert (sensor.station, sensor.network, sensor.location, sensor.place, sensor.channel) == SENSORS[form]


def test_a_geonet_file_begins_with_its_title_whatever_stands_below():
    head = geonet_text(1).encode()
    assert is_geonet(head)
    first, rest = head.split(b"\n", 1)
    assert not is_geonet(b"of another agency".ljust(len(first)) + b"\n" + rest)


def test_a_key_of_unam_that_has_no_value_for_each_channel_says_nothing():
    assert _texts_of("/a/ b /c/", 3) == ["a", "b", "c"]
    assert _texts_of("/a/b/", 3) == _texts_of("/a/b/c/d/", 3) == ["", "", ""]
