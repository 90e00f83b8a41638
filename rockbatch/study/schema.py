"""JSON schemas (draft 7) by which an editor completes and underlines a study file while it is written.

    python -m rockbatch.study.schema study > study.schema.json

writes one; ``#:schema study.schema.json`` as the first line of a study names it. A schema refuses
values that are wrong by themselves, and accepts every valid file; contradictions between keys are left to the reader.
"""

import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace

from rockbatch.checks.rule_files import SUITE
from rockbatch.checks.rule_files import TOP as CHECKS_TOP
from rockbatch.checks.rules import CHECK
from rockbatch.common.analyses import doors, from_analysis
from rockbatch.motions import manifest
from rockbatch.study import load
from rockbatch.toml.kinds import Schema
from rockbatch.toml.section import Section, options

STUDY = (
    *load.SECTIONS,
    *(part for name, door in doors().items() if door.tables for part in from_analysis(name, "study.SECTIONS")),
)
"""A study file."""

CHECKS = (CHECKS_TOP, SUITE, replace(CHECK, required=True))
"""A file of checks, as ``rockbatch check --rules`` takes it."""

MANIFEST = (Section((), "", {}), *manifest.SECTIONS)
"""``motions.toml``, beside the records."""

FILES = {"study": STUDY, "checks": CHECKS, "manifest": MANIFEST}


def schema_of(sections: Sequence[Section], title: str) -> Schema:
    """Return the schema of a file with these sections, of which the one at the top comes first and outer ones before inner."""
    tables: dict[tuple[str, ...], Schema] = {}
    for section in sections:
        table = tables[section.at] = _table(section)
        if section.at:
            outer = tables[section.at[:-1]]
            name = section.at[-1]
            several = {"type": "array", "items": table}
            either = {"anyOf": [table, several]} if section.single else several
            outer["properties"][name] = either if section.many else table
            if section.numbered:
                outer.setdefault("patternProperties", {})[f"^{name}_[1-9][0-9]*$"] = table
            if section.required:
                outer["required"] = [*outer.get("required", []), name]
    return {"$schema": "http://json-schema.org/draft-07/schema#", "title": title, **tables[()]}


def _table(section: Section) -> Schema:
    """Return the schema of one table, with conditions for keys that depend on the value of another."""
    table: Schema = {
        "type": "object",
        "description": section.about,
        "properties": {name: _value(section, name) for name in section},
        "additionalProperties": False,
        "required": [name for name, key in section.items() if key.always_required],
    }
    if section.free:
        table["patternProperties"] = {section.free: dict(section.free_schema)}
    names = dict.fromkeys(key_name for key in section.values() for key_name in key.only)
    if conditions := [excluded for key_name in names for excluded in _excluded(section, key_name)]:
        table["allOf"] = conditions
    return table


def _excluded(section: Section, other: str) -> Iterator[Schema]:
    """Yield conditions that exclude the keys that do not apply beside a value of ``other``, or without that key."""
    for value in options(section[other]):
        single: Schema = {"const": value}
        several = {"anyOf": [single, {"type": "array", "items": single, "minItems": 1}]}
        condition = {"properties": {other: several if section[other].many else single}, "required": [other]}
        yield from _unless(section, other, value, condition)
    if not section[other].always_required:
        yield from _unless(section, other, section.default(other), {"not": {"required": [other]}})


def _unless(section: Section, other: str, value: object, condition: Schema) -> Iterator[Schema]:
    """Yield one exclusion, under ``condition``, of the keys that do not apply to this ``value`` of ``other``; none if all do."""
    names = [name for name, key in section.items() if other in key.only and value not in key.only[other]]
    if names:
        yield {"if": condition, "then": {"properties": dict.fromkeys(names, False)}}


def _value(section: Section, name: str) -> Schema:
    """Return the schema of the value of a key, with its meaning and its default."""
    key = section[name]
    single = key.kind.schema()
    if key.pair:
        single = {"type": "array", "items": single, "minItems": 2, "maxItems": 2}
    elif key.many:
        several = {"type": "array", "items": single, "minItems": 1, "uniqueItems": key.distinct}
        single = {"anyOf": [single, several]}
    default = section.default(name)
    words = single | {"description": key.words}
    return words if default is None else words | {"default": list(default) if isinstance(default, tuple) else default}


def main(arguments: Sequence[str]) -> int:
    """Print the schema of one of :data:`FILES`; return the exit status, 2 for another argument."""
    if len(arguments) != 1 or arguments[0] not in FILES:
        print(f"write one of {', '.join(FILES)} behind python -m rockbatch.study.schema", file=sys.stderr)
        return 2
    print(json.dumps(schema_of(FILES[arguments[0]], f"rockbatch {arguments[0]}"), indent=1, ensure_ascii=False))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
