//! The values of one output, and the surrogate fitted to them.

use apportion::result::{OutputResult, SurrogateRecord};
use apportion::uncertainty::{Estimate, Interval, NamedTerm};

use super::tables::FACTORS_OF_ESTIMATORS;
use crate::document::{Part, Table};
use crate::format::{among_with_unit, grouped, index_with_unit, minus, name, printed, significant, value};
use crate::leading::by_total;

/// Quantiles in the table, in percent; the JSON file has more.
const QUANTILES: [f64; 7] = [2.5, 5.0, 25.0, 50.0, 75.0, 95.0, 97.5];
/// Share of the variance, in percent, below which a term of a surrogate is not shown.
const MIN_TERM_SHARE: f64 = 0.01;

/// Tabulates moments and quantiles of an output's values.
pub(super) fn moments(output: &OutputResult) -> Option<Part> {
    let record = output.distribution.as_ref()?;
    let number = |x: f64| minus(&among_with_unit(x, record.sample.spread(), &output.unit));
    let mut rows: Vec<(String, String)> = Vec::new();
    let mut add = |label: &str, text: Option<String>| rows.extend(text.map(|text| (label.to_owned(), text)));
    let sample = &record.sample;
    add("values", Some(grouped(record.values)));
    add("mean", mean(output));
    add("standard deviation", sd(output));
    add(
        "coefficient of variation",
        sample.sd.filter(|_| sample.mean != 0.0).map(|sd| value(100.0 * sd / sample.mean.abs(), "%")),
    );
    add("skewness", sample.skewness.map(|x| value(x, "")));
    add("excess kurtosis", sample.excess_kurtosis.map(|x| value(x, "")));
    add("smallest", Some(number(sample.min)));
    if sample.histogram.is_some() {
        let is_known = |percent: f64| QUANTILES.contains(&percent) && sample.tells(percent);
        for quantile in sample.quantiles.iter().filter(|quantile| is_known(quantile.percent)) {
            add(&format!("{} % quantile", significant(quantile.percent)), Some(number(quantile.value)));
        }
    }
    add("largest", Some(number(sample.max)));
    let caption = "Moments and range are those of all values unless stated otherwise, mean and standard deviation with their \
                   95 % intervals; quantiles are those of the kept values.";
    let rows = Table::from_rows(caption, &rows).text("", |(label, _)| label).number("", |(_, text)| text);
    Some(rows.into())
}

/// Formats the mean of an output with its error and unit.
pub(super) fn mean(output: &OutputResult) -> Option<String> {
    Some(of_unit(output.mean?, output.mean_interval, &output.unit))
}

/// Formats the standard deviation, by the divisor n - 1, as in the file; its interval is that of the variance. If a
/// surrogate's interval of the variance is so short that it excludes the value, the root of its variance is used.
pub(super) fn sd(output: &OutputResult) -> Option<String> {
    let sample = output.distribution.as_ref().and_then(|distribution| distribution.sample.sd);
    let interval = output.variance_interval.and_then(|variance| variance.map(|bound| bound.max(0.0).sqrt()));
    let is_inside = |sd: &f64| interval.is_none_or(|interval| (interval.low..=interval.high).contains(sd));
    let known = sample.filter(is_inside).or(output.variance.map(f64::sqrt)).or(sample);
    Some(of_unit(known?, interval, &output.unit))
}

fn of_unit(estimate: f64, interval: Option<Interval>, unit: &str) -> String {
    match interval {
        Some(i) if (i.low..=i.high).contains(&estimate) => index_with_unit(Estimate { estimate, interval }, unit),
        _ => value(estimate, unit),
    }
}

/// Describes the leading terms of the surrogates, and compares the plain indices with the corrected ones.
pub(super) fn surrogate(output: &OutputResult, record: &SurrogateRecord) -> Vec<Part> {
    let label = |term: &NamedTerm| {
        let factor = |(factor, degree): (&String, &usize)| match degree {
            1 => name(factor),
            degree => format!("{}^{degree}", name(factor)),
        };
        term.degrees.iter().map(factor).collect::<Vec<_>>().join(" × ")
    };
    let terms = record.leading_terms.iter().filter(|term| term.share >= MIN_TERM_SHARE);
    let caption = "The terms with most of the variance, by the degree in each factor (steps and kinks count too).";
    let terms = Table::from_rows(caption, terms)
        .text("term", label)
        .number("of the variance", |term| format!("{} %", printed(term.share)));
    let mut parts = vec![terms.into()];
    if let Some(order) = by_total(output) {
        let plain = |number: usize| record.plain.get(number);
        let table = Table::from_rows("Indices with and without the surrogate.", order)
            .text("factor", |(_, index)| name(&index.factor))
            .number("S_1", |(_, index)| index.effect.first_order)
            .number("S_1 plain", |(number, _)| plain(number).and_then(|plain| plain.first_order))
            .number("S_T", |(_, index)| index.effect.total)
            .number("S_T plain", |(number, _)| plain(number).and_then(|plain| plain.total));
        parts.push(table.first(FACTORS_OF_ESTIMATORS, "factors").into());
    }
    parts
}
