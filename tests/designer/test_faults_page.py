"""What people stumbled over on the page, and no longer do: labels, digits, and where there is more (regression)."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.designer.sliders import sliders
from cuefem.designer.start import first_scene
from cuefem.designer.unit_system import INCHES
from cuefem.designer.words import MEASURED
from cuefem.io.ready import PRESETS
from cuefem.report.report_page import page as report_page
from cuefem.vary import PLACES, knobs_of
from tests.helpers.designer_browser import needs_browser, opened, settled

browsed = needs_browser()
MESHES = Path(__file__).parents[2] / "meshes"


def test_a_place_is_labelled_as_it_is_with_no_more_digits_than_a_maker_reads() -> None:
    assert "Taper, at 330.2 mm" in [slider.label for slider in sliders(first_scene())]
    inches = {slider.knob: slider for slider in sliders(first_scene(), INCHES)}
    assert "Taper, at 13 in" in [slider.label for slider in inches.values()]
    knobs = knobs_of(first_scene())
    texts = {knob: slider.text(slider.shown(knobs)) for knob, slider in inches.items()}
    assert texts["tip_diameter"] == "0.502"
    assert max(len(text.partition(".")[2]) for text in texts.values()) <= 4
    assert inches["tip_diameter"].turned(knobs, 0.5)["tip_diameter"] == 0.0127  # half an inch is saved as such


# Cells with one word that takes two lines.
BROKEN = """[...document.querySelectorAll("table td, table th")].filter(cell => {
  const inside = document.createRange();
  inside.selectNodeContents(cell);
  return /^\\S+$/.test(cell.innerText) && inside.getBoundingClientRect().height > 32;
}).map(cell => cell.innerText)"""
WHISKER = re.compile(r'class="whisker" d="M([0-9.]+) [0-9.]+H([0-9.]+)"')


USUAL = first_scene()
WOOD, BRASS = cf.Material(12.6e9, 0.84e9, 782.0), cf.Material(1e11, 3.7e10, 8500.0)
RINGING = cf.Cue((cf.Segment(0.006, 0.012, 0.012, BRASS), cf.Segment(0.7, 0.012, 0.021, WOOD)), 0.4)


@pytest.mark.parametrize(
    ("scene", "told"),
    [
        (USUAL, False),
        (cf.Scene(USUAL.cue, USUAL.ball, cf.Tip(contact_time=2e-3), USUAL.stroke), False),
        (cf.Scene(RINGING, tip=cf.Tip(contact_time=1.2e-3), stroke=cf.Stroke(offset=0.3)), True),
    ],
    ids=["leather", "spring", "a brass tip that rings"],
)
def test_a_line_through_a_dot_is_told_only_where_one_is(scene: cf.Scene, told: bool) -> None:
    """The range of an end mass while fewer modes are kept is told only where it is longer than its dot."""
    text = report_page("a scene", scene)
    drawn = [float(high) - float(low) for low, high in WHISKER.findall(text)]
    assert len(drawn) > 3
    assert any(length > 9 for length in drawn) is told
    assert ("The line through a dot" in text) is told


def test_what_was_measured_on_a_ready_cue_is_told_in_a_sentence() -> None:
    told = [preset.told for preset in PRESETS]
    assert "no measurement known" in told
    assert all(words == "no measurement known" or words.startswith("measured on such cues: ") for words in told)
    assert all(words.startswith(MEASURED) for words in told)


class TestOnThePage:
    pytestmark = browsed

    def test_the_bores_label_follows_the_ferrule(self, browser: Any, address: str) -> None:
        with opened(browser, address) as page:
            page.get_by_label("Bore depth, from 25 mm on, mm, as a number").wait_for()
            page.get_by_label("Ferrule length, mm, as a number").fill("20")
            page.get_by_label("Bore depth, from 20 mm on, mm, as a number").wait_for()
            page.get_by_role("slider", name="Bore depth, from 20 mm on, mm").wait_for()
            settled(page)
            assert page.locator(".knob").filter(has_text="from 20 mm on").count() == 1
            page.get_by_role("button", name="Undo").click()
            page.get_by_label("Bore depth, from 25 mm on, mm, as a number").wait_for()

    def test_all_fields_are_short_in_inches(self, browser: Any, address: str) -> None:
        with opened(browser, address) as page:
            page.get_by_text("Everything in this design").click()
            page.get_by_role("checkbox", name="AxialWaves").wait_for()
            page.get_by_role("combobox", name="Units").click()
            page.get_by_role("option", name="in, oz").click()
            page.get_by_label("Tip diameter, in, as a number").wait_for()
            settled(page)
            values = [field.input_value() for field in page.locator('input[inputmode="decimal"]').all()]
            assert max(len(value.partition(".")[2]) for value in values) <= 5
            labelled = page.locator("label").filter(has_text=re.compile("length, in")).locator("input").all()
            assert all(re.fullmatch(r"[0-9]+(\.[0-9]{1,4})?", field.input_value()) for field in labelled)

    @pytest.mark.parametrize("scheme", ["light", "dark"])
    def test_the_knobs_show_that_there_are_more(self, browser: Any, address: str, scheme: str) -> None:
        """A shadow stands at the end of the panel until one has scrolled to the last knob."""
        with opened(browser, address, scheme=scheme) as page:
            box = page.locator(".knobs").bounding_box()
            strip = {"x": box["x"] + 2, "y": box["y"] + min(box["height"], 900 - box["y"]) - 4, "width": 8, "height": 3}
            page.evaluate("document.querySelector('.knobs').scrollTop = 0; scrollTo(0, 0)")
            page.evaluate(
                "(e => e.style.maxHeight = (innerHeight - e.getBoundingClientRect().top - 9) + 'px')"
                "(document.querySelector('.knobs'))"
            )
            box = page.locator(".knobs").bounding_box()
            strip["y"] = box["y"] + box["height"] - 5
            more = page.screenshot(clip=strip)
            page.evaluate("document.querySelector('.knobs').scrollTop = 1e6")
            page.wait_for_timeout(200)
            assert page.screenshot(clip=strip) != more

    def test_a_legends_words_stay_together_on_a_phone(self, browser: Any) -> None:
        context = browser.new_context(viewport={"width": 390, "height": 844})
        page = context.new_page()
        page.set_content(report_page("hollow", cf.usual_scene(cf.load(MESHES / "pool_hollow.toml"))))
        shapes = page.evaluate(
            "[...document.querySelectorAll('.legend > span')].map(e => [e.innerText.length,"
            " e.getBoundingClientRect().height, e.scrollWidth, e.parentElement.clientWidth])"
        )
        context.close()
        assert len(shapes) > 3
        for letters, height, wide, room in shapes:
            assert height < 26 * (1 + letters // 30)  # as many lines as its letters take
            assert wide <= room

    def test_knobs_say_what_else_they_move(self, browser: Any, address: str) -> None:
        with opened(browser, address) as page:
            hints = page.locator(".knob [title]").evaluate_all(
                "parts => parts.map(part => [part.innerText, part.title])"
            )
        known = {place.title: place.hint for place in PLACES.values() if place.hint}
        assert {label: hint for label, hint in hints if label in known}.items() <= known.items()
        assert dict(hints)["Ferrule length"] == known["Ferrule length"]

    @pytest.mark.parametrize("name", ["pool_hollow", "whole_cue"])
    def test_no_table_of_a_report_is_cut_on_a_phone(self, browser: Any, name: str) -> None:
        """A table wraps its words between letters of no number: nothing of it is beyond the edge."""
        page = browser.new_page(viewport={"width": 390, "height": 844})
        page.set_content(report_page(name, cf.usual_scene(cf.load(MESHES / f"{name}.toml"))))
        page.evaluate("document.querySelectorAll('details').forEach(fold => fold.open = true)")
        shapes = page.evaluate("[...document.querySelectorAll('.scroll')].map(e => [e.scrollWidth, e.clientWidth])")
        broken = page.evaluate(BROKEN)
        page.close()
        assert len(shapes) >= 5
        assert all(wide <= room + 1 for wide, room in shapes), shapes
        assert broken == []

    def test_the_printed_glossary_shows_every_letter(self, browser: Any) -> None:
        page = browser.new_page()
        page.set_content(report_page("hollow", cf.usual_scene(cf.load(MESHES / "pool_hollow.toml"))))
        page.emulate_media(media="print")
        hidden = page.evaluate(
            "[...document.querySelectorAll('.word')].filter(e => getComputedStyle(e).overflowX !== 'visible').length"
        )
        assert page.locator(".word").count() > 10
        page.close()
        assert hidden == 0
