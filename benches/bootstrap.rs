//! What do intervals from kept outputs cost? 8 factors, 2^12 and 2^16 random base points, 1000 resamples; all cores.
//!
//! Whole runs of Sobol' G, whose rows take a few milliseconds: estimates, resamples or influences, intervals and
//! probabilities. The two sizes show how the bootstrap grows with the number of points.

use apportion::study::Study;
use apportion::uncertainty::IntervalMethod;
use criterion::{Criterion, criterion_group, criterion_main};

/// The study of Sobol' G at `base_samples` random points with intervals by `method`.
fn study(base_samples: u64, method: IntervalMethod) -> Study {
    let text = format!(
        "model = \"sobol-g\"\n[design]\nsampler = \"random\"\nbase_samples = {base_samples}\n[analysis]\n\
         intervals = \"{}\"\nresamples = 1000\nsurrogate = \"off\"\n",
        method.name()
    );
    apportion_files::parse_study(&text, "bootstrap.toml".as_ref(), &[]).expect("a study")
}

fn bootstrap(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("intervals of 8 factors");
    group.sample_size(10);
    for exponent in [12, 16] {
        for method in [IntervalMethod::Delta, IntervalMethod::Percentile] {
            let study = study(1 << exponent, method);
            group.bench_function(format!("{}, 2^{exponent} points", method.name()), |bencher| {
                bencher.iter(|| study.run().expect("indices"));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, bootstrap);
criterion_main!(benches);
