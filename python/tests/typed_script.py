"""What a user writes, for `mypy --strict`: a wrong keyword or choice is an error there, and so is an ignore without one."""

from typing_extensions import assert_type

import apportion as ap
import numpy as np
from numpy.typing import NDArray


def plume(rate: NDArray[np.float64], height: NDArray[np.float64], wind: NDArray[np.float64]) -> NDArray[np.float64]:
    return rate / wind * np.exp(-((height / 50.0) ** 2))


def main() -> None:
    factors = {"rate": ap.Uniform(1, 2, unit="g/s"), "height": ap.Normal(30, sd=5), "wind": ap.LogNormal(4, 1).truncated(1, 12)}
    assert_type(factors["rate"], ap.Factor)
    result = ap.analyse(plume, factors, base_samples=64, sampler="sobol", measures=["delta"], seed=np.random.default_rng(1))
    assert_type(result, ap.Result)
    assert_type(result["y"].total["wind"].estimate, float)
    assert_type(float(result.total["wind"] / 2), float)
    study = ap.Study(None, factors, base_samples=64, intervals="nets", version="1")
    assert_type(study.analyse(plume(*study.sample().T)), ap.Result)
    try:
        ap.Study(None, factors, sampler="halton")  # type: ignore[arg-type]
    except ap.StudyError as error:
        assert "sobol" in str(error)
    try:
        ap.analyse(plume, factors, base_samples=0.5)  # type: ignore[arg-type]
    except ap.StudyError as error:
        assert "base_samples" in str(error)


if __name__ == "__main__":
    main()
