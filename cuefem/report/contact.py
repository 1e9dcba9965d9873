"""The course of one contact, for the page: charts of forces and velocities, and what happens when."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice, pairwise
from typing import Any

import numpy as np

from cuefem.report.charts import Axis, Chart, Curve, Mark, Shade, chart
from cuefem.results.records import Record
from cuefem.scene import Outcome

MOST_EVENTS = 12


def contact_part(outcome: Outcome) -> Record:
    """Charts over time, the numbered moments on them in words, and whether the tip slips."""
    events = list(_events(outcome))
    t = np.linspace(0, outcome.duration, 401)
    history = outcome.history(t)
    ms = 1e3 * t
    slipping = [phase for phase in outcome.phases if phase.grip.startswith("slip")]
    spans = [Shade(1e3 * phase.start, 1e3 * phase.end, "slip") for phase in slipping]
    marks = [Mark(1e3 * at, str(i + 1)) for i, (at, _) in enumerate(events)]

    def drawn(title: str, label: str, curves: list[Curve]) -> Chart:
        return chart(title, curves, x=Axis("time, ms", 0.0, float(ms[-1])), y=Axis(label), spans=spans, marks=marks)

    return {
        "charts": [
            drawn(
                "Force of the tip on the ball",
                "force, N",
                [
                    Curve("along the normal", ms, history["force_n"], "c1"),
                    Curve("along the tangent", ms, history["force_t"], "c2"),
                ],
            ),
            drawn(
                "Velocity of the ball against the tip",
                "velocity, m/s",
                [
                    Curve("along the normal", ms, history["velocity_n"], "c1"),
                    Curve("along the tangent", ms, history["velocity_t"], "c2"),
                ],
            ),
        ],
        "events": [(str(i + 1), f"{1e3 * at:.4f} ms", words) for i, (at, words) in enumerate(events)],
        "slips": bool(spans),
    }


def _events(outcome: Outcome) -> Iterator[tuple[float, str]]:
    """The moments, s, at which the phase changes, in words: the first `MOST_EVENTS` of them, and the last."""
    phases = outcome.phases
    yield phases[0].start, "first touch, the tip slips" if phases[0].grip != "stick" else "first touch, the tip sticks"
    for before, after in islice(pairwise(phases), MOST_EVENTS):
        yield after.start, _turn(before, after)
    yield phases[-1].end, "separation"


def _turn(before: Any, after: Any) -> str:
    grips = {"stick": "the tip sticks", "slip": "the tip slips", "slip back": "the tip slips back"}
    presses = {
        "load": "pressed beyond its old peak",
        "unload": "greatest compression",
        "rigid": "greatest compression",
        "ringing": "the tip rings",
        "capped": "the tip rings less and less",
        "rubbed": "friction damps the ringing",
        "rubbed back": "friction damps the ringing",
        "swinging": "the tip rings and slips by turns",
    }
    words = []
    if after.press != before.press:
        words.append(presses.get(after.press, after.press))
    if after.grip != before.grip:
        words.append(grips.get(after.grip, after.grip))
    return ", ".join(words) or "goes on"
