//! What does a run of each rung cost, and which method suits the equations of motion?
//!
//! The second question on an oscillator that follows a slow target, y'' = omega^2 (sin t - y), to an event at y = 1/2: the
//! shape of the tip between its fast swing and its slow ramp. The explicit method pays for omega, the stiff one does not.

use std::hint::black_box;

use apportion::afm::ode::{Control, DormandPrince, March, Method, Outcome, Problem, Rodas};
use apportion::afm::{Fidelity, FrictionLaw, Options, Scene, critical_force};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

fn rungs(c: &mut Criterion) {
    let mut group = c.benchmark_group("critical_force");
    for friction in [FrictionLaw::Coulomb, FrictionLaw::HurtadoKim, FrictionLaw::LuGre] {
        for &fidelity in Fidelity::ALL {
            let options = Options { friction, fidelity, ..Options::default() };
            let scene = Scene::default();
            group.bench_function(BenchmarkId::new(friction.name(), fidelity.name()), |b| {
                b.iter(|| critical_force(black_box(&scene), &options));
            });
        }
    }
}

struct Driven {
    omega: f64,
}

impl Problem<2> for Driven {
    fn rate(&self, t: f64, y: &[f64; 2]) -> [f64; 2] {
        [y[1], self.omega.powi(2) * (t.sin() - y[0])]
    }

    fn jacobian(&self, _: f64, _: &[f64; 2]) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [-self.omega.powi(2), 0.0]]
    }

    fn time_rate(&self, t: f64, _: &[f64; 2]) -> [f64; 2] {
        [0.0, self.omega.powi(2) * t.cos()]
    }
}

/// Time of the event; pi/6 where the oscillator follows its target.
fn crossing<M: Method>(omega: f64) -> f64 {
    let problem = Driven { omega };
    let control = Control {
        tolerance: 1e-6,
        scale: [1.0, omega],
        first_step: 1e-3 / omega,
        longest_step: 0.1,
        step_budget: 10_000_000,
    };
    let mut march = March::<M, _, 2>::new(&problem, (0.0, [0.0, 1.0]), control);
    match march.until(1.0, |_, y| Ok(y[0] - 0.5)) {
        Ok(Outcome::Event(end) | Outcome::Horizon(end)) => end.t,
        Err(failure) => panic!("{failure}"),
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
