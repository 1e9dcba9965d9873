"""Terminal, JSON and page of two scenes against golden files; `--update` rewrites them (regression).

Tolerance: one unit in the last digit of a number, in JSON 1e-6 of its value, for other machines' round-off error.
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
SCENES = {"kim": "studies/scenes/kim.toml", "pool": "meshes/pool_hollow.toml"}  # a spring tip; a default stroke
OUTPUTS = {
    "report.txt": ["report"],
    "report.json": ["report", "--json"],
    "page.txt": ["report", "-o", "page.html"],
    "strike.txt": ["strike"],
    "end_mass.txt": ["end-mass"],
    "modes.txt": ["modes", "--near", "250"],
    "report_us.txt": ["report", "--units", "us"],
}
HEAVY = {"effects.txt": ["effects"], "improve.txt": ["improve"], "check.txt": ["check"]}
NUMBER = re.compile(r"(?<![\w.])[-+−]?\d+(?:\.\d+)?(?:e[-+]\d+)?")


def page_text(page: str) -> str:
    """The text of a page, one line an element, without script, style and charts."""
    body = re.sub(r"<(style|script|svg|head).*?</\1>", "", page, flags=re.DOTALL)
    return "\n".join(line for part in re.split(r"<[^>]*>", body) if (line := html.unescape(part).strip())) + "\n"


def last_place(number: str) -> float:
    """One unit in the last digit of a number."""
    digits, _, power = number.partition("e")
    return 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))


def differences(stored: str, now: str) -> list[tuple[str, str]]:
    """Lines that differ by more than one unit in the last digit of a number."""
    off = []
    for one, other in zip(stored.splitlines(), now.splitlines(), strict=False):
        pairs = list(zip(NUMBER.findall(one), NUMBER.findall(other), strict=False))
        close = (abs(float(a.replace("−", "-")) - float(b.replace("−", "-"))) < 1.01 * last_place(a) for a, b in pairs)
        if " ".join(NUMBER.sub("#", one).split()) != " ".join(NUMBER.sub("#", other).split()) or not all(close):
            off.append((one, other))
    return off


def assert_same_json(stored: Any, now: Any, path: str = "") -> None:
    if isinstance(stored, dict):
        assert stored.keys() == now.keys(), path
        for key in stored:
            assert_same_json(stored[key], now[key], f"{path}.{key}")
    elif isinstance(stored, list):
        assert len(stored) == len(now), path
        for i, (one, other) in enumerate(zip(stored, now, strict=True)):
            assert_same_json(one, other, f"{path}[{i}]")
    elif isinstance(stored, float):
        assert now == pytest.approx(stored, rel=1e-6, abs=1e-9), path
    else:
        assert stored == now, path


EVERYDAY = [("kim", output) for output in (*OUTPUTS, "effects.txt") if output != "page.txt"] + [
    ("pool", output) for output in OUTPUTS if output not in ("page.txt", "report.txt", "report_us.txt")
]
SLOW = [(scene, output) for scene in SCENES for output in OUTPUTS | HEAVY if (scene, output) not in EVERYDAY]


@pytest.mark.parametrize(
    ("scene", "output"), [*EVERYDAY, *(pytest.param(*slow, marks=pytest.mark.heavy) for slow in SLOW)]
)
def test_output_equals_golden_file(
    output: str, scene: str, request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: Any
) -> None:
    monkeypatch.chdir(ROOT)
    monkeypatch.setenv("COLUMNS", "110")
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    for clock in ("perf_counter", "process_time"):
        ticks = itertools.count()
        monkeypatch.setattr(f"time.{clock}", ticks.__next__)  # every reading is one second later
    command, *options = (OUTPUTS | HEAVY)[output]
    options = [str(tmp_path / option) if option == "page.html" else option for option in options]
    status, out, err = call(command, SCENES[scene], *options)
    assert (status, err) == (0, "")
    now = page_text((tmp_path / "page.html").read_text(encoding="utf-8")) if output == "page.txt" else out
    now = re.sub(r"\n +not tried: [^\n]*", "", now)  # tests define effects
    golden = GOLDEN / f"{scene}_{output}"
    if request.config.getoption("--update"):
        golden.write_text(now, encoding="utf-8")
    stored = golden.read_text(encoding="utf-8")
    if output.endswith(".json"):
        assert_same_json(json.loads(stored), json.loads(now))
    else:
        assert differences(stored, now) == []
        assert len(stored.splitlines()) == len(now.splitlines())
