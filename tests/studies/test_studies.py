"""Studies: each page equals the output of its program, and the index lists it (regression)."""

import re
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.results.uncertainty import MASS_ERROR, MODEL_ERROR, SHAFT_ERROR, SPRING_ERROR
from studies.measured import calibration, two_balls, uncertainty
from studies.pages import IN_PYTHON, STUDIES, Study, disagreements
from studies.strokes import cue, full_model, pool_stroke

# Studies whose page takes more than 10 s of processor time; `.ci/nightly` computes them again.
NIGHTLY = ("accuracy", "distribution", "fronts", "games", "leather", "miscue_limit", "solid")
NIGHTLY += ("article", "scatter")
# Studies of few sums and no search, whose pages are equal: one unit in a last digit is a stale number.
SMOOTH = ("chain", "definitions", "kim")
PROGRAMS = sorted(path for path in STUDIES.rglob("*.py") if re.search(r"^STUDY = ", path.read_text("utf-8"), re.M))
STUDY: dict[str, Study] = {
    path.stem: import_module(".".join(path.relative_to(STUDIES.parent).with_suffix("").parts)).STUDY
    for path in PROGRAMS
}
INDEX = (STUDIES / "README.md").read_text(encoding="utf-8")


@pytest.mark.heavy
@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.nightly] if name in NIGHTLY else [])
        for name, study in STUDY.items()
        if not study.seconds
    ],
)
def test_study_page_equals_its_program(name: str) -> None:
    page = STUDY[name].page()
    assert disagreements(STUDY[name].committed, page) == []
    assert page == STUDY[name].committed or name not in SMOOTH


@pytest.mark.heavy
@pytest.mark.parametrize("name", STUDY)
def test_study_example_prints_what_its_page_shows(name: str) -> None:
    _, head, section = STUDY[name].committed.partition(IN_PYTHON)
    assert disagreements(head + section, STUDY[name].in_python()) == []
    assert 5 <= len(STUDY[name].example.splitlines()) <= 12


@pytest.mark.parametrize("name", STUDY)
def test_study_page_has_question_answer_and_index_entry(name: str) -> None:
    study = STUDY[name]
    lines = study.committed.partition(IN_PYTHON)[0].rstrip().splitlines()
    assert lines[0].startswith("# ")
    assert lines[2].startswith("**Question.** ")
    assert lines[4].startswith("**Answer.** ")
    assert len(lines) <= 80 or name == "kim"  # one line a claim
    assert f"({study.path.parent.name}/{name}.md)" in INDEX
    for figure in study.figures:
        assert study.path.with_name(figure).exists()
        assert "<text" in study.path.with_name(figure).read_text("utf-8")


def test_study_of_own_stroke_rejects_other_scenes() -> None:
    base = full_model(cue("pool_maple"))
    carom = replace(base, ball=replace(base.ball, radius=0.03075))
    heavy = replace(base, ball=replace(base.ball, mass=0.7))
    lumped = replace(base, cue=cf.LumpedCue(0.5, 0.008), effects=())
    for scene, first in ((lumped, "cue is"), (carom, "ball.radius"), (heavy, "ball.mass")):
        with pytest.raises(ValueError, match=f"^{first}"):
            pool_stroke(scene)


@pytest.mark.heavy
def test_stored_makers_are_those_of_the_package() -> None:
    """To a hundredth of a standard deviation: the stored makers come from interpolated strikes."""
    for row in calibration.ROWS[:2]:
        made, stored = calibration.maker(row, 0), calibration.stored()[row.name][0]
        assert made.off == pytest.approx(stored.off, abs=0.01 * made.stated)
        assert made.stated == pytest.approx(stored.stated, rel=0.01)


@pytest.mark.heavy
def test_two_measured_balls_are_compared_with_both_predictions(tmp_path: Path) -> None:
    light, heavy = tmp_path / "light", tmp_path / "heavy"
    for folder, grams in ((light, 156), (heavy, 200)):
        folder.mkdir()
        cf.save(cf.load_cue("plain maple"), folder / "cue.toml")
        (folder / "measured.toml").write_text(f'[ball]\nmass = "{grams} g"\n', "utf-8")
    table = "offset,speed [m/s],left [deg],right [deg],error [deg]\n0.3,2,{0},{0},0.01\n"
    for folder, squirt in ((light, 2.0), (heavy, 1.62)):
        (folder / "squirt.csv").write_text(table.format(squirt), "utf-8")
    assert two_balls.result(str(light), str(heavy)).endswith("nearer to an end mass")
    with pytest.raises(ValueError, match="at least 5 % more"):
        two_balls.result(str(light), str(light))


@pytest.mark.heavy
def test_model_errors_agree_with_published_series() -> None:
    """The constants are the upper ends of the study's intervals."""
    errors = [uncertainty.model_error(model).high for model in ("full model", "bare tip")]
    constants = [MODEL_ERROR, SPRING_ERROR, SHAFT_ERROR, MASS_ERROR]
    assert [*errors, *uncertainty.ratio_errors()] == pytest.approx(constants, abs=5.1e-3)


@pytest.mark.heavy
def test_uncertainty_covers_published_rows() -> None:
    """At least 68 % of published squirts and of two shafts; the series of 3 g has fewer, as the page states."""
    within = {name: (inside, rows) for name, rows, inside, _ in uncertainty.coverage()}
    cues = [pair for name, pair in within.items() if " g on a shaft" not in name]
    inside, rows = map(sum, zip(*cues, strict=True))
    assert rows == 13
    assert inside / rows > 0.68
    assert within["11 g on a shaft"][0] / within["11 g on a shaft"][1] > 0.68
    assert f"| all | {sum(n for n, _ in within.values())} of 44 |" in uncertainty.STUDY.committed
