"""The points of the study accuracy_cost: errors over its family, and the work to time. Not a study itself."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from importlib import import_module
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from cuefem import (
    Cue,
    LumpedCue,
    Outcome,
    PowerLawTip,
    RollingContact,
    Scene,
    StructuralDamping,
    Support,
    TipDome,
    TipShear,
    end_mass,
    impulse,
    modes,
    strike,
)
from cuefem.accuracy import relative_error
from cuefem.beam.modes import Modes, solve
from cuefem.beam.system import assemble
from cuefem.beam.tail import tail
from cuefem.beam.tip import tip_modes
from cuefem.beam.waves import mesh_for
from cuefem.contact.linear import Exact
from cuefem.contact.strike import strike_modes
from cuefem.endmass.drives import velocity
from cuefem.scene import Resolution
from cuefem.tip_modes import tip_modes_from, turning

HERE = Path(__file__).parent
if str(HERE) not in sys.path:
    sys.path.append(str(HERE))  # studies are files, not a package
common, contact_cost = import_module("common"), import_module("contact_cost")

STROKES = ((0.7e-3, 0.4), (1e-3, 0.3), (2e-3, 0.1))  # contact time, s, and offset
SAID = "five cues of meshes/ x (0.7 ms, b/R 0.4), (1 ms, 0.3), (2 ms, 0.1)"
FREQUENCIES, KEPT = 10, 24  # of the beam's part: the lowest ten; end mass by 24 modes
ELEMENTS, ORDERS = (1, 2, 4, 8), (1, 2, 4, 6, 8, 12, 16, 20)
MODES, REFERENCE = (12, 17, 24, 34, 48, 68, 96), 220
STEPS = (1000, 2000, 4000, 8000, 16000)  # Newmark steps a head-on contact time
DRIVES = ("stick", "velocity", "force", "squirt")
# What is added rung by rung; the last is the reference of all models.
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
    return tuple(common.scene(common.cue(name), T, b) for name in common.NAMES for T, b in STROKES)


def cue_of(scene: Scene) -> Cue:
    assert isinstance(scene.cue, Cue)
    return scene.cue


# (a) the beam


def beam_points(elements: int) -> list[Point]:
    """Frequencies f1 to f10 and the velocity end mass (2 ms, 24 modes) by elements a piece of rising order."""
    points = []
    for order in ORDERS:
        held = [_held(name, elements, order) for name in common.NAMES]
        if min(held) < KEPT:
            continue
        at = Resolution(elements, order, KEPT)
        error = max(np.abs(_beam(name, at) / _beam(name, None) - 1).max() for name in common.NAMES)
        points.append(Point(f"{elements} x {order}", error, max(held), lambda at=at: _frequencies(at)))
    return points


def _frequencies(at: Resolution) -> Modes:
    return modes(common.cue("kim"), FREQUENCIES, at=at)


@cache
def _held(name: str, elements: int, order: int) -> int:
    return int(assemble(common.cue(name), elements=elements, order=order).mesh.unknowns) - 2


@cache
def _beam(name: str, at: Resolution | None) -> np.ndarray:
    """f1 to f10 and end mass; None: many elements of an order that no contestant has."""
    cue, at = common.cue(name), at or Resolution(12, 14, KEPT)
    found = solve(assemble(cue, elements=at.elements, order=at.order), at.modes)
    mass = velocity(tip_modes(found, cue.mass), common.scene(cue, 2e-3))
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


class Newmark(Exact):
    """The same phases by Newmark's constant-average-acceleration steps, their ends by a shortened last step.

    In first-order form that rule is the trapezoidal one: z' = A z, (1 - A h/2) z(t + h) = (1 + A h/2) z(t).
    """

    steps: int = 1000

    def follow(self, grip: Any, press: Any) -> str:
        """One phase."""
        contact = self.contact
        flow, (names, guards) = self.flow(grip, press), self.guards(grip, press)
        rows, h = guards.weights @ flow.rows, contact.laws.time / self.steps
        advance, z, before, start = _trapezoid(flow.A, h), contact.z, contact.impulse, contact.time
        values = rows @ z + guards.constants
        while True:
            following = advance @ z
            after = rows @ following + guards.constants
            fallen = np.flatnonzero((after < 0) & ((values > 0) | (after < values)))
            if len(fallen):
                break
            z, values, contact.time = following, after, contact.time + h
        fractions = np.maximum(values[fallen], 0) / (np.maximum(values[fallen], 0) - after[fallen])
        guard, fraction = int(fallen[np.argmin(fractions)]), float(fractions.min())
        state = _trapezoid(flow.A, fraction * h) @ z
        self.arrive(contact.time + fraction * h, state, [])
        self.patch.end(self, grip, press)
        contact.end_phase(grip, press, start, before)
        return names[guard]


def _trapezoid(A: np.ndarray, h: float) -> np.ndarray:
    one = np.eye(len(A))
    return np.linalg.solve(one - h / 2 * A, one + h / 2 * A)


def contact_points(kind: str) -> list[Point]:
    """Kim's four strokes of contact_cost by one solver, at rising accuracy."""
    if kind == "exact":
        return [_contact_point("exact phases", Exact, contact_cost.worst(contact_cost.Fine))]
    if kind == "Newmark":
        return [_contact_point(f"{n} steps", Newmark, steps=n) for n in STEPS]
    return [
        _contact_point(f"rtol {rtol:.0e}", contact_cost.Stepped, method=kind, rtol=rtol) for rtol in (1e-4, 1e-6, 1e-8)
    ]


def _contact_point(name: str, kind: type[Exact], error: float | None = None, **options: Any) -> Point:
    worst = contact_cost.worst(kind, **options) if error is None else error
    unknowns = len(contact_cost.struck(0.3).z)
    return Point(name, worst, unknowns, lambda: contact_cost.struck(0.3, kind, **options))


# (d) the ladder of models


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
    return found


@cache
def squirts(name: str) -> np.ndarray:
    """Squirt of every scene of the family by one model, rad."""
    return np.array([models()[name](scene) for scene in family()], float)


def model_errors(name: str) -> np.ndarray:
    """Relative error of squirt against the fullest model, for every scene of the family."""
    return np.asarray(squirts(name) / squirts(list(models())[-1]) - 1)


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
    cue = common.cue("kim")
    whole = cue.segments[0]
    d = np.linspace(whole.tip_diameter, whole.butt_diameter, pieces + 1)
    parts = [
        replace(whole, length=whole.length / pieces, tip_diameter=float(a), butt_diameter=float(b))
        for a, b in pairwise(d)
    ]
    return replace(cue, segments=tuple(parts))
