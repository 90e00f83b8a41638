"""Static strength and rocking periods, of one pier or of every case of a study."""

import os
from typing import overload

import numpy as np

from rockbatch.common.arguments import checked
from rockbatch.common.errors import MissingKey, Problem, refuse
from rockbatch.motions import Motion
from rockbatch.pier import Base, Pier
from rockbatch.pier.devices import unlikely_devices
from rockbatch.pier.possible import problems
from rockbatch.pier.statics import Statics, sheet_of
from rockbatch.results.labelled import names_of
from rockbatch.results.run_json import describe_case
from rockbatch.study import Study, load_study


@overload
def statics(pier: Pier, foundation: Base) -> Statics: ...
@overload
def statics(pier: str | os.PathLike[str] | Study) -> dict[str, Statics]: ...
@checked
def statics(
    pier: Pier | str | os.PathLike[str] | Study, foundation: Base | None = None
) -> Statics | dict[str, Statics]:
    """Return the statics sheet of a pier on a foundation, with its devices, or those of a study: nothing is simulated.

    Parameters
    ----------
    pier : Pier, or path-like or Study
        The ``mass_t`` of a pier gives kN, its ``flexural_period_s`` a comparison with the period of rocking. The records of a
        study are not read, and may be missing.
    foundation : RigidBase, ElasticBase, YieldingBase or FootingBase, optional
        That of a pier: its ``restraints`` are the devices, its ``area_m2`` gives bearing stresses. A study has its own.

    Returns
    -------
    Statics, or dict of them
        Numbers, a moment–rotation ``curve`` up to overturning, the period and the damping of free ``swings``, and ``plot()``;
        of a study a sheet of each case, by the names that the terminal gives them.

    Raises
    ------
    InputError
        If the pier cannot stand on the foundation, or a device is implausible and not named in its ``confirm``; with every
        mistake in a study.

    Examples
    --------
    >>> rb.statics(rb.Pier(alpha=0.13, p=0.38), rb.RigidBase())
    <statics of a pier, base rigid>
      lift-off  0.1307 g, at θ/α = 0
      strength  0.1307 g, at θ/α = 0
      moment    6.605 m × weight
      balance   θ/α = 1
      periods   0.1 α 4.92 s, 0.5 α 13.9 s, 0.9 α 31.5 s
      impacts   as viscous damping 0.1 α 1.71%, 0.5 α 2.33%, 0.9 α 4.59%
    """
    if isinstance(pier, Pier):
        if foundation is None:
            refuse([Problem("foundation", None, "a pier needs one, such as RigidBase()", kind=MissingKey)])
        assert foundation is not None
        refuse(problems(pier, foundation) or unlikely_devices(pier, foundation.restraints))
        return sheet_of(pier, foundation)
    if foundation is not None:
        refuse([Problem("foundation", None, "a study has its own foundations; leave it out")])
    study = pier if isinstance(pier, Study) else without_records(pier)
    names = names_of(map(describe_case, study.cases), study.varied, study.text)
    called = (names.named_case(case.name, case.columns, study.varied) for case in study.cases)
    return {
        name.replace("\u00a0", " "): sheet_of(case.pier, case.base)  # with spaces that a keyboard has
        for name, case in zip(called, study.cases, strict=True)
    }


def without_records(path: str | os.PathLike[str]) -> Study:
    """Return the study in a file, with a motion at rest for its records, which may be missing."""
    return load_study(path, motions=Motion("none", 0.01, np.zeros(2)))
