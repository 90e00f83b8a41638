"""What each shock of a sequence does: against histories read by other code, and against runs of the shocks so far."""

import numpy as np
import pandas as pd
import pytest
from studies import COSINE, PADS, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.motions import read_motions
from rockbatch.observers.shocks import TABLE
from rockbatch.observers.shocks.table import MEANING, read

PIER = rb.Pier(alpha=0.2, p=1.0)
SOFT = rb.YieldingBase(beta=40, eta=2.0, spring="epp", zeta=0.1)
SPRINGS = rb.ElasticBase(beta=30, zeta=0.2)


def shock(name="sine", amplitude=6.0, period=0.9, duration=4.0):
    return rb.pulse("sine", name=name, amplitude=amplitude, period=period, dt=0.01, duration=duration)


def of(base, *parts, pause=30.0, **more):
    return rb.simulate(PIER, base, rb.sequence(parts, name="s", pause=pause), **more)


@pytest.mark.parametrize("base", [rb.RigidBase(), SPRINGS], ids=["rigid", "elastic"])
def test_two_equal_shocks_give_equal_peaks_if_the_pier_is_at_rest_between(base):
    found = of(base, shock(), shock(), pause=120.0).shocks
    assert found["moving_over_alpha"][0] < 1e-6
    first, second = found["theta_max_over_alpha"]
    assert first > 0.1
    assert second == pytest.approx(first, rel=1e-5)
    assert found["t_max_s"][1] - found["t_max_s"][0] == pytest.approx(124.0, abs=1e-3)


def independent(response, motion):
    """Peak, its time and settlement of each shock, from the columns of a history alone."""
    history, pier, base = response.history, response.pier, response.base
    ends = [*(s.start for s in motion.shocks[1:]), motion.shocks[-1].end + 6.0]
    deflection = base.eta * pier.gravity / (base.beta * pier.p) ** 2
    rows = []
    for s, end in zip(motion.shocks, ends, strict=True):
        own = history[(history["t"] >= s.start - 1e-9) & (history["t"] < end - 1e-9)]
        largest = own["theta"].abs().idxmax()
        sunk = []
        for side in ("left", "right"):
            borne = history[: own.index[-1] + 1]
            borne = borne[borne[f"force_{side}"] < 0.0]
            sunk.append(-(borne[f"v_{side}"] - deflection * borne[f"z_{side}"]).iloc[-1])
        quiet = own[own["t"] >= end - 0.25 * (end - s.end)]["theta"]
        rows.append((abs(own["theta"][largest]), own["t"][largest], np.mean(sunk), (quiet.max() - quiet.min()) / 2))
    return rows


@pytest.mark.slow
def test_the_numbers_are_those_of_the_history_read_by_other_code():
    found = read_motions("motions/near_fault")
    motion = rb.sequence([found["CHAN15"], found["CHAN24"], found["CHAN15"]], pause=6.0, factors=[2.0, 2.0, 1.0])
    base = rb.YieldingBase(beta=40, eta=2.0, spring="epp")
    pier = rb.Pier(alpha=0.16, p=0.9)
    response = rb.simulate(pier, base, motion, quiet_s=6.0)
    table = response.shocks
    for i, (theta, t, sunk, moving) in enumerate(independent(response, motion)):
        row = table.iloc[i]
        assert row["shock_status"] == "ok"
        assert row["theta_max_over_alpha"] * pier.alpha == pytest.approx(theta, rel=1e-3)
        assert row["theta_max_over_alpha"] * pier.alpha >= theta * (1 - 1e-12)
        assert row["t_max_s"] == pytest.approx(t, abs=motion.dt)
        assert row["settlement_m"] == pytest.approx(sunk, abs=1e-9)
        assert row["moving_over_alpha"] * pier.alpha == pytest.approx(moving, rel=1e-3)
    assert table["theta_max_over_alpha"].max() == response.row["theta_max_over_alpha"]
    assert table["theta_max_error"].between(0.0, 1e-3).all()


def test_what_is_left_after_each_shock_is_what_a_run_of_the_shocks_so_far_ends_with():
    parts = [shock("a", 7.0), shock("b", 5.0, 1.3), shock("c", 8.0, 0.7)]
    table = of(SOFT, *parts, pause=60.0).shocks
    for n in (1, 2, 3):
        so_far = of(SOFT, *parts[:n], pause=60.0)
        row = table.iloc[n - 1]
        last = so_far.shocks.iloc[-1]
        for column in ("theta_max_over_alpha", "theta_res_over_alpha", "settlement_m"):
            assert row[column] == pytest.approx(last[column], rel=1e-3)
        assert row["settlement_m"] >= so_far.settlement * (1.0 - 1e-9)  # peaks.csv reads it while the pier still rocks


def test_a_base_that_yields_settles_with_every_shock_and_never_rises():
    settled = of(SOFT, *[shock(amplitude=7.0)] * 4, pause=40.0).shocks["settlement_m"]
    assert len(settled) == 4
    assert (settled.diff(1).fillna(settled.iloc[0]) > 1e-6).all()


@pytest.mark.parametrize(
    "base",
    [
        rb.YieldingBase(60, eta=0.8, spring="backbone", backbone=((1.0, 1.0), (2.0, 1.5), (3.0, 1.8)), epsilon=0.1),
        rb.YieldingBase(60, eta=1.5, spring="hardening", n=1.0, epsilon=0.1),
        rb.YieldingBase(60, eta=1.2, epsilon=0.1),
    ],
    ids=["backbone", "hardening", "bouc-wen"],
)
def test_what_supports_have_sunk_under_the_weight_is_no_settlement_of_a_shock(base):
    still = rb.Motion.still(0.05, 0.01)
    response = rb.simulate(PIER, base, rb.sequence([still, still], name="s", pause=0.1))
    assert response.settlement == pytest.approx(0.0, abs=1e-12)
    assert response.shocks["settlement_m"].to_numpy() == pytest.approx(
        0.0, abs=1e-12
    )  # 0.2 to 1.8 mm with the first sinking


def test_the_settlement_of_a_shock_counts_from_before_the_pull_to_a_rotation():
    pier = rb.Pier(alpha=0.2, p=1.0, initial_rotation_rad=0.05)
    base = rb.YieldingBase(40, eta=1.5, spring="hardening", n=1.0, zeta=0.1)
    still = rb.Motion.still(0.5, 0.01)
    response = rb.simulate(pier, base, rb.sequence([still, still], name="s", pause=60.0))
    last = response.shocks.iloc[-1]
    assert response.settlement > 1e-4
    assert last["settlement_m"] == pytest.approx(response.settlement, rel=1e-3)


def test_an_elastic_base_has_no_residual_and_a_rigid_one_without_dampers_none_at_all():
    assert of(SPRINGS, shock(), shock()).shocks[["theta_res_over_alpha", "settlement_m"]].eq(0.0).all(axis=None)
    assert of(rb.RigidBase(), shock(), shock()).shocks[["theta_res_over_alpha", "settlement_m"]].isna().all(axis=None)


@pytest.mark.slow
def test_dampers_that_hold_a_tilt_hold_it_until_the_next_shock():
    base = rb.RigidBase(restraints=(rb.Damper("friction", f=0.6),))
    table = of(base, shock(amplitude=9.0), shock(amplitude=9.0), pause=40.0).shocks
    alone = of(base, shock(amplitude=9.0), pause=40.0)
    assert abs(table["theta_res_over_alpha"][0]) > 1e-3
    assert table["theta_res_over_alpha"][0] == pytest.approx(alone.row["theta_res_over_alpha"], rel=1e-6)


def test_the_shock_that_overturns_is_named_and_what_follows_is_not_reached():
    table = of(rb.RigidBase(), shock(amplitude=5.0), shock(amplitude=25.0, period=2.5), shock()).shocks
    assert list(table["shock_status"]) == ["ok", "overturned", "not reached"]
    assert table["theta_max_over_alpha"][1] > 1.0
    assert table.iloc[2][["theta_max_over_alpha", "settlement_m"]].isna().all()


def test_a_motion_that_is_no_sequence_has_no_shocks():
    assert rb.simulate(PIER, rb.RigidBase(), shock()).shocks is None


# The table beside the peaks

SEQUENCE = {
    "name": "both",
    "records": ["one-sine", "one-cosine"],
    "pause_s": 10.0,
    "factors": [1.0, 1.5],
    "alone": True,
}


def study(folder, name="study.toml", **more):
    motions = {"sequence": [SEQUENCE], "polarity": ["+", "-"], "scale": [1.0, 1.2]} | more
    text = study_text(
        motions=motions, pulses=[SINE, COSINE], cases=[RIGID, PADS | {"beta": [40, 50]}], output={"histories": "none"}
    )
    return write_study(folder, text, name)


@pytest.mark.slow
def test_the_table_has_a_row_for_each_shock_of_each_run_that_was_simulated(tmp_path):
    path, out = study(tmp_path), tmp_path / "out"
    peaks = rb.run(path, out=out, jobs=1)
    results = rb.open_results(out)
    table = results.shocks
    rb.run(path, out=tmp_path / "two", jobs=2)
    assert (out / TABLE).read_bytes() == (tmp_path / "two" / TABLE).read_bytes()
    assert table["shock_record"].tolist()[:2] == ["one-sine", "one-cosine"]
    assert list(table) == ["record", "case", "polarity", "scale", "beta", *MEANING]
    assert len(table) == 2 * 2 * 3  # shocks, scales, cases; the other polarity is the mirror image
    assert set(table["record"]) == {"both"}
    own = peaks[(peaks["record"] == "both") & (peaks["polarity"] == "+")]
    most = table.groupby(["case", "beta", "scale"], dropna=False)["theta_max_over_alpha"].max()
    for _, row in own.iterrows():
        key = (row["case"], row["beta"], row["scale"])
        same = most[[k for k in most.index if all(a == b or (a != a and b != b) for a, b in zip(k, key, strict=True))]]
        assert same.iloc[0] == row["theta_max_over_alpha"]
    loaded = rb.load_study(path)
    motions = rb.sequence(
        [spec.motion(9.81) for spec in loaded.motions.pulses], name="both", pause=10.0, factors=[1.0, 1.5]
    )
    pads = next(case for case in loaded.cases if case.columns.get("beta") == 50)
    alone = rb.simulate(pads.pier, pads.base, motions.times(1.2)).shocks
    written = table[(table["beta"] == 50) & (table["scale"] == 1.2)].reset_index(drop=True)
    pd.testing.assert_frame_equal(written[list(MEANING)], alone[list(MEANING)], rtol=1e-9, check_dtype=False)


def test_the_table_goes_when_the_study_has_no_sequence_any_more(tmp_path):
    out = tmp_path / "out"
    rb.run(study(tmp_path, scale=1.0), out=out)
    assert (out / TABLE).exists()
    text = study_text(pulses=[SINE], cases=[RIGID], output={"histories": "none"})
    rb.run(write_study(tmp_path, text), out=out, fresh=True)
    assert not (out / TABLE).exists()
    with pytest.raises(rb.InputError, match=r"shocks.csv: not there; add a \[\[motions.sequence\]\]"):
        _ = rb.open_results(out).shocks


@pytest.mark.parametrize("restraints", [(), (rb.Damper("friction", f=0.05),)], ids=["free", "held"])
def test_a_shock_leaves_the_pier_where_supports_or_dampers_hold_it(restraints):
    """Moments on supports that tilt by φ: M (β p)² b² (θ − φ) = M g h θ; dampers hold it amid a pause's last quarter."""
    base = rb.YieldingBase(beta=40, eta=2.0, spring="epp", restraints=restraints)
    motion = rb.sequence([shock("a", 8.0), shock("b", 5.0, 1.3)], name="s", pause=5.0)
    response = rb.simulate(PIER, base, motion, quiet_s=5.0, substeps=8)
    history, b, deflection = response.history, PIER.half_width, base.eta * PIER.gravity / (base.beta * PIER.p) ** 2
    left, right = (history[f"v_{side}"] - deflection * history[f"z_{side}"] for side in ("left", "right"))
    stiff = (base.beta * PIER.p * b) ** 2
    for i, s in enumerate(motion.shocks):
        row, before = response.shocks.iloc[i], history["t"] < s.until - 1e-9
        quiet = history["theta"][(history["t"] >= s.until - 0.25 * (s.until - s.end)) & (history["t"] < s.until + 1e-9)]
        high, low = quiet.max(), quiet.min()
        unstressed = [
            level[before & (history[f"force_{side}"] < 0.0)].iloc[-1]
            for side, level in (("left", left), ("right", right))
        ]
        tilt = (unstressed[0] - unstressed[1]) / (2.0 * b)
        rests = 0.5 * (high + low) if restraints else tilt / (1.0 - PIER.gravity * PIER.height / stiff)
        assert row["theta_res_over_alpha"] * PIER.alpha == pytest.approx(rests, rel=1e-6, abs=1e-9)
        assert row["settlement_m"] == pytest.approx(-0.5 * sum(unstressed), rel=1e-9)
        assert row["moving_over_alpha"] * PIER.alpha == pytest.approx(0.5 * (high - low), rel=1e-3)
        assert abs(rests) > 1e-5


def test_a_table_without_a_varied_key_is_refused(tmp_path):
    (tmp_path / TABLE).write_text(",".join(["record", "case", "polarity", "scale", *MEANING]) + "\n", encoding="utf-8")
    with pytest.raises(rb.InputError, match=r"shocks\.csv: column eta is missing"):
        read(tmp_path, ["eta"])
