"""What studies share: the cues of meshes/, the scene they are struck in, tables and figures. Not a study itself.

Tables are read back and compared by `cuefem.validation.disagreements`.
"""

from __future__ import annotations

import os
import platform
from collections.abc import Iterable, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from cuefem import Cue, LumpedCue, Scene, Stroke, Tip, load
from cuefem.contact.impulse_space import impact
from cuefem.validation import number

STUDIES = Path(__file__).parent
MESHES = STUDIES.parent / "meshes"
NAMES = ("kim", "pool_maple", "pool_hollow", "carbon", "whole_cue")
STYLE = {"svg.hashsalt": "cuefem", "svg.fonttype": "path", "font.size": 10, "axes.grid": True, "grid.alpha": 0.3}


def processor() -> str:
    """The machine that seconds are of: its processor and number of cores."""
    path = Path("/proc/cpuinfo")
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    model = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.machine())
    return f"{model}, {os.cpu_count()} cores"


@cache
def cue(name: str) -> Cue:
    """A cue of meshes/."""
    found = load(MESHES / f"{name}.toml")
    assert isinstance(found, Cue)
    return found


# What pages say that strike before the ball of `scene`.
CAROM = (
    "Struck before a carom ball of 210 g, as Kim's shaft is; the commands take a pool ball of 170 g where a file names "
    "none."
)


def scene(struck: Cue | LumpedCue, contact_time: float = 1e-3, offset: float = 0.0) -> Scene:
    """The cue before the default ball (210 g), e = 3/4, mu = 0.7."""
    return Scene(struck, tip=Tip(contact_time=contact_time), stroke=Stroke(offset=offset))


def at_offset(struck: Scene, offset: float) -> Scene:
    """The scene struck at another offset."""
    return replace(struck, stroke=replace(struck.stroke, offset=offset))


def lumped_squirt(struck: Scene, end_mass: float) -> float:
    """Squirt of the impulse solver with this end mass at the scene's offset, rad."""
    return float(impact(replace(struck, cue=LumpedCue(struck.axial_mass, end_mass), effects=())).squirt)


def slope(x: Iterable[float], y: Iterable[float]) -> float:
    """Exponent of the power law through points, least squares in the logarithms."""
    return float(np.polyfit(np.log(list(x)), np.log(list(y)), 1)[0])


def crests(errors: Sequence[float], size: int) -> np.ndarray:
    """Largest size of an error in each run of ``size`` samples: the envelope of errors that ring."""
    return np.max(np.abs(np.reshape(errors, (-1, size))), axis=1)


def table(columns: Sequence[str], rows: Iterable[Sequence[Any]], digits: int = 4) -> str:
    """A markdown table; text stands as it is, numbers with ``digits`` significant digits."""

    def line(cells: Sequence[Any]) -> str:
        return "| " + " | ".join(c if isinstance(c, str) else number(c, digits) for c in cells) + " |"

    return "\n".join([line(columns), "|" + "---|" * len(columns), *map(line, rows)]) + "\n"


def predictions(predicted: Mapping[str, str], *more: tuple[str, Mapping[str, str]]) -> str:
    """Numbers by name: what was predicted, and (column, its values) of what was found and measured."""
    rows = [[name, said, *(values.get(name, "") for _, values in more)] for name, said in predicted.items()]
    return table(["number", "predicted", *(column for column, _ in more)], rows)


@contextmanager
def figure(path: Path, panels: tuple[int, int] = (1, 1), size: tuple[float, float] = (6.4, 4.4)) -> Any:
    """Axes to draw on; the figure is saved without a date when the block ends."""
    with plt.rc_context(STYLE):
        canvas, axes = plt.subplots(*panels, figsize=size, layout="constrained")
        yield axes
        canvas.savefig(path, metadata={"Date": None})
        plt.close(canvas)
