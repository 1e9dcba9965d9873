"""CalculiX: the cone as a solid of 20-node bricks, half of it (bending in the plane of symmetry).

A solid is another model: it has the beam's frequencies only as far as Timoshenko's assumptions hold. What can be
matched is matched: Poisson's ratios are 0, where Timoshenko's coefficient of a circle is 6/7, and the shear moduli
along the grain carry the rest of the cone's kappa G. A run is a process of its own, its start and files included.
"""

from __future__ import annotations

import shutil
import subprocess
from functools import partial
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from studies.accuracy.peers.cone import CONE, MODES

if shutil.which("ccx") is None:
    raise ModuleNotFoundError("No program named 'ccx'")
VERSION = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout.split()[-1]
RIGID = 3  # in the plane of symmetry

# corners and mid-edges of a 20-node brick in CalculiX's order, in half steps
BRICK = np.array(
    [
        *((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2), (1, 0, 0), (2, 1, 0)),
        *((1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)),
    ]
)


def deck(across: int, along: int) -> str:
    """The input: ``across`` x ``across``/2 bricks in the half disc, ``along`` in length."""
    half = np.array([2 * across, across, 2 * along])  # the grid in half steps
    origins = np.array(list(product(*(range(0, count, 2) for count in half))))
    grid = origins[:, None, :] + BRICK
    used, brick_nodes = np.unique(grid.reshape(-1, 3), axis=0, return_inverse=True)
    u, v, z = (used * [1 / across, 1 / across, CONE.length / half[2]] - [1, 0, 0]).T
    # the square onto the disc
    r = CONE.radius(z)
    x, y = r * u * np.sqrt(1 - v**2 / 2), r * v * np.sqrt(1 - u**2 / 2)
    nodes = "\n".join(f"{i},{a:.12e},{b:.12e},{c:.12e}" for i, (a, b, c) in enumerate(zip(x, y, z, strict=True), 1))
    rows = brick_nodes.reshape(-1, 20) + 1
    bricks = "\n".join(
        f"{i},{','.join(map(str, row[:10]))},\n{','.join(map(str, row[10:]))}" for i, row in enumerate(rows, 1)
    )
    plane = ",\n".join(str(i + 1) for i in np.flatnonzero(used[:, 1] == 0))
    shear = CONE.kappa * CONE.G / (6 / 7)
    E = CONE.E
    return f"""*NODE, NSET=ALL
{nodes}
*ELEMENT, TYPE=C3D20R, ELSET=CONE
{bricks}
*NSET, NSET=PLANE
{plane}
*MATERIAL, NAME=WOOD
*ELASTIC, TYPE=ENGINEERING CONSTANTS
{E},{E},{E},0.,0.,0.,{E / 2},{shear},
{shear}
*DENSITY
{CONE.rho}
*SOLID SECTION, ELSET=CONE, MATERIAL=WOOD
*BOUNDARY
PLANE,2,2
*STEP
*FREQUENCY
{RIGID + MODES}
*END STEP
"""


def modes(across: int, along: int) -> np.ndarray:
    """f1 to f5, Hz."""
    with TemporaryDirectory() as folder:
        Path(folder, "cone.inp").write_text(deck(across, along), encoding="utf-8")
        run = subprocess.run(["ccx", "cone"], cwd=folder, capture_output=True, text=True, check=False)
        if run.returncode:
            raise ArithmeticError(f"ccx: {run.stdout[-300:]}")
        lines = Path(folder, "cone.dat").read_text(encoding="utf-8").splitlines()
    rows = [line.split() for line in lines[: next(i for i, s in enumerate(lines) if "P A R T I C" in s)]]
    return np.array([float(row[3]) for row in rows if len(row) == 5 and row[0].isdigit()][RIGID:])


CONTESTANTS = {
    "modes": {f"CalculiX, solid, {n} x {n // 2} x {m}": partial(modes, n, m) for n, m in ((2, 20), (4, 40), (6, 40))},
    "end_mass": {},
}
