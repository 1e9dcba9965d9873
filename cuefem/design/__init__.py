"""Design studies: many scenes at once, what varies in them, and sweeps that nothing can lose."""

from cuefem.design.evaluation import Evaluation, Response, evaluate
from cuefem.design.ranges import METHODS, Levels, Normal, Sample, Span
from cuefem.design.study import Study, Vary
from cuefem.design.sweep import Pool, Row, Store, Task, dask, processes, sweep

__all__ = [
    "METHODS",
    "Evaluation",
    "Levels",
    "Normal",
    "Pool",
    "Response",
    "Row",
    "Sample",
    "Span",
    "Store",
    "Study",
    "Task",
    "Vary",
    "dask",
    "evaluate",
    "processes",
    "sweep",
]
