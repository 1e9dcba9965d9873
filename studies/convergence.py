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
Writes convergence.md and convergence_*.svg beside itself; takes about 20 s.
"""

from __future__ import annotations

import math
import sys
from functools import cache
from importlib import import_module
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
if str(HERE) not in sys.path:
    sys.path.append(str(HERE))  # studies are files, not a package
common, roads = import_module("common"), import_module("convergence_roads")
slope, crests, table = common.slope, common.crests, common.table

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
    struck = common.scene(common.cue(name))
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
    return table(columns, map(offset_row, common.NAMES), 3)


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
    struck = common.scene(common.cue("kim"))
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
    return "\n\n".join(part.rstrip("\n") for part in parts) + "\n"


def main() -> None:
    """Write the table and the figures."""
    (HERE / "convergence.md").write_text(report(), encoding="utf-8")
    import_module("convergence_figures").figures(HERE, sys.modules[__name__])


if __name__ == "__main__":
    main()
