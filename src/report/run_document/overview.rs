//! What the document says of many outputs: an overview first, and what is said of single ones folded below it.

use super::figures::{Figures, Numbered, overview_stems};
use super::output::{definitions, topics};
use super::under_headings;
use super::warnings::{folded, output_names};
use crate::report::document::{Cell, Column, Mark, Part, Section, Table};
use crate::report::format::{give_or_take, grouped, heading, index, name, short, value};
use crate::report::leading::{Contender, by_total, may_lead, names, of_which};
use crate::report::listed;
use crate::report::output_axis::OutputAxis;
use crate::report::result::{AggregateIndexRecord, EstimateRecord, IndexRecord, OutputRecord, ResultFile};
use crate::report::run_charts::{map_chart, overall_order, together_chart};
use crate::report::study_sections::{failures, inputs};

/// Most outputs that are told in full.
const IN_FULL: usize = 3;
/// How far total indices must be from those of the outputs that are told in full already, summed over the factors.
const DIFFERENT: f64 = 0.2;
/// Factors in the table of all.
const FACTORS: usize = 50;
/// Factors beside each output in the tables of outputs.
const COLUMNS: usize = 12;
/// Outputs that are folded together.
const FOLDED: usize = 50;
/// About as many bytes of the page may be tables of outputs, and a cell takes so many beside its heading.
const BYTES: usize = 1_200_000;
const BYTES_OF_CELL: usize = 70;
/// Most warnings, and most names in a sentence.
const WARNINGS: usize = 10;
const NAMES: usize = 6;

/// The sections of all outputs.
pub(super) fn sections(figures: &mut Figures<'_>) -> Vec<Section> {
    let result = figures.result;
    let mut sections = vec![
        Section::new("overview", "All outputs at a glance", overview(figures)),
        Section::new("mind", "What to mind", mind(result)),
        Section::new("in-full", "Some outputs in full", in_full(figures)),
        Section::new("outputs", "Every output", every_output(result, BYTES)),
    ];
    sections.retain(|section| !section.parts.is_empty());
    sections
}

fn overview(figures: &mut Figures<'_>) -> Vec<Part> {
    let result = figures.result;
    let names: Vec<&str> = result.outputs.iter().map(|output| output.name.as_str()).collect();
    let axes = OutputAxis::all(&names);
    let mut stems = overview_stems(&result.study.name, axes.len()).into_iter();
    let mut parts = definitions(result).to_vec();
    let weighting = result
        .aggregate
        .as_ref()
        .map(|aggregate| format!(" In those of all outputs together, {}.", aggregate.weighting));
    parts.push(Part::Text(format!(
        "The indices of every output are in `{study}.csv`, and whatever else is known of them in `{study}.json`.{}",
        weighting.unwrap_or_default(),
        study = result.study.name
    )));
    parts.push(figures.add(together_chart(result), "together", &stems.next().unwrap_or_default()));
    parts.push(factors(result).into());
    for (number, (axis, stem)) in axes.iter().zip(stems).enumerate() {
        parts.push(figures.add(map_chart(result, axis), &format!("map-{}", number + 1), &stem));
    }
    parts
}

/// For how many outputs each factor matters most.
struct Leads {
    /// By the place of the factor, the outputs for which it surely does.
    first: Vec<usize>,
    /// Outputs of which it cannot be told.
    open: usize,
    /// Outputs without indices.
    without: usize,
}

impl Leads {
    fn of(result: &ResultFile) -> Self {
        let mut leads = Self { first: vec![0; result.factors.len()], open: 0, without: 0 };
        for output in &result.outputs {
            match by_total(output) {
                None => leads.without += 1,
                Some(order) => {
                    let contenders: Vec<Contender> = order.iter().map(|(_, index)| Contender::of(index)).collect();
                    // Without intervals nothing is sure.
                    let is_known = contenders.len() == 1 || contenders[0].has_error();
                    match may_lead(&contenders)[..] {
                        [_] if is_known => leads.first[order[0].0] += 1,
                        _ => leads.open += 1,
                    }
                }
            }
        }
        leads
    }
}

/// What each factor does to all outputs.
pub(super) fn factors(result: &ResultFile) -> Table {
    let leads = Leads::of(result);
    let together = result.aggregate.as_ref().and_then(|aggregate| aggregate.indices.as_deref()).unwrap_or_default();
    let row = |&factor: &usize| -> Vec<Cell> {
        let of_factor = |output: &'_ OutputRecord| -> Option<EstimateRecord> {
            Some(output.indices.as_ref()?.get(factor)?.effect.total)
        };
        let mut totals: Vec<(f64, usize)> = Vec::new();
        for (place, output) in result.outputs.iter().enumerate() {
            totals.extend(of_factor(output).map(|total| (total.estimate, place)));
        }
        totals.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let own = &result.factors[factor].name;
        let all = together.iter().find(|index| index.factor == *own);
        let dash = || Cell::from("–");
        let median = totals.get(totals.len() / 2).map_or_else(dash, |(median, _)| short(*median).into());
        let largest = totals.last().and_then(|&(_, place)| Some((of_factor(&result.outputs[place])?, place)));
        vec![
            name(own).into(),
            all.map_or_else(dash, |all| give_or_take(all.first_order).into()),
            all.map_or_else(dash, |all| give_or_take(all.total).into()),
            leads.first[factor].to_string().into(),
            median,
            largest.map_or_else(dash, |(total, _)| give_or_take(total).into()),
            largest.map_or_else(dash, |(_, place)| name(&result.outputs[place].name).into()),
        ]
    };
    let order = overall_order(result);
    let mut caption =
        "Indices of all outputs together, for how many outputs a factor surely matters most, and the median \
                       and largest of its total indices."
            .to_owned();
    if order.len() > FACTORS {
        caption.push_str(&format!(" The {FACTORS} largest of {} factors, all in the CSV file.", order.len()));
    }
    let headings = [
        ("factor", false),
        ("S_1 together", true),
        ("S_T together", true),
        ("first of", true),
        ("median S_T", true),
        ("largest S_T", true),
        ("at", false),
    ];
    let column = |(heading, is_number)| if is_number { Column::number(heading) } else { Column::text(heading) };
    Table::new(caption, headings.map(column)).with_rows(order.iter().take(FACTORS).map(row))
}

/// What is said several times, with of what: in the order of the first time.
fn grouped_by<K: PartialEq, T>(said: impl Iterator<Item = (K, T)>) -> Vec<(K, Vec<T>)> {
    let mut groups: Vec<(K, Vec<T>)> = Vec::new();
    for (key, of) in said {
        match groups.iter_mut().find(|(known, _)| *known == key) {
            Some((_, all)) => all.push(of),
            None => groups.push((key, vec![of])),
        }
    }
    groups
}

/// Which outputs have no indices, what the run warns of, and which runs failed: each once.
pub(super) fn mind(result: &ResultFile) -> Vec<Part> {
    let outputs = || result.outputs.iter();
    let without = outputs().enumerate().filter(|(_, output)| output.indices.is_none());
    let without = without.filter_map(|(place, output)| Some((output.reason.as_deref()?, place)));
    let mut parts: Vec<Part> = Vec::new();
    for (reason, places) in grouped_by(without).into_iter().take(WARNINGS) {
        let text = format!("There are no indices of {}: {reason}.", of_which(&output_names(&result.outputs), &places));
        parts.push(Part::no_indices(text));
    }
    let warned = folded(&result.outputs);
    let mut warnings: Vec<String> = warned.iter().take(WARNINGS).cloned().collect();
    if warned.len() > WARNINGS {
        warnings.push(format!("{} more warnings are in the JSON file", warned.len() - WARNINGS));
    }
    parts.extend(Part::warnings(&warnings));
    let failed = outputs().flat_map(|output| &output.failures);
    let failed = grouped_by(failed.map(|failure| ((failure.reason.as_str(), failure.first_row), failure)));
    parts.extend(failures(failed.iter().map(|((reason, row), of_outputs)| {
        let runs = of_outputs.iter().map(|failure| failure.runs).max().unwrap_or(0);
        (*reason, format!("row {row}: {}", inputs(&of_outputs[0].first_inputs)), runs)
    })));
    parts
}

/// The outputs that are told in full: the one with the largest variance (or the first of outputs of several units), and those
/// whose total indices differ most from all before them.
fn different(result: &ResultFile) -> Vec<usize> {
    let totals = |output: &OutputRecord| -> Option<Vec<f64>> {
        Some(output.indices.as_ref()?.iter().map(|index| index.effect.total.estimate).collect())
    };
    let known: Vec<(usize, Vec<f64>)> =
        result.outputs.iter().enumerate().filter_map(|(place, output)| Some((place, totals(output)?))).collect();
    let same_unit = result.outputs.windows(2).all(|pair| pair[0].unit == pair[1].unit);
    let variance = |place: usize| result.outputs[place].variance.unwrap_or(0.0);
    let larger = |best: usize, next: usize| {
        if same_unit && variance(known[next].0) > variance(known[best].0) { next } else { best }
    };
    let Some(first) = (0..known.len()).reduce(larger) else { return Vec::new() };
    let mut chosen = vec![first];
    let distance = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum::<f64>();
    while chosen.len() < IN_FULL {
        let nearest = |place: usize| {
            chosen.iter().map(|&other| distance(&known[place].1, &known[other].1)).fold(f64::INFINITY, f64::min)
        };
        let farthest = (0..known.len()).map(|place| (nearest(place), place));
        match farthest.reduce(|best, next| if next.0 > best.0 { next } else { best }) {
            Some((far, place)) if far > DIFFERENT => chosen.push(place),
            _ => break,
        }
    }
    chosen.into_iter().map(|place| known[place].0).collect()
}

pub(super) fn in_full(figures: &mut Figures<'_>) -> Vec<Part> {
    let result = figures.result;
    let places = different(result);
    if places.is_empty() {
        return Vec::new();
    }
    let text = "The output with the largest variance (or the first one, where units differ), and those whose total indices \
                differ most from it. Their charts are on this page alone.";
    let mut parts = vec![Part::Text(text.to_owned())];
    for place in places {
        let output = &result.outputs[place];
        let topics = topics(figures, Numbered { output, number: place + 1 });
        parts.push(Part::Details { summary: heading(&output.name, &output.unit), parts: under_headings(topics) });
    }
    vec![Part::OnPage(parts)]
}

/// The indices of every output as numbers, as many as have room in about so many bytes.
pub(super) fn every_output(result: &ResultFile, bytes: usize) -> Vec<Part> {
    let mut factors = overall_order(result);
    factors.truncate(COLUMNS);
    let of_row: usize = factors.iter().map(|&factor| BYTES_OF_CELL + result.factors[factor].name.len()).sum();
    let names: usize = result.outputs.iter().map(|output| output.name.len()).sum();
    let all = result.outputs.len();
    let of_output = 2 * (of_row + 2 * BYTES_OF_CELL + names / all.max(1));
    let step = (all * of_output).div_ceil(bytes).max(1);
    let shown: Vec<&OutputRecord> = result.outputs.iter().step_by(step).collect();
    let mut text =
        "First the total indices of every output with its mean and standard deviation, then its first-order \
                    indices, each with the half width of its 95 % interval; the largest of an output in strong letters."
            .to_owned();
    if result.factors.len() > factors.len() {
        text.push_str(&format!(
            " Of {} factors, the {} with the largest total indices.",
            result.factors.len(),
            factors.len()
        ));
    }
    if step > 1 {
        text.push_str(&format!(" One of {step} outputs is shown: all are in the CSV file."));
    }
    let mut parts = vec![Part::Text(text)];
    for some in shown.chunks(FOLDED) {
        let ends = [some.first(), some.last()].map(|end| end.map_or_else(String::new, |output| name(&output.name)));
        let tables = [true, false].map(|is_total| Part::Table(of_outputs(result, some, &factors, is_total)));
        parts.push(Part::Details { summary: format!("{} to {}", ends[0], ends[1]), parts: tables.to_vec() });
    }
    vec![Part::OnPage(parts)]
}

/// Total or first-order indices of some outputs, a row each.
fn of_outputs(result: &ResultFile, outputs: &[&OutputRecord], factors: &[usize], is_total: bool) -> Table {
    let of = |index: &IndexRecord| if is_total { index.effect.total } else { index.effect.first_order };
    let row = |output: &&OutputRecord| -> Vec<Cell> {
        let mut row: Vec<Cell> = vec![name(&output.name).into()];
        let number = |x: Option<f64>| -> Cell { x.map_or_else(|| "–".to_owned(), |x| value(x, &output.unit)).into() };
        if is_total {
            row.extend([number(output.mean), number(output.variance.map(f64::sqrt))]);
        }
        let largest = output.indices.iter().flatten().map(|index| of(index).estimate).fold(f64::NEG_INFINITY, f64::max);
        row.extend(factors.iter().map(|&factor| {
            let index = output.indices.as_ref().and_then(|indices| indices.get(factor)).map(of);
            let mark = if index.is_some_and(|index| index.estimate == largest) { Mark::Strong } else { Mark::Plain };
            Cell::marked(index.map_or_else(|| "–".to_owned(), give_or_take), mark)
        }));
        row
    };
    let mut columns = vec![Column::text("output")];
    if is_total {
        columns.extend(["mean", "standard deviation"].map(Column::number));
    }
    columns.extend(factors.iter().map(|&factor| Column::number(name(&result.factors[factor].name))));
    let caption = if is_total { "Total indices S_T." } else { "First-order indices S_1." };
    Table::new(caption, columns).with_rows(outputs.iter().map(row))
}

/// The paragraphs at the top: who leads, output by output and over all together.
pub(super) fn answers(result: &ResultFile) -> Vec<String> {
    let leads = Leads::of(result);
    let mut order: Vec<usize> = (0..leads.first.len()).filter(|&factor| leads.first[factor] > 0).collect();
    order.sort_by_key(|&factor| std::cmp::Reverse(leads.first[factor]));
    let all = grouped(result.outputs.len() as u64);
    let mut counted: Vec<String> = order
        .iter()
        .take(NAMES)
        .map(|&factor| format!("{} for {}", name(&result.factors[factor].name), leads.first[factor]))
        .collect();
    if let Some(first) = counted.first_mut() {
        *first = first.replacen(" for ", " matters most for ", 1);
    }
    if order.len() > NAMES {
        counted.push(format!("{} more factors for others", order.len() - NAMES));
    }
    let mut sentence = match counted.is_empty() {
        true => format!("For none of {all} outputs a factor is sure to matter most"),
        false => format!("Of {all} outputs, {}, by the total index S_T", listed(&counted)),
    };
    if leads.open > 0 {
        sentence.push_str(&format!("; for {} it cannot be told", leads.open));
    }
    if leads.without > 0 {
        let have = if leads.without == 1 { "has" } else { "have" };
        sentence.push_str(&format!("; {} {have} no indices", leads.without));
    }
    let mut answers = vec![sentence + "."];
    answers[0].extend(super::interactions::of_many(&result.outputs).map(|text| format!(" {text}")));
    if let Some(aggregate) = result.aggregate.as_ref() {
        let of = "For all outputs together";
        answers.extend(aggregate.indices.as_deref().and_then(|indices| leader_of_all(indices, of)));
    }
    answers
}

/// Which factor leads over many values, the sentence beginning with `of` what; `None` without factors.
pub(super) fn leader_of_all(indices: &[AggregateIndexRecord], of: &str) -> Option<String> {
    let contender = |index: &AggregateIndexRecord| Contender {
        label: name(&index.factor),
        first_order: Some(index.first_order),
        total: index.total,
        probability: None,
    };
    let contenders: Vec<Contender> = indices.iter().map(contender).collect();
    let total = |contender: &Contender| index(contender.total);
    let leaders = may_lead(&contenders);
    Some(match leaders[..] {
        [] => return None,
        [one] => format!("{of}, {} matters most: its S_T is {}.", contenders[one].label, total(&contenders[one])),
        _ => {
            let names = names(&contenders, &leaders, &total);
            format!("{of}, what matters most cannot be told apart, by S_T: {names}.")
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_of_several_is_said_once() {
        let groups = grouped_by([("few runs", "a"), ("noise", "b"), ("few runs", "c")].into_iter());
        assert_eq!(groups, [("few runs", vec!["a", "c"]), ("noise", vec!["b"])]);
    }
}
