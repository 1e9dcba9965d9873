"""Two oracles of the impulse solver, written from Newton's and Coulomb's laws and sharing no formula with cuefem.

`march`: the momentum equations of ball and cue as ordinary differential equations in the normal impulse, integrated by
scipy's DOP853 with events. `exact`: the same course in decimal arithmetic of 60 digits, where the pieces are straight.
Neither knows the inverse mass B: a contact force (f, 1) per normal impulse moves the ball's centre, its spin and the
tip, each by its own law, and the contact's velocity is read off their motion.
"""

from decimal import Decimal, localcontext
from math import asin, atan2, cos, inf, sin, sqrt
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from cuefem import Scene


class Told(NamedTuple):
    """What an oracle says, in SI; tangent: tan of the squirt; pulls: the friction law's course."""

    squirt: Any
    tangent: Any
    p_t: Any
    p_n: Any
    cue_speed: Any
    tip_loss: Any
    friction_loss: Any
    pulls: list[str]


def numbers(scene: Scene) -> dict[str, float]:
    """The scene's numbers, mass and length in the ball's units, at unit speed."""
    M = scene.ball.mass
    return {
        "b": scene.stroke.offset,
        "along": M / scene.cue.mass,
        "across": M / scene.cue.end_mass,
        "coupling": M * scene.cue.coupling,
        "nu": scene.ball.inertia,
        "e": scene.tip.restitution,
        "mu": scene.tip.friction,
    }


class Motion:
    """State y = (ball V_t, V_n, surface speed R Omega, tip u, tip w, normal and friction work, tangential impulse)."""

    def __init__(self, b: float, along: float, across: float, coupling: float, nu: float):
        phi = asin(b)
        self.s, self.c, self.nu = sin(phi), cos(phi), nu
        self.cue = np.array([[along, coupling], [coupling, across]])

    def relative(self, y: np.ndarray) -> tuple[float, float]:
        """Velocity of the ball's contact point against the tip's, (t, n)."""
        tip_t, tip_n = self.s * y[3] + self.c * y[4], self.c * y[3] - self.s * y[4]
        return y[0] + y[2] - tip_t, y[1] - tip_n

    def rates(self, y: np.ndarray, f: float, normal: float = 1.0) -> np.ndarray:
        """dy/dp under the force (f, normal) on the ball, its reaction on the tip."""
        tip = -self.cue @ [self.s * f + self.c * normal, self.c * f - self.s * normal]
        v_t, v_n = self.relative(y)
        return np.array([f, normal, f / self.nu, *tip, normal * v_n, -f * v_t, f])

    def response(self, f: float, normal: float) -> tuple[float, float]:
        """Rate of the relative velocity under a force."""
        return self.relative(self.rates(np.zeros(8), f, normal))

    def holding(self) -> float:
        """The force ratio under which the contact's tangential velocity does not change."""
        return -self.response(0.0, 1.0)[0] / self.response(1.0, 0.0)[0]

    def pull(self, y: np.ndarray, mu: float, sticks: bool) -> tuple[str, float]:
        """Coulomb's law: the name of what friction does and the force ratio."""
        if not sticks:
            return ("slip", mu) if self.relative(y)[0] < 0 else ("reversed", -mu)
        held = self.holding()
        if abs(held) <= mu:
            return "stick", held
        return ("reversed", -mu) if held < 0 else ("slip", mu)


def march(scene: Scene) -> Told:
    """The stroke by solve_ivp in the normal impulse, one call a piece, ended by its events."""
    x = numbers(scene)
    e, mu = x.pop("e"), x.pop("mu")
    motion = Motion(**x)
    y = np.zeros(8)
    y[3] = 1.0
    sticks = motion.s == 0
    if mu == inf and not sticks:  # the limit of ever larger friction: a blow along t with no normal impulse
        p_t = -motion.relative(y)[0] / motion.response(1.0, 0.0)[0]
        y = y + p_t * motion.rates(y / 2, 1.0, 0.0)
        sticks = True
    spent, pulls = None, []
    while True:
        name, f = motion.pull(y, mu, sticks)
        pulls.append(name + (" compressing" if spent is None else " restoring"))
        span = _span(motion, y, (name, f), e=e, spent=spent)
        if spent is not None and span == 0:
            break

        def grips(_p: float, y: np.ndarray) -> float:
            return motion.relative(y)[0]

        def ends(_p: float, y: np.ndarray, spent: float | None = spent) -> float:
            return motion.relative(y)[1] if spent is None else y[5] - (1 - e**2) * spent

        grips.terminal = ends.terminal = True  # type: ignore[attr-defined]
        grips.direction = ends.direction = 1  # type: ignore[attr-defined]
        events = [ends, grips] if name == "slip" else [ends]
        solution = solve_ivp(
            lambda _p, y, f=f: motion.rates(y, f), (0, span), y, method="DOP853", events=events, rtol=1e-13, atol=1e-15
        )
        y = solution.y[:, -1]
        if len(events) == 2 and len(solution.t_events[1]):
            sticks = True
        elif spent is None:
            spent = y[5]
            if e == 0:
                break
        else:
            break
    p_u, p_w = motion.s * y[7] + motion.c * y[1], motion.c * y[7] - motion.s * y[1]
    M, U = scene.ball.mass, scene.stroke.speed
    along = 1 - motion.cue[0, 1] ** 2 / (motion.cue[0, 0] * motion.cue[1, 1])
    return Told(
        squirt=atan2(-p_w, p_u),
        tangent=-p_w / p_u,
        p_t=M * U * y[7],
        p_n=M * U * y[1],
        cue_speed=U * (1 - p_u * motion.cue[0, 0] * along),
        tip_loss=-M * U**2 * y[5],
        friction_loss=M * U**2 * y[6],
        pulls=pulls,
    )


def _span(motion: Motion, y: np.ndarray, pull: tuple[str, float], *, e: float, spent: float | None) -> float:
    """Just beyond the piece's end: velocities are straight in p, so no piece is longer than its own end's root."""
    v_t, v_n = motion.relative(y)
    r_t, r_n = motion.response(pull[1], 1.0)
    roots = [-v_t / r_t] if pull[0] == "slip" and v_t < 0 < r_t else []
    if spent is None:
        roots += [-v_n / r_n] if v_n < 0 < r_n else []
    else:
        missing = max((1 - e**2) * spent - y[5], 0.0)
        roots += [2 * missing / (v_n + sqrt(v_n**2 + 2 * r_n * missing))] if missing else [0.0]
    return 1.01 * min(roots)


def exact(scene: Scene, digits: int = 60) -> Told:
    """The stroke in decimal arithmetic: straight pieces of velocity, roots of lines and parabolas. mu finite."""
    with localcontext() as context:
        context.prec = digits
        x = {name: Decimal(value) for name, value in numbers(scene).items()}
        # masses as they stand, not their rounded ratios
        M = Decimal(scene.ball.mass)
        x["along"], x["across"] = M / Decimal(scene.cue.mass), M / Decimal(scene.cue.end_mass)
        x["coupling"] = M * Decimal(scene.cue.coupling)
        return _exact(x, M=M, U=Decimal(scene.stroke.speed))


def _exact(x: dict[str, Decimal], *, M: Decimal, U: Decimal) -> Told:
    s, e, mu, nu = x["b"], x["e"], x["mu"], x["nu"]
    c = (1 - s * s).sqrt()

    def response(f: Decimal, normal: Decimal) -> tuple[Decimal, Decimal]:
        u, w = s * f + c * normal, c * f - s * normal
        tip_u, tip_w = -x["along"] * u - x["coupling"] * w, -x["coupling"] * u - x["across"] * w
        return f + f / nu - (s * tip_u + c * tip_w), normal - (c * tip_u - s * tip_w)

    held = -response(Decimal(0), Decimal(1))[0] / response(Decimal(1), Decimal(0))[0]
    v_t, v_n = -s, -c
    p_t = p_n = normal_work = friction_work = Decimal(0)
    spent, pulls = None, []
    while True:
        if v_t < 0:
            name, f = "slip", mu
        elif v_t == 0 and abs(held) <= mu:
            name, f = "stick", held
        elif v_t > 0 or held < 0:
            name, f = "reversed", -mu
        else:
            name, f = "slip", mu
        pulls.append(name + (" compressing" if spent is None else " restoring"))
        r_t, r_n = response(f, Decimal(1))
        if spent is None:
            end = -v_n / r_n if r_n > 0 else None
        else:
            missing = spent * (1 - e * e) - normal_work
            end = 2 * missing / (v_n + (v_n * v_n + 2 * r_n * missing).sqrt()) if missing > 0 else Decimal(0)
        grip = -v_t / r_t if v_t < 0 < r_t else None
        gripped = grip is not None and (end is None or grip < end)
        step = grip if gripped else end
        normal_work += (v_n + r_n * step / 2) * step
        friction_work -= f * (v_t + r_t * step / 2) * step
        p_t, p_n = p_t + f * step, p_n + step
        v_t = Decimal(0) if gripped or name == "stick" else v_t + r_t * step
        v_n = v_n + r_n * step
        if gripped:
            continue
        if spent is not None or e == 0:
            break
        spent, v_n = normal_work, Decimal(0)
    p_u, p_w = s * p_t + c * p_n, c * p_t - s * p_n
    free = 1 - x["coupling"] ** 2 / (x["along"] * x["across"])
    return Told(
        squirt=None,
        tangent=-p_w / p_u,
        p_t=M * U * p_t,
        p_n=M * U * p_n,
        cue_speed=U * (1 - p_u * x["along"] * free),
        tip_loss=-M * U**2 * normal_work,
        friction_loss=M * U**2 * friction_work,
        pulls=pulls,
    )


def regime_of(told: Told) -> str:
    """The regime in the words of `Outcome`, from the course of friction."""
    if any(pull.startswith("reversed") for pull in told.pulls):
        return "slip reversal"
    first = next((pull for pull in told.pulls if pull.startswith("stick")), None)
    if first is None:
        return "miscue"
    return "stick" if first == "stick compressing" else "late stick"
