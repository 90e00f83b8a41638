"""Powers by products where the exponent is a whole number, which loops over lanes can take for several at once."""

from rockbatch.core.kernel import inlined

LARGEST_WHOLE = 10
"""Exponents up to here that are whole numbers need no pow."""


@inlined
def power(x, n):
    """Return xⁿ for x ≥ 0, by the type of n: None is the paper's 5, a whole number up to 10 is a product of squares.

    Neither costs a call to pow, which would keep a loop over lanes from being turned into vector instructions.
    """
    if n is None:
        square = x * x
        return square * square * x
    if isinstance(n, int):
        square = x * x
        fourth = square * square
        low = (x if n & 1 else 1.0) * (square if n & 2 else 1.0)
        return low * ((fourth if n & 4 else 1.0) * (fourth * fourth if n & 8 else 1.0))
    return x**n
