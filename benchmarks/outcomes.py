"""Are outcomes right? A pool of random hard cases, each held against an independent reference.

    python benchmarks/outcomes.py [--cases N] [--seed 0] [--jobs 2] [--only STRATUM] [--within 400] [--cache FOLDER] [--csv FILE]
    python benchmarks/outcomes.py --case weak-17          one case in full: what it is, the truth, rockbatch's answer

Runs every case as `rockbatch run` would at a tolerance of 10⁻⁴ and compares with what `independent` says of it: a pair
of order 8 with events located, restarted at every sample and event, followed up to 400 s after the motion. A reference
that does not agree with itself to 10⁻⁶ α, by a tolerance a hundred times looser on a motion 10⁻¹² stronger, is none (chaos);
one whose greatest rotation still grows in the second half of that time is undecided. Both are counted, and left out of the
verdicts:

  wrong outcome    ok although it overturns; overturned although it stands, or at another time; a flight where there is
                   none, at another time, or missed, or one that ends a run that flight does not end. Where flight ends
                   the run and the pier would fall after it, both count.
  error            |θ_max − truth| beyond the tolerance
  beyond estimate  |θ_max − truth until the end of the run| beyond the error that the row reports
  failed, settled  a failed row whose best value is the truth, of a pier that nothing topples later either
  later, noted     the truth comes after the end of the run, whose note says that it still had the energy for it

On the rigid base as on springs, θ_max is that of the whole run, through flights and landings, where flight is guided.

A run on a base where flight ends it that is ok all the same says that it flew when nothing could exceed the peak any more. It
is held against the whole truth, through the flight and after it: the pier must stand, with this peak.

"later" marks what goes wrong after the end of the run: it stopped too early.

Bouc–Wen springs ratchet on vibration that nothing damps, so that some piers topple after minutes of it. On them the truth
is taken until 40/p after the motion, as long as rockbatch waits (THEORY.md, When a run is over); those that
topple later are counted ("ratchets over").
--within 60 asks for the truth until 60 s after the motion on all bases.

References are kept in FOLDER (outcomes.json; a new version of the pool or the solver starts anew); by default a folder
in the temporary directory.
"""

import argparse
import csv
import hashlib
import json
import math
import tempfile
import threading
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from independent.pool import STRATA, Case, cases, just_overturning, scaled
from independent.reference import HORIZON, Reference, reference, twice

from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Base, RigidBase, YieldingBase, problems
from rockbatch.simulation import run_to_tolerance
from rockbatch.simulation.steps import PATIENCE

TOLERANCE = 1e-4
RATCHETS = "ratchets over"
BLUR = 1e-10  # of α: what a reference may be off by itself
AGREES = 1e-6  # of α, between the two references
GROWS = 1e-5  # of α: an undecided peak has grown by more in the second half of the time
SAME_FLIGHT = 0.01  # over p [s]: two flights within it are one
SAME_FALL = 0.5  # over p [s]
WRONG = ("ok, overturns", "overturned, stands", "overturned at another time", "flight, none", "flight at another time",
         "flight missed", "flight, guided", "refused, stable")  # fmt: skip
FLIGHT = ("t_flight", "theta_flight", "peak_flight", "t_peak_flight")
LEFT_OUT = ("no reference", "undecided")
RIGHT = ("", "failed, rightly", "refused", "later, noted", RATCHETS)


@dataclass(frozen=True)
class Row:
    """One case: its verdict, "" if all is well, and the numbers behind it (angles over α)."""

    id: str
    stratum: str
    base: str
    verdict: str
    status: str
    truth: str
    theta_max: float
    true_theta_max: float
    error: float
    reported: float
    t_max: float
    true_t_max: float
    t_end: float
    true_t_end: float
    t_flight: float
    true_t_flight: float
    later: bool
    error_until: float
    substeps: int
    reason: str
    note: str


class Cache:
    """References on disk: what is known of a case, of this motion, under the present pool and solver."""

    def __init__(self, folder: Path, seed: int) -> None:
        sources = sorted((Path(__file__).parent / "independent").glob("*.py"))
        version = hashlib.sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()[:16]
        folder.mkdir(parents=True, exist_ok=True)
        self.path = folder / f"outcomes-{version}-{seed}.json"
        self.known: dict[str, dict] = json.loads(self.path.read_text()) if self.path.exists() else {}
        self.lock = threading.Lock()

    def get(self, case: Case) -> tuple[Case, Reference, Reference]:
        """The case as it is run (scaled to its share of overturning), its reference and the looser one."""
        name = f"{case.id} {case.motion.name} {case.motion.npts} {case.motion.pga:.6g}"  # records at hand differ
        known = self.known.get(name)
        if known is None:
            factor = 1.0 if case.hair is None else case.hair * just_overturning(case)
            run = scaled(case, factor)
            fine, loose = twice(run.pier, run.base, run.motion)
            known = {"factor": factor, "fine": asdict(fine), "loose": asdict(loose)}
            with self.lock:
                self.known[name] = known
        return scaled(case, known["factor"]), Reference(**known["fine"]), Reference(**known["loose"])

    def save(self) -> None:
        self.path.write_text(json.dumps(self.known))


def label(base: Base) -> str:
    """A base in short."""
    numbers = [f"{name} {value:.4g}" for name, value in vars(base).items() if isinstance(value, int | float)]
    words = [value for value in vars(base).values() if isinstance(value, str)]
    return " ".join([base.name, *numbers, *words])


def near(a: float, b: float, within: float) -> bool:
    return (math.isnan(a) and math.isnan(b)) or abs(a - b) <= within


def stands_on_itself(case: Case, fine: Reference, loose: Reference) -> str:
    """Whether the reference can judge: "", "no reference" or "undecided"."""
    alpha, p = case.pier.alpha, case.pier.p
    if "exhausted" in (fine.status, loose.status) or not near(fine.t_flight, loose.t_flight, 1e-4 / p):
        return "no reference"
    if case.flight_stops and not math.isnan(fine.t_flight):
        return "" if near(fine.peak_flight, loose.peak_flight, AGREES * alpha) else "no reference"
    if fine.status != loose.status:
        return "no reference"
    if fine.status == "overturned":
        return "" if near(fine.t_end, loose.t_end, 0.01 / p) else "no reference"
    if not near(fine.theta_max, loose.theta_max, AGREES * alpha):
        return "no reference"
    grows = not fine.decided and fine.theta_max - fine.halfway > GROWS * alpha
    return "undecided" if grows else ""


def residuals_agree(case: Case, fine: Reference, loose: Reference) -> bool:
    """Whether both references leave the base with the same tilt, to the tolerance; rigid bases have none."""
    if isinstance(case.base, RigidBase):
        return True
    half_width = case.pier.half_width
    tilts = [0.5 * (one.up_left - one.up_right) / half_width for one in (fine, loose)]
    return abs(tilts[1] - tilts[0]) <= TOLERANCE * case.pier.alpha


def flown(case: Case, found: Outcome, fine: Reference) -> bool:
    """Whether the truth has flown by the end of the run; a flight as good as at its end only if the run flew too."""
    same = SAME_FLIGHT / case.pier.p
    return fine.t_flight <= found.t_end + (-same if found.status == "ok" and found.t_flight is None else same)


def truth_of(case: Case, fine: Reference, found: Outcome) -> tuple[str, float, float]:
    """Status, θ_max and its time that a run until the end of ``found`` ought to have come to."""
    goes_on = found.status == "ok" and found.t_flight is not None  # and claims that the flight changes nothing
    if fine.status == "flew" or (case.flight_stops and flown(case, found, fine) and not goes_on):
        return "flight", fine.peak_flight, fine.t_peak_flight
    return ("overturned" if fine.status == "overturned" else "ok"), fine.theta_max, fine.t_max


def verdict(case: Case, found: Outcome, fine: Reference) -> tuple[str, float]:
    """What is wrong about a row, and its error [rad] (nan where θ_max has no say)."""
    p, tolerance = case.pier.p, TOLERANCE * case.pier.alpha
    truth, peak, _ = truth_of(case, fine, found)
    error = abs(found.theta_max - peak)
    t_flight = math.nan if found.t_flight is None else found.t_flight
    if found.status == "failed":
        return ("failed, settled" if truth != "overturned" and error <= tolerance else "failed, rightly"), math.nan
    if found.status == "overturned":
        if fine.status != "overturned":
            return "overturned, stands", math.nan
        at = (fine.t_end, fine.t_flight)
        return ("" if any(near(found.t_end, t, SAME_FALL / p) for t in at) else "overturned at another time"), math.nan
    if found.status == "flight" and not case.flight_stops:
        return "flight, guided", math.nan
    if found.status == "flight":
        if math.isnan(fine.t_flight):
            return "flight, none", math.nan
        if not near(t_flight, fine.t_flight, SAME_FLIGHT / p):
            return "flight at another time", math.nan
    elif truth == "overturned":
        return "ok, overturns", math.nan
    elif truth == "flight":
        return "flight missed", math.nan
    elif not near(t_flight, fine.t_flight if flown(case, found, fine) else math.nan, SAME_FLIGHT / p):
        return "flight at another time", math.nan
    return ("error" if error > tolerance else ""), error


def until(case: Case, end: float) -> Reference:
    """The reference followed to ``end`` [s], whatever is decided before."""
    horizon = end - case.motion.duration - case.motion.dt
    return reference(case.pier, case.base, case.motion, horizon=horizon, patient=True)


def error_until_end(case: Case, found: Outcome, peak: float, t_peak: float) -> float:
    """|θ_max − truth until the end of the run| [rad]: what the row's own error can know of."""
    if found.status == "flight" or t_peak <= found.t_end:
        return abs(found.theta_max - peak)
    return abs(found.theta_max - until(case, found.t_end).theta_max)


def horizon_of(case: Case) -> float:
    """How long after the motion [s] the truth is asked for."""
    ratchets = isinstance(case.base, YieldingBase) and case.base.spring == "bouc-wen"
    return PATIENCE / case.pier.p if ratchets else HORIZON


def judge(case: Case, cache: Cache, within: float | None = None) -> Row:
    """Runs one case and holds it against its reference, as far as ``within`` [s] after the motion."""
    case, fine, loose = cache.get(case)
    alpha, at_last = case.pier.alpha, fine.status
    within = horizon_of(case) if within is None else within
    refused = problems(case.pier, case.base)
    if refused:
        stands = fine.status == "stands"
        return Row(case.id, case.stratum, label(case.base), "refused, stable" if stands else "refused", "refused",
                   fine.status, *[math.nan] * 10, False, math.nan, 0, refused[0], "")  # fmt: skip
    found = run_to_tolerance(case.pier, case.base, case.motion, TOLERANCE, case.quiet_s)
    limit = max(found.t_end, case.motion.duration + case.motion.dt + within)
    if (
        found.status != "overturned"
        and within < HORIZON
        and max(fine.t_end if fine.status == "overturned" else 0.0, fine.t_max) > limit
    ):
        fine = loose = until(case, limit)
    if found.t_flight is not None and found.t_flight > fine.t_end:  # after the moment at which the peak was decided
        if found.status == "ok":  # no matter of the outcome, and undamped vibration forgets nothing
            fine = replace(fine, t_flight=found.t_flight)
        else:
            flights = until(case, found.t_end)
            fine = replace(fine, **{name: getattr(flights, name) for name in FLIGHT})
    said, error = verdict(case, found, fine)
    truth, peak, t_peak = truth_of(case, fine, found)
    error_until = math.nan if math.isnan(error) else error_until_end(case, found, peak, t_peak)
    if said == "" and error_until > (found.theta_max_error or 0.0) + BLUR * alpha:
        said = "beyond estimate"
    if said == "error" and t_peak > found.t_end and getattr(found, "note", ""):
        said = "later, noted"
    if said == "" and found.status == "ok" and at_last == "overturned":
        said = RATCHETS
    if said == "failed, settled" and (at_last == "overturned" or not residuals_agree(case, fine, loose)):
        said = "failed, rightly"  # as it says: what it leans on will topple it, or the residual rotation is chance
    said = stands_on_itself(case, fine, loose) or said
    return Row(
        case.id, case.stratum, label(case.base), said, found.status, truth, found.theta_max / alpha, peak / alpha, error / alpha,
        math.nan if found.theta_max_error is None else found.theta_max_error / alpha, found.t_max, t_peak, found.t_end,
        fine.t_end, math.nan if found.t_flight is None else found.t_flight, fine.t_flight,
        said in ("error", "ok, overturns") and t_peak > found.t_end, error_until / alpha, found.substeps, found.reason,
        getattr(found, "note", ""),
    )  # fmt: skip


def judged(pool: Iterable[Case], cache: Cache, jobs: int, within: float | None = None) -> list[Row]:
    """Rows of the pool, in its order; references are kept."""
    with ThreadPoolExecutor(jobs) as workers:
        rows = list(workers.map(lambda case: judge(case, cache, within), pool))
    cache.save()
    return rows


COLUMNS = ("cases", "ok", "overturned", "flight", "failed", "no reference", "undecided", "wrong", "error", "of these later",
           "beyond estimate", "worst ratio", "failed, settled", "failed, rightly", "later, noted",
           RATCHETS)  # fmt: skip


def counts(rows: list[Row]) -> dict[str, float]:
    """The columns of the table, of some rows."""
    of = {said: sum(row.verdict == said for row in rows) for said in {row.verdict for row in rows}}
    by = {status: sum(row.status == status for row in rows) for status in ("ok", "overturned", "flight", "failed")}
    told = [row for row in rows if row.verdict not in LEFT_OUT and row.reported > 0 and not math.isnan(row.error_until)]
    numbers: dict[str, float] = {name: of.get(name, 0) for name in COLUMNS}
    return (
        numbers
        | by
        | {
            "cases": len(rows),
            "wrong": sum(of.get(said, 0) for said in WRONG),
            "of these later": sum(row.later for row in rows),
            "beyond estimate": sum(row.error_until > row.reported + BLUR for row in told),
            "worst ratio": max([row.error_until / row.reported for row in told], default=0.0),
        }
    )


def table(rows: list[Row]) -> list[str]:
    """Lines of the table per stratum, and of everything that is wrong."""
    lines = ["| stratum | " + " | ".join(COLUMNS) + " |", "|" + " --- |" * (len(COLUMNS) + 1)]
    for name in [*STRATA, "all"]:
        some = [row for row in rows if name in (row.stratum, "all")]
        if some:
            lines.append(f"| {name} | " + " | ".join(f"{counts(some)[column]:.4g}" for column in COLUMNS) + " |")
    return lines


def complaints(rows: list[Row]) -> list[str]:
    """One line for each row that is wrong."""
    return [
        f"{row.id} ({row.base}): {row.verdict}{' (later)' if row.later else ''}: "
        f"{row.status} {row.theta_max:.6g} ± {row.reported:.1e} at {row.t_max:.4f} s, end {row.t_end:.4f} s, "
        f"flight {row.t_flight:.4f} s; truth {row.truth} {row.true_theta_max:.6g} at {row.true_t_max:.4f} s, "
        f"end {row.true_t_end:.4f} s, flight {row.true_t_flight:.4f} s; k = {row.substeps} {row.reason}"
        for row in rows
        if row.verdict not in (*LEFT_OUT, *RIGHT)
    ]


def in_full(case: Case, cache: Cache) -> list[str]:
    """One case: what it is, both references, rockbatch's answer, and the verdict."""
    run, fine, loose = cache.get(case)
    motion = run.motion
    lines = [
        f"{run.id} ({run.stratum})", str(run.pier), str(run.base), f"quiet_s = {run.quiet_s}",
        f"{motion.name}: dt = {motion.dt!r}, npts = {motion.npts}, duration {motion.duration:.4f} s, PGA {motion.pga:.6g} m/s², "
        f"vertical {motion.pga_vertical}",
        f"reference:       {fine}", f"looser, 1+1e-12: {loose}",
        f"now:             {reference(run.pier, run.base, run.motion)}",
    ]  # fmt: skip
    if not problems(run.pier, run.base):
        lines.append(f"rockbatch:       {run_to_tolerance(run.pier, run.base, run.motion, TOLERANCE, run.quiet_s)}")
    return [*lines, str(judge(case, cache))]


def write(path: Path, rows: list[Row]) -> None:
    """All rows as CSV, in the order of the pool."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, list(asdict(rows[0])), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow(
                {key: f"{value:.9g}" if isinstance(value, float) else value for key, value in asdict(row).items()}
            )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, help="size of the pool (all that there are)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="strata whose name holds this")
    parser.add_argument("--within", type=float, help="truth until so long after the motion [s]")
    parser.add_argument("--case", help="one case in full, by its id")
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "rockbatch-outcomes")
    parser.add_argument("--csv", type=Path, help="write every row to this file")
    arguments = parser.parse_args()
    cache = Cache(arguments.cache, arguments.seed)
    if arguments.case:
        chosen = [case for case in cases(None, arguments.seed) if case.id == arguments.case]
        print("\n".join(in_full(chosen[0], cache)) if chosen else f"no case {arguments.case}")
        return
    rows = judged(cases(arguments.cases, arguments.seed, arguments.only), cache, arguments.jobs, arguments.within)
    if arguments.csv:
        write(arguments.csv, rows)
    print("\n".join([*complaints(rows), "", *table(rows)]))


if __name__ == "__main__":
    main()
