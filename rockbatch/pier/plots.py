"""The figure of a statics sheet. Loads matplotlib: imported where it is drawn."""

from matplotlib.figure import Figure

from rockbatch.common.figures import figure, line, styled
from rockbatch.pier.block import Pier
from rockbatch.pier.equilibrium import Equilibria
from rockbatch.pier.free_rocking import Swings


@styled
def statics(pier: Pier, equilibria: Equilibria, swings: Swings, width_mm: float) -> Figure:
    """See :meth:`rockbatch.pier.statics.Statics.plot`."""
    alpha = pier.alpha
    wide = width_mm >= 120.0
    drawn = figure(width_mm, 62.0 if wide else 118.0)
    left, right = drawn.subplots(1, 2) if wide else drawn.subplots(2, 1)
    size, unit = (
        (1.0, "moment/weight [m]") if pier.mass_t is None else (1e-3 * pier.mass_t * pier.gravity, "moment [MN m]")
    )
    shares = {
        "weight and supports": equilibria.weight,
        "tendons": equilibria.tendons,
        "stops, deck springs": equilibria.stops,
        "dampers": equilibria.dampers,
    }
    shown = {name: values for name, values in shares.items() if values.any()}
    for place, (name, values) in enumerate({"all": equilibria.moment, **(shown if len(shown) > 1 else {})}.items()):
        left.plot(equilibria.theta / alpha, size * values, label=name, **line(place))
    left.set(xlabel=r"$\theta/\alpha$", ylabel=unit, title="righting moment", xlim=(0.0, None), ylim=(0.0, None))
    if len(shown) > 1:
        left.legend()
    right.plot(swings.amplitude / alpha, swings.period, marker="o", **line(0))
    if pier.flexural_period_s is not None:
        right.axhline(pier.flexural_period_s, label="fixed at its base", **line(1))
        right.legend()
    right.set(
        xlabel=r"amplitude$/\alpha$", ylabel="period [s]", title="free rocking", xlim=(0.0, 1.0), ylim=(0.0, None)
    )
    return drawn
