"""Named tuples of numbers in records and in lanes: get, put, move, and linear combinations.

A table of lanes is one record, in which each field holds one number for each lane: a loop over lanes reads contiguous memory,
and the compiler can process several lanes with one instruction.
"""

from collections.abc import Mapping
from typing import NamedTuple, get_type_hints

import numba
import numpy as np
from llvmlite import ir
from numba.core import types
from numba.extending import intrinsic

from rockbatch.core.kernel import kernel

LANES = 16
"""Runs that a table holds side by side."""

WIDEST = 64
"""Bytes that the widest vector instructions take at a time, and of a line of the cache."""

ZERO = np.int64(0)  # typed: with a literal 0 every callee would be compiled twice

_CODES = {float: "f8", int: "i8"}
_DOUBLE = ir.DoubleType()


def record(kind: type[NamedTuple]) -> np.dtype:
    """Return the dtype of a record with the fields of ``kind``: f8 for a float, i8 for an int."""
    return np.dtype([(name, _CODES[hint]) for name, hint in get_type_hints(kind).items()])


def lanes_of(parts: Mapping[str, type[NamedTuple]]) -> np.dtype:
    """Return the dtype of a table: each of ``parts`` a record with LANES numbers for each field of its named tuple."""
    return np.dtype([(part, [(name, "f8", LANES) for name in kind._fields]) for part, kind in parts.items()])


def with_beds(lanes: np.dtype, beds: np.dtype) -> np.dtype:
    """Return ``lanes`` with a last field "beds" of the dtype ``beds``, which stays in place as lanes are moved.

    A lane refers to its bed by a slot, which moves with it; the numbers of a bed lie next to each other.
    """
    return np.dtype([*((name, lanes[name]) for name in lanes.names or ()), ("beds", beds)])


def aligned(count: int, kind: np.dtype) -> np.recarray:
    """Return ``count`` records of ``kind``, all zeros, from an address that is a multiple of WIDEST.

    Elsewhere each access of the widest instructions touches two lines of the cache: a pass with devices took a tenth more time.
    """
    memory = np.zeros(count * kind.itemsize + WIDEST, np.uint8)
    start = -memory.__array_interface__["data"][0] % WIDEST
    return memory[start : start + count * kind.itemsize].view(kind).view(np.recarray)


def table(lanes: np.dtype) -> tuple[np.recarray, np.ndarray]:
    """Return an array of one record of ``lanes``, all zeros, and a view of its numbers as rows with a column for each lane.

    The view leaves out beds.
    """
    memory = aligned(1, lanes)
    fields = lanes.fields
    movable = fields["beds"][1] if fields is not None and "beds" in fields else lanes.itemsize
    return memory, memory.view("f8", np.ndarray)[: movable // 8].reshape(-1, LANES)


@kernel
def move(cells, i, j):
    """Copy lane ``i``, a column of ``cells``, to lane ``j``."""
    for k in range(len(cells)):
        cells[k, j] = cells[k, i]


def _interpreted_get(part, i, kind):
    kind = kind if isinstance(kind, type) else type(kind)
    return kind(*(float(part[name][i]) for name in kind._fields))


def _interpreted_taken(line, kind):
    return kind(*(float(line[name]) for name in kind._fields))


def _interpreted_put(part, i, value):
    for name, number in zip(value._fields, value, strict=True):
        part[name][i] = number


def _interpreted_with_pull(m, pull):
    return m._replace(pull=pull)


def _interpreted_with_rates(y, v_rate, omega):
    return y._replace(v_rate=v_rate, omega=omega)


def _interpreted_with_z(y, left, right):
    return y._replace(z_left=left, z_right=right)


def _interpreted_along(y, k, h):
    return type(y)(*(a + h * b for a, b in zip(y, k, strict=True)))


def _interpreted_weighted(k1, k2, k3, k4):
    return type(k1)(*(a + 2.0 * (b + c) + d for a, b, c, d in zip(k1, k2, k3, k4, strict=True)))


def _interpreted_selected(first, a, b):
    return a if first else b


def _addresses(builder, part, pointer, lane, names):
    base = builder.bitcast(pointer, ir.IntType(8).as_pointer())
    for name in names:
        field = builder.gep(base, [ir.Constant(ir.IntType(64), part.offset(name))], inbounds=True)
        yield builder.gep(builder.bitcast(field, _DOUBLE.as_pointer()), [lane], inbounds=True)


@intrinsic
def _get(typing_context, part, i, kind):
    """Return lane ``i`` of a part of the table as a named tuple; ``kind`` is its class or an instance of it."""
    fields = kind.instance_class._fields
    result = types.NamedUniTuple(types.float64, len(fields), kind.instance_class)

    def generate(context, builder, signature, arguments):
        places = _addresses(builder, part, arguments[0], arguments[1], fields)
        return context.make_tuple(builder, result, [builder.load(place) for place in places])

    return result(part, i, kind), generate


@intrinsic
def _taken(typing_context, line, kind):
    """Return the named tuple of class ``kind`` with the numbers that a record has in fields of the same names."""
    fields = kind.instance_class._fields
    result = types.NamedUniTuple(types.float64, len(fields), kind.instance_class)

    def generate(context, builder, signature, arguments):
        start = context.get_constant(types.intp, 0)
        places = _addresses(builder, line, arguments[0], start, fields)
        return context.make_tuple(builder, result, [builder.load(place) for place in places])

    return result(line, kind), generate


@intrinsic
def _put(typing_context, part, i, value):
    """Write a named tuple into the fields of the same names of lane ``i`` of a part of the table."""

    def generate(context, builder, signature, arguments):
        places = _addresses(builder, part, arguments[0], arguments[1], value.instance_class._fields)
        for j, place in enumerate(places):
            builder.store(builder.extract_value(arguments[2], j), place)
        return context.get_dummy_value()

    return types.void(part, i, value), generate


@intrinsic
def _with_pull(typing_context, m, pull):
    """Return ``m`` with its field ``pull`` replaced, possibly by another type."""
    place = m.fields.index("pull")
    result = types.NamedTuple([*m.types[:place], pull, *m.types[place + 1 :]], m.instance_class)

    def generate(context, builder, signature, arguments):
        values = [builder.extract_value(arguments[0], j) for j in range(len(m))]
        values[place] = arguments[1]
        return context.make_tuple(builder, result, values)

    return result(m, pull), generate


def _replaced(builder, y, value, numbers):
    for name, number in numbers.items():
        value = builder.insert_value(value, number, y.fields.index(name))
    return value


@intrinsic
def _with_rates(typing_context, y, v_rate, omega):
    """Return the state ``y`` with its fields ``v_rate`` and ``omega`` replaced."""

    def generate(context, builder, signature, arguments):
        state, *numbers = arguments
        return _replaced(builder, y, state, dict(zip(("v_rate", "omega"), numbers, strict=True)))

    return y(y, types.float64, types.float64), generate


@intrinsic
def _with_z(typing_context, y, left, right):
    """Return the state ``y`` with its fields ``z_left`` and ``z_right`` replaced."""

    def generate(context, builder, signature, arguments):
        state, *numbers = arguments
        return _replaced(builder, y, state, dict(zip(("z_left", "z_right"), numbers, strict=True)))

    return y(y, types.float64, types.float64), generate


@intrinsic
def _along(typing_context, y, k, h):
    """Return ``y + h k`` of two named tuples of one kind."""

    def generate(context, builder, signature, arguments):
        start, rates, length = arguments
        end = start
        for j in range(len(y)):
            way = builder.fmul(length, builder.extract_value(rates, j))
            end = builder.insert_value(end, builder.fadd(builder.extract_value(start, j), way), j)
        return end

    return y(y, k, types.float64), generate


@intrinsic
def _weighted(typing_context, k1, k2, k3, k4):
    """Return ``k1 + 2 (k2 + k3) + k4`` of four named tuples of one kind."""

    def generate(context, builder, signature, arguments):
        two = ir.Constant(_DOUBLE, 2.0)
        total = arguments[0]
        for j in range(len(k1)):
            first, second, third, fourth = (builder.extract_value(k, j) for k in arguments)
            inner = builder.fmul(two, builder.fadd(second, third))
            total = builder.insert_value(total, builder.fadd(builder.fadd(first, inner), fourth), j)
        return total

    return k1(k1, k2, k3, k4), generate


@intrinsic
def _selected(typing_context, first, a, b):
    """Return the named tuple ``a`` if ``first`` is True, else ``b``, of one kind, without a branch."""

    def generate(context, builder, signature, arguments):
        is_first, *both = arguments
        pairs = [[builder.extract_value(each, j) for each in both] for j in range(len(a))]
        return context.make_tuple(builder, a, [builder.select(is_first, *pair) for pair in pairs])

    return a(types.boolean, a, b), generate


_COMPILES = not numba.config.DISABLE_JIT  # type: ignore[attr-defined]
get = _get if _COMPILES else _interpreted_get
taken = _taken if _COMPILES else _interpreted_taken
with_pull = _with_pull if _COMPILES else _interpreted_with_pull
with_rates = _with_rates if _COMPILES else _interpreted_with_rates
with_z = _with_z if _COMPILES else _interpreted_with_z
selected = _selected if _COMPILES else _interpreted_selected
put = _put if _COMPILES else _interpreted_put
along = _along if _COMPILES else _interpreted_along
weighted = _weighted if _COMPILES else _interpreted_weighted
