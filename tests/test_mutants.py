"""The tool that puts small errors into the product: which errors, and that a test is seen to notice one."""

import ast
import sys
import tomllib
from pathlib import Path

import pytest

import rockbatch.pier.restraints

TOOL = Path(__file__).parent / "mutants"
PRODUCT = "rockbatch"


@pytest.fixture(autouse=True)
def importable(monkeypatch):
    monkeypatch.syspath_prepend(str(TOOL))
    yield
    for name in ("places", "run"):
        sys.modules.pop(name, None)


def test_errors_are_signs_comparisons_numbers_conditions_and_swaps_but_no_wording_nor_rounding():
    from places import mutants

    source = (
        'def f(x: int = 2) -> "a < b":\n'
        '    """1 < 2"""\n'
        "    if x <= 0.5 and not g(x, y):\n"
        '        raise ValueError(f"{x + 1} < 2")\n'
        "    sum(zip(x, strict=True), 1e-9)\n"
        "    return max(x, y) - 3\n"
    )
    assert [str(mutant) for mutant in mutants(source)] == [
        "2 → (3)",
        "x <= 0.5 and not g(x, y) → (x <= 0.5 or not g(x, y))",
        "x <= 0.5 and not g(x, y) → (not g(x, y))",
        "x <= 0.5 and not g(x, y) → (x <= 0.5)",
        "x <= 0.5 → (x < 0.5)",
        "0.5 → (0.55)",
        "not g(x, y) → (g(x, y))",
        "g(x, y) → (g(y, x))",
        "max(x, y) - 3 → (max(x, y) + 3)",
        "3 → (4)",
    ]


def test_every_error_leaves_a_program_and_another_one():
    from places import mutants

    source = Path(rockbatch.pier.restraints.__file__).read_text(encoding="utf-8")
    whole = ast.dump(ast.parse(source))
    errors = list(mutants(source))
    assert len(errors) > 50
    for error in errors[::5]:
        assert ast.dump(ast.parse(error.put_into(source))) != whole


@pytest.mark.slow
@pytest.mark.parametrize(
    ("limit", "test", "noticed"),
    [("3", "", ""), ("2", "def test_limit()", ""), ("2", "@pytest.mark.slow\ndef test_limit()", " (slow)")],
)
def test_an_error_survives_fast_and_slow_tests_that_do_not_meet_it(tmp_path, monkeypatch, limit, test, noticed):
    import run
    from places import mutants
    from run import FAST, SLOW, Place, noticed_by

    source = f"def small(x):\n    return x < {limit}\n"
    (tmp_path / PRODUCT).mkdir()
    (tmp_path / PRODUCT / "few.py").write_text(source)
    (tmp_path / "conftest.py").write_text("import sys; sys.path.insert(0, 'rockbatch')\n")
    (tmp_path / "test_few.py").write_text(
        "from few import small\ndef test_small(): assert small(1) and not small(9)\ndef test_unsound(): assert False\n"
    )
    if test:
        (tmp_path / "test_limit.py").write_text(f"import pytest\nfrom few import small\n{test}: assert not small(2)\n")
    (mutant,) = (mutant for mutant in mutants(source) if "<=" in mutant.text)
    place = Place(f"{PRODUCT}/few.py", mutant)
    monkeypatch.setattr(run, "tests_of", lambda place: [(FAST, ["test_few.py"]), (FAST, ["."]), (SLOW, ["."])])
    assert noticed_by(place, tmp_path, set()) == (f"test_limit.py::test_limit{noticed}" if test else "")
    assert (tmp_path / PRODUCT / "few.py").read_text() == source


@pytest.mark.slow
def test_errors_are_drawn_from_all_packages_and_what_is_listed_as_equivalent_can_still_be_put_in():
    from run import EQUIVALENT, drawn

    places = drawn(seed=1, count=sys.maxsize)
    assert len({place.package for place in places[:100]}) > 10
    assert set(tomllib.loads(EQUIVALENT.read_text(encoding="utf-8"))) <= {place.name for place in places}
