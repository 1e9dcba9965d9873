"""Where does the energy of a stroke go, against the offset?

What: the cue's kinetic energy at first touch, split after the coupled strike into the ball's translation
and spin, the cue's rigid motion and vibration, and the losses of tip and friction; Kim's cue and a
maple pool cue; T = 1 ms, e = 3/4, mu = 0.7, a ball of 210 g, b/R 0 to 0.75, through the miscue.
Equations: handbook: The strike (the energy audit of the coupled strike).
Takes about 3 s.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from cuefem import Outcome
from cuefem.tip_modes import PLAIN_PERIODS, default_resolution, tip_modes_of
from studies import pages, strokes
from studies.strokes import strike_modes

CUES = ("kim", "pool_maple")
PARTS = ("ball translation", "ball rotation", "cue", "cue vibration", "tip loss", "friction loss")
OFFSETS = np.round(np.arange(0, 0.76, 0.05), 2)
FINE = np.round(np.arange(0, 0.7501, 0.01), 2)
COLOURS = ("C0", "C9", "0.75", "C3", "C1", "0.35")


@cache
def tip(name: str) -> object:
    """The cue's tip modes, plainly summed: with a tail a last slip back hides which strokes miscue."""
    struck = strokes.scene(strokes.cue(name))
    return tip_modes_of(struck, default_resolution(struck, periods=PLAIN_PERIODS))


@cache
def outcome_at(name: str, offset: float) -> Outcome:
    """The coupled strike at an offset."""
    return strike_modes(strokes.scene(strokes.cue(name), offset=offset), tip(name))


def duration(name: str, offset: float) -> float:
    """Length of the contact, s."""
    return float(outcome_at(name, offset).duration)


def shares(name: str, offset: float) -> tuple[dict[str, float], str]:
    """Each part over the energy at first touch, and the regime, at an offset."""
    outcome = outcome_at(name, offset)
    return {part: float(outcome.energy[part] / outcome.energy["initial"]) for part in PARTS}, str(outcome.regime)


def share_table(name: str) -> str:
    """Shares in per cent."""
    rows = []
    for offset in OFFSETS:
        found, regime = shares(name, float(offset))
        rows.append([f"{offset:.2f}", *(f"{100 * found[part]:.2f}" for part in PARTS), regime])
    return pages.table(["b/R", *PARTS, "regime"], rows)


def largest(name: str, part: str) -> tuple[float, float]:
    """Largest share of a part over the offsets of FINE before the first miscue, and the offset it is found at."""
    return max((shares(name, float(b))[0][part], float(b)) for b in FINE if b < miscues(name)[0])


def miscues(name: str) -> list[float]:
    """Offsets of FINE that miscue."""
    return [float(b) for b in FINE if shares(name, float(b))[1] == "miscue"]


def gripping_again(name: str) -> list[float]:
    """Offsets of FINE beyond the first miscue at which the tip grips once more."""
    return [float(b) for b in FINE if b > miscues(name)[0] and float(b) not in miscues(name)]


def conclusions() -> list[str]:
    """What the numbers say."""
    said = []
    for name in CUES:
        head_on, _ = shares(name, 0.0)
        spin, at = largest(name, "ball rotation")
        vibration, there = largest(name, "cue vibration")
        slipping, _ = largest(name, "friction loss")
        ball = head_on["ball translation"]
        said.append(
            f"{name}: in a head-on stroke the ball takes {100 * ball:.1f} %, the cue keeps {100 * head_on['cue']:.1f} "
            f"% and the tip loses {100 * head_on['tip loss']:.1f} %. Below the offset of the first miscue (b/R "
            f"{miscues(name)[0]:.2f}) spin takes at most {100 * spin:.1f} % (at b/R {at:.2f}), vibration of the shaft "
            f"{100 * vibration:.1f} % (at b/R {there:.2f}), and friction {100 * slipping:.1f} %."
        )
        if again := gripping_again(name):
            lasting = [duration(name, b) for b in again]
            said[-1] += (
                f" The miscue has no sharp edge: at b/R {again[0]:.2f} to {again[-1]:.2f} the tip slips first and "
                f"grips late, in contacts of {1e3 * min(lasting):.1f} to {1e3 * max(lasting):.1f} ms (at the first "
                f"miscue {1e3 * duration(name, miscues(name)[0]):.1f} ms)."
            )
    return said


def report() -> str:
    """The committed table."""
    parts = ["# Where the energy of a stroke goes", *conclusions()]
    for name in CUES:
        parts += [f"## {name}, per cent of the cue's energy at first touch", share_table(name)]
    return pages.paragraphs(*parts)


def draw(axes: object, name: str) -> None:
    """The shares, stacked."""
    found = [shares(name, float(b))[0] for b in FINE]
    stack = [[100 * f[part] for f in found] for part in PARTS]
    axes.stackplot(FINE, stack, labels=PARTS, colors=COLOURS, lw=0)
    axes.axvline(miscues(name)[0], color="k", lw=0.9, ls=":")
    axes.text(miscues(name)[0] + 0.008, 45, "first miscue", rotation=90, fontsize=8)
    axes.set(xlabel="offset b/R", title=name, xlim=(0, FINE[-1]), ylim=(0, 100))


def draw_both(panels: Any) -> None:
    """The shares of both cues."""
    for axes, name in zip(panels, CUES, strict=True):
        draw(axes, name)
    panels[0].set(ylabel="per cent of the cue's energy")
    handles, labels = panels[0].get_legend_handles_labels()
    panels[0].figure.legend(handles[::-1], labels[::-1], loc="outside right center", fontsize=9)


STUDY = pages.Study(
    __file__, report, {"energy.svg": pages.Figure(draw_both, (1, 2), (10, 4.4))}, heavy=False, drawn=True
)


if __name__ == "__main__":
    STUDY.write()
