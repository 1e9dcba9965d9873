"""Round sections of a shaft from slices of a closed surface of triangles, normal to its long axis.

A slice of a polyhedron is a polygon. Where all corners of an outline lie on one circle, as of a turned shape with
facets inscribed, that circle is the section: N facets of equal area would be too narrow by sqrt(N sin(2 pi/N)/(2 pi)).
Else its area and second moments (Green's theorem) are those of a round section with diameters D and d: A = pi/4 (D^2 -
d^2), I = pi/64 (D^4 - d^4). Lengths are in the unit of the points.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cuefem.cue import Array

Index = NDArray[np.intp]

SAME = 1e-6  # of the length: closer points are merged
FLAT = 1e-5  # of the length: a triangle of a smaller axial extent is a flat face
UPRIGHT = 5e-4  # rad: an axis closer to x, y or z is replaced by it; a shaft 60 times as long as wide is then straight
SLENDER = 5.0  # least ratio of length to largest diameter
ROUND = 0.02  # relative: the two second moments of a section, and that of a solid section against a disc's
STRAIGHT = 0.02  # of the diameter: the centre of a section off the axis
ON_CIRCLE = 1e-4  # relative: corners this close to a circle lie on it
COARSEST = 0.06  # of the radius, corners outside the circle of equal area: 8 facets have 5.4 %, 7 have 7.1 %
TOLERANCE = 5e-5  # of the widest diameter: error of the straight pieces
N_SLICES_OF_ENDS = 60  # that tell the tip from the butt, by the thickest of the first and of the last third
SLICES, LEVELS = 50, 1000  # least number of slices; largest number of corner levels that are all cut


class ConicalPiece(NamedTuple):
    """A conical piece: length, outer diameters and bores at both ends, tip side first."""

    length: float
    outer: tuple[float, float]
    bore: tuple[float, float]


class Gap(NamedTuple):
    """A gap between two bodies: its position and its width along the axis."""

    position: float
    width: float


@dataclass(frozen=True)
class SectionedShaft:
    """A shaft from a surface. pieces: from the thinner end to the thicker.

    facets: largest distance of a corner outside the circle of its slice; the true radius lies between the two.
    gaps: between bodies, which the piece in front of each of them bridges.
    """

    pieces: tuple[ConicalPiece, ...]
    facets: float
    gaps: tuple[Gap, ...] = ()

    @property
    def widest(self) -> float:
        """The largest diameter."""
        return max(max(piece.outer) for piece in self.pieces)


class Slice(NamedTuple):
    """A polygon normal to the axis.

    area, second moments about its centroid (yy, zz, yz), centroid (y, z), numbers of outer and inner outlines, the
    largest distance of a corner from the axis, and the diameters of the circles on which the corners of its outer and
    inner outline lie; None if they do not.
    """

    area: float
    moments: tuple[float, float, float]
    centre: tuple[float, float]
    outlines: tuple[int, int]
    reach: float
    circles: tuple[float, float] | None = None

    @property
    def diameters(self) -> tuple[float, float]:
        """Outer diameter and bore of its circles, else of the equivalent round section; for one outline of a disc."""
        if self.area <= 0:
            return 0.0, 0.0
        if self.circles:
            return self.circles
        difference = 4 * self.area / np.pi
        if self.outlines[1] == 0:
            return float(np.sqrt(difference)), 0.0
        total = 8 * (self.moments[0] + self.moments[1]) / self.area  # D^2 + d^2 = 16 I/A
        return float(np.sqrt((total + difference) / 2)), float(np.sqrt(max(total - difference, 0.0) / 2))


@dataclass(frozen=True, eq=False)
class Surface:
    """A closed surface with its axis along x from 0 to ``length``. points: (n, 3). triangles: (m, 3), oriented
    outwards. flats: positions of the faces normal to the axis, both ends included."""

    points: Array
    triangles: Index
    flats: Array

    @property
    def length(self) -> float:
        """Length along the axis."""
        return float(self.flats[-1])

    @cached_property
    def _spans(self) -> Array:
        """The least and the largest x of every triangle, (2, m)."""
        along = self.points[:, 0][self.triangles]
        return np.array([along.min(axis=1), along.max(axis=1)])

    def cut(self, x: float, *, butt_side: bool = True) -> Slice:
        """The slice at ``x``; at a flat face, the slice on its butt side or on its tip side."""
        low, high = self._spans
        triangles = self.triangles[(low <= x) & (x < high) if butt_side else (low < x) & (x <= high)]
        along = self.points[triangles, 0]
        beyond = along > x if butt_side else along >= x
        if not len(triangles):
            return Slice(0.0, (0.0, 0.0, 0.0), (0.0, 0.0), (0, 0), 0.0)
        alone = np.argmax(beyond == (beyond.sum(axis=1) == 1)[:, None], axis=1)  # the corner that is alone on its side
        rows = np.arange(len(triangles))
        a, b, c = (triangles[rows, (alone + k) % 3] for k in range(3))
        leaving = beyond[rows, alone]  # the outline runs a-b to a-c where the corner lies beyond, else back
        first, last = np.where(leaving, b, c), np.where(leaving, c, b)
        return _polygon(self._crossing(a, first, x), self._crossing(a, last, x), _chains(a, first, last))

    def _crossing(self, a: Index, b: Index, x: float) -> Array:
        a, b = np.minimum(a, b), np.maximum(a, b)  # the same from both sides, to the last bit
        p, q = self.points[a], self.points[b]
        t = (x - p[:, 0]) / (q[:, 0] - p[:, 0])
        return np.asarray(p[:, 1:] + t[:, None] * (q[:, 1:] - p[:, 1:]))


def _chains(a: Index, first: Index, last: Index) -> Index:
    """Label of the outline of each side of the polygon: a side ends at the cut edge where the next one starts."""
    count = 1 + max(int(part.max()) for part in (a, first, last))
    begins, ends = (np.minimum(a, other) * count + np.maximum(a, other) for other in (first, last))
    following = np.empty(len(a), dtype=np.intp)
    following[np.argsort(ends, kind="stable")] = np.argsort(begins, kind="stable")
    label = np.arange(len(a))
    for _ in range(len(a).bit_length()):  # pointer doubling: the least label spreads twice as far each time
        label = np.minimum(label, label[following])
        following = following[following]
    return np.unique(label, return_inverse=True)[1].ravel()


def _polygon(start: Array, end: Array, outline: Index) -> Slice:
    (y0, z0), (y1, z1) = start.T, end.T
    cross = y0 * z1 - y1 * z0
    signed = np.bincount(outline, cross) / 2
    area = float(signed.sum())
    negligible = 1e-9 * np.abs(signed).max()
    outlines = int(np.sum(signed > negligible)), int(np.sum(signed < -negligible))
    reach = float(np.sqrt((start**2).sum(axis=1)).max())
    if area <= 0:
        return Slice(area, (0.0, 0.0, 0.0), (0.0, 0.0), outlines, reach)
    y, z = float(((y0 + y1) * cross).sum() / 6 / area), float(((z0 + z1) * cross).sum() / 6 / area)
    yy = float(((y0**2 + y0 * y1 + y1**2) * cross).sum() / 12) - area * y**2
    zz = float(((z0**2 + z0 * z1 + z1**2) * cross).sum() / 12) - area * z**2
    yz = float(((y0 * (2 * z0 + z1) + y1 * (2 * z1 + z0)) * cross).sum() / 24) - area * y * z
    circles = (
        [_circle(start[outline == k], end[outline == k]) for k in np.argsort(-signed)] if sum(outlines) < 3 else []
    )
    if not circles or 0.0 in circles:
        return Slice(area, (yy, zz, yz), (y, z), outlines, reach)
    return Slice(area, (yy, zz, yz), (y, z), outlines, reach, (circles[0], circles[1] if outlines[1] else 0.0))


def _circle(start: Array, end: Array) -> float:
    """The diameter of the circle through all corners of an outline of sides; 0 if they lie on none.

    Points between corners are allowed: the polygon of the points on the circle must have the area of the outline.
    """
    cross = start[:, 0] * end[:, 1] - end[:, 0] * start[:, 1]
    area = float(cross.sum()) / 2
    if area == 0:
        return 0.0
    points = start - ((start + end) * cross[:, None]).sum(axis=0) / 6 / area
    radii = np.hypot(*points.T)
    corners = points[radii >= (1 - ON_CIRCLE) * radii.max()]
    y, z = corners[np.argsort(np.arctan2(corners[:, 1], corners[:, 0]))].T
    inscribed = float((y * np.roll(z, -1) - np.roll(y, -1) * z).sum()) / 2
    return 2 * float(radii.max()) if abs(inscribed - abs(area)) <= 2 * ON_CIRCLE * abs(area) else 0.0


def aligned_surface(points: Array, triangles: Index) -> Surface:
    """The surface rotated to the x axis, its thinner end at 0; ValueError if it is not closed or not slender."""
    size = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    if not np.isfinite(size) or size <= 0 or not len(triangles):
        raise ValueError("must be a surface with finite corners and some extent; got none")
    points, triangles = _merged(points, triangles, SAME * size)
    _check_closed(points, triangles)
    points = points - points.mean(axis=0)
    volumes, corners = _tetrahedra(points, triangles)
    volume = float(volumes.sum())
    if abs(volume) <= 1e-9 * size**3:
        raise ValueError("must enclose a volume; got a surface that encloses none")
    if volume < 0:
        triangles = triangles[:, ::-1]
    points = points - np.einsum("i,ikj->j", volumes, corners) / 4 / volume
    volumes, corners = _tetrahedra(points, triangles)
    total = corners.sum(axis=1)
    spread = np.einsum("i,ij,ik->jk", volumes, total, total) + np.einsum("i,ilj,ilk->jk", volumes, corners, corners)
    return _aligned(points @ _frame(spread), triangles)


def _tetrahedra(points: Array, triangles: Index) -> tuple[Array, Array]:
    """Signed volumes of the tetrahedra from the origin to every triangle, and their corners."""
    corners = points[triangles]
    return np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6, corners


def _merged(points: Array, triangles: Index, near: float) -> tuple[Array, Index]:
    """Coincident points merged (formats repeat them, rounded) and degenerate triangles removed."""
    _, first, label = np.unique(np.round(points / near), axis=0, return_index=True, return_inverse=True)
    triangles = label.ravel()[triangles].astype(np.intp)
    whole = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return points[first], triangles[whole]


def _check_closed(points: Array, triangles: Index) -> None:
    first, last = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    count = len(points)
    edges, met = np.unique(np.minimum(first, last) * count + np.maximum(first, last), return_counts=True)
    loose = edges[met % 2 == 1]
    if len(loose):
        position = ", ".join(f"{v:.6g}" for v in points[loose[0] // count])
        raise ValueError(
            f"must be closed, two triangles at every edge; got {len(loose)} loose edges, one at ({position})"
        )
    there, back = (np.sort(a * count + b) for a, b in ((first, last), (last, first)))
    if not np.array_equal(there, back):
        wrong = int(np.sum(there != back))
        raise ValueError(f"must have consistently oriented triangles; got about {wrong} edges in one direction only")


def _frame(spread: Array) -> Array:
    """Columns: the long axis and two transverse ones, right-handed."""
    axis = np.linalg.eigh(spread)[1][:, -1]
    nearest = int(np.argmax(np.abs(axis)))
    straight = np.eye(3)[nearest] * np.sign(axis[nearest])
    if np.linalg.norm(axis - straight) < UPRIGHT:
        axis = straight
    side = np.cross(axis, np.eye(3)[(nearest + 1) % 3])
    side /= np.linalg.norm(side)
    return np.column_stack([axis, side, np.cross(axis, side)])


def _aligned(points: Array, triangles: Index) -> Surface:
    """With the thinner end at x = 0, and all corners of each flat face at the same x."""
    points[:, 0] -= points[:, 0].min()
    length = float(points[:, 0].max())
    widest = 2 * float(np.sqrt((points[:, 1:] ** 2).sum(axis=1)).max())
    if length < SLENDER * widest:
        raise ValueError(
            f"must be slender, at least {SLENDER:g} times as long as wide; got {length:.6g} by {widest:.6g}"
        )
    along = points[triangles][:, :, 0]
    across = np.ptp(along, axis=1) <= FLAT * length
    levels = np.sort(np.concatenate([[0.0, length], along[across].ravel()]))
    levels = np.array([group.mean() for group in np.split(levels, np.flatnonzero(np.diff(levels) > FLAT * length) + 1)])
    levels[[0, -1]] = 0.0, length
    corners = np.unique(triangles[across])
    points[corners, 0] = levels[np.argmin(np.abs(points[corners, 0, None] - levels), axis=1)]
    laid = Surface(points, triangles, levels)
    shares = np.linspace(0.01, 0.99, N_SLICES_OF_ENDS)
    areas = np.array([laid.cut(share * length).area for share in shares])
    if areas[shares < 1 / 3].max() <= areas[shares > 2 / 3].max():  # a chamfer or a bumper at the butt is thin
        return laid
    turned = points * [-1, -1, 1] + [length, 0, 0]  # about z: a rotation preserves the orientation
    return replace(laid, points=turned, flats=length - levels[::-1])


def section_shaft(body: Surface, tolerance: float = TOLERANCE) -> SectionedShaft:
    """The conical pieces that approximate the slices of a surface to ``tolerance`` (of the widest diameter).

    Slices are at every level of corners and between the levels, at least `SLICES`; steps at flat faces are preserved.
    A gap between the flat faces of two bodies is bridged by the body in front of it. ValueError if a section is not one
    round piece about the axis.
    """
    pieces: list[ConicalPiece] = []
    gaps: list[Gap] = []
    facets = 0.0
    widest = 2 * float(np.sqrt((body.points[:, 1:] ** 2).sum(axis=1)).max())
    for start, stop in itertools.pairwise(body.flats):
        x = _cut_positions(body, float(start), float(stop))
        cuts = [body.cut(p, butt_side=p < stop) for p in x]
        if all(cut.area == 0 for cut in cuts):
            width = float(stop - start)
            gaps.append(Gap(float(start), width))
            pieces[-1] = pieces[-1]._replace(length=pieces[-1].length + width)
            continue
        _check_one_body(cuts, x, body.length)
        for position, cut in zip(x, cuts, strict=True):
            _check_round(cut, position, widest)
        diameters = np.array([cut.diameters for cut in cuts])
        diameters[:, 0] = np.maximum(diameters[:, 0], tolerance * widest)  # an apex
        for i, j in itertools.pairwise(2 * polyline_corners(x[::2], diameters[::2], tolerance * widest)):
            (outer0, bore0), (outer1, bore1) = diameters[i].tolist(), diameters[j].tolist()
            pieces.append(ConicalPiece(float(x[j] - x[i]), (outer0, outer1), (bore0, bore1)))
        facets = max(facets, *(float(cut.reach - d / 2) for cut, d in zip(cuts, diameters[:, 0], strict=True)))
    return SectionedShaft(tuple(pieces), facets, tuple(gaps))


def _check_one_body(cuts: Sequence[Slice], x: Array, length: float) -> None:
    """ValueError for an empty section between the ends, which two bodies with round faces leave."""
    empty = [position for position, cut in zip(x, cuts, strict=True) if cut.area == 0 and 0 < position < length]
    if empty:
        raise ValueError(f"must be one body; got none at {empty[0]:.6g} from its thinner end: join the bodies in CAD")


def _cut_positions(body: Surface, start: float, stop: float) -> Array:
    """Positions of the slices between two steps: corner levels, points between them, and all midpoints."""
    levels = np.unique(body.points[:, 0])
    levels = levels[(levels > start) & (levels < stop)]
    near = FLAT * body.length
    levels = levels[np.diff(levels, prepend=start) > near]
    scattered = len(levels) > LEVELS
    step = body.length / (LEVELS if scattered else SLICES)
    ends = np.array([start, *([] if scattered else levels[levels < stop - near]), stop])
    parts = [np.linspace(a, b, int(np.ceil((b - a) / step)), endpoint=False) for a, b in itertools.pairwise(ends)]
    x = np.append(np.concatenate(parts), stop)
    return np.insert(x, np.arange(1, len(x)), (x[:-1] + x[1:]) / 2)


def _check_round(cut: Slice, position: float, widest: float) -> None:
    where = f"at {position:.6g} from its thinner end"
    if cut.area <= (FLAT * widest) ** 2:
        return  # an apex
    outside, inside = cut.outlines
    if outside != 1:
        problem = f"must have one outer outline in every section; got {outside} outlines {where}"
        raise ValueError(f"{problem}: bodies that overlap, or stand in one another, must be joined in CAD")
    off = float(np.hypot(*cut.centre))
    if off > STRAIGHT * widest:
        bound = f"its sections' centres within {100 * STRAIGHT:g} % of the width of one axis"
        raise ValueError(f"must be straight, {bound}; got {100 * off / widest:.1f} % {where}")
    yy, zz, yz = cut.moments
    mean, half = (yy + zz) / 2, float(np.hypot((yy - zz) / 2, yz))
    if half > ROUND / 2 * mean:
        got = f"second moments {100 * 2 * half / mean:.1f} % apart {where}"
        raise ValueError(f"must be round, second moments within {100 * ROUND:g} % of each other; got {got}")
    corners = (cut.reach - off) / (cut.diameters[0] / 2) - 1
    if cut.circles is None and corners > COARSEST:
        got = f"corners {100 * corners:.1f} % outside the circle of equal area {where}"
        raise ValueError(f"must have at least 8 facets around it, or all corners on one circle; got {got}")
    disc = 4 * np.pi * mean / cut.area**2 - 1
    if inside == 0 and abs(disc) > ROUND:
        got = f"a section {100 * disc:.1f} % off {where}"
        raise ValueError(f"must be round, its second moment within {100 * ROUND:g} % of a disc's; got {got}")


def polyline_corners(x: Array, diameters: Array, near: float) -> Index:
    """Indices of the points of a polyline within ``near`` of all points (Douglas and Peucker)."""
    corners, open_ends = {0, len(x) - 1}, [(0, len(x) - 1)]
    while open_ends:
        i, j = open_ends.pop()
        off = _offsets(x[i : j + 1], diameters[i : j + 1])
        worst = int(np.argmax(off))
        if off[worst] > near:
            corners.add(i + worst)
            open_ends += [(i, i + worst), (i + worst, j)]
    return np.array(sorted(corners), dtype=np.intp)


def _offsets(x: Array, diameters: Array) -> Array:
    """Distances of diameters from the straight line between the first and the last, the larger of outer and bore."""
    t = (x - x[0]) / (x[-1] - x[0])
    return np.asarray(np.abs(diameters - diameters[0] - t[:, None] * (diameters[-1] - diameters[0])).max(axis=1))
