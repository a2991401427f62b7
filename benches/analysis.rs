//! What do the points and the estimators cost, without the model?
//!
//! Analysis: all estimators of first-order, total and second-order indices from stored outputs of 8 factors at 2^16
//! base points, on one thread, in the blocks of a run. Points: coordinates a second of each sampler, in the blocks of
//! a run too. Surrogates: runs that fit them.

mod outputs;

use std::hint::black_box;

use apportion::design::{Design, DesignSettings, Rows, Sampler};
use apportion::estimate::{FirstOrder, Moments, Total, Workspace, second_order};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use outputs::{Outputs, design, function};

const POINTS: u64 = 1 << 16;
/// Base points of a block, as in a run.
const BLOCK: u64 = 256;

/// Moments of blocks, merged in the tree of a run.
fn merged(outputs: &Outputs<'_>, first: u64, blocks: u64, work: &mut Workspace) -> Moments {
    if blocks == 1 {
        return outputs.moments(first as usize..(first + BLOCK) as usize, work);
    }
    let mut left = merged(outputs, first, blocks / 2, work);
    left.merge(&merged(outputs, first + blocks / 2 * BLOCK, blocks / 2, work));
    left
}

/// The sum of all indices by all estimators, which makes sure that each is computed.
fn every_index(moments: &Moments) -> f64 {
    let swaps = || 0..moments.swaps();
    let first: f64 = FirstOrder::ALL.iter().flat_map(|e| swaps().map(|j| e.estimate(moments, j))).sum();
    let total: f64 = Total::ALL.iter().flat_map(|e| swaps().map(|j| e.estimate(moments, j))).sum();
    let swaps = moments.pairs().map_or(&[][..], |pairs| pairs.swaps());
    let pairs = swaps.iter().flat_map(|j| swaps.iter().filter(move |k| *k > j).map(move |k| (*j, *k)));
    let second: f64 = pairs.map(|(j, k)| second_order(moments, j, k)).sum();
    first + total + second
}

fn analysis(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("analysis-8-factors-65536");
    let function = function("sobol-g");
    let settings = DesignSettings { sampler: Sampler::Sobol, base_samples: POINTS, replicates: 1, seed: 0 };
    for (name, second_order) in [("first-and-total", false), ("with-second-order", true)] {
        let design = design(settings.clone(), 8, second_order);
        let outputs = Outputs::of(&function, &design);
        group.throughput(Throughput::Elements(design.rows()));
        let mut work = Workspace::default();
        group.bench_function(name, |bencher| {
            bencher.iter(|| every_index(&merged(black_box(&outputs), 0, POINTS / BLOCK, &mut work)));
        });
    }
    group.finish();
}

/// A study with surrogates on one thread: above all, a sparse expansion for each of four nets, from the polynomials to the
/// coefficients refitted to the others.
fn surrogate(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("surrogates-8-factors");
    for base_samples in [100, 1000] {
        let text = format!("model = \"sobol-g\"\n[design]\nbase_samples = {base_samples}\n");
        let study = apportion_files::parse_study(&text, "surrogate.toml".as_ref(), &[]).expect("a study");
        group.throughput(Throughput::Elements(study.design().rows()));
        group.bench_function(BenchmarkId::new("rows", study.design().rows()), |bencher| {
            bencher.iter(|| study.runner().threads(1).run().expect("a result"));
        });
    }
    group.finish();
}

fn points(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("points");
    for dimensions in [16, 64] {
        let mut columns = vec![vec![0.0; BLOCK as usize]; dimensions];
        group.throughput(Throughput::Elements(BLOCK * dimensions as u64));
        for sampler in Sampler::ALL {
            let settings = DesignSettings { sampler, base_samples: POINTS, replicates: 1, seed: 0 };
            let design = Design::new(settings, dimensions / 2, Rows::default()).expect("a design");
            let points = design.replicate(0);
            let mut block = 0;
            group.bench_function(BenchmarkId::new(sampler.name(), dimensions), |bencher| {
                bencher.iter(|| {
                    block = (block + 1) % (POINTS / BLOCK);
                    points.fill(block * BLOCK, &mut columns);
                    black_box(columns[0][0])
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, analysis, surrogate, points);
criterion_main!(benches);
