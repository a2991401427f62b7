"""SALib's bars; `apportion.Result.plot` and the charts of a page show more."""

from .._problem import refused
from . import bar

__all__ = ["bar"]
__getattr__ = refused(
    __name__,
    {
        name: "the charts of ap.analyse(...), ap.Study(...).screen(): document.charts()"
        for name in ("hdmr", "heatmap", "morris", "shapley")
    },
)
