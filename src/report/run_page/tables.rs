//! The tables of one output.

use super::lead::by_total;
use super::words::{give_or_take, grouped, half_width, name, share, value};
use crate::report::page::{Cell, OnPhone, PageTable, Part};
use crate::report::result::{
    AggregateIndexRecord, EffectRecord, EstimateRecord, FailureRecord, IndexRecord, OtherIndexRecord, OutputRecord,
    PairRecord, ResultFile,
};
use crate::report::significant;
use crate::report::tables::chance;

/// Most factors in a table; the files have all of them.
const FACTORS: usize = 50;
/// Most pairs of factors.
const PAIRS: usize = 20;
/// Quantiles in the table, in percent; the JSON file has more.
const QUANTILES: [f64; 7] = [2.5, 5.0, 25.0, 50.0, 75.0, 95.0, 97.5];
/// Most estimators side by side.
const ESTIMATORS: usize = 6;
/// Most factors in a table of estimators.
const FACTORS_OF_ESTIMATORS: usize = 20;

/// A table of which all columns but the first `texts` are numbers.
pub(super) fn table(caption: String, header: &[&str], (texts, rows): (usize, Vec<Vec<Cell>>)) -> Part {
    let header: Vec<String> = header.iter().map(|text| (*text).to_owned()).collect();
    Part::Table(PageTable {
        caption,
        numeric: (texts..header.len()).collect(),
        header,
        rows,
        on_phone: OnPhone::Scroll,
    })
}

/// `which` of how many are shown, if not all.
fn largest(shown: usize, all: usize, what: &str) -> String {
    if shown < all { format!(" The {shown} largest of {all} {what}.") } else { String::new() }
}

/// First-order and total indices of the factors, the largest total index first.
pub(super) fn indices(result: &ResultFile, output: &OutputRecord) -> Option<Part> {
    let order = by_total(output)?;
    let shown = &order[..order.len().min(FACTORS)];
    let mut rows: Vec<Vec<Cell>> = shown.iter().map(|index| effect_row(name(&index.factor), &index.effect)).collect();
    let sum = |sum: Option<EstimateRecord>| Cell::plain(sum.map_or_else(String::new, give_or_take));
    let mut sums = vec![Cell::plain("sum of all factors"), sum(output.sum_first_order), sum(output.sum_total)];
    sums.resize(6, Cell::default());
    rows.push(sums);
    let caption = format!(
        "First-order index S_1, total index S_T and their difference, each with the half width of its 95 % interval, in \
         the order of the total index.{}",
        largest(shown.len(), order.len(), "factors, all in the CSV file")
    );
    Some(effect_table(result, caption, ("factor", rows)))
}

fn effect_table(result: &ResultFile, caption: String, (what, rows): (&str, Vec<Vec<Cell>>)) -> Part {
    let above = format!("P(S_T > {})", result.provenance.threshold);
    table(caption, &[what, "S_1", "S_T", "S_T − S_1", "P(largest)", &above], (1, rows))
}

fn effect_row(label: String, effect: &EffectRecord) -> Vec<Cell> {
    let number = |record: Option<EstimateRecord>| Cell::plain(record.map_or_else(|| "–".to_owned(), give_or_take));
    let chance = |probability| Cell::plain(chance(probability).replace('-', "–"));
    vec![
        Cell::plain(label),
        number(Some(effect.first_order)),
        number(Some(effect.total)),
        number(effect.interaction),
        chance(effect.probability_first),
        chance(effect.probability_above_threshold),
    ]
}

/// Shares in percent, the largest share of the total indices first.
pub(super) fn shares(output: &OutputRecord) -> Option<Part> {
    let order = by_total(output)?;
    let shown = &order[..order.len().min(FACTORS)];
    let row = |index: &&IndexRecord| {
        let effect = &index.effect;
        vec![
            Cell::plain(name(&index.factor)),
            Cell::plain(share(effect.share_first_order, effect.share_first_order_interval)),
            Cell::plain(share(effect.share_total, effect.share_total_interval)),
        ]
    };
    let caption = format!(
        "Shares in percent, with their 95 % intervals.{}",
        largest(shown.len(), order.len(), "factors, all in the CSV file")
    );
    let header = ["factor", "of the sum of S_1", "of the sum of S_T"];
    Some(table(caption, &header, (1, shown.iter().map(row).collect())))
}

/// Groups, subsets and the dummy factor.
pub(super) fn joint(result: &ResultFile, output: &OutputRecord) -> Option<Part> {
    let names = |factors: &[String]| factors.iter().map(|factor| name(factor)).collect::<Vec<_>>().join(" + ");
    let groups = output.groups.iter().flatten();
    let groups =
        groups.map(|group| effect_row(format!("{}: {}", name(&group.group), names(&group.factors)), &group.effect));
    let subsets = output.subsets.iter().flatten().map(|subset| effect_row(names(&subset.factors), &subset.effect));
    let dummy = output.dummy.iter().map(|effect| effect_row("dummy, which does nothing".to_owned(), effect));
    let rows: Vec<Vec<Cell>> = groups.chain(subsets).chain(dummy).take(FACTORS).collect();
    let alone = output.groups.iter().flatten().count() + output.subsets.iter().flatten().count() == 0;
    let caption = if alone {
        "Indices of a factor that does nothing, run along: what is not 0 is noise."
    } else {
        "Joint indices of groups and subsets of the factors: S_1 includes the interactions inside them."
    }
    .to_owned();
    (!rows.is_empty()).then(|| effect_table(result, caption, ("factors", rows)))
}

/// The largest second-order indices.
pub(super) fn pairs(output: &OutputRecord) -> Option<Part> {
    let pairs = output.second_order.as_ref().filter(|pairs| !pairs.is_empty())?;
    let mut sorted: Vec<&PairRecord> = pairs.iter().collect();
    sorted.sort_by(|a, b| b.index.estimate.total_cmp(&a.index.estimate));
    let row = |pair: &&PairRecord| {
        let seen = match (pair.index.low, pair.index.high) {
            (Some(low), _) if low > 0.0 => "yes",
            (Some(_), Some(high)) if high < 0.0 => "no: below 0 by chance, or too few samples",
            (Some(_), Some(_)) => "no: 0 is within the interval",
            _ => "unknown",
        };
        let [a, b] = &pair.factors;
        let pair_name = Cell::plain(format!("{} × {}", name(a), name(b)));
        vec![pair_name, Cell::plain(seen), Cell::plain(give_or_take(pair.index))]
    };
    let shown = &sorted[..sorted.len().min(PAIRS)];
    let caption = format!(
        "Second-order indices: what two factors do together beyond what each does alone.{}",
        largest(shown.len(), sorted.len(), "pairs, all in the CSV file")
    );
    Some(table(caption, &["pair", "interaction seen", "S_2"], (2, shown.iter().map(row).collect())))
}

/// The width of the intervals at every stage of the run.
pub(super) fn stages(output: &OutputRecord) -> Option<Part> {
    let row = |stage: &crate::report::result::StageRecord| {
        let width = stage.largest_half_width.map_or_else(|| "–".to_owned(), half_width);
        vec![Cell::plain(grouped(stage.base_samples)), Cell::plain(grouped(stage.model_runs)), Cell::plain(width)]
    };
    let rows: Vec<Vec<Cell>> = output.convergence.iter().map(row).collect();
    let caption = "Largest half width of all first-order and total indices as the run grew.".to_owned();
    let header = ["base points", "model runs", "largest half width"];
    (!rows.is_empty()).then(|| table(caption, &header, (0, rows)))
}

/// Moments and quantiles of an output's values.
pub(super) fn moments(output: &OutputRecord) -> Option<Part> {
    let record = output.distribution.as_ref()?;
    let number = |x: f64| value(x, &output.unit);
    let mut rows: Vec<(String, String)> = Vec::new();
    let mut add = |label: &str, text: Option<String>| rows.extend(text.map(|text| (label.to_owned(), text)));
    let mean = output.mean.map(|mean| match output.mean_interval {
        Some(i) => format!("{} ({} to {})", number(mean), value(i.low, ""), value(i.high, "")),
        None => number(mean),
    });
    let sample = &record.sample;
    add("values", Some(grouped(record.values)));
    add("mean", mean);
    add("standard deviation", sample.sd.map(number));
    add(
        "coefficient of variation",
        sample.sd.filter(|_| sample.mean != 0.0).map(|sd| value(100.0 * sd / sample.mean.abs(), "%")),
    );
    add("skewness", sample.skewness.map(|x| value(x, "")));
    add("excess kurtosis", sample.excess_kurtosis.map(|x| value(x, "")));
    add("smallest", Some(number(sample.min)));
    if sample.histogram.is_some() {
        for quantile in sample.quantiles.iter().filter(|quantile| QUANTILES.contains(&quantile.percent)) {
            add(&format!("{} % quantile", significant(quantile.percent)), Some(number(quantile.value)));
        }
    }
    add("largest", Some(number(sample.max)));
    let rows = rows.into_iter().map(|(label, text)| vec![Cell::plain(label), Cell::plain(text)]).collect();
    let caption = "Moments and range are those of all values, the mean with its 95 % interval; quantiles are those of the values that were kept.".to_owned();
    Some(table(caption, &[], (0, rows)))
}

/// First-order, then total indices by the other estimators, beside the default ones.
pub(super) fn estimators(output: &OutputRecord) -> Vec<Part> {
    let (Some(order), false) = (numbers_by_total(output), output.estimators.is_empty()) else { return Vec::new() };
    type Of = fn(&OtherIndexRecord) -> Option<EstimateRecord>;
    type Default = fn(&EffectRecord) -> EstimateRecord;
    let kinds: [(&str, Of, Default); 2] = [
        ("First-order indices S_1", |other| other.first_order, |effect| effect.first_order),
        ("Total indices S_T", |other| other.total, |effect| effect.total),
    ];
    let mut parts = Vec::new();
    for (what, of, default) in kinds {
        let has = |index: &OtherIndexRecord| of(index).is_some();
        let records: Vec<_> = output.estimators.iter().filter(|record| record.indices.iter().any(has)).collect();
        for few in records.chunks(ESTIMATORS) {
            let mut header = vec!["factor", "default"];
            header.extend(few.iter().map(|record| record.estimator.as_str()));
            let row = |&(number, index): &(usize, &IndexRecord)| {
                let others = few.iter().map(|record| record.indices.get(number).and_then(of));
                let all = [Some(default(&index.effect))].into_iter().chain(others);
                let numbers = all.map(|index| Cell::plain(index.map_or_else(|| "–".to_owned(), give_or_take)));
                [Cell::plain(name(&index.factor))].into_iter().chain(numbers).collect()
            };
            let shown = &order[..order.len().min(FACTORS_OF_ESTIMATORS)];
            let caption =
                format!("{what} by estimator.{}", largest(shown.len(), order.len(), "factors, all in the CSV file"));
            parts.push(table(caption, &header, (1, shown.iter().map(row).collect())));
        }
    }
    let source = |record: &crate::report::result::EstimatorRecord| {
        let first = record.first_order_source.iter().map(|source| format!("S_1: {source}"));
        let total = record.total_source.iter().map(|source| format!("S_T: {source}"));
        format!("`{}`: {}", record.estimator, first.chain(total).collect::<Vec<_>>().join("; "))
    };
    parts.push(Part::List(output.estimators.iter().map(source).collect()));
    parts
}

/// The indices with their places in the study, the largest total index first.
fn numbers_by_total(output: &OutputRecord) -> Option<Vec<(usize, &IndexRecord)>> {
    let mut order: Vec<(usize, &IndexRecord)> = output.indices.as_ref()?.iter().enumerate().collect();
    order.sort_by(|a, b| b.1.effect.total.estimate.total_cmp(&a.1.effect.total.estimate));
    Some(order)
}

/// Why runs failed.
pub(super) fn failures(failures: &[FailureRecord]) -> Option<Part> {
    let row = |failure: &FailureRecord| {
        let inputs: Vec<String> =
            failure.first_inputs.iter().take(12).map(|(name, value)| format!("{name} = {value}")).collect();
        let more = if failure.first_inputs.len() > inputs.len() { ", …" } else { "" };
        vec![
            Cell::plain(&failure.reason),
            Cell::plain(format!("row {}: {}{more}", failure.first_row, inputs.join(", "))),
            Cell::plain(grouped(failure.runs)),
        ]
    };
    let caption = "Runs without a value, by reason, with the inputs of the first of each.".to_owned();
    let rows: Vec<Vec<Cell>> = failures.iter().take(FACTORS).map(row).collect();
    (!rows.is_empty()).then(|| table(caption, &["reason", "first", "runs"], (2, rows)))
}

/// Indices over all outputs together.
pub(super) fn aggregate(indices: &[AggregateIndexRecord]) -> Part {
    let mut order: Vec<&AggregateIndexRecord> = indices.iter().collect();
    order.sort_by(|a, b| b.total.estimate.total_cmp(&a.total.estimate));
    let shown = &order[..order.len().min(FACTORS)];
    let row = |index: &&AggregateIndexRecord| {
        let number = |record| Cell::plain(give_or_take(record));
        vec![Cell::plain(name(&index.factor)), number(index.first_order), number(index.total)]
    };
    let caption = format!(
        "Aggregated indices of all outputs.{}",
        largest(shown.len(), order.len(), "factors, all in the CSV file")
    );
    table(caption, &["factor", "S_1", "S_T"], (1, shown.iter().map(row).collect()))
}
