//! What does a run of each rung cost, and which method suits the equations of motion?
//!
//! The second question on the oscillator of `driven`: the explicit method pays for its frequency, the stiff one does not.
//! `neighbours` sets both beside the methods of diffsol.

mod driven;

use std::hint::black_box;

use apportion_afm::ode::{DormandPrince, Rodas};
use apportion_afm::{Fidelity, FrictionLaw, Options, Scene, critical_force};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use driven::crossing;

fn rungs(c: &mut Criterion) {
    let mut group = c.benchmark_group("critical_force");
    for friction in [FrictionLaw::Coulomb, FrictionLaw::HurtadoKim, FrictionLaw::LuGre] {
        for fidelity in Fidelity::ALL {
            let options = Options { friction, fidelity, ..Options::default() };
            let scene = Scene::default();
            group.bench_function(BenchmarkId::new(friction.name(), fidelity.name()), |b| {
                b.iter(|| critical_force(black_box(&scene), &options));
            });
        }
    }
}

fn methods(c: &mut Criterion) {
    let mut group = c.benchmark_group("crossing");
    for omega in [1e1, 1e3, 1e5] {
        group.bench_function(BenchmarkId::new("rodas", omega), |b| b.iter(|| crossing::<Rodas>(black_box(omega))));
        group.bench_function(BenchmarkId::new("dormand-prince", omega), |b| {
            b.iter(|| crossing::<DormandPrince>(black_box(omega)));
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(std::time::Duration::from_millis(500))
        .warm_up_time(std::time::Duration::from_millis(200));
    targets = rungs, methods
}
criterion_main!(benches);
