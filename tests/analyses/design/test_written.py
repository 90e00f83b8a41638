"""Values written into the tables of a study, by the path of their key."""

import pytest

from rockbatch.analyses.design.written import paths_in, with_value

TWO = [{"kind": "friction", "f": 0.1}, {"kind": "viscous", "nu": 0.2}, {"kind": "friction", "f": 0.3}]
TABLES = {
    "pier": {"width_m": 4.0, "part": [{"mass_t": 1.0}, {"mass_t": 2.0}]},
    "case": [{"name": "a", "beta": [40, 80], "damper": TWO}, {"base": "rigid", "tendon": {"psi": 0.1}}],
}


@pytest.mark.parametrize(
    ("path", "case", "places"),
    [
        ("pier.width_m", "a", ["pier.width_m"]),
        ("pier.part.mass_t", "a", ["pier.part.0.mass_t", "pier.part.1.mass_t"]),
        ("pier.part_2.mass_t", "a", ["pier.part.1.mass_t"]),
        ("case.beta", "a", ["case.0.beta"]),
        ("case.damper.f", "a", ["case.0.damper.0.f", "case.0.damper.2.f"]),
        ("case.damper_3.f", "a", ["case.0.damper.2.f"]),
        ("case.tendon.psi", "rigid", ["case.1.tendon.psi"]),
        ("case.damper_2.f", "a", []),
        ("case.damper_4.f", "a", []),
        ("case.tendon.psi", "a", []),
        ("case.zeta", "rigid", []),
    ],
)
def test_a_value_is_written_where_its_path_says_and_nowhere_else(path, case, places):
    written = with_value(TABLES, path, case, 9.0)
    assert (written is not None) == bool(places)
    if written is not None:
        before, after = dict(leaves(TABLES)), dict(leaves(written))
        assert after == before | dict.fromkeys(places, 9.0)


def leaves(value, place=""):
    """Yield the places and values of everything that is no table and no list of tables."""
    items = value.items() if isinstance(value, dict) else enumerate(value)
    for key, item in items:
        at = f"{place}.{key}".strip(".")
        tables = isinstance(item, dict) or (isinstance(item, list) and all(isinstance(part, dict) for part in item))
        yield from leaves(item, at) if tables else [(at, item)]


def test_the_paths_of_a_study_are_those_of_its_keys_with_numbers():
    """Those of words, such as case.name, are not among them: a scan varies numbers."""
    of_pier, of_devices = {"pier.width_m", "pier.part.mass_t"}, {"case.damper.f", "case.damper.nu", "case.tendon.psi"}
    assert {*paths_in(TABLES)} == of_pier | of_devices | {"case.beta"}
