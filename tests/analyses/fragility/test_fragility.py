"""From records at rising intensities to fragility curves: files, messages and the report."""

import contextlib
import io
import json
import math
import shutil
from dataclasses import replace

import numpy as np
import pytest
from fragility_samples import IDA, STRIPES, journal_of, read, written
from report_page import Page

from rockbatch.analyses.fragility.bounds import NoCurve
from rockbatch.analyses.fragility.curves import Curve, Member, Undecided, assess
from rockbatch.analyses.fragility.ida import Bracket, Capacity
from rockbatch.analyses.fragility.lognormal import Lognormal
from rockbatch.analyses.fragility.runs import LevelPlan
from rockbatch.analyses.fragility.section import rates, section
from rockbatch.analyses.fragility.study import OVERTURNING, FragilitySpec, read_fragility
from rockbatch.analyses.fragility.tables import capacities, note
from rockbatch.analyses.fragility.windows import Windows
from rockbatch.batch.threads import Threads
from rockbatch.batch.waves import Waves
from rockbatch.commands.cli import main
from rockbatch.common.errors import EditedTable
from rockbatch.motions.intensity.measures import pga
from rockbatch.pier import ElasticBase, Pier, RigidBase
from rockbatch.reporting import finished_analysis
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.study import Case, load_study

pytestmark = pytest.mark.usefixtures("pages")


@pytest.fixture(scope="module")
def ida(tmp_path_factory):
    """The folder that the command leaves after an incremental dynamic analysis, and what it prints."""
    folder, printed = tmp_path_factory.mktemp("ida"), io.StringIO()
    with contextlib.redirect_stdout(printed):
        assert main(["fragility", str(written(folder, IDA)), "--out", str(folder / "out"), "--jobs", "2"]) == 0
    return folder / "out", printed.getvalue()


# The whole


def test_the_command_writes_points_curves_capacities_and_all_runs(ida):
    out, printed = ida
    points, capacities_, runs = (read(out / f"fragility{name}.csv") for name in ("", "_capacities", "_runs"))
    told = json.loads((out / "fragility.json").read_text(encoding="utf-8"))
    names = "case columns limit_state words reason counting median dispersion note undecided says_little median_undecided points"
    of_file = {*names.split(), "capacities", "looked"}  # earlier folders have these names
    assert all(of_file <= curve.keys() for curve in told["curves"])
    limits = ["overturning", "half way", "settlement"]
    assert list(dict.fromkeys(point["limit_state"] for point in points)) == limits
    assert len(points) == 4 * (2 + 2 + 1)  # a rigid base does not settle, and eta is about no record
    assert {(one["limit_state"], one["case"]) for one in told["curves"]} == {
        (limit, case) for limit in limits for case in ("rigid", "pads") if (limit, case) != ("settlement", "rigid")
    }
    assert len(capacities_) == 5 * 5
    for one in capacities_:
        if one["found"] == "exceeded":
            assert float(one["above"]) < float(one["at_most"]) <= 1.02 * float(one["above"]) * (1 + 1e-9)
            assert float(one["scale_at_most"]) == pytest.approx(float(one["at_most"]) / 0.4, rel=0.05)
    overturned = {(run["record"], run["case"]) for run in runs if run["status"] == "overturned"}
    found = {
        (one["record"], one["case"]) for one in capacities_ if one["limit_state"] == "overturning" and one["at_most"]
    }
    assert overturned == found
    assert "Fragility for PGA, incremental dynamic analysis" in printed
    assert "half way: theta_max_over_alpha > 0.5" in printed
    assert not (out / "fragility_runs.csv.part").exists()


def test_capacities_have_all_their_bounds_also_as_scales():
    case, spec = Case("rigid", Pier(0.2, 1.0), RigidBase(), {}), FragilitySpec("ida", "PGA", (0.2, 0.8), ())
    found = (
        ((0, 0), Capacity(Bracket(0.2, 0.4), Bracket(0.25, 0.3), Bracket(0.35, 0.5), 2, 1, 0.05)),
        ((0, 1), Capacity(*3 * (Bracket(0.8, math.inf),), 0, 0, 0.1)),
        ((0, 2), Capacity(*3 * (Bracket(0.0, 0.2),), 0, 0, 0.0)),
        ((0, 1), Capacity(*3 * (Bracket(0.3, 0.31),), 0, 3, 0.2)),
        ((0, 1), Capacity(Bracket(0.8, math.inf), Bracket(0.2, 0.3), Bracket(0.8, math.inf), 1, 0, 0.1)),
    )
    curve = Curve(case, OVERTURNING, (), "none", Undecided(0, 0, 0, 0), capacities=found)
    plan = LevelPlan([0.1, 0.2, 0.4], [1.0] * 3, [{}] * 3, [{}] * 3)
    rows = capacities([curve], spec, (), ["a", "b", "c"], [plan], [case])
    assert rows.columns[:6].to_list() == ["record", "case", "limit_state", "measure", "unit", "found"]
    assert rows["record"].to_list() == ["a", "b", "c", "b", "b"]
    assert rows["found"].to_list() == [
        "undecided", "beyond the highest level", "below the lowest level", "exceeded", "undecided",
    ]  # fmt: skip
    names = (
        "above", "at_most", "scale_above", "scale_at_most", "undecided", "if_exceeded", "if_withstood", "returns", "widest_step",
    )  # fmt: skip
    np.testing.assert_allclose(rows[list(names)].to_numpy(float), [
        [0.2, 0.4, 2.0, 4.0, 2, 0.3, 0.35, 1, 0.05],
        [0.8, np.nan, 4.0, np.nan, 0, np.nan, np.nan, 0, 0.1],
        [0.0, 0.2, 0.0, 0.5, 0, np.nan, np.nan, 0, 0.0],
        [0.3, 0.31, 1.5, 1.55, 0, np.nan, np.nan, 3, 0.2],
        [0.8, np.nan, 4.0, np.nan, 1, 0.3, 0.8, 0, 0.1],
    ])  # fmt: skip


def test_notes_say_why_there_is_no_curve_and_what_one_rests_on():
    case, spec = Case("rigid", Pier(0.2, 1.0), RigidBase(), {}), FragilitySpec("ida", "PGA", (0.2, 0.8), ())
    fitted = Lognormal(0.5, 0.4, (0.4, 0.6), (0.3, 0.5), np.zeros((1, 2)))

    def said(fitted, undecided=(0, 0, 0, 0), **more):
        return note(Curve(case, OVERTURNING, (), fitted, Undecided(*undecided), **more), spec)

    assert (said(NoCurve("no record counts")), said(fitted)) == ("no record counts", "")
    for median, beyond in (
        (0.19, True),
        (0.2 - 1e-16, False),
        (0.2, False),
        (0.8, False),
        (0.8 + 2e-16, False),
        (0.81, True),
    ):
        words = "the median is extrapolated beyond the intensities that were run"
        assert said(replace(fitted, median=median)) == beyond * words
    few = replace(fitted, median_interval=None, dispersion_interval=None, stations=4)
    assert said(few) == "no intervals: records of 4 stations, and 5 are needed to estimate their scatter"
    for name in ("median_interval", "dispersion_interval"):
        assert said(replace(fitted, **{name: (0.3, math.inf)})).startswith("the records leave the intervals open")
    assert (
        said(fitted, windows=Windows(0.02, (0.0,), (1,), (0,), NoCurve("none exceeds")))
        == "no median by shares: none exceeds"
    )
    returning = tuple(
        (Member(0, m), Capacity(*3 * (Bracket(0.3, 0.31),), 0, returns, 0.1)) for m, returns in enumerate((0, 2, 1))
    )
    assert said(fitted, capacities=returning) == "2 of 3 records withstand a level above their first exceedance"
    assert said(fitted, (10, 1, 2, 0)).startswith(
        "3 of 10 runs undecided: 1 flew, 2 failed, above the first exceedance of"
    )


def test_stripes_count_a_record_once_in_whatever_polarities(tmp_path):
    study = load_study(written(tmp_path, STRIPES))
    spec = read_fragility(study)
    motions, journal = journal_of(study, spec, tmp_path)
    with journal:
        curves = assess(study, spec, motions, Waves(study, journal, Threads(2)))
        rows = [row for _, row in journal.rows()]
    over = next(curve for curve in curves if curve.case.name == "rigid" and curve.limit.name == "overturning")
    unscaled = {motion.name: pga(motion.horizontal) / 9.81 for motion in motions}
    for stripe in over.stripes:
        names = {
            row["record"]
            for row in rows
            if row["case"] == "rigid" and row["status"] == "overturned"
            and float(row["scale"]) * unscaled[row["record"]] == pytest.approx(stripe.level)
        }  # fmt: skip
        assert (stripe.records, stripe.exceeded, stripe.collapsed) == (5, len(names), len(names))
    assert 0 < sum(stripe.exceeded for stripe in over.stripes) < 20
    assert over.capacities == ()


# The report


@pytest.fixture(scope="module")
def stripes(tmp_path_factory):
    """The folder that the command leaves after stripes."""
    folder = tmp_path_factory.mktemp("stripes")
    assert main(["fragility", str(written(folder, STRIPES)), "--out", str(folder / "out"), "--jobs", "2"]) == 0
    return folder / "out"


def test_the_report_has_a_panel_for_each_limit_and_every_curve_in_its_table(ida):
    out, _ = ida
    page = Page((out / "analyses.html").read_text(encoding="utf-8"))
    told = json.loads((out / "fragility.json").read_text(encoding="utf-8"))
    assert page.mismatched == []
    assert page.headings == ["Fragility", "The study file"]
    assert len(told["curves"]) == 5
    rows = page.tables["fragility"]
    medians, capacities, factors = rows[1:6], rows[7:32], rows[32:]
    of_csv = read(out / "fragility_capacities.csv")
    assert [cells[0] for cells in capacities] == [row["record"] for row in of_csv]
    assert [float(cells[-1]) for cells in capacities] == pytest.approx(
        [100 * float(row["widest_step"]) for row in of_csv], rel=0.05
    )
    assert [cells[0] for cells in factors[2:]] == told["scales"]["records"]
    assert [cells[0] for cells in medians] == [curve["limit_state"] for curve in told["curves"]]


def test_where_first_exceedances_were_looked_for_is_said_once_and_drawn(ida):
    """On rigid ground in steps of 0.25 % up to the greatest capacity, a single dash; on pads at the four levels, a dash each."""
    out, printed = ida
    page = Page((out / "analyses.html").read_text(encoding="utf-8"))
    told = json.loads((out / "fragility.json").read_text(encoding="utf-8"))
    words = "in steps of 0.25 % from the lowest level up (rigid)", "at the levels alone, up to 100 % apart (pads)"
    assert "Strips above: intensities that were searched." in page.text
    for text in (page.text, printed):
        assert [text.count(each) for each in words] == [1, 1]
    by_case = {one["case"]: one["looked"] for one in told["curves"] if one["limit_state"] == "overturning"}
    assert by_case["pads"] == [[x, x] for x in (0.2, 0.4, 0.6, 0.8)]
    ((low, high),) = by_case["rigid"]
    capacities = [row for row in read(out / "fragility_capacities.csv") if row["limit_state"] == "overturning"]
    bounds = [float(row["at_most"] or "inf") for row in capacities if row["case"] == "rigid"]
    assert (low, high) == (0.2, pytest.approx(min(max(bounds), 0.8)))
    steps = {case: [float(row["widest_step"]) for row in capacities if row["case"] == case] for case in by_case}
    assert max(steps["rigid"]) <= 0.0025 + 1e-9
    assert max(steps["pads"]) >= 0.3


def test_hunt_step_looks_between_the_levels_on_every_base(tmp_path):
    spec = read_fragility(load_study(written(tmp_path, f"{IDA}\nhunt_step = 0.05")))
    assert [spec.step_on(base) for base in (RigidBase(), ElasticBase(30.0))] == [0.05, 0.05]
    spec = read_fragility(load_study(written(tmp_path, IDA)))
    assert [spec.step_on(base) for base in (RigidBase(), ElasticBase(30.0))] == [0.0025, None]


def test_a_file_of_an_earlier_version_says_what_to_run_and_the_rest_is_there(tmp_path, stripes):
    """Its bounds of medians had no confidence, which ended the whole report as damaged."""
    out = shutil.copytree(stripes, tmp_path / "out")
    info = json.loads((out / "fragility.json").read_text(encoding="utf-8"))
    info["curves"][0]["median_bound"] = {"is": "above", "above": 0.3, "below": None}
    info["hazard"] = {"source": ""}
    info["sha256"] = finished_analysis.digest_of(info)
    (out / "fragility.json").write_text(json.dumps(info), encoding="utf-8")
    contents = Contents(out, info["study"])
    assert "Of an earlier version; run `rockbatch fragility` again." in section(contents)
    assert rates(contents) == ""


def test_an_edited_or_damaged_analysis_is_reported(tmp_path, stripes):
    """Medians stand in fragility.json only: a digit that flipped would be a wrong curve."""
    out = shutil.copytree(stripes, tmp_path / "out")
    path, points_csv = out / "fragility.json", out / "fragility.csv"
    whole = path.read_text(encoding="utf-8")
    study = json.loads(whole)["study"]
    first = next(one for one in json.loads(whole)["curves"] if one["median"] is not None)
    other = whole.replace(f'"median": {first["median"]}', f'"median": {2 * first["median"]}', 1)
    assert other != whole
    of_another = whole.replace('"sha256": "', '"sha256": "0')
    for text, shown in ((other, True), (of_another, False), (whole[:-100], False), ("\xf4" + whole, False)):
        path.write_text(text, encoding="latin-1")
        with pytest.warns(EditedTable, match=r"fragility\.json: edited or damaged since it was written"):
            assert (section(Contents(out, study)) != "") == shown
    path.write_text(whole, encoding="utf-8")
    assert section(Contents(out, study)) != ""
    points_csv.write_text(points_csv.read_text(encoding="utf-8").replace("0", "1", 1), encoding="utf-8")
    found = finished_analysis.read(out, "fragility", study["sha256"])
    with pytest.warns(EditedTable, match=r"fragility\.csv: edited or damaged since it was written"):
        assert found.table("fragility.csv", ()) is not None
