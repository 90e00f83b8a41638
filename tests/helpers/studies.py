"""Studies for tests: a small pier under pulses, of which a test states only what it varies."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

Table = Mapping[str, Any]

PIER = {"alpha": 0.2, "p": 1.0}
SINE = {
    "name": "one-sine",
    "shape": "sine",
    "amplitude_g": 1.0,
    "period_s": 0.5,
    "dt_s": 0.01,
    "duration_s": 4.0,
}
COSINE = {
    "name": "one-cosine",
    "shape": "cosine",
    "amplitude_g": 0.5,
    "period_s": 1.0,
    "dt_s": 0.02,
    "duration_s": 4.0,
}
RIGID = {"name": "rigid", "base": "rigid"}
PADS = {"name": "pads", "base": "yielding", "beta": 50, "eta": 2.5}
SEVEN = [
    ("sine", 0.4),
    ("sine", 0.6),
    ("sine", 1.0),
    ("cosine", 0.5),
    ("cosine", 0.8),
    ("ricker", 0.9),
    ("ricker", 1.3),
]
"""Shapes of pulses and their periods [s]."""


def seven_pulses(amplitude_g: float) -> list[Table]:
    """Return a [[motions.pulse]] of 4 s for each of SEVEN."""
    return [
        SINE | {"name": f"{shape}_{t}", "shape": shape, "amplitude_g": amplitude_g, "period_s": t, "duration_s": 4.0}
        for shape, t in SEVEN
    ]


def toml(table: Table, header: str = "", name: str = "") -> str:
    """Return ``table`` as TOML: its own keys first, then the tables in it, each after an empty line."""
    own, inner = [], []
    for key, value in table.items():
        path = f"{name}.{key}" if name else key
        if isinstance(value, Mapping):
            inner.append(toml(value, f"[{path}]\n", path))
        elif isinstance(value, list | tuple) and all(isinstance(item, Mapping) for item in value):
            inner += [toml(item, f"[[{path}]]\n", path) for item in value]
        else:
            own.append(f"{key} = {json.dumps(value, ensure_ascii=False)}\n")
    return "".join([*(["\n", header, *own] if own else []), *inner])


def study_text(
    *,
    title: str | None = None,
    pier: Table = PIER,
    motions: Table | None = None,
    pulses: Sequence[Table] = (SINE,),
    cases: Sequence[Table] = (RIGID, PADS),
    **tables: Any,
) -> str:
    """Return the text of a study; ``motions`` are keys beside its pulses, ``tables`` what comes after its cases."""
    named = {} if title is None else {"title": title}
    return toml(named | {"pier": pier, "motions": {**(motions or {}), "pulse": pulses}, "case": cases, **tables})


def write_study(folder: Path, text: str, name: str = "study.toml") -> Path:
    """Write the study's file into ``folder`` and return its path."""
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


# Of a folder of records beside the study; further keys of [motions] may follow.
FOLDER_STUDY = toml({"pier": {"alpha": 0.13, "p": 0.38}, "case": [{"base": "rigid"}], "motions": {"path": "records"}})
