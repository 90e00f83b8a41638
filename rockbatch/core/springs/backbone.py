"""A spring's backbone: the concave polyline that its force follows in compression, as corners and slopes (THEORY.md, A backbone).

Beyond a corner the spring is on the inelastic branch of that corner's number, 1 to MOST_CORNERS; 0 is the elastic one.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from rockbatch.core.kernel import hook, inlined, optional_hook
from rockbatch.core.table import get, put, taken

MOST_CORNERS = 8
"""Corners that a backbone may have."""

MOST_FORCE = 1e30
"""A force/F_y beyond all corners."""

_CORNERS = tuple(range(1, MOST_CORNERS + 1))

NUMBERS = (
    *(
        (f"force_{corner}", float) for corner in _CORNERS
    ),  # at each corner, over F_y, that at the first; inf for those it lacks
    *((f"loss_{corner}", float) for corner in _CORNERS),  # share of the elastic stiffness lost beyond each corner
)

Backbone = NamedTuple("Backbone", NUMBERS)  # type: ignore[misc]
"""Corners of a backbone."""

LIKE = Backbone(*[0.0] * len(NUMBERS))
"""Trait of all piers whose springs have a backbone: its value does not matter."""


def backbone_of(forces: Sequence[float], losses: Sequence[float]) -> Backbone:
    """Return the Backbone with corners at ``forces``/F_y, beyond which it has lost the shares ``losses`` of its stiffness."""
    lacking = MOST_CORNERS - len(forces)
    return Backbone(*map(float, forces), *[math.inf] * lacking, *map(float, losses), *[float(losses[-1])] * lacking)


@hook
def backbone_in(backbone, lanes, i):
    """Return the Backbone of lane ``i``, of the type of ``backbone`` in the traits; None if its springs have none."""


@backbone_in.of(type(None))
def _no_backbone(backbone, lanes, i):
    return None


@backbone_in.of(Backbone)
def _backbone_of_lane(backbone, lanes, i):
    return get(lanes.backbone, i, Backbone)


@optional_hook
def begin_backbone(backbone, lanes, i, run):
    """Set the backbone of a ``run`` in lane ``i``; nothing if its springs have none."""


@begin_backbone.of(Backbone)
def _begin_backbone(backbone, lanes, i, run):
    put(lanes.backbone, i, taken(run, Backbone))


@inlined
def loss_on(backbone, branch):
    """Return the share of the elastic stiffness that is lost on an inelastic ``branch``, by its number."""
    loss = backbone[MOST_CORNERS]
    for corner in range(1, MOST_CORNERS):
        loss = backbone[MOST_CORNERS + corner] if branch > corner else loss
    return loss


@optional_hook
def branch_at(backbone, force):
    """Return the branch of first loading at a ``force``/F_y: how many corners it has reached; by default 1."""
    return 1.0


@branch_at.of(Backbone)
def _branch_of_backbone(backbone, force):
    branch = 0.0
    for corner in range(MOST_CORNERS):
        branch += 1.0 if force >= backbone[corner] else 0.0
    return branch


@optional_hook
def corner_beyond(backbone, branch):
    """Return the force/F_y at the corner with which a ``branch`` ends; by default, and for the last one, infinity."""
    return math.inf


@corner_beyond.of(Backbone)
def _corner_of_backbone(backbone, branch):
    force = math.inf
    for corner in range(MOST_CORNERS):
        force = backbone[corner] if branch == corner else force
    return force


@optional_hook
def give_at(backbone):
    """Return the place, 0 to 1, in a small part of a loading whose compliance stands for all of it; by default the middle."""
    return 0.5


@give_at.of(Backbone)
def _give_at_end(backbone):
    # Where it is greatest, so that the energy to turn a pier is bounded below; short of a corner at the end
    return 1.0 - 1e-9


@optional_hook
def greatest(backbone):
    """Return the greatest force/F_y; by default 1."""
    return 1.0


@greatest.of(Backbone)
def _greatest_of_backbone(backbone):
    last = branch_at(backbone, MOST_FORCE)
    return corner_beyond(backbone, last - 1.0) if loss_on(backbone, last) == 1.0 else math.inf
