//! The fields of a [`Scene`] by name, and the check that each is in its domain.

use apportion_base::quantity::Domain;

use super::{Failure, Scene};

/// One parameter of a [`Scene`].
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Name of the field, as in a study file.
    pub name: &'static str,
    /// Symbol in the papers, in plain letters.
    pub symbol: &'static str,
    /// Symbol of the SI unit; `1` for a pure number.
    pub unit: &'static str,
    /// Description in a few words.
    pub description: &'static str,
    /// Its physical domain.
    pub domain: Domain,
    /// Reads it (SI): the effective value, given or derived.
    pub get: fn(&Scene) -> f64,
    /// Sets it (SI), without checking the domain. A derived value is then independent of the other parameters.
    pub set: fn(&mut Scene, f64),
}

impl Parameter {
    /// Returns the parameter of that name, if there is one.
    pub fn from_name(name: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|parameter| parameter.name == name)
    }
}

impl Scene {
    /// Checks that every parameter is in its physical domain.
    ///
    /// # Errors
    /// [`Failure::OutOfDomain`] names the first parameter of [`Parameter::ALL`] that does not.
    #[inline]
    pub fn check(&self) -> Result<(), Failure> {
        let mut fit = Domain::Positive.contains(self.effective_shear_modulus());
        // All of them without early exit, which is quicker than to look for the first one that does not fit.
        self.for_each_given(|domain, value| fit &= domain.contains(value));
        if fit { Ok(()) } else { self.look_closely() }
    }

    #[cold]
    fn look_closely(&self) -> Result<(), Failure> {
        Parameter::ALL.iter().try_for_each(|one| Failure::unless_in(one.domain, one.name, (one.get)(self)))
    }
}

#[cfg(test)]
#[path = "tests/parameter.rs"]
mod tests;
