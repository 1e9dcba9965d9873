"""Which part of a cue determines its end mass: one curve, and the contact time that follows from it.

Derivation: an infinite Euler-Bernoulli beam with a free end, a = sqrt(EI/rhoA). In the Laplace domain, with
q = sqrt(s/2a), a velocity V(s) of its end moves the point x by V exp(-qx) cos(qx). A mass m there adds the force
m s V (exp(-qx) cos(qx))^2 at the end, to first order in m, by reciprocity. The impulse of that force, over m V(T), is
the weight of the mass in the end mass. For a velocity step it is `step_weight`, by Duhamel's integral that of any
velocity; a given normal force prescribes the velocity of a tip that sticks (handbook: Effective end mass). The moment
of the force on a dome moves a held tip's shaft by s M exp(-qx) sin(qx)/(2 EI q^2): the mass adds the weight `domed`.
`distribution.py FILE` prints the places of a cue.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.optimize import brentq
from scipy.special import erfc

import cuefem as cf
from studies import pages, strokes
from studies.pages import number, table
from studies.strokes import NAMES, POOL, cue, drawn_stroke, full_model, own_stroke, pool_scene
from tests.oracle.small_steps import solve_small_steps

COUNT, SEED, CLAY, TIME = 40, 1, 5e-3, 1.2e-3  # drawn strokes; kg; s
E, Q = 0.73, POOL.mass / 0.54  # restitution, ball over cue
PLACES = np.r_[0.5, 0.8, 0.9, np.arange(1.0, 1.45, 0.05)]  # xi of the clay
SCATTER = 0.09  # of one stroke of the robot (measured/squirt.md)
STIFF = cf.Material(E=12e9, G=19.9e9, rho=700.0)  # nearly without shear strain
GAUSS = tuple((np.array(x) + shift) / 2 for x, shift in zip(np.polynomial.legendre.leggauss(300), (1, 0), strict=True))


def step_weight(xi: Any) -> Any:
    """Weight of a mass at xi = x/sqrt(aT) in the end mass of a step of velocity: 1 at the tip."""
    return (erfc(xi / math.sqrt(2)) + erfc((1 + 1j) * xi / math.sqrt(2)).real) / 2


def weight(xi: float, initial: float, rate: Callable[[Any], Any]) -> float:
    """Weight for a velocity that starts at ``initial`` and has the derivative ``rate`` in t/T, and ends at 1."""
    root, share = GAUSS  # 1 - t/T = root^2
    later = share * 2 * root * rate(1 - root**2) * step_weight(xi / root)
    return float(initial * step_weight(xi) + later.sum())


def smooth(xi: float) -> float:
    """Weight for the velocity (1 - cos(pi t/T))/2."""
    return weight(xi, 0.0, lambda t: np.pi / 2 * np.sin(np.pi * t))


def sticking(xi: float, restitution: float = E, q: float = Q) -> float:
    """Weight for a tip that sticks, (K P(t) - 1)/(K - 1): P of a spring tip, q the ball's mass over the cue's."""
    K = (1 + restitution) * (1 + 1 / 0.4 + q) / (1 + q)

    def rate(t: Any) -> Any:
        phase = np.pi / 2 * (1 + restitution) * t
        return np.where(phase < np.pi / 2, np.sin(phase), np.cos((phase - np.pi / 2) / restitution))

    return weight(xi, -1 / (K - 1), lambda t: K / (K - 1) * np.pi / 2 * rate(t))


def domed(xi: float, radius: float, time: float, shaft: cf.Cue, restitution: float = E) -> float:
    """Weight for a tip that sticks, with a dome of this radius, m, at a contact time, s, on a uniform shaft."""
    section, q = shaft.section(0.0), POOL.mass / shaft.mass
    K = (1 + restitution) * (1 + 1 / 0.4 + q) / (1 + q)
    spread = float(section.rhoA) * math.sqrt(float(section.EI / section.rhoA)) * time  # rhoA a T
    share = radius * (1 + restitution) * POOL.mass / (1 + q) / (2 * spread * (K - 1))
    root, part = GAUSS
    phase = np.pi / 2 * (1 + restitution) * (1 - root**2)
    falling = -np.sin((phase - np.pi / 2) / restitution) / restitution
    force_rate = (np.pi / 2) ** 2 * (1 + restitution) * np.where(phase < np.pi / 2, np.cos(phase), falling)
    moment = part * 2 * root * force_rate * -erfc((1 + 1j) * xi / root / math.sqrt(2)).imag
    return sticking(xi, restitution, q) + share * float(moment.sum())


def zeros(of: Callable[[float], float], last: float = 2.4) -> list[float]:
    """Where a weight changes its sign."""
    xi = np.linspace(0.4, last, 60)
    values = [of(x) for x in xi]
    return [brentq(of, *xi[i : i + 2]) for i in range(len(xi) - 1) if values[i] * values[i + 1] < 0]


def travel(shaft: cf.Cue, x: Any) -> Any:
    """Integral of (rhoA/EI)^(1/4) from the tip to x, s^(1/2): of a uniform shaft x/sqrt(a); xi is it over sqrt(T)."""
    at = np.linspace(0.0, 0.6, 1201)
    section = shaft.section(at)
    return np.interp(x, at, cumulative_trapezoid((section.rhoA / section.EI) ** 0.25, at, initial=0.0))


def place(shaft: cf.Cue, xi: float, time: float) -> float:
    """The distance from the tip, m, that has this xi at a contact time, s."""
    at = np.linspace(0.0, 0.6, 1201)
    return float(np.interp(xi * math.sqrt(time), travel(shaft, at), at))


def with_clay(struck: cf.Scene, x: float) -> cf.Scene:
    """The scene with clay on the shaft."""
    return replace(struck, effects=(*struck.effects, cf.PointMass(position=x, mass=CLAY)))


class Crossing(NamedTuple):
    """A stroke: contact time, s; where clay changes no squirt, m and xi; slope of ln squirt over xi; bored or not."""

    time: float
    x: float
    xi: float
    xi_of_tip: float
    slope: float
    bored: bool


def is_bored(shaft: cf.Cue) -> bool:
    """Whether a piece longer than a ferrule is hollow."""
    return any(piece.tip_bore > 0 and piece.length > 0.03 for piece in shaft.segments)


def crossing(struck: cf.Scene) -> Crossing | None:
    """The first place where clay does not change the squirt of the coupled strike; None if none is in `PLACES`."""
    plain, shaft = cf.strike(struck), struck.shaft
    spots = [place(shaft, xi, float(plain.duration)) for xi in PLACES]
    changes = cf.batch_strike([with_clay(struck, x) for x in spots]).squirt / plain.squirt - 1
    falling = np.flatnonzero((changes[:-1] > 0) & (changes[1:] <= 0))
    if not len(falling):
        return None
    i = falling[0]
    slope = (changes[i + 1] - changes[i]) / (PLACES[i + 1] - PLACES[i])
    xi = PLACES[i] - changes[i] / slope
    x, tip = place(shaft, xi, float(plain.duration)), shaft.section(0.0)
    of_tip = x * float(tip.rhoA / tip.EI) ** 0.25 / math.sqrt(plain.duration)
    return Crossing(float(plain.duration), x, xi, of_tip, slope, is_bored(shaft))


@cache
def drawn() -> list[Crossing | None]:
    """Crossings of drawn strokes."""
    draw = np.random.default_rng(SEED)
    return [crossing(drawn_stroke(draw)) for _ in range(COUNT)]


def found() -> list[Crossing]:
    """The drawn strokes that have a crossing."""
    return [each for each in drawn() if each]


def spread(values: Any, digits: int = 2) -> list[str]:
    """Median, 2.5 and 97.5 %, and number of values."""
    low, middle, high = np.percentile(values, [2.5, 50, 97.5])
    return [f"{middle:.{digits}f}", f"{low:.{digits}f} to {high:.{digits}f}", str(len(values))]


def median_xi() -> float:
    """Where clay changes no squirt in drawn strokes."""
    return float(np.median([each.xi for each in found()]))


def time_errors() -> np.ndarray:
    """Relative errors, %, of contact times from the place where clay changes no squirt."""
    return np.array([100 * ((each.xi / median_xi()) ** 2 - 1) for each in found()])


def drawn_table() -> str:
    """The curve's zero over drawn strokes."""
    groups = {
        "all shafts": found(),
        "not bored": [c for c in found() if not c.bored],
        "bored or tubes": [c for c in found() if c.bored],
    }
    rows = [[name, *spread([c.xi for c in group]), *spread([c.xi_of_tip for c in group])[:2]]
            for name, group in groups.items()]  # fmt: skip
    columns = ["drawn strokes", "ξ0, median", "95 %", "n", "x0/√(T√(EI/ρA)) at the tip, median", "95 %"]
    return table(columns, rows)


def uniform() -> cf.Cue:
    """A long thin cylinder of 3 mm radius."""
    return cf.Cue((cf.Segment(1.5, 6e-3, 6e-3, STIFF),), 0.5)


@cache
def finite_element_weight(xi: float) -> float:
    """Weight by finite elements, for the velocity (1 - cos(pi t/T))/2."""
    lump = cf.PointMass(position=place(uniform(), xi, 1e-3), mass=1e-5)
    base = strokes.scene(uniform())
    return (cf.end_mass(replace(base, effects=(lump,)), "velocity") - cf.end_mass(base, "velocity")) / lump.mass


def check_table() -> str:
    """The derived curve beside finite elements."""
    rows = [[f"{xi:g}", *(f"{v:.4f}" for v in (smooth(xi), finite_element_weight(xi), sticking(xi)))]
            for xi in (0.2, 0.5, 1.0, 1.5, 2.0)]  # fmt: skip
    columns = ["ξ", "given velocity, closed form", "given velocity, finite elements", "sticking tip, closed form"]
    return table(columns, rows)


@cache
def oracle_changes() -> list[tuple[float, float, float]]:
    """xi, and the change of squirt by clay, %, of the coupled strike and of the oracle in small steps."""
    base = pool_scene(strokes.plain_maple(), TIME, 0.3, (strokes.DOME, strokes.SHEAR))
    plain, stepped = cf.strike(base).squirt, solve_small_steps(base, 150, 1000).squirt
    rows = []
    for xi in (0.5, 1.0, 1.3):
        heavier = with_clay(base, place(base.shaft, xi, TIME))
        ratios = cf.strike(heavier).squirt / plain, solve_small_steps(heavier, 150, 1000).squirt / stepped
        rows.append((xi, *(100 * (ratio - 1) for ratio in ratios)))
    return rows


@cache
def tips() -> list[list[str]]:
    """The curve's first zero on a uniform shaft, by the model of the tip: closed form, and coupled strike."""
    rod = cf.Cue((cf.Segment(0.74, 12.5e-3, 12.5e-3, cf.Material(12e9, 0.8e9, 700.0)),), 0.45)
    rows = []
    for radius in (0.0, 5e-3, 9.5e-3):
        closed = zeros(partial(domed, radius=radius, time=TIME, shaft=rod))[0]
        effects = (cf.TipDome(radius),) if radius else ()
        struck = first_zero(pool_scene(rod, TIME, 0.03, effects))
        rows.append([f"spring that sticks, dome of {1e3 * radius:g} mm", f"{closed:.2f}", f"{struck:.2f}"])
    soft = first_zero(pool_scene(rod, TIME, 0.3, (strokes.DOME, strokes.SHEAR)))
    leather = first_zero(full_model(rod, 0.3))
    rows.append(["the last, b/R 0.3 and tangential compliance", pages.NONE, f"{soft:.2f}"])
    return [*rows, ["leather (default stroke), b/R 0.3", pages.NONE, f"{leather:.2f}"]]


def first_zero(struck: cf.Scene) -> float:
    """xi where a small mass first changes no squirt; nan if nowhere below 1.8."""
    plain = cf.strike(struck)
    xi = np.arange(0.6, 1.81, 0.05)
    masses = [cf.PointMass(position=place(struck.shaft, x, float(plain.duration)), mass=1e-4) for x in xi]
    heavier = [replace(struck, effects=(*struck.effects, mass)) for mass in masses]
    changes = cf.batch_strike(heavier).squirt - plain.squirt
    falling = np.flatnonzero((changes[:-1] > 0) & (changes[1:] <= 0))
    if not len(falling):
        return math.nan
    ends = slice(falling[0], falling[0] + 2)
    return float(np.interp(0, -changes[ends], xi[ends]))


def needed_strokes(error: float) -> int:
    """Strokes with the clay, and as many without it, for a contact time to a relative error."""
    slope = abs(float(np.median([each.slope for each in found()])))
    return math.ceil(2 * (SCATTER / (slope * median_xi() * error / 2)) ** 2)


def text() -> str:
    errors, ends = time_errors(), zeros(sticking)
    return pages.page(
        "End-mass distribution along the shaft",
        "Which part of a cue determines its end mass, and what does that depend on?",
        f"The first 10 cm, by one curve. A mass counts by ξ = ∫(ρA/EI)^¼ dx/√T, the way that bending waves of the "
        f"contact time T travel. Clay of {1e3 * CLAY:g} g changes no squirt at ξ0 = {median_xi():.2f} (95 % of "
        f"{len(errors)} drawn "
        f"strokes: {spread([c.xi for c in found()])[1]}), so that its place measures T without a camera: "
        f"T = (∫(ρA/EI)^¼ dx/{median_xi():.2f})², within {np.percentile(abs(errors), 95):.0f} % for 95 % of them "
        f"(median {np.median(abs(errors)):.0f} %).",
        "## Derivation",
        "A long shaft is an Euler-Bernoulli beam with a free end; a = √(EI/ρA). With q = √(s/2a) in the Laplace "
        "domain, a velocity V of its end moves the point x by V e^(-qx) cos qx. A small mass m at x adds the force "
        "m s V (e^(-qx) cos qx)² at the end (reciprocity); its impulse over m V(T) is the weight of the mass in "
        "the end "
        "mass. A step of velocity has, with ξ = x/√(aT),",
        "```text\nW(ξ) = ½ erfc(ξ/√2) + ½ Re erfc((1 + i) ξ/√2)\n"
        "w(ξ) = v(0) W(ξ) + ∫ v'(t) W(ξ/√(1 - t)) dt,   0 < t < 1,   v(1) = 1\n```",
        "and any velocity v(t/T) has w. A tip that sticks has v = (K P - 1)/(K - 1) for the normal impulse P(t) of "
        "a given "
        f"normal force ([end_mass](../../cuefem/handbook/end_mass.md)): zeros at ξ = "
        f"{', '.join(f'{x:.2f}' for x in ends)}. Beyond the first "
        "zero, waves that the mass reflects reduce squirt. By homogeneity ∫w dξ is ¾ of the C in m_e = C ρA √(aT). "
        "(A half-sine force instead of a velocity gives a mass at the tip no weight: it acts on the velocity only "
        "while force acts.)",
        check_table(),
        "## Tip",
        "The moment of the force on a dome of radius r pushes the shaft too. It adds D w₂(ξ) to w, with "
        "W₂ = -Im erfc((1 + i) ξ/√2) instead of W, the rate of the normal force instead of that of v, and "
        "D = r (1 + e) m/(2 ρA a T (K - 1)), m the reduced mass of ball and cue: 0.2 here. First zero on a uniform "
        "shaft of 12.5 mm, by a mass of 0.1 g:",
        table(["tip", "closed form", "coupled strike"], tips()),
        "## Drawn shafts",
        f"{COUNT} default strokes of drawn shafts (1 to 4 pieces, wood or carbon, solid or bored), speed 1 to 4 "
        f"m/s, b/R 0.2 to 0.4, leather of 80 to "
        f"300 MPa, 4 to 8 mm high; {len(errors)} of them have a zero below ξ = {PLACES[-1]:.1f}. A taper, a "
        f"ferrule or a bore "
        "moves the place, not ξ0: the section at the tip alone predicts it worse.",
        drawn_table(),
        "![the derived curve, and the change of squirt by clay on four cues](distribution.svg)",
        "Change of squirt by the clay on the maple shaft, a spring tip with dome and compliance, by `cf.strike` "
        "and by the "
        "independent oracle (scikit-fem's beam, 150 modes, small steps): "
        + "; ".join(f"{a:+.2f} and {b:+.2f} % at ξ = {xi:g}" for xi, a, b in oracle_changes())
        + ".",
        "## Measurement",
        f"Move {1e3 * CLAY:g} g of clay along a shaft until squirt is as without it. One robot stroke scatters by "
        f"{100 * SCATTER:.0f} %: a contact "
        f"time to 10 % (1σ) takes {needed_strokes(0.1)} strokes at this place, and as many without clay; √(EI/ρA) "
        f"follows from a natural frequency "
        "of the shaft. A high-speed film of the same strokes would decide whether the curve holds.",
    )  # fmt: skip


def draw(axes: Any) -> None:
    """The derived curve, finite elements, and the change of squirt of cues by clay."""
    curve, change = axes
    xi = np.linspace(0.02, 2.5, 120)
    curve.plot(xi, [sticking(x) for x in xi], label="sticking tip, closed form")
    curve.plot(xi, [smooth(x) for x in xi], label="given velocity, closed form")
    dots = np.linspace(0.1, 2.4, 12)
    curve.plot(dots, [finite_element_weight(float(x)) for x in dots], "k.", label="given velocity, finite elements")
    curve.set(xlabel="ξ", ylabel="grams of end mass that one gram adds")
    for name in (n for n in NAMES if n != "kim"):
        scene = full_model(cue(name), 0.3)
        plain, at = cf.strike(scene), np.linspace(0.15, 2.0, 40)
        spots = [with_clay(scene, place(scene.shaft, float(x), float(plain.duration))) for x in at]
        change.plot(at, 100 * (cf.batch_strike(spots).squirt / plain.squirt - 1), label=name)
    change.axvline(median_xi(), color="black", lw=0.8, ls=":")
    change.set(xlabel="ξ", ylabel=f"change of squirt by {1e3 * CLAY:g} g, %")
    for one in axes:
        one.axhline(0, color="black", lw=0.8)
        one.legend(fontsize=8)


def answer(path: str) -> str:
    """Where clay changes no squirt of a cue's stroke, and the contact time that this place has by the curve."""
    one = crossing(own_stroke(path))
    if one is None:
        raise ValueError(
            f"squirt has no place between ξ = {PLACES[0]:g} and {PLACES[-1]:.2f} where clay does not change it"
        )
    time = one.time * (one.xi / median_xi()) ** 2
    return (
        f"{1e3 * CLAY:g} g change no squirt {number(1e3 * one.x, 3)} mm behind the tip: contact time by the curve "
        f"{number(1e3 * time, 3)} ms, in the model {number(1e3 * one.time, 3)} ms"
    )


EXAMPLE = """\
from dataclasses import replace
import cuefem as cf

scene = cf.load_scene("meshes/pool_maple.toml")
for position in (0.02, 0.05, 0.1, 0.15, 0.2):
    heavier = replace(scene, effects=(*scene.effects, cf.PointMass(position=position, mass=5e-3)))
    ratio = cf.strike(heavier).squirt / cf.strike(scene).squirt
    print(f"5 g at {1e3 * position:.0f} mm: {100 * (ratio - 1):+.0f} % squirt")
"""
STUDY = pages.Study(__file__, text, {"distribution.svg": pages.Figure(draw, (1, 2), (9.6, 4.2))}, example=EXAMPLE)

if __name__ == "__main__":
    pages.run(STUDY, answer)
