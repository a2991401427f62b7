//! Which factor leads, as the documents say it.

use apportion::result::PairRecord;
use apportion::uncertainty::{Estimate, Interval};
use apportion_report::run_document;

use super::{between, of_factors, tables};

/// A total index, and the probability that it is the largest.
type Contender = (Estimate, Option<f64>);

/// The factors that the first sentence calls the most important, by their numbers, the largest first.
fn leaders(contenders: &[Contender]) -> Vec<usize> {
    let mut result = of_factors(contenders.len());
    for (index, (total, probability)) in result.outputs[0].indices.iter_mut().flatten().zip(contenders) {
        (index.effect.total, index.effect.probability_first) = (*total, *probability);
    }
    let lead = &run_document(&result).lead[0];
    let (sentence, _) = lead.split_once(" Next ").unwrap_or((lead, ""));
    let number = |text: &str| -> usize { text.rsplit_once('x').unwrap().1.parse().unwrap() };
    let numbers: Vec<usize> = match sentence.split_once("by the total index S_T: ") {
        Some((_, tied)) => tied.rsplit(" (").skip(1).map(number).collect(),
        None => vec![number(sentence.split_once(" matters most").unwrap().0)],
    };
    numbers.into_iter().rev().map(|number| number - 1).collect()
}

#[test]
fn a_tie_has_no_winner() {
    let tie = [(between(0.4, 0.6), Some(0.45)), (between(0.42, 0.6), Some(0.53)), (between(0.0, 0.1), Some(0.02))];
    assert_eq!(leaders(&tie), [1, 0]);
    let mut unknown = tie;
    unknown.iter_mut().for_each(|(_, probability)| *probability = None);
    assert_eq!(leaders(&unknown), [1, 0]);
    unknown.iter_mut().for_each(|(total, _)| total.interval = None);
    assert_eq!(leaders(&unknown), [1]);
    // Not certain, and no other one is likely: the next one.
    assert_eq!(leaders(&[(between(0.5, 0.6), Some(0.93)), (between(0.4, 0.5), Some(0.04))]), [0, 1]);
}

#[test]
fn none_outside_a_tie_has_a_larger_estimate_than_one_inside() {
    let contenders: [Contender; 4] = [
        (between(1.0, 2.0), Some(0.9)),
        (between(0.5, 1.5), Some(0.01)),
        (between(0.2, 0.8), Some(0.07)),
        (between(0.0, 0.1), Some(0.0)),
    ];
    assert_eq!(leaders(&contenders), [0, 1, 2]);
    // By intervals: that of the second is below, that of the third is not.
    let mut by_interval = contenders;
    by_interval.iter_mut().for_each(|(_, probability)| *probability = None);
    for ((total, _), high) in by_interval[1..].iter_mut().zip([0.99, 1.2]) {
        total.interval = total.interval.map(|interval| Interval { high, ..interval });
    }
    assert_eq!(leaders(&by_interval), [0, 1, 2]);
}

#[test]
fn one_of_many_interactions_is_chance() {
    let mut result = of_factors(2);
    let mut seen = |pairs: &[Estimate]| -> Vec<String> {
        let record =
            |(k, index): (usize, &Estimate)| PairRecord { factors: [format!("x{k}"), "z".to_owned()], index: *index };
        result.outputs[0].second_order = Some(pairs.iter().enumerate().map(record).collect());
        let page = run_document(&result);
        let tables = tables(&page, "interactions");
        let table = tables.iter().find(|table| table.caption.starts_with("Second-order indices")).unwrap();
        table.rows.iter().map(|row| row[1].text.clone()).collect()
    };
    let pairs = |number: usize| -> Vec<Estimate> {
        // Twice its half width from 0, and at 1.2 half widths.
        (0..number).map(|k| if k == 0 { between(0.01, 0.03) } else { between(0.002, 0.022) }).collect()
    };
    assert_eq!(seen(&pairs(2)), ["yes", "yes"]);
    // 45 pairs require 3.26 standard errors; at 435 pairs there are 3.86.
    assert_eq!(seen(&pairs(45))[..2], ["yes", "may be chance: one of many pairs"]);
    assert_eq!(seen(&pairs(435))[0], "yes");
    assert_eq!(seen(&[Estimate::alone(0.5), between(0.2, 0.2)]), ["unknown", "yes"]);
}
