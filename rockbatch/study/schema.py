"""JSON schemas (draft 7) by which an editor completes and underlines a study file while it is written.

    python -m rockbatch.study.schema study > study.schema.json

writes one; ``#:schema study.schema.json`` as the first line of a study names it. A schema refuses what a single key shows
to be wrong, and takes all that is right; what takes several keys to see, only the reader tells.
"""

import json
import sys
from collections.abc import Sequence
from typing import Any

from rockbatch.study.sections import FILES, Section
from rockbatch.toml import asking
from rockbatch.toml.reader import Key

Schema = dict[str, Any]


def schema_of(sections: Sequence[Section], title: str) -> Schema:
    """The schema of a file with these sections, of which the one at the top comes first and outer ones before inner."""
    tables: dict[tuple[str, ...], Schema] = {}
    inner = {name for section in sections for name in section.inner}
    for section in sections:
        table = tables[section.at] = _table(section)
        if section.at:
            outer = tables[section.at[:-1]]
            name = section.at[-1]
            several = {"type": "array", "items": table}
            either = {"anyOf": [table, several]} if name in inner else several
            outer["properties"][name] = either if section.many else table
            if section.numbered:
                outer.setdefault("patternProperties", {})[f"^{name}_[1-9][0-9]*$"] = table
            if section.required:
                outer["required"] = [*outer.get("required", []), name]
    return {"$schema": "http://json-schema.org/draft-07/schema#", "title": title, **tables[()]}


def _table(section: Section) -> Schema:
    found: Schema = {
        "type": "object",
        "description": section.about,
        "properties": {name: _value(section, name, key) for name, key in section.keys.items()},
        "additionalProperties": False,
        "required": [name for name, key in section.keys.items() if key.required],
    }
    if section.free:
        found["patternProperties"] = {section.free: {"type": "number"}}
    if section.only_for:
        bases = section.keys["base"].kind
        found["allOf"] = [_only(section, base) for base in asking.schema(bases)["enum"]]
    return found


def _only(section: Section, base: str) -> Schema:
    """Which keys a case on this base may have."""
    names = [name for name in section.keys if base in section.only_for.get(name, (base,))]
    names += [name for name, bases in section.inner.items() if base in bases]
    return {
        "if": {"properties": {"base": {"const": base}}, "required": ["base"]},
        "then": {"propertyNames": {"enum": names}},
    }


def _value(section: Section, name: str, key: Key) -> Schema:
    one = asking.schema(key.kind)
    if key.many:
        several = {"type": "array", "items": one, "minItems": 1, "uniqueItems": key.distinct}
        one = {"anyOf": [one, several]}
    found = one | {"description": section.words.get(name, "")}
    default = section.default(name)
    return found if default is None else found | {"default": list(default) if isinstance(default, tuple) else default}


def main(arguments: Sequence[str]) -> int:
    """Write the schema of a file of FILES to the standard output."""
    if len(arguments) != 1 or arguments[0] not in FILES:
        print(f"write one of {', '.join(FILES)} behind python -m rockbatch.study.schema", file=sys.stderr)
        return 2
    print(json.dumps(schema_of(FILES[arguments[0]], f"rockbatch {arguments[0]}"), indent=1, ensure_ascii=False))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
