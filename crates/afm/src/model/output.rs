//! The outputs of the critical-force computation.

use apportion::model::Output;
use apportion_base::names::named;
use apportion_base::quantity::Unit;

use crate::force::{ClosedForms, Column, Slips};
use crate::{Critical, Failure};

named! {
/// An output of the critical-force computation, the default one first.
pub enum AfmOutput {
    /// F_cr, the tip force at which the particle slips.
    CriticalForce = "critical_force",
    /// F_Y, the lateral part of it.
    LateralForce = "lateral_force",
    /// F_Z, the normal part of it.
    NormalForce = "normal_force",
    /// t_cr, the time until it is reached.
    CriticalTime = "critical_time",
    /// ln F_cr, F_cr in newtons.
    LogCriticalForce = "log_critical_force",
    /// psi, the angle of the tip force from the vertical.
    ForceAngle = "force_angle",
    /// a, radius of the contact between particle and substrate.
    ContactRadius = "contact_radius",
    /// d_s, indentation of that contact.
    Indentation = "indentation",
}
}

impl AfmOutput {
    /// Returns its description as an output.
    pub fn info(self) -> Output {
        let (unit, description) = self.row();
        Output::new(self.name(), edge(unit), description)
    }

    /// Returns unit and description.
    fn row(self) -> (&'static str, &'static str) {
        match self {
            Self::CriticalForce => ("nN", "tip force F_cr at which the particle slips"),
            Self::LateralForce => ("nN", "lateral part F_Y of the critical force"),
            Self::NormalForce => ("nN", "normal part F_Z of the critical force"),
            Self::CriticalTime => ("s", "time t_cr until the particle slips; none at velocity 0"),
            Self::LogCriticalForce => ("1", "natural logarithm of the critical force in newtons"),
            Self::ForceAngle => ("rad", "angle psi of the critical force from the vertical"),
            Self::ContactRadius => ("nm", "radius a of the contact between particle and substrate"),
            Self::Indentation => ("nm", "indentation d_s of the contact between particle and substrate"),
        }
    }

    /// Returns the values of scenes solved at once in SI units, if available.
    pub(super) fn column(self, slips: &Slips) -> Option<&Column> {
        match self {
            Self::CriticalForce => Some(&slips.critical_force),
            Self::LateralForce => Some(&slips.lateral_force),
            Self::NormalForce => Some(&slips.normal_force),
            Self::ContactRadius => Some(&slips.contact_radius),
            Self::CriticalTime | Self::LogCriticalForce | Self::ForceAngle | Self::Indentation => None,
        }
    }

    /// Returns the value of scene number `i` of those solved at once.
    pub(super) fn of_many(self, i: usize, forms: &ClosedForms) -> Result<f64, Failure> {
        let slips = forms.slips();
        match self {
            Self::CriticalTime => forms.critical_time(i),
            Self::LogCriticalForce => Ok(libm::log(slips.critical_force[i])),
            Self::ForceAngle => Ok(libm::atan2(slips.lateral_force[i], slips.normal_force[i])),
            Self::Indentation => forms.indentation(i),
            other => Ok(other.column(slips).map_or(f64::NAN, |column| column[i])),
        }
    }

    /// Returns the value in SI units.
    pub fn value(self, critical: &Critical) -> Result<f64, Failure> {
        Ok(match self {
            Self::CriticalForce => critical.critical_force,
            Self::LateralForce => critical.lateral_force,
            Self::NormalForce => critical.normal_force,
            Self::CriticalTime => critical.critical_time?,
            Self::LogCriticalForce => libm::log(critical.critical_force),
            Self::ForceAngle => critical.force_angle(),
            Self::ContactRadius => critical.contact_radius,
            Self::Indentation => critical.indentation,
        })
    }
}

/// Parses a unit of this program, all of which are known: tests cover them.
pub(super) fn edge(symbol: &str) -> Unit {
    Unit::parse(symbol).unwrap_or_else(|_| Unit::dimensionless())
}

#[cfg(test)]
#[path = "tests/output.rs"]
mod tests;
