"""Small studies; no tests."""

import os
import signal
import sqlite3
import subprocess
import sys
import time
from concurrent.futures import Executor
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cuefem.designs.blocks import Block, BlockResult, Blocks, compute_block, lost_block
from cuefem.designs.executors import in_parallel
from cuefem.designs.many_designs import Columns
from cuefem.designs.store import SqliteStore
from cuefem.designs.study import Study
from cuefem.designs.study_answer import study as compute_study
from cuefem.designs.study_file import load_study

ENVIRONMENT = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])}
SCENE = """
game = "kim"
[cue]
body_mass = "420 g"
[[cue.segments]]
length = "700 mm"
tip_diameter = "12 mm"
butt_diameter = "21 mm"
material = "hard maple"
[tip]
contact_time = "1.2 ms"
"""


def resolution(order: int, modes: int) -> str:
    """The table of a mesh of one element a segment."""
    return f"\n[resolution]\nelements = 1\norder = {order}\nmodes = {modes}\n"


def vary(path: str, *rest: str) -> str:
    """A [[vary]] table, one key a line."""
    return "\n".join(["", "[[vary]]", f"path = {path}", *rest, ""])


STUDY = 'scene = "scene.toml"\nresponses = ["end_mass", "tip_stiffness", "frequency(1)"]\n' + resolution(12, 6)
BOTH = '["cue.segments[0].tip_bore", "cue.segments[0].butt_bore"]'
STUDY += vary(BOTH, 'name = "bore"', 'low = "0 mm"', 'high = "15 mm"', "count = 8")
STUDY += vary('"tip.contact_time"', 'values = ["0.8 ms", "1.2 ms"]')
STUDY += vary('"cue.segments[0].material"', 'values = ["hard maple", "ash"]')

# Quasi-random; a strike takes longer than an end mass, so that blocks are small.
STRIKES = 'scene = "scene.toml"\nresponses = ["squirt(0.3)", "end_mass", "vibration_energy(0.3)"]\n' + resolution(10, 4)
STRIKES += "[sample]\ncount = 150\nseed = 5\n"
STRIKES += vary('"cue.segments[0].tip_bore"', 'low = "0 mm"', 'high = "13 mm"')
STRIKES += vary('"cue.segments[*].material.E"', 'name = "E over drawn"', "low = 0.7", "high = 1.3", "factor = true")

# Distributions of wood and tip for a tolerance analysis.
SCATTER = 'scene = "scene.toml"\nresponses = ["end_mass", "tip_stiffness"]\n' + resolution(8, 4)
SCATTER += '[tolerances]\ncount = 16\nseed = 5\ncorrelations = [["E", "density", 0.4]]\n'
SCATTER += 'groups = { wood = ["E", "density"] }\n'
SCATTER += vary('"cue.segments[0].material.E"', 'name = "E"', 'median = "12 GPa"', 'sd = "2 GPa"')
DENSITY = ('name = "density"', 'median = "700 kg/m^3"', "sd = 0.1", 'spacing = "logarithmic"')
SCATTER += vary('"cue.segments[0].material.rho"', *DENSITY)
SCATTER += vary('"tip.contact_time"', 'name = "time"', 'low = "0.8 ms"', 'high = "1.5 ms"')

# Minimum squirt over bore and tip diameter with a stiffness of at least 300 N/m.
OPTIMUM = 'scene = "scene.toml"\n[objective]\nminimize = "squirt_slope"\n' + resolution(8, 4)
OPTIMUM += '[[limit]]\nresponse = "tip_stiffness"\nlow = "300 N/m"\n'
OPTIMUM += vary('"cue.segments[0].tip_bore"', 'name = "bore"', 'low = "1 mm"', 'high = "9 mm"')
OPTIMUM += vary('"cue.segments[0].tip_diameter"', 'name = "tip"', 'low = "10 mm"', 'high = "13 mm"')

# Two bare responses on a coarse mesh.
GRID = 'scene = "scene.toml"\nresponses = ["end_mass", "mass"]\n' + resolution(8, 4)
GRID += vary('"cue.segments[0].tip_bore"', 'name = "bore"', 'values = ["0 mm", "1 mm", "2 mm", "3 mm"]')
GRID += vary('"cue.segments[0].tip_diameter"', 'values = ["12 mm", "12.5 mm"]')


def write_study(folder: Path, study: str = STUDY, scene: str = SCENE, name: str = "study.toml") -> Path:
    """Write a study and its scene; the path of the study."""
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    (folder / name).write_text(study, encoding="utf-8")
    return folder / name


def computed_rows(study: Path, output: Path, **options: Any) -> list[tuple[Any, ...]]:
    """Compute a study into a store; its rows as stored."""
    with SqliteStore(output, load_study(study)) as store:
        result = compute_study(store.study, store=store, **options)
        return [(row.design, *row.values, *row.responses, row.failure) for row in result.rows]


def stored_count(path: Path) -> int:
    """The number of stored designs."""
    with closing(sqlite3.connect(path)) as file:
        return int(file.execute("SELECT coalesce(sum(length(keys)), 0) / 16 FROM blocks").fetchone()[0])


def alter_store(path: Path, command: str, *values: object) -> None:
    """Execute an SQL statement on a store."""
    with sqlite3.connect(path) as file:
        file.execute(command, values)
    file.close()


def start_study(study: Path, *more: str) -> subprocess.Popen[bytes]:
    quiet = subprocess.PIPE
    return subprocess.Popen(
        [sys.executable, "-m", "cuefem", "study", str(study), *more],
        env=ENVIRONMENT,
        stdout=quiet,
        stderr=quiet,
        start_new_session=True,
        preexec_fn=interruptible,
    )


def interruptible() -> None:
    """Enable Ctrl-C, which shells disable in background processes."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def wait_for_rows(store: Path, run: subprocess.Popen[bytes], rows: int) -> int:
    """Wait until ``rows`` rows are stored or the study has ended; the number of stored rows."""
    begun, count = time.monotonic(), 0
    while run.poll() is None and count < rows and time.monotonic() - begun < 60:
        time.sleep(0.02)
        try:
            count = stored_count(store) if store.exists() else 0
        except sqlite3.OperationalError:  # it is being created
            count = 0
    return count


DEADLY = 21  # the design that ends its worker


def deadly_block(study: Study, block: Block) -> BlockResult:
    """Compute a block; the process ends at `DEADLY`, as if it was killed for its memory."""
    if DEADLY in block.numbers:
        os._exit(9)
    return compute_block(study, False, block)


def assert_deadly_design_fails_alone(folder: Path, workers: int | Executor) -> None:
    """All other designs of a study have the serial values."""
    wider = '"12.5 mm", "12.6 mm", "12.7 mm", "13 mm", "13.5 mm"]'
    study = load_study(write_study(folder, GRID.replace('"12.5 mm"]', wider)))
    assert isinstance(study, Study)
    found, whole = Columns.of(study), compute_study(study).columns
    blocks, work = Blocks(enumerate(study.designs())), partial(deadly_block, study)
    for result in in_parallel(work, blocks, workers, partial(lost_block, study)):
        assert result.values is not None
        found.add(result.block.numbers, result.values, result.failures)
    assert [*found.failures] == [DEADLY]
    assert found.failures[DEADLY].endswith("out of memory, or killed")
    whole.values[DEADLY] = np.nan
    np.testing.assert_array_equal(found.values, whole.values)
