"""Progress and messages of a run."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

from ._warnings import warn


def say(line: str) -> None:
    if line.startswith("warning: "):
        warn(line.removeprefix("warning: "))
    else:
        print(line, file=sys.stderr)


_SECONDS_OF_A_LINE = 60.0


class Progress:
    """Reports the progress of a run."""

    def __init__(self, asked: bool | Callable[[int, int], None] | None, name: str):
        self.asked, self.name = asked, name
        self.begun = time.monotonic()
        self.bar: Any = None
        self.make: Any = None
        if asked is True or asked is None and _is_watched():
            try:
                from tqdm.auto import tqdm

                self.make = tqdm
            except ImportError:
                self.make = _Lines

    @property
    def callback(self) -> Callable[[int, int, int, int], None] | None:
        if callable(self.asked):
            return lambda done, total, failed, recalled: self.asked(done, total)  # type: ignore[operator, misc]
        return self._draw if self.make is not None else None

    def _draw(self, done: int, total: int, failed: int, recalled: int) -> None:
        # Short runs need no bar.
        if self.bar is None and time.monotonic() - self.begun < 1.0:
            return
        if self.bar is None:
            self.bar = self.make(total=total, desc=self.name, unit="run", unit_scale=True)
            # Of the run.
            self.bar.start_t = time.time() - (time.monotonic() - self.begun)
        self.bar.total = total
        self.bar.update(done - self.bar.n)

    def __enter__(self) -> "Progress":
        return self

    def __exit__(self, *_: object) -> None:
        if self.bar is not None:
            self.bar.close()


class _Lines:
    """A line a minute, with the interface of a bar of tqdm."""

    def __init__(self, total: int, desc: str, **_: Any):
        self.total, self.desc, self.n = total, desc, 0
        self.start_t = self.said = time.time()

    def update(self, runs: int) -> None:
        self.n += runs
        now = time.time()
        if now - self.said >= _SECONDS_OF_A_LINE and self.n:
            left = (self.total - self.n) * (now - self.start_t) / self.n / 60.0
            self.said = now
            say(f"{self.desc}: {self.n} of {self.total} runs, about {left:.1f} minutes left")

    def close(self) -> None:
        pass


def _is_watched() -> bool:
    return "ipykernel" in sys.modules or bool(getattr(sys.stderr, "isatty", lambda: False)())
