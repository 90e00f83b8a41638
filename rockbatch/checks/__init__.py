"""Design checks of finished results: a demand of each record, a statistic over the suite, a limit, and the verdict.

A rule (:mod:`rules`) comes from a file by :mod:`rule_files`, and may ask for what :mod:`rockbatch.quantities` has.
:mod:`rule_choices` fits it to a study, :mod:`bounds` finds the bounds within which its demand of a suite lies, :mod:`judging`
decides, and :mod:`verdicts` has the result; :mod:`rockbatch.results.checking` does so for a folder. Never loads the compiler.
"""

from rockbatch.checks.judging import judge
from rockbatch.checks.rules import Rule
from rockbatch.checks.verdicts import Verdict, as_table, read_verdicts, write_verdicts

__all__ = ["Rule", "Verdict", "as_table", "judge", "read_verdicts", "write_verdicts"]
