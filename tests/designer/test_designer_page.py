"""The designer in a headless browser: its numbers are the command line's, it takes keys, and says what is wrong."""

from __future__ import annotations

import re
import statistics
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.designer.start import first_scene
from cuefem.vary import knobs_of
from tests.helpers.command_line import call
from tests.helpers.designer_browser import downloaded, needs_browser, opened, served, settled, shown, turn

pytestmark = needs_browser()
ROOT = Path(__file__).parents[2]
MOVES = 20


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


def test_moved_sliders_give_the_numbers_of_the_command_line(browser: Any, address: str, tmp_path: Path) -> None:
    with opened(browser, address) as page:
        assert cf.load(downloaded(page, "Save as .toml", tmp_path)) == first_scene()
        before = {name: shown(page, name) for name in ("squirt", "end_mass_stick", "mode1", "stiffness", "balance")}
        turn(page, "tip_diameter", "ArrowLeft", 4)
        turn(page, "bore_depth", "PageUp", 3)
        turn(page, "joint_compliance", "ArrowRight", 6)
        turn(page, "leather", "ArrowRight", 2)
        turn(page, "offset", "ArrowRight", 2)
        assert all(shown(page, name) != was for name, was in before.items())
        path = downloaded(page, "Save as .toml", tmp_path)
        made = cf.load(path)
        assert made.cue.segments[0].tip_diameter == pytest.approx(12.55e-3)
        assert made.stroke.offset == pytest.approx(0.32)
        assert made.effects[0] == replace(first_scene().effects[0], E=150e6)
        assert made.effects[-1] == cf.Joint(knobs_of(first_scene())["joint_position"], 3e-4)
        assert_as_commanded(page, path)


PIECE = """[[segments]]
length = "1 mm"
tip_diameter = "12 mm"
butt_diameter = "12 mm"
material = "ash"
"""
WRONG = {
    "broken.toml": ("[[segments", "broken.toml: must be TOML; got a syntax error"),
    "empty.toml": ("", "empty.toml: must hold a cue or a scene; got an empty file"),
    "bare.toml": ("[[segments]]\nlength = 0.7\n", "segments[0].length: needs a unit"),
    "lumped.toml": (
        'game = "kim"\n[cue]\nmass = "0.5 kg"\nend_mass = "6 g"\n',
        "Scene.cue must be a Cue of segments",
    ),
    "elsewhere.toml": ('cue = "shaft.toml"\n', "elsewhere.toml: cue: shaft.toml: cannot be read: No such file"),
    "profile.csv": ("a,b\n1,2\n", "profile.csv:"),
    "<b>.toml": ("x = 1", "<b>.toml: x: "),
    "notes.txt": ("x = 1", "a file must be a .toml, .csv, .vtk, .vtu, .stl, .ply or .obj of at most 5 MB"),
    "many.toml": (PIECE * 2001, "many.toml: segments: must hold at most 2000 segments; got 2001"),
    "long.toml": (
        PIECE.replace("1 mm", "1e9 m"),
        "segments[0].length: must be more than 0 and at most 1000 m; got 1e9 m",
    ),
}


def test_a_wrong_file_is_refused_and_the_page_stays(browser: Any, address: str, tmp_path: Path) -> None:
    with opened(browser, address) as page:
        turn(page, "tip_diameter", "ArrowLeft", 2)
        was = shown(page, "squirt")
        for name, (text, words) in WRONG.items():
            (tmp_path / name).write_text(text, encoding="utf-8")
            page.locator("input[type=file]").set_input_files(tmp_path / name)
            alert = page.locator(".said[role=alert]").filter(has_text=words)
            alert.wait_for()
            assert alert.inner_text().startswith("not opened: ")
            assert "Traceback" not in alert.inner_text()
            assert "/tmp" not in alert.inner_text()
            assert shown(page, "squirt") == was
            assert page.get_by_role("heading", level=1).inner_text() == "pool_maple.toml"
        turn(page, "tip_diameter", "ArrowLeft")
        assert page.get_by_role("alert").count() == 0


def typed(page: Any, label: str, text: str) -> None:
    """Type a number into its field, and wait for all that follows."""
    page.get_by_label(f"{label}, as a number").fill(text)
    page.wait_for_timeout(400)  # it is heard when nobody has typed for 200 ms
    settled(page)


def test_nothing_is_lost(browser: Any, address: str) -> None:
    """Typed with a comma, undone, reloaded, opened in another tab, and by a link in another browser."""
    with opened(browser, address) as page:
        was = shown(page, "end_mass_stick")
        typed(page, "Tip diameter, mm", "11,8")
        assert page.get_by_label("Tip diameter, mm, as a number").input_value() == "11,8"
        thin = shown(page, "end_mass_stick")
        assert float(thin.split()[0]) < float(was.split()[0])
        page.keyboard.press("Escape")
        page.get_by_role("button", name="Undo").click()
        page.wait_for_function(
            "was => document.querySelector('[data-number=end_mass_stick]').innerText === was", arg=was
        )
        page.get_by_role("button", name="Redo").click()
        page.wait_for_function(
            "was => document.querySelector('[data-number=end_mass_stick]').innerText === was", arg=thin
        )
        page.get_by_role("button", name="Pin this design").click()
        typed(page, "Bore depth, from 25 mm on, mm", "100")
        bored = shown(page, "end_mass_stick")
        page.reload()
        settled(page)
        assert shown(page, "end_mass_stick") == bored
        page.get_by_role("button", name="Link").click()
        link = page.get_by_label("Link", exact=True).input_value()
        other = page.context.new_page()
        other.set_default_timeout(30_000)
        other.goto(address)
        settled(other)
        assert shown(other, "end_mass_stick") == bored
    with opened(browser, link) as page:
        assert shown(page, "end_mass_stick") == bored
        names = page.locator("thead th").all_inner_texts()
        assert names == ["number", "this design", "pool_maple 1"]
        page.get_by_role("button", name="Undo").click()
        page.wait_for_function(
            "was => document.querySelector('[data-number=end_mass_stick]').innerText === was", arg=was
        )


def test_a_wrong_number_is_said_beside_its_field_and_inches_are_remembered(browser: Any, address: str) -> None:
    with opened(browser, address) as page:
        was = shown(page, "shaft_mass")
        typed(page, "Tip diameter, mm", "99")
        knob = page.locator(".knob").filter(has_text="Tip diameter")
        said = "must be from 4 to 30.00 mm; the design keeps 12.75 mm"
        assert knob.get_by_role("alert").inner_text() == said
        typed(page, "Tip diameter, mm", "twelve")
        assert knob.get_by_role("alert").inner_text().startswith("must be a number, such as 11.8 or 11,8")
        typed(page, "Bore width, mm", "11")
        typed(page, "Tip diameter, mm", "8")
        typed(page, "Bore depth, from 25 mm on, mm", "20")
        assert "the bore must be narrower than the cue" in page.locator(".knob .wrong").last.inner_text()
        assert shown(page, "shaft_mass") != was
        page.get_by_role("combobox", name="Units").click()
        page.get_by_role("option", name="in, oz").click()
        page.get_by_label("Tip diameter, in, as a number").wait_for()
        page.reload()
        settled(page)
        assert shown(page, "shaft_mass").endswith(" oz")
        assert shown(page, "balance").endswith(" in")
        typed(page, "Tip diameter, in", "29/64")
        assert page.get_by_label("Tip diameter, in, as a number").input_value() == "29/64"
        metric = page.locator("body").inner_text()
        assert not re.search(r"[0-9] (mm|g)\b", metric.partition("The numbers are the same")[0])


def test_three_designs_are_compared_and_exported(browser: Any, address: str, tmp_path: Path) -> None:
    with opened(browser, address) as page:
        page.get_by_role("button", name="Pin this design").click()
        turn(page, "tip_diameter", "ArrowLeft", 10)
        page.get_by_role("button", name="Pin this design").click()
        turn(page, "bore_depth", "PageUp", 3)
        page.get_by_label("name of pinned design 2").fill("thin")
        page.wait_for_function("[...document.querySelectorAll('thead th')].some(e => e.innerText === 'thin')")
        cells = page.locator("tr", has=page.locator('[data-number="end_mass_stick"]')).locator("td").all_inner_texts()
        values = [float(cell.split(" g")[0]) for cell in cells]
        parts = [float(found[1].replace("−", "-")) for cell in cells if (found := re.search(r"([−+][0-9.]+)\s%", cell))]
        assert parts == pytest.approx([100 * (values[i] / values[1] - 1) for i in (0, 2)], abs=0.06)
        legends = page.locator(".legend", has_text="coupled, in time").filter(has_text="thin")
        legends.nth(1).wait_for()  # curves come after the numbers
        assert legends.count() == 2
        with page.expect_download() as waiting:
            page.get_by_role("button", name="Save the table as .csv").click()
        waiting.value.save_as(tmp_path / "table.csv")
        head, *lines = (tmp_path / "table.csv").read_text(encoding="utf-8-sig").splitlines()
        assert head.startswith('"",unit,this design,' if head[0] == '"' else ",unit,this design,")
        assert head.endswith('thin,"thin, % from pool_maple 1"')
        assert any(line.startswith("Tip diameter,mm,12.25,") for line in lines)


def test_a_person_starts_from_nothing(browser: Any, address: str, tmp_path: Path) -> None:
    """A drawing with its weight in ounces, a game, a ready cue, and any field of it."""
    (tmp_path / "mine.csv").write_text("x [mm],diameter [mm]\n0,12.75\n330,13.2\n736.6,21.5\n")
    with opened(browser, address) as page:
        page.locator("input[type=file]").first.set_input_files(tmp_path / "mine.csv")
        page.get_by_label("Weight, g").fill("3 oz")
        page.get_by_role("button", name="Open it", exact=True).last.click()
        page.get_by_text("the whole cue must weigh more than what is drawn").wait_for()
        page.get_by_label("Weight, g").fill("19 oz")
        page.get_by_label("Ferrule", exact=True).fill("25 mm cheese")
        page.get_by_role("button", name="Open it", exact=True).last.click()
        page.get_by_text("no material is called 'cheese'").wait_for()
        page.get_by_label("Ferrule", exact=True).fill("25 mm melamine")
        page.get_by_label("Bore", exact=True).fill("1/4 in wide, 5 in deep")
        page.get_by_role("button", name="Open it", exact=True).last.click()
        page.get_by_role("heading", level=1, name="mine.csv").wait_for()
        settled(page)
        made = cf.load(downloaded(page, "Save as .toml", tmp_path))
        assert made.cue.mass == pytest.approx(19 * 28.349523125e-3, rel=1e-9)
        bare = cf.load(tmp_path / "mine.csv", ferrule="25 mm melamine", bore="1/4 in wide, 5 in deep")
        assert made == cf.usual_scene(replace(bare, body_mass=made.cue.body_mass))
        page.get_by_text("Everything in this design").click()
        page.get_by_role("group", name="Segment 1", exact=True).get_by_role("button", name="Split").click()
        page.get_by_role("group", name="Segment 3", exact=True).wait_for()
        page.get_by_role("checkbox", name="AxialWaves").wait_for()
        page.get_by_role("button", name="Ready cues").click()
        page.get_by_text("Pool: low-deflection shaft on a bridge").click()
        page.get_by_role("heading", level=1, name="pool_low_deflection.toml").wait_for()
        page.get_by_role("checkbox", name="Support acts").click()
        page.get_by_role("checkbox", name="Support", exact=True).wait_for()
        settled(page)
        ready = cf.load(ROOT / "studies" / "scenes" / "pool_low_deflection.toml")
        kept = tuple(effect for effect in ready.effects if not isinstance(effect, cf.Support))
        assert cf.load(downloaded(page, "Save as .toml", tmp_path)) == replace(ready, effects=kept)


def test_the_page_asks_for_the_weight_of_a_profile(browser: Any, tmp_path: Path) -> None:
    """`cuefem designer my.csv` takes the options of `cuefem report`, and the page asks for the one that is missing."""
    file = tmp_path / "mine.csv"
    file.write_text("x [mm],diameter [mm]\n0,12.75\n330,13.2\n736.6,21.5\n")
    told = ("--ferrule", "25 mm melamine", "--speed", "3 m/s", "--material", "ash")
    (tmp_path / "desk").mkdir()
    with served(tmp_path / "desk", file, *told) as address, opened(browser, address) as page:
        page.get_by_label("Weight, g").fill("19 oz")
        assert not page.get_by_label("Ferrule", exact=True).is_visible()  # that is told already
        page.get_by_role("button", name="Open it", exact=True).last.click()
        page.get_by_label("Weight, g").wait_for(state="hidden")
        settled(page)
        made = cf.load(downloaded(page, "Save as .toml", tmp_path))
        assert made.cue.mass == pytest.approx(19 * 28.349523125e-3, rel=1e-9)
        assert made.stroke.speed == 3
        bare = cf.load(file, ferrule="25 mm melamine", material="ash")
        assert made.cue == replace(bare, body_mass=made.cue.body_mass)


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
    page.locator(".said[role=alert]").filter(has_text="not opened: a.toml").wait_for()
    for name, words in NAMES.items():
        page.evaluate(SENT, [sent.value.url, name, " "])
        page.locator(".said[role=alert]").filter(has_text=f"not opened: {words}").wait_for()
    context.close()


def test_a_file_is_opened_changed_and_taken_back(browser: Any, address: str, tmp_path: Path) -> None:
    with opened(browser, address) as page:
        page.locator("input[type=file]").set_input_files(ROOT / "meshes" / "kim.toml")
        page.get_by_role("heading", level=1, name="kim.toml").wait_for()
        settled(page)
        assert page.get_by_text("no ferrule is drawn behind the tip").count() == 1
        assert page.locator('[data-knob="ferrule_length"]').count() == 0
        assert page.get_by_text("assumed: a usual stroke of pool").count() == 1
        assert page.get_by_text("e 0.73 of the whole cue head on: 0.63 of its tip").count() == 1
        path = downloaded(page, "Save as .toml", tmp_path)
        assert cf.load(path) == cf.usual_scene(cf.load(ROOT / "meshes" / "kim.toml"))
        assert_as_commanded(page, path)
        was = shown(page, "squirt")
        turn(page, "taper_diameter", "ArrowRight", 3)
        assert shown(page, "squirt") != was
        page.get_by_role("button", name="Back to the file").click()
        page.wait_for_function("was => document.querySelector('[data-number=squirt]').innerText === was", arg=was)


# What has the focus: its role, its name (of a word that is explained, what it opens), whether a slider shows that it
# has it, and whether it had it before all others.
REACHED = """() => {
  const e = document.activeElement, thumb = e.querySelector(".q-slider__thumb");
  const name = e.getAttribute("popovertarget") || e.ariaLabel || e.innerText;
  const again = e === window.firstReached;
  window.firstReached ??= e;
  return [e.getAttribute("role") || "", name, thumb ? getComputedStyle(thumb).outlineStyle !== "none" : false, again];
}"""


def test_it_is_worked_by_keys_alone(browser: Any, address: str) -> None:
    with opened(browser, address) as page:
        reached: list[tuple[str, str]] = []
        for _ in range(300):
            page.keyboard.press("Tab")
            role, label, outlined, again = page.evaluate(REACHED)
            if again:
                break  # once round
            reached.append((role, label))
            assert outlined or role != "slider"
        sliders = [label for role, label in reached if role == "slider"]
        assert sliders[0] == "Tip diameter, mm"
        assert len(set(sliders)) == page.locator("[data-knob] [role=slider]").count() == 18
        names = {label for _, label in reached}
        buttons = page.locator("button:not(:disabled):not(.term):visible").all()
        assert {one.get_attribute("aria-label") or one.inner_text() for one in buttons} <= names
        assert sum(label.startswith("Squirt: ") for label in names) == 1  # a chart to read values from
        assert {"w-squirt", "w-natural-pivot-length", "w-bore", "w-ferrule"} <= {label for _, label in reached}
        slider = page.get_by_role("slider", name="Offset b/R")
        slider.focus()
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


MOST_BEFORE = 8_000  # bytes that come before the squirt of a move


def test_a_move_sends_its_numbers_before_anything_that_is_drawn_anew(browser: Any, address: str) -> None:
    """What a page gets until its squirt is there, in the order in which it comes."""
    with opened(browser, address) as page:
        session = page.context.new_cdp_session(page)
        session.send("Network.enable")
        came: list[str] = []
        session.on("Network.webSocketFrameReceived", lambda event: came.append(event["response"]["payloadData"]))
        turn(page, "tip_diameter")
        came.clear()
        turn(page, "tip_diameter")
        messages = [message for message in came if message.startswith("42")]
        numbers = next(i for i, message in enumerate(messages) if "data-key" in message)
        before = messages[: numbers + 1]
        assert sum(map(len, before)) < MOST_BEFORE
        assert not any(message.startswith('42["update"') for message in before)
        updates = [message for message in messages if message.startswith('42["update"')]
        assert 1 <= len(updates) <= 2  # the knob's text
        assert not any("q-slider" in message or "<svg" in message for message in updates)


def test_presses_that_come_faster_than_answers_all_count(browser: Any, address: str) -> None:
    """A late answer does not move the slider back; an undone move does, also to where the page last heard it stand."""
    with opened(browser, address) as page:
        field = page.get_by_label("Tip diameter, mm, as a number")
        slider = page.get_by_role("slider", name="Tip diameter, mm", exact=True)
        slider.focus()
        for _ in range(12):
            page.keyboard.press("ArrowRight")
            page.wait_for_timeout(20)
        settled(page)
        assert (slider.get_attribute("aria-valuenow"), field.input_value()) == ("13.35", "13.35")
        page.get_by_role("button", name="Undo").click()
        page.wait_for_function("document.querySelector('[data-knob=tip_diameter] [role=slider]').ariaValueNow < 13")
        settled(page)
        assert (slider.get_attribute("aria-valuenow"), field.input_value()) == ("12.75", "12.75")


WATCH = """() => {
  window.trips = { squirt: [], end_mass_stick: [] };
  const number = key => document.querySelector(`[data-key=${key}]:not(.stale)`)?.innerText;
  const began = {}, was = {};
  addEventListener("keydown", () => {
    for (const key in trips) { began[key] = performance.now(); was[key] = number(key) ?? was[key]; }
  }, true);
  new MutationObserver(() => {
    for (const key in trips) {
      if (!began[key] || !number(key) || number(key) === was[key]) continue;
      window.trips[key].push(performance.now() - began[key]);
      began[key] = null;
    }
  }).observe(document.body, { subtree: true, childList: true, characterData: true });
}"""


def test_round_trips_are_told(
    browser: Any, address: str, capsys: pytest.CaptureFixture[str], record_property: Any
) -> None:
    """How long a move takes until its squirt is on the page, and until its end mass is."""
    pause = 30  # ms
    with opened(browser, address) as page:
        page.evaluate(WATCH)
        page.locator('[data-knob="tip_diameter"] [role="slider"]').focus()
        for move in range(MOVES):
            page.keyboard.press("ArrowRight" if move < MOVES // 2 else "ArrowLeft")
            page.wait_for_function("n => Object.values(window.trips).every(one => one.length > n)", arg=move)
            page.wait_for_timeout(pause)
        trips = page.evaluate("window.trips")
        for name, times in trips.items():
            assert len(times) == MOVES
            median, slowest = statistics.median(times), max(times)
            record_property(f"{name}: median, ms, {pause} ms between moves", median)
            with capsys.disabled():
                print(f"\n{name} after {median:.0f} ms (median), {min(times):.0f} to {slowest:.0f} ms")
