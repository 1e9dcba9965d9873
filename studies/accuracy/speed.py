"""What do the public calls cost, and what does the same answer cost with other programs?

Processor time of warm calls that take turns, one thread, medians. A peer starts from the cone's numbers and ends at the
answer: mesh, assembly, solution; imports are not timed. Modes: f3 to f5 of Kim's shaft. End masses: force, of Kim's
shaft at 12 contact times, 0.5 to 3 ms, Newmark steps (average acceleration) where a peer has no modes. Errors are
relative to cuefem with more elements and modes. Times are in units of scipy.linalg.expm of a 50 x 50 matrix in the same
run. Run it with OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from statistics import median
from time import process_time
from typing import Any

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from skfem import Basis, BilinearForm, ElementLineP2, MeshLine

import cuefem as cf
from studies import pages, strokes
from studies.pages import table

CUE, ROUNDS = strokes.cue("kim"), 9
CONE, WOOD = CUE.segments[0], CUE.segments[0].material
L, KAPPA, TIMES = CONE.length, float(CONE.kappa or 0.9), np.linspace(0.5e-3, 3e-3, 12)
MIDDLE = CUE.section(L / 2)
EXPM = "scipy.linalg.expm, 50 x 50"
SHIFT = float(500 * MIDDLE.EI / MIDDLE.rhoA / L**4)  # rad2/s2: K + SHIFT M has no rigid motion


def area(x: Any) -> Any:
    """Area of the cone, m2, x from the tip."""
    return np.pi / 4 * (CONE.tip_diameter + (CONE.butt_diameter - CONE.tip_diameter) * x / L) ** 2


def inertia(x: Any) -> Any:
    """Second moment of the cone, m4."""
    return area(x) ** 2 / (4 * np.pi)


def lowest(K: Any, M: Any) -> np.ndarray:
    """f1 to f5, Hz, of a free beam's matrices, with their shapes."""
    if K.shape[0] < 200:
        squares = 1 / la.eigh(M.toarray(), (K + SHIFT * M).toarray())[0][::-1][2:7] - SHIFT
    else:
        squares = np.sort(sla.eigsh(K, 7, M, sigma=-SHIFT, v0=np.ones(K.shape[0]))[0])[2:]
    return np.sqrt(squares) / (2 * np.pi)


def newmark(K: Any, M: Any, tip: int, steps: int, T: float) -> float:
    """Force end mass, kg: impulse of a half sine at an unknown over its velocity at the end; one factorisation."""
    dt = T / steps
    solve = sla.splu(sp.csc_matrix(M + dt**2 / 4 * K)).solve
    u, v, a, force = (np.zeros(K.shape[0]) for _ in range(4))
    for step in range(1, steps + 1):
        force[tip] = np.sin(np.pi * step / steps)
        ahead = u + dt * v + dt**2 / 4 * a
        new = solve(force - K @ ahead)
        u, v, a = ahead + dt**2 / 4 * new, v + dt / 2 * (a + new), new
    return float(2 * T / np.pi / v[tip])


@BilinearForm
def stiff(w: Any, turn: Any, v: Any, other: Any, x: Any) -> Any:
    """Bending and shear."""
    shear = KAPPA * WOOD.G * area(x.x[0]) * (w.grad[0] - turn) * (v.grad[0] - other)
    return WOOD.E * inertia(x.x[0]) * turn.grad[0] * other.grad[0] + shear


@BilinearForm
def heavy(w: Any, turn: Any, v: Any, other: Any, x: Any) -> Any:
    """Inertia across and of rotation."""
    return WOOD.rho * (area(x.x[0]) * w * v + inertia(x.x[0]) * turn * other)


def by_scikit_fem(elements: int) -> tuple[Any, Any, int]:
    """K, M and the unknown of the tip's deflection, quadratic elements."""
    line = ElementLineP2()
    basis = Basis(MeshLine(np.linspace(0, L, elements + 1)), line * line, intorder=8)
    tip = basis.get_dofs(lambda x: x[0] == 0).nodal["u^1"][0]
    return stiff.assemble(basis), heavy.assemble(basis), int(tip)


def scene(T: float) -> cf.Scene:
    """Kim's shaft, a little longer from call to call, so that nothing is kept of it."""
    scene.calls += 1  # type: ignore[attr-defined]
    longer = replace(CONE, length=L * (1 + 1e-13 * scene.calls))  # type: ignore[attr-defined]
    return strokes.scene(replace(CUE, segments=(longer,)), T, 0.3)


scene.calls = 0  # type: ignore[attr-defined]


def contestants() -> dict[str, dict[str, Callable[[float], Any]]]:
    """Calls by task and name; they take a contact time, which modes do not need."""
    modes: dict[str, Callable[[float], Any]] = {"cuefem": lambda T: cf.modes(scene(T).shaft, 5).frequencies}
    masses: dict[str, Callable[[float], Any]] = {"cuefem": lambda T: cf.end_mass(scene(T), "force")}
    modes["scikit-fem P2 x 150"] = lambda T: lowest(*by_scikit_fem(150)[:2])
    masses["scikit-fem P2 x 80, 800 steps"] = lambda T: newmark(*by_scikit_fem(80), 800, T)
    return {"modes, f3 to f5": modes, "end mass, force": masses}


def seconds(calls: dict[str, Callable[[], Any]]) -> dict[str, float]:
    """Median processor seconds of calls that take turns."""
    spent: dict[str, list[float]] = {name: [] for name in calls}
    for turn in range(ROUNDS + 1):  # the first warms up
        for name, work in calls.items():
            start = process_time()
            work()
            spent[name] += [process_time() - start] if turn else []
    return {name: median(each) for name, each in spent.items()}


def peer_rows() -> list[list[str]]:
    """Error of every contestant, and its time relative to cuefem's."""
    fine = cf.modes(CUE, 5, at=cf.Resolution(11, 9, 5)).frequencies[2:]
    masses = np.array([cf.end_mass(strokes.scene(CUE, T), "force", rtol=1e-4) for T in TIMES])
    rows = []
    for task, calls in contestants().items():
        modes = task.startswith("modes")
        spent = seconds({name: lambda work=work: work(1.5e-3) for name, work in calls.items()})
        for name, work in calls.items():
            off = work(1e-3)[2:] / fine - 1 if modes else np.array([work(T) for T in TIMES]) / masses - 1
            error = np.abs(off).max() if modes else np.median(np.abs(off))
            cells = f"{max(error, 1e-9):.0e}", f"{spent[name] / spent['cuefem']:.2g}"
            rows.append([task, name, *cells])
    return rows


def text() -> str:
    full, n = strokes.full_model(strokes.cue("pool_maple")), 20
    offsets = np.linspace(0.02, 0.5, n)
    batches = {
        name: [strokes.at_offset(s, float(b)) for b in offsets]
        for name, s in {"bare tip": scene(1e-3), "full model": full}.items()
    }
    calls: dict[str, Callable[[], Any]] = {
        EXPM: lambda: la.expm(np.full((50, 50), 0.02)),
        "modes(cue, 5)": lambda: cf.modes(scene(1e-3).shaft, 5),
        "end_mass(scene)": lambda: cf.end_mass(scene(2e-3)),
        "end_mass(scene, 'force')": lambda: cf.end_mass(scene(2e-3), "force"),
        "strike(scene), bare tip": lambda: cf.strike(scene(1e-3)),
        "strike(scene), full model": lambda: cf.strike(full),
        f"batch_strike of {n}, bare tip": lambda: cf.batch_strike(batches["bare tip"]),
        f"batch_strike of {n}, full model": lambda: cf.batch_strike(batches["full model"]),
        "strike(scene, rtol=1e-3), bare tip": lambda: cf.strike(scene(1e-3), rtol=1e-3),
        "strike(scene, rtol=1e-3), full model": lambda: cf.strike(full, rtol=1e-3),
    }
    spent, peers = seconds(calls), peer_rows()
    unit = spent[EXPM]
    return pages.page(
        "Run time and other programs",
        "What is the run time of the public calls, and that of the same result by another program?",
        f"A strike with a spring tip takes {spent['strike(scene), bare tip'] / unit:.0f} times a matrix exponential, "
        f"the default stroke of pool {spent['strike(scene), full model'] / unit:.0f} times. For f3 to f5 of one cone "
        f"to 1e-6 scikit-fem takes {peers[1][3]} times cuefem's processor time.",
        f"{pages.machine()}, one thread; medians of calls that take turns. Studies on processes and "
        "clusters: [many_designs](many_designs.md).",
        table(["call", f"times {EXPM}"], [[name, f"{t / unit:.0f}"] for name, t in spent.items()]),
        "## The same result by another program",
        table(["task", "program", "error", "times cuefem"], peers),
    )


EXAMPLE = """\
from timeit import timeit
import cuefem as cf

scene = cf.load_scene("studies/scenes/kim.toml")
seconds = timeit(lambda: cf.strike(scene), number=10) / 10
print(f"{1e3 * seconds:.1f} ms a strike")
"""
STUDY = pages.Study(__file__, text, seconds=True, example=EXAMPLE)

if __name__ == "__main__":
    STUDY.write()
