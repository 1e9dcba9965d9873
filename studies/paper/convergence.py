"""Is the lumped cue of the papers a limit of the finite-element one, and how fast is it reached?

What: four roads from the coupled strike of a vibrating shaft to the impulse solver of a lumped cue, and what the modes,
elements and polynomial order of the finite-element cue leave out.
(a) a 12 cm stub of Kim's cone whose E and G grow: m_e = m_c nu_c/(1 + nu_c), with the stub's own nu_c;
(b) Kim's whole shaft in an ever longer contact at a fixed offset: the rigid shaft; (a) is (b) again, as only omega T
counts;
(c) Kim's shaft made ever lighter at fixed shape: [Kim]'s first order in epsilon;
(d) a vanishing offset: the impulse solver with the stick end mass, for all cues of meshes/.
Equations: handbook: Inverse mass, The impulse solver, The strike, Effective end mass and, for the end mass at an
offset, `stick_at_offset`; the table says how fast each road is and why. Parts: convergence_roads.py computes. e =
3/4, mu = 0.7, a ball of 210 g.
Takes about 20 s.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np

from studies import pages, strokes
from studies.paper import convergence_roads as roads
from studies.strokes import NAMES

slope, crests, table = pages.slope, pages.crests, pages.table

DRIVES = ("force", "velocity", "stick", "squirt")
LAST = 4  # windows over which a rigid road's rate is taken


@cache
def road(name: str, *arguments: object) -> roads.Road:
    """A road, walked once."""
    return getattr(roads, name)(*arguments)


def envelopes(name: str, *arguments: object) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Starts of the windows of a rigid road, and the largest errors in each."""
    found = road(name, *arguments)
    return found.along[:: roads.SAMPLES], {drive: crests(found.errors[drive], roads.SAMPLES) for drive in DRIVES}


def rigid_rates(name: str, *arguments: object) -> dict[str, float]:
    """Rates of a rigid road's errors over its last windows."""
    along, largest = envelopes(name, *arguments)
    return {drive: slope(along[-LAST:], errors[-LAST:]) for drive, errors in largest.items()}


def rigid_table(name: str, first: str) -> str:
    """A rigid road as a table, with its rates in the last line."""
    along, largest = envelopes(name)
    rows = [[f"{start:.6g}", *(largest[drive][i] for drive in DRIVES)] for i, start in enumerate(along)]
    rates = rigid_rates(name)
    return table([first, *DRIVES], [*rows, ["rate", *(f"{rates[drive]:.2f}" for drive in DRIVES)]], 2)


def light_rates() -> dict[float, float]:
    """(c) Rate in the factor of what is left with the end mass at the offset, over the lightest three half-decades."""
    return {b: slope(r.along[-4:], np.abs(r.errors["stick at the offset"][-4:])) for b, r in road("light").items()}


def light_table() -> str:
    """(c) as a table."""
    found = road("light")
    names = [(b, name) for b in found for name in ("stick", "stick at the offset")]
    columns = ["factor", *(f"b/R {b:g}, {name}" for b, name in names)]
    along = next(iter(found.values())).along
    rows = [[f"{x:.3g}", *(found[b].errors[name][i] for b, name in names)] for i, x in enumerate(along)]
    return table(columns, rows, 3)


def offset_row(name: str) -> list[object]:
    """(d) A cue's row: the root law derived and measured, its rate, and errors at larger offsets."""
    found = road("small_offset", name)
    struck = strokes.scene(strokes.cue(name))
    derived = roads.root_law(roads.plain_tip(struck), struck)
    stuck, own = found.errors["stick"], found.errors["stick at the offset"]
    measured = stuck[0] / np.sqrt(found.along[0])
    larger = [int(np.argmin(np.abs(found.along - b))) for b in (0.01, 0.1, 0.3)]
    errors = [errors[i] for errors in (stuck, own) for i in larger]
    return [name, derived, measured, f"{slope(found.along[:7], np.abs(stuck[:7])):.3f}", *errors]


def offset_table() -> str:
    """(d) as a table."""
    errors = [f"{name}, b/R {b}" for name in ("stick", "at the offset") for b in (0.01, 0.1, 0.316)]
    columns = ["cue", "root law derived", "measured", "rate", *errors]
    return table(columns, map(offset_row, strokes.NAMES), 3)


def modes_table() -> str:
    """The tail of the modes, as a table."""
    found = road("more_modes")
    psi, soft = found.errors["squirt"], found.errors["compliance"]
    rows = [[f"{n}", psi[i], soft[i], psi[i] / soft[i]] for i, n in enumerate(found.along) if i % 3 == 0]
    return table(["modes", "squirt", "compliance left out", "ratio"], rows, 2)


def modes_rate() -> float:
    """Exponent of the tail in the number of modes, from 20 modes on."""
    found = road("more_modes")
    far = found.along >= 20
    return slope(found.along[far], np.abs(found.errors["squirt"][far]))


def elements_table() -> str:
    """Errors against elements for orders 1 to 3, with the rates."""
    found = {order: road("more_elements", order) for order in (1, 2, 3)}
    along = found[1].along
    rows = [[f"{n}", *(abs(found[p].errors["squirt"][i]) for p in found)] for i, n in enumerate(along)]
    rates = [f"{slope(along, np.abs(r.errors['squirt'])):.2f}" for r in found.values()]
    return table(["elements", *(f"order {p}" for p in found)], [*rows, ["rate", *rates]], 2)


def order_table() -> str:
    """Errors against the order, three elements."""
    found = road("higher_order")
    rows = [[f"{p}", abs(e)] for p, e in zip(found.along, found.errors["squirt"], strict=True) if p % 3 == 0]
    return table(["order", "error"], rows, 2)


RIGID = (
    "The table shows the largest relative error in a window of a factor {window}, because the errors ring. Force and "
    "velocity end mass lose their error like {power}. Stick has no limit, because the step of velocity that it starts "
    "with rings for ever. The coupled squirt has one and approaches it as fast: friction caps the ringing force along "
    "the surface at mu F_n, which falls to zero at the end."
)
ENDLESS = (
    "With infinite friction nothing caps the ringing, and the squirt has no rigid limit either (rate {rate:.2f}, "
    "still {left:.0%} off in the last window)."
)
LIGHT = (
    "The table shows psi over [Kim]'s first order in epsilon, minus 1, for T = 1 ms and 22 modes; rho, E and G are "
    "multiplied by a factor. With the small-offset stick end mass the first order is never reached: it stays off by "
    "{missed}. At an offset the blow is shorter and changes the tip's velocity by less, so the end mass there is a "
    "different one. With that end mass (`stick_at_offset`) the first order is exact; the error falls at a rate of "
    "{rate:.2f} in the factor (b/R 0.5), which comes from the first slip."
)
OFFSET = (
    "The table shows the coupled squirt over that of the impulse solver, minus 1, for T = 1 ms. As b -> 0 it is C "
    "sqrt(b) with the derived C: 2/3 of the first slip times the ringing force at the end, of either sign, over the "
    "impulse. The rate varies where the slip begins to last longer than the period of the highest modes. With more "
    "modes the slip becomes shorter, like one over the root of the sum of their phi^2, and C with it (Kim, 22 to 160 "
    "modes: {fall:.2f} of C is left, {slip:.2f} of the slip); the ringing does not change. The term sqrt(b) therefore "
    "belongs to the truncation. It is also small: what the table shows is b^2, the change of the end mass itself with "
    "the offset."
)
MODES = (
    "The table shows the squirt of Kim's cue at b/R 0.3 and T = 1 ms over that with 300 modes, minus 1. The error "
    "falls algebraically, here like the number of modes to the power {rate:.1f}. It follows the static compliance of "
    "the modes left out, which is a spring between tip and cue, but it is no constant times it: from 28 modes on the "
    "ratio varies between {low:.2f} and {high:.2f} and does not settle."
)
MESH = (
    "The same with 22 modes, against the number of elements: the error falls with the order 2p. Against the order p "
    "of three elements: the convergence is spectral."
)


def truncation() -> dict[str, float]:
    """(d) What is left of Kim's root law, and of its first slip, when 22 modes become 160."""
    struck = strokes.scene(strokes.cue("kim"))
    few, many = (roads.tip_modes_of(struck, roads.Resolution(12, 26, n)) for n in (22, 160))
    laws = {"fall": roads.root_law, "slip": roads.first_slip}
    return {name: law(many, struck) / law(few, struck) for name, law in laws.items()}


def tail_ratios() -> np.ndarray:
    """Error of squirt over the compliance left out, from 28 modes on."""
    found = road("more_modes")
    return (found.errors["squirt"] / found.errors["compliance"])[found.along >= 28]


def report() -> str:
    """The committed table."""
    missed = ", ".join(f"{-r.errors['stick'][-1]:.1%} at b/R {b:g}" for b, r in road("light").items())
    parts = [
        "# From the finite-element cue to the lumped one",
        "## (a) A 12 cm stub of Kim's cone grows stiff",
        RIGID.format(window="4 in E and G", power="1/E"),
        rigid_table("stiff_stub", "E and G, times"),
        ENDLESS.format(
            rate=rigid_rates("stiff_stub", math.inf)["squirt"], left=envelopes("stiff_stub", math.inf)[1]["squirt"][-1]
        ),
        "## (b) Kim's shaft in a long contact",
        RIGID.format(window="2 in T", power="1/T^2"),
        rigid_table("long_contact", "T, s"),
        "## (c) A light cue of fixed shape",
        LIGHT.format(missed=missed, rate=light_rates()[0.5]),
        light_table(),
        "## (d) An offset that vanishes",
        OFFSET.format(**truncation()),
        offset_table(),
        "## Modes, elements, order",
        MODES.format(rate=modes_rate(), low=tail_ratios().min(), high=tail_ratios().max()),
        modes_table(),
        MESH,
        elements_table(),
        order_table(),
    ]
    return pages.paragraphs(*parts)


COLOURS = {"force": "C1", "velocity": "C2", "stick": "C3", "squirt": "C0"}


def guide(axes: Any, x: np.ndarray, *, through: float, power: float, name: str) -> None:
    """A thin line of a power law, from its value at the first x."""
    axes.plot(x, through * (x / x[0]) ** power, color="0.4", lw=0.9, ls="--", label=name)


def draw_rigid(axes: Any, name: str, *, power: float) -> None:
    """(a) or (b): errors as points, their crests as lines."""
    found = road(name)
    starts, largest = envelopes(name)
    for drive, colour in COLOURS.items():
        axes.plot(found.along, np.abs(found.errors[drive]), color=colour, lw=0.5)
        axes.plot(starts * (found.along[1] / found.along[0]) ** 3.5, largest[drive], color=colour, label=drive)
    last = largest["squirt"][-4]
    guide(axes, starts[-4:], through=2 * last, power=power, name=f"power {power:g}")
    axes.set(xscale="log", yscale="log", ylabel="relative error against the rigid cue", ylim=(3e-7, 8))


def draw_light(axes: Any) -> None:
    """(c): what the first order misses."""
    for colour, (b, found) in zip(("C0", "C1", "C3"), road("light").items(), strict=True):
        for name, style in (("stick", "--"), ("stick at the offset", "-")):
            label = f"b/R {b:g}, {name}"
            axes.plot(found.along, np.abs(found.errors[name]), style, color=colour, label=label)
    x = np.array([1e-3, 1e-5])
    guide(axes, x, through=5e-3, power=0.5, name="power 1/2")
    axes.set(xscale="log", yscale="log", xlabel="ρ, E and G, times", ylabel="|ψ over first order − 1|")
    axes.invert_xaxis()


def draw_offset(axes: Any) -> None:
    """(d): the coupled against the lumped squirt, all cues."""
    for i, name in enumerate(NAMES):
        found = road("small_offset", name)
        for which, style in (("stick", "-"), ("stick at the offset", ":")):
            label = name if which == "stick" else None
            axes.plot(found.along, np.abs(found.errors[which]), style, color=f"C{i}", label=label)
    guide(axes, np.array([1e-6, 1e-3]), through=1.3e-5, power=0.5, name="power 1/2")
    axes.plot([3e-3, 0.5], [9e-6 * 2, 0.5], color="0.4", lw=0.9, ls="-.", label="power 2")
    axes.set(xscale="log", yscale="log", xlabel="offset b/R", ylabel="|coupled over lumped squirt − 1|", ylim=(1e-6, 1))


def draw_modes(axes: Any) -> None:
    """The tail of the modes."""
    found = road("more_modes")
    psi, soft = found.errors["squirt"], found.errors["compliance"]
    axes.plot(found.along, np.abs(psi), "o-", ms=3, label="squirt")
    axes.plot(found.along, soft * np.median(psi / soft), "k--", lw=0.9, label="compliance left out, scaled")
    axes.set(xscale="log", yscale="log", xlabel="flexible modes kept", ylabel="relative error of squirt")
    axes.set_xticks([10, 20, 40, 80], ["10", "20", "40", "80"])
    axes.set_xticks([], minor=True)


def draw_mesh(axes: Any) -> None:
    """Elements and order."""
    for order in (1, 2, 3):
        found = road("more_elements", order)
        unknowns = found.along * (2 * order + 1)
        axes.plot(unknowns, np.abs(found.errors["squirt"]), "o-", ms=3, label=f"order {order}, 48 to 128 elements")
    found = road("higher_order")
    axes.plot(3 * (2 * found.along + 1), np.abs(found.errors["squirt"]), "s-", ms=3, color="C3",
              label="3 elements, order 6 to 21")  # fmt: skip
    axes.set(
        xscale="log",
        yscale="log",
        xlabel="unknowns of the mesh",
        ylabel="relative error of squirt, 22 modes",
        ylim=(1e-11, 3),
    )


def draw_rigids(panels: Any) -> None:
    """(a) and (b)."""
    left, right = panels
    draw_rigid(left, "stiff_stub", power=-1)
    draw_rigid(right, "long_contact", power=-2)
    left.set(xlabel="E and G, times", title="(a) a 12 cm stub grows stiff")
    right.set(xlabel="contact time T, s", title="(b) Kim's shaft, long contact")
    left.legend(fontsize=8)
    right.legend(fontsize=8, loc="upper right")


def draw_lumped(panels: Any) -> None:
    """(c) and (d)."""
    left, right = panels
    draw_light(left)
    draw_offset(right)
    left.set(title="(c) Kim's shaft made light, against first order in ε")
    right.set(title="(d) the offset vanishes, T = 1 ms")
    left.legend(fontsize=7)
    title = "solid: fed with the stick end mass\ndotted: with that of the offset"
    right.legend(title=title, fontsize=8, title_fontsize=8, loc="upper left")


def draw_modes_and_mesh(panels: Any) -> None:
    """Modes, elements and order."""
    left, right = panels
    draw_modes(left)
    draw_mesh(right)
    left.set(title="Modes: Kim, b/R 0.3, T = 1 ms")
    right.set(title="Elements and order")
    left.legend(fontsize=8)
    right.legend(fontsize=8, loc="upper right")


DRAWN = {"rigid": draw_rigids, "lumped": draw_lumped, "mesh": draw_modes_and_mesh}
STUDY = pages.Study(
    __file__,
    report,
    {f"convergence_{name}.svg": pages.Figure(draw, (1, 2), (10, 4.2)) for name, draw in DRAWN.items()},
    drawn=True,
)


if __name__ == "__main__":
    STUDY.write()
