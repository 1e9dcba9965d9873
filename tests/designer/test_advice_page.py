"""A maker tries changes in the designer and takes the best: command and saved file have the same numbers."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.results.quantities import degrees
from tests.helpers.command_line import call
from tests.helpers.designer_browser import BROWSER, launched, opened, served, settled, shown

pytest.importorskip("playwright.sync_api", reason="needs playwright: pip install playwright")
pytest.importorskip("nicegui", reason="needs NiceGUI: pip install '.[designer]' in the clone")
pytestmark = [
    pytest.mark.heavy,
    pytest.mark.skipif(BROWSER is None, reason="needs Chromium: apt-get install chromium"),
]
MAPLE = Path(__file__).parents[2] / "meshes" / "pool_maple.toml"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    with (
        launched() as browser,
        served(tmp_path_factory.mktemp("designer")) as address,
        opened(browser, address) as found,
    ):
        yield found


def test_three_changes_are_tried_and_the_best_is_saved(page: Any, tmp_path: Path) -> None:
    rows = json.loads(call("improve", MAPLE, "--json")[1])["changes"]
    page.get_by_role("button", name="Compute the changes").click()
    for row in (rows[2], rows[1], rows[0]):
        page.get_by_role("button", name=f"try: {row['change']}").click()
        page.locator('[data-key="squirt"]', has_text=degrees(row["squirt"])).wait_for()
        settled(page)
        assert shown(page, "squirt") == degrees(row["squirt"])
    with page.expect_download() as waiting:
        page.get_by_role("button", name="Save as .toml").click()
    path = tmp_path / waiting.value.suggested_filename
    waiting.value.save_as(path)
    assert degrees(cf.strike(cf.load(path)).squirt) == degrees(rows[0]["squirt"])
    assert degrees(json.loads(call("report", path, "--json")[1])["verdict"]["squirt"]) == degrees(rows[0]["squirt"])
    assert page.locator(".verdict .squirt b").inner_text() in call("report", path)[1]
