"""The coupled strike: the vibrating shaft meets the ball in time (handbook: The strike); one, or many at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from cuefem.beam.blas_threads import one_blas_thread
from cuefem.beam.tip_modes import TipModes
from cuefem.contact.contact_model import model_of
from cuefem.contact.refinement import check_one_resolution, refined_strike
from cuefem.contact.step_records import solve_contact
from cuefem.scene import Outcome, Outcomes, Resolution, Scene, as_scenes, check_scene
from cuefem.scene.solved_scene import has_moment_arm, strike_mode_count, tip_modes_of
from cuefem.solid.solid_resolution import Solid


def strike(scene: Scene, at: Resolution | Solid | None = None, *, rtol: float | None = None) -> Outcome:
    """Strike a ball with a vibrating cue and compute the contact in time.

    Parameters
    ----------
    scene : Scene
        What is there and which physics acts.
    at : Resolution or Solid, optional
        Resolution of the cue: a truncated sum over the requested modes of a beam or a solid. By default the modes of a
        beam are chosen by frequency and the truncated ones corrected, so that squirt is within 0.1 % for 95 % of
        default strikes (studies/accuracy/accuracy.md). A lumped cue needs none.
    rtol : float, optional
        In place of ``at``: the requested accuracy, in (0, 1), the largest relative error of squirt, ball speed and
        spin. Modes and steps are refined until the estimated error is within it: an estimate, no bound (handbook:
        Accuracy).

    Returns
    -------
    Outcome
        With ``rtol``, its ``error`` is the estimated error. Its ``phases`` are `cuefem.contact.outcome.Phase`; its
        ``history`` has forces and velocities at any time. Its ``energy`` names "ball translation", "ball rotation",
        "cue" (rigid-body modes), "cue vibration", "tip loss" and "friction loss", and what effects add.

    Raises
    ------
    ValueError
        For effects that cannot act together, or a restitution below 0.05 (0.1 beside `LeatherTip`); `cuefem.impulse`
        takes any. If rtol is out of bounds, or beside ``at``.
    RuntimeError
        If the ball does not separate from the cue, or friction turns the tip away from it again and again, or the
        finest level of refinement does not reach ``rtol``.

    Notes
    -----
    The cue's modes, the tip and the ball are one system. Over a step the forces of the contact are constant, and the
    modes answer them exactly; the force-indentation law acts at mid-step and friction is a return mapping (Moreau 1988,
    Jean 1999). Second order in the step; the error of the default steps: handbook: The contact.

    A refinement begins at the default number of modes, or for a restitution below 0.5 at that of a contact which is as
    short as the unloading, 2 e of the time. Each level has 1.4 times the modes, up to 400, or twice the
    steps, whichever contribute more to the error: the differences from the previous levels of both, with squirt
    relative to its magnitude or to 0.01 sin(phi) rad if that is larger, since squirt may vanish. Close to a separation
    or a double hit more modes may change the sequence of contacts: agreement of levels then proves little.

    Examples
    --------
    >>> import math
    >>> import cuefem as cf
    >>> outcome = cf.strike(cf.Scene(cf.LumpedCue(0.54, 0.01), stroke=cf.Stroke(speed=2.0, offset=0.3)))
    >>> outcome.regime
    'stick'
    >>> round(math.degrees(outcome.squirt), 3)
    2.187
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> cf.strike(cf.Scene(cue, stroke=cf.Stroke(offset=0.3)), rtol=1e-2).error < 1e-2
    True
    """
    check_scene("strike scene", scene)
    if rtol is not None:
        check_one_resolution("strike", at)
        return refined_strike(scene, rtol)
    return strike_modes(scene, tip_modes_of(scene, at), steps=steps_of(at))


def steps_of(at: Resolution | Solid | None) -> int | None:
    """Steps of a resolution; None for the default."""
    return at.steps if isinstance(at, Resolution) else None


@one_blas_thread
def strike_modes(scene: Scene, tip: TipModes, *, steps: int | None = None) -> Outcome:
    """The strike of a cue represented by its tip modes, as `strike`; steps: `Resolution.steps`.

    Strikes with the same tip modes share what belongs to the cue.
    """
    return solve_contact(model_of(scene, tip), steps=steps).outcome


def batch_strike(scenes: Sequence[Scene], at: Resolution | None = None) -> Outcomes:
    """Strike many balls with vibrating cues: the results of `cuefem.strike` as arrays.

    Parameters
    ----------
    scenes
        One scene a strike, of any cues and effects. Scenes that differ only in ball, tip and stroke share their modes
        at the same resolution.
    at
        As in `cuefem.strike`, for all; by default each scene's own.

    Returns
    -------
    Outcomes
        Arrays with one entry a scene, vectors (scenes, 2); ``outcomes[i]`` is one `Outcome`, ``outcomes.to_frame()`` a
        pandas frame.

    Raises
    ------
    TypeError
        If ``scenes`` is not a sequence of scenes.
    ValueError, RuntimeError
        As `cuefem.strike`, with the number of the scene in front, from 0 on.

    Notes
    -----
    Times of strikes and modes: studies/accuracy/speed.md.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> cue = cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), body_mass=0.43)
    >>> scenes = [cf.Scene(cue, stroke=cf.Stroke(2.0, offset)) for offset in (0.1, 0.2, 0.3)]
    >>> outcomes = cf.batch_strike(scenes, cf.Resolution(2, 10, 10))
    >>> outcomes.squirt.shape, bool(outcomes.squirt[2] > outcomes.squirt[1]), outcomes[0].regime
    ((3,), True, 'stick')
    """
    scenes = as_scenes("batch_strike scenes", scenes)
    tips: dict[Any, TipModes] = {}
    results = []
    for i, scene in enumerate(scenes):
        try:
            key = _mode_inputs(scene, at)
            tip = tips[key] = tips.get(key) or tip_modes_of(scene, at)
            results.append(strike_modes(scene, tip, steps=steps_of(at)))
        except (ValueError, RuntimeError) as error:
            error_type = ValueError if isinstance(error, ValueError) else RuntimeError
            raise error_type(f"scene {i}: {error}") from error
    return Outcomes.of(results)


def _mode_inputs(scene: Scene, at: Resolution | None) -> tuple[Any, ...]:
    """Inputs that determine the tip modes of a scene."""
    if scene.lumped is not None:
        return (scene.lumped,)
    return scene.cue, scene.cue_effects, float(scene.axial_mass), has_moment_arm(scene), at or strike_mode_count(scene)
