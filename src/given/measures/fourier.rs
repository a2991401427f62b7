//! The first-order index from the spectrum of the output.

use std::f64::consts::TAU;

/// Harmonics that count as the effect of the input.
const HARMONICS: usize = 10;

/// Computes the first-order index from the centred outputs in ascending order of the input; `starts` are the places at
/// which a new value of the input begins, and the number of rows.
///
/// Every second row in ascending order, followed by the others in descending order, is one period of a wave, whose
/// first harmonics contain the effect of the input (Plischke 2010), minus the expected noise (Tissot and Prieur 2012).
/// Rows with the same input have no order: the power is the mean over all of their orders, in closed form.
pub fn first_order(sorted: &[f64], starts: &[usize]) -> f64 {
    let rows = sorted.len();
    let ties: Vec<Tie> = starts.windows(2).map(|ends| Tie::new(&sorted[ends[0]..ends[1]])).collect();
    let mut tie_of = vec![0; rows];
    for (tie, ends) in starts.windows(2).enumerate() {
        tie_of[ends[0]..ends[1]].fill(tie);
    }
    let wave: Vec<usize> = tie_of.iter().step_by(2).chain(tie_of.iter().skip(1).step_by(2).rev()).copied().collect();
    let total: f64 = sorted.iter().map(|z| z * z).sum();
    let harmonics = HARMONICS.min((rows - 1) / 2);
    let power: f64 = (1..=harmonics).map(|harmonic| power(&ties, &wave, harmonic)).sum();
    let share = 2.0 * power / (rows as f64 * total);
    let noise = 2.0 * harmonics as f64 / rows as f64;
    share - noise / (1.0 - noise) * (1.0 - share)
}

/// Returns the power of one harmonic of a wave of rows with these `ties`.
fn power(ties: &[Tie], wave: &[usize], harmonic: usize) -> f64 {
    let rows = wave.len();
    let (sine, cosine) = libm::sincos(TAU * harmonic as f64 / rows as f64);
    let (mut at, mut sums) = ((1.0, 0.0), vec![(0.0, 0.0); ties.len()]);
    for (k, &tie) in wave.iter().enumerate() {
        // Computed directly from time to time, because rounding grows with the rows.
        if k % 256 == 0 {
            let (sine, cosine) = libm::sincos(TAU * (harmonic * k % rows) as f64 / rows as f64);
            at = (cosine, sine);
        }
        let sum: &mut (f64, f64) = &mut sums[tie];
        *sum = (sum.0 + at.0, sum.1 + at.1);
        at = (at.0 * cosine - at.1 * sine, at.0 * sine + at.1 * cosine);
    }
    let (mut re, mut im, mut spread) = (0.0, 0.0, 0.0);
    for (tie, (cosines, sines)) in ties.iter().zip(sums) {
        re += tie.mean * cosines;
        im += tie.mean * sines;
        // For values in random order at fixed places.
        spread += tie.variance * (tie.rows - (cosines * cosines + sines * sines) / tie.rows);
    }
    re * re + im * im + spread
}

/// Outputs of rows with the same input.
struct Tie {
    rows: f64,
    mean: f64,
    /// With the divisor n - 1; 0 for a single row.
    variance: f64,
}

impl Tie {
    fn new(outputs: &[f64]) -> Self {
        let rows = outputs.len() as f64;
        let mean = outputs.iter().sum::<f64>() / rows;
        let squares: f64 = outputs.iter().map(|z| (z - mean) * (z - mean)).sum();
        Self { rows, mean, variance: if rows > 1.0 { squares / (rows - 1.0) } else { 0.0 } }
    }
}

#[cfg(test)]
#[path = "tests/fourier.rs"]
mod tests;
