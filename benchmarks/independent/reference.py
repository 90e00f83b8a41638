"""What a run comes to in truth: outcomes over the whole free vibration, by :mod:`dop853`."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad

from rockbatch.motions import Motion
from rockbatch.pier import Base, Pier, RigidBase, YieldingBase

from . import dop853 as core

HORIZON = 400.0  # s after the motion
STEP = 0.4  # of 1/ω, ω the highest frequency
STATUS = ("stands", "overturned", "flew", "exhausted")


@dataclass(frozen=True)
class Reference:
    """Truth about a run; angles in rad, times in s.

    ``status`` is "stands", "overturned" (|θ| = π/2, ever), "flew" (a rigid base whose ``flight`` is "stop": the run ends
    with its first flight, other than that of a pier that falls beyond α) or "exhausted" (more than ``most_steps``).
    Everywhere else the run goes on in flight as if guided: ``t_flight`` is its first time (nan: none), ``theta_flight``
    the rotation then, positive on its way out, and ``peak_flight`` the peak until then, at ``t_peak_flight``.
    ``flights`` are as many as take-offs of both pivots, ``flight_duration`` is the time in all of them, ``flight_height``
    the greatest height of the lower pivot [m] (rigid base; nan on springs).
    ``decided``: the energy left cannot exceed ``theta_max`` any more; otherwise ``halfway`` is the peak half-way to the
    horizon.
    """

    status: str
    theta_max: float
    t_max: float
    t_end: float
    impacts: int
    separations: int
    t_flight: float
    theta_flight: float
    peak_flight: float
    t_peak_flight: float
    up_left: float
    up_right: float
    balance: float
    forced: int
    steps: int
    decided: bool
    halfway: float
    flights: int
    flight_duration: float
    flight_height: float


def start_depth(delta_y: float, eta: float, n: float) -> float:
    """∫₀^{1/η} ds/(1 − sⁿ) · δ_y: how far Bouc–Wen springs sink under the weight."""
    return (
        delta_y * quad(lambda s: 1 / -math.expm1(n * math.log(s)) if s > 0 else 1.0, 0, 1 / eta, epsabs=0, limit=500)[0]
    )


def parameters(pier: Pier, base: Base) -> tuple[np.ndarray, np.ndarray]:
    """Parameters and start (v, θ, v̇, θ̇, z_L, z_R) of the compiled solver."""
    par = np.zeros(17)
    size = pier.mu / (1 + pier.mu) * pier.gravity / pier.p**2
    par[core.G], par[core.ALPHA], par[core.P] = pier.gravity, pier.alpha, pier.p
    par[core.HALF_WIDTH], par[core.HEIGHT] = size * math.sin(pier.alpha), size * math.cos(pier.alpha)
    par[core.INERTIA] = size**2 / pier.mu
    start = np.zeros(6)
    if isinstance(base, RigidBase):
        housner = 1 - 2 * pier.mu / (1 + pier.mu) * math.sin(pier.alpha) ** 2
        par[core.RIGID], par[core.E] = 1.0, max(housner, 0.0) if base.restitution is None else base.restitution
        par[core.FINITE], par[core.STOPS] = 1.0, float(getattr(base, "flight", "guided") == "stop")
        par[core.EPSILON] = getattr(base, "epsilon", 0.0)
        return par, start
    omega = base.beta * pier.p
    delta_s = pier.gravity / omega**2
    eta, law, n = 1.0, core.ELASTIC, 1.0
    depth = delta_s
    if isinstance(base, YieldingBase):
        eta = base.eta
        law, n = (core.EPP, 1.0) if base.spring == "epp" else (core.BOUC_WEN, base.n)
        if law == core.BOUC_WEN:
            depth = start_depth(eta * delta_s, eta, n)
    par[core.FY], par[core.DY], par[core.N], par[core.LAW] = eta * pier.gravity / 2, eta * delta_s, n, law
    par[core.FINITE], par[core.EPSILON] = float(base.kinematics == "finite"), base.epsilon
    par[core.OMEGA], par[core.ETA] = omega, eta
    start[0], start[4:] = -depth, -1 / eta
    return par, start


def reference(
    pier: Pier,
    base: Base,
    motion: Motion,
    tolerance: float = 1e-13,
    *,
    factor: float = 1.0,
    horizon: float = HORIZON,
    most_steps: float = 2e7,
    patient: bool = False,
    trace: np.ndarray | None = None,
) -> Reference:
    """Truth about ``pier`` on ``base`` under ``motion`` times ``factor``, followed for up to ``horizon`` [s] after it
    (``patient``: in any case).

    Steps are a share of the shortest period; a share too of ``motion.dt`` for tolerances below 10⁻¹².
    """
    par, start = parameters(pier, base)
    vertical = np.zeros(motion.npts) if motion.vertical is None else motion.vertical
    found = core.solve(
        par,
        start,
        motion.dt,
        np.ascontiguousarray(motion.horizontal, dtype=float) * factor,
        np.ascontiguousarray(vertical, dtype=float) * factor,
        horizon,
        tolerance,
        min(STEP / max(par[core.OMEGA], 4 * par[core.P]), 0.7 * motion.dt if tolerance < 1e-12 else math.inf),
        most_steps,
        patient,
        np.zeros((0, 7)) if trace is None else trace,
    )
    return Reference(
        status=STATUS[int(found[core.STATUS])],
        theta_max=float(found[core.THETA_MAX]),
        t_max=float(found[core.T_MAX]),
        t_end=float(found[core.T_END]),
        impacts=int(found[core.IMPACTS]),
        separations=int(found[core.SEPARATIONS]),
        t_flight=float(found[core.T_FLIGHT]),
        theta_flight=float(found[core.THETA_FLIGHT]),
        peak_flight=float(found[core.PEAK_FLIGHT]),
        t_peak_flight=float(found[core.T_PEAK_FLIGHT]),
        up_left=float(found[core.UP_LEFT]),
        up_right=float(found[core.UP_RIGHT]),
        balance=float(found[core.BALANCE]),
        forced=int(found[core.FORCED]),
        steps=int(found[core.STEPS]),
        decided=bool(found[core.DECIDED]),
        halfway=float(found[core.HALFWAY]),
        flights=int(found[core.FLIGHTS]),
        flight_duration=float(found[core.AIR_TIME]),
        flight_height=float(found[core.AIR_HEIGHT]) if isinstance(base, RigidBase) else math.nan,
    )


def twice(pier: Pier, base: Base, motion: Motion) -> tuple[Reference, Reference]:
    """The truth, and what a tolerance a hundred times looser, other steps and a motion 10⁻¹² stronger make of it."""
    return reference(pier, base, motion), reference(pier, base, motion, 1e-11, factor=1 + 1e-12)
