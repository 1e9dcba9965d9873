"""Commands and calls: the table of README and handbook, and made-up questions (properties)."""

import inspect
import re
from pathlib import Path

import pytest

import cuefem as cf
from cuefem.cli import listed_commands
from cuefem.show.analysis import Answer

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "cuefem" / "handbook" / "working.md"]


def table(page: Path) -> list[list[list[str]]]:
    """The names in code of every cell of the table of commands, calls and results."""
    rows = page.read_text(encoding="utf-8").partition("| command | call | result |\n")[2].partition("\n\n")[0]
    return [[re.findall("`([^`]*)`", cell) for cell in row.strip("|").split("|")] for row in rows.splitlines()[1:]]


def kinds(kind: type) -> set[str]:
    """The names of all answers."""
    return {name for other in kind.__subclasses__() for name in {other.__name__, *kinds(other)}}


def returned(name: str) -> set[str]:
    """The answers that a public function returns, by its annotation; those of a study by their common class."""
    annotation = str(inspect.signature(getattr(cf, name)).return_annotation)
    found = {each.strip() for each in annotation.split("|")} & kinds(Answer)
    return {"SweepResult", "ScatterResult", "OptimumResult"} if found == {"StudyResult"} else found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_table_lists_every_command_every_call_and_its_result(page: Path) -> None:
    rows = table(page)
    assert {command.split()[0] for row in rows for command in row[0]} == set(listed_commands())
    called = {match[1] for row in rows for call in row[1] if (match := re.match(r"cf\.(\w+)\(", call))}
    functions = {name for name in dir(cf) if inspect.isfunction(getattr(cf, name))}
    assert called == {name for name in functions if returned(name)} | {"load", "save"}
    for _, calls, results in rows:
        names = [call.removeprefix("cf.").partition("(")[0] for call in calls]
        if results:
            assert set(results) <= set().union(*map(returned, names))
        assert len(results) >= len(names) or names == ["load", "save"]


def test_table_of_readme_and_handbook_is_one() -> None:
    first, other = map(table, PAGES)
    assert first == other
