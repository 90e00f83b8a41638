"""The demand of axial force and moment on the capacity of a section, which is no column of peaks.csv."""

from rockbatch.quantities.demands import Demand, largest

DEMANDS = (
    Demand(
        "section_moment_over_capacity",
        "greatest moment in a section of the shaft over its capacity at the axial force of the same moment",
        largest(("over_capacity",), error="over_capacity_error"),
        needs="interaction",
        weighed=True,
        landing=True,
        bending=True,
    ),
)
