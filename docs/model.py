"""Draw the model with the keys of a study on it: `python docs/model.py` writes images/model.svg, legible on light and dark pages.

The pier stands on its supports with every device at the left, a footing on its bed at the right. Keys that are no length, place
or constant of a part that can be drawn are in :data:`LEFT_OUT`, each with the reason.
"""

from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path

PICTURE = Path(__file__).parent / "images" / "model.svg"
BOX = (24, 88, 1256, 684)
"""Left, top, width and height of what is drawn [px]."""
LINE = 17
"""Distance of the lines of a text [px]."""

LEFT, RIGHT, FOOT, TOP, DECK, CENTRE = 400, 560, 560, 180, 150, 330
"""Edges of the pier, its foot and top, and the heights of deck and centre of mass [px]."""
BED = (980, 1160, 600)
"""Edges and underside of the footing [px]."""

NUMBERS = "a number without a unit, which follows from the lengths, masses and stiffnesses that are drawn"
CHOICE = "chooses a law or a formula, which has no place in the picture"
ESTIMATE = "does not affect any run: the statics sheet or a remark uses it"
OF_PARTS = "of a pier that is given part by part: its shape is drawn, not its parts"

PART = (
    "mass_t",
    "height_m",
    "length_m",
    "width_m",
    "apart_m",
    "inertia_t_m2",
    "flexural_rigidity_kNm2",
    "shear_rigidity_kN",
)

LEFT_OUT = {
    "pier": {
        "p": NUMBERS,
        "mu": NUMBERS,
        "columns": "a frame of equal columns under one deck, which is another model",
        "confirm": CHOICE,
    },
    "pier.part": dict.fromkeys(PART, OF_PARTS) | {"confirm": CHOICE},
    "case": dict.fromkeys(("beta", "eta"), NUMBERS)
    | dict.fromkeys(
        (
            "name",
            "base",
            "impact",
            "kinematics",
            "spring",
            "n",
            "flight",
            "flexural_damping_kind",
            "flexural_impact",
            "formula",
        ),
        CHOICE,
    )
    | dict.fromkeys(("flight_limit_mm", "friction", "contact_stiffness_kN_m"), ESTIMATE)
    | {
        "mass_t": "the mass that [pier] has, for a pier of alpha and p",
        "other_width_m": "width at right angles to the picture",
        "backbone_mm_kN": "points of a curve in place of stiffness_kN_m and yield_kN",
        "radiation": CHOICE,
        "confirm": CHOICE,
    },
    "case.damper": {"f": NUMBERS, "nu": NUMBERS, "brace": NUMBERS, "confirm": CHOICE},
    "case.tendon": {"psi": NUMBERS, "lambda": NUMBERS, "confirm": CHOICE},
    "case.stop": {"lambda": NUMBERS, "confirm": CHOICE},
    "case.deck_spring": {"lambda": NUMBERS, "confirm": CHOICE},
}
"""Keys of [pier] and [[case]] that are not on the picture, by table, with the reason."""

STYLE = """
svg{--paper:#ffffff;--ink:#1c2126;--muted:#5f6a74;--band:#e8edf1;--blue:#0b62a8;--orange:#b4470c;--green:#00755a}
@media (prefers-color-scheme:dark){
svg{--paper:#14181b;--ink:#e4e8eb;--muted:#9aa5ae;--band:#2a3238;--blue:#6cb4f0;--orange:#f29a62;--green:#4fc9a4}
}
.paper{fill:var(--paper)}.band{fill:var(--band)}path{fill:none;stroke-linejoin:round}
.i{stroke:var(--ink);stroke-width:1.6}.l{stroke:var(--muted)}.d{stroke-dasharray:6 4}
.b{stroke:var(--blue);stroke-width:2}.o{stroke:var(--orange);stroke-width:2}.g{stroke:var(--green);stroke-width:2}
text{fill:var(--ink);paint-order:stroke;stroke:var(--paper);stroke-width:2px}
.k{font:13px ui-monospace,Cascadia Mono,Menlo,Consolas,monospace}.h{fill:var(--muted);font-size:13px}
.e{text-anchor:end}.m{text-anchor:middle}.in{stroke:var(--band)}
"""


def path(class_: str, *points: tuple[float, float]) -> str:
    """Return a line through points."""
    return f'<path class="{class_}" d="M{" L".join(f"{x:g} {y:g}" for x, y in points)}"/>'


def keys(table: str, names: Sequence[str], x: float, y: float, class_: str = "", turned: bool = False) -> str:
    """Return the names of keys below each other, each with the table that it belongs to for those who check."""
    lines = []
    for place, name in enumerate(names):
        at = f'x="{x:g}" y="{y + LINE * place:g}"' + (f' transform="rotate(-90 {x:g} {y:g})"' if turned else "")
        lines.append(f'<text class="k {class_}" data-table="{table}" {at}>{escape(name)}</text>')
    return "".join(lines)


def group(table: str, head: str, names: Sequence[str], x: float, y: float) -> str:
    """Return a head and below it the names of the keys of a table."""
    return f'<text class="h" x="{x:g}" y="{y:g}">{escape(head)}</text>' + keys(table, names, x, y + LINE + 2)


def upright(table: str, name: str, x: float, top: float, foot: float = FOOT) -> str:
    """Return a dimension line for a height, with the key along it."""
    ends = path("l", (x - 4, top), (x + 4, top)) + path("l", (x - 4, foot), (x + 4, foot))
    return path("l", (x, top), (x, foot)) + ends + keys(table, [name], x - 6, (top + foot) / 2, "m", turned=True)


def level(table: str, name: str, left: float, right: float, y: float) -> str:
    """Return a dimension line for a width, with the key below it."""
    ends = path("l", (left, y - 4), (left, y + 4)) + path("l", (right, y - 4), (right, y + 4))
    return path("l", (left, y), (right, y)) + ends + keys(table, [name], (left + right) / 2, y + 18, "m")


def spring(x: float, top: float, foot: float, class_: str = "i", wide: float = 8) -> str:
    """Return an upright spring."""
    step = (foot - top) / 8
    turns = [(x + (wide if i % 2 else -wide), top + i * step) for i in range(1, 8)]
    return path(class_, (x, top), *turns, (x, foot))


def ground(left: float, right: float, y: float) -> str:
    """Return the surface of the ground."""
    hatches = "".join(path("l", (x, y), (x - 7, y + 9)) for x in range(int(left) + 10, int(right), 16))
    return path("i", (left, y), (right, y)) + hatches


def pier() -> Iterator[str]:
    """Yield the pier with its deck, lengths and masses."""
    yield f'<rect class="band" x="{LEFT}" y="{TOP}" width="{RIGHT - LEFT}" height="{FOOT - TOP}"/>'
    yield path("i", (LEFT, FOOT), (LEFT, TOP), (RIGHT, TOP), (RIGHT, FOOT), (LEFT, FOOT))
    outline = f"M{RIGHT} {FOOT}V{TOP}H{LEFT}V{FOOT}z"
    yield f'<path class="l d" d="{outline}" transform="rotate(7 {RIGHT} {FOOT})"/>'
    yield keys("pier", ["initial_rotation_rad"], 612, 238)
    yield f'<rect class="band" x="330" y="{DECK - 12}" width="300" height="24"/>'
    yield path("i", (330, DECK - 12), (630, DECK - 12), (630, DECK + 12), (330, DECK + 12), (330, DECK - 12))
    yield path("i", (440, DECK + 12), (440, TOP)) + path("i", (520, DECK + 12), (520, TOP))
    yield keys("pier", ["deck_mass_t", "deck_inertia_t_m2"], 480, 108, "m")
    yield path("i d", (RIGHT, FOOT), (480, CENTRE))
    yield f'<circle cx="480" cy="{CENTRE}" r="4.5" style="fill:var(--ink)"/>'
    yield keys("pier", ["mass_t"], 492, CENTRE + 2, "in")
    yield path("o", (480, CENTRE + 8), (480, CENTRE + 52), (476, CENTRE + 44), (480, CENTRE + 52), (484, CENTRE + 44))
    yield keys("pier", ["gravity"], 473, CENTRE + 40, "e in")
    yield keys("pier", ["size_m"], 516, 468, "e in")
    yield f'<path class="l" d="M{RIGHT} 450A110 110 0 0 0 524 456"/>'
    yield keys("pier", ["alpha"], 566, 446)
    yield (
        upright("pier", "height_m", 350, TOP)
        + upright("pier", "top_m", 318, 168)
        + upright("pier", "deck_height_m", 286, DECK)
    )
    yield level("pier", "width_m", LEFT, RIGHT, 648)
    yield f'<path class="b d" d="M480 {FOOT}C480 420 462 260 440 {TOP}"/>'
    yield group("case", "a shaft that bends", ["shaft", "flexural_modes", "flexural_damping"], 40, 214)
    yield keys("pier", ["flexural_period_s"], 40, 232 + 3 * LINE)
    yield path("l", (180, 250), (454, 250))
    for y in (300, 500):
        yield path("l d", (LEFT - 8, y), (RIGHT + 12, y))
    yield '<text class="h" x="576" y="296">forces are read at</text>'
    yield keys("output", ["sections_m"], 576, 314)


def devices() -> Iterator[str]:
    """Yield the supports and the devices, each with its keys."""
    yield ground(300, 660, 620)
    yield spring(LEFT, FOOT, 620) + spring(RIGHT, FOOT, 620)
    names = ["stiffness_kN_m", "yield_kN", "zeta", "epsilon", "area_m2"]
    yield group("case", "[[case]], of each support", names, 700, 438) + path("l", (694, 500), (572, 588))
    yield group("case", 'on base = "rigid"', ["restitution"], 700, 546)
    yield path("g", (LEFT, FOOT), (370, FOOT), (370, 582)) + path(
        "g", (361, 582), (379, 582), (379, 600), (361, 600), (361, 582)
    )
    yield path("g", (370, 600), (370, 620))
    names = ["kind", "force_kN", "coefficient_kN_s_m", "exponent", "yield_mm", "brace_kN_m", "at"]
    yield group("case.damper", "[[case.damper]]", names, 40, 580) + path("l", (190, 592), (356, 592))
    yield path("b", (414, TOP), (414, 620))
    names = ["prestress_kN", "stiffness_kN_m", "yield_kN", "at"]
    yield group("case.tendon", "[[case.tendon]]", names, 230, 660) + path("l", (336, 652), (411, 612))
    yield path("o", (592, 620), (592, 546), (RIGHT + 2, 546))
    yield group("case.stop", "[[case.stop]]", ["gap_mm", "stiffness_kN_m", "restitution", "at"], 700, 616)
    yield path("l", (694, 630), (598, 590))
    yield path("o", (662, DECK), *((668 + 6 * i, DECK + (7 if i % 2 else -7)) for i in range(7)), (716, DECK))
    yield path("i", (716, DECK - 24), (716, DECK + 24)) + path("i", (662, DECK - 8), (662, DECK + 8))
    yield path("l", (630, DECK + 24), (662, DECK + 24)) + keys("case.deck_spring", ["gap_mm"], 640, DECK + 44)
    yield group("case.deck_spring", "[[case.deck_spring]]", ["side", "stiffness_kN_m", "restitution"], 740, DECK - 22)
    yield upright("case.deck_spring", "height_m", 884, DECK)


def footing() -> Iterator[str]:
    """Yield the footing on its bed, which takes the place of the supports."""
    left, right, foot = BED
    surface = foot - 60
    yield f'<text class="h" x="{left - 20}" y="330">base = "footing"</text>'
    yield f'<rect class="band" x="1040" y="380" width="60" height="{foot - 420}"/>'
    yield f'<rect class="band" x="{left}" y="{foot - 40}" width="{right - left}" height="40"/>'
    yield path("i", (1040, 380), (1040, foot - 40), (left, foot - 40), (left, foot), (right, foot), (right, foot - 40))
    yield path("i", (right, foot - 40), (1100, foot - 40), (1100, 380))
    yield ground(958, 1034, surface) + ground(1106, 1230, surface)
    yield "".join(spring(left + 5 + 170 * i / 8, foot, foot + 34, wide=5) for i in range(9))
    yield path("i", (left - 10, foot + 34), (right + 10, foot + 34))
    yield upright("case", "embedment_m", 950, surface, foot)
    yield level("case", "width_m", left, right, foot + 52)
    yield path("l", (right, foot - 40), (right + 34, foot - 64), (right + 34, foot - 24), (right, foot))
    yield keys("case", ["length_m"], right + 40, foot - 36)
    names = ["strips", "stiffness_MN_m3", "bearing_MPa", "safety_factor"]
    yield group("case", "the bed", names, 914, 690)
    yield group("case", "or of the soil", ["shear_modulus_MPa", "poisson", "density_t_m3"], 1050, 690)
    yield group("case", "or a layer", ["young_GPa", "depth_m"], 1196, 690)


def drawn() -> str:
    """Return the picture."""
    left, top, width, height = BOX
    lines_first = sorted((*pier(), *devices(), *footing()), key=lambda part: part.startswith("<text"))
    parts = "\n".join(lines_first)
    about = (
        "A pier of width_m and height_m with a deck stands on two supports, with a damper, a tendon, a stop and a spring "
        "beside the deck; a footing on a bed of springs may take the place of the supports. Each stands beside its keys."
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{left} {top} {width} {height}" '
        'font-family="system-ui,Segoe UI,Roboto,Arial,sans-serif">'
        f"<title>The model with the keys of a study</title><desc>{about}</desc><style>{STYLE}</style>"
        f'<rect class="paper" x="{left}" y="{top}" width="{width}" height="{height}"/>\n{parts}\n</svg>\n'
    )


if __name__ == "__main__":
    PICTURE.write_text(drawn(), encoding="utf-8")
