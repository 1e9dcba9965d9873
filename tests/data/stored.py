"""Reads the stored results of the former engine (README.md): strikes with their inputs.

A strike is stored with the inputs of its contact: the tip modes, and the terms of a leather tip's law. A test therefore
compares the contact alone, independently of the mesh and of the tip's elasticity.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

import cuefem as cf
from cuefem.beam.tip_modes import TipModes, lumped_tip_modes
from cuefem.contact.strike import strike_modes
from cuefem.effects.force_law import LeatherLaw
from cuefem.effects.leather_tip import LeatherTip
from cuefem.scene import Scene

DATA = Path(__file__).parent
WOOD = cf.Material(E=12.6e9, G=0.84e9, rho=700.0)


@cache
def strikes() -> tuple[dict[str, Any], ...]:
    """The stored strikes, each a row: kind, inputs, answers; without those of a constant tangential stiffness."""
    rows = json.loads((DATA / "strikes.json").read_text())
    return tuple(row for row in rows if row["kind"] != "leather spring")


@cache
def tips() -> dict[str, TipModes]:
    """The stored tip modes by name."""
    with np.load(DATA / "tip_modes.npz") as stored:
        parts = {name: stored[name].astype(float) for name in stored}
    names = {name.split(":")[0] for name in parts}
    return {n: rebuilt({key: parts[f"{n}:{key}"] for key in PARTS if f"{n}:{key}" in parts}) for n in names}


PARTS = ("omega", "amplitude", "approach", "rotation", "damping", "radiation", "geometric")


def rebuilt(parts: dict[str, Any]) -> TipModes:
    """Tip modes from their stored parts; a matrix is stored as its square root, rows^T rows."""
    squares = {name: rows.T @ rows for name in PARTS[4:] if (rows := parts.get(name)) is not None}
    modes = TipModes(
        *(parts[name] for name in PARTS[:4]), radiation=squares.get("radiation"), geometric=squares.get("geometric")
    )
    if "damping" not in squares:
        return modes
    rates = np.diag(squares["damping"])  # of structural damping alone, which couples no modes
    assert np.count_nonzero(squares["damping"] - np.diag(rates)) == 0
    return replace(modes, loss=rates / np.where(modes.omega > 0, modes.omega, 1.0))


def scene_of(row: dict[str, Any]) -> Scene:
    """The scene of a row; its cue has only the mass and the tip diameter of the original."""
    numbers = row["scene"]
    if "lumped" in numbers:
        cue: cf.Cue | cf.LumpedCue = cf.LumpedCue(*numbers["lumped"])
    else:
        diameter, mass = numbers["cue"]
        shaft = cf.Segment(0.7, diameter, diameter, WOOD)
        cue = cf.Cue((shaft,), body_mass=mass - cf.Cue((shaft,), body_mass=1.0).shaft_mass)
    tip = {name: math.inf if value == "inf" else value for name, value in numbers["tip"].items()}
    effects = tuple(getattr(cf, name)(**fields) for name, fields in numbers["effects"].items())
    return Scene(cue, cf.Ball(*numbers["ball"]), cf.Tip(**tip), cf.Stroke(*numbers["stroke"]), effects)


def tip_of(row: dict[str, Any]) -> TipModes:
    """The tip modes of a row."""
    return lumped_tip_modes(cf.LumpedCue(*row["scene"]["lumped"])) if "lumped" in row["scene"] else tips()[row["tip"]]


@contextmanager
def stored_law(row: dict[str, Any]) -> Iterator[None]:
    """Replaces the leather tip's law by the stored one, without 3-D elasticity."""
    if "law" not in row:
        yield
        return
    laws = row["law"]

    def law(tip: LeatherTip, diameter: float, radius: float, offset: float, restitution: float) -> LeatherLaw:
        force, give, most = laws["at offset" if offset else "head on"]
        return LeatherLaw(tuple(force), tuple(give), restitution, most, tip.surface_restitution)

    with mock.patch.object(LeatherTip, "law", law):
        yield


def strike_row(row: dict[str, Any], **resolution: int) -> cf.Outcome:
    """The strike of a row by the package."""
    with stored_law(row):
        return strike_modes(scene_of(row), tip_of(row), **resolution)
