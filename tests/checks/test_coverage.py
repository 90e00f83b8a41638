"""Runs and stations that a verdict covers: counted anew, in loops, on random tables."""

import numpy as np
import pandas as pd
import pytest
from check_samples import case, runs

from rockbatch.checks.coverage import Stations, runs_of_cases, stations_of

WORDS = {"overturned": "overturned", "flight": "ended by flight", "failed": "failed", "not run": "not run"}


@pytest.mark.sweep(fast=2)
@pytest.mark.parametrize("seed", range(8))
def test_runs_of_every_case_are_counted_by_scale_and_ending(seed):
    """Some rows are lacking, and a case has the runs of both axes of its pier."""
    random = np.random.default_rng(seed)
    scales, polarities = [0.5, 1.0, 2.0][: random.integers(1, 4)], ["+", "-"][: random.integers(1, 3)]
    both, records = bool(random.integers(2)), int(random.integers(2, 6))
    cases = [case("pads", eta=2.0), case("pads", eta=3.0), case("rigid")]
    cases += [case("wide") | {"across_of": "rigid"}] if both else []
    tables = [
        runs(np.full(records, 0.1), one["case"], scale=scale, polarity=polarity, **one["columns"])
        for one in cases for scale in scales for polarity in polarities
    ]  # fmt: skip
    table = pd.concat(tables, ignore_index=True)
    statuses = np.array(["ok", "overturned", "flight", "failed"])
    table["status"] = statuses[random.choice(4, len(table), p=[0.6, 0.2, 0.1, 0.1])]
    lacking = random.choice(len(table), int(random.integers(3)), replace=False)
    table = table.drop(index=lacking[(table["record"] != "r0").to_numpy()[lacking]]).reset_index(drop=True)
    counted = runs_of_cases(table, cases, records)
    names = [(["pads"], 2.0), (["pads"], 3.0), (["rigid", "wide"], None)]
    expected = []
    for of_case, eta in names:
        for scale in scales:
            chosen = table[table["case"].isin(of_case) & (table["scale"] == scale)]
            chosen = chosen if eta is None else chosen[chosen["eta"] == eta]
            planned = records * len(polarities) * (2 if both and eta is None else 1)
            ended = {status: int((chosen["status"] == status).sum()) for status in ("overturned", "flight", "failed")}
            ended["not run"] = planned - len(chosen)
            expected.append((of_case[0], scale, planned, {status: n for status, n in ended.items() if n}))
    assert [(one.case, one.scale, one.runs, dict(one.ended)) for one in counted] == expected
    for one in counted:
        words = [f"{n} {WORDS[status]}" for status, n in one.ended.items()]
        if words:
            words[0] = words[0].replace(" ", f" of {one.runs} runs ", 1)
        assert one.in_words == ", ".join(words)


def test_a_record_and_a_file_of_no_known_station_are_their_own():
    records = [
        {"record": "a", "station": "S"},
        {"record": "b", "station": "S"},
        {"record": "c"},
        {"record": "d", "station": ""},
    ]
    unusable = [{"name": "e", "station": "T"}, {"name": "f"}, {"name": "g", "station": "T"}]
    left_out = [{"name": "h", "named": True}, {"name": "i"}, {"name": "k", "station": "T", "named": True}]
    found = stations_of({"records": records, "unusable": unusable, "left_out": left_out})
    assert list(found.used) == ["S", "c", "d"]
    assert {name: [file["name"] for file in files] for name, files in found.unusable.items()} == {
        "T": ["e", "g"],
        "f": ["f"],
    }
    assert {name: [file["name"] for file in files] for name, files in found.left_out.items()} == {"h": ["h"]}
    assert (found.total, found.known) == (5, False)
    known = stations_of({"records": records[:2], "unusable": unusable[:1]})
    assert known == Stations(["S"], {"T": unusable[:1]}, {}, True)
