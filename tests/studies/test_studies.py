"""Every study of studies/: its page is what its program gives, its figures can be drawn, and the index names it
(regression)."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import matplotlib as mpl
import pytest

from studies import pages
from studies.pages import STUDIES, Again, Study, disagreements
from tests.helpers.study_tables import after, row

mpl.use("Agg")
PROGRAMS = sorted(path for path in STUDIES.rglob("*.py") if re.search(r"^STUDY = ", path.read_text("utf-8"), re.M))
STUDY = {path.stem: import_module(".".join(path.relative_to(STUDIES.parent).with_suffix("").parts)).STUDY
         for path in PROGRAMS}  # fmt: skip
INDEX = (STUDIES / "README.md").read_text(encoding="utf-8")
SUBJECTS = {"article", "paper", "beam", "contact", "end_mass", "design", "measured", "accuracy"}


def parts() -> Iterator[object]:
    for name, study in STUDY.items():
        for words, part in study.parts.items():
            marks = [pytest.mark.heavy] if part.heavy else []
            yield pytest.param(study, part, id=f"{name}: {words}", marks=marks)


def not_committed(page: str, derived: str) -> list[str]:
    """Lines of a derived part of a page that do not stand in it in this order; empty where all do.

    A number may be one off in its last printed place, as in `studies.pages.disagreements`.
    """
    left, missing = page.splitlines(), []
    for line in derived.splitlines():
        place = next((i for i, other in enumerate(left) if not disagreements(other, line)), None)
        if place is None:
            missing.append(line)
        else:
            left = left[place + 1 :]
    return missing


def between(page: str, since: str, until: str) -> str:
    """The part of a page from one line on to before another, each told by its beginning."""
    first = page.index(f"\n{since}") + 1 if since else 0
    last = page.index(f"\n{until}", first) if until else len(page)
    return page[first:last].rstrip("\n")


@pytest.mark.parametrize(("study", "part"), list(parts()))
def test_a_page_is_what_its_study_gives(study: Study, part: Again, monkeypatch: pytest.MonkeyPatch) -> None:
    module = sys.modules[f"studies.{study.path.parent.name}.{study.path.stem}"]
    for name, value in part.instead.items():
        monkeypatch.setattr(module, name, value)
    committed, derived = between(study.committed, part.since, part.until), part.text().rstrip("\n")
    if part.left_out is None:  # the lines stand together
        lines, count = committed.splitlines(), len(derived.splitlines())
        blocks = ("\n".join(lines[i : i + count]) for i in range(len(lines) - count + 1))
        assert any(not disagreements(block, derived) for block in blocks), derived
    else:
        assert len(committed.splitlines()) - len(derived.splitlines()) == part.left_out
        assert not_committed(committed, derived) == []


@pytest.mark.parametrize(
    "study",
    [
        pytest.param(study, id=name, marks=[pytest.mark.heavy] if study.heavy else [])
        for name, study in STUDY.items()
        if study.drawn
    ],
)
def test_figures_are_drawn(study: Study, tmp_path: Path) -> None:
    for name, figure in study.figures.items():
        figure.save(tmp_path / name)
        assert 0 < (tmp_path / name).stat().st_size < 350_000


@pytest.mark.parametrize("name", [name for name, study in STUDY.items() if study.predicted])
def test_predictions_stand_beside_what_was_found(name: str) -> None:
    page = after(STUDY[name].committed, pages.LEATHER)
    for number, said in STUDY[name].predicted.items():
        cells = row(page, number)
        assert cells[1] == said
        assert cells[2]


@pytest.mark.parametrize("name", STUDY)
def test_what_a_study_writes_is_committed_and_in_the_index(name: str) -> None:
    study = STUDY[name]
    written = [
        *study.figures,
        *([f"{name}.md"] if study.page else []),
        *([f"{name}_seconds.md"] if study.seconds else []),
    ]
    assert [file for file in written if not study.path.with_name(file).exists()] == []
    home = study.path.parent.name
    for file in (f"{name}.py", *written):
        assert f"({home}/{file})" in INDEX


def test_every_subject_holds_its_studies_and_nothing_else_lies_about() -> None:
    assert {path.parent.name for path in PROGRAMS} == SUBJECTS
    assert {path.name for path in STUDIES.glob("*.py")} == {"pages.py", "strokes.py"}
    written = {path.with_name(file) for path in PROGRAMS for file in STUDY[path.stem].figures}
    written |= {path.with_name(f"{path.stem}{end}.md") for path in PROGRAMS for end in ("", "_seconds")}
    loose = {path for home in SUBJECTS for path in (STUDIES / home).iterdir() if path.suffix in (".md", ".svg", ".png")}
    assert {path.name for path in loose - written} == {"README.md"}


def test_every_link_of_the_index_is_there() -> None:
    links = re.findall(r"\]\(([^)#]+)\)", INDEX)
    assert [link for link in links if not link.startswith("http") and not (STUDIES / link).exists()] == []


def test_studies_do_not_reach_into_the_contact() -> None:
    """But for the one door of studies/strokes.py, and for the two that ask what its steps and its laws leave out."""
    inner = {}
    for path in STUDIES.rglob("*.py"):
        tree = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        named = {node.module for node in tree if isinstance(node, ast.ImportFrom) and node.module}
        if found := {name for name in named if name.startswith("cuefem.contact")}:
            inner[path.name] = found
    assert inner.pop("strokes.py") == {"cuefem.contact.strike"}
    assert set(inner) == {"leather_tip.py", "left_out.py"}


def test_a_changed_number_of_a_committed_page_is_found() -> None:
    page = STUDY["energy"].committed
    assert len(disagreements(page.replace("| 61.74 |", "| 61.77 |"), page)) == 1
    assert len(not_committed(page.replace("late stick", "stick", 1), page)) == 1


def test_tables_print_text_as_it_is_and_numbers_with_the_digits_asked_for() -> None:
    assert pages.table(["a", "b"], [["x", 1 / 3], ["y", 2e-9]], 3) == (
        "| a | b |\n|---|---|\n| x | 0.333 |\n| y | 2e-09 |\n"
    )


def test_one_looks_for_a_part_where_it_says() -> None:
    page = "a\n\n## b\n1\n2\n\n## c\n3\n"
    assert between(page, "## b", "## c") == "## b\n1\n2"
    assert between(page, "", "") == page.rstrip("\n")
