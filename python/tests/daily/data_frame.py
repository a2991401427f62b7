"""A table of old runs, with text, and rows without an output."""

import warnings

import apportion as ap
import numpy as np
import pandas as pd

rng = np.random.default_rng(2)
runs = pd.DataFrame({"depth": rng.uniform(1, 5, 400), "soil": rng.choice(["clay", "loam", "sand"], 400), "seed": rng.random(400)})
runs["settled"] = runs["depth"] ** 2 + 8.0 * (runs["soil"] == "clay")
runs.loc[rng.random(400) < 0.05, "settled"] = np.nan

with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    found = ap.given_data(runs[["depth", "soil", "seed"]], runs["settled"])
assert any("rows have no output" in str(warning.message) for warning in caught)
first = found.to_frame()["first_order"].droplevel("output")
assert first["depth"] > 0.5 and first["soil"] > 0.1 and abs(first["seed"]) < 0.1
