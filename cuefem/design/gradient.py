"""Gradients of end mass and small-offset squirt to every number of a cue's drawing.

Chain rule: the densities of `cuefem.design.sensitivity` times the derivatives of the section properties, which come
from a complex step through the one formula of `cuefem.cue`. A longer segment stretches its own piece of the shaft.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from cuefem.beam.basis import table
from cuefem.cue import Array, Cue, Section, SegmentRows, section_properties
from cuefem.design.sensitivity import Sensitivity, sensitivity
from cuefem.endmass.undamped import StickLimit
from cuefem.scene import Resolution, Scene

STEP = 1e-30  # of a complex step, relative to the number: exact to rounding


@dataclass(frozen=True)
class Gradient:
    """End mass, kg, small-offset squirt over phi, and their derivatives to the numbers of the drawing.

    end_mass_to, squirt_to: `SegmentRows` of arrays (segments,), per SI unit of each number: E and G at fixed Poisson
    ratio, nu the effective one at fixed E and G; kappa nan if it follows from the section. The body's mass stays.
    Squirt is None for a drive other than "stick".
    """

    end_mass: float
    squirt: float | None
    end_mass_to: SegmentRows
    squirt_to: SegmentRows | None


def gradient(scene: Scene, drive: str = "stick", at: Resolution | None = None) -> Gradient:
    """Derivatives of a bare cue's end mass, and of its small-offset squirt, to every number of its drawing.

    Parameters
    ----------
    scene : Scene
        With a finite-element cue and without effects. The contact time is held, also if the tip's stiffness gives it.
    drive : str
        The definition of the end mass: "stick", "velocity" or "force". Only "stick" has a squirt.
    at : Resolution, optional
        The default is that of `sensitivity`.

    Returns
    -------
    Gradient
        Exact for the modes kept, on the mesh as it is.

    Raises
    ------
    ValueError
        If the cue is lumped, the drive is another one, or the scene has effects.

    Notes
    -----
    The cost is one dense eigenproblem, for however many numbers.
    """
    densities, rows = sensitivity(scene, drive, at), drawing(scene.shaft)
    heavier = masses_to(rows)
    own = densities_to(densities, rows)
    end_mass_to = SegmentRows(*(d + densities.axial_mass * m for d, m in zip(own, heavier, strict=True)))
    if drive != "stick":
        return Gradient(densities.end_mass, None, end_mass_to, None)
    squirt, to_m, to_axial = _squirt(scene, densities.end_mass)
    squirt_to = SegmentRows(*(to_m * d + to_axial * m for d, m in zip(end_mass_to, heavier, strict=True)))
    return Gradient(densities.end_mass, squirt, end_mass_to, squirt_to)


def _squirt(scene: Scene, end_mass: float) -> tuple[float, float, float]:
    """(squirt b -> 0 over phi, its derivatives to the end mass and to the axial mass, 1/kg)."""

    def squirt(m: complex, axial_mass: complex) -> complex:
        limit = StickLimit.of(scene, axial_mass)
        return complex(limit.slope((limit.K - 1) / (1 / m + limit.c)))

    m, a = end_mass, scene.axial_mass
    return squirt(m, a).real, squirt(m + 1j * STEP, a).imag / STEP, squirt(m, a + 1j * STEP).imag / STEP


def drawing(cue: Cue) -> SegmentRows:
    """The numbers of a cue's segments, arrays (segments,)."""
    return SegmentRows(*np.array([segment.constants for segment in cue.segments]).T)


def with_poisson_ratios(rows: SegmentRows, moves: SegmentRows) -> SegmentRows:
    """Moves of a drawing's numbers, with those of the effective Poisson ratios, which E and G carry along."""
    for kind in ("", "core_"):  # nu_e/(1 + nu_e) = 2 nu G/E, so d nu_e = nu_e (1 + nu_e) (dG/G - dE/E)
        E, G, nu = (getattr(rows, f"{kind}{name}") for name in ("E", "G", "nu"))
        dE, dG, own = (getattr(moves, f"{kind}{name}") for name in ("E", "G", "nu"))
        with np.errstate(divide="ignore", invalid="ignore"):
            carried = np.where(E > 0, nu * (1 + nu) * (dG / G - dE / E), 0.0)
        moves = moves._replace(**{f"{kind}nu": own + carried})
    return moves


def derivatives(rows: SegmentRows, of: Callable[[SegmentRows], Array]) -> SegmentRows:
    """Derivatives of each segment's share of a number, (segments,), to the segment's own numbers."""
    slopes, still = [], SegmentRows(*np.zeros((len(rows), len(rows.length))))
    for name, row in zip(rows._fields, rows, strict=True):
        steps = STEP * np.maximum(np.abs(np.nan_to_num(row)), 1e-3)
        moves = with_poisson_ratios(rows, still._replace(**{name: steps}))
        moved = SegmentRows(*(number + 1j * move for number, move in zip(rows, moves, strict=True)))
        slopes.append(np.where(np.isnan(row), np.nan, np.imag(of(moved)) / steps))
    return SegmentRows(*slopes)


def masses_to(rows: SegmentRows) -> SegmentRows:
    """Derivatives of the cue's mass to the numbers of the drawing, kg per SI unit, arrays (segments,)."""
    t = table(4)

    def mass(moved: SegmentRows) -> Array:
        columns = SegmentRows(*(row[:, None] for row in moved))
        section = section_properties(columns, columns.length * t.points)
        return np.asarray(moved.length * (section.rhoA * t.weights).sum(axis=1))

    return derivatives(rows, mass)


def densities_to(densities: Sensitivity, rows: SegmentRows) -> SegmentRows:
    """Derivatives to the numbers of the drawing of the number whose densities these are; the axial mass stays.

    Sections depend on s/length alone, so a longer segment keeps them and stretches the fields: dx grows, the slopes w'
    and theta' shrink, theta stays.
    """
    ends = np.cumsum(rows.length)
    piece = np.searchsorted(ends[:-1], densities.x)
    t = (densities.x - (ends - rows.length)[piece]) / rows.length[piece]

    def sections(moved: SegmentRows) -> Section:
        each = SegmentRows(*(row[piece] for row in moved))
        return section_properties(each, each.length * t)

    def gathered(values: Any) -> Array:
        values = densities.weights * values
        return np.asarray(np.bincount(piece, values.real) + 1j * np.bincount(piece, values.imag))

    def change(moved: SegmentRows) -> Array:
        section = sections(moved)
        return gathered(
            sum(getattr(section, name) * getattr(densities, name) for name in ("rhoA", "rhoI", "EI", "kGA"))
        )

    s = sections(rows)
    stretch = (
        s.rhoA * densities.rhoA
        + s.rhoI * densities.rhoI
        - s.EI * densities.EI
        + s.kGA * (densities.kGA - 2 * densities.shear_slope)
    )
    return derivatives(rows, change)._replace(length=np.real(gathered(stretch + 0j)) / rows.length)
