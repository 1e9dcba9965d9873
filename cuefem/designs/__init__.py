"""Design studies: sweeps, optima, tolerance analyses, their files, and the store of designs."""

from cuefem.designs.evaluation import Response, evaluate
from cuefem.designs.many_designs import Row
from cuefem.designs.sampling import Levels, Normal, Sample, Span
from cuefem.designs.study import Study, Vary

__all__ = ["Levels", "Normal", "Response", "Row", "Sample", "Span", "Study", "Vary", "evaluate"]
