"""Measures of an engineer's own and over g tan α: values by record, powers, mistakes of a table, piers that share a curve."""

import math

import numpy as np
import pytest
from studies import seven_pulses, study_text, write_study

import rockbatch as rb
from rockbatch.analyses.fragility.answer import of_curves
from rockbatch.analyses.fragility.measures import MEASURES, own_measure
from rockbatch.common.errors import InputError
from rockbatch.motions.intensity.measures import arias_intensity
from rockbatch.pier import Pier
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions


def study(tmp_path, fragility, pier=None):
    text = study_text(
        pier=pier or {"alpha": 0.2, "p": 2.0},
        motions={},
        pulses=seven_pulses(0.4),
        cases=({"name": "rigid", "base": "rigid"},),
        numerics={"tolerance": 1e-3},
        fragility=fragility,
    )
    return write_study(tmp_path, text)


def arias(tmp_path):
    found = ground_motions(load_study(study(tmp_path, {"measure": "PGA", "levels_g": [0.2, 0.4]}))).motions
    return {motion.name: arias_intensity(motion.horizontal, motion.dt) for motion in found}


def test_a_measure_of_a_table_scales_records_by_the_root_of_its_power(tmp_path):
    """Arias intensity grows as the square of a factor: at each level it is the level again, by the run's own factor."""
    values = arias(tmp_path)
    lines = "".join(f"{name},{value!r}\n" for name, value in values.items())
    (tmp_path / "arias.csv").write_text("record,Arias [m/s]\n" + lines, encoding="utf-8")
    own = {"measure_file": "arias.csv", "measure_power": 2, "levels": [0.5, 2.0, 8.0, 32.0]}
    found = rb.fragility(study(tmp_path, own))
    assert (found.info["measure"], found.info["unit"]) == ("Arias", "m/s")
    runs = found.fragility_runs
    reached = runs["scale"] ** 2 * runs["record"].map(values)
    assert np.sort(reached) == pytest.approx(np.repeat([0.5, 2.0, 8.0, 32.0], 7), rel=1e-5)
    assert found.fragility_scales["scale"].to_numpy() == pytest.approx(
        np.sqrt(found.fragility_scales["level"] / found.fragility_scales["unscaled"]), rel=1e-9
    )


def test_from_python_values_by_record_take_the_place_of_the_measure(tmp_path):
    """PGA as a series of its own is PGA."""
    by_name = study(tmp_path, {"measure": "PGA", "levels_g": [0.2, 0.3, 0.4, 0.6]})
    of_pga = rb.fragility(by_name)
    given = of_pga.fragility_scales.groupby("record")["unscaled"].first()
    found = rb.fragility(by_name, im=given.rename("own PGA [g]"))
    assert found.info["measure"] == "own PGA"
    assert found.fragility["exceeded"].to_list() == of_pga.fragility["exceeded"].to_list()
    assert rb.fragility(by_name, im=dict(given)).info["unit"] == ""


def test_a_record_without_a_value_is_refused_by_name(tmp_path):
    values = arias(tmp_path)
    missing = sorted(values)[2]
    del values[missing]
    with pytest.raises(InputError, match=f"{missing}: the measure"):
        rb.fragility(study(tmp_path, {"measure": "PGA", "levels_g": [0.2, 0.4]}), im=values)


@pytest.mark.parametrize(
    ("heading", "name", "unit"),
    [
        ("AvgSa [g]", "AvgSa", "g"),
        ("FIV3 (m/s)", "FIV3", "m/s"),
        ("ratio [-]", "ratio", ""),
        ("I_a[cm/s]", "I_a", "cm/s"),
    ],
)
def test_the_unit_of_a_measure_is_in_its_heading(heading, name, unit):
    own = own_measure(heading, [("a", 1.0)], 1.0)
    assert (own.name, own.unit) == (name, unit)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("record,AvgSa\na,1\n", 'has no unit; write "AvgSa [g]"'),
        ("record,AvgSa [g]\na,0\n", "above 0"),
        ("record,AvgSa [g]\na,1\na,2\n", "a: it has several values"),
        ("record,Sa [g],V [m/s]\na,1,2\n", "it needs record, and one"),
        ("name,Sa [g]\na,1\n", "it needs record, and one"),
    ],
)
def test_tables_that_are_no_measure_say_why(tmp_path, text, message):
    (tmp_path / "own.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        rb.fragility(study(tmp_path, {"measure_file": "own.csv", "levels": [0.2, 0.4]}))
    assert message in "\n".join(caught.value.messages)


@pytest.mark.parametrize(
    ("fragility", "message"),
    [
        ({"levels": [0.2, 0.4]}, "measure is missing"),
        ({"measure": "PGA", "levels": [0.2, 0.4]}, "levels: the measure has levels_g; write that"),
        ({"measure": "PGA", "measure_file": "a.csv", "levels_g": [0.2]}, "measure and measure_file are given"),
        ({"measure": "PGA", "measure_power": 2, "levels_g": [0.2, 0.4]}, "measure_power is of measure_file"),
    ],
)
def test_measures_and_levels_that_do_not_belong_together_are_refused(tmp_path, fragility, message):
    with pytest.raises(InputError) as caught:
        rb.fragility(study(tmp_path, fragility))
    assert message in "\n".join(caught.value.messages)


def test_intensities_over_uplift_are_those_of_the_spectrum_of_a_pier():
    pier = Pier(0.2, 1.5)
    assert MEASURES["PGA/(g tan alpha)"].per_pier(pier) == pytest.approx(1 / math.tan(0.2))
    assert MEASURES["p PGV/(g tan alpha)"].per_pier(pier) == pytest.approx(1.5 / (9.81 * math.tan(0.2)))


@pytest.mark.slow
def test_piers_of_a_list_share_a_curve_over_what_lifts_them_off(tmp_path):
    """Three sizes: each record counts once for each, and its station once in all."""
    levels = [1.0, 1.5, 2.0, 3.0, 4.0]
    piers = study(tmp_path, {"measure": "PGA/(g tan alpha)", "levels": levels}, {"alpha": 0.2, "p": [1.5, 2.0, 2.5]})
    found = rb.fragility(piers)
    (curve,) = found.curves
    assert (curve.cases, "p" in curve.case.columns) == (3, False)
    assert found.fragility["n"].to_list() == 5 * [21]
    assert found.info["curves"][0]["stations"] == 7
    assert "7 stations on 3 piers" in of_curves(found.info)
    assert len(found.fragility_runs) == 3 * 7 * 5
    pga = found.fragility_runs["scale"] * 0.4 / math.tan(0.2)
    assert np.sort(pga) == pytest.approx(np.repeat(levels, 21), rel=1e-3)
    alone = [
        rb.fragility(study(tmp_path, {"measure": "PGA/(g tan alpha)", "levels": levels}, {"alpha": 0.2, "p": p}))
        for p in (1.5, 2.0, 2.5)
    ]
    sums = sum(each.fragility["exceeded"] for each in alone)
    assert found.fragility["exceeded"].to_list() == sums.to_list()
