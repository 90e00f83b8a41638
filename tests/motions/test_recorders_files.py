"""Files that ObsPy reads by an explicit format, and ASDF through h5py: of recorders and of data centres."""

import struct

import h5py
import numpy as np
import pytest
from waveform_files import COUNTS, asdf_bytes, channel_xml, evt_bytes, trace

from rockbatch.common.errors import InputError
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.formats.with_obspy import check_evt

XML = (
    '<FDSNStationXML xmlns="http://www.fdsn.org/xml/station/1"><Network code="CI"><Station code="LRL">{}</Station></Network>'
    "</FDSNStationXML>"
)


def reason(folder, **given) -> str:
    (unusable,) = read_motions(folder, **given).unusable
    return unusable.reason


@pytest.mark.parametrize("name", ["x.h5", "x.asdf", "x"])
def test_asdf_has_its_waveforms_and_their_gains_in_one_file(tmp_path, name):
    xml = XML.format(channel_xml("HNN") + channel_xml("HNE", 90.0) + channel_xml("HNZ", dip=-90.0, value=4e5))
    (tmp_path / name).write_bytes(asdf_bytes(trace("HNE"), trace("HNN"), trace("HNZ"), xml=xml))
    found = read_motions(tmp_path)
    assert not found.unusable
    assert sorted(motion.azimuth for motion in found) == [0.0, 90.0]
    plain = COUNTS / 2e5 - (COUNTS / 2e5).mean()
    np.testing.assert_allclose(found.motions[0].horizontal, plain, rtol=1e-12, atol=1e-15)
    assert found.motions[0].vertical == pytest.approx(plain / 2.0)
    assert found.motions[0].start == trace("HNN").stats.starttime.timestamp
    assert any("StationXML of CI.LRL, epoch 2017" in note for note in found.motions[0].notes)


def test_asdf_without_a_gain_asks_for_it_and_takes_what_is_stated(tmp_path):
    (tmp_path / "x.h5").write_bytes(asdf_bytes(trace("HNN")))
    assert "counts without a sensitivity" in reason(tmp_path)
    (motion,) = read_motions(tmp_path, options=ReadOptions(sensitivity=2e5))
    np.testing.assert_allclose(motion.horizontal, COUNTS / 2e5 - (COUNTS / 2e5).mean(), rtol=1e-12, atol=1e-15)


def test_of_several_tags_in_an_asdf_file_the_recordings_are_used(tmp_path):
    xml = XML.format(channel_xml("HNN"))
    (tmp_path / "x.h5").write_bytes(asdf_bytes(trace("HNN"), xml=xml, tags=("processed", "raw_recording")))
    (motion,) = read_motions(tmp_path)
    assert motion.pga == pytest.approx(np.abs(COUNTS - COUNTS.mean()).max() / 2e5)
    assert "waveforms with the tag processed left out: ASDF states no unit of what was processed" in motion.notes


def test_pieces_of_an_asdf_file_that_follow_one_another_are_one_record(tmp_path):
    whole = trace("HNN")
    middle = whole.stats.starttime + 100 * whole.stats.delta
    pieces = whole.slice(endtime=middle), whole.slice(starttime=middle + whole.stats.delta)
    xml = XML.format(channel_xml("HNN"))
    (tmp_path / "x.h5").write_bytes(asdf_bytes(*pieces, xml=xml))
    (motion,) = read_motions(tmp_path)
    assert motion.npts == len(COUNTS)
    gap = whole.slice(starttime=middle + 5 * whole.stats.delta)
    (tmp_path / "x.h5").write_bytes(asdf_bytes(pieces[0], gap, xml=xml))
    assert "gaps or overlaps: 2 pieces" in reason(tmp_path)
    other_rate = trace("HNN", start=middle + 0.01, rate=50.0)
    (tmp_path / "x.h5").write_bytes(asdf_bytes(pieces[0], other_rate, xml=xml))
    assert "gaps or overlaps: 2 pieces" in reason(tmp_path)


def test_two_gains_within_an_asdf_file_contradict_each_other(tmp_path):
    xml = XML.format(channel_xml("HNN") + channel_xml("HNN", value=5e5))
    (tmp_path / "x.h5").write_bytes(asdf_bytes(trace("HNN"), xml=xml))
    assert "500000 counts per M/S**2 (StationXML of CI.LRL" in reason(tmp_path)


@pytest.mark.parametrize(
    "changed", [{"sampling_rate": 0.0}, {"sampling_rate": np.nan}, {"starttime": -5}, {"starttime": 2.0**62}]
)
def test_a_rate_or_a_time_that_cannot_be_is_refused(tmp_path, changed):
    (tmp_path / "x.h5").write_bytes(asdf_bytes(trace("HNN"), **changed))
    assert "sampling_rate = " in reason(tmp_path)


def test_another_hdf5_file_and_links_into_others_are_no_records(tmp_path):
    with h5py.File(tmp_path / "x.h5", "w") as store:
        store["numbers"] = np.arange(5.0)
    assert "without the group Waveforms" in reason(tmp_path)
    (tmp_path / "secret.bin").write_bytes(asdf_bytes(trace("HNN")))
    with h5py.File(tmp_path / "x.h5", "w") as store:
        store["Waveforms"] = h5py.ExternalLink(str(tmp_path / "secret.bin"), "/Waveforms")
    assert (
        "without the group Waveforms" in {u.source: u.reason for u in read_motions(tmp_path / "x.h5").unusable}["x.h5"]
    )


def test_a_file_of_a_recorder_is_in_m_s2_by_its_own_header_and_asks_for_directions(tmp_path):
    (tmp_path / "x.evt").write_bytes(evt_bytes())
    found = read_motions(tmp_path)
    assert [unusable.reason.partition(":")[0] for unusable in found.unusable] == [
        f'direction not known from "channel {n}"' for n in (1, 2, 3)
    ]
    stated = read_motions(tmp_path, options=ReadOptions(role="horizontal"), confirmed_pga=["*"])
    assert [motion.npts for motion in stated] == [5750] * 3
    from obspy import read

    (peaks,) = [
        [abs(one.data - one.data.mean()).max() for one in read(tmp_path / "x.evt", "KINEMETRICS_EVT", apply_calib=True)]
    ]
    assert [motion.pga for motion in stated] == pytest.approx(peaks, rel=1e-6)


@pytest.mark.parametrize("end", [10, 1000, 3000, -100])
def test_a_cut_file_of_a_recorder_is_refused(tmp_path, end):
    (tmp_path / "x.evt").write_bytes(evt_bytes()[:end])
    assert read_motions(tmp_path).unusable
    assert not read_motions(tmp_path, options=ReadOptions(role="horizontal"), confirmed=["*"]).motions


def frame(kind, order, mark=None, of_data=24):
    """Return a frame of an .evt: a tag of 16 bytes in the byte ``order`` that its second byte states, a header and data."""
    tag = struct.pack(f"{order}2s2xIHHI", b"K" + bytes([order == ">" if mark is None else mark]), kind, 32, of_data, 0)
    return tag + bytes(32 + of_data)


@pytest.mark.parametrize("order", "<>")
def test_tags_of_a_recorder_lead_from_frame_to_frame_in_either_byte_order(order):
    whole = frame(1, order, of_data=0) + frame(0, order) + frame(0, order)
    assert check_evt(whole) == whole
    assert check_evt(whole + bytes(50)) == whole + bytes(50)
    with pytest.raises(InputError, match="no tag at byte 48"):
        check_evt(whole[:48] + frame(0, order, mark=2))
    with pytest.raises(InputError, match="a frame of 32 and 24 bytes at byte 120"):
        check_evt(whole[:-1])
    with pytest.raises(InputError, match="no tag at byte 192"):
        check_evt(whole + b"K\0")
