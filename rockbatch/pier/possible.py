"""Piers on bases that are impossible together, and the least β and η of springs that hold a pier upright."""

import math

import numpy as np

from rockbatch.common.errors import Contradiction, MissingKey, OutOfRange, Problem
from rockbatch.common.units import rounded_up
from rockbatch.pier.bases import LEAST_ETA, Base, ElasticBase, FootingBase, RigidBase, YieldingBase
from rockbatch.pier.bending import problems as bending_problems
from rockbatch.pier.block import Pier
from rockbatch.pier.places import places, prestress_over_weight
from rockbatch.pier.plausibility import wrong_on_springs, wrong_restraints


def least_beta(pier: Pier, base: Base) -> float:
    """Return β below which the pier topples on its springs under its own weight, or at the least push (THEORY.md, eq. 13).

    A spring under the weight, z = −1/η, or with tendons −(1 + ψ)/η, is softer where it is loaded than where it is unloaded, by
    the factor r of its first loading, 1 − |z|ⁿ by Bouc–Wen; both together have 2r/(1 + r) of the elastic springs' stiffness in
    rotation.
    """
    if not (isinstance(base, YieldingBase) and base.eta > 1 and base.n >= 1):
        return pier.least_beta
    carried = base.eta / (1.0 + prestress_over_weight(pier, base.restraints))
    if carried <= 1:
        return pier.least_beta
    softer = float(base.first_loading.tangent(np.array(1.0 / carried)))
    return pier.least_beta * math.sqrt((1.0 + softer) / (2.0 * softer))


def least_eta(pier: Pier, base: Base) -> float:
    """Return η below which the springs cannot carry the weight and the prestress of the tendons."""
    return LEAST_ETA * (1.0 + prestress_over_weight(pier, base.restraints))


def enough_eta(pier: Pier, base: Base) -> float:
    """Return η above which the springs carry weight and prestress, and with the stiffness that they have hold the pier upright.

    The inverse of :func:`least_beta` for a β above that of elastic springs; :func:`least_eta` for another.
    """
    least = least_eta(pier, base)
    if isinstance(base, YieldingBase) and base.beta > pier.least_beta:
        excess = 2.0 * (base.beta / pier.least_beta) ** 2 - 1.0
        low, high = 0.0, 1.0  # of z, between which the stiffness falls to 1/excess
        for _ in range(60):
            middle = 0.5 * (low + high)
            stiff = float(base.first_loading.tangent(np.array(middle))) > 1.0 / excess
            low, high = (middle, high) if stiff else (low, middle)
        least /= high
    return least


def problems(pier: Pier, base: Base) -> list[Problem]:
    """Return what is impossible about ``pier`` on ``base``, with the limit; empty if nothing is."""
    if base.on_springs and pier.deck_over_columns is not None:
        text = (
            f"a rocking frame is solved on rigid ground only, and this base is {base.name}. On springs the columns "
            "sink by themselves, the deck no longer moves level, and no one block stands for them (Makris & Vassiliou 2013); "
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
        wrong += wrong_on_springs(pier, base.restraints)
    if isinstance(base, YieldingBase) and base.eta < (least := least_eta(pier, base)):
        prestress = prestress_over_weight(pier, base.restraints)
        text = (
            f"the springs cannot carry the weight and the prestress of the tendons, psi = {prestress:g} of it; eta must be "
            f"above 1 + psi, {rounded_up(least):g}"
        )
        wrong.append(Problem("eta", base.eta, text, kind=OutOfRange))
    return wrong


def _wrong_footing(pier: Pier, base: FootingBase) -> list[Problem]:
    least, psi = pier.least_beta / math.sqrt(base.rocking_share), prestress_over_weight(pier, base.restraints)
    wrong = []
    if not base.beta > least:
        text = (
            f"the bed is too soft to hold the pier upright, K_θ = ω_v² b²/3 must be above g h; beta must be above {least:.4g}, "
            f"the bed {(least / base.beta) ** 2:.3g} times as stiff"
        )
        wrong.append(Problem("beta", base.beta, text, kind=OutOfRange))
    if base.safety_factor is not None and not base.safety_factor > 1.0 + psi:
        more = f" and the prestress of the tendons, psi = {psi:g} of it" if psi else ""
        text = f"the bed cannot carry the weight{more}; it must be above {1.0 + psi:g}"
        wrong.append(Problem("safety_factor", base.safety_factor, text, kind=OutOfRange))
    if pier.initial_rotation_rad and base.restraints:
        text = "a pier with devices is let go on springs or rigid ground only; leave one out"
        wrong.append(Problem("initial_rotation_rad", pier.initial_rotation_rad, text, kind=Contradiction))
    return wrong


def _wrong_bending(pier: Pier, base: Base) -> list[Problem]:
    wrong = bending_problems(pier)
    if any(place.height != 0.0 for device in base.restraints for place in places(pier, device)):
        text = 'devices on the deck are of a rigid shaft; leave them out, or write shaft = "rigid"'
        wrong.append(Problem("shaft", "elastic", text, kind=Contradiction))
    if isinstance(base, RigidBase) and base.restitution is not None:
        text = "what a blow takes of a shaft that bends follows from the momentum of its mode; leave it out"
        wrong.append(Problem("restitution", base.restitution, text, kind=Contradiction))
    return wrong


def _wrong_contact(pier: Pier, base: RigidBase) -> list[Problem]:
    """Return why the force of a landing foot cannot be estimated."""
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
            f"sqrt((1+mu) cos(alpha)/mu)/sin(alpha) = {pier.least_beta:.4g}"
            + (f", for these springs above {least:.4g}" if least > pier.least_beta else "")
        )
    elif not base.beta > least and isinstance(base, YieldingBase):
        text = (
            "the least push topples the pier, because such springs near their yield force "
            f"(eta = {base.eta:g}, n = {base.n:g}) give way on the loaded side; beta must be above {least:.4g}"
        )
    else:
        return []
    return [Problem("beta", base.beta, text, kind=OutOfRange)]
