"""Small errors that can be put into a source.

A sign, a comparison, a number, a factor of a thousand, a dropped condition or statement, another function or column of the same
kind, two swapped arguments, two swapped fields of a message.
"""

import ast
import copy
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple, TypeVar

Program = ast.expr | ast.stmt
Node = TypeVar("Node", bound=Program)

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
_PAIRS = (
    "min max, minimum maximum, fmin fmax, nanmin nanmax, argmin argmax, any all, sin cos, floor ceil, mean median, isnan isinf, "
    "startswith endswith, removeprefix removesuffix, partition rpartition, append extend, add discard, upper lower"
)
EXCHANGED = dict(turn for pair in map(str.split, _PAIRS.split(", ")) for turn in (pair, pair[::-1]))
"""Functions and methods by others that take the same arguments."""
UNITS = (1e3, 1e-3, 1e6)
"""Factors between units: one that is forgotten is 1."""
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
    tree = ast.parse(source)
    columns = _columns(tree)
    for node in _of_programs(tree):
        for wrong in (*_wrong(node), *_dropped(node), *_exchanged(node, columns)):
            start, end = (starts[row - 1] + column for row, column in _span(node))
            before = data[start:end].decode()
            after = ast.unparse(wrong)
            yield Mutant(node.lineno, start, end, before, f"({after})" if isinstance(node, ast.expr) else after)


def _span(node: Program) -> tuple[tuple[int, int], tuple[int, int]]:
    return (node.lineno, node.col_offset), (node.end_lineno or node.lineno, node.end_col_offset or node.col_offset)


def _of_programs(node: ast.AST) -> Iterator[Program]:
    """Yield statements, and the expressions that a program computes with: no annotations, plain texts or bases of classes."""
    if isinstance(node, ast.Raise):  # a wording
        yield from (each for each in ast.walk(node) if isinstance(each, ast.JoinedStr))
        return
    if isinstance(node, ast.keyword) and node.arg == "strict":  # of zip: the program's guard against itself
        return
    if isinstance(node, Program):
        yield node
    if isinstance(node, ast.JoinedStr):
        return
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "bases", "type_params"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield from _of_programs(child)


def _wrong(node: Program) -> Iterator[ast.expr]:
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
            if value in UNITS:
                yield ast.Constant(1)
        case ast.Constant(value=float() as value) if value >= ROUNDING:
            yield ast.Constant(value * FACTOR)
            if value in UNITS:
                yield ast.Constant(1.0)
        case ast.Constant(value=float() as value) if value == 0.0:
            yield ast.Constant(1.0)
        case ast.Call(
            func=func, args=[ast.Name() | ast.Attribute() as first, ast.Name() | ast.Attribute() as second, *rest]
        ):
            if ast.unparse(func) not in SYMMETRIC and ast.dump(first) != ast.dump(second):
                yield _with(node, args=[second, first, *rest])


def _dropped(node: Program) -> Iterator[Program]:
    """Yield what is left where a statement is dropped that binds no name."""
    match node:
        case ast.Expr(value=ast.Call()) | ast.AugAssign() | ast.Assign(targets=[ast.Attribute() | ast.Subscript()]):
            yield ast.Pass()
        case ast.Continue() | ast.Break():
            yield ast.Pass()


def _exchanged(node: Program, columns: dict[str, str]) -> Iterator[ast.expr]:
    """Yield the node with another function of the same arguments, another column, or two fields of a message swapped."""
    match node:
        case ast.Call(func=ast.Name(id=name) as func) if name in EXCHANGED:
            yield _with(node, func=_with(func, id=EXCHANGED[name]))
        case ast.Call(func=ast.Attribute(attr=name) as func) if name in EXCHANGED:
            yield _with(node, func=_with(func, attr=EXCHANGED[name]))
        case ast.Subscript(slice=ast.Constant(value=str() as name)) if name in columns:
            yield _with(node, slice=ast.Constant(columns[name]))
        case ast.JoinedStr(values=parts):
            fields = [i for i, part in enumerate(parts) if isinstance(part, ast.FormattedValue)]
            for i, k in pairwise(fields):
                if ast.dump(parts[i]) != ast.dump(parts[k]):
                    swapped = {i: parts[k], k: parts[i]}
                    yield _with(node, values=[swapped.get(number, part) for number, part in enumerate(parts)])


def _columns(tree: ast.AST) -> dict[str, str]:
    """Return the columns that a source names, each with the next one."""
    named = [node.slice for node in ast.walk(tree) if isinstance(node, ast.Subscript)]
    names = list(
        dict.fromkeys(one.value for one in named if isinstance(one, ast.Constant) and isinstance(one.value, str))
    )
    return dict(zip(names, names[1:] + names[:1], strict=True)) if len(names) > 1 else {}


def _with(node: Node, **fields: object) -> Node:
    changed = copy.copy(node)
    for name, value in fields.items():
        setattr(changed, name, value)
    return changed
