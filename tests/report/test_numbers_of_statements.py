"""Statements and the head of the calculation sheet, read back: of two studies that differ in every number, name and date."""

import math
from types import SimpleNamespace

import pytest
from check_samples import PADS, RECORD, case, runs, verdict
from messages import assert_states
from report_page import Page
from report_samples import case_entry, write_results

from rockbatch.checks.coverage import CaseRuns, Stations
from rockbatch.checks.responses import Worst
from rockbatch.pier import Pier, RigidBase, YieldingBase
from rockbatch.reporting.finished import read
from rockbatch.reporting.sections import identity, inputs
from rockbatch.reporting.sections.statement import check_sentences
from rockbatch.reporting.sections.statement.statements import (
    _bounds,
    _conforming,
    _Design,
    _identity,
    _not_covered,
    _result,
    _suite,
)
from rockbatch.reporting.sheet import sheet_of

FIRST = SimpleNamespace(
    name="pads", check="drift", other="lift", bound="soft", value=0.31, low=0.28, high=0.34, limit=0.45, ratio=0.689,
    margin=0.14, records=7, at_m=25.0, record="Kobe", governing=0.37, reason="clause 7", runs=21, fell=3, flew=2, scale=1.5,
    stations=9, used=("A", "B"), lost=("C", "D"), file="C.AT2", left="E.AT2", events=("Kobe 1995", "Waiau 2016"),
    factors=(0.5, 2.0),
    version="1.4.2", commit="0a1b2c3d", created="2026-03-04T05:06:07", path="a.toml", study="13" * 32, peaks="57" * 32, beta=40.0,
    eta=2.5, alpha=0.13, p=0.38, mass=1875.0, machine="Linux x86_64, 12 cores", numpy="2.3.1",
)  # fmt: skip
SECOND = SimpleNamespace(
    name="piles", check="tilt", other="slide", bound="stiff", value=0.52, low=0.49, high=0.57, limit=0.61, ratio=0.852,
    margin=0.09, records=11, at_m=17.5, record="Imperial", governing=0.73, reason="clause 8", runs=44, fell=5, flew=4, scale=0.8,
    stations=13, used=("F", "G", "H"), lost=("I",), file="I.V2A", left="J.V2A",
    events=("Izmit 1999", "Duzce 1999", "Van 2011"), factors=(0.7, 1.6),
    version="2.0.1", commit="4e5f6a7b", created="2027-11-12T13:14:15", path="b.toml", study="24" * 32, peaks="68" * 32, beta=75.0,
    eta=3.25, alpha=0.17, p=0.46, mass=2245.0, machine="Linux aarch64, 96 cores", numpy="3.0.4",
)  # fmt: skip
OF = SimpleNamespace(named=lambda record: f"station {record}")
"""Results whose records have these names."""


def judged(s, decided="pass", **more):
    """Return the verdict of a check on the drift of a study."""
    about = {
        "check": s.check, "demand": "top_drift_m", "statistic": "max", "words": "maximum of the drift", "value": s.value,
        "low": s.low, "high": s.high, "limit": s.limit, "margin": s.margin, "records": s.records, "count": "station", "unit": "m",
        "at_m": s.at_m, "record": s.record, "governing": s.governing, "reason": s.reason, "ratio": s.ratio,
        "columns": {"bound": s.bound},
    }  # fmt: skip
    return verdict(s.name, decided, **about | more)


def design(s, kinds, decided="pass", bounded=False, free=(), of_suite=()):
    """Return a design with a verdict of each of these kinds, by the names of its checks."""
    one = case(s.name, PADS, **({"bound": s.bound} if bounded else {}))
    verdicts = [judged(s, kind, check=name) for name, kind in kinds.items()]
    ended = CaseRuns(s.name, {}, s.scale, s.runs, {"overturned": s.fell, "flight": s.flew})
    return _Design(s.name, [one], ended, verdicts, of_suite, free, decided)


def stations(s):
    lost = {name: [{"name": s.file}] for name in s.lost}
    return Stations(s.used, lost, {"left": [{"name": s.left}]})


def suite(s, **more):
    """Return results of records of which all but one have a vertical component."""
    records = [
        RECORD
        | {
            "record": f"r{i}",
            "station": f"s{i % 3}",
            "event": s.events[i % len(s.events)],
            "factor": factor,
            "pga_v_g": 0.1 if i else None,
        }
        for i, factor in enumerate([*s.factors, *[1.0] * (s.records - 2)])
    ]
    saved = SimpleNamespace(peaks=runs([0.1] * s.records, polarity=["+", "-"] * (s.records // 2) + ["+"]))
    return SimpleNamespace(info={"records": records} | more, saved=saved)


def condition(s, decided):
    about = {
        "check": "suite",
        "words": "stations",
        "value": s.stations,
        "limit": s.records,
        "unit": "",
        "sense": "at least",
    }
    return verdict("", decided, reason=s.reason, **about)


def not_covered(s):
    free = [Worst("settlement_m", s.value, case(s.name), runs([0.1]), 0)]
    return "; ".join(_not_covered(design(s, {s.check: "pass"}, free=free), stations(s)))


def changed(s):
    """Return a sentence on the bound of a design, and one on the key that it lacks."""
    lacking = [{"case": s.name, "keys": ["case.beta"]}]
    bound = {"bound": s.bound, "changes": [f"case.eta × {s.eta:g}"], "source": s.reason, "lacking": lacking}
    return " ".join(_bounds({"bounds": [bound]}, design(s, {s.check: "pass"}, bounded=True)))


def quoted(*names):
    return ", ".join(f'"{name}"' for name in names)


def identified(s, **more):
    info = {
        "versions": {"commit": s.commit},
        "rockbatch": s.version,
        "peaks": {"sha256": s.peaks},
        "created": s.created,
    }
    return _identity(info | {"study": {"sha256": s.study, "path": s.path}} | more)


SAID = {
    "a value below its limit": (
        lambda s: check_sentences.sentence(OF, judged(s), [judged(s)]),
        lambda s: [
            f'"{s.check}" passes', "maximum", s.records, "stations", s.at_m, "m", "is", s.value, "m", s.low, "m", s.high, "m",
            "at most", s.limit, "m", 100.0 * s.ratio, "%", s.margin, "m to spare", f'"station {s.record}"', s.governing, "m",
            f'"{s.reason}"',
        ],
    ),
    "a value beyond its limit, at worst": (
        lambda s: check_sentences._value_in_words(judged(s), at_worst=True),
        lambda s: ["is at worst", s.value, "m", s.low, "m", s.high, "m", f'under "{s.bound}"'],
    ),
    "a limit that is passed": (
        lambda s: check_sentences._limit(judged(s, margin=-s.margin)),
        lambda s: ["at most", s.limit, "m is allowed", 100.0 * s.ratio, "%", s.margin, "m beyond it"],
    ),
    "a share of checks that fail": (
        lambda s: _result(
            design(s, {s.check: "fail", s.other: "not decided", "third": "pass"}, "fail"), stations(s), outdated=False
        ),
        lambda s: [f'"{s.name}" fails', 1.0, 3.0, f'checks: "{s.check}"', f'"{s.other}" is not decided'],
    ),
    "why a design is not decided": (
        lambda s: _result(design(s, {s.check: "pass"}, "not decided"), stations(s), outdated=False),
        lambda s: [f'"{s.name}" meets its only check', len(s.lost), len(s.used) + len(s.lost), "stations"],
    ),
    "all checks": (
        lambda s: _result(design(s, dict.fromkeys((*s.events, "x", "y"), "pass")), stations(s), outdated=False),
        lambda s: [f'"{s.name}" passes', len(s.events) + 2.0, "checks"],
    ),
    "a condition that is not met": (
        lambda s: _conforming({}, [condition(s, "fail"), condition(s, "pass")]),
        lambda s: [2.0, "conditions", f'"suite" ("{s.reason}")', "stations", s.stations, "at least", s.records],
    ),
    "what is not covered": (
        not_covered,
        lambda s: [1000.0 * s.value, "mm", s.fell, s.runs, "overturned", s.flew, "flight", quoted(s.file), quoted(s.left)],
    ),
    "bounds": (
        changed,
        lambda s: ["one bound", f'"{s.bound}"', "case.eta", s.eta, f"({s.reason})", "case.beta", f'"{s.bound}"'],
    ),
    "a suite": (
        lambda s: _suite(suite(s), design(s, {s.check: "pass"})),
        lambda s: [s.records, "horizontal components", 3.0, "stations", len(s.events), "earthquakes",
                   quoted(*s.events), *s.factors, s.scale, "both directions", s.records - 1.0, s.records],
    ),
}  # fmt: skip


@pytest.mark.parametrize("study", [FIRST, SECOND], ids=["first", "second"])
@pytest.mark.parametrize("name", SAID)
def test_a_sentence_of_a_statement_names_what_it_speaks_of(name, study):
    said, expected = SAID[name]
    text, wanted = said(study).replace("\u00a0", " "), expected(study)
    for part in [part for part in wanted if isinstance(part, str) and any(map(str.isdigit, part))]:
        assert part in text  # names that have digits in them are no numbers
        text, wanted = text.replace(part, "NAMED", 1), ["NAMED" if one == part else one for one in wanted]
    assert_states(text, *wanted)


@pytest.mark.parametrize("study", [FIRST, SECOND], ids=["first", "second"])
def test_a_statement_ends_with_program_date_study_and_both_digests(study):
    places = [study.version, study.commit, study.created[:10], study.path, study.study[:16], study.peaks[:16]]
    text = identified(study)
    assert [text.index(part) for part in places] == sorted(text.index(part) for part in places)
    assert study.study[:17] not in text
    assert "results" not in identified(study, peaks=None)
    assert "commit" not in identified(study, versions={})


def folder_of(s, tmp_path):
    """Write results of a study with two foundations, one of them rigid."""
    pier = Pier(alpha=s.alpha, p=s.p)
    cases = [
        case_entry(s.name, {}, pier, YieldingBase(beta=s.beta, eta=s.eta)),
        case_entry("rigid", {}, pier, RigidBase()),
    ]
    for one in cases:
        one["pier"] |= {"mass_t": s.mass}
    pads = f'[[case]]\nname = "{s.name}"\nbase = "yielding"\nbeta = {s.beta}\neta = {s.eta}\n'
    text = f"[pier]\nalpha = {s.alpha}\np = {s.p}\n{pads}"
    study = {"path": s.path, "title": s.bound, "notes": "", "text": text, "sha256": s.study}
    folder = write_results(tmp_path, cases=cases, study=study, versions={"numpy": s.numpy, "commit": s.commit})
    finished = read(folder)
    finished.info.update({"rockbatch": s.version, "created": s.created, "machine": s.machine})
    finished.info["peaks"] = {"rows": 12, "sha256": s.peaks}
    return finished


@pytest.mark.parametrize("study", [FIRST, SECOND], ids=["first", "second"])
def test_head_digests_and_inputs_of_a_sheet_are_those_of_its_study(tmp_path, study):
    finished = folder_of(study, tmp_path)
    sheet = sheet_of(finished)
    version = f"rockbatch {study.version} ({study.commit}), {study.created[:10]}"
    assert (sheet.title, sheet.path, sheet.version) == (study.bound, study.path, version)
    drawn = Page(str(identity.section(finished)))
    rows = {row[0]: row[1:] for row in drawn.tables[""] if row[0] != "record"}
    assert rows["study file"] == [study.path, study.study]
    assert rows["results"] == ["peaks.csv", study.peaks]
    assert rows["program"][0] == f"rockbatch {study.version}, commit {study.commit}"
    assert f"numpy {study.numpy}, commit {study.commit} on {study.machine}, {study.created}." in drawn.text
    tables = Page(str(inputs.section(finished))).tables[""]
    heads = [place for place, row in enumerate(tables) if not any(cell.replace(".", "").isdigit() for cell in row)]
    found = {}
    for start, end in zip(heads, [*heads[1:], len(tables)], strict=True):
        for row in tables[start + 1 : end]:
            for head, cell in zip(tables[start], row, strict=False):
                found.setdefault(head, set()).add(cell)
    for head, value in {
        "α [rad]": study.alpha,
        "p [rad/s]": study.p,
        "β": study.beta,
        "η": study.eta,
        "mass [t]": study.mass,
    }.items():
        assert {cell for cell in found[head] if cell not in ("", "–")} == {f"{value:g}"}, head
    size = 0.75 * 9.81 / study.p**2
    assert found["R0 [m]"] == {f"{size:.6g}"}
    assert found["half-width b [m]"] == {f"{size * math.sin(study.alpha):.6g}"}
