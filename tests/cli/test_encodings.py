"""Output in encodings that lack characters: all lines are printed, status 0."""

import io
import json
from contextlib import redirect_stdout
from pathlib import Path

import pytest

from cuefem.cli import main
from tests.helpers.command_line import as_json, stdout_of

ENCODINGS = ("cp1252", "cp932", "ascii")  # Windows in the West, Windows in Japan, and the smallest set


def printed(encoding: str, *arguments: str) -> str:
    """What a command with exit status 0 writes to a stdout of an encoding."""
    content = io.BytesIO()
    stream = io.TextIOWrapper(content, encoding=encoding)
    with redirect_stdout(stream), pytest.raises(SystemExit) as exit_:
        main([*arguments])
    stream.flush()
    assert exit_.value.code == 0
    return content.getvalue().decode(encoding)


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_glossary_loses_no_line_and_no_number_in_any_encoding(encoding: str) -> None:
    """What an encoding lacks is spelt, and escaped in JSON."""
    whole = stdout_of("guide", "glossary", "--print")
    text = printed(encoding, "guide", "glossary", "--print")
    assert len(text.splitlines()) == len(whole.splitlines())
    assert text.count("?") == whole.count("?")
    assert ("sigma" in text) == (encoding != "cp932")
    assert json.loads(printed(encoding, "guide", "glossary", "--json")) == as_json("guide", "glossary")


@pytest.mark.parametrize("command", ["modes", pytest.param("compare", marks=pytest.mark.heavy)])
def test_control_characters_of_file_names_are_escaped(command: str, tmp_path: Path) -> None:
    path = tmp_path / "kim\x1b[31m\u202e.toml"
    path.write_text(Path("meshes/kim.toml").read_text(encoding="utf-8"), encoding="utf-8")
    others = ("meshes/kim.toml",) if command == "compare" else ()
    text = stdout_of(command, path, *others)
    assert "\\x1b[31m\\u202e" in text
    assert [character for character in text if character in "\x1b\u202e"] == []
