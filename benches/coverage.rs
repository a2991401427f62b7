//! How often does a 95 % interval hold, and how wide is it against the true error?
//!
//! For functions with exact indices, over many seeds: coverage of the intervals of the active factors, the root mean
//! square error of the estimates, and the mean half width, each averaged over the indices. An honest interval has
//! coverage near 0.95 and a half width near twice the error.

use apportion::analyse;
use apportion::model::KnownAnswer;
use apportion::study::Study;

const SEEDS: u64 = 200;

fn case(name: &str, text: &str, base_samples: u64, replicates: u64) {
    let function = KnownAnswer::from_name(name).expect("a function of the list").default_function();
    let exact = function.exact().indices.expect("no constant");
    let (first, total) = (exact.first_order, exact.total);
    let (mut held, mut count, mut squares, mut widths) = (0u64, 0u64, 0.0, 0.0);
    for seed in 0..SEEDS {
        let overrides = [("base_samples", base_samples), ("replicates", replicates), ("seed", seed)]
            .map(|(key, value)| format!("design.{key}={value}"));
        let study = Study::parse(text, "coverage.toml".as_ref(), &overrides).expect("a study of this repository");
        let result = analyse(&study, 0, &|_| ()).expect("threads");
        for (index, exact) in result.outputs[0].indices.iter().flatten().zip(first.iter().zip(&total)) {
            for (estimate, exact) in [(index.effect.first_order, exact.0), (index.effect.total, exact.1)] {
                let (Some(low), Some(high)) = (estimate.low, estimate.high) else { continue };
                held += u64::from(low <= *exact && *exact <= high);
                count += 1;
                squares += (estimate.estimate - exact).powi(2);
                widths += (high - low) / 2.0;
            }
        }
    }
    let n = count as f64;
    println!(
        "  {:9} {base_samples:6} {replicates:3}   coverage {:.3}   error {:.1e}   half width {:.1e}",
        name,
        held as f64 / n,
        (squares / n).sqrt(),
        widths / n
    );
}

fn main() {
    println!("function, base samples, replicates; {SEEDS} seeds:");
    for (name, text) in
        [("ishigami", include_str!("../studies/ishigami.toml")), ("sobol-g", include_str!("../studies/sobol-g.toml"))]
    {
        for base_samples in [1 << 10, 1 << 13, 1 << 16] {
            for replicates in [4, 8, 16] {
                case(name, text, base_samples, replicates);
            }
        }
    }
}
