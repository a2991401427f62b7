"""Functions that are called elsewhere: any executor of `concurrent.futures` or of its kind."""

from __future__ import annotations

import concurrent.futures
import os
import pickle
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from ._engine import RunError, Stop
from ._functions import AnswerError, Call
from ._repeated import RepeatedCall

# How often a block is handed out before the run gives up.
ATTEMPTS = 4
# Blocks under way for each worker, so that none waits for the next one.
AHEAD = 2


def workers_of(executor: Any) -> int:
    """How many workers an executor has, as far as it tells."""
    client = getattr(executor, "_client", None)
    if client is not None and hasattr(client, "nthreads"):
        return max(1, sum(client.nthreads().values()))
    for name in ("_max_workers", "num_workers", "max_workers"):
        count = getattr(executor, name, None)
        if isinstance(count, int) and count > 0:
            return count
    return os.cpu_count() or 1


class Blocks:
    """Hands blocks of rows to an executor and waits for their outputs; called from several threads at once."""

    def __init__(self, executor: Any, call: Call | RepeatedCall, stop: Stop):
        self.executor = executor
        self.stop = stop
        self.call = _portable(call)

    def __call__(self, columns: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
        x = np.ascontiguousarray(columns.T)
        for attempt in range(1, ATTEMPTS + 1):
            try:
                return self._once(x)
            except (AnswerError, KeyboardInterrupt, pickle.PicklingError):
                raise
            except Exception as error:
                # The function's own exceptions are answers: this is one of the workers, or the way to them.
                if self.stop.is_set() or attempt == ATTEMPTS:
                    raise RunError(
                        f"the executor failed {attempt} times over a block of {len(x)} rows: {type(error).__name__}: {error}"
                    ) from error
                time.sleep(0.1 * attempt)
        raise AssertionError("unreachable")

    def _once(self, x: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
        future = self.executor.submit(_evaluate, self.call, x)
        while True:
            try:
                return future.result(timeout=0.2)
            except (concurrent.futures.TimeoutError, TimeoutError):
                if future.done():
                    return future.result()
                if self.stop.is_set():
                    future.cancel()
                    raise RunError("interrupted") from None


def _evaluate(call: Any, x: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
    """In the worker."""
    return (call.load() if isinstance(call, _ByValue) else call).evaluate(x)


class _ByValue:
    """A call whose function goes along with its code, as those of notebooks must."""

    def __init__(self, data: bytes):
        self.data = data
        self._call: Call | RepeatedCall | None = None

    def __getstate__(self) -> bytes:
        return self.data

    def __setstate__(self, data: bytes) -> None:
        self.data = data
        self._call = None

    def load(self) -> Call | RepeatedCall:
        if self._call is None:
            self._call = pickle.loads(self.data)
        return self._call


def _portable(call: Call | RepeatedCall) -> Any:
    module = getattr(call.function, "__module__", None)
    try:
        if module != "__main__":
            pickle.dumps(call)
            return call
    except Exception:
        pass
    try:
        import cloudpickle
    except ImportError:
        try:
            pickle.dumps(call)
        except Exception as error:
            raise RunError(
                f"the function cannot go to another process ({error}): define it in a module, or install cloudpickle"
            ) from error
        return call
    return _ByValue(cloudpickle.dumps(call))


def called_elsewhere(executor: Any, call: Call | RepeatedCall, stop: Stop, workers: int | None) -> tuple[Callable[..., Any], int]:
    """What the engine calls, and from how many threads."""
    count = workers if workers is not None else AHEAD * workers_of(executor)
    return Blocks(executor, call, stop), max(1, count)
