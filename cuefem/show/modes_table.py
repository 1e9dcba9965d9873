"""Natural frequencies of bending and tip amplitudes: record and table."""

from __future__ import annotations

from cuefem.beam.modes import modes
from cuefem.results.records import ColumnEntry, Record, Table, tabulate
from cuefem.scene import Scene


def modes_record(scene: Scene, *, count: int, near: float | None) -> Record:
    """Natural frequencies and tip amplitudes of the ``count`` lowest bending modes, or of those nearest ``near``, Hz.

    "frequencies", Hz; "tip_amplitudes", kg^-1/2, of mass-normalised modes; "rigid", the number of rigid-body modes;
    "nearest_frequency", the frequency nearest ``near``, or None.
    """
    bending = modes(scene.shaft, count, near, effects=scene.cue_effects)
    amplitudes, _ = bending.shape(0.0)
    nearest = None if near is None else min(bending.frequencies.tolist(), key=lambda f: abs(f - near))
    return {
        "requested_frequency": near,
        "nearest_frequency": nearest,
        "rigid": bending.rigid,
        "frequencies": bending.frequencies.tolist(),
        "tip_amplitudes": amplitudes.tolist(),
    }


def tabulate_modes(record: Record) -> Table:
    """A row for each mode of the cue, with the scene's effects on the cue."""
    near, nearest = record["requested_frequency"], record["nearest_frequency"]
    rows = [
        {"frequency": frequency, "period": 1 / frequency, "tip_amplitude": amplitude}
        for frequency, amplitude in zip(record["frequencies"], record["tip_amplitudes"], strict=True)
    ]
    columns: dict[str, ColumnEntry] = {
        "frequency": "{frequency:frequencies}",
        "period": "{period:s}",  # in the display unit of s
        "tip amplitude": "{tip_amplitude:tip_amplitudes}",
    }
    if near is not None:
        columns[""] = lambda row: "nearest" if row["frequency"] == nearest else ""
    notes = ["tip amplitude: of the mass-normalised mode", "of the drawn part with its tip, without the butt"]
    if rigid := record["rigid"]:
        notes.insert(0, f"{rigid} rigid-body mode{'s' * (rigid > 1)} at 0 Hz not listed")
    title = "Natural frequencies" if near is None else f"Natural frequencies nearest {near:g} Hz"
    return tabulate(title, columns, rows, "; ".join(notes), texts=())
