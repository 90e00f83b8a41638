"""Demands on devices: closed forms, a solver of its own, and whether the error that a row claims holds them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from core_samples import FIG5, broadband, pulse
from restrained_reference import TiedTwoSprings

from rockbatch.common.units import GRAVITY
from rockbatch.motions.motion import Motion
from rockbatch.outcome.changes import FLOOR, OF_DEVICES, scales_of
from rockbatch.pier import Base, Damper, DeckSpring, Pier, Restraint, RigidBase, Stop, Tendon, YieldingBase
from rockbatch.simulation import block, run_fixed, run_to_tolerance

STILL = Motion("still", 0.01, np.zeros(150))
PADS = YieldingBase(50.0, 0.3, eta=3.0, flight="guided")
SHAKEN = pulse("sine", 0.5, 1.0, dt=0.01, end=2.0)


@pytest.mark.parametrize("substeps", [1, 3])
def test_a_speed_that_jumps_up_at_an_impact_is_that_behind_it(substeps):
    """Let go at θ0 the block comes down at ω² = 2 p² (cos(α − θ0) − cos α); then the other pivot rises at 2 b e ω."""
    start = 0.5 * FIG5.alpha
    pier = replace(FIG5, initial_rotation_rad=start)
    base = RigidBase(restraints=(Damper("viscous", nu=0.0, at="right"),))
    omega = math.sqrt(2.0 * (math.cos(pier.alpha - start) - math.cos(pier.alpha))) * pier.p
    outcome = run_fixed(pier, base, STILL, substeps, quiet_s=0.0, wait=False)  # before the block comes back
    assert outcome.impacts == 1
    expected = 2.0 * pier.half_width * block(pier, base).restitution * omega
    assert outcome.damper_speed == pytest.approx(expected, rel=1e-6)


class Sampled(TiedTwoSprings):
    """The reference, with the greatest demands on its devices, at twelve moments of every step of its own."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.most = np.zeros((len(self.elements), 3))  # force, stroke and speed of each
        turning = self.leg._turning

        def sampled(dense, times, states, theta, omega):
            turning(dense, times, states, theta, omega)
            inside = [dense(x).tolist() for x in np.linspace(times[0], times[-1], 13)[1:-1]]
            for y in (states[0], *inside, states[-1]):
                for j in range(len(self.elements)):
                    values = abs(self.pull(j, y)), abs(self.elongation(j, y)), abs(self.speed(j, y))
                    self.most[j] = np.maximum(self.most[j], values)

        self.leg._turning = sampled


@pytest.mark.sweep(fast=2)
@pytest.mark.parametrize(
    "device",
    [
        Damper("viscous", nu=1.0, at="left"),
        Damper("hysteretic", f=0.1, yield_m=0.005, at="right"),
        Tendon(psi=0.1, lam=1.0, at=0.4),
        Tendon(psi=0.1, lam=1.0, strength=0.13),
    ],
    ids=["viscous", "hysteretic", "tendon", "yields"],
)
def test_demands_are_those_of_the_reference(device):
    base = replace(PADS, restraints=(device,))
    expected = Sampled(FIG5, base, SHAKEN, 0.0)
    expected.run()
    (force, stroke, speed), *_ = expected.most
    found = run_fixed(FIG5, base, SHAKEN, 8, quiet_s=0.0, wait=False)
    assert getattr(found, f"{device.what}_force") == pytest.approx(force / GRAVITY, rel=1e-5)
    if isinstance(device, Damper):
        assert (found.damper_stroke, found.damper_speed) == pytest.approx((stroke, speed), rel=1e-5)


def _between(rng: np.random.Generator, low: float, high: float) -> float:
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def _device(rng: np.random.Generator, pier: Pier) -> Restraint:
    """Return a random device of any kind."""
    kind = str(rng.choice(["friction", "viscous", "root", "steel", "on a brace", "tendon", "yields", "stop", "deck"]))
    at = (None, "left", "right", float(rng.uniform(-0.9, 0.9)) * pier.half_width)[rng.integers(4)]
    gap = _between(rng, 0.005, 0.2) * 2.0 * pier.half_width * pier.alpha
    psi = _between(rng, 0.05, 0.4)
    steel = {"f": _between(rng, 0.01, 0.15), "yield_m": _between(rng, 0.001, 0.02), "at": at}
    devices: dict[str, Restraint] = {
        "friction": Damper("friction", f=_between(rng, 0.01, 0.15), at=at),
        "viscous": Damper("viscous", nu=_between(rng, 0.05, 2.0), at=at),
        "root": Damper("viscous", nu=_between(rng, 0.05, 0.5), exponent=float(rng.uniform(0.3, 0.9)), at=at),
        "steel": Damper("hysteretic", **steel),
        "on a brace": Damper("hysteretic", **steel, brace=_between(rng, 1.0, 50.0)),
        "tendon": Tendon(psi=psi, lam=_between(rng, 0.05, 2.0), at=at or 0.0),
        "yields": Tendon(psi=psi, lam=_between(rng, 0.3, 2.0), strength=psi * _between(rng, 1.1, 3.0), at=at or 0.0),
        "stop": Stop(gap, _between(rng, 5.0, 100.0), float(rng.uniform(0.4, 1.0))),
        "deck": DeckSpring(
            _between(rng, 0.05, 2.0), gap, float(rng.uniform(0.4, 1.0)), ("both", "left")[rng.integers(2)]
        ),
    }
    return devices[kind]


def _case(seed: int, base: Base) -> tuple[Pier, Base, Motion]:
    """Return a random pier with one to three devices on ``base``, and a motion that makes it rock."""
    rng = np.random.default_rng(seed)
    pier = Pier(alpha=_between(rng, 0.06, 0.35), p=_between(rng, 0.35, 2.0))
    devices = tuple(_device(rng, pier) for _ in range(rng.integers(1, 4)))
    strong = GRAVITY * math.tan(pier.alpha) * rng.uniform(1.2, 4.0)
    motion = Motion(f"seed {seed}", 0.01, broadband(rng, 0.01, 400, strong))
    return pier, replace(base, restraints=devices), motion


@pytest.mark.parametrize("base", [RigidBase(), PADS], ids=["rigid", "springs"])
@pytest.mark.parametrize(
    "seeds", [range(5), pytest.param(range(5, 60), marks=pytest.mark.thorough)], ids=["few", "many"]
)  # fmt: skip
def test_no_demand_of_random_devices_is_further_off_than_the_error_says(seeds, base):
    held = 0
    for seed in seeds:
        pier, tied, motion = _case(seed, base)
        found = run_to_tolerance(pier, tied, motion, 1e-4)
        if found.status != "ok" or found.theta_max_error is None:
            continue
        truth = run_fixed(pier, tied, motion, 4 * found.substeps)
        for (name,), scale in OF_DEVICES.values():
            value, true = (getattr(outcome, name) or 0.0 for outcome in (found, truth))
            least = FLOOR * scales_of(pier)[scale]
            assert abs(value - true) <= found.devices_error * max(value, least) + 1e-12, (seed, name)
        held += 1
    assert held > 0.5 * len(seeds)
