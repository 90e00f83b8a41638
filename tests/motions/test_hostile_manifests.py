"""Manifests that would cost their reader: each is told, in time and memory that grow with its size and no faster."""

import numpy as np
import pytest
from bounds import bounds
from motion_files import wiggle, write_at2

from rockbatch.common.errors import InputError
from rockbatch.motions import read_motions
from rockbatch.toml.reader import LARGEST, MOST_REPORTED

RECORD = '[[record]]\nfile = "a000.AT2"\n'


@pytest.fixture
def folder(tmp_path):
    write_at2(tmp_path, "a000.AT2", wiggle())
    return tmp_path


def problems(folder, name: str, text: str | bytes) -> list[str]:
    """What is said of a manifest, which must be said soon."""
    (folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    with bounds(3, 800), pytest.raises(InputError) as caught:
        read_motions(folder)
    assert all(problem.startswith(str(folder / name)) for problem in caught.value.messages)
    return [problem[:400] for problem in caught.value.messages]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (RECORD + "scale =" + " " * 200_000 + "x", "not valid TOML"),
        (RECORD + "\n" * 200_000 + "scale =" + " \t" * 100_000 + "\n", "invalid value"),
        (".".join("a" * 60_000) + " = 1", "more than 32 deep"),
        ("[" + ".".join("a" * 60_000) + "]", "more than 32 deep"),
        ("[[" + ".".join("a" * 60_000) + "]]\nx = [", "more than 32 deep"),
        ("x = " + "[" * 100_000, "more than 32 deep"),
        ("x = " + "{a=" * 100_000, "more than 32 deep"),
        (RECORD + "dt = [\n" + "1,\n" * 20_000 + "]", "one value, not a list"),
        (RECORD + "dt = [" + "[]," * 15_000 + "]", "one value, not a list"),
        (RECORD + "dt = [" + "[1],\n" * 10_000 + "]", "one value, not a list"),
        (RECORD + 'dt = "' + "a" * 700_000 + '"', "without quotes"),
        (RECORD + 'role = "' + "a" * 700_000 + '"', "one of"),
        (RECORD + 'station = """' + '""\\"' * 50_000, "not valid TOML"),
        (RECORD + "dt = 0x" + "f" * 100_000, "a finite number"),
        (RECORD + "dt = " + "9" * 100_000, "not valid TOML"),
        (RECORD + "a" * 1_000_000 + " = 1", "unknown key"),
        (RECORD + "".join(f"k{i} = 1\n" for i in range(7_000)), "unknown key"),
        ('[[record]]\nfile = "nobody.AT2"\n' * 2_500, "no such file"),
        ("[[record]]\n" * 12_000, "file is missing"),
        (RECORD * 4_000, "given twice"),
        ("".join(f'{RECORD}component = "{i}"\n' for i in range(2_000)), "the file has"),
        ("".join(f"[t{i}]\n" for i in range(10_000)), "unknown section"),
        ("x = '''" + "''x" * 300_000, "not valid TOML"),
        ("#" * 4_000_000 + "\nx", "not valid TOML"),
        (b"\xff\xfe", "not UTF-8"),
        (" " * LARGEST + "x", "larger than 4 MiB"),
        ('[[record]]\nfile = "a\\u0000"\n', "the name of a file"),
        (f'[[record]]\nfile = "{"a/" * 400_000}"\n', "the name of a file"),
        (f'[[record]]\nfile = "{"a" * 900}"\n', "no such file"),
        ('[[record]]\nfile = "a000.AT2/x"\n', "no such file"),
    ],
)
def test_a_manifest_is_refused_soon_whatever_it_holds(folder, text, said):
    told = problems(folder, "motions.toml", text)
    assert any(said in problem for problem in told)
    assert len(told) <= MOST_REPORTED + 1


def test_more_mistakes_than_are_reported_are_announced(folder):
    told = problems(folder, "motions.toml", RECORD + "".join(f"k{i} = 1\n" for i in range(MOST_REPORTED + 50)))
    assert len(told) == MOST_REPORTED + 1
    assert "there may be more" in told[-1]


def test_a_large_manifest_without_a_mistake_is_read(folder):
    names = [f"x{i:04d}_HNE.AT2" for i in range(3)]
    for i, name in enumerate(names):
        write_at2(folder, name, wiggle(seed=i + 2), title=f"X, 1/17/1994, S{i}, 090")
    lines = "".join(f'[[record]]\nfile = "{name}"\nscale = 2.0\n# {"." * 100_000}\n\n' for name in names)
    (folder / "motions.toml").write_text(lines + "\n" * 1_000_000)
    with bounds(10, 500):
        found = read_motions(folder)
    assert sum("scaled by 2" in str(motion.notes) for motion in found.motions) == 3


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b"file,scale\n" + b'"' + b"a" * 200_000 + b'",2\n', "field larger than field limit"),
        (b'file,scale\n"a000.AT2,2\n' + b"x,1\n" * 100_000, "field larger than field limit"),
        (b"file,scale\n" + b"nobody.AT2,2\n" * 10_000, "no such file"),
        (b"file," + b",".join(b"k%d" % i for i in range(100_000)) + b"\na000.AT2\n", "unknown column"),
        (b"file,scale\na000.AT2\x00,2\n", "the name of a file"),
        (b"file,scale\n" + b"a000.AT2," + b"2" * 1000 + b"\n", "a finite number"),
        (b"file,scale\na000.AT2,2,3,4\n", "4 cells"),
        (b"file\n" + b"x" * LARGEST, "larger than 4 MiB"),
        (b"file,scale\n\xff\n", "not UTF-8"),
    ],
)
def test_a_csv_manifest_is_refused_soon_whatever_it_holds(folder, text, said):
    told = problems(folder, "motions.csv", text)
    assert any(said in problem for problem in told)
    assert len(told) <= MOST_REPORTED + 1


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_a_csv_manifest_has_any_of_the_three_line_ends(folder, end):
    (folder / "motions.csv").write_bytes(end.join(["file,scale", "a000.AT2,2", ""]).encode())
    (motion,) = read_motions(folder, gravity=1.0).motions
    np.testing.assert_allclose(np.abs(motion.horizontal).max(), 2 * np.abs(wiggle()).max(), rtol=1e-6)


def test_a_manifest_of_mistakes_in_a_folder_of_many_files_has_few_hints(folder):
    for i in range(300):
        (folder / f"a{i:06d}.json").touch()
    text = "".join(f'[[record]]\nfile = "b{i:06d}.json"\n' for i in range(300))
    told = problems(folder, "motions.toml", text)
    assert len(told) == MOST_REPORTED + 1
    assert ["did you mean" in problem for problem in told] == [True] * 10 + [False] * (MOST_REPORTED - 9)
