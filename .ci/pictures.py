"""README's pictures: the figure of the chain by its study, and the report page of pool_hollow as chromium shows it.

Stored where they belong, or in another folder: .venv/bin/python .ci/pictures.py [FOLDER]
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

from studies.paper import chain

STUDIES = Path(chain.__file__).parents[1]
SIZE = {"width": 900, "height": 820}


def draw_report(cue: Path, picture: Path) -> None:
    """The first screen of the page that `cuefem report CUE -o` writes."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        page = Path(folder) / "report.html"
        subprocess.run([sys.executable, "-m", "cuefem", "report", cue, "-o", page], check=True, capture_output=True)
        # the browser of the system, as in the tests; else the one that playwright installed
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        shown = browser.new_page(viewport=SIZE, color_scheme="light")
        shown.goto(page.as_uri())
        shown.screenshot(path=picture)
        browser.close()


if __name__ == "__main__":
    other = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    for name, figure in chain.STUDY.figures.items():
        figure.save((other or chain.STUDY.path.parent) / name)
    draw_report(STUDIES.parent / "meshes" / "pool_hollow.toml", (other or STUDIES) / "report.png")
