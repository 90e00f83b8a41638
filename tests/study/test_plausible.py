"""Values that only a wrong unit explains: told with what is usual, and taken once they are confirmed."""

import re
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import rockbatch as rb
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.motions import MotionSet
from rockbatch.motions.spectrum import spectral_acceleration
from rockbatch.motions.suites.design_spectra import TableSpectrum
from rockbatch.motions.suites.scaling import at_target
from rockbatch.motions.suites.spectrum_target import SpectrumTarget
from rockbatch.pier import unlikely_devices
from rockbatch.study import load_study, target_keys

PULSE = (
    '[[motions.pulse]]\nname = "sine"\nshape = "sine"\namplitude_g = 0.2\nperiod_s = 1.0\ndt_s = 0.01\nduration_s = 2\n'
)
PARTS = {
    "pier": "[pier]\nwidth_m = 4\nheight_m = 30\nmass_t = 3000\n",
    "numerics": "[numerics]\ntolerance = 1e-4\n",
    "case": '[[case]]\nname = "pads"\nbase = "yielding"\nstiffness_kN_m = 2e6\nyield_kN = 4e4\n',
    "check": '[[check]]\nname = "uplift"\ndemand = "heel_uplift_m"\nat_most = 0.1\nreason = "keys"\n',
}
THETA = ('demand = "heel_uplift_m"\nat_most = 0.1', 'demand = "theta_max_over_alpha"\nat_most = 50')
DAMPER = '[[case.damper]]\nkind = "friction"\nforce_kN = 500\n'  # of the case above the check
FOUND = [  # part, what stands there, what shall, its key, and what is said
    ("pier", "mass_t = 3000", "mass_t = 3000\ntop_m = 31500", "top_m", "[pier]: top_m = 31500: more than 400 m"),
    ("pier", "mass_t = 3000", "mass_t = 2e3\ndeck_mass_t = 2e6", "deck_mass_t", "[pier]: deck_mass_t = 2e+06: more than"),
    ("pier", "mass_t = 3000", "[[pier.part]]\nmass_t = 3000\nheight_m = 1500\ninertia_t_m2 = 2e5", "height_m",
     "[[pier.part]] no. 1: height_m = 1500: more than 400 m"),
    ("numerics", "1e-4", "100", "tolerance", "[numerics]: tolerance = 100: more than 0.1 of theta_max/alpha"),
    ("case", "4e4", "[4e4, 37e6]", "yield_kN",
     '[[case]] "pads": yield_kN = 3.7e+07: 2.51e+03 times what the support carries at rest, where 2 to 20'),
    ("check", "at_most = 0.1", "at_most = 100", "at_most",
     '[[check]] "uplift": at_most = 100: heel_uplift_m above 0.5302 is past the edge of overturning, so the limit decides'),
    ("check", *THETA, "at_most", '[[check]] "uplift": at_most = 50: theta_max_over_alpha above 1 is past the edge'),
    ("check", *(each.replace("theta_max_over_alpha", "top_drift_m") for each in THETA), "at_most",
     '[[check]] "uplift": at_most = 50: top_drift_m above 3.977 is past the edge'),
    ("check", *(each.replace("theta_max_over_alpha", "settlement_m") for each in THETA), "at_most",
     '[[check]] "uplift": at_most = 50: settlement_m above 4 is more than the pier is wide'),
    ("check", THETA[0], 'demand = "eta"\nat_least = 2500', "at_least", '[[check]] "uplift": at_least = 2500: eta above 100'),
    ("pier", "width_m = 4\nheight_m = 30", "height_m = 4\nwidth_m = 30", "width_m",
     "[pier]: width_m = 30: more than the height, 4 m: such a block lifts off at 7.5 g only"),
    ("pier", "mass_t = 3000", "mass_t = 3000\ntop_m = 300", "top_m",
     "[pier]: top_m = 300: 10 times the height of the pier, 30 m"),
    ("pier", "mass_t = 3000", "mass_t = 2e3\ndeck_mass_t = 1e3\ndeck_height_m = 3", "deck_height_m",
     "[pier]: deck_height_m = 3: 0.1 times the height of the pier"),
    ("pier", "mass_t = 3000", "mass_t = 2e3\ndeck_mass_t = 1e3\ndeck_height_m = 310", "deck_height_m",
     "[pier]: deck_height_m = 310: 10 times the height of the pier"),
    ("check", "at_most = 0.1", 'statistic = "count"\nabove = 100\nat_most = 2', "above",
     '[[check]] "uplift": above = 100: heel_uplift_m above 0.5302 is past the edge'),
    ("pier", "mass_t = 3000", "mass_t = 3\ndeck_mass_t = 900", "deck_mass_t",
     "[pier]: deck_mass_t = 900: 300 times the mass of the pier, mass_t = 3"),
    ("pier", "mass_t = 3000", "mass_t = 2e3\ndeck_mass_t = 1.2", "deck_mass_t",
     "[pier]: deck_mass_t = 1.2: 0.0006 times the mass of the pier, mass_t = 2000"),
    ("pier", "mass_t = 3000", "mass_t = 30\ncolumns = 2\ndeck_mass_t = 9000", "deck_mass_t",
     "[pier]: deck_mass_t = 9000: 150 times the mass of the pier, mass_t = 60"),
    ("pier", "height_m = 30\nmass_t = 3000", "deck_mass_t = 900\ndeck_height_m = 30\n[[pier.part]]\nmass_t = 1.8\nheight_m = 15",
     "deck_mass_t",
     "[pier]: deck_mass_t = 900: 500 times the mass of the pier, mass_t = 1.8"),
    ("check", THETA[0], 'demand = "heel_uplift_mm"\nat_most = 0.15', "at_most",
     '[[check]] "uplift": at_most = 0.15: in mm, as heel_uplift_mm is, hardly more than nothing; 0.15 m are 150 mm'),
    ("check", THETA[0], 'demand = "top_drift_mm"\nat_most = 1.2', "at_most", '[[check]] "uplift": at_most = 1.2: in mm, as'),
    ("check", f'[[check]]\nname = "uplift"\n{THETA[0]}',
     f'{DAMPER}[[check]]\nname = "uplift"\ndemand = "damper_stroke_m"\nat_most = 60', "at_most",
     '[[check]] "uplift": at_most = 60: damper_stroke_m above 4 is more than the pier is wide'),
]  # fmt: skip


def written(folder, **changed):
    path = folder / "study.toml"
    path.write_text(PULSE + "".join((PARTS | changed)[name] for name in PARTS), encoding="utf-8")
    return path


def problems_of(path):
    """What is said about a study; nothing where it is right."""
    try:
        load_study(path)
    except InputError as error:
        return error.messages
    return ()


def at_the_key(text, new, key):
    """``text`` with a line that confirms ``key`` below the last of ``new``, which is of the same table."""
    own, part, inner = new.partition("\n[[pier.part]]")
    own, inner = (own, part + inner) if key in own else (new, "")
    return text.replace(new, f'{own}\nconfirm = ["{key}"]{inner}')


@pytest.mark.parametrize(("part", "old", "new", "key", "said"), FOUND)
def test_what_only_a_wrong_unit_explains_is_refused_until_it_is_confirmed(tmp_path, part, old, new, key, said):
    assert old in PARTS[part]
    text = PARTS[part].replace(old, new)
    (problem,) = (each for each in problems_of(written(tmp_path, **{part: text})) if f": {said}" in each)
    assert problem.endswith(f'check the unit; if it is right, write confirm = ["{key}"] in this table')
    line = int(problem.removeprefix(f"{tmp_path / 'study.toml'}:").partition(":")[0])
    assert key in (tmp_path / "study.toml").read_text().splitlines()[line - 1]
    confirmed = problems_of(written(tmp_path, **{part: at_the_key(text, new, key)}))
    assert not any(f": {said}" in each for each in confirmed)  # others may follow from it, as of a pier of 4 km × 30 m


def test_the_mass_of_a_case_is_judged_too(tmp_path):
    pier = PARTS["pier"].replace("mass_t = 3000\n", "")
    case = PARTS["case"].replace("2e6", "2e9") + "mass_t = 3e6\n"
    problem, *_ = problems_of(written(tmp_path, pier=pier, case=case.replace("4e4", "4e7")))
    assert '[[case]] "pads": mass_t = 3e+06: more than 1e+06 t' in problem
    believed = at_the_key(case.replace("4e4", "4e7"), "mass_t = 3e6", "mass_t")
    assert problems_of(written(tmp_path, pier=pier, case=believed)) == ()


@pytest.mark.parametrize(("limit", "refused"), [(0.9, True), (0.75, True), (0.749, False), (0.5, False)])
@pytest.mark.parametrize("strength", ["bearing_MPa = 0.75", "safety_factor = {factor!r}", ""])
def test_a_pressure_that_the_bed_never_exceeds_is_no_limit(tmp_path, limit, refused, strength):
    """The bed yields at 0.75 MPa, which is its safety factor times the weight over the area, 4 × 10 m; an elastic bed never."""
    factor = 0.75e3 * 40.0 / (3000.0 * 9.81)
    case = f'[[case]]\nbase = "footing"\nstiffness_MN_m3 = 60\nlength_m = 10\n{strength.format(factor=factor)}\n'
    check = f'[[check]]\nname = "ground"\ndemand = "bed_pressure_MPa"\nat_most = {limit}\nreason = "report"\n'
    said = problems_of(written(tmp_path, case=case, check=check))
    assert bool(said) is (refused and bool(strength))
    if said:
        (problem,) = said
        assert (
            f"at_most = {limit:g}: bed_pressure_MPa above 0.75 does not occur, as the bed yields there, so the limit"
            in problem
        )
        assert "; limit edge_settlement_m or yielding_half_cycles instead, or" in problem
        assert problem.endswith('write confirm = ["at_most"] in this table')
        advised = check.replace("bed_pressure_MPa", "yielding_half_cycles").replace(f"= {limit}", "= 0")
        assert problems_of(written(tmp_path, case=case, check=advised)) == ()


def test_a_study_that_is_confirmed_runs(tmp_path):
    """Stiff as a laboratory's floor, and a limit that is not meant to bite."""
    case = at_the_key(PARTS["case"].replace("4e4", "37e6"), "37e6", "yield_kN")
    check = at_the_key(PARTS["check"].replace("0.1", "100"), "at_most = 100", "at_most")
    study = load_study(written(tmp_path, case=case, check=check))
    assert study.cases[0].base.eta == pytest.approx(2 * 37e6 / (3000 * 9.81))
    assert study.checks[0].confirm == ("at_most",)
    assert main(["run", str(study.path), "--out", str(tmp_path / "out")]) == 0


def test_what_is_usual_passes(tmp_path):
    """The ends of what is usual, and a limit at the edge of overturning."""
    ends = {
        "pier": "[pier]\nwidth_m = 100\nheight_m = 400\nmass_t = 1e6\n",
        "case": '[[case]]\nname = "pads"\nbase = "yielding"\nbeta = 5000\neta = 1000\n',
        "numerics": "[numerics]\ntolerance = 0.1\n",
        "check": PARTS["check"].replace(*THETA).replace("50", "1"),
    }
    load_study(written(tmp_path, **ends))


def test_a_limit_is_odd_only_where_it_is_so_for_all_its_cases(tmp_path):
    """0.6 m is past the edge of the pier of 4 m and not of the one of 6 m."""
    both = PARTS["pier"].replace("width_m = 4", "width_m = [4, 6]")
    load_study(written(tmp_path, pier=both, check=PARTS["check"].replace("0.1", "0.6")))
    with pytest.raises(InputError, match=r"heel_uplift_m above 1\.184 is past"):
        load_study(written(tmp_path, pier=both, check=PARTS["check"].replace("0.1", "1.3")))


@pytest.mark.parametrize(
    ("part", "old", "new", "said"),
    [
        ("pier", "= 3000", '= 3000\nconfirm = ["heigth_m"]',
         'confirm = "heigth_m": this table has no such key; write one of "width_m", "height_m", "mass_t"'),
        ("numerics", "1e-4", '1e-4\nconfirm = "quiet_s"', 'this table has no such key; write one of "tolerance"'),
        ("numerics", "tolerance = 1e-4", 'confirm = "quiet_s"', 'this table has no such key; leave it out'),
        ("check", "= 0.1", '= 0.1\nconfirm = "name"',
         'confirm = "name": expected one of "at_most", "at_least", "above", "capacity"'),
        ("numerics", "1e-4", "9e-13", "tolerance = 9e-13: must be 1e-12 or above, because rounding alone makes as much"),
        ("numerics", "1e-4", "0", "tolerance = 0: expected a number above 0; write for example tolerance = 1e-4"),
    ],
)  # fmt: skip
def test_values_that_cannot_be_confirmed_or_met_are_reported(tmp_path, part, old, new, said):
    with pytest.raises(InputError) as caught:
        load_study(written(tmp_path, **{part: PARTS[part].replace(old, new)}))
    (problem,) = caught.value.messages
    assert problem.endswith(said)


def test_rules_from_elsewhere_are_held_against_the_piers_of_the_results(tmp_path):
    out = tmp_path / "out"
    assert main(["run", str(written(tmp_path)), "--out", str(out)]) == 0
    rules = tmp_path / "rules.toml"
    rules.write_text(PARTS["check"].replace("0.1", "100"), encoding="utf-8")
    with pytest.raises(InputError, match=r'check "uplift": at_most = 100: heel_uplift_m above 0\.5302'):
        rb.check(out, rules)
    with pytest.raises(InputError, match="past the edge"):
        rb.check(out, [rb.Rule("uplift", "heel_uplift_m", at_most=100.0)])
    confirmed = rb.Rule("uplift", "heel_uplift_m", at_most=100.0, confirm=("at_most",))
    assert rb.check(out, [confirmed])["value"].notna().all()
    rules.write_text(at_the_key(rules.read_text(), "at_most = 100", "at_most"), encoding="utf-8")
    assert rb.check(out, rules)["verdict"].eq("pass").all()


def test_a_run_to_less_than_rounding_is_refused(tmp_path):
    """It would never be called settled."""
    pier, motion = rb.Pier(0.2, 1.0), rb.pulse("sine", name="p", amplitude=2.5, period=1.0, dt=0.01, duration=1.0)
    with pytest.raises(InputError, match="tolerance = 1e-13: must be 1e-12 or above"):
        rb.simulate(pier, rb.RigidBase(), motion, tolerance=1e-13)


# Devices, motions and targets; from a study and from Python

TALL = rb.Pier.rectangle(8, 30, mass_t=3000)
SHAKE = rb.pulse("sine", name="s", amplitude=3.0, period=1.0, dt=0.01, duration=2.0)


def written_with(folder, motions="", case='[[case]]\nname = "rock"\nbase = "rigid"\n', pulse=PULSE):
    path = folder / "study.toml"
    path.write_text("[pier]\nwidth_m = 8\nheight_m = 30\nmass_t = 3000\n" + motions + pulse + case, encoding="utf-8")
    return path


TWICE = "stiffness_kN_m and lambda are given, which fix the same; keep one"


@pytest.mark.parametrize(
    ("device", "keys", "said"),
    [
        ("deck_spring", "gap_mm = 100", "stiffness_kN_m is missing; write for example stiffness_kN_m = 5.0e4, or lambda"),
        ("deck_spring", "lambda = 1\nstiffness_kN_m = 1e4", TWICE), ("deck_spring", 'lambda = 1\nside = "top"', 'side = "top"'),
        ("deck_spring", "lambda = 1\nheight_m = -3", "height_m"), ("deck_spring", 'lambda = 1\nat = "left"', "at"),
        ("stop", "gap_mm = 100", "stiffness_kN_m is missing; write for example stiffness_kN_m = 5.0e5, or lambda"),
        ("stop", "lambda = 20", "gap_mm is missing"), ("stop", "gap_mm = 100\nlambda = 20\nstiffness_kN_m = 1e5", TWICE),
        ("stop", "gap_mm = 100\nlambda = 20\nrestitution = 60", "restitution = 60: must be within 0.1 and 1"),
        ("stop", 'gap_mm = 100\nlambda = 20\nat = "top"', 'at = "top"'), ("stop", "gap_m = 0.1\nlambda = 20", "gap_m"),
    ],
)  # fmt: skip
def test_what_is_wrong_about_a_stop_or_a_deck_spring_is_said(tmp_path, device, keys, said):
    case = f'[[case]]\nname = "a"\nbase = "rigid"\n[[case.{device}]]\n{keys}\n'
    problems = problems_of(written_with(tmp_path, case=case))
    assert any(said in problem for problem in problems), problems


@pytest.mark.parametrize("width", [0.3, 8.0])
def test_without_a_gap_the_rest_is_judged_and_a_deck_spring_is_in_contact(width):
    def study(**device):
        case = {"name": "rock", "base": "rigid"} | {what: [keys] for what, keys in device.items()}
        return rb.Study.from_dict(
            {"pier": {"width_m": width, "height_m": 4.0 * width}, "motions": {"still_s": 5.0}, "case": [case]}
        )

    with pytest.raises(InputError) as refused:
        study(stop={"lambda": 1e9})
    assert [problem.key for problem in refused.value.problems] == ["case.0.stop.0", "case.0.stop.0.lambda"]
    with pytest.raises(InputError) as refused:
        study(deck_spring={"lambda": 1e9})
    assert [problem.key for problem in refused.value.problems] == ["case.0.deck_spring.0.lambda"]
    (spring,) = study(deck_spring={"lambda": 5.0}).cases[0].base.restraints
    assert spring.gap_m == 0.0


B, R0, P, A = 4.0, np.hypot(4.0, 15.0), TALL.p, TALL.alpha
friction, hysteretic, viscous = (
    partial(rb.Damper, "friction", f=0.1),
    partial(rb.Damper, "hysteretic", f=0.1, yield_m=0.005),
    partial(rb.Damper, "viscous"),
)
tendon, stop, beside = (
    partial(rb.Tendon, psi=0.1, lam=0.1),
    partial(rb.Stop, gap_m=0.1, lam=1.0),
    partial(rb.DeckSpring, lam=1.0),
)


@pytest.mark.parametrize(
    ("make", "name", "bound", "beyond"),
    [
        (friction, "f", 1.0, 1.001), (friction, "f", 1e-3, 0.999),
        (hysteretic, "yield_m", 2.5e-5, 0.999), (hysteretic, "yield_m", 0.5, 1.001),
        (hysteretic, "brace", B**2 / (1e-3 * R0), 1.001), (hysteretic, "brace", 0.025, 0.999),
        (partial(viscous, exponent=0.5), "nu", 9.81 / P / 0.1**0.5, 1.001), (viscous, "nu", 1e-3 * 9.81 / P, 0.999),
        (partial(viscous, brace=20.0), "nu", 20.0 * 9.81 * R0 / B**2 / P / 1e4, 0.999),
        (tendon, "psi", 1e-3, 0.999), (tendon, "strength", 10.0, 1.001), (tendon, "lam", 100.0, 1.001),
        (tendon, "lam", 0.01, 0.999),
        (stop, "gap_m", 5e-4, 0.999), (stop, "gap_m", 2.0 * TALL.half_width, 1.001),
        (stop, "lam", B**2 / (1e-4 * R0), 1.001), (stop, "lam", 0.05 * B**2 / (R0 * 2.0 * B * A), 0.999),
        (beside, "lam", B**2 / (1e-3 * R0), 1.001), (beside, "lam", 0.05 * B**2 / (R0 * TALL.deck * A), 0.999),
        (partial(beside, height_m=10.0), "gap_m", 10.0 * np.tan(A), 1.001),
    ],
)  # fmt: skip
def test_what_is_usual_of_a_device_ends_at_its_bound(make, name, bound, beyond):
    """By the sentences of the module's constants, from the weight, R0, b and α."""
    inside = (
        bound if name in ("f", "yield_m", "psi", "strength", "gap_m") else bound * (1.0 - 1e-9 * np.sign(beyond - 1.0))
    )
    assert unlikely_devices(TALL, (make(**{name: inside}),)) == []
    assert len(unlikely_devices(TALL, (make(**{name: bound * beyond}),))) == 1


def test_an_empty_tendon_is_refused(tmp_path):
    (problem,) = problems_of(written_with(tmp_path, case='[[case]]\nname = "a"\nbase = "rigid"\n[[case.tendon]]\n'))
    assert '[[case]] "a", tendon 1: it has neither prestress nor stiffness, so it has no effect' in problem


@pytest.mark.parametrize(
    "device",
    [
        rb.Damper("viscous", nu=4000.0), rb.Damper("hysteretic", f=0.02, yield_m=5e-6), rb.Tendon(psi=0.1, lam=2000.0),
        rb.Tendon(),
    ],
)  # fmt: skip
def test_python_refuses_the_same_devices_until_they_are_confirmed(device):
    with pytest.raises(InputError, match=r"(damper|tendon): .*write confirm = ") as error:
        rb.simulate(TALL, rb.RigidBase(restraints=(device,)), SHAKE)
    name = str(error.value).rsplit('"', 2)[1]
    right = replace(device, confirm=(name,))
    assert unlikely_devices(TALL, (right,)) == []
    assert (right, repr(right)) == (device, repr(device))
    assert "confirm" not in rb.RigidBase(restraints=(right,)).parameters(TALL)["restraints"][0]


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (lambda **more: rb.Pier.rectangle(28, 7, **more), "width_m"),
        (lambda **more: rb.Pier.rectangle(7, 28, top_m=280, **more), "top_m"),
        (lambda **more: rb.Pier.from_size(0.2, 15.0, top_m=280, **more), "top_m"),
        (lambda **more: rb.Pier.with_deck(7, 28, 2000, 1000, deck_height_m=2.8, **more), "deck_height_m"),
        (lambda **more: rb.Pier.with_deck(28, 7, 2000, 1000, **more), "width_m"),
        (lambda **more: rb.Pier.of_parts(7, [rb.Part.shaft(7, 28, 2000)], top_m=280, **more), "top_m"),
        (lambda **more: rb.pulse("sine", name="a", amplitude=40, period=1, dt=0.01, duration=2, **more), "amplitude"),
        (lambda **more: rb.pulse("sine", name="a", amplitude=4, period=1, dt=0.8, duration=2, **more), "dt"),
    ],
)  # fmt: skip
def test_python_refuses_sizes_and_pulses_until_they_are_confirmed(make, name):
    with pytest.raises(InputError, match=rf'^{name} = .*write confirm = \["{name}"\]$'):
        make()
    make(confirm=(name,))


K = 1e3
IN_MM: dict[str, tuple[Callable[[], object], set[str]]] = {
    "rectangle": (lambda: rb.Pier.rectangle(7 * K, 28 * K), {"width_m = 7", "height_m = 28"}),
    "size": (lambda: rb.Pier.from_size(0.2, 15 * K), {"size_m = 15"}),
    "deck": (lambda: rb.Pier.with_deck(7 * K, 28 * K, 2000, 1000), {"width_m = 7", "height_m = 28"}),
    "deck alone": (lambda: rb.Pier(0.2, 1.0, deck_height_m=15 * K), {"deck_height_m = 15"}),
    "top alone": (lambda: rb.Pier(0.2, 1.0, top_m=15 * K), {"top_m = 15"}),
    "parts": (lambda: rb.Pier.of_parts(7 * K, [rb.Part.shaft(7 * K, 28 * K, 2000)]), {"width_m = 7"}),
}


@pytest.mark.parametrize("way", IN_MM)
def test_every_way_to_make_a_pier_asks_whether_lengths_are_in_mm(way):
    """All lengths are wrong alike, so that no share of one in another tells."""
    make, right = IN_MM[way]
    with pytest.raises(InputError) as caught:
        make()
    said = [re.findall(r"if it is in mm, write (\w+ = [\d.]+);", message) for message in caught.value.messages]
    assert {remedy for remedies in said for remedy in remedies} == right


def test_a_motion_in_gal_is_refused_where_it_is_run():
    gal = rb.Motion("gal", 0.01, 400.0 * np.sin(np.arange(200) / 10))
    with pytest.raises(
        InputError, match=r'motion "gal": PGA 40\.8 g, where .*gal are 0\.01 of it.*confirm = \["pga"\]'
    ):
        rb.simulate(TALL, rb.RigidBase(), gal)
    confirmed = rb.simulate(TALL, rb.RigidBase(), replace(gal, confirm=("pga",)))
    assert confirmed.row["pga_g"] == pytest.approx(40.8, abs=0.05)


@pytest.mark.parametrize(
    ("old", "new", "key", "said"),
    [
        ("amplitude_g = 0.2", "amplitude_g = 4", "amplitude_g", "amplitude_g = 4: 4 g are more than 3 g, where pulses"),
        ("dt_s = 0.01", "dt_s = 0.8", "dt_s", "dt_s = 0.8: 1.2 samples in a period of 1 s, which miss the pulse's peak"),
    ],
)  # fmt: skip
def test_a_pulse_that_is_none_is_refused(tmp_path, old, new, key, said):
    (problem,) = problems_of(written_with(tmp_path, pulse=PULSE.replace(old, new)))
    assert said in problem
    assert problem.endswith(f'write confirm = ["{key}"] in this table')
    assert problems_of(written_with(tmp_path, pulse=at_the_key(PULSE.replace(old, new), new, key))) == ()


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ("target = { pga_g = 40CONFIRM }", "pga_g = 40: more than 2 g: few records exceed 1 g, and the strongest had 2 to 4 g"),
        ("target = { pgv_m_s = 80CONFIRM }", "pgv_m_s = 80: more than 5 m/s"),
        ('target = { spectrum = "EN 1998-1", type = 1, ground = "B", period_range_s = [0.4, 4], ag_g = 3.5CONFIRM }',
         "ag_g = 3.5: more than 2 g"),
    ],
)  # fmt: skip
def test_a_target_beyond_any_earthquake_is_refused(tmp_path, key, said):
    (problem,) = problems_of(written_with(tmp_path, f"[motions]\n{key.replace('CONFIRM', '')}\n"))
    assert said in problem
    name = said.split(" ")[0]
    assert problem.endswith(f'write confirm = ["{name}"] in this table')
    confirmed = key.replace("CONFIRM", f', confirm = ["{name}"]')
    assert problems_of(written_with(tmp_path, f"[motions]\n{confirmed}\n")) == ()


def test_a_scale_in_percent_is_refused(tmp_path):
    (problem,) = problems_of(written_with(tmp_path, "[motions]\nscale = [1, 150]\n"))
    assert "[motions]: scale = 150: more than 10 times as recorded; 150 % are 1.5" in problem
    assert problems_of(written_with(tmp_path, '[motions]\nscale = [1, 150]\nconfirm = "scale"\n')) == ()


def test_a_weak_record_is_not_made_a_strong_one_unless_it_is_confirmed():
    """Three motions that are alike but for their size: the least takes ten times what the first does."""
    shape = np.sin(np.arange(2000) / 16) * np.exp(-np.arange(2000) / 500)
    motions = [rb.Motion(name, 0.01, size * shape) for name, size in (("a", 4.0), ("b", 1.2), ("c", 0.4))]
    periods = np.geomspace(0.5, 1.0, 8)  # those that the target has
    sa = spectral_acceleration(motions[0].horizontal, 0.01, periods, 0.05) / 9.81
    target = SpectrumTarget(TableSpectrum(periods, sa, 0.05, "mine"), (0.5, 1.0), factors="each")
    found = at_target(MotionSet(motions), target, 9.81)
    assert [motion.name for motion in found.motions] == ["a", "b"]
    (weak,) = found.unusable
    assert weak.reason.startswith("takes 10 times its motion, PGA 0.39 g, to meet the spectrum mine")
    assert 'write confirm = ["c"] under [motions]' in weak.reason
    assert len(at_target(MotionSet(motions), target, 9.81, ("c",)).motions) == 3


def test_a_limit_below_zero_is_refused_until_it_is_confirmed(tmp_path):
    check = PARTS["check"].replace("at_most = 0.1", "at_most = -0.5")
    (problem,) = problems_of(written(tmp_path, check=check))
    assert (
        "at_most = -0.5: heel_uplift_m is counted without its sign, so that nothing passes; check the sign" in problem
    )
    assert problems_of(written(tmp_path, check=at_the_key(check, "at_most = -0.5", "at_most"))) == ()


@pytest.mark.parametrize(
    ("keys", "name", "least", "most"),
    [
        (target_keys.ASCE_KEYS, "sds_g", 0.005, 5.0),
        (target_keys.ASCE_KEYS, "sd1_g", 0.002, 5.0),
        (target_keys.ASCE_KEYS, "tl_s", 0.005, 50.0),
        (target_keys.AASHTO_KEYS, "as_g", 0.005, 2.0),
    ],
)
def test_values_of_design_spectra_are_doubted_beyond_these_bounds(keys, name, least, most):
    doubts = keys[name].usual.doubts
    assert doubts(name, 1.01 * least) == doubts(name, 0.99 * most) == []
    assert len(doubts(name, 0.99 * least)) == len(doubts(name, 1.01 * most)) == 1


def test_a_target_of_0_4_g_in_metres_per_second_squared_is_noticed(tmp_path):
    (problem,) = problems_of(written_with(tmp_path, "[motions]\ntarget = { pga_g = 3.924 }\n"))
    assert "; if it is in m/s², write pga_g = 0.4" in problem
