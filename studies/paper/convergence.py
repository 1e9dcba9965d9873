"""Is the lumped cue of the papers a limit of the finite-element one, and how fast is it reached?

(a) Kim's shaft in an ever longer contact at b/R 0.3: the rigid shaft (as only omega T counts, a stiff stub is the
same). (b) Kim's shaft made ever lighter at fixed shape, T = 1 ms: Kim's first order in epsilon. (c) Elements and order
of the beam. e = 3/4, mu = 0.7, a ball of 210 g. Equations: handbook: The impulse solver, The strike, Effective end
mass.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

import cuefem as cf
from studies import pages, strokes
from studies.pages import table
from studies.paper.closed_forms import cue_end_mass, squirt_slope

KIM, OFFSETS, WINDOW = strokes.cue("kim"), (0.1, 0.3, 0.5), 6  # samples in each window of (a), a factor of 2 in time
STARTS, FACTORS = 2e-3 * 2.0 ** np.arange(10), 10.0 ** np.arange(0, -5.1, -1)
FEW, MANY = cf.Resolution(4, 20, 12, steps=4000), cf.Resolution(8, 26, 22)
DRIVES = ("force", "velocity", "stick", "squirt")


@cache
def rigid_end_mass() -> float:
    """What the tip feels of the rigid motions of Kim's shaft alone, kg: of a shaft a million times as stiff."""
    (cone,) = KIM.segments
    stiff = replace(cone, material=replace(cone.material, E=1e6 * cone.material.E, G=1e6 * cone.material.G))
    return float(cf.end_mass(strokes.scene(replace(KIM, segments=(stiff,)), 1e-2), "force", at=FEW))


@cache
def long_contact() -> dict[str, np.ndarray]:
    """Largest relative errors in windows of contact time, (windows,), because the errors oscillate."""
    result: dict[str, list[float]] = {drive: [] for drive in DRIVES}
    for time in np.ravel(STARTS[:, None] * 2.0 ** (np.arange(WINDOW) / WINDOW)):
        scene = strokes.scene(KIM, float(time), 0.3)
        for drive in DRIVES[:3]:
            result[drive].append(cf.end_mass(scene, drive, at=FEW) / rigid_end_mass() - 1)
        result["squirt"].append(cf.strike(scene, FEW).squirt / strokes.lumped_squirt(scene, rigid_end_mass()) - 1)
    return {drive: np.abs(np.reshape(errors, (-1, WINDOW))).max(axis=1) for drive, errors in result.items()}


def rates() -> dict[str, float]:
    """Exponents of the errors in the contact time over the last four windows."""
    return {drive: pages.slope(STARTS[-4:], errors[-4:]) for drive, errors in long_contact().items()}


@cache
def light(offset: float) -> dict[str, np.ndarray]:
    """Squirt of lighter shafts over Kim's first order, less 1, with the stick end mass and with that at the offset."""
    result: dict[str, list[float]] = {"stick": [], "offset": []}
    for factor in FACTORS:
        (cone,) = KIM.segments
        wood = replace(cone.material, **{name: factor * getattr(cone.material, name) for name in ("E", "G", "rho")})
        shaft = replace(cone, material=wood)
        scene = strokes.scene(cf.Cue((shaft,), KIM.mass - shaft.mass), 1e-3, offset)
        squirt = float(cf.strike(scene, MANY).squirt)
        for drive, errors in result.items():
            ratio = scene.axial_mass / scene.ball.mass
            # nu_c drops out of the first order when it is written in the end mass
            mass = cue_end_mass(float(cf.end_mass(scene, drive, at=MANY)), 1.0) / scene.ball.mass
            errors.append(squirt / float(squirt_slope(offset, cue_mass_ratio=ratio, nu_c=1.0) * mass) - 1)
    return {drive: np.array(errors) for drive, errors in result.items()}


def element_table() -> str:
    """Error of squirt by 22 modes against elements and order."""
    scene = strokes.scene(KIM, 1e-3, 0.3)
    exact, counts = cf.strike(scene, cf.Resolution(8, 20, 22)).squirt, (48, 64, 96, 128)
    off = {p: [abs(cf.strike(scene, cf.Resolution(n, p, 22)).squirt / exact - 1) for n in counts] for p in (1, 2)}
    rows = [[str(n), *(f"{off[p][i]:.0e}" for p in off)] for i, n in enumerate(counts)]
    return table(
        ["elements", *(f"order {p}" for p in off)],
        [*rows, ["order", *(f"{pages.slope(counts, e):.1f}" for e in off.values())]],
    )


def text() -> str:
    left = {b: 100 * abs(light(b)["stick"][-1]) for b in OFFSETS}
    first = [[f"{1e3 * start:g}", *(f"{long_contact()[d][i]:.0e}" for d in DRIVES)] for i, start in enumerate(STARTS)]
    columns = [f"b/R {b:g}, {name}" for b in OFFSETS for name in ("stick", "stick at the offset")]
    second = [
        [f"{factor:g}", *(f"{light(b)[d][i]:+.3f}" for b in OFFSETS for d in ("stick", "offset"))]
        for i, factor in enumerate(FACTORS)
    ]
    return pages.page(
        "Convergence of the finite-element cue to the lumped one",
        "Is the lumped cue of the papers a limit of the finite-element cue, and what is the order of convergence?",
        "Yes. In a long contact the end masses by force and velocity and the squirt converge to those of the rigid cue "
        f"like T^{rates()['force']:.1f}, T^{rates()['velocity']:.1f} and T^{rates()['squirt']:.1f}; the stick end mass "
        "does not, because the vibration after its initial step of velocity does not decay. For a light cue Kim's "
        "first order is exact with the end mass at the offset; with that of small offsets the error remains "
        f"{left[0.1]:.0f}, {left[0.3]:.0f} and {left[0.5]:.0f} % at b/R 0.1, 0.3 and 0.5.",
        "## (a) Kim's shaft in a long contact, b/R 0.3",
        "Largest relative error in contact times from T to 2T. Friction bounds the oscillating force by mu F_n, which "
        "vanishes at separation: therefore squirt has a limit and stick has none.",
        table(["T, ms", *DRIVES], [*first, ["order", *(f"{rates()[d]:.1f}" for d in DRIVES)]]),
        "## (b) A light cue of fixed shape: squirt over Kim's first order, less 1",
        table(["rho, E and G, times", *columns], second),
        "## (c) Squirt with 22 modes against the mesh: order of convergence 2p",
        element_table(),
    )


def draw(panels: Any) -> None:
    """(a) and (b)."""
    left, right = panels
    for drive in DRIVES:
        left.loglog(1e3 * STARTS, long_contact()[drive], "o-", ms=3, label=drive)
    for i, b in enumerate(OFFSETS):
        for drive, style in (("stick", "--"), ("offset", "-")):
            right.loglog(FACTORS, np.abs(light(b)[drive]), style, color=f"C{i}", label=f"b/R {b:g}, {drive}")
    left.set(xlabel="contact time T, ms", ylabel="largest relative error from T to 2T", title="(a) long contact")
    right.set(xlabel="rho, E and G, times", ylabel="|squirt over first order - 1|", title="(b) light shaft")
    for axis in panels:
        axis.legend(fontsize=8)


EXAMPLE = """\
from dataclasses import replace
import cuefem as cf

scene = cf.load_scene("studies/scenes/kim.toml")
for time in (8e-3, 32e-3, 128e-3):
    slow = replace(scene, tip=replace(scene.tip, contact_time=time))
    print(f"T {1e3 * time:.0f} ms: squirt {cf.strike(slow).squirt:.5f} rad")
"""
STUDY = pages.Study(__file__, text, {"convergence.svg": pages.Figure(draw, (1, 2), (10, 4.2))}, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
