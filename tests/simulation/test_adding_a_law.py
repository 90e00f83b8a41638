"""A support law is added in a copy by the recipe of CONTRIBUTING: two records, after which everything asks for it.

Nothing is compiled, since these runs take seconds without, and their kernels more than a minute.
"""

import json
import math
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import rockbatch

TOP = Path(rockbatch.__file__).parent

CORE = """    "softening": Law(
        limited=1.0, yields_at_first=1.0, yields_when_pressed=1.0, has_point=0.0, remembers=0.0,
        stiffness_loss=softening_loss, plastic_work=softening_work,
    ),
}
\"\"\"All laws"""

KERNELS = '''@inlined
def softening_loss(m, x):
    """Return x, by which the stiffness falls on a straight line."""
    return x


@kernel
def softening_work(m, z_from, z_to, plastic_deflection):
    """Return ∫ x² dx/(1 − x) δ_y."""
    start, end = -z_from, -z_to
    share = np.log((1.0 - start) / (1.0 - end)) - (end - start) * (1.0 + 0.5 * (start + end))
    return m.yield_deflection * share


LAWS = {
'''

PIER = """    "softening": Law(
        meaning="softer in proportion to its force",
        has_exponent=False,
        has_points=False,
        first_loading=lambda n, points: SOFTENING,
        creep=Creep(exponent=lambda n: 1.0, other="epp"),
    ),
}
\"\"\"All laws"""

SCRIPT = """
import json
import numpy as np
import rockbatch as rb
from rockbatch.observers.other_law.observe import by_other_law
from rockbatch.quantities.cases import creeps
from rockbatch.simulation import run_fixed
from rockbatch.study.case_keys import CASE

pier = rb.Pier(0.2, 1.0)
base = rb.YieldingBase(30.0, 0.1, eta=2.5, spring="softening")
motion = rb.pulse("sine", name="push", amplitude=4.0, period=0.6, dt=0.01, duration=2.0)
shaken = rb.simulate(pier, base, motion, substeps=8, quiet_s=0.0, wait=False, ledger=True)
released = rb.simulate(pier, base, motion, substeps=8, quiet_s=0.0, wait=False, initial_rotation_rad=0.05)
outcome = run_fixed(pier, base, motion, 8, 0.0, wait=False)
held, first = released.history.iloc[0], shaken.history.iloc[0]
print(json.dumps({
    "settled": rb.statics(pier, base).settlement_m,
    "at rest": [first.v, first.z_left],
    "held": [held.v_right, held.z_right],
    "remainder": float(np.abs(shaken.ledger["remainder"]).max()),
    "plastic": float(shaken.ledger["plastic"].iloc[-1]),
    "dissipated": outcome.dissipated_left + outcome.dissipated_right,
    "creeps": creeps({"parameters": base.parameters(pier)}),
    "other": by_other_law(base).spring,
    "help": CASE["spring"].words,
}))
"""


@pytest.fixture
def copied(tmp_path):
    shutil.copytree(TOP, tmp_path / "rockbatch", ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


def edit(place, module, *changes):
    path = place / "rockbatch" / module
    text = path.read_text(encoding="utf-8")
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    path.write_text(text, encoding="utf-8")


def add(place, core=CORE, of_pier=PIER, literal=True):
    end = '}\n"""All laws'
    edit(place, "core/springs/laws.py", ("LAWS = {\n", KERNELS), (end, core))
    edit(
        place,
        "pier/laws.py",
        (end, of_pier),
        ("import Curve, Polyline, Straight, bouc_wen\n", "import Curve, Polyline, Smooth, Straight, bouc_wen\n"),
        ("LAWS: dict[", "SOFTENING = Smooth(lambda deficit: deficit)\n\nLAWS: dict["),
        *([('"backbone"]', '"backbone", "softening"]')] if literal else []),
    )


def python(place, script):
    return subprocess.run(
        [sys.executable, "-c", script], cwd=place,
        env=os.environ | {"PYTHONPATH": str(place), "HOME": str(place), "NUMBA_DISABLE_JIT": "1"},
        text=True, capture_output=True, check=False,
    )  # fmt: skip


@pytest.mark.slow
def test_a_law_is_added_by_two_records(copied):
    """Of s = 1 − z first loading is z = 1 − exp(−x), so that the static state and what is released follow in closed form."""
    add(copied)
    done = python(copied, SCRIPT)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)

    soft = 2.5 * 9.81 / 30.0**2  # δ_y
    settled = -soft * math.log(1.0 - 1.0 / 2.5)
    assert found["settled"] == pytest.approx(settled, rel=1e-12)
    assert found["at rest"] == pytest.approx([-settled, -1.0 / 2.5], rel=1e-12)
    depth, force = found["held"]
    assert force == pytest.approx(math.exp(depth / soft) - 1.0, rel=1e-9)
    assert found["remainder"] < 1e-4 * found["plastic"]
    assert found["plastic"] == pytest.approx(found["dissipated"], rel=1e-4)
    assert (found["creeps"], found["other"]) == (True, "epp")
    assert '"softening", softer in proportion to its force' in found["help"]


@pytest.mark.parametrize(
    "lacks",
    [
        "stiffness_loss=softening_loss, ",
        *(pytest.param(each, marks=pytest.mark.slow) for each in ("remembers=0.0,", "yields_when_pressed=1.0, ")),
    ],
)
def test_a_law_without_an_entry_in_the_core_stops_the_import(copied, lacks):
    add(copied, core=CORE.replace(lacks, ""))
    done = python(copied, "import rockbatch; rockbatch.simulate")
    assert f"missing 1 required positional argument: '{lacks.split('=')[0]}'" in done.stderr


@pytest.mark.parametrize(
    "lacks", ["first_loading=lambda n, points: SOFTENING,", 'creep=Creep(exponent=lambda n: 1.0, other="epp"),']
)
def test_a_law_without_an_entry_for_statics_or_releases_stops_the_import(copied, lacks):
    add(copied, of_pier=PIER.replace(lacks, ""))
    done = python(copied, "import rockbatch; rockbatch.Pier")
    assert f"missing 1 required positional argument: '{lacks.split('=')[0]}'" in done.stderr


@pytest.mark.slow
def test_a_law_in_one_table_only_stops_the_import(copied):
    end = '}\n"""All laws'
    add(copied, of_pier=end)
    done = python(copied, "import rockbatch; rockbatch.simulate")
    assert "softening" in done.stderr.splitlines()[-1]
    assert done.returncode != 0


def test_a_law_in_the_core_only_stops_the_import_of_the_models(copied):
    add(copied, of_pier='}\n"""All laws', literal=False)
    done = python(copied, "import rockbatch; rockbatch.simulate")
    assert done.stderr.splitlines()[-1].endswith("core/springs/laws.py and pier/laws.py only: softening")
