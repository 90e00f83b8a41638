"""Stripes with records of their own in a study file, as record selection gives them: [[fragility.stripe]]."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rockbatch.analyses.fragility.hazard import IN_G, IN_M_S
from rockbatch.common.errors import InputError
from rockbatch.common.grouping import closest
from rockbatch.common.naming import chosen
from rockbatch.common.showing import shown
from rockbatch.toml.csv_columns import columns_of
from rockbatch.toml.kinds import positive, text
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import CONFIRM, Clash, Key, Section


@dataclass(frozen=True)
class StripeRecords:
    """[[fragility.stripe]]: a level, and the records that are run there.

    ``records`` are names or patterns of names; ``scales`` the factor on each, empty where each is scaled to the level.
    """

    level: float
    records: tuple[str, ...]
    scales: tuple[float, ...] = ()


STRIPE = Section(
    ("fragility", "stripe"),
    (
        "A level with its own records, as from a selection by conditional spectra. Write one for each level, "
        "in rising order, in place of levels_g or levels_m_s."
    ),
    {
        "level_g": Key(positive, "0.4", "Level of PGA or Sa.", usual=IN_G),
        "level_m_s": Key(positive, "0.5", "Level of PGV.", usual=IN_M_S),
        "level": Key(positive, "1.5", "Level of another measure, in its unit."),
        "records": Key(
            text,
            '["RSN821*", "RSN1063_RRS228"]',
            "Names of the records as results have them, or patterns of names with * and ?.",
            many=True,
        ),
        "scales": Key(
            positive,
            "[1.7, 0.9]",
            "Factor on each of the records, as it was recorded; if it is not given, each is scaled to the level.",
            many=True,
            distinct=False,
        ),
        "file": Key(
            text,
            '"selection_475.csv"',
            "A CSV file with the records, relative to the study: a column record, and scale if the selection gives factors.",
        ),
        **CONFIRM,
    },
    many=True,
    clashes=(
        Clash(("level_g", "level_m_s"), "level_g and level_m_s are given; keep the one of the measure"),
        Clash(("file", "records"), "file and records are given; keep one"),
        Clash(("file", "scales"), "file and scales are given; write the factors into the file, as its column scale"),
        Clash(("scales",), "scales: write records, too, in the same order", lacking=("records",)),
    ),
)


def read_stripes(file: TomlFile, levels: str) -> tuple[StripeRecords, ...]:
    """Return the stripes of a study, () without any; mistakes become problems of ``file``.

    ``levels`` is the key of the levels of its measure, such as "levels_g".
    """
    key = levels.replace("levels", "level")
    stripes: list[StripeRecords] = []
    for table in file.tables("fragility", "stripe", title=key):
        problems_before = len(file.problems)
        read = table.read(STRIPE)
        for wrong_key in {"level_g", "level_m_s", "level"} - {key} & table.data.keys():
            table.complain(f"{wrong_key}: the measure of [fragility] has {key}; write that", wrong_key)
        if key not in table.data:
            table.complain(f"{key} is missing; write for example {key} = {STRIPE[key].example}")
        records, scales = _records(table, read)
        if file.is_sound_since(problems_before):
            if stripes and read[key] <= stripes[-1].level:
                table.complain(f"{key} = {read[key]:g}: after {stripes[-1].level:g}; write them in rising order", key)
            stripes.append(StripeRecords(read[key], records, scales))
    return tuple(stripes)


def _records(table: Table, read: dict[str, Any]) -> tuple[tuple[str, ...], tuple[float, ...]]:
    if "file" in read:
        with table.noting("file"):
            return _from_file(table, read["file"])
        return (), ()
    records, scales = read.get("records", ()), read.get("scales", ())
    if not table.has("records"):
        table.complain(
            f"it has no records; write records = {STRIPE['records'].example}, or file = {STRIPE['file'].example}"
        )
    elif records and scales and len(records) != len(scales):
        table.complain(f"{len(records)} records and {len(scales)} scales: write a factor for each record", "scales")
    return records, scales


def _from_file(table: Table, name: str) -> tuple[tuple[str, ...], tuple[float, ...]]:
    path = table.file.path.parent / name
    columns = columns_of(path, {"record": text, "scale": positive})
    if "record" not in columns:
        raise InputError(f"{path}: it has no column record")
    if len(set(columns["record"])) < len(columns["record"]):
        raise InputError(f"{path}: a record occurs twice; a stripe runs each once")
    return tuple(columns["record"]), tuple(columns.get("scale", ()))


def members(file: TomlFile, stripes: Sequence[StripeRecords], names: Sequence[str]) -> list[dict[int, float | None]]:
    """Return for each stripe the factors on its records by index in ``names``; None for a factor that scales to the level.

    Raises ``InputError`` with the line of every name that is no record's, of patterns with a factor that fit several, and of
    records that a stripe names twice.
    """
    levels = []
    for n, stripe in enumerate(stripes):
        scales_of_level: dict[int, float | None] = {}
        for place, pattern in enumerate(stripe.records):
            its = set(chosen(pattern, names))
            fitting = [number for number, name in enumerate(names) if name in its]
            wrong = ""
            if not fitting:
                nearest = closest(pattern, names)
                wrong = f"no record has this name; {f'did you mean {shown(nearest)}?' if nearest else 'see `rockbatch motions`'}"
            elif stripe.scales and len(fitting) > 1:
                wrong = f"{len(fitting)} records have such names, and there is one factor; name one of them"
            elif not scales_of_level.keys().isdisjoint(fitting):
                wrong = "its record is in this stripe already; name it once"
            if wrong:
                key = "records" if file.value(("fragility", "stripe", n, "records")) is not None else "file"
                key_path = ("fragility", "stripe", n, key)
                file.complain(
                    (*key_path, place) if key == "records" else key_path,
                    f"[[fragility.stripe]] {shown(pattern)}: {wrong}",
                )
            scales_of_level |= dict.fromkeys(fitting, stripe.scales[place] if stripe.scales else None)
        levels.append(scales_of_level)
    file.finish()
    return levels
