"""Geometrically similar blocks move as far at their tops, whatever their size, unless they are near to overturning.

Reggiani Manzo & Vassiliou (2019), Displacement-based analysis and design of rocking structures, doi 10.1002/eqe.3217 (abstract),
for pulses and records.
"""

from pathlib import Path

import numpy as np
import pytest

import rockbatch as rb

STUDY = f"""
[pier]
alpha = [0.10, 0.15]
size_m = [20.0, 40.0, 80.0]

[motions]
path = '{Path(__file__).parents[2] / "motions" / "near_fault"}'
vertical = false

[[case]]
base = "rigid"
restitution = 0.95
"""


def test_tops_of_20_and_80_m_move_as_far_under_near_fault_records_in_the_median():
    """The table of docs/pages/held_against_others.md: half of the 20 ratios within 6 %, while θ/α of the larger is a quarter."""
    runs = rb.run(rb.Study.from_toml(STUDY)).set_index(["record", "alpha", "size_m"])["theta_max_over_alpha"].unstack()
    ratios = 4.0 * runs[80.0] / runs[20.0]  # 2 R0 θ
    assert len(ratios) == 20
    quartiles = np.percentile(ratios, [25, 50, 75])
    assert quartiles == pytest.approx([0.945, 0.980, 1.008], abs=0.005)
    assert np.percentile(2.0 * runs[80.0] / runs[40.0], [25, 50, 75]) == pytest.approx([0.98, 0.995, 1.0], abs=0.01)
    extremes = ratios.min(), ratios.max()
    assert extremes == pytest.approx((0.28, 1.47), abs=0.02)
