//! Small twist, no inertia: the normal force stays that of the preload, and the tip is a linear
//! spring.

use std::f64::consts::PI;

use super::{Critical, Options};
use crate::afm::contact::{Contact, Pair};
use crate::afm::friction::{LuGre, Pressed};
use crate::afm::probe::Probe;
use crate::afm::{Failure, Flag, Flags, FrictionLaw, Scene};

/// F_Z = F_Z0, F_Y* by the law of friction, s = F_Y*/k_lat, theta = F_Y* H/K_theta.
#[inline]
pub(super) fn critical_force(scene: &Scene, options: &Options) -> Result<Critical, Failure> {
    let probe = Probe::new(scene, options.torsion);
    let normal_force = probe.preload_force;
    let pair = Pair {
        radius: scene.particle_radius,
        modulus: scene.equivalent_modulus,
        adhesion: scene.adhesion,
        separation: scene.equilibrium_separation,
    };
    let contact = options.contact.contact(&pair, normal_force)?;
    let adhesive_load = if options.adhesion_in_load { options.contact.pull_off(&pair) } else { 0.0 };
    let pressed = Pressed { load: normal_force + adhesive_load, radius: contact.radius };
    let lateral_force = options.friction.capacity(scene, pressed);
    let travel = lateral_force / probe.apex;
    let twist = lateral_force * scene.height / probe.torsional;
    Ok(Critical {
        normal_force,
        lateral_force,
        critical_force: normal_force.hypot(lateral_force),
        force_angle: lateral_force.atan2(normal_force),
        travel,
        critical_time: critical_time(travel, scene.velocity),
        contact_radius: contact.radius,
        indentation: contact.indentation,
        twist,
        flags: flags(scene, options, &pair, contact)
            .with(Flag::AboveHardness, normal_force > scene.hardness * (PI * contact.radius * contact.radius))
            .with(Flag::LargeTwist, twist > 0.1),
    })
}

/// The flags that need no force.
#[inline]
fn flags(scene: &Scene, options: &Options, pair: &Pair, contact: Contact) -> Flags {
    let fast = options.friction == FrictionLaw::LuGre && !LuGre::of(scene).is_slow(scene.velocity);
    // Without adhesion every theory is Hertz, whatever the Tabor parameter.
    let unsuited = pair.adhesion > 0.0 && !options.contact.suits(pair.tabor());
    Flags::NONE
        .with(Flag::LargeContact, contact.radius > 0.3 * pair.radius)
        .with(Flag::TaborOutOfRange, unsuited)
        .with(Flag::FastLuGreForm, fast)
}

/// s/V.
#[inline]
fn critical_time(travel: f64, velocity: f64) -> Result<f64, Failure> {
    if velocity == 0.0 {
        return Err(Failure::VelocityZero);
    }
    let time = travel / velocity;
    if time.is_finite() { Ok(time) } else { Err(Failure::NotFinite { quantity: "critical_time" }) }
}
