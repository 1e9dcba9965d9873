"""Time history of one contact, for the page: charts of force and velocity, and the events on them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice, pairwise
from typing import Any

import numpy as np

from cuefem.contact.outcome import Phase
from cuefem.quantity.display_units import to_display, with_heading
from cuefem.results.records import Record
from cuefem.results.solved_design import time_history
from cuefem.scene import Outcome
from cuefem.show.charts import Axis, Chart, Curve, Shade, Tick, chart

MAX_EVENTS = 12
MIN_SHARE = 0.01  # of the normal impulse: near separation, where F_n is near 0, the contact state changes each step


def contact_section(outcome: Outcome) -> Record:
    """Charts over time, and their numbered events: number, time and text."""
    phases = _main_phases(outcome)
    events = list(_events(phases))
    t = np.linspace(0, outcome.duration, 401)
    ends = [to_display([phase.start, phase.end], "s").tolist() for phase in phases if phase.state.startswith("slip")]
    spans = [Shade(start, end, "slip") for start, end in ends]
    marks = [Tick(float(to_display(at, "s")), str(i + 1)) for i, (at, _) in enumerate(events)]
    time = Axis(with_heading("time", "s"), 0.0, float(to_display(outcome.duration, "s")))

    def draw(title: str, name: str, unit: str) -> Chart:
        lines = zip(time_history(outcome, name, t).items(), ("c1", "c2"), strict=True)
        curves = [Curve(label, to_display(t, "s"), to_display(values, unit), style) for (label, values), style in lines]
        return chart(title, curves, x=time, y=Axis(with_heading(name, unit)), spans=spans, marks=marks)

    return {
        "charts": [
            draw("Force of the tip on the ball", "force", "N"),
            draw("Velocity of the ball relative to the tip", "velocity", "m/s"),
        ],
        "events": [(str(i + 1), f"{to_display(at, 's'):.4f} ms", text) for i, (at, text) in enumerate(events)],
    }


def _main_phases(outcome: Outcome) -> list[Phase]:
    """The phases of a contact with at least `MIN_SHARE` of its normal impulse; equal neighbours are merged."""
    whole = sum(abs(phase.impulse[1]) for phase in outcome.phases)
    main: list[Phase] = []
    for phase in outcome.phases:
        small = phase.state in ("stick", "slip", "slip back") and abs(phase.impulse[1]) < MIN_SHARE * whole
        if main and (small or (phase.state, phase.normal_phase) == (main[-1].state, main[-1].normal_phase)):
            main[-1] = main[-1]._replace(end=phase.end)
        else:
            main.append(phase)
    return main


def _events(phases: Sequence[Any]) -> Iterator[tuple[float, str]]:
    """Time, s, and text of each change of phase: the first `MAX_EVENTS`, and separation."""
    yield phases[0].start, "first touch, the tip slips" if phases[0].state != "stick" else "first touch, the tip sticks"
    for before, after in islice(pairwise(phases), MAX_EVENTS):
        yield after.start, _change_text(before, after)
    yield phases[-1].end, "separation"


def _change_text(before: Any, after: Any) -> str:
    grips = {"stick": "the tip sticks", "slip": "the tip slips", "slip back": "the tip slips back"}
    presses = {"load": "indentation beyond its former maximum", "unload": "maximum indentation"}
    changes = [presses.get(after.normal_phase, after.normal_phase)] if after.normal_phase != before.normal_phase else []
    changes += [grips.get(after.state, after.state)] if after.state != before.state else []
    return ", ".join(changes) or "unchanged"
