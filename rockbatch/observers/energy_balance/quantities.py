"""Terms of the energy balance."""

from rockbatch.quantities.quantity import Quantity, ReportFormat, Run


def _energy(term: str, form: str = ".4f") -> Quantity:
    """Return a term of the energy ledger."""

    def value(run: Run) -> float | None:
        return None if run.outcome.energies is None else run.outcome.energies[term]

    words = "energy ledger at the end, per unit mass, and the greatest remainder on the way"
    page = ReportFormat(f"{term.replace('_', '-')} [J/kg]", form)
    return Quantity(f"energy_{term}_J_kg", words, value, "J/kg", page, needs="ledger")


QUANTITIES = (
    _energy("kinetic"), _energy("potential"), _energy("elastic"), _energy("input"), _energy("plastic"), _energy("impact"),
    _energy("p_delta"), _energy("constraint"), _energy("damping"), _energy("remainder", ".0e"),
)  # fmt: skip
