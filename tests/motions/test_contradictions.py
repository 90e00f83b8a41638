"""What a header states of its samples is compared with them, in every format."""

import numpy as np
import pytest
from agency_files import A, cwa_text, dyna_text, knet_text
from contradictions import CONTRADICTIONS, HEADERS, bit, read_as, text, word
from fixed_column_files import csmip_text, smc_text
from national_files import csmnc_text

from rockbatch.common.units import GRAVITY
from rockbatch.motions import read_motions
from rockbatch.motions.formats import FORMATS, format_of
from rockbatch.motions.formats.geonet import read_geonet_stream
from rockbatch.motions.formats.stated import QUANTITIES, Sampled, Stated, contradictions

OF = {header.format: header for header in HEADERS}


@pytest.mark.parametrize("header", HEADERS, ids=lambda header: header.format)
def test_a_header_that_is_right_is_read_without_a_remark(header):
    found = read_as(header, header.data)
    assert found.motions
    assert not found.unusable
    assert not any("states" in note for motion in found for note in motion.notes)
    assert {finding.what for motion in found for finding in motion.findings} <= {"unprocessed", "no PGD"}


@pytest.mark.parametrize("wrong", CONTRADICTIONS, ids=lambda wrong: f"{wrong.header.format}: {wrong.statement}")
def test_no_statement_of_a_header_is_contradicted_in_silence(wrong):
    assert wrong.data != wrong.header.data
    assert wrong.consequence() in ("error", "waits", "warning", "note")


def test_every_format_tells_what_its_header_states():
    tried = {format_of(f".{header.file.rpartition('.')[2]}", header.data).name for header in HEADERS}
    by_libraries = {"ASDF", "Kinemetrics EVT"}  # which compare counts themselves
    assert tried == {form.name for form in FORMATS} - by_libraries


LIMITS = {
    "peak": (2.0, 0.05, 0.25), "range": (3.0, 0.05, 0.25), "time of the peak": (0.4, 0.05, 0.25), "duration": (1.0, 0.01, 0.25),
    "step": (0.001, 0.01, 0.01), "rate": (1000.0, 0.01, 0.01),
}  # fmt: skip
"""What samples have, and by how much a statement may be off before it is a warning, and before it waits.

Filters and offsets change a peak by some 5 %, a sample more or less a duration by 1 %; a quarter is another record.
"""


def shares(quantity: str) -> list[tuple[float, str]]:
    """Return factors by which a statement is off, and what is to come of it."""
    _, noted, gross = LIMITS[quantity]
    within = [(1.03 * noted, "warning"), (0.97 * gross, "warning")] if noted < gross else []
    kinds = [(0.97 * noted, "note"), *within, (1.03 * gross, "waits")]
    return [(1.0, ""), *((factor, kind) for off, kind in kinds for factor in (1 + off, 1 / (1 + off)))]


@pytest.mark.parametrize(
    ("quantity", "off", "what"), [(quantity, *share) for quantity in QUANTITIES for share in shares(quantity)]
)
def test_what_is_off_by_little_is_a_note_by_more_a_warning_and_by_much_waits(quantity, off, what):
    values = np.zeros(1000)
    values[[400, 700]] = 2.0, -1.0
    has, sampled = LIMITS[quantity][0], Sampled(values, 0.001, "m/s2", 1.0, values)
    findings, notes = contradictions([Stated(quantity, f"{off * has:.9f}")], sampled, GRAVITY)
    assert [*("waits" if f.gross else "warning" for f in findings), *("note" for _ in notes)] == (
        [what] if what else []
    )
    texts = (*(finding.text for finding in findings), *notes)
    assert all(f"states {QUANTITIES[quantity].words} {off * has:.9f}" in text for text in texts)
    for nothing in ("", "?", "0.000", "1e", "inf", "9e999"):
        if nothing != "0.000" or QUANTITIES[quantity].unit:  # a peak of 0 is one
            assert contradictions([Stated(quantity, nothing)], sampled, GRAVITY) == ((), ())
    ((absurd,), _) = contradictions([Stated(quantity, "9e200")], sampled, GRAVITY)
    assert absurd.gross


def test_a_time_of_a_nearly_equal_peak_and_one_that_counts_from_elsewhere_are_right():
    values = np.zeros(1000)
    values[[200, 800]] = 2.0, -1.92
    sampled = Sampled(values, 0.01, "m/s2", 1.0, values)
    for printed, begins in (("8.00", 0.0), ("-3.0", -5.0), ("3.0", -5.0), ("2.0", 0.0)):
        assert contradictions([Stated("time of the peak", printed, begins=begins)], sampled, GRAVITY) == ((), ())
    for printed, begins in (("5.0", 0.0), ("2.0", -5.0), ("-2.0", 0.0)):
        assert any(contradictions([Stated("time of the peak", printed, begins=begins)], sampled, GRAVITY))


@pytest.mark.parametrize("rate", [20.0, 100.0, 220.0, 400.0])
def test_a_rate_of_an_smc_file_is_held_against_the_time_of_the_peak(tmp_path, rate):
    """Real numbers 29 and 31 time the extremes."""
    (tmp_path / "x.smc").write_text(smc_text(rate=rate, at=np.abs(A).argmax() / 200), encoding="latin-1")
    found = read_motions(tmp_path)
    if rate == 220.0:
        assert [finding.what for finding in found.motions[0].findings] == ["time of the peak"]
    else:
        assert "its header states its peak after" in found.unusable[0].reason


@pytest.mark.parametrize("direction", ["E-W", "5"])
def test_a_knet_file_that_was_cut_within_its_last_count_is_refused(direction):
    """A last sample of -0.003 m/s² was 0.095 m/s² after the cut, without a word."""
    whole = OF["K-NET/KiK-net"]
    data = knet_text(direction)[0].encode()
    assert data.endswith(b" 4002 \n")
    for lost in range(3):
        assert len(read_as(whole, data[:-lost] if lost else data).motions) == 1
    for lost in range(3, 40):
        found = read_as(whole, data[:-lost])
        assert not found.motions
        assert found.unusable[0].reason.startswith(("line 42: found ", "200 values from line 42 on"))


def sac(change) -> tuple[list[str], list[str]]:
    """Return reasons and remarks of a SAC file with a change."""
    found = read_as(OF["SAC"], change(OF["SAC"].data))
    remarks = [note for motion in found for note in motion.notes if "its header" in note]
    return [unusable.reason for unusable in found.unusable], remarks


def test_extremes_of_a_sac_header_may_be_off_by_a_factor_of_two_at_most():
    def scaled(by: float):
        return lambda data: data[:632] + (by * np.frombuffer(data, "<f4", offset=632)).astype("<f4").tobytes()

    assert sac(scaled(1.0)) == ([], [])
    reasons, remarks = sac(scaled(1.6))
    assert not reasons
    assert "its header states a range of " in remarks[0]
    for change in (scaled(10.0), scaled(0.1), word(632 + 4 * 1700, "<f", lambda _: 5e5)):
        reasons, _ = sac(change)
        assert "its header states a range of " in reasons[0]
        assert 'if it is right, write confirm = ["x"]' in reasons[0]
    for unset in (-12345.0, 0.0):
        both = word(4, "<f", lambda _, value=unset: value), word(8, "<f", lambda _, value=unset: value)
        assert sac(lambda data, both=both: both[0](both[1](scaled(10.0)(data)))) == ([], [])


@pytest.mark.parametrize("place", [1, 2, 5, 6, 34, 57, 58, 70, 71, 72, 73, 74, 75, 85, 86, 105])
def test_any_number_of_a_sac_header_that_is_not_needed_may_be_undefined_alone(place):
    assert sac(word(4 * place, "<f" if place < 70 else "<i", lambda _: -12345)) == ([], [])


def test_the_times_of_a_sac_header_count_from_1970_in_some_files():
    def from_1970(data: bytes) -> bytes:
        begins = np.float32(1562383163.0)
        for place, value in ((5, begins), (6, begins + np.float32(29.99))):
            data = word(4 * place, "<f", lambda _, value=value: value)(data)
        return data

    assert sac(from_1970) == ([], [])
    reasons, _ = sac(word(0, "<f", lambda _: 0.0025))
    assert "its header states a duration of 29.99 s, and its samples have 7.5 s" in reasons[0]


@pytest.mark.parametrize("block", [0, 4, 9])
@pytest.mark.parametrize(("byte", "mask"), [(21, 1), (26, 1), (23, 2), (24, 2), (25, 32), (25, 4)])
def test_a_bit_of_the_time_of_a_block_of_miniseed_makes_no_two_motions(block, byte, mask):
    whole = OF["MiniSEED"]
    assert len(whole.data) == 10 * 512
    found = read_as(whole, bit(512 * block + byte, mask)(whole.data))
    assert not found.motions
    reasons = ("by its number, but not by its time", "gaps or overlaps")
    assert all(any(reason in unusable.reason for reason in reasons) for unusable in found.unusable)


def test_blocks_of_a_channel_with_a_location_code_are_counted_too():
    whole = OF["MiniSEED"]
    data = bytearray(whole.data)
    for start in range(0, len(data), 512):
        data[start + 13 : start + 15] = b"00"
    found = read_as(whole, bit(512 * 4 + 24, 2)(bytes(data)))
    assert any("by its number, but not by its time" in unusable.reason for unusable in found.unusable)


def test_blocks_of_miniseed_without_a_rate_are_refused():
    """Logs of recorders have none."""
    data = bytearray(OF["MiniSEED"].data)
    for block in range(0, len(data), 512):
        data[block + 32 : block + 36] = bytes(4)
    (refused,) = read_as(OF["MiniSEED"], bytes(data)).unusable
    assert "gaps or overlaps" in refused.reason


def test_a_second_that_is_cut_off_is_a_warning_and_more_waits():
    cwa, values = OF["CWA"], np.resize(A, 6000)
    head = cwa_text(**{"RecordLength(sec)": "    30.0"}).partition("#Data:")[0].replace("MAX.", "")
    rows = [f"{0.005 * i:10.3f}" + f"{value / 2:10.3f}" + 2 * f"{value:10.3f}" + "\n" for i, value in enumerate(values)]
    remarks = []
    for cut in (0, 20, 50, 190, 1000):
        data = f"{head}#Data: 4F10.3 \n{''.join(rows[: len(rows) - cut])}".encode()
        found = read_as(cwa, data)
        said = {finding.what for motion in found for finding in motion.findings} - {
            "unprocessed",
            "no PGD",
            "vertical",
            "copy",
            "cut",
        }
        notes = {note.partition(",")[0] for motion in found for note in motion.notes if "duration" in note}
        remarks.append((len(found.motions), said, len(notes)))
    assert remarks == [
        *((2, set(), 0), (2, set(), 0)),  # rounding: 0.1 s
        *((2, set(), 2), (2, {"duration"}, 2), (0, set(), 0)),
    ]


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("CSMNC", csmnc_text().replace("DURATION:  0.215 SEC", "DURATION:  60 SEC")),
        ("CSMIP Volume 2", csmip_text(2).replace("Record length =  0.430", "Record length = 56.957")),
    ],
)
def test_a_duration_of_what_the_samples_are_not_is_a_warning_at_most(name, data):
    found = read_as(OF[name], data.encode("latin-1"))
    assert not found.unusable
    assert all("duration" in {finding.what for finding in motion.findings} for motion in found)


def test_the_time_of_a_peak_counts_from_the_recorders_first_sample(tmp_path):
    (tmp_path / "x.ASC").write_text(dyna_text(TIME_PGA_S="0.300"))
    (refused,) = read_motions(tmp_path).unusable
    assert "its header states its peak after 0.300 s, and its samples have 0.115 s: check its step" in refused.reason
    confirmed = read_motions(tmp_path, confirmed=["*"])
    assert len(confirmed.motions) == 1


def test_obspys_readers_warn_of_contradictions(tmp_path):
    header = OF["GeoNet V1A"]
    (tmp_path / "x.V1A").write_bytes(text(r"Duration 0\.21", "Duration 0.43")(header.data))
    with pytest.warns(UserWarning, match=r"x\.V1A \(N28W\): its header states a duration of 0.43 s"):
        assert len(read_geonet_stream(str(tmp_path / "x.V1A"))) == 3
