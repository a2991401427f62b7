"""Another cluster: the points go out as a file, and the outputs come back in any order of files."""

import tempfile
from pathlib import Path

import apportion as ap
import numpy as np
import pandas as pd

with tempfile.TemporaryDirectory() as folder:
    study = ap.Study(None, {"speed": (1, 2), "angle": (0, 1)}, base_samples=256, outputs=["range"])
    points = pd.DataFrame(study.sample(), columns=study.factors)
    for job in range(4):
        points[job::4].to_csv(Path(folder, f"job{job}.csv"))
    # What the jobs do.
    for path in sorted(Path(folder).glob("job*.csv"), reverse=True):
        done = pd.read_csv(path, index_col=0)
        done["range"] = done["speed"] ** 2 * np.sin(2 * done["angle"])
        done.to_csv(path)
    outputs = pd.concat([pd.read_csv(path, index_col=0) for path in sorted(Path(folder).glob("job*.csv"), reverse=True)])
    result = study.analyse(outputs[["range"]])
assert list(result) == ["range"] and result.total["angle"] > result.total["speed"]
