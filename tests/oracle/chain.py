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
        area, fine = math.pi * radius(middle) ** 2, (np.arange(20 * count) + 0.5) / 20
        part = density * math.pi * radius(fine * self.link) ** 2 * self.link / 20
        self.mass = np.bincount(fine.astype(int), part * (1 - fine % 1), count + 1)
        self.mass += np.bincount(fine.astype(int) + 1, part * (fine % 1), count + 1)
        self.mass[-1] += butt_mass
        self.stretch, self.bend = E * area / self.link, E * math.pi * radius(node) ** 4 / 4 / self.link
        self.rest = np.column_stack([-np.arange(count + 1) * self.link, np.zeros(count + 1)])

    @property
    def step(self) -> float:
        """Time step, s: a small part of the time that a wave takes along a link."""
        return 0.08 * float(np.sqrt(self.mass[1:-1].min() / self.stretch.max()))

    def forces(self, at: Any, *, exact: bool) -> Any:
        """Forces on the masses, (masses, 2), N."""
        force = np.zeros_like(at)
        if not exact:
            displacement = at - self.rest
            pull = self.stretch * (displacement[1:, 0] - displacement[:-1, 0])
            force[:-1, 0] += pull
            force[1:, 0] -= pull
            couple = self.bend / self.link**2 * (displacement[2:, 1] - 2 * displacement[1:-1, 1] + displacement[:-2, 1])
            force[2:, 1] -= couple
            force[1:-1, 1] += 2 * couple
            force[:-2, 1] -= couple
            return force
        link = at[:-1] - at[1:]
        long = np.hypot(*link.T)
        along = link / long[:, None]
        angle = np.arctan2(link[:, 1], link[:, 0])
        couple = self.bend * (angle[:-1] - angle[1:])  # of each joint
        turning = np.append(couple, 0.0) - np.append(0.0, couple)  # on each link, against its angle
        sideways = np.column_stack([-along[:, 1], along[:, 0]]) * (turning / long)[:, None]
        total = along * (self.stretch * (long - self.link))[:, None] + sideways
        force[:-1] -= total
        force[1:] += total
        return force


def chain_squirt(chain: Chain, stroke: Any, ball: Any, stiffness: float, shear: float, *, exact: bool) -> float:
    """Squirt, rad, of a ball struck by a linear spring along the normal of the first touch and another along t."""
    phi, step = math.asin(stroke.offset), chain.step
    t, n = np.array([math.sin(phi), math.cos(phi)]), np.array([math.cos(phi), -math.sin(phi)])
    at, v = chain.rest.copy(), np.zeros_like(chain.rest)
    v[:, 0] = stroke.speed
    ball_way, ball_v, spin, shift, depth = np.zeros(2), np.zeros(2), 0.0, 0.0, 0.0
    while depth >= 0:
        force, push = chain.forces(at, exact=exact), stiffness * depth * n + shear * shift * t
        force[0] -= push
        v += force / chain.mass[:, None] * step
        at += v * step
        ball_v = ball_v + push / ball.mass * step
        spin += shear * shift / (ball.inertia * ball.mass) * step
        ball_way = ball_way + ball_v * step
        depth = float((at[0] - chain.rest[0] - ball_way) @ n)
        shift -= (float((ball_v - v[0]) @ t) + spin) * step
    return math.atan2(-ball_v[1], ball_v[0])
