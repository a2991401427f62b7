//! Coulomb friction with an interfacial shear strength.

use std::f64::consts::PI;

use super::Pressed;
use crate::Scene;

/// F_Y* = mu_s N + tau pi a^2 (Tafazzoli & Sitti 2004).
#[derive(Clone, Copy, Debug)]
pub struct Coulomb<'a>(pub &'a Scene);

impl Coulomb<'_> {
    /// Returns the largest lateral force (N).
    #[inline(always)]
    pub fn capacity(&self, pressed: Pressed) -> f64 {
        self.0.static_friction * pressed.load + self.0.shear_strength * (PI * pressed.radius * pressed.radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn load_and_area_add() {
        let scene = Scene { static_friction: 0.5, shear_strength: 4e6, ..Scene::default() };
        let law = Coulomb(&scene);
        assert_eq!(law.capacity(Pressed { load: 3e-7, radius: 0.0 }), 1.5e-7);
        let of_area = law.capacity(Pressed { load: 0.0, radius: 1e-8 });
        assert!((of_area / (4e-10 * PI) - 1.0).abs() < 1e-15);
        assert_eq!(law.capacity(Pressed { load: 3e-7, radius: 1e-8 }), 1.5e-7 + of_area);
    }
}
