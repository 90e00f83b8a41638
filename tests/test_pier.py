"""Pier and bases: the relations between their sizes, and what is refused."""

import inspect
import math
from dataclasses import replace
from functools import partial
from types import SimpleNamespace
from typing import get_args

import numpy as np
import pytest
from core_samples import FIG5

from rockbatch.common.errors import InputError, UnknownKey
from rockbatch.motions.motion import Motion
from rockbatch.observers.other_law.observe import by_other_law
from rockbatch.pier import (
    LAWS,
    WITH_EXPONENT,
    Damper,
    DeckSpring,
    ElasticBase,
    FootingBase,
    Part,
    Pier,
    RigidBase,
    SpringLaw,
    Stop,
    Tendon,
    YieldingBase,
    problems,
    static_deflection,
    tilt_over_residual,
    vertical_frequency,
    yield_deflection,
)
from rockbatch.pier.block import unlikely_mass
from rockbatch.pier.devices import doubt as pier_doubt
from rockbatch.pier.frequencies import fastest, rocking_frequency
from rockbatch.pier.plausibility import wrong_restraints
from rockbatch.pier.sizes import unlikely_deck, unlikely_heights, unlikely_inertia
from rockbatch.simulation import run_fixed
from rockbatch.simulation.models import CODES, springs


@pytest.mark.parametrize(
    ("least", "greatest", "problems_of"),
    [
        (0.25, 2.5, lambda share: unlikely_heights(20.0, (), top_m=20.0 * share)),
        (0.005, 100.0, lambda share: unlikely_deck(1000.0, 1000.0 * share, ())),
        (0.01, 5.0, lambda share: unlikely_inertia(100.0, 100.0 * (20.0 * share) ** 2, 20.0, ())),
        (0.03, 1e3, lambda t_m3: unlikely_mass(SimpleNamespace(half_width=2.0, height=10.0, mass_t=320.0 * t_m3), ())),
    ],
)
def test_the_proportions_of_a_pier_are_doubted_beyond_these_bounds(least, greatest, problems_of):
    """The height of the top over the pier's, the mass of a deck over that below it, its radius of gyration over its height, and
    the density of a square block [t/m³]."""
    assert not problems_of(1.001 * least)
    assert not problems_of(0.999 * greatest)
    assert len(problems_of(0.999 * least)) == len(problems_of(1.001 * greatest)) == 1


@pytest.mark.parametrize(("p", "size"), [(1.0, 7.36), (0.35, 60.1)])
def test_size_of_the_papers_blocks(p, size):
    """R0 = 7.36 m for p = 1 rad/s and 60.1 m for p = 0.35 rad/s (Figs. 5 and 7): half a unit of the last digit."""
    assert Pier(0.13, p).size == pytest.approx(size, abs=0.05 if size > 10 else 0.005)


@pytest.mark.parametrize("mu", [0.8, 3.0, 6.0])
def test_size_and_frequency_parameter_are_two_names_of_one_thing(mu):
    """p² = μ/(1+μ) g/R0, there and back; I0 = M R0²/μ. Rounding only."""
    pier = Pier.from_size(0.3, 12.0, mu)
    assert pier.p**2 == pytest.approx(mu / (1 + mu) * pier.gravity / 12.0, rel=1e-14)
    assert pier.size == pytest.approx(12.0, rel=1e-14)
    assert math.hypot(pier.half_width, pier.height) == pytest.approx(12.0, rel=1e-14)
    assert math.atan2(pier.half_width, pier.height) == pytest.approx(0.3, rel=1e-14)
    assert pier.inertia == pytest.approx(144.0 / mu, rel=1e-14)


def test_rectangle_has_the_inertia_of_a_rectangle():
    """I0/M = (w² + h²)/12 about the centre."""
    pier = Pier.rectangle(width_m=2.0, height_m=9.0)
    assert pier.inertia == pytest.approx((4.0 + 81.0) / 12.0, rel=1e-14)
    assert (2 * pier.half_width, 2 * pier.height) == pytest.approx((2.0, 9.0), rel=1e-14)


@pytest.mark.parametrize("alpha", [0.05, 0.2, 0.9])
def test_least_beta_is_where_the_static_pier_loses_its_stiffness(alpha):
    """g h = ω_v² b²; and the core agrees: just above it a nudge is borne, however softly, just below it topples."""
    pier = Pier(alpha, 1.0)
    omega_v = pier.least_beta * pier.p
    assert omega_v**2 * pier.half_width**2 == pytest.approx(pier.gravity * pier.height, rel=1e-12)
    nudge = Motion("nudge", 0.05, np.r_[0.0, 1e-4, np.zeros(600)])
    peaks = []
    for factor in (1.1, 0.9):
        base = ElasticBase(factor * pier.least_beta)
        peaks.append(run_fixed(pier, base, nudge, 8, 0.0).theta_max)
    assert peaks[0] < 1e-2 * alpha < peaks[1]


def test_every_impossible_value_is_named_with_its_limit():
    with pytest.raises(InputError) as caught:
        YieldingBase(-3.0, 1.5, "second-order", "free", eta=0.9, spring="clay", n=0.5)
    names = ["epsilon", "eta", "n", "kinematics", "flight", "spring", "beta"]
    assert [problem.split(" ")[0] for problem in caught.value.messages] == names
    (problem,) = problems(FIG5, ElasticBase(3.0))
    assert str(problem).startswith("beta = 3: ")
    assert f"{FIG5.least_beta:.4g}" in str(problem)


@pytest.mark.parametrize(
    ("kind", "placed"),
    [
        (Pier, "alpha p mu gravity mass_t top_m deck_over_columns deck_height_m"), (RigidBase, "restitution restraints"),
        (ElasticBase, "beta epsilon kinematics flight"), (YieldingBase, "beta epsilon kinematics flight spring n"),
        (Damper, "kind f nu yield_m exponent at"), (Tendon, "psi lam strength at"), (Stop, "gap_m lam restitution at"),
        (DeckSpring, "lam gap_m restitution side height_m"),
    ],
)  # fmt: skip
def test_what_is_rarely_given_goes_by_its_name(kind, placed):
    parameters = inspect.signature(kind).parameters.values()
    assert [each.name for each in parameters if each.kind is each.POSITIONAL_OR_KEYWORD] == placed.split()


@pytest.mark.parametrize(
    "base",
    [RigidBase(), RigidBase(0.0), RigidBase(1.0), ElasticBase(6.0), YieldingBase(50.0, eta=1.01, n=1.0)],
)
def test_possible_bases_have_no_problems(base):
    assert problems(FIG5, base) == []


@pytest.mark.parametrize("make", [RigidBase, lambda **keys: ElasticBase(50.0, **keys)])
def test_flight_is_followed_unless_a_base_says_stop_and_its_limit_is_a_height(make):
    assert (make().flight, make().flies, make().flight_limit_mm) == ("guided", True, 5.0)
    assert not make(flight="stop").flies
    assert problems(FIG5, make(flight="stop", flight_limit_mm=20.0)) == []
    with pytest.raises(InputError, match=r'^flight = "free": must be "guided" or "stop"'):
        make(flight="free")
    for height in (0.0, -1.0, math.nan):
        with pytest.raises(InputError, match=r"^flight_limit_mm = "):
            make(flight_limit_mm=height)


def test_a_base_tells_what_it_can_do():
    """Springs deflect, yielding ones settle, those of Bouc–Wen ratchet, landings on undamped ones have an ε or ask for tension,
    and friction may hold a pier at a tilt."""
    bouc_wen = YieldingBase(50.0, eta=3.0)
    epp = replace(bouc_wen, spring="epp")
    told = [(base.on_springs, base.yields, base.ratchets, base.has_residual) for base in (
        RigidBase(), ElasticBase(50.0), bouc_wen, epp,
    )]  # fmt: skip
    assert told == [
        (False, False, False, False), (True, False, False, False), (True, True, True, True), (True, True, False, True),
    ]  # fmt: skip
    assert not replace(bouc_wen, spring="hardening").ratchets
    impacts = {
        RigidBase(): (False, False),
        ElasticBase(50.0): (True, False),
        bouc_wen: (True, False),
        ElasticBase(50.0, zeta=0.1): (False, False),
        ElasticBase(50.0, impact="housner"): (False, True),
        replace(bouc_wen, impact="housner"): (False, True),
        replace(epp, impact="housner"): (False, True),
    }
    assert {base: (base.has_epsilon, base.asks_tension) for base in impacts} == impacts
    assert by_other_law(bouc_wen) == epp
    assert by_other_law(epp) is by_other_law(RigidBase()) is None
    holds = {
        Damper("friction", f=0.05): True,
        Damper("hysteretic", f=0.05, yield_m=0.01): True,
        Damper("viscous", nu=0.5): False,
        Tendon(psi=0.1): False,
    }
    for restraint, held in holds.items():
        assert RigidBase(restraints=(restraint,)).has_residual == held
        assert ElasticBase(50.0, restraints=(restraint,)).has_residual == held


def test_a_rigid_base_is_the_limit_of_stiff_springs():
    stiff = [*(ElasticBase(beta, confirm=("beta",)) for beta in (1e3, 1e6, 1e9)), RigidBase()]
    frequencies, deflections = ([of(FIG5, base) for base in stiff] for of in (vertical_frequency, static_deflection))
    assert np.diff(np.log10(frequencies[:3])) == pytest.approx([3.0, 3.0])
    assert np.diff(np.log10(deflections[:3])) == pytest.approx([-6.0, -6.0])
    assert (frequencies[3], deflections[3]) == (math.inf, 0.0)


@pytest.mark.parametrize(
    ("low", "high", "make"),
    [
        (0.0, 1.0, RigidBase), (0.0, 1.0, lambda x: RigidBase(flexural_damping=x)),
        (0.0, 1.0, lambda x: ElasticBase(50.0, x)), (0.0, 1.0, lambda x: ElasticBase(50.0, zeta=x)),
        (1.000001, 1e15, lambda x: YieldingBase(50.0, eta=x, spring="epp", confirm=("eta",))),
        (1.0, 1000.0, lambda x: YieldingBase(50.0, eta=3.0, n=x)),
        (0.0, 10.0, lambda x: RigidBase(restraints=(Damper("friction", f=x),))),
        (0.1, 2.0, lambda x: RigidBase(restraints=(Damper("viscous", nu=0.1, exponent=x),))),
        (0.1, 2.0, lambda x: ElasticBase(50.0, restraints=(Damper("viscous", nu=0.1, exponent=x),))),
        (0.0, 10.0, lambda x: RigidBase(restraints=(Tendon(psi=x),))),
        (0.1, 1.0, lambda x: RigidBase(restraints=(Stop(gap_m=0.1, lam=1.0, restitution=x),))),
    ],
)  # fmt: skip
def test_what_is_possible_ends_at_its_bounds(low, high, make):
    assert problems(FIG5, make(low)) == problems(FIG5, make(high)) == []
    for value in (low - 1e-8, high * 1.001, math.nan):
        with pytest.raises(InputError) as caught:
            make(value)
        assert len(caught.value.messages) == 1, value


@pytest.mark.parametrize("width", [-4.0, 0.0, 1e16, math.nan])
def test_no_confirmation_makes_an_impossible_width_of_parts_possible(width):
    with pytest.raises(InputError, match=r"^width_m = "):
        Pier.of_parts(width, [Part(100.0, 10.0, 4000.0)], confirm=("width_m",))


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [("alpha", 1e-4, 1.57079), ("p", 1e-3, 1e3), ("mu", 1e-3, 1e12), ("gravity", 1e-3, 1e3)],
)
def test_a_pier_far_from_any_that_exists_is_possible_up_to_its_bounds(name, low, high):
    def pier(value):
        return Pier(**{"alpha": 0.2, "p": 1.0, name: value}, confirm=(name,))

    assert [getattr(pier(value), name) for value in (low, high)] == [low, high]
    for value in (0.999 * low, 1.001 * high, math.nan):
        with pytest.raises(InputError, match=f"^{name} = "):
            pier(value)


@pytest.mark.parametrize(
    ("beta", "words"), [(math.nan, "above"), (-1.0, "above"), (math.inf, "1e+15 at most"), (2e15, "1e+15")]
)
def test_a_stiffness_that_is_no_number_is_refused(beta, words):
    with pytest.raises(InputError) as caught:
        ElasticBase(beta)
    (problem,) = caught.value.messages
    assert words in problem


def test_a_pier_reports_all_its_mistakes_at_once():
    with pytest.raises(InputError) as caught:
        Pier(alpha=11.5, p=-1.0, mu=0.0, gravity=math.nan)
    named = [message.partition(" = ")[0] for message in caught.value.messages]
    assert named == ["alpha", "p", "mu", "gravity"]
    assert "degrees" in str(caught.value)


def test_deflections_and_frequency_follow_from_each_other():
    soft, elastic = YieldingBase(40.0, eta=2.5), ElasticBase(40.0)
    assert vertical_frequency(FIG5, soft) == 40.0 * FIG5.p
    assert static_deflection(FIG5, soft) * vertical_frequency(FIG5, soft) ** 2 == pytest.approx(FIG5.gravity, rel=1e-14)
    assert yield_deflection(FIG5, soft) == pytest.approx(2.5 * static_deflection(FIG5, soft), rel=1e-14)
    assert yield_deflection(FIG5, elastic) == static_deflection(FIG5, elastic)


@pytest.mark.parametrize("zeta", [0.0, 0.3, 0.9, 1.0])
@pytest.mark.parametrize("alpha", [0.2, 1.2])
@pytest.mark.parametrize(("base", "squared"), [(ElasticBase, 1.0), (FootingBase, 1.0 / 3.0)])
def test_the_fastest_rate_is_the_largest_root_of_heave_and_rocking_in_full_contact(alpha, zeta, base, squared):
    """By NumPy's roots, per unit mass: two springs ω_v²/2 and two dashpots ζ ω_v at ±b; the weight tips by g h.

    A bed of the same stiffness from −b to b has the mean square b²/3 of its places in the place of b².
    """
    pier, omega = Pier(alpha, 1.0), 20.0
    b2, h = squared * pier.half_width**2, pier.height
    heave = np.roots([1.0, 2.0 * zeta * omega, omega**2])
    rocking = np.roots([pier.inertia + h**2, 2.0 * zeta * omega * b2, omega**2 * b2 - pier.gravity * h])
    assert fastest(pier, base(omega, zeta=zeta)) == pytest.approx(np.abs([*heave, *rocking]).max(), rel=1e-6)
    undamped = (omega**2 * b2 - pier.gravity * h) / (pier.inertia + h**2)
    assert rocking_frequency(pier, base(omega, zeta=zeta)) ** 2 == pytest.approx(undamped, rel=1e-12)
    assert rocking_frequency(pier, base(0.1, zeta=zeta)) == 0.0  # it topples


def test_the_base_tilts_less_than_the_residual_the_nearer_to_toppling():
    """THEORY.md, eq. 20; at the least β that carries the pier in rotation, whatever tilt is left topples it."""

    def at(omega_v):
        return tilt_over_residual(FIG5.gravity, FIG5.height, FIG5.half_width, omega_v)

    assert at(FIG5.least_beta * FIG5.p) == pytest.approx(0.0, abs=1e-12)
    assert at(2.0 * FIG5.least_beta * FIG5.p) == pytest.approx(0.75, rel=1e-12)


def test_every_law_stands_in_both_tables_and_one_that_creeps_names_one_that_does_not():
    assert set(get_args(SpringLaw)) == set(LAWS) == set(CODES) - {"elastic"}
    for spring, law in LAWS.items():
        points = ((1.0, 1.0), (3.0, 2.0)) if law.has_points else ()
        base = YieldingBase(40.0, eta=3.0, spring=spring, backbone=points)
        other = by_other_law(base)
        assert other is None or not other.ratchets
        assert base.ratchets == (other is not None) == (law.creep is not None)
        model = springs(Pier(0.13, 0.38), base)
        assert (model.law, model.creep > 0.0) == (CODES[spring], base.ratchets)
        assert base.has_exponent == law.has_exponent == (spring in WITH_EXPONENT)
        assert base.has_points == law.has_points == (model.backbone is not None)


SQUARE = Pier.rectangle(6.0, 30.0, mass_t=1000.0)
FRAME = Pier.frame(Pier.rectangle(1.0, 7.0, mass_t=20.0), 4, 200.0)
TALL = Pier.with_deck(8.0, 30.0, 2000.0, 700.0)
RUBS, FEW, BRACED = (
    Damper("friction", f=0.1),
    "damper: two places of friction at most",
    Damper("viscous", nu=1.0, brace=10.0),
)
AT_DECK = "columns: devices at the deck of a rocking frame are not solved"


@pytest.mark.parametrize(
    ("devices", "said"),
    [
        ((RUBS,), []), ((RUBS, RUBS), [FEW]), ((replace(RUBS, at="left"), replace(RUBS, at=1.0)), []),
        ((RUBS, replace(RUBS, at="left")), [FEW]), ((RUBS, RUBS, Damper("viscous", nu=1.0)), [FEW]),
        ((BRACED,), []), ((replace(BRACED, exponent=0.9),), []), ((Damper("viscous", nu=1.0, exponent=1.05),), []),
        ((Damper("hysteretic", f=0.1, yield_m=0.01, brace=10.0),), []), ((Damper("viscous", nu=1.0, at="deck"),), []),
        ((Tendon(0.1, at=-6.0),), []), ((Tendon(0.1, at=6.01),), ["tendon: at = 6.01: must be within the base's width either"]),
        ((DeckSpring(1.0, gap_m=0.1, side="left"),), []),
    ],
)  # fmt: skip
def test_what_is_impossible_of_devices_under_a_pier_is_said_once(devices, said):
    found = wrong_restraints(SQUARE, devices)
    assert len(found) == len(said)
    assert all(str(sentence).startswith(start) for sentence, start in zip(found, said, strict=True)), found


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: replace(RUBS, f=-1.0), ["damper: f = -1: its force over the weight must be within 0..10"]),
        (
            lambda: replace(BRACED, exponent=1.05),
            ["damper: brace = 10: with one the exponent must be 1 at most; leave the brace out"],
        ),
        (lambda: replace(BRACED, brace=0.0), ["damper: brace = 0: must be"]),
        (lambda: replace(RUBS, brace=10.0), ["damper: brace = 10: friction on a brace is a hysteretic damper"]),
        (lambda: replace(RUBS, at="deck"), ['damper: at = "deck": friction at the deck']),
        (
            lambda: Damper("viscous", nu=1.0, at="top"),
            ['damper: at = "top": must be "left", "right", "deck" or an offset in m'],
        ),
        (lambda: Tendon(0.1, at="deck"), ['tendon: at = "deck": must be "left", "right" or an offset in m']),
        (
            lambda: replace(RUBS, nu=1.0, yield_m=0.1),
            ["damper: nu = 1: is not", "damper: yield_m = 0.1: is not of a friction damper"],
        ),
        (
            lambda: replace(RUBS, kind="oil"),
            ['damper: kind = "oil": must be "friction" or "hysteretic" or "viscous"'],
        ),
        (
            lambda: Tendon(0.3, strength=0.3),
            ["tendon: strength = 0.3: its yield force over the weight must be above its prestress, 0.3"],
        ),
        (lambda: DeckSpring(1.0, side="top"), ['deck_spring: side = "top": must be']),
        (lambda: ElasticBase(50.0, kinematics="large"), ['kinematics = "large": must be "first-order" or "finite"']),
        (
            lambda: YieldingBase(50.0, eta=0.5, spring="bilinear"),
            ["eta = 0.5: the springs cannot", 'spring = "bilinear": must'],
        ),
        (lambda: ElasticBase(50.0, epsilon=0.5, zeta=0.1), ["epsilon = 0.5: zeta is given too"]),
        (lambda: RigidBase(friction=35.0), ["friction = 35: more than 2 as a coefficient"]),
        (lambda: RigidBase(restitution=0.1), ["restitution = 0.1: less than 0.3 of the angular velocity"]),
        (lambda: Pier(0.2, 0.001), ["p = 0.001: less than 0.1 rad/s"]),
        (lambda: Pier(0.2, 1.0, mass_t=2e6), ["mass_t = 2e+06: more than 1e+06 t"]),
        (lambda: Pier.rectangle(600.0, 3000.0), ["width_m = 600: more than 400 m", "height_m = 3000: more than 400 m"]),
        (
            lambda: Damper.friction(TALL, force_kN=2.0),
            ["damper: f = 7.55087e-05: it has 0.0076 % of the pier's weight"],
        ),
        (lambda: Tendon.of(TALL, prestress_kN=10.0), ["tendon: psi = 0.000377544: its prestress is 0.038 %"]),
        (
            lambda: Stop.of(TALL, gap_mm=0.1, stiffness_kN_m=1e6),
            ["stop: gap_m = 0.0001: it is met after 0.1 mm already"],
        ),
        (lambda: ElasticBase.from_stiffness(TALL, 1e9), ["stiffness_kN_m = 1e+09: the pier's weight presses"]),
        (lambda: YieldingBase.from_stiffness(TALL, 2e6, 4e6), ["yield_kN = 4e+06: 302 times what the support carries"]),
        (
            lambda: YieldingBase.from_stiffness(TALL, 2e6, 4e4, eta=2.5),
            ["yield_kN = 40000: eta is given, too, which sets the same quantity"],
        ),
    ],
)
def test_what_cannot_be_or_is_odd_is_said_where_it_is_made(made, said):
    with pytest.raises(InputError) as caught:
        made()
    found = caught.value.messages
    assert len(found) == len(said)
    assert all(str(sentence).startswith(start) for sentence, start in zip(found, said, strict=True)), found


def test_what_is_odd_is_made_when_it_is_confirmed():
    assert RigidBase(friction=35.0, confirm=["friction"]).friction == 35.0
    assert Pier(0.2, 0.001, confirm=("p",)) == replace(Pier(0.2, 1.0), p=0.001, confirm=("p",))
    assert Damper.friction(TALL, force_kN=2.0, confirm=("f",)).f == pytest.approx(2.0 / (2700.0 * 9.81))
    assert ElasticBase.from_stiffness(TALL, 1e9, confirm=("stiffness_kN_m",)).beta > 1000.0


def test_a_misspelt_confirmation_is_refused_on_every_base():
    bases = (
        partial(RigidBase),
        partial(ElasticBase, 50.0),
        partial(YieldingBase, 50.0, eta=3.0),
        partial(FootingBase, 50.0),
    )
    for base in bases:
        assert base(confirm=("friction", "beta")).confirm == ("friction", "beta")
        with pytest.raises(UnknownKey, match='did you mean "friction"') as refused:
            base(confirm=("fricton",))
        assert [(problem.key, problem.value) for problem in refused.value.problems] == [("confirm", "fricton")]


def test_the_columns_of_a_frame_are_no_frames():
    light = Pier.frame(Pier.rectangle(1.0, 7.0, mass_t=20.0), 4, 1e-7, confirm=("deck_mass_t",))
    assert light.mu == pytest.approx(3.0)
    with pytest.raises(InputError, match="the columns of a frame are solid rectangles"):
        Pier.frame(light, 2, 100.0)


@pytest.mark.parametrize(("share", "doubtful"), [(0.249, True), (0.251, False), (2.49, False), (2.51, True)])
def test_a_spring_at_the_deck_is_at_a_quarter_to_two_and_a_half_heights_of_the_pier(share, doubtful):
    spring = DeckSpring(0.2, height_m=share * 2.0 * FIG5.height)
    doubt = pier_doubt(FIG5, spring)
    assert (doubt is not None and doubt.name == "height_m") == doubtful


def test_devices_of_a_frame_are_at_the_feet_of_its_columns():
    for device in (DeckSpring(1.0), Damper("viscous", nu=1.0, at="deck")):
        assert [str(problem).startswith(AT_DECK) for problem in wrong_restraints(FRAME, (RUBS, device))] == [True]
    assert wrong_restraints(FRAME, (RUBS,)) == []
