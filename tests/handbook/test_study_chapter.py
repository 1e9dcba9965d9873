"""The chapter on studies: examples load and run, every key and response is listed (regression)."""

import re
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.designs import study_file
from cuefem.designs.study_file import load_study
from cuefem.files.schema import keys_of
from cuefem.handbook import chapters
from cuefem.results.computable_results import computable_results

(TEXT,) = (chapter.text for chapter in chapters() if chapter.name == "study")
EXAMPLES = {
    kind: re.findall(r"```toml\n(.*?)```", TEXT.partition(f"\n## {title}\n")[2].partition("\n## ")[0], re.DOTALL)
    for kind, title in (("sweep", "Sweep"), ("scatter", "Tolerance analysis"), ("optimum", "Optimum"))
}
KINDS = {"sweep": "Study", "scatter": "Scatter", "optimum": "Problem"}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    cf.save(cf.load(Path(__file__).parents[2] / "meshes" / "pool_hollow.toml"), tmp_path / "my_cue.toml")
    for kind, (text, *_) in EXAMPLES.items():
        (tmp_path / f"{kind}.toml").write_text(text, encoding="utf-8")
    text, *_ = EXAMPLES["optimum"]
    front = text.replace("[[limit]]", 'against = "tip_stiffness"\ncount = 3\n\n[[limit]]', 1)
    (tmp_path / "front.toml").write_text(front, encoding="utf-8")
    return tmp_path


def test_study_chapter_examples_load_as_their_kinds(folder: Path) -> None:
    for kind, name in KINDS.items():
        assert type(load_study(folder / f"{kind}.toml")).__name__ == name
    first, sample = EXAMPLES["sweep"]
    sampled = first.replace("count = 6\n", "").replace("[[vary]]", f"{sample}\n[[vary]]", 1)
    (folder / "drawn.toml").write_text(sampled, encoding="utf-8")
    assert load_study(folder / "drawn.toml").size == 4096


def test_study_chapter_lists_every_key_and_response() -> None:
    tables_of = [value for name, value in vars(study_file).items() if name.endswith("Table")]
    keys = {f"`{key}`" for each in tables_of for key in keys_of(each)}
    tables = {"`vary`", "`sample`", "`tolerances`", "`objective`", "`limit`", "`resolution`"}
    assert sorted(key for key in keys - tables if key not in TEXT) == []
    assert sorted(key for key in tables if f"[{key[1:-1]}]" not in TEXT) == []
    assert [name for name in computable_results() if f"| `{name}" not in TEXT] == []


@pytest.mark.heavy
@pytest.mark.parametrize("code", re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL), ids=["front", "one call"])
def test_python_examples_of_study_chapter_run(folder: Path, code: str, capsys: pytest.CaptureFixture[str]) -> None:
    exec(compile(code.replace(", workers=2", ""), "example", "exec"), {"__name__": "example"})
    out = capsys.readouterr().out
    squirts = [float(squirt) for squirt in re.findall(r"^\d+\.0 (\S+) \{", out, re.MULTILINE)]  # "380.0 0.0227 {..."
    assert len(squirts) == (3 if "for low in" in code else 0)
    assert squirts == sorted(squirts)
