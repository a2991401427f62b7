//! Every estimator on every function with a closed form, at two sizes, on every sampler.

use apportion::design::{DesignSettings, Sampler};
use apportion::estimate::{FirstOrder, Total, Workspace};
use apportion::model::{Basis, KnownAnswer, KnownFunction};

use crate::engine::accuracy::outputs::{Outputs, design};

const SEEDS: u64 = 16;

/// Estimates of every estimator and factor, one list per seed, and what they should be.
fn estimates(function: &KnownFunction, sampler: Sampler, base_samples: u64) -> Vec<Vec<f64>> {
    let factors = function.inputs().len();
    let of_seed = |seed| {
        let design = design(DesignSettings { sampler, base_samples, replicates: 1, seed }, factors, false);
        let moments = Outputs::of(function, &design).moments(0..base_samples as usize, &mut Workspace::default());
        let of = |estimate: &dyn Fn(usize) -> f64| (0..factors).map(estimate).collect::<Vec<_>>();
        let first = FirstOrder::ALL.into_iter().map(|estimator| of(&|j| estimator.estimate(&moments, j)));
        let total = Total::ALL.into_iter().map(|estimator| of(&|j| estimator.estimate(&moments, j)));
        first.chain(total).flatten().collect()
    };
    (0..SEEDS).map(of_seed).collect()
}

#[test]
fn every_estimator_is_within_its_error_of_every_closed_form_on_every_sampler() {
    let (mut count, mut beyond_4) = (0, 0);
    for answer in KnownAnswer::all() {
        let exact = answer.default_function().exact();
        let (Basis::ClosedForm, Some(indices)) = (&exact.basis, &exact.indices) else { continue };
        let expected: Vec<f64> =
            [vec![indices.first_order.clone(); FirstOrder::ALL.len()], vec![indices.total.clone(); Total::ALL.len()]]
                .concat()
                .concat();
        let uneven = exact.mean.powi(2) / exact.variance + 1.0;
        let function = answer.default_function();
        for sampler in Sampler::ALL {
            for base_samples in [256, 1024] {
                let all = estimates(&function, sampler, base_samples);
                for (place, exact) in expected.iter().enumerate() {
                    let n = SEEDS as f64;
                    // As published, Saltelli 2002 divides one of its sums by N - 1 and the other by N.
                    let estimator = FirstOrder::ALL.get(place / function.inputs().len());
                    let published = if estimator == Some(&FirstOrder::Saltelli2002) { uneven } else { 0.0 };
                    let room = published / (base_samples - 1) as f64 + 1e-9;
                    let mean = all.iter().map(|list| list[place]).sum::<f64>() / n;
                    let sd = (all.iter().map(|list| (list[place] - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
                    // The mean of 16 has a quarter of the standard error of one: twice that of one is eight of its own, so
                    // that only a bias is beyond it. 1e-9 is rounding, where an inert factor has no error.
                    assert!(
                        (mean - exact).abs() < 2.0 * sd + room,
                        "{answer:?}, {sampler:?}, {base_samples}, {place}: {mean} +- {sd}, not {exact}"
                    );
                    count += SEEDS;
                    beyond_4 += all.iter().filter(|l| (l[place] - exact).abs() > 4.0 * sd + room).count() as u64;
                }
            }
        }
    }
    assert!(count > 100_000 && beyond_4 * 1000 < count, "{beyond_4} of {count} beyond four standard errors");
}
