"""A footing on sand, pushed to and fro in a centrifuge: its moments, and the bed's (benchmarks/measured_footing.py)."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

SPEC = importlib.util.spec_from_file_location(
    "measured_footing", Path(__file__).parents[2] / "benchmarks" / "measured_footing.py"
)
assert SPEC is not None
assert SPEC.loader is not None
MEASURED = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(MEASURED)


@pytest.fixture(params=MEASURED.MODULI)
def bed(request):
    """Rotations and moments of the bed with one shear modulus."""
    return MEASURED.moments(*MEASURED.on_sand(request.param))


def test_capacity_of_the_bed_is_below_the_measured_moment_by_an_eighth_at_most(bed):
    """From 14 mrad on; two springs of the same strength at the edges have 1.0, above all measured means."""
    for packet in MEASURED.PACKETS[2:]:
        assert 0.87 < np.interp(packet.rotation, *bed) / packet.mean < 1.04


def test_bed_mobilises_its_moment_before_the_sand_did(bed):
    """A bed of one stiffness; with the modulus of small strains seven times as early, with a quarter of it 1.7 times."""
    tested = np.array([(packet.rotation, packet.mean) for packet in MEASURED.PACKETS]).T
    theta, moment = bed
    most = 0.9 * (1.0 - 1.0 / 5.198)
    assert 0.1 < MEASURED.mobilised(theta, moment, most) / MEASURED.mobilised(*tested, most) < 0.65
