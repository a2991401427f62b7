import csv
import sys
from math import sin


def model(x1, x2, x3):
    return sin(x1) + 7 * sin(x2) ** 2 + 0.1 * x3**4 * sin(x1)


# One line of factor values in, one line of outputs out.
for row in csv.DictReader(sys.stdin):
    x = {name: float(value) for name, value in row.items()}
    print(model(**x), flush=True)
