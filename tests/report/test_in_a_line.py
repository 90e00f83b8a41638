"""The line below the title: pier, stations, components and runs."""

import json

import pytest
from report_samples import FIG7, FOUNDATIONS, case_entry, three_piers, write_results

from rockbatch.pier import Pier
from rockbatch.reporting.finished import read
from rockbatch.reporting.sections.studied import in_a_line

LOST = {"name": "x", "source": "x.AT2", "reason": "cut", "station": "S9"}
FELL = {("SYL360", "2"): {"status": "overturned"}, ("SYL360", "3"): {"status": "failed"}}
SIZES = "width_m = 4.0\nheight_m = 20.0\nmass_t = 1_234.5\ndeck_mass_t = 300"
PARTS = "width_m = 4.0\n[[pier.part]]\nmass_t = 500\nheight_m = 15"
SHAFT = "α = 0.13, p = 0.38 rad/s"


ONE, ALL = {"records": FIG7[:1]}, (SHAFT, "6 stations", "6 components")
TALL = [case_entry("1", {}, Pier(0.13, 0.3 + 0.01 * k), FOUNDATIONS[1][1]) for k in range(4)]

FEET = [TALL[0] | {"base": "footing", "pier": TALL[0]["pier"] | {"half_width_m": 3.0}}]


@pytest.mark.parametrize(
    ("results", "pier", "expected"),
    [
        ({}, "", (*ALL, "30 runs, all end standing")),
        ({"changes": FELL}, "", (*ALL, "30 runs, 28 end standing")),
        ({"unusable": [LOST]}, "", (SHAFT, "6 of 7 stations", "6 components", "30 runs, all end standing")),
        ({"unusable": [LOST | {"station": ""}]}, "", (*ALL, "30 runs, all end standing")),
        (ONE, "", (SHAFT, "1 station", "one component", "5 runs, all end standing")),
        (ONE, SIZES, ("20 m high, 4 m wide, 1234.5 t, 300 t of deck", "1 station", "one component", "5 runs, all end standing")),
        (ONE | {"cases": [TALL[0] | {"pier": TALL[0]["pier"] | {"highest_m": 31.25}}]}, PARTS,
         ("31.25 m high, 4 m wide", "1 station", "one component", "one run, all end standing")),
        (ONE | {"cases": FEET}, SIZES,  # the foot, not the distance of the pivots
         ("20 m high, 6 m wide, 1234.5 t, 300 t of deck", "1 station", "one component", "one run, all end standing")),
        (ONE | {"cases": TALL}, PARTS, ("4 m wide", "1 station", "one component", "4 runs, all end standing")),
        (ONE | {"cases": three_piers(), "varied": ("p",)}, "",
         ("α = 0.13, p = 0.38, 0.36, 0.35 rad/s", "1 station", "one component", "15 runs, all end standing")),
        (ONE | {"cases": TALL}, "", ("α = 0.13", "1 station", "one component", "4 runs, all end standing")),
    ],
)  # fmt: skip
def test_the_line_below_the_title_says_what_was_run_and_how_much_of_it_stands(tmp_path, results, pier, expected):
    """Sizes as the study gives them, else α and p while they are few; stations of all, if those of the others are known."""
    write_results(tmp_path, **results)
    if pier:
        info = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
        info["study"]["text"] = f"[pier]\n{pier}\n"
        (tmp_path / "run.json").write_text(json.dumps(info), encoding="utf-8")
    of_pier, stations, components, runs = expected
    assert in_a_line(read(tmp_path)) == f"{of_pier} · {stations}, {components} (with the vertical component) · {runs}"
