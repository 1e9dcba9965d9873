"""The designer in a headless browser: its numbers are the command line's, it takes keys, and says what is wrong."""

from __future__ import annotations

import re
import statistics
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.designer.model import knobs_of
from cuefem.designer.start import first_scene
from cuefem.materials import material
from tests.helpers.command_line import call
from tests.helpers.designer_browser import BROWSER, opened, served, settled, shown, turn
from tests.helpers.surfaces import revolved, written

sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright: pip install playwright")
pytest.importorskip("nicegui", reason="needs NiceGUI: pip install '.[designer]' in the clone")
pytestmark = [
    pytest.mark.heavy,
    pytest.mark.skipif(BROWSER is None, reason="needs Chromium: apt-get install chromium"),
]
ROOT = Path(__file__).parents[2]
MOVES = 20


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with sync_api.sync_playwright() as driver:
        found = driver.chromium.launch(executable_path=BROWSER, args=["--no-sandbox", "--disable-gpu"])
        yield found
        found.close()


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with served(tmp_path_factory.mktemp("designer")) as found:
        yield found


def saved(page: Any, folder: Path) -> Path:
    """The design as its file."""
    with page.expect_download() as waiting:
        page.get_by_role("button", name="Save as .toml").click()
    path = folder / waiting.value.suggested_filename
    waiting.value.save_as(path)
    return path


def assert_as_commanded(page: Any, path: Path) -> None:
    """The numbers on the page are those that the commands give for its file."""
    status, out, _ = call("strike", path)
    assert status == 0
    coupled = {line[:34].strip(): line[34:].split("  ")[0] for line in out.splitlines()}
    assert shown(page, "squirt") in out
    assert (
        any(shown(page, "pivot") in line for name, line in coupled.items() if name == "") or shown(page, "pivot") in out
    )
    status, out, _ = call("end-mass", path)
    for drive in ("stick", "velocity", "force", "squirt"):
        line = next(line for line in out.splitlines() if line.strip().startswith(drive))
        assert shown(page, f"end_mass_{drive}") == re.split(r"  +", line.strip())[1]
    status, out, _ = call("modes", path)
    for i in range(1, 6):
        assert shown(page, f"mode{i}") in out
    assert page.locator('[data-key="squirt"]').inner_text() == shown(page, "squirt")
    assert page.locator('[data-key="end_mass_stick"]').inner_text() == shown(page, "end_mass_stick")


def test_it_opens_with_the_maple_shaft(browser: Any, address: str, tmp_path: Path) -> None:
    with opened(browser, address) as page:
        path = saved(page, tmp_path)
        assert cf.load(path) == first_scene()
        assert_as_commanded(page, path)


def test_moved_sliders_give_the_numbers_of_the_command_line(browser: Any, address: str, tmp_path: Path) -> None:
    with opened(browser, address) as page:
        before = {name: shown(page, name) for name in ("squirt", "end_mass_stick", "mode1", "stiffness", "balance")}
        turn(page, "tip_diameter", "ArrowLeft", 4)
        turn(page, "bore_depth", "PageUp", 3)
        turn(page, "joint_compliance", "ArrowRight", 6)
        turn(page, "contact_time", "ArrowLeft", 5)
        turn(page, "offset", "ArrowRight", 2)
        assert all(shown(page, name) != was for name, was in before.items())
        path = saved(page, tmp_path)
        made = cf.load(path)
        assert made.cue.segments[0].tip_diameter == pytest.approx(12.55e-3)
        assert made.stroke.offset == pytest.approx(0.32)
        assert made.tip.contact_time == pytest.approx(1.05e-3)
        assert made.effects[-1] == cf.Joint(knobs_of(first_scene()).joint_position, 3e-4)
        assert_as_commanded(page, path)


def test_a_material_and_a_number_are_chosen(browser: Any, address: str, tmp_path: Path) -> None:
    with opened(browser, address) as page:
        page.get_by_role("combobox", name="Shaft material").click()
        page.get_by_role("option", name="ash", exact=True).click()
        page.get_by_label("Ferrule length, mm, as a number").fill("12.5")
        settled(page)
        made = cf.load(path := saved(page, tmp_path))
        assert [segment.length for segment in made.cue.segments][1] == pytest.approx(12.5e-3)
        assert made.cue.segments[-1].material == material("ash")
        assert made.cue.segments[1].core == material("ash")
        assert_as_commanded(page, path)


def test_a_pinned_design_is_compared(browser: Any, address: str) -> None:
    with opened(browser, address) as page:
        was = shown(page, "end_mass_stick")
        page.get_by_role("button", name="Pin this design").click()
        row = page.locator("tr", has=page.locator('[data-number="end_mass_stick"]')).locator("td")
        page.wait_for_function("document.querySelectorAll('thead th').length === 4")
        assert row.all_inner_texts() == [was, was, "the same"]
        turn(page, "tip_diameter", "ArrowLeft", 10)
        now, pinned, difference = row.all_inner_texts()
        grams = float(now.split()[0]) - float(was.split()[0])
        assert pinned == was
        assert grams < 0
        found = re.fullmatch(r"−([0-9.]+) g \(−([0-9.]+)\s%\)", difference)
        assert found is not None
        assert float(found[1]) == pytest.approx(-grams, abs=2e-3)
        assert float(found[2]) == pytest.approx(-100 * grams / float(was.split()[0]), abs=0.06)
        assert page.locator(".legend", has_text="pinned, coupled").count() == 2
        assert page.locator(".legend", has_text="pinned, whole").count() == 1
        page.get_by_role("button", name="Take the pin off").click()
        page.wait_for_function("document.querySelectorAll('thead th').length === 2")


PIECE = """[[segments]]
length = "1 mm"
tip_diameter = "12 mm"
butt_diameter = "12 mm"
material = "ash"
"""
WRONG = {
    "broken.toml": ("[[segments", "broken.toml: must be TOML; got a syntax error"),
    "empty.toml": ("", "empty.toml: must hold a cue or a scene; got an empty file"),
    "bare.toml": ("[[segments]]\nlength = 0.7\n", "segments[0].length: must be in (0, 1000] m, a length with its unit"),
    "lumped.toml": (
        '[cue]\nmass = "0.5 kg"\nend_mass = "6 g"\n',
        "Scene.cue must be a Cue of segments",
    ),
    "elsewhere.toml": ('cue = "shaft.toml"\n', "elsewhere.toml: cue: shaft.toml: cannot be read: No such file"),
    "profile.csv": ("a,b\n1,2\n", "profile.csv:"),
    "<b>.toml": ("x = 1", "<b>.toml: x: "),
    "notes.txt": ("x = 1", "a file must be a .toml, .csv, .vtk, .vtu, .stl, .ply or .obj of at most 5 MB"),
    "many.toml": (PIECE * 2001, "many.toml: segments: must hold at most 2000 segments; got 2001"),
    "long.toml": (PIECE.replace("1 mm", "1e9 m"), "segments[0].length: must be in (0, 1000] m; got '1e9 m'"),
}


def test_a_wrong_file_is_refused_and_the_page_stays(browser: Any, address: str, tmp_path: Path) -> None:
    with opened(browser, address) as page:
        turn(page, "tip_diameter", "ArrowLeft", 2)
        was = shown(page, "squirt")
        for name, (text, words) in WRONG.items():
            (tmp_path / name).write_text(text, encoding="utf-8")
            page.locator("input[type=file]").set_input_files(tmp_path / name)
            alert = page.locator("[role=alert] .said").filter(has_text=words)
            alert.wait_for()
            assert alert.inner_text().startswith("not opened: ")
            assert "Traceback" not in alert.inner_text()
            assert "/tmp" not in alert.inner_text()
            assert shown(page, "squirt") == was
            assert page.get_by_role("heading", level=1).inner_text() == "pool_maple.toml"
        turn(page, "tip_diameter", "ArrowLeft")
        assert page.get_by_role("alert").inner_text() == ""


SENT = """async ([url, name, text]) => {
  const form = new FormData();
  if (name === null) form.append("a", text); else form.append("a", new Blob([text]), name);
  const answer = await fetch(url, { method: "POST", body: form });
  return answer.status;
}"""
NAMES = {
    "a" * 300 + ".toml": "a file's name must be of at most 255 bytes; got 305",
    "..": "a file must have a name; got '..'",
    "": "a file must have a name; got ''",
    None: "no file was sent",
    "../../up.toml": "up.toml: must hold a cue or a scene; got an empty file",
}


def test_a_name_that_no_file_has_is_refused(browser: Any, address: str) -> None:
    context = browser.new_context()
    page = context.new_page()
    page.set_default_timeout(30_000)
    page.goto(address)
    settled(page)
    with page.expect_request(lambda asked: asked.method == "POST") as sent:  # tells where files go
        page.locator("input[type=file]").set_input_files({"name": "a.toml", "mimeType": "", "buffer": b" "})
    page.locator("[role=alert] .said").filter(has_text="not opened: a.toml").wait_for()
    for name, words in NAMES.items():
        page.evaluate(SENT, [sent.value.url, name, " "])
        page.locator("[role=alert] .said").filter(has_text=f"not opened: {words}").wait_for()
    context.close()


SLOW = """
import time
import cuefem.designer.app as app
quick = app.answers
def slow(scene):
    end = time.monotonic() + (15 if abs(scene.stroke.offset - 0.31) < 1e-9 else 0)
    while time.monotonic() < end:
        pass
    return quick(scene)
app.answers = slow
"""


def test_another_tab_is_answered_while_a_slow_design_computes(browser: Any, tmp_path: Path) -> None:
    with (
        served(tmp_path, before=SLOW) as address,
        opened(browser, address) as slow,
        opened(browser, address) as quick,
    ):
        slow.locator('[data-knob="offset"] [role="slider"]').focus()
        slow.keyboard.press("ArrowRight")
        slow.wait_for_function("document.querySelector('.answers').ariaBusy === 'true'")
        was = shown(quick, "end_mass_stick")
        quick.locator('[data-knob="tip_diameter"] [role="slider"]').focus()
        quick.keyboard.press("ArrowLeft")
        quick.wait_for_function(
            "was => document.querySelector('[data-number=end_mass_stick]').innerText !== was", arg=was
        )
        assert slow.evaluate("document.querySelector('.answers').ariaBusy") == "true"
        settled(slow)
        settled(quick)


def test_a_surface_is_opened(browser: Any, address: str, tmp_path: Path) -> None:
    for name, binary in (("ascii.stl", False), ("binary.stl", True), ("shaft.ply", False)):
        path = written(tmp_path / name, *revolved([(0, 0), (0, 0.006), (0.7, 0.0105), (0.7, 0)], 16), binary=binary)
        with opened(browser, address) as page:
            page.locator("input[type=file]").set_input_files(path)
            page.get_by_role("heading", level=1, name=name).wait_for()
            settled(page)
            assert shown(page, "shaft_mass").endswith(" g")


def test_a_file_is_opened_changed_and_taken_back(browser: Any, address: str, tmp_path: Path) -> None:
    with opened(browser, address) as page:
        page.locator("input[type=file]").set_input_files(ROOT / "meshes" / "kim.toml")
        page.get_by_role("heading", level=1, name="kim.toml").wait_for()
        settled(page)
        assert page.get_by_text("no ferrule is drawn behind the tip").count() == 1
        assert page.locator('[data-knob="ferrule_length"]').count() == 0
        assumed = "assumed: a usual stroke of pool; ball 170 g, 57.15 mm; a leather tip 6 mm high"
        assert page.get_by_text(assumed).count() == 1
        path = saved(page, tmp_path)
        assert cf.load(path).cue == cf.load(ROOT / "meshes" / "kim.toml")
        assert_as_commanded(page, path)
        was = shown(page, "squirt")
        turn(page, "taper_diameter", "ArrowRight", 3)
        assert shown(page, "squirt") != was
        page.get_by_role("button", name="Back to the file").click()
        page.wait_for_function("was => document.querySelector('[data-number=squirt]').innerText === was", arg=was)


def test_an_impossible_cue_is_said_and_the_next_move_answers(browser: Any, address: str) -> None:
    with opened(browser, address) as page:
        turn(page, "bore_depth", "ArrowRight", 3)
        page.get_by_label("Tip diameter, mm, as a number").fill("8")
        page.get_by_label("Bore width, mm, as a number").fill("11")
        page.locator("[role=alert] .said").filter(
            has_text="the bore must be narrower than the cue, 8.496 mm there; got 11 mm"
        ).wait_for()
        page.get_by_role("button", name="Back to the file").click()
        page.wait_for_function("document.querySelector('[role=alert]').innerText === ''")
        assert shown(page, "shaft_mass") == "99.98 g"
        page.get_by_label("Offset b/R, as a number").fill("7")
        page.keyboard.press("Tab")
        page.locator("[role=alert] .said").filter(has_text="Offset b/R must be in [0, 0.6]").wait_for()
        assert page.get_by_label("Offset b/R, as a number").input_value() == "0.30"


def test_it_is_worked_by_keys_alone(browser: Any, address: str) -> None:
    with opened(browser, address) as page:
        reached = []
        for _ in range(40):
            page.keyboard.press("Tab")
            reached.append(
                page.evaluate("(e => [e.getAttribute('role'), e.ariaLabel || e.innerText])(document.activeElement)")
            )
            if reached[-1] == ["slider", "Offset b/R"]:
                break
        sliders = [label for role, label in reached if role == "slider"]
        assert sliders[0] == "Tip diameter, mm"
        assert len(sliders) == page.locator("[data-knob] [role=slider]").count() == 10
        assert (
            page.evaluate("getComputedStyle(document.activeElement.querySelector('.q-slider__thumb')).outlineStyle")
            != "none"
        )
        slider = page.get_by_role("slider", name="Offset b/R")
        assert slider.get_attribute("aria-valuenow") == "0.3"
        was = shown(page, "squirt")
        page.keyboard.press("ArrowRight")
        page.wait_for_function("was => document.querySelector('[data-number=squirt]').innerText !== was", arg=was)
        assert slider.get_attribute("aria-valuenow") == "0.31"
        tone = page.get_by_role("button", name="play mode 1")
        tone.focus()
        page.keyboard.press("Enter")
        page.wait_for_function("window.cuefemSound instanceof AudioContext")


# The least contrast of a text with what lies behind it (WCAG 2.2, 1.4.3), of all texts that are seen.
CONTRAST = """() => {
  const part = c => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  const light = ([r, g, b]) => 0.2126 * part(r) + 0.7152 * part(g) + 0.0722 * part(b);
  const colour = text => text.match(/[0-9.]+/g).map(Number);
  const behind = element => {
    for (let e = element; e; e = e.parentElement) {
      const found = colour(getComputedStyle(e).backgroundColor);
      if (found.length === 3 || found[3] === 1) return found;
    }
    return [255, 255, 255];
  };
  const seen = [];
  const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walk.nextNode()) {
    const element = walk.currentNode.parentElement, words = walk.currentNode.nodeValue.trim();
    const unseen = !element.checkVisibility({visibilityProperty: true}) || element.closest("script, style, title");
    if (!words || unseen) continue;
    const style = getComputedStyle(element);
    const front = light(colour(element.closest("svg") ? style.fill : style.color)), back = light(behind(element));
    seen.push([(Math.max(front, back) + 0.05) / (Math.min(front, back) + 0.05), words]);
  }
  return seen.sort((a, b) => a[0] - b[0]).slice(0, 3).concat([[seen.length, "texts"]]);
}"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_texts_stand_out(browser: Any, address: str, scheme: str) -> None:
    with opened(browser, address, scheme=scheme) as page:
        *worst, (texts, _) = page.evaluate(CONTRAST)
        assert texts > 80
        assert worst[0][0] >= 4.5, worst


CUT_OFF = """() => {
  const box = e => e.getBoundingClientRect(), all = what => [...document.querySelectorAll(what)];
  const texts = all("svg.chart text, svg.cue text").map(box);
  return {
    scroll: document.documentElement.scrollWidth,
    wide: all("section, figure, button, .knob").filter(e => box(e).right > innerWidth + 1).map(e => e.className),
    outside: texts.filter(r => r.right > innerWidth || r.left < 0).length,
    smallest: Math.min(...texts.map(r => r.height)),
    keys: all("dd b").filter(e => box(e).right > box(e.closest("div")).right + 1).length,
  };
}"""


@pytest.mark.parametrize("width", [1280, 390])
def test_nothing_is_cut_off(browser: Any, address: str, width: int) -> None:
    with opened(browser, address, width=width) as page:
        page.get_by_role("button", name="Pin this design").click()
        turn(page, "tip_diameter", "ArrowLeft", 3)
        found = page.evaluate(CUT_OFF)
        assert found["scroll"] <= width
        assert (found["wide"], found["outside"], found["keys"]) == ([], 0, 0)
        assert found["smallest"] > 6.5  # px, of a text's line


def test_the_report_is_exported(browser: Any, address: str, tmp_path: Path) -> None:
    with opened(browser, address) as page:
        with page.expect_download() as waiting:
            page.get_by_role("button", name="Write the report").click()
        waiting.value.save_as(tmp_path / "report.html")
        text = (tmp_path / "report.html").read_text(encoding="utf-8")
        assert waiting.value.suggested_filename == "pool_maple.html"
        assert text.startswith("<!DOCTYPE html>")
        squirt = float(re.search(r"<title>pool_maple.toml: squirt ([0-9.]+)°", text)[1])
        assert squirt == pytest.approx(float(shown(page, "squirt").rstrip("°")), rel=5e-3)  # of its own accuracy


def test_a_scene_of_the_command_line_is_opened(browser: Any, tmp_path: Path) -> None:
    scene = ROOT / "studies" / "scenes" / "pool_low_deflection.toml"
    (tmp_path / "server").mkdir()
    with served(tmp_path / "server", scene) as address, opened(browser, address) as page:
        made = cf.load(path := saved(page, tmp_path))
        assert made == cf.load(scene)
        assert_as_commanded(page, path)


WATCH = """() => {
  window.trips = [];
  const number = () => document.querySelector("[data-key=end_mass_stick]")?.innerText;
  let began = null, was = number();
  addEventListener("keydown", () => { began = performance.now(); was = number(); }, true);
  new MutationObserver(() => {
    if (began !== null && number() && number() !== was) { window.trips.push(performance.now() - began); began = null; }
  }).observe(document.body, { subtree: true, childList: true, characterData: true });
}"""


@pytest.mark.parametrize("pause", [30, 450])
def test_round_trips_are_told(
    browser: Any, address: str, capsys: pytest.CaptureFixture[str], record_property: Any, pause: int
) -> None:
    with opened(browser, address) as page:
        page.evaluate(WATCH)
        page.locator('[data-knob="tip_diameter"] [role="slider"]').focus()
        for move in range(MOVES):
            page.keyboard.press("ArrowRight" if move < MOVES // 2 else "ArrowLeft")
            page.wait_for_function("n => window.trips.length > n", arg=move)
            page.wait_for_timeout(pause)
        trips = page.evaluate("window.trips")
        assert len(trips) == MOVES
        median, slowest = statistics.median(trips), max(trips)
        record_property(f"median round trip, ms, {pause} ms between moves", median)
        with capsys.disabled():
            print(
                f"\na move answered in {median:.0f} ms (median), {slowest:.0f} ms (slowest), {pause} ms between moves"
            )
