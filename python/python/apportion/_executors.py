"""Functions that run in other processes: any executor of `concurrent.futures` or of its kind."""

from __future__ import annotations

import concurrent.futures
import inspect
import os
import pickle
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from ._answers import AnswerError
from ._checks import whole
from ._engine import RunError, Stop, StudyError
from ._functions import Call
from ._repeated import RepeatedCall

# How often a block is handed out before the run gives up.
ATTEMPTS = 4
# Blocks under way for each worker, so that none waits for the next one.
AHEAD = 2
# A thread of the engine waits for each.
MAX_IN_FLIGHT = 8192


def workers_of(executor: Any, in_flight: int | None) -> int:
    """The number of blocks that an executor gets at a time: `in_flight`, or one according to its number of workers.

    A `StudyError` says what was expected if it is no executor.
    """
    if isinstance(executor, type) or not callable(getattr(executor, "submit", None)):
        raise StudyError(
            f"executor={executor!r}: expected an executor of concurrent.futures or of its kind, which has submit(), such as "
            "ProcessPoolExecutor(8)"
        )
    if in_flight is not None:
        return whole("in_flight", in_flight, 1, MAX_IN_FLIGHT)
    client = getattr(executor, "_client", None)
    count = os.cpu_count() or 1
    if client is not None and hasattr(client, "nthreads"):
        count = max(1, sum(client.nthreads().values()))
    else:
        for name in ("_max_workers", "num_workers", "max_workers"):
            stated = getattr(executor, name, None)
            if isinstance(stated, int) and stated > 0:
                count = stated
                break
    return min(AHEAD * count, MAX_IN_FLIGHT)


class _Closed(Exception):
    """The executor is broken or shut down: a retry is useless."""


class Blocks:
    """Submits blocks of rows to an executor and waits for their outputs; called from several threads at once."""

    def __init__(self, executor: Any, call: Call | RepeatedCall, stop: Stop):
        self.executor = executor
        self.stop = stop
        # Threads need no copy.
        is_here = isinstance(executor, concurrent.futures.ThreadPoolExecutor)
        self.call = call if is_here else _portable(call)

    def __call__(self, columns: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
        x = np.ascontiguousarray(columns.T)
        for attempt in range(1, ATTEMPTS + 1):
            try:
                values, failures = self._once(x)
                # What comes from other processes may lie anywhere in a buffer; the engine reads aligned numbers.
                return np.require(values, float, ["C", "ALIGNED"]), failures
            except (AnswerError, KeyboardInterrupt, pickle.PicklingError):
                raise
            except Exception as error:
                # The function's own exceptions are answers: this is one of the workers, or the way to them.
                is_gone = isinstance(error, (_Closed, concurrent.futures.BrokenExecutor))
                if is_gone or self.stop.is_set() or attempt == ATTEMPTS:
                    often = "" if is_gone else f" {attempt} times"
                    words = str(error) if isinstance(error, _Closed) else f"{type(error).__name__}: {error}"
                    raise RunError(f"the executor failed{often} over a block of {len(x)} rows: {words}") from error
                time.sleep(0.1 * attempt)
        raise AssertionError("unreachable")

    def _once(self, x: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
        try:
            future = self.executor.submit(_evaluate, self.call, x)
        except RuntimeError as error:
            raise _Closed(f"it accepts no more work: {error}") from error
        # Those of submitit have a result() without a timeout.
        takes_timeout = "timeout" in inspect.signature(future.result).parameters
        while True:
            try:
                if takes_timeout:
                    return future.result(timeout=0.2)
                if not future.done():
                    time.sleep(0.2)
            except (concurrent.futures.TimeoutError, TimeoutError):
                pass
            if future.done():
                return future.result()
            if self.stop.is_set():
                future.cancel()
                raise RunError("interrupted")


def _evaluate(call: Any, x: np.ndarray) -> tuple[np.ndarray, list[tuple[int, str]]]:
    """Runs in the worker."""
    call = call.load() if isinstance(call, _ByValue) else call
    values, failures = call.evaluate(call.rows(x))
    # The function may use its array again before this one is read.
    return values.copy(), failures


class _ByValue:
    """A call that is sent with the code of its function, as functions of notebooks must be."""

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
    """The call as sent to another process: by reference if the function can be imported there, otherwise with its code."""
    try:
        data, reason = pickle.dumps(call), None
    except Exception as error:
        data, reason = b"", error
    # What refers to the script or notebook, at any place in the function, is not found by workers that start again.
    if reason is None and b"__main__" not in data:
        return call
    try:
        import cloudpickle
    except ImportError:
        if reason is None:
            return call
        raise RunError(_words(reason) + ": define it in a module, or install cloudpickle") from reason
    try:
        return _ByValue(cloudpickle.dumps(call))
    except Exception as error:
        words = "make what cannot go (a lock, a file, a connection) inside of the function, or use a ThreadPoolExecutor"
        raise RunError(f"{_words(error)}: {words}") from error


def _words(error: Exception) -> str:
    return f"the function cannot be sent to another process ({type(error).__name__}: {error})"


def called_elsewhere(executor: Any, call: Call | RepeatedCall, stop: Stop) -> Callable[..., Any]:
    """The function that the engine calls."""
    return Blocks(executor, call, stop)
