"""Annuli of a leather contact in small steps, with dissipation laws outside the package; no study.

On a cue without axial waves and axial force, and a contact that does not roll. The force F(d) and the tangential
stiffness k(d) of the leather are distributed over annuli (method of dimensionality reduction): an annulus at d' comes
into contact at that indentation, carries the normal force F''(d') (d - d') dd' and has the tangential stiffness k'(d'),
up to its friction limit. With viscoelastic springs this is Ting's solution (1966): annuli unload separately, and lose
contact where their force vanishes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg as la

import cuefem as cf
from cuefem.scene.solved_scene import SolvedScene
from studies.strokes import cue, full_model

RINGS, STEP = 200, 1e-6


@dataclass(frozen=True)
class Leather:
    """Relaxation of leather: its stiffness is `stiffer` times (1 - share + share exp(-t/time)) of the elastic one.

    surface: whether the tangential stiffness relaxes too. coupled: whether normal and tangential motion are coupled.
    """

    share: float = 0.0
    time: float = 4e-4
    stiffer: float = 1.0
    surface: bool = False
    coupled: bool = False


def plain(offset: float, speed: float = 2.0) -> cf.Scene:
    """The stroke that `stepped` makes: the leather's rings on a bending shaft, alone."""
    scene = full_model(cue("pool_maple"), offset, speed, rolling=False)
    return replace(scene, effects=scene.effects[:1])


def stepped(scene: cf.Scene, leather: Leather) -> tuple[float, float, float]:
    """Squirt, deg, contact time, s, and speed of the ball over the cue's. The package's loss where nothing relaxes."""
    tip, at, restitution = scene.leather_tip, scene.stroke, scene.tip.restitution
    diameter, mass = scene.tip_diameter, scene.ball.mass
    law, modes = scene.tip_law(restitution, at.offset), SolvedScene(scene).tip
    edges = law.indentation_limit * np.linspace(0, 1, RINGS + 1) ** 2
    begin, stiff = (edges[1:] + edges[:-1]) / 2, np.array([np.diff(law.slope(edges)), np.diff(law.at(edges)[1])])
    radius, depth_, _ = tip.head_on(diameter, scene.ball.radius)
    C = tip.compliance(diameter, at.offset, np.minimum(radius[1:], diameter / 2))
    lean = np.append(C[0, 0, 1] / C[0, 0, 0], C[:, 0, 1] / C[:, 0, 0]) if leather.coupled else np.zeros(len(radius))
    n, omega = len(modes.omega), modes.omega
    turn = np.zeros((3 * n, 3 * n))  # of q, omega q and q'
    turn[:n, 2 * n :], turn[n : 2 * n, 2 * n :], turn[2 * n :, n : 2 * n] = np.eye(n), np.diag(omega), np.diag(-omega)
    turn[2 * n :, 2 * n :] = -modes.damping
    turn, fade = la.expm(turn * STEP), math.exp(-STEP / leather.time)
    phi = math.asin(at.offset)
    t, normal = np.array([math.sin(phi), math.cos(phi)]), np.array([math.cos(phi), -math.sin(phi)])
    reach = modes.amplitude + np.outer(modes.rotation, tip.moment_arm(phi, diameter))
    z, velocity, spin = np.concatenate([np.zeros(2 * n), at.speed * modes.approach]), np.zeros(2), 0.0
    share = leather.share * np.array([1.0, float(leather.surface)])[:, None]
    strain, slow = np.zeros((2, RINGS)), np.zeros((2, RINGS))  # along the normal and the surface; what relaxes of it
    depth = peak = time = 0.0
    while True:
        old, z = z, turn @ z
        near = velocity * STEP - (z[:n] - old[:n]) @ reach
        by = -float(near @ normal)
        depth, time = depth + by, time + STEP
        peak = max(peak, depth)
        if leather.share:
            before = strain[0] > 0
            strain[0] = np.maximum(depth - begin, 0.0)
            slow[0] = np.where(strain[0] > 0, (slow[0] + np.where(before, by, strain[0])) * fade, 0.0)
            pressed = np.maximum((1 - share[0]) * strain[0] + share[0] * slow[0], 0.0) * leather.stiffer
        else:
            virtual = depth if depth == peak else (depth - (1 - law.restitution**2) * peak) / law.restitution**2
            pressed = np.maximum(virtual - begin, 0.0)
        F_n = float(stiff[0] @ pressed)
        if F_n <= 0:
            break
        leaning = float(np.interp(depth, depth_, lean))
        along = -(float(near @ t) + spin * STEP) - leaning * by
        on = pressed > 0
        strain[1], slow[1] = np.where(on, strain[1] + along, 0.0), np.where(on, (slow[1] + along) * fade, 0.0)
        shear = ((1 - share[1]) * strain[1] + share[1] * slow[1]) * (leather.stiffer if leather.surface else 1.0)
        bound = scene.tip.friction * stiff[0] * pressed / stiff[1]
        slip = (shear - np.clip(shear, -bound, bound)) / (leather.stiffer if leather.surface else 1.0)
        strain[1], slow[1] = strain[1] - slip, slow[1] - slip
        F_t = float(stiff[1] @ np.clip(shear, -bound, bound))
        force = (F_n - leaning * F_t) * normal + F_t * t
        z[2 * n :] -= reach @ force * STEP
        velocity, spin = velocity + force * STEP / mass, spin + F_t * STEP / (scene.ball.inertia * mass)
    return math.degrees(math.atan2(-velocity[1], velocity[0])), time, float(np.hypot(*velocity)) / at.speed
