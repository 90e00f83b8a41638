"""Histories: what simulate returns, and that it belongs to the row of the table."""

import pickle
from itertools import pairwise

import numpy as np
import pandas as pd
import pytest
from studies import PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common.figures.description import Look, Points, Polyline, Rule, Words, sign_of
from rockbatch.outcome.figures import MOST_LANES, Drawn, History, of_one, reduced, together
from rockbatch.simulation import restraints

PIER = rb.Pier(0.2, 1.0)
PULSE = rb.pulse("sine", name="one-sine", amplitude=9.81, period=0.5, dt=0.005, duration=6.0)
BASES = {
    "rigid": rb.RigidBase(),
    "elastic": rb.ElasticBase(beta=50, epsilon=0.1),
    "yielding": rb.YieldingBase(beta=50, eta=2.2, epsilon=0.1),
    "finite": rb.YieldingBase(beta=50, eta=2.2, epsilon=0.1, kinematics="finite", spring="epp"),
}


@pytest.fixture(params=BASES, scope="module")
def response(request):
    return rb.simulate(PIER, BASES[request.param], PULSE, quiet_s=0.0)


def test_a_history_has_every_sample_and_both_sides_of_every_event(response):
    t = response.t
    samples = np.arange(PULSE.npts) * PULSE.dt
    assert (np.diff(t) >= 0).all()
    assert np.abs(t[:, None] - samples[None, ::100]).min(axis=0).max() < 1e-9
    for event in response.events.itertuples():
        if event.kind == "impact":
            assert (np.abs(t - event.t) < 1e-12).sum() >= 2


def test_rotation_is_continuous_and_angular_velocity_its_derivative(response):
    """Between rows that are not an event apart, Simpson's bound on the trapezoid: h² |θ⃛|/12 ~ 1e-5 of the largest step."""
    t, theta, omega = response.t, response.theta, response.omega
    step = np.diff(t)
    by_trapezoid = 0.5 * (omega[1:] + omega[:-1]) * step
    assert np.abs(np.diff(theta) - by_trapezoid).max() < 2e-6
    assert np.abs(np.diff(theta)).max() > 1e-4


def test_a_positive_pulse_throws_the_pier_to_the_left_first(response):
    moving = np.flatnonzero(np.abs(response.theta) > 1e-4)
    assert response.theta[moving[0]] < 0


def test_the_ground_of_a_history_is_the_motion(response):
    at = np.round(response.t / PULSE.dt, 6)
    on_sample = at == np.round(at)
    samples = at[on_sample].astype(int)
    expected = np.where(samples < PULSE.npts, PULSE.horizontal[np.minimum(samples, PULSE.npts - 1)], 0.0)
    assert response.history["ag_h"].to_numpy()[on_sample] == pytest.approx(expected, abs=1e-9)


def test_springs_stay_within_their_law():
    response = rb.simulate(PIER, BASES["yielding"], PULSE)
    for z in (response.z_left, response.z_right):
        assert z.min() >= -1.0
        assert z.max() <= 1e-15  # separation is located to rounding
        assert z[0] == pytest.approx(-1 / 2.2, rel=1e-14)


def test_forces_of_damped_supports_follow_deflections_and_reach_the_row():
    """F/M = ω_v² v/2 + ζ ω_v dv/dt with ω_v = β p of both supports, the rate by differences: 0.02 m/s² are their error."""
    t, base = 0.01 * np.arange(500), rb.ElasticBase(30.0, zeta=0.1)
    motion = rb.Motion("shaken", 0.01, 2.4 * np.sin(4.0 * t), 3.0 * np.sin(11.0 * t))
    response = rb.simulate(PIER, base, motion, substeps=4, forces=True)
    history, frequency = response.history, 30.0 * PIER.p
    steps = np.diff(history["t"])
    even = np.r_[False, (np.abs(np.diff(steps)) < 1e-9) & (steps[1:] > 0.005), False]
    sides = [history[f"v_{side}"].to_numpy() for side in ("left", "right")]
    np.testing.assert_allclose(sides[0] - sides[1], 2.0 * PIER.half_width * response.theta, atol=1e-12)
    np.testing.assert_allclose(sides[0] + sides[1], 2.0 * response.v, atol=1e-12)
    for side, v in zip(("left", "right"), sides, strict=True):
        force = history[f"force_{side}"].to_numpy()
        borne = even & (force < 0.0) & (np.roll(force, 1) < 0.0) & (np.roll(force, -1) < 0.0)
        assert borne.sum() > 150
        with np.errstate(invalid="ignore", divide="ignore"):  # both sides of an event have one time
            rate = np.gradient(v, history["t"])
        law = 0.5 * frequency**2 * v + 0.1 * frequency * rate
        np.testing.assert_allclose(force[borne], law[borne], atol=0.02)
        peak = response.row[f"pivot_force_{side}"] * PIER.gravity / 2.0  # over half of the weight
        assert -force.min() == pytest.approx(peak, rel=2e-3)
        assert -force.min() <= peak


@pytest.mark.slow
def test_energy_starts_at_zero_and_is_kept_between_impacts_of_elastic_springs():
    """After the pulse, on elastic springs with ε = 1 and finite kinematics, only changes of H alter the stored energy.

    In full contact and while one pivot is free it is constant: 1e-5 of its size is the step's error.
    """
    base = rb.ElasticBase(beta=50, epsilon=1.0, kinematics="finite", flight="guided")
    response = rb.simulate(PIER, base, PULSE, substeps=8)
    assert response.energy[0] == 0.0
    after = response.t > 0.6
    t, energy = response.t[after], response.energy[after]
    events = response.events["t"].to_numpy()
    pieces = np.searchsorted(events, t, side="right")
    inside = [energy[pieces == piece][1:-1] for piece in np.unique(pieces)]
    spread = max(np.ptp(piece) for piece in inside if len(piece) > 2)
    assert energy.max() > 0.1
    assert spread < 1e-5


def test_an_impossible_pier_is_refused_with_the_limit():
    with pytest.raises(rb.InputError, match="beta must be above") as error:
        rb.simulate(PIER, rb.YieldingBase(beta=3, eta=2.0), PULSE)
    assert len(error.value.messages) == 1
    with pytest.raises(rb.InputError) as error:
        rb.YieldingBase(beta=3, eta=0.9, epsilon=2)
    assert len(error.value.messages) == 2


def test_the_figure_shows_histories_in_units_and_loops_of_loaded_springs(response, tmp_path):
    panels = of_one(response, "title").panels
    assert [panel.y.plain for panel in panels[:4]] == ["θ/α", "θ̇/(αp)", "E/M [J/kg]", "üg/g"]
    rotation, *events = panels[0].marks
    expected = response.theta / PIER.alpha
    omega, ground = response.omega / (PIER.alpha * PIER.p), response.history["ag_h"].to_numpy() / PIER.gravity
    for panel, values in zip(panels[:4], (expected, omega, response.energy, ground), strict=True):
        line = panel.marks[0]
        assert (line.y.min(), line.y.max()) == (values.min(), values.max())
        assert line.name == panel.y.plain
    assert np.interp(rotation.x, response.t, expected) == pytest.approx(rotation.y)
    at_the_foot = [len(mark.at) for mark in events if isinstance(mark, Rule) and mark.low == 0.0 and mark.high < 0.1]
    assert sum(at_the_foot) == (response.events["kind"] == "impact").sum()
    assert f"{np.abs(expected).max():.4f}" in [mark.text for mark in events if isinstance(mark, Words)]
    loops = panels[4:]
    assert len(loops) == (0 if isinstance(response.base, rb.RigidBase) else 2)
    yields = isinstance(response.base, rb.YieldingBase)
    for loop in loops:
        assert 2 * loop.width <= panels[0].width  # both side by side
        assert (loop.x.plain == "v [mm]", loop.y.plain == "F/(M g)") == (not yields, not yields)
        line, *limit = loop.marks
        assert np.nanmax(line.y) < 0.0
        assert [mark.at.tolist() for mark in limit] == ([[-1.0]] if yields else [])
    response.plot().savefig(tmp_path / "response.png")
    assert (tmp_path / "response.png").stat().st_size > 10_000


def test_a_history_follows_its_devices_once(monkeypatch):
    calls = []
    follow = restraints.device_histories
    monkeypatch.setattr(restraints, "device_histories", lambda *given: calls.append(given) or follow(*given))
    device = rb.Damper("hysteretic", f=0.05, yield_m=0.005)
    response = rb.simulate(PIER, rb.RigidBase(restraints=(device,)), PULSE)
    assert not response.restraints.empty
    assert len(calls) == 1


@pytest.mark.parametrize("width", [160.0, 88.0])
def test_the_figure_shows_the_loop_of_every_damper_and_tendon(width):
    devices = (rb.Damper("hysteretic", f=0.05, yield_m=0.005), rb.Tendon(psi=0.2, lam=0.3))
    response = rb.simulate(PIER, rb.RigidBase(restraints=devices), PULSE)
    loops = {panel.caption: panel.marks for panel in of_one(response, "title").panels[4:]}
    assert {name: [mark.name for mark in marks] for name, marks in loops.items()} == {
        "damper 1": ["F/(M g) right", "F/(M g) left"], "tendon 1": ["F/(M g)"],
    }  # fmt: skip
    histories, *_, one, other = of_one(response, "title").panels
    assert one.width + other.width <= histories.width
    assert [mark.label for mark in loops["damper 1"]] == ["at the right pivot", "at the left pivot"]
    (tendon,) = loops["tendon 1"]
    assert not tendon.label  # it is the only one
    rows = np.isin(1000.0 * response.restraints["tendon 1 elongation"].to_numpy(), tendon.x)
    assert rows.sum() >= len(tendon.x) > 100
    force = response.restraints["tendon 1 force"].to_numpy() / PIER.gravity
    assert (tendon.y.min(), tendon.y.max()) == pytest.approx((force.min(), force.max()), rel=1e-3)
    drawn = response.plot(width)
    drawn.draw_without_rendering()
    assert drawn.get_figwidth() == pytest.approx(width / 25.4)


STUDY = study_text(
    pulses=[SINE | {"dt_s": 0.005, "duration_s": 6.0}],
    cases=[RIGID, PADS | {"name": "yielding", "eta": 2.2, "epsilon": 0.1}],
    numerics={"quiet_s": 0.0},
    output={"both_laws": False, "ledger": True, "forces": True},
)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    rb.run(write_study(folder, STUDY), folder / "out")
    return rb.open_results(folder / "out")


@pytest.mark.parametrize("base", ["rigid", "yielding"])
def test_a_response_has_the_row_of_the_table_simulated_or_opened(finished, base):
    simulated = rb.simulate(PIER, BASES[base], PULSE, quiet_s=0.0, ledger=True, forces=True)
    opened = finished.response(case=base)
    table = finished.peaks[finished.peaks["case"] == base].iloc[0]
    nothing = list(set(table.index) - set(simulated.row.index))  # as forces in kN of a pier without a mass
    assert table[nothing].isna().all()
    for row in (simulated.row, opened.row):
        assert list(row.index) == [name for name in table.index if name in row]
        for name, value in table.drop(nothing).items():
            expected = value if isinstance(value, str) else pytest.approx(value, rel=1e-9, abs=0)
            assert pd.isna(row[name]) if pd.isna(value) else row[name] == expected, name
    assert simulated.theta_max == pytest.approx(opened.theta_max, rel=1e-9)
    assert np.abs(simulated.theta).max() <= simulated.theta_max * (1 + 1e-12)
    assert simulated.theta_max == pytest.approx(np.abs(simulated.theta).max(), rel=1e-3)  # the peak is between samples
    assert 0 < simulated.theta_max_error < 1e-4 * PIER.alpha


def test_what_does_not_apply_is_nan_and_words_are_empty():
    fixed = rb.simulate(PIER, BASES["rigid"], PULSE, substeps=4)
    assert np.isnan([fixed.theta_max_error, fixed.settlement, fixed.theta_res]).all()
    assert (fixed.status, fixed.reason, fixed.note) == ("ok", "", "")
    assert "energy_input_J_kg" not in fixed.row


def test_an_overturned_pier_says_so_in_its_row_and_in_its_repr():
    strong = rb.pulse("sine", name="strong", amplitude=40.0, period=2.0, dt=0.005, duration=2.0, confirm=("amplitude",))
    response = rb.simulate(PIER, BASES["rigid"], strong, case="rock")
    assert response.row["status"] == response.status == "overturned"
    assert repr(response).startswith("<response strong, rock: overturned>")
    assert np.isnan(response.theta_max_error)


def test_a_single_run_is_of_the_motion_as_it_is_whenever_its_histories_are_read(response):
    """Read at once beside forces, or later: by the scale 1 and the polarity +, which neither its words nor its row change."""
    at_once = rb.simulate(PIER, BASES["rigid"], PULSE, quiet_s=0.0, forces=True)
    for one in (response, at_once):
        assert (one.scale, one.polarity, one.row["scale"], one.row["polarity"]) == (1.0, "+", 1.0, "+")
        assert repr(one).startswith(f"<response {PULSE.name}, {one.case}")


def test_a_response_tells_of_itself_in_a_few_lines(response):
    lines = repr(response).splitlines()
    assert len(lines) <= 8
    assert f"{response.theta_max / PIER.alpha:.5f} ± " in lines[1]
    impacts = (response.events["kind"] == "impact").sum()
    assert f"{impacts} × impact" in lines[-1]
    html = response._repr_html_()
    assert html.count("<tr>") == len(lines) - 1
    assert f"{response.theta_max / PIER.alpha:.5f}" in html


def test_a_run_that_would_take_too_long_is_refused_with_the_reason():
    endless = rb.Motion("endless", 0.001, np.zeros(1000))
    with pytest.raises(rb.InputError, match=r"endless: would take .* steps"):
        rb.simulate(PIER, BASES["rigid"], endless, quiet_s=1e9)


def test_histories_alone_say_where_there_is_a_row():
    from dataclasses import replace

    alone = replace(rb.simulate(PIER, BASES["rigid"], PULSE), row=None)
    assert "θ_max" not in repr(alone)
    with pytest.raises(rb.InputError, match="histories alone"):
        _ = alone.theta_max


def test_histories_are_computed_once_when_one_is_asked_for(monkeypatch):
    from rockbatch.simulation import observing

    seen = []

    def recorded(*arguments):
        seen.append(arguments)
        return sides(*arguments)

    sides = observing.recorded_side_by_side
    monkeypatch.setattr(observing, "recorded_side_by_side", recorded)
    damped = rb.RigidBase(restraints=(rb.Damper("friction", f=0.05),))
    response = rb.simulate(PIER, damped, PULSE)
    assert response.row["theta_max_over_alpha"] * PIER.alpha == response.theta_max > 0.0
    assert response.status == "ok"
    assert seen == []
    assert np.abs(response.theta).max() == pytest.approx(response.theta_max, rel=1e-2)
    assert list(response.restraints) == [
        "t",
        *(f"damper 1 {side} {of}" for side in ("left", "right") for of in ("elongation", "force")),
    ]
    assert len(response.events) > 0
    assert len(seen) == 1


@pytest.mark.parametrize("base", ["rigid", "yielding"])
def test_histories_asked_for_later_are_those_beside_an_energy_balance(base):
    later, at_once = (rb.simulate(PIER, BASES[base], PULSE, ledger=ledger) for ledger in (False, True))
    columns = ["t", "theta", "energy"]
    ours = later.history[columns].drop_duplicates("t").set_index("t")
    theirs = at_once.history[columns].drop_duplicates("t").set_index("t")
    pd.testing.assert_frame_equal(ours, theirs.loc[ours.index], check_exact=True)
    assert later.events["kind"].tolist() == at_once.events["kind"].tolist()


def test_a_copy_has_the_histories_and_no_other_attribute_is_made_up():
    response = rb.simulate(PIER, BASES["rigid"], PULSE)
    copied = pickle.loads(pickle.dumps(response))
    pd.testing.assert_frame_equal(copied.history, response.history, check_exact=True)
    assert copied.row.equals(response.row)
    with pytest.raises(AttributeError, match="'Response' object has no attribute 'histroy'"):
        _ = response.histroy


def test_tables_of_a_study_say_the_units_of_their_columns(tmp_path):
    study = write_study(tmp_path, STUDY)
    table = rb.run(study, tmp_path / "out")
    units = table.attrs["units"]
    assert (units["t_max_s"], units["theta_max_over_alpha"], units["settlement_m"]) == ("s", "1", "m")
    assert set(units) <= set(table)
    assert rb.open_results(tmp_path / "out").peaks.attrs["units"] == rb.run(study).attrs["units"] == units
    column = table["t_max_s"]
    column.attrs["units"]["t_max_s"] = "min"
    assert units["t_max_s"] == table.attrs["units"]["t_max_s"] == "s"


def test_tables_say_the_units_of_their_columns():
    response = rb.simulate(PIER, BASES["elastic"], PULSE, forces=True)
    units = response.history.attrs["units"]
    assert list(units) == list(response.history)
    assert dict(units) == {
        "t": "s",
        "theta": "rad",
        "omega": "rad/s",
        "v": "m",
        "z_left": "1",
        "z_right": "1",
        "v_left": "m",
        "v_right": "m",
        "force_left": "N/kg",
        "force_right": "N/kg",
        "energy": "J/kg",
        "ag_h": "m/s^2",
        "ag_v": "m/s^2",
    }
    assert dict(response.forces.attrs["units"]) == {
        "t": "s",
        "base_shear": "m/s^2",
        "normal_force": "m/s^2",
        "base_moment": "m^2/s^2",
        "friction": "1",
        "pivot_left": "1",
        "pivot_right": "1",
        "heel_gap_left": "m",
        "heel_gap_right": "m",
        "heel_speed_left": "m/s",
        "heel_speed_right": "m/s",
        "deck_acceleration": "m/s^2",
    }
    of_impacts = {"t": "s", "landing_velocity": "m/s", "impulse_horizontal": "m/s", "impulse_vertical": "m/s"}
    assert dict(response.impacts.attrs["units"]) == of_impacts
    assert response.history["theta"].attrs["units"] == units


# Piers drawn together


def one_of(
    *, peak=(2.0, 0.5), moving=(1.0, 3.0), status="ok", end=10.0, impacts=(), separations=(), flights=(), look=1
):
    """A history to be drawn, of ten seconds, whose rotation over α has its peak at one moment and swings back at 5 s."""
    t = np.linspace(0.0, 10.0, 101)
    theta = np.where(np.isclose(t, peak[0]), peak[1], np.where(t == 5.0, -0.2 * np.sign(peak[1]), 0.0))
    theta = np.where(np.isclose(t, peak[0] - 0.1) & (status != "ok"), 1.6, theta)
    curves = [(t, theta), (t, 2.0 * theta), (t, 3.0 * theta), (t, moving[1] * np.sin(t))]
    events = (np.array(times, dtype=float) for times in (impacts, separations, flights))
    history = History(status, curves, *events, peak, (end, peak[1]), moving)
    return Drawn(history, f"pier {look}", f"{look}", Look("curve", look), Look("", look, shape="up"))


def test_piers_are_drawn_while_one_of_them_moves_and_a_short_rest_is_not_cut_off():
    first, second = one_of(moving=(1.0, 3.5)), one_of(moving=(2.0, 4.0), look=2)
    figure, whole = together([first, second], "a record")
    assert [(panel.height, panel.width) for panel in figure.panels] == [(200.0, 900.0), (110.0, 900.0), (90.0, 900.0)]
    assert [(panel.x.label, panel.x.numbered) for panel in figure.panels] == [("", False), ("", False), ("t [s]", True)]
    shown = figure.panels[0].x
    assert (shown.low, shown.high) == pytest.approx((1.0 - 0.03 * 3.0, 4.0 + 0.03 * 3.0))  # from the first to the last
    assert (whole.low, whole.high) == (0.0, 10.0)
    (ground,) = figure.panels[-1].marks  # once, of the pier that moves longest
    assert ground.y is first.history.curves[3][1]
    lines = [mark for mark in figure.panels[0].marks if isinstance(mark, Polyline)]
    assert [line.label for line in lines] == ["pier 1: 0.5000 at 2.0 s", "pier 2: 0.5000 at 2.0 s"]
    assert not any(mark.label for mark in figure.panels[1].marks)
    for moving, ends in (((0.5, 8.9), (0.248, 9.152)), ((0.5, 9.4), (0.0, 10.0)), ((0.1, 8.0), (0.0, 8.237))):
        x = together([one_of(moving=moving)], "a record")[0].panels[0].x
        assert (x.low, x.high) == pytest.approx(ends)


@pytest.mark.parametrize("count", [1, 2, 4, 5])
def test_strokes_of_events_stand_in_lanes_of_their_piers_beyond_the_curves(count):
    runs = [one_of(impacts=[1.0, 2.0], separations=[3.0], look=k + 1, peak=(2.0, 0.5 - k)) for k in range(count)]
    panel = together(runs, "a record")[0].panels[0]
    strokes = [mark for mark in panel.marks if isinstance(mark, Rule) and len(mark.at)]
    assert len(strokes) == (2 * count if count <= MOST_LANES else 0)
    assert {mark.label for mark in panel.marks if isinstance(mark, Rule) and not len(mark.at)} == (
        {"impacts, at the foot", "separations, at the top"} if strokes else set()
    )
    drawn = np.concatenate([run.history.curves[0][1] for run in runs])
    lowest, highest = (np.array([drawn.min(), drawn.max()]) - panel.y.low) / (panel.y.high - panel.y.low)
    for at, times in ((0.0, [1.0, 2.0]), (1.0, [3.0])):
        own = [stroke for stroke in strokes if stroke.at.tolist() == times]
        assert [stroke.look.colour for stroke in own] == [k + 1 for k in range(len(own))]
        ends = sorted((stroke.low, stroke.high) for stroke in own)
        assert all(0.0 <= low < high <= 1.0 for low, high in ends)
        assert all(before[1] < after[0] for before, after in pairwise(ends))
        if own:
            assert own[0].low == pytest.approx(0.0) if at == 0.0 else own[0].low > own[-1].low or count == 1
            assert max(high for _, high in ends) < lowest if at == 0.0 else min(low for low, _ in ends) > highest


def test_the_largest_peak_has_its_value_where_there_is_room():
    for t, side in ((7.4, 1), (7.6, -1)):
        small, large = one_of(peak=(3.0, 0.4)), one_of(peak=(t, -0.6), look=2, moving=(0.0, 10.0))
        marks = together([small, large], "a record")[0].panels[0].marks
        (words,) = (mark for mark in marks if isinstance(mark, Words))
        assert (words.x, words.y, words.text, words.side) == (t, -0.6, "0.6000", side)
        points = [(mark.x.tolist(), mark.y.tolist()) for mark in marks if isinstance(mark, Points)]
        assert points == [([3.0], [0.4]), ([t], [-0.6])]
        labels = [mark.label for mark in marks if isinstance(mark, Points)]
        assert labels == ["pier 1: 0.4000 at 3.0 s", f"pier 2: 0.6000 at {t} s"]
    still = together([one_of(peak=(0.0, 0.0))], "a record")[0].panels[0].marks
    assert not any(
        isinstance(mark, Points | Words) for mark in still
    )  # one that stayed at rest has no largest rotation
    fallen = one_of(peak=(6.0, 7.0), status="overturned", look=2)
    panel = together([small, fallen], "a record")[0].panels[0]
    assert 0.4 < panel.y.high < 0.7  # not stretched by the one that fell
    (end,) = (mark for mark in panel.marks if isinstance(mark, Points) and mark.label == "overturned")
    assert (end.x.tolist(), end.y.tolist(), end.look) == ([10.0], [panel.y.high], sign_of("overturned"))
    (line,) = (mark for mark in panel.marks if isinstance(mark, Polyline) and "pier 2" in mark.label)
    assert line.label == "pier 2: overturned at 10.0 s"
    alone = together([fallen], "a record")[0].panels[0]
    assert alone.y.high < 2.0  # nor by its own way down
    flown = together([one_of(flights=[4.0]), one_of(flights=[5.0])], "a record")[0].panels[0].marks
    assert [mark.at.tolist() for mark in flown if isinstance(mark, Rule) and mark.look.kind == "flown"] == [[4.0, 5.0]]


def test_a_pier_moves_from_where_it_leaves_its_rest_to_where_it_stays(response):
    """Away from rest is a fiftieth of the largest rotation; the drawn curve keeps the rows' extremes and ends."""
    drawn = reduced(response, Look("curve"))
    t, theta = response.t, response.theta / PIER.alpha
    least = 0.02 * np.abs(theta).max()
    assert drawn.moving == (t[np.abs(theta) > least][0], t[np.abs(theta - theta[-1]) > least][-1])
    assert drawn.peak == (t[np.abs(theta).argmax()], theta[np.abs(theta).argmax()])
    assert drawn.end == (t[-1], theta[-1])
    assert drawn.outcome == f"{np.abs(theta).max():.4f} at {drawn.peak[0]:.1f} s"
    omega = response.omega / (PIER.alpha * PIER.p)
    for (x, y), values in zip(drawn.curves[:2], (theta, omega), strict=False):
        assert (y.min(), y.max(), x[0], x[-1]) == (values.min(), values.max(), t[0], t[-1])
        assert len(x) < 2 * 2 * 900
    kinds = response.events["kind"]
    for times, own in ((drawn.impacts, kinds == "impact"), (drawn.separations, kinds.isin(["separation", "lift-off"]))):
        grain = (drawn.moving[1] - drawn.moving[0]) / 900
        assert (
            np.abs(times[:, None] - response.events["t"][own].to_numpy()).min(axis=1, initial=np.inf).max(initial=0.0)
            <= 0.51 * grain
        )
        assert len(times) <= own.sum()
