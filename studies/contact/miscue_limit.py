"""Does a low-deflection shaft miscue earlier: the largest offset without a miscue against the end mass.

A lumped cue slips to separation beyond an offset that is a root of a cubic (`studies.paper.closed_forms`). For an end
mass m_e much smaller than the ball's mass M, tan(phi) = mu + tau m_e/M with tau = mu (1 + mu^2) ((1 + e)(1 + 1/nu) +
e M/M_c - 1)/(1 + e + mu^2): perturb the cubic, whose leading part is (tan(phi) - mu)(tan(phi)^2 + 1 + e). The coupled
strike of a drawn shaft has its own limit: slip for half of the normal impulse or through its last third. FILE: prints
the limit of a cue.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np

import cuefem as cf
from studies import pages, strokes
from studies.pages import table
from studies.paper.closed_forms import miscue_offset
from studies.strokes import at_offset, cue, drawn_stroke, full_model, hollow, own_stroke, pool_scene
from tests.oracle.small_steps import solve_small_steps

FRICTION, LEATHER_E, SEED = 0.7, 0.604, 1
COUNT, PAIRS = 40, 24  # drawn shafts; drawn tips on two shafts
RATIOS = (0.02, 0.04, 0.06, 0.08)  # m_e/M
CHALK = 0.05  # scatter of friction from stroke to stroke: assumed, no source
BALL, CUE = strokes.POOL, 0.54  # kg


def massless(friction: float) -> float:
    """Largest b/R of a cue end without mass."""
    return friction / math.sqrt(1 + friction**2)


def first_order(friction: float, restitution: float, cue_mass: float = CUE, inertia: float = 0.4) -> float:
    """Change of that b/R with m_e/M."""
    bracket = (1 + restitution) * (1 + 1 / inertia) + restitution * BALL.mass / cue_mass - 1
    return friction * bracket / ((1 + restitution + friction**2) * math.sqrt(1 + friction**2))


def lumped(ratio: float, friction: float = FRICTION, restitution: float = LEATHER_E) -> float:
    """Largest b/R of a lumped cue of m_e/M."""
    masses = {"cue_mass_ratio": CUE / BALL.mass, "end_mass_ratio": ratio}
    return float(miscue_offset(friction, restitution=restitution, **masses))


@cache
def limit(struck: cf.Scene) -> float:
    """The least b/R at which the coupled strike is a miscue, within 0.0004; ValueError if none is found."""
    low = massless(struck.tip.friction) - 0.08
    high = low + 0.24
    for _ in range(3):
        offsets = np.linspace(low, high, 9)
        regimes = cf.batch_strike([at_offset(struck, float(b)) for b in offsets]).regime
        first = next((i for i, regime in enumerate(regimes) if regime == "miscue"), 0)
        if not first:
            raise ValueError(f"squirt has no limit of a miscue between b/R {low:.2f} and {high:.2f}")
        low, high = offsets[first - 1], offsets[first]
    return float(low + high) / 2


def with_friction(struck: cf.Scene, friction: float) -> cf.Scene:
    """The scene with another friction."""
    return replace(struck, tip=replace(struck.tip, friction=friction))


class Drawn(NamedTuple):
    """A drawn stroke: its friction, m_e/M (stick), and limit of the coupled strike."""

    friction: float
    ratio: float
    restitution: float
    limit: float

    @property
    def excess(self) -> float:
        """The limit beyond that of no end mass, over its first order in m_e/M."""
        return (self.limit - massless(self.friction)) / (first_order(self.friction, self.restitution) * self.ratio)


@cache
def drawn() -> list[Drawn]:
    """Limits of drawn shafts and tips, friction 0.6 to 0.8."""
    draw = np.random.default_rng(SEED)
    results = []
    for _ in range(COUNT):
        struck = with_friction(drawn_stroke(draw), draw.uniform(0.6, 0.8))
        ratio = cf.end_mass(struck) / struck.ball.mass
        results.append(Drawn(struck.tip.friction, ratio, struck.tip.restitution, limit(struck)))
    return results


@cache
def pairs() -> list[float]:
    """How much earlier a bored maple shaft miscues than the solid one with the same drawn tip, mm."""
    draw = np.random.default_rng(SEED)
    earlier = []
    for _ in range(PAIRS):
        stroke, friction = drawn_stroke(draw, cue("pool_maple")), draw.uniform(0.6, 0.8)
        solid = with_friction(stroke, friction)
        bored = replace(solid, cue=full_model(hollow(8.5e-3)).cue)
        earlier.append(1e3 * BALL.radius * (limit(solid) - limit(bored)))
    return earlier


def spread(values: list[float], digits: int = 2) -> str:
    """Median and 95 % of values."""
    low, middle, high = np.percentile(values, [2.5, 50, 97.5])
    return f"{middle:.{digits}f} (95 % {low:.{digits}f} to {high:.{digits}f}, n {len(values)})"


def shafts() -> dict[str, cf.Scene]:
    """Default strokes of shafts."""
    names = {"solid maple": cue("pool_maple"), "bored maple, 6 mm": cue("pool_hollow")}
    names |= {"bored maple, 8.5 mm": hollow(8.5e-3), "carbon tube": cue("carbon")}
    return {name: full_model(shaft) for name, shaft in names.items()}


def shaft_table() -> str:
    """Limits of shafts, by friction."""
    rows = []
    for name, struck in shafts().items():
        limits = [f"{limit(with_friction(struck, mu)):.3f}" for mu in (0.6, FRICTION, 0.8)]
        rows.append([name, f"{1e3 * cf.end_mass(struck):.1f}", *limits])
    rows.append(["no end mass: sin(atan μ)", "0", *(f"{massless(mu):.3f}" for mu in (0.6, FRICTION, 0.8))])
    return table(["shaft, default stroke", "end mass (stick), g", "μ 0.6", "μ 0.7", "μ 0.8"], rows)


def lumped_table() -> str:
    """The closed forms."""
    slope = first_order(FRICTION, LEATHER_E)
    rows = [[f"{ratio:g}", f"{lumped(ratio):.4f}", f"{massless(FRICTION) + slope * ratio:.4f}"] for ratio in RATIOS]
    rows = [["0", f"{massless(FRICTION):.4f}", f"{massless(FRICTION):.4f}"], *rows]
    rows.append(["∞ (rigid across)", f"{lumped(1e9):.4f}", pages.NONE])
    return table(["m_e/M", "cubic", "first order"], rows)


def share(struck: cf.Scene, squirt: float) -> float:
    """Transverse impulse over friction times the normal impulse, from the direction of the ball."""
    angle = float(struck.stroke.angle) - squirt
    return math.tan(angle) / struck.tip.friction


@cache
def check() -> list[tuple[float, float, float]]:
    """b/R, and the share of the coupled strike and of the oracle in small steps."""
    rows = []
    for offset in (0.5, 0.56, 0.6, 0.64):
        struck = pool_scene(strokes.plain_maple(), 1.2e-3, offset, (strokes.DOME, strokes.SHEAR))
        stepped = solve_small_steps(struck, 150, 1000).squirt
        rows.append((offset, share(struck, cf.strike(struck).squirt), share(struck, stepped)))
    return rows


def needed_strokes() -> int:
    """Strokes of each of two shafts, at offsets about the limit, that tell their median difference at 2 sigma."""
    slope = 1 / (1 + FRICTION**2) ** 1.5  # of massless(mu)
    scatter = 1e3 * BALL.radius * slope * CHALK
    error = abs(float(np.median(pairs()))) / 2
    return math.ceil(2 * math.pi / 2 * (scatter / error) ** 2)  # of a median: pi/2 times the variance of a mean


def text() -> str:
    slope = first_order(FRICTION, LEATHER_E)
    earlier = pairs()
    friction = float(np.median(earlier)) / (1e3 * BALL.radius) * (1 + FRICTION**2) ** 1.5
    return pages.page(
        "Miscue limit against the end mass",
        "Does a shaft of low squirt miscue at a smaller offset?",
        f"Yes, by little. A bored maple shaft (8.5 mm) miscues {spread(earlier)} mm earlier than a solid one with "
        f"the "
        f"same tip and friction 0.6 to 0.8. A friction lower by {friction:.3f} has the same effect. Without an end "
        f"mass the limit is "
        f"tan φ = μ (b/R {massless(FRICTION):.3f} at μ 0.7); each 1 % of the ball's mass in the end mass adds "
        f"{slope / 100:.3f} to b/R if the cue is lumped, and {spread([d.excess for d in drawn()])} of that in the "
        f"coupled strike of drawn shafts.",
        "## Closed forms",
        "During slip the contact force is at the friction angle. A lumped cue slips to separation if its slip "
        "still lasts when the "
        "normal impulse is complete: a cubic in tan φ ([miscue](../paper/miscue.md)). Its parts of order M/m_e are "
        "(tan φ - μ)(tan² φ + 1 + e); the "
        "next order gives, with the ball's mass M, the cue's M_c and ν = 2/5,",
        "```text\nb/R = μ/√(1+μ²) + μ ((1+e)(1+1/ν) + e M/M_c - 1)/((1+e+μ²) √(1+μ²)) m_e/M\n```",
        f"At μ {FRICTION:g}, e {LEATHER_E:g} of the leather, a cue of {1e3 * CUE:g} g:",
        lumped_table(),
        "## Shafts",
        "Limit b/R of the coupled strike, where the tip slips for more than half of the normal impulse or through "
        "its last third. This "
        "definition is stricter than slip to separation, and a leather tip takes time to build up its force: real "
        "shafts lie below the lumped curve.",
        shaft_table(),
        "![limits of lumped cues and drawn shafts](miscue_limit.svg)",
        "## Check",
        "Transverse impulse over μ times the normal impulse on solid maple, a spring tip with dome and compliance, "
        "by `cf.strike` and by "
        "the independent oracle (scikit-fem's beam, 150 modes, small steps): "
        + "; ".join(f"{a:.4f} and {b:.4f} at b/R {offset:g}" for offset, a, b in check())
        + ".",
        "## Measurement",
        f"Put one tip on both shafts in turn, chalk before every stroke, and strike at offsets 0.5 mm apart about "
        f"the limit. With a scatter "
        f"of friction of {CHALK:g} from stroke to stroke (assumed: no source) about {needed_strokes()} strokes of "
        f"each shaft distinguish the "
        "two at 2σ. The friction of chalked leather, which was measured in no source known to us stroke by stroke, "
        "decides first.",
    )


def draw(axes: Any) -> None:
    """Limits against the end mass."""
    ratios = np.linspace(1e-4, 0.1, 60)
    for mu, colour in ((0.6, "C0"), (FRICTION, "C1"), (0.8, "C2")):
        axes.plot(100 * ratios, [lumped(float(r), mu) for r in ratios], colour, label=f"lumped cue, μ {mu:g}")
        shades = [d for d in drawn() if abs(d.friction - mu) < 0.05]
        shifted = [d.limit + massless(mu) - massless(d.friction) for d in shades]
        axes.plot([100 * d.ratio for d in shades], shifted, colour + "o", ms=3)
    axes.plot([], [], "ko", ms=3, label="drawn shafts, shifted to the nearest μ")
    axes.set(xlabel="end mass (stick), % of the ball's mass", ylabel="largest b/R without a miscue")
    axes.legend(fontsize=8)


def answer(path: str) -> str:
    """The limit of a cue's stroke."""
    struck = own_stroke(path)
    found, least = limit(struck), massless(struck.tip.friction)
    return (
        f"miscue from b/R {found:.3f} at friction {struck.tip.friction:g}, {1e3 * struck.ball.radius * found:.1f} "
        f"mm from the centre; "
        f"without an end mass from {least:.3f}"
    )


EXAMPLE = """\
import cuefem as cf
from dataclasses import replace

scene = cf.load_scene("meshes/pool_maple.toml")
for offset in (0.55, 0.59, 0.63):
    stroke = cf.Stroke(speed=2.0, offset=offset)
    print(offset, cf.strike(replace(scene, stroke=stroke)).regime)
"""
STUDY = pages.Study(__file__, text, {"miscue_limit.svg": pages.Figure(draw)}, example=EXAMPLE)

if __name__ == "__main__":
    pages.run(STUDY, answer)
