//! Adaptive steps and events.

use std::marker::PhantomData;

use super::{Failure, Method, Problem, State};
use crate::root::{self, Point};

/// Accuracy and limits of an integration.
#[derive(Clone, Copy, Debug)]
pub struct Control<const N: usize> {
    /// Relative tolerance of the local error, > 0.
    pub tolerance: f64,
    /// Size from which on an unknown counts by its own size; below it, its error is weighted by this. > 0.
    pub scale: [f64; N],
    /// Length of the first step tried, > 0.
    pub first_step: f64,
    /// Maximum step, > 0.
    pub longest_step: f64,
    /// Maximum number of steps tried, accepted or not.
    pub step_budget: u64,
}

/// The state at the end of an integration.
#[derive(Clone, Copy, Debug)]
pub struct End<const N: usize> {
    /// Time.
    pub t: f64,
    /// Unknowns.
    pub y: [f64; N],
}

/// How an integration ended.
#[derive(Clone, Copy, Debug)]
pub enum Outcome<const N: usize> {
    /// The event function rose through zero here.
    Event(End<N>),
    /// The end of the interval came first.
    Horizon(End<N>),
}

/// Adaptive integration, step by step.
pub struct March<'a, M, P, const N: usize> {
    problem: &'a P,
    control: Control<N>,
    state: State<N>,
    h: f64,
    steps: u64,
    evaluations: u64,
    method: PhantomData<M>,
}

impl<'a, M: Method, P: Problem<N>, const N: usize> March<'a, M, P, N> {
    /// Creates an integration of `problem` from the unknowns `y` at the time `t`.
    pub fn new(problem: &'a P, (t, y): (f64, [f64; N]), control: Control<N>) -> Self {
        let state = State { t, y, rate: problem.rate(t, &y) };
        Self { problem, control, state, h: control.first_step, steps: 0, evaluations: 1, method: PhantomData }
    }

    /// Returns the current state.
    pub fn state(&self) -> &State<N> {
        &self.state
    }

    /// Returns the number of evaluations of f so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Returns the number of steps tried so far, accepted or not.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Takes one accepted step, at most to `horizon`.
    ///
    /// # Errors
    /// [`Failure::StepBudget`] once the budget is spent, [`Failure::StepTooSmall`] if no step that moves the time is
    /// accurate enough.
    pub fn advance(&mut self, horizon: f64) -> Result<(), Failure> {
        loop {
            let left = horizon - self.state.t;
            let last = self.h >= left * (1.0 - 1e-12);
            let h = if last { left } else { self.h.min(self.control.longest_step) };
            let moves = self.state.t + h > self.state.t;
            if !moves {
                return Err(Failure::StepTooSmall);
            }
            if self.steps >= self.control.step_budget {
                return Err(Failure::StepBudget);
            }
            self.steps += 1;
            let attempt = M::step(self.problem, &self.state, h);
            self.evaluations += attempt.evaluations;
            let end = attempt.end;
            let error = self.size_of(&attempt.error, &end);
            let usable = error.is_finite() && attempt.rate.iter().all(|value| value.is_finite());
            let factor = if usable { 0.9 * libm::pow(error, -1.0 / f64::from(M::ERROR_ORDER)) } else { 0.1 };
            if usable && error <= 1.0 {
                // A step cut short by the horizon says little about the length of the next one.
                let next = h * factor.clamp(0.2, 6.0);
                self.h = if last { next.max(self.h) } else { next };
                let t = if last { horizon } else { self.state.t + h };
                self.state = State { t, y: end, rate: attempt.rate };
                return Ok(());
            }
            self.h = h * factor.clamp(0.1, 0.9);
        }
    }

    /// Integrates until `event` rises through zero, or to `horizon`.
    ///
    /// The event is located by steps of other lengths from the same start, not by interpolation: on a slow motion
    /// between fast modes the ends of the steps are far more accurate than anything between them.
    ///
    /// # Errors
    /// As [`advance`](Self::advance), and those of `event`.
    pub fn until(
        &mut self,
        horizon: f64,
        mut event: impl FnMut(f64, &[f64; N]) -> Result<f64, Failure>,
    ) -> Result<Outcome<N>, Failure> {
        let mut before = event(self.state.t, &self.state.y)?;
        while self.state.t < horizon {
            let start = self.state;
            self.advance(horizon)?;
            let after = event(self.state.t, &self.state.y)?;
            if before < 0.0 && after >= 0.0 {
                let (low, high) = (Point { x: start.t, y: before }, Point { x: self.state.t, y: after });
                return self.locate(&start, (low, high), event).map(Outcome::Event);
            }
            before = after;
        }
        Ok(Outcome::Horizon(End { t: self.state.t, y: self.state.y }))
    }

    fn locate(
        &mut self,
        start: &State<N>,
        (low, high): (Point, Point),
        mut event: impl FnMut(f64, &[f64; N]) -> Result<f64, Failure>,
    ) -> Result<End<N>, Failure> {
        let mut to = |t: f64| {
            let attempt = M::step(self.problem, start, t - start.t);
            self.evaluations += attempt.evaluations;
            attempt.end
        };
        let t = root::between(low, high, |t| event(t, &to(t)))?;
        // The ends of the bracket are known, and a step of zero length has no end.
        let y = if t == start.t { start.y } else { to(t) };
        Ok(End { t, y })
    }

    fn size_of(&self, error: &[f64; N], end: &[f64; N]) -> f64 {
        let mut largest = 0.0_f64;
        for i in 0..N {
            let scale = self.control.scale[i].max(self.state.y[i].abs()).max(end[i].abs());
            let size = error[i].abs() / (self.control.tolerance * scale);
            // max alone would lose a NaN.
            largest = if size > largest || size.is_nan() { size } else { largest };
        }
        largest
    }
}
