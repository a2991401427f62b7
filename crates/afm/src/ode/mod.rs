//! Initial value problems of a few unknowns: one explicit method, one for stiff problems, both with the location of
//! events.
//!
//! [`March`] takes adaptive steps; [`March::until`] stops where an event function rises through zero. Every cause of an
//! early stop has its own [`Failure`], and a budget limits the work.

mod dormand_prince;
mod linear;
mod march;
mod rodas;
#[cfg(test)]
mod tests;

pub use dormand_prince::DormandPrince;
pub use march::{Control, End, March, Outcome};
pub use rodas::Rodas;

use super::Failure;

/// M y' = f(t, y), with a diagonal mass matrix M.
pub trait Problem<const N: usize> {
    /// Returns f(t, y).
    fn rate(&self, t: f64, y: &[f64; N]) -> [f64; N];

    /// Returns the Jacobian df_i/dy_j, row by row. Used only by [`Rodas`].
    fn jacobian(&self, t: f64, y: &[f64; N]) -> [[f64; N]; N];

    /// Returns df/dt at fixed y; zero by default.
    fn time_rate(&self, _t: f64, _y: &[f64; N]) -> [f64; N] {
        [0.0; N]
    }

    /// Returns the diagonal of M. A zero makes its row an algebraic equation, f_i = 0; used only by [`Rodas`].
    fn mass(&self) -> [f64; N] {
        [1.0; N]
    }
}

/// A one-step method with an embedded error estimate.
pub trait Method {
    /// Order of the embedded error estimate in the step, local: p of err = O(h^p).
    const ERROR_ORDER: i32;

    /// Steps from `start` by `h`.
    fn step<const N: usize, P: Problem<N>>(problem: &P, start: &State<N>, h: f64) -> Attempt<N>;
}

/// Unknowns at a time, and f there if the method uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<const N: usize> {
    /// Time.
    pub t: f64,
    /// Unknowns.
    pub y: [f64; N],
    /// f(t, y).
    pub rate: [f64; N],
}

/// A step, accepted or not.
#[derive(Clone, Copy, Debug)]
pub struct Attempt<const N: usize> {
    /// Unknowns at the end.
    pub end: [f64; N],
    /// f at the end.
    pub rate: [f64; N],
    /// Estimated local error.
    pub error: [f64; N],
    /// Number of evaluations of f.
    pub evaluations: u64,
}

/// Checks the Jacobian of `problem` against central differences over `step`, to 1e-6 for their curvature.
#[cfg(test)]
pub(super) fn assert_jacobian<const N: usize>(problem: &impl Problem<N>, y: [f64; N], step: f64) {
    let jacobian = problem.jacobian(0.0, &y);
    for j in 0..N {
        let moved = |by: f64| problem.rate(0.0, &std::array::from_fn(|k| y[k] + if k == j { by } else { 0.0 }));
        let (above, below) = (moved(step), moved(-step));
        for (i, row) in jacobian.iter().enumerate() {
            let difference = (above[i] - below[i]) / (2.0 * step);
            assert!((row[j] - difference).abs() < 1e-6 * difference.abs().max(1.0), "{i} {j}");
        }
    }
}
