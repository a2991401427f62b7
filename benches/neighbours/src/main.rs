//! Which method suits the equations of motion: our stiff and explicit methods, or those of diffsol?
//!
//! On the oscillator of `../driven`, whose solution is known. Printed per method: time of one integration
//! (best of several), and the error of the event's time.

#[path = "../../driven/mod.rs"]
mod driven;

use std::time::Instant;

use apportion_afm::ode::{DormandPrince, Rodas};
use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason};
use driven::{STEPS, TOLERANCE, crossing};

/// Time of the event, by bisection of the solution y = a sin t + b sin(omega t), a = omega^2/(omega^2 - 1), of the start
/// at rest on the target with its speed 1.
fn exact(omega: f64) -> f64 {
    let a = omega * omega / (omega * omega - 1.0);
    let b = (1.0 - a) / omega;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let t: f64 = (low + high) / 2.0;
        if a * t.sin() + b * (omega * t).sin() < 0.5 { low = t } else { high = t }
    }
    low
}

/// Time and error of the best of several integrations, or why there is none.
fn report((name, omega): (&str, f64), integrate: impl Fn() -> Option<f64>) {
    let mut best = f64::INFINITY;
    let mut event = None;
    for _ in 0..20 {
        let start = Instant::now();
        event = integrate();
        best = best.min(start.elapsed().as_secs_f64());
        if best > 0.2 {
            break;
        }
    }
    match event {
        Some(t) => println!("  {name:16} {:10.1} us   error {:.1e}", best * 1e6, (t - exact(omega)).abs()),
        None => println!("  {name:16} no event found"),
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for omega in [1e1f64, 1e3, 1e5] {
        println!("omega = {omega:.0e} rad/s, tolerance {TOLERANCE:.0e}");
        report(("our Rodas", omega), || crossing::<Rodas>(omega));
        report(("our Dormand-Prince", omega), || crossing::<DormandPrince>(omega));
        let squared = omega * omega;
        let problem = OdeBuilder::<NalgebraMat<f64>>::new()
            .rtol(TOLERANCE)
            .atol([TOLERANCE, TOLERANCE * omega])
            .h0(1e-3 / omega)
            .rhs_implicit(
                move |x: &[f64], _p: &[f64], t: f64, y: &mut [f64]| {
                    y[0] = x[1];
                    y[1] = squared * (t.sin() - x[0]);
                },
                move |_x: &[f64], _p: &[f64], _t: f64, v: &[f64], y: &mut [f64]| {
                    y[0] = v[1];
                    y[1] = -squared * v[0];
                },
            )
            .init(
                |_p: &[f64], _t: f64, y: &mut [f64]| {
                    y[0] = 0.0;
                    y[1] = 1.0;
                },
                2,
            )
            .root(|x: &[f64], _p: &[f64], _t: f64, y: &mut [f64]| y[0] = x[0] - 0.5, 1)
            .build()?;
        macro_rules! diffsol {
            ($name:literal, $solver:expr) => {
                report(($name, omega), || {
                    let mut solver = $solver.ok()?;
                    solver.set_stop_time(1.0).ok()?;
                    (0..STEPS).find_map(|_| match solver.step() {
                        Ok(OdeSolverStopReason::RootFound(t, _)) => Some(Some(t)),
                        Ok(OdeSolverStopReason::TstopReached) | Err(_) => Some(None),
                        Ok(_) => None,
                    })?
                });
            };
        }
        diffsol!("diffsol bdf", problem.bdf::<NalgebraLU<f64>>());
        diffsol!("diffsol tr-bdf2", problem.tr_bdf2::<NalgebraLU<f64>>());
        diffsol!("diffsol esdirk34", problem.esdirk34::<NalgebraLU<f64>>());
        diffsol!("diffsol tsit45", problem.tsit45());
    }
    Ok(())
}
