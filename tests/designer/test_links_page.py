"""Links that somebody damaged, through the page: each is refused in words, in the dialog and in the address bar."""

from __future__ import annotations

import base64
import json
import zlib
from typing import Any

import pytest

from cuefem.designer.design import Design, State, Step
from cuefem.designer.kept import text_of
from cuefem.designer.start import first_scene
from tests.helpers.designer_browser import BROWSER, opened, settled, shown, turn

pytest.importorskip("playwright.sync_api", reason="needs playwright: pip install playwright")
pytest.importorskip("nicegui", reason="needs NiceGUI: pip install '.[designer]' in the clone")
pytestmark = [
    pytest.mark.heavy,
    pytest.mark.skipif(BROWSER is None, reason="needs Chromium: apt-get install chromium"),
]
TEXT = text_of(State((Step(Design.of("maple", first_scene())),)))


def changed(**parts: Any) -> str:
    """The text of the first design with parts of it exchanged."""
    record = json.loads(zlib.decompress(base64.urlsafe_b64decode(TEXT + "=" * (-len(TEXT) % 4)))) | parts
    return base64.urlsafe_b64encode(zlib.compress(json.dumps(record).encode())).decode()


def scenes(count: int) -> list[Any]:
    piece = {"length": "0.4 mm", "tip_diameter": "12 mm", "butt_diameter": "12 mm", "material": "ash"}
    return [{"cue": {"segments": [piece] * count, "body_mass": f"{400 + i} g"}} for i in range(13)]


DAMAGED = "this link is damaged: its parts do not fit together"
CUT = "this link is not whole: copy all of it"
LINKS = {  # what else is wrong with a link is refused in the same words: test_kept_properties.py
    "cut after 100": (TEXT[:100], CUT),
    "letter 50 gone": (TEXT[:50] + TEXT[51:], CUT),
    "knobs 5": (changed(designs=[["a", 0, 5, []]]), DAMAGED),
    "offset nan": (changed(designs=[["a", 0, {"offset": float("nan")}, []]]), "offset must be a number; got "),
    "steps [[-1]]": (changed(steps=[[-1]]), "this link "),
    "2000 segments": (
        changed(scenes=scenes(2000), designs=[["a", i, {}, []] for i in range(13)], steps=[list(range(13))]),
        "the designer takes a cue of at most 300 segments; got 2000",
    ),
    "5000 segments": (changed(scenes=scenes(5000)), "this link must hold at most 4 MB of designs"),
}


def test_in_the_dialog_it_says_what_is_wrong_and_the_design_stays(browser: Any, address: str) -> None:
    with opened(browser, address) as page:
        turn(page, "tip_diameter", "ArrowLeft", 2)
        was = shown(page, "squirt")
        page.get_by_role("button", name="Link", exact=True).click()
        dialog = page.locator(".q-dialog .dialog").filter(has_text="A link that holds all of this")
        field = page.get_by_label("Open a link that you were sent")
        for text, words in LINKS.values():
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


@pytest.mark.parametrize("name", ["cut after 100", "knobs 5", "steps [[-1]]", "2000 segments"])
def test_in_the_address_bar_it_says_so_beside_the_first_design(browser: Any, address: str, name: str) -> None:
    text, words = LINKS[name]
    with opened(browser, f"{address}#d={text}") as page:
        alert = page.locator(".said[role=alert]")
        assert f"the link in the address was not opened: {words}" in alert.inner_text()
        assert page.get_by_role("heading", level=1).inner_text() == "pool_maple.toml"
        turn(page, "tip_diameter", "ArrowLeft")
        assert page.get_by_role("alert").count() == 0
