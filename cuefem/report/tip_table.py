"""The leather tip of a scene by itself: record and sheets."""

from __future__ import annotations

import numpy as np

from cuefem.contact.calibrated import head_on, rebound_of
from cuefem.effects import LeatherTip
from cuefem.effects.leather_law import LeatherLaw
from cuefem.results.quantities import NONE, grams, significant, with_unit, written
from cuefem.results.records import Record, Sheet, by_words, sheet
from cuefem.scene import Scene

SPEEDS = (0.5, 1.0, 2.0, 3.0, 5.0, 8.0)  # m/s
SHEAR_OFFSETS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)  # b/R
CURVE = 41  # points of the force over the depth


def tip_record(scene: Scene) -> Record:
    """What a tip of leather does: head on at several speeds, sideways at several offsets, and its force over depth.

    A speed at which the leather would be pressed further than its law is known has None. The shear ratio is that of a
    patch which sticks, as large as the greatest of a head-on blow at the scene's speed, along the surface over along
    the normal.
    """
    leather = scene.leather
    diameter = leather.diameter_on(scene.shaft.segments[0].tip_diameter)
    restitution = float(scene.tip.restitution)
    law = scene.tip_law(restitution)
    patches, depths, _ = leather.head_on(diameter, float(scene.ball.radius))
    speeds = sorted({*SPEEDS, float(scene.stroke.speed)})
    deepest, _ = law.blow(scene.head_on_mass, scene.stroke.speed)
    patch = float(np.interp(deepest, depths, patches))
    slope = float(law.slope(np.array([deepest]))[0])
    along = np.linspace(0.0, law.most, CURVE)
    struck = head_on(scene)
    return {
        "tip_mass": leather.mass(diameter),
        "contact_time": scene.contact_time,
        "E": leather.E,
        "struck": {"contact_time": struck.duration, "rebound": rebound_of(struck, scene)},
        "blows": [_blow(scene, law, speed, patches, depths) for speed in speeds],
        "shear_ratios": [
            {"offset": offset, "ratio": _shear_ratio(leather, diameter, patch, slope, offset)}
            for offset in SHEAR_OFFSETS
        ],
        "patch": 2 * patch,
        "curve": {"depth": along, "force": law.at(along)[0]},
    }


def _blow(scene: Scene, law: LeatherLaw, speed: float, patches: np.ndarray, depths: np.ndarray) -> Record:
    """A head-on blow at a speed, m/s, of a cue that is rigid along its axis."""
    try:
        deepest, loading = law.blow(scene.head_on_mass, speed)
    except ValueError:
        return {"speed": speed, "contact_time": None, "force": None, "depth": None, "patch": None}
    return {
        "speed": speed,
        "contact_time": (1 + law.restitution) * loading,
        "force": float(law.at(np.array([deepest]))[0][0]),
        "depth": deepest,
        "patch": 2 * float(np.interp(deepest, depths, patches)),
    }


def _shear_ratio(leather: LeatherTip, diameter: float, patch: float, slope: float, offset: float) -> float:
    """Stiffness of a patch of that radius along the surface over that along the normal (slope: on the axis)."""
    normal = slope * float(np.interp(patch, *leather.normal_ratio(diameter, offset)))
    if leather.shear is not None:
        return leather.shear / normal
    return float(np.interp(patch, *leather.shear_stiffness(diameter, offset))) / normal


def tip_sheets(record: Record, scene: Record, wanted: float | None) -> list[Sheet | str]:
    """A tip's blows head on, its shear ratio, and the leather that has the contact time asked for."""
    struck, tip, speed = record["struck"], scene["tip"], f"{scene['stroke']['speed']:g} m/s"
    lines = [f"mass of the leather {grams(record['tip_mass'])}; E {significant(record['E'] / 1e6)} MPa"]
    if wanted is not None:
        lines.append(f"E is what makes a head-on blow at {speed} last {with_unit(wanted, 's', 6)}")
    return [
        *lines,
        "",
        sheet(
            "Head on",
            {"ball or cue at": "{speed:g} m/s"} | by_words("contact_time", "force", "depth", "patch"),
            record["blows"],
            f"restitution {tip['restitution']:g}; the cue is rigid along its axis",
            f"the scene's own blow at {speed}, with waves along the cue if it lists them: it lasts "
            f"{with_unit(struck['contact_time'], 's')}, and the whole cue rebounds with {struck['rebound']:.3f}",
            *([f"{NONE}: the leather would be pressed further than its law is known"] if _unknown(record) else []),
            texts=(),
        ),
        sheet(
            "Sideways",
            {"b/R": "{offset:g}", "shear ratio": "{ratio:.3f}"},
            record["shear_ratios"],
            "stiffness along the surface over that along the normal, of a patch that sticks "
            f"({written('patch', record['patch'])} wide, the largest head on at {speed})",
            texts=(),
        ),
    ]


def _unknown(record: Record) -> bool:
    return any(blow["contact_time"] is None for blow in record["blows"])
