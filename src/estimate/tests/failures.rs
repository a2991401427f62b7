//! The effect of failed runs: their own swap loses a base point, and the others none.

use super::textbook::textbook;
use super::*;

fn of_swap(all: &[(String, f64)], swap: usize) -> Vec<(String, f64)> {
    let own = |name: &str| name.starts_with(&format!("S{swap} ")) || name.starts_with(&format!("ST{swap} "));
    all.iter().filter(|(name, _)| own(name)).cloned().collect()
}

#[test]
fn a_failed_row_of_one_swap_leaves_the_others_in_every_bit() {
    let sample = Sample::noise(100, 2.0);
    let plain = everything(&sample.moments());
    for column in [2, 4] {
        let mut failed = sample.clone();
        failed.columns()[column][17] = f64::INFINITY;
        let moments = failed.moments();
        assert_eq!(
            [moments.count(), moments.fewest(), moments.swap(0).base.n, moments.swap(1).base.n],
            [100, 99, 99, 100]
        );
        assert_eq!(of_swap(&everything(&moments), 1), of_swap(&plain, 1), "column {column}");
        assert_ne!(of_swap(&everything(&moments), 0), of_swap(&plain, 0), "column {column}");
    }
}

#[test]
fn an_index_is_estimated_from_the_base_points_at_which_its_rows_succeeded() {
    let mut sample = Sample::noise(200, 1.0);
    // A of one point, B of another, AB_0 of a third, BA_1 of a fourth.
    for (column, row) in [(0, 3), (1, 20), (2, 77), (5, 199)] {
        sample.columns()[column][row] = f64::NAN;
    }
    let moments = sample.moments();
    assert_eq!([moments.count(), moments.fewest()], [198, 197]);
    for (swap, lost) in [(0, [3, 20, 77]), (1, [3, 20, 199])] {
        let mut kept = sample.clone();
        for column in kept.columns() {
            *column = column.iter().enumerate().filter(|(row, _)| !lost.contains(row)).map(|(_, y)| *y).collect();
        }
        // The rows of the other swap that failed are elsewhere, except for those that the textbook formula cannot handle.
        let kept = kept.map(|y| if y.is_finite() { y } else { 0.0 });
        let mut expected = textbook(&kept);
        for ((name, _), own) in everything(&moments).iter().zip(&mut expected) {
            own.0.clone_from(name);
        }
        assert_close(&of_swap(&everything(&moments), swap), &of_swap(&expected, swap), 1e-12);
    }
    let pairs = moments.pairs().unwrap();
    // E_0 D_1 lacks only the points of A and B; E_1 D_0 those of BA_1 and AB_0 too.
    assert_eq!((pairs.mean(0, 1).unwrap().1, pairs.mean(1, 0).unwrap().1), (198, 196));
    let kept = (0..200).filter(|row| ![3, 20, 77, 199].contains(row));
    let products = kept.map(|i| (sample.ba[1][i] - sample.b[i]) * (sample.ab[0][i] - sample.a[i]));
    assert!((pairs.mean(1, 0).unwrap().0 - products.sum::<f64>() / 196.0).abs() < 1e-14);
}

#[test]
fn a_swap_that_always_fails_is_no_index_and_a_constant_remainder_has_no_variance() {
    let mut sample = Sample::noise(50, 0.0);
    sample.ab[1].fill(f64::NAN);
    let moments = sample.moments();
    assert_eq!((moments.count(), moments.fewest()), (50, 0));
    assert_eq!(Indices::from_moments(&moments), Err(Undefined::NoRuns));
    // A and B vary, but not where the rows of swap 0 succeeded.
    let mut sample = Sample::noise(50, 0.0);
    sample.ab[0][4..].fill(f64::NAN);
    sample.a[..4].fill(0.1);
    sample.b[..4].fill(0.1);
    assert_eq!(Indices::from_moments(&sample.moments()), Err(Undefined::ZeroVariance));
}

#[test]
fn outputs_whose_differences_overflow_have_no_indices() {
    let sample = Sample::noise(64, 0.0).map(|y| if y > 0.0 { f64::MAX } else { -f64::MAX });
    assert_eq!(Indices::from_moments(&sample.moments()), Err(Undefined::Unrepresentable));
}
