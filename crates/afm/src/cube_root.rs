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
#[path = "tests/cube_root.rs"]
mod tests;
