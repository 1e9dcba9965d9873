"""Imports: order of rooms, room of each heavy library, loading on demand (properties)."""

import ast
import re
import subprocess
import sys
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from tests.conftest import SOLVED_AT_COLLECTION
from tests.helpers.sources import PACKAGE, statements, trees

# The rooms in the order of CONTRIBUTING.md's table; a room imports only those before it.
TABLE = (PACKAGE.parent / "CONTRIBUTING.md").read_text(encoding="utf-8").partition("## Map")[2].partition("## How")[0]
ORDER = [name for rooms in re.findall(r"^\| (`.*?) \|", TABLE, re.M) for name in re.findall(r"`(\w+)", rooms)] + [
    "__main__"
]
HOMES = {
    "skfem": {"solid", "beam"},
    "meshio": {"files"},
    "matplotlib": {"show", "plot"},
    "pandas": {"quantity"},
    "pyarrow": {"designs"},
    "distributed": {"cli"},
    "pint": set(),
    "pydantic": set(),
    "pydantic_core": set(),
    "tomlkit": {"files"},
    "click": {"cli"},
    "rich": {"show", "cli"},
    "jinja2": {"show"},
    "markdown_it": {"handbook"},
    "sqlite3": {"designs"},
    "nicegui": {"designer"},
    "starlette": {"designer"},
}


def part_of(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def is_for_types(statement: ast.AST) -> bool:
    """Whether a statement does something for type checking alone."""
    return isinstance(statement, ast.If) and getattr(statement.test, "id", "") == "TYPE_CHECKING"


@cache
def for_types(tree: ast.Module) -> list[ast.stmt]:
    """What a file does for type checking alone."""
    return [inner for one in statements(tree) if is_for_types(one) for inner in statements(one)]


@cache
def walk(tree: ast.Module) -> list[ast.stmt]:
    """The statements of a file, except those for type checking."""
    skipped = {*for_types(tree)}
    return [one for one in statements(tree) if one not in skipped and not is_for_types(one)]


def out_of_order(part: str, tree: ast.Module) -> list[str]:
    """Imports of a file of ``part`` against the order, or of a library of another room."""
    wrong = []
    for name in (name for one in walk(tree) for name in loads(one)):
        top, _, rest = name.partition(".")
        inner = rest.partition(".")[0]
        if top == "cuefem" and inner and inner != part and ORDER.index(inner) >= ORDER.index(part):
            wrong.append(name)
        if part not in HOMES.get(top, {part}):
            wrong.append(name)
    return wrong


def test_imports_follow_package_order() -> None:
    """Each library in its rooms."""
    rooms = {path: tree for path, tree in trees().items() if path != PACKAGE / "__init__.py"}
    wrong = {path.name: out_of_order(part_of(path), tree) for path, tree in rooms.items()}
    assert {name: names for name, names in wrong.items() if names} == {}
    assert out_of_order("cue", ast.parse("from cuefem.beam import assemble")) == ["cuefem.beam"]
    assert out_of_order("scene", ast.parse("def f():\n    import pint")) == ["pint"]


def module_of(path: Path) -> str:
    """The name of a file's module."""
    steps = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(steps[:-1] if steps[-1] == "__init__" else steps)


@cache
def modules() -> dict[str, ast.Module]:
    """The modules of the package by their names."""
    return {module_of(path): tree for path, tree in trees().items()}


def loads(statement: ast.AST) -> set[str]:
    """The modules that a statement imports, also one that `lazy_loader` imports when it is used."""
    match statement:
        case ast.Import(names):
            return {alias.name for alias in names}
        case ast.ImportFrom(module, names, level):
            assert level == 0, "imports are absolute"
            parts = {f"{module}.{alias.name}" for alias in names} & modules().keys()
            return parts or {module or ""}
        case ast.Assign(value=ast.Call(ast.Attribute(attr="load"), [ast.Constant(str(name))])):
            return {name}
    return set()


def test_modules_of_package_have_no_circle() -> None:
    """Neither by imports at the top nor by those for types or inside functions."""
    needed = {
        module: {each for one in [*walk(tree), *for_types(tree)] for each in loads(one)}
        for module, tree in modules().items()
    }
    assert len(needed["cuefem.cli.request"] & modules().keys()) > 5
    graph = {module: (names & modules().keys()) - {module} for module, names in needed.items()}
    assert [*TopologicalSorter(graph).static_order()]  # CycleError names a circle


def test_no_two_classes_of_package_have_one_name() -> None:
    names = [one.name for tree in trees().values() for one in tree.body if isinstance(one, ast.ClassDef)]
    assert sorted(name for name in {*names} if names.count(name) > 1) == []


def test_collection_solves_nothing(request: pytest.FixtureRequest) -> None:
    """A broken core fails tests, and not their collection: what solves or strikes stands in a test or a fixture."""
    assert request.config.stash[SOLVED_AT_COLLECTION] == []


HEAVY = ["skfem", "scipy", "pint", "pydantic", "matplotlib", "meshio", "tomlkit", "rich", "click"]
# A command on a valid file in common units needs none of these, whose import takes several times as long as its work.
WORKED_ON = ["skfem", "scipy.sparse", "scipy.optimize", "pint", "pydantic", "tomlkit", "jinja2", "matplotlib"]


@pytest.mark.parametrize(
    ("statement", "light"),
    [
        ("import cuefem", ["numpy", *HEAVY]),
        ("import cuefem; cuefem.strike(cuefem.Scene(cuefem.LumpedCue(0.5, 0.006)))", HEAVY),
        pytest.param(
            "from tests.helpers.command_line import call; call('report', 'meshes/kim.toml')",
            WORKED_ON,
            marks=pytest.mark.heavy,
        ),
        ("import cuefem.cli", [name for name in ["numpy", *HEAVY] if name != "click"]),
    ],
)
def test_import_or_command_loads_no_unneeded_library(statement: str, light: list[str]) -> None:
    program = f"{statement}\nimport sys\nprint(sorted(set({light!r}) & sys.modules.keys()))"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, cwd=PACKAGE.parent, check=True
    )
    assert done.stdout.strip() == "[]"
