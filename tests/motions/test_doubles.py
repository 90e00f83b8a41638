"""One recording in several files: which one is used, and what is said about the others."""

import gzip
import zipfile

import numpy as np
import pytest
from agency_files import geonet_text, renadic_channel
from fixed_column_files import A, B, C, cosmos_text, csmip_channel, csmip_text, smc_text
from motion_files import RECORDS, at2_text, needs_records, wiggle, write_at2
from national_files import csmnc_text
from waveform_files import COUNTS, START, trace, write_mseed

from rockbatch.common.errors import Contradiction
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.identity.doubles import _finding_on_copy
from rockbatch.motions.identity.likeness import pairs_of_one_recording
from rockbatch.motions.labels.orientation import Orientation
from rockbatch.motions.manifest_draft import draft


def title(component: str, station: str = "STA", event: str = "Somewhere, 1/17/1994") -> str:
    return f"{event}, {station}, {component}"


def left_out(found) -> dict[str, str]:
    return {double.source: double.reason for double in found.left_out}


def write(folder, **files: str) -> None:
    for name, text in files.items():
        (folder / name.replace("_", ".")).write_bytes(text.encode("latin-1"))


def test_the_corrected_one_of_two_volumes_is_used_and_the_other_named(tmp_path):
    write(tmp_path, STA_V1A=geonet_text(1), STA_V2A=geonet_text(2))
    found = read_motions(tmp_path)
    assert {motion.source for motion in found.motions} == {"STA.V2A (N28W)", "STA.V2A (S62W)"}
    assert not found.unusable
    assert left_out(found) == {
        f"STA.V1A ({way})": f"the same recording, less corrected, as STA.V2A ({way}), which is used; "
        "write use = true in motions.toml to use this one"
        for way in ("N28W", "S62W", "Up")
    }


@pytest.mark.parametrize("modern", [True, False])
def test_old_headers_without_a_time_are_compared_by_their_event(tmp_path, modern):
    write(tmp_path, a_RAW=csmip_text(1, modern=modern), b_V2=csmip_text(2, modern=modern))
    assert {m.source.partition(" ")[0] for m in read_motions(tmp_path).motions} == {"b.V2"}
    another = (
        csmip_text(1, modern=modern).replace("19:37", "29:37").replace("Jul  5", "Jul  6").replace("JUL  5", "JUL  6")
    )
    write(tmp_path, a_RAW=another)
    found = read_motions(tmp_path)
    assert {m.source.partition(" ")[0] for m in found.motions} == {"a.RAW", "b.V2"}
    assert not found.left_out


@pytest.mark.parametrize("names", [("a.mseed", "b.mseed"), ("b.mseed", "a.mseed")])
def test_what_begins_with_the_last_sample_of_another_file_is_no_copy_of_it(tmp_path, names):
    for name, values, start in zip(
        names, (COUNTS, COUNTS[::-1]), (START, START + 0.01 * (len(COUNTS) - 1)), strict=True
    ):
        write_mseed(tmp_path / name, trace("HNN", values, start))
    found = read_motions(tmp_path, confirmed=["*"], options=ReadOptions(unit="cm/s2"))
    assert len(found.motions) == 2
    assert not found.left_out


def test_use_in_a_manifest_decides_otherwise(tmp_path):
    write(tmp_path, STA_V1A=geonet_text(1), STA_V2A=geonet_text(2))
    manifest = tmp_path / "motions.toml"
    manifest.write_text('[[record]]\nfile = "STA.V1A"\nuse = true\n')
    found = read_motions(tmp_path)
    assert {motion.source.partition(" ")[0] for motion in found.motions} == {"STA.V1A"}
    assert all(motion.vertical_source == "STA.V1A (Up)" for motion in found.motions)
    assert "the same recording as STA.V1A (N28W), which is used" in left_out(found)["STA.V2A (N28W)"]
    manifest.write_text('[[record]]\nfile = "STA.V1A"\nuse = true\n[[record]]\nfile = "STA.V2A"\nuse = true\n')
    assert len(read_motions(tmp_path).motions) == 4


@pytest.mark.parametrize("other", ["x (2).AT2", "a/x.AT2", "copy of x.AT2", "x2.AT2"])
def test_a_copy_under_another_name_is_left_out_and_says_of_what(tmp_path, other):
    for name in ("x.AT2", other):
        write_at2((tmp_path / name).parent, name.rsplit("/", 1)[-1], wiggle(60), title="nothing, 000")
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["x.AT2"]
    assert left_out(found)[other].startswith("a copy of x.AT2, which is used")


def test_a_copy_with_a_suffix_that_nobody_knows_is_no_unusable_file(tmp_path):
    at2 = write_at2(tmp_path, "z.AT2", wiggle(60), title="nothing, 000")
    (tmp_path / "z.90").write_bytes(at2.read_bytes())  # known by its header; columns are not
    text = "# time(s) NS(g)\n" + "".join(f"{i / 100} {value:.6f}\n" for i, value in enumerate(wiggle(60, 2)))
    (tmp_path / "x.txt").write_text(text)
    (tmp_path / "x.90").write_text(text)
    (tmp_path / "y.90").write_text(text[:-1] + " ")
    with zipfile.ZipFile(tmp_path / "more.zip", "w") as archive:
        archive.writestr("x.91", text)
    (tmp_path / "x.92.gz").write_bytes(gzip.compress(text.encode()))
    found = read_motions(tmp_path)
    copies = dict.fromkeys(("x.90", "more.zip/x.91", "x.92.gz"), "a copy of x.txt")
    why = "a copy of z.AT2, which is used; write use = true in motions.toml to use this one"
    assert left_out(found) == {**copies, "z.90": why}
    assert {file.of for file in found.left_out} == {"x.txt", "z.AT2"}
    assert [file.source for file in found.unusable] == ["y.90"]


def test_records_in_archives_and_beside_them_are_used_once(tmp_path):
    """Downloads are kept as they came and unpacked: the file beside its archive has the shorter name."""
    text = at2_text(wiggle(60), title="nothing, 000")
    (tmp_path / "x.AT2").write_text(text)
    (tmp_path / "x.AT2.gz").write_bytes(gzip.compress(text.encode()))
    with zipfile.ZipFile(tmp_path / "peer.zip", "w") as archive:
        archive.writestr("x.AT2", text)
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["x.AT2"]
    assert set(left_out(found)) == {"x.AT2.gz", "peer.zip/x.AT2"}


def test_whole_sets_of_one_recording_are_used_once_if_samples_are_alike(tmp_path):
    """Read off again, with other noise, from the same recorder at another gain: one recording. A coda: another part."""
    noise = np.random.default_rng(1).standard_normal((3, len(A)))
    sets = {
        "a": (A, C, B),
        "b": tuple(1.3 * x + 0.05 * np.abs(x).max() * n for x, n in zip((A, C, B), noise, strict=True)),
    }
    for name, series in {**sets, "c": tuple(noise)}.items():
        channels = (
            renadic_channel(label, x / 100, trigger="2/27/2010 3:55:43.000")
            for label, x in zip("LVT", series, strict=True)
        )
        (tmp_path / f"{name}.v1").write_text("\n".join(line for channel in channels for line in channel))
    found = read_motions(tmp_path, confirmed=["*"])
    assert len(found.motions) == 4
    assert {motion.source.partition(" ")[0] for motion in found.motions} - {"a.v1", "b.v1"} == {"c.v1"}
    assert all(motion.vertical is not None for motion in found.motions)


def test_the_same_recording_in_another_unit_is_recognised_by_its_header(tmp_path):
    write_at2(tmp_path, "RSN7_X_STA000.AT2", wiggle(60), title=title("0"))
    write_at2(tmp_path, "sta.AT2", wiggle(60) * 981, title=title("0"), unit="ACCELERATION IN UNITS OF CM/S2")
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["sta.AT2"]
    assert left_out(found)["RSN7_X_STA000.AT2"].startswith("the same recording as sta.AT2")


def test_none_of_two_files_that_claim_one_component_is_used_until_named(tmp_path):
    strong, weak = wiggle(60, 1), wiggle(60, 2) / 20
    write_at2(tmp_path, "a_part1.AT2", weak, title=title("0"))
    write_at2(tmp_path, "a_part2.AT2", strong, title=title("0"))
    found = read_motions(tmp_path)
    assert not found.motions
    assert {unusable.kind for unusable in found.unusable} == {Contradiction}
    for unusable in found.unusable:
        assert "a_part1.AT2" in unusable.reason
        assert "a_part2.AT2" in unusable.reason
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "a_part1.AT2"\nuse = false\n')
    assert [motion.source for motion in read_motions(tmp_path).motions] == ["a_part2.AT2"]
    entries = (f'[[record]]\nfile = "a_part{i}.AT2"\nazimuth = 0\n' for i in (1, 2))
    (tmp_path / "motions.toml").write_text("".join(entries))
    assert len(read_motions(tmp_path).motions) == 2


def test_a_set_with_its_vertical_goes_before_one_without(tmp_path):
    write_at2(tmp_path / "a", "s000.AT2", wiggle(60, 1), title=title("0"))
    write_at2(tmp_path / "b", "s000.AT2", wiggle(60, 1) * 1.01, title=title("0"))
    write_at2(tmp_path / "b", "sUP.AT2", wiggle(60, 2), title=title("UP"))
    (motion,) = read_motions(tmp_path).motions
    assert (motion.source, motion.vertical_source) == ("b/s000.AT2", "b/sUP.AT2")


def test_other_sensors_events_and_directions_of_a_station_are_other_records(tmp_path):
    write(
        tmp_path,
        a_V1c=cosmos_text(A),
        b_V1c=cosmos_text(B, scnl="8040.HNE.NP.D1"),
        c_V1c=cosmos_text(C, location="Building; basement"),
        d_V1c=cosmos_text(A * 0.9, "360 Deg"),
        e_V1c=cosmos_text(A * 0.8, clock=(2018, 11, 30, 18, 29)),
    )
    found = read_motions(tmp_path)
    assert (len(found.motions), found.left_out) == (5, [])


def test_channels_of_one_file_are_never_doubles_of_each_other(tmp_path):
    lines = [*csmip_channel("90 Deg", A, volume=2), *csmip_channel("90 Deg", B, volume=2)]
    write(tmp_path, a_V2="\n".join([*lines, ""]))
    assert len(read_motions(tmp_path).motions) == 2


def test_records_whose_numbers_by_peer_differ_are_other_records(tmp_path):
    write_at2(tmp_path, "RSN7_X_S000.AT2", wiggle(60, 1), title=title("0"))
    write_at2(tmp_path, "RSN8_X_S000.AT2", wiggle(60, 2), title=title("0"))
    assert len(read_motions(tmp_path).motions) == 2


def test_an_smc_file_beside_its_uncorrected_one(tmp_path):
    write(tmp_path, a_smc=smc_text(title="1 UNCORRECTED ACCELEROGRAM"), b_smc=smc_text(B))
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == ["b.smc"]
    assert "less corrected" in left_out(found)["a.smc"]


@pytest.mark.parametrize(
    ("one", "two", "same"),
    [
        (Sensor("1336", place="FREEFIELD"), Sensor("01336", "CE", "", "Free field", "15"), True),
        (Sensor("CCC", "CI", ""), Sensor("CCC", "CI", "00"), False),
        (Sensor("CCC", "CI"), Sensor("CCC", "NP"), False),
        (Sensor("CCC", "CI", "00"), Sensor("CCC"), True),
        (Sensor("24386", place="ROOF"), Sensor("24386", place="GROUND"), False),
        (Sensor("24386", channel="1"), Sensor("24386", channel="2"), False),
        (Sensor(""), Sensor(""), False),
        (Sensor("A"), Sensor("B"), False),
    ],
)
def test_a_sensor_is_recognised_by_what_both_headers_say_of_it(one, two, same):
    assert one.may_be_same_as(two) == two.may_be_same_as(one) == same


def test_the_corrected_file_of_a_csmnc_record_is_used(tmp_path):
    raw, corrected = csmnc_text(A), csmnc_text(A * 0.99, kind="CORRECTED ACCELERATION")
    roof = csmnc_text(B).replace("POINT: GROUND", "POINT: ROOF")
    write(tmp_path, raw_dat=raw, corrected_dat=corrected, roof_dat=roof)
    found = read_motions(tmp_path)
    assert [(motion.source, motion.processed) for motion in found.motions] == [("corrected.dat", True)]
    assert "less corrected" in left_out(found)["raw.dat"]
    assert "is in a structure" in found.unusable[0].reason


def test_smc_files_that_do_not_know_their_time_are_not_taken_for_one_recording(tmp_path):
    nobody_knows = (-32768,) * 6
    write(tmp_path, a_smc=smc_text(A, clock=nobody_knows), b_smc=smc_text(B, clock=nobody_knows))
    assert len(read_motions(tmp_path).motions) == 2


def test_the_drafted_manifest_has_the_line_that_takes_the_other_one(tmp_path):
    write(tmp_path, STA_V1A=geonet_text(1), STA_V2A=geonet_text(2))
    text = draft(tmp_path)
    lines = [line for line in text.splitlines() if line.startswith("# use = true   ")]
    assert lines == [
        f"# use = true   # the same recording, less corrected, as STA.V2A ({way})" for way in ("N28W", "S62W", "Up")
    ]
    before = read_motions(tmp_path)
    (tmp_path / "motions.toml").write_text(text)
    after = read_motions(tmp_path)
    assert [(m.name, m.files) for m in after.motions] == [(m.name, m.files) for m in before.motions]
    assert left_out(after) == left_out(before)


@needs_records
def test_of_real_recordings_in_several_files_one_is_used():
    found = read_motions([RECORDS / "formats" / "ridgecrest_ccc", RECORDS / "formats" / "kaikoura_hses"])
    assert {motion.source.partition(" ")[0] for motion in found.motions} == {
        "ridgecrest_ccc/CICCC.RAW",  # in g; MiniSEED has counts
        "kaikoura_hses/20161113_110300_HSES_20.V2A",
    }
    doubles = [double for double in found.left_out if "which is used" in double.reason]
    assert len(doubles) == 6


@pytest.mark.parametrize(("stage", "used"), [("Corrected", "cosmos.v2c"), ("Uncorrected", "unknown.AT2")])
def test_a_copy_of_unknown_processing_ranks_between_corrected_and_uncorrected(tmp_path, stage, used):
    values = np.round(wiggle(1500, 4, 90.0) * np.hanning(1500), 3)
    text = cosmos_text(values, "90 Deg", stage=stage, scnl="")
    (tmp_path / "cosmos.v2c").write_text(text, encoding="latin-1")
    at2 = at2_text(values / 981.0, title="EARTHQUAKE, 1/17/1994, 8040, 090", dt=".0050")
    (tmp_path / "unknown.AT2").write_text(at2.replace("PEER NGA STRONG MOTION DATABASE RECORD", "A RECORD"))
    found = read_motions(tmp_path)
    assert [motion.source for motion in found.motions] == [used]


def test_two_channels_of_unknown_direction_do_not_contradict_each_other():
    """Two files of one sensor and event: with equal labels one of them is wrong, without labels they may be two directions."""

    def denied(label):
        made = [
            Component(
                f"c{k}",
                0.01,
                wiggle(seed=k),
                Orientation(label),
                sources=(f"{k}.x",),
                sensor=Sensor("A", "CI"),
                event="E",
            )
            for k in (1, 2)
        ]
        return pairs_of_one_recording(made).denied

    assert denied("H1") == [(0, 1)]
    assert denied("") == []


@pytest.mark.parametrize(
    ("peak", "factor", "said"),
    [(6.0, None, "has 3 times its peak"), (0.5, None, "has 0.25 times its peak"), (2.9, None, ""), (1.4, None, ""),
     (6.0, 3.0, "has the same samples times 3: check")],
)  # fmt: skip
def test_a_copy_with_another_peak_says_how_many_times_that_of_the_one_in_use(peak, factor, said):
    used = Component("used", 0.01, 2.0 * np.sin(np.arange(1, 200) * np.pi / 4.0), Orientation("NS"))
    copy = Component(
        "copy", 0.01, peak * np.sin(np.arange(1, 200) * np.pi / 4.0), Orientation("NS"), sources=("copy.AT2",)
    )
    finding = _finding_on_copy(copy, used, factor, decided=True)
    assert (finding is not None) == bool(said)
    assert finding is None or (said in finding.text and not finding.gross)
