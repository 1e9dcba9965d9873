"""The designer in a headless browser: one journey, accessibility, and nothing cut off (regression)."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.designer.start import first_scene
from tests.helpers.command_line import call
from tests.helpers.designer_browser import downloaded, launched, needs_browser, opened, served, settled, shown, turn

axe = pytest.importorskip(
    "axe_playwright_python.sync_playwright", reason="needs axe: pip install axe-playwright-python"
)
pytestmark = needs_browser()
OUNCE = 28.349523125e-3  # kg
DRAWING = "position (in);diameter (in)\n0;0,5\n13;0,52\n29;0,85\n"


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with launched() as made:
        yield made


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with served(tmp_path_factory.mktemp("designer")) as made:
        yield made


def faults(page: Any, part: str = "body") -> list[tuple[str, list[str]]]:
    """The serious and critical faults of a part of a page: each rule, and where it is broken."""
    found = axe.Axe().run(page, part).response["violations"]
    return [
        (one["id"], [str(node["target"]) for node in one["nodes"]])
        for one in found
        if one["impact"] in ("serious", "critical")
    ]


def test_a_cue_maker_goes_all_the_way(browser: Any, address: str, tmp_path: Path) -> None:
    """A wrong file, a drawing with its weights and game, sliders, pins, undo, the scene and the report."""
    (tmp_path / "mine.csv").write_text(DRAWING, encoding="utf-8")
    (tmp_path / "broken.toml").write_text("[[segments", encoding="utf-8")
    with opened(browser, address) as page:
        assert cf.load(downloaded(page, "Save as .toml", tmp_path)) == first_scene()
        page.locator("input[type=file]").first.set_input_files(tmp_path / "broken.toml")
        alert = page.locator(".said[role=alert]").filter(has_text="broken.toml: must be TOML")
        alert.wait_for()
        assert "Traceback" not in alert.inner_text()
        page.locator("input[type=file]").first.set_input_files(tmp_path / "mine.csv")
        page.get_by_label("Weight, g").fill("19.5 oz")
        page.get_by_label("Weight of the shaft").fill("112 g")
        page.get_by_role("combobox", name="Game").click()
        page.get_by_role("option", name="pool", exact=True).click()
        page.get_by_role("button", name="Open it", exact=True).last.click()
        page.get_by_role("heading", level=1, name="mine.csv").wait_for()
        settled(page)
        drawn = cf.load(downloaded(page, "Save as .toml", tmp_path))
        assert drawn.cue.mass + drawn.leather.mass_on(drawn.cue) == pytest.approx(19.5 * OUNCE, rel=1e-9)
        assert drawn.cue.shaft_mass + drawn.leather.mass_on(drawn.cue) == pytest.approx(0.112, rel=1e-9)
        assert drawn.cue.weighed
        assert drawn.cue.length == pytest.approx(29 * 0.0254)

        page.get_by_role("button", name="Pin this design").click()
        turn(page, "tip_diameter", "ArrowLeft", 6)
        thin = shown(page, "squirt")
        page.get_by_role("button", name="Undo").click()
        page.wait_for_function("was => document.querySelector('[data-number=squirt]').innerText !== was", arg=thin)
        page.get_by_role("button", name="Redo").click()
        page.wait_for_function("was => document.querySelector('[data-number=squirt]').innerText === was", arg=thin)
        settled(page)
        path = downloaded(page, "Save as .toml", tmp_path)
        assert cf.strike(cf.load(path)).squirt == pytest.approx(math.radians(float(thin.rstrip("°"))), abs=2e-5)
        lines = call("end-mass", path)[1].splitlines()
        stick = next(line for line in lines if line.strip().startswith("stick"))
        assert shown(page, "end_mass_stick") == re.split(r"  +", stick.strip())[1]
        report = downloaded(page, "Write the report", tmp_path).read_text(encoding="utf-8")
        squirt = float(re.search(r"<title>mine[^:]*: squirt ([0-9.]+)°", report)[1])  # type: ignore[index]
        assert squirt == pytest.approx(float(thin.rstrip("°")), rel=5e-3)  # of its own accuracy


CUT_OFF = """() => {
  const box = e => e.getBoundingClientRect(), all = what => [...document.querySelectorAll(what)];
  const texts = all("svg.chart text, svg.cue text").map(box);
  return {
    scroll: document.documentElement.scrollWidth,
    wide: all("section, figure, button, .knob").filter(e => box(e).right > innerWidth + 1).map(e => e.className),
    outside: texts.filter(r => r.right > innerWidth || r.left < 0).length,
    smallest: Math.min(...texts.map(r => r.height)),
  };
}"""


@pytest.mark.parametrize(("scheme", "width"), [("light", 1280), ("dark", 390)])
def test_everybody_reads_it_and_nothing_is_cut_off(browser: Any, address: str, scheme: str, width: int) -> None:
    with opened(browser, address, width=width, scheme=scheme) as page:
        page.get_by_role("button", name="Pin this design").click()
        turn(page, "tip_diameter", "ArrowLeft", 2)
        found = page.evaluate(CUT_OFF)
        assert found["scroll"] <= width
        assert (found["wide"], found["outside"]) == ([], 0)
        assert found["smallest"] > 6.5  # px, of a text's line
        page.get_by_text("Everything in this design").click()
        page.get_by_role("checkbox", name="AxialWaves").wait_for()
        page.locator("svg.read").first.focus()
        page.keyboard.press("ArrowRight")
        assert faults(page) == []
