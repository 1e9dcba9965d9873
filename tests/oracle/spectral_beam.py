"""An independent Timoshenko beam: spectral elements with lumped masses; no tests.

The nodes of an element are its Gauss-Lobatto points, which are its quadrature points too, so that the mass matrix is
diagonal. It shares no basis, quadrature, sections or effects with the package.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
import scipy.linalg as la
from numpy.polynomial import legendre
from numpy.typing import NDArray

from cuefem import Cue, Effect, Joint, Material, PointMass, Segment, StructuralDamping, Support

Array = NDArray[np.float64]
DEGREE, MAX_LENGTH = 8, 0.06  # of an element; m


@cache
def lobatto(degree: int) -> tuple[Array, Array, Array]:
    """Nodes in [0, 1], weights, and the derivative matrix of the polynomials through the nodes."""
    coefficients = np.zeros(degree + 1)
    coefficients[-1] = 1.0
    x = np.concatenate([[-1.0], np.sort(legendre.legroots(legendre.legder(coefficients)).real), [1.0]])
    values = legendre.legval(x, coefficients)
    weights = 2 / (degree * (degree + 1) * values**2)
    differences = x[:, None] - x + np.eye(degree + 1)
    slopes = (values[:, None] / values) / differences * (1 - np.eye(degree + 1))
    slopes -= np.diag(slopes.sum(axis=1))  # a constant has no slope
    return (x + 1) / 2, weights / 2, 2 * slopes


@dataclass(frozen=True)
class Bending:
    """Modes of a beam: angular frequency, rad/s, deflection and rotation of the tip, and the damping matrix, 1/s."""

    omega: Array
    deflection: Array
    rotation: Array
    damping: Array


def section(segment: Segment, s: Array) -> list[tuple[Material, Array, Array]]:
    """(material, area, second moment of area) of the shell and of the core, at distances s from the tip's end."""
    outer = segment.tip_diameter + (segment.butt_diameter - segment.tip_diameter) * s / segment.length
    bore = segment.tip_bore + (segment.butt_bore - segment.tip_bore) * s / segment.length
    parts = [(segment.material, math.pi / 4 * (outer**2 - bore**2), math.pi / 64 * (outer**4 - bore**4))]
    if segment.core is not None:
        parts.append((segment.core, math.pi / 4 * bore**2, math.pi / 64 * bore**4))
    return parts


class Assembly:
    """Stiffness, the same with every modulus times its loss factor, dashpots, and the diagonal of masses.

    Degrees of freedom in the order of the nodes: deflection, rotation.
    """

    def __init__(self, cue: Cue, effects: tuple[Effect, ...]) -> None:
        self.effects = effects
        positions = [effect.position for effect in effects if hasattr(effect, "position")]
        ends = np.cumsum([0.0, *(segment.length for segment in cue.segments)])
        joints = {effect.position for effect in effects if isinstance(effect, Joint)}
        self.blocks: list[tuple[Array, float, Segment, float]] = []  # nodes, length, segment, start in the segment
        self.node: dict[float, int] = {0.0: 0}
        self.before: dict[float, int] = {}  # the node ahead of a joint
        last, count = 0, 1
        for (start, end), segment in zip(pairwise(ends), cue.segments, strict=True):
            cuts = [start, *sorted({x for x in positions if start + 1e-9 < x < end - 1e-9}), end]
            for a, b in pairwise(cuts):
                many = math.ceil((b - a) / MAX_LENGTH)
                for i in range(many):
                    nodes = np.concatenate([[last], np.arange(count, count + DEGREE)])
                    self.blocks.append((nodes, (b - a) / many, segment, a - start + i * (b - a) / many))
                    last, count = int(nodes[-1]), count + DEGREE
                where = next((x for x in positions if abs(x - b) < 1e-9), b)
                if where in joints:
                    self.before[where] = last
                    last, count = count, count + 1
                self.node[where] = last
        self.count = count

    def matrices(self) -> tuple[Array, Array, Array, Array]:
        """(K, K with losses, C, diagonal of M) of all degrees of freedom."""
        size = 2 * self.count
        K, lossy, C, M = np.zeros((size, size)), np.zeros((size, size)), np.zeros((size, size)), np.zeros(size)
        x, weights, slopes = lobatto(DEGREE)
        loss = next((effect.loss for effect in self.effects if isinstance(effect, StructuralDamping)), None)
        for nodes, length, segment, start in self.blocks:
            w, theta, n = 2 * nodes, 2 * nodes + 1, len(nodes)
            slope = slopes / length
            curvature, shear = np.zeros((n, 2 * n)), np.zeros((n, 2 * n))
            curvature[:, n:], shear[:, :n], shear[:, n:] = slope, slope, -np.eye(n)
            dofs = np.concatenate([w, theta])
            for material, area, moment in section(segment, start + x * length):
                assert segment.kappa is not None
                stiffness = curvature.T @ np.diag(weights * length * material.E * moment) @ curvature
                stiffness += shear.T @ np.diag(weights * length * segment.kappa * material.G * area) @ shear
                K[np.ix_(dofs, dofs)] += stiffness
                lossy[np.ix_(dofs, dofs)] += stiffness * (material.loss if loss is None else loss)
                M[w] += weights * length * material.rho * area
                M[theta] += weights * length * material.rho * moment
        for effect in self.effects:
            if isinstance(effect, PointMass):
                at = 2 * self.node[effect.position]
                M[at : at + 2] += effect.mass, effect.rotary_inertia
            elif isinstance(effect, Support):
                at = 2 * self.node[effect.position]
                for i, spring in enumerate((effect.stiffness, effect.rotational_stiffness)):
                    if math.isfinite(spring):
                        K[at + i, at + i] += spring
                C[at, at] += effect.dashpot
        return K, lossy, C, M

    def reduced(self) -> tuple[Array, Array, Array, Array]:
        """The matrices with joint springs, without clamped degrees of freedom, with rigid joint directions tied."""
        K, lossy, C, M = self.matrices()
        targets = np.arange(2 * self.count)
        for effect in self.effects:
            if isinstance(effect, Joint):
                ahead, behind = 2 * self.before[effect.position], 2 * self.node[effect.position]
                for i, compliance in enumerate((effect.shear_compliance, effect.rotational_compliance)):
                    if compliance:
                        pair = [ahead + i, behind + i]
                        K[np.ix_(pair, pair)] += np.array([[1, -1], [-1, 1]]) / compliance
                    else:
                        targets[ahead + i] = targets[behind + i]
        clamped = {
            2 * self.node[effect.position] + i
            for effect in self.effects
            if isinstance(effect, Support)
            for i, spring in enumerate((effect.stiffness, effect.rotational_stiffness))
            if math.isinf(spring)
        }
        free = sorted(set(targets.tolist()) - clamped)
        T = np.zeros((len(targets), len(free)))
        for i, degree in enumerate(targets.tolist()):
            if degree in free:
                T[i, free.index(degree)] = 1.0
        return T.T @ K @ T, T.T @ lossy @ T, T.T @ C @ T, T.T @ np.diag(M) @ T


def bending(cue: Cue, effects: tuple[Effect, ...], count: int) -> Bending:
    """The lowest ``count`` modes, rigid ones included, with the effects on the cue."""
    K, lossy, C, M = Assembly(cue, effects).reduced()
    shift = 4e4
    size = len(K)
    inverse, vectors = la.eigh(M, K + shift * M, subset_by_index=[size - count, size - 1])
    omega2 = 1 / inverse[::-1] - shift
    shapes = vectors[:, ::-1] / np.sqrt(np.einsum("in,ij,jn->n", vectors, M, vectors))[::-1]
    omega = np.where(omega2 > 1e-5 * shift, np.sqrt(np.abs(omega2)), 0.0)
    damping = shapes.T @ C @ shapes
    if any(isinstance(effect, StructuralDamping) for effect in effects):
        flexible = omega > 0
        loss_energy = np.einsum("in,ij,jn->n", shapes, lossy, shapes)
        strain = np.einsum("in,ij,jn->n", shapes, K, shapes)
        damping = damping + np.diag(np.where(flexible, loss_energy / np.where(flexible, strain, 1.0) * omega, 0.0))
    return Bending(omega, shapes[0], shapes[1], damping)
