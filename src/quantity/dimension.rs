//! Kinds of quantity.

use std::fmt;

/// Exponents of metre, kilogram, second, ampere, kelvin, mole and radian: what kind of quantity a unit measures.
///
/// The angle is a dimension of its own, so that a length given for an angle is found out.
/// `Display` names the kind for error texts: "a length", "a pressure".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Dimension {
    length: i8,
    mass: i8,
    time: i8,
    current: i8,
    temperature: i8,
    amount: i8,
    angle: i8,
}

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
    pub const CURRENT: Self = Self { current: 1, ..Self::NUMBER };
    /// Coulomb.
    pub const CHARGE: Self = Self { current: 1, ..Self::TIME };
    /// Volt.
    pub const VOLTAGE: Self = Self { current: -1, ..Self::POWER };
    /// Ohm.
    pub const RESISTANCE: Self = Self { current: -2, ..Self::POWER };
    /// Farad.
    pub const CAPACITANCE: Self = Self { current: 2, ..Self::of(-2, -1, 4) };
    /// Tesla.
    pub const FLUX_DENSITY: Self = Self { current: -1, ..Self::of(0, 1, -2) };
    /// Kelvin.
    pub const TEMPERATURE: Self = Self { temperature: 1, ..Self::NUMBER };
    /// Mole.
    pub const AMOUNT: Self = Self { amount: 1, ..Self::NUMBER };
    /// Radian.
    pub const ANGLE: Self = Self { angle: 1, ..Self::NUMBER };

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
        Self { length, mass, time, current: 0, temperature: 0, amount: 0, angle: 0 }
    }

    /// `self * other^power`, `None` past the range of `i8`.
    pub(super) fn times(self, other: Self, power: i8) -> Option<Self> {
        let combine = |a: i8, b: i8| a.checked_add(b.checked_mul(power)?);
        Some(Self {
            length: combine(self.length, other.length)?,
            mass: combine(self.mass, other.mass)?,
            time: combine(self.time, other.time)?,
            current: combine(self.current, other.current)?,
            temperature: combine(self.temperature, other.temperature)?,
            amount: combine(self.amount, other.amount)?,
            angle: combine(self.angle, other.angle)?,
        })
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((_, name)) = Self::NAMES.iter().find(|(dimension, _)| dimension == self) {
            return f.write_str(name);
        }
        f.write_str("a quantity in")?;
        let bases = [
            (self.length, "m"),
            (self.mass, "kg"),
            (self.time, "s"),
            (self.current, "A"),
            (self.temperature, "K"),
            (self.amount, "mol"),
            (self.angle, "rad"),
        ];
        bases
            .into_iter()
            .filter(|(power, _)| *power != 0)
            .try_for_each(|(power, base)| if power == 1 { write!(f, " {base}") } else { write!(f, " {base}^{power}") })
    }
}
