"""How stiff must a bridge hand be to change squirt?

What: a support 8 to 12 in behind the tip of bare shafts, as a spring across the cue; change of squirt at b/R 0.3 for
contacts of 0.7 to 2 ms: the largest over the positions for a hand of 1e4 N/m, and the stiffness that changes squirt by
1 %. e = 3/4, mu = 0.7, a ball of 210 g, default resolution (its error of 0.5 % is the same with the hand and without
it).
Equations: handbook: Effects (Support). A small change is linear in the stiffness.
Takes about 30 s.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from cuefem import Support, strike
from studies import pages, strokes

NAMES = ("kim", "pool_maple", "pool_hollow", "carbon")
TIMES = (0.7e-3, 1.0e-3, 1.4e-3, 2.0e-3)
POSITIONS = (8, 9, 10, 12)  # in
HAND = 1e4  # N/m, a firm hand
LIMIT = 0.01
INCH = 0.0254
GRID = tuple(np.geomspace(1e3, 1e7, 13))


@cache
def change(name: str, time: float, inches: float, stiffness: float) -> float:
    """Relative change of squirt by a support."""
    struck = strokes.scene(strokes.cue(name), time, 0.3)
    held = replace(struck, effects=(Support(inches * INCH, stiffness),)) if stiffness else struck
    return float(strike(held).squirt) / _free(name, time) - 1 if stiffness else 0.0


@cache
def _free(name: str, time: float) -> float:
    return float(strike(strokes.scene(strokes.cue(name), time, 0.3)).squirt)


@cache
def worst(name: str, time: float) -> tuple[float, float]:
    """Inches at which a firm hand changes squirt the most, and by how much."""
    return max(((x, change(name, time, x, HAND)) for x in POSITIONS), key=lambda found: abs(found[1]))


@cache
def stiffness_of(name: str, time: float) -> float:
    """Stiffness, N/m, that changes squirt by LIMIT at the worst place of a hand: linear first, then three secants."""
    inches, found = worst(name, time)
    k = HAND
    for _ in range(4):
        k *= LIMIT / abs(found)
        found = change(name, time, inches, k)
    return k


def table() -> str:
    """The hand's worst, and the stiffness that matters."""
    columns = ["cue", "T, ms", "worst place, in", "change by 1e4 N/m", "1 % from, N/m"]
    rows: list[list[Any]] = []
    for name in NAMES:
        for T in TIMES:
            inches, found = worst(name, T)
            stiff = f"{stiffness_of(name, T):.1e}"
            rows.append([name, f"{1e3 * T:g}", f"{inches:g}", f"{100 * found:+.2f} %", stiff])
    return pages.table(columns, rows)


def conclusions() -> list[str]:
    """What the numbers say."""
    kim = max(abs(worst("kim", T)[1]) for T in TIMES)
    short = max(abs(worst(name, T)[1]) for name in NAMES for T in TIMES[:-1])
    long = max(abs(worst(name, TIMES[-1])[1]) for name in NAMES)
    stiff = {T: min(stiffness_of(name, T) for name in NAMES) for T in TIMES}
    least = stiffness_of("kim", TIMES[-1])
    return [
        f"A hand of 1e4 N/m, 8 in or more behind the tip, changes squirt by at most {100 * kim:.2f} % on Kim's shaft "
        f"for contacts of 0.7 to 2 ms. On the other shafts the change is at most {100 * short:.2f} % up to 1.4 ms and "
        f"reaches {100 * long:.2f} % at 2 ms.",
        f"To change squirt by 1 % a stiffness of {stiff[TIMES[0]]:.0e} N/m is needed at 0.7 ms, {stiff[TIMES[1]]:.0e} "
        f"N/m at 1 ms, and {stiff[TIMES[-1]]:.0e} N/m at 2 ms (Kim's shaft {least:.1e} N/m). Fingers have a few 1e3 "
        "N/m (assumed). Whether squirt rises or falls depends on the place of the hand and on the contact time, "
        "because the spring reflects a bending wave. A clamp would matter.",
    ]


def report() -> str:
    """The committed table."""
    parts = ["# Squirt and the bridge hand", *conclusions(), table()]
    return pages.paragraphs(*parts)


def draw(panels: Any) -> None:
    """Change of squirt against the hand's stiffness."""
    for axes, name in zip(panels, NAMES[:2], strict=True):
        for i, T in enumerate((0.7e-3, 1.0e-3, 2.0e-3)):
            found = [100 * change(name, T, 8, float(k)) for k in GRID]
            axes.plot(GRID, found, color=f"C{i}", label=f"{1e3 * T:g} ms")
        axes.axhspan(-1, 1, color="0.5", alpha=0.2, lw=0)
        axes.axvline(HAND, color="k", lw=0.9, ls=":")
        axes.set(xscale="log", xlabel="stiffness 8 in behind the tip, N/m", title=f"{name}, b/R 0.3")
    panels[0].text(HAND * 0.8, 4, "a firm hand", rotation=90, ha="right", fontsize=8)
    panels[0].set(ylabel="change of squirt, per cent")
    panels[0].legend(fontsize=8, loc="lower left")


STUDY = pages.Study(__file__, report, {"bridge.svg": pages.Figure(draw, (1, 2), (10, 4.2))}, drawn=True)


if __name__ == "__main__":
    STUDY.write()
