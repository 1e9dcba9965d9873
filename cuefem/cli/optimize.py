"""`cuefem optimize`: the best design within limits."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import isfinite
from pathlib import Path

import click
from rich.console import Console

from cuefem.cli.common import blaming, check_free, force_option, remark
from cuefem.cli.printing import assumed_lines, json_option, output_option, tell
from cuefem.design.optimum import Problem, optimum
from cuefem.io import save
from cuefem.io.study_files import assumed_base, load_optimum
from cuefem.quantity.units import text
from cuefem.report.study_table import column_label
from cuefem.scene import Scene
from cuefem.vary import replaced, value_at


@click.command()
@click.argument("study", type=click.Path(path_type=Path))
@output_option(".html", ".toml", many=True)
@click.option(
    "--iterations", type=click.IntRange(min=1), default=60, show_default=True, help="Largest number of steps."
)
@click.option("--seed", type=click.IntRange(min=0), default=0, help="Random seed, used only without exact gradients.")
@json_option
@force_option
def optimize(study: Path, output: tuple[Path, ...], iterations: int, seed: int, as_json: bool, force: bool) -> None:
    """Find the design of STUDY (.toml) with the smallest or largest objective within its ranges and limits.

    STUDY has the [[vary]] tables of a sweep, an [objective] and [[limit]] tables. Where exact gradients exist (a bare
    cue, its dimensions and materials) it takes tens of evaluations, otherwise thousands.
    """
    wanted = load_optimum(study)
    notes = assumed_base(study, wanted.base)
    drawing, page = (next((path for path in output if path.suffix == kind), None) for kind in (".toml", ".html"))
    if drawing is not None:
        check_free(drawing, force=force)
    remark(wanted.base)
    with blaming(study), _counter() as progress:
        found = optimum(wanted, iterations=iterations, seed=seed, progress=progress)
    if drawing is not None:
        save(_rounded(found.scene, wanted), drawing)
    aim = "maximize" if wanted.largest else "minimize"
    units = dict(zip(wanted.study.columns, wanted.study.units, strict=True))
    way = "by exact gradients" if found.exact else "by differential evolution"
    labels = {one.name: one.label for one in wanted.study.responses}
    lines = [f"{aim} {wanted.objective.label}: {found.evaluations} evaluations {way}", ""]
    both = {**found.numbers, **found.values}
    words = {name: labels.get(name) or column_label(name) for name in both}
    width = max(map(len, words.values()))
    lines += [f"{words[name]:{width}}  {_short(value, units[name])}" for name, value in both.items()]
    held = (limit.rsplit(" ", 2) for limit in found.active)
    held_by = [f"{words[name]} {sign} {_short(float(bound), units[name])}" for name, sign, bound in held]
    lines += ["", f"held by: {', '.join(held_by) or 'nothing'}"]
    if found.unfinished:
        lines.append(f"not finished: {found.unfinished}; more --iterations may find a better design")
    about = {"file": str(study), "assumed": notes, "written": drawing and str(drawing)}
    numbers = {"value": found.value, "numbers": found.numbers, "values": found.values, "active": found.active}
    search = {"evaluations": found.evaluations, "exact_gradients": found.exact, "unfinished": found.unfinished}
    record = about | {"objective": {aim: wanted.objective.name}} | numbers | search
    said = [*lines, *assumed_lines(notes), *([f"wrote {drawing}"] if drawing else [])]
    tell(as_json, record | {"resolution": vars(wanted.study.resolution), "units": units}, said, page)


def _short(value: float, unit: str) -> str:
    """A number to six digits, in the unit in which scene files are written: "204.493 mm"."""
    return text(float(f"{value:.6g}"), unit) if unit else f"{value:.6g}"


def _rounded(scene: Scene, wanted: Problem) -> Scene:
    """The scene with the numbers that varied to nine digits, far within the tolerance of the limits."""
    moved = {path for vary in wanted.vary for path in (*vary.fields(scene), *vary.givers(scene))}
    return replaced(scene, {path: float(f"{value_at(scene, path):.9g}") for path in moved})


@contextmanager
def _counter() -> Iterator[Callable[[int, float], object]]:
    """The number of evaluations and the best value on stderr, if a person looks on."""
    console = Console(stderr=True)
    if not console.is_terminal:
        yield lambda count, best: None
        return
    with console.status("computing") as status:
        yield lambda count, best: status.update(_progress(count, best))


def _progress(count: int, best: float) -> str:
    return f"{count} evaluations, " + (f"{best:.6g}" if isfinite(best) else "no design within the limits yet")
