//! The first-order index from the spectrum of the output.

use std::f64::consts::TAU;

/// Harmonics that count as the effect of the input.
const HARMONICS: usize = 10;

/// The first-order index from the centred outputs in ascending order of the input.
///
/// Every second row up and the others down again make one period of a wave, whose first harmonics carry what the output owes to
/// the input (Plischke 2010), less what noise would put there (Tissot and Prieur 2012).
pub fn first_order(sorted: Vec<f64>) -> f64 {
    let rows = sorted.len();
    let up = sorted.iter().step_by(2);
    let down = sorted.iter().skip(1).step_by(2).rev();
    let wave: Vec<f64> = up.chain(down).copied().collect();
    let total: f64 = wave.iter().map(|z| z * z).sum();
    let power = |harmonic: usize| {
        let (sine, cosine) = libm::sincos(TAU * harmonic as f64 / rows as f64);
        let (mut re, mut im, mut at) = (0.0, 0.0, (1.0, 0.0));
        for (k, z) in wave.iter().enumerate() {
            // Anew from time to time: rounding would grow with the rows.
            if k % 256 == 0 {
                let (sine, cosine) = libm::sincos(TAU * (harmonic * k % rows) as f64 / rows as f64);
                at = (cosine, sine);
            }
            re += z * at.0;
            im += z * at.1;
            at = (at.0 * cosine - at.1 * sine, at.0 * sine + at.1 * cosine);
        }
        re * re + im * im
    };
    let harmonics = HARMONICS.min((rows - 1) / 2);
    let share = 2.0 * (1..=harmonics).map(power).sum::<f64>() / (rows as f64 * total);
    let noise = 2.0 * harmonics as f64 / rows as f64;
    share - noise / (1.0 - noise) * (1.0 - share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_of_the_input_is_all_of_its_variance_and_noise_none() {
        let rows = 1000;
        // A cosine of one period in the order up and down.
        let sorted: Vec<f64> = (0..rows).map(|k| libm::cos(TAU * (k as f64) / (2.0 * rows as f64))).collect();
        assert!((first_order(sorted) - 1.0).abs() < 1e-4);
        let scattered: Vec<f64> = (0..rows).map(|k| ((k * 7919 % rows) as f64 - 499.5) / 500.0).collect();
        assert!(first_order(scattered).abs() < 0.05);
    }
}
