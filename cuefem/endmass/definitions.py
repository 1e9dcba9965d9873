"""The definitions of effective end mass, each from the tip modes of a cue (handbook: Effective end mass).

The effective end mass m_e is the inertia that the ball feels across the cue at the tip. A vibrating cue has no single
one: how much of it takes part depends on how the tip is driven. `DEFINITIONS`, at the end of this file, is the table of
the definitions that every command, page and sweep reads. All of them follow from the tip's transverse impulse response
h(t) = sum phi_k^2 cos(omega_k t), free or damped (`cuefem.endmass.impulse_response`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from cuefem.beam.tip import TipModes
from cuefem.contact.outcome import slips_at_end
from cuefem.contact.rigid_impact import impact, numbers_of
from cuefem.contact.strike import strike_modes
from cuefem.cue import Array, LumpedCue
from cuefem.effects import Effect
from cuefem.endmass.impulse_response import ImpulseResponse
from cuefem.endmass.sticking_contact import StickLimit
from cuefem.quantity.fields import check_kind
from cuefem.scene import Outcome, Resolution, Scene, Stroke
from cuefem.scene.solved_scene import Solved

# The squirts of this many lumped cues are computed in one call, which costs as much as two single ones; a root is then
# sought between two neighbours in the same way, ZOOMS times in all.
MANY, ZOOMS = 500, 6
NEAR = 1e-5  # b/R that stands for the limit of small offsets
FLAT = 1e-12  # rad: squirts that differ by less are the same


def end_mass(scene: Scene, drive: str = "stick", at: Resolution | None = None) -> float:
    """Effective end mass m_e of a scene's cue: the inertia that the ball feels across the cue at the tip.

    Parameters
    ----------
    scene
        The cue, and what the pulse depends on. The pulse lasts the scene's head-on contact time. "stick" and "offset"
        also depend on the ball's mass and inertia factor and on the tip's restitution; "offset" and "squirt" on the
        scene's offset; "squirt" on speed and friction too.
    drive
        Which definition, by its name in `cuefem.endmass.definitions.DEFINITIONS`:

        - "stick": the tip sticks to the ball as in the coupled strike of a straight cue, in the limit of small offsets.
          Recommended.
        - "offset": the same at the scene's own offset; this is what the impulse solver takes.
        - "velocity": the tip's velocity rises like (1 - cos(pi t/T))/2.
        - "force": the tip is pushed by a half-sine force.
        - "squirt": the lumped end mass that has the squirt of the coupled strike.
    at
        How finely the cue is computed. By default modes are kept by frequency (handbook: The beam), at least 160 of
        them, or 40 for "velocity" and "force", whose drives begin smoothly, on a cue without leather drawn in. Between
        0.5 and 3 ms a stick end mass is within 0.03 % for 95 % of 50 shafts, and 0.2 % at most on 50 whole cues with
        joints and masses, of that of 400 modes, except for metal tips that stick, and "force" through soft leather in
        less than 1 ms; `cuefem.resolve_end_mass` estimates the error.

    Returns
    -------
    float
        kg. A `LumpedCue` answers its own ``end_mass``, whatever the definition.

    Raises
    ------
    ValueError
        If the definition is unknown, or has no answer for this scene (a miscue, a clamped tip).

    Notes
    -----
    Costs one eigenproblem of the beam; "stick", "offset" and "velocity" a linear solve over equal steps too.
    Definitions and formulas: handbook: Effective end mass.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> scene = cf.Scene(cue, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
    >>> round(1e3 * cf.end_mass(scene), 1), round(1e3 * cf.end_mass(scene, "offset"), 1)  # g
    (4.8, 4.4)
    """
    check_kind("end_mass scene", scene, Scene)
    definition = definition_of(drive)
    if scene.lumped is not None:
        return scene.lumped.end_mass
    return definition.of_solved(Solved(scene, at))


def _couples(tip: TipModes, scene: Scene) -> bool:
    """Whether the tip does not follow K P(t) - 1, so that a coupled strike must be solved."""
    along = np.any(tip.amplitude[tip.omega > 0, 0] != 0)  # rod modes change the course of the normal impulse
    return bool(along) or bool(scene.at_tip)


def definition_of(drive: str) -> Definition:
    """The definition of that name; ValueError that lists all names if no definition has it."""
    if drive not in DEFINITIONS:
        raise ValueError(f"end_mass drive must be one of {', '.join(DEFINITIONS)}; got {drive!r}")
    return DEFINITIONS[drive]


def force(tip: TipModes, scene: Scene) -> float:
    """Impulse of a half-sine force over the tip velocity at its end, kg. Converges like 1/modes^2 (it has kinks).

    A soft tip on a heavy ferrule may be at rest when the push ends, or move back: then this is huge, or negative, and
    its inverse alone is accurate.
    """
    T = float(scene.contact_time)
    return 2 * T / np.pi / ImpulseResponse.of(tip).half_sine_velocity(T)


def velocity(tip: TipModes, scene: Scene) -> float:
    """Impulse that makes the tip follow (1 - cos(pi t/T))/2, over its final velocity, kg."""
    return ImpulseResponse.of(tip).smooth_start_impulse(float(scene.contact_time))


def stick(tip: TipModes, scene: Scene) -> float:
    """End mass of the limit b -> 0 of the coupled strike, kg: `cuefem.endmass.sticking_contact.StickLimit`.

    It has the squirt of `small_offset_slope`.
    """
    limit = StickLimit.of(scene)
    return float(limit.end_mass(limit.impulse(small_offset_slope(tip, scene))))


def stick_at_offset(tip: TipModes, scene: Scene) -> float:
    """End mass of a tip that sticks from the first touch, at the scene's own offset, kg (handbook: Effective end mass).

    For a bare cue it is that of `stick` with the contact at this offset (`limit_at`), exact to first order in the
    lightness of the cue's end. With effects at the tip or axial waves it is the lumped end mass with the squirt of a
    coupled strike that never slips. The two ways differ in second order, by about 1 % at b/R 0.3. Both sides of the
    ball are alike, and head on it is `stick`. ValueError if no end mass has that squirt.
    """
    b = abs(scene.stroke.offset)
    if _couples(tip, scene):
        here = replace(scene, stroke=Stroke(scene.stroke.speed, b))
        return _with_squirt(sticking_squirt(tip, here), _gripping(here), "offset") if b else stick(tip, here)
    mass = float(_uncoupled(tip, scene, np.array([b]))[0])
    if math.isnan(mass):
        raise ValueError(f"end_mass drive 'offset': a tip that sticks has no end mass's squirt; got offset {b:g}")
    return mass


def stick_at_offsets(tip: TipModes, scene: Scene, offsets: Sequence[float]) -> list[float]:
    """`stick_at_offset` of each offset; nan where no end mass has that squirt."""
    if not _couples(tip, scene):  # one linear solve for all
        return [float(mass) for mass in _uncoupled(tip, scene, np.abs(offsets))]

    def mass(offset: float) -> float:
        try:
            return stick_at_offset(tip, replace(scene, stroke=Stroke(scene.stroke.speed, offset)))
        except ValueError:
            return math.nan

    return [mass(offset) for offset in offsets]


def _uncoupled(tip: TipModes, scene: Scene, offsets: Array) -> Array:
    limit = limit_at(scene, offsets)
    J = limit.transverse_impulse(_held(tip, StickLimit.of(scene)), scene.contact_time)
    rest = np.divide(limit.K - 1, J, out=np.full(len(J), np.nan), where=J > 0) - limit.c
    return np.divide(1.0, rest, out=np.full(len(J), np.nan), where=rest > 0)


def limit_at(scene: Scene, offset: Any) -> StickLimit:
    """The law of a tip that sticks at offsets b/R >= 0. A light cue end leaves the force along the cue.

    Then F_t = F_n tan(phi). With D = 1 + 1/Q0 + sin(phi)^2/nu the contact is that of the mass M cos(phi)^2/D, of the
    length T cos(phi) sqrt((1 + 1/Q0)/D), and the tip's velocity runs as K P - 1, K = (1 + e)(1 + 1/nu + 1/Q0)/D.
    """
    limit, q = StickLimit.of(scene), scene.ball.mass / scene.axial_mass
    share = (1 + q) / (1 + q + offset**2 / scene.ball.inertia)
    return replace(limit, K=limit.K * share, T=limit.T * np.sqrt((1 - offset**2) * share))


def _held(tip: TipModes, limit: StickLimit) -> Array:
    return ImpulseResponse.of(tip).held(limit.c, limit.T)


def small_offset_slope(tip: TipModes, scene: Scene) -> float:
    """Squirt over phi in the limit b -> 0 of the coupled strike, whose tip sticks from the start.

    `StickLimit` knows no effects at the tip (a dome, shear), no axial waves and no lumped cue: with them it is that of
    a strike at b/R = 1e-5. The first slip vanishes in the limit, like sqrt(b); endless friction takes it out, and
    leaves an error of b^2.
    """
    if scene.lumped is None and not _couples(tip, scene):
        limit = StickLimit.of(scene)
        return float(limit.slope(limit.transverse_impulse(_held(tip, limit), limit.T)))
    small = _aside(scene)
    return sticking_squirt(tip, small) / float(small.stroke.angle)


def _aside(scene: Scene) -> Scene:
    """The scene's stroke so near to the centre that squirt is in proportion to the offset."""
    return replace(scene, stroke=Stroke(scene.stroke.speed, NEAR))


def sticking_squirt(tip: TipModes, scene: Scene) -> float:
    """Squirt, rad, away from the side struck, of a coupled strike with endless friction, while tip and ball press.

    The cue is the straight one, as for all end masses but "squirt": thrust would make them fall with the speed.
    """
    p_t, p_n = strike_modes(_gripping(scene), tip.straight).impulse
    return float(abs(scene.stroke.angle) - math.atan2(p_t * np.sign(scene.stroke.offset), p_n))


def _gripping(scene: Scene) -> Scene:
    """The scene with a tip that never slips, without table and later hits, which are no part of an end mass."""

    def of_contact(effect: Effect) -> bool:
        terms = replace(scene, effects=(effect,)).contact_terms
        return terms.table is None and terms.window is None

    return replace(scene, tip=replace(scene.tip, friction=math.inf), effects=tuple(filter(of_contact, scene.effects)))


def squirt_equivalent(tip: TipModes, scene: Scene) -> float:
    """The lumped end mass whose impulse-solver squirt is that of the coupled strike, kg; head on that at b/R = 1e-5.

    ValueError if there is none: see `equivalent_end_mass`.
    """
    off_centre = scene if scene.stroke.offset else _aside(scene)
    return equivalent_end_mass(strike_modes(off_centre, tip), off_centre)


def equivalent_end_mass(outcome: Outcome, scene: Scene) -> float:
    """The lumped end mass, kg, whose impulse-solver squirt is that of a scene's outcome, off centre.

    ValueError if the tip slid up to the end, since the squirt of a sliding tip does not depend on the end mass.
    """
    if slips_at_end(outcome):
        raise ValueError(
            f"end_mass drive 'squirt': the stroke miscues at offset {scene.stroke.offset}; got no end mass"
        )
    return _with_squirt(float(np.sign(scene.stroke.offset) * outcome.squirt), scene, "squirt")


def _with_squirt(squirt: float, scene: Scene, drive: str) -> float:
    """The lumped end mass, kg, whose impulse-solver squirt is ``squirt``, rad, away from the side struck."""
    side, numbers = np.sign(scene.stroke.offset), numbers_of(scene, LumpedCue(scene.axial_mass, scene.axial_mass))

    def excess(log_mass: Any) -> Any:
        return side * impact(numbers | {"end_mass": np.exp(log_mass)}).squirt - squirt

    log_masses = np.linspace(math.log(1e-9), math.log(1e3), MANY)
    excesses = excess(log_masses)
    if not excesses[0] < -FLAT < FLAT < excesses[-1]:  # of all light lumps the tip slides at one squirt
        raise ValueError(
            f"end_mass drive {drive!r}: no single lumped end mass in [1e-9, 1e3] kg has the squirt {squirt:.6g} rad"
        )
    return math.exp(zoomed_root(excess, log_masses))


def zoomed_root(function: Callable[[Array], Array], places: Array) -> float:
    """The place, to rounding, where a function that is below zero at the first of many places first is not."""
    for _ in range(ZOOMS):
        above = int(np.argmax(function(places) >= 0))
        places = np.linspace(places[above - 1], places[above], len(places))
    return float(places[-1])


class Definition(NamedTuple):
    """One definition of the effective end mass, and what commands, pages and sweeps say of it.

    name: as `end_mass` takes it. label: in a few words. meaning: in plain English. value: the end mass of a vibrating
    cue, kg, from its tip modes and its scene. at_offset: whether it is the end mass at the scene's own offset.
    counts_tip: whether effects at the tip count in it. smooth: whether the tip starts from rest, without a step of its
    velocity, so that a strike's modes are enough.
    """

    name: str
    label: str
    meaning: str
    value: Callable[[TipModes, Scene], Any]
    at_offset: bool = False
    counts_tip: bool = False
    smooth: bool = False

    def tip_of(self, solved: Solved) -> TipModes:
        """The tip modes of a solved scene that this definition takes."""
        return solved.tip_smooth if self.smooth else solved.tip_stuck

    def of_solved(self, solved: Solved) -> Any:
        """The end mass of a solved scene, kg, from the tip modes that this definition takes."""
        return self.of(self.tip_of(solved), solved.scene)

    def of(self, tip: TipModes, scene: Scene) -> Any:
        """The end mass of any cue by this definition, kg; a lumped cue has its own whatever the definition."""
        return self.value(tip, scene) if scene.lumped is None else scene.lumped.end_mass

    def label_at(self, offset: Any) -> str:
        """The label, with the offset b/R where the definition is of the scene's own."""
        return f"{self.label} at b/R {offset:g}" if self.at_offset else self.label


# The one table of the definitions, in the order in which they are shown. What is added here is found everywhere.
DEFINITIONS: dict[str, Definition] = {
    definition.name: definition
    for definition in (
        Definition(
            *("stick", "stick, small offsets"),
            "transverse inertia of the cue at the tip in the coupled strike, in the limit of small offsets",
            stick,
            counts_tip=True,
        ),
        Definition(
            *("offset", "stick"),
            "transverse inertia of the cue at the tip in a coupled strike at this offset whose tip never slips",
            stick_at_offset,
            at_offset=True,
            counts_tip=True,
        ),
        Definition(
            *("velocity", "velocity"),
            "impulse over final velocity, for a prescribed tip velocity (1 - cos(pi t/T))/2",
            velocity,
            smooth=True,
        ),
        Definition(
            *("force", "force"),
            "impulse over final velocity, for a prescribed half-sine force of duration T",
            force,
            smooth=True,
        ),
        Definition(
            *("squirt", "squirt-equivalent"),
            "the end mass whose squirt in the impulse solver (restitution, friction) is that of the coupled strike",
            squirt_equivalent,
            at_offset=True,
            counts_tip=True,
        ),
    )
}
