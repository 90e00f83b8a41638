"""Studies of the commands that carry out runs in waves or under bounds, for tests that stop them in the middle."""

from pathlib import Path

from studies import RIGID, SINE, Table, study_text, write_study

SPRUNG = {"name": "springs", "base": "elastic", "beta": 50.0}
CHECK = {"name": "peak", "demand": "theta_max_over_alpha", "at_most": 0.3, "reason": "made up"}
TABLES = {
    "run": {"cases": (SPRUNG, RIGID), "bound": [{"name": "soft", "case.beta": {"times": 0.8}}]},
    "design": {
        "cases": (SPRUNG,),
        "design": {"vary": "case.beta", "between": [30.0, 60.0], "find": "least", "points": 3, "width": 10.0},
    },
    "fragility": {"cases": (SPRUNG, RIGID), "fragility": {"measure": "PGA", "levels_g": [0.3, 0.6, 1.2]}},
}
"""Tables of the study of each command."""


def study_of(command: str, folder: Path, pulses: "list[Table] | tuple[Table, ...]" = (SINE,)) -> Path:
    """Write the study of a command into ``folder`` and return its path."""
    text = study_text(pulses=pulses, check=[CHECK], output={"histories": "none"}, **TABLES[command])
    return write_study(folder, text)


def tables_in(folder: Path) -> dict[str, bytes]:
    """Return the tables of a folder by name."""
    return {path.name: path.read_bytes() for path in folder.glob("*.csv")}
