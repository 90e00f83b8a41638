"""Recognise what rockbatch wrote: a folder of records may hold the results of a study that lies beside them."""

import re
from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.motions.sources.archives import bare, content

OWN = "a result that rockbatch wrote"

_TABLES = (".csv", ".part", ".tsv", ".txt")
_HISTORIES = (".h5", ".hdf5")
_HISTORIES_BEGIN = b"rockbatch histories"
_MOST_OF_A_HEAD = 16_384  # bytes: more than the heads of all columns

_COLUMNS_TOGETHER = """
record case polarity scale
case limit_state
record measure unit unscaled level
case parameter swing
case parameter first total
record polarity scale status theta_max_over_alpha
case alpha two_pi_over_p_s
map case outcome
method machine study
case parameter value confidence
case impact t_measured_s
case t_s theta_rad
record file_h file_v
case lift_off_g
case theta_rad moment_over_weight_m
"""
_NAMED_TOGETHER = [frozenset(line.split()) for line in _COLUMNS_TOGETHER.strip().splitlines()]
"""Columns of which every table has at least one group, and which no table of samples has."""


def is_own(path: Path) -> bool:
    """Return whether a file, or a member of an archive, is a table, a journal or the histories of a study or an analysis.

    Its first bytes decide, and of its name the suffix only (.csv, .tsv, .txt, .part, .h5, .hdf5), since it may have been renamed.
    False if it cannot be read.
    """
    suffix = bare(path).suffix.lower()
    if suffix not in (*_TABLES, *_HISTORIES):
        return False
    try:
        begin = content(path, _MOST_OF_A_HEAD)
    except (InputError, OSError):
        return False  # its reader reports what is wrong with it
    if suffix in _HISTORIES:
        return begin.startswith(_HISTORIES_BEGIN)
    first = begin.removeprefix(b"\xef\xbb\xbf").partition(b"\n")[0].decode(errors="replace")
    cells = {cell.strip(' \r"') for cell in re.split("[,;\t]", first)}
    return any(names <= cells for names in _NAMED_TOGETHER)
