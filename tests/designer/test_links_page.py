"""Links that somebody damaged, through the page: each is refused in words, in the dialog and in the address bar."""

from __future__ import annotations

import base64
import json
import zlib
from collections.abc import Iterator
from typing import Any

import pytest

from cuefem.designer.design import Design, State, Step
from cuefem.designer.kept import text_of
from cuefem.designer.start import first_scene
from tests.helpers.designer_browser import BROWSER, launched, opened, served, settled, shown, turn

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
LINKS = {
    **{f"cut after {size}": (TEXT[:size], CUT) for size in (3, 20, 100, 300, len(TEXT) - 4)},
    **{f"letter {i} gone": (TEXT[:i] + TEXT[i + 1 :], CUT) for i in (2, 10, 50, 200, 400)},
    **{
        f"knobs {knobs!r}": (changed(designs=[["a", 0, knobs, []]]), DAMAGED)
        for knobs in (5, 0, "x", None, True, 1.5, [], [5], "offset", ["offset"])
    },
    **{
        f"offset {value!r}": (changed(designs=[["a", 0, {"offset": value}, []]]), "offset must be a number; got ")
        for value in (None, True, "1", [], {}, float("nan"), float("inf"), 10**400, "0.3", -1e301)
    },
    **{
        f"steps {steps!r}"[:30]: (changed(steps=steps), "this link ")
        for steps in (5, None, [], [[]], [[1]], [[-1]], [["0"]], [[0], [0]], [[0] * 14], {"0": [0]})
    },
    **{
        f"{count} segments": (
            changed(scenes=scenes(count), designs=[["a", i, {}, []] for i in range(13)], steps=[list(range(13))]),
            f"the designer takes a cue of at most 300 segments; got {count}",
        )
        for count in (301, 2000)
    },
    "5000 segments": (changed(scenes=scenes(5000)), "this link must hold at most 4 MB of designs"),
}


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with launched() as found:
        yield found


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with served(tmp_path_factory.mktemp("designer")) as found:
        yield found


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
