"""Powers with whole exponents as products, which the compiler can vectorise."""

from rockbatch.core.kernel import inlined

LARGEST_WHOLE = 10
"""Greatest whole exponent that is computed by products."""


@inlined
def power(x, n):
    """Return xⁿ for x ≥ 0; ``n`` None stands for 5, an int is at most LARGEST_WHOLE = 10.

    These are products of squares; a float ``n`` calls pow, which keeps a loop over lanes from being vectorised.
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
