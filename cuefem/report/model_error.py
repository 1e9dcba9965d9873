"""Beam theory beside the solid, for one's own shaft: record and sheet of `cuefem check`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from cuefem.beam import weak_forms
from cuefem.beam.modes import Modes, modes
from cuefem.beam.tip import TipModes, free_tip_modes, tip_modes
from cuefem.contact.strike import strike_modes
from cuefem.cue import Cue
from cuefem.effects.base import CueEffect
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.results.quantities import TRADE, scaled
from cuefem.results.records import Record, Sheet, sheet
from cuefem.scene import Scene
from cuefem.scene.solved_scene import mass_on_face
from cuefem.solid.meridian_mesh import Fineness, blocks, check_size
from cuefem.solid.shaft import AXIAL, Body

# Flexible modes on both sides; tones that are told.
MODES, TONES = 40, 6
ORDER, LARGE_ORDER, LARGE = 6, 4, 150  # a drawing of more elements than LARGE is computed with LARGE_ORDER
# The beam that scikit-fem assembles: the longest element, m, its order, and the smallest difference that is printed.
LONGEST, ORDER_OF_BOTH, SAME = 0.03, 6, 1e-9
Follow = Callable[[Sequence[Any]], Iterable[Any]]


def fineness(cue: Cue) -> Fineness:
    """The finer of the two meshes on which a cue is checked; the coarser has an order less."""
    mesh = Fineness(ORDER, 0.8, 0.05)
    cells = sum(len(block.along) - 1 for block in blocks(cue, mesh))
    return mesh if cells <= LARGE else mesh._replace(order=LARGE_ORDER)


def checked_scene(scene: Scene) -> tuple[Scene, list[str]]:
    """The scene with the effects that a solid can have alone, and the names of those that are left out."""
    out = [e for e in scene.effects if isinstance(e, CueEffect) and e.mass_on_face(scene.shaft) is None]
    rest = tuple(effect for effect in scene.effects if effect not in out)
    return (replace(scene, effects=rest) if out else scene), [type(effect).__name__ for effect in out]


def model_error_record(scene: Scene, follow: Follow = iter) -> Record:
    """Frequencies, stiffness, end masses and squirt by beam and solid, with the discretisation error.

    "left_out": effects that no solid can have, left out on both sides. "scikit_fem": tone 1 of the beam whose weak
    forms scikit-fem assembles. follow: shows how far the work is.
    """
    scene, left_out = checked_scene(scene)
    bending = modes(scene.shaft, MODES, effects=scene.cue_effects)
    mesh = fineness(scene.shaft)
    check_size(scene.shaft, mesh)
    work = (lambda: _by_beam(scene, bending), lambda: _by_solid(scene, mesh))
    coarser = mesh._replace(order=mesh.order - 1)
    beam, solid, coarse = (work_of() for work_of in follow([*work, lambda: _by_solid(scene, coarser)]))
    rows = [
        {
            "quantity": words,
            "unit": unit,
            "beam": beam[words, unit],
            "solid": value,
            "difference": beam[words, unit] / value - 1,
            "mesh_error": abs(coarse[words, unit] / value - 1),
        }
        for (words, unit), value in solid.items()
        if value
    ]
    return {
        "rows": rows,
        "scikit_fem": _by_scikit_fem(scene, bending),
        "modes": MODES,
        "order": mesh.order,
        "left_out": left_out,
        "sentence": _sentence(rows),
    }


Numbers = dict[tuple[str, str], float]


def _by_scikit_fem(scene: Scene, bending: Modes) -> Record:
    """Tone 1 of the beam and of the same beam as scikit-fem assembles it, on a mesh of its own."""
    ends, shift = scene.shaft.nodes, bending.system.shift
    pieces = [np.linspace(a, b, int(np.ceil((b - a) / LONGEST)) + 1)[:-1] for a, b in pairwise(ends)]
    nodes = np.concatenate([*pieces, ends[-1:]])
    K, M = weak_forms.assemble(scene.shaft, nodes, order=ORDER_OF_BOTH, effects=scene.cue_effects)
    ours, theirs = bending.frequencies[0], weak_forms.frequencies(K, M, shift=shift)[bending.rigid]
    return {"beam": float(ours), "scikit_fem": float(theirs), "difference": float(ours / theirs - 1)}


def _by_beam(scene: Scene, bending: Modes) -> Numbers:
    cue = scene.shaft
    tip = tip_modes(bending, scene.axial_mass)
    # one newton across the tip bends the cue by its distance from there, and shears it all along
    x, weights = np.polynomial.legendre.leggauss(40)
    pieces = [(s.section((x + 1) / 2 * s.length), weights * s.length / 2) for s in cue.segments]
    along = sum(float(w @ (1 / section.EA)) for section, w in pieces)
    across = sum(
        float(w @ ((at + (x + 1) / 2 * s.length) ** 2 / section.EI + 1 / section.kGA))
        for (section, w), s, at in zip(pieces, cue.segments, cue.nodes, strict=False)
    )
    return _numbers(scene, tip, across, along)


def _by_solid(scene: Scene, mesh: Fineness) -> Numbers:
    body = Body(scene.shaft, mesh)
    bending = body.modes(MODES + 2, mass=mass_on_face(scene))
    tip = free_tip_modes(bending.omega, *bending.at_tip, scene.axial_mass)
    return _numbers(scene, tip, body.give, Body(scene.shaft, mesh, AXIAL).give)


def _numbers(scene: Scene, tip: TipModes, across: float, along: float) -> Numbers:
    """What is compared, by its words and its unit, from a cue's tip modes and its gives with the butt held, m/N."""
    omega, amplitude = tip.omega[3:], tip.amplitude[3:, 1]
    numbers = {(f"natural frequency {k}", "Hz"): float(w) / (2 * np.pi) for k, w in enumerate(omega[:TONES], 1)}
    numbers["transverse stiffness at the tip, butt clamped", "N/m"] = 1 / across
    numbers["axial stiffness at the tip, butt clamped", "N/m"] = 1 / along
    numbers["tip compliance, free cue", "m/N"] = float(np.sum((amplitude / omega) ** 2))
    for definition in DEFINITIONS.values():
        with suppress(ValueError):  # a miscue has no squirt-equivalent end mass
            numbers[f"end mass, {definition.label_at(scene.stroke.offset)}", "kg"] = float(definition.of(tip, scene))
    numbers["squirt", "rad"] = float(strike_modes(scene, tip).squirt)
    return numbers


def _percent(part: float, digits: int, sign: str = "-") -> str:
    """A part in per cent, so many digits of it; never as a power of ten where it is large."""
    return f"{100 * part:{sign}.{digits}g} %" if abs(part) < 0.1 else f"{100 * part:{sign}.0f} %"


def _sentence(rows: Sequence[Record]) -> str:
    """How far beam theory is off, in a sentence."""
    row = next((row for row in rows if row["quantity"] == "squirt"), None) or rows[-1]
    off, own = abs(row["difference"]), row["mesh_error"]
    size = _percent(max(off, own), 2 if own < 0.05 * off else 1)
    words = f"less than {size}" if off < own else size
    return f"Error of the beam model for this shaft: {words} in {row['quantity']}."


def model_error_sheet(record: Record) -> Sheet:
    """Beam and solid side by side."""
    without = " *" if record["left_out"] else ""
    of_strike = ("end mass", "squirt")
    columns: Any = {
        "": lambda row: row["quantity"] + (without if row["quantity"].startswith(of_strike) else ""),
        "unit": lambda row: TRADE.get(row["unit"], (1.0, row["unit"]))[1],
        "beam": lambda row: f"{scaled(row['beam'], row['unit']):.6g}",
        "solid": lambda row: f"{scaled(row['solid'], row['unit']):.6g}",
        "error of the beam": lambda row: _percent(row["difference"], 2, "+"),
        "discretisation error": lambda row: _percent(row["mesh_error"], 1),
    }
    notes = [
        f"both from {record['modes']} bending modes without a truncation correction, which `cuefem end-mass` and "
        f"`cuefem strike` have; discretisation error: change from elements of order {record['order'] - 1} to "
        f"{record['order']}"
    ]
    if record["left_out"]:
        notes.append(
            f"* without {', '.join(record['left_out'])}, which the solid model does not include; `cuefem end-mass` does"
        )
    found = sheet("Beam and solid models", columns, record["rows"], *notes, texts=(0, 1))
    same = record["scikit_fem"]
    off = "< 1e-07 %" if abs(same["difference"]) < SAME else _percent(same["difference"], 2, "+")
    row = ("natural frequency 1, same beam by scikit-fem", "Hz", f"{same['beam']:.6g}", "", off, "")
    return replace(found, rows=(*found.rows, row))
