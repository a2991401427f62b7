//! Coulomb friction with an interfacial shear strength.

use std::f64::consts::PI;

use super::Pressed;
use crate::Scene;

/// F_Y* = mu_s N + tau pi a^2 (Tafazzoli & Sitti 2004).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    /// Coefficient of static friction mu_s, >= 0.
    pub coefficient: f64,
    /// Interfacial shear strength tau (Pa), >= 0.
    pub shear_strength: f64,
}

impl Coulomb {
    /// Creates the law with the constants of `scene`.
    #[inline(always)]
    pub fn from_scene(scene: &Scene) -> Self {
        Self { coefficient: scene.static_friction, shear_strength: scene.shear_strength }
    }

    /// Returns the largest lateral force (N).
    #[inline(always)]
    pub fn capacity(&self, pressed: Pressed) -> f64 {
        self.coefficient * pressed.load + self.shear_strength * (PI * pressed.radius * pressed.radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn load_and_area_add() {
        let law = Coulomb { coefficient: 0.5, shear_strength: 4e6 };
        assert_eq!(law.capacity(Pressed { load: 3e-7, radius: 0.0 }), 1.5e-7);
        let of_area = law.capacity(Pressed { load: 0.0, radius: 1e-8 });
        assert!((of_area / (4e-10 * PI) - 1.0).abs() < 1e-15);
        assert_eq!(law.capacity(Pressed { load: 3e-7, radius: 1e-8 }), 1.5e-7 + of_area);
    }
}
