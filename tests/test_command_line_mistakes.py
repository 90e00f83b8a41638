"""Mistakes in command lines: what an answer names, put in the place of the mistake, gives the line that was meant."""

import re
import shlex

import pytest
from report_samples import write_results
from studies import study_text, write_study

from rockbatch.commands.arguments import COMMANDS
from rockbatch.commands.cli import main, parser

MENDED = [  # the line as it is written, and as it was meant
    # values
    ("run pier.toml --jobs 2.0", "run pier.toml --jobs 2"),
    ("run pier.toml --jobs 4x", "run pier.toml --jobs 4"),
    ("run pier.toml --jobs=2cores", "run pier.toml --jobs=2"),
    ("run pier.toml -j4", "run pier.toml --jobs 4"),
    ("fragility pier.toml -j2", "fragility pier.toml --jobs 2"),
    ("run pier.toml --engine Dask", "run pier.toml --engine dask"),
    ("run pier.toml --engine thread", "run pier.toml --engine threads"),
    ("run pier.toml --csv Semicolon", "run pier.toml --csv semicolon"),
    ("run pier.toml --shard 1-4", "run pier.toml --shard 1/4"),
    ("run pier.toml --shard 1,4", "run pier.toml --shard 1/4"),
    ("run pier.toml --shard 3of4", "run pier.toml --shard 3/4"),
    ("run pier.toml --shard 2:4", "run pier.toml --shard 2/4"),
    ("report out --paper a4", "report out --paper A4"),
    ("report out --paper letter", "report out --paper Letter"),
    ("report out --paper=LETTER", "report out --paper=Letter"),
    ("report out other --pair a:b", "report out other --pair a=b"),
    ("report out other --pair a,b", "report out other --pair a=b"),
    ("report out other --pair a==b", "report out other --pair a=b"),
    ("report out other --pair a->b", "report out other --pair a=b"),
    ("report out other --pair a=>b", "report out other --pair a=b"),
    ("motions records --dt 0,01", "motions records --dt 0.01"),
    ("motions records --dt 0.01s", "motions records --dt 0.01"),
    ("motions records --dt 10ms", "motions records --dt 0.01"),
    ("motions records --dt 100Hz", "motions records --dt 0.01"),
    ("motions records --dt 200hz", "motions records --dt 0.005"),
    ("motions records --sensitivity 428000counts", "motions records --sensitivity 428000"),
    ("motions records --sensitivity 428000,5", "motions records --sensitivity 428000.5"),
    ("motions records --layout wrap", "motions records --layout wrapped"),
    ("motions records --layout Columns", "motions records --layout columns"),
    ("motions records --role Horizontal", "motions records --role horizontal"),
    # signs before options
    ("run pier.toml —dry-run", "run pier.toml --dry-run"),
    ("run pier.toml –strict", "run pier.toml --strict"),
    ("run pier.toml /strict", "run pier.toml --strict"),
    ("run pier.toml -dry-run", "run pier.toml --dry-run"),
    ("run pier.toml out=there", "run pier.toml --out=there"),
    ("run pier.toml –out=there", "run pier.toml --out=there"),
    ("cache clear", "cache --clear"),
    ("check out all", "check out --all"),
    # other words for options and commands
    ("cache --clean", "cache --clear"),
    ("check out --check rules.toml", "check out --rules rules.toml"),
    ("check out rules.toml", "check out --rules rules.toml"),
    ("report out --pdf", "report out --sheet"),
    ("statics pier.toml --out s.csv", "statics pier.toml --csv s.csv"),
    ("motions records --out r.csv", "motions records --csv r.csv"),
    ("motions records --manifest", "motions records --write-manifest"),
    ("motions records --write", "motions records --write-manifest"),
    ("run pier.toml --records there", "run pier.toml --motions there"),
    ("design pier.toml --cores 2", "design pier.toml --jobs 2"),
    ("spectrum pier.toml --output there", "spectrum pier.toml --out there"),
    ("validate out", "check out"),
    ("pdf out", "report out"),
    ("stat pier.toml", "statics pier.toml"),
    ("--jobs 2 run pier.toml", "run --jobs 2 pier.toml"),
    ("--all check out", "check --all out"),
    ("pier.toml", "run pier.toml"),
    ("rockbatch run pier.toml", "run pier.toml"),
    ("python -m rockbatch check out", "check out"),
    # places
    (r"run .\pier.toml", "run ./pier.toml"),
    (r"run .\pier.toml --strict", "run ./pier.toml --strict"),
    ("run pier --strict", "run pier.toml --strict"),
    ("run pier.tom", "run pier.toml"),
    ("check ot", "check out"),
    ("report outt", "report out"),
    ("statement Out1", "statement out"),
    ("check out --rules rule.toml", "check out --rules rules.toml"),
    ("motions record", "motions records"),
    (r"motions .\records", "motions records"),
    ("run pier.toml --motions records/*.AT2", "run pier.toml --motions records"),
    ("run pier.toml --motions record", "run pier.toml --motions records"),
]
OF_OTHERS = [
    ("run pier.toml --rules rules.toml", "check"),
    ("run pier.toml --sheet", "report"),
    ("run pier.toml --pair a=b", "report"),
    ("run pier.toml --case pads", "statement"),
    ("run pier.toml --html page.html", "motions"),
    ("check out --strict", "run"),
    ("check out --history one", "run"),
    ("statics pier.toml --jobs 2", "run"),
    ("motions records --dry-run", "run"),
    ("design pier.toml --curves c.csv", "statics"),
]
WITHOUT = [  # nothing of it can be known, and what is said
    ("run pier.toml --jobs four", "four: must be at least 1, a whole number"),
    ("run pier.toml --jobs 0", "0: must be at least 1"),
    ("run pier.toml --jobs all", "all processors are the default; leave the option out"),
    ("run pier.toml --engine slurm", "slurm: must be threads or dask"),
    ("run pier.toml --csv comma", "comma: must be semicolon"),
    ("run pier.toml --shard 5/4", "5/4: must be such as 2/4"),
    ("run pier.toml --shard 5-4", "5-4: must be such as 2/4"),
    ("run pier.toml --quiet", "unrecognized arguments: --quiet; see"),
    ("run pier.toml --gpu", "unrecognized arguments: --gpu; see"),
    ("run pier.toml --title Pier", "unrecognized arguments: --title Pier; see"),
    ("run pier.toml -f", "unrecognized arguments: -f; see"),
    ("run pier.toml other.toml", "other.toml; one study at a time"),
    ("run out", "out: a folder of results; give a study file"),
    ("run pier.toml --out rules.toml", "rules.toml: a file stands in the place of the folder"),
    ("report out --paper A3", "A3: must be A4 or Letter"),
    ("report out --pair a", "a: must be two cases in a word, such as pads=springs"),
    ("motions records --role vertical", "vertical: must be horizontal"),
    ("motions records --dt often", "often: must be a number alone"),
    ("motions records --dt inf", "inf: must be a finite number"),
    ("motions records --dt nan", "nan: must be a finite number"),
    ("motions records --sensitivity 1e999", "1e999: must be a finite number"),
    ("motions records --dt 1,000,5", "1,000,5: must be a number alone"),
    ("motions records --csv=", "must be a file; it is empty: write - to print it"),
    ("check pier.toml", "pier.toml: a file, not a folder of results; give the folder"),
    ("check nowhere", "nowhere: not there, or without results of `rockbatch run`; give a folder"),
]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_study(tmp_path, study_text(), "pier.toml")
    write_study(tmp_path, '[[check]]\nname = "no study"\n', "rules.toml")
    (tmp_path / "records").mkdir()
    (tmp_path / "out").mkdir()
    write_results(tmp_path / "out")


def answer(words, capsys):
    """Return what is said of a line that ends with 2."""
    try:
        code = main(words)
    except SystemExit as ended:
        code = ended.code
    assert code == 2
    return capsys.readouterr().err.strip()


def mended(words, said):
    """Return the words of a line with what is named in the place of the mistake, or the line that is named as a whole."""
    named = shlex.split(re.search(r"did you mean (.*?)\?", said)[1])
    if re.search(r"stand behind the command|before the command", said):
        return named
    places = (r"no command", r"unrecognized arguments:", r"argument --\w+:", r"pier.toml: --motions", r"rockbatch:")
    found = next(filter(None, (re.search(rf"{each} (\S+?)[:;]?(?: |$)", said) for each in places)))
    wrong = found[1]
    place = next(n for n, word in enumerate(words) if wrong in (word, word.partition("=")[2]))
    option = words[place].removesuffix(wrong)
    return [*words[:place], option + named[0], *named[1:], *words[place + 1 :]]


@pytest.mark.sweep(fast=30)
@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(("line", "meant"), MENDED)
def test_what_is_named_in_the_place_of_the_mistake_gives_the_line_meant(line, meant, capsys):
    words = line.split()
    assert mended(words, answer(words, capsys)) == meant.split()
    parser().parse_args(meant.split())


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(("line", "other"), OF_OTHERS)
def test_an_option_of_another_command_is_answered_with_that_command(line, other, capsys):
    said = answer(line.split(), capsys)
    option, command = re.search(r"; (--[\w-]+) is an option of `rockbatch (\w+)`", said).groups()
    assert command == other
    assert option in line.split()
    assert option in COMMANDS[other].arguments
    assert "did you mean" not in said


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(("line", "says"), WITHOUT)
def test_where_nothing_can_be_known_the_answer_says_what_is_expected(line, says, capsys):
    said = answer(line.split(), capsys)
    assert says in said
    assert "did you mean" not in said
