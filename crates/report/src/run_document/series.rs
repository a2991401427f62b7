//! The document on a series: its indices along the axis and as a whole.

use apportion::Scaling;
use apportion::result::{AggregateRecord, OutputResult, SeriesRecord, StudyResult};

use super::figures::Figures;
use super::overview;
use super::shared::definitions;
use crate::document::{Part, Section, Table};
use crate::format::{heading, name};
use crate::leading::leader_of_all;
use crate::run_charts::{along_chart, together_chart, values};

/// Number of series with all their charts and a table of their values.
const IN_FULL: usize = 4;

/// Returns the values of `series` alone, as a result of its own.
fn values_alone(result: &StudyResult, series: &SeriesRecord) -> StudyResult {
    let outputs = values(result, series).to_vec();
    let aggregate = AggregateRecord {
        outputs: outputs.iter().map(|output| output.name.clone()).collect(),
        weighting: Scaling::Plain,
        indices: series.indices.clone(),
        noise: None,
        reason: series.reason.clone(),
    };
    with_outputs(result, outputs, Some(aggregate))
}

/// Returns the outputs of `result` that are in no series, as a result of its own.
pub(super) fn single_outputs(result: &StudyResult) -> StudyResult {
    let single = |place: usize| !result.series.iter().any(|series| series.places().contains(&place));
    let outputs = result.outputs.iter().enumerate().filter(|(place, _)| single(*place));
    with_outputs(result, outputs.map(|(_, output)| output.clone()).collect(), result.aggregate.clone())
}

/// Returns `result` as if the study had only the output or series of that name; without a name, or if it is missing,
/// the first one.
pub fn one_output(result: &StudyResult, name: Option<&str>) -> StudyResult {
    let series = |found: &dyn Fn(&SeriesRecord) -> bool| result.series.iter().find(|series| found(series));
    let place = name.and_then(|name| result.outputs.iter().position(|output| output.name == name));
    let named = name.and_then(|name| series(&|series| series.name == name));
    let first = || series(&|series| series.first_output == 0);
    match named.or_else(|| if place.is_none() { first() } else { None }) {
        Some(series) => StudyResult {
            series: vec![SeriesRecord { first_output: 0, ..series.clone() }],
            ..with_outputs(result, result.outputs[series.places()].to_vec(), None)
        },
        None => {
            let place = place.unwrap_or(0);
            with_outputs(result, result.outputs.get(place).cloned().into_iter().collect(), None)
        }
    }
}

/// Returns the same with other outputs, none of which is a series.
fn with_outputs(result: &StudyResult, outputs: Vec<OutputResult>, aggregate: Option<AggregateRecord>) -> StudyResult {
    StudyResult {
        format: result.format.clone(),
        version: result.version,
        study: result.study.clone(),
        provenance: result.provenance.clone(),
        indices_of: result.indices_of,
        factors: result.factors.clone(),
        outputs,
        validity: result.validity.clone(),
        effort: result.effort.clone(),
        aggregate,
        series: Vec::new(),
        stopping: result.stopping.clone(),
        spending: result.spending.clone(),
        low_fidelity: result.low_fidelity.clone(),
    }
}

/// Builds the sections of all series of `result`.
pub(super) fn sections(result: &StudyResult, stems: &[String]) -> Vec<Section> {
    let section = |(place, (series, stem)): (usize, (&SeriesRecord, &String))| {
        let (alone, number) = (values_alone(result, series), place + 1);
        let parts = match place {
            ..IN_FULL => {
                let figures = Figures { result: &alone, stems: &[], series: Some(number), is_only: false };
                in_full(result, series, figures, stem, place == 0)
            }
            _ => vec![overview::factors(&alone).into()],
        };
        let title = format!("{} along {}", heading(&series.name, &series.unit), name(&series.axis));
        Section::new(&format!("series-{number}"), &title, parts)
    };
    result.series.iter().zip(stems).enumerate().map(section).collect()
}

fn in_full(result: &StudyResult, series: &SeriesRecord, figures: Figures<'_>, stem: &str, is_first: bool) -> Vec<Part> {
    let (alone, study) = (figures.result, &result.study.name);
    let mut parts = overview::mind(alone);
    if is_first {
        parts.extend(definitions(result));
        parts.push(Part::Text(format!("The indices of every value are in `{study}.csv`, all else in `{study}.json`.")));
    }
    parts.push(figures.of_all(along_chart(result, series), "along", &format!("{stem}-along")));
    parts.push(Part::Heading("As a whole".to_owned()));
    let reason = series.reason.as_ref();
    parts.extend(reason.map(|reason| Part::no_indices(format!("There are no indices of the whole series: {reason}."))));
    let mut chart = together_chart(alone);
    chart.title = chart.title.replace("all outputs together", &format!("{} as a whole", name(&series.name)));
    chart.caption = chart.caption.replace("each output", "each value");
    parts.push(figures.of_all(chart, "together", &format!("{stem}-together")));
    let caption = "Indices of the whole series, the number of its values for which a factor surely matters most, and the median and \
                   largest of its total indices.";
    parts.push(Table { caption: caption.to_owned(), ..overview::factors(alone) }.into());
    parts.push(overview::every_output(alone));
    parts
}

/// Returns the paragraph at the top on a series: the leading factor over all of it.
pub(super) fn answer(result: &StudyResult, series: &SeriesRecord) -> String {
    let label = name(&series.name);
    let whole = format!("For {label} as a whole ({} values)", values(result, series).len());
    let sentence = series.indices.as_ref().and_then(|indices| leader_of_all(indices, &whole));
    let reason = || series.reason.as_deref().unwrap_or("the result has none");
    sentence.unwrap_or_else(|| format!("There are no indices of {label} as a whole: {}.", reason()))
}
