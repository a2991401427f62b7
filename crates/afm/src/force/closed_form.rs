//! Small twist, no inertia: the normal force is that of the preload, and the tip is a linear spring.

use super::presliding::Presliding;
use super::slip::{Error, Slip};
use super::substrate::Substrate;
use super::swing::Swing;
use super::{Critical, Options};
use crate::contact::Contact;
use crate::friction::{LuGre, LuGreForm};
use crate::probe::Probe;
use crate::{Failure, Fidelity, Flag, Flags, FrictionLaw, Scene};

/// Computes F_Z = F_Z0, F_Y* by the law of friction, s = F_Y*/k_lat, theta = F_Y* H/K_theta.
#[inline]
pub(super) fn critical_force(scene: &Scene, options: &Options) -> Result<Critical, Failure> {
    let probe = Probe::new(scene, options.torsion);
    let substrate = Substrate::new(scene, options, &probe, LuGreForm::Fast);
    let hold = substrate.hold(probe.preload_force)?;
    let slip = slip(&probe, scene.height, hold.capacity, hold.contact);
    let presliding = Presliding::new(&substrate, &slip, &probe, probe.apex)?;
    let slip = presliding.map_or(slip, |presliding| presliding.timed(&slip, probe.apex));
    let of_law = of_law(&substrate, probe.preload_force, hold.capacity);
    Ok(Critical {
        flags: flags(&slip, scene, options),
        error_estimate: error(&substrate, &probe, (&slip, presliding.as_ref()), of_law),
        evaluations: hold.evaluations,
        ..slip.critical(&substrate, Fidelity::ClosedForm)
    })
}

/// Returns the slip of a contact that holds `lateral_force` (N).
#[inline(always)]
pub(super) fn slip(probe: &Probe, height: f64, lateral_force: f64, contact: Contact) -> Slip {
    Slip {
        normal_force: probe.preload_force,
        lateral_force,
        travel: lateral_force / probe.apex,
        twist: lateral_force * height / probe.torsional,
        contact,
        advance: 0.0,
        slowdown: 1.0,
    }
}

/// Returns the possible error of `capacity` by the law itself (N): a LuGre ramp peaks between Fss(V), the fast form,
/// and the strength at rest; other laws are as accurate as their integration.
#[inline(always)]
pub(super) fn of_law(substrate: &Substrate, normal_force: f64, capacity: f64) -> f64 {
    if substrate.options.friction != FrictionLaw::LuGre {
        return capacity * substrate.error();
    }
    let law = LuGre::from_scene(substrate.scene);
    let load = normal_force + substrate.adhesive_load;
    (law.stribeck(load, 0.0) - law.stribeck(load, substrate.scene.velocity)).abs()
}

/// Returns the flags of the slip, and that of the fast form.
#[inline(always)]
pub(super) fn flags(slip: &Slip, scene: &Scene, options: &Options) -> Flags {
    let is_fast = !LuGre::from_scene(scene).is_slow(scene.velocity);
    let is_lugre = options.friction == FrictionLaw::LuGre;
    slip.flags(scene, options).with(Flag::FastLuGreForm, is_lugre & is_fast)
}

/// Returns the relative error of F_cr, and of the critical time if it matters.
#[inline(always)]
pub(super) fn error(
    substrate: &Substrate,
    probe: &Probe,
    (slip, presliding): (&Slip, Option<&Presliding>),
    of_law: f64,
) -> f64 {
    let of_forces = left_out(substrate, probe, slip, of_law).value(slip);
    if substrate.options.accurate_time {
        of_forces.max(time_error(substrate, probe, (slip, presliding), of_law))
    } else {
        of_forces
    }
}

/// Returns the errors of both forces by the neglected twist and swing of the tip, and by the [law](of_law).
#[inline(always)]
pub(super) fn left_out(substrate: &Substrate, probe: &Probe, slip: &Slip, of_law: f64) -> Error {
    let error = twisting(substrate, probe, slip) + Swing::new(substrate.scene, probe).left_out(slip, substrate);
    Error { lateral: error.lateral + of_law, ..error }
}

/// Returns the relative error of the critical time for the same reasons: the moment of the normal force turns the tip
/// further, so the substrate travels further until the slip.
#[cold]
fn time_error(
    substrate: &Substrate,
    probe: &Probe,
    (slip, presliding): (&Slip, Option<&Presliding>),
    of_law: f64,
) -> f64 {
    let height = substrate.scene.height;
    let twist = slip.lateral_force * height / (probe.torsional - slip.normal_force * height);
    let further = height * (twist - slip.twist + twist.powi(3)) / slip.travel;
    // Three times: bristles whose load falls meanwhile creep less, by up to twice that.
    let of_forces = 3.0 * (twisting(substrate, probe, slip).lateral + of_law) / slip.lateral_force;
    let of_creep = presliding.map_or(0.0, |presliding| presliding.error(slip))
        + substrate.viscous_rise(slip.normal_force, slip.lateral_force);
    let all = further.abs() + of_forces + of_creep + Swing::new(substrate.scene, probe).of_time(slip, substrate);
    if twist > 0.0 && all < 1.0 { all } else { 1.0 }
}

/// Returns the loss of normal force by the twist, K_z H (1 - cos theta), which the closed form neglects, and that of
/// friction; the twist itself is larger by the moment of the normal force.
#[inline(always)]
fn twisting(substrate: &Substrate, probe: &Probe, slip: &Slip) -> Error {
    let height = substrate.scene.height;
    let softened = probe.torsional - slip.normal_force * height;
    let twist = slip.lateral_force * height / softened;
    // A twentieth more, for the terms of higher order.
    let normal = 1.05 * 0.5 * probe.normal * height * twist * twist;
    // Otherwise it tips the probe over, or lifts the tip until nothing holds the particle down.
    let holds = (softened > 0.0) & (normal < slip.normal_force + substrate.support);
    let lateral = normal * substrate.slope(slip.lateral_force, slip.normal_force);
    Error { normal: if holds { normal } else { f64::INFINITY }, lateral: if holds { lateral } else { 0.0 } }
}
