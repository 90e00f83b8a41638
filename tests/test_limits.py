"""A limit is compared on the side on which its words say it is: what is "more than" one is above it, and not at it.

Nothing else tells whether a value at a limit is within: tests try values on both sides, and hardly ever the limit itself. Without
words about it in the function, its name has to say it: a value is too much above MOST_…, and too little below LEAST_….
"""

import ast
import re
from itertools import pairwise
from pathlib import Path

import rockbatch

TOP = Path(rockbatch.__file__).parent
ABOVE, BELOW = (ast.Gt, ast.LtE), (ast.Lt, ast.GtE)
"""Comparisons of a value with a limit on their right that count the limit itself as below it, or as above it."""
TURNED = {ast.Gt: ast.Lt, ast.Lt: ast.Gt, ast.GtE: ast.LtE, ast.LtE: ast.GtE}
HERE = "LIMIT"
SAID = {
    ABOVE: rf"(more than|above|over|exceeds?|beyond|longer|larger|up to|at most)( than)? {HERE}|{HERE}[^.;,]* (at|are the) most",
    BELOW: rf"(fewer than|less than|below|at least|shorter than) {HERE}|{HERE}( \w+)? or (more|above)",
}
NAMED = {
    ABOVE: r"_?(MOST|LARGEST|LONGEST|GREATEST|FARTHEST|HIGHEST|HEAVIEST|THICKEST|WIDEST|BROADEST|QUICKEST)(_|$)",
    BELOW: r"_?(LEAST|FEWEST|SHORTEST|LOWEST|LIGHTEST|THINNEST|NARROWEST)(_|$)",
}
ROOM = {
    "batch/dask.py: deaths >= MOST_DEATHS", "motions/formats/table.py: len(header) < _MOST_HEADER",
    "motions/sources/stationxml.py: len(self.texts.get(key, '')) < _LONGEST",
    "motions/sources/stationxml.py: len(self.site) < _LONGEST",
    "motions/manifest.py: len(file.problems) < _MOST_HINTS", "reporting/sections/histories.py: count < MOST_HISTORIES",
    "toml/lines.py: index < _MOST_ELEMENTS", "toml/reader.py: len(self.problems) >= MOST_REPORTED",
}  # fmt: skip
"""Comparisons that ask whether there is room for one more."""
NEVER_AT_IT = {
    "analyses/fragility/lognormal.py: optimum.x[1] > LEAST_SLOPE", "motions/quality/places.py: depth > _LEAST_DEPTH",
    "motions/identity/pairing.py: np.abs(common.first).max() < _MOST_OF_IT * h.pga",
    "study/bound_keys.py: 1.0 / _MOST < times < _MOST",
    "reporting/overview.py: limit.theta < MOST_STRETCH * top", "results/shape.py: -MOST < value < MOST",
    "toml/kinds.py: 0.0 < bounds.low <= LEAST", "toml/kinds.py: bounds.high >= MOST",
}  # fmt: skip
"""Comparisons of measures, which meet no limit, and with the bounds of all numbers."""


COMPARED = re.compile(r"[<>]=? .*\b_?[A-Z]{3}|\b_?[A-Z_]{3,}\b.* [<>]")
"""What a line has that compares something with a constant."""


def functions():
    """Yield each function of the package with a comparison of a constant, and its file."""
    for path in sorted(TOP.rglob("*.py")):
        for part in path.read_text(encoding="utf-8").split("\n\n\n"):
            if COMPARED.search(part):
                inside = ast.walk(ast.parse(part))
                yield from (
                    (path.relative_to(TOP).as_posix(), node) for node in inside if isinstance(node, ast.FunctionDef)
                )


def limits_in(node):
    """Return the names of constants that an operand is, alone or times something."""
    parts = (
        [node.left, node.right] if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div) else [node]
    )
    names = (getattr(part, "id", getattr(part, "attr", "")) for part in parts)
    return [name for name in names if isinstance(name, str) and name.isupper()]


def compared(function):
    """Yield each comparison with a limit: its text, the limit, and the side on which the limit itself counts."""
    for node in ast.walk(function):
        if isinstance(node, ast.Compare):
            for (left, right), operator in zip(pairwise([node.left, *node.comparators]), node.ops, strict=True):
                for name, kind in (
                    *((name, TURNED.get(type(operator))) for name in limits_in(left)),
                    *((name, type(operator)) for name in limits_in(right)),
                ):
                    if kind in TURNED:
                        yield ast.unparse(node), name, ABOVE if kind in ABOVE else BELOW


def words_on(function, limit):
    """Return what the docstring and the messages of a function say of a limit, which stands in them as LIMIT."""
    found = [re.sub(rf":data:`{limit}`|``{limit}``", HERE, ast.get_docstring(function) or "")]
    for node in ast.walk(function):
        if isinstance(node, ast.JoinedStr):
            values = (
                part.value if isinstance(part, ast.Constant) else f"{ast.unparse(part.value)}" for part in node.values
            )
            found.append("".join(values).replace(limit, HERE))
    return " ".join(" ".join(found).split())


def sides(texts, patterns):
    return [side for side, pattern in patterns.items() if re.search(pattern, texts)]


def test_limits_are_compared_on_the_side_that_their_words_say():
    said, others = 0, set()
    for file, function in functions():
        for text, limit, side in compared(function):
            stated = sides(words_on(function, limit), SAID) or sides(limit, NAMED)
            said += len(stated) == 1
            if len(stated) == 1 and side not in stated:
                others.add(f"{file}: {text}")
    assert others == ROOM | NEVER_AT_IT
    assert said > 150
