"""The sections on the study and its statics show the structure: masses, deck, devices with their numbers; to scale."""

import pytest
from report_page import Page
from studies import study_text, write_study

import rockbatch as rb
from rockbatch.pier import described
from rockbatch.reporting.structure import base_of, device_in_words, pier_of, restraints_of
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case

BRIDGE = {
    "width_m": 7.0, "height_m": 30.0, "mass_t": 1800.0, "deck_mass_t": 1200.0, "deck_height_m": 31.5, "top_m": 30.0,
}  # fmt: skip
CASES = (
    {"name": "bare", "base": "rigid"},
    {"name": "oil", "base": "rigid", "damper": [{"kind": "viscous", "coefficient_kN_s_m": 2000.0, "exponent": 0.3}]},
    {
        "name": "tied", "base": "rigid", "restitution": 0.9,
        "damper": [{"kind": "hysteretic", "force_kN": 2000.0, "yield_mm": 5.0, "at": "left"}],
        "tendon": [{"prestress_kN": 5000.0, "stiffness_kN_m": 20000.0}],
    },
)  # fmt: skip


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bridge")
    text = study_text(pier=BRIDGE | {"flexural_period_s": 1.5}, cases=CASES, output={"histories": "none"})
    rb.run(write_study(folder, text), out=folder / "out")
    return (folder / "out/report.html").read_text(encoding="utf-8")


def part(report: str, anchor: str) -> str:
    return report.split(f'<section id="{anchor}"')[1].partition(">")[2].split("</section>")[0]


def test_masses_deck_and_heights_stand_in_the_units_of_the_study(report):
    text = Page(part(report, "studied")).text
    assert "mass 3000 t" in text
    given = "between the pivots 7 m, height 30 m, shaft 1800 t, deck 1200 t, centre of the deck at 31.5 m, drift read at 30 m"
    assert f"As given: {given}." in text


def test_the_statics_of_all_cases_stand_beside_each_other_with_their_devices(report):
    page = Page(f'<section id="statics">{part(report, "statics")}</section>')
    rows = {row[0]: [cell.replace("\u00a0", " ") for cell in row[1:-1]] for row in page.tables["statics"]}
    assert rows[""] == ["bare", "oil", "tied: e = 0.9"]
    assert rows["devices"] == [
        "",
        "viscous damper at each pivot, C = 2000 kN (s/m)^0.3",
        "hysteretic damper at the left pivot, F = 2000 kN, uy = 5 mm, n = 5; tendon on the axis, P0 = 5000 kN, kt = 20,000 kN/m",
    ]
    pier = rb.Pier.with_deck(**BRIDGE)
    tan = pier.half_width / pier.height
    assert rows["lift-off [g]"] == [f"{tan:.4f}", f"{tan:.4f}", f"{tan * (1 + 5000 / (3000 * 9.81)):.4f}"]
    assert rows["unstable equilibrium, θ/α"][:2] == ["1", "1"]
    assert float(rows["unstable equilibrium, θ/α"][2]) > 1.0
    assert rows["restitution e"] == [f"{pier.restitution:.4f}", f"{pier.restitution:.4f}", "0.9000"]
    assert rows["weight [kN]"] == ["29,430"] * 3
    assert rows["direction"] == ["", "", "to the left"]
    assert not {"settlement at rest [m]", "vertical period [s]"} & set(rows)
    assert page.text.count("not rigid, bending adds") == 3


def test_a_value_that_is_no_number_makes_no_pier_though_an_equal_one_does():
    """True equals 1.0, also as a key."""
    pier = described(rb.Pier(0.2, 1.0))
    assert pier_of({"pier": pier}).p == 1.0
    assert pier_of({"pier": pier | {"p": True}}) is None
    assert pier_of({"pier": pier | {"p": [1.0]}}) is None


BARE, HEAVY = rb.Pier(0.2, 1.0), rb.Pier(0.2, 1.0, mass_t=1000.0)
STIFFNESS = 9810.0 * HEAVY.size / HEAVY.half_width**2
"""That of λ = 1 under the weight of HEAVY, 9810 kN [kN/m]."""


@pytest.mark.parametrize(
    ("device", "place", "over_weight", "in_units"),
    [
        (rb.Damper("friction", f=0.1), "friction damper at each pivot", "f = 0.1", "F = 981 kN"),
        (rb.Damper("friction", f=0.1, at="left"), "friction damper at the left pivot", "f = 0.1", "F = 981 kN"),
        (rb.Damper("friction", f=0.1, at="right"), "friction damper at the right pivot", "f = 0.1", "F = 981 kN"),
        (rb.Damper("friction", f=0.1, at=0.0), "friction damper on the axis", "f = 0.1", "F = 981 kN"),
        (rb.Damper("friction", f=0.1, at=0.4), "friction damper 0.4 m right of the axis", "f = 0.1", "F = 981 kN"),
        (rb.Damper("friction", f=0.1, at=-0.4), "friction damper 0.4 m left of the axis", "f = 0.1", "F = 981 kN"),
        (rb.Damper("viscous", nu=0.1, exponent=0.3), "viscous damper at each pivot", "ν = 0.1, a = 0.3", "C = 100 kN (s/m)^0.3"),
        (rb.Damper("viscous", nu=0.1, exponent=1.0, at="deck"), "viscous damper at the deck", "ν = 0.1, a = 1", "C = 100 kN s/m"),
        (
            rb.Damper("hysteretic", f=0.1, yield_m=0.005), "hysteretic damper at each pivot",
            "f = 0.1, uy = 5 mm, n = 5", "F = 981 kN, uy = 5 mm, n = 5",
        ),
        (
            rb.Tendon(psi=0.1, lam=0.5), "tendon on the axis", "ψ = 0.1, λ = 0.5",
            f"P0 = 981 kN, kt = {0.5 * STIFFNESS:,.0f} kN/m",
        ),
        (
            rb.Stop(gap_m=0.01, lam=2.0, restitution=0.5), "stop at each pivot", "gap = 10 mm, λ = 2, e = 0.5",
            f"gap = 10 mm, k = {2.0 * STIFFNESS:,.0f} kN/m, e = 0.5",
        ),
        (
            rb.Stop(gap_m=0.01, lam=2.0, at="left"), "stop at the left pivot", "gap = 10 mm, λ = 2, e = 1",
            f"gap = 10 mm, k = {2.0 * STIFFNESS:,.0f} kN/m, e = 1",
        ),
        (
            rb.DeckSpring(lam=2.0), "deck spring on both sides", "λ = 2, gap = 0 mm, e = 1",
            f"k = {2.0 * STIFFNESS:,.0f} kN/m, gap = 0 mm, e = 1",
        ),
        (
            rb.DeckSpring(lam=2.0, side="right"), "deck spring on the right", "λ = 2, gap = 0 mm, e = 1",
            f"k = {2.0 * STIFFNESS:,.0f} kN/m, gap = 0 mm, e = 1",
        ),
        (
            rb.DeckSpring(lam=2.0, gap_m=0.02, side="left", restitution=0.7, height_m=3.0),
            "deck spring on the left, 3 m high", "λ = 2, gap = 20 mm, e = 0.7",
            f"k = {2.0 * STIFFNESS:,.0f} kN/m, gap = 20 mm, e = 0.7",
        ),
    ],
)  # fmt: skip
def test_a_device_is_said_with_its_place_and_in_kilonewtons_if_the_mass_is_known(device, place, over_weight, in_units):
    for pier, numbers in ((BARE, over_weight), (HEAVY, in_units)):
        assert device_in_words(pier, device).replace("\u00a0", " ") == f"{place}, {numbers}"


def test_a_base_that_cannot_be_has_no_statics():
    """Change run.json, which may come from anybody."""
    pier = rb.Pier(alpha=0.2, p=1.0)
    base = rb.YieldingBase(beta=30.0, eta=2.5, restraints=(rb.Tendon(psi=0.1, strength=0.2),))
    entry = describe_case(Case("pads", pier, base, {}))
    assert base_of(entry, pier) == base
    for wrong in ({"beta": 0.1}, {"eta": None}, {"spring": "steel"}, {"n": "much"}):
        assert base_of(entry | {"parameters": entry["parameters"] | wrong}, pier) is None


@pytest.mark.parametrize(
    "wrong",
    [
        [{"device": "damper", "kind": "magic"}],
        [{"device": "damper", "kind": "friction", "f": "much"}],
        [3],
        [{"device": "tendon", "psi": -1.0}],
        [{"psi": 0.1}],
        "none",
        [None],
    ],
)
def test_devices_that_cannot_be_are_left_out(wrong):
    """Change run.json, which may come from anybody."""
    pier = rb.Pier(alpha=0.2, p=1.0)
    assert restraints_of({"pier": described(pier), "parameters": {"restraints": wrong}}) == ()
