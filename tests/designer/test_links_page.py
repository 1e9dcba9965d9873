"""Links that somebody damaged, through the page: each is refused in words, in the dialog and in the address bar."""

from __future__ import annotations

from typing import Any

import pytest

from tests.helpers.designer_browser import needs_browser, opened, settled, shown, turn
from tests.helpers.designer_links import TEXT, WRONG

pytestmark = needs_browser()
LINKS = ("cut off", "knobs [5]", "offset nan", "steps [[-1]]", "many segments", "no end of segments")


def test_in_the_dialog_it_says_what_is_wrong_and_the_design_stays(browser: Any, address: str) -> None:
    with opened(browser, address) as page:
        turn(page, "tip_diameter", "ArrowLeft", 2)
        was = shown(page, "squirt")
        page.get_by_role("button", name="Link", exact=True).click()
        dialog = page.locator(".q-dialog .dialog").filter(has_text="A link that holds all of this")
        field = page.get_by_label("Open a link that you were sent")
        for text, words in map(WRONG.__getitem__, LINKS):
            field.fill(f"{address}#d={text}")
            dialog.get_by_role("button", name="Open it").click()
            dialog.get_by_role("alert").filter(has_text=words).wait_for()
            field.fill("no link at all")  # what is wrong is said anew for the next
            dialog.get_by_role("button", name="Open it").click()
            dialog.get_by_role("alert").filter(has_text="copy all of it; got ''").wait_for()
        assert shown(page, "squirt") == was
        field.fill(f"{address}#d={TEXT}")
        dialog.get_by_role("button", name="Open it").click()
        page.get_by_role("heading", level=1, name="maple", exact=True).wait_for()
        page.locator(".q-dialog").wait_for(state="detached")
        settled(page)
        turn(page, "tip_diameter", "ArrowLeft")  # the page is alive


@pytest.mark.parametrize("name", ["cut off", "many segments"])
def test_in_the_address_bar_it_says_so_beside_the_first_design(browser: Any, address: str, name: str) -> None:
    text, words = WRONG[name]
    with opened(browser, f"{address}#d={text}") as page:
        alert = page.locator(".said[role=alert]")
        assert f"the link in the address was not opened: {words}" in alert.inner_text()
        assert page.get_by_role("heading", level=1).inner_text() == "pool_maple.toml"
        turn(page, "tip_diameter", "ArrowLeft")
        assert page.get_by_role("alert").count() == 0
