"""The table of parameters: studies, sliders, uncertain parameters and options of commands derive from it.

An entry added here appears in all of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from cuefem.cue.materials import LEATHER_BY_NAME, LEATHERS, MATERIALS, WOODS, leather_restitution, table_name
from cuefem.parameters.field_paths import Path
from cuefem.parameters.parameter import Parameter, Slider, millimetres
from cuefem.parameters.parts import (
    BODY_MASS,
    BORE_DEPTH,
    BORE_WIDTH,
    CONTACT_TIME_OF_SPRING,
    EMPTY_DEPTH,
    FERRULE_LENGTH,
    FERRULE_MATERIAL,
    FRONT_WALL,
    GROWTH,
    INSERT_DEPTH,
    SHAFT_MATERIAL,
    WEIGHT,
    Layout,
    diameter_at,
    main_material,
    taper_position,
)
from cuefem.scene import Scene
from cuefem.scene.default_scene import BODY_MASS_RANGE


def _wood_spread(name: str) -> Callable[[Scene], float | None]:
    """Half the width of the wood's range, in logarithms; None for a weighed density."""

    def spread(scene: Scene) -> float | None:
        if name == "rho" and scene.shaft.shaft_mass_measured:
            return None
        wood = main_material(scene.shaft)
        low, high = MATERIALS[table_name(wood) or "hard maple"].ranges[name]
        return math.log(high / low) / 2

    return spread


def _leather_spread(scene: Scene) -> float | None:
    """From a contact time of ±10 % (1.0 to 1.2 ms) for a named leather, ±5 % for a custom E; None without one."""
    if scene.contact_terms.tip is None:
        return None
    is_tabulated = any(tip.E == scene.leather_tip.E for tip in LEATHERS.values())
    return CONTACT_TIME_POWER * (0.1 if is_tabulated else 0.05)


def _dependent_restitution(scene: Scene, E: float) -> dict[Path, float]:
    """The tip's restitution for another E of its leather, at the same restitution of the whole cue."""
    change = leather_restitution(E) - leather_restitution(scene.leather_tip.E)
    return {("tip", "restitution"): min(max(float(scene.tip.restitution) + change, 0.1), 1.0)}


def _restitution_spread(scene: Scene) -> float | None:
    """For whole cues of 0.71 to 0.75 (tips 0.575 to 0.633, `cuefem.identify_tip`); None without leather."""
    return None if scene.contact_terms.tip is None else 0.05


def _friction_spread(scene: Scene) -> float | None:
    """Root mean square distance of three published values from 0.7, in logarithms; None without friction.

    A tip slips first at offsets of 0.5 to 0.55 R, tan φ 0.577 and 0.659 ([TP 2.1]); [Kim] takes 0.7.
    """
    published = (math.tan(math.asin(0.5)), math.tan(math.asin(0.55)), 0.7)
    squares = [math.log(friction / 0.7) ** 2 for friction in published]
    return math.sqrt(sum(squares) / len(squares)) if scene.tip.friction else None


def _body_spread(scene: Scene) -> float | None:
    """Half the range of usual cues, in logarithms, of an assumed mass; None for another."""
    return math.log(BODY_MASS_RANGE[1] / BODY_MASS_RANGE[0]) / 2 if scene.shaft.is_body_mass_assumed else None


def _ferrule_spread(name: str) -> Callable[[Scene], float | None]:
    """Half the width of the range of a ferrule that stands for a trade name, in logarithms; None for others."""

    def spread(scene: Scene) -> float | None:
        ferrule = FERRULE_MATERIAL.read(scene)
        entry = MATERIALS.get(table_name(ferrule) or "") if ferrule else None
        if entry is None or not entry.is_class:
            return None
        low, high = entry.ranges[name]
        return math.log(high / low) / 2

    return spread


def _bore_spread(scene: Scene) -> float | None:
    """Half the range of drilled bores, 6 to 7.5 mm (meshes/README.md), in logarithms; None without a bore."""
    return math.log(7.5 / 6) / 2 if Layout.of(scene.shaft).bore else None


SHAFTS = (*WOODS, "carbon fibre")
CONTACT_TIME_POWER = 3.5  # a leather's E goes as that power of 1/contact time (`cuefem.identify_tip`)
FERRULES = tuple(name for name in MATERIALS if name not in (*SHAFTS, "foam", "leather"))
_LEATHERS = {
    name: {"leather.E": tip.E, "leather.nu": tip.nu, "leather.rho": tip.rho, "tip.restitution": tip.restitution}
    for name, tip in LEATHER_BY_NAME.items()
}

# Parts are written in this order: the shaft mass first, because it is measured before other changes; materials last,
# because ferrule and shaft are identified by theirs.
PARAMETERS: dict[str, Parameter] = {
    entry.key: entry
    for entry in (
        Parameter("E", "E of the wood", "wood.E", spread=_wood_spread("E")),
        Parameter("G", "G of the wood", "wood.G", spread=_wood_spread("G")),
        Parameter("rho", "density of the wood", "wood.rho", spread=_wood_spread("rho")),
        Parameter("ferrule E", "E of the ferrule", "ferrule.E", spread=_ferrule_spread("E")),
        Parameter("ferrule density", "density of the ferrule", "ferrule.rho", spread=_ferrule_spread("rho")),
        # half the logarithm of E's and rho's variation in one wood (22 and 10 %, materials.toml), in quadrature
        Parameter("wave speed", "speed of axial waves in the butt", "waves.wave_speed", spread=0.12),
        Parameter(
            name="shaft mass",
            label="weight of the shaft as drawn, with its tip",
            part=WEIGHT,
            option="MASS",
            help=(
                "Measured mass of the shaft with its tip, and with any ferrule and bore that other options add, e.g. "
                '"112 g"; sets the density of its wood.'
            ),
            slider=Slider("g", 1e3, 0, 0, 0.1, 0.1, 100_000),
        ),
        Parameter(
            "ferrule length", "length of the ferrule", part=FERRULE_LENGTH, slider=millimetres(2, 40, 0.5, 0.5, 60)
        ),
        Parameter(
            name="tip diameter",
            label="diameter at the tip",
            part=diameter_at(lambda cue: 0.0),
            slider=millimetres(8, 15, 0.05, 4, 30),
        ),
        Parameter(
            name="taper diameter",
            label="diameter where the taper begins",
            part=diameter_at(taper_position),
            slider=millimetres(8, 20, 0.05, 4, 60),
        ),
        Parameter(
            name="butt diameter",
            label="diameter at the end",
            part=diameter_at(lambda cue: cue.length),
            slider=millimetres(12, 34, 0.1, 4, 60),
        ),
        Parameter("taper", "diameter gained to the joint", part=GROWTH),
        Parameter(
            name="bore depth",
            label="depth of the bore",
            part=BORE_DEPTH,
            slider=millimetres(0, 300, 1, 0, 3000),
        ),
        Parameter(
            name="bore width",
            label="width of the bore",
            part=BORE_WIDTH,
            spread=_bore_spread,
            slider=millimetres(1, 11, 0.1, 0.1, 30),
        ),
        Parameter("front wall", "wall of a tube in its first 150 mm, at its front end", part=FRONT_WALL),
        Parameter("empty depth", "length of a tube that is not filled, from its front end", part=EMPTY_DEPTH),
        Parameter("insert depth", "length of a maple insert in the front of a tube", part=INSERT_DEPTH),
        Parameter(
            name="leather",
            label="E of the leather",
            path="leather.E",
            spread=_leather_spread,
            dependent_values=_dependent_restitution,
            option="LEATHER",
            help='Leather of the tip: soft, medium, hard, a tip of `cuefem parts`, or its E, e.g. "200 MPa".',
            sets=_LEATHERS,
        ),
        Parameter(
            name="tip height",
            label="height of the tip",
            path="leather.height",
            spread=0.1,
            option="LENGTH",
            help='Height of the leather tip, e.g. "6 mm".',
            slider=millimetres(2, 12, 0.1, 0.5, 40),
        ),
        Parameter(
            name="dome",
            label="tip radius (dome)",
            path="leather.dome_radius",
            spread=0.1,  # a dime's 8.95 to a nickel's 10.6 mm
            option="RADIUS",
            help='Tip radius (dome): nickel, dime, flat or a length, e.g. "9.5 mm".',
            slider=millimetres(6, 20, 0.1, 3, 500),
        ),
        Parameter(
            name="surface restitution",
            label="restitution along the leather's surface",
            path="leather.surface_restitution",
            below=0.05,  # not measured: 0.9 changes squirt by 7 %, and a robot's strokes suggest a value near 1
        ),
        # leather 1.0 to 1.2 ms
        Parameter(
            name="contact time",
            label="contact time",
            part=CONTACT_TIME_OF_SPRING,
            spread=0.1,
            slider=Slider("ms", 1e3, 0.6, 3, 0.01, 0.2, 20),
        ),
        Parameter(
            name="restitution",
            label="restitution of the tip",
            path="tip.restitution",
            spread=_restitution_spread,
            option="E",
            help="Restitution of the tip alone, 0 to 1; with axial waves a tip of 0.6 gives a whole cue 0.73.",
            slider=Slider("", 1.0, 0.5, 0.95, 0.01, 0, 1),
        ),
        Parameter(
            name="friction",
            label="friction of tip and ball",
            path="tip.friction",
            spread=_friction_spread,
            option="MU",
            help="Coefficient of friction between tip and ball.",
            slider=Slider("", 1.0, 0.2, 1.2, 0.01, 0.01, 10),
        ),
        Parameter(
            name="speed",
            label="speed of the cue",
            path="stroke.speed",
            option="SPEED",
            help='Cue speed at impact, e.g. "3 m/s".',
            slider=Slider("m/s", 1.0, 0.3, 12, 0.1, 0.01, 40),
        ),
        Parameter(
            name="offset",
            label="offset b/R",
            path="stroke.offset",
            option="B/R",
            help='Tip offset from the ball centre: b/R in (-1, 1), or a length, e.g. "8 mm".',
            slider=Slider("", 1.0, 0, 0.9, 0.01, -0.95, 0.95),
        ),
        Parameter(
            name="body mass",
            label="mass of the butt",
            part=BODY_MASS,
            spread=_body_spread,
            option="MASS",
            help='Mass of the butt, the rest of the cue behind what FILE draws, e.g. "420 g".',
            slider=Slider("g", 1e3, 0, 0, 1, 0, 5000),
        ),
        Parameter("ferrule material", "material of the ferrule", part=FERRULE_MATERIAL, materials=FERRULES),
        Parameter("shaft material", "material of the shaft", part=SHAFT_MATERIAL, materials=SHAFTS),
    )
}
