//! The lowest rung that is accurate enough.

use super::slip::Slip;
use super::substrate::Substrate;
use super::swing::Swing;
use super::{Cost, Critical, Options, closed_form, dynamic, quasi_static};
use crate::afm::contact::Contact;
use crate::afm::friction::LuGreForm;
use crate::afm::probe::Probe;
use crate::afm::{Failure, FrictionLaw, Scene};

/// Climbs from the closed form until an error estimate meets the tolerance, or no higher rung does better; what the lower
/// rungs cost is counted too. A failure of a rung is the answer: a lower one is not more able.
pub(super) fn critical_force(scene: &Scene, options: &Options) -> Result<Critical, Failure> {
    let closed = closed_form::critical_force(scene, options)?;
    if closed.error_estimate <= options.tolerance {
        return Ok(closed);
    }
    let spent = closed.cost.evaluations;
    let exact = quasi_static::critical_force(scene, options)?;
    // At rest nothing is dynamic.
    let best =
        exact.error_estimate <= options.tolerance + left_to_dynamic(&exact, scene, options) || scene.velocity == 0.0;
    let (found, spent) =
        if best { (exact, spent) } else { (dynamic::critical_force(scene, options)?, spent + exact.cost.evaluations) };
    Ok(Critical { cost: Cost { evaluations: spent + found.cost.evaluations }, ..found })
}

/// The error that the dynamic rung has in common with the quasi-static one: on bristles neither follows the swing, unless it is slow,
/// nor what it shakes loose.
fn left_to_dynamic(exact: &Critical, scene: &Scene, options: &Options) -> f64 {
    if options.friction != FrictionLaw::LuGre {
        return 0.0;
    }
    let &Critical { normal_force, lateral_force, travel, twist, .. } = exact;
    let contact = Contact { radius: exact.contact_radius, indentation: exact.indentation };
    let probe = Probe::new(scene, options.torsion);
    let slip = Slip { normal_force, lateral_force, travel, twist, contact };
    let substrate = Substrate::new(scene, options, &probe, LuGreForm::Ramp);
    let swing = Swing::new(scene, &probe);
    let mut error = swing.left_out(&slip, &substrate);
    if !swing.is_followed(travel, scene.velocity) {
        error.lateral += quasi_static::overshoot(&slip, &substrate);
    }
    let of_time = if options.accurate_time { swing.of_time(&slip, &substrate) } else { 0.0 };
    error.of(&slip).max(of_time)
}
