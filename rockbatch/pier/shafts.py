"""Shafts of piers on bases that let them bend."""

from dataclasses import dataclass, field, fields

import numpy as np
import numpy.typing as npt

from rockbatch.pier.bending import MOST_MODES, Modes, modes_of
from rockbatch.pier.block import Pier
from rockbatch.pier.traits import FlexuralDamping, Shaft, Traits


@dataclass(frozen=True)
class WithShaft(Traits):
    """A base whose pier may bend."""

    shaft: Shaft = field(default="rigid", kw_only=True)
    flexural_damping: float = field(default=0.05, kw_only=True)
    flexural_damping_kind: FlexuralDamping = field(default="modal", kw_only=True)
    flexural_modes: int | None = field(default=None, kw_only=True)

    @property
    def bends(self) -> bool:  # type: ignore[override]
        """Return True if the shaft is elastic."""
        return self.shaft == "elastic"

    def modes(self, pier: Pier) -> Modes:
        """Return the modes of an elastic shaft that a run follows: ``flexural_modes``, 4 by default, or all if it has fewer."""
        return modes_of(pier, self.flexural_modes or MOST_MODES)

    def damping_ratios(self, pier: Pier) -> npt.NDArray[np.float64]:
        """Return ζ_i of these modes, shape (n,): equal ("modal"), or in proportion to their frequencies ("stiffness")."""
        frequency = self.modes(pier).frequency
        of_first = 1.0 if self.flexural_damping_kind == "modal" else frequency / frequency[0]
        return self.flexural_damping * of_first * np.ones(len(frequency))

    def leaning_height(self, pier: Pier) -> float:
        """Return the height [m] at which the weight of ``pier`` turns it as it leans at rest, above h if its shaft hangs over."""
        return pier.height + self.overhang(pier) if self.bends else pier.height

    def overhang(self, pier: Pier) -> float:
        """Return how far the weight hangs over the axis of an elastic shaft that leans at rest, over sin θ [m]: g Σ μ²/ω²."""
        modes = self.modes(pier)
        return pier.gravity * float(((modes.share / modes.frequency) ** 2).sum())

    def of_shaft(self, pier: Pier) -> dict[str, object]:
        """Return the shaft of ``pier`` by the keys of run.json; empty if it is rigid."""
        if not self.bends:
            return {}
        return {name: getattr(self, name) for name in OF_SHAFT} | {"flexural_modes": len(self.modes(pier).frequency)}


OF_SHAFT = tuple(field.name for field in fields(WithShaft))
"""Keys of the shaft, of every base and in studies."""
