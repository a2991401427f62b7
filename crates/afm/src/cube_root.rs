//! The cube root by arithmetic alone, so that the compiler can vectorise it, and every machine computes the same bits.

/// Returns the cube root of `x` >= 0, within one unit in the last place; NaN of NaN.
///
/// As in FreeBSD's `s_cbrt.c` (Kahan 1991; Evans): a third of the exponent, a polynomial to 23 bits, one step of
/// Newton's method. There are no branches.
#[inline(always)]
pub(super) fn cube_root(x: f64) -> f64 {
    const TWO_54: f64 = (1u64 << 54) as f64;
    // (1023 - 1023/3 - 0.03306235651) 2^20, and the same less 54/3 exponents.
    const NORMAL: u32 = 715_094_163;
    const SUBNORMAL: u32 = 696_219_795;
    let (scaled, bias) = if x < f64::MIN_POSITIVE { (x * TWO_54, SUBNORMAL) } else { (x, NORMAL) };
    let third = ((scaled.to_bits() >> 32) as u32 & 0x7fff_ffff) / 3;
    let t = f64::from_bits(u64::from(third.wrapping_add(bias)) << 32);
    // 1/cbrt(r) for r = t^3/x.
    let r = (t * t) * (t / x);
    let low = 1.875_951_824_271_77 + r * (-1.884_979_795_433_771_7 + r * 1.621_429_720_105_354_5);
    let high = (r * r) * r * (-0.758_397_934_778_766 + r * 0.145_996_192_886_612_45);
    let t = t * (low + high);
    // To 23 bits, so that t^2 is exact.
    let t = f64::from_bits((t.to_bits() + 0x8000_0000) & 0xffff_ffff_c000_0000);
    let r = x / (t * t);
    let root = t + t * ((r - t) / (t + t + r));
    if x > 0.0 && x < f64::INFINITY { root } else { x }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn cubes_have_exact_roots() {
        for root in [0.0, 1e-100, 0.25, 1.0, 2.0, 3.0, 101.0, 2.0_f64.powi(-340), 2.0_f64.powi(341)] {
            let cube: f64 = root * root * root;
            assert!((cube_root(cube) - root).abs() <= 2.0 * f64::EPSILON * root, "{root}");
        }
        for x in [8.0, 27.0, 1e6, 2.0_f64.powi(-1074), 2.0_f64.powi(1020)] {
            assert_eq!(cube_root(x), libm::cbrt(x), "{x}");
        }
    }

    #[test]
    fn the_ends_of_the_range() {
        assert_eq!(cube_root(0.0), 0.0);
        assert_eq!(cube_root(f64::INFINITY), f64::INFINITY);
        assert!(cube_root(f64::NAN).is_nan());
    }

    proptest! {
        /// One unit in the last place from the library's root, which is itself rounded.
        #[test]
        fn agrees_with_the_library(x in any::<f64>()) {
            let x = x.abs();
            let (own, library) = (cube_root(x), libm::cbrt(x));
            prop_assert!(own == library || (own - library).abs() <= 2.0 * f64::EPSILON * library || x.is_nan());
        }
    }
}
