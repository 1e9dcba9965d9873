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
from typing import TYPE_CHECKING, Any

import numpy as np

from cuefem.beam.modes import modes as solved_modes
from cuefem.contact.strike import strike
from cuefem.cue import Cue, Material
from cuefem.endmass.end_mass_density import end_mass_density
from cuefem.quantity.display_units import END_MASS, to_display, with_heading, with_unit
from cuefem.quantity.fields import check_count, check_kind
from cuefem.results.solved_design import coupled_curve, time_history
from cuefem.scene import Outcome, Resolution, Scene, check_scene
from cuefem.scene.solved_scene import SolvedScene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from cuefem.analysis.reduction import Reduction

__all__ = ["end_mass", "forces", "modes", "reduction", "shaft", "squirt"]


def __dir__() -> list[str]:
    """The public names, for completion in a Python session."""
    return __all__


PLOT_OFFSETS = tuple(np.round(np.arange(0.0, 0.525, 0.025), 3).tolist())
FROM_TIP, TIME = "from the front of the drawing", "time"
_SOFT, _WOODY, _METAL = 1e9, (300.0, 1250.0), 2500.0  # Pa: leather and foam; kg/m3: woods, metals
_RESOLVED = 0.3  # m from the tip: modes resolve the end-mass distribution up to here
_ABOVE: dict[str, Any] = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0), "ncols": 4}  # a legend off the curves
_LOCAL = 5e-4  # m behind the leather: the end-mass distribution is drawn from here


def _axes(axes: Axes | None) -> Axes:
    """The axes to draw on; those of a new figure by default."""
    if axes is not None:
        return axes
    import matplotlib.pyplot as plt

    return plt.subplots(figsize=(6.4, 3.6), layout="constrained")[1]


def _cue_of(thing: Cue | Scene) -> Cue:
    check_kind("cue", thing, (Cue, Scene))
    return thing.shaft if isinstance(thing, Scene) else thing


def _colour(material: Material) -> str:
    """The colour of leather, foam, wood, carbon, metal or plastic, by Young's modulus and density."""
    if material.E < _SOFT:
        return "#8fa3b5" if material.rho > _WOODY[0] else "#f2e6b5"
    if material.rho > _METAL:
        return "#b9bcc2"
    if material.E > 5 * _SOFT and _WOODY[0] < material.rho < _WOODY[1]:
        return "#e0c697"
    return "#6b6f76" if material.E > 25 * _SOFT else "#f4efe1"


def shaft(cue: Cue | Scene, ax: Axes | None = None) -> Axes:
    """Draw a cue from the side, tip on the left; colours show leather, wood, carbon, metal and plastics.

    Parameters
    ----------
    cue : Cue or Scene
        A cue of segments, or a scene with one.
    ax : matplotlib axes, optional
        Where to draw; by default on a new figure.

    Returns
    -------
    matplotlib axes
        Axial positions in mm, radii in mm at another scale.
    """
    drawn, axes = _cue_of(cue), _axes(ax)
    for segment, x in zip(drawn.segments, drawn.nodes, strict=False):
        ends = to_display([x, x + segment.length], "m")
        outer = to_display([segment.tip_diameter / 2, segment.butt_diameter / 2], "m")
        bore = to_display([segment.tip_bore / 2, segment.butt_bore / 2], "m")
        axes.fill_between(ends, -outer, outer, facecolor=_colour(segment.material), edgecolor="#555", linewidth=0.6)
        if bore.any():
            inside = "white" if segment.core is None else _colour(segment.core)
            axes.fill_between(ends, -bore, bore, facecolor=inside, edgecolor="#555", linewidth=0.4)
    axes.set(
        xlabel=with_heading(FROM_TIP, "m"), ylabel=with_heading("radius", "m"), xlim=(0, to_display(drawn.length, "m"))
    )
    return axes


def modes(cue: Cue | Scene, count: int = 4, ax: Axes | None = None, *, at: Resolution | None = None) -> Axes:
    """Draw the lowest bending modes of a cue, each scaled to its largest deflection.

    Parameters
    ----------
    cue : Cue or Scene
        A cue of segments, or a scene, which includes its effects on the cue.
    count : int
        Number of modes.
    ax : matplotlib axes, optional
        Where to draw; by default on a new figure.
    at : Resolution, optional
        As for `cuefem.modes`.

    Returns
    -------
    matplotlib axes
        Positions along the cue in mm; the legend lists the natural frequencies.
    """
    drawn, axes = _cue_of(cue), _axes(ax)
    check_count("count", count, 1)
    solved = solved_modes(drawn, count, effects=cue.cue_effects if isinstance(cue, Scene) else (), at=at)
    x = np.linspace(0, drawn.length, 400)
    for frequency, deflection in zip(solved.frequencies, solved.shape(x)[0], strict=True):
        axes.plot(to_display(x, "m"), deflection / np.abs(deflection).max(), label=f"{frequency:.0f} Hz")
    axes.axhline(0, color="#888", linewidth=0.6)
    axes.set(
        xlabel=with_heading(FROM_TIP, "m"),
        ylabel="deflection over its maximum",
        xlim=(0, to_display(drawn.length, "m")),
    )
    axes.legend(**_ABOVE)
    return axes


def squirt(
    scenes: Scene | Mapping[str, Scene],
    offsets: Sequence[float] = PLOT_OFFSETS,
    ax: Axes | None = None,
    *,
    at: Resolution | None = None,
) -> Axes:
    """Draw squirt of coupled strikes against the offset; a line ends where the stroke miscues.

    Parameters
    ----------
    scenes : Scene, or mapping of names to scenes
        A line for each; the offset of its stroke is not used.
    offsets : sequence of float
        b/R, in (-1, 1).
    ax : matplotlib axes, optional
        Where to draw; by default on a new figure.
    at : Resolution, optional
        As for `cuefem.strike`.

    Returns
    -------
    matplotlib axes
        Degrees against b/R; a cross at zero squirt marks the first offset with a miscue (`Outcome.regime`).
    """
    named = scenes if isinstance(scenes, Mapping) else {"": scenes}
    axes = _axes(ax)
    for name, scene in named.items():
        check_scene(f"scenes[{name!r}]" if name else "scenes", scene)
        tip = SolvedScene(scene, at).tip
        curve = coupled_curve(scene, offsets, tip)
        miscue = np.array(curve["regime"]) == "miscue"
        (line,) = axes.plot(offsets, np.where(miscue, np.nan, to_display(curve["squirt"], "rad")), label=name or None)
        if miscue.any():
            axes.plot(np.asarray(offsets)[miscue][:1], [0], "x", color=line.get_color(), clip_on=False)
    axes.set(xlabel="tip offset b/R", ylabel="squirt, degrees")
    if any(named):
        axes.legend()
    return axes


def forces(stroke: Scene | Outcome, ax: Axes | None = None, *, at: Resolution | None = None) -> Axes:
    """Draw the time history of the forces on the ball in a coupled strike.

    Parameters
    ----------
    stroke : Scene or Outcome
        A scene, of which the strike is computed, or the outcome of `cuefem.strike`.
    ax : matplotlib axes, optional
        Where to draw; by default on a new figure.
    at : Resolution, optional
        As for `cuefem.strike`.

    Returns
    -------
    matplotlib axes
        Normal and tangential force, N, against time, ms.

    Raises
    ------
    ValueError
        If the outcome has no time history, such as one of `cuefem.impulse`.
    """
    check_kind("stroke", stroke, (Scene, Outcome))
    outcome = strike(stroke, at) if isinstance(stroke, Scene) else stroke
    if outcome.history is None:
        raise ValueError("forces needs an outcome of strike; got one without a time history")
    axes, times = _axes(ax), np.linspace(0, outcome.duration, 400)
    for label, force in time_history(outcome, "force", times).items():
        axes.plot(to_display(times, "s"), to_display(force, "N"), label=label)
    axes.axhline(0, color="#888", linewidth=0.6)
    axes.set(
        xlabel=with_heading(TIME, "s"),
        ylabel=with_heading("force on the ball", "N"),
        xlim=(0, to_display(outcome.duration, "s")),
    )
    axes.legend(**_ABOVE)
    return axes


def end_mass(scene: Scene, ax: Axes | None = None, *, at: Resolution | None = None) -> Axes:
    """Draw the end-mass distribution along the shaft: the increase of the stick end mass by a mass of 1 g at each x.

    Parameters
    ----------
    scene : Scene
        With a cue of segments. Of effects only a `LeatherTip`, of which the contact time is used, and effects without
        transverse action (axial waves, geometric stiffness) are valid. The leather itself is excluded: all of its
        mass is at the tip and is end mass.
    ax : matplotlib axes, optional
        Where to draw; by default on a new figure.
    at : Resolution, optional
        As for `cuefem.end_mass`.

    Returns
    -------
    matplotlib axes
        Grams per gram against mm from the tip. Drawn leather is excluded: its modes are too close to the truncation
        limit.

    Raises
    ------
    ValueError
        If the scene has other effects.
    """
    check_scene("scene", scene)
    if others := [effect for effect in scene.effects if effect.changes_bending and not effect.defines_tip]:
        names = ", ".join(sorted({type(effect).__name__ for effect in others}))
        raise ValueError(f"plot.end_mass takes a scene without effects other than LeatherTip; got {names}")
    bare, excluded = scene, ""
    if scene.effects:
        bare = replace(scene.without_tip_effects, effects=())
        excluded = f", without the {with_unit(scene.axial_mass - bare.axial_mass, END_MASS, 2)} of its leather"
    drivers, axes = end_mass_density(bare, at=at), _axes(ax)
    behind = drivers.x > scene.shaft.leather_height + _LOCAL
    axes.plot(to_display(drivers.x[behind], "m"), (drivers.rhoA + drivers.axial_mass)[behind])
    axes.axhline(0, color="#888", linewidth=0.6)
    axes.set(
        xlabel=with_heading(FROM_TIP, "m"),
        ylabel=with_heading("end mass added by 1 g", END_MASS),
        xlim=(0, to_display(min(scene.shaft.length, _RESOLVED), "m")),
    )
    axes.set_title(f"end mass {with_unit(drivers.end_mass, END_MASS, 3)}{excluded}", fontsize="medium")
    return axes


def reduction(own: Reduction, axes: Sequence[Axes] | None = None) -> tuple[Axes, Axes]:
    """Draw a reduction: squirt against the offset, and the end mass against the contact time.

    Parameters
    ----------
    own : Reduction
        The result of `cuefem.reduction` for a cue of segments.
    axes : two matplotlib axes, optional
        Where to draw; by default on a new figure.

    Returns
    -------
    tuple of matplotlib axes
        Degrees against b/R, of the given end masses, the reduced and the vibrating shaft; effective end mass, g,
        against ms, with the contact time of Kim's paper and the filmed one as vertical lines.
    """
    left, right = _two_axes() if axes is None else axes
    colours = {name: f"C{i}" for i, name in enumerate(own.models)}
    for name, angles in own.squirt_curves().items():
        left.plot(own.chart_offsets, to_display(angles, "rad"), color=colours[name], label=name)
    for name, masses in own.end_mass_curves().items():
        right.plot(to_display(own.chart_times, "s"), to_display(masses, END_MASS), color=colours[name])
    for time, label in own.marked_times.items():
        at = float(to_display(time, "s"))
        right.axvline(at, color="#888", linewidth=0.8, linestyle="--")
        right.annotate(label, (at, 0), xytext=(3, 4), textcoords="offset points")
    left.set(xlabel="tip offset b/R", ylabel="squirt, degrees", xlim=(0, None), ylim=(0, None))
    right.set(
        xlabel=with_heading("contact time of a rigid cue", "s"),
        ylabel=with_heading("effective end mass", END_MASS),
        ylim=(0, None),
    )
    left.legend(fontsize="small")
    return left, right


def _two_axes() -> tuple[Axes, Axes]:
    import matplotlib.pyplot as plt

    left, right = plt.subplots(1, 2, figsize=(10, 3.8), layout="constrained")[1]
    return left, right
