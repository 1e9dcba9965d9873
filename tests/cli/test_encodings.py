"""Output in encodings that lack characters: all lines are printed, status 0."""

import io
import json
from contextlib import redirect_stdout
from pathlib import Path

import pytest

from cuefem.cli import main
from tests.helpers.command_line import stdout_of

ALWAYS = ("cp1252", "ascii")  # of Windows; and the one that lacks most characters
OTHERS = ("utf-8", "cp850", "cp932", "gbk", "latin-1")
ENCODINGS = (*ALWAYS, *(pytest.param(name, marks=pytest.mark.heavy) for name in OTHERS))


def printed(encoding: str, *arguments: str) -> str:
    """What a command with exit status 0 writes to a stdout of an encoding."""
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    with redirect_stdout(stream), pytest.raises(SystemExit) as exit_:
        main([*arguments])
    stream.flush()
    assert exit_.value.code == 0
    content = stream.buffer
    assert isinstance(content, io.BytesIO)
    return content.getvalue().decode(encoding)


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize("arguments", [("parts",), ("guide", "measured", "--print")])
def test_command_prints_all_lines_in_every_encoding(encoding: str, arguments: tuple[str, ...]) -> None:
    lines = printed(encoding, *arguments).splitlines()
    assert len(lines) == len(stdout_of(*arguments).splitlines())
    assert encoding == "utf-8" or "?" not in "".join(lines).replace("?", "", stdout_of(*arguments).count("?"))


def test_json_in_ascii_equals_json_in_unicode() -> None:
    arguments = ("guide", "glossary", "--json")
    assert json.loads(printed("ascii", *arguments)) == json.loads(printed("utf-8", *arguments))
    assert "σ" in printed("utf-8", *arguments)


def test_lacking_characters_are_spelt_in_ascii() -> None:
    text = printed("ascii", "guide", "glossary", "--print")
    assert "sigma" in text


@pytest.mark.parametrize("command", ["modes", "end-mass", pytest.param("compare", marks=pytest.mark.heavy)])
def test_control_characters_of_file_names_are_escaped(command: str, tmp_path: Path) -> None:
    path = tmp_path / "kim\x1b[31m\u202e.toml"
    path.write_text(Path("meshes/kim.toml").read_text(encoding="utf-8"), encoding="utf-8")
    others = ("meshes/kim.toml",) if command == "compare" else ()
    text = stdout_of(command, path, *others)
    assert "\\x1b[31m\\u202e" in text
    assert [character for character in text if character in "\x1b\u202e"] == []
