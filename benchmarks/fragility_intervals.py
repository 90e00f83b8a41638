"""Coverage of the intervals of fragility curves on made-up suites of known truth, two components a station; and the bias of β.

``python benchmarks/fragility_intervals.py [SUITES] [--seed N]`` prints a table; 400 suites a row take a quarter of an hour.

Capacities, or demands, are lognormal, with the correlation ρ between the components of a station. Each row counts how often the
95 % intervals of the median θ, the dispersion β and the annual rate λ hold the truth. Curves that could not be fitted are left
out, and counted.
"""

import argparse
import math
from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from rockbatch.analyses.fragility.cloud import Cloud
from rockbatch.analyses.fragility.lognormal import Lognormal
from rockbatch.analyses.fragility.statistics import capacities, cloud, stripes
from rockbatch.common.errors import InputError
from rockbatch.motions.suites.hazard import HazardCurve

Values = npt.NDArray[np.float64]
THETA, BETA = 1.0, 0.4
HAZARD = HazardCurve([0.25], [1 / 475], slope=2.0)
X, RATES = (values[::9] for values in HAZARD.quadrature())
RATES = 9.0 * RATES  # every ninth point is enough for a count
RATE = float(RATES @ np.vectorize(lambda x: 0.5 * math.erfc(-math.log(x / THETA) / BETA / math.sqrt(2.0)))(X))


def correlated(rng: np.random.Generator, stations: int, components: int, rho: float) -> Values:
    """Return standard normal numbers, shape (stations · components,), those of a station with the correlation ``rho``."""
    shared = np.repeat(rng.standard_normal(stations), components)
    return math.sqrt(rho) * shared + math.sqrt(1.0 - rho) * rng.standard_normal(stations * components)


def by_ida(rng: np.random.Generator, scatter: Values, station: Sequence[int]) -> Lognormal:
    """Fit brackets of one percent; capacities above 1.6 θ, an eighth of them, are censored."""
    x = THETA * np.exp(BETA * scatter)
    beyond = x > 1.6 * THETA
    low, high = np.where(beyond, 1.6 * THETA, 0.995 * x), np.where(beyond, np.inf, 1.005 * x)
    return capacities(low, high, stations=station)


def by_stripes(rng: np.random.Generator, scatter: Values, station: Sequence[int]) -> Lognormal:
    """Fit seven stripes over two dispersions either way, with the same records at all of them."""
    levels = THETA * np.exp(BETA * np.linspace(-2.0, 2.0, 7))
    return stripes(levels, THETA * np.exp(BETA * scatter)[:, None] <= levels, stations=station)


def by_cloud(rng: np.random.Generator, scatter: Values, station: Sequence[int]) -> Cloud:
    """Fit a line to demands, which exceed 1 as the capacities are exceeded."""
    x = _intensities(rng, station)
    return cloud(x, (x / THETA) ** 1.2 * np.exp(-1.2 * BETA * scatter), 1.0, stations=station)


def by_overturning(rng: np.random.Generator, scatter: Values, station: Sequence[int]) -> Cloud:
    """Fit the share that overturns, which is logistic: β and λ are those of a lognormal one only nearly."""
    from rockbatch.analyses.fragility.bounds import NoCurve
    from rockbatch.analyses.fragility.cloud import fit_event

    x = _intensities(rng, station)
    curve = fit_event(x, x > THETA * np.exp(BETA * scatter), station=np.array(station))
    if isinstance(curve, NoCurve):
        raise InputError(curve.reason)
    return curve


def _intensities(rng: np.random.Generator, station: Sequence[int]) -> Values:
    """Return those of stations, with a scatter of 0.15 between the components of each."""
    of_station = 0.6 * rng.standard_normal(max(station) + 1)
    return THETA * np.exp(of_station[list(station)] + 0.15 * rng.standard_normal(len(station)))


METHODS: dict[str, Callable[..., Lognormal | Cloud]] = {
    "ida": by_ida,
    "stripes": by_stripes,
    "cloud": by_cloud,
    "cloud, overturning": by_overturning,
}


def row(name: str, stations: int, components: int, rho: float, suites: int, seed: int) -> str:
    """Return a line of the table: coverage in per cent, and mean β by the sample and by the maximum likelihood."""
    rng = np.random.default_rng((seed, stations, components, round(100 * rho), list(METHODS).index(name)))
    station = np.repeat(np.arange(stations), components).tolist()
    held, fitted = np.zeros(3), 0
    betas, likely = list[float](), list[float]()
    for _ in range(suites):
        try:
            curve = METHODS[name](rng, correlated(rng, stations, components, rho), station)
        except InputError:
            continue
        intervals = curve.median_interval, curve.dispersion_interval, curve.rate(X, RATES)[1:]
        fitted += 1
        held += [
            interval is not None and interval[0] <= truth <= interval[1]
            for interval, truth in zip(intervals, (THETA, BETA, RATE), strict=True)
        ]
        betas.append(curve.dispersion)
        likely.append(curve.most_likely_dispersion if isinstance(curve, Lognormal) else math.nan)
    share = " | ".join(f"{100 * each / fitted:.0f}" for each in held) if stations >= 5 else " | | "
    root = math.nan if "cloud" in name else math.sqrt(np.mean(np.square(betas)))  # a line that hardly rises has any β
    spread = f"{np.mean(likely):.3f} | {np.median(betas):.3f} | {root:.3f}".replace("nan", "")
    return f"| {name} | {stations} × {components} | {rho:g} | {fitted} | {share} | {spread} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=str(__doc__).split("\n\n")[0])
    parser.add_argument("suites", type=int, nargs="?", default=400)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    print("| method | stations | ρ | curves | θ held [%] | β held [%] | λ held [%] | mean β_ML | median β | rms β |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    for stations, components, rho in (
        (7, 2, 0.0),
        (7, 2, 0.3),
        (7, 2, 0.6),
        (7, 2, 0.8),
        (15, 2, 0.6),
        (5, 1, 0.0),
        (7, 1, 0.0),
    ):
        for name in METHODS if components > 1 else ("ida", "stripes"):
            print(row(name, stations, components, rho, arguments.suites, arguments.seed), flush=True)


if __name__ == "__main__":
    main()
