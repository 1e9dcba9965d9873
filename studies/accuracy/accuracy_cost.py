"""What does accuracy cost: in the beam, in the modes kept, in the contact, and in the model itself?

What: (a) element order against number of elements, in f1 to f10 and the velocity end mass (2 ms, 24 modes); (b) modes
kept, as a plain sum and with `cuefem.beam.tail`, in squirt, ball speed and spin; (c) exactly propagated phases against
scipy's solve_ivp and Newmark's steps on the very same phases; (d) the ladder of models from the paper's closed form to
the whole stroke (LeatherTip, waves along the cue, thrust on the bent shaft), in squirt against that last one. Errors
are the largest over a family: five cues of meshes/ x (0.7 ms, b/R 0.4), (1 ms, 0.3), (2 ms, 0.1); in (c) Kim's four
strokes of contact_cost.py; in (d) five cues x (leather of 400 MPa at 4 m/s, b/R 0.4), (140 MPa, 2 m/s, 0.3), (60 MPa,
0.8 m/s, 0.1), where each whole stroke tells the other models what can be measured of it head on: how long it lasts, and
how the cue rebounds; (e) the last rung of a strike, the cue as a solid, on Kim's shaft and a pool shaft, against the
beam with as many modes. References: 12 elements of order 14; 220 modes with a tail on a mesh of another order; exact
phases in cells a third as long. Left out: SecondHit, which changes only what follows the stroke; material data and
friction, which no refinement improves. Equations: handbook: The beam, The strike, Effective end mass, What the paper
says, Effects. Values and seconds stand on pages of their own; takes about two minutes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from cuefem import (
    Cue,
    LumpedCue,
    Outcome,
    PowerLawTip,
    Resolution,
    RollingContact,
    Scene,
    Solid,
    Stroke,
    StructuralDamping,
    Support,
    Tip,
    TipDome,
    TipShear,
    end_mass,
    impulse,
    modes,
    rebound,
    resolve,
    strike,
)
from cuefem.accuracy import relative_error
from cuefem.beam.modes import Modes, solve
from cuefem.beam.system import assemble
from cuefem.beam.tail import tail
from cuefem.beam.tip import tip_modes
from cuefem.beam.waves import mesh_for
from cuefem.endmass.drives import velocity
from cuefem.tip_modes import tip_modes_from, turning
from studies import pages, strokes
from studies.accuracy import contact_cost
from studies.accuracy.linear_phases import Follow, by_newmark, by_solver, exactly
from studies.measured import pool
from studies.strokes import strike_modes

STROKES = ((0.7e-3, 0.4), (1e-3, 0.3), (2e-3, 0.1))  # contact time, s, and offset
SAID = "five cues of meshes/ x (0.7 ms, b/R 0.4), (1 ms, 0.3), (2 ms, 0.1)"
FREQUENCIES, KEPT = 10, 24  # of the beam's part: the lowest ten; end mass by 24 modes
ELEMENTS, ORDERS = (1, 2, 4, 8), (1, 2, 4, 6, 8, 12, 16, 20)
MODES, REFERENCE = (12, 17, 24, 34, 48, 68, 96), 220
# Of the ladder: the leather's modulus, Pa, speed, m/s, and offset.
PLAYED = ((400e6, 4.0, 0.4), (140e6, 2.0, 0.3), (60e6, 0.8, 0.1))
PLAYED_SAID = "five cues of meshes/ x (400 MPa, 4 m/s, b/R 0.4), (140 MPa, 2 m/s, 0.3), (60 MPa, 0.8 m/s, 0.1)"
STEPS = (1000, 2000, 4000, 8000, 16000)  # Newmark steps a head-on contact time
DRIVES = ("stick", "velocity", "force", "squirt")
# What is added rung by rung, before the whole stroke, which is the reference of all models.
EFFECTS = {
    "dome": (TipDome(0.0095),),
    "tip shear": (TipShear(0.75),),
    "bridge hand, damping": (Support(0.2, stiffness=1e4), StructuralDamping(0.012)),
    "rolling contact": (RollingContact(),),
    "power-law tip": (PowerLawTip(1.5),),
}


class Point(NamedTuple):
    """One way to compute: its name, its largest error over the family, its unknowns, and the work, to be timed."""

    name: str
    error: float
    unknowns: int
    work: Callable[[], Any]


@cache
def family() -> tuple[Scene, ...]:
    """The fifteen scenes."""
    return tuple(strokes.scene(strokes.cue(name), T, b) for name in strokes.NAMES for T, b in STROKES)


def cue_of(scene: Scene) -> Cue:
    assert isinstance(scene.cue, Cue)
    return scene.cue


# (a) the beam


def beam_points(elements: int) -> list[Point]:
    """Frequencies f1 to f10 and the velocity end mass (2 ms, 24 modes) by elements a piece of rising order."""
    points = []
    for order in ORDERS:
        held = [_held(name, elements, order) for name in strokes.NAMES]
        if min(held) < KEPT:
            continue
        at = Resolution(elements, order, KEPT)
        error = max(np.abs(_beam(name, at) / _beam(name, None) - 1).max() for name in strokes.NAMES)
        points.append(Point(f"{elements} x {order}", error, max(held), lambda at=at: _frequencies(at)))
    return points


def _frequencies(at: Resolution) -> Modes:
    return modes(strokes.cue("kim"), FREQUENCIES, at=at)


@cache
def _held(name: str, elements: int, order: int) -> int:
    return int(assemble(strokes.cue(name), elements=elements, order=order).mesh.unknowns) - 2


@cache
def _beam(name: str, at: Resolution | None) -> np.ndarray:
    """f1 to f10 and end mass; None: many elements of an order that no contestant has."""
    cue, at = strokes.cue(name), at or Resolution(12, 14, KEPT)
    found = solve(assemble(cue, elements=at.elements, order=at.order), at.modes)
    mass = velocity(tip_modes(found, cue.mass), strokes.scene(cue, 2e-3))
    return np.append(found.frequencies[:FREQUENCIES], mass)


# (b) the modes kept


@cache
def _modes_of(index: int, count: int, spare: int) -> Modes:
    """Modes of a scene's cue on a mesh for ``spare`` modes; odd spare: of another order."""
    cue = cue_of(family()[index])
    elements, order = mesh_for(cue, spare)
    odd = spare % 2
    more = elements + odd if isinstance(elements, int) else tuple(each + odd for each in elements)
    return solve(assemble(cue, elements=more, order=order - 2 * odd), count)


def ended(found: Modes, scene: Scene, *, by_tail: bool) -> Outcome:
    """The strike by some modes, with or without a tail."""
    whole = tail(found, turning=turning(scene)) if by_tail else found
    return strike_modes(scene, tip_modes_from(whole, scene))


@cache
def reference(index: int) -> Outcome:
    """By far more modes than any contestant has, on a mesh of another order."""
    return ended(_modes_of(index, REFERENCE, REFERENCE + 1), family()[index], by_tail=True)


def mode_points(*, by_tail: bool) -> list[Point]:
    """Strikes by ever more modes, on a mesh that holds them."""
    points = []
    for count in MODES:
        outcomes = [ended(_modes_of(i, count, count), scene, by_tail=by_tail) for i, scene in enumerate(family())]
        errors = [relative_error(o, reference(i), s) for i, (o, s) in enumerate(zip(outcomes, family(), strict=True))]
        points.append(
            Point(f"{count} modes", max(errors), outcomes[0].unknowns, lambda n=count: _fresh(n, by_tail=by_tail))
        )
    return points


def _fresh(count: int, *, by_tail: bool) -> Outcome:
    """Kim's stroke from the drawing on, as a user computes it."""
    scene = family()[1]
    cue = cue_of(scene)
    elements, order = mesh_for(cue, count)
    return ended(solve(assemble(cue, elements=elements, order=order), count), scene, by_tail=by_tail)


# (c) the contact


def contact_points(kind: str) -> list[Point]:
    """Kim's four strokes of contact_cost by one solver, at rising accuracy."""
    if kind == "exact":
        return [_contact_point("exact phases", exactly(), contact_cost.worst(exactly(3)))]
    if kind == "Newmark":
        return [_contact_point(f"{n} steps", by_newmark(n)) for n in STEPS]
    return [_contact_point(f"rtol {rtol:.0e}", by_solver(kind, rtol)) for rtol in (1e-4, 1e-6, 1e-8)]


def _contact_point(name: str, follow: Follow, error: float | None = None) -> Point:
    worst = contact_cost.worst(follow) if error is None else error
    stroke = contact_cost.stroke(0.3)
    return Point(name, worst, stroke.run(follow).unknowns, lambda: stroke.run(follow))


# (d) the ladder of models


@cache
def whole_strokes() -> dict[Scene, Scene]:
    """The fifteen whole strokes, each by the scene that tells other models its offset, contact time and rebound."""
    found = {}
    for name in strokes.NAMES:
        cue = strokes.cue(name)
        drawn = pool.without_leather(cue) if cue.leather else cue
        for E, speed, offset in PLAYED:
            effects = (replace(pool.LEATHER, E=E), *pool.WHOLE)
            struck = Scene(drawn, tip=Tip(pool.TIP_RESTITUTION, 0.7), stroke=Stroke(speed, offset), effects=effects)
            head_on = strike(replace(struck, stroke=Stroke(speed, 0.0)))
            tip = Tip(rebound(struck), 0.7, contact_time=head_on.duration)
            found[Scene(cue, tip=tip, stroke=Stroke(speed, offset))] = struck
    return found


def with_effects(scene: Scene, rungs: int) -> Scene:
    """The scene with the effects of the first rungs."""
    return replace(scene, effects=tuple(effect for rung in list(EFFECTS.values())[:rungs] for effect in rung))


def papers(scene: Scene) -> Any:
    """Squirt of the paper's two-part cue of 12 g, by its closed form wherever that applies."""
    return impulse(replace(scene, cue=LumpedCue.two_part(scene.axial_mass, 0.012))).squirt


def lumped(scene: Scene, drive: Any) -> Any:
    """Squirt of the lumped cue with the finite-element end mass of that definition."""
    return impulse(replace(scene, cue=LumpedCue(scene.axial_mass, end_mass(scene, drive)))).squirt


def coupled(scene: Scene, rungs: int) -> Any:
    """Squirt of the coupled strike with the effects of the first rungs, at the default resolution."""
    return strike(with_effects(scene, rungs)).squirt


def models() -> dict[str, Callable[[Scene], Any]]:
    """Squirt by every model, from the paper's to the fullest."""
    found: dict[str, Callable[[Scene], Any]] = {"paper's closed form, 12 g": papers}
    for drive in DRIVES:
        found[f"lumped, {drive} end mass"] = lambda scene, drive=drive: lumped(scene, drive)
    found["coupled"] = lambda scene: coupled(scene, 0)
    for i, name in enumerate(EFFECTS, 1):
        found[f"... and {name}"] = lambda scene, i=i: coupled(scene, i)
    found["the whole stroke"] = lambda scene: strike(whole_strokes()[scene]).squirt
    return found


@cache
def squirts(name: str) -> np.ndarray:
    """Squirt of every stroke of the ladder by one model, rad."""
    return np.array([models()[name](scene) for scene in whole_strokes()], float)


def model_errors(name: str) -> np.ndarray:
    """Relative error of squirt against the whole stroke, for every stroke of the ladder."""
    return np.asarray(squirts(name) / squirts(list(models())[-1]) - 1)


# (e) the solid

SOLID = Solid(modes=60)
RUNGS = {"kim": (0, 1, 2), "pool_maple": (3, 4, 5)}  # of the family


@cache
def by_rungs(index: int) -> dict[str, float]:
    """Squirt of a scene of the family by the beam with its default, by a beam of as many modes as the solid, and by
    the solid; rad."""
    scene = family()[index]
    same = Resolution(*mesh_for(cue_of(scene), SOLID.modes), SOLID.modes)
    return {name: float(strike(scene, at).squirt) for name, at in (("default", None), ("beam", same), ("solid", SOLID))}


def solid_offs(name: str) -> np.ndarray:
    """Squirt by the solid over that by the beam of as many modes, less 1, for a cue's three strokes."""
    return np.array([by_rungs(i)["solid"] / by_rungs(i)["beam"] - 1 for i in RUNGS[name]])


def solid_table() -> str:
    """What the solid changes, beside what the modes do that neither has."""
    rows = []
    for name, scenes in RUNGS.items():
        for i in scenes:
            T, b = STROKES[i % len(STROKES)]
            squirt, exact = by_rungs(i), float(reference(i).squirt)
            offs = squirt["solid"] / squirt["beam"], squirt["beam"] / exact, squirt["default"] / exact
            rows.append([name, f"{1e3 * T:g} ms, b/R {b:g}", *(f"{100 * (off - 1):+.2f}" for off in offs)])
    heads = ["solid over beam, 60 modes each, %", "60 modes over all, beam, %", "default over all, beam, %"]
    return str(pages.table(["cue", "stroke", *heads], rows))


# Growth of the cost


def growth() -> dict[str, list[tuple[int, Callable[[], Any]]]]:
    """Work that should grow like the cube of the modes, and like the number of segments."""
    kim = family()[1]
    by_modes = [(n, lambda n=n: strike(kim, Resolution(*mesh_for(cue_of(kim), n), n))) for n in (25, 50, 100, 200)]
    shafts = {n: cut(n) for n in (25, 50, 100, 200)}
    by_segments = [(n, lambda c=c: modes(c, 6, at=Resolution(1, 2, 6))) for n, c in shafts.items()]
    return {"strike, modes kept": by_modes, "modes, segments": by_segments}


def cut(pieces: int) -> Cue:
    """Kim's cone as many pieces."""
    cue = strokes.cue("kim")
    whole = cue.segments[0]
    d = np.linspace(whole.tip_diameter, whole.butt_diameter, pieces + 1)
    parts = [
        replace(whole, length=whole.length / pieces, tip_diameter=float(a), butt_diameter=float(b))
        for a, b in pairwise(d)
    ]
    return replace(cue, segments=tuple(parts))


TICKS = (25, 30, 50, 100, 200, 400, 600, 1000, 2000, 4000)
NOISE = 1e-9  # errors below it are rounding and differ from machine to machine


@cache
def curves(part: str) -> dict[str, list[Any]]:
    """The points of one part, by the name of their curve."""
    if part == "beam":
        return {a_piece(n): beam_points(n) for n in ELEMENTS}
    if part == "modes":
        return {name: mode_points(by_tail=name == "tail") for name in ("plain sum", "tail")}
    return {kind: contact_points(kind) for kind in ("exact", "DOP853", "Radau", "Newmark")}


def a_piece(elements: int) -> str:
    """So many elements a piece, in words."""
    return f"{elements} element{'s' if elements > 1 else ''} a piece"


def size(error: float) -> str:
    """An error to one digit, or that it is below the noise."""
    return f"< {NOISE:.0e}" if error < NOISE else f"{error:.0e}"


def beam_table() -> str:
    """Errors by order and elements."""
    by_name = {point.name: point for curve in curves("beam").values() for point in curve}
    rows = []
    for order in ORDERS:
        cells = [by_name.get(f"{n} x {order}") for n in ELEMENTS]
        rows.append([str(order), *("" if p is None else f"{size(p.error)} ({p.unknowns})" for p in cells)])
    return str(pages.table(["order", *(a_piece(n) for n in ELEMENTS)], rows))


def modes_table() -> str:
    """Errors by modes kept, plain and with a tail."""
    plain, ended = curves("modes")["plain sum"], curves("modes")["tail"]
    rows = [
        [p.name.split()[0], size(p.error), size(t.error), str(t.unknowns)] for p, t in zip(plain, ended, strict=True)
    ]
    return str(pages.table(["modes kept", "plain sum", "with a tail", "unknowns"], rows))


def contact_table() -> str:
    """Errors of the contact's solvers."""
    rows = [[kind, p.name, size(p.error)] for kind, curve in curves("contact").items() for p in curve]
    return str(pages.table(["solver", "how finely", "error"], rows))


def model_table() -> str:
    """Errors of the models."""
    rows = []
    for name in models():
        errors = 100 * model_errors(name)
        rows.append([name, *(f"{value:.0f}" for value in (np.median(errors), errors.min(), errors.max()))])
    return str(pages.table(["model", "median, %", "lowest, %", "highest, %"], rows))


def point(elements: int, order: int) -> Any:
    """A point of the beam's part."""
    return next(p for p in curves("beam")[a_piece(elements)] if p.name == f"{elements} x {order}")


def conclusions() -> list[str]:
    """Four sentences, of numbers that the tables hold."""
    low, high, more, most = point(8, 4), point(4, 8), point(8, 8), point(4, 16)
    plain, ended = curves("modes")["plain sum"][-1], curves("modes")["tail"][-1]
    coarse = curves("contact")["Newmark"][0]
    names = list(models())
    off = {name: f"{100 * np.median(np.abs(model_errors(name))):.0f} %" for name in names}
    return [
        "A higher order pays more than more elements. With a thousand unknowns, 8 elements of order 4 leave an error "
        f"of {size(low.error)} and 4 elements of order 8 leave {size(high.error)}; with two thousand, 8 of order 8 "
        f"leave {size(more.error)} and 4 of order 16 {size(most.error)}.",
        f"{ended.name.capitalize()} with a tail leave an error of {size(ended.error)}; without it the error is "
        f"{size(plain.error)}, {plain.error / ended.error:.0f} times as large. The contact adds nothing to that: even "
        f"{coarse.name} of Newmark leave only {size(coarse.error)}, and exact phases {size(0.0)}.",
        f"No refinement makes up for a wrong model. In the median the paper's 12 g is {off[names[0]]} off, the stick "
        f"end mass {off['lumped, stick end mass']}, the bare coupled strike {off['coupled']}, the coupled strike with "
        f"the dome of the tip {off['... and dome']}, and with the shear of the tip too {off['... and tip shear']}. One "
        "more effect may lead away: only the whole stroke has them all.",
        f"The solid changes squirt by {solid_size('kim')} % at most on Kim's shaft, whose drawing has a shear "
        f"coefficient of its own, 0.9, and by {solid_size('pool_maple')} % on a pool shaft. Sixty modes without a tail "
        f"lack {lacking('beam', 'kim')} and {lacking('beam', 'pool_maple')} % by themselves, the beam's default "
        f"{lacking('default', 'kim')} and {lacking('default', 'pool_maple')} %: the solid says how far to trust the "
        "beam; a better squirt it does not give.",
    ]


def solid_size(name: str) -> str:
    """The largest change of squirt from beam to solid over a cue's three strokes, %."""
    return f"{100 * np.max(np.abs(solid_offs(name))):.2f}"


def lacking(how: str, name: str) -> str:
    """The largest error of the beam's squirt against all modes over a cue's three strokes, %."""
    return f"{100 * max(abs(by_rungs(i)[how] / float(reference(i).squirt) - 1) for i in RUNGS[name]):.2f}"


def report() -> str:
    """The values, without seconds."""
    return "\n".join(
        [
            "# What accuracy costs\n",
            f"Largest relative errors over {SAID}; below {NOISE:.0e} they are",
            "rounding. Seconds: [accuracy_cost_seconds.md](accuracy_cost_seconds.md).\n",
            *(f"{i}. {sentence}" for i, sentence in enumerate(conclusions(), 1)),
            "\n## (a) The beam: order against elements\n\nf1 to f10 and the velocity end mass (2 ms, 24 modes). "
            "Brackets hold the unknowns of the largest cue; a cell is empty if there are fewer than 24 modes.\n",
            beam_table(),
            "## (b) The modes kept\n\nSquirt, ball speed and spin, on a mesh that holds the modes to 2e-7.\n",
            modes_table(),
            "## (c) The contact\n\nThe four strokes of [contact_cost.md](contact_cost.md), 24 modes; Newmark's steps "
            "are those of one head-on contact time.\n",
            contact_table(),
            f"## (d) The ladder of models\n\nThe error of squirt relative to the whole stroke, over {PLAYED_SAID}. "
            "The other models are told its head-on contact time and rebound.\n",
            model_table(),
            "## (e) The solid\n\nSquirt by `strike(scene, at=Solid(modes=60))` over that by a beam with as many modes, "
            "both summed plainly; beside it, what sixty modes and the default lack of all modes.\n",
            solid_table(),
        ]
    )


def draw_values(axes: Any) -> None:
    """Error against unknowns: beam and modes."""
    for panel, part in zip(axes, ("beam", "modes"), strict=True):
        for name, curve in curves(part).items():
            panel.loglog([p.unknowns for p in curve], [max(p.error, 1e-13) for p in curve], "o-", label=name)
        panel.legend()
    axes[0].set(xlabel="unknowns of the largest cue", ylabel="largest relative error", title="(a) the beam")
    axes[1].set(xlabel="unknowns of the strike", title="(b) the modes kept")
    for panel in axes:
        plain_ticks(panel.xaxis, TICKS)


def plain_ticks(axis: Any, ticks: Sequence[float]) -> None:
    """Ticks as plain numbers, where powers of ten are too few."""
    low, high = axis.get_view_interval()
    axis.set_ticks([t for t in ticks if low <= t <= high], [f"{t:g}" for t in ticks if low <= t <= high])
    axis.set_tick_params(which="minor", label1On=False)


@cache
def seconds(part: str, name: str) -> list[float]:
    """Median seconds of a curve's points."""
    return [pages.seconds_of(point.work, 5) for point in curves(part)[name]]


def solid_seconds() -> dict[str, float]:
    """Median seconds of one stroke (1 ms, b/R 0.3) of Kim's shaft and of a pool shaft, on the solid."""
    return {name: pages.seconds_of(lambda i=scenes[1]: strike(family()[i], SOLID), 5) for name, scenes in RUNGS.items()}


@cache
def model_seconds(name: str) -> float:
    """Median seconds of one stroke (pool_maple, 2 m/s, b/R 0.3) by a model."""
    work, scene = models()[name], list(whole_strokes())[4]
    work(scene)
    return float(pages.seconds_of(lambda: work(scene), 5))


def draw_seconds(grid: Any) -> None:
    """Error against seconds, all four parts, and how the cost grows."""
    axes = grid.ravel()
    titles = ("(a) the beam: f1 to f10 of Kim's shaft", "(b) the modes kept", "(c) the contact")
    for panel, part, title in zip(axes[:3], ("beam", "modes", "contact"), titles, strict=True):
        for name, curve in curves(part).items():
            panel.loglog(seconds(part, name), [max(p.error, 1e-13) for p in curve], "o-", label=name)
        panel.set(title=title, xlabel="seconds", ylabel="largest relative error")
        panel.legend()
    axes[2].set_xlim(right=30)  # room for the legend
    plain_ticks(axes[1].xaxis, (0.005, 0.01, 0.02, 0.05, 0.1, 0.2))
    for i, name in enumerate(list(models())[:-1]):
        error = float(np.median(np.abs(model_errors(name))))
        axes[3].loglog(model_seconds(name), error, "os^v<>DPX*"[i % 10], label=name)
    axes[3].set(title="(d) models", xlabel="seconds", ylabel="median relative error of squirt", xlim=(1e-7, 1))
    plain_ticks(axes[3].yaxis, (0.01, 0.02, 0.05, 0.1, 0.2, 0.5))
    axes[3].legend(fontsize=7, loc="lower left")
    for panel, (name, rows) in zip(axes[4:], grown().items(), strict=True):
        n, t = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
        power = 3 if "modes kept" in name else 1
        panel.loglog(n, t, "o-", label=name)
        panel.loglog(n, t[-1] * (n / n[-1]) ** power, "k:", label=f"power {power}")
        panel.set(title=f"growth: {name}", xlabel=name.split(", ")[1], ylabel="seconds")
        plain_ticks(panel.xaxis, TICKS)
        panel.legend()


@cache
def grown() -> dict[str, list[tuple[int, float]]]:
    """Median seconds of the work that grows."""
    found = {}
    for name, rows in growth().items():
        for _, work in rows:
            work()
        found[name] = [(n, pages.seconds_of(work, 3)) for n, work in rows]
    return found


def seconds_report() -> str:
    """The cost table of this machine."""
    expm = pages.seconds_of(pages.expm_50(), 200)
    line = "| {} | {} | {} | {:.2f} |".format
    rows = [
        line(part, f"{name}: {p.name}", size(p.error), 1e3 * t)
        for part in ("beam", "modes", "contact")
        for name, curve in curves(part).items()
        for p, t in zip(curve, seconds(part, name), strict=True)
    ]
    for name in models():
        error = float(np.median(np.abs(model_errors(name))))
        rows.append(line("models", name, f"{error:.0e}" if error else "", 1e3 * model_seconds(name)))
    rows += [line("solid", name, "", 1e3 * t) for name, t in solid_seconds().items()]
    ratios, wanted = [], []
    for rtol in (1e-2, 1e-3, 1e-4):
        scene = family()[1]
        t = pages.seconds_of(lambda r=rtol, s=scene: resolve(s, r), 5)
        wanted.append(f"| {rtol:.0e} | {1e3 * t:.1f} | {t / expm:.0f} |")
    for name, found in grown().items():
        steep = np.log(found[-1][1] / found[-2][1]) / np.log(found[-1][0] / found[-2][0])
        times = ", ".join(f"{n}: {1e3 * t:.0f} ms" for n, t in found)
        ratios.append(f"- {name}: {times}; power {steep:.1f} at the last step")
    return (
        "\n".join(
            [
                "# Seconds of accuracy\n",
                f"{pages.machine()}\nMedian processor seconds of five; the models: one stroke of pool_maple, 2 m/s, "
                "b/R 0.3.\n",
                "| part | how | error | ms |\n|---|---|---|---|",
                *rows,
                "\n`resolve` of Kim's stroke (1 ms, b/R 0.3), all rungs included, against one scipy.linalg.expm of a "
                f"50 x 50\nmatrix of norm 1, {1e3 * expm:.3f} ms:\n",
                "| rtol | ms | expm |\n|---|---|---|",
                *wanted,
                "\nGrowth:\n",
                *ratios,
            ]
        )
        + "\n"
    )


# Of the models, those that the page's sentences name; the last is what they are held against.
NAMED = ("paper's closed form, 12 g", "lumped, stick end mass", "coupled", "... and dome", "... and tip shear")
SHORT = {name: work for name, work in models().items() if name in NAMED or name == list(models())[-1]}
STUDY = pages.Study(
    __file__,
    report,
    {
        "accuracy_cost.svg": pages.Figure(draw_values, (1, 2), (9.6, 4.2)),
        "accuracy_cost_seconds.png": pages.Figure(draw_seconds, (2, 3), (10.6, 6.4)),
    },
    seconds=seconds_report,
    again={
        "named models": pages.Again(report, left_out=len(models()) - len(SHORT), instead={"models": lambda: SHORT}),
        "the beam": pages.Again(beam_table, left_out=None),
        "the solid": pages.Again(solid_table, left_out=None),
    },
)


if __name__ == "__main__":
    STUDY.write()
