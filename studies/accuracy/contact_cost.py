"""What do exactly propagated phases cost compared with a general ODE solver, at equal accuracy?

What: strokes of meshes/kim.toml (24 flexible modes, T = 1 ms, e = 3/4, mu = 0.7, a ball of 210 g) at four offsets, from
little slip to a miscue, by cuefem.contact.linear and by scipy's solve_ivp (DOP853, and Radau with its Jacobian) on the
very same linear phases, their ends found by solve_ivp's events. Each solver's rtol is the loosest power of ten that
holds squirt and ball speed of all four strokes to 1e-8 of the exact phases; those are checked against cells a third as
long. Equations: handbook: The strike. Writes contact_cost.md (values, no seconds) and contact_cost_seconds.md (seconds,
of the machine named there) beside itself; takes about 5 s.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from statistics import median
from time import perf_counter
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from cuefem import Resolution
from cuefem.beam.tip import TipModes
from cuefem.contact.flow import Flow
from cuefem.contact.linear import Exact
from cuefem.contact.phases import run
from cuefem.contact.state import Contact, Laws
from cuefem.tip_modes import tip_modes_of
from studies import pages, strokes

MODES, OFFSETS, ACCURACY = 24, (0.1, 0.3, 0.5, 0.8), 1e-8
AT = Resolution(4, 22, MODES)
TOLERANCES = dict.fromkeys(("DOP853", "Radau"), 10.0 ** -np.arange(3, 13))


class Fine(Exact):
    """The exact phases in cells a third as long."""

    def flow(self, grip: Any, press: Any) -> Flow:
        """The same motion, cut finer."""
        if (grip, press) not in self.flows:
            self.flows[grip, press] = replace(super().flow(grip, press), rate=3 * super().flow(grip, press).rate)
        return self.flows[grip, press]


class Stepped(Exact):
    """The same phases, followed by solve_ivp and ended by its events."""

    method: str = "DOP853"
    rtol: float = 1e-10
    evaluations: int = 0

    def follow(self, grip: Any, press: Any) -> str:
        """One phase."""
        contact = self.contact
        flow, (names, guards) = self.flow(grip, press), self.guards(grip, press)
        before, start = contact.impulse, contact.time

        def event(weights: np.ndarray, constant: float) -> Callable[[float, np.ndarray], float]:
            row = weights @ flow.rows

            def falls(_: float, z: np.ndarray) -> float:
                return float(row @ z + constant)

            falls.terminal, falls.direction = True, -1.0  # type: ignore[attr-defined]
            return falls

        found = solve_ivp(
            lambda _, z: flow.A @ z,
            (start, start + 20 * contact.laws.time),
            contact.z,
            method=self.method,
            rtol=self.rtol,
            atol=self.rtol * 1e-2 * contact.laws.speed,
            events=[event(*pair) for pair in zip(guards.weights, guards.constants, strict=True)],
            **({"jac": flow.A} if self.method == "Radau" else {}),
        )
        self.evaluations += found.nfev
        guard = next(i for i, hits in enumerate(found.t_events) if len(hits))
        self.arrive(float(found.t[-1]), found.y[:, -1], [])
        self.patch.end(self, grip, press)
        contact.end_phase(grip, press, start, before)
        return names[guard]


@cache
def stroke(offset: float) -> tuple[TipModes, Laws]:
    """Tip modes and laws of one of the strokes."""
    scene = strokes.scene(strokes.cue("kim"), offset=offset)
    ball, tip = scene.ball, scene.tip
    laws = Laws(
        math.asin(offset),
        ball.mass,
        ball.inertia,
        scene.stiffness,
        tip.restitution,
        tip.friction,
        scene.contact_time,
        1.0,
    )
    return tip_modes_of(scene, AT), laws


def struck(offset: float, kind: type[Exact] = Exact, **options: Any) -> Contact:
    """A stroke, from first touch to separation."""
    return solved(offset, kind, **options).contact


def solved(offset: float, kind: type[Exact], **options: Any) -> Any:
    """The same with all that its kind of contact counted."""
    found = kind.of(*stroke(offset))
    for name, value in options.items():
        setattr(found, name, value)
    run(found)
    return found


def answer(contact: Contact) -> np.ndarray:
    """Squirt, rad, and ball speed over the cue's."""
    (p_t, p_n), laws = contact.impulse, contact.laws
    return np.array([laws.phi - math.atan2(p_t, p_n), math.hypot(p_t, p_n) / laws.ball_mass])


def worst(kind: type[Exact], **options: Any) -> float:
    """Largest error of squirt or speed over the strokes, against the exact phases."""
    exact = [answer(struck(offset)) for offset in OFFSETS]
    found = [answer(struck(offset, kind, **options)) for offset in OFFSETS]
    return float(np.abs(np.array(found) - exact).max())


@cache
def tolerance(method: str) -> tuple[float, float]:
    """The loosest rtol of a solver that holds the accuracy on all strokes, and its worst error."""
    for rtol in TOLERANCES[method]:
        error = worst(Stepped, method=method, rtol=rtol)
        if error < ACCURACY:
            return rtol, error
    raise RuntimeError(f"{method} does not reach {ACCURACY} with an rtol down to {rtol}")


def bound(error: float) -> str:
    """The power of ten just above an error."""
    return f"1e{math.ceil(math.log10(max(error, 1e-13)))}"


def report() -> str:
    """The values, without seconds."""
    lines = [
        "# Exactly propagated phases against a general ODE solver",
        "",
        f"Kim's cue, {MODES} modes, T = 1 ms; b/R {', '.join(map(str, OFFSETS))}. Errors are the largest over the",
        "strokes, of squirt (rad) or ball speed (relative to the cue's), rounded up to a power of ten. What it costs:",
        "[contact_cost_seconds.md](contact_cost_seconds.md).",
        "",
        "| solver | rtol | error below |",
        "|---|---|---|",
        f"| exact phases | | {bound(worst(Fine))} |",
    ]
    for method in TOLERANCES:
        rtol, error = tolerance(method)
        lines.append(f"| solve_ivp {method} | {rtol:.0e} | {bound(error)} |")
    lines += ["", "| b/R | squirt, degrees | phases |", "|---|---|---|"]
    for offset in OFFSETS:
        contact = struck(offset)
        course = ", ".join(f"{phase.grip} {phase.press}" for phase in contact.phases)
        lines.append(f"| {offset} | {np.degrees(answer(contact)[0]):.6f} | {course} |")
    return "\n".join(lines) + "\n"


def seconds() -> str:
    """The cost table of this machine; solvers take turns, so that a busy machine is busy for all."""
    solvers: dict[str, tuple[Callable[[float], Any], int]] = {"exact phases": (struck, 25)}
    for method in TOLERANCES:
        rtol = tolerance(method)[0]
        solvers[f"solve_ivp {method}"] = (lambda b, m=method, r=rtol: struck(b, Stepped, method=m, rtol=r), 5)
    solvers["solve_ivp Radau"] = (solvers["solve_ivp Radau"][0], 1)
    cost = {
        name: [pages.seconds_of(lambda b=b, w=work: w(b), repeats, perf_counter) for b in OFFSETS]
        for name, (work, repeats) in solvers.items()
    }
    expm = pages.seconds_of(pages.expm_50(), 200, perf_counter)
    exact = np.array(cost["exact phases"])
    lines = [
        "# Seconds of one stroke",
        "",
        pages.machine(),
        f"Medians, milliseconds, at an accuracy of {ACCURACY:.0e}.",
        "",
        "| solver | " + " | ".join(f"b/R {b}" for b in OFFSETS) + " | median ratio to exact phases |",
        "|---|" + "---|" * (len(OFFSETS) + 1),
    ]
    for name, times in cost.items():
        cells = " | ".join(f"{1e3 * t:.2f}" for t in times)
        lines.append(f"| {name} | {cells} | {np.median(np.array(times) / exact):.1f} |")
    share = median(exact) / expm
    lines += [
        "",
        f"One scipy.linalg.expm of a 50 x 50 matrix: {1e3 * expm:.3f} ms; a stroke costs {share:.1f} of them.",
    ]
    return "\n".join(lines) + "\n"


STUDY = pages.Study(__file__, report, seconds=seconds, heavy=False)


if __name__ == "__main__":
    STUDY.write()
