"""Terms of the energy balance."""

from rockbatch.outcome.outcome import TERMS
from rockbatch.quantities.quantity import Quantity, ReportFormat, Run


def _energy(term: str, form: str) -> Quantity:
    """Return the quantity of a term of the energy balance at the end of a run; of the remainder the greatest on the way."""

    def value(run: Run) -> float | None:
        energies = run.outcome.observed.get("energy_balance")
        return None if energies is None else energies[term]

    words = "energy ledger at the end, per unit mass, and the greatest remainder during the run"
    page = ReportFormat(f"{term.replace('_', '-')}", form)
    return Quantity(f"energy_{term}_J_kg", words, value, "J/kg", page, needs="ledger")


QUANTITIES = tuple(_energy(term, ".0e" if term == "remainder" else ".4f") for term in TERMS)
