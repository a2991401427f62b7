//! Every constant of the problem, each with its default, symbol, unit, physical domain and description.

use apportion_base::quantity::Domain;

use super::Parameter;

/// Declares [`Scene`] with its defaults and [`Parameter::ALL`] together, so that they always agree. A field is
/// `name: type = default => value in force, symbol, unit, domain, description`.
macro_rules! scene {
    ($(#[$about:meta])* pub struct Scene { $($(#[$meta:meta])*
        $field:ident: $type:ty = $default:expr $(=> $in_force:path)?,
        $symbol:literal, $unit:literal, $domain:ident, $description:literal;)+
    }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Scene { $($(#[$meta])* pub $field: $type,)+ }

        impl Default for Scene {
            fn default() -> Self {
                Self { $($field: $default),+ }
            }
        }

        impl Scene {
            /// Calls `look` with the domain and the value of every given field, without the indirect calls of
            /// [`Parameter::ALL`].
            #[inline(always)]
            pub(super) fn for_each_given(&self, mut look: impl FnMut(Domain, f64)) {
                $(if let Some(value) = Option::from(self.$field) {
                    look(Domain::$domain, value);
                })+
            }
        }

        impl Parameter {
            /// Every field of [`Scene`]: first the eight factors of the papers, then the constants.
            pub const ALL: &'static [Self] = &[$(Self {
                name: stringify!($field),
                symbol: $symbol,
                unit: $unit,
                description: $description,
                domain: Domain::$domain,
                get: getter!($field $($in_force)?),
                set: |scene, value| scene.$field = value.into(),
            }),+];
        }
    };
}

macro_rules! getter {
    ($field:ident) => {
        |scene| scene.$field
    };
    ($field:ident $in_force:path) => {
        $in_force
    };
}

scene! {
/// Everything the physics depends on, in SI. The default is the nominal scene: a silicon cantilever
/// pushing a gold particle of 50 nm radius on silicon oxide.
///
/// [`Parameter::ALL`] lists the same fields with symbols, units and physical domains.
pub struct Scene {
    /// Cantilever length L (m).
    length: f64 = 225e-6, "L", "m", Positive, "cantilever length";
    /// Cantilever width w (m).
    width: f64 = 48e-6, "w", "m", Positive, "cantilever width";
    /// Cantilever thickness t (m).
    thickness: f64 = 1e-6, "t", "m", Positive, "cantilever thickness";
    /// Tip height H (m).
    height: f64 = 12e-6, "H", "m", Positive, "tip height";
    /// Substrate velocity V (m/s).
    velocity: f64 = 100e-9, "V", "m/s", NonNegative, "substrate velocity";
    /// Young's modulus of the cantilever, E (Pa).
    elastic_modulus: f64 = 169e9, "E", "Pa", Positive, "Young's modulus of the cantilever";
    /// Equivalent contact modulus K = (4/3) E*, of either contact (Pa).
    equivalent_modulus: f64 = 60e9, "K", "Pa", Positive, "equivalent contact modulus";
    /// Work of adhesion omega, of either contact (J/m2).
    adhesion: f64 = 0.2, "omega", "J/m2", NonNegative, "work of adhesion";
    /// Poisson ratio of the cantilever, nu.
    poisson_ratio: f64 = 0.27, "nu", "1", PoissonRatio, "Poisson ratio of the cantilever";
    /// Shear modulus of the cantilever, G (Pa); `None` means E/(2 (1 + nu)). The papers print 40.5 GPa.
    shear_modulus: Option<f64> = None => Scene::effective_shear_modulus,
        "G", "Pa", Positive, "shear modulus of the cantilever, E/(2 (1 + nu)) unless set";
    /// Density of cantilever and tip (kg/m3).
    probe_density: f64 = 2330.0, "rho", "kg/m3", Positive, "density of cantilever and tip";
    /// Radius of the tip cone at its base (m).
    tip_base_radius: f64 = 3e-6, "r", "m", Positive, "radius of the tip cone at its base";
    /// Particle radius R_p (m).
    particle_radius: f64 = 50e-9, "R_p", "m", Positive, "particle radius";
    /// Radius of the tip apex, R_t (m).
    tip_radius: f64 = 20e-9, "R_t", "m", Positive, "radius of the tip apex";
    /// Angle of the tip-particle contact from the vertical, phi (rad).
    contact_angle: f64 = 60_f64.to_radians(), "phi", "rad", AcuteAngle, "tip-particle contact angle from the vertical";
    /// Preload angle phi0; the preload deflection is L sin(phi0) (rad).
    preload_angle: f64 = 0.7_f64.to_radians(), "phi0", "rad", AcuteAngle, "preload angle";
    /// Coefficient of static friction, mu_s.
    static_friction: f64 = 0.8, "mu_s", "1", NonNegative, "coefficient of static friction";
    /// Coefficient of dynamic friction, mu_d. May exceed mu_s (friction that rises with velocity).
    dynamic_friction: f64 = 0.7, "mu_d", "1", NonNegative, "coefficient of dynamic friction";
    /// Interfacial shear strength tau (Pa). Tafazzoli & Sitti 2004 print 28 N/m2 and mean N/mm2.
    shear_strength: f64 = 28e6, "tau", "Pa", NonNegative, "interfacial shear strength";
    /// Shear modulus of the particle, G1 (Pa).
    particle_shear_modulus: f64 = 27e9, "G1", "Pa", Positive, "shear modulus of the particle";
    /// Shear modulus of the substrate, G2 (Pa).
    substrate_shear_modulus: f64 = 31.2e9, "G2", "Pa", Positive, "shear modulus of the substrate";
    /// Burgers vector b (m).
    burgers_vector: f64 = 0.288e-9, "b", "m", Positive, "Burgers vector";
    /// Density of the particle (kg/m3).
    particle_density: f64 = 19300.0, "rho_p", "kg/m3", Positive, "density of the particle";
    /// LuGre bristle stiffness sigma0 (N/m).
    bristle_stiffness: f64 = 625.0, "sigma0", "N/m", Positive, "LuGre bristle stiffness";
    /// LuGre bristle damping sigma1 (N s/m).
    bristle_damping: f64 = 1.6e-7, "sigma1", "N s/m", NonNegative, "LuGre bristle damping";
    /// LuGre viscous friction sigma2 (N s/m).
    viscous_friction: f64 = 1e-7, "sigma2", "N s/m", NonNegative, "LuGre viscous friction";
    /// Stribeck velocity v_s (m/s).
    stribeck_velocity: f64 = 1e-3, "v_s", "m/s", Positive, "Stribeck velocity";
    /// Equilibrium separation of the surfaces, z0 (m).
    equilibrium_separation: f64 = 0.2e-9, "z0", "m", Positive, "equilibrium separation of the surfaces";
    /// Hardness of the particle (Pa).
    hardness: f64 = 3.7e9, "p_Y", "Pa", Positive, "hardness of the particle";
    /// Poisson ratio of the particle, nu1. For LuGre friction with the parameters of the contact. Gold: 0.42.
    particle_poisson_ratio: f64 = 0.42, "nu1", "1", PoissonRatio, "Poisson ratio of the particle";
    /// Poisson ratio of the substrate, nu2, likewise. Fused silica: 0.17.
    substrate_poisson_ratio: f64 = 0.17, "nu2", "1", PoissonRatio, "Poisson ratio of the substrate";
    /// Exponent alpha of Dahl's law, 1 in most uses: LuGre friction without damping at constant strength.
    dahl_exponent: f64 = 1.0, "alpha_D", "1", Positive, "exponent of Dahl's law";
    /// Exponent d_s of the classical Stribeck curve. 2, as in LuGre friction.
    stribeck_exponent: f64 = 2.0, "d_s", "1", Positive, "exponent of the classical Stribeck curve";
    /// Coefficient of static friction of a contact that has just come to rest, of Armstrong's law: F_C + F_S,a = mu_a
    /// N. No paper prints one for this contact: midway between mu_d and mu_s.
    fresh_friction: f64 = 0.75, "mu_a", "1", NonNegative, "coefficient of static friction just after coming to rest";
    /// Time gamma (s) in which Armstrong's static friction rises halfway from fresh to old. Chosen: the order of
    /// magnitude of Armstrong-Helouvry, Dupont & Canudas de Wit 1994.
    dwell_constant: f64 = 1.0, "gamma", "s", Positive, "time in which static friction rises halfway (Armstrong)";
    /// Time at rest before the substrate moves (s), which Armstrong's static friction remembers.
    rest_time: f64 = 0.0, "t_r", "s", NonNegative, "time at rest before the substrate moves (Armstrong)";
    /// Frictional lag tau_l of Armstrong's law (s): sliding friction depends on the velocity one lag before.
    frictional_lag: f64 = 1e-3, "tau_l", "s", NonNegative, "frictional lag (Armstrong)";
    /// Half the thickness of the Lemaitre-Carlson layer, h (m). Chosen: two nanometres of lubricant in all.
    layer_half_thickness: f64 = 1e-9, "h", "m", Positive, "half the layer thickness (Lemaitre-Carlson)";
    /// Shear modulus of that layer, mu (Pa). Chosen: a glassy molecular film.
    layer_modulus: f64 = 1e9, "mu", "Pa", Positive, "shear modulus of the layer (Lemaitre-Carlson)";
    /// Stress scale of its rearrangements, mubar (Pa). Chosen with the four rates below so that the layer slides
    /// steadily near the shear strength of 28 MPa at 100 nm/s, weakens with velocity and ages.
    layer_stress: f64 = 10e6, "mubar", "Pa", Positive, "stress scale of rearrangements (Lemaitre-Carlson)";
    /// Rate E0 of its rearrangements (1/s).
    rearrangement_rate: f64 = 1e5, "E0", "1/s", Positive, "rate of rearrangements (Lemaitre-Carlson)";
    /// Rate E1 of its ageing (1/s).
    ageing_rate: f64 = 1.8e3, "E1", "1/s", Positive, "rate of ageing (Lemaitre-Carlson)";
    /// Barrier kappa of ageing, in units of that of rearrangements.
    ageing_barrier: f64 = 0.5, "kappa", "1", Positive, "barrier of ageing (Lemaitre-Carlson)";
    /// Disorder made by plastic work, alpha (1/Pa).
    disorder_gain: f64 = 1e-8, "alpha", "1/Pa", Positive, "disorder made by plastic work (Lemaitre-Carlson)";
    /// Disorder chi at the start; smaller is older.
    initial_disorder: f64 = 0.06, "chi0", "1", Positive, "disorder at the start (Lemaitre-Carlson)";
    /// Mass of the tip, m (kg); `None` means a cone, rho pi r^2 H/3.
    tip_mass: Option<f64> = None => Scene::effective_tip_mass,
        "m", "kg", Positive, "mass of the tip, that of a cone unless set";
    /// Moment of inertia of the tip about an axis across it through its centre of mass, I_c (kg m2); `None` means a
    /// cone of the effective mass, m (3/80) (4 r^2 + H^2).
    tip_inertia: Option<f64> = None => Scene::effective_tip_inertia,
        "I_c", "kg m2", Positive, "moment of inertia of the tip about its centre of mass, that of a cone unless set";
}
}

impl Scene {
    /// Returns the effective shear modulus of the cantilever (Pa): the given one, else E/(2 (1 + nu)).
    #[inline(always)]
    pub fn effective_shear_modulus(&self) -> f64 {
        match self.shear_modulus {
            Some(given) => given,
            None => self.elastic_modulus / (2.0 * (1.0 + self.poisson_ratio)),
        }
    }

    /// Returns the effective mass of the tip (kg): the given one, else that of a cone.
    #[inline(always)]
    pub fn effective_tip_mass(&self) -> f64 {
        let &Self { probe_density, tip_base_radius: r, height, .. } = self;
        self.tip_mass.unwrap_or(probe_density * std::f64::consts::PI * r * r * height / 3.0)
    }

    /// Returns the effective moment of inertia of the tip about its centre of mass (kg m2): the given one, or a cone's.
    #[inline(always)]
    pub fn effective_tip_inertia(&self) -> f64 {
        let &Self { tip_base_radius: r, height, .. } = self;
        self.tip_inertia.unwrap_or(self.effective_tip_mass() * (3.0 / 80.0) * (4.0 * r * r + height * height))
    }
}

#[cfg(test)]
#[path = "tests/scene.rs"]
mod tests;
