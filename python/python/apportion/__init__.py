"""Sobol' global sensitivity analysis: which inputs of a model drive its output, and by how many percent.

    import apportion as ap

    result = ap.analyse(f, {"x1": ap.Uniform(-3, 3), "x2": ap.Normal(0, 1), "x3": (0, 1)}, base_samples=4096)
    result.total["x1"].estimate

`f` takes one array per factor, or one of all (rows, factors), and returns an array, several of them, or a dict.
"""

from . import salib
from ._answers import AnswerError
from ._distributions import *  # noqa: F403
from ._distributions import __all__ as _distributions
from ._engine import RunError, StudyError, __version__
from ._given import given_data
from ._indices import Index, Indices, OutputResult, SeriesResult
from ._result import Document, Result, load_result
from ._study import Study, analyse
from ._warnings import SensitivityWarning
from .salib import from_problem as from_salib

__all__ = [
    "AnswerError",
    "Document",
    "Index",
    "Indices",
    "OutputResult",
    "Result",
    "RunError",
    "SensitivityWarning",
    "SeriesResult",
    "Study",
    "StudyError",
    "__version__",
    "analyse",
    "from_salib",
    "given_data",
    "load_result",
    "salib",
    *_distributions,
]
