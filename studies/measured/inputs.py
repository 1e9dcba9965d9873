"""How sensitive is squirt to butt and leather of the default stroke, and how do their values follow from measurements?

Contact time and restitution of a whole cue identify the leather's E and the tip's restitution together
(`cuefem.identify_tip`); a butt behind the shaft reflects axial waves later than a rigid mass at the joint. Three
strokes are compared: rigid mass and 140 MPa with e 0.63; the butt and 140 MPa; butt and 229 MPa. Data: squirt.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache, partial
from typing import Any

from scipy.optimize import brentq

import cuefem as cf
from cuefem.contact.tips import MIN_LEATHER_RESTITUTION
from cuefem.cue.materials import LEATHERS
from cuefem.results.closed_forms import pivot_length
from studies import pages, strokes
from studies.measured.published import INCHES, mass_ratios
from studies.pages import table
from studies.strokes import INCH, at_offset, cue, full_model, hollow, squirt, with_tip

Inputs = Callable[[cf.Scene], cf.Scene]
SPEEDS = (0.8, 2.0, 4.0, 7.0)
TIMES = (2.0, 1.8, 1.6, 1.5, 1.4, 1.3, 1.2, 1.135, 1.1, 1.05, 1.0, 0.95, 0.9)  # ms
REBOUND = 0.73
PHENOLIC = {"nu": 0.33, "rho": 1340.0, "dome_radius": 12.7e-3}  # a break tip
# E, Pa, and restitution of the former leathers, whose contact times were those of a rigid cue of e 0.73.
FORMER = {name: (E, 0.6315) for name, E in (("soft", 30e6), ("medium", 140e6), ("hard", 360e6))}
CURRENT = {name: (known.E, known.restitution) for name, known in LEATHERS.items()}


def with_inputs(struck: cf.Scene, name: str = "medium", *, butt: bool, former: bool) -> cf.Scene:
    """The scene with a former or current leather, and a butt or a rigid mass at the joint."""
    scene = with_tip(struck, *(FORMER if former else CURRENT)[name])
    if butt:
        return scene
    return replace(scene, effects=tuple(cf.AxialWaves() if isinstance(e, cf.AxialWaves) else e for e in scene.effects))


STROKES: dict[str, Any] = {
    "rigid mass, 140 MPa": partial(with_inputs, butt=False, former=True),
    "butt, 140 MPa": partial(with_inputs, butt=True, former=True),
    "butt, 229 MPa": partial(with_inputs, butt=True, former=False),
}


def maple(offset: float = 0.375, speed: float = 2.0) -> cf.Scene:
    """The maple shaft in the full model."""
    return full_model(cue("pool_maple"), offset, speed)


def head_on(struck: cf.Scene) -> tuple[float, float]:
    """Contact time, s, and rebound of the whole cue."""
    return float(cf.strike(at_offset(struck, 0.0)).duration), cf.rebound(struck)


def several(values: Iterator[float] | list[float], digits: int = 2) -> str:
    """Some numbers in a cell."""
    return ", ".join(f"{value:.{digits}f}" for value in values)


def rows(of: Any) -> Iterator[tuple[str, str, str]]:
    """Name, measured value and computed value of each quantity."""
    yield "squirt at b/R 0.375, 2 m/s, deg", "2.30, 2.43", f"{squirt(of(maple())):.2f}"
    speeds = [squirt(of(maple(speed=v))) for v in SPEEDS]
    yield "at 0.8, 2, 4, 7 m/s (largest over smallest)", "–", f"{several(speeds)} ({pages.change(speeds)})"
    moduli = [squirt(replace_E(of(maple()), E)) for E in (70e6, 140e6, 280e6)]
    yield "at 70, 140, 280 MPa", "–", f"{several(moduli)} ({pages.change(moduli)})"
    for name, shaft, text in (("Players", cue("pool_maple"), "12.7"), ("Predator Z", hollow(strokes.BORES[1]), "20.2")):
        struck = of(full_model(shaft))
        length = float(pivot_length(struck, math.radians(squirt(struck)), 0.375)) / INCH
        yield f"pivot length of {name}, in", text, f"{length:.1f}"
    angles = [squirt(of(maple(b))) for b in (0.187, 0.320, 0.453)]
    yield "at b/R 0.187, 0.320, 0.453 (2007)", "0.84, 1.43, 2.50", several(angles)
    ratio = squirt(of(full_model(hollow(strokes.BORES[1]), 0.453))) / angles[2]
    yield "Predator Z over maple at b/R 0.453", "0.72", f"{ratio:.3f}"
    ratios = {x: with_mass(of(maple()), x) for x in INCHES}
    measured = {x: mass_ratios()[11, x][0] for x in INCHES}
    some = [x for x in (2, 4, 7, 9) if x in ratios]
    yield f"11 g at {several(some, 0)} in", several([measured[x] for x in some]), several([ratios[x] for x in some])
    yield "RMS of the difference, ten positions", "", f"{pages.rms(ratios[x] - measured[x] for x in INCHES):.2f}"
    impacts = [head_on(of(maple(speed=v))) for v in SPEEDS]
    yield "head on: contact time at these speeds, ms", "1.0 to 1.2", several([1e3 * time for time, _ in impacts])
    yield "head on: rebound at these speeds", "0.71 to 0.75", several([rebound for _, rebound in impacts])
    for v in (2.0, 5.0):
        soft, hard = (squirt(of(maple(speed=v), name)) for name in ("soft", "hard"))
        yield f"soft over hard leather at {v:g} m/s", "1.00 ± 0.05", f"{soft / hard:.2f}"


def replace_E(struck: cf.Scene, E: float) -> cf.Scene:
    """The scene with another E of its leather."""
    return with_tip(struck, E, float(struck.tip.restitution))


def with_mass(struck: cf.Scene, inches: float) -> float:
    """Squirt with 11 g on the shaft over that without."""
    lump = cf.PointMass(position=inches * INCH - struck.leather_tip.height, mass=11e-3)
    return squirt(replace(struck, effects=(*struck.effects, lump))) / squirt(struck)


def stroke_table() -> str:
    """The three strokes beside measured values."""
    columns = {name: list(rows(of)) for name, of in STROKES.items()}
    first = next(iter(columns.values()))
    cells = [[name, value, *(each[i][2] for each in columns.values())] for i, (name, value, _) in enumerate(first)]
    return table(["", "measured", *STROKES], cells)


@cache
def identified(milliseconds: float, rebound: float = REBOUND, **phenolic: float) -> Any:
    """The tip of a whole cue with this contact time."""
    return cf.identify_tip(full_model(cue("whole_cue"), **phenolic), 1e-3 * milliseconds, rebound)


def leather_table() -> str:
    """E, restitution and squirt by contact time, of the whole cue, and of the shaft with a butt."""
    lines = []
    for time in TIMES:
        tip = identified(time)
        squirts = (squirt(with_tip(full_model(cue(name)), *tip)) for name in ("whole_cue", "pool_maple"))
        lines.append([f"{time:g}", f"{tip.E / 1e6:.0f}", f"{tip.restitution:.2f}", *(f"{s:.2f}" for s in squirts)])
    return table(["T, ms", "E, MPa", "tip's e", "squirt, whole cue, deg", "shaft with a butt, deg"], lines)


def input_table() -> str:
    """Change of squirt with the butt's numbers at 2 and 7 m/s, %."""
    changes: dict[str, Inputs] = {
        "waves in the butt 12 % slower": lambda s: waving(s, wave_speed=0.88),
        "12 % faster": lambda s: waving(s, wave_speed=1.12),
        "butt 29 mm wide for 31.75 mm": lambda s: waving(s, butt_diameter=29 / 31.75),
        "cue 57 in long for 58 in": lambda s: waving(s, cue_length=57 / 58),
        "a butt that bends too": lambda s: replace(s, cue=waves_of(s).with_butt(s.shaft)),
        "the whole cue drawn, joint, pin and weight bolt": lambda s: replace(s, cue=full_model(cue("whole_cue")).cue),
    }
    base = {v: squirt(maple(speed=v)) for v in (2.0, 7.0)}
    lines = [
        [name, *(f"{100 * (squirt(of(maple(speed=v))) / base[v] - 1):+.1f}" for v in base)]
        for name, of in changes.items()
    ]
    return table(["change", "at 2 m/s, %", "at 7 m/s, %"], lines)


def waves_of(struck: cf.Scene) -> cf.AxialWaves:
    """The scene's axial waves."""
    return next(e for e in struck.effects if isinstance(e, cf.AxialWaves))


def waving(struck: cf.Scene, **factors: float) -> cf.Scene:
    """The scene with some numbers of its butt times factors."""
    waves = waves_of(struck)
    result = replace(waves, **{name: factor * getattr(waves, name) for name, factor in factors.items()})
    return replace(struck, effects=tuple(result if e is waves else e for e in struck.effects))


def shortest(rebound: float) -> str:
    """Contact time, ms, of the leather of the least restitution with this rebound; a larger E shortens it."""
    struck, least = full_model(cue("whole_cue")), MIN_LEATHER_RESTITUTION
    E = math.exp(brentq(lambda log_E: cf.rebound(with_tip(struck, math.exp(log_E), least)) - rebound, 18, 24))
    central = with_tip(replace(struck, stroke=replace(struck.stroke, offset=0.0)), E, least)
    return f"{1e3 * cf.strike(central).duration:.2f}"


def text() -> str:
    former, with_butt, current = (squirt(of(maple())) for of in STROKES.values())
    medium = identified(1.135)
    hard = [identified(0.9, rebound, **PHENOLIC) for rebound in (0.81, 0.87)]
    return pages.page(
        "Butt and leather of the default stroke",
        "How sensitive is squirt to butt and leather of the default stroke, and how do their values follow from "
        "measurements?",
        f"Squirt of the maple shaft at b/R 0.375 and 2 m/s is {current:.2f}° ({former:.2f}° with a rigid mass at the "
        f"joint and leather of 140 MPa, {with_butt:.2f}° with the butt alone). Medium leather has "
        f"{medium.E / 1e6:.0f} MPa and e {medium.restitution:.2f}; no leather has a contact time below "
        f"{shortest(REBOUND)} ms.",
        stroke_table(),
        "## Modulus and restitution of leather by contact time",
        "Central impact at 2 m/s, pool ball, meshes/whole_cue.toml, restitution of the whole cue 0.73; squirt at b/R "
        "0.375 and 2 m/s.",
        leather_table(),
        f"A contact time below {shortest(REBOUND)} ms would require a tip restitution below 0.1. The "
        "published 0.8 ms is of phenolic in a fast stroke (Alciatore, FAQ, tip contact time: most tips 1 to 2 ms, soft "
        "tips in slow strokes up to 3 ms). The data linked in the FAQ are of dbkcues.ru, a maker of cues for Russian "
        "pyramid, with balls of 285 g; whether the FAQ uses them was not checked. A phenolic tip with a dome of 12.7 "
        "mm, a contact time of 0.9 ms and a restitution of the whole cue of 0.81 to 0.87 has "
        f"{hard[0].E / 1e6:.0f} to {hard[1].E / 1e6:.0f} MPa and e "
        f"{hard[0].restitution:.2f} to {hard[1].restitution:.2f}.",
        "## Sensitivity of squirt to the butt: maple shaft, b/R 0.375",
        input_table(),
    )


EXAMPLE = """\
from dataclasses import replace
from math import degrees
import cuefem as cf

scene = cf.load_scene("meshes/pool_maple.toml")
for butt in (0.38, 0.43, 0.48):
    squirt = cf.strike(replace(scene, cue=replace(scene.shaft, body_mass=butt))).squirt
    print(f"{butt} kg behind the shaft: {degrees(squirt):.2f} degrees")
"""
STUDY = pages.Study(__file__, text, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
