"""Damaged studies, journals and folders of results end in words or in what is right.

A few here, thousands by ``benchmarks/damage.py``.
"""

import math
import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[1] / "benchmarks"))
import damage

pytestmark = pytest.mark.usefixtures("pages")  # damaged pages are held against those of the whole folders


@pytest.fixture(scope="module")
def sample(tmp_path_factory):
    return damage.Sample(tmp_path_factory.mktemp("damage"))


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    return damage.Sample(tmp_path_factory.mktemp("small"), ("fragility",))


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize(("what", "times"), [("study", 12), ("journal", 20), ("folder", 1), ("rules", 10)])
def test_a_damaged_one_ends_in_words_or_in_what_is_right(small, what, times):
    ends, bad = damage.repeated(getattr(small, f"damage_{what}"), times, seed=3)
    assert bad == []
    assert ends["words"] < times or what == "journal"


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize(
    ("what", "times"), [("study", 2000), ("journal", 2000), ("folder", 200), ("analysis", 200), ("rules", 2000)]
)
@pytest.mark.parametrize("part", ["a fortieth", pytest.param("the rest", marks=pytest.mark.thorough)])
def test_thousands_do(sample, what, times, part):
    some = math.ceil(times / 40)
    first, times = (0, some) if part == "a fortieth" else (some, times - some)
    _, bad = damage.repeated(getattr(sample, f"damage_{what}"), times, seed=4, first=first)
    assert bad == []


def test_a_row_that_was_changed_with_its_checksum_would_be_seen(small):
    """The harness itself: a journal that lies about a row is a failure, and so is what never ends."""
    lying = damage.Sample.__new__(damage.Sample)
    lying.__dict__ |= small.__dict__
    lying.rows = [row | {"status": "other"} for row in small.rows]
    _, bad = damage.repeated(lying.damage_journal, 5, seed=5)
    assert any("WrongError" in one for one in bad)


def test_what_never_ends_is_seen(monkeypatch):
    monkeypatch.setattr(damage, "SECONDS", 0.05)

    def endless(_):
        while True:
            pass

    _, bad = damage.repeated(endless, 1, seed=1)
    assert "TookTooLongError" in bad[0]
