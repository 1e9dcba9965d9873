"""Execute the notebooks anew in Jupyter and store their outputs, or write them to another folder; all else stays.

.venv/bin/python .ci/notebooks.py [FOLDER]
"""

from __future__ import annotations

import copy
import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient

FOLDER = Path(__file__).parents[1] / "studies" / "notebooks"


def execute(path: Path, folder: Path) -> None:
    """Execute a notebook where it lies, in a kernel of the Python that runs this, and write it to a folder."""
    notebook = nbformat.read(path, as_version=4)
    metadata = copy.deepcopy(notebook.metadata)
    resources = {"metadata": {"path": path.parent}}
    NotebookClient(notebook, timeout=600, record_timing=False, coalesce_streams=True, resources=resources).execute()
    notebook.metadata = metadata
    nbformat.write(notebook, folder / path.name)


if __name__ == "__main__":
    for path in sorted(FOLDER.glob("*.ipynb")):
        print(path.name, flush=True)
        execute(path, Path(*sys.argv[1:2] or [FOLDER]))
