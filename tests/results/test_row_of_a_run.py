"""The row of a single run is that of a table, value by value and type by type."""

import pandas as pd
import pytest

import rockbatch as rb
from rockbatch.quantities.catalogue import COLUMNS
from rockbatch.results.columns import as_series, as_table
from rockbatch.study import load_study

PIER = rb.Pier(alpha=0.2, p=1.0)


@pytest.mark.parametrize(
    "base",
    [rb.RigidBase(), rb.RigidBase(restraints=(rb.Damper("friction", f=0.05),)), rb.YieldingBase(beta=50.0, eta=3.0)],
)
def test_a_row_has_the_values_and_types_of_a_table(base, tmp_path):
    motion = rb.pulse("sine", name="p", amplitude=9.81, period=0.5, dt=0.005, duration=2.0)
    row = rb.simulate(PIER, base, motion).row
    path = tmp_path / "study.toml"
    path.write_text(
        '[pier]\nalpha = 0.2\np = 1.0\n[motions]\nstill_s = 1.0\n[[case]]\nbase = "rigid"\n', encoding="utf-8"
    )
    plain = {name: None if value is pd.NA or value != value else value for name, value in row.items()}
    of_table = as_table([plain], load_study(path)).iloc[0]
    alike = row.index.intersection(of_table.index)
    assert len(alike) > 20
    for name in alike:
        same = (
            row[name] is of_table[name]
            or row[name] == of_table[name]
            or (row[name] != row[name] and of_table[name] != of_table[name])
        )
        assert same, name
        assert type(row[name]) is type(of_table[name]), name
    again = as_series(plain)
    assert (again.name, list(again.index)) == ("p", list(row.index))


def test_errors_that_a_pier_must_stay_upright_for_are_empty_where_it_overturns():
    """On springs, with a shaft that bends."""
    pier = rb.Pier(alpha=0.2, p=1.0, flexural_period_s=1.0)
    base = rb.ElasticBase(beta=50.0, zeta=0.05, shaft="elastic", kinematics="finite")

    def stated(amplitude):
        row = rb.simulate(
            pier, base, rb.pulse("sine", name="p", amplitude=amplitude, period=2.0, dt=0.02, duration=3.0)
        ).row
        return row["status"], {name for name in row.index if name in COLUMNS and not pd.isna(row[name])}

    (stands, upright), (falls, fallen) = stated(1.0), stated(2.5)
    assert (stands, falls) == ("ok", "overturned")
    only_upright = {name for name in upright - fallen if "error" in name}
    assert {"theta_max_error", "deflection_error_m", "top_drift_error_m"} <= only_upright
    conditional = {name for name, column in COLUMNS.items() if "stayed upright" in column.applies}
    assert only_upright <= conditional
    assert not fallen & conditional
