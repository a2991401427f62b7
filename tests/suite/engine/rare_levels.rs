//! Rare levels and thin tails: surrogates claim nothing that the rows do not contain, and effects of missing levels are unknown.

use apportion::model::{Model, Output, RunContext, Worker};
use apportion::{
    AnalysisOptions, Distribution, Sampler, Study, StudyBuilder, StudyResult, SurrogateChoice, Target, Warning,
    function_model,
};

use crate::common::effects;

/// A model that reports long run times, as a program does.
struct Program<M>(M);

impl<M: Model> Model for Program<M> {
    fn outputs(&self) -> &[Output] {
        self.0.outputs()
    }

    fn concurrency(&self) -> Option<usize> {
        Some(1)
    }

    fn worker<'a>(&'a self, context: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        self.0.worker(context)
    }
}

fn uniform() -> Distribution {
    Distribution::uniform(0.0, 1.0).unwrap()
}

fn boolean(probability: f64) -> Distribution {
    Distribution::boolean(probability).unwrap()
}

fn builder(factors: &[Distribution], function: fn(&[f64]) -> f64) -> StudyBuilder {
    let builder = Study::builder("rare", Program(function_model("y", function)));
    factors.iter().enumerate().fold(builder, |builder, (i, law)| builder.factor(&format!("x{i}"), law.clone()))
}

fn options(surrogate: SurrogateChoice) -> AnalysisOptions {
    AnalysisOptions { surrogate, ..AnalysisOptions::for_sampler(Sampler::Sobol) }
}

/// How many intervals of first-order and total indices hold `exact`, and how many there are.
fn held(analysis: &StudyResult, exact: &[[f64; 2]]) -> (usize, usize) {
    let effects = effects(&analysis.outputs[0]);
    let estimates = effects.iter().zip(exact).flat_map(|(f, e)| [(f.first_order, e[0]), (f.total, e[1])]);
    let holds = estimates.map(|(estimate, exact)| {
        usize::from(estimate.interval.is_some_and(|i| i.low - 1e-9 <= exact && exact <= i.high + 1e-9))
    });
    let list: Vec<usize> = holds.collect();
    (list.iter().sum(), list.len())
}

/// Each case with its exact indices, in closed form.
#[test]
fn intervals_hold_where_levels_are_rare() {
    // Var(ab) = 7/144, of which 1/48 each is of the first order; Var(d) = p (1 - p).
    let product = |switches: &[f64]| -> Vec<[f64; 2]> {
        let variance = 7.0 / 144.0 + switches.iter().sum::<f64>();
        let own = [1.0 / 48.0 / variance, 4.0 / 144.0 / variance];
        [own, own].into_iter().chain(switches.iter().map(|v| [v / variance; 2])).collect()
    };
    let var = |p: f64| p * (1.0 - p);
    let both = |x: &[f64]| x[0] * x[1] + x[2] + x[3];
    let two = |p: f64| [uniform(), uniform(), boolean(p), boolean(p)].to_vec();
    let idle = |p: f64| [uniform(), uniform(), boolean(p)].to_vec();
    type Case = (Vec<Distribution>, fn(&[f64]) -> f64, u64, Vec<[f64; 2]>);
    let cases: [Case; 4] = [
        (two(0.03), both, 128, product(&[var(0.03); 2])),
        (two(0.02), both, 512, product(&[var(0.02); 2])),
        (idle(0.001), |x| x[0] * x[1], 128, product(&[0.0])),
        (vec![boolean(0.05); 10], |x| x.iter().sum::<f64>(), 128, vec![[0.1; 2]; 10]),
    ];
    for (number, (factors, function, base_samples, exact)) in cases.into_iter().enumerate() {
        let (mut hits, mut all) = (0, 0);
        for seed in 0..4 {
            let study = builder(&factors, function).base_samples(base_samples).seed(seed);
            let result = study.analysis(options(SurrogateChoice::On)).build().unwrap().run().unwrap();
            let (held, count) = held(&result, &exact);
            (hits, all) = (hits + held, all + count);
        }
        assert!(10 * hits >= 9 * all, "case {number}: {hits} of {all}");
    }
}

#[test]
fn a_level_without_rows_does_not_count_as_without_effect() {
    let factors = [uniform(), uniform(), boolean(1e-4)];
    let function = |x: &[f64]| x[0] * x[1] + 100.0 * x[2];
    for target in [Target::accuracy(0.01), Target::default()] {
        let study = builder(&factors, function).until(target).analysis(options(SurrogateChoice::Auto));
        let result = study.build().unwrap().run().unwrap();
        let output = &result.outputs[0];
        let rare = effects(output)[2];
        let interval = rare.total.interval.unwrap();
        // 1e-4 (1 - 1e-4) 1e4 of itself and 7/144.
        assert!(interval.low <= 0.954 && 0.954 <= interval.high, "{interval:?}");
        assert_eq!((rare.probability_above_threshold, rare.probability_first), (None, None));
        let is_rare = |warning: &Warning| matches!(warning, Warning::RareLevel(rare) if rare.factor == "x2");
        assert!(output.warnings.iter().any(is_rare), "{:?}", output.warnings);
        assert!(result.stopping.is_none_or(|stopped| stopped.target_met == Some(false)));
    }
}

#[test]
fn a_run_with_accuracy_continues_until_rare_levels_occur() {
    let factors = [uniform(), uniform(), boolean(0.03), boolean(0.03)];
    let variance = 7.0 / 144.0 + 2.0 * 0.03 * 0.97;
    let exact = [1.0 / 48.0 / variance, 0.03 * 0.97 / variance];
    for seed in 0..2 {
        let study = builder(&factors, |x| x[0] * x[1] + x[2] + x[3]).until(Target::accuracy(0.01)).seed(seed);
        let result = study.build().unwrap().run().unwrap();
        assert_eq!(result.stopping.as_ref().unwrap().target_met, Some(true));
        let factors = effects(&result.outputs[0]);
        for (effect, exact) in [(0, exact[0]), (2, exact[1]), (3, exact[1])] {
            let error = (factors[effect].first_order.estimate - exact).abs();
            assert!(error <= 0.01, "{seed}, x{effect}: {error}");
        }
    }
}

/// The rows of a net at equal distances near a power of two hardly have a rare level: half of such runs lost their surrogates.
#[test]
fn more_rows_know_rare_levels_at_least_as_well() {
    let exact = 0.03 * 0.97 / (7.0 / 144.0 + 2.0 * 0.03 * 0.97);
    for seed in 5..9 {
        let builder = builder(&[uniform(), uniform(), boolean(0.03), boolean(0.03)], |x| x[0] * x[1] + x[2] + x[3]);
        let options = AnalysisOptions { convergence: false, ..options(SurrogateChoice::Auto) };
        let study = builder.seed(seed).base_samples(4096).analysis(options).build().unwrap();
        let analysis = study.runner().run().unwrap();
        let total = effects(&analysis.outputs[0])[2].total;
        assert!((total.estimate - exact).abs() < 1e-9, "{seed}: {total:?}");
    }
}

/// Rejected surrogates do not extend the intervals of the plain indices.
#[test]
fn surrogates_that_are_refused_are_warned_of_once() {
    let text = "model = \"expression\"\noutputs.y = \"a*b + 100*d\"\n[factors]\na = { min = 0, max = 1 }\n\
                b = { min = 0, max = 1 }\nd = { distribution = \"boolean\", probability = 1e-4 }\n";
    let mut is_warned = false;
    for seed in 0..8 {
        let changes = [format!("design.seed={seed}"), "design.base_samples=4096".to_owned()];
        let study = apportion_files::parse_study(text, "rare.toml".as_ref(), &changes).unwrap();
        let warnings = &study.run().unwrap().outputs[0].warnings;
        let is_refusal = |warning: &Warning| {
            matches!(warning, Warning::ContradictedSurrogate { .. } | Warning::InflatedSurrogate { .. })
        };
        let is_heavy = warnings.contains(&Warning::HeavyTailedSurrogate);
        assert!(!is_heavy || !warnings.iter().any(is_refusal), "{seed}: {warnings:?}");
        is_warned |= is_heavy;
    }
    assert!(is_warned);
}
