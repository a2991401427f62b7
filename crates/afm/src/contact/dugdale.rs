//! The cohesive zone of Dugdale 1960 around a circular contact, as Maugis 1992 solved it.
//!
//! Dimensionless throughout: abar = a/(pi w R^2/K)^(1/3), Pbar = F/(pi w R); the constant stress sigma0 acts from the
//! contact radius a to c = m a.

use std::f64::consts::PI;

/// A cohesive zone of the transition parameter `lambda`, at the extent s = sqrt(m^2 - 1).
///
/// With s as the parameter of the load-radius curve no equation must be solved: the relation of a and m (Maugis 1992),
///
/// (lambda abar^2/2) f + (4 lambda^2 abar/3) g = 1, f = s + (s^2 - 1) atan s, g = s atan s - m + 1,
///
/// is quadratic in abar, and its positive root falls as s grows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Zone {
    lambda: f64,
    /// s = sqrt(m^2 - 1).
    pub extent: f64,
    /// abar.
    pub radius: f64,
    angle: f64,
    f: f64,
    /// 4 lambda^2 g/3.
    b: f64,
}

/// Returns f = s + (s^2 - 1) atan s; below 0.1 its series sum (-1)^(k+1) 4k/(4k^2 - 1) s^(2k+1), as terms cancel.
#[inline]
fn bulk(s: f64, angle: f64) -> f64 {
    let x = s * s;
    if s < 0.1 {
        const C: [f64; 7] =
            [4.0 / 3.0, -8.0 / 15.0, 12.0 / 35.0, -16.0 / 63.0, 20.0 / 99.0, -24.0 / 143.0, 28.0 / 195.0];
        s * x * C.iter().rev().fold(0.0, |sum, c| sum * x + c)
    } else {
        s + (x - 1.0) * angle
    }
}

/// Returns g = s atan s - m + 1, written with m - 1 = s^2/(m + 1).
#[inline]
fn rim(s: f64, angle: f64) -> f64 {
    s * (angle - s / (1.0 + (1.0 + s * s).sqrt()))
}

impl Zone {
    /// Creates the zone of extent `extent` > 0.
    #[inline]
    pub fn new(lambda: f64, extent: f64) -> Self {
        let angle = libm::atan(extent);
        let f = bulk(extent, angle);
        let b = 4.0 / 3.0 * lambda * lambda * rim(extent, angle);
        Self { lambda, extent, radius: 2.0 / (b + (b * b + 2.0 * lambda * f).sqrt()), angle, f, b }
    }

    /// Returns Pbar + 2, the load above the pull-off of DMT, which is positive.
    ///
    /// Pbar = abar^3 - lambda abar^2 (s + m^2 atan s); the equation of the radius turns this into
    /// abar^3 + 2 abar (4 lambda^2 g/3 - lambda abar atan s) - 2, which keeps its digits where Pbar is near -2.
    #[inline]
    pub fn lift(&self) -> f64 {
        let a = self.radius;
        a * (a * a + 2.0 * (self.b - self.lambda * a * self.angle))
    }

    /// Returns (4/3) lambda abar s, by which the zone reduces the indentation: dbar = abar^2 - this.
    #[inline]
    pub fn stretch(&self) -> f64 {
        4.0 / 3.0 * self.lambda * self.radius * self.extent
    }

    /// Returns e = -1 - d ln abar/d ln s, from 0 to 1.
    #[inline]
    fn excess(&self) -> f64 {
        let Self { lambda, extent: s, radius: a, angle, f, b } = *self;
        let x = s * s;
        let square = 1.0 + x;
        // s f'/2 - f, of the series sum (-1)^(k+1) 2k/(2k + 1) s^(2k+1).
        let h = if s < 0.1 {
            const C: [f64; 7] = [2.0 / 3.0, -4.0 / 5.0, 6.0 / 7.0, -8.0 / 9.0, 10.0 / 11.0, -12.0 / 13.0, 14.0 / 15.0];
            s * x * C.iter().rev().fold(0.0, |sum, c| sum * x + c)
        } else {
            angle - s / square
        };
        // s g' - g = (m - 1)/m^2.
        let k = x / ((1.0 + square.sqrt()) * square);
        (lambda * a * h + 4.0 / 3.0 * lambda * lambda * k) / (lambda * f * a + b)
    }

    /// Returns d Pbar/d ln s, divided by abar^2: negative on the stable branch, zero at pull-off.
    ///
    /// This is 2 lambda (atan s + e q) - 3 abar (1 + e), q = s + m^2 atan s, with e = -1 - d ln abar/d ln s: only the
    /// two terms that balance at pull-off are subtracted.
    #[inline]
    pub fn slope(&self) -> f64 {
        let e = self.excess();
        2.0 * self.lambda * (self.angle + e * (self.f + 2.0 * self.angle)) - 3.0 * self.radius * (1.0 + e)
    }

    /// Returns the zone with the least load, for `lambda` from 1e-36 to 1e9.
    pub fn at_pull_off(lambda: f64) -> Self {
        // s -> (3/2)^(1/3)/lambda for large lambda, 3/pi^(3/2) lambda^(-3/2) for small; the sum of the two is above s
        // by at most a factor 1.8, and never below.
        let scale = 1.144_714_242_553_331_9 / lambda + 0.538_761_366_375_499_7 / (lambda * lambda.sqrt());
        let slope = |inverse: f64| Self::new(lambda, 1.0 / inverse).slope();
        // Regula falsi with the weights of Anderson & Bjorck 1973, in 1/s, which varies like abar.
        let (mut old, mut new) = (0.9 / scale, 2.0 / scale);
        let (mut slope_old, mut slope_new) = (slope(old), slope(new));
        for _ in 0..100 {
            let next = new - (new - old) * (slope_new / (slope_new - slope_old));
            let slope_next = slope(next);
            if slope_next * slope_new < 0.0 {
                (old, slope_old) = (new, slope_new);
            } else {
                let weight = 1.0 - slope_next / slope_new;
                slope_old *= if weight > 0.0 { weight } else { 0.5 };
            }
            let step = (next - new).abs();
            (new, slope_new) = (next, slope_next);
            if slope_new == 0.0 || step <= 4.0 * f64::EPSILON * new {
                break;
            }
        }
        Self::new(lambda, 1.0 / new)
    }

    /// Returns the zone on the stable branch with this [lift](Self::lift), inside `bound`, a zone at or past pull-off
    /// (not needed at a lift above 1/2, that of JKR at pull-off).
    pub fn at_lift(lambda: f64, lift: f64, bound: Option<Self>) -> Self {
        let limit = match bound {
            Some(zone) if lift <= zone.lift() => return zone,
            Some(zone) => zone.extent,
            None => f64::INFINITY,
        };
        // A radius between DMT, abar^3 = lift, and JKR.
        let share = lambda / (lambda + 0.6);
        let radius = libm::cbrt(lift + share * (1.0 + (6.0 * lift - 3.0).max(0.0).sqrt()));
        let start = approximate_extent(lambda, radius).min(0.9 * limit);
        let extent = descend(start, limit, |s| {
            let zone = Self::new(lambda, s);
            let value = zone.lift();
            (libm::log(value / lift), zone.slope() * (zone.radius * zone.radius) / value)
        });
        Self::new(lambda, extent)
    }

    /// Returns the zone around a contact of this abar.
    pub fn at_radius(lambda: f64, radius: f64) -> Self {
        let extent = descend(approximate_extent(lambda, radius), f64::INFINITY, |s| {
            let zone = Self::new(lambda, s);
            (libm::log(zone.radius / radius), -1.0 - zone.excess())
        });
        Self::new(lambda, extent)
    }
}

/// Returns approximately the extent of the zone around a contact of this abar, from the leading terms of f and g.
#[inline]
fn approximate_extent(lambda: f64, radius: f64) -> f64 {
    let bulk = lambda * radius * radius;
    let rim = lambda * lambda * radius;
    let narrow = 1.0 / (libm::cbrt(2.0 / 3.0 * bulk) + (2.0 / 3.0 * rim).sqrt());
    let wide = 1.0 / ((PI / 4.0 * bulk).sqrt() + 0.761 * rim);
    narrow.max(wide)
}

/// Returns the root, in 0 < s < limit, of a function that falls through it and may rise again after a minimum below
/// zero. `function` gives its value and its derivative by ln s.
///
/// Newton's method in ln s, nearly exact because of the power laws at either end, inside a bracket that is halved if a
/// step would leave it: it ends for any start.
fn descend(start: f64, limit: f64, function: impl Fn(f64) -> (f64, f64)) -> f64 {
    const FACTOR: f64 = 16.0;
    let (mut low, mut high, mut s) = (0.0, limit, start);
    let mut last = f64::NAN;
    for _ in 0..200 {
        let (value, slope) = function(s);
        let step = if slope < 0.0 { -value / slope } else { f64::NAN };
        if step.abs() < 4.0 * f64::EPSILON {
            break;
        }
        if step > 0.0 {
            low = s;
        } else {
            high = s;
        }
        let newton = s * libm::exp(step);
        if newton > low && newton < high {
            s = newton;
            // The remaining error if it continues to shrink quadratically, with a margin.
            let rate = step / last;
            if step.abs() * rate * rate < 1e-19 {
                break;
            }
            last = step;
        } else {
            s = match (low > 0.0, high < f64::INFINITY) {
                (true, true) => (low * high).sqrt(),
                (true, false) => low * FACTOR,
                (false, _) => high / FACTOR,
            };
            last = f64::NAN;
        }
    }
    s
}

#[cfg(test)]
#[path = "tests/dugdale.rs"]
mod tests;
