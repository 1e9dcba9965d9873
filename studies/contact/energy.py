"""Where does the energy of a stroke go, against the offset?

The cue's kinetic energy at first contact, split after the coupled strike into the ball's translation and rotation, the
cue's rigid motion and vibration, and the losses of tip and friction: a maple pool cue, T = 1 ms, e = 3/4, mu = 0.7, a
ball of 210 g, b/R 0 to 0.75, beyond the miscue limit. Equations: handbook: The strike (energy balance).
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
OFFSETS = np.round(np.arange(0, 0.7501, 0.025), 3)


@cache
def shares(offset: float) -> tuple[dict[str, float], str]:
    """Each part over the energy at first contact, %, and the contact state (regime)."""
    outcome = cf.strike(strokes.scene(strokes.cue("pool_maple"), offset=offset))
    return {p: 100 * float(outcome.energy[p] / outcome.energy["initial"]) for p in PARTS}, str(outcome.regime)


def text() -> str:
    """The answer, and the table of the shares."""
    central = shares(0.0)[0]
    sticking = [shares(float(b))[0] for b in OFFSETS if shares(float(b))[1] == "stick"]
    rotation, vibration = (max(share[part] for share in sticking) for part in ("ball rotation", "cue vibration"))
    miscues = [float(b) for b in OFFSETS if shares(float(b))[1] == "miscue"]
    friction = max(shares(b)[0]["friction loss"] for b in miscues)
    ball = [sum(shares(b)[0][part] for part in ("ball translation", "ball rotation")) for b in (0.5, *miscues)]
    rows = [[f"{b:.2f}", *(f"{shares(float(b))[0][p]:.1f}" for p in PARTS), shares(float(b))[1]] for b in OFFSETS[::2]]
    return pages.page(
        "Energy balance of a stroke",
        "How does the energy of a stroke divide between ball, cue, tip and friction?",
        f"In a central impact the ball receives {central['ball translation']:.0f} %, the cue retains "
        f"{central['cue']:.0f} % and the tip dissipates {central['tip loss']:.0f} %. In the state stick, "
        f"rotation of the ball is at most {rotation:.0f} % and vibration of the shaft {vibration:.1f} %. The miscue "
        f"limit is gradual: in a miscue, from b/R {miscues[0]:g} on, friction dissipates up to {friction:.0f} %, and "
        f"the ball's part decreases from {ball[1]:.0f} % to {ball[-1]:.0f} % at b/R {miscues[-1]:g} "
        f"({ball[0]:.0f} % at 0.5).",
        "pool_maple, per cent of the cue's energy at first contact:",
        table(["b/R", *PARTS, "contact state"], rows),
    )


def draw(axes: Any) -> None:
    """The shares, stacked."""
    curves = [shares(float(b))[0] for b in OFFSETS]
    axes.stackplot(OFFSETS, [[share[part] for share in curves] for part in PARTS], labels=PARTS, colors=COLOURS, lw=0)
    axes.set(xlabel="offset b/R", ylabel="per cent of the cue's energy", xlim=(0, OFFSETS[-1]), ylim=(0, 100))
    handles, labels = axes.get_legend_handles_labels()
    axes.figure.legend(handles[::-1], labels[::-1], loc="outside right center", fontsize=9)


EXAMPLE = """\
import cuefem as cf

energy = dict(cf.strike(cf.load_scene("meshes/pool_maple.toml")).energy)
initial = energy.pop("initial")
for name, part in energy.items():
    print(f"{name:20}{100 * part / initial:5.1f} %")
"""
STUDY = pages.Study(__file__, text, {"energy.svg": pages.Figure(draw, size=(7, 4))}, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
