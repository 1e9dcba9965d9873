"""The four roads from the finite-element cue to the lumped one, and the three to the exact one. Part of convergence.py.

Each road is a pure function that returns a `Road`: what is varied, and relative errors by name.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cuefem import Cue, Resolution, Scene, StickLimit, squirt
from cuefem.beam.tip import TipModes
from cuefem.endmass.drives import flexible, force, stick, stick_at_offset, velocity
from cuefem.tip_modes import default_resolution, tip_modes_of
from studies.strokes import at_offset, cue, lumped_squirt, scene, strike_modes

OFFSETS = (0.1, 0.3, 0.5)
STUB = 0.12  # m, [Kim]'s cue end
SAMPLES = 8  # in each window of the rigid roads: a factor 2 in time, 4 in stiffness


@dataclass(frozen=True)
class Road:
    """What is varied, (n,), and the signed relative errors that go with it, each (n,)."""

    along: np.ndarray
    errors: dict[str, np.ndarray]


def squirt_of(tip: TipModes, struck: Scene) -> float:
    """Squirt of the coupled strike, rad."""
    return float(strike_modes(struck, tip).squirt)


# (a), (b): a cue that is stiff, or struck for long, moves as a rigid body


def stub() -> Cue:
    """The first 12 cm of Kim's cone, the cue's 540 g along the axis."""
    whole = cue("kim")
    (cone,) = whole.segments
    base = 2 * float(squirt.base_radius(STUB, length=0.7, tip_radius=6e-3, butt_radius=10.5e-3))
    end = replace(cone, length=STUB, butt_diameter=base)
    return Cue((end,), body_mass=whole.mass - end.mass)


def stub_end_mass() -> float:
    """m_c nu_c/(1 + nu_c) with the stub's own nu_c, rotary inertia included, kg."""
    (end,) = stub().segments
    nu_c = squirt.inertia_factor(
        tip_radius=end.tip_diameter / 2, base_radius=end.butt_diameter / 2, end_length=end.length
    )
    return float(end.mass * nu_c / (1 + nu_c))


def rigid_end_mass(tip: TipModes) -> float:
    """What the tip feels of the rigid motions alone, kg."""
    omega, phi = tip.transverse
    return float(1 / np.sum(phi[omega == 0] ** 2))


def rigid_errors(tip: TipModes, struck: Scene, end_mass: float) -> dict[str, float]:
    """End masses over the rigid one, and squirt over the rigid cue's, minus 1."""
    masses = {"force": force, "velocity": velocity, "stick": stick}
    errors = {name: drive(tip, struck) / end_mass - 1 for name, drive in masses.items()}
    return {**errors, "squirt": squirt_of(tip, struck) / lumped_squirt(struck, end_mass) - 1}


def gathered(along: Sequence[float], found: Sequence[dict[str, float]]) -> Road:
    """A road from its points."""
    return Road(np.array(along), {name: np.array([point[name] for point in found]) for name in found[0]})


def stiff_stub(friction: float = 0.7, doublings: int = 7) -> Road:
    """(a) The stub, T = 2 ms, b/R 0.3, against factors on E and G, which scale every frequency by their root."""
    struck = scene(stub(), 2e-3, 0.3)
    struck = replace(struck, tip=replace(struck.tip, friction=friction))
    tip = tip_modes_of(struck, Resolution(2, 14, 4))
    factors = 4.0 ** (np.arange(doublings * SAMPLES) / SAMPLES)
    stiffer = (replace(tip, omega=tip.omega * math.sqrt(factor)) for factor in factors)
    return gathered(factors, [rigid_errors(one, struck, stub_end_mass()) for one in stiffer])


def long_contact(doublings: int = 10, shortest: float = 2e-3) -> Road:
    """(b) Kim's whole shaft, b/R 0.3, against the contact time, s."""
    times = shortest * 2.0 ** (np.arange(doublings * SAMPLES) / SAMPLES)
    tip = tip_modes_of(scene(cue("kim")), Resolution(4, 20, 12))
    strokes = (scene(cue("kim"), time, 0.3) for time in times)
    return gathered(times, [rigid_errors(tip, struck, rigid_end_mass(tip)) for struck in strokes])


# (c): a light cue of fixed shape


def first_order(struck: Scene, end_mass: float) -> float:
    """[Kim]'s psi = epsilon dpsi/depsilon, rad; nu_c drops out of it when written in m_e."""
    ratio = struck.axial_mass / struck.ball.mass
    slope = squirt.squirt_slope(struck.stroke.offset, cue_mass_ratio=ratio, nu_c=1.0)
    return float(slope * squirt.cue_end_mass(end_mass, 1.0) / struck.ball.mass)


def light(modes: int = 22, lightest: float = -5.0) -> dict[float, Road]:
    """(c) Kim's shaft, T = 1 ms, rho, E and G all times a factor: psi over the first order of two end masses, minus 1.

    "stick": the small-offset end mass; "stick at the offset": `stick_at_offset`. One road an offset.
    """
    factors = 10.0 ** np.arange(0.0, lightest - 0.1, -0.5)
    heavy = tip_modes_of(scene(cue("kim")), Resolution(8, 26, modes))
    roads = {}
    for offset in OFFSETS:
        struck, points = scene(cue("kim"), 1e-3, offset), []
        for factor in factors:
            tip = lighter(heavy, factor)
            psi = squirt_of(tip, struck)
            masses = {"stick": stick(tip, struck), "stick at the offset": stick_at_offset(tip, struck)}
            points.append({name: psi / first_order(struck, mass) - 1 for name, mass in masses.items()})
        roads[offset] = gathered(factors, points)
    return roads


def lighter(tip: TipModes, factor: float) -> TipModes:
    """Tip modes of a cue whose transverse inertia and stiffness are ``factor`` times these; the axis as it was."""
    scale = np.array([1.0, factor**-0.5])
    return replace(tip, amplitude=tip.amplitude * scale)


# (d): an offset that vanishes


def plain_tip(struck: Scene) -> TipModes:
    """Tip modes without a tail: the law of (d) is that of a plain sum, whose modes ring."""
    return tip_modes_of(struck, default_resolution(struck, periods=45))


def small_offset(name: str, modes: int | None = None, smallest: float = -6.0) -> Road:
    """(d) Coupled squirt over that of the impulse solver, minus 1, T = 1 ms, against the offset.

    "stick": fed with the stick end mass; "stick at the offset": with that of `stick_at_offset`.
    """
    struck = scene(cue(name))
    tip = plain_tip(struck) if modes is None else tip_modes_of(struck, Resolution(12, 26, modes))
    offsets, points = 10.0 ** np.arange(smallest, -0.24, 0.25), []
    for offset in offsets:
        there = at_offset(struck, offset)
        psi, masses = squirt_of(tip, there), (stick(tip, struck), stick_at_offset(tip, there))
        stuck, own = (psi / lumped_squirt(there, mass) - 1 for mass in masses)
        points.append({"stick": stuck, "stick at the offset": own})
    return gathered(offsets, points)


def first_slip(tip: TipModes, struck: Scene) -> float:
    """Duration of the first slip over the root of the offset, as the offset vanishes, s.

    The load grows as k U t, so v_t = -U phi + mu B_tt k U t^2/2, B_tt the sum of phi_k^2 over the modes kept, and the
    ball's: slip ends at sqrt(2 phi/(mu k B_tt)). More modes shorten it: it vanishes with them.
    """
    B_tt = np.sum(tip.amplitude[:, 1] ** 2) + StickLimit.of(struck).c
    return float(np.sqrt(2 / (struck.tip.friction * struck.stiffness * B_tt)))


def ringing(tip: TipModes, struck: Scene, step: float = 1e-6) -> float:
    """The force at the end of the contact that a unit velocity step of the tip at its start still takes, N s/m.

    The derivative in T of the step's impulse, which is the transverse impulse of a `StickLimit` with K = 0.
    """
    limit = replace(StickLimit.of(struck), K=0.0)
    earlier, later = (
        -float(replace(limit, T=limit.T * (1 + side * step)).transverse_impulse(*flexible(tip))) for side in (-1, 1)
    )
    return (later - earlier) / (2 * step * limit.T)


def root_law(tip: TipModes, struck: Scene) -> float:
    """Coupled over lumped squirt, minus 1, over the root of the offset, as the offset vanishes.

    The first slip spreads the step of the tip's velocity over t_s, on average by 2/3 t_s, so the impulse changes by
    that much of what the step leaves ringing at the end, of either sign.
    """
    impulse = float(StickLimit.of(struck).transverse_impulse(*flexible(tip)))
    return 2 / 3 * first_slip(tip, struck) * ringing(tip, struck) / impulse


# modes, elements, order


def more_modes(name: str = "kim", most: int = 300) -> Road:
    """Squirt at b/R 0.3, T = 1 ms, over that of the ``most`` lowest modes, minus 1, against the modes kept.

    "compliance": the static compliance of the modes left out over the whole: what the tip misses of them.
    """
    struck = scene(cue(name), 1e-3, 0.3)
    tip = tip_modes_of(struck, Resolution(20, 26, most))
    rigid = int(np.sum(tip.omega == 0))
    soft = (tip.amplitude[rigid:, 1] / tip.omega[rigid:]) ** 2
    counts = np.unique(np.geomspace(10, most / 4, 25).astype(int))
    reference = squirt_of(tip, struck)
    points = [
        {"squirt": squirt_of(tip.lowest(n + rigid), struck) / reference - 1, "compliance": soft[n:].sum() / soft.sum()}
        for n in counts
    ]
    return gathered(counts, points)


def converged(struck: Scene) -> float:
    """Squirt with 22 modes on a mesh that has converged, rad."""
    return squirt_of(tip_modes_of(struck, Resolution(8, 20, 22)), struck)


def more_elements(order: int, elements: Sequence[int] = (48, 64, 96, 128)) -> Road:
    """Squirt of Kim's shaft, b/R 0.3, T = 1 ms, 22 modes, over that of a converged mesh, minus 1."""
    struck = scene(cue("kim"), 1e-3, 0.3)
    found = [squirt_of(tip_modes_of(struck, Resolution(n, order, 22)), struck) for n in elements]
    return gathered(elements, [{"squirt": psi / converged(struck) - 1} for psi in found])


def higher_order(elements: int = 3, orders: Sequence[int] = tuple(range(6, 22))) -> Road:
    """The same against the order, with ``elements`` elements."""
    struck = scene(cue("kim"), 1e-3, 0.3)
    exact = converged(struck)
    found = [squirt_of(tip_modes_of(struck, Resolution(elements, order, 22)), struck) for order in orders]
    return gathered(orders, [{"squirt": psi / exact - 1} for psi in found])
