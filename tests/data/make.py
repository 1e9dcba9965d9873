"""Makes the stored answers of this folder: `python -m tests.data.make strikes|cues`, about ten minutes in all.

It was run once, with the engine of commit 1e8a581 (collocation of order 14), whose rings were solved to 1e-9; it is
kept to show what the data are. Scenes are drawn at random over every law and effect, 20 of a kind.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np

import cuefem as cf
from cuefem.beam.spectrum import ended
from cuefem.beam.system import assemble
from cuefem.beam.tip import TipModes, lumped_tip_modes
from cuefem.beam.waves import ended_mesh_for
from cuefem.contact import laws
from cuefem.contact.strike import strike_modes
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.scene import Scene
from cuefem.scene.default_scene import without_leather
from cuefem.tip_modes import Solved, tip_modes_from, turning
from tests.data.stored import DATA, EFFECTS, PARTS, cue_of, rebuilt, scene_of, stored_law

MESHES = Path(__file__).parents[2] / "meshes"
BEHIND = {  # what acts on the cue behind the tip, by the name of a set of tip modes
    "plain": (),
    "damped": ("StructuralDamping",),
    "axial": ("AxialWaves", "StructuralDamping"),
    "thrust": ("AxialWaves", "GeometricStiffness"),
}
NEEDS = {"axial": "axial", "usual": "thrust", "thrust": "thrust", "raised thrust": "thrust", "damping": "damped"}
KINDS = (
    *("linear", "dome", "shear", "axial", "damping", "power", "power shear", "rolling", "thrust", "second hit"),
    *("low e", "endless", "endless shear", "lumped", "leather", "leather spring", "leather loss", "usual", "raised"),
    "raised thrust",
)
ROWS = 24  # of the geometric stiffness


def drawn(rng: np.random.Generator, low: float, high: float) -> float:
    """A number of a uniform logarithm, to four digits."""
    return float(f"{np.exp(rng.uniform(np.log(low), np.log(high))):.4g}")


def compact(tip: TipModes) -> dict[str, Any]:
    """Parts of tip modes, rounded to single precision; of the matrices, rows whose squares add up to them."""
    parts: dict[str, Any] = {name: np.asarray(getattr(tip, name), np.float32) for name in PARTS[:4]}
    for name in PARTS[4:]:
        matrix = getattr(tip, name)
        if matrix is not None:
            strengths, directions = np.linalg.eigh(matrix)
            kept = np.flatnonzero(strengths > 1e-14 * strengths[-1])[-(ROWS if name == "geometric" else len(matrix)) :]
            parts[name] = (directions[:, kept] * np.sqrt(strengths[kept])).T.astype(np.float32)
    return parts


def effects_of(rng: np.random.Generator, kind: str, diameter: float) -> dict[str, dict[str, float]]:
    """The effects at the contact, by class and field."""
    dome = {"TipDome": {"radius": drawn(rng, 6e-3, 12e-3)}}
    shear = {"TipShear": {"ratio": drawn(rng, 0.25, 4.0)}}
    power = {"PowerLawTip": {"exponent": float(rng.choice([1.25, 1.5, 2.0]))}}
    leather = {
        "height": float(f"{rng.uniform(0.35, 0.6) * diameter:.4g}"),
        "dome_radius": float(f"{rng.uniform(0.65, 1.0) * diameter:.4g}"),
        "E": drawn(rng, 60e6, 400e6),
    }
    raised = {"Elevation": {"angle": drawn(rng, 0.02, 0.6), "friction": float(rng.choice([0.0, 0.2, 0.3]))}}
    of_kind: dict[str, dict[str, dict[str, float]]] = {
        "dome": dome,
        "shear": dome | shear,
        "axial": dome,
        "power": power,
        "power shear": power | shear | dome,
        "rolling": {"RollingContact": {}} | dome,
        "thrust": dome,
        "second hit": {"SecondHit": {"window": 4e-3}},
        "endless shear": shear | dome,
        "leather": {"LeatherTip": leather},
        "leather spring": {"LeatherTip": leather | {"shear": drawn(rng, 5e5, 2e6)}},
        "leather loss": {"LeatherTip": leather | {"surface_restitution": drawn(rng, 0.5, 0.95)}},
        "usual": {"LeatherTip": leather},
        "raised": raised | (dome if rng.random() < 0.5 else {}),
        "raised thrust": raised | dome,
    }
    return of_kind.get(kind, {})


def row_of(rng: np.random.Generator, kind: str, name: str, cue: cf.Cue, time: float) -> dict[str, Any]:
    """The inputs of a strike of a kind, on the tip modes of a name, made for contacts of about this time, s."""
    diameter = float(cue.segments[0].tip_diameter)
    leather = kind.startswith("leather") or kind == "usual"
    e = {"low e": rng.uniform(0.05, 0.3)}.get(kind, rng.uniform(0.4 if leather else 0.3, 1.0))
    friction: Any = "inf" if kind.startswith("endless") else float(rng.choice([0.1, 0.3, 0.6, 0.7, 0.8, 1.5]))
    tip = {"restitution": float(f"{e:.4g}"), "friction": friction}
    if not leather:
        tip["contact_time"] = float(f"{time * rng.uniform(0.7, 1.4):.4g}")
    speed = min(drawn(rng, 0.3, 8.0), 4.0 if kind in ("thrust", "raised thrust") else 8.0)
    offset = float(f"{rng.choice([-1, 1]) * rng.uniform(0.05, 0.55 if 'raised' in kind else 0.7):.4g}")
    ball = [float(f"{rng.uniform(0.12, 0.22):.4g}"), 0.028575]
    scene: dict[str, Any] = {"ball": ball, "tip": tip, "stroke": [speed, offset]}
    scene["effects"] = effects_of(rng, kind, diameter)
    if kind == "lumped":
        mass = drawn(rng, 0.3, 0.7)
        scene["lumped"] = [mass, drawn(rng, 2e-3, 0.1), float(rng.choice([0.0, 0.3])) / mass]
        return {"kind": kind, "scene": scene}
    scene["cue"] = [diameter, float(cue.mass)]
    return {"kind": kind, "tip": name, "scene": scene}


def tables() -> tuple[dict[str, dict[str, Any]], dict[str, tuple[cf.Cue, float]]]:
    """Tip modes of every cue with what acts behind its tip, as parts, and the cue and the contact time of each."""
    rng, parts, of = np.random.default_rng(39), {}, {}
    cues = {path.stem: cf.load(path) for path in sorted(MESHES.glob("*.toml"))}
    for number, (stem, cue) in enumerate((stem, cue) for stem, cue in cues.items() if isinstance(cue, cf.Cue)):
        for behind, names in BEHIND.items():
            for leather in (False, True):
                if leather and behind not in ("plain", "thrust"):
                    continue
                time = drawn(rng, 5e-4, 3e-3) if not leather else 1.2e-3
                drawing = without_leather(cue) if leather else cue
                effects = (*(EFFECTS[each]() for each in names), cf.TipDome(9e-3))
                scene = Scene(drawing, tip=cf.Tip(contact_time=time), stroke=cf.Stroke(2.0, 0.3), effects=effects)
                name = f"{number} {behind}{' leather' if leather else ''}"
                parts[name], of[name] = compact(Solved(scene).tip), (drawing, time)
                print(stem, name, len(parts[name]["omega"]), flush=True)
    return parts, of


def make_strikes(each: int = 20) -> None:
    """400 strikes."""
    laws.RINGED_TOLERANCE = laws.LEATHER_TOLERANCE = 1e-9  # type: ignore[misc]
    parts, of = tables()
    np.savez_compressed(DATA / "tip_modes.npz", **{f"{n}:{key}": a for n, p in parts.items() for key, a in p.items()})
    modes = {name: rebuilt({key: part.astype(float) for key, part in of_tip.items()}) for name, of_tip in parts.items()}
    rows = []
    for kind in KINDS:
        rng, count = np.random.default_rng(abs(hash_of(kind))), 0
        while count < each:
            leather = kind.startswith("leather") or kind == "usual"
            names = [n for n in of if NEEDS.get(kind, "plain") in n and (" leather" in n) == leather]
            name = str(rng.choice(names))
            row = row_of(rng, kind, name, *of[name])
            try:
                if leather:
                    scene, radius = scene_of(row), row["scene"]["ball"][1]
                    head, there = (scene.tip_law(1.0, x) for x in (0.0, abs(row["scene"]["stroke"][1])))
                    row["law"] = {"head on": law_row(head), "at offset": law_row(there)}
                    assert radius == 0.028575
                with stored_law(row):
                    scene = scene_of(row)
                    tip = lumped_tip_modes(scene.lumped) if scene.lumped else modes[name]
                    outcome = strike_modes(scene, tip)
            except (ValueError, RuntimeError) as error:
                print(kind, str(error)[:100], flush=True)
                continue
            row["answer"] = answer_of(outcome)
            rows.append(row)
            count += 1
        print(kind, flush=True)
    (DATA / "strikes.json").write_text("[\n" + ",\n".join(json.dumps(row) for row in rows) + "\n]\n")


def hash_of(kind: str) -> int:
    """A seed that does not change from run to run."""
    return sum(ord(letter) * 31**i for i, letter in enumerate(kind)) % 2**31


def law_row(law: Any) -> list[Any]:
    """What a leather law is made of."""
    return [list(law.force_terms), list(law.give_terms), law.most]


def answer_of(outcome: Any) -> dict[str, Any]:
    """What is compared."""
    names = ("squirt", "ball_speed", "spin", "cue_speed", "duration")
    return {name: float(getattr(outcome, name)) for name in names} | {
        "ball_velocity": [float(v) for v in outcome.ball_velocity],
        "regime": str(outcome.regime),
        "energy": {name: float(f"{value:.12g}") for name, value in outcome.energy.items()},
    }


def drawn_cue(rng: np.random.Generator) -> dict[str, Any]:
    """A cue: a ferrule and two to three cones of wood or carbon, some bored, some with leather drawn in."""
    segments, diameter = [], float(f"{rng.uniform(0.0115, 0.0135):.4g}")
    if rng.random() < 0.3:
        segments.append([0.006, diameter, diameter, 0.1e9, 0.033e9, 950.0, 0.2])
    segments.append([drawn(rng, 0.008, 0.03), diameter, diameter, drawn(rng, 2e9, 10e9), 1e9, 1200.0, 0.03])
    carbon = rng.random() < 0.25
    for length in (drawn(rng, 0.08, 0.2), drawn(rng, 0.15, 0.3), drawn(rng, 0.2, 0.45)):
        butt = float(f"{diameter * rng.uniform(1.0, 1.25):.4g}")
        bore = float(f"{diameter * rng.uniform(0.4, 0.75):.4g}") if carbon or rng.random() < 0.3 else 0.0
        E = drawn(rng, 40e9, 80e9) if carbon else drawn(rng, 10e9, 18e9)
        loss = 0.005 if carbon else 0.012
        rho = 1550.0 if carbon else drawn(rng, 600, 850)
        segments.append([length, diameter, butt, E, drawn(rng, 0.8e9, 1.4e9), rho, loss, bore, bore])
        diameter = butt
    return {"segments": segments, "body_mass": drawn(rng, 0.3, 0.5), "contact_time": drawn(rng, 5e-4, 3e-3)}


def make_cues(count: int = 100, with_modes: int = 30, kept: int = 400) -> None:
    """End masses of 100 cues from 400 modes and a tail, and 12 frequencies of the first 30."""
    rng, rows = np.random.default_rng(40), []
    while len(rows) < count:
        row = drawn_cue(rng)
        cue = cue_of(row)
        tip = cf.Tip(contact_time=row["contact_time"], friction=math.inf)
        row["end_mass"] = {}
        for name, effects in (("free", ()), ("damped", (cf.StructuralDamping(),))):
            scene = Scene(cue, tip=tip, stroke=cf.Stroke(2.0, 0.3), effects=effects)
            elements, orders = ended_mesh_for(cue, kept)
            system = assemble(cue, elements=elements, order=orders, effects=scene.cue_effects, count=kept)
            modes = tip_modes_from(ended(system, kept, turning=turning(scene))(kept), scene)
            row["end_mass"][name] = {}
            for drive, definition in DEFINITIONS.items():
                try:
                    row["end_mass"][name][drive] = float(definition.of(modes, scene))
                except ValueError as error:
                    print(len(rows), drive, str(error)[:100])
        if len(rows) < with_modes:
            row["frequencies"] = [float(f) for f in cf.modes(cue, 12, at=cf.Resolution(4, 16, 24)).frequencies[:12]]
        rows.append(row)
        print(len(rows), row["end_mass"]["free"], flush=True)
        (DATA / "cues.json").write_text("[\n" + ",\n".join(json.dumps(row) for row in rows) + "\n]\n")


if __name__ == "__main__":
    {"strikes": make_strikes, "cues": make_cues}[sys.argv[1]]()
