"""interaction.csv, which a study asks for, and the check of a section's capacity that takes it."""

import numpy as np
import pandas as pd
import pytest
from studies import COSINE, PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.results.interaction import INTERACTION, read_interaction

pytestmark = pytest.mark.usefixtures("no_report")

PIER = {"width_m": 3.0, "height_m": 14.0, "mass_t": 400.0, "deck_mass_t": 200.0}
PULSES = [SINE | {"duration_s": 2.0}, COSINE | {"duration_s": 2.0}]
CURVE = [[-1000.0, 0.0], [0.0, 6e3], [9e3, 16e3], [20e3, 0.0]]
FOOT = {
    "name": "foot", "demand": "section_moment_over_capacity", "at_m": 0.0, "capacity": CURVE, "at_most": 1.0,
    "reason": "drawing 7",
}  # fmt: skip


def study_of(folder, *, pier=PIER, cases=(PADS,), **tables):
    return write_study(folder, study_text(pier=pier, pulses=PULSES, cases=cases, **tables))


def polygon_share(n, m):
    """Return the share of the capacity at one moment by where a line of constant N leaves the closed polygon of the curve."""
    corners = [*map(tuple, CURVE), *((axial, -most) for axial, most in reversed(CURVE[1:-1]))]
    most = 0.0
    for (n1, m1), (n2, m2) in zip(corners, [*corners[1:], corners[0]], strict=True):
        if min(n1, n2) <= n <= max(n1, n2):
            most = max(most, m1 + (m2 - m1) * (n - n1) / (n2 - n1))
    return abs(m) / most if most > 0.0 else np.inf


def test_the_share_of_the_foot_is_that_of_the_stored_histories_by_another_polygon(tmp_path):
    """Moment and axial force of each sample of histories.h5; between samples the run may use a little more."""
    output = {"interaction_m": [0.0, 7.0], "sections_m": [0.0, 7.0], "forces": True, "histories": "all"}
    path = study_of(tmp_path, cases=[RIGID, PADS], output=output, check=[FOOT])
    rb.run(path, out=tmp_path / "out")
    results = rb.open_results(tmp_path / "out")
    checks = rb.check(results).set_index("case")
    shares = []
    for response in results.responses:
        if response.case == "pads":
            theta = np.interp(response.forces["t"], response.history["t"], response.history["theta"])
            shear, normal = (response.forces[name].to_numpy() * 600.0 for name in ("base_shear", "normal_force"))
            moment = response.forces["base_moment"].to_numpy() * 600.0
            shares.append(max(map(polygon_share, normal + shear * np.abs(theta), moment)))
            shares[-1] = max(shares[-1], max(map(polygon_share, normal - shear * np.abs(theta), moment)))
    found = checks.loc["pads"]
    assert found["value"] == pytest.approx(max(shares), rel=0.02)
    assert found["high"] > found["value"] > found["low"]
    assert checks.loc["rigid", "verdict"] == "not decided"  # a landing on rigid ground is no force
    table, sections = read_interaction(tmp_path / "out" / INTERACTION, []), results.sections
    keys = ["record", "case", "height_m"]
    for key, rows in table.groupby(keys, sort=False):
        own = sections[(sections[keys] == pd.Series(key, keys)).all(axis=1)].iloc[0]
        assert rows["axial_kN"].is_monotonic_increasing
        assert rows["axial_kN"].iloc[[0, -1]].tolist() == pytest.approx(
            [own["section_axial_least_kN"], own["section_axial_greatest_kN"]], rel=1e-8
        )
        assert rows["moment_kNm"].max() == pytest.approx(own["section_moment_kNm"], rel=1e-8)
    assert len(table.groupby(keys)) == 8


@pytest.mark.parametrize(
    ("pier", "output", "check", "said"),
    [
        (PIER, {}, FOOT, r"there are no forces in sections; write interaction_m = \[0.0\] under \[output\]"),
        (PIER, {"interaction_m": [7.0]}, FOOT, "there is no section at this height; there are 7"),
        (PIER, {"interaction_m": [70.0]}, FOOT, "interaction_m = 70: must be within 0 and the top of the pier"),
        ({"width_m": 3.0, "height_m": 14.0}, {"interaction_m": [0.0]}, FOOT, "its forces are in kN; write mass_t under"),
        (PIER, {"interaction_m": [0.0]}, FOOT | {"capacity": [[20e3, 0.0], [0.0, 6e3]]}, "does not go by ascending N"),
        (PIER, {"interaction_m": [0.0]}, FOOT | {"capacity": [[0.0, 6e3], [5.0]]}, r"capacity = \[5\.0\]: expected points"),
        (PIER, {"interaction_m": [0.0]}, FOOT | {"capacity": [[-9.0, 0.0], [-1.0, 6.0]]}, "that of the dead load is 5886 kN"),
    ],
)  # fmt: skip
def test_a_capacity_that_cannot_be_used_is_refused_with_its_line_and_a_remedy(tmp_path, pier, output, check, said):
    path = study_of(tmp_path, pier=pier, output=output, check=[check])
    with pytest.raises(rb.InputError, match=rf"study\.toml:\d+: .*{said}"):
        rb.load_study(path)
