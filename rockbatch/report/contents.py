"""Contents of a folder, as the sections of its report read them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rockbatch.checks import Verdict, read_verdicts
from rockbatch.report import finished_analysis
from rockbatch.report.finished import Finished, finished
from rockbatch.report.finished_analysis import FinishedAnalysis
from rockbatch.results.opened import Results, open_results
from rockbatch.simulation.response import Response


@dataclass(frozen=True, eq=False)
class Contents:
    """Everything that a report can show; what a folder lacks is None or empty, and its sections are left out.

    Attributes
    ----------
    directory : Path
        The folder.
    study : mapping
        ``path``, ``title``, ``notes``, ``text`` and ``sha256`` of the study file, as run.json has them.
    finished : Finished, optional
        Results of ``rockbatch run``.
    responses : sequence of Response
        Runs whose histories are shown.
    verdicts : sequence of Verdict
        Results of ``rockbatch check``.
    """

    directory: Path
    study: Mapping[str, Any]
    finished: Finished | None = None
    responses: Sequence[Response] = ()
    verdicts: Sequence[Verdict] = ()

    def analysis(self, name: str) -> FinishedAnalysis | None:
        """Return the analysis in NAME.json; None if there is none for this state of the study."""
        return finished_analysis.read(self.directory, name, self.study["sha256"])


def read(directory: Path, responses: Sequence[Response] | None = None, saved: Results | None = None) -> Contents:
    """All that the folder of a run holds; ``responses`` are shown instead of those in ``histories.h5``.

    ``saved`` is what was read there already.

    Raises ``InputError`` where the results are missing, damaged or do not belong together.
    """
    results = saved or open_results(directory)
    shown = results.responses if responses is None else responses
    return Contents(directory, results.info["study"], finished(results), shown, read_verdicts(directory))
