"""The designer's page without a browser: its elements, typed values and results against golden files (regression)."""

from __future__ import annotations

import asyncio
import itertools
import re
from collections.abc import Awaitable, Callable, Iterator
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("nicegui", reason="needs NiceGUI: pip install '.[designer]' in the clone")
from nicegui import Client, core, ui

from cuefem.analysis.design_changes import ChangedDesign, DesignChanges
from cuefem.cue import Array
from cuefem.designer.controls import DRILLED, LEATHER_BEGINS
from cuefem.designer.file_editor import FileEditor
from cuefem.designer.knob_row import KnobRow
from cuefem.designer.page import Page
from cuefem.designer.session import FILE, NOTHING, OPENED
from cuefem.designer.state import reference_design
from cuefem.designer.tabs import changes_panel
from cuefem.scene import Scene
from tests.test_golden_files import assert_golden, drawing_text, page_text

Step = Callable[[Page], Any]
KIM = reference_design("kim bare")
# Typed in the first page's fields, one after the other: with and without units, too small, too large, no numbers.
TYPED = {
    "tip_diameter": ("11,8", "1/2 in", "30", "x", "", "12 g", "1/0 in", "nan mm", "9" * 50),
    "taper_diameter": ("13.5 mm", "2 mm"),
    "tip_height": ("6", "50"),
    "shaft_mass": ("4 oz", "1 g"),
    "friction": ("0.55", "-1", "1 mm"),
    "restitution": ("0.8", "1.2"),
    "contact_time": ("1.2", "1 s"),
    "speed": ("5 mph", "100"),
    "offset": ("9 mm", "0.99"),
    "ball_mass": ("6 oz",),
    "ball_diameter": ("57.15", "1 m"),
}
CHOSEN = {"shaft_material": "ash", "ferrule": "brass", "game": "pool", "leather": "hard", "dome": "2 mm"}
RANGE = ("min", "max", "step", "value", "style")  # of a slider
UNSTABLE = ("url", "for", "id")  # props with the number of a client or an element


def described(client: Client) -> Iterator[str]:
    """One line an element but timers: tag, classes, text and properties, then the text and charts of its markup."""
    for element in client.elements.values():
        if isinstance(element, ui.timer):
            continue
        props: dict[str, Any] = {
            name: value for name, value in sorted(element.props.items()) if name not in UNSTABLE and name[0] != "_"
        }
        markup = str(props.pop("innerHTML", ""))
        shown = re.sub(r"\bc\d+\b", "c", f"{element.tag} {' '.join(element.classes)} {props}")
        yield f"{shown} {getattr(element, 'text', '')}".rstrip()
        yield from (page_text(markup) + drawing_text(markup)).split("\n") if markup else ()


def opened() -> Page:
    """A page whose computations in the background do not begin."""
    core.loop = asyncio.get_running_loop()
    page = Page(KIM)
    page.compute = lambda: None
    return page


def failing(scene: Scene) -> None:
    """A strike that fails."""
    raise ValueError("the leather is squeezed\nflat")


def along(scene: Scene) -> tuple[Array, Array]:
    """A mass's increase of the end mass along the cue, which takes longer to compute."""
    x = np.linspace(0, 0.3, 7)
    return x, np.exp(-x / float(scene.stroke.offset))


async def compared(tab: str) -> Page:
    """A page that compares two designs, with the results of a tab, which an older computation leaves."""
    page = opened()
    page.session.set_knob("offset", 0.54)
    page.session.set_knob("tip_diameter", 0.0125)
    page.session.compare_with(OPENED)
    page.show()
    page.tabs.open = tab
    page.screen.set_stale()
    page.set_busy(True)
    await page._compute(page.run - 1)
    assert (page.screen.tiles.content, page.main.props["data-busy"]) == ("", "true")
    await page._compute(page.run)
    return page


async def of_results() -> str:
    """The elements of a page that compares two designs."""
    with Client(ui.page("/"), request=None) as client:
        page = await compared("Numbers")
        row = ChangedDesign("bore + thin", {}, 0.01, 300.0, 0.1, 90.0, -0.1, -0.06, -1e-3, 2.0, 0.02, "worthwhile")
        rows = [row, replace(row, change="wider", squirt_change=0.1, verdict="more squirt")]
        base = {"squirt": 0.011, "tip_stiffness": 319.0, "shaft_mass": 0.101, "frequency": 88.0}
        page.session.results.own["changes"] = DesignChanges(KIM.scene, 0.3, "slip", base, rows, together=rows[:1])
        changes_panel(page.session, lambda values: None)
        return "\n".join(described(client)) + "\n"


async def of_tabs() -> str:
    """The content of tabs of that page, whose designs are computed."""
    with Client(ui.page("/"), request=None), pytest.MonkeyPatch.context() as patch:
        patch.setattr("cuefem.designer.computation.end_mass_distribution", along)
        page = await compared("Curves")
        lines = list[str]()
        for page.tabs.open in ("Curves", "Numbers", "Check"):
            page.tabs.show_results()
            markup = str(getattr(page.tabs, page.tabs.open.lower()).content)
            lines += [page_text(markup), drawing_text(markup)]
        patch.setattr("cuefem.designer.computation.solved_strike", failing)
        await page._compute(page.run)
        lines.append(f"{page.banner.text} {page.banner.visible} {page.main.props['data-busy']}\n")
        page.session.count = 3, 7
        for step in (page.tabs.begin, lambda: setattr(page.tabs, "open", "Changes"), page.tabs.begin):
            step()
            lines.append(f"counts: {page.tabs.counting.active}\n")
        page.tabs._show_count()
        lines.append(page.tabs.count.text)
        page.tabs.end()
        lines.append(f" {page.tabs.counting.active} {page.tabs.count.text}\n")
        return "".join(lines)


def line(row: KnobRow, text: str | None = None) -> str:
    """What a row shows, after a text was typed in it."""
    slider = {name: row.slider.props.get(name) for name in RANGE} if row.slider else ""
    parts = row.label.text, row.note.text, row.field.value, row.error.text, slider
    return " | ".join([row.key, *([] if text is None else [text]), *map(str, parts)])


async def of_typed_values() -> str:
    """Each row of the controls after each typed value."""
    lines = []
    with Client(ui.page("/"), request=None):
        page = opened()
        rows = {row.key: row for row in page.controls.rows}
        for key, texts in [*TYPED.items(), *((key, (text,)) for key, text in CHOSEN.items())]:
            for text in texts:
                rows[key].field.value = text
                rows[key]._on_input()
                lines.append(line(rows[key], text))
        page.session.set_knob("bore", DRILLED)
        page.session.compare_with(OPENED)
        page.show()
        enter("bore_width", "1 m")(page)
        lines += map(line, page.controls.rows)
    return "\n".join(lines) + "\n"


def shown(page: Page) -> dict[str, str]:
    """What the page shows of its session, by part."""
    history, header, screen, file = page.session.history, page.header, page.screen, page.tabs.file
    enabled = [each.enabled for each in (header.undo, header.redo)]
    rows = {row.key: f"{line(row)} {row.root.visible} {' '.join(row.field.classes)}" for row in page.controls.rows}
    return rows | {
        "name": f"{header.name.value} {header.changed.text} {page.session.file_name('csv')}",
        "steps": f"{history.at} of {len(history.steps)} {enabled}",
        "banner": f"{page.banner.text} {page.banner.visible}",
        "compare": f"{screen.compare.value} of {screen.compare.options} {screen.swap.visible}",
        "calibration": f"{screen.calibration.visible}",
        "file": f"{file.title.text} {file.apply.enabled} {file.error.text}" if file else "",
        "captions": str([fold.props["caption"] for fold in page.controls.folds.values()]),
    }


def row_of(page: Page, key: str) -> KnobRow:
    """The row of a control."""
    return next(row for row in page.controls.rows if row.key == key)


def slide(key: str, at: object) -> Step:
    """Move a slider."""
    return lambda page: row_of(page, key)._slid(SimpleNamespace(args=at))


def enter(key: str, text: str) -> Step:
    """Type a text, and enter it."""

    def step(page: Page) -> None:
        row = row_of(page, key)
        row.field.value = text
        row._on_input(entered=True)

    return step


def choose(key: str, option: str) -> Step:
    """Choose an option."""
    return lambda page: setattr(row_of(page, key).field, "value", option)


def press(key: str, *, ctrl: bool = True, shift: bool = False, down: bool = True) -> Step:
    """Press a key."""
    modifiers = SimpleNamespace(ctrl=ctrl, meta=False, shift=shift)
    return lambda page: page._key(SimpleNamespace(key=key, action=SimpleNamespace(keydown=down), modifiers=modifiers))


def upload(name: str, content: bytes) -> Step:
    """Open an uploaded file."""

    async def read() -> bytes:
        return content

    return lambda page: page.header.upload.take_file(SimpleNamespace(file=SimpleNamespace(name=name, read=read)))


def edit(old: str, new: str) -> Step:
    """Edit the file of the design, and apply it."""

    def step(page: Page) -> None:
        page.tabs._on_open(SimpleNamespace(value="File"))
        assert page.tabs.file is not None
        page.tabs.file.editor.value = page.tabs.file.editor.value.replace(old, new)
        page.tabs.file._apply()

    return step


def compare(choice: str) -> Step:
    """Choose what to compare with."""
    return lambda page: page.screen.compare.set_value(choice)


CSV = b"position (mm);diameter (mm)\n0;12,4\n330;13,1\n737;21,5\n"
# What a user does one after the other, .8 s apart: moves of a slider within 1.5 s are one step.
STEPS: dict[str, Step] = {
    "slide to 12.5": slide("tip_diameter", 12.5),
    "slide on to 12.6": slide("tip_diameter", 12.6),
    "slide another": slide("speed", 3.3),
    "slide to the same": slide("speed", 3.3),
    "slide to nothing": slide("speed", None),
    "slide the speed back": slide("speed", 3.2),
    "undo": press("z"),
    "undo again": press("z"),
    "redo": press("y"),
    "redo again": press("Z", shift=True),
    "no key": press("z", ctrl=False),
    "key up": press("z", down=False),
    "rename": lambda page: page.header.name.set_value(" my/cue 2 "),
    "drill": choose("bore", DRILLED),
    "slide the bore": slide("bore_width", 4.0),
    "fill": choose("bore", "none"),
    "game": choose("game", "snooker"),
    "leather": choose("leather", "hard"),
    "tip": lambda page: page.attempt(page.session.set_knob, "front", LEATHER_BEGINS),
    "compare": compare("low deflection"),
    "swap": lambda page: page.attempt(page.session.swap),
    "compare with the file opened": compare(OPENED),
    "compare with a file": compare(FILE),
    "which is": upload("mine.csv", CSV),
    "compare with nothing": compare(NOTHING),
    "open a file": upload("folder\\mine.csv", CSV),
    "open no file": upload("mine.csv", b"position"),
    "open a long file": upload("mine.csv", CSV + b"#" * 5_000_001),
    "slide to the assumed": slide("speed", 2.0),
    "weigh": enter("shaft_mass", "95"),
    "weigh less": enter("shaft_mass", "3 oz"),
    "keep": enter("dome", "9.5 mm"),
    "thicker": slide("butt_diameter", 22.0),
    "edit the offset too far": edit("offset = 0.3", "offset = 1.3"),
    "edit the offset": edit("offset = 1.3", "offset = 0.25"),
    "invalid change": lambda page: page.attempt(page.session.set_parameters, {"tip diameter": -0.01}),
    "change": lambda page: page.attempt(page.session.set_parameters, {"tip diameter": 0.012}),
    "other wood": choose("shaft_material", "ash"),
}


async def of_steps() -> str:
    """What each step of a user changes on the page."""
    clock, lines = itertools.count(step=0.8), []
    with Client(ui.page("/"), request=None) as client, pytest.MonkeyPatch.context() as patch:
        patch.setattr("cuefem.designer.session.time", SimpleNamespace(monotonic=clock.__next__))
        patch.setattr(FileEditor, "set_accessible_name", lambda self: None)
        page = opened()
        before = shown(page)
        for words, step in STEPS.items():
            if isinstance(waits := step(page), Awaitable):
                await waits
            now = shown(page)
            lines += [f"- {words}", *(f"{part}: {text}" for part, text in now.items() if text != before[part])]
            before = now
        page.session.results.own["verdict"] = SimpleNamespace(inputs={"speed": 0.01, "friction": 0.2, "E": 0.1})
        page.screen.fold.value = True
        await asyncio.sleep(0.001)  # until the assumptions are unfolded
        unfolded = "\n".join(described(client)).partition("div assumption")[2]
        lines += re.findall(r"(?<=data-knob': ')\w+|(?<=soft \{\} ).* ±.*", unfolded)
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("text", [of_results, of_tabs, of_steps, of_typed_values])
def test_page_equals_golden_file(text: Any, request: pytest.FixtureRequest) -> None:
    assert_golden(f"designer_{text.__name__}.txt", asyncio.run(text()), request)
