"""Design checks of finished results: a demand of each record, a statistic over the suite, a limit, and the verdict.

What a rule asks is said by :mod:`rockbatch.checks.rules`, and what may be asked by :mod:`rockbatch.quantities`. Here
:mod:`bounds` finds between which bounds each record's demand lies, :mod:`judging` decides, :mod:`verdicts` has the result, and
:mod:`checking` does so for a folder. Never loads the compiler.
"""

from rockbatch.checks.judging import judge
from rockbatch.checks.rules import Rule
from rockbatch.checks.verdicts import Verdict, as_table, read_verdicts, write_verdicts

__all__ = ["Rule", "Verdict", "as_table", "judge", "read_verdicts", "write_verdicts"]
