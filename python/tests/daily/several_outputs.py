"""Cost and yield of a reactor: a table of both, and which factor matters for the two together."""

import apportion as ap


def reactor(temperature, time, feed):
    return {"cost": temperature * time + 3 * feed, "yield": feed * temperature**0.5}


factors = {"temperature": ap.Normal(350, 10, unit="K"), "time": ap.Uniform(1, 2, unit="h"), "feed": ap.LogNormal(5, 0.5)}
result = ap.analyse(reactor, factors, outputs={"cost": "1", "yield": "1"}, base_samples=512, aggregate=True)
frame = result.to_frame()
assert frame.loc[("yield", "time"), "total"] == 0
assert result["cost"].total["time"] > 0.9 and result["yield"].total["feed"] > 0.9
assert frame.loc[("all outputs", "time"), "total"] == float(result.aggregate.total["time"])
