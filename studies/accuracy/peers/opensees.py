"""OpenSeesPy: elastic Timoshenko elements, the taper in steps; `-cMass` holds the rotary inertia already."""

from __future__ import annotations

from functools import partial

import numpy as np

from studies.accuracy.peers.cone import CONE, MODES

try:
    import openseespy.opensees as ops
except RuntimeError as why:
    raise RuntimeError(f"{str(why).rstrip('.')}; it needs the system's libblas3 (apt-get install libblas3)") from why

VERSION = ops.version()


def beam(elements: int) -> None:
    """Uniform elements with the section at their middles, in the plane, held along the axis only."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    x = np.linspace(0, CONE.length, elements + 1)
    for node, position in enumerate(x.tolist(), 1):
        ops.node(node, position, 0.0)
        ops.fix(node, 1, 0, 0)
    ops.geomTransf("Linear", 1)
    for tag, middle in enumerate(((x[1:] + x[:-1]) / 2).tolist(), 1):
        A, inertia = float(CONE.area(middle)), float(CONE.inertia(middle))
        section = (CONE.E, CONE.G, A, inertia, CONE.kappa * A)
        ops.element("ElasticTimoshenkoBeam", tag, tag, tag + 1, *section, 1, "-mass", CONE.rho * A, "-cMass")


def modes(elements: int) -> np.ndarray:
    """f1 to f5, Hz."""
    beam(elements)
    return np.sqrt(ops.eigen(2 + MODES)[2:]) / (2 * np.pi)


def end_mass(elements: int, steps: int, *linear: str) -> float:
    """Force end mass, kg, by Newmark steps (average acceleration); ``linear``: options of the linear algorithm."""
    beam(elements)
    ops.timeSeries("Trig", 1, 0.0, CONE.contact_time, 2 * CONE.contact_time)
    ops.pattern("Plain", 1, 1)
    ops.load(1, 0.0, 1.0, 0.0)
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandSPD")
    ops.algorithm("Linear", *linear)
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    if ops.analyze(steps, CONE.contact_time / steps) != 0:
        raise ArithmeticError("OpenSees: a step failed")
    return 2 * CONE.contact_time / np.pi / ops.nodeVel(1, 2)


CONTESTANTS = {
    "modes": {f"OpenSeesPy x {n}": partial(modes, n) for n in (80, 310, 1240)},
    "end_mass": {
        **{f"OpenSeesPy x {n}, {steps} steps": partial(end_mass, n, steps) for n, steps in ((40, 200), (160, 800))},
        "OpenSeesPy, factored once, x 160, 800 steps": partial(end_mass, 160, 800, "-factorOnce"),
    },
}
