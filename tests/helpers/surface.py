"""What users write scripts and studies against, as data: `python tests/helpers/surface.py > tests/stable/1.0.json`.

The release's file holds what it promised (docs/pages/stability.md); :func:`taken_away` says what of it is no longer there.
"""

import inspect
import json
from dataclasses import fields, is_dataclass
from importlib import import_module
from types import FunctionType
from typing import Any, get_type_hints

import rockbatch as rb
from rockbatch.commands.arguments import COMMANDS
from rockbatch.commands.cli import EXIT_CODES
from rockbatch.quantities.catalogue import COLUMNS
from rockbatch.study.schema import FILES, schema_of

Surface = dict[str, dict[str, list[str]]]

CALLED = {"python", "commands"}
"""Groups whose parts are parameters: ``name=`` may be left out, and what follows ``*`` is written with its name."""

MADE = {"Response", "Statics", "Study"}
"""Classes that functions make for users, who do not call them."""

INNER = {
    "NAME", "TABLES", "counting", "counts", "deck", "ends", "flies", "has_exponent", "has_residual",
    "in_file", "intensity_order", "is_ban", "least_beta", "lined", "linear", "log_slope", "misfit",
    "missing_in_words", "named", "of_station", "on_springs", "overruled", "parameters", "quadrature", "ratchets",
    "reduced_to", "refuse_irregular", "sense", "spec", "what", "yields",
}  # fmt: skip
"""Attributes without an underscore that modules of rockbatch share, and that no page names."""


def surface() -> Surface:
    """Return all that is promised: by group and name, its parameters, or the words that a key takes."""
    schemas = {name: _keys(schema_of(sections, name), name) for name, sections in FILES.items()}
    return {
        "python": _python(),
        "keys": {key: values for keys in schemas.values() for key, values in keys.items()},
        "columns": {name: [] for name in COLUMNS},
        "commands": {name: _options(command.arguments) for name, command in COMMANDS.items()},
        "exit codes": {line.split()[0]: [] for line in EXIT_CODES.splitlines()[1:]},
    }


def taken_away(promised: Surface, present: Surface) -> list[str]:
    """Return what a script or a study of the release can no longer write; additions are none of it."""
    lost = []
    for group, names in promised.items():
        differing = _harder_to_call if group in CALLED else _fewer_words
        for name, before in names.items():
            now = present[group].get(name)
            lost += (
                [f"{group}: {name}"] if now is None else [f"{group}: {name}: {part}" for part in differing(before, now)]
            )
    return lost


def _fewer_words(before: list[str], now: list[str]) -> list[str]:
    """Return the words that a key no longer takes; one without words takes any."""
    return [str(word) for word in before if word not in now] if before else [f"only {word}" for word in now]


def _harder_to_call(before: list[str], now: list[str]) -> list[str]:
    """Return the parameters that are gone, stand in another place, or have to be given where they had not."""
    places, places_now = _placed(before), _placed(now)
    gone = sorted({part.rstrip("=") for part in before} - {part.rstrip("=") for part in now})
    moved = [] if gone or places_now[: len(places)] == places else [f"{', '.join(places)} stand otherwise"]
    needed = [part for part in now if not part.endswith("=") and part not in before and part != "*"]
    return [f"{part} is gone" for part in gone] + moved + [f"{part} has to be given" for part in needed]


def _placed(parameters: list[str]) -> list[str]:
    """Return the names of the parameters that a place tells."""
    return [part.rstrip("=") for part in (parameters[: parameters.index("*")] if "*" in parameters else parameters)]


def _python() -> dict[str, list[str]]:
    """Return the parameters of the public names, of what these classes have, and of what these functions return."""
    found = {}
    for name, home in sorted(rb._homes().items()):
        thing = getattr(import_module(home), name)
        found[name] = [] if name in MADE else _parameters(thing)
        kind = thing if inspect.isclass(thing) else get_type_hints(thing).get("return")
        if kind is thing:
            found |= _of_class(name, kind)
        elif getattr(kind, "__module__", "").startswith("rockbatch") and kind.__name__ not in rb._homes():
            found |= _of_class(f"{name}()", kind)
    return found


def _of_class(name: str, kind: Any) -> dict[str, list[str]]:
    owners = [owner for owner in kind.__mro__ if owner.__module__.startswith("rockbatch")]
    names = {part for owner in owners for part in vars(owner)}
    names |= {field.name for field in fields(kind)} if is_dataclass(kind) else set()
    parts = {part: inspect.getattr_static(kind, part, None) for part in names - INNER if not part.startswith("_")}
    methods = {part for part, thing in parts.items() if isinstance(thing, FunctionType | classmethod | staticmethod)}
    return {f"{name}.{part}": _parameters(getattr(kind, part)) if part in methods else [] for part in sorted(parts)}


def _parameters(function: Any) -> list[str]:
    listed = []
    for parameter in inspect.signature(function).parameters.values():
        if parameter.kind is parameter.KEYWORD_ONLY and not any(part.startswith("*") for part in listed):
            listed.append("*")
        stars = {parameter.VAR_POSITIONAL: "*", parameter.VAR_KEYWORD: "**"}.get(parameter.kind, "")
        optional = parameter.default is not parameter.empty or stars == "**"
        listed.append(f"{stars}{parameter.name}{'=' if optional else ''}")
    return [part for part in listed if part != "self"]


def _keys(schema: dict[str, Any], at: str) -> dict[str, list[str]]:
    """Return the keys of a table and of those in it, with the words that a key takes."""
    found = {}
    for name, value in schema.get("properties", {}).items():
        inner = [value, value.get("items", {}), *value.get("anyOf", [])]
        tables = [kind for kind in [*inner, *(kind.get("items", {}) for kind in inner)] if "properties" in kind]
        words = [word for kind in inner for word in kind.get("enum", [])]
        found[f"{at}.{name}"] = words
        found |= {} if not tables else _keys(tables[0], f"{at}.{name}")
    return found


def _options(arguments: Any) -> list[str]:
    """Return the arguments of a command in the form of parameters; its options are the keywords."""
    placed = [
        f"{value.get('metavar', name)}{'=' if value.get('nargs') == '?' else ''}"
        for name, value in arguments.items()
        if not name.startswith("-")
    ]
    return [*placed, "*", *(f"{name}=" for name in arguments if name.startswith("-"))]


if __name__ == "__main__":
    groups = []
    for group, names in surface().items():
        lines = ",\n".join(f"  {json.dumps(name)}: {json.dumps(parts)}" for name, parts in names.items())
        groups.append(f" {json.dumps(group)}: {{\n{lines}\n }}")
    print("{\n" + ",\n".join(groups) + "\n}")
