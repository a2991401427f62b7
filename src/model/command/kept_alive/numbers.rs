//! Numbers of rows: what a program writes back before its answer.
//!
//! They are six digits, which all languages print in full, and do not count up: the lines that a program prints about its
//! own steps (`1,0.5`, `2,0.25`) are taken for no answer, and a program that counts rows by itself is found out.

/// As many numbers there are; of so many rows in a row no two have the same.
const MANY: u64 = 900_000;
const LEAST: u64 = 100_000;
/// Has no divisor in common with `MANY`, and has the inverse below.
const STEP: u64 = 611_953;
const INVERSE: u64 = inverse(STEP);

const fn inverse(step: u64) -> u64 {
    // By Euclid's algorithm: r = t * step modulo MANY.
    let (mut t, mut next_t, mut r, mut next_r) = (0i64, 1i64, MANY as i64, step as i64);
    while next_r != 0 {
        let quotient = r / next_r;
        (t, next_t) = (next_t, t - quotient * next_t);
        (r, next_r) = (next_r, r - quotient * next_r);
    }
    assert!(r == 1);
    t.rem_euclid(MANY as i64) as u64
}

/// The number of the `count`th row that a process gets, from 0.
pub(super) fn number_of(count: usize) -> u64 {
    LEAST + (count as u64 + 1) % MANY * STEP % MANY
}

/// Which of the first `sent` rows has that number; the last if there are several.
pub(super) fn count_of(number: u64, sent: usize) -> Option<usize> {
    let residue = number.checked_sub(LEAST).filter(|rest| *rest < MANY)? * INVERSE % MANY;
    // The largest count + 1 of that residue which is no more than `sent`.
    let back = (sent as u64 % MANY + MANY - residue) % MANY;
    (sent as u64).checked_sub(back + 1).map(|count| count as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_found_by_their_numbers() {
        for sent in [1, 2, 1000, 899_999, 900_000, 900_001, 2_000_000] {
            for count in [0, 1, sent / 2, sent - 1].into_iter().filter(|c| *c < sent && sent - c <= 900_000) {
                let number = number_of(count);
                assert!((100_000..1_000_000).contains(&number));
                assert_eq!(count_of(number, sent), Some(count), "{number} of {sent}");
            }
            assert_eq!(sent >= 900_000, count_of(number_of(sent), sent).is_some(), "one that has not been sent");
        }
        for strange in [0, 1, 99_999, 1_000_000, u64::MAX] {
            assert_eq!(count_of(strange, 1_000_000), None);
        }
        assert_eq!(count_of(number_of(0), 0), None);
    }

    #[test]
    fn numbers_of_neighbours_are_far_apart() {
        for count in 0..10_000 {
            assert!(number_of(count).abs_diff(number_of(count + 1)) > 1000);
        }
    }
}
