//! The swing of a stuck tip, carried over its many turns to the eve of the slip.
//!
//! Between start and slip the tip swings 1e3 to 1e7 times, all alike: about the equilibrium theta_e of the substrate's
//! position, theta = theta_e + a sin(phi) with phi' = omega(theta_e), and a^2 omega stays what it was (the adiabatic
//! invariant of an oscillator). What this leaves out is of the order of a times the change of omega in one turn. So the
//! equations of motion need be integrated over the last few turns only.

use super::motion::Motion;
use super::quasi_static::Statics;
use crate::afm::Failure;
use crate::afm::root::{self, Point};

/// The unknowns of [`Motion`] at a time.
pub(super) struct Eve {
    pub t: f64,
    pub y: [f64; 2],
}

impl Motion<'_> {
    /// Relative change of the frequency of the swing from start to the twist `theta`, and the other terms of theta^2 that
    /// make the swing differ from a sine.
    pub fn drift(&self, theta: f64) -> f64 {
        (self.local_frequency(theta) / self.local_frequency(0.0) - 1.0).abs() + theta * theta
    }

    /// Motion at the time `t`, before the slip at the twist `last`.
    ///
    /// # Errors
    /// None of its own; the search for the equilibrium cannot fail.
    pub fn carried_to(&self, t: f64, last: f64) -> Result<Eve, Failure> {
        let &Self { statics, scene, .. } = self;
        let travel = |theta: f64| statics.travel(theta, statics.lateral_force(theta)) - t * self.length;
        let (start, end) = (Point { x: 0.0, y: travel(0.0) }, Point { x: last, y: travel(last) });
        let theta = root::between(start, end, |theta| Ok(travel(theta)))?;
        let phase =
            integral(theta, |theta| self.local_frequency(theta) * travel_slope(statics, theta) / scene.velocity);
        let (first, here) = (self.local_frequency(0.0), self.local_frequency(theta));
        let mean = scene.velocity / scene.height;
        let kick = mean * (1.0 - self.turning(0.0));
        let away = kick / (first * here).sqrt() * libm::sin(phase);
        let rate = mean * self.turning(theta) + kick * (here / first).sqrt() * libm::cos(phase);
        // K_y y_P = K_y (s - H sin theta), s unchanged.
        let stretch =
            -2.0 * statics.probe.lateral * scene.height * libm::cos(theta + 0.5 * away) * libm::sin(0.5 * away);
        let lateral = statics.lateral_force(theta) + stretch;
        Ok(Eve { t, y: [lateral / self.force, rate / mean] })
    }

    /// theta' in equilibrium at the twist `theta`, in units of V/H.
    pub fn turning(&self, theta: f64) -> f64 {
        self.scene.height / travel_slope(self.statics, theta)
    }

    /// omega (rad/s) about the equilibrium at the twist `theta`, the apex held.
    fn local_frequency(&self, theta: f64) -> f64 {
        let &Self { statics, scene, .. } = self;
        let (sin, cos) = libm::sincos(theta);
        let height = scene.height;
        let twisting = height * (statics.lateral_moment_slope(theta) + statics.lateral_force(theta) * sin);
        let bending = statics.probe.lateral * (height * cos) * (height * cos);
        ((twisting + bending) / self.inertia).sqrt()
    }
}

/// d(travel)/d(theta) in equilibrium (m).
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

/// The integral of a smooth `f` from 0 to `end`, to rounding: panels are halved until that changes nothing.
fn integral(end: f64, f: impl Fn(f64) -> f64) -> f64 {
    let by = |panels: u32| {
        let half = 0.5 * end / f64::from(panels);
        let panel = |i: u32| {
            let middle = f64::from(2 * i + 1) * half;
            GAUSS.iter().map(|&(x, weight)| weight * f(middle + half * x)).sum::<f64>() * half
        };
        (0..panels).map(panel).sum::<f64>()
    };
    let mut sum = by(1);
    for halving in 1..=8 {
        let finer = by(1 << halving);
        let change = (finer - sum).abs();
        sum = finer;
        if change <= 1e-14 * sum.abs() {
            break;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the antiderivative; 1e-14 for the sum.
    #[test]
    fn integrals_are_exact_to_rounding() {
        for end in [1e-6_f64, 0.3, 1.5] {
            assert!((integral(end, libm::cos) / libm::sin(end) - 1.0).abs() < 1e-14, "{end}");
        }
        assert_eq!(integral(0.0, libm::cos), 0.0);
    }
}
