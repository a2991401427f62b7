"""SALib's bars and heat maps; the charts of results, `document.charts()` and `document.plot()`, show more."""

from . import bar, heatmap

__all__ = ["bar", "heatmap"]
