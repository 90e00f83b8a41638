"""Laws of springs one by one: branches, switching points, deflection and work, against quadrature and by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest
from core_samples import FIG5
from scipy.integrate import quad

from rockbatch.core.springs import backbone, laws
from rockbatch.core.springs.events import Side
from rockbatch.core.springs.free_vibration import _climb
from rockbatch.core.springs.model import Contact, State, Supports
from rockbatch.core.springs.transitions import handle
from rockbatch.core.types import CONTACT_LEFT, CONTACT_RIGHT, SPRING_LEFT, SPRING_RIGHT, Ground, Moment
from rockbatch.pier import ElasticBase, YieldingBase
from rockbatch.pier.laws import LAWS as LAW_OF_PIERS
from rockbatch.pier.laws import Law
from rockbatch.simulation import springs

LAWS = laws.CODES


POINTS = ((1.0, 1.0), (2.0, 1.7), (3.0, 2.0), (4.0, 2.0))
"""Corners at 1, 1.7 and 2; beyond the last one the spring is plastic."""


def base_of(law="bouc-wen", **more):
    if law == "elastic":
        return ElasticBase(50.0, **more)
    points = {"backbone": POINTS} if law == "backbone" else {}
    return YieldingBase(50.0, eta=2.5, spring=law, **points, **more)


def model(law="bouc-wen", **more):
    return springs(FIG5, base_of(law, **more))


def test_a_spring_that_yields_loses_the_share_z_to_the_n_of_its_stiffness():
    """Powers are right to 8 units in the last place for n up to 3, and to 25 for n up to 10."""
    for n in (5.0, 3.0, 2.5):
        m = model(n=n)
        for z in (-0.2, -0.7, -1.0):
            assert laws.z_rate(m, z, -0.3, 1.0) == pytest.approx(
                -0.3 * m.stiffness * (1.0 - (-z) ** n), abs=25 * math.ulp(0.3 * m.stiffness)
            )
            assert laws.z_rate(m, z, -0.3, 0.0) == pytest.approx(-0.3 * m.stiffness)
        assert laws.z_rate(m, -1.2, -0.3, 1.0) == 0.0  # it ends at its capacity
        assert laws.z_rate(m, 0.1, 0.3, 1.0) == pytest.approx(0.3 * m.stiffness)
    assert [laws.within_yield(None, z, yields) for z, yields in ((-1.2, 1.0), (-1.2, 0.0), (-0.4, 1.0))] == [
        -1.0,
        -1.2,
        -0.4,
    ]
    assert laws.within_yield(model("backbone").backbone, -1.2, 1.0) == -1.2


@pytest.mark.parametrize(
    ("law", "pressed", "curved", "creeps", "signs", "leaves"),
    [
        ("elastic", 0.0, False, False, (0.0, -1.0), False), ("bouc-wen", 1.0, True, True, (1.0, -1.0), False),
        ("epp", 0.0, False, False, (0.0, -1.0), True), ("hardening", 0.0, True, False, (0.0, -1.0), True),
        ("backbone", 0.0, False, False, (0.0, -1.0), True),
    ],
)  # fmt: skip
def test_what_each_law_does(law, pressed, curved, creeps, signs, leaves):
    """Bouc–Wen is on the branch of its velocity's sign; the three with a yield point leave the elastic one there."""
    code, m, remembers = LAWS[law], model(law), law in ("hardening", "backbone")
    assert laws.yields_when_pressed(code) == pressed
    assert (bool(laws.yields_at_first(code)), model(law).creep > 0.0) == (curved, creeps)
    assert laws.limited(code) == (law != "elastic")
    assert tuple(laws.kept_sign(code, 1.0, yields) for yields in (0.0, 1.0)) == signs
    assert laws.kept_sign(code, 0.0, 1.0) == laws.kept_sign(code, 0.0, 0.0) == 0.0  # off its spring
    assert (laws.may_yield(code, 0.0), laws.may_yield(code, 1.0)) == (leaves, False)
    assert laws.yield_point(code, -0.6, -0.8) == (-0.8 if remembers else -1.0)
    assert laws.yield_point(code, -0.6, -0.4) == (-0.6 if remembers else -1.0)
    assert laws.after_switch(m, 0.0, -1.0, -0.99) == (1.0, -1.0 if leaves else -0.99)
    assert laws.after_switch(m, 1.0, -0.6, -0.7) == (0.0, -0.7)


@pytest.mark.parametrize(
    ("law", "fast", "below"),
    [
        ("elastic", 0.5, 0.5),
        ("bouc-wen", 1.0, 1.0),
        ("epp", 0.5, 1.0),
        ("hardening", 0.5, 1.0),
        ("backbone", 0.5, 1.0),
    ],
)
def test_a_jump_of_the_velocity_unloads_a_spring_or_presses_it_along_its_law(law, fast, below):
    """0.5 stands for the branch it was on: upwards it unloads, downwards it yields at once or from its yield point on."""
    code, m = LAWS[law], model(law)._replace(rest=1e-3)
    assert laws.branch_after_jump(m, 0.5, -1.1, -1.0, 1.0) == 0.0
    assert laws.branch_after_jump(m, 0.5, -1.1, -1.0, -1.0) == fast
    assert laws.branch_after_jump(m, 0.5, -1.1, -1.1, -1.0) == below
    for still in (1e-3, -1e-3, 0.0):
        assert laws.branch_after_jump(m, 0.5, -1.1, -1.2, still) == 0.5
    plain, damped = model(law), model(law, zeta=0.05)
    for velocity in (-1.0, 1.0):
        assert laws.branch_of_landing(plain, velocity) == laws.yields_when_pressed(code)
        assert laws.branch_of_landing(damped, velocity) == (laws.yields_when_pressed(code) if velocity < 0.0 else 0.0)


@pytest.mark.parametrize("n", [5.0, 3.0, 2.5])
@pytest.mark.parametrize("law", [law for law in LAWS if law != "backbone"])
def test_first_loading_and_plastic_work_are_integrals_over_the_loss_of_stiffness(law, n):
    """δ = ∫ ds/(1 − loss), of a law that yields at first; what is dissipated ∫ x d(u − x) along the inelastic branch."""
    m = model(law, **({"n": n} if law in ("bouc-wen", "hardening") else {}))
    base = base_of(law, **({} if law == "elastic" else {"n": n}))
    yields_at_first = laws.yields_at_first(LAWS[law])

    def stiffness(force):
        return 1.0 - yields_at_first * laws.stiffness_loss(m, force)

    for force in (0.1, 0.6, 0.95):
        curve = quad(lambda s: 1.0 / stiffness(s), 0.0, force, epsabs=1e-14, epsrel=1e-13)[0]
        assert base.first_loading.deflection(force) == pytest.approx(curve, rel=1e-11)
        assert base.first_loading.force(np.array([curve])) == pytest.approx([force], rel=1e-11)
        assert base.first_loading.tangent(np.array(force)) == pytest.approx(stiffness(force), rel=1e-11)
        reloads = laws.yields_when_pressed(LAWS[law]) or (law == "hardening" and force > 0.5)
        point = laws.yield_point(LAWS[law], 0.0, -0.5)
        assert laws.give(m, force, point) == pytest.approx(1.0 / stiffness(force) if reloads else 1.0)
    assert m.level == pytest.approx(
        -m.yield_deflection * base.first_loading.deflection(0.5 * m.gravity / m.yield_force)
    )
    if yields_at_first:
        for start, end in ((0.0, 0.3), (0.3, 0.9), (0.5, 0.55), (0.1, 0.99)):
            plastic = quad(lambda x: x**n / (1.0 - x**n), start, end, epsabs=1e-14)[0] * m.yield_deflection
            work = quad(lambda x: x * x**n / (1.0 - x**n), start, end, epsabs=1e-14)[0] * m.yield_deflection
            assert laws.plastic_work(m, -start, -end, plastic) == pytest.approx(work, rel=1e-8)
        assert laws.plastic_work(m, -1.0, -1.0, 0.02) == 0.02  # at its capacity all of it
        assert laws._elastic_share(1.0, m.exponent) == pytest.approx(1.0 / n)


def test_a_backbone_has_a_branch_beyond_each_corner():
    m = model("backbone")
    assert [backbone.branch_at(m.backbone, force) for force in (0.0, 0.99, 1.0, 1.69, 1.7, 1.9, 2.0)] == [
        0,
        0,
        1,
        1,
        2,
        2,
        3,
    ]
    assert [backbone.corner_beyond(m.backbone, branch) for branch in (0.0, 1.0, 2.0, 3.0)] == [1.0, 1.7, 2.0, math.inf]
    rates = [laws.z_rate(m, -1.8, -0.3, branch) for branch in (0.0, 1.0, 2.0, 3.0)]
    assert rates == pytest.approx([-0.3 * m.stiffness * share for share in (1.0, 0.7, 0.3, 0.0)], rel=1e-15)
    assert laws.z_rate(m, -2.0, -0.3, 3.0) == 0.0
    assert backbone.greatest(m.backbone) == 2.0
    assert backbone.greatest(springs(FIG5, replace(base_of("backbone"), backbone=POINTS[:3])).backbone) == math.inf
    assert [laws.branch_at_first(m, z) for z in (-0.9, -1.0, -1.8)] == [0.0, 1.0, 2.0]
    assert laws.after_switch(m, 0.0, -1.8, -1.7999) == (2.0, -1.8)
    assert laws.branch_after_jump(m, 0.0, -1.8, -1.8, -1.0) == 2.0
    assert [laws.give(m, force, -1.2) for force in (1.1, 1.5, 1.8)] == pytest.approx([1.0, 1.0 / 0.7, 1.0 / 0.3])
    assert laws.plastic_work(m, -1.0, -1.7, 0.02) == pytest.approx(1.35 * 0.02)
    assert laws.plastic_work(m, -2.0, -2.0, 0.02) == pytest.approx(2.0 * 0.02)


@pytest.mark.parametrize(("contact_event", "side"), [(CONTACT_LEFT, "left"), (CONTACT_RIGHT, "right")])
def test_a_corner_sets_the_force_and_goes_on_to_the_next_branch(contact_event, side):
    """The event of a pressed spring's contact, since it cannot separate; the yield point is of its unloading and stays."""
    m, supports = model("backbone"), Supports(0.0, 0.0, -1.2, -1.2)
    now = Moment(State(-0.1, 0.0, -0.3, 0.0, -1.69999999, -1.69999999), Contact(1.0, 1.0, 1.0, 1.0, 0.0), supports)
    after, kind = handle(m, now, contact_event, Ground(0.0, 0.0, 0.0, 0.0))
    other = "right" if side == "left" else "left"
    assert kind == (SPRING_LEFT if side == "left" else SPRING_RIGHT)
    assert getattr(after.y, f"z_{side}") == -1.7
    assert getattr(after.contact, f"{side}_yields") == 2.0
    assert (getattr(after.y, f"z_{other}"), getattr(after.contact, f"{other}_yields")) == (-1.69999999, 1.0)
    assert after.supports == supports


def test_the_energy_to_turn_a_pier_on_a_backbone_is_bounded_below():
    """Against 1e5 parts of the same loading, for targets on every slope: at most it, by no more than 2 %."""
    base = replace(base_of("backbone"), eta=1.15)  # at rest below the first corner, alone beyond the second
    m = springs(FIG5, base)
    load, b = m.gravity, m.half_width
    static, curve = 0.5 * load / m.yield_force, base.first_loading
    x = np.linspace(0.0, 1.0, 100_001)
    deflections = np.array([curve.deflection(force) for force in static * (1.0 + x)])
    theta = 0.5 * m.yield_deflection * (deflections - deflections[0] + static * x) / b
    moment = load * (b * x - m.height * theta)
    work = np.concatenate(([0.0], np.cumsum(0.5 * (moment[1:] + moment[:-1]) * np.diff(theta))))
    for share in (0.2, 0.5, 0.9, 0.999):
        target = share * theta[-1]
        exact = np.interp(target, theta, work)
        assert 0.98 * exact <= _climb(m, 0.0, target, load, -1.0) <= exact * (1.0 + 1e-9)


def test_a_switching_point_is_where_the_velocity_reverses_or_at_the_yield_point():
    """Positive on the branch: of a spring that keeps the sign of its velocity that velocity, of others what is left to yield."""
    side = Side(0.0, 0.3, 5.0, -0.4, 0.7, 0.0, 0.0, -0.6)
    unloading, yielding = side, side._replace(yields=1.0)
    assert laws.switching_point(LAWS["bouc-wen"], unloading, 0.7, 5.0) == (0.3, 5.0)
    assert laws.switching_point(LAWS["bouc-wen"], yielding, 0.7, 5.0) == (-0.3, -5.0)
    assert laws.switching_point(LAWS["elastic"], unloading, 0.7, 5.0) == (1.0, 0.0)
    for law in (LAWS["epp"], LAWS["hardening"], LAWS["backbone"]):
        assert laws.switching_point(law, unloading, 0.7, 5.0) == pytest.approx((0.2, 0.7))
        assert laws.switching_point(law, yielding, 0.7, 5.0) == (-0.3, -5.0)


def test_a_law_that_lacks_an_entry_cannot_be_written():
    """Nor can one of another name in one of the tables than in the other: tests/simulation/test_adding_a_law.py."""
    whole = laws.LAWS["hardening"]._asdict()
    for name in whole:
        with pytest.raises(TypeError, match=name):
            laws.Law(**{entry: value for entry, value in whole.items() if entry != name})
    whole = vars(LAW_OF_PIERS["hardening"])
    for name in whole:
        with pytest.raises(TypeError, match=name):
            Law(**{entry: value for entry, value in whole.items() if entry != name})
