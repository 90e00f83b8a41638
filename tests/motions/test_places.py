"""Where a sensor stands: texts as agencies write them, in several languages, on structures, in boreholes and on the ground."""

import pytest
from fixed_column_files import cosmos_text, csmip_channel
from motion_files import wiggle, write_at2

from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.quality.places import Stand, stand


def only_reason(found) -> str:
    (unusable,) = found.unusable
    return unusable.reason


# fmt: off
ON_STRUCTURES = (
    "Base of Center Column", "South Embankment", "Column at Grnd Level", "Abutment 1", "Abut. 3: West", "Abut1",
    "Roof", "Bldg; roof, NE corner", "3rd floor", "3rd Floor Center", "12th Flr: SE", "2nd-floor", "Floor 4",
    "Penthouse", "Deck Level near Abut 1", "Bridge deck: midspan", "Dam crest", "Bent 3 column top", "Top of Pier 2",
    "21st Floor", "Second floor", "Bent 3 footing", "Base of column", "Embankment", "Pile Cap", "Pile cap, pier 4",
    "Footing, Bent 3", "Top of Footing", "Isolator", "Above isolators", "Below Isolators, NW", "Level 5", "Lvl 3",
    "5th level", "Level 12 center", "Crest - center", "Right Crest", "Left Abutment", "Lower gallery", "Spillway",
    "Pier 3 base", "Tower", "West Tower Base", "Anchorage", "Midspan", "Hinge 2", "Bent 4", "Bent #3 cap beam",
    "Caisson", "Girder: 1/4 span", "Approach embankment", "Embkmt near Abut 2", "Wharf Deck", "Pile 3",
    "Column base, ground level", "Ground level at column B2", "Base of tower", "Pier 3 at ground level",
    "Foundation of Pier 6", "Pylon", "Upstream face", "Dam body", "Control tower roof", "Techo", "Azotea", "Piso 5",
    "5o piso", "3er piso", "Nivel 4", "Coronación", "Estribo norte", "Pila 3", "Columna C4", "Zapata",
    "Terraplén sur", "Aislador 2", "Tablero", "Torre", "Telhado", "3º andar", "Encontro", "Sapata", "Pilar 2",
    "Aterro", "Toiture", "3e étage", "3ème étage", "Culée nord", "Tablier", "Semelle pile 3", "Crête", "Remblai",
    "Tetto", "3° piano", "Piano 3", "Spalla", "Impalcato", "Pilastro", "Coronamento", "Rilevato", "Dach", "3. OG",
    "3. Stock", "Dachgeschoss", "Widerlager Nord", "Pfeiler 2", "Dammkrone", "Überbau", "Stütze B2", "Çatı", "3. kat",
    "Kat 5", "Kret", "Kenar ayak", "Kolon", "Tabliye", "Dolgu", "3. Kat kolon", "Taratsa", "3os orofos", "Akrovathro",
    "Stepsi", "okujo", "屋上", "3F", "RF", "5階", "橋脚", "Qiaodun", "bading", "坝顶", "免震層", "12 m above ground",
    "Top Floor", "Upper Deck", "Bent cap", "Pile-cap", "Footing (Pier 3)", "Col. B4 base", "Abtmt 2", "Ftng, Bent 5",
    "Ground level of pier", "Ground floor of tower", "Grnd Lvl, column 3",
    "Edificio, tercer piso", "Quinto nivel", "Piso tercero", "Corona de la cortina", "Losa 2", "Laje", "Secondo piano",
    "Terzo livello", "Dernier étage", "Troisième étage", "Zweites Stockwerk", "Brückenüberbau Feldmitte",
    "Staumauer", "Üçüncü kat", "En üst kat", "Köprü tabliyesi", "Minare", "Γέφυρα, βάθρο", "τρίτος όροφος", "三階", "第三层",
    "五楼", "третий этаж", "derde verdieping", "etaj 3", "Acoperiș bloc", "Lantai 5", "Atap gedung", "طبقه سوم", "تاج سد",
    "střecha", "krov zgrade", "tető", "גג", "Roof terrace", "Soffit of span 2",
    "Roof center", "Crest Center", "Deck centre",
)
ON_GROUND = (
    "Freefield", "Free field, 100 m from the deck", "Ground floor", "1st Floor", "Basement", "Ground - N of pier 2",
    "", "DH array surface", "Borehole array; surface", "Dam toe", "Level 0", "Level 1", "Free-field near Abut 1",
    "Ground", "Ground surface", "Abutment 1 Free Field", "Lobby", "Sub-basement", "2nd basement", "B2 level",
    "Planta baja", "Piso 1", "Sótano", "Rez-de-chaussée", "Piano terra", "Erdgeschoss", "Zemin kat", "Bodrum",
    "Isogeio", "1F", "B1F", "Hut 50 m N of dam crest", "Instrument shelter near abutment", "Elev. 120 m",
    "100 m N of building", "Campo libre", "Champ libre", "Freifeld", "地表", "Foundation level", "Grade",
    "Parking lot", "30 m from building", "Depth 0 m", "Vault", "Rock outcrop", "Station", "Bldg base",
    "Toe - downstream", "FF", "Ground - 20m S of Abut 1", "Basement; center", "Slab on grade", "Campo libero",
    "Surface", "Concrete pad", "Level -1", "Grnd Lvl near Bent 3", "Free Field - N of Bent 3", "Base: center",
    "1st Floor: SE corner", "Surface, near abutment", "Embankment toe", "Terreno a 20 m de pila 3",
    "Suelo junto a pila 2", "Grade, 15 ft from column", "Alluvial terrace", "Corona", "Cortina", "Campanile",
    "Primer piso", "Primo piano", "Erster Stock", "一階", "地下二階", "1楼",
    "Penstock Bay", "Mine Bay", "Wharf Bay", "Cable Bay", "Span Point", "Tunnel point", "Tower Point Rd",
    "etaj 1", "Lantai 1", "birinci kat", "первый этаж",
)
BELOW = (
    "Downhole", "Downhole 30 m", "DH 30m", "Dwnhl", "Borehole", "Depth 30 m", "30 m depth", "30m deep", "-30 m",
    "GL-100m", "100 ft below surface", "30 m", "Depth: 20 ft", "Geotech array; 30 m", "at 15 m", "15 m below ground",
    "Profundidad 30 m", "Pozo 20 m", "Bohrloch", "Tiefe 25 m", "30 m Tiefe", "Sondaj", "Derinlik 15 m", "Forage 50 m",
    "地中", "Profondità 10 m", "Hole 2, 12.5 m", "z = -15 m", "Depth = 7.5m", "Array 30 m", "GL -7.0 m", "6 m depth",
    "35.2m", "22 m bgs",
)
STATIONS_ON_GROUND = (
    "Dam, downstream free field", "Base Line Rd", "Columbia College", "Bridge St", "Pier Ave", "Santa Monica - Pier",
    "Tower Rd", "Hillcrest", "Crest Dr", "Crest Drive", "Anchorage;R B Atwood Bld", "San Antonio Dam - Toe",
    "El Centro - Hwy 8/Meloland Overpass", "Pilar", "Torre del Greco", "Pozo Almonte", "Canoga Park - Topanga Can",
    "Foundation Dr", "Lake Hughes #1", "LA - Hollywood Stor FF", "El Centro Array #11", "Castaic - Old Ridge Route",
    "Hwy 33 Bridge", "Floor Valley", "Level Rd", "Coyote Lake Dam (downst)", "Long Valley Dam (Downst)",
    "Cliff House", "Parachute Test Site", "Deckers", "Wall St", "Fort Tower", "El Pilar", "Crestline", "Crest View",
    "Dach (Pakistan)", "Beverly Hills - 12520 Mulhol", "LA - 7-story Univ Hospital (FF)", "Corona",
    "Palm Springs 2nd St", "Pileta", "Roofers Lane", "TAPS Pump Sta. #10", "Kret Creek", "Tank Rd", "Well 5",
    "Rio Dell Overpass FF", "Zafferana Etnea", "Columbine", "Sol Duc", "Lamont 362", "Embarcadero",
    "Newhall - W Pico Canyon Rd.", "CHY101", "Petrolia", "Hollister - City Hall Annex", "Alhambra - Fremont School",
    "Shin-Osaka", "Piano di Sorrento", "Kat", "Kai", "Lou Ann", "Stock Exchange", "Kolonaki", "Krone", "De Kalb",
    "Krestena", "Alta 5 m", "Palo Alto", "East Palo Alto", "Palos Verdes", "La Cresta", "Zapata", "Santa Pila",
    "Shi Zhuang", "Chimney Rock", "San Pedro - Palos Verdes", "Lagerheim", "Bridge Street Fire Sta",
    "Columbia - Airport", "Santa Cruz Pier", "Bent Creek", "Stone Tower Inn", "Wall Springs", "Piermont",
    "Top of the World", "Terrasse-Vaudreuil", "Remblai", "Damm", "Terrace", "Quinto", "Segundo Ruiz Belvis", "San Pietro 2",
    "Cortina d'Ampezzo", "Losa del Obispo", "Somewhere FS28", "Pier 3 Street", "Corona - I15 Bridge", "RF12",
    "Puente Alto, Torre", "Anchorage - Port Bridge", "Some Dam, Tower Road", "Bridge, ground near tower",
    "7-story hotel, ground floor", "12-story building, basement", "Edificio de 7 pisos, suelo",
    "SJB Overpass, Bent 3 g.l.", "X Overpass, Pier 5 ground level", "Bridge, bent 3, ground", "Overpass, Bent 5 GL",
    "Station near Pier 4", "Tower 3 substation", "Pier 3 Warehouse, Oakland", "Artesian Well 20 m N of road",
)
STATIONS_ON_STRUCTURES = (
    "Madeup Dam L Abut", "Madeup Dam - Southwest Abutment", "Dam (crest)", "Dam, Crest", "ELAZIG KEBAN (KRET-CREST)",
    "TORRE (ROOF)", "Bldg, 7th floor", "Some Bridge - Deck", "Meloland Overpass (Embankment)", "Overpass - Pile Cap",
    "Dam - Left Abutment", "Hospital - Penthouse", "Treasure Is. downhole 30 m", "Somewhere, Level 5",
    "Bay Bridge - East tower", "Staumauer Krone", "Golden Gate Bridge, south anchorage", "Universidad, pozo 100 m",
    "Bay Bridge, pier 3", "Viadotto, base pila 7", "Bridge - Bent B3", "Tower no. 2", "Presa, berma", "Dam, berms",
    "Hotel; 5th Fl", "Overpass, Footing", "Base of Column, Overpass", "Dam (right crest)",
    "LOS ANGELES - 52-STORY BLDG", "VAN NUYS - 7-STORY HOTEL", "Edificio de 7 pisos",
    "7-story hotel, ground floor of tower, 3rd floor", "Bridge, pier 3 top", "Bridge (east), tower 2 (top)",
)
# fmt: on


IN_FURTHER_LANGUAGES = {
    Stand.STRUCTURE: "крыша|3 этаж|2-й этаж|опора 3|насыпь|свая|지붕|옥상|3층|교각|سقف|dak|3e verdieping|"
    "landhoofd|3ος όροφος|Brückenpfeiler 2|Isolatorebene|Corona de la presa|Tailings dam|Pedestal|Anchor block|Tunnel|Mezz.",
    Stand.BOREHOLE: "скважина 30 м|boorgat 2|시추공",
    Stand.GROUND: "грунт|1 этаж|1층|свободное поле|maaiveld|지표면|Dakar|Mezzogiorno|Stena Line|Minerva",
}


@pytest.mark.parametrize("where", IN_FURTHER_LANGUAGES)
def test_places_are_understood_in_the_languages_of_directions(where):
    wrong = [place for place in IN_FURTHER_LANGUAGES[where].split("|") if stand(place, "Somewhere")[0] is not where]
    assert wrong == []


@pytest.mark.parametrize(
    ("places", "where"), [(ON_STRUCTURES, Stand.STRUCTURE), (ON_GROUND, Stand.GROUND), (BELOW, Stand.BOREHOLE)]
)
def test_a_place_says_where_its_sensor_stands(places, where):
    assert [place for place in places if stand(place, "Somewhere")[0] is not where] == []
    assert [place for place in places if stand(place.upper(), "")[0] is not where] == []


def test_names_of_streets_towns_and_people_are_no_structures():
    assert [name for name in STATIONS_ON_GROUND if stand("", name)[0] is not Stand.GROUND] == []
    assert [name for name in STATIONS_ON_GROUND if stand(name.upper(), name)[0] is not Stand.GROUND] == []


@pytest.mark.parametrize(
    ("name", "where"),
    [
        ("Lower Dam (Outlet)", Stand.STRUCTURE),
        ("Lower Dam (Gallery)", Stand.STRUCTURE),
        ("Bridge 7 (Pier 3)", Stand.STRUCTURE),
        ("Baraj (dolusavak)", Stand.STRUCTURE),
        ("Some Array (12 m)", Stand.BOREHOLE),
        ("Lower Dam (Toe)", Stand.GROUND),
        ("Poe Road (temp)", Stand.GROUND),
        ("Bridge 7 free field (Pier 3)", Stand.GROUND),
        ("Outlet Mall", Stand.GROUND),
        ("Tower Town (Airport)", Stand.GROUND),
        ("Station (USGS STATION 5054)", Stand.GROUND),
    ],
)
def test_what_stands_in_brackets_behind_a_station_s_name_is_a_place(name, where):
    assert stand("", name)[0] is where
    assert stand("", name)[1] in ("", name)


def test_a_name_of_a_station_may_say_that_it_is_on_a_structure_or_in_a_borehole():
    assert [name for name in STATIONS_ON_STRUCTURES if stand("", name)[0] is Stand.GROUND] == []


@pytest.mark.parametrize("place", ["Base of Pile Cap", "West Embankment", "Level 7", "Isolator 3 top", "Depth 12 m"])
def test_a_record_beside_or_below_the_ground_waits_until_it_is_confirmed(tmp_path, place):
    lines = csmip_channel("90 Deg", wiggle(60), volume=2, place=place)
    (tmp_path / "x.V2").write_text("\n".join([*lines, ""]), encoding="latin-1")
    assert f'"{place.upper()}" is in a' in only_reason(read_motions(tmp_path))
    assert len(read_motions(tmp_path, confirmed=["x"]).motions) == 1


@pytest.mark.parametrize(("depth", "used"), [(0.0, 1), (1.5, 1), (30.0, 0)])
def test_a_depth_in_station_xml_or_sac_is_that_of_a_borehole(tmp_path, depth, used):
    from obspy import Trace
    from obspy.core import AttribDict
    from waveform_files import channel_xml, station_xml, trace, write_mseed

    (tmp_path / "sac").mkdir()
    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    station_xml(tmp_path, channel_xml("HNN").replace("<Azimuth>", f"<Depth>{depth}</Depth><Azimuth>"))
    header = {"delta": 0.01, "station": "LRL", "channel": "HNE", "sac": AttribDict(stdp=depth)}
    Trace(wiggle(500).astype("float32"), header).write(str(tmp_path / "sac" / "e.sac"), format="SAC")
    found = read_motions(tmp_path, options=ReadOptions(unit="g"))
    assert len(found) == 2 * used
    assert all('"depth 30 m" is in a borehole' in one.reason for one in found.unusable)


@pytest.mark.parametrize(
    ("site", "place", "words"),
    [
        ("Atwood Bldg", "Roof, NE corner", "Roof, NE corner"),
        ("Lower Dam, Crest", "", "Lower Dam, Crest"),
        ("Array", "Borehole", "Borehole"),
        ("Tower Rd", "Kinemetrics Episensor", ""),
    ],
)
def test_a_structure_in_the_words_of_station_xml_is_told(tmp_path, site, place, words):
    from waveform_files import channel_xml, station_xml, trace, write_mseed

    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    channel = channel_xml("HNN").replace("<Azimuth>", f"<Description>{place}</Description><Azimuth>")
    station_xml(tmp_path, f"<Site><Name>{site}</Name></Site>", channel)
    found = read_motions(tmp_path)
    assert (len(found.motions), len(found.unusable)) == ((0, 1) if words else (1, 0))
    assert all(one.reason.startswith(f'"{words}" is in a ') for one in found.unusable)


@pytest.mark.parametrize(
    ("code", "place", "used"),
    [
        (10, "Chan 5", 0),
        (11, "", 0),
        (12, "NE corner", 0),
        (11, "Free Field", 1),
        (10, "Basement", 1),
        (1, "Chan 5", 1),
    ],
)
def test_the_type_of_a_cosmos_station_tells_a_structure_where_its_words_do_not(tmp_path, code, place, used):
    values = wiggle(400, scale=90.0)
    head, integers, *remainder = cosmos_text(values, location=place or " ").partition("Format= (10I8)\n")
    numbers = remainder[0]
    changed = numbers[: 8 * 10 + 1 + 8 * 8] + f"{code:8d}" + numbers[8 * 10 + 1 + 8 * 9 :]
    (tmp_path / "x.V1c").write_text(head + integers + changed, encoding="latin-1")
    found = read_motions(tmp_path)
    assert len(found.motions) == used
    assert used or "structure" in only_reason(found)


def test_a_dam_s_toe_and_crest_are_told_apart_by_the_station_of_an_at2_file(tmp_path):
    write_at2(tmp_path, "x.AT2", wiggle(60), title="Somewhere, 1/17/1994, Some Dam - Toe, 000")
    assert len(read_motions(tmp_path)) == 1
    write_at2(tmp_path, "x.AT2", wiggle(60), title="Somewhere, 1/17/1994, Some Dam - Right Crest, 000")
    assert "in a structure" in only_reason(read_motions(tmp_path))


@pytest.mark.parametrize("place", ["{} m depth", "Depth: {} m", "{} m below ground", "GL-{} m"])
def test_a_depth_over_two_metres_is_below_the_ground_in_either_unit(place):
    expected = {1.9: Stand.GROUND, 2.1: Stand.BOREHOLE}
    for unit, metres in (("m", 1.0), ("ft", 0.3048), ("feet", 0.3048)):
        found = {
            m: stand(place.format(f"{m / metres:.3f}").replace(" m", f" {unit}", 1), "Somewhere")[0] for m in expected
        }
        assert found == expected


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (["Station: Golden Bridge, top of pier 3"], "structure"),
        (["Station: HTL", "Location: Roof"], "structure"),
        (["Station: Golden Bridge", "Location: approach fill, east end"], "structure"),
        (["Station: Golden Bridge, pier 3"], "structure"),
        (["Station: LA - City Hall, 5th floor"], "structure"),
        (["Sensor location: tower"], "structure"),
        (["Location: Torre del Greco"], ""),  # a town
        (["Sensor: Roof"], "structure"),
        (["Site: Crest of dam"], "structure"),
        (["Konum: Köprü, orta ayak"], "structure"),
        (["観測点：屋上"], "structure"),
        (["Location: 34.05, -118.25, elevation 80 m"], ""),
        (["Estación: Hotel Plaza, azotea"], "structure"),
        (["Station name = WLA GL-22m"], "borehole"),
        (["Location: Dam downhole 30 m"], "borehole"),
        (["Station: Golden Bridge, free field"], ""),
        (["Station: PIER"], ""),  # a code
        (["Source: top of pier 3"], ""),
        (["Site: NEHRP class D, groundwater at 3 m"], ""),
        (["Location: Shinjuku, water table at 4 m"], ""),
        (["Station: Shaft Hill, bedrock depth 45 m"], ""),
        (["Location: Vs30 = 300 m/s at a depth of 30 m"], ""),
    ],
)
def test_the_header_of_a_table_says_where_its_sensor_stands(tmp_path, lines, said):
    rows = "\n".join(f"{a:.6f}" for a in wiggle(60))
    head = "\n".join([*lines, "Component: NS", "Units: g", "dt = 0.01 s"])
    (tmp_path / "x.txt").write_text(f"{head}\n{rows}\n", encoding="utf-8")
    found = read_motions(tmp_path)
    assert len(found.motions) == (not said)
    assert not said or said in only_reason(found)
    assert not any(motion.origin.station for motion in found)
