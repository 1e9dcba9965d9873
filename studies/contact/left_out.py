"""Which effects does the default stroke neglect or assume, with what sign and size in squirt?

Every row is the maple shaft's default stroke at 2 m/s with one change. Most are scenes; three are not in the package
and come from annuli in small steps (`studies.contact.annuli`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache, partial
from typing import Any
from unittest.mock import patch

import numpy as np
from scipy.optimize import fsolve

import cuefem as cf
from cuefem.results.closed_forms import pivot_length
from studies import pages, strokes
from studies.contact.annuli import Leather, plain, stepped
from studies.pages import table
from studies.strokes import INCH, at_offset, cue, full_model, pool_scene, squirt

OFFSETS = (0.187, 0.375, 0.453)  # b/R
TIMES = (1e-4, 4e-4)  # s, of relaxation
NORMAL = "normal loss: viscoelastic annuli, relaxation time 0.1, 0.4 ms (Ting 1966)"
Change = Callable[[float], float]
HEAD_ON = cf.LeatherTip.head_on
UNLIKE = 1 + 1e-9  # no tip that is remembered has this modulus


@cache
def relaxing(time: float) -> Leather:
    """Viscoelastic leather with the restitution and the contact time of the package's in a central impact."""
    _, lasts, ratio = stepped(plain(0.0), Leather())

    def miss(x: Any) -> list[float]:
        _, T, rebound = stepped(plain(0.0), Leather(float(x[0]), time, float(x[1])))
        return [T / lasts - 1, rebound / ratio - 1]

    share, stiffer = fsolve(miss, [0.6, 1.5], xtol=1e-4)
    assert 0 < share < 1, share
    return Leather(float(share), time, float(stiffer))


@cache
def alone(leather: Leather, offset: float) -> float:
    """Squirt of `stepped` over that of its own base, less 1."""
    return stepped(plain(offset), leather)[0] / stepped(plain(offset), Leather())[0] - 1


def change(scene: cf.Scene, base: cf.Scene, offset: float) -> float:
    """Squirt of a scene over that of another at an offset, less 1."""
    return squirt(at_offset(scene, offset)) / squirt(at_offset(base, offset)) - 1


def stiffening(tip: cf.LeatherTip, diameter: float, ball_radius: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Contact radius, m, indentation, m, and force, N, of a central impact on a neo-Hookean tip."""
    patched, depth, force = HEAD_ON(tip, diameter, ball_radius)
    strain = depth / tip.height
    return patched, depth, force * (1 + strain + 4 / 3 * strain**2)


def stiffened(offset: float) -> float:
    """Change of squirt by large strain."""
    default = full_model(cue("pool_maple"), offset)
    unlike = full_model(cue("pool_maple"), offset, E=UNLIKE * default.leather_tip.E)
    squirt(default)
    with patch.object(cf.LeatherTip, "head_on", stiffening):
        return change(unlike, default, offset)


@cache
def rows() -> dict[str, tuple[str, ...]]:
    """Changes of squirt at `OFFSETS`, %, by what is changed."""
    default, drawn = full_model(cue("pool_maple")), full_model(cue("whole_cue"))
    domed = pool_scene(cue("pool_maple"), float(default.contact_time), 0.375, (strokes.DOME,))
    grip = drawn.shaft.length - 10 * INCH

    def added(scene: cf.Scene, *effects: cf.Effect) -> cf.Scene:
        return replace(scene, effects=(*scene.effects, *effects))

    def scenes(variants: Iterable[cf.Scene], base: cf.Scene = default) -> list[Change]:
        return [partial(change, scene, base) for scene in variants]

    hands = (added(drawn, cf.PointMass(position=grip, mass=mass)) for mass in (0.05, 0.3, 1.0))
    bridges = (added(default, cf.Support(x * INCH, k)) for x in (6, 8, 10, 12) for k in (1e3, 1e4))
    raised = (added(domed, cf.Elevation(math.radians(angle))) for angle in (2, 4, 6))
    slippery = (replace(default, tip=replace(default.tip, friction=mu)) for mu in (0.6, 0.55))
    lossy = (full_model(cue("pool_maple"), surface_restitution=e) for e in (0.95, 0.9))
    relaxed = [relaxing(time) for time in TIMES]
    tangential = [replace(leather, surface=True) for leather in relaxed]
    changes: dict[str, list[Change]] = {
        NORMAL: [partial(alone, leather) for leather in relaxed],
        "the same, with tangential loss too (isotropic)": [partial(alone, leather) for leather in tangential],
        "tangential loss: tangential restitution 0.95, 0.9": scenes(lossy),
        "normal-tangential coupling compliance (C_nt)": [partial(alone, Leather(coupled=True))],
        "large strain: a neo-Hookean tip": [stiffened],
        "a hand of 0.05, 0.3, 1 kg that moves with the grip": scenes(hands, drawn),
        "a bridge hand, 1e3 to 1e4 N/m, 6 to 12 in from the tip": scenes(bridges),
        "a ball of 156 g": scenes([replace(default, ball=replace(default.ball, mass=0.156))]),
        "friction 0.6, 0.55": scenes(slippery),
        "a cue raised by 2, 4, 6° (spring tip with a dome)": scenes(raised, domed),
    }
    return {name: tuple(text_of([100 * one(b) for one in each]) for b in OFFSETS) for name, each in changes.items()}


def text_of(values: list[float]) -> str:
    """Some changes, or the least and the most of many."""
    many = len(values) > 3
    return (" to " if many else ", ").join(f"{v:+.1f}" for v in ((min(values), max(values)) if many else values))


def left_out_table(offsets: tuple[float, ...] = OFFSETS) -> str:
    """The table, at some of the offsets."""
    columns = [OFFSETS.index(b) for b in offsets]
    lines = [[name, *(values[i] for i in columns)] for name, values in rows().items()]
    return table(["neglected or assumed", *(f"b/R {b:g}" for b in offsets)], lines)


def ball_text() -> str:
    """Change of squirt by a lighter ball at several speeds, and of pivot lengths by a heavier one."""
    speeds, light, pivots = (1.0, 2.0, 3.5, 5.0, 7.0), [], []
    for speed in speeds:
        base = full_model(cue("pool_maple"), 0.375, speed)
        light.append(100 * change(replace(base, ball=replace(base.ball, mass=0.156)), base, 0.375))
    for name in ("pool_maple", "pool_hollow", "carbon"):
        base = full_model(cue(name), 0.3)
        heavy = replace(base, ball=replace(base.ball, mass=1.1 * base.ball.mass))
        usual, longer = (float(pivot_length(scene, cf.strike(scene).squirt)) for scene in (base, heavy))
        pivots.append(100 * (longer / usual - 1))
    ratio = base.ball.mass / 0.007
    rule = 10 * ratio / (1 + 1 / base.ball.inertia + ratio)
    changes, lengths = (", ".join(f"{x:+.1f}" for x in values) for values in (light, pivots))
    return (
        f"The row of a ball of 156 g holds at 2 m/s: at {', '.join(f'{v:g}' for v in speeds)} m/s it is {changes} "
        f"% at b/R 0.375, by "
        f"the echo of the butt. A ball 10 % heavier changes the natural pivot length at b/R 0.3 by {lengths} % "
        f"(maple, bored, carbon); a "
        f"fixed end mass of 7 g would change it by {rule:+.0f} % ([A.31]). [two_balls](../measured/two_balls.md) "
        f"tests this."
    )


def text() -> str:
    normal, both = ([float(v) for v in values[1].split(", ")] for values in list(rows().values())[:2])
    base = max(abs(stepped(plain(b), Leather())[0] / squirt(plain(b)) - 1) for b in OFFSETS)
    return pages.page(
        "Neglected effects",
        "Which effects does the default stroke neglect or assume, with what sign and size in squirt?",
        f"The dissipation law is the largest uncertainty: viscoelastic leather gives {pages.span(normal, 0)} % more "
        "squirt at b/R 0.375 than the unloading law of the package (scaled indentation), at the same restitution and "
        f"contact time of a central impact; with tangential loss too, about {np.mean(both):.0f} % more. All other "
        "effects are a few per cent. The numbers indicate the size of the model error; they are not corrections.",
        "## Change of squirt, %, on the maple shaft at 2 m/s",
        left_out_table(),
        "The rows of viscoelastic leather and of C_nt are computed by annuli in small steps, without axial waves, "
        "axial force and rolling; with the package's own law these give the squirt of `cf.strike` within "
        f"{100 * base:.2f} %. The relaxing share and the leather's stiffness follow from the restitution and the "
        "contact time of a central impact. The unloading law of the package has no published source. The hand grips "
        "the whole cue of meshes/ 10 in before its end. From 4 m/s on the indentation of a 6 mm tip is 25 % of its "
        "height, beyond small strains.",
        ball_text(),
        "In the whole stroke, with axial waves, axial force and rolling, viscoelastic loss is not computed: the "
        "annuli have none of these. The law of loss of the package stays as it is, on purpose: contact time and "
        "rebound of a central impact fix one stiffness and one loss, and do not distinguish two laws. Three "
        "measurements would: the force of a central impact over time; the dent of the tip at separation, 1 - e² of "
        "the maximum indentation in the law of the package; and a ball dropped at 30° on a clamped tip, whose "
        "rebound along the surface has the tangential loss without a cue.",
    )


EXAMPLE = """\
from dataclasses import replace
import cuefem as cf

scene = cf.load_scene("meshes/pool_maple.toml")
lossy = tuple(replace(e, surface_restitution=0.8) if isinstance(e, cf.LeatherTip) else e for e in scene.effects)
ratio = cf.strike(replace(scene, effects=lossy)).squirt / cf.strike(scene).squirt
print(f"a tangential loss of the leather: {100 * (ratio - 1):+.1f} % squirt")
"""
STUDY = pages.Study(__file__, text, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
