import csv
import random
import sys


def mean_wait(gap, service, spread, seed):
    """Mean wait in minutes of 100 customers of one clerk (Lindley 1952), who come at random."""
    draw = random.Random(seed)
    shape = 1 / spread**2
    wait = total = 0.0
    for _ in range(100):
        total += wait
        wait = max(0.0, wait + draw.gammavariate(shape, service / shape) - draw.expovariate(1 / gap))
    return total / 100


# One line in for each row, its number, the factor values and the seed; one line out, the number and the output.
for row in csv.DictReader(sys.stdin):
    number, seed = row.pop("id"), int(row.pop("seed"))
    print(number, mean_wait(**{name: float(value) for name, value in row.items()}, seed=seed), sep=",", flush=True)
