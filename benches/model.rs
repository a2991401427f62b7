//! How many critical forces per second, under each friction law, on one thread, over the papers' box? And how much
//! slower is a function as a formula in the study file?

use std::hint::black_box;

use apportion::design::{Design, DesignSettings, Rows};
use apportion::model::{Batch, RunContext};
use apportion::study::Study;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

const ROWS: usize = 4096;

/// SI columns of the general study's box.
fn columns(study: &Study) -> Vec<Vec<f64>> {
    let settings = DesignSettings { base_samples: ROWS as u64, replicates: 1, ..DesignSettings::default() };
    let design = Design::new(settings, study.design().factors(), Rows::default()).expect("a plain design");
    let mut unit = vec![vec![0.0; ROWS]; study.design().factors() * 2];
    design.replicate(0).fill(0, &mut unit);
    let mut values = vec![vec![0.0; ROWS]; study.design().factors()];
    for ((factor, u), si) in study.space().factors().iter().zip(&unit).zip(&mut values) {
        factor.fill_si(u, si);
    }
    values
}

/// A group of studies, each by the runs of its model.
fn group(criterion: &mut Criterion, title: &str, studies: &[(&str, &str)]) {
    let mut group = criterion.benchmark_group(title);
    group.throughput(Throughput::Elements(ROWS as u64));
    for &(name, text) in studies {
        let study = apportion_files::parse_study(text, name.as_ref(), &[]).expect("a study of this repository");
        let (model, columns) = (study.model(), columns(&study));
        let inputs: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let context = RunContext::default();
        let mut worker = model.worker(&context);
        let mut batch = Batch::new(model.as_ref());
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                batch.reset(ROWS);
                worker.run(black_box(&inputs), &mut batch);
                black_box(batch.column(0)[0])
            });
        });
    }
    group.finish();
}

fn closed_form(criterion: &mut Criterion) {
    let studies = [
        ("coulomb", include_str!("../studies/coulomb-general.toml")),
        ("hk", include_str!("../studies/hk-general.toml")),
        ("lugre", include_str!("../studies/lugre-general.toml")),
    ];
    group(criterion, "closed-form", &studies);
}

fn ishigami(criterion: &mut Criterion) {
    let built_in = include_str!("../studies/ishigami.toml");
    let formula = "model = \"expression\"\noutputs.y = \"sin(x1) + a*sin(x2)^2 + b*x3^4*sin(x1)\"\n\
                   expression.constants = { a = 7, b = 0.1 }\n";
    let formula = built_in.replace("model = \"ishigami\"\n", formula);
    group(criterion, "ishigami", &[("built-in", built_in), ("formula", &formula)]);
}

criterion_group!(benches, closed_form, ishigami);
criterion_main!(benches);
