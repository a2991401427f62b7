"""A predator and its prey in time: which rate decides the number of prey on each day."""

import apportion as ap
import numpy as np
from scipy.integrate import solve_ivp

DAYS = np.linspace(0.0, 10.0, 6)


def prey(birth, hunted, death):
    def rates(_, n):
        return [birth * n[0] - hunted * n[0] * n[1], hunted * n[0] * n[1] - death * n[1]]

    return {"prey": solve_ivp(rates, (0.0, 10.0), [5.0, 2.0], t_eval=DAYS, rtol=1e-6).y[0]}


factors = {"birth": (0.3, 0.5), "hunted": (0.08, 0.12), "death": (0.25, 0.35)}
outputs = {"prey": {"axis": "day", "positions": DAYS}}
result = ap.analyse(prey, factors, outputs=outputs, vectorised=False, base_samples=64)
against_time = result.series["prey"].total["birth"]
assert against_time.shape == (6, 3) and np.isnan(against_time[0, 0])
assert sum(float(index) for index in result.total.values()) > 0.9
