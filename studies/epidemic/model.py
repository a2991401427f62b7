"""An epidemic in steps of a quarter of a day: susceptible, exposed, infected and recovered shares of all people."""

import json
import sys

DAYS = 60
STEPS = 4


def infected_by_day(contacts, recovery, incubation, first_cases):
    """Percent of all people that are infected on each day."""
    exposed, infected = 0.0, first_cases / 100
    susceptible = 1.0 - infected
    days = []
    for step in range(DAYS * STEPS):
        if step % STEPS == 0:
            days.append(100 * infected)
        new = contacts * susceptible * infected / STEPS
        ill = exposed / incubation / STEPS
        susceptible -= new
        exposed += new - ill
        infected += ill - recovery * infected / STEPS
    return days


# One line in for each row, an object with its number and the factors; one line out, with the number and the outputs.
for line in sys.stdin:
    x = json.loads(line)
    number = x.pop("id")
    days = infected_by_day(**x)
    print(json.dumps({"id": number, "infected": days, "peak": max(days)}), flush=True)
