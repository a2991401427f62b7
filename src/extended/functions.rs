//! The elementary functions.

use super::Extended;
use super::reduction::reduced;

/// Terms after which every power series here has ended.
const TERMS: u32 = 60;

/// The sum of a series whose terms follow from each other: `next` makes term n of the one before.
fn series(first: Extended, next: impl Fn(Extended, u32) -> Extended) -> Extended {
    let (mut term, mut sum) = (first, first);
    for n in 1..TERMS {
        term = next(term, n);
        let before = sum;
        sum = sum + term;
        if term.is_zero() || sum.exponent - term.exponent > 110 && before.exponent == sum.exponent {
            break;
        }
    }
    sum
}

fn whole(n: u32) -> Extended {
    f64::from(n).into()
}

impl Extended {
    /// e^x. Beyond 2^40 the exponent itself is out of reach: infinite or 0.
    #[must_use]
    pub fn exp(self) -> Self {
        if !self.is_finite() || self.is_zero() {
            return if self.high == f64::NEG_INFINITY {
                Self::ZERO
            } else if self.is_zero() {
                Self::ONE
            } else {
                self
            };
        }
        if self.exponent > 40 {
            return if self.is_negative() { Self::ZERO } else { Self::INFINITY };
        }
        let turns = (self.value() * std::f64::consts::LOG2_E).round();
        let rest = self - Self::LN_2 * turns.into();
        // Nine halvings, then nine squares.
        let small = rest.times_power_of_two(-9);
        let mut grown = series(small, |term, n| term * small / whole(n + 1));
        for _ in 0..9 {
            // (1 + g)^2 - 1, which loses no digits of a small g.
            grown = grown.times_power_of_two(1) + grown.square();
        }
        (Self::ONE + grown).times_power_of_two(turns as i64)
    }

    /// e^x - 1.
    #[must_use]
    pub fn exp_m1(self) -> Self {
        if self.is_finite() && self.exponent < 0 {
            return series(self, |term, n| term * self / whole(n + 1));
        }
        self.exp() - Self::ONE
    }

    /// The natural logarithm.
    #[must_use]
    pub fn ln(self) -> Self {
        if self.is_zero() {
            return -Self::INFINITY;
        }
        if self.is_negative() || !self.is_finite() {
            return if self.high == f64::INFINITY { self } else { Self::NAN };
        }
        // A mantissa about 1, so that the logarithm of a number near 1 keeps its digits.
        let shift = if self.high < std::f64::consts::FRAC_1_SQRT_2 { self.exponent - 1 } else { self.exponent };
        let mantissa = self.times_power_of_two(-shift);
        let root = mantissa.sqrt().sqrt();
        let of_mantissa = two_artanh((root - Self::ONE) / (root + Self::ONE)).times_power_of_two(2);
        let close = mantissa - Self::ONE;
        let of_mantissa = if close.exponent < -8 { two_artanh(close / (close + 2.0.into())) } else { of_mantissa };
        of_mantissa + Self::LN_2 * (shift as f64).into()
    }

    /// ln(1 + x).
    #[must_use]
    pub fn ln_1p(self) -> Self {
        if self.is_finite() && self.exponent < -3 {
            two_artanh(self / (self + 2.0.into()))
        } else {
            (Self::ONE + self).ln()
        }
    }

    /// Sine and cosine.
    pub fn sin_cos(self) -> (Self, Self) {
        let (quarter, x) = reduced(self);
        let square = -x.square();
        let sin = if x.is_zero() { x } else { series(x, |term, n| term * square / whole(2 * n * (2 * n + 1))) };
        let cos = series(Self::ONE, |term, n| term * square / whole(2 * n * (2 * n - 1)));
        match quarter {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }

    #[must_use]
    pub fn sin(self) -> Self {
        self.sin_cos().0
    }

    #[must_use]
    pub fn cos(self) -> Self {
        self.sin_cos().1
    }

    #[must_use]
    pub fn tan(self) -> Self {
        let (sin, cos) = self.sin_cos();
        sin / cos
    }

    /// One step from the rounded angle: tan(atan x - y) = (x - tan y)/(1 + x tan y).
    #[must_use]
    pub fn atan(self) -> Self {
        if self.is_nan() || self.is_zero() {
            return self;
        }
        if self.abs() > Self::ONE {
            let quarter = Self::PI.times_power_of_two(-1);
            let beyond = (Self::ONE / self).atan();
            return if self.is_negative() { -quarter - beyond } else { quarter - beyond };
        }
        if self.exponent < -60 {
            return self - self * self.square() / 3.0.into();
        }
        let guess = Self::from(libm::atan(self.value()));
        let (sin, cos) = guess.sin_cos();
        let off = (self * cos - sin) / (cos + self * sin);
        guess + off - off * off.square() / 3.0.into()
    }

    #[must_use]
    pub fn asin(self) -> Self {
        atan2(self, ((Self::ONE - self) * (Self::ONE + self)).sqrt())
    }

    #[must_use]
    pub fn acos(self) -> Self {
        atan2(((Self::ONE - self) * (Self::ONE + self)).sqrt(), self)
    }

    #[must_use]
    pub fn sinh(self) -> Self {
        (self.exp_m1() - (-self).exp_m1()).times_power_of_two(-1)
    }

    #[must_use]
    pub fn cosh(self) -> Self {
        (self.exp() + (-self).exp()).times_power_of_two(-1)
    }

    #[must_use]
    pub fn tanh(self) -> Self {
        if self.exponent > 8 {
            return if self.is_negative() { -Self::ONE } else { Self::ONE };
        }
        let grown = self.times_power_of_two(1).exp_m1();
        grown / (grown + 2.0.into())
    }

    #[must_use]
    pub fn log2(self) -> Self {
        self.ln() / Self::LN_2
    }

    #[must_use]
    pub fn log10(self) -> Self {
        self.ln() / Self::from(10.0).ln()
    }

    #[must_use]
    pub fn hypot(self, other: Self) -> Self {
        (self.square() + other.square()).sqrt()
    }

    /// x^y, for x > 0, or 0 and a positive y, or any x and a whole y.
    #[must_use]
    pub fn powf(self, power: Self) -> Self {
        if power.is_zero() {
            return Self::ONE;
        }
        if self.is_zero() {
            return if power.is_negative() { Self::INFINITY } else { self.abs() };
        }
        if self.is_negative() {
            let half = power.times_power_of_two(-1);
            let size = self.abs().powf(power);
            return match () {
                () if power.floor() != power => Self::NAN,
                () if half.floor() == half => size,
                () => -size,
            };
        }
        (self.ln() * power).exp()
    }

    #[must_use]
    pub fn ceil(self) -> Self {
        -(-self).floor()
    }

    /// To the nearest whole number, halves away from zero.
    #[must_use]
    pub fn round(self) -> Self {
        let size = (self.abs() + 0.5.into()).floor();
        if self.is_negative() { -size } else { size }
    }

    /// To the nearest whole number, halves to even ones.
    #[must_use]
    pub fn round_ties_even(self) -> Self {
        let below = self.floor();
        let part = self - below;
        let half = below.times_power_of_two(-1);
        let is_even = half.floor() == half;
        if part < 0.5.into() || part == 0.5.into() && is_even { below } else { below + Self::ONE }
    }
}

/// The angle of the point (x, y) from the first axis.
pub(crate) fn atan2(y: Extended, x: Extended) -> Extended {
    if x.is_nan() || y.is_nan() {
        return Extended::NAN;
    }
    let half_turn = if y.is_negative() { -Extended::PI } else { Extended::PI };
    match () {
        () if x.is_zero() && y.is_zero() => Extended::ZERO,
        () if x.is_zero() => half_turn.times_power_of_two(-1),
        () if y.abs() > x.abs() => half_turn.times_power_of_two(-1) - (x / y).atan(),
        () if x.is_negative() => half_turn + (y / x).atan(),
        () => (y / x).atan(),
    }
}

/// ln((1 + z)/(1 - z)), for small z.
fn two_artanh(z: Extended) -> Extended {
    if z.is_zero() {
        return z;
    }
    let square = z.square();
    let mut power = z;
    let mut sum = z;
    for n in 1..TERMS {
        power = power * square;
        let term = power / whole(2 * n + 1);
        sum = sum + term;
        if sum.exponent - term.exponent > 110 {
            break;
        }
    }
    sum.times_power_of_two(1)
}
