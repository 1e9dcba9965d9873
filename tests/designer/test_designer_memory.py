"""Five hundred moves in a row leave the memory of server and page as it was (regression)."""

from __future__ import annotations

from typing import Any

import pytest

from tests.helpers.designer_browser import BROWSER, opened, served, settled

sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright: pip install playwright")
psutil = pytest.importorskip("psutil", reason="needs psutil: pip install psutil")
pytest.importorskip("nicegui", reason="needs NiceGUI: pip install '.[designer]' in the clone")
pytestmark = [
    pytest.mark.heavy,
    pytest.mark.skipif(BROWSER is None, reason="needs Chromium: apt-get install chromium"),
]
MOVES, WARM = 500, 160  # the first moves fill what is kept: results, steps to undo, threads
MOST_SERVER, MOST_PAGE = 24e6, 6e6  # bytes
# Moves go back and forth, each after the answer to the last or a moment; what comes too fast is answered by the newest.
MOVE = """async ([first, count]) => {
  const slider = document.querySelector("[data-knob=tip_diameter] [role=slider]");
  const number = () => document.querySelector("[data-key=squirt]").innerText;
  slider.focus();
  for (let i = first; i < first + count; i++) {
    const was = number(), key = Math.floor(i / 40) % 2 ? "ArrowRight" : "ArrowLeft";
    slider.dispatchEvent(new KeyboardEvent("keydown", { key, keyCode: key === "ArrowRight" ? 39 : 37, bubbles: true }));
    slider.dispatchEvent(new KeyboardEvent("keyup", { key, keyCode: key === "ArrowRight" ? 39 : 37, bubbles: true }));
    for (let waited = 0; number() === was && waited < 12; waited++) await new Promise(done => setTimeout(done, 5));
  }
}"""


def server_memory() -> int:
    """Resident bytes of the designer, which is a child of this process."""
    (process,) = (child for child in psutil.Process().children() if "designer" in child.cmdline())
    return int(process.memory_info().rss)


def test_five_hundred_moves_leave_memory_as_it_was(
    tmp_path_factory: pytest.TempPathFactory, capsys: pytest.CaptureFixture[str], record_property: Any
) -> None:
    with (
        served(tmp_path_factory.mktemp("designer")) as address,
        sync_api.sync_playwright() as driver,
    ):
        browser = driver.chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])
        with opened(browser, address) as page:
            session = page.context.new_cdp_session(page)
            session.send("Performance.enable")

            def memory() -> dict[str, float]:
                settled(page)
                session.send("HeapProfiler.collectGarbage")
                told = {one["name"]: one["value"] for one in session.send("Performance.getMetrics")["metrics"]}
                found = {name: told[name] for name in ("JSHeapUsedSize", "Nodes", "JSEventListeners")}
                return found | {"server": server_memory()}

            page.evaluate(MOVE, [0, WARM])
            before = memory()
            page.evaluate(MOVE, [WARM, MOVES])
            grown = {name: value - before[name] for name, value in memory().items()}
        browser.close()
    record_property("growth in 500 moves", grown)
    with capsys.disabled():
        print(f"\ngrowth in {MOVES} moves: {grown}")
    assert grown["JSHeapUsedSize"] < MOST_PAGE
    assert grown["server"] < MOST_SERVER
    assert grown["JSEventListeners"] < 50
    assert grown["Nodes"] < 500
