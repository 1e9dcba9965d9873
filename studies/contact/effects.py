"""How much does each effect change in the ready scenes?

What: every scene of scenes/ as it stands, then without each effect that it lists, and with each that it does not list
(at the effect's textbook value, `usual`). The change is squirt (ball speed, spin) with the effect over that without
it, minus 1. Default resolution. Effects without a usual value (a joint, a mass that is not listed) and Elevation,
which is the player's choice, are left out. Last the scenes in the whole
stroke: LeatherTip, waves along the cue, thrust on the bent shaft. bridge.py covers a bridge hand in general,
dome.py the dome. Equations: handbook: Effects.
Takes about 40 s.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from cuefem import LeatherTip, Scene, TipDome, leather_modulus, load, strike, tip_restitution
from cuefem.design.worth import variants
from studies import pages
from studies.measured import pool

SCENES = ("kim", "pool_low_deflection", "carom", "snooker", "clay_on_shaft", "break_cue")
SLOW = SCENES[:-1]  # all but the break
EFFECTS = (
    "TipDome",
    "TipShear",
    "RollingContact",
    "AxialWaves",
    "GeometricStiffness",
    "PowerLawTip",
    "PointMass",
    "Support",
    "StructuralDamping",
    "SecondHit",
)
SMALL = EFFECTS[-3:]
BESIDE = (*EFFECTS[3:5], *EFFECTS[6:])  # what goes with LeatherTip
HEIGHT, DOME = 6e-3, 9.5e-3  # m, of LeatherTip where the scene has none
QUANTITIES = ("squirt", "ball speed", "spin")
# What LeatherTip alone should say, from leather_tip.md, and the whole stroke, from dome.md and leather_tip.md, each
# written down before it was run here. Not to be changed.
PREDICTED = {
    "squirt of pool_low_deflection, deg": "1.8; whole stroke: 1.75",
    "squirt of carom, deg": "2.3; whole stroke: 2.1",
    "squirt of snooker, deg": "1.7; whole stroke: 1.4",
    "squirt of clay_on_shaft, deg": "3.7; whole stroke: 3.4",
    "AxialWaves, per cent": "+3 to +10; whole stroke: +2 to +12",
    "GeometricStiffness, per cent": "whole stroke: -2 at 1 m/s to -12 at 4 m/s",
    "Support, StructuralDamping, SecondHit, per cent": "below 0.5; whole stroke: below 0.6",
}


class Worth(NamedTuple):
    """What an effect is worth, relative: squirt, ball speed, spin; whether the scene lists it."""

    squirt: float
    ball_speed: float
    spin: float
    listed: bool


@cache
def scene(name: str) -> Scene:
    """A ready scene."""
    found = load(pages.STUDIES / "scenes" / f"{name}.toml")
    assert isinstance(found, Scene)
    return found


@cache
def base(name: str) -> Any:
    """The scene's outcome as it stands."""
    return strike(scene(name))


@cache
def worth(name: str) -> dict[str, Worth]:
    """What the effects are worth in a scene."""
    found = {}
    for variant in variants(scene(name)):
        if variant.scene is None or variant.name not in EFFECTS:
            continue
        pair = (strike(variant.scene), base(name))
        without, with_it = pair if variant.listed else pair[::-1]
        gains = [getattr(with_it, q) / getattr(without, q) - 1 for q in ("squirt", "ball_speed", "spin")]
        found[variant.name] = Worth(*map(float, gains), variant.listed)
    return found


def span(effect: str, names: tuple[str, ...]) -> tuple[float, float]:
    """Smallest and largest worth of an effect in squirt, per cent."""
    found = [100 * worth(name)[effect].squirt for name in names if effect in worth(name)]
    return min(found), max(found)


def cell(name: str, effect: str, quantity: int) -> str:
    """A worth in per cent, in bold where the scene lists the effect."""
    if effect not in worth(name):
        return "–"
    found = worth(name)[effect]
    text = f"{100 * found[quantity]:+.1f}".replace("-0.0", "+0.0")
    return f"**{text}**" if found.listed else text


def worth_table(quantity: int) -> str:
    """Worths of all effects in all scenes, per cent."""
    rows = [[effect, *(cell(name, effect, quantity) for name in SCENES)] for effect in EFFECTS]
    return pages.table(["effect", *SCENES], rows)


def scene_table() -> str:
    """The scenes."""
    rows = []
    for name in SCENES:
        struck, outcome = scene(name), base(name)
        stroke = [f"{1e3 * struck.contact_time:.1f}", f"{struck.stroke.offset:g}", f"{struck.stroke.speed:g}"]
        listed = ", ".join(type(effect).__name__ for effect in struck.effects) or "none"
        rows.append([name, *stroke, f"{np.degrees(outcome.squirt):.2f}", listed])
    return pages.table(["scene", "T, ms", "b/R", "speed, m/s", "squirt, deg", "effects listed"], rows)


def conclusions() -> list[str]:
    """What the numbers say, in two sentences."""
    dome, shear, turning, axial, thrust, power = (span(effect, SLOW) for effect in EFFECTS[:6])
    hard = {effect: 100 * worth("break_cue")[effect].squirt for effect in EFFECTS if effect in worth("break_cue")}
    least = max(abs(x) for effect in SMALL for x in span(effect, SCENES))
    return [
        f"The dome of the tip changes squirt the most in every scene but the break, by {dome[0]:+.0f} to "
        f"{dome[1]:+.0f} %. The shear of the tip follows with {shear[0]:+.0f} to {shear[1]:+.0f} %, the turning "
        f"contact with {turning[0]:+.0f} to {turning[1]:+.0f} %, waves along the cue with {axial[0]:+.0f} to "
        f"{axial[1]:+.0f} %, the thrust on the bent shaft with {thrust[0]:+.0f} to {thrust[1]:+.0f} %, and the power "
        f"law with {power[0]:+.0f} to {power[1]:+.0f} %. In the break, at 11 m/s, the "
        f"thrust changes the most ({hard['GeometricStiffness']:+.0f} %: the ball leaves to the other side), and then "
        f"the turning contact ({hard['RollingContact']:+.0f} %, more than its assumptions allow).",
        "A bridge hand of 5000 N/m, the damping of the wood and a second hit change squirt by less than "
        f"{np.ceil(10 * least) / 10:.1f} % in all scenes: no scene needs them for its squirt.",
    ]


def report() -> str:
    """The committed table."""
    parts = ["# What each effect is worth", *conclusions(), "## The scenes", scene_table()]
    for i, quantity in enumerate(QUANTITIES):
        title = f"## Change of {quantity} by the effect, per cent"
        parts += [title, "Bold: the scene lists this effect.", worth_table(i)]
    return pages.paragraphs(*parts)


def whole_stroke(found: Scene) -> Scene:
    """A scene with LeatherTip in the place of its leather and of the effects of its tip, with waves and the thrust.

    Head on its contact is as long, and the whole cue rebounds, as the scene says.
    """
    domes = [effect.radius for effect in found.effects if isinstance(effect, TipDome)]
    height = found.cue.leather
    tip = LeatherTip(height or HEIGHT, *(domes or [DOME]), 140e6)
    cue = replace(found.cue, segments=found.cue.segments[1:]) if height else found.cue
    replaced = (*LeatherTip.excludes, *(type(effect).__name__ for effect in pool.WHOLE))
    rest = [effect for effect in found.effects if type(effect).__name__ not in replaced]
    moved = [replace(e, position=e.position - height) if hasattr(e, "position") else e for e in rest]
    plain = replace(found.tip, contact_time=None, stiffness=None)
    struck = replace(found, cue=cue, tip=plain, effects=(tip, *pool.WHOLE, *moved))
    for _ in range(3):  # the modulus and the restitution hardly depend on each other
        tip = replace(tip, E=leather_modulus(struck, float(found.contact_time)))
        struck = replace(struck, effects=(tip, *struck.effects[1:]))
        struck = replace(struck, tip=replace(plain, restitution=tip_restitution(struck, found.tip.restitution)))
    return struck


@cache
def leather_scene(name: str) -> Scene:
    """A ready scene as a whole stroke."""
    return whole_stroke(scene(name))


@cache
def leather_worth(name: str) -> dict[str, float]:
    """What the effects that go with LeatherTip are worth in squirt in the whole stroke, relative."""
    struck = leather_scene(name)
    base, found = strike(struck).squirt, {}
    for variant in variants(struck):
        if variant.scene is not None and variant.name in BESIDE:
            other = strike(variant.scene).squirt
            found[variant.name] = float(base / other - 1 if variant.listed else other / base - 1)
    return found


def leather_table() -> str:
    """The whole strokes: their tips, squirt, and what the effects beside the tip are worth."""
    rows = []
    for name in SLOW:
        struck, worths = leather_scene(name), leather_worth(name)
        squirts = [f"{np.degrees(outcome.squirt):.2f}" for outcome in (base(name), strike(struck))]
        cells = [f"{100 * worths[e]:+.1f}".replace("-0.0", "+0.0") if e in worths else "–" for e in BESIDE]
        tip = [f"{struck.leather.E / 1e6:.0f}", f"{struck.tip.restitution:.3f}"]
        rows.append([name, *tip, *squirts, *cells])
    columns = ["scene", "E, MPa", "e of the tip", "squirt as listed, deg", f"{pool.MODERN}, deg", *BESIDE]
    return pages.table(columns, rows)


def leather_found() -> dict[str, str]:
    """What was found, by the names of PREDICTED."""
    squirts = (f"{np.degrees(strike(leather_scene(name)).squirt):.2f}" for name in SLOW[1:])
    axial, thrust = ([100 * leather_worth(name)[effect] for name in SLOW] for effect in EFFECTS[3:5])
    small = max(abs(leather_worth(name).get(effect, 0.0)) for name in SLOW for effect in SMALL)
    both = (f"{min(each):+.0f} to {max(each):+.0f}" for each in (axial, thrust))
    numbers = (*squirts, *both, f"{100 * small:.1f} at most")
    return dict(zip(PREDICTED, numbers, strict=True))


def leather_report() -> str:
    """The end of the page: the whole stroke."""
    ratios = [float(strike(leather_scene(name)).squirt / base(name).squirt) for name in SLOW]
    axial, thrust = ([100 * leather_worth(name)[effect] for name in SLOW] for effect in EFFECTS[3:5])
    told = (
        "The whole stroke is LeatherTip with waves along the cue and thrust on the bent shaft. LeatherTip takes the "
        "place of dome, shear, power law and turning contact. Its modulus is the one that makes the scene's contact "
        "time, and its restitution the one with which the whole cue rebounds as the scene says; a scene without a dome "
        f"gets one of 9.5 mm. Squirt is then {min(ratios):.2f} to {max(ratios):.2f} of what the scene has as it is "
        f"listed. The waves are worth {min(axial):+.0f} to {max(axial):+.0f} %, the thrust {min(thrust):+.0f} to "
        f"{max(thrust):+.0f} %: what each column says is squirt with the effect over squirt without "
        "it. The break is left out: its tip is phenolic."
    )
    parts = [
        "## LeatherTip in the whole stroke: squirt, and what the effects beside the tip change of it, per cent",
        told,
    ]
    parts += [leather_table(), pages.predictions(PREDICTED, leather_found())]
    return pages.paragraphs(*parts)


def draw(axes: Any) -> None:
    """The worth of all effects in squirt."""
    for i, name in enumerate(SCENES):
        found = {effect: 100 * worth(name)[effect].squirt for effect in EFFECTS if effect in worth(name)}
        places = [EFFECTS.index(effect) + 0.13 * (i - 2.5) for effect in found]
        axes.barh(places, list(found.values()), height=0.12, color=f"C{i}", label=name)
    axes.set_yticks(range(len(EFFECTS)), EFFECTS)
    axes.invert_yaxis()
    axes.axvline(0, color="k", lw=0.8)
    axes.grid(visible=False, axis="y")
    axes.set(xlabel="change of squirt by the effect, per cent", title="What each effect is worth in the ready scenes")
    axes.legend(fontsize=8, loc="lower right")


STUDY = pages.Study(
    __file__,
    lambda: pages.paragraphs(report(), leather_report()),
    {"effects.svg": pages.Figure(draw, size=(8, 4.8))},
    drawn=True,
    predicted=PREDICTED,
)


if __name__ == "__main__":
    STUDY.write()
