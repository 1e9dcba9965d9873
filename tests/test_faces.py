"""What terminal, JSON and page show of two scenes, against golden files; `--update` writes them anew (regression).

A number may be one off in its last place, of JSON 1e-6 of itself: it must not hang on another machine's digits.
"""

import html
import itertools
import json
import re
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.command_line import call

ROOT = Path(__file__).parents[1]
GOLDEN = ROOT / "tests" / "golden"
SCENES = {"kim": "studies/scenes/kim.toml", "pool": "meshes/pool_hollow.toml"}  # a bare strike; all of a usual one
FACES = {
    "report.txt": ["report"],
    "report.json": ["report", "--json"],
    "page.txt": ["report", "-o", "page.html"],
    "strike.txt": ["strike"],
    "end_mass.txt": ["end-mass"],
    "modes.txt": ["modes", "--near", "250"],
}
HEAVY = {"effects.txt": ["effects"], "improve.txt": ["improve"], "check.txt": ["check"]}
NUMBER = re.compile(r"(?<![\w.])[-+−]?\d+(?:\.\d+)?(?:e[-+]\d+)?")


def words_of(page: str) -> str:
    """The text of a page: a line a text, without script, style and the scales of charts."""
    body = re.sub(r"<(style|script|svg|head).*?</\1>", "", page, flags=re.DOTALL)
    return "\n".join(line for part in re.split(r"<[^>]*>", body) if (line := html.unescape(part).strip())) + "\n"


def place(number: str) -> float:
    """One in the last place of a number as it stands."""
    digits, _, power = number.partition("e")
    return 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))


def differences(kept: str, now: str) -> list[tuple[str, str]]:
    """Lines that differ by more than the last place of a number."""
    off = []
    for one, other in zip(kept.splitlines(), now.splitlines(), strict=False):
        pairs = list(zip(NUMBER.findall(one), NUMBER.findall(other), strict=False))
        near = (abs(float(a.replace("−", "-")) - float(b.replace("−", "-"))) < 1.01 * place(a) for a, b in pairs)
        if " ".join(NUMBER.sub("#", one).split()) != " ".join(NUMBER.sub("#", other).split()) or not all(near):
            off.append((one, other))
    return off


def same(kept: Any, now: Any, path: str = "") -> None:
    if isinstance(kept, dict):
        assert kept.keys() == now.keys(), path
        for key in kept:
            same(kept[key], now[key], f"{path}.{key}")
    elif isinstance(kept, list):
        assert len(kept) == len(now), path
        for i, (one, other) in enumerate(zip(kept, now, strict=True)):
            same(one, other, f"{path}[{i}]")
    elif isinstance(kept, float):
        assert now == pytest.approx(kept, rel=1e-6, abs=1e-9), path
    else:
        assert kept == now, path


EVERYDAY = [("kim", face) for face in (*FACES, "effects.txt") if face != "page.txt"] + [
    ("pool", face) for face in FACES if face not in ("page.txt", "report.txt")
]
SLOW = [(scene, face) for scene in SCENES for face in FACES | HEAVY if (scene, face) not in EVERYDAY]


@pytest.mark.parametrize(
    ("scene", "face"), [*EVERYDAY, *(pytest.param(*slow, marks=pytest.mark.heavy) for slow in SLOW)]
)
def test_a_face(face: str, scene: str, request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(ROOT)
    monkeypatch.setenv("COLUMNS", "110")
    for clock in ("perf_counter", "process_time"):
        ticks = itertools.count()
        monkeypatch.setattr(f"time.{clock}", ticks.__next__)  # every look is one second later
    command, *options = (FACES | HEAVY)[face]
    options = [str(tmp_path / option) if option == "page.html" else option for option in options]
    status, out, err = call(command, SCENES[scene], *options)
    assert (status, err) == (0, "")
    now = words_of((tmp_path / "page.html").read_text(encoding="utf-8")) if face == "page.txt" else out
    now = re.sub(r"\n +not tried: [^\n]*", "", now)  # tests make effects up
    golden = GOLDEN / f"{scene}_{face}"
    if request.config.getoption("--update"):
        golden.write_text(now, encoding="utf-8")
    kept = golden.read_text(encoding="utf-8")
    if face.endswith(".json"):
        same(json.loads(kept), json.loads(now))
    else:
        assert differences(kept, now) == []
        assert len(kept.splitlines()) == len(now.splitlines())
