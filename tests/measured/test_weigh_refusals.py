"""What the pendulum test refuses: readings that cannot be, options that do not go together (regression)."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cuefem.measured.pendulum import Bounces, PendulumTest
from studies.strokes import MESHES
from tests.helpers.refusals import command_refuses, refuses

FREE = Bounces("speed", (1.0,), (-0.1,), error=0.01)
CALLS: dict[str, tuple[Callable[[], object], str]] = {
    "way": (lambda: Bounces("angle", (1.0,), (0.5,), 0.01), "Bounces.way must be one of swing, height, speed, frames"),
    "error": (lambda: Bounces("speed", (1.0,), (0.5,), 0.0), "Bounces.error must be in (0, inf) m/s; got 0.0"),
    "counts": (lambda: Bounces("speed", (1.0,) * 2, (0.5,) * 3, 0.01), "as many as after; got 2 and 3"),
    "none": (lambda: Bounces("speed", (1.0,), (), 0.01), "as many as after; got 1 and 0"),
    "before": (lambda: Bounces("speed", (-1.0,), (0.5,), 0.01), "Bounces.before must be in (0, inf) m/s; got -1.0"),
    "thread": (lambda: Bounces("swing", (0.2,), (0.1,), 0.001, 0.2), "longer than every swing; got 0.2 m for 0.2 m"),
    "no thread": (lambda: Bounces("swing", (0.2,), (0.1,), 0.001), "longer than every swing; got inf m for 0.2 m"),
    "frames": (lambda: Bounces("frames", (8.0,), (0.0,), 0.5), "a ball that stops has no count: got 0"),
    "neither": (lambda: PendulumTest(8e-3, 1e-4, FREE, 1e-3), "wall or restitution, bounces off the shaft held firm"),
    "both": (lambda: PendulumTest(8e-3, 1e-4, FREE, 1e-3, wall=FREE, restitution=0.8), "held firm; got both"),
    "mass": (lambda: PendulumTest(0.0, 0.0, FREE, 1e-3, restitution=0.8), "PendulumTest.ball_mass must be in (0, inf)"),
    "kind": (lambda: PendulumTest(8e-3, 0.0, 0.3, 1e-3, restitution=0.8), "TypeError: PendulumTest.free must be a"),  # type: ignore[arg-type]
    "like a wall": (
        lambda: PendulumTest(8e-3, 0.0, Bounces("speed", (1.0,), (0.8,), 0.01), 1e-3, restitution=0.8).weighed(),
        "from the free shaft with (-1, 0.8) of its speed, less than from the shaft held firm",
    ),
    "through": (
        lambda: PendulumTest(8e-3, 0.0, FREE, 1e-3, wall=FREE).weighed(),
        "from the shaft held firm with (0, 1] of its speed; got -0.1",
    ),
}


@pytest.mark.parametrize(("ask", "message"), CALLS.values(), ids=CALLS.keys())
def test_refusals(ask: Callable[[], object], message: str) -> None:
    refuses(ask, message)


BALL = ("--ball-mass", "8 g", "--before", "200 mm", "--after", "-34 mm", "--thread", "1 m")
TIME = ("--contact-time", "1 ms")
COMMANDS = {
    "nothing": ((), "--ball-mass: must be given (or --plan); got nothing"),
    "after": (("--ball-mass", "8 g", "--before", "200 mm"), "--after: must be given (or --plan)"),
    "unit": ((*BALL[:1], "8", *BALL[2:], *TIME, "--restitution", "0.8"), "--ball-mass: needs a unit"),
    "held": ((*BALL, *TIME), "--held-after: or --restitution must be given; got neither"),
    "twice": ((*BALL, *TIME, "--restitution", "0.8", "--held-after", "160 mm"), "must be given; got both"),
    "time": ((*BALL, "--restitution", "0.8"), "--contact-time: must be given, or --press and --press-depth"),
    "depth": ((*BALL, "--restitution", "0.8", "--press", "20 N"), "--contact-time: must be given, or --press"),
    "thread": ((*BALL[:-2], *TIME, "--restitution", "0.8"), "Bounces.thread must be longer than every swing"),
    "press": (
        (
            *BALL[:2],
            *("--read", "frames", "--before", "8", "--after", "-40", "--restitution", "0.8"),
            *("--press", "20 N", "--press-depth", "0.5 mm"),
        ),
        "--press: must go with readings that tell a speed; got frames",
    ),
    "too near": (
        (*BALL[:4], "--after", "161.9 mm", "--held-after", "162 mm", *BALL[6:], *TIME),
        "the readings must tell the end mass to within its own size",
    ),
    "off": (
        (*BALL, *TIME, "--restitution", "0.8", "--scene", MESHES / "kim.toml", "--position", "2 m"),
        "end_mass position must be in [0.006, 0.706] m, on the shaft; got 2.0",
    ),
}


@pytest.mark.parametrize(("options", "message"), COMMANDS.values(), ids=COMMANDS.keys())
def test_commands(options: tuple[object, ...], message: str) -> None:
    command_refuses(message, "weigh", *options)
