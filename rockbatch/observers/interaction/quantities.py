"""Demands over a capacity that depends on the axial force of the same moment, which are no columns of peaks.csv."""

from rockbatch.quantities.demands import OF_BASE, Demand, largest

_SHARE = largest(("over_capacity",), error="over_capacity_error")

DEMANDS = (
    Demand(
        "section_moment_over_capacity",
        "greatest moment in a section of the shaft over its capacity at the axial force of the same moment",
        _SHARE,
        needs="interaction",
        weighed=True,
        landing=True,
        bending=True,
        over_capacity=True,
    ),
    Demand(
        "base_shear_over_capacity",
        "greatest shear of the base over its capacity at the normal force of the same moment",
        _SHARE,
        needs=OF_BASE,
        weighed=True,
        landing=True,
        bending=True,
        directed=True,
        over_capacity=True,
    ),
)
