"""Every answer: one line of repr, strict JSON, a frame with units where it is a table (properties)."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import cuefem as cf
from cuefem.designs.sweep import SweepResult
from cuefem.show.analysis import Answer, Rows

KIM = Path(__file__).parents[2] / "studies" / "scenes" / "kim.toml"
ANSWERS: dict[str, Callable[[cf.Scene], Answer]] = {
    "verdict": cf.verdict,
    "squirt_curve": cf.squirt_curve,
    "reduction": cf.reduction,
    "natural_frequencies": cf.natural_frequencies,
    "end_masses": cf.end_masses,
    "strike_models": cf.strike_models,
    "contact_history": cf.contact_history,
    "cue_numbers": cf.cue_numbers,
    "parts": lambda scene: cf.parts(),
    "report": cf.report,
    "study": lambda scene: cf.study(
        cf.Study(scene, (cf.Vary("speed", cf.Span(1.0, 2.0, count=2)),), (cf.Response("ball_speed"),))
    ),
}
SLOW: dict[str, Callable[[cf.Scene], Answer]] = {
    "tip_impacts": lambda scene: cf.tip_impacts(cf.load_scene("plain maple")),
    "compare": lambda scene: cf.compare({"kim": scene, "maple": cf.load_scene("plain maple")}),
    "compare folder": lambda scene: cf.compare(KIM.parents[1] / "measured" / "stinger"),
    "estimate": lambda scene: cf.estimate(KIM.parents[1] / "measured" / "stinger"),
    "design_changes": cf.design_changes,
    "plays_like": lambda scene: cf.plays_like(scene, cf.with_parameters(scene, {"tip diameter": 0.0115})),
    "effect_sensitivity": cf.effect_sensitivity,
    "convergence_study": lambda scene: cf.convergence_study(scene, max_modes=12),
    "model_error": cf.model_error,
    "strike_table": lambda scene: cf.strike_table(scene, (1.0, 2.0)),
}
CASES = [*ANSWERS, *(pytest.param(name, marks=pytest.mark.heavy) for name in SLOW)]


@pytest.mark.parametrize("name", CASES)
def test_answer_has_short_repr_strict_json_and_frame(name: str) -> None:
    scene = cf.load_scene(KIM)
    answer = {**ANSWERS, **SLOW}[name](scene)
    text = repr(answer)
    assert 60 <= len(text) <= 350
    assert len(text.splitlines()) == 1
    record = json.loads(json.dumps(answer.to_dict(), allow_nan=False))
    for value in answer.values().values():
        if isinstance(value, dict | list):
            value.clear()
    assert json.loads(json.dumps(answer.to_dict(), allow_nan=False)) == record
    if not isinstance(answer, Rows | SweepResult):
        assert name in ("verdict", "report")
        return
    frame = answer.to_frame()
    assert len(frame) > 1
    assert frame.attrs["units"].keys() <= {*frame.columns}
    numbers = {column for column in frame.columns if frame[column].dtype.kind == "f"}
    assert numbers & frame.attrs["units"].keys() or {"unit", "kind"} & {*frame.columns}
    assert all(np.isfinite(frame[column].dropna()).all() for column in numbers)


def test_frame_without_pandas_is_refused_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    with pytest.raises(RuntimeError, match=r"^frames need pandas: pip install 'cuefem\[pandas\]'$"):
        cf.natural_frequencies(cf.load_scene(KIM)).to_frame()


@pytest.mark.heavy
def test_answers_in_one_notebook_share_no_id_script_or_frame() -> None:
    """Of a miscue, too, whose page does not exist: its numbers alone."""
    scene = cf.load_scene(KIM)
    miscue = cf.report(cf.with_parameters(scene, {"offset": 0.8}))
    for answer in (cf.reduction(scene), cf.report(scene), cf.compare({"a": scene, "b": scene}), miscue):
        markup = answer._repr_html_()
        assert markup.lstrip().startswith('<div class="cuefem">')
        assert markup.count("<style>") == 1
        assert not re.search(r"""<(iframe|script|html|body)\b|\sid=|clip-path=|prefers-color-scheme""", markup)
    assert miscue.no_squirt
