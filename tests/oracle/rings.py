"""A patch of leather that holds and slides ring by ring: f -> clip(f min(k/k before, 1) + k d(shift), +-mu N).

k and N are a ring's share of the patch's stiffness and normal force between two edges of the compression; of the last
ring that touches, up to the compression itself. The patch slides as a whole where all of its rings do.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.oracle.contact import NODES, Step, at
from tests.oracle.planar import Planar


class Ringed(Planar):
    ring_shear: Any = 0.0
    kept: float = 0.0  # by the leather, of the work of the last walk, J

    def rings(self, depth: Any) -> tuple[Any, Any]:
        """Stiffness and normal force of each ring, (..., rings), at virtual compressions."""
        depth = np.asarray(depth)[..., None]
        edges, arrays = self.model.arrays["ring_edges"], self.model.arrays
        there = np.concatenate([depth.real > edges[:-1], np.zeros_like(depth, bool)], -1)  # past an edge
        whole = self.stiffness(depth), self.normal(depth)
        # at an edge: the stiffness, and the normal force of a patch that grows no further
        k = np.where(there, arrays["ring_stiffness"], whole[0])
        N = np.where(there, arrays["ring_forces"] + arrays["ring_slopes"] * (depth - edges), whole[1])
        k, N = k[..., 1:] - k[..., :-1], N[..., 1:] - N[..., :-1]
        return np.where(k.real > 0, k, 0.0), np.where(N.real > 0, N, 0.0)  # just past an edge, of rounding

    def walk(self, depth: Any, x: Any) -> Any:
        """What each ring bears after a path of compressions and shifts -x, both (..., places)."""
        k, N = self.rings(self.virtual(depth))
        f, e2, self.kept = self.ring_shear, self.terms["surface_restitution"] ** 2, 0.0
        for i in range(1, k.shape[-2]):
            was, now = k[..., i - 1, :], k[..., i, :]
            left = np.where(was.real > now.real, now / np.where(was == 0, 1.0, was), 1.0)
            f, k_mean = f * left, (now + was) / 2
            start, by = f, k_mean * (x[..., i - 1] - x[..., i])[..., None]
            falls = np.where(np.abs(by.real) < e2 * np.abs(np.real(f)), f + by / e2, by + e2 * f)
            f = np.where((np.real(f) * by.real) < 0, falls, f + by)
            bound = self.mu * N[..., i, :] if np.isfinite(self.mu) else np.full_like(now, 1e300)
            f = np.where(f.real > bound.real, bound, np.where(f.real < -bound.real, -bound, f))
            f = np.where(now == 0, 0.0, f)
            grown = np.real(f) ** 2 - np.where(np.real(f * start) > 0, np.real(start) ** 2, 0.0)
            rate = np.where(k_mean.real > 0, (1 - e2) / (2 * np.where(k_mean.real > 0, k_mean.real, 1.0)), 0.0)
            self.kept += np.sum(np.maximum(grown, 0.0) * rate)
            yield f

    def along(self, s: Step) -> Any:
        borne = [f.sum(axis=-1) for f in self.walk(s.depth, s.x[..., 0, :])]
        return s.F[..., 0, 1:] - np.stack(borne, axis=-1)

    def stored(self) -> float:
        k = self.rings(self.virtual(self.depth))[0]
        e2 = self.terms["surface_restitution"] ** 2
        return e2 * float(np.sum(self.ring_shear**2 * (k > 0) / (2 * np.where(k > 0, k, 1.0))))

    def begin(self) -> None:
        super().begin()
        if self.press == "free":
            self.ring_shear = 0.0

    def shear_after(self, s: Step, part: float) -> float:
        """Take the rings to a part of the step; the phase of a grip that is no more ends where the step began."""
        there = np.append([node for node in NODES if node < part * (1 - 1e-12)], part)
        path = [at(np.append(0.0, there), values) for values in (s.depth, s.x[0])]
        *_, self.ring_shear = self.walk(*path)
        shear, normal = float(self.ring_shear.sum()), float(at(part, s.F[1]))
        grip = "stick"
        if self.mu == 0:
            grip = "stick" if s.v[0, -1] == 0 else "slip" if s.v[0, -1] < 0 else "slip back"
        elif abs(shear) >= self.mu * normal * (1 - 1e-9) and normal > 0:
            grip = "slip" if shear > 0 else "slip back"
        if grip != self.grip and self.time > self.start:
            self.phases.append((self.grip, self.press, self.start, self.time))
            self.start = self.time
        self.grip = grip
        return shear
