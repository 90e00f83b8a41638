"""A run withstands, exceeds or leaves undecided each limit state as its check says."""

import pytest
from fragility_samples import of_statuses

from rockbatch.analyses.fragility.limit_states import EXCEEDED, LEFT_OUT, UNDECIDED, WITHSTOOD, states
from rockbatch.analyses.fragility.study import _limits
from rockbatch.checks import Rule
from rockbatch.quantities.arrays import Rows


@pytest.mark.parametrize(("rule", "expected"), [
    ({"at_most": 0.5}, [WITHSTOOD, EXCEEDED, UNDECIDED, UNDECIDED]),
    ({"at_most": 0.3}, [EXCEEDED, EXCEEDED, EXCEEDED, UNDECIDED]),
    ({"at_most": 0.405}, [UNDECIDED, EXCEEDED, UNDECIDED, UNDECIDED]),
    ({"at_most": 0.5, "flight": "infinite", "failed": "left out"}, [WITHSTOOD, EXCEEDED, EXCEEDED, LEFT_OUT]),
    ({"at_most": 0.5, "statistic": "asce7-16"}, [WITHSTOOD, EXCEEDED, EXCEEDED, EXCEEDED]),
    ({"at_most": 3, "statistic": "count", "above": 0.3}, [EXCEEDED, EXCEEDED, EXCEEDED, UNDECIDED]),
])  # fmt: skip
def test_a_run_that_did_not_go_through_counts_as_its_check_says(rule, expected):
    runs = of_statuses(["ok", "overturned", "flight", "failed"])
    case = {"base": "rigid", "pier": {"alpha": 0.2}, "parameters": {}}
    found = states(Rule("check", "theta_max_over_alpha", **rule), Rows(runs), case)
    assert list(found) == expected


def test_whether_a_run_that_was_cut_short_would_have_overturned_is_undecided():
    runs = of_statuses(["ok", "overturned", "flight", "failed"])
    found = states(Rule("overturning", "overturned", at_most=0), Rows(runs), {"base": "rigid", "parameters": {}})
    assert list(found) == [WITHSTOOD, EXCEEDED, UNDECIDED, UNDECIDED]


def test_checks_of_forces_that_peaks_do_not_have_are_no_limit_states():
    """Those in a section, and those over a curve; a capacity that is a number leaves the quantity of the run."""
    rules = (
        Rule("rotation", "theta_max_over_alpha", 0.5, reason="r"),
        Rule("toe", "pivot_force_kN", 0.9, capacity=9e3, reason="r"),
        Rule("joint", "base_shear_over_capacity", 1.0, capacity=9e3, reason="r"),
        Rule("foot", "section_shear_kN", 9e3, at_m=0.0, reason="r"),
    )
    assert [(rule.name, rule.limit) for rule in _limits(None, rules, None)] == [("rotation", 0.5), ("toe", 8100.0)]
