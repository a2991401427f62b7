//! Maugis 1992, "Adhesion of spheres: the JKR-DMT transition using a Dugdale model".

use super::dugdale::Zone;
use super::{Contact, Pair, dmt, hertz, jkr};
use crate::Failure;

/// Lambda up to which DMT is exact to a rounding error: the indentation differs by a share of sqrt(lambda).
const STIFF: f64 = 1e-36;
/// Lambda from which JKR is exact to a rounding error: loads and radii differ by a share of 1/lambda^2.
const STICKY: f64 = 1e9;
/// Pbar from which adhesion, with a share of 1/sqrt(Pbar), is less than a rounding error.
const HEAVY: f64 = 1e34;
/// Pbar + 2 below which pull-off may be near: it is between 0 (DMT) and 1/2 (JKR).
const NEAR_PULL_OFF: f64 = 0.6;

/// With abar = a/(pi w R^2/K)^(1/3), Pbar = F/(pi w R), m the outer radius of the cohesive zone in units of a, and
/// lambda = [1.157 mu_T](Pair::transition):
///
/// (lambda abar^2/2) (s + (m^2 - 2) atan s) + (4 lambda^2 abar/3) (s atan s - m + 1) = 1, s = sqrt(m^2 - 1),
/// Pbar = abar^3 - lambda abar^2 (s + m^2 atan s), d = (abar^2 - (4/3) lambda abar s) (pi^2 w^2 R/K^2)^(1/3),
///
/// on the branch that is stable under a given load. Valid for every Tabor parameter; tends to DMT for small ones and to
/// JKR for large ones. Without adhesion this is Hertz, to the last bit.
pub(super) fn contact(pair: &Pair, load: f64) -> Result<Contact, Failure> {
    let lambda = pair.transition();
    if lambda <= STIFF {
        return dmt::contact(pair, load);
    }
    if lambda >= STICKY {
        return jkr::contact(pair, load);
    }
    let unit = pair.unit_load();
    if load >= HEAVY * unit {
        return hertz::contact(pair, load);
    }
    let lift = (load + 2.0 * unit) / unit;
    let last = if lift < NEAR_PULL_OFF { Some(Zone::at_pull_off(lambda)) } else { None };
    if last.is_some_and(|zone| load < -unit * (2.0 - zone.lift())) {
        return Err(Failure::BeyondPullOff);
    }
    let zone = Zone::at_lift(lambda, lift, last);
    let scale = pair.unit_radius();
    Ok(Contact {
        radius: zone.radius * scale,
        indentation: (zone.radius * zone.radius - zone.stretch()) * (scale * (scale / pair.radius)),
    })
}

/// Returns the least load over all contact radii, from 2 pi w R (stiff) to 1.5 pi w R (soft).
pub(super) fn pull_off(pair: &Pair) -> f64 {
    let lambda = pair.transition();
    if lambda <= STIFF {
        dmt::pull_off(pair)
    } else if lambda >= STICKY {
        jkr::pull_off(pair)
    } else {
        pair.unit_load() * (2.0 - Zone::at_pull_off(lambda).lift())
    }
}

/// Returns the indentation of a contact of this radius (m): a^2/R minus the stretch of the cohesive zone around it.
pub(super) fn indentation(pair: &Pair, radius: f64) -> f64 {
    let lambda = pair.transition();
    let scale = pair.unit_radius();
    let hertz = radius * radius / pair.radius;
    if lambda <= STIFF || radius * radius * radius >= HEAVY * (scale * scale * scale) {
        hertz
    } else if lambda >= STICKY {
        hertz - jkr::stretch(pair, radius)
    } else {
        hertz - Zone::at_radius(lambda, radius / scale).stretch() * (scale * (scale / pair.radius))
    }
}
