"""Words for directions in the languages of agencies and programs, in their own script and transliterated.

Without accents, in any case. Pairs of words (Norte-Sur, 南北) are made of the single ones, in both orders; ``ns`` and ``ew`` are
abbreviations of such pairs; "above" and "below" are directions only in a pair (haut-bas). A single letter that means different
directions in two languages (O: oeste, Ost) is in none.
"""

import unicodedata
from itertools import product

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
        "north": "NORTE",
        "south": "SUR",
        "east": "ESTE",
        "west": "OESTE",
        "ew": "EO OE",
        "above": "ARRIBA",
        "below": "ABAJO",
        "horizontal": "TRANSVERSAL",
        "filling": "COMPONENTE DIRECCION SENTIDO CANAL EJE ACELERACION ACELERACIONES",
    },
    "Portuguese": {
        "north": "NORTE",
        "south": "SUL",
        "east": "ESTE LESTE",
        "west": "OESTE",
        "ew": "LO OL",
        "above": "CIMA",
        "below": "BAIXO",
        "filling": "DIRECAO CANAL EIXO ACELERACAO ACELERACOES",
    },
    "French": {
        "north": "NORD",
        "south": "SUD",
        "east": "EST",
        "west": "OUEST",
        "ew": "EO OE",
        "vertical": "VERTICALE",
        "above": "HAUT",
        "below": "BAS",
        "horizontal": "HORIZONTALE LONGITUDINALE TRANSVERSALE RADIALE",
        "filling": "COMPOSANTE VOIE AXE SENS",
    },
    "Italian": {
        "north": "NORD",
        "south": "SUD",
        "east": "EST",
        "west": "OVEST",
        "ew": "EO OE",
        "vertical": "VERTICALE",
        "above": "ALTO SU",
        "below": "BASSO GIU",
        "horizontal": "ORIZZONTALE LONGITUDINALE TRASVERSALE RADIALE",
        "filling": "COMPONENTE DIREZIONE CANALE ASSE ACCELERAZIONE ACCELERAZIONI",
    },
    "German": {
        "north": "NORD NORDEN",
        "south": "SUD SUED SUDEN SUEDEN",
        "east": "OST OSTEN",
        "west": "WEST WESTEN",
        "ew": "OW WO",
        "vertical": "VERTIKAL VERTIKALE SENKRECHT LOTRECHT",
        "up": "AUFWARTS AUFWAERTS",
        "down": "ABWARTS ABWAERTS",
        "above": "AUF OBEN",
        "below": "AB UNTEN",
        "horizontal": "WAAGRECHT WAAGERECHT LANGS LAENGS QUER",
        "filling": "KOMPONENTE RICHTUNG KANAL ACHSE BESCHLEUNIGUNG BESCHLEUNIGUNGEN",
    },
    "Turkish": {
        "north": "KUZEY",
        "south": "GUNEY",
        "east": "DOGU",
        "west": "BATI",
        "ns": "KG GK",
        "ew": "DB BD",
        "vertical": "DUSEY DIKEY",
        "above": "YUKARI",
        "below": "ASAGI",
        "horizontal": "YATAY BOYUNA ENINE",
        "filling": "BILESEN BILESENI YON YONU KANAL EKSEN IVME IVMESI",
    },
    "Greek": {
        "north": "ΒΟΡΡΑΣ ΒΟΡΑΣ ΒΟΡΕΙΑ VORRAS VORAS",
        "south": "ΝΟΤΟΣ ΝΟΤΙΑ NOTOS",
        "east": "ΑΝΑΤΟΛΗ ΑΝΑΤΟΛΙΚΗ ANATOLI",
        "west": "ΔΥΣΗ ΔΥΤΙΚΗ DYSI",
        "ns": "ΒΝ",
        "ew": "ΑΔ",
        "vertical": "ΚΑΤΑΚΟΡΥΦΗ ΚΑΤΑΚΟΡΥΦΟΣ ΚΑΤΑΚΟΡΥΦΟ ΚΑΘΕΤΗ ΚΑΘΕΤΟΣ KATAKORYFI KATAKORYFOS KATHETI",
        "above": "ΠΑΝΩ ΑΝΩ",
        "below": "ΚΑΤΩ",
        "horizontal": "ΟΡΙΖΟΝΤΙΑ ORIZONTIA ΔΙΑΜΗΚΗΣ ΕΓΚΑΡΣΙΑ",
        "filling": "ΣΥΝΙΣΤΩΣΑ ΔΙΕΥΘΥΝΣΗ ΕΠΙΤΑΧΥΝΣΗ",
    },
    "Russian": {
        "north": "СЕВЕР СЕВЕРНАЯ SEVER",
        "south": "ЮГ ЮЖНАЯ YUG",
        "east": "ВОСТОК ВОСТОЧНАЯ VOSTOK",
        "west": "ЗАПАД ЗАПАДНАЯ ZAPAD",
        "ns": "СЮ ЮС",
        "ew": "ВЗ ЗВ",
        "vertical": "ВЕРТИКАЛЬ ВЕРТИКАЛЬНАЯ ВЕРТИКАЛЬНЫЙ VERTIKAL VERTIKALNAYA VERTIKALNAIA",
        "up": "ВВЕРХ ВЕРХ",
        "down": "ВНИЗ НИЗ",
        "horizontal": "ГОРИЗОНТАЛЬНАЯ GORIZONTALNAYA ПРОДОЛЬНАЯ ПОПЕРЕЧНАЯ",
        "filling": "КОМПОНЕНТА КАНАЛ НАПРАВЛЕНИЕ УСКОРЕНИЕ",
    },
    "Japanese": {
        "north": "北 KITA",
        "south": "南 MINAMI",
        "east": "東 HIGASHI",
        "west": "西 NISHI",
        "ns": "NANBOKU NAMBOKU",
        "ew": "TOZAI TOUZAI",
        "vertical": "鉛直 JOGE JOUGE ENCHOKU",
        "above": "上",
        "below": "下",
        "horizontal": "水平",
        "filling": "成分 方向 動 加速度",
    },
    "Chinese": {
        "north": "北",
        "south": "南",
        "east": "东 東",
        "west": "西",
        "ns": "NANBEI BEINAN",
        "ew": "DONGXI XIDONG",
        "vertical": "垂直 垂 竖 竖直 豎 豎直 铅直 鉛直 铅垂 鉛垂 CHUIZHI SHUXIANG SHUZHI",
        "above": "上",
        "below": "下",
        "horizontal": "水平 SHUIPING",
        "filling": "分量 方向 向 加速度",
    },
    "Persian": {
        "north": "شمال شمالی شمالي SHOMAL SHOMALI",
        "south": "جنوب جنوبی جنوبي JONUB JONUBI JONOUB",
        "east": "شرق شرقی شرقي SHARGH SHARGHI SHARQ",
        "west": "غرب غربی غربي GHARB GHARBI",
        "vertical": "قائم عمودی عمودي GHAEM AMUDI AMOODI",
        "above": "بالا",
        "below": "پایین",
        "horizontal": "افقی افقي طولی عرضی OFOGHI",
        "filling": "مولفه مؤلفه جهت شتاب",
    },
    "Arabic": {
        "north": "شمال",
        "south": "جنوب JANUB",
        "east": "شرق",
        "west": "غرب",
        "vertical": "راسي رأسي رأسية RASI",
        "horizontal": "أفقي افقي",
        "filling": "مركبة اتجاه",
    },
    "Dutch": {
        "north": "NOORD",
        "south": "ZUID",
        "east": "OOST",
        "west": "WEST",
        "ew": "OW WO",
        "vertical": "VERTICAAL VERTIKAAL",
        "horizontal": "HORIZONTAAL",
        "filling": "RICHTING KANAAL VERSNELLING",
    },
    "Romanian": {
        "north": "NORD",
        "south": "SUD",
        "east": "EST",
        "west": "VEST",
        "horizontal": "ORIZONTAL ORIZONTALA",
        "vertical": "VERTICALA",
        "filling": "COMPONENTA DIRECTIE ACCELERATIE",
    },
    "Indonesian": {
        "north": "UTARA",
        "south": "SELATAN",
        "east": "TIMUR",
        "west": "BARAT",
        "vertical": "VERTIKAL TEGAK",
        "horizontal": "MENDATAR",
        "filling": "KOMPONEN ARAH PERCEPATAN",
    },
    "Korean": {
        "north": "북",
        "south": "남",
        "east": "동",
        "west": "서",
        "vertical": "수직 연직",
        "above": "상",
        "below": "하",
        "horizontal": "수평",
        "filling": "성분 방향 가속도",
    },
}
"""By language and meaning. "filling": words beside a direction, such as component and acceleration."""


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
