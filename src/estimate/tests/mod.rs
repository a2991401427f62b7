//! Samples for the tests of this module, and the tests that concern all of it.

use super::*;

mod exact;
mod failures;
mod invariance;
mod textbook;

/// Outputs of one swap with rows BA, and of another one for pairs.
#[derive(Clone)]
struct Sample {
    a: Vec<f64>,
    b: Vec<f64>,
    ab: [Vec<f64>; 2],
    ba: [Vec<f64>; 2],
}

impl Sample {
    /// `n` base points of columns with arbitrary correlations, with `offset`.
    fn noise(n: usize, offset: f64) -> Self {
        let raw: Vec<Vec<f64>> = (1..=6).map(|salt| noise(n, salt)).collect();
        let column = |own: usize, shared: &[usize]| -> Vec<f64> {
            (0..n).map(|i| raw[own][i] + 0.7 * shared.iter().map(|&k| raw[k][i]).sum::<f64>() + offset).collect()
        };
        Self {
            a: column(0, &[]),
            b: column(1, &[]),
            ab: [column(2, &[0]), column(3, &[0, 1])],
            ba: [column(4, &[1]), column(5, &[1, 0])],
        }
    }

    fn columns(&mut self) -> Vec<&mut Vec<f64>> {
        let Self { a, b, ab, ba } = self;
        [a, b].into_iter().chain(ab).chain(ba).collect()
    }

    fn map(&self, f: impl Fn(f64) -> f64) -> Self {
        let mut mapped = self.clone();
        mapped.columns().into_iter().flatten().for_each(|y| *y = f(*y));
        mapped
    }

    fn part(&self, range: std::ops::Range<usize>) -> Self {
        let mut part = self.clone();
        part.columns().into_iter().for_each(|column| *column = column[range.clone()].to_vec());
        part
    }

    fn moments(&self) -> Moments {
        let [ab, ba] = [&self.ab, &self.ba].map(|s| [&s[0][..], &s[1][..]]);
        let block = BlockOutputs { a: &self.a, b: &self.b, ab: &ab, ba: &ba, paired: &[0, 1] };
        Moments::of_block(block, &mut Workspace::default())
    }
}

/// Deterministic numbers without structure, about 0 with spread 1.
fn noise(n: usize, salt: u64) -> Vec<f64> {
    let mut x = salt.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let next = || {
        x ^= x << 13;
        x ^= x >> 7;
        x ^= x << 17;
        (x >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    std::iter::repeat_with(next).take(n).collect()
}

/// Every index of `moments` by every estimator, with the estimator's name.
fn everything(moments: &Moments) -> Vec<(String, f64)> {
    let mut all = Vec::new();
    for swap in 0..moments.swaps() {
        for estimator in FirstOrder::ALL {
            all.push((format!("S{swap} {}", estimator.name()), estimator.estimate(moments, swap)));
        }
        for estimator in Total::ALL {
            all.push((format!("ST{swap} {}", estimator.name()), estimator.estimate(moments, swap)));
        }
    }
    all.push(("S01".to_owned(), second_order(moments, 0, 1)));
    all
}

#[track_caller]
fn assert_close(got: &[(String, f64)], expected: &[(String, f64)], tolerance: f64) {
    assert_eq!(got.len(), expected.len());
    for ((name, got), (_, expected)) in got.iter().zip(expected) {
        assert!((got - expected).abs() <= tolerance, "{name}: {got} is not {expected}");
    }
}

#[test]
fn names_are_unique_and_sources_are_given() {
    let unique = |names: Vec<&str>| names.iter().collect::<std::collections::BTreeSet<_>>().len() == names.len();
    assert!(unique(FirstOrder::ALL.map(FirstOrder::name).to_vec()));
    assert!(unique(Total::ALL.map(Total::name).to_vec()));
    assert!(unique(Estimator::ALL.map(Estimator::name).to_vec()));
    assert!(FirstOrder::ALL.iter().all(|estimator| estimator.source().contains(char::is_numeric)));
    assert!(Total::ALL.iter().all(|estimator| estimator.source().contains(char::is_numeric)));
}

#[test]
fn estimators_of_a_name_run_on_the_design_of_that_name() {
    for estimator in Estimator::ALL {
        for has_ba in [estimator.needs_ba(), true] {
            let (first_order, total) = estimator.formulas();
            let first_order = first_order.unwrap_or(FirstOrder::default_for(has_ba));
            let total = total.unwrap_or(Total::default_for(has_ba));
            assert!(has_ba || !first_order.needs_ba() && !total.needs_ba(), "{estimator:?}");
        }
    }
}

#[test]
fn an_estimator_gives_an_index_exactly_if_it_has_the_rows_that_it_needs() {
    let sample = Sample::noise(50, 0.0);
    let [ab, ba] = [&sample.ab, &sample.ba].map(|rows| [&rows[0][..], &rows[1][..]]);
    for has_ba in [false, true] {
        let ba = if has_ba { &ba[..] } else { &[] };
        let block = BlockOutputs { a: &sample.a, b: &sample.b, ab: &ab, ba, ..BlockOutputs::default() };
        let moments = Moments::of_block(block, &mut Workspace::default());
        assert_eq!(moments.has_ba(), has_ba);
        for first_order in FirstOrder::ALL {
            let served = has_ba || !first_order.needs_ba();
            assert_eq!(first_order.estimate(&moments, 1).is_finite(), served, "{first_order:?}");
        }
        for total in Total::ALL {
            let served = has_ba || !total.needs_ba();
            assert_eq!(total.estimate(&moments, 1).is_finite(), served, "{total:?}");
        }
    }
}
