//! Armstrong's seven-parameter law.

use crate::Scene;

/// Friction with presliding, lag and memory of rest (Armstrong-Helouvry, Dupont & Canudas de Wit 1994, "A survey of
/// models, analysis tools and compensation methods for the control of machines with friction", section 4.3).
///
/// Sticking: F = sigma0 x. Sliding: F = {F_C + F_S(gamma, t_d)/[1 + (v(t - tau_l)/v_s)^2]} sgn v + F_v v, with
/// F_S(gamma, t_d) = F_S,a + (F_S,inf - F_S,a) t_d/(t_d + gamma) after a rest of t_d. Its F_S is the part of static
/// friction above F_C; here F_C = mu_d N, F_S,a = (mu_a - mu_d) N and F_S,inf = (mu_s - mu_d) N.
#[derive(Clone, Copy, Debug)]
pub struct Armstrong<'a>(pub &'a Scene);

impl Armstrong<'_> {
    /// Returns the static friction F_C + F_S(gamma, t_d) (N) under `load` (N) after a rest of `dwell` (s) or for ever.
    pub fn static_force(&self, load: f64, dwell: f64) -> f64 {
        let aged = 1.0 / (1.0 + self.0.dwell_constant / dwell);
        load * (self.0.fresh_friction * (1.0 - aged) + self.0.static_friction * aged)
    }

    /// Returns the force (N) at which a sticking contact breaks away when the force grows at `rate` (N/s), >= 0, after
    /// the rest t_r: static friction after the rest and the loading itself, F = static_force(t_r + F/rate). It is the
    /// positive root of a quadratic.
    pub fn break_away(&self, load: f64, rate: f64) -> f64 {
        let rest = self.0.rest_time;
        let fresh = self.0.fresh_friction * load;
        let gain = (self.0.static_friction - self.0.fresh_friction) * load;
        // F^2 + p F - q = 0 with q >= 0.
        let p = rate * (rest + self.0.dwell_constant) - fresh - gain;
        let q = rate * (fresh * self.0.dwell_constant + (fresh + gain) * rest);
        if !(p.is_finite() && q.is_finite()) {
            // Instantaneous loading.
            return self.static_force(load, rest);
        }
        let half = 0.5 * p;
        let root = libm::hypot(half, q.sqrt());
        if half > 0.0 { q / (half + root) } else { root - half }
    }
}

#[cfg(test)]
#[path = "tests/armstrong.rs"]
mod tests;
