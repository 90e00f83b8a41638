"""Random studies under random checks, judged again from their histories by other code.

Values are those of the samples in histories.h5: rotations on cubic polynomials between them, forces by Newton's second law with
differences of velocities. Errors of runs are those of peaks.csv. Everything else is written here again: lengths of piers, the
worst of a station, statistics, what is unknown, and the verdict. Where a limit lies within what samples miss, it is not compared.
"""

import csv
import math
from collections import defaultdict
from dataclasses import dataclass
from itertools import pairwise

import h5py
import numpy as np
import pytest
from scipy import stats

import rockbatch as rb
from rockbatch.motions.labels.origin import Origin

INF, NAN = math.inf, math.nan
LEAST = {"p84": 6, "p84_95": 18, "asce7-16": 11, "en1998-1": 3, "aashto": 3, "nzs1170.5": 3}
CODES = {"asce7-16", "en1998-1", "aashto", "nzs1170.5"}
STATISTICS = ("max", "mean", "median", "count", *LEAST)
EVENTS = ("overturned", "failed", "flight")
LANDED = {"base_shear_kN", "normal_force_kN", "pivot_force_kN", "deck_acceleration_g"}
"""Forces that a landing enters."""
RAISED_LATER = LANDED | {"omega_max_over_p", "damper_force_kN", "damper_stroke_m"}
"""Demands that landings after the end of a run may raise."""
DIRECTED = {
    "theta_max_over_alpha",
    "top_drift_m",
    "heel_uplift_mm",
    "omega_max_over_p",
    "base_shear_kN",
    "deck_acceleration_g",
}
"""Demands that add up over both axes of a pier."""
COMBINED = {"greater": max, "srss": math.hypot, "100_30": lambda x, y: max(x + 0.3 * y, 0.3 * x + y)}


@dataclass
class Body:
    """Half width, height of the centre, heights of top and deck [m], inertia over the mass [m²], mass [t]."""

    b: float
    h: float
    top: float
    deck: float
    i0: float
    mass: float

    @classmethod
    def of(cls, pier, width=None):
        """The pier of a table, on another width if given."""
        wide = pier["width_m"]
        shaft = [(q["mass_t"], q["height_m"], q["length_m"], q["width_m"]) for q in pier.get("part", ())]
        shaft = shaft or [(pier["mass_t"], 0.5 * pier["height_m"], pier["height_m"], wide)]
        pieces = [(m, z, m * (length**2 + w**2) / 12.0, z + 0.5 * length) for m, z, length, w in shaft]
        deck = max(top for *_, top in pieces)
        if "deck_mass_t" in pier:
            deck = pier["deck_height_m"]
            pieces.append((pier["deck_mass_t"], deck, 0.0, deck))
        mass = sum(m for m, *_ in pieces)
        h = sum(m * z for m, z, *_ in pieces) / mass
        i0 = sum(i + m * (z - h) ** 2 for m, z, i, _ in pieces) / mass
        return cls(0.5 * (width or wide), h, pier.get("top_m", max(top for *_, top in pieces)), deck, i0, mass)

    @property
    def alpha(self):
        return math.atan2(self.b, self.h)

    @property
    def p(self):
        return math.sqrt(9.81 * math.hypot(self.b, self.h) / (self.i0 + self.b**2 + self.h**2))


# Random studies


def random_pier(rng):
    wide = float(rng.uniform(3.0, 7.0))
    high, mass = wide * float(rng.uniform(4.0, 7.0)), float(rng.uniform(500.0, 2500.0))
    pier = {"width_m": wide, "height_m": high, "mass_t": mass}
    kind = rng.choice(["rectangle", "deck", "parts"])
    if kind == "parts":
        low = {"mass_t": mass, "height_m": 0.4 * high, "length_m": 0.8 * high, "width_m": 0.6 * wide}
        cap = {"mass_t": 0.3 * mass, "height_m": 0.85 * high, "length_m": 0.1 * high, "width_m": wide}
        pier = {"width_m": wide, "part": [low, cap]}
    if kind != "rectangle":
        pier |= {
            "deck_mass_t": mass * float(rng.uniform(0.2, 1.5)),
            "deck_height_m": high + float(rng.uniform(0.0, 2.0)),
        }
    return pier | ({"top_m": 0.8 * high} if rng.random() < 0.2 else {})


def random_case(rng, pier, base):
    body = Body.of(pier)
    topples = math.sqrt(9.81 * body.h) / (body.b * body.p)  # of springs below this β
    springs = {"beta": topples * float(rng.uniform(4.0, 8.0))}
    loss = {"epsilon": float(rng.choice([0.05, 0.3]))}, {"zeta": float(rng.uniform(0.02, 0.2))}
    case = {
        "rigid": {"base": "rigid"},
        "impulse": {"base": "elastic"} | springs | loss[0],
        "dashpot": {"base": "elastic"} | springs | loss[1],
        "pads": {"base": "yielding", "eta": float(rng.uniform(1.8, 4.0)), "spring": "epp"} | springs | loss[1],
        "foot": {"base": "footing", "length_m": 2.0 * body.b, "stiffness_MN_m3": 50.0, "safety_factor": 3.0},
    }[base]
    damper = {"kind": "viscous", "nu": 0.2}, {"kind": "hysteretic", "f": 0.04, "yield_mm": 5.0}
    tied = base in ("rigid", "dashpot") and rng.random() < 0.5
    return {"name": base} | case | ({"damper": [damper[int(rng.integers(2))]]} if tied else {})


def random_motions(rng, across):
    """One to two components of each of some stations, of a few earthquakes, most with a vertical component."""
    t, motions = np.arange(0.0, 5.0, 0.01), []

    def wave(amplitude, low, high):
        parts = [np.sin(2.0 * np.pi * f * t + rng.uniform(0.0, 6.3)) for f in rng.uniform(low, high, 3)]
        sum_of = np.minimum(1.0, 2.0 * t) * np.exp(-np.maximum(0.0, t - 2.5)) * sum(parts)
        return amplitude * 9.81 * sum_of / np.abs(sum_of).max()

    for station in range(int(rng.integers(2, 9))):
        origin = Origin(f"event {rng.integers(3)}", f"st{station}")
        for component in range(1 if across else int(rng.integers(1, 3))):
            other = {"across": wave(rng.uniform(0.25, 0.7), 0.4, 2.0), "azimuth": 0.0} if across else {}
            vertical = wave(rng.uniform(0.1, 0.4), 2.0, 8.0) if rng.random() < 0.6 else None
            name, along = f"s{station}c{component}", wave(rng.uniform(0.25, 0.7), 0.4, 2.0)
            motions.append(rb.Motion(name, 0.01, along, vertical, station=f"st{station}", origin=origin, **other))
    return motions


def random_study(rng, base):
    """A study of one case, on both axes of its pier, at two scales, under a bound, or by both polarities."""
    pier, extra, motions = random_pier(rng), {}, {}
    kind = str(rng.choice(["plain", "scales", "axes", "bound", "polarities"]))
    case = random_case(rng, pier, base)
    if kind == "axes" and base != "foot":
        case["other_width_m"] = pier["width_m"] * float(rng.uniform(0.8, 1.3))
    elif kind == "bound" and "deck_mass_t" in pier:
        extra = {"bound": [{"name": "high", "pier.deck_height_m": pier["deck_height_m"] + 1.5}]}
    elif kind == "scales":
        motions["scale"] = [1.0, 0.5]
    elif kind == "polarities":
        motions["polarity"] = ["+", "-"]
    tables = {"pier": pier, "case": [case], "motions": motions, "output": {"histories": "all", "forces": True}} | extra
    found = random_motions(rng, "other_width_m" in case)
    quiet = float(rng.choice([2.0, 20.0]))  # after the shorter one most piers still rock
    return tables | {"numerics": {"quiet_s": quiet}}, found


# Values of a run from its history


def rates(t, values):
    """d/dt of what jumps where a time is repeated; NaN in pieces of fewer than three rows."""
    of_rows = np.full(len(t), NAN)
    ends = [0, *(np.flatnonzero(np.diff(t) <= 1e-9) + 1), len(t)]
    for first, last in pairwise(ends):
        if last - first >= 3:
            of_rows[first:last] = np.gradient(values[first:last], t[first:last], edge_order=2)
    return of_rows


def greatest_rotation(t, theta, omega):
    """The greatest |θ| on the cubic polynomials between the rows."""
    step, s = np.diff(t), np.linspace(0.0, 1.0, 17)[:, None]
    ends = (2 * s**3 - 3 * s**2 + 1) * theta[:-1] + (3 * s**2 - 2 * s**3) * theta[1:]
    return np.abs(ends + step * ((s**3 - 2 * s**2 + s) * omega[:-1] + (s**3 - s**2) * omega[1:])).max()


def accelerations(run, body, rigid):
    """Absolute acceleration of the centre along and up, of the deck along, and θ̈, from the motion of the body alone."""
    t, theta, omega, ag = (run[name] for name in ("t", "theta", "omega", "ag_h"))
    turning = rates(t, omega)
    if not rigid:  # linearised kinematics
        return ag + body.h * turning, None, ag + body.deck * turning
    size, phi = math.hypot(body.b, body.h), body.alpha - np.abs(theta)
    side = np.where(
        (np.abs(theta) < 1e-12) & (omega != 0.0), NAN, np.sign(theta)
    )  # it lands or lifts off: about neither corner
    along = ag + size * (np.cos(phi) * turning + side * np.sin(phi) * omega**2)
    up = 9.81 + np.nan_to_num(run["ag_v"]) + size * (side * np.sin(phi) * turning - np.cos(phi) * omega**2)
    rise = body.deck - body.h
    return along, up, along + rise * (np.cos(theta) * turning - np.sin(theta) * omega**2)


def measured(run, body, case):
    """Value of each demand, and the share by which samples may miss it; left out are those not known here."""
    rigid, weight = case["base"] == "rigid", 9.81 * body.mass
    theta = greatest_rotation(run["t"], run["theta"], run["omega"])
    found = {
        "theta_max_over_alpha": (theta / body.alpha, 2e-3),
        "top_drift_m": (body.top * theta, 2e-3),
        "heel_uplift_mm": (2e3 * body.b * theta, 2e-3),
        "omega_max_over_p": (np.abs(run["omega"]).max() / body.p, 0.02),
    }
    pulls = {name: values for name, values in run.items() if name.startswith("damper") and name.endswith("force")}
    if pulls:
        found["damper_force_kN"] = (max(np.abs(pull).max() for pull in pulls.values()) * body.mass, 0.03)
        ways = [values for name, values in run.items() if name.startswith("damper") and name.endswith("elongation")]
        found["damper_stroke_m"] = (max(np.abs(way).max() for way in ways), 0.02)
    if case["base"] == "footing":
        return found
    along, up, deck = accelerations(run, body, rigid)
    pressed = up + sum(pulls.values()) if rigid else -(run["force_left"] + run["force_right"])
    found["normal_force_kN"] = (np.nanmax(pressed) * body.mass, 0.04)
    found["deck_acceleration_g"] = (np.nanmax(np.abs(deck)) / 9.81, 0.06)
    if not (rigid and pulls):
        found["base_shear_kN"] = (np.nanmax(np.abs(along)) * body.mass, 0.06)
    if not rigid:
        found["pivot_force_kN"] = (max((-run[f"force_{side}"]).max() for side in ("left", "right")) * body.mass, 0.02)
    if case["base"] == "yielding":
        yields = 0.5 * case["eta"] * weight / (0.5 * body.mass * (case["beta"] * body.p) ** 2)
        found["ductility"] = (max((-run[f"v_{side}"]).max() for side in ("left", "right")) / yields, 0.02)
    return found


def error_of(row, demand, value, body):
    """The error of a demand by the columns of errors of its row; NaN without one."""
    lengths = {
        "theta_max_over_alpha": 1.0,
        "top_drift_m": body.top * body.alpha,
        "heel_uplift_mm": 2e3 * body.b * body.alpha,
    }
    if demand in lengths:
        return lengths[demand] * number(row["theta_max_error"])
    share = {"ductility": "", "damper_force_kN": "devices_error", "damper_stroke_m": "devices_error"}.get(
        demand, "forces_error"
    )
    return value * number(row.get(share))


def number(cell):
    return float(cell) if cell else NAN


# Judgement


def statistic(name, values, above=0.0):
    ordered = np.sort(np.asarray(values, float))
    n, finite = len(ordered), np.isfinite(ordered)
    if name in ("median", "p84"):
        rank = {"median": 0.5, "p84": 0.84}[name] * (n - 1)
        low, share = int(rank + 1e-12), rank - int(rank + 1e-12)
        return ordered[low] if share < 1e-9 else INF if not finite[low + 1] else np.interp(rank, range(n), ordered)
    if name == "p84_95":
        return next((x for k, x in enumerate(ordered, 1) if stats.binom.cdf(k - 1, n, 0.84) >= 0.95), ordered[-1])
    if name == "asce7-16" and not finite.all():
        alone = finite.sum() == n - 1 > 0
        return max(1.2 * statistic("median", ordered), ordered[finite].mean()) if alone else INF
    by_mean = name in ("mean", "asce7-16") or (name in ("en1998-1", "aashto") and n >= 7)
    return float((ordered > above).sum()) if name == "count" else ordered.mean() if by_mean else ordered[-1]


def bounds_of(rule, row, value, error, landings_missing):
    """(low, value, high) of the demand in one run; None for one that is left out."""
    status, may = row["status"], row["may_overturn"] == "1"
    if rule.demand in EVENTS:
        open_ = (rule.demand == "overturned" and may) or (rule.demand != "failed" and status in ("failed", "flight"))
        return value, value, 1.0 if open_ else value
    usual = {"overturned": "infinite", "flight": "unknown", "failed": "unknown"}
    ways = dict.fromkeys(usual, "infinite") if rule.statistic == "asce7-16" else usual
    way = getattr(rule, status, None) or ways.get(status) if status != "ok" else None
    if way == "left out":
        return None
    if way == "infinite":
        return INF, INF, INF
    wild = row["chaotic"] == "1" and row["theta_max_error"] == "" and math.isnan(error)
    margin = 0.0 if math.isnan(error) else error
    low, high = (0.5 * value, 2.0 * value) if wild else (max(value - margin, 0.0), value + margin)
    if way == "unknown" or landings_missing:
        low = 0.0 if status == "failed" else low
        return low, low, INF
    return low, value, INF if may and (rule.overturned or ways["overturned"]) == "infinite" else high


def reached(row, demand, body):
    """A lower bound of a rotation until its motion ended, of a run that failed later; 0 for other demands."""
    lengths = {
        "theta_max_over_alpha": 1.0,
        "top_drift_m": body.top * body.alpha,
        "heel_uplift_mm": 2e3 * body.b * body.alpha,
    }
    low = number(row["theta_max_in_motion_over_alpha"]) - number(row["theta_max_in_motion_error"])
    return 0.0 if math.isnan(low) else max(low, 0.0) * lengths.get(demand, 0.0)


def unmet(rule, named, events):
    """Whether fewer records count than are asked for, stations of one event are too many, or "count" allows them all."""
    n, stations = len(named), {station for stations in named.values() for station in stations}
    least = max(LEAST.get(rule.statistic, 1), rule.least or 0)
    together = defaultdict(set)
    for station in stations:
        together[events[station]].add(station)
    crowded = rule.per_event is not None and max(map(len, together.values())) > rule.per_event
    return (
        n < least
        or len(stations) < LEAST.get(rule.statistic, 1)
        or crowded
        or (rule.statistic == "count" and rule.limit >= n)
    )


def random_rule(rng, number_of, values):
    """A check of a random demand, whose limit is about the size of its ``values``."""
    demand = str(rng.choice([*values, *EVENTS]))
    kinds = ("max", "count", "mean") if demand in EVENTS else STATISTICS
    kind, asked = str(rng.choice(kinds)), {}
    size = 1.0 if demand in EVENTS else max(values[demand])
    most = size * float(rng.choice([0.2, 0.5, 0.9, 1.1, 2.0]))
    if kind == "count":
        asked["above"], most = (None, 1.0) if demand in EVENTS else (0.5 * size, float(rng.integers(0, 4)))
    elif demand in EVENTS:
        most = {"max": 0.0, "mean": 0.3}[kind]
    if kind not in CODES and rng.random() < 0.2:
        asked["count"] = "component"
    if kind in CODES and rng.random() < 0.3:
        asked["per_event"] = int(rng.integers(1, 5))
    if rng.random() < 0.2:
        asked["least"] = LEAST.get(kind, 1) + int(rng.integers(0, 6))
    if demand in DIRECTED:
        asked["both_axes"] = str(rng.choice(list(COMBINED)))
    if demand not in EVENTS and kind != "asce7-16" and rng.random() < 0.2:
        asked[str(rng.choice(["overturned", "flight", "failed"]))] = str(
            rng.choice(["infinite", "unknown", "left out"])
        )
    return rb.Rule(f"rule {number_of}", demand, most, statistic=kind, confirm=("at_most", "above"), **asked)


class Judge:
    """All runs of a study in a folder, by the suite to which they belong."""

    def __init__(self, folder, study, motions):
        self.study, self.events = study, {motion.station: motion.origin.event for motion in motions}
        self.case, self.suites = study["case"][0], defaultdict(lambda: defaultdict(dict))
        with (folder / "peaks.csv").open(newline="") as file, h5py.File(folder / "histories.h5") as histories:
            kept = {key_of(group): group for group in histories["runs"].values()}
            for row in csv.DictReader(file):
                if row.get("mirror_of"):
                    continue
                key = (row["record"], row["case"], row["polarity"], float(row["scale"]), row.get("bound", ""))
                run = {name: item[()] for name, item in kept[key].items() if isinstance(item, h5py.Dataset)}
                run |= {name: item[()] for name, item in kept[key].get("restraints", {}).items()}
                body, axis = self.body(row), row["case"] != self.case["name"]
                self.suites[row.get("bound", ""), float(row["scale"])][row["record"]][axis] = (
                    row,
                    body,
                    measured(run, body, self.case),
                )

    def body(self, row):
        pier = dict(self.study["pier"])
        for bound in self.study.get("bound", ()):
            pier |= {key[5:]: value for key, value in bound.items() if row["bound"] == bound["name"] and key != "name"}
        return Body.of(pier, self.case["other_width_m"] if row["case"] != self.case["name"] else None)

    def values(self):
        """Finite values of every demand in all runs."""
        of_demands = defaultdict(list)
        for records in self.suites.values():
            for axes in records.values():
                for _, _, found in axes.values():
                    for name, (value, _) in found.items():
                        of_demands[name].append(value)
        return of_demands

    def demanded(self, rule, axes):
        """(low, value, high) of a record on one or both axes, None if it is left out, and the share that samples may miss."""
        bounds, missed = [], 0.0
        stopped = self.case["base"] == "rigid" or "epsilon" in self.case
        for row, body, found in axes.values():
            happened = {
                "overturned": row["status"] == "overturned",
                "failed": row["status"] == "failed",
                "flight": row["flight_s"] != "",
            }
            value, share = (float(happened[rule.demand]), 0.0) if rule.demand in EVENTS else found[rule.demand]
            missing = rule.demand in LANDED and stopped and row["impacts"] != "0"
            missing |= rule.demand in RAISED_LATER and row["still_rocks"] == "1"
            of_run = bounds_of(rule, row, value, error_of(row, rule.demand, value, body), missing)
            if of_run and row["status"] == "failed" and of_run[2] == INF > of_run[0] and rule.demand not in EVENTS:
                low = reached(row, rule.demand, body)
                of_run = low, low, INF
            bounds.append(of_run)
            missed = max(missed, share)
        if None in bounds:
            return None, missed
        combine = COMBINED[rule.both_axes or "greater"]
        together = bounds[0] if len(bounds) == 1 else tuple(combine(*ends) for ends in zip(*bounds, strict=True))
        return together, missed

    def expected(self, rule, suite, allowed):
        """(records, (low, value, high), verdict or None where samples cannot tell) of a rule on a suite."""
        records, named, missed, close = {}, defaultdict(set), 0.0, False
        for record, axes in self.suites[suite].items():
            row = next(iter(axes.values()))[0]
            bounds, share = self.demanded(rule, axes)
            missed = max(missed, share)
            if bounds is None:
                continue
            close |= rule.statistic == "count" and any(
                abs(x - (rule.above or 0.0)) <= 2.0 * share * x for x in bounds if x < INF
            )
            name = record if rule.count == "component" else row["station"]
            records[name] = tuple(map(max, records.get(name, (0.0, 0.0, 0.0)), bounds))
            named[name].add(row["station"])
        if not records:
            return 0, None, "not decided"
        ends = [statistic(rule.statistic, of_end, rule.above or 0.0) for of_end in zip(*records.values(), strict=True)]
        lows, _, highs = zip(*records.values(), strict=True)
        if rule.statistic == "asce7-16" and np.isinf(highs).sum() > np.isinf(lows).sum():
            ends[2] = INF
        close |= rule.statistic != "count" and any(abs(x - rule.limit) <= 2.0 * missed * x for x in ends if x < INF)
        met = not unmet(rule, named, self.events) and allowed
        verdict = "fail" if ends[0] > rule.limit else "pass" if met and ends[2] <= rule.limit else "not decided"
        return len(records), (ends, missed), None if close else verdict

    def allowed(self, rules, suite):
        """Whether every ending of a run is in some check."""
        checked = {rule.demand for rule in rules}
        checked |= set(EVENTS) if any(rule.statistic == "asce7-16" for rule in rules) else set()
        rows = [row for axes in self.suites[suite].values() for row, _, _ in axes.values()]
        ends = {row["status"] for row in rows} - {"ok"} | {"overturned" for row in rows if row["may_overturn"] == "1"}
        return ends <= checked


def key_of(group):
    bound = group["varied"].attrs.get("bound", "") if "varied" in group else ""
    return (*(group.attrs[name] for name in ("record", "case", "polarity")), float(group.attrs["scale"]), bound)


@pytest.mark.thorough
@pytest.mark.parametrize("base", ["rigid", "impulse", "dashpot", "pads", "foot"])
@pytest.mark.parametrize("seed", range(4))
def test_a_judge_by_other_code_finds_the_same_verdicts(tmp_path, base, seed):
    rng = np.random.default_rng([seed, len(base), ord(base[0])])
    study, motions = random_study(rng, base)
    rb.run(rb.Study.from_dict(study, motions=motions), out=tmp_path / "out")
    judge = Judge(tmp_path / "out", study, motions)
    rules = [random_rule(rng, number_of, judge.values()) for number_of in range(40)]
    table = rb.check(tmp_path / "out", rules)
    told = defaultdict(int)
    for found in table.fillna({"bound": ""} if "bound" in table else {}).to_dict("records"):
        suite = (found.get("bound", ""), found["scale"])
        rule = next(rule for rule in rules if rule.name == found["check"])
        records, values, verdict = judge.expected(rule, suite, judge.allowed(rules, suite))
        assert found["records"] == records, rule
        if verdict is not None:
            assert found["verdict"] == verdict, (rule, values, found["note"])
            told[verdict] += 1
        if values and (rule.statistic != "count" or verdict is not None):
            (low, value, high), missed = values
            ends = (found["low"], found["high"], value if math.isnan(found["value"]) else found["value"])
            assert ends == pytest.approx((low, high, value), rel=1.5 * missed + 1e-6, abs=1e-9), rule
        if rule.demand == "top_drift_m":
            assert found["at_m"] == pytest.approx(next(iter(judge.suites[suite].values()))[False][1].top)
    assert sum(told.values()) > 20
