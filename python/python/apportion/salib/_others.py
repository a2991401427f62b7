"""SALib's modules that are not here, and what does their work."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from types import ModuleType

_PACKAGE = __name__.rpartition(".")[0]
_GIVEN = "ap.given_data(X, Y, measures=True)"
_SURROGATE = "ap.given_data(X, Y), which fits a surrogate"
_FAST = "sample.sobol with analyze.sobol, or sample.latin with analyze.rbd_fast"
_SHAPLEY = "ap.analyse(f, ap.from_salib(problem), shapley=True)"
_SCREEN = "ap.Study(f, ap.from_salib(problem)).screen()"
_CHARTS = "plot() and charts() of what ap.analyse(...) and ap.Study(...).screen() return"
_INSTEAD = {
    "sample.fast_sampler": _FAST,
    "sample.ff": "sample.morris with analyze.morris",
    "sample.finite_diff": _SCREEN,
    "sample.radial": _SCREEN,
    "sample.shapley": _SHAPLEY,
    "analyze.delta": _GIVEN,
    "analyze.dgsm": _SCREEN,
    "analyze.discrepancy": _GIVEN,
    "analyze.enhanced_hdmr": _SURROGATE,
    "analyze.fast": _FAST,
    "analyze.ff": "sample.morris with analyze.morris",
    "analyze.hdmr": _SURROGATE,
    "analyze.pawn": _GIVEN,
    "analyze.radial_ee": _SCREEN,
    "analyze.rsa": _GIVEN,
    "analyze.shapley": _SHAPLEY,
    "analyze.sobol_jansen": "sample.sobol with analyze.sobol",
    "plotting.hdmr": _CHARTS,
    "plotting.morris": _CHARTS,
    "plotting.shapley": _CHARTS,
}


class _Others(MetaPathFinder):
    """Says of an import what to use in its place."""

    def find_spec(self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None) -> None:
        package, _, module = fullname.partition(f"{_PACKAGE}.")
        if not package and module in _INSTEAD:
            raise ImportError(f"{fullname} is not there: use {_INSTEAD[module]}", name=fullname)


sys.meta_path.append(_Others())
