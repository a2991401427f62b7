"""The engine, as the package calls it."""

from collections.abc import Callable
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

__version__: str
__all__ = ["__version__", "StudyError", "RunError", "Study", "Document", "Stop", "distributions", "given_data", "unlikely", "read_document", "in_words"]

class StudyError(ValueError):
    problem: str
class RunError(RuntimeError):
    result: Any

@final
class Stop:
    def is_set(self) -> bool: ...

@final
class Document:
    @property
    def name(self) -> str: ...
    @property
    def lead(self) -> list[str]: ...
    def json(self) -> str: ...
    def text(self) -> str: ...
    def html(self) -> str: ...
    def charts(self) -> list[tuple[str, str]]: ...
    def tables(self) -> list[tuple[str, str]]: ...
    def save(self, folder: str, formats: list[str], width: str | None) -> str: ...

@final
class Study:
    @staticmethod
    def parse(text: str, path: str, overrides: list[str]) -> Study: ...
    @staticmethod
    def load(path: str, overrides: list[str]) -> Study: ...
    @property
    def name(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def factors(self) -> list[tuple[str, str]]: ...
    @property
    def outputs(self) -> list[tuple[str, str]]: ...
    @property
    def runs(self) -> int: ...
    @property
    def rows_per_point(self) -> int: ...
    @property
    def base_samples(self) -> int: ...
    @property
    def replicates(self) -> int: ...
    @property
    def grows(self) -> bool: ...
    @property
    def is_external(self) -> bool: ...
    def sample(self, first: int, last: int, step: int) -> NDArray[np.float64]: ...
    def evaluate(self, points: NDArray[np.float64]) -> tuple[NDArray[np.float64], list[tuple[int, str, str]]]: ...
    def run(
        self,
        function: dict[str, Any] | None,
        stop: Stop,
        *,
        threads: int,
        journal: str | None,
        resume: str,
        progress: Callable[[int, int, int, int], None] | None,
        message: Callable[[str], None] | None,
    ) -> Document: ...
    def analyse(self, outputs: NDArray[np.float64]) -> Document: ...
    def screen(
        self,
        function: dict[str, Any] | None,
        stop: Stop,
        *,
        trajectories: int,
        levels: int | None,
        seed: int | None,
        threads: int,
        journal: str | None,
        resume: str,
        progress: Callable[[int, int, int, int], None] | None,
        message: Callable[[str], None] | None,
    ) -> Document: ...
    def sweep(
        self,
        function: dict[str, Any] | None,
        stop: Stop,
        factors: list[str],
        points: int,
        *,
        journal: str | None,
        resume: str,
        progress: Callable[[int, int, int, int], None] | None,
        message: Callable[[str], None] | None,
    ) -> Document: ...

def given_data(
    inputs: tuple[list[str], NDArray[np.float64]],
    outputs: tuple[list[str], NDArray[np.float64]],
    *,
    measures: bool,
    distributions: Study | None,
    seed: int,
    name: str,
    sha256: str,
) -> Document: ...
def unlikely(y: NDArray[np.float64], independent: NDArray[np.float64]) -> str | None: ...
def distributions() -> list[tuple[str, str, list[tuple[str, str, str, bool, float | None]]]]: ...
def in_words(estimate: float, low: float, high: float) -> str: ...
def read_document(json: str, name: str) -> Document: ...
