//! Special functions of the normal and Student's t distribution, with the same bits on every platform: `libm` is the
//! only mathematical library that they use.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use libm::erfc;

/// Returns P(Z < z) of the standard normal distribution, to full relative precision in the lower tail.
pub fn normal_below(z: f64) -> f64 {
    0.5 * erfc(-z * FRAC_1_SQRT_2)
}

/// Returns the quantile of the standard normal distribution at `u` in (0, 1), to a relative error of about 1e-16 down
/// to u = 1e-316 (Wichura 1988, Applied Statistics 37, algorithm AS 241, PPND16).
pub fn normal_quantile(u: f64) -> f64 {
    let q = u - 0.5;
    if q.abs() <= 0.425 {
        return normal_quantile_near_median(q);
    }
    let tail = if q < 0.0 { u } else { 1.0 - u };
    if tail <= 0.0 {
        return if q < 0.0 { f64::NEG_INFINITY } else { f64::INFINITY };
    }
    let r = (-libm::log(tail)).sqrt();
    let x = if r <= 5.0 { quantile_of_tail(r) } else { quantile_far_out(r) };
    if q < 0.0 { -x } else { x }
}

/// Returns the normal quantile above 0.425 from the median, for r = sqrt(-ln tail) up to 5.
fn quantile_of_tail(r: f64) -> f64 {
    let r = r - 1.6;
    let above = polynomial(
        r,
        [
            1.423_437_110_749_683_6,
            4.630_337_846_156_546,
            5.769_497_221_460_691,
            3.647_848_324_763_204_5,
            1.270_458_252_452_368_4,
            0.241_780_725_177_450_6,
            0.022_723_844_989_269_184,
            7.745_450_142_783_414e-4,
        ],
    );
    let below = polynomial(
        r,
        [
            1.0,
            2.053_191_626_637_759,
            1.676_384_830_183_803_8,
            0.689_767_334_985_1,
            0.148_103_976_427_480_08,
            0.015_198_666_563_616_457,
            5.475_938_084_995_345e-4,
            1.050_750_071_644_416_9e-9,
        ],
    );
    above / below
}

/// The same for larger r.
fn quantile_far_out(r: f64) -> f64 {
    let r = r - 5.0;
    let above = polynomial(
        r,
        [
            6.657_904_643_501_103,
            5.463_784_911_164_114,
            1.784_826_539_917_291_3,
            0.296_560_571_828_504_87,
            0.026_532_189_526_576_124,
            0.001_242_660_947_388_078_4,
            2.711_555_568_743_487_6e-5,
            2.010_334_399_292_288_1e-7,
        ],
    );
    let below = polynomial(
        r,
        [
            1.0,
            0.599_832_206_555_888,
            0.136_929_880_922_735_8,
            0.014_875_361_290_850_615,
            7.868_691_311_456_133e-4,
            1.846_318_317_510_054_8e-5,
            1.421_511_758_316_446e-7,
            2.044_263_103_389_939_8e-15,
        ],
    );
    above / below
}

/// Returns the standard normal quantile at 1/2 + `q`, |q| <= 0.425, to full relative precision about 0.
pub fn normal_quantile_near_median(q: f64) -> f64 {
    let r = 0.180_625 - q * q;
    let above = polynomial(
        r,
        [
            3.387_132_872_796_366_5,
            133.141_667_891_784_38,
            1_971.590_950_306_551_3,
            13_731.693_765_509_46,
            45_921.953_931_549_87,
            67_265.770_927_008_7,
            33_430.575_583_588_13,
            2_509.080_928_730_122_7,
        ],
    );
    let below = polynomial(
        r,
        [
            1.0,
            42.313_330_701_600_91,
            687.187_007_492_057_9,
            5_394.196_021_424_751,
            21_213.794_301_586_597,
            39_307.895_800_092_71,
            28_729.085_735_721_943,
            5_226.495_278_852_854,
        ],
    );
    q * above / below
}

fn polynomial(x: f64, coefficients: [f64; 8]) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

/// Degrees of freedom above which Student's t distribution is computed as a normal one of a transformed argument.
const LARGE_FREEDOM: f64 = 1e5;

/// Returns P(T > t) of Student's t distribution with `freedom` > 0 degrees of freedom (`f64::INFINITY` for the normal
/// distribution), to a relative error of about 1e-12.
pub fn t_above(t: f64, freedom: f64) -> f64 {
    if t < 0.0 {
        return 1.0 - t_above(-t, freedom);
    }
    if freedom.is_infinite() {
        return normal_below(-t);
    }
    if freedom > LARGE_FREEDOM {
        // Hill 1970, Communications of the ACM 13, algorithm 395: the next term is of the order of 1/f^3.
        let y = (freedom - 0.5) * libm::log1p(t * (t / freedom));
        let b = 48.0 * (freedom - 0.5) * (freedom - 0.5);
        let next = (((-0.4 * y - 3.3) * y - 24.0) * y - 85.5) / (0.8 * y * y + 100.0 + b);
        return normal_below(-(((next + y + 3.0) / b + 1.0) * y.sqrt()));
    }
    // 2 P(T > t) = I_x(f/2, 1/2) at x = f/(f + t^2) (Abramowitz and Stegun 1964, 26.7.1).
    let (a, square) = (freedom / 2.0, t * t);
    let (x, rest) = (freedom / (freedom + square), square / (freedom + square));
    if square.is_infinite() {
        // Only the first term of the series remains.
        return 0.5 * libm::exp(a * (libm::log(freedom) - 2.0 * libm::log(t))) * root_ratio(a) / (a * PI.sqrt());
    }
    // x^a (1 - x)^(1/2) / B(a, 1/2); log1p where x is nearly 1.
    let log_x = if rest < 0.5 { libm::log1p(-rest) } else { libm::log(x) };
    let front = libm::exp(a * log_x) * rest.sqrt() * root_ratio(a) / PI.sqrt();
    if x < (a + 1.0) / (a + 2.5) {
        0.5 * front * beta_fraction(x, a, 0.5, 1e-16) / a
    } else {
        0.5 - front * beta_fraction(rest, 0.5, a, 1e-16)
    }
}

/// Returns the t at which P(|T| > t) is `outside`, for Student's t distribution with `freedom` > 0 degrees of freedom;
/// infinity if it exceeds the range of `f64`.
pub fn t_quantile_outside(outside: f64, freedom: f64) -> f64 {
    let target = libm::log(outside / 2.0);
    // Newton on ln P(T > e^s), which falls and is concave: right of the root steps come nearer, none passes it.
    let mut s = libm::log(-normal_quantile(outside / 2.0));
    for _ in 0..200 {
        let t = libm::exp(s);
        if !t.is_finite() {
            break;
        }
        let above = t_above(t, freedom);
        let step = (libm::log(above) - target) * above / (t * t_density(t, freedom));
        s += step;
        if step.abs() < 1e-15 * s.abs().max(1.0) {
            break;
        }
    }
    libm::exp(s)
}

/// Returns the density of Student's t distribution.
fn t_density(t: f64, freedom: f64) -> f64 {
    if freedom.is_infinite() {
        return libm::exp(-0.5 * t * t) / (2.0 * PI).sqrt();
    }
    let power = libm::exp(-0.5 * (freedom + 1.0) * libm::log1p(t * t / freedom));
    root_ratio(freedom / 2.0) / (freedom * PI).sqrt() * power
}

/// Returns Gamma(a + 1/2) / Gamma(a): by the recurrence up to 20, then by the asymptotic series (Tricomi and Erdelyi
/// 1951, Pacific J. Math. 1), whose first omitted term is below 1e-16 there.
fn root_ratio(a: f64) -> f64 {
    let (mut factor, mut a) = (1.0, a);
    while a < 20.0 {
        factor *= a / (a + 0.5);
        a += 1.0;
    }
    let y = 1.0 / (a * a);
    let log = (-1.0 / 8.0 + y * (1.0 / 192.0 + y * (-1.0 / 640.0 + y * (17.0 / 14_336.0 - y * 31.0 / 18_432.0)))) / a;
    factor * a.sqrt() * libm::exp(log)
}

/// Evaluates the continued fraction of the incomplete beta function I_x(a, b) (Abramowitz and Stegun 1964, 26.5.8) up
/// to a relative change of less than `least_change`, by the modified Lentz algorithm (Press et al. 2007, Numerical
/// Recipes, section 6.4). About sqrt(a) terms are needed.
pub fn beta_fraction(x: f64, a: f64, b: f64, least_change: f64) -> f64 {
    let (mut c, mut d) = (1.0, 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0)));
    let mut value = d;
    for m in 1..100_000 {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / away_from_zero(1.0 + even * d);
        c = away_from_zero(1.0 + even / c);
        value *= d * c;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / away_from_zero(1.0 + odd * d);
        c = away_from_zero(1.0 + odd / c);
        let change = d * c;
        value *= change;
        if (change - 1.0).abs() < least_change {
            break;
        }
    }
    value
}

/// Returns `value`, or a tiny number in place of one near 0, by which Lentz's algorithm divides.
pub fn away_from_zero(value: f64) -> f64 {
    const TINY: f64 = 1e-300;
    if value.abs() < TINY { TINY } else { value }
}

#[cfg(test)]
#[path = "tests/special.rs"]
mod tests;
