"""Limits of quantities that several parts of the catalogue share, and names of columns that these read."""

from rockbatch.quantities.cases import THOUSAND, Lever, product, width
from rockbatch.quantities.demands import Ceiling, largest
from rockbatch.quantities.quantity import Limit

IN_MOTION, IN_MOTION_ERROR = "theta_max_in_motion_over_alpha", "theta_max_in_motion_error"
"""Columns of the peak until a motion ends, which a run that failed later has reached, and of its error."""

OVERTURNS = "is past the edge of overturning"
WIDER = Ceiling(width, "is more than the pier is wide")
_IN_MM = Limit(unit="mm", times=THOUSAND, ceiling=Ceiling(product(THOUSAND, width), WIDER.beyond))
LENGTHS = (Limit(ceiling=WIDER), _IN_MM)


def rotation(of: str, name: str, unit: str, times: Lever, words: str = "") -> Limit:
    """Return a limit on |θ|/α times a factor, from the columns OF_over_alpha and OF_error.

    Only that on ``theta_max`` is looked up in a motion, too.
    """
    reached = largest((IN_MOTION,), times, IN_MOTION_ERROR) if of == "theta_max" else None
    evaluate = largest((f"{of}_over_alpha",), times, f"{of}_error")
    return Limit(name, unit, times, Ceiling(times, OVERTURNS), words, evaluate=evaluate, reached=reached)


def greater(name: str, words: str, *limits: Limit) -> tuple[Limit, ...]:
    """Return limits on the greater of two columns, left and right: "ductility" stands for ductility_left and ductility_right.

    In ``name``, "/" is the place of "_left" and "_right", which the limit's name lacks; by default they are at its end. In
    ``words``, "{}" becomes "a". Without ``limits`` there is one, in the unit of the columns.
    """
    stem, _, ending = name.partition("/")
    columns = (f"{stem}_left{ending}", f"{stem}_right{ending}")
    return tuple(
        limit._replace(
            name=f"{stem}_{limit.unit}" if limit.unit else stem + ending, words=words.format("a"), columns=columns
        )
        for limit in limits or (Limit(),)
    )
