"""First-order kinematics where rotations are large: what it neglects, how far that moves the peak, and that the run says so."""

import math

import pandas as pd
import pytest
from report_page import Page
from studies import SINE, study_text, write_study

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.pier import MOST_NEGLECTED, neglected

TENDON = (rb.Tendon(psi=0.5, lam=2.0),)


@pytest.mark.parametrize("alpha", [0.1, 0.2, 0.4])
@pytest.mark.parametrize("mu", [3.0, 4.5])
def test_the_share_is_that_of_the_terms_dropped_between_the_two_equations(alpha, mu):
    """THEORY (5) and (8) about a pivot that stands still, in numbers: R0 = 1, g = 1."""
    b, h, theta = math.sin(alpha), math.cos(alpha), 0.9 * alpha
    of_block = 1.0 / mu + 1.0  # I0/M + R0²
    inertia = 1.0 - (1.0 / mu + h * h + b * (b - h * theta)) / of_block  # v'' = b θ'' on a pivot that stands
    moment = ((b - h * theta) - (b * math.cos(theta) - h * math.sin(theta))) / b
    pier = rb.Pier(alpha, 1.0, mu)
    assert neglected(pier, theta) == pytest.approx(inertia + 0.5 * theta**2, rel=1e-12)
    assert 0.6 * 0.5 * theta**2 < moment < 0.5 * theta**2  # its next term is −h θ³/(6 b)
    assert neglected(pier, -theta) == neglected(pier, theta)


TIED_OR_NOT = [
    (0.2, 2.0, ()), (0.2, 8.0, TENDON), (0.3, 3.0, ()), (0.3, 6.0, TENDON), (0.4, 3.0, TENDON), (0.4, 6.0, ()),
]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    ("alpha", "amplitude", "restraints", "zeta"),
    [
        *((alpha, amplitude, (), None) for alpha, amplitude in ((0.2, 2.0), (0.3, 3.0), (0.4, 6.0))),
        *(pytest.param(*case, 0.1, marks=pytest.mark.thorough) for case in TIED_OR_NOT),
    ],
)
def test_peaks_differ_by_about_the_share_and_have_a_note_beyond_five_percent(alpha, amplitude, restraints, zeta):
    pier = rb.Pier(alpha, 1.0)
    pulse = rb.pulse(
        "sine", name="s", amplitude=amplitude * pier.gravity * math.tan(alpha), period=1.0, dt=0.005, duration=4.0
    )
    rows = {}
    for kinematics in ("first-order", "finite"):
        base = rb.ElasticBase(
            max(30, 6 * pier.least_beta),
            zeta=zeta,
            kinematics=kinematics,
            restraints=restraints,
            flight_limit_mm=1e4,  # so that a high flight adds no remark of its own
        )
        rows[kinematics] = rb.simulate(pier, base, pulse).row
    first, finite = (row["theta_max_over_alpha"] * alpha for row in rows.values())
    share = neglected(pier, first)
    assert abs(first / finite - 1.0) < (1.1 if share < MOST_NEGLECTED else 2.0) * share
    note = rows["first-order"]["note"]
    assert rows["first-order"]["beyond_linearised"] == (share > MOST_NEGLECTED)
    assert (f"a peak of {first:.2g} rad" in note and f"{share:.0%} of inertia" in note) == (share > MOST_NEGLECTED)
    assert pd.isna(rows["finite"]["beyond_linearised"])
    assert rows["finite"]["note"] == ""


def test_a_pier_that_overturns_has_no_peak_to_doubt():
    pier = rb.Pier(0.3, 1.0)
    pulse = rb.pulse("half-sine", name="s", amplitude=2.0 * pier.gravity, period=4.0, dt=0.005, duration=4.0)
    row = rb.simulate(pier, rb.ElasticBase(60.0), pulse).row
    assert row["status"] == "overturned"
    assert (row["beyond_linearised"], row["note"]) == (0, "")


@pytest.mark.usefixtures("pages")
def test_the_terminal_and_the_report_say_so(tmp_path, capsys):
    case = {"name": "springs", "base": "elastic", "beta": 60, "epsilon": 0.1}
    pulses = (SINE, SINE | {"name": "strong", "amplitude_g": 2.5, "period_s": 1.0})
    study = write_study(tmp_path, study_text(pier={"alpha": 0.4, "p": 1.0}, pulses=pulses, cases=(case,)))
    assert main(["run", str(study), "--out", str(tmp_path / "out")]) == 0
    assert "1 run rotates too far for linearised kinematics" in capsys.readouterr().err
    page = Page((tmp_path / "out" / "report.html").read_text(encoding="utf-8"))
    assert "one run of 2: rotations too large for linearised kinematics" in page.text.replace("\u00a0", " ")
    assert page.text.count("linearised kinematics") == 2  # in the sentence, and in the remarks below the table
