use super::*;

fn runs(factors: usize, swaps: &[&[usize]], ba: bool) -> Runs {
    let swaps = swaps.iter().map(|swap| swap.to_vec()).collect();
    Runs::new(&Rows { swaps, ba, ..Rows::default() }, factors)
}

/// Returns the row of a kind, column by column, from its definition.
fn definition(kind: RowKind, factors: usize, swaps: &[&[usize]]) -> Vec<Matrix> {
    use Matrix::{A, B};
    let mixed = |base, swap: usize, from| {
        (0..factors).map(|column| if swaps[swap].contains(&column) { from } else { base }).collect()
    };
    match kind {
        RowKind::A => vec![A; factors],
        RowKind::B => vec![B; factors],
        RowKind::Ab(s) => mixed(A, s, B),
        RowKind::Ba(s) => mixed(B, s, A),
    }
}

fn made(run: &Run, factors: usize) -> Vec<Matrix> {
    (0..factors).map(|column| if run.columns.contains(&column) { run.from } else { run.base }).collect()
}

#[test]
fn every_row_is_answered_by_a_run_of_the_same_point_and_no_two_runs_are_the_same() {
    let cases: [(usize, &[&[usize]]); 7] = [
        (1, &[&[0]]),
        (2, &[&[0], &[1]]),
        (3, &[&[0], &[1], &[2], &[1], &[2, 0], &[0, 1, 2]]),
        (4, &[&[0], &[1], &[2], &[3], &[0, 1], &[3, 2], &[2, 2, 1, 3]]),
        (2, &[&[0, 1], &[1, 0, 1]]),
        (5, &[&[0, 1, 2], &[3, 4]]),
        (6, &[&[0, 1, 2], &[3, 4, 5]]),
    ];
    for (factors, swaps) in cases {
        for ba in [false, true] {
            let runs = runs(factors, swaps, ba);
            let all: Vec<Vec<Matrix>> = runs.runs.iter().map(|run| made(run, factors)).collect();
            for (number, point) in all.iter().enumerate() {
                assert!(!all[..number].contains(point), "{factors} {swaps:?}: run {number} is repeated");
            }
            let kinds: [fn(usize) -> RowKind; 2] = [RowKind::Ab, RowKind::Ba];
            for (numbers, kind) in [&runs.ab, &runs.ba].into_iter().zip(kinds) {
                for (swap, &number) in numbers.iter().enumerate() {
                    assert_eq!(all[number], definition(kind(swap), factors, swaps), "{:?}", kind(swap));
                }
            }
        }
    }
}

#[test]
fn a_dummy_factor_is_run_again() {
    let runs = runs(2, &[&[0], &[1], &[], &[]], true);
    // A, B; AB_0, AB_1, two dummies; BA_0 is AB_1 and BA_1 is AB_0, two dummies.
    assert_eq!(runs.runs.len(), 2 + 4 + 2);
    assert_eq!(made(&runs.runs[runs.ab[2]], 2), [Matrix::A; 2]);
    assert_ne!(runs.ab[2], runs.ab[3]);
    assert_eq!(made(&runs.runs[runs.ba[3]], 2), [Matrix::B; 2]);
}
