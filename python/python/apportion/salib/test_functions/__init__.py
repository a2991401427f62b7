"""Functions with known indices; the engine has more of them by name: `ap.Study("ishigami")`."""

from . import Ishigami, Sobol_G

__all__ = ["Ishigami", "Sobol_G"]
