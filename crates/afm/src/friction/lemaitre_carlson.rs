//! Lemaitre & Carlson 2004, "Boundary lubrication with a glassy interface", Phys. Rev. E 69, 061611.

use std::f64::consts::PI;

use super::{Drive, Held, Pressed};
use crate::ode::{Control, End, March, Outcome, Problem, Rodas};
use crate::{Failure, Scene};

/// A glassy layer of thickness 2 h between particle and substrate, sheared by its whole area:
/// gam' = E0 exp(-1/chi) sinh(sig/mubar), sig' = mu (V/(2h) - gam'), chi' = -E1 exp(-kappa/chi) + alpha sig gam'.
/// The disorder chi falls with age and rises with plastic work. The paper prints x-dot for chi-dot.
#[derive(Clone, Copy, Debug)]
pub struct LemaitreCarlson<'a>(pub &'a Scene);

/// The layer pulled through a spring: stress in units of mubar and disorder over the strain V t/(2 h).
pub(super) struct Sheared<'a> {
    scene: &'a Scene,
    /// V/(2h) (1/s).
    rate: f64,
    /// Modulus of layer and spring in series over mubar.
    modulus: f64,
}

impl<'a> LemaitreCarlson<'a> {
    /// Creates the layer over the area (m2) pulled at `velocity` (m/s), > 0, through a spring of `stiffness` (N/m),
    /// which may be infinite.
    pub(super) fn sheared(&self, area: f64, velocity: f64, stiffness: f64) -> Sheared<'a> {
        let thickness = 2.0 * self.0.layer_half_thickness;
        let modulus = 1.0 / (1.0 / self.0.layer_modulus + area / (thickness * stiffness));
        Sheared { scene: self.0, rate: velocity / thickness, modulus: modulus / self.0.layer_stress }
    }

    /// Returns the first peak of the force (N) when pulled steadily.
    ///
    /// # Errors
    /// [`Failure::VelocityZero`], since the layer grows stronger without limit at rest; those of [`March`].
    pub fn capacity(&self, pressed: Pressed, drive: &Drive) -> Result<Held, Failure> {
        if drive.velocity == 0.0 {
            return Err(Failure::VelocityZero);
        }
        let area = PI * pressed.radius * pressed.radius;
        if area == 0.0 {
            return Ok(Held { force: 0.0, evaluations: 0 });
        }
        // So close to gam' = V/(2h) that the remaining rise is below the tolerance, reached or only approached.
        let (end, evaluations) = self.pull(area, drive, |layer, y| {
            layer.plastic_rate(y) - 1.0 + drive.tolerance * (1.0 / layer.modulus).min(1.0)
        })?;
        Ok(Held { force: area * self.0.layer_stress * end.y[0], evaluations })
    }

    /// Returns the travel (m) of the far end of the spring when the force on a contact of `radius` (m) first reaches
    /// `force` (N), which is below the first peak, at a velocity above zero.
    ///
    /// # Errors
    /// Those of [`March`].
    pub(crate) fn travel(&self, radius: f64, force: f64, drive: &Drive) -> Result<f64, Failure> {
        let area = PI * radius * radius;
        let stress = force / (area * self.0.layer_stress);
        let (end, _) = self.pull(area, drive, |_, y| y[0] - stress)?;
        Ok(2.0 * self.0.layer_half_thickness * end.t)
    }

    /// Integrates the layer over the area (m2), pulled at a velocity above zero, until `event` rises through zero; also
    /// returns the number of evaluations.
    ///
    /// # Errors
    /// Those of [`March`].
    fn pull(
        &self,
        area: f64,
        drive: &Drive,
        event: impl Fn(&Sheared<'_>, &[f64; 2]) -> f64,
    ) -> Result<(End<2>, u64), Failure> {
        let layer = self.sheared(area, drive.velocity, drive.stiffness);
        let mut march = March::<Rodas, _, 2>::new(&layer, (0.0, [0.0, self.0.initial_disorder]), layer.control(drive));
        let (Outcome::Event(end) | Outcome::Horizon(end)) = march.until(f64::MAX, |_, y| Ok(event(&layer, y)))?;
        Ok((end, march.evaluations()))
    }
}

/// Returns exp(-barrier/chi); at chi = 0 there is no ageing and no rearrangement.
pub(super) fn activation(barrier: f64, disorder: f64) -> f64 {
    if disorder > 0.0 { libm::exp(-barrier / disorder) } else { 0.0 }
}

impl Sheared<'_> {
    pub(super) fn control(&self, drive: &Drive) -> Control<2> {
        let disorder = self.scene.initial_disorder;
        // If it is sheared slowly it ages long before it strains, which a first step by the strain alone would miss.
        let ageing = self.scene.ageing_rate / self.rate * activation(self.scene.ageing_barrier, disorder);
        Control {
            tolerance: drive.tolerance,
            scale: [1.0, disorder],
            first_step: (1e-3 / self.modulus).min(1e-3 * disorder / ageing),
            longest_step: f64::INFINITY,
            step_budget: drive.step_budget,
        }
    }

    /// Returns gam' in units of V/(2h).
    pub(super) fn plastic_rate(&self, &[s, disorder]: &[f64; 2]) -> f64 {
        self.scene.rearrangement_rate / self.rate * activation(1.0, disorder) * libm::sinh(s)
    }
}

impl Problem<2> for Sheared<'_> {
    fn rate(&self, _: f64, y: &[f64; 2]) -> [f64; 2] {
        let flow = self.plastic_rate(y);
        let ageing = self.scene.ageing_rate / self.rate * activation(self.scene.ageing_barrier, y[1]);
        [self.modulus * (1.0 - flow), self.scene.disorder_gain * self.scene.layer_stress * y[0] * flow - ageing]
    }

    fn jacobian(&self, _: f64, y: &[f64; 2]) -> [[f64; 2]; 2] {
        let &[s, disorder] = y;
        let flow = self.plastic_rate(y);
        let by_s = self.scene.rearrangement_rate / self.rate * activation(1.0, disorder) * libm::cosh(s);
        let squared = disorder * disorder;
        let by_disorder = if disorder > 0.0 { flow / squared } else { 0.0 };
        let kappa = self.scene.ageing_barrier;
        let ageing = self.scene.ageing_rate / self.rate * activation(kappa, disorder);
        let ageing_slope = if disorder > 0.0 { ageing * kappa / squared } else { 0.0 };
        let gain = self.scene.disorder_gain * self.scene.layer_stress;
        [
            [-self.modulus * by_s, -self.modulus * by_disorder],
            [gain * (flow + s * by_s), gain * s * by_disorder - ageing_slope],
        ]
    }
}

#[cfg(test)]
#[path = "tests/lemaitre_carlson.rs"]
mod tests;
