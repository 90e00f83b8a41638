"""Supports of a study that a wrong unit explains better than the ground: refused until they are confirmed.

The ratios beta and eta have no unit and are not judged: their limits, too, are something to study.
"""

from collections.abc import Collection

from rockbatch.errors import remedy
from rockbatch.pier import MOST_ETA, Base, Pier, eta_of, static_deflection
from rockbatch.study.lists import Chosen
from rockbatch.toml.reader import Table

LEAST_DEFLECTION = 2e-5
"""Static deflection [m] of supports below which a wrong unit is likelier than the ground: on sound rock it is some 0.1 mm."""


def complain_unless_usual_support(
    table: Table, chosen: Chosen, pier: Pier, base: Base, believed: Collection[str]
) -> None:
    """Note a stiffness and a yield force that no support has under this pier, unless they are confirmed."""
    name = "stiffness_kN_m"
    deflection = static_deflection(pier, base)
    if name in chosen and name not in believed and deflection < LEAST_DEFLECTION:
        message = f"{name} = {chosen[name].value:g}: the pier's weight presses the supports in by {1000 * deflection:.2g} mm only"
        table.complain_about(
            chosen[name], f"{message}, where sound rock gives some 0.1 mm; {remedy(name)} in this table"
        )
    name = "yield_kN"
    if name in chosen and name not in believed and (eta := eta_of(pier, chosen[name].value)) > MOST_ETA:
        message = f"{name} = {chosen[name].value:g}: {eta:.3g} times what the support carries at rest"
        table.complain_about(chosen[name], f"{message}, where 2 to 20 times is usual; {remedy(name)} in this table")
