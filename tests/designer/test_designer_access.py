"""Designer and report for everybody: axe-core finds no serious fault, in any scheme and width (regression)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.report.report_page import page as report_page
from tests.helpers.designer_browser import needs_browser, opened, turn
from tests.helpers.study_page import study_of_ten_columns

axe = pytest.importorskip(
    "axe_playwright_python.sync_playwright", reason="needs axe: pip install axe-playwright-python"
)
pytestmark = needs_browser()
ROOT = Path(__file__).parents[2]
KINDS = [("light", 1280), ("dark", 1280), ("light", 390), ("dark", 390)]


def faults(page: Any, part: str = "body") -> list[tuple[str, list[str]]]:
    """The serious and critical faults of a part of a page: each rule, and where it is broken."""
    found = axe.Axe().run(page, part).response["violations"]
    return [
        (one["id"], [str(node["target"]) for node in one["nodes"]])
        for one in found
        if one["impact"] in ("serious", "critical")
    ]


@pytest.mark.parametrize(("scheme", "width"), KINDS)
def test_the_designer_has_no_serious_fault(browser: Any, address: str, scheme: str, width: int) -> None:
    with opened(browser, address, width=width, scheme=scheme) as page:
        page.get_by_role("button", name="Pin this design").click()
        turn(page, "tip_diameter", "ArrowLeft", 2)
        page.get_by_text("Everything in this design").click()
        page.get_by_role("checkbox", name="AxialWaves").wait_for()
        page.locator("svg.read").first.focus()
        page.keyboard.press("ArrowRight")
        assert faults(page) == []
        page.get_by_role("button", name="Link").click()
        page.get_by_label("Link", exact=True).wait_for()
        page.wait_for_function("document.getAnimations().length === 0")
        assert faults(page, ".q-dialog") == []


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("report") / "page.html"
    scene = cf.usual_scene(cf.load(ROOT / "meshes" / "pool_hollow.toml"))
    file.write_text(report_page("pool_hollow.toml", scene, remarks=["a remark"]), encoding="utf-8")
    return file


@pytest.mark.parametrize(("scheme", "width"), KINDS)
def test_report_and_study_have_no_serious_fault(browser: Any, report: Path, scheme: str, width: int) -> None:
    context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)
    page = context.new_page()
    page.goto(report.as_uri())
    page.evaluate("document.querySelectorAll('details').forEach(fold => fold.open = true)")
    page.locator("svg.read").first.focus()
    page.keyboard.press("ArrowRight")
    page.locator(".term").first.click()
    assert faults(page) == []
    page.set_content(study_of_ten_columns())
    assert page.locator(".trade").is_visible()
    assert faults(page) == []
    context.close()
