"""Add to the site what comes from the program itself and from the documents at the repository's top; a hook of MkDocs.

Nothing of it is kept: the study file's reference and schemas come from the reader's tables, the
commands from their parsers, the figures of the verification from the CSV files in benchmarks/, the pictures from gallery/. The
verification is a PDF, too.
"""

import contextlib
import csv
import importlib.util
import inspect
import io
import json
import os
import re
from collections.abc import Callable, Iterable, Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page
from printing import as_pdf

import rockbatch
from rockbatch import motions
from rockbatch.commands.cli import COMMANDS, main
from rockbatch.common.showing import shown
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.quantity import BASES_IN_WORDS
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.study.schema import FILES, MANIFEST, STUDY, schema_of
from rockbatch.toml.kinds import Choice
from rockbatch.toml.section import Key, Section

HERE = Path(__file__).parent
TOP = HERE.parent
DOCUMENTS = {
    "theory.md": "THEORY.md",
    "performance.md": "benchmarks/README.md",
    "reference/columns.md": "docs/columns.md",
    "reference/motions.md": "motions/README.md",
}
"""Pages that are documents of the repository."""


def _is_error(name: str) -> bool:
    """Return whether a public name is a class of errors below ``InputError``."""
    thing = getattr(rockbatch, name)
    return isinstance(thing, type) and issubclass(thing, rockbatch.InputError) and thing is not rockbatch.InputError


TOPICS: dict[str, tuple[str, tuple[str, ...]]] = {
    "studies": (
        "Studies and results",
        ("load_study", "Study", "run", "Dask", "open_results", "report", "statement", "check", "Rule"),
    ),
    "piers": (
        "Piers and bases",
        (
            "Pier",
            "Part",
            "RigidBase",
            "ElasticBase",
            "YieldingBase",
            "FootingBase",
            "Damper",
            "Tendon",
            "Stop",
            "DeckSpring",
            "statics",
            "Statics",
        ),
    ),
    "runs": ("Single runs", ("simulate", "Response")),
    "analyses": (
        "Analyses",
        ("design", "fragility", "HazardCurve", "spectrum", "sensitivity", "release", "accuracy"),
    ),
    "motions": (
        "Ground motions",
        ("read_motions", "ReadOptions", "Motion", "MotionSet", "pulse", "sequence", "pair_spectrum"),
    ),
    "errors": ("Errors", ("InputError", "Problem", *(name for name in rockbatch.__all__ if _is_error(name)))),
}
"""Pages of the Python reference, with their headings and the public names on them."""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages, schemas and pictures that are made."""
    pages: dict[str, str | bytes] = {page: _included(document, page) for page, document in DOCUMENTS.items()}
    pages |= {
        "reference/study.md": _study(),
        "reference/files.md": _other_files(),
        "reference/commands.md": _commands(),
    } | {f"reference/python/{name}.md": text for name, text in _python().items()}
    for name, sections in FILES.items():
        pages[f"reference/{name}.schema.json"] = json.dumps(schema_of(sections, f"rockbatch {name}"), indent=1)
    pictures = {f"pictures/{script.stem}.svg": _picture(script) for script in sorted((HERE / "gallery").glob("*.py"))}
    pages |= pictures
    pages["verification.pdf"] = _verification(pictures)
    for path, content in pages.items():
        files.append(File.generated(config, path, content=content))
    for image in sorted((HERE / "images").iterdir()):
        files.append(File.generated(config, f"images/{image.name}", abs_src_path=str(image)))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Put the counted figures in the place of ``<!-- name -->``."""
    return _counted(markdown)


def on_page_content(html: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Take the roles of Sphinx from the names in docstrings."""
    return re.sub(r":(?:attr|class|data|func|meth|mod):<code>", "<code>", html)


def on_post_build(config: MkDocsConfig) -> None:
    """Refuse a site that would load anything from the network."""
    loading = re.compile(
        r'<(?:script|img|iframe)[^>]*\ssrc="?(?:https?:)?//|<link[^>]*stylesheet[^>]*href="?(?:https?:)?//'
    )
    for page in Path(config.site_dir).rglob("*.html"):
        if match := loading.search(page.read_text(encoding="utf-8")):
            raise PluginError(f"{page}: loads something from the network: {match.group()}")


# Documents of the repository


def _included(document: str, page: str) -> str:
    """Return a document as Python-Markdown wants it, with links as they are from its page.

    What belongs to an item of a list is indented by four; an equation's number comes closer, so that no line is very long.
    """
    lines = []
    indent = 0
    for line in (TOP / document).read_text(encoding="utf-8").splitlines():
        if item := re.match(r"(- |\d+\. )", line):
            indent = len(item.group())
        elif line and not line.startswith(" "):
            indent = 0
        elif line:
            shift = " " * (4 - indent) if indent else ""
            line = shift + re.sub(r" {5,}(\(\d+\)$)", r"    \1", line)
        lines.append(line)
    text = "\n".join(lines) + "\n"
    return re.sub(r"\]\(([\w./-]+)", lambda link: f"]({_on_site(link.group(1), document, page)}", text)


def _on_site(link: str, document: str, page: str) -> str:
    """Return a link of a document as it is from its page on the site; unchanged if its target is not there."""
    target = os.path.normpath(Path(document).parent / link)
    on_site = {source: local for local, source in DOCUMENTS.items()}
    place = on_site.get(target)
    for folder, source in (("docs/images/", "images/"), ("docs/pages/", "")):
        if target.startswith(folder):
            place = source + target.removeprefix(folder)
    return os.path.relpath(place, Path(page).parent) if place else link


# The study file


def _study() -> str:
    return "\n".join(
        [
            "# The study file",
            "",
            "A study is a TOML file. This page lists every table and key that rockbatch reads; it is made of the reader's own",
            "tables. A key that may have several values is marked *or a list*: the study then runs every combination.",
            "",
            "All mistakes in a study are reported together, each with its line and its remedy, before anything runs. Editors",
            "that know JSON Schema (Taplo, Even Better TOML) underline most of them while you write: put",
            "[study.schema.json](study.schema.json) beside the study and, as its first line,",
            "",
            "```toml",
            "#:schema study.schema.json",
            "```",
            "",
            "`python -m rockbatch.study.schema study > study.schema.json` writes the same file.",
            "",
            *_sections(STUDY),
            *_demands(),
        ]
    )


def _other_files() -> str:
    return "\n".join(
        [
            "# Files of checks and manifests",
            "",
            "## A file of checks",
            "",
            "`rockbatch check DIR --rules RULES.toml` holds results against the checks of a file of their own. It has the keys",
            "`title` and `notes`, and tables `[[check]]` as in [the study file](study.md#check), where they are described.",
            "Its schema is [checks.schema.json](checks.schema.json).",
            "",
            "## A manifest",
            "",
            "Its schema is [manifest.schema.json](manifest.schema.json).",
            "",
            *_sections(section for section in MANIFEST if section.at),
        ]
    )


def _sections(sections: Iterable[Section]) -> Iterator[str]:
    for section in sections:
        anchor = "-".join(section.at) or "top"
        heading = f"`{section.header}`" if section.header else "At the top"
        yield from (f"## {heading} {{ #{anchor} }}", "", section.about, "")
        yield from ("| key | value | default | meaning |", "| --- | --- | --- | --- |")
        for name, key in section.items():
            yield f"| `{name}` | {_value(key)} | {_default(section, name)} | {_only(key)}{key.words} |"
        yield ""


def _only(key: Key) -> str:
    """Return the values of other keys with which a key applies, to stand before its meaning."""
    conditions = [" or ".join(f"`{name} = {shown(value)}`" for value in values) for name, values in key.only.items()]
    return f"With {', '.join(conditions)}: " if conditions else ""


def _value(key: Key) -> str:
    if isinstance(key.kind, Choice) and not key.kind.own_words:
        words = "one of " + ", ".join(f"`{shown(option)}`" for option in key.kind.options)
        if len(key.kind.options) > 10:
            words = "one of [these](#demands)"
    else:
        words = f"{'a range, each end ' if key.pair else ''}{key.kind.words}, such as `{key.example}`"
    return words + (", or a list" if key.many else "")


def _default(section: Section, name: str) -> str:
    if section[name].always_required:
        return "**required**"
    default = section.default(name)
    if default is None:
        return ""
    return f"`{shown(list(default)) if isinstance(default, tuple) else _number(default)}`"


def _number(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else shown(value)


def _demands() -> Iterator[str]:
    yield from ("## What a check may ask { #demands }", "", "| demand | meaning | bases |", "| --- | --- | --- |")
    for name, demand in DEMANDS.items():
        yield f"| `{name}` | {demand.words} | {BASES_IN_WORDS[demand.bases] or 'all'} |"
    yield from ("", "## Statistics over the records { #statistics }", "", "| statistic | meaning |", "| --- | --- |")
    for name, statistic in STATISTICS.items():
        yield f"| `{name}` | {statistic.words} |"
    yield ""


# Columns, commands, Python


def _commands() -> str:
    parts = [(HERE / "commands.md").read_text(encoding="utf-8")]
    for name in COMMANDS:
        parts += [f"## rockbatch {name} {{ #{name} }}", "", "```text", _help(name), "```", ""]
    return "\n".join(parts)


def _help(command: str) -> str:
    """Return what ``rockbatch COMMAND --help`` prints."""
    printed, width = io.StringIO(), os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = "84"
    try:
        with contextlib.redirect_stdout(printed), contextlib.suppress(SystemExit):
            main([command, "--help"])
    finally:
        os.environ.pop("COLUMNS") if width is None else os.environ.update(COLUMNS=width)
    return printed.getvalue().rstrip()


def _python() -> dict[str, str]:
    """Return the pages of the Python reference by their names, with every public name on one of them."""
    listed = [name for _, names in TOPICS.values() for name in names]
    if sorted(listed) != sorted(rockbatch.__all__):
        raise PluginError(f"TOPICS: not the public names: {set(listed) ^ set(rockbatch.__all__)}")
    pages = {
        topic: "\n".join([f"# {heading}", "", *(f"::: {_home(name)}.{name}\n" for name in names)])
        for topic, (heading, names) in TOPICS.items()
    }
    heading, _, members = pages["errors"].partition("\n\n")
    pages["errors"] = f"{heading}\n\n{_tree()}\n\n{members}"
    further = [name for name in motions.__all__ if name not in rockbatch.__all__]
    pages["motions"] += "\n".join(
        ["# Of `rockbatch.motions` alone", "", *(f"::: rockbatch.motions.{name}\n" for name in further)]
    )
    pages["index"] = "\n".join(
        [
            "# Python",
            "",
            "`import rockbatch as rb` has these names. Modules behind them are for those who extend rockbatch.",
            "",
            "| topic | names |",
            "| --- | --- |",
            *(f"| [{heading}]({topic}.md) | {_links(topic, names)} |" for topic, (heading, names) in TOPICS.items()),
            f"| [`from rockbatch import motions`](motions.md) | {_links('motions', further)} |",
            "",
        ]
    )
    return pages


def _tree() -> str:
    """Return what the module of the errors says of them, with their tree as a block of code."""
    said = inspect.cleandoc(import_module("rockbatch.common.errors").__doc__ or "")
    above, _, tree = said.partition("\n\n    InputError")
    prose = re.sub(r":class:`(\w+)`", r"`\1`", above).replace("``", "`")
    return f"{prose}\n\n```text\n{inspect.cleandoc('InputError' + tree)}\n```"


def _home(name: str) -> str:
    """Return the module of a public name; ``rb.report`` is its package, which can be called."""
    documented = getattr(rockbatch, name)
    return documented.__name__ if isinstance(documented, ModuleType) else documented.__module__


def _links(topic: str, names: Iterable[str]) -> str:
    return ", ".join(f"[`{name}`]({topic}.md#{_anchor(name)})" for name in names)


def _anchor(name: str) -> str:
    return f"{_home(name) if name in rockbatch.__all__ else 'rockbatch.motions'}.{name}"


# Pictures, counts and paper


def _picture(script: Path) -> bytes:
    spec = importlib.util.spec_from_file_location(script.stem, script)
    if spec is None or spec.loader is None:
        raise PluginError(f"{script}: is no script")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    picture = io.BytesIO()
    module.draw().savefig(picture, format="svg", metadata={"Date": None})
    return picture.getvalue()


def _errors() -> Iterator[str]:
    """Yield a table of true errors beside the reported ones, base by base, from benchmarks/error_estimates.csv."""
    rows = _csv("error_estimates.csv")
    yield "| base | quantity | true ≤ reported | greatest true/reported | greatest true error |"
    yield "| --- | --- | --- | --- | --- |"
    for base in [*dict.fromkeys(row["base"] for row in rows), ""]:
        for quantity, symbol in (("theta_max", "θ_max/α"), ("theta_res", "θ_res/α")):
            pairs = [
                (float(row[f"{quantity}_true"]), float(row[f"{quantity}_reported"]))
                for row in rows
                if base in ("", row["base"]) and "nan" not in (row[f"{quantity}_true"], row[f"{quantity}_reported"])
            ]
            if pairs:
                within = sum(true <= reported for true, reported in pairs)
                ratio = max(true / reported for true, reported in pairs)
                worst = max(true for true, _ in pairs)
                yield f"| {base or 'all'} | {symbol} | {within} of {len(pairs)} | {ratio:.2g} | {worst:.1e} |"


def _outcomes() -> Iterator[str]:
    """Yield a table of how hard cases ended, and of the remarks on them, from benchmarks/outcomes.csv."""
    rows = _csv("outcomes.csv")
    ends = ("ok", "overturned", "flight", "failed")
    yield from (f"| kind of case | cases | {' | '.join(ends)} | remarks |", "| --- |" + " --- |" * (len(ends) + 2))
    for stratum in [*dict.fromkeys(row["stratum"] for row in rows), ""]:
        of_stratum = [row for row in rows if stratum in ("", row["stratum"])]
        counts = " | ".join(str(sum(row["status"] == status for row in of_stratum)) for status in ends)
        remarks = [row["verdict"] for row in of_stratum if row["verdict"]]
        counted = ", ".join(f"{remarks.count(remark)} {remark}" for remark in dict.fromkeys(remarks))
        yield f"| {stratum or 'all'} | {len(of_stratum)} | {counts} | {counted} |"


def _counted(text: str) -> str:
    for name, table in COUNTED.items():
        if f"<!-- {name} -->" in text:
            text = text.replace(f"<!-- {name} -->", "\n".join(table()))
    return text


def _verification(pictures: dict[str, bytes]) -> bytes:
    """Return the page of that name as a report on paper, with the sources that it cites."""
    _, heading, sources = (TOP / "THEORY.md").read_text(encoding="utf-8").partition("\n## Sources\n")
    text = _counted((HERE / "pages" / "verification.md").read_text(encoding="utf-8"))
    text += heading + sources.partition("\n### ")[0]
    shown = {path: picture for path, picture in pictures.items() if f"({path})" in text}
    return as_pdf(text, "Verification of rockbatch", f"rockbatch {rockbatch.__version__}", shown)


def _csv(name: str) -> list[dict[str, str]]:
    with (TOP / "benchmarks" / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


COUNTED: dict[str, Callable[[], Iterator[str]]] = {
    "error estimates": _errors,
    "outcomes": _outcomes,
}
