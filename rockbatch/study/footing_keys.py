"""Keys of a footing in a [[case]], as engineers have them: a bed, a toe of some depth, or soil."""

import math
from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any, get_args

from rockbatch.common.errors import Contradiction, InputError, MissingKey, Problem, Unusual
from rockbatch.pier import OF_SHAFT, FootingBase, Pier
from rockbatch.pier.footing_base import POISSON, STRIPS
from rockbatch.pier.parts import Part
from rockbatch.pier.restraints import DeckSpring, Restraint
from rockbatch.pier.sections import distribution_problems
from rockbatch.pier.soil import Formula
from rockbatch.pier.traits import CONFIRMED
from rockbatch.toml.kinds import Kind, Whole, boolean, choice, not_negative, positive, within
from rockbatch.toml.section import Key, fix_the_same

ON_FOOTING = {"base": ("footing",)}
_FIELDS = (
    *("zeta", "kinematics", "friction", "flight_limit_mm", "strips", "length_m", "safety_factor", "beta"),
    *OF_SHAFT,
)

_WAYS = {
    "beta": ("beta",),
    "stiffness_MN_m3": ("stiffness_MN_m3",),
    "young_GPa with depth_m": ("young_GPa", "depth_m"),
    "shear_modulus_MPa with poisson": ("shear_modulus_MPa", "poisson"),
}
"""Ways to give the stiffness of the bed, and the keys of each."""
_BESIDE = {
    "young_GPa": ("depth_m", "length_m"),
    "depth_m": ("young_GPa",),
    "shear_modulus_MPa": ("poisson", "length_m"),
    "poisson": ("shear_modulus_MPa",),
    "bearing_MPa": ("length_m",),
    "stiffness_MN_m3": ("length_m",),
    "embedment_m": ("shear_modulus_MPa",),
    "formula": ("shear_modulus_MPa",),
    "radiation": ("shear_modulus_MPa", "density_t_m3"),
    "density_t_m3": ("radiation",),
}
"""Keys that each key requires beside it."""


def _key(kind: Kind, example: str, words: str) -> Key:
    """Return the declaration of a key that only a footing has, and that may be a list."""
    return Key(kind, example, words, many=True, only=ON_FOOTING)


FOOTING_KEYS = {
    "width_m": _key(
        positive,
        "9.0",
        "Width of the foot in the plane of rocking; default: that of the pier. α of the case is then atan(width_m/2h); devices "
        "stay at the pivots of `[pier]`.",
    ),
    "length_m": _key(positive, "12.0", "Length of the foot across the plane of rocking."),
    "stiffness_MN_m3": _key(positive, "60.0", "Stiffness of the bed; or give soil, or `young_GPa` with `depth_m`."),
    "young_GPa": _key(
        positive, "30.0", "Young's modulus of toes of concrete or steel, whose bed has the stiffness E/depth."
    ),
    "depth_m": _key(positive, "0.5", "Depth of that material."),
    "bearing_MPa": _key(
        positive, "1.2", "Strength of the bed, uniform; or give `safety_factor`. With neither it is elastic."
    ),
    "safety_factor": _key(positive, "3.0", "FS: bearing capacity over the weight of pier and deck, above 1."),
    "shear_modulus_MPa": _key(positive, "60.0", "Shear modulus G of the soil, at the strain that is expected."),
    "poisson": _key(within(POISSON), "0.45", "Poisson's ratio ν of the soil."),
    "embedment_m": _key(not_negative, "2.0", "Depth of the foot's underside below the surface, with walls in contact."),
    "formula": _key(
        choice(*get_args(Formula)),
        '"gazetas"',
        "Formula of the soil's stiffnesses; the bed has its rocking stiffness, from which its vertical one follows.",
    ),
    "radiation": _key(
        boolean,
        "true",
        "Whether dashpots of radiated waves join `zeta`. Strip by strip they overstate the damping of rocking 8 to 100 times.",
    ),
    "density_t_m3": _key(positive, "1.9", "Density of the soil, for `radiation`."),
    "strips": _key(Whole(), "40", f"Strips of the bed, an even number; default: {STRIPS}."),
}
"""Keys of a footing; in a list each value is a case."""


def on_foot(pier: Pier, width_m: float) -> Pier:
    """Return ``pier`` on a foot of another width: with its height and inertia, and α of that foot.

    A solid rectangle gets a part of its own width: α and μ no longer say how its mass is spread.
    """
    half, height = 0.5 * width_m, pier.height
    size = math.hypot(half, height)
    mu = size**2 / pier.inertia
    p = math.sqrt(mu / (1.0 + mu) * pier.gravity / size)
    parts = pier.parts
    if parts is None and not distribution_problems(pier):
        parts = (Part.shaft(2.0 * pier.half_width, 2.0 * height, pier.mass_t or 1.0),)
    return replace(pier, alpha=math.atan2(half, height), p=p, mu=mu, parts=parts, confirm=("p", "mass_t", "top_m"))


def unlikely_foot(pier: Pier, on_its_foot: Pier) -> list[Problem]:
    """Return the problem of a foot narrower than the ``pier`` on it; [] for a wider one."""
    foot, width = 2.0 * on_its_foot.half_width, 2.0 * pier.half_width
    if foot >= width * (1.0 - 1e-9):
        return []
    text = f"the foot is narrower than the pier on it, {width:.4g} m wide"
    return [Problem("width_m", foot, text, confirm="width_m", kind=Unusual)]


def at_pivots(devices: tuple[Restraint, ...], pier: Pier) -> tuple[Restraint, ...]:
    """Return ``devices``, those at pivots of ``pier`` at offsets [m] from the middle, so that a wider foot leaves them in place.

    One that stands at both pivots becomes two.
    """
    ways: dict[float | str | None, tuple[float, ...]] = {None: (-1.0, 1.0), "left": (-1.0,), "right": (1.0,)}
    placed: list[Restraint] = []
    for device in devices:
        if isinstance(device, DeckSpring) or device.at not in ways:
            placed.append(device)
        else:
            placed += [replace(device, at=side * pier.half_width) for side in ways[device.at]]
    return tuple(placed)


def footing_of(
    values: Mapping[str, Any], pier: Pier, devices: tuple[Restraint, ...], confirm: Collection[str]
) -> tuple[FootingBase, list[Problem]]:
    """Return the base of a case on a footing, and its problems; with problems, an elastic base lets other keys be checked.

    ``pier`` is that on the foot; keys in ``confirm`` may be unusual.
    """
    fields: dict[str, Any] = {name: values[name] for name in _FIELDS if name in values}
    fields |= {"restraints": devices, "confirm": tuple(CONFIRMED.intersection(confirm))}
    ways = [way for way, keys in _WAYS.items() if any(key in values for key in keys)]
    fallback = FootingBase(4.0 * pier.least_beta, restraints=devices, confirm=("beta",))
    if len(ways) != 1:
        text = (
            "the stiffness of the bed is missing; write shear_modulus_MPa and poisson of the soil, or stiffness_MN_m3"
        )
        if ways:
            text = fix_the_same(*ways)
        return fallback, [Problem("base", None, text, kind=Contradiction if ways else MissingKey)]
    if wrong := _ill_combined(values):
        return fallback, wrong
    try:
        return _footing_base(values, pier, fields), []
    except InputError as error:
        return fallback, list(error.problems)


def _ill_combined(values: Mapping[str, Any]) -> list[Problem]:
    """Return a problem for each key whose required companion is missing, and for strength given in two ways; [] for none."""
    wrong = [
        Problem(key, values[key], f"{other} is missing beside it", kind=MissingKey)
        for key, others in _BESIDE.items()
        for other in others
        if key in values and other not in values
    ]
    if "bearing_MPa" in values and "safety_factor" in values:
        text = "safety_factor is given, which fixes the same; keep one"
        wrong.append(Problem("bearing_MPa", values["bearing_MPa"], text, kind=Contradiction))
    return wrong


def _footing_base(values: Mapping[str, Any], pier: Pier, fields: dict[str, Any]) -> FootingBase:
    """Return the footing by β, the stiffness of its bed, or soil, whichever is given. Raises ``InputError`` if impossible."""
    if "beta" in values:
        return FootingBase(**fields)
    fields |= {"bearing_MPa": values.get("bearing_MPa")}
    if "shear_modulus_MPa" not in values:
        stiffness = values.get("stiffness_MN_m3") or 1000.0 * values["young_GPa"] / values["depth_m"]
        return FootingBase.from_stiffness(pier, stiffness, **fields)
    density = values["density_t_m3"] if values.get("radiation") else None
    soil = {name: values[name] for name in ("embedment_m", "formula") if name in values}
    return FootingBase.from_soil(
        pier, values["shear_modulus_MPa"], values["poisson"], density_t_m3=density, **soil, **fields
    )
