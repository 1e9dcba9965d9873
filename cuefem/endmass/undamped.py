"""Closed forms, from the modes, for what prescribed drives across the cue do at its tip; end masses follow from them.

The tip's transverse impulse response is h(t) = rigid + sum phi_k^2 cos(omega_k t), 1/kg. All functions take stacks of
cues: omega and phi of shape (..., n), flexible modes only, and rigid of shape (...), the sum of the rigid motions'
phi^2. Source: handbook: Effective end mass.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from cuefem.cue import Array
from cuefem.quantity.fields import scalar
from cuefem.scene import Scene

# Modes begin to fade at this part of the highest frequency kept. Measured: 0.35 to 0.65 serve equally well.
FADED = 0.5


def half_sine_velocity(omega: Array, phi: Array, rigid: Any, *, T: float) -> Any:
    """Tip velocity at the end of a half-sine force of unit height and length T, m/s per N."""
    return (phi**2 * half_sine_response(omega, T)).sum(axis=-1) + rigid * 2 * T / np.pi


def half_sine_response(omega: Any, T: float) -> Any:
    """Integral of cos(omega (T - s)) sin(pi s/T) ds over 0..T, s: what one mode gives per phi^2.

    It is a (1 + cos(omega T))/(a^2 - omega^2), a = pi/T, written with sinc so that it is exact at omega = a.
    """
    x = omega * T - np.pi
    return -np.pi * T / 2 * x * np.sinc(x / (2 * np.pi)) ** 2 / (x + 2 * np.pi)


def smooth_start_impulse(omega: Array, phi: Array, rigid: Any, *, T: float) -> Any:
    """Impulse that makes the tip follow the velocity (1 - cos(pi t/T))/2 from 0 to T, N s per m/s."""
    W, residues, direct = mobility(omega, phi, rigid)
    return direct + (residues * smooth_start_swing(W, T)).sum(axis=-1)


def smooth_start_swing(W: Array, T: float, vibrate: Callable[..., Array] | None = None) -> Array:
    """Integral of sin(W (T - s)) (1 - cos(pi s/T))/2 ds over 0..T; vibrate: as in `normal_impulse`."""
    vibrate = vibrate or response
    return (vibrate(W, T, (0.0, T)) - vibrate(W, T, (0.0, T), a=np.pi / T)) / 2


def response(W: Array, T: Any, span: tuple[Any, Any], *, a: Any = 0.0, b: Any = 0.0) -> Array:
    """Integral of sin(W (T - s)) cos(a s + b) ds over a span, free of 0/0 at W = a."""
    first, last = span
    middle, length = (first + last) / 2, last - first

    def sine(phase: Array, rate: Array) -> Array:  # integral of sin(phase + rate s)
        return length * np.sin(phase + rate * middle) * np.sinc(rate * length / (2 * np.pi))

    return (sine(W * T + b, a - W) + sine(W * T - b, -a - W)) / 2


def normal_impulse(W: Array, e: Any, T: Any, vibrate: Callable[..., Array] = response) -> Array:
    """Integral of sin(W (T - s)) P(s) ds over 0..T, P the head-on impulse of the bilinear tip over its total.

    Two quarter periods: (1 - cos)/(1 + e) while the tip is loaded, T/(1 + e) long, then (1 + e sin)/(1 + e). vibrate:
    as `response`; that of damped vibrations in the place of sin(W (T - s)).
    """
    peak, a = loading(e, T)
    total = vibrate(W, T, (0.0, T)) - vibrate(W, T, (0.0, peak), a=a)
    if np.any(e > 0):
        rate = a / np.where(e > 0, e, 1.0)  # where e = 0 the tip does not unload, and the span is empty
        total = total + e * vibrate(W, T, (peak, T), a=rate, b=-peak * rate - np.pi / 2)
    return total / (1 + e)


@dataclass(frozen=True)
class StickLimit:
    """The limit b -> 0 of the coupled strike: the tip sticks to the ball from the first touch.

    The tip's velocity against the ball is K P(t) - 1 times what it was, P the part of the normal impulse given so far.
    c = (1 + 1/nu)/M, 1/kg. K = (1 + e)(1 + 1/nu + 1/Q0)/(1 + 1/Q0). T: contact time, s. e: restitution. head_on_mass,
    kg. All may be stacks. J, kg, is the transverse impulse over U phi.
    """

    c: Any
    K: Any
    e: Any
    T: Any
    head_on_mass: Any

    @classmethod
    def of(cls, scene: Scene, axial_mass: Any = None) -> StickLimit:
        """The limit of a scene; axial_mass, kg: of other cues in the scene's place."""
        M, nu = scalar("Ball.mass", scene.ball.mass), scalar("Ball.inertia", scene.ball.inertia)
        e = scalar("Tip.restitution", scene.tip.restitution)
        axial_mass = scene.axial_mass if axial_mass is None else axial_mass
        return cls.law(M, nu, e, scene.contact_time, axial_mass)

    @classmethod
    def of_each(cls, scenes: Sequence[Scene], axial_mass: Array) -> StickLimit:
        """The stack of the limits of scenes with cues of ``axial_mass`` kg, (scenes,)."""
        limits = [cls.of(scene, m) for scene, m in zip(scenes, axial_mass, strict=True)]
        return cls(*(np.array([getattr(limit, part.name) for limit in limits]) for part in fields(cls)))

    @classmethod
    def law(cls, ball_mass: Any, inertia: Any, restitution: Any, contact_time: Any, axial_mass: Any) -> StickLimit:
        """The limit from numbers in kg and s, or from stacks of them that broadcast: thousands of contacts at once."""
        c = (1 + 1 / inertia) / ball_mass
        head_on_mass = 1 / (1 / ball_mass + 1 / axial_mass)
        K = (1 + restitution) * head_on_mass * (c + 1 / axial_mass)
        return cls(c, K, restitution, contact_time, head_on_mass)

    def __getitem__(self, part: slice) -> StickLimit:
        """A part of a stack; a field that is one number holds for all."""
        values = (getattr(self, each.name) for each in fields(self))
        return StickLimit(*(value[part] if np.ndim(value) else value for value in values))

    def transverse_impulse(self, omega: Array, phi: Array, rigid: Any, *, top: Any = None) -> Any:
        """J of a bare cue's modes, kg.

        top: rad/s, (...): vibrations near the frequency ``top`` and above fade out and only give way (see `fade`); by
        default all modes vibrate to the end.
        """
        W, residues, direct = mobility(omega, phi, rigid + self.c)
        swing = self.swing(W)
        if top is not None:
            settled = np.divide(_beside(self.K - 1), W, out=np.zeros_like(W), where=W > 0)
            swing = settled + fade(W / _beside(top)) * (swing - settled)
        return direct * (self.K - 1) + (residues * swing).sum(axis=-1)

    def ringing(self, omega: Array, phi: Array, rigid: Any, *, tail: int) -> float:
        """How far, relative to J, the ``tail`` highest vibrations of a held tip make it swing while they ring."""
        W, residues, direct = mobility(omega, phi, rigid + self.c)
        J = direct * (self.K - 1) + residues @ self.swing(W)
        return float(np.sum((residues / W)[len(W) - tail :]) / J)

    def swing(self, W: Array, vibrate: Callable[..., Array] = response) -> Array:
        """Integral of sin(W (T - s)) (K P(s) - 1) ds over 0..T; vibrate: as in `normal_impulse`."""
        T = _beside(self.T)
        P = normal_impulse(W, _beside(self.e), T, vibrate)
        return np.asarray(self.K)[..., None] * P - vibrate(W, T, (0.0, T))

    def swing_per_K(self, W: Array) -> Array:
        """Integral of sin(W (T - s)) P(s) ds over 0..T."""
        return normal_impulse(W, _beside(self.e), _beside(self.T))

    def impulse(self, slope: Any) -> Any:
        """J of a strike whose squirt is ``slope`` times phi, kg."""
        return slope * (1 + self.e) * self.head_on_mass

    def slope(self, J: Any) -> Any:
        """Squirt over phi of a strike with the transverse impulse J."""
        return J / ((1 + self.e) * self.head_on_mass)

    def end_mass(self, J: Any) -> Any:
        """The end mass of a lumped cue that takes the transverse impulse J, kg: (K - 1)/J = 1/m + c.

        ValueError, with the reason of `stick_reason`, if no end mass does.
        """
        masses = self.end_masses(J)
        for i in np.argwhere(np.isnan(masses))[:1]:
            slope = float(np.broadcast_to(self.slope(J), np.shape(masses))[tuple(i)])
            raise ValueError(f"end_mass drive 'stick': {stick_reason(slope)}; see cuefem.lump")
        return masses

    def end_masses(self, J: Any) -> Any:
        """As `end_mass`, for a stack: nan where no end mass gives J; `stick_reason` then says why."""
        rest = np.divide(self.K - 1, J, out=np.full(np.shape(J), np.nan), where=np.asarray(J) > 0) - self.c
        masses = np.divide(1.0, rest, out=np.full(np.shape(rest), np.nan), where=rest > 0)
        return masses if np.ndim(masses) else masses[()]


def stick_reason(slope: float) -> str:
    """The reason why no end mass has this squirt over phi."""
    if not np.isfinite(slope):
        return "the squirt is not a number"
    if slope < 0:
        return f"the squirt is {slope:.4g} times phi, below that of any end mass: so light a cue runs ahead of the ball"
    if slope == 0:
        return "there is no squirt, which asks for an end mass of 0"
    return f"the squirt is {slope:.4g} times phi, larger than that of any end mass"


def loading(e: Any, T: Any) -> tuple[Any, Any]:
    """Time of the bilinear tip's largest force, s, and the angular frequency of its loading, rad/s.

    The head-on force is a quarter of a sine up to its peak and another one down, which e makes 1/e times as fast.
    """
    peak = T / (1 + e)
    return peak, np.pi / (2 * peak)


def fade(x: Array) -> Array:
    """The part of a vibration that is kept at ``x`` times the highest frequency: 1 up to `FADED`, 0 from 1 on.

    Far above the pulse's own frequencies sin(W (T - s)) leaves V(T)/W, the beam giving way, and a ringing of
    cos(W T)/W. If the sum over modes ends sharply, the ringing that it keeps depends on its last modes by chance. If it
    fades out, it keeps what waves of these frequencies bring back to the tip by then.
    """
    return np.cos(np.pi / 2 * np.clip((x - FADED) / (1 - FADED), 0, 1)) ** 2


def _beside(value: Any) -> Any:
    """A number as it is, or a stack (...) as (..., 1), so that it broadcasts against stacks of modes."""
    return np.asarray(value)[..., None] if np.ndim(value) else value


def mobility(omega: Array, phi: Array, still: Any) -> tuple[Array, Array, Any]:
    """The force that a unit velocity step of the tip takes: direct delta(t) + sum of residues sin(W t).

    In Laplace's terms 1/D(s) = 1/(sum phi^2 s^2/(s^2 + omega^2) + still) = direct + sum residues W/(s^2 + W^2), whose
    poles are the frequencies W of the cue with its tip held by the inertia 1/still (the rigid motions' share is in
    ``still``): one symmetric eigenproblem a cue.
    """
    total = np.asarray((phi**2).sum(axis=-1) + still)[..., None]
    v = phi * omega
    diagonal = omega[..., None] ** 2 * np.eye(omega.shape[-1])
    squares, vectors = np.linalg.eigh(diagonal - v[..., :, None] * v[..., None, :] / total[..., None])
    # of a clamped cue the lowest is 0: a small one gives its limit, where rounding below 0 would lose the term
    W = np.sqrt(np.maximum(squares, 1e-12 * omega[..., :1] ** 2))
    weights = (np.einsum("...i,...ij->...j", v, vectors) / total) ** 2
    return W, np.divide(weights, W, out=np.zeros_like(W), where=W > 0), 1 / total[..., 0]
