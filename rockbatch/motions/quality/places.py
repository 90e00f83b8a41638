"""Location of a sensor on the ground, on a structure or in a borehole, by the words for its place or its station's name.

Words of all languages are in one table (``_PLACES``); accents and capitals do not matter. A word for a structure counts anywhere
in the text, in "Base of column" as in "Top of pier", unless the text states that the sensor is in the free field, or on the
ground beside the structure: "Ground, N of pier 2". Stations are also named after streets and towns: words that occur in such
names count in places only.
"""

import re
import unicodedata
from enum import Enum, auto
from functools import lru_cache


class Stand(Enum):
    """Location of a sensor."""

    GROUND = auto()  # also if unknown
    STRUCTURE = auto()
    BOREHOLE = auto()


_PLACES = {  # word* is the beginning of one; commas part words, blanks in them may be hyphens or nothing
    "free field": {
        "en": "free field, free fld, ff, far field, ground surface, array surface, surface array, toe, rock outcrop",
        "es pt": "campo libre, campo livre, superficie del terreno, afloramiento, pie de presa, pe da barragem",
        "fr it": "champ libre, champ lointain, campo libero, affleurement, pied du barrage, piede diga",
        "de": "freifeld*, freies feld, gelaendeoberflaeche, gelandeoberflache, dammfuss",
        "tr el": "serbest saha, serbest alan, acik saha, elefthero pedio, ελευθερο πεδιο",
        "ja zh": "jiyu jiban, chihyo, 地表, 自由地盤, ziyou chang, 自由场, 自由場",
        "ru nl ko fa": "свободное поле, vrije veld, maaiveld, 자유장, 지표면, میدان آزاد",
    },
    "ground": {
        "en": "ground, grnd, grd, soil, grade, lawn, yard, parking, field, hut, shed, shelter, vault, pad, kiosk, hillside, "
        "surface, g l",
        "es pt": "terreno, suelo, solo, jardin, jardim, caseta, patio",
        "fr it": "sol, terrain, jardin, suolo, terreno, giardino, cabina",
        "de": "boden, gelande, garten, huette, hutte",
        "tr el": "zemin, bahce, arazi, edafos, εδαφος",
        "ja zh": "jiban, jimen, 地盤, 地面, dimian",
        "ru nl ko fa": "грунт*, земля, grond, bodem, 지반, زمین",
    },
    "structure": {
        "en": "roof, rooftop, penthouse, mezzanine, attic, balcony, parapet*, ceiling, catwalk, deck, girder, beam, truss*, "
        "abut*, abtmt, crest, column, bent cap, cap beam, pile, pilecap, piling, footing, ftg, ftng, caisson, embank*, embkmt, "
        "levee, berm, isolator, isolation, isoltr, isol, midspan, mid span, wingwall, wing wall, shear wall, core wall, "
        "spillway, dam top, top of dam, dam body, upstream face, downstream face, pylon, superstructure, superstr, pier cap, "
        "pier top, top of pier, pier base, base of pier, tower top, top of tower, tower base, base of tower, hinge, pedestal, "
        "anchor block, tailings dam, mezz, outlet, outlet works, intake, penstock, gatehouse, gate house, soffit, "
        "structure type, approach fill, approach slab, road fill",
        "es pt": "techo, azotea, tejado, estribo, coronacion, corona de la presa, corona de la cortina, "
        "cortina de la presa, cortina de presa, coronamiento, encepado, terraplen*, berma, "
        "aislador*, cuerpo de la presa, aliviadero, vertedero, vertedouro, telhado, "
        "tabuleiro, coroamento, bloco de estacas, isolador*, corpo da barragem",
        "fr it": "toiture, culee, couronnement, semelle, isolateur, appareil d appui, corps du barrage, sottotetto, impalcato, "
        "coronamento, pila del ponte, isolatore, isolatori, corpo diga, evacuateur*, sfioratore, "
        "tablier du pont",
        "de": "dachgeschoss, ueberbau, uberbau, brueckenueberbau, bruckenuberbau, "
        "fahrbahnplatte, widerlager, dammkrone, mauerkrone, staumauer krone, fundamentplatte, pfahlkopf*, "
        "brueckenpfeiler*, bruckenpfeiler*, isolatorebene, grundablass, hochwasserentlastung",
        "tr el": "dolusavak, dipsavak, "
        "catisi, cati kati, tabliye, tabliyesi, kenar ayak, kenar ayagi, orta ayak, kret, kreti, izolator*, taratsa, katastroma, "
        "akrovathro, mesovathro, epichoma, στεγη, ταρατσα, καταστρωμα, ακροβαθρο, στεψη, υποστυλωμα*, μεσοβαθρο, επιχωμα, "
        "μονωτηρ*",
        "ja zh": "okujo, okujou, kyodai, kyokyaku, menshin, 屋上, 床版, 橋台, 天端, 橋脚, フーチング, 盛土, 免震, "
        "屋顶, 屋頂, 楼顶, 桥面, 橋面, 桥台, 坝顶, 壩頂, 坝体, 桥墩, 橋墩, 承台, 路堤, 隔震",
        "ru": "крыша, крыши, крыше, кровля, чердак, насыпь, насыпи, свая, сваи, сваях, ростверк*, пролетн*, гребень плотины",
        "nl": "landhoofd*, brugdek, paalkop*, dijkkruin",
        "ko fa": "옥상, 지붕, 교각, 교대, 상판, 말뚝, 성토, 면진, 주탑, سقف, پشت بام, پایه پل, خاکریز, تاج سد",
        "ro id cs sl hr he": "acoperis*, atap, strecha, strese, streha, krov, krovu, גג",
    },
    "structure, in places only": {  # also names of towns, streets and people
        "en": "pier, bent, tower, span, wall, bearing, anchorage, approach*, gallery, wharf, quay, dock, crane, tank, silo, "
        "stack, shaft, mast, dike, dyke, ramp, cable, saddle, chimney, joint, col, rf, tunnel, mine",
        "es": "ultimo piso, tablero, viga, cresta, cima, columna, zapata, cabezal, pilote, pila, pilon, galeria, torre, pilar*, "
        "apoyo, muro, losa, campanario",
        "pt": "laje, encontro, crista, coluna, sapata, estaca, aterro",
        "fr": "dalle, toit, terrasse, tablier, poutre, crete, poteau*, pieu*, remblai, tour, pilier, mur",
        "it": "soletta, "
        "tetto, copertura, trave, travi, spalla, spalle, ciglio, pilastro, pilastri, pilone, plinto, plinti, palo, pali, "
        "rilevato, cunicolo",
        "de": "dach, traeger, trager, krone, stuetze*, stutze*, saeule*, saule*, pfeiler*, pfahl*, boeschung, damm, isolatoren, "
        "lager, turm, glockenturm, mauer, staumauer, bruecke, brucke",
        "tr": "cati, teras, kiris*, kolon, kolonu, sutun*, somel, kazik*, dolgu, dolgusu, govde, govdesi, kule, ayak, minare",
        "el": "stegi, doma, dokos, stepsi, kolona, stylos, vathro, pedilo*, passalo*, monotir*, efedrano, pyrgos, gefyra, δωμα, "
        "πεδιλο, βαθρο",
        "ja zh": "shouban, shoban, keta, tenba, tentan, hashira, futingu, kui, morido, wuding, loding, qiaomian, liang, qiaotai, "
        "badi, bading, zhuzi, qiaodun, chengtai, zhuang, ludi, gezhen*, 桁, 柱, 杭, 桩, 梁",
        "ru": "опора, опоры, опоре, колонна, колонны, колонне, балка, балки, балке, башня, башни, стена, стены, гребень",
        "nl ko fa hu": "dak, pijler*, kolom, kolommen, ligger*, toren, kruin, 기둥, ستون, برج, teto",
    },
    "whole structure": {  # behind its name, the words above place a sensor
        "en": "bridge, overpass, overcrossing, viaduct, dam, levee",
        "es pt fr it": "presa, viaducto, barragem, viaduto, barrage, viaduc, diga, viadotto",  # towns begin with Puente and Pont
        "de tr": "bruecke, brucke, talbruecke, talbrucke, talsperre, staumauer, koprusu, baraj, baraji, viyadugu",
    },
    "borehole": {
        "en": "borehole*, bore hole, downhole*, down hole, dwnhl, dwnh, dhole, dh, bh, drillhole, drill hole, underground",
        "es pt": "sondeo*, perforacion*, sondagem, furo de sondagem, subterraneo",
        "fr it": "forage*, puits, perforazione, sondaggio, in foro",
        "de": "bohrloch*, bohrung*",
        "tr el": "sondaj*, kuyu ici, geotrisi*, γεωτρηση",
        "ja zh": "chichu, konai, 地中, 孔内, jingxia, zuankong, 井下, 钻孔, 鑽孔",
        "ru nl ko fa": "скважин*, boorgat*, 시추공, گمانه",
    },
    "borehole, in places only": {"": "hole, pozo, pozzo, furo, foro, kuyu, well, tiefe"},
    "depth": {
        "en": "depth, deep, below ground, below surface, below grade, below gl, bgs, below",
        "es pt fr it": "profundidad*, prof, profundidade, profondeur, profondita, de profondeur",
        "de": "tiefe, tief, unter gelande, unter gok",
        "tr el": "derinlik*, derin, vathos, βαθος",
        "ja zh": "fukasa, 深さ, 深度, shendu",
    },
    "surface": {"": "surface*, superficie*, oberflache*, yuzey*, epifaneia, επιφανεια, 地表, chihyo, dibiao"},
    "base": {
        "": "basement, base, foundation, lobby, lower level, parking level, sotano, keller, bodrum, sous sol, seminterrato"
    },
    "near": {
        "en": "near, nr, adjacent, adj, beside, next to, away, from, outside, opposite, behind, beyond, downstream, upstream",
        "es pt fr it": "cerca, junto, lejos, perto, pres, a cote, vicino, presso",
        "de tr": "neben, bei, nahe, yakin, yani*",
    },
    "floor": {
        "en": "fl, flr, floor, story, storey, level, lvl, lev",
        "es pt": "piso, planta, nivel, andar, pavimento",
        "fr it": "etage, niveau, piano, livello",
        "de": "stock, stockwerk, og, obergeschoss, etage, ebene, geschoss",
        "tr el": "kat, orofos, οροφος",
        "ja zh": "kai, f, lou, ceng, 階, 层, 層, 楼, 樓",
        "ru nl ko fa": "этаж*, verdieping*, 층, طبقه",
        "ro id cs hu": "etaj, etajul, lantai, patro, podlazi, emelet",
    },
}
_STREETS = (  # behind a word, which is a name then
    "street st road rd drive dr avenue ave boulevard blvd lane ln way court ct place pl highway hwy parkway pkwy plaza circle "
    "park view heights school college hospital library church mall center centre station creek lake valley hill hills canyon "
    "ranch island beach bay point city village town estates"
)
_POSITIONS = {"center", "centre"}  # of these, words that place a sensor: "Roof center"
_ORDINALS = (
    "second third fourth fifth sixth seventh eighth ninth tenth eleventh twelfth top upper "
    "segundo segunda tercer tercero tercera cuarto cuarta quinto quinta sexto septimo octavo noveno decimo ultimo ultima "
    "terceiro terceira quarto deuxieme troisieme quatrieme cinquieme sixieme septieme huitieme neuvieme dixieme dernier "
    "secondo terzo sesto settimo ottavo nono zweites zweiter drittes dritter viertes vierter funftes funfter oberstes oberster "
    "ikinci ucuncu dorduncu besinci altinci yedinci sekizinci dokuzuncu onuncu ust δευτεροσ τριτοσ τεταρτοσ πεμπτοσ "
    "второи третии четвертыи пятыи шестои последнии tweede derde vierde vijfde bovenste دوم سوم چهارم پنجم"
)
_NUMBERED = re.compile(r"[ .#-]+(?:no[. ]*)?[a-z]?-?\d+\b")
_ENDS = re.compile(r" *(?:$|[;,.()-])")
_STOREYS = re.compile(r"\d+[ -]*(?:stor(?:e?y|ies)|floors|pisos|plantas|andares|piani|etages)\b")  # a building's
_IN_CHINESE = r"(?<!下)(?<!地)[二三四五六七八九十]+"  # floors; below the ground they begin with 地下
_CARDINAL = re.compile(r"\b(?:north|south|east|west|n|s|e|w|nw|ne|sw|se|northwest|northeast|southwest|southeast)\b")
_IN_BRACKETS = re.compile(r"\(([^()]+)\)")
_LEAST_DEPTH = 2.0  # m: vaults of sensors at the surface are less deep
_FOOT = 0.3048  # m
_WIDE = r"぀-ヿ一-鿿가-힣؀-ۿ"  # scripts without blanks between words, or whose words have endings and articles joined to them
_LETTERS = "a-zα-ωа-я"

_LENGTH = r"(?P<number>\d+(?:[.,]\d+)?) ?(?P<unit>m|mt|mts|meters?|metres?|metros|metri|ft|feet|foot)\b\.?"
_DEPTH_BEHIND = re.compile(rf"[ ,#-]*{_LENGTH}")
_DIRECTED = re.compile(
    r" *(?:from|away|of|to|off|n|s|e|w|ne|nw|se|sw|north|south|east|west|above|high|tall|wide|long|span|elev|asl|de|du|del|von"
    r"|vom|dal)(?![a-z])"
)
_LEVEL = re.compile(r"(?:(?:^|[ (=,;]|gl ?|g\.l\. ?|z ?= ?)[-−–]|\b(?:gl|at|@)[ -]*)$")
_HIGH = re.compile(r"\b(?:elev|el|elevation|alt|altitude|height|h|within|about|~|span|cota|quota)[. =:]*$")


@lru_cache(maxsize=1024)
def stand(place: str, name: str) -> tuple[Stand, str]:
    """Return the location of a sensor and the text that states it, ``place`` or the station's ``name``; "" for the ground.

    What stands in brackets behind a name, "Lower Dam (Gallery)", is a place, unless the name itself says ground.
    """
    texts = [(place, _folded(place) == _folded(name)), (name, True)]
    if not any(_pattern(kind).search(_folded(name)) for kind in ("free field", "ground")):
        texts += [(text, False) for text in _IN_BRACKETS.findall(name)]
    for text, is_name in texts:
        where = _stand(text, is_name)
        if where is not Stand.GROUND:
            return where, name if text in name else text
    return Stand.GROUND, ""


def tells_place(text: str) -> bool:
    """Return whether the words for a place tell a floor, the ground, a structure or a borehole; False for "Chan 5" and ""."""
    folded = _folded(text)
    kinds = ("free field", "ground", "structure", "borehole", "depth", "surface", "floor", "base")
    return _stand(text, False) is not Stand.GROUND or _pattern(*kinds).search(folded) is not None


def depth_as_place(depth: float | None) -> str | None:
    """Return "depth 30 m" for a sensor at this depth below the surface [m]; None for 2 m or less, or an unknown depth."""
    return f"depth {depth:g} m" if depth is not None and depth > _LEAST_DEPTH else None


@lru_cache(maxsize=1024)
def _stand(text: str, is_name: bool) -> Stand:
    """Return the location that a text states, the name of a station or the words for a place; the ground for any other text."""
    folded = _folded(text)
    if not folded:
        return Stand.GROUND
    if _is_below(folded, is_name):
        return Stand.BOREHOLE
    return Stand.STRUCTURE if _is_on_structure(folded, is_name) else Stand.GROUND


@lru_cache(maxsize=1024)
def _folded(text: str) -> str:
    """Return a text in lower case without accents, with single blanks for runs of blanks, "_", ":", "/" and quotation marks."""
    text = text.casefold().replace("ı", "i").replace("ß", "ss").replace("ø", "o")
    plain = "".join(c for c in unicodedata.normalize("NFKD", text) if not unicodedata.combining(c))
    plain = unicodedata.normalize("NFC", plain)
    return " ".join(re.sub(r"[_:/'’\"]+", " ", plain).split())


@lru_cache(maxsize=64)
def _pattern(*kinds: str) -> re.Pattern[str]:
    """Return a pattern of the words of these kinds in ``_PLACES``, and their plurals from three letters on, in a folded text."""
    words = {
        word.strip().casefold() for kind in kinds for listed in _PLACES[kind].values() for word in listed.split(",")
    }
    wide = [re.escape(word) for word in words if re.search(f"[{_WIDE}]", word)]
    plain = sorted(words - {word for word in words if re.search(f"[{_WIDE}]", word)}, key=len, reverse=True)
    ends = [
        re.sub(r"\\? ", "[- .]*", re.escape(word.removesuffix("*")))
        + (f"[{_LETTERS}]*" if word.endswith("*") else "(?:s|es)?" if len(word) > 2 else "")
        for word in plain
    ]
    return re.compile(rf"(?<![{_LETTERS}])(?:{'|'.join(ends)})(?![{_LETTERS}])" + "".join(f"|{word}" for word in wide))


def _is_on_structure(text: str, is_name: bool) -> bool:
    """Return whether a folded text places a sensor on a structure, or above the ground floor; False if it says free field."""
    if _pattern("free field").search(text):
        return False
    words = _pattern("structure", "structure, in places only").finditer(text)
    first = next((word for word in words if _places_sensor(text, word, is_name)), None)
    if first is not None and not _is_beside(text[: first.start()]):
        return True
    if not is_name and re.search(rf"{_LENGTH} above\b", text):
        return True
    if _pattern("ground", "base").search(text):
        text = _STOREYS.sub("", text)
    return _upper_floor().search(text) is not None


def _places_sensor(text: str, word: re.Match[str], is_name: bool) -> bool:
    """Return whether a structure's word in a folded text places a sensor, and is no name of a street or a town.

    In a station's name words of places do, behind a structure or with a number at their end, but not on or near the ground.
    """
    number = _NUMBERED.match(text, word.end())
    if _is_street(text, (number or word).end(), is_name):
        return False
    if not is_name or _pattern("structure").fullmatch(word[0]):
        return True
    if _pattern("ground", "near").search(text):
        return False
    named = _pattern("whole structure").search(text[: word.start()])
    return named is not None or (number is not None and _ENDS.match(text, number.end()) is not None)


def _is_beside(before: str) -> bool:
    """Return whether the text before a structure's word places the sensor on the ground near it: "Ground, N of"."""
    ground = _pattern("ground").search(before)
    between = "" if ground is None else before[ground.end() :]
    return any(pattern.search(between) for pattern in (_pattern("near"), _CARDINAL, re.compile(_LENGTH)))


def _is_street(text: str, end: int, is_name: bool) -> bool:
    """Return whether the word that ends at ``end`` is the name of a street or a town, by the word behind it: "Crest Drive".

    In a place, which ``is_name`` of no station, "Crest center" is the middle of a crest.
    """
    following = re.match(r"[ .]*([a-z]+)", text[end:])
    if following is None or (not is_name and following[1] in _POSITIONS):
        return False
    return following[1] in _STREETS.split()


@lru_cache(maxsize=1)
def _upper_floor() -> re.Pattern[str]:
    """Return a pattern of floors from the second on, in digits or words, before or after the word for floor."""
    floor = _pattern("floor").pattern
    number = r"(?<![\d.b-])(?:[2-9]|[1-9]\d)(?![\d])"
    ordinal = r"(?:st|nd|rd|th|er|do|to|mo|e|eme|ieme|de|ste|o|a|°|º|ª|\.|os|οσ|inci|uncu|ncu|-?и|-?м)?"
    words = rf"\b(?:{'|'.join(_ORDINALS.split())})\b"
    before = rf"(?:{number}{ordinal}|{words}|{_IN_CHINESE})[ -]*(?:{floor})"
    return re.compile(rf"{before}|(?:{floor})[ .#]*(?:no[. ]*)?(?:{number}|{words})")


def _is_below(text: str, is_name: bool) -> bool:
    """Return whether a folded text says borehole, or a depth over 2 m; False if it says surface (but not "below surface")."""
    if _pattern("surface").search(text) and not re.search(r"below (?:the |ground )?surface", text):
        return False
    if any(not _is_street(text, match.end(), is_name) for match in _pattern("borehole").finditer(text)):
        return True
    for word in _pattern("borehole, in places only").finditer(text):
        length = _DEPTH_BEHIND.match(text, word.end())
        if length is None and (is_name or _is_street(text, word.end(), is_name)):
            continue
        if length is None or not _DIRECTED.match(text, length.end()):
            return True
    return any(depth > _LEAST_DEPTH for depth in _depths(text, is_name))


def _depths(text: str, is_name: bool) -> list[float]:
    """Return the depths [m] that a folded text states: "30 m depth", "GL-100m", and in places a bare "30 m"."""
    depth, depths = _pattern("depth").pattern, []
    for match in re.finditer(_LENGTH, text):
        before, behind = text[: match.start()], text[match.end() :]
        stated = re.search(rf"(?:{depth})[ .=(-]*(?:of )?$", before) or re.match(
            rf"[ )]*(?:de |di |en )?(?:{depth})", behind
        )
        alone = _LEVEL.search(before) or (not is_name and _stands_alone(before, behind))
        if stated or (alone and not _DIRECTED.match(behind)):
            number = float(match["number"].replace(",", "."))
            depths.append(number * (_FOOT if match["unit"].startswith("f") else 1.0))
    return depths


def _stands_alone(before: str, behind: str) -> bool:
    """Return whether a length stands alone between commas or brackets, and is no height: True for the 30 m of "Array, 30 m"."""
    if _HIGH.search(before) or not re.fullmatch(r"[ )]*(?:[;,].*)?", behind):
        return False
    return re.fullmatch(r"(?:.*[;,(-] ?|.*array ?|)", before) is not None
