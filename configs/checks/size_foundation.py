"""Size a foundation: the least strength η, and the least stiffness β with it, for which a pier passes its checks.

    python configs/checks/size_foundation.py

runs the suite of size_foundation.toml on a grid of foundations and holds each against stepping_pier.toml. A grid, and no
bisection: stronger ground settles less but throws the pier higher, so that what passes is a window. The weakest
stiff foundations (eta = 1.5) ratchet on after the record, so that nothing can be said for them. It takes a few seconds:

    eta        1.50 2.00 2.25  2.50  2.75  3.00  3.50  4.00
    beta
    15.0         ij    j    j     j     j     j     j     j
    20.0        gij    j    j     j     j     j     j     j
    25.0        gij    j    j     j     j     j     j     j
    30.0        gij   gj    j     j     j     j     j     j
    40.0  abcdefghi    g    g  pass  pass  pass     e     e
    60.0  abcdefghi    g    g     g  pass  pass  pass     e
    80.0  abcdefghi    g    g     g     g  pass  pass  pass
        a: every run settled
        b: no overturning
        c: flight within the keys
        d: overturning margin
        e: uplift of the heel
        f: residual tilt
        g: settlement of the toe
        h: spring ductility
        i: bearing
        j: static deflection
    least: eta = 2.5, beta = 40
"""

from pathlib import Path

import pandas as pd

import rockbatch as rb

HERE = Path(__file__).parent


def sized(study: Path, rules: Path) -> tuple[pd.DataFrame, dict[str, str]]:
    """Letters of the checks that do not pass, for every β (rows) and η (columns), and the check of each letter."""
    loaded = rb.load_study(study)
    verdicts = rb.check(rb.run(loaded), rules, study=loaded)
    letters = dict(zip(verdicts["check"].unique(), "abcdefghijklmnopqrstuvwxyz", strict=False))
    verdicts["letter"] = verdicts["check"].map(letters).where(verdicts["verdict"] != "pass", "")
    return verdicts.pivot_table("letter", "beta", "eta", aggfunc="".join), {one: name for name, one in letters.items()}


def main() -> None:
    grid, checks = sized(HERE / "size_foundation.toml", HERE / "stepping_pier.toml")
    print(grid.replace("", "pass").to_string())
    for letter in sorted(set("".join(grid.to_numpy().ravel()))):
        print(f"    {letter}: {checks[letter]}")
    passing = [(eta, beta) for (beta, eta), letters in grid.stack().items() if not letters]
    print("least: eta = {:g}, beta = {:g}".format(*min(passing)) if passing else "no foundation of the grid passes")


if __name__ == "__main__":
    main()
