"""Terminal, JSON and page of four scenes against golden files; `--update` rewrites them (regression).

Tolerance: one unit in the last digit of a number, in JSON 1e-6 of its value, for other machines' round-off error.
"""

import html
import itertools
import json
import math
import re
from collections import Counter
from dataclasses import replace
from difflib import SequenceMatcher
from pathlib import Path
from typing import Any

import pytest

import cuefem as cf
from cuefem.analysis import QUESTIONS
from tests.helpers.command_line import call

ROOT = Path(__file__).parents[1]
GOLDEN = ROOT / "tests" / "golden"
# A spring tip; a default stroke; a whole cue with a tube, whose tip slips at first; a bored stub for the solid.
SCENES = {
    "kim": "studies/scenes/kim.toml",
    "pool": "meshes/pool_hollow.toml",
    "tube": "tests/golden/tube.toml",
    "stub": "tests/golden/stub.toml",
}
OUTPUTS = {
    "report.txt": ["report"],
    "report.json": ["report", "--json"],
    "page.txt": ["report", "-o", "page.html"],
    "strike.txt": ["strike"],
    "end_mass.txt": ["end-mass"],
    "modes.txt": ["modes", "--near", "250"],
    "report_us.txt": ["report", "--units", "us"],
    "effects.txt": ["effects"],
    "improve.txt": ["improve"],
    "check.txt": ["check"],
}
NUMBER = re.compile(r"(?<![\w.])[-+−]?\d+(?:\.\d+)?(?:e[-+]\d+)?")


def one_level(page: str) -> str:
    """A page whose charts are no longer nested <svg>: the inner one, which clips, as <g>."""
    return re.sub(r'<svg( class="plot".*?)</svg>', r"<g\1</g>", page, flags=re.DOTALL)


def page_text(page: str) -> str:
    """The text of a page, one line an element, without script, style and charts."""
    body = re.sub(r"<(style|script|svg|head).*?</\1>", "", one_level(page), flags=re.DOTALL)
    return "\n".join(line for part in re.split(r"<[^>]*>", body) if (line := html.unescape(part).strip())) + "\n"


def last_place(number: str) -> float:
    """One unit in the last digit of a number."""
    digits, _, power = number.partition("e")
    return 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))


def alike(one: str, other: str, exact: bool = False) -> bool:
    """Whether two numbers differ by at most one unit in the last digit, or are the same whole number below 100.

    Rounded numbers have as many decimals: five and more are those of a float as Python writes it. exact: to 1e-6.
    """
    decimals = {len(number.partition(".")[2]) for number in (one, other)}
    first, second = (float(number.replace("−", "-")) for number in (one, other))
    if exact or (decimals == {0} and abs(first) < 100):
        close = math.isclose(first, second, rel_tol=1e-6)
    else:
        close = abs(first - second) < 1.01 * last_place(one)
    return close and (len(decimals) == 1 or max(decimals) > 4)


def differences(stored: str, now: str, exact: bool = False) -> list[tuple[str, str]]:
    """Lines that differ by more than one unit in the last digit of a number, or in its decimals; exact: see `alike`."""
    off = []
    for one, other in zip(stored.splitlines(), now.splitlines(), strict=False):
        pairs = zip(NUMBER.findall(one), NUMBER.findall(other), strict=False)
        close = all(alike(a, b, exact) for a, b in pairs)
        if " ".join(NUMBER.sub("#", one).split()) != " ".join(NUMBER.sub("#", other).split()) or not close:
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


EVERYDAY = {
    "kim": ("report.txt", "report.json", "strike.txt", "end_mass.txt", "modes.txt"),
    "pool": ("report.json", "strike.txt", "end_mass.txt", "modes.txt"),
    "tube": ("report_us.txt", "strike.txt", "end_mass.txt"),
    "stub": ("check.txt",),
}
HEAVY = {
    "kim": ("page.txt", "effects.txt", "improve.txt", "check.txt"),
    "pool": ("page.txt", "effects.txt", "improve.txt", "check.txt", "report.txt"),
}
RUNS = [(scene, output) for scene, outputs in EVERYDAY.items() for output in outputs] + [
    pytest.param(scene, output, marks=pytest.mark.heavy) for scene, outputs in HEAVY.items() for output in outputs
]


def test_update_of_a_golden_file_keeps_lines_that_are_alike() -> None:
    stored = "a 1.00\nb 2.00 and 3.0\nc 4.00\n"
    assert kept(stored, "a 1.01\nnew 1.0\nb 2.00 and 3.2\nc 4.00\n", exact=False) == (
        "a 1.00\nnew 1.0\nb 2.00 and 3.2\nc 4.00\n"
    )
    assert kept("1.0000001\n", "1.00000011\n", exact=True) == "1.0000001\n"


@pytest.mark.parametrize(("scene", "output"), RUNS)
def test_output_equals_golden_file(
    output: str, scene: str, request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: Any
) -> None:
    monkeypatch.chdir(ROOT)
    monkeypatch.setenv("COLUMNS", "110")
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    for clock in ("perf_counter", "process_time"):
        ticks = itertools.count()
        monkeypatch.setattr(f"time.{clock}", ticks.__next__)  # every reading is one second later
    command, *options = OUTPUTS[output]
    options = [str(tmp_path / option) if option == "page.html" else option for option in options]
    status, out, err = call(command, SCENES[scene], *options)
    assert status == 0
    assert not err or scene == "stub"  # too short for a shaft
    now = page_text((tmp_path / "page.html").read_text(encoding="utf-8")) if output == "page.txt" else out
    assert_golden(f"{scene}_{output}", now, request)


def kept(stored: str, now: str, exact: bool) -> str:
    """A text with the stored lines that are alike, so that an update shows what changed and no round-off."""
    old, new = stored.splitlines(), now.splitlines()
    words = [[NUMBER.sub("#", line) for line in lines] for lines in (old, new)]
    for start, first, size in SequenceMatcher(None, *words, autojunk=False).get_matching_blocks():
        for one, other in zip(range(start, start + size), range(first, first + size), strict=True):
            if differences(old[one], new[other], exact) == []:
                new[other] = old[one]
    return "".join(f"{line}\n" for line in new)


def assert_golden(name: str, now: str, request: pytest.FixtureRequest, *, exact: bool = False) -> None:
    """A text equals that of the golden file, which `--update` writes; exact: see `alike`."""
    golden, now = GOLDEN / name, re.sub(r"\n *not tried: [^\n]*", "", now)  # tests define effects
    if request.config.getoption("--update"):
        stored = golden.read_text(encoding="utf-8") if golden.exists() else ""
        golden.write_text(kept(stored, now, exact or name.endswith(".json")), encoding="utf-8")
    stored = golden.read_text(encoding="utf-8")
    if name.endswith(".json"):
        assert_same_json(json.loads(stored), json.loads(now))
    else:
        assert differences(stored, now, exact) == []
        assert len(stored.splitlines()) == len(now.splitlines())


def drawing_text(page: str) -> str:
    """How often a page has each class, and the elements of its charts, one a line.

    Of a path each eighth point, to four decimals.
    """

    def thinned(path: re.Match[str]) -> str:
        pieces = re.findall(r"[A-Zz][^A-Zz]*", path[1])
        return f' d="{" ".join(pieces[::8] + pieces[-1:])}"'

    charts = re.findall(r"<svg.*?</svg>", one_level(page), re.DOTALL)
    charts = [re.sub(r"\d+\.\d{5,}", lambda number: f"{float(number[0]):.4f}", chart) for chart in charts]
    lines = [line.strip() for chart in charts for line in re.sub(r"(<(?!/))", r"\n\1", chart).splitlines()]
    lines = [str(sorted(Counter(re.findall(r'class="([^"]*)"', page)).items())), *lines]
    return "\n".join(re.sub(r' d="([^"]*)"', thinned, line) for line in lines if line) + "\n"


def rounded(text: str) -> str:
    """A text without round-off: numbers to five decimals, tiny ones as 0."""
    text = re.sub(r"\d+(\.\d+)?e-(1[3-9]|[2-9]\d)", "0", text)
    return re.sub(r"\d+\.\d{6,}", lambda number: f"{float(number[0]):.5f}", text)


@pytest.fixture(scope="module")
def tube() -> cf.Scene:
    scene = cf.load(ROOT / SCENES["tube"])
    assert isinstance(scene, cf.Scene)
    return scene


def test_tip_section_equals_golden_file(request: pytest.FixtureRequest) -> None:
    """Impacts of a leather tip, of which the fastest is beyond its law."""
    scene = cf.usual_scene(cf.Cue((cf.Segment(0.7, 0.0125, 0.021, cf.Material(12e9, 0.8e9, 700.0)),), 0.42))
    page = QUESTIONS["tip"].function()(replace(scene, stroke=cf.Stroke(speed=30.0))).to_html()
    assert_golden("tip_section.txt", page_text(page) + drawing_text(page), request)


@pytest.mark.parametrize("key", [key for key in QUESTIONS if key not in ("advice", "check", "end_masses", "tip")])
def test_section_of_page_equals_golden_file(key: str, request: pytest.FixtureRequest, tube: cf.Scene) -> None:
    """Texts of a section of the report's page, and the points of its charts."""
    page = QUESTIONS[key].function()(tube).to_html()
    assert_golden(f"tube_{key}_section.txt", page_text(page) + drawing_text(page), request)
