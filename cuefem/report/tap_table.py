"""A tap test's results: record, sheets, and the spectrum with its tones."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np

from cuefem.contact.outcome import MISSED, grip_of
from cuefem.measured.chance import LEVEL
from cuefem.measured.fit import TapFit
from cuefem.measured.ringing import Ringing
from cuefem.measured.tones import HIGH, LOW
from cuefem.measured.wood import Predicted
from cuefem.report.figures import figure_content
from cuefem.report.strike_table import MISCUE
from cuefem.results.quantities import RESULTS, grams, written
from cuefem.results.records import Entry, Record, Sheet, sheet
from cuefem.scene import Outcome

UNITS = {
    **{"frequency": "Hz", "error": "as its number", "decay": "1/s", "clipped": "s", "mains": "Hz"},
    "level": "of a tone as recorded, of a hum in dB",
    "covariance": "of ln E, ln G/E, ln rho",
}
KINDS = {
    "faint": "too faint to tell",
    "steady": "steady hum",
    "harmonic": "sum of other tones?",
    "twin": "second plane of bending, beside a louder tone",
}


def tap_record(fit: TapFit, heard: Ringing, numbers: Mapping[str, Predicted], struck: Outcome) -> Record:
    """The wood, the tones and their modes, what the scene's numbers become; errors are standard deviations.

    struck: the scene's stroke with the fitted wood.
    """
    wood = {
        name: {"value": getattr(fit.wood, name), "error": error, "before": getattr(fit.before, name)}
        for name, error in zip(("E", "G", "rho"), fit.errors, strict=True)
    }
    return {
        "wood": wood | {"covariance": fit.covariance, "loss": fit.loss},
        "G_told": fit.told,
        "weighed": fit.weighed,
        "rivals": [{"E": E, "odds_against": odds} for E, odds in fit.rivals],
        "misfit": fit.misfit,
        "chance": fit.chance,
        "shear_coefficients": fit.shear_coefficients,
        "refusals": list(fit.refusals),
        "tones": [asdict(m.tone) | {"mode": m.mode, "model_frequency": m.frequency} for m in fit.matched],
        "shaft_mass": fit.cue.shaft_mass,
        "predicted": {name: asdict(number) for name, number in numbers.items()},
        "units": UNITS,
        "regime": struck.regime,
        "grip": grip_of(struck),
        "taps": heard.taps,
        "clipped": heard.clipped,
        "hum": None if heard.hum is None else asdict(heard.hum),
        "notes": [*fit.notes, *_clipping(heard), *_hum(heard)],
    }


def _hum(heard: Ringing) -> list[str]:
    if heard.hum is None:
        return []
    hum = heard.hum
    tones = ", ".join(f"{k * hum.mains:.0f}" for k in hum.multiples)
    return [f"a mains hum of {hum.mains:.2f} Hz, {hum.level:+.0f} dB of the rest, is taken out: {tones} Hz"]


def _clipping(heard: Ringing) -> list[str]:
    if not heard.clipped:
        return []
    return [f"clipped: the first {1e3 * heard.clipped:.0f} ms after the tap are left out; record with less gain"]


def tap_sheets(record: Record, about: Record) -> list[Sheet]:
    """The tones, the wood, and what it means."""
    return [_tones(record["tones"], record["taps"]), _wood(record), _numbers(record, about)]


def _tones(tones: Sequence[Record], taps: int) -> Sheet:
    strongest = max(tone["level"] for tone in tones)
    columns: dict[str, Entry] = {
        "tone": "{frequency:frequencies}",
        "±": "{error:.2g} Hz",
        "loss factor": lambda tone: f"{tone['decay'] / (np.pi * tone['frequency']):.4f}",
        "strength": lambda tone: f"{20 * np.log10(tone['level'] / strongest):.0f} dB",
        "mode": lambda tone: str(tone["mode"] or KINDS.get(tone["kind"], "not of this shaft")),
        "of the fitted shaft": "{model_frequency:frequencies}",
        "apart": "{apart:+.2 %}",
    }
    rows = [
        tone | {"apart": None if model is None else tone["frequency"] / model - 1}
        for tone, model in ((tone, tone["model_frequency"]) for tone in tones)
    ]
    said = f"{taps} tap" + ("s" if taps > 1 else "")
    return sheet("Tones", columns, rows, f"{said}; ±: one standard deviation of the tone as heard", texts=())


def _wood(record: Record) -> Sheet:
    wood = record["wood"]
    rows = []
    for name in ("E", "G", "rho"):
        value, error, before = (wood[name][key] for key in ("value", "error", "before"))
        part = f"{100 * error / value:.2g} %"
        rows.append((name, written(name, value), written(name, error), part, written(name, before)))
    notes = (
        f"the tones tell G times the shear coefficient; here {_shear(record['shear_coefficients'])}",
        f"loss factor {wood['loss']:.4f}, the median of the tones: the wood's own is at most that",
        f"{_share(record['chance'])} of random sets of tones fit this shaft as well",
        *(f"doubt: {doubt}" for doubt in record["refusals"]),
        *(f"note: {note}" for note in record["notes"]),
    )
    return Sheet("The wood", ("", "fitted", "±", "", "in the file"), tuple(rows), notes)


def _shear(ends: tuple[float, float]) -> str:
    least, most = (f"{coefficient:.3f}" for coefficient in ends)
    return f"a shear coefficient of {least}" if least == most else f"shear coefficients of {least} to {most}"


def _share(chance: float) -> str:
    return f"{100 * chance:.1f} % or less" if chance <= LEVEL else f"{100 * chance:.2g} %"


def _numbers(record: Record, about: Record) -> Sheet:
    words = {"end_mass": "end mass (stick)", "squirt": f"squirt at b/R {about['stroke']['offset']:g}"}
    entry = {"end_mass": grams, "squirt": lambda angle: f"{RESULTS['squirt'].scale * angle:.4f}°"}
    rows = (
        (words[name], *(entry[name](record["predicted"][name][key]) for key in ("value", "error", "before")))
        for name in words
    )
    missed = [MISCUE] if record["grip"] in MISSED else []
    note = "±: one standard deviation that comes from the wood; the error of the stroke's model is not in it"
    return Sheet("What follows", ("", "fitted", "±", "with the file's wood"), tuple(rows), (*missed, note))


def tap_figure(fit: TapFit, heard: Ringing, title: str, kind: str) -> bytes:
    """The spectrum with its tones and the fitted shaft's modes, as a file's content; kind: "png", "svg"."""

    def draw(_: Any, axes: Any) -> None:
        draw_spectrum(axes, fit, heard)
        axes.set_title(title)

    return figure_content(kind, draw, figsize=(9, 4.4))


def draw_spectrum(axes: Any, fit: TapFit, heard: Ringing) -> None:
    """The sound's power over frequency, the fitted shaft's modes as numbered lines, the tones marked on their peaks."""
    size = heard.traces.shape[1]
    f = np.fft.rfftfreq(size, 1 / heard.rate)
    power = np.square(np.abs(np.fft.rfft(heard.traces))).sum(axis=0)
    inside = (f >= LOW) & (f <= min(HIGH, heard.rate / 2))
    f, decibels = f[inside], 10 * np.log10(power[inside] / power[inside].max() + 1e-12)
    axes.semilogx(f, decibels, color="0.55", lw=0.6)
    low, high = np.quantile(decibels, 0.01) - 5, 14.0
    for number, mode in enumerate(fit.frequencies, start=1):
        if LOW <= mode <= f[-1]:
            axes.axvline(mode, color="C0", lw=0.6, ls=":")
            axes.annotate(
                str(number),
                (mode, high),
                xytext=(0, -10),
                textcoords="offset points",
                ha="center",
                fontsize=7,
                color="C0",
            )
    styles = {"mode": ("o", "C0", "tone of a mode"), "other": ("X", "C3", "other tone")}
    drawn = set()
    for match in fit.matched:
        style = "mode" if match.mode is not None else "other"
        mark, colour, label = styles[style]
        near = np.abs(f - match.tone.frequency) <= max(3 * match.tone.error, 2 * heard.rate / size)
        top = decibels[near].max() if near.any() else 0.0
        axes.plot(
            match.tone.frequency, top + 3, mark, color=colour, ms=6, mec="w", label=None if style in drawn else label
        )
        drawn.add(style)
    ticks = [tick for tick in (60, 100, 200, 500, 1000, 2000, 5000, 8000) if tick <= f[-1]]
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.minorticks_off()
    axes.set(xlim=(LOW, f[-1]), ylim=(low, high), xlabel="frequency, Hz", ylabel="power, dB (strongest 0)")
    axes.plot([], [], ":", color="C0", label="mode of the fitted shaft, by number")
    axes.legend(loc="lower left", fontsize=8)
