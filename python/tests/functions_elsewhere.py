"""Functions that tests hand to other processes: they must be in a module that these can import."""

import os
import time

from conftest import polynomial


def row(x):
    return float(polynomial(*x))


def slow_row(x):
    time.sleep(0.005)
    return row(x)


class DiesOnce:
    """Kills its process the first time that it is called anywhere."""

    def __init__(self, mark):
        self.mark = mark

    def __call__(self, x1, x2, x3):
        try:
            os.close(os.open(self.mark, os.O_CREAT | os.O_EXCL))
        except FileExistsError:
            return polynomial(x1, x2, x3)
        os._exit(1)
