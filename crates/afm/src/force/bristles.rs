//! Motion of the tip together with a particle that has mass and slides on LuGre bristles.

use super::motion::{Motion, Twist, local_tolerance};
use super::presliding::REACHED;
use super::slip::Slip;
use super::substrate::Substrate;
use crate::Failure;
use crate::friction::{LuGre, particle_mass};
use crate::ode::{Control, End, March, Outcome, Problem, Rodas};

/// The equations of [`Motion`], with the apex fixed to a particle that moves by
///
///   m_p x'' = F_Y - F,  F = sigma0 z + sigma1 z' + sigma2 x',  z' = x' - sigma0 |x'| z/Fss(x')
///
/// (Canudas de Wit et al. 1995), where x is the displacement of the particle relative to the substrate, against the
/// motion of the substrate. The apex is at s = V t - x. Unknowns, in the units of `Motion`: K_y y_P, theta', x, x' and
/// sigma0 z.
///
/// The inertia force of the tip's mass due to x'' is neglected, as in the equations of the tip, which are those of an
/// apex at constant velocity.
pub(super) struct Bristles<'a> {
    motion: &'a Motion<'a>,
    substrate: &'a Substrate<'a>,
    limit: &'a Slip,
    law: LuGre,
    velocity: f64,
    /// Acceleration of the particle per unit of force, 1/m_p, in units of V per unit of time.
    agility: f64,
    /// sigma0, sigma1 and sigma2 in units of force, length and velocity.
    stiffness: f64,
    damping: f64,
    viscosity: f64,
}

impl<'a> Bristles<'a> {
    /// Creates the bristles of the contact with the quasi-static slip `limit`.
    pub fn new(motion: &'a Motion<'a>, substrate: &'a Substrate<'a>, limit: &'a Slip) -> Self {
        let scene = substrate.scene;
        let law = LuGre::with(scene, substrate.options.lugre, limit.contact.radius);
        let velocity = scene.velocity;
        Self {
            motion,
            substrate,
            limit,
            law,
            velocity,
            agility: motion.time * motion.force / (particle_mass(scene) * velocity),
            stiffness: law.stiffness * motion.length / motion.force,
            damping: law.damping * velocity / motion.force,
            viscosity: law.viscous_friction * velocity / motion.force,
        }
    }

    /// Integrates to the maximum of F, or until the remaining rise is below the tolerance; then again from a step before
    /// the force reaches the slip, for the time of the slip.
    ///
    /// Without the swing dF/dt = k_lat (V - x'), so F is largest where x' = V. This condition is not sufficient: from the
    /// start the swing of the tip makes x' exceed V for short times. At the maximum F has also reached the force of
    /// steady sliding, Fss(V) + sigma2 V; before it, either the bristles still stretch or the viscous forces are below
    /// those at V. With viscous friction the maximum follows the saturation of the bristles (sigma0 z = Fss) by a few
    /// times sigma2/k_lat.
    pub fn slip(&self) -> Result<(Slip, u64), Failure> {
        let followed = self.motion.swing().is_followed(self.motion.length, self.velocity);
        let swing = if followed { 0.0 } else { self.motion.swing().spring / self.motion.force };
        // Not below a tenth of a swing that is not followed, since a smaller one would not help. And not coarse: a long
        // step would miss a sudden saturation of the bristles.
        let tolerance = local_tolerance(self.substrate.options).max(0.1 * swing).min(1e-7);
        // Angular frequency of the particle on its bristles and the spring of the probe, sqrt((sigma0 + k_lat)/m_p).
        let shaking = (self.agility * (1.0 + self.stiffness)).sqrt();
        let control = Control {
            tolerance,
            scale: [1.0, self.motion.frequency().max(1.0), 1.0, shaking.max(1.0), 1.0],
            first_step: 1e-3,
            longest_step: 0.1,
            step_budget: self.substrate.options.step_budget,
        };
        // Where the bristles limit the approach, 1 - x'/V is sigma0/k_lat times the relative remaining rise.
        let near = (10.0 * tolerance * self.stiffness).clamp(1e-3, 0.5);
        let start = [0.0, if followed { 1.0 } else { self.slow_turning() }, 0.0, 0.0, 0.0];
        let mut largest = End { t: 0.0, y: start };
        // The last step well before the slip, whose force is 1 by the quasi-static rung.
        let mut before = End { t: 0.0, y: start };
        // Bristles and dashpots each approach their limit exponentially: to 1e-12 in 28 time constants.
        let horizon = 10.0 + 30.0 * (1.0 + 3.0 / self.stiffness);
        // While the bristles stretch, the error of the particle's velocity is weighted by its effect on them. When they
        // saturate, this velocity determines the time of the maximum. Its error is that of a stiff unknown, which the
        // next steps forget: a tenth of the weight changes force and time by less than a tenth of their own errors.
        let mut stretching = March::<Rodas, _, 5>::new(self, (0.0, start), control);
        let (Outcome::Event(half) | Outcome::Horizon(half)) =
            stretching.until(horizon, |t, y| Ok(y[0] / self.strength(self.load(t - y[2], y[0]), 1.0) - 0.5))?;
        let [forces, turning, way, _, bristles] = control.scale;
        let control = Control { scale: [forces, turning, way, 10.0, bristles], ..control };
        let mut march = March::<Rodas, _, 5>::new(self, (half.t, half.y), control);
        let outcome = march.until(horizon, |t, y| {
            let &[q, _, x, u, _] = y;
            if q < REACHED - 1e-3 && t > before.t {
                before = End { t, y: *y };
            }
            if q > largest.y[0] {
                largest = End { t, y: *y };
            }
            let steady = self.strength(self.load(t - x, q), 1.0) + self.viscosity;
            Ok((q / steady - 1.0 + tolerance).min(u - 1.0 + near))
        })?;
        let end = match outcome {
            Outcome::Event(end) => end,
            // The force stayed below that of steady sliding: use the largest one.
            Outcome::Horizon(_) => largest,
        };
        let level = REACHED * end.y[0];
        let from = if before.y[0] > 0.0 && before.y[0] < level { before } else { half };
        let mut again = March::<Rodas, _, 5>::new(self, (from.t, from.y), control);
        let reached = if from.y[0] < level {
            let (Outcome::Event(end) | Outcome::Horizon(end)) = again.until(horizon, |_, y| Ok(y[0] / level - 1.0))?;
            end.t
        } else {
            from.t
        };
        let [q, w, creep, _, _] = end.y;
        let tip = self.motion.tip(end.t - creep, &[q, w]);
        let slip = Slip {
            normal_force: tip.normal_force,
            // The force on the particle: the inertia force of the tip's mass is neglected here too.
            lateral_force: q * self.motion.force,
            travel: (end.t - creep) * self.motion.length,
            twist: tip.twist,
            contact: self.substrate.contact(tip.normal_force)?,
            advance: (reached - (end.t - creep)) * self.motion.length,
            slowdown: self.limit.slowdown,
        };
        Ok((slip, stretching.evaluations() + march.evaluations() + again.evaluations()))
    }

    /// Returns theta' for a start without a swing: that of a tip in equilibrium whose apex moves at V less the velocity
    /// of the stretching bristles, V sigma0/(sigma0 + k_lat).
    fn slow_turning(&self) -> f64 {
        self.motion.turning(0.0) * self.stiffness / (1.0 + self.stiffness)
    }

    /// Returns the load of the friction law (N).
    fn load(&self, s: f64, q: f64) -> f64 {
        self.load_at(&self.motion.twist(s, q))
    }

    fn load_at(&self, twist: &Twist) -> f64 {
        twist.normal_spring + self.substrate.adhesive_load
    }

    fn strength(&self, load: f64, u: f64) -> f64 {
        self.law.stribeck(load, u * self.velocity) / self.motion.force
    }
}

impl Problem<5> for Bristles<'_> {
    fn rate(&self, t: f64, &[q, w, x, u, p]: &[f64; 5]) -> [f64; 5] {
        let twist = self.motion.twist(t - x, q);
        let [rise, turn] = self.motion.rates(&twist, 1.0 - u, &[q, w]);
        let sprung = u - u.abs() * p / self.strength(self.load_at(&twist), u);
        let friction = p + self.damping * sprung + self.viscosity * u;
        [rise, turn, u, self.agility * (q - friction), self.stiffness * sprung]
    }

    /// Neglects the change of the load with the twist, which is of second order; the error estimate of the integration
    /// covers it.
    fn jacobian(&self, t: f64, &[q, w, x, u, p]: &[f64; 5]) -> [[f64; 5]; 5] {
        let twist = self.motion.twist(t - x, q);
        let [[rise_q, rise_w, rise_s], [turn_q, turn_w, turn_s]] = self.motion.slopes(&twist, &[q, w]);
        let load = self.load_at(&twist);
        let strength = self.strength(load, u);
        let slope = self.law.stribeck_slope(load, u * self.velocity) * self.velocity / self.motion.force;
        let by_p = -u.abs() / strength;
        let by_u = 1.0 - u.signum() * p / strength + u.abs() * p * slope / (strength * strength);
        let g = self.agility;
        [
            [rise_q, rise_w, -rise_s, -self.motion.stiffness, 0.0],
            [turn_q, turn_w, -turn_s, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0, 0.0],
            [g, 0.0, 0.0, -g * (self.damping * by_u + self.viscosity), -g * (1.0 + self.damping * by_p)],
            [0.0, 0.0, 0.0, self.stiffness * by_u, self.stiffness * by_p],
        ]
    }

    fn time_rate(&self, t: f64, &[q, w, x, _, _]: &[f64; 5]) -> [f64; 5] {
        let [[_, _, rise_s], [_, _, turn_s]] = self.motion.slopes(&self.motion.twist(t - x, q), &[q, w]);
        [rise_s, turn_s, 0.0, 0.0, 0.0]
    }
}
