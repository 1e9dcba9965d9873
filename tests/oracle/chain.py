"""A geometrically exact cue: point masses, stretching links and rotational springs at joints, in small steps; no tests.

It uses no code of cuefem. Links stretch and rotate by any angle; the linear chain has the same stiffness without the
geometric terms, so that the two differ by the coupling of axial force and bending.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np


class Chain:
    """length: m; radius(x), density, E: of a solid shaft; butt_mass: at the butt end, kg; count: number of links."""

    def __init__(self, length: float, radius: Any, density: float, E: float, butt_mass: float, count: int) -> None:
        self.link = length / count
        middle, node = (np.arange(count) + 0.5) * self.link, np.arange(1, count) * self.link
        area, points = math.pi * radius(middle) ** 2, (np.arange(20 * count) + 0.5) / 20
        masses = density * math.pi * radius(points * self.link) ** 2 * self.link / 20
        self.mass = np.bincount(points.astype(int), masses * (1 - points % 1), count + 1)
        self.mass += np.bincount(points.astype(int) + 1, masses * (points % 1), count + 1)
        self.mass[-1] += butt_mass
        self.stretch, self.couple = E * area / self.link, E * math.pi * radius(node) ** 4 / 4 / self.link
        self.rest = np.column_stack([-np.arange(count + 1) * self.link, np.zeros(count + 1)])

    @property
    def step(self) -> float:
        """Time step, s: a small part of the time that a wave takes along a link."""
        return 0.08 * float(np.sqrt(self.mass[1:-1].min() / self.stretch.max()))

    def forces(self, positions: Any, *, exact: bool) -> Any:
        """Forces on the masses, (masses, 2), N."""
        force = np.zeros_like(positions)
        if not exact:
            displacement = positions - self.rest
            pull = self.stretch * (displacement[1:, 0] - displacement[:-1, 0])
            force[:-1, 0] += pull
            force[1:, 0] -= pull
            w = displacement[:, 1]
            couple = self.couple / self.link**2 * (w[2:] - 2 * w[1:-1] + w[:-2])
            force[2:, 1] -= couple
            force[1:-1, 1] += 2 * couple
            force[:-2, 1] -= couple
            return force
        link = positions[:-1] - positions[1:]
        lengths = np.hypot(*link.T)
        directions = link / lengths[:, None]
        angle = np.arctan2(link[:, 1], link[:, 0])
        couple = self.couple * (angle[:-1] - angle[1:])  # of each joint
        moments = np.append(couple, 0.0) - np.append(0.0, couple)  # on each link, against its angle
        lateral = np.column_stack([-directions[:, 1], directions[:, 0]]) * (moments / lengths)[:, None]
        total = directions * (self.stretch * (lengths - self.link))[:, None] + lateral
        force[:-1] -= total
        force[1:] += total
        return force


def chain_squirt(chain: Chain, stroke: Any, ball: Any, stiffness: float, shear: float, *, exact: bool) -> float:
    """Squirt, rad, of a ball struck by a linear spring along the normal of the first touch and another along t."""
    phi, step = math.asin(stroke.offset), chain.step
    t, n = np.array([math.sin(phi), math.cos(phi)]), np.array([math.cos(phi), -math.sin(phi)])
    positions, v = chain.rest.copy(), np.zeros_like(chain.rest)
    v[:, 0] = stroke.speed
    ball_position, ball_v, spin, shift, depth = np.zeros(2), np.zeros(2), 0.0, 0.0, 0.0
    while depth >= 0:
        force, contact_force = chain.forces(positions, exact=exact), stiffness * depth * n + shear * shift * t
        force[0] -= contact_force
        v += force / chain.mass[:, None] * step
        positions += v * step
        ball_v = ball_v + contact_force / ball.mass * step
        spin += shear * shift / (ball.inertia * ball.mass) * step
        ball_position = ball_position + ball_v * step
        depth = float((positions[0] - chain.rest[0] - ball_position) @ n)
        shift -= (float((ball_v - v[0]) @ t) + spin) * step
    return math.atan2(-ball_v[1], ball_v[0])
