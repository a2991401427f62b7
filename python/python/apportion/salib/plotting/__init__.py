"""SALib's bars; the charts of results, `document.charts()` and `document.plot()`, show more."""

from . import bar

__all__ = ["bar"]
