"""The energy balance is read from every step of a run."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rockbatch.common.lazy import pd
from rockbatch.core import types
from rockbatch.core.observe.beds import ledger_on_footing
from rockbatch.core.observe.ledger import LEDGER, ledger_on_rigid_base, ledger_on_springs
from rockbatch.motions.motion import Samples
from rockbatch.observers.energy_balance.study import Ledger
from rockbatch.outcome.outcome import TERMS, Outcome
from rockbatch.pier import FootingBase
from rockbatch.simulation import restraints
from rockbatch.simulation.models import ground_of, model, springs
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.recording import Recording
from rockbatch.simulation.runs import Run
from rockbatch.study import Output


@dataclass(frozen=True)
class EnergyBalance(Observer):
    """The energy balance at the end of a run, with the greatest remainder on the way; no error."""

    most_steps = 1_000_000
    """Each step is recorded, 100 bytes, and its energies beside it."""
    column = "energy_input_J_kg"
    histories_of_steps = True

    def claims_error(self, outcome: Outcome) -> bool:
        """Return False: its remainder tells the error."""
        return False

    def read(self, recording: Recording, outcome: Outcome) -> dict[str, float]:
        """Return each term at the end by its name, but of the remainder the greatest magnitude on the way."""
        terms = energies(recording.run, recording.rows)
        at_end = dict(zip(TERMS, map(float, terms[-1]), strict=True))
        return at_end | {"remainder": float(abs(terms[:, -1]).max())}

    def add(self, run: Run, outcome: Outcome, fine: dict[str, float] | None, coarse: None) -> Outcome:
        """Return ``outcome`` with the terms ``fine``, unchanged if they are None."""
        return outcome if fine is None else outcome.with_observed("energy_balance", fine)

    def histories(self, recording: Recording) -> "Mapping[str, pd.DataFrame]":
        """Return the terms at samples, events and the end as the table ``ledger``."""
        rows = recording.rows
        shown = rows.kind != types.STEP
        shown[-1] = True  # an overturned pier may fall between samples
        table = pd.DataFrame(energies(recording.run, rows)[shown], columns=list(TERMS))
        table.insert(0, "t", rows.t[shown])
        return {"ledger": table}


def energies(run: Run, rows: np.recarray) -> Samples:
    """Return the energy balance [J/kg] at every row of a run: :data:`rockbatch.outcome.outcome.TERMS`, shape (n, 10)."""
    pier, base = run.pier, run.base
    ground, dt = ground_of(run.motion), float(run.motion.dt)
    terms = np.zeros((len(rows), len(TERMS)))
    balance = terms.view(LEDGER)[:, 0].view(np.recarray)  # the same memory, by names
    plain, pulls = restraints.apart(base, rows)
    if isinstance(base, FootingBase):
        ledger_on_footing(model(pier, base), plain, pulls, ground, dt, balance)
    elif base.on_springs:
        ledger_on_springs(springs(pier, base), plain, pulls, ground, dt, balance)
    else:
        ledger_on_rigid_base(model(pier, base), plain, pulls, ground, dt, balance)
    return restraints.with_devices(pier, base, rows, terms) if base.restraints else terms


def requested(output: Output) -> EnergyBalance | None:
    """Return the observer if [output] of a study asks for it, else None."""
    return EnergyBalance() if output.of(Ledger).ledger else None
