import csv
import sys

# One line in for each row: its number and the factor values. One line out: the number and the outputs.
# Print nothing else, or to sys.stderr.
for row in csv.DictReader(sys.stdin):
    number = row.pop("id")
    x = {{name: float(value) for name, value in row.items()}}
    y = {sum}
    print(number, {values}, sep=",", flush=True)    # id, {outputs}
