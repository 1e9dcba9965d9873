"""What the leather tip leaves out, and what it is worth in squirt.

What: the usual stroke of the maple pool cue, with three things that cuefem's tip does not have.

- Coupling. A patch off the axis that is pressed moves along the surface too, by C_nt F_n (`LeatherTip.compliance`, the
  solid's). Where the patch grows by da, both parts of dx = C(a) dF are strained, so that the shift that counts along
  the surface is x_t - psi x_n, psi = C_nt/C_nn; by virtual work F_t then pushes back on x_n with -psi F_t. That is a
  tangent that leans by psi: one row of the contact's directions, with which the account of energies closes. psi is
  taken of one patch, the normal does not turn here, and F_n stiffens by C_nn alone (C_nt^2 is below 2 % of C_nn C_tt).
- Large strain. A neo-Hookean block that is pressed by the part s of its height has, on its first section,
  F/(G A) = (1 - s)^-2 - (1 - s) = 3 s (1 + s + 4 s^2/3 + ...): 19 % more than 3 s at s = 0.15. Sheared by d it has
  sigma = G (1 - s)^2 d/(h (1 - s)) on the area A/(1 - s): F = G A d/h, as without the pressing. So the law along the
  normal is stiffened by 1 + s + 4 s^2/3, s the depth over the height, and the one along the surface is left.
- The rim. Far out the patch reaches over the rim of the tip, and squirt has a step, which is sought by bisection.

A flat tip touches with its rim at any offset: its squirt does not go to zero with the offset, which no leather does.
Takes about 20 s.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from cuefem import LeatherTip, Scene, Stroke, usual_scene
from cuefem.beam.tip import TipModes
from cuefem.contact.laws import ContactModel, model_of
from cuefem.contact.solve import solve_contact
from cuefem.contact.strike import outcome_of
from cuefem.effects.leather_law import LeatherLaw
from cuefem.tip_modes import tip_modes_of
from studies import pages, strokes
from studies.strokes import strike_modes

OFFSETS = (0.187, 0.375, 0.453)
PATCHES = (2e-3, 3e-3, 4e-3)  # m; the usual stroke's is 3 to 4 mm at its widest
SPEEDS = (0.8, 2.0, 4.0, 7.0)
GRIPPY = 1.2  # friction: at the rim no tip holds with less
LOOKED_OVER = 0.50, 0.66, 41  # b/R; the first touch is on the rim from 0.671 on
ASIDE = 1e-4  # b/R over which a step is one


@cache
def struck(rolls: bool = True) -> tuple[Scene, TipModes]:
    """The usual stroke, whose ball rolls over the tip or does not, and its modes."""
    scene = usual_scene(strokes.cue("pool_maple"))
    usual = tip_of(scene)
    scene = replace(
        scene, effects=tuple(replace(usual, rolls=rolls) if effect is usual else effect for effect in scene.effects)
    )
    return scene, tip_modes_of(scene)


def stiffening(model: ContactModel, height: float) -> ContactModel:
    """The contact with the force along the normal times 1 + s + 4 s^2/3, s the depth over the height."""
    assert isinstance(model.law, LeatherLaw)
    force = np.array(model.law.force_terms)
    terms = np.zeros(len(force) + 4)
    for power, part in ((0, 1.0), (2, 1 / height), (4, 4 / 3 / height**2)):
        terms[power : power + len(force)] += part * force
    give = np.pad(model.law.give_terms, (0, len(terms) - len(force)))  # as many terms as of the force
    law = replace(model.law, force_terms=tuple(terms.tolist()), give_terms=tuple(give.tolist()))
    edges = model.arrays["ring_edges"]
    changed = {
        "force_terms": terms,
        "give_terms": give,
        "ring_forces": law.at(edges)[0],
        "ring_slopes": law.slope(edges),
    }
    return replace(model, law=law, arrays=model.arrays | changed, terms=model.terms | {"terms": len(terms)})


def tip_of(scene: Scene) -> LeatherTip:
    """The leather on a scene's cue."""
    return next(effect for effect in scene.effects if isinstance(effect, LeatherTip))


def coupled(offset: float, patch: float) -> tuple[float, float, float]:
    """psi, by how much squirt changes with it, and what is left of the account of energies, over the first."""
    scene, modes = struck(rolls=False)
    scene = strokes.at_offset(scene, offset)
    model, C = model_of(scene, modes), tip_of(scene).compliance(scene.shaft.segments[0].tip_diameter, offset, patch)
    psi, facing = float(C[0, 1] / C[0, 0]), model.facing.copy()
    facing[0] -= psi * facing[1]
    without, leaning = (outcome_of(solve_contact(each), scene) for each in (model, replace(model, facing=facing)))
    left = 2 * leaning.energy["initial"] - sum(leaning.energy.values())
    return psi, float(leaning.squirt / without.squirt - 1), abs(left / leaning.energy["initial"])


def stiffened(speed: float, offset: float) -> float:
    """By how much large strain changes squirt."""
    scene, modes = struck()
    scene = replace(scene, stroke=Stroke(speed, offset))
    own = model_of(scene, modes)
    large = stiffening(own, tip_of(scene).height)
    squirts = [float(outcome_of(solve_contact(each), scene).squirt) for each in (own, large)]
    return squirts[1] / squirts[0] - 1


def rim_step(speed: float) -> tuple[float, float]:
    """Where squirt has its greatest step far out, b/R, and the step over squirt."""
    scene, modes = struck()
    scene = replace(scene, tip=replace(scene.tip, friction=GRIPPY))

    def squirt(offset: float) -> float:
        return float(strike_modes(replace(scene, stroke=Stroke(speed, offset)), modes, recorded=False).squirt)

    offsets = np.linspace(*LOOKED_OVER)
    values = np.array([squirt(float(offset)) for offset in offsets])
    grows = np.diff(values)
    i = int(np.argmax(np.abs(grows - np.median(grows))))
    (low, below), (high, above) = ((float(offsets[k]), float(values[k])) for k in (i, i + 1))
    while high - low > ASIDE:
        middle = (low + high) / 2
        value = squirt(middle)
        if abs(value - below) > abs(above - value):
            high, above = middle, value
        else:
            low, below = middle, value
    return low, above / below - 1


def block(strain: float) -> float:
    """Force of a neo-Hookean block over that of Hooke's."""
    return ((1 - strain) ** -2 - (1 - strain)) / (3 * strain)


def coupling_table() -> str:
    """One row an offset."""
    rows = []
    for offset in OFFSETS:
        found = [coupled(offset, patch) for patch in PATCHES]
        rows.append([f"{offset}", *(f"{psi:.3f}: {100 * change:+.1f}" for psi, change, _ in found)])
    return pages.table(["b/R", *(f"patch of {1e3 * patch:g} mm" for patch in PATCHES)], rows)


def strain_table() -> str:
    """One row a speed."""
    scene, _ = struck()
    height = tip_of(scene).height
    rows = []
    for speed in SPEEDS:
        strain = replace(scene, stroke=Stroke(speed, 0.0)).deepest / height
        changes = [f"{100 * stiffened(speed, offset):+.1f}" for offset in OFFSETS]
        rows.append([f"{speed:g}", f"{100 * strain:.0f}", f"{100 * (block(strain) - 1):.0f}", *changes])
    return pages.table(["m/s", "strain, %", "stiffer, %", *(f"b/R {offset}" for offset in OFFSETS)], rows)


def rim_table() -> str:
    """One row a speed."""
    found = [(speed, *rim_step(speed)) for speed in SPEEDS[:3]]
    return pages.table(["m/s", "at b/R", "step, %"], [[f"{U:g}", f"{b:.3f}", f"{100 * s:+.1f}"] for U, b, s in found])


WORDS = """# What the leather tip leaves out

The usual stroke of the maple cue with three things that cuefem's tip does not have; how each is put in stands in
left_out.py. None is worth more than 3 % of squirt in a stroke of 2 m/s up to b/R 0.453. The numbers are estimates:
they say how far the model may be off, not by what to correct it. Hard strokes are outside: from 4 m/s on the tip is
pressed by a quarter of its height and more, and no law of small strains holds.
Far out, at b/R 0.609, squirt steps by a hundredth and a half where the tip holds at all; the stiffness of the patch
steps there by a thousandth, and the tip begins to slide earlier. A step of the model, then, and not of leather; what
makes it is not known.
"""
TABLES = {
    "Coupling of normal and sideways motion: psi, and the change of squirt, %, at 2 m/s": coupling_table,
    "Large strain: a neo-Hookean tip, change of squirt, %": strain_table,
    "The rim: the greatest step of squirt over b/R 0.50 to 0.66 (friction 1.2)": rim_table,
}


def text() -> str:
    """The page."""
    return WORDS + "".join(f"\n## {title}\n\n{made()}" for title, made in TABLES.items())


STUDY = pages.Study(__file__, text)


if __name__ == "__main__":
    STUDY.write()
