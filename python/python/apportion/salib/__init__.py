"""SALib's modules on the engine: a script written for SALib 1.6 runs with `apportion.salib` in the place of `SALib` in its imports.

    from apportion.salib.sample import sobol as sobol_sample
    from apportion.salib.analyze import sobol

    X = sobol_sample.sample(problem, 1024)
    Si = sobol.analyze(problem, Y)

There are `sample.sobol`, `saltelli`, `morris` and `latin`, `analyze.sobol`, `morris` and `rbd_fast`, `ProblemSpec`,
`util.read_param_file`, `plotting.bar` and `test_functions`; an import of another method says what does its work. `from_problem`
turns a problem into the factors of `apportion.analyse`, which needs fewer runs for the same accuracy.
"""

from . import _others, analyze, plotting, sample, test_functions, util  # noqa: F401
from ._problem import from_problem
from .util import ProblemSpec

__all__ = ["ProblemSpec", "analyze", "from_problem", "plotting", "sample", "test_functions", "util"]
