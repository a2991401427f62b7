//! A particle on LuGre bristles, pulled by a spring whose other end moves steadily.

use super::{Drive, Held, LuGre};
use crate::Failure;
use crate::ode::{Control, End, March, Outcome, Problem, Rodas};

/// dF/dt = k_lat (V - v), with v from the balance F = sigma0 z + sigma1 z' + sigma2 v of a massless particle, or from
/// m v' = F - friction of one with mass.
///
/// In units of F0, the largest friction of the problem, for forces, V for velocities and F0/(k_lat V) for time: p =
/// sigma0 z, u = v, and w = (F - p)/s, the force on the dashpots in units of s, their size at V. So F is not subtracted
/// from p, with which it agrees to many digits.
#[derive(Clone, Copy)]
pub(super) struct Ramp {
    law: LuGre,
    load: f64,
    velocity: f64,
    unit: f64,
    /// sigma0/k_lat.
    stiffness: f64,
    /// sigma1 V and sigma2 V as shares of their sum, and the sum over F0.
    damping: f64,
    viscosity: f64,
    dashpots: f64,
    /// m k_lat V^2/F0^2 over `dashpots`; 0 for a particle with negligible mass.
    mass: f64,
    inertia: f64,
}

/// Returns the largest force of the ramp (N): its peak, where v reaches V; the force of steady sliding if v tends to V
/// from below.
///
/// # Errors
/// Those of [`March`].
pub(super) fn peak(law: &LuGre, load: f64, drive: &Drive) -> Result<Held, Failure> {
    let velocity = drive.velocity;
    let steady = law.steady_force(load, velocity);
    let largest = law.stribeck(load, 0.0).max(law.stribeck(load, velocity));
    if stays_near_steady(law, load, drive) || largest <= 0.0 {
        return Ok(Held { force: steady, evaluations: 0 });
    }
    let ramp = Ramp::new(law, load, drive);
    // Bristles hold no more than the largest friction, the dashpots up to V no more than at V, and a mass accelerated
    // to V takes V sqrt(k_lat m): more is due to steps that are too long for the bristles, far outside any laboratory.
    let inertial = velocity * (drive.stiffness * drive.mass).sqrt();
    let most = largest + (law.damping + law.viscous_friction) * velocity + inertial;
    // The remaining rise when v is this close to V is below the tolerance, whether v passes V or only tends to it. The
    // start, where inertia may let v swing past V, is excluded.
    let near = drive.tolerance * ramp.stiffness.min(1.0);
    let (end, evaluations) =
        ramp.climb(drive, |ramp, y| if ramp.force(y) > 0.1 * ramp.unit { y[2] - 1.0 + near } else { -1.0 })?;
    let force = ramp.force(&end.y);
    // Outside, the integration has missed its limit.
    let is_plausible = (UNDERSHOOT * steady..=OVERSHOOT * most).contains(&force);
    if is_plausible { Ok(Held { force, evaluations }) } else { Err(Failure::StepTooSmall) }
}

/// Returns the travel V t (m) of the spring's far end when the force first reaches `force` (N), and the evaluations.
///
/// # Errors
/// Those of [`March`].
pub(crate) fn travel(law: &LuGre, load: f64, drive: &Drive, force: f64) -> Result<(f64, u64), Failure> {
    let ramp = Ramp::new(law, load, drive);
    let (end, evaluations) = ramp.climb(drive, |ramp, y| ramp.force(y) / force - 1.0)?;
    Ok((end.t * ramp.unit / drive.stiffness, evaluations))
}

/// Factor by which a peak may exceed its bound.
const OVERSHOOT: f64 = 1.01;
/// Share of the force of steady sliding that a peak always reaches.
const UNDERSHOOT: f64 = 0.5;

/// Returns whether the peak is [near enough](Drive::near_steady) to the force of steady sliding, by bounds.
///
/// The force rises while v is below V. If v only tends to V, the steady force is approached. If v passes V, p = sigma0
/// z must be above Fss(V) then: by Fss(0) - Fss(V) at most. And p passes Fss(V) while v is still below V; from then on
/// p' <= W F' with W = sigma0 V |Fss'|/(k_lat Fss), the rest, (1 - W) F' at least, moves the dashpots on to V, and so p
/// gains W/(1 - W) of their force at most.
fn stays_near_steady(law: &LuGre, load: f64, drive: &Drive) -> bool {
    let velocity = drive.velocity;
    let strength = law.stribeck(load, velocity);
    // The curve is steepest at v_s/sqrt(2).
    let steepest = velocity.min(law.stribeck_velocity * std::f64::consts::FRAC_1_SQRT_2);
    let slope = (-law.stribeck_slope(load, steepest)).max(0.0);
    let weakening = law.stiffness * velocity * slope / (drive.stiffness * strength);
    let spread = (law.stribeck(load, 0.0) - strength).max(0.0);
    let gained = weakening / (1.0 - weakening) * (law.damping + law.viscous_friction) * velocity;
    let near = drive.near_steady() * law.steady_force(load, velocity);
    velocity == 0.0 || weakening < 0.1 && law.damping * velocity < strength && spread.min(gained) <= near
}

impl Ramp {
    fn new(law: &LuGre, load: f64, drive: &Drive) -> Self {
        let velocity = drive.velocity;
        let largest = law.stribeck(load, 0.0).max(law.stribeck(load, velocity));
        let unit = largest + law.viscous_friction * velocity;
        let forces = [law.damping * velocity / unit, law.viscous_friction * velocity / unit];
        let damped = forces[0] + forces[1] > 0.0;
        let dashpots = if damped { forces[0] + forces[1] } else { 1.0 };
        let inertia = drive.mass * (drive.stiffness * velocity / unit) * (velocity / unit) / dashpots;
        Self {
            law: *law,
            load,
            velocity,
            unit,
            stiffness: law.stiffness / drive.stiffness,
            damping: forces[0] / dashpots,
            viscosity: forces[1] / dashpots,
            dashpots,
            // Without dashpots only its mass gives the particle a velocity.
            mass: if damped { 0.0 } else { inertia },
            inertia,
        }
    }

    /// Returns the transmitted force (N).
    fn force(&self, y: &[f64; 3]) -> f64 {
        self.unit * (y[0] + self.dashpots * y[1])
    }

    /// Integrates until `event` rises through zero.
    fn climb(&self, drive: &Drive, event: impl Fn(&Self, &[f64; 3]) -> f64) -> Result<(End<3>, u64), Failure> {
        // The velocity of a particle swinging on its bristles is weighted by its effect on them: u over the frequency.
        let inertia = self.mass * self.dashpots;
        let swing = if inertia > 0.0 { ((1.0 + self.stiffness) / inertia).sqrt().max(1.0) } else { 1.0 };
        let control = Control {
            tolerance: drive.tolerance,
            scale: [1.0, 1.0, swing],
            first_step: 1e-6,
            longest_step: f64::INFINITY,
            step_budget: drive.step_budget,
        };
        let mut march = March::<Rodas, _, 3>::new(self, (0.0, [0.0; 3]), control);
        match march.until(f64::MAX, |_, y| Ok(event(self, y))) {
            Ok(Outcome::Event(end) | Outcome::Horizon(end)) => Ok((end, march.evaluations())),
            // If friction weakens faster than the dashpots hold, the velocity of a massless particle is undefined.
            Err(Failure::StepTooSmall) if self.mass == 0.0 && self.inertia > 0.0 => {
                Self { mass: self.inertia, ..*self }.climb(drive, event)
            }
            Err(failure) => Err(failure),
        }
    }

    fn strength(&self, u: f64) -> f64 {
        self.law.stribeck(self.load, u * self.velocity) / self.unit
    }

    /// Returns z'/V.
    fn sprung(&self, p: f64, u: f64) -> f64 {
        u - u.abs() * p / self.strength(u)
    }
}

impl Problem<3> for Ramp {
    fn rate(&self, _: f64, &[p, w, u]: &[f64; 3]) -> [f64; 3] {
        let sprung = self.sprung(p, u);
        let rise = self.stiffness * sprung;
        [rise, 1.0 - u - rise, w - self.damping * sprung - self.viscosity * u]
    }

    fn jacobian(&self, _: f64, &[p, _, u]: &[f64; 3]) -> [[f64; 3]; 3] {
        let strength = self.strength(u);
        let slope = self.law.stribeck_slope(self.load, u * self.velocity) * self.velocity / self.unit;
        let by_p = -u.abs() / strength;
        let by_u = 1.0 - u.signum() * p / strength + u.abs() * p * slope / (strength * strength);
        let k = self.stiffness;
        [
            [k * by_p, 0.0, k * by_u],
            [-k * by_p, 0.0, -1.0 - k * by_u],
            [-self.damping * by_p, 1.0, -self.damping * by_u - self.viscosity],
        ]
    }

    fn mass(&self) -> [f64; 3] {
        [1.0, self.dashpots, self.mass]
    }
}

#[cfg(test)]
#[path = "tests/ramp.rs"]
mod tests;
