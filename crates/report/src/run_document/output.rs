//! The topics of the document on one output.

use apportion::given::Measure;
use apportion::result::{IndexRecord, NoiseRecord, OutputResult, RunMeasures, StudyResult, SurrogateTrial};

use super::figures::Figures;
use super::shared::{complement, definitions, failed_runs, grouped_warnings};
use super::tables;
use super::tables::FACTORS;
use crate::document::{Part, Section, Table, csv};
use crate::format::{
    among_with_unit, count, grouped, index, is_above_zero, minus, name, percent, share_of_runs, significant, two_digits,
};
use crate::given::{agreement, measures_table};
use crate::leading::{WIDE, by_total, indices_measured, no_indices, widest_of};
use crate::{convergence_chart, distribution_chart, indices_chart, pairs_chart, scatter_chart, shapley_chart};

/// Returns all topics of an output, which are sections if there is one output, and parts of its section if there are
/// several; empty ones are omitted.
pub(super) fn topics(figures: Figures<'_>, number: usize) -> Vec<Section> {
    let output = figures.output(number);
    let mut topics = vec![Section::new("warnings", "Warnings", mind(output, figures.is_only))];
    if output.indices.is_some() {
        topics.push(Section::new("indices", "Indices", indices(figures, number)));
        topics.push(Section::new("shares", "Shares", shares(figures, number)));
        topics.push(Section::new("noise", "The noise", noise(output)));
        topics.push(Section::new("interactions", "Interactions", interactions(figures, number)));
        topics.push(Section::new("measures", "Other measures", measures(output)));
        topics.push(Section::new("convergence", "Convergence", convergence(figures, number)));
    }
    topics.push(Section::new("distribution", "Distribution of the output", distribution(figures, number)));
    if output.scatter.is_some() {
        topics.push(Section::new("scatter", "Scatter plots", vec![figures.draw(number, "scatter", scatter_chart, "")]));
    }
    topics.push(Section::new("surrogate", "Surrogate", surrogate(output)));
    topics.push(Section::new("estimators", "Other estimators", estimators(output)));
    topics.retain(|topic| !topic.parts.is_empty());
    topics
}

/// Says why there are no indices, lists the warnings (of a single output; else they come before) and the failed runs.
fn mind(output: &OutputResult, is_only: bool) -> Vec<Part> {
    let mut parts = Vec::new();
    if output.indices.is_none() {
        parts.push(Part::no_indices(no_indices(output)));
    }
    parts.extend(Part::warnings(&grouped_warnings(std::slice::from_ref(output))).filter(|_| is_only));
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

/// Describes the accuracy of the surrogates, their benefit, and their terms.
fn surrogate(output: &OutputResult) -> Vec<Part> {
    let Some(record) = &output.surrogate else {
        let declined = |trial: SurrogateTrial| {
            format!(
                "The indices are plain ones: in a trial on {} runs, surrogates made errors {} times smaller, and all runs are \
                 corrected only from {} times smaller on (`surrogate = \"on\"` always corrects them).",
                grouped(trial.runs),
                significant((trial.gain * 10.0).floor() / 10.0),
                trial.needed
            )
        };
        return output.surrogate_trial.map(declined).map(Part::Text).into_iter().collect();
    };
    let percent = |share: f64| significant((share * 1e4).floor() / 1e2);
    let gain = |what: &str, corrected: bool, gain: Option<f64>| match gain.filter(|_| corrected) {
        Some(gain) => format!("the {what} indices are as accurate as with {} times the runs", two_digits(gain)),
        None if corrected => format!("the {what} indices are corrected by them"),
        None => format!("the {what} indices are the plain ones, which are no less accurate"),
    };
    let mut text = format!(
        "Polynomials with {:.0} terms, fitted to all replicates but one in turn, explain {} % of the variance of the other; {}; {}.",
        record.terms,
        percent(record.explained),
        gain("first-order", record.corrects_first_order, record.gain_first_order),
        gain("total", record.corrects_total, record.gain_total)
    );
    if let Some(low) = &record.low {
        let explained = percent(low.explained.clamp(0.0, 1.0));
        text.push_str(&format!(
            " The low-fidelity model `{}` alone explains {explained} %; the polynomials are fitted to the rest.",
            low.name
        ));
    }
    [vec![Part::Text(text)], tables::surrogate(output, record)].concat()
}

fn shares(figures: Figures<'_>, number: usize) -> Vec<Part> {
    let any = |asked: fn(&IndexRecord) -> bool| figures.output(number).indices.iter().flatten().any(asked);
    let text = match any(|index| index.effect.shapley.is_some()) {
        true => {
            "Shapley effects divide the variance of the output among the factors, even if they depend on each other: each is the mean, \
             over all orders of the factors, of the variance that a factor adds to that of the factors before it. They sum to 100 %."
        }
        false if any(|index| index.effect.dependent.is_some()) => {
            let text = "The indices of factors that depend on each other do not divide the variance. Shapley effects do: shapley = true \
                        in [analysis].";
            return vec![Part::Text(text.to_owned())];
        }
        false => return Vec::new(),
    };
    let text = (number == 1).then(|| Part::OnPage(vec![Part::Text(text.to_owned())]));
    text.into_iter().chain([figures.draw(number, "shares", shapley_chart, ".csv")]).collect()
}

fn indices(figures: Figures<'_>, number: usize) -> Vec<Part> {
    let result = figures.result;
    let mut parts = vec![figures.draw(number, "indices", indices_chart, ".csv")];
    if number == 1 {
        parts.extend(definitions(result));
    }
    let tables = [
        tables::indices(result, figures.output(number)),
        tables::groups(result, figures.output(number)),
        tables::subsets(result, figures.output(number)),
    ];
    parts.extend(tables.into_iter().flatten().map(Part::Table));
    parts
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

fn interactions(figures: Figures<'_>, number: usize) -> Vec<Part> {
    let output = figures.output(number);
    let Some(text) = sum_of_indices(output).filter(|_| output.indices.iter().flatten().count() > 1) else {
        return Vec::new();
    };
    let mut parts = vec![Part::Text(text)];
    if let Some(table) = tables::pairs(output) {
        parts.extend([figures.draw(number, "pairs", pairs_chart, "-second-order.csv"), table.into()]);
    }
    parts
}

fn convergence(figures: Figures<'_>, number: usize) -> Vec<Part> {
    if figures.output(number).convergence.is_empty() {
        return Vec::new();
    }
    let width = widest_of(figures.output(number)).filter(|width| *width < WIDE).map(|width| {
        let which = indices_measured(std::slice::from_ref(figures.output(number)));
        Part::Text(format!("At the end {which} is known to ± {} or better.", two_digits(width)))
    });
    width.into_iter().chain([figures.draw(number, "convergence", convergence_chart, "-convergence.csv")]).collect()
}

fn distribution(figures: Figures<'_>, number: usize) -> Vec<Part> {
    let Some(table) = tables::moments(figures.output(number)) else {
        return vec![Part::Text(format!("There are no values of {} to show.", name(&figures.output(number).name)))];
    };
    vec![
        Part::Text(range(figures.output(number))),
        figures.draw(number, "distribution", distribution_chart, ""),
        Part::OnPage(vec![table]),
    ]
}

/// Describes mean, standard deviation, and the range of most values.
fn range(output: &OutputResult) -> String {
    let sample = output.distribution.as_ref().map(|distribution| &distribution.sample);
    let spread = sample.map_or(0.0, |sample| sample.spread());
    let value = |x: f64| among_with_unit(x, spread, &output.unit);
    let mut said = vec![format!("Mean {}", tables::mean(output).unwrap_or_else(|| "unknown".to_owned()))];
    said.extend(tables::sd(output).map(|sd| format!("standard deviation {sd}")));
    if let Some((sample, median)) = sample.and_then(|sample| Some((sample, sample.quantile(50.0)?))) {
        let (whose, (low, high)) = match sample.central() {
            Some(ends) => ("95 % of the values".to_owned(), ends),
            None => (count(sample.count, "value", "values"), (sample.min, sample.max)),
        };
        said.push(format!("median {}", value(median)));
        said.push(format!("{whose} from {} to {}", value(low), value(high)));
    }
    minus(&said.join(", ")) + "."
}

fn estimators(output: &OutputResult) -> Vec<Part> {
    let parts = tables::estimators(output);
    match parts.is_empty() {
        true => parts,
        false => vec![Part::Details { summary: "Indices by estimator".to_owned(), parts }],
    }
}

/// States the share of the variance of a stochastic model's output that no factor explains.
pub(super) fn sentence(output: &OutputResult) -> Option<String> {
    let total = output.noise.as_ref()?.effect.total;
    Some(format!("Of the variance, {} is noise that no factor explains.", percent(total)))
}

/// Describes the noise of a stochastic model, and the indices of the mean over it.
pub(super) fn noise(output: &OutputResult) -> Vec<Part> {
    let Some(noise) = &output.noise else { return Vec::new() };
    let mut text = sentence(output).unwrap_or_default();
    if noise.mean_share.estimate > 0.0 {
        let rest = percent(complement(noise.effect.total));
        text.push_str(&format!(" The mean over the noise has {rest}: its indices refer to that variance only."));
    }
    if noise.of_mean.iter().all(|of_mean| of_mean.total.is_none()) {
        text.push_str(" Its total indices need one more run for each factor: `mean_totals = true` in [noise].");
    }
    let table = (noise.mean_share.estimate > 0.0).then(|| noise_table(output, noise).into());
    [Part::Text(text)].into_iter().chain(table).collect()
}

/// Tabulates the first-order indices of the values next to the indices of the mean over the noise.
fn noise_table(output: &OutputResult, noise: &NoiseRecord) -> Table {
    let order = by_total(output).unwrap_or_default();
    let of_mean = |index: &IndexRecord| noise.of_mean.iter().find(|of_mean| of_mean.name == index.factor);
    Table::from_rows("Indices of the values and of the mean over the noise, each of its own variance.", order)
        .text("factor", |(_, index)| name(&index.factor))
        .number("S_1 of a value", |(_, index)| index.effect.first_order)
        .number("S_1 of the mean", |(_, index)| of_mean(index).and_then(|of_mean| of_mean.first_order))
        .number("S_T of the mean", |(_, index)| of_mean(index).and_then(|of_mean| of_mean.total))
        .first(FACTORS, "factors, all in the JSON file")
        .into()
}

/// Describes the measures, with a row for each factor.
pub(super) fn measures(output: &OutputResult) -> Vec<Part> {
    let Some(record) = &output.measures else { return Vec::new() };
    let wanted = wanted([record]);
    let text = format!(
        "{} They are estimated from the first {} rows A and B of the run, as from given data.",
        agreement(&output.name, &record.factors, &wanted),
        grouped(record.rows as u64)
    );
    vec![Part::Text(text), measures_table_of(output, record, &wanted).into()]
}

/// Returns the measures that any of the records has.
fn wanted<'a>(records: impl IntoIterator<Item = &'a RunMeasures>) -> Vec<Measure> {
    let factors: Vec<_> = records.into_iter().flat_map(|record| &record.factors).collect();
    let is_there = |measure: &Measure| factors.iter().any(|of| of.measures.contains_key(measure));
    Measure::ALL.into_iter().filter(is_there).collect()
}

fn measures_table_of(output: &OutputResult, record: &RunMeasures, wanted: &[Measure]) -> Table {
    let table = measures_table(&output.name, ("factor", &record.factors), wanted);
    let printed = Some((0..table.rows.len().min(FACTORS)).collect());
    Table { printed, ..table }
}

/// Formats the measures of all outputs as CSV.
pub(super) fn measures_csv(result: &StudyResult) -> String {
    let wanted = wanted(result.outputs.iter().filter_map(|output| output.measures.as_ref()));
    let tables =
        result.outputs.iter().filter_map(|output| Some(measures_table_of(output, output.measures.as_ref()?, &wanted)));
    csv(tables)
}
