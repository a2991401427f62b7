//! What do the points and the estimators cost, without the model?
//!
//! Analysis: all estimators of first-order, total and second-order indices from stored outputs of 8 factors at 2^16
//! base points, on one thread, in the blocks of a run. Points: coordinates a second of each sampler, in the blocks of
//! a run too. Surrogates: one cross-fit.

mod outputs;

use std::hint::black_box;

use apportion::design::{Design, DesignSettings, LatinHypercube, RandomPoints, Rows, Sampler, SobolSequence};
use apportion::estimate::{FirstOrder, Moments, SecondOrder, Total, Workspace};
use apportion::run::BLOCK;
use apportion::surrogate::{Caps, Family, Net, cross_fitted};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use outputs::{Outputs, design, function};

const POINTS: u64 = 1 << 16;

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
    let pairs = || swaps.iter().flat_map(|j| swaps.iter().filter(move |k| *k > j).map(move |k| (*j, *k)));
    let second: f64 = SecondOrder::ALL.iter().flat_map(|e| pairs().map(|(j, k)| e.estimate(moments, j, k))).sum();
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

/// A sparse expansion for each of four nets, from the polynomials to the coefficients refitted to the others, on one
/// thread.
fn surrogate(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("surrogate-fits-8-factors-400-terms");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    let function = function("sobol-g");
    let families = vec![Family::Legendre; 8];
    let caps = Caps { terms: 400, ..Caps::new(&families, 0) };
    for base_samples in [100, 1000] {
        let settings =
            |seed| DesignSettings { base_samples: base_samples / 4, replicates: 1, seed, ..Default::default() };
        let rows = Rows::plain((0..8).map(|j| vec![j]).collect());
        let designs: Vec<Design> =
            (0..4).map(|seed| Design::new(settings(seed), 8, rows.clone()).expect("a design")).collect();
        let outputs: Vec<Vec<Vec<f64>>> = designs.iter().map(|design| Outputs::of(&function, design).runs).collect();
        let rows = 10 * base_samples;
        group.throughput(Throughput::Elements(rows));
        group.bench_function(BenchmarkId::new("rows", rows), |bencher| {
            bencher.iter(|| {
                pool.install(|| {
                    let net = |(design, outputs): (&Design, &Vec<Vec<f64>>)| {
                        Net::new(design, 0, 0..outputs[0].len(), &families, caps.degree, outputs)
                    };
                    let nets: Vec<Net> = designs.iter().zip(black_box(&outputs)).map(net).collect();
                    cross_fitted(&nets, caps)
                })
            });
        });
    }
    group.finish();
}

fn points(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("points");
    for dimensions in [16, 64] {
        let mut columns = vec![vec![0.0; BLOCK as usize]; dimensions];
        group.throughput(Throughput::Elements(BLOCK * dimensions as u64));
        let sobol = SobolSequence::scrambled(dimensions, 0, 0);
        let random = RandomPoints::new(dimensions, 0, 0);
        let latin = LatinHypercube::new(dimensions, POINTS, 0, 0);
        let mut fill = |name: &str, fill: &dyn Fn(u64, &mut [Vec<f64>])| {
            let mut block = 0;
            group.bench_function(BenchmarkId::new(name, dimensions), |bencher| {
                bencher.iter(|| {
                    block = (block + 1) % (POINTS / BLOCK);
                    fill(block * BLOCK, &mut columns);
                    black_box(columns[0][0])
                });
            });
        };
        fill("sobol", &|first, columns| {
            columns.iter_mut().enumerate().for_each(|(dimension, column)| sobol.fill(dimension, first, column));
        });
        fill("random", &|first, columns| random.fill(first, columns));
        fill("latin-hypercube", &|first, columns| latin.fill(first, columns));
    }
    group.finish();
}

criterion_group!(benches, analysis, surrogate, points);
criterion_main!(benches);
