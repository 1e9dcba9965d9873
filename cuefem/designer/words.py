"""The words of the designer's page: its head, and the explanation at its foot."""

from __future__ import annotations

from html import escape

from cuefem.designer.design import Design
from cuefem.designer.unit_system import METRIC, UnitSystem
from cuefem.report.record import scene_record
from cuefem.report.scene_words import assumptions, effect_words, plain_cue_line
from cuefem.report.unusual import unusual

MEASURED = ("measured on such cues: ", "no measurement known")  # so notes begin that are no assumptions


def head_markup(design: Design, system: UnitSystem = METRIC) -> str:
    """The head of the page: the design's name, and the cue, the stroke and the effects in words."""
    scene = design.scene
    facts = [plain_cue_line(scene.cue), assumptions(scene_record(scene))]
    facts += [f"with {', '.join(map(effect_words, scene.effects))}"] if scene.effects else []
    assumed = [note for note in design.notes if not note.startswith(MEASURED)]
    facts += [f"assumed: {'; '.join(assumed)}"] if assumed else []
    facts += [note for note in design.notes if note.startswith(MEASURED)]
    facts += [f"unusual: {remark}" for remark in unusual(scene)]
    lines = "".join(f'<p class="fact">{escape(system.said(fact))}</p>' for fact in facts)
    return f'<p class="kind">cuefem designer</p><h1>{escape(design.name)}</h1>{lines}'


ABOUT = """<p>The numbers are the same as those of <code>cuefem strike</code>, <code>end-mass</code> and
<code>modes</code> for the saved file. An [accuracy] table of the opened file is not saved. End mass m<sub>e</sub>
is how much mass the ball has to push aside at the tip; less of it means less squirt. &#8220;Stick&#8221; means that
the tip does not slip on the ball.</p>"""
