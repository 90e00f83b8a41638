"""The section of the records: spectra, doubts about a record, and files that were not used."""

import json

import pytest
from report_samples import write_results

from rockbatch.reporting import write_report


@pytest.mark.parametrize("count", [1, 3, 20])
def test_few_spectra_are_drawn_with_names_and_many_as_a_spread(tmp_path, count):
    names = [(f"record {i}", 0.1 + 0.01 * i) for i in range(count)]
    spectra = {"damping": 0.05, "period_s": [0.1, 1.0, 5.0], "sa_g": [[1.0, 0.5 + 0.1 * i, 0.1] for i in range(count)]}
    write_results(tmp_path, records=names, spectra=spectra)
    text = write_report(tmp_path).read_text(encoding="utf-8")
    drawn = text[text.index(f"Response spectra of {count} ground motions") :].split("</ul>")[0]
    assert drawn.count("<path") > count
    assert (">record 0<" in drawn) == (count < 20)
    assert drawn.count(">16 and 84 %<") == (count == 20)  # one entry for two lines that look alike
    assert ("median" in drawn) == (count > 1)


def test_what_is_odd_about_a_record_and_whether_it_is_processed_stand_in_the_table(tmp_path):
    write_results(tmp_path, records=[("rings", 0.2), ("plain", 0.3)])
    info = json.loads((tmp_path / "run.json").read_text(encoding="utf-8"))
    odd = [{"what": what, "text": what, "gross": True, "key": "confirm"} for what in ("alternates", "no PGD")]
    info["records"][0] |= {"processed": False, "findings": odd, "pgd_m": None}
    info["records"][1] |= {"processed": True, "findings": []}
    (tmp_path / "run.json").write_text(json.dumps(info), encoding="utf-8")
    text = write_report(tmp_path).read_text(encoding="utf-8")
    assert '<a href="#records">One record to check</a>, ' in text
    table = text[text.rindex(">to check<") :].split("</table>")[0]
    assert ">alternates, no PGD<" in table
    assert table.index(">no<") < table.index(">yes<")
    assert "displacement 0.30 m" in text


def test_files_left_out_are_separate_from_unusable_ones(tmp_path):
    left_out = [{"name": "meta", "source": "a/<meta>.json", "reason": "no record: text about the records"}]
    write_results(tmp_path, left_out=left_out)
    text = write_report(tmp_path).read_text(encoding="utf-8")
    assert "a/&lt;meta&gt;.json" in text
    assert "Left out" in text
    assert "could not be used" not in text
