"""Design checks that decide: a demand, a statistic over the suite of records, a limit, and the reason for it.

:mod:`rules` says what a check asks, :mod:`choices` which of the results it is about, and :mod:`reading` reads it from
TOML. :mod:`demands` and :mod:`suite` turn the rows of peaks.csv into what each record demands, and between which bounds;
:mod:`statistics` sums the suite up, :mod:`judging` decides, and :mod:`verdicts` is what comes out. Never loads the
compiler.
"""

from rockbatch.checks.judging import judge
from rockbatch.checks.reading import load_rules, read_checks
from rockbatch.checks.rules import Rule
from rockbatch.checks.verdicts import Verdict, as_table, read_verdicts, write_verdicts

__all__ = ["Rule", "Verdict", "as_table", "judge", "load_rules", "read_checks", "read_verdicts", "write_verdicts"]
