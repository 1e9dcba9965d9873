"""A tap test of the design's shaft: what was heard, the wood that fits, and the doubts, as markup."""

from __future__ import annotations

from dataclasses import dataclass, replace
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from cuefem.designer.unit_system import UnitSystem
from cuefem.io.sound import load_recording
from cuefem.measured.fit import TapFit
from cuefem.measured.ringing import Ringing, ringing
from cuefem.measured.tones import HIGH, LOW, tones
from cuefem.measured.wood import TapTest
from cuefem.parts import with_material
from cuefem.report.charts import Axis, Curve, Mark, chart
from cuefem.report.tap_table import KINDS
from cuefem.report.templates import chart_markup
from cuefem.results.quantities import written
from cuefem.scene import Scene

DRAWN = 600  # points of the spectrum
DEEPEST = -90.0  # dB, of the spectrum


@dataclass(frozen=True)
class Tapped:
    """What a recording tells of a scene's shaft."""

    fit: TapFit
    heard: Ringing


def tapped(scene: Scene, content: bytes, mass: float | None) -> Tapped:
    """Fit the wood of a scene's shaft to the content of a .wav file; mass: of the shaft as it hung, kg, if weighed.

    ValueError or RuntimeError, in one line, if there is no sound to fit.
    """
    test = TapTest(scene.shaft, mass=mass, effects=scene.cue_effects)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "tap.wav"
        path.write_bytes(content)
        try:
            sound = load_recording(path)
        except ValueError as error:
            raise ValueError(str(error).replace(f"{folder}/", "")) from None
    heard = ringing(sound.samples, sound.rate)
    return Tapped(test.fit(tones(heard), heard.rate), heard)


def with_wood(scene: Scene, fit: TapFit) -> Scene:
    """The scene with the wood that was heard in the place of the one it has."""
    return replace(scene, cue=with_material(scene.shaft, fit.before, fit.wood))


def tapped_markup(tap: Tapped, system: UnitSystem) -> str:
    """The wood with its doubts, the spectrum, and the tones."""
    fit, heard = tap.fit, tap.heard
    doubts = "".join(f'<p class="wrong" role="alert">Doubt: {escape(line)}</p>' for line in fit.refusals)
    notes = "".join(f"<p>{escape(system.said(line))}</p>" for line in fit.notes)
    return f"{doubts}{_wood(fit)}{notes}{_spectrum(fit, heard)}{_tones(fit)}"


def _wood(fit: TapFit) -> str:
    rows = ""
    for name, error in zip(("E", "G", "rho"), fit.errors, strict=True):
        value, before = getattr(fit.wood, name), getattr(fit.before, name)
        cells = (written(name, value), f"± {written(name, error)}", written(name, before))
        label = {"E": "E, stiffness along the grain", "G": "G, stiffness in shear", "rho": "density"}[name]
        numbers = "".join(f"<td>{escape(cell)}</td>" for cell in cells)
        rows += f'<tr><th class="text" scope="row">{label}</th>{numbers}</tr>'
    head = "".join(f'<th scope="col">{words}</th>' for words in ("The wood", "as heard", "", "in the design"))
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>'


def _spectrum(fit: TapFit, heard: Ringing) -> str:
    size = heard.traces.shape[1]
    f = np.fft.rfftfreq(size, 1 / heard.rate)
    power = np.square(np.abs(np.fft.rfft(heard.traces))).sum(axis=0)
    last = min(HIGH, heard.rate / 2, 1.15 * max(match.tone.frequency for match in fit.matched))
    inside = (f >= LOW) & (f <= last)
    f, power = f[inside], power[inside]
    pieces = np.array_split(np.arange(len(f)), min(DRAWN, len(f)))
    top = np.array([power[piece].max() for piece in pieces])
    decibels = np.maximum(10 * np.log10(top / top.max() + 1e-12), DEEPEST)
    modes = [Mark(hertz, str(i)) for i, hertz in enumerate(fit.frequencies.tolist(), 1) if LOW <= hertz <= last]
    made = chart(
        "What was heard, and the modes of the fitted shaft by their numbers",
        [Curve("the sound", [f[piece[0]] for piece in pieces], decibels, "c1")],
        x=Axis("frequency, Hz", 0.0, float(last)),
        y=Axis("loudness, dB"),
        marks=modes,
    )
    return chart_markup(made, "spectrum")


def _tones(fit: TapFit) -> str:
    rows = ""
    for match in fit.matched:
        tone = match.tone
        mode = KINDS.get(tone.kind, "not of this shaft") if match.mode is None else f"mode {match.mode}"
        apart = f"{100 * (tone.frequency / match.frequency - 1):+.2f} %" if match.frequency else ""
        cells = (f"{tone.frequency:.2f} Hz", f"± {tone.error:.2g} Hz", mode, apart.replace("-", "−"))
        rows += "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>"
    head = "".join(f'<th scope="col">{words}</th>' for words in ("tone", "", "", "from the fitted shaft"))
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>'
