//! Numbers of twice the precision of doubles and of any size, to check results in double precision against.
//!
//! The number is (high + low) 2^exponent, |low| at most half a unit in the last place of high (Dekker 1971): 31 digits,
//! and an exponent of its own, so that nothing over- or underflows on the way. It is for checks, not for speed.

mod bounded;
mod functions;
mod reduction;
#[cfg(test)]
mod tests;

pub use bounded::Bounded;
pub(crate) use functions::atan2;

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number of 106 bits and any size.
#[derive(Clone, Copy, Debug)]
pub struct Extended {
    /// In [1/2, 1) by magnitude; 0, infinite or not a number, and the exponent 0 then.
    high: f64,
    low: f64,
    exponent: i64,
}

/// Exponents further apart than this leave the larger number as it is.
const FARTHEST: i64 = 220;

/// a + b and what rounding took from it, for |a| >= |b|.
fn quick_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// The same for any two.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// 2^n for n in the range of normal doubles.
fn power_of_two(n: i64) -> f64 {
    f64::from_bits(((n + 1023) as u64) << 52)
}

/// `x` as a number in [1/2, 1) times a power of two; `x` is finite and not 0.
fn split(x: f64) -> (f64, i64) {
    if x.abs() < f64::MIN_POSITIVE {
        let (mantissa, exponent) = split(x * power_of_two(64));
        return (mantissa, exponent - 64);
    }
    let exponent = ((x.to_bits() >> 52) & 0x7ff) as i64 - 1022;
    (f64::from_bits(x.to_bits() & !(0x7ff << 52) | (1022 << 52)), exponent)
}

impl Extended {
    pub const ZERO: Self = Self::special(0.0);
    pub const ONE: Self = Self { high: 0.5, low: 0.0, exponent: 1 };
    pub const INFINITY: Self = Self::special(f64::INFINITY);
    pub const NAN: Self = Self::special(f64::NAN);
    /// pi
    pub const PI: Self = Self { high: std::f64::consts::FRAC_PI_4, low: 3.061_616_997_868_383e-17, exponent: 2 };
    /// The natural logarithm of 2.
    pub const LN_2: Self = Self { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17, exponent: 0 };

    const fn special(high: f64) -> Self {
        Self { high, low: 0.0, exponent: 0 }
    }

    /// The number (high + low) 2^exponent, of parts that do not overlap much and are of size 1 or so.
    fn new((high, low): (f64, f64), exponent: i64) -> Self {
        let (high, low) = quick_sum(high, low);
        if high == 0.0 || !high.is_finite() {
            return Self::special(high);
        }
        let (mantissa, shift) = split(high);
        Self { high: mantissa, low: low * power_of_two(-shift), exponent: exponent + shift }
    }

    /// The nearest double; infinite beyond their range.
    pub fn value(self) -> f64 {
        let sum = self.high + self.low;
        match self.exponent {
            _ if sum == 0.0 || !sum.is_finite() => sum,
            1025.. => f64::INFINITY.copysign(sum),
            ..-1080 => 0.0_f64.copysign(sum),
            // In two steps, of which the first is exact: subnormal numbers have a factor below every power of two.
            exponent => sum * power_of_two(exponent / 2) * power_of_two(exponent - exponent / 2),
        }
    }

    pub fn is_nan(self) -> bool {
        self.high.is_nan()
    }

    pub fn is_finite(self) -> bool {
        self.high.is_finite()
    }

    pub fn is_zero(self) -> bool {
        self.high == 0.0
    }

    pub fn is_negative(self) -> bool {
        self.high < 0.0
    }

    #[must_use]
    pub fn abs(self) -> Self {
        if self.is_negative() { -self } else { self }
    }

    /// This number times 2^n.
    #[must_use]
    pub fn times_power_of_two(self, n: i64) -> Self {
        if self.is_zero() || !self.is_finite() { self } else { Self { exponent: self.exponent + n, ..self } }
    }

    #[must_use]
    pub fn square(self) -> Self {
        self * self
    }

    /// `self` to a whole power.
    #[must_use]
    pub fn powi(self, power: i32) -> Self {
        let (mut left, mut base, mut product) = (power.unsigned_abs(), self, Self::ONE);
        while left > 0 {
            if left & 1 == 1 {
                product = product * base;
            }
            base = base.square();
            left >>= 1;
        }
        if power < 0 { Self::ONE / product } else { product }
    }

    /// One step of Newton's method from the rounded root doubles its digits.
    #[must_use]
    pub fn sqrt(self) -> Self {
        if self.is_zero() || self.is_nan() || self.high == f64::INFINITY {
            return self;
        }
        if self.is_negative() {
            return Self::NAN;
        }
        let half = self.exponent.div_euclid(2);
        let reduced = self.times_power_of_two(-2 * half);
        let guess = Self::from(reduced.value().sqrt());
        ((guess + reduced / guess).times_power_of_two(-1)).times_power_of_two(half)
    }

    #[must_use]
    pub fn cbrt(self) -> Self {
        if self.is_zero() || !self.is_finite() {
            return self;
        }
        let third = self.exponent.div_euclid(3);
        let reduced = self.times_power_of_two(-3 * third);
        let guess = Self::from(libm::cbrt(reduced.value()));
        (guess + (reduced / guess.square() - guess) / 3.0.into()).times_power_of_two(third)
    }

    /// The largest whole number that is not larger.
    #[must_use]
    pub fn floor(self) -> Self {
        match self.exponent {
            _ if !self.is_finite() || self.is_zero() => self,
            // Every bit is worth 1 or more.
            108.. => self,
            ..-1 => {
                if self.is_negative() {
                    -Self::ONE
                } else {
                    Self::ZERO
                }
            }
            exponent => {
                let scale = power_of_two(exponent);
                let (high, low) = (self.high * scale, self.low * scale);
                let floor = high.floor();
                Self::new(two_sum(floor, if floor == high { low.floor() } else { 0.0 }), 0)
            }
        }
    }

    /// Whether it is less than `other`; not if one of them is not a number.
    pub fn is_below(self, other: Self) -> bool {
        self < other
    }

    fn order(self, other: Self) -> Option<Ordering> {
        if self.is_finite() && other.is_finite() {
            (self - other).high.partial_cmp(&0.0)
        } else {
            self.high.partial_cmp(&other.high)
        }
    }

    /// The larger one; not a number if one of them is none.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        match self.order(other) {
            None => Self::NAN,
            Some(Ordering::Less) => other,
            Some(_) => self,
        }
    }

    /// The lesser one; not a number if one of them is none.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        -(-self).max(-other)
    }
}

impl From<f64> for Extended {
    fn from(value: f64) -> Self {
        if value == 0.0 || !value.is_finite() {
            return Self::special(value);
        }
        let (high, exponent) = split(value);
        Self { high, low: 0.0, exponent }
    }
}

impl PartialEq for Extended {
    fn eq(&self, other: &Self) -> bool {
        self.order(*other) == Some(Ordering::Equal)
    }
}

impl PartialOrd for Extended {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.order(*other)
    }
}

impl Neg for Extended {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low, ..self }
    }
}

impl Add for Extended {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if !self.is_finite() || !other.is_finite() {
            return Self::special(self.high + other.high);
        }
        if self.is_zero() || other.is_zero() {
            return if self.is_zero() { other } else { self };
        }
        let (large, small) = if self.exponent >= other.exponent { (self, other) } else { (other, self) };
        let apart = large.exponent - small.exponent;
        if apart > FARTHEST {
            return large;
        }
        let scale = power_of_two(-apart);
        let (high, rest) = two_sum(large.high, small.high * scale);
        let (low, last) = two_sum(large.low, small.low * scale);
        let (high, rest) = quick_sum(high, rest + low);
        Self::new((high, rest + last), large.exponent)
    }
}

impl Sub for Extended {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Extended {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        if high == 0.0 || !high.is_finite() {
            return Self::special(high);
        }
        let low = self.high.mul_add(other.high, -high) + (self.high * other.low + self.low * other.high);
        Self::new((high, low), self.exponent + other.exponent)
    }
}

impl Div for Extended {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        if first == 0.0 || !first.is_finite() {
            return Self::special(first);
        }
        let [dividend, divisor] = [self, other].map(|number| Self { exponent: 0, ..number });
        let rest = dividend - divisor * first.into();
        let second = rest.value() / divisor.high;
        let rest = rest - divisor * second.into();
        let third = rest.value() / divisor.high;
        let (high, low) = quick_sum(first, second);
        Self::new((high, low + third), self.exponent - other.exponent)
    }
}
