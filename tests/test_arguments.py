"""Arguments of public functions and classes: another type is answered with a sentence, at every door."""

import os
import re
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from studies import RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common.arguments import checked

PIER = rb.Pier(alpha=0.2, p=1.0)
BASE = rb.RigidBase()
MOTION = rb.pulse("sine", name="one-sine", amplitude=9.81, period=0.5, dt=0.01, duration=1.0)
ROWS = np.sin(np.arange(20.0))

NO_NUMBERS = (None, "0.2", True, [0.2], np.array([0.2]), object(), 1j, Decimal("0.2"), b"x", {}, float, "a\0b")
NUMBER_DOORS = {
    "alpha": lambda value: rb.Pier(alpha=value, p=1.0),
    "width_m": lambda value: rb.Pier.rectangle(value, 10.0),
    "deck_mass_t": lambda value: rb.Pier.with_deck(width_m=8, height_m=30, mass_t=2000, deck_mass_t=value),
    "beta": lambda value: rb.ElasticBase(beta=value),
    "eta": lambda value: rb.YieldingBase(beta=40, eta=value),
    "f": lambda value: rb.Damper("friction", f=value),
    "psi": lambda value: rb.Tendon(psi=value),
    "dt": lambda value: rb.Motion("mine", value, ROWS),
    "amplitude": lambda value: rb.pulse("sine", name="s", amplitude=value, period=0.5, dt=0.01, duration=1.0),
    "factor": lambda value: MOTION.times(value),
    "tolerance": lambda value: rb.simulate(PIER, BASE, MOTION, tolerance=value),
    "quiet_s": lambda value: rb.simulate(PIER, BASE, MOTION, quiet_s=value),
}
OTHER_DOORS = {
    "pier": lambda value: rb.simulate(value, BASE, MOTION),
    "foundation": lambda value: rb.simulate(PIER, value, MOTION),
    "motion": lambda value: rb.simulate(PIER, BASE, value),
    "restraints": lambda value: rb.RigidBase(restraints=value),
    "paths": rb.read_motions,
    "path": rb.load_study,
    "study": rb.run,
    "directory": rb.open_results,
}


@pytest.mark.parametrize(
    ("name", "value"),
    [("alpha", value) for value in NO_NUMBERS] + [(name, "0.2") for name in NUMBER_DOORS],
    ids=lambda value: value if isinstance(value, str) else type(value).__name__,
)
def test_what_is_no_number_is_refused_by_name(name, value):
    with pytest.raises(rb.InputError, match=rf"^{name} = .*(must be a number|NUL character)"):
        NUMBER_DOORS[name](value)


@pytest.mark.parametrize(
    ("name", "value"),
    [("paths", value) for value in (None, True, 0.2, 1j, object(), b"x", {}, np.array([0.2]), "a\0b", [0.2])]
    + [(name, value) for name in OTHER_DOORS for value in (0.2, "a\0b")],
    ids=lambda value: value if isinstance(value, str) else type(value).__name__,
)
def test_an_object_of_another_type_is_refused_by_name(name, value):
    with pytest.raises(rb.InputError, match=rf"^{name} = "):
        OTHER_DOORS[name](value)


@pytest.mark.parametrize("number", [np.float32(0.25), np.float64(0.25), np.longdouble(0.25), Fraction(1, 4)], ids=repr)
def test_numbers_of_other_types_become_those_of_python(number):
    pier = rb.Pier(alpha=number, p=1.0)
    assert type(pier.alpha) is float
    assert pier.alpha == 0.25


def test_a_word_for_a_base_is_answered_with_the_bases_there_are():
    with pytest.raises(
        rb.InputError,
        match=r"^foundation = 'rigid': must be a RigidBase, an ElasticBase, a YieldingBase or a FootingBase$",
    ):
        rb.simulate(PIER, "rigid", MOTION)
    with pytest.raises(rb.InputError, match=re.escape("such as RigidBase(…)")):
        rb.simulate(PIER, rb.RigidBase, MOTION)


def test_all_wrong_arguments_are_reported_at_once():
    with pytest.raises(rb.InputError) as caught:
        rb.simulate(BASE, PIER, "a.at2")
    assert [problem.split(" = ")[0] for problem in caught.value.messages] == ["pier", "foundation", "motion"]


def test_a_list_is_taken_for_a_tuple_and_its_members_are_checked():
    friction = rb.Damper("friction", f=0.1)
    assert rb.RigidBase(restraints=[friction]).restraints == (friction,)
    with pytest.raises(rb.InputError, match="a tuple of Damper or Tendon"):
        rb.RigidBase(restraints=(friction, PIER))


def test_a_file_in_the_place_of_the_results_is_named(tmp_path):
    study, file = write_study(tmp_path, study_text(cases=(RIGID,), pulses=(SINE,))), tmp_path / "file"
    file.write_text("mine")
    for out in (file, file / "beneath"):
        with pytest.raises(rb.InputError, match="a file stands in the place of the folder"):
            rb.run(study, out=out)
    assert file.read_text() == "mine"


def test_a_path_with_a_nul_character_is_refused(tmp_path):
    for door in (rb.open_results, rb.report, rb.check, rb.load_study):
        with pytest.raises(rb.InputError, match="has a NUL character"):
            door(Path("a\0b"))


def test_annotations_that_do_not_tell_are_not_checked():
    """One in quotes, an array, any object, and none."""

    @checked
    def door(a, b: "int", c: np.ndarray, d: object, *rest: int, **more: int):
        return a, b, c, d, rest, more

    given = ("a", "b", "c", "d", ("e",), {"f": "f"})
    assert door(*given[:4], "e", f="f") == given


def test_samples_are_copied_and_cannot_change():
    values = ROWS.copy()
    motion = rb.Motion("mine", 0.01, values, vertical=values)
    values[0] = 7.0
    assert motion.horizontal[0] == motion.vertical[0] == ROWS[0]
    with pytest.raises(ValueError, match="read-only"):
        motion.horizontal[0] = 1.0


@pytest.mark.parametrize(
    ("samples", "words"),
    [
        (np.ma.masked_less(ROWS, 0.0), "masked samples"), (ROWS + 1j, "complex128: must be real numbers"),
        (np.array([0.0, None]), "object: must be real numbers"), (["0.1", "0.2"], "must be real numbers"),
        ([True, False], "bool: must be real numbers"), ([[0.1, 0.2], [0.3]], "cannot be made an array"),
        (3.0, "samples in a row"),
    ],
    ids=["masked", "complex", "object", "str", "bool", "ragged", "scalar"],
)  # fmt: skip
def test_samples_that_are_no_real_numbers_are_refused(samples, words):
    for components in ({"horizontal": samples}, {"horizontal": ROWS, "vertical": samples}):
        with pytest.raises(rb.InputError, match=words):
            rb.Motion("mine", 0.01, **components)


@pytest.mark.parametrize(
    "samples", [ROWS.astype(np.longdouble), ROWS.astype("f4"), np.arange(9), [0.0, 1.0, 0.0], ROWS[::2]]
)
def test_real_numbers_of_any_kind_run(samples):
    motion = rb.Motion("mine", 0.01, samples)
    assert motion.horizontal.dtype == np.float64
    assert rb.simulate(PIER, BASE, motion).status == "ok"


def test_motions_are_equal_by_their_samples():
    one, other = rb.Motion("mine", 0.01, ROWS), rb.Motion("mine", 0.01, ROWS.copy())
    assert one == other
    assert hash(one) == hash(other)
    assert one != one.scaled(2.0)
    assert one != "mine"
    assert rb.read_motions("motions/near_fault") == rb.read_motions("motions/near_fault")


def test_a_place_among_motions_is_a_number_or_a_name():
    motions = rb.read_motions("motions/near_fault")
    assert motions[np.int64(1)] is motions[1]
    with pytest.raises(rb.InputError, match="must be a place, a slice of places or a name"):
        motions[1.0]


def test_equal_arguments_of_doors_are_those_of_os(tmp_path):
    """Any path that ``os`` takes."""

    class Mine(os.PathLike):
        def __fspath__(self):
            return "motions/near_fault"

    assert len(rb.read_motions(Mine())) == 10
