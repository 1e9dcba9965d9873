"""What do the public calls cost, compared with the bare linear algebra that they use?

What: on [Kim]'s shaft (meshes/kim.toml; T = 1 ms, b/R 0.3, e = 3/4, mu = 0.7) warm calls of `modes`, `end_mass`,
`strike` and `resolve`; on meshes/pool_maple.toml the usual pool stroke (`LeatherTip`, waves, thrust) and the same with
`LeatherTip` alone, single and in a batch of strikes of the one cue; and whole processes of the command. Beside them two
calls of LAPACK's size: `scipy.linalg.eigh` of the matrices that `modes` assembles for five modes, and
`scipy.linalg.expm` of a 50 x 50 matrix of norm 1. And the beam's matrices at the default mesh of a strike, by cuefem's
tabulated basis and as scikit-fem assembles the same weak forms: what the basis is kept for. All take turns in one
process with one BLAS thread, so that a busy machine slows all alike; medians of processor time and their ratios. Writes
speed_seconds.md beside itself, of the machine named there; takes under a minute.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from statistics import median
from time import perf_counter, process_time
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
from skfem import Basis, BilinearForm, ElementLinePp, MeshLine

from cuefem import Cue, LeatherTip, Resolution, Stroke, batch_strike, end_mass, modes, resolve, strike, usual_scene
from cuefem.beam.system import assemble
from cuefem.beam.waves import ended_mesh_for, mesh_for
from cuefem.tip_modes import default_modes, tip_modes_of
from studies import pages, strokes
from studies.strokes import strike_modes

COMMANDS = ("--help", "end-mass studies/scenes/kim.toml")
ROUNDS, STARTS = 20, 5
STRIKE = "strike, default resolution"
TABULATED, FORMS = "the beam's matrices at a strike's mesh, by cuefem", "the same as scikit-fem assembles them"
BATCH = 20  # strikes of a batch, at so many offsets


@BilinearForm
def bending(theta: Any, phi: Any, at: Any) -> Any:
    """EI theta' phi'."""
    return at.EI * theta.grad[0] * phi.grad[0]


@BilinearForm
def sheared(w: Any, v: Any, at: Any) -> Any:
    """kappa G A w' v'."""
    return at.kGA * w.grad[0] * v.grad[0]


@BilinearForm
def crossed(w: Any, phi: Any, at: Any) -> Any:
    """-kappa G A w' phi."""
    return -at.kGA * w.grad[0] * phi


@BilinearForm
def weighed(u: Any, v: Any, at: Any) -> Any:
    """The product of two fields, times a property of the section."""
    return at.of * u * v


def by_scikit_fem(cue: Cue, nodes: np.ndarray, order: int) -> tuple[sp.csr_matrix, sp.csr_matrix]:
    """K and M of the Timoshenko beam as scikit-fem assembles its weak forms: deflection of a degree more than the
    rotation, on elements between these nodes, m."""
    across = Basis(MeshLine(nodes), ElementLinePp(order + 1), intorder=2 * order + 6)  # a taper's EI has degree 4
    turning = across.with_element(ElementLinePp(order))
    section = cue.section(np.asarray(across.global_coordinates())[0])
    K = [
        [sheared.assemble(across, kGA=section.kGA), crossed.assemble(across, turning, kGA=section.kGA).T],
        [
            crossed.assemble(across, turning, kGA=section.kGA),
            bending.assemble(turning, EI=section.EI) + weighed.assemble(turning, of=section.kGA),
        ],
    ]
    M = [weighed.assemble(across, of=section.rhoA), weighed.assemble(turning, of=section.rhoI)]
    return sp.bmat(K, format="csr"), sp.block_diag(M, format="csr")


def calls() -> dict[str, tuple[Callable[[], Any], int]]:
    """What is called, by name, and how often a round."""
    kim = strokes.cue("kim")
    scene = strokes.scene(kim, offset=0.3)
    longer = strokes.scene(kim, contact_time=2e-3)
    elements, order = mesh_for(kim, 5)
    system = assemble(kim, elements=elements, order=order)
    shifted = system.K + system.shift * system.M
    found: dict[str, tuple[Callable[[], Any], int]] = {
        "scipy.linalg.expm, 50 x 50": (pages.expm_50(), 20),
        f"scipy.linalg.eigh, {len(shifted)} x {len(shifted)}": (lambda: la.eigh(system.M, shifted), 10),
        "modes(kim, 5)": (lambda: modes(kim, 5), 10),
        **{
            f"end_mass, {drive}, 2 ms": (lambda drive=drive: end_mass(longer, drive), 1)
            for drive in ("stick", "offset", "velocity", "force")
        },
    }
    struck_at = default_modes(scene)
    pieces, orders = ended_mesh_for(kim, struck_at)
    fine = assemble(kim, elements=pieces, order=orders)
    found[TABULATED] = (
        lambda: assemble(kim, elements=pieces, order=orders, count=struck_at),
        5,
    )
    found[FORMS] = (lambda: by_scikit_fem(kim, fine.mesh.nodes, fine.mesh.order), 1)
    for count in (24, 50, 100, 200):
        tip = tip_modes_of(scene, Resolution(4 + count // 20, 24, count))
        found[f"contact of {count} modes"] = (lambda tip=tip: strike_modes(scene, tip), max(1, 100 // count))
    found[STRIKE] = (lambda: strike(scene), 1)
    whole = replace(usual_scene(strokes.cue("pool_maple")), stroke=Stroke(2.0, 0.375))
    leather = replace(whole, effects=tuple(effect for effect in whole.effects if isinstance(effect, LeatherTip)))
    assert len(whole.effects) > len(leather.effects) > 0
    found["strike with LeatherTip, default resolution"] = (lambda: strike(leather), 1)
    found["strike of the whole usual stroke, default resolution"] = (lambda: strike(whole), 1)
    offsets = np.linspace(0.02, 0.5, BATCH)
    for name, each in (("Kim's shaft", scene), ("LeatherTip", leather), ("whole usual stroke", whole)):
        scenes = [replace(each, stroke=Stroke(2.0, float(b))) for b in offsets]
        found[f"batch_strike of {BATCH}, {name}, a strike"] = (lambda scenes=scenes: batch_strike(scenes), 1)
    for rtol in (1e-3, 1e-4):
        found[f"resolve to {rtol:.0e}"] = (lambda rtol=rtol: resolve(scene, rtol), 1)
    return found


def medians(rounds: int) -> dict[str, float]:
    """Median processor seconds of every call; they take turns."""
    jobs = calls()
    times: dict[str, list[float]] = {name: [] for name in jobs}
    for turn in range(rounds + 1):  # the first warms up
        for name, (work, repeats) in jobs.items():
            for _ in range(repeats if turn else 1):
                start = process_time()
                work()
                if turn:
                    times[name].append(process_time() - start)
    return {name: median(each) / (BATCH if "a strike" in name else 1) for name, each in times.items()}


def starts(repeats: int) -> dict[str, float]:
    """Median seconds of whole processes of the command."""
    times: dict[str, list[float]] = {command: [] for command in COMMANDS}
    for _ in range(repeats):
        for command, each in times.items():
            start = perf_counter()
            program = [sys.executable, "-c", "from cuefem.cli import main; main()", *command.split()]
            subprocess.run(program, cwd=pages.STUDIES.parent, check=True, capture_output=True)
            each.append(perf_counter() - start)
    return {f"cuefem {command}": median(each) for command, each in times.items()}


def report(rounds: int = ROUNDS, repeats: int = STARTS) -> str:
    """The table of this machine."""
    found = medians(rounds)
    expm, eigh = list(found.values())[:2]
    lines = [
        "# Seconds of the public calls",
        "",
        pages.machine(),
        "Processor time of warm calls that take turns: medians, milliseconds, and their ratios to the two bare calls.",
        "",
        "| call | ms | of one expm | of one eigh |",
        "|---|---|---|---|",
        *(f"| {name} | {1e3 * t:.2f} | {t / expm:.1f} | {t / eigh:.1f} |" for name, t in found.items()),
        "",
        f"To assemble the beam's matrices scikit-fem takes {found[FORMS] / found[STRIKE]:.0f} times as long as a whole",
        f"strike, and {found[FORMS] / found[TABULATED]:.0f} times as long as cuefem's tabulated basis, which is kept",
        "while that is more than a quarter of a strike.",
        "",
        "| whole process | s |",
        "|---|---|",
        *(f"| `{name}` | {t:.2f} |" for name, t in starts(repeats).items()),
    ]
    return "\n".join(lines) + "\n"


STUDY = pages.Study(__file__, seconds=report)


if __name__ == "__main__":
    STUDY.write()
