"""Report on a finished batch, of one process or of several."""

from typing import TYPE_CHECKING

from rockbatch.batch.listening import count
from rockbatch.commands.messages import say, show

if TYPE_CHECKING:
    from rockbatch.batch.finishing import FinishedBatch
    from rockbatch.study import Study


def tell(finished: "FinishedBatch", study: "Study") -> int:
    """Print the table of peaks and the verdicts, and the paths of what is in the folder; return the exit code."""
    from rockbatch.checks.suite import simulated
    from rockbatch.checks.verdicts import CHECKS
    from rockbatch.commands import check
    from rockbatch.commands.summary import leaning, linearised, other_law, sliding, summary

    code = 0
    if finished.without:
        say(str(finished.without))
        code = 1
    peaks = simulated(finished.saved.peaks)
    by_pga = sorted(finished.motions.motions, key=lambda motion: motion.pga)
    named = {motion.name: motion.short for motion in by_pga}
    show(summary(peaks, study.varied, named))
    labelled = peaks.assign(record=peaks["record"].map(named))
    for warning in filter(
        None, (other_law(labelled, study.varied), linearised(labelled), leaning(labelled), sliding(labelled))
    ):
        say(warning)
    if study.checks:
        code = max(code, check.tell(finished.verdicts, finished.saved.directory / CHECKS, finished.saved))
    else:
        show(check.answered((), finished.saved))
    for path in finished.files:
        if path.name != CHECKS:  # printed with the verdicts
            say(str(path))
    unusable = len(finished.saved.info["unusable"])
    failed = int(((peaks["status"] == "failed") & (peaks["case"] != "")).sum())
    lost = [
        f"{count(n, what)} {how}" for n, what, how in ((failed, "run", "failed"), (unusable, "file", "not used")) if n
    ]
    if lost:
        say(f"{' and '.join(lost)}: the column reason of peaks.csv says why")
        code = 1
    return code
