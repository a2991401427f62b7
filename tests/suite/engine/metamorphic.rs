//! Invariance: offset and scale of the output, order of the factors, number of threads.

use apportion::EffectEstimates;
use apportion::model::{Batch, KnownAnswer, KnownFunction, Model, Output, RunContext, Worker};
use apportion::result::Named;
use apportion::{AnalysisOptions, Distribution, Estimate, Sampler, Study, SurrogateChoice, Unit};
use proptest::prelude::*;

use crate::common::{analysed, apportion, gap, numbers, study_path};

/// Ishigami's function times `scale` plus `offset`, with its inputs in the order `order`.
struct Changed {
    function: KnownFunction,
    scale: f64,
    offset: f64,
    order: [usize; 3],
    outputs: [Output; 1],
}

impl Changed {
    fn new(scale: f64, offset: f64, order: [usize; 3]) -> Self {
        let function = KnownAnswer::from_name("ishigami").unwrap().default_function();
        let outputs = [Output::new("y", Unit::dimensionless(), "")];
        Self { function, scale, offset, order, outputs }
    }
}

impl Model for Changed {
    fn outputs(&self) -> &[Output] {
        &self.outputs
    }

    fn worker<'a>(&'a self, _: &'a RunContext<'a>) -> Box<dyn Worker + 'a> {
        Box::new(ChangedWorker(self))
    }
}

struct ChangedWorker<'a>(&'a Changed);

impl Worker for ChangedWorker<'_> {
    fn run(&mut self, inputs: &[&[f64]], batch: &mut Batch) {
        for (row, y) in batch.column_mut(0).iter_mut().enumerate() {
            let x = self.0.order.map(|column| inputs[column][row]);
            *y = self.0.function.value(&x) * self.0.scale + self.0.offset;
        }
    }
}

fn indices(model: Changed, base_samples: u64) -> Vec<Named<EffectEstimates>> {
    let pi = std::f64::consts::PI;
    let options = AnalysisOptions {
        surrogate: SurrogateChoice::Off,
        convergence: false,
        ..AnalysisOptions::for_sampler(Sampler::Sobol)
    };
    let mut study = Study::builder("changed", model).base_samples(base_samples).replicates(4).analysis(options);
    for name in ["x1", "x2", "x3"] {
        study = study.factor(name, Distribution::uniform(-pi, pi).unwrap());
    }
    study.build().unwrap().run().unwrap().outputs[0].indices.clone().unwrap()
}

fn flat(indices: &[Named<EffectEstimates>]) -> Vec<f64> {
    [numbers_of(indices, |e| vec![e.estimate]), bounds(indices)].concat()
}

fn bounds(indices: &[Named<EffectEstimates>]) -> Vec<f64> {
    numbers_of(indices, |e| vec![e.interval.unwrap().low, e.interval.unwrap().high])
}

fn numbers_of(indices: &[Named<EffectEstimates>], of: fn(Estimate) -> Vec<f64>) -> Vec<f64> {
    let all = indices.iter();
    all.flat_map(|of| [of.effect.first_order, of.effect.total]).flat_map(of).collect()
}

#[test]
fn an_offset_of_1e9_changes_no_index_by_1e_9() {
    let estimates = |indices: &[Named<EffectEstimates>]| numbers_of(indices, |e| vec![e.estimate]);
    let plain = indices(Changed::new(1.0, 0.0, [0, 1, 2]), 1 << 14);
    for offset in [1e6, 1e9, -1e9] {
        // Adding 1e9 rounds each output by up to 6e-8; over 2^14 points this leaves some 1e-10 in an index. Bounds rest on
        // differences between 64ths of the points, where eight times as much is left.
        let shifted = indices(Changed::new(1.0, offset, [0, 1, 2]), 1 << 14);
        let (estimates, bounds) =
            (gap(&estimates(&plain), &estimates(&shifted)), gap(&bounds(&plain), &bounds(&shifted)));
        assert!(estimates < 1e-9 && bounds < 8e-9, "offset {offset}: {estimates}, {bounds}");
    }
}

#[test]
fn a_scale_from_1e_minus_120_to_1e120_changes_nothing() {
    let plain = flat(&indices(Changed::new(1.0, 0.0, [0, 1, 2]), 1 << 10));
    for scale in [1e-120, 1e-30, -1.0, 1e30, 1e120] {
        // Only the rounding of the scaled outputs differs, some 1e-16 each; a sign cancels.
        let scaled = flat(&indices(Changed::new(scale, 0.0, [0, 1, 2]), 1 << 10));
        assert!(gap(&plain, &scaled) < 1e-12, "scale {scale}: {}", gap(&plain, &scaled));
    }
    // Powers of two scale without rounding: the same bits.
    assert_eq!(plain, flat(&indices(Changed::new(2f64.powi(-100), 0.0, [0, 1, 2]), 1 << 10)));
}

#[test]
fn the_order_of_the_factors_changes_their_coordinates_only() {
    // Other coordinates of the sequence are another design of the same quality: equal within the error of 2^14 points.
    let plain = indices(Changed::new(1.0, 0.0, [0, 1, 2]), 1 << 14);
    let swapped = indices(Changed::new(1.0, 0.0, [2, 0, 1]), 1 << 14);
    for (j, k) in [(0, 2), (1, 0), (2, 1)] {
        let (a, b) = (&plain[j].effect, &swapped[k].effect);
        assert!((a.first_order.estimate - b.first_order.estimate).abs() < 0.01);
        assert!((a.total.estimate - b.total.estimate).abs() < 0.01);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn offsets_and_scales_of_any_size_leave_the_indices(exponent in -60i32..60, offset in -1e3f64..1e3) {
        let scale = 2f64.powi(exponent);
        let plain = flat(&indices(Changed::new(1.0, 0.0, [0, 1, 2]), 256));
        let changed = flat(&indices(Changed::new(scale, offset * scale, [0, 1, 2]), 256));
        // An offset of up to 1e3 rounds outputs of size 10 to 1e-13, and little of it averages out over 256 points.
        prop_assert!(gap(&plain, &changed) < 1e-10);
    }
}

#[test]
fn files_of_repeated_runs_differ_only_in_time_and_threads() {
    let folder = tempfile::tempdir().unwrap();
    let run = |threads: &str| {
        let out = folder.path().join(threads);
        let study = study_path("hk-general");
        let arguments = [
            "run",
            study.to_str().unwrap(),
            "--base-samples",
            "4096",
            "--threads",
            threads,
            "--out",
            out.to_str().unwrap(),
        ];
        let output = apportion(&arguments);
        assert!(output.status.success(), "{}", crate::common::stderr(&output));
        let text = std::fs::read_to_string(out.join("hk-general.json")).unwrap();
        let telling = |line: &&str| !line.contains("\"threads\"") && !line.contains("\"wall_seconds\"");
        let lines: Vec<String> = text.lines().filter(telling).map(str::to_owned).collect();
        let chart = std::fs::read(out.join("charts/hk-general-indices.svg")).unwrap();
        (lines, chart)
    };
    let one = run("1");
    for threads in ["2", "7"] {
        assert!(run(threads) == one, "{threads} threads");
    }
}

#[test]
fn the_seed_changes_the_points_and_zero_is_a_seed() {
    let with = |seed: &str| {
        let overrides = [&format!("design.seed={seed}")[..], "design.base_samples=256"];
        numbers(&analysed("ishigami", &overrides).outputs[0])
    };
    assert_eq!(with("0"), with("0"));
    assert_ne!(with("0"), with("1"));
    assert_ne!(with("1"), with("9223372036854775807"));
}
