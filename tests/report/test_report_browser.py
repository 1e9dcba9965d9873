"""The report in a headless browser: values are read off its charts, words are explained, and it prints (regression)."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.report.report_page import PAGE_OFFSETS, page
from cuefem.report.squirt import squirt_record
from tests.helpers.designer_browser import BROWSER, launched
from tests.helpers.study_page import study_of_ten_columns

pytest.importorskip("playwright.sync_api", reason="needs playwright: pip install playwright")
pytestmark = [
    pytest.mark.heavy,
    pytest.mark.skipif(BROWSER is None, reason="needs Chromium: apt-get install chromium"),
]
SCENE = cf.usual_scene(cf.load(Path(__file__).parents[2] / "meshes" / "pool_maple.toml"))


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = tmp_path_factory.mktemp("report") / "page.html"
    found.write_text(page("pool_maple.toml", SCENE), encoding="utf-8")
    return found


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with launched() as found:
        yield found


@pytest.fixture
def opened(browser: Any, file: Path) -> Iterator[Any]:
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    made = context.new_page()
    said: list[str] = []
    made.on("console", lambda message: said.append(message.text))
    made.on("pageerror", lambda error: said.append(str(error)))
    made.goto(file.as_uri())
    yield made
    context.close()
    assert said == []


def test_values_are_read_off_a_chart(opened: Any) -> None:
    chart = opened.locator("svg.read").nth(2)
    known = squirt_record(SCENE, PAGE_OFFSETS)["models"]
    chart.focus()
    for _ in range(2):
        opened.keyboard.press("Home")
        for _ in range(3):
            opened.keyboard.press("PageUp")
        at, *values = opened.locator("p.spoken").inner_text().split("; ")
        assert at == "offset b/R: 0.300"
        read = {name: float(value) for name, value in (line.rsplit(" ", 1) for line in values)}
        i = PAGE_OFFSETS.index(0.3)
        assert read == {name: pytest.approx(math.degrees(one["squirt"][i]), abs=0.01) for name, one in known.items()}
        opened.keyboard.press("Escape")
        assert opened.locator("div.reading").count() == 0
    box = chart.bounding_box()
    left, _, right, _ = map(float, chart.get_attribute("data-box").split())
    across = box["width"] / 440
    opened.mouse.move(box["x"] + across * (left + right) / 2, box["y"] + 100)
    assert opened.locator("div.reading b").inner_text() == "offset b/R: 0.300"
    opened.mouse.move(5, 5)
    chart.blur()
    assert opened.locator(".reading").count() == 0


def test_words_are_explained_by_keys_alone(opened: Any) -> None:
    reached = set()
    for _ in range(60):
        opened.keyboard.press("Tab")
        name = opened.evaluate("document.activeElement.getAttribute('popovertarget')")
        if name and name not in reached:
            reached.add(name)
            opened.keyboard.press("Enter")
            word = opened.locator(f"#{name}")
            assert word.is_visible()
            box = word.bounding_box()
            assert box["x"] >= 0
            assert box["x"] + box["width"] <= 1280
            opened.keyboard.press("Escape")
            assert not word.is_visible()
    assert {"w-squirt", "w-natural-pivot-length", "w-effective-end-mass", "w-offset", "w-mode", "w-node"} <= reached


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_prints_on_two_to_five_pages_with_its_tables_open(opened: Any, scheme: str) -> None:
    opened.emulate_media(color_scheme=scheme)
    made = opened.pdf(format="A4", print_background=True)
    assert 2 <= len(re.findall(rb"/Type /Page\b(?!s)", made)) <= 5
    opened.emulate_media(media="print", color_scheme=scheme)
    assert opened.get_by_role("columnheader", name="length, mm").is_visible()
    assert opened.locator("#w-squirt").is_visible()
    assert opened.evaluate("getComputedStyle(document.querySelector('h1')).color") == "rgb(29, 34, 38)"
    assert opened.evaluate(CUT) == 0


# tables wider than their place
CUT = "[...document.querySelectorAll('.scroll')].filter(e => e.scrollWidth > e.clientWidth + 1).length"
LAID_OUT = """() => {
  const parts = [...document.querySelectorAll("section, figure, header")].map(e => e.getBoundingClientRect());
  const texts = [...document.querySelectorAll("svg text")].map(e => e.getBoundingClientRect());
  return {
    scroll: document.documentElement.scrollWidth,
    wide: parts.filter(r => r.right > innerWidth + 1).length,
    outside: texts.filter(r => r.right > innerWidth || r.left < 0).length,
    smallest: Math.min(...texts.map(r => r.height)),
  };
}"""


@pytest.mark.parametrize("name", ["pool_low_deflection", "break_cue", "clay_on_shaft"])
def test_it_is_shown_without_scrolling_or_complaint(opened: Any, tmp_path: Path, name: str) -> None:
    scene = cf.load(Path(__file__).parents[2] / "studies" / "scenes" / f"{name}.toml")
    (tmp_path / "page.html").write_text(page(f"{name}.toml", scene), encoding="utf-8")
    for width in (1280, 390):
        opened.set_viewport_size({"width": width, "height": 900})
        opened.goto((tmp_path / "page.html").as_uri())
        if width == 1280:
            opened.evaluate("document.querySelectorAll('details').forEach(fold => fold.open = true)")
            assert opened.evaluate(CUT) == 0
        found = opened.evaluate(LAID_OUT)
        assert found["scroll"] <= width
        assert (found["wide"], found["outside"]) == (0, 0)
        assert found["smallest"] > 6.5  # px, of a text's line: still to be read on a phone


def test_a_study_is_not_cut_at_1280_nor_in_print(opened: Any, tmp_path: Path) -> None:
    (tmp_path / "study.html").write_text(study_of_ten_columns(), encoding="utf-8")
    opened.goto((tmp_path / "study.html").as_uri())
    assert opened.evaluate(CUT) == 0
    assert opened.evaluate("document.querySelectorAll('.trade tbody tr').length") > 1
    small = "Math.min(...[...document.querySelectorAll('.parallel text')].map(e => e.getBoundingClientRect().height))"
    assert opened.evaluate(small) > 10  # px, of letters of about 10
    opened.emulate_media(media="print")
    opened.set_viewport_size({"width": 703, "height": 1000})  # A4 within its margins
    assert opened.evaluate(CUT) == 0
