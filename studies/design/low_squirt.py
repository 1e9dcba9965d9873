"""What lowers the squirt of a shaft, and what does it cost in stiffness?

One change at a time on the hollow-front shaft of meshes/: the static tip stiffness with the joint clamped, and squirt
at b/R 0.3 with a spring tip (1 ms, a ball of 210 g) and in the default stroke of pool. Then the shafts of meshes/, and
the shaft of lowest squirt in the default stroke among those as stiff as the solid one, with walls of 2 mm (SLSQP).
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from scipy.optimize import minimize

import cuefem as cf
from cuefem.designs import evaluate
from studies import pages, strokes
from studies.pages import table
from studies.strokes import cue, hollow, squirt

START = (6e-3, 0.127, 0.013, 11.85e-3, 12.45e-3)  # m, of the hollow shaft of meshes/; 14.3 mm wide 100 mm further back
BOUNDS = ((1e-3, 9e-3), (0.03, 0.25), (5e-3, 0.03), (11e-3, 13.5e-3), (12.2e-3, 14.3e-3))
CHANGES = {  # by what each number of START grows
    "bore 1 mm wider": (1e-3, 0, 0, 0, 0),
    "bore 1 in deeper": (0, 0.0254, 0, 0, 0),
    "ferrule 5 mm longer": (0, 0, 5e-3, 0, 0),
    "tip 0.5 mm wider": (0, 0, 0, 5e-4, 0),
    "end of the taper (13 in) 1 mm wider": (0, 0, 0, 0, 1e-3),
}


def shaft(bore: float, depth: float, ferrule: float, tip: float, taper: float) -> cf.Cue:
    """The hollow shaft with other sizes, m; its length stays."""
    leather, end, front, solid, opening, butt = cue("pool_hollow").segments
    bores = {"tip_bore": bore, "butt_bore": bore}
    remainder = end.length + front.length + solid.length - ferrule - depth
    pieces = (
        replace(leather, tip_diameter=tip, butt_diameter=tip),
        replace(end, length=ferrule, tip_diameter=tip, butt_diameter=tip, **bores),
        replace(front, length=depth, tip_diameter=tip, **bores),
        replace(solid, length=remainder, butt_diameter=taper),
        replace(opening, tip_diameter=taper),
        butt,
    )
    return replace(cue("pool_hollow"), segments=pieces)


@cache
def measures(struck: cf.Cue) -> tuple[float, float, float]:
    """Tip stiffness, N/m; squirt at b/R 0.3, deg, with a spring tip and in the default stroke."""
    stiffness = float(evaluate([cf.Scene(struck)], ["tip_stiffness"]).values[0, 0])
    return stiffness, squirt(strokes.scene(struck, 1e-3, 0.3)), squirt(strokes.full_model(struck, 0.3))


def change_table() -> str:
    """What one change makes."""
    base, rows = measures(shaft(*START)), []
    for name, by in CHANGES.items():
        result = measures(shaft(*np.add(START, by)))
        rows.append(
            [name, *(f"{100 * (new / value - 1):+.1f}" for new, value in zip(result[::-1], base[::-1], strict=True))]
        )
    tip, ferrule, *rest = cue("pool_hollow").segments
    heavy = replace(ferrule, material=replace(ferrule.material, rho=1.5 * ferrule.material.rho))
    result = measures(replace(cue("pool_hollow"), segments=(tip, heavy, *rest)))
    gained = (f"{100 * (new / value - 1):+.1f}" for new, value in zip(result[::-1], base[::-1], strict=True))
    rows.append([f"ferrule {1e3 * (heavy.mass - ferrule.mass):.2f} g heavier", *gained])
    return table(["change", "squirt, default stroke, %", "squirt, spring tip, %", "tip stiffness, %"], rows)


@cache
def optimum() -> tuple[float, ...]:
    """Sizes of the shaft of lowest squirt as stiff as the solid one, walls of 2 mm."""
    target, scale = measures(cue("pool_maple"))[0], np.array(START)
    limits = (
        {"type": "ineq", "fun": lambda x: measures(shaft(*(scale * x)))[0] / target - 1},
        {"type": "ineq", "fun": lambda x: (scale[3] * x[3] - scale[0] * x[0] - 4e-3) / 1e-3},
    )
    bounds = [(low / s, high / s) for (low, high), s in zip(BOUNDS, scale, strict=True)]
    start = np.clip(1.0 + np.array([0.0, 0.0, 0.0, 0.05, 0.1]), *np.transpose(bounds))
    options = {"maxiter": 25, "eps": 1e-3, "ftol": 1e-4}
    result = minimize(
        lambda x: measures(shaft(*(scale * x)))[2], start, bounds=bounds, constraints=limits, options=options
    )
    return tuple(float(x) for x in scale * result.x)


def shafts() -> dict[str, cf.Cue]:
    """The shafts that are compared."""
    shapes = {
        "solid pro taper": cue("pool_maple"),
        "hollow front, bore 6 mm": cue("pool_hollow"),
        "carbon tube": cue("carbon"),
    }
    shapes |= {f"hollow front, bore {1e3 * bore:g} mm": hollow(bore) for bore in strokes.BORES}
    shapes["bore 7 mm, tip 11 mm, taper to 14.3 mm"] = shaft(7e-3, *START[1:3], 11e-3, 14.3e-3)
    return shapes | {"lowest squirt, as stiff as the solid": shaft(*optimum())}


def shaft_table() -> str:
    """The shafts, and squirt over that of the solid one."""
    solid, rows = measures(cue("pool_maple")), []
    for name, cue_ in shafts().items():
        stiffness, spring, full = measures(cue_)
        rows.append(
            [
                name,
                f"{stiffness:.0f}",
                f"{spring:.2f}",
                f"{spring / solid[1]:.2f}",
                f"{full:.2f}",
                f"{full / solid[2]:.2f}",
            ]
        )
    return table(
        ["shaft", "tip stiffness, N/m", "squirt, spring tip, deg", "to solid", "default stroke, deg", "to solid"], rows
    )


def text() -> str:
    base, solid = measures(shaft(*START)), measures(cue("pool_maple"))
    wider, deep, broad = (measures(shaft(*np.add(START, CHANGES[n]))) for n in list(CHANGES)[:2] + list(CHANGES)[3:4])
    best = measures(shaft(*optimum()))
    sizes = ", ".join(
        f"{name} {1e3 * x:.1f} mm"
        for name, x in zip(("bore", "depth", "ferrule", "tip", "end of the taper"), optimum(), strict=True)
    )
    return pages.page(
        "Low-squirt shafts",
        "What lowers the squirt of a shaft, and what does it cost in stiffness?",
        "A wider bore: in a shaft that is already bored, 1 mm wider lowers squirt by "
        f"{100 * (1 - wider[2] / base[2]):.0f} % with a leather tip "
        f"({100 * (1 - wider[1] / base[1]):.0f} % with a spring tip) and stiffness by "
        f"{100 * (1 - wider[0] / base[0]):.1f} %; a tip 0.5 mm narrower lowers squirt by "
        f"{100 * (broad[2] / base[2] - 1):.0f} %. A bore 6 in deep instead of 5 in lowers it by "
        f"{100 * (1 - deep[2] / base[2]):.0f} %. At the stiffness of a solid shaft the lowest squirt found is "
        f"{best[2] / solid[2]:.2f} of its squirt.",
        "## One change at a time, hollow front",
        change_table(),
        "## Shafts, b/R 0.3",
        "A hollow end lowers squirt less with a leather tip than with a spring tip: the moment of the force on the "
        "dome is the same on every shaft, and a larger part of a small squirt. Measured, hollow over solid: 0.69 to "
        "0.72 (meshes/README.md).",
        shaft_table(),
        f"Lowest squirt: {sizes}; limits: stiffness of the solid shaft, walls of 2 mm, "
        + ", ".join(f"{1e3 * low:g} to {1e3 * high:g}" for low, high in BOUNDS)
        + " mm. `cuefem study studies/design/optimum.toml` finds such shafts for a spring tip.",
    )


def draw(axes: Any) -> None:
    """Squirt of the default stroke against tip stiffness, by bore and taper."""
    for taper in (12.45e-3, 13.4e-3, 14.3e-3):
        results = [measures(shaft(bore, *START[1:4], taper)) for bore in (1e-3, 3e-3, 5e-3, 6e-3, 7e-3, 8e-3, 9e-3)]
        axes.plot(
            [f[0] for f in results],
            [f[2] for f in results],
            "o-",
            ms=3,
            label=f"taper ends at {1e3 * taper:g} mm, bore 1 to 9 mm",
        )
    for name, cue_ in shafts().items():
        if "bore" not in name and name != "carbon tube":
            axes.plot(measures(cue_)[0], measures(cue_)[2], "k^" if "lowest" in name else "ks", label=name)
    axes.set(xlabel="static tip stiffness, N/m", ylabel="squirt of the default stroke, degrees")
    axes.legend(fontsize=8)


EXAMPLE = """\
from dataclasses import replace
import cuefem as cf

def wider(s: cf.Segment) -> cf.Segment:
    return replace(s, tip_bore=s.tip_bore + 1e-3, butt_bore=s.butt_bore + 1e-3) if s.tip_bore else s

scene = cf.load_scene("meshes/pool_hollow.toml")
bored = replace(scene.shaft, segments=tuple(map(wider, scene.shaft.segments)))
ratio = cf.strike(replace(scene, cue=bored)).squirt / cf.strike(scene).squirt
print(f"bore 1 mm wider: {100 * (ratio - 1):+.1f} % squirt")
"""
STUDY = pages.Study(__file__, text, {"low_squirt.svg": pages.Figure(draw)}, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
