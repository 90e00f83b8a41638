"""Sentences of designs and of fragility, read back: each value, count and name in them is that of what they speak of."""

import math
import re
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from messages import assert_states, said_by

import rockbatch as rb
from rockbatch.analyses.accuracy import section as accuracy
from rockbatch.analyses.accuracy.error_and_time import SUBSTEPS, Clock, _of_steps
from rockbatch.analyses.design import answer as design
from rockbatch.analyses.fragility import answer as fragility
from rockbatch.analyses.fragility.bounds import NoCurve, outside, separated
from rockbatch.analyses.fragility.curves import Undecided
from rockbatch.analyses.fragility.lognormal import Capacities, _degenerate
from rockbatch.analyses.fragility.measures import own_measure
from rockbatch.analyses.fragility.risk import note
from rockbatch.analyses.fragility.scale_factors import in_words
from rockbatch.analyses.fragility.statistics import cloud
from rockbatch.analyses.fragility.tables import _about_drawn, _about_undecided
from rockbatch.analyses.release.analysis import _Test
from rockbatch.analyses.sensitivity import answer as sensitivity
from rockbatch.analyses.spectrum import answer as spectrum
from rockbatch.batch.listening import Listener
from rockbatch.common.errors import InputError
from rockbatch.pier import Pier
from rockbatch.study import Numerics, Study

VARIED = [
    {"path": "case.damper.f", "low": 0.02, "high": 0.2, "step": 0.0175},
    {"path": "pier.width_m", "low": 5.0, "high": 9.0, "step": 0.45},
]
TRIED = {
    "verdict": "pass", "case.damper.f": 0.06, "check": "drift", "reason": None, "ratio": 0.83, "under_bound": "soft ground",
    "record": "LGP000", "at_scale": 1.5,
}  # fmt: skip


def ends(side, value, verdict, check, ratio, bound=None):
    """Return what an interval has about its neighbour ``below`` or ``above``."""
    said = {
        "verdict": verdict,
        "check": check,
        "reason": None,
        "ratio": ratio,
        "under_bound": bound,
        "record": "TCU052",
    }
    return {side: value} | {f"{side}_{key}": of_end for key, of_end in said.items()} | {f"{side}_at_scale": 1.0}


def interval(
    low, high, verdict="pass", below=(0.05, "fail", "drift", 1.27), above=(0.13, "fail", "uplift", 1.08), **more
):
    """Return an interval of values with one verdict; None stands for the end of the scan."""
    neighbours = {}
    for side, neighbour in (("below", below), ("above", above)):
        neighbours |= ends(side, *(neighbour or (None, None, None, None)))
    return {"verdict": verdict, "low": low, "high": high, "widest_step": 0.031} | neighbours | more


def line(rows, find="least", tried=None):
    about = {"vary": VARIED[:1], "find": find, "bounds": ["soft ground"]}
    best = [TRIED, TRIED | {"case.damper.f": 0.11, "ratio": 0.94, "check": "uplift"}]
    return lambda: [text for _, text in design._of_line(about, rows, tried or best)]


def plane(rows, find="least", tried=()):
    about = {"vary": VARIED, "find": find, "bounds": []}
    return lambda: [text for _, text in design._of_map(about, rows, tried)]


def left_open(**info):
    about = {
        "vary": VARIED[:1], "width": 0.04, "without_limit": [], "omitted": [], "unusable": 0, "refused": [], "lacking": [],
        "not_selected": [],
        "tried": 11, "beyond": [], "cut_short": 0, "of_one_motion": False, "passing": 7,
    }  # fmt: skip
    return lambda: [text for _, text in design._remarks(about | info, [interval(0.06, 0.11)])]


BEST = ["drift", 83.0, 1.5, "LGP000"]
"""What governs the value that is tried first, as a sentence says it."""
BELOW, ABOVE = ["fails", "drift", 127.0, "TCU052"], ["fails", "uplift", 108.0, "TCU052"]
UNDECIDED = 0.05, "not decided", "tilt", 0.97
WIDTH, FORCE = "pier.width_m", "case.damper.f"
REFUSED = [{"values": [0.15, 7.25], "reason": "too wide"}, {"values": [0.17, 7.7], "reason": "too wide"}]
FAILED = [TRIED | {"verdict": "fail", "ratio": 1.3}, TRIED | {"verdict": "fail", "ratio": 1.2, FORCE: 0.11}]
NO_PAIR = (1.3, 0.06, 5.45), (1.2, 0.11, 6.35), (1.4, 0.13, 7.25)
POINTS = [0.06, 0.07, 0.08, 0.09, 0.11, 0.12, 0.13]
DESIGNS = {
    "the least value": (
        line([interval(0.06, 0.2, above=None)]),
        ["least case.damper.f", "every bound", 0.06, "drift under soft ground", *BEST[1:], 0.05, *BELOW],
    ),
    "the greatest value": (
        line([interval(0.02, 0.11, below=None)], "greatest"),
        ["greatest case.damper.f", 0.11, "uplift", 94.0, 1.5, "LGP000", 0.13, *ABOVE],
    ),
    "the end of the scan": (
        line([interval(0.06, 0.2, below=None, above=None)]),
        [FORCE, 0.06, "lower end", *BEST, "least value"],
    ),
    "gaps": (
        line([interval(0.06, 0.08, above=UNDECIDED), interval(0.11, 0.19)]),
        [
            *(FORCE, 0.06, *BEST, 0.05, *BELOW, FORCE, 0.06, 0.08, "below it", *BELOW[:3], "above it", "tilt", 97.0),
            *(0.11, 0.19, "below it", *BELOW[:3], "above it", *ABOVE[:3]),
        ],
    ),
    "more gaps": (
        line([interval(x, x) for x in POINTS]),
        [FORCE, 0.06, *BEST, 0.05, *BELOW, "passes from"]
        + [number for x in POINTS[: design.MOST_INTERVALS] for number in (x, x, 127.0, 108.0)]
        + [len(POINTS) - design.MOST_INTERVALS],
    ),
    "values that are not decided": (
        line([interval(0.03, 0.05, "not decided"), interval(0.06, 0.2, below=UNDECIDED, above=None)]),
        [FORCE, 0.06, *BEST, 0.05, "not decided", "tilt", 97.0, "TCU052", 0.03, 0.05, "least", "low", 0.03],
    ),
    "no value": (
        line([interval(0.02, 0.2, "fail")], tried=FAILED),
        [FORCE, 0.02, 0.2, 0.11, "fails", "drift", 120.0, 1.5, "LGP000"],
    ),
    "the least of a map": (
        plane(
            [
                interval(0.06, 0.1, **{WIDTH: 5.45}),
                interval(0.04, 0.1, below=(0.03, "fail", "tilt", 1.44), **{WIDTH: 9.0}),
                interval(0.1, 0.2, "fail", **{WIDTH: 6.35}),
            ]
        ),
        ["least", FORCE, 0.04, WIDTH, 9.0, "end of its scan", 0.03, "tilt", 144.0, "TCU052", 1.0, 3.0, WIDTH, FORCE],
    ),
    "the greatest of a map": (
        plane([interval(0.06, 0.1, **{WIDTH: 5.45}), interval(0.04, 0.2, above=None, **{WIDTH: 7.25})], "greatest"),
        ["greatest", FORCE, 0.2, "its scan ends", WIDTH, 7.25],
    ),
    "no pair of values": (
        plane(
            [interval(0.02, 0.2, "fail", **{WIDTH: 5.45})],
            tried=[TRIED | {"verdict": "fail", "ratio": ratio, FORCE: f, WIDTH: w} for ratio, f, w in NO_PAIR],
        ),
        [0.11, 6.35, "fails", "drift", 120.0, 1.5, "LGP000"],
    ),
    "records beyond a limit": (
        left_open(beyond=["uplift in 3 of 9", "tilt in 2 of 8"]),
        ["uplift", 3.0, 9.0, "tilt", 2.0, 8.0],
    ),
    "runs that do not end standing": (left_open(cut_short=3, passing=5), [3.0, 5.0, "values"]),
    "steps without a run": (left_open(width=0.01), [0.031]),
    "steps of a map": (left_open(vary=VARIED), [WIDTH, 0.45]),
    "files and limits": (left_open(unusable=4, without_limit=["uplift", "tilt"]), ["uplift, tilt", 4.0]),
    "stations not selected": (left_open(not_selected=list("ABCDEFGHI")), ["A, B, C, D, E, F, and", 3.0, "more"]),
    "refused values": (
        left_open(vary=VARIED, refused=REFUSED, lacking=["rigid"]),
        [WIDTH, 0.45, 2.0, 11.0, FORCE, 0.15, WIDTH, 7.25, "too wide", f"{FORCE} and {WIDTH}", "rigid"],
    ),
}


def brackets(low, high):
    return np.array(low), np.array(high), 0.95


def factors(scales, reached=(), lost=()):
    """Return what is said of records with these factors by level, the intensities reached, and the levels lost."""
    used = list(reached) or [{x: x for x in by_level} for by_level in scales]
    plan = SimpleNamespace(used=used, not_used=list(lost) or [{} for _ in used], factor=lambda m, x: scales[m][x])
    spec = SimpleNamespace(
        levels=(0.2, 0.4), method="stripes", least_scale=0.25, most_scale=4.5, unit="g", label="SA(1.2 s)"
    )
    return lambda: in_words([plan], spec)


RISK = SimpleNamespace(
    rate=2e-3, interval=None, above=3e-4, below=2.6e-4, bounds=(1.7e-3, 2.9e-3), beyond_levels=(4e-4, 5e-4)
)


def rate():
    hazard = SimpleNamespace(curve=SimpleNamespace(levels=(0.1, 0.3)), years=(50.0,))
    return note(RISK, SimpleNamespace(hazard=hazard, levels=(0.15, 0.35, 0.85), unit="g"))


FRAGILITY = {
    "a median below": (lambda: outside(SimpleNamespace(median=0.05, median_interval=None), 0.1, 0.4).reason, [0.1]),
    "a median above": (lambda: outside(SimpleNamespace(median=0.95, median_interval=None), 0.1, 0.4).reason, [0.4]),
    "no record": (lambda: separated(*brackets([0.3, 0.7], [math.inf, math.inf])).reason, [0.7, 6]),
    "every record": (lambda: separated(*brackets([0.0, 0.0], [0.3, 0.2])).reason, [0.2, 6]),
    "a median between": (lambda: separated(*brackets([0.2, 0.3], [0.5, 0.45])).reason, [0.3, 0.45, 6]),
    "one level": (
        lambda: _degenerate(Capacities(*brackets([0.2, 0.4], [0.4, 0.6])[:2], np.ones(2)), 0.95).reason,
        [0.4],
    ),
    "a value of a measure": (
        lambda: own_measure("AvgSa [g]", [("a", 0.2), ("b", -0.3), ("c", 0.1), ("c", 0.2)], 1.0),
        ["b", "AvgSa", -0.3, 0.0, "c", "AvgSa"],
    ),
    "a heading without a unit": (
        lambda: own_measure("FIV3", [("a", 0.2)], 1.0),
        ['"FIV3"', '"FIV3 [g]"', '"FIV3 [-]"'],
    ),
    "a record without a value": (
        lambda: own_measure("AvgSa [g]", [("LGP000", 0.2)], 1.0).of_records(["LGP090"]),
        ["LGP090", '"AvgSa"', "LGP000"],
    ),
    "demands": (lambda: cloud([0.1, 0.2, 0.3], [1.0, 2.0, 3.0], 1.0, stations=["a", "b"]), [2.0, 3.0]),
    "a limit": (lambda: cloud([0.1, 0.2], [1.0, 2.0], -0.4), ["limit", -0.4, 0.0]),
    "a level": (lambda: cloud([0.1, 0.2, -0.3], [1.0, 2.0, 3.0], 1.0), [2.0, 0.0]),
    "factors": (factors([{0.2: 0.5, 0.4: 1.7}, {0.2: 0.8}]), [0.5, 1.7, 0.8]),
    "limits on factors": (
        factors([{0.2: 0.5, 0.4: 1.7}, {0.2: 0.8}, {}], lost=[{}, {0.4: 4.4}, {0.2: 7.0, 0.4: 9.0}]),
        [0.5, 1.7, 0.8, 0.25, 4.5, 2.0, 3.0, 0.2, 1.0, 3.0, 0.4],
    ),
    "factors away from a level": (
        factors([{0.2: 0.5, 0.4: 1.7}, {0.2: 0.8}], [{0.2: 0.31, 0.4: 0.41}, {0.2: 0.17}]),
        [0.5, 1.7, 0.8, 0.17, 0.31, 0.2, "SA(1.2 s)"],
    ),
    "rates from beyond": (
        rate,
        [15.0, 1.7e-3, 2.9e-3, 13.0, 20.0, 0.15, "g", 25.0, 0.85, "g"],
    ),
}
INPUTS = [
    {"parameter": name, "total": total, "total_error": error, "swing": swing, "low": low, "high": high, "answer_low": at_low,
     "answer_high": at_high, "answer_base": 0.412}
    for name, total, error, swing, low, high, at_low, at_high in (
        ("beta", 0.55, 0.04, 0.2, 30.0, 60.0, 0.31, 0.52), ("eta", 0.32, 0.03, 0.3, 2.1, 3.7, 0.29, 0.58),
        ("mu", 0.21, 0.02, 0.1, 2.8, 3.1, 0.39, 0.42), ("zeta", 0.002, 0.001, 0.01, 0.02, 0.08, 0.41, 0.413),
        ("alpha", 0.003, 0.002, 0.02, 0.11, 0.13, 0.4, 0.42),
    )
]  # fmt: skip
SENSITIVITY = {
    "the inputs of a case": (
        lambda: plain_text(sensitivity._of_case(INPUTS, 1.0)),
        ["β", 0.55, 0.04, "η", 0.32, 0.03, "μ", 0.21, 0.02, 2.0, 0.01, "η", 0.29, 2.1, 0.58, 3.7, 0.412],
    ),
    "inputs of many cases": (
        lambda: plain_text(sensitivity._in_most([INPUTS, INPUTS[1:], INPUTS, [INPUTS[0] | {"total": math.nan}]])),
        [4.0, "cases", "β", 2.0, 0.55, 0.55, "η", 1.0, 0.32, 0.32, 1.0],
    ),
    "runs of a sample": (
        lambda: sensitivity._of_runs(
            {
                **{"statistic": "median", "statuses": {"ok": 80, "overturned": 7, "flight": 4, "failed": 3}},
                **{"overturned": 2.5, "motions": 4, "stations": 4},
            }
        ),
        [11.0, 94.0, "runs", 2.5, 3.0, 94.0, "runs"],
    ),
}  # fmt: skip


def plain_text(markup):
    return re.sub(r"<[^>]*>", "", str(markup))


def regions(*rows):
    return pd.DataFrame(rows, columns=["map", "case", "outcome", "low", "high", "omega_p_over_p"])


SUITE = pd.DataFrame({"count": [30, 28], "flight": [2, 3], "failed": [0, 4]})
FALLING = (
    ("sine", "rigid", "overturned with impact", 2.15, 9.0, 3.5),
    ("sine", "rigid", "overturned without impact", 2.75, 9.0, 5.5),
)
STANDING = [("sine", "rigid", "standing", 0.5, 2.15, 3.5), ("sine", "rigid", "standing", 0.5, 7.5, 8.5)]
SPECTRUM = {
    "runs of a spectrum": (lambda: spectrum._of_runs(SUITE), [5.0, 62.0, "runs", 4.0, 62.0, "runs"]),
    "the least pulse": (
        lambda: spectrum._least_of({"cases": [{"case": "rigid"}], "varied_map": []}, regions(*FALLING, *STANDING), ["case"], ""),
        ["least sine", 2.15, 3.5],
    ),
    "no pulse": (
        lambda: spectrum._least_of({"cases": [{"case": "rigid"}], "varied_map": []}, regions(*STANDING), ["case"], ""),
        ["sine", 3.5, 8.5, 7.5],
    ),
    "pulses that may overturn": (
        lambda: spectrum._left_open(regions(*FALLING, ("sine", "rigid", "flight", 1.25, 2.15, 4.5), *STANDING)),
        [1.25, 4.5],
    ),
}  # fmt: skip


def curve(case, median, **more):
    """Return a curve as fragility.json has it."""
    undecided = {"runs": 60, "flight": 4, "failed": 3, "other": 1, "lower": 1}
    return {"case": case, "columns": {}, "median": median, "says_little": False, "undecided": undecided, "points": [],
            "median_undecided": None, "stations": 17, "piers": 1, "capacities": []} | more  # fmt: skip


ABOUT = {
    "unit": "g",
    "measure": "PGA",
    "levels": [0.2, 0.9],
    "varied": [],
    "cases": [],
    "records": 34,
    "stations": 17,
    "confidence": 0.9,
}
CURVES = [curve("a", None), curve("b", 0.4, says_little=True), curve("c", None)]
UNDECIDED = Undecided(400, 10, 2, 5)
FRAGILITY |= {
    "components": (lambda: fragility._shared(ABOUT), [34.0, "records", 17.0, "stations"]),
    "few earthquakes": (
        lambda: fragility._shared(ABOUT | {"stations": 34, "events": 3}),
        [3.0, "earthquakes"],
    ),
    "intervals by earthquake": (lambda: fragility._shared(ABOUT | {"events": 6, "by": "event"}), [6.0, "earthquakes"]),
    "curves that say little": (
        lambda: list(fragility._of_all(ABOUT | {"curves": CURVES, "stations": 34}))[:2],
        [2.0, 3.0, 1.0, 3.0],
    ),
    "an extrapolation": (
        lambda: fragility._left_open(ABOUT, curve("a", 1.3), []),
        [0.2, 0.9, "g"],
    ),
    "undecided runs": (lambda: fragility._left_open(ABOUT, curve("a", None), []), [9.0, 60.0, "runs"]),
    "kinds of undecided runs": (lambda: UNDECIDED.words, [17.0, 400.0, "runs", 10.0, "flew", 2.0, "failed", 5.0]),
    "runs left open by what a demand leaves out": (
        lambda: Undecided(400, 10, 0, 0, 7, "impulses are left out").words,
        [17.0, 400.0, "runs", 10.0, "flew", 7.0, "below the limit", "impulses are left out"],
    ),
    "undecided runs that change nothing": (
        lambda: _about_undecided(SimpleNamespace(undecided=UNDECIDED, readings=None)),
        [17.0, 400.0, "runs", 10.0, 2.0, 5.0, "nothing"],
    ),
    "undecided runs on either side": (
        lambda: _about_undecided(
            SimpleNamespace(
                undecided=UNDECIDED,
                readings=[SimpleNamespace(median=0.31), SimpleNamespace(median=0.47)],
                inconclusive=True,
            )
        ),
        ["little", 17.0, 400.0, "runs", 10.0, 2.0, 5.0, "beyond", 0.31, "within", 0.47],
    ),
    "drawn inputs": (
        lambda: _about_drawn(
            SimpleNamespace(
                drawn_share=SimpleNamespace(effects=[0.05, -0.02], errors=[0.012, 0.008]), fitted=None, drawn=["alpha", "eta"]
            )
        ),
        ["alpha", 5.0, 1.2, "eta", -2.0, 0.8],
    ),
}  # fmt: skip
PIER = Pier(0.2, 1.25, initial_rotation_rad=-0.08)
MEASURED = SimpleNamespace(
    case=SimpleNamespace(pier=PIER),
    measured=SimpleNamespace(t=[0.7, 1.9, 2.8, 3.5]),
    model=lambda value: SimpleNamespace(t=np.array([0.8, 2.0, 3.0, 3.6])),
)
"""A release with a mean half cycle of 0.9 s."""


def fit(**values):
    found = {
        "value": 0.9,
        "at_end": False,
        "stretch": 1.0,
        "stretch_error": 0.01,
        "t_rms": 0.0045,
        "amplitude_rms": 0.0012,
    }
    return SimpleNamespace(**found | values)


def bounds(value, low, high):
    return SimpleNamespace(value=value, low=low, high=high)


def doubt(best, times=None, amplitudes=None):
    return lambda: _Test._doubt(MEASURED, best, {"by_times": times, "by_amplitudes": amplitudes})


RELEASE = {
    "differences of a release": (
        lambda: _Test._differences(MEASURED, fit()),
        [4.5, "ms", 0.005, "half cycle", 1.2, "mrad", 0.015, "initial rotation"],
    ),
    "times that are stretched": (
        doubt(fit(stretch=1.25, stretch_error=0.03)),
        [1.25, 0.03, "p", 1.0, "rad/s", 1.25, "size"],
    ),
    "times and amplitudes apart": (
        doubt(fit(), bounds(0.91, 0.9, 0.92), bounds(0.84, 0.82, 0.86)),
        [0.91, 0.84],
    ),
}
TWO = {"cases": [{"case": "rigid"}, {"case": "pads"}], "varied_map": []}
ON_PADS = [("sine", "pads", *row[2:]) for row in FALLING]
SPECTRUM |= {
    "the least pulse of two cases": (
        lambda: spectrum._least_of(TWO, regions(FALLING[1], *STANDING, *ON_PADS), ["case"], ""),
        ["least sine", 2.15, 3.5, "pads", "the least of", 2.0, "cases"],
    ),
    "the same pulse in two cases": (
        lambda: spectrum._least_of(TWO, regions(*FALLING, *STANDING, *ON_PADS), ["case"], ", the least of 5 maps"),
        ["least sine", 2.15, 3.5, 2.0, 2.0, "cases", 5.0, "maps"],
    ),
}
OWN = SimpleNamespace(error_max=3e-4, status_differs=2, tolerance=1e-4)
ACCURACY = {
    "an error above its tolerance": (lambda: accuracy._remarks(OWN, 5e-4), ["tolerance", 2.0, "of these runs", 5e-4]),
}


class First(Listener):
    """Stops what speaks to it at its first sentence, which becomes an error."""

    def say(self, text):
        raise InputError(text)


RANGES = {"frequency": [1.0, 8.0], "amplitude": [1.0, 12.0]}


def first_of_maps(cases):
    """Return a function that begins the overturning maps of so many cases."""
    study = Study.from_dict(
        {
            "pier": {"alpha": 0.2, "p": 1.0},
            "motions": {"still_s": 5.0},
            "case": [{"name": f"rock {chr(97 + i)}", "base": "rigid"} for i in range(cases)],
            "spectrum": {"map": [{"name": "halves", "shape": "sine", "frequencies": 5, "amplitudes": 8} | RANGES]},
        }
    )
    return lambda: rb.spectrum(study, progress=First(), jobs=1)


SPECTRUM |= {
    "the map of a case": (first_of_maps(1), ["map halves", 5.0, "frequencies", 8.0, "amplitudes", 1.0, "thread"]),
    "the map of three cases": (
        first_of_maps(3),
        ["map halves", 5.0, "frequencies", 8.0, "amplitudes", 3.0, "cases", 1.0, "thread"],
    ),
}
ACCURACY |= {
    "settings and runs": (
        lambda: _of_steps(SimpleNamespace(numerics=Numerics()), [None] * 7, First(), Clock()),
        [1.0 + 2.0 * len(SUBSTEPS), "settings", 7.0, "runs"],
    ),
}
FRAGILITY |= {
    "drawn inputs of unknown share": (
        lambda: _about_drawn(SimpleNamespace(drawn_share=NoCurve("3 draws are too few"), fitted=None, drawn=["alpha"])),
        ["not known", 3.0, "draws are too few"],
    ),
}
MESSAGES = DESIGNS | FRAGILITY | SENSITIVITY | SPECTRUM | RELEASE | ACCURACY


@pytest.mark.parametrize("name", MESSAGES)
def test_what_a_sentence_names_is_what_it_speaks_of(name):
    call, expected = MESSAGES[name]
    assert_states(said_by(call), *expected)
