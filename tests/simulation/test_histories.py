"""Histories: what simulate returns, and that it belongs to the row of the table."""

import numpy as np
import pytest

import rockbatch as rb

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
        rb.simulate(PIER, rb.YieldingBase(beta=3, eta=0.9, epsilon=2), PULSE)
    assert len(error.value.problems) == 3


def test_a_plot_shows_the_histories_over_their_units_and_each_loop_while_its_spring_is_loaded(response, tmp_path):
    figure = response.plot()
    axes = {ax.get_ylabel(): ax for ax in figure.axes}
    assert list(axes)[:4] == ["θ/α", "θ̇/(αp)", "E [J/kg]", "üg/g"]
    t, rotation = axes["θ/α"].lines[0].get_data()
    assert (t == response.t).all()
    assert rotation == pytest.approx(response.theta / PIER.alpha)
    assert len(axes["θ/α"].lines) == 1 + (response.events["kind"] == "impact").sum()
    loops = figure.axes[4:]
    assert len(loops) == (0 if isinstance(response.base, rb.RigidBase) else 2)
    for ax in loops:
        assert np.nanmax(ax.lines[0].get_ydata()) < 0
    figure.savefig(tmp_path / "response.png")
    assert (tmp_path / "response.png").stat().st_size > 10_000
