"""Sections of closed surfaces against exact polygons, and the loaded shafts (verification)."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.cue.materials import material
from cuefem.files.defaults_report import drawing_assumptions
from cuefem.files.errors import InputError
from cuefem.files.surface_sections import TOLERANCE, aligned_surface, section_shaft
from cuefem.files.warnings_of_drawings import drawing_warnings
from tests.helpers.surfaces import outline_of, revolve, two_bodies, write_surface

MAPLE = material("hard maple")
CYLINDER = cf.Cue((cf.Segment(0.5, 0.013, 0.013, MAPLE),))
KIM = cf.Cue((cf.Segment(0.7, 0.012, 0.021, MAPLE),))
HOLLOW = cf.Cue(
    (
        cf.Segment(0.146, 0.01185, 0.01205, MAPLE, 0.006, 0.006),
        cf.Segment(0.1842, 0.01205, 0.01245, MAPLE),
        cf.Segment(0.1, 0.01245, 0.0143, MAPLE),
        cf.Segment(0.3064, 0.0143, 0.0215, MAPLE),
    )
)
STEPPED = cf.Cue((cf.Segment(0.3, 0.012, 0.013, MAPLE), cf.Segment(0.4, 0.018, 0.02, MAPLE)))
CUES = {"cylinder": CYLINDER, "kim": KIM, "hollow": HOLLOW, "stepped": STEPPED}


def polygon(radius: float, facets: int) -> tuple[float, float]:
    """Area and second moment of a regular polygon of this outer radius."""
    turn = 2 * np.pi / facets
    area = facets / 2 * np.sin(turn) * radius**2
    return area, area * radius**2 * (2 + np.cos(turn)) / 12


@pytest.mark.parametrize("facets", [7, 64])
@pytest.mark.parametrize("name", CUES)
def test_slices_equal_exact_polygons(name: str, facets: int) -> None:
    cue = CUES[name]
    body = aligned_surface(*revolve(outline_of(cue), facets))
    assert body.flats == pytest.approx(np.unique(cue.nodes)[[0, *body_jumps(cue), -1]], abs=1e-12)
    for x in (0.0, 0.01, 0.1, 0.1459, 0.1461, 0.2999, 0.3001, 0.49):
        i = np.searchsorted(cue.nodes, x, side="right") - 1
        s, t = cue.segments[i], (x - cue.nodes[i]) / cue.segments[i].length
        outer, bore = (
            polygon((getattr(s, f"tip_{n}") * (1 - t) + getattr(s, f"butt_{n}") * t) / 2, facets)
            for n in ("diameter", "bore")
        )
        cut = body.cut(x)
        assert cut.area == pytest.approx(outer[0] - bore[0], rel=1e-10)
        assert cut.moments[:2] == pytest.approx([outer[1] - bore[1]] * 2, rel=1e-10)
        assert cut.moments[2] == pytest.approx(0, abs=1e-10 * outer[1])
        assert cut.outlines == (1, int(bore[0] > 0))
        aside = replace(body, points=body.points + np.array([0, 1e-3, -2e-3])).cut(x)
        assert aside.centre == pytest.approx([1e-3, -2e-3], rel=1e-9)
        assert [aside.area, *aside.moments] == pytest.approx([cut.area, *cut.moments], abs=1e-9 * outer[1])


def body_jumps(cue: cf.Cue) -> list[int]:
    """Nodes inside the cue with a face across the axis."""
    return [
        i
        for i, (a, b) in enumerate(pairwise(cue.segments), start=1)
        if (a.butt_diameter, a.butt_bore) != (b.tip_diameter, b.tip_bore)
    ]


@pytest.mark.parametrize("name", CUES)
def test_surface_of_conical_pieces_recovers_the_drawing(name: str) -> None:
    """The facets' corners lie on circles, which are the sections."""
    cue, facets = CUES[name], 64
    result = section_shaft(aligned_surface(*revolve(outline_of(cue), facets)))
    assert [p.length for p in result.pieces] == pytest.approx([s.length for s in cue.segments], rel=1e-9)
    for piece, segment in zip(result.pieces, cue.segments, strict=True):
        assert piece.outer == pytest.approx([segment.tip_diameter, segment.butt_diameter], rel=2e-6)
        assert piece.bore == pytest.approx([segment.tip_bore, segment.butt_bore], rel=2e-5)
    assert result.facets == pytest.approx(0, abs=1e-6 * result.widest)


def test_curved_profile_is_within_the_tolerance() -> None:
    """Straight segments approximate a curved taper within the tolerance."""
    x = np.linspace(0, 0.7, 141)
    radius = 0.006 + 0.005 * (x / 0.7) ** 3
    result = section_shaft(aligned_surface(*revolve([(0, 0), *zip(x, radius, strict=True), (0.7, 0)], 48)))
    ends = np.concatenate([[0.0], np.cumsum([p.length for p in result.pieces])])
    outer = np.array([result.pieces[0].outer[0], *(p.outer[1] for p in result.pieces)])
    off = np.abs(np.interp(x, ends, outer) - 2 * radius).max()
    assert 8 < len(result.pieces) < 100
    assert 0.2 * TOLERANCE * result.widest < off <= TOLERANCE * result.widest


@pytest.mark.parametrize("seed", range(2))
def test_surface_moved_and_rotated_gives_the_same_shaft(seed: int) -> None:
    rng = np.random.default_rng(seed)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    points, faces = revolve(outline_of(HOLLOW), 24)
    straight = section_shaft(aligned_surface(points, faces))
    turned = section_shaft(aligned_surface(points @ turn.T + rng.normal(size=3), faces if seed else faces[:, ::-1]))
    for piece, other in zip(turned.pieces, straight.pieces, strict=True):
        assert np.hstack(piece) == pytest.approx(np.hstack(other), rel=1e-6, abs=1e-12)


@pytest.mark.parametrize("tilt", [3e-4, 7e-4, 9.9e-4])
def test_surface_a_little_off_its_axis_gives_the_same_shaft(tilt: float) -> None:
    """Up to a milliradian: a straight shaft whose axis is replaced by x must not look bent."""
    points, faces = revolve(outline_of(KIM), 24)
    (piece,) = section_shaft(aligned_surface(points + tilt * points[:, [1, 0, 2]] * (-1, 1, 0), faces)).pieces
    assert np.hstack(piece) == pytest.approx([0.7, 0.012, 0.021, 0, 0], rel=1e-5)


def test_fin_without_thickness_is_no_outline() -> None:
    """Two triangles back to back, as CAD programs leave them inside a body."""
    points, faces = revolve(outline_of(KIM), 24)
    fin = np.array([[0.1, 0, 0], [0.3, 1e-3, 0], [0.3, 0, 1e-3]])
    first, second, third = len(points) + np.arange(3)
    both = np.array([[first, second, third], [first, third, second]])
    body = aligned_surface(np.concatenate([points, fin]), np.concatenate([faces, both]))
    assert body.cut(0.2).outlines == (1, 0)


def test_polygon_faces_are_triangulated(tmp_path: Path) -> None:
    turn = 2 * np.pi * np.arange(12) / 12
    corners = [f"v {x} {6 * np.cos(t)} {6 * np.sin(t)}" for x in (0, 500) for t in turn]
    sides = [f"f {i + 1} {(i + 1) % 12 + 1} {12 + (i + 1) % 12 + 1} {12 + i + 1}" for i in range(12)]
    caps = [f"f 1 {i + 2} {i + 1}" for i in range(1, 11)] + [f"f 13 {12 + i + 1} {12 + i + 2}" for i in range(1, 11)]
    path = tmp_path / "bar.obj"
    path.write_text("\n".join([*corners, *sides, *caps]) + "\n")
    (segment,) = cf.load(path).segments
    assert segment.tip_diameter == pytest.approx(0.012, rel=1e-6)


@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_surface_length_unit_and_uppercase_extension_are_read(tmp_path: Path) -> None:
    """Also by a scene file."""
    points, faces = revolve(outline_of(KIM), 16)
    inches = write_surface(tmp_path / "inches.stl", points, faces, unit=0.0254)
    assert cf.load(inches, length_unit="in").length == pytest.approx(0.7, rel=1e-6)
    loaded, path = cf.load(inches), inches.rename(tmp_path / "INCHES.STL")
    assert loaded.length == pytest.approx(0.7 / 25.4, rel=1e-6)
    assert cf.load(path, material="ash").segments[0].material == material("ash")
    (tmp_path / "SCENE.TOML").write_text(f"game = 'kim'\ncue = '{path.name}'\n")
    assert cf.load(tmp_path / "SCENE.TOML").cue == loaded
    texts = [each.text for each in drawing_assumptions(path, loaded, {"body_mass": 0.4})]
    assert [text.split(" ")[0] for text in texts[:5]] == ["lengths", "1", "facets", "the", "material"]


@pytest.mark.parametrize("facets", [6, 8, 12])
def test_surface_of_few_facets_on_a_circle_is_the_turned_shape(facets: int, tmp_path: Path) -> None:
    """A cone of 12.75 to 21.5 mm: its exact mass, where facets of equal area were 17, 10 and 4.5 % lighter."""
    outline = [(0, 0), (0, 0.006375), (0.7366, 0.01075), (0.7366, 0)]
    cue = cf.load(write_surface(tmp_path / "shaft.stl", *revolve(outline, facets), binary=True))
    exact = cf.Cue((cf.Segment(0.7366, 0.01275, 0.0215, cue.segments[0].material),))
    assert cue.mass == pytest.approx(exact.mass, rel=1e-6)
    assert drawing_warnings(tmp_path / "shaft.stl") == []


def faceted(folder: Path, facets: int, bow: float = 0.0) -> Path:
    """A cone whose corners lie 1 % inside and outside a circle, alternately, along a bow of this rise, m."""
    x = np.linspace(0, 0.7366, 21)
    points, triangles = revolve([(0, 0), *zip(x, 0.006375 + 0.00594 * x, strict=True), (0.7366, 0)], facets)
    angle = np.arctan2(points[:, 2], points[:, 1])
    points[:, 1:] *= 1 + 0.01 * np.cos(facets / 2 * angle)[:, None]
    points[:, 1] += bow * (2 * points[:, 0] / 0.7366 - 1) ** 2
    return write_surface(folder / "shaft.stl", points, triangles, binary=True)


@pytest.mark.parametrize("bow", [0.0, 3e-4])
def test_surface_of_facets_off_a_circle_warns(bow: float, tmp_path: Path) -> None:
    """Also along a bow that is straight enough."""
    with pytest.warns(cf.PlausibilityWarning, match=r"facets are coarse: corners lie up to \d.\d % of the diameter"):
        cf.load(faceted(tmp_path, 12, bow))


def test_surface_of_six_facets_off_a_circle_is_rejected(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="must have at least 8 facets around it, or all corners on one circle"):
        cf.load(faceted(tmp_path, 6))


def test_surface_with_a_bumper_at_the_butt_begins_at_the_tip(tmp_path: Path) -> None:
    outline = [(0, 0), (0, 0.0065), (1.44, 0.015), (1.44, 0.006), (1.47, 0.006), (1.47, 0)]
    cue = cf.load(write_surface(tmp_path / "cue.stl", *revolve(outline, 32), binary=True))
    assert cue.segments[0].tip_diameter == pytest.approx(0.013, rel=1e-6)


@pytest.mark.parametrize("gap", [1e-5, 5e-4])
@pytest.mark.filterwarnings("ignore::cuefem.PlausibilityWarning")
def test_gap_between_two_bodies_is_bridged_and_warned(gap: float, tmp_path: Path) -> None:
    path = write_surface(tmp_path / "bodies.obj", *two_bodies(gap))
    cue = cf.load(path)
    assert cue.length == pytest.approx(0.7366, rel=1e-6)
    widths = [width for segment in cue.segments for width in (segment.tip_diameter, segment.butt_diameter)]
    exact = np.interp([0, 0.031, 0.031, 0.7366], [0, 0.7366], [0.01275, 0.0215])
    assert widths == pytest.approx(exact, rel=gap / 0.03)
    (line,) = drawing_warnings(path)
    assert "read as one" in line
