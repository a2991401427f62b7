//! Direction numbers of the Sobol' sequence: Joe and Kuo's set `new-joe-kuo-6`, read from the embedded table.

use std::sync::LazyLock;

/// Number of dimensions in the embedded tables (the first one is van der Corput's sequence and needs no entry). A web
/// page has only the first table, since every byte is downloaded.
pub const MAX_DIMENSIONS: usize = if cfg!(target_family = "wasm") { 1024 } else { 4096 };

/// Bits of a coordinate, and so the number of direction numbers per dimension: 2^32 distinct points.
pub const BITS: usize = 32;

/// Dimensions 2 to 1024, and those that follow.
const TABLES: [&str; 2] = [
    include_str!("../../assets/joe-kuo/new-joe-kuo-6.1024.txt"),
    if cfg!(target_family = "wasm") { "" } else { include_str!("../../assets/joe-kuo/new-joe-kuo-6.4096.txt") },
];

/// Direction numbers of one dimension, bits reversed: entry `k` is XORed into the coordinate when bit `k` of the
/// point's index is set. The least significant bit of an entry has the value 1/2, as the scramble requires.
pub type Directions = [u32; BITS];

/// Dimensions that suffice for most studies, so that a short run does not read thousands of them.
const FIRST_DIMENSIONS: usize = 128;

/// The first dimensions and all dimensions, each read once per program.
static FIRST: LazyLock<Vec<Directions>> = LazyLock::new(|| read(FIRST_DIMENSIONS));
static ALL: LazyLock<Vec<Directions>> = LazyLock::new(|| read(MAX_DIMENSIONS));

fn read(dimensions: usize) -> Vec<Directions> {
    let van_der_corput = std::array::from_fn(|k| 1 << (BITS - 1 - k));
    let lines = TABLES.into_iter().flat_map(str::lines).filter(|line| !line.starts_with('#'));
    let all = std::iter::once(van_der_corput).chain(lines.map(from_line));
    all.take(dimensions).map(|v| v.map(u32::reverse_bits)).collect()
}

/// Returns the direction numbers of the first `dimensions` dimensions, in order.
///
/// Recurrence: Bratley and Fox (1988), ACM TOMS 14, 88-100, eq. (2), with the polynomials and initial numbers of
/// Joe and Kuo (2008), SIAM J. Sci. Comput. 30, 2635-2654.
///
/// # Panics
/// If `dimensions` exceeds [`MAX_DIMENSIONS`]; [`crate::design::Design`] checks this first.
pub fn directions(dimensions: usize) -> &'static [Directions] {
    assert!(dimensions <= MAX_DIMENSIONS, "at most {MAX_DIMENSIONS} dimensions");
    if dimensions <= FIRST_DIMENSIONS { &FIRST[..dimensions] } else { &ALL[..dimensions] }
}

/// Reads direction numbers before bit reversal: the most significant bit of an entry has the value 1/2.
fn from_line(line: &str) -> Directions {
    let numbers = line.split(' ').map(|n| n.parse::<u32>().expect("the embedded table holds whole numbers"));
    let numbers: Vec<u32> = numbers.collect();
    let (s, a, initial) = (numbers[1] as usize, numbers[2], &numbers[3..]);
    let mut v = [0; BITS];
    for (k, number) in initial[..s].iter().enumerate() {
        v[k] = number << (BITS - 1 - k);
    }
    for k in s..BITS {
        v[k] = v[k - s] ^ (v[k - s] >> s);
        for l in 1..s {
            if a >> (s - 1 - l) & 1 == 1 {
                v[k] ^= v[k - l];
            }
        }
    }
    v
}

#[cfg(test)]
#[path = "tests/joe_kuo.rs"]
mod tests;
