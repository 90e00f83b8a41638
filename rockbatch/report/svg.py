"""Matplotlib figures as inline SVG that takes its colours and fonts from the page."""

import io
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from rockbatch.report.markup import Markup, tag

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.path import Path

# Stand-ins that Matplotlib carries through and the style sheet gives a meaning, for light, dark and print
INK, MUTED, GRID, BAND, ALARM, PAPER = (f"#fe00{i:02x}" for i in range(1, 7))
SERIES = tuple(f"#fe01{i:02x}" for i in range(1, 8))
_VARIABLES = {
    **dict(
        zip((INK, MUTED, GRID, BAND, ALARM, PAPER), ("ink", "muted", "grid", "band", "alarm", "paper"), strict=True)
    ),
    **{colour: f"s{i}" for i, colour in enumerate(SERIES, 1)},
}

# Labels whose subscripts the page sets; Matplotlib's own would bring its own fonts
_SUBSCRIPTS = {
    "θmax/α": ("θ", "max", "/α"),
    "error of θmax/α": ("error of θ", "max", "/α"),
    "üg/g": ("ü", "g", "/g"),
    "v/δy": ("v/δ", "y", ""),
    "F/Fy": ("F/F", "y", ""),
}

# Numbers of markers and colours have no common factor: 70 pairs before one comes back
MARKERS = ("o", "s", "^", "D", "v", "P", "*", "<", ">", "h")


def style_of(index: int) -> tuple[str, str]:
    """Marker and colour of the ``index``-th foundation."""
    return MARKERS[index % len(MARKERS)], SERIES[index % len(SERIES)]


def arrow() -> "Path":
    """Marker of a pier that flies: an arrow up."""
    from matplotlib.path import Path

    corners = [(-0.35, -1), (0.35, -1), (0.35, 0), (1, 0), (0, 1), (-1, 0), (-0.35, 0), (-0.35, -1)]
    return Path(corners, closed=True)


@contextmanager
def drawing(name: str) -> Iterator[None]:
    """Settings under which a figure is made and written; ``name`` keeps its ids apart from other figures'."""
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(
            {
                "svg.fonttype": "none",
                "svg.hashsalt": name,
                "text.parse_math": False,  # a "$" in a record's name is a dollar
                "font.size": 8.5,
                "text.color": INK,
                "axes.edgecolor": MUTED,
                "axes.labelcolor": INK,
                "axes.facecolor": "none",
                "axes.linewidth": 0.6,
                "axes.spines.top": False,
                "axes.spines.right": False,
                "axes.axisbelow": True,
                "figure.facecolor": "none",
                "grid.color": GRID,
                "grid.linewidth": 0.6,
                "xtick.color": MUTED,
                "ytick.color": MUTED,
                "xtick.labelcolor": INK,
                "ytick.labelcolor": INK,
                "xtick.major.size": 2.5,
                "ytick.major.size": 2.5,
                "xtick.major.width": 0.6,
                "ytick.major.width": 0.6,
                "legend.frameon": False,
                "lines.solid_joinstyle": "round",
                "path.simplify_threshold": 0.15,
            }
        )
        yield


def inline(figure: "Figure", description: str) -> Markup:
    """The figure as an ``<svg>`` element; ``description`` is for those who cannot see it."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    buffer = io.StringIO()
    with warnings.catch_warnings():
        # Names in any script are written as text: whether Matplotlib's own font has the glyphs does not matter
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        FigureCanvasSVG(figure).print_svg(
            buffer, metadata={"Date": None, "Creator": None, "Format": None, "Type": None}
        )
    svg = buffer.getvalue()
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>\s*", "", svg, flags=re.DOTALL)
    svg = re.sub(r'<g id="[^"]*"', "<g", svg)
    svg = re.sub(r'\b(d|x|y|width|height|transform)="([^"]*)"', _shorter, svg)
    svg = re.sub(r"font: ([\d.]+px) [^;\"]*", r"font-size: \1", svg)
    svg = re.sub(r"font-family: [^;\"]*;? ?", "", svg)
    for colour, variable in _VARIABLES.items():
        svg = svg.replace(colour, f"var(--{variable})")
    svg = svg.replace(" xlink:href=", " href=")
    for label, (base, index, rest) in _SUBSCRIPTS.items():
        lowered = f'{base}<tspan dy="2" font-size="75%">{index}</tspan>'
        svg = svg.replace(f">{label}<", f'>{lowered}<tspan dy="-2">{rest}</tspan><' if rest else f">{lowered}<")
    svg = re.sub(r">\s+<", "><", svg)
    width, height = figure.get_size_inches() * 72
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="figure" role="img" viewBox="0 0 {width:g} {height:g}" '
        f'style="--w:{width:.0f}px">{tag("title", description)}'
    )
    return Markup(head + svg[svg.index(">") + 1 :].strip())


def _shorter(attribute: re.Match[str]) -> str:
    value = re.sub(r"-?\d+\.\d{3,}", lambda m: f"{float(m[0]):.2f}".rstrip("0").rstrip("."), attribute[2])
    return f'{attribute[1]}="{" ".join(value.split())}"'


def thin(
    x: npt.NDArray[np.float64], y: npt.NDArray[np.float64], buckets: int
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Fewer points of a history that draw the same: of each bucket the first, least, largest and last.

    Parameters
    ----------
    x, y : ndarray, shape (n,)
        Abscissae in order, and ordinates; NaN is allowed in ``y``.
    buckets : int
        One for each pixel across.

    Returns
    -------
    x, y : ndarray, shape (≤ 4 buckets,)
    """
    if len(x) <= 4 * buckets:
        return x, y
    edges = np.linspace(0, len(x), buckets + 1).astype(int)
    kept: set[int] = set()
    for start, end in pairwise(edges):
        kept.update((int(start), int(end) - 1))
        part = y[start:end]
        if not np.isnan(part).all():
            kept.update((int(start + np.nanargmin(part)), int(start + np.nanargmax(part))))
    order = np.array(sorted(kept))
    return x[order], y[order]
