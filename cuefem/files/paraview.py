"""Modes of a cue and motion of a strike for ParaView: .vtu meshes, and a .pvd file with their times.

X points along the stroke of the drawn surface, its origin at the tip; Y is transverse, Z up. A point at height y in the
section moves by (u + theta y, w, 0): small rotations, as in the beam.
"""

from __future__ import annotations

import math
import os
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import meshio
import numpy as np

from cuefem.beam.modes import Modes, modes
from cuefem.contact.motion_history import Motion, motion
from cuefem.cue import Array, Cue
from cuefem.files import check_new_folder, write_folder_atomically
from cuefem.scene import Scene

RING_POINTS = 24  # points of a ring
RING_SPACING = 0.01  # m between rings, at most
MAX_FRAMES = 10_000


def save_motion(
    scene: Scene,
    folder: str | os.PathLike[str],
    *,
    frames: int = 61,
    until: float | None = None,
    scale: float = 1.0,
    count: int = 6,
) -> None:
    """Save the mode shapes of a cue and its motion during a strike as a folder for ParaView.

    Parameters
    ----------
    scene : Scene
        A level stroke of a cue of segments.
    folder : str or path
        The folder to create; it must not exist.
    frames : int, optional
        Number of frames of the strike, 2 to 10,000.
    until : float, optional
        Time of the last frame, s after first contact; by default 3 contact times.
    scale : float, optional
        Magnification of the drawn bending. Point data contain the true displacement.
    count : int, optional
        Number of bending modes.

    Raises
    ------
    InputError
        If the folder exists or cannot be written.
    ValueError
        For a lumped or a raised cue (see `motion`), and for frames, until or scale out of bounds.

    Notes
    -----
    ``modes.vtu`` contains the shaft's surface with a displacement, such as ``mode_1_95.0_Hz``, and a rotation
    ``mode_1_theta`` for each mode, mass-normalised; ``strike.pvd`` lists a shaft and a ball for each frame, with the
    force on the ball, N, at its points. X points along the stroke with its origin at the tip, Y is transverse, Z up;
    lengths in m.

    Examples
    --------
    >>> import cuefem as cf
    >>> import pathlib, tempfile
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.74, 0.012, 0.0215, wood),), body_mass=0.42)
    >>> scene = cf.Scene(cue, stroke=cf.Stroke(speed=2.0, offset=0.3))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     cf.save_motion(scene, pathlib.Path(folder) / "strike", frames=2)
    ...     sorted(path.name for path in pathlib.Path(folder, "strike").iterdir())
    ['modes.vtu', 'strike', 'strike.pvd']
    """
    folder = Path(folder)
    check_new_folder(folder)
    for name, value, holds, bounds in (
        ("frames", frames, isinstance(frames, int) and 2 <= frames <= MAX_FRAMES, f"an integer in [2, {MAX_FRAMES}]"),
        ("until", until, until is None or 0 < until < math.inf, "in (0, inf) s"),
        ("scale", scale, math.isfinite(scale), "finite"),
    ):
        if not holds:
            raise ValueError(f"save_motion: {name} must be {bounds}; got {value}")
    last = 3 * motion(scene, [0.0]).duration if until is None else until
    moving = motion(scene, np.linspace(0, last, frames))
    cue, bending = scene.shaft, modes(scene.shaft, count, effects=scene.cue_effects)

    def write(new: Path) -> None:
        save_modes(new / "modes.vtu", cue, bending)
        save_strike(new, scene, moving, scale=scale)

    write_folder_atomically(folder, write)


class ShaftSurface(NamedTuple):
    """Points (n, 3), m, and cells of a surface; x: distance of a shaft's points from the tip, m."""

    points: Array
    cells: list[tuple[str, Any]]
    x: Array


def shaft_surface(cue: Cue) -> ShaftSurface:
    """The outer surface of a cue: rings along every segment, two at a step in diameter, and a lid at each end."""
    stations, radii = [], []
    for start, segment in zip(cue.nodes[:-1], cue.segments, strict=True):
        parts = np.linspace(0, 1, 2 + int(segment.length / RING_SPACING))
        stations.append(start + parts * segment.length)
        radii.append((segment.tip_diameter + parts * (segment.butt_diameter - segment.tip_diameter)) / 2)
    x, radius = np.clip(np.concatenate(stations), 0, cue.length), np.concatenate(radii)
    angle = 2 * np.pi * np.arange(RING_POINTS) / RING_POINTS
    y, z = radius[:, None] * np.cos(angle), radius[:, None] * np.sin(angle)
    points = np.column_stack([np.repeat(-x, RING_POINTS), y.ravel(), z.ravel()])
    ends = np.array([[-x[0], 0, 0], [-x[-1], 0, 0]])
    i = np.arange(len(x) * RING_POINTS).reshape(-1, RING_POINTS)
    after = np.roll(i, -1, axis=1)
    quads = np.stack([i[:-1], i[1:], after[1:], after[:-1]], axis=-1).reshape(-1, 4)
    lids = [
        np.column_stack([np.full(RING_POINTS, i.size + end), ring, np.roll(ring, turn)])
        for end, (ring, turn) in enumerate([(i[0], -1), (i[-1], 1)])
    ]
    cells = [("quad", quads), ("triangle", np.concatenate(lids))]
    return ShaftSurface(np.concatenate([points, ends]), cells, np.concatenate([np.repeat(x, RING_POINTS), x[[0, -1]]]))


def ball_surface(radius: float) -> ShaftSurface:
    """A ball about the origin, of quads between the poles on Z."""
    polar, round_ = np.linspace(0, np.pi, 19), 2 * np.pi * np.arange(36) / 36
    ring = np.stack([np.cos(round_), np.sin(round_)], axis=-1)
    points = np.concatenate(
        [np.sin(polar)[:, None, None] * ring, np.broadcast_to(np.cos(polar)[:, None, None], (19, 36, 1))], axis=-1
    )
    i = np.arange(19 * 36).reshape(19, 36)
    after = np.roll(i, -1, axis=1)
    quads = np.stack([i[:-1], i[1:], after[1:], after[:-1]], axis=-1).reshape(-1, 4)
    return ShaftSurface(radius * points.reshape(-1, 3), [("quad", quads)], np.zeros(19 * 36))


def displacements(surface: ShaftSurface, w: Array, theta: Array, *, along: float = 0.0) -> Array:
    """Displacement of a shaft's points, (n, 3): (along + theta y, w, 0)."""
    return np.column_stack([along + theta * surface.points[:, 1], w, np.zeros_like(w)])


def save_vtu(path: Path, surface: ShaftSurface, data: Mapping[str, Array]) -> None:
    """Write a surface with point data."""
    meshio.vtu.write(str(path), meshio.Mesh(surface.points, surface.cells, point_data=dict(data)), binary=True)


def save_modes(path: Path, cue: Cue, solved: Modes) -> None:
    """Save mode shapes on the shaft, mass-normalised: displacement, 1/sqrt(kg), and rotation, 1/(m sqrt(kg))."""
    surface = shaft_surface(cue)
    data = {"x": surface.x}
    for k, (tone, w, theta) in enumerate(zip(solved.frequencies, *solved.shape(surface.x), strict=True), start=1):
        data |= {f"mode_{k}_{tone:.1f}_Hz": displacements(surface, w, theta), f"mode_{k}_theta": theta}
    save_vtu(path, surface, data)


def save_strike(folder: Path, scene: Scene, motion: Motion, *, scale: float = 1.0) -> None:
    """Write folder/strike.pvd and, in folder/strike, a shaft and a ball per frame.

    scale: magnification of the drawn bending; the point data contain the true displacement.
    """
    shaft, ball = shaft_surface(scene.shaft), ball_surface(scene.ball.radius)
    w, theta = motion.deflection(shaft.x)
    centres, forces = (np.column_stack([plane, np.zeros(len(plane))]) for plane in (motion.centre, motion.force))
    (folder / "strike").mkdir()
    series = []
    for i, time in enumerate(motion.times.tolist()):
        along, names = float(motion.axial[i]), [f"strike/{body}_{i:04d}.vtu" for body in ("shaft", "ball")]
        drawn = shaft._replace(points=shaft.points + displacements(shaft, scale * w[i], scale * theta[i], along=along))
        true = displacements(shaft, w[i], theta[i], along=along)
        save_vtu(folder / names[0], drawn, {"x": shaft.x, "displacement": true, "w": w[i], "theta": theta[i]})
        ball_now = ball._replace(points=np.add(_turned(ball.points, float(motion.rotation[i])), centres[i]))
        moved = ball_now.points - np.add(ball.points, centres[0])
        save_vtu(folder / names[1], ball_now, {"displacement": moved, "force": np.tile(forces[i], (len(moved), 1))})
        series += [(time, part, name) for part, name in enumerate(names)]
    save_pvd(folder / "strike.pvd", series)


def _turned(points: Array, angle: float) -> Array:
    s, c = np.sin(angle), np.cos(angle)
    return points @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def save_pvd(path: Path, series: Iterable[tuple[float, int, str]]) -> None:
    """Write a collection of files for ParaView: time, s, part and path of each."""
    root = ET.Element("VTKFile", type="Collection", version="0.1", byte_order="LittleEndian")
    collection = ET.SubElement(root, "Collection")
    for time, part, name in series:
        ET.SubElement(collection, "DataSet", timestep=repr(float(time)), group="", part=str(part), file=name)
    ET.indent(root)
    ET.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
