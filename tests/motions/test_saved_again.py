"""What editors, archives and transfers do to a text, or to the name of a file, changes nothing that is read of it."""

import io
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from damaged_files import SAMPLES

from rockbatch.motions.formats import dyna, geonet, read_record
from rockbatch.motions.sources.record_file import ReadOptions, RecordFile

STATED = ReadOptions(unit="m/s2", sensitivity=1e5)
TEXTS = [(name, file, data) for name, files in SAMPLES.items() for file, data in files if b"\x00" not in data]
AGAIN = {
    "CR LF": lambda text: text.replace("\n", "\r\n"),
    "CR": lambda text: text.replace("\n", "\r"),
    "UTF-8 with its mark": lambda text: "\ufeff" + text,
    "spaces at the ends of lines": lambda text: text.replace("\n", "  \n"),
    "without the last end of a line": lambda text: text.rstrip("\n"),
    "blank lines at the end": lambda text: text + "\n\n",
    "the mark of the end of DOS": lambda text: text + "\x1a",
}
OF_NAME = {"name", "sources"}


def facts(file, data):
    """Return all that is read of a file, but for its name, with samples to the bit."""
    found = read_record(RecordFile(Path(file), file, data, options=STATED))
    every = ({field.name: getattr(one, field.name) for field in fields(one)} for one in found)
    return [
        {
            key: value.tobytes() if isinstance(value, np.ndarray) else value
            for key, value in one.items()
            if key not in OF_NAME
        }
        for one in every
    ]


@pytest.mark.parametrize(("name", "file", "data"), TEXTS, ids=[f"{name} {file}" for name, file, _ in TEXTS])
def test_a_text_that_is_saved_again_is_read_as_it_was(name, file, data):
    text = data.decode("latin-1").replace("\r\n", "\n")
    as_it_was = facts(file, data)
    assert {way: facts(file, again(text).encode()) == as_it_was for way, again in AGAIN.items()} == dict.fromkeys(
        AGAIN, True
    )


@pytest.mark.parametrize(("name", "file", "data"), TEXTS, ids=[f"{name} {file}" for name, file, _ in TEXTS])
def test_a_suffix_in_other_letters_is_the_same_suffix(name, file, data):
    path = Path(file)
    for suffix in (path.suffix.upper(), path.suffix.lower()):
        assert facts(path.stem + suffix, data) == facts(file, data)


@pytest.mark.parametrize(("file", "is_file"), [("x.ASC", dyna.is_dyna_file), ("x.V1A", geonet.is_geonet_file)])
def test_obspy_recognises_a_text_with_the_mark_of_utf_8(file, is_file):
    (data,) = (data for _, name, data in TEXTS if name == file)
    assert is_file(io.BytesIO("\ufeff".encode() + data))
