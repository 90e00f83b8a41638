"""The headline of a whole study with a station that could not be used, on terminal and page."""

import pytest
from motion_files import wiggle, write_at2
from report_page import Page
from studies import RIGID, toml, write_study

from rockbatch.commands.cli import main

LIMIT = {"name": "rotation", "demand": "theta_max_over_alpha", "at_most": 0.9, "reason": "half"}


def page_of(folder):
    return Page((folder / "report.html").read_text(encoding="utf-8")).text


@pytest.mark.slow
@pytest.mark.usefixtures("pages")
def test_a_missing_station_is_amber_until_the_study_leaves_it_out(tmp_path, capsys):
    for seed, name in enumerate(("RSN7_A_B000", "RSN8_A_C000", "RSN9_A_D000")):
        write_at2(
            tmp_path / "records", f"{name}.AT2", wiggle(400, seed, scale=0.3), title=f"Made-up, 1/17/1994, {name}, 000"
        )
    cut = tmp_path / "records/RSN9_A_D000.AT2"
    cut.write_text("\n".join(cut.read_text().splitlines()[:-2]))

    def run(out, **motions):
        keys = {"path": "records", **motions}
        study = write_study(
            tmp_path, toml({"pier": {"alpha": 0.2, "p": 1.0}, "motions": keys, "case": [RIGID], "check": [LIMIT]})
        )
        code = main(["run", str(study), "--out", str(tmp_path / out), "--fresh"])
        return code, capsys.readouterr().out, page_of(tmp_path / out)

    code, told, page = run("all")
    assert code == 1
    for text in (told, page):
        assert "? 2 of 3 stations; RSN9 could not be used: RSN9_A_D000.AT2: the header says NPTS = 400" in " ".join(
            text.split()
        )
        assert "? Every check passes in the only case." in text
        assert "✓ Every" not in text
    assert main(["check", str(tmp_path / "all")]) == 1
    assert "? 2 of 3 stations" in capsys.readouterr().out

    assert "\n? Every check passes" in told

    code, told, page = run("named", leave_out=["RSN9"])
    assert code == 0
    assert "\n✓ Every check passes" in told
    for text in (told, page):
        assert "✓ Every check passes in the only case." in text
        assert "Left out by name: RSN9." in " ".join(text.split())
    assert "Left out by name" in page
