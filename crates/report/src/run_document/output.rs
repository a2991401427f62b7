//! The topics of the document on one output.

use apportion::IndexPair;
use apportion::result::{Named, OutputResult, StudyResult};
use apportion::uncertainty::{Estimate, Interval};
use apportion_base::text::listed;

use super::parts::{definitions, failed_runs, figure, grouped_warnings};
use super::tables;
use super::tables::{FACTORS, measures_of, measures_table_of};
use crate::chart::Chart;
use crate::document::{OutputReport, Part, Section, Table};
use crate::format::{
    among_with_unit, count, grouped, index, is_above_zero, minus, name, percent, share_of_runs, significant, two_digits,
};
use crate::given::agreement;
use crate::leading::{by_total, no_indices, noise_sentence};
use crate::output_view::{OutputView, effects};
use crate::precision::{WIDE, indices_measured, widest_of};
use crate::{convergence_chart, distribution_chart, indices_chart, pairs_chart, scatter_chart, shapley_chart};

/// Reports on several outputs, each with its topics under headings.
pub(super) fn reports<'a>(view: &OutputView<'a>, stems: &[String]) -> Vec<OutputReport<'a>> {
    let mut reports = Vec::new();
    for ((place, output), stem) in view.outputs.iter().enumerate().zip(stems) {
        let mut parts = Vec::new();
        for topic in topics(view, place, stem) {
            parts.push(Part::Heading(topic.title));
            parts.extend(topic.parts);
        }
        reports.push(OutputReport { name: &output.name, unit: &output.unit, parts, ..OutputReport::default() });
    }
    reports
}

/// Lists the warnings of several outputs.
pub(super) fn warnings_section(view: &OutputView<'_>) -> Option<Section> {
    let warnings = Part::warnings(&grouped_warnings(&view.outputs))?;
    Some(Section::new("warnings", "Warnings", vec![warnings]))
}

/// Describes the indices of all outputs together, or why there are none.
pub(super) fn together(view: &OutputView<'_>) -> Option<Section> {
    let together = view.together.as_ref()?;
    let names: Vec<String> = together.outputs.iter().map(|output| name(output)).collect();
    let mut parts = vec![Part::Text(format!("Of {}: {}.", listed(&names), together.weighting))];
    match (together.indices, together.reason) {
        (Some(indices), _) => {
            parts.push(tables::together(view.result, &together.outputs, indices, together.noise).into());
        }
        (None, Some(reason)) => parts.push(Part::no_indices(format!("There are no such indices: {reason}."))),
        (None, None) => (),
    }
    Some(Section::new("together", "All outputs together", parts))
}

/// An output of a document.
struct Topics<'a> {
    result: &'a StudyResult,
    output: &'a OutputResult,
    /// Its number in the document, from 1.
    number: usize,
    /// The prefix of the names of its files.
    stem: &'a str,
    /// Whether it is the only one.
    is_single: bool,
}

/// Returns all topics of the output at `place`, which are sections if there is one output, and parts of its section if
/// there are several; empty ones are omitted.
pub(super) fn topics(view: &OutputView<'_>, place: usize, stem: &str) -> Vec<Section> {
    let (result, output) = (view.result, view.outputs[place]);
    let of = Topics { result, output, number: place + 1, stem, is_single: view.is_single_output() };
    let mut topics = vec![Section::new("warnings", "Warnings", of.warnings())];
    if output.indices.is_some() {
        topics.push(Section::new("indices", "Indices", of.indices()));
        topics.push(Section::new("shares", "Shares", of.shares()));
        topics.push(Section::new("noise", "The noise", of.noise()));
        topics.push(Section::new("interactions", "Interactions", of.interactions()));
        topics.push(Section::new("measures", "Other measures", of.measures()));
        topics.push(Section::new("convergence", "Convergence", of.convergence()));
    }
    topics.push(Section::new("distribution", "Distribution of the output", of.distribution()));
    if output.scatter.is_some() {
        topics.push(Section::new("scatter", "Scatter plots", vec![of.figure(scatter_chart, "scatter", "")]));
    }
    topics.push(Section::new("surrogate", "Surrogate", of.surrogate()));
    topics.push(Section::new("estimators", "Other estimators", of.estimators()));
    topics.retain(|topic| !topic.parts.is_empty());
    topics
}

impl Topics<'_> {
    /// Draws a figure; the names of its anchor and of its files end in `name`.
    fn figure(&self, draw: fn(&StudyResult, &OutputResult) -> Chart, name: &str, data: &str) -> Part {
        let (anchor, stem) = (format!("{}-{name}", self.number), format!("{}-{name}", self.stem));
        figure(&self.result.study, draw(self.result, self.output), anchor, stem, data)
    }

    /// Says why there are no indices, lists the warnings (of a single output; else they come before) and the failed runs.
    fn warnings(&self) -> Vec<Part> {
        let output = self.output;
        let mut parts = Vec::new();
        if output.indices.is_none() {
            parts.push(Part::no_indices(no_indices(output)));
        }
        if self.is_single {
            parts.extend(Part::warnings(&grouped_warnings(&[output])));
        }
        if output.runs_failed > 0 {
            let all = output.runs_ok + output.runs_failed;
            let share = share_of_runs(output.runs_failed as f64 / all as f64);
            let (failed, all) = (grouped(output.runs_failed), count(all, "run", "runs"));
            let points = count(output.base_points_used, "base point", "base points");
            parts.push(Part::Text(format!("{failed} of {all} ({share}) had no value; {points} are left.")));
        }
        parts.extend(failed_runs(output));
        parts
    }

    fn indices(&self) -> Vec<Part> {
        let (result, output) = (self.result, self.output);
        let mut parts = vec![self.figure(indices_chart, "indices", ".csv")];
        if self.number == 1 {
            parts.extend(definitions(result));
        }
        let tables = [tables::indices(result, output), tables::groups(result, output), tables::subsets(result, output)];
        parts.extend(tables.into_iter().flatten().map(Part::Table));
        parts
    }

    fn shares(&self) -> Vec<Part> {
        let mut effects = effects(self.output);
        if effects.clone().all(|(_, effect)| effect.shapley.is_none()) {
            let text = "The indices of factors that depend on each other do not divide the variance. Shapley effects do: shapley = true \
                        in [analysis].";
            let is_dependent = effects.any(|(_, effect)| effect.dependent.is_some());
            return is_dependent.then(|| Part::Text(text.to_owned())).into_iter().collect();
        }
        let mut parts = Vec::new();
        if self.number == 1 {
            let text = "Shapley effects divide the variance of the output among the factors, even if they depend on each other: each is \
                        the mean, over all orders of the factors, of the variance that a factor adds to that of the factors before it. \
                        They sum to 100 %.";
            parts.push(Part::OnPage(vec![Part::Text(text.to_owned())]));
        }
        let (chart, anchor) = (shapley_chart(self.result, self.output), format!("{}-shares", self.number));
        parts.push(figure(&self.result.study, chart, anchor, self.stem.to_owned(), ".csv"));
        parts
    }

    /// Describes the noise of a stochastic model, and the indices of the mean over it.
    fn noise(&self) -> Vec<Part> {
        let Some(noise) = &self.output.noise else { return Vec::new() };
        let mut text = noise_sentence(self.output).unwrap_or_default();
        let has_mean = noise.mean_share.estimate > 0.0;
        if has_mean {
            let rest = percent(complement(noise.effect.total));
            text.push_str(&format!(" The mean over the noise has {rest}: its indices refer to that variance only."));
        }
        if noise.of_mean.iter().all(|of_mean| of_mean.effect.total.is_none()) {
            text.push_str(" Its total indices need one more run for each factor: `mean_totals = true` in [noise].");
        }
        let mut parts = vec![Part::Text(text)];
        parts.extend(has_mean.then(|| noise_table(self.output, &noise.of_mean).into()));
        parts
    }

    fn interactions(&self) -> Vec<Part> {
        let sum = sum_of_indices(self.output).filter(|_| effects(self.output).count() > 1);
        let Some(text) = sum else { return Vec::new() };
        let mut parts = vec![Part::Text(text)];
        if let Some(table) = tables::pairs(self.output) {
            parts.extend([self.figure(pairs_chart, "pairs", "-second-order.csv"), table.into()]);
        }
        parts
    }

    /// Describes the measures, with a row for each factor.
    fn measures(&self) -> Vec<Part> {
        let Some(record) = &self.output.measures else { return Vec::new() };
        let measures = measures_of([record]);
        let text = format!(
            "{} They are estimated from the first {} rows A and B of the run, as from given data.",
            agreement(&self.output.name, &record.factors, &measures),
            grouped(record.rows as u64)
        );
        vec![Part::Text(text), measures_table_of(self.output, record, &measures).into()]
    }

    fn convergence(&self) -> Vec<Part> {
        let mut parts = Vec::new();
        if self.output.convergence.is_empty() {
            return parts;
        }
        if let Some(width) = widest_of(self.output).filter(|width| *width < WIDE) {
            let which = indices_measured([self.output]);
            parts.push(Part::Text(format!("At the end {which} is known to ± {} or better.", two_digits(width))));
        }
        parts.push(self.figure(convergence_chart, "convergence", "-convergence.csv"));
        parts
    }

    fn distribution(&self) -> Vec<Part> {
        let Some(table) = tables::moments(self.output) else {
            return vec![Part::Text(format!("There are no values of {} to show.", name(&self.output.name)))];
        };
        let chart = self.figure(distribution_chart, "distribution", "");
        vec![Part::Text(range(self.output)), chart, Part::OnPage(vec![table])]
    }

    /// Describes the accuracy of the surrogates, their benefit, and their terms.
    fn surrogate(&self) -> Vec<Part> {
        let Some(record) = &self.output.surrogate else {
            return Vec::new();
        };
        if record.plain.is_empty() {
            let text = format!(
                "A surrogate of {:.0} terms gives the indices. Without a part of the rows it explains {} % of the variance of that part.",
                record.terms,
                percent_below(record.explained)
            );
            return [vec![Part::Text(text)], tables::surrogate(self.output, record)].concat();
        }
        let mut text = format!(
            "Polynomials with {:.0} terms, fitted to all replicates but one in turn, explain {} % of the variance of the other; {}; {}.",
            record.terms,
            percent_below(record.explained),
            gain("first-order", record.corrects_first_order, record.gain_first_order),
            gain("total", record.corrects_total, record.gain_total)
        );
        if let Some(low) = &record.low {
            text.push_str(&format!(
                " The low-fidelity model `{}` alone explains {} %; the polynomials are fitted to the rest.",
                low.name,
                percent_below(low.explained.clamp(0.0, 1.0))
            ));
        }
        [vec![Part::Text(text)], tables::surrogate(self.output, record)].concat()
    }

    fn estimators(&self) -> Vec<Part> {
        let parts = tables::estimators(self.output);
        match parts.is_empty() {
            true => parts,
            false => vec![Part::Details { summary: "Indices by estimator".to_owned(), parts }],
        }
    }
}

/// Formats a share in percent, rounded down to two decimals.
fn percent_below(share: f64) -> String {
    significant((share * 1e4).floor() / 1e2)
}

/// Factor of the number of runs above which it cannot be checked.
const MAX_GAIN: f64 = 1000.0;

/// Says by how much the surrogates make indices more accurate.
fn gain(what: &str, is_corrected: bool, gain: Option<f64>) -> String {
    match gain.filter(|_| is_corrected) {
        Some(gain) if gain > MAX_GAIN => {
            format!("the {what} indices are as accurate as with more than {MAX_GAIN} times the runs")
        }
        Some(gain) => format!("the {what} indices are as accurate as with {} times the runs", two_digits(gain)),
        None if is_corrected => format!("the {what} indices are corrected by them"),
        None => format!("the {what} indices are the plain ones, which are no less accurate"),
    }
}

/// States the sum of the first-order indices, and the least share of the variance that is interaction.
fn sum_of_indices(output: &OutputResult) -> Option<String> {
    let sum = output.sum_first_order?;
    let rest = complement(sum);
    let interaction = match is_above_zero(rest) {
        true => format!(", so {} of the variance is interaction", percent(rest)),
        false => String::new(),
    };
    Some(format!("The first-order indices sum to {}{interaction}.", index(sum)))
}

/// Returns 1 minus a part, with the interval that follows from its own.
fn complement(part: Estimate) -> Estimate {
    let interval = part.interval.map(|Interval { low, high }| Interval { low: 1.0 - high, high: 1.0 - low });
    Estimate { estimate: 1.0 - part.estimate, interval }
}

/// Describes mean, standard deviation, and the range of most values.
fn range(output: &OutputResult) -> String {
    let mut texts = vec![format!("Mean {}", tables::mean(output).unwrap_or_else(|| "unknown".to_owned()))];
    texts.extend(tables::sd(output).map(|sd| format!("standard deviation {sd}")));
    if let Some(sample) = &output.distribution
        && let Some(median) = sample.quantile(50.0)
    {
        let (whose, (low, high)) = match sample.central() {
            Some(ends) => ("95 % of the values".to_owned(), ends),
            None => (count(sample.count, "value", "values"), (sample.min, sample.max)),
        };
        let [median, low, high] = [median, low, high].map(|x| among_with_unit(x, sample.spread(), &output.unit));
        texts.push(format!("median {median}"));
        texts.push(format!("{whose} from {low} to {high}"));
    }
    minus(&texts.join(", ")) + "."
}

/// Tabulates the first-order indices of the values next to the indices of the mean over the noise.
fn noise_table(output: &OutputResult, of_mean: &[Named<IndexPair<Option<Estimate>>>]) -> Table {
    let order = by_total(output).unwrap_or_default().into_iter();
    let rows = order.map(|(_, index)| (index, of_mean.iter().find(|of_mean| of_mean.name == index.name)));
    Table::from_rows("Indices of the values and of the mean over the noise, each of its own variance.", rows)
        .text("factor", |(index, _)| name(&index.name))
        .number("S_1 of a value", |(index, _)| index.effect.first_order)
        .number("S_1 of the mean", |(_, of_mean)| of_mean.and_then(|of_mean| of_mean.effect.first_order))
        .number("S_T of the mean", |(_, of_mean)| of_mean.and_then(|of_mean| of_mean.effect.total))
        .first(FACTORS, "factors, all in the JSON file")
        .into()
}
