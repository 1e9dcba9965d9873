"""The report page: valid HTML, escaping, axes, drawing of the cue (regression)."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.files import today
from cuefem.files.defaults_report import Assumption
from cuefem.results.quantities import DASH
from cuefem.show.charts import WIDTH, Axis, round_step, spread_labels
from cuefem.show.drawings import DIAMETER_SCALE, cue_drawing

MESHES = Path(__file__).parents[2] / "meshes"
SCENES = MESHES.parent / "studies" / "scenes"
LUMPED = cf.Scene(cf.LumpedCue(0.54, 0.006), stroke=cf.Stroke(offset=0.3))


def scene(name: str) -> cf.Scene:
    loaded = cf.load(SCENES / f"{name}.toml")
    assert isinstance(loaded, cf.Scene)
    return loaded


def test_page_with_markup_in_name_is_escaped() -> None:
    text = cf.report(LUMPED, details=True).to_html(
        "<script>alert(1)</script> & co.toml", [Assumption("", "a < b"), Assumption("", "ash (take --material)")]
    )
    assert "<script>alert" not in text
    assert "&lt;script&gt;alert(1)&lt;/script&gt; &amp; co.toml" in text
    assert "a &lt; b</li>" in text


def test_axis_ticks_are_round_numbers() -> None:
    assert [round_step(length) for length in (1.0, 6.0, 7.0, 0.0123, 5000.0)] == [0.2, 1.0, 2.0, 0.005, 1000.0]
    scale = Axis("x").scale_for([np.array([0.3, 2.7, np.nan])])
    assert (scale.low, scale.high, scale.step) == (0.0, 3.0, 0.5)
    assert [(tick.label, tick.at) for tick in scale.ticks(0, 60)] == [
        (f"{i / 2}", pytest.approx(10 * i)) for i in range(7)
    ]
    assert Axis("x").scale_for([np.zeros(3)])[:2] == (0.0, 1.0)
    assert Axis("x", from_zero=False).scale_for([np.full(3, 5.0)])[:2] == pytest.approx((4.4, 5.6))


def box(outline: str) -> np.ndarray:
    """Left, right, top and bottom of a path."""
    x, y = np.array(re.findall(r"(-?[0-9.]+) (-?[0-9.]+)", outline), float).T
    return np.array([x.min(), x.max(), y.min(), y.max()])


def layered() -> cf.Scene:
    """A tip of leather on two layers, narrower than the shaft, and a mass on it."""
    plain = cf.usual_scene(scene("kim").shaft)
    layers = (cf.TipLayer(1e-3, 2e9), cf.TipLayer(2e-3, 1e9))  # from the ferrule up
    tip = replace(plain.leather_tip, height=9e-3, layers=layers, diameter=10e-3)
    return replace(plain, effects=(tip, *plain.effects[1:], cf.PointMass(position=0.05, mass=0.01)))


@pytest.mark.parametrize(
    ("stroke", "front"), [(scene("pool_low_deflection"), ()), (layered(), (6e-3, 2e-3, 1e-3))], ids=["bored", "layers"]
)
def test_cue_drawing_has_segments_at_their_positions(stroke: cf.Scene, front: tuple[float, ...]) -> None:
    """To 0.02 units: tip on the left, diameters enlarged about the axis, bores inside."""
    drawing, segments = cue_drawing(stroke, "whole cue"), stroke.shaft.segments
    sizes = [(height, 10e-3, 0.0) for height in front]
    sizes += [(s.length, max(s.tip_diameter, s.butt_diameter), max(s.tip_bore, s.butt_bore)) for s in segments]
    ends = np.cumsum([0.0, *(length for length, *_ in sizes)])
    scale = WIDTH / ends[-1]
    for piece, x, (length, wide, bore) in zip(drawing.pieces, ends[:-1], sizes, strict=True):
        along = [scale * x, scale * (x + length)]
        for outline, width in ((piece.outline, wide), (piece.bore, bore)):
            across = drawing.axis + scale * DIAMETER_SCALE * width / 2 * np.array([-1, 1])
            assert (outline == "") == (width == 0)
            assert not outline or box(outline) == pytest.approx([*along, *across], abs=0.02)
    at = scale * (0.2 + sum(front))  # positions are from behind the leather
    assert {tick.label: tick.at for tick in drawing.ticks}["200"] == pytest.approx(at, abs=0.02)


@pytest.mark.parametrize(
    ("positions", "moved"),
    [
        ([0, 50, 100], [0, 50, 100]),
        ([40, 41, 42], [40, 54, 68]),
        ([98, 99, 100], [72, 86, 100]),
        ([-5, 0, 99, 100], [0, 14, 86, 100]),
    ],
)
def test_labels_of_lines_keep_their_gap(positions: list[float], moved: list[float]) -> None:
    assert spread_labels(positions, 0, 100) == moved


def test_squirt_curves_end_at_the_miscue_limit() -> None:
    """Friction 0.2: offsets from 0.2 to 0.3 on are miscues of the coupled strike."""
    slippery = replace(LUMPED, tip=cf.Tip(friction=0.2))
    curves = cf.squirt_curve(slippery, (0.1, 0.2, 0.3, 0.4, 0.5))
    regimes = curves.models["coupled, this cue"]["regime"]
    last = curves.offsets[regimes.index("miscue") - 1]
    drawn = [*curves.charts(), *curves.more_charts()[0].charts]
    for each in drawn:
        for name, _, outline in each.curves:
            limit = each.x_scale.position(last, each.box[0], each.box[2])
            assert name == "plain maple" or box(outline)[1] <= limit + 0.01, (each.title, name)


def test_pivot_chart_ends_about_a_cue_length_from_the_tip() -> None:
    """A light end mass has its pivot point 1.05 m from the tip, a lighter one beyond the cue."""
    cues = [cf.LumpedCue(0.54, end_mass) for end_mass in (0.002, 0.0005)]
    far, beyond = (cf.squirt_curve(replace(LUMPED, cue=cue), (0.1, 0.3)).charts()[1].y_scale.high for cue in cues)
    assert 1050 < far < beyond < 1700


def test_squirt_curve_head_on_has_no_pivot_length() -> None:
    shown = cf.squirt_curve(LUMPED, (-0.3, 0.0, 0.3))
    left, head_on, right = shown.models["coupled, this cue"]["pivot_length"]
    assert (
        left == pytest.approx(right) == pytest.approx(shown.models["two-part, this cue"]["pivot_length"][2], rel=1e-3)
    )
    assert math.isnan(head_on)
    assert shown.table().rows[1][1:3] == ("0.00°", DASH)


def test_date_of_a_page_is_that_of_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1795737600")
    assert today() == "2026-11-27"
