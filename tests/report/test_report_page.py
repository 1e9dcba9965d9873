"""The report page: well-formed, self-contained, agrees with the library, and looks right in a browser (regression)."""

import math
import re
from collections import Counter
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.report.charts import WIDE, Axis, round_step
from cuefem.report.drawings import ACROSS, cue_drawing
from cuefem.report.report_page import page

MESHES = Path(__file__).parents[2] / "meshes"
SCENES = MESHES.parent / "studies" / "scenes"
VOID = {"meta", "link", "br"}

LUMPED = cf.Scene(cf.LumpedCue(0.54, 0.006), stroke=cf.Stroke(offset=0.3))


def scene(name: str) -> cf.Scene:
    found = cf.load(SCENES / f"{name}.toml")
    assert isinstance(found, cf.Scene)
    return found


class Reader(HTMLParser):
    """Tags, attributes and text of a page; refuses tags that do not close in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: Counter[str] = Counter()
        self.attributes: list[tuple[str, str]] = []
        self.text: list[str] = []
        self.within = False  # a sentence that a word which is explained stands in
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags[tag] += 1
        self.attributes += [(name, value or "") for name, value in attrs]
        self.within = tag == "button"
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert tag in VOID or self.open.pop() == tag
        self.within = tag == "button"

    def handle_data(self, data: str) -> None:
        if not {"style", "script"} & set(self.open):
            self.text[-1:] = ["".join([*self.text[-1:], data])] if self.within else [*self.text[-1:], data]


def assert_sound(text: str) -> Reader:
    """A page that is whole, needs nothing from outside, and says no nan and no None."""
    found = Reader(text)
    assert found.open == []
    titles_of_curves = text.count("</title></path>")
    assert found.tags["html"] == found.tags["h1"] == found.tags["title"] - titles_of_curves == 1
    assert (found.tags["script"], found.tags["img"], found.tags["iframe"]) == (1, 0, 0)
    values = [value for name, value in found.attributes if name in ("href", "src", "xlink:href")]
    assert values == ["data:,"]
    assert re.findall(r"url\((?!#)|@import|https?:", text) == []
    ids = [value for name, value in found.attributes if name == "id"]
    assert len(ids) == len(set(ids))
    explained = {value for name, value in found.attributes if name == "popovertarget"}
    assert set(re.findall(r"url\(#([^)]*)\)", text)) | explained == set(ids)
    words = " ".join(found.text)
    assert not re.search(r"\b(nan|inf|None|Undefined)\b", words)
    assert not re.search(r"\bnan\b", text)
    return found


@pytest.mark.parametrize(
    "blow",
    [
        LUMPED,
        replace(LUMPED, stroke=cf.Stroke(offset=-0.3)),
        replace(LUMPED, stroke=cf.Stroke(offset=0.0)),
        replace(LUMPED, stroke=cf.Stroke(offset=0.75)),
        replace(LUMPED, cue=cf.LumpedCue(0.54, 0.006, 0.5), effects=(cf.TipShear(0.75),)),
        replace(LUMPED, tip=cf.Tip(friction=math.inf)),
        replace(LUMPED, tip=cf.Tip(friction=0.0)),
    ],
    ids=["lumped", "left", "head on", "miscue", "coupled", "no slip", "no friction"],
)
def test_pages_of_lumped_cues(blow: cf.Scene) -> None:
    words = " ".join(assert_sound(page("lumped.toml", blow)).text)
    assert "Mode shapes" not in words
    assert f"{math.degrees(cf.strike(blow).squirt):.2f}°" in words


def test_names_are_text_and_no_markup() -> None:
    text = page("<script>alert(1)</script> & co.toml", LUMPED, notes=["a < b", "ash (take --material)"])
    assert "<script>alert" not in text
    assert "&lt;script&gt;alert(1)&lt;/script&gt; &amp; co.toml" in text
    assert "a &lt; b</li>" in text
    assert_sound(text)


def test_ticks_are_round_numbers() -> None:
    assert [round_step(length) for length in (1.0, 6.0, 7.0, 0.0123, 5000.0)] == [0.2, 1.0, 2.0, 0.005, 1000.0]
    scale = Axis("x").scale_for([np.array([0.3, 2.7, np.nan])])
    assert (scale.low, scale.high, scale.step) == (0.0, 3.0, 0.5)
    assert [(tick.label, tick.at) for tick in scale.ticks(0, 60)] == [
        (f"{i / 2}", pytest.approx(10 * i)) for i in range(7)
    ]
    assert Axis("x").scale_for([np.zeros(3)])[:2] == (0.0, 1.0)


def box(outline: str) -> np.ndarray:
    """Left, right, top and bottom of a path."""
    x, y = np.array(re.findall(r"(-?[0-9.]+) (-?[0-9.]+)", outline), float).T
    return np.array([x.min(), x.max(), y.min(), y.max()])


def layered() -> cf.Scene:
    """A tip of leather on two layers, narrower than the shaft, and a mass on it."""
    plain = cf.usual_scene(scene("kim").shaft)
    layers = (cf.TipLayer(1e-3, 2e9), cf.TipLayer(2e-3, 1e9))  # from the ferrule up
    tip = replace(plain.leather, height=9e-3, layers=layers, diameter=10e-3)
    return replace(plain, effects=(tip, *plain.effects[1:], cf.PointMass(0.05, 0.01)))


@pytest.mark.parametrize(
    ("blow", "front"), [(scene("pool_low_deflection"), ()), (layered(), (6e-3, 2e-3, 1e-3))], ids=["bored", "layers"]
)
def test_every_piece_is_drawn_at_its_place(blow: cf.Scene, front: tuple[float, ...]) -> None:
    """The cue in millimetres of a hundredth: tip to the left, diameters enlarged about the axis, bores inside."""
    drawing, segments = cue_drawing(blow, "all of it"), blow.shaft.segments
    sizes = [(height, 10e-3, 0.0) for height in front]
    sizes += [(s.length, max(s.tip_diameter, s.butt_diameter), max(s.tip_bore, s.butt_bore)) for s in segments]
    ends = np.cumsum([0.0, *(length for length, *_ in sizes)])
    scale = WIDE / ends[-1]
    for piece, x, (length, wide, bore) in zip(drawing.pieces, ends[:-1], sizes, strict=True):
        along = [scale * x, scale * (x + length)]
        for outline, width in ((piece.outline, wide), (piece.bore, bore)):
            across = drawing.axis + scale * ACROSS * width / 2 * np.array([-1, 1])
            assert (outline == "") == (width == 0)
            assert not outline or box(outline) == pytest.approx([*along, *across], abs=0.02)
    at = scale * (0.2 + sum(front))  # behind the leather, as positions count
    assert {tick.label: tick.at for tick in drawing.ticks}["200"] == pytest.approx(at, abs=0.02)


def test_the_longest_cue_has_a_leather_tip_too() -> None:
    piece = cf.Segment(0.36e-3, 0.012, 0.012, cf.Material(12.6e9, 0.84e9, 700.0))
    longest = cf.usual_scene(cf.Cue((piece,) * 200, body_mass=0.45))
    assert len(cue_drawing(longest, "").pieces) == 201
