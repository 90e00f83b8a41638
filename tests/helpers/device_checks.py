"""What holds for every device: peaks as the reference solver has them, errors of order four, a closed energy balance."""

import math

import pytest
from core_samples import FIG5
from restrained_reference import TiedTwoSprings
from stop_reference import StoppedBlock
from stopped_piers import SHAKEN, stopped

import rockbatch as rb
from rockbatch.pier import problems
from rockbatch.simulation import Run, run_to_tolerance, written_run

SEEDS = [
    pytest.param(range(2), id="few", marks=pytest.mark.slow),
    pytest.param(range(2, 34), id="most", marks=pytest.mark.thorough),
]


def reference(pier, base, motion):
    """The reference solver for a base with devices."""
    return (TiedTwoSprings if base.on_springs else StoppedBlock)(pier, base, motion, 0.0)


def assert_agreement(cases, base, rounding):
    """Assert for most ``cases``, pairs of devices and motion, that the peak is the reference's within the reported error.

    ``rounding``, a part of α, is added to that error.
    """
    compared = 0
    for devices, motion in cases:
        tied = stopped(base, devices)
        assert not problems(FIG5, tied)
        outcome = run_to_tolerance(FIG5, tied, motion, 1e-6, 0.0)
        flies = outcome.flights and not base.on_springs  # which that reference does not follow
        if outcome.status != "ok" or flies or outcome.theta_max_error is None:
            continue
        end = reference(FIG5, tied, motion).run()
        if end.t_end < outcome.t_max:  # reached while the run waited
            continue
        error, bound = abs(outcome.theta_max - end.theta_max), outcome.theta_max_error + rounding * FIG5.alpha
        assert error <= bound, f"{motion.name}: {error} above {bound}"
        compared += 1
    assert compared > 0.6 * len(cases)


def assert_fourth_order(tied, rounding):
    """Assert that errors of the peak fall with the fourth power of the step, or below ``rounding``."""
    peaks = [written_run(Run(FIG5, tied, SHAKEN), k, 0.0, 1, wait=False)[0].theta_max for k in (4, 16, 128)]
    first, third = (abs(peak - peaks[-1]) for peak in peaks[:-1])
    assert third < rounding or math.log2(first / third) / 2 > 3.4, f"errors {first} and {third}"


def assert_balance(tied):
    """Assert that the energy balance closes, and return it."""
    ledger = rb.simulate(FIG5, tied, SHAKEN, substeps=32, wait=False, quiet_s=0.0, ledger=True).ledger
    residual, bound = ledger.remainder.abs().max(), 2e-7 * ledger.input.abs().max()
    assert residual < bound, f"{residual} above {bound}"
    return ledger
