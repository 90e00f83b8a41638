"""Every public name of rockbatch, called with what no caller should pass: errors of its own name the argument."""

import copy
import inspect
import pickle

import numpy as np
import pytest
from studies import study_text, write_study

import rockbatch as rb
import rockbatch.batch.single
from rockbatch.common.analyses import ANALYSES

PIER = rb.Pier.rectangle(8, 30, mass_t=3000)
SHAKE = rb.pulse("sine", name="s", amplitude=3.0, period=1.0, dt=0.01, duration=2.0)
HOSTILE = [
    10**400, -(10**5000), 2**70, 1e308, float("nan"), float("inf"), -1, 0, True, None, "\ud800", "a\0b", ["\ud800"], "/dev/zero",
    b"x", object(), [], {}, [10**400], rb.Pier, np.array([1.0]),
]  # fmt: skip
MISSING = {"study": "nowhere.toml"}
CALLS = {  # what is called, and arguments that it takes
    "Pier": (rb.Pier, {"alpha": 0.2, "p": 1.0}),
    "Pier.from_size": (rb.Pier.from_size, {"alpha": 0.2, "size_m": 10.0}),
    "Pier.rectangle": (rb.Pier.rectangle, {"width_m": 8.0, "height_m": 30.0}),
    "Pier.of_parts": (rb.Pier.of_parts, {"width_m": 8.0, "parts": [rb.Part(1000.0, 15.0, 1e5)]}),
    "Pier.with_deck": (rb.Pier.with_deck, {"width_m": 8.0, "height_m": 30.0, "mass_t": 2000.0, "deck_mass_t": 1000.0}),
    "Pier.frame": (rb.Pier.frame, {"column": PIER, "columns": 2, "deck_mass_t": 3000.0}),
    "Part.shaft": (rb.Part.shaft, {"width_m": 8.0, "height_m": 30.0, "mass_t": 2000.0}),
    "Damper": (rb.Damper, {"kind": "viscous"}),
    "Damper.viscous": (rb.Damper.viscous, {"pier": PIER, "coefficient_kN_s_m": 900.0}),
    "Damper.friction": (rb.Damper.friction, {"pier": PIER, "force_kN": 450.0}),
    "Damper.hysteretic": (rb.Damper.hysteretic, {"pier": PIER, "force_kN": 450.0, "yield_mm": 5.0}),
    "Tendon": (rb.Tendon, {}),
    "Stop": (rb.Stop, {"gap_m": 0.1, "lam": 20.0}),
    "DeckSpring": (rb.DeckSpring, {"lam": 0.2}),
    "RigidBase": (rb.RigidBase, {}),
    "ElasticBase": (rb.ElasticBase, {"beta": 40.0}),
    "ElasticBase.from_stiffness": (rb.ElasticBase.from_stiffness, {"pier": PIER, "stiffness_kN_m": 2e6}),
    "YieldingBase": (rb.YieldingBase, {"beta": 40.0, "eta": 2.5}),
    "YieldingBase.from_stiffness": (rb.YieldingBase.from_stiffness, {"pier": PIER, "stiffness_kN_m": 2e6, "eta": 2.5}),
    "FootingBase": (rb.FootingBase, {"beta": 40.0}),
    "FootingBase.from_stiffness": (
        rb.FootingBase.from_stiffness, {"pier": PIER, "stiffness_MN_m3": 60.0, "length_m": 12.0},
    ),
    "FootingBase.from_soil": (
        rb.FootingBase.from_soil, {"pier": PIER, "shear_modulus_MPa": 60.0, "poisson": 0.3, "length_m": 12.0},
    ),
    "pulse": (rb.pulse, {"shape": "sine", "name": "s", "amplitude": 3.0, "period": 1.0, "dt": 0.01, "duration": 2.0}),
    "Motion": (rb.Motion, {"name": "s", "dt": 0.01, "horizontal": [0.0, 1.0]}),
    "Motion.from_array": (rb.Motion.from_array, {"values": [0.0, 1.0], "dt": 0.01, "unit": "g"}),
    "Motion.still": (rb.Motion.still, {"duration_s": 2.0}),
    "Motion.times": (SHAKE.times, {"factor": 2.0}),
    "Motion.spectrum": (SHAKE.spectrum, {}),
    "ReadOptions": (rb.ReadOptions, {}),
    "read_motions": (rb.read_motions, {"paths": "nowhere"}),
    "sequence": (rb.sequence, {"motions": [SHAKE, SHAKE]}),
    "pair_spectrum": (rb.pair_spectrum, {"first": SHAKE, "second": SHAKE}),
    "Dask": (rb.Dask, {}),
    "HazardCurve": (rb.HazardCurve, {"levels": [0.1, 0.2], "rates": [0.1, 0.01]}),
    "Rule": (rb.Rule, {"name": "a", "demand": "theta_max_over_alpha", "at_most": 0.5}),
    "check": (rb.check, {"results": "nowhere"}),
    "statics": (rb.statics, {"pier": PIER, "foundation": rb.RigidBase()}),
    "simulate": (rb.simulate, {"pier": PIER, "foundation": rb.RigidBase(), "motion": SHAKE}),
    "open_results": (rb.open_results, {"directory": "nowhere"}),
    "report": (rb.report, {"directory": "nowhere"}),
    "statement": (rb.statement, {"directory": "nowhere"}),
    "load_study": (rb.load_study, {"path": "study.toml"}),
    **{name: (getattr(rb, name), MISSING) for name in (*ANALYSES, "run")},
}  # fmt: skip
ERRORS = {name for name in rb.__all__ if isinstance(kind := getattr(rb, name), type) and issubclass(kind, Exception)}
MADE_BY_OTHERS = {*ERRORS, "Problem", "Part", "MotionSet", "Response", "Statics", "Study"}
"""Results of other calls, and errors; the numbers of a part are checked by the pier."""


class BegunError(Exception):
    """A run that would now be computed."""


@pytest.fixture(autouse=True)
def nothing_is_computed(monkeypatch, tmp_path):
    def begin(*_):
        raise BegunError

    monkeypatch.setattr(rockbatch.batch.single, "_outcome", begin)
    monkeypatch.chdir(tmp_path)
    write_study(tmp_path, study_text())


def keywords(call):
    named = inspect.signature(call).parameters.values()
    return [each.name for each in named if each.kind not in (each.VAR_KEYWORD, each.VAR_POSITIONAL)]


def refusal(call, arguments):
    """What Python says of a keyword that does not exist; empty where the call returns, or refuses in words of our own."""
    try:
        call(**arguments)
    except TypeError as error:
        return str(error)
    except (rb.InputError, BegunError):
        pass
    return ""


def test_every_public_name_is_called():
    assert {name.partition(".")[0] for name in CALLS} | MADE_BY_OTHERS == set(rb.__all__)


@pytest.mark.parametrize("name", CALLS)
def test_what_no_caller_should_pass_is_refused_in_words_of_our_own(name):
    call, usual = CALLS[name]
    for keyword in (*keywords(call), "nope"):
        for value in HOSTILE:
            if said := refusal(call, usual | {keyword: value}):
                assert f"'{keyword}'" in said


def test_an_unknown_keyword_is_that_of_the_function_that_was_called():
    with pytest.raises(TypeError, match=r"^simulate\(\) got an unexpected keyword argument 'nope'$"):
        rb.simulate(PIER, rb.RigidBase(), SHAKE, nope=1)


def test_numbers_without_end_and_halves_of_characters_are_named():
    with pytest.raises(rb.InputError, match=r"alpha = 1000.*…: must be within −1e\+18 and 1e\+18"):
        rb.Pier(alpha=10**400, p=1.0)
    with pytest.raises(rb.InputError, match="alpha = a int of thousands of digits: must be within"):
        rb.Pier(alpha=10**5000, p=1.0)
    with pytest.raises(rb.InputError, match=r"path = '\\ud800': has '\\ud800', half of a character"):
        rb.load_study("\ud800")


@pytest.mark.parametrize("path", ["/dev/zero", "/dev/null"])
def test_a_device_is_no_folder_of_results(path):
    for call in (rb.open_results, rb.report, rb.check):
        with pytest.raises(rb.InputError, match=f"{path}: a file, not a folder of results"):
            call(path)


def test_copies_of_a_motion_cannot_be_changed_either():
    pair = rb.Motion("s", 0.01, [0.0, 1.0], [0.0, 0.5], across=np.array([0.0, 0.2]))
    for other in (copy.copy(pair), copy.deepcopy(pair), pickle.loads(pickle.dumps(pair)), pair.times(2.0)):
        for samples in (other.horizontal, other.vertical, other.across):
            with pytest.raises(ValueError, match="read-only"):
                samples[0] = 1.0
    assert copy.deepcopy(pair) == pair
