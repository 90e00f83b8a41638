"""Uncertain supports, impacts and slenderness in a study file, and their draws: [fragility.uncertain].

Inputs are drawn once for every record and level by Latin hypercube sampling, so that their scatter is in the curve. A draw
depends on the seed, the numbers of record and level, and the input alone: resumed and shared searches find the same.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from typing import Any
from zlib import crc32

import numpy as np
from scipy.special import ndtr, ndtri
from scipy.stats.qmc import LatinHypercube

from rockbatch.analyses.fragility.bounds import Values
from rockbatch.common.analyses import Entry
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case, Study
from rockbatch.study.inputs import impossible, outside, ranges, values_of, varied, why_no_case
from rockbatch.study.restraint_inputs import IN_KILONEWTONS
from rockbatch.toml.kinds import Number, choice, count
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import Key, Section

NAMES = ("alpha", "restitution", "epsilon", "zeta", "beta", "stiffness_kN_m", "eta", "yield_kN")
"""Inputs that can be drawn."""

MOST_IMPOSSIBLE = 0.03
"""Share of a distribution that may lie where no pier can be; draws there are made again."""

TRIALS = 500
"""Draws by which that share is estimated."""


@dataclass(frozen=True)
class Input:
    """An input that is drawn.

    ``spread`` is "lognormal", about the value of the case as median and with ``size`` the standard deviation of the logarithm, or
    "uniform" with the ends as ``size``.
    """

    name: str
    spread: str
    size: Any

    @property
    def at(self) -> tuple[str, str]:
        """Return its table and key under [fragility.uncertain], as ("lognormal", "zeta")."""
        return self.spread, self.name

    @property
    def words(self) -> str:
        """Return "alpha lognormal 0.1", "restitution uniform 0.85 to 0.95"."""
        size = f"{self.size:g}" if self.spread == "lognormal" else " to ".join(f"{end:g}" for end in self.size)
        return f"{self.name} {self.spread} {size}"

    def value(self, score: float, own: float) -> float:
        """Return the value at a normal ``score``: lognormal about ``own``, that of the case, or uniform between the ends."""
        if self.spread == "lognormal":
            return own * math.exp(self.size * score)
        low, high = self.size
        return float(low + (high - low) * ndtr(score))


@dataclass(frozen=True)
class Correlation:
    """[[fragility.uncertain.correlation]]: correlation of the normal scores of two inputs."""

    between: tuple[str, str]
    value: float

    @property
    def words(self) -> str:
        """Return "stiffness_kN_m and yield_kN 0.7"."""
        return f"{' and '.join(self.between)} {self.value:g}"


@dataclass(frozen=True)
class Uncertain:
    """[fragility.uncertain]: the inputs that are drawn; none by default."""

    inputs: tuple[Input, ...] = ()
    correlations: tuple[Correlation, ...] = ()
    seed: int = 1

    @property
    def names(self) -> tuple[str, ...]:
        """Return the names of the inputs."""
        return tuple(parameter.name for parameter in self.inputs)

    @property
    def words(self) -> str:
        """Return the drawn inputs in words: "alpha lognormal 0.1, eta uniform 2 to 3; correlated: … (seed 1)"; or ""."""
        inputs = ", ".join(parameter.words for parameter in self.inputs)
        together = "; correlated: " + ", ".join(each.words for each in self.correlations)
        return f"{inputs}{together if self.correlations else ''} (seed {self.seed})" if self.inputs else ""

    @property
    def columns(self) -> tuple[str, ...]:
        """Return the columns of their values in the table of runs: "drawn_alpha"."""
        return tuple(f"drawn_{name}" for name in self.names)

    @property
    def matrix(self) -> Values:
        """Return the correlations of the normal scores, shape (inputs, inputs)."""
        matrix = np.eye(len(self.inputs))
        for correlation in self.correlations:
            i, j = (self.names.index(name) for name in correlation.between)
            matrix[i, j] = matrix[j, i] = correlation.value
        return matrix

    @cached_property
    def root(self) -> Values:
        """Return the lower triangle L of L Lᵀ = :attr:`matrix`, also of a singular one (correlations of ±1)."""
        variances, axes = np.linalg.eigh(self.matrix)
        _, upper = np.linalg.qr((axes * np.sqrt(np.maximum(variances, 0.0))).T)
        return np.asarray(upper.T * np.where(np.diag(upper) < 0, -1.0, 1.0))

    def scores(self, records: int, level: int) -> Values:
        """Return normal scores of all records at a level, shape (records, inputs): Latin hypercube samples, correlated."""
        independent = np.empty((records, len(self.inputs)))
        for column, name in zip(independent.T, self.names, strict=True):  # a column that depends on no other input
            generator = np.random.default_rng((self.seed, level, crc32(name.encode())))
            column[:] = LatinHypercube(1, seed=generator).random(records)[:, 0]
        return np.asarray(ndtri(independent) @ self.root.T)


_SPREADS = {
    "lognormal": Section(
        ("fragility", "uncertain", "lognormal"),
        "Lognormal inputs: standard deviation of the logarithm, about the value of each case as median.",
        {
            name: Key(Number("a number above 0 and at most 2", low=0.0, high=2.0, above=True), "0.1", key.words)
            for name, key in ranges().items()
            if name in NAMES
        },
    ),
    "uniform": Section(
        ("fragility", "uncertain", "uniform"),
        "Uniform inputs: the smallest and the largest value.",
        {name: key for name, key in ranges().items() if name in NAMES},
    ),
}
UNCERTAIN = Section(
    ("fragility", "uncertain"),
    (
        'Inputs that are not known: each is drawn once for every record and level (with "ida" once for every record), so that '
        "its scatter is in the curve. Leave it out of [[fragility.dispersion]]."
    ),
    {
        "seed": Key(count, "1", "Seed of the draws."),
    },
    homes=(Uncertain,),
)
CORRELATION = Section(
    ("fragility", "uncertain", "correlation"),
    (
        "Correlation of two inputs: that of their logarithms if both are lognormal. Write one for each pair; others are "
        "independent."
    ),
    {
        "between": Key(choice(*NAMES), '["stiffness_kN_m", "yield_kN"]', "The two inputs.", many=True, required=True),
        "value": Key(Number("a number from -1 to 1", low=-1.0, high=1.0), "0.7", "Their correlation.", required=True),
    },
    many=True,
)

SECTIONS = (UNCERTAIN, *_SPREADS.values(), CORRELATION)
"""Its tables in a study file."""


def read_uncertain(file: TomlFile, study: Study) -> Uncertain:
    """Return the inputs that a study draws, none without the table; mistakes become problems of ``file``."""
    table = file.table("fragility", "uncertain")
    if table is None:
        return Uncertain()
    before = len(file.problems)
    read = table.read(UNCERTAIN, other=(*_SPREADS, "correlation"))
    inputs = []
    for spread, keys in _SPREADS.items():
        if inner := file.table("fragility", "uncertain", spread):
            inputs += [Input(name, spread, size) for name, size in inner.read(keys).items()]
    inputs.sort(key=lambda parameter: NAMES.index(parameter.name))
    if not inputs and file.is_sound_since(before):
        table.complain("nothing is drawn; write [fragility.uncertain.lognormal] and under it alpha = 0.1")
    for one, other in combinations(inputs, 2):
        if one.name == other.name:
            table.complain(f"{one.name} is given under {one.spread} and {other.spread}; keep one", *other.at)
        elif IN_KILONEWTONS.get(other.name) == one.name:
            table.complain(f"{one.name} and {other.name} are given, which fix the same; keep one", *other.at)
    uncertain = Uncertain(tuple(inputs), _correlations(file, inputs), **read)
    if file.is_sound_since(before):
        _check_inputs(table, uncertain, study)
    return uncertain


def _correlations(file: TomlFile, inputs: Sequence[Input]) -> tuple[Correlation, ...]:
    names = [parameter.name for parameter in inputs]
    correlations: list[Correlation] = []
    for table in file.tables("fragility", "uncertain", "correlation", title="between"):
        read = table.read(CORRELATION)
        if not read.keys() >= {"between", "value"}:
            continue
        between = tuple(sorted(read["between"], key=NAMES.index))
        if len(between) != 2:
            table.complain(f"between: expected two inputs; write between = {CORRELATION['between'].example}", "between")
        elif absent := [name for name in between if name not in names]:
            table.complain(f"between: {absent[0]} is not drawn; give its scatter, or leave this out", "between")
        elif any(correlation.between == between for correlation in correlations):
            table.complain("this pair is given twice; keep one", "between")
        else:
            correlations.append(Correlation(between, read["value"]))
            together = Uncertain(tuple(inputs), tuple(correlations)).matrix
            if np.linalg.eigvalsh(together)[0] < -1e-12:
                table.complain(f"value = {read['value']:g}: impossible beside the correlations above it", "value")
    return tuple(correlations)


def _check_inputs(table: Table, uncertain: Uncertain, study: Study) -> None:
    """Complain about inputs that no case has, unfit distributions, and cases of which over 3 % of the draws are impossible."""
    used: set[str] = set()
    for case in study.cases:
        own = _own_values(case)
        inputs = [parameter for parameter in uncertain.inputs if parameter.name in own]
        used |= {parameter.name for parameter in inputs}
        wrong = {
            parameter: message for parameter in inputs if (message := _unfit(parameter, own[parameter.name], case))
        }
        for parameter, message in wrong.items():
            table.complain(message, *parameter.at)
        if not wrong:
            _check_draws(table, uncertain, case)
    for parameter in uncertain.inputs:
        if parameter.name not in used:
            table.complain(f"{parameter.name}: {why_no_case(parameter.name, study)}; leave it out", *parameter.at)


def _unfit(parameter: Input, own: float, case: Case) -> str:
    """Return why a distribution does not fit a case: it is lognormal and the value ``own`` 0, or uniform and ``own`` outside it.

    Empty if it fits.
    """
    if parameter.spread == "uniform":
        return outside(parameter.name, parameter.size, [(case.name, own)])
    zero = f'{parameter.name} = 0 in case "{case.name}", about which nothing is lognormal; write it under uniform'
    return "" if own else zero


def _check_draws(table: Table, uncertain: Uncertain, case: Case) -> None:
    """Complain if more than MOST_IMPOSSIBLE, 3 %, of TRIALS, 500, draws are impossible in a case, with an example of the input
    that is wrong in most of them.
    """
    own = _own_values(case)
    trials = (values_at(uncertain, own, scores) for scores in uncertain.scores(TRIALS, 0))
    wrong = [problems[0] for values in trials if (problems := impossible(case, values))]
    if len(wrong) <= MOST_IMPOSSIBLE * TRIALS:
        return
    names = [name for _, name in wrong]
    name = max(dict.fromkeys(names), key=names.count)
    example = next(problem for problem, about in wrong if about == name)
    place = next((parameter.at for parameter in uncertain.inputs if parameter.name == name), ())
    table.complain(
        f'case "{case.name}" cannot be with {100 * len(wrong) / TRIALS:.0f} % of what is drawn, where '
        f"{100 * MOST_IMPOSSIBLE:g} % are allowed and drawn again: {example}; write a narrower distribution",
        *place,
    )


def _own_values(case: Case) -> dict[str, Any]:
    """Return the values of a case, by input, about which inputs are drawn; a restitution that is not given is Housner's."""
    own = values_of(case)
    return own | ({"restitution": case.pier.restitution} if own.get("restitution", 0.0) is None else {})


def values_at(uncertain: Uncertain, own: Entry, scores: Values) -> dict[str, float]:
    """Return uncertain inputs at standard normal ``scores``, shape (inputs,): about the case's ``own`` values, or uniform.

    Inputs not in ``own`` are left out.
    """
    values = {}
    for parameter, score in zip(uncertain.inputs, scores, strict=True):
        if parameter.name in own:
            values[parameter.name] = parameter.value(float(score), own[parameter.name])
    return values


@dataclass(frozen=True, eq=False)
class Drawn:
    """A case with drawn inputs, as run.json has it, too, and their normal scores by name."""

    case: Case
    described: dict[str, object]
    scores: dict[str, float]


class Draws:
    """Cases with drawn inputs, each made once for a record and level; the cases themselves if nothing is drawn."""

    def __init__(self, uncertain: Uncertain, cases: Sequence[Case], records: int) -> None:
        self.uncertain, self.cases, self.records = uncertain, cases, records
        self._own = [_own_values(case) for case in cases]
        self._scores: dict[int, Values] = {}
        self._made: dict[tuple[int, int, int], Drawn] = {}

    def at(self, case: int, record: int, level: int) -> Drawn:
        """Return the case ``case`` as it is drawn for a record and a level, all by their numbers; as it is if nothing is."""
        key = (case, 0, 0) if self._own[case].keys().isdisjoint(self.uncertain.names) else (case, record, level)
        if key not in self._made:
            self._made[key] = self._draw(*key)
        return self._made[key]

    def _draw(self, number: int, record: int, level: int) -> Drawn:
        """Return a case with its drawn inputs, drawn again, from a random sequence of its own, while it is impossible."""
        case, own, uncertain = self.cases[number], self._own[number], self.uncertain
        if own.keys().isdisjoint(uncertain.names):
            return Drawn(case, describe_case(case), {})
        if level not in self._scores:
            self._scores[level] = uncertain.scores(self.records, level)
        scores = self._scores[level][record]
        again = np.random.default_rng((uncertain.seed, level, record, number))
        while impossible(case, values := values_at(uncertain, own, scores)):
            scores = uncertain.root @ again.standard_normal(len(uncertain.inputs))
        changed = {name: value for name, value in values.items() if value != own[name]}  # to the bit without scatter
        columns = case.columns | {f"drawn_{name}": value for name, value in values.items()}
        drawn = replace(varied(case, changed), columns=columns)
        by_name = dict(zip(uncertain.names, scores.tolist(), strict=True))
        return Drawn(drawn, describe_case(drawn), {name: by_name[name] for name in values})
