"""The piers of a study file, with every combination of listed values: [pier] and [[pier.part]]."""

from collections.abc import Collection, Sequence
from dataclasses import asdict
from typing import Any

from rockbatch.errors import InputError
from rockbatch.pier import Part, Pier
from rockbatch.study.lists import Chosen, combinations, how_many, listed, too_many
from rockbatch.study.plausible import CONFIRM, LENGTHS, MASSES, complain_unless_usual, confirmed
from rockbatch.toml.kinds import KindError, count, not_negative, positive
from rockbatch.toml.reader import Key, Setting, Table, TomlFile


def _columns(value: Any) -> int:
    if count(value) < 2:
        raise KindError("a whole number, 2 or above (a single column is a pier with a deck)")
    return int(value)


PIER = {
    "alpha": Key(positive, "0.13", many=True),
    "mu": Key(positive, "3.0", many=True),
    "gravity": Key(positive, "9.81"),  # one for all: motions given in g are turned into m/s² with it
    "p": Key(positive, "0.38", many=True),
    "size_m": Key(positive, "60.1", many=True),
    "width_m": Key(positive, "4.0", many=True),
    "height_m": Key(positive, "30.0", many=True),
    "mass_t": Key(positive, "3000.0", many=True),
    "deck_mass_t": Key(positive, "1000.0", many=True),
    "deck_height_m": Key(positive, "31.0", many=True),
    "deck_inertia_t_m2": Key(not_negative, "0.0", many=True),
    "top_m": Key(positive, "31.5", many=True),
    "columns": Key(_columns, "4", many=True),
}
PART = {
    "mass_t": Key(positive, "500.0", many=True, required=True),
    "height_m": Key(not_negative, "28.0", many=True, required=True),
    "inertia_t_m2": Key(not_negative, "0.0", many=True),
}
PIER_KEYS = tuple(name for name in PIER if name != "mass_t")
"""Keys that tell piers apart; the mass, which a [[case]] may have too, tells foundations apart."""

Values = dict[str, float | str]


def read_piers(file: TomlFile) -> tuple[list[tuple[Pier, Values]], tuple[str, ...]]:
    """The piers of [pier] with their keys' values (none if there are mistakes), and which keys are lists.

    Those of the n-th [[pier.part]] are called part_n_mass_t and so on.
    """
    table = file.table("pier", required="[pier] with alpha = 0.13 and p = 0.38, or with width_m and height_m")
    if table is None:
        return [], ()
    before = len(file.problems)
    read = table.read(PIER | CONFIRM, other=("part",))
    believed = confirmed(table, read, PIER)
    gravity = {"gravity": read.pop("gravity")} if "gravity" in read else {}
    _check_one_size(table)
    _check_masses(table)
    for name, usual in (LENGTHS | MASSES).items():
        complain_unless_usual(table, name, read.get(name, ()), usual, believed)
    varied = listed(table, PIER)
    parts = file.tables("pier", "part", title="name")
    if table.data.get("part") == []:
        table.complain(
            "part = []: a pier has one part at least; write [[pier.part]] above each, or leave it out", "part"
        )
    for n, part in enumerate(parts, 1):
        its, names = _part(part, n)
        read |= its
        varied += names
    if told := too_many(how_many(read), "piers"):
        table.complain(told)
    if not file.is_sound_since(before):
        return [], ()
    piers = []
    for chosen in combinations(read):
        values = {name: setting.value for name, setting in chosen.items()} | gravity
        try:
            pier = _pier(values, len(parts), believed)
        except InputError as error:
            for problem in error.problems:
                _complain_where_due(table, chosen, problem)
        else:
            derived = {name: value for name, value in asdict(pier).items() if value is not None}
            piers.append((pier, derived | values))
    return piers, varied


def has_mass(file: TomlFile) -> bool:
    """Whether [pier] says what the pier weighs."""
    return file.value(("pier", "mass_t")) is not None or bool(file.value(("pier", "part")))


def _part(table: Table, n: int) -> tuple[dict[str, Sequence[Setting]], tuple[str, ...]]:
    """Settings of the n-th part by the names that set them apart, and which of them are lists."""
    read = table.read(PART | CONFIRM)
    believed = confirmed(table, read, PART)
    for name, usual in (LENGTHS | MASSES).items():
        complain_unless_usual(table, name, read.get(name, ()), usual, believed)
    return {f"part_{n}_{name}": its for name, its in read.items()}, tuple(f"part_{n}_{x}" for x in listed(table, PART))


def _pier(values: dict[str, Any], parts: int, believed: Collection[str]) -> Pier:
    """The pier that these keys say; which of them go together is checked already."""
    rest: dict[str, Any] = {name: values[name] for name in ("gravity", "top_m") if name in values}
    rest["confirm"] = believed
    if parts:
        return _of_parts(values, parts, rest)
    if "deck_mass_t" in values and "columns" not in values:
        names = ("width_m", "height_m", "mass_t", "deck_mass_t", "deck_height_m", "deck_inertia_t_m2")
        return Pier.with_deck(**{name: values[name] for name in names if name in values}, **rest)
    rest |= {
        name: values[name] for name in ("alpha", "p", "size_m", "mu", "width_m", "height_m", "mass_t") if name in values
    }
    if "width_m" in values:
        pier = Pier.rectangle(**rest)
    elif "size_m" in values:
        pier = Pier.from_size(**rest)
    else:
        del rest["confirm"]
        pier = Pier(**rest)
        if "top_m" in rest:
            Pier.from_size(pier.alpha, pier.size, pier.mu, pier.gravity, top_m=pier.top_m, confirm=believed)
    return Pier.frame(pier, values["columns"], values["deck_mass_t"]) if "columns" in values else pier


def _of_parts(values: dict[str, Any], parts: int, rest: dict[str, Any]) -> Pier:
    """A pier of parts, and the deck as one more; drift is read at the highest point that is known."""
    all_of_them = [
        Part(**{name: values[f"part_{n}_{name}"] for name in PART if f"part_{n}_{name}" in values})
        for n in range(1, parts + 1)
    ]
    deck = None
    if "deck_mass_t" in values:
        deck = values["deck_height_m"] if "deck_height_m" in values else values["height_m"]
        all_of_them.append(Part(values["deck_mass_t"], deck, values.get("deck_inertia_t_m2", 0.0)))
    top = max(values.get("height_m", 0.0), *(part.height_m for part in all_of_them))
    return Pier.of_parts(values["width_m"], all_of_them, **{"top_m": top, "deck_height_m": deck} | rest)


def _complain_where_due(table: Table, chosen: Chosen, problem: str) -> None:
    """Place a problem of the pier, "key = …", at that key."""
    if "write confirm" in problem:
        problem += " in this table"
    name = problem.split(" = ")[0]
    if name in chosen:
        table.complain_about(chosen[name], problem)
    else:
        table.complain(problem)


# Mistakes that take more than one key to see


def _check_one_size(table: Table) -> None:
    """Exactly one way to give the pier's size, and α and μ only where they do not follow from it."""
    parts = "part" in table.data
    given = [name for name in table.data if name in ("p", "size_m", "width_m", "height_m")]
    sides = [name for name in given if name in ("width_m", "height_m")]
    ways = len(given) - len(sides) + bool(sides)
    if ways == 0:
        table.complain("its size is missing; write p = 0.38 (rad/s), size_m = 60.1, or width_m and height_m")
    elif ways > 1:
        table.complain(
            f"{', '.join(given[:-1])} and {given[-1]} are given, which fix the size more than once; keep p, "
            "or size_m, or width_m with height_m",
            given[-1],
        )
    elif len(sides) == 1 and not (parts and sides == ["width_m"]):
        missing = "height_m" if sides == ["width_m"] else "width_m"
        example = PIER[missing].example
        table.complain(f"{missing} is missing beside {sides[0]}; write for example {missing} = {example}")
    if not sides and "alpha" not in table.data:
        table.complain("alpha is missing; write for example alpha = 0.13 (slenderness, rad)")
    if sides and ways == 1:
        of = "the parts" if parts else "width_m and height_m (of a solid rectangle)"
        for name in {"alpha", "mu"} & table.data.keys():
            table.complain(f"{name} follows from {of}; leave it out", name)


def _check_masses(table: Table) -> None:
    """Each mass is said once, and where it is."""
    given = table.data.keys()
    parts, deck, frame, sides = ("part" in given, "deck_mass_t" in given, "columns" in given, "width_m" in given)
    if parts and not sides:
        table.complain(
            "[[pier.part]]: needs width_m, between the pivots, and no other size; write width_m = 4.0", "part"
        )
    if parts and "mass_t" in given:
        table.complain("mass_t: the parts say what the pier weighs; leave it out", "mass_t")
    if deck and not (parts or "mass_t" in given):
        told = "of one column" if frame else "of the pier without its deck"
        table.complain(
            f"mass_t is missing beside deck_mass_t, {told}; write for example mass_t = 2000.0", "deck_mass_t"
        )
    if deck and not (sides or frame):
        table.complain(
            "deck_mass_t: goes with width_m and height_m; other sizes are those of the pier with its deck, and mass_t is then "
            "the mass of both",
            "deck_mass_t",
        )
    if deck and parts and not given & {"height_m", "deck_height_m"}:
        table.complain(
            "deck_height_m is missing beside deck_mass_t; write for example deck_height_m = 31.0", "deck_mass_t"
        )
    for name in ("deck_height_m", "deck_inertia_t_m2"):
        if name in given and not deck:
            table.complain(f"{name}: there is no deck; write deck_mass_t too, or leave it out", name)
    if frame:
        _check_frame(table)


def _check_frame(table: Table) -> None:
    """A frame takes its columns' size and mass, and its deck's mass."""
    why = {
        "part": "the columns of a frame are solid rectangles; leave [[pier.part]] out",
        "mu": "the columns of a frame are solid rectangles; leave it out",
        "deck_height_m": "the deck of a frame rests on its columns and keeps level, so only its mass counts; leave it out",
        "deck_inertia_t_m2": "the deck of a frame keeps level, so only its mass counts; leave it out",
        "top_m": "the deck of a frame keeps level, so all of it drifts as the tops of the columns do; leave it out",
    }
    if "deck_mass_t" not in table.data:
        table.complain("columns: a frame has a deck; write deck_mass_t, of the whole deck, too", "columns")
    for name, told in why.items():
        if name in table.data:
            table.complain(f"{name}: {told}", name)
