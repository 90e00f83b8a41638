"""Takes the screenshots of the gallery and the README: `make screenshots`.

Two studies on the records that come with rockbatch are run, and the first screens of their reports are taken in Chromium: wide,
narrow, dark and printed. Without Chromium, or of the printed page without pypdfium2, the pictures stay as they are.
"""

import io
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from PIL import Image

import rockbatch as rb

HERE = Path(__file__).parent
IMAGES = HERE.parent / "images"
FIRST = HERE.parents[1] / "configs" / "first_study.toml"
HUNDRED = HERE / "hundred_foundations.toml"
COLOURS = 256
"""Of a picture: with fewer the pale green and red of the scorecard were grey."""


class Shot(NamedTuple):
    """A picture of the first screen of a study's report."""

    study: Path
    width: int
    height: int
    dark: bool = False
    printed: bool = False


SHOTS = {
    "report": Shot(FIRST, 1400, 900),
    "report-dark": Shot(FIRST, 1400, 900, dark=True),
    "report-narrow": Shot(FIRST, 480, 1400),  # to the figure of peaks
    "report-printed": Shot(FIRST, 794, 1123, printed=True),  # A4 at 96 dpi
    "report-hundred": Shot(HUNDRED, 1400, 900),
}


def browser() -> str | None:
    """Chromium, if there is one."""
    return next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


def take(shot: Shot, page: Path, chromium: str) -> Image.Image | None:
    """The picture of a report; None of a printed one that cannot be drawn."""
    with tempfile.TemporaryDirectory() as folder:
        kind = ("print-to-pdf", "page.pdf") if shot.printed else ("screenshot", "page.png")
        made = Path(folder) / kind[1]
        command = [
            chromium,
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
            "--no-pdf-header-footer",
        ]
        command += [f"--user-data-dir={folder}/profile", f"--window-size={shot.width},{shot.height}"]
        command += [
            f"--blink-settings=preferredColorScheme={0 if shot.dark else 1}",
            f"--{kind[0]}={made}",
            page.as_uri(),
        ]
        subprocess.run(command, check=True, capture_output=True, timeout=120)
        return _first_page(made, shot) if shot.printed else Image.open(io.BytesIO(made.read_bytes()))


def _first_page(pdf: Path, shot: Shot) -> Image.Image | None:
    try:
        import pypdfium2
    except ImportError:
        print("no pypdfium2: the printed page stays as it is; pip install pypdfium2", file=sys.stderr)
        return None
    document = pypdfium2.PdfDocument(pdf)
    page = document[0]
    picture = page.render(scale=shot.width / page.get_width()).to_pil()
    document.close()
    return picture


def smaller(picture: Image.Image) -> Image.Image:
    """The picture with a palette, which makes its file small; large areas keep their colour within 2 of 255."""
    return picture.convert("RGB").quantize(COLOURS, Image.Quantize.MAXCOVERAGE, kmeans=3)


def main(images: Path = IMAGES) -> None:
    """Run the studies and write every picture into ``images``."""
    chromium = browser()
    if chromium is None:
        print("no Chromium: the screenshots stay as they are", file=sys.stderr)
        return
    with tempfile.TemporaryDirectory() as folder:
        pages = {}
        for study in (FIRST, HUNDRED):
            rb.run(study, out=Path(folder) / study.stem)
            pages[study] = Path(folder) / study.stem / "report.html"
        for name, shot in SHOTS.items():
            picture = take(shot, pages[shot.study], chromium)
            if picture is not None:
                smaller(picture).save(images / f"{name}.png", optimize=True)
                print(images / f"{name}.png")


if __name__ == "__main__":
    main()
