"""Points for SALib's analyses: `sobol`, `saltelli`, `morris`, `latin`."""

from .._problem import refused
from . import latin, morris, saltelli, sobol

__all__ = ["latin", "morris", "saltelli", "sobol"]
__getattr__ = refused(
    __name__,
    {
        "fast_sampler": "sample.sobol with analyze.sobol, or sample.latin with analyze.rbd_fast",
        "ff": "sample.morris with analyze.morris",
        "finite_diff": "ap.Study(f, factors).screen(derivatives=True)",
        "radial": "ap.Study(f, factors).screen()",
        "shapley": "ap.analyse(f, factors, shapley=True)",
    },
)
