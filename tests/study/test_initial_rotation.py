"""Keys of a pier that is let go from a rotation, and of the still ground under it."""

import math

import pytest
from studies import study_text, write_study

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

STILL = {"still_s": 5.0}


def problems_of(tmp_path, **tables) -> list[str]:
    with pytest.raises(InputError) as error:
        load_study(write_study(tmp_path, study_text(**tables)))
    return error.value.messages


def test_a_list_of_rotations_is_a_pier_for_each(tmp_path):
    pier = {"alpha": 0.2, "p": 2.0, "initial_rotation_rad": [0.05, -0.1]}
    study = load_study(write_study(tmp_path, study_text(pier=pier, motions=STILL)))
    assert [case.pier.initial_rotation_rad for case in study.cases] == [0.05, 0.05, -0.1, -0.1]
    assert "initial_rotation_rad" in study.varied
    motion = ground_motions(study).motions[-1]
    assert (motion.name, motion.pga, motion.duration) == ("still", 0.0, 5.0)


def test_a_rotation_beyond_alpha_is_refused_and_one_in_degrees_translated(tmp_path):
    pier = {"alpha": 0.2, "p": 2.0, "initial_rotation_rad": 0.25}
    (problem,) = problems_of(tmp_path, pier=pier, motions=STILL)
    assert "initial_rotation_rad = 0.25: must be below alpha = 0.2 rad in magnitude" in problem
    assert "study.toml:" in problem
    assert "degrees" not in problem
    (problem,) = problems_of(tmp_path, pier=pier | {"initial_rotation_rad": 5.0}, motions=STILL)
    assert f"if it is in degrees, write {math.radians(5.0):.4g}" in problem


def test_the_reversed_motion_of_a_pier_that_leans_is_no_mirror_image(tmp_path):
    pier = {"alpha": 0.2, "p": 2.0, "initial_rotation_rad": 0.05}
    (problem,) = problems_of(tmp_path, pier=pier, motions=STILL | {"polarity": ["+", "-"]})
    assert "keep one polarity, and list initial_rotation_rad" in problem


@pytest.mark.parametrize(("changes", "words"), [
    ({"still_s": 0.0}, "still_s = 0.0"), ({"still_s": 5.0, "target": {"pga_g": 0.4}}, "cannot be scaled"),
])  # fmt: skip
def test_still_ground_that_cannot_be_is_refused(tmp_path, changes, words):
    assert any(words in problem for problem in problems_of(tmp_path, motions=changes))


def test_python_refuses_what_a_study_does():
    pier = rb.Pier(alpha=0.2, p=2.0)
    with pytest.raises(InputError, match="must be below alpha"):
        rb.simulate(pier, rb.RigidBase(), rb.Motion.still(1.0), initial_rotation_rad=-0.2)
    with pytest.raises(InputError, match="duration_s = 0: must be a number above 0"):
        rb.Motion.still(0.0)
    with pytest.raises(InputError, match="more than 10,000,000 samples"):
        rb.Motion.still(1e6, 1e-3)
