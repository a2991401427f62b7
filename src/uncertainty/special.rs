//! Special functions for variance components.

/// Returns the bias of the logarithm of a mean square with `freedom` degrees of freedom: E ln(chi^2_f / f) = psi(f/2) -
/// ln(f/2).
pub(super) fn log_bias(freedom: f64) -> f64 {
    digamma(freedom / 2.0) - libm::log(freedom / 2.0)
}

/// Returns the variance of the logarithm of a mean square with `freedom` degrees of freedom: psi'(f/2).
pub(super) fn log_variance(freedom: f64) -> f64 {
    trigamma(freedom / 2.0)
}

/// Returns the degrees of freedom of the mean square whose logarithm has the variance `variance` > 0.
pub(super) fn freedom_of_log_variance(variance: f64) -> f64 {
    // Newton on 1/psi', which is nearly a line and convex (Smyth 2004, Stat. Appl. Genet. Mol. Biol. 3, appendix): from
    // 1/2 + 1/v it converges from one side in a few steps.
    let mut x = 0.5 + 1.0 / variance;
    for _ in 0..50 {
        let tri = trigamma(x);
        let step = tri * (1.0 - tri / variance) / tetragamma(x);
        x += step;
        if -step / x < 1e-10 {
            break;
        }
    }
    2.0 * x
}

/// Returns the sum of `term` at x, x + 1, ... as far as these are below 10, and the next of them.
fn below_ten(mut x: f64, term: fn(f64) -> f64) -> (f64, f64) {
    let mut sum = 0.0;
    while x < 10.0 {
        sum += term(x);
        x += 1.0;
    }
    (sum, x)
}

/// Returns psi(x) for x > 0: by the recurrence psi(x) = psi(x + 1) - 1/x up to 10, then by the asymptotic series
/// (Abramowitz and Stegun 1964, 6.3.18), whose first omitted term is below 1e-15 there.
fn digamma(x: f64) -> f64 {
    let (sum, x) = below_ten(x, |x| -1.0 / x);
    let y = 1.0 / (x * x);
    let series = y * (1.0 / 12.0 - y * (1.0 / 120.0 - y * (1.0 / 252.0 - y * (1.0 / 240.0 - y * (1.0 / 132.0)))));
    sum + libm::log(x) - 0.5 / x - series
}

/// Returns psi'(x) for x > 0: by the recurrence psi'(x) = psi'(x + 1) + 1/x^2 up to 10, then by the asymptotic series
/// (Abramowitz and Stegun 1964, 6.4.12), whose first omitted term is below 1e-14 there.
fn trigamma(x: f64) -> f64 {
    let (sum, x) = below_ten(x, |x| 1.0 / (x * x));
    let y = 1.0 / (x * x);
    let series = y * (1.0 / 6.0 - y * (1.0 / 30.0 - y * (1.0 / 42.0 - y * (1.0 / 30.0 - y * (5.0 / 66.0)))));
    sum + 1.0 / x + y / 2.0 + series / x
}

/// Returns psi''(x) for x > 0, likewise (6.4.13).
fn tetragamma(x: f64) -> f64 {
    let (sum, x) = below_ten(x, |x| -2.0 / (x * x * x));
    let y = 1.0 / (x * x);
    sum - y - y / x - y * y * (0.5 - y * (1.0 / 6.0 - y * (1.0 / 6.0 - y * (3.0 / 10.0))))
}

#[cfg(test)]
#[path = "tests/special.rs"]
mod tests;
