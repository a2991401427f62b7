//! Dahl 1968, "A solid friction model".

use crate::Scene;

/// dF/dx = sigma |1 - (F/F_C) sgn v|^alpha sgn(1 - (F/F_C) sgn v): a spring that yields towards the Coulomb force
/// F_C = mu_d N. Independent of the rate of motion.
///
/// With alpha = 1 it is LuGre friction with Fss = F_C and neither sigma1 nor sigma2.
#[derive(Clone, Copy, Debug)]
pub struct Dahl<'a>(pub &'a Scene);

impl Dahl<'_> {
    /// Returns the force that it approaches and never exceeds from below, F_C (N), at the load (N).
    #[inline]
    pub fn capacity(&self, load: f64) -> f64 {
        self.0.dynamic_friction * load
    }

    /// Returns dF/dx (N/m) at the force `force` (N) under `load` (N) when moving in the `direction` (1 or -1).
    pub fn slope(&self, load: f64, force: f64, direction: f64) -> f64 {
        let reserve = 1.0 - force / self.capacity(load) * direction;
        self.0.bristle_stiffness * libm::pow(reserve.abs(), self.0.dahl_exponent).copysign(reserve)
    }
}
