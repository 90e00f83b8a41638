"""Plastic work of the springs, branch by branch, from the start of each spring's present branch."""

from typing import NamedTuple

from rockbatch.core.kernel import kernel
from rockbatch.core.springs.equations import geometry
from rockbatch.core.springs.laws import plastic_work


class Loading(NamedTuple):
    """Start of each spring's present branch: unstressed position [m] and z; and the plastic work/F_y so far [m]."""

    left: float
    z_left: float
    work_left: float
    right: float
    z_right: float
    work_right: float


class BranchChange(NamedTuple):
    """Unstressed positions [m] and z of both springs at a change of their branches."""

    unstressed_left: float
    unstressed_right: float
    z_left: float
    z_right: float


class Branch(NamedTuple):
    """Unstressed position [m] and z of a spring at the start of its branch, and its plastic work/F_y so far [m]."""

    unstressed: float
    z: float
    work: float


@kernel
def _branch(m, was, now, begun, unstressed, z):
    """Return the Branch after an event at ``z``: ``begun``, the present one, if ``was`` equals ``now``, else a new one.

    The plastic work of an inelastic branch that has ended is added.
    """
    if was == now:
        return begun
    work = begun.work
    if was != 0.0:
        work += plastic_work(m, begun.z, z, begun.unstressed - unstressed)
    return Branch(unstressed, z, work)


@kernel
def branches(m, loading, before, after, at):
    """Return the Loading of both springs after a change of the contacts from ``before`` to ``after``.

    ``at`` is a BranchChange: unstressed positions [m] and z at the change.
    """
    left = Branch(loading.left, loading.z_left, loading.work_left)
    left = _branch(m, before.left_yields, after.left_yields, left, at.unstressed_left, at.z_left)
    right = Branch(loading.right, loading.z_right, loading.work_right)
    right = _branch(m, before.right_yields, after.right_yields, right, at.unstressed_right, at.z_right)
    return Loading(left.unstressed, left.z, left.work, right.unstressed, right.z, right.work)


@kernel
def branch_change(m, y):
    """Return unstressed positions and z of both springs in state ``y``, as a BranchChange."""
    at, soft = geometry(m, y.theta), m.yield_deflection
    left, right = y.v + at.lift_left - soft * y.z_left, y.v + at.lift_right - soft * y.z_right
    return BranchChange(left, right, y.z_left, y.z_right)
