"""Groups of inputs: soil and weather against each other, and each factor in them."""

import apportion as ap

factors = {
    "clay": ap.Uniform(0, 1, group="soil"),
    "lime": ap.Uniform(0, 1, group="soil"),
    "rain": ap.Normal(1, 0.3, group="weather"),
    "sun": ap.Normal(1, 0.2, group="weather"),
}
result = ap.analyse(lambda clay, lime, rain, sun: clay * rain + lime + sun, factors, base_samples=1024)
groups = result.groups()
assert set(groups) == {"soil", "weather"} and groups["soil"] > groups["weather"]
assert list(result.to_frame().query("kind == 'group'").index) == ["soil", "weather"]
alone = ap.analyse(lambda clay, lime, rain, sun: clay * rain + lime + sun, factors, base_samples=1024, indices_of="groups")
assert alone.runs < result.runs and abs(float(alone.total["soil"]) - float(groups["soil"])) < 0.01
