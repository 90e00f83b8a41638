"""``rockbatch spectrum``: rocking spectra and overturning maps of a study, as tables and in the report."""

import argparse
import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from rockbatch.commands.analyses import end, journal_of
from rockbatch.commands.messages import count, make_ready, once, say, tell_motions
from rockbatch.commands.options import add_engine, add_study, engine, folder, study_of

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd

    from rockbatch.analysis.folder import AnalysisFolder
    from rockbatch.batch.threads import Engine
    from rockbatch.study.spectrum import MapSpec, SpectrumSpec

HELP = "rocking spectra over the size of the pier, and maps of the pulses that overturn it"
MOST_LINES = 12
"""Of a table for the terminal."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_study(parser)
    add_engine(parser)


def main(arguments: argparse.Namespace) -> int:
    from rockbatch.analysis.folder import AnalysisFolder
    from rockbatch.study.spectrum import read_spectrum

    started = time.monotonic()
    study = study_of(arguments)
    spectrum, maps = read_spectrum(study)
    results = AnalysisFolder(folder(arguments), "spectrum", study, arguments.fresh)
    failed = 0
    with engine(arguments) as carrier:
        if spectrum is not None:
            failed = _spectrum(results, spectrum, carrier)
        if maps:
            _maps(results, maps, carrier)
        end(results, engine=str(carrier), wall_s=round(time.monotonic() - started, 3))
    return 1 if failed else 0


def _spectrum(results: "AnalysisFolder", spectrum: "SpectrumSpec", carrier: "Engine") -> int:
    """Write the rocking spectra, and print them; returns the number of files and runs that failed."""
    from rockbatch.analysis import rocking_spectrum as analysis
    from rockbatch.batch.carrying_out import carry_out
    from rockbatch.batch.digests import digests
    from rockbatch.commands.progress import Progress
    from rockbatch.files import read_table
    from rockbatch.study.suite import ground_motions

    study, path = results.study, results.directory / analysis.FILE
    motions = ground_motions(study)
    tell_motions(motions)
    runs = analysis.plan(study, spectrum, motions)
    digest = digests(
        motions.motions,
        cases=spectrum.cases,
        scales=(study.motions.polarity, study.motions.scale),
        numerics=study.numerics,
    )
    say(f"spectra: {count(len(motions.motions), 'motion')}, {count(len(runs), 'run')}{once(study)} on {carrier}")
    results.info |= {"axis": spectrum.axis, "varied": list(spectrum.varied), "motions": len(motions.motions)}
    if results.has(analysis.FILE, digest):
        results.keep(analysis.FILE, digest)
    else:
        make_ready(replace(study, cases=spectrum.cases))
        with journal_of(results, analysis.FILE, analysis.columns(spectrum), digest) as journal:
            with Progress(len(runs) - len(journal)) as progress:
                carry_out(runs, study.numerics, journal, carrier, row=analysis.row_of, progress=progress)
            journal.write_in_order(path)
            results.keep(analysis.FILE, digest)
    table = read_table(path)
    suite = analysis.of_suite(table, spectrum.varied)
    results.keep_table(analysis.SUITE, suite)
    print(shown(suite, spectrum))
    failed = int((table["status"] == "failed").sum())
    if failed:
        say(f"{failed} of {count(len(table), 'run')} failed and count in no quantile; the column reason says why")
    return failed + len(motions.unusable)


def shown(suite: "pd.DataFrame", spectrum: "SpectrumSpec") -> str:
    """Medians of θ_max/α for a terminal: a line for each value on the axis, ∞ where the pier overturns."""
    import numpy as np
    import pandas as pd

    from rockbatch.commands.summary import named

    axis = spectrum.axis
    apart = [name for name in ("case", "scale", *spectrum.varied) if name != axis]
    told = [name for name in apart if name != "case" and (name != "scale" or suite[name].nunique() > 1)]
    lines = spread(suite[axis].unique())
    columns: dict[str, dict[str, str]] = {}
    for names, own in suite[suite[axis].isin(lines)].groupby(apart, sort=False, dropna=False):
        values = dict(zip(apart, names, strict=True))
        columns[f"{names[0]} {named(told, [values[name] for name in told])}"] = {
            f"{value:.4g}": "" if np.isnan(median) else "∞" if np.isinf(median) else f"{median:.4f}"
            for value, median in zip(own[axis], own["median"], strict=True)
        }
    cells = pd.DataFrame(columns).rename_axis(axis, axis="columns").fillna("")
    of = suite[axis].nunique()
    some = f", {len(lines)} of {of} values of {axis}" if len(lines) < of else ""
    return f"Median of theta_max/alpha{some}; ∞: overturned or ended by flight\n{cells.to_string()}"


def spread(values: "np.ndarray") -> "np.ndarray":
    """At most :data:`MOST_LINES` of ``values``, evenly, the first and the last among them."""
    import numpy as np

    if len(values) <= MOST_LINES:
        return values
    return values[np.linspace(0, len(values) - 1, MOST_LINES).round().astype(int)]


def _evenly(values: "np.ndarray") -> "np.ndarray":
    """At most :data:`MOST_LINES` of ``values``, those that are nearest to evenly spaced ones."""
    import numpy as np

    wanted = np.linspace(values[0], values[-1], MOST_LINES)
    return values[np.unique(np.abs(values[:, None] - wanted).argmin(axis=0))]


def _maps(results: "AnalysisFolder", maps: "tuple[MapSpec, ...]", carrier: "Engine") -> None:
    """Write the overturning maps, and print them."""
    import pandas as pd

    from rockbatch.analysis import overturning_map as analysis
    from rockbatch.analysis.waves import Waves
    from rockbatch.batch.digests import digests
    from rockbatch.batch.groups import NOTHING_MORE
    from rockbatch.commands.progress import Progress
    from rockbatch.files import read_table
    from rockbatch.results.columns import columns

    study = replace(results.study, output=NOTHING_MORE)
    results.info["varied_map"] = list(study.varied)
    told = ("name", "shape", "tolerance", "width")
    results.info["maps"] = [{name: getattr(spec, name) for name in told} for spec in maps]
    digest = digests([], maps=maps, cases=study.cases, numerics=study.numerics)
    if results.has(analysis.RUNS, digest) and (results.directory / analysis.FILE).exists():
        results.keep(analysis.FILE)
        results.keep(analysis.RUNS, digest)
        print(shown_maps(read_table(results.directory / analysis.FILE), study.varied))
        return
    rows: list[Any] = []
    make_ready(study)
    with journal_of(results, analysis.RUNS, columns(study), digest) as journal:
        waves = Waves(study, journal, carrier, Progress)
        for spec in maps:
            own, before = analysis.Maps(spec, study.cases), waves.finished
            say(
                f"map {spec.name}: {_grid(spec, len(study.cases))} on {carrier}; then what changes is looked at more closely"
            )
            found = own.find(waves)
            rows += own.rows(found)
            say(f"map {spec.name}: {sum(map(len, found))} frequencies, {waves.finished - before} runs")
        table = pd.DataFrame(rows, columns=analysis.columns(study.varied))
        results.keep_table(analysis.FILE, table)
        journal.write_in_order(results.directory / analysis.RUNS)
        results.keep(analysis.RUNS, digest)
    print(shown_maps(table, study.varied))


def _grid(spec: "MapSpec", cases: int) -> str:
    grid = f"{spec.frequencies} frequencies × {spec.amplitudes} amplitudes"
    return f"{grid} × {count(cases, 'case')}" if cases > 1 else grid


def shown_maps(table: "pd.DataFrame", varied: tuple[str, ...]) -> str:
    """The regions of every map for a terminal, a line for each frequency."""
    from rockbatch.commands.summary import named

    blocks = []
    for names, own in table.groupby(["map", "case", *varied], sort=False, dropna=False):
        lines = [f"{names[0]}, {names[1]} {named(varied, names[2:])}".rstrip() + ": outcome by a_p/(g tan alpha)"]
        for frequency in _evenly(own["omega_p_over_p"].unique()):
            column = own[own["omega_p_over_p"] == frequency]
            told = "; ".join(f"{each.low:.4g} to {each.high:.4g} {each.outcome}" for each in column.itertuples())
            lines.append(f"  omega_p/p = {frequency:<6.4g} {told}")
        blocks.append("\n".join(lines))
    return "\n\n".join(blocks)
