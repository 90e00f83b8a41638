"""Sequences of shocks: the records as they are, and the ground at rest between them."""

import numpy as np
import pytest
from motion_files import wiggle, write_at2
from studies import COSINE, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.motions import Motion, read_motions
from rockbatch.motions.intensity import measures
from rockbatch.motions.motion import Initial
from rockbatch.motions.quality.plausible import unlikely_samples
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.motions.suites.sequences import MOST_IN_PAUSE, ShockSequence
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

MOTIONS = "motions/near_fault"


def record(name: str, seed: int = 1, dt: float = 0.01, size: float = 3.0, vertical: bool = True, **more) -> Motion:
    up = size * wiggle(400, seed + 10) if vertical else None
    return Motion(name, dt, size * wiggle(400, seed), up, **more)


def real():
    found = read_motions(MOTIONS)
    return [found["CHAN15"], found["CHAN24"], found["20161113_110259_WTMC_20.N28W"]]


def test_a_sequence_of_one_is_the_record_itself_to_the_byte():
    for alone in (record("a"), real()[0]):
        one = rb.sequence([alone], name="one")
        for samples in ("horizontal", "vertical"):
            assert getattr(one, samples).tobytes() == getattr(alone, samples).tobytes()
        assert (one.dt, one.initial, one.label) == (alone.dt, alone.initial, alone.label if alone.source else "one")
        (shock,) = one.shocks
        assert (shock.name, shock.start, shock.end) == (alone.name, 0.0, pytest.approx(alone.duration))


def test_each_shock_has_the_samples_of_its_record_and_begins_with_its_velocity():
    parts = real()[:2]
    whole = rb.sequence([*parts, parts[0]], pause=12.0)
    velocity = measures.velocity(whole.horizontal, whole.dt, whole.initial)
    for shock, part in zip(whole.shocks, [*parts, parts[0]], strict=True):
        first = round(shock.start / whole.dt)
        of_shock = slice(first, first + part.npts)
        assert whole.horizontal[of_shock].tobytes() == part.horizontal.tobytes()
        assert whole.vertical[of_shock].tobytes() == part.vertical.tobytes()
        own = measures.velocity(part.horizontal, part.dt, part.initial)
        np.testing.assert_allclose(velocity[of_shock], own, atol=1e-12)
    gaps = [b.start - a.end for a, b in zip(whole.shocks, whole.shocks[1:], strict=False)]
    assert gaps == pytest.approx([12.0, 12.0])
    assert any("brought to rest in the pauses by" in note for note in whole.notes)


def test_a_record_that_ends_at_rest_is_followed_by_no_motion_at_all():
    pulse = rb.pulse("sine", name="p", amplitude=2.0, period=1.0, dt=0.01, duration=4.0)
    whole = rb.sequence([pulse, pulse], pause=5.0)
    assert not whole.horizontal[pulse.npts : round(whole.shocks[1].start / 0.01)].any()
    assert not any("rest" in note for note in whole.notes)
    assert (whole.sources, whole.recorded) == (("pulse",), False)
    assert measures.pgd(whole.horizontal, 0.01) == pytest.approx(2.0 * measures.pgd(pulse.horizontal, 0.01))


def test_a_velocity_is_taken_away_by_a_bell_whose_area_it_is():
    drifting = Motion("d", 0.01, np.r_[np.full(51, 0.4), np.zeros(50)])  # ends with 0.202 m/s
    whole = rb.sequence([drifting, drifting], pause=20.0)
    pause = whole.horizontal[drifting.npts : -drifting.npts]
    assert np.trapezoid(np.r_[0.0, pause, 0.4], dx=0.01) == pytest.approx(-0.4 * 0.505)
    assert np.abs(pause).max() == pytest.approx(2.0 * (0.4 * 0.505 + 0.5 * 0.01 * 0.4) / 20.0, rel=0.02)
    assert pause.max() < 0.0
    begun = Motion("b", 0.01, np.zeros(101), initial=Initial(velocity=0.3))
    moving = rb.sequence([begun, begun], pause=20.0)  # it begins and ends with the same velocity
    assert not moving.horizontal.any()


def test_ground_that_would_shake_the_pier_on_its_way_to_rest_is_refused():
    drifting = Motion("d", 0.01, np.full(200, 0.5))
    with pytest.raises(
        InputError, match=r"to bring the ground to rest in a pause of 5 s, more than 0.005 g.*offset = \"mean\""
    ):
        rb.sequence([drifting, drifting], pause=5.0)
    assert 9.81 * np.tan(0.05) / 9.0 > MOST_IN_PAUSE


def test_the_finest_sampling_counts_and_multiples_of_it_lose_nothing():
    coarse, fine = record("coarse", 1, 0.02), record("fine", 2, 0.01)
    whole = rb.sequence([coarse, fine])
    assert whole.dt == 0.01
    np.testing.assert_allclose(whole.horizontal[: 2 * 400 - 1 : 2], coarse.horizontal, rtol=1e-12, atol=1e-15)
    assert any("coarse interpolated linearly from dt = 0.02 s to 0.01 s" in note for note in whole.notes)
    odd = rb.sequence([record("odd", 1, 0.003), fine])
    assert (odd.dt, odd.shocks[1].end - odd.shocks[1].start) == (0.003, pytest.approx(3.99, abs=0.003))


def test_factors_polarities_and_missing_verticals():
    a, b = record("a", 1), record("b", 2, vertical=False)
    whole = rb.sequence([a, b], factors=[0.5, 2.0], polarity=["-", "+"])
    second = round(whole.shocks[1].start / 0.01)
    np.testing.assert_array_equal(whole.horizontal[:400], -0.5 * a.horizontal)
    np.testing.assert_array_equal(whole.vertical[:400], 0.5 * a.vertical)
    np.testing.assert_array_equal(whole.horizontal[second:], 2.0 * b.horizontal)
    assert not whole.vertical[second:].any()
    assert "shock 1, a: times 0.5, reversed" in whole.notes
    assert "no vertical component in b: zeros" in whole.notes
    assert rb.sequence([b, b]).vertical is None
    stronger = rb.sequence([b, a], factors=[1.0, 1.1])
    np.testing.assert_allclose(stronger.horizontal[second:], 1.1 * a.horizontal, rtol=1e-15)
    assert [note for note in stronger.notes if "times" in note] == ["shock 2, a: times 1.1"]


def test_after_a_long_pause_a_sequence_has_the_larger_of_the_spectra_of_its_shocks():
    parts = real()[:2]
    whole = rb.sequence(parts, pause=60.0)
    periods = np.array([0.3, 0.7, 1.0, 2.0])
    spectra = [spectral_acceleration(part.horizontal, part.dt, periods) for part in parts]
    found = spectral_acceleration(whole.horizontal, whole.dt, periods)
    np.testing.assert_allclose(found, np.max(spectra, axis=0), rtol=1e-4)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"motions": []}, "one motion at least"),
        ({"pause": 0.0}, "pause = 0: must be a number above 0"),
        ({"factors": [1.0]}, "factors: 1 given for 2 motions; give one for each"),
        ({"factors": [1.0, -1.0]}, "factors: -1 must be a number above 0"),
        ({"polarity": ["+", "x"]}, r'polarity: "x" must be "\+" or "-"'),
        ({"motions": [1, 2]}, "must be a list of Motion"),
        ({"motions": [record("a", dt=0.2), record("b", dt=0.0004)]}, "more than 20 times apart"),
        ({"pause": 1e6}, "more than 20,000,000 samples"),
    ],
)
def test_what_is_wrong_about_a_sequence_is_said(change, said):
    asked = {"motions": [record("a"), record("b", 2)], "name": "s"} | change
    with pytest.raises(InputError, match=said):
        rb.sequence(asked.pop("motions"), **asked)


def test_a_sequence_of_sequences_is_refused():
    twice = rb.sequence([record("a"), record("b", 2)], name="twice")
    with pytest.raises(InputError, match="twice is a sequence itself; give its records"):
        rb.sequence([twice, record("a")])


# In a study


def study(folder, *sequences, pulses=(), **motions):
    text = study_text(motions={"path": "records", "sequence": list(sequences), **motions}, pulses=pulses, cases=[RIGID])
    for name, seed, size in (("RSN1_A_000", 1, 1.0), ("RSN1_A_090", 2, 0.7), ("RSN2_B_000", 3, 1.4)):
        _, station, azimuth = name.split("_")
        title = f"Made-up, 1/17/1994, Station {station}, {azimuth}"
        write_at2(folder / "records", f"{name}.AT2", size * wiggle(400, seed), title=title)
    return load_study(write_study(folder, text))


TWO = {"name": "two", "records": ["RSN1_A_000", "RSN2_B_000"], "pause_s": 5.0}


def names(motions):
    return [motion.name for motion in motions]


def test_a_study_runs_a_sequence_in_the_place_of_its_records(tmp_path):
    found = ground_motions(study(tmp_path, TWO))
    assert names(found.motions) == ["RSN1_A_090", "two"]
    assert [(each.name, each.reason.partition(";")[0]) for each in found.left_out] == [
        ("RSN1_A_000", 'a shock of the sequence "two"'), ("RSN2_B_000", 'a shock of the sequence "two"')
    ]  # fmt: skip
    assert found["two"].of_station == f"{read_motions(tmp_path / 'records')['RSN1_A_000'].of_station} + RSN2"
    whole = ground_motions(study(tmp_path, TWO | {"alone": True}))
    assert names(whole.motions) == ["RSN1_A_000", "RSN1_A_090", "RSN2_B_000", "two"]


def test_one_factor_is_for_all_shocks_and_so_is_one_polarity():
    parts = [record("a"), record("b", 2)]
    whole = ShockSequence("s", ("a", "b"), factors=(0.5,), polarity=("-",)).as_motion(parts)
    np.testing.assert_array_equal(whole.horizontal[:400], -0.5 * parts[0].horizontal)
    np.testing.assert_array_equal(whole.horizontal[-400:], -0.5 * parts[1].horizontal)
    each = ShockSequence("s", ("a", "b"), factors=(1.0, 0.8), polarity=("-", "+")).as_motion(parts)
    np.testing.assert_array_equal(each.horizontal[:400], -parts[0].horizontal)
    np.testing.assert_array_equal(each.horizontal[-400:], 0.8 * parts[1].horizontal)
    assert each.notes[:2] == ("shock 1, a: times 1, reversed", "shock 2, b: times 0.8")
    times = [t for shock in each.shocks for t in (shock.start, shock.end, shock.until)]
    assert times == pytest.approx([0.0, 3.99, 23.99, 23.99, 27.98, 47.98])


def test_a_sequence_is_scaled_to_a_target_as_one_and_pulses_are_not(tmp_path):
    of_pulses = {"name": "pulses", "records": ["one-sine", "one-cosine"]}
    made = study(tmp_path, TWO, of_pulses, pulses=[SINE, COSINE], target={"pga_g": 0.5}, select={"pga_g": [0.1, 1.0]})
    found = ground_motions(made)
    assert names(found.motions) == ["two", "pulses"]
    assert found["two"].pga_g == pytest.approx(0.5)
    first, second = found["two"].horizontal[:400], found["two"].horizontal[-400:]
    assert np.abs(second).max() / np.abs(first).max() == pytest.approx(1.4, rel=1e-3)
    assert (found["pulses"].pga_g, found["pulses"].dt) == (pytest.approx(1.0, rel=0.01), 0.01)


def test_a_sequence_of_what_cannot_be_used_is_a_row_with_the_reason(tmp_path):
    made = study(tmp_path, TWO)
    (tmp_path / "records" / "RSN2_B_000.AT2").write_text("PEER NGA STRONG MOTION DATABASE RECORD\nnothing\n")
    found = ground_motions(made)
    assert names(found.motions) == ["RSN1_A_000", "RSN1_A_090"]
    (reason,) = [each.reason for each in found.unusable if each.name == "two"]
    assert reason.startswith('sequence "two": its record RSN2_B_000 cannot be used: ')


@pytest.mark.parametrize(
    ("sequences", "said"),
    [
        (
            [TWO | {"records": ["RSN1_A_000", "RSN2_B_0000"]}],
            'there is no record "RSN2_B_0000"; did you mean "RSN2_B_000"?',
        ),
        ([TWO | {"records": ["nothing like it"]}], "`rockbatch motions PATH` lists them"),
        ([TWO | {"name": "RSN1_A_090"}], r'\[\[motions.sequence\]\] "RSN1_A_090": a record has this name'),
        ([TWO, TWO], 'name = "two": given twice; give each sequence its own name'),
        ([TWO | {"factors": [1.0, 2.0, 3.0]}], "factors: 3 given for 2 records; write one for each, or one for all"),
        ([TWO | {"pause_s": 0}], "pause_s = 0: expected a number above 0"),
        ([TWO | {"pause_s": 3600}], 'more than 600 s: .*write confirm = \\["pause_s"\\]'),
        ([TWO | {"polarity": ["up"]}], 'polarity = "up": expected one of'),
        ([TWO | {"pause": 5}], "pause: unknown key; did you mean pause_s"),
        ([{"name": "two"}], "records is missing; write for example records ="),
    ],
)
def test_mistakes_in_a_study_are_answered_with_the_remedy(tmp_path, sequences, said):
    with pytest.raises(InputError, match=said.replace("?", r"\?") if 'did you mean "' in said else said):
        ground_motions(study(tmp_path, *sequences))


# In a manifest


def manifest(folder, text):
    for name, seed in (("RSN1_A_000", 1), ("RSN2_B_000", 3)):
        write_at2(folder, f"{name}.AT2", wiggle(400, seed))
    (folder / "motions.toml").write_text(text, encoding="utf-8")
    return read_motions(folder)


def test_a_manifest_declares_sequences_that_every_reader_of_the_folder_gets(tmp_path):
    text = '[[sequence]]\nname = "{}"\nrecords = ["RSN1_A_000", "{}"]\npause_s = 5.0\n'
    found = manifest(tmp_path, text.format("both", "RSN2_B_000") + text.format("twice", "RSN1_A_000"))
    assert names(found.motions) == ["both", "twice"]
    assert len(found.left_out) == 2
    lone = read_motions(tmp_path / "RSN2_B_000.AT2")
    assert names(lone.motions) == ["RSN2_B_000"]
    assert [(each.name, each.reason[:11]) for each in lone.unusable] == [("both", 'sequence "b')]
    assert [(each.name, each.reason[:15]) for each in lone.left_out] == [("twice", "none of its rec")]


def test_a_manifests_sequence_with_a_records_name_says_so_and_the_rest_is_used(tmp_path):
    text = '[[sequence]]\nname = "{}"\nrecords = ["RSN1_A_000", "RSN1_A_000"]\n'
    found = manifest(tmp_path, text.format("RSN2_B_000") + text.format("twice"))
    assert names(found.motions) == ["RSN2_B_000", "twice"]
    (refused,) = found.unusable
    assert refused.source.endswith("motions.toml")
    assert refused.reason == 'sequence "RSN2_B_000": a record has this name; give the sequence one of its own'


def test_a_manifest_with_a_record_that_is_not_there_says_so_and_the_rest_is_used(tmp_path):
    found = manifest(tmp_path, '[[sequence]]\nname = "both"\nrecords = ["RSN1_A_000", "RSN2_B_00"]\n')
    assert names(found.motions) == ["RSN1_A_000", "RSN2_B_000"]
    assert found.unusable[0].reason.endswith('there is no record "RSN2_B_00"; did you mean "RSN2_B_000"?')
    assert found.unusable[0].source.endswith("motions.toml")
    with pytest.raises(InputError, match=r"motions.toml:3: .*pause_s = -1: expected a number above 0"):
        manifest(tmp_path, '[[sequence]]\nname = "b"\npause_s = -1\nrecords = ["RSN1_A_000"]\n')


def test_a_sequence_has_the_factors_and_confirmations_that_all_its_shocks_share():
    one, other = record("a", factor=2.0, vertical_factor=3.0, confirm=("pga",)), record("b", seed=2, factor=1.5)
    both = rb.sequence([one, other])
    assert (both.factor, both.vertical_factor, tuple(both.confirm)) == (1.0, None, ())
    twice = rb.sequence([one, one])
    assert (twice.factor, twice.vertical_factor, tuple(twice.confirm)) == (2.0, 3.0, ("pga",))


def test_a_strong_sequence_can_be_confirmed_as_a_whole():
    strong = record("a", size=800.0, confirm=("pga",))
    weak = record("b", seed=2)
    (said,) = unlikely_samples(rb.sequence([strong, weak]), 9.81)
    assert said.endswith('write confirm = ["pga"]')
    assert unlikely_samples(rb.sequence([strong, weak], confirm=["pga"]), 9.81) == []


def test_a_sequence_has_the_sources_of_its_shocks_and_is_recorded_if_one_is():
    one = record("a", source="a.AT2", vertical_source="a-UP.AT2")
    pulse = rb.pulse("sine", name="p", amplitude=2.0, period=1.0, dt=0.01, duration=4.0)
    both = rb.sequence([one, pulse, one])
    assert (both.sources, both.source, both.recorded) == (("a.AT2", "a-UP.AT2", "pulse"), "a.AT2, pulse", True)
    assert not rb.sequence([pulse, Motion.still(5.0, 0.01)]).recorded
