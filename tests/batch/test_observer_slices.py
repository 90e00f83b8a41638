"""An observer is one folder and one name in a tuple: in a copy of the package each is deleted, and another one added."""

import json
import os
import shutil
import subprocess
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pandas as pd
import pytest
from studies import PADS, PIER, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common import observers
from rockbatch.common.observers import OBSERVERS, report_parts
from rockbatch.quantities.catalogue import COLUMNS, DEMANDS
from rockbatch.reporting.page import PARTS
from rockbatch.results.opened import Results

KEYS = {
    "other_law": {"both_laws": True},
    "rocking": {"rocking": True},
    "energy_balance": {"ledger": True},
    "forces": {"forces": True},
    "devices_work": {"devices_work": True},
    "half_cycles": {"half_cycles": True},
    "sections": {"sections": 3},
    "interaction": {"interaction_m": [0.0]},
    "shocks": {},
    "intensity": {"intensity": True},
}
"""What a study writes under [output] for each."""

GROUPS = ("FIRST", "QUANTITIES", "ERRORS", "FURTHER", "LAST")
"""Places of the columns that observers bring."""

IN_CI = ("forces", "rocking", "sections")
"""Those that are deleted in CI: one with columns, one without forces of its own, one with a table beside."""

RUN = """
import json, sys
import rockbatch as rb
from rockbatch.quantities.catalogue import COLUMNS, DEMANDS
from rockbatch.reporting.page import PARTS
rb.run(sys.argv[1], sys.argv[2])
try:
    rb.load_study(sys.argv[3])
except rb.UnknownKey as error:
    print(error)
print("seen:", json.dumps([[part.anchor for part in PARTS], [*COLUMNS], [*DEMANDS]]))
"""


def delete(package, name):
    """Delete an observer: its folder, and its line in the tuple."""
    shutil.rmtree(package / "observers" / name)
    listing = package / "common" / "observers.py"
    lines = listing.read_text(encoding="utf-8").splitlines(keepends=True)
    kept = [line for line in lines if line != f'    "{name}",\n']
    assert len(kept) == len(lines) - 1
    listing.write_text("".join(kept), encoding="utf-8")


def copy_of_package(tmp_path):
    """Return a folder with a copy of the package."""
    copied = tmp_path / "copied"
    shutil.copytree(Path(rb.__file__).parent, copied / "rockbatch", ignore=shutil.ignore_patterns("*.nb[ci]"))
    return copied


def run_in(copied, *arguments):
    """Run :data:`RUN` with the package in ``copied``."""
    command = [sys.executable, "-c", RUN, *map(str, arguments)]
    environment = os.environ | {"PYTHONPATH": str(copied)}
    done = subprocess.run(command, cwd=copied, env=environment, text=True, capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    return done


def brought(name):
    """Return the parts of the report, the columns and the demands that an observer brings."""
    parts = [part.anchor for owner, part in report_parts() if owner == name]
    if not find_spec(f"rockbatch.observers.{name}.quantities"):
        return parts, [], []
    quantities = import_module(f"rockbatch.observers.{name}.quantities")
    columns = [quantity for group in GROUPS for quantity in getattr(quantities, group, ())]
    demands = [*getattr(quantities, "DEMANDS", ()), *(demand for column in columns for demand in column.demands())]
    return parts, [column.name for column in columns], [demand.name for demand in demands]


def output_of(names):
    return {"histories": "none"} | {key: value for name in names for key, value in KEYS[name].items()}


def study_of(folder, names, name="study.toml"):
    damper = {"kind": "friction", "f": 0.05, "at": "left"}
    cases = [RIGID, PADS, RIGID | {"name": "damped", "damper": [damper]}]
    pier = PIER | {"mass_t": 400.0}
    text = study_text(pier=pier, pulses=[SINE | {"duration_s": 2.0}], cases=cases, output=output_of(names))
    return write_study(folder, text, name)


def test_every_observer_is_deleted_below():
    assert sorted(KEYS) == sorted(OBSERVERS)
    assert {name for name in OBSERVERS if brought(name)[0]} == {
        "forces",
        "shocks",
        "sections",
        "interaction",
        "intensity",
    }
    assert {name for name in OBSERVERS if brought(name)[1]} == {*OBSERVERS} - {
        "shocks",
        "half_cycles",
        "sections",
        "interaction",
        "intensity",
    }
    assert {name for name in OBSERVERS if brought(name)[2]} == {
        "rocking",
        "forces",
        "devices_work",
        "sections",
        "interaction",
    }


@pytest.mark.slow
@pytest.mark.parametrize("name", [n if n in IN_CI else pytest.param(n, marks=pytest.mark.thorough) for n in OBSERVERS])
def test_an_observer_is_deleted_with_its_folder_and_its_name(tmp_path, name):
    """Tables of a study that asks for all others are the same to the byte, and its key is unknown."""
    study, asking = (
        study_of(tmp_path, [other for other in OBSERVERS if other != name]),
        study_of(tmp_path, [name], "own.toml"),
    )
    rb.run(study, tmp_path / "whole")
    copied = copy_of_package(tmp_path)
    delete(copied / "rockbatch", name)
    sources = [path.read_text(encoding="utf-8") for path in copied.rglob("*.py")]
    assert not [source for source in sources if f'observed.get("{name}")' in source or f"observers.{name}" in source]
    done = run_in(copied, study, tmp_path / "rest", asking)
    assert all(f"{key}: unknown key" in done.stdout for key in KEYS[name])
    parts, columns, demands = (set(own) for own in brought(name))
    assert json.loads(done.stdout.rpartition("seen: ")[2]) == [
        [part.anchor for part in PARTS if part.anchor not in parts],
        [column for column in COLUMNS if column not in columns],
        [demand for demand in DEMANDS if demand not in demands],
    ]
    files = [path.name for path in sorted((tmp_path / "whole").glob("*.csv"))]
    assert files == [path.name for path in sorted((tmp_path / "rest").glob("*.csv"))]
    for file in files:
        assert (tmp_path / "whole" / file).read_bytes() == (tmp_path / "rest" / file).read_bytes()


def test_results_have_no_table_of_an_observer_that_is_not_there(monkeypatch):
    monkeypatch.setattr(
        observers, "OBSERVERS", tuple(name for name in OBSERVERS if name not in ("shocks", "intensity"))
    )
    results = object.__new__(Results)
    assert not any(hasattr(results, name) for name in ("shocks", "intensity"))


QUICKEST = {
    "__init__.py": '"""Greatest speed of rocking."""\n',
    "study.py": """
from dataclasses import dataclass
from rockbatch.toml.kinds import boolean
from rockbatch.toml.section import Key, Section

@dataclass(frozen=True)
class Quickest:
    quickest: bool = False

OUTPUT = Section(("output",), "", {"quickest": Key(boolean, "true", "Whether it is added.")}, homes=(Quickest,))
""",
    "observe.py": """
from dataclasses import dataclass
import numpy as np
from rockbatch.observers.quickest.study import Quickest
from rockbatch.simulation.observing import Observer

@dataclass(frozen=True)
class GreatestSpeed(Observer):
    def read(self, recording, outcome):
        return float(np.abs(recording.rows.omega).max())

    def add(self, run, outcome, fine, coarse):
        return outcome if fine is None else outcome.with_observed("quickest", fine)

def requested(output):
    return GreatestSpeed() if output.of(Quickest).quickest else None
""",
    "quantities.py": """
from rockbatch.quantities.quantity import Limit, Quantity, ReportFormat

def _speed(run):
    return run.outcome.observed.get("quickest")

LAST = (
    Quantity("omega_max_rad_s", "greatest speed of rocking", _speed, "rad/s", ReportFormat("speed", ".3f"), needs="quickest",
        limits=(Limit(),)),
)
""",
}
"""Files of an observer with a column."""


@pytest.mark.slow
def test_an_observer_with_a_column_is_added_by_its_folder_and_its_name(tmp_path):
    """Its column and its demand are there, next to that of the angular velocity over p, which is the same."""
    copied = copy_of_package(tmp_path)
    folder = copied / "rockbatch" / "observers" / "quickest"
    folder.mkdir()
    for name, source in QUICKEST.items():
        (folder / name).write_text(source, encoding="utf-8")
    listing = copied / "rockbatch" / "common" / "observers.py"
    text = listing.read_text(encoding="utf-8")
    listing.write_text(text.replace("OBSERVERS = (\n", 'OBSERVERS = (\n    "quickest",\n'), encoding="utf-8")
    study = study_text(pier=PIER, pulses=[SINE], cases=[RIGID], output={"quickest": True, "forces": True})
    path = write_study(tmp_path, study)
    done = run_in(copied, path, tmp_path / "results", path)
    demands = json.loads(done.stdout.rpartition("seen: ")[2])[2]
    assert "omega_max_rad_s" in demands
    row = pd.read_csv(tmp_path / "results" / "peaks.csv").iloc[0]
    assert row["omega_max_rad_s"] == pytest.approx(
        row["omega_max_over_p"] * rb.load_study(study_of(tmp_path, [])).cases[0].pier.p
    )
