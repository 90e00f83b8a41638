"""sections.csv, which a study asks for: what Response.sections has of each run, and what checks and errors make of it."""

from pathlib import Path

import pandas as pd
import pytest
from studies import COSINE, PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.pier.sections import above, section_heights
from rockbatch.quantities.demands import OF_SECTIONS, SECTIONS

PIER = {"width_m": 3.0, "height_m": 14.0, "mass_t": 400.0, "deck_mass_t": 200.0}
CHECKS = [
    {"name": "moment", "demand": "section_moment_kNm", "at_m": 7.0, "at_most": 1e5, "reason": "drawing 7"},
    {"name": "shear", "demand": "section_shear_kN", "at_m": 0.0, "at_most": 1.0, "reason": "drawing 7"},
]
PULSES = [SINE | {"duration_s": 2.0}, COSINE | {"duration_s": 2.0}]


def study_of(folder, *, pier=PIER, cases=(RIGID,), **tables):
    return write_study(folder, study_text(pier=pier, pulses=PULSES, cases=cases, **tables))


@pytest.mark.slow
def test_a_study_that_asks_has_the_sections_of_every_run_and_checks_of_them(tmp_path):
    text = {"output": {"sections": 3}, "check": CHECKS, "motions": {"polarity": ["+", "-"]}}
    pads = PADS | {"zeta": 0.05}  # by epsilon a part of each landing has no force
    path, out = study_of(tmp_path, cases=[RIGID, pads], **text), tmp_path / "out"
    main(["run", str(path), "--out", str(out), "--jobs", "2"])
    results, study = rb.open_results(out), rb.load_study(path)
    table = results.sections
    assert list(table)[-len(OF_SECTIONS) :] == list(OF_SECTIONS)
    runs = table.groupby(["record", "case"], sort=False)
    assert (len(runs), len(table), set(table["polarity"])) == (4, 12, {"+"})  # none of mirror images
    assert table["height_m"].tolist() == 4 * [0.0, 7.0, 14.0]
    for (record, name), rows in runs:
        pulse = next(pulse for pulse in study.motions.pulses if pulse.name == record)
        case = next(case for case in study.cases if case.name == name)
        response = rb.simulate(case.pier, case.base, pulse.motion(9.81), sections=3)
        expected = response.sections
        pd.testing.assert_frame_equal(rows[list(OF_SECTIONS)].reset_index(drop=True), expected, rtol=1e-9, atol=1e-9)

    assert [response.pier for response in results.responses] == [case.pier for case in study.cases]  # with its parts
    checks = rb.check(results)
    assert checks["verdict"].tolist() == [
        "not decided",
        "fail",
        "pass",
        "fail",
    ]  # landings on rigid ground have no force
    worst = table[(table["case"] == "pads") & (table["height_m"] == 7.0)]["section_moment_kNm"].max()
    assert checks[(checks["case"] == "pads") & (checks["check"] == "moment")]["value"].item() == pytest.approx(worst)
    written = (out / SECTIONS).read_bytes()
    main(["run", str(path), "--out", str(out)])  # nothing is left to run
    assert (out / SECTIONS).read_bytes() == written

    study_of(tmp_path, cases=[RIGID, PADS], motions=text["motions"])
    main(["run", str(path), "--out", str(out)])
    assert not (out / SECTIONS).exists()
    with pytest.raises(rb.InputError, match=r"sections.csv: not there; add \[output\] sections = 5"):
        _ = rb.open_results(out).sections


def test_a_fixed_step_has_no_error_and_no_mass_no_forces_in_kilonewtons():
    block = rb.Pier.rectangle(width_m=3.0, height_m=14.0)
    motion = rb.pulse("sine", name="sine", amplitude=4.0, period=0.5, dt=0.01, duration=1.0)
    table = rb.simulate(block, rb.RigidBase(), motion, sections=[7.0], substeps=8).sections
    assert table.loc[0, "section_moment_m2_s2"] > 0.0
    assert table[[name for name in OF_SECTIONS if name.endswith(("kN", "kNm", "error"))]].isna().all(axis=None)
    assert rb.simulate(block, rb.RigidBase(), motion).sections is None


FRAME = {"width_m": 2.0, "height_m": 10.0, "mass_t": 100.0, "columns": 4, "deck_mass_t": 500.0}
IN_PARTS = {"width_m": 4.0, "part": [{"mass_t": 500.0, "height_m": 7.0, "inertia_t_m2": 9000.0}]}


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"output": {"sections_m": [0.0, 15.0]}}, "sections_m = 15: must be within 0 and the top of the pier, 14 m"),
        ({"output": {"sections": 3, "sections_m": [0.0]}}, "sections and sections_m are given, which say the same; keep one"),
        ({"output": {"sections": 1}}, "2 or above: foot and top of the pier are among them"),
        ({"output": {"sections": 3}, "pier": FRAME}, "how the deck of a frame presses on each of its columns is not known"),
        ({"output": {"sections": 3}, "pier": IN_PARTS}, "part 1, at 7 m, has no length_m, over which its mass is spread"),
        ({"output": {"sections": 3}, "pier": {"alpha": 0.2, "p": 1.0, "mu": 4.0}}, "mu = 4 does not say how the mass"),
        ({"check": CHECKS[:1]}, "there are no forces in sections; write sections = 5 under"),
        ({"output": {"sections": 4}, "check": CHECKS[:1]}, "at_m = 7: there is no section at this height; there are 0, 4.66667"),
    ],
)  # fmt: skip
def test_a_study_with_sections_that_cannot_be_is_refused(tmp_path, tables, message):
    with pytest.raises(rb.InputError) as refused:
        rb.load_study(study := study_of(tmp_path, **tables))
    assert message in str(refused.value)
    if "sections_m = 15" in message:
        key = next(
            i for i, line in enumerate(study.read_text("utf-8").splitlines(), 1) if line.startswith("sections_m")
        )
        assert f"{study.name}:{key}: [output]" in str(refused.value)


def test_a_rectangle_on_a_wider_foot_has_the_sections_of_the_rectangle(tmp_path):
    """Its mass is spread as without the foot, which has none; α and μ are those of the foot, h and I0 its own."""
    foot = {"name": "foot", "base": "footing", "width_m": 6.0, "length_m": 6.0, "stiffness_MN_m3": 60.0}
    plain = {name: value for name, value in PIER.items() if name != "deck_mass_t"}
    study = rb.load_study(study_of(tmp_path, pier=plain, cases=[RIGID, foot], output={"sections": 3}, check=CHECKS[:1]))
    own, wide = (case.pier for case in study.cases)
    assert (wide.half_width, wide.height) == pytest.approx((3.0, own.height))
    assert wide.mu == pytest.approx((3.0**2 + 7.0**2) / own.inertia)
    assert section_heights(wide, 3) == section_heights(own, 3) == (0.0, 7.0, 14.0)
    for height in (0.0, 5.0, 14.0):
        assert above(wide, height) == pytest.approx(above(own, height), rel=1e-12)
    assert (wide.shaft_share, wide.highest) == pytest.approx((1.0, 14.0))


@pytest.mark.parametrize("of_case", [False, True])
def test_sections_that_no_pier_can_have_are_refused_without_advice_to_ask_for_them(tmp_path, of_case):
    """Of the pier, or of a pier on the foot of a case, whose α and μ are those of the foot."""
    foot = {"base": "footing", "width_m": 6.0, "length_m": 6.0, "stiffness_MN_m3": 60.0}
    shaped = {"alpha": 0.2, "p": 1.0, "mu": 4.0, "mass_t": 400.0}
    tables = {"cases": [foot], "pier": shaped} if of_case else {"pier": FRAME}
    with pytest.raises(rb.InputError) as refused:
        rb.load_study(study_of(tmp_path, output={"sections": 3}, check=CHECKS[:1], **tables))
    (problem,) = refused.value.problems
    assert "[output]: sections: " in str(problem)


def test_parts_with_their_lengths_have_sections(tmp_path):
    part = IN_PARTS["part"][0] | {"length_m": 14.0}
    pier = {"width_m": 4.0, "deck_mass_t": 200.0, "deck_height_m": 15.0, "part": [part]}
    case = rb.load_study(study_of(tmp_path, pier=pier, output={"sections_m": [14.0]})).cases[0]
    assert case.pier.parts == (rb.Part(500.0, 7.0, 9000.0, 14.0), rb.Part(200.0, 15.0, 0.0, 0.0))


def test_the_page_of_columns_lists_those_of_sections():
    """To put it right: write what is missing into docs/columns.md."""
    rows = [f"| {name} | {meaning} |\n" for name, meaning in OF_SECTIONS.items()]
    columns = (Path(rb.__file__).parents[1] / "docs/columns.md").read_text(encoding="utf-8")
    assert "| column | meaning |\n| --- | --- |\n" + "".join(rows) in columns
