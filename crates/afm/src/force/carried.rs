//! The oscillation (swing) of a tip that sticks to the particle, extrapolated over its many periods to just before the
//! slip.
//!
//! Between start and slip the tip swings 1e3 to 1e7 times about the equilibrium theta_e at the position of the
//! substrate: theta = theta_e + a sin(phi) with phi' = omega(theta_e). a^2 omega is constant, the adiabatic invariant of
//! an oscillator with constant inertia (Landau & Lifshitz, Mechanics, section 49). The error is of the order of a times
//! the relative change of omega in one period. So the equations of motion are integrated only over the last few periods.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::motion::Motion;
use super::slip::Slip;
use super::statics::Statics;
use super::substrate::Substrate;
use crate::Failure;
use crate::ode::End;
use crate::root::{self, Point};

impl Motion<'_> {
    /// Returns the relative change of omega from the start to the twist `theta`, plus theta^2 for the other terms of
    /// second order, by which the swing differs from a sine.
    pub fn drift(&self, theta: f64) -> f64 {
        (self.local_frequency(theta) / self.local_frequency(0.0) - 1.0).abs() + theta * theta
    }

    /// Returns the motion at the time `t`, before the slip at the twist `last`.
    ///
    /// # Errors
    /// None: the search for the equilibrium cannot fail.
    pub fn carried_to(&self, t: f64, last: f64) -> Result<End<2>, Failure> {
        let statics = self.statics;
        let travel = |theta: f64| statics.travel(theta, statics.lateral_force(theta)) - t * self.length;
        let (start, end) = (Point { x: 0.0, y: travel(0.0) }, Point { x: last, y: travel(last) });
        let theta = root::between(start, end, |theta| Ok(travel(theta)))?;
        Ok(End { t, y: self.swung(theta, self.phase(theta)) })
    }

    /// Returns phi at the equilibrium at the twist `theta` (rad), the integral of omega dt from the start.
    fn phase(&self, theta: f64) -> f64 {
        let &Self { statics, scene, .. } = self;
        integral(theta, |theta| self.local_frequency(theta) * travel_slope(statics, theta) / scene.velocity)
    }

    /// Returns the unknowns about the equilibrium at the twist `theta` for the phase phi of the swing. theta' at the start
    /// is V/H, so a(0) = (V/H - theta_e')/omega(0).
    fn swung(&self, theta: f64, phase: f64) -> [f64; 2] {
        let &Self { statics, scene, .. } = self;
        let (first, here) = (self.local_frequency(0.0), self.local_frequency(theta));
        let mean = scene.velocity / scene.height;
        let kick = mean * (1.0 - self.turning(0.0));
        let away = kick / (first * here).sqrt() * libm::sin(phase);
        let rate = mean * self.turning(theta) + kick * (here / first).sqrt() * libm::cos(phase);
        // The change of K_y y_P = K_y (s - H sin theta) at the same s.
        let stretch =
            -2.0 * statics.probe.lateral * scene.height * libm::cos(theta + 0.5 * away) * libm::sin(0.5 * away);
        let lateral = statics.lateral_force(theta) + stretch;
        [lateral / self.force, rate / mean]
    }

    /// Returns the first time at which F_Y with the swing reaches F_Y*(F_Z), linearised about the quasi-static slip: there
    /// F_Y - F_Y* is a linear function of time plus a sine, whose phase and amplitude are those of
    /// [`swung`](Self::swung).
    ///
    /// # Errors
    /// Those of the law of friction.
    pub fn first_slip(&self, limit: &Slip, substrate: &Substrate) -> Result<FirstSlip, Failure> {
        let &Self { statics, scene, .. } = self;
        let theta = limit.twist;
        let mut evaluations = 0;
        let mut excess = |phase: f64| {
            let tip = self.tip(1.0, &self.swung(theta, phase));
            let hold = substrate.hold(tip.normal_force)?;
            evaluations += hold.evaluations;
            Ok(tip.lateral_force - hold.capacity)
        };
        let [east, north, west, south] = [excess(0.0)?, excess(FRAC_PI_2)?, excess(PI)?, excess(PI + FRAC_PI_2)?];
        let (sine, cosine) = (0.5 * (north - south), 0.5 * (east - west));
        let amplitude = libm::hypot(sine, cosine);
        let mean = 0.25 * (east + north + west + south);
        let overtone = 0.25 * (north + south - east - west).abs();
        let frequency = self.local_frequency(theta);
        let fading = limit.slope(substrate) * statics.probe.normal * scene.height * libm::sin(theta);
        let slope = (statics.lateral_force_slope(theta) + fading) / travel_slope(statics, theta) * scene.velocity;
        let turns = self.phase(theta);
        let phase = turns + libm::atan2(cosine, sine);
        let steepness = slope / frequency / amplitude;
        let offset = mean / amplitude;
        // The error of the adiabatic approximation is of the order of the change in one period.
        let doubt = overtone / amplitude + self.drift(theta) / turns + 1e-14 * turns + 1e-6;
        let [here, early, late] =
            [offset, offset + doubt, offset - doubt].map(|offset| first_crossing(steepness, offset, phase));
        let (here, early, late) = (here?, early?, late?);
        let share = 1.0 / (frequency * self.time);
        let away = (here * share).abs();
        let error = ((early - here).abs().max((late - here).abs()) * share + away * away).min(1.0);
        // Before the start, or without a swing, there is no effect.
        let error = if away < 0.5 { error } else { 1.0 };
        Ok(FirstSlip { advance: here * share * self.length, error, evaluations })
    }

    /// Returns theta' in equilibrium at the twist `theta`, in units of V/H.
    pub fn turning(&self, theta: f64) -> f64 {
        self.scene.height / travel_slope(self.statics, theta)
    }

    /// Returns omega (rad/s) about the equilibrium at the twist `theta`, with the apex fixed: I_T omega^2 is the derivative
    /// by theta of K_theta theta - H (K_y y_P cos theta + K_z z_P sin theta) at constant s.
    fn local_frequency(&self, theta: f64) -> f64 {
        let &Self { statics, scene, .. } = self;
        let (sin, cos) = libm::sincos(theta);
        let height = scene.height;
        let twisting = height * (statics.lateral_moment_slope(theta) + statics.lateral_force(theta) * sin);
        let bending = statics.probe.lateral * (height * cos) * (height * cos);
        ((twisting + bending) / self.inertia).sqrt()
    }
}

/// The slip of a tip that swings.
pub(super) struct FirstSlip {
    /// Travel of the substrate in addition to that at the quasi-static slip (m).
    pub advance: f64,
    /// Relative error of the time; at most 1.
    pub error: f64,
    pub evaluations: u64,
}

/// Returns the smallest root x of `slope` x + `offset` + sin(`phase` + x); `slope` > 0.
fn first_crossing(slope: f64, offset: f64, phase: f64) -> Result<f64, Failure> {
    let value = |x: f64| slope * x + offset + libm::sin(phase + x);
    let (low, high) = if slope >= 1.0 {
        ((-offset - 1.0) / slope, (-offset + 1.0) / slope)
    } else {
        // Between the first positive maximum and the minimum before it.
        let top = libm::acos(-slope);
        let least = -(offset + libm::sin(top)) / slope;
        let turn = TAU * ((least + phase - top) / TAU).ceil();
        (turn - top - phase, turn + top - phase)
    };
    root::between(Point { x: low, y: value(low) }, Point { x: high, y: value(high) }, |x| Ok(value(x)))
}

/// Returns d(travel)/d(theta) in equilibrium (m).
fn travel_slope(statics: &Statics, theta: f64) -> f64 {
    statics.scene.height * libm::cos(theta) + statics.lateral_force_slope(theta) / statics.probe.lateral
}

/// Nodes and weights of Gauss's rule of five points on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// Returns the integral of `f` from 0 to `end` over so many panels.
fn integral_by(panels: u32, end: f64, f: impl Fn(f64) -> f64) -> f64 {
    let half = 0.5 * end / f64::from(panels);
    let panels = (0..panels).map(|i| {
        let middle = f64::from(2 * i + 1) * half;
        GAUSS.iter().map(|&(x, weight)| weight * f(middle + half * x)).sum::<f64>() * half
    });
    panels.sum()
}

/// Returns the integral of a smooth `f` from 0 to `end`, to rounding: panels are halved until the result is constant.
fn integral(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    let mut sum = integral_by(1, end, &f);
    for halving in 1..=8 {
        let finer = integral_by(1 << halving, end, &f);
        let change = (finer - sum).abs();
        sum = finer;
        if change <= 1e-14 * sum.abs() {
            break;
        }
    }
    sum
}

#[cfg(test)]
#[path = "tests/carried.rs"]
mod tests;
