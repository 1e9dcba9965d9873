"""A cue maker's way through the designer in a real browser, from nothing to a report and a scene (regression)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from tests.helpers.designer_browser import BROWSER, downloaded, needs_browser, opened, served, settled, shown, turn

sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright: pip install playwright")
pytestmark = needs_browser()
OUNCE = 28.349523125e-3  # kg
DRAWING = "position (in);diameter (in)\n0;0,5\n13;0,52\n29;0,85\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("journey")
    (made / "mine.csv").write_text(DRAWING, encoding="utf-8")
    return made


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with served(tmp_path_factory.mktemp("designer")) as found:
        yield found


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with sync_api.sync_playwright() as driver:
        options = ["--no-sandbox", "--disable-gpu"]
        found = driver.chromium.launch(executable_path=BROWSER, args=options)
        yield found
        found.close()


def test_a_cue_maker_goes_all_the_way(browser: Any, address: str, folder: Path, tmp_path: Path) -> None:
    with opened(browser, address) as page:
        # a drawing, its weight in ounces, the game
        page.locator("input[type=file]").first.set_input_files(folder / "mine.csv")
        page.get_by_label("Weight, g").fill("19.5 oz")
        page.get_by_role("combobox", name="Game").click()
        page.get_by_role("option", name="pool", exact=True).click()
        page.get_by_role("button", name="Open it", exact=True).last.click()
        page.get_by_role("heading", level=1, name="mine.csv").wait_for()
        settled(page)
        drawn = cf.load(downloaded(page, "Save as .toml", tmp_path))
        assert drawn.cue.mass == pytest.approx(19.5 * OUNCE, rel=1e-9)
        assert drawn.cue.length == pytest.approx(29 * 0.0254)
        assert drawn.ball == cf.usual_scene(drawn.cue, "pool").ball

        # three designs beside each other
        page.get_by_role("button", name="Pin this design").click()
        turn(page, "tip_diameter", "ArrowLeft", 6)
        page.get_by_role("button", name="Pin this design").click()
        turn(page, "bore_depth", "PageUp", 2)
        columns = page.locator("thead th").all_inner_texts()
        assert columns[:4] == ["number", "this design", "mine 1", "mine 2"]
        felt = 'tr:has([data-number="end_mass_stick"]) td span'
        row = page.locator(felt).all_inner_texts()
        bored, plain, thin = (float(cell.split()[0]) for cell in row)
        assert bored < thin < plain

        # a link that opens the same three
        page.get_by_role("button", name="Link").click()
        link = page.get_by_label("Link", exact=True).input_value()
        page.get_by_role("button", name="Close").click()
        with opened(browser, link) as other:
            other.get_by_role("heading", level=1, name="mine.csv").wait_for()
            assert other.locator("thead th").all_inner_texts()[:4] == columns[:4]
            assert other.locator(felt).all_inner_texts() == row

        # back to the first one
        page.get_by_role("button", name="Work on it").first.click()
        settled(page)

        # the scene and the report
        made = cf.load(downloaded(page, "Save as .toml", tmp_path))
        assert cf.strike(made).squirt == pytest.approx(np.radians(float(shown(page, "squirt").rstrip("°"))), abs=2e-5)
        report = downloaded(page, "Write the report", tmp_path).read_text(encoding="utf-8")
        assert "<h1>mine 1</h1>" in report
        squirt = float(re.search(r"<title>mine 1: squirt ([0-9.]+)°", report)[1])  # type: ignore[index]
        assert squirt == pytest.approx(float(shown(page, "squirt").rstrip("°")), rel=5e-3)  # of its own accuracy
        assert report.count('<svg class="chart read"') == 4
