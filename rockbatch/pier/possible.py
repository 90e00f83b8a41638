"""Impossible combinations of pier and base, and the least β and η of springs that hold a pier upright."""

import math

import numpy as np

from rockbatch.common.errors import Contradiction, MissingKey, OutOfRange, Problem
from rockbatch.common.units import rounded_up
from rockbatch.pier.bases import Base, ElasticBase, RigidBase, YieldingBase
from rockbatch.pier.bending import problems as bending_problems
from rockbatch.pier.block import Pier
from rockbatch.pier.footing_base import FootingBase
from rockbatch.pier.places import places, prestress_over_weight
from rockbatch.pier.plausibility import lopsided_tendons, wrong_restraints
from rockbatch.pier.traits import LEAST_ETA


def least_beta(pier: Pier, base: Base) -> float:
    """Return β below which the pier topples on its springs under its weight, or at any disturbance (THEORY.md, eq. 13).

    A spring at rest at z = −1/η, or −(1 + ψ)/η with tendons, has r = 1 − |z|ⁿ (Bouc–Wen) of its elastic stiffness in further
    loading, and all of it in unloading; as a pair in rotation the springs have 2r/(1 + r) of the elastic stiffness. A shaft that
    bends hangs over as it leans. For other bases it is that on two elastic springs.
    """
    over = _over(pier, base) if base.on_springs else 1.0
    if not (isinstance(base, YieldingBase) and base.n >= 1):
        return over * pier.least_beta
    carried = base.eta / (1.0 + prestress_over_weight(pier, base.restraints))
    if carried * base.first_loading.most <= 1:
        return over * pier.least_beta
    softer = float(base.first_loading.tangent(np.array(1.0 / carried)))
    return over * pier.least_beta * math.sqrt((1.0 + softer) / (2.0 * softer))


def _over(pier: Pier, base: ElasticBase | FootingBase) -> float:
    """Return the least β that holds a shaft which hangs over as it leans, over that of a rigid one.

    1 for a rigid one, and for one that has :func:`rockbatch.pier.bending.problems`.
    """
    if not base.bends or bending_problems(pier):
        return 1.0
    return math.sqrt(base.leaning_height(pier) / pier.height)


def least_eta(pier: Pier, base: Base) -> float:
    """Return η below which the springs cannot carry the weight and the tendons' prestress."""
    most = base.first_loading.most if isinstance(base, YieldingBase) else 1.0
    return LEAST_ETA * (1.0 + prestress_over_weight(pier, base.restraints)) / most


def enough_eta(pier: Pier, base: Base) -> float:
    """Return η above which the springs carry weight and prestress, and hold the pier upright with the given β.

    This inverts :func:`least_beta` if the base yields and β suffices for elastic springs; otherwise it is :func:`least_eta`.
    It is of springs that bear F_y at most, without points.
    """
    assert not base.has_points
    least = least_eta(pier, base)
    if isinstance(base, YieldingBase) and base.beta > pier.least_beta:
        excess = 2.0 * (base.beta / pier.least_beta) ** 2 - 1.0
        low, high = 0.0, 1.0  # bracket of z at which the tangent stiffness is 1/excess of the elastic one
        for _ in range(60):
            middle = 0.5 * (low + high)
            stiff = float(base.first_loading.tangent(np.array(middle))) > 1.0 / excess
            low, high = (middle, high) if stiff else (low, middle)
        least /= high
    return least


def problems(pier: Pier, base: Base) -> list[Problem]:
    """Return a problem, with the limit, for each value that is impossible for ``pier`` on ``base``; [] if all are possible.

    A frame that is not on rigid ground has that problem alone. Lopsided tendons on springs are named if all else is right.
    """
    if base.on_springs and pier.deck_over_columns is not None:
        text = (
            f"a rocking frame is solved on rigid ground only, and this base is {base.name}. On springs each column "
            "settles by itself, the deck no longer stays level, and no single block is equivalent (Makris & Vassiliou 2013); "
            'write base = "rigid"; or, if the columns are fixed to their cap beam, leave columns out and write [[pier.part]] '
            "for them and the beam, with width_m between the outer feet"
        )
        return [Problem("columns", None, text, kind=Contradiction)]
    wrong: list[Problem] = []
    if isinstance(base, FootingBase):
        wrong = _wrong_footing(pier, base)
    elif isinstance(base, ElasticBase):
        wrong = _wrong_stiffness(pier, base)
    wrong += wrong_restraints(pier, base.restraints)
    if base.bends:
        wrong += _wrong_bending(pier, base)
    if isinstance(base, RigidBase) and base.contact_stiffness_kN_m is not None:
        wrong += _wrong_contact(pier, base)
    if base.on_springs and not wrong:
        wrong += lopsided_tendons(pier, base.restraints)
    if isinstance(base, YieldingBase) and base.eta < (least := least_eta(pier, base)):
        prestress = prestress_over_weight(pier, base.restraints)
        more = f" and the prestress of the tendons, psi = {prestress:g} of it" if prestress else ""
        above = f"{'' if base.has_points else '1 + psi, '}{rounded_up(least, 7):.7g}"
        text = f"the springs cannot carry the weight{more}; eta must be above {above}"
        wrong.append(Problem("eta", base.eta, text, kind=OutOfRange))
    return wrong


def _wrong_footing(pier: Pier, base: FootingBase) -> list[Problem]:
    rigid, psi = pier.least_beta / math.sqrt(base.rocking_share), prestress_over_weight(pier, base.restraints)
    wrong, least = [], rigid * _over(pier, base)
    if not base.beta > least:
        over = "" if base.beta <= rigid else ", and by more under a shaft, which hangs over as it leans"
        text = (
            f"the bed is too soft to hold the pier upright, K_θ = ω_v² b²/3 must be above g h{over}; beta must be above "
            f"{rounded_up(least):g}, the bed {(least / base.beta) ** 2:.3g} times as stiff"
        )
        wrong.append(Problem("beta", base.beta, text, kind=OutOfRange))
    if base.safety_factor is not None and not base.safety_factor > 1.0 + psi:
        more = f" and the prestress of the tendons, psi = {psi:g} of it" if psi else ""
        text = f"the bed cannot carry the weight{more}; it must be above {1.0 + psi:g}"
        wrong.append(Problem("safety_factor", base.safety_factor, text, kind=OutOfRange))
    if pier.initial_rotation_rad and base.restraints:
        text = "a pier with devices can be released on springs or rigid ground only; leave one out"
        wrong.append(Problem("initial_rotation_rad", pier.initial_rotation_rad, text, kind=Contradiction))
    return wrong


def _wrong_bending(pier: Pier, base: Base) -> list[Problem]:
    wrong = bending_problems(pier)
    if any(place.height != 0.0 for device in base.restraints for place in places(pier, device)):
        text = 'devices on the deck are of a rigid shaft; leave them out, or write shaft = "rigid"'
        wrong.append(Problem("shaft", "elastic", text, kind=Contradiction))
    if base.has_points:
        text = 'springs with a backbone are available for rigid shafts only; write spring = "hardening", or shaft = "rigid"'
        wrong.append(Problem("shaft", "elastic", text, kind=Contradiction))
    if base.on_springs:
        wrong += [Problem("shaft", "elastic", text, kind=Contradiction) for text in _wrong_under_shaft(base)]
    if isinstance(base, RigidBase) and base.restitution is not None:
        text = "the loss of a bending shaft at an impact follows from the momenta of its modes; leave this out"
        wrong.append(Problem("restitution", base.restitution, text, kind=Contradiction))
    return wrong


def _wrong_under_shaft(base: ElasticBase | FootingBase) -> list[str]:
    """Return a text for each property of springs or a bed that a shaft that bends cannot have under it."""
    texts = []
    if base.two_springs and not base.zeta:
        texts.append(
            "a landing on undamped springs is an impulse, which bending does not follow; write zeta, for example 0.2"
        )
    if base.kinematics != "finite":
        texts.append('bending is of finite kinematics; write kinematics = "finite"')
    return texts


def _wrong_contact(pier: Pier, base: RigidBase) -> list[Problem]:
    """Return a problem for each reason that ``contact_stiffness_kN_m`` cannot be used."""
    key, stiffness = "contact_stiffness_kN_m", base.contact_stiffness_kN_m
    wrong = []
    if pier.mass_t is None:
        text = "is of a pier whose mass is known; write mass_t in [pier], or leave it out"
        wrong.append(Problem(key, stiffness, text, kind=MissingKey))
    if pier.deck_over_columns is not None:
        text = "how the columns of a frame share a landing is not known; leave it out"
        wrong.append(Problem(key, stiffness, text, kind=Contradiction))
    if base.bends:
        text = 'is of a rigid shaft; leave it out, or write shaft = "rigid"'
        wrong.append(Problem(key, stiffness, text, kind=Contradiction))
    return wrong


def _wrong_stiffness(pier: Pier, base: ElasticBase) -> list[Problem]:
    least = least_beta(pier, base)
    if not base.beta > pier.least_beta:
        text = (
            "the pier topples on its springs under its own weight; beta must be above "
            f"sqrt((1+mu) cos(alpha)/mu)/sin(alpha) = {rounded_up(pier.least_beta):g}"
            + (f", for these springs above {rounded_up(least):g}" if least > pier.least_beta else "")
        )
    elif base.beta > least:
        return []
    elif isinstance(base, YieldingBase):
        text = (
            "the least push topples the pier, because such springs near their yield force "
            f"({_near_yield(base)}) give way on the loaded side; beta must be above {rounded_up(least):g}"
        )
    else:
        text = (
            "the pier topples on its springs, over which its shaft hangs as it leans; beta must be above "
            f"{rounded_up(least):g}"
        )
    return [Problem("beta", base.beta, text, kind=OutOfRange)]


def _near_yield(base: YieldingBase) -> str:
    """Return "eta = 1.2, n = 5", the second if the law has it."""
    return f"eta = {base.eta:g}" + (f", n = {base.n:g}" if base.has_exponent else "")
