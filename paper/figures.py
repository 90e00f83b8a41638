"""Make the figure and the table of the paper: `python paper/figures.py` (two minutes; `--table` for the table alone).

The figure is measured: `rockbatch accuracy` on Fig. 7's tower, and the general solvers of benchmarks/solvers.py. The table is
made of what the benchmarks have left (benchmarks/*.csv) and of the documentation's tables of others' results.
"""

import argparse
import csv
import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
TOP = HERE.parent
PAPER = HERE / "paper.md"
TABLE = re.compile(r"(?<=<!-- verification -->\n).*?(?=<!-- end -->)", re.DOTALL)


def read(name: str) -> list[dict[str, str]]:
    """Return the rows of a table of the benchmarks."""
    with (TOP / "benchmarks" / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def rows_of(page: str, first: str, cells: int) -> list[list[str]]:
    """Return the cells of the rows of a page that begin so."""
    lines = (TOP / "docs" / "pages" / page).read_text(encoding="utf-8").splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if re.match(rf"\| {first}", line)]
    return [row for row in rows if len(row) == cells]


def verification() -> str:
    """Return the table of what was compared, with what, and what came out."""
    pairs = [(float(row["theta_max_true"]), float(row["theta_max_reported"])) for row in read("error_estimates.csv")]
    known = [(true, told) for true, told in pairs if true == true and told == told]
    within = sum(true <= told for true, told in known)
    verdicts = [row["verdict"] for row in read("outcomes.csv")]
    excluded = sum(verdict in ("undecided", "no reference") for verdict in verdicts)
    wrong = sum(verdict in ("wrong outcome", "error") for verdict in verdicts)
    programs = [row for row in rows_of("held_against_others.md", "", 5) if re.fullmatch(r"0\.\d{4}", row[1])]
    apart = max(abs(float(row[2]) / float(row[1]) - 1.0) for row in programs)
    greatest, least = (rows_of("verification.md", name, 5)[0] for name in ("Loma Prieta", "Cape Mendocino"))
    shares: dict[str, list[str]] = {}
    for row in rows_of("measured.md", "[12] ", 7):
        shares.setdefault(row[1], []).append(f"{100 * float(row[4].split()[0]):.1f}")
    block, regression, pga = (
        " and ".join(shares[name]) for name in ("block, α", "logistic regression", "threshold on PGA")
    )
    lines = [
        ("closed forms: free and harmonic rocking, lift-off and landing on two springs", "2·10⁻⁵ or closer"),
        (
            "converged runs, 208 recorded motions on five bases",
            f"the reported error covers the true one in {within} of {len(known)}",
        ),
        (
            f"independent solver, {len(verdicts):,} random hard cases",
            f"{wrong} wrong outcomes; {excluded} excluded, for which that solver has no clear result",
        ),
        (f"OpenSees, {len(programs)} piers on elastic and yielding springs", f"peaks within {100 * apart:.1f} %"),
        (
            "published rigid tower, greatest and least peak θ/α",
            f"{greatest[1]} where {greatest[4]} is printed, {least[3]} where {least[4]} is",
        ),
        (
            "461 shake-table tests of two granite blocks, overturned or not, on records not used to fit α",
            f"right in {block} %; regression on PGA and PGV {regression} %; threshold on PGA {pga} %",
        ),
    ]
    return "\n".join(
        ["| compared with | result |", "| :--- | :--- |", *(f"| {what} | {result} |" for what, result in lines), ""]
    )


def draw() -> None:
    """Measure and draw error against time per run."""
    sys.path.insert(0, str(TOP / "benchmarks"))
    import solvers

    import rockbatch as rb

    (axes,) = rb.accuracy(TOP / "configs" / "fig7.toml", scipy=False).plot(width_mm=150.0).axes
    for line in solvers.main(repeats=2)[2:]:
        name, _, took, error, *_ = (cell.strip() for cell in line.strip("|").split("|"))
        if name.startswith("SciPy"):
            time = float(took.split()[0])
            axes.plot(time, float(error), "^", color="0.3", markersize=5)
            above = 6 if float(error) > 5e-5 else -12
            axes.annotate(name, (time, float(error)), (0, above), textcoords="offset points", ha="center", fontsize=7)
    axes.set_xlim(right=2000.0)
    axes.set_xticks([0.1, 1, 10, 100, 1000], ["0.1", "1", "10", "100", "1,000"])
    axes.figure.savefig(HERE / "error_and_time.png", dpi=250, bbox_inches="tight")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--table", action="store_true", help="the table alone, without a measurement")
    if not parser.parse_args().table:
        draw()
    text = PAPER.read_text(encoding="utf-8")
    PAPER.write_text(TABLE.sub(lambda _: verification(), text), encoding="utf-8")
