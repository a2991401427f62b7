//! What do intervals from kept outputs cost? 8 factors, 2^16 random base points, 1000 resamples; all cores.
//!
//! Everything that an output's indices take once its runs are over: estimates, resamples or influences, intervals and
//! probabilities. A second group shows how the bootstrap grows with the number of points.

use apportion::analysis::{IntervalOptions, output_indices};
use apportion::design::Design;
use apportion::effect::Layout;
use apportion::estimate::{MomentParts, PointOutputs};
use apportion::model::RunContext;
use apportion::run::{GrowingRun, Job, Totals};
use apportion::uncertainty::{IntervalMethod, KeptPoints};
use criterion::{Criterion, criterion_group, criterion_main};

/// The random design of `base_samples`, and its run through Sobol' G with the outputs kept.
fn finished(base_samples: u64) -> (Design, Vec<Totals>) {
    let text = format!("model = \"sobol-g\"\n[design]\nsampler = \"random\"\nbase_samples = {base_samples}");
    let study = apportion_files::parse_study(&text, "bootstrap.toml".as_ref(), &[]).expect("a study");
    let model = study.model();
    let job = Job { design: study.design(), space: study.space(), model: model.as_ref() };
    let context = RunContext::default();
    let mut run = GrowingRun::new(job, &context, 0).expect("threads");
    run.keeps_outputs = true;
    run.grow_to(base_samples, &|_| ()).expect("no failures");
    let totals = run.totals().to_vec();
    (study.design().clone(), totals)
}

fn bootstrap(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("intervals of 8 factors");
    group.sample_size(10);
    for exponent in [12, 16] {
        let (design, totals) = finished(1 << exponent);
        let kept: Vec<&PointOutputs> = totals.iter().map(|totals| &totals.outputs[0].point_outputs).collect();
        let parts: Vec<MomentParts> = totals.iter().map(|totals| totals.outputs[0].moments.clone()).collect();
        let points = KeptPoints::all(&design, &kept);
        for method in [IntervalMethod::Delta, IntervalMethod::Percentile] {
            let options = IntervalOptions {
                method,
                threshold: 0.05,
                seed: 1,
                resamples: 1000,
                points,
                ranks: true,
                correlations: &[],
                surrogate: None,
            };
            group.bench_function(format!("{}, 2^{exponent} points", method.name()), |bencher| {
                bencher.iter(|| output_indices(&parts, &Layout::plain(design.factors()), &options).expect("indices"));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, bootstrap);
criterion_main!(benches);
