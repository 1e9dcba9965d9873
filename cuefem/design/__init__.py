"""Design studies: sweeps, optima, tolerance analyses and sensitivities, with stored designs."""

from cuefem.design.evaluation import Response, evaluate
from cuefem.design.sampling import Levels, Normal, Sample, Span
from cuefem.design.study import Study, Vary
from cuefem.design.sweep import Row

__all__ = ["Levels", "Normal", "Response", "Row", "Sample", "Span", "Study", "Vary", "evaluate"]
