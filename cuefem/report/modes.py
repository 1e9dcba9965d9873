"""The modes of a cue: record and table."""

from __future__ import annotations

from rich.console import Group

from cuefem.beam.modes import modes
from cuefem.report.record import Record
from cuefem.report.table import table_of, with_caption
from cuefem.results.quantities import written
from cuefem.scene import Scene


def modes_record(scene: Scene, *, count: int, near: float | None) -> Record:
    """Frequencies and tip amplitudes of the scene's cue: the ``count`` lowest modes, or the ones nearest ``near`` Hz.

    "nearest": the one frequency nearest ``near``; None if ``near`` is.
    """
    found = modes(scene.shaft, count, near, effects=scene.cue_effects)
    amplitudes, _ = found.shape(0.0)
    nearest = None if near is None else min(found.frequencies.tolist(), key=lambda f: abs(f - near))
    return {
        "near": near,
        "nearest": nearest,
        "rigid": found.rigid,
        "frequencies": found.frequencies.tolist(),
        "tip_amplitudes": amplitudes.tolist(),
    }


def modes_table(record: Record) -> Group:
    """The modes of a free cue, or of a cue held by the scene's effects."""
    near = record["near"]
    title = "Bending modes" if near is None else f"Bending modes nearest {near:g} Hz"
    marked = [] if near is None else [""]
    table = table_of(title, ["frequency", "period", "tip amplitude", *marked], text_columns=0)
    for frequency, amplitude in zip(record["frequencies"], record["tip_amplitudes"], strict=True):
        period = f"{1e3 / frequency:.4g} ms"
        mark = ["nearest" if frequency == record["nearest"] else "" for _ in marked]
        table.add_row(written("frequencies", frequency), period, written("tip_amplitudes", amplitude), *mark)
    motions = "1 rigid motion" if record["rigid"] == 1 else f"{record['rigid']} rigid motions"
    caption = f"{motions} at 0 Hz not listed; tip amplitude: how far the tip moves in the mode, mass-normalised"
    return with_caption(table, caption)
