"""Error of the beam model of a shaft against the elastic solid."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from cuefem.beam import weak_forms
from cuefem.beam.modes import Modes, modes
from cuefem.beam.tip_modes import TipModes, free_tip_modes, tip_modes
from cuefem.contact.strike import strike_modes
from cuefem.cue import Cue
from cuefem.effects.effect import CueEffect
from cuefem.endmass.definitions import DEFINITIONS
from cuefem.quantity.display_units import END_MASS, display_unit, displayed_system
from cuefem.results.progress import Progress
from cuefem.results.records import Record, Table, tabulate
from cuefem.scene import Scene, check_scene
from cuefem.scene.solved_scene import mass_on_face
from cuefem.show.analysis import Analysis, Rows
from cuefem.show.scene_summary import effect_name
from cuefem.solid.meridian_mesh import Fineness, blocks, check_mesh_size
from cuefem.solid.shaft import AXIAL, SolidBody

MODES, N_FREQUENCIES = 40, 6  # flexible modes of either model; natural frequencies in the table
ORDER, LARGE_ORDER, LARGE = 6, 4, 150  # a mesh of more than LARGE elements has LARGE_ORDER
# The beam that scikit-fem assembles: its longest element, m, and its order.
MAX_ELEMENT, SCIKIT_FEM_ORDER = 0.03, 6
MIN_PRINTED = 1e-5  # relative difference: smaller ones are printed as below it
# Factors and units of large stiffnesses and of compliances, by the SI unit and whether the number is large.
LARGE_UNITS = {("N/m", True): (1e-6, "kN/mm"), ("m/N", False): (1e3, "mm/N")}


def fineness(cue: Cue) -> Fineness:
    """The finer of the two meshes of a cue; the order of the coarser is lower by 1."""
    mesh = Fineness(ORDER, 0.8, 0.05)
    cells = sum(len(block.ends) - 1 for block in blocks(cue, mesh))
    return mesh if cells <= LARGE else mesh._replace(order=LARGE_ORDER)


def checked_scene(scene: Scene) -> tuple[Scene, list[str]]:
    """The scene without the effects that the solid model does not include, and the names of these effects."""
    excluded = [e for e in scene.effects if isinstance(e, CueEffect) and e.mass_on_face(scene.shaft) is None]
    rest = tuple(effect for effect in scene.effects if effect not in excluded)
    return (replace(scene, effects=rest) if excluded else scene), [type(effect).__name__ for effect in excluded]


@dataclass(frozen=True)
class ModelError(Rows, Analysis):
    """Beam model of a shaft beside a 3-D elastic solid: frequencies, stiffness, end masses and squirt.

    Parameters
    ----------
    scene : Scene
        The analysed stroke.
    rows : list of dict
        For each quantity its name, "quantity", and "unit"; its value in SI by "beam" and by "solid"; "difference", beam
        over solid less 1; and "discretisation_error", the relative change of the solid's value by elements of the next
        lower order.
    scikit_fem : dict
        First natural frequency, Hz, of the "beam", and of the same beam as "scikit_fem" assembles it, and the relative
        "difference".
    modes : int
        Number of bending modes of either model.
    order : int
        Order of the solid's elements.
    excluded_effects : list of str
        Effects that the solid does not include, removed from both models.
    summary : str
        The error of the beam model in squirt, as a sentence.
    """

    rows: list[Record]
    scikit_fem: Record
    modes: int
    order: int
    excluded_effects: list[str]
    summary: str

    def frame_rows(self) -> list[Record]:
        """A row for each quantity."""
        return self.rows

    def tables(self) -> list[Table | str]:
        """Beam and solid side by side, and the summary."""
        return [self.table(), self.summary]

    def table(self) -> Table:
        """Beam and solid side by side."""
        star = " *" if self.excluded_effects else ""
        of_strike = ("end mass", "squirt")
        columns: Any = {
            "": lambda row: row["quantity"] + (star if row["quantity"].startswith(of_strike) else ""),
            "unit": lambda row: _display_unit(row)[1],
            "beam": lambda row: f"{_display_unit(row)[0] * row['beam']:.6g}",
            "solid": lambda row: f"{_display_unit(row)[0] * row['solid']:.6g}",
            "error of the beam": lambda row: _percent(row["difference"], 2, "+"),
            "discretisation error": lambda row: _percent(row["discretisation_error"], 1),
        }
        notes = [
            f"beam and solid with {self.modes} bending modes each, without the truncation correction of `cuefem "
            f"end-mass` and `cuefem strike`; discretisation error: change from elements of order {self.order - 1} to "
            f"{self.order}"
        ]
        if self.excluded_effects:
            without = ", ".join(map(effect_name, self.excluded_effects))
            notes.append(f"* without {without}, which the solid model does not include; `cuefem end-mass` does")
        made = tabulate("Beam and solid models", columns, self.rows, *notes, texts=(0, 1))
        same = self.scikit_fem
        error = _percent(same["difference"], 2, "+")
        row = ("natural frequency 1, same beam by scikit-fem", "Hz", f"{same['beam']:.6g}", "", error, "")
        return replace(made, rows=(*made.rows, row))


def model_error(scene: Scene, *, progress: Progress = iter) -> ModelError:
    """Error of the beam model of a shaft against a 3-D elastic solid: frequencies, stiffness, end mass and squirt.

    The solid is computed with elements of two orders; their difference is the discretisation error. Effects that the
    solid lacks (AxialWaves, GeometricStiffness ...) are removed from both models and listed. Run time: some seconds,
    longer for a shaft of many segments.

    Parameters
    ----------
    scene : Scene
        A stroke with a cue of segments. Effects that the solid lacks are removed from both models.
    progress : callable, optional
        Wraps the list of the computations, to show progress.

    Returns
    -------
    ModelError
        Show it with ``print``, in a notebook, or by ``.save("check.html")``.

    Raises
    ------
    ValueError
        If the cue is lumped, or the mesh of the solid too large.

    Examples
    --------
    >>> import cuefem as cf
    >>> wood = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)
    >>> scene = cf.Scene(cf.Cue((cf.Segment(0.3, 0.02, 0.02, wood),)), stroke=cf.Stroke(offset=0.3))
    >>> first = cf.model_error(scene).rows[0]
    >>> first["quantity"], abs(first["difference"]) < 2e-3
    ('natural frequency 1', True)
    """
    check_scene("model_error scene", scene)
    compared, excluded = checked_scene(scene)
    bending = modes(compared.shaft, MODES, effects=compared.cue_effects)
    mesh = fineness(compared.shaft)
    check_mesh_size(compared.shaft, mesh)
    work = (lambda: _by_beam(compared, bending), lambda: _by_solid(compared, mesh))
    coarser = mesh._replace(order=mesh.order - 1)
    beam, solid, coarse = (compute() for compute in progress([*work, lambda: _by_solid(compared, coarser)]))
    rows = [
        {
            "quantity": name,
            "unit": unit,
            "beam": beam[name, unit],
            "solid": value,
            "difference": beam[name, unit] / value - 1,
            "discretisation_error": abs(coarse[name, unit] / value - 1),
        }
        for (name, unit), value in solid.items()
        if value
    ]
    return ModelError(
        scene,
        rows=rows,
        scikit_fem=_by_scikit_fem(compared, bending),
        modes=MODES,
        order=mesh.order,
        excluded_effects=excluded,
        summary=_summary(rows),
    )


Numbers = dict[tuple[str, str], float]


def _by_scikit_fem(scene: Scene, bending: Modes) -> Record:
    """First natural frequency, Hz, of the beam, and of the same beam assembled by scikit-fem on another mesh."""
    ends, shift = scene.shaft.nodes, bending.system.shift
    pieces = [np.linspace(a, b, int(np.ceil((b - a) / MAX_ELEMENT)), endpoint=False) for a, b in pairwise(ends)]
    nodes = np.concatenate([*pieces, ends[-1:]])
    beam = weak_forms.assemble(scene.shaft, nodes, order=SCIKIT_FEM_ORDER, effects=scene.cue_effects)
    ours, theirs = bending.frequencies[0], weak_forms.frequencies(beam, shift=shift)[bending.rigid]
    return {"beam": float(ours), "scikit_fem": float(theirs), "difference": float(ours / theirs - 1)}


def _by_beam(scene: Scene, bending: Modes) -> Numbers:
    cue = scene.shaft
    tip = tip_modes(bending, scene.axial_mass)
    # a transverse unit force at the tip has the bending moment x and the shear force 1
    x, weights = np.polynomial.legendre.leggauss(40)
    pieces = [(s.section((x + 1) / 2 * s.length), weights * s.length / 2) for s in cue.segments]
    axial = sum(float(w @ (1 / section.EA)) for section, w in pieces)
    transverse = sum(
        float(w @ ((at + (x + 1) / 2 * s.length) ** 2 / section.EI + 1 / section.kGA))
        for (section, w), s, at in zip(pieces, cue.segments, cue.nodes, strict=False)
    )
    return _numbers(scene, tip, transverse, axial)


def _by_solid(scene: Scene, mesh: Fineness) -> Numbers:
    body = SolidBody(scene.shaft, mesh)
    bending = body.modes(MODES + 2, mass=mass_on_face(scene))
    tip = free_tip_modes(bending.omega, *bending.at_tip, scene.axial_mass)
    return _numbers(scene, tip, body.compliance, SolidBody(scene.shaft, mesh, AXIAL).compliance)


def _numbers(scene: Scene, tip: TipModes, transverse: float, axial: float) -> Numbers:
    """The compared quantities by name and unit. transverse, axial: compliance at the tip, m/N, joint end clamped."""
    omega, amplitude = tip.omega[3:], tip.amplitude[3:, 1]
    frequencies = omega[:N_FREQUENCIES] / (2 * np.pi)
    numbers = {(f"natural frequency {k}", "Hz"): float(frequency) for k, frequency in enumerate(frequencies, 1)}
    numbers["transverse stiffness at the tip, joint end clamped", "N/m"] = 1 / transverse
    numbers["axial stiffness at the tip, joint end clamped", "N/m"] = 1 / axial
    numbers["tip compliance, free cue", "m/N"] = float(np.sum((amplitude / omega) ** 2))
    for definition in DEFINITIONS.values():
        with suppress(ValueError):  # a miscue has no squirt-equivalent end mass
            numbers[f"end mass, {definition.label_at(scene.stroke.offset)}", "kg"] = float(definition.of(tip, scene))
    numbers["squirt", "rad"] = float(strike_modes(scene, tip).squirt)
    return numbers


def _display_unit(row: Record) -> tuple[float, str]:
    """The factor from the SI unit, and the unit, that a quantity is displayed in."""
    unit = END_MASS if row["unit"] == "kg" else row["unit"]
    large = LARGE_UNITS.get((unit, abs(row["solid"]) >= 1e5)) if displayed_system() == "metric" else None
    return large or display_unit(unit)[:2]


def _percent(part: float, digits: int, sign: str = "-") -> str:
    """A relative difference in per cent, to so many significant digits, without exponent."""
    if abs(part) < MIN_PRINTED:
        return f"< {100 * MIN_PRINTED:g} %"
    text = f"{100 * part:{sign}.{digits}g}" if abs(part) < 0.1 else f"{100 * part:{sign}.0f}"
    return f"{text} %".replace("-", "−")


def _summary(rows: Sequence[Record]) -> str:
    """The error of the beam model in squirt, as a sentence."""
    row = next((row for row in rows if row["quantity"] == "squirt"), None) or rows[-1]
    difference, mesh = abs(row["difference"]), row["discretisation_error"]
    size = _percent(max(difference, mesh), 1)
    error = f"less than {size}" if difference < mesh else size
    return (
        f"Error of the beam model for this shaft: {error} in {row['quantity']} (a part of the numerical error only; "
        "total uncertainty: cuefem report)."
    )
