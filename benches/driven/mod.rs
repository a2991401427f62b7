//! The problem on which the solvers are compared: an oscillator that follows a slow target, y'' = omega^2 (sin t - y), up
//! to the event y = 1/2. It has the shape of the tip between its fast swing and its slow ramp.

use apportion_afm::ode::{Control, March, Method, Outcome, Problem};

/// Relative tolerance asked of every solver.
pub const TOLERANCE: f64 = 1e-6;

/// More steps than this are no answer.
pub const STEPS: u64 = 10_000_000;

/// The oscillator, of frequency `omega` (rad/s).
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

/// Time of the event by one of our methods; none if it was not found.
pub fn crossing<M: Method>(omega: f64) -> Option<f64> {
    let problem = Driven { omega };
    let control = Control {
        tolerance: TOLERANCE,
        scale: [1.0, omega],
        first_step: 1e-3 / omega,
        longest_step: 0.1,
        step_budget: STEPS,
    };
    let mut march = March::<M, _, 2>::new(&problem, (0.0, [0.0, 1.0]), control);
    match march.until(1.0, |_, y| Ok(y[0] - 0.5)) {
        Ok(Outcome::Event(end)) => Some(end.t),
        Ok(Outcome::Horizon(_)) | Err(_) => None,
    }
}
