"""The worked design: its page shows its study, and its hand checks come to what the program has."""

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest

import rockbatch as rb
from rockbatch.pier.statics import FACTS
from rockbatch.study.load import load_study

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "pages" / "worked_design.md").read_text(encoding="utf-8")
STUDY = ROOT / "configs" / "worked_design.toml"

SHOWN = ("", "soft ground", "stiff ground", "weak ground", "strong ground")
F_CD, F_YD, E_S = 0.85 * 35e3 / 1.5, 500e3 / 1.15, 200e6  # kPa
DEPTH, WIDTH, WALL, STEEL = 6.0, 4.0, 0.4, 54 * 0.032**2 * np.pi / 4.0  # m; m² in each of the short walls


def blocks(language):
    """The texts between ```language and ``` on the page."""
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)


def cases():
    """The cases of the study, by the names of their bounds."""
    return {str(case.columns.get("bound", "")): case for case in load_study(STUDY).cases}


def test_every_table_on_the_page_is_in_the_study():
    of_study = STUDY.read_text(encoding="utf-8").splitlines()
    assert len(blocks("toml")) > 3
    assert [line for text in blocks("toml") for line in text.splitlines() if line not in of_study] == []


def test_its_statics_are_those_that_are_printed():
    made = cases()
    sheets = [rb.statics(made[bound].pier, made[bound].base).row for bound in SHOWN]
    rows = dict(re.findall(r"^\| (.*?) \| (.*) \|$", PAGE, re.MULTILINE))
    facts = [fact for fact in FACTS if fact.heading in rows]
    assert len(facts) == 10
    for fact in facts:
        assert [cell.strip() for cell in rows[fact.heading].split("|")] == [
            fact.written(row[fact.name]) for row in sheets
        ]


def test_its_statics_are_those_of_a_hand():
    """W, h, FS, K_θ by Gazetas' formula, settlement, ultimate moment, lift-off without dampers."""
    case = cases()[""]
    row = rb.statics(case.pier, case.base).row
    weight, height = 9.81 * (1900 + 600 + 368), (1900 * 24.5 + 600 * 1 + 368 * 12) / 2868
    stiffness = 100 / 0.7 * 1000**0.75 * 1.2**0.25 * (2.4 + 0.5 / 1.2)
    assert case.pier.height == pytest.approx(height)
    assert case.base.safety_factor == pytest.approx(144e3 / weight)
    assert row["rocking_stiffness_MN_m"] == pytest.approx(stiffness)
    assert row["ultimate_moment_kN_m"] == pytest.approx(0.5 * weight * 10 * (1 - weight / 144e3))
    plain = rb.statics(case.pier, dataclasses.replace(case.base, restraints=())).row
    assert plain["lift_off_g"] == pytest.approx(10 / 6 / height, rel=0.01)  # P-delta of a rotation of 0.6 mrad
    said = (
        f"{weight:,.0f} kN",
        f"{height:.2f} m",
        f"{stiffness:,.0f} MN m/rad",
        f"{1e-3 * weight * 100 / 12 / stiffness * 1e3:.2f} mm",
        f"{1e-3 * row['ultimate_moment_kN_m']:.1f} MN m",
        f"{10 / 6 / height:.4f} g",
    )
    assert [words for words in said if words not in PAGE] == []


def section(strain, curvature):
    """Axial force and moment [kN, kN m] of the shaft, by its strain in the middle and its curvature, compression positive.

    Fibres; concrete by EN 1992's parabola and rectangle, steel elastic, then plastic, in the middle of the short walls.
    """
    y = (np.arange(6000) + 0.5) / 6000 * DEPTH - 0.5 * DEPTH
    breadth = np.where(abs(y) > 0.5 * DEPTH - WALL, WIDTH, 2.0 * WALL)
    share = np.clip((strain + curvature * y) / 0.002, 0.0, 1.0)
    concrete = F_CD * (1.0 - (1.0 - share) ** 2) * breadth * DEPTH / 6000
    z = 0.5 * (DEPTH - WALL) * np.array([-1.0, 1.0])
    steel = STEEL * np.clip(E_S * (strain + curvature * z), -F_YD, F_YD)
    return concrete.sum() + steel.sum(), concrete @ y + steel @ z


def resistance(axial):
    """The moment [kN m] that the shaft bears at an axial force [kN], with 0.0035 at its edge."""
    low, high = -0.3, 0.0034
    for _ in range(60):
        middle = 0.5 * (low + high)
        force, moment = section(middle, (0.0035 - middle) / (0.5 * DEPTH))
        low, high = (middle, high) if force < axial else (low, middle)
    return moment


@pytest.mark.parametrize("axial", [0.0, 10e3, 20e3, 31.7e3])
def test_the_curve_of_the_shaft_is_that_of_its_fibres(axial):
    """By hand: (A_s f_yd + N/2) z with z between the middles of the short walls, without the long ones, to a full short wall."""
    curve = np.array(next(check.capacity for check in load_study(STUDY).checks if check.capacity))
    by_hand = float(np.interp(axial, curve[:, 0], curve[:, 1]))
    assert resistance(axial) == pytest.approx(by_hand, rel=0.02)
    assert resistance(axial) > 0.999 * by_hand


def test_its_corners_are_those_of_the_hand():
    curve = next(check.capacity for check in load_study(STUDY).checks if check.capacity)
    lever, tie, wall = DEPTH - WALL, STEEL * F_YD, WIDTH * WALL * F_CD
    whole = (WIDTH * DEPTH - (WIDTH - 2.0 * WALL) * (DEPTH - 2.0 * WALL)) * F_CD
    corners = [(-2.0 * tie, 0.0), (0.0, tie * lever), (wall, (tie + 0.5 * wall) * lever), (whole + 2.0 * tie, 0.0)]
    np.testing.assert_allclose(np.array(curve), corners, rtol=2e-3, atol=1.0)
