use proptest::prelude::*;

use super::*;

fn tally(point: u64) -> Tally {
    Tally { count: 1, first: RowPosition { replicate: 0, point, run: 0 } }
}

fn counted(reasons: &[(u64, String)]) -> Failures {
    let mut failures = Failures::default();
    reasons.iter().for_each(|(point, reason)| failures.count(&RowFailure::new(reason), tally(*point)));
    failures
}

#[test]
fn reasons_with_numbers_in_them_are_one() {
    let reasons = |count: u64| -> Vec<(u64, String)> {
        (0..count).map(|k| (k, format!("no root at t = {}.5, x = -{k}e-3", k * k))).collect()
    };
    let few = counted(&reasons(MAX_REASONS as u64));
    assert_eq!(few.iter().count(), MAX_REASONS);
    let many = counted(&reasons(100_000));
    let listed: Vec<_> = many.iter().map(|(reason, tally)| (reason.to_string(), tally.count)).collect();
    assert_eq!(listed, [("no root at t = #, x = #".to_owned(), 100_000)]);
    assert_eq!(many.first().unwrap().1.first.point, 0);
}

#[test]
fn only_the_first_reasons_are_counted_separately() {
    let word = |k: u32| [k / 26 % 26, k % 26].map(|place| char::from(b'a' + place as u8)).iter().collect::<String>();
    let all = counted(&(0..300).rev().map(|k| (u64::from(k), word(k))).collect::<Vec<_>>());
    let listed: Vec<_> = all.iter().collect();
    assert_eq!(listed.len(), MAX_REASONS + 1);
    assert!(listed[..MAX_REASONS].iter().enumerate().all(|(k, (reason, _))| reason.to_string() == word(k as u32)));
    assert_eq!(
        (listed[100].0.to_string().as_str(), listed[100].1.count, listed[100].1.first.point),
        (OTHERS, 200, 100)
    );
}

proptest! {
    /// The result does not depend on where failures are counted, or on the order of merging.
    #[test]
    fn the_order_does_not_count(
        reasons in prop::collection::vec("[ab\u{1}#-]{0,2}[0-9]{1,2}[cd]{0,3}", 0..400),
        parts in prop::collection::vec(0_usize..5, 400),
    ) {
        let reasons: Vec<(u64, String)> = (0..).zip(reasons).collect();
        let all = counted(&reasons);
        let of_part = |part: usize| {
            counted(&reasons.iter().filter(|(k, _)| parts[*k as usize] == part).cloned().collect::<Vec<_>>())
        };
        for order in [[0, 1, 2, 3, 4], [4, 2, 0, 1, 3]] {
            let mut merged = Failures::default();
            order.iter().for_each(|part| merged.merge(&of_part(*part)));
            prop_assert_eq!(&merged, &all);
        }
    }
}
