"""The report in a headless browser: keyboard, print, accessibility, layout (regression)."""

import math
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem.analysis.cue_report import CueReport
from cuefem.analysis.squirt_curve import FINE_OFFSETS, squirt_curve
from cuefem.designs import Response
from cuefem.designs.sweep import SweepStatistics, sweep_charts, tabulate_sweep
from cuefem.files.defaults_report import Assumption
from cuefem.results.records import Record
from cuefem.show.templates import plain_page
from tests.helpers.designer_browser import BROWSER, empty_page, open_browser, violations

pytest.importorskip("playwright.sync_api", reason="needs playwright: pip install playwright")
pytestmark = [pytest.mark.heavy, pytest.mark.skipif(BROWSER is None, reason="needs Chromium: apt-get install chromium")]
SCENE = cf.usual_scene(cf.load(Path(__file__).parents[2] / "meshes" / "pool_maple.toml"))
# tables wider than their container, and elements outside the window
CUT = "[...document.querySelectorAll('.scroll')].filter(e => e.scrollWidth > e.clientWidth + 1).length"
# numbers of the first screen that run into the next one
OVERLAID = """[...document.querySelectorAll('.tiles dd *')].filter(e => {
  const box = e.closest('div').getBoundingClientRect(), own = e.getBoundingClientRect();
  return own.right > box.right + 1;}).map(e => e.innerText)"""
SHEET = rb"/Type /Page\b(?!s)"
OUTSIDE = """[...document.querySelectorAll("section, figure, header, svg:not(.lathe svg) text")]
  .map(e => e.getBoundingClientRect()).filter(r => r.right > innerWidth + 1 || r.left < 0).length"""


@cache
def report() -> CueReport:
    return cf.report(SCENE, details=True)


def report_page() -> str:
    return report().to_html("pool_maple.toml")


@cache
def compare_page() -> str:
    """Five cues, one of a long name."""
    names = ("predator z2", "carbon", "low deflection", "plain maple")
    scenes = {name: cf.usual_scene(cf.load(name)) for name in names}
    return cf.compare({"a_shaft_of_my_own_with_a_long_name": SCENE, **scenes}).to_html()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with open_browser() as instance:
        yield instance


@pytest.fixture
def opened(browser: Any) -> Iterator[Any]:
    with empty_page(browser) as page:
        yield page


def test_report_by_keyboard_shows_values_and_definitions_and_prints(opened: Any) -> None:
    opened.set_content(report_page())
    opened.get_by_text("Other models").click()
    chart, known = opened.locator("svg.read[aria-label^='Squirt by model']"), squirt_curve(SCENE, FINE_OFFSETS).models
    chart.focus()
    opened.keyboard.press("Home")
    for _ in range(3):
        opened.keyboard.press("PageUp")
    at, *values = opened.locator("p.spoken").inner_text().replace("\u00a0", " ").split("; ")
    assert at == "tip offset b/R: 0.300"
    read = {name: float(value) for name, value in (line.rsplit(" ", 1) for line in values)}
    i = FINE_OFFSETS.index(0.3)
    assert read == {name: pytest.approx(math.degrees(one["squirt"][i]), abs=0.01) for name, one in known.items()}
    opened.locator("button[popovertarget=w-squirt]").first.press("Enter")
    assert opened.locator("#w-squirt").is_visible()
    opened.keyboard.press("Escape")
    assert 2 <= len(re.findall(SHEET, opened.pdf(format="A4", print_background=True))) <= 5
    opened.emulate_media(media="print")
    assert opened.evaluate(CUT) == 0


def test_five_compared_cues_print_on_three_sheets(opened: Any) -> None:
    opened.set_content(compare_page())
    assert len(re.findall(SHEET, opened.pdf(format="A4", print_background=True))) <= 3
    opened.emulate_media(media="print")
    opened.set_viewport_size({"width": 703, "height": 1000})
    assert opened.evaluate(CUT) == 0


def test_design_changes_on_a_phone_show_three_columns_and_all_on_demand(opened: Any) -> None:
    opened.set_viewport_size({"width": 390, "height": 900})
    opened.set_content(report_page())
    heads = opened.locator(".advice thead th")
    assert [heads.nth(i).inner_text() for i in range(heads.count()) if heads.nth(i).is_visible()] == [
        "change",
        "squirt change",
        "recommendation",
    ]
    opened.locator(".advice").get_by_label("all columns").check()
    assert all(heads.nth(i).is_visible() for i in range(6))


def test_report_on_paper_names_no_options(opened: Any) -> None:
    note = Assumption("ferrule", "ferrule of melamine", "ferrule")
    opened.set_content(report().to_html("pool_maple.toml", [note]))
    opened.emulate_media(media="print")
    text = opened.locator("body").inner_text()
    assert "ferrule of melamine" in text
    assert "--" not in text


def study_of_ten_columns() -> str:
    """The page of a sweep over three columns with seven responses, as wide as those in studies/sweeps."""
    bore, deep, time = (x.ravel() for x in np.meshgrid([2.0, 5.0, 9.0], [50.0, 140.0], [0.8, 1.2], indexing="ij"))
    kinds = ("end_mass", "squirt(0.3)", "pivot_length", "tip_stiffness", "shaft_mass", "balance_point", "frequency(1)")
    results = np.stack([time - 0.1 * bore, -bore, bore, -bore, -bore, bore, bore], axis=1)
    names, units = ("bore", "bore depth", "tip.contact_time"), ("m", "m", "s")
    values = (1e-3 * bore, 1e-3 * deep, 1e-3 * time)
    table = SweepStatistics(names, units, tuple(map(Response.of, kinds)), np.arange(12), values, results)
    steps: list[dict[str, Record]] = [{} for _ in table.shown_front[1:]]
    return plain_page("bore", ["12 designs", *sweep_charts(table), *tabulate_sweep(table, steps, {})])


@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize("what", ["report", "compare", "study"])
def test_page_is_accessible_and_not_cropped(opened: Any, what: str, width: int) -> None:
    opened.set_viewport_size({"width": width, "height": 900})
    opened.emulate_media(color_scheme="dark" if width == 390 else "light")
    opened.set_content({"report": report_page, "compare": compare_page, "study": study_of_ten_columns}[what]())
    assert opened.evaluate("document.documentElement.scrollWidth") <= width
    assert opened.evaluate(OUTSIDE) == 0
    assert opened.evaluate(OVERLAID) == []
    opened.evaluate("document.querySelectorAll('details').forEach(fold => fold.open = true)")
    assert width == 390 or opened.evaluate(CUT) == 0
    assert [one["id"] for one in violations(opened) if one["impact"] in ("serious", "critical")] == []
