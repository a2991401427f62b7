//! The document on series: their indices along the axis and as a whole.

use apportion::result::SeriesRecord;

use super::overview;
use super::parts::{definitions, figure};
use crate::document::{Part, Section};
use crate::format::{heading, name};
use crate::output_view::OutputView;
use crate::run_charts::{along_chart, together_chart};

/// Number of series with all their charts and a table of their values.
const IN_FULL: usize = 4;

const FACTORS: &str = "Indices of the whole series, the number of its values for which a factor surely matters most, and the median and \
                       largest of its total indices.";

/// Builds the sections of all series, whose files are named by `stems`.
pub(super) fn sections(view: &OutputView<'_>, stems: &[String]) -> Vec<Section> {
    let mut sections = Vec::new();
    for ((number, series), stem) in (1..).zip(&view.series).zip(stems) {
        let values = view.values(series);
        let parts = match number {
            ..=IN_FULL => in_full(&values, series, number, stem),
            _ => vec![overview::factors(&values, FACTORS).into()],
        };
        let title = format!("{} along {}", heading(&series.name, &series.unit), name(&series.axis));
        sections.push(Section::new(&format!("series-{number}"), &title, parts));
    }
    sections
}

fn in_full(values: &OutputView<'_>, series: &SeriesRecord, number: usize, stem: &str) -> Vec<Part> {
    let study = &values.result.study;
    let mut parts = overview::warnings(values);
    if number == 1 {
        parts.extend(definitions(values.result));
        let study = &study.name;
        parts.push(Part::Text(format!("The indices of every value are in `{study}.csv`, all else in `{study}.json`.")));
    }
    let along = along_chart(values, series);
    parts.push(figure(study, along, format!("series-{number}-along"), format!("{stem}-along"), ".csv"));
    parts.push(Part::Heading("As a whole".to_owned()));
    if series.reason.is_some() {
        parts.push(Part::no_indices(format!("There are no indices of the whole series: {}.", values.reason())));
    }
    let together = together_chart(values);
    parts.push(figure(study, together, format!("series-{number}-together"), format!("{stem}-together"), ".csv"));
    parts.push(overview::factors(values, FACTORS).into());
    parts.push(overview::every_output(values));
    parts
}
