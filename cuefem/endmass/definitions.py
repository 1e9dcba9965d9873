"""The definitions of effective end mass, each from the tip modes of a cue (handbook: Effective end mass).

The effective end mass m_e is the transverse inertia of the cue at the tip. A vibrating cue has no single one: it
depends on how the tip is driven. `DEFINITIONS`, at the end of this file, is the table of definitions for commands,
pages and sweeps. All of them follow from the tip's transverse impulse response
h(t) = sum phi_k^2 cos(omega_k t), free or damped (`cuefem.endmass.impulse_response`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Literal, NamedTuple

import numpy as np

from cuefem.beam.blas_threads import one_blas_thread
from cuefem.beam.tip_modes import TipModes
from cuefem.contact.impulse_solver import impacts, impulse_inputs
from cuefem.contact.outcome import slips_at_end
from cuefem.contact.refinement import check_one_resolution, refined_end_mass
from cuefem.contact.strike import strike_modes
from cuefem.cue import Array, LumpedCue
from cuefem.effects.effect import Effect
from cuefem.endmass.impulse_response import PULSE_STEPS, half_sine_velocity, imposed_velocity_impulse
from cuefem.endmass.sticking_contact import StickLimit
from cuefem.scene import Outcome, Resolution, Scene, Stroke, check_scene
from cuefem.scene.solved_scene import SolvedScene

# The squirts of this many lumped cues are computed in one call, which costs as much as two single ones. The root is
# then bracketed by two neighbours and refined in the same way; between the last two, 1e-7 apart, squirt is linear.
SEARCH_POINTS = 500
SEARCH_ROUNDS = 2  # rounds of refinement
SMALL_OFFSET = 1e-5  # b/R in the limit of small offsets
SQUIRT_TOLERANCE = 1e-12  # rad: squirts that differ by less are equal

Drive = Literal["stick", "offset", "velocity", "force", "squirt"]


def end_mass(scene: Scene, drive: Drive = "stick", at: Resolution | None = None, *, rtol: float | None = None) -> float:
    """Effective end mass m_e of a scene's cue: its transverse inertia at the tip.

    Parameters
    ----------
    scene
        The cue, and the impact. The pulse lasts the scene's contact time of a centre-ball impact. "stick" and "offset"
        also depend on the ball's mass and inertia factor and on the tip's restitution; "offset" and "squirt" on the
        scene's offset; "squirt" on speed and friction too.
    drive
        Name of a definition in `cuefem.endmass.definitions.DEFINITIONS`:

        - "stick": the tip sticks to the ball as in the coupled strike of a straight cue, in the limit of small offsets.
          Recommended.
        - "offset": the same at the scene's own offset, as in the impulse solver.
        - "velocity": the tip's velocity is prescribed as (1 - cos(pi t/T))/2.
        - "force": a half-sine force acts on the tip.
        - "squirt": the lumped end mass with the squirt of the coupled strike.
    at
        A `Resolution`. By default "stick" and "offset" retain 160 modes, "force" and "velocity" 80; "squirt", and all
        that stick through a leather tip, those of a strike.
        At contact times of 0.5 to 3 ms, a stick end mass differs from that of 400 modes by less than 0.1 % for 95 % of
        random cues, and by at most 0.2 %. Exceptions are metal tips that stick, and "force" through soft leather in
        less than 1 ms.
    rtol
        In place of ``at``: the requested relative accuracy, in (0, 1). The number of modes is refined, up to 400,
        until its estimated error is within it.

    Returns
    -------
    float
        kg. Of a `LumpedCue` its own ``end_mass``, whatever the definition.

    Raises
    ------
    ValueError
        If the definition is unknown, or has no value for this scene (a miscue, a clamped tip); if rtol is out of
        bounds, or beside ``at``.
    RuntimeError
        If even 400 modes do not reach ``rtol``.

    Notes
    -----
    The cost is one eigenproblem of the beam; "stick", "offset" and "velocity" add a linear solve over equal steps.
    Definitions and formulas: handbook: Effective end mass.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> scene = cf.Scene(cue, tip=cf.Tip(contact_time=1e-3), stroke=cf.Stroke(offset=0.3))
    >>> round(1e3 * cf.end_mass(scene), 1), round(1e3 * cf.end_mass(scene, "offset"), 1)  # g
    (4.8, 4.4)
    >>> abs(cf.end_mass(scene, rtol=1e-3) / cf.end_mass(scene) - 1) < 1e-3
    True
    """
    check_scene("end_mass scene", scene)
    definition = definition_of(drive)
    if rtol is not None:
        check_one_resolution("end_mass", at)
        return refined_end_mass(lambda tip: float(definition.of(tip, scene)), scene, rtol)
    if scene.lumped is not None:
        return scene.lumped.end_mass
    return definition.of_design(SolvedScene(scene, at))


def _needs_strike(tip: TipModes, scene: Scene) -> bool:
    """Whether a coupled strike must be solved, since the tip's velocity is not K P(t) - 1, P the normal impulse.

    Axial modes and effects at the tip change the history of the normal impulse.
    """
    has_axial_modes = np.any(tip.amplitude[tip.omega > 0, 0] != 0)
    return bool(has_axial_modes) or bool(scene.at_tip)


def definition_of(drive: str) -> Definition:
    """The definition of that name; ValueError that lists all names if no definition has it."""
    if drive not in DEFINITIONS:
        raise ValueError(f"end_mass drive must be one of {', '.join(DEFINITIONS)}; got {drive!r}")
    return DEFINITIONS[drive]


def force(tip: TipModes, scene: Scene) -> float:
    """Impulse of a half-sine force over the final tip velocity, kg; its kinks make the error fall like 1/modes^2.

    A soft tip on a heavy ferrule may be almost at rest when the force ends: the value is then huge, and only its
    inverse is accurate. If the tip moves back, `Definition.of` refuses the value.
    """
    T = float(scene.contact_time)
    return 2 * T / np.pi / half_sine_velocity(tip, T)


def velocity(tip: TipModes, scene: Scene) -> float:
    """Impulse for the tip velocity (1 - cos(pi t/T))/2, over the final velocity, kg."""
    raised_cosine = (1 - np.cos(np.pi * np.linspace(0.0, 1.0, PULSE_STEPS + 1))) / 2
    return imposed_velocity_impulse(tip, float(scene.contact_time), raised_cosine)


def stick(tip: TipModes, scene: Scene) -> float:
    """End mass of the limit b -> 0 of the coupled strike, kg: `cuefem.endmass.sticking_contact.StickLimit`.

    It has the squirt of `small_offset_slope`.
    """
    limit = StickLimit.of(scene)
    return limit.end_mass(small_offset_slope(tip, scene) * limit.normal)


def stick_at_offset(tip: TipModes, scene: Scene) -> float:
    """End mass of a tip that sticks from the first touch, at the scene's own offset, kg (handbook: Effective end mass).

    For a bare cue it is that of `stick` with the contact at this offset (`limit_at`), exact to first order in the mass
    ratio of the cue's end. With effects at the tip or axial waves it is the lumped end mass with the squirt of a
    coupled strike without slip. The two differ in second order of the offset. It is even in the offset, and equals
    `stick` at the centre. ValueError if no end mass has that squirt.
    """
    b = abs(scene.stroke.offset)
    if _needs_strike(tip, scene):
        scene = replace(scene, stroke=Stroke(scene.stroke.speed, b))
        return _with_squirt(sticking_squirt(tip, scene), without_slip(scene), "offset") if b else stick(tip, scene)
    limit = limit_at(scene, b)
    return limit.end_mass(limit.transverse_impulse(tip))


def stick_at_offsets(tip: TipModes, scene: Scene, offsets: Sequence[float]) -> list[float]:
    """`stick_at_offset` at each offset, kg; nan where no end mass has that squirt, or none is found."""

    def mass(offset: float) -> float:
        try:
            return stick_at_offset(tip, replace(scene, stroke=Stroke(scene.stroke.speed, offset)))
        except (ValueError, RuntimeError):
            return math.nan

    return [mass(offset) for offset in offsets]


def limit_at(scene: Scene, offset: float) -> StickLimit:
    """The contact of a tip that sticks at an offset b/R >= 0. With a light cue end, the force is axial.

    Then F_t = F_n tan(phi). With D = 1 + 1/Q0 + sin(phi)^2/nu the contact is that of the mass M cos(phi)^2/D, of the
    length T cos(phi) sqrt((1 + 1/Q0)/D), and the tip's velocity is K P - 1, K = (1 + e)(1 + 1/nu + 1/Q0)/D.
    """
    limit, q = StickLimit.of(scene), scene.ball.mass / scene.axial_mass
    share = (1 + q) / (1 + q + offset**2 / scene.ball.inertia)
    return limit._replace(K=limit.K * share, T=limit.T * math.sqrt((1 - offset**2) * share))


def small_offset_slope(tip: TipModes, scene: Scene) -> float:
    """Squirt over phi in the limit b -> 0 of the coupled strike, whose tip sticks from the start.

    `StickLimit` excludes effects at the tip (a dome, shear), axial waves and lumped cues: with them it is that of a
    strike at b/R = 1e-5. The initial slip vanishes in the limit, like sqrt(b); infinite friction removes it, which
    leaves an error of b^2. Geometric stiffness is excluded: see `coupled_slope`.
    """
    if scene.lumped is None and not _needs_strike(tip, scene):
        limit = StickLimit.of(scene)
        return limit.transverse_impulse(tip) / limit.normal
    near_centre = _near_centre(scene)
    return sticking_squirt(tip, near_centre) / float(near_centre.stroke.angle)


def coupled_slope(tip: TipModes, scene: Scene) -> float:
    """As `small_offset_slope`, with geometric stiffness, as a strike at the scene's speed has it."""
    if tip.geometric is None:
        return small_offset_slope(tip, scene)
    near_centre = _near_centre(scene)
    return _stuck_squirt(tip, near_centre) / float(near_centre.stroke.angle)


def _near_centre(scene: Scene) -> Scene:
    """The scene's stroke at an offset so small that squirt is proportional to it."""
    return replace(scene, stroke=Stroke(scene.stroke.speed, SMALL_OFFSET))


def sticking_squirt(tip: TipModes, scene: Scene) -> float:
    """Squirt, rad, away from the side struck, of a sticking tip: that of end masses.

    Geometric stiffness is excluded, as for all end masses but "squirt": it would make them fall with the speed.
    """
    return _stuck_squirt(tip.without_geometric_stiffness, scene)


def _stuck_squirt(tip: TipModes, scene: Scene) -> float:
    """Squirt, rad, away from the side struck, of a coupled strike with infinite friction, up to separation."""
    p_t, p_n = strike_modes(without_slip(scene), tip).impulse
    return float(abs(scene.stroke.angle) - math.atan2(p_t * np.sign(scene.stroke.offset), p_n))


def without_slip(scene: Scene) -> Scene:
    """The scene with infinite friction, without the table and double hits, which do not belong to an end mass."""

    def in_contact(effect: Effect) -> bool:
        terms = replace(scene, effects=(effect,)).contact_terms
        return terms.table is None and terms.window is None

    return replace(scene, tip=replace(scene.tip, friction=math.inf), effects=tuple(filter(in_contact, scene.effects)))


def squirt_equivalent(tip: TipModes, scene: Scene, squirt_factor: float = 1.0) -> float:
    """The lumped end mass with the squirt of the coupled strike, kg; at the centre that at b/R = 1e-5.

    squirt_factor: of a calibration, calibrated over computed squirt. ValueError if no end mass has this squirt: see
    `equivalent_end_mass`.
    """
    off_centre = scene if scene.stroke.offset else _near_centre(scene)
    return equivalent_end_mass(strike_modes(off_centre, tip), off_centre, squirt_factor)


def equivalent_end_mass(outcome: Outcome, scene: Scene, squirt_factor: float = 1.0) -> float:
    """The lumped end mass, kg, whose impulse-solver squirt is that of a scene's outcome, off centre.

    squirt_factor: of a calibration, calibrated over computed squirt.

    ValueError for a miscue, or if the tip slips until separation: squirt then does not depend on the end mass.
    """
    if outcome.regime == "miscue" or slips_at_end(outcome):
        raise ValueError(f"the stroke miscues at b/R {scene.stroke.offset:.4g}: its squirt has no end mass")
    return _with_squirt(float(np.sign(scene.stroke.offset) * squirt_factor * outcome.squirt), scene, "squirt")


def _with_squirt(squirt: float, scene: Scene, drive: str) -> float:
    """The lumped end mass, kg, whose impulse-solver squirt is ``squirt``, rad, away from the side struck."""
    # any end mass that causes no `PlausibilityWarning`: the search replaces it
    cue, masses = LumpedCue(scene.axial_mass, 0.01), np.geomspace(1e-9, 1e3, SEARCH_POINTS)
    mass = lumped_number("end_mass", masses, squirt, scene=scene, cue=cue)
    if mass is None:
        raise ValueError(
            f"end_mass drive {drive!r}: no single lumped end mass in [1e-9, 1e3] kg has the squirt {squirt:.6g} rad"
        )
    return mass


def lumped_number(name: str, values: Array, squirt: float, *, scene: Scene, cue: LumpedCue) -> float | None:
    """The smallest value of the field ``name`` of a lumped cue, to round-off error, at which its squirt is ``squirt``.

    values: ascending, (n,), the range. squirt: rad, away from the side struck. None unless squirt is smaller at the
    lower end of the range and larger at the upper: light end masses, whose tip slips until separation, have one squirt.
    """
    side, inputs = np.sign(scene.stroke.offset), impulse_inputs(scene, cue)

    def excess(values: Array) -> Array:
        return np.asarray(side * impacts(inputs._replace(**{name: values})).squirt - squirt)

    excesses = excess(values)
    if not excesses[0] < -SQUIRT_TOLERANCE < SQUIRT_TOLERANCE < excesses[-1]:
        return None
    for _ in range(SEARCH_ROUNDS):
        index = int(np.argmax(excesses >= 0))
        values = np.linspace(values[index - 1], values[index], len(values))
        excesses = excess(values)
    index = int(np.argmax(excesses >= 0))
    below, above = excesses[index - 1], excesses[index]
    return float(values[index - 1] + (values[index] - values[index - 1]) * below / (below - above))


class Definition(NamedTuple):
    """One definition of the effective end mass, for commands, pages and sweeps.

    name: the ``drive`` of `end_mass`. label: a short title. meaning: one sentence. value: the end mass of a vibrating
    cue, kg, from its tip modes and its scene. at_offset: whether it is the end mass at the scene's own offset.
    includes_tip: whether it includes effects at the tip. tip_modes: those of a solved scene that the definition needs,
    by default those of a tip that sticks.
    """

    name: Drive
    label: str
    meaning: str
    value: Callable[[TipModes, Scene], Any]
    at_offset: bool = False
    includes_tip: bool = False
    tip_modes: Callable[[SolvedScene], TipModes] = lambda solved: solved.stick_tip

    def of_design(self, design: SolvedScene, scene: Scene | None = None) -> Any:
        """The end mass of a solved scene, kg; or of a ``scene`` that differs from it only in the stroke."""
        return self.of(self.tip_modes(design), scene or design.scene)

    @one_blas_thread
    def of(self, tip: TipModes, scene: Scene) -> Any:
        """The end mass of any cue by this definition, kg; of a lumped cue its `LumpedCue.end_mass`.

        ValueError if it is not positive: soft leather, or a support near the tip, drives the tip back before the
        contact ends.
        """
        if scene.lumped is not None:
            return scene.lumped.end_mass
        mass = self.value(tip, scene)
        if not mass > 0:
            raise ValueError(
                f"end_mass drive {self.name!r}: the tip must move with the impulse when the contact ends; it moves "
                f"back (impulse over velocity {mass:.4g} kg): move supports away from the tip, or shorten the contact"
            )
        return mass

    def label_at(self, offset: Any) -> str:
        """The label, with the offset b/R if the definition depends on it."""
        return f"{self.label}, b/R {offset:.4g}" if self.at_offset else self.label


# The table of definitions, in the order of display. An entry added here appears in commands, pages and sweeps.
DEFINITIONS: dict[str, Definition] = {
    definition.name: definition
    for definition in (
        Definition(
            name="stick",
            label="stick, small offsets",
            meaning="transverse inertia of the cue at the tip in the coupled strike, in the limit of small offsets",
            value=stick,
            includes_tip=True,
        ),
        Definition(
            name="offset",
            label="stick at offset",
            meaning="transverse inertia of the cue at the tip in a coupled strike at this offset whose tip never slips",
            value=stick_at_offset,
            at_offset=True,
            includes_tip=True,
        ),
        Definition(
            name="velocity",
            label="velocity",
            meaning="impulse over final velocity, for a prescribed tip velocity (1 - cos(pi t/T))/2",
            value=velocity,
            tip_modes=lambda solved: solved.pulse_tip,
        ),
        Definition(
            name="force",
            label="force",
            meaning="impulse over final velocity, for a prescribed half-sine force of duration T",
            value=force,
            tip_modes=lambda solved: solved.pulse_tip,
        ),
        Definition(
            name="squirt",
            label="squirt-equivalent",
            meaning=(
                "the end mass whose squirt in the impulse solver (restitution, friction) is that of the coupled strike"
            ),
            value=squirt_equivalent,
            at_offset=True,
            includes_tip=True,
            tip_modes=lambda solved: solved.tip,
        ),
    )
}
