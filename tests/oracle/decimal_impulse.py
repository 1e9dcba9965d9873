"""An independent impulse solver, written from Newton's and Coulomb's laws without a formula of cuefem; no tests.

The solution is piecewise linear in the normal impulse, in decimal arithmetic of 60 digits. There is no inverse mass B:
a contact force (f, 1) per normal impulse accelerates the ball's centre, its spin and the tip, each by its own law, and
the relative velocity of the contact follows from their motion.
"""

from decimal import Decimal, localcontext
from typing import Any, NamedTuple

from cuefem import Scene


class ImpulseSolution(NamedTuple):
    """The outcome in SI; tangent: tan of the squirt; friction_states: state and phase of each piece."""

    tangent: Any
    p_t: Any
    p_n: Any
    cue_speed: Any
    tip_loss: Any
    friction_loss: Any
    friction_states: list[str]


def exact_impulse(scene: Scene) -> ImpulseSolution:
    """The stroke in decimal arithmetic: straight pieces of velocity, roots of lines and parabolas."""
    cue, ball, tip = scene.cue, scene.ball, scene.tip
    with localcontext(prec=60):
        M = Decimal(ball.mass)
        x = {"along": M / Decimal(cue.mass), "across": M / Decimal(cue.end_mass), "coupling": M * Decimal(cue.coupling)}
        x |= {"b": Decimal(scene.stroke.offset), "nu": Decimal(ball.inertia)}
        x |= {"e": Decimal(tip.restitution), "mu": Decimal(tip.friction)}
        return _exact(x, M=M, U=Decimal(scene.stroke.speed))


def _exact(x: dict[str, Decimal], *, M: Decimal, U: Decimal) -> ImpulseSolution:
    s, e, mu, nu = x["b"], x["e"], x["mu"], x["nu"]
    c = (1 - s * s).sqrt()

    def response(f: Decimal, normal: Decimal) -> tuple[Decimal, Decimal]:
        u, w = s * f + c * normal, c * f - s * normal
        tip_u, tip_w = -x["along"] * u - x["coupling"] * w, -x["coupling"] * u - x["across"] * w
        return f + f / nu - (s * tip_u + c * tip_w), normal - (c * tip_u - s * tip_w)

    stick_ratio = -response(Decimal(0), Decimal(1))[0] / response(Decimal(1), Decimal(0))[0]
    v_t, v_n = -s, -c
    p_t = p_n = normal_work = friction_work = Decimal(0)
    compression_work, friction_states = None, []
    if mu == Decimal("Infinity") and v_t < 0:  # the limit of infinite friction: a tangential impulse alone
        r_t, r_n = response(Decimal(1), Decimal(0))
        p_t = -v_t / r_t
        friction_work, v_t, v_n = -v_t * p_t / 2, Decimal(0), v_n + r_n * p_t
    while True:
        if v_t < 0:
            name, f = "slip", mu
        elif v_t == 0 and abs(stick_ratio) <= mu:
            name, f = "stick", stick_ratio
        elif v_t > 0 or stick_ratio < 0:
            name, f = "reversed", -mu
        else:
            name, f = "slip", mu
        friction_states.append(name + (" compressing" if compression_work is None else " restoring"))
        r_t, r_n = response(f, Decimal(1))
        if compression_work is None:
            end = -v_n / r_n if r_n > 0 else None
        else:
            work = compression_work * (1 - e * e) - normal_work  # still to be returned
            end = 2 * work / (v_n + (v_n * v_n + 2 * r_n * work).sqrt()) if work > 0 else Decimal(0)
        stick_impulse = -v_t / r_t if v_t < 0 < r_t else None
        sticks = stick_impulse is not None and (end is None or stick_impulse < end)
        step = stick_impulse if sticks else end
        normal_work += (v_n + r_n * step / 2) * step
        friction_work -= f * (v_t + r_t * step / 2) * step
        p_t, p_n = p_t + f * step, p_n + step
        v_t = Decimal(0) if sticks or name == "stick" else v_t + r_t * step
        v_n = v_n + r_n * step
        if sticks:
            continue
        if compression_work is not None or e == 0:
            break
        compression_work, v_n = normal_work, Decimal(0)
    p_u, p_w = s * p_t + c * p_n, c * p_t - s * p_n
    axial_factor = 1 - x["coupling"] ** 2 / (x["along"] * x["across"])
    return ImpulseSolution(
        tangent=-p_w / p_u,
        p_t=M * U * p_t,
        p_n=M * U * p_n,
        cue_speed=U * (1 - p_u * x["along"] * axial_factor),
        tip_loss=-M * U**2 * normal_work,
        friction_loss=M * U**2 * friction_work,
        friction_states=friction_states,
    )


def regime_of(solution: ImpulseSolution) -> str:
    """The regime of `Outcome` that the friction states define."""
    if any(state.startswith("reversed") for state in solution.friction_states):
        return "slip reversal"
    first = next((state for state in solution.friction_states if state.startswith("stick")), None)
    if first is None:
        return "miscue"
    return "stick" if first == "stick compressing" else "late stick"
