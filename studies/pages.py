"""How a study says what it has to say: its page, tables and figures, what was predicted, and what a test makes again.

A study is a module with a `STUDY`; run as a program it writes its page and its figures beside itself. A test makes the
page again, or the parts that `STUDY` names where the whole takes too long, and compares every number at its printed
precision (`disagreements`).
"""

from __future__ import annotations

import os
import platform
import random
import re
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any, TypeVar

import matplotlib.pyplot as plt
import numpy as np
import scipy
import scipy.linalg as la

STUDIES = Path(__file__).parent
STYLE = {"svg.hashsalt": "cuefem", "svg.fonttype": "path", "font.size": 10, "axes.grid": True, "grid.alpha": 0.3}
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
T = TypeVar("T")
NONE = "–"
BEFORE = "Predicted before it was run here."
LEATHER = "## LeatherTip"  # what ends the pages of studies that stood before it


@dataclass(frozen=True)
class Figure:
    """What draws on the axes of a figure, its panels, and its size in inches."""

    draw: Callable[[Any], object]
    panels: tuple[int, int] = (1, 1)
    size: tuple[float, float] = (6.4, 4.4)

    def save(self, path: Path) -> None:
        """Draw it into a file."""
        with figure(path, self.panels, self.size) as axes:
            self.draw(axes)


@dataclass(frozen=True)
class Again:
    """A part of a page that a test makes again.

    since, until: the lines between which the part stands, each by its beginning; "" for the page's own. left_out: how
    many of the lines there the part leaves out; None where it is a block of lines among others. instead: what names of
    the study mean meanwhile, such as a sample of a long list.
    """

    text: Callable[[], str]
    since: str = ""
    until: str = ""
    left_out: int | None = 0
    heavy: bool = True
    instead: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True)
class Study:
    """A study: the file of its program, its page, its figures by their file names, and what a test makes again.

    seconds: a page of this machine's seconds, which no test compares; it is written in a process of one BLAS thread.
    again: parts of the page by name; by default the whole page. heavy: whether page and figures take long to make.
    drawn: whether a test draws the figures too. predicted: numbers by name, as they were said before the study was run;
    the page has them beside what was found (`predictions`).
    """

    file: str
    page: Callable[[], str] | None = None
    figures: Mapping[str, Figure] = field(default_factory=dict)
    seconds: Callable[[], str] | None = None
    again: Mapping[str, Again] | None = None
    heavy: bool = True
    drawn: bool = False
    predicted: Mapping[str, str] = field(default_factory=dict)

    @property
    def path(self) -> Path:
        """The program; its page has the same name."""
        return Path(self.file)

    @property
    def committed(self) -> str:
        """The page as it is committed."""
        return self.path.with_suffix(".md").read_text(encoding="utf-8")

    @property
    def parts(self) -> Mapping[str, Again]:
        """What of the page a test makes again."""
        if self.again is not None or self.page is None:
            return self.again or {}
        return {"page": Again(self.page, heavy=self.heavy)}

    def write(self) -> None:
        """Write the page, the figures and the seconds."""
        if self.seconds is not None and any(os.environ.get(name) != "1" for name in THREADS):
            module = ".".join(self.path.relative_to(STUDIES.parent).with_suffix("").parts)
            pinned = {**os.environ, **dict.fromkeys(THREADS, "1")}
            subprocess.run([sys.executable, "-m", module], env=pinned, cwd=STUDIES.parent, check=True)
            return
        if self.page is not None:
            self.path.with_suffix(".md").write_text(self.page(), encoding="utf-8")
        for name, drawing in self.figures.items():
            drawing.save(self.path.with_name(name))
        if self.seconds is not None:
            self.path.with_name(f"{self.path.stem}_seconds.md").write_text(self.seconds(), encoding="utf-8")


def some(among: Sequence[T], count: int) -> tuple[T, ...]:
    """Some of these, drawn once, in their order."""
    places = sorted(random.Random(0).sample(range(len(among)), count))
    return tuple(among[place] for place in places)


def some_of(among: Mapping[str, T], count: int) -> dict[str, T]:
    """Some entries, drawn once, in their order."""
    return {name: among[name] for name in some(tuple(among), count)}


def row(cells: Sequence[Any], digits: int = 4) -> str:
    """A line of a markdown table; text stands as it is, numbers with ``digits`` significant digits."""
    return "| " + " | ".join(c if isinstance(c, str) else number(c, digits) for c in cells) + " |"


def table(columns: Sequence[str], rows: Iterable[Sequence[Any]], digits: int = 4) -> str:
    """A markdown table."""
    return "\n".join([row(columns), "|" + "---|" * len(columns), *(row(cells, digits) for cells in rows)]) + "\n"


def paragraphs(*parts: str) -> str:
    """Titles, words and tables with an empty line between them."""
    return "\n\n".join(part.rstrip("\n") for part in parts) + "\n"


def predictions(
    predicted: Mapping[str, str], found: Mapping[str, str], measured: Mapping[str, str] | None = None
) -> str:
    """The end of a page: numbers by name as predicted, as found, and, where given, as measured."""
    values = {"found": found, **({} if measured is None else {"measured": measured})}
    words = "predicted and found" if measured is None else "predicted, found and measured"
    rows = [[name, said, *(each.get(name, "") for each in values.values())] for name, said in predicted.items()]
    return paragraphs(f"{LEATHER}: what was {words}", BEFORE, table(["number", "predicted", *values], rows))


@contextmanager
def figure(path: Path, panels: tuple[int, int] = (1, 1), size: tuple[float, float] = (6.4, 4.4)) -> Iterator[Any]:
    """Axes to draw on; the figure is saved without a date when the block ends."""
    with plt.rc_context(STYLE):
        canvas, axes = plt.subplots(*panels, figsize=size, layout="constrained")
        yield axes
        canvas.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)
        plt.close(canvas)


def slope(x: Iterable[float], y: Iterable[float]) -> float:
    """Exponent of the power law through points, least squares in the logarithms."""
    return float(np.polyfit(np.log(list(x)), np.log(list(y)), 1)[0])


def crests(errors: Sequence[float], size: int) -> np.ndarray:
    """Largest size of an error in each run of ``size`` samples: the envelope of errors that ring."""
    return np.max(np.abs(np.reshape(errors, (-1, size))), axis=1)


# seconds


def processor() -> str:
    """The machine that seconds are of: its processor and number of cores."""
    path = Path("/proc/cpuinfo")
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    model = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.machine())
    return f"{model}, {os.cpu_count()} cores"


def machine() -> str:
    """What seconds are of: processor and versions, two lines."""
    versions = f"numpy {np.__version__}, scipy {scipy.__version__}"
    return f"{processor()}, one BLAS thread, Python {platform.python_version()},\n{versions}."


def seconds_of(work: Callable[[], Any], repeats: int, clock: Callable[[], float] = process_time) -> float:
    """Median of the seconds that work takes: by default of the processor, which other work hardly lengthens."""
    times = []
    for _ in range(repeats):
        start = clock()
        work()
        times.append(clock() - start)
    return median(times)


def expm_50() -> Callable[[], Any]:
    """The call that seconds are told in: `scipy.linalg.expm` of a 50 x 50 matrix of norm 1."""
    matrix = np.random.default_rng(0).normal(size=(50, 50))
    matrix /= np.linalg.norm(matrix, 2)
    return lambda: la.expm(matrix)


def number(value: float | None, digits: int = 8) -> str:
    """A number as tables print it."""
    return NONE if value is None else f"{value:.{digits}g}"


_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d*)?(?:e[+-]?\d+)?(?![\w.]*\w)")


def disagreements(committed: str, derived: str) -> list[str]:
    """Where two tables differ: text that is not the same, numbers apart by more than one in the last printed place.

    Lists the pairs of lines, empty where the tables agree. Numbers as in "4.1e-05" count by their last digit.
    """
    ours, theirs = committed.splitlines(), derived.splitlines()
    if len(ours) != len(theirs):
        return [f"{len(ours)} lines committed, {len(theirs)} derived"]
    return [f"{a}\n{b}" for a, b in zip(ours, theirs, strict=True) if not _same(a, b)]


def _same(ours: str, theirs: str) -> bool:
    if _NUMBER.sub("#", ours) != _NUMBER.sub("#", theirs):
        return False
    pairs = zip(_NUMBER.findall(ours), _NUMBER.findall(theirs), strict=True)
    return all(abs(float(a) - float(b)) <= 1.01 * max(_last_place(a), _last_place(b)) for a, b in pairs if a != b)


def _last_place(text: str) -> float:
    digits, _, exponent = text.partition("e")
    decimals = len(digits.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - decimals)
