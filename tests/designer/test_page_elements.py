"""The designer's page without a browser: its elements, typed values and results against golden files (regression)."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Iterator
from typing import Any

import pytest

pytest.importorskip("nicegui", reason="needs NiceGUI: pip install '.[designer]' in the clone")
from nicegui import Client, core, ui

from cuefem.designer.controls import DRILLED
from cuefem.designer.knob_row import KnobRow
from cuefem.designer.page import Page
from cuefem.designer.session import OPENED
from cuefem.designer.state import reference_design
from cuefem.files.reference_cues import PRESETS
from tests.test_golden_files import assert_golden, drawing_text, page_text

KIM = reference_design(next(preset for preset in PRESETS if preset.file == "studies/scenes/kim.toml"))
# Typed in the first page's fields, one after the other: with and without units, too small, too large, no numbers.
TYPED = {
    "tip_diameter": ("11,8", "1/2 in", "30", "x", ""),
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
CHOSEN = {"shaft_material": "ash", "ferrule": "brass", "game": "pool", "leather": "hard"}
RANGE = ("min", "max", "step", "value", "style")  # of a slider
UNSTABLE = ("url", "for", "id")  # props with the number of a client or an element


def described(client: Client) -> Iterator[str]:
    """One line an element: tag, classes, text and properties, then the text and charts of its markup."""
    for element in client.elements.values():
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
    page.compute = lambda: None  # type: ignore[method-assign]
    return page


async def of_results() -> str:
    """The elements of a page that compares two offsets."""
    client = Client(ui.page("/"), request=None)
    with client:
        page = opened()
        page.session.set_knob("offset", 0.2)
        page.session.compare_with(OPENED)
        page.show()
        assert page.session.compute("Numbers") == []
        page.screen.show_results()
        page.tabs.show_results()
    return "\n".join(described(client)) + "\n"


def line(row: KnobRow) -> str:
    """What a row shows."""
    slider = {name: row.slider.props.get(name) for name in RANGE} if row.slider else ""
    return f"{row.key} | {row.label.text} | {row.note.text} | {row.field.value} | {row.error.text} | {slider}"


async def of_typed_values() -> str:
    """Each row of the controls after each typed value."""
    client, lines = Client(ui.page("/"), request=None), []
    with client:
        page = opened()
        rows = {row.key: row for row in page.controls.rows}
        for key, texts in [*TYPED.items(), *((key, (text,)) for key, text in CHOSEN.items())]:
            for text in texts:
                rows[key].field.value = text
                rows[key]._on_input()
                row, slider = rows[key], rows[key].slider
                props = (
                    {name: slider.props.get(name) for name in ("min", "max", "step", "value", "style")}
                    if slider
                    else {}
                )
                parts = (key, text, row.label.text, row.note.text, str(row.field.value), row.error.text, str(props))
                lines.append(" | ".join(parts))
        page.session.set_knob("bore", DRILLED)
        page.session.compare_with(OPENED)
        page.show()
        lines += map(line, page.controls.rows)
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("text", [of_results, of_typed_values])
def test_page_equals_golden_file(text: Any, request: pytest.FixtureRequest) -> None:
    assert_golden(f"designer_{text.__name__}.txt", asyncio.run(text()), request)
