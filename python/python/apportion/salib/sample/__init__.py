"""Points for SALib's analyses: `sobol`, `saltelli`, `morris`, `latin`."""

from . import latin, morris, saltelli, sobol

__all__ = ["latin", "morris", "saltelli", "sobol"]
