"""Small errors that can be put into a source: a sign, a comparison, a number, a dropped condition, two swapped arguments."""

import ast
import copy
from collections.abc import Iterator
from typing import NamedTuple

COMPARED = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
}  # fmt: skip
COMPUTED = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult,
    ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd,
}  # fmt: skip
SYMMETRIC = {
    "min", "max", "isinstance", "cast", "checked", "np.minimum", "np.maximum", "np.fmin", "np.fmax", "math.hypot", "np.hypot",
    "suppress", "windows", "same_counts", "_difference", "_residual_difference", "correlation", "overlap",
    "self._fitting", "self._overlap", "np.array_equal",
}  # fmt: skip
"""Functions to which the order of arguments means nothing, or that fail at once with another."""
FACTOR = 1.1
"""By which a number with a point is wrong; a whole one is off by one."""
ROUNDING = 1e-6
"""Numbers below it are room for rounding, of which a tenth more changes nothing."""


class Mutant(NamedTuple):
    """One error: ``text`` instead of what stands from byte ``start`` to byte ``end`` of the source."""

    line: int
    start: int
    end: int
    before: str
    text: str

    def put_into(self, source: str) -> str:
        """Return the source with the error."""
        data = source.encode()
        return (data[: self.start] + self.text.encode() + data[self.end :]).decode()

    def __str__(self) -> str:
        return " → ".join(" ".join(text.split()) for text in (self.before, self.text))


def mutants(source: str) -> Iterator[Mutant]:
    """Yield every error that can be put into a source, in its order; each still compiles."""
    data, starts = source.encode(), [0]
    for line in data.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    for node in _of_programs(ast.parse(source)):
        for wrong in _wrong(node):
            start, end = (starts[row - 1] + column for row, column in _span(node))
            before = data[start:end].decode()
            after = ast.unparse(wrong)
            yield Mutant(node.lineno, start, end, before, f"({after})" if isinstance(node, ast.expr) else after)


def _span(node: ast.expr) -> tuple[tuple[int, int], tuple[int, int]]:
    return (node.lineno, node.col_offset), (node.end_lineno or node.lineno, node.end_col_offset or node.col_offset)


def _of_programs(node: ast.AST) -> Iterator[ast.expr]:
    """Yield the expressions that a program computes with: no annotations, texts or bases of classes."""
    if isinstance(node, ast.JoinedStr | ast.Raise):  # wordings
        return
    if isinstance(node, ast.keyword) and node.arg == "strict":  # of zip: the program's guard against itself
        return
    if isinstance(node, ast.expr):
        yield node
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "bases", "type_params"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield from _of_programs(child)


def _wrong(node: ast.expr) -> Iterator[ast.expr]:
    """Yield the node with an error at its top."""
    match node:
        case ast.Compare(ops=[op]):
            yield _with(node, ops=[COMPARED[type(op)]()])
        case ast.BoolOp(op=op, values=values):
            yield _with(node, op=ast.Or() if isinstance(op, ast.And) else ast.And())
            for i in range(len(values)):
                rest = values[:i] + values[i + 1 :]
                yield rest[0] if len(rest) == 1 else _with(node, values=rest)
        case ast.UnaryOp(op=ast.Not() | ast.USub(), operand=operand) if not isinstance(operand, ast.Constant):
            yield operand
        case ast.BinOp(op=op, left=left) if type(op) in COMPUTED and not isinstance(left, ast.JoinedStr):
            if not (isinstance(op, ast.Mod) and isinstance(left, ast.Constant) and isinstance(left.value, str)):
                yield _with(node, op=COMPUTED[type(op)]())
        case ast.IfExp(body=body, orelse=other):
            yield body
            yield other
        case ast.Constant(value=bool() as value):
            yield ast.Constant(not value)
        case ast.Constant(value=int() as value):
            yield ast.Constant(value + 1)
        case ast.Constant(value=float() as value) if value >= ROUNDING:
            yield ast.Constant(value * FACTOR)
        case ast.Constant(value=float() as value) if value == 0.0:
            yield ast.Constant(1.0)
        case ast.Call(
            func=func, args=[ast.Name() | ast.Attribute() as first, ast.Name() | ast.Attribute() as second, *rest]
        ):
            if ast.unparse(func) not in SYMMETRIC and ast.dump(first) != ast.dump(second):
                yield _with(node, args=[second, first, *rest])


def _with(node: ast.expr, **fields: object) -> ast.expr:
    changed = copy.copy(node)
    for name, value in fields.items():
        setattr(changed, name, value)
    return changed
