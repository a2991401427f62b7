"""A thousand outputs by jaxgsa: the study of `cargo bench --bench many_outputs`, 82 million numbers.

    JAX_ENABLE_X64=1 python tests/peers/many_outputs.py [BOOTSTRAPS]

needs Python 3.12 and `pip install jaxgsa`. Prints the processor seconds of sampling and model, those of the analysis with and without
compilation, and the largest error of a total index.
"""

import sys
import time

import jax
import jaxgsa
import numpy as np

FACTORS, OUTPUTS, BASE_SAMPLES = 8, 1000, 8192


def timed(work):
    """What `work` returns, and its processor seconds."""
    start = time.process_time()
    done = work()
    return done, time.process_time() - start


outputs = np.arange(OUTPUTS)[:, None]
weights = 1.0 + (7 * outputs + 3 * np.arange(FACTORS)) % 11


def model(x):
    return x**2 @ weights.T + 3 * (x[:, 0] * x[:, 1])[:, None]


def totals():
    """The exact total indices: V(w x^2) = 4 w^2/45, Cov(w x^2, 3 x y) = w/8, V(3 x y) = 7/16, of which 3/16 are of each factor alone."""
    alone = 4 / 45 * weights**2
    shared = np.zeros_like(alone)
    shared[:, :2] = weights[:, :2] / 4 + 1 / 4
    variance = (alone.sum(1) + weights[:, :2].sum(1) / 4 + 7 / 16)[:, None]
    return (alone + shared) / variance


problem = jaxgsa.Problem([f"x{j}" for j in range(FACTORS)], [(0.0, 1.0)] * FACTORS)
design, sampling = timed(
    lambda: jaxgsa.sobol.sample(problem, base_n=BASE_SAMPLES, calc_second_order=False, seed=1, verbose=False)
)
x = np.asarray(design.samples)
y, of_model = timed(lambda: model(x))
bootstraps = int(sys.argv[1]) if len(sys.argv) > 1 else 0


def analysed():
    return jax.block_until_ready(jaxgsa.sobol.analyze(design, y, n_bootstrap=bootstraps, key=1, verbose=False).ST)


(_, first), (total, again) = timed(analysed), timed(analysed)
error = np.abs(np.asarray(total).reshape(OUTPUTS, FACTORS) - totals()).max()
print(f"{y.size} numbers: sampling {sampling:.2f} s, model {of_model:.2f} s", end=", ")
print(f"analysis {first:.2f} s, compiled {again:.2f} s, error {error:.1e}")
