"""Plane frames of OpenSees on springs without tension: their materials, their weight, and the motion of the ground."""

from collections.abc import Mapping

import numpy as np
import openseespy.opensees as ops

BEAM = 1
"""Corotational beams, by the number of their transformation."""


def begin() -> None:
    """Begin an empty plane model."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.geomTransf("Corotational", BEAM)


def without_tension(tag: int, stiffness: float, strength: float | None = None) -> None:
    """Define a material of this ``stiffness`` in compression that yields at its ``strength``, if given, with accumulating gap.

    A spring of 10⁻⁷ of that beside it keeps the first tangent from being singular.
    """
    if strength is None:
        ops.uniaxialMaterial("ENT", tag + 1, stiffness)
    else:
        ops.uniaxialMaterial("ElasticPPGap", tag + 1, stiffness, -strength, 0.0, 0.0, "damage")
    ops.uniaxialMaterial("Elastic", tag + 2, 1e-7 * stiffness)
    ops.uniaxialMaterial("Parallel", tag, tag + 1, tag + 2)


def solve(integrator: str, *parameters: float, within: float) -> None:
    """Choose how each step is solved: until displacements change by less than ``within``."""
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", within, 50)
    ops.algorithm("Newton")
    ops.integrator(integrator, *parameters)


def come_to_rest(weights: Mapping[int, float], within: float) -> None:
    """Let the ``weights`` at nodes act, in ten steps."""
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    for node, weight in weights.items():
        ops.load(node, 0.0, -weight, 0.0)
    solve("LoadControl", 0.1, within=within)
    ops.analysis("Static")
    assert ops.analyze(10) == 0
    ops.loadConst("-time", 0.0)
    ops.wipeAnalysis()


def shake(dt: float, horizontal: np.ndarray, vertical: np.ndarray | None = None) -> None:
    """Move the ground by accelerations [m/s²], sampled at ``dt`` [s]."""
    for direction, acceleration in enumerate((horizontal, vertical), start=1):
        if acceleration is not None:
            ops.timeSeries("Path", 1 + direction, "-dt", dt, "-values", *acceleration.tolist())
            ops.pattern("UniformExcitation", 1 + direction, direction, "-accel", 1 + direction)
