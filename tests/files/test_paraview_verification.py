"""ParaView files: modes and motion equal the library (verification)."""

import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

import cuefem as cf
from cuefem.contact.motion_history import motion
from cuefem.files import InputError
from cuefem.files.paraview import RING_POINTS, ball_surface, displacements, shaft_surface

MAPLE = cf.Material(12.6e9, 0.84e9, 782.3284453057836)
CUE = cf.Cue((cf.Segment(0.025, 0.0125, 0.0128, MAPLE), cf.Segment(0.7, 0.012, 0.021, MAPLE)), 0.42)
SCENE = cf.Scene(CUE, cf.Ball(0.17, 0.028575), cf.Tip(0.75, 0.7, 1e-3), cf.Stroke(2.0, 0.3))


def area_and_volume(points: np.ndarray, cells: dict[str, np.ndarray]) -> tuple[float, float]:
    triangles = [
        cells[kind][:, corners] for kind in cells for corners in ([0, 1, 2], [0, 2, 3])[: len(cells[kind][0]) - 2]
    ]
    a, b, c = points[np.concatenate(triangles)].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2, np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def test_shaft_surface_is_closed_and_oriented_outwards() -> None:
    surface = shaft_surface(CUE)
    assert np.diff(np.unique(surface.x)).max() <= 0.01
    _, volume = area_and_volume(surface.points, dict(surface.cells))
    frusta = [(0.025, 0.0125, 0.0128), (0.7, 0.012, 0.021)]
    prism = RING_POINTS / (2 * np.pi) * np.sin(2 * np.pi / RING_POINTS)  # area of the polygon over that of the circle
    assert prism == pytest.approx(1, abs=0.02)
    expected = prism * np.pi / 12 * sum(length * (d**2 + d * D + D**2) for length, d, D in frusta)
    assert volume == pytest.approx(expected, rel=1e-12)
    edges = np.concatenate([np.stack([c, np.roll(c, -1, axis=1)], axis=-1).reshape(-1, 2) for _, c in surface.cells])
    forward, back = (set(map(tuple, pairs)) for pairs in (edges, edges[:, ::-1]))
    assert forward == back
    assert len(forward) == len(edges)


def test_ball_surface_is_a_sphere() -> None:
    surface = ball_surface(0.03)
    np.testing.assert_allclose(np.linalg.norm(surface.points, axis=1), 0.03, rtol=1e-14)
    area, volume = area_and_volume(surface.points, dict(surface.cells))
    assert area == pytest.approx(4 * np.pi * 0.03**2, rel=0.01)
    assert volume == pytest.approx(4 / 3 * np.pi * 0.03**3, rel=0.02)


def test_displacements_of_rigid_rotation_preserve_distances() -> None:
    """A rigid motion of the beam is one of its surface, to first order, which tests the sign of the rotation."""
    surface = shaft_surface(CUE)
    result = cf.modes(CUE)
    for vector in result.rigid_vectors.T:
        w, theta = result.system.interpolate(vector[:, None], surface.x)
        displaced = displacements(surface, w[0], theta[0])
        ends = surface.points[:-1:7], surface.points[1::7][: len(surface.points[:-1:7])]
        u = displaced[:-1:7], displaced[1::7][: len(ends[0])]
        np.testing.assert_allclose(np.sum((ends[1] - ends[0]) * (u[1] - u[0]), axis=1), 0, atol=1e-15)


def test_save_motion_modes_equal_the_library(tmp_path: Path) -> None:
    cf.save_motion(SCENE, tmp_path / "seen", count=4, frames=2)
    read = meshio.read(tmp_path / "seen/modes.vtu")
    result = cf.modes(CUE, 4)
    shapes, turns = result.shape(read.point_data["x"])
    for k, tone in enumerate(result.frequencies):
        displaced = read.point_data[f"mode_{k + 1}_{tone:.1f}_Hz"]
        np.testing.assert_array_equal(displaced[:, 1], shapes[k])
        np.testing.assert_array_equal(displaced[:, 0], turns[k] * read.points[:, 1])
        np.testing.assert_array_equal(read.point_data[f"mode_{k + 1}_theta"], turns[k])
    np.testing.assert_array_equal(read.points[:, 0], -read.point_data["x"])


def test_save_motion_strike_equals_the_library(tmp_path: Path) -> None:
    scale, folder = 20.0, tmp_path / "seen"
    cf.save_motion(SCENE, folder, frames=5, scale=scale)
    times = np.linspace(0, 3 * motion(SCENE, [0.0]).duration, 5)
    result = motion(SCENE, times)
    shaft = shaft_surface(CUE)
    w, theta = result.deflection(shaft.x)
    collection = ET.parse(folder / "strike.pvd").getroot()
    sets = [entry.attrib for entry in collection.iter("DataSet")]
    assert collection.get("type") == "Collection"
    assert sorted(entry["file"] for entry in sets) == sorted(f"strike/{path.name}" for path in folder.glob("strike/*"))
    assert [float(entry["timestep"]) for entry in sets] == np.repeat(times, 2).tolist()
    assert [entry["part"] for entry in sets] == ["0", "1"] * 5
    for i in range(5):
        read = meshio.read(folder / sets[2 * i]["file"])
        np.testing.assert_array_equal(read.point_data["w"], w[i])
        np.testing.assert_array_equal(read.point_data["theta"], theta[i])
        np.testing.assert_array_equal(
            read.point_data["displacement"], displacements(shaft, w[i], theta[i], along=result.axial[i])
        )
        exaggerated = displacements(shaft, scale * w[i], scale * theta[i], along=result.axial[i])
        np.testing.assert_array_equal(read.points, shaft.points + exaggerated)
        ball = meshio.read(folder / sets[2 * i + 1]["file"])
        np.testing.assert_allclose(ball.points.reshape(-1, 3)[36:-36].mean(axis=0), [*result.centre[i], 0], atol=1e-15)
        np.testing.assert_array_equal(ball.points[:, 2], ball_surface(SCENE.ball.radius).points[:, 2])
        assert set(map(tuple, ball.point_data["force"])) == {(*result.force[i], 0)}
    history = cf.strike(SCENE).history(times[1])  # within the contact
    s, c = 0.3, np.sqrt(1 - 0.09)
    expected = [s * history["force_t"] + c * history["force_n"], c * history["force_t"] - s * history["force_n"]]
    np.testing.assert_allclose(result.force[1], expected, rtol=1e-12)
    np.testing.assert_array_equal(result.force[2:], 0)


def test_save_motion_with_effects_ends_at_until(tmp_path: Path) -> None:
    scene = replace(SCENE, effects=(cf.TipDome(0.0095), cf.Support(0.25, stiffness=1e4)))
    cf.save_motion(scene, tmp_path / "seen", frames=2, until=4e-3)
    read = meshio.read(tmp_path / "seen/modes.vtu")
    tones = cf.modes(CUE, 6, effects=(cf.Support(0.25, stiffness=1e4),)).frequencies
    assert {f"mode_{k}_{tone:.1f}_Hz" for k, tone in enumerate(tones, start=1)} <= {*read.point_data}
    collection = ET.parse(tmp_path / "seen/strike.pvd").getroot()
    assert [float(entry.attrib["timestep"]) for entry in collection.iter("DataSet")] == [0, 0, 0.004, 0.004]


def test_save_motion_failure_leaves_no_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("cuefem.files.paraview.save_pvd", full)
    with pytest.raises(InputError, match="seen: cannot be written: No space left on device"):
        cf.save_motion(SCENE, tmp_path / "seen", frames=2)
    assert list(tmp_path.iterdir()) == []
