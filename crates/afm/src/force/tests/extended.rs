//! Arithmetic of twice the precision, as a reference: a number is the unevaluated sum of two (Dekker 1971).

use std::ops::{Add, Div, Mul, Neg, Sub};

/// high + low, |low| at most half a unit roundoff of high: 32 digits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extended {
    high: f64,
    low: f64,
}

fn quick_sum(a: f64, b: f64) -> Extended {
    let high = a + b;
    Extended { high, low: b - (high - a) }
}

fn two_sum(a: f64, b: f64) -> Extended {
    let high = a + b;
    let part = high - a;
    Extended { high, low: (a - (high - part)) + (b - part) }
}

impl From<f64> for Extended {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Add for Extended {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let sum = two_sum(self.high, other.high);
        quick_sum(sum.high, sum.low + self.low + other.low)
    }
}

impl Neg for Extended {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
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
        let low = self.high.mul_add(other.high, -high) + (self.high * other.low + self.low * other.high);
        quick_sum(high, low)
    }
}

impl Div for Extended {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let rest = rest - other * second.into();
        quick_sum(first, second) + (rest.high / other.high).into()
    }
}

impl Extended {
    pub fn value(self) -> f64 {
        self.high + self.low
    }

    pub fn is_negative(self) -> bool {
        self.high < 0.0
    }

    /// One step of Newton's method from the rounded root doubles its digits.
    pub fn sqrt(self) -> Self {
        if self.high == 0.0 {
            return self;
        }
        let guess: Self = self.high.sqrt().into();
        (guess + self / guess) / 2.0.into()
    }

    pub fn cbrt(self) -> Self {
        if self.high == 0.0 {
            return self;
        }
        let guess: Self = self.high.cbrt().into();
        guess + (self / (guess * guess) - guess) / 3.0.into()
    }

    /// By the power series, 0 to pi/2.
    pub fn sin_cos(self) -> (Self, Self) {
        let (mut sin, mut cos) = (Self::from(0.0), Self::from(0.0));
        let mut term = Self::from(1.0);
        for n in 0..36_u32 {
            let sign = if n / 2 % 2 == 0 { term } else { -term };
            if n % 2 == 0 {
                cos = cos + sign
            } else {
                sin = sin + sign
            }
            term = term * self / f64::from(n + 1).into();
        }
        (sin, cos)
    }
}

#[test]
fn known_values() {
    let two = Extended::from(2.0);
    let off = (two.sqrt() * two.sqrt() - two).value();
    assert!(off.abs() < 1e-31, "{off}");
    let off = (two.cbrt() * two.cbrt() * two.cbrt() - two).value();
    assert!(off.abs() < 1e-30, "{off}");
    let (sin, cos) = Extended::from(1.25).sin_cos();
    assert!((sin * sin + cos * cos - 1.0.into()).value().abs() < 1e-31);
    assert!((sin.value() - 1.25_f64.sin()).abs() < 1e-16);
    let third = Extended::from(1.0) / 3.0.into();
    assert!((third + third + third - 1.0.into()).value().abs() < 1e-31);
}
