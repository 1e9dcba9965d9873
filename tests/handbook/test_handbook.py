"""The handbook: citations, lines of every effect, page and command (regression)."""

import json
import re
import webbrowser
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest

from cuefem.effects.effect import effect_kinds
from cuefem.handbook import CHAPTERS, LINES, chapters, effect_lines, sections_with
from cuefem.handbook.page import page
from tests.helpers.command_line import stdout_of

ROOT = Path(__file__).parents[2]
TITLES = {chapter.title for chapter in chapters()}
CITED = re.compile(r"[Hh]andbook:\s+([A-Z][^,;.:()\"`]+(?:,\s+[A-Z][^,;.:()\"`]+)*)")
SOURCES = sorted(
    path
    for folder in ("cuefem", "studies", "tests", "meshes")
    for path in (ROOT / folder).rglob("*")
    if path.suffix in (".py", ".md", ".toml") and path != Path(__file__)
)
# excludes effects that tests define
EFFECTS = {name: kind for name, kind in effect_kinds().items() if kind.__module__.startswith("cuefem.")}


@cache
def whole() -> str:
    return page()


def cited_wrongly(text: str) -> list[str]:
    """Citations in a text, and capitalized names after a comma, that do not begin with a chapter's title."""
    wrong = []
    for citation in CITED.findall(re.sub(r"\n\s*(?:# )?", "\n", text)):
        first, *others = (" ".join(part.split()) for part in citation.split(","))
        names = [first, *(other for other in others if other[:1].isupper())]
        wrong += [name for name in names if not any(name == title or name.startswith(title + " ") for title in TITLES)]
    return wrong


def test_every_citation_names_chapter() -> None:
    texts = {path: path.read_text(encoding="utf-8") for path in SOURCES}
    assert sum(len(CITED.findall(text)) for text in texts.values()) > 40
    assert {str(path): wrong for path, text in texts.items() if (wrong := cited_wrongly(text))} == {}


@pytest.mark.parametrize("name", EFFECTS)
def test_effects_chapter_has_five_lines_of_every_effect(name: str) -> None:
    lines = effect_lines(EFFECTS[name])
    assert tuple(lines) == LINES
    assert all(text.endswith(".") for text in lines.values())
    (text,) = (chapter.text for chapter in chapters() if chapter.name == "effects")
    section = text.partition(f"\n## {name}\n")[2].partition("\n## ")[0]
    assert [line for line in LINES if f"- **{line}:** {lines[line]}" not in section] == []
    assert f">{name}</h2>" in whole()


def test_handbook_page_is_self_contained_with_valid_links() -> None:
    text = whole()
    anchors, links = (re.findall(rf'\b(?:{name})="([^"]*)"', text) for name in ("id", "href|src"))
    assert len(anchors) == len(set(anchors))
    assert {link for link in links if not link.startswith("#")} == {"data:,"}
    assert {link[1:] for link in links if link.startswith("#")} | set(CHAPTERS) <= set(anchors)
    assert [title for title in TITLES if f">{title}</h1>" not in text] == []
    assert 'handbook: <a href="#beam">The beam</a>, <a href="#strike">The strike</a>, <a href="#effects">' in text


def test_formulas_are_text_in_terminal_and_mathml_on_page() -> None:
    formulas = sum(chapter.text.count("```math") for chapter in chapters())
    printed = "".join(stdout_of("guide", name, "--print") for name in ("beam", "contact"))
    assert formulas > 30
    assert "\\" not in printed + re.sub(r"<script>.*</script>", "", whole(), flags=re.DOTALL)
    assert "ν_e/(1 + ν_e) = 2 νG / E" in printed
    assert whole().count("<math ") == formulas
    assert sections_with("qquad") == ()


@pytest.mark.parametrize("has_browser", [True, False])
def test_guide_opens_prints_and_writes(has_browser: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opened, first = list[str](), list[str]()

    def opens(address: str) -> bool:
        opened.append(address)
        return has_browser

    def made(opens_with: str = "") -> str:
        first.append(opens_with)
        return whole()

    monkeypatch.setattr(import_module("cuefem.cli.guide_command"), "page", made)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(webbrowser, "open", opens)
    assert stdout_of("guide", "glossary").startswith("opened file:" if has_browser else "no browser found")
    (page_file,) = tmp_path.glob("cuefem-guide-*.html")
    assert opened == [f"{page_file.as_uri()}#glossary"]
    assert stdout_of("guide", "-o", tmp_path / "guide.html") == f"wrote {tmp_path / 'guide.html'}\n"
    assert first == ["", CHAPTERS[0]]
    assert page_file.read_text(encoding="utf-8") == (tmp_path / "guide.html").read_text(encoding="utf-8") == whole()
    printed = stdout_of("guide", "glossary", "--print")
    assert ("effective end mass" in printed, "Hutchinson" in printed) == (True, False)
    assert stdout_of("guide", "telephone").startswith("1 section with 'telephone'; cuefem guide CHAPTER opens one:\n")
    section_list = stdout_of("guide", "ferrule")
    assert re.match(r"\d\d sections with 'ferrule'; ", section_list)
    assert ("measure_your_shaft" in section_list, "impulse_solver" in section_list) == (True, False)
    listed = " ".join(stdout_of("guide", "--help").split())
    assert [name for name in CHAPTERS if name not in listed] == []


def test_guide_writes_one_chapter_as_json_and_opens_page_with_it(tmp_path: Path) -> None:
    stdout_of("guide", "beam", "-o", tmp_path / "beam.json")
    record = json.loads((tmp_path / "beam.json").read_text(encoding="utf-8"))
    assert (list(record), record["beam"].splitlines()[0]) == (["beam"], "# The beam")
    first = [text for text in page(opens_with="beam").split("<section") if text.startswith(' class="first"')]
    assert len(first) == 1
    assert 'id="beam"' in first[0]


def test_moves_of_a_step_are_those_of_the_kernel() -> None:
    """The table of the chapter The contact names the calls of `take_step` in their order."""
    chapter = (ROOT / "cuefem/handbook/contact.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (`[a-z_]+`(?:, `[a-z_]+`)*) \|", chapter, re.MULTILINE)
    source = (ROOT / "cuefem/contact/kernel/step.c").read_text(encoding="utf-8")
    body = source.split("\nbool take_step(")[1].split("\n}")[0].partition("{")[2]
    calls = [name for name in re.findall(r"\b(\w+)\(", body) if name != "memcpy"]
    assert re.findall(r"`(\w+)`", " ".join(rows)) == calls
