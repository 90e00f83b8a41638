"""interaction.csv, which a study asks for, and the check of a section's capacity that takes it."""

import numpy as np
import pandas as pd
import pytest
from check_samples import case, runs
from studies import COSINE, PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.checks.judging import judge
from rockbatch.checks.rules import Rule
from rockbatch.quantities.demands import INTERACTION, OF_INTERACTION
from rockbatch.results.sections import read_forces

PIER = {"width_m": 3.0, "height_m": 14.0, "mass_t": 400.0, "deck_mass_t": 200.0}
PULSES = [SINE | {"duration_s": 2.0}, COSINE | {"duration_s": 2.0}]
CURVE = [[-1000.0, 0.0], [0.0, 6e3], [9e3, 16e3], [20e3, 0.0]]
FOOT = {
    "name": "foot", "demand": "section_moment_over_capacity", "at_m": 0.0, "capacity": CURVE, "at_most": 1.0,
    "reason": "drawing 7",
}  # fmt: skip


def study_of(folder, *, pier=PIER, cases=(PADS,), **tables):
    return write_study(folder, study_text(pier=pier, pulses=PULSES, cases=cases, **tables))


JOINT = {
    "name": "joint", "demand": "base_shear_over_capacity", "capacity": {"constant": 400.0, "per_N": 0.5}, "at_most": 1.0,
    "reason": "friction and a key",
}  # fmt: skip


def polygon_share(n, m):
    """Return the share of the capacity at one moment by where a line of constant N leaves the closed polygon of the curve."""
    corners = [*map(tuple, CURVE), *((axial, -most) for axial, most in reversed(CURVE[1:-1]))]
    most = 0.0
    for (n1, m1), (n2, m2) in zip(corners, [*corners[1:], corners[0]], strict=True):
        if min(n1, n2) <= n <= max(n1, n2):
            most = max(most, m1 + (m2 - m1) * (n - n1) / (n2 - n1))
    return abs(m) / most if most > 0.0 else np.inf


@pytest.mark.usefixtures("pages")
def test_the_share_of_the_foot_is_that_of_the_stored_histories_by_another_polygon(tmp_path):
    """Moment and axial force of each sample of histories.h5; between samples the run may use a little more."""
    output = {"interaction_m": [0.0, 7.0], "sections_m": [0.0, 7.0], "forces": True, "histories": "all"}
    path = study_of(tmp_path, cases=[RIGID, PADS | {"zeta": 0.05}], output=output, check=[FOOT, JOINT])
    rb.run(path, out=tmp_path / "out")
    results = rb.open_results(tmp_path / "out")
    checks = rb.check(results)
    joint = checks[checks["check"] == "joint"].set_index("case")
    checks = checks[checks["check"] == "foot"].set_index("case")
    shares, of_joint = [], []
    for response in results.responses:
        if response.case == "pads":
            theta = np.interp(response.forces["t"], response.history["t"], response.history["theta"])
            shear, normal = (response.forces[name].to_numpy() * 600.0 for name in ("base_shear", "normal_force"))
            moment = response.forces["base_moment"].to_numpy() * 600.0
            shares.append(max(map(polygon_share, normal + shear * np.abs(theta), moment)))
            shares[-1] = max(shares[-1], max(map(polygon_share, normal - shear * np.abs(theta), moment)))
            of_joint.append((np.abs(shear) / (400.0 + 0.5 * normal)).max())
    found = checks.loc["pads"]
    assert found["value"] == pytest.approx(max(shares), rel=0.02)
    assert found["high"] > found["value"] > found["low"]
    assert joint.loc["pads", "value"] == pytest.approx(max(of_joint), rel=0.02)
    assert max(of_joint) <= joint.loc["pads", "high"]
    assert checks.loc["rigid", "verdict"] == "not decided"  # a landing on rigid ground is no force
    table, sections = read_forces(tmp_path / "out" / INTERACTION, [], OF_INTERACTION), results.sections
    keys = ["record", "case", "height_m"]
    base = table[table["height_m"].isna()].groupby(["record", "case"])
    assert results.peaks.set_index(["record", "case"])["normal_force_kN"].to_dict() == pytest.approx(
        base["axial_kN"].max().to_dict(), rel=2e-3
    )
    assert results.peaks.set_index(["record", "case"])["base_shear_kN"].to_dict() == pytest.approx(
        base["shear_kN"].max().to_dict(), rel=2e-3
    )
    for key, rows in table.groupby(keys, sort=False):
        own = sections[(sections[keys] == pd.Series(key, keys)).all(axis=1)].iloc[0]
        assert rows["axial_kN"].is_monotonic_increasing
        assert rows["axial_kN"].iloc[[0, -1]].tolist() == pytest.approx(
            [own["section_axial_least_kN"], own["section_axial_greatest_kN"]], rel=1e-8
        )
        assert rows["moment_kNm"].max() == pytest.approx(own["section_moment_kNm"], rel=1e-8)
    assert len(table.groupby(keys)) == 8
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    for words in ("section at 0 m", "foot</", "joint</", "V [kN]", "M [kN m]"):
        assert words in page[page.index('id="capacities"') :], words


def test_a_check_of_the_base_brings_its_forces_and_needs_them_in_results(tmp_path):
    study = rb.load_study(study_of(tmp_path, check=[JOINT]))
    assert study.output.has("interaction_base")
    assert study.checks[0].capacity == ((-800.0, 0.0), (1e9, 400.0 + 0.5e9))
    rb.run(study.with_(check=[]), out=tmp_path / "without", progress=False)
    rules = tmp_path / "rules.toml"
    rules.write_text(
        '[[check]]\nname="j"\ndemand="base_shear_over_capacity"\ncapacity=900.0\nat_most=1.0\nreason="r"\n'
    )
    with pytest.raises(rb.InputError, match="write interaction_base = true under"):
        rb.check(tmp_path / "without", rules)


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
        (PIER, {}, JOINT | {"capacity": [[-9.0, 0.0], [99.0, 6.0]]}, "that of the dead load is 5886 kN"),
        (PIER, {}, JOINT | {"capacity": {"constant": 4.0, "per_n": 1.0}}, "expected a line { constant = 500.0, per_N = 0.6 }"),
        (PIER, {}, JOINT | {"capacity": {"per_N": -1.0}}, "expected 0 or a number above it"),
        (PIER, {}, JOINT | {"capacity": [1e3, 2e3]}, r"capacity = \(1000\.0, 2000\.0\)"),
        (
            PIER,
            {"forces": True},
            {"name": "k", "demand": "normal_force_kN", "capacity": 4e7, "at_most": 0.9, "reason": "r"},
            r"capacity = 4e\+07: normal_force_kN is a force, and the pier's weight",
        ),
        (
            {"width_m": 3.0, "height_m": 14.0},
            {"interaction_base": True},
            JOINT,
            "interaction_base: its forces are in kN; write mass_t under",
        ),
    ],
)  # fmt: skip
def test_a_capacity_that_cannot_be_used_is_refused_with_its_line_and_a_remedy(tmp_path, pier, output, check, said):
    path = study_of(tmp_path, pier=pier, output=output, check=[check])
    with pytest.raises(rb.InputError, match=rf"study\.toml:\d+: .*{said}"):
        rb.load_study(path)


def test_a_check_of_the_base_of_a_pier_without_a_mass_is_refused(tmp_path):
    with pytest.raises(rb.InputError, match="interaction_base: its forces are in kN; write mass_t under"):
        rb.load_study(study_of(tmp_path, pier={"width_m": 3.0, "height_m": 14.0}, check=[JOINT]))


def test_an_older_table_is_refused_with_a_remedy_that_works(tmp_path):
    """Delete a column that earlier versions did not write: to run the study again, as the message says, writes it."""
    path = study_of(tmp_path, output={"interaction_m": [0.0]}, check=[FOOT])
    rb.run(path, out=tmp_path / "out")
    table = tmp_path / "out" / INTERACTION
    written = table.read_bytes()
    pd.read_csv(table).drop(columns="shear_kN").to_csv(table, index=False)
    with pytest.raises(rb.InputError, match=r"shear_kN is missing: .*an earlier version; start `rockbatch run` again"):
        rb.check(tmp_path / "out")
    rb.run(path, out=tmp_path / "out")
    assert table.read_bytes() == written


def test_a_table_without_rows_is_read_and_decides_nothing_where_all_runs_failed(tmp_path):
    """Where a run went through there have to be rows: its checks are refused, not passed over."""
    rows = tmp_path / INTERACTION
    rows.write_text("record,case,polarity,scale\n")
    empty = read_forces(rows, ["beta"], OF_INTERACTION)
    assert (len(empty), [*empty][4:6], empty["height_m"].dtype) == (0, ["beta", "height_m"], float)
    rules = [
        Rule(**{**FOOT, "capacity": tuple(map(tuple, CURVE))}),
        Rule(**{**JOINT, "capacity": ((0.0, 4e2), (1e4, 5e3))}),
    ]
    ran = runs([0.1]).assign(beta=40.0)
    failed = ran.assign(status="failed", theta_max_over_alpha=np.nan, theta_max_error=np.nan)
    judged = judge(rules, failed, [case()], interaction=empty)
    assert [verdict.verdict for verdict in judged] == ["not decided", "not decided"]
    mixed = runs([0.1, 0.2], status=["ok", "failed"])
    for table in (ran, mixed):
        with pytest.raises(
            rb.InputError, match=r"(?s)there are no forces in sections.*there is no column of interaction_base"
        ):
            judge(rules, table, [case()], interaction=empty)


def test_a_mistake_in_an_output_that_a_check_brings_has_the_line_of_the_check(tmp_path):
    path = study_of(tmp_path, pier={"width_m": 3.0, "height_m": 14.0}, check=[JOINT])
    line = 1 + path.read_text(encoding="utf-8").splitlines().index("[[check]]")
    message = rf"study.toml:{line}: \[output\]: interaction_base: its forces are in kN; write mass_t"
    with pytest.raises(rb.InputError, match=message):
        rb.load_study(path)
    (tmp_path / "more.toml").write_text(
        path.read_text(encoding="utf-8")[path.read_text(encoding="utf-8").index("[[check]]") :]
    )
    other = study_of(tmp_path, pier={"width_m": 3.0, "height_m": 14.0}, suite={"checks": "more.toml"})
    line = 1 + other.read_text(encoding="utf-8").splitlines().index('checks = "more.toml"')
    with pytest.raises(rb.InputError, match=message.replace(message[11 : message.index(": ")], str(line))):
        rb.load_study(other)
