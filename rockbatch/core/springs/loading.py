"""The plastic work of the springs, branch by branch: runs keep only where each spring's present branch began."""

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
    """Unstressed positions [m] and z of both springs where they change their branches."""

    unstressed_left: float
    unstressed_right: float
    z_left: float
    z_right: float


@kernel
def _branch(m, was, now, begun, z_begun, unstressed, z, work):
    """Return the start of a spring's branch and its plastic work, brought up to an event at ``z``, ``unstressed`` there then."""
    if was == now:
        return begun, z_begun, work
    if was != 0.0:
        work += plastic_work(m, z_begun, z, begun - unstressed)
    return unstressed, z, work


@kernel
def branches(m, loading, before, after, at):
    """Return the Loading of both springs, brought up to a change of the contacts from ``before`` to ``after``.

    ``at`` has unstressed positions [m] and z of both springs at the change of each (BranchChange).
    """
    left, z_left, work_left = _branch(
        m, before.left_yields, after.left_yields,
        loading.left, loading.z_left, at.unstressed_left, at.z_left, loading.work_left,
    )  # fmt: skip
    right, z_right, work_right = _branch(
        m, before.right_yields, after.right_yields,
        loading.right, loading.z_right, at.unstressed_right, at.z_right, loading.work_right,
    )  # fmt: skip
    return Loading(left, z_left, work_left, right, z_right, work_right)


@kernel
def branch_change(m, y):
    """Return the BranchChange of springs that change their branches in state ``y``."""
    at, soft = geometry(m, y.theta), m.yield_deflection
    left, right = y.v + at.lift_left - soft * y.z_left, y.v + at.lift_right - soft * y.z_right
    return BranchChange(left, right, y.z_left, y.z_right)
