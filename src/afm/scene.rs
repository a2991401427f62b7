//! Every constant of the problem.

/// Everything the physics depends on, in SI. The default is the nominal scene: a silicon cantilever
/// pushing a gold particle of 50 nm radius on silicon oxide.
///
/// [`Parameter::ALL`](super::Parameter::ALL) lists the same fields with symbols, units and physical domains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scene {
    /// Cantilever length L (m).
    pub length: f64,
    /// Cantilever width w (m).
    pub width: f64,
    /// Cantilever thickness t (m).
    pub thickness: f64,
    /// Tip height H (m).
    pub height: f64,
    /// Substrate velocity V (m/s).
    pub velocity: f64,
    /// Young's modulus of the cantilever, E (Pa).
    pub elastic_modulus: f64,
    /// Equivalent contact modulus K = (4/3) E*, of either contact (Pa).
    pub equivalent_modulus: f64,
    /// Work of adhesion omega, of either contact (J/m2).
    pub adhesion: f64,
    /// Poisson ratio of the cantilever, nu.
    pub poisson_ratio: f64,
    /// Shear modulus of the cantilever, G (Pa); `None` stands for E/(2 (1 + nu)). The papers print
    /// 40.5 GPa.
    pub shear_modulus: Option<f64>,
    /// Density of cantilever and tip (kg/m3).
    pub probe_density: f64,
    /// Radius of the tip cone at its base (m).
    pub tip_base_radius: f64,
    /// Particle radius R_p (m).
    pub particle_radius: f64,
    /// Radius of the tip apex, R_t (m).
    pub tip_radius: f64,
    /// Angle of the tip-particle contact from the vertical, phi (rad).
    pub contact_angle: f64,
    /// Preload angle phi0; the preload deflection is L sin(phi0) (rad).
    pub preload_angle: f64,
    /// Coefficient of static friction, mu_s.
    pub static_friction: f64,
    /// Coefficient of dynamic friction, mu_d. May exceed mu_s (friction that rises with velocity).
    pub dynamic_friction: f64,
    /// Interfacial shear strength tau (Pa). Tafazzoli & Sitti 2004 print 28 N/m2 and mean N/mm2.
    pub shear_strength: f64,
    /// Shear modulus of the particle, G1 (Pa).
    pub particle_shear_modulus: f64,
    /// Shear modulus of the substrate, G2 (Pa).
    pub substrate_shear_modulus: f64,
    /// Burgers vector b (m).
    pub burgers_vector: f64,
    /// Density of the particle (kg/m3).
    pub particle_density: f64,
    /// LuGre bristle stiffness sigma0 (N/m).
    pub bristle_stiffness: f64,
    /// LuGre bristle damping sigma1 (N s/m).
    pub bristle_damping: f64,
    /// LuGre viscous friction sigma2 (N s/m).
    pub viscous_friction: f64,
    /// Stribeck velocity v_s (m/s).
    pub stribeck_velocity: f64,
    /// Equilibrium separation of the surfaces, z0 (m).
    pub equilibrium_separation: f64,
    /// Hardness of the particle (Pa).
    pub hardness: f64,
    /// Poisson ratio of the particle, nu1. For LuGre friction with the parameters of the contact. Gold: 0.42.
    pub particle_poisson_ratio: f64,
    /// Poisson ratio of the substrate, nu2, likewise. Fused silica: 0.17.
    pub substrate_poisson_ratio: f64,
    /// Exponent alpha of Dahl's law, 1 in most uses: LuGre friction without damping at constant strength.
    pub dahl_exponent: f64,
    /// Exponent d_s of the classical Stribeck curve. 2, as in LuGre friction.
    pub stribeck_exponent: f64,
    /// Coefficient of static friction of a contact that has just come to rest, of Armstrong's law: F_C + F_S,a = mu_a N.
    /// No paper prints one for this contact: midway between mu_d and mu_s.
    pub fresh_friction: f64,
    /// Time gamma (s) in which Armstrong's static friction rises halfway from fresh to old. Chosen: the order of
    /// magnitude of Armstrong-Helouvry, Dupont & Canudas de Wit 1994.
    pub dwell_constant: f64,
    /// Time at rest before the substrate moves (s), which Armstrong's static friction remembers.
    pub rest_time: f64,
    /// Frictional lag tau_l of Armstrong's law (s): sliding friction answers the velocity so much earlier.
    pub frictional_lag: f64,
    /// Half the thickness of the Lemaitre-Carlson layer, h (m). Chosen: two nanometres of lubricant in all.
    pub layer_half_thickness: f64,
    /// Shear modulus of that layer, mu (Pa). Chosen: a glassy molecular film.
    pub layer_modulus: f64,
    /// Stress scale of its rearrangements, mubar (Pa). Chosen with the four rates below so that the layer slides steadily
    /// near the shear strength of 28 MPa at 100 nm/s, weakens with velocity and ages.
    pub layer_stress: f64,
    /// Rate E0 of its rearrangements (1/s).
    pub rearrangement_rate: f64,
    /// Rate E1 of its ageing (1/s).
    pub ageing_rate: f64,
    /// Barrier kappa of ageing, in units of that of rearrangements.
    pub ageing_barrier: f64,
    /// Disorder made by plastic work, alpha (1/Pa).
    pub disorder_gain: f64,
    /// Disorder chi at the start; smaller is older.
    pub initial_disorder: f64,
    /// Mass of the tip, m (kg); `None` stands for a cone, rho pi r^2 H/3.
    pub tip_mass: Option<f64>,
    /// Moment of inertia of the tip about an axis across it through its centre of mass, I_c (kg m2); `None` stands for
    /// a cone of the mass in force, m (3/80) (4 r^2 + H^2).
    pub tip_inertia: Option<f64>,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            length: 225e-6,
            width: 48e-6,
            thickness: 1e-6,
            height: 12e-6,
            velocity: 100e-9,
            elastic_modulus: 169e9,
            equivalent_modulus: 60e9,
            adhesion: 0.2,
            poisson_ratio: 0.27,
            shear_modulus: None,
            probe_density: 2330.0,
            tip_base_radius: 3e-6,
            particle_radius: 50e-9,
            tip_radius: 20e-9,
            contact_angle: 60_f64.to_radians(),
            preload_angle: 0.7_f64.to_radians(),
            static_friction: 0.8,
            dynamic_friction: 0.7,
            shear_strength: 28e6,
            particle_shear_modulus: 27e9,
            substrate_shear_modulus: 31.2e9,
            burgers_vector: 0.288e-9,
            particle_density: 19300.0,
            bristle_stiffness: 625.0,
            bristle_damping: 1.6e-7,
            viscous_friction: 1e-7,
            stribeck_velocity: 1e-3,
            equilibrium_separation: 0.2e-9,
            hardness: 3.7e9,
            particle_poisson_ratio: 0.42,
            substrate_poisson_ratio: 0.17,
            dahl_exponent: 1.0,
            stribeck_exponent: 2.0,
            fresh_friction: 0.75,
            dwell_constant: 1.0,
            rest_time: 0.0,
            frictional_lag: 1e-3,
            layer_half_thickness: 1e-9,
            layer_modulus: 1e9,
            layer_stress: 10e6,
            rearrangement_rate: 1e5,
            ageing_rate: 1.8e3,
            ageing_barrier: 0.5,
            disorder_gain: 1e-8,
            initial_disorder: 0.06,
            tip_mass: None,
            tip_inertia: None,
        }
    }
}

impl Scene {
    /// The shear modulus of the cantilever in force (Pa): the one given, else E/(2 (1 + nu)).
    #[inline(always)]
    pub fn effective_shear_modulus(&self) -> f64 {
        match self.shear_modulus {
            Some(given) => given,
            None => self.elastic_modulus / (2.0 * (1.0 + self.poisson_ratio)),
        }
    }

    /// The mass of the tip in force (kg): the one given, else that of a cone.
    #[inline(always)]
    pub fn effective_tip_mass(&self) -> f64 {
        let &Self { probe_density, tip_base_radius: r, height, .. } = self;
        self.tip_mass.unwrap_or(probe_density * std::f64::consts::PI * r * r * height / 3.0)
    }

    /// The moment of inertia of the tip about its centre of mass in force (kg m2): the one given, else that of a cone.
    #[inline(always)]
    pub fn effective_tip_inertia(&self) -> f64 {
        let &Self { tip_base_radius: r, height, .. } = self;
        self.tip_inertia.unwrap_or(self.effective_tip_mass() * (3.0 / 80.0) * (4.0 * r * r + height * height))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shear_modulus_follows_young_unless_given() {
        let scene = Scene::default();
        // 169 GPa / 2.54, by hand.
        assert!((scene.effective_shear_modulus() / 66.535_433e9 - 1.0).abs() < 1e-8);
        let given = Scene { shear_modulus: Some(40.5e9), ..scene };
        assert_eq!(given.effective_shear_modulus(), 40.5e9);
    }
}
