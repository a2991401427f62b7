//! Sums of fixed shape: the same operands give the same bits, however many threads there are.
//!
//! Each sum runs in [`LANES`] interleaved partial sums that are joined pairwise at the end. This fixes the order of the
//! additions, keeps the rounding error of a block near eps sqrt(n), and lets the compiler use vector instructions.

/// Number of interleaved partial sums.
pub const LANES: usize = 8;

/// Sum of `f(i)` for `i` in `0..n`, in the fixed shape.
#[inline(always)]
pub(crate) fn sum_by(n: usize, f: impl Fn(usize) -> f64) -> f64 {
    let mut lanes = [0.0; LANES];
    let whole = n - n % LANES;
    let mut i = 0;
    while i < whole {
        for (lane, sum) in lanes.iter_mut().enumerate() {
            *sum += f(i + lane);
        }
        i += LANES;
    }
    for (sum, i) in lanes.iter_mut().zip(whole..n) {
        *sum += f(i);
    }
    ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]))
}

/// Arithmetic mean of `x`; 0 for no values.
///
/// The mean is taken relative to the first value, so that an offset common to all values costs no digits.
pub fn mean(x: &[f64]) -> f64 {
    let Some(&origin) = x.first() else { return 0.0 };
    origin + sum_by(x.len(), |i| x[i] - origin) / x.len() as f64
}

/// Sum of x y over the common length of `x` and `y`.
pub fn product(x: &[f64], y: &[f64]) -> f64 {
    let n = x.len().min(y.len());
    let (x, y) = (&x[..n], &y[..n]);
    sum_by(n, |i| x[i] * y[i])
}

/// Sum of (x - mean_x)(y - mean_y) over the common length of `x` and `y`.
pub fn centred_product((x, mean_x): (&[f64], f64), (y, mean_y): (&[f64], f64)) -> f64 {
    let n = x.len().min(y.len());
    let (x, y) = (&x[..n], &y[..n]);
    sum_by(n, |i| (x[i] - mean_x) * (y[i] - mean_y))
}

/// The values times 2^-e, and e, which brings the largest magnitude between 1 and 2: sums of powers of them can neither
/// overflow nor vanish, and no digit is lost. Values are finite; e is 0 if all are zero.
pub(crate) fn rescaled(x: &[f64]) -> (Vec<f64>, i32) {
    let largest = x.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let exponent = if largest == 0.0 { 0 } else { libm::ilogb(largest) };
    (x.iter().map(|&v| libm::scalbn(v, -exponent)).collect(), exponent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_cases_by_hand() {
        assert_eq!(mean(&[]), 0.0);
        assert_eq!(mean(&[3.0]), 3.0);
        assert_eq!(mean(&[1.0, 2.0, 6.0]), 3.0);
        let (x, y) = ([1.0, 2.0, 6.0], [0.0, 3.0, 0.0]);
        assert_eq!(centred_product((&x, 3.0), (&y, 1.0)), 2.0 - 2.0 - 3.0);
    }

    #[test]
    fn every_element_counts_once_at_any_length() {
        for n in 0..50 {
            let x: Vec<f64> = (0..n).map(|i| (1u64 << i) as f64).collect();
            assert_eq!(centred_product((&x, 0.0), (&vec![1.0; n], 0.0)), (1u64 << n) as f64 - 1.0);
        }
    }

    #[test]
    fn a_large_offset_costs_no_digits_of_the_spread() {
        // The offset leaves the small integers exact; the mean is known to half of 2^-12, which enters squared.
        let spread: Vec<f64> = (0..1001).map(|i| f64::from(i % 7)).collect();
        let shifted: Vec<f64> = spread.iter().map(|x| x + 2f64.powi(40)).collect();
        let centred = |x: &[f64]| centred_product((x, mean(x)), (x, mean(x)));
        assert!((centred(&shifted) / centred(&spread) - 1.0).abs() < 1e-8);
    }

    #[test]
    fn equal_values_have_no_spread() {
        for value in [0.1, 1e300, -7e-300, 1.0 / 3.0] {
            let x = vec![value; 777];
            assert_eq!(mean(&x), value);
            assert_eq!(centred_product((&x, mean(&x)), (&x, mean(&x))), 0.0);
        }
    }
}
