"""Messages and notes about records, read back: each number, name and file in them is that of what they speak of."""

import math
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from damaged_files import SAMPLES
from messages import assert_states, said_by
from motion_files import wiggle

import rockbatch as rb
from rockbatch.motions.component import Component
from rockbatch.motions.fema_p695 import _split_name
from rockbatch.motions.formats import read_record
from rockbatch.motions.formats.time_steps import on_even_steps
from rockbatch.motions.formats.with_obspy import check_evt
from rockbatch.motions.identity.azimuths import components_along
from rockbatch.motions.identity.common_span import on_common_samples, too_unlike
from rockbatch.motions.identity.doubles import _finding_on_copy, _reason
from rockbatch.motions.intensity.pairs import common_samples
from rockbatch.motions.labels.orientation import Orientation
from rockbatch.motions.motion import Shock
from rockbatch.motions.quality.baseline import Offset, remove_offset
from rockbatch.motions.sources.record_file import ReadOptions, RecordFile
from rockbatch.motions.suites.design_spectra import AashtoSpectrum, NzsSpectrum
from rockbatch.motions.suites.hazard import problems
from rockbatch.motions.suites.pulses import unlikely
from rockbatch.motions.suites.scaling import Target
from rockbatch.motions.suites.spectrum_target import SpectrumTarget

G = 9.80665
OPTIONS = ReadOptions(unit="m/s2")
A = wiggle(400, 3, 1.0)


def component(name, azimuth=0.0, *, dt=0.01, samples=A, **rest):
    return Component(name, dt, samples, Orientation(name[-3:], azimuth=azimuth), sources=(f"{name}.AT2",), **rest)


def motion(name, azimuth=0.0, *, dt=0.01, samples=A, **rest):
    return rb.Motion(name, dt, samples, azimuth=azimuth, **rest)


def turned(*horizontals):
    """Return why these components of a station cannot be turned, or the notes on how they are."""
    kept, refused = components_along(horizontals, [30.0])
    return [file.reason for file in refused[:1]] or list(kept[0].notes)


def of_samples(first, second):
    return on_common_samples(first, second, (first.name, second.name)).notes


def damaged(form, before, after, which=0, options=OPTIONS):
    """Return why a sample of a format is refused with one text in it replaced by another."""
    file, whole = SAMPLES[form][which]
    wrong = whole.replace(before, after, 1)
    assert wrong != whole
    return lambda: [str(reading) for reading in read_record(RecordFile(Path(file), file, wrong, options=options))]


def with_bytes(form, **words):
    """Return why a binary sample is refused with other bytes from these places on."""
    file, whole = SAMPLES[form][0]
    for place, data in words.items():
        start = int(place[2:])
        whole = whole[:start] + data + whole[start + len(data) :]
    return lambda: [str(reading) for reading in read_record(RecordFile(Path(file), file, whole))]


def cut(form, size):
    """Return why a sample of a format is refused of which so many bytes are left."""
    file, whole = SAMPLES[form][0]
    return lambda: [str(reading) for reading in read_record(RecordFile(Path(file), file, whole[:size]))]


STEPS = [0.0011, *((0.0195 if i % 2 else 0.05) + 1e-5 * math.sin(i) for i in range(1, 120))]
FIRST, SECOND = component("first_000"), component("second_090", 90.0)
LATE = replace(SECOND, start=1.0e9 + 3.7)
MESSAGES = {
    "a count of other samples": (
        lambda: damaged("CSMIP", b"43 points of", b"40 points of", which=1)()[:1],
        ["x.V2", 90.0, 40.0, 43.0],
    ),
    "components 75° apart": (lambda: turned(FIRST, component("x_075", 75.0)), ["first_000", "x_075", 75.0]),
    "one of unknown azimuth": (lambda: turned(FIRST, component("x_UNK", None)), ["x_UNK"]),
    "three components": (lambda: turned(FIRST, SECOND, component("x_180", 180.0)), [3.0]),
    "components without common time": (
        lambda: turned(replace(FIRST, start=0.0), replace(SECOND, start=50.0)),
        ["first_000", "second_090"],
    ),
    "steps too far apart to turn": (
        lambda: turned(FIRST, replace(SECOND, dt=0.0001)),
        ["second_090", 0.0001, 0.01, "first_000", 20.0],
    ),
    "turned components": (lambda: turned(FIRST, SECOND), [30.0, "first_000", "second_090"]),
    "steps too far apart": (lambda: too_unlike(FIRST, replace(SECOND, dt=0.5)), [0.5, 0.01, "first_000", 20.0]),
    "interpolated to common samples": (
        lambda: of_samples(FIRST, replace(SECOND, dt=0.005)),
        ["first_000", 0.005, 0.01, "first_000", 0.005, "second_090", 1.995, 3.99, "first_000", 1.995, "second_090"],
    ),
    "a late component": (
        lambda: of_samples(replace(FIRST, start=1.0e9), replace(LATE, start=1.0e9 + 1.2)),
        [2.79, 3.99, "first_000", 3.99, "second_090"],
    ),
    "a component that jitters": (
        lambda: of_samples(replace(FIRST, start=1.0e6), replace(SECOND, start=1.0e6 + 0.0007)),
        ["second_090", 0.7, 0.07],
    ),
    "motions 75° apart": (lambda: common_samples(motion("a"), motion("b", 75.0)), ["a and b", 75.0]),
    "motions of two steps": (
        lambda: common_samples(motion("a"), motion("b", 90.0, dt=0.02)),
        ["a and b", 0.01, 0.02],
    ),
    "motions between samples": (
        lambda: common_samples(motion("a", start=1e6), motion("b", 90.0, start=1e6 + 0.0237)),
        ["a and b", 2.37],
    ),
    "motions without common time": (
        lambda: common_samples(motion("a", start=1e6), motion("b", 90.0, start=1e6 + 700.0)),
        ["a and b"],
    ),
    "sequences out of step": (
        lambda: common_samples(
            motion("a", shocks=(Shock("x", 0.0, 1.0, 2.0),)), motion("b", 90.0, shocks=(Shock("y", 0.5, 1.0, 2.0),))
        ),
        ["a and b"],
    ),
    "an offset rule": (lambda: Offset("median"), ['offset = "median"', "as needed, keep, mean, pre-event"]),
    "a window out of order": (lambda: Offset("pre-event", (3.0, 2.0)), [3.0, 2.0, 0.0]),
    "a window beyond the record": (
        lambda: remove_offset(FIRST, Offset("pre-event", (1.5, 7.25))),
        [1.5, 7.25, 3.99],
    ),
    "an offset kept": (
        lambda: remove_offset(replace(FIRST, acceleration=A - A.mean() + 0.345, raw=True), Offset("keep")).notes,
        [0.345],
    ),
    "an offset before the event": (
        lambda: remove_offset(replace(FIRST, acceleration=0.0 * A + 0.215), Offset("pre-event", (0.5, 1.25))).notes,
        [0.215, 0.5, 1.25],
    ),
    "an offset": (
        lambda: remove_offset(replace(FIRST, acceleration=A - A.mean() + 0.125), Offset("mean")).notes,
        [0.125],
    ),
    "a point of a hazard": (
        lambda: [text for _, text in problems([0.1, -0.3], [0.02, 0.001], None, "points")],
        [-0.3, 0.001, 0.0],
    ),
    "a hazard of return periods": (
        lambda: [text for _, text in problems([0.1, 0.3], [475.0, 72.0], None, "points")],
        [475.0],
    ),
    "a hazard that rises": (
        lambda: [text for _, text in problems([0.1, 0.3], [0.002, 0.005], None, "points")],
        [0.005, 0.3, 0.002, 0.1],
    ),
    "a hazard out of order": (
        lambda: [text for _, text in problems([0.3, 0.1], [0.005, 0.002], None, "points")],
        [0.1, 0.3],
    ),
    "levels without rates": (
        lambda: [text for _, text in problems([0.3, 0.1, 0.2], [0.005], None, "points")],
        [3.0, 1.0],
    ),
    "a range of periods": (
        lambda: SpectrumTarget(NzsSpectrum("C", 0.3), (0.4, 6.5)),
        [0.4, 6.5, "NZS 1170.5", 0.3, 1.0, 5.0, 0.0, 4.5],
    ),
    "rules of a target": (
        lambda: SpectrumTarget(NzsSpectrum("C", 0.3), (0.4, 1.5), factors="two", pairs="some"),
        ['factors = "two"', "both", 'pairs = "some"', "apart"],
    ),
    "a hazard beyond the standard": (
        lambda: NzsSpectrum("C", 0.5, return_period_factor=1.8).beyond,
        [0.9, "1170.5, 3.1.1", 0.7, 0.9 / 0.7, "return_period_factor", 0.7 / 0.5],
    ),
    "a target of two components": (
        lambda: str(Target(sa_g=0.45, period_s=1.2, damping=0.07)),
        [1.2, 7.0, 0.45],
    ),
    "a strong pulse": (lambda: unlikely(4.5, 0.8, 0.5).values(), [4.5, 3.0, 0.1, 1.0, 1.6, 0.8, 50.0]),
    "a pulse of many samples": (
        lambda: rb.pulse("sine", name="s", amplitude=1.0, period=2.0, dt=1e-7, duration=300.0),
        ["dt", 1e-7, 1e7, 300.0],
    ),
    "a pulse of no shape": (
        lambda: rb.pulse("sinus", name="s", amplitude=1.0, period=2.0, dt=0.01, duration=3.0),
        ["shape", "sinus", "sine", "cosine", 'did you mean "sine"'],
    ),
    "a sequence with unlike lists": (
        lambda: rb.sequence([motion("a"), motion("b"), motion("c")], name="all", factors=[1.0, 2.0]),
        ["all", "factors", 2.0, 3.0],
    ),
    "notes of a sequence": (
        lambda: rb.sequence(
            [motion("a"), motion("b", dt=0.02)], name="all", factors=[1.0, 0.7], polarity=["+", "-"], pause=20.0
        ).notes[:2],
        ["shock 2, b", 0.7, "reversed", "b", 0.02, 0.01],
    ),
    "a sequence that has to stop": (
        lambda: rb.sequence([motion("a", samples=A + 3.0), motion("b")], name="all", pause=2.0),
        ["all", 2.0 * abs((A + 3.0)[:-1].sum() * 0.01 + 0.5 * 0.01 * (A[0] + 3.0)) / 2.0 / G, 2.0, 0.005],
    ),
    "a copy that is less corrected": (
        lambda: _reason(replace(FIRST, processed=False), replace(SECOND, processed=True), 0.45),
        ["less corrected", 0.45, "times as large", "second_090.AT2"],
    ),
    "a copy": (lambda: _reason(FIRST, replace(FIRST, sources=("other.AT2",)), None), ["copy of other.AT2"]),
    "a copy of another size": (
        lambda: _finding_on_copy(FIRST, SECOND, 2.5, decided=True).text,
        ["first_000.AT2", 2.5],
    ),
    "a copy with another peak": (
        lambda: _finding_on_copy(replace(FIRST, acceleration=3.5 * A), SECOND, None, decided=True).text,
        ["first_000.AT2", 3.5],
    ),
    "the spectrum of NZS 1170.5": (
        lambda: str(NzsSpectrum("D", 0.35, return_period_factor=1.3, fault_km=7.5)),
        ["1170.5 subsoil D", 0.35, 1.3, 7.5, "km", 5.0],
    ),
    "the spectrum of AASHTO": (lambda: str(AashtoSpectrum(0.35, 0.85, 0.45)), [0.35, 0.85, 0.45, 5.0]),
    "a name of a package": (lambda: _split_name("NORTHR-MUL"), ["NORTHR-MUL"]),
    "a time that stands still": (
        lambda: on_even_steps(np.array([0.0, 0.1, 0.2, 0.2, 0.3]), np.zeros((5, 1))),
        [3.0, 0.2],
    ),
    "a gap": (
        lambda: on_even_steps(np.array([*np.arange(9) * 0.1, 9.0]), np.zeros((10, 1))),
        [0.1, 8.2, 9.0, 0.8],
    ),
    "steps of many lengths": (
        lambda: on_even_steps(np.cumsum([0.0, *STEPS]), np.zeros((121, 1))),
        [min(STEPS), max(STEPS), math.ceil(sum(STEPS) / min(STEPS)), 121.0],
    ),
    "a duration of K-NET": (
        damaged("K-NET/KiK-net", b"Duration Time(s)  2", b"Duration Time(s)  2.007"),
        ["line 12", 2.007, 100.0, 1.0],
    ),
    "one point of CSMNC": (
        damaged("CSMNC", b"NO. OF POINTS:  43", b"NO. OF POINTS:   1"),
        ["line 12", "NO. OF POINTS:   1  EQUALLY SPACED INTERVALS OF:  0.005  SEC"],
    ),
    "directions of UNAM": (
        damaged("UNAM", b"/N00E/N90E/V", b"/N00E/N90E  "),
        [3.0, "ORIENTACION C1-C6", "/N00E/N90E"],
    ),
    "an hour of MiniSEED": (
        with_bytes("MiniSEED", at22=struct.pack(">H", 17), at24=bytes([24, 4, 5])),
        [17.0, 24.0, 4.0, 5.0],
    ),
    "a damaged length of MiniSEED": (with_bytes("MiniSEED", at54=bytes([33])), [2.0, 33.0, 2.0, 7.0, 2.0, 20.0]),
    "a damaged .evt": (lambda: check_evt(SAMPLES["Kinemetrics EVT"][0][1][:2100]), [32.0, 225.0, 2056.0]),
    "a SAC file that is cut": (cut("SAC", 2001), [342.25, 700.0]),
    "a step of SAC": (with_bytes("SAC", at0=struct.pack("<f", 7e9)), ["DELTA", 7e9, 1e-5, 1.0]),
    "a short SAC file": (cut("SAC", 612), [612.0, 632.0]),
}


@pytest.mark.parametrize("name", MESSAGES)
def test_what_a_message_names_is_what_it_speaks_of(name):
    call, expected = MESSAGES[name]
    assert_states(said_by(call), *expected)
