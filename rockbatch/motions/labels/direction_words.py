"""Words for directions in the languages of agencies and programs, in their own script and transliterated.

Without accents, in any case. Pairs of words (Norte-Sur, 南北) are made of the single ones, in both orders; ``ns`` and ``ew`` are
abbreviations of such pairs; "above" and "below" are directions only in a pair (haut-bas). A single letter that means different
directions in two languages (O: oeste, Ost) is in none.
"""

import unicodedata
from itertools import product


def _row(meanings: str, *of_meanings: str) -> dict[str, str]:
    """Return the words of each of several meanings."""
    return dict(zip(meanings.split(), of_meanings, strict=True))


WORDS: dict[str, dict[str, str]] = {
    "English": {
        "north": "N NORTH NORTHWARD NORTHERN",
        "south": "S SOUTH SOUTHWARD SOUTHERN",
        "east": "E EAST EASTWARD EASTERN",
        "west": "W WEST WESTWARD WESTERN",
        "ns": "NS SN",
        "ew": "EW WE",
        "vertical": "V VER VERT VRT VERTIC VERTICAL Z AZ U UD DU ZUP UPZ VUP VERUP VERTUP VERTICALUP",
        "up": "UP UPWARD UPWARDS YUP UPY",
        "down": "DOWN DWN DN DOWNWARD DOWNWARDS ZDWN ZDN ZDOWN VDWN VDN VDOWN VERDOWN VERTDN VERTDOWN VERTICALDOWN DOWNZ",
        "horizontal": "H H1 H2 HOR HOR1 HOR2 HORIZ HORIZ1 HORIZ2 HORIZONTAL HORIZONTAL1 HORIZONTAL2 L T LN TR LONG LONGI LONGIT "
        "LONGITUDINAL TRAN TRANS TRANSV TRANSVERSE TRANSVERSAL RAD RADIAL TANG TANGENTIAL X Y AX AY FN FP R",
    },
    "Spanish": {
        **_row("north south east west", "NORTE", "SUR", "ESTE", "OESTE"),
        "ew": "EO OE",
        **_row("above below", "ARRIBA", "ABAJO"),
        "horizontal": "TRANSVERSAL",
        "filling": "COMPONENTE DIRECCION SENTIDO CANAL EJE ACELERACION ACELERACIONES",
    },
    "Portuguese": {
        **_row("north south east west", "NORTE", "SUL", "ESTE LESTE", "OESTE"),
        "ew": "LO OL",
        **_row("above below", "CIMA", "BAIXO"),
        "filling": "DIRECAO CANAL EIXO ACELERACAO ACELERACOES",
    },
    "French": {
        **_row("north south east west", "NORD", "SUD", "EST", "OUEST"),
        "ew": "EO OE",
        "vertical": "VERTICALE",
        **_row("above below", "HAUT", "BAS"),
        "horizontal": "HORIZONTALE LONGITUDINALE TRANSVERSALE RADIALE",
        "filling": "COMPOSANTE VOIE AXE SENS",
    },
    "Italian": {
        **_row("north south east west", "NORD", "SUD", "EST", "OVEST"),
        "ew": "EO OE",
        "vertical": "VERTICALE",
        **_row("above below", "ALTO SU", "BASSO GIU"),
        "horizontal": "ORIZZONTALE LONGITUDINALE TRASVERSALE RADIALE",
        "filling": "COMPONENTE DIREZIONE CANALE ASSE ACCELERAZIONE ACCELERAZIONI",
    },
    "German": {
        **_row("north south east west", "NORD NORDEN", "SUD SUED SUDEN SUEDEN", "OST OSTEN", "WEST WESTEN"),
        "ew": "OW WO",
        "vertical": "VERTIKAL VERTIKALE SENKRECHT LOTRECHT",
        **_row("up down", "AUFWARTS AUFWAERTS", "ABWARTS ABWAERTS"),
        **_row("above below", "AUF OBEN", "AB UNTEN"),
        "horizontal": "WAAGRECHT WAAGERECHT LANGS LAENGS QUER",
        "filling": "KOMPONENTE RICHTUNG KANAL ACHSE BESCHLEUNIGUNG BESCHLEUNIGUNGEN",
    },
    "Turkish": {
        **_row("north south east west", "KUZEY", "GUNEY", "DOGU", "BATI"),
        **_row("ns ew", "KG GK", "DB BD"),
        "vertical": "DUSEY DIKEY",
        **_row("above below", "YUKARI", "ASAGI"),
        "horizontal": "YATAY BOYUNA ENINE",
        "filling": "BILESEN BILESENI YON YONU KANAL EKSEN IVME IVMESI",
    },
    "Greek": {
        **_row(
            "north south east west",
            "ΒΟΡΡΑΣ ΒΟΡΑΣ ΒΟΡΕΙΑ VORRAS VORAS",
            "ΝΟΤΟΣ ΝΟΤΙΑ NOTOS",
            "ΑΝΑΤΟΛΗ ΑΝΑΤΟΛΙΚΗ ANATOLI",
            "ΔΥΣΗ ΔΥΤΙΚΗ DYSI",
        ),
        **_row("ns ew", "ΒΝ", "ΑΔ"),
        "vertical": "ΚΑΤΑΚΟΡΥΦΗ ΚΑΤΑΚΟΡΥΦΟΣ ΚΑΤΑΚΟΡΥΦΟ ΚΑΘΕΤΗ ΚΑΘΕΤΟΣ KATAKORYFI KATAKORYFOS KATHETI",
        **_row("above below", "ΠΑΝΩ ΑΝΩ", "ΚΑΤΩ"),
        "horizontal": "ΟΡΙΖΟΝΤΙΑ ORIZONTIA ΔΙΑΜΗΚΗΣ ΕΓΚΑΡΣΙΑ",
        "filling": "ΣΥΝΙΣΤΩΣΑ ΔΙΕΥΘΥΝΣΗ ΕΠΙΤΑΧΥΝΣΗ",
    },
    "Russian": {
        **_row(
            "north south east west",
            "СЕВЕР СЕВЕРНАЯ SEVER",
            "ЮГ ЮЖНАЯ YUG",
            "ВОСТОК ВОСТОЧНАЯ VOSTOK",
            "ЗАПАД ЗАПАДНАЯ ZAPAD",
        ),
        **_row("ns ew", "СЮ ЮС", "ВЗ ЗВ"),
        "vertical": "ВЕРТИКАЛЬ ВЕРТИКАЛЬНАЯ ВЕРТИКАЛЬНЫЙ VERTIKAL VERTIKALNAYA VERTIKALNAIA",
        **_row("up down", "ВВЕРХ ВЕРХ", "ВНИЗ НИЗ"),
        "horizontal": "ГОРИЗОНТАЛЬНАЯ GORIZONTALNAYA ПРОДОЛЬНАЯ ПОПЕРЕЧНАЯ",
        "filling": "КОМПОНЕНТА КАНАЛ НАПРАВЛЕНИЕ УСКОРЕНИЕ",
    },
    "Japanese": {
        **_row("north south east west", "北 KITA", "南 MINAMI", "東 HIGASHI", "西 NISHI"),
        **_row("ns ew", "NANBOKU NAMBOKU", "TOZAI TOUZAI"),
        "vertical": "鉛直 JOGE JOUGE ENCHOKU",
        **_row("above below", "上", "下"),
        "horizontal": "水平",
        "filling": "成分 方向 動 加速度",
    },
    "Chinese": {
        **_row("north south east west", "北", "南", "东 東", "西"),
        **_row("ns ew", "NANBEI BEINAN", "DONGXI XIDONG"),
        "vertical": "垂直 垂 竖 竖直 豎 豎直 铅直 鉛直 铅垂 鉛垂 CHUIZHI SHUXIANG SHUZHI",
        **_row("above below", "上", "下"),
        "horizontal": "水平 SHUIPING",
        "filling": "分量 方向 向 加速度",
    },
    "Persian": {
        "north": "شمال شمالی شمالي SHOMAL SHOMALI",
        "south": "جنوب جنوبی جنوبي JONUB JONUBI JONOUB",
        "east": "شرق شرقی شرقي SHARGH SHARGHI SHARQ",
        "west": "غرب غربی غربي GHARB GHARBI",
        "vertical": "قائم عمودی عمودي GHAEM AMUDI AMOODI",
        **_row("above below", "بالا", "پایین"),
        "horizontal": "افقی افقي طولی عرضی OFOGHI",
        "filling": "مولفه مؤلفه جهت شتاب",
    },
    "Arabic": {
        **_row("north south east west", "شمال", "جنوب JANUB", "شرق", "غرب"),
        "vertical": "راسي رأسي رأسية RASI",
        "horizontal": "أفقي افقي",
        "filling": "مركبة اتجاه",
    },
    "Dutch": {
        **_row("north south east west", "NOORD", "ZUID", "OOST", "WEST"),
        "ew": "OW WO",
        "vertical": "VERTICAAL VERTIKAAL",
        "horizontal": "HORIZONTAAL",
        "filling": "RICHTING KANAAL VERSNELLING",
    },
    "Romanian": {
        **_row("north south east west", "NORD", "SUD", "EST", "VEST"),
        "horizontal": "ORIZONTAL ORIZONTALA",
        "vertical": "VERTICALA",
        "filling": "COMPONENTA DIRECTIE ACCELERATIE",
    },
    "Indonesian": {
        **_row("north south east west", "UTARA", "SELATAN", "TIMUR", "BARAT"),
        "vertical": "VERTIKAL TEGAK",
        "horizontal": "MENDATAR",
        "filling": "KOMPONEN ARAH PERCEPATAN",
    },
    "Korean": {
        **_row("north south east west", "북", "남", "동", "서"),
        "vertical": "수직 연직",
        **_row("above below", "상", "하"),
        "horizontal": "수평",
        "filling": "성분 방향 가속도",
    },
}
"""By language and meaning, words with blanks between them; "filling" has those beside a direction: component, acceleration."""


def folded(text: str) -> str:
    """Return a text in capitals, without accents: "Dirección" gives "DIRECCION"."""
    plain = unicodedata.normalize("NFKD", text.replace("º", "°").replace("ı", "i").upper())
    return "".join(c for c in plain if not unicodedata.combining(c))


def words(meaning: str) -> set[str]:
    """Return the words of all languages for a meaning such as "up", in capitals without accents; set() for an unknown one."""
    return {word for language in WORDS.values() for word in _words_in(language, meaning)}


def pairs(first: str, second: str) -> set[str]:
    """Return pairs of words of one language for two meanings, in both orders: NORTESUR, SURNORTE."""
    joined: set[str] = set()
    for language in WORDS.values():
        for a, b in product(_words_in(language, first), _words_in(language, second)):
            joined |= {a + b, b + a}
    return joined


def _words_in(language: dict[str, str], meaning: str) -> list[str]:
    """Return a language's words for a meaning, folded; [] without any."""
    return folded(language.get(meaning, "")).split()
