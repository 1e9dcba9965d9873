"""Pages and figures of studies, and the comparison that tests make of them.

A study is a module with a `STUDY`. Run as a program, it writes its page and its figures beside itself. A test makes the
page again and compares every number at its printed precision (`disagreements`).
"""

from __future__ import annotations

import contextlib
import io
import os
import platform
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import scipy

STUDIES = Path(__file__).parent
IN_PYTHON = "## In Python"
STYLE = {"svg.hashsalt": "cuefem", "svg.fonttype": "none", "font.size": 10, "axes.grid": True, "grid.alpha": 0.3}


@dataclass(frozen=True)
class Figure:
    """A function that draws on axes, the rows and columns of panels, and the size in inches."""

    draw: Callable[[Any], object]
    panels: tuple[int, int] = (1, 1)
    size: tuple[float, float] = (6.4, 4.4)

    def save(self, path: Path) -> None:
        """Draw it into a file."""
        with figure(path, self.panels, self.size) as axes:
            self.draw(axes)


@dataclass(frozen=True)
class Study:
    """The file of a study's program, the text of its page, its figures by file name, and its question in Python.

    example: a few lines that run in the root of the repository; the page ends with them and with what they print.
    seconds: whether the page holds seconds of this machine, which no test compares.
    """

    file: str
    text: Callable[[], str]
    figures: Mapping[str, Figure] = field(default_factory=dict)
    seconds: bool = False
    example: str = ""

    @property
    def path(self) -> Path:
        """The program; its page has the same name."""
        return Path(self.file)

    @property
    def committed(self) -> str:
        """The page as it is committed."""
        return self.path.with_suffix(".md").read_text(encoding="utf-8")

    def page(self) -> str:
        """The text and the section of Python."""
        return paragraphs(self.text(), self.in_python())

    def in_python(self) -> str:
        """The section of Python; what the example prints is not shown where it prints seconds."""
        printed = output_of(self.example)
        shown = () if self.seconds else (f"```text\n{printed}```",)
        return paragraphs(IN_PYTHON, f"```python\n{self.example}```", *shown)

    def write(self) -> None:
        """Write the page and the figures."""
        self.path.with_suffix(".md").write_text(self.page(), encoding="utf-8")
        for name, drawing in self.figures.items():
            drawing.save(self.path.with_name(name))


def run(study: Study, answer: Callable[..., str]) -> None:
    """Write the page and its figures; or, with files as arguments, print what the study computes of them.

    Invalid input prints one line and ends with status 2.
    """
    if len(sys.argv) == 1:
        study.write()
        return
    try:
        print(answer(*sys.argv[1:]))
    except (TypeError, ValueError, OSError) as error:
        print(f"{' '.join(sys.argv[1:])}: {error}", file=sys.stderr)
        raise SystemExit(2) from error


def output_of(example: str) -> str:
    """What an example prints in the root of the repository."""
    printed = io.StringIO()
    with contextlib.chdir(STUDIES.parent), contextlib.redirect_stdout(printed):
        exec(compile(example, "example", "exec"), {})
    plt.close("all")
    return printed.getvalue()


def page(title: str, question: str, answer: str, *parts: str) -> str:
    """A page: title, question, answer, then text and tables with an empty line between them."""
    return paragraphs(f"# {title}", f"**Question.** {question}", f"**Answer.** {answer}", *parts)


def paragraphs(*parts: str) -> str:
    """Titles, text and tables with an empty line between them."""
    return "\n\n".join(part.rstrip("\n") for part in parts) + "\n"


NONE = "–"


def number(value: float | None, digits: int = 8) -> str:
    """A number with so many significant digits, `NONE` for none."""
    return NONE if value is None else f"{value:.{digits}g}"


def table(columns: Sequence[str], rows: Iterable[Sequence[Any]], digits: int = 3) -> str:
    """A markdown table; text stands as it is, numbers get so many significant digits."""

    def line(cells: Sequence[Any]) -> str:
        return "| " + " | ".join(c if isinstance(c, str) else number(c, digits) for c in cells) + " |"

    return "\n".join([line(columns), "|" + "---|" * len(columns), *map(line, rows)]) + "\n"


def span(values: Iterable[float], digits: int = 2) -> str:
    """Least and largest of some numbers."""
    numbers = list(values)
    return f"{min(numbers):.{digits}f} to {max(numbers):.{digits}f}"


def change(values: Iterable[float]) -> str:
    """Largest over smallest of some numbers, less 1, per cent."""
    numbers = list(values)
    return f"{100 * (max(numbers) / min(numbers) - 1):.0f} %"


def rms(values: Iterable[float]) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(list(values)))))


def slope(x: Iterable[float], y: Iterable[float]) -> float:
    """Exponent of the power law through points, least squares in the logarithms."""
    return float(np.polyfit(np.log(list(x)), np.log(list(y)), 1)[0])


@contextlib.contextmanager
def figure(path: Path, panels: tuple[int, int] = (1, 1), size: tuple[float, float] = (6.4, 4.4)) -> Iterator[Any]:
    """Axes to draw on; the figure is saved without a date when the block ends, its text as text."""
    with plt.rc_context(STYLE):
        canvas, axes = plt.subplots(*panels, figsize=size, layout="constrained")
        yield axes
        canvas.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)
        plt.close(canvas)


def machine() -> str:
    """Processor and versions that seconds belong to."""
    path = Path("/proc/cpuinfo")
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    model = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.machine())
    versions = f"Python {platform.python_version()}, numpy {np.__version__}, scipy {scipy.__version__}"
    return f"{model}, {os.cpu_count()} cores, {versions}"


_NUMBER = re.compile(r"(?<![\w.])[+-]?\d+(?:\.\d*)?(?:e[+-]?\d+)?(?![\w.]*\w)")


def disagreements(committed: str, derived: str) -> list[str]:
    """Pairs of lines of two pages that differ: other text, or numbers more than one apart in the last printed place."""
    old, new = committed.splitlines(), derived.splitlines()
    if len(old) != len(new):
        return [f"{len(old)} lines committed, {len(new)} derived"]
    return [f"{a}\n{b}" for a, b in zip(old, new, strict=True) if not _agree(a, b)]


def _agree(old: str, new: str) -> bool:
    if _NUMBER.sub("#", old) != _NUMBER.sub("#", new):
        return False
    pairs = zip(_NUMBER.findall(old), _NUMBER.findall(new), strict=True)
    return all(abs(float(a) - float(b)) <= 1.01 * max(_resolution(a), _resolution(b)) for a, b in pairs if a != b)


def _resolution(text: str) -> float:
    digits, _, exponent = text.partition("e")
    decimals = len(digits.partition(".")[2])
    return 10.0 ** (int(exponent or 0) - decimals)
