//! Kinds of quantity.

use std::fmt;

/// Exponents of metre, kilogram, second, ampere, kelvin, mole and radian: the kind of quantity that a unit measures.
///
/// The angle is a separate dimension, so that a length given for an angle is detected. `Display` names the kind for
/// error texts: "a length", "a pressure".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Dimension([i8; 7]);

/// The base units of the exponents.
const BASES: [&str; 7] = ["m", "kg", "s", "A", "K", "mol", "rad"];

/// Declares the named kinds: a constant for each, and its description.
macro_rules! kinds {
    ($($(#[$doc:meta])* $name:ident = $powers:expr, $words:literal;)+) => {
        impl Dimension {
            $($(#[$doc])* pub const $name: Self = Self($powers);)+

            const NAMES: &[(Self, &str)] = &[$((Self::$name, $words)),+];
        }
    };
}

kinds! {
    /// A pure number.
    NUMBER = [0, 0, 0, 0, 0, 0, 0], "a pure number";
    /// Metre.
    LENGTH = [1, 0, 0, 0, 0, 0, 0], "a length";
    /// Square metre.
    AREA = [2, 0, 0, 0, 0, 0, 0], "an area";
    /// Cubic metre.
    VOLUME = [3, 0, 0, 0, 0, 0, 0], "a volume";
    /// Kilogram.
    MASS = [0, 1, 0, 0, 0, 0, 0], "a mass";
    /// Second.
    TIME = [0, 0, 1, 0, 0, 0, 0], "a time";
    /// Hertz.
    FREQUENCY = [0, 0, -1, 0, 0, 0, 0], "a frequency";
    /// Metre per second.
    SPEED = [1, 0, -1, 0, 0, 0, 0], "a speed";
    /// Metre per second squared.
    ACCELERATION = [1, 0, -2, 0, 0, 0, 0], "an acceleration";
    /// Newton.
    FORCE = [1, 1, -2, 0, 0, 0, 0], "a force";
    /// Pascal.
    PRESSURE = [-1, 1, -2, 0, 0, 0, 0], "a pressure";
    /// Newton per metre; a surface energy (joule per square metre) has the same dimension.
    STIFFNESS = [0, 1, -2, 0, 0, 0, 0], "a stiffness or surface energy";
    /// Newton second per metre.
    DAMPING = [0, 1, -1, 0, 0, 0, 0], "a damping coefficient";
    /// Joule; a torque (newton metre) has the same dimension.
    ENERGY = [2, 1, -2, 0, 0, 0, 0], "an energy or torque";
    /// Kilogram per cubic metre.
    DENSITY = [-3, 1, 0, 0, 0, 0, 0], "a density";
    /// Pascal second.
    VISCOSITY = [-1, 1, -1, 0, 0, 0, 0], "a viscosity";
    /// Watt.
    POWER = [2, 1, -3, 0, 0, 0, 0], "a power";
    /// Ampere.
    CURRENT = [0, 0, 0, 1, 0, 0, 0], "an electric current";
    /// Coulomb.
    CHARGE = [0, 0, 1, 1, 0, 0, 0], "an electric charge";
    /// Volt.
    VOLTAGE = [2, 1, -3, -1, 0, 0, 0], "a voltage";
    /// Ohm.
    RESISTANCE = [2, 1, -3, -2, 0, 0, 0], "an electric resistance";
    /// Farad.
    CAPACITANCE = [-2, -1, 4, 2, 0, 0, 0], "a capacitance";
    /// Tesla.
    FLUX_DENSITY = [0, 1, -2, -1, 0, 0, 0], "a magnetic flux density";
    /// Kelvin.
    TEMPERATURE = [0, 0, 0, 0, 1, 0, 0], "a temperature";
    /// Mole.
    AMOUNT = [0, 0, 0, 0, 0, 1, 0], "an amount of substance";
    /// Radian.
    ANGLE = [0, 0, 0, 0, 0, 0, 1], "an angle";
}

impl Dimension {
    /// Returns `self * other^power`, or `None` beyond the range of `i8`.
    pub(super) fn times(self, other: Self, power: i8) -> Option<Self> {
        let mut powers = self.0;
        for (sum, other) in powers.iter_mut().zip(other.0) {
            *sum = sum.checked_add(other.checked_mul(power)?)?;
        }
        Some(Self(powers))
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((_, name)) = Self::NAMES.iter().find(|(dimension, _)| dimension == self) {
            return f.write_str(name);
        }
        f.write_str("a quantity in")?;
        let powers = self.0.into_iter().zip(BASES);
        powers
            .filter(|(power, _)| *power != 0)
            .try_for_each(|(power, base)| if power == 1 { write!(f, " {base}") } else { write!(f, " {base}^{power}") })
    }
}
