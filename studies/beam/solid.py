"""How close is the beam to the solid cue, and which shear coefficient is right?

The same cue by 3-D elasticity (cuefem.solid: harmonic m = 1, quadrilaterals of order 6) and by the beam of
cuefem, both converged below the figures shown. First the shear coefficient: of a rod with its ends held in the plane
(U = V = 0, free to warp) the lowest mode is a wave of k = pi/L, exactly; Timoshenko's dispersion, solved for kappa G A,
gives the right coefficient as k -> 0. Then free cues: six frequencies, the tip's amplitude, the end masses (from as
many modes on both sides, those below 20 kHz, without a tail). Last, one feature at a time on a uniform rod. About 60 s.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from click.testing import CliRunner
from scipy.special import j0, j1, jn_zeros

from cuefem import Cue, Material, Segment, modes
from cuefem.beam.tip import tip_modes
from cuefem.beam.waves import modes_below
from cuefem.cli import main
from cuefem.cue import Array, shear_coefficient
from cuefem.endmass.drives import formula_of
from cuefem.materials import material
from cuefem.solid.half_section import Fineness
from cuefem.solid.shaft import AXIAL, Body, SolidModes
from studies import pages
from studies.pages import table
from studies.strokes import MESHES, NAMES, cue, scene

COUNT = 6
HIGHEST = 20e3  # Hz: below the first thickness modes of every shaft here
FINE, ROUGH = Fineness(8, 0.2, 0.03), Fineness(6, 0.4, 0.04)
WOOD, CARBON, FOAM = material("hard maple"), material("carbon fibre"), material("foam")
MELAMINE, LEATHER = material("melamine"), material("leather")
ACROSS = {"across_ratio": WOOD.across_ratio, "nu_across": WOOD.nu_across}
KIM_CONE = cue("kim").segments[0]
KIM_WOOD = replace(KIM_CONE.material, **ACROSS)
KIM_ISOTROPIC = replace(KIM_CONE.material, G=KIM_WOOD.E / 2.6)


def kim(wood: Material, kappa: float | None = None) -> Cue:
    """Kim's cone of another material; kappa left out: Hutchinson's."""
    return Cue((replace(KIM_CONE, material=wood, kappa=kappa),), body_mass=0.42)


def rod(wood: Material = WOOD, *, length: float = 0.7, diameter: float = 0.0128, bore: float = 0.0) -> Cue:
    return Cue((Segment(length, diameter, diameter, wood, bore, bore),))


# The long wave: which shear coefficient?


def wave(whole: Cue, slenderness: float) -> tuple[float, float]:
    """(k, omega) of the lowest mode of a uniform cue's section at a length of ``slenderness`` radii."""
    section = whole.segments[0]
    length = slenderness * section.tip_diameter / 2
    body = Body(Cue((replace(section, length=length),)), Fineness(8, slenderness / 8, length / 6, 1.5, 1))
    return math.pi / length, float(body.modes(1, supported=True).omega[0])


def long_wave(whole: Cue) -> tuple[float, float]:
    """(bending stiffness over E I, kappa G A in N) that the solid has in the limit k -> 0, from four wave lengths.

    A section of one material has E I exactly; materials of unlike nu stiffen each other.
    """
    found = np.array([wave(whole, s) for s in (48.0, 68.0, 96.0, 136.0)])
    k2, omega2 = found.T**2
    s = whole.section(0.0)
    ratio = 1.0
    if whole.segments[0].core:  # rhoA omega2/k2^2 = EI (1 - k2 (rhoI/rhoA + EI/kGA) + ...)
        ratio = float(np.polyfit(k2, s.rhoA * omega2 / (s.EI * k2**2), 3)[-1])
    EI = ratio * s.EI
    kGA = s.rhoA * omega2 * (EI * k2 - omega2 * s.rhoI) / (EI * k2**2 - omega2 * (s.rhoA + s.rhoI * k2))
    return ratio, float(np.polyfit(k2, kGA, 3)[-1])


def cowper(nu: float, bore_ratio: float = 0.0) -> float:
    """Cowper's coefficient of a round section (J. Appl. Mech. 33 (1966) 335)."""
    c = bore_ratio**2
    return 6 * (1 + nu) * (1 + c) ** 2 / ((7 + 6 * nu) * (1 + c) ** 2 + (20 + 12 * nu) * c)


SECTIONS = {"solid, nu 0.3": (KIM_ISOTROPIC, 0.0), "solid, maple": (WOOD, 0.0), "solid, E/G 15": (KIM_WOOD, 0.0)} | {
    f"bore {c:g}, {words}": (wood, c)
    for words, wood in (("nu 0.3", KIM_ISOTROPIC), ("maple", WOOD), ("carbon", CARBON))
    for c in (0.5, 0.8, 0.95)
}


@cache
def kappa(name: str) -> float:
    """The solid's shear coefficient of a section of SECTIONS."""
    wood, ratio = SECTIONS[name]
    whole = rod(wood, bore=ratio * 0.0128)
    area = float(whole.section(0.0).kGA) / float(shear_coefficient(wood.effective_poisson_ratio, ratio))
    return long_wave(whole)[1] / area


def coefficients() -> Iterator[list[str | float]]:
    for name, (wood, ratio) in SECTIONS.items():
        solid, nu = kappa(name), wood.effective_poisson_ratio
        rules = (float(shear_coefficient(nu, ratio)), cowper(nu, ratio), float(shear_coefficient(wood.nu, ratio)))
        yield [name, f"{nu:.3f}", f"{solid:.5f}", *(f"{rule:.5f} ({gap(rule, solid)})" for rule in rules)]


def gap(beam: float, solid: float) -> str:
    """Relative difference of the beam, with one figure."""
    part = beam / solid - 1
    return "0" if abs(part) < 5e-6 else f"{part:+.0e}"


CORED = {
    "melamine over maple, 5/16 in": Cue((Segment(0.1, 0.0128, 0.0128, MELAMINE, 0.00794, 0.00794, WOOD),)),
    "carbon tube, 0.8 mm wall, foam": Cue((Segment(0.1, 0.0124, 0.0124, CARBON, 0.0108, 0.0108, FOAM),)),
    "phenolic on a steel pin": Cue(
        (Segment(0.1, 0.0216, 0.0216, material("phenolic"), 0.0085, 0.0085, material("steel")),)
    ),
}


def cored() -> Iterator[list[str | float]]:
    for name, whole in CORED.items():
        EI, kGA = long_wave(whole)
        model = float(whole.section(0.0).kGA)
        yield [name, f"{EI - 1:+.1e}", 1e-3 * kGA, 1e-3 * model, f"{100 * (model / kGA - 1):+.1f}"]


# Free cues


def solid_modes(struck: Cue, count: int, how: Fineness = FINE) -> SolidModes:
    """Free modes of the solid, two rigid ones and ``count`` more."""
    return _solid_modes(Cue(tuple(replace(piece, kappa=None) for piece in struck.segments)), count, how)


@cache
def _solid_modes(struck: Cue, count: int, how: Fineness) -> SolidModes:
    return Body(struck, how).modes(count + 2)


def own_error(struck: Cue) -> float:
    """The largest change of the six frequencies of the solid from a coarser mesh: more than its error."""
    fine, rough = (solid_modes(struck, COUNT, how).frequencies for how in (FINE, ROUGH))
    return float(np.max(np.abs(rough / fine - 1)))


@cache
def compared(struck: Cue) -> tuple[Array, Array, dict[str, float]]:
    """(frequencies, tip amplitudes, end masses by name) of the beam over those of the solid, less 1."""
    count = max(COUNT, modes_below(struck, 2 * np.pi * HIGHEST) - 2)
    beam, solid = modes(struck, count), solid_modes(struck, count)
    in_beam = tip_modes(beam, struck.mass)
    in_solid = replace(in_beam, omega=in_beam.omega.copy(), amplitude=in_beam.amplitude.copy())
    in_solid.omega[3:] = solid.omega[2:]
    in_solid.amplitude[1:, 1] = solid.tip
    masses = {}
    for T in (1e-3, 2e-3):
        at = scene(struck, T)
        for drive in ("stick", "velocity", "force"):
            ours, theirs = (formula_of(drive)(tip, at) for tip in (in_beam, in_solid))
            masses[f"{drive} {1e3 * T:g} ms"] = ours / theirs - 1
    tips = in_beam.amplitude[3:, 1] / solid.tip[2:] - 1
    return (beam.frequencies / solid.frequencies - 1)[:COUNT], tips[:COUNT], masses


CUES = {"isotropic, Hutchinson": kim(KIM_ISOTROPIC), "isotropic, Cowper": kim(KIM_ISOTROPIC, cowper(0.3))} | {
    "wood, Hutchinson": kim(KIM_WOOD),
    "wood, Cowper": kim(KIM_WOOD, cowper(KIM_WOOD.nu)),
    "wood, 0.9 as in kim.toml": kim(KIM_WOOD, KIM_CONE.kappa),
    "pool_maple": cue("pool_maple"),
    "pool_hollow": cue("pool_hollow"),
    "carbon": cue("carbon"),
}


# What cuefem check says

CHECKED = {name: MESHES / f"{name}.toml" for name in NAMES}
CHECK_SHOWS = {
    "tone 1": "tone 1",
    "tone 6": "tone 6",
    "stiffness at the tip, butt held": "stiffness across",
    "stiffness along the axis, butt held": "along",
    "give of the tip, cue free": "give of the tip",
    "end mass, stick": "end mass, stick",
    "end mass, force": "end mass, force",
    "squirt": "squirt",
}


def checked() -> Iterator[list[str | float]]:
    """What the command says of every cue of meshes/."""
    for name, file in CHECKED.items():
        answer = CliRunner().invoke(main, ["check", str(file), "--json"], catch_exceptions=False)
        by_name = {row["quantity"]: row for row in json.loads(answer.stdout)["rows"]}
        offs = [f"{by_name[quantity]['difference']:+.1e}" for quantity in CHECK_SHOWS]
        yield [name, *offs, f"{max(row['mesh_error'] for row in by_name.values()):.0e}"]


# What is left on Kim's cone, and why


def taper(struck: Cue) -> Array:
    """What the shear that a taper makes of the bending moment changes in the frequencies of the beam of a solid cone.

    The bending stress s x (s = M/I) of a cone of slope a pulls shear a s x out of its surface, and falls along it by
    4 a s/R beside V/I. With p = ds/dz and q = a s/R the shear is t_xz = A + B x^2 + C y^2, t_yz = D x y, where
    equilibrium, the free surface and compatibility (t_yz,x - t_xz,y = n p y, n = 2 nu_LT G/E) ask
    C = -p (1 + 3n)/8, B = -p (3 + n)/8, D = -p (1 - n)/4, A = R^2 (q + p (3 + n)/8); its sum is I (4 q + p) = V. The
    beam counts the energy of V alone, q = 0. By Rayleigh's principle half the difference over the mode's energy is the
    relative error of the frequency, to first order in a^2 E/G.
    """
    segment, found = struck.segments[0], modes(struck, COUNT)
    ends = np.array([segment.tip_diameter, segment.butt_diameter]) / 2
    points, weights = np.polynomial.legendre.leggauss(100)
    x, weights, h = (points + 1) / 2 * segment.length, weights * segment.length / 2, 1e-5 * segment.length
    (_, turn), ((w1, t1), (w0, t0)) = found.shape(x), (found.shape(x + d) for d in (h, -h))
    section, radius = struck.section(x), ends[0] + (ends[1] - ends[0]) * x / segment.length
    wood, nu = segment.material, segment.material.effective_poisson_ratio
    n, inertia = nu / (1 + nu), np.pi / 4 * radius**4
    q = -(ends[1] - ends[0]) / segment.length * wood.E * (t1 - t0) / (2 * h) / radius
    force = section.kGA * ((w1 - w0) / (2 * h) - turn)

    def energy(q: Array | float, p: Array) -> Array:
        A, B, C, D = q + p * (3 + n) / 8, -p * (3 + n) / 8, -p * (1 + 3 * n) / 8, -p * (1 - n) / 4
        squares = A**2 + (B**2 + C**2) / 8 + B * C / 12 + A * (B + C) / 2 + D**2 / 24
        return np.pi * radius**6 * squares / (2 * wood.G)

    excess = energy(q, force / inertia - 4 * q) - energy(0.0, force / inertia)
    return np.asarray(excess @ weights / found.omega**2)


def uniform(wood: Material) -> Cue:
    """A rod as long and as thick, in the mean, as Kim's cone."""
    return rod(wood, diameter=0.0165)


def causes(wood: Material) -> Iterator[list[str | float]]:
    cone, straight = (compared(struck)[0] for struck in (kim(wood), uniform(wood)))
    shear = taper(kim(wood))
    yield ["the cone", *signed(cone)]
    yield ["shear of the taper, derived", *signed(shear)]
    yield ["a uniform rod of 16.5 mm", *signed(straight)]
    yield ["left", *signed(cone - shear - straight)]


FERRULE = {f"melamine ferrule over a tenon, {1e3 * long:g} mm": long for long in (0.006, 0.0125, 0.025)}


def fronted(*front: Segment) -> Cue:
    """The plain rod behind other pieces, as long as it was."""
    rest = 0.7 - sum(piece.length for piece in front)
    return Cue((*front, Segment(rest, 0.0128, 0.0128, WOOD)))


def piece(length: float, wood: Material, bore: float = 0.0, core: Material | None = None) -> Segment:
    return Segment(length, 0.0128, 0.0128, wood, bore, bore, core)


FEATURES = {
    "none: a uniform rod, 0.7 m, 12.8 mm, maple": rod(),
    "half as long": rod(length=0.35),
    "a cone, 12 to 21 mm": Cue((Segment(0.7, 0.012, 0.021, WOOD),)),
    "a cone twice as steep, 12 to 30 mm": Cue((Segment(0.7, 0.012, 0.030, WOOD),)),
    "a jump from 12.8 to 15 mm in the middle": Cue((piece(0.35, WOOD), Segment(0.35, 0.015, 0.015, WOOD))),
    "a bore of 6 mm, 127 mm deep": fronted(piece(0.127, WOOD, 0.006)),
    "bored through, 6.4 mm (wall 3.2)": rod(bore=0.0064),
    "bored through, 10.24 mm (wall 1.3)": rod(bore=0.01024),
    "bored through, 12.16 mm (wall 0.3)": rod(bore=0.01216),
    "carbon tube, wall 0.8 mm": rod(CARBON, bore=0.0112),
    "leather tip, 6 mm": fronted(piece(0.006, LEATHER)),
    "ABS ferrule, 13 mm": fronted(piece(0.013, material("abs"))),
    **{name: fronted(piece(long, MELAMINE, 0.00794, WOOD)) for name, long in FERRULE.items()},
    "steel pin of 8.5 mm, 60 mm long, in the middle": Cue(
        (piece(0.32, WOOD), piece(0.06, WOOD, 0.0085, material("steel")), piece(0.32, WOOD))
    ),
}


def features() -> Iterator[list[str | float]]:
    for name, struck in FEATURES.items():
        found, _, masses = compared(struck)
        worst = float(np.max(np.abs(found)))
        row = (found[0], found[2], found[5], masses["stick 1 ms"])
        yield [name, *signed(np.array(row)), "yes" if worst < 1e-4 else "no"]


def ferrule_give(E: float, nu: float, radius: float, bore: float) -> float:
    """The give, m/N, of a ferrule's end when the force leaves it through a ring alone, evenly spread there.

    Less its mean, the ring's stress is a sum of p_k J0(k r), k = j_1k/R, each of which sinks a half-space by
    2 (1 - nu^2)/(E k) p_k J0(k r) and dies away within R/j_1k; the give is twice their energy over the force squared.
    """
    roots = jn_zeros(1, 20000)
    k, height = roots / radius, radius**2 / 2 * j0(roots) ** 2
    part = -bore * j1(k * bore) / k / (np.pi * (radius**2 - bore**2)) / height
    return float(np.sum(2 * (1 - nu**2) / (E * k) * part**2 * 2 * np.pi * height))


def along_the_axis(struck: Cue, order: int) -> float:
    """The solid's give along the axis less the beam's, m/N."""
    points, weights = np.polynomial.legendre.leggauss(40)
    beam = sum(float(weights @ (s.length / 2 / s.section((points + 1) / 2 * s.length).EA)) for s in struck.segments)
    return float(Body(struck, Fineness(order, 0.8, 0.05), AXIAL).give - beam)


FERRULE_E = (0.25, 1.0, 4.0)


def ferrules() -> Iterator[list[str | float]]:
    """The carbon cue without its leather, its ferrule of other moduli: the give that a beam leaves out."""
    drawn = cue("carbon")
    _, ferrule, *rest = drawn.segments
    for times in FERRULE_E:
        plastic = replace(ferrule.material, E=times * ferrule.material.E, G=times * ferrule.material.G)
        struck = replace(drawn, segments=(replace(ferrule, material=plastic), *rest))
        coarse, fine = (along_the_axis(struck, order) for order in (6, 8))
        rule = ferrule_give(plastic.E, plastic.nu, ferrule.butt_diameter / 2, rest[0].tip_bore / 2)
        yield [f"{plastic.E / 1e9:.3g}", *(f"{give:.2e}" for give in (rule, fine, coarse))]


def signed(values: Array) -> list[str]:
    return [f"{v:+.1e}" for v in values]


def frequencies() -> Iterator[list[str | float]]:
    for name, struck in CUES.items():
        own = own_error(struck)
        yield [name, *signed(compared(struck)[0]), f"{own:.0e}" if own > 1e-9 else "< 1e-09"]


def responses() -> Iterator[list[str | float]]:
    for name, struck in CUES.items():
        _, tips, masses = compared(struck)
        yield [name, *signed(tips[[0, 2, 5]]), *signed(np.array(list(masses.values())))]


def across_grain() -> Iterator[list[str | float]]:
    """Kim's wooden cone with other constants across the grain."""
    struck = kim(KIM_WOOD)
    beam = modes(struck, COUNT).frequencies
    for ratio, nu in ((WOOD.across_ratio, WOOD.nu_across), (0.05, 0.5), (0.2, 0.4), (1.0, 0.3)):
        wood = replace(KIM_WOOD, across_ratio=ratio, nu_across=nu)
        solid = Body(kim(wood), FINE).modes(COUNT + 2)
        yield [f"{ratio:g}", f"{nu:g}", *signed(beam / solid.frequencies - 1)]


def slopes() -> Iterator[list[str | float]]:
    """The first frequency of cones of 0.7 m and 16.5 mm in the mean against their slope; wood and isotropic."""
    for half in (0.00225, 0.0045, 0.006):
        row = []
        for wood in (KIM_ISOTROPIC, KIM_WOOD):
            struck = Cue((Segment(0.7, 0.0165 - half, 0.0165 + half, wood),))
            off = modes(struck, 1).frequencies[0] / solid_modes(struck, COUNT).frequencies[0] - 1
            row += [f"{off:+.2e}", f"{off / (half / 0.7) ** 2:.2f}"]
        yield [f"{half / 0.7:.5f}", *row]


NUMBERS = [f"mode {k}" for k in range(1, COUNT + 1)]
MASSES = [f"{drive} {T} ms" for T in (1, 2) for drive in ("stick", "velocity", "force")]


def text() -> str:
    """The page: every difference is the beam's over the solid's, less 1."""
    rules = ["Hutchinson, nu_e", "Cowper, nu_e", "Hutchinson, nu_LT itself"]
    return f"""# Beam and solid

Differences are the beam's value divided by the solid's, minus 1.

The shear coefficient that the long waves of the solid need, with nu_e/(1 + nu_e) = 2 nu_LT G/E:

{table(["section", "nu_e", "solid", *rules], coefficients())}
Hutchinson's coefficient at nu_e is exact for solid and hollow sections, isotropic or not, and for every E_T: the
shear of a rod that bends slowly depends on the material only through nu_LT G/E. (For a solid circle it is
Timoshenko's own coefficient of 1922.)

Sections of two materials, whose kappa G A the beam takes as the sum of shell and core:

{table(["section", "E I, solid over sum, less 1", "kappa G A, solid, kN", "beam, kN", "beam off by, %"], cored())}
Frequencies of free cues; the last column bounds the error of the solid itself:

{table(["cue", *NUMBERS, "own error"], frequencies())}
Free cues: amplitude of the tip (mean over its face) and end masses, from the modes below 20 kHz, equally many in both:

{table(["cue", "tip, mode 1", "mode 3", "mode 6", *MASSES], responses())}
The stick end mass begins with a step of velocity, to which every mode responds, so the highest modes differ most.

What `cuefem check` says of the cues of meshes/ on its usual stroke; waves along the cue and thrust are on neither side:

{table(["cue", *CHECK_SHOWS.values(), "own error, largest"], checked())}
The carbon cue is 6.6 % stiffer along the axis as a beam than as a solid, because of its ferrule: a solid piece of ABS,
12.4 mm wide, on a wall of 0.8 mm round soft foam. Its sections cannot stay plane, for the force leaves it through the
wall alone. Were it spread evenly over the wall, the give would be 2 (1 - nu²)/E over a length that the section sets
(derived in solid.py). A soft ferrule gives less, because it settles where the wall lets it; under a stiff one the end
of the wall gives too. The leather's own give along the axis is 5e-7 m/N, so that a stroke hardly notices.

{table(["E of the ferrule, GPa", "evenly spread, m/N", "solid less beam, m/N", "a coarser mesh"], ferrules())}
Kim's wooden cone with other constants across the grain:

{table(["E_T/E_L", "nu_T", *NUMBERS], across_grain())}
The error of a cone's first mode grows like the square of its slope (radius over length):

{table(["slope", "isotropic", "over slope²", "wood (E/G 15)", "over slope²"], slopes())}
Causes of the differences on Kim's cone, in wood: the taper turns bending stress into shear, which no beam describes
(derived in solid.py); in higher modes sections also warp, as they do in a uniform rod:

{table(["wood", *NUMBERS], causes(KIM_WOOD))}
{table(["isotropic", *NUMBERS], causes(KIM_ISOTROPIC))}
One feature at a time, maple:

{table(["rod", "mode 1", "mode 3", "mode 6", "stick 1 ms", "six within 1e-4"], features())}"""


def draw(panels: Any) -> None:
    cone, shafts = panels
    number = np.arange(1, COUNT + 1)
    for axis, names in ((cone, list(CUES)[:5]), (shafts, list(CUES)[5:])):
        for name, mark in zip(names, "osd^v", strict=False):
            axis.semilogy(number, np.abs(compared(CUES[name])[0]), f"{mark}-", ms=5, label=name)
        axis.axhline(1e-4, color="black", lw=0.8, ls="--")
        axis.set(xlabel="bending mode", ylim=(2e-7, 1e-1), xticks=number)
        axis.legend(fontsize=8, loc="upper left")
    cone.set(ylabel="frequency: |beam/solid - 1|", title="Kim's cone")
    shafts.set(title="shafts of meshes/")


LONG = {"SECTIONS": SECTIONS, "CORED": CORED, "CUES": CUES, "CHECKED": CHECKED, "FEATURES": FEATURES}
SHORT = {"SECTIONS": 2, "CORED": 1, "CUES": 3, "CHECKED": 2, "FEATURES": 4}
STUDY = pages.Study(
    __file__,
    text,
    {"solid.svg": pages.Figure(draw, (1, 2), (9.6, 4.4))},
    again={
        "some rows": pages.Again(
            text,
            left_out=sum((len(LONG[name]) - count) * (2 if name == "CUES" else 1) for name, count in SHORT.items()),
            instead={name: pages.some_of(LONG[name], count) for name, count in SHORT.items()},
        )
    },
)


if __name__ == "__main__":
    STUDY.write()
