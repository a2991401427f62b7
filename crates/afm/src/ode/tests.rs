//! Orders of convergence, stability, events, and early ends.

use std::f64::consts::{FRAC_PI_2, PI};

use super::*;

/// y' = rate of an oscillator of frequency `omega` about a target that moves: y'' = omega^2 (sin t - y).
struct Driven {
    omega: f64,
}

impl Problem<2> for Driven {
    fn rate(&self, t: f64, y: &[f64; 2]) -> [f64; 2] {
        [y[1], self.omega.powi(2) * (libm::sin(t) - y[0])]
    }

    fn jacobian(&self, _: f64, _: &[f64; 2]) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [-self.omega.powi(2), 0.0]]
    }

    fn time_rate(&self, t: f64, _: &[f64; 2]) -> [f64; 2] {
        [0.0, self.omega.powi(2) * libm::cos(t)]
    }
}

/// y1' = y2, y2' = -sin y1: nonlinear, autonomous.
struct Pendulum;

impl Problem<2> for Pendulum {
    fn rate(&self, _: f64, y: &[f64; 2]) -> [f64; 2] {
        [y[1], -libm::sin(y[0])]
    }

    fn jacobian(&self, _: f64, y: &[f64; 2]) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [-libm::cos(y[0]), 0.0]]
    }
}

/// y' = -y, 0 = y^2 - w: index 1.
struct Square;

impl Problem<2> for Square {
    fn rate(&self, _: f64, y: &[f64; 2]) -> [f64; 2] {
        [-y[0], y[0] * y[0] - y[1]]
    }

    fn jacobian(&self, _: f64, y: &[f64; 2]) -> [[f64; 2]; 2] {
        [[-1.0, 0.0], [2.0 * y[0], -1.0]]
    }

    fn mass(&self) -> [f64; 2] {
        [1.0, 0.0]
    }
}

/// y' = y^2, which leaves every bound at t = 1/y(0).
struct Explosion;

impl Problem<1> for Explosion {
    fn rate(&self, _: f64, y: &[f64; 1]) -> [f64; 1] {
        [y[0] * y[0]]
    }

    fn jacobian(&self, _: f64, y: &[f64; 1]) -> [[f64; 1]; 1] {
        [[2.0 * y[0]]]
    }
}

fn control<const N: usize>(tolerance: f64) -> Control<N> {
    Control { tolerance, scale: [1.0; N], first_step: 1e-3, longest_step: f64::INFINITY, step_budget: 100_000 }
}

/// The exact solution of the driven oscillator with omega = 2, from (0.5, -1): 4/3 sin t + 1/2 cos 2t - 7/6 sin 2t.
fn exact(t: f64) -> [f64; 2] {
    [
        4.0 / 3.0 * libm::sin(t) + 0.5 * libm::cos(2.0 * t) - 7.0 / 6.0 * libm::sin(2.0 * t),
        4.0 / 3.0 * libm::cos(t) - libm::sin(2.0 * t) - 7.0 / 3.0 * libm::cos(2.0 * t),
    ]
}

/// Error at t = 1 after `steps` equal steps.
fn error<M: Method>(steps: u32) -> f64 {
    let problem = Driven { omega: 2.0 };
    let h = 1.0 / f64::from(steps);
    let mut y = exact(0.0);
    for t in (0..steps).map(|i| f64::from(i) * h) {
        y = M::step(&problem, &State { t, y, rate: problem.rate(t, &y) }, h).end;
    }
    (y[0] - exact(1.0)[0]).abs()
}

/// log2 of the error ratio at halved steps is the order; 0.3 for the terms of higher order at these steps.
#[test]
fn methods_have_their_orders() {
    let orders = [error::<DormandPrince>(32) / error::<DormandPrince>(64), error::<Rodas>(32) / error::<Rodas>(64)];
    let [dormand_prince, rodas] = orders.map(libm::log2);
    assert!((dormand_prince - 5.0).abs() < 0.3 && (rodas - 4.0).abs() < 0.3, "{dormand_prince} {rodas}");
}

/// A quarter period of the pendulum released at rest at 1 rad: K(sin 1/2) by the arithmetic-geometric mean.
fn quarter<M: Method>(tolerance: f64) -> f64 {
    let mut march = March::<M, _, 2>::new(&Pendulum, (0.0, [-1.0, 0.0]), control(tolerance));
    match march.until(10.0, |_, y| Ok(y[0])).unwrap() {
        Outcome::Event(end) => end.t,
        Outcome::Horizon(_) => panic!("the pendulum never came down"),
    }
}

#[test]
fn events_are_as_accurate_as_the_solution() {
    let (mut a, mut b) = (1.0_f64, libm::cos(0.5));
    for _ in 0..6 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let exact = FRAC_PI_2 / a;
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        assert!((quarter::<DormandPrince>(tolerance) - exact).abs() < 20.0 * tolerance);
        assert!((quarter::<Rodas>(tolerance) - exact).abs() < 20.0 * tolerance);
    }
}

/// A stiff undamped oscillator, 1e8 rad/s, that starts on its slow motion: the stiff method steps over the oscillation.
#[test]
fn rodas_steps_over_a_fast_undamped_mode() {
    let problem = Driven { omega: 1e8 };
    let control = Control { scale: [1.0, 1e8], ..control(1e-8) };
    let mut march = March::<Rodas, _, 2>::new(&problem, (0.0, [0.0, 1.0]), control);
    let Ok(Outcome::Event(end)) = march.until(4.0, |_, y| Ok(y[0] - 0.5)) else { panic!("no event") };
    assert!((end.t - PI / 6.0).abs() < 1e-7, "{}", end.t);
    assert!(march.steps() < 200, "{}", march.steps());
}

#[test]
fn rodas_solves_differential_algebraic_problems() {
    let mut march = March::<Rodas, _, 2>::new(&Square, (0.0, [1.0, 1.0]), control(1e-8));
    let Ok(Outcome::Horizon(end)) = march.until(1.0, |_, _| Ok(-1.0)) else { panic!("no end") };
    assert!((end.y[0] - libm::exp(-1.0_f64)).abs() < 1e-7 && (end.y[1] - libm::exp(-2.0_f64)).abs() < 1e-7, "{end:?}");
}

/// Work of a fixed task, so that doubling it would show.
#[test]
fn work_is_counted() {
    let mut march = March::<DormandPrince, _, 2>::new(&Pendulum, (0.0, [1.0, 0.0]), control(1e-6));
    march.until(10.0, |_, _| Ok(-1.0)).unwrap();
    assert_eq!(march.evaluations(), 1 + 6 * march.steps());
    assert!((15..60).contains(&march.steps()), "{}", march.steps());
}

#[test]
fn every_way_to_stop_short_has_its_name() {
    fn run<M: Method>(control: Control<1>) -> Failure {
        March::<M, _, 1>::new(&Explosion, (0.0, [1.0]), control).until(2.0, |_, _| Ok(-1.0)).unwrap_err()
    }
    let short = Control { step_budget: 10, ..control(1e-8) };
    for failure in [run::<DormandPrince>(short), run::<Rodas>(short)] {
        assert_eq!(failure, Failure::StepBudget);
    }
    for failure in [run::<DormandPrince>(control(1e-8)), run::<Rodas>(control(1e-8))] {
        assert_eq!(failure, Failure::StepTooSmall);
    }
    let mut march = March::<Rodas, _, 2>::new(&Pendulum, (0.0, [1.0, 0.0]), control(1e-6));
    assert!(matches!(march.until(1.0, |_, _| Err(Failure::BeyondPullOff)), Err(Failure::BeyondPullOff)));
}

/// The horizon is met exactly, and does not shorten the steps after it.
#[test]
fn the_horizon_is_met_exactly() {
    let mut march = March::<DormandPrince, _, 2>::new(&Pendulum, (0.0, [1.0, 0.0]), control(1e-6));
    for i in 1..=100 {
        let horizon = 0.1 * f64::from(i);
        march.until(horizon, |_, _| Ok(-1.0)).unwrap();
        assert_eq!(march.state().t, horizon);
    }
    assert!(march.steps() < 130);
}
