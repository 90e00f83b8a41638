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


@kernel
def _branch(m, was, now, begun, z_begun, place, z, work):
    """Start of a spring's branch and its plastic work, brought up to an event at position ``place`` and ``z``."""
    if was == now:
        return begun, z_begun, work
    unstressed = place - m.yield_deflection * z
    return _closed(m, begun, z_begun, work, unstressed, z) if was != 0.0 else (unstressed, z, work)


@kernel
def _closed(m, begun, z_begun, work, unstressed, z):
    """Return the same, at the end of an inelastic branch, in a spring that is unstressed at ``unstressed`` from then on."""
    work += plastic_work(m, z_begun, z, begun - unstressed)
    return unstressed, z, work


@kernel
def branches(m, loading, before, after, y):
    """Return the Loading of both springs, brought up to an event that changed the contacts from ``before`` to ``after``."""
    at = geometry(m, y.theta)
    left, z_left, work_left = _branch(
        m, before.left_yields, after.left_yields,
        loading.left, loading.z_left, y.v + at.lift_left, y.z_left, loading.work_left,
    )  # fmt: skip
    right, z_right, work_right = _branch(
        m, before.right_yields, after.right_yields,
        loading.right, loading.z_right, y.v + at.lift_right, y.z_right, loading.work_right,
    )  # fmt: skip
    return Loading(left, z_left, work_left, right, z_right, work_right)


@kernel
def close_left(m, loading, unstressed, z):
    """Return the Loading once the left spring has left its inelastic branch at ``z``, then unstressed at ``unstressed``."""
    left, z_left, work_left = _closed(m, loading.left, loading.z_left, loading.work_left, unstressed, z)
    return Loading(left, z_left, work_left, loading.right, loading.z_right, loading.work_right)


@kernel
def close_right(m, loading, unstressed, z):
    """Do the same for the right spring."""
    right, z_right, work_right = _closed(m, loading.right, loading.z_right, loading.work_right, unstressed, z)
    return Loading(loading.left, loading.z_left, loading.work_left, right, z_right, work_right)
