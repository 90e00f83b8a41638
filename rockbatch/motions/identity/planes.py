"""Rows of samples in one plane, as are components of one motion in three directions."""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from rockbatch.motions.motion import Samples

Indices = npt.NDArray[np.int64]

_CLOSE = 0.499  # correlation of lines 60° apart, but for rounding
_ROUNDING = 1e-12  # of coordinates of unit vectors
_BLOCK = 256  # rows that are compared with all others at once
_NEAR_AXIS = 0.05  # of the greatest distance from a row: nearer rows have no certain azimuth about it


def in_one_plane(samples: Samples, apart: float) -> Iterator[tuple[int, int, int]]:
    """Yield three rows of unit ``samples``, shape (n, m), m ≥ 3, of which one is within ``apart`` of the plane of two others.

    Two of three lines in a plane are 60° apart at most, and so their samples have a correlation of a half or more. What lies in a
    plane lies in its projections, and is no farther from them: two projections to three coordinates rule nearly all rows out.
    """
    rng = np.random.default_rng(0)
    some, others = (samples @ np.linalg.qr(rng.normal(size=(samples.shape[1], 3)))[0] for _ in range(2))
    for a, close in _close_lines(samples):
        g = samples[close] @ samples[a]
        lines = np.abs(g) < 1.0 - apart
        b, g = close[lines], g[lines]
        off_plane = apart / np.sqrt(1.0 - g**2)
        pair, c = _near_planes(some, a, b, off_plane)
        normal = np.cross(others[a], others[b])
        within = off_plane * np.linalg.norm(normal, axis=1) + _ROUNDING
        near = np.abs(np.einsum("ij,ij->i", normal[pair], others[c])) <= within[pair]
        near &= (c != a) & (c != b[pair])
        pair, c = pair[near], c[near]
        to_a, to_b = samples[c] @ samples[a], np.einsum("ij,ij->i", samples[c], samples[b[pair]])
        in_plane = (to_a**2 + to_b**2 - 2.0 * g[pair] * to_a * to_b) / (1.0 - g[pair] ** 2)
        held = in_plane > 1.0 - off_plane[pair] ** 2
        yield from ((a, second, third) for second, third in zip(b[pair[held]].tolist(), c[held].tolist(), strict=True))


def _close_lines(samples: Samples) -> Iterator[tuple[int, Indices]]:
    """Yield each row a of unit ``samples`` with the rows b > a whose correlation with it is about a half or more, of either sign.

    A block of rows a at a time, so that memory does not grow with the square of their number.
    """
    rounded = samples.astype(np.float32)
    for first in range(0, len(rounded), _BLOCK):
        cosines = np.abs(rounded[first : first + _BLOCK] @ rounded[first:].T)
        for i, row in enumerate(cosines):
            close = np.flatnonzero(row[i + 1 :] >= _CLOSE)
            if close.size:
                yield first + i, close + first + i + 1


def _near_planes(points: Samples, a: int, b: Indices, off_plane: Samples) -> tuple[Indices, Indices]:
    """Return places in ``b``, and rows of ``points``, shape (n, 3), that are near the plane through the origin, a and that b.

    Rows of one plane through a have one azimuth about it: those of all planes are found in one sorted list. The rows nearest to
    that axis count as near every plane.
    """
    axis = points[a] / np.linalg.norm(points[a])
    zero = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    x, y = points @ (zero / np.linalg.norm(zero)), points @ np.cross(axis, zero / np.linalg.norm(zero))
    radius, azimuth = np.hypot(x, y), np.arctan2(y, x) % np.pi
    least = _NEAR_AXIS * radius.max()
    sines = (off_plane + _ROUNDING / (np.linalg.norm(points[a]) * radius[b])) / least
    half = np.arcsin(np.minimum(sines, 1.0))
    far, near = np.flatnonzero(radius >= least), np.flatnonzero(radius < least)
    order = far[np.argsort(azimuth[far])]
    turned = np.concatenate([azimuth[order] + turn for turn in (-np.pi, 0.0, np.pi)])
    low, high = turned.searchsorted(azimuth[b] - half), turned.searchsorted(azimuth[b] + half, "right")
    counts, places = high - low, np.arange(len(b))
    in_window = np.arange(counts.sum()) + np.repeat(low - (np.cumsum(counts) - counts), counts)
    pair = np.concatenate([np.repeat(places, counts), np.repeat(places, len(near))])
    return pair, np.concatenate([order[in_window % len(order)], np.tile(near, len(b))])
