"""A row of the table, as a whole, of springs of many kinds against the reference solver: peaks, end, energies, forces, devices.

The core runs without the compiler, for half a second to a second: each of these would need a kernel of its own.
"""

import numpy as np
import pytest
from core_samples import FIG5, broadband, pulse
from reference_forces import WithForces

import rockbatch as rb
from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, DeckSpring, ElasticBase, Stop, Tendon, YieldingBase

DT, STEPS = 0.02, 4
FREE = {
    "elastic": ElasticBase(50, 0.3, flight="guided"),
    "bouc-wen": YieldingBase(50, 0.1, flight="guided", eta=2.2),
    "epp": YieldingBase(40, 0.3, flight="guided", eta=1.5, spring="epp"),
    "hardening": YieldingBase(50, 0.1, flight="guided", eta=1.5, spring="hardening"),
    "damped": YieldingBase(50, flight="guided", zeta=0.1, eta=2.2, n=2.0),
    "finite": YieldingBase(50, 0.1, "finite", "guided", eta=3.0),
    "finite, any n": YieldingBase(40, 0.3, "finite", "guided", eta=1.5, spring="hardening", n=2.5),
    "finite, damped": ElasticBase(50, kinematics="finite", flight="guided", zeta=0.05),
}
TIED = {
    "deck spring and braces": YieldingBase(
        50, 0.3, flight="guided", eta=3.0,
        restraints=(
            DeckSpring(0.2),
            Damper("viscous", nu=0.3, brace=2.0, at="deck"),
            Damper("hysteretic", f=0.05, yield_m=0.005, at=0.3, brace=3.0),
        ),
    ),
    "finite, a tendon yields": ElasticBase(
        50, 0.3, "finite", "guided",
        restraints=(Damper("hysteretic", f=0.1, yield_m=0.005, at=0.5), Tendon(psi=0.1, lam=1.0, strength=0.13)),
    ),
    "finite, stops": ElasticBase(
        50, 0.3, "finite", "guided", restraints=(Stop(0.03, 2.0, 0.5), DeckSpring(0.3, 0.02, 0.6, "right"))
    ),
    "finite, damped, friction": YieldingBase(
        60.0, eta=3.5, spring="epp", zeta=0.1, kinematics="finite", flight="guided",
        restraints=(
            Damper("friction", f=0.06), Damper("hysteretic", f=0.05, yield_m=0.005, at=0.2), Tendon(psi=0.1, lam=0.5)
        ),
    ),
}  # fmt: skip


def shaken(end: float) -> Motion:
    horizontal = pulse("sine", 0.5, dt=DT, end=end).horizontal
    return Motion("shaken", DT, horizontal, broadband(np.random.default_rng(0), DT, len(horizontal), 12.0))


class Observed(WithForces):
    """``most``: greatest force, stroke and speed of each device, and the work that it has taken."""

    def __init__(self, base, motion):
        super().__init__(FIG5, base, motion, 0.0)
        self.base = base
        self.most, self.work, self.last = np.zeros((len(self.elements), 3)), np.zeros(len(self.elements)), None

    def _look(self, t, y):
        super()._look(t, y)
        now = np.array([(self.pull(j, y), self.elongation(j, y), self.speed(j, y)) for j in range(len(self.elements))])
        if len(now):
            self.most = np.maximum(self.most, np.abs(now))
        if len(now) and self.last is not None:
            t_last, power = self.last
            self.work += 0.5 * (t - t_last) * (power + now[:, 0] * now[:, 2])
        self.last = (t, now[:, 0] * now[:, 2]) if len(now) else None

    def of(self, kinds):
        """Return the numbers of the devices of these classes."""
        return [j for j, (device, _) in enumerate(self.elements) if isinstance(device, kinds)]


def peaks(solver, run):
    """Return what a row has for the outcome of the reference, by its columns."""
    pier, base, g = FIG5, solver.base, FIG5.gravity
    columns = {
        "theta_max_over_alpha": run.theta_max / pier.alpha,
        "t_max_s": run.t_max,
        "impacts": run.impacts,
        "separations": run.separations,
        "flight_s": run.t_flight,
        "friction_demand": solver.greatest["friction_demand"],
        "key_shear_m_s2": solver.greatest["key_shear"] or None,
    }
    forces = ("base_shear", "normal_force", "deck_acceleration")
    columns |= {f"{name}_m_s2": solver.greatest[name] for name in forces}
    for side in ("left", "right"):
        columns[f"pivot_force_{side}"] = solver.greatest[f"pivot_{side}"]
        columns[f"heel_gap_{side}_m"] = solver.greatest[f"heel_gap_{side}"]
        columns[f"heel_speed_{side}_m_s"] = solver.greatest[f"heel_speed_{side}"]
        if isinstance(base, YieldingBase):
            columns[f"dissipated_{side}_J_kg"] = getattr(run, f"dissipated_{side}")
    if base.kinematics == "first-order":
        columns["base_moment_m2_s2"] = solver.greatest["base_moment"]
    if dampers := solver.of(Damper):
        columns["damper_force_over_weight"] = solver.most[dampers, 0].max() / g
        if all(damper.brace == np.inf for damper in base.restraints if isinstance(damper, Damper)):
            columns |= {
                "damper_stroke_m": solver.most[dampers, 1].max(),
                "damper_speed_m_s": solver.most[dampers, 2].max(),
            }
            columns["damper_energy_J_kg"] = solver.work[dampers].sum()
    for kind, name in ((Tendon, "tendon"), (Stop, "stop"), (DeckSpring, "deck_spring")):
        if chosen := solver.of(kind):
            columns[f"{name}_force_over_weight"] = solver.most[chosen, 0].max() / g
    return columns


def energies(solver, run):
    """Return the parts of the balance of a pier without devices, and where its base has gone."""
    parts = ("input", "plastic", "impact", "p_delta", "constraint", "damping")
    unstressed = solver.v0 - solver.dy * solver.z0
    return {f"energy_{name}_J_kg": run.ledger[name] for name in parts} | {
        "settlement_m": unstressed - 0.5 * (run.base_left + run.base_right),
        "base_tilt_rad": (run.base_left - run.base_right) / (2 * FIG5.half_width),
    }


@pytest.mark.parametrize("name", [*FREE, *TIED])
def test_a_row_is_that_of_the_reference(name, uncompiled):
    """Peaks and the end to the error of four steps a sample, forces and energies to a few in ten thousand."""
    base, motion = (FREE | TIED)[name], shaken(0.9 if name in FREE else 0.6)
    solver = Observed(base, motion)
    run = solver.run()
    expected = peaks(solver, run) | (energies(solver, run) if name in FREE else {})
    response = uncompiled(
        rb.simulate, FIG5, base, motion, substeps=STEPS, quiet_s=0.0, wait=False, ledger=True, forces=True
    )
    row, end = response.row, response.history.iloc[-1]
    assert run.impacts > 0
    for column, value in expected.items():
        found, rounding = row.get(column, np.nan), 1e-5 if "J_kg" in column else 1e-6
        assert found == pytest.approx(np.nan if value is None else value, rel=3e-4, abs=rounding, nan_ok=True), column
    assert row.theta_max_over_alpha == pytest.approx(expected["theta_max_over_alpha"], abs=1e-6)
    assert [end.theta, end.omega, end.v] == pytest.approx([run.theta, run.omega, run.v], abs=5e-6)
    ledger = response.ledger
    assert ledger.remainder.abs().max() < 5e-4 * ledger.input.abs().max()
    if base.kinematics == "finite":  # the corners of a rigid body that turns about its centre of mass
        corners = np.array([[-FIG5.half_width], [FIG5.half_width]]) - 1j * FIG5.height
        raised = response.v + (corners * np.exp(-1j * response.theta)).imag + FIG5.height
        np.testing.assert_allclose(response.history[["v_left", "v_right"]].T, raised, rtol=0.0, atol=1e-14)
    if name in FREE:
        stored = ledger.kinetic + ledger.potential + ledger.elastic
        np.testing.assert_allclose(response.energy, stored, rtol=0.0, atol=1e-14)
