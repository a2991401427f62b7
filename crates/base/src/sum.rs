//! Sums of fixed shape: the same operands give the same bits on any number of threads.
//!
//! Each sum runs in [`LANES`] interleaved partial sums that are joined pairwise at the end. This fixes the order of the
//! additions, keeps the rounding error of a block near eps sqrt(n), and lets the compiler use vector instructions.

use multiversion::multiversion;

/// Number of interleaved partial sums.
pub const LANES: usize = 8;

/// Returns the sum of `f(i)` for `i` in `0..n`, in the fixed shape.
#[inline(always)]
pub fn sum_by(n: usize, f: impl Fn(usize) -> f64) -> f64 {
    let [sum] = sums_by(n, |i| [f(i)]);
    sum
}

/// Returns the sums of several terms at once, each in the fixed shape.
#[expect(clippy::needless_range_loop, reason = "the compiler makes one wide register of the lanes of this form")]
#[inline(always)]
pub fn sums_by<const K: usize>(n: usize, f: impl Fn(usize) -> [f64; K]) -> [f64; K] {
    let mut lanes = [[0.0; LANES]; K];
    let in_full_rounds = n - n % LANES;
    let mut i = 0;
    while i < in_full_rounds {
        for lane in 0..LANES {
            let terms = f(i + lane);
            for k in 0..K {
                lanes[k][lane] += terms[k];
            }
        }
        i += LANES;
    }
    for (lane, i) in (in_full_rounds..n).enumerate() {
        let terms = f(i);
        for k in 0..K {
            lanes[k][lane] += terms[k];
        }
    }
    lanes.map(|l| ((l[0] + l[1]) + (l[2] + l[3])) + ((l[4] + l[5]) + (l[6] + l[7])))
}

/// Returns the arithmetic mean of `x`; 0 if it is empty.
///
/// The mean is taken relative to the first value, so that an offset common to all values costs no digits.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn mean(x: &[f64]) -> f64 {
    let Some(&origin) = x.first() else { return 0.0 };
    origin + sum_by(x.len(), |i| x[i] - origin) / x.len() as f64
}

/// Returns the sum of x y over the common length of `x` and `y`.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn product(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len().min(y.len());
    let (x, y) = (&x[..n], &y[..n]);
    sum_by(n, |i| x[i] * y[i])
}

/// Adds `weight` times `other` to `column`.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn add_scaled(column: &mut [f64], weight: f64, other: &[f64]) {
    for (value, other) in column.iter_mut().zip(other) {
        *value += weight * other;
    }
}

/// Returns the sum of (x - mean_x)(y - mean_y) over the common length of `x` and `y`.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn centred_product(x: (&[f64], f64), y: (&[f64], f64)) -> f64 {
    let ((x, mean_x), (y, mean_y)) = (x, y);
    let n = x.len().min(y.len());
    let (x, y) = (&x[..n], &y[..n]);
    sum_by(n, |i| (x[i] - mean_x) * (y[i] - mean_y))
}

/// Returns the [centred products](centred_product) of `z` with `x`, `y` and itself in one pass; all have one length.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn centred_products(x: (&[f64], f64), y: (&[f64], f64), z: (&[f64], f64)) -> [f64; 3] {
    let ((x, mean_x), (y, mean_y), (z, mean_z)) = (x, y, z);
    let n = z.len();
    let (x, y) = (&x[..n], &y[..n]);
    sums_by(n, |i| {
        let centred = z[i] - mean_z;
        [(x[i] - mean_x) * centred, (y[i] - mean_y) * centred, centred * centred]
    })
}

/// Returns the smallest and the largest of finite values; infinities if there are none.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
pub fn range(x: &[f64]) -> (f64, f64) {
    let (mut low, mut high) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
    for chunk in x.chunks(LANES) {
        for (lane, &value) in chunk.iter().enumerate() {
            low[lane] = if value < low[lane] { value } else { low[lane] };
            high[lane] = if value > high[lane] { value } else { high[lane] };
        }
    }
    (low.into_iter().fold(f64::INFINITY, f64::min), high.into_iter().fold(f64::NEG_INFINITY, f64::max))
}

/// Returns the values times 2^-e, and e, such that the largest magnitude lies between 1 and 2: sums of their powers
/// neither overflow nor underflow, and no digit is lost. Values must be finite; e is 0 if all are zero.
pub fn rescaled(x: &[f64]) -> (Vec<f64>, i32) {
    let largest = x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let exponent = if largest == 0.0 { 0 } else { libm::ilogb(largest) };
    (x.iter().map(|&v| libm::scalbn(v, -exponent)).collect(), exponent)
}

#[cfg(test)]
#[path = "tests/sum.rs"]
mod tests;
