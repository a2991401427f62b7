//! What the page says about one output, topic by topic.

use super::figures::{Figures, Numbered};
use super::lead::{by_total, widest};
use super::tables;
use super::words::{count, first, grouped, half_width, index, name, the};
use crate::report::page::{Mark, Part};
use crate::report::result::{EstimateRecord, IndexRecord, OutputRecord, ResultFile};
use crate::report::{capitalised, listed, width_after_doubling};

/// Most factors whose shares are drawn; of more, the chart of the indices shows the largest.
const DRAWN: usize = 30;

/// A topic: a section of its own where there is one output, a part of the output's section where there are several.
pub(super) struct Topic {
    pub id: &'static str,
    pub title: &'static str,
    pub parts: Vec<Part>,
}

/// All topics of an output; those of which there is nothing to say are left out.
pub(super) fn topics(figures: &mut Figures<'_>, of: Numbered<'_>) -> Vec<Topic> {
    let topic = |id, title, parts| Topic { id, title, parts };
    let mut topics = vec![topic("mind", "What to mind", warnings(of.output))];
    if of.output.indices.is_some() {
        topics.push(topic("shares", "Shares", shares(figures, of)));
        topics.push(topic("indices", "Indices", indices(figures, of)));
        topics.push(topic("interactions", "Interactions", interactions(figures, of)));
        topics.push(topic("convergence", "How the indices settled", convergence(figures, of)));
    }
    topics.push(topic("distribution", "Distribution of the output", distribution(figures, of)));
    if of.output.scatter.is_some() {
        let scatter = vec![figures.scatter(of)];
        topics.push(topic("scatter", "The output against its factors", scatter));
    }
    topics.push(topic("estimators", "Other estimators", estimators(of.output)));
    topics.retain(|topic| !topic.parts.is_empty());
    topics
}

/// Why there are no indices, what the run warns of, and which runs failed.
fn warnings(output: &OutputRecord) -> Vec<Part> {
    let mut parts = Vec::new();
    if let (None, Some(reason)) = (&output.indices, &output.reason) {
        let texts = vec![format!("There are no indices of {}: {reason}.", the(&output.name))];
        parts.push(Part::Notice { mark: Mark::Bad, kind: "No indices".to_owned(), texts });
    }
    if !output.warnings.is_empty() {
        let kind = if output.warnings.len() == 1 { "Warning" } else { "Warnings" }.to_owned();
        let texts = output.warnings.iter().map(|warning| format!("{}.", capitalised(warning))).collect();
        parts.push(Part::Notice { mark: Mark::Mixed, kind, texts });
    }
    if output.runs_failed > 0 {
        let all = output.runs_ok + output.runs_failed;
        let share = crate::report::share_of_runs(output.runs_failed as f64 / all as f64);
        let mut text =
            format!("{} of {} ({share}) had no value", grouped(output.runs_failed), count(all, "run", "runs"));
        if output.indices.is_some() {
            let points = count(output.base_points_used, "base point", "base points");
            text.push_str(&format!("; every estimate rests on {points} or more"));
        }
        parts.push(Part::Text(text + "."));
    }
    parts.extend(tables::failures(&output.failures));
    parts
}

fn shares(figures: &mut Figures<'_>, of: Numbered<'_>) -> Vec<Part> {
    let text = "A factor's share is its index in percent of the sum of the indices of all factors: of the first-order \
                indices S_1, which count what a factor does alone, or of the total indices S_T, which count what it does \
                together with others too.";
    let mut parts = Vec::new();
    parts.extend(of.is_first().then(|| Part::Text(text.to_owned())));
    if figures.result.factors.len() <= DRAWN {
        parts.push(figures.shares(of));
    }
    if let Some(table) = tables::shares(of.output) {
        parts.push(Part::Details { summary: "The shares as numbers".to_owned(), parts: vec![table] });
    }
    parts
}

fn indices(figures: &mut Figures<'_>, of: Numbered<'_>) -> Vec<Part> {
    let result = figures.result;
    let mut parts = Vec::new();
    parts.extend(of.is_first().then(|| Part::Text(definitions(result))));
    parts.push(figures.indices(of));
    parts.extend(tables::indices(result, of.output));
    parts.extend(below_zero(of.output).map(Part::Text));
    parts.extend(tables::joint(result, of.output));
    parts
}

/// What the columns of the tables of indices mean.
fn definitions(result: &ResultFile) -> String {
    let threshold = result.provenance.threshold;
    let text = format!(
        "S_1 is the part of the variance of the output that goes if a factor becomes known; S_T is the part that stays as \
         long as it is unknown. P(largest) is the probability that a factor's total index is the largest, \
         P(S_T > {threshold}) that it exceeds {threshold}."
    );
    match &result.provenance.interval {
        Some(words) => format!("{text} Intervals: {words}."),
        None => format!("{text} There are no intervals: a single replicate says nothing about its error."),
    }
}

/// Estimates below 0, which no index is, in words.
fn below_zero(output: &OutputRecord) -> Option<String> {
    const NAMED: usize = 6;
    let both = |index: &IndexRecord| {
        let label = |what: &str| format!("{what} of {}", name(&index.factor));
        [(label("S_1"), index.effect.first_order), (label("S_T"), index.effect.total)]
    };
    let negative: Vec<(String, EstimateRecord)> =
        output.indices.iter().flatten().flat_map(both).filter(|(_, index)| index.estimate < 0.0).collect();
    if negative.is_empty() {
        return None;
    }
    let outside = negative.iter().filter(|(_, index)| index.high.is_some_and(|high| high < 0.0)).count();
    let unknown = negative.iter().filter(|(_, index)| index.high.is_none()).count();
    let mut names: Vec<String> = negative.iter().take(NAMED).map(|(name, _)| name.clone()).collect();
    let (more, one) = (negative.len() - names.len(), negative.len() == 1);
    if more > 0 {
        names.push(format!("{more} more"));
    }
    let mut text = format!("{} {} below 0, which no index can be: ", listed(&names), if one { "is" } else { "are" });
    text.push_str(match (outside, unknown) {
        (0, 0) if one => "0 is within the interval, so the index is 0 to within its error.",
        (0, 0) => "0 is within the intervals, so these indices are 0 to within their errors.",
        (0, _) => "without intervals nothing tells whether 0 is within the error.",
        _ => "not all intervals contain 0, by chance (once in 20 times) or for want of samples.",
    });
    Some(text)
}

fn interactions(figures: &mut Figures<'_>, of: Numbered<'_>) -> Vec<Part> {
    let output = of.output;
    let Some(order) = by_total(output).filter(|order| order.len() > 1) else { return Vec::new() };
    let mut text = super::lead::interactions(output.sum_first_order);
    let difference = |index: &&&IndexRecord| index.effect.interaction.map_or(f64::NEG_INFINITY, |i| i.estimate);
    let most = order.iter().max_by(|a, b| difference(a).total_cmp(&difference(b)));
    if let Some((most, gap)) = most.and_then(|most| Some((most, most.effect.interaction?)))
        && gap.low.is_some_and(|low| low > 0.0)
    {
        let (factor, difference) = (name(&most.factor), index(gap));
        text.push_str(&format!(" Most of all, {factor} acts together with others: S_T − S_1 is {difference}."));
    }
    let mut parts = vec![Part::Text(text), figures.interactions(of)];
    parts.extend(tables::pairs(output));
    parts
}

fn convergence(figures: &mut Figures<'_>, of: Numbered<'_>) -> Vec<Part> {
    let output = of.output;
    let mut sentences = Vec::new();
    if let Some(width) = widest(output) {
        sentences.push(format!("In the end every index is known to ± {} or better.", half_width(width)));
    }
    match (width_after_doubling(&output.convergence), output.convergence.last()) {
        (Some(width), Some(last)) => sentences.push(format!(
            "If the trend of the last stages goes on, doubling the runs to {} would bring about ± {}.",
            grouped(2 * last.model_runs),
            half_width(width)
        )),
        _ => sentences
            .push("There are too few stages with intervals to say what doubling the runs would bring.".to_owned()),
    }
    let mut parts = vec![Part::Text(sentences.join(" "))];
    if !output.convergence.is_empty() {
        parts.push(figures.convergence(of));
    }
    if let Some(table) = tables::stages(output) {
        parts.push(Part::Details { summary: "The stages as numbers".to_owned(), parts: vec![table] });
    }
    parts
}

fn distribution(figures: &mut Figures<'_>, of: Numbered<'_>) -> Vec<Part> {
    let Some(table) = tables::moments(of.output) else {
        let text = format!("There are no values of {} to show.", the(&of.output.name));
        return vec![Part::Text(text)];
    };
    vec![figures.distribution(of), table]
}

fn estimators(output: &OutputRecord) -> Vec<Part> {
    let parts = tables::estimators(output);
    if parts.is_empty() {
        return parts;
    }
    let text =
        "The same runs through the other formulas that the study lists; the default ones are named in the provenance.";
    let details = Part::Details { summary: "Indices by estimator".to_owned(), parts };
    vec![Part::Text(text.to_owned()), details]
}

/// An output's name and unit as a heading.
pub(super) fn heading(output: &OutputRecord) -> String {
    match output.unit.as_str() {
        "" | "1" => first(&output.name),
        unit => format!("{} ({unit})", first(&output.name)),
    }
}
