"""SALib's analyses: `sobol`, `morris`, `rbd_fast`."""

from . import morris, rbd_fast, sobol

__all__ = ["morris", "rbd_fast", "sobol"]
