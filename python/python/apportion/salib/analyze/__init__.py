"""SALib's analyses: `sobol`, `morris`, `rbd_fast`."""

from .._problem import refused
from . import morris, rbd_fast, sobol

__all__ = ["morris", "rbd_fast", "sobol"]
_GIVEN = "ap.given_data(X, Y, measures=True)"
_ENGINE = "ap.analyse(f, ap.from_salib(problem)"
__getattr__ = refused(
    __name__,
    {
        "delta": _GIVEN,
        "dgsm": "ap.Study(f, factors).screen(derivatives=True)",
        "discrepancy": _GIVEN,
        "enhanced_hdmr": "ap.given_data(X, Y, surrogate=True)",
        "fast": "sample.sobol with analyze.sobol, or sample.latin with analyze.rbd_fast",
        "ff": "sample.morris with analyze.morris",
        "hdmr": "ap.given_data(X, Y, surrogate=True)",
        "pawn": _GIVEN,
        "radial_ee": "ap.Study(f, factors).screen()",
        "rsa": _GIVEN,
        "shapley": f"{_ENGINE}, shapley=True)",
        "sobol_jansen": f"{_ENGINE})",
    },
)
