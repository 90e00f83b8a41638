"""A dimensional proof of the equations: every scalar function takes quantities with units and gives the right ones.

The kernels run as plain Python here, with pint's quantities in place of floats. A term in the wrong dimension, or a
factor too few, cannot be added; and every argument given in a wrong unit is noticed.
"""

from types import ModuleType

import pint
import pytest
from numba.core.registry import CPUDispatcher

from rockbatch.core import creep, equations, events, forces, impact, laws, trigonometry
from rockbatch.core.restrained import elements
from rockbatch.core.restrained.elements import FRICTION, TENDON, Element
from rockbatch.core.rigid import equations as rigid
from rockbatch.core.types import BOUC_WEN, ELASTIC, EPP, Block, Contact, Geometry, Ground, Rocking, Springs, State

U = pint.UnitRegistry()
M, S, RAD, ONE = U.metre, U.second, U.radian, U.dimensionless
SPEED, ACCELERATION, JERK = M / S, M / S**2, M / S**3

UNITS = {  # of the fields, by the tuples' own comments
    Springs: (M, M, M**2, ACCELERATION, M, 1 / M, ACCELERATION, ONE, 1 / S),
    State: (M, RAD, SPEED, RAD / S, ONE, ONE),
    Ground: (ACCELERATION, JERK, ACCELERATION, JERK),
    Geometry: (M,) * 12,
    Block: (RAD, 1 / S, ACCELERATION, ONE),
    Element: (ONE, M, M, ACCELERATION, 1 / S**2, ACCELERATION / SPEED, ONE, ACCELERATION, M, SPEED),
}
RATES = (SPEED, RAD / S, ACCELERATION, RAD / S**2, 1 / S, 1 / S)

PIER = (1.5, 7.2, 18.0, 9.81, 0.01, 100.0, 14.7, 0.1, 1.9)
MOVING = (-0.004, 0.02, -0.01, 0.15, -0.3, -0.6)
SHAKING = (2.0, -30.0, -1.0, 12.0)
BLOCK = (0.2, 1.0, 9.81, 0.9)

BOTH = Contact(1.0, 1.0, 1.0, 0.0, 0)
CONTACTS = [
    pytest.param(BOTH, id="both"),
    pytest.param(Contact(1.0, 0.0, 1.0, 0.0, 0), id="left"),
    pytest.param(Contact(0.0, 1.0, 0.0, 0.0, 0), id="right"),
    pytest.param(Contact(0.0, 0.0, 0.0, 0.0, 0), id="flight"),
    pytest.param(Contact(0.0, 1.0, 0.0, 1.0, -1), id="left-held"),
    pytest.param(Contact(1.0, 0.0, 1.0, 0.0, 1), id="right-held"),
]
KINEMATICS = pytest.mark.parametrize("finite", [None, True], ids=["first-order", "finite"])
DAMPED = pytest.mark.parametrize("damped", [None, True], ids=["undamped", "damped"])
LAWS = pytest.mark.parametrize("law", [ELASTIC, BOUC_WEN, EPP], ids=["elastic", "bouc-wen", "epp"])


@pytest.fixture(autouse=True)
def plain_python(monkeypatch):
    """All kernels of these modules as the Python functions they were written as.

    A lever that is absent is written as 0.0; an exact zero has every dimension, so it gets that of its neighbours.
    """
    modules: tuple[ModuleType, ...] = (laws, creep, equations, impact, events, trigonometry, rigid, forces, elements)
    compiled_geometry = equations.geometry

    def geometry(m, theta):
        found = compiled_geometry.py_func(m, theta)
        return Geometry(*(0.0 * M if isinstance(value, float) and value == 0.0 else value for value in found))

    for module in modules:
        for name, kernel in list(vars(module).items()):
            if kernel is compiled_geometry:
                monkeypatch.setattr(module, name, geometry)
            elif isinstance(kernel, CPUDispatcher):
                monkeypatch.setattr(module, name, kernel.py_func)


def quantities(kind, values, wrong=None):
    """Values with the units of the fields of ``kind``; the field ``wrong`` as if it had one more kilogram."""
    units = UNITS[kind]
    return [
        value * unit * (U.kilogram if name == wrong else 1)
        for name, value, unit in zip(kind._fields, values, units, strict=False)
    ]


def pier(finite, law=BOUC_WEN, wrong=None, damped=None):
    return Springs(*quantities(Springs, PIER, wrong), law, 1.0, None, finite, damped)


def state(wrong=None):
    return State(*quantities(State, MOVING, wrong))


def ground(wrong=None):
    return Ground(*quantities(Ground, SHAKING, wrong))


def assert_units(values, units):
    """Each value has the dimension of its unit; a plain number is one without."""
    for value, unit in zip(values, units, strict=True):
        assert U.Quantity(value).check(unit), f"{value} is not in {unit}"


# What the equations give


@KINEMATICS
def test_levers_and_pivots_are_lengths(finite):
    assert_units(equations.geometry(pier(finite), state().theta), UNITS[Geometry])


@KINEMATICS
@DAMPED
@pytest.mark.parametrize("contact", CONTACTS)
def test_rates_are_the_states_units_per_second_whatever_the_contact(finite, damped, contact):
    m, shaking = pier(finite, damped=damped), ground()
    found = equations.rates(m, state(), contact, shaking.horizontal, shaking.vertical)
    assert_units(found, RATES)
    for side in (-1, 1):
        pivot = equations.pivot_acceleration(m, state(), contact, side, shaking.horizontal, shaking.vertical)
        assert_units([pivot], [ACCELERATION])


@KINEMATICS
@DAMPED
@pytest.mark.parametrize("contact", CONTACTS[:4])
def test_a_step_ends_in_a_state(finite, damped, contact):
    m, y, shaking = pier(finite, damped=damped), state(), ground()
    k1 = equations.rates(m, y, contact, shaking.horizontal, shaking.vertical)
    assert_units(equations.step(m, y, k1, contact, shaking, 0.001 * S), UNITS[State])


@KINEMATICS
def test_a_landing_ends_in_a_state(finite):
    for side in (-1, 1):
        assert_units(impact.land(pier(finite), state(), side), UNITS[State])
    assert_units(impact.land_flat(pier(finite), state()), UNITS[State])


@pytest.mark.parametrize("n", [1.0, 2.5, 5.0])
def test_the_spring_law_gives_rates_deflections_and_work(n):
    """Work is divided by the yield force, hence a length; the static deflection by δ_y, hence a number."""
    exponent = n * ONE
    m = pier(None)._replace(exponent=exponent)
    for yields in (0.0, 1.0):
        rate = laws.z_rate(m, -0.6 * ONE, -0.1 * SPEED, yields)
        assert_units([rate, laws.within_yield(-0.6 * ONE, yields)], [1 / S, ONE])
    assert_units([laws.static_deflection(0.4 * ONE, exponent)], [ONE])
    work = laws.plastic_work(m, -0.2 * ONE, -0.6 * ONE, 0.001 * M)
    given = [laws.deflection(m, 0.4 * ONE), laws.give(m, 0.4 * ONE)]
    assert_units([work, *given], [M, ONE, ONE])


@KINEMATICS
@DAMPED
@LAWS
@pytest.mark.parametrize("contact", CONTACTS)
def test_signals_compare_like_with_like_and_their_slopes_are_per_second(finite, damped, law, contact):
    """In contact the force over F_y, else the gap; on a spring the pivot's velocity, for an EPP spring its way to yield 1 + z."""
    m, y, shaking = pier(finite, law, damped=damped), state(), ground()
    k = equations.rates(m, y, contact, shaking.horizontal, shaking.vertical)
    rest = events.at_rest(m)
    values, slopes = events.signals(m, y, k, contact, 0.001 * M, 0.002 * M, rest, shaking.horizontal, shaking.vertical)
    assert_units([rest], [SPEED])
    for pivot, side in (("left", -1), ("right", 1)):
        on_spring, yields = getattr(contact, pivot) != 0.0, getattr(contact, f"{pivot}_yields") != 0.0
        first, law_signal = getattr(values, pivot), getattr(values, f"{pivot}_law")
        if contact.held == side:
            assert_units([first, law_signal], [ACCELERATION, ACCELERATION])
            continue
        unit = ONE if on_spring else M
        assert_units([first, getattr(slopes, pivot)], [unit, unit / S])
        if on_spring and law != ELASTIC:
            unit = SPEED if yields or law == BOUC_WEN else ONE
            assert_units([law_signal, getattr(slopes, f"{pivot}_law")], [unit, unit / S])


def test_the_rigid_bases_equations_give_rotations_and_times():
    m, shaking = Block(*quantities(Block, BLOCK)), ground()
    y, h = Rocking(0.05 * RAD, -0.1 * RAD / S, 1.0), 0.01 * S
    k1 = rigid.acceleration(m, y.theta, y.side, shaking.horizontal, shaking.vertical)
    assert_units([k1], [RAD / S**2])
    assert_units(rigid.rocking_step(m, y, k1, shaking, h)[:2], [RAD, RAD / S])
    assert_units(rigid.time_to_rest(m, y.omega, 0.1 * ACCELERATION, shaking.vertical), [RAD, S])
    later, _ = rigid.lift_off(m, Ground(1.8 * ACCELERATION, 40.0 * JERK, 0.0 * ACCELERATION, 0.0 * JERK), h)
    assert 0.0 * S < later < h
    assert_units([later], [S])


FORCES = (*(ACCELERATION,) * 4, M, M, SPEED, SPEED, ACCELERATION, SPEED, SPEED, RAD / S, ONE, M)


@KINEMATICS
@pytest.mark.parametrize("contact", CONTACTS)
def test_forces_gaps_and_speeds_have_their_units_on_springs(finite, contact):
    shaking = ground()
    found = forces.on_springs(
        pier(finite), 31.0 * M, state(), contact, 0.001 * M, 0.002 * M, shaking.horizontal, shaking.vertical
    )
    assert_units(found, FORCES)


@pytest.mark.parametrize("side", [-1.0, 0.0, 1.0])
@pytest.mark.parametrize("kinds", [(), (FRICTION, TENDON)], ids=["plain", "tied"])
@pytest.mark.parametrize("omega", [0.0, -0.1])
def test_forces_gaps_and_speeds_have_their_units_on_a_rigid_base(side, kinds, omega):
    m, outline = Block(*quantities(Block, BLOCK)), forces.Outline(7.4 * M, 3.0 * M, 1.0, 24.0 * M)
    tied = [Element(*quantities(Element, (kind, 2.0, 1.0, 3.0, 40.0, 0.1, 1.0, 0.5, 0.5, 0.0))) for kind in kinds]
    found = forces.on_rigid_base(
        m, outline, tied, [0.001 * M] * len(tied), 0.05 * side * RAD, omega * RAD / S, side, 0.5 * ACCELERATION,
        -1.0 * ACCELERATION,
    )  # fmt: skip
    assert_units(found, FORCES)


# What they refuse


def step_and_land(m, y, shaking):
    """A step, its signals and a landing: between them they need every argument."""
    k1 = equations.rates(m, y, BOTH, shaking.horizontal, shaking.vertical)
    equations.step(m, y, k1, BOTH, shaking, 0.001 * S)
    rest = events.at_rest(m)
    events.signals(m, y, k1, BOTH, 0.001 * M, 0.002 * M, rest, shaking.horizontal, shaking.vertical)
    impact.land(m, y, 1)


def rock(m, shaking):
    """A step on the rigid base and the bounces that are left."""
    y = Rocking(0.05 * RAD, -0.1 * RAD / S, 1.0)
    k1 = rigid.acceleration(m, y.theta, y.side, shaking.horizontal, shaking.vertical)
    rigid.rocking_step(m, y, k1, shaking, 0.01 * S)
    rigid.time_to_rest(m, y.omega, 0.1 * ACCELERATION, shaking.vertical)


def test_right_units_are_not_refused():
    for finite in (None, True):
        step_and_land(pier(finite), state(), ground())
    rock(Block(*quantities(Block, BLOCK)), ground())


@KINEMATICS
@pytest.mark.parametrize("field", Springs._fields[:9])
def test_a_pier_with_one_wrong_unit_is_refused(finite, field):
    with pytest.raises(pint.DimensionalityError):
        step_and_land(pier(finite, wrong=field, damped=field == "damping" or None), state(), ground())


@KINEMATICS
@pytest.mark.parametrize("field", State._fields)
def test_a_state_with_one_wrong_unit_is_refused(finite, field):
    """An angle in kilograms, whose sine is a polynomial, is refused where it is compared with π/4, as a plain error."""
    with pytest.raises((pint.DimensionalityError, ValueError), match=r"Cannot (convert|compare)"):
        step_and_land(pier(finite), state(wrong=field), ground())


@KINEMATICS
@pytest.mark.parametrize("field", Ground._fields)
def test_a_ground_motion_with_one_wrong_unit_is_refused(finite, field):
    with pytest.raises(pint.DimensionalityError):
        step_and_land(pier(finite), state(), ground(wrong=field))


@KINEMATICS
def test_a_step_in_metres_is_refused(finite):
    m, y, shaking = pier(finite), state(), ground()
    k1 = equations.rates(m, y, BOTH, shaking.horizontal, shaking.vertical)
    with pytest.raises(pint.DimensionalityError):
        equations.step(m, y, k1, BOTH, shaking, 0.001 * M)


@pytest.mark.parametrize("field", Block._fields)
def test_a_block_with_one_wrong_unit_is_refused(field):
    with pytest.raises(pint.DimensionalityError):
        rock(Block(*quantities(Block, BLOCK, wrong=field)), ground())
