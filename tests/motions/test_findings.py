"""What is odd about a record: it is told, and where it is gross, nothing is run until somebody confirms it."""

import csv
from dataclasses import replace
from functools import cache
from itertools import combinations

import numpy as np
import pytest
from fixed_column_files import A, B, C, cosmos_text, csmip_channel, smc_text
from motion_files import needs_records, real_components, wiggle, write_at2
from studies import FOLDER_STUDY, write_study

from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.motions import ReadOptions, fema_p695, read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.identity.doubles import without_doubles
from rockbatch.motions.identity.likeness import likeness_of
from rockbatch.motions.identity.pairing import to_motions
from rockbatch.motions.identity.stations import by_station
from rockbatch.motions.intensity import measures
from rockbatch.motions.labels.orientation import Orientation
from rockbatch.motions.manifest_draft import draft
from rockbatch.motions.motion import Finding, Motion
from rockbatch.motions.quality.plausible import (
    ALTERNATION,
    SELDOM_ABOVE,
    SELDOM_BELOW,
    UNEQUAL,
    alternating,
    flat_tops,
    unlikely_samples,
)
from rockbatch.results.run_json import describe
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

G = 9.81


def title(component: str, station: str = "STA") -> str:
    return f"Somewhere, 1/17/1994, {station}, {component}"


def ringing(npts: int = 300, at: int = 100, amplitude: float = 0.6) -> np.ndarray:
    """A record [g] with a stretch of samples to and fro that dies out, above its own peak."""
    a = wiggle(npts, 3, 0.4)
    a[at : at + 30] += amplitude * (-1.0) ** np.arange(30) * 0.95 ** np.arange(30)
    return a


def drifting(npts: int = 4000) -> np.ndarray:
    """A record [g] at 100 Hz whose baseline is off by 0.006 g: 47 m in 40 s."""
    return wiggle(npts, 4, 0.4) + 0.006


def whats(motion) -> list[str]:
    return [finding.what for finding in motion.findings]


def only_reason(found) -> str:
    (refused,) = found.unusable
    return refused.reason


# Gross: not used until confirmed


def grossly_odd(folder, kind: str) -> str:
    """A folder with one record that is grossly odd; its name."""
    if kind == "alternates":
        write_at2(folder, "x.AT2", ringing(), title="nothing, 000")
    elif kind == "PGD":
        write_at2(folder, "x.AT2", drifting(), title="nothing, 000")
    else:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "x.V2").write_text(cosmos_text(stage="Corrected", location="Building; roof"), encoding="latin-1")
    return "x"


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("alternates", "it alternates from sample to sample by 0.3"),
        ("PGD", "its displacement reaches 47"),
        ("structure", '"BUILDING; ROOF" is in a structure'),
    ],
)
def test_a_grossly_odd_record_is_used_only_when_it_is_confirmed(tmp_path, kind, words):
    name = grossly_odd(tmp_path, kind)
    reason = only_reason(read_motions(tmp_path))
    assert reason.startswith(words)
    assert f'write confirm = ["{name}"] under [motions] in the study, or confirm = true in motions.toml' in reason
    assert not read_motions(tmp_path, confirmed=["y*"], confirmed_pga=["*"]).motions  # which is for its PGA only
    (motion,) = read_motions(tmp_path, confirmed=["x"]).motions
    assert kind in whats(motion)
    assert any(note.startswith(f"confirmed: {words}") for note in motion.notes)
    (file,) = [path.name for path in tmp_path.iterdir()]
    for key, used in (("confirm_pga", 0), ("confirm", 1)):
        (tmp_path / "motions.toml").write_text(f'[[record]]\nfile = "{file}"\n{key} = true\n')
        assert len(read_motions(tmp_path).motions) == used


def test_confirm_in_a_study_confirms_the_pga_too_and_confirm_pga_nothing_else(tmp_path):
    write_at2(tmp_path / "records", "high.AT2", wiggle(50, scale=60), title="nothing, 000")
    write_at2(tmp_path / "records", "rings.AT2", ringing(), title="nothing, 000")
    for keys, used in (
        ("", []),
        ('confirm_pga = "*"\n', ["high"]),
        ('confirm = "high"\n', ["high"]),
        ('confirm = ["high", "ri*"]\n', ["high", "rings"]),
    ):
        study = load_study(write_study(tmp_path, FOLDER_STUDY + keys))
        if not used:
            with pytest.raises(InputError, match="no ground motion that can be used"):
                ground_motions(study)
        else:
            assert [motion.name for motion in ground_motions(study).motions] == used


def test_two_gross_findings_are_one_reason_and_one_key_confirms_both(tmp_path):
    write_at2(tmp_path, "x.AT2", 20 * ringing(), title="nothing, 000")
    reason = only_reason(read_motions(tmp_path))
    assert "outside 0.001–5 g: check the unit; it alternates" in reason
    assert 'write confirm = ["x"]' in reason


def test_a_vertical_that_alternates_is_found_with_its_horizontal(tmp_path):
    write_at2(tmp_path, "x000.AT2", wiggle(300), title=title("0"))
    write_at2(tmp_path, "xUP.AT2", ringing(), title=title("UP"))
    assert only_reason(read_motions(tmp_path)).startswith("vertical: it alternates")
    assert len(read_motions(tmp_path, vertical=False).motions) == 1


def test_a_displacement_beyond_all_ground_is_gross_in_corrected_records_only():
    for processed, gross in ((True, True), (None, False), (False, False)):
        component = Component("c", 0.01, drifting() * 9.81, Orientation("000", azimuth=0.0), processed=processed)
        found = to_motions([component], confirmed=())
        assert len(found.unusable) == gross
        if not gross:
            assert "PGD" in whats(found.motions[0])


@pytest.mark.parametrize("kind", ["alternates", "PGD", "structure"])
def test_the_drafted_manifest_has_the_line_that_confirms_it(tmp_path, kind):
    grossly_odd(tmp_path, kind)
    text = draft(tmp_path)
    (line,) = [line for line in text.splitlines() if line.startswith("# confirm = true   # ")]
    (tmp_path / "motions.toml").write_text(text.replace(line, line.removeprefix("# ")))
    assert len(read_motions(tmp_path).motions) == 1


def test_motions_of_no_file_are_asked_about_their_unit_until_confirmed():
    high = Motion("m", 0.01, np.array([0.0, 5.0 * G, -5.1 * G]))
    (asked,) = unlikely_samples(high, G)
    assert asked.startswith('motion "m": PGA 5.1 g')
    judged = replace(high, findings=(Finding("peak", "PGA 5.1 g", gross=True, key="confirm_pga"),))
    for known in (judged, replace(high, recorded=False), replace(high, confirm=("pga",)), high.times(1.0 / 1.02)):
        assert unlikely_samples(known, G) == []
    assert len(unlikely_samples(replace(high, findings=(Finding("PGD", "47 m"),), confirm=()), G)) == 1


# How they are found


def test_alternation_is_the_least_of_seven_swings_to_and_fro():
    t = np.arange(200)
    assert alternating(3.0 * (-1.0) ** t + 0.01 * t) == pytest.approx(3.0, abs=0.006)  # on a slope
    assert alternating(3.0 * np.cos(2 * np.pi * t / 4)) == 0.0  # half of the highest frequency there can be
    burst = np.zeros(200)
    burst[50:58] = 2.0 * (-1.0) ** np.arange(8)
    assert alternating(burst) == 2.0
    burst[50] = 0.0
    assert alternating(burst) == 1.0
    burst[51:53] = 0.0
    assert alternating(burst) == 0.0  # six swings are left, the first and the last of them from and to nothing
    assert alternating(np.array([1.0, -1.0] * 3)) == 0.0  # too few to tell


@pytest.mark.parametrize(
    "place",
    [
        "Roof", "Bldg; roof, NE corner", "3rd floor", "3rd Floor Center", "12th Flr: SE", "2nd-floor", "Floor 4", "Penthouse",
        "Deck Level near Abut 1", "Bridge deck: midspan", "Abutment 1", "Abut. 3: West", "Dam crest", "Bent 3 column top",
        "Top of Pier 2", "21st Floor", "Second floor",
    ],
)  # fmt: skip
def test_a_sensor_in_a_structure_is_recognised_by_its_place(tmp_path, place):
    (tmp_path / "x.V2").write_text(
        "\n".join([*csmip_channel("90 Deg", A, volume=2, place=place), ""]), encoding="latin-1"
    )
    assert "is in a structure" in only_reason(read_motions(tmp_path))


@pytest.mark.parametrize(
    "place",
    [
        "Freefield", "Free field, 100 m from the deck", "Ground floor", "1st Floor", "Basement", "Ground - N of pier 2", "",
        "DH array surface", "Borehole array; surface", "Dam toe", "Level 0",
    ],
)  # fmt: skip
def test_a_sensor_on_the_ground_is_left_in_peace(tmp_path, place):
    (tmp_path / "x.V2").write_text(
        "\n".join([*csmip_channel("90 Deg", A, volume=2, place=place), ""]), encoding="latin-1"
    )
    assert len(read_motions(tmp_path).motions) == 1


def test_the_station_of_an_smc_file_may_be_a_dam_s_crest(tmp_path):
    text = smc_text().replace("San José, 1295 Shafter, 42n", "Anderson Dam, Crest")
    (tmp_path / "x.smc").write_text(text, encoding="latin-1")
    assert '"ANDERSON DAM, CREST" is in a structure' in only_reason(read_motions(tmp_path))


def test_one_horizontal_many_times_the_other_is_a_finding_of_both(tmp_path):
    write_at2(tmp_path, "x000.AT2", wiggle(200, 1, 0.5), title=title("0"))
    write_at2(tmp_path, "x090.AT2", wiggle(200, 2, 0.05), title=title("90"))
    motions = read_motions(tmp_path).motions
    assert [whats(motion) for motion in motions] == [["unequal"], ["unequal"]]
    assert all("PGA of x000 is 10 times that of x090: check their gains" in motion.notes for motion in motions)
    write_at2(tmp_path, "x090.AT2", wiggle(200, 2, 0.5 / (0.98 * UNEQUAL)), title=title("90"))
    assert [whats(motion) for motion in read_motions(tmp_path).motions] == [[], []]


def test_an_unprocessed_record_has_a_finding(tmp_path, capsys):
    for name, text in (("a.V1", cosmos_text(A)), ("b.V2", cosmos_text(B, "360 Deg", stage="Corrected"))):
        (tmp_path / name).write_text(text, encoding="latin-1")
    write_at2(tmp_path, "c.AT2", wiggle(300, 2), title="nothing, 000")
    (tmp_path / "d.txt").write_text("# time(s) NS(gal)\n" + "".join(f"{i / 100} {a}\n" for i, a in enumerate(C)))
    motions = read_motions(tmp_path).motions
    assert [motion.processed for motion in motions] == [False, True, True, None]
    assert ["unprocessed" in whats(motion) for motion in motions] == [True, False, False, False]
    assert any(note.startswith("unprocessed: ") for note in motions[0].notes)
    (tmp_path / ".out").mkdir()
    assert main(["motions", "--all", str(tmp_path), "--csv", str(tmp_path / ".out" / "t.csv")]) == 0
    rows = list(csv.DictReader((tmp_path / ".out" / "t.csv").read_text().splitlines()))
    assert [row["processed"] for row in rows] == ["no", "yes", "yes", ""]
    assert rows[0]["check"] == "unprocessed"
    shown = capsys.readouterr().out.splitlines()
    assert "check" in shown[0].split()
    assert "unprocessed" in shown[1].split()


def test_where_the_displacement_runs_away_there_is_no_pgd_and_it_is_said(tmp_path):
    """Half of a spike is 1 cm/s for all of the record, as a velocity would be that the file does not tell."""
    spike = np.concatenate([[0.2], wiggle(4000, 5, 0.01)])
    write_at2(tmp_path / "records", "runs.AT2", spike, title="nothing, 000")
    write_at2(tmp_path / "records", "stays.AT2", wiggle(4000, 6, 0.2), title="nothing, 000")
    study = load_study(write_study(tmp_path, FOLDER_STUDY))
    told = {record["record"]: record for record in describe(study, ground_motions(study))["records"]}
    assert told["stays"]["pgd_m"] > 0
    assert told["stays"]["findings"] == []
    assert told["runs"]["pgd_m"] is None
    assert [finding["what"] for finding in told["runs"]["findings"]] == ["cut", "no PGD"]
    assert any(note.startswith("no PGD: integrated displacement drifts to ") for note in told["runs"]["notes"])


# Against real records


@cache
def components() -> list[Component]:
    return real_components(unit="g") + fema_p695.all_components()


@pytest.mark.slow
@needs_records
def test_no_real_record_comes_near_the_limit_of_alternation():
    """The largest of 200 real components is 7 % of its PGA; an instrument's is all of it."""
    pytest.importorskip("hdf5plugin")
    shares = [alternating(c.acceleration) / c.pga for c in components()]
    assert len(shares) > 190
    assert max(shares) < 0.3 * ALTERNATION


@pytest.mark.slow
@needs_records
def test_real_horizontals_of_a_station_are_far_from_five_times_each_other():
    pytest.importorskip("hdf5plugin")
    ratios = []
    for station in by_station(without_doubles(components())[0]):
        peaks = [c.pga for c in station if not c.orientation.vertical]
        if len(peaks) == 2:
            ratios.append(max(peaks) / min(peaks))
    assert len(ratios) > 60
    assert max(ratios) == pytest.approx(2.75, abs=0.01)  # TCU084


@pytest.mark.slow
@needs_records
def test_real_components_are_far_from_copies_and_real_verticals_from_another_unit():
    pytest.importorskip("hdf5plugin")
    alike, ratios = [], []
    for station in by_station(without_doubles(components())[0]):
        if len(station) <= 3:
            alike += [likeness_of(a, b) for a, b in combinations(station, 2)]
            peaks = [c.pga for c in station if not c.orientation.vertical]
            ratios += [c.pga / max(peaks) for c in station if c.orientation.vertical and peaks]
    assert len(alike) > 80
    assert max(alike) == pytest.approx(0.54, abs=0.01)
    assert len(ratios) > 20
    assert (min(ratios), max(ratios)) == pytest.approx((0.34, 1.85), abs=0.01)
    assert 2.0 * SELDOM_BELOW < min(ratios) < max(ratios) < SELDOM_ABOVE / 1.5


@pytest.mark.slow
@needs_records
def test_lasting_displacements_of_real_records_do_not_count_as_running_away():
    """Lucerne moved for good, by 2.4 m; straight lines take a third off that, and three fifths off what runs away."""
    pytest.importorskip("hdf5plugin")
    away = {True: 0, False: 0, None: 0}
    for c in {c.acceleration.tobytes(): c for c in components()}.values():
        away[c.processed] += c.initial is None and measures.runs_away(measures.displacement(c.acceleration, c.dt))
    assert away == {True: 2, False: 15, None: 1}  # True: 0111b and 0111c


@pytest.mark.slow
@needs_records
def test_no_corrected_real_record_is_doubted_and_all_have_a_pgd():
    pytest.importorskip("hdf5plugin")
    corrected = [c for c in components() if c.processed]
    found = to_motions(corrected, confirmed=())
    assert len(found.motions) > 130
    for motion in found.motions:
        assert whats(motion) in ([], ["no PGD"])
    assert [motion.name for motion in found.motions if motion.findings] == ["0111c"]  # SMC: its start is not told
    assert {u.reason.partition(" ")[0] for u in found.unusable} <= {"PGA", "several"}  # too weak; a suite found twice


# Clipped records, and numbers in m/s² under a header of g


def smooth(n: int = 4000, seed: int = 3) -> np.ndarray:
    """Return a record of many frequencies without any flat top, peak 1."""
    rng, t = np.random.default_rng(seed), np.arange(n) * 0.01
    waves = sum(rng.normal() * np.sin(2 * np.pi * f * t + rng.uniform(0, 6)) for f in np.geomspace(0.3, 12, 40))
    shape = waves * np.exp(-(((t - 15.0) / 6.0) ** 2))
    return shape / np.abs(shape).max()


@pytest.mark.parametrize(
    "clip",
    [
        lambda a: np.clip(a, -0.6, 0.6),
        lambda a: np.minimum(a, 0.5),
        lambda a: np.clip(a, -0.5, 0.5) - 0.03,
        lambda a: np.round(np.clip(a, -0.5, 0.5), 3),
        lambda a: np.clip(a, -0.5, 0.5) + np.linspace(0.0, 0.002, len(a)),
    ],
)
@pytest.mark.parametrize("seed", [3, 4, 5])
def test_flat_tops_are_found_and_have_to_be_confirmed(tmp_path, clip, seed):
    write_at2(tmp_path, "x000.AT2", 0.4 * clip(smooth(seed=seed)), title=title("0"))
    assert "flat tops: " in only_reason(read_motions(tmp_path))
    assert whats(read_motions(tmp_path, confirmed=["x000"]).motions[0])[0] == "clipped"


@pytest.mark.parametrize(("peak", "doubted"), [(1.99, False), (2.01, True)])
def test_a_peak_above_2_g_under_a_header_of_g_is_doubted(tmp_path, peak, doubted):
    write_at2(tmp_path, "x000.AT2", peak * smooth(), title=title("0"))
    (motion,) = read_motions(tmp_path, confirmed_pga=["x000"]).motions
    assert ("PGA" in whats(motion)) == doubted


@pytest.mark.parametrize("digits", [2, 3, 6])
@pytest.mark.parametrize("seed", [3, 4, 5])
def test_peaks_of_smooth_and_of_coarsely_printed_records_are_no_flat_tops(digits, seed):
    assert flat_tops(np.round(smooth(seed=seed), digits)) == []
    slow = np.sin(np.arange(2000) * 0.005)
    assert flat_tops(np.round(slow, digits)) == []


@pytest.mark.parametrize(
    ("rows", "clipped"),
    [
        ((3,), False),
        ((4,), True),
        ((2, 2), False),
        ((2, -2), False),
        ((2, 3), True),
        ((2, -3), True),
        ((2, 2, -1), False),
    ],
)
def test_four_samples_in_a_row_or_five_in_several_are_clipped(tmp_path, rows, clipped):
    samples = smooth()
    for place, row in enumerate(rows):  # below zero where negative
        samples[1000 + 100 * place :][: abs(row)] = np.copysign(1.2, row)
    write_at2(tmp_path, "x000.AT2", 0.4 * samples, title=title("0"))
    (motion,) = read_motions(tmp_path, confirmed=["x000"]).motions
    assert ("clipped" in whats(motion)) == clipped


def test_a_clipped_vertical_is_a_finding_of_its_motion(tmp_path):
    write_at2(tmp_path, "x000.AT2", 0.4 * smooth(), title=title("0"))
    write_at2(tmp_path, "x-UP.AT2", 0.4 * np.clip(smooth(seed=4), -0.5, 0.5), title=title("UP"))
    assert "vertical: flat tops" in only_reason(read_motions(tmp_path))


@pytest.mark.parametrize(("peak", "found"), [(1.9, []), (2.9, ["PGA"])])
def test_more_than_2_g_under_a_header_of_g_may_be_m_s2(tmp_path, peak, found):
    write_at2(tmp_path, "x000.AT2", peak * smooth(), title=title("0"))
    (motion,) = read_motions(tmp_path).motions
    assert whats(motion) == found
    if found:
        assert "if its numbers are in m/s², it is 0.3 g" in motion.findings[0].text


def test_a_strong_record_in_another_unit_is_left_in_peace(tmp_path):
    np.savetxt(tmp_path / "x000.txt", 25.0 * smooth())
    (motion,) = read_motions(tmp_path, options=ReadOptions(unit="m/s2", dt=0.01)).motions
    assert "PGA" not in whats(motion)
