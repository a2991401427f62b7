//! The summary: which factor matters most, with which certainty.

use apportion::analysis::MIN_OUTPUTS_TOGETHER;
use apportion::result::{OutputResult, StudyResult};
use apportion_base::text::listed;

use super::overview;
use crate::format::{grouped, index, name, two_digits};
use crate::leading::{self, Contender, WIDE, by_total, first_answers, indices_measured, leader_of, widest_interval};

/// Returns the paragraphs at the top of the page: on every series, then on the `single` outputs outside series.
pub(super) fn lead(result: &StudyResult, single: &StudyResult) -> Vec<String> {
    let series = result.series.iter().map(|series| super::series::answer(result, series));
    let mut lead = first_answers(series.collect());
    lead.extend(match single.outputs.len() {
        ..MIN_OUTPUTS_TOGETHER => first_answers(single.outputs.iter().map(answer).collect()),
        _ => overview::answers(single),
    });
    lead.into_iter().chain([settled(result)]).collect()
}

/// Says which factor matters most for an output, and how much is noise, or which factors follow.
pub(super) fn answer(output: &OutputResult) -> String {
    let order = by_total(output).unwrap_or_default();
    let contenders: Vec<Contender> = order.iter().map(|(_, index)| Contender::from_index(index)).collect();
    let leaders = leading::leaders(&contenders).len();
    let next = order.iter().skip(leaders).take(2);
    let next: Vec<String> =
        next.map(|(_, next)| format!("{} ({})", name(&next.factor), index(next.effect.weight()))).collect();
    let verb = if next.len() == 1 { "comes" } else { "come" };
    let next = (!next.is_empty()).then(|| format!("Next {verb} {}.", listed(&next)));
    let sentences = [Some(leader_of(output)), super::output::sentence(output).or(next)];
    sentences.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

/// States the precision of the indices, and the number of runs.
fn settled(result: &StudyResult) -> String {
    let runs = grouped(result.provenance.model_runs);
    let target = match result.stopping.as_ref().and_then(|stopping| stopping.target_met) {
        Some(true) => "; the target is met",
        Some(false) => "; the target is not met",
        None => "",
    };
    match widest_interval(result) {
        None => format!("The study took {runs} model runs; the error of the indices is unknown{target}."),
        Some(widest) if widest < WIDE => {
            let which = indices_measured(&result.outputs);
            format!("After {runs} model runs {which} is known to ± {} or better{target}.", two_digits(widest))
        }
        Some(_) => format!("After {runs} model runs the intervals are too wide to determine the indices{target}."),
    }
}
