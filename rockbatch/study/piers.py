"""The piers of a study file, with every combination of listed values: [pier] and [[pier.part]]."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import asdict, replace
from itertools import count, takewhile
from typing import NamedTuple

from rockbatch.common.errors import InputError, refuse
from rockbatch.pier import Part, Pier
from rockbatch.pier.sizes import BOUNDS, USUAL, unlikely_deck, unlikely_inertia
from rockbatch.study.design_bounds import DesignBound
from rockbatch.study.lists import Chosen, Grid, complain_where_due, too_many
from rockbatch.toml.kinds import KeyValues, Whole, not_negative, positive, within
from rockbatch.toml.meant import names
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import CONFIRM, Clash, Key, Section, beside, fix_the_same


def _listed(name: str, example: str, words: str) -> Key:
    """Return the key of a field of the pier that may be a list, with the field's possible and usual values."""
    return Key(within(BOUNDS[name]), example, words, many=True, usual=USUAL.get(name))


PIER = Section(
    ("pier",),
    (
        "The pier, a rigid block that can pivot about its two lower corners. Its size is given in one of three ways: "
        "`width_m` with `height_m`, `size_m`, or `p`. Every key but `gravity` may be a list: each value is a separate pier."
    ),
    {
        "alpha": _listed(
            "alpha",
            "0.13",
            "Slenderness α: the angle at a lower corner between the vertical and the line to the centre of mass, in radians. It "
            "follows from `width_m` and `height_m`, and is then left out.",
        ),
        "mu": _listed(
            "mu",
            "3.0",
            "Shape factor μ = M R0²/I0, with the moment of inertia I0 about the centre of mass. It follows from `width_m` and "
            "`height_m`, and is then left out.",
        ),
        "gravity": Key(
            within(BOUNDS["gravity"]),
            "9.81",
            "Acceleration of gravity [m/s²], for the pier and for motions that are given in g.",
            usual=USUAL["gravity"],
        ),
        "p": _listed("p", "0.38", "Frequency parameter [rad/s], p² = μ/(1+μ) · gravity/R0."),
        "size_m": _listed("size_m", "60.1", "R0, from a lower corner to the centre of mass."),
        "width_m": _listed(
            "width_m", "4.0", "Width of a solid rectangle; of a pier with parts, the distance between its pivots."
        ),
        "height_m": _listed("height_m", "30.0", "Height of a solid rectangle. Parts have heights of their own."),
        "mass_t": _listed(
            "mass_t", "3000.0", "Mass of the pier without its deck; of one column of a frame. Forces in kN need a mass."
        ),
        "deck_mass_t": _listed(
            "deck_mass_t", "1000.0", "Mass of the deck that it carries; of a frame, of the whole deck."
        ),
        "deck_height_m": _listed(
            "deck_height_m",
            "31.0",
            "Height of the deck's centre above the pivots; default: `height_m`; of a pier with parts it has to be given.",
        ),
        "deck_inertia_t_m2": Key(
            not_negative,
            "0.0",
            "Moment of inertia of the deck about its own centre. 0 for a deck on bearings, which does not rotate.",
            many=True,
        ),
        "top_m": _listed(
            "top_m",
            "31.5",
            "Height above the pivots at which drift is read; default: the highest point of the pier, its parts and its deck.",
        ),
        "flexural_period_s": _listed(
            "flexural_period_s",
            "0.6",
            "First period of the pier with its deck, fixed at its base. The statics sheet compares it with the period "
            "of rocking, to show whether the pier is rigid; runs take it as rigid unless a case has `shaft = "
            '"elastic"`.',
        ),
        "columns": Key(
            Whole(2, "a whole number, 2 or above (a single column is a pier with a deck)"),
            "4",
            "Number of equal columns of a rocking frame under one deck that rests on their tops, on a rigid base only. "
            "A bent whose columns are fixed to its cap beam is one pier: leave this out and write [[pier.part]].",
            many=True,
        ),
        "initial_rotation_rad": _listed(
            "initial_rotation_rad",
            "0.05",
            "Rotation from which the pier is released at the first sample of the motion; positive to the right, below α. A "
            "still ground, `still_s` of [motions], makes it a release test.",
        ),
        **CONFIRM,
    },
    required=True,
    homes=(Pier,),
    also=names(
        {
            "mass_t": "m shaftmass blockmass",
            "deck_mass_t": "superstructuremass superstructure topmass tributarymass headmass lumpedmass carriedmass",
            "width_m": "diameter breadth basewidth",
            "size_m": "r0 r radius halfdiagonal",
            "flexural_period_s": "period t t1 fundamentalperiod naturalperiod elasticperiod",
            "height_m": "totalheight overallheight clearheight",
            "gravity": "g",
            "alpha": "alfa",
            "p": "frequencyparameter",
            "mu": "shapefactor",
            "columns": "ncolumns numberofcolumns",
            "initial_rotation_rad": "theta0 initialtilt initialangle",
        }
    ),
    instead=names(
        {
            ("mass_t", "the weight in kN over 9.81"): "weight selfweight w",
            (
                "deck_mass_t",
                "the weight in kN over 9.81",
            ): "deckweight superstructureweight axialload axialforce deadload nkn pkn",
            "write mass_t, the density times the volume": "density rho unitweight volume",
            "the model is plane, so that the size across its axis does not enter; leave it out": "length depth",
            'write flexural_period_s; a pier is rigid unless its case says shaft = "elastic"': "e ei fck modulus youngsmodulus",
            "write flexural_period_s, 2 pi over it": "omega omegarads",
            ("mass_t", "of the pier without its deck"): "totalmass overallmass",
            ("width_m", "twice the half"): "halfwidth",
            ("width_m", "the whole width, twice the b of the theory"): "b",
            ("height_m", "twice the half"): "halfheight",
            ("height_m", "the whole height, twice the h of the theory"): "h",
            "write deck_mass_t, in t, of what rests on the pier, or a [[pier.part]] for each part of it": (
                "capmass capbeam capbeammass"
            ),
            ("size_m", "half the diagonal"): "diagonal",
            "write alpha = atan(width/height), in radians": "slenderness slendernessratio aspectratio",
            "write mu = M R0²/I0, or a [[pier.part]] with its inertia_t_m2": "inertia i0 momentofinertia",
            "units are part of the names of keys; leave it out": "unit units",
            "write deck_mass_t and deck_height_m in [pier]": "deck",
            "write flexural_period_s, 1 over it in Hz": "frequency frequencyhz fhz f1hz",
        }
    ),
    clashes=(
        Clash(
            ("part",),
            "[[pier.part]]: needs width_m, between the pivots, and no other size; write width_m = 4.0",
            lacking=("width_m",),
        ),
        Clash(
            ("height_m", "part"),
            "height_m: the parts say how high the pier is; call it top_m if drift is to be read at this height, or leave it out",
        ),
        Clash(("mass_t", "part"), "mass_t: the mass of the pier is that of its parts; leave it out"),
        Clash(
            ("deck_mass_t",),
            "mass_t is missing beside deck_mass_t, of the pier without its deck; write for example mass_t = 2000.0",
            lacking=("part", "mass_t", "columns"),
        ),
        Clash(
            ("deck_mass_t", "columns"),
            "mass_t is missing beside deck_mass_t, of one column; write for example mass_t = 2000.0",
            lacking=("part", "mass_t"),
        ),
        Clash(
            ("deck_mass_t",),
            "deck_mass_t: goes with width_m and height_m; other sizes are those of the pier with its deck, and "
            "mass_t is then the mass of both",
            lacking=("width_m", "columns"),
        ),
        Clash(
            ("deck_mass_t", "part"),
            "deck_height_m is missing beside deck_mass_t; write for example deck_height_m = 31.0",
            lacking=("deck_height_m",),
        ),
        *(
            Clash((key,), f"{key}: there is no deck; write deck_mass_t too, or leave it out", lacking=("deck_mass_t",))
            for key in ("deck_height_m", "deck_inertia_t_m2")
        ),
        Clash(
            ("columns",),
            "columns: a frame has a deck; write deck_mass_t, of the whole deck, too",
            lacking=("deck_mass_t",),
        ),
        Clash(("part", "columns"), "part: the columns of a frame are solid rectangles; leave [[pier.part]] out"),
        Clash(("mu", "columns"), "mu: the columns of a frame are solid rectangles; leave it out"),
        Clash(
            ("deck_height_m", "columns"),
            "deck_height_m: the deck of a frame rests on its columns and keeps level, so only its mass counts; leave it out",
        ),
        Clash(
            ("deck_inertia_t_m2", "columns"),
            "deck_inertia_t_m2: the deck of a frame keeps level, so only its mass counts; leave it out",
        ),
        Clash(
            ("top_m", "columns"),
            "top_m: the deck of a frame stays level and drifts as the tops of the columns; leave it out",
        ),
    ),
)
PART = Section(
    ("pier", "part"),
    ("A part of a non-uniform pier, with its centre on the axis. Write one for each part, in addition to `width_m`."),
    {
        "mass_t": Key(positive, "500.0", "Mass of the part.", required=True, many=True, usual=USUAL["mass_t"]),
        "height_m": Key(
            not_negative,
            "28.0",
            "Height of its centre above the pivots.",
            required=True,
            many=True,
            usual=USUAL["height_m"]._replace(least=0.0),
        ),
        "inertia_t_m2": Key(
            not_negative,
            "0.0",
            "Moment of inertia about its own centre; default 0, or what follows from `width_m`.",
            many=True,
        ),
        "length_m": Key(
            not_negative,
            "20.0",
            "Length along the axis over which its mass is spread evenly; default 0, a mass at one height. `sections` of "
            "[output] need it.",
            many=True,
            usual=USUAL["height_m"]._replace(least=0.0),
        ),
        "flexural_rigidity_kNm2": Key(
            positive,
            "3.0e7",
            'E I of the part over its length, for `shaft = "elastic"`; of every part with a length, in place of '
            "`flexural_period_s`. Parts beside each other add up.",
            many=True,
        ),
        "shear_rigidity_kN": Key(
            positive,
            "2.0e7",
            "G A_s of the part, its stiffness in shear; default: rigid in shear.",
            many=True,
        ),
        "width_m": Key(
            not_negative,
            "2.4",
            "Width of a rectangle, or of each of two legs; its inertia follows from it and `length_m`.",
            many=True,
            usual=USUAL["width_m"]._replace(least=0.0),
        ),
        "apart_m": Key(
            not_negative,
            "10.7",
            "Distance of the axes of two equal legs, which this part is; `mass_t` is that of both, as are forces in sections.",
            many=True,
            usual=USUAL["width_m"]._replace(least=0.0),
        ),
        **CONFIRM,
    },
    many=True,
    clashes=(
        Clash(("inertia_t_m2", "width_m"), fix_the_same("inertia_t_m2", "width_m")),
        beside("width_m", "length_m", "20.0"),
        beside("flexural_rigidity_kNm2", "length_m", "20.0", ", over which it extends"),
        beside("shear_rigidity_kN", "flexural_rigidity_kNm2", "3.0e7"),
        beside("apart_m", "width_m", "2.4", ", of each leg"),
    ),
)
PIER_KEYS = tuple(name for name in PIER if name not in ("mass_t", "confirm"))
"""Keys by which piers differ; the mass, which a [[case]] may have too, is one by which foundations differ."""

Values = dict[str, float | str]


class PierRead(NamedTuple):
    """A pier with its values by key, those that are chosen and those that follow; and likewise under bounds, by their names."""

    pier: Pier
    values: Values
    under: Mapping[str, tuple[Pier, Values]] = {}


class Piers(NamedTuple):
    """The piers of a study, the keys that are lists, and all keys that are written."""

    piers: Sequence[PierRead]
    varied: tuple[str, ...]
    keys: tuple[str, ...]


def read_piers(file: TomlFile, bounds: Sequence[DesignBound] = ()) -> Piers:
    """Return the piers of [pier], each also under those of the ``bounds`` that change keys of [pier].

    Mistakes become problems of ``file``. An impossible pier is left out, and all are if the table has another mistake. Keys of
    the n-th [[pier.part]] are called part_n_mass_t and so on.
    """
    table = file.table("pier", required="[pier] with alpha = 0.13 and p = 0.38, or with width_m and height_m")
    if table is None:
        return Piers([], (), ())
    problems_before = len(file.problems)
    grid = Grid.of(table, PIER, other=("part",))
    _check_one_size(table)
    parts = file.tables("pier", "part", title="name")
    if table.data.get("part") == []:
        message = "a pier has one part at least; write [[pier.part]] above each, or leave it out"
        table.complain(f"part = []: {message}", "part")
    for n, part in enumerate(parts, 1):
        grid += Grid.of(part, PART, _key_of_part(n, ""))
    if message := too_many(len(grid), "piers"):
        table.complain(message)
    if not file.is_sound_since(problems_before):
        return Piers([], (), tuple(grid.settings))
    piers = [
        PierRead(*nominal, _under_bounds(table, chosen, bounds))
        for chosen in grid
        if (nominal := _pier_of(table, chosen)) is not None
    ]
    return Piers(piers, grid.varied, tuple(grid.settings))


def _under_bounds(table: Table, chosen: Chosen, bounds: Sequence[DesignBound]) -> dict[str, tuple[Pier, Values]]:
    """Return the pier of one choice of values under each bound that changes keys of [pier], by the bound's name.

    A pier that cannot be made is left out; a single value that a bound makes impossible stays nominal. Problems of both are added
    to the file.
    """
    piers = {}
    for bound in bounds:
        if any(change.of_pier for change in bound.changes):
            gathered = bound.without_mistakes(table.file)
            own = bound.table(table, gathered)
            changed = _pier_of(own, bound.changed(chosen, own, of_pier=True))
            bound.note(table.file, gathered)
            if changed is not None:
                piers[bound.name] = changed
    return piers


def _pier_of(table: Table, chosen: Chosen) -> tuple[Pier, Values] | None:
    """Return the pier of one choice of values, and its values by key; None if impossible, with problems added to the table."""
    values = {name: setting.value for name, setting in chosen.items()}
    try:
        pier = _pier(values, table.confirmed)
        pier = replace(
            pier,
            flexural_period_s=values.get("flexural_period_s"),
            initial_rotation_rad=values.get("initial_rotation_rad", 0.0),
        )
    except InputError as error:
        for problem in error.problems:
            complain_where_due(table, chosen, problem)
        return None
    of_pier = asdict(replace(pier, parts=None))  # each key of a part has a column
    del of_pier["confirm"]
    return pier, {name: value for name, value in of_pier.items() if value is not None} | values


def has_mass(file: TomlFile) -> bool:
    """Return whether [pier] states the mass, itself or by parts; True if mass_t, or [pier], is probably misspelt."""
    return file.has(("pier", "mass_t")) or bool(file.value(("pier", "part"))) or ("pier",) in file.misspelt


def _pier(values: KeyValues, confirmed: Collection[str]) -> Pier:
    """Return the pier with these ``values``, which reading has found to go together.

    Raises ``InputError`` for an impossible pier, or for unusual values of keys that are not ``confirmed``.
    """
    common = {name: values[name] for name in ("gravity", "top_m") if name in values} | {"confirm": tuple(confirmed)}

    def constructed(constructor: Callable[..., Pier], *names: str) -> Pier:
        return constructor(**{name: values[name] for name in names if name in values}, **common)

    if _key_of_part(1, "mass_t") in values:
        return _pier_of_parts(values, common)
    if "deck_mass_t" in values and "columns" not in values:
        names = ("width_m", "height_m", "mass_t", "deck_mass_t", "deck_height_m", "deck_inertia_t_m2")
        return constructed(Pier.with_deck, *names)
    if "width_m" in values:
        pier = constructed(Pier.rectangle, "width_m", "height_m", "mass_t")
    elif "size_m" in values:
        pier = constructed(Pier.from_size, "alpha", "size_m", "mu", "mass_t")
    else:
        pier = constructed(Pier, "alpha", "p", "mu", "mass_t")
        if "top_m" in common:
            Pier.from_size(
                pier.alpha, pier.size, pier.mu, pier.gravity, top_m=pier.top_m, confirm=(*confirmed, "size_m")
            )
    if "columns" in values:
        return Pier.frame(pier, values["columns"], values["deck_mass_t"], confirm=confirmed)
    return pier


def with_width(values: Values, width_m: float, confirmed: Collection[str]) -> Pier:
    """Return the pier with these ``values`` and another width, as it stands across its axis.

    Heights, masses, and the inertias of parts and deck stay. A flexural period is along the axis alone, and left out.
    Raises ``InputError`` for an impossible pier, or an unusual one that is not ``confirmed``.
    """
    return _pier(values | {"width_m": width_m}, confirmed)


def _key_of_part(number: int, name: str) -> str:
    """Return the name of a key of a [[pier.part]] among the values of the pier: "part_1_mass_t"."""
    return f"part_{number}_{name}"


def _pier_of_parts(values: KeyValues, common: KeyValues) -> Pier:
    """Return a pier of parts, with the deck as its last part. Raises ``InputError`` for impossible ones and unusual decks."""
    numbers = takewhile(lambda n: _key_of_part(n, "mass_t") in values, count(1))
    written = ({name: values[key] for name in PART if (key := _key_of_part(n, name)) in values} for n in numbers)
    all_of_them = [Part.rectangle(**part) if "width_m" in part else Part(**part) for part in written]
    deck = None
    if "deck_mass_t" in values:
        wrong = unlikely_deck(sum(part.mass_t for part in all_of_them), values["deck_mass_t"], common["confirm"])
        refuse(wrong)
        deck = values["deck_height_m"]
        inertia = values.get("deck_inertia_t_m2", 0.0)
        refuse(unlikely_inertia(values["deck_mass_t"], inertia, deck, common["confirm"]))
        all_of_them.append(Part(values["deck_mass_t"], deck, inertia, 0.0))
    return Pier.of_parts(values["width_m"], all_of_them, deck_height_m=deck, **common)


def _check_one_size(table: Table) -> None:
    """Add to ``table`` that the size, one of two sides or α is missing, the size given in several ways, α or μ beside sides."""
    parts = table.has("part")
    written = [name for name in table.names if name in ("p", "size_m", "width_m", "height_m")]
    sides = [name for name in written if name in ("width_m", "height_m")]
    ways = len(written) - len(sides) + bool(sides)
    if ways == 0:
        table.complain("its size is missing; write p = 0.38 (rad/s), size_m = 60.1, or width_m and height_m")
    elif ways > 1:
        table.complain(
            f"{', '.join(written[:-1])} and {written[-1]} are given, which fix the size more than once; keep p, "
            "or size_m, or width_m with height_m",
            written[-1],
        )
    elif len(sides) == 1 and not (parts and sides == ["width_m"]):
        missing = "height_m" if sides == ["width_m"] else "width_m"
        example = PIER[missing].example
        table.complain(f"{missing} is missing beside {sides[0]}; write for example {missing} = {example}")
    if not sides and not table.has("alpha"):
        table.complain("alpha is missing; write for example alpha = 0.13 (slenderness, rad)")
    if sides and ways == 1:
        instead_of = "the parts" if parts else "width_m and height_m (of a solid rectangle)"
        for name in {"alpha", "mu"} & table.data.keys():
            table.complain(f"{name} follows from {instead_of}; leave it out", name)
