//! The hold on the particle: contact and friction on the substrate under a normal force.

use crate::contact::{Contact, Pair};
use crate::friction::{Drive, LemaitreCarlson, LuGreForm, Pressed, Stribeck};
use crate::probe::Probe;
use crate::{Failure, FrictionLaw, Options, Scene};

/// The substrate contact of a scene under any normal force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Substrate<'a> {
    pub scene: &'a Scene,
    pub options: &'a Options,
    pub pair: Pair,
    /// Contribution of adhesion to the load of friction (N).
    pub adhesive_load: f64,
    /// Contribution of adhesion to the load that holds the particle down (N): the same, or the pull-off force for laws
    /// that depend on the area of contact. Minus it is the least normal force.
    pub support: f64,
    pub drive: Drive,
}

/// The contact and its friction under one normal force.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hold {
    pub contact: Contact,
    /// F_Y* (N).
    pub capacity: f64,
    pub evaluations: u64,
}

impl<'a> Substrate<'a> {
    #[inline]
    pub fn new(scene: &'a Scene, options: &'a Options, probe: &Probe, form: LuGreForm) -> Self {
        let pair = Pair::substrate(scene);
        let (adhesive_load, support) = adhesion(options, &pair);
        // With longer steps a Lemaitre-Carlson layer that is sheared slowly loses a tenth of its first peak.
        let coarsest = if options.friction == FrictionLaw::LemaitreCarlson { 1e-6 } else { f64::INFINITY };
        let drive = Drive {
            lugre: options.lugre,
            form,
            // The errors of the laws are small compared with the tolerance of a run.
            tolerance: (0.01 * options.tolerance).max(1e-10).min(coarsest),
            step_budget: options.step_budget,
            ..Drive::from_scene(scene, probe.apex)
        };
        Self { scene, options, pair, adhesive_load, support, drive }
    }

    /// Returns only the contact under `normal_force` (N).
    #[inline]
    pub fn contact(&self, normal_force: f64) -> Result<Contact, Failure> {
        self.options.contact.contact(&self.pair, normal_force)
    }

    /// Returns contact and friction under `normal_force` (N).
    #[inline]
    pub(super) fn hold(&self, normal_force: f64) -> Result<Hold, Failure> {
        let contact = self.contact(normal_force)?;
        let pressed = Pressed { load: normal_force + self.adhesive_load, radius: contact.radius };
        let held = self.options.friction.capacity(self.scene, pressed, &self.drive)?;
        Ok(Hold { contact, capacity: held.force, evaluations: 1 + held.evaluations })
    }

    /// Returns the relative error that the law of friction may add to a capacity.
    pub fn error(&self) -> f64 {
        match self.options.friction {
            FrictionLaw::LuGre => self.drive.near_steady(),
            // Computed by a search: up to 1.1 times the tolerance of a step.
            FrictionLaw::LemaitreCarlson => 2.0 * self.drive.tolerance,
            _ => 0.0,
        }
    }

    /// Returns the stiffness (N/m) of a spring that is stretched as far as a Lemaitre-Carlson layer on a contact of
    /// `radius` (m) is sheared when its force is `force` (N).
    ///
    /// # Errors
    /// Those of the integration.
    pub fn layer_stiffness(&self, radius: f64, force: f64) -> Result<f64, Failure> {
        let travel = LemaitreCarlson(self.scene).travel(radius, force, &self.drive)?;
        // At least the value that rounding leaves of a layer far stiffer than the spring.
        let sheared = (travel - force / self.drive.stiffness).max(f64::EPSILON * travel);
        Ok(force / sheared)
    }

    /// Returns a bound of the relative error of the time of slip at these forces (N) under Stribeck friction if viscosity
    /// raises it above its value at rest: from there on the particle moves, and the force only approaches its peak.
    pub fn viscous_rise(&self, normal_force: f64, lateral_force: f64) -> f64 {
        if self.options.friction != FrictionLaw::Stribeck {
            return 0.0;
        }
        let at_rest = Stribeck(self.scene).force(normal_force + self.adhesive_load, 0.0);
        10.0 * (1.0 - at_rest / lateral_force).max(0.0)
    }

    /// Returns a bound of dF_Y*/dF_Z at a `normal_force` (N) where friction holds `capacity` (N), for estimates: in
    /// proportion to the load of friction, or to that of the contact for laws that depend on its area (a^2 grows at
    /// most as (F_Z + F_ad)^(2/3) by every theory of contact).
    #[inline(always)]
    pub fn slope(&self, capacity: f64, normal_force: f64) -> f64 {
        let law = self.options.friction;
        let of_load = if law == FrictionLaw::Coulomb { self.scene.static_friction } else { 0.0 };
        // Viscous friction does not depend on the load.
        let viscous = if law == FrictionLaw::LuGre { self.scene.viscous_friction * self.scene.velocity } else { 0.0 };
        // A contact that is loaded longer ages longer.
        let ageing = if law == FrictionLaw::Armstrong { 1.05 } else { 1.0 };
        let of_area = (capacity - viscous - of_load * (normal_force + self.adhesive_load)).max(0.0);
        of_load + if of_area > 0.0 { ageing * of_area / (normal_force + self.support) } else { 0.0 }
    }
}

/// Returns the contributions of adhesion to the load of friction, and to that which holds the particle down (N).
#[inline(always)]
pub(super) fn adhesion(options: &Options, pair: &Pair) -> (f64, f64) {
    let on_area = options.friction.lives_on_area();
    let pull_off = if on_area || options.adhesion_in_load { options.contact.pull_off(pair) } else { 0.0 };
    let adhesive_load = if options.adhesion_in_load { pull_off } else { 0.0 };
    (adhesive_load, if on_area { pull_off } else { adhesive_load })
}
