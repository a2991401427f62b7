//! Generator matrices of nets made for pick-freeze designs, read from the embedded table.
//!
//! `examples/search_nets.rs` finds them and tells by which measure: a table for every number of factors d, of a pair of
//! matrices (A_i, B_i) for each factor. All matrices are upper triangular with a unit diagonal, so that every coordinate
//! is a (0, 1)-sequence in base 2 (Niederreiter 1987), as are those of the Sobol' sequence.
//!
//! The first 20 columns were searched for up to 12 factors, 16 for more: nets of 2^20 and of 2^16 points. Further columns are
//! those of the Sobol' sequence, which keep every coordinate a (0, 1)-sequence to 2^32 points.

use std::sync::OnceLock;

use super::joe_kuo::{Directions, directions};

/// Most factors for which there is a table. In a web page the first file has to do, since every byte is loaded.
pub const MAX_SEARCHED_FACTORS: usize = if cfg!(target_family = "wasm") { 32 } else { 64 };

/// Those of up to 32 factors, and those of more.
const TABLES: [&str; 2] = [
    include_str!("../../assets/pick-freeze/nets.32.txt"),
    if cfg!(target_family = "wasm") { "" } else { include_str!("../../assets/pick-freeze/nets.64.txt") },
];

/// The direction numbers of one factor in A and in B, bits reversed as in [`Directions`].
pub type Pair = [Directions; 2];

/// The tables of d = 1, 2, .., each read when it is first asked for: d pairs.
static READ: [OnceLock<Vec<Pair>>; MAX_SEARCHED_FACTORS + 1] = [const { OnceLock::new() }; MAX_SEARCHED_FACTORS + 1];

/// The pairs of a design of `factors` factors, one for each.
///
/// # Panics
/// If `factors` exceeds [`MAX_SEARCHED_FACTORS`]; [`crate::design::Design`] checks this before.
pub fn pairs(factors: usize) -> &'static [Pair] {
    assert!(factors <= MAX_SEARCHED_FACTORS, "at most {MAX_SEARCHED_FACTORS} factors");
    READ[factors].get_or_init(|| {
        let before = factors * factors.saturating_sub(1) / 2;
        lines().skip(before).take(factors).enumerate().map(|(i, line)| pair(line, [i, factors + i])).collect()
    })
}

/// A line for each factor of each number of them.
fn lines() -> impl Iterator<Item = &'static str> {
    TABLES.into_iter().flat_map(str::lines).filter(|line| !line.starts_with('#'))
}

/// A line of the table: d, and the bits above the diagonal of the two matrices in hexadecimal. Further columns are those
/// of `dimensions` of the Sobol' sequence.
fn pair(line: &str, dimensions: [usize; 2]) -> Pair {
    let mut matrices = line.split(' ').skip(1);
    dimensions.map(|dimension| {
        let digits = matrices.next().expect("the embedded table is complete");
        let bits = digits.chars().flat_map(|digit| {
            let four = digit.to_digit(16).expect("the embedded table is hexadecimal");
            (0..4).rev().map(move |place| four >> place & 1)
        });
        let bits: Vec<u32> = bits.collect();
        let continued = &directions(dimension + 1)[dimension];
        // Column k has k bits, after those of the columns before; the first place is the least significant bit.
        let searched = |k: usize| {
            let own = bits.get(k * k.saturating_sub(1) / 2..k * (k + 1) / 2)?;
            Some(own.iter().enumerate().fold(1 << k, |number, (place, bit)| number | bit << place))
        };
        std::array::from_fn(|k| searched(k).unwrap_or(continued[k]))
    })
}

#[cfg(test)]
mod tests;
