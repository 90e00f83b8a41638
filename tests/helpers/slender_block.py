"""A slender block on a rigid base under a pulse, in closed form: conditions of overturning.

In the slender limit, with time in 1/p, angles in α, W = ω_p/p, A = a_p/(g tan α) and ψ = asin(1/A) the pulse's phase at
lift-off, the block obeys x″ = x + A sin(Wτ + ψ) for x = θ/α − 1. So x = −D sin(Wτ + ψ) + c cosh τ + s sinh τ with
D = A/(1 + W²), c = −W²/(1 + W²) and s = W √(A² − 1)/(1 + W²). Once the pulse is over x + x′ decides: above 0 the block
falls, at 0 it stays at the unstable equilibrium, below 0 it comes back, and falls to the other side if e² (1 + x′² − x²) > 1, the
kinetic energy after an impact at x = −1. (Zhang & Makris 2001 give the first of these conditions.)
"""

import math

W = 5.0
E = 0.9
SLENDER = 1e-4
HALF_SINE = 3.289146777523
ONE_SINE = (3.018600, 6.318071, 7.168129)


def end_of_pulse(amplitude: float, end: float, w: float = W) -> tuple[float, float]:
    """Return x and x′ when a sine pulse with ω_p/p = ``w`` has reached its phase ``end``, a multiple of π."""
    psi = math.asin(1.0 / amplitude)
    tau = (end - psi) / w
    c, s = -(w**2) / (1 + w**2), w * math.sqrt(amplitude**2 - 1) / (1 + w**2)
    forced = -amplitude * w * math.cos(end) / (1 + w**2)
    return c * math.cosh(tau) + s * math.sinh(tau), forced + c * math.sinh(tau) + s * math.cosh(tau)


def outward(amplitude: float, end: float, w: float = W) -> float:
    """Return x + x′ at the end of the pulse; above 0 the block falls without an impact."""
    x, x_rate = end_of_pulse(amplitude, end, w)
    return x + x_rate


def energy_after_impact(amplitude: float, w: float = W) -> float:
    """Return a measure of the energy after the first impact, which follows the one-sine; above 0 the block falls."""
    x, x_rate = end_of_pulse(amplitude, 2 * math.pi, w)
    return E**2 * (1 + x_rate**2 - x**2) - 1
