"""Natural frequencies of bending and tip amplitudes: record and table."""

from __future__ import annotations

from cuefem.beam.modes import modes
from cuefem.results.records import ColumnEntry, Record, Table, tabulate
from cuefem.scene import Scene


def modes_record(scene: Scene, *, count: int, near: float | None) -> Record:
    """Natural frequencies, Hz, and tip amplitudes of the ``count`` lowest modes, or of those nearest ``near``, Hz.

    "nearest": the frequency nearest ``near``, or None.
    """
    bending = modes(scene.shaft, count, near, effects=scene.cue_effects)
    amplitudes, _ = bending.shape(0.0)
    nearest = None if near is None else min(bending.frequencies.tolist(), key=lambda f: abs(f - near))
    return {
        "near": near,
        "nearest": nearest,
        "rigid": bending.rigid,
        "frequencies": bending.frequencies.tolist(),
        "tip_amplitudes": amplitudes.tolist(),
    }


def tabulate_modes(record: Record) -> Table:
    """A row for each mode of the cue with the scene's effects on it."""
    near, nearest = record["near"], record["nearest"]
    rows = [
        {"frequency": frequency, "period": 1 / frequency, "at_tip": amplitude}
        for frequency, amplitude in zip(record["frequencies"], record["tip_amplitudes"], strict=True)
    ]
    columns: dict[str, ColumnEntry] = {
        "frequency": "{frequency:frequencies}",
        "period": "{period:s}",
        "tip amplitude": "{at_tip:tip_amplitudes}",
    }
    if near is not None:
        columns[""] = lambda row: "nearest" if row["frequency"] == nearest else ""
    motions = "1 rigid-body mode" if record["rigid"] == 1 else f"{record['rigid']} rigid-body modes"
    note = f"{motions} at 0 Hz not listed; tip amplitude: of the mass-normalised mode"
    title = "Natural frequencies" if near is None else f"Natural frequencies nearest {near:g} Hz"
    return tabulate(title, columns, rows, note, texts=())
