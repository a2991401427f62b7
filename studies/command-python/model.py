import csv
import sys
from math import sin


def model(x1, x2, x3):
    return sin(x1) + 7 * sin(x2) ** 2 + 0.1 * x3**4 * sin(x1)


# One line in for each row, its number and the factor values; one line out, the number and the output.
for row in csv.DictReader(sys.stdin):
    number = row.pop("id")
    x = {name: float(value) for name, value in row.items()}
    print(number, model(**x), sep=",", flush=True)
