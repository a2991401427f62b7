use super::*;
use crate::space::Distribution;

/// Switches that are 1 with probability 1/4; rows have all combinations but the last `missing` ones.
fn unseen(values: u8, switches: usize, missing: usize, term: &Term, rest: f64, part: fn(usize) -> usize) -> f64 {
    let switch = Distribution::discrete(&[0.0, 1.0], Some(&[0.75, 0.25])).unwrap();
    let rows = (1 << switches) - missing;
    let of = |row: usize, factor: usize| if row >> factor & 1 == 1 { 0.9 } else { 0.1 };
    let columns: Vec<Vec<f64>> = (0..switches).map(|factor| (0..rows).map(|row| of(row, factor)).collect()).collect();
    let quantiles: Vec<&[f64]> = columns.iter().map(|u| &u[..]).collect();
    let outputs: Vec<f64> = (0..rows).map(|row| (row % usize::from(values)) as f64).collect();
    // Every combination is twice among the rows.
    let of_parts = |second: usize| (0..rows).map(|row| if second == 0 { 0 } else { part(row) }).collect();
    let rows = [0, 1].map(|second| Rows { quantiles: quantiles.clone(), outputs: &outputs, parts: of_parts(second) });
    unseen_combinations([(term, 0.1)].into_iter(), rest, &vec![Family::new(&switch); switches], &rows)
}

#[test]
fn combinations_that_no_row_has_are_wrong_by_the_rule_of_three_and_at_least_one() {
    let term = |factors: usize| (0..factors).map(|factor| (factor, 1)).collect::<Term>();
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
    // The square of the range, 2, counts.
    close(unseen(3, 3, 1, &term(3), 1e-4, |_| 0), 4.0 / 64.0);
    // Of 12 combinations in one part, at most a quarter contradicts the fit; the other 13 are in two parts.
    close(
        unseen(3, 5, 7, &term(5), 1e-4, |row| usize::from(row >= 12)),
        4.0 * PROBABILITY_OF_SEVEN * RULE_OF_THREE / 12.0,
    );
    // Nothing has been tested.
    close(unseen(3, 5, 7, &term(5), 1e-4, |_| 1), 4.0 * PROBABILITY_OF_SEVEN);
    // All factors matter for an output of two values.
    close(unseen(2, 3, 1, &term(1), 1e-4, |_| 0), 1.0 / 64.0);
    for (missing, factors, rest) in [(0, 3, 1e-4), (1, 2, 1e-4), (1, 3, 0.1)] {
        assert_eq!(unseen(3, 3, missing, &term(factors), rest, |_| 0), 0.0);
    }
}

/// That of 11001 to 11111 in binary digits.
const PROBABILITY_OF_SEVEN: f64 = (3.0 * 9.0 + 3.0 * 3.0 + 1.0) / 1024.0;
