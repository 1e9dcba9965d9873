"""A command or a page solves no eigenproblem of a cue twice (properties)."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cuefem as cf
from cuefem.beam import modes, spectrum
from cuefem.beam.system import System
from cuefem.designer.answers import answers, completed, with_end_mass
from cuefem.results.band import squirt_of
from tests.helpers.command_line import call

KIM = Path(__file__).parents[2] / "studies/scenes/kim.toml"


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, str]]:
    """Every eigenproblem of bending that is solved: its unknowns, and stiffness and mass as a digest."""
    found: list[tuple[int, str]] = []
    squirt_of.cache_clear()
    lowest, reduced = modes.lowest, spectrum.reduced

    def note(*matrices: Any) -> None:
        whole = [matrix if isinstance(matrix, np.ndarray) else matrix.toarray() for matrix in matrices]
        found.append((len(whole[0]), hashlib.sha256(b"".join(each.tobytes() for each in whole)).hexdigest()))

    def noted(K: Any, M: Any, **options: Any) -> Any:
        note(K, M)
        return lowest(K, M, **options)

    def noted_form(system: System, *kept: Any) -> Any:
        note(system.K, system.M)
        return reduced(system, *kept)

    monkeypatch.setattr(modes, "lowest", noted)
    monkeypatch.setattr(spectrum, "reduced", noted_form)
    return found


def command(*arguments: str) -> Callable[[Path], None]:
    def run(folder: Path) -> None:
        placed = [str(folder / part) if part == "page.html" else part for part in arguments]
        assert call(placed[0], KIM, *placed[1:])[0] == 0

    return run


def designer(folder: Path) -> None:
    scene = cf.load(KIM)
    assert isinstance(scene, cf.Scene)
    completed(with_end_mass(answers(scene)))


@pytest.mark.parametrize(
    ("work", "count"),
    [
        # a strike, an end mass (more modes), the range of the end masses (plain sums), and the frequencies shown; for
        # the verdict three other woods and three ready cues
        (command("report"), 4 + 6),
        # nine changes, each with a strike and a tone, and the own tone;
        # the strike of a page climbs to an accuracy, here on its first mesh, coarser than a strike's by default
        (command("report", "-o", "page.html"), 5 + 6 + 19),
        (command("strike"), 2),  # the end mass of the two-part model takes more modes
        (command("end-mass"), 3),  # of a tip that sticks, of one that is pushed or led (a strike's modes), plain sums
        (command("modes"), 1),
        (command("strike", "--format", "pooltool"), 1),
        (designer, 3 + 6),
    ],
    ids=["report", "page", "strike", "end mass", "modes", "pooltool", "designer"],
)
def test_no_eigenproblem_is_solved_twice(
    work: Callable[[Path], None], count: int, solved: list[tuple[int, str]], tmp_path: Path
) -> None:
    work(tmp_path)
    assert len(set(solved)) == len(solved) == count
