//! The lowest rung that is accurate enough.

use super::{Critical, Options, closed_form, dynamic, quasi_static};
use crate::{Failure, Scene};

/// Tries the rungs from the closed form up until an error estimate meets the tolerance, or no higher rung is better;
/// the cost includes all of them. A failure of a rung is returned: a lower one could not compute more.
pub(super) fn critical_force(scene: &Scene, options: &Options) -> Result<Critical, Failure> {
    let closed = closed_form::critical_force(scene, options)?;
    if closed.error_estimate <= options.tolerance {
        return Ok(closed);
    }
    let spent = closed.evaluations;
    let (exact, shared) = quasi_static::critical_force(scene, options, options.accurate_time)?;
    // At rest there are no dynamics.
    let best = exact.error_estimate <= options.tolerance + shared || scene.velocity == 0.0;
    let (refined, spent) =
        if best { (exact, spent) } else { (dynamic::critical_force(scene, options)?, spent + exact.evaluations) };
    Ok(Critical { evaluations: spent + refined.evaluations, ..refined })
}
