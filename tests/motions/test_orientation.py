"""Labels of components: verticals, azimuths and channel codes of many agencies."""

import pytest

from rockbatch.motions.labels.orientation import Orientation, orientation_in, orientation_of, same_azimuth, split_stem


@pytest.mark.parametrize(
    "label", ["UP", "up", "UD", "U-D", "U", "V", "-V", "Z", "VER", "Vert", "HNZ", "BNZ", "Up-down"]
)
def test_these_are_vertical_and_positive_up(label):
    found = orientation_of(label)
    assert found is not None
    assert found.vertical
    assert not found.down


@pytest.mark.parametrize("label", ["DWN", "DN", "down"])
def test_these_are_vertical_and_positive_down(label):
    found = orientation_of(label)
    assert found is not None
    assert found.vertical
    assert found.down


@pytest.mark.parametrize(
    ("label", "azimuth"),
    [
        ("360", 0),
        ("000", 0),
        ("0", 0),
        ("21", 21),
        ("360 DEG", 0),
        ("NS", 0),
        ("N-S", 0),
        ("North-south acceleration", 0),
        ("E", 90),
        ("EW", 90),
        ("S62W", 242),
        ("N62W", 298),
        ("S28E", 152),
        ("N10E", 10),
        ("HNE", 90),
        ("HLN", 0),
    ],
)
def test_these_are_horizontal_with_an_azimuth(label, azimuth):
    found = orientation_of(label)
    assert found is not None
    assert not found.vertical
    assert found.azimuth == azimuth


@pytest.mark.parametrize("label", ["L", "T", "H1", "H2", "HN1", "LN", "TR", "x"])
def test_these_are_horizontal_without_an_azimuth(label):
    found = orientation_of(label)
    assert found is not None
    assert not found.vertical
    assert found.azimuth is None


@pytest.mark.parametrize("label", ["", "acc", "361", "999", "foo", "12345"])
def test_these_say_nothing(label):
    assert orientation_of(label) is None


@pytest.mark.parametrize(
    ("stem", "station", "label"),
    [
        ("RSN1063_NORTHR_RRS228", "RSN1063_NORTHR_RRS", "228"),
        ("RSN1063_NORTHR_RRS-UP", "RSN1063_NORTHR_RRS", "UP"),
        ("RSN1633_MANJIL_ABBAR--T", "RSN1633_MANJIL_ABBAR", "T"),
        ("RSN4843_CHUETSU_65006EW", "RSN4843_CHUETSU_65006", "EW"),
        ("RSN4013_SANSIMEO_36258021", "RSN4013_SANSIMEO_36258", "021"),
        ("RSN57_SFERN_ORRDWN", "RSN57_SFERN_ORR", "DWN"),
        ("20220917134114_TSMIP_TTN021_E", "20220917134114_TSMIP_TTN021", "E"),
        ("CI.LRL..HNZ", "CI.LRL", "HNZ"),
        ("KOBE2040", "KOBE2", "040"),
        ("A-010", "A", "010"),
        ("228", "", "228"),
        ("CI.LRL..HNZ__20190706T031850Z__20190706T032250Z", "CI.LRL__20190706T031850Z__20190706T032250Z", "HNZ"),
        ("CI.LRL.10.HN1__20190706T031850Z__20190706T032180Z", "CI.LRL.10__20190706T031850Z__20190706T032180Z", "HN1"),
        ("IT.AQK..HNE.D.20090406.013239.U.ACC", "IT.AQK.D.20090406.013239.U.ACC", "HNE"),
        ("LRL_N_2019-07-06T03-18-50", "LRL_2019-07-06T03-18-50", "N"),
    ],
)
def test_the_end_of_a_stem_tells_station_and_component(stem, station, label):
    part, found = split_stem(stem)
    assert found is not None
    assert (part, found.label) == (station, label)


@pytest.mark.parametrize(
    "stem",
    [
        "record",
        "run_12",
        "site_5",
        "AOM0031801241951",
        "KOBE1900",
        "KOBE2039",
        "A-001",
        "A2019.187",
        "001",
        "SITE_1995_090",
        "LRL_20190706T031850Z",
        "LRL_20190706T031090",
    ],
)
def test_a_stem_without_component_is_left_whole(stem):
    assert split_stem(stem) == (stem, None)


def test_azimuths_agree_within_a_degree_across_north():
    assert same_azimuth(0.0, 359.5)
    assert same_azimuth(228.0, 229.0)
    assert not same_azimuth(0.0, 180.0)
    assert not same_azimuth(None, 0.0)


@pytest.mark.parametrize(
    ("words", "azimuth"),
    [
        ("N NS SN NORTH NORTHSOUTH NORTHWARD NORTE HNN EHN", 0.0),
        ("E EW WE EAST EASTWEST EASTWARD ESTE HNE EHE", 90.0),
        ("S SOUTH SOUTHWARD SUR S00E S00W 180", 180.0),
        ("W WEST WESTWARD OESTE N90W S90W 270", 270.0),
    ],
)
def test_points_of_the_compass_are_read_as_agencies_write_them(words, azimuth):
    for word in words.split():
        for label in (word, word.lower(), f"Comp. {word}"):
            assert orientation_of(label).azimuth == azimuth
            assert orientation_of(label).label == label


def test_the_name_of_a_column_tells_its_direction_or_nothing():
    azimuths = {"0": 0.0, "00": 0.0, "90": 90.0, "360": 0.0, " N ": 0.0, "CCC_HNE": 90.0}
    for label, azimuth in azimuths.items():
        assert orientation_in(label) == Orientation(label.strip(), vertical=False, azimuth=azimuth)
    for label in ("Z", "CCC_HNZ"):
        assert orientation_in(label) == Orientation(label, vertical=True, azimuth=None)
    for label in ("12", "45", "A_12"):
        assert orientation_in(label) == Orientation(label, vertical=False, azimuth=None, known=False)


@pytest.mark.parametrize(
    ("north", "east", "upright"),
    [
        ("Sur-Norte", "Componente Este - Oeste", "Aceleración vertical"),
        ("Norte-Sul", "LESTE-OESTE", "vertical"),
        ("Composante Nord-Sud", "Est-Ouest", "VERTICALE"),
        ("Nord - Sud", "est-ovest", "Componente verticale"),
        ("NORD-SÜD", "Ostkomponente", "senkrecht"),
        ("Sued-Nord", "O-W", "auf-ab"),
        ("Kuzey-Güney", "DOĞU-BATI", "Düşey bileşen"),
        ("K-G", "D-B", "yukarı-aşağı"),
        ("Βορράς-Νότος", "Ανατολή-Δύση", "Κατακόρυφη συνιστώσα"),
        ("Север-Юг", "В-З", "вертикальная"),
        ("sever-yug", "vostok-zapad", "vertikal"),
        ("南北動", "東西成分", "上下"),
        ("Nanboku", "Tōzai", "Jōge"),
        ("南北向", "东西", "竖向"),
        ("شمالی - جنوبی", "شرقی-غربی", "قائم"),
        ("shomal-jonub", "shargh-gharb", "ghaem"),
        ("Utara-Selatan", "timur-barat", "tegak"),
        ("남북", "동서", "수직"),
    ],
)
def test_directions_are_understood_in_the_languages_of_those_who_record_them(north, east, upright):
    for label, azimuth in ((north, 0.0), (east, 90.0)):
        assert (orientation_in(label).vertical, orientation_in(label).azimuth) == (False, azimuth)
    assert (orientation_in(upright).vertical, orientation_in(upright).down) == (True, False)


@pytest.mark.parametrize("label", ["O", "Este-Sur", "Nord-Ost", "Alto", "bas"])
def test_words_that_mean_two_directions_are_none(label):
    assert not orientation_in(label).known


@pytest.mark.parametrize("stem", ["Palo_Alto", "Bologna_Nord", "Roma_Est", "x_DB"])
def test_names_of_places_are_no_directions(stem):
    assert split_stem(stem) == (stem, None)
