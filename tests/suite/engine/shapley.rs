//! Shapley effects of independent factors; those of dependent factors are in `dependent.rs`, of groups in `indices_of_groups.rs`.

use ::apportion::uncertainty::IntervalMethod;
use ::apportion::{AnalysisOptions, BuildError, Distribution, Sampler, Study, function_model};

fn study(
    factors: usize,
    value: fn(&[f64]) -> f64,
    base_samples: u64,
    options: AnalysisOptions,
) -> Result<Study, BuildError> {
    let pi = std::f64::consts::PI;
    let builder = Study::builder("function", function_model("y", value));
    let factor = |k: usize| (format!("x{k}"), Distribution::uniform(-pi, pi).unwrap());
    let builder = (1..=factors).map(factor).fold(builder, |builder, (name, of)| builder.factor(&name, of));
    let sampler = if options.intervals == IntervalMethod::Nets { Sampler::Sobol } else { Sampler::Random };
    builder.sampler(sampler).base_samples(base_samples).analysis(options).build()
}

/// The Shapley effects of Ishigami's function are S1 + S13/2, S2 and S13/2 (Owen 2014). A base point without one of its runs is left
/// out of the effects.
#[test]
fn ishigami_has_its_effects_by_every_interval() {
    let ishigami = |x: &[f64]| x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin() + 1e7;
    let (s1, s2, s13) = (0.313_905, 0.442_411, 0.243_684);
    for intervals in [IntervalMethod::Nets, IntervalMethod::Batches, IntervalMethod::Delta, IntervalMethod::Percentile]
    {
        let sampler = if intervals == IntervalMethod::Nets { Sampler::Sobol } else { Sampler::Random };
        let plain = AnalysisOptions::for_sampler(sampler);
        let study =
            study(3, ishigami, 1 << 14, AnalysisOptions { shapley: Some(true), intervals, resamples: 200, ..plain });
        let study = study.unwrap();
        assert_eq!(study.design().rows_per_point(), 8);
        let analysis = study.run().unwrap();
        let effects = crate::common::effects(analysis.output("y").unwrap());
        for (found, exact) in effects.iter().map(|effect| effect.shapley.unwrap()).zip([s1 + s13 / 2.0, s2, s13 / 2.0])
        {
            assert!((found.estimate - exact).abs() < 0.02, "{intervals:?}: {found:?}, {exact}");
            let interval = found.interval.unwrap();
            assert!(interval.low - 0.01 < exact && exact < interval.high + 0.01, "{intervals:?}: {found:?}, {exact}");
        }
    }
}

#[test]
fn more_factors_than_subsets_can_serve_are_refused() {
    let sum: fn(&[f64]) -> f64 = |x| x.iter().sum();
    let plain = || AnalysisOptions::for_sampler(Sampler::Sobol);
    let asked = || AnalysisOptions { shapley: Some(true), ..plain() };
    assert!(matches!(study(9, sum, 64, asked()), Err(BuildError::Wrong { key: "shapley", .. })));
    assert!(study(8, sum, 64, asked()).is_ok() && study(101, sum, 64, plain()).is_ok());
}
