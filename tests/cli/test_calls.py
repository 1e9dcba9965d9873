"""Commands and calls: the table of the handbook (properties)."""

import inspect
import re
from pathlib import Path

import cuefem as cf
from cuefem.cli import listed_commands
from cuefem.show.analysis import Answer

ROOT = Path(__file__).parents[2]
LOADERS = {"load_cue", "load_scene", "save"}
PAGE = ROOT / "cuefem" / "handbook" / "working.md"


def table() -> list[list[list[str]]]:
    """The names in code of every cell of the table of commands, calls and results."""
    text = PAGE.read_text(encoding="utf-8").partition("| you want | command | call | result |\n")[2]
    rows = text.partition("\n\n")[0]
    return [[re.findall("`([^`]*)`", cell) for cell in row.split("|")[2:-1]] for row in rows.splitlines()[1:]]


def kinds(kind: type) -> set[str]:
    """The names of all answers."""
    return {name for other in kind.__subclasses__() for name in {other.__name__, *kinds(other)}}


def returned(name: str) -> set[str]:
    """The answers that a public function returns, by its annotation; those of a study by their common class."""
    annotation = str(inspect.signature(getattr(cf, name)).return_annotation)
    found = {each.strip() for each in annotation.split("|")} & kinds(Answer)
    return {"SweepResult", "ScatterResult", "OptimumResult"} if found == {"StudyResult"} else found


def test_table_lists_every_command_every_call_and_its_result() -> None:
    rows = table()
    assert {command.split()[0] for row in rows for command in row[0]} == set(listed_commands())
    called = {match[1] for row in rows for call in row[1] if (match := re.match(r"cf\.(\w+)\(", call))}
    functions = {name for name in dir(cf) if inspect.isfunction(getattr(cf, name))}
    assert called == {name for name in functions if returned(name)} | LOADERS
    for _, calls, results in rows:
        names = [call.removeprefix("cf.").partition("(")[0] for call in calls]
        if results:
            assert set(results) <= set().union(*map(returned, names))
        assert len(results) >= len(names) or {*names} == LOADERS
