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
from cuefem.report.drawings import ACROSS, cue_drawing, strike_drawing
from cuefem.report.report_page import page
from cuefem.results.convergence import resolve

MESHES = Path(__file__).parents[2] / "meshes"
SCENES = MESHES.parent / "studies" / "scenes"
VOID = {"meta", "link", "br"}

LUMPED = cf.Scene(cf.LumpedCue(0.54, 0.006), stroke=cf.Stroke(offset=0.3))


def scene(name: str) -> cf.Scene:
    found = cf.load(SCENES / f"{name}.toml")
    assert isinstance(found, cf.Scene)
    return found


@pytest.fixture(scope="module")
def pool() -> str:
    return page("pool.toml", scene("pool_low_deflection"))


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


@pytest.mark.heavy
def test_a_page_is_whole_and_self_contained(pool: str) -> None:
    found = assert_sound(pool)
    words = " ".join(found.text)
    for effect in ("TipDome (radius 9.5 mm)", "TipShear (ratio 0.75)", "Support (position 203.2 mm"):
        assert effect in words
    assert "How it rings" in words
    assert "shaded: " not in words
    assert len(pool.encode()) < 200_000


@pytest.mark.heavy
def test_the_pages_numbers_are_the_librarys(pool: str) -> None:
    blow = scene("pool_low_deflection")
    outcome = resolve(blow, 1e-2)
    words = " ".join(" ".join(Reader(pool).text).split())
    assert f"{math.degrees(outcome.squirt):.3f}°" in words
    assert f"{outcome.ball_speed:.3f} m/s" in words
    assert f"{1e3 * outcome.duration:.3f} ms" in words
    assert f"{outcome.error:.1e}" in words
    assert f"have an estimated error of {100.0 * outcome.error:.2g} %; 1 % was asked for." in words
    for frequency in cf.modes(blow.cue, 5, effects=blow.cue_effects).frequencies:
        assert (f"{frequency:.1f} Hz" if frequency < 1e3 else f"{frequency / 1e3:.2f} kHz") in words
    parts = [float(part) for part in re.findall(r'style="width:([0-9.]+)%"', pool)]
    assert sum(parts) == pytest.approx(100, abs=0.01)
    assert f"{100 * outcome.energy['ball translation'] / outcome.energy['initial']:.2f} %" in words


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
    assert "How it rings" not in words
    assert "How exact" not in words
    assert "estimated error" not in words
    assert f"{math.degrees(cf.strike(blow).squirt):.2f}°" in words


def test_names_are_text_and_no_markup() -> None:
    text = page("<script>alert(1)</script> & co.toml", LUMPED, notes=["a < b", "ash (take --material)"])
    assert "<script>alert" not in text
    assert "&lt;script&gt;alert(1)&lt;/script&gt; &amp; co.toml" in text
    assert 'assumed: a &lt; b; ash (take <span class="option">--material)</span></p>' in text
    assert_sound(text)


def test_ticks_are_round_numbers() -> None:
    assert [round_step(length) for length in (1.0, 6.0, 7.0, 0.0123, 5000.0)] == [0.2, 1.0, 2.0, 0.005, 1000.0]
    scale = Axis("x").over([np.array([0.3, 2.7, np.nan])])
    assert (scale.low, scale.high, scale.step) == (0.0, 3.0, 0.5)
    assert [(tick.label, tick.at) for tick in scale.ticks(0, 60)] == [
        (f"{i / 2}", pytest.approx(10 * i)) for i in range(7)
    ]
    assert Axis("x").over([np.zeros(3)])[:2] == (0.0, 1.0)


def test_the_cue_is_drawn_to_scale() -> None:
    blow = scene("pool_low_deflection")
    drawing = cue_drawing(blow)
    length, last = blow.cue.length, blow.cue.segments[-1]

    def extent(outline: str) -> tuple[float, float]:
        points = np.array(re.findall(r"(-?[0-9.]+) (-?[0-9.]+)", outline), float)
        return float(np.ptp(points[:, 0])), float(np.ptp(points[:, 1]))

    along, high = extent(drawing.pieces[-1].outline)
    assert high / along == pytest.approx(ACROSS * last.butt_diameter / last.length, rel=1e-3)
    assert along == pytest.approx((WIDE - 20) * last.length / length, abs=0.02)
    assert len(drawing.pieces) == len(blow.cue.segments)
    assert [sign.label for sign in drawing.signs] == ["Support"]
    assert drawing.signs[0].at == pytest.approx(10 + (WIDE - 20) * 0.2032 / length)
    assert [bool(piece.bore) for piece in drawing.pieces] == [False, True, True, False, False, False]


def test_a_leather_tip_is_drawn_in_front_of_the_cue() -> None:
    blow = cf.usual_scene(scene("kim").shaft)
    blow = replace(blow, effects=(*blow.effects, cf.PointMass(0.05, 0.01)))
    drawing = cue_drawing(blow)
    assert [piece.material for piece in drawing.pieces] == ["m-leather", "m-other"]
    assert [sign.label for sign in drawing.signs] == ["PointMass"]
    assert drawing.signs[0].at == pytest.approx(10 + (WIDE - 20) * 0.056 / 0.706)
    piece = cf.Segment(0.36e-3, 0.012, 0.012, cf.Material(12.6e9, 0.84e9, 700.0))
    longest = cf.usual_scene(cf.Cue((piece,) * 200, body_mass=0.45))
    assert len(cue_drawing(longest).pieces) == 201
    for each in (blow, longest):
        assert strike_drawing(each, 0.03).pieces[0][1] == "m-leather"


def test_a_tip_is_drawn_with_its_layers_and_as_wide_as_it_is() -> None:
    plain = cf.usual_scene(scene("kim").shaft)
    layers = (cf.TipLayer(1e-3, 2e9), cf.TipLayer(2e-3, 1e9))  # from the ferrule up
    tip = replace(plain.leather, height=9e-3, layers=layers, diameter=10e-3)
    drawing = cue_drawing(replace(plain, effects=(tip,)))
    boxes = [np.array(re.findall(r"(-?[0-9.]+) (-?[0-9.]+)", piece.outline), float) for piece in drawing.pieces]
    scale = (WIDE - 20) / (plain.cue.length + tip.height)
    assert [np.ptp(box[:, 0]) / scale for box in boxes[:3]] == pytest.approx([6e-3, 2e-3, 1e-3], abs=5e-5)
    assert [np.ptp(box[:, 1]) / scale / ACROSS for box in boxes[:3]] == pytest.approx([10e-3] * 3, rel=1e-3)


def test_the_blow_is_drawn_true() -> None:
    blow = scene("pool_low_deflection")
    made = strike_drawing(blow, 0.03)
    x, y, radius = made.ball
    away = math.hypot(made.contact[0] - x, made.contact[1] - y)
    assert away == pytest.approx(radius, rel=1e-9)  # the contact lies on the ball
    assert (y - made.contact[1]) / radius == pytest.approx(0.375, rel=1e-9)  # b/R above its centre
    fall = (made.path_end[1] - y) / (x - made.path_end[0])
    assert fall == pytest.approx(math.tan(0.03), rel=1e-9)
