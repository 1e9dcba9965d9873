"""CONTRIBUTING.md: names exist, recipes list every file, and its own rules hold (properties).

tests/test_extensions.py runs the code of its recipes.
"""

import re
from functools import cache
from pathlib import Path

import pytest

from cuefem.analysis import QUESTIONS
from cuefem.effects.effect import effect_kinds
from cuefem.quantity.fields import quantity_fields
from tests.helpers.contributors_guide import GUIDE, ROOT, recipe
from tests.helpers.sources import PACKAGE

CODE = re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", GUIDE, flags=re.DOTALL))
# Of other programs, or made up.
FOREIGN = {
    "cc",
    "ziglang",
    "site/index.html",
    "cf.Collar",
    "cf.NAME",
    "tests/golden/refused_ROOM.txt",
    "tests/golden/tube_NAME_section.txt",
    "raise",
    "v5",
    "pypa/cibuildwheel",
}
SHARE = 0.5  # of lines in tests over those of a room
OWN = {name: kind for name, kind in effect_kinds().items() if kind.__module__.startswith("cuefem.")}
EFFECTS = [
    name for name, kind in OWN.items() if quantity_fields(kind) and name != "LeatherTip"
]  # a strategy of its own


DEFINITION = re.compile(r"\b(?:def|class) (\w+)|^(\w+)(?:: | = )|^    (\w+): |[(,] ?(\w+): ", re.MULTILINE)


@cache
def defined_names() -> set[str]:
    """Names that package, kernel and tests define: functions, classes, fields, arguments and constants."""
    names: set[str] = set()
    for path in [*PACKAGE.rglob("*.py"), *(ROOT / "tests").rglob("*.py")]:
        names |= {name for found in DEFINITION.findall(path.read_text(encoding="utf-8")) for name in found}
    for path in PACKAGE.rglob("*.h"):
        names |= set(re.findall(r"\w+", path.read_text(encoding="utf-8")))
    return names


def exists(name: str) -> bool:
    """Whether a word in backticks names a path, or something that the package or its tests define."""
    if not re.fullmatch(r"[\w./*]+", name):
        return True  # a command or an example
    found = [*ROOT.glob(name), *PACKAGE.glob(name), *PACKAGE.glob(f"{name}.py"), *(ROOT / "tests").rglob(name)]
    is_path = "/" in name or name.endswith((".py", ".toml", ".txt", ".json"))
    return bool(found) or (not is_path and name.rpartition(".")[2] in defined_names() | MARKERS)


MARKERS = set(re.findall(r'^  "(\w+): ', (ROOT / "pyproject.toml").read_text(encoding="utf-8"), flags=re.MULTILINE))


def test_names_in_backticks_exist() -> None:
    assert [name for name in CODE if name not in FOREIGN and not exists(name)] == []
    assert not exists("tests/made_up.py")
    assert not exists("made_up_name")


@pytest.mark.parametrize(
    ("title", "names"),
    [("An effect", EFFECTS), ("A question about a scene", [question.call for question in QUESTIONS.values()])],
)
def test_files_of_a_recipe_hold_what_there_is(title: str, names: list[str]) -> None:
    """Whoever adds one touches the files that hold the others; a question is not in pages of other commands."""
    files = {name for name in re.findall(r"`([\w./]+\.(?:py|pyi|md))`", recipe(title)) if "effects/" not in name}
    assert len(files) == 3
    texts = {name: (ROOT / name).read_text(encoding="utf-8") for name in files}
    pairs = [(name, file) for name in names for file in texts]
    assert "\n".join(f"{file} lacks {name}" for name, file in pairs if not re.search(rf"\b{name}\b", texts[file])) == ""


def lines(folder: Path, *left_out: str) -> int:
    """Lines of Python and C, without blank ones and comments."""
    paths = [path for kind in ("*.py", "*.[ch]") for path in folder.rglob(kind) if path.name not in left_out]
    texts = [path.read_text(encoding="utf-8") for path in paths]
    return sum(line.strip() != "" and line.strip()[0] not in "#/*" for text in texts for line in text.splitlines())


ROOMS = sorted(path.name for path in (ROOT / "tests").iterdir() if [*(PACKAGE / path.name).glob("*.py")])


@pytest.mark.parametrize("room", [room for room in ROOMS if room != "handbook"])
def test_room_has_tests_within_its_share(room: str) -> None:
    tests = lines(ROOT / "tests" / room, "test_invalid_input.py")
    assert tests <= SHARE * lines(PACKAGE / room)
