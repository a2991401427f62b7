//! The fields of a [`Scene`] as a table, for whoever sets them by name, and the check that each lies in its domain.

use super::{Failure, Scene};
use crate::quantity::Domain;

/// One parameter of a [`Scene`].
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Name of the field, as a study file writes it.
    pub name: &'static str,
    /// Symbol in the papers, in plain letters.
    pub symbol: &'static str,
    /// Symbol of the SI unit; `1` for a pure number.
    pub unit: &'static str,
    /// What it is, in a few words.
    pub description: &'static str,
    /// Where it is physical.
    pub domain: Domain,
    /// Reads it (SI). For those with a derived value the one in force, given or derived.
    pub get: fn(&Scene) -> f64,
    /// Sets it (SI), without looking at the domain. Setting one with a derived value cuts its tie to the others.
    pub set: fn(&mut Scene, f64),
}

macro_rules! parameter {
    ($field:ident, $symbol:literal, $unit:literal, $domain:ident, $description:literal) => {
        Parameter {
            name: stringify!($field),
            symbol: $symbol,
            unit: $unit,
            description: $description,
            domain: Domain::$domain,
            get: |scene| scene.$field,
            set: |scene, value| scene.$field = value,
        }
    };
}

impl Parameter {
    /// Every field of [`Scene`]: first the eight factors of the papers, then the constants.
    pub const ALL: &'static [Self] = &[
        parameter!(length, "L", "m", Positive, "cantilever length"),
        parameter!(width, "w", "m", Positive, "cantilever width"),
        parameter!(thickness, "t", "m", Positive, "cantilever thickness"),
        parameter!(height, "H", "m", Positive, "tip height"),
        parameter!(velocity, "V", "m/s", NonNegative, "substrate velocity"),
        parameter!(elastic_modulus, "E", "Pa", Positive, "Young's modulus of the cantilever"),
        parameter!(equivalent_modulus, "K", "Pa", Positive, "equivalent contact modulus"),
        parameter!(adhesion, "omega", "J/m2", NonNegative, "work of adhesion"),
        parameter!(poisson_ratio, "nu", "1", PoissonRatio, "Poisson ratio of the cantilever"),
        Self {
            name: "shear_modulus",
            symbol: "G",
            unit: "Pa",
            description: "shear modulus of the cantilever, E/(2 (1 + nu)) unless set",
            domain: Domain::Positive,
            get: Scene::effective_shear_modulus,
            set: |scene, value| scene.shear_modulus = Some(value),
        },
        parameter!(probe_density, "rho", "kg/m3", Positive, "density of cantilever and tip"),
        parameter!(tip_base_radius, "r", "m", Positive, "radius of the tip cone at its base"),
        parameter!(particle_radius, "R_p", "m", Positive, "particle radius"),
        parameter!(tip_radius, "R_t", "m", Positive, "radius of the tip apex"),
        parameter!(contact_angle, "phi", "rad", AcuteAngle, "tip-particle contact angle from the vertical"),
        parameter!(preload_angle, "phi0", "rad", AcuteAngle, "preload angle"),
        parameter!(static_friction, "mu_s", "1", NonNegative, "coefficient of static friction"),
        parameter!(dynamic_friction, "mu_d", "1", NonNegative, "coefficient of dynamic friction"),
        parameter!(shear_strength, "tau", "Pa", NonNegative, "interfacial shear strength"),
        parameter!(particle_shear_modulus, "G1", "Pa", Positive, "shear modulus of the particle"),
        parameter!(substrate_shear_modulus, "G2", "Pa", Positive, "shear modulus of the substrate"),
        parameter!(burgers_vector, "b", "m", Positive, "Burgers vector"),
        parameter!(particle_density, "rho_p", "kg/m3", Positive, "density of the particle"),
        parameter!(bristle_stiffness, "sigma0", "N/m", Positive, "LuGre bristle stiffness"),
        parameter!(bristle_damping, "sigma1", "N s/m", NonNegative, "LuGre bristle damping"),
        parameter!(viscous_friction, "sigma2", "N s/m", NonNegative, "LuGre viscous friction"),
        parameter!(stribeck_velocity, "v_s", "m/s", Positive, "Stribeck velocity"),
        parameter!(equilibrium_separation, "z0", "m", Positive, "equilibrium separation of the surfaces"),
        parameter!(hardness, "p_Y", "Pa", Positive, "hardness of the particle"),
        parameter!(particle_poisson_ratio, "nu1", "1", PoissonRatio, "Poisson ratio of the particle"),
        parameter!(substrate_poisson_ratio, "nu2", "1", PoissonRatio, "Poisson ratio of the substrate"),
        parameter!(dahl_exponent, "alpha_D", "1", Positive, "exponent of Dahl's law"),
        parameter!(stribeck_exponent, "d_s", "1", Positive, "exponent of the classical Stribeck curve"),
        parameter!(
            fresh_friction,
            "mu_a",
            "1",
            NonNegative,
            "coefficient of static friction just after coming to rest"
        ),
        parameter!(dwell_constant, "gamma", "s", Positive, "time in which static friction rises halfway (Armstrong)"),
        parameter!(rest_time, "t_r", "s", NonNegative, "time at rest before the substrate moves (Armstrong)"),
        parameter!(frictional_lag, "tau_l", "s", NonNegative, "frictional lag (Armstrong)"),
        parameter!(layer_half_thickness, "h", "m", Positive, "half the layer thickness (Lemaitre-Carlson)"),
        parameter!(layer_modulus, "mu", "Pa", Positive, "shear modulus of the layer (Lemaitre-Carlson)"),
        parameter!(layer_stress, "mubar", "Pa", Positive, "stress scale of rearrangements (Lemaitre-Carlson)"),
        parameter!(rearrangement_rate, "E0", "1/s", Positive, "rate of rearrangements (Lemaitre-Carlson)"),
        parameter!(ageing_rate, "E1", "1/s", Positive, "rate of ageing (Lemaitre-Carlson)"),
        parameter!(ageing_barrier, "kappa", "1", Positive, "barrier of ageing (Lemaitre-Carlson)"),
        parameter!(disorder_gain, "alpha", "1/Pa", Positive, "disorder made by plastic work (Lemaitre-Carlson)"),
        parameter!(initial_disorder, "chi0", "1", Positive, "disorder at the start (Lemaitre-Carlson)"),
        Self {
            name: "tip_mass",
            symbol: "m",
            unit: "kg",
            description: "mass of the tip, that of a cone unless set",
            domain: Domain::Positive,
            get: Scene::effective_tip_mass,
            set: |scene, value| scene.tip_mass = Some(value),
        },
        Self {
            name: "tip_inertia",
            symbol: "I_c",
            unit: "kg m2",
            description: "moment of inertia of the tip about its centre of mass, that of a cone unless set",
            domain: Domain::Positive,
            get: Scene::effective_tip_inertia,
            set: |scene, value| scene.tip_inertia = Some(value),
        },
    ];

    /// The parameter of that name, if there is one.
    pub fn from_name(name: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|parameter| parameter.name == name)
    }
}

impl Scene {
    /// Whether every parameter lies in its physical domain.
    ///
    /// # Errors
    /// [`Failure::OutOfDomain`] names the first parameter of [`Parameter::ALL`] that does not.
    #[inline]
    pub fn check(&self) -> Result<(), Failure> {
        if self.looks_physical() { Ok(()) } else { self.look_closely() }
    }

    /// A digest of the domains in [`Parameter::ALL`] without its indirect calls, for the hot path.
    #[inline]
    fn looks_physical(&self) -> bool {
        let positive = [
            self.length,
            self.width,
            self.thickness,
            self.height,
            self.elastic_modulus,
            self.equivalent_modulus,
            self.effective_shear_modulus(),
            self.probe_density,
            self.tip_base_radius,
            self.particle_radius,
            self.tip_radius,
            self.particle_shear_modulus,
            self.substrate_shear_modulus,
            self.burgers_vector,
            self.particle_density,
            self.bristle_stiffness,
            self.stribeck_velocity,
            self.equilibrium_separation,
            self.hardness,
            self.dahl_exponent,
            self.stribeck_exponent,
            self.dwell_constant,
            self.layer_half_thickness,
            self.layer_modulus,
            self.layer_stress,
            self.rearrangement_rate,
            self.ageing_rate,
            self.ageing_barrier,
            self.disorder_gain,
            self.initial_disorder,
            self.tip_mass.unwrap_or(1.0),
            self.tip_inertia.unwrap_or(1.0),
        ];
        let not_negative = [
            self.velocity,
            self.adhesion,
            self.static_friction,
            self.dynamic_friction,
            self.shear_strength,
            self.bristle_damping,
            self.viscous_friction,
            self.fresh_friction,
            self.rest_time,
            self.frictional_lag,
        ];
        use Domain::{AcuteAngle, PoissonRatio};
        // As integers the positive finite numbers are one range, so that one comparison of the largest does for all.
        let positive = positive.iter().fold(0, |largest, value| value.to_bits().wrapping_sub(1).max(largest));
        // Adding zero makes minus zero zero.
        let not_negative = not_negative.iter().fold(0, |largest, value| (value + 0.0).to_bits().max(largest));
        (positive < f64::MAX.to_bits())
            & (not_negative <= f64::MAX.to_bits())
            & AcuteAngle.contains(self.contact_angle)
            & AcuteAngle.contains(self.preload_angle)
            & PoissonRatio.contains(self.poisson_ratio)
            & PoissonRatio.contains(self.particle_poisson_ratio)
            & PoissonRatio.contains(self.substrate_poisson_ratio)
    }

    #[cold]
    fn look_closely(&self) -> Result<(), Failure> {
        match Parameter::ALL.iter().find(|parameter| !parameter.domain.contains((parameter.get)(self))) {
            Some(culprit) => Err(Failure::OutOfDomain { parameter: culprit.name, domain: culprit.domain }),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn the_main_factors_come_first() {
        let symbols: Vec<_> = Parameter::ALL[..8].iter().map(|parameter| parameter.symbol).collect();
        assert_eq!(symbols, ["L", "w", "t", "H", "V", "E", "K", "omega"]);
    }

    #[test]
    fn names_and_symbols_are_unique() {
        let names: HashSet<_> = Parameter::ALL.iter().map(|parameter| parameter.name).collect();
        let symbols: HashSet<_> = Parameter::ALL.iter().map(|parameter| parameter.symbol).collect();
        assert_eq!((names.len(), symbols.len()), (Parameter::ALL.len(), Parameter::ALL.len()));
    }

    #[test]
    fn set_then_get_gives_the_value_back_and_moves_nothing_else() {
        // Those with a derived value are fixed first, since unset they follow others.
        let before =
            Scene { shear_modulus: Some(1.0), tip_mass: Some(1.0), tip_inertia: Some(1.0), ..Scene::default() };
        for parameter in Parameter::ALL {
            let mut scene = before;
            (parameter.set)(&mut scene, 0.123);
            let moved: Vec<_> =
                Parameter::ALL.iter().filter(|p| (p.get)(&scene) != (p.get)(&before)).map(|p| p.name).collect();
            assert_eq!(moved, [parameter.name]);
            assert_eq!((parameter.get)(&scene), 0.123);
        }
    }

    /// The table covers the struct: every field of `Scene` is eight bytes, but for the three
    /// optional ones of sixteen.
    #[test]
    fn no_field_is_missing() {
        assert_eq!(size_of::<Scene>(), 8 * (Parameter::ALL.len() + 3));
    }

    #[test]
    fn defaults_are_physical() {
        for parameter in Parameter::ALL {
            assert!(parameter.domain.contains((parameter.get)(&Scene::default())), "{}", parameter.name);
        }
    }

    /// Each parameter alone, set to each value outside its domain: this also proves that the digest
    /// covers the table.
    #[test]
    fn every_parameter_is_checked_and_named() {
        for parameter in Parameter::ALL {
            let outside = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 0.6, 2.0];
            for value in outside.into_iter().filter(|&value| !parameter.domain.contains(value)) {
                let mut scene = Scene::default();
                (parameter.set)(&mut scene, value);
                let expected = Failure::OutOfDomain { parameter: parameter.name, domain: parameter.domain };
                assert_eq!(scene.check(), Err(expected), "{} = {value}", parameter.name);
            }
        }
    }

    #[test]
    fn nothing_inside_a_domain_is_refused() {
        for parameter in Parameter::ALL {
            for value in [0.0, 1e-300, 0.4, 0.5, 1.5, 1e300].into_iter().filter(|&v| parameter.domain.contains(v)) {
                let mut scene =
                    Scene { shear_modulus: Some(1.0), tip_mass: Some(1.0), tip_inertia: Some(1.0), ..Scene::default() };
                (parameter.set)(&mut scene, value);
                assert_eq!(scene.check(), Ok(()), "{} = {value}", parameter.name);
            }
        }
    }
}
