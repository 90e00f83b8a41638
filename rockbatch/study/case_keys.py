"""The keys of the tables [[case]] of a study file."""

from collections.abc import Mapping

from rockbatch.pier import (
    MOST_POINTS,
    WITH_EPSILON,
    WITH_EXPONENT,
    WITH_POINTS,
    ElasticBase,
    FootingBase,
    RigidBase,
    YieldingBase,
)
from rockbatch.pier.backbones import wrong_points
from rockbatch.pier.bases import BASES
from rockbatch.pier.bending import MOST_MODES
from rockbatch.pier.laws import meanings
from rockbatch.pier.sizes import BOUNDS as OF_PIER
from rockbatch.pier.supports import FIXED_BY_POINTS
from rockbatch.pier.traits import BOUNDS, EPSILON_AND_ZETA, ETA_OF_BACKBONE, USUAL, WORDS, wrong_blow
from rockbatch.study.footing_keys import FOOTING_KEYS
from rockbatch.study.piers import PIER
from rockbatch.toml.kinds import KindError, Other, Points, Whole, choice, positive, text, within
from rockbatch.toml.meant import names
from rockbatch.toml.section import CONFIRM, Clash, Key, Section, either

_CALLED = {
    "base": names(
        {
            "rigid": "fixed rigidbase rigidground housner rock",
            "elastic": "spring springs winkler flexible linear compliant",
            "yielding": "inelastic nonlinear plastic elastoplastic elasticplastic epp boucwen bilinear",
            "footing": "bed soil strip foot spreadfooting shallowfoundation",
        }
    ),
    "spring": names(
        {
            "epp": "bilinear elastoplastic elasticplastic elasticperfectlyplastic perfectlyplastic elasticpp",
            "bouc-wen": "smooth",
            "backbone": "multilinear piecewiselinear polyline points trilinear",
        }
    ),
    "impact": names({"landing": "impulse"}),
    "kinematics": names(
        {
            "first-order": "small smallrotations linear linearised linearized 1storder",
            "finite": "large largerotations nonlinear exact full",
        }
    ),
}
_ON_SPRINGS = {"base": tuple(name for name, base in BASES.items() if base.two_springs)}
_ON_GROUND_THAT_GIVES = {"base": tuple(name for name, base in BASES.items() if base.on_springs)}
_NOT_ON_A_BED = {"base": (*_ON_SPRINGS["base"], "rigid")}
_ON_ROCK = {"base": tuple(name for name, base in BASES.items() if not base.on_springs)}
_YIELDS = {"base": tuple(name for name, base in BASES.items() if base.two_springs and base.yields)}

WHICH_DEVICE = "write [[case.damper]], [[case.tendon]], [[case.stop]] or [[case.deck_spring]]"


def _impact_rule(value: object) -> str:
    """Return the name of an impact rule of a shaft that bends. Raises :class:`KindError` for an unknown one."""
    if problem := wrong_blow(str(value)):
        raise KindError(problem, whole=True)
    return str(value)


def _listed(name: str, example: str, words: str, only: Mapping[str, tuple[str, ...]] | None = None) -> Key:
    """Return the key of a field of a base that may be a list: a number within its bounds, or one of its words."""
    kind = within(BOUNDS[name]) if name in BOUNDS else choice(*WORDS[name], called=_CALLED.get(name))
    return Key(kind, example, words, many=True, only=only or {}, usual=USUAL.get(name))


BASE_KEYS = {
    "restitution": _listed(
        "restitution",
        "0.9",
        "Factor on the angular velocity at an impact; default: Housner's, from the geometry.",
        only=_ON_ROCK,
    ),
    "beta": Key(
        positive,
        "40.0",
        "Stiffness as β = ω_v/p, the vertical over the rocking frequency; or give `stiffness_kN_m`.",
        many=True,
        only=_ON_GROUND_THAT_GIVES,
        usual=USUAL["beta"],
    ),
    "stiffness_kN_m": Key(
        positive,
        "2.0e6",
        "Stiffness K of one support, if the mass is given; or give `beta`.",
        many=True,
        only=_ON_SPRINGS,
    ),
    "mass_t": Key(
        positive,
        "3000.0",
        "Mass of all that rocks, unless `[pier]` states it.",
        many=True,
        only=_ON_GROUND_THAT_GIVES,
        usual=PIER["mass_t"].usual,
    ),
    "epsilon": _listed(
        "epsilon",
        "0.05",
        "Restitution ε of the landing pivot, from 0 (no rebound) to 1 (no loss).",
        only=_ON_SPRINGS | {"impact": WITH_EPSILON},
    ),
    "impact": _listed(
        "impact",
        '"landing"',
        'What a landing does: "landing", an impulse at that pivot, by `epsilon`; or "housner", Housner\'s e on the '
        "angular velocity while the other pivot keeps its velocity, for which the supports would have to pull.",
        only=_ON_SPRINGS,
    ),
    "zeta": Key(
        within(BOUNDS["zeta"]),
        "0.05",
        "Damping ratio ζ of the vertical vibration, by a dashpot parallel to each spring; instead of `epsilon`. A footing has "
        "0.05 without it.",
        many=True,
        only=_ON_GROUND_THAT_GIVES,
    ),
    "kinematics": _listed(
        "kinematics",
        '"first-order"',
        'The paper\'s equations, "first-order", or equations for rotations of any size.',
        only=_ON_GROUND_THAT_GIVES,
    ),
    "eta": Key(
        within(ETA_OF_BACKBONE),  # the law decides the limit, which is 1 without points
        "2.5",
        "Strength as η = F_y/(static force of a support), above 1; or give `yield_kN`.",
        many=True,
        only=_YIELDS,
        usual=USUAL["eta"],
    ),
    "yield_kN": Key(
        positive,
        "4.0e4",
        "Yield force F_y of one support, if the mass is given; or give `eta`.",
        many=True,
        only=_YIELDS,
    ),
    "spring": _listed(
        "spring",
        '"bouc-wen"',
        f"Law of the supports: {meanings()}.",
        only=_YIELDS,
    ),
    "backbone_mm_kN": Key(
        Points(
            "a list of points, each [deflection in mm, force in kN]",
            MOST_POINTS,
            wrong_points,
            "write a [[case]] for each backbone",
        ),
        "[[10.0, 2.0e4], [30.0, 3.5e4], [60.0, 4.0e4]]",
        "Backbone of one support in compression: deflections and forces at its corners, from the first one on, and at one point "
        "beyond, after which its slope continues. It is concave and replaces stiffness and strength; the mass must be known.",
        required=True,
        only=_YIELDS | {"spring": WITH_POINTS},
    ),
    "n": _listed(
        "n",
        "5",
        "Bouc–Wen exponent, of hardening springs too: the larger, the sharper the corner between elastic and plastic.",
        only=_YIELDS | {"spring": WITH_EXPONENT},
    ),
    "flight": _listed(
        "flight",
        '"stop"',
        'What happens when both pivots are off the ground: "guided" follows the pier, which shear keys hold sideways, until '
        'it lands, and the run goes on; "stop" ends the run there, as in the paper.',
        only=_NOT_ON_A_BED,
    ),
    "flight_limit_mm": _listed(
        "flight_limit_mm",
        "20.0",
        "Height of the lower pivot in flight beyond which a run carries a note: as far as shear keys reach, say.",
    ),
    "friction": _listed(
        "friction",
        "0.5",
        "Coefficient of friction of the interface, for runs with `forces = true` under `[output]`: those that would slide "
        "say so.",
    ),
    "contact_stiffness_kN_m": _listed(
        "contact_stiffness_kN_m",
        "5.0e6",
        "Stiffness of the ground under one foot, by which runs with `forces = true` estimate the force of their hardest landing: "
        "the column `landing_force_kN`, an orientation that no check takes; it does not affect any run.",
        only=_ON_ROCK,
    ),
    "shaft": _listed(
        "shaft",
        '"rigid"',
        'Whether the shaft bends: "elastic" follows its modes besides, the first of the period `flexural_period_s` of '
        '`[pier]`; on springs with `zeta` and `kinematics = "finite"`, on a footing with the latter.',
    ),
    "flexural_damping": _listed(
        "flexural_damping",
        "0.05",
        "Damping ratio of the first mode, of the pier fixed at its base.",
        only={"shaft": ("elastic",)},
    ),
    "flexural_damping_kind": _listed(
        "flexural_damping_kind",
        '"modal"',
        'Damping of the higher modes: "modal", the same ratio as of the first, or "stiffness", in proportion to their frequency.',
        only={"shaft": ("elastic",)},
    ),
    "flexural_modes": Key(
        Whole(1, f"a whole number, 1 to {MOST_MODES}", MOST_MODES),
        "4",
        "Number of modes of the shaft; default: four, or as many as its masses have. Errors include what one fewer would change.",
        many=True,
        only={"shaft": ("elastic",)},
    ),
    "flexural_impact": Key(
        Other('"momentum"', _impact_rule, {"enum": ["momentum"]}),
        '"momentum"',
        "What a blow keeps, the momentum of the mode: the only rule, so that the key has no effect and may be left out.",
        many=True,
        only=_ON_ROCK | {"shaft": ("elastic",)},
    ),
    "area_m2": _listed(
        "area_m2",
        "6.0",
        "Area of one support, for the bearing stresses of the statics sheet; it does not affect any run.",
        only=_NOT_ON_A_BED,
    ),
    **FOOTING_KEYS,
}
"""Keys that describe a base; in a list each value is a case."""
CASE = Section(
    ("case",),
    (
        "A foundation. Write one for each foundation to compare. All keys but `name`, `base`, `other_width_m`, "
        "`backbone_mm_kN` and `confirm` may be lists: every combination is a case."
    ),
    {
        "name": Key(text, '"soft"', "Its name in tables; the base if there is only one case."),
        "base": Key(
            choice(*BASES, called=_CALLED["base"]),
            '"yielding"',
            '"rigid": Housner\'s block on ground that neither gives nor yields; "elastic": two springs without tension; '
            '"yielding": the same, and the springs yield; "footing": a foot on a bed of strips.',
            required=True,
        ),
        **BASE_KEYS,
        "other_width_m": Key(
            within(OF_PIER["width_m"]),
            "8.0",
            "Width between the pivots across the axis, at right angles to `width_m` of `[pier]`. The case is then run "
            "on both axes, each a planar model under its component of every record, and checks combine them by "
            "`both_axes`.",
            usual=PIER["width_m"].usual,
            only=_NOT_ON_A_BED,
        ),
        **CONFIRM,
    },
    many=True,
    required=True,
    homes=(YieldingBase, ElasticBase, RigidBase, FootingBase),
    also=names(
        {
            "base": "foundation support supports type kind model ground",
            "stiffness_kN_m": "k kv kz springstiffness",
            "yield_kN": "fy strength capacity yieldforce yieldstrength bearingcapacity vult qult ultimate",
            "zeta": "damping dampingratio xi",
            ("restitution", "epsilon"): "cor e r coefficientofrestitution",
            "friction": "mu mus coefficientoffriction",
            "spring": "law hysteresis material uniaxialmaterial springs springlaw springtype",
            "eta": "fs factorofsafety safetyfactor",
            "n": "exponent boucwenn",
            "backbone_mm_kN": "backbone envelope curve points backbonekn",
            "name": "id label title",
            "tendon": "cable cables strand posttensioning",
        }
    ),
    instead=names(
        {
            ("mass_t", "the weight in kN over 9.81"): "weight w",
            "write friction, the tangent of the angle": "phi frictionangle frictiondeg",
            "write zeta, the damping ratio of the vertical vibration": "rayleigh alpham betak",
            WHICH_DEVICE: "device devices restraint restraints",
        }
    ),
    clashes=(
        either("beta", "stiffness_kN_m"),
        either("eta", "yield_kN"),
        *(
            Clash((key, "backbone_mm_kN"), "the first point of backbone_mm_kN fixes the same; leave it out", shown=True)
            for key in FIXED_BY_POINTS
        ),
        Clash(("epsilon", "zeta"), EPSILON_AND_ZETA, shown=True),
        Clash(("impact", "zeta"), EPSILON_AND_ZETA, shown=True),
        Clash(
            ("mass_t",),
            "mass_t is for use with stiffness_kN_m or yield_kN; leave it out",
            lacking=("stiffness_kN_m", "yield_kN", "backbone_mm_kN"),
        ),
    ),
)
