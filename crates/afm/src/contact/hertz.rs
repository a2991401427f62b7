//! Hertz 1881: elastic contact without adhesion.

use super::{Contact, Pair};
use crate::Failure;
use crate::cube_root::cube_root;

/// Returns a^3 = R F/K, d = a^2/R. Adhesion is ignored.
///
/// Valid for a well below R, and if the load is far above every adhesive force.
#[inline]
pub(super) fn contact(pair: &Pair, load: f64) -> Result<Contact, Failure> {
    if load < 0.0 {
        return Err(Failure::BeyondPullOff);
    }
    let radius = radius(pair, load);
    Ok(Contact { radius, indentation: radius * radius / pair.radius })
}

/// Returns the radius alone (m), of a load >= 0.
#[inline]
pub(super) fn radius(pair: &Pair, load: f64) -> f64 {
    cube_root(pair.radius / pair.modulus * load)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAIR: Pair = Pair { radius: 50e-9, modulus: 60e9, adhesion: 0.2, separation: 0.2e-9 };

    /// By hand: R F/K = 50e-9 * 4.8e-7/60e9 = 4e-25 m^3, and (4e-25)^(1/3) = 7.3680630 nm.
    #[test]
    fn by_hand() {
        let contact = contact(&PAIR, 4.8e-7).unwrap();
        assert!((contact.radius / 7.368_063_0e-9 - 1.0).abs() < 1e-8);
        assert!((contact.indentation / 1.085_767_1e-9 - 1.0).abs() < 1e-7);
    }
}
