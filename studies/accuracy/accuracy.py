"""What are the numerical errors at the default resolution, and the errors of simpler models?

(a) The default of `strike` and `end_mass` against fine resolutions, on the cues of meshes/ and on random
cues (woods, carbon tubes, ferrules, bores; contact times 0.5 to 3 ms, b/R 0.05 to 0.5; all draws seeded). (b) Order
against number of elements in f1 to f10. (c) The number of modes in squirt. (d) The squirt of simpler models against
that of the full model (LeatherTip, AxialWaves, GeometricStiffness); each has the contact time and the restitution of
the full model's central impact. Equations: handbook: The beam, The strike, Effective end mass.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

import cuefem as cf
from cuefem.contact.refinement import refinement_levels
from cuefem.endmass.definitions import definition_of
from cuefem.scene.solved_scene import MAX_MODES, corrected_tip_modes
from studies import pages, strokes
from studies.pages import table

RANDOM, SEED, FINE = 12, 11, 2e-4  # random cues; accuracy of the reference, where 400 modes have it
MODES, MOST = (12, 24, 48, 96), 220
ORDERS, ELEMENTS = (4, 8, 16), (1, 2, 4, 8)
PLAYED = ((350e6, 4.0, 0.4), (229e6, 2.0, 0.3), (60e6, 0.8, 0.1))  # Pa, m/s, b/R
EFFECTS: tuple[tuple[str, tuple[cf.Effect, ...]], ...] = (
    ("dome", (strokes.DOME,)),
    ("tip shear", (strokes.SHEAR,)),
    ("rolling contact", (cf.RollingContact(),)),
)


def axial_waves(cue: cf.Cue) -> cf.Effect:
    """Those of the default stroke of pool, with its butt."""
    return next(effect for effect in cf.usual_scene(cue).effects if isinstance(effect, cf.AxialWaves))


def fine_squirt(scene: cf.Scene) -> float:
    """Squirt of the first refinement to `FINE`, or of the finest, rad."""
    *_, finest = refinement_levels(scene, FINE)
    return float(finest.outcome.squirt)


@cache
def errors() -> dict[str, np.ndarray]:
    """Relative errors of the default by quantity, over random cues and those of meshes/, three strokes each."""
    draw = np.random.default_rng(SEED)
    cues = [*map(strokes.cue, strokes.NAMES), *(strokes.random_cue(draw) for _ in range(RANDOM))]
    result: dict[str, list[float]] = {"squirt": [], "squirt, axial waves": [], "end mass, stick": []}
    result |= {"end mass, force": [], "squirt, rtol=1e-3": []}
    for cue in cues:
        for turn in range(3):
            scene = strokes.scene(cue, draw.uniform(0.5e-3, 3e-3), draw.uniform(0.05, 0.5))
            waves = replace(scene, effects=(axial_waves(cue),))
            fine = fine_squirt(scene)
            result["squirt"].append(cf.strike(scene).squirt / fine - 1)
            result["squirt, rtol=1e-3"].append(cf.strike(scene, rtol=1e-3).squirt / fine - 1)
            result["squirt, axial waves"].append(cf.strike(waves).squirt / fine_squirt(waves) - 1)
            for drive in ("force", "stick")[: 1 if turn else 2]:
                exact = definition_of(drive).of(*corrected_tip_modes(scene, MAX_MODES), scene)
                result[f"end mass, {drive}"].append(cf.end_mass(scene, drive) / exact - 1)
    return {name: np.abs(errors) for name, errors in result.items()}


def error_table() -> str:
    """Errors of the default, per cent."""
    rows = [[n, str(len(e)), *(f"{100 * q:.2f}" for q in np.quantile(e, (0.5, 0.95, 1)))] for n, e in errors().items()]
    return table(["quantity", "values", "median, %", "95th percentile, %", "largest, %"], rows)


def order_table() -> str:
    """Largest relative error of f1 to f10 over the cues of meshes/."""

    def tones(name: str, at: cf.Resolution) -> Any:
        return cf.modes(strokes.cue(name), 10, at=at).frequencies

    rows = []
    for order in ORDERS:
        offs = []
        for n in ELEMENTS:
            try:
                over = [
                    tones(k, cf.Resolution(n, order, 10)) / tones(k, cf.Resolution(10, 14, 10)) for k in strokes.NAMES
                ]
                off = max(float(np.abs(one - 1).max()) for one in over)
                offs.append("< 1e-09" if off < 1e-9 else f"{off:.0e}")
            except ValueError:  # fewer modes than were asked for
                offs.append("–")
        rows.append([str(order), *offs])
    return table(["order", *(f"{n} elements a piece" for n in ELEMENTS)], rows)


def mode_table() -> str:
    """Largest relative error of squirt by so many modes, summed without a truncation correction."""
    scenes = [
        strokes.scene(strokes.cue(k), T, b) for k in strokes.NAMES for T, b in ((7e-4, 0.4), (1e-3, 0.3), (2e-3, 0.1))
    ]
    fine = [fine_squirt(scene) for scene in scenes]

    def worst(at: cf.Resolution | None) -> str:
        return f"{100 * max(abs(cf.strike(s, at).squirt / f - 1) for s, f in zip(scenes, fine, strict=True)):.2f}"

    rows = [[str(count), worst(cf.Resolution(6, 16, count))] for count in MODES]
    return table(["modes", "largest error of squirt, %"], [*rows, ["default, with the correction", worst(None)]])


@cache
def ladder() -> dict[str, np.ndarray]:
    """Squirt by every model over that of the full model, less 1."""
    models: dict[str, Callable[[cf.Scene], Any]] = {
        "Kim's closed form, 12 g": lambda s: (
            cf.impulse(replace(s, cue=cf.LumpedCue.two_part(s.axial_mass, 0.012))).squirt
        )
    }
    for drive in ("stick", "velocity", "force"):
        models[f"lumped, {drive} end mass"] = lambda s, d=drive: strokes.lumped_squirt(s, cf.end_mass(s, d))
    models["coupled beam"] = lambda s: cf.strike(s).squirt
    for i, (name, _) in enumerate(EFFECTS, 1):
        effects = tuple(effect for _, group in EFFECTS[:i] for effect in group)
        models[f"... and {name}"] = lambda s, effects=effects: cf.strike(replace(s, effects=effects)).squirt
    result: dict[str, list[float]] = {name: [] for name in models}
    for name in strokes.NAMES:
        for E, speed, offset in PLAYED:
            struck = replace(strokes.full_model(strokes.cue(name), offset, speed, E=E), ball=cf.Ball())
            head_on = cf.strike(replace(struck, stroke=cf.Stroke(speed, 0.0)))
            tip, expected = cf.Tip(cf.rebound(struck), 0.7, contact_time=head_on.duration), cf.strike(struck).squirt
            spring = cf.Scene(strokes.cue(name), tip=tip, stroke=cf.Stroke(speed, offset))
            for model, squirt in models.items():
                result[model].append(float(squirt(spring)) / expected - 1)
    return {name: 100 * np.array(values) for name, values in result.items()}


def text() -> str:
    squirt, stick = (100 * errors()[name] for name in ("squirt", "end mass, stick"))
    medians = {name: f"{np.median(np.abs(values)):.0f} %" for name, values in ladder().items()}
    rows = [[name, *(f"{f(v):+.0f}" for f in (np.median, np.min, np.max))] for name, v in ladder().items()]
    return pages.page(
        "Numerical errors and model errors",
        "What are the numerical errors at the default resolution, and the errors of simpler models?",
        f"At the default resolution the error of squirt is {np.quantile(squirt, 0.95):.2f} % (95th percentile) and "
        f"{squirt.max():.1f} % (maximum) over {len(squirt)} strokes with a spring tip, that of the stick end mass "
        f"{np.quantile(stick, 0.95):.2f} and {stick.max():.1f} %. The choice of model matters more. Median difference "
        f"of squirt from the full model: Kim's 12 g {medians[next(iter(medians))]}, the stick end mass "
        f"{medians['lumped, stick end mass']}, a beam without effects {medians['coupled beam']}, with the tip's dome "
        f"and shear {medians['... and tip shear']}. The model error of the full model is up to 18 % "
        "([uncertainty](../measured/uncertainty.md)).",
        "## Numerical errors at the default resolution",
        "Five cues of meshes/ and 12 random ones, 3 strokes each, against a refinement to 2e-4 or to 400 modes. A "
        "brass tip, which vibrates at 100 to 250 kHz, is not included: the error of its stick end mass is up to 1.4 %.",
        error_table(),
        "## Order against elements: largest relative error of f1 to f10",
        order_table(),
        "## Modes: squirt",
        mode_table(),
        "## Simpler models: difference of squirt from the full model, %",
        "Five cues x (leather of 350 MPa, 4 m/s, b/R 0.4), (229 MPa, 2 m/s, 0.3), (60 MPa, 0.8 m/s, 0.1), a ball of "
        "210 g.",
        table(["model", "median", "lowest", "highest"], rows),
    )


EXAMPLE = """\
import cuefem as cf

scene = cf.load_scene("studies/scenes/kim.toml")
fine = cf.strike(scene, cf.Resolution(elements=4, order=20, modes=160)).squirt
for modes in (4, 8, 16, 32):
    squirt = cf.strike(scene, cf.Resolution(elements=4, order=20, modes=modes)).squirt
    print(f"{modes:2} modes: {100 * (squirt / fine - 1):+.3f} %")
"""
STUDY = pages.Study(__file__, text, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
