"""A dimensional proof of the equations: every scalar function takes quantities with units and gives the right ones.

The kernels run as plain Python here, with pint's quantities in place of floats. A term in the wrong dimension, or a
factor too few, cannot be added; and every argument given in a wrong unit is noticed.
"""

import math
from types import ModuleType, SimpleNamespace

import pint
import pytest
from numba.core.registry import CPUDispatcher

from rockbatch.core import rk4, system, table, trigonometry
from rockbatch.core.block import equations as block
from rockbatch.core.block import events as block_events
from rockbatch.core.block.model import Block, Rocker, Rocking, Stance, Tilt
from rockbatch.core.devices import elongation, pull
from rockbatch.core.devices import laws as device_laws
from rockbatch.core.devices.laws import CONTACT, FRICTION, HYSTERETIC, MAXWELL, SPRING, TENDON, VISCOUS, Element
from rockbatch.core.flexure import equations as flexure
from rockbatch.core.flexure import events as flexure_events
from rockbatch.core.flexure import model as flexure_model
from rockbatch.core.flexure import shaft as flexure_shaft
from rockbatch.core.flexure.model import FlexibleBlock, Flexing
from rockbatch.core.flexure.modes import PerMode
from rockbatch.core.observe import forces
from rockbatch.core.springs import bending as bending_on_springs
from rockbatch.core.springs import equations, events, impact, laws, recovery
from rockbatch.core.springs.model import (
    HOUSNER,
    LANDING,
    BentState,
    Contact,
    Geometry,
    Shaft,
    Springs,
    State,
    Supports,
)
from rockbatch.core.types import IMPACT_BOTH, IMPACT_LEFT, IMPACT_RIGHT, Ground, Instant, Moment, Pull

U = pint.get_application_registry()  # which two test files share, since it takes a second to make
M, S, RAD, ONE = U.metre, U.second, U.radian, U.dimensionless
SPEED, ACCELERATION, JERK = M / S, M / S**2, M / S**3

UNITS = {  # of the fields, by the tuples' own comments
    Springs: (M, M, M**2, ACCELERATION, M, 1 / M, ACCELERATION, ONE, ONE, ONE, 1 / S),
    State: (M, RAD, SPEED, RAD / S, ONE, ONE),
    BentState: (M, RAD, SPEED, RAD / S, ONE, ONE, *4 * (M,), *4 * (SPEED,)),
    Shaft: (ONE, M, 1 / S, 1 / S, ONE, ONE, ONE),  # of each mode
    Ground: (ACCELERATION, JERK, ACCELERATION, JERK),
    Geometry: (M,) * 12,
    Block: (M, M, M**2, ACCELERATION, RAD, 1 / S, ONE, ONE, ONE, 1 / M**2, SPEED, ONE),
    Rocking: (M, RAD, SPEED, RAD / S),
    FlexibleBlock: (
        *(M, M, M**2, ACCELERATION, RAD, 1 / S, ONE, SPEED, ONE, M, RAD, S),
        *(ONE, M, 1 / S, 1 / S, ONE, ONE),  # of each mode
    ),
    Flexing: (M, RAD, SPEED, RAD / S, *4 * (M,), *4 * (SPEED,)),
    Rocker: (M, M, ACCELERATION, 1 / M**2),
    Tilt: (RAD, RAD / S),
    Pull: (ACCELERATION, M * ACCELERATION),
    elongation.Gap: (M, SPEED, ONE, M, ACCELERATION, M),
    Supports: (M, M),
    Element: (  # of a tendon
        ONE,
        ACCELERATION,
        1 / S**2,
        ACCELERATION / SPEED,
        ONE,
        ACCELERATION,
        M,
        SPEED,
        1 / S,
        ONE,
        M,
        ONE,
        1 / S,
        M,
        M,
        ONE,
    ),
}
RATES = (SPEED, RAD / S, ACCELERATION, RAD / S**2, 1 / S, 1 / S)

PIER = (1.5, 7.2, 18.0, 9.81, 0.01, 100.0, 14.7, 0.1, LANDING, 0.9, 1.9)
MOVING = (-0.004, 0.02, -0.01, 0.15, -0.3, -0.6)
SHAKING = (2.0, -30.0, -1.0, 12.0)
BLOCK = (1.5, 7.2, 18.0, 9.81, 0.2, 1.0, 0.9, 0.3, 1.0, 0.0138, 1e-12, 0.3)
FLEXIBLE = (1.5, 7.2, 18.0, 9.81, 0.2, 1.0, 1.0, 1e-12, 0.0, 12.0, 0.19, 0.001)
OF_MODES = ((0.8, -0.4, 0.3, -0.2), (6.0, -1.0, 0.4, -0.2), (9.0, 56.0, 158.0, 309.0), (0.9, 5.6, 15.8, 30.9),
            (1.9, -2.0, 2.0, -2.0), (1.8, -1.8, 1.6, -1.5))  # fmt: skip
FLEXES = (0.07, 0.05, -0.15, -0.1, 0.03, 0.01, -0.005, 0.001, -0.2, 0.1, 0.1, -0.1)
ROCKS = (0.07, 0.05, -0.15, -0.1)
DEVICE = (2.0, 3.0, 40.0, 1.0, 0.5, 0.5, 0.01, 400.0, 0.3, 0.01, 0.5, 9.0, 0.0, 1.5, 1.0)  # an Element after its kind

BOTH = Contact(1.0, 1.0, 1.0, 0.0, 0)
ON_RIGHT, IN_AIR = Stance(0.0, 1.0, 1.0, 1.0), Stance(0.0, 0.0, 1.0, -1.0)
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
LAWS = pytest.mark.parametrize("law", laws.CODES.values(), ids=laws.CODES)

WAITING = Supports(0.001 * M, 0.002 * M)
CALM = Ground(0.1 * ACCELERATION, 0.2 * JERK, -0.1 * ACCELERATION, 0.3 * JERK)


def rocking(*values):
    """Return the state of a block, whose zeros are written without units."""
    units = UNITS[Rocking]
    return Rocking(*(x * unit if isinstance(x, float) else x for x, unit in zip(values, units, strict=True)))


MATH = SimpleNamespace(
    **{**vars(math), "sqrt": lambda x: x**0.5, "copysign": lambda x, like: abs(x) if like >= 0.0 * like else -abs(x)}
)
"""math, with roots and signs of quantities."""


@pytest.fixture(autouse=True)
def plain_python(monkeypatch):
    """All kernels of these modules as the Python functions they were written as.

    A lever that is absent, or the state of a block at rest, is written as 0.0; an exact zero has every dimension, so it gets
    the right one.
    """
    modules: tuple[ModuleType, ...] = (
        laws, recovery, equations, impact, events, trigonometry, block, block_events, forces, device_laws, elongation, pull, rk4,
        flexure, flexure_events, flexure_model, flexure_shaft, bending_on_springs,
    )  # fmt: skip
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
            elif kernel in (table.along, table.weighted, table.with_pull, table.with_rates, table.with_z):
                monkeypatch.setattr(module, name, getattr(table, f"_interpreted_{name}"))
    for module in (block_events, device_laws, elongation):
        monkeypatch.setattr(module, "math", MATH)
    for module in (laws, device_laws):  # real powers are arithmetic on the bits of floats
        monkeypatch.setattr(module, "power", lambda x, n: x ** (5 if n is None else n))
    without = block.pull_down
    for module in (block, flexure):
        monkeypatch.setattr(module, "pull_down", lambda pull: without(pull or Pull(*quantities(Pull, (0.0, 0.0)))))
    monkeypatch.setattr(block_events, "Rocking", rocking)
    monkeypatch.setattr(block_events, "NEAR_FLIGHT", 10.0)  # so that the rate of the normal force is looked at


def quantities(kind, values, wrong=None):
    """Values with the units of the fields of ``kind``; the field ``wrong`` as if it had one more kilogram."""
    units = UNITS[kind]
    return [
        value * unit * (U.kilogram if name == wrong else 1)
        for name, value, unit in zip(kind._fields, values, units, strict=False)
    ]


def pier(finite, law=laws.CODES["bouc-wen"], wrong=None, damped=None, landing=LANDING):
    numbers = Springs(*quantities(Springs, PIER, wrong), law, -0.005 * M, 5.0, 1.0, 1e-12 * SPEED, None, finite, damped)
    return numbers._replace(impact=landing)


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
    found = system.rates(m, state(), contact, shaking)
    assert_units(found, RATES)
    for side in (-1, 1):
        pivot = equations.pivot_acceleration(m, state(), contact, side, shaking)
        assert_units([pivot], [ACCELERATION])


@KINEMATICS
@DAMPED
@pytest.mark.parametrize("contact", CONTACTS[:4])
def test_a_step_ends_in_a_state(finite, damped, contact):
    m, y, shaking = pier(finite, damped=damped), state(), ground()
    k1 = system.rates(m, y, contact, shaking)
    assert_units(rk4.rk4(m, None, Instant(y, k1, contact, WAITING, shaking), 0.001 * S), UNITS[State])


@KINEMATICS
@pytest.mark.parametrize("landing", [LANDING, HOUSNER], ids=["landing", "housner"])
def test_a_landing_ends_in_a_state_and_takes_an_energy(finite, landing):
    m = pier(finite, landing=landing)
    for side, kind in ((-1, IMPACT_LEFT), (1, IMPACT_RIGHT)):
        for contact in (BOTH, Contact(0.0, 0.0, 0.0, 0.0, 0)):
            landed, velocity = impact.land(m, state(), side, contact)
            assert_units(landed, UNITS[State])
            assert_units([velocity, impact.loss(m, state(), contact, kind)], [SPEED, SPEED**2])
    assert_units(impact.land_flat(m, state()), UNITS[State])
    assert_units([impact.loss(m, state(), BOTH, IMPACT_BOTH)], [SPEED**2])


@pytest.mark.parametrize("n", [1.0, 2.5, 5.0])
def test_the_spring_law_gives_rates_compliances_and_work(n):
    """Work is divided by the yield force, hence a length; deflection by force over those at yield, hence a number."""
    exponent = n * ONE
    m = pier(None)._replace(exponent=exponent)
    for yields in (0.0, 1.0):
        rate = laws.z_rate(m, -0.6 * ONE, -0.1 * SPEED, yields)
        assert_units([rate, laws.within_yield(None, -0.6 * ONE, yields)], [1 / S, ONE])
    work = laws.plastic_work(m, -0.2 * ONE, -0.6 * ONE, 0.001 * M)
    assert_units([work, laws.give(m, 0.4 * ONE, -0.3 * ONE)], [M, ONE])


@pytest.mark.sweep(fast=32)
@KINEMATICS
@DAMPED
@LAWS
@pytest.mark.parametrize("contact", CONTACTS)
def test_signals_compare_like_with_like_and_their_slopes_are_per_second(finite, damped, law, contact):
    """In contact the force over F_y, else the gap; on a spring the pivot's velocity, or its way to a yield point."""
    m, y, shaking = pier(finite, law, damped=damped), state(), ground()
    k = system.rates(m, y, contact, shaking)
    values, slopes = system.event_functions(m, None, Instant(y, k, contact, WAITING, shaking))
    for pivot, side in (("left", -1), ("right", 1)):
        on_spring, yields = getattr(contact, pivot) != 0.0, getattr(contact, f"{pivot}_yields") != 0.0
        first, law_signal = getattr(values, pivot), getattr(values, f"{pivot}_law")
        if contact.held == side:
            assert_units([first, law_signal], [ACCELERATION, ACCELERATION])
            continue
        unit = ONE if on_spring else M
        assert_units([first, getattr(slopes, pivot)], [unit, unit / S])
        if on_spring and law != laws.CODES["elastic"]:
            unit = SPEED if yields or law == laws.CODES["bouc-wen"] else ONE
            assert_units([law_signal, getattr(slopes, f"{pivot}_law")], [unit, unit / S])


def rigid(under=None, wrong=None):
    return Block(*quantities(Block, BLOCK, wrong), under and Pull(*quantities(Pull, (0.4, -0.7))))


@pytest.mark.parametrize("under", [None, True], ids=["plain", "pulled"])
@pytest.mark.parametrize("stance", [ON_RIGHT, IN_AIR], ids=["rocks", "flies"])
def test_a_block_has_rates_event_functions_and_a_step(under, stance):
    m, shaking = rigid(under), ground()
    y = block.constrained(m, Rocking(*quantities(Rocking, ROCKS)), stance)
    k = system.rates(m, y, stance, shaking)
    assert_units(k, (SPEED, RAD / S, ACCELERATION, RAD / S**2))
    assert_units(rk4.rk4(m, None, Instant(y, k, stance, None, shaking), 0.01 * S), UNITS[Rocking])
    values, slopes = system.event_functions(m, None, Instant(y, k, stance, None, shaking))
    units = (RAD, ACCELERATION) if stance is ON_RIGHT else (M, M)
    assert_units([values.left, values.right], units)
    assert_units([slopes.left, slopes.right], [unit / S for unit in units])
    assert_units(block.clearances(m, y, stance.top), (M, M, SPEED, SPEED))
    assert_units([block.lever(m, y, stance)], [M])
    assert_units([system.ground_power(m, y, stance, shaking)], [ACCELERATION * SPEED])


def test_a_rocker_steps_as_a_block_does():
    m, y, shaking = (
        Rocker(1.5 * M, 7.2 * M, 9.81 * ACCELERATION, 0.0138 / M**2),
        Tilt(0.05 * RAD, -0.1 * RAD / S),
        ground(),
    )
    k = system.rates(m, y, 1.0, shaking)
    assert_units(k, (RAD / S, RAD / S**2))
    assert_units(rk4.rk4(m, None, Instant(y, k, 1.0, None, shaking), 0.01 * S), UNITS[Tilt])


def test_what_lifts_a_block_off_and_the_bounces_that_are_left():
    at_rest = Rocking(*quantities(Rocking, (0.0,) * 4))
    assert_units([block_events.lifting(rigid(), None, at_rest, 1.0, CALM)], [RAD / S**2])
    assert_units(
        [block_events.lift_rate(rigid(), None, Instant(at_rest, at_rest, ON_RIGHT, None, CALM), 1.0)], [RAD / S**3]
    )
    assert_units(block_events.bounces(rigid(), None, at_rest, -0.1 * RAD / S, 0.9, CALM), (RAD, S))


@KINEMATICS
def test_a_device_has_an_elongation_in_metres(finite):
    m = pier(finite)
    found = elongation.gap(m, 0.5 * M, elongation.attitude(m, state(), BOTH, 0.001 * M), state())
    assert finite or found.bend == 0.0
    assert_units(found._replace(bend=found.bend or 0.0 * ACCELERATION), UNITS[elongation.Gap])
    assert_units(
        [elongation.lifted(found, Rocking(SPEED, RAD / S, 0.3 * ACCELERATION, 0.2 * RAD / S**2))], [ACCELERATION]
    )


@pytest.mark.parametrize(("kind", "unit"), [
    (FRICTION, ONE), (VISCOUS, ONE), (HYSTERETIC, 1 / S), (TENDON, SPEED), (MAXWELL, JERK), (CONTACT, ONE), (SPRING, ONE),
])  # fmt: skip
def test_a_device_has_a_force_and_the_rate_of_its_state(kind, unit):
    of = Element(*quantities(Element, (kind, *DEVICE)))
    of = of._replace(stiffness=40.0 / M) if kind == HYSTERETIC else of
    inner = {TENDON: 0.001 * M, CONTACT: 0.001 * M, SPRING: 0.0 * M, MAXWELL: 0.4 * ACCELERATION}.get(kind, 0.4 * ONE)
    for mode in (device_laws.TAUT,) if kind == SPRING else (device_laws.TAUT, device_laws.YIELDING):
        law = device_laws.response(of, 0.02 * M, 0.1 * SPEED, inner, mode, 1.0)
        assert_units([law.force], [ACCELERATION])
        assert law.state_rate == 0.0 or U.Quantity(law.state_rate).check(unit)
        assert law.loss_rate == 0.0 or U.Quantity(law.loss_rate).check(ACCELERATION * SPEED)
        kept = device_laws.stored(of, 0.02 * M, inner)
        assert kept == 0.0 or U.Quantity(kept).check(ACCELERATION * M)


@KINEMATICS
def test_the_deck_moves_in_metres(finite):
    m, of = pier(finite), Element(*quantities(Element, (SPRING, *DEVICE)))._replace(height=31.0 * M)
    found = elongation.gap_of(m, of, elongation.attitude(m, state(), BOTH, 0.001 * M), state())
    assert found.by_v == 0.0
    assert finite or found.bend == 0.0
    assert_units(found._replace(by_v=0.0 * ONE, bend=found.bend or 0.0 * ACCELERATION), UNITS[elongation.Gap])


FORCES = (
    *(ACCELERATION,) * 2, M * ACCELERATION, *(ACCELERATION,) * 2,
    M, M, SPEED, SPEED, ACCELERATION, SPEED, SPEED, RAD / S, ONE, M,
)  # fmt: skip


@KINEMATICS
@pytest.mark.parametrize("contact", CONTACTS)
def test_forces_gaps_and_speeds_have_their_units_on_springs(finite, contact):
    waiting = Supports(0.001 * M, 0.002 * M)
    found = forces.on_springs(pier(finite), 31.0 * M, Moment(state(), contact, waiting), ground())
    assert_units(found, FORCES)


@pytest.mark.parametrize("stance", [Stance(1.0, 0.0, -1.0, -1.0), Stance(1.0, 1.0, 0.0, 0.0), ON_RIGHT, IN_AIR])
def test_forces_gaps_and_speeds_have_their_units_on_a_rigid_base(stance):
    m, outline = rigid(True), forces.Outline(7.4 * M, 3.0 * M, 1.0, 24.0 * M, 0.0)
    hold = forces.Hold(0.3 * ACCELERATION, 0.1 * RAD / S**2, 0.3 * ACCELERATION, 0.1 * RAD / S**2)
    rests = stance.left == stance.right == 1.0
    y = block.constrained(m, Rocking(*quantities(Rocking, (0.0,) * 4 if rests else ROCKS)), stance)
    found = forces.on_block(m, forces.Body(outline, hold), Moment(y, stance, None), ground())
    assert_units(found, FORCES)


def bending_pier():
    """A pier on damped springs whose shaft has the modes of FLEXIBLE."""
    values = (*OF_MODES, OF_MODES[-1])
    modes = [PerMode(*(x * unit for x in each)) for each, unit in zip(values, UNITS[Shaft], strict=True)]
    return pier(True, damped=True)._replace(shaft=Shaft(*modes, 12.0 * M))


@pytest.mark.parametrize("contact", CONTACTS)
def test_a_bending_shaft_on_springs_has_rates_energies_and_forces(contact):
    m, y, shaking = bending_pier(), BentState(*quantities(BentState, (*MOVING, *FLEXES[4:]))), ground()
    k = system.rates(m, y, contact, shaking)
    assert_units(k, (*RATES, *4 * (SPEED,), *4 * (ACCELERATION,)))
    assert_units(rk4.rk4(m, None, Instant(y, k, contact, WAITING, shaking), 0.001 * S), UNITS[BentState])
    up, turning, modes = bending_on_springs.momenta(m, y, 7.0 * M)
    assert_units([up, turning, *modes], [SPEED, M * SPEED, *4 * (SPEED,)])
    assert_units([flexure_shaft.kinetic_of_modes(m, y, 7.0 * M)], [SPEED**2])
    assert_units([system.ground_power(m, y, contact, shaking)], [ACCELERATION * SPEED])
    assert_units(forces.on_springs(m, 31.0 * M, Moment(y, contact, WAITING), shaking), FORCES)


# What they refuse


def step_and_land(m, y, shaking):
    """A step, its signals, a landing and plastic work: between them they need every argument."""
    k1 = system.rates(m, y, BOTH, shaking)
    start = Instant(y, k1, BOTH, WAITING, shaking)
    rk4.rk4(m, None, start, 0.001 * S)
    system.event_functions(m, None, start)
    impact.land(m, y, 1, BOTH)
    impact.land(m._replace(impact=HOUSNER), y, 1, BOTH)
    laws.plastic_work(m, -0.2 * ONE, -0.6 * ONE, 0.001 * M)


def rock(m, shaking):
    """A step on the rigid base, its event functions, the bounces that are left, and a landing from flight."""
    y = block.constrained(m, Rocking(*quantities(Rocking, ROCKS)), ON_RIGHT)
    k = system.rates(m, y, ON_RIGHT, shaking)
    start = Instant(y, k, ON_RIGHT, None, shaking)
    rk4.rk4(m, None, start, 0.01 * S)
    system.event_functions(m, None, start)
    still = Rocking(*quantities(Rocking, (0.0,) * 4))
    height, remaining = block_events.bounces(m, None, still, -0.1 * RAD / S, m.restitution, CALM)
    assert_units([height, remaining], [RAD, S])
    landed, _, _ = block_events._landing(m, Rocking(*quantities(Rocking, ROCKS)), IN_AIR, 1.0)
    assert_units(landed, UNITS[Rocking])


def test_right_units_are_not_refused():
    for finite in (None, True):
        step_and_land(pier(finite), state(), ground())
    rock(rigid(), ground())


@KINEMATICS
@pytest.mark.parametrize("field", [name for name in Springs._fields[:11] if name != "impact"])
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
    k1 = system.rates(m, y, BOTH, shaking)
    with pytest.raises(pint.DimensionalityError):
        rk4.rk4(m, None, Instant(y, k1, BOTH, WAITING, shaking), 0.001 * M)


@pytest.mark.parametrize("field", Block._fields[:8])
def test_a_block_with_one_wrong_unit_is_refused(field):
    with pytest.raises(pint.DimensionalityError):
        rock(rigid(wrong=field), ground())


def bending(wrong=None):
    """A pier whose shaft bends; the field ``wrong`` as if it had one more kilogram."""
    single = quantities(FlexibleBlock, FLEXIBLE, wrong)
    names, units = FlexibleBlock._fields[len(single) :], UNITS[FlexibleBlock][len(single) :]
    of_modes = [
        PerMode(*(value * unit * (U.kilogram if name == wrong else 1) for value in values))
        for name, values, unit in zip(names, OF_MODES, units, strict=False)
    ]
    return FlexibleBlock(*single, *of_modes)


def flex(m, shaking, stance):
    """A step of a pier whose shaft bends, its normal force, and the blow of a foot."""
    y = block.constrained(m, Flexing(*quantities(Flexing, FLEXES)), stance)
    k = system.rates(m, y, stance, shaking)
    assert_units(k, (SPEED, RAD / S, ACCELERATION, RAD / S**2, *4 * (SPEED,), *4 * (ACCELERATION,)))
    rk4.rk4(m, None, Instant(y, k, stance, None, shaking), 0.001 * S)
    assert_units([block.normal_force(m, y, k, shaking.vertical)], [ACCELERATION])
    assert_units([system.ground_power(m, y, stance, shaking)], [ACCELERATION * SPEED])
    assert_units([flexure_events.lift_rate(m, None, Instant(y, k, stance, None, shaking), 1.0)], [RAD / S**3])
    omega, rates = flexure_events._after_blow(m, y, 1.0, 0.1 * SPEED, -1.0)
    assert_units((omega, *rates), (RAD / S, *4 * (SPEED,)))


@pytest.mark.parametrize("stance", [ON_RIGHT, Stance(0.0, 0.0, 1.0, 1.0)], ids=["rocks", "flies"])
def test_a_shaft_that_bends_has_rates_and_blows_of_the_right_units(stance):
    flex(bending(), ground(), stance)


@pytest.mark.parametrize(
    "field", ["half_width", "height", "inertia", "gravity", "share", "coupling", "frequency", "damping"]
)
def test_a_shaft_with_one_wrong_unit_is_refused(field):
    with pytest.raises(pint.DimensionalityError):
        flex(bending(field), ground(), ON_RIGHT)
