"""Bases that the tests of stops, deck springs and braces share, and a block thrown against these."""

import math
from dataclasses import replace

import numpy as np
import pytest
from core_samples import pulse

from rockbatch.core.block import lanes
from rockbatch.core.devices.lanes import equipment_of
from rockbatch.core.history import MOMENT
from rockbatch.core.run import march
from rockbatch.pier import ElasticBase, RigidBase, YieldingBase
from rockbatch.simulation.elements import elements
from rockbatch.simulation.models import block

ELASTIC = ElasticBase(50.0, epsilon=0.3)
BOUC_WEN = YieldingBase(50.0, epsilon=0.3, eta=3.0)
FINITE = YieldingBase(60.0, eta=3.5, spring="epp", zeta=0.1, kinematics="finite", flight="guided")
BASES = [
    pytest.param(RigidBase(), id="rigid"),
    pytest.param(ELASTIC, id="elastic"),
    pytest.param(BOUC_WEN, id="bouc-wen"),
    pytest.param(FINITE, id="finite"),
]
RANDOM_BASES = [BASES[0], pytest.param(ELASTIC, id="elastic", marks=pytest.mark.slow), BASES[2]]


def crossed(bases, devices, on_all, *, wholly=False, once=""):
    """Return parameters of every base with every one of the named ``devices``.

    Fast tests have all of them on rigid ground, but the one named ``once``, of many steps, and on Bouc–Wen springs those named
    ``on_all``, or all if ``wholly``. Slow ones have the rest there, and ``on_all`` on every other base; thorough ones all.
    """
    parameters = []
    for base in bases:
        for name, each in devices.items():
            common = base.id == "bouc-wen" or (base.id == "rigid" and name != once)
            fast = common and (base.id == "rigid" or wholly or name == on_all)
            marks = () if fast else (pytest.mark.slow,) if common or name == on_all else pytest.mark.thorough
            parameters.append(pytest.param(*base.values, each, id=f"{base.id}-{name}", marks=marks))
    return parameters


SHAKEN = pulse("sine", 0.5, 1.0, end=3.0)


def stiffness(pier, ratio):
    """k over the mass [1/s²] of a device of the dimensionless stiffness ``ratio``."""
    return ratio * pier.gravity * pier.size / pier.half_width**2


def stopped(base, stops):
    return replace(base, restraints=stops)


def thrown(pier, base, omega, dt=2e-3, samples=700, substeps=8):
    """Rows of a block on still ground that leaves θ = 0 at the velocity ``omega``, and the use of its devices."""
    m, ground = block(pier, base), np.zeros((samples, 4))
    kind, line = lanes.system_of(m), lanes.line_of(m, 0.0, omega, dt, substeps, 0, 0, samples, 0)
    devices = equipment_of(kind, [(elements(pier, base), (), math.nan)])
    history = np.zeros((80_000, len(MOMENT) + len(kind.columns) + devices.x.shape[1] + 2))
    flag = np.zeros(1, np.uint8)
    result = march(kind, [line], ground, flag, substeps, every_step=True, history=history[None], devices=devices)[0]
    names = [*MOMENT, *kind.columns]
    return np.rec.fromarrays(history[: result.rows, : len(names)].T, names=names), devices.use[0]
