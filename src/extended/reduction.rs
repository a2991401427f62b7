//! Angles of any size, reduced to an eighth of a turn (Payne and Hanek 1983).

use super::Extended;

/// The bits of 2/pi, 32 to a word: as many as the largest double takes.
const TWO_OVER_PI: [u32; 44] = [
    0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab, 0xdebbc561, 0xb7246e3a,
    0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e, 0xe88235f5, 0x2ebb4484, 0xe99c7026, 0xb45f7e41,
    0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b, 0x1ff897ff, 0xde05980f, 0xef2f118b, 0x5a0a6d1f, 0x6d367ecf,
    0x27cb09b7, 0x4f463f66, 0x9e5fea2d, 0x7527bac7, 0xebe5f17b, 0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08,
    0x56033046, 0xfc7b6bab, 0xf0cfbc20, 0x9af4361d, 0xa9e39161, 0x5ee61b08, 0x6599855f, 0x14a06840,
];

/// Bits of 2/pi that are multiplied: those of the angle, of the result, and some that cancel.
const WINDOW: i64 = 288;

/// Largest exponent of an angle whose bits of 2/pi are all there.
const LARGEST_EXPONENT: i64 = 44 * 32 - WINDOW;

/// Words of the product: 107 bits of the angle, 288 of 2/pi.
const WORDS: usize = 13;

/// `x` as a quarter of a turn (0 to 3) and a rest between -pi/4 and pi/4; not a number beyond the largest double.
pub(super) fn reduced(x: Extended) -> (u32, Extended) {
    if x.is_zero() || x.exponent < 0 {
        return (0, x);
    }
    if !x.is_finite() || x.exponent > LARGEST_EXPONENT {
        return (0, Extended::NAN);
    }
    let (quarter, rest) = of_positive(x.abs());
    if x.is_negative() { (quarter.wrapping_neg() & 3, -rest) } else { (quarter, rest) }
}

fn of_positive(x: Extended) -> (u32, Extended) {
    // x = m 2^e, m whole.
    let scale = |part: f64, bits: i32| part * libm::exp2(f64::from(bits));
    let m = (scale(x.high, 53) as i128) * (1 << 54) + scale(x.low, 107).floor() as i128;
    let e = x.exponent - 107;
    // Bits of 2/pi that make multiples of 4 are passed over.
    let first = (e - 2).max(0);
    let mut product = [0_u32; WORDS];
    for place in 0..4 {
        let factor = (m >> (32 * place)) as u128 & 0xffff_ffff;
        let mut carry = 0_u128;
        for word in 0..WORDS - place {
            let bits = u128::from(window(first, word));
            let sum = u128::from(product[word + place]) + factor * bits + carry;
            product[word + place] = sum as u32;
            carry = sum >> 32;
        }
    }
    // x 2/pi = product 2^-shift.
    let shift = first + WINDOW - e;
    let at =
        |bit: i64| if (0..32 * WORDS as i64).contains(&bit) { product[bit as usize / 32] >> (bit % 32) & 1 } else { 0 };
    let quarter = at(shift) + 2 * at(shift + 1);
    let is_upper = at(shift - 1) == 1;
    // The first 150 bits of the fraction after those that cancel, of the fraction less 1 if it is a half or more.
    let lead = u32::from(is_upper);
    let Some(start) = (0..shift).rev().find(|bit| at(*bit) != lead) else { return (quarter, Extended::ZERO) };
    let mut rest = Extended::ZERO;
    for bit in (start - 150..=start).rev().filter(|bit| at(*bit) != lead) {
        rest = rest + Extended::ONE.times_power_of_two(bit - shift);
    }
    if is_upper {
        ((quarter + 1) & 3, -rest * Extended::PI.times_power_of_two(-1))
    } else {
        (quarter, rest * Extended::PI.times_power_of_two(-1))
    }
}

/// Word number `word`, the least first, of the bits of 2/pi from bit `first` after the point on.
fn window(first: i64, word: usize) -> u32 {
    if word >= WINDOW as usize / 32 {
        return 0;
    }
    let bit = first as usize + WINDOW as usize - 32 * (word + 1);
    let (place, offset) = (bit / 32, bit % 32);
    let pair = u64::from(TWO_OVER_PI[place]) << 32 | u64::from(TWO_OVER_PI.get(place + 1).copied().unwrap_or(0));
    (pair >> (32 - offset)) as u32
}
