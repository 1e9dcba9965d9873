"""A maker's way on film: a sloppy table with a bore, its verdict, three changes, the best taken, the report printed.

Page, command, JSON and the saved file have the same numbers all the way.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.results.quantities import degrees
from tests.helpers.command_line import call
from tests.helpers.designer_browser import downloaded, needs_browser, opened, served, settled, shown

pytestmark = needs_browser()
# As a spreadsheet of a German maker leaves it: semicolons, decimal commas, a note, a row of notes, a blank line.
SLOPPY = """\ufeffMy shaft, March;;;;;
Pos. [mm];Diameter [mm];Bore (mm);material;core;remark
0;12,75;8;melamine;Hard Maple;ferrule
25;12,8;5,5;hard maple;;

152,4;12,95;;;;end of the bore
330;13,2;;;;
736,6;21,5;;;;joint
"""
BODY = ("--body-mass", "425 g")


@pytest.fixture(scope="module")
def page(browser: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    with served(tmp_path_factory.mktemp("designer")) as address, opened(browser, address) as found:
        yield found


def verdict(file: Path, *options: str) -> float:
    """The squirt that the command's JSON says first, and its table for people too."""
    said = json.loads(call("report", file, "--json", *options)[1])["verdict"]["squirt"]
    status, out, _ = call("report", file, *options)
    assert (status, f"squirt {1.0 * round(57.29577951308232 * said, 1):g}°" in out) == (0, True)
    return float(said)


def test_a_sloppy_table_its_best_change_and_the_printed_report(page: Any, browser: Any, tmp_path: Path) -> None:
    mine = tmp_path / "mine.csv"
    mine.write_text(SLOPPY, encoding="utf-8")
    assert [s.tip_bore for s in cf.load(mine).segments[:2]] == [0.008, 0.0055]
    before = verdict(mine, *BODY)

    page.locator("input[type=file]").first.set_input_files(mine)
    dialog = page.get_by_role("dialog", name="What the file does not say")
    dialog.get_by_label("Weight").fill(
        f"{1e3 * (cf.load(mine).shaft_mass + 0.425):.9f}"
    )  # the page asks for the whole cue's
    dialog.get_by_role("button", name="Open it").click()
    page.get_by_role("heading", level=1, name="mine.csv").wait_for()
    settled(page)
    assert shown(page, "squirt") == degrees(before)

    rows = json.loads(call("improve", mine, "--json", *BODY)[1])["changes"]
    page.get_by_role("button", name="Compute the changes").click()
    for row in (rows[2], rows[1], rows[0]):
        page.get_by_role("button", name=f"try: {row['change']}").click()
        page.locator('[data-key="squirt"]', has_text=degrees(row["squirt"])).wait_for()
        settled(page)
        assert shown(page, "squirt") == degrees(row["squirt"])
    assert rows[0]["squirt"] < rows[1]["squirt"] < before

    best = downloaded(page, "Save as .toml", tmp_path)
    told = page.locator(".verdict .squirt b").inner_text()
    after = cf.strike(cf.load(best)).squirt
    assert after == pytest.approx(rows[0]["squirt"], rel=1e-9)
    assert verdict(best) == pytest.approx(after, rel=1e-9)
    assert told in call("report", best)[1]

    report = downloaded(page, "Write the report", tmp_path)
    printed = browser.new_page()
    printed.goto(report.as_uri())
    printed.emulate_media(media="print")
    assert told in printed.locator(".verdict").first.inner_text()
    assert printed.pdf().startswith(b"%PDF")
    printed.close()
    assert call("report", best, "-o", tmp_path / "again.html")[0] == 0
    assert told in (tmp_path / "again.html").read_text(encoding="utf-8")


def test_the_handbook_is_a_click_away(page: Any) -> None:
    with page.expect_popup() as waiting:
        page.get_by_role("link", name="Guide").click()
    waiting.value.get_by_role("heading", level=1, name="What squirt is").wait_for()
    waiting.value.close()


def test_beam_theory_is_checked_on_request_as_by_the_command(page: Any, tmp_path: Path) -> None:
    path = downloaded(page, "Save as .toml", tmp_path)
    page.get_by_role("button", name="Check beam theory").click()
    page.locator(".check", has_text="Computing: step").wait_for()
    page.locator(".check", has_text=json.loads(call("check", path, "--json")[1])["sentence"]).wait_for()
    assert "the design before" not in page.locator(".check").inner_text()
