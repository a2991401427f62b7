//! Results as CSV: numbers with as many digits as it takes to read the same bits back, an empty cell where there is none.

use crate::report::asked::{cell, csv_text};
use crate::report::result::{
    AggregateIndexRecord, EffectRecord, EstimateRecord, IntervalRecord, OtherIndexRecord, OutputRecord, PairRecord,
    ResultFile,
};

/// Indices as CSV: one line per output and factor or group; then the subsets and dummy factors of every output, and the
/// indices over all outputs together (kind `aggregate`, the outputs joined by " + ").
pub fn indices_csv(result: &ResultFile) -> String {
    let header = [
        "output",
        "kind",
        "name",
        "first_order",
        "first_order_low",
        "first_order_high",
        "total",
        "total_low",
        "total_high",
        "share_first_order",
        "share_first_order_low",
        "share_first_order_high",
        "share_total",
        "share_total_low",
        "share_total_high",
        "interaction",
        "interaction_low",
        "interaction_high",
        "probability_first",
        "probability_above_threshold",
    ];
    let of_output = |output: &OutputRecord| {
        let factors = output.indices.iter().flatten().map(|i| effect_line(output, ("factor", &i.factor), &i.effect));
        let groups = output.groups.iter().flatten().map(|g| effect_line(output, ("group", &g.group), &g.effect));
        factors.chain(groups).collect::<Vec<_>>()
    };
    let more_of_output = |output: &OutputRecord| {
        let subsets = output.subsets.iter().flatten();
        let subsets = subsets.map(|s| effect_line(output, ("subset", &s.factors.join(" + ")), &s.effect));
        let dummy = output.dummy.iter().map(|effect| effect_line(output, ("dummy", "dummy"), effect));
        subsets.chain(dummy).collect::<Vec<_>>()
    };
    let lines = result.outputs.iter().flat_map(of_output).chain(result.outputs.iter().flat_map(more_of_output));
    csv_text([names(&header)].into_iter().chain(lines).chain(aggregate_lines(result, header.len())))
}

fn effect_line(output: &OutputRecord, (kind, name): (&str, &str), effect: &EffectRecord) -> Vec<String> {
    let share = |share, interval: Option<IntervalRecord>| [share, interval.map(|i| i.low), interval.map(|i| i.high)];
    let numbers = [
        bounds(Some(effect.first_order)),
        bounds(Some(effect.total)),
        share(effect.share_first_order, effect.share_first_order_interval),
        share(effect.share_total, effect.share_total_interval),
        bounds(effect.interaction),
    ];
    let chances = [effect.probability_first, effect.probability_above_threshold];
    line(&[&output.name, kind, name], numbers.into_iter().flatten().chain(chances))
}

fn aggregate_lines(result: &ResultFile, columns: usize) -> Vec<Vec<String>> {
    let Some(aggregate) = &result.aggregate else { return Vec::new() };
    let outputs = aggregate.outputs.join(" + ");
    let of_factor = |index: &AggregateIndexRecord| {
        let numbers = [bounds(Some(index.first_order)), bounds(Some(index.total))];
        let mut line = line(&[&outputs, "aggregate", &index.factor], numbers.into_iter().flatten());
        line.resize(columns, String::new());
        line
    };
    aggregate.indices.iter().flatten().map(of_factor).collect()
}

/// Second-order indices as CSV: one line per output and pair of factors, in the order of the factors.
pub fn second_order_csv(result: &ResultFile) -> String {
    let header = names(&["output", "factor_1", "factor_2", "second_order", "second_order_low", "second_order_high"]);
    let pair = |output: &OutputRecord, pair: &PairRecord| {
        let [first, second] = &pair.factors;
        line(&[&output.name, first, second], bounds(Some(pair.index)))
    };
    let of_output =
        |output: &'_ OutputRecord| output.second_order.iter().flatten().map(|p| pair(output, p)).collect::<Vec<_>>();
    csv_text([header].into_iter().chain(result.outputs.iter().flat_map(of_output)))
}

/// Indices by the other estimators that the study lists as CSV: one line per output, estimator and factor, group, subset
/// or dummy.
pub fn estimators_csv(result: &ResultFile) -> String {
    let header = names(&[
        "output",
        "estimator",
        "name",
        "first_order",
        "first_order_low",
        "first_order_high",
        "total",
        "total_low",
        "total_high",
    ]);
    let entry = |output: &OutputRecord, estimator: &str, index: &OtherIndexRecord| {
        let numbers = [bounds(index.first_order), bounds(index.total)];
        line(&[&output.name, estimator, &index.name], numbers.into_iter().flatten())
    };
    let mut lines = vec![header];
    for output in &result.outputs {
        for record in &output.estimators {
            lines.extend(record.indices.iter().map(|index| entry(output, &record.estimator, index)));
        }
    }
    csv_text(lines)
}

/// The indices at every stage of the run as CSV: one line per output, number of base samples and factor.
pub fn convergence_csv(result: &ResultFile) -> String {
    let header = names(&[
        "output",
        "base_samples",
        "model_runs",
        "factor",
        "first_order",
        "first_order_low",
        "first_order_high",
        "total",
        "total_low",
        "total_high",
    ]);
    let mut lines = vec![header];
    for output in &result.outputs {
        for stage in &output.convergence {
            let (samples, runs) = (stage.base_samples.to_string(), stage.model_runs.to_string());
            lines.extend(stage.indices.iter().map(|index| {
                let numbers = [bounds(Some(index.first_order)), bounds(Some(index.total))];
                line(&[&output.name, &samples, &runs, &index.factor], numbers.into_iter().flatten())
            }));
        }
    }
    csv_text(lines)
}

fn names(header: &[&str]) -> Vec<String> {
    header.iter().map(|name| (*name).to_owned()).collect()
}

fn bounds(estimate: Option<EstimateRecord>) -> [Option<f64>; 3] {
    [estimate.map(|e| e.estimate), estimate.and_then(|e| e.low), estimate.and_then(|e| e.high)]
}

fn line(texts: &[&str], numbers: impl IntoIterator<Item = Option<f64>>) -> Vec<String> {
    texts.iter().map(|text| (*text).to_owned()).chain(numbers.into_iter().map(cell)).collect()
}

/// A text as a CSV field, quoted where it must be (RFC 4180).
pub(crate) fn csv_field(text: &str) -> String {
    let text = inert(text.to_owned());
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text }
}

/// What a text begins with that a spreadsheet takes for a formula.
const FORMULA: [char; 4] = ['=', '+', '-', '@'];

/// A cell that no spreadsheet runs: a text that it would take for a formula begins with an apostrophe. Numbers stay.
pub(crate) fn inert(text: String) -> String {
    if text.starts_with(FORMULA) && text.parse::<f64>().is_err() { format!("'{text}") } else { text }
}

/// A text without the apostrophe of [`inert`].
pub(crate) fn plain_field(text: &str) -> &str {
    text.strip_prefix('\'').filter(|text| text.starts_with(FORMULA)).unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_no_formulas() {
        for (text, field) in [
            ("=HYPERLINK(\"http://x\",\"y\")", "\"'=HYPERLINK(\"\"http://x\"\",\"\"y\"\")\""),
            ("+x", "'+x"),
            ("-a", "'-a"),
            ("@SUM(1)", "'@SUM(1)"),
            ("-1.5e-3", "-1.5e-3"),
            ("+4", "+4"),
            ("a-b", "a-b"),
        ] {
            assert_eq!(csv_field(text), field);
            let inert = inert(text.to_owned());
            assert_eq!(plain_field(&inert), text);
        }
        assert_eq!(plain_field("'quoted'"), "'quoted'");
    }
}
