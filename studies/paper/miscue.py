"""How far off centre can a ball be struck before the tip slips to the end (a miscue)?

What: the largest offset b/R before a miscue against friction, for [Kim]'s rigid cue (Q0 = 3, nu_c = 0.136) and two-part
cue (Q0 = 18/7, epsilon = 2/35), for the [A.31]-like limit (the same end mass, e = 0) and for a cue end without mass,
the paper's own condition mu = tan(phi). And the offset beyond which slip no longer ends during compression, so that
[Kim]'s closed form is not valid: where the paper's mu = 0.6 stops working. Equations: a miscue is slip that still goes
on when e^2 of the normal work is regained, tan(phi) (B_nn + mu B_tn) = (1 + e) (mu B_tt + B_tn), a cubic in tan(phi)
(closed_forms.miscue_offset); the table's last column finds the same edge by bisection on the regime of the general
solver (cuefem.impulse).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from cuefem import Ball, LumpedCue, Scene, Stroke, Tip, impulse
from studies import pages
from studies.pages import table
from studies.paper import closed_forms as squirt

E, NU, NU_C = 0.75, 0.4, 0.136
FRICTIONS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.0, 1.2)


class Cue(NamedTuple):
    """A lumped cue, masses over the ball's, and the tip's restitution."""

    name: str
    mass: float
    end_mass: float
    restitution: float


def rigid(ratio: float) -> Cue:
    """[Kim]'s rigid cue of mass ``ratio`` balls."""
    return Cue(f"rigid, Q0 = {ratio:g}", ratio, ratio * NU_C / (1 + NU_C), E)


TWO_PART = Cue("two-part, epsilon = 2/35", 18 / 7, 2 / 35 / 4, E)
CUES = (rigid(3.0), TWO_PART, TWO_PART._replace(name="[A.31]: two-part, e = 0", restitution=0.0))


def miscue(cue: Cue, friction: float | np.ndarray) -> np.ndarray:
    """Largest b/R before a miscue."""
    return squirt.miscue_offset(
        friction, cue_mass_ratio=cue.mass, end_mass_ratio=cue.end_mass, restitution=cue.restitution
    )


def compression_limit(cue: Cue, friction: float | np.ndarray) -> np.ndarray:
    """Largest b/R with slip ending in compression, where the closed form is valid."""
    tangent = friction * (1 + 1 / NU + 1 / cue.end_mass) / (1 + 1 / cue.end_mass)
    return tangent / np.sqrt(1 + tangent**2)


def by_regime(cue: Cue, friction: float) -> float:
    """Largest b/R before a miscue, by bisection on what the general solver says."""
    tip = Tip(restitution=cue.restitution, friction=friction)

    def slips(offset: float) -> bool:
        scene = Scene(LumpedCue(cue.mass, cue.end_mass), Ball(mass=1.0), tip, Stroke(offset=offset))
        return bool(impulse(scene).regime == "miscue")

    return edge(slips, 1e-6, 1 - 1e-6)


def edge(happens: Callable[[float], bool], low: float, high: float) -> float:
    """Where a condition that is false at ``low`` and true at ``high`` turns, to 1e-13."""
    while high - low > 1e-13:
        middle = (low + high) / 2
        low, high = (low, middle) if happens(middle) else (middle, high)
    return (low + high) / 2


def turning_ratio(phi: float, friction: float = 0.6) -> float:
    """Q0 of the rigid cue whose slip ends with compression at ``phi``, rad: [Kim]'s map holds above it."""
    return brentq(lambda q: float(compression_limit(rigid(q), friction)) - math.sin(phi), 1e-9, 100.0)


def text() -> str:
    """Offsets at the edge of a miscue, and where mu = 0.6 stops working."""
    rows = []
    for mu in FRICTIONS:
        values = [math.sin(math.atan(mu)), *(miscue(cue, mu) for cue in CUES), compression_limit(TWO_PART, mu)]
        rows.append([f"{mu:g}", *(f"{float(v):.4f}" for v in (*values, by_regime(TWO_PART, mu)))])
    edges = []
    for cue in (*(rigid(q) for q in (0.3, 1.0, 18 / 7, 3.0, 5.0)), *CUES[1:]):
        both = compression_limit(cue, 0.6), miscue(cue, 0.6)
        edges.append([cue.name, *(c for v in both for c in (f"{float(v):.3f}", f"{math.degrees(math.asin(v)):.1f}"))])
    needed = float(squirt.compression_stick_friction(0.7, end_mass_ratio=TWO_PART.end_mass))
    return pages.page(
        "Largest offset before a miscue",
        "What is the largest tip offset without a miscue (here: slip until separation of a lumped cue)?",
        "Kim's tan phi = mu holds for an end mass of zero. Real cues allow slightly more: mu = 0.6 allows b/R "
        f"{float(miscue(TWO_PART, 0.6)):.3f} (the closed form holds to "
        f"{float(compression_limit(TWO_PART, 0.6)):.3f}), not Coriolis' 0.7, which requires a mu of {needed:.2f}.",
        table(
            [
                "friction",
                "tan phi = mu",
                *(c.name for c in CUES),
                "two-part, slip ends in compression",
                "two-part, solver",
            ],
            rows,
        ),
        "## Limits of Kim's mu = 0.6",
        table(["cue", "closed form valid to b/R", "to phi, deg", "miscue from b/R", "from phi, deg"], edges),
        f"The map of the rigid cue to 45 degrees requires a Q0 of at least {turning_ratio(math.radians(45)):.2f} at mu "
        "= 0.6.",
    )


def draw(axes: Any) -> None:
    """The miscue map."""
    mu = np.linspace(0, 1.5, 301)
    axes.plot(mu, np.sin(np.arctan(mu)), "k", lw=1, label="no end mass: tan φ = μ")
    for cue, colour in zip(CUES, ("C0", "C3", "C2"), strict=True):
        axes.plot(mu, miscue(cue, mu), color=colour, label=f"miscue: {cue.name}")
        if cue.restitution:
            axes.plot(mu, compression_limit(cue, mu), color=colour, ls="--", lw=1,
                      label=f"slip ends in compression: {cue.name}")  # fmt: skip
    axes.axvline(0.6, color="0.5", lw=0.8)
    axes.text(0.61, 0.93, "the paper's μ = 0.6", fontsize=8, color="0.3")
    axes.axhline(0.7, color="0.5", lw=0.8)
    axes.text(0.02, 0.71, "Coriolis' limit b/R = 0.7", fontsize=8, color="0.3")
    axes.set(xlabel="friction μ", ylabel="largest offset b/R before a miscue", xlim=(0, 1.5), ylim=(0, 1))
    axes.legend(fontsize=8, loc="lower right")


EXAMPLE = """\
import cuefem as cf

cue = cf.LumpedCue.two_part(0.54, 0.012)
for offset in (0.50, 0.53, 0.54):
    scene = cf.Scene(cue, tip=cf.Tip(friction=0.6), stroke=cf.Stroke(2.0, offset))
    print(offset, cf.impulse(scene).regime)
"""
STUDY = pages.Study(__file__, text, {"miscue.svg": pages.Figure(draw, size=(6.4, 4.6))}, example=EXAMPLE)


if __name__ == "__main__":
    STUDY.write()
