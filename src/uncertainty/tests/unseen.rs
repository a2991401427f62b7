use super::*;
use crate::estimate::{BlockOutputs, Workspace};

fn moments(a: &[f64], b: &[f64], ab: &[&[f64]]) -> Moments {
    Moments::of_block(BlockOutputs { a, b, ab, ..BlockOutputs::default() }, &mut Workspace::default())
}

#[test]
fn only_a_factor_that_is_not_read_is_without_effect() {
    let (a, b) = ([0.0, 1.0, 0.0, 1.0], [1.0, 1.0, 0.0, 0.0]);
    let moments = moments(&a, &b, &[&b, &a]);
    let layout = Layout::plain(2);
    let values = crate::estimate::quantities(&layout, &moments).unwrap();
    let of_rows = unseen(&layout, &moments, &values, &[]);
    // No row shows the second factor, nor excludes it.
    assert_eq!(of_rows.effects[1].total.half_width, 1.0);
    assert_eq!(of_rows.effects[1].interaction, of_rows.effects[1].total);
    let unseen = unseen(&layout, &moments, &values, &[false, true]);
    let of = |factor: usize| unseen.effects[factor].first_order;
    // R^2/V = 4, and fewer than 3 of 4 rows: no bound but that of an index.
    assert_eq!(of(0).half_width, 1.0);
    assert_eq!(of(1), Unseen::NONE);
    assert!(of(0).applies(&vec![vec![1e-16, -1e-16]; 2]) && !of(0).applies(&vec![vec![1e-3, 0.0]; 2]));
    assert!(!of(1).applies(&vec![vec![0.0; 2]; 2]));
    // The only factor with an effect has all of the share.
    assert_eq!(unseen.effects[0].shares.first_order, Unseen::NONE);
}

#[test]
fn a_sample_without_the_large_outputs_has_seen_half() {
    let (flat, peak) = ([0.0, 0.1, 0.0, 0.1], [0.0, 9.0, 0.0, 0.1]);
    assert!(half_seen(&moments(&peak, &flat, &[&flat]), 0));
    assert!(!half_seen(&moments(&flat, &peak, &[&peak]), 0));
    assert!(!half_seen(&moments(&peak, &peak, &[&peak]), 0));
}
