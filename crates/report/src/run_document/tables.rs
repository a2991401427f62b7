//! The tables of one output, of its values and its surrogate, and the CSV files, which hold more.

use apportion::IndexPair;
use apportion::NamedTerm;
use apportion::given::Measure;
use apportion::result::{EstimatorRecord, Named, OutputResult, PairRecord, RunMeasures, StudyResult, SurrogateRecord};
use apportion::uncertainty::{EffectEstimates, Estimate, Interval};

use crate::document::{Cell, DataFile, Part, Rows, Table, csv};
use crate::format::{among_with_unit, chance, grouped, index_with_unit, minus, name, printed, significant, value};
use crate::given::measures_table;
use crate::leading::{by_total, falling, surely_interact};
use crate::output_view::{IndexOf, effects as effects_of};

/// Maximum number of factors in a table; the files have all of them.
pub(crate) const FACTORS: usize = 50;
/// The caption's note on the others.
pub(crate) const IN_CSV: &str = "factors, all in the CSV file";
/// Maximum number of pairs of factors in a table.
const PAIRS: usize = 20;
/// Maximum number of factors in a table of estimators.
pub(super) const FACTORS_OF_ESTIMATORS: usize = 20;

/// A line of a table of indices.
struct Line<'a> {
    kind: &'static str,
    label: String,
    name: String,
    first_order: Estimate,
    total: Estimate,
    /// All indices; over several outputs together there are only these two.
    effect: Option<&'a EffectEstimates>,
}

impl<'a> Line<'a> {
    fn new(kind: &'static str, label: String, name: impl Into<String>, effect: &'a EffectEstimates) -> Self {
        let EffectEstimates { first_order, total, .. } = *effect;
        Self { kind, label, name: name.into(), first_order, total, effect: Some(effect) }
    }

    /// Creates a line of indices over several outputs together.
    fn plain(label: String, index: &Named<IndexPair<Estimate>>) -> Self {
        let IndexPair { first_order, total } = index.effect;
        Self { kind: "aggregate", label, name: index.name.clone(), first_order, total, effect: None }
    }

    fn get<T>(&self, of: fn(&EffectEstimates) -> Option<T>) -> Option<T> {
        self.effect.and_then(of)
    }
}

/// Tabulates indices; those over several outputs together have only the first two.
fn effects<'a>(
    result: &StudyResult,
    output: &str,
    caption: &str,
    what: &str,
    lines: &'a [Line<'a>],
) -> Rows<&'a Line<'a>> {
    // All outputs are alike.
    let index = result.outputs.iter().find_map(|output| output.indices.as_ref()?.first());
    let is_dependent = index.is_some_and(|index| index.effect.dependent.is_some());
    let is_of_one = lines.iter().all(|line| line.effect.is_some());
    // Differences of indices of dependent factors are not interactions, and exceedances of a threshold are not ranked.
    let is_independent = is_of_one && !is_dependent;
    let mut rows = Table::from_rows(caption, lines)
        .file("output", |_| output)
        .file("kind", |line| line.kind)
        .text(what, |line| &line.label)
        .value("name", |line| &line.name)
        .index("S_1", "first_order", |line| Some(line.first_order))
        .number("S_T", |line| match line.total {
            Estimate { estimate: 0.0, interval: Some(Interval { low: 0.0, high: 0.0 }) } => "no effect".into(),
            total => Cell::from(total),
        })
        .estimate("total", |line| Some(line.total))
        .file_estimate("share_first_order", |line| line.get(EffectEstimates::first_order_percent))
        .file_estimate("share_total", |line| line.get(EffectEstimates::total_percent))
        .index("S_T − S_1", "interaction", |line| line.get(|effect| effect.interaction))
        .shown(is_independent)
        .number("P(largest)", |line| probability(line.get(|effect| effect.probability_first)))
        .value("probability_first", |line| line.get(|effect| effect.probability_first))
        .shown(is_independent)
        .number(format!("P(S_T > {})", result.provenance.threshold), |line| {
            probability(line.get(|effect| effect.probability_above_threshold))
        })
        .value("probability_above_threshold", |line| line.get(|effect| effect.probability_above_threshold))
        .shown(is_independent);
    if is_dependent {
        rows = rows
            .index("S_1 given the others", "independent_first_order", |line| {
                line.get(|effect| Some(effect.dependent?.independent_first_order))
            })
            .shown(is_of_one)
            .index("S_T with the others", "full_total", |line| line.get(|effect| Some(effect.dependent?.full_total)))
            .shown(is_of_one);
    }
    if index.is_some_and(|index| index.effect.shapley.is_some()) {
        rows = rows.index("Shapley effect", "shapley", |line| line.get(|effect| effect.shapley)).shown(is_of_one);
    }
    rows
}

/// Formats a probability, a dash for `None`.
fn probability(probability: Option<f64>) -> String {
    chance(probability).replace('-', "–")
}

/// Names the noise.
fn of_noise(noise: &str) -> String {
    format!("noise ({})", name(noise))
}

/// Tabulates first-order and total indices of the factors, the largest total index first.
pub(super) fn indices(result: &StudyResult, output: &OutputResult) -> Option<Table> {
    let order = by_total(output)?;
    let mut lines: Vec<Line<'_>> =
        effects_of(output).map(|(factor, effect)| Line::new("factor", name(factor), factor, effect)).collect();
    lines
        .extend(output.noise.iter().map(|noise| Line::new("noise", of_noise(&noise.name), &noise.name, &noise.effect)));
    let caption = "First-order index S_1 and total index S_T, each with the half width of its 95 % interval, the largest S_T first.";
    let mut rows = effects(result, &output.name, caption, "factor", &lines);
    // The sum of indices of dependent factors has no meaning.
    if let Some((first_order, total)) = output.sum_first_order.zip(output.sum_total) {
        let sums = [Cell::default(), Cell::default(), "sum of all factors".into(), first_order.into(), total.into()];
        rows = rows.sums(sums);
    }
    let mut table: Table = rows.largest(order.iter().map(|(place, _)| *place), FACTORS, IN_CSV).into();
    if let Some(printed) = &mut table.printed {
        printed.extend(order.len()..lines.len());
    }
    Some(table)
}

/// Returns the tables of a result as CSV files: those that its outputs have.
pub(super) fn data_files(result: &StudyResult) -> Vec<DataFile> {
    let outputs = &result.outputs;
    let mut texts = vec![("", indices_csv(result))];
    if outputs.iter().any(|output| output.second_order.is_some()) {
        texts.push(("-second-order", pairs_csv(result)));
    }
    if outputs.iter().any(|output| output.measures.is_some()) {
        texts.push(("-measures", measures_csv(result)));
    }
    if outputs.iter().any(|output| !output.estimators.is_empty()) {
        texts.push(("-estimators", estimators_csv(result)));
    }
    texts.push(("-convergence", convergence_csv(result)));
    let name = &result.study.name;
    texts.into_iter().map(|(ending, text)| DataFile::new(format!("{name}{ending}.csv"), text)).collect()
}

/// Formats the indices of all outputs: factors and groups, subsets and the dummy factor, then several together.
fn indices_csv(result: &StudyResult) -> String {
    // Each table is built when it is written: there may be thousands.
    let header = std::iter::once(effects(result, "", "", "", &[]).into());
    let outputs = result.outputs.iter();
    let first = outputs.clone().flat_map(|output| indices(result, output).into_iter().chain(groups(result, output)));
    let aggregate = result.aggregate.iter().filter_map(|record| {
        let outputs: Vec<&str> = record.outputs.iter().map(String::as_str).collect();
        Some(together(result, &outputs, record.indices.as_ref()?, record.noise.as_ref()))
    });
    let series = result.series.iter();
    let series = series.filter_map(|series| Some(together(result, &[&series.name], series.indices.as_ref()?, None)));
    csv(header.chain(first).chain(outputs.filter_map(|output| subsets(result, output))).chain(aggregate).chain(series))
}

/// Formats the second-order indices of all outputs.
fn pairs_csv(result: &StudyResult) -> String {
    let header = std::iter::once(pairs_table("", Vec::new()).into());
    csv(header.chain(result.outputs.iter().filter_map(pairs)))
}

/// Tabulates joint indices of groups of factors.
pub(super) fn groups(result: &StudyResult, output: &OutputResult) -> Option<Table> {
    let lines = output.groups.iter().flatten().map(|group| {
        let label = format!("{}: {}", name(&group.name), joined(&group.factors));
        Line::new("group", label, &group.name, &group.effect)
    });
    let caption = "Joint indices of groups of the factors: S_1 includes the interactions inside them.";
    joint(result, output, caption, lines.collect())
}

/// Tabulates joint indices of subsets of factors, and those of the dummy factor.
pub(super) fn subsets(result: &StudyResult, output: &OutputResult) -> Option<Table> {
    let subsets = output.subsets.iter().flatten();
    let mut lines: Vec<Line<'_>> =
        subsets.map(|subset| Line::new("subset", joined(&subset.factors), &subset.name, &subset.effect)).collect();
    let dummy = output.dummy.iter();
    lines.extend(dummy.map(|effect| Line::new("dummy", "dummy, without effect".to_owned(), "dummy", effect)));
    let caption = match output.dummy {
        Some(_) => "Joint indices of subsets, and of a dummy factor: its indices are 0 except for errors.",
        None => "Joint indices of subsets of the factors: S_1 includes the interactions inside them.",
    };
    joint(result, output, caption, lines)
}

fn joined(factors: &[String]) -> String {
    factors.iter().map(|factor| name(factor)).collect::<Vec<_>>().join(" + ")
}

fn joint(result: &StudyResult, output: &OutputResult, caption: &str, lines: Vec<Line<'_>>) -> Option<Table> {
    let table: Table = effects(result, &output.name, caption, "factors", &lines).into();
    (!lines.is_empty()).then_some(Table { printed: Some((0..lines.len().min(FACTORS)).collect()), ..table })
}

/// Tabulates the largest second-order indices.
pub(super) fn pairs(output: &OutputResult) -> Option<Table> {
    let pairs = output.second_order.as_ref().filter(|pairs| !pairs.is_empty())?;
    let order = falling(&pairs.iter().map(|pair| pair.index.estimate).collect::<Vec<_>>());
    let rows = pairs_table(&output.name, pairs.iter().zip(surely_interact(pairs)).collect());
    Some(rows.largest(order, PAIRS, "pairs, all in the CSV file").into())
}

/// Tabulates pairs, and whether their interaction is certain.
fn pairs_table<'a>(output: &str, pairs: Vec<(&'a PairRecord, bool)>) -> Rows<(&'a PairRecord, bool)> {
    let caption = "Second-order indices: interactions of two factors.";
    Table::from_rows(caption, pairs)
        .text("pair", |(pair, _)| pair.factors.each_ref().map(|factor| name(factor)).join(" × "))
        .text("interaction seen", |(pair, is_sure)| match pair.index.interval {
            _ if is_sure => "yes",
            Some(interval) if interval.low > 0.0 => "may be chance: one of many pairs",
            Some(_) => "no",
            None => "unknown",
        })
        .file("output", |_| output)
        .file("factor_1", |(pair, _)| &pair.factors[0])
        .file("factor_2", |(pair, _)| &pair.factors[1])
        .index("S_2", "second_order", |(pair, _)| Some(pair.index))
}

/// Tabulates first-order, then total indices by the other estimators, with the default ones.
pub(super) fn estimators(output: &OutputResult) -> Vec<Part> {
    let tables = [
        (
            "First-order indices S_1 by estimator.",
            EstimatorColumn { other: |of| of.effect.first_order, default: |of| of.first_order },
        ),
        ("Total indices S_T by estimator.", EstimatorColumn { other: |of| of.effect.total, default: |of| of.total }),
    ];
    tables.into_iter().filter_map(|(caption, column)| estimator_table(output, caption, column)).collect()
}

/// Which index a table of estimators shows: of another estimator, and of the default ones.
#[derive(Clone, Copy)]
struct EstimatorColumn {
    other: fn(&Named<IndexPair<Option<Estimate>>>) -> Option<Estimate>,
    default: IndexOf,
}

fn estimator_table(output: &OutputResult, caption: &str, column: EstimatorColumn) -> Option<Part> {
    let order = by_total(output)?;
    let has_index = |record: &&EstimatorRecord| record.indices.iter().any(|index| (column.other)(index).is_some());
    let records: Vec<&EstimatorRecord> = output.estimators.iter().filter(has_index).collect();
    if records.is_empty() {
        return None;
    }
    let mut rows = Table::from_rows(caption, order)
        .text("factor", |(_, index)| name(&index.name))
        .number("default", |(_, index)| (column.default)(&index.effect));
    for record in records {
        rows = rows.number(&record.estimator, |(number, _)| record.indices.get(number).and_then(column.other));
    }
    Some(rows.first(FACTORS_OF_ESTIMATORS, IN_CSV).into())
}

/// Tabulates indices over all outputs together.
pub(super) fn together(
    result: &StudyResult,
    outputs: &[&str],
    indices: &[Named<IndexPair<Estimate>>],
    noise: Option<&Named<IndexPair<Estimate>>>,
) -> Table {
    let mut lines: Vec<Line<'_>> = indices.iter().map(|index| Line::plain(name(&index.name), index)).collect();
    lines.extend(noise.map(|noise| Line::plain(of_noise(&noise.name), noise)));
    let order = falling(&lines.iter().map(|line| line.total.estimate).collect::<Vec<_>>());
    // The names of hundreds of outputs, in every line, would be most of the file.
    let outputs = match outputs.len() {
        ..StudyResult::MIN_OUTPUTS_TOGETHER => outputs.join(" + "),
        all if all == result.outputs.len() => "all outputs".to_owned(),
        _ => "all outputs that are not series".to_owned(),
    };
    let rows = effects(result, &outputs, "Aggregated indices of all outputs.", "factor", &lines);
    rows.largest(order, FACTORS, IN_CSV).into()
}

/// Formats the indices by the other estimators: a line per output, estimator and factor, group, subset or dummy.
fn estimators_csv(result: &StudyResult) -> String {
    let records = result.outputs.iter().flat_map(|output| output.estimators.iter().map(move |record| (output, record)));
    let rows = records.flat_map(|(output, record)| record.indices.iter().map(move |index| (output, record, index)));
    Table::from_rows("", rows)
        .file("output", |(output, ..)| &output.name)
        .file("estimator", |(_, record, _)| &record.estimator)
        .file("name", |(.., index)| &index.name)
        .file_estimate("first_order", |(.., index)| index.effect.first_order)
        .file_estimate("total", |(.., index)| index.effect.total)
        .csv()
}

/// Formats the indices at every stage of the run: a line per output, number of base samples and factor.
fn convergence_csv(result: &StudyResult) -> String {
    let stages = result.outputs.iter().flat_map(|output| output.convergence.iter().map(move |stage| (output, stage)));
    let rows = stages.flat_map(|(output, stage)| stage.indices.iter().map(move |index| (output, stage, index)));
    Table::from_rows("", rows)
        .file("output", |(output, ..)| &output.name)
        .file("base_samples", |(_, stage, _)| stage.base_samples)
        .file("model_runs", |(_, stage, _)| stage.model_runs)
        .file("factor", |(.., index)| &index.name)
        .file_estimate("first_order", |(.., index)| Some(index.effect.first_order))
        .file_estimate("total", |(.., index)| Some(index.effect.total))
        .csv()
}

/// Quantiles in the table, in percent; the JSON file has more.
const QUANTILES: [f64; 7] = [2.5, 5.0, 25.0, 50.0, 75.0, 95.0, 97.5];
/// Share of the variance, in percent, below which a term of a surrogate is not shown.
const MIN_TERM_SHARE: f64 = 0.01;

/// Tabulates moments and quantiles of an output's values.
pub(super) fn moments(output: &OutputResult) -> Option<Part> {
    let sample = output.distribution.as_ref()?;
    let with_unit = |x: f64| minus(&among_with_unit(x, sample.spread(), &output.unit));
    let variation = sample.sd.filter(|_| sample.mean != 0.0).map(|sd| value(100.0 * sd / sample.mean.abs(), "%"));
    let mut rows: Vec<(String, Option<String>)> = [
        ("values", Some(grouped(sample.values))),
        ("mean", mean(output)),
        ("standard deviation", sd(output)),
        ("coefficient of variation", variation),
        ("skewness", sample.skewness.map(|x| value(x, ""))),
        ("excess kurtosis", sample.excess_kurtosis.map(|x| value(x, ""))),
        ("smallest", Some(with_unit(sample.min))),
    ]
    .map(|(label, text)| (label.to_owned(), text))
    .to_vec();
    for quantile in sample.quantiles.iter().filter(|_| sample.histogram.is_some()) {
        if QUANTILES.contains(&quantile.percent) && sample.tells(quantile.percent) {
            rows.push((format!("{} % quantile", significant(quantile.percent)), Some(with_unit(quantile.value))));
        }
    }
    rows.push(("largest".to_owned(), Some(with_unit(sample.max))));
    let caption = "Moments and range are those of all values unless stated otherwise, mean and standard deviation with their \
                   95 % intervals; quantiles are those of the kept values.";
    let rows: Vec<(String, String)> = rows.into_iter().filter_map(|(label, text)| Some((label, text?))).collect();
    Some(Table::from_rows(caption, &rows).text("", |(label, _)| label).number("", |(_, text)| text).into())
}

/// Formats the mean of an output with its error and unit.
pub(super) fn mean(output: &OutputResult) -> Option<String> {
    Some(of_unit(output.mean?, output.mean_interval, &output.unit))
}

/// Formats the standard deviation, by the divisor n - 1, as in the file; its interval is that of the variance. If a
/// surrogate's interval of the variance is so short that it excludes the value, the root of its variance is used.
pub(super) fn sd(output: &OutputResult) -> Option<String> {
    let sample = output.distribution.as_ref().and_then(|distribution| distribution.sd);
    let interval = output.variance_interval.and_then(|variance| variance.map(|bound| bound.max(0.0).sqrt()));
    let inside = sample.filter(|sd| interval.is_none_or(|interval| (interval.low..=interval.high).contains(sd)));
    let sd = inside.or(output.variance.map(f64::sqrt)).or(sample)?;
    Some(of_unit(sd, interval, &output.unit))
}

fn of_unit(estimate: f64, interval: Option<Interval>, unit: &str) -> String {
    match interval {
        Some(i) if (i.low..=i.high).contains(&estimate) => index_with_unit(Estimate { estimate, interval }, unit),
        _ => value(estimate, unit),
    }
}

/// Describes the leading terms of the surrogates, and compares the plain indices with the corrected ones.
pub(super) fn surrogate(output: &OutputResult, record: &SurrogateRecord) -> Vec<Part> {
    let terms = record.leading_terms.iter().filter(|term| term.share >= MIN_TERM_SHARE);
    let caption = "The terms with most of the variance, by the degree in each factor (steps and kinks count too).";
    let terms = Table::from_rows(caption, terms)
        .text("term", term_label)
        .number("of the variance", |term| format!("{} %", printed(term.share)));
    let mut parts = vec![terms.into()];
    if let Some(order) = by_total(output).filter(|_| !record.plain.is_empty()) {
        let rows = order.into_iter().map(|(number, index)| (index, record.plain.get(number)));
        let table = Table::from_rows("Indices with and without the surrogate.", rows)
            .text("factor", |(index, _)| name(&index.name))
            .number("S_1", |(index, _)| index.effect.first_order)
            .number("S_1 plain", |(_, plain)| plain.and_then(|plain| plain.effect.first_order))
            .number("S_T", |(index, _)| index.effect.total)
            .number("S_T plain", |(_, plain)| plain.and_then(|plain| plain.effect.total));
        parts.push(table.first(FACTORS_OF_ESTIMATORS, "factors").into());
    }
    parts
}

/// Formats a term as a product of powers, such as `x1^2 × x2`.
fn term_label(term: &NamedTerm) -> String {
    let mut powers = Vec::new();
    for (factor, degree) in &term.degrees {
        powers.push(match degree {
            1 => name(factor),
            degree => format!("{}^{degree}", name(factor)),
        });
    }
    powers.join(" × ")
}

/// Returns the measures that any of the records has.
pub(super) fn measures_of<'a>(records: impl IntoIterator<Item = &'a RunMeasures>) -> Vec<Measure> {
    let factors: Vec<_> = records.into_iter().flat_map(|record| &record.factors).collect();
    let measures = Measure::ALL.into_iter();
    measures.filter(|measure| factors.iter().any(|of| of.measures.contains_key(measure))).collect()
}

pub(super) fn measures_table_of(output: &OutputResult, record: &RunMeasures, measures: &[Measure]) -> Table {
    let table = measures_table(&output.name, ("factor", &record.factors), measures);
    let printed = Some((0..table.rows.len().min(FACTORS)).collect());
    Table { printed, ..table }
}

/// Formats the measures of all outputs as CSV.
fn measures_csv(result: &StudyResult) -> String {
    let records = || result.outputs.iter().filter_map(|output| Some((output, output.measures.as_ref()?)));
    let measures = measures_of(records().map(|(_, record)| record));
    csv(records().map(|(output, record)| measures_table_of(output, record, &measures)))
}
