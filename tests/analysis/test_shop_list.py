"""The list of a shop's shafts: against single comparisons, and marks (properties); its files are golden ones."""

import pytest

import cuefem as cf
from cuefem.results.closed_forms import pivot_length

FRONTS = {"s0": 0.495, "s1": 0.505, "s2": 0.470}  # in


def scene_of(front: float) -> cf.Scene:
    """A shaft of a shop."""
    tip, taper, end = (0.0254 * width for width in (front, front + 0.015, 0.845))
    maple = cf.material("hard maple")
    cone = cf.Segment(0.3556, tip, taper, maple), cf.Segment(0.381, taper, end, maple)
    return cf.usual_scene(cf.Cue(cone, body_mass=0.425))


@pytest.mark.heavy
def test_list_equals_comparisons() -> None:
    """The reference is the first shaft, and each difference that of `compare`."""
    scenes = {name: scene_of(front) for name, front in FRONTS.items()}
    rows = cf.shop_list(scenes).shafts
    assert [row["name"] for row in rows] == ["s2", "s0", "s1"]
    for row in rows:
        squirt = cf.strike(scenes[row["name"]]).squirt
        assert row["squirt"] == pytest.approx(squirt, rel=1e-9)
        assert row["pivot_length"] == pytest.approx(pivot_length(scenes[row["name"]], squirt), rel=1e-9)
    single = cf.compare({name: scenes[name] for name in ("s0", "s2")}).differences["s2"]["squirt"]
    assert rows[0]["difference"] == pytest.approx(single["difference"], rel=1e-9)
    assert rows[0]["error"] == pytest.approx(single["error"], rel=0.05)


@pytest.mark.heavy
def test_mark_of_an_assumed_inside_is_of_the_named_cue_alone() -> None:
    """Head, first screen and list mark "carbon", with another ferrule too, and not a maker's own carbon.csv."""
    own, named = scene_of(0.495).cue, cf.load("carbon")
    changed = cf.load("carbon", ferrule="10 mm melamine")
    for cue, mark in ((own, "carbon"), (named, "carbon†"), (changed, "carbon†")):
        scenes = {"carbon": cf.usual_scene(cue), "plain maple": cf.usual_scene(cf.load("plain maple"))}
        compared = cf.compare(scenes)
        assert compared.table().head[1:3] == (mark, "plain maple")
        assert {row[0] for row in cf.shop_list(scenes).tables()[0].rows} == {mark, "plain maple"}
        assert f"<span>{mark}</span>" in compared.to_html()
