"""The table of a leather tip's static give that cuefem's LeatherTip reads, computed from 3-D elasticity."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from cuefem.effects import leather_table as lt
from studies.leather_body import Array, Patch, Shape, Solid, compliance, fitted, head_on, loads, punch, usual

PLACE = lt.__file__.replace(".py", ".npz")
OFF = usual(4, 6, 5, 30)
COUNTS = {"curvature": 5, "height": 7, "nu": 4, "place": 8, "radius": 12, "head_on": 12}


def shape_at(curvature: float, coordinate: float) -> Shape:
    return Shape(np.exp(coordinate) - lt.SOFTENED + lt.sag(curvature), curvature)


def places(curvature: float, count: int) -> Array:
    far = lt.farthest(curvature) ** 2
    return np.sqrt(lt.nodes(lt.PLACE * far, far, count))


def geometry(shape: Shape, load: Array, nus: Array, n: dict[str, int]) -> tuple[Array, Array]:
    """Rows of the table for one shape: patch (nu, place, radius, 3) and head_on (nu, radius, 2, 3)."""
    off = Solid(shape, OFF)
    radii = np.exp(lt.nodes(*lt.LOG_RADIUS, n["radius"]))
    straight = np.exp(lt.nodes(*lt.LOG_HEAD_ON, n["head_on"]))
    s = places(shape.curvature, n["place"])
    patch = []
    for nu in nus:
        C = np.zeros((n["place"], n["radius"], 2, 2))
        for m in range(OFF.harmonics + 1):
            f = load[:, :, m]
            C += np.einsum("pric,prjc->prij", f @ off.surface(nu, m), f)
        base = lt.half_space(nu, radii)
        direct = np.stack([C[..., 0, 0], C[..., 1, 1]], -1)
        across = C[..., 0, 1] / s[:, None] / np.sqrt(direct.prod(axis=-1))
        patch.append(np.concatenate([np.log(direct / base), across[..., None]], -1))
    head = np.zeros((len(nus), n["head_on"], 2, 3))
    for i, a in enumerate(straight):
        how = fitted(shape.height, a)
        on = Solid(shape, how)
        for k, nu in enumerate(nus):
            found = head_on(shape, on.surface(nu, 0), a, how)
            head[k, i] = np.log(found / lt.half_space_head_on(nu, a))
    return np.array(patch), head


def build(n: dict[str, int] = COUNTS, report: bool = True) -> lt.Table:
    nus = (1 - np.exp(-lt.nodes(*lt.NU, n["nu"]))) / 2
    radii = np.exp(lt.nodes(*lt.LOG_RADIUS, n["radius"]))
    patch = np.zeros((2, n["curvature"], n["height"], n["nu"], n["place"], n["radius"], 3))
    head = np.zeros((2, n["curvature"], n["height"], n["nu"], n["head_on"], 2, 3))
    begun = time.time()
    for panel in (0, 1):
        for i, k in enumerate(lt.nodes(panel, panel + 1.0, n["curvature"])):
            if panel and i == 0:
                patch[1, 0], head[1, 0] = patch[0, -1], head[0, -1]
                continue
            load = None
            for j, v in enumerate(lt.nodes(*lt.heights(k), n["height"])):
                shape = shape_at(k, v)
                if load is None:
                    load = np.array([[loads(shape, Patch(s, a), OFF) for a in radii] for s in places(k, n["place"])])
                patch[panel, i, j], head[panel, i, j] = geometry(shape, load, nus, n)
            if report:
                print(panel, k, time.time() - begun, file=sys.stderr, flush=True)
    gain = np.zeros((n["height"], n["nu"], n["radius"], 2))
    how = OFF._replace(harmonics=1)
    for j, v in enumerate(lt.nodes(*lt.heights(0.0), n["height"])):
        shape = shape_at(0.0, v)
        solid, load = Solid(shape, how), [loads(shape, Patch(0.0, a), how, (0.5, -0.5)) for a in radii]
        for k, nu in enumerate(nus):
            surfaces = [solid.surface(nu, m) for m in (0, 1)]
            both = [compliance(surfaces, f) for f in load]
            gain[j, k] = [np.diagonal(C[:2, :2] - punch(C)) for C in both] / (lt.half_space(nu, radii) / 6)
    return lt.Table(patch, head, gain)


def main() -> None:
    found = build()
    np.savez_compressed(PLACE, **{k: v.astype(np.float32) for k, v in found._asdict().items()})
    print(Path(PLACE).stat().st_size)


if __name__ == "__main__":
    main()
