"""Five hundred moves in a row leave the memory of server and page as it was (regression)."""

from __future__ import annotations

from pathlib import Path
from statistics import median
from typing import Any

import pytest

from tests.helpers.designer_browser import launched, needs_browser, opened, served, settled

psutil = pytest.importorskip("psutil", reason="needs psutil: pip install psutil")
pytestmark = needs_browser()
MOVES, WARM = 500, 160  # the first moves fill what is kept: results, steps to undo, threads
STOPS, BETWEEN = 3, 40  # memory is the median of this many stops, as many moves apart: one alone may be 15 MB more
# Bytes. One result or one picture left behind a move would be 50e6 and more in the server; what its allocator holds
# in pieces comes and goes by some 15e6.
MOST_SERVER, MOST_PAGE = 40e6, 6e6
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


def server_memory(folder: Path) -> int:
    """Resident bytes of the designer that runs in the folder, a child of this process among others."""
    (process,) = (
        child
        for child in psutil.Process().children()
        if "designer" in child.cmdline() and Path(child.cwd()) == folder.resolve()
    )
    return int(process.memory_info().rss)


def test_five_hundred_moves_leave_memory_as_it_was(
    tmp_path_factory: pytest.TempPathFactory, capsys: pytest.CaptureFixture[str], record_property: Any
) -> None:
    folder = tmp_path_factory.mktemp("designer")
    with (
        served(folder) as address,
        launched() as browser,
        opened(browser, address) as page,
    ):
        session = page.context.new_cdp_session(page)
        session.send("Performance.enable")

        def memory() -> dict[str, float]:
            settled(page)
            session.send("HeapProfiler.collectGarbage")
            told = {one["name"]: one["value"] for one in session.send("Performance.getMetrics")["metrics"]}
            found = {name: told[name] for name in ("JSHeapUsedSize", "Nodes", "JSEventListeners")}
            return found | {"server": server_memory(folder)}

        def after(first: int, count: int) -> dict[str, float]:
            """What memory is near the end of moves."""
            page.evaluate(MOVE, [first, count - STOPS * BETWEEN])
            found = []
            for stop in range(STOPS):
                page.evaluate(MOVE, [first + count - (STOPS - stop) * BETWEEN, BETWEEN])
                found.append(memory())
            return {name: median(one[name] for one in found) for name in found[0]}

        before = after(0, WARM)
        grown = {name: value - before[name] for name, value in after(WARM, MOVES).items()}
    record_property("growth in 500 moves", grown)
    with capsys.disabled():
        print(f"\ngrowth in {MOVES} moves: {grown}")
    assert grown["JSHeapUsedSize"] < MOST_PAGE
    assert grown["server"] < MOST_SERVER
    assert grown["JSEventListeners"] < 50
    assert grown["Nodes"] < 500
