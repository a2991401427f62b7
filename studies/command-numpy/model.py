import sys

import numpy as np


def model(x1, x2, x3):
    return np.sin(x1) + 7 * np.sin(x2) ** 2 + 0.1 * x3**4 * np.sin(x1)


names = sys.stdin.buffer.readline().decode().strip().split(",")
rest = b""
# The rows that are there, however many: waiting for more of them would be waiting for ever.
while block := sys.stdin.buffer.read1(1 << 20):
    rows, _, rest = (rest + block).rpartition(b"\n")
    if rows:
        values = np.array(rows.replace(b"\n", b",").split(b","), dtype=float).reshape(-1, len(names))
        x = dict(zip(names, values.T))
        numbers = x.pop("id").astype(int).tolist()
        answers = model(**x).tolist()
        sys.stdout.write("".join(f"{number},{answer!r}\n" for number, answer in zip(numbers, answers)))
        sys.stdout.flush()
