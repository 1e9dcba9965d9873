"""Where does the energy of a stroke go, against the offset?

The cue's kinetic energy at first touch, split after the coupled strike into the ball's translation and spin, the cue's
rigid motion and vibration, and the losses of tip and friction: a maple pool cue, T = 1 ms, e = 3/4, mu = 0.7, a ball of
210 g, b/R 0 to 0.75, through the miscue. Equations: handbook: The strike (energy balance).
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

import cuefem as cf
from studies import pages, strokes
from studies.pages import table

PARTS = ("ball translation", "ball rotation", "cue", "cue vibration", "tip loss", "friction loss")
COLOURS = ("C0", "C9", "0.75", "C3", "C1", "0.35")
FINE = np.round(np.arange(0, 0.7501, 0.025), 3)


@cache
def shares(offset: float) -> tuple[dict[str, float], str]:
    """Each part over the energy at first touch, %, and the regime."""
    outcome = cf.strike(strokes.scene(strokes.cue("pool_maple"), offset=offset))
    return {p: 100 * float(outcome.energy[p] / outcome.energy["initial"]) for p in PARTS}, str(outcome.regime)


def text() -> str:
    head_on = shares(0.0)[0]
    held = [shares(float(b)) for b in FINE if shares(float(b))[1] == "stick"]
    spin, shaken = (max(found[part] for found, _ in held) for part in ("ball rotation", "cue vibration"))
    rows = [[f"{b:.2f}", *(f"{shares(float(b))[0][p]:.1f}" for p in PARTS), shares(float(b))[1]] for b in FINE[::2]]
    return pages.page(
        "Where the energy of a stroke goes",
        "Where does the energy of a stroke go?",
        f"In a central impact the ball takes {head_on['ball translation']:.0f} %, the cue keeps {head_on['cue']:.0f} "
        f"% and the tip loses {head_on['tip loss']:.0f} %. While the tip sticks, spin takes at most {spin:.0f} % and "
        f"the shaft's vibration {shaken:.1f} %. A miscue has no sharp edge: past b/R 0.6 friction takes up to 14 % "
        "and the ball less and less.",
        "pool_maple, per cent of the cue's energy at first touch:",
        table(["b/R", *PARTS, "regime"], rows),
    )


def draw(axes: Any) -> None:
    """The shares, stacked."""
    found = [shares(float(b))[0] for b in FINE]
    axes.stackplot(FINE, [[f[part] for f in found] for part in PARTS], labels=PARTS, colors=COLOURS, lw=0)
    axes.set(xlabel="offset b/R", ylabel="per cent of the cue's energy", xlim=(0, FINE[-1]), ylim=(0, 100))
    handles, labels = axes.get_legend_handles_labels()
    axes.figure.legend(handles[::-1], labels[::-1], loc="outside right center", fontsize=9)


STUDY = pages.Study(__file__, text, {"energy.svg": pages.Figure(draw, size=(7, 4))})

if __name__ == "__main__":
    STUDY.write()
