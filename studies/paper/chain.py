"""How far off is [Kim]'s guess of a 12 g cue end, and why?

(a) the chain of the paper on the paper's own cone: drawing, modes, end mass in a 2 ms impact, two-part impulse solver,
squirt (cf.reduction). (b) supports of the joint, and the whole cue in two hands: a butt as in studies/paper/tone, a
grip of 0.3 kg 1.1 m from the tip that does not move axially, a bridge of 5e3 N/m 0.2 m from the tip. (c) contact time.
(d) law of loss and restitution of the tip. (e) towards nature: a maple shaft at b/R 0.375 and 2 m/s, each row from the
one before. Equations: handbook: Effective end mass, The impulse solver, The strike.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

from scipy.optimize import brentq

import cuefem as cf
from cuefem.analysis.reduction import FILMED_CONTACT_TIME, SMALL_OFFSETS, VIBRATING, Reduction
from studies import pages, strokes
from studies.pages import table
from studies.paper import tone

KIM = cf.load(pages.STUDIES / "scenes" / "kim.toml")
assert isinstance(KIM, cf.Scene)
AT_OFFSET = "this shaft, b/R 0.3"
GUESS = 0.012  # kg
TIMES = (0.5e-3, 1e-3, FILMED_CONTACT_TIME, 2e-3, 3e-3)  # s
GRIP, BRIDGE = cf.PointMass(position=1.1, mass=0.3, axial_share=0.0), cf.Support(0.2, 5e3)
ROBOT = "2.30 and 2.43"  # degrees; studies/measured/squirt


@cache
def chain() -> Reduction:
    """The reduction of the scene of [Kim]."""
    return cf.reduction(KIM)


def degrees(angle: float | None) -> str:
    """An angle with two decimals."""
    return pages.NONE if angle is None else f"{math.degrees(angle):.2f}°"


def grams(mass: float | None, decimals: int = 2) -> str:
    """A mass."""
    return pages.NONE if mass is None else f"{1e3 * mass:.{decimals}f} g"


def chain_rows(own: Reduction) -> Iterator[list[str]]:
    """A row for each model, as README shows it."""
    for name, model in own.models.items():
        length = model["rigid_length"]
        yield [
            name,
            grams(model["end_mass"]),
            grams(model["cue_end_mass"], 1),
            pages.NONE if model["eps"] is None else f"{model['eps']:.3f}",
            pages.NONE if length is None else f"{100 * length:.0f} cm",
            *map(degrees, model["squirt"]),
        ]


def chain_table() -> str:
    """The first table of the page, and that of README."""
    squirts = [f"b/R {offset:g}" for offset in chain().offsets]
    return table(["cue", "m_e", "m_c = 4 m_e", "ε = m_c/M", "rigid end", *squirts], chain_rows(chain()))


def ratio(row: str, quantity: str) -> float:
    """A model's end mass or squirt at b/R 0.3 over that of the guess."""
    own, guess = (chain().models[name] for name in (row, "Kim's guess"))
    if quantity == "squirt":
        return float(own["squirt"][1] / guess["squirt"][1])
    return float(own[quantity] / guess[quantity])


def time_of_guess() -> float:
    """The contact time in which the shaft has the end mass of 12 g, s."""

    def excess(time: float) -> float:
        return cf.end_mass(replace(KIM, tip=replace(KIM.tip, contact_time=time))) - GUESS / 4

    return float(brentq(excess, 2e-4, 1e-3, xtol=1e-7))


def held() -> Mapping[str, tuple[cf.Cue, Sequence[cf.Effect]]]:
    """The shaft and the whole cue by their supports."""
    shaft, E = KIM.shaft, tone.MAPLE[1]
    joint, cue = shaft.length, tone.whole(E)
    return {
        "shaft, joint free": (shaft, ()),
        "shaft, joint pinned": (shaft, (cf.Support(joint, math.inf),)),
        "shaft, joint clamped": (shaft, (cf.Support(joint, math.inf, math.inf),)),
        "whole cue, free": (cue, ()),
        "whole cue, grip of 0.3 kg": (cue, (GRIP,)),
        "whole cue, grip and bridge": (cue, (GRIP, BRIDGE)),
    }


def contact(offset: float, time: float) -> cf.Outcome:
    """The vibrating shaft at an offset b/R, struck with a tip whose contact with a rigid cue lasts ``time`` head on."""
    return cf.strike(replace(KIM, tip=replace(KIM.tip, contact_time=time), stroke=replace(KIM.stroke, offset=offset)))


def duration_note() -> str:
    """How long the contacts of the table last, and the squirt of contacts that last as long as the paper's."""
    paper = KIM.tip.contact_time
    own = [f"{1e3 * contact(offset, paper).duration:.2f}" for offset in chain().offsets]

    def lasting(offset: float) -> float:
        time = brentq(lambda time: contact(offset, time).duration - paper, paper, 2 * paper, xtol=1e-6)
        return contact(offset, time).squirt

    kept = [degrees(lasting(offset)) for offset in chain().offsets]
    return (
        f"2 ms is the contact with a rigid cue head on. That of the vibrating shaft lasts {', '.join(own[:-1])} and "
        f"{own[-1]} ms at these offsets; with softer tips, whose contacts last 2 ms there, it has "
        f"{', '.join(kept[:-1])} and {kept[-1]}."
    )


def definition_note() -> str:
    """Which end mass the table has, and what others would be."""
    losses = [cf.end_mass(replace(KIM, tip=replace(KIM.tip, restitution=e)), "stick") for e in (0.5, 1.0)]
    return (
        f'm_e is the end mass "stick": a tip that sticks to the ball. By the tip\'s restitution, 0.5 to 1, it is '
        f'{1e3 * losses[0]:.1f} to {grams(losses[1], 1)}; of a half-sine force ("force") it would be '
        f"{grams(cf.end_mass(KIM, 'force'), 1)} ([definitions](../end_mass/definitions.md))."
    )


def supports_table() -> str:
    """The mode nearest to 250 Hz, end mass and squirt for each support."""
    rows = []
    for name, (cue, effects) in held().items():
        own = cf.reduction(replace(KIM, cue=cue, effects=tuple(effects)))
        mode, models = own.nearest["free"], own.models
        E = mode["stiffness_ratio"] * tone.MAPLE[1]
        rows.append(
            [
                *(name, f"{mode['mode']}", f"{mode['frequency']:.0f} Hz", f"{E / 1e9:.1f} GPa"),
                *(grams(models[row]["end_mass"]) for row in (SMALL_OFFSETS, AT_OFFSET)),
                degrees(models[VIBRATING]["squirt"][1]),
            ]
        )
    head = ["cue", "mode nearest 250 Hz", "frequency", "E for 250 Hz", "m_e", "m_e, b/R 0.3", "squirt, b/R 0.3"]
    return table(head, rows)


def times_table() -> str:
    """End mass and squirt against the contact time."""
    rows = []
    for time in TIMES:
        models = cf.reduction(replace(KIM, tip=replace(KIM.tip, contact_time=time))).models
        small, reduced, struck = (models[name] for name in (SMALL_OFFSETS, AT_OFFSET, VIBRATING))
        masses = [grams(small["end_mass"]), grams(small["cue_end_mass"], 1), grams(reduced["end_mass"])]
        rows.append([f"{1e3 * time:g} ms", *masses, degrees(reduced["squirt"][1]), degrees(struck["squirt"][1])])
    return table(["contact time", "m_e", "m_c", "m_e, b/R 0.3", "impulse solver, b/R 0.3", "vibrating, b/R 0.3"], rows)


def losses() -> Iterator[list[str]]:
    """Squirt at b/R 0.3 by restitution and force law of the tip."""
    for restitution in (0.5, 0.75, 1.0):
        scene = replace(KIM, tip=replace(KIM.tip, restitution=restitution))
        mass = cf.end_mass(scene, "offset")
        yield [
            f"spring, e = {restitution:g}",
            grams(mass),
            degrees(cf.impulse(scene).squirt),
            degrees(cf.strike(scene).squirt),
        ]
    for exponent in (1.5, 2.5):
        scene = replace(KIM, effects=(cf.PowerLawTip(exponent),))
        yield [f"force ~ indentation^{exponent:g}, e = 0.75", pages.NONE, pages.NONE, degrees(cf.strike(scene).squirt)]


def towards_nature() -> Iterator[tuple[str, str, str, str]]:
    """Rows on the maple shaft, each from the one before: end mass at the offset, squirt reduced and coupled."""
    full = strokes.full_model(strokes.cue("pool_maple"))
    leather = [effect for effect in full.effects if isinstance(effect, cf.LeatherTip)]
    waves = [effect for effect in full.effects if isinstance(effect, cf.AxialWaves)]
    spring = strokes.pool_scene(full.shaft, 2e-3, 0.375)
    filmed = replace(spring, tip=replace(spring.tip, contact_time=FILMED_CONTACT_TIME))
    guess = cf.LumpedCue.two_part(spring.axial_mass, GUESS)
    yield (
        "two-part cue, 12 g",
        grams(guess.end_mass),
        degrees(cf.impulse(replace(spring, cue=guess)).squirt),
        pages.NONE,
    )
    for name, scene in (
        ("finite-element shaft, contact of 2 ms", spring),
        ("contact of 1.135 ms, as filmed", filmed),
        ("dome of 9.5 mm", replace(filmed, effects=(strokes.DOME,))),
        ("leather instead of spring and dome, e = 0.73", replace(full, tip=cf.Tip(0.73, 0.7), effects=tuple(leather))),
        ("axial waves, the leather's own e", replace(full, effects=(*leather, *waves))),
        ("axial force on the bent shaft", full),
    ):
        reduced = [pages.NONE] * 2
        if not scene.effects:
            reduced = [grams(cf.end_mass(scene, "offset")), degrees(cf.impulse(scene).squirt)]
        yield name, *reduced, degrees(cf.strike(scene).squirt)


def text() -> str:
    models = chain().models
    masses = [1e3 * models[name]["cue_end_mass"] for name in (AT_OFFSET, SMALL_OFFSETS)]
    ratios = [ratio(name, "cue_end_mass") for name in (AT_OFFSET, SMALL_OFFSETS)]
    lengths = [100 * models[name]["rigid_length"] for name in (AT_OFFSET, SMALL_OFFSETS)]
    filmed = cf.reduction(replace(KIM, tip=replace(KIM.tip, contact_time=FILMED_CONTACT_TIME))).models
    short = [1e3 * filmed[name]["cue_end_mass"] for name in (AT_OFFSET, SMALL_OFFSETS)]
    nature = [*towards_nature()]
    return pages.page(
        "From the drawing to squirt: the chain of [Kim]",
        "How far off is the paper's guess of a 12 g cue end (ε = 0.057), and why?",
        f"From the paper's own cone the two-part end mass is {masses[0]:.0f} to {masses[1]:.0f} g, "
        f"{ratios[0]:.1f} to {ratios[1]:.1f} times the guess, and squirt is {ratio(VIBRATING, 'squirt'):.1f} times as "
        "large. The guess is the mass of the first 12 cm; in a 2 ms impact the shaft responds like a rigid end of "
        f"{lengths[0]:.0f} to {lengths[1]:.0f} cm, and 12 g belong to a contact of {1e3 * time_of_guess():.2f} ms. The "
        "guesses of 12 g and of 2 ms err in opposite directions: in the filmed 1.135 ms the cone has "
        f"{short[0]:.0f} to {short[1]:.0f} g, and on a maple shaft the whole chain ends at {nature[-1][3]}, where a "
        f"robot measured {ROBOT}°.",
        "## (a) Kim's cone: radius 6 to 10.5 mm, 700 mm, 120 g; cue 540 g, ball 210 g; effective end mass for a 2 ms "
        "impact",
        f"Modes: {', '.join(f'{f:.0f}' for f in chain().frequencies)} Hz (free). m_c = 4 m_e is the paper's ν_c = 1/3, "
        f"a uniform rod; the first 12 cm of this cone have {chain().front_ratio:.2f}. Rigid end: the length of the "
        "cone that has this m_e as a rigid body. The impulse solver computes the squirt of the two-part cues.",
        chain_table(),
        definition_note(),
        duration_note(),
        "![squirt against the offset, end mass against the contact time](chain.svg)",
        "## (b) Modes near 250 Hz: which support?",
        "E of the table is 12.6 GPa; maple has 10 to 16. Two candidates: the second mode pinned at the joint, and the "
        "fourth of the whole cue held by the grip. The end mass hardly depends on it: by 6 % at 2 ms, not at 1.135 ms.",
        supports_table(),
        "## (c) Contact time",
        times_table(),
        "## (d) Law of loss",
        "Viscoelastic leather instead of the unloading law adds 4 to 10 % ([left_out](../contact/left_out.md)).",
        table(["tip", "m_e, b/R 0.3", "impulse solver, b/R 0.3", "vibrating, b/R 0.3"], losses()),
        "## (e) Towards nature: maple shaft, pool ball, b/R 0.375, 2 m/s; each row from the one before",
        table(["model", "m_e, b/R 0.375", "impulse solver", "vibrating"], nature),
        "## Limits",
        "For a light cue the squirt of the reduced shaft converges to the paper's first order in ε, of order 1; for a "
        "stiff shaft, or a long contact, that of the vibrating shaft to the rigid cue's like 1/T²; the stick end mass "
        "has no such limit ([convergence](convergence.md)).",
    )


def draw(panels: Any) -> None:
    """Squirt against the offset, and end mass against the contact time."""
    cf.plot.reduction(chain(), panels)


EXAMPLE = """\
from math import degrees
import cuefem as cf

chain = cf.reduction(cf.load_scene("studies/scenes/kim.toml"))
for name, model in chain.models.items():
    print(f"{name:26}", *(f"{degrees(squirt):.2f}" for squirt in model["squirt"]), "degrees")
axes = cf.plot.reduction(chain)
"""
STUDY = pages.Study(__file__, text, {"chain.svg": pages.Figure(draw, (1, 2), (10, 4))}, example=EXAMPLE)


if __name__ == "__main__":
    STUDY.write()
