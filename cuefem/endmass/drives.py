"""The definitions of effective end mass, each from the tip modes of a cue (physics.md section 6).

For the tip's transverse impulse response h(t) = sum phi_k^2 cos(omega_k t):

- "force": a half-sine force of length T; impulse over tip velocity at T.
- "velocity": the tip follows (1 - cos(pi t/T))/2; impulse needed over final velocity.
- "stick": the tip must follow the ball, as in the coupled strike when the offset goes to zero (recommended).
- "offset": the same at the scene's own offset; what the impulse solver takes for a finite-element cue.
- "squirt": the lumped end mass whose squirt is that of the coupled strike, at this offset, speed and friction.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, Literal, NamedTuple

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.flow import zero
from cuefem.contact.impulse_space import impact
from cuefem.contact.strike import strike_modes
from cuefem.cue import Array, LumpedCue
from cuefem.effects import TipEffect
from cuefem.endmass import damped
from cuefem.endmass import undamped as transverse
from cuefem.endmass.undamped import StickLimit
from cuefem.quantity import scalar
from cuefem.scene import Outcome, Resolution, Scene, Stroke
from cuefem.tip_modes import LEAST_STUCK, Solved, tip_modes_of

# Of the swing that a tail could add if it rang without loss, errors of the stick end mass above 0.2 % are less than
# this part (studies/default_accuracy.md).
HEARD = 0.6

Drive = Literal["stick", "offset", "velocity", "force", "squirt"]

# Offsets whose end masses are worked at a time, so that the arrays of modes by offsets stay small.
BLOCK = 1024


def end_mass(scene: Scene, drive: Drive = "stick", at: Resolution | None = None) -> Any:
    """Effective end mass m_e of a scene's cue, kg: the inertia that the ball feels across the cue at the tip.

    drive: the definition, see the module. The pulse is as long as the scene's head-on contact time; "stick" and
    "offset" also take the ball's mass, inertia factor and restitution from the scene, and "offset" its offset, which
    may be an array. A LumpedCue answers its own end_mass. at: left out, modes are kept by frequency
    (`default_resolution`), 120 at least: within 0.5 % but at a tip of metal, where `end_mass_spreads` estimates the
    error. Cost: one eigenproblem of the beam, for three of the drives one more of the size of the modes kept.
    ValueError for an unknown drive.
    """
    formula = formula_of(drive)
    if scene.lumped is not None:
        return scene.lumped.end_mass
    return formula(tip_modes_of(scene, at, least=LEAST_STUCK), scene)


class Spread(NamedTuple):
    """An end mass, and the smallest and largest where fewer modes are kept: from a quarter of them to all; kg.

    error: the relative error that `ringing` gives the definition "stick", to which lowest and highest reach at least;
    None for the others, and where a resolution was given.
    """

    end_mass: float
    lowest: float
    highest: float
    error: float | None = None


def end_mass_spread(scene: Scene, drive: Drive = "stick", at: Resolution | None = None) -> tuple[float, float]:
    """Smallest and largest end mass, kg, when only the lowest modes are kept: from a quarter of them to all.

    Wave fronts that return just before the pulse ends make false plateaus, so one doubling of the modes proves nothing.
    """
    formula_of(drive)
    return end_mass_spreads(scene, at)(drive)[1:3]


def end_mass_spreads(
    scene: Scene, at: Resolution | None = None, *, solved: Solved | None = None
) -> Callable[[Drive], Spread]:
    """The end mass and its spread by definition, for any number of definitions from one eigenproblem of the beam.

    The spread is that of plain sums, without a tail. A definition that takes a coupled strike is tried at 5 cutoffs,
    one in closed form at 13. solved: the scene's modes, if they are known already.
    """
    if scene.lumped is not None:
        same = scalar("LumpedCue.end_mass", scene.lumped.end_mass)
        return lambda drive: Spread(same, same, same)
    solved = solved or Solved(scene, at)
    tip, plain = solved.tip_stuck, solved.tip_plain
    rigid, whole = int(np.sum(plain.omega == 0)), len(plain.omega)

    def spread(drive: Drive) -> Spread:
        formula, cutoffs = formula_of(drive), 5 if _strikes(drive, tip, scene) else 13
        least = rigid + math.ceil((whole - rigid) / 4)
        kept = np.unique(np.linspace(least, whole, cutoffs).astype(int))
        values = [formula(tip, scene), *(formula(plain.lowest(n), scene) for n in kept)]
        error = ringing(tip, StickLimit.of(scene)) if drive == "stick" and tip.radiation is not None else None
        reach = [values[0] * (1 + side * (error or 0.0)) for side in (-1, 1)]
        return Spread(values[0], min(*values, *reach), max(*values, *reach), error)

    return spread


def _strikes(drive: str, tip: TipModes, scene: Scene) -> bool:
    """Whether a definition takes a coupled strike, because nothing else says it."""
    if drive not in ("stick", "offset"):
        return drive == "squirt"
    along = np.any(tip.amplitude[tip.omega > 0, 0] != 0)  # rod modes change the course of the normal impulse
    return bool(along) or any(isinstance(effect, TipEffect) for effect in scene.effects)


def formula_of(drive: str) -> Callable[[TipModes, Scene], Any]:
    """The definition of that name, as a function of tip modes and scene; ValueError for an unknown one."""
    formulas: dict[str, Callable[[TipModes, Scene], Any]] = {
        "stick": stick,
        "offset": stick_at_offset,
        "velocity": velocity,
        "force": force,
        "squirt": squirt_equivalent,
    }
    if drive not in formulas:
        raise ValueError(f"end_mass drive must be one of {', '.join(formulas)}; got {drive!r}")
    return formulas[drive]


def force(tip: TipModes, scene: Scene) -> float:
    """Impulse of a half-sine force over the tip velocity at its end, kg. Converges like 1/modes^2 (it has kinks)."""
    T = scene.contact_time
    if tip.resistance is None:
        return 2 * T / np.pi / float(transverse.half_sine_velocity(*flexible(tip), T=T))
    return 2 * T / np.pi / damped.half_sine_velocity(tip, T)


def velocity(tip: TipModes, scene: Scene) -> float:
    """Impulse that makes the tip follow (1 - cos(pi t/T))/2, over its final velocity, kg."""
    T = scene.contact_time
    if tip.resistance is None:
        return float(transverse.smooth_start_impulse(*flexible(tip), T=T))
    return damped.smooth_start_impulse(tip, T)


def stick(tip: TipModes, scene: Scene) -> float:
    """End mass of the limit b -> 0 of the coupled strike, kg: `cuefem.endmass.undamped.StickLimit`.

    Effects at the tip (a dome, shear) and axial waves have no part in that formula: with them it is fed with the
    coupled strike's own small-offset squirt.
    """
    limit = StickLimit.of(scene)
    if _strikes("stick", tip, scene):
        return float(limit.end_mass(limit.impulse(small_offset_slope(tip, scene))))
    return float(limit.end_mass(stick_impulse(tip, limit)))


def stick_at_offset(tip: TipModes, scene: Scene) -> Any:
    """End mass of a tip that sticks from the first touch, at the scene's own offset, kg (physics.md section 6).

    A bare cue's is that of `stick` with the contact of the offset (`limit_at`), exact to first order in the lightness
    of the cue's end. With effects at the tip or axial waves it is the lumped one with the squirt of a coupled strike
    that never slips; the two ways differ in second order, by about 1 % at b/R 0.3. The same on either side, and head on
    that of `stick`. Offsets may be an array, and speeds, of which a bare cue's end mass knows nothing. ValueError where
    the squirt is that of no end mass. Cost: each different offset some milliseconds (with a tail or damping two matrix
    exponentials).
    """
    b, stroke = np.abs(scene.stroke.offset), scene.stroke
    if _strikes("offset", tip, scene):
        return _each(lambda x, U: _stuck_end_mass(tip, replace(scene, stroke=Stroke(U, x))), b, stroke.speed)
    if tip.resistance is not None:
        return _each(lambda x, _: _end_mass_at(tip, scene, x), b, 1.0)
    if np.ndim(b) == 0:
        return float(_end_mass_at(tip, scene, b))
    flat, places = np.unique(b, return_inverse=True)
    found = [_end_mass_at(tip, scene, flat[i : i + BLOCK]) for i in range(0, len(flat), BLOCK)]
    return np.concatenate(found)[places.ravel()].reshape(b.shape)


def _each(function: Callable[[float, float], float], offset: Any, speed: Any) -> Any:
    """The function of every offset and speed, which broadcast; each pair is worked once."""
    b, U = np.broadcast_arrays(offset, speed)
    pairs, places = np.unique(np.stack([b.ravel(), U.ravel()]), axis=1, return_inverse=True)
    found = np.array([function(*pair) for pair in pairs.T.tolist()])
    return found[places.ravel()].reshape(b.shape) if b.shape else float(found[0])


def limit_at(scene: Scene, offset: Any) -> StickLimit:
    """The law of a tip that sticks at offsets b/R >= 0, where a light cue end leaves the force along the cue.

    Then F_t = F_n tan(phi). With D = 1 + 1/Q0 + sin(phi)^2/nu the contact is that of the mass M cos(phi)^2/D, of the
    length T cos(phi) sqrt((1 + 1/Q0)/D), and the tip's velocity runs as K P - 1, K = (1 + e)(1 + 1/nu + 1/Q0)/D.
    """
    limit, q = StickLimit.of(scene), scene.ball.mass / scene.axial_mass
    share = (1 + q) / (1 + q + offset**2 / scene.ball.inertia)
    return replace(limit, K=limit.K * share, T=limit.T * np.sqrt((1 - offset**2) * share))


def _end_mass_at(tip: TipModes, scene: Scene, offset: Any) -> Any:
    limit = limit_at(scene, offset)
    try:
        return limit.end_mass(stick_impulse(tip, limit))
    except ValueError:
        where = f"offset {offset:g}" if np.ndim(offset) == 0 else f"offsets from {offset.min():g} to {offset.max():g}"
        raise ValueError(f"end_mass drive 'offset': a tip that sticks has no end mass's squirt; got {where}") from None


def _stuck_end_mass(tip: TipModes, scene: Scene) -> float:
    if scene.stroke.offset == 0:
        return stick(tip, scene)
    return _with_squirt(sticking_squirt(tip, scene), _gripping(scene), "offset")


def stick_impulse(tip: TipModes, limit: StickLimit) -> Any:
    """J of a cue without effects at the tip, kg: in closed form, or for modes that are damped or radiate in time."""
    if tip.resistance is None:
        return limit.transverse_impulse(*flexible(tip))
    return damped.stick_impulse(tip, limit)


def ringing(tip: TipModes, limit: StickLimit) -> float:
    """Estimated relative error of the stick end mass of modes that end in a tail.

    The step of velocity at first touch sets the tail vibrating, and its dashpot takes that away. If instead it rang on
    without loss, as a metal tip does on wood at 100 to 250 kHz, the impulse J would swing by residue/W for each of its
    vibrations W; `HEARD` of that is the estimate.
    """
    assert tip.radiation is not None
    tail = int(np.sum(tip.radiation.any(axis=1) & (tip.amplitude[:, 1] != 0)))
    omega, phi, rigid = flexible(tip)
    felt = float(limit.end_mass(limit.transverse_impulse(omega, phi, rigid)))
    return HEARD * limit.ringing(omega, phi, rigid, tail=tail) * (1 + felt * limit.c)  # end mass goes with J so


def flexible(tip: TipModes) -> tuple[Array, Array, float]:
    """(omega, phi) of the modes that vibrate across the cue, and the sum of the rigid ones' phi^2."""
    omega, phi = tip.transverse
    if len(phi) == 0:
        raise ValueError("end_mass: a clamp holds the tip across the cue, so its end mass is infinite")
    moving = omega > 0
    return omega[moving], phi[moving], float(np.sum(phi[~moving] ** 2))


def small_offset_slope(tip: TipModes, scene: Scene) -> float:
    """Squirt over phi in the limit b -> 0 of the coupled strike: a strike at b/R = 1e-5 that sticks from the start.

    The first slip vanishes in the limit, like sqrt(b); endless friction takes it out, and leaves an error of b^2.
    """
    small = replace(scene, stroke=Stroke(scalar("Stroke.speed", scene.stroke.speed), 1e-5))
    return sticking_squirt(tip, small) / float(small.stroke.angle)


def sticking_squirt(tip: TipModes, scene: Scene) -> float:
    """Squirt, rad, away from the side struck, of a coupled strike with endless friction, for all that is pressed."""
    outcome = strike_modes(_gripping(scene), tip)
    # past the peak of a tip without restitution nothing presses, but endless friction would go on pulling
    p_t, p_n = np.sum([phase.impulse for phase in outcome.phases if phase.press != "rigid"], axis=0)
    return float(abs(scene.stroke.angle) - math.atan2(p_t, p_n))


def _gripping(scene: Scene) -> Scene:
    return replace(scene, tip=replace(scene.tip, friction=math.inf))


def squirt_equivalent(tip: TipModes, scene: Scene) -> float:
    """The lumped end mass whose impulse-solver squirt equals that of the coupled strike, kg; head on its limit, stick.

    ValueError where there is none: see `equivalent_end_mass`.
    """
    return stick(tip, scene) if scene.stroke.offset == 0 else equivalent_end_mass(strike_modes(scene, tip), scene)


def equivalent_end_mass(outcome: Outcome, scene: Scene) -> float:
    """The lumped end mass, kg, whose impulse-solver squirt is that of a scene's outcome, off centre.

    ValueError where the strike miscued: a sliding tip's squirt does not depend on the end mass.
    """
    if outcome.regime == "miscue":
        raise ValueError(
            f"end_mass drive 'squirt': the stroke miscues at offset {scene.stroke.offset}; got no end mass"
        )
    return _with_squirt(float(np.sign(scene.stroke.offset) * outcome.squirt), scene, "squirt")


def _with_squirt(squirt: float, scene: Scene, drive: Drive) -> float:
    """The lumped end mass, kg, whose impulse-solver squirt is ``squirt``, rad, away from the side struck."""
    side = np.sign(scene.stroke.offset)

    def excess(log_mass: float) -> float:
        lumped = LumpedCue(scene.axial_mass, math.exp(log_mass))
        return float(side * impact(replace(scene, cue=lumped, effects=())).squirt) - squirt

    low, high = math.log(1e-9), math.log(1e3)
    if not excess(low) < 0 < excess(high):
        raise ValueError(
            f"end_mass drive {drive!r}: no lumped end mass in [1e-9, 1e3] kg has the squirt {squirt:.6g} rad"
        )
    return math.exp(zero(excess, low, high))
