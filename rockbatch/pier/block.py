"""The pier: a rigid block with its deck, and the rocking frame as an equivalent block."""

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field, fields, replace

from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError, MissingKey, OutOfRange, Problem, refuse
from rockbatch.common.showing import InNotebook
from rockbatch.common.units import GRAVITY
from rockbatch.pier.parts import Part, in_floats, part_problems
from rockbatch.pier.sizes import (
    BOUNDS,
    THICKEST,
    THINNEST,
    USUAL,
    falls,
    odd,
    out_of_bounds,
    unlikely_deck,
    unlikely_heights,
    unlikely_inertia,
    unlikely_sizes,
    unusual,
)

ROUNDING = 1e-9
"""Relative difference of heights that is rounding."""


@checked
@dataclass(frozen=True)
class Pier(InNotebook):
    """A rigid block that can pivot about its two lower corners.

    From sizes in m and masses in t make it by :meth:`rectangle`, :meth:`with_deck`, :meth:`of_parts` or :meth:`frame`.

    Attributes
    ----------
    alpha : float
        Slenderness α [rad]: the angle at a pivot between the vertical and the line to the centre of mass.
    p : float
        Frequency parameter [rad/s], p² = μ/(1+μ) g/R0 (THEORY.md, eq. 1).
    mu : float
        Shape factor μ = M R0²/I0; 3 for a rectangle.
    gravity : float
        g [m/s²].
    mass_t : float, optional
        Mass M of all that rocks [t]; only forces in kN and stiffnesses in kN/m need it.
    top_m : float, optional
        Height above the pivots at which drift is read [m]; that of the highest point by default, see :attr:`highest`.
    deck_over_columns : float, optional
        γ = m_d/(N m_c) of a rocking frame, whose equivalent block this is; see :meth:`frame`.
    deck_height_m : float, optional
        Height above the pivots of the deck's centre [m], whose acceleration is computed; that of the highest point by default.
    initial_rotation_rad : float, default 0
        θ0 [rad], positive to the right, below α: the pier is pulled there slowly, held, and released at the first sample of the
        motion, at rest (THEORY.md, Release from a rotation).
    flexural_period_s : float, optional
        First period of the pier, with its deck, fixed at its base [s]. An elastic shaft (:class:`RigidBase`) vibrates with it,
        unless its parts give their rigidity; runs with a rigid shaft ignore it, and :func:`rockbatch.statics` compares it with
        the period of rocking. ``dataclasses.replace(pier, flexural_period_s=0.6)`` adds it.
    parts : tuple of Part, optional
        Its parts, by which forces in sections know how the mass is spread over the height; see :meth:`of_parts`. Without
        them the pier is a solid rectangle there, if ``mu`` is 3.

    confirm : sequence of str
        Fields that are right though unusual: "p", "mass_t", …

    Raises ``InputError`` with every value that is impossible, or unusual and not confirmed.

    Examples
    --------
    >>> tower = rb.Pier(alpha=0.13, p=0.38)
    >>> f"R0 = {tower.size:.1f} m, e = {tower.restitution:.4f}"
    'R0 = 51.0 m, e = 0.9748'
    >>> tall = rb.Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=1000)
    >>> f"alpha = {tall.alpha:.4f} rad, p = {tall.p:.4f} rad/s, mu = {tall.mu:.3f}"
    'alpha = 0.1974 rad, p = 0.6206 rad/s, mu = 4.017'
    """

    alpha: float
    p: float
    mu: float = 3.0
    gravity: float = GRAVITY
    mass_t: float | None = None
    top_m: float | None = None
    deck_over_columns: float | None = None
    deck_height_m: float | None = None
    initial_rotation_rad: float = field(default=0.0, kw_only=True)
    flexural_period_s: float | None = field(default=None, kw_only=True)
    parts: tuple[Part, ...] | None = field(default=None, kw_only=True, repr=False)
    confirm: Sequence[str] = field(default=(), kw_only=True, compare=False, repr=False)

    def __post_init__(self) -> None:
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        wrong = out_of_bounds(**{name: value for name, value in values.items() if name in BOUNDS})
        refuse(wrong or falls(self.alpha, self.initial_rotation_rad))
        doubts = unusual(USUAL, self.confirm, **{name: value for name, value in values.items() if name in USUAL})
        refuse(doubts or unlikely_mass(self, self.confirm))

    @classmethod
    @checked
    def from_size(
        cls,
        alpha: float,
        size_m: float,
        mu: float = 3.0,
        gravity: float = GRAVITY,
        *,
        mass_t: float | None = None,
        top_m: float | None = None,
        confirm: Collection[str] = (),
    ) -> "Pier":
        """Return a pier of the size R0 [m], the distance from a pivot to the centre of mass.

        Here and in the other constructors from lengths, ``confirm`` names values that are right though unusual: "width_m",
        "top_m", "deck_height_m", "mass_t", "deck_mass_t", "deck_inertia_t_m2".
        Raises ``InputError`` for what is impossible or not confirmed.
        """
        refuse(
            out_of_bounds(alpha=alpha, size_m=size_m, mu=mu, gravity=gravity)
            or unusual(USUAL, confirm, size_m=size_m)
            + unlikely_sizes(0.0, 2 * size_m * math.cos(alpha), confirm, top_m=top_m)
        )
        p = math.sqrt(mu / (1 + mu) * gravity / size_m)
        return cls(alpha, p, mu, gravity, mass_t, top_m, confirm=(*confirm, "p"))

    @classmethod
    @checked
    def rectangle(
        cls,
        width_m: float,
        height_m: float,
        gravity: float = GRAVITY,
        *,
        mass_t: float | None = None,
        top_m: float | None = None,
        confirm: Collection[str] = (),
    ) -> "Pier":
        """Return a solid rectangular block; its width and height [m] give α, R0 and μ = 3. ``confirm``: see :meth:`from_size`."""
        wrong = out_of_bounds(width_m=width_m, height_m=height_m)
        wrong = wrong or unusual(USUAL, confirm, width_m=width_m, height_m=height_m)
        refuse(wrong or unlikely_sizes(width_m, height_m, confirm, top_m=top_m))
        alpha, size = math.atan2(width_m, height_m), math.hypot(width_m, height_m) / 2
        return cls.from_size(
            alpha, size, 3.0, gravity, mass_t=mass_t, top_m=top_m, confirm=(*confirm, "top_m", "size_m")
        )

    @classmethod
    @checked
    def of_parts(
        cls,
        width_m: float,
        parts: Iterable[Part],
        *,
        top_m: float | None = None,
        deck_height_m: float | None = None,
        gravity: float = GRAVITY,
        confirm: Collection[str] = (),
    ) -> "Pier":
        """Return a pier of any shape, with what it carries (THEORY.md, The pier).

        Parameters
        ----------
        width_m : float
            Between the pivots, 2b [m].
        parts : iterable of Part
            Or of (mass_t, height_m, inertia_t_m2, length_m): masses m_i at heights h_i, with inertias I_i about their own
            centres, spread over a length or not.
        top_m : float, optional
            Height at which drift is read [m]; the highest upper end of a part, or the deck, by default.
        deck_height_m : float, optional
            Height at which the deck's acceleration is computed [m]; without a deck at the highest point.
        confirm : collection of str
            See :meth:`from_size`.

        Returns
        -------
        Pier
            M = Σ m_i, h = Σ m_i h_i/M, I0 = Σ [I_i + m_i (h_i − h)²], α = atan(b/h) and μ = M R0²/I0.

        Raises
        ------
        InputError
            With every impossible number; part 1 is the first.
        """
        try:
            parts = [in_floats(*part) for part in parts]
        except (TypeError, ValueError, OverflowError) as error:
            raise InputError("parts: must be Part(mass_t, height_m, inertia_t_m2), or three numbers, each") from error
        wrong = out_of_bounds(width_m=width_m) or unusual(USUAL, confirm, width_m=width_m)
        for n, part in enumerate(parts, 1):
            wrong += part_problems(n, part)
        if not parts:
            wrong.append(Problem("parts", None, "there are none; a pier has at least one", kind=MissingKey))
        refuse(wrong)
        mass = math.fsum(part.mass_t for part in parts)
        height = math.fsum(part.mass_t * part.height_m for part in parts) / mass
        inertia = math.fsum(part.inertia_t_m2 + part.mass_t * (part.height_m - height) ** 2 for part in parts)
        if height == 0 or inertia == 0:
            lack = "no height" if height == 0 else "no rotary inertia about their common centre"
            raise InputError(f"parts: they have {lack}; a shaft has m (width² + height²)/12 at half its height")
        refuse(unlikely_sizes(width_m, 2 * height, confirm, deck_height_m=deck_height_m))
        size = math.hypot(0.5 * width_m, height)
        alpha = math.atan2(0.5 * width_m, height)
        confirmed = (*confirm, "top_m", "mass_t", "size_m")
        pier = cls.from_size(alpha, size, mass * size**2 / inertia, gravity, mass_t=mass, confirm=confirmed)
        refuse(unlikely_mass(pier, confirm, "width_m"))
        pier = replace(pier, parts=tuple(parts), top_m=top_m, deck_height_m=deck_height_m)
        refuse(unlikely_heights(pier.highest, confirm, top_m=top_m))
        return pier

    @classmethod
    @checked
    def with_deck(
        cls,
        width_m: float,
        height_m: float,
        mass_t: float,
        deck_mass_t: float,
        *,
        deck_height_m: float | None = None,
        deck_inertia_t_m2: float = 0.0,
        top_m: float | None = None,
        gravity: float = GRAVITY,
        confirm: Collection[str] = (),
    ) -> "Pier":
        """Return a uniform shaft of ``width_m`` × ``height_m`` and ``mass_t``, with a deck on it.

        ``deck_height_m`` is that of the deck's centre, at the top of the shaft by default; ``deck_inertia_t_m2`` its rotary
        inertia about it, 0 for a deck on bearings that does not turn with the pier. Drift is read at ``top_m``, by default the
        higher of shaft and deck. See :meth:`of_parts`, and :meth:`from_size` for ``confirm``.
        """
        wrong = out_of_bounds(width_m=width_m, height_m=height_m, mass_t=mass_t, deck_mass_t=deck_mass_t)
        refuse(
            wrong
            or unusual(USUAL, confirm, width_m=width_m, height_m=height_m, mass_t=mass_t, deck_mass_t=deck_mass_t)
            + unlikely_sizes(width_m, height_m, confirm, deck_height_m=deck_height_m, top_m=top_m)
            + unlikely_deck(mass_t, deck_mass_t, confirm)
        )
        deck = Part(deck_mass_t, height_m if deck_height_m is None else deck_height_m, deck_inertia_t_m2, 0.0)
        refuse(unlikely_inertia(deck_mass_t, deck_inertia_t_m2, deck.height_m, confirm))
        parts = [Part.shaft(width_m, height_m, mass_t), deck]
        confirmed = (*confirm, "width_m", "top_m", "deck_height_m")
        pier = cls.of_parts(
            width_m, parts, top_m=top_m, deck_height_m=deck.height_m, gravity=gravity, confirm=confirmed
        )
        refuse(unlikely_mass(pier, confirm))
        return pier

    @classmethod
    @checked
    def frame(cls, column: "Pier", columns: int, deck_mass_t: float, *, confirm: Collection[str] = ()) -> "Pier":
        """Return a rocking frame: equal columns, and a deck that rests on their tops and keeps level (Makris & Vassiliou 2013).

        Parameters
        ----------
        column : Pier
            One column, a solid rectangle with its mass.
        columns : int
            N, 2 or more.
        deck_mass_t : float
            m_d [t], of the deck on all of them; with γ = m_d/(N m_c).
        confirm : collection of str
            See :meth:`from_size`.

        Returns
        -------
        Pier
            The block that rotates as the columns do: α of a column, p̂ = p √((1+2γ)/(1+3γ)), and μ = 3 (1+2γ)²/(1+4γ), by which
            ``size``, ``height`` and ``inertia`` are those of the whole per unit of its mass N m_c + m_d. ``half_width`` is a
            column's, and ``restitution`` the frame's. For rigid ground only; devices below it are those of all columns together.
            A bent whose columns are fixed to its cap beam is one pier, :meth:`of_parts`.

        Raises
        ------
        InputError
            With every impossible number.
        """
        if not isinstance(column, cls):
            raise InputError("column: must be a Pier, a solid rectangle with its mass")
        wrong = out_of_bounds(deck_mass_t=deck_mass_t)
        if columns < 2:
            text = "must be a whole number, 2 or above; a single one is a pier with a deck"
            wrong.append(Problem("columns", columns, text, kind=OutOfRange))
        if column.mass_t is None:
            wrong.append(Problem("mass_t", None, "mass_t is missing, of one column [t]", kind=MissingKey, named=False))
        if not math.isclose(column.mu, 3.0) or column.deck_over_columns is not None:
            wrong.append(
                Problem("mu", column.mu, "the columns of a frame are solid rectangles, mu = 3", kind=OutOfRange)
            )
        refuse(wrong)
        assert column.mass_t is not None
        refuse(unlikely_deck(columns * column.mass_t, deck_mass_t, confirm))
        ratio = deck_mass_t / (columns * column.mass_t)
        return cls(
            column.alpha,
            column.p * math.sqrt((1 + 2 * ratio) / (1 + 3 * ratio)),
            3 * (1 + 2 * ratio) ** 2 / (1 + 4 * ratio),
            column.gravity,
            mass_t=columns * column.mass_t + deck_mass_t,
            deck_over_columns=ratio,
            confirm=(*confirm, "p", "mass_t", "top_m"),
        )

    def _facts(self) -> tuple[str, dict[str, str]]:
        """Return "Pier" and its entries in run.json to five digits, which a notebook shows."""
        return "Pier", {name: f"{value:.5g}" for name, value in described(self).items()}

    @property
    def size(self) -> float:
        """Return R0 [m], from a pivot to the centre of mass."""
        return self.mu / (1 + self.mu) * self.gravity / self.p**2

    @property
    def half_width(self) -> float:
        """Return b = R0 sin α [m]; of a frame that of a column, whose R0 is (1+γ)/(1+2γ) of the equivalent block's."""
        return self._column_share * self.size * math.sin(self.alpha)

    @property
    def height(self) -> float:
        """Return h = R0 cos α [m], of the centre of mass above the pivots."""
        return self.size * math.cos(self.alpha)

    @property
    def inertia(self) -> float:
        """Return I0/M = R0²/μ [m²], about the centre of mass, per unit mass."""
        return self.size**2 / self.mu

    @property
    def inertia_about_pivot(self) -> float:
        """Return I0/M + R0² [m²], about a pivot, per unit mass."""
        return self.inertia + self.size**2

    @property
    def _column_share(self) -> float:
        """Return R0 of a column over R0 of the frame's equivalent block; 1 for a single pier."""
        ratio = self.deck_over_columns
        return 1.0 if ratio is None else (1 + ratio) / (1 + 2 * ratio)

    @property
    def highest(self) -> float:
        """Return the height of the highest point above the pivots [m]: of its parts and its deck.

        Without parts the pier is as a rectangle, twice as high as its centre of mass; a frame is as high as its columns.
        """
        ends = [part.upper_end for part in self.parts] if self.parts else [2.0 * self._column_share * self.height]
        return max(*ends, self.deck_height_m or 0.0)

    @property
    def top(self) -> float:
        """Return the height above the pivots at which drift is read [m]: ``top_m``, or that of the highest point."""
        return self.highest if self.top_m is None else self.top_m

    @property
    def deck(self) -> float:
        """Return the height at which the deck's acceleration is computed [m]: ``deck_height_m``, or that of the highest point."""
        return self.highest if self.deck_height_m is None else self.deck_height_m

    @property
    def restitution(self) -> float:
        """Return the factor e on the angular velocity at an impact on rigid ground, keeping angular momentum (THEORY.md, eq. 16).

        Housner's 1 − 2μ/(1+μ) sin²α, or (1 − 3/2 sin²α + 3γ cos 2α)/(1 + 3γ) of a frame (Makris & Vassiliou 2013). A pier so
        stocky that this is negative would have to turn back through the corner that it has just landed on: it stops, e = 0.
        """
        loss = 2.0 * self.mu / (1.0 + self.mu)
        if self.deck_over_columns is not None:
            loss = (1.5 + 6.0 * self.deck_over_columns) / (1.0 + 3.0 * self.deck_over_columns)
        return max(0.0, 1.0 - loss * math.sin(self.alpha) ** 2)

    @property
    def shaft_share(self) -> float:
        """Return the share of the shaft or the columns in the mass of these and the deck on top, without a footing below.

        Among parts, the deck is the point masses at or above the highest upper end of those with a length, and if none has a
        length, the highest mass; a footing is a part on the pivots that is wider than long, below others with a length.
        """
        if self.parts is None:
            return share_of_shaft(self.alpha, self.mu, self.deck_over_columns)
        long = [part for part in self.parts if part.length_m]
        end = max(part.upper_end for part in long or self.parts) * (1.0 - ROUNDING)
        above = [part for part in self.parts if not (part.is_slab_at_foot and len(long) > 1)]
        carried = math.fsum(part.mass_t for part in above if not part.length_m and part.height_m >= end)
        return 1.0 - carried / math.fsum(part.mass_t for part in above)

    @property
    def least_beta(self) -> float:
        """Return β = ω_v/p below which the pier topples on its springs under its own weight (g h > ω_v² b²)."""
        return math.sqrt((1 + self.mu) * math.cos(self.alpha) / self.mu) / math.sin(self.alpha)


def share_of_shaft(alpha: float, mu: float, deck_over_columns: float | None = None) -> float:
    """Return :attr:`Pier.shaft_share` of a pier without parts: of a uniform shaft with a mass on top, or of a frame.

    If the shaft has r times the mass on top, M h²/I0 = μ cos²α = 3 + 12/(r² + 4r); 1 if that is 3 or less.
    """
    if deck_over_columns is not None:
        return 1.0 / (1.0 + deck_over_columns)
    excess = mu * math.cos(alpha) ** 2 - 3.0
    if excess <= 0.0:
        return 1.0
    ratio = 2.0 * (math.sqrt(1.0 + 3.0 / excess) - 1.0)
    return ratio / (1.0 + ratio)


def unlikely_mass(pier: Pier, confirm: Collection[str], name: str = "mass_t") -> list[Problem]:
    """Return the problem of an implausible density of a pier; empty without a mass, or if ``name`` is in ``confirm``.

    ``name`` is the mass, or "width_m" if the parts of the pier give its mass.
    """
    volume = 8.0 * pier.half_width**2 * pier.height
    if pier.mass_t is None or THINNEST <= pier.mass_t / volume <= THICKEST or name in confirm:
        return []
    width, density = 2.0 * pier.half_width, pier.mass_t / volume
    text = (
        f"a block {width:.3g} m wide and as thick, {2 * pier.height:.3g} m high, of {pier.mass_t:g} t would have "
        f"{density:.2g} t/m³"
    )
    return [odd(name, pier.mass_t if name == "mass_t" else width, text)]


def described(pier: Pier) -> dict[str, float]:
    """Return a pier by the keys of run.json; mass, γ, deck and period only if given, θ0 unless it is 0.

    ``top_m`` is the height at which drift is read, whether it was given or not; ``shaft_share`` is there of a pier of parts.
    """
    values = {
        "alpha": pier.alpha,
        "p": pier.p,
        "mu": pier.mu,
        "gravity": pier.gravity,
        "size_m": pier.size,
        "half_width_m": pier.half_width,
        "height_m": pier.height,
        "highest_m": pier.highest,
        "top_m": pier.top,
    }
    for name in ("mass_t", "deck_over_columns", "deck_height_m", "flexural_period_s"):
        if (value := getattr(pier, name)) is not None:
            values[name] = value
    if pier.parts is not None:
        values["shaft_share"] = pier.shaft_share
    if pier.initial_rotation_rad:
        values["initial_rotation_rad"] = pier.initial_rotation_rad
    return values
