"""Figures of cues and strokes for researchers: each function draws on a matplotlib axes and returns it.

>>> import matplotlib
>>> matplotlib.use("agg")
>>> import cuefem as cf
>>> from cuefem import plot
>>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
>>> scene = cf.Scene(cf.Cue((cf.Segment(0.7, 0.012, 0.021, wood),), 0.43), stroke=cf.Stroke(offset=0.3))
>>> axes = plot.forces(scene)
>>> axes.get_xlabel()
'time, ms'
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from cuefem.beam.modes import modes as solved_modes
from cuefem.contact.strike import strike
from cuefem.cue import Cue, Material
from cuefem.design.sensitivity import sensitivity
from cuefem.quantity.fields import check_count, check_kind
from cuefem.results.quantities import scaled, with_heading, with_unit
from cuefem.results.solved_design import coupled_curve, course
from cuefem.scene import Outcome, Resolution, Scene
from cuefem.scene.solved_scene import Solved

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["end_mass", "forces", "modes", "shaft", "squirt"]


def __dir__() -> list[str]:
    """What a person looks for here, without what the module imports."""
    return __all__


PLOT_OFFSETS = tuple(np.round(np.arange(0.0, 0.525, 0.025), 3).tolist())
FROM_TIP, TIME = with_heading("from the tip", "m"), with_heading("time", "s")
_SOFT, _WOODY, _METAL = 1e9, (300.0, 1250.0), 2500.0  # Pa: leather and foam; kg/m3: woods, metals
_LOCAL = 5e-4  # m: where end mass lives is drawn from behind the leather, and beyond this


def _axes(axes: Axes | None) -> Axes:
    """The axes to draw on; a figure's own are made if none are given."""
    if axes is not None:
        return axes
    import matplotlib.pyplot as plt

    return plt.subplots(figsize=(6.4, 3.6), layout="constrained")[1]


def _cue_of(thing: Cue | Scene) -> Cue:
    check_kind("cue", thing, (Cue, Scene))
    return thing.shaft if isinstance(thing, Scene) else thing


def _colour(material: Material) -> str:
    """Of leather, wood, carbon, metal or plastic, told by stiffness and density."""
    if material.E < _SOFT:
        return "#8fa3b5"
    if material.rho > _METAL:
        return "#b9bcc2"
    if material.E > 5 * _SOFT and _WOODY[0] < material.rho < _WOODY[1]:
        return "#e0c697"
    return "#6b6f76" if material.E > 25 * _SOFT else "#f4efe1"


def shaft(cue: Cue | Scene, ax: Axes | None = None) -> Axes:
    """Draw a cue from its side, tip on the left; leather, wood, carbon, metal and plastics have their colours.

    Parameters
    ----------
    cue : Cue or Scene
        A cue of segments, or a scene with one.
    ax : matplotlib axes, optional
        Where to draw; by default on a new figure.

    Returns
    -------
    matplotlib axes
        Lengths along it in mm, diameters in mm at another scale.
    """
    drawn, axes = _cue_of(cue), _axes(ax)
    for segment, x in zip(drawn.segments, drawn.nodes, strict=False):
        ends = scaled([x, x + segment.length], "m")
        outer = scaled([segment.tip_diameter / 2, segment.butt_diameter / 2], "m")
        bore = scaled([segment.tip_bore / 2, segment.butt_bore / 2], "m")
        axes.fill_between(ends, -outer, outer, facecolor=_colour(segment.material), edgecolor="#555", linewidth=0.6)
        if bore.any():
            inside = "white" if segment.core is None else _colour(segment.core)
            axes.fill_between(ends, -bore, bore, facecolor=inside, edgecolor="#555", linewidth=0.4)
    axes.set(xlabel=FROM_TIP, ylabel=with_heading("radius", "m"), xlim=(0, scaled(drawn.length, "m")))
    return axes


def modes(cue: Cue | Scene, count: int = 4, ax: Axes | None = None, *, at: Resolution | None = None) -> Axes:
    """Draw the lowest bending modes of a cue, each scaled to its largest deflection.

    Parameters
    ----------
    cue : Cue or Scene
        A cue of segments, or a scene, whose effects on the cue count.
    count : int
        How many modes.
    ax : matplotlib axes, optional
        Where to draw; by default on a new figure.
    at : Resolution, optional
        As for `cuefem.modes`.

    Returns
    -------
    matplotlib axes
        Places along the cue in mm; a legend names the frequencies.
    """
    drawn, axes = _cue_of(cue), _axes(ax)
    check_count("count", count, 1)
    solved = solved_modes(drawn, count, effects=cue.cue_effects if isinstance(cue, Scene) else (), at=at)
    x = np.linspace(0, drawn.length, 400)
    for frequency, deflection in zip(solved.frequencies, solved.shape(x)[0], strict=True):
        axes.plot(scaled(x, "m"), deflection / np.abs(deflection).max(), label=f"{frequency:.0f} Hz")
    axes.axhline(0, color="#888", linewidth=0.6)
    axes.set(xlabel=FROM_TIP, ylabel="deflection", xlim=(0, scaled(drawn.length, "m")))
    axes.legend(ncols=2)
    return axes


def squirt(
    scenes: Scene | Mapping[str, Scene],
    offsets: Sequence[float] = PLOT_OFFSETS,
    ax: Axes | None = None,
    *,
    at: Resolution | None = None,
) -> Axes:
    """Draw squirt against the offset, from coupled strikes; a line ends where the stroke miscues.

    Parameters
    ----------
    scenes : Scene, or mapping of names to scenes
        Each gives a line. The offset of its own stroke does not matter.
    offsets : sequence of float
        b/R, in (-1, 1).
    ax : matplotlib axes, optional
        Where to draw; by default on a new figure.
    at : Resolution, optional
        As for `cuefem.strike`.

    Returns
    -------
    matplotlib axes
        Degrees against b/R; a cross on the line of no squirt marks the first offset at which a scene miscues:
        of a miscue (`Outcome.regime`).
    """
    named = scenes if isinstance(scenes, Mapping) else {"": scenes}
    axes = _axes(ax)
    for name, scene in named.items():
        check_kind(f"scenes[{name!r}]" if name else "scenes", scene, Scene)
        tip = Solved(scene, at).tip
        curve = coupled_curve(scene, offsets, tip)
        lost = np.array(curve["regime"]) == "miscue"
        (line,) = axes.plot(offsets, np.where(lost, np.nan, scaled(curve["squirt"], "rad")), label=name or None)
        if lost.any():
            axes.plot(np.asarray(offsets)[lost][:1], [0], "x", color=line.get_color(), clip_on=False)
    axes.set(xlabel="offset b/R", ylabel="squirt, degrees")
    if any(named):
        axes.legend()
    return axes


def forces(stroke: Scene | Outcome, ax: Axes | None = None, *, at: Resolution | None = None) -> Axes:
    """Draw the forces on the ball in the course of a coupled strike.

    Parameters
    ----------
    stroke : Scene or Outcome
        A scene, which is struck, or what `cuefem.strike` returned.
    ax : matplotlib axes, optional
        Where to draw; by default on a new figure.
    at : Resolution, optional
        As for `cuefem.strike`.

    Returns
    -------
    matplotlib axes
        Newtons against milliseconds, along the normal and along the tangent.

    Raises
    ------
    ValueError
        If the outcome has no course in time, as that of `cuefem.impulse`.
    """
    check_kind("stroke", stroke, (Scene, Outcome))
    outcome = strike(stroke, at) if isinstance(stroke, Scene) else stroke
    if outcome.history is None:
        raise ValueError("forces needs an outcome of strike; got one without a course in time")
    axes, times = _axes(ax), np.linspace(0, outcome.duration, 400)
    for label, force in course(outcome, "force", times).items():
        axes.plot(scaled(times, "s"), force, label=label)
    axes.axhline(0, color="#888", linewidth=0.6)
    axes.set(xlabel=TIME, ylabel=with_heading("force on the ball", "N"), xlim=(0, scaled(outcome.duration, "s")))
    axes.legend()
    return axes


def end_mass(scene: Scene, ax: Axes | None = None, *, at: Resolution | None = None) -> Axes:
    """Draw where the stick end mass lives: the grams that one gram more at each place would add to it.

    Parameters
    ----------
    scene : Scene
        With a cue of segments and without effects but a `LeatherTip`, of which the contact time stays, and those that
        leave the cue alone across its axis (waves along it, and thrust, which is not counted). The leather
        itself is left out: all of its mass, which sits at the tip, is end mass.
    ax : matplotlib axes, optional
        Where to draw; by default on a new figure.
    at : Resolution, optional
        As for `cuefem.end_mass`.

    Returns
    -------
    matplotlib axes
        Grams a gram against mm from the tip. A tip of soft leather is left out: its own modes lie too near the limit
        of those kept.

    Raises
    ------
    ValueError
        If the scene has other effects.
    """
    check_kind("scene", scene, Scene)
    if others := [effect for effect in scene.effects if effect.across and not effect.whole_tip]:
        names = ", ".join(sorted({type(effect).__name__ for effect in others}))
        raise ValueError(f"plot.end_mass takes a scene without effects, LeatherTip apart; got {names}")
    bare, left_out = scene, ""
    if scene.effects:
        bare = replace(scene.bare, effects=())
        left_out = f", without the {with_unit(scene.axial_mass - bare.axial_mass, 'kg', 2)} of its leather"
    drivers, axes = sensitivity(bare, at=at), _axes(ax)
    behind = drivers.x > scene.shaft.leather + _LOCAL
    axes.plot(scaled(drivers.x[behind], "m"), (drivers.rhoA + drivers.axial_mass)[behind])
    axes.axhline(0, color="#888", linewidth=0.6)
    axes.set(
        xlabel=FROM_TIP, ylabel=with_heading("end mass a gram adds", "kg"), xlim=(0, scaled(scene.shaft.length, "m"))
    )
    axes.set_title(f"end mass {with_unit(drivers.end_mass, 'kg', 3)}{left_out}", fontsize="medium")
    return axes
