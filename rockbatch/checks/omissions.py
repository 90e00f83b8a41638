"""Omissions of a force: landings on rigid ground, the modes of a shaft, its bending (THEORY.md, Forces)."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import (
    Case,
    bends,
    has_light_shaft,
    is_frame,
    lands_by_impulse,
    stops_by_impulse,
)
from rockbatch.quantities.demands import Demand

MODES, LANDINGS, LANDINGS_OF_FRAME = "modes", "landings", "landings of a frame"
IMPULSES, BENDING = "impulses", "bending"

FACTORS = "1.6 to 2.9"
"""Base shear by twenty finite elements over that of a rigid shaft: of one with twice the mass of its top (THEORY.md, Forces)."""


class Omission(NamedTuple):
    """Remark on an omission; ``decides`` is False if the demand without the omitted part has no upper bound."""

    remark: str
    decides: bool = True


_LANDINGS = "landings are left out, which on rigid ground are impulses without a force"

OMISSIONS = {
    MODES: Omission(
        f"forces of a single mode bound nothing: a heavy shaft had {FACTORS} times its rigid base shear by finite elements, 1.1 "
        "times by one mode, so take them from a program with beam elements",
        decides=False,
    ),
    LANDINGS: Omission(
        f'{_LANDINGS}: give the feet a stiffness K, base = "elastic" with zeta, and check K/2, K and 2 K', decides=False
    ),
    LANDINGS_OF_FRAME: Omission(
        f"{_LANDINGS}: take them from a program with springs under the columns, which a frame cannot have here",
        decides=False,
    ),
    IMPULSES: Omission(
        "the part of each landing that epsilon stops by an impulse is left out, to which zeta gives a force"
    ),
    BENDING: Omission(
        f"bending of the shaft is left out, with which a heavy one had {FACTORS} times its rigid base shear by finite elements"
    ),
}
"""Omissions by the names that checks.csv has for them, the gravest first."""


def open_landings(demand: Demand, runs: Rows, case: Case) -> npt.NDArray[np.bool_]:
    """Return True for each run of which landings by impulse are missing in the demand, shape (n,): a lower bound.

    A run without impacts, whose pier never lifted off or never came back, misses none.
    """
    if not (demand.landing and lands_by_impulse(case)):
        return np.zeros(len(runs), dtype=bool)
    return runs.numbers("impacts") != 0.0


def omissions(demand: Demand, runs: Rows, case: Case) -> list[str]:
    """Return the names in :data:`OMISSIONS` of the parts that the demand leaves out in these runs of a case."""
    if demand.landing and bends(case):
        return [MODES]
    omitted = []
    if open_landings(demand, runs, case).any():
        omitted.append(LANDINGS_OF_FRAME if is_frame(case) else LANDINGS)
    if demand.landing and stops_by_impulse(case) and (runs.numbers("impacts") > 0.0).any():
        omitted.append(IMPULSES)
    if demand.bending and not has_light_shaft(case):
        omitted.append(BENDING)
    return omitted
