"""The figures of convergence.py."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from common import NAMES, figure

COLOURS = {"force": "C1", "velocity": "C2", "stick": "C3", "squirt": "C0"}


def guide(axes: Any, x: np.ndarray, *, through: float, power: float, name: str) -> None:
    """A thin line of a power law, from its value at the first x."""
    axes.plot(x, through * (x / x[0]) ** power, color="0.4", lw=0.9, ls="--", label=name)


def draw_rigid(axes: Any, study: Any, *, road: str, power: float) -> None:
    """(a) or (b): errors as points, their crests as lines."""
    found = study.road(road)
    starts, largest = study.envelopes(road)
    for drive, colour in COLOURS.items():
        axes.plot(found.along, np.abs(found.errors[drive]), color=colour, lw=0.5)
        axes.plot(starts * (found.along[1] / found.along[0]) ** 3.5, largest[drive], color=colour, label=drive)
    last = largest["squirt"][-4]
    guide(axes, starts[-4:], through=2 * last, power=power, name=f"power {power:g}")
    axes.set(xscale="log", yscale="log", ylabel="relative error against the rigid cue", ylim=(3e-7, 8))


def draw_light(axes: Any, study: Any) -> None:
    """(c): what the first order misses."""
    for colour, (b, found) in zip(("C0", "C1", "C3"), study.road("light").items(), strict=True):
        for name, style in (("stick", "--"), ("stick at the offset", "-")):
            label = f"b/R {b:g}, {name}"
            axes.plot(found.along, np.abs(found.errors[name]), style, color=colour, label=label)
    x = np.array([1e-3, 1e-5])
    guide(axes, x, through=5e-3, power=0.5, name="power 1/2")
    axes.set(xscale="log", yscale="log", xlabel="ρ, E and G, times", ylabel="|ψ over first order − 1|")
    axes.invert_xaxis()


def draw_offset(axes: Any, study: Any) -> None:
    """(d): the coupled against the lumped squirt, all cues."""
    for i, name in enumerate(NAMES):
        found = study.road("small_offset", name)
        for which, style in (("stick", "-"), ("stick at the offset", ":")):
            label = name if which == "stick" else None
            axes.plot(found.along, np.abs(found.errors[which]), style, color=f"C{i}", label=label)
    guide(axes, np.array([1e-6, 1e-3]), through=1.3e-5, power=0.5, name="power 1/2")
    axes.plot([3e-3, 0.5], [9e-6 * 2, 0.5], color="0.4", lw=0.9, ls="-.", label="power 2")
    axes.set(xscale="log", yscale="log", xlabel="offset b/R", ylabel="|coupled over lumped squirt − 1|", ylim=(1e-6, 1))


def draw_modes(axes: Any, study: Any) -> None:
    """The tail of the modes."""
    found = study.road("more_modes")
    psi, soft = found.errors["squirt"], found.errors["compliance"]
    axes.plot(found.along, np.abs(psi), "o-", ms=3, label="squirt")
    axes.plot(found.along, soft * np.median(psi / soft), "k--", lw=0.9, label="compliance left out, scaled")
    axes.set(xscale="log", yscale="log", xlabel="flexible modes kept", ylabel="relative error of squirt")
    axes.set_xticks([10, 20, 40, 80], ["10", "20", "40", "80"])
    axes.set_xticks([], minor=True)


def draw_mesh(axes: Any, study: Any) -> None:
    """Elements and order."""
    for order in (1, 2, 3):
        found = study.road("more_elements", order)
        unknowns = found.along * (2 * order + 1)
        axes.plot(unknowns, np.abs(found.errors["squirt"]), "o-", ms=3, label=f"order {order}, 48 to 128 elements")
    found = study.road("higher_order")
    axes.plot(3 * (2 * found.along + 1), np.abs(found.errors["squirt"]), "s-", ms=3, color="C3",
              label="3 elements, order 6 to 21")  # fmt: skip
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="unknowns of the mesh",
        ylabel="relative error of squirt, 22 modes",
        ylim=(1e-11, 3),
    )


def figures(folder: Path, study: Any) -> None:
    """Draw all into ``folder``."""
    with figure(Path(folder) / "convergence_rigid.svg", (1, 2), (10, 4.2)) as (left, right):
        draw_rigid(left, study, road="stiff_stub", power=-1)
        draw_rigid(right, study, road="long_contact", power=-2)
        left.set(xlabel="E and G, times", title="(a) a 12 cm stub grows stiff")
        right.set(xlabel="contact time T, s", title="(b) Kim's shaft, long contact")
        left.legend(fontsize=8)
        right.legend(fontsize=8, loc="upper right")
    with figure(Path(folder) / "convergence_lumped.svg", (1, 2), (10, 4.2)) as (left, right):
        draw_light(left, study)
        draw_offset(right, study)
        left.set(title="(c) Kim's shaft made light, against first order in ε")
        right.set(title="(d) the offset vanishes, T = 1 ms")
        left.legend(fontsize=7)
        right.legend(title="solid: fed with the stick end mass\ndotted: with that of the offset",
                     fontsize=8, title_fontsize=8, loc="upper left")  # fmt: skip
    with figure(Path(folder) / "convergence_mesh.svg", (1, 2), (10, 4.2)) as (left, right):
        draw_modes(left, study)
        draw_mesh(right, study)
        left.set(title="Modes: Kim, b/R 0.3, T = 1 ms")
        right.set(title="Elements and order")
        left.legend(fontsize=8)
        right.legend(fontsize=8, loc="upper right")
