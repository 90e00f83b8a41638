"""[output] of a study: results beyond the peaks, most of them of observers, which declare their own keys."""

from collections.abc import Collection
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, TypeVar

from rockbatch.common.errors import InputError, Problem, UnknownKey
from rockbatch.common.observers import parts
from rockbatch.toml.kinds import choice, positive
from rockbatch.toml.meant import names
from rockbatch.toml.section import Key, Section, joined

S = TypeVar("S")

_OF_OBSERVERS: tuple[Section, ...] = tuple(parts("study.OUTPUT"))
_SETTINGS = tuple(home for section in _OF_OBSERVERS for home in section.homes)
"""Dataclasses of the keys of observers, with their defaults."""


@dataclass(frozen=True)
class Output:
    """[output]: results beyond the peaks, each of which costs time; :data:`OUTPUT` explains them.

    ``settings`` are those of observers that differ from their defaults.
    """

    histories: str = "worst"
    histories_MB: float = 20.0  # noqa: N815 (the study's key)
    settings: tuple[object, ...] = ()

    @classmethod
    def with_keys(cls, **keys: Any) -> "Output":
        """Return the output of a table with these ``keys``, others at their defaults. Raises ``InputError`` for unknown ones."""
        if unknown := keys.keys() - OUTPUT.keys():
            raise InputError(
                *(Problem(key, keys[key], "there is no such output", kind=UnknownKey) for key in sorted(unknown))
            )
        settings = [kind(**_fields_of(kind, keys)) for kind in _SETTINGS]
        return cls(**_fields_of(cls, keys), settings=tuple(chosen for chosen in settings if chosen != type(chosen)()))

    @cached_property
    def keys(self) -> dict[str, Any]:
        """Return all keys with their values, given or default."""
        return {
            key: getattr(home, key) for home in (self, *map(self.of, _SETTINGS)) for key in OUTPUT if hasattr(home, key)
        }

    def of(self, kind: type[S]) -> S:
        """Return the settings of the observer whose dataclass is ``kind``, its defaults if none are given."""
        return next((chosen for chosen in self.settings if isinstance(chosen, kind)), kind())

    def has(self, key: str) -> bool:
        """Return whether an optional output is asked for: the value of its ``key`` is true, or not empty; False if unknown."""
        return bool(self.keys.get(key))

    def also(self, keys: Collection[str]) -> "Output":
        """Return the output with those of ``keys`` that are yes or no switched on, too; other ``keys`` change nothing."""
        known = self.keys
        return self.with_keys(**known | {key: True for key in keys if known.get(key) is False})

    def only(self, keys: Collection[str]) -> "Output":
        """Return the output with those of ``keys`` that are yes or no switched on alone, without histories.

        Keys that apply only with these keep their values.
        """
        known = self.keys
        chosen = {key: True for key in keys if isinstance(known.get(key), bool)}
        settings = {key: value for key, value in known.items() if OUTPUT[key].only.keys() & chosen.keys()}
        return self.with_keys(histories="none", **chosen, **settings)


def _fields_of(kind: type, keys: dict[str, Any]) -> dict[str, Any]:
    """Return the ``keys`` that are fields of a dataclass."""
    return {field.name: keys[field.name] for field in fields(kind) if field.name in keys}


OUTPUT = joined(
    Section(
        ("output",),
        "What is kept beyond the table of peaks.",
        {
            "histories": Key(
                choice("worst", "all", "none"),
                '"all"',
                'Runs whose histories are kept: the "worst" record of each case, "all", or "none".',
            ),
            "histories_MB": Key(
                positive,
                "50",
                'How large their file may become with "worst"; the greatest rotations are kept first.',
                only={"histories": ("worst",)},
            ),
        },
        homes=(Output,),
        also=names({"histories": "timehistories timehistory", "forces": "baseshear internalforces"}),
        instead=names(
            {
                "write --out FOLDER behind rockbatch run; leave it out": "path folder directory dir out file",
                "`rockbatch report` draws them, and makes a PDF with --sheet; leave it out": "plot plots figures pdf png",
                "estimates of design practice are an example now, configs/code_estimates.py; leave it out": "estimate estimates",
            }
        ),
    ),
    *_OF_OBSERVERS,
)
