//! Roots of functions of one variable that may not exist everywhere.

/// The first zero of `function` along `grid`, to the last digits of its argument: between two neighbours of different
/// sign, or at one of them. NaN where the function does not exist. Zeros that `accept` refuses (steps, poles) are
/// passed over.
pub(super) fn first_zero<T>(
    grid: impl Iterator<Item = f64>,
    function: impl Fn(f64) -> f64,
    accept: impl Fn(f64) -> Option<T>,
) -> Option<T> {
    let mut before: Option<(f64, f64)> = None;
    for x in grid {
        let y = function(x);
        if y == 0.0
            && let Some(found) = accept(x)
        {
            return Some(found);
        }
        if let Some((from, start)) = before
            && start * y < 0.0
            && let Some(found) = accept(bisected((from, start), x, &function))
        {
            return Some(found);
        }
        before = y.is_finite().then_some((x, y));
    }
    None
}

/// The zero between `low` (with its value) and `high`, where the function has the other sign.
fn bisected((mut low, start): (f64, f64), mut high: f64, function: &impl Fn(f64) -> f64) -> f64 {
    loop {
        let middle = low + (high - low) / 2.0;
        if middle == low || middle == high {
            return middle;
        }
        let y = function(middle);
        if y == 0.0 || y.is_nan() {
            return middle;
        }
        if y.signum() == start.signum() { low = middle } else { high = middle }
    }
}

/// `count` numbers from `from` to `to`, both included, at equal distances.
pub(super) fn evenly(from: f64, to: f64, count: u32) -> impl Iterator<Item = f64> {
    let last = f64::from(count - 1);
    (0..count).map(f64::from).map(move |k| if k == last { to } else { from + (to - from) * (k / last) })
}
