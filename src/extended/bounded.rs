//! Numbers with a bound of what rounding may make of them where they are computed in doubles (running error analysis,
//! Wilkinson 1986).

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Extended, atan2};

/// Half a unit in the last place of a double, relatively.
const UNIT: f64 = f64::EPSILON / 2.0;

/// Units that a function of the mathematical library may be off by.
const OF_FUNCTIONS: f64 = 4.0;

/// The exact value of an expression, and how far the same expression in doubles may lie from it.
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    /// The value.
    pub value: Extended,
    /// The bound; infinite where there is none, as after an overflow or a comparison that rounding may decide.
    pub error: Extended,
}

impl From<f64> for Bounded {
    /// A double, which is exact.
    fn from(value: f64) -> Self {
        Self { value: value.into(), error: Extended::ZERO }
    }
}

impl Bounded {
    /// A value of which doubles need not have a digit.
    pub fn unbounded(value: Extended) -> Self {
        Self { value, error: Extended::INFINITY }
    }

    /// The result `value` of an operation whose operands may move it by `error`, and which is rounded by so many units.
    fn rounded(value: Extended, error: Extended, units: f64) -> Self {
        let size = value.abs() + error;
        let in_range = size <= f64::MAX.into();
        if !in_range || error.is_nan() {
            return Self::unbounded(value);
        }
        if units == 0.0 {
            return Self { value, error };
        }
        // The least subnormal number where the result underflows.
        Self { value, error: error + size * (units * UNIT).into() + f64::from_bits(1).into() }
    }

    /// Whether 0 is within the error.
    fn may_be_zero(self) -> bool {
        !self.error.is_below(self.value.abs())
    }

    /// `function` of this number, the largest of whose change is at the ends of what the number may be.
    pub fn map(self, function: impl Fn(Extended) -> Extended) -> Self {
        self.map_in(function, OF_FUNCTIONS)
    }

    /// The same of a function whose result is not rounded: absolute value, whole numbers.
    pub fn map_exactly(self, function: impl Fn(Extended) -> Extended) -> Self {
        self.map_in(function, 0.0)
    }

    fn map_in(self, function: impl Fn(Extended) -> Extended, units: f64) -> Self {
        let value = function(self.value);
        if self.error.is_zero() {
            return Self::rounded(value, Extended::ZERO, units);
        }
        let change = |x: Extended| (function(x) - value).abs();
        let error = change(self.value - self.error).max(change(self.value + self.error));
        if error.is_nan() { Self::unbounded(value) } else { Self::rounded(value, error, units) }
    }

    /// `function` of this number that changes by no more than its argument: sine and cosine.
    pub fn map_wave(self, function: impl Fn(Extended) -> Extended) -> Self {
        let value = function(self.value);
        if self.error.is_finite() { Self::rounded(value, self.error, OF_FUNCTIONS) } else { Self::unbounded(value) }
    }

    /// The tangent, without a bound where a pole may be.
    pub fn tan(self) -> Self {
        let near_pole = !self.error.is_below(self.value.cos().abs());
        if near_pole { Self::unbounded(self.value.tan()) } else { self.map(Extended::tan) }
    }

    /// To a whole power, by multiplication.
    pub fn powi(self, power: i32) -> Self {
        let Self { value, error } = self.map(|x| x.powi(power));
        Self::rounded(value, error, f64::from(power.unsigned_abs()))
    }

    /// To any power.
    pub fn powf(self, power: Self) -> Self {
        let value = self.value.powf(power.value);
        if self.error.is_zero() && power.error.is_zero() {
            return Self::rounded(value, Extended::ZERO, OF_FUNCTIONS);
        }
        if self.may_be_zero() || self.value.is_negative() {
            return Self::unbounded(value);
        }
        let of_base = power.value.abs() * self.error / (self.value - self.error);
        let of_power = (self.value.ln().abs() + self.error / (self.value - self.error)) * power.error;
        Self::rounded(value, value.abs() * (of_base + of_power).exp_m1(), OF_FUNCTIONS)
    }

    /// The angle of the point (x, y).
    pub fn atan2(y: Self, x: Self) -> Self {
        let value = atan2(y.value, x.value);
        let far = y.value.hypot(x.value) - y.error.hypot(x.error);
        let moved = y.error.hypot(x.error);
        if moved.is_zero() {
            return Self::rounded(value, Extended::ZERO, OF_FUNCTIONS);
        }
        // The angle jumps where y = 0, x < 0.
        let at_jump = x.value.is_negative() && y.may_be_zero();
        if !moved.is_below(far) || at_jump {
            Self::unbounded(value)
        } else {
            Self::rounded(value, moved / far, OF_FUNCTIONS)
        }
    }

    /// sqrt(x^2 + y^2).
    pub fn hypot(self, other: Self) -> Self {
        Self::rounded(self.value.hypot(other.value), self.error + other.error, OF_FUNCTIONS)
    }

    /// The larger one.
    pub fn max(self, other: Self) -> Self {
        Self { value: self.value.max(other.value), error: self.error.max(other.error) }
    }

    /// The lesser one.
    pub fn min(self, other: Self) -> Self {
        Self { value: self.value.min(other.value), error: self.error.max(other.error) }
    }

    /// A truth that hangs on the sign of `self`: unbounded where rounding may turn it.
    pub fn decides(self, truth: bool) -> Self {
        let value = Extended::from(f64::from(u8::from(truth)));
        let certain = self.error.is_zero() || !self.may_be_zero();
        if certain { Self { value, error: Extended::ZERO } } else { Self::unbounded(value) }
    }
}

impl Neg for Bounded {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl Add for Bounded {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::rounded(self.value + other.value, self.error + other.error, 1.0)
    }
}

impl Sub for Bounded {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Bounded {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let error = self.value.abs() * other.error + self.error * (other.value.abs() + other.error);
        Self::rounded(self.value * other.value, error, 1.0)
    }
}

impl Div for Bounded {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        if other.may_be_zero() {
            return Self::unbounded(value);
        }
        let error =
            (self.value.abs() * other.error / other.value.abs() + self.error) / (other.value.abs() - other.error);
        Self::rounded(value, error, 1.0)
    }
}
