//! Kinds of quantity.

use std::fmt;

/// Exponents of metre, kilogram, second, ampere, kelvin, mole and radian: what kind of quantity a unit measures.
///
/// The angle is a dimension of its own, so that a length given for an angle is found out.
/// `Display` names the kind for error texts: "a length", "a pressure".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Dimension([i8; 7]);

/// The units that these are exponents of.
const BASES: [&str; 7] = ["m", "kg", "s", "A", "K", "mol", "rad"];

impl Dimension {
    /// A pure number.
    pub const NUMBER: Self = Self::of(0, 0, 0);
    /// Metre.
    pub const LENGTH: Self = Self::of(1, 0, 0);
    /// Square metre.
    pub const AREA: Self = Self::of(2, 0, 0);
    /// Cubic metre.
    pub const VOLUME: Self = Self::of(3, 0, 0);
    /// Kilogram.
    pub const MASS: Self = Self::of(0, 1, 0);
    /// Second.
    pub const TIME: Self = Self::of(0, 0, 1);
    /// Hertz.
    pub const FREQUENCY: Self = Self::of(0, 0, -1);
    /// Metre per second.
    pub const SPEED: Self = Self::of(1, 0, -1);
    /// Metre per second squared.
    pub const ACCELERATION: Self = Self::of(1, 0, -2);
    /// Newton.
    pub const FORCE: Self = Self::of(1, 1, -2);
    /// Pascal.
    pub const PRESSURE: Self = Self::of(-1, 1, -2);
    /// Newton per metre; a surface energy (joule per square metre) has the same dimension.
    pub const STIFFNESS: Self = Self::of(0, 1, -2);
    /// Newton second per metre.
    pub const DAMPING: Self = Self::of(0, 1, -1);
    /// Joule; a torque (newton metre) has the same dimension.
    pub const ENERGY: Self = Self::of(2, 1, -2);
    /// Kilogram per cubic metre.
    pub const DENSITY: Self = Self::of(-3, 1, 0);
    /// Pascal second.
    pub const VISCOSITY: Self = Self::of(-1, 1, -1);
    /// Watt.
    pub const POWER: Self = Self::of(2, 1, -3);
    /// Ampere.
    pub const CURRENT: Self = Self([0, 0, 0, 1, 0, 0, 0]);
    /// Coulomb.
    pub const CHARGE: Self = Self([0, 0, 1, 1, 0, 0, 0]);
    /// Volt.
    pub const VOLTAGE: Self = Self([2, 1, -3, -1, 0, 0, 0]);
    /// Ohm.
    pub const RESISTANCE: Self = Self([2, 1, -3, -2, 0, 0, 0]);
    /// Farad.
    pub const CAPACITANCE: Self = Self([-2, -1, 4, 2, 0, 0, 0]);
    /// Tesla.
    pub const FLUX_DENSITY: Self = Self([0, 1, -2, -1, 0, 0, 0]);
    /// Kelvin.
    pub const TEMPERATURE: Self = Self([0, 0, 0, 0, 1, 0, 0]);
    /// Mole.
    pub const AMOUNT: Self = Self([0, 0, 0, 0, 0, 1, 0]);
    /// Radian.
    pub const ANGLE: Self = Self([0, 0, 0, 0, 0, 0, 1]);

    const NAMES: [(Self, &'static str); 26] = [
        (Self::NUMBER, "a pure number"),
        (Self::LENGTH, "a length"),
        (Self::AREA, "an area"),
        (Self::VOLUME, "a volume"),
        (Self::MASS, "a mass"),
        (Self::TIME, "a time"),
        (Self::FREQUENCY, "a frequency"),
        (Self::SPEED, "a speed"),
        (Self::ACCELERATION, "an acceleration"),
        (Self::FORCE, "a force"),
        (Self::PRESSURE, "a pressure"),
        (Self::STIFFNESS, "a stiffness or surface energy"),
        (Self::DAMPING, "a damping coefficient"),
        (Self::ENERGY, "an energy or torque"),
        (Self::DENSITY, "a density"),
        (Self::VISCOSITY, "a viscosity"),
        (Self::POWER, "a power"),
        (Self::CURRENT, "an electric current"),
        (Self::CHARGE, "an electric charge"),
        (Self::VOLTAGE, "a voltage"),
        (Self::RESISTANCE, "an electric resistance"),
        (Self::CAPACITANCE, "a capacitance"),
        (Self::FLUX_DENSITY, "a magnetic flux density"),
        (Self::TEMPERATURE, "a temperature"),
        (Self::AMOUNT, "an amount of substance"),
        (Self::ANGLE, "an angle"),
    ];

    const fn of(length: i8, mass: i8, time: i8) -> Self {
        Self([length, mass, time, 0, 0, 0, 0])
    }

    /// `self * other^power`, `None` past the range of `i8`.
    pub(super) fn times(self, other: Self, power: i8) -> Option<Self> {
        let mut powers = self.0;
        for (own, other) in powers.iter_mut().zip(other.0) {
            *own = own.checked_add(other.checked_mul(power)?)?;
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
