//! What the document says about one output, topic by topic.

use super::figures::{CONVERGENCE, DISTRIBUTION, Figures, INDICES, INTERACTIONS, Numbered, PAIRS, SCATTER, SHARES};
use super::measures::measures;
use super::noise::noise;
use super::warnings::folded;
use super::{tables, values};
use crate::analysis::warnings::LITTLE;
use crate::estimate::ShapleyMethod;
use crate::report::document::Part;
use crate::report::format::{among_with_unit, count, grouped, name, share_of_runs, significant, two_digits};
use crate::report::interval_widths::{WIDE, has_too_few_stages, indices_measured, widest_of, width_after_doubling};
use crate::report::leading::moving;
use crate::report::listed;
use crate::report::result::{EstimateRecord, IndexRecord, OutputRecord, ResultFile};
use crate::report::study_sections::{failures, inputs};

/// Most factors whose shares are drawn unfolded; of more, the chart of the indices shows the largest.
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
    let mut topics =
        vec![topic("mind", "What to mind", mind(of.output, figures.result.outputs.len() == 1 && figures.count() == 0))];
    if of.output.indices.is_some() {
        topics.push(topic("indices", "Indices", indices(figures, of)));
        topics.push(topic("shares", "Shares", shares(figures, of)));
        topics.push(topic("noise", "The noise", noise(figures.result, of.output)));
        topics.push(topic("interactions", "Interactions", interactions(figures, of)));
        topics.push(topic("measures", "Other measures", measures(figures.result, of.output)));
        topics.push(topic("convergence", "How the indices settled", convergence(figures, of)));
    }
    topics.push(topic("distribution", "Distribution of the output", distribution(figures, of)));
    if of.output.scatter.is_some() {
        let scatter = vec![figures.draw(of, SCATTER)];
        topics.push(topic("scatter", "The output against its factors", scatter));
    }
    topics.push(topic("surrogate", "What the surrogate did", surrogate(figures.result, of.output)));
    topics.push(topic("estimators", "Other estimators", estimators(of.output)));
    topics.retain(|topic| !topic.parts.is_empty());
    topics
}

/// Why there are no indices, what the run warns of (of one of several outputs it is said before), and which runs failed.
fn mind(output: &OutputRecord, is_only: bool) -> Vec<Part> {
    let mut parts = Vec::new();
    if let (None, Some(reason)) = (&output.indices, &output.reason) {
        parts.push(Part::no_indices(format!("There are no indices of {}: {reason}.", name(&output.name))));
    }
    parts.extend(Part::warnings(&folded(std::slice::from_ref(output))).filter(|_| is_only));
    if output.runs_failed > 0 {
        let all = output.runs_ok + output.runs_failed;
        let share = share_of_runs(output.runs_failed as f64 / all as f64);
        let mut text =
            format!("{} of {} ({share}) had no value", grouped(output.runs_failed), count(all, "run", "runs"));
        if output.indices.is_some() {
            let points = count(output.base_points_used, "base point", "base points");
            text.push_str(&format!("; every estimate rests on {points} or more"));
        }
        parts.push(Part::Text(text + "."));
    }
    let failed = output.failures.iter();
    parts.extend(failures(
        failed.map(|f| (&*f.reason, format!("row {}: {}", f.first_row, inputs(&f.first_inputs)), f.runs)),
    ));
    parts
}

/// How well polynomials stand in for the model, what they gained, and what they consist of.
fn surrogate(result: &ResultFile, output: &OutputRecord) -> Vec<Part> {
    let Some(record) = &output.surrogate else { return Vec::new() };
    let explained = 100.0 * record.explained;
    // Plain rows have no part in plain indices; where they are of little use, a warning says so and no gain is told.
    let (has_plain_rows, is_poor) = (result.provenance.plain_rows > 0, record.explained < LITTLE);
    let than = if has_plain_rows { "its base samples alone" } else { "the runs" };
    let gain = |what: &str, corrected: bool, gain: Option<f64>| match gain {
        _ if !corrected => format!("the {what} indices are the plain ones, which are no less accurate"),
        Some(gain) if !(has_plain_rows && is_poor) => format!(
            "the {what} indices are corrected by them, with the accuracy of {} times {than}",
            times(gain, output.base_points_used)
        ),
        _ => format!("the {what} indices are corrected by them"),
    };
    let text = format!(
        "Polynomials with {:.0} terms were fitted to the runs of all replicates but one, in turn. They explain {} % of the \
         variance of the runs that they were not fitted to. Their indices are known exactly, and the runs show the rest: {}; {}.",
        record.terms,
        significant((explained * 1e4).floor() / 1e4),
        gain("first-order", record.corrects_first_order, record.gain_first_order),
        gain("total", record.corrects_total, record.gain_total)
    );
    let mut parts = vec![Part::Text(text)];
    parts.extend(record.low.as_ref().map(|low| {
        let explained = 100.0 * low.explained.clamp(0.0, 1.0);
        Part::Text(format!(
            "Beside the polynomials the cheaper model `{}` stands in, which by itself explains {} % of the variance: the \
             polynomials are those of what it leaves.",
            low.name,
            significant((explained * 1e4).floor() / 1e4)
        ))
    }));
    parts.extend(values::surrogate(output, record));
    parts
}

/// How many times the runs, to two digits; of few base points no more is told than that it is many times.
fn times(gain: f64, base_points: u64) -> String {
    const MANY: f64 = 1e6;
    /// Of fewer base points the error of plain indices is known to little more than its power of ten.
    const FEW: u64 = 16;
    match gain {
        1000.0.. if base_points < FEW => "more than a thousand".to_owned(),
        MANY.. => "more than a million".to_owned(),
        100.0.. => grouped(format!("{gain:.1e}").parse::<f64>().unwrap_or(gain) as u64),
        _ => significant(format!("{gain:.1e}").parse().unwrap_or(gain)),
    }
}

fn shares(figures: &mut Figures<'_>, of: Numbered<'_>) -> Vec<Part> {
    let any = |asked: fn(&IndexRecord) -> bool| of.output.indices.iter().flatten().any(asked);
    let of_groups = of.output.shapley_groups.is_some();
    if of_groups || any(|index| index.effect.shapley.is_some()) {
        let is_random = figures.result.provenance.shapley_method.as_deref() == Some(ShapleyMethod::Permutations.name());
        let (players, player) = match of_groups {
            true => ("groups of factors, and factors that have no group,", "group"),
            false => ("factors", "factor"),
        };
        let orders = match (is_random, of_groups) {
            (true, true) => "over a random order of them at each base sample",
            (true, false) => "over a random order of the factors at each base sample",
            (false, true) => "over all orders of them",
            (false, false) => "over all orders of the factors",
        };
        let text = format!(
            "Shapley effects share out the variance of the output among the {players} whether or not they depend on each other: \
             each is the mean, {orders}, of what a {player} adds to what those before it explain. They sum to 100 %."
        );
        let table = tables::players(of.output);
        return [Part::Text(text), figures.draw(of, SHARES)].into_iter().chain(table).collect();
    }
    if any(|index| index.effect.dependent.is_some()) {
        return vec![Part::Text(
            "The indices of factors that depend on each other share out nothing. Shapley effects do: shapley = true in [analysis]."
                .to_owned(),
        )];
    }
    let text = "A factor's share is its index in percent of the sum of the indices of all factors: of the first-order \
                indices S_1, which count what a factor does alone, or of the total indices S_T, which count what it does \
                together with others too.";
    let mut parts = Vec::new();
    parts.extend(of.is_first().then(|| Part::OnPage(vec![Part::Text(text.to_owned())])));
    let figure = figures.draw(of, SHARES);
    parts.push(match figures.result.factors.len() {
        0..=DRAWN => figure,
        _ => Part::Details { summary: "The shares of all factors as a chart".to_owned(), parts: vec![figure] },
    });
    if let Some(table) = tables::shares(of.output) {
        parts.push(Part::Details { summary: "The shares as numbers".to_owned(), parts: vec![table] });
    }
    parts
}

fn indices(figures: &mut Figures<'_>, of: Numbered<'_>) -> Vec<Part> {
    let result = figures.result;
    let mut parts = Vec::new();
    if of.is_first() {
        parts.extend(definitions(result));
    }
    parts.push(figures.draw(of, INDICES));
    parts.extend(tables::indices(result, of.output));
    parts.extend(below_zero(of.output).map(Part::Text));
    parts.extend(never_moved(of.output).map(Part::Text));
    parts.extend(tables::joint(result, of.output));
    parts
}

/// What the columns of the tables of indices mean, and what the intervals are.
pub(super) fn definitions(result: &ResultFile) -> [Part; 2] {
    let threshold = result.provenance.threshold;
    if !result.study.dependences.is_empty() {
        let text = "Factors depend on each other. S_1 is the part of the variance of the output that goes if a factor becomes known, \
                    with all that it tells of others; S_T is the part that stays as long as it alone is unknown, which is what \
                    it has on its own, and may be smaller (Kucherenko, Tarantola and Annoni 2012). The other two are S_1 of what \
                    the factor has on its own, given the others, and S_T with all that it tells of others (Mara, Tarantola and \
                    Annoni 2015).";
        let intervals =
            result.provenance.interval.as_ref().map_or_else(String::new, |words| format!("Intervals (±): {words}."));
        return [Part::OnPage(vec![Part::Text(text.to_owned())]), Part::Text(intervals)];
    }
    let indices = format!(
        "S_1 is the part of the variance of the output that goes if a factor becomes known; S_T is the part that stays as \
         long as it is unknown. P(largest) is the probability that a factor's total index is the largest, \
         P(S_T > {threshold}) that it exceeds {threshold}."
    );
    let intervals = match &result.provenance.interval {
        Some(words) => format!("Intervals (±): {words}."),
        None => "There are no intervals: a single replicate says nothing about its error.".to_owned(),
    };
    [Part::OnPage(vec![Part::Text(indices)]), Part::Text(intervals)]
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

/// Factors that moved the output in no run, where so few base points leave room for an effect in a part of the factor space.
fn never_moved(output: &OutputRecord) -> Option<String> {
    /// A part of the factor space that is worth a word.
    const WORTH: f64 = 0.01;
    // An event of this probability is missed by so many points once in 20 times.
    let unseen = 1.0 - libm::pow(0.05, 1.0 / output.base_points_used.max(1) as f64);
    let is_still = |index: &&IndexRecord| {
        let EstimateRecord { estimate, high, .. } = index.effect.total;
        estimate == 0.0 && high == Some(0.0)
    };
    let all: Vec<&IndexRecord> = output.indices.iter().flatten().collect();
    let names: Vec<String> = all.iter().copied().filter(is_still).map(|index| name(&index.factor)).collect();
    if unseen < WORTH || names.is_empty() || names.len() == all.len() {
        return None;
    }
    Some(format!(
        "{} moved {} at none of the {} base points: what acts in less than {} % of the factor space may be missed.",
        listed(&names),
        name(&output.name),
        grouped(output.base_points_used),
        two_digits(100.0 * unseen)
    ))
}

fn interactions(figures: &mut Figures<'_>, of: Numbered<'_>) -> Vec<Part> {
    let output = of.output;
    let is_dependent = !figures.result.study.dependences.is_empty();
    if is_dependent || output.indices.as_ref().is_none_or(|indices| indices.len() < 2) {
        return Vec::new();
    }
    let mut parts = Vec::new();
    // One factor alone interacts with none.
    if moving(output) > 1 {
        let mut text = super::interactions::interactions(figures.result, output);
        text.extend(super::interactions::leader(output).map(|leader| format!(" {leader}")));
        parts.extend([Part::Text(text), figures.draw(of, INTERACTIONS)]);
    }
    if output.second_order.as_ref().is_some_and(|pairs| !pairs.is_empty()) {
        parts.push(figures.draw(of, PAIRS));
    }
    parts.extend(tables::pairs(figures.result, output));
    parts
}

fn convergence(figures: &mut Figures<'_>, of: Numbered<'_>) -> Vec<Part> {
    let output = of.output;
    let mut sentences = Vec::new();
    if output.surrogate.is_some() {
        sentences.push("The surrogate was fitted anew to the runs of every stage.".to_owned());
    }
    if let Some(width) = widest_of(output).filter(|width| *width < WIDE) {
        let which = indices_measured(std::slice::from_ref(output));
        sentences.push(format!("In the end {which} is known to ± {} or better.", two_digits(width)));
    }
    match (width_after_doubling(&output.convergence), output.convergence.last()) {
        (Some(width), Some(last)) => sentences.push(format!(
            "If the trend of the last stages goes on, doubling the runs to {} would bring about ± {}.",
            grouped(2 * last.model_runs),
            two_digits(width)
        )),
        _ if has_too_few_stages(&output.convergence) => sentences
            .push("There are too few stages with intervals to say what doubling the runs would bring.".to_owned()),
        _ => (),
    }
    let mut parts = Vec::new();
    if !sentences.is_empty() {
        parts.push(Part::Text(sentences.join(" ")));
    }
    if !output.convergence.is_empty() {
        parts.push(figures.draw(of, CONVERGENCE));
    }
    if let Some(table) = tables::stages(output) {
        let details = Part::Details { summary: "The stages as numbers".to_owned(), parts: vec![table] };
        parts.push(Part::OnPage(vec![details]));
    }
    parts
}

fn distribution(figures: &mut Figures<'_>, of: Numbered<'_>) -> Vec<Part> {
    let Some(table) = values::moments(of.output) else {
        let text = format!("There are no values of {} to show.", name(&of.output.name));
        return vec![Part::Text(text)];
    };
    vec![Part::Text(range(of.output)), figures.draw(of, DISTRIBUTION), Part::OnPage(vec![table])]
}

/// Mean, standard deviation, and the range of most values.
fn range(output: &OutputRecord) -> String {
    let sample = output.distribution.as_ref().map(|distribution| &distribution.sample);
    let spread = sample.map_or(0.0, |sample| sample.spread());
    let value = |x: f64| among_with_unit(x, spread, &output.unit);
    let mean = match (values::mean(output), values::corrected_from(output)) {
        (Some(mean), Some(own)) => Some(format!("{mean}, corrected by the surrogate (that of the values is {own})")),
        (mean, _) => mean,
    };
    let mut text = match (mean, values::sd(output)) {
        (Some(mean), Some(sd)) => format!("Mean {mean}, standard deviation {sd}"),
        (Some(mean), None) => format!("Mean {mean}"),
        _ => return format!("There is no mean of {}.", name(&output.name)),
    };
    if let Some((sample, median)) = sample.and_then(|sample| Some((sample, sample.quantile(50.0)?))) {
        let (whose, (low, high)) = match sample.central() {
            Some(ends) => ("95 % of the values".to_owned(), ends),
            None => (count(sample.count, "value", "values"), (sample.min, sample.max)),
        };
        text.push_str(&format!("; median {}, {whose} from {} to {}", value(median), value(low), value(high)));
    }
    crate::report::format::minus(&text) + "."
}

fn estimators(output: &OutputRecord) -> Vec<Part> {
    let parts = tables::estimators(output);
    if parts.is_empty() {
        return parts;
    }
    let text =
        "The same runs through the other formulas that the study lists; the default ones are named in the provenance.";
    let details = Part::Details { summary: "Indices by estimator".to_owned(), parts };
    vec![Part::OnPage(vec![Part::Text(text.to_owned())]), details]
}
